"""Shaken: how the bodies answer to the ground, whose acceleration no step may extrapolate.

The acceleration of the ground has a kink at every sample of its record, and bodies on stiff contacts answer to it at
once. Extrapolated from the last steps it would be the largest error of a run. So the accelerations of the bodies are
split, q'' = s + G a: a is the acceleration of the ground, whose mean over any time is known exactly, and s changes
smoothly between touches. The engine itself tells G wherever the length of the step changes: contacts hold and let go as
they do then, and the ground accelerates by one unit more. Accelerations of several bodies are not split: where they
slide and strike, their answer changes from step to step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..quantities import Array
from ..scene.ground import Ground, mean_acceleration, push_along
from .memory import EngineArrays
from .setting import Setting, push
from .sliding import STAGE_VELOCITY, Sliding, give_rows_back, slide


class Shaken(NamedTuple):
    """The ground in the last step, and the answer of the bodies. Directions are x, z, and y in space, as in `Ground`;
    there is none where accelerations are not split.

    Args:
        mean: mean acceleration of the ground over the window of the last step [m/s2], shape (2 or 3,).
        answer: acceleration of the bodies for a unit of it, G, shape (2 or 3, n nv); zero until it is found.
    """

    mean: Array
    answer: Array

    @classmethod
    def of(cls, setting: Setting) -> Shaken:
        """Before the first step."""
        directions = len(setting.points.places.axes) if setting.splits else 0
        return cls(np.zeros(directions), np.zeros((directions, len(setting.masses))))


@inlined
def find_answer(
    memory: EngineArrays, setting: Setting, sliding: Sliding, frames: Array, shaken: Shaken, t: float
) -> None:
    """Find how the bodies answer to the ground at the pose, with the step and the velocity that are set."""
    if not slide(memory, setting, sliding, frames, t):
        push(memory, setting, frames, t)
        memory.forward(memory.model, memory.data)
    for d in range(len(shaken.mean)):
        for j in range(len(memory.acceleration)):
            shaken.answer[d, j] = -memory.acceleration[j]
    axes, masses = setting.points.places.axes, setting.masses
    for d in range(len(shaken.mean)):
        if len(setting.ground[d].accel) > 0:
            push_along(d, 1.0, masses, axes, memory.applied)
            memory.accelerate(memory.model, memory.data, STAGE_VELOCITY, 1)
            push_along(d, -1.0, masses, axes, memory.applied)
            for j in range(len(memory.acceleration)):
                shaken.answer[d, j] += memory.acceleration[j]
    give_rows_back(memory, sliding)


@inlined
def add_change(shaken: Shaken, ground: Ground, t: float, h: float, weight: float, to: Array) -> None:
    """Add to `to` the weight times what the bodies answer to the change of the ground.

    The change is that of its mean acceleration, from the window of the last step to a time h [s] around t [s].
    """
    for d in range(len(shaken.mean)):
        if len(ground[d].accel) > 0:
            change = mean_acceleration(ground[d], t, h) - shaken.mean[d]
            for j in range(len(to)):
                to[j] += weight * change * shaken.answer[d, j]


@inlined
def take_mean(shaken: Shaken, ground: Ground, t: float, h: float) -> None:
    """Take the mean acceleration of the ground over the window of a step h [s] at t [s]."""
    for d in range(len(shaken.mean)):
        shaken.mean[d] = mean_acceleration(ground[d], t, h)
