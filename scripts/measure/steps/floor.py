"""The explicit step of sprung joints in the plane as plain C, compiled where a compiler is found: what a step may cost.

It has the law of the joints alone: no ends of faces, no touches, no accounts, see `floor.c`.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import time
from pathlib import Path

import numpy as np

from mjrock.distinct.system import System
from mjrock.quantities import Array

SOURCE = Path(__file__).with_suffix(".c")
OPTIONS = ("-O3", "-march=native", "-fno-math-errno", "-mprefer-vector-width=512", "-shared", "-fPIC")
OF_LINES = ("at", "origin", "between", "normal")
LINES = (*(f"{name}_{axis}" for name in OF_LINES for axis in "xz"), "k", "c", "k_s", "c_s", "friction")
KEPT = ("grip", "force_x", "force_z", "moment", "moment_of_face")
BODIES = ("mass", "inverse_inertia", "rest_x", "rest_z")
MOVED = ("x", "z", "angle", "sine", "versine", "speed_x", "speed_z", "spin", "force_x", "force_z", "moment")
NUMBERS, INTEGERS = ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int)


def is_there() -> bool:
    """Whether there is a compiler."""
    return shutil.which("gcc") is not None


def structure(names: tuple[str, ...], integers: tuple[str, ...] = ()) -> type[ctypes.Structure]:
    """The structure of C of some arrays after their length."""
    fields = [(name, INTEGERS) for name in integers] + [(name, NUMBERS) for name in names]
    return type("Table", (ctypes.Structure,), {"_fields_": [("count", ctypes.c_int), *fields]})


class Floor:
    """The system of a masonry of the plane with sprung joints as arrays of C."""

    def __init__(self, system: System, folder: Path) -> None:
        made = folder / "floor.so"
        subprocess.run(["gcc", *OPTIONS, str(SOURCE), "-o", str(made), "-lm"], check=True)
        self.library = ctypes.CDLL(str(made))
        lines, bodies, n = system.lines, system.bodies, len(system.bodies)
        self.line = {name: np.zeros(len(lines)) for name in (*LINES, *KEPT)}
        for name in OF_LINES:
            for i, axis in enumerate("xz"):
                self.line[f"{name}_{axis}"][:] = lines[name][:, i]
        for name in ("k", "c", "k_s", "c_s", "friction"):
            self.line[name][:] = lines[name]
        self.line["grip"][:] = lines["shear_state"][:, 0]
        self.ends = [np.where(lines[name] < 0, n, lines[name]).astype(np.intc) for name in ("body", "face")]
        self.body = {name: np.zeros(n + 1) for name in (*BODIES, *MOVED)}
        self.body["mass"][:] = np.append(bodies["mass"], 1.0)
        self.body["inverse_inertia"][:n] = bodies["inverse_inertia"][:, 0, 0]
        self.body["angle"][:n] = bodies["angle"]
        self.body["sine"][:], self.body["versine"][:] = np.sin(self.body["angle"]), 1 - np.cos(self.body["angle"])
        for i, axis in enumerate("xz"):
            self.body[f"rest_{axis}"][:n], self.body[axis][:n] = bodies["rest"][:, i], bodies["place"][:, i]
        listed = (
            [np.flatnonzero(self.ends[0] == i) for i in range(n)],
            [np.flatnonzero(self.ends[1] == i) for i in range(n)],
        )
        of = [np.concatenate([own, -1 - other]) for own, other in zip(*listed, strict=True)]
        self.listed = np.concatenate(of).astype(np.intc)
        self.first = np.cumsum([0, *map(len, of)]).astype(np.intc)

    def nanoseconds(self, h: float, push: float, steps: int, *, vectors: bool) -> float:
        """Processor time of a line and step [ns]."""
        lines = structure((*LINES, *KEPT), ("body", "face"))(
            len(self.ends[0]), *map(_integers, self.ends), *(_numbers(self.line[name]) for name in (*LINES, *KEPT))
        )
        bodies = structure((*BODIES, *MOVED))(
            len(self.body["mass"]), *(_numbers(self.body[name]) for name in (*BODIES, *MOVED))
        )
        given = ctypes.byref(lines), ctypes.byref(bodies), ctypes.c_double(h), ctypes.c_double(push), steps
        begun = time.process_time()
        if vectors:
            self.library.by_body(*given, _integers(self.first), _integers(self.listed))
        else:
            self.library.one_loop(*given)
        return (time.process_time() - begun) / (steps * len(self.ends[0])) * 1e9

    @property
    def x(self) -> Array:
        """Displacements of the bodies [m]."""
        return self.body["x"][:-1]


def _numbers(values: Array) -> object:
    return values.ctypes.data_as(NUMBERS)


def _integers(values: np.ndarray) -> object:
    return values.ctypes.data_as(INTEGERS)
