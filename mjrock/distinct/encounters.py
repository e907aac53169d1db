"""Encounters: blocks that have left their joints meet others, corner against edge.

From time to time the blocks that have moved by more than the width of a joint are looked at. Where a corner of one
comes near an edge of another that it has no closed joint with, a contact line appears there, and it lasts until the
next look. It has the stiffness, damping and friction of the softest line of the block that carries the corner. Two
blocks that overlap when their line appears push each other apart only where they come nearer. The corners of fixed
blocks meet no edge.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..compiled import compiled, jitable
from ..problem.masonry.lines import free_numbers
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Flags, Integers
from .system import LINE, Rows, System, rows

NEAR = 2.0
"""Distance up to which a corner is near an edge, over the way that a block makes until the next look [-]."""
LEAST = 1e-3
"""Smallest distance up to which a corner is near an edge, over the size of the smallest block [-]."""
MOST = 16
"""Encounters for which there is room, over the number of blocks [-]."""
CORNERS = 1024
"""More than the corners and than the faces of any block."""
KEPT = ("corner", "grip", "push", "pressed", "dragged")
"""What a line remembers of its last step."""


class Look(NamedTuple):
    """What is looked at for encounters.

    Args:
        places: corners of all blocks [m], shape (corners, 2).
        first: where those of each block begin, and where those of the last end, shape (blocks + 1,).
        order: the blocks by their left ends, shape (blocks,).
        left, right: lowest and highest x of each block [m], shape (blocks,).
        loose, fixed: which blocks have left their places, and which are fixed, shape (blocks,).
        held: pairs of blocks that have a joint, increasing, see `pair_number`.
    """

    places: Array
    first: Integers
    order: Integers
    left: Array
    right: Array
    loose: Flags
    fixed: Flags
    held: Integers


class Looking:
    """What is looked at from time to time, in the plane and in space: which blocks have left their joints.

    Args:
        masonry: the masonry.
        system: its bodies, and the lines of its joints.
        joint: number of the joint of each line. The account of the encounters comes after those of the joints.
    """

    def __init__(self, masonry: Masonry, system: Any, joint: Integers) -> None:
        self.joints, self.group, self.most = system.lines, len(masonry.joints), MOST * len(masonry.blocks) + 64
        self.body = free_numbers(masonry.blocks)
        self.widths = narrowest(masonry)
        self.sizes = np.array([masonry.blocks[i].size for i in masonry.free])
        self.softest = softest(self.joints, len(masonry.free))
        self.pairs = pairs_of(masonry, joint)
        self.keys = np.empty(0, dtype=np.int64)
        self.overlaps = np.empty(0)

    def moved(self, bodies: Rows) -> Array:
        """How far a corner of each body has moved at most [m], shape (bodies,)."""
        raise NotImplementedError

    def speeds(self, bodies: Rows) -> Array:
        """The velocity of a corner of each body at most [m/s], shape (bodies,)."""
        raise NotImplementedError

    def loose(self, system: Any) -> Flags:
        """Which bodies have moved by more than the narrowest of their joints is wide."""
        return np.asarray(self.moved(system.bodies) > self.widths)

    def looked_for(self, system: Any, loose: Flags, until: float) -> Any:
        """The system with the lines of the encounters that may happen within a time [s]."""
        raise NotImplementedError

    def _near(self, bodies: Rows, until: float) -> float:
        """Distance up to which a corner is near what it may meet within a time [m]."""
        return max(NEAR * float(self.speeds(bodies).max()) * until, LEAST * float(self.sizes.min()))

    def _held(self, system: Any, loose: Flags) -> Integers:
        """Pairs of blocks whose joint still touches, as numbers in order. A joint of loose blocks that has opened is
        gone for good."""
        lines = system.lines[: len(self.joints)]
        free = np.append(loose, False)
        either = free[lines["body"]] | free[lines["face"]]
        touches, pairs = lines["push"] > 0, self.pairs
        closed = np.unique(pairs[touches | ~either])
        gone = either & ~np.isin(pairs, closed)
        for name in ("k", "c", "friction"):
            lines[name][gone] = 0.0
        return np.asarray(np.setdiff1d(closed, pairs[lines["k"] == 0]), dtype=np.int64)

    def _joined(self, system: Any, lines: Rows) -> Any:
        """The system with the lines of its joints and those of the encounters."""
        return system._replace(lines=np.concatenate([system.lines[: len(self.joints)], lines]).view(np.recarray))

    def _remembered(self, keys: Integers, gaps: Array) -> tuple[Array, Integers, Integers]:
        """Overlaps that count as none [m], and which of these encounters are which of those of the last look."""
        _, new, old = np.intersect1d(keys, self.keys, return_indices=True)
        overlaps = np.minimum(gaps, 0.0)
        overlaps[new] = np.maximum(self.overlaps[old], overlaps[new])
        self.keys, self.overlaps = keys, overlaps
        return overlaps, new, old


class Encounters(Looking):
    """The blocks of masonry as polygons, and the lines where they meet beyond their joints."""

    def __init__(self, masonry: Masonry, system: System, joint: Integers) -> None:
        super().__init__(masonry, system, joint)
        blocks = masonry.blocks
        self.rest = np.column_stack([system.bodies["x0"], system.bodies["z0"]])
        self.origin = np.where(self.body[:, None] < 0, 0.0, self.rest[self.body])
        self.first = np.cumsum([0, *(len(block.corners) for block in blocks)])
        self.corners = np.concatenate([b.corners - at for b, at in zip(blocks, self.origin, strict=True)])
        self.room = np.zeros((self.most, 5))

    def moved(self, bodies: Rows) -> Array:
        """As in `Looking`."""
        return np.asarray(np.hypot(bodies["x"], bodies["z"]) + np.abs(bodies["theta"]) * self.sizes)

    def speeds(self, bodies: Rows) -> Array:
        """As in `Looking`."""
        return np.asarray(np.hypot(bodies["vx"], bodies["vz"]) + np.abs(bodies["w"]) * self.sizes)

    def looked_for(self, system: System, loose: Flags, until: float) -> System:
        """As in `Looking`."""
        bodies, near = system.bodies, self._near(system.bodies, until)
        held = self._held(system, loose)
        places = self._places(bodies)
        polygon_loose = np.append(loose, False)[self.body]
        left, right = (ends.reduceat(places[:, 0], self.first[:-1]) for ends in (np.minimum, np.maximum))
        order = np.argsort(left, kind="stable").astype(np.int64)
        looks = Look(places, self.first, order, left, right, polygon_loose, self.body < 0, held)
        count = near_corners(looks, near, self.room)
        met = self.room[:count]
        lines = self._lines(met[:, :4].astype(np.int64), met[:, 4], system.lines[len(self.joints) :])
        joined: System = self._joined(system, lines)
        return joined

    def _places(self, bodies: Rows) -> Array:
        """Corners of all blocks at the pose [m], shape (corners, 2)."""
        of = np.repeat(self.body, np.diff(self.first))
        free, (x, z) = of >= 0, self.corners.T
        sine, versine = (np.where(free, bodies[name][of], 0.0) for name in ("sine", "versine"))
        at = [np.where(free, bodies[name][of] + bodies[f"{name}0"][of], 0.0) for name in ("x", "z")]
        return np.column_stack([at[0] + x + z * sine - x * versine, at[1] + z - x * sine - z * versine])

    def _lines(self, numbers: Integers, gaps: Array, last: Rows) -> Rows:
        """Lines of encounters, the numbers of two blocks with a corner of one and an edge of the other, (count, 4)."""
        a, corner, b, edge = numbers.T
        keys = ((a * CORNERS + corner) * len(self.body) + b) * CORNERS + edge
        overlaps, new, old = self._remembered(keys, gaps)
        body, face = self.body[a], self.body[b]
        at = self.corners[self.first[a] + corner]
        start, end = (self.corners[self.first[b] + (edge + i) % np.diff(self.first)[b]] for i in (0, 1))
        length = np.hypot(*(end - start).T)
        normal = np.column_stack([end[:, 1] - start[:, 1], start[:, 0] - end[:, 0]]) / length[:, None]
        start = start + overlaps[:, None] * normal  # the edge is taken to lie where the corner is
        between = (self.origin[a] + at) - (self.origin[b] + start)
        lines = rows(LINE, len(numbers), body=body, face=face, support=-1, group=self.group, corner=1, low=-length)
        for name, values in (("at", at), ("origin", start), ("normal", normal), ("between", between)):
            lines[f"{name}_x"], lines[f"{name}_z"] = values.T
        for name in ("k", "c", "k_s", "c_s", "friction"):
            lines[name] = self.softest[name][body]
        for name in KEPT:
            lines[name][new] = last[name][old]
        return lines


def narrowest(masonry: Masonry) -> Array:
    """Width of the narrowest joint of each free block [m], shape (bodies,)."""
    widths = np.full(len(masonry.blocks), np.inf)
    for joint in masonry.joints:
        for block in (joint.below, joint.above):
            widths[block] = min(widths[block], joint.width)
    return widths[list(masonry.free)]


def softest(lines: Rows, bodies: int) -> Rows:
    """The softest line of each body, or of all where it has none."""
    chosen = np.full(bodies, int(np.argmin(lines["k"])))
    for name in ("face", "body"):
        stiffest_first = np.argsort(-lines["k"], kind="stable")
        stiffest_first = stiffest_first[lines[name][stiffest_first] >= 0]
        chosen[lines[name][stiffest_first]] = stiffest_first  # the last of a body stays
    chosen_lines: Rows = lines[chosen]
    return chosen_lines


def pairs_of(masonry: Masonry, joint: Integers) -> Integers:
    """One number for the pair of blocks of each line, from the number of its joint."""
    below, above = np.array([(joint.below, joint.above) for joint in masonry.joints])[joint].T
    return pair_number(below, above, len(masonry.blocks))


def pair_number(a: Integers, b: Integers, blocks: int) -> Integers:
    """One number for two blocks."""
    return np.asarray(np.minimum(a, b) * blocks + np.maximum(a, b), dtype=np.int64)


@jitable
def among(values: Integers, number: int) -> bool:
    """Whether a number is among increasing values."""
    low, high = 0, len(values)
    while low < high:
        middle = (low + high) // 2
        if values[middle] < number:
            low = middle + 1
        else:
            high = middle
    return low < len(values) and values[low] == number


@jitable
def beside(places: Array, i: int, j: int, x: float, z: float) -> tuple[float, float, float]:
    """Distance of a point from the line of the edge between corners i and j, its place along it, and the length [m]."""
    ex, ez = places[j, 0] - places[i, 0], places[j, 1] - places[i, 1]
    size = math.sqrt(ex * ex + ez * ez)
    dx, dz = x - places[i, 0], z - places[i, 1]
    return (ez * dx - ex * dz) / size, (ex * dx + ez * dz) / size, size


@jitable
def meet_edges(look: Look, near: float, met: Array, count: int, p: int, corner: int, q: int) -> int:
    """Write the edges of block q that a corner of block p may come through: all that it is outside of.

    Where it is inside already, that is the edge that it is nearest to. Returns how many rows are written by then.
    """
    places, start, end = look.places, look.first[q], look.first[q + 1]
    x, z, inside, widest = places[corner, 0], places[corner, 1], -1, -np.inf
    for i in range(start, end):
        apart, place, size = beside(places, i, i + 1 if i + 1 < end else start, x, z)
        if apart > near:
            return count
        if apart > widest:
            inside, widest = i, apart
    for i in range(start, end):
        apart, place, size = beside(places, i, i + 1 if i + 1 < end else start, x, z)
        entered = apart > 0 or (i == inside and widest > -0.5 * size)
        if entered and -near <= place <= size + near and count < len(met):
            met[count, 0], met[count, 1], met[count, 2] = p, corner - look.first[p], q
            met[count, 3], met[count, 4] = i - start, apart
            count += 1
    return count


@compiled
def near_corners(look: Look, near: float, met: Array) -> int:
    """Write corners nearer than `near` [m] to edges of other blocks: block, corner, other block, edge, gap [m].

    Returns:
        How many there are, at most as many as there is room for.
    """
    first, order, loose, held = look.first, look.order, look.loose, look.held
    count, blocks = 0, len(first) - 1
    for turn in range(blocks):
        a = order[turn]
        for other in range(turn + 1, blocks):
            b = order[other]
            if look.left[b] > look.right[a] + near:
                break
            if not (loose[a] or loose[b]) or among(held, min(a, b) * blocks + max(a, b)):
                continue
            for turned in range(2):
                p, q = (a, b) if turned == 0 else (b, a)
                if look.fixed[p]:
                    continue
                for corner in range(first[p], first[p + 1]):
                    count = meet_edges(look, near, met, count, p, corner, q)
    return count
