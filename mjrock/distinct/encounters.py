"""Encounters: blocks that have left their joints meet others wherever they are.

A joint of the drawing serves while it is intact. Once all of it has opened by a share of its width, or a part of it has
slid by so much, it is handed over for good, with its friction, to contacts that are found where the blocks are. Blocks
that have no common joint are looked at once one of them has moved nearly as far as the other was away at rest. A find
gives each pair its places, with the law of `pair_law`. Where the step asks for softer ones, they stay soft as long as
they press: from find to find stiff and soft in turn, blocks would sink into each other. Until the next find each place
moves with its body, and its normal with the other. What the springs of a find hold less than those before it is booked.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np

from ..problem.masonry.lines import free_numbers
from ..problem.masonry.masonry import Masonry
from ..quantities import GRAVITY, Array, Flags, Integers
from .bonds import holding, released
from .finder import Finder, Found
from .handover import Blocks, Lines, Pairs, hand_over
from .looking import Motion, Wear, held, take_motion, wears
from .pair_law import SHARED, PairLaw, least_among, pair_number
from .rows import joined, rows, taken
from .softening import Sides, shares_within
from .solids import Poses
from .system import Books, System

LOOK, SOONEST = 5e-3, 5e-4
"""Longest and shortest time between two looks [s]."""
FALL = 0.5 * GRAVITY * LOOK**2
"""What a block falls by from one look to the next [m]."""
PASSED = 0.02
"""Way that a pair may make between two looks, over the size of the smaller block [-]."""
STAYED = 2e-4
"""Way over its size that a block may make while a find of it stays valid [-]. What is within `NEAR` is found."""
SURE = 2.0
"""Way within which places are kept until the next look, over that which speeds alone make [-]."""
NEAR = 1e-3
"""Distance at which blocks are near each other, and way up to which no block is looked at, over their size [-]. Blocks
without a common joint that are so near at rest touch at edges or corners, and are looked at later, from `PASSED` on."""
STABLE = 0.5
"""Longest step over the longest one with which the places of a block alone are stable [-]. Intact joints, and places of
blocks that have not moved, act on it besides."""
LEFT = 0.05
"""Opening of a whole joint, or slip of a part of it, over its width, beyond which it is handed over [-]."""
TOWARDS = 0.4
"""Way of a block over its distance from the nearest one without a common joint, from which on it is looked at [-]."""


@dataclass
class Met:
    """What a look knows of those before it.

    Args:
        watched: blocks that are looked at, shape (blocks,).
        handed: whether the joints of each pair that has some are handed over, shape (p,).
        pair: number of the pair of each line of an encounter, shape (lines,).
        slack: what presses nothing of the overlap of each line [m], shape (lines,).
        share: of its law that each line has left where the step asked for softer ones [-], shape (lines,).
        poses: where each block was when it was last taken to have moved.
        moves: how often it has, shape (blocks,).
        found: moves of both blocks when each line was found, shape (lines,).
    """

    watched: Flags
    handed: Flags
    pair: Integers
    slack: Array
    share: Array
    poses: Poses
    moves: Integers
    found: Integers


class Encounters:
    """The blocks of masonry, and the lines where they meet beyond their joints.

    Args:
        masonry: the masonry.
        system: its bodies where they stand, and the lines of its joints.
        joint: number of the joint of each line. The account of the encounters comes after those of the joints.
    """

    def __init__(self, masonry: Masonry, system: System, joint: Integers) -> None:
        blocks = masonry.blocks
        self.count, self.group = len(blocks), len(masonry.joints)
        self.names, self.sizes = masonry.names, np.array([block.size for block in blocks])
        body, drawn = free_numbers(blocks), np.array(masonry.centroids, dtype=float)
        still = Poses(drawn, np.zeros_like(drawn), np.zeros((*drawn.shape, drawn.shape[1])))
        fixed = np.where(body < 0, np.cumsum(body < 0) - 1, -1)
        self.blocks = Blocks(still, self.sizes, np.array(masonry.free), body, fixed, np.full(self.count, -1))
        self.finder = Finder(blocks, drawn)
        self.law = PairLaw.of_joints(masonry, system.lines, joint)
        below, above = np.array([(each.below, each.above) for each in masonry.joints]).T
        of = np.searchsorted(self.law.jointed, pair_number(below, above, self.count))
        left = np.full(len(self.law.jointed), np.inf)
        np.minimum.at(left, of, [LEFT * each.width for each in masonry.joints])
        self.jointed = _jointed(masonry, self.finder, of)
        self.kind, self.start = system.lines.dtype, self.motion(system).poses
        self.limits, free, slip, gap = self._limits(), self.blocks.free, np.zeros(len(left)), np.zeros(len(left))
        self.wear = Wear(of[joint], slip, gap, left, system.bodies.copy(), self.limits[free], self.sizes[free])
        self.met = self._nothing_met()

    def begun(self, supports: tuple[str, ...]) -> Encounters:
        """The same at the start of a run.

        Args:
            supports: names of the fixed blocks that move, in the order of the supports.
        """
        fresh, names = copy(self), {name: i for i, name in enumerate(supports)}
        fresh.blocks = self.blocks._replace(support=np.array([names.get(name, -1) for name in self.names]))
        fresh.met = self._nothing_met()
        return fresh

    def _nothing_met(self) -> Met:
        none, unmoved = np.zeros(0, dtype=np.int64), np.zeros(self.count, dtype=np.int64)
        nobody, intact = np.zeros(self.count, dtype=bool), np.zeros(len(self.law.jointed), dtype=bool)
        return Met(nobody, intact, none, np.zeros(0), np.zeros(0), self.start, unmoved, none)

    def _limits(self) -> Array:
        """How far each block may move before it is looked at [m], shape (blocks,)."""
        every, jointed = np.ones(self.count, dtype=bool), np.unique(self.jointed[1])
        found = self.finder.found(self.start, 0.5 * self.sizes, every, jointed)
        apart, limits = (
            found.gap > NEAR * np.minimum(self.sizes[found.face], self.sizes[found.other]),
            self.sizes.copy(),
        )
        for block in (found.face, found.other):
            np.minimum.at(limits, block, np.where(apart, TOWARDS * found.gap, PASSED * self.sizes[block]))
        return np.asarray(np.maximum(limits, NEAR * self.sizes))

    def _numbers(self, found: Found) -> Integers:
        return pair_number(found.face, found.other, self.count)

    def motion(self, system: System) -> Motion:
        """Where all blocks are, and how fast."""
        still = self.blocks.poses
        poses = Poses(still.drawn, np.zeros_like(still.moved), np.zeros_like(still.change))
        motion = Motion(poses, np.zeros_like(still.moved), np.zeros(self.count))
        take_motion(system, self.blocks, motion)
        return motion

    def look_on(self, system: System, books: Books, h: float) -> tuple[System, Books, float]:
        """The system with the lines of the encounters that may happen until the next look, its books with room for
        them, and the time until then [s]. With steps of h [s] they are stable."""
        met, wear = self.met, self.wear
        if not (wears(system, wear, LOOK) or met.watched.any() or system.supports.moved.any()):
            return system, books, LOOK
        worn = (np.maximum(wear.slip, wear.gap) > wear.left) & ~met.handed
        if len(system.bonds):
            worn[wear.pairs[: len(system.bonds)][holding(system.bonds)]] = False
        poses, velocity, about = self.motion(system)
        ahead = LOOK * (np.linalg.norm(velocity, axis=1) + about)
        watched = met.watched | (poses.far(self.start, self.sizes) + ahead > self.limits)
        watched[np.concatenate(np.divmod(self.law.jointed[worn], self.count))] = True
        moved = (poses.far(met.poses, self.sizes) > STAYED * self.sizes) | (watched & ~met.watched)
        if not watched.any() or not moved.any():
            return system, books, LOOK
        met.watched, met.handed = watched, met.handed | worn
        met.moves, met.poses = met.moves + moved, _newer(poses, met.poses, moved)
        stays = self._moves_of(met.pair) == met.found
        intact = self.jointed[1][~met.handed[self.jointed[0]]]
        known = np.sort(np.append(intact, self.finder.between(met.pair[stays])))
        found = self.finder.found(poses, SURE * (ahead + FALL + NEAR * self.sizes), watched, known)
        until, soon = self._until(found, velocity, about)
        of_gone = np.append(worn[wear.pairs], ~stays)
        if not (soon.any() or of_gone.any()):
            return system, books, until
        system = self._renewed(system, books, poses, found.only(soon), of_gone, h)
        return system, books.with_room(len(system.lines)), until

    def _until(self, found: Found, velocity: Array, about: Array) -> tuple[float, Flags]:
        """The time until the next look [s], and which places may touch by then."""
        if not len(found.gap):
            return LOOK, np.zeros(0, dtype=bool)
        first, second = found.face, found.other
        size = np.minimum(self.sizes[first], self.sizes[second])
        speed = np.linalg.norm(velocity[first] - velocity[second], axis=1) + about[first] + about[second]
        soonest = float((np.maximum(PASSED * size, 0.5 * found.gap) / np.maximum(speed, 1e-9)).min())
        until = min(max(soonest, SOONEST), LOOK)
        return until, found.gap < SURE * (speed * until + 2 * FALL + NEAR * size)

    def _renewed(self, system: System, books: Books, poses: Poses, found: Found, of_gone: Flags, h: float) -> System:
        """The system with these places. Pairs that have not moved keep their lines.

        Args:
            system, books: the system, and the account of what the springs of vanished lines have lost.
            poses: of all blocks.
            found: places that may touch.
            of_gone: lines of joints that are handed over, and of encounters whose blocks have moved, shape (lines,).
            h: length of a step [s].
        """
        met, count = self.met, len(self.wear.pairs)
        lines = np.asarray(system.lines)
        joints, others, number = lines[:count], lines[count:], self._numbers(found)
        worn, stays = of_gone[:count], ~of_gone[count:]
        if len(system.bonds):
            released(joints, system.bonds, worn)
        pair, which = np.append(self.law.jointed[self.wear.pairs], met.pair), np.flatnonzero(of_gone)
        which = which[np.argsort(pair[which], kind="stable")]
        slack, size = np.append(np.zeros(count), met.slack), len(number)
        gone = Lines(taken(lines, which), slack[which], np.empty(len(which)))
        new = Lines(rows(self.kind, size, group=self.group, margin=np.inf), np.empty(size), np.empty(size))
        before = held(system, which, gone.depth)
        share = np.append(np.ones(count), met.share)[which]
        soft = (share < 1) & (gone.depth > 0)
        share = least_among(number, pair[which][soft], share[soft])
        law = self.law.of_places(number, found.share, found.area, self.count)
        share = np.minimum(share, self._stable(found, law, poses, system, h))
        for name, column in law.items():
            new.rows[name] = share * column if name in SHARED else column
        blocks = self.blocks._replace(poses=poses)
        hand_over(new, found, gone, Pairs.belonging(number, pair[which]), blocks, system.axes)
        if worn.any():
            for name in ("k", "c", "friction", "grip", "dragged", "push", "pressed", "depth", "rate"):
                joints[name][worn] = 0.0
            joints["margin"][worn] = np.inf  # no step looks at such a line again
        met.pair, met.slack = np.append(met.pair[stays], number), np.append(met.slack[stays], new.slack)
        met.share = np.append(met.share[stays], share)
        met.found = np.append(met.found[stays], self._moves_of(number))
        lines = joined(joints, taken(others, stays), np.asarray(new.rows))
        ways = system.ways
        if len(ways) and len(ways) < (len(system.axes) - 1) * len(lines):
            ways = rows(ways.dtype, (len(system.axes) - 1) * len(lines))
        system = system._replace(lines=lines, ways=ways)
        books.ends[1] += before - held(system, np.arange(len(lines) - size, len(lines)), new.depth)
        return system

    def _moves_of(self, pair: Integers) -> Integers:
        """Moves of both blocks of pairs."""
        return np.asarray(self.met.moves[np.array(np.divmod(pair, self.count))].sum(axis=0))

    def _stable(self, found: Found, law: dict[str, Array], poses: Poses, system: System, h: float) -> Array:
        """Share of their law that leaves places stable in a step of h [s], shape (n,)."""
        blocks = np.array([found.face, found.other])
        arms = found.place - poses.drawn[blocks] - poses.moved[blocks]
        sides = Sides(self.blocks.body[blocks], arms, found.normal)
        return shares_within(sides, law, system.bodies, h / STABLE)


def _jointed(masonry: Masonry, finder: Finder, of: Integers) -> tuple[Integers, Integers]:
    """Pairs of solids whose faces make a joint: the number of the pair of blocks among those with joints, and that of
    the pair of solids, shape (n,) each.

    Args:
        masonry, finder: the blocks.
        of: number of the pair of blocks of each joint, shape (joints,).
    """
    pairs, numbers = list[int](), list[int]()
    for joint, pair in zip(masonry.joints, of.tolist(), strict=True):
        ends = (joint.below, joint.above)
        one, other = (
            [int(finder.first[block]) + part for part in masonry.blocks[block].sides[side].parts]
            for block, side in zip(ends, joint.sides, strict=True)
        )
        both = [int(pair_number(i, j, len(finder.owner))) for i in one for j in other]  # type: ignore[arg-type]
        pairs += [pair] * len(both)
        numbers += both
    return np.array(pairs), np.array(numbers)


def _newer(poses: Poses, old: Poses, moved: Flags) -> Poses:
    """The poses of the blocks that have moved, and the old ones of the others."""
    parts = zip(poses, old, strict=True)
    return Poses(*(np.where(moved.reshape(-1, *[1] * (new.ndim - 1)), new, before) for new, before in parts))
