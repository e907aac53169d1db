"""What stands in a case of masonry at rest: solids with their faces, and joints with their axes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...geometry.hull import Side
from ...quantities import Array
from ..wall.rest_geometry import Face, JointFrames, Solid, in_space
from .blocks.joints import Joint
from .blocks.joints_in_space import SpaceJoint
from .lines import free_numbers
from .masonry import Masonry


@dataclass(frozen=True, eq=False)
class MasonryRestGeometry:
    """Masonry, and the centroids of all blocks with the masses that are added to them [m], shape (blocks, d)."""

    masonry: Masonry
    centroids: Array

    @cached_property
    def solids(self) -> tuple[Solid, ...]:
        """The blocks in their order; those of the plane are prisms of their length."""
        blocks, body = self.masonry.blocks, free_numbers(self.masonry.blocks).tolist()
        return tuple(
            Solid(name, i, body[i], centroid, block.solids, block.inside, block.sides, block.size)
            for i, (name, block, centroid) in enumerate(
                zip(self.masonry.names, blocks, in_space(self.centroids), strict=True)
            )
        )

    @property
    def joints(self) -> tuple[Joint | SpaceJoint, ...]:
        """The joints of the masonry."""
        return self.masonry.joints

    @property
    def frames(self) -> JointFrames:
        """Where they are."""
        masonry = self.masonry
        number, fixed = free_numbers(masonry.blocks), np.array([block.fixed for block in masonry.blocks])
        below, above = np.array([(joint.below, joint.above) for joint in masonry.joints]).T
        of_fixed = np.where(fixed, np.cumsum(fixed) - 1, -1)
        return JointFrames(
            tuple(joint.name for joint in masonry.joints),
            np.array([joint.middle for joint in masonry.joints]),
            np.array([joint.frame for joint in masonry.joints]),
            number[below],
            number[above],
            of_fixed[below],
            tuple(name for name, held in zip(masonry.names, fixed, strict=True) if held),
            self.centroids[list(masonry.free)],
        )

    @cached_property
    def faces(self) -> tuple[tuple[Face, Face], ...]:
        """The whole faces that make each joint, of the blocks below and above."""
        sides = [block.sides for block in self.masonry.blocks]
        below = [sides[joint.below][joint.sides[0]] for joint in self.masonry.joints]
        above = [sides[joint.above][joint.sides[1]] for joint in self.masonry.joints]
        if self.masonry.in_space:
            return tuple(zip(Face.in_space(below), Face.in_space(above), strict=True))
        edges = zip(self.masonry.plane_joints, below, above, strict=True)
        return tuple((_edge(lower, joint, 1.0), _edge(upper, joint, -1.0)) for joint, lower, upper in edges)


def _edge(side: Side, joint: Joint, sense: float) -> Face:
    """An edge that makes a joint, along the line of the joint, see `Face.in_plane`."""
    low, high = sorted(((side.corners - joint.middle) @ joint.along).tolist())
    return Face.in_plane(joint.middle, joint.along, (low, high), sense)


def travels(faces: tuple[Face, Face], directions: Array) -> Array:
    """How far the face above can slide along unit vectors until it has left the face below [m], shape (n,).

    The two faces then touch at most along a line perpendicular to that direction.
    """
    below, above = faces
    return np.asarray((below.corners @ directions.T).max(axis=0) - (above.corners @ directions.T).min(axis=0))
