"""Encounters in space: corners of blocks that have left their joints meet faces of other blocks.

They are looked for as in the plane, see `mjrock.distinct.encounters`. A corner that has come through a face presses on
it until it leaves its outline. Corners of fixed blocks meet no face, and edges that cross do not meet.
"""

from __future__ import annotations

import numpy as np

from ...problem.masonry.joints_in_space import faces_of
from ...problem.masonry.masonry import Masonry
from ...quantities import Array, Flags, Integers
from ..encounters import CORNERS, Looking, pair_number
from ..system import Rows, rows, stacked
from .assembly import edges_of_face
from .columns import PLACE, QUATERNION, REST, named_vectors, turns
from .contact import NEAR, THROUGH
from .system import POINT, WAY, System


class EncountersInSpace(Looking):
    """The blocks of masonry as polyhedra, and the points where they meet beyond their joints."""

    def __init__(self, masonry: Masonry, system: System, joint: Integers) -> None:
        super().__init__(masonry, system, joint)
        blocks, free = masonry.blocks, self.body >= 0
        self.rest = np.where(free[:, None], stacked(system.bodies, REST)[self.body], 0.0)
        faces = [faces_of(block) for block in blocks]
        shape = len(blocks), max(map(len, faces)), max(len(block.corners) for block in blocks)
        self.corners = np.full((shape[0], shape[2], 3), np.nan)  # from the centroid, of fixed blocks from the origin
        self.normals, self.offsets = np.zeros((*shape[:2], 3)), np.full(shape[:2], np.inf)
        self.ends = np.zeros((*shape[:2], 2), dtype=np.int64)
        tables, count = [system.edges], len(system.edges)
        for i, (block, sides) in enumerate(zip(blocks, faces, strict=True)):
            self.corners[i, : len(block.corners)] = block.corners - self.rest[i]
            for j, face in enumerate(sides):
                self.normals[i, j], self.offsets[i, j] = face.normal, face.offset - face.normal @ self.rest[i]
                tables.append(edges_of_face(face, self.rest[i]))
                self.ends[i, j] = count, count + len(tables[-1])
                count += len(tables[-1])
        self.edges = np.concatenate(tables).view(np.recarray)

    def made_room(self, system: System) -> System:
        """The system with the edges of all faces, and room for the ways of encounters that stick rigidly."""
        ways = rows(WAY, len(system.ways) + 2 * self.most) if len(system.ways) else system.ways
        return system._replace(edges=self.edges, ways=ways)

    def moved(self, bodies: Rows) -> Array:
        """As in `Looking`."""
        turned = 2 * np.arccos(np.minimum(np.abs(np.asarray(bodies)["qw"]), 1.0))
        return np.asarray(np.linalg.norm(stacked(bodies, PLACE), axis=1) + turned * self.sizes)

    def speeds(self, bodies: Rows) -> Array:
        """As in `Looking`."""
        linear, angular = stacked(bodies, ("vx", "vy", "vz")), stacked(bodies, ("wx", "wy", "wz"))
        return np.asarray(np.linalg.norm(linear, axis=1) + np.linalg.norm(angular, axis=1) * self.sizes)

    def looked_for(self, system: System, loose: Flags, until: float) -> System:
        """As in `Looking`."""
        bodies, free = system.bodies, self.body >= 0
        near, held = self._near(bodies, until), self._held(system, loose)
        places = self.rest + np.where(free[:, None], stacked(bodies, PLACE)[self.body], 0.0)
        turn = np.where(free[:, None, None], turns(stacked(bodies, QUATERNION))[self.body], 0.0)
        corners = places[:, None] + self.corners + np.einsum("nij,ncj->nci", turn, self.corners)
        pairs = self._close(corners, near, np.append(loose, False)[self.body])
        of, other = pairs[~np.isin(pair_number(pairs[:, 0], pairs[:, 1], len(self.body)), held)].T
        within = corners[of] - places[other][:, None]  # corners of one block in the axes of the other
        within = within + np.einsum("pji,pcj->pci", turn[other], within)
        gaps = np.einsum("pfi,pci->pcf", self.normals[other], within) - self.offsets[other][:, None]
        widest = gaps.max(axis=2, keepdims=True)
        pair, corner, face = np.nonzero(((gaps > 0) | (gaps == widest)) & (widest <= near))
        numbers = np.column_stack([of[pair], corner, other[pair], face])
        points = self._points(numbers, within[pair, corner], gaps[pair, corner, face], system.lines[len(self.joints) :])
        joined: System = self._joined(system, points)
        return joined

    def _close(self, corners: Array, near: float, loose: Flags) -> Integers:
        """Pairs of a free block and another one, one of them loose, whose extents come near, shape (pairs, 2)."""
        low, high = np.nanmin(corners, axis=1) - near, np.nanmax(corners, axis=1)
        meet = loose[:, None] | loose
        for axis in range(3):
            meet &= (low[:, None, axis] <= high[:, axis]) & (low[:, axis] <= high[:, None, axis])
        np.fill_diagonal(meet, val=False)
        meet[self.body < 0] = False
        return np.argwhere(meet)

    def _points(self, numbers: Integers, within: Array, gaps: Array, last: Rows) -> Rows:
        """Points of encounters: those of the last look that press, and new ones.

        Args:
            numbers: of two blocks with a corner of one and a face of the other, shape (count, 4).
            within: the corners, from the centroid of the other block in its axes [m], shape (count, 3).
            gaps: of the corners [m], shape (count,).
            last: the points of the last look.
        """
        a, corner, b, face = numbers.T
        keys = ((a * CORNERS + corner) * len(self.body) + b) * CORNERS + face
        pressing = last["corner"] == THROUGH
        kept, kept_keys, kept_overlaps = last[pressing], self.keys[pressing], self.overlaps[pressing]
        free = ~np.isin(keys // CORNERS, kept_keys // CORNERS)
        free &= np.cumsum(free) <= self.most - len(kept)
        (a, corner, b, face), within, gaps = numbers[free].T, within[free], gaps[free]
        overlaps, _, _ = self._remembered(keys[free], gaps)
        at, normal, ends = self.corners[a, corner], self.normals[b, face], self.ends[b, face]
        origin = within + (overlaps - gaps)[:, None] * normal  # the face is taken to lie where the corner is
        points = rows(
            POINT,
            len(a),
            body=self.body[a],
            face=self.body[b],
            support=-1,
            group=self.group,
            corner=NEAR,
            **named_vectors(at=at, origin=origin, normal=normal, between=self.rest[a] + at - self.rest[b] - origin),
            **{name: self.softest[name][self.body[a]] for name in ("k", "c", "k_s", "c_s", "friction")},
            first=ends[:, 0],
            last=ends[:, 1],
        )
        self.keys, self.overlaps = np.append(kept_keys, self.keys), np.append(kept_overlaps, self.overlaps)
        return np.concatenate([kept, points]).view(np.recarray)
