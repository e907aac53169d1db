"""Finder: where convex blocks meet or are about to, at any pose.

MuJoCo's collision of convex meshes finds the pairs, the normal of each, and the places of edges that cross. The places
of faces come from `clipping`. It decides neither the law of a contact nor the motion. Blocks of the plane are prisms
for it. Its meshes have the digits of single precision, which the places of faces do not depend on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ..problem.masonry.polygon import Polygon
from ..problem.masonry.polyhedron import Polyhedron
from ..quantities import Array, Flags, Integers
from .clipping import Shapes, clip
from .handover import Poses

MEMORY = 1 << 20
"""Room for contacts at the start [byte]. It is doubled as long as contacts do not fit."""
FREE, WATCHED, FIXED = 1, 2, 4
"""Kinds of blocks: a free one that is not watched, one that is, and a fixed one. A pair is looked at if one of the two
is watched."""
CORNERS = 4
"""Places that share what a pair has, where two faces of ashlar lie on each other in space."""


class Found(NamedTuple):
    """Places where two blocks meet or are near.

    Args:
        pair: the two blocks, the lower number first, shape (n, 2).
        face: the block of the face, of two edges the first, shape (n,).
        place: halfway between the two surfaces [m], shape (n, d).
        normal: unit vector out of the face, shape (n, d).
        gap: between the surfaces, negative for an overlap [m], shape (n,).
        share: of what the pair has, shape (n,).
    """

    pair: Integers
    face: Integers
    place: Array
    normal: Array
    gap: Array
    share: Array

    def taken(self, which: Flags | Integers) -> Found:
        """Some of the places."""
        return Found(*(part[which] for part in self))


class Finder:
    """Convex blocks as bodies of a MuJoCo model that is never stepped.

    Args:
        blocks: the blocks.
        drawn: where their centroids are drawn [m], shape (blocks, d).
    """

    def __init__(self, blocks: Sequence[Polygon | Polyhedron], drawn: Array) -> None:
        self.flat = drawn.shape[1] == 2
        self._half = float(np.median([block.size for block in blocks]))  # of the length of a prism
        solids = [
            Polyhedron.prism(replace(block, length=2 * self._half)) if isinstance(block, Polygon) else block
            for block in blocks
        ]
        self._fixed = np.array([block.fixed for block in blocks])
        self.shapes = Shapes.of(solids, np.insert(drawn, 1, 0.0, axis=1) if self.flat else drawn)
        self._spec, before = mujoco.MjSpec(), np.cumsum([len(solid.corners) for solid in solids])
        self._spec.memory = MEMORY
        for i, corners in enumerate(np.split(self.shapes.corners, before[:-1])):
            self._add(f"{i}", corners)
        self._build()
        self._table = np.empty((64, 10))
        self._room = np.empty((4 * int(np.diff(self.shapes.first).max()) + 4, 3))

    def _add(self, name: str, corners: Array) -> None:
        mesh = self._spec.add_mesh(name=name)
        mesh.uservert = corners.ravel()
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
        body = self._spec.worldbody.add_body(name=name)
        body.add_freejoint()
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name)

    def _build(self) -> None:
        self._model: Any = self._spec.compile()
        self._data: Any = mujoco.MjData(self._model)

    def found(self, poses: Poses, reach: Array, watched: Flags) -> Found:
        """Where pairs of blocks of which one is watched are nearer than the sum of what they reach.

        Args:
            poses: of all blocks.
            reach: of each block [m], shape (blocks,).
            watched: shape (blocks,).
        """
        fixed = self._fixed
        place, matrix = self._in_space(poses)
        kind = np.where(fixed, FIXED, np.where(watched, WATCHED, FREE))
        meets = np.where(watched, FREE | WATCHED | np.where(fixed, 0, FIXED), 0)
        while True:
            model, data = self._model, self._data
            model.geom_margin[:], model.geom_contype[:], model.geom_conaffinity[:] = reach, kind, meets
            data.qpos[:] = np.column_stack([place, poses.turn]).ravel()
            for stage in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_collision):
                stage(model, data)
            if not data.warning[mujoco.mjtWarning.mjWARN_CONTACTFULL].number:
                break
            self._spec.memory = 2 * self._spec.memory
            self._build()
        found = self._places(place, matrix)
        return self._of_the_plane(found) if self.flat else found

    def _in_space(self, poses: Poses) -> tuple[Array, Array]:
        """Centroids and rotations of all blocks, shapes (blocks, 3) and (blocks, 3, 3)."""
        place, matrix = poses.drawn + poses.moved, np.tile(np.eye(3), (len(poses.moved), 1, 1))
        if not self.flat:
            return place, matrix + poses.change
        matrix[:, ::2, ::2] += poses.change
        return np.insert(place, 1, 0.0, axis=1), matrix

    def _places(self, place: Array, matrix: Array) -> Found:
        """The places, as blocks in space."""
        contact, count = self._data.contact, self._data.ncon
        pair = self._model.geom_bodyid[contact.geom].astype(np.int64).reshape(-1, 2) - 1
        sense = np.where(pair[:, 0] > pair[:, 1], -1.0, 1.0)
        pair.sort(axis=1)
        normal, gap = sense[:, None] * contact.frame.reshape(-1, 9)[:, :3], np.array(contact.dist)
        order = np.lexsort((gap, pair[:, 1], pair[:, 0]))  # the nearest place of each pair first
        pairs, first, of = np.unique(pair[order], axis=0, return_index=True, return_inverse=True)
        are_faces = np.empty(len(pairs), dtype=bool)
        pairs = np.ascontiguousarray(pairs)
        while (of_faces := clip(self.shapes, place, matrix, pairs, normal[order][first], self._table, are_faces, self._room)) > len(
            self._table
        ):
            self._table = np.empty((2 * of_faces, 10))
        table = self._table[:of_faces]
        number = table[:, 0].astype(np.int64)
        are_edges = ~are_faces[of.ravel()]
        edges, of_edges = order[are_edges], of.ravel()[are_edges]
        share = 1 / np.maximum(np.bincount(of_edges, minlength=len(pairs))[of_edges], CORNERS)
        return Found(
            np.concatenate([pairs[number], pair[edges]]),
            np.append(table[:, 1].astype(np.int64), pair[edges, 0]),
            np.concatenate([table[:, 2:5], contact.pos.reshape(-1, 3)[edges]]),
            np.concatenate([table[:, 5:8], normal[edges]]),
            np.append(table[:, 8], gap[edges]),
            np.append(table[:, 9], share),
        )

    def _of_the_plane(self, found: Found) -> Found:
        """The places at one end of the prisms, or those between the ends where a pair has none there."""
        number = found.pair[:, 0] * len(self._fixed) + found.pair[:, 1]
        at_the_end = found.place[:, 1] > 0.5 * self._half
        kept = found.taken(at_the_end | ~np.isin(number, number[at_the_end]))
        normal = kept.normal[:, ::2] / np.hypot(*kept.normal[:, ::2].T)[:, None]
        return kept._replace(place=kept.place[:, ::2], normal=normal, share=2 * kept.share)
