"""Progress: what one step of a run hands to the next, and where the run is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..geometry.frames import frames_of
from ..quantities import Array, Flags
from .memory import EngineArrays
from .pace import Pace
from .setting import Setting
from .shaken import Shaken
from .sliding import Sliding
from .sticking import Joints
from .touches import Openings, Touches


class Progress(NamedTuple):
    """What one step hands to the next.

    Args:
        acceleration: in the last step, shape (n nv,).
        rate: its rate, from the last two steps, shape (n nv,).
        change: room for the change of the acceleration in a step, shape (n nv,).
        velocity_now, acceleration_now: room for the values at the time of the pose, shape (n nv,).
        frames, next_frames: frames of the pose before and after the step.
        openings: gap of each contact, slack of each tie, and their rates.
        closed: which contacts are closed and which ties are taut, shape (m + t,).
        touches: room for the touches of a step.
        joints: where sticking edges stuck.
        sliding: which contacts slide.
        shaken: the ground in the last step, and how the bodies answer to it.
    """

    acceleration: Array
    rate: Array
    change: Array
    velocity_now: Array
    acceleration_now: Array
    frames: Array
    next_frames: Array
    openings: Openings
    closed: Flags
    touches: Touches
    joints: Joints
    sliding: Sliding
    shaken: Shaken

    @classmethod
    def of(cls, memory: EngineArrays, setting: Setting, joints: Joints, sliding: Sliding) -> Progress:
        """The state before the first step."""
        places = setting.points.places
        frames, touches = frames_of(memory.pose, places.freedom), Touches.of(places, setting.ties)
        count = len(touches.k)
        acceleration, rate, change, velocity_now, acceleration_now = np.zeros((5, len(memory.velocity)))
        rates = acceleration, rate, change, velocity_now, acceleration_now
        touching = Openings.of(count), np.zeros(count, dtype=np.bool_), touches
        return cls(*rates, frames, frames.copy(), *touching, joints, sliding, Shaken.of(setting))


class StepClock(NamedTuple):
    """Where a run of fitted steps is.

    Args:
        t: time of the next pose [s].
        allowed: length of step that the pace allows [s].
        previous: length of the last step, zero at the release [s].
        energy: twice the kinetic energy at the last touch [J], by which changes are measured, see `Method.faster`.
        calm_steps: how many steps in a row changed little.
        no_rate: whether no rate of the acceleration is known: after a touch, and at the release.
        unpredictable: whether the last step changed the velocity so much that it says nothing of the next.
        touches: how many touches have been met.
        ended: whether the run is over.
    """

    t: float
    allowed: float
    previous: float
    energy: float
    calm_steps: int
    no_rate: bool
    unpredictable: bool
    touches: int
    ended: bool

    @classmethod
    def started(cls, pace: Pace, energy: float) -> StepClock:
        """At the release, with the energy of the release [J]."""
        return cls(0.0, pace.short, 0.0, max(2 * energy, pace.least_energy), 0, True, False, 0, False)
