"""The text of a plain model: bodies as boxes and hulls, a pair for each two neighbours, one rule for all others.

The text is complete, and the run steps the model that MuJoCo makes of it. Numbers have twelve digits, so that it reads
well, but for those of the keyframe, which have all. The keyframe `release` has the velocities half a step before the
release, where MuJoCo's Euler step keeps them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..._version import __version__
from ...geometry.frames import PLANE
from ...quantities import GRAVITY
from ...scene.parts import GROUND
from ...scene.scene import Scene
from ..mjcf import SPARSE_FROM, Keyframe, camera_of, extent_of, force_elements, link_elements
from ..shapes import BALL, HINGE, in_space, inertia_of_body, section, sites, tag, tints
from .pairs import POINTS, PairRows, Pairs
from .pieces import Piece

HEAD = """\
<mujoco model="rocking masonry">
  <!-- {title}; made by mjrock {version}. {facts}
       SI units and radians. MuJoCo finds {points} points where two faces meet, 2 where one stands on an edge.
       Each has k = k_n A / {points} of its joint and c = 2 xi k / omega. With W the sum of the inverse weights of its
       bodies and h the timestep, m = h c / 2 + h^2 k / 4, d = W m / (1 + W m), solref = -(1 - d) W (k, c), solimp =
       (d, d).{others} Reset to the keyframe `release` and step. -->
  <compiler angle="radian"/>
  <option timestep="{h}" gravity="0 0 {gravity}" integrator="Euler" cone="elliptic" impratio="{impratio}"
          solver="Newton" iterations="100" tolerance="1e-16"{rows}><flag island="disable"/></option>
