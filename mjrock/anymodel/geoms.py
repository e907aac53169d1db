"""Two geoms of anyone's model that can meet: their names, their bodies, and the mass of their approach."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass

import mujoco
import numpy as np

from ..quantities import Array, require_array, require_kind, require_text, shown

GEOM, BODY = mujoco.mjtObj.mjOBJ_GEOM, mujoco.mjtObj.mjOBJ_BODY
FARTHEST = 1e10
"""Distance up to which the nearest points of two geoms are looked for [m]."""
TOUCHING, ASIDE = 1e-3, 1e-2
"""Geoms that are nearer than this share of the distance of their centres touch, and the shortest distance has no
direction. It is then looked for with one of them moved aside by the other share."""
ONE_POINT = (int(mujoco.mjtGeom.mjGEOM_SPHERE), int(mujoco.mjtGeom.mjGEOM_ELLIPSOID))
"""Geoms that meet any other convex geom in a single point."""
UNEVEN = (int(mujoco.mjtGeom.mjGEOM_HFIELD), int(mujoco.mjtGeom.mjGEOM_SDF))
"""Geoms that are not convex."""


def compiled(model: mujoco.MjModel | mujoco.MjSpec) -> mujoco.MjModel:
    """The compiled model of either; an MjSpec stays as it is.

    Raises:
        TypeError: unless it is one of them; for a text or a path with the call that loads it.
        ValueError: with the compiler's message, if the specification does not compile.
    """
    if isinstance(model, str | os.PathLike):
        load = "from_xml_string" if isinstance(model, str) and model.lstrip().startswith("<") else "from_xml_path"
        raise TypeError(f"model = {shown(model)} is not a MjModel or MjSpec; load it with mujoco.MjModel.{load}")
    require_kind("model", model, mujoco.MjModel, mujoco.MjSpec)
    if isinstance(model, mujoco.MjModel):
        return model
    try:
        return model.copy().compile()
    except ValueError as error:
        raise ValueError(f"model does not compile: {error}") from error


def geom_id(model: mujoco.MjModel, argument: str, value: object) -> int:
    """The number of a geom, from its name or number, or from the name of a body that has a single geom.

    Messages call the value `argument`.

    Raises:
        TypeError: unless the value is a text or a whole number.
        ValueError: if there is no such geom, or the body has none or several.
    """
    if isinstance(value, str):
        require_text(argument, value)
        number = mujoco.mj_name2id(model, GEOM, value)
        if number >= 0:
            return int(number)
        body = mujoco.mj_name2id(model, BODY, value)
        if body < 0:
            geoms, bodies = _known(model, GEOM, model.ngeom), _known(model, BODY, model.nbody)
            raise ValueError(
                f"{argument} = {value!r} is no geom or body of this model; its named geoms are: {geoms}; "
                f"its named bodies are: {bodies}"
            )
        if model.body_geomnum[body] != 1:
            raise ValueError(f"{argument} = {value!r} is a body with {model.body_geomnum[body]} geoms; name the geom")
        return int(model.body_geomadr[body])
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise TypeError(f"{argument} = {shown(value)} is neither the name nor the number of a geom")
    if not 0 <= value < model.ngeom:
        raise ValueError(f"{argument} = {value} is outside the valid range 0 to {model.ngeom - 1}")
    return int(value)


def geom_name(model: mujoco.MjModel, geom: int) -> str:
    """The name of a geom, or an empty text."""
    return mujoco.mj_id2name(model, GEOM, geom) or ""


def _known(model: mujoco.MjModel, kind: mujoco.mjtObj, count: int) -> str:
    names = (mujoco.mj_id2name(model, kind, number) for number in range(count))
    return ", ".join(name for name in names if name) or "none"


@dataclass(frozen=True)
class GeomPair:
    """Two geoms of a compiled model.

    Args:
        model: the model, which is only read.
        geoms: the numbers of the geoms.
        chosen: the number of one of the model's explicit pairs of these geoms. None is the first, if there is one.
    """

    model: mujoco.MjModel
    geoms: tuple[int, int]
    chosen: int | None = None

    @classmethod
    def named(cls, model: mujoco.MjModel, geom1: object, geom2: object) -> GeomPair:
        """The pair of two geoms given by name or number, or by the name of a body with a single geom.

        Raises:
            TypeError, ValueError: if one of them is not in the model, or both are one, or neither can move.
        """
        pair = cls(model, (geom_id(model, "geom1", geom1), geom_id(model, "geom2", geom2)))
        if pair.geoms[0] == pair.geoms[1]:
            raise ValueError(f"geom1 and geom2 = {shown(geom1)} are the same geom")
        if not pair.inverse_weight > 0:
            raise ValueError(
                f"geom1 = {geom1!r} and geom2 = {geom2!r} have no inverse weight (body_invweight0 is zero): neither "
                "centre of mass can move, and MuJoCo has no contact stiffness for them"
            )
        return pair

    @property
    def names(self) -> tuple[str, str]:
        """The names; a geom without a name has an empty one."""
        return geom_name(self.model, self.geoms[0]), geom_name(self.model, self.geoms[1])

    @property
    def bodies(self) -> tuple[int, int]:
        """The numbers of the bodies."""
        first, second = (int(self.model.geom_bodyid[geom]) for geom in self.geoms)
        return first, second

    @property
    def explicit(self) -> int:
        """The number of the chosen explicit pair of these geoms, or -1."""
        return self.chosen if self.chosen is not None else next(iter(self.listed), -1)

    @property
    def listed(self) -> tuple[int, ...]:
        """The numbers of all explicit pairs of these geoms. MuJoCo makes a contact of each."""
        ends = zip(self.model.pair_geom1, self.model.pair_geom2, strict=True)
        return tuple(i for i, (a, b) in enumerate(ends) if {int(a), int(b)} == set(self.geoms))

    @property
    def inverse_weight(self) -> float:
        """W, the sum of `body_invweight0` of both bodies, translation [1/kg]."""
        return float(sum(self.model.body_invweight0[body, 0] for body in self.bodies))

    @property
    def makes_several_points(self) -> bool:
        """Whether MuJoCo can make more than one contact of these geoms at a time."""
        kinds = [self.model.geom_type[geom] for geom in self.geoms]
        return any(kind in UNEVEN for kind in kinds) or not any(kind in ONE_POINT for kind in kinds)

    def mass(self, data: mujoco.MjData | None = None, at: object = None) -> float:
        """Effective mass of an approach along the contact's normal, at the model's `qpos0` [kg].

        1/m is the rate at which the geoms part along the normal for a unit impulse. The normal is that of a plane, else
        it points along the shortest distance of the geoms.

        Args:
            data: state of the model at `qpos0`, if there is one; see `at_rest`.
            at: the contact point in the world's frame [m], shape (3,). None takes the centres of mass of what moves
                with each geom, for which 1/m is 1/m1 + 1/m2 of two free bodies.

        Returns:
            The mass; infinity, if the geoms cannot approach each other along the normal.

        Raises:
            TypeError, ValueError: unless `at` is a point.
        """
        data = data if data is not None else at_rest(self.model)
        point = None if at is None else require_array("at", at, (3,))
        if point is not None and np.abs(point).max() > FARTHEST:
            raise ValueError(f"at = {shown(at)} is outside the valid range of {FARTHEST:g} m")
        jacobian = np.zeros((3, self.model.nv))
        for body, sign in zip(self.bodies, (1.0, -1.0), strict=True):
            rows = np.zeros((3, self.model.nv))
            mujoco.mj_jac(self.model, data, rows, None, self._centre(data, body) if point is None else point, body)
            jacobian += sign * rows
        along = self._normal(data) @ jacobian
        if not np.any(np.abs(along) > 1e-9):
            return np.inf
        moved = np.zeros((1, self.model.nv))
        mujoco.mj_solveM(self.model, data, moved, along[None, :])
        return float(1 / (along @ moved[0]))

    def _centre(self, data: mujoco.MjData, body: int) -> Array:
        """Centre of mass of all bodies that are welded together with this one."""
        model = self.model
        group = model.body_weldid == model.body_weldid[body]
        mass = model.body_mass[group]
        return np.array(mass @ data.xipos[group] / max(mass.sum(), mujoco.mjMINVAL))

    def _normal(self, data: mujoco.MjData) -> Array:
        for geom in self.geoms:
            if self.model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE:
                return np.array(data.geom_xmat[geom].reshape(3, 3)[:, 2])
        between = data.geom_xpos[self.geoms[1]] - data.geom_xpos[self.geoms[0]]
        apart = self._shortest(data)
        if np.linalg.norm(apart) < TOUCHING * np.linalg.norm(between):
            place = np.array(data.geom_xpos[self.geoms[1]])
            data.geom_xpos[self.geoms[1]] += ASIDE * between
            apart = self._shortest(data)
            data.geom_xpos[self.geoms[1]] = place
        vector = next(
            direction for direction in (apart, between, np.array((0.0, 0.0, 1.0))) if np.any(np.abs(direction) > 1e-12)
        )
        return np.array(vector / np.linalg.norm(vector))

    def _shortest(self, data: mujoco.MjData) -> Array:
        """Vector between the nearest points of the geoms [m]; zero where MuJoCo knows none."""
        ends = np.zeros(6)
        try:
            mujoco.mj_geomDistance(self.model, data, *self.geoms, FARTHEST, ends)
        except mujoco.FatalError:
            return np.zeros(3)
        return ends[3:] - ends[:3]


def at_rest(model: mujoco.MjModel) -> mujoco.MjData:
    """The state of a model at `qpos0`, with its mass matrix."""
    data = mujoco.MjData(model)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_makeM(model, data)
        mujoco.mj_factorM(model, data)
    return data
