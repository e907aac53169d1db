"""Slow loading: masonry pushed by an actuator or by a horizontal force that grows, with what it bears after its peak.

The load goes on in pieces, each of which carries on the steps of the one before. A piece in which the forces of inertia
are above the share that is allowed is made again at half the rate, and after one far below it the rate doubles.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from tqdm import tqdm

from ..distinct.explicit import solve_explicit
from ..problem.ground.motion import GroundMotion
from ..problem.masonry.actuator import LARGEST, Actuator
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.effects import laden
from ..problem.masonry.masonry import Masonry
from ..problem.wall.effect import Effect
from ..quantities import GRAVITY, Array, Implausible, require_kind, require_row, require_within, shown
from ..result.response import Response

PIECES, POINTS, SAMPLES = 100, 4, 5
"""Pieces of a push, points of the curve in each, and samples of a point."""
TRIES = 5
"""How often a piece is made again at half the rate."""
FIRST = 0.02
"""Time of the first piece and of the shortest one [s]."""
QUIET = 0.25
"""Share of the inertia allowed below which the next piece takes half the time [-]."""
LONGEST = 0.5
"""Longest step of the motion that is a force that grows [s]."""
RISE = 0.002
"""Growth of the multiplier in a piece [-]."""
BEYOND = 1.02
"""Multiplier over what is borne from which it does not grow any more [-]."""
PART = 0.05
"""Largest motion in a piece, over the displacement at which the push ends, beyond which a piece is cut [-]."""
HIGHEST = 2.5
"""Largest multiplier of a push [-]."""
DAMPED = 0.5
"""Damping ratio of the block on an actuator that has no damping of its own [-]."""
STRIKING = 0.05
"""Force of inertia over what is borne beyond which a point is part of a blow [-]."""


@dataclass(frozen=True, eq=False, repr=False)
class Push:
    """What masonry bears as it is pushed slowly. A point is a mean over its time.

    Args:
        displacement: of the actuator's point along its direction, or of the centroid of all free blocks along the
            direction of the force [m], shape (n,).
        force: what the masonry bears: force of the actuator, or horizontal force over the weight of the free blocks,
            each less inertia and damping of the motion [N] or [-], shape (n,).
        inertia: forces of inertia and of the damping of the motion along the direction, likewise, shape (n,).
        ended: why it stopped, in words.
        answer: the last piece of the motion, whose `end` carries on.
        unit: of the force, "N" or "-".
    """

    displacement: Array
    force: Array
    inertia: Array
    ended: str
    answer: Response = field(repr=False)
    unit: str = "N"

    @property
    def peak(self) -> float:
        """The largest force either way [N] or multiplier [-], of points whose force of inertia is below 5 % of it.

        Blocks that have given way strike each other, and what they bear in a blow is no strength of the masonry. Under
        a force that grows nothing holds them back, so that no point after the first blow counts.
        """
        return float(np.abs(self.force[self._peak_at]))

    @property
    def inertia_share(self) -> float:
        """Root mean square of the forces of inertia up to the peak, over the peak [-]."""
        return float(np.sqrt(np.mean(self.inertia[: self._peak_at + 1] ** 2)) / self.peak)

    @property
    def _peak_at(self) -> int:
        """The point of the peak."""
        borne, inertia = np.abs(self.force), np.abs(self.inertia)
        slow = inertia <= STRIKING * borne
        if self.unit == "-":
            slow &= np.cumsum(inertia > STRIKING * borne.max()) == 0
        return int(np.where(slow, borne, -1.0).argmax())

    def __repr__(self) -> str:
        return (
            f"<Push: {len(self.force)} points to {np.abs(self.displacement).max():.3g} m, peak {self.peak:.4g} "
            f"{self.unit}, inertia {self.inertia_share:.2%} of it, {self.ended}>"
        )


def push(
    masonry: Masonry,
    driver: Actuator | float,
    to: float | ArrayLike,
    *,
    effects: Sequence[Effect] | Effect = (),
    inertia: float = 0.01,
    mass_damping: float = 0.0,
    local_damping: float = 0.0,
    falls_to: float = 0.0,
    start: Any = None,
) -> Push:
    """Force and displacement of masonry that is pushed slowly, with the branch on which the force falls.

    An actuator is driven to displacements one after the other, to and fro for a cyclic test. A direction, 1 or -1 along
    x, is that of a horizontal force on every block in proportion to its weight, which grows until it is no longer
    borne; then the blocks move on, and the curve has what they bear as they move.

    Args:
        masonry: the masonry.
        driver: the actuator, whose own history plays no part, or 1 or -1.
        to: displacement at which to stop [m], or those at which to turn back and to stop; for a direction one number.
        effects: further effects, such as a `Load` that stays.
        inertia: forces of inertia and of the damping of the motion that are allowed in a piece, root mean square over
            the largest force so far [-], 1e-4 to 0.5. Where blocks give way at once they are larger at any rate.
        mass_damping, local_damping: of the motion, see `solve_explicit`.
        falls_to: share of the largest force so far at which to stop [-], 0 to 1; 0 goes on to the displacement, as a
            cyclic push has to.
        start: the `end` of the answer of an earlier push.

    Returns:
        The `Push`: displacement [m] and force [N] or multiplier [-], their `peak`, and the `answer` at the end.

    Raises:
        TypeError, ValueError: for a value outside its range, or masonry that does not stand.
    """
    require_kind("masonry", masonry, Masonry)
    allowed = require_within("inertia", inertia, 1e-4, 0.5)
    falls_to = require_within("falls_to", falls_to, 0.0, 1.0)
    turns = require_row("to", np.atleast_1d(np.asarray(to)), "displacement")
    require_within("to", float(turns[np.abs(turns).argmax()]), -LARGEST, LARGEST, "m")
    given = tuple(effects) if isinstance(effects, Sequence) else (effects,)
    options = {"mass_damping": mass_damping, "local_damping": local_damping}
    if isinstance(driver, Actuator):
        load: Load = Driven(masonry, given, options, start, _damped(driver, masonry), turns)
    elif driver in (1, -1) and len(turns) == 1 and turns[0] > 0:
        load = Forced(masonry, given, options, start, float(driver), float(turns[0]))
    else:
        raise ValueError(
            f"driver = {shown(driver)} with to = {shown(to)}: it is an Actuator, or 1 or -1 with one displacement "
            "above 0"
        )
    return _pushed(load, allowed, falls_to)


class Piece(NamedTuple):
    """A piece of a push: its points, what was borne, its answer, and the level of the load at its end."""

    displacement: Array
    force: Array
    inertia: Array
    answer: Response
    level: float


@dataclass
class Load:
    """A load that grows slowly.

    Args:
        masonry, effects, options, start: see `push`.
    """

    masonry: Masonry
    effects: tuple[Effect, ...]
    options: dict[str, Any]
    start: Any
    level: float = field(default=0.0, init=False)
    unit = "N"

    def piece(self, duration: float) -> Piece:
        """The next piece, in so much time [s]."""
        raise NotImplementedError

    def accept(self, piece: Piece) -> None:
        """Go on from the end of a piece."""
        self.start, self.level = piece.answer.end, piece.level

    @property
    def may_slow(self) -> bool:
        """Whether a longer time makes a piece quieter."""
        return True

    def done(self, piece: Piece) -> str:
        """Why it ends after a piece, or nothing."""
        raise NotImplementedError

    def _answer(self, duration: float, *driven: Effect, motion: GroundMotion | None = None) -> Response:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Implausible)  # the motion is that of a piece
            case = MasonryCase(self.masonry, duration, motion=motion, effects=(*self.effects, *driven))
            warnings.filterwarnings("ignore", "explicit steps would take")  # the push has a bar of its own
            return solve_explicit(case, output_step=duration / (POINTS * SAMPLES), start=self.start, **self.options)

    def _inertia(self, answer: Response, way: Array) -> Array:
        """Force of inertia and of the damping of the motion along a direction, in the mean of each point [N]."""
        mass = laden(self.masonry, self.effects)[0][list(self.masonry.free)]
        momentum = (answer.velocity[:, :, : len(way)] @ way) @ mass
        grown = np.diff(momentum[::SAMPLES]) / np.diff(answer.t[::SAMPLES])
        return np.asarray(grown + self.options["mass_damping"] * means(momentum))


def means(values: Array) -> Array:
    """Means of samples over the time of each point, by the trapezoidal rule."""
    between = 0.5 * (values[1:] + values[:-1])
    return np.asarray(between.reshape(POINTS, SAMPLES).mean(axis=1))


@dataclass
class Driven(Load):
    """An actuator that goes from one displacement to the next.

    Args:
        actuator: its own history plays no part.
        turns: the displacements [m], shape (n,).
    """

    actuator: Actuator
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

    def piece(self, duration: float) -> Piece:
        """The actuator goes on to its next level."""
        goal = float(self.levels[0])
        driven = replace(self.actuator, displacement=((0.0, duration), (0.0, goal - self.level)))
        answer = self._answer(duration, driven)
        *_, force = answer.actuators.values()  # effects may have others
        pushed = means(force)
        place = self.level + means(answer.t) / duration * (goal - self.level) - pushed / self.actuator.stiffness
        inertia = self._inertia(answer, driven.way)
        return Piece(place, pushed - inertia, inertia, answer, goal)

    def accept(self, piece: Piece) -> None:
        """Go on to the level after that."""
        super().accept(piece)
        del self.levels[0]

    def done(self, piece: Piece) -> str:
        """At the last level."""
        return "" if self.levels else f"reached {1e3 * piece.level:.4g} mm"


@dataclass
class Forced(Load):
    """A horizontal force on every block in proportion to its weight.

    Args:
        side: 1 along x, -1 against it.
        to: displacement of the centroid at which it ends [m].
    """

    side: float
    to: float
    unit = "-"

    def __post_init__(self) -> None:
        self.held, self.cut, self.moved = False, False, 0.0

    @property
    def may_slow(self) -> bool:
        """Until the blocks move on by themselves."""
        return not self.held

    def piece(self, duration: float) -> Piece:
        """The force grows by RISE, or stays once it is no longer borne. A piece in which the blocks move far is cut."""
        rise = 0.0 if self.held else RISE
        piece, self.cut = self._grown(duration, rise), False
        while piece is None or (self._gives_way(piece) and duration > FIRST):
            duration, rise, self.cut = 0.5 * duration, 0.5 * rise, True
            piece = self._grown(duration, rise)
        return piece

    def _gives_way(self, piece: Piece) -> bool:
        return abs(float(piece.displacement[-1]) - self.moved) > PART * self.to

    def _grown(self, duration: float, rise: float) -> Piece | None:
        """A piece in which the force grows so far, or None where blocks have fallen before its end."""
        level = self.level + rise
        count = math.ceil(duration / LONGEST)
        ramp = np.append(np.linspace(self.level, level, count + 1), level)
        answer = self._answer(duration, motion=GroundMotion(-self.side * GRAVITY * ramp, duration / count))
        if len(answer.t) <= POINTS * SAMPLES:
            return None
        mass = laden(self.masonry, self.effects)[0][list(self.masonry.free)]
        way = self.side * np.eye(3 if self.masonry.in_space else 2)[0]
        inertia = self._inertia(answer, way) / (GRAVITY * mass.sum())
        borne = np.interp(means(answer.t), [0.0, duration], [self.level, level]) - inertia
        moved = (answer.pose[:, :, : len(way)] @ way) @ mass / mass.sum()
        return Piece(means(moved), borne, inertia, answer, level)

    def accept(self, piece: Piece) -> None:
        """Go on, with the force as it is where it was not borne or the blocks gave way."""
        super().accept(piece)
        self.moved = float(piece.displacement[-1])
        self.held = self.cut or piece.level > BEYOND * float(piece.force.mean())

    def done(self, piece: Piece) -> str:
        """Where the centroid has moved, or nothing gives way."""
        if piece.displacement[-1] > self.to:
            return f"moved by {1e3 * self.to:.4g} mm"
        return f"nothing gives way to {HIGHEST:g}" if piece.level >= HIGHEST else ""


def _pushed(load: Load, allowed: float, falls_to: float) -> Push:
    """The pieces of a push until one ends it."""
    points, ended, duration, largest = [], "", FIRST, 0.0
    with tqdm(desc="push", delay=3, disable=None, leave=False) as bar:
        while not ended:
            for attempt in range(TRIES):
                piece = load.piece(duration)
                share = float(np.sqrt(np.mean(piece.inertia**2))) / max(largest, float(np.abs(piece.force).max()))
                if share <= allowed or not load.may_slow or attempt == TRIES - 1:
                    break
                duration *= 2
            load.accept(piece)
            if share < QUIET * allowed or not load.may_slow:
                duration = max(0.5 * duration, FIRST) if load.may_slow else FIRST
            points.append(piece[:3])
            largest = max(largest, float(np.abs(piece.force).max()))
            fallen = float(np.abs(piece.force).max()) < falls_to * largest
            ended = load.done(piece) or (f"fell to {falls_to:.0%} of its peak" if fallen else "")
            bar.update()
    displacement, force, inertia = (np.concatenate(part) for part in zip(*points, strict=True))
    return Push(displacement, force, inertia, ended, piece.answer, load.unit)


def _damped(actuator: Actuator, masonry: Masonry) -> Actuator:
    """An actuator that damps the swing of its block on it."""
    if actuator.damping > 0:
        return actuator
    block = masonry.names.index(actuator.block) if isinstance(actuator.block, str) else actuator.block
    return replace(actuator, damping=2 * DAMPED * math.sqrt(actuator.stiffness * masonry.blocks[block].mass))
