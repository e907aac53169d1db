"""The MJCF text of a case: a wall, a base, and a side stop where the case has one, at full precision.

The text is complete: stock MuJoCo and its viewer load it, the keyframe `release` tilts the wall, and stepping it is the
simulation. Contacts are explicit `<pair>` elements between small spheres, centred on the contact points of the wall,
and planes set off by their radius, so that gap and lever are those of the point at every rotation. (Upwards it is the
wall that is set off: MuJoCo takes a static geom within 1e-6 m of the origin to be at the origin.)
"""

from __future__ import annotations

from xml.etree.ElementTree import Comment, Element, SubElement, indent, tostring

from ._version import __version__
from .block import GRAVITY, Block, require_within
from .case import Case
from .contact import ContactParameters, contact_parameters, friction_that_holds, sound_beta
from .interface import Contacts, Interface
from .pose import release_pose

RADIUS = 1e-6
"""Radius of the contact spheres in half heights [-]: friction acts at their surface, so it is tiny."""
FREE_FRICTION = 1.0
"""Friction coefficient of the edges of a wall without a side stop on two lines [-]; on a bed of n lines n/2 times that,
as an edge carries so much less. It holds any wall in free rocking, whose base is pushed with at most
(3/4) sin(2 alpha) / (2 - (3/2) sin(alpha)^2) of what loads it. It is no larger because two edges that both stick while
the wall turns over work against each other: with mu = 30 a wall of h/b = 15 on 5e7 N/m3 loses a third too much."""
HELD_FRICTION = 30.0
"""Friction coefficient of the outer edge of a wall with a side stop [-]. It is not to slip when the side impact throws
the base while it is hardly loaded: on the paper's wall mu = 1 loses 13 % of |e_1s| and mu = 3 loses 2 %, from mu = 10
nothing changes (`scripts/friction.py`). The inner edge takes as much of it as SELF_WORK allows."""
SELF_WORK = 1e-4
"""Most work that two sticking edges may do against each other in an impact, over the energy of a release at alpha/2."""
HELD_MASSES = 1e3
"""Inertia of a friction row in masses of the wall [-]: a horizontal acceleration a creeps at a h / HELD_MASSES."""


def inverse_weight(mass: float) -> float:
    """W of a contact of the planar wall [1/kg], 2/(3 m).

    MuJoCo's `body_invweight0` is the mean of the inverse masses along three axes; two slides and a hinge leave two.
    """
    return 2 / (3 * mass)


def inner_friction(wall: Block, contacts: Contacts) -> float:
    """Friction coefficient of the inner edge of a wall with a side stop [-], 1 to HELD_FRICTION.

    While both edges are loaded, up to the uplift rotation theta_u, they slide against each other by b theta_u^2, which
    takes mu m g b theta_u^2; a release at alpha/2 has about (3/8) m g b alpha. On a stiff base that is nothing, and the
    inner edge has to hold where a soft side stop lets the wall lean on it; on a soft base it never does.
    """
    allowed = SELF_WORK * 0.375 * wall.alpha / contacts.uplift_rotation(wall) ** 2
    return min(max(allowed, FREE_FRICTION), HELD_FRICTION)


