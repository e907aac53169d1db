"""The scene of masonry: its free blocks as bodies, its contact lines as points and faces; and its model text."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..problem.lines import Lines
from ..problem.masonry import Masonry
from ..problem.masonry_case import MasonryCase
from ..problem.quantities import Integers, require_kind, require_within
from ..problem.statics import falling
from ..result.masonry import named
from .model import released_mjcf
from .rest import UnsettledError
from .scene import Scene
from .tables import GROUND


def masonry_scene(case: MasonryCase) -> Scene:
    """The scene of a case: the masonry at rest under its weight, then released.

    Bodies have the names of the blocks that are not fixed, in order. The groups of contacts are the joints, by name.

    Raises:
        ValueError: if the masonry does not stand. The message names the blocks that fall.
    """
    require_kind("case", case, MasonryCase)
    scene = standing_masonry(case.masonry)
    require_standing(case.masonry)
    velocity = np.zeros_like(scene.at_rest) if case.velocity is None else np.asarray(case.velocity)
    return scene.released(scene.at_rest, velocity, case.duration, case.motion, case.vertical)


def masonry_mjcf(case: MasonryCase, timestep: float, *, newmark_beta: float = 0.25) -> str:
    """The model of a case as MJCF text; the same arguments give the same bytes.

    Reset to the keyframe `release` and stepped, stock MuJoCo repeats `simulate(case, timestep=timestep)` where the
    ground does not move. Names: bodies and geoms as the blocks that are not fixed; contact points `a|b_0`, `a|b_1`, ...
    of the joint between the blocks a and b; joints `a_x`, `a_z`, `a_theta`; keyframe `release`; camera `front`.

    Args:
        case: the masonry and its release.
        timestep: MuJoCo's step, on which the contact rows depend [s], 1e-9 to 1.
        newmark_beta: Newmark's beta of the contact rows [-], 0 to 10, see `wall_mjcf`.

    Raises:
        ValueError: if the masonry does not stand, or for a value outside its range.
    """
    require_within("timestep", timestep, 1e-9, 1.0, "s")
    require_within("newmark_beta", newmark_beta, 0.0, 10.0)
    return released_mjcf(masonry_scene(case), timestep, newmark_beta)


@lru_cache(maxsize=16)
def require_standing(masonry: Masonry) -> None:
    """Find the masonry at rest under its weight, or raise ValueError with the names of the blocks that fall."""
    falls = falling(masonry)
    if falls:
        raise ValueError(f"the masonry cannot stand: {named(falls)} would fall under the weight")
    try:
        _ = standing_masonry(masonry).at_rest
    except UnsettledError as error:
        moved = np.hypot(*error.pose[:, :2].T)
        gone = [masonry.names[i] for i, far in zip(masonry.free, moved, strict=True) if far >= 0.1 * moved.max()]
        raise ValueError(
            f"the masonry cannot stand: rigid blocks would, but on joints of this stiffness {named(gone)} would fall; "
            "raise k_n"
        ) from None


@lru_cache(maxsize=16)
def standing_masonry(masonry: Masonry) -> Scene:
    """The scene of masonry, which all cases of it share."""
    blocks, number = masonry.blocks, np.full(len(masonry.blocks), GROUND)
    number[list(masonry.free)] = np.arange(len(masonry.free))
    lines = _sorted(masonry.lines, number)
    bodies = [blocks[i] for i in masonry.free]
    origin = np.where(number[:, None] == GROUND, 0.0, masonry.centroids)
    middles = np.array([joint.middle for joint in masonry.joints])
    return Scene(
        names=tuple(masonry.names[i] for i in masonry.free),
        mass=np.array([block.mass for block in bodies]),
        inertia=np.array([block.inertia for block in bodies]),
        rest=masonry.centroids[list(masonry.free)],
        outlines=tuple(block.corners - block.centroid for block in bodies),
        length=max(block.length for block in bodies),
        point_body=number[lines.body],
        point=lines.at - masonry.centroids[lines.body],
        face_body=number[lines.face],
        face=middles[lines.joint] - origin[lines.face],
        normal=lines.normal,
        k=lines.k,
        c=masonry.retardation[lines.joint] * lines.k,
        friction=masonry.joint_friction[lines.joint],
        group=tuple(masonry.joints[j].name for j in lines.joint),
        title=f"Masonry of {len(bodies)} blocks on {len(masonry.joints)} joints",
    )


def _sorted(lines: Lines, number: Integers) -> Lines:
    """Lines in the order in which MuJoCo keeps contacts: by the lower and then the higher of their two bodies."""
    pair = np.sort(number[np.array([lines.body, lines.face])], axis=0)
    order = np.lexsort((pair[1], pair[0]))
    return Lines(*(values[order] for values in lines))  # type: ignore[arg-type]
