"""Which solver for masonry of how many blocks: error against time of MuJoCo and of explicit steps, time against blocks.

Columns of 0.6 x 4.2 m in 1 to 16 equal blocks, 64 in the full study, are shaken by one sine of 2 m/s2 and 0.7 s. The
error of the motion is the largest error of a rotation over the peak of its block, that of the peaks the worst relative
one. Each solver is judged by fine steps of the other; how far these two references lie apart is printed, and no error
below it can be told. Times are those of the steps alone: statics are the same for both and are kept between runs.
Walls in running bond, whose units slide, show how the time grows with the number of blocks under a weak and a strong
sine. A line is one contact line. Prints the time of a step and line, from which `simulate` estimates what a run takes.
Writes solvers_of_masonry.csv, .png and .txt.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace

from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import legend_below
from scripts.measure.masonry_precision import PULSE, SAMPLE, Motion, column, motion_of
from scripts.shared import cli

UNIT = (0.4, 0.2)
"""Size of a unit in running bond [m]."""
K_N = 1e10
"""Stiffness of its joints [N/m3]."""
WEAK, STRONG, PERIOD = 3.0, 9.0, 0.3
"""Amplitudes [m/s2] and period [s] of the sine that shakes it."""
WORDS = {"weak": f"{WEAK:g} m/s²", "strong": f"{STRONG:g} m/s²", "rigid": "joints stick", "sprung": "$k_s = 0.4\\,k_n$"}
"""Settings in the figure."""


@dataclass(frozen=True)
class Study:
    """What is run.

    Args:
        counts: numbers of blocks of the columns.
        duration: how long they are followed [s].
        accuracies: of fitted steps in MuJoCo [-].
        shares: explicit steps over the longest stable one [-].
        finest_accuracy, finest_share: those of the references [-].
        few: number of blocks beyond which the finest settings and references are left out.
        walls: length and height of the walls [m].
        largest: number of blocks up to which MuJoCo runs them.
        shaken: how long they are followed [s].
    """

    counts: Sequence[int] = (1, 2, 4, 8, 16, 64)
    duration: float = 2.0
    accuracies: Sequence[float] = (1e-2, 1e-3, 1e-4)
    shares: Sequence[float] = (0.9, 0.4, 0.1, 0.03)
    finest_accuracy: float = 1e-5
    finest_share: float = 0.01
    few: int = 16
    walls: Sequence[tuple[float, float]] = ((0.8, 0.8), (1.2, 0.8), (1.6, 1.2), (2.0, 2.0), (3.2, 3.0))
    largest: int = 60
    shaken: float = 0.3


QUICK = Study((1, 2), 0.5, (1e-2, 1e-3), (0.9, 0.4), 1e-4, 0.1, 16, ((0.8, 0.8),), 20, 0.02)


@dataclass(frozen=True)
class Point:
    """One run: blocks, lines, solver, its setting, steps, time of a simulated second [s], errors [-]."""

    blocks: int
    lines: int
    solver: str
    setting: str
    steps: int
    seconds: float
    peak: float = math.nan
    path: float = math.nan


def explicit(case: mr.MasonryCase, share: float) -> mr.Response:
    """Explicit steps of a share of the longest stable one, whole in a sample."""
    limit = mr.solve_explicit(case_of(case, 1e-2)).stats["stable_timestep"]
    return mr.solve_explicit(case, timestep=SAMPLE / math.ceil(SAMPLE / (share * limit)), output_step=SAMPLE, threads=1)


def case_of(case: mr.MasonryCase, duration: float) -> mr.MasonryCase:
    """The same case, followed for another time [s]."""
    return mr.MasonryCase(case.masonry, duration, case.motion)


def fitted(case: mr.MasonryCase, accuracy: float) -> mr.Response:
    """Steps that fit the motion in MuJoCo."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "explicit steps would take", UserWarning)
        return mr.simulate(case, accuracy=accuracy, output_step=SAMPLE)


def errors(answer: mr.Response, exact: Motion) -> tuple[float, float]:
    """Errors of the peaks and of the motion."""
    motion = motion_of(answer)
    count = min(len(motion.theta), len(exact.theta))
    return Motion(motion.peaks, motion.theta[:count]).errors(Motion(exact.peaks, exact.theta[:count]))


def point_of(answer: mr.Response, case: mr.MasonryCase, setting: str, exact: Motion | None = None) -> Point:
    """A run as a point."""
    lines, seconds = len(mr.masonry_scene(case).contacts.k), answer.stats["stepping_time"] / case.duration
    wrong = (math.nan, math.nan) if exact is None else errors(answer, exact)
    return Point(len(case.masonry.free), lines, answer.solver, setting, answer.stats["steps"], seconds, *wrong)


