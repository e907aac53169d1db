"""Angles of rotations, from poses of bodies in space."""

from __future__ import annotations

import numpy as np

from ..quantities import Array


def tilt_of(pose: Array) -> Array:
    """Angle between the axis of each body that was vertical at rest and the vertical [rad], from 0 to pi.

    Args:
        pose: displacement and unit quaternion, w first, shape (..., 7).
    """
    w, x, y, z = np.moveaxis(pose[..., 3:], -1, 0)
    angle: Array = 2 * np.arctan2(np.hypot(x, y), np.hypot(w, z))
    return angle


def angle_of(pose: Array) -> Array:
    """Angle of rotation from rest, about whatever axis [rad], from 0 to pi, of poses as in `tilt_of`."""
    angle: Array = 2 * np.arctan2(np.linalg.norm(pose[..., 4:], axis=-1), np.abs(pose[..., 3]))
    return angle
