"""The same rest on any processor: random arches, domes and vaults under the kernels of OpenBLAS for several processors.

Each structure that limit analysis holds is brought to rest on joints of 1e8 to 1e12 N/m3, with shear stiffness or
rigid along their faces. Prints, of each kernel, how many are refused, how many differ from the first kernel, and how
far: poses over the largest displacement, forces over the largest normal force. Kernels that the machine does not carry
out are left out. Each structure that is refused is also run with damping from the drawn pose, with and without a push.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock.machine import kernels
from mjrock.problem.masonry.limit.statics import falling
from mjrock.quantities import Array
from mjrock.scene.masonry import scene_of_masonry
from scripts.shared import cli

KERNELS = ("Haswell", "Nehalem", "SkylakeX", "Sandybridge")
COUNT, QUICK = 500, 3
EQUAL = 1e-9
"""Largest difference up to which two answers count as equal [-]."""
STIFFEST = 1e12
"""Largest stiffness of the joints [N/m3]."""
PUSHES, DAMPING, DURATION = (0.0, 0.02), 5.0, 5.0
"""Velocities with which damped runs start [m/s], their damping by mass [1/s], and how long they take [s]."""
ONE = "ONE_KERNEL"
"""Environment variable of a process that answers under its own kernel."""


class Rest(NamedTuple):
    """One structure at rest.

    Args:
        label: of the structure.
        refused: why it was refused, or "".
        pose: shape (free nq,) [m, rad, -].
        force: normal force and friction of each contact line [N].
    """

    label: str
    refused: str
    pose: Array
    force: Array


def structure(seed: int, stiffest: float = STIFFEST) -> tuple[str, mr.Masonry]:
    """An arch, a vault or a dome by lot, half of them with a shear stiffness."""
    rng = np.random.default_rng(seed)
    k_n, share = float(10 ** rng.uniform(8, np.log10(stiffest))), float(rng.choice([1.0, 0.4]))
    k_s = share * k_n if rng.random() < 0.5 else None
    joints = mr.Dry(k_n, friction=float(rng.uniform(0.5, 0.8)), k_s=k_s)
    kind, thin, radius = seed % 5, float(rng.uniform(0.11, 0.18)), float(rng.uniform(1.0, 8.0))
    if kind == 3:
        masonry = mr.Masonry.barrel_vault(radius, thin * radius, 0.4 * radius, 0.2 * radius, courses=9, joints=joints)
        return f"vault of {radius:.3g} m, k_n {k_n:.1e}", masonry
    if kind == 4:
        lunes, hoops = int(rng.integers(6, 11)), int(rng.integers(3, 6))
        return f"dome of {lunes} by {hoops}, k_n {k_n:.1e}", mr.Masonry.dome(
            radius, thin * radius, lunes, hoops, joints=joints
        )
    count = int(rng.integers(7, 90))
    return f"arch of {count}, t/R {thin:.4f}, k_n {k_n:.1e}", mr.Masonry.arch(
        radius, thin * radius, voussoirs=count, joints=joints
    )


def rest(seed: int, stiffest: float = STIFFEST) -> Rest | None:
    """A structure at rest, or None where limit analysis does not hold it."""
    label, masonry = structure(seed, stiffest)
    if falling(masonry):
        return None
    scene = scene_of_masonry(masonry)
    try:
        pose, friction = scene.rest_state
    except ValueError as error:
        return Rest(label, str(error), np.zeros(0), np.zeros(0))
    return Rest(label, "", pose.ravel(), np.append(scene.contacts.k * scene.bears, friction.ravel()))


def damped(seed: int, stiffest: float) -> list[object]:
    """What a structure does in damped runs from the drawn pose, with each push."""
    label, masonry = structure(seed, stiffest)
    ends: list[object] = []
    for push in PUSHES:
        velocity = np.zeros((len(masonry.free), masonry.freedom.nv))
        velocity[:, 0] = push
        case = mr.MasonryCase(masonry, DURATION, settled=False, velocity=velocity)
        answer = mr.solve_explicit(case, mass_damping=DAMPING)
        still = np.abs(answer.pose[-1] - answer.pose[-2]).max() / (answer.t[-1] - answer.t[-2])
        ends.append(f"{len(answer.fallen)} blocks fall" if answer.fallen else f"stands, moves by {still:.0e} m/s")
    return [f"{label}, seed {seed}", *ends]


def answers(seeds: Sequence[int], stiffest: float, out: Path) -> None:
    """Write what this process answers, under its own kernel."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = {str(seed): answer for seed in seeds if (answer := rest(seed, stiffest)) is not None}
    arrays = {f"{seed} {name}": getattr(answer, name) for seed, answer in found.items() for name in Rest._fields}
    np.savez(out, kernel=kernels().get("numpy", "another"), **arrays)


