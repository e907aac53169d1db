"""Slow loading: masonry pushed by an actuator or by a growing horizontal force, with its softening branch.

The load goes on in pieces, each of which carries on the steps of the one before. A piece in which the forces of inertia
are above the share that is allowed is made again at half the rate, and after one far below it the rate doubles.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...bars import Bar
from ...distinct.explicit import solve_explicit
from ...distinct.response import EnergyGainError
from ...notebook import NotebookPicture
from ...problem.masonry.actuator import LARGEST_STROKE, Actuator
from ...problem.masonry.case import MasonryCase
from ...problem.masonry.masonry import Masonry
from ...problem.wall.effect import Effect
from ...quantities import (
    GRAVITY,
    Array,
    Implausible,
    require_kind,
    require_reals,
    require_row,
    require_within,
    shown,
    warn_of,
)
from ...result.problem import required_start
from ...result.response import End, Response, State
from ...result.ties import warn_of_ties
from .limit_analysis import InPlan, horizontal
from .pushover import falls_to_zero

PIECES, POINTS, SAMPLES = 100, 4, 5
"""Pieces of a push, points of the curve in each, and samples of a point."""
SHORTEST_PUSH = 1e-6
"""Least displacement of a push [m]."""
MOST_ATTEMPTS = 5
"""Most times that a piece is made, each at half the rate of the one before."""
USEFUL_RATIO = 0.75
"""Inertia of a piece over that at twice the rate, up to which a lower rate still is of use [-]."""
SHORTEST_PIECE = 0.02
"""Time of the first piece, and the least of any [s]."""
SHARE_TO_SPEED_UP = 0.25
"""Share of the inertia allowed below which the next piece takes half the time [-]."""
MULTIPLIER_STEP, LEAST_MULTIPLIER_STEP = 0.03, 0.001
"""Growth of the multiplier beyond all before it in a piece, over the largest, and its least value [-]. A piece in which
it grows twice as much is cut into halves."""
PIECE_HALVINGS = 3
"""Most times that a piece is cut into halves."""
DRIVER_STIFFNESS = 1e4
"""Stiffness of the driver of all blocks, over their weight divided by the height of the masonry [-]."""
LARGEST_MULTIPLIER = 2.5
"""Largest multiplier of a push [-]."""
DRIVER_DAMPING = 0.5
"""Damping ratio of the driven mass on an actuator that has no damping of its own [-]."""
BLOW_INERTIA = 0.05
"""Force of inertia over what is borne beyond which a point is part of a blow [-]."""
BLOWS_TO_END = 5
"""Pieces in a row that are part of blows at any rate, after which a push along a direction ends."""
WORK_ERROR = 0.02
"""Difference of the work under a curve and the energy gained that is warned of, over the largest energy [-]."""


@dataclass(frozen=True, eq=False, repr=False)
class Push(NotebookPicture):
    """What masonry bears as it is pushed slowly. A point is a mean over its time.

    Args:
        displacement: of the actuator's point along its direction, or of the centroid of all free blocks along the
            direction of the force [m], shape (n,).
        force: what the masonry bears: force of the actuator, or horizontal force over the weight of the free blocks,
            each less inertia and damping of the motion [N] or [-], shape (n,).
        inertia: forces of inertia and of the damping of the motion, likewise, shape (n,): under an actuator the rate of
            the momentum along it, under a direction the growth of the kinetic energy over the displacement.
        ended: why it stopped, in words.
        answer: the last piece of the motion, whose `end` carries on.
        unit: of the force, "N" or "-".
        energy: potential and elastic energy that the masonry has gained, and what friction, dashpots, bonds and ties
            have taken, since the push began [J], shape (n,). The work under the curve equals it where the motion is
            slow.
    """

    displacement: Array
    force: Array
    inertia: Array
    ended: str
    answer: Response = field(repr=False)
    unit: str = "N"
    energy: Array = field(kw_only=True)

    @property
    def peak(self) -> float:
        """The largest force either way [N] or multiplier [-], of points whose force of inertia is up to 5 % of it.

        Blocks that have given way strike each other, and what they bear in a blow is no strength of the masonry.
        """
        return float(np.abs(self.force[self._peak_at]))

    @property
    def way(self) -> Array:
        """The direction, a unit vector along x or in space along x, y and z, shape (2,) or (3,)."""
        driver = self.answer.case.effects[-1]
        assert isinstance(driver, Actuator)
        return np.array(driver.direction)

    @property
    def d_0(self) -> float:
        """Displacement beyond the peak at which nothing is borne any more [m]; NaN where the curve ends before it."""
        return falls_to_zero(self.displacement[self._peak_at :], self.force[self._peak_at :])

    @property
    def inertia_share(self) -> float:
        """Root mean square of the forces of inertia over the whole curve, over the peak [-]."""
        return float(np.sqrt(np.mean(self.inertia**2)) / self.peak)

    @property
    def _peak_at(self) -> int:
        """The point of the peak."""
        return int(without_blows(np.abs(self.force) if self.unit == "N" else self.force, self.inertia).argmax())

    def __repr__(self) -> str:
        peak = f"{self.peak / 1e3:.4g} kN" if self.unit == "N" else f"{self.peak:.4g} of the weight"
        return (
            f"<Push: {len(self.force)} points to {np.abs(self.displacement).max():.3g} m, peak {peak}, "
            f"inertia {self.inertia_share:.2%} of it, {self.ended}>"
        )


def push(
    masonry: Masonry,
    driver: Actuator | float | ArrayLike,
    to: float | ArrayLike,
    *,
    angle: InPlan = None,
    effects: Sequence[Effect] | Effect = (),
    inertia: float = 0.01,
    mass_damping: float = 0.0,
    local_damping: float = 0.0,
    falls_to: float = 0.0,
    start: State | End | None = None,
) -> Push:
    """Force and displacement of masonry that is pushed slowly, with the branch on which the force falls.

    An actuator is driven to displacements one after the other, to and fro for a cyclic test. A direction is that of a
    horizontal force on every block in proportion to its weight. The force is the one that lets the common centroid of
    the blocks move slowly along the direction, so that its work is what the masonry gains and what is taken in it. It
    ends before `to` where nothing is borne any more and the masonry would go on by itself, and where five pieces in a
    row are blows at any rate, as where blocks have left the mechanism and strike others.

    Args:
        masonry: the masonry.
        driver: the actuator, whose own history plays no part, or the direction: 1 along x, -1 against it, or in space a
            vector in plan, shape (2,), of any length.
        to: displacement at which to stop [m], or those at which to turn back and to stop; for a direction one number.
        angle: of the direction in plan, from x towards y [rad], -2 pi to 2 pi, in space; it takes the place of
            `driver`.
        effects: further effects, such as a `Load` that stays.
        inertia: forces of inertia and of the damping of the motion that are allowed in a piece, root mean square over
            the largest force so far [-], 1e-4 to 0.5. Where blocks give way at once they are larger at any rate.
        mass_damping, local_damping: of the motion, see `solve_explicit`.
        falls_to: share of the largest force so far at which to stop [-], 0 to 1; 0 goes on to the displacement, as a
            cyclic push has to.
        start: the `end` of the answer of an earlier push with the same driver.

    Returns:
        The `Push`: displacement [m] and force [N] or multiplier [-], their `peak`, and the `answer` at the end.

    Raises:
        TypeError, ValueError: for a value outside its range, or masonry that does not stand.
        RuntimeError: where undamped masonry swings so long that its steps gain energy.

    Warns:
        UserWarning: where the motion was not slow: where the work under the curve is not the energy that was gained, or
            the forces of inertia are above 5 % of the peak.
    """
    require_kind("masonry", masonry, Masonry)
    allowed = require_within("inertia", inertia, 1e-4, 0.5)
    falls_to = require_within("falls_to", falls_to, 0.0, 1.0)
    turns = require_row("to", np.atleast_1d(require_reals("to", to, "displacements")), "displacement")
    require_within("to", float(turns[np.abs(turns).argmax()]), -LARGEST_STROKE, LARGEST_STROKE, "m")
    if turns.any():
        require_within("to", float(np.abs(turns).max()), SHORTEST_PUSH, LARGEST_STROKE, "m")
    case = _required_case(masonry, effects, start)
    pushed = case, start, mass_damping, local_damping
    if isinstance(driver, Actuator) and angle is None:
        return _pushed_in_pieces(
            ActuatorRun(*pushed, _with_damping(driver, _driven_mass(driver, case)), turns), allowed, falls_to
        )
    if isinstance(driver, Actuator):
        raise ValueError(f"angle = {shown(angle)} is for a direction; an Actuator has one of its own")
    actuator = _driver_of_all_blocks(case, horizontal(masonry, driver, angle, "driver"))
    if len(turns) != 1 or turns[0] <= 0:
        raise ValueError(f"to = {shown(to)}: a direction goes with one displacement above 0, an Actuator with others")
    return _pushed_in_pieces(ForceRun(*pushed, actuator, float(turns[0])), allowed, falls_to)


def _required_case(masonry: Masonry, effects: Sequence[Effect] | Effect, start: object) -> MasonryCase:
    """The masonry with the effects that stay, where steps take them and the start."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Implausible)
        case = MasonryCase(masonry, 1.0, effects=effects)  # type: ignore[arg-type]
    if start is not None:
        required_start(start, case, remembers=True)
    return case


