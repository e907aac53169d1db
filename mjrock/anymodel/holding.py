"""What holds a body beside its contact, by name: springs and dampers of joints, tendons, actuators, limits, welds.

Along the approach a spring of the model adds u^T K u to the stiffness of the contact, and a damper u^T D u to its
dashpot, with u the velocity of the joints for a unit speed of the contact.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np

from ..problem.damping.rebound import rebound_restitution
from ..quantities import Array, Integers, named
from .felt import Felt

STIFF = 0.05
"""Stiffness beside that of the contact, as a share of it, from which it is named [-]."""
SHIFTS = 0.02
"""Change of the restitution from which a damper is named [-]."""
JOINT, TENDON = mujoco.mjtObj.mjOBJ_JOINT, mujoco.mjtObj.mjOBJ_TENDON
ACTUATOR, CONSTRAINT = mujoco.mjtObj.mjOBJ_ACTUATOR, mujoco.mjtObj.mjOBJ_EQUALITY


@dataclass(frozen=True)
class Beside:
    """What a joint, a tendon or an actuator adds to a contact along its approach.

    Args:
        name: what it is called.
        k, c: stiffness [N/m] and damping [N s/m].
    """

    name: str
    k: float
    c: float


def holding(model: mujoco.MjModel, data: mujoco.MjData, felt: Felt, k: float, xi: float, mass: float) -> Iterator[str]:
    """What holds the bodies of a contact besides, one sentence each.

    Args:
        model, data: the model in its pose.
        felt: what the contact feels.
        k, xi, mass: stiffness of the whole contact [N/m], its damping ratio [-] and its mass [kg].
    """
    if felt.slides:
        yield (
            "the joints let the point approach only while it slides, so that friction takes part in the blow and the "
            "restitution depends on it; with friction=0 it is what was asked for"
        )
    for number in felt.yielding:
        yield (
            f"the equality constraint {_name(model, CONSTRAINT, number)} yields in a contact, so that its bodies move "
            "neither as one nor apart, and the restitution is another; shorten the time of its solref"
        )
    if felt.limits:
        rows = {_name(model, *_owner(data, row)) for row in felt.limits}
        yield f"{named(sorted(rows))} is at its limit in this pose, which holds the contact too; give mass"
    yield from _springs(model, data, felt.motion, k, xi, mass)


def _springs(
    model: mujoco.MjModel, data: mujoco.MjData, motion: Array, k: float, xi: float, mass: float
) -> Iterator[str]:
    """What springs and dampers do, where they do much."""
    squares = motion**2
    c_most = float(model.dof_damping @ squares)
    k_most = float(np.ravel(model.jnt_stiffness)[model.dof_jntid] @ squares) if model.njnt else 0.0
    if model.ntendon == 0 and model.nu == 0 and k_most <= STIFF * k and c_most <= 1e-3 * math.sqrt(k * mass):
        return
    parts = [*_joints(model, motion), *_tendons(model, data, motion), *_actuators(model, data, motion)]
    stiff = [part for part in parts if part.k > 0]
    added = sum(part.k for part in stiff)
    if added > STIFF * k:
        yield (
            f"{_names(stiff, 'k')} adds {added:.3g} N/m to the {k:.3g} N/m of the contact along the approach, which "
            "changes its restitution"
        )
    damped = [part for part in parts if part.c > 0]
    ratio = sum(part.c for part in damped) / (2 * math.sqrt(k * mass))
    if rebound_restitution(xi) - rebound_restitution(xi + ratio) > SHIFTS:
        yield (
            f"{_names(damped, 'c')} adds a damping ratio of {ratio:.2g} to the {xi:.2g} of the contact along the "
            "approach, which lowers its restitution"
        )


def _names(parts: list[Beside], what: str) -> str:
    """Those that add nearly all of it, the largest first."""
    parts = sorted(parts, key=lambda part: -getattr(part, what))
    least = 0.1 * getattr(parts[0], what)
    return named([part.name for part in parts if getattr(part, what) >= least])


def _name(model: mujoco.MjModel, kind: mujoco.mjtObj, number: int) -> str:
    words = {JOINT: "joint", TENDON: "tendon", ACTUATOR: "actuator", CONSTRAINT: ""}[kind]
    return f"{words} {mujoco.mj_id2name(model, kind, number) or f'[{number}]'!s}".strip()


def _owner(data: mujoco.MjData, row: int) -> tuple[mujoco.mjtObj, int]:
    tendon = int(data.efc_type[row]) == int(mujoco.mjtConstraint.mjCNSTR_LIMIT_TENDON)
    return (TENDON if tendon else JOINT), int(data.efc_id[row])


def _joints(model: mujoco.MjModel, motion: Array) -> Iterator[Beside]:
    for joint in range(model.njnt):
        end = model.jnt_dofadr[joint + 1] if joint + 1 < model.njnt else model.nv
        dofs = slice(int(model.jnt_dofadr[joint]), int(end))
        squares = motion[dofs] ** 2
        k, c = model.jnt_stiffness[joint], model.dof_damping[dofs]
        if (np.any(k) or np.any(c)) and squares.any():
            yield Beside(_name(model, JOINT, joint), float(np.ravel(k)[0] * squares.sum()), float(c @ squares))


def _along(values: Array, count: Integers, start: Integers, columns: Integers, number: int, motion: Array) -> float:
    """One row of a sparse matrix times the motion."""
    part = slice(int(start[number]), int(start[number] + count[number]))
    return float(np.ravel(values)[part] @ motion[np.ravel(columns)[part]])


def _tendons(model: mujoco.MjModel, data: mujoco.MjData, motion: Array) -> Iterator[Beside]:
    for i in range(model.ntendon):
        stretch = _along(data.ten_J, model.ten_J_rownnz, model.ten_J_rowadr, model.ten_J_colind, i, motion)
        k, c = float(np.ravel(model.tendon_stiffness[i])[0]), float(np.ravel(model.tendon_damping[i])[0])
        if (k or c) and stretch:
            yield Beside(_name(model, TENDON, i), k * stretch**2, c * stretch**2)


def _actuators(model: mujoco.MjModel, data: mujoco.MjData, motion: Array) -> Iterator[Beside]:
    affine = int(mujoco.mjtBias.mjBIAS_AFFINE)
    for i in range(model.nu):
        moved = _along(data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind, i, motion)
        k, c = (-float(model.actuator_biasprm[i, n]) for n in (1, 2))
        if int(model.actuator_biastype[i]) == affine and (k > 0 or c > 0) and moved:
            yield Beside(_name(model, ACTUATOR, i), max(k, 0.0) * moved**2, max(c, 0.0) * moved**2)
