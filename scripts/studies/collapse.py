"""Collapses by explicit steps to their end: what energy cannot see, what it can, and how sure the number of fallen is.

A wall in running bond, three facades in space with openings and a wall of two storeys, each under two strong motions.
Prints for each run how many blocks fall, the largest share of a block that lies inside another at any sample, energy
that has no account over what the ground put in, and the time of the processor. Beside it stand the number of fallen
with half the step, and the least and the most of some seeds: the same motion times 1 + 1e-9 of a random number.
Prints at last how the heap of the wall lies still: its kinetic energy, and how far a block creeps in ten seconds.
Writes collapse.csv, a row when its runs are done, and collapse.txt.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from tqdm import tqdm

import mjrock as mr
from scripts.shared import cli
from scripts.studies import facade_in_space, heap, two_storeys

TINY = 1e-9
"""Change of a motion from one seed to the next [-]."""
REST = 10.0
"""Time in which the heap may creep [s]."""


def facade(length: float, height: float, gable: int, *openings: tuple[float, mr.Opening]) -> mr.Masonry:
    """A facade in space on the joints of the other studies."""
    unit, joints = facade_in_space.UNIT, facade_in_space.JOINTS
    return mr.Masonry.facade(length, height, facade_in_space.DEPTH, unit, openings=openings, gable=gable, **joints)


DOOR = mr.Opening(width=0.8, height=1.2)
WINDOW = mr.Opening(width=0.4, height=0.6, sill=0.6)
MASONRY: dict[str, Callable[[], mr.Masonry]] = {
    "wall of 36 units": lambda: mr.Masonry.running_bond(2.0, 2.0, heap.UNIT, k_n=1e9, friction=0.6),
    "facade, door": lambda: facade(2.4, 1.6, 0, (0.0, DOOR)),
    "facade, two windows": facade_in_space.facade,
    "facade, gable": lambda: facade(3.2, 2.0, 4, (0.0, WINDOW)),
    "two storeys": lambda: two_storeys.wall(two_storeys.FULL),
}


class Run(NamedTuple):
    """A run: what stands, how strong its motion is, for how long [s], its seed, and its step over the default."""

    name: str
    strength: float
    duration: float
    seed: int = 0
    step: float = 1.0


class Found(NamedTuple):
    """What a run gives: fallen blocks, overlap [-], energy without an account over what was put in [-], kinetic energy
    at the end [J], and the time of the processor [s]."""

    fallen: int
    overlap: float
    unaccounted: float
    kinetic: float
    took: float


def motions(run: Run) -> dict[str, Any]:
    """The motions of a run: a sine, a record in the plane, or three components."""
    factor = run.strength * (1 + TINY * float(np.random.default_rng(run.seed).standard_normal()) * (run.seed > 0))
    if run.name.startswith("wall"):
        return {"motion": mr.GroundMotion.sine(factor * heap.AMPLITUDE, heap.PERIOD)}
    if run.name == "two storeys":
        study = two_storeys.FULL
        record = mr.GroundMotion.synthetic(16.0, study.shaken, seed=1, ground_frequency=two_storeys.SOIL)
        return {"motion": record.scaled(factor)}
    three = facade_in_space.motions(facade_in_space.PEAKS, 6.0)
    return {name: motion.scaled(factor) for name, motion in three.items()}


def case_of(run: Run) -> mr.MasonryCase:
    """The case of a run."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mr.Implausible)  # the run may end before the record
        return mr.MasonryCase(MASONRY[run.name](), run.duration, **motions(run))


def followed(run: Run) -> Found:
    """One run to its end."""
    case, options = case_of(run), dict[str, Any]()
    with warnings.catch_warnings():
        for printed in ("explicit steps would take", "the ledger does not close", ".* lie inside each other"):
            warnings.filterwarnings("ignore", printed)  # these numbers are in the table
        if run.step != 1.0:
            short = mr.solve_explicit(mr.MasonryCase(case.masonry, 1e-3)).stats["timestep"]
            options["timestep"] = run.step * short
        answer = mr.solve_explicit(case, output_step=0.02, ledger=True, **options)
    ledger = answer.ledger
    assert ledger is not None
    put_in = float(np.abs(np.diff(ledger.ground)).sum())
    lost = float(np.abs(ledger.residual).max())
    kinetic, took = float(ledger.kinetic[-1]), answer.stats["processor_time"]
    return Found(len(answer.fallen), answer.stats["overlap"], lost / put_in, kinetic, took)