class Piece(NamedTuple):
    """A piece of a push.

    Args:
        displacement, force, inertia, energy: of its points, see `Push`, shape (n,).
        answer: its motion.
        level: displacement of the actuator at its end [m].
        compression: of the spring of the actuator then [m].
        energy_gained: that the masonry has gained by then, since the push began [J].
    """

    displacement: Array
    force: Array
    inertia: Array
    energy: Array
    answer: Response
    level: float
    compression: float
    energy_gained: float


def without_blows(borne: Array, inertia: Array) -> Array:
    """What is borne, below nothing at points that are part of a blow."""
    return np.where(np.abs(inertia) <= BLOW_INERTIA * borne, borne, -1.0)


def means(values: Array) -> Array:
    """Means of samples over the time of each point, by the trapezoidal rule."""
    between = 0.5 * (values[1:] + values[:-1])
    return np.asarray(between.reshape(POINTS, SAMPLES).mean(axis=1))


def free_masses(case: MasonryCase) -> Array:
    """Mass of each block that is not fixed, with the masses added to it [kg], shape (free,)."""
    return case.masses[list(case.masonry.free)]


def weight_of(case: MasonryCase) -> float:
    """Weight of the free blocks and of the masses added to them [N]."""
    return GRAVITY * float(free_masses(case).sum())


