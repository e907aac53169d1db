"""The law of the contact of two blocks beyond their joints.

Two blocks that had a joint keep its stiffness and dashpot per area over their common area, and its friction, that of a
mortared joint without its bond. So a joint that has slid is as stiff as one that is drawn where it is. Two that had
none take those of the softer block: of its stiffest joint, or of half of all its joints if that is more, since a block
of a wall has joints on two sides. Where their faces lie over each other by less than a tenth of the area of such a
joint, they have less in proportion. So blocks that only touch along their edges carry no force. The places where a pair
touches share its stiffness. Friction and damping of two that had none are those that `pairs` of the masonry gives them,
if it does.

A block without any joint is loose. It has what a joint over its largest face would have, per area that of the softest
joint of the masonry. Where it is the softer block, the pair has that over the area on which the two faces lie, as a
joint that is drawn there would have. A fixed block has over the area of the free one what its own joints have per area,
so that how many blocks stand on the ground plays no part.

A corner or a small face of a loose block has a quarter of the largest face, and what is left of a joint that has slid
has a quarter of the joint, with the same decrease for areas that are ten times smaller still. Otherwise they would sink
into the other block. The step of a run is found from the joints at rest, which loose blocks do not have, nor the
dashpots that `pairs` gives. So `LongestSteps` take each such block with the springs and the strongest
dashpots that it has on one of its sides, twice over, as a block between two others.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...geometry.hull import Side, area_vector
from ...problem.masonry.laws.dry import PairProperties
from ...problem.masonry.laws.joint_law import INTENSIVE, Law, largest_stiffness
from ...problem.wall.rest_geometry import Solid
from ...quantities import Array, Flags, Integers
from ...rows import Rows, chosen, joined, rows
from ...scene.parts import JointSprings
from ...scene.scene import Scene
from ..stable_step import longest_step
from ..step_length import Impacts, LongestSteps
from ..system import System
from .constants import AS_STIFF, LEAST_CONTACT, SIDES_THAT_BEAR, WHOLE_CONTACT

SHARED_COLUMNS = ("k", "c", "k_s", "c_s")
"""The properties that the places of a pair share."""
OF_FRICTION = INTENSIVE.index("friction")


def pair_number(a: Integers, b: Integers, blocks: int) -> Integers:
    """One number for two blocks."""
    return np.asarray(np.minimum(a, b) * blocks + np.maximum(a, b), dtype=np.int64)


def are_among(numbers: Integers, increasing: Integers) -> Flags:
    """Whether numbers are among increasing ones, shape of the numbers."""
    if not len(increasing):
        return np.zeros(len(numbers), dtype=bool)
    place = np.minimum(increasing.searchsorted(numbers), len(increasing) - 1)
    return np.asarray(increasing[place] == numbers)


def least_among(pair: Integers, others: Integers, shares: Array) -> Array:
    """The least share of each pair among others, 1 where it is not one of them, shape of the pairs."""
    if not len(others):
        return np.ones(len(pair))
    known, index = np.unique(others, return_inverse=True)
    least_shares = np.ones(len(known) + 1)
    np.minimum.at(least_shares, index, shares)
    return least_shares[np.where(are_among(pair, known), np.searchsorted(known, pair), -1)]


class PairLaw(NamedTuple):
    """What each pair of blocks has in all.

    Args:
        jointed: numbers of the pairs that have a joint, increasing, shape (p,).
        of_pair: `SHARED_COLUMNS` and area [m2], in the plane width [m], of these pairs, shape (p, 5), and the numbers
            `INTENSIVE` of their law, of which the least of their joints count, (p, i).
        of_block: likewise of each block as a pair without a joint takes it.
        fixed, loose: which blocks are fixed, and which have no joint, shape (blocks,).
        given: friction and dashpot over spring of pairs without a joint that have been requested.
        known: what pairs have that have a joint or have met.
    """

    jointed: Integers
    of_pair: tuple[Array, Array]
    of_block: tuple[Array, Array]
    fixed: Flags
    loose: Flags
    given: GivenPairs
    known: PairsMet

    @classmethod
    def of_joints(cls, scene: Scene, lines: Rows) -> PairLaw:
        """The law of the joints of a scene, from their lines."""
        solids, springs, joint = scene.rest_geometry.solids, scene.springs, scene.contacts.joint
        in_space = len(scene.freedom.axes) == 3
        assert springs is not None
        blocks, joints = len(solids), len(scene.rest_geometry.joints)
        below, above = np.array([(joint.below, joint.above) for joint in scene.rest_geometry.joints]).T
        areas = np.array([joint.area if in_space else joint.width for joint in scene.rest_geometry.joints])
        sums = np.column_stack([*(_sums(joint, lines[name], joints) for name in SHARED_COLUMNS), areas])
        others = np.zeros((joints, len(INTENSIVE)))
        others[joint] = np.column_stack([lines[name] for name in INTENSIVE])
        others[joint, OF_FRICTION] = np.minimum(others[joint, OF_FRICTION], springs.residual[joint])
        jointed, pair_of_joint = np.unique(pair_number(below, above, blocks), return_inverse=True)
        in_pairs = np.column_stack([_sums(pair_of_joint, column, len(jointed)) for column in sums.T])
        least_values = np.full((len(jointed), len(INTENSIVE)), np.inf)
        np.minimum.at(least_values, pair_of_joint, others)
        shared, rough = _law_of_blocks(np.append(below, above), sums, others, blocks)
        loose = shared[:, 0] == 0
        shared[loose], rough[loose] = _law_of_loose(scene, sums, others, loose)
        fixed = np.array([solid.fixed for solid in solids])
        known = PairsMet(KnownPairs(jointed, in_pairs, least_values, np.ones(len(jointed), dtype=bool)))
        return cls(jointed, (in_pairs, least_values), (shared, rough), fixed, loose, GivenPairs(springs, blocks), known)

    @property
    def slowest(self) -> float:
        """The largest dashpot over its spring of the requested pairs [s]."""
        shared = np.concatenate([self.of_pair[0], self.of_block[0]])
        return max(float((shared[:, 1] / shared[:, 0]).max()), self.given.slowest)

    def meetings(self, inverse_mass: Array) -> Meetings:
        """What the pairs of blocks without a joint that are given make of flat impacts, from the inverse mass of each
        block, zero of a fixed one [1/kg], shape (blocks,)."""
        blocks, fastest = len(self.fixed), dict[float, float]()
        slowest = np.zeros(blocks)
        for block in range(blocks if self.given.springs.pairs is not None else 0):
            others = np.arange(block + 1, blocks)
            others = others[~are_among(pair_number(np.full_like(others, block), others, blocks), self.jointed)]
            others = others[inverse_mass[block] + inverse_mass[others] > 0]
            slow = self.given.retardations(block, others)
            others, slow = others[slow > 0], slow[slow > 0]
            ends = np.array([np.full_like(others, block), others])
            law = law_of(self._law_of_softer(ends)[0][:, 0], self.of_block[1][ends].min(axis=0))
            frequency = np.sqrt(largest_stiffness(law) * (inverse_mass[block] + inverse_mass[others]))
            for retardation in np.unique(slow).tolist():
                fastest[retardation] = max(fastest.get(retardation, 0.0), float(frequency[slow == retardation].max()))
            slowest[block] = max(slowest[block], slow.max(initial=0.0))
            slowest[others] = np.maximum(slowest[others], slow)
        frequency = np.array([*fastest.values()])
        return Meetings(Impacts(frequency, 0.5 * np.array([*fastest]) * frequency), slowest)

    def of_places(self, pair: Integers, share: Array, area: Array, blocks: int) -> dict[str, Array]:
        """Columns of lines at places of pairs, from the share that each has of its pair, and the area of the part of a
        face that lies over the other [m2], zero for edges, shape (n,) each."""
        known = self.known.with_pairs(pair, lambda new: self._law_without_joint(new, blocks))
        index = known.numbers.searchsorted(pair)
        shared, others = known.shared[index], known.others[index]
        over = area / shared[:, -1]
        part = np.where(known.of_face[index], part_of_face(over), np.minimum(over / WHOLE_CONTACT, 1.0))
        share = share * np.where(area > 0, part, 1.0)
        columns = dict(zip(SHARED_COLUMNS, share * shared[:, :-1].T, strict=True))
        return columns | dict(zip(INTENSIVE, others.T, strict=True))

    def _law_without_joint(self, pair: Integers, blocks: int) -> KnownPairs:
        """What pairs without a joint have, by their increasing numbers."""
        ends = np.array(np.divmod(pair, blocks))
        (shared, loose), others = self._law_of_softer(ends), self.of_block[1][ends].min(axis=0)
        self.given.take(pair, shared, others[:, OF_FRICTION])
        return KnownPairs(pair, shared, others, loose)

    def _law_of_softer(self, ends: Integers) -> tuple[Array, Flags]:
        """What pairs without a joint have, shape (n, 5), and whether the block that rules is loose, shape (n,), from
        their blocks, shape (2, n)."""
        laws, fixed = self.of_block[0][ends], self.fixed[ends]
        over = laws[::-1, :, -1] / laws[..., -1]
        laws = laws * np.where(fixed, over, 1.0)[..., None]
        less, more = laws[0] < (1 - AS_STIFF) * laws[1], (1 - AS_STIFF) * laws[0] > laws[1]
        unlike = (less | more).argmax(axis=1)  # of equal stiffness the one with less of the next column
        first = ~np.take_along_axis(more, unlike[:, None], axis=1)[:, 0]
        second = fixed[0] | (~fixed[1] & ~first)
        rules = np.where(second, self.loose[ends[1]], self.loose[ends[0]])
        alike = ~fixed.any(axis=0) & ~(less | more).any(axis=1)
        rules |= alike & self.loose[ends].any(axis=0)  # the loose one of two
        return np.where(first[:, None], laws[0], laws[1]), np.asarray(rules, dtype=bool)


class KnownPairs(NamedTuple):
    """What some pairs have.

    Args:
        numbers: of the pairs, increasing, shape (p,).
        shared, others: see `PairLaw.of_pair`.
        of_face: whether each has less over a part of its joint or of a face, see `part_of_face`, shape (p,).
    """

    numbers: Integers
    shared: Array
    others: Array
    of_face: Flags


class PairsMet:
    """Pairs with a joint, and those that have met, whose law is computed once. A run has a copy."""

    def __init__(self, known: KnownPairs) -> None:
        self._known = known

    def with_pairs(self, pair: Integers, law: Callable[[Integers], KnownPairs]) -> KnownPairs:
        """All known pairs, these among them. The law of pairs that have not met, by their increasing numbers."""
        known = self._known
        new = pair[~are_among(pair, known.numbers)]
        if len(new):
            merged = [np.concatenate(parts) for parts in zip(known, law(np.unique(new)), strict=True)]
            order = merged[0].argsort()
            self._known = known = KnownPairs._make(part[order] for part in merged)
        return known


class Meetings(NamedTuple):
    """What `pairs` of the masonry makes of flat impacts.

    Args:
        impacts: for each dashpot over its spring, the fastest of those that have it.
        slowest: the largest dashpot over its spring of the pairs of each block [s], shape (blocks,).
    """

    impacts: Impacts
    slowest: Array


class GivenPairs:
    """Friction and dashpot over spring of pairs of blocks without a joint, each of which is computed once.

    Args:
        springs: from which the values of pairs follow.
        blocks: how many there are.
    """

    def __init__(self, springs: JointSprings, blocks: int) -> None:
        self.springs, self.blocks = springs, blocks
        self.known: dict[int, PairProperties | None] = {}

    @property
    def slowest(self) -> float:
        """The largest dashpot over its spring of the requested pairs [s]."""
        return max((meets.retardation for meets in self.known.values() if meets is not None), default=0.0)

    def of_pair(self, number: int) -> PairProperties | None:
        """What a pair has, by its number, or None."""
        if number not in self.known:
            self.known[number] = self.springs.of_pair(*divmod(number, self.blocks))
        return self.known[number]

    def retardations(self, block: int, others: Integers) -> Array:
        """Dashpot over spring of a block with others of higher numbers, zero where nothing is given [s], shape (n,)."""
        if isinstance(self.springs.pairs, PairProperties):
            return np.full(len(others), self.springs.pairs.retardation)
        met = [self.of_pair(number) for number in (block * self.blocks + others).tolist()]
        return np.array([0.0 if meets is None else meets.retardation for meets in met])

    def take(self, pair: Integers, shared: Array, friction: Array) -> None:
        """Write dashpots (n, 5) and friction (n,) of those of pairs without a joint that are given."""
        for i, number in enumerate(pair.tolist() if self.springs.pairs is not None else ()):
            if (meets := self.of_pair(number)) is not None:
                friction[i], shared[i, 1] = meets.friction, meets.retardation * shared[i, 0]
                if math.isfinite(shared[i, 2]):
                    shared[i, 3] = meets.retardation * shared[i, 2]


def law_of(k: Array, others: Array) -> Law:
    """The law of springs [N/m], shape (n,), with the numbers `INTENSIVE`, shape (n, i)."""
    return Law(k=k, **dict(zip(INTENSIVE, others.T, strict=True)))


def part_of_face(over: Array) -> Array:
    """Part of what a loose block has over its largest face, or a pair over its joint, that it has over another area,
    from this area over that of the face or the joint."""
    return np.asarray(np.maximum(over, np.minimum(over / WHOLE_CONTACT, LEAST_CONTACT)))


def side_area(side: Side) -> float:
    """Area of a side of a block [m2], in the plane its length [m]."""
    flat = side.corners.shape[1] == 2
    return float(np.linalg.norm(np.subtract(*side.corners) if flat else area_vector(side.corners)))


def _sums(group: Integers, values: Array, count: int) -> Array:
    return np.asarray(np.bincount(group, weights=values, minlength=count), dtype=float)


def _law_of_blocks(block: Integers, joints: Array, others: Array, blocks: int) -> tuple[Array, Array]:
    """What each block has, from its joints: below of all and then above of all. One without a joint has nothing."""
    joints, others = np.concatenate([joints, joints]), np.concatenate([others, others])
    sums = np.column_stack([_sums(block, column, blocks) for column in joints.T])
    stiffest, least_values = np.zeros(blocks), np.zeros((blocks, others.shape[1]))
    np.maximum.at(stiffest, block, joints[:, 0])
    least_values[block] = others
    np.minimum.at(least_values, block, others)
    share = np.maximum(stiffest / np.where(sums[:, 0] == 0, 1.0, sums[:, 0]), 0.5)
    return share[:, None] * sums, least_values


def _law_of_loose(scene: Scene, joints: Array, others: Array, loose: Flags) -> tuple[Array, Array]:
    """What loose blocks have over their largest faces. Of joints that are as soft, the softest along the face counts,
    then the least damped and the smoothest one."""
    assert scene.springs is not None
    springs, solids = scene.springs, [scene.rest_geometry.solids[i] for i in np.flatnonzero(loose)]
    known = springs.k_n, springs.k_s, springs.retardation, *others.T
    softest = int(np.lexsort(known[::-1])[0])
    largest = np.reshape([max(side_area(side) for side in solid.sides) for solid in solids], (-1, 1))
    per_area = joints[softest] / joints[softest, -1]
    if len(scene.freedom.axes) == 2:
        length = np.array([[np.ptp(solid.drawn[0].corners[:, 1])] for solid in solids]).reshape(-1, 1)
        of_joint = scene.rest_geometry.joints[softest].length
        per_area = per_area * np.append(length / of_joint * np.ones(4), np.ones_like(length), 1)
    return largest * per_area, np.tile(others[softest], (len(solids), 1))


def longest_steps_of(solids: Sequence[Solid], law: PairLaw, slowest: Array, system: System) -> LongestSteps:
    """The longest stable steps of the blocks of a system on the springs that they have beyond their joints.

    Args:
        solids, law, system: the blocks.
        slowest: the largest dashpot over its spring that is given for pairs of each block [s], shape (blocks,).
    """
    shared = law.of_block[0]
    loose = longest_step_of_some(solids, law.loose & ~law.fixed, law, shared, system)
    slower = (slowest * shared[:, 0] > shared[:, 1]) & ~law.fixed
    if not slower.any():
        return LongestSteps(loose)
    damped = shared.copy()
    damped[slower, 1] = slowest[slower] * shared[slower, 0]
    sprung = slower & np.isfinite(shared[:, 2])
    damped[sprung, 3] = slowest[sprung] * shared[sprung, 2]
    is_dashpot = np.array([0, 1, 0, 1, 0]) > 0
    of_requested, slow = (
        longest_step_of_some(solids, slower, law, springs, system)
        for springs in (np.where(is_dashpot, 0.0, shared), damped)
    )
    return LongestSteps(loose, of_requested, slow / of_requested)


def longest_step_of_some(solids: Sequence[Solid], flags: Flags, law: PairLaw, shared: Array, system: System) -> float:
    """The longest stable step of some blocks by their law with other springs and dashpots, see `PairLaw.of_block`
    [s]."""
    tables, body_numbers, in_space = [rows(system.lines.dtype, 0)], list[int](), len(system.axes) == 3
    for i in np.flatnonzero(flags).tolist():
        solid = solids[i]
        centroid = solid.rest if in_space else solid.rest[::2]
        for corners, normal, springs in _springs(solid, shared[i]):
            columns = dict(zip((*SHARED_COLUMNS, *INTENSIVE), (*springs, *law.of_block[1][i]), strict=True))
            ends: dict[str, Any] = {"body": len(body_numbers), "face": -1, "at": corners - centroid, "normal": -normal}
            tables.append(rows(system.lines.dtype, len(corners), **ends, **columns))
            body_numbers.append(solid.body)
    if not body_numbers:
        return math.inf
    bodies = chosen(system.bodies, np.array(body_numbers))
    return longest_step(system._replace(bodies=bodies, lines=joined(*tables), laws=(), links=()))


def _springs(solid: Solid, shared: Array) -> list[tuple[Array, Array, Array]]:
    """The corners of each side of a block [m], its normal, and the springs and dashpots that each corner has."""
    springs = []
    for side in solid.sides:
        over = np.array([min(side_area(side) / shared[-1], 1.0)])
        part = SIDES_THAT_BEAR * float(part_of_face(over)[0]) / len(side.corners)
        springs.append((np.asarray(side.corners), np.asarray(side.normal), part * shared[:-1]))
    return springs
