"""Masonry in space that stands, and its system at the start of a case."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ...geometry.frames import SPACE
from ...geometry.kinematics import Places
from ...problem.masonry.case import MasonryCase
from ...problem.masonry.masonry import Masonry
from ...problem.wall.effects import Effect
from ...quantities import Array, named
from ...result.response import State
from ...scene.course import Course
from ..following import Setup
from ..limit import SHARE
from ..loop import Clock
from ..system import Books, Samples
from .assembly import copied, masonry_system, started
from .columns import PLACE, QUATERNION, stacked, vectors
from .limit import longest_step
from .loop import advance
from .rest import UnsettledError, settle
from .system import System

GONE = 0.1
"""Displacement of a block that falls in the search for the pose of rest, over the largest of all blocks [-]."""


@dataclass(frozen=True, eq=False)
class Stand:
    """Masonry in space at rest, for explicit steps.

    Args:
        names: of the blocks that are not fixed.
        group: name of the joint of each contact point.
        system: its rows, at rest.
        at_rest: pose at rest, shape (n, 7).
        rest_energies: kinetic, potential and elastic energy at rest [J], shape (3,).
        tie_names, damper_names: what holds it.
        tie_ultimate: plastic elongation at which each tie breaks [m].
    """

    names: tuple[str, ...]
    group: tuple[str, ...]
    system: System
    at_rest: Array
    rest_energies: Array
    tie_names: tuple[str, ...]
    damper_names: tuple[str, ...]
    tie_ultimate: Array

    @property
    def places(self) -> Places:
        """The contact points, for the joints' motion."""
        lines = self.system.lines
        at, origin, normal = (np.ascontiguousarray(vectors(lines, name)) for name in ("at", "origin", "normal"))
        body, face = (np.ascontiguousarray(lines[name]) for name in ("body", "face"))
        return Places(SPACE.axes, body, at, face, origin, normal, np.zeros_like(at), 0.0)


@lru_cache(maxsize=16)
def standing(masonry: Masonry, effects: tuple[Effect, ...] = ()) -> Stand:
    """Masonry in space at rest, which all cases of it with the same effects share.

    Raises:
        ValueError: if it does not stand. The message names the blocks that fall.
    """
    system = masonry_system(masonry)
    names = tuple(masonry.names[i] for i in masonry.free)
    try:
        settle(system)
    except UnsettledError as error:
        far = np.linalg.norm(error.place, axis=1)
        gone = [name for name, way in zip(names, far, strict=True) if way >= GONE * far.max()]
        raise ValueError(
            f"the masonry cannot stand: {named(gone)} would fall under the weight; raise k_n or friction, or support it"
        ) from None
    at_rest = np.column_stack([stacked(system.bodies, PLACE), stacked(system.bodies, QUATERNION)])
    group = tuple(masonry.joints[j].name for j in masonry.lines.joint)
    return Stand(names, group, system, at_rest, energies_of(system), (), (), system.ties["ultimate"])


def energies_of(system: System) -> Array:
    """Kinetic, potential and elastic energy of a system as it is [J], shape (3,)."""
    samples = Samples.of(1, len(system.bodies), 2, SPACE)
    still = copied(system)
    groups = int(still.lines["group"].max(initial=0)) + 1
    advance(still, Books.of(still, groups), samples, Clock(0, 1e-9, 1, 0, 1, math.inf))
    return samples.energy[0]


def setup_in_space(case: MasonryCase, state: State | None) -> Setup:
    """Masonry in space at the start of a case, or in a given state."""
    stand = standing(case.masonry, case.effects)
    velocity = np.zeros((len(stand.names), 6)) if case.velocity is None else np.asarray(case.velocity)
    course = Course(stand.at_rest, velocity, case.duration, case.motion, case.vertical)
    if state is not None:
        course = replace(course, pose=state[0], velocity=state[1], released=False)
    system = copied(stand.system)._replace(ground=course.ground)
    started(system, course.pose, course.velocity)
    limit = longest_step(system)
    return Setup(stand, course, system, advance, limit, SHARE, freedom=SPACE)
