"""Pictures of limit analysis: how masonry fails, and the forces of its joints as it begins to move."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from ..problem.masonry.blocks.joints import Joint
from ..problem.masonry.limit.collapse import Collapse
from ..quantities import require_flag, require_kind, require_within
from .arguments import picture
from .masonry import blocks
from .section import FORCE

THICK = 3.0
"""Width of the line of the largest force [points]."""


@picture()
def mechanism(ax: Axes, collapse: Collapse, *, share: float = 0.1, forces: bool = True) -> Axes:
    """Masonry that has moved a little in its mechanism of collapse, and where joints press as it begins to move.

    Each force is a line through the point of its joint where it acts, along the force and as long as half the joint.
    Its width grows with the force. Lines that follow one another are the path of the thrust. They are drawn at rest, in
    the plane alone.

    Args:
        ax: where to draw; of three dimensions for blocks in space.
        collapse: what `collapse_multiplier` has returned, of a finite multiplier.
        share: largest displacement of a centroid that is drawn, over the extent of the masonry, 0 to 1.
        forces: whether to draw the forces.

    Raises:
        ValueError: for a multiplier that is infinite, or a share out of its range.
    """
    require_kind("collapse", collapse, Collapse)
    share, forces = require_within("share", share, 0.0, 1.0), require_flag("forces", forces)
    masonry = collapse.masonry
    if masonry is None or collapse.forces is None:
        raise ValueError(f"multiplier = {collapse.multiplier:g}: nothing gives way, and there is no mechanism to draw")
    parts = 3 if masonry.in_space else 2
    extent = np.ptp(np.concatenate([masonry.blocks[i].corners for i in masonry.free]), axis=0).max()
    largest = np.linalg.norm(collapse.motion[:, :parts], axis=1).max()
    pose = share * extent / largest * collapse.motion
    if masonry.in_space:
        half = 0.5 * pose[:, 3:]
        pose = np.column_stack([pose[:, :3], np.ones(len(pose)), half])
        pose[:, 3:] /= np.linalg.norm(pose[:, 3:], axis=1)[:, None]
    blocks(ax, masonry, pose)
    if forces and not masonry.in_space:
        _pressed(ax, masonry.plane_joints, collapse)
    return ax


def _pressed(ax: Axes, joints: tuple[Joint, ...], collapse: Collapse) -> None:
    """A line for each force of a joint."""
    assert collapse.forces is not None
    normal, shear, along = collapse.forces.normal, collapse.forces.shear, collapse.forces.eccentricity
    size = np.hypot(normal, shear)
    ax.set_xlabel(f"{ax.get_xlabel()}\nline {THICK:g} pt wide: {size.max() / 1e3:.3g} kN")
    for i, joint in enumerate(joints):
        if normal[i] > 1e-3 * size.max():
            way = (normal[i] * joint.normal + shear[i] * joint.along) / size[i]
            ends = joint.middle + along[i] * joint.along + 0.25 * joint.width * np.outer([-1, 1], way)
            ax.plot(*ends.T, color=FORCE, linewidth=max(0.4, THICK * size[i] / size.max()), solid_capstyle="round")
