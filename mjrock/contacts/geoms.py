"""Geoms of any model that can meet: their names, their bodies, and the direction in which they part.

Geoms that collide without an explicit pair are found by the rules of MuJoCo's manual (Computation, Selection)."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import mujoco
import numpy as np

from .checks import Array, Flags, require_kind, require_text, shown
from .files import require_file

GEOM, BODY = mujoco.mjtObj.mjOBJ_GEOM, mujoco.mjtObj.mjOBJ_BODY
FARTHEST_GEOM = 1e10
"""Distance up to which the nearest points of two geoms are looked for [m]."""
TOUCHING_SHARE, BESIDE_THE_LINE = 1e-3, 1e-2
"""Geoms that are nearer than this share of the distance of their centres touch, and the shortest distance has no
direction. It is then looked for with one of them moved aside by the other share."""
FACING = 0.999
"""Cosine from which a direction is the normal of a face [-]; 2.6 degrees."""
NO_LOAD = 1e-9
"""Load of a contact that carries nothing [N]."""
ONE_POINT = (int(mujoco.mjtGeom.mjGEOM_SPHERE), int(mujoco.mjtGeom.mjGEOM_ELLIPSOID))
"""Geoms that meet any other convex geom in a single point."""
FACED = (int(mujoco.mjtGeom.mjGEOM_BOX), int(mujoco.mjtGeom.mjGEOM_MESH))
"""Geoms with faces and corners."""
BOUNDLESS = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))
"""Geoms that fill all that is below them, and stay where they are."""
NOT_CONVEX = (int(mujoco.mjtGeom.mjGEOM_HFIELD), int(mujoco.mjtGeom.mjGEOM_SDF))
"""Geoms that are not convex."""


def load(path: Path) -> mujoco.MjModel:
    """The model of a file.

    Raises:
        ValueError, OSError: if it is not there, or no model.
    """
    read = mujoco.MjModel.from_binary_path if path.suffix == ".mjb" else mujoco.MjModel.from_xml_path
    return read(str(require_file(path)))


def keyframe_argument(text: str | None) -> str | int | None:
    """A keyframe of a command line: a number where the text is one, otherwise a name."""
    return int(text) if text is not None and text.isdecimal() else text


def compiled_model(model: mujoco.MjModel | mujoco.MjSpec) -> mujoco.MjModel:
    """The compiled model of either. An MjSpec itself is compiled, and stays as it is: MuJoCo 4.0 ends the process
    where a copy does not compile for a keyframe of a nested attachment.

    Raises:
        TypeError: for any other.
        ValueError: with the compiler's message for a specification that does not compile.
    """
    if isinstance(model, str | os.PathLike):
        load = "from_xml_string" if isinstance(model, str) and model.lstrip().startswith("<") else "from_xml_path"
        raise TypeError(f"model = {shown(model)} is not a MjModel or MjSpec; load it with mujoco.MjModel.{load}")
    require_kind("model", model, mujoco.MjModel, mujoco.MjSpec)
    if isinstance(model, mujoco.MjModel):
        return model
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # MuJoCo repeats its warnings of when the parts were attached
            return model.compile()
    except ValueError as error:
        raise ValueError(f"model does not compile: {error}") from error


def geom_id(model: mujoco.MjModel, argument: str, value: object) -> int:
    """The number of a geom, from its name or number, or from the name of a body that has a single geom.

    Messages call the value `argument`.

    Raises:
        TypeError: unless it is a text or a whole number.
        ValueError: if there is no such geom, or the body has none or several.
    """
    if isinstance(value, str):
        require_text(argument, value)
        number = mujoco.mj_name2id(model, GEOM, value)
        if number >= 0:
            return int(number)
        body = mujoco.mj_name2id(model, BODY, value)
        if body < 0 and mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_FLEX, value) >= 0:
            raise ValueError(
                f"{argument} = {value!r} is a flex, which no explicit pair covers; its contacts take solref and solimp "
                "from the flex and the other geom"
            )
        if body < 0:
            geoms, bodies = (", ".join(filter(None, names_of_objects(model, kind))) or "none" for kind in (GEOM, BODY))
            raise ValueError(
                f"{argument} = {value!r} is not a geom or body of this model; its named geoms are: {geoms}; "
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


def names_of_objects(model: mujoco.MjModel, kind: mujoco.mjtObj) -> list[str]:
    """The names of all geoms or bodies; one without a name has an empty one."""
    count = model.ngeom if kind == GEOM else model.nbody
    return [mujoco.mj_id2name(model, kind, number) or "" for number in range(count)]


def geom_label(model: mujoco.MjModel, geom: int) -> str:
    """The name of a geom; one without a name has that of its body, with its own number in brackets."""
    body = mujoco.mj_id2name(model, BODY, model.geom_bodyid[geom]) or ""
    return mujoco.mj_id2name(model, GEOM, geom) or f"{body}[{geom}]"


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
        """The pair of two geoms that `geom_id` finds.

        Raises:
            ValueError: if both are one, or neither can move.
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
        first, second = (mujoco.mj_id2name(self.model, GEOM, geom) or "" for geom in self.geoms)
        return first, second

    @property
    def labels(self) -> tuple[str, str]:
        """The labels of both, see `geom_label`."""
        first, second = (geom_label(self.model, geom) for geom in self.geoms)
        return first, second

    @property
    def body_names(self) -> tuple[str, str]:
        """The names of the bodies, or their numbers in brackets."""
        first, second = (mujoco.mj_id2name(self.model, BODY, body) or f"[{body}]" for body in self.bodies)
        return first, second

    @cached_property
    def bodies(self) -> tuple[int, int]:
        """The numbers of the bodies."""
        first, second = (int(self.model.geom_bodyid[geom]) for geom in self.geoms)
        return first, second

    @property
    def explicit(self) -> int:
        """The number of the chosen explicit pair of these geoms, or -1."""
        return self.chosen if self.chosen is not None else next(iter(self.listed), -1)

    @cached_property
    def listed(self) -> tuple[int, ...]:
        """The numbers of all explicit pairs of these geoms. MuJoCo makes a contact of each."""
        first, second = self.model.pair_geom1, self.model.pair_geom2
        a, b = self.geoms
        return tuple(np.flatnonzero((first == a) & (second == b) | (first == b) & (second == a)).tolist())

    @property
    def inverse_weight(self) -> float:
        """W, the sum of `body_invweight0` of both bodies, translation [1/kg]."""
        return float(sum(self.model.body_invweight0[body, 0] for body in self.bodies))

    @cached_property
    def trees(self) -> list[Flags]:
        """The bodies of each tree of joints that moves with one of the two; none of what is fixed or mocap."""
        tree = np.array(self.model.body_treeid)
        return [tree == number for number in dict.fromkeys(tree[list(self.bodies)].tolist()) if number >= 0]

    @property
    def moving(self) -> float:
        """Mass of all trees that move with one of the two [kg]."""
        return float(sum(self.model.body_mass[bodies].sum() for bodies in self.trees))

    @property
    def load(self) -> float:
        """Weight of the lighter tree [N], without what `gravcomp` or the flag of gravity take; next to nothing where
        there is none. It is the static load where the geoms are apart, see `Pose.load`."""
        option = self.model.opt
        pull = 0.0 if option.disableflags & int(mujoco.mjtDisableBit.mjDSBL_GRAVITY) else np.linalg.norm(option.gravity)
        mass = self.model.body_mass * (1 - self.model.body_gravcomp)
        return max(NO_LOAD, min((abs(float(mass[bodies].sum())) for bodies in self.trees), default=0.0) * float(pull))

    @property
    def thickness(self) -> float:
        """The smallest half extent of the two geoms along their axes [m]."""
        return float(self.model.geom_aabb[list(self.geoms), 3:].min())

    @property
    def makes_several_points(self) -> bool:
        """Whether MuJoCo can make more than one contact of these geoms at a time."""
        return self.is_uneven or not any(self.model.geom_type[geom] in ONE_POINT for geom in self.geoms)

    @property
    def has_one_side(self) -> bool:
        """Whether one of the geoms is a plane or a height field, which nothing comes out of on another side."""
        return any(self.model.geom_type[geom] in BOUNDLESS for geom in self.geoms)

    @property
    def has_two_faces(self) -> bool:
        """Whether both geoms have faces and corners, so that MuJoCo clips one face with the other."""
        return all(self.model.geom_type[geom] in FACED for geom in self.geoms)

    @property
    def is_uneven(self) -> bool:
        """Whether one of the geoms is not convex, so that the number of points changes from place to place."""
        return any(self.model.geom_type[geom] in NOT_CONVEX for geom in self.geoms)

    def can_turn(self, data: mujoco.MjData, axis: Array) -> bool:
        """Whether the joints let one of the bodies turn against the other about an axis, shape (3,)."""
        turns = np.zeros((2, 3, self.model.nv))
        for jacobian, body in zip(turns, self.bodies, strict=True):
            mujoco.mj_jacBody(self.model, data, None, jacobian, body)
        return bool(np.abs(axis @ (turns[0] - turns[1])).max(initial=0) > 1e-9)

    def centre(self, data: mujoco.MjData, body: int) -> Array:
        """Centre of mass of all bodies that are welded together with this one [m]."""
        model = self.model
        group = model.body_weldid == model.body_weldid[body]
        mass = model.body_mass[group]
        return np.array(mass @ data.xipos[group] / max(mass.sum(), mujoco.mjMINVAL))

    def separation(self, data: mujoco.MjData) -> tuple[Array, float, Array | None]:
        """The unit vector along which the first geom parts from the second, their distance [m], and the nearest points
        of both [m], shape (2, 3), or None where MuJoCo finds none.

        The vector is the normal of a plane, otherwise it points along the shortest distance of the geoms.
        """
        between = data.geom_xpos[self.geoms[0]] - data.geom_xpos[self.geoms[1]]
        distance, ends = self._shortest(data)
        if (axis := self.axis(data, mujoco.mjtGeom.mjGEOM_PLANE)) is not None:
            return axis, distance, ends
        separation = np.zeros(3) if ends is None else np.copysign(1.0, distance) * (ends[0] - ends[1])
        if np.linalg.norm(separation) < TOUCHING_SHARE * np.linalg.norm(between):
            place = np.array(data.geom_xpos[self.geoms[0]])
            data.geom_xpos[self.geoms[0]] += BESIDE_THE_LINE * between
            aside, moved = self._shortest(data)
            data.geom_xpos[self.geoms[0]] = place
            separation = np.zeros(3) if moved is None else np.copysign(1.0, aside) * (moved[0] - moved[1])
        up = np.array((0.0, 0.0, 1.0))
        vector = next(vector for vector in (separation, between, up) if np.any(np.abs(vector) > 1e-12))
        return np.array(vector / np.linalg.norm(vector)), distance, ends

    def axis(self, data: mujoco.MjData, kind: mujoco.mjtGeom) -> Array | None:
        """The unit vector along which the first geom parts from the second, where one of them is a plane or a height
        field, as `kind` says: its axis. None for other geoms."""
        for geom, sign in zip(self.geoms, (-1.0, 1.0), strict=True):
            if self.model.geom_type[geom] == kind:
                return sign * np.array(data.geom_xmat[geom].reshape(3, 3)[:, 2])
        return None

    def meets_edges(self, data: mujoco.MjData, away: Array) -> bool:
        """Whether a line meets edges or corners of all boxes, cylinders and meshes among the two geoms."""
        model, cosines = self.model, []
        for geom in self.geoms:
            geom_type, along = model.geom_type[geom], np.abs(data.geom_xmat[geom].reshape(3, 3).T @ away)
            if geom_type == mujoco.mjtGeom.mjGEOM_PLANE or geom_type in NOT_CONVEX:
                return False
            if geom_type == mujoco.mjtGeom.mjGEOM_BOX:
                cosines.append(along.max())
            elif geom_type == mujoco.mjtGeom.mjGEOM_CYLINDER:
                cosines.append(max(along[2], float(np.hypot(*along[:2]))))
            elif geom_type == mujoco.mjtGeom.mjGEOM_MESH:
                mesh = int(model.geom_dataid[geom])
                first = int(model.mesh_polyadr[mesh])
                normals = model.mesh_polynormal[first : first + int(model.mesh_polynum[mesh])]
                local = data.geom_xmat[geom].reshape(3, 3).T @ away
                cosines.append(float(np.abs(normals @ local).max(initial=0)))
        return bool(cosines) and max(cosines) < FACING

    def _shortest(self, data: mujoco.MjData) -> tuple[float, Array | None]:
        """Distance of the geoms and their nearest points [m]; zero and None where MuJoCo finds none."""
        ends = np.zeros(6)
        try:
            distance = float(mujoco.mj_geomDistance(self.model, data, *self.geoms, FARTHEST_GEOM, ends))
        except mujoco.FatalError:
            return 0.0, None
        known = distance < FARTHEST_GEOM and np.any(ends != 0)
        return (distance, ends.reshape(2, 3)) if known else (0.0, None)


