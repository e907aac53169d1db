"""Rocking from impact to impact: Eq. 1 over a base at rest or shaken, in compiled steps.

Steps end where the wall turns, meets the upright position or lies on its face, where a tie goes taut, yields, breaks or
goes slack, and at every sample of a record. Between two samples the acceleration of the ground is linear, so that each
step of Nystroem's fourth-order method integrates a smooth function. (A general integrator would be restarted at each of
thousands of samples.) The wall rests until the moment about a free toe turns it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..problem.wall.case import Case
from ..problem.wall.restoring_moment import pulled, yielded
from ..quantities import ON_ITS_FACE, Array
from ..result.motion import interpolated
from ..result.rocking import Impact
from ..rows import Row, Rows, flags, integers, numbers, row_type, rows
from .law import (
    BROKEN,
    SLACK,
    TAUT,
    YIELDING,
    Loads,
    RockingLaw,
    Toe,
    WallTies,
    acceleration,
    acceleration_by_ties,
    nystroem,
    pushed,
)

HALVINGS = 50
"""Halvings of a step in the search of the time at which a tie changes."""
NYSTROEM = 50.0
"""(p h)^4 of the longest step over rtol. Nystroem's method then errs by about rtol alpha in a fall from alpha/2."""
NEWTON = 60
"""Most iterations of a root, of which bisection alone would need 53."""
UPRIGHT, TURNED, LYING = 0, 1, 2
"""Where an arc ends: the rotation is zero, the velocity is zero, or the wall lies on its face."""
CHUNK = 4096
"""Room for knots, and for a quarter as many impacts and peaks, which is emptied when it is full."""


@inlined
def new_state(toe: Toe, ties: WallTies, i: int, theta: float) -> int:
    """The state that tie i takes at a rotation, or -1 where it keeps the one that it has.

    A tie that yields goes on until the wall turns or it breaks, and one that has broken stays so.
    """
    if ties.state[i] == BROKEN:
        return -1
    tie = ties.pulls[i]
    elastic = pulled(tie, theta, toe.side)[0] - ties.plastic[i]
    if ties.state[i] == SLACK:
        return TAUT if elastic > 0 else -1
    if ties.state[i] == TAUT:
        if elastic < 0:
            return SLACK
        if elastic * tie.stiffness > tie.strength:
            return YIELDING
    if ties.state[i] == YIELDING:
        drawn = pulled(tie, theta, toe.side)[0] - tie.strength / tie.stiffness
        if drawn > tie.ultimate:
            return BROKEN
    return -1


@inlined
def any_change(loads: Loads, theta: float) -> bool:
    """Whether any tie changes its state at a rotation."""
    for i in range(len(loads.ties.state)):  # noqa: SIM110, numba knows no any()
        if new_state(loads.toe, loads.ties, i, theta) >= 0:
            return True
    return False


@inlined
def until_change(loads: Loads, theta: float, omega: float, h: float) -> float:
    """The time within a step after which a tie first changes its state, from just after it; `h` where none does."""
    if len(loads.ties.state) == 0 or not any_change(loads, nystroem(loads, theta, omega, h).theta):
        return h
    low, high = 0.0, h
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if any_change(loads, nystroem(loads, theta, omega, middle).theta):
            high = middle
        else:
            low = middle
    return high


@inlined
def update_states(toe: Toe, ties: WallTies, theta: float, turned: bool) -> None:
    """Bring the states of all ties up to date. One that yields has yielded for good when the wall turns."""
    for i in range(len(ties.state)):
        state = new_state(toe, ties, i, theta)
        if state >= 0:
            ties.state[i] = state
        elif ties.state[i] == YIELDING and turned:
            tie = ties.pulls[i]
            ties.plastic[i] = pulled(tie, theta, toe.side)[0] - tie.strength / tie.stiffness
            ties.state[i] = TAUT


class Rules(NamedTuple):
    """Rules of a run.

    Args:
        one_sided: whether a side stop keeps the rotation from becoming negative.
        least_energy: an impact that leaves less energy than this leaves the wall at rest [J].
        longest: longest step [s].
        duration: of the run [s].
    """

    one_sided: bool
    least_energy: float
    longest: float
    duration: float


CLOCK = row_type(
    [
        *numbers("t", "theta", "omega", "side"),
        *integers("knots", "impacts", "peaks"),
        *flags("at_rest", "fell", "ended"),
    ]
)
"""Where the motion is: time [s], rotation [rad], velocity [rad/s] and side, how many knots, impacts and peaks are
written, and whether the wall rests, lies on its face, and is at the end of the run."""
KNOT = row_type(numbers("t", "theta", "omega", "acceleration"))
"""One end of a step: time [s], rotation [rad], velocity [rad/s] and acceleration [rad/s2]."""
IMPACT = row_type(numbers(*Impact._fields))


