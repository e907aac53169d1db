"""Features of the MuJoCo version, 3.3.2 or newer. A flag or a field that a version lacks counts as not set.

* Before 3.3.3 `mj_crb` makes the mass matrix; `mj_makeM` does so since.
* Before 3.4 two boxes are found half as deep as they are.
* Before 3.5 the larger margin and gap of two geoms count; since, they add up.
* Before 3.8 a flag enables several points of two meshes; since, one disables them.
* Before 3.9 a contact acts from its margin less its gap on; since, it acts from its margin on, and pulls up to the gap.
* Since 3.11 contacts have an adhesion, and surfaces move.
"""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np

from .checks import Array, Integers

MAJOR_MINOR = tuple(int(part) for part in mujoco.__version__.split(".")[:2])
"""The version: major and minor."""
DISABLE, ENABLE = mujoco.mjtDisableBit, mujoco.mjtEnableBit
BOXES_HALF_AS_DEEP = MAJOR_MINOR < (3, 4)
MARGINS_ADD_UP = MAJOR_MINOR >= (3, 5)
GAP_IS_BEYOND = MAJOR_MINOR >= (3, 9)
make_mass_matrix: Callable[[mujoco.MjModel, mujoco.MjData], None] = getattr(mujoco, "mj_makeM", mujoco.mj_crb)


def disable_bits(*names: str) -> int:
    """The bits of the flags of these names that disable something."""
    return sum(int(getattr(DISABLE, f"mjDSBL_{name}", 0)) for name in names)


def enable_bits(*names: str) -> int:
    """The bits of the flags of these names that enable something."""
    return sum(int(getattr(ENABLE, f"mjENBL_{name}", 0)) for name in names)


NO_SPRINGS, NO_DAMPERS = (disable_bits(name) or disable_bits("PASSIVE") for name in ("SPRING", "DAMPER"))
"""Bits of the flags that disable springs, and dampers."""


def has_several_points(option: mujoco.MjOption) -> bool:
    """Whether the finder makes several points of two meshes or boxes."""
    if disable_bits("MULTICCD"):
        return not option.disableflags & disable_bits("MULTICCD")
    return bool(option.enableflags & enable_bits("MULTICCD"))


def give_several_points(option: mujoco.MjOption) -> None:
    """Let the finder make several points of two meshes or boxes."""
    option.disableflags &= ~disable_bits("MULTICCD")
    if not disable_bits("MULTICCD"):
        option.enableflags |= enable_bits("MULTICCD")


def field(model: mujoco.MjModel, name: str, count: int) -> Array:
    """A field of a model, shape (count, ...); zeros where MuJoCo has none of this name."""
    return np.array(getattr(model, name, np.zeros(count)))


def stretches_of_tendons(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """Jacobian of the lengths of tendons, shape (ntendon, nv)."""
    if hasattr(model, "ten_J_rownnz"):
        return dense(data.ten_J, model.ten_J_rownnz, model.ten_J_rowadr, model.ten_J_colind, model.nv)
    if mujoco.mj_isSparse(model):
        return dense(data.ten_J, data.ten_J_rownnz, data.ten_J_rowadr, data.ten_J_colind, model.nv)
    return np.array(data.ten_J).reshape(model.ntendon, model.nv)


def dense(values: Array, count: Integers, start: Integers, columns: Integers, width: int) -> Array:
    """A sparse matrix with all of its zeros."""
    matrix = np.zeros((len(count), width))
    if matrix.size:
        mujoco.mju_sparse2dense(matrix, np.ravel(values), count, start, np.ravel(columns))
    return matrix


def actuators(model: mujoco.MjModel) -> int:
    """How many actuators a model has."""
    return int(getattr(model, "nactuator", model.nu))
