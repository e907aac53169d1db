"""Encounters: blocks that have left their joints meet others, corner on face.

From time to time the blocks that have moved by more than the width of a joint are looked at. Where a corner of one
comes near a face of another that it has no closed joint with, a contact line appears there for each face that the
corner is outside of, or for the nearest where it is inside. It has the stiffness, damping and friction of the
softest line of the block that carries the corner. Two blocks that overlap when their line appears push each other apart
only where they come nearer. A corner that has come through a face presses on it until it leaves its outline, see
`contact.cornered`, and meets no other face of that block from within. Corners of fixed blocks meet no face, and edges
that cross do not meet.
"""

from __future__ import annotations

import numpy as np

from ..problem.masonry.lines import free_numbers
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Flags, Integers
from .contact import NEAR, THROUGH
from .faces import edges_of, outlines_of
from .looking import Look, near_corners, pair_number
from .rows import Rows, joined, rows
from .system import System
from .turning import angles, rotations

AHEAD = 2.0
"""Distance up to which a corner is near a face, over the way that a block makes until the next look [-]."""
LEAST = 1e-3
"""Smallest distance up to which a corner is near a face, over the size of the smallest block [-]."""
MOST = 16
"""Encounters for which there is room, over the number of blocks [-]."""


class Encounters:
    """The blocks of masonry, and the lines where they meet beyond their joints.

    Args:
        masonry: the masonry.
        system: its bodies, and the lines of its joints.
        joint: number of the joint of each line. The account of the encounters comes after those of the joints.
    """

    def __init__(self, masonry: Masonry, system: System, joint: Integers) -> None:
        blocks = masonry.blocks
        self.joints, self.group, self.capacity = system.lines, len(masonry.joints), MOST * len(blocks) + 64
        self.body = free_numbers(blocks)
        self.widths = narrowest(masonry)
        self.sizes = np.array([blocks[i].size for i in masonry.free])
        self.softest = softest(self.joints, len(masonry.free))
        self.pairs = pairs_of(masonry, joint)
        self.rest = np.where(self.body[:, None] >= 0, system.bodies["rest"][self.body], 0.0)
        self.corners = np.concatenate([b.corners - at for b, at in zip(blocks, self.rest, strict=True)])
        self.first = np.cumsum([0, *(len(block.corners) for block in blocks)])
        outlines = [outlines_of(block) for block in blocks]
        self.first_face = np.cumsum([0, *map(len, outlines)])
        faces = [(face, at) for sides, at in zip(outlines, self.rest, strict=True) for face in sides]
        self.normals = np.array([face.normal for face, _ in faces])
        self.offsets = np.array([((face.corners - at) @ face.normal).mean() for face, at in faces])
        edges = [edges_of(face, at) for face, at in faces]
        self.ends = len(system.edges) + np.cumsum([0, *map(len, edges)])  # of the edges of each face
        self.edges = joined(system.edges, *edges)
        self.room = np.zeros((self.capacity, 5))
        self.keys = np.empty((0, 4), dtype=np.int64)  # of the lines there are, see `_lines`

    def made_room(self, system: System) -> System:
        """The system with the edges of all faces, and room for the ways of encounters that stick rigidly."""
        further = (len(system.axes) - 1) * self.capacity if len(system.ways) else 0
        ways = rows(system.ways.dtype, len(system.ways) + further)
        return system._replace(edges=self.edges, ways=ways)

    def loose(self, system: System) -> Flags:
        """Which bodies have a corner that may have moved by more than the narrowest of their joints is wide."""
        bodies = system.bodies
        moved = np.linalg.norm(bodies["place"], axis=1) + angles(bodies) * self.sizes
        return np.asarray(moved > self.widths)

    def looked_for(self, system: System, loose: Flags, until: float) -> System:
        """The system with the lines of the encounters that may happen within a time [s]."""
        bodies, free = system.bodies, self.body >= 0
        held = self._held(system, loose)
        places = self.rest + np.where(free[:, None], bodies["place"][self.body], 0.0)
        turn = np.where(free[:, None, None], rotations(bodies)[self.body], 0.0)
        of_corner, of_face = (np.repeat(np.arange(len(free)), np.diff(n)) for n in (self.first, self.first_face))
        corners = places[of_corner] + self.corners + np.einsum("nij,nj->ni", turn[of_corner], self.corners)
        normals = self.normals + np.einsum("nij,nj->ni", turn[of_face], self.normals)
        offsets = self.offsets + (normals * places[of_face]).sum(axis=1)
        low, high = (ends.reduceat(corners, self.first[:-1]) for ends in (np.minimum, np.maximum))
        axis = int(np.ptp(low, axis=0).argmax())
        order = np.argsort(low[:, axis], kind="stable")
        loose_blocks = np.append(loose, False)[self.body]
        look = Look(
            corners, self.first, normals, offsets, self.first_face, low, high, order, axis, loose_blocks, ~free, held,
            LEAST * float(self.sizes.min()),
        )  # fmt: skip
        last = self._lasting(system.lines[len(self.joints) :], look)
        count = near_corners(look, self._near(bodies, until), self.room)
        met = self.room[:count, :4].astype(np.int64)
        corner, other = met[:, 1], met[:, 2]
        within = corners[corner] - places[other]  # corners of one block in the axes of the other
        within = within + np.einsum("nji,nj->ni", turn[other], within)
        new = self._unknown(met, self.room[:count, 4])[: self.capacity - len(last)]
        lines = self._lines(met[new], within[new], self.room[new, 4])
        return system._replace(lines=joined(system.lines[: len(self.joints)], last, lines))

    def _near(self, bodies: Rows, until: float) -> float:
        """Distance up to which a corner is near what it may meet within a time [m]."""
        speeds = np.linalg.norm(bodies["velocity"], axis=1) + np.linalg.norm(bodies["spin"], axis=1) * self.sizes
        return max(AHEAD * float(speeds.max()) * until, LEAST * float(self.sizes.min()))

    def _held(self, system: System, loose: Flags) -> Integers:
        """Pairs of blocks whose joint still touches, as numbers in order. A joint of loose blocks that has opened is
        gone for good."""
        lines = system.lines[: len(self.joints)]
        free = np.append(loose, False)
        either = free[lines["body"]] | free[lines["face"]]
        touches, pairs = lines["depth"] > 0, self.pairs
        closed = np.unique(pairs[touches | ~either])
        gone = either & ~np.isin(pairs, closed)
        for name in ("k", "c", "friction"):
            lines[name][gone] = 0.0
        return np.asarray(np.setdiff1d(closed, pairs[lines["k"] == 0]), dtype=np.int64)

    def _lasting(self, lines: Rows, look: Look) -> Rows:
        """The lines of corners that have come through their face, or are behind it since the last step."""
        _, corner, _, face = self.keys.T
        gaps = (look.normals[face] * look.corners[corner]).sum(axis=1) - look.offsets[face]
        lasts = (lines["corner"] == THROUGH) | ((lines["corner"] == NEAR) & (gaps < 0))
        self.keys = self.keys[lasts]
        lasting: Rows = lines[lasts]
        return lasting

    def _unknown(self, met: Integers, gaps: Array) -> Integers:
        """Which corners near faces have no line yet: not one on this face, nor, within the block, one on another."""
        blocks, faces = len(self.body), len(self.normals)
        corner_and_block, known = (numbers[:, 1] * blocks + numbers[:, 2] for numbers in (met, self.keys))
        on_face = np.isin(corner_and_block * faces + met[:, 3], known * faces + self.keys[:, 3])
        return np.flatnonzero(~on_face & ((gaps > 0) | ~np.isin(corner_and_block, known)))

    def _lines(self, met: Integers, within: Array, gaps: Array) -> Rows:
        """New lines of encounters.

        Args:
            met: two blocks with the numbers of a corner of one and of a face of the other, shape (count, 4).
            within: the corners, from the centroid of the other block in its axes [m], shape (count, d).
            gaps: of the corners [m], shape (count,).
        """
        block, corner, other, face = met.T
        at, normal = self.corners[corner], self.normals[face]
        origin = within - np.maximum(gaps, 0.0)[:, None] * normal  # or the face is taken to lie where the corner is
        self.keys = np.concatenate([self.keys, met])
        return rows(
            self.joints.dtype,
            len(met),
            body=self.body[block],
            face=self.body[other],
            support=-1,
            group=self.group,
            corner=NEAR,
            at=at,
            origin=origin,
            between=self.rest[block] + at - self.rest[other] - origin,
            normal=normal,
            first=self.ends[face],
            last=self.ends[face + 1],
            **{name: self.softest[name][self.body[block]] for name in ("k", "c", "k_s", "c_s", "friction")},
        )


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
