"""What holds a body beside its contact, by name: springs and dampers of joints, tendons, actuators, limits, welds."""

from __future__ import annotations

import math
from collections.abc import Iterator

import mujoco
import numpy as np

from ..problem.damping.rebound import rebound_restitution
from ..quantities import Array, named
from .felt import Felt
from .meeting import Pose
from .springs import ACTUATOR, JOINT, TENDON, Springs

STIFF = 0.05
"""Stiffness beside that of the contact, as a share of it, from which it is named [-]."""
SHIFTS = 0.02
"""Change of the restitution from which a damper is named [-]."""
CONSTRAINT = mujoco.mjtObj.mjOBJ_EQUALITY


def holding(pose: Pose, felt: Felt, k: float, xi: float, mass: float) -> Iterator[str]:
    """What holds the bodies of a contact besides, one sentence each.

    Args:
        pose: the model in its pose.
        felt: what the contact feels.
        k, xi, mass: stiffness of the whole contact [N/m], its damping ratio [-] and its mass [kg].
    """
    model, data = pose.model, pose.data
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
    yield from _beside(model, pose.springs, felt.motion, k, xi, mass)


def _beside(model: mujoco.MjModel, springs: Springs, motion: Array, k: float, xi: float, mass: float) -> Iterator[str]:
    """What springs and dampers do, where they do much."""
    stiffness, damping = springs.along(motion)
    added = float(stiffness.sum())
    if added > STIFF * k:
        yield (
            f"{_names(model, springs, stiffness)} adds {added:.3g} N/m to the {k:.3g} N/m of the contact along the "
            "approach, which changes its restitution"
        )
    ratio = float(damping.sum()) / (2 * math.sqrt(k * mass))
    if ratio > 0 and rebound_restitution(xi) - rebound_restitution(xi + ratio) > SHIFTS:
        yield (
            f"{_names(model, springs, damping)} adds a damping ratio of {ratio:.2g} to the {xi:.2g} of the contact "
            "along the approach, which lowers its restitution"
        )


def _names(model: mujoco.MjModel, springs: Springs, shares: Array) -> str:
    """Those that add nearly all of it, the largest first."""
    order = np.argsort(-shares, kind="stable")
    return named([_name(model, *springs.owners[i]) for i in order[shares[order] >= 0.1 * shares[order[0]]]])


def _name(model: mujoco.MjModel, kind: mujoco.mjtObj, number: int) -> str:
    words = {JOINT: "joint", TENDON: "tendon", ACTUATOR: "actuator", CONSTRAINT: ""}[kind]
    return f"{words} {mujoco.mj_id2name(model, kind, number) or f'[{number}]'!s}".strip()


def _owner(data: mujoco.MjData, row: int) -> tuple[mujoco.mjtObj, int]:
    tendon = int(data.efc_type[row]) == int(mujoco.mjtConstraint.mjCNSTR_LIMIT_TENDON)
    return (TENDON if tendon else JOINT), int(data.efc_id[row])
