"""Forces of the joints of masonry at rest, and where they act."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....quantities import Array
from ..blocks.joints_in_space import SpaceJoint
from ..masonry import Masonry


@dataclass(frozen=True, eq=False)
class JointForces:
    """Force of each joint on the block above it, in the order of `masonry.joints`.

    Args:
        normal: along the normal, positive where it presses [N], shape (joints,).
        shear: along `Joint.along`, which is x on a bed joint [N], shape (joints,). In space along the two axes of
            `SpaceJoint.axes`, shape (joints, 2).
        eccentricity: from the middle of the joint to where the force passes through it, in the same directions [m], of
            the shape of `shear`, also where a bond pulls; NaN without a normal force.
    """

    normal: Array
    shear: Array
    eccentricity: Array


def axes_of(masonry: Masonry) -> Array:
    """Of each joint the normal and the directions along it, as unit vectors, shape (joints, d, d)."""
    return np.array([[j.normal, *(j.axes if isinstance(j, SpaceJoint) else j.along[None])] for j in masonry.joints])


def joint_forces(masonry: Masonry, forces: Array) -> JointForces:
    """The forces of joints from those of their contact lines on the block `Lines.body` [N], shape (m, d)."""
    lines, joints = masonry.lines, masonry.joints
    above = np.array([joint.above for joint in joints])[lines.joint]
    forces = np.where(above == lines.body, 1.0, -1.0)[:, None] * forces
    axes = axes_of(masonry)
    parts = np.einsum("mad,md->ma", axes[lines.joint], forces)
    arms = np.einsum(
        "mad,md->ma", axes[lines.joint], lines.at - np.array([joint.middle for joint in joints])[lines.joint]
    )
    total, moments = np.zeros((len(joints), axes.shape[1])), np.zeros((len(joints), axes.shape[1]))
    np.add.at(total, lines.joint, parts)
    np.add.at(moments, lines.joint, parts[:, :1] * arms)
    normal = total[:, 0]
    shear, eccentricity = total[:, 1:], moments[:, 1:] / np.where(normal != 0, normal, np.nan)[:, None]
    if axes.shape[1] == 2:
        shear, eccentricity = shear[:, 0], eccentricity[:, 0]
    return JointForces(normal.copy(), shear.copy(), eccentricity.copy())
