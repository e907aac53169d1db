"""Touches: when a contact closes or a tie breaks, and how the step is fitted to it.

A step in which a point would touch, to second order in time, ends half a short step after the touch. The touch is then
the start of the leapfrog window in which the new contact first acts. Ending the step at the touch itself would apply
half a step of force too much. A touch that is too faint to matter is ignored. A tie that breaks is met in the same way:
it pulls up to the end of a window.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..geometry.kinematics import Places, Ties, opening
from ..quantities import Array, Flags

ROUNDING_OF_GAP = 1e-6
"""Gap below which a contact has neither opened nor closed, over the radius of the contact spheres [-], which goes with
the size of the bodies: some 1e-12 m. A joint that bears nothing rests at a gap of zero."""


class Openings(NamedTuple):
    """Gaps of the contacts and after them slack of the ties, and how they change, shape (m + t,) each; as in `Gap`."""

    value: Array
    rate: Array
    linear: Array
    swept: Array

    @classmethod
    def with_room(cls, count: int) -> Openings:
        """Room for a number of openings."""
        return cls(*np.zeros((4, count)))


class Touches(NamedTuple):
    """Touches of a step, of the contacts and after them of the ties, shape (m + t,) each.

    Args:
        k, c: springs [N/m] and dashpots [N s/m].
        time, speed: time until each touch [s], infinite where there is none, and closing speed [m/s].
    """

    k: Array
    c: Array
    time: Array
    speed: Array

    @classmethod
    def with_room(cls, places: Places, ties: Ties) -> Touches:
        """Room for the touches of a scene."""
        k, c = np.append(places.k, ties.k), np.append(places.c, np.zeros_like(ties.k))
        return cls(k, c, *np.zeros((2, len(k))))


@inlined
def follow_openings(places: Places, ties: Ties, frames: Array, v: Array, a: Array, openings: Openings) -> None:
    """Write how the gap of every contact and the slack of every tie change. A tie that goes taut is a touch too.

    A link that also pushes is never slack. It counts as one that is taut by its elongation or its shortening.
    """
    contacts = len(places.body)
    for i in range(len(openings.value)):
        now = opening(places, ties, i, frames, v, a)
        openings.value[i], openings.rate[i] = now.value, now.rate
        openings.linear[i], openings.swept[i] = now.linear, now.swept
        if i >= contacts and ties.squeeze[i - contacts] > 0:
            side = -1.0 if now.value > 0 else 1.0
            openings.value[i], openings.rate[i] = (
                side * now.value - 2 * ROUNDING_OF_GAP * places.radius,
                side * now.rate,
            )
            openings.linear[i], openings.swept[i] = side * now.linear, side * now.swept


@inlined
def closure_changed(places: Places, openings: Openings, closed: Flags) -> bool:
    """Whether a contact or a tie has opened or closed since `closed` was brought up to date, which is done here."""
    changed = False
    for i in range(len(closed)):
        now = openings.value[i] < 0
        if now != closed[i] and abs(openings.value[i]) > ROUNDING_OF_GAP * places.radius:
            closed[i] = now
            changed = True
    return changed


@inlined
def predict_touches(touches: Touches, openings: Openings, now: float, h: float, least: float) -> float:
    """Find the touches of a step that matter, and return the time until the first one [s], or infinity.

    A touch that is ignored is noticed up to a step h too late. It then misplaces k (v h)^2 / 4 in the spring and
    c h v^2 in the dashpot.

    Args:
        touches: with the springs and the dashpots. Time and speed are written; the time is infinite where a contact is
            closed, does not touch, or touches too faintly.
        openings: how they open and close now.
        now: the step within which touches count [s].
        h: the step up to which a touch that is ignored would be noticed too late [s].
        least: energy that may be misplaced [J].
    """
    first = math.inf
    for i in range(len(touches.k)):
        touches.time[i] = math.inf
        g, g1, g2 = openings.value[i], openings.rate[i], openings.linear[i] + openings.swept[i]
        if g < 0 or g + now * (g1 + 0.5 * now * g2) > 0:
            continue
        closing = math.sqrt(max(0.0, g1 * g1 - 2 * g * g2))
        if (0.25 * touches.k[i] * h + touches.c[i]) * h * (closing * closing) > least:
            touches.time[i], touches.speed[i] = 2 * g / (closing - g1), closing
            first = min(first, touches.time[i])
    return first


@inlined
def hardest_touch(touches: Touches, latest: float) -> float:
    """Of the touches up to a time, the time of the one with the highest closing speed [s]."""
    when, fastest = 0.0, -1.0
    for i in range(len(touches.time)):
        if touches.time[i] <= latest and touches.speed[i] > fastest:
            when, fastest = touches.time[i], touches.speed[i]
    return when


@inlined
def step_to_touch(touches: Touches, openings: Openings, now: float, h: float, least: float, short: float) -> float:
    """Length of a step that ends half a short step after the touch that falls within it, or zero if none does [s].

    Of several touches in one short window, the hardest is the start of the window. `now` is the step that is about to
    be made, `short` the short step [s], and the other arguments are those of `predict_touches`.
    """
    first = predict_touches(touches, openings, now, h, least)
    if first == math.inf:
        return 0.0
    return hardest_touch(touches, first + 0.5 * short) + 0.5 * short


@inlined
def step_to_break(ties: Ties, openings: Openings, now: float, short: float) -> float:
    """Length of a step that ends half a short step after a tie breaks within it, or zero if none does [s].

    Args:
        ties: the ties, their reach up to date.
        openings: of the contacts and the ties.
        now: the step that is about to be made [s].
        short: the short step [s].
    """
    first, contacts = math.inf, len(openings.value) - len(ties.k)
    for i in range(len(ties.k)):
        if ties.limit[i] == math.inf or ties.reach[i] == math.inf:
            continue
        j = contacts + i
        remaining = ties.limit[i] - ties.reach[i] + openings.value[j]
        g1, g2 = openings.rate[j], openings.linear[j] + openings.swept[j]
        if remaining + now * (g1 + 0.5 * now * g2) <= 0:
            first = min(first, 2 * remaining / (math.sqrt(max(0.0, g1 * g1 - 2 * remaining * g2)) - g1))
    return 0.0 if first == math.inf else first + 0.5 * short