class ArcRoom(NamedTuple):
    """Arrays that a run of the loop fills, and the restitution that it reads.

    Args:
        e: restitution of each impact to come [-], as the root of the energy that is left, with the sign of the
            velocity, shape (n,).
        knots: rows of `KNOT` at both ends of each step, shape (n,).
        impacts: rows with the numbers of `mjrock.result.rocking.Impact`, shape (n,).
        peaks: rotation maxima |theta| [rad], shape (n,).
    """

    e: Array
    knots: Rows
    impacts: Rows
    peaks: Array

    @classmethod
    def empty(cls, e: Array) -> ArcRoom:
        """Room for as many impacts as there are restitutions."""
        return cls(e, rows(KNOT, CHUNK), rows(IMPACT, len(e)), np.empty(len(e)))

    def filled(self, clock: Row) -> tuple[Rows | Array, ...]:
        """Copies of the knots, impacts and peaks that are written."""
        parts = (self.knots, clock.knots), (self.impacts, clock.impacts), (self.peaks, clock.peaks)
        return tuple(array[:count].copy() for array, count in parts)


@inlined
def free_moment(toe: Toe, by_ties: float, x: float, z: float) -> float:
    """Moment that holds a resting wall down, over its inertia [1/s2]; a negative one lifts it towards the toe.

    `by_ties` is that of its ties, likewise.
    """
    return toe.P + by_ties + toe.Wd * z + toe.side * toe.Wz * x


@inlined
def uplift(law: RockingLaw, one_sided: bool, t: float, duration: float) -> tuple[float, float]:
    """When a wall that rests at time `t` is lifted, and to which side [s, +1 or -1]. Never is infinity."""
    begun = t
    outer, inner = -acceleration_by_ties(law.outer, law.ties, 0.0), acceleration_by_ties(law.inner, law.ties, 0.0)
    while t < duration:
        push, end = pushed(law.x, law.z, t)
        for toe, by_ties in ((law.outer, outer), (law.inner, inner)):
            if toe.side < 0 and one_sided:
                continue
            now = free_moment(toe, by_ties, push.x, push.z)
            if now < (-1e-9 * toe.P if t == begun else 0.0):
                return t, toe.side
            span = min(end, duration) - t
            then = free_moment(toe, by_ties, push.x + push.x_rate * span, push.z + push.z_rate * span)
            if then < 0 <= now:
                return t + span * now / (now - then), toe.side
        t = end
    return math.inf, 1.0


@inlined
def time_of_end(end: int, loads: Loads, theta: float, omega: float, h: float) -> float:
    """Time within the next `h` at which the wall is at an end of its arc: UPRIGHT, TURNED or LYING [s].

    Newton's method, from the root at a constant acceleration, bounded by bisection. The other arguments are those of
    `nystroem`.
    """
    k1 = acceleration(loads, 0.0, theta, math.sin(theta), math.cos(theta))
    goal = loads.toe.side * ON_ITS_FACE if end == LYING else 0.0
    if end == TURNED:
        start, over, under = omega, -omega, k1
    else:
        start = theta - goal
        closing = math.copysign(math.sqrt(max(0.0, omega * omega - 2 * k1 * start)), start)
        over, under = 2 * start, closing - omega
    low, high, tau = 0.0, h, over / under if under != 0 else 0.0
    if not low < tau < high:
        tau = 0.5 * h
    for _ in range(NEWTON):
        at, speed, _, rate = nystroem(loads, theta, omega, tau)
        value, slope = (speed, rate) if end == TURNED else (at - goal, speed)
        if start * value > 0:
            low = tau
        else:
            high = tau
        better = tau - value / slope if slope != 0 else low
        if abs(better - tau) <= 1e-15 * (1 + h):
            break
        tau = better if low < better < high else 0.5 * (low + high)
    return tau


@inlined
def write_knot(room: ArcRoom, clock: Row, acceleration: float) -> None:
    """Write a knot where the motion is, with its acceleration [rad/s2]."""
    knot = room.knots[clock.knots]
    knot.t, knot.theta, knot.omega, knot.acceleration = clock.t, clock.theta, clock.omega, acceleration
    clock.knots += 1


@inlined
def rebound(room: ArcRoom, law: RockingLaw, least_energy: float, clock: Row) -> None:
    """Let the wall rebound, or rest where it has no more than the least energy [J] left, and write the impact."""
    impact, e, omega = room.impacts[clock.impacts], room.e[clock.impacts], clock.omega
    leaving = math.copysign(1.0, e * omega)
    arriving = (law.outer if clock.side > 0 else law.inner).inertia
    departing = (law.outer if leaving > 0 else law.inner).inertia
    after = e * omega * math.sqrt(arriving / departing)
    impact.t, impact.omega_before, impact.omega_after = clock.t, omega, after
    impact.energy_before, impact.energy_after = 0.5 * arriving * omega * omega, 0.5 * departing * after * after
    clock.omega, clock.side, clock.at_rest = after, math.copysign(1.0, after), impact.energy_after <= least_energy
    clock.impacts += 1


