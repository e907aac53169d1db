"""The tilting table: gravity that turns in the plane x-z, as the blocks on the table see it.

A table that has turned by an angle a gives every block the accelerations g sin a along x and -g cos a along z, which
are its own. Beside the weight at rest this is a ground that accelerates by -g sin a along x and -g (1 - cos a) along
z. The table turns slowly: what its rate adds, such as centrifugal forces, is left out.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...quantities import GRAVITY
from ..ground.motion import GroundMotion
from .histories import History, history_of

STEEPEST = math.pi
"""Largest angle of a table [rad]."""
SAMPLES, MOST = 2000, 1_000_000
"""Samples of the equivalent ground motion over a run, and most where the angle changes faster [-]."""
COARSEST = 1.0
"""Largest step of a ground motion [s]."""


def tilt_of(given: Any) -> History | None:
    """The history of the angle of a table from (t, angle), or None.

    Raises:
        TypeError, ValueError: for what is not two rows of as many numbers, or out of range.
    """
    return None if given is None else history_of("tilt", given, STEEPEST, "rad")


def motions_of_tilt(tilt: History, duration: float) -> tuple[GroundMotion, GroundMotion]:
    """The horizontal and the vertical motion of the ground that turns gravity as a table does, to the end of a run.

    The angle is linear between its samples. Those of the motion are so close that between them the acceleration is
    within 1e-6 g where the table turns by less than 5 rad in the run.
    """
    t, angle = (np.array(row) for row in tilt)
    closest = 0.25 * float(np.diff(t).min()) if len(t) > 1 else math.inf
    step = min(max(min(duration / SAMPLES, closest), duration / MOST), COARSEST)
    count = math.ceil(duration / step) + 1
    turned = np.interp(duration * np.arange(count + 1) / (count - 1), t, angle)
    accel, dt = (-GRAVITY * np.sin(turned), -2 * GRAVITY * np.sin(0.5 * turned) ** 2), duration / (count - 1)
    return GroundMotion(accel[0], dt, "tilt"), GroundMotion(accel[1], dt, "tilt")
