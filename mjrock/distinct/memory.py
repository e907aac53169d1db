"""Memory: what the steps know at the end of a run beside pose and velocity, so that another run carries on to rounding.

Velocities stand half a step before the pose, friction holds what it held in the last step, and the work of dashpots and
friction is that of the mean of two steps.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..geometry.vectors import Vector
from ..quantities import Array
from ..result.response import State
from .assembly import copied, guided_as
from .encounters import Met
from .links import support_place
from .loop import Clock, accelerated
from .system import Supports, System


class Memory(NamedTuple):
    """The steps before the last pose of a run.

    Args:
        of: what stands, see `Setup`. Another structure remembers nothing.
        system: with the velocities half a step before the pose.
        before: length of the step that led to the pose [s].
        pushed: mean acceleration of the ground over the half of that step before the pose [m/s2].
        moved: displacement of each fixed block that moves in that step, by name, shape (d,) each [m].
        driven: where each actuator was at the pose, and how far it had gone in that step [m], shape (a, 2).
        met: what was known of the encounters.
        look: steps until the next look for encounters.
    """

    of: object
    system: System
    before: float
    pushed: Vector
    moved: dict[str, Array]
    driven: Array
    met: Met | None = None
    look: int = 0


class Remembered(tuple[Array, Array]):
    """The end of a run by explicit steps: pose and velocity, with the `memory` of its steps."""

    memory: Memory | None


def remembered(end: State, memory: Memory | None) -> State:
    """The end of a run with its memory, which a run that ended before its time does not have."""
    carried = Remembered(end)
    carried.memory = memory
    return carried


def memory_of(start: object, of: object) -> Memory | None:
    """The memory of a start, if it has one of what stands here."""
    memory = getattr(start, "memory", None)
    return memory if isinstance(memory, Memory) and memory.of == of else None


def remember(of: object, system: System, clock: Clock, blocks: tuple[str, ...]) -> Memory:
    """What the steps know before the last of them, but for the encounters.

    Args:
        of: what stands.
        system: before the last step.
        clock: at the last step.
        blocks: names of the fixed blocks that move.
    """
    t, h, supports = clock.step * clock.h, clock.h, system.supports
    pushed = accelerated(system.ground, t - 0.25 * h, 0.5 * h, system.axes)
    moved = {block: places(supports, i, t) - supports.moved[i] for i, block in enumerate(blocks)}
    driven = np.array([places(system.drives, i, t) for i in range(len(system.actuators))]).reshape(-1, 1)
    return Memory(of, copied(system), h, pushed, moved, np.hstack([driven, driven - system.drives.moved]))


def places(supports: Supports, i: int, t: float) -> Array:
    """Displacement of support i at a time [m], shape (d,)."""
    return np.array([support_place(supports, i, axis, t) for axis in range(supports.moved.shape[1])])


def carry_drives(memory: Memory, system: System) -> None:
    """Let actuators go on from where the same ones before had driven their blocks."""
    before, same = memory.system.actuators, ["body", "at", "between", "k", "c"]
    if len(before) != len(system.actuators) or (before[same] != system.actuators[same]).any():
        return
    for name in ("pulled", "dragged"):
        system.actuators[name] = before[name]
    system.actuators["reach"] = before["reach"] + memory.driven[:, 0]
    system.drives.moved[:, 0] = -memory.driven[:, 1]


def recalled(memory: Memory, system: System, blocks: tuple[str, ...]) -> System:
    """The system at the start of a run that carries on.

    Args:
        memory: of the run before.
        system: as a run starts from rest, with its ground, supports and faces.
        blocks: names of the fixed blocks that move. Their histories go on from wherever those before have ended.
    """
    for i, block in enumerate(blocks):
        system.supports.moved[i] = places(system.supports, i, 0.0) - memory.moved.get(block, 0.0)
    carried = copied(memory.system)
    carried.lines["support"][: len(system.lines)] = system.lines["support"]
    carried.ties["support"], carried.dampers["support"] = system.ties["support"], system.dampers["support"]
    carried.lines["widest"] = carried.bonds["age"] = 0.0
    guided_as(carried.bodies, system.bodies)
    carry_drives(memory, system)
    carried = system._replace(
        bodies=carried.bodies, lines=carried.lines, bonds=carried.bonds, ties=carried.ties, dampers=carried.dampers
    )
    return carried.with_ways()
