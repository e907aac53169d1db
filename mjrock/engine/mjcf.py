"""The MJCF text of a scene: its bodies and contacts, at full precision.

The text is complete. Stock MuJoCo and its viewer load it, the keyframe `release` sets the bodies at their release, and
stepping it is the simulation at that fixed step. Newton's method starts from the accelerations of the step before where
there are several bodies, which saves half of its iterations; for one body this saves little. Contacts are explicit
`<pair>` elements between small spheres, centred on the contact points, and planes or boxes whose surface lies one
radius behind the face. Gap and lever are then those of the point at every rotation. (The bodies are raised by the
radius instead of lowering the ground, because MuJoCo takes a static geom within 1e-6 m of the origin to be at the
origin.)
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from .._version import __version__
from ..geometry.frames import PLANE
from ..method import METHOD, Method
from ..problem.wall.effect import LinkLaw
from ..quantities import GRAVITY, Array
from ..scene.parts import GROUND
from ..scene.scene import Scene
from .rows import ContactRows, Step, points_of, set_rows
from .shapes import in_space, meshes, section, sites, tag, value_text, world

HEAD = """\
<mujoco model="rocking wall">
  <!-- {title}; made by mjrock {version}.
       SI units and radians; k_n in N/m3, xi a fraction. To repeat `simulate(case, contacts, timestep={h})`, reset to
       the keyframe `release` and step. Its velocities are those half a step before the release, where MuJoCo's Euler
       step keeps them. A ground motion is not in this text: it acts through qfrc_applied. Steps that fit the motion are
       not in it either: they set timestep, impratio, solref, solimp and solreffriction for each length of step, and
       shift the velocities by half of its change. -->
  <compiler angle="radian"/>
  <option timestep={timestep} gravity={gravity} integrator="Euler" cone="elliptic" impratio={impratio} solver="Newton"
          iterations="500" tolerance="1e-10"{rows}>
    <flag {start}island="disable" autoreset="disable"/>
  </option>
  <statistic center={center} extent={extent}/>
  <visual>
    <global azimuth="110" elevation="-12" offwidth="1280" offheight="960"/>
    <headlight ambient="0.35 0.35 0.35" diffuse="0.4 0.4 0.4" specular="0 0 0"/>
  </visual>
  <default>
    <geom contype="0" conaffinity="0" group="1"/>
  </default>
  <asset>
    <texture name="sky" type="skybox" builtin="gradient" rgb1="0.93 0.95 0.97" rgb2="0.62 0.7 0.8" width="16"
             height="96"/>
    <texture name="paving" type="2d" builtin="checker" rgb1="0.72 0.72 0.7" rgb2="0.66 0.66 0.64" width="64"
             height="64"/>
    <material name="paving" texture="paving" texrepeat="1 1" texuniform="true"/>
    <material name="plaster" rgba="0.85 0.82 0.76 1"/>{meshes}
  </asset>