def wall_mjcf(case: Case, contacts: Contacts, timestep: float, *, newmark_beta: float = 0.25) -> str:
    """The model of `case` on `contacts` as MJCF text; the same arguments give the same bytes.

    Names: bodies and geoms `wall`, `base`, `side`; contact points `base_0`, `base_1`, ... from the inner to the outer
    edge and `side_0`, ... from the bottom to the top; joints `x`, `z`, `theta`; keyframe `release`; camera `front`.
    Without a side stop there is no side geom and no side pair. Friction acts at the two edges of the base alone: a bed
    whose every line sticks would lock the rotation that shears it.

    Args:
        case: the wall and its release.
        contacts: the interfaces.
        timestep: MuJoCo's step, which the contact rows depend on [s].
        newmark_beta: Newmark's beta of the contact rows [-], see `mjrock.contact`. Rows that MuJoCo would clamp,
            or whose dashpot is stiff for the step, take a larger one (`mjrock.contact.sound_beta`).

    Raises:
        ValueError: if the contacts do not fit the case, or a contact cannot be represented at this step.
    """
    require_within("timestep", timestep, 1e-9, 1.0, "s")
    wall = case.block
    contacts.require_fit(wall, side_stop=case.side_stop)
    b, h, length, radius = wall.b, wall.h, wall.length, RADIUS * wall.h
    base_rows = _rows(contacts.base, timestep, inverse_weight(wall.mass), newmark_beta)
    hold, impratio = friction_that_holds(base_rows[0], timestep=timestep, held_inertia=HELD_MASSES * wall.mass)
    pose, velocity = release_pose(case, contacts)

    root = Element("mujoco", model="rocking wall")
    root.append(
        Comment(
            f" A masonry wall, {2 * b:g} m thick, {2 * h:g} m high, {length:g} m long, {wall.density:g} kg/m3, rocking "
            f"{'against a side stop' if case.side_stop else 'on both edges'}; made by mjrock {__version__}. "
            "SI units and radians; k_n in N/m3, xi a fraction. "
        )
    )
    _add(root, "compiler", angle="radian")
    option = _add(
        root, "option", timestep=timestep, gravity=(0, 0, -GRAVITY), integrator="Euler", cone="elliptic",
        impratio=impratio, solver="Newton", iterations="50", tolerance=1e-10,
    )  # fmt: skip
    _add(option, "flag", warmstart="disable", island="disable", autoreset="disable")
    _add_scenery(root, case)

    world = _add(root, "worldbody")
    _add(world, "light", name="sun", directional="true", castshadow="false", dir=(-0.4, 0.5, -0.8))
    _add(world, "camera", name="front", pos=(0.2 * h, -6 * h, 1.3 * h), xyaxes=(1, 0, 0, 0, 0.05, 1), fovy="28")
    _add(world, "geom", name="base", type="plane", size=(0, 0, 1), material="paving")
    if case.side_stop:
        plane = (-b - radius, 0, h)
        _add(world, "geom", name="side", type="plane", size=(h, 0.6 * length, 1), pos=plane, zaxis=(1, 0, 0), group="3")
        extent = (b, 0.6 * length, h)
        _add(world, "geom", name="side_wall", type="box", size=extent, pos=(-2 * b, 0, h), material="plaster")
    body = _add(world, "body", name="wall", pos=(0, 0, h + radius))
    about_x, about_z = (wall.mass * (length**2 + 4 * half**2) / 12 for half in (h, b))
    _add(body, "inertial", pos=(0, 0, 0), mass=wall.mass, diaginertia=(about_x, wall.inertia, about_z))
    _add(body, "joint", name="x", type="slide", axis=(1, 0, 0))
    _add(body, "joint", name="z", type="slide", axis=(0, 0, 1))
    _add(body, "joint", name="theta", type="hinge", axis=(0, 1, 0))
    _add(body, "geom", name="wall", type="box", size=(b, length / 2, h), material="brick")

    pairs = _add(root, "contact")
    for i, (x, row) in enumerate(zip(contacts.base.positions, base_rows, strict=True)):
        grip: dict[str, object] = {"condim": "1"}
        if i in (0, len(base_rows) - 1):
            mu = HELD_FRICTION if i else inner_friction(wall, contacts)
            mu = mu if case.side_stop else FREE_FRICTION * contacts.base.points / 2
            grip = {"condim": "3", "friction": (mu, mu, 0, 0, 0), "solreffriction": hold}
        sphere = {"size": radius, "pos": (x, 0, -h)}
        _add_point(body, pairs, f"base_{i}", sphere, "base", row, grip)
    facts = {"k_n_base": contacts.base.k_n, "xi_base": contacts.base.xi}
    if case.side_stop:
        assert contacts.side is not None
        side_rows = _rows(contacts.side, timestep, inverse_weight(wall.mass), newmark_beta)
        for i, (z, row) in enumerate(zip(contacts.side.positions, side_rows, strict=True)):
            sphere = {"size": radius, "pos": (-b, 0, z)}
            _add_point(body, pairs, f"side_{i}", sphere, "side", row, {"condim": "1"})
        facts |= {"k_n_side": contacts.side.k_n, "xi_side": contacts.side.xi}
    facts |= {"reference_frequency": contacts.base.frequency, "newmark_beta": newmark_beta}

    custom = _add(root, "custom")
    for name, value in facts.items():
        _add(custom, "numeric", name=name, data=value)
    _add(custom, "text", name="law", data=contacts.law)
    _add(custom, "text", name="mjrock", data=__version__)
    _add(_add(root, "keyframe"), "key", name="release", qpos=pose, qvel=velocity)
    indent(root)
    return tostring(root, encoding="unicode") + "\n"


