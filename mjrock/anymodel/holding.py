"""What holds a body beside its contact, by name: springs and dampers of joints, tendons, actuators, limits, welds."""

from __future__ import annotations

import math
from collections.abc import Iterator

import mujoco
import numpy as np

from ..problem.damping.rebound import rebound_at, rebound_restitution
from ..quantities import Array, named
from .felt import ACTUATOR, JOINT, TENDON, EffectiveMass
from .meeting import Pose

STIFF_BESIDE = 0.05
"""Stiffness beside that of the contact, as a share of it, from which it is named [-]."""
SHIFTS = 0.02
"""Change of the restitution by dampers and dry friction from which they are named [-]."""
CONSTRAINT = mujoco.mjtObj.mjOBJ_EQUALITY


def holding(pose: Pose, felt: EffectiveMass, k: float, xi: float, mass: float, speed: float = 1.0) -> Iterator[str]:
    """What holds the bodies of a contact besides, one sentence each. The whole contact has the stiffness k [N/m], the
    damping ratio xi [-] and the mass [kg]; dry friction is judged at the speed of approach [m/s]."""
    model, data = pose.model, pose.data
    if felt.slides:
        yield (
            "the joints let the point approach only while it slides, so that friction takes part in the blow and the "
            "restitution depends on it; with friction=0 it is what was asked for"
        )
    if felt.yielding:
        names = [_name(model, CONSTRAINT, number) for number in felt.yielding]
        many, one = ("s", "") if len(names) > 1 else ("", "s")
        yield (
            f"equality constraint{many} {named(names)} yield{one} in a contact, so that bodies move neither as one nor "
            "apart, and the restitution is another; shorten the time of solref there"
        )
    if felt.limits:
        rows = {_name(model, *_owner(data, row)) for row in felt.limits}
        be = "is at its limit" if len(rows) == 1 else "are at their limits"
        yield f"{named(sorted(rows))} {be} in this pose, which holds the contact too; give mass"
    yield from _beside(pose, felt.motion, k, xi, mass, speed)


def _beside(pose: Pose, motion: Array, k: float, xi: float, mass: float, speed: float) -> Iterator[str]:
    """What springs, dampers and dry friction do, where they do much together.

    A dry friction F that is small beside the force m omega v of the contact lowers e by F / (m omega v) times
    2 sqrt(e) - 2 xi e, which is its work on the way in and out. MuJoCo's row of dry friction yields, and in a short
    contact it pulls the bodies together on both ways, as gravity does. What it takes is at most the larger of both.
    """
    springs, e = pose.springs, rebound_restitution(xi)
    stiffness, damping = springs.along(motion, speed)
    friction = springs.friction(motion)
    added = float(stiffness.sum())
    if abs(added) > STIFF_BESIDE * k:
        yield (
            f"{_names(pose, stiffness)} {added:.3g} N/m to the {k:.3g} N/m of the contact along the "
            "approach, which changes its restitution"
        )
    omega = math.sqrt(k / mass)
    ratio, pull = float(damping.sum()) / (2 * mass * omega), float(friction.sum()) / (mass * omega * speed)
    damped = e - rebound_restitution(xi + ratio) if ratio > 0 else 0.0
    rubbed = (
        min(e, max(pull * (2 * math.sqrt(e) - 2 * xi * e), e - rebound_at(1.0, xi, 1.0, pull))) if pull > 0 else 0.0
    )
    least = SHIFTS if damped + rubbed <= SHIFTS else 0.25 * SHIFTS
    if damped > least:
        yield (
            f"{_names(pose, damping)} a damping ratio of {ratio:.2g} to the {xi:.2g} of the contact "
            "along the approach, which lowers its restitution"
        )
    if rubbed > least:
        yield (
            f"{_names(pose, friction)} a dry friction of {friction.sum():.3g} N along the approach, which "
            f"lowers e = {e:.3g} by up to {rubbed:.2g} at {speed:g} m/s, and by more at a lower speed"
        )


def _names(pose: Pose, shares: Array) -> str:
    """Those that add nearly all of it, the largest first, and the verb."""
    shares = np.abs(shares)
    order = np.argsort(-shares, kind="stable")
    most = [_name(pose.model, *pose.springs.owners[i]) for i in order[shares[order] >= 0.1 * shares[order[0]]]]
    return f"{named(most)} add{'s' * (len(most) == 1)}"


def _name(model: mujoco.MjModel, kind: mujoco.mjtObj, number: int) -> str:
    words = {JOINT: "joint", TENDON: "tendon", ACTUATOR: "actuator", CONSTRAINT: ""}[kind]
    return f"{words} {mujoco.mj_id2name(model, kind, number) or f'[{number}]'!s}".strip()


def _owner(data: mujoco.MjData, row: int) -> tuple[mujoco.mjtObj, int]:
    tendon = int(data.efc_type[row]) == int(mujoco.mjtConstraint.mjCNSTR_LIMIT_TENDON)
    return (TENDON if tendon else JOINT), int(data.efc_id[row])
