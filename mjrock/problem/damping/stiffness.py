"""Interface stiffness k_n [N/m3]: the usual ways to it.

The stiffness of an interface is a pressure over a closing of it [Pa/m = N/m3]. The value spreads over two orders of
magnitude between methods: take more than one where the result matters, see docs/stiffness.md. `reference_frequency`
gives the frequency that a stiffness belongs to.
"""

from __future__ import annotations

import math
from typing import Annotated

from ...quantities import Within, require_kind, require_stiffness, within_ranges
from ..wall.block import Block
from .interface import PointCount, contact_lines, reference_frequency

Modulus = Annotated[float, Within(1e5, 1e12, "Pa", "modulus E")]
"""Young's modulus of mortar, masonry or stone."""
UNIT = 1e8
"""A stiffness whose frequency is scaled [N/m3]."""


@within_ranges
def joint_stiffness(E: Modulus, thickness: Annotated[float, Within(1e-4, 1, "m")]) -> float:
    """k_n = E / t of a mortar joint or of any thin layer, uniaxially compressed [N/m3].

    It is an upper bound for units much stiffer than the mortar: real joints have voids and touch in spots.

    Args:
        E: Young's modulus of the layer [Pa], 1e5 to 1e12. It is not a pressure: mortar has 1e8 to 1e10.
        thickness: of the layer [m], 1e-4 to 1.

    Raises:
        ValueError: for a value outside its range, or a stiffness outside 1e4 to 1e14 N/m3.

    Source: Lourenço (1996), Computational strategies for masonry structures, TU Delft, for joints between stiff units.
    """
    return require_stiffness("k_n = E / thickness", E / thickness)


@within_ranges
def wall_stiffness(E: Modulus, wall: Block, points: PointCount = 2) -> float:
    """k_n = E / H of a base that stands for the elasticity of the wall above it [N/m3].

    Two corner lines of E / H have the rotational stiffness 3 E I / H of a cantilever with a force at its top. On more
    lines k_n is larger, up to 3 E / H of a bed, so that this rotational stiffness stays. It is a lower bound for a wall
    that presses on one edge: the pressure spreads over less than its height.

    Args:
        E: Young's modulus of the masonry [Pa], 1e5 to 1e12.
        wall: the wall.
        points: contact lines a face, 2 to 1000.

    Raises:
        ValueError: for a modulus outside its range, or a stiffness outside 1e4 to 1e14 N/m3.
    """
    require_kind("wall", wall, Block)
    x, widths = contact_lines(2 * wall.half_base, points)
    fewer = 2 * wall.half_base**3 / float((widths * x**2).sum())
    return require_stiffness("k_n = E / H", fewer * E / (2 * wall.h))


def layered_stiffness(*stiffnesses: float) -> float:
    """k_n of layers in series, such as a joint and the wall above it: 1 / k_n is the sum of theirs [N/m3].

    Args:
        stiffnesses: of each layer [N/m3], at least one, 1e4 to 1e14.

    Raises:
        ValueError: for a value outside its range, or none.
    """
    if not stiffnesses:
        raise ValueError("stiffnesses is empty; at least one layer is needed")
    checked = [require_stiffness(f"stiffnesses[{i}]", value) for i, value in enumerate(stiffnesses)]
    return require_stiffness("k_n of the layers", 1 / sum(1 / value for value in checked))


@within_ranges
def measured_stiffness(
    wall: Block, frequency: Annotated[float, Within(1e-3, 1e4, "Hz")], points: PointCount = 2
) -> float:
    """k_n for which the wall, rocking in full contact on its base, has a measured natural frequency [N/m3].

    The frequency is the lowest out of plane of the detached wall with its top free, at small amplitude, by ambient
    vibration or a tap. It is the inverse of omega^2 = (K_rot - m g z) / I_base with K_rot the sum of k_i x_i^2 over the
    contact lines, z the height of the centroid and I_base the moment of inertia about the middle of the base.

    Args:
        wall: the wall.
        frequency: in cycles a second [Hz], 1e-3 to 1e4, not in rad/s.
        points: contact lines a face, 2 to 1000. The same wall on two corner lines needs a third of the k_n of a uniform
            bed.

    Raises:
        ValueError: for a value outside its range, or a stiffness outside 1e4 to 1e14 N/m3.

    Source: Small oscillations of a rigid body on springs; the engine agrees, see tests/problem/test_stiffness.py.
    """
    require_kind("wall", wall, Block)
    omega = 2 * math.pi * frequency
    unit = reference_frequency(wall, UNIT, points) ** 2 / UNIT
    arm = math.hypot(wall.centroid_height, wall.centroid_offset)
    inertia = wall.inertia + wall.mass * arm**2
    falling = wall.weight * wall.centroid_height / inertia
    return require_stiffness("k_n of the measured frequency", (omega**2 + falling) / unit)
