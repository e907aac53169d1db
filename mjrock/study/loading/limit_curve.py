"""The push that rigid masonry bears as its mechanism goes on, by limit analysis in one pose after the other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array, vstack

from ...geometry.frames import PLANE, SPACE
from ...geometry.poses import at_rest, moved
from ...linear import rates_of
from ...problem.masonry.limit.collapse import Collapse, UnbalancedError
from ...problem.masonry.limit.pose import Moves, gaps_of
from ...problem.masonry.lines import free_numbers
from ...problem.masonry.masonry import Masonry
from ...problem.wall.effect import Effect
from ...quantities import Array, Flags, Integers, named, require_kind, require_whole, require_within
from .limit_analysis import collapse_multiplier, horizontal

STAYS = 1e-6
"""Rate below which a line neither opens nor slides, over the largest of the mechanism [-]."""
ROUNDED, TURNS = 1e-12, 20
"""What lines that stay may miss, over the size of the masonry [-], and most turns of the search for it."""
PRESSED = 1e-6
"""Normal force of a joint that counts as none, over the largest [-]."""
BEHIND = 0.1
"""How far a line that closes may lie behind its face, over the tolerance of the masonry [-]."""
HALVINGS = 40
"""How often a step is halved at most in the search for where a line closes."""


@dataclass(frozen=True, eq=False)
class LimitCurve:
    """What rigid masonry bears as its mechanism goes on.

    Args:
        displacement: of the centroid of all free blocks along the direction [m], shape (n,).
        multiplier: of the horizontal force over the weight [-], shape (n,), below zero where the masonry is held back.
        pose: of the free blocks, as in a `Response`, shape (n, free, 3), in space (n, free, 7).
        ended: why it stopped, in words.
    """

    displacement: Array
    multiplier: Array
    pose: Array
    ended: str

    def __repr__(self) -> str:
        return (
            f"<LimitCurve: {len(self.multiplier)} poses to {self.displacement[-1]:.3g} m, from "
            f"{self.multiplier[0]:.4g} to {self.multiplier[-1]:.4g} of the weight, {self.ended}>"
        )

    @property
    def d_0(self) -> float:
        """Displacement at which nothing is borne any more [m]; NaN where the curve ends before it."""
        if self.multiplier[-1] > 0:
            return math.nan
        (d, e), (borne, none) = self.displacement[-2:], self.multiplier[-2:]
        return float(d + (e - d) * borne / (borne - none))


def limit_curve(
    masonry: Masonry,
    direction: float | ArrayLike | None = 1,
    *,
    to: float,
    angle: float | None = None,
    effects: Sequence[Effect] | Effect = (),
    poses: int = 100,
) -> LimitCurve:
    """The horizontal force that rigid masonry bears as it goes on, proportional to the weight, in turned poses.

    From each pose the mechanism of `collapse_multiplier` goes on by a step. Lines that neither open nor slide in it
    then stay where they are, and a step ends where a further line closes, from which another mechanism may go on. No
    steps in time are made, and joints have no stiffness. The curve ends where joints slide, since those of associated
    friction open as they do, and where a further joint would open as well and several hinges would move at once: `push`
    follows both. Where several mechanisms have the same multiplier it goes on with one of them, and where lines close
    again and again, more often than there are lines, it ends.

    Args:
        masonry: the masonry, with dry joints.
        direction, angle, effects: as of `collapse_multiplier`.
        to: displacement of the centroid of all free blocks along the direction at which to stop [m], 1e-6 to 100.
        poses: how many steps go to it, 2 to 10000; it ends before where nothing is borne any more.

    Returns:
        The `LimitCurve`: `displacement` [m], `multiplier` [-], `pose` and `d_0`.

    Raises:
        TypeError, ValueError: as `collapse_multiplier` does.

    Examples:
        >>> column = mr.Masonry.stack([mr.Block.from_size(0.6, 1.0)] * 3)
        >>> round(mr.limit_curve(column, 1, to=0.5).d_0, 3)
        0.3
    """
    require_kind("masonry", masonry, Masonry)
    to = require_within("to", to, 1e-6, 100.0, "m")
    step = to / require_whole("poses", poses, 2, 10_000)
    found = collapse_multiplier(masonry, direction, angle=angle, effects=effects)
    path = Path.of(masonry, horizontal(masonry, direction, angle))
    curve = [(0.0, found.multiplier, path.rest)]
    while True:
        d, multiplier, pose = curve[-1]
        if ended := _ended(d, multiplier, to, found):
            break
        stay = path.staying(pose, found)
        if slides := path.sliding(pose, found, stay):
            ended = f"{named(slides)} slide"
            break
        pose = path.further(pose, found, stay, min(step, to - d))
        if path.gone(pose) - d < ROUNDED * path.size:
            ended = "locks"
            break
        if len(curve) > poses + len(path.pair):
            ended = "lines close again and again"
            break
        try:
            found = collapse_multiplier(masonry, direction, angle=angle, effects=effects, pose=pose)
        except UnbalancedError:
            ended = "another joint begins to open"
            break
        except ValueError as error:
            ended = str(error)
            break
        curve.append((path.gone(pose), found.multiplier, pose))
    displacement, multipliers, gone = zip(*curve, strict=True)
    return LimitCurve(np.array(displacement), np.array(multipliers), np.array(gone), ended)


def _ended(d: float, multiplier: float, to: float, found: Collapse) -> str:
    """Why a curve ends at a pose, or nothing."""
    if not found.moving:
        return "nothing gives way"
    if multiplier <= 0:
        return "goes on by itself"
    return f"moved by {1e3 * to:.4g} mm" if d >= to * (1 - 1e-9) else ""


class Stay(NamedTuple):
    """Which closed lines do not open in a mechanism, which of them do not slide, and which open, shape (m,) each."""

    closed: Flags
    stuck: Flags
    opens: Flags


class Path(NamedTuple):
    """What a mechanism goes on with.

    Args:
        masonry: the masonry.
        way: unit vector of the force, shape (d,).
        mass: of the free blocks, over that of all [-], shape (free,).
        pair: numbers of the bodies of each line, -1 for a fixed one, shape (m, 2).
        size: extent of the free blocks [m].
    """

    masonry: Masonry
    way: Array
    mass: Array
    pair: Integers
    size: float

    @classmethod
    def of(cls, masonry: Masonry, way: Array) -> Path:
        """That of masonry pushed along a unit vector."""
        mass = np.array([masonry.blocks[i].mass for i in masonry.free])
        corners = np.concatenate([masonry.blocks[i].corners for i in masonry.free])
        pair = free_numbers(masonry.blocks)[np.column_stack([masonry.lines.body, masonry.lines.face])]
        return cls(masonry, way, mass / mass.sum(), pair, float(np.ptp(corners, axis=0).max()))

    @property
    def rest(self) -> Array:
        """The pose at rest, shape (free, nq)."""
        freedom = SPACE if self.masonry.in_space else PLANE
        return at_rest(len(self.mass), freedom).reshape(len(self.mass), -1)

    def gone(self, pose: Array) -> float:
        """How far the centroid has gone along the way [m]."""
        return float(self.mass @ pose[:, : len(self.way)] @ self.way)

    def rates(self, moves: Moves, directions: Array) -> csr_array:
        """Rates at which lines move apart in directions of their faces at rest, for unit velocities, (m, unknowns)."""
        lines, at = self.masonry.lines, moves.at(self.masonry.lines.body, self.masonry.lines.at)
        arms = at - moves.place[lines.body], at - moves.place[lines.face]
        return rates_of(self.pair, arms, moves.turned(lines.face, directions), len(self.mass))

    def staying(self, pose: Array, found: Collapse) -> Stay:
        """Which lines stay in a mechanism."""
        moves, lines, velocity = Moves.of(self.masonry, pose), self.masonry.lines, found.motion.ravel()
        closed = gaps_of(lines, moves)[2] <= self.masonry.tolerance
        normal = self.rates(moves, lines.normal) @ velocity
        along = np.hypot.reduce([self.rates(moves, way) @ velocity for way in lines.across])
        least = STAYS * max(float(np.abs(normal[closed]).max(initial=0.0)), float(np.abs(velocity).max()))
        still = closed & (np.abs(normal) <= least)
        return Stay(still, still & (along <= least), closed & ~still)

    def sliding(self, pose: Array, found: Collapse, stay: Stay) -> list[str]:
        """Names of the joints that press, rub and slide at each line that does not open, or at all that do."""
        lines, moves, velocity = self.masonry.lines, Moves.of(self.masonry, pose), found.motion.ravel()
        along = np.hypot.reduce([self.rates(moves, way) @ velocity for way in lines.across])
        rubs = (along > STAYS * np.abs(velocity).max()) & (stay.opens | stay.closed)
        names = []
        for number, joint in enumerate(self.masonry.joints):
            own = lines.joint == number
            pressed = found.forces is not None and found.forces.normal[number] > PRESSED * found.forces.normal.max()
            if pressed and self.masonry.joint_friction[number] > 0 and rubs[own].any() and not (own & stay.stuck).any():
                names.append(joint.name)
        return names

    def further(self, pose: Array, found: Collapse, stay: Stay, step: float) -> Array:
        """The pose a step further [m], or up to where a line closes."""
        shift = found.motion[:, : len(self.way)]
        speed = float(self.mass @ shift @ self.way)
        low, high = 0.0, step / max(speed, ROUNDED)
        after = self.projected(pose, found.motion * high, stay)
        if not self.closes(pose, after, stay):
            return after
        best = pose
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            after = self.projected(pose, found.motion * middle, stay)
            if self.closes(pose, after, stay):
                high = middle
            else:
                low, best = middle, after
        return best

    def closes(self, before: Array, after: Array, stay: Stay) -> bool:
        """Whether a line that does not stay has gone behind its face, farther than it was."""
        gap, was = (gaps_of(self.masonry.lines, Moves.of(self.masonry, pose))[2] for pose in (after, before))
        return bool((gap < np.minimum(was, 0.0) - BEHIND * self.masonry.tolerance)[~stay.closed].any())

    def projected(self, pose: Array, motion: Array, stay: Stay) -> Array:
        """The pose after a motion, with the lines that stay where they were on their faces."""
        lines, goal = self.masonry.lines, self.relative(pose)
        after = self.turned(pose, motion)
        for _ in range(TURNS):
            moves = Moves.of(self.masonry, after)
            off = self.relative(after) - goal
            rows = [self.rates(moves, lines.normal)[stay.closed]]
            rows += [self.rates(moves, way)[stay.stuck] for way in lines.across]
            left = [(off * lines.normal).sum(axis=1)[stay.closed]]
            left += [(off * way).sum(axis=1)[stay.stuck] for way in lines.across]
            missing = np.concatenate(left)
            if np.abs(missing).max(initial=0.0) < ROUNDED * self.size:
                break
            change = -np.linalg.lstsq(vstack(rows).toarray(), missing, rcond=1e-9)[0]
            after = self.turned(after, change.reshape(motion.shape))
        return after

    def relative(self, pose: Array) -> Array:
        """Where points of lines are from those of their faces, in the axes of the faces at rest [m], shape (m, d)."""
        moves, lines = Moves.of(self.masonry, pose), self.masonry.lines
        apart = moves.at(lines.body, lines.at) - moves.at(lines.face, lines.at)
        return np.asarray((np.swapaxes(moves.turn[lines.face], 1, 2) @ apart[..., None])[..., 0])

    def turned(self, pose: Array, motion: Array) -> Array:
        """A pose after a motion, whose rotations are about the axes of the world in space."""
        if not self.masonry.in_space:
            return pose + motion
        turn = Moves.of(self.masonry, pose).turn[list(self.masonry.free)]
        own = np.concatenate([motion[:, :3], (np.swapaxes(turn, 1, 2) @ motion[:, 3:, None])[..., 0]], axis=1)
        return moved(pose.ravel(), own.ravel(), SPACE).reshape(pose.shape)
