"""Handover: replaces contact lines of two blocks by newly found ones, and keeps their force, friction and energy.

The new lines of a pair start with at most the force and energy of those before them, so that a search adds no energy.
Each takes over the friction of the old lines that it is nearest to.
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
from ..contacts.friction import along_face, shortened, turned_along
from ..contacts.touches import FIRST_OPENING
from ..rows import POINT_ON_FIXED_BLOCK, Row, Rows
from .constants import AS_NEAR, REGAINED, SAME_NORMAL, SAME_PLACE
from .finder import Found
from .solids import Poses, changed


class Blocks(NamedTuple):
    """All blocks, and the numbers by which they go.

    Args:
        poses: where they are.
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
        slack, depth: the part of the overlap of each without force, and the part with force [m], shape (n,) each.
        at: room for their points [m], shape (n, d).
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
    """Which places and which lines that are gone belong to the same two blocks.

    Args:
        first: where the places of each pair begin, and where those of the last end, shape (pairs + 1,).
        low, high: where the lines of each pair that are gone begin and end, shape (pairs,) each.
    """

    first: Integers
    low: Integers
    high: Integers

    @classmethod
    def belonging(cls, places: Integers, gone: Integers) -> Pairs:
        """From the number of the pair of each place, where those of a pair stand together, and of each line that is
        gone, where they increase."""
        first = np.concatenate([[0], np.flatnonzero(np.diff(places)) + 1, [len(places)]])
        pairs = places[first[:-1]] if len(places) else places
        return cls(first, *(np.searchsorted(gone, pairs, side) for side in ("left", "right")))


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
    """Where the centroid of a block is [m], with as many components as another vector."""
    return plus(vector(poses.drawn, block, like), vector(poses.moved, block, like))


