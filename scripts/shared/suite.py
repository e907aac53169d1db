"""What the earthquake studies share: the suite of ground motions, the analyses of both solvers, and how a run went."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import mjrock as mr
from scripts.shared import cli

STILL = 0.01
"""Peak rotation below which a wall is said to have stayed at rest, in multiples of alpha [-]."""
STIFF = 3e9
"""Interface stiffness of base and side for a nearly rigid base [N/m3]: the upper end of the paper's Table 1."""
READERS: Mapping[str, Callable[[Path], mr.GroundMotion]] = {
    ".at2": mr.GroundMotion.from_at2,
    ".sac": lambda path: mr.GroundMotion.from_sac(path, "cm/s2"),
}
SETTLING = 5.0
"""Time that a wall is followed after the record [s]."""
OPTIONS: Mapping[str, Mapping[str, object]] = {
    "analytical": {"rtol": 1e-8, "output_step": 0.05},
    "MuJoCo": {"output_step": 0.05},
}
"""Options of both solvers: what is kept of a run is its peak and its outcome."""
SOLVERS = tuple(OPTIONS)


def parser(description: str | None, out: str, *, records: bool = True) -> argparse.ArgumentParser:
    """A script's parser with the options of an earthquake study, `records` among them or not."""
    made = cli.parser(description, out)
    if records:
        made.add_argument("--records", type=Path, help="folder of .at2 and .sac records; else synthetic ones")
    made.add_argument("--workers", type=int, help="processes; else one for each processor")
    return made


def synthetic(count: int, duration: float = 15.0) -> list[mr.GroundMotion]:
    """Synthetic records of a duration [s]."""
    return [mr.GroundMotion.synthetic(3.0, duration, seed=seed) for seed in range(count)]


def motions(args: argparse.Namespace, count: int, quick: int) -> list[mr.GroundMotion]:
    """The records of the folder that a script is given, or `count` synthetic ones; `quick` of them, and synthetic ones
    that are short, in its quick mode."""
    if args.records is None:
        return synthetic(quick, 5.0) if args.quick else synthetic(count)
    files = sorted(path for path in args.records.iterdir() if path.suffix.lower() in READERS)
    if not files:
        raise ValueError(f"{args.records} holds no record; the endings that are read are {', '.join(READERS)}")
    return [READERS[path.suffix.lower()](path) for path in files[: quick if args.quick else None]]


def to_peak(motion: mr.GroundMotion, pga: float) -> mr.GroundMotion:
    """The motion scaled to a peak ground acceleration in g."""
    return motion.scaled(peak=pga * mr.GRAVITY)


def analysis(
    wall: mr.Block,
    motion: mr.GroundMotion,
    solver: str,
    *,
    k_n: float,
    side_stop: bool = True,
    settling: float = SETTLING,
) -> mr.Analysis:
    """A wall at rest under a ground motion, in rocking theory or in MuJoCo with the calibrated damping law."""
    e = mr.Restitution.from_geometry(wall.alpha)
    case = mr.Case(wall, 0.0, motion.duration + settling, side_stop=side_stop, motion=motion)
    contacts = mr.Contacts.from_law(wall, e, k_base=k_n, k_side=k_n if side_stop else None, law=mr.CALIBRATED)
    return mr.Analysis(case, solver, e=e, contacts=contacts, options=OPTIONS[solver])


def verdict(row: Mapping[str, Any]) -> str:
    """Whether the wall of a row rests, rocks or overturns."""
    if row["outcome"] == mr.Outcome.OVERTURNED.value:
        return "overturns"
    return "rests" if float(row["peak_over_alpha"]) < STILL else "rocks"


def in_pairs(rows: Sequence[Mapping[str, Any]]) -> tuple[NDArray[np.str_], NDArray[np.float64]]:
    """Verdicts and peak rotations in multiples of alpha of rows that follow each other in pairs, shapes (n, 2); the
    peak of a wall that overturns is infinite."""
    ends = np.reshape([verdict(row) for row in rows], (-1, 2))
    return ends, np.reshape([float(row["peak_over_alpha"]) for row in rows], (-1, 2))
