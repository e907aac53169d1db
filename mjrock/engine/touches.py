"""Touches: when a contact closes, and how the step is fitted to it.

A step in which a point would touch, to second order in time, ends half a short step after the touch. The touch is then
the start of the leapfrog window in which the new contact first acts. Ending the step at the touch itself would apply
half a step of force too much. A touch that is too faint to matter is ignored.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import jitable
from ..problem.quantities import Array, Flags
from .kinematics import Points, Ties, gap, slack

FADED = 0.01
"""A touch is met with a short step where ignoring it would misplace more than this share of accuracy x energy [-]."""
ABRUPT = 0.1
"""Change of velocity in a step, over the speed at the last touch, beyond which no touch is predicted from it [-]. How a
strong dashpot stops a body within a step or two says nothing of the next step."""
ROUNDING = 1e-12
"""Gap below which a contact has neither opened nor closed [m]. A joint that bears nothing rests at a gap of zero."""


class Springs(NamedTuple):
    """Springs [N/m] and dashpots [N s/m] of the contacts, and after them of the ties, shape (m + t,) each."""

    k: Array
    c: Array

    @classmethod
    def of(cls, points: Points, ties: Ties) -> Springs:
        """Those of a scene."""
        return cls(np.append(points.k, ties.k), np.append(points.c, np.zeros_like(ties.k)))


@jitable
def follow(points: Points, ties: Ties, frame: Array, v: Array, a: Array, motion: Array) -> None:
    """Write the gap of every contact and the slack of every tie with their rates, shape (m + t, 4).

    See `kinematics.gap`. A tie that goes taut is a touch like any other.
    """
    m = len(points.k)
    for i in range(m):
        motion[i, 0], motion[i, 1], motion[i, 2], motion[i, 3] = gap(points, i, frame, v, a)
    for i in range(len(ties.k)):
        j = m + i
        motion[j, 0], motion[j, 1], motion[j, 2], motion[j, 3] = slack(ties, i, frame, v, a)


@jitable
def closure_changed(motion: Array, closed: Flags) -> bool:
    """Whether a contact or a tie has opened or closed since `closed` was brought up to date, which is done here."""
    changed = False
    for i in range(len(motion)):
        now = motion[i, 0] < 0
        if now != closed[i] and abs(motion[i, 0]) > ROUNDING:
            closed[i] = now
            changed = True
    return changed


@jitable
def predict(springs: Springs, motion: Array, now: float, h: float, least: float, touch: Array) -> float:
    """Find the touches of a step that matter, and return the time until the first one [s], or infinity.

    A touch that is ignored is noticed up to a step h too late. It then misplaces k (v h)^2 / 4 in the spring and
    c h v^2 in the dashpot.

    Args:
        springs: of the contacts and the ties.
        motion: their motion now.
        now: the step within which touches count [s].
        h: the step up to which a touch that is ignored would be noticed too late [s].
        least: energy that may be misplaced [J].
        touch: where the time until the touch [s] and the closing speed [m/s] of each contact are written, shape
            (m + t, 2). The time is infinite where a contact is closed, does not touch, or touches too faintly.
    """
    first = math.inf
    for i in range(len(springs.k)):
        touch[i, 0] = math.inf
        g, g1, g2 = motion[i, 0], motion[i, 1], motion[i, 2] + motion[i, 3]
        if g < 0 or g + now * (g1 + 0.5 * now * g2) > 0:
            continue
        closing = math.sqrt(max(0.0, g1 * g1 - 2 * g * g2))
        if (0.25 * springs.k[i] * h + springs.c[i]) * h * closing**2 > least:
            touch[i, 0], touch[i, 1] = 2 * g / (closing - g1), closing
            first = min(first, touch[i, 0])
    return first


@jitable
def hardest(touch: Array, latest: float) -> float:
    """Of the touches up to a time, the time of the one with the highest closing speed [s]."""
    when, fastest = 0.0, -1.0
    for i in range(len(touch)):
        if touch[i, 0] <= latest and touch[i, 1] > fastest:
            when, fastest = touch[i, 0], touch[i, 1]
    return when


@jitable
def step_to_touch(
    springs: Springs, motion: Array, now: float, h: float, least: float, short: float, touch: Array
) -> float:
    """Length of a step that ends half a short step after the touch that falls within it, or zero if none does [s].

    Of several touches in one short window, the hardest is the start of the window.

    Args:
        springs: of the contacts and the ties.
        motion: their motion now.
        now: the step that is about to be made [s].
        h: the length of step that the pace allows [s].
        least: energy that may be misplaced [J].
        short: the short step [s].
        touch: room for the touches, shape (m + t, 2).
    """
    first = predict(springs, motion, now, h, least, touch)
    if first == math.inf:
        return 0.0
    return hardest(touch, first + 0.5 * short) + 0.5 * short
