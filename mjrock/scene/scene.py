"""The scene: one flat description of what stands, for any number of bodies.

Everything lies in a plane, x horizontal and z upwards, or stands in space, with y along the facade. Vectors have d = 2
or 3 numbers, poses of a body nq = 3 or 7, and velocities nv = 3 or 6, see `mjrock.geometry.frames`. At rest no body is
turned, so that a vector in the frame of a body is the same in the world. Contact points on one body meet plane faces of
another body or of the ground. The model text, the steps, the energy ledger and the result all follow from this
description. What happens to it is its `Course`.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from ..geometry.frames import PLANE, SPACE, Freedom
from ..geometry.kinematics import Forces, Places, Ties, gaps
from ..quantities import Array, Flags, Integers, frozen
from .arrays import checked, nothing
from .dampers import Dampers
from .equilibrium import lowered, settled
from .frequencies import highest_frequency, rocking_frequency, tie_frequency
from .masses import mass_diagonals, principal, products_of
from .names import face_names, point_names
from .potential import Potential
from .rest_in_space import settled_in_space
from .structure import Structure, energies

RADIUS = 1e-6
"""Radius of the contact spheres, over the largest extent of a body from its centroid [-]. Friction acts at their
surface, which is why it is tiny."""


@dataclass(frozen=True, eq=False)
class Scene:
    """Rigid bodies in a plane or in space, and the compliant contacts between them and with the ground.

    Args:
        names: names of the n bodies.
        mass: masses [kg], shape (n,).
        inertia: moments of inertia about the centroids [kg m2], shape (n,), and in space the tensors, shape (n, 3, 3).
        rest: positions of the centroids at rest, the contacts undeformed [m], shape (n, d). It says whether the scene
            is one of the plane or of space.
        outlines: vertices of each body about its centroid, for pictures [m], n arrays of shape (vertices, d).
        length: length out of the plane, for pictures [m]. It makes no difference in space.
        point_body: the body that carries each of the m contact points, shape (m,).
        point: position of each point from the centroid of its body [m], shape (m, d).
        face_body: the body whose face each point meets, or GROUND, shape (m,).
        face: a point of that face, from the centroid of its body or from the origin of the world [m], shape (m, d).
        normal: unit vector out of that face, shape (m, d).
        k, c: spring [N/m] and dashpot [N s/m] of each contact, shape (m,).
        friction: coefficient of friction of each contact, zero for none [-], shape (m,).
        holds: which contacts stand for a base that holds, shape (m,), or one answer for all. Their coefficient of
            friction is a number that holds it, and no law of sliding.
        group: name of the group that each contact belongs to. Its points are numbered in the model, and the ledger has
            an account for each group.
        tie_names: names of the t ties, which pull and never push.
        tie_body, tie_point: the body that each tie holds, and where, from its centroid [m], shapes (t,) and (t, d).
        anchor_body, anchor: the body of the other end, or GROUND, and the end, as for a face, shapes (t,) and (t, d).
        tie_k: stiffness of each tie [N/m], shape (t,).
        tie_length: length up to which it is slack [m], shape (t,).
        tie_strength: force at which it yields [N], infinite for one that does not, shape (t,).
        tie_ultimate: plastic elongation at which it breaks [m], shape (t,); infinite, or nothing, where none does.
        damper_names: names of the viscous dampers.
        damper_body, damper_point, damper_anchor_body, damper_anchor: as of ties.
        damper_c: damping coefficient of each [N s/m], shape (dampers,).
        force_names: names of the f constant forces. They keep their direction and follow their points.
        force_body, force_point: the body that each force acts on, and where, from its centroid [m], (f,) and (f, d).
        force: its components [N], shape (f, d).
        settled: pose of the bodies at rest under their weight, shape (n, nq). None searches for it.
        reach, overlap: largest gap and deepest penetration of a contact that a run follows [m]; beyond them a body has
            gone too far.
        damped_joints: whether the dashpots of contacts that bear weight matter in long steps too, as those between flat
            blocks do; see `mjrock.engine.pace`.
        title: what the scene is, in words, for the model text.
        facts: numbers and texts that the model records.

    Raises:
        ValueError: for an array of another shape, an invalid value, or bodies that do not stand.
    """

    names: tuple[str, ...]
    mass: Array
    inertia: Array
    rest: Array
    outlines: tuple[Array, ...]
    length: float
    point_body: Integers
    point: Array
    face_body: Integers
    face: Array
    normal: Array
    k: Array
    c: Array
    friction: Array
    group: tuple[str, ...]
    holds: Flags | bool = False
    tie_names: tuple[str, ...] = ()
    tie_body: Integers = field(default_factory=nothing)
    tie_point: Array = field(default_factory=nothing)
    anchor_body: Integers = field(default_factory=nothing)
    anchor: Array = field(default_factory=nothing)
    tie_k: Array = field(default_factory=nothing)
    tie_length: Array = field(default_factory=nothing)
    tie_strength: Array = field(default_factory=nothing)
    tie_ultimate: Array = field(default_factory=nothing)
    damper_names: tuple[str, ...] = ()
    damper_body: Integers = field(default_factory=nothing)
    damper_point: Array = field(default_factory=nothing)
    damper_anchor_body: Integers = field(default_factory=nothing)
    damper_anchor: Array = field(default_factory=nothing)
    damper_c: Array = field(default_factory=nothing)
    force_names: tuple[str, ...] = ()
    force_body: Integers = field(default_factory=nothing)
    force_point: Array = field(default_factory=nothing)
    force: Array = field(default_factory=nothing)
    settled: Array | None = None
    reach: float = math.inf
    overlap: float = math.inf
    damped_joints: bool = False
    title: str = "Rigid bodies on compliant contacts"
    facts: Mapping[str, float | str] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<Scene of {len(self.names)} bodies, {len(self.k)} contacts, {len(self.tie_names)} ties>"

    def __post_init__(self) -> None:
        if not np.size(self.tie_ultimate):
            object.__setattr__(self, "tie_ultimate", np.full(len(self.tie_names), math.inf))
        for name, values in checked(vars(self)).items():
            object.__setattr__(self, name, values)
        object.__setattr__(self, "holds", frozen(np.broadcast_to(np.array(self.holds, dtype=bool), self.k.shape)))
        if self.settled is not None:
            pose = np.reshape(np.asarray(self.settled, dtype=float), (len(self.names), self.freedom.nq))
            object.__setattr__(self, "settled", frozen(pose))

    @property
    def freedom(self) -> Freedom:
        """How the bodies may move: in the plane or in space."""
        return PLANE if self.rest.shape[1] == 2 else SPACE

    def lowered(self, pose: Array) -> Array:
        """A pose lowered until the springs of the ground carry the weight of all bodies, shape (n, nq)."""
        return lowered(self.places, self.k, self.forces, self.masses, pose)

    @cached_property
    def extent(self) -> float:
        """The largest coordinate of a vertex from the centroid of its body [m]."""
        return max(float(np.abs(outline).max()) for outline in self.outlines)

    @property
    def radius(self) -> float:
        """Radius of the spheres that stand for the contact points in MuJoCo [m]."""
        return RADIUS * self.extent

    @cached_property
    def point_names(self) -> tuple[str, ...]:
        """Name of each contact point: its group and its number in it."""
        return point_names(self.group)

    @cached_property
    def face_names(self) -> tuple[str, ...]:
        """Name of the face that each point meets: its group, with a number where the points of a group meet several."""
        return face_names(self.group, self.face_body, self.face, self.normal)

    @cached_property
    def masses(self) -> Array:
        """Generalised masses: m, m, I of each body, and in space m, m, m, Ixx, Iyy, Izz, shape (n nv,)."""
        return frozen(mass_diagonals(self.mass, self.inertia))

    @cached_property
    def products(self) -> Array:
        """Products of inertia of the bodies of space [kg m2], see `mjrock.scene.masses`, shape (n, 3), else (0, 3)."""
        return frozen(products_of(self.inertia))

    @cached_property
    def principal(self) -> tuple[csr_array, Array]:
        """Velocities of the bodies along their principal axes, and the masses of each, see `masses.principal`."""
        return principal(self.mass, self.inertia)

    @cached_property
    def places(self) -> Places:
        """The contacts for the compiled functions."""
        return Places(
            axes=self.freedom.axes,
            body=self.point_body,
            at=self.point,
            face_body=self.face_body,
            face_at=self.face,
            normal=self.normal,
            between=self._between(self.point_body, self.point, self.face_body, self.face),
            radius=self.radius,
        )

    def _between(self, body: Integers, at: Array, other: Integers, start: Array) -> Array:
        """Vectors at rest from points of other bodies or of the ground to points of bodies [m]."""
        return frozen(self.rest[body] + at - np.where(other[:, None] < 0, 0.0, self.rest[other]) - start)

    @cached_property
    def ties(self) -> Ties:
        """The ties for the compiled functions."""
        return Ties(
            body=self.tie_body,
            at=self.tie_point,
            anchor_body=self.anchor_body,
            anchor_at=self.anchor,
            between=self._between(self.tie_body, self.tie_point, self.anchor_body, self.anchor),
            k=self.tie_k,
            reach=self.tie_length,
            stretch=frozen(self.tie_strength / self.tie_k),
            limit=frozen(self.tie_length + self.tie_strength / self.tie_k + self.tie_ultimate),
        )

    @cached_property
    def dampers(self) -> Dampers:
        """The dampers for the compiled functions."""
        anchored = self.damper_anchor_body, self.damper_anchor
        between = self._between(self.damper_body, self.damper_point, *anchored)
        return Dampers(self.damper_body, self.damper_point, *anchored, between, self.damper_c)

    @cached_property
    def forces(self) -> Forces:
        """The constant forces for the compiled functions."""
        return Forces(self.force_body, self.force_point, self.force)

    @cached_property
    def structure(self) -> Structure:
        """What has energy, for the compiled functions."""
        return Structure(self.places, self.k, self.ties, self.forces, self.masses, self.products)

    @cached_property
    def potential(self) -> Potential:
        """The energy of springs, weight and constant forces as a function of the pose."""
        return Potential(self.structure)

    @cached_property
    def at_rest(self) -> Array:
        """Pose of the bodies at rest under their weight, shape (n, nq)."""
        if self.settled is not None:
            return self.settled
        return self.rest_in_space[0] if self.freedom == SPACE else settled(self.potential, self.friction)

    @cached_property
    def rest_in_space(self) -> tuple[Array, Array]:
        """Pose of bodies of space at rest, shape (n, 7), and the friction that holds them there, shape (m, 2) [N]."""
        return settled_in_space(self.potential, self.friction)

    @cached_property
    def bears(self) -> Array:
        """Penetration of each contact at rest [m], zero where it is open, shape (m,)."""
        return frozen(np.maximum(-gaps(self.places, self.at_rest.reshape(1, -1).copy())[0], 0))

    @cached_property
    def rest_energies(self) -> Array:
        """Kinetic, potential and elastic energy of the scene at rest [J], shape (3,)."""
        return self.accounts(self.at_rest.reshape(1, -1).copy(), np.zeros((1, len(self.masses))))[0][0]

    def accounts(self, q: Array, v: Array, broken: Integers | None = None) -> tuple[Array, Array]:
        """Kinetic, potential and elastic energy, and what ties have taken, see `structure.energies`."""
        return energies(self.structure, q, v, broken)

    def energy(self, pose: Array, velocity: Array) -> Array:
        """Energy above the scene at rest [J], shape (steps,), of poses (steps, n, nq) and velocities (steps, n, nv)."""
        flat = (len(pose), -1)
        parts, _ = self.accounts(np.reshape(pose, flat), np.reshape(velocity, flat))
        return np.asarray(parts.sum(axis=1) - self.rest_energies.sum())

    @cached_property
    def highest_frequency(self) -> float:
        """The highest natural frequency with every contact closed and free to slide [rad/s]."""
        return highest_frequency(self.potential, self.principal)

    @cached_property
    def tie_frequency(self) -> float:
        """The highest natural frequency of the bodies on one tie alone [rad/s], zero without ties."""
        return tie_frequency(self.potential, self.principal)

    @cached_property
    def rocking_frequency(self) -> float:
        """The largest p = sqrt(m g R / (I + m R^2)) of the bodies [rad/s], R to the farthest point of each."""
        return rocking_frequency(self.mass, self.inertia, self.outlines)

    @cached_property
    def key(self) -> str:
        """A digest of all that has to be compiled.

        Springs and dashpots are set with each step, and limits, titles and facts move nothing.
        """
        set_anew = {"k", "c", "settled", "reach", "overlap", "damped_joints", "title", "facts"}
        digest = hashlib.sha256()
        for name in (entry.name for entry in fields(self) if entry.name not in set_anew):
            parts = getattr(self, name) if name == "outlines" else (getattr(self, name),)
            digest.update(b"".join(p.tobytes() if isinstance(p, np.ndarray) else repr(p).encode() for p in parts))
        return digest.hexdigest()