@compiled
def rocking_loop(law: RockingLaw, rules: Rules, clocks: Rows, room: ArcRoom) -> None:
    """Make steps until the room is nearly full, the wall lies on its face, or the run is at its end.

    `clocks` has the row of `CLOCK` that is read and written.
    """
    clock, ties = clocks[0], law.ties
    while clock.knots + 4 < len(room.knots) and max(clock.impacts, clock.peaks) < len(room.peaks) and not clock.ended:
        if clock.at_rest:
            lifted, towards = uplift(law, rules.one_sided, clock.t, rules.duration)
            clock.theta, clock.omega = 0.0, 0.0
            write_knot(room, clock, 0.0)
            if lifted >= rules.duration:
                clock.t, clock.ended = rules.duration, True
                write_knot(room, clock, 0.0)
                break
            clock.t, clock.side, clock.at_rest = lifted, towards, False
        t, theta, omega, side = clock.t, clock.theta, clock.omega, clock.side
        toe = law.outer if side > 0 else law.inner
        push, end = pushed(law.x, law.z, t)
        loads = Loads(toe, ties, push)
        h = until_change(loads, theta, omega, min(rules.longest, end - t, rules.duration - t))
        new_theta, new_omega, k1, k3 = nystroem(loads, theta, omega, h)
        if k1 * k3 < 0 and omega * new_omega >= 0:
            middle = h * k1 / (k1 - k3)  # of the step's extreme velocity
            if middle > 1e-6 * h and nystroem(loads, theta, omega, middle).omega * new_omega < 0:
                h = middle  # the wall turns, and turns again within the step
                new_theta, new_omega, _, k3 = nystroem(loads, theta, omega, h)
        turned = omega * new_omega < 0
        if turned:
            h = time_of_end(TURNED, loads, theta, omega, h)
            new_theta, _, _, k3 = nystroem(loads, theta, omega, h)
            new_omega = 0.0
        hit, fell = side * new_theta <= 0, side * new_theta >= ON_ITS_FACE
        if hit or fell:
            from_rest = hit and theta == 0.0 and side * omega < 0  # released against its stop
            h = 0.0 if from_rest else time_of_end(UPRIGHT if hit else LYING, loads, theta, omega, h)
            _, new_omega, _, k3 = nystroem(loads, theta, omega, h)
            new_theta = 0.0 if hit else side * ON_ITS_FACE
        elif turned and side * omega > 0:
            room.peaks[clock.peaks] = abs(new_theta)
            clock.peaks += 1
        update_states(toe, ties, new_theta, turned)
        write_knot(room, clock, k1)
        clock.t, clock.theta, clock.omega = t + h, new_theta, new_omega
        write_knot(room, clock, k3)
        if hit:
            rebound(room, law, rules.least_energy, clock)
        clock.fell, clock.ended = fell, fell or clock.t >= rules.duration


@dataclass(frozen=True, eq=False)
class RockingMotion:
    """A motion of a rigid wall from impact to impact.

    Args:
        knots, impacts, peaks: as in `ArcRoom`, of the whole motion.
        end: the row of `CLOCK` at the end.
        yielded: elongation that each tie has yielded by each knot [m], infinite once it has broken, shape (n, ties).
    """

    knots: Rows
    impacts: Rows
    peaks: Array
    end: Row
    yielded: Array

    def sample(self, times: Array) -> Array:
        """Rotation [rad] and angular velocity [rad/s] at n increasing times [s], shape (2, n)."""
        t, theta, omega, acceleration = (self.knots[name] for name in KNOT.names or ())
        values, rates = np.column_stack([theta, omega]), np.column_stack([omega, acceleration])
        return interpolated(t.copy(), values, rates, times)[0].T

    @property
    def evaluations(self) -> int:
        """Evaluations of Eq. 1 in the steps, three each, without those that find where a step ends."""
        return 3 * (len(self.knots) // 2)


def rock(case: Case, restitutions: Callable[[int], Array], least_energy: float, rtol: float) -> RockingMotion:
    """Rocking of the wall of a case.

    Args:
        case: the wall, its release, its ties and its ground motion.
        restitutions: gives those of a number of next impacts [-], as the root of the energy that is left; negative
            where the wall leaves to the side that it came from.
        least_energy: an impact that leaves less energy than this leaves the wall at rest [J].
        rtol: sets the longest step, see NYSTROEM.
    """
    law = RockingLaw.from_case(case)
    rules = Rules(case.one_sided, least_energy, (NYSTROEM * rtol) ** 0.25 / law.frequency, case.duration)
    at_rest = case.release_energy == 0
    clocks = rows(CLOCK, 1, theta=case.theta0, omega=case.omega0, side=case.direction, at_rest=at_rest)
    clock = clocks[0]
    for _ in range(3):  # from slack to taut to yielding to taut
        update_states(Toe.from_case(case, case.direction), law.ties, case.theta0, not case.released_outwards)
    room, parts = ArcRoom.empty(restitutions(CHUNK // 4)), []
    while not clock.ended:
        rocking_loop(law, rules, clocks, room)
        parts.append(room.filled(clock))
        past = int(clock.impacts)
        room.e[:] = np.append(room.e[past:], restitutions(past))
        clock.knots = clock.impacts = clock.peaks = 0
    knots, impacts, peaks = map(np.concatenate, zip(*parts, strict=True))
    return RockingMotion(knots, impacts, peaks, clock, yielded(case.pulls, knots["theta"]))
