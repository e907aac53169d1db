"""The parts of a scene: bodies, contacts, links, constant forces and limits. Each checks its own shapes and values.

Vectors have d = 2 numbers in the plane and 3 in space.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..geometry.frames import PLANE, SPACE, Freedom
from ..problem.masonry.laws.bond import Bond, strengths
from ..problem.masonry.laws.dry import PairProperties
from ..problem.masonry.laws.joint_law import law_rows
from ..problem.masonry.laws.own_law import Own
from ..problem.wall.effect import Effect, LinkLaw
from ..problem.wall.effects import constant_forces_of, link_effects
from ..problem.wall.own_link import AppliedLink
from ..quantities import Array, Flags, Integers, frozen, shown
from ..rows import Rows, numbers, row_type
from .masses import mass_diagonals, principal, products_of

GROUND = -1
"""The body of a face or an anchor that belongs to the ground."""
LAW = row_type(numbers(*LinkLaw._fields))
"""A row with the numbers of the law of a link."""


def label_of(part: object) -> str:
    """The name of a part in a message."""
    names = {"Bodies": "bodies", "ContactPoints": "contacts", "Links": "links", "ConstantForces": "forces"}
    return names[type(part).__name__]


def keep_array(
    part: object,
    name: str,
    shape: tuple[int, ...],
    *,
    kind: type = float,
    above: float | None = None,
    least: float | None = None,
) -> None:
    """Keep a field of a part as an array of the kind that compiled functions take.

    Raises:
        TypeError, ValueError: for what is not an array of numbers, another shape or a value out of range. The message
            names it.
    """
    argument, label = getattr(part, name), f"{name} of the {label_of(part)}"
    try:
        values: NDArray[Any] = np.ascontiguousarray(argument, dtype=kind)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{label} = {shown(argument)} is not an array of numbers") from None
    values = values if values.size else values.reshape(shape)
    if values.shape != shape:
        raise ValueError(f"{label} has the shape {values.shape}; {shape} is needed")
    require_values(label, values, above, least)
    object.__setattr__(part, name, frozen(values))


def require_values(
    label: str, values: NDArray[Any], above: float | None = None, least: float | None = None, infinite: bool = False
) -> None:
    """Raise a ValueError for a value that is not finite, not above `above`, or below `least`."""
    if np.isnan(values).any() or not (infinite or np.isfinite(values).all()):
        raise ValueError(f"{label} holds a value that is not finite")
    if above is not None and not (values > above).all():
        raise ValueError(f"{label} = {values.min():g} is outside the valid range, which is above {above:g}")
    if least is not None and not (values >= least).all():
        raise ValueError(f"{label} = {values.min():g} is outside the valid range, which starts at {least:g}")


def require_others(part: ContactPoints | Links, name: str) -> None:
    """Raise a ValueError where a face or an anchor is on the body that carries the point."""
    if (getattr(part, name) == part.body).any() or (getattr(part, name) < GROUND).any():
        raise ValueError(f"{name} of the {label_of(part)} is another body, or {GROUND} for the ground")


def require_on(bodies: Bodies, parts: Iterable[ContactPoints | Links | ConstantForces]) -> None:
    """Raise a ValueError unless parts are of the plane or of space as the bodies are, and on them."""
    n, directions = len(bodies.names), bodies.rest.shape[1]
    for part in parts:
        if len(part.body) and part.at.shape[1] != directions:
            label = f"at of the {label_of(part)}"
            raise ValueError(f"{label} has the shape {part.at.shape}; {(len(part.body), directions)} is needed")
        for name in ("body", "face_body", "anchor_body"):
            lowest = 0 if name == "body" else GROUND
            numbers = getattr(part, name, np.empty(0))
            if not ((numbers >= lowest) & (numbers < n)).all():
                raise ValueError(f"{name} of the {label_of(part)} is outside the valid range {lowest} to {n - 1}")


def require_inertia(inertia: Array) -> None:
    """Raise ValueError for moments of inertia, or tensors of space, that no body has.

    Tensors are symmetric, and no principal moment is larger than the sum of the other two.
    """
    if inertia.ndim == 1:
        if not (inertia > 0).all():
            raise ValueError(f"inertia = {inertia.min():g} is outside the valid range inertia > 0")
        return
    for tensor in inertia:
        moments = np.linalg.eigvalsh(tensor)
        if not (np.allclose(tensor, tensor.T, rtol=0, atol=1e-9 * np.abs(tensor).max()) and moments[0] > 0):
            raise ValueError(f"inertia = {tensor.tolist()} is not a symmetric tensor with three positive moments")
        if moments[2] > (1 + 1e-9) * (moments[0] + moments[1]):
            raise ValueError(
                f"inertia with the principal moments {', '.join(f'{moment:g}' for moment in moments)}: no body has one "
                "that is larger than the sum of the other two"
            )


def _empty_array() -> NDArray[Any]:
    """An array without values."""
    return np.empty(0)


@dataclass(frozen=True, eq=False)
class Bodies:
    """Rigid bodies.

    Args:
        names: names of the n bodies.
        mass: masses [kg], shape (n,).
        inertia: moments of inertia about the centroids [kg m2], shape (n,), and in space the tensors, shape (n, 3, 3).
        rest: positions of the centroids at rest, the contacts undeformed [m], shape (n, d). It says whether the scene
            is one of the plane or of space.
        outlines: vertices of each body about its centroid, for pictures [m], n arrays of shape (vertices, d).
        length: length out of the plane, for pictures [m]. It makes no difference in space.
        parts: vertices of the convex parts of each body that is not convex, for pictures, by its number.
    """

    names: tuple[str, ...]
    mass: Array
    inertia: Array
    rest: Array
    outlines: tuple[Array, ...]
    length: float
    parts: Mapping[int, tuple[Array, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        n, directions = len(self.names), 3 if np.shape(self.rest)[-1:] == (3,) else 2
        keep_array(self, "mass", (n,), above=0.0)
        keep_array(self, "inertia", (n,) if directions == 2 else (n, 3, 3))
        keep_array(self, "rest", (n, directions))
        require_inertia(self.inertia)

    @property
    def freedom(self) -> Freedom:
        """How the bodies may move: in the plane or in space."""
        return PLANE if self.rest.shape[1] == 2 else SPACE

    def parts_of(self, body: int) -> tuple[Array, ...]:
        """Vertices of the convex parts of a body about its centroid [m]: the outline of one that is convex."""
        return self.parts.get(body, (self.outlines[body],))

    @cached_property
    def extent(self) -> float:
        """The largest coordinate of a vertex from the centroid of its body [m]."""
        return max(float(np.abs(outline).max()) for outline in self.outlines)

    @cached_property
    def masses(self) -> Array:
        """Generalised masses: m, m, I of each body, and in space m, m, m, Ixx, Iyy, Izz, shape (n nv,)."""
        return frozen(mass_diagonals(self.mass, self.inertia))

    @cached_property
    def products(self) -> Array:
        """Products of inertia of the bodies of space [kg m2], see `mjrock.scene.masses`, shape (n, 3), or (0, 3)."""
        return frozen(products_of(self.inertia))

    @cached_property
    def principal(self) -> tuple[csr_array, Array]:
        """Velocities of the bodies along their principal axes, and the masses of each, see `masses.principal`."""
        return principal(self.mass, self.inertia)

    def between(self, body: Integers, at: Array, other: Integers, start: Array) -> Array:
        """Vectors at rest from points of other bodies or of the ground to points of bodies [m], shape (k, d)."""
        if not len(body):
            return frozen(np.empty((0, self.rest.shape[1])))
        return frozen(self.rest[body] + at - np.where(other[:, None] < 0, 0.0, self.rest[other]) - start)


@dataclass(frozen=True, eq=False)
class ContactPoints:
    """Compliant contacts between points on bodies and plane faces of other bodies or of the ground.

    Args:
        body: the body that carries each of the m contact points, shape (m,).
        at: position of each point from the centroid of its body [m], shape (m, d).
        face_body: the body whose face each point meets, or -1 for the ground, shape (m,).
        face_at: a point of that face, from the centroid of its body or from the origin of the world [m], shape (m, d).
        normal: unit vector out of that face, shape (m, d).
        k, c: spring [N/m] and dashpot [N s/m] of each contact, shape (m,).
        friction: coefficient of friction of each contact, zero for none [-], shape (m,).
        joint: number of the joint that each contact belongs to, shape (m,). Its points are numbered in the model.
        joints: names of the joints. The ledger has an account for each.
        holds: which contacts stand for a base that holds, shape (m,), or one answer for all. Their coefficient of
            friction is a number that holds it, and no law of sliding.
        k_s: spring of each contact along its face [N/m], infinite where it sticks rigidly, shape (m,), or one number
            for all.
        area: what part of its joint each contact stands for [m2], shape (m,), or one number for all.
        bonds: the bond of each joint, or its own law, None where a joint is dry; empty where all are.
        further: the other numbers of the law of each contact by name, see `joint_law.Law`, shape (m,) each.
    """

    body: Integers
    at: Array
    face_body: Integers
    face_at: Array
    normal: Array
    k: Array
    c: Array
    friction: Array
    joint: Integers
    joints: tuple[str, ...]
    holds: Flags | bool = False
    k_s: Array | float = math.inf
    area: Array | float = 0.0
    bonds: tuple[Bond | Own | None, ...] = ()
    further: Mapping[str, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        m, directions = len(self.k), np.shape(self.normal)[-1] if np.size(self.normal) else 2
        keep_array(self, "k", (m,), above=0.0)
        for name in ("c", "friction"):
            keep_array(self, name, (m,), least=0.0)
        for name in ("body", "face_body", "joint"):
            keep_array(self, name, (m,), kind=np.int64)
        for name in ("at", "face_at", "normal"):
            keep_array(self, name, (m, directions))
        require_others(self, "face_body")
        if not np.allclose(np.hypot.reduce(self.normal, axis=1), 1.0):
            raise ValueError("normal of the contacts holds a vector that is not of unit length")
        if not ((self.joint >= 0) & (self.joint < len(self.joints))).all():
            raise ValueError(f"joint of the contacts is outside the valid range 0 to {len(self.joints) - 1}")
        object.__setattr__(self, "holds", frozen(np.broadcast_to(np.array(self.holds, dtype=bool), (m,))))
        for name in ("k_s", "area"):
            object.__setattr__(self, name, frozen(np.broadcast_to(np.array(getattr(self, name), dtype=float), (m,))))

    @cached_property
    def law(self) -> Rows:
        """Rows of the law of the contacts, with all its numbers, shape (m,)."""
        springs = {"k": self.k, "c": self.c, "k_s": np.asarray(self.k_s)}
        return law_rows(len(self.k), friction=self.friction, **springs, **self.further)

    @cached_property
    def tension(self) -> Array:
        """Tension that the bond of each contact holds [N], shape (m,)."""
        return self._strength("tension")

    @cached_property
    def cohesion(self) -> Array:
        """Force along the face that it holds without pressure [N], shape (m,)."""
        return self._strength("cohesion")

    def _strength(self, name: str) -> Array:
        return np.asarray(strengths(self.bonds, name)[self.joint] * self.area if self.bonds else np.zeros(len(self.k)))

    @property
    def group(self) -> tuple[str, ...]:
        """Name of the joint of each contact."""
        return tuple(self.joints[joint] for joint in self.joint)

    @cached_property
    def point_names(self) -> tuple[str, ...]:
        """Name of each contact point: its joint and its number in it."""
        numbers: Counter[str] = Counter()
        names = []
        for name in self.group:
            names.append(f"{name}_{numbers[name]}")
            numbers[name] += 1
        return tuple(names)

    @cached_property
    def face_names(self) -> tuple[str, ...]:
        """Name of the face that each point meets: its joint, with a number where the points of a joint meet several."""
        places = np.column_stack([self.face_body, self.face_at, self.normal]).tolist()
        faces = [(name, *place) for name, place in zip(self.group, places, strict=True)]
        known: dict[tuple[object, ...], str] = {}
        met: Counter[str] = Counter()
        for face in dict.fromkeys(faces):
            name = face[0]
            known[face] = f"{name}_face_{met[name]}" if met[name] else name
            met[name] += 1
        return tuple(known[face] for face in faces)


@dataclass(frozen=True, eq=False)
class Links:
    """Links between points of bodies and anchors on the ground or on other bodies, by their law, see `LinkLaw`.

    Args:
        names: names of the links.
        body, at: the body that each link holds, and where, from its centroid [m], shapes (t,) and (t, d).
        anchor_body, anchor_at: the body of the other end, or -1 for the ground, and the end, as of a face, shapes (t,)
            and (t, d).
        law: a `LinkLaw` for each, kept as rows with its numbers, shape (t,).
        anchor_block: number of the block of masonry that the other end moves with, or -1 for the ground, shape (t,).
        user_laws: the own law of each, None where `law` has it; empty where none has one.
    """

    names: tuple[str, ...] = ()
    body: Integers = field(default_factory=_empty_array)
    at: Array = field(default_factory=_empty_array)
    anchor_body: Integers = field(default_factory=_empty_array)
    anchor_at: Array = field(default_factory=_empty_array)
    law: NDArray[np.void] = field(default_factory=_empty_array)
    anchor_block: Integers = field(default_factory=_empty_array)
    user_laws: tuple[AppliedLink | None, ...] = ()

    def __post_init__(self) -> None:
        t, directions = len(self.names), np.shape(self.at)[-1] if np.size(self.at) else 2
        if not np.size(self.anchor_block):
            object.__setattr__(self, "anchor_block", np.full(t, GROUND))
        for name in ("body", "anchor_body", "anchor_block"):
            keep_array(self, name, (t,), kind=np.int64)
        for name in ("at", "anchor_at"):
            keep_array(self, name, (t, directions))
        require_others(self, "anchor_body")
        self._keep_law()
        if not ((self.law["push"] == 0) | (self.law["push"] == self.law["strength"])).all():
            raise ValueError("push of the links is neither zero nor the strength")
        if not np.isfinite(self.law["reach"][self.law["k"] > 0]).all():
            raise ValueError("reach of the links is infinite for a link with a spring; give it a length")

    def _keep_law(self) -> None:
        """Check the laws and keep them as rows. A number may be infinite if its default is."""
        argument = self.law if np.size(self.law) else [LinkLaw()] * len(self.names)
        try:
            laws = argument if isinstance(argument, np.recarray) else [LinkLaw(*law) for law in argument]
            rows = np.array(laws, dtype=LAW)
        except (TypeError, ValueError, OverflowError):
            raise TypeError(f"law of the links = {shown(argument)} does not hold a LinkLaw for each") from None
        object.__setattr__(self, "law", frozen(rows).view(np.recarray))
        if self.law.shape != (len(self.names),):
            raise ValueError(f"law of the links has the shape {self.law.shape}; {(len(self.names),)} is needed")
        for name, usual in LinkLaw._field_defaults.items():
            above, infinite = (0.0 if name in ("reach", "strength") else None), usual == math.inf
            require_values(f"{name} of the links", self.law[name], above, 0.0, infinite)

    def chosen(self, flags: Flags) -> Links:
        """Some of the links."""
        if flags.all():
            return self
        numbers = np.flatnonzero(flags)
        arrays = (entry.name for entry in fields(self) if entry.name not in ("names", "user_laws"))
        user_laws = tuple(self.user_laws[i] for i in numbers) if self.user_laws else ()
        return Links(
            names=tuple(self.names[i] for i in numbers),
            user_laws=user_laws,
            **{name: getattr(self, name)[numbers] for name in arrays},
        )

    @cached_property
    def owned(self) -> Links:
        """The links with a law of their own."""
        return self.chosen(self.are_owned)

    @cached_property
    def are_owned(self) -> Flags:
        """Which links have a law of their own, shape (t,)."""
        return np.array([law is not None for law in self.user_laws or (None,) * len(self.names)], dtype=bool)

    @cached_property
    def sprung(self) -> Links:
        """The links with a spring."""
        return self.chosen(self.law["k"] > 0)

    @cached_property
    def bearing(self) -> Links:
        """The links that may have a force at rest: those with a spring that only pulls, or a law of their own."""
        return self.chosen((self.law["k"] > 0) & (self.law["push"] == 0) | self.are_owned)

    @cached_property
    def damped(self) -> Links:
        """The links with a dashpot, and those without a spring and a law of their own."""
        damps = np.array([LinkLaw(*law).damps for law in self.law], dtype=bool)
        return self.chosen((damps | (self.law["k"] == 0)) & ~self.are_owned)


@dataclass(frozen=True, eq=False)
class ConstantForces:
    """Forces that keep size and direction and follow their points.

    Args:
        names: names of the f forces.
        body, at: the body that each acts on, and where, from its centroid [m], shapes (f,) and (f, d).
        force: its components [N], shape (f, d).
    """

    names: tuple[str, ...] = ()
    body: Integers = field(default_factory=_empty_array)
    at: Array = field(default_factory=_empty_array)
    force: Array = field(default_factory=_empty_array)

    def __post_init__(self) -> None:
        f, directions = len(self.names), np.shape(self.at)[-1] if np.size(self.at) else 2
        keep_array(self, "body", (f,), kind=np.int64)
        for name in ("at", "force"):
            keep_array(self, name, (f, directions))


class JointSprings(NamedTuple):
    """Properties of the joints per area, in the order of their names, shape (joints,) each.

    Args:
        k_n, k_s: stiffness along the normal and along the face [N/m3], k_s infinite where the joint sticks rigidly.
        retardation: dashpot over spring, c/k [s].
        friction: coefficient [-].
        residual: the same of a joint that has lost its bond [-].
        points: contact lines of a joint of the plane, and of each side of a joint in space.
        pairs: what all blocks without a common joint have where they meet, or a function of the numbers of two that
            gives it, or None where their joints say it; None where nothing is given.
    """

    k_n: Array
    k_s: Array
    retardation: Array
    friction: Array
    residual: Array
    points: Integers
    pairs: PairProperties | Callable[[int, int], PairProperties | None] | None = None

    def of_pair(self, one: int, other: int) -> PairProperties | None:
        """What two blocks without a joint have where they meet, by their numbers, or None where nothing is given."""
        return self.pairs(one, other) if callable(self.pairs) else self.pairs


@dataclass(frozen=True)
class Limits:
    """How far a run follows its bodies.

    Args:
        reach, overlap: largest gap and deepest penetration of a contact that a run follows [m]; beyond them a body has
            gone too far.
        damped_joints: whether the dashpots of contacts that bear weight matter in long steps too, as those between flat
            blocks do; see `mjrock.engine.step_control`.
    """

    reach: float = math.inf
    overlap: float = math.inf
    damped_joints: bool = False


def attachments(
    effects: Sequence[Effect], number: Integers, place: Callable[[Effect], Sequence[float]], centroids: Array
) -> tuple[Links, ConstantForces]:
    """The links and the constant forces that effects bring.

    Args:
        effects: the effects.
        number: of each block among the bodies, GROUND for one that is fixed.
        place: where an effect acts, from the origin of the world, at rest [m].
        centroids: of the bodies at rest [m], shape (bodies, d).
    """
    links, forces, d = link_effects(effects), constant_forces_of(effects), centroids.shape[1]

    def places_of(acting: Collection[Effect]) -> tuple[Integers, Array, Array]:
        bodies = number[[effect.block for effect in acting]]
        points = np.array([place(effect) for effect in acting])
        return bodies, points, points - centroids[bodies]

    pulled, pushed = Links(), ConstantForces()
    if links:
        bodies, points, at = places_of(links.values())
        blocks = np.array([GROUND if link.anchor_block is None else link.anchor_block for link in links.values()])
        others = np.where(blocks == GROUND, GROUND, number[blocks])
        ends = np.array([link.anchor_of(point) for link, point in zip(links.values(), points, strict=True)])
        ends = ends - np.where(others[:, None] == GROUND, 0.0, centroids[others])
        laws = np.array([link.law for link in links.values()], dtype=LAW)
        user_laws = tuple(link.user_law for link in links.values())
        pulled = Links(tuple(links), bodies, at, others, ends, laws, blocks, user_laws if any(user_laws) else ())
    if forces:
        bodies, _, at = places_of([effect for effect, _ in forces.values()])
        vectors = np.array([force for _, force in forces.values()])
        pushed = ConstantForces(tuple(forces), bodies, at, vectors if d == 3 else vectors[:, ::2])
    return pulled, pushed
