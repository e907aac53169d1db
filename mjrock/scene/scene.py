"""The scene: one flat description of a structure, for any number of bodies.

Everything lies in a plane, x horizontal and z upwards, or stands in space, with y along the facade. Vectors have d = 2
or 3 numbers, poses of a body nq = 3 or 7, and velocities nv = 3 or 6, see `mjrock.geometry.frames`. At rest no body is
turned, so that a vector in the frame of a body is the same in the world. Contact points on one body meet plane faces of
another body or of the ground. The model text, the steps, the energy ledger and the result all follow from this
description. What happens to it is its `Course`.
"""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property

import numpy as np

from ..geometry.frames import Freedom, frames_of
from ..geometry.kinematics import AppliedForces, LinkEnds, Places, Ties, ends, gaps
from ..problem.masonry.laws.own_law import OwnSprings
from ..problem.wall.rest_geometry import RestGeometry
from ..quantities import GRAVITY, Array, Integers, frozen
from .dampers import Dampers
from .masses import kinetic_energies
from .parts import Bodies, ConstantForces, ContactPoints, JointSprings, Limits, Links, require_on
from .potential import Potential, Structure, energies, highest_frequency, rocking_frequency, tie_frequency
from .rest import RestState, lowered, settled

RADIUS = 1e-6
"""Radius of the contact spheres, over the largest extent of a body from its centroid [-]. Friction acts at their
surface, which is why it is tiny."""
GAP_ROUNDING = 64 * np.finfo(float).eps
"""Rounding of the gap between a point and its face as drawn, over the largest coordinate [-]."""