def under(kernel: str, seeds: Sequence[int], stiffest: float, out: Path) -> dict[str, Rest] | None:
    """The answers under a kernel, by seed, or None where this machine does not carry it out."""
    path = out / f"{kernel}.npz"
    setting = os.environ | {"OPENBLAS_CORETYPE": kernel, "OPENBLAS_NUM_THREADS": "1", ONE: str(path)}
    command = [sys.executable, "-m", "scripts.checks.rest_on_processors", str(stiffest), *map(str, seeds)]
    subprocess.run(command, env=setting, cwd=Path(__file__).resolve().parents[2], check=False)
    if not path.exists():
        return None
    with np.load(path) as found:
        if found["kernel"] != kernel:
            return None
        names = dict.fromkeys(name.split()[0] for name in found if name != "kernel")
        return {seed: Rest(*(found[f"{seed} {field}"] for field in Rest._fields)) for seed in names}


def apart(first: Rest, other: Rest) -> float:
    """The largest difference of pose and forces of two answers, each over what is largest of its kind [-]."""
    if first.refused or other.refused:
        return 0.0 if str(first.refused) == str(other.refused) else np.inf
    drawn = np.round(first.pose)  # 1 of a quaternion, and 0
    moved = np.abs(first.pose - drawn).max()
    return float(
        max(np.abs(first.pose - other.pose).max() / moved, np.abs(first.force - other.force).max() / first.force.max())
    )


def compared(
    seeds: Sequence[int], out: Path, named: Sequence[str] = KERNELS, stiffest: float = STIFFEST
) -> tuple[list[list[object]], list[int]]:
    """A row for each kernel that the machine carries out, how many stand, are refused, and the largest difference, and
    the seeds that any of them refuses."""
    found = {}
    for kernel in tqdm(named, desc="kernels", disable=None, leave=False):
        answer = under(kernel, seeds, stiffest, out)
        if answer is not None:
            found[kernel] = answer
    first = next(iter(found.values()))
    rows: list[list[object]] = []
    for kernel, answer in found.items():
        refused = [str(one.label) for one in answer.values() if one.refused]
        differences = {str(first[seed].label): apart(first[seed], one) for seed, one in answer.items()}
        worst = max(differences, key=lambda label: differences[label])
        beyond = sum(difference > EQUAL for difference in differences.values())
        largest = f"{differences[worst]:.1e}"
        rows.append([kernel, len(answer), len(refused), beyond, largest, worst, "; ".join(refused)])
    return rows, sorted({int(seed) for answer in found.values() for seed, one in answer.items() if one.refused})


def main(argv: Sequence[str] | None = None) -> None:
    """Compare the kernels, and print the table."""
    options = cli.parser(__doc__, "rest_on_processors")
    options.add_argument("--first", type=int, default=0, metavar="SEED", help="first seed, for other structures")
    options.add_argument("--count", type=int, default=COUNT, metavar="N", help="how many structures")
    options.add_argument("--stiffest", type=float, default=STIFFEST, metavar="K_N", help="largest stiffness [N/m3]")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    count, named = (QUICK, KERNELS[:2]) if args.quick else (args.count, KERNELS)
    seeds = range(args.first, args.first + count)
    with tempfile.TemporaryDirectory() as kept:
        rows, refused = compared(seeds, Path(kept), named, args.stiffest)
    header = ["kernel", "held", "refused", f"beyond {EQUAL:g}", "largest difference [-]", "of", "refused ones"]
    tables = [cli.table(header, rows)]
    if refused:
        pushes = [f"pushed by {push:g} m/s" for push in PUSHES]
        tables.append(cli.table(["refused", *pushes], [damped(seed, args.stiffest) for seed in refused]))
    cli.report(out / "rest_on_processors", "\n\n".join(tables))


if __name__ == "__main__":
    if ONE in os.environ:
        answers([int(seed) for seed in sys.argv[2:]], float(sys.argv[1]), Path(os.environ[ONE]))
    else:
        sys.exit(cli.run(main))