"""
OTHERS = " Any two solids without a joint have the W k and W c of the median joint."
ASSETS = (
    '<texture type="skybox" builtin="gradient" rgb1="0.93 0.95 0.97" rgb2="0.62 0.7 0.8" width="16" height="96"/>',
    '<texture name="edges" type="cube" builtin="flat" mark="edge" markrgb="0.2 0.15 0.12" rgb1="1 1 1" rgb2="1 1 1" '
    'width="128" height="128"/>',
    '<material name="edges" texture="edges" specular="0.1"/>',
)
"""The sky, and the edges of boxes: a texture that is stretched over each face and dark along its border."""
SUN = (-0.2, 0.6, -0.9)
"""Direction of the light."""
VISUAL = (
    '<visual><global azimuth="110" elevation="-12" offwidth="1280" offheight="960"/><map shadowclip="2" zfar="20"/>'
    '<headlight ambient="0.25 0.25 0.27" diffuse="0.25 0.25 0.25" specular="0 0 0"/></visual>'
)
"""Camera and light of viewers. `shadowclip` is half the width of what casts shadows and `zfar` the depth of what is
seen, both over half the extent."""
PLASTER = (0.85, 0.82, 0.76, 1)
"""Colour of fixed blocks and the ground."""
SUPPORT_MASS = 1e12
"""Mass of a fixed block that is moved: nothing on it moves it [kg]."""
ZERO_COORDINATE = 1e-15
"""Coordinate up to which it is zero but for rounding [m]."""
MEMORY_OF_PIECE = 0.25
"""Room for the contacts of a piece, beside eight for all [MiB]."""


def number_text(values: object) -> str:
    """Numbers with twelve digits; what is less than 1e-15 is a rounding of zero."""
    numbers = np.ravel(np.asarray(values, dtype=float))
    return " ".join(f"{number:.12g}" for number in np.where(np.abs(numbers) < ZERO_COORDINATE, 0.0, numbers).tolist())


def text_of(value: object) -> str:
    """A text as it is, and numbers with twelve digits."""
    return value if isinstance(value, str) else number_text(value)


def element(kind: str, within: str = "", /, **attributes: object) -> str:
    """An element with texts and numbers as attributes."""
    return tag(kind, within, **{name: text_of(value) for name, value in attributes.items()})


def plain_text(
    scene: Scene, pieces: list[Piece], pairs: Pairs, timestep: float, keyframe: Keyframe, moved: tuple[str, ...]
) -> str:
    """The plain model of a scene as MJCF text. The same arguments give the same bytes.

    Names: each body and its geom as the block, the further geoms of a block of several parts with their numbers; the
    joints `x`, `z` and `theta` of a body of the plane and the free joint `free` of one in space, with the name of the
    body before them where there are several; the keyframe `release`; the camera `front`.

    Args:
        scene, pieces, pairs: the structure.
        timestep: MuJoCo's step [s].
        keyframe: of the release, as MuJoCo keeps it: qpos, qvel and the state of ties.
        moved: names of fixed blocks that are moved. Each is a body whose frame is that of the world at rest.
    """
    rows = pairs.rows(timestep)
    middle, half = extent_of(scene)
    laws, mixes = _laws(pairs, rows), _meets_others(pieces, pairs)
    head = HEAD.format(
        title=scene.title.replace("--", "- -"),
        version=__version__,
        facts=", ".join(
            f"{name} = {value if isinstance(value, str) else f'{value:.6g}'}" for name, value in scene.facts.items()
        ),
        points=POINTS,
        others=OTHERS if mixes else "",
        h=number_text(timestep),
        gravity=number_text(-GRAVITY),
        impratio=number_text(rows.impratio),
        rows=' jacobian="sparse"' if len(scene.bodies.names) >= SPARSE_FROM else "",
    )
    memory = [element("size", memory=f"{int(8 + MEMORY_OF_PIECE * len(pieces))}M")] if mixes else []
    shapes = [element("mesh", name=piece.name, vertex=piece.shape.corners) for piece in pieces if piece.has_mesh]
    body = [
        *memory,
        element("statistic", center=in_space(middle), extent=2 * half),
        VISUAL,
        *section("default", (f"  {line}" for line in _defaults(scene, pairs, rows, laws, mixes=mixes))),
        *section("asset", (f"  {line}" for line in [*ASSETS, *shapes])),
        "<worldbody>",
        "  " + _sun(np.array(in_space(middle)), half),
        "  " + element("camera", name="front", **camera_of(scene, middle, half), fovy="28"),
        *(f"  {line}" for line in _world(scene, pieces, moved)),
        "</worldbody>",
        *section("contact", (f"  {line}" for line in [*_pairs(pieces, pairs, laws), *_exclusions(moved)])),
        *section("tendon", link_elements(scene)),
        *section("actuator", force_elements(scene)),
        *section("keyframe", iter(["  " + tag("key", name="release", **keyframe.values)])),
    ]
    return head + "".join(f"  {line}\n" for line in body) + "</mujoco>\n"


def _sun(middle: NDArray[np.float64], half: float) -> str:
    """A light from far above, whose shadows end beyond the structure around the middle."""
    place = np.round(middle - 6 * half * np.array(SUN), 1)
    colours = {"ambient": np.full(3, 0.15), "diffuse": (0.6, 0.6, 0.57)}
    return element("light", name="sun", directional="true", pos=place, dir=SUN, **colours)


def _meets_others(pieces: list[Piece], pairs: Pairs) -> bool:
    """Whether two pieces may meet that are no neighbours at rest."""
    of_body = np.array([*Counter(piece.body for piece in pieces if piece.meets).values()])
    may = (of_body.sum() ** 2 - (of_body**2).sum()) // 2  # pairs of pieces of two bodies
    return bool(may > len(pairs.pieces))


def _laws(pairs: Pairs, rows: PairRows) -> list[dict[str, object]]:
    """The attributes of each pair."""
    laws: list[dict[str, object]] = []
    for i, mu in enumerate(pairs.friction[:-1].tolist()):
        law: dict[str, object] = {"condim": "1", "solref": rows.solref[i], "solimp": np.full(2, rows.impedance[i])}
        if mu > 0:
            law |= {
                "condim": "3",
                "friction": (mu, mu, 0, 0, 0),
                "solreffriction": f"-1e-30 {number_text(rows.friction_rate[i])}",
            }
        laws.append({name: text_of(value) for name, value in law.items()})
    return laws


def _class_of(laws: list[dict[str, object]]) -> dict[int, str]:
    """The class of each pair that has its law in common with another one, by the number of the pair."""
    texts = [str(law) for law in laws]
    shared = (text for text, count in Counter(texts).items() if count > 1)
    number = {text: i for i, text in enumerate(shared)}
    return {i: f"joint_{number[text]}" for i, text in enumerate(texts) if text in number}


def _defaults(
    scene: Scene, pairs: Pairs, rows: PairRows, laws: list[dict[str, object]], *, mixes: bool
) -> Iterator[str]:
    """What geoms without a joint meet with, the joints of the plane, and the laws that pairs have in common."""
    mu = pairs.friction[-1]
    others = {"condim": "3" if mu > 0 else "1", "friction": (mu, 0, 0)}
    if mixes:
        yield element("geom", **others, solref=rows.solref[-1], solimp=np.full(2, rows.impedance[-1]))
    if len(scene.bodies.names) > 1 and scene.freedom == PLANE:
        for name, kind, axis in HINGE:
            yield f'<default class="{name}">{element("joint", type=kind, axis=axis)}</default>'
    classes = _class_of(laws)
    for name in dict.fromkeys(classes.values()):
        i = next(i for i, class_name in classes.items() if class_name == name)
        yield f"<!-- {_comment(pairs, i)} -->"
        yield f'<default class="{name}">{element("pair", **laws[i])}</default>'


def _comment(pairs: Pairs, i: int) -> str:
    """Spring and dashpot of a pair in words."""
    return f"at each point k = {pairs.k[i]:.6g} N/m, c = {pairs.c[i]:.6g} N s/m"


def _pairs(pieces: list[Piece], pairs: Pairs, laws: list[dict[str, object]]) -> Iterator[str]:
    """The pairs of neighbours."""
    classes = _class_of(laws)
    for i, (a, b) in enumerate(pairs.pieces.tolist()):
        names = {"geom1": pieces[a].name, "geom2": pieces[b].name}
        if i in classes:
            yield tag("pair", **{"class": classes[i]}, **names)
        else:
            yield f"<!-- {_comment(pairs, i)} -->"
            yield element("pair", **names, **laws[i])


def _exclusions(moved: tuple[str, ...]) -> Iterator[str]:
    """Fixed geoms do not collide with blocks that are moved."""
    for i, name in enumerate(moved):
        for apart_from in ("world", *moved[:i]):
            yield element("exclude", body1=apart_from, body2=name)


def _world(scene: Scene, pieces: list[Piece], moved: tuple[str, ...]) -> Iterator[str]:
    """Fixed geoms, fixed blocks that are moved, and the bodies."""
    for piece in pieces:
        if piece.body == GROUND and piece.block not in moved:
            yield _geom(piece, rgba=PLASTER)
    yield from sites(scene, GROUND)
    for name in moved:
        yield element("body", name=name, gravcomp="1").removesuffix("/>") + ">"
        yield "  " + element("inertial", pos=(0, 0, 0), mass=SUPPORT_MASS, diaginertia=np.full(3, SUPPORT_MASS))
        yield "  " + "".join(
            element("joint", name=f"{name}_{axis}", type="slide", axis=along) for axis, _, along in BALL
        )
        yield from (f"  {_geom(piece, rgba=PLASTER)}" for piece in pieces if piece.block == name)
        yield "</body>"
    for j, (name, tint) in enumerate(zip(scene.bodies.names, tints(scene), strict=True)):
        yield from _body(scene, j, name, [piece for piece in pieces if piece.body == j], tint)


def _geom(piece: Piece, **attributes: object) -> str:
    """A piece as a geom in the frame of its body, or of the world."""
    attributes = {"name": piece.name} | attributes
    if not piece.meets:
        attributes |= {"contype": "0", "conaffinity": "0"}
    if not piece.is_seen:
        attributes |= {"group": "3"}
    if piece.is_ground:
        return element("geom", type="plane", size=(0, 0, 1), pos=(0, 0, piece.shape.corners[:, 2].max()), **attributes)
    if piece.box is not None:
        if piece.shape.box is None:
            attributes |= {"xyaxes": piece.box.axes[:2].ravel()}
        return element("geom", type="box", size=piece.box.half, pos=piece.box.middle, material="edges", **attributes)
    return element("geom", type="mesh", mesh=piece.name, **attributes)


def _body(scene: Scene, j: int, name: str, pieces: list[Piece], tint: dict[str, object]) -> Iterator[str]:
    """A body with its joints and its geoms. A uniform box is given its mass, any other body its moments of inertia."""
    alone = len(scene.bodies.names) == 1
    opening = element("body", name=name, pos=in_space(scene.bodies.rest[j]))
    yield opening.removesuffix("/>") + ">"
    if scene.freedom != PLANE:
        yield "  " + element("freejoint", name="free" if alone else f"{name}_free")
    elif alone:
        yield from ("  " + element("joint", name=axis, type=kind, axis=along) for axis, kind, along in HINGE)
    else:
        yield "  " + "".join(tag("joint", **{"class": axis}, name=f"{name}_{axis}") for axis, _, _ in HINGE)
    weight: dict[str, object] = {"mass": scene.bodies.mass[j]}
    if not _is_uniform_box(scene, j, pieces):
        yield "  " + element("inertial", pos=(0, 0, 0), mass=scene.bodies.mass[j], **inertia_of_body(scene, j))
        weight = {}
    for piece in pieces:
        yield "  " + _geom(piece, **weight, **tint)
    yield from (f"  {site}" for site in sites(scene, j))
    yield "</body>"


def _is_uniform_box(scene: Scene, j: int, pieces: list[Piece]) -> bool:
    """Whether a body is one box about its centroid whose moments of inertia are those of an even density."""
    box = pieces[0].shape.box
    if len(pieces) > 1 or box is None or np.abs(box[0]).max() > 1e-12 * box[1].max():
        return False
    square = box[1] ** 2
    even = scene.bodies.mass[j] / 3 * (square.sum() - square)
    held = np.array([scene.bodies.inertia[j]]) if scene.freedom == PLANE else np.diagonal(scene.bodies.inertia[j])
    return bool(np.allclose(held, even[1:2] if scene.freedom == PLANE else even, rtol=1e-9))
