"""Step control: how long the steps of a run may be.

The lengths follow from the contacts, the rocking and an error estimate:

* the short step from the highest frequency of the closed contacts, omega h = sqrt(short x accuracy);
* the longest from the rocking, p h = sqrt(longest x accuracy), as far as MuJoCo represents the rows. On a shaken base
  it is no longer than the time step of the record;
* between the two, a step is halved when the acceleration changed by too much in it, h |da| more than
  change x accuracy x |v|, and doubled after two steps in a row that changed by less than a quarter of that. |.| weighs
  with the masses, and |v| is the speed at which the bodies arrived at their last touch, or a share `faster` of the
  present kinetic energy as a speed, if that is more. What bodies answer to the ground does not count, see
  `mjrock.engine.loop`;
* on a shaken base a touch is approached: a step ends before it, but for the last short ones;
* a loaded contact stays loaded: no step moves a loaded point by more than the share `stays` of its penetration through
  the velocities alone;
* no step is longer than a taut tie allows for its integration, and a step ends where a tie that can yield is longest.

The constants are those of `mjrock.method`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..contacts.solref import longest_represented_step
from ..geometry.kinematics import Ties
from ..method import METHOD, Method
from ..quantities import Array
from ..scene.course import Course
from ..scene.dampers import damping_rate
from ..scene.scene import Scene
from .rows import Points, Step, inverse_weights, points_of
from .touches import Openings

LARGEST_INVERSE_MASS = {2: 6, 3: 7}
"""Largest inverse mass that a contact of a block may feel, over W, in the plane and in space [-]: 4/m at the edge of a
slender block, and 7/m at the corner of a thin plate."""


class StepControl(NamedTuple):
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
        method: the constants of the method.
    """

    short: float
    longest: float
    taut: float
    accuracy: float
    least_energy: float
    frequency: float
    beta: Array
    ringing: Array
    method: Method

    @classmethod
    def from_scene(cls, scene: Scene, course: Course, accuracy: float, method: Method = METHOD) -> StepControl:
        """The limits for a scene and what happens to it."""
        short, weight = short_step(scene, accuracy, method), points_of(scene, method).weight
        rocking = math.sqrt(method.longest * accuracy) / scene.rocking_frequency
        represented = min(longest_represented_step(k, W) for k, W in zip(scene.contacts.k, weight, strict=True))
        stable = method.stable / max(scene.tie_frequency, 1e-300)
        decay = damping_rate(scene.dampers, scene.potential.unmoved, scene.bodies.principal)
        of_dampers = math.sqrt(method.dashpot * accuracy) / max(decay, 1e-300)
        longest = max(short, min(rocking, represented, stable, of_dampers, *course.sampling))
        damped = scene.contacts.c / (longest * scene.contacts.k) if scene.limits.damped_joints else 0.0
        ringing = np.where(scene.bears > 0, np.maximum(method.ringing_borne - damped, 0.0), method.ringing_open)
        return cls(
            short=short,
            longest=longest,
            taut=math.sqrt(method.taut * accuracy) / scene.tie_frequency if scene.links.sprung.names else math.inf,
            accuracy=accuracy,
            least_energy=2 * float(scene.rest_energies[2]),
            frequency=scene.highest_frequency,
            beta=np.stack([np.full_like(ringing, 1 / 12), (1 + ringing**2) / 4]),
            ringing=np.stack([np.zeros_like(ringing), ringing]),
            method=method,
        )


def short_step(scene: Scene, accuracy: float, method: Method = METHOD) -> float:
    """The step that resolves the stiffest spring and the strongest dashpot to `accuracy` [s].

    A dashpot that would ask for less than an eighth of the spring's step acts at the end of the step instead, see
    `mjrock.contacts.solref.row`. It stops what it meets, and how it does so no longer matters.
    """
    spring = min(method.most, math.sqrt(method.short * accuracy)) / scene.highest_frequency
    strongest = float(np.max(scene.contacts.c * inverse_weights(scene)))
    decay = LARGEST_INVERSE_MASS[scene.freedom.translations] * strongest
    dashpot = math.sqrt(method.dashpot * accuracy) / decay if strongest else math.inf
    return min(spring, max(dashpot, spring / 8))


@inlined
def kind_of_step(control: StepControl, h: float) -> int:
    """Which row of `control.beta` and `control.ringing` a step of length h takes: 0 where it resolves the contacts,
    otherwise 1."""
    return 0 if h * control.frequency < control.method.smooth else 1


@inlined
def step_of(control: StepControl, h: float) -> Step:
    """The step of length h."""
    kind = kind_of_step(control, h)
    return Step(h, control.beta[kind], control.ringing[kind])


@inlined
def limited_by_loaded_contacts(control: StepControl, points: Points, openings: Openings, h: float) -> float:
    """The step h [s], shortened so that every loaded contact stays loaded in it, but not below the short step.

    h^2/2 |g2| <= stays |g| for every loaded point, with g its gap and g2 what the velocities alone make of its second
    rate.
    """
    for i in range(len(points.bears)):
        g, swept = openings.value[i], openings.swept[i]
        if -g > control.method.loaded * points.bears[i] > 0 and 0.5 * h * h * abs(swept) > -control.method.stays * g:
            h = math.sqrt(-2 * control.method.stays * g / abs(swept))
    return max(h, control.short)


@inlined
def limited_by_taut_ties(control: StepControl, ties: Ties, openings: Openings, h: float) -> float:
    """The step h [s], shortened so that a taut tie is integrated well in it, but not below the short step.

    It also ends where a tie that can yield is longest. A tie yields up to its greatest length, which a long step would
    pass by.
    """
    first = len(openings.value) - len(ties.k)
    for i in range(len(ties.k)):
        j = first + i
        g, g1, g2 = openings.value[j], openings.rate[j], openings.linear[j] + openings.swept[j]
        if g < 0:
            h = min(h, control.taut)
        if ties.stretch[i] < math.inf and g < 0 and g1 < 0 and g1 + h * g2 > 0:
            h = -g1 / g2
    return max(h, control.short)


@inlined
def limited_by_approach(control: StepControl, step: float, to_touch: float) -> tuple[float, float]:
    """The step on moving ground, and the step to a touch, zero where none is met in it [s].

    A touch that is predicted from the present motion comes earlier or later as the ground goes on, the more so the
    further ahead it is. A step therefore ends before a touch that is not near.
    """
    if to_touch > control.method.near * control.short:
        return min(step, control.method.approach * to_touch), 0.0
    return step, to_touch if to_touch <= step else 0.0


@inlined
def next_length(control: StepControl, h: float, change: float, calm: int) -> tuple[float, int]:
    """The length of the next step [s], and how many steps in a row have changed little.

    Args:
        control: the limits.
        h: length of the step just made [s].
        change: (h |da| / |v|)^2 of the step just made [-].
        calm: how many steps in a row before it changed little.
    """
    tolerated = (control.method.change * control.accuracy) * (control.method.change * control.accuracy)
    if change > tolerated:
        return max(0.5 * h, control.short), 0
    if 16 * change >= tolerated:
        return h, 0
    if calm == 0:
        return h, 1
    return min(2 * h, control.longest), 0
