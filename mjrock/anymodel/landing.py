"""Where two geoms meet: moved along their normal until they touch, in the pose that they have.

MuJoCo's own collision functions make the points. A box that lies level on a plane meets it in four, a cylinder in
three, a capsule that lies in two.
"""

from __future__ import annotations

import copy
from typing import NamedTuple

import mujoco
import numpy as np

from ..quantities import Array
from .geoms import GeomPair

DEPTH = 1e-3
"""How far the geoms are pressed into each other, as a share of the smaller one's radius [-]: a face that is level to
one in a thousand meets in all of its points."""
DIRECTIONLESS = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))
"""Geoms that stay where they are."""


class Ground:
    """A copy of a model in a pose, see `state_of`, in which geoms are tried against each other."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.model = copy.copy(model)
        option, disabled = self.model.opt, mujoco.mjtDisableBit
        option.disableflags |= int(disabled.mjDSBL_MIDPHASE | disabled.mjDSBL_FILTERPARENT)
        option.disableflags &= ~int(disabled.mjDSBL_CONTACT | disabled.mjDSBL_CONSTRAINT)
        option.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        self.data = mujoco.MjData(self.model)
        for name in ("qpos", "mocap_pos", "mocap_quat"):
            getattr(self.data, name)[:] = getattr(data, name)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        for name in ("geom_contype", "geom_conaffinity", "body_contype", "body_conaffinity"):
            getattr(self.model, name)[:] = 0

    def points(self, pair: GeomPair, away: Array, distance: float) -> Array:
        """The points in which the geoms meet, with the first moved by `distance` against `away`, shape (n, 3)."""
        bodies, geoms = list(pair.bodies), list(pair.geoms)
        self._let_meet(geoms, bodies, 1)
        moves = 1 if self.model.geom_type[geoms[0]] in DIRECTIONLESS else 0
        place = np.array(self.data.geom_xpos[geoms[moves]])
        radii = self.model.geom_rbound[geoms]
        depth = DEPTH * float(min((radius for radius in radii if radius > 0), default=1.0))
        shift = (distance + depth) * away
        self.data.geom_xpos[geoms[moves]] += shift if moves else -shift
        try:
            mujoco.mj_collision(self.model, self.data)
            contact = self.data.contact
            met = contact.pos[(np.sort(contact.geom, axis=1) == sorted(geoms)).all(axis=1)]
        finally:
            self.data.geom_xpos[geoms[moves]] = place
            self._let_meet(geoms, bodies, 0)
        points = met[:: max(1, len(pair.listed))]
        return points + shift if moves == 0 else points

    def _let_meet(self, geoms: list[int], bodies: list[int], value: int) -> None:
        self.model.geom_contype[geoms] = self.model.geom_conaffinity[geoms] = value
        self.model.body_contype[bodies] = self.model.body_conaffinity[bodies] = value


class Landing(NamedTuple):
    """Where two geoms meet.

    Args:
        away: unit vector along which the first geom parts from the second, shape (3,).
        distance: their distance [m].
        first, second: the points of the contact on each of them where it is now, in the world's frame [m], shape
            (n, 3). They are the same points once the geoms have met.
    """

    away: Array
    distance: float
    first: Array
    second: Array


def landing(pair: GeomPair, data: mujoco.MjData, ground: Ground | None) -> Landing:
    """Where two geoms meet.

    Args:
        pair: the geoms.
        data: the pose, see `state_of`.
        ground: a copy of the model in this pose; None for geoms that meet in a single point.
    """
    away, distance, ends = pair.apart(data)
    if ground is not None:
        points = ground.points(pair, away, distance)
        if len(points):
            return Landing(away, distance, points, points - distance * away)
    first, second = [pair.centre(data, body) for body in pair.bodies] if ends is None else ends
    return Landing(away, distance, first[None, :], second[None, :])
