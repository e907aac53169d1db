"""The planar pose of a wall on compliant contacts: gaps, energy, and the pose of release.

A pose is (x, z, theta): displacement of the centroid from the upright wall on an undeformed base [m], x away from the
side stop and z upwards, and the rotation [rad], positive towards +x. A velocity is its time derivative. Arrays of
poses have shape (..., 3).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .block import Block
from .case import Case
from .interface import Contacts

Array = NDArray[np.float64]


def base_gaps(wall: Block, contacts: Contacts, pose: Array) -> Array:
    """Height of each contact point of the base above the base, negative in penetration [m], shape (..., points)."""
    z, theta = pose[..., 1, None], pose[..., 2, None]
    gaps: Array = z + wall.h - contacts.base.positions * np.sin(theta) - wall.h * np.cos(theta)
    return gaps


def side_gaps(wall: Block, contacts: Contacts, pose: Array) -> Array:
    """Distance of each contact point of the inner face from the side stop [m], shape (..., points)."""
    assert contacts.side is not None
    x, theta = pose[..., 0, None], pose[..., 2, None]
    gaps: Array = x + wall.b - wall.b * np.cos(theta) + contacts.side.positions * np.sin(theta)
    return gaps


def mechanical_energy(case: Case, contacts: Contacts, pose: Array, velocity: Array) -> Array:
    """Kinetic, potential and elastic energy above the wall at rest on its settled base [J], shape (...,)."""
    wall = case.block
    kinetic = wall.mass * (velocity[..., 0] ** 2 + velocity[..., 1] ** 2) + wall.inertia * velocity[..., 2] ** 2
    springs = contacts.base.stiffness * np.minimum(base_gaps(wall, contacts, pose), 0) ** 2
    doubled: Array = kinetic + springs.sum(axis=-1)
    if case.side_stop:
        assert contacts.side is not None
        springs = contacts.side.stiffness * np.minimum(side_gaps(wall, contacts, pose), 0) ** 2
        doubled = doubled + springs.sum(axis=-1)
    at_rest = -(wall.weight**2) / (2 * contacts.base.stiffness.sum())
    energy: Array = doubled / 2 + wall.weight * pose[..., 1] - at_rest
    return energy


def release_pose(case: Case, contacts: Contacts) -> tuple[Array, Array]:
    """Pose and velocity at release: tilted about the toe, the base sunk until its springs carry the weight.

    A wall set down unloaded would drop by m g / k, bounce, and lose in its base what an impact is to be measured by
    (1 % of the release energy on the paper's wall).
    """
    wall, theta = case.block, case.theta0
    toe = case.direction * wall.b
    sine, cosine = math.sin(theta), math.cos(theta)
    # sum k_i max(0, depth_i - z) = m g, with the deepest points loaded first
    depth = contacts.base.positions * sine + wall.h * (cosine - 1)
    order = np.argsort(-depth, kind="stable")
    depth, stiffness = depth[order], contacts.base.stiffness[order]
    levels = (np.cumsum(stiffness * depth) - wall.weight) / np.cumsum(stiffness)
    z = float(levels[np.flatnonzero(levels >= np.append(depth[1:], -np.inf))[0]])
    x = toe - toe * cosine + wall.h * sine
    arm = np.array([wall.h * cosine + toe * sine, -(wall.h * sine - toe * cosine)])
    return np.array([x, z, theta]), case.omega0 * np.append(arm, 1.0)