def of_centroid(case: MasonryCase, motion: Array, way: Array, blocks: Sequence[str] | None = None) -> Array:
    """Displacement [m] or velocity [m/s] of the common centroid of the free blocks along a unit vector, shape (n,).

    Args:
        case: the masonry and its effects.
        motion: poses or velocities of the free blocks, shape (n, free, nq).
        way: the unit vector, shape (d,).
        blocks: names of those that count; None are all.
    """
    mass = free_masses(case)
    if blocks is not None:
        mass = np.where([case.masonry.names[i] in blocks for i in case.masonry.free], mass, 0.0)
    return np.asarray((motion[..., : len(way)] @ way) @ mass / mass.sum())


@dataclass
class PushRun:
    """An actuator that goes on slowly.

    Args:
        case: the masonry and the effects that stay.
        start, mass_damping, local_damping: see `push`.
        actuator: its own history plays no part.
    """

    case: MasonryCase
    start: State | End | None
    mass_damping: float
    local_damping: float
    actuator: Actuator
    level: float = field(default=0.0, init=False)
    energy: float = field(default=0.0, init=False)
    largest_force: float = field(default=0.0, init=False)
    unit, weight = "N", 1.0

    def path(self, duration: float) -> tuple[Array, Array]:
        """Where the actuator goes next: times [s] and displacements from where it is [m], of the same shape."""
        raise NotImplementedError

    def piece(self, duration: float) -> Piece:
        """The next piece, in about this duration [s]."""
        t, path = self.path(duration)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Implausible)  # the motion is that of a piece
            driven = replace(self.actuator, displacement=(t, path))
            case = replace(self.case, duration=t[-1], effects=(*self.case.effects, driven))
            warnings.filterwarnings("ignore", "explicit steps would take")  # the push has a bar of its own
            warnings.filterwarnings("ignore", "the ledger does not close")  # the work under the curve is checked
            warnings.filterwarnings("ignore", ".* was drawn out by")  # the push warns at its end
            answer = self._answer(case)
        *_, force = answer.actuators.values()  # effects may have others
        advance = np.interp(answer.t, t, path)
        compression, inertia = self.compression_at(answer, force, advance), self.inertia(answer, advance)
        displacement, energy = self.level + advance - compression, self._energy_gained(answer, compression)
        return Piece(
            displacement=means(displacement),
            force=means(force) - inertia,
            inertia=inertia,
            energy=means(energy),
            answer=answer,
            level=self.level + float(advance[-1]),
            compression=float(compression[-1]),
            energy_gained=float(energy[-1]),
        )

    def _answer(self, case: MasonryCase) -> Response:
        """The motion of a piece.

        Raises:
            EnergyGainError: where steps gain energy. They gain a share of what swings in each period, so that undamped
                masonry that has cracked gains much in a long piece.
            RuntimeError: where the motion is not finite.
        """
        spacing = case.duration / (POINTS * SAMPLES)
        try:
            return solve_explicit(
                case,
                output_step=spacing,
                ledger=True,
                start=self.start,
                mass_damping=self.mass_damping,
                local_damping=self.local_damping,
            )
        except RuntimeError as broken:
            failure = str(broken).partition("; take ")[0]
            piece = f"in a piece of the push of {case.duration:.3g} s at {1e3 * self.level:.4g} mm"
            remedy = "make what drives it less stiff"
            if isinstance(broken, EnergyGainError):
                damped = "local_damping = 0.1 or mass_damping = 5, or its joints by xi"
                remedy = f"masonry that has given way swings; damp its motion by {damped}"
            raise type(broken)(f"{failure}, {piece}: {remedy}") from None

    def compression_at(self, answer: Response, force: Array, advance: Array) -> Array:
        """How far the spring of the actuator is pressed at the samples [m], without the part of its dashpot."""
        return force / self.actuator.stiffness

    def inertia(self, answer: Response, advance: Array) -> Array:
        """Force of inertia and of the damping of the motion along the direction, in the mean of each point [N]."""
        raise NotImplementedError

    def _energy_gained(self, answer: Response, compression: Array) -> Array:
        """What the masonry has gained and what was taken in it at the samples of a piece, see `Push.energy` [J].

        The spring and the dashpot of the actuator have no part in it, nor has the damping that is not in the curve.
        """
        ledger, driving = answer.ledger, list(answer.actuators)[-1]
        assert ledger is not None
        others = sum((work for name, work in ledger.put_in.items() if name != driving), np.zeros(len(answer.t)))
        of_actuator = ledger.dashpots[driving] + 0.5 * self.actuator.stiffness * compression**2
        total = sum(ledger.taken.values(), ledger.potential + ledger.elastic)
        total = total - others - of_actuator - self._mass_damping_work(answer)
        return np.asarray(self.energy + total - total[0])

    def _mass_damping_work(self, answer: Response) -> Array:
        """What damping in proportion to mass has taken at the samples of a piece [J]."""
        assert answer.ledger is not None
        power = 2 * self.mass_damping * answer.ledger.kinetic
        return np.append(0.0, np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(answer.t)))

    def accept(self, piece: Piece) -> None:
        """Go on from the end of a piece."""
        self.start, self.level, self.energy = piece.answer.end, piece.level, piece.energy_gained
        self.largest_force = max(self.largest_force, float(without_blows(np.abs(piece.force), piece.inertia).max()))

    def inertia_share(self, piece: Piece) -> float:
        """Root mean square of the inertia in a piece, over the largest force so far [-]."""
        largest = max(self.largest_force, float(np.abs(piece.force).max()))
        return float(np.sqrt(np.mean(piece.inertia**2))) / largest

    def next_duration(self, duration: float, share: float, allowed: float) -> float:
        """Time of the next piece [s], from that of the last and its inertia, over the largest force, and what is
        allowed [-]."""
        return max(0.5 * duration, SHORTEST_PIECE) if share < SHARE_TO_SPEED_UP * allowed else duration

    def ending(self, piece: Piece) -> str:
        """Why it ends after a piece, or nothing."""
        raise NotImplementedError


