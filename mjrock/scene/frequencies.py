"""Frequencies of bodies on the springs of their contacts and ties."""

from __future__ import annotations

import math

import numpy as np
from scipy.sparse import csr_array

from ..geometry.frames import SPACE
from ..linear import highest_square
from ..quantities import GRAVITY, Array
from .potential import Potential

Principal = tuple[csr_array, Array]
"""Velocities along principal axes, and the masses of each, see `masses.principal`."""


def highest_frequency(potential: Potential, principal: Principal) -> float:
    """The highest natural frequency with every contact closed and free to slide [rad/s].

    No contact state of a run vibrates faster, because opening a contact or holding it sideways only lowers it.
    """
    stiffness, (columns, masses) = potential.stiffness(potential.unmoved, potential.springs), principal
    if potential.structure.places.freedom == SPACE:
        stiffness = csr_array(columns.T @ stiffness @ columns)
    return math.sqrt(highest_square(stiffness, masses))


def tie_frequency(potential: Potential, principal: Principal) -> float:
    """The highest natural frequency of the bodies on one tie alone [rad/s], zero without ties."""
    k, (columns, masses) = potential.structure.ties.k, principal
    rates = potential.rates(potential.unmoved)[len(potential.structure.k) :]
    if potential.structure.places.freedom == SPACE:
        rates = csr_array(rates @ columns)
    return math.sqrt(max(k * (rates.power(2) @ (1 / masses)), default=0.0))


def rocking_frequency(mass: Array, inertia: Array, outlines: tuple[Array, ...]) -> float:
    """The largest p = sqrt(m g R / (I + m R^2)) of bodies [rad/s], R to the farthest of the vertices of each outline.

    In space I is the smallest principal moment of inertia.
    """
    R = np.array([np.hypot.reduce(corners, axis=1).max() for corners in outlines])
    least = inertia if inertia.ndim == 1 else np.linalg.eigvalsh(inertia)[:, 0]
    return math.sqrt(float(np.max(mass * GRAVITY * R / (least + mass * R**2))))
