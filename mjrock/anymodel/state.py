"""The pose of a model in which a contact is made: `qpos0`, a keyframe, or positions that are given."""

from __future__ import annotations

import warnings

import mujoco
import numpy as np

from ..quantities import require_array, require_whole, shown

KEY = mujoco.mjtObj.mjOBJ_KEY


def keyframe_names(model: mujoco.MjModel) -> tuple[str, ...]:
    """The names of all keyframes, with a number in brackets where there is none."""
    return tuple(mujoco.mj_id2name(model, KEY, i) or f"[{i}]" for i in range(model.nkey))


def keyframe_id(model: mujoco.MjModel, keyframe: object) -> int:
    """The number of a keyframe given by name or number; TypeError or ValueError with what the model has for none."""
    known = ", ".join(keyframe_names(model)) or "none"
    if isinstance(keyframe, str):
        number = mujoco.mj_name2id(model, KEY, keyframe) if "\0" not in keyframe and keyframe.isprintable() else -1
        if number < 0:
            raise ValueError(f"keyframe = {shown(keyframe)} is not a keyframe of this model; it has: {known}")
        return int(number)
    if model.nkey == 0:
        raise ValueError(f"keyframe = {shown(keyframe)} is given, and this model has none")
    return require_whole("keyframe", keyframe, 0, model.nkey - 1)


def state_of(model: mujoco.MjModel, keyframe: object = None, qpos: object = None) -> mujoco.MjData:
    """The model in a pose, at rest, with its mass matrix, its constraints but for contacts, and its weight.

    Arguments are those of `Pose`. TypeError or ValueError for a keyframe or positions that the model cannot have, or
    both.
    """
    if keyframe is not None and qpos is not None:
        raise ValueError(f"keyframe = {shown(keyframe)} and qpos are both given; give one of them")
    data = mujoco.MjData(model)
    if keyframe is not None:
        mujoco.mj_resetDataKeyframe(model, data, keyframe_id(model, keyframe))
        data.qvel[:] = 0
    elif qpos is not None:
        data.qpos[:] = require_array("qpos", qpos, (model.nq,))
        if np.abs(data.qpos).max(initial=0) > 1e10:
            raise ValueError("qpos holds a value outside the valid range -1e10 to 1e10")
        mujoco.mj_normalizeQuat(model, data.qpos)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_flex(model, data)
        mujoco.mj_tendon(model, data)
        mujoco.mj_transmission(model, data)
        mujoco.mj_makeM(model, data)
        mujoco.mj_factorM(model, data)
        mujoco.mj_makeConstraint(model, data)
        mujoco.mj_fwdVelocity(model, data)
    return data