@dataclass
class ActuatorRun(PushRun):
    """An actuator that goes from one displacement to the next.

    Args:
        turns: the displacements [m], shape (n,).
    """

    turns: Array

    def __post_init__(self) -> None:
        goals = np.concatenate([[0.0], self.turns])
        share = np.abs(np.diff(goals)) / max(float(np.abs(np.diff(goals)).sum()), 1e-12)
        legs = [
            np.linspace(a, b, max(2, math.ceil(PIECES * part) + 1))[1:]
            for a, b, part in zip(goals[:-1], goals[1:], share, strict=True)
        ]
        begun = legs[0][0] * 2.0 ** np.arange(-4, 0)  # the joints close
        self.levels = list(np.concatenate([begun, *legs]))

    def path(self, duration: float) -> tuple[Array, Array]:
        """To the next displacement."""
        return np.array([0.0, duration]), np.array([0.0, self.levels[0] - self.level])

    def inertia(self, answer: Response, advance: Array) -> Array:
        """The rate of momentum along the direction, with the part of it that is damped away."""
        direction = np.array(self.actuator.direction)
        momentum = (answer.velocity[:, :, : len(direction)] @ direction) @ free_masses(self.case)
        rate = np.diff(momentum[::SAMPLES]) / np.diff(answer.t[::SAMPLES])
        return np.asarray(rate + self.mass_damping * means(momentum))

    def accept(self, piece: Piece) -> None:
        """Go on to the level after that."""
        super().accept(piece)
        del self.levels[0]

    def ending(self, piece: Piece) -> str:
        """At the last level."""
        return "" if self.levels else f"reached {1e3 * piece.level:.4g} mm"


