"""Masonry in space at rest, and its system at the start of a case."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...geometry.frames import SPACE
from ...problem.masonry.case import MasonryCase
from ...problem.masonry.masonry import Masonry
from ...problem.wall.effect import Effect
from ...result.response import State
from ...scene.equilibrium import UnsettledError
from ...scene.explicit_step import SHARE
from ...scene.masonry import masonry_course, require_carried, standing_masonry, unsettled
from ...scene.scene import Scene
from ..following import Setup
from .assembly import copied, masonry_system, moved_by, started, take_grips
from .encounters import EncountersInSpace
from .limit import longest_step
from .loop import advance
from .system import System


def setup_in_space(case: MasonryCase, state: State | None) -> Setup:
    """Masonry in space at the start of a case, or in a given state."""
    scene, at_rest = standing(case.masonry, case.effects)
    course = masonry_course(case, scene)
    if state is not None:
        course = course.continued(*state)
    system = moved_by(copied(at_rest), scene, case.masonry, case.supports)._replace(ground=course.ground)
    started(system, course.pose, course.velocity)
    limit, encounters = longest_step(system), EncountersInSpace(case.masonry, system, scene.contacts.joint)
    system = encounters.made_room(system)
    return Setup(scene, course, system, advance, limit, SHARE, freedom=SPACE, encounters=encounters)


@lru_cache(maxsize=16)
def standing(masonry: Masonry, effects: tuple[Effect, ...] = ()) -> tuple[Scene, System]:
    """Masonry in space and its system at rest, which all cases of it with the same effects share.

    Raises:
        ValueError: if it does not stand. The message names the blocks that fall.
    """
    scene = standing_masonry(masonry, effects)
    system = masonry_system(scene, masonry)
    try:
        pose, drag = scene.rest_in_space
    except UnsettledError as error:
        require_carried(masonry, effects)
        raise unsettled(masonry, error.pose) from None
    started(system, pose, np.zeros((len(pose), 6)))
    take_grips(system.lines, drag)
    return scene, system