def reason_for_no_contact(pair: GeomPair) -> str:
    """Why MuJoCo makes no contact of two geoms without an explicit pair, in words; nothing if it makes one.

    Bodies that are welded together without joints are one body. A parent that is the world, or is welded to it, meets
    its children.
    """
    model, (first, second), (a, b) = pair.model, pair.geoms, pair.bodies
    if not (
        model.geom_contype[first] & model.geom_conaffinity[second]
        or model.geom_contype[second] & model.geom_conaffinity[first]
    ):
        return "their contype and conaffinity do not match"
    weld_a, weld_b = int(model.body_weldid[a]), int(model.body_weldid[b])
    if weld_a == weld_b:
        return "they belong to the same body"
    if weld_a and weld_b and not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_FILTERPARENT):
        parents = (int(model.body_weldid[model.body_parentid[weld]]) for weld in (weld_a, weld_b))
        if {weld_a, weld_b} & {*parents}:
            return "their bodies are parent and child"
    if (model.exclude_signature == (min(a, b) << 16) + max(a, b)).any():
        return "an <exclude> names their bodies"
    return ""


def makes(pair: GeomPair) -> bool:
    """Whether MuJoCo makes contacts of two geoms, by an explicit pair or without one."""
    return pair.explicit >= 0 or (pair.inverse_weight > 0 and not reason_for_no_contact(pair))


def every_pair(model: mujoco.MjModel, *, candidates: bool = True) -> Iterator[GeomPair]:
    """The explicit pairs of a model, then the geoms that MuJoCo lets collide without one. Pairs of which neither body
    can move are left out."""
    listed = set()
    for chosen, ends in enumerate(zip(model.pair_geom1.tolist(), model.pair_geom2.tolist(), strict=True)):
        listed.add(frozenset(ends))
        if (pair := GeomPair(model, ends, chosen)).inverse_weight > 0:
            yield pair
    for first in range(model.ngeom if candidates else 0):
        kinds, masks = model.geom_contype[first:], model.geom_conaffinity[first:]
        for later in np.flatnonzero(kinds[0] & masks[1:] | kinds[1:] & masks[0]).tolist():
            pair = GeomPair(model, (first, first + 1 + later))
            if frozenset(pair.geoms) not in listed and pair.inverse_weight > 0 and not reason_for_no_contact(pair):
                yield pair
