"""Rest: the poses in which the springs of the contacts carry the weight."""

from __future__ import annotations

import numpy as np

from ..problem.quantities import GRAVITY, Array
from .kinematics import Points, frame_of, gap, gaps

ITERATIONS = 200
"""Most iterations of Newton's method."""


def gap_rates(points: Points, pose: Array) -> Array:
    """Rates of the gaps for unit velocities at a pose of shape (3 n,), shape (m, 3 n)."""
    frame, columns, none = frame_of(pose), np.eye(len(pose)), np.zeros_like(pose)
    return np.array([[gap(points, i, frame, v, none)[1] for v in columns] for i in range(len(points.k))])


def settled(points: Points, masses: Array) -> Array:
    """The pose in which the springs of the contacts carry the weight without friction, shape (n, 3).

    Newton's method on the potential energy. Where nothing holds a direction, the bodies stay where they are.

    Raises:
        ValueError: if no such pose is found near the undeformed one.
    """
    weight = np.zeros_like(masses)
    weight[1::3] = -GRAVITY * masses[1::3]
    pose = np.zeros_like(masses)
    closed = np.ones(len(points.k), dtype=bool)
    for _ in range(ITERATIONS):
        rates, depth = gap_rates(points, pose), -gaps(points, pose[None])[0]
        residual = weight + rates.T @ np.where(closed, points.k * depth, 0.0)
        if np.abs(residual).max() < 1e-9 * np.abs(weight).max() and (closed == (depth > 0)).all():
            return pose.reshape(-1, 3)
        stiffness = (rates.T * np.where(closed, points.k, 0.0)) @ rates
        pose = pose + np.linalg.lstsq(stiffness, residual, rcond=1e-12)[0]
        closed = gaps(points, pose[None])[0] < 0
    raise ValueError("the bodies do not stand on their contacts without friction")


def lowered(points: Points, masses: Array, pose: Array) -> Array:
    """A pose lowered until the springs of level ground carry the weight of all bodies, shape (n, 3).

    The bodies keep their rotations and their horizontal positions.
    """
    level = (points.face_body < 0) & (points.normal[:, 1] > 1 - 1e-12)
    depth, k = -gaps(points, np.array(pose, dtype=float).reshape(1, -1))[0][level], points.k[level]
    order = np.argsort(-depth, kind="stable")  # the deepest points are loaded first
    depth, k = depth[order], k[order]
    # sum k_i max(0, depth_i - z) = m g for the points down to the i-th
    levels = (np.cumsum(k * depth) - GRAVITY * masses[1::3].sum()) / np.cumsum(k)
    z = levels[np.flatnonzero(levels >= np.append(depth[1:], -np.inf))[0]]
    return pose + np.array([0.0, z, 0.0])
