"""The engine's own memory: `mj_step` by its address, and the arrays and options of a model that steps change.

The compiled loop calls the functions of MuJoCo's library directly, with the addresses of a model and its data. The
arrays are the views of MuJoCo's Python bindings. `opt.timestep` and `opt.impratio` have no such view. `opt.gravity` has
one, and MuJoCo's own description of its structures says how far before it they lie. This is proved for every model, by
writing through the bindings and reading at the address, before anything is written there.
"""

from __future__ import annotations

import ctypes
import sys
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ..quantities import Array, Integers
from .rows import ContactRows

TIMESTEP, IMPRATIO = 0, 1
"""Places of the two options in `EngineArrays.options`."""
TYPES = {"mjtNum": ctypes.c_double, "int": ctypes.c_int}
"""Types of C by their names in MuJoCo's description of mjOption."""
LIBRARIES = {"linux": "libmujoco.so.*", "darwin": "libmujoco.*.dylib", "win32": "mujoco.dll"}
"""File names of MuJoCo's library in its Python package, by `sys.platform`."""


class EngineArrays(NamedTuple):
    """The functions of the engine, and the arrays of a model and its data, that a compiled loop uses.

    Args:
        step, forward, finish: `mj_step`, `mj_forward` and `mj_step2`, which take the two addresses.
        accelerate: `mj_forwardSkip`, which takes them, the stage that is already done, and 1.
        model, data: addresses.
        options: timestep [s] and impratio [-].
        pose: of all joints, shape (n nq,).
        velocity, acceleration, applied: of all joints, shape (n nv,).
        guess: the acceleration that the engine starts its search from, shape (n nv,).
        rows: of all pairs.
        dimension: of all pairs, 1 without friction and 3 with it, shape (m,).
        plastic: state of the tendons that yield: between which lengths each is slack [m], shape (2 yielding,).
        upper: index in `plastic` of the upper length of each tendon; 0 for one that does not yield.
    """

    step: Any
    forward: Any
    finish: Any
    accelerate: Any
    model: int
    data: int
    options: Array
    pose: Array
    velocity: Array
    acceleration: Array
    guess: Array
    applied: Array
    rows: ContactRows
    dimension: Integers
    plastic: Array
    upper: Integers

    @classmethod
    def from_model(cls, model: mujoco.MjModel, data: mujoco.MjData) -> EngineArrays:
        """The memory of a model and its data, which have to outlive it.

        Raises:
            RuntimeError: if the options are not where they should be, or the library is not found.
        """
        return cls(
            **functions(),
            model=model._address,
            data=data._address,
            options=_options(model),
            pose=data.qpos,
            velocity=data.qvel,
            acceleration=data.qacc,
            guess=data.qacc_warmstart,
            applied=data.qfrc_applied,
            rows=ContactRows(model.pair_solref, model.pair_solimp, model.pair_solreffriction),
            dimension=model.pair_dim,
            plastic=data.plastic,
            upper=model.tendon_plasticadr.astype(np.int64) + 1,
        )


@cache
def functions() -> dict[str, Any]:
    """The functions of `EngineArrays` by their names there, of the library that the bindings use.

    Raises:
        RuntimeError: if the library is not found, or is not the one of the bindings.
    """
    path = library_file(Path(mujoco.__file__).parent)
    library = ctypes.CDLL(str(path))
    library.mj_versionString.restype = ctypes.c_char_p
    version = library.mj_versionString().decode()
    if version != mujoco.mj_versionString():
        raise RuntimeError(f"{path} is version {version} and not {mujoco.mj_versionString()}; reinstall mujoco")
    library_functions = {
        "step": library.mj_step,
        "forward": library.mj_forward,
        "finish": library.mj_step2,
        "accelerate": library.mj_forwardSkip,
    }
    addresses = (ctypes.c_void_p, ctypes.c_void_p)
    for name, function in library_functions.items():
        function.argtypes = (*addresses, ctypes.c_int, ctypes.c_int) if name == "accelerate" else addresses
        function.restype = None
    return library_functions


def library_file(folder: Path) -> Path:
    """MuJoCo's library in the folder of its Python package.

    Raises:
        RuntimeError: if there is none, or more than one.
    """
    pattern = LIBRARIES.get(sys.platform, LIBRARIES["linux"])
    files = sorted(folder.glob(pattern))
    if len(files) != 1:
        raise RuntimeError(
            f"{len(files)} files match {pattern} in {folder}, where the library of MuJoCo {mujoco.__version__} is "
            "expected; reinstall mujoco"
        )
    return files[0]


@cache
def option_offsets() -> dict[str, int]:
    """Bytes from the start of MuJoCo's mjOption to its timestep, impratio and gravity, by its own description.

    Raises:
        RuntimeError: if the description is missing, lacks one of these fields, has types that mjrock does not know, or
            has gravity before the other two.
    """
    try:
        from mujoco.introspect.structs import STRUCTS  # a tenth of a second, once a process that simulates
    except ImportError as error:
        raise RuntimeError(
            f"MuJoCo {mujoco.__version__} lacks its module mujoco.introspect.structs, which says where its options lie "
            f"in memory ({error}); reinstall mujoco"
        ) from None
    try:
        fields = [(field.name, _type(field.type)) for field in STRUCTS["mjOption"].fields]
        described: Any = type("mjOption", (ctypes.Structure,), {"_fields_": fields})
        at = {name: getattr(described, name).offset for name in ("timestep", "impratio", "gravity")}
        if at["gravity"] != max(at.values()):
            raise KeyError("gravity comes first")
    except (AttributeError, KeyError) as error:
        raise RuntimeError(
            f"mujoco.introspect.structs of MuJoCo {mujoco.__version__} describes mjOption in a way that mjrock does "
            f"not know ({type(error).__name__}: {error}); use a version of MuJoCo that mjrock has been tested with"
        ) from None
    return at


def _type(described: Any) -> Any:
    """The type of ctypes for a number or an array of MuJoCo's description."""
    if not hasattr(described, "extents"):
        return TYPES[described.name]
    kind = _type(described.inner_type)
    for extent in reversed(described.extents):
        kind *= extent
    return kind


def _options(model: mujoco.MjModel) -> Array:
    """A view of timestep and impratio in the memory of the model, once it is proved to be one."""
    at = option_offsets()
    address = model.opt.gravity.ctypes.data - at["gravity"]
    content = np.ctypeslib.as_array((ctypes.c_ubyte * at["gravity"]).from_address(address))
    view = np.ndarray(2, float, content, at["timestep"], strides=(at["impratio"] - at["timestep"],))
    before = model.opt.timestep, model.opt.impratio
    proved = True
    for probe in ((0.123, 45.6), (7.89e-5, 0.321)):
        model.opt.timestep, model.opt.impratio = probe
        proved = proved and (view[TIMESTEP], view[IMPRATIO]) == probe
    model.opt.timestep, model.opt.impratio = before
    if not proved:
        raise RuntimeError(
            f"MuJoCo {mujoco.__version__} does not keep opt.timestep and opt.impratio where mjrock expects them, "
            f"{at['gravity'] - at['timestep']} and {at['gravity'] - at['impratio']} bytes before opt.gravity; use a "
            "version of MuJoCo that mjrock has been tested with"
        )
    return view