@dataclass
class ForceRun(PushRun):
    """A horizontal force on every block in proportion to its weight, which drives their common centroid.

    Args:
        to: displacement of the centroid at which it ends [m].
    """

    to: float
    unit = "-"

    def __post_init__(self) -> None:
        self.weight = weight_of(self.case)
        self.least = min(LEAST_MULTIPLIER_STEP * self.weight / self.actuator.stiffness, self.to / PIECES)
        speed = 0.0 if self.start is None else float(of_centroid(self.case, self.start[1], self.actuator.direction))
        self.speed, self.compression, self.blows = max(speed, 0.0), math.nan, 0
        self.step = max(self.least, self.speed * SHORTEST_PIECE)

    @property
    def multiplier_step(self) -> float:
        """Growth of the multiplier in a piece [-]."""
        return max(MULTIPLIER_STEP * self.largest_force, LEAST_MULTIPLIER_STEP)

    def path(self, duration: float) -> tuple[Array, Array]:
        """Further by a step; the speed changes evenly from the present one to that of a step in this duration."""
        speed = self.step / duration
        t = np.linspace(0.0, 2 * self.step / (self.speed + speed), POINTS * SAMPLES + 1)
        return t, (self.speed + 0.5 * (speed - self.speed) * t / t[-1]) * t

    def piece(self, duration: float) -> Piece:
        """The piece with multipliers in place of forces, cut where they grow by too much."""
        piece = self.as_multipliers(super().piece(duration))
        for _ in range(PIECE_HALVINGS):
            if self.is_blow(piece) or self.growth(piece) <= 2 * self.multiplier_step or self.step <= self.least:
                break
            self.step = max(0.5 * self.step, self.least)
            piece = self.as_multipliers(super().piece(duration))
        return piece

    def as_multipliers(self, piece: Piece) -> Piece:
        """A piece with multipliers in place of forces."""
        return piece._replace(force=piece.force / self.weight, inertia=piece.inertia / self.weight)

    def is_blow(self, piece: Piece) -> bool:
        """Whether a piece is part of a blow."""
        return self.inertia_share(piece) > BLOW_INERTIA

    def growth(self, piece: Piece) -> float:
        """By how much the largest multiplier of a piece exceeds all before [-]."""
        return float(piece.force.max()) - self.largest_force

    def compression_at(self, answer: Response, force: Array, advance: Array) -> Array:
        """From how far the centroid has moved. One that carries on counts from where the blocks are."""
        moved = of_centroid(self.case, answer.pose, self.actuator.direction)
        if math.isnan(self.compression):
            self.compression = float(force[0]) / self.actuator.stiffness
            if self.start is not None:
                self.level, self.largest_force = float(moved[0]) + self.compression, float(force[0]) / self.weight
        return np.asarray(self.compression + advance - (moved - moved[0]))

    def inertia(self, answer: Response, advance: Array) -> Array:
        """The growth of the kinetic energy, with what was damped away, over the displacement of what drives."""
        assert answer.ledger is not None
        kinetic = answer.ledger.kinetic + self._mass_damping_work(answer)
        return np.asarray(np.diff(kinetic[::SAMPLES]) / np.diff(advance[::SAMPLES]))

    def accept(self, piece: Piece) -> None:
        """Go on from the end of a piece, with the step in which the multiplier would grow as it is to."""
        share = 2.0 if self.is_blow(piece) else self.multiplier_step / max(self.growth(piece), 1e-9)
        self.speed = 2 * self.step / piece.answer.t[-1] - self.speed
        self.blows = self.blows + 1 if self.is_blow(piece) else 0
        self.step = min(max(self.step * min(max(share, 0.5), 2.0), self.least), self.to / PIECES)
        super().accept(piece)
        self.compression = piece.compression

    def next_duration(self, duration: float, share: float, allowed: float) -> float:
        """The speed of the centroid grows no faster than the force of inertia that is allowed, half as fast in
        energy: blocks that turn have more of it."""
        gained = GRAVITY * allowed * self.largest_force * self.step if share < SHARE_TO_SPEED_UP * allowed else 0.0
        return max(self.step / math.sqrt(self.speed**2 + gained), SHORTEST_PIECE)

    def ending(self, piece: Piece) -> str:
        """Where the centroid has moved, nothing gives way, or nothing is borne any more."""
        if piece.displacement[-1] > self.to:
            return f"moved by {1e3 * self.to:.4g} mm"
        if self.is_blow(piece):
            at = 1e3 * piece.displacement[-1]
            return f"ends in blows at {at:.4g} mm" if self.blows == BLOWS_TO_END else ""
        if piece.force[-1] < 0 and self.largest_force > LEAST_MULTIPLIER_STEP:
            return f"goes on by itself from {1e3 * piece.displacement[-1]:.4g} mm"
        return f"nothing gives way to {LARGEST_MULTIPLIER:g}" if piece.force[-1] >= LARGEST_MULTIPLIER else ""