class Place(NamedTuple):
    """Where a line is.

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
def place_of(line: Row, both: int, blocks: Blocks) -> Place:
    """Where a line is, of a pair of blocks whose numbers have some sum."""
    poses, block = blocks.poses, blocks.free[line.body]
    face, normal, own = both - block, read(line.normal), read(line.at)
    arm = turned(poses, block, own)
    at = plus(centroid(poses, block, own), arm)
    if line.face == POINT_ON_FIXED_BLOCK:
        way = minus(plus(minus(arm, own), vector(poses.moved, block, own)), vector(poses.moved, face, own))
        at, normal = minus(at, plus(read(line.between), way)), turned(poses, block, normal)
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
    best, least = -1, math.inf
    for j in range(ends[0], ends[1]):
        square = square_between(lines, j, at)
        if square < least:
            best, least = j, square
    return best, math.sqrt(least)


@inlined
def pressed_at(line: Row, i: int, found: Found, gone: Lines, ends: tuple[int, int], blocks: Blocks) -> float:
    """The part of the overlap of place i, where a new line is, that has a force [m], if a line of its pair was there,
    see `hand_over`. It is that of the nearest line of such a normal: at a corner two joints of a pair may have their
    lines.
    """
    overlap: float = max(-found.gap[i], 0.0)
    like = read(line.normal)
    face, other, at, normal = found.face[i], found.other[i], vector(found.place, i, like), vector(found.normal, i, like)
    bound, best, least = (SAME_PLACE * min(blocks.sizes[face], blocks.sizes[other])) ** 2, -1, math.inf
    for j in range(ends[0], ends[1] if overlap > 0 else ends[0]):
        square = square_between(gone, j, at)
        if square < least:
            there, sense = place_of(gone.rows[j], face + other, blocks), 1.0 if other > face else -1.0
            deep = dot(normal, minus(there.at, at))
            if square - deep * deep < bound and sense * there.sense * dot(normal, there.normal) > SAME_NORMAL:
                best, least = j, square
    pressed: float = max(overlap - gone.slack[best], 0.0) if best >= 0 else 0.0
    return pressed


@inlined
def press(new: Lines, places: tuple[int, int], found: Found, gone: Lines, ends: tuple[int, int]) -> None:
    """Give the places of a pair in all the normal force of the lines that they replace, and no more energy. A pair that
    has lost force in a search gets it back in later ones, since blocks would otherwise sink into each other from search
    to search.
    """
    force = energy = had = held = 0.0
    for j in range(ends[0], ends[1]):
        had += normal_force(gone.rows[j], -gone.depth[j], 0.0)
        held += stored(gone.rows[j], -gone.depth[j])
    for i in range(places[0], places[1]):
        force += normal_force(new.rows[i], -new.depth[i], 0.0)
        energy += stored(new.rows[i], -new.depth[i])
    of_force, of_energy = (min(REGAINED, had / force), held / energy) if force > 0 else (0.0, 0.0)
    for i in range(places[0], places[1]):
        row, depth = new.rows[i], new.depth[i]
        pressed = min(depth_of_force(row, of_force, depth), depth_of_energy(row, of_energy, depth))
        new.depth[i] = min(pressed, max(-found.gap[i], 0.0))


@inlined
def write_line(line: Row, i: int, slack: float, found: Found, blocks: Blocks) -> None:
    """Write where the point and the face of place i are, in the axes of their blocks.

    A fixed block carries no point but where its corner meets the face of a body.
    """
    like = read(line.normal)
    poses, face, block, normal = blocks.poses, found.face[i], found.other[i], vector(found.normal, i, like)
    point = blocks.body[block] < 0
    if point:
        face, block, normal = block, face, scaled(-1.0, normal)
    held, half, place = blocks.body[face] < 0, scaled(0.5 * found.gap[i], normal), vector(found.place, i, like)
    at = turned_back(poses, block, minus(plus(place, half), centroid(poses, block, like)))
    origin = minus(minus(place, half), scaled(slack, normal))
    between = plus(vector(poses.drawn, block, like), at)
    if held:
        origin = minus(origin, vector(poses.moved, face, like))
    else:
        origin = turned_back(poses, face, minus(origin, centroid(poses, face, like)))
        between = minus(between, vector(poses.drawn, face, like))
    if point or not held:
        normal = turned_back(poses, block if point else face, normal)
    line.body, line.face = blocks.body[block], POINT_ON_FIXED_BLOCK if point else blocks.body[face]
    line.support, line.fixed = blocks.support[face], blocks.fixed[face]
    put(line.at, at)
    put(line.origin, origin)
    put(line.between, minus(between, origin))
    put(line.normal, normal)


@inlined
def along_new(along: Vector, old: Place, new: Place) -> Vector:
    """The force or elongation that a line keeps along its face, in the axes of another face. In the plane it is a
    number along the tangent. Past an end of its face it is turned back along this first.
    """
    sense = old.sense * new.sense
    if len(along) == 1:
        return (sense * along[0] * dot(tangent(old.normal), tangent(new.normal)),)
    return along_face(new.normal, turned_along(old.normal, scaled(sense, along)))


@inlined
def give(gone: Row, line: Row, share: float, both: int, blocks: Blocks) -> None:
    """Give a line a share of the friction of one that it replaces, and of its normal force of the last step.

    Of a spring along the face the force is kept, as that of rigid friction is. Of several the deepest
    gives its rate.
    """
    poses, old, new = blocks.poses, place_of(gone, both, blocks), place_of(line, both, blocks)
    line.push, line.pressed = line.push + share * gone.push, line.pressed + share * gone.pressed
    if gone.depth > line.depth or line.depth == 0:
        line.depth, line.rate = gone.depth, gone.rate
    grip = scaled(share, read(gone.grip))
    if gone.face >= 0:
        grip = turned(poses, old.face, grip)
    grip = along_new(grip, old, new)
    if line.face >= 0:
        grip = turned_back(poses, new.face, grip)
    increase(line.grip, scaled(gone.k_s / line.k_s if line.k_s < math.inf else 1.0, grip))
    increase(line.dragged, along_new(scaled(share, read(gone.dragged)), old, new))


@inlined
def give_to_nearest(gone: Row, new: Lines, places: tuple[int, int], both: int, blocks: Blocks) -> None:
    """Give the forces of a line that is replaced to the nearest places of its pair. Places that are equally near share
    them.
    """
    at, count = place_of(gone, both, blocks).at, 0
    _, off = nearest(new, places, at)
    near = AS_NEAR * off * off
    for i in range(places[0], places[1]):
        count += square_between(new, i, at) <= near
    for i in range(places[0], places[1]):
        if square_between(new, i, at) <= near:
            give(gone, new.rows[i], 1 / count, both, blocks)


@compiled_at_once
def keep_depths(new: Lines, found: Found, gone: Lines, pairs: Pairs, blocks: Blocks) -> None:
    """Write the part of the overlap of each place that had a force, and where lines that are gone have their points,
    see `hand_over`."""
    for p in range(len(pairs.low)):
        begin, end, ends = pairs.first[p], pairs.first[p + 1], (pairs.low[p], pairs.high[p])
        both = found.face[begin] + found.other[begin]
        for j in range(ends[0], ends[1]):
            put(gone.at[j], place_of(gone.rows[j], both, blocks).at)
        for i in range(begin, end):
            new.depth[i] = pressed_at(new.rows[i], i, found, gone, ends, blocks)


@compiled_at_once
def hand_over(new: Lines, found: Found, gone: Lines, pairs: Pairs, blocks: Blocks) -> None:
    """Write the lines of places, and give them the forces of the lines of their pair that they replace.

    The part of the overlap without force is written too. It is the whole overlap of a place that no line was near, for
    as long as this overlap lasts. So a contact that an earlier search has missed, or one that touched at rest without a
    joint, adds no energy. The places of a pair have the normal force of the lines before them where they can, and no
    more energy. Each line that is replaced gives all of its force along its face to the nearest new ones, so that the
    forces of a pair are kept.

    Args:
        new: rows with the law of each place, `keep_depths`, and room for what does not press of their overlap.
        found: the places, those of a pair together.
        gone: the lines that are gone, in the order of their pairs.
        pairs: which of both belong together.
        blocks: all blocks.
    """
    for p in range(len(pairs.low)):
        begin, end, ends = pairs.first[p], pairs.first[p + 1], (pairs.low[p], pairs.high[p])
        both = found.face[begin] + found.other[begin]
        press(new, (begin, end), found, gone, ends)
        for i in range(begin, end):
            unpressed = FIRST_OPENING * min(blocks.sizes[found.face[i]], blocks.sizes[found.other[i]])
            pressed = new.depth[i] if new.depth[i] > 0 else -unpressed
            new.slack[i] = max(-found.gap[i] - pressed, 0.0)
            write_line(new.rows[i], i, new.slack[i], found, blocks)
            put(new.at[i], place_of(new.rows[i], both, blocks).at)
        for j in range(ends[0], ends[1]):
            old = gone.rows[j]
            if old.push != 0 or max(old.depth, gone.depth[j]) > 0:  # at a start no step has written its depth
                give_to_nearest(old, new, (begin, end), both, blocks)
        for i in range(begin, end):
            line = new.rows[i]
            if line.k_s < math.inf:
                most = shear_limit(line, normal_force(line, -new.depth[i], 0.0)) / line.k_s
                put(line.grip, shortened(read(line.grip), most))
