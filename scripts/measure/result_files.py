"""What a whole result takes as a file of each format: its size, and times to write and to read it.

HDF5 is `Response.save` and `mjrock.load`. An .npz of NumPy has the same arrays and texts, without units, dimensions and
names that a reader finds. NetCDF is what xarray writes of `to_xarray`, and Parquet what pandas writes of the columns of
`Response.csv`: the motion alone, without the case and the end. pickle holds all, and executes what is in it. Times are
of the processor; that of an .npz is without the making of its texts.
"""

from __future__ import annotations

import argparse
import importlib
import io
import pickle
import statistics
import sys
import time
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

import mjrock as mr
from scripts.shared import cli

HEADER = ("answer", "format", "size [kB]", "written in [ms]", "read in [ms]", "to the bit", "whole")
WALL = mr.Block.from_size(0.6, 4.2)
Format = tuple[Callable[[Path], object], Callable[[Path], object], bool, bool]
"""What writes and reads a file, whether numbers are kept to the bit, and whether it is a whole result."""


def answers(quick: bool) -> dict[str, mr.Response]:
    """A wall, an arch and a façade in space, shaken, with their forces."""
    motion = mr.GroundMotion.synthetic(peak=2.0, duration=2.0 if quick else 10.0, seed=1)
    duration = 0.2 if quick else 10.0
    contacts = mr.Contacts.from_law(WALL, mr.Restitution.from_geometry(WALL), k_base=5e8, k_side=5e8)
    wall = mr.simulate(mr.Case(WALL, 0.02, duration, motion=motion), contacts, forces=True)
    arch = mr.Masonry.arch(radius=5.0, thickness=0.9, voussoirs=19, k_s=5e9)
    shaken = mr.solve_explicit(mr.MasonryCase(arch, duration, motion=motion), forces=True, output_step=5e-3)
    dome = mr.Masonry.dome(3.0, 0.6, lunes=16, hoops=6, k_s=5e9)
    resting = mr.solve_explicit(mr.MasonryCase(dome, 0.02 if quick else 0.5, motion=motion), forces=True)
    return {"wall": wall, "arch of 19": shaken, "dome of 97": resting}


def formats(answer: mr.Response, folder: Path) -> dict[str, Format]:
    """The formats whose libraries are installed, by their names."""
    import h5py

    with h5py.File(answer.save(folder / "whole.h5")) as file:
        names: list[str] = []
        file.visit(names.append)
        held = {name.replace("/", "."): file[name][()] for name in names if isinstance(file[name], h5py.Dataset)}
    texts = {
        name: one.astype(str) if getattr(one, "dtype", np.dtype(float)).hasobject else one for name, one in held.items()
    }
    columns = answer.csv()

    def read_npz(path: Path) -> object:
        with np.load(path) as archive:
            return {name: archive[name] for name in archive}

    found: dict[str, Format] = {
        "HDF5, Response.save": (answer.save, mr.load, True, True),
        ".npz of NumPy": (lambda path: np.savez_compressed(path, **texts), read_npz, True, True),
        "pickle": (
            lambda path: path.write_bytes(pickle.dumps(answer)),
            lambda path: pickle.loads(path.read_bytes()),
            True,
            True,
        ),
        "csv": (answer.csv, lambda path: np.genfromtxt(path, delimiter=",", names=True), True, False),
    }
    try:
        import xarray

        made = answer.to_xarray()
        found["NetCDF, xarray"] = (
            lambda path: made.to_netcdf(path, engine="h5netcdf"),
            lambda path: xarray.load_dataset(path, engine="h5netcdf"),
            True,
            False,
        )
        import pandas

        importlib.import_module("pyarrow")  # by which pandas writes Parquet
        frame = pandas.read_csv(io.StringIO(columns), comment="#")
        found["Parquet, pandas"] = (frame.to_parquet, pandas.read_parquet, True, False)
    except ImportError as error:
        print(f"left out: {error}")
    return found


def took(call: Callable[[Path], object], path: Path, times: int) -> float:
    """The median processor time of a call [ms]."""
    found = []
    for _ in range(times):
        begun = time.process_time()
        call(path)
        found.append(1e3 * (time.process_time() - begun))
    return statistics.median(found)


def measured(name: str, answer: mr.Response, folder: Path, times: int) -> list[list[object]]:
    """The rows of an answer."""
    rows: list[list[object]] = []
    for kind, (write, read, exact, whole) in formats(answer, folder).items():
        path = folder / f"answer{'.npz' if 'npz' in kind else '.bin'}"
        writes = took(write, path, times)
        rows.append([name, kind, f"{path.stat().st_size / 1e3:.0f}", f"{writes:.0f}", f"{took(read, path, times):.0f}"])
        rows[-1] += ["yes" if answered else "no" for answered in (exact, whole)]
    if mr.load(folder / "whole.h5") != answer:
        raise RuntimeError(f"{name}: what was read is not what was saved")
    return rows


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and print and write the table."""
    args: argparse.Namespace = cli.parser(__doc__, "result_files").parse_args(argv)
    out = cli.folder(args.out)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = answers(args.quick)
    rows = [row for name, answer in found.items() for row in measured(name, answer, out, 1 if args.quick else 5)]
    for left in ("answer.npz", "answer.bin", "whole.h5"):
        (out / left).unlink()
    cli.report(out / "result_files", cli.table(HEADER, rows), HEADER, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
