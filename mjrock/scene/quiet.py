"""When masonry has come to rest."""

from __future__ import annotations

from ..quantities import Array
from .masses import kinetic_energies
from .scene import Scene


def is_quiet(scene: Scene, energy: float, velocity: Array) -> bool:
    """Whether masonry rests: neither the energy that is left nor the motion of a block opens a joint.

    The energy above rest is less than that of the springs at rest. What falls freely keeps its energy, and what slides
    down loses some. So the kinetic energy of every block is less than its share of that of the springs too, by mass.

    Args:
        scene: the masonry.
        energy: at the end, above the scene at rest [J].
        velocity: at the end, shape (bodies, nv).
    """
    springs = float(scene.rest_energies[2])
    moving = kinetic_energies(scene.bodies.masses, scene.bodies.products, velocity) / scene.bodies.mass
    return abs(energy) < springs and bool((moving < springs / scene.bodies.mass.sum()).all())
