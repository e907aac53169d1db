"""compas_cra on its own samples: which stand by rigid-block equilibrium, and which by coupled rigid-block analysis.

`pip install compas_cra`, then `python scripts/peers/codes/cra.py FOLDER`, a folder such as src/compas_cra/data/samples
of its repository. It needs nothing else of this one. Supports, friction and tolerances are those of its examples.
"""

from __future__ import annotations

import contextlib
import io
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import compas
from compas_cra.algorithms import assembly_interfaces_numpy
from compas_cra.datastructures import CRA_Assembly
from compas_cra.equilibrium import cra_solve, rbe_solve

NAMES = (
    *("cubes", "H", "A", "type-a", "type-b", "type-c", "type-d", "shelf-stable"),
    *("shelf", "shelf-s1", "shelf-s2", "shelf-s3", "bridge", "snake"),
)


def verdict(path: Path, solve: Callable[..., Any]) -> str:
    """Whether a solver finds forces that bear an assembly."""
    shelf, snake, bridge = (path.stem.startswith(name) for name in ("shelf", "snake", "bridge"))
    assembly = compas.json_load(str(path)).copy(cls=CRA_Assembly)
    assembly.set_boundary_conditions([0] if shelf or snake or path.stem == "cubes" else [0, 1])
    fine = shelf or snake or bridge
    found = {"amin": 1e-6, "tmax": 1e-4} if fine else {"nmax": 10, "amin": 1e-2, "tmax": 1e-2}
    options: dict[str, float] = {"mu": 0.9 if shelf or bridge else 0.7 if snake else 0.84, "density": 1.0}
    if solve is cra_solve:
        options |= {"d_bnd": 1e-1, "eps": 1e-3} if fine else {"d_bnd": 1e-2, "eps": 1e-4}
    with contextlib.redirect_stdout(io.StringIO()):
        assembly_interfaces_numpy(assembly, **found)
        try:
            solve(assembly, **options)
        except ValueError as error:
            return str(error)
    return "stands"


if __name__ == "__main__":
    for name in NAMES:
        file = Path(sys.argv[1]) / f"{name}.json"
        print(f"{name}: equilibrium: {verdict(file, rbe_solve)}; CRA: {verdict(file, cra_solve)}", flush=True)
