"""Steps of the engine: their record, their windows, and samples between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..geometry.frames import PLANE, Freedom
from ..geometry.poses import coordinate_rates, from_rates, moved
from ..method import METHOD, Method
from ..quantities import Array, Flags, Integers
from ..result.motion import interpolated, intervals, thinned
from ..result.response import End


class Record(NamedTuple):
    """Steps one after the other, or room for them.

    Args:
        t: times [s], shape (steps,).
        h: step lengths [s], shape (steps,).
        pose: of each body, displacements [m] and rotation, shape (steps, n nq).
        before, after: velocities at t - h/2 and t + h/2 [m/s, rad/s], shape (steps, n nv).
        friction: friction of each contact that slides by Coulomb's law, NaN for one that has its row [N], (steps, m).
        damping: force of each damper [N], shape (steps, d).
    """

    t: Array
    h: Array
    pose: Array
    before: Array
    after: Array
    friction: Array
    damping: Array

    @classmethod
    def with_room(cls, steps: int, coordinates: tuple[int, int], contacts: int, dampers: int = 0) -> Record:
        """Room for a number of steps of bodies with given numbers of coordinates and velocities."""
        return cls(
            t=np.empty(steps),
            h=np.empty(steps),
            pose=np.empty((steps, coordinates[0])),
            before=np.empty((steps, coordinates[1])),
            after=np.empty((steps, coordinates[1])),
            friction=np.empty((steps, contacts)),
            damping=np.empty((steps, dampers)),
        )

    def first(self, n: int) -> Record:
        """A copy of the first n steps."""
        return Record(*(values[:n].copy() for values in self))

    @staticmethod
    def joined(parts: list[Record]) -> Record:
        """Records one after the other."""
        return parts[0] if len(parts) == 1 else Record(*map(np.concatenate, zip(*parts, strict=True)))


class StepKinds(NamedTuple):
    """The rows of the steps, which are of two kinds: those that resolve the contacts, and those that do not.

    Args:
        beta: Newmark's beta of each contact [-] in the two kinds, shape (2, m).
        ringing: the extra dashpots of each contact in units of h k [-], shape (2, m).
        kind: which of the two each step is, shape (steps,).
        released_on: which contacts the engine sees closed at the release, where gaps are zero to rounding, shape (m,).
    """

    beta: Array
    ringing: Array
    kind: Integers
    released_on: Flags


@dataclass(frozen=True)
class Steps:
    """The steps of a run, and how they were made.

    Args:
        record: the steps.
        kinds: their rows.
        touches: how many touches were met with a short step.
        method: the constants of the method by which they were made.
        freedom: of the bodies.
    """

    record: Record
    kinds: StepKinds
    touches: int = 0
    method: Method = METHOD
    freedom: Freedom = PLANE

    @property
    def t(self) -> Array:
        """Times of the poses [s], shape (steps,)."""
        return self.record.t

    @property
    def h(self) -> Array:
        """Lengths of the steps [s], shape (steps,)."""
        return self.record.h

    @property
    def pose(self) -> Array:
        """Poses, shape (steps, n nq)."""
        return self.record.pose

    @cached_property
    def velocity(self) -> Array:
        """Velocities at the times of the poses, shape (steps, n nv)."""
        velocity: Array = 0.5 * (self.record.before + self.record.after)
        return velocity

    def sampled(self, duration: float, spacing: float | None, stride: int) -> Samples:
        """Samples of the steps, and their end.

        Args:
            duration: up to when samples that are interpolated reach [s].
            spacing: their distance [s]; None takes every `stride`-th step as it is.
            stride: which steps are taken then, and the last.
        """
        nq, nv, pose, velocity = self.freedom.nq, self.freedom.nv, self.pose, self.velocity
        if spacing is None:
            kept, last = thinned(len(self.t), stride), (pose[-1], velocity[-1])
            t, pose, velocity = self.t[kept], pose[kept], velocity[kept]
        else:
            finish = min(float(self.t[-1]), duration)
            t = np.linspace(0.0, finish, intervals(finish, spacing) + 1)
            rates = coordinate_rates(pose, velocity, self.freedom)
            pose, velocity = from_rates(*interpolated(self.t, pose, rates, t), self.freedom)
            last = pose[-1], velocity[-1]
        end = End(last[0].reshape(-1, nq), last[1].reshape(-1, nv))
        return Samples(t, pose.reshape(len(t), -1, nq), velocity.reshape(len(t), -1, nv), end)

    @cached_property
    def windows(self) -> Windows:
        """The windows of the steps."""
        before, after, freedom = self.record.before, self.record.after, self.freedom
        t, velocity = self.t - 0.5 * self.h, before.copy()
        pose = moved(self.pose, -0.5 * self.h[:, None] * before, freedom)
        t[0], pose[0], velocity[0] = self.t[0], self.pose[0], self.velocity[0]
        end = np.concatenate([velocity[1:], after[-1:]])
        width, mean = np.append(np.diff(t), self.h[-1]), 0.5 * (velocity + end)
        square = np.append(0.0, self.h[1:] ** 2)  # of the distance from pose to seam, four times
        late = np.diff(square)[:, None] * ((after - before) / self.h[:, None])[:-1] / 8
        behind = np.concatenate([np.zeros_like(before[:1]), np.cumsum(late, axis=0)])
        return Windows(t, width, pose, moved(pose, -behind, freedom), velocity, mean)


class Samples(NamedTuple):
    """Samples of a run: times [s], poses (n, bodies, nq) and velocities (n, bodies, nv), and its end."""

    t: Array
    pose: Array
    velocity: Array
    end: End


class Windows(NamedTuple):
    """The windows of the leapfrog, in which the force of a step acts, from half a step before a pose to half a step
    after it.

    The first starts at the release: before it no force has acted. Over a window a constant force does the work that is
    its product with the mean velocity and the width, without error.

    Args:
        t: start of each window [s], shape (steps,).
        width: its length, the last as long as its step [s], shape (steps,).
        pose, velocity: at its start, the pose as the springs of the contacts see it, (steps, n nq) and (steps, n nv).
        placed: the same as the weight sees it, moved by mean velocity times width in each window, (steps, n nq).
            Where the step changes from h to h', a pose that falls back to the seam with its velocity alone misses
            a (h'^2 - h^2) / 8, with a the acceleration of the step.
        mean: the mean velocity in it, shape (steps, n nv).
    """

    t: Array
    width: Array
    pose: Array
    placed: Array
    velocity: Array
    mean: Array