def _pushed_in_pieces(run: PushRun, allowed: float, falls_to: float) -> Push:
    """The pieces of a push until one ends it."""
    points, ended, duration = list[tuple[Array, ...]](), "", SHORTEST_PIECE
    with Bar("push", "pieces") as bar:
        while not ended:
            piece, share = run.piece(duration), math.inf
            for _ in range(MOST_ATTEMPTS - 1):
                before, share = share, run.inertia_share(piece)
                if share <= allowed or share > USEFUL_RATIO * before:
                    break
                duration *= 2
                piece = run.piece(duration)
            share = run.inertia_share(piece)
            run.accept(piece)
            duration = run.next_duration(duration, share, allowed)
            points.append(piece[:4])
            fallen = float(np.abs(piece.force).max()) < falls_to * run.largest_force
            ended = run.ending(piece) or (f"fell to {falls_to:.0%} of its peak" if fallen else "")
            bar.add()
    displacement, force, inertia, energy = (np.concatenate(part) for part in zip(*points, strict=True))
    push = Push(displacement, force, inertia, ended, piece.answer, run.unit, energy=energy)
    warn_if_fast(push, run.weight)
    warn_of_ties(piece.answer.case, piece.answer.plastic)
    return push


def warn_if_fast(push: Push, weight: float) -> None:
    """Warn where a push was not slow. The weight [N] is 1 for forces."""
    steps = 0.5 * (push.force[1:] + push.force[:-1]) * np.diff(push.displacement)
    beside = np.cumsum(weight * steps) - (push.energy[1:] - push.energy[0])
    off = float(np.abs(beside).max() / np.ptp(push.energy)) if np.ptp(push.energy) > 0 else 0.0
    if off > WORK_ERROR or push.inertia_share > BLOW_INERTIA:
        at = 1e3 * push.displacement[np.abs(push.inertia).argmax()]
        warn_of(
            f"the push was not slow: forces of inertia are {push.inertia_share:.1%} of the peak, most at {at:.4g} mm, "
            f"and the work under the curve is up to {off:.1%} beside the energy gained. Blocks that fall or strike "
            "each other take part in no slow push: end it before they do, or lower inertia"
        )


def _driver_of_all_blocks(case: MasonryCase, way: Array) -> Actuator:
    """What drives all blocks along a unit vector."""
    masonry, weight = case.masonry, weight_of(case)
    heights = np.concatenate([part.corners[:, -1] for i in masonry.free for part in masonry.blocks[i].parts])
    return _with_damping(
        Actuator(None, None, way, None, DRIVER_STIFFNESS * weight / float(np.ptp(heights))), weight / GRAVITY
    )


def _driven_mass(actuator: Actuator, case: MasonryCase) -> float:
    """Mass of what an actuator drives [kg]."""
    masonry = case.masonry
    if actuator.block is None:
        return weight_of(case) / GRAVITY
    block = masonry.names.index(actuator.block) if isinstance(actuator.block, str) else actuator.block
    return masonry.blocks[block].mass


def _with_damping(actuator: Actuator, mass: float) -> Actuator:
    """An actuator that damps the swing of a mass on it."""
    if actuator.damping > 0:
        return actuator
    return replace(actuator, damping=2 * DRIVER_DAMPING * math.sqrt(actuator.stiffness * mass))
