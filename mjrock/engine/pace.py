"""Pace: how long the steps of a run may be.

The lengths follow from the contacts, the rocking and an error estimate:

* the short step from the highest frequency of the closed contacts, omega h = sqrt(SHORT accuracy);
* the longest from the rocking, p h = sqrt(LONG accuracy), as far as MuJoCo represents the rows. On a shaken base it is
  no longer than the time step of the record;
* between the two, a step is halved when the acceleration changed by too much in it, h |da| more than
  CHANGE accuracy |v|, and doubled after two steps in a row that changed by less than a quarter of that. |.| weighs with
  the masses, and |v| is the speed at which the bodies arrived at their last touch;
* a loaded contact stays loaded: no step moves a loaded point by more than the share STAYS of its penetration through
  the velocities alone;
* no step is longer than a taut tie is integrated well in, and a tie that can yield is met at its greatest length.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import jitable
from ..geometry.kinematics import Ties
from ..problem.quantities import Array
from ..scene.course import Course
from ..scene.scene import Scene
from .contact import longest_step
from .points import Reach, inverse_weights, points_of
from .rows import Step
from .touches import Openings

SHORT = 24.0
"""(omega h)^2 of a short step over the accuracy, omega the highest contact frequency. Newmark's period error is
(omega h)^2 / 24 for beta = 0 and less for beta = 1/12, which short steps use."""
MOST = 0.35
"""omega h of a short step, however loose the accuracy: some eighteen steps in the shortest period [-]."""
DASHPOT = 12.0
"""(c h / m)^2 of a short step over the accuracy, m = 1 / (6 W) the least mass that a contact may feel. The error of a
dashpot centred in the step is (c h / m)^2 / 12."""
LONG = 0.6
"""(p h)^2 of the longest step over the accuracy, p the frequency parameter of the rocking."""
CHANGE = 2.0
"""Largest accepted (change of acceleration x step), as a multiple of accuracy x speed."""
STAYS = 0.1
"""Largest accepted movement of a loaded point in a step by the velocities alone, as a share of its penetration [-]. A
point of a wall that turns at omega is moved by h^2/2 omega^2 times the height of the centroid. On a stiff base this
lifts a toe that its weight presses in by micrometres, and friction at the toe is lost with it."""
LOADED = 0.5
"""A point counts as loaded from this share of its penetration at rest on [-]: an edge may lift off as it likes."""
STABLE = 1.0
"""omega h of the longest step with a tie [-], omega as for TAUT: a tie may go taut unforeseen, and MuJoCo's explicit
ties are stable up to 2."""
TAUT = 12.0
"""(omega h)^2 of the longest step with a taut tie over the accuracy, omega the frequency of the bodies on it alone.
MuJoCo integrates ties explicitly, and the energy of a bounce on one errs by about (omega h)^2 / 12."""
SMOOTH = 1.5
"""omega h below which a step resolves the contacts and takes Newmark's beta = 1/12 (stable below 2.45). A longer step
takes a beta above 1/4, which is stable at every step. The closed contacts hardly move then."""
RINGING_BORNE, RINGING_OPEN = 0.1, 1.0
"""Extra dashpot h k r of a contact in a step that does not resolve it, with beta = (1 + r^2)/4 [-]: of a contact that
bears weight at rest, and of one that is open at rest. beta above 1/4 alone would let what is left of a vibration ring
on from step to step. Where weight is borne, the dashpot takes a third of the energy of the vibration in a step, and
next to nothing of the rocking. A contact that is open at rest, such as a side stop, carries only what has just hit it.
What is too faint to be met with a short step has to die there, and not to be thrown back with more energy. Between
several bodies a dashpot of the joint that already takes as much counts, because columns of flat blocks rock at
frequencies at which the extra dashpot would be felt: it is only what the joint lacks in the longest step."""


class Pace(NamedTuple):
    """The limits of the steps of a run.

    Args:
        short, longest: the shortest and the longest step [s].
        taut: the longest step while a tie is taut [s].
        accuracy: the relative tolerance that is aimed at [-].
        least_energy: the energy that changes are measured by is never smaller [J]: twice the elastic energy of the
            scene at rest. Without a floor, a scene at rest would be stepped as finely as one in an impact.
        frequency: highest frequency of the closed contacts [rad/s].
        beta, ringing: Newmark's beta and the extra dashpot of each contact [-], in steps that resolve the contacts and
            in steps that do not, shape (2, m).
    """

    short: float
    longest: float
    taut: float
    accuracy: float
    least_energy: float
    frequency: float
    beta: Array
    ringing: Array

    @classmethod
    def of(cls, scene: Scene, course: Course, accuracy: float) -> Pace:
        """The limits for a scene and what happens to it."""
        short, weight = short_step(scene, accuracy), points_of(scene).inertia.weight
        rocking = math.sqrt(LONG * accuracy) / scene.rocking_frequency
        represented = min(longest_step(k, W) for k, W in zip(scene.k, weight, strict=True))
        stable = STABLE / max(scene.tie_frequency, 1e-300)
        longest = max(short, min(rocking, represented, stable, *course.sampling))
        damped = scene.c / (longest * scene.k) if scene.damped_joints else 0.0
        ringing = np.where(scene.bears > 0, np.maximum(RINGING_BORNE - damped, 0.0), RINGING_OPEN)
        return cls(
            short,
            longest,
            math.sqrt(TAUT * accuracy) / scene.tie_frequency if len(scene.tie_k) else math.inf,
            accuracy,
            2 * float(scene.rest_energies[2]),
            scene.highest_frequency,
            np.stack([np.full_like(ringing, 1 / 12), (1 + ringing**2) / 4]),
            np.stack([np.zeros_like(ringing), ringing]),
        )


def short_step(scene: Scene, accuracy: float) -> float:
    """The step that resolves the stiffest spring and the strongest dashpot to `accuracy` [s].

    A dashpot that would ask for less than an eighth of the spring's step acts at the end of the step instead, see
    `mjrock.engine.contact.row`. It stops what it meets, and how it does so no longer matters.
    """
    spring = min(MOST, math.sqrt(SHORT * accuracy)) / scene.highest_frequency
    strongest = float(np.max(scene.c * inverse_weights(scene)))
    dashpot = math.sqrt(DASHPOT * accuracy) / (6 * strongest) if strongest else math.inf
    return min(spring, max(dashpot, spring / 8))


@jitable
def resolves(pace: Pace, h: float) -> int:
    """Which row of `pace.beta` and `pace.ringing` a step of length h takes: 0 where it resolves the contacts, else
    1."""
    return 0 if h * pace.frequency < SMOOTH else 1


@jitable
def step_of(pace: Pace, h: float) -> Step:
    """The step of length h."""
    kind = resolves(pace, h)
    return Step(h, pace.beta[kind], pace.ringing[kind])


@jitable
def while_loaded(reach: Reach, openings: Openings, h: float, short: float) -> float:
    """The step h [s], shortened to what every loaded contact stays loaded in, but not below the short step.

    h^2/2 |g2| <= STAYS |g| for every loaded point, with g its gap and g2 what the velocities alone make of its second
    rate.
    """
    for i in range(len(reach.bears)):
        g, swept = openings.value[i], openings.swept[i]
        if -g > LOADED * reach.bears[i] > 0 and 0.5 * h * h * abs(swept) > -STAYS * g:
            h = math.sqrt(-2 * STAYS * g / abs(swept))
    return max(h, short)


@jitable
def while_taut(pace: Pace, ties: Ties, openings: Openings, h: float) -> float:
    """The step h [s], shortened to what a taut tie is integrated well in, but not below the short step.

    It also ends where a tie that can yield is longest. A tie yields up to its greatest length, which a long step would
    pass by.

    Args:
        pace: the limits.
        ties: the ties.
        openings: of the contacts and the ties.
        h: the step [s].
    """
    first = len(openings.value) - len(ties.k)
    for i in range(len(ties.k)):
        j = first + i
        g, g1, g2 = openings.value[j], openings.rate[j], openings.linear[j] + openings.swept[j]
        if g < 0:
            h = min(h, pace.taut)
        if ties.stretch[i] < math.inf and g < 0 and g1 < 0 and g1 + h * g2 > 0:
            h = -g1 / g2
    return max(h, pace.short)


@jitable
def judged(pace: Pace, h: float, change: float, calm: int) -> tuple[float, int]:
    """The length of the next step, and how many steps in a row have been calm.

    Args:
        pace: the limits.
        h: the step [s].
        change: (h |da| / |v|)^2 of the step just made [-].
        calm: the steps that were calm before it.
    """
    tolerated = (CHANGE * pace.accuracy) ** 2
    if change > tolerated:
        return max(0.5 * h, pace.short), 0
    if 16 * change >= tolerated:
        return h, 0
    if calm == 0:
        return h, 1
    return min(2 * h, pace.longest), 0
