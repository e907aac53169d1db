"""What stands in a case of masonry at rest: solids with their faces, and joints with their axes."""

from __future__ import annotations

import numpy as np

from ...geometry.hull import Faces, prism
from ...quantities import Array
from ..wall.standing import JointFrames, Solid, in_space
from .blocks.compound import AnyBlock
from .blocks.polygon import Polygon
from .limit.joint_forces import axes_of
from .lines import free_numbers
from .masonry import Masonry


def solids_of(masonry: Masonry, centroids: Array) -> list[Solid]:
    """The blocks in their order; those of the plane are prisms of their length.

    Args:
        masonry: the masonry.
        centroids: of all blocks with the masses that are added to them [m], shape (blocks, d).
    """
    solids, parts = [], zip(masonry.names, masonry.blocks, in_space(centroids), strict=True)
    for i, (name, block, rest) in enumerate(parts):
        corners, faces = faces_of(block)
        solids.append(Solid(name, i, corners - rest, faces, rest, block.fixed))
    return solids


def faces_of(block: AnyBlock) -> tuple[Array, Faces]:
    """Corners of a block in space [m], shape (corners, 3), and its faces: those of each of its convex parts."""
    corners, faces = list[Array](), list[tuple[int, ...]]()
    for part in block.parts:
        before = sum(map(len, corners))
        own, rings = prism(part.corners, part.length) if isinstance(part, Polygon) else (part.corners, part.faces)
        corners.append(own)
        faces += [tuple(before + i for i in ring) for ring in rings]
    return np.concatenate(corners), tuple(faces)


def joints_of(masonry: Masonry, centroids: Array) -> JointFrames:
    """The joints; arguments are those of `solids_of`."""
    number, fixed = free_numbers(masonry.blocks), np.array([block.fixed for block in masonry.blocks])
    below, above = np.array([(joint.below, joint.above) for joint in masonry.joints]).T
    of_fixed = np.where(fixed, np.cumsum(fixed) - 1, -1)
    return JointFrames(
        tuple(joint.name for joint in masonry.joints),
        np.array([joint.middle for joint in masonry.joints]),
        axes_of(masonry),
        number[below],
        number[above],
        of_fixed[below],
        tuple(name for name, held in zip(masonry.names, fixed, strict=True) if held),
        centroids[list(masonry.free)],
    )