def of_column(study: Study, count: int) -> tuple[list[Point], tuple[float, float]]:
    """The points of one column, and how far its two references lie apart."""
    case = mr.MasonryCase(column(count), study.duration, PULSE)
    if count > study.few:
        accuracies, shares = study.accuracies[:-1], study.shares[:-2]
        study = replace(study, accuracies=accuracies, shares=shares, finest_accuracy=1e-4, finest_share=0.2)
    engine = motion_of(fitted(case, study.finest_accuracy))
    fine = explicit(case, study.finest_share)
    points = [
        point_of(fitted(case, accuracy), case, f"accuracy {accuracy:g}", motion_of(fine))
        for accuracy in study.accuracies
    ]
    points += [point_of(explicit(case, share), case, f"{share:g} of limit", engine) for share in study.shares]
    return points, errors(fine, engine)


def of_wall(study: Study, size: tuple[float, float], amplitude: float) -> list[Point]:
    """Times of a wall in running bond: MuJoCo, where it is not too large, and rigid and sprung joints explicitly."""
    motion = mr.GroundMotion.sine(amplitude, PERIOD)
    points = []
    for k_s in (None, 0.4 * K_N):
        wall = mr.Masonry.running_bond(*size, UNIT, k_n=K_N, k_s=k_s)
        case = mr.MasonryCase(wall, study.shaken, motion)
        mr.solve_explicit(case_of(case, 1e-3))
        strength = "weak" if amplitude == WEAK else "strong"
        if k_s is None and len(wall.free) <= study.largest:
            points.append(point_of(fitted(case, 1e-3), case, strength))
        joints = "rigid" if k_s is None else "sprung"
        points.append(point_of(mr.solve_explicit(case, threads=1), case, f"{strength}, {joints}"))
    return points


def drawn(walls: Sequence[Point]) -> Figure:
    """Time against blocks of the walls."""
    figure = Figure(figsize=(7.4, 4.0), layout="constrained")
    ax = figure.subplots()
    for solver in ("MuJoCo", "explicit"):
        look = plotting.STYLES[solver]
        for setting in dict.fromkeys(one.setting for one in walls if one.solver == solver):
            own = [one for one in walls if (one.solver, one.setting) == (solver, setting)]
            dashes = "-" if setting.startswith("strong") else ":"
            marker = "s" if "sprung" in setting else "o"
            style = {"color": look["color"], "marker": marker, "linestyle": dashes, "markerfacecolor": "none"}
            label = ", ".join([str(look["label"]), *(WORDS[word] for word in setting.split(", "))])
            ax.plot([one.blocks for one in own], [one.seconds for one in own], label=label, **style)
    ax.set(xscale="log", yscale="log")
    legend_below(figure, *ax.get_legend_handles_labels(), 2)
    ax.set_xlabel("blocks that are free [-]")
    ax.set_ylabel("CPU time of a simulated second [s/s]")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run columns and walls, draw and print."""
    args = cli.parser(__doc__, "solvers_of_masonry").parse_args(argv)
    out = cli.folder(args.out)
    study = QUICK if args.quick else Study()
    columns, walls, apart = [], [], []
    with tqdm(total=len(study.counts) + 2 * len(study.walls), disable=None, leave=False) as bar:
        for count in study.counts:
            points, scatter = of_column(study, count)
            columns += points
            apart.append(f"references of {count} blocks: {scatter[0]:.1e} (peaks), {scatter[1]:.1e} (motion) apart")
            bar.update()
        for size in study.walls:
            for amplitude in (WEAK, STRONG):
                walls += of_wall(study, size, amplitude)
                bar.update()
    plotting.save(drawn(walls), out / "solvers_of_masonry.png")
    header = ["scene", "blocks", "lines", "solver", "setting", "steps", "s a simulated s", "ns a step and line"]
    header += ["peak error", "motion error"]
    rows = []
    for scene, points, duration in (("column", columns, study.duration), ("wall", walls, study.shaken)):
        for one in points:
            each = f"{1e9 * one.seconds * duration / one.steps / one.lines:.0f}"
            wrong = ["-" if math.isnan(value) else f"{value:.1e}" for value in (one.peak, one.path)]
            cells = [scene, one.blocks, one.lines, one.solver, one.setting, one.steps]
            rows.append([*cells, f"{one.seconds:.3g}", each, *wrong])
    text = "\n".join([cli.table(header, rows), "", *apart])
    cli.report(out / "solvers_of_masonry", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