"""

IN_FRONT = (5.0, -3.0, 2.0)
"""From the middle of a scene of space to its camera, over half the size of the scene [-]."""
SPARSE_FROM = 4
"""Bodies from which MuJoCo keeps the rows of the contacts sparse. A row moves two bodies. A step of sixteen blocks in a
stack takes half the time with sparse rows, one of four blocks as much."""


def scene_mjcf(scene: Scene, timestep: float, newmark_beta: float = 0.25, keyframe: Keyframe | None = None) -> str:
    """The model of a scene as MJCF text. The same arguments give the same bytes.

    Names: each body and the geom that shows it; each contact point, its pair and its geom by group and number, such as
    `base_0`; the face that a group meets by the group; the joints `x`, `z` and `theta` of a single body, and in space
    `x`, `y`, `z` and `turn`, or with the name of the body before them; the keyframe `release`; the camera `front`.

    Args:
        scene: the scene.
        timestep: MuJoCo's step, on which the contact rows depend [s].
        newmark_beta: Newmark's beta of the contact rows [-], see `mjrock.contacts.solref.row`.
        keyframe: of the release. None means the scene at rest.
    """
    keyframe = (
        Keyframe(scene.at_rest, np.zeros_like(scene.bodies.masses), np.empty(0)) if keyframe is None else keyframe
    )
    scene = near_the_origin(scene)
    middle, half = extent_of(scene)
    fixed = pair_rows(scene, timestep, newmark_beta)
    head = HEAD.format(
        title=scene.title.replace("--", "- -"),
        version=__version__,
        h=repr(float(timestep)),
        timestep=value_text(timestep),
        gravity=value_text((0.0, 0.0, -GRAVITY)),
        impratio=value_text(fixed.impratio),
        rows=' jacobian="sparse"' if len(scene.bodies.names) >= SPARSE_FROM else "",
        start="" if len(scene.bodies.names) > 1 else 'warmstart="disable" ',
        center=value_text(in_space(middle)),
        extent=value_text(2 * half),
        meshes="".join(f"\n    {mesh}" for mesh in meshes(scene)),
    )
    camera = camera_of(scene, middle, half)
    body = [
        "<worldbody>",
        '  <light name="sun" directional="true" castshadow="false" dir="-0.4 0.5 -0.8"/>',
        tag("camera", name="front", **camera, fovy="28"),
        *world(scene),
        *(f"  {site}" for site in sites(scene, GROUND, scene.radius)),
        "</worldbody>",
        *section("contact", _pairs(scene, fixed.rows)),
        *section("tendon", link_elements(scene)),
        *section("actuator", force_elements(scene)),
        *section("custom", _records(scene, newmark_beta)),
        *section("keyframe", iter(["  " + tag("key", name="release", **keyframe.values)])),
    ]
    return head + "".join(f"  {line}\n" for line in body) + "</mujoco>\n"


def near_the_origin(scene: Scene) -> Scene:
    """A scene moved by whole kilometres, its middle to within one of the origin along each axis.

    MuJoCo rounds the places of bodies in the world, at 10 km by 2e-12 m. Poses are displacements from rest, and stay.
    """
    by = 1e3 * np.fix(1e-3 * extent_of(scene)[0])
    if not by.any():
        return scene
    contacts, links = scene.contacts, scene.links
    face_at = contacts.face_at - np.where(contacts.face_body[:, None] == GROUND, by, 0.0)
    if links.names:
        links = replace(links, anchor_at=links.anchor_at - np.where(links.anchor_body[:, None] == GROUND, by, 0.0))
    bodies, contacts = replace(scene.bodies, rest=scene.bodies.rest - by), replace(contacts, face_at=face_at)
    return replace(scene, bodies=bodies, contacts=contacts, links=links, settled=scene.at_rest)


def extent_of(scene: Scene) -> tuple[Array, float]:
    """Middle of the bodies at rest [m], shape (d,), and half of their largest extent along an axis [m]."""
    corners = np.concatenate(
        [centroid + outline for centroid, outline in zip(scene.bodies.rest, scene.bodies.outlines, strict=True)]
    )
    low, high = corners.min(axis=0), corners.max(axis=0)
    return 0.5 * (low + high), 0.5 * float((high - low).max())


def camera_of(scene: Scene, middle: Array, half: float) -> dict[str, object]:
    """Where the camera stands: before the plane, or in space before the facade and beside it."""
    if scene.freedom == PLANE:
        at = (middle[0] + 0.2 * half, -6 * half, middle[1] + 0.3 * half)
        return {"pos": at, "xyaxes": (1.0, 0.0, 0.0, 0.0, 0.05, 1.0)}
    away = np.array(IN_FRONT)
    right = np.cross((0.0, 0.0, 1.0), away)
    return {"pos": middle + half * away, "xyaxes": (*right, *np.cross(away, right))}


class Keyframe(NamedTuple):
    """What the keyframe `release` holds.

    Args:
        pose: of the bodies at the release, shape (n, nq).
        velocity: half a step before the release, shape (n, nv).
        plastic: state of the ties, as MuJoCo keeps it, shape (2 t,); empty where none can yield.
    """

    pose: Array
    velocity: Array
    plastic: Array

    @property
    def values(self) -> dict[str, Array]:
        """By the names of MuJoCo."""
        values = {"qpos": self.pose, "qvel": self.velocity, "plastic": self.plastic}
        return {name: value for name, value in values.items() if len(value)}


class FixedRows(NamedTuple):
    """The rows of all pairs at one step, the impratio of the model [-], and the dashpots of the links [N s/m], (t,)."""

    rows: ContactRows
    impratio: float
    damping: Array


def pair_rows(scene: Scene, timestep: float, newmark_beta: float = 0.25, method: Method = METHOD) -> FixedRows:
    """The rows of a scene at a fixed step."""
    points, m = points_of(scene, method), len(scene.contacts.k)
    rows, step = ContactRows.with_room(m), Step(timestep, np.full(m, newmark_beta), np.zeros(m))
    return FixedRows(rows, set_rows(points, step, rows), scene.links.law["c"])


def link_elements(scene: Scene) -> Iterator[str]:
    """The links: tendons with a spring that is slack up to a length and yields at a force, and with a dashpot."""
    links, lengths = scene.links, dict(zip(scene.links.sprung.names, scene.ties.reach.tolist(), strict=True))
    for i, name in enumerate(links.names):
        law = LinkLaw(*links.law[i])
        attributes: dict[str, object] = {"damping": law.c} if law.damps or law.k == 0 else {}
        if law.k > 0:
            yields = {"springyield": law.strength / law.k} if law.yields else {}
            slack_from = lengths[name] if law.push > 0 else 0
            attributes = {"springlength": (slack_from, lengths[name]), "stiffness": law.k, **yields, **attributes}
        ends = "".join(tag("site", site=site) for site in (f"{name}_anchor", name))
        yield "  " + tag("spatial", ends, name=name, **attributes)


def force_elements(scene: Scene) -> Iterator[str]:
    """The constant forces: actuators that need no control."""
    for name, force in zip(scene.forces.names, scene.forces.force, strict=True):
        yield "  " + tag(
            "general",
            name=name,
            site=name,
            refsite="origin",
            gear=(*in_space(force), 0, 0, 0),
            gainprm="0",
            biastype="affine",
            biasprm="1 0 0",
        )


def _pairs(scene: Scene, rows: ContactRows) -> Iterator[str]:
    """The contacts."""
    for i, (point, face) in enumerate(zip(scene.contacts.point_names, scene.contacts.face_names, strict=True)):
        mu = scene.contacts.friction[i]
        of_friction: dict[str, object] = {"condim": "1"}
        if mu > 0:
            of_friction = {"condim": "3", "friction": (mu, mu, 0, 0, 0), "solreffriction": rows.solreffriction[i]}
        row = {"solref": rows.solref[i], "solimp": rows.solimp[i]}
        yield "  " + tag("pair", name=point, geom1=point, geom2=face, **row, **of_friction)


def _records(scene: Scene, newmark_beta: float) -> Iterator[str]:
    """What made the model."""
    for name, value in scene.facts.items():
        if not isinstance(value, str):
            yield "  " + tag("numeric", name=name, data=value)
    yield "  " + tag("numeric", name="newmark_beta", data=newmark_beta)
    for name, text in (*scene.facts.items(), ("mjrock", __version__)):
        if isinstance(text, str):
            yield "  " + tag("text", name=name, data=text)
