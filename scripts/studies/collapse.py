"""Collapses by explicit steps to their end: what energy cannot see, what it can, and how sure the number of fallen is.

A wall in running bond, three facades in space with openings and a wall of two storeys, each under two strong motions.
Their joints are so stiff that a unit which falls from the top and lands flat lies inside the ground by 1 % of itself.
Prints for each run how many blocks fall, the largest share of a block that lies inside another at any sample, energy
that has no account over what the ground put in, and the time of the processor. Beside it stand the number of fallen
with half the step, and the least and the most of some seeds: the same motion times 1 + 1e-9 of a random number.
Prints at last how the heap of the wall lies still after the stronger motion: its speed, and how far a block creeps in
ten seconds. What has gone past the end of the ground falls on and is left out of both.
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
from mjrock.quantities import Array
from scripts.shared import cli
from scripts.studies import facade_in_space, heap, two_storeys

TINY = 1e-9
"""Change of a motion from one seed to the next [-]."""
REST = 10.0
"""Time in which the heap may creep [s]."""
UNIT, DENSITY = 0.2, 2000.0
"""Height [m] and density [kg/m3] of the units."""
PAST = -10.0
"""Height of a centroid below its first one that has gone past the end of the ground [m]."""


def kept_apart(height: float) -> float:
    """Stiffness of joints [N/m3] on which a unit that falls by a height [m] and lands flat at a speed v lies inside the
    ground by 1 % of itself: v (rho h / k_n)^1/2, as a spring stops it."""
    return 2 * mr.GRAVITY * height * DENSITY / (UNIT * 0.01**2)


def facade(stiffer: float, length: float, height: float, gable: int, *openings: tuple[float, mr.Opening]) -> mr.Masonry:
    """A facade in space with the unit and the friction of the other studies."""
    unit, k_n = facade_in_space.UNIT, stiffer * kept_apart(height + gable * UNIT)
    joints = facade_in_space.JOINTS | {"k_n": k_n, "k_s": k_n}
    return mr.Masonry.facade(length, height, facade_in_space.DEPTH, unit, openings=openings, gable=gable, **joints)


DOOR = mr.Opening(width=0.8, height=1.2)
WINDOW = mr.Opening(width=0.4, height=0.6, sill=0.6)
MASONRY: dict[str, Callable[[float], mr.Masonry]] = {
    "wall of 36 units": lambda stiffer: mr.Masonry.running_bond(
        2.0, 2.0, heap.UNIT, k_n=stiffer * kept_apart(2.0), friction=0.6
    ),
    "facade, door": lambda stiffer: facade(stiffer, 2.4, 1.6, 0, (0.0, DOOR)),
    "facade, two windows": lambda stiffer: facade(stiffer, 3.2, 1.6, 0, *facade_in_space.WINDOWS),
    "facade, gable": lambda stiffer: facade(stiffer, 3.2, 2.0, 4, (0.0, WINDOW)),
    "two storeys": lambda stiffer: two_storeys.wall(two_storeys.FULL, stiffer * kept_apart(two_storeys.FULL.height)),
}
"""Masonry on joints so many times stiffer than `kept_apart`."""


class Run(NamedTuple):
    """A run: what stands, on joints how many times stiffer, how strong its motion is, for how long [s], its seed, and
    its step over the default."""

    name: str
    stiffer: float
    strength: float
    duration: float
    seed: int = 0
    step: float = 1.0


class Found(NamedTuple):
    """What a run gives: fallen blocks, overlap [-], energy without an account over what was put in [-], the largest
    speed of a centroid at the end [m/s], and the time of the processor [s]."""

    fallen: int
    overlap: float
    unaccounted: float
    speed: float
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
        return mr.MasonryCase(MASONRY[run.name](run.stiffer), run.duration, **motions(run))


def fastest(answer: mr.Response, motions: Array) -> float:
    """The largest motion of a centroid among those of poses or velocities at the end of a run."""
    d = 2 if answer.pose.shape[2] == 3 else 3
    stays = answer.pose[-1, :, d - 1] > PAST
    return float(np.linalg.norm(motions[stays, :d], axis=1).max())


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
    speed, took = fastest(answer, answer.velocity[-1]), answer.stats["processor_time"]
    return Found(len(answer.fallen), answer.stats["overlap"], lost / put_in, speed, took)


def creep(duration: float, rest: float) -> tuple[float, float]:
    """The largest speed in the heap of a wall after its fall [m/s], and the largest way of a block in a time after it
    [m]."""
    fallen = mr.solve_explicit(case_of(Run("wall of 36 units", 1.0, 1.5, duration)), output_step=0.02)
    quiet = mr.solve_explicit(mr.MasonryCase(fallen.of_masonry.masonry, rest), output_step=0.05, start=fallen.end)
    return fastest(fallen, fallen.velocity[-1]), fastest(quiet, quiet.pose[-1] - quiet.pose[0])


def row(found: dict[Run, Found]) -> list[object]:
    """The line of a table for the runs of one scene: the first, the one with half the step, the seeds."""
    (run, first), (_, half), *_ = found.items()
    scatter = [one.fallen for seed, one in found.items() if seed.step == 1.0]
    overlap, unaccounted = (max(getattr(one, name) for one in found.values()) for name in ("overlap", "unaccounted"))
    return [
        run.name, len(MASONRY[run.name](1.0).free), f"{run.strength:g}", f"{run.duration:g}", first.fallen, half.fallen,
        f"{min(scatter)} to {max(scatter)}", f"{overlap:.2%}", f"{unaccounted:.1e}", f"{1e3 * first.speed:.1e}",
        f"{first.took:.3g}",
    ]  # fmt: skip


def main(argv: Sequence[str] | None = None) -> None:
    """Run the study."""
    parser = cli.parser(__doc__, "collapse")
    parser.add_argument("--seeds", type=int, default=10, help="of the wall in running bond, besides the first run")
    parser.add_argument("--seeds-of-facades", type=int, default=4, help="of each facade")
    parser.add_argument("--seeds-of-storeys", type=int, default=1, help="of the wall of two storeys")
    parser.add_argument("--only", choices=list(MASONRY), help="one of the scenes")
    parser.add_argument("--stiffer", type=float, default=1.0, help="joints so many times stiffer")
    args = parser.parse_args(argv)
    out, names = cli.folder(args.out), [args.only] if args.only else list(MASONRY)
    durations = {"two storeys": 6.0}
    scenes = [(name, args.stiffer, strength, durations.get(name, 8.0)) for name in names for strength in (1.0, 1.5)]
    if args.quick:
        scenes, args.seeds = [("wall of 36 units", args.stiffer, 1.0, 0.4)], 1
    runs = []
    for scene in scenes:
        seeds = {"wall of 36 units": args.seeds, "two storeys": args.seeds_of_storeys}.get(
            scene[0], args.seeds_of_facades
        )
        runs += [Run(*scene), Run(*scene, step=0.5), *(Run(*scene, seed=seed) for seed in range(1, seeds + 1))]
    header = ["masonry", "units", "strength", "time [s]", "fallen", "half step", "seeds", "largest overlap"]
    header += ["without account [-]", "speed at the end [mm/s]", "processor [s]"]
    rows = list[list[object]]()
    with ProcessPoolExecutor(None if len(runs) > 3 else 1) as pool:
        coming = tqdm(pool.map(followed, runs), total=len(runs), delay=3, disable=None)
        for _, ran in groupby(zip(runs, coming, strict=True), key=lambda one: one[0][:4]):
            rows.append(row(dict(ran)))
            cli.write_text(out / "collapse.csv", cli.csv_text(header, rows))  # an interrupted study keeps its rows
    speed, way = creep(*((0.4, 0.1) if args.quick else (8.0, REST)))
    summary = f"the heap of the wall moves at {1e3 * speed:.1e} mm/s after its fall; in {REST:g} s more"
    text = f"{cli.table(header, rows)}\n\n{summary} no block moves by more than {1e3 * way:.2g} mm"
    cli.report(out / "collapse", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