def creep(duration: float, rest: float) -> tuple[float, float]:
    """Kinetic energy of the heap after its fall [J], and the largest way of a block in the time after it [m]."""
    run = Run("wall of 36 units", 1.0, duration)
    fallen = mr.solve_explicit(case_of(run), output_step=0.02, ledger=True)
    quiet = mr.solve_explicit(mr.MasonryCase(fallen.case.masonry, rest), output_step=0.05, start=fallen.end)
    assert fallen.ledger is not None
    ways = np.linalg.norm(quiet.pose[-1, :, :2] - quiet.pose[0, :, :2], axis=1)
    on_ground = quiet.pose[-1, :, 1] > -10.0  # what fell past the end of the ground falls on
    return float(fallen.ledger.kinetic[-1]), float(ways[on_ground].max())


def row(found: dict[Run, Found]) -> list[object]:
    """The line of a table for the runs of one scene: the first, the one with half the step, the seeds."""
    (run, first), (_, half), *_ = found.items()
    scatter = [one.fallen for seed, one in found.items() if seed.step == 1.0]
    overlap, unaccounted = (max(getattr(one, name) for one in found.values()) for name in ("overlap", "unaccounted"))
    return [
        run.name, len(MASONRY[run.name]().free), f"{run.strength:g}", f"{run.duration:g}", first.fallen, half.fallen,
        f"{min(scatter)} to {max(scatter)}", f"{overlap:.2%}", f"{unaccounted:.1e}", f"{first.kinetic:.1e}",
        f"{first.took:.3g}",
    ]  # fmt: skip


def main(argv: Sequence[str] | None = None) -> None:
    """Run the study."""
    parser = cli.parser(__doc__, "collapse")
    parser.add_argument("--seeds", type=int, default=10, help="of the wall in running bond, besides the first run")
    parser.add_argument("--seeds-of-facades", type=int, default=4, help="of each facade")
    parser.add_argument("--seeds-of-storeys", type=int, default=1, help="of the wall of two storeys")
    args = parser.parse_args(argv)
    out = cli.folder(args.out)
    durations = {"wall of 36 units": 8.0, "two storeys": 6.0}
    scenes = [(name, strength, durations.get(name, 8.0)) for name in MASONRY for strength in (1.0, 1.5)]
    if args.quick:
        scenes, args.seeds = [("wall of 36 units", 1.0, 0.4)], 1
    runs = []
    for scene in scenes:
        seeds = {"wall of 36 units": args.seeds, "two storeys": args.seeds_of_storeys}.get(
            scene[0], args.seeds_of_facades
        )
        runs += [Run(*scene), Run(*scene, step=0.5), *(Run(*scene, seed=seed) for seed in range(1, seeds + 1))]
    header = ["masonry", "units", "strength", "time [s]", "fallen", "half step", "seeds", "largest overlap"]
    header += ["without account [-]", "kinetic at the end [J]", "processor [s]"]
    rows = list[list[object]]()
    with ProcessPoolExecutor(None if len(runs) > 3 else 1) as pool:
        coming = tqdm(pool.map(followed, runs), total=len(runs), delay=3, disable=None)
        for _, ran in groupby(zip(runs, coming, strict=True), key=lambda one: one[0][:3]):
            rows.append(row(dict(ran)))
            cli.write_text(out / "collapse.csv", cli.csv_text(header, rows))  # an interrupted study keeps its rows
    kinetic, way = creep(*((0.4, 0.1) if args.quick else (8.0, REST)))
    said = f"the heap of the wall has {kinetic:.1e} J after its fall; in {REST:g} s more"
    text = f"{cli.table(header, rows)}\n\n{said} no block moves by more than {1e3 * way:.2g} mm"
    cli.report(out / "collapse", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
