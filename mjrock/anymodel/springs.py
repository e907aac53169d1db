"""The springs, dampers and dry friction of a model in a pose, and what they add along an approach.

Along the approach a spring of the model adds u^T K u to the stiffness of the contact, and a damper u^T D u to its
dashpot, with u the velocity of the joints for a unit speed of the contact. Dry friction, MuJoCo's `frictionloss`,
resists with up to the sum of |u| times that of each joint.
"""

from __future__ import annotations

import mujoco
import numpy as np

from ..quantities import Array, Integers

JOINT, TENDON, ACTUATOR = mujoco.mjtObj.mjOBJ_JOINT, mujoco.mjtObj.mjOBJ_TENDON, mujoco.mjtObj.mjOBJ_ACTUATOR
Owner = tuple[mujoco.mjtObj, int]
"""What holds: a joint, a tendon or an actuator, and its number."""


class JointSprings:
    """The springs and dampers of a model in its pose.

    Attributes:
        owners: all joints, then the tendons and actuators that have a spring, a damper or dry friction.
        joint_of: the joint of each degree of freedom, shape (nv,).
        joint_k: stiffness of each joint [N/m or N m], shape (njnt,).
        dof_c: damping of each degree of freedom [N s/m or N m s], shape (nv,).
        stretch: stretch of each tendon and actuator for a unit velocity of each degree of freedom, shape (n, nv).
        k, c: stiffness and damping of each tendon and actuator, shape (n,).
        dof_dry: dry friction of each degree of freedom [N or N m], shape (nv,).
        dry: dry friction of each tendon, and 0 of each actuator, shape (n,).
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        servo = model.actuator_biastype == int(mujoco.mjtBias.mjBIAS_AFFINE)
        servo_k, servo_c = (np.where(servo, np.maximum(-model.actuator_biasprm[:, n], 0.0), 0.0) for n in (1, 2))
        k = np.concatenate([_first(model.tendon_stiffness, model.ntendon), servo_k])
        c = np.concatenate([_first(model.tendon_damping, model.ntendon), servo_c])
        stretch = np.vstack(
            [
                _dense(data.ten_J, model.ten_J_rownnz, model.ten_J_rowadr, model.ten_J_colind, model.nv),
                _dense(data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind, model.nv),
            ]
        )
        dry = np.concatenate([_first(model.tendon_frictionloss, model.ntendon), np.zeros(model.nu)])
        acts = (k > 0) | (c > 0) | (dry > 0)
        others = [(TENDON, i) for i in range(model.ntendon)] + [(ACTUATOR, i) for i in range(model.nu)]
        self.owners: list[Owner] = [(JOINT, i) for i in range(model.njnt)] + [others[i] for i in np.flatnonzero(acts)]
        self.joint_of = np.array(model.dof_jntid, dtype=np.int64)
        self.joint_k = _first(model.jnt_stiffness, model.njnt)
        self.dof_c, self.dof_dry = _first(model.dof_damping, model.nv), _first(model.dof_frictionloss, model.nv)
        self.stretch, self.k, self.c, self.dry = stretch[acts], k[acts], c[acts], dry[acts]

    def along(self, motion: Array) -> tuple[Array, Array]:
        """What each owner adds to stiffness [N/m] and damping [N s/m] of a contact, shape (owners,), where `motion` is
        the velocity of the joints for a unit speed of the contact, shape (nv,)."""
        squares, joints = motion**2, len(self.joint_k)
        moved = (self.stretch @ motion) ** 2
        joint_k = self.joint_k * np.bincount(self.joint_of, squares, joints)
        joint_c = np.bincount(self.joint_of, self.dof_c * squares, joints)
        return np.concatenate([joint_k, self.k * moved]), np.concatenate([joint_c, self.c * moved])

    def friction(self, motion: Array) -> Array:
        """The dry friction of each owner along the approach of a contact [N], shape (owners,)."""
        joints = np.bincount(self.joint_of, self.dof_dry * np.abs(motion), len(self.joint_k))
        return np.concatenate([joints, self.dry * np.abs(self.stretch @ motion)])


def _first(values: Array, count: int) -> Array:
    """The linear coefficient of each, shape (count,)."""
    return np.array(np.reshape(values, (count, -1))[:, 0] if count else np.zeros(0), dtype=float)


def _dense(values: Array, count: Integers, start: Integers, columns: Integers, width: int) -> Array:
    """A sparse matrix with all of its zeros."""
    dense = np.zeros((len(count), width))
    if dense.size:
        mujoco.mju_sparse2dense(dense, np.ravel(values), count, start, np.ravel(columns))
    return dense
