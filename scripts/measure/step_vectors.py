"""Explicit steps of sprung joints in the plane with vectors and on several cores: would it pay?

The law of `steps/floor.c` as compiled Python over arrays: the forces of all lines first, which the compiler may
vectorise, then their sums body by body, so that any number of threads gives the same bits. Prints nanoseconds a line
and step on one thread, by the processor, the ratio of the clock on one thread to that on two, and plain C beside them.
"""

from __future__ import annotations

import math
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numba
import numpy as np
from tqdm import tqdm

from mjrock.distinct.setup import setup_of
from mjrock.quantities import GRAVITY, Array
from scripts.measure.steps import floor as step_floor
from scripts.measure.steps.tasks import PUSH, case_of
from scripts.shared import cli

SIZES = (50, 200, 1000, 4000)
"""Blocks of the walls."""
LINE_STEPS = 6e6
"""Steps times lines that are timed."""


@numba.njit(parallel=True, error_model="numpy")  # type: ignore[untyped-decorator]
def found(line: Array, ends: np.ndarray, body: Array, force: Array, h: float) -> None:
    """The forces of all lines. Rows of the tables are those of `LINES`, `BODIES` and `MOVED` of the floor."""
    for p in numba.prange(line.shape[1]):
        i, f = ends[0, p], ends[1, p]
        ax, az, ox, oz = line[0, p], line[1, p], line[2, p], line[3, p]
        s, v, sf, vf = body[7, i], body[8, i], body[7, f], body[8, f]
        tx, tz = az * s - ax * v, -ax * s - az * v
        rx, rz = ax + tx, az + tz
        dx = line[4, p] + body[4, i] + tx - body[4, f] - oz * sf + ox * vf
        dz = line[5, p] + body[5, i] + tz - body[5, f] + ox * sf + oz * vf
        nx, nz = line[6, p], line[7, p]
        mx, mz = nx + nz * sf - nx * vf, nz - nx * sf - nz * vf
        sx = body[2, i] - body[2, f] + body[4, i] - body[4, f] + rx
        sz = body[3, i] - body[3, f] + body[5, i] - body[5, f] + rz
        gap = mx * dx + mz * dz
        overlap = min(gap, 0.0)
        ux = body[9, i] + body[11, i] * rz - body[9, f] - body[11, f] * sz
        uz = body[10, i] - body[11, i] * rx - body[10, f] + body[11, f] * sx
        rate, slip = mx * ux + mz * uz, mz * ux - mx * uz
        push = max(-(line[8, p] * overlap + line[9, p] * rate), 0.0) if gap < 0 else 0.0
        limit = line[12, p] * push
        longest, grip = limit / line[10, p], line[13, p] + h * slip
        grip = min(max(grip, -longest), longest)
        drag = min(max(-line[10, p] * grip - line[11, p] * slip, -limit), limit)
        line[13, p] = grip
        fx, fz, turn = push * mx + drag * mz, push * mz - drag * mx, -0.5 * overlap * drag
        force[0, p], force[1, p] = fx, fz
        force[2, p], force[3, p] = rz * fx - rx * fz + turn, -(sz * fx - sx * fz + turn)


@numba.njit(parallel=True, error_model="numpy")  # type: ignore[untyped-decorator]
def moved(body: Array, force: Array, first: np.ndarray, listed: np.ndarray, h: float, push: float) -> None:
    """Sum the forces of each body in the order of its lines, and move it."""
    for i in numba.prange(body.shape[1] - 1):
        fx, fz, moment = -body[0, i] * push, -body[0, i] * GRAVITY, 0.0
        for q in range(first[i], first[i + 1]):
            p = listed[q]
            if p >= 0:
                fx, fz, moment = fx + force[0, p], fz + force[1, p], moment + force[2, p]
            else:
                fx, fz, moment = fx - force[0, -1 - p], fz - force[1, -1 - p], moment + force[3, -1 - p]
        body[9, i] += h / body[0, i] * fx
        body[10, i] += h / body[0, i] * fz
        body[11, i] += h * body[1, i] * moment
        body[4, i] += h * body[9, i]
        body[5, i] += h * body[10, i]
        body[6, i] += h * body[11, i]
        half = math.sin(0.5 * body[6, i])
        body[7, i], body[8, i] = 2 * half * math.cos(0.5 * body[6, i]), 2 * half * half


@numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
def run(tables: Any, h: float, push: float, steps: int) -> None:
    """Some steps."""
    line, ends, body, force, first, listed = tables
    for _ in range(steps):
        found(line, ends, body, force, h)
        moved(body, force, first, listed, h, push)


def tables_of(floor: step_floor.Floor) -> tuple[Any, ...]:
    """The arrays of a floor as tables."""
    line = np.array([floor.line[name] for name in (*step_floor.LINES, "grip")])
    body = np.array([floor.body[name] for name in (*step_floor.BODIES, *step_floor.MOVED)])
    return line, np.array(floor.ends), body, np.zeros((4, line.shape[1])), floor.first, floor.listed


def timed(floor: step_floor.Floor, h: float, steps: int, threads: int) -> tuple[float, float, Array]:
    """Processor and clock seconds of some steps, and where they have led."""
    numba.set_num_threads(threads)
    tables = tables_of(floor)
    begun = time.process_time(), time.perf_counter()
    run(tables, h, PUSH[2], steps)
    return time.process_time() - begun[0], time.perf_counter() - begun[1], tables[2]


def row_of(blocks: int, folder: Path, *, rounds: int) -> list[object]:
    """A row of the table."""
    setup = setup_of(case_of(f"wall {blocks} sprung", 1.0), None, None)
    h, lines = 0.4 * setup.limit, len(setup.system.lines)
    steps = max(10, int(LINE_STEPS / lines))
    cores = min(2, numba.config.NUMBA_NUM_THREADS)
    for threads in (1, cores):
        timed(step_floor.Floor(setup.system, folder), h, 5, threads)
    one, clocks, plain = [], [], []
    for _ in range(rounds):
        alone = timed(step_floor.Floor(setup.system, folder), h, steps, 1)
        both = timed(step_floor.Floor(setup.system, folder), h, steps, cores)
        assert (alone[2] == both[2]).all()
        one.append(alone[0] / (steps * lines) * 1e9)
        clocks.append((alone[1], both[1]))
        plain.append(step_floor.Floor(setup.system, folder).nanoseconds(h, PUSH[2], steps, vectors=True))
    faster = min(a for a, _ in clocks) / min(b for _, b in clocks)
    return [blocks, lines, f"{min(one):.1f}", f"{faster:.2f}", f"{min(plain):.1f}"]


HEADER = ["blocks", "lines", "compiled Python, one thread [ns]", "two threads, times as fast", "C, vectors [ns]"]


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and print the table."""
    options = cli.parser(__doc__, "step_vectors")
    options.add_argument("--rounds", type=int, default=7, help="turns of one thread, two, and plain C")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    if not step_floor.is_there():
        raise RuntimeError("no C compiler is found; install gcc")
    with tempfile.TemporaryDirectory() as folder:
        sizes, rounds = (SIZES[:1], 1) if args.quick else (SIZES, args.rounds)
        sizes = tqdm(sizes, desc="walls", disable=None, leave=False)
        rows = [row_of(blocks, Path(folder), rounds=rounds) for blocks in sizes]
    cli.report(out / "step_vectors", cli.table(HEADER, rows), HEADER, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
