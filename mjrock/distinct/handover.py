"""Handover: lines of a pair of blocks that take the place of others, with their friction."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..quantities import Array, Flags, Integers
from .looking import nearest
from .pair_law import are_among
from .rows import POINT, Rows


class Poses(NamedTuple):
    """Where all blocks are.

    Args:
        drawn: the centroids as drawn [m], shape (blocks, d).
        moved: their displacements from there [m], shape (blocks, d).
        turn: quaternions, shape (blocks, 4).
        change: rotations less 1, shape (blocks, d, d).
    """

    drawn: Array
    moved: Array
    turn: Array
    change: Array

    def far(self, other: Poses, sizes: Array) -> Array:
        """How far a corner of each block may be from where it is in other poses [m], shape (blocks,)."""
        way = np.linalg.norm(self.moved - other.moved, axis=1)
        return np.asarray(way + np.linalg.norm(self.change - other.change, axis=(1, 2)) * sizes)

    def turned(self, block: Integers, a: Array) -> Array:
        """Vectors of blocks in the axes of the world, shape (n, d)."""
        return np.asarray(a + np.einsum("nij,nj->ni", self.change[block], a))

    def turned_back(self, block: Integers, a: Array) -> Array:
        """Vectors of the world in the axes of blocks, shape (n, d)."""
        return np.asarray(a + np.einsum("nji,nj->ni", self.change[block], a))


class ContactPlaces(NamedTuple):
    """Lines where they are.

    Args:
        pair: number of the pair of blocks of each line, shape (n,).
        body, face: blocks of their points and of their faces, shape (n,).
        held: whether the face is that of a fixed block, shape (n,). Its vectors are those of the world.
        at: the points [m], shape (n, d).
        normal: out of the faces, shape (n, d).
    """

    pair: Integers
    body: Integers
    face: Integers
    held: Flags
    at: Array
    normal: Array

    @property
    def sense(self) -> Array:
        """1 where the point is on the second block of the pair, -1 where it is on the first, shape (n, 1)."""
        return np.where(self.body > self.face, 1.0, -1.0)[:, None]


def places_of(lines: Rows, pair: Integers, poses: Poses, free: Integers) -> ContactPlaces:
    """Where lines are.

    Args:
        lines: the lines.
        pair: number of the pair of blocks of each, shape (n,).
        poses: of all blocks.
        free: the block of each body, shape (bodies,).
    """
    body, held, point = free[lines["body"]], lines["face"] < 0, (lines["face"] == POINT)[:, None]
    face = np.sum(np.divmod(pair, len(poses.moved)), axis=0) - body
    arm, origin = (poses.turned(block, lines[name]) for block, name in ((body, "at"), (face, "origin")))
    way = arm - lines["at"] + poses.moved[body]
    of_face = np.where(held[:, None], 0.0, origin - lines["origin"]) + poses.moved[face]
    turns = np.where(point[:, 0], body, face)
    normal = np.where(held[:, None] & ~point, lines["normal"], poses.turned(turns, lines["normal"]))
    at = poses.drawn[body] + poses.moved[body] + arm - np.where(point, lines["between"] + way - of_face, 0.0)
    return ContactPlaces(pair, body, face, held, at, normal)


def in_pairs(pair: Integers) -> tuple[Integers, Integers, Integers]:
    """Numbers of the pairs of lines, an order of the lines by pair, and where each pair begins and ends in it."""
    order = np.argsort(pair, kind="stable")
    pairs, first = np.unique(pair[order], return_index=True)
    return pairs, order, np.append(first, len(order))


def take_over(lines: Rows, new: ContactPlaces, overlap: Array, gone: Rows, old: ContactPlaces, poses: Poses) -> None:
    """Let lines take over the friction, and the push of the last step, of those of their pair that are gone.

    Each line that is gone gives all that it has to the nearest one, so that the forces of a pair stay.

    Args:
        lines, new: the lines, and where they are.
        overlap: what presses of each line [m], shape (n,). Springs along the face hold no more than friction allows.
        gone, old: those that are gone, and where they are.
        poses: of all blocks.
    """
    pairs, order, first = in_pairs(new.pair)
    source = np.flatnonzero(are_among(old.pair, pairs) & ((gone["push"] != 0) | (gone["depth"] > 0)))
    chosen = np.empty(len(source), dtype=np.int64)
    nearest(np.searchsorted(pairs, old.pair[source]), old.at[source], first, new.at[order], chosen)
    target = order[chosen]
    for name in ("push", "pressed"):
        np.add.at(lines[name], target, gone[name][source])
    np.maximum.at(lines["depth"], target, gone["depth"][source])
    lines["rate"][target] = gone["rate"][source]
    before, after = _some(old, source), _some(new, target)
    for name in ("grip", "dragged"):
        turns = name == "grip"
        along = _in_world(gone[name][source], before, poses, turns=turns)
        along = _of_line(after.sense * before.sense * along, after, poses, turns=turns)
        if turns:  # what springs are stretched by is kept, and of rigid friction the force
            sprung = np.isfinite(lines["k_s"][target])
            along[sprung] *= (gone["k_s"][source][sprung] / lines["k_s"][target][sprung])[:, None]
        np.add.at(lines[name], target, along)
    sprung = np.flatnonzero(np.isfinite(lines["k_s"]))
    most = lines["friction"][sprung] * lines["k"][sprung] * overlap[sprung] / lines["k_s"][sprung]
    stretch = np.linalg.norm(lines["grip"][sprung], axis=1)
    lines["grip"][sprung] *= np.minimum(most / np.maximum(stretch, 1e-300), 1.0)[:, None]


def _some(places: ContactPlaces, which: Integers) -> ContactPlaces:
    return ContactPlaces._make(part[which] for part in places)


def _in_world(along: Array, places: ContactPlaces, poses: Poses, *, turns: bool) -> Array:
    """Vectors of the world from what lines keep along their faces, in the axes of the face if it `turns` with it."""
    if along.shape[1] == 1:
        return np.asarray(along * _tangents(places))
    return np.where(places.held[:, None] | (not turns), along, poses.turned(places.face, along))


def _of_line(along: Array, places: ContactPlaces, poses: Poses, *, turns: bool) -> Array:
    """What lines keep of vectors of the world, see `_in_world`."""
    if along.shape[1] == 2:
        return np.asarray(np.sum(along * _tangents(places), axis=1, keepdims=True))
    return np.where(places.held[:, None] | (not turns), along, poses.turned_back(places.face, along))


def _tangents(places: ContactPlaces) -> Array:
    """Directions along the faces of the plane, see `geometry.vectors.tangent`."""
    return np.column_stack([places.normal[:, 1], -places.normal[:, 0]])
