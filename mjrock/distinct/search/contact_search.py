"""Contact search: where blocks that have left their joints meet others, and the contact lines that they get there.

A joint of the drawing serves while it is intact. Once all of it has opened by a share of its width, or a part of it has
slid by that share, it is handed over for good, with its friction, to contacts that are found where the blocks are. The
contacts of blocks that have no common joint are searched once one of them has moved nearly as far as the other was away
at rest. A search gives each pair its places, with the law of `pair_law`. Where the step requires softer contacts, they
stay soft as long as they press: if they were stiff and soft in turn, blocks would sink into each other. Until the next
search each place moves with its body, and its normal with the other.

A search books what springs along normals lose, and what springs along faces gain. What springs along faces lose counts
as friction. It also books the work of the changed forces in the half of a step before the pose, along the old normals,
since that half was stepped with them.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass

import numpy as np

from ...compiled import for_types_of
from ...problem.wall.rest_geometry import RestGeometry
from ...quantities import Array, Flags, Integers
from ...rows import Rows, chosen, joined, rows, unsound
from ...scene.scene import Scene
from ..rotation import rotations
from ..rows import MAY_BE_INFINITE
from ..supports import velocity_changes
from ..system import Books, System
from .constants import (
    HANDOVER_OPENING,
    NEAR,
    OF_STABLE_STEP,
    ONE_PLANE,
    REACH,
    ROLLED,
    TOWARDS_OTHERS,
    VALID_APPROACH,
    VALID_DISPLACEMENT,
)
from .finder import ContactPlaces, Finder
from .handover import Blocks, Lines, Pairs, hand_over, keep_depths
from .pair_law import SHARED_COLUMNS, PairLaw, least_among, longest_steps_of, pair_number
from .softening import Sides, shares_within
from .solids import Poses
from .validity import (
    Account,
    JointState,
    Limits,
    Motion,
    SearchInput,
    Validity,
    account,
    fall_within,
    is_outdated,
    longest_interval,
    set_validity,
)


@dataclass
class SearchState:
    """The state of the search between two updates.

    Args:
        validity: of the blocks.
        handed_over: whether the joints of each pair that has some are handed over, shape (p,).
        pair: number of the pair of each line that a search has found, shape (lines,).
        slack: what presses nothing of the overlap of each line [m], shape (lines,).
        share: of its law that each line has left where the step required softer ones [-], shape (lines,).
        found: how often both blocks had been searched when each line was found, shape (lines,).
        least_share: the least of such shares so far of lines of each block that pressed [-], shape (blocks,).
        since: time from the last update to the next [s].
    """

    validity: Validity
    handed_over: Flags
    pair: Integers
    slack: Array
    share: Array
    found: Integers
    least_share: Array
    since: float


class ContactSearch:
    """The blocks of a scene, and the lines where they meet beyond their joints.

    Args:
        scene: what stands.
        system: its bodies where they stand, and the lines of its joints. The account of the lines that are found
            comes after those of the joints.

    `longest_steps` are the longest stable steps of blocks on the springs that they have beyond their joints, and
    `flat_impacts` those of the pairs that are given, see `pair_law`.
    """

    examine = staticmethod(is_outdated)  # until a run knows the types of its arguments

    def __init__(self, scene: Scene, system: System) -> None:
        solids, joints, joint = scene.rest_geometry.solids, scene.rest_geometry.joints, scene.contacts.joint
        self.count, self.group = len(solids), len(joints)
        self.names, self.sizes = [solid.name for solid in solids], np.array([solid.size for solid in solids])
        body, drawn = np.array([solid.body for solid in solids]), np.array([solid.rest for solid in solids])
        flat = len(scene.freedom.axes) == 2
        drawn = drawn[:, ::2].copy() if flat else drawn
        as_drawn = Poses(drawn, np.zeros_like(drawn), np.zeros((*drawn.shape, drawn.shape[1])))
        fixed = np.where(body < 0, np.cumsum(body < 0) - 1, -1)
        self.blocks = Blocks(as_drawn, self.sizes, np.flatnonzero(body >= 0), body, fixed, np.full(self.count, -1))
        self.finder = Finder(solids, flat=flat)
        self.law = PairLaw.of_joints(scene, system.lines)
        inverse_mass = np.append(1 / scene.bodies.mass, 0.0)[body]
        self.flat_impacts, slowest = self.law.meetings(inverse_mass)
        self.longest_steps = longest_steps_of(solids, self.law, slowest, system)
        below, above = np.array([(joint.below, joint.above) for joint in joints]).T
        pair_of_joint = np.searchsorted(self.law.jointed, pair_number(below, above, self.count))
        left, rolled = np.full((2, len(self.law.jointed)), np.inf)
        np.minimum.at(left, pair_of_joint, HANDOVER_OPENING * np.array([joint.width for joint in joints]))
        np.minimum.at(rolled, pair_of_joint, _rolling_limits(scene.rest_geometry))
        self.first_joint = np.unique(pair_of_joint, return_index=True)[1]
        self.jointed, points = _jointed_pairs(scene, self.finder, pair_of_joint)
        self.finder.jointed, first = np.unique(self.jointed[1], return_index=True)
        self.finder.points = np.maximum.reduceat(points, first)
        self.line_type, start = system.lines.dtype, self.poses(system)
        interval = longest_interval(self.sizes[self.blocks.free])
        self.limits = Limits(start, self._limits(start), VALID_DISPLACEMENT * self.sizes, interval)
        blocks = np.column_stack(np.divmod(self.law.jointed, self.count))
        self.motion, self.joints = Motion.initial(start), JointState.intact(pair_of_joint[joint], blocks, left, rolled)
        self.state = self._no_contacts()

    def begun(self, supports: tuple[str, ...]) -> ContactSearch:
        """The same at the start of a run, with room of its own to write into.

        Args:
            supports: names of the fixed blocks that move, in the order of the supports.
        """
        fresh, names = copy(self), {name: i for i, name in enumerate(supports)}
        fresh.blocks = self.blocks._replace(support=np.array([names.get(name, -1) for name in self.names]))
        fresh.finder, fresh.state = self.finder.with_own_workspace(), self._no_contacts()
        fresh.law = self.law._replace(known=copy(self.law.known))
        fresh.motion, fresh.joints = Motion.initial(self.limits.start), JointState.intact(*self.joints[:4])
        return fresh

    def _no_contacts(self) -> SearchState:
        none, intact = np.zeros(0, dtype=np.int64), np.zeros(len(self.law.jointed), dtype=bool)
        validity, zeros = Validity.initial(self.limits.start, self.limits.interval), np.zeros(0)
        return SearchState(validity, intact, none, zeros, zeros, none, np.ones(self.count), 0.0)

    def _limits(self, start: Poses) -> Array:
        """How far each block may move from where it stands before its contacts are searched [m], shape (blocks,). Both
        blocks of a pair may. One that is not found is farther than the sum of both sizes."""
        every, jointed = np.ones(self.count, dtype=bool), np.unique(self.jointed[1])
        places = self.finder.places_near(start, self.sizes, every, jointed)
        separate = places.gap > NEAR * np.minimum(self.sizes[places.face], self.sizes[places.other])
        limits = TOWARDS_OTHERS * self.sizes
        for block in (places.face, places.other):
            allowance = np.where(separate, TOWARDS_OTHERS * places.gap, VALID_APPROACH * self.sizes[block])
            np.minimum.at(limits, block, allowance)
        return np.asarray(np.maximum(limits, NEAR * self.sizes))

    def _pair_numbers(self, places: ContactPlaces) -> Integers:
        return pair_number(places.face, places.other, self.count)

    def poses(self, system: System) -> Poses:
        """Where all blocks are."""
        as_drawn, free, support = self.blocks.poses, self.blocks.free, self.blocks.support
        poses = Poses(as_drawn.drawn, np.zeros_like(as_drawn.moved), np.zeros_like(as_drawn.change))
        poses.moved[free], poses.change[free] = system.bodies["place"], rotations(system.bodies)
        poses.moved[support >= 0] = system.supports.moved[support[support >= 0]]
        return poses

    def update(self, system: System, books: Books, t: float, h: float) -> tuple[System, Books, int]:
        """The system at a time [s] with the lines of all contacts that may touch until the next update, its books with
        room for them, and the steps until then. With steps of h [s] they are stable."""
        state, validity, motion, joints = self.state, self.state.validity, self.motion, self.joints
        motion.surge[:] = self._surges(system, t, t + h + self.limits.interval)
        examined = SearchInput(self.blocks, motion, self.limits, joints, state.handed_over, validity)
        outdated = self.examine(system, examined, state.since)
        if self.examine is is_outdated:
            self.examine = for_types_of(is_outdated, system, examined, state.since)
        if outdated:
            state.handed_over = state.handed_over | joints.left
            lasting = self._searches_of(state.pair) == state.found
            intact = self.jointed[1][~state.handed_over[self.jointed[0]]]
            reach = REACH * (validity.ahead + fall_within(self.limits.interval) + NEAR * self.sizes)
            places = self.finder.places_near(motion.poses, reach, validity.outdated, intact)
            may_touch = np.empty(len(places.gap), dtype=bool)
            set_validity(places, motion, self.sizes, validity, may_touch, self.limits.interval)
            may_touch &= places.share > 0
            of_gone = np.concatenate([joints.left[joints.pairs], ~lasting])
            if may_touch.any() or of_gone.any():
                system = self._with_lines_at(system, books, motion.poses, places.only(may_touch), of_gone, h)
                books = books.with_room(system)
        steps = max(1, int(validity.valid_for[validity.searched].min(initial=self.limits.interval) / h))
        state.since = steps * h
        return system, books, steps

    def _surges(self, system: System, t: float, until: float) -> Array:
        """By how much the velocity of what is driven, a fixed block or one at a link, changes until a time [m/s], shape
        (blocks,)."""
        surges = np.zeros(self.count)
        if len(system.supports.moved):
            moves = np.flatnonzero(self.blocks.support >= 0)
            surges[moves] = velocity_changes(system.supports, t, until)[self.blocks.support[moves]]
        for table in system.links:
            if len(table.rows):
                bodies, changes = table.velocity_changes(t, until)
                np.add.at(surges, self.blocks.free[bodies], changes)
        return surges

    def _with_lines_at(
        self, system: System, books: Books, poses: Poses, places: ContactPlaces, of_gone: Flags, h: float
    ) -> System:
        """The system with contact lines at these places. Pairs that have not moved keep their lines.

        Args:
            system, books: the system, and the account of what the springs of vanished lines have lost.
            poses: of all blocks.
            places: places that may touch.
            of_gone: lines of joints that are handed over, and found ones whose blocks have moved, shape (lines,).
            h: length of a step [s].
        """
        state, count, lines = self.state, len(self.joints.pairs), system.lines
        joints, others, number = lines[:count], lines[count:], self._pair_numbers(places)
        left_joints, kept, size = of_gone[:count], ~of_gone[count:], len(number)
        bonded = [law for law in system.laws if len(law.rows)]
        for law in bonded:
            law.release(joints[: len(law.rows)], left_joints[: len(law.rows)])
        pair, old_numbers = np.concatenate([self.law.jointed[self.joints.pairs], state.pair]), of_gone.nonzero()[0]
        old_numbers = old_numbers[pair[old_numbers].argsort(kind="stable")]
        slack, share = (
            np.concatenate([np.full(count, of_joints), of_found])[old_numbers]
            for of_joints, of_found in ((0.0, state.slack), (1.0, state.share))
        )
        old = Lines.unwritten(chosen(lines, old_numbers), slack)
        new = Lines.unwritten(rows(self.line_type, size, group=self.group, margin=np.inf), np.empty(size))
        before = account(system, old_numbers, old.depth)
        soft = (share < 1) & (old.depth > 0)
        share = least_among(number, pair[old_numbers][soft], share[soft])
        law = self.law.of_places(number, places.share, places.area, self.count)
        for name, column in law.items():
            new.rows[name] = column
        law_rows = [(bonded_law, bonded_law.contact_rows(self._joints_of(number), new.rows)) for bonded_law in bonded]
        springs = law
        for bonded_law, added in law_rows:
            springs = bonded_law.stiffest(added, springs)
        share = np.minimum(share, self._shares(places, springs, poses, system, h))
        for name in SHARED_COLUMNS:
            new.rows[name] *= share
        blocks, pairs = self.blocks._replace(poses=poses), Pairs.belonging(number, pair[old_numbers])
        keep_depths(new, places, old, pairs, blocks)
        for bonded_law, added in law_rows:
            bonded_law.soften(added, share)
            bonded_law.set_secant_stiffness(added, new.rows, new.depth)
        hand_over(new, places, old, pairs, blocks)
        for bonded_law, added in law_rows:
            bonded_law.set_secant_stiffness(added, new.rows, new.depth)
        for place in unsound(new.rows, MAY_BE_INFINITE)[:1]:
            block_name, other_name = (self.names[int(block[place])] for block in (places.face, places.other))
            raise ArithmeticError(f"the contact of {block_name} and {other_name}")
        if left_joints.any():
            _clear_lines(joints, left_joints)
        self._keep(kept, places, number, new.slack, share)
        lines = joined(joints, chosen(others, kept), new.rows)
        grown = {type(bonded_law): bonded_law.with_search_lines(count, kept, added) for bonded_law, added in law_rows}
        laws = tuple(grown.get(type(law), law) for law in system.laws)
        system = system._replace(lines=lines, laws=laws).with_room_for_friction()
        after = account(system, np.arange(len(lines) - size, len(lines)), new.depth)
        self._book(books, before, after, 0.5 * h if state.since > 0 else 0.0)
        return system

    def _keep(self, kept: Flags, places: ContactPlaces, number: Integers, slack: Array, share: Array) -> None:
        """Keep which lines there are now, and what they have been softened to.

        Args:
            kept: found lines that stay, shape (lines,).
            places, number: places of the new lines, and numbers of their pairs.
            slack, share: overlap of the new lines without force [m], and their stiffness over that of their law [-].
        """
        state, pressing = self.state, (places.gap < 0) & (share < 1)
        columns = {"pair": number, "slack": slack, "share": share, "found": self._searches_of(number)}
        for name, column in columns.items():
            setattr(state, name, np.concatenate([getattr(state, name)[kept], column]))
        for block in (places.face, places.other) if pressing.any() else ():
            np.minimum.at(state.least_share, block[pressing], share[pressing])

    def _book(self, books: Books, before: Account, after: Account, half: float) -> None:
        """Book what a search changes, whose forces change half a step before the pose [s]."""
        shear_change = min(before.sheared - after.sheared, 0.0)  # what they lose is friction
        late, totals = half * (after.power - before.power), books.totals
        totals["encounter_ends"][0] += before.energy + shear_change - after.energy - late
        totals["ground"][0] += half * (before.carried - after.carried)
        totals["friction"][0] += half * (before.rubbed - after.rubbed) - shear_change
        books.dashpots[self.group] += half * (before.damped - after.damped) + float(books.encounters.sum())
        books.encounters[:] = 0.0

    def _joints_of(self, pair: Integers) -> Integers:
        """Number of the first joint of each pair of blocks, -1 for a pair that has none."""
        index = np.minimum(np.searchsorted(self.law.jointed, pair), len(self.law.jointed) - 1)
        return np.where(self.law.jointed[index] == pair, self.first_joint[index], -1)

    def _searches_of(self, pair: Integers) -> Integers:
        """How often both blocks of pairs have been searched."""
        searches = self.state.validity.searches
        return np.asarray(searches[pair // self.count] + searches[pair % self.count])

    def _shares(self, places: ContactPlaces, law: dict[str, Array], poses: Poses, system: System, h: float) -> Array:
        """Share of their law that leaves places stable in a step of h [s], shape (n,)."""
        blocks = np.array([places.face, places.other])
        arms = places.place - poses.drawn[blocks] - poses.moved[blocks]
        sides = Sides(self.blocks.body[blocks], arms, places.normal)
        return shares_within(sides, law, system.bodies, h / OF_STABLE_STEP)


def _clear_lines(lines: Rows, gone: Flags) -> None:
    """Leave nothing to lines of joints that found contacts replace. No step takes them again."""
    for name in ("k", "c", "friction", "shear_state", "shear_force", "push", "dashpot_force", "depth", "rate"):
        lines[name][gone] = 0.0
    lines["margin"][gone] = np.inf


def _rolling_limits(geometry: RestGeometry) -> Array:
    """1 less the cosine of the angle of its faces up to which each joint serves [-], shape (joints,)."""
    normals = [np.array([side.normal for side in solid.sides]) for solid in geometry.solids]
    shapes, known = [face_normals.tobytes() for face_normals in normals], dict[tuple[bytes, int], float]()
    rolled = np.empty(len(geometry.joints))
    for i, joint in enumerate(geometry.joints):
        ends = list(zip((joint.below, joint.above), joint.sides, strict=True))
        for block, side in ends:
            if (shapes[block], side) not in known:
                beside = normals[block] @ normals[block][side]
                known[shapes[block], side] = float(beside[beside < ONE_PLANE].max(initial=-1.0))
        cosine = max(known[shapes[block], side] for block, side in ends)
        rolled[i] = 1 - math.cos(ROLLED * math.acos(cosine))
    return rolled


def _jointed_pairs(scene: Scene, finder: Finder, joint_pair: Integers) -> tuple[tuple[Integers, Integers], Integers]:
    """Pairs of solids whose faces make a joint: the number of the pair of blocks among those with joints, and that of
    the pair of solids, and the contact lines of the joint, shape (n,) each.

    Args:
        scene, finder: the blocks and their joints.
        joint_pair: number of the pair of blocks of each joint, shape (joints,).
    """
    assert scene.springs is not None
    geometry, of_joints = scene.rest_geometry, scene.springs.points.tolist()
    pairs, numbers, points = list[int](), list[int](), list[int]()
    for joint, pair, count in zip(geometry.joints, joint_pair.tolist(), of_joints, strict=True):
        ends = (joint.below, joint.above)
        parts_below, parts_above = (
            [int(finder.first[block]) + part for part in geometry.solids[block].sides[side].parts]
            for block, side in zip(ends, joint.sides, strict=True)
        )
        part_pairs = [int(pair_number(i, j, len(finder.owner))) for i in parts_below for j in parts_above]  # type: ignore[arg-type]
        pairs += [pair] * len(part_pairs)
        numbers += part_pairs
        points += [count] * len(part_pairs)
    order = np.argsort(numbers, kind="stable")
    return (np.array(pairs)[order], np.array(numbers)[order]), np.array(points)[order]
