"""Dampers on a wall, written for SciPy, with kinematics of their own."""

from __future__ import annotations

import math

from ..problem.wall.damper import Damper
from ..quantities import Array


def damper_force(damper: Damper, face: float, up: float, y: Array) -> tuple[float, float, float, float]:
    """Point from the centroid at rest [m], and force on the wall [N], x before z each.

    Args:
        damper: the damper.
        face: horizontal distance of the inner face behind the centroid [m].
        up: height of the centroid above the base [m].
        y: the state of the wall, see `Wall`.
    """
    x, z, theta, vx, vz, omega = y
    px, pz = -face, damper.height - up
    sine, cosine = math.sin(theta), math.cos(theta)
    across = damper.length + x + px * (cosine - 1) + pz * sine
    above = z - px * sine + pz * (cosine - 1)
    length = math.hypot(across, above)
    rate_across, rate_above = vx + omega * (pz * cosine - px * sine), vz - omega * (px * cosine + pz * sine)
    force = -damper.c * (across * rate_across + above * rate_above) / length
    return px, pz, force * across / length, force * above / length
