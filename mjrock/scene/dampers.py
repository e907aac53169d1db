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
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..compiled import compiled, inlined
from ..geometry.frames import Freedom, frames_of, push_body, take_frames
from ..geometry.kinematics import LinkEnds, ends, link_velocity
from ..geometry.vectors import dot, scaled
from ..problem.wall.effect import damping_coefficient, resistance
from ..quantities import Array


class Dampers(NamedTuple):
    """Links with a dashpot for compiled functions: their ends, and rows with the numbers of their laws, shape (d,)."""

    links: LinkEnds
    law: NDArray[np.void]


@inlined
def stretching(dampers: Dampers, i: int, frames: Array, v: Array) -> float:
    """Rate of the length of damper i [m/s]."""
    link = ends(dampers.links, i, frames)
    return dot(link.span, link_velocity(dampers.links, i, link, frames, v)) / math.sqrt(dot(link.span, link.span))


@inlined
def damping_forces(dampers: Dampers, frames: Array, v: Array, force: Array) -> None:
    """Write the force of every damper along its direction [N], shape (d,)."""
    for i in range(len(force)):
        force[i] = -resistance(dampers.law[i], stretching(dampers, i, frames, v))


@inlined
def push_ends(links: LinkEnds, i: int, force: float, frames: Array, total: Array) -> None:
    """Add a force that pushes the ends of link i apart [N] to generalised forces."""
    link = ends(links, i, frames)
    pushed = scaled(force / math.sqrt(dot(link.span, link.span)), link.span)
    push_body(frames, links.body[i], link.arm, pushed, total)
    if links.anchor_body[i] >= 0:
        push_body(frames, links.anchor_body[i], link.anchor_arm, scaled(-1.0, pushed), total)


@inlined
def damp(dampers: Dampers, frames: Array, force: Array, total: Array) -> None:
    """Add the forces of the dampers [N], shape (d,), to generalised forces."""
    for i in range(len(force)):
        push_ends(dampers.links, i, force[i], frames, total)


def damping_rate(dampers: Dampers, pose: Array, principal: tuple[csr_array, Array]) -> float:
    """The highest rate at which a damper alone slows the bodies down at a pose [1/s], zero without dampers.

    Args:
        dampers: the dampers.
        pose: shape (n nq,).
        principal: velocities along principal axes and their masses, see `masses.principal`.
    """
    frames, rates, (columns, masses) = frames_of(pose, Freedom(dampers.links.axes)), [0.0], principal
    for i, c in enumerate(damping_coefficient(dampers.law.view(np.recarray))):
        push = np.zeros_like(masses)
        push_ends(dampers.links, i, 1.0, frames, push)
        rates.append(float(c * ((columns.T @ push) ** 2 / masses).sum()))
    return max(rates)


def dissipated_by_dampers(dampers: Dampers, pose: Array, mean: Array, width: Array, force: Array) -> Array:
    """Energy that each damper dissipates in the window of each step [J], shape (steps, d).

    Args:
        dampers: the dampers.
        pose: of the steps, shape (steps, n nq).
        mean, width: mean velocity in each window, shape (steps, n nv), and its length [s].
        force: of each damper in each step [N], shape (steps, d).
    """
    rates, freedom = np.zeros_like(force), Freedom(dampers.links.axes)
    if len(dampers.law):
        _rates(dampers, pose, mean, freedom.frames(pose.shape[1] // freedom.nq), rates)
    work: Array = -rates * force * width[:, None]
    return work


@compiled
def _rates(dampers: Dampers, pose: Array, mean: Array, frames: Array, rates: Array) -> None:
    """Write the rate of the length of each damper in the window of each step [m/s], shape (steps, d)."""
    for n in range(len(pose)):
        take_frames(pose[n], frames, dampers.links.axes)
        for i in range(len(dampers.law)):
            rates[n, i] = stretching(dampers, i, frames, mean[n])