def _text(value: object) -> str:
    """An attribute's text: strings as they are, numbers with every digit that tells them from their neighbours."""
    if isinstance(value, str):
        return value
    numbers = value if hasattr(value, "__iter__") else (value,)
    return " ".join(repr(float(number)) for number in numbers)


def _add(parent: Element, tag: str, **attributes: object) -> Element:
    return SubElement(parent, tag, {name: _text(value) for name, value in attributes.items()})


def _rows(interface: Interface, timestep: float, weight: float, newmark_beta: float) -> list[ContactParameters]:
    """The contact row of each line of an interface."""
    return [
        contact_parameters(
            k,
            c,
            timestep=timestep,
            inverse_weight=weight,
            newmark_beta=sound_beta(k, c, timestep, weight, newmark_beta),
        )
        for k, c in zip(interface.stiffness.tolist(), interface.damping.tolist(), strict=True)
    ]


def _add_point(
    body: Element,
    pairs: Element,
    name: str,
    sphere: dict[str, object],
    plane: str,
    row: ContactParameters,
    friction: dict[str, object],
) -> None:
    """A contact point of the wall: its sphere, and its pair with a plane."""
    _add(body, "geom", name=name, type="sphere", group="3", **sphere)
    _add(pairs, "pair", name=name, geom1=name, geom2=plane, solref=row.solref, solimp=row.solimp, **friction)


def _add_scenery(root: Element, case: Case) -> None:
    """What only the eye needs, and the default by which geoms meet through explicit pairs alone."""
    h = case.block.h
    _add(root, "statistic", center=(0, 0, h), extent=2 * h)
    visual = _add(root, "visual")
    _add(visual, "global", azimuth="110", elevation="-12", offwidth="1280", offheight="960")
    _add(visual, "headlight", ambient=(0.35, 0.35, 0.35), diffuse=(0.4, 0.4, 0.4), specular=(0, 0, 0))
    _add(_add(root, "default"), "geom", contype="0", conaffinity="0", group="1")
    asset = _add(root, "asset")
    sky = {"rgb1": (0.93, 0.95, 0.97), "rgb2": (0.62, 0.70, 0.80), "width": "64", "height": "384"}
    _add(asset, "texture", name="sky", type="skybox", builtin="gradient", **sky)
    paving = {"rgb1": (0.72, 0.72, 0.70), "rgb2": (0.66, 0.66, 0.64), "width": "256", "height": "256"}
    _add(asset, "texture", name="paving", type="2d", builtin="checker", **paving)
    _add(asset, "material", name="paving", texture="paving", texrepeat=(1, 1), texuniform="true")
    _add(asset, "material", name="brick", rgba=(0.70, 0.33, 0.23, 1))
    _add(asset, "material", name="plaster", rgba=(0.85, 0.82, 0.76, 1))
