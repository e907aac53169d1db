"""The start of explicit steps: the system of a wall or of masonry, and the length of its steps."""

from __future__ import annotations

import math
from copy import deepcopy
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..problem.damping.contacts import Contacts
from ..problem.masonry.case import MasonryCase
from ..problem.wall.case import Case
from ..quantities import ON_ITS_FACE
from ..result.problem import Problem, problem_of, require_known_ties
from ..result.response import State
from ..scene.course import Course
from ..scene.scene import Scene
from .assembly import at_pose, copied, guide, open_slightly, set_initial_friction, system_of, with_supports
from .kinds.lists import laws_of, links_of
from .memory import Memory, memory_of, recalled, require_nothing_forgotten
from .search.contact_search import ContactSearch
from .stable_step import longest_step
from .step_length import StepLength
from .system import System


@dataclass(frozen=True, eq=False)
class Setup:
    """A system at its start, with all that its time integration needs.

    Args:
        problem: the case with its contacts.
        scene, course, system: the structure, what happens to it, and its rows.
        step_length: of its steps.
        end_rotation: rotation at which the run ends [rad].
        search: the contact search for blocks that fall; a wall has none.
        structure: masonry with its effects, or the key of the scene of a wall and its contacts. A run can be continued
            by one of the same structure.
        moving_blocks: the fixed blocks that move, in the order of the supports.
        link_names: of the links of each kind.
        mass_damping, local_damping: of the motion [1/s, -].
        memory: of the run that this one carries on, or None.
    """

    problem: Problem
    scene: Scene
    course: Course
    system: System
    step_length: StepLength
    end_rotation: float = math.inf
    search: ContactSearch | None = None
    structure: object = None
    moving_blocks: tuple[str, ...] = ()
    memory: Memory | None = None
    link_names: tuple[tuple[str, ...], ...] = ()
    mass_damping: float = 0.0
    local_damping: float = 0.0

    @property
    def has_motion_damping(self) -> bool:
        """Whether its motion is damped."""
        return self.mass_damping > 0 or self.local_damping > 0


def with_motion_damping(setup: Setup, mass_damping: float, local_damping: float) -> Setup:
    """The setup with mass-proportional [1/s] and local damping [-] of the motion.

    Raises:
        ValueError: for local damping of joints that stick rigidly.
    """
    if local_damping > 0 and not np.isfinite(setup.system.lines["k_s"]).all():
        raise ValueError(
            f"local_damping = {local_damping:g} needs joints with a shear stiffness, whose friction is part of the "
            "unbalanced force: take mass_damping, or masonry whose joints have k_s"
        )
    return replace(setup, mass_damping=mass_damping, local_damping=local_damping)


def setup_of(case: Case | MasonryCase, contacts: Contacts | None, state: State | None) -> Setup:
    """A wall or masonry at the start of a case, or in a given state."""
    return setup_of_problem(problem_of(case, contacts), contacts, state)


def setup_of_problem(problem: Problem, contacts: Contacts | None, state: State | None) -> Setup:
    """A problem at its start, or in a given state."""
    case, scene = problem.case, problem.scene()
    course = problem.course(scene)
    course = course if state is None else course.continued(*state)
    if isinstance(case, MasonryCase):
        return setup_of_masonry(problem, case, scene, course)
    return replace(setup_of_wall(problem, case, scene, course), structure=(scene.key, contacts))


def continued(setup: Setup, start: object) -> Setup:
    """The setup that carries on the steps of another run, if the start is the end of one of the same structure.

    Raises:
        ValueError: for ties that yield, whose elongation another start does not contain, and for an end of another
            structure whose joint laws have a memory.
    """
    memory = memory_of(start, setup.structure)
    if memory is None:
        if start is not None:
            require_known_ties(setup.problem.case)
            require_nothing_forgotten(start)
        return setup
    if setup.search is not None and memory.search is not None:
        setup.search.state = deepcopy(memory.search)
    return replace(setup, memory=memory, system=recalled(memory, setup.system, setup.moving_blocks))


def setup_of_wall(problem: Problem, case: Case, scene: Scene, course: Course) -> Setup:
    """A wall at the start of its course."""
    system = system_of(scene)
    names, links = links_of(scene, case, system.bodies)
    system = at_pose(system, course.pose, course.velocity)._replace(ground=course.ground, links=links)
    step_length = StepLength.of_wall(system, case.wall.p)
    return Setup(problem, scene, course, system, step_length, ON_ITS_FACE, link_names=names)


def setup_of_masonry(problem: Problem, case: MasonryCase, scene: Scene, course: Course) -> Setup:
    """Masonry at the start of its course."""
    at_rest = masonry_at_rest(scene)
    names, links = links_of(scene, case, at_rest.system.bodies)
    passive = tuple(table for table in links if not table.driven)
    guided = np.concatenate([table.rows["body"] for table in links if table.driven])
    system = copied(at_rest.system)._replace(ground=course.ground, links=links, guided=guided)
    system = with_supports(system, scene, case.supports)
    has_passive_links = any(len(table.rows) for table in passive)
    unguided = longest_step(system._replace(links=passive)) if has_passive_links else at_rest.limit
    guide(system, case)
    search = at_rest.search
    step_length = StepLength.of_masonry(system, unguided, search.longest_steps, search.flat_impacts)
    moving_blocks = tuple(support.block for support in case.supports)
    return Setup(
        problem,
        scene,
        course,
        at_pose(system, course.pose, course.velocity),
        step_length,
        search=search.begun(moving_blocks),
        structure=(case.masonry, case.passive),
        moving_blocks=moving_blocks,
        link_names=names,
    )


class AtRest(NamedTuple):
    """The part of a set-up that cases with the same scene share.

    Args:
        system: of masonry at rest, or as drawn where it is not settled, with the laws of its joints, without links.
        search: its blocks as they may meet.
        limit: the longest stable step without links [s].
    """

    system: System
    search: ContactSearch
    limit: float


@lru_cache(maxsize=16)
def masonry_at_rest(scene: Scene) -> AtRest:
    """Masonry at rest, or as drawn where it is not settled, computed once for each scene."""
    system = system_of(scene, ended=True)
    if scene.settled is None:
        set_initial_friction(system.lines, scene.rest_state.friction)
        at_pose(system, scene.rest_state.pose)
    else:
        open_slightly(system.lines, scene)
    search = ContactSearch(scene, system)
    system = system._replace(laws=laws_of(scene, system.lines))
    return AtRest(system, search, longest_step(system))
