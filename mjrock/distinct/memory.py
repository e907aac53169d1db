"""Memory: the state of the steps at the end of a run, beside pose and velocity. With it a run goes on to rounding.

Velocities stand half a step before the pose, friction holds what it held in the last step, and the work of dashpots and
friction is that of the mean of two steps.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..geometry.vectors import Vector
from ..quantities import Array, named
from ..result.response import End
from .assembly import copied, guided_as
from .loop import Clock, ground_acceleration
from .search.contact_search import SearchState
from .supports import places
from .system import System


class Memory(NamedTuple):
    """The steps before the last pose of a run.

    Args:
        structure: to which it belongs, see `Setup`.
        system: with the velocities half a step before the pose.
        h_before: length of the step that led to the pose [s].
        ground_acceleration_before: its mean over the half of that step before the pose [m/s2].
        moved: displacement of each fixed block that moves in that step, by name, shape (d,) each [m].
        search: the state of the contact search.
        until_search: steps until its next update.
    """

    structure: object
    system: System
    h_before: float
    ground_acceleration_before: Vector
    moved: dict[str, Array]
    search: SearchState | None = None
    until_search: int = 0


def memory_of(start: object, structure: object) -> Memory | None:
    """The memory of a start, if the start carries one of the same structure."""
    memory = start.memory if isinstance(start, End) else None
    return memory if isinstance(memory, Memory) and memory.structure == structure else None


def require_nothing_forgotten(start: object) -> None:
    """Raise a ValueError that names the joints whose laws remember something at a start of another structure, such as
    the same one with another law or another number of it."""
    memory = start.memory if isinstance(start, End) else None
    if not isinstance(memory, Memory):
        return
    masonry: Any = memory.structure[0] if isinstance(memory.structure, tuple) else None
    bonds = getattr(masonry, "bonds", ())  # a wall has none
    joints = {
        masonry.joints[int(memory.system.lines["group"][i])].name: None
        for law in (memory.system.laws if any(bonds) else ())
        for i in np.flatnonzero(law.has_changed(bonds)).tolist()
        if memory.system.lines["group"][i] < len(masonry.joints)
    }
    if joints:
        raise ValueError(
            f"start is the end of a run of another structure, whose joints, laws or effects are not those of the case, "
            f"and the laws of {named(list(joints))} remember something there; go on with the same structure, or give "
            "start=(end.pose, end.velocity), from which laws begin without a memory and bonds whole"
        )


def remember(structure: object, system: System, clock: Clock, blocks: tuple[str, ...]) -> Memory:
    """The memory of the steps before the last of them, without the contact search.

    Args:
        structure: see `Memory`.
        system: before the last step.
        clock: at the last step.
        blocks: names of the fixed blocks that move.
    """
    t, h, supports = clock.step * clock.h, clock.h, system.supports
    ground_acceleration_before = ground_acceleration(system.ground, t - 0.25 * h, 0.5 * h, system.axes)
    moved, copy_before = dict(zip(blocks, places(supports, t) - supports.moved, strict=True)), copied(system)
    copy_before = copy_before._replace(links=tuple(table.remembered(t) for table in copy_before.links))
    return Memory(structure, copy_before, h, ground_acceleration_before, moved)


def recalled(memory: Memory, system: System, blocks: tuple[str, ...]) -> System:
    """The system at the start of a run that carries on.

    Args:
        memory: of the run before.
        system: as a run starts from rest, with its ground, supports and faces.
        blocks: names of the fixed blocks that move. Their histories go on from wherever those before have ended.
    """
    start = places(system.supports, 0.0)
    for i, block in enumerate(blocks):
        system.supports.moved[i] = start[i] - memory.moved.get(block, 0.0)
    carried = copied(memory.system)
    carried.lines["support"][: len(system.lines)] = system.lines["support"]
    carried.lines["widest"] = 0.0
    guided_as(carried.bodies, system.bodies)
    links = tuple(table.resumed(before) for table, before in zip(system.links, carried.links, strict=True))
    laws = tuple(law.resumed(from_rest) for law, from_rest in zip(carried.laws, system.laws, strict=True))
    carried = system._replace(bodies=carried.bodies, lines=carried.lines, laws=laws, links=links)
    return carried.with_room_for_friction()