@dataclass(frozen=True, eq=False)
class Scene:
    """Rigid bodies in a plane or in space, and the compliant contacts between them and with the ground.

    Args:
        bodies: the bodies.
        contacts: the contacts.
        links: ties, dampers and what else links a point of a body with an anchor.
        forces: the constant forces.
        settled: pose of the bodies at rest under their weight, shape (n, nq). None searches for it.
        limits: how far a run follows the bodies.
        title: what the scene is, in words, for the model text.
        facts: numbers and texts that the model records.
        made_of: solids and joints of the bodies and of what they stand on; None of a scene that is written by hand.
        springs: what the joints of masonry are made of, or None.

    Raises:
        ValueError: for parts that do not fit the bodies, two things of one name, or bodies that do not stand.
    """

    bodies: Bodies
    contacts: ContactPoints
    links: Links = field(default_factory=Links)
    forces: ConstantForces = field(default_factory=ConstantForces)
    settled: Array | None = None
    limits: Limits = field(default_factory=Limits)
    title: str = "Rigid bodies on compliant contacts"
    facts: Mapping[str, float | str] = field(default_factory=dict)
    made_of: RestGeometry | None = None
    springs: JointSprings | None = None

    def __repr__(self) -> str:
        parts = len(self.bodies.names), len(self.contacts.k), len(self.links.names)
        return "<Scene of {} bodies, {} contacts, {} links>".format(*parts)

    def __post_init__(self) -> None:
        require_on(self.bodies, (self.contacts, self.links, self.forces))
        names = (*self.bodies.names, *self.contacts.joints, *self.links.names, *self.forces.names)
        for name, number in Counter(names).items():
            if number > 1:
                raise ValueError(
                    f"{name} names two things of the scene; bodies, joints, links and forces need names of their own"
                )
        if self.settled is not None:
            pose = np.reshape(np.asarray(self.settled, dtype=float), (len(self.bodies.names), self.freedom.nq))
            object.__setattr__(self, "settled", frozen(pose))

    @property
    def freedom(self) -> Freedom:
        """How the bodies may move: in the plane or in space."""
        return self.bodies.freedom

    @property
    def rest_geometry(self) -> RestGeometry:
        """Solids and joints of the bodies and of what they stand on.

        Raises:
            ValueError: for a scene that is written by hand, which has none.
        """
        if self.made_of is None:
            raise ValueError("the scene is written by hand and has no solids; give made_of, or take scene_of(case)")
        return self.made_of

    @property
    def radius(self) -> float:
        """Radius of the spheres that stand for the contact points in MuJoCo [m]."""
        return RADIUS * self.bodies.extent

    def lowered(self, pose: Array) -> Array:
        """A pose lowered until the springs of the ground carry the weight of all bodies, shape (n, nq)."""
        return lowered(self.potential.structure, pose)

    @cached_property
    def places(self) -> Places:
        """The contacts for the compiled functions. A gap at rest that is the rounding of coordinates is none."""
        points = self.contacts
        between = self.bodies.between(points.body, points.at, points.face_body, points.face_at)
        gap = (points.normal * between).sum(axis=1)
        rounding = GAP_ROUNDING * float(np.abs(self.bodies.rest).max() + self.bodies.extent)
        between = frozen(between - np.where(np.abs(gap) < rounding, gap, 0.0)[:, None] * points.normal)
        columns = {name: getattr(points, name) for name in Places._fields if hasattr(points, name)}
        return Places(axes=self.freedom.axes, between=between, radius=self.radius, **columns)

    @cached_property
    def sense(self) -> Array:
        """1 where the body of a contact is above its joint, -1 where it is below, shape (m,)."""
        above = self.rest_geometry.frames.above[self.contacts.joint]
        return frozen(np.where(above == self.contacts.body, 1.0, -1.0))

    @cached_property
    def ties(self) -> Ties:
        """The links with a spring, for the compiled functions. Those that also push bear nothing at rest."""
        ties = self._drawn_ties(self.links.sprung)
        if not (ties.squeeze > 0).any():
            return ties
        frames = frames_of(self.at_rest.ravel(), self.freedom)
        lengths = [math.hypot(*ends(ties.links, i, frames).span) for i in range(len(ties.k))]
        return ties._replace(reach=frozen(np.where(ties.squeeze > 0, lengths, ties.reach)))

    def _drawn_ties(self, links: Links) -> Ties:
        """Links with a spring, as they are drawn. An own law answers beyond the length that it has there."""
        ends, owned = self._ends_of(links), links.are_owned
        k, reach = links.law["k"], links.law["reach"]
        if owned.any():
            k, reach = np.where(owned, 1.0, k), np.where(owned, np.linalg.norm(ends.between, axis=1), reach)
        k, reach = frozen(k), frozen(reach)
        stretch, squeeze = frozen(links.law["strength"] / k), frozen(links.law["push"] / k)
        return Ties(ends, k, reach, stretch, frozen(reach + stretch + links.law["ultimate"]), squeeze)

    def _ends_of(self, links: Links) -> LinkEnds:
        """The ends of links."""
        places = links.body, links.at, links.anchor_body, links.anchor_at
        return LinkEnds(self.freedom.axes, *places, self.bodies.between(*places))

    @cached_property
    def dampers(self) -> Dampers:
        """The links with a dashpot, for the compiled functions."""
        return Dampers(self._ends_of(self.links.damped), self.links.damped.law)

    @cached_property
    def structure(self) -> Structure:
        """What has energy, for the compiled functions."""
        return self.potential.structure._replace(ties=self.ties)

    @cached_property
    def potential(self) -> Potential:
        """The energy of all that may have a force at rest, as a function of the pose."""
        axes, forces = self.freedom.axes, self.forces
        vectors = (values.reshape(-1, len(axes)) for values in (forces.at, forces.force))
        bearing = self.links.bearing
        structure = Structure(
            self.places,
            self._drawn_ties(bearing),
            AppliedForces(axes, forces.body, *vectors),
            self.bodies.masses,
            self.bodies.products,
        )
        points, weight = self.contacts, GRAVITY * float(self.bodies.mass.sum())
        laws = OwnSprings.from_joints(points.bonds, points.joint, np.asarray(points.area), weight)
        owned = np.flatnonzero(bearing.are_owned)
        user_laws = tuple(law for law in bearing.user_laws if law is not None)
        return Potential(structure, laws.and_links(len(points.k) + owned, user_laws))

    @cached_property
    def at_rest(self) -> Array:
        """Pose of the bodies at rest under their weight, shape (n, nq)."""
        return self.rest_state.pose if self.settled is None else self.settled

    @cached_property
    def rest_state(self) -> RestState:
        """The pose of rest that the search finds, and the friction that holds the bodies there, see `rest.settled`."""
        return settled(self.potential, np.asarray(self.contacts.k_s))

    @cached_property
    def bears(self) -> Array:
        """Penetration of each contact at rest [m], zero where it is open, shape (m,)."""
        return frozen(np.maximum(-gaps(self.places, self.at_rest.reshape(1, -1).copy())[0], 0))

    @cached_property
    def rest_energies(self) -> Array:
        """Kinetic, potential and elastic energy of the scene at rest [J], shape (3,)."""
        return self.accounts(self.at_rest.reshape(1, -1).copy(), np.zeros((1, len(self.bodies.masses))))[0][0]

    def accounts(self, q: Array, v: Array, broken: Integers | None = None) -> tuple[Array, Array]:
        """Kinetic, potential and elastic energy, and what ties have dissipated, see `potential.energies`."""
        return energies(self.structure, q, v, broken)

    def energy(self, pose: Array, velocity: Array) -> Array:
        """Energy above the scene at rest [J], shape (steps,), of poses (steps, n, nq) and velocities (steps, n, nv)."""
        flat = (len(pose), -1)
        parts, _ = self.accounts(np.reshape(pose, flat), np.reshape(velocity, flat))
        return np.asarray(parts.sum(axis=1) - self.rest_energies.sum())

    @cached_property
    def highest_frequency(self) -> float:
        """The highest natural frequency with every contact closed and free to slide [rad/s]."""
        return highest_frequency(Potential(self.structure), self.bodies.principal)

    @cached_property
    def tie_frequency(self) -> float:
        """The highest natural frequency of the bodies on one tie alone [rad/s], zero without ties."""
        return tie_frequency(Potential(self.structure), self.bodies.principal)

    @cached_property
    def rocking_frequency(self) -> float:
        """The largest p = sqrt(m g R / (I + m R^2)) of the bodies [rad/s], R to the farthest point of each."""
        return rocking_frequency(self.bodies.mass, self.bodies.inertia, self.bodies.outlines)

    @cached_property
    def key(self) -> str:
        """A digest of all that has to be compiled.

        Springs and dashpots of contacts are set with each step, and limits, titles and facts move nothing.
        """
        digest = hashlib.sha256()
        for part in (self.bodies, self.contacts, self.links, self.forces):
            for entry in fields(part):
                values = getattr(part, entry.name)
                if part is self.contacts and entry.name in ("k", "c", "k_s", "area", "bonds", "further"):
                    continue
                if entry.name == "parts":
                    values = tuple(part for of_body in values.values() for part in of_body)
                for value in values if entry.name in ("outlines", "parts") else (values,):
                    digest.update(value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode())
        if (self.links.law["push"] > 0).any():
            digest.update(self.ties.reach.tobytes())
        return digest.hexdigest()


def liveliness(scene: Scene, velocity: Array) -> float:
    """Largest kinetic energy of a block over its share, by mass, of the elastic energy at rest [-].

    A block with more than its share can open a joint. Velocities have the shape (bodies, nv).
    """
    springs, bodies = float(scene.rest_energies[2]), scene.bodies
    moving = kinetic_energies(bodies.masses, bodies.products, velocity) / bodies.mass
    return float(moving.max() * bodies.mass.sum() / springs) if springs > 0 else float("inf")
