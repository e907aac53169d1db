"""Steps of the engine: what a run of MuJoCo leaves behind, or what broke it down."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..problem.quantities import Array, Integers
from ..result.response import State
from ..result.samples import interpolated


class StepError(RuntimeError):
    """The engine warned, or the state is no longer finite, at the time given [s]."""

    def __init__(self, what: str, t: float) -> None:
        super().__init__(what)
        self.t = t


@dataclass(frozen=True)
class Steps:
    """What the engine did: the poses at each step, and the velocities half a step before and after it.

    Args:
        t: times [s], shape (steps,).
        h: step lengths [s], shape (steps,).
        pose: x, z, theta of each body [m, m, rad], shape (steps, 3 n).
        before, after: velocities at t - h/2 and t + h/2 [m/s, m/s, rad/s], shape (steps, 3 n).
        beta: Newmark's beta of each contact [-], in the two kinds of steps, shape (2, m).
        ringing: the extra dashpots of each contact in units of h k [-], shape (2, m).
        kind: which of the two each step is, shape (steps,).
        touches: how many touches were met with a short step.
    """

    t: Array
    h: Array
    pose: Array
    before: Array
    after: Array
    beta: Array
    ringing: Array
    kind: Integers
    touches: int = 0

    @cached_property
    def velocity(self) -> Array:
        """Velocities at the times of the poses, shape (steps, 3 n)."""
        velocity: Array = 0.5 * (self.before + self.after)
        return velocity

    def sampled(self, duration: float, spacing: float | None, stride: int) -> tuple[Array, Array, Array, State]:
        """Samples of a motion: times [s], poses and velocities of shape (n, bodies, 3), and the state at the end.

        Args:
            duration: up to when samples that are interpolated reach [s].
            spacing: their distance [s]; None takes every `stride`-th step as it is.
            stride: which steps are taken then.
        """
        if spacing is None:
            t, pose, velocity = self.t[::stride], self.pose[::stride], self.velocity[::stride]
            last = self.pose[-1], self.velocity[-1]
        else:
            finish = min(float(self.t[-1]), duration)
            t = np.linspace(0.0, finish, max(2, math.ceil(finish / spacing) + 1))
            pose, velocity = interpolated(self.t, self.pose, self.velocity, t)
            last = pose[-1], velocity[-1]
        shape = (len(t), -1, 3)
        return t, pose.reshape(shape), velocity.reshape(shape), (last[0].reshape(-1, 3), last[1].reshape(-1, 3))

    @property
    def seams(self) -> Array:
        """Starts of the leapfrog's windows, half a step before the poses [s], shape (steps,)."""
        return self.t - 0.5 * self.h

    @property
    def widths(self) -> Array:
        """Lengths of the windows, from seam to seam, the last as long as its step [s], shape (steps,)."""
        return np.append(np.diff(self.seams), self.h[-1])


class Record(NamedTuple):
    """Room for steps: their times and lengths [s], poses, and the velocities before and after them; as in `Steps`."""

    t: Array
    h: Array
    pose: Array
    before: Array
    after: Array

    @classmethod
    def of(cls, steps: int, coordinates: int) -> Record:
        """Room for a number of steps."""
        return cls(*np.empty((2, steps)), *np.empty((3, steps, coordinates)))

    def first(self, n: int) -> Record:
        """A copy of the first n steps."""
        return Record(*(values[:n].copy() for values in self))

    @staticmethod
    def joined(parts: list[Record]) -> Record:
        """Records one after the other."""
        return parts[0] if len(parts) == 1 else Record(*map(np.concatenate, zip(*parts, strict=True)))
