"""A random scene as a case, its run by a solver, and how far apart two runs are."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np

import mjrock as mr
from mjrock.distinct.search import contact_search
from mjrock.distinct.search.softening import Sides, shares_within
from mjrock.distinct.search.solids import Solids
from mjrock.distinct.setup import setup_of
from mjrock.geometry.poses import rotations
from mjrock.problem.masonry.blocks.joints_in_space import SpaceJoint
from mjrock.problem.masonry.lines import Lines
from mjrock.problem.masonry.rest_geometry import MasonryRestGeometry
from mjrock.problem.wall.rest_geometry import Solid
from tests import own_laws

from .quantities import QUANTITIES, Quantity, Scene, changed

LINKS = {"tie": mr.Tie, "damper": mr.Damper, "friction damper": mr.FrictionDamper}
"""Devices that are links to an anchor."""
OF_LINKS = {"stiffness": "stiffness", "strength": "strength", "ultimate": "ultimate", "slack": "slack", "damping": "c"}
OF_LINKS |= {"slip_force": "slip_force", "prestress": "prestress"}
"""Their arguments by the names of a scene."""
OF_JOINTS = ("k_n", "k_s", "friction", "xi", "frequency", "points", "tolerance")


def case_of(scene: Scene) -> mr.Case | mr.MasonryCase:
    """The case of a scene.

    Raises:
        ValueError: where the scene is refused.
    """
    return wall_case(scene) if scene["place"] == "wall" else masonry_case(scene)


def wall_case(scene: Scene) -> mr.Case:
    """One wall, released or shaken."""
    given = scene["block"]
    block = mr.Block.from_size(given["thickness"], given["height"], given["length"], given["density"])
    stop = scene["one_sided"] if scene["stop"] is None else mr.SideStop(scene["stop"])
    effects = tuple(device_on_wall(device) for device in scene["devices"])
    return mr.Case(block, scene["theta0"], scene["duration"], stop, effects=effects, **motions(scene["record"]))


def contacts_of(scene: Scene, case: mr.Case) -> mr.Contacts:
    """The contacts of a wall."""
    side = {"k_side": scene["k_side"], "xi_side": 0.5 * scene["xi"]} if scene["one_sided"] else {}
    return mr.Contacts.from_damping(case.wall, k_base=scene["k_n"], xi_base=scene["xi"], **side)


def device_on_wall(device: Scene) -> Any:
    """An effect of a wall."""
    height = device["at"][1]
    if device["kind"] in LINKS:
        return LINKS[device["kind"]](height, length=-device["reach"][0], **of_link(device))
    match device["kind"]:
        case "thrust":
            return mr.Thrust(height, device["force"][0])
        case "load":
            return mr.Load(-device["force"][1], height)
    return mr.AddedMass(device["mass"], height)


def of_link(device: Scene) -> dict[str, float]:
    """The arguments of a link that a device gives."""
    return {OF_LINKS[name]: value for name, value in device.items() if name in OF_LINKS and value is not None}


def motions(record: Scene | None) -> dict[str, mr.GroundMotion | None]:
    """Ground motions along the axes that a record shakes."""
    if record is None:
        return {}
    along = ("motion", "vertical") if record["acceleration"].shape[1] == 2 else ("motion", "transverse", "vertical")
    return {
        name: mr.GroundMotion(accel, record["dt"])
        for name, accel in zip(along, record["acceleration"].T, strict=True)
        if accel.any()
    }


def masonry_of(scene: Scene) -> mr.Masonry:
    """The blocks and joints of a scene."""
    bond = None if scene["bond"] is None else mr.Bond(**scene["bond"])
    if "own" in scene:
        softness, glue = scene["own"]["softness"], scene["own"].get("glue")
        bond = own_laws.Stiffening(softness) if glue is None else own_laws.Cohesive(*glue.values())
    pairs = None if scene.get("pairs") is None else mr.Dry(**scene["pairs"])
    blocks = [block_of(unit) for unit in scene["units"]]
    return mr.Masonry(blocks, bond=bond, pairs=pairs, **{name: scene[name] for name in OF_JOINTS})


def masonry_case(scene: Scene) -> mr.MasonryCase:
    """Masonry, and what moves it."""
    masonry, kick = masonry_of(scene), scene["kick"]
    return mr.MasonryCase(
        masonry,
        scene["duration"],
        **motions(scene["record"]),
        velocity=None if kick is None else np.column_stack([kick["velocity"], kick["spin"]]),
        effects=tuple(effect_of(masonry, device) for device in scene["devices"]),
        supports={name: (history["t"], *history["displacement"].T) for name, history in scene["supports"].items()},
        settled=scene["settled"],
        tilt=None if scene["tilt"] is None else (scene["tilt"]["t"], scene["tilt"]["angle"]),
    )


def block_of(unit: Scene) -> mr.Polygon | mr.Polyhedron | mr.Compound:
    """A block of one part, or a compound."""
    alone = len(unit["parts"]) == 1
    named = {"fixed": unit["fixed"], "name": unit["name"]}
    made = []
    for part in unit["parts"]:
        own = {"density": unit["density"]} | (named if alone else {})
        if part["corners"].shape[1] == 2:
            made.append(mr.Polygon(part["corners"], length=unit["length"], **own))
        else:
            made.append(mr.Polyhedron(part["corners"], **own))
    return made[0] if alone else mr.Compound(made, **named)


def effect_of(masonry: mr.Masonry, device: Scene) -> Any:
    """A device on a block of masonry."""
    block, at = device["block"], device["at"]
    if device["kind"] == "jack":
        names = ("stiffness", "damping")
        given, history = {name: device[name] for name in names}, (device["t"], device["stroke"])
        return mr.Actuator(block, at, device["direction"], history, **given, guided=device["guided"])
    place: dict[str, Any] = {"block": block}
    if masonry.in_space:
        place["at"] = at
    else:
        place["height"] = at[1]
    if device["kind"] in LINKS:
        anchor = {"anchor": at + device["reach"]} if masonry.in_space else {"length": -device["reach"][0]}
        if "to" in device:
            anchor["anchor_block"] = device["to"]
        return LINKS[device["kind"]](**place, **anchor, **of_link(device))
    if device["kind"] == "thrust":
        force = device["force"]
        if not masonry.in_space:
            return mr.Thrust(force=force[0], **place)
        size = float(np.linalg.norm(force))
        return mr.Thrust(force=size, direction=force / size, **place)
    if not masonry.in_space:
        place["offset"] = at[0] - masonry.blocks[masonry.names.index(block)].centroid[0]
    if device["kind"] == "load":
        return mr.Load(force=-device["force"][-1], **place)
    return mr.AddedMass(mass=device["mass"], **place)


def solve(scene: Scene, **options: Any) -> mr.Response:
    """The answer to a scene by its solver, at the step of the scene where it has one."""
    case = case_of(scene)
    contacts = contacts_of(scene, case) if isinstance(case, mr.Case) else None
    if scene["solver"] == "theory":
        return mr.solve_analytical(case, mr.Restitution.from_geometry(case.wall, case.stop_top), **options)
    calls = {"MuJoCo": mr.simulate, "plain": partial(mr.simulate, collisions=True), "explicit": mr.solve_explicit}
    call = calls[scene["solver"]]
    return call(case, contacts, scene["timestep"], **options)


@contextmanager
def measured_in_the_plane(scene: Scene) -> Iterator[None]:
    """Prisms of a scene of the plane have the sizes of its blocks, the outlines of their faces and the widths of its
    joints. The search goes by these when it looks for contacts, takes the faces that meet and hands joints over."""
    flat, solids, about = masonry_of(scene), vars(MasonryRestGeometry)["solids"].func, Solids.about
    sizes = {name: block.size for name, block in zip(flat.names, flat.blocks, strict=True)}
    widths = {(joint.below, joint.above, *np.round(joint.middle, 9)): joint.width for joint in flat.joints}

    def measured(standing: MasonryRestGeometry) -> tuple[Solid, ...]:
        return tuple(replace(solid, size=sizes[solid.name]) for solid in solids(standing))

    def width(joint: SpaceJoint) -> float:
        return widths[joint.below, joint.above, *np.round(joint.middle[::2], 9)]

    def outlined(*args: Any, flat: bool) -> Solids:
        return about(*args, flat=True)

    with (
        patch.object(Solids, "about", outlined),
        patch.object(MasonryRestGeometry, "solids", property(measured)),
        patch.object(SpaceJoint, "width", property(width)),
    ):
        yield


@contextmanager
def softened() -> Iterator[list[float]]:
    """The least share of their law that searches of runs in space leave contacts for the step [-], one of each search
    with contacts."""
    shares: list[float] = []

    def noted(sides: Sides, law: dict[str, np.ndarray], bodies: np.ndarray, step: float) -> np.ndarray:
        share = shares_within(sides, law, bodies, step)
        if sides.normals.shape[1] == 3 and len(share):
            shares.append(float(share.min()))
        return share

    with patch.object(contact_search, "shares_within", noted):
        yield shares


def has_other_points(scene: Scene) -> bool:
    """Whether prisms have a contact point on another block than their scene of the plane. A side of an L ends in the
    plane where its other part begins, and has a corner there. In space it goes on behind that part, and has none."""
    flat, solid = masonry_of(scene).lines, masonry_of(extruded(scene)).lines
    return points_of(flat, flat.at, flat.normal) != points_of(solid, solid.at[:, ::2], solid.normal[:, ::2])


def points_of(lines: Lines, *vectors: np.ndarray) -> set[tuple[float, ...]]:
    """The block that carries the point of each line, the one whose face it meets, and vectors of it, rounded."""
    blocks = np.column_stack([lines.body, lines.face])
    return set(map(tuple, np.hstack([blocks, *(np.round(vector, 9) + 0.0 for vector in vectors)]).tolist()))


def pushed_beside(scene: Scene) -> bool:
    """Whether a thrust of the plane acts at a place that is not on its block, as in the opening of an L."""
    blocks = {unit["name"]: block_of(unit) for unit in scene["units"]}
    for device in scene["devices"]:
        if device["kind"] == "thrust":
            block = blocks[device["block"]]
            at = np.array([block.centroid[0], device["at"][1]])
            outside = [max((at - side.corners[0]) @ side.normal for side in part.sides) for part in block.parts]
            if min(outside) > 0:
                return True
    return False


def default_step(scene: Scene) -> float:
    """The step that explicit steps take of themselves for masonry [s]."""
    return setup_of(masonry_case(scene), None, None).step_length.default


class Motion(NamedTuple):
    """Where the bodies of a run are at its samples.

    Args:
        names: of the bodies.
        sizes: of each [m].
        place: displacements [m], shape (n, bodies, d).
        turn: matrices of their rotations, shape (n, bodies, d, d).
    """

    names: tuple[str, ...]
    sizes: np.ndarray
    place: np.ndarray
    turn: np.ndarray

    def turned(self, matrix: np.ndarray, factor: float = 1.0) -> Motion:
        """The motion in axes that an orthogonal matrix turns, its lengths multiplied."""
        return Motion(self.names, factor * self.sizes, factor * self.place @ matrix.T, matrix @ self.turn @ matrix.T)

    def in_the_plane(self) -> Motion:
        """What of a motion in space lies in the plane x, z."""
        return Motion(self.names, self.sizes, self.place[..., ::2], self.turn[..., ::2, ::2])

    def out_of_the_plane(self) -> np.ndarray:
        """How far a motion in space is out of the plane x, z at each sample [m], shape (n,): the largest displacement
        across it, and turn out of it times the size of the body."""
        turn = np.abs(self.turn[..., [0, 2], 1]).max(axis=2) * self.sizes
        return np.maximum(np.abs(self.place[..., 1]), turn).max(axis=1)

    def until(self, n: int) -> Motion:
        """The motion to a sample, without it."""
        return self._replace(place=self.place[:n], turn=self.turn[:n])

    def extent(self) -> float:
        """Largest distance of a body from its start [m]."""
        n, start = len(self.place), self._replace(place=self.place[:1], turn=self.turn[:1])
        return apart(self, start._replace(place=start.place.repeat(n, 0), turn=start.turn.repeat(n, 0)))


def motion_of(answer: mr.Response) -> Motion:
    """The motion of a run."""
    d = 3 if answer.in_space else 2
    if isinstance(answer.case, mr.Case):
        names, sizes = ("wall",), [2 * answer.case.wall.h]
    else:
        masonry = answer.case.masonry
        names, sizes = answer.bodies, [masonry.blocks[i].size for i in masonry.free]
    return Motion(tuple(names), np.array(sizes), answer.pose[..., :d], rotations(answer.pose))


def apart(first: Motion, second: Motion) -> float:
    """Largest distance of two motions to the end of the shorter one [m], of rotations times the sizes of the first."""
    n = min(len(first.place), len(second.place))
    order = [second.names.index(name) for name in first.names]
    place = np.abs(first.place[:n] - second.place[:n, order]).max()
    turn = np.abs(first.turn[:n] - second.turn[:n, order]).max(axis=(0, 2, 3)) * first.sizes
    return float(max(place, turn.max()))


def extruded(scene: Scene) -> Scene:
    """A scene of the plane in space: blocks are prisms, and all that acts on them lies in their middle."""
    blocks = {unit["name"]: block_of(unit) for unit in scene["units"]}

    def solid(name: str, value: Any) -> Any:
        match QUANTITIES.get(name, Quantity(0, 0, 0)).turns:
            case "vector" | "point" if name != "corners":
                return np.insert(value, 1, 0.0, axis=-1)
            case "spin":
                return value * [0.0, 1.0, 0.0]
        return value

    made = changed(scene, solid) | {"place": "space"}
    for unit in made["units"]:
        half = 0.5 * unit["length"]
        for part in unit["parts"]:
            part["corners"] = np.array([(x, y, z) for x, z in part["corners"] for y in (-half, half)])
    for device in made["devices"]:
        block = blocks[device["block"]]
        if device["kind"] in LINKS:
            device["at"][0] = block.left_at(device["at"][2])
        elif device["kind"] == "thrust":
            device["at"][0] = block.centroid[0]
    if scene["xi"] and scene["frequency"] is None:
        made["frequency"] = (
            2 * scene["xi"] / masonry_of(scene).retardation[0]
        )  # space has lower modes, out of the plane
    return made
