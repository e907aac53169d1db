"""Problems that solvers take: a wall on its contacts, or masonry, which has its own joints; and the start of a run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..geometry.frames import PLANE, SPACE
from ..method import METHOD, Method
from ..problem.damping.contacts import Contacts
from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.wall.case import Case
from ..quantities import Array, declared, require_array, require_kind, require_within, shown
from ..scene.course import Course
from ..scene.masonry import masonry_course, masonry_scene
from ..scene.scene import Scene
from ..scene.wall import wall_course, wall_scene
from .ledger import Ledger
from .motion import Motion, SampledMotion
from .reading import ContactHistory, Reading, masonry_reading, wall_reading
from .response import End, State

RESIDUAL_OF_WALL = 0.05
"""Error of the balance of a wall above which there is a warning, over the energy of the release and of the
ground motion [-]."""
UNPAID = 0.01
"""Error of the balance of masonry above which there is a warning, over the largest part of the ledger [-]."""

NUMBERS_IN_TEXT = {"k", "reach", "strength", "push", "c"}
"""The numbers of a `LinkLaw` that the text of a model has."""
PARTS = ("pose", "velocity")
UNIT_ROUNDING = 1e-6
"""Largest difference of the length of a quaternion from one [-]."""


class EnergyImbalance(NamedTuple):
    """Energy without an account.

    Args:
        energy: that energy [J].
        whole, label: the energy that it is compared with [J], and its name.
        share: the share of it above which there is a warning [-].
    """

    energy: float
    whole: float
    label: str
    share: float


@dataclass(frozen=True)
class WallProblem:
    """A wall on its contacts, what happens to it, and what is read from its motion."""

    case: Case
    contacts: Contacts

    def scene(self, method: Method = METHOD) -> Scene:
        """The wall against its base and its side stop.

        Raises:
            ValueError: for contacts that do not fit the case.
        """
        return wall_scene(self.case, self.contacts, method)

    def course(self, scene: Scene) -> Course:
        """Its release, and the motion of its base."""
        return wall_course(self.case, scene)

    def read(
        self, scene: Scene, t: Array, motion: SampledMotion, *, released: bool, history: ContactHistory | None = None
    ) -> Reading:
        """Impacts and peaks, see `wall_reading`."""
        return wall_reading(self.case, self.contacts, t, motion, released=released)

    def unpaid(self, ledger: Ledger, motion: Motion, scale: float) -> EnergyImbalance:
        """Energy [J] that has appeared while the wall could still come back."""
        unpaid = ledger.residual[self.case.returns_from(motion.theta[:, 0])].max(initial=0.0)
        return EnergyImbalance(float(unpaid), scale, "the energy there was", RESIDUAL_OF_WALL)


@dataclass(frozen=True)
class MasonryProblem:
    """Masonry, as a `WallProblem` is of a wall."""

    case: MasonryCase

    def scene(self, method: Method = METHOD) -> Scene:
        """The blocks on their joints.

        Raises:
            ValueError: if they fall under their weight.
        """
        return masonry_scene(self.case)

    def course(self, scene: Scene) -> Course:
        """Its start from rest, and the motion of the ground."""
        return masonry_course(self.case, scene)

    def read(
        self, scene: Scene, t: Array, motion: SampledMotion, *, released: bool, history: ContactHistory | None = None
    ) -> Reading:
        """Openings, slidings and falls, see `masonry_reading`."""
        return masonry_reading(self.case, scene, t, motion, history)

    def unpaid(self, ledger: Ledger, motion: Motion, scale: float) -> EnergyImbalance:
        """Energy [J] that has appeared or vanished."""
        return EnergyImbalance(float(np.abs(ledger.residual).max()), ledger.largest, "its largest part", UNPAID)


Problem = WallProblem | MasonryProblem
"""A case with its structure, what happens to it, and what is read from its motion."""


def problem_of(case: AnyCase, contacts: Contacts | None = None) -> Problem:
    """A wall on its contacts, or masonry, which has joints of its own.

    Raises:
        TypeError: for anything else.
    """
    if isinstance(case, MasonryCase):
        if contacts is not None:
            raise TypeError(f"contacts = {shown(contacts)}: masonry has its joints; leave contacts out")
        return MasonryProblem(case)
    if isinstance(case, Contacts) and contacts is not None:
        raise TypeError("case and contacts are swapped: the case comes first")
    require_kind("case", case, Case, MasonryCase)
    if contacts is None:
        raise TypeError("contacts = None: a wall needs its interfaces; take Contacts.from_law(wall, e, k_base, k_side)")
    require_kind("contacts", contacts, Contacts)
    return WallProblem(case, contacts)


def scene_of(case: AnyCase, contacts: Contacts | None = None, method: Method = METHOD) -> Scene:
    """The scene of a case: a wall on its contacts, or masonry, which has joints of its own.

    Raises:
        ValueError: if the contacts do not fit the case, or its structure falls under its weight.
    """
    return problem_of(case, contacts).scene(method)


def require_known_ties(case: AnyCase) -> None:
    """Raise a ValueError that names a tie of a case that can yield, of which a start does not say how far it has."""
    for name, link in case.links.items():
        if link.user_law is not None and link.user_law.remembers:
            raise ValueError(
                f"start is a pose and a velocity, which do not say what {name} remembers, whose law has a memory; give "
                "solve_explicit the end of explicit steps of the same structure, or follow the case in one run"
            )
        if link.law.yields:
            raise ValueError(
                f"start is a pose and a velocity, which do not say how far {name} has yielded, whose strength is "
                f"{link.law.strength:g} N; give solve_explicit the end of explicit steps of the same structure, or "
                "follow the case in one run"
            )


def required_start(start: object, case: AnyCase, *, remembers: bool = False) -> State:
    """A start as pose and velocity of all bodies, of shape (bodies, 3), in space (bodies, 7) and (bodies, 6), finite.

    Args:
        start: the start.
        case: that starts there.
        remembers: whether what ties have yielded is taken from the memory of explicit steps, if the start has one.

    Raises:
        TypeError: if it is no pose and velocity.
        ValueError: for another shape, a value out of range, ties that yield among the effects, or a block that moves as
            its guide does not allow. A guide takes less than a thousandth of sqrt(g size) from it.
    """
    if not (remembers and isinstance(start, End) and start.memory is not None):
        require_known_ties(case)
    if isinstance(start, End):
        start = tuple(start)
    if not isinstance(start, tuple | list) or len(start) != 2:
        raise TypeError(f"start = {shown(start)} is not a pose and a velocity; take the end of an earlier response")
    bodies, freedom = len(case.bodies), SPACE if case.in_space else PLANE
    pose, velocity = (
        require_array(f"start, {name}", part, (bodies, numbers))
        for name, part, numbers in zip(PARTS, start, (freedom.nq, freedom.nv), strict=True)
    )
    velocity = case.require_start(pose, velocity)
    for name, values in zip(PARTS, (pose, velocity), strict=True):
        require_within(f"start, largest of {name}", float(np.abs(values).max()), 0.0, 1e3)
    if freedom is SPACE:
        size = np.linalg.norm(pose[:, 3:], axis=1)
        for length in size[np.abs(size - 1) > UNIT_ROUNDING].tolist():
            require_within("start, length of a quaternion", length, 1 - UNIT_ROUNDING, 1 + UNIT_ROUNDING)
    return pose, velocity


def require_in_text(case: AnyCase) -> None:
    """Raise ValueError for a link whose law the text of a model, and so a fixed step, cannot describe."""
    for name, link in case.links.items():
        link_type: Callable[..., object] = type(link)
        for number, default in link.law._field_defaults.items():
            if number not in NUMBERS_IN_TEXT and (value := getattr(link.law, number)) != default:
                unit = declared(link_type)[number].within.unit
                raise ValueError(
                    f"a fixed step is the text of a model, which cannot describe the law of each link, and {name} has "
                    f"{number} = {value:g} {unit}; leave timestep out, so that steps fit the motion, or leave {number} "
                    "out"
                )
