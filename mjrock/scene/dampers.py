"""Dampers of a scene: viscous, between a point of a body and an anchor on the ground or on another body.

A damper resists the rate of its length in both directions. In MuJoCo's steps that fit the motion its force is that at
the velocity of the pose, which the leapfrog keeps half a step earlier and carries forward by the last acceleration
(`engine.setting`); in fixed steps it is the tendon of the text (`engine.mjcf`). SciPy has it in `reference.equations`,
and the explicit steps in `distinct.kinds.dampers`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array

from ..compiled import compiled, inlined
from ..geometry.frames import Freedom, frames_of, push_body, take_frames
from ..geometry.kinematics import ends, parting
from ..geometry.vectors import dot, scaled
from ..quantities import Array, Integers


class Dampers(NamedTuple):
    """Dampers as arrays for compiled functions.

    Args:
        body, at: the body that each damper holds, and where, from its centroid at rest [m], shapes (d,) and (d, axes).
        anchor_body, anchor_at: the body of the other end, negative for the ground, and where, from the centroid of that
            body, or from the origin of the world [m].
        between: vector from the anchor to the point, at rest [m], shape (d, axes).
        c: damping coefficient [N s/m], shape (d,).
    """

    body: Integers
    at: Array
    anchor_body: Integers
    anchor_at: Array
    between: Array
    c: Array


@inlined
def stretching(dampers: Dampers, i: int, frames: Array, v: Array, axes: tuple[int, ...]) -> float:
    """Rate of the length of damper i [m/s]."""
    at = ends(dampers, i, frames, axes)
    return dot(at.across, parting(dampers, i, at, frames, v, axes)) / math.sqrt(dot(at.across, at.across))


@inlined
def damping_forces(dampers: Dampers, frames: Array, v: Array, axes: tuple[int, ...], force: Array) -> None:
    """Write the force of every damper along its direction [N], shape (d,)."""
    for i in range(len(force)):
        force[i] = -dampers.c[i] * stretching(dampers, i, frames, v, axes)


@inlined
def push_ends(dampers: Dampers, i: int, force: float, frames: Array, axes: tuple[int, ...], total: Array) -> None:
    """Add a force that pushes the ends of damper i apart [N] to generalised forces."""
    at = ends(dampers, i, frames, axes)
    pushed = scaled(force / math.sqrt(dot(at.across, at.across)), at.across)
    push_body(frames, dampers.body[i], at.arm, pushed, total)
    if dampers.anchor_body[i] >= 0:
        push_body(frames, dampers.anchor_body[i], at.anchor_arm, scaled(-1.0, pushed), total)


@inlined
def damp(dampers: Dampers, frames: Array, force: Array, axes: tuple[int, ...], total: Array) -> None:
    """Add the forces of the dampers [N], shape (d,), to generalised forces."""
    for i in range(len(force)):
        push_ends(dampers, i, force[i], frames, axes, total)


def damping_rate(dampers: Dampers, pose: Array, freedom: Freedom, principal: tuple[csr_array, Array]) -> float:
    """The highest rate at which a damper alone slows the bodies down at a pose [1/s], zero without dampers.

    Args:
        dampers: the dampers.
        pose: shape (n nq,).
        freedom: of the bodies.
        principal: velocities along principal axes and their masses, see `masses.principal`.
    """
    frames, rates, (columns, masses) = frames_of(pose, freedom), [0.0], principal
    for i, c in enumerate(dampers.c):
        push = np.zeros_like(masses)
        push_ends(dampers, i, 1.0, frames, freedom.axes, push)
        rates.append(float(c * ((columns.T @ push) ** 2 / masses).sum()))
    return max(rates)


def taken_by_dampers(dampers: Dampers, freedom: Freedom, pose: Array, mean: Array, width: Array, force: Array) -> Array:
    """Energy that each damper dissipates in the window of each step [J], shape (steps, d).

    Args:
        dampers: the dampers.
        freedom: of the bodies.
        pose: of the steps, shape (steps, n nq).
        mean, width: mean velocity in each window, shape (steps, n nv), and its length [s].
        force: of each damper in each step [N], shape (steps, d).
    """
    rates = np.zeros_like(force)
    if len(dampers.c):
        _rates(dampers, pose, mean, freedom.frames(pose.shape[1] // freedom.nq), freedom.axes, rates)
    work: Array = -rates * force * width[:, None]
    return work


@compiled
def _rates(dampers: Dampers, pose: Array, mean: Array, frames: Array, axes: tuple[int, ...], rates: Array) -> None:
    """Write the rate of the length of each damper in the window of each step [m/s], shape (steps, d)."""
    for n in range(len(pose)):
        take_frames(pose[n], frames, axes)
        for i in range(len(dampers.c)):
            rates[n, i] = stretching(dampers, i, frames, mean[n], axes)
