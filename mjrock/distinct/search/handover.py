"""Handover: replaces the contact lines of two blocks by newly found ones, which take over force, friction and energy.

The new lines of a pair start with at most the force and energy of the old ones, so that a search adds no energy. The
friction of each old line goes to the nearest new ones.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...compiled import compiled_at_once, inlined
from ...geometry.vectors import (
    Vector,
    dot,
    increase,
    minus,
    plus,
    put,
    read,
    scaled,
    tangent,
    vector,
)
from ...problem.masonry.laws.joint_law import depth_of_energy, depth_of_force, normal_force, shear_limit, stored
from ...quantities import Array, Integers
from ...rows import Row, Rows
from ..contacts.friction import along_face, shortened, turned_along
from ..contacts.touches import FIRST_OPENING
from ..rows import POINT_ON_FIXED_BLOCK
from .constants import AS_NEAR, REGAINED, SAME_NORMAL, SAME_PLACE
from .finder import ContactPlaces
from .solids import Poses, changed


class Blocks(NamedTuple):
    """All blocks, with their numbers as bodies, fixed blocks and supports.

    Args:
        poses: of all blocks.
        sizes: the largest distance of a corner from the centroid of each [m], shape (blocks,).
        free: the block of each body, shape (bodies,).
        body: the body of each block, negative for a fixed one, shape (blocks,).
        fixed: number of each fixed block among these, -1 for a body, shape (blocks,).
        support: the support that moves each block, -1 for none, shape (blocks,).
    """

    poses: Poses
    sizes: Array
    free: Integers
    body: Integers
    fixed: Integers
    support: Integers


class Lines(NamedTuple):
    """Lines of pairs.

    Args:
        rows: their numbers.
        slack, depth: parts of the overlap of each without force and with force [m], shape (n,) each.
        at: room for the positions of their points [m], shape (n, d).
    """

    rows: Rows
    slack: Array
    depth: Array
    at: Array

    @classmethod
    def unwritten(cls, table: Rows, slack: Array) -> Lines:
        """Lines with room for the rest."""
        return cls(table, slack, np.empty(len(table)), np.empty_like(table["at"]))


class Pairs(NamedTuple):
    """Which new places and which old lines belong to the same two blocks.

    Args:
        first: where the places of each pair begin, and where those of the last end, shape (pairs + 1,).
        low, high: where the old lines of each pair begin and end, shape (pairs,) each.
    """

    first: Integers
    low: Integers
    high: Integers

    @classmethod
    def belonging(cls, places: Integers, old: Integers) -> Pairs:
        """From the number of the pair of each place, those of a pair together, and of each old line, increasing."""
        begins = (places[1:] != places[:-1]).nonzero()[0] + 1
        first = np.array([0, *begins.tolist(), len(places)])
        pairs = places[first[:-1]] if len(places) else places
        return cls(first, old.searchsorted(pairs), old.searchsorted(pairs, "right"))


@inlined
def turned(poses: Poses, block: int, a: Vector) -> Vector:
    """A vector of a block in the axes of the world."""
    return changed(poses.change[block], a)


@inlined
def turned_back(poses: Poses, block: int, a: Vector) -> Vector:
    """A vector of the world in the axes of a block."""
    return changed(poses.change[block].T, a)


@inlined
def centroid(poses: Poses, block: int, like: Vector) -> Vector:
    """Position of the centroid of a block [m], with as many components as another vector."""
    return plus(vector(poses.drawn, block, like), vector(poses.moved, block, like))


class Place(NamedTuple):
    """Position and face of a line.

    Args:
        at: its point [m].
        normal: out of the face.
        face: the block of the face.
        sense: 1 where the point is on the block of the pair with the higher number, otherwise -1.
    """

    at: Vector
    normal: Vector
    face: int
    sense: float


@inlined
def place_of(line: Row, block_sum: int, blocks: Blocks) -> Place:
    """Position and face of a line, from the sum of the numbers of its two blocks."""
    poses, block = blocks.poses, blocks.free[line.body]
    face, normal, point = block_sum - block, read(line.normal), read(line.at)
    arm = turned(poses, block, point)
    at = plus(centroid(poses, block, point), arm)
    if line.face == POINT_ON_FIXED_BLOCK:
        shift = minus(plus(minus(arm, point), vector(poses.moved, block, point)), vector(poses.moved, face, point))
        at, normal = minus(at, plus(read(line.between), shift)), turned(poses, block, normal)
    elif line.face >= 0:
        normal = turned(poses, face, normal)
    return Place(at, normal, face, 1.0 if block > face else -1.0)


@inlined
def square_between(lines: Lines, j: int, at: Vector) -> float:
    """Square of the distance of line j from a place [m2]."""
    off = minus(vector(lines.at, j, at), at)
    square: float = dot(off, off)
    return square


@inlined
def nearest(lines: Lines, ends: tuple[int, int], at: Vector) -> tuple[int, float]:
    """Which of the lines of a pair is nearest to a place, -1 where there is none, and its distance [m].

    Args:
        lines, ends: lines with their points, and where those of the pair begin and end.
        at: the place [m].
    """
    best, least_square = -1, math.inf
    for j in range(ends[0], ends[1]):
        square = square_between(lines, j, at)
        if square < least_square:
            best, least_square = j, square
    return best, math.sqrt(least_square)


@inlined
def pressed_overlap(
    line: Row, i: int, places: ContactPlaces, old: Lines, ends: tuple[int, int], blocks: Blocks
) -> float:
    """The part of the overlap of new place i that has a force, zero if no old line of its pair was there [m].

    It is the overlap less the slack of the nearest old line with a similar normal: at a corner two joints of a pair may
    have lines. See `hand_over`.
    """
    overlap: float = max(-places.gap[i], 0.0)
    like = read(line.normal)
    face, other = places.face[i], places.other[i]
    at, normal = vector(places.place, i, like), vector(places.normal, i, like)
    bound, best, least_square = (SAME_PLACE * min(blocks.sizes[face], blocks.sizes[other])) ** 2, -1, math.inf
    for j in range(ends[0], ends[1] if overlap > 0 else ends[0]):
        square = square_between(old, j, at)
        if square < least_square:
            old_place, sense = place_of(old.rows[j], face + other, blocks), 1.0 if other > face else -1.0
            deep = dot(normal, minus(old_place.at, at))
            if square - deep * deep < bound and sense * old_place.sense * dot(normal, old_place.normal) > SAME_NORMAL:
                best, least_square = j, square
    pressed: float = max(overlap - old.slack[best], 0.0) if best >= 0 else 0.0
    return pressed


@inlined
def press(new: Lines, numbers: tuple[int, int], places: ContactPlaces, old: Lines, ends: tuple[int, int]) -> None:
    """Give the places of a pair together the normal force of the lines that they replace, and no more energy.

    A pair that has lost force in a search regains it in later ones: otherwise blocks would sink into each other from
    search to search.
    """
    force = energy = force_before = energy_before = 0.0
    for j in range(ends[0], ends[1]):
        force_before += normal_force(old.rows[j], -old.depth[j], 0.0)
        energy_before += stored(old.rows[j], -old.depth[j])
    for i in range(numbers[0], numbers[1]):
        force += normal_force(new.rows[i], -new.depth[i], 0.0)
        energy += stored(new.rows[i], -new.depth[i])
    of_force, of_energy = (min(REGAINED, force_before / force), energy_before / energy) if force > 0 else (0.0, 0.0)
    for i in range(numbers[0], numbers[1]):
        row, depth = new.rows[i], new.depth[i]
        pressed = min(depth_of_force(row, of_force, depth), depth_of_energy(row, of_energy, depth))
        new.depth[i] = min(pressed, max(-places.gap[i], 0.0))


@inlined
def write_line(line: Row, i: int, slack: float, places: ContactPlaces, blocks: Blocks) -> None:
    """Write the point and the face of place i, in the axes of their blocks.

    A fixed block carries a point only where its corner meets the face of a body.
    """
    like = read(line.normal)
    poses, face, block, normal = blocks.poses, places.face[i], places.other[i], vector(places.normal, i, like)
    point = blocks.body[block] < 0
    if point:
        face, block, normal = block, face, scaled(-1.0, normal)
    fixed, half, place = blocks.body[face] < 0, scaled(0.5 * places.gap[i], normal), vector(places.place, i, like)
    at = turned_back(poses, block, minus(plus(place, half), centroid(poses, block, like)))
    origin = minus(minus(place, half), scaled(slack, normal))
    between = plus(vector(poses.drawn, block, like), at)
    if fixed:
        origin = minus(origin, vector(poses.moved, face, like))
    else:
        origin = turned_back(poses, face, minus(origin, centroid(poses, face, like)))
        between = minus(between, vector(poses.drawn, face, like))
    if point or not fixed:
        normal = turned_back(poses, block if point else face, normal)
    line.body, line.face = blocks.body[block], POINT_ON_FIXED_BLOCK if point else blocks.body[face]
    line.support, line.fixed = blocks.support[face], blocks.fixed[face]
    put(line.at, at)
    put(line.origin, origin)
    put(line.between, minus(between, origin))
    put(line.normal, normal)


@inlined
def along_new(along: Vector, old: Place, new: Place) -> Vector:
    """The force or elongation of a line along its face, in the axes of another face. In the plane it is a number along
    the tangent. Of a line past an end of its face it is first turned into the face.
    """
    sense = old.sense * new.sense
    if len(along) == 1:
        return (sense * along[0] * dot(tangent(old.normal), tangent(new.normal)),)
    return along_face(new.normal, turned_along(old.normal, scaled(sense, along)))


@inlined
def give(old: Row, line: Row, share: float, block_sum: int, blocks: Blocks) -> None:
    """Give a line a share of the friction of one that it replaces, and of its normal force of the last step.

    The force of a shear spring is kept, as that of rigid friction is. The rate is that of the deepest line that it
    replaces.
    """
    poses, old_place, new_place = blocks.poses, place_of(old, block_sum, blocks), place_of(line, block_sum, blocks)
    line.push, line.dashpot_force = line.push + share * old.push, line.dashpot_force + share * old.dashpot_force
    if old.depth > line.depth or line.depth == 0:
        line.depth, line.rate = old.depth, old.rate
    shear = scaled(share, read(old.shear_state))
    if old.face >= 0:
        shear = turned(poses, old_place.face, shear)
    shear = along_new(shear, old_place, new_place)
    if line.face >= 0:
        shear = turned_back(poses, new_place.face, shear)
    increase(line.shear_state, scaled(old.k_s / line.k_s if line.k_s < math.inf else 1.0, shear))
    increase(line.shear_force, along_new(scaled(share, read(old.shear_force)), old_place, new_place))


@inlined
def give_to_nearest(old_line: Row, new: Lines, places: tuple[int, int], block_sum: int, blocks: Blocks) -> None:
    """Give the forces of a line that is replaced to the nearest place of its pair, or to all that are as near."""
    at, count = place_of(old_line, block_sum, blocks).at, 0
    _, off = nearest(new, places, at)
    near = AS_NEAR * off * off
    for i in range(places[0], places[1]):
        count += square_between(new, i, at) <= near
    for i in range(places[0], places[1]):
        if square_between(new, i, at) <= near:
            give(old_line, new.rows[i], 1 / count, block_sum, blocks)


@compiled_at_once
def keep_depths(new: Lines, places: ContactPlaces, old: Lines, pairs: Pairs, blocks: Blocks) -> None:
    """Write the part of the overlap of each place that has a force, and the positions of the old lines, see
    `hand_over`."""
    for p in range(len(pairs.low)):
        begin, end, ends = pairs.first[p], pairs.first[p + 1], (pairs.low[p], pairs.high[p])
        block_sum = places.face[begin] + places.other[begin]
        for j in range(ends[0], ends[1]):
            put(old.at[j], place_of(old.rows[j], block_sum, blocks).at)
        for i in range(begin, end):
            new.depth[i] = pressed_overlap(new.rows[i], i, places, old, ends, blocks)


@compiled_at_once
def hand_over(new: Lines, places: ContactPlaces, old: Lines, pairs: Pairs, blocks: Blocks) -> None:
    """Write the lines of new places, and give them the forces of the lines of their pair that they replace.

    Of a place that no old line was near, the whole overlap has no force for as long as it lasts. So a contact that an
    earlier search has missed, or one that touched at rest without a joint, adds no energy. The places of a pair get the
    normal force of the old lines as far as their overlaps allow it, and no more energy. Each old line gives all of its
    force along the face to the nearest new ones, so that the force of a pair is kept.

    Args:
        new: rows with the law and the depth of each place, see `keep_depths`, and room for their slack.
        places: those of a pair together.
        old: the old lines, in the order of their pairs.
        pairs: which of both belong together.
        blocks: all blocks.
    """
    for p in range(len(pairs.low)):
        begin, end, ends = pairs.first[p], pairs.first[p + 1], (pairs.low[p], pairs.high[p])
        block_sum = places.face[begin] + places.other[begin]
        press(new, (begin, end), places, old, ends)
        for i in range(begin, end):
            unpressed = FIRST_OPENING * min(blocks.sizes[places.face[i]], blocks.sizes[places.other[i]])
            pressed = new.depth[i] if new.depth[i] > 0 else -unpressed
            new.slack[i] = max(-places.gap[i] - pressed, 0.0)
            write_line(new.rows[i], i, new.slack[i], places, blocks)
            put(new.at[i], place_of(new.rows[i], block_sum, blocks).at)
        for j in range(ends[0], ends[1]):
            old_line = old.rows[j]
            if old_line.push != 0 or max(old_line.depth, old.depth[j]) > 0:  # at a start no step has written its depth
                give_to_nearest(old_line, new, (begin, end), block_sum, blocks)
        for i in range(begin, end):
            line = new.rows[i]
            if line.k_s < math.inf:
                limit = shear_limit(line, normal_force(line, -new.depth[i], 0.0)) / line.k_s
                put(line.shear_state, shortened(read(line.shear_state), limit))
