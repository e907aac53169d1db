"""Motion of the bodies at the samples of a response."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from ..quantities import Array


class Motion(Protocol):
    """Where bodies are at the samples, how fast they move, and their energy, as in `Response`."""

    @property
    def pose(self) -> Array:
        """Displacements and rotations from rest, shape (n, bodies, 3), or (n, bodies, 7) in space."""

    @property
    def velocity(self) -> Array:
        """Their rates, shape (n, bodies, 3), or (n, bodies, 6) in space."""

    @property
    def energy(self) -> Array:
        """Energy above rest [J], shape (n,)."""

    @property
    def theta(self) -> Array:
        """Rotations of the bodies of the plane [rad], shape (n, bodies)."""

    @property
    def omega(self) -> Array:
        """Angular velocities of the bodies of the plane [rad/s], shape (n, bodies)."""


@dataclass(frozen=True, eq=False)
class SampledMotion:
    """A motion that is given by its samples, see `Motion`."""

    pose: Array
    velocity: Array
    energy: Array

    @property
    def theta(self) -> Array:
        """Rotations of the bodies of the plane [rad], shape (n, bodies)."""
        return self.pose[:, :, 2]

    @property
    def omega(self) -> Array:
        """Angular velocities of the bodies of the plane [rad/s], shape (n, bodies)."""
        return self.velocity[:, :, 2]
