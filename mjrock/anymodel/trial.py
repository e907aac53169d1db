"""A trial of contacts in their model: how many iterations MuJoCo's solver needs for them.

The contacts are written into a copy of the model, on its pairs and its geoms. Geoms that are apart act at the distance
at which they are, so that every contact carries. The copy steps with a solver that converges, from a state that moves
in all of its joints. At each state the solver of the model is asked as well. Where it ends at its last iteration or
finds other forces, it has too few iterations."""

from __future__ import annotations

import copy
import math
import warnings
from collections.abc import Sequence

import mujoco
import numpy as np

from ..quantities import Array
from .contact import PairContact
from .geoms import GeomPair
from .meeting import Pose, awake
from .notes import LINE_SEARCHES, MOST_TURNS, SolverNeed

STEPS = 50
"""Steps of a trial."""
MOVING = 0.1
"""Largest speed of a joint at the start of a trial [m/s or rad/s]."""
OTHER_FORCES = 0.01
"""Change of the forces, as a share of the largest, from which they are others [-]."""


def solver_need(model: mujoco.MjModel, pose: Pose, contacts: Sequence[PairContact]) -> SolverNeed:
    """What contacts of a compiled model need of its solver, by a trial in a pose.

    Where it does not converge, a tenth of the impratio is tried, and so on until half of the iterations are enough.
    """
    tried = _with(model, pose, contacts)
    own = int(tried.opt.iterations), int(tried.opt.ls_iterations)
    cap, searches = max(own[0], MOST_TURNS), max(own[1], LINE_SEARCHES)
    most, enough = _stepped(tried, pose, cap, searches)
    if most < cap:
        return SolverNeed(*own) if enough else SolverNeed(max(2 * most, own[0]), searches)
    full = float(tried.opt.impratio) if any(contact.condim > 1 for contact in contacts) else 1.0
    for power in range(math.ceil(math.log10(full)) - 1, -1, -1):
        tried.opt.impratio, (tried.opt.iterations, tried.opt.ls_iterations) = 10.0**power, own
        most, _ = _stepped(tried, pose, cap, searches)
        if 2 * most <= cap:
            return SolverNeed(max(2 * most, own[0]), searches, converges=False, impratio=10.0**power)
    return SolverNeed(*own, converges=False)


def _stepped(tried: mujoco.MjModel, pose: Pose, cap: int, searches: int) -> tuple[int, bool]:
    """The most iterations of a step, of `cap` with so many line searches, and whether those of the model find the same
    forces."""
    own = int(tried.opt.iterations), int(tried.opt.ls_iterations)
    data, other = mujoco.MjData(tried), mujoco.MjData(tried)
    for each in (data, other):
        _put(each, pose.data.qpos, MOVING * np.cos(np.arange(tried.nv)))
        each.mocap_pos[:], each.mocap_quat[:] = pose.data.mocap_pos, pose.data.mocap_quat
    most, enough = 0, True
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for _ in range(STEPS):
            tried.opt.iterations, tried.opt.ls_iterations = own
            _put(other, data.qpos, data.qvel)
            other.act[:], other.qacc_warmstart[:] = data.act, data.qacc_warmstart
            mujoco.mj_forward(tried, other)
            tried.opt.iterations, tried.opt.ls_iterations = cap, searches
            mujoco.mj_step(tried, data)
            if data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number:
                break
            most = max(most, int(data.solver_niter.max(initial=0)))
            enough &= _alike(other, data)
    return most, enough


def _with(model: mujoco.MjModel, pose: Pose, contacts: Sequence[PairContact]) -> mujoco.MjModel:
    """A copy of a model with contacts on its pairs and geoms, which act at the distance at which they are."""
    tried = copy.copy(awake(model))
    option = tried.opt
    option.timestep = contacts[0].timestep
    if any(contact.condim > 1 for contact in contacts):
        option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        option.impratio = max(float(option.impratio), *(contact.impratio for contact in contacts), 1.0)
    for contact in contacts:
        pair = GeomPair(tried, contact.ids)
        contact.write_numbers(tried, pair)
        here = max(0.0, pose.landing(GeomPair(model, contact.ids)).distance) + contact.depth
        if pair.explicit >= 0:
            tried.pair_margin[pair.explicit] = here
        else:
            first, second = contact.ids
            tried.geom_margin[first] = max(float(tried.geom_margin[first]), here - float(tried.geom_margin[second]))
    return tried


def _put(data: mujoco.MjData, qpos: Array, qvel: Array) -> None:
    data.qpos[:], data.qvel[:] = qpos, qvel


def _alike(other: mujoco.MjData, data: mujoco.MjData) -> bool:
    """Whether the forces of two solutions of one state are the same."""
    if other.nefc != data.nefc or not data.nefc:
        return True
    difference = np.abs(np.array(other.efc_force) - data.efc_force).max()
    return bool(difference <= OTHER_FORCES * np.abs(data.efc_force).max())
