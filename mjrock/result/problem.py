"""What a solver asks of a problem: a wall on its contacts, or masonry, which has joints of its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from ..method import METHOD, Method
from ..problem.damping.contacts import Contacts
from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.wall.case import Case
from ..quantities import Array, require_kind, shown
from ..scene.course import Course
from ..scene.masonry import masonry_course, masonry_scene
from ..scene.scene import Scene
from ..scene.wall import wall_course, wall_scene
from .ledger import Ledger
from .motion import Motion, SampledMotion
from .reading import BesidePoses, Reading, masonry_reading, wall_reading

RESIDUAL_OF_WALL = 0.05
"""Error of the balance of a wall above which there is a warning, over the energy of the release and of the
ground motion [-]."""
UNPAID = 0.01
"""Error of the balance of masonry above which there is a warning, over the largest part of the ledger [-]."""


class Unpaid(NamedTuple):
    """Energy without an account [J], what it is compared with [J], in words, and the share from which it is said."""

    energy: float
    whole: float
    said: str
    share: float


class Problem(Protocol):
    """A case with what stands in it, what happens to it, and what is read from its motion."""

    @property
    def case(self) -> AnyCase:
        """What was asked."""

    def scene(self, method: Method = METHOD) -> Scene:
        """What stands; ValueError if the contacts do not fit the case, or what stands in it falls under its weight."""

    def course(self, scene: Scene) -> Course:
        """What happens to the scene."""

    def read(
        self, scene: Scene, t: Array, motion: SampledMotion, *, released: bool, beside: BesidePoses | None = None
    ) -> Reading:
        """What a motion says; `released` and `beside` are as in `wall_reading` and `masonry_reading`."""

    def unpaid(self, ledger: Ledger, motion: Motion, scale: float) -> Unpaid:
        """Error of the balance of a ledger [J]."""


@dataclass(frozen=True)
class WallProblem:
    """A wall on its contacts, see `Problem`."""

    case: Case
    contacts: Contacts

    def scene(self, method: Method = METHOD) -> Scene:
        """The wall against its base and its side stop."""
        return wall_scene(self.case, self.contacts, method)

    def course(self, scene: Scene) -> Course:
        """Its release, and the motion of its base."""
        return wall_course(self.case, scene)

    def read(
        self, scene: Scene, t: Array, motion: SampledMotion, *, released: bool, beside: BesidePoses | None = None
    ) -> Reading:
        """Impacts and peaks."""
        return wall_reading(self.case, self.contacts, t, motion, released=released)

    def unpaid(self, ledger: Ledger, motion: Motion, scale: float) -> Unpaid:
        """Energy that has appeared while the wall could still come back."""
        unpaid = ledger.residual[self.case.returns_from(motion.theta[:, 0])].max(initial=0.0)
        return Unpaid(float(unpaid), scale, "the energy there was", RESIDUAL_OF_WALL)


@dataclass(frozen=True)
class MasonryProblem:
    """Masonry, see `Problem`."""

    case: MasonryCase

    def scene(self, method: Method = METHOD) -> Scene:
        """The blocks on their joints."""
        return masonry_scene(self.case)

    def course(self, scene: Scene) -> Course:
        """Its start from rest, and the motion of the ground."""
        return masonry_course(self.case, scene)

    def read(
        self, scene: Scene, t: Array, motion: SampledMotion, *, released: bool, beside: BesidePoses | None = None
    ) -> Reading:
        """Openings, slidings and falls."""
        return masonry_reading(self.case, scene, t, motion, beside)

    def unpaid(self, ledger: Ledger, motion: Motion, scale: float) -> Unpaid:
        """Energy that has appeared or vanished."""
        return Unpaid(float(np.abs(ledger.residual).max()), ledger.largest, "its largest part", UNPAID)


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
        ValueError: if the contacts do not fit the case, or what stands in it falls under its weight.
    """
    return problem_of(case, contacts).scene(method)
