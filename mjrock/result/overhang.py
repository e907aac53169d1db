"""Where the weight of a block has passed the edge of what it stands on, which MuJoCo does not feel."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import scipy

from ..problem.masonry.masonry import Masonry
from ..problem.masonry.standing import MasonryStanding
from ..quantities import Array, Integers, named
from .joint_motion import JointRecord

LOOKS = 200
"""Most times at which a run is looked at."""
WORTH_SAYING = 1e-3
"""Distance past an edge that is said, over the size of the block [-]."""
UPRIGHT = 1e-9
"""Vertical part of the normal of a joint up to which it carries no weight [-]."""


def past_support(
    standing: MasonryStanding, motion: JointRecord, slips: Callable[[Integers], Array]
) -> dict[str, float]:
    """How far the weight of each block has passed the edge of the faces that it stands on [m], at most, by its name.

    Blocks that stand on horizontal joints alone are looked at. What overhangs as it is drawn counts from there.

    Args:
        standing: the masonry at rest.
        motion: what the joints did.
        slips: from the numbers of some steps, how far the block above each joint has slid on the one below [m], shape
            (steps, joints, d).
    """
    masonry, centroids, found = standing.masonry, standing.centroids, {}
    faces = [below.corners[:, :-1] for below, _ in standing.faces]
    looks = np.unique(np.linspace(0, len(motion.off) - 1, LOOKS).astype(int))
    for block, beds in _beds(masonry).items():
        weight = centroids[block, :-1]
        drawn = _beyond(weight, np.concatenate([faces[j] for j in beds]))
        least = max(drawn, 0.0) + WORTH_SAYING * masonry.blocks[block].size
        if drawn + motion.sliding[beds].max() < least:
            continue
        slid = slips(looks)[:, beds, :-1]
        far = least
        for some, off in zip(slid, motion.off[looks][:, beds], strict=True):
            on = [faces[j] - slip for j, slip, gone in zip(beds, some, off, strict=True) if not gone]
            far = max(far, _beyond(weight, np.concatenate(on))) if on else far
        if far > least:
            found[masonry.names[block]] = far - max(drawn, 0.0)
    return found


def told_of_overhang(past: Mapping[str, float]) -> str:
    """Whose weight has passed its support, and how far, as a sentence after a message; nothing where none has."""
    far = [f"{name} by {past[name]:.3g} m" for name in sorted(past, key=past.__getitem__, reverse=True)]
    return (
        f" The weight passed the edge of what it stands on: {named(far)}. Faces have no end in MuJoCo, where such a "
        "block does not tip; solve_explicit follows it."
        if far
        else ""
    )


def _beds(masonry: Masonry) -> dict[int, list[int]]:
    """Numbers of the horizontal joints that each block stands on, of blocks that no inclined one carries too."""
    beds: dict[int, list[int]] = {}
    inclined = set()
    for j, joint in enumerate(masonry.joints):
        up = float(joint.normal[-1])
        if joint.is_bed and up > 0:
            beds.setdefault(joint.above, []).append(j)
        elif not joint.is_bed and abs(up) > UPRIGHT:
            inclined |= {joint.below, joint.above}
    return {block: on for block, on in beds.items() if block not in inclined}


def _beyond(point: Array, corners: Array) -> float:
    """How far a point lies outside of the hull of some corners in plan [m], negative inside."""
    if len(point) == 1:
        return float(max(corners.min() - point[0], point[0] - corners.max()))
    sides = scipy.spatial.ConvexHull(corners).equations
    return float((sides[:, :2] @ point + sides[:, 2]).max())
