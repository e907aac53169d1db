"""A block on its corner and a column of three drums in two components: MuJoCo against explicit steps.

The block, 0.6 x 0.4 x 2 m on 1e8 N/m3, is released about a corner with a tilt of 0.12 rad at 30 degrees in plan, and
shaken along x and y. The square column of three drums, 0.6 x 3 m on 1e9 N/m3, is shaken likewise. MuJoCo sticks
rigidly, so explicit steps have rigid friction, or shear springs of 100, 10 and 0.4 times k_n. Differences are the
largest of a displacement of a centroid from that of explicit steps of 5 us with rigid friction. Times are those of the
steps alone, the least of some repetitions.

Then 20 pairs of artificial records shake the column, x at the full and y at 0.8 of the peak of 3.5 m/s2. A run
overturns when a drum has tilted by more than 0.5 rad, or has fallen. To tell the solvers from a motion that scatters
by itself, explicit steps are repeated with half the step, with 20 us, and with k_n changed by 1e-6 and by 1e-3 of
itself. Two runs part where a component of the rotation vector of a drum differs by more than 2 mrad, 1 % of the angle
at which the column overturns as one block. For each pair of ways are given when they part, how far the peaks of the
tilt until then differ, the largest of those that differ by more than 3 %, how many columns overturn in each and end
alike, and how far the peaks differ where both stand.
Explicit steps with shear springs of 0.4 k_n are another model, not another solver: their joints give way, and their
peaks differ before the paths part.

Last, what a simulated second takes over the number of contact points and the highest frequency, of a column of 12 drums
and of a facade with return walls under a weak and a strong sine: from this `simulate` estimates what a run takes.
Writes columns_in_space.csv, .png and .txt.
"""

from __future__ import annotations

import itertools
import math
import sys
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, Look, below_figure
from mjrock.quantities import Array
from scripts.shared import cli
from scripts.shared.paths import OVERTURNED, PARTED, SAMPLE, Path, apart, draw_square, pairs_of, parting, path_of

SIZE, SOFT = (0.6, 0.4, 2.0), 1e8
"""Size of the block [m] and stiffness of its joint [N/m3]."""
TILT, PLAN = 0.12, math.radians(30)
"""Of its release [rad]."""
WIDTH, HEIGHT, DRUMS, K_N = 0.6, 3.0, 3, 1e9
"""Of the column [m], its drums, and the stiffness of its joints [N/m3]."""
PEAK, SHARE, LENGTH = 3.5, 0.8, 10.0
"""Peak of the records along x [m/s2], that along y over it [-], and their duration [s]."""
AMPLITUDES = (1.0, 6.0)
"""Of the sine that shakes many blocks, weak and strong [m/s2]."""
FINE = 5e-6
"""Step of the reference [s]."""
SETTINGS = ("MuJoCo 1e-3", "MuJoCo 1e-4", "explicit", "explicit 100 k_n", "explicit 10 k_n", "explicit 0.4 k_n")
"""Solvers: the accuracy of fitted steps in MuJoCo, and k_s of the joints of explicit steps, rigid where none stands."""
FINEST, SLIGHT, SMALL = 20e-6, 1e-6, 1e-3
"""Step of the finest run of a record [s], and changes of k_n, over k_n [-]."""
RUNS = ("MuJoCo 1e-3", "MuJoCo 1e-4", "explicit", "half the step", "20 us", "k_n + 1e-6", "k_n + 1e-3", "0.4 k_n")
"""Ways to run the records. All but those of MuJoCo are explicit steps."""
LOOKS: dict[str, Look] = {
    "MuJoCo 1e-4": {"color": ORANGE, "linestyle": "-", "linewidth": 2.4},
    "explicit": {"color": BLUE, "linestyle": "-", "linewidth": 1.2},
    "half the step": {"color": BLACK, "linestyle": "--", "linewidth": 1.0},
    "explicit 0.4 k_n": {"color": GREEN, "linestyle": ":", "linewidth": 1.6},
    "0.4 k_n": {"color": GREEN},
}
"""The lines of some ways in the figures."""
NAMES = {"MuJoCo 1e-4": "MuJoCo", "explicit": "explicit steps", "half the step": "explicit steps half as long"}
NAMES |= dict.fromkeys(("explicit 0.4 k_n", "0.4 k_n"), "explicit, $k_s$ = 0.4 $k_n$ instead of rigid")
SHORT = {"MuJoCo 1e-4": "MuJoCo", "half the step": "half the step", "0.4 k_n": "$k_s$ = 0.4 $k_n$"}
COMPARED = {
    ("explicit", "MuJoCo 1e-3"): "two solvers",
    ("explicit", "MuJoCo 1e-4"): "two solvers",
    ("20 us", "MuJoCo 1e-4"): "two solvers",
    ("MuJoCo 1e-3", "MuJoCo 1e-4"): "one solver",
    ("explicit", "half the step"): "one solver",
    ("explicit", "k_n + 1e-6"): "one solver",
    ("explicit", "k_n + 1e-3"): "one solver",
    ("explicit", "0.4 k_n"): "two models",
}
"""Pairs of them, and what they are."""
NEARLY = 0.03
"""Difference of peaks that is counted as small [-]."""
GROWTH: dict[tuple[str, str], tuple[str, Look]] = {
    ("explicit", "MuJoCo 1e-4"): ("the other solver", {"color": ORANGE}),
    ("explicit", "half the step"): ("half the step", {"color": BLACK, "linestyle": "--"}),
    ("explicit", "k_n + 1e-3"): ("$k_n$ larger by 10$^{-3}$", {"color": PURPLE, "linestyle": "-."}),
    ("explicit", "k_n + 1e-6"): ("$k_n$ larger by 10$^{-6}$", {"color": GREEN, "linestyle": ":"}),
}
"""Pairs whose difference is drawn over time, and what is other than in explicit steps."""


@dataclass(frozen=True)
class Study:
    """What is run: time that the histories take [s], number of records, their duration [s], repetitions,
    and how long masonry of many blocks is shaken [s]."""

    duration: float = 2.0
    records: int = 20
    length: float = LENGTH
    repeats: int = 3
    shaken: float = 0.2


QUICK = Study(0.5, 2, 1.0, 1, 0.02)


@dataclass(frozen=True)
class Scene:
    """Masonry, of any shear stiffness over k_n, and what happens to it."""

    name: str
    masonry: Callable[[float | None], mr.Masonry]
    motion: mr.GroundMotion | None = None
    transverse: mr.GroundMotion | None = None
    tilted: bool = False

    def run(self, setting: str, duration: float, timestep: float | None = None) -> mr.Response:
        """The answer of a solver."""
        solver, *value = setting.split()
        share = float(value[0]) if solver == "explicit" and value else None
        masonry = self.masonry(share)
        case = mr.MasonryCase(masonry, duration, self.motion, transverse=self.transverse)
        start = on_a_corner(masonry) if self.tilted else None
        if solver == "explicit":
            return mr.solve_explicit(case, timestep=timestep, start=start)
        return mr.simulate(case, accuracy=float(value[0]), start=start)


def on_a_corner(masonry: mr.Masonry) -> tuple[Array, Array]:
    """Pose and velocity of the block at its release: tilted about a corner of its base, which carries it."""
    scene = mr.masonry_scene(mr.MasonryCase(masonry, 1.0))
    turn = Rotation.from_rotvec(TILT * np.array([-math.sin(PLAN), math.cos(PLAN), 0.0]))
    away = np.array(scene.contacts.at) - turn.apply(np.array(scene.contacts.at))
    corner = away[int(away[:, 2].argmax())]
    return scene.lowered(np.array([[*corner, *np.roll(turn.as_quat(), 1)]])), np.zeros((1, 6))


def block(share: float | None) -> mr.Masonry:
    """The block on its ground."""
    return mr.Masonry.box(SIZE, k_n=SOFT, k_s=None if share is None else share * SOFT, friction=0.6)


def column(share: float | None, k_n: float = K_N) -> mr.Masonry:
    """The column of drums."""
    return mr.Masonry.column(WIDTH, HEIGHT, DRUMS, k_n=k_n, k_s=None if share is None else share * k_n, friction=0.7)


def scenes() -> list[Scene]:
    """The scenes whose histories are compared."""
    sine = mr.GroundMotion.sine
    return [
        Scene("block released on a corner", block, tilted=True),
        Scene("block shaken", block, sine(2.5, 0.8), sine(2.0, 0.6)),
        Scene("column shaken", column, sine(3.6, 0.7), sine(2.16, 0.5)),
    ]


def compared(scene: Scene, study: Study) -> tuple[list[list[object]], dict[str, mr.Response]]:
    """A row for each solver, and their answers."""
    exact = scene.run("explicit", study.duration, FINE)
    rows, answers = [], {}
    for setting in SETTINGS:
        runs = [scene.run(setting, study.duration) for _ in range(study.repeats)]
        answer = answers[setting] = runs[0]
        count = min(len(answer.t), len(exact.t))
        apart = np.abs(answer.pose[:count, :, :3] - exact.pose[:count, :, :3]).max(axis=(1, 2))
        late = count // 3 if scene.tilted else 0  # after the first impact, beyond the release itself
        highest = answer.tilt[late:].max()
        peak = highest / exact.tilt[late:].max() - 1
        seconds = min(run.stats["stepping_time"] for run in runs)
        cells = [answer.stats["steps"], f"{1e3 * seconds:.0f}", f"{math.degrees(highest):.3f}"]
        rows.append([scene.name, setting, *cells, f"{peak:+.2%}", f"{1e3 * apart.max():.3f}"])
    return rows, answers


def records(study: Study) -> list[tuple[mr.GroundMotion, mr.GroundMotion]]:
    """The records along x and along y."""
    made = mr.GroundMotion.synthetic
    return [
        (made(PEAK, study.length, seed=seed), made(SHARE * PEAK, study.length, seed=1000 + seed))
        for seed in range(study.records)
    ]


def runs(study: Study, motions: tuple[mr.GroundMotion, mr.GroundMotion]) -> dict[str, Path]:
    """All ways to run a record."""
    x, y = motions

    def case(share: float | None = None, change: float = 0.0) -> mr.MasonryCase:
        return mr.MasonryCase(column(share, (1 + change) * K_N), study.length, x, transverse=y)

    def stepped(masonry: mr.MasonryCase, timestep: float | None = None) -> mr.Response:
        return mr.solve_explicit(masonry, timestep=timestep, output_step=SAMPLE)

    engine = [mr.simulate(case(), accuracy=accuracy, output_step=SAMPLE) for accuracy in (1e-3, 1e-4)]
    coarse = stepped(case())
    finer = [stepped(case(), step) for step in (0.5 * coarse.stats["timestep"], FINEST)]
    changed = [stepped(case(change=change)) for change in (SLIGHT, SMALL)]
    answers = (*engine, coarse, *finer, *changed, stepped(case(0.4)))
    return dict(zip(RUNS, map(path_of, answers), strict=True))


def quartiles(paths: Sequence[dict[str, Path]]) -> list[list[object]]:
    """Quartiles of the peaks of each way, and how many columns overturn."""
    rows: list[list[object]] = []
    for name in RUNS:
        peaks = np.array([own[name].peak for own in paths])
        values = np.degrees(np.quantile(peaks, [0.25, 0.5, 0.75], method="nearest"))
        rows.append([name, *(f"{value:.2f}" for value in values), int(np.isinf(peaks).sum())])
    return rows


def partings(paths: Sequence[dict[str, Path]]) -> list[list[object]]:
    """For each pair of ways when they part, and how they compare until then and in the end."""
    rows: list[list[object]] = []
    for (name, other), of in COMPARED.items():
        pairs = pairs_of(paths, name, other)
        before, off = np.abs(pairs.before - 1), np.abs(pairs.stand - 1)
        near = before < NEARLY
        small = "" if near.all() else f"{np.degrees(pairs.peaks[~near].max()):.2f}"
        parted = [np.isfinite(pairs.parts).sum(), f"{np.median(pairs.parts):.2f}"]
        parted += [f"{np.median(before):.1e}", near.sum(), small]
        ends = [f"{pairs.overturn[0]}, {pairs.overturn[1]}", len(paths) - sum(pairs.alone)]
        rows.append([of, f"{name} : {other}", *parted, *ends, f"{np.median(off):.1%}", f"{off.max(initial=0.0):.1%}"])
    return rows


def growth(paths: Sequence[dict[str, Path]], name: str, other: str) -> Array:
    """Median over the records of the largest difference of a rotation [rad], for as long as most are followed, (n,)."""
    differences = [apart(own[name], own[other]) for own in paths]
    shared = sorted(map(len, differences))[len(differences) // 2]
    median: Array = np.median([difference[:shared] for difference in differences if len(difference) >= shared], axis=0)
    return median


def costs(study: Study) -> list[list[object]]:
    """Time of MuJoCo over points and highest frequency, and of explicit steps a step and point, for many blocks."""
    many = {
        "column of 12 drums": lambda k_s: mr.Masonry.column(WIDTH, HEIGHT, 12, k_n=K_N, k_s=k_s),
        "facade": lambda k_s: mr.Masonry.facade(1.5, 0.75, 0.5, (0.5, 0.25), k_n=K_N, k_s=k_s),
    }
    rows: list[list[object]] = []
    for (name, masonry), amplitude in itertools.product(many.items(), AMPLITUDES):
        rigid, sprung = (
            mr.MasonryCase(masonry(k_s), study.shaken, mr.GroundMotion.sine(amplitude, 0.3)) for k_s in (None, K_N)
        )
        scene = mr.masonry_scene(rigid)
        points = len(scene.contacts.k)
        engine = mr.simulate(rigid).stats["stepping_time"] / study.shaken
        each = [
            1e9 * stats["stepping_time"] / stats["steps"] / points
            for stats in (mr.solve_explicit(case).stats for case in (rigid, sprung))
        ]
        unit = f"{engine / points / scene.highest_frequency:.1e}"
        rows.append(
            [
                name,
                f"{amplitude:g}",
                len(scene.bodies.names),
                points,
                f"{engine:.2g}",
                unit,
                *(f"{ns:.0f}" for ns in each),
            ]
        )
    return rows


def drawn(histories: dict[str, dict[str, mr.Response]]) -> Figure:
    """Tilts over time of each scene in both solvers, and with joints that are sprung along their faces."""
    figure = Figure(figsize=(7.4, 3.0), layout="constrained")
    axes = figure.subplots(1, len(histories))
    for ax, (name, answers) in zip(axes, histories.items(), strict=True):
        for setting in ("MuJoCo 1e-4", "explicit", "explicit 0.4 k_n"):
            answer = answers[setting]
            ax.plot(answer.t, np.degrees(answer.tilt[:, -1]), label=NAMES[setting], **LOOKS[setting])
        ax.set(xlabel="$t$ [s]", ylabel="tilt [deg]")
        ax.set_title(name, fontsize=9)
    below_figure(figure, axes[0])
    return figure


def under_records(paths: Sequence[dict[str, Path]]) -> Figure:
    """A record in several ways, how far apart they are, and the peaks of all records."""
    figure = Figure(figsize=(7.4, 5.6), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(1.3, 1))
    draw_record(figure.add_subplot(grid[0, :]), paths)
    draw_growth(figure.add_subplot(grid[1, 0]), paths)
    draw_peaks(figure.add_subplot(grid[1, 1]), paths)
    return figure


def draw_record(ax: Axes, paths: Sequence[dict[str, Path]]) -> None:
    """Of the records under which no column overturns, the one whose paths part at the median time."""
    ways = ("MuJoCo 1e-4", "explicit", "half the step")
    times = [parting(own["explicit"], own["MuJoCo 1e-4"]).when for own in paths]
    standing = [i for i, own in enumerate(paths) if not any(own[way].overturns for way in ways)] or [0]
    shown = sorted(standing, key=lambda i: times[i])[len(standing) // 2]
    for way in ways:
        tilt = np.degrees(paths[shown][way].tilt[:, -1])
        ax.plot(SAMPLE * np.arange(len(tilt)), tilt, label=NAMES[way], **LOOKS[way])
    if math.isfinite(times[shown]):
        ax.axvline(times[shown], color="0.5", linewidth=0.8, linestyle=":")
        ax.text(times[shown], ax.get_ylim()[1], " they part", fontsize=8, va="top")
    ax.set(xlabel="$t$ [s]", ylabel="tilt [deg]", ylim=(0, None))
    ax.set_title(f"column of three drums under record {shown}", fontsize=9)
    ax.legend(frameon=False, fontsize=8, loc="upper left")


def draw_growth(ax: Axes, paths: Sequence[dict[str, Path]]) -> None:
    """How far apart two ways are over time, the median of the records."""
    for (name, other), (label, look) in GROWTH.items():
        difference = 1e3 * growth(paths, name, other)
        ax.semilogy(SAMPLE * np.arange(len(difference)), difference, linewidth=1.2, label=label, **look)
    ax.axhline(1e3 * PARTED, color="0.5", linewidth=0.8, linestyle=":")
    ax.text(0.0, 1e3 * PARTED, "parted", fontsize=8, va="bottom")
    ax.set(xlabel="$t$ [s]", ylabel="difference of a rotation [mrad]", ylim=(1e-6, 1e3))
    ax.set_title("off explicit steps, median of the records", fontsize=9)
    ax.legend(frameon=False, fontsize=8, loc="lower right")


def draw_peaks(ax: Axes, paths: Sequence[dict[str, Path]]) -> None:
    """Peaks of the same record, those that overturn in the grey."""
    peaks = {way: np.array([own[way].peak for own in paths]) for way in RUNS}
    low, edge = 0.7 * min(values.min() for values in peaks.values()), OVERTURNED
    for way, marker in (("MuJoCo 1e-4", "o"), ("half the step", "x"), ("0.4 k_n", "^")):
        x, y = (np.degrees(np.minimum(peaks[name], 1.5 * edge)) for name in ("explicit", way))
        colour = LOOKS[way]["color"]
        ax.plot(x, y, marker, color=colour, markerfacecolor="none", markersize=5, label=SHORT[way])
    draw_square(ax, math.degrees(low), math.degrees(edge))
    ax.set(xlabel="peak tilt, explicit steps [deg]", ylabel="peak tilt [deg]")
    ax.set_title("peaks; in the grey they overturn", fontsize=9)
    ax.legend(frameon=False, fontsize=8, loc="upper left")


def main(argv: Sequence[str] | None = None) -> None:
    """Run both, draw and print."""
    args = cli.parser(__doc__, "out/columns_in_space").parse_args(argv)
    out = cli.folder(args.out)
    study = QUICK if args.quick else Study()
    rows: list[list[object]] = []
    histories = {}
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "explicit steps would take", UserWarning)
        for scene in tqdm(scenes(), disable=None, leave=False):
            own, histories[scene.name] = compared(scene, study)
            rows += own
        paths = [runs(study, motions) for motions in tqdm(records(study), unit="record", disable=None, leave=False)]
        times = costs(study)
    header = ["scene", "solver", "steps", "steps [ms]", "peak tilt [deg]", "off", "apart [mm]"]
    shares = ["way", "quartile [deg]", "median [deg]", "quartile [deg]", "overturned"]
    text = [cli.table(header, rows), "", f"{study.records} records", "", cli.table(shares, quartiles(paths))]
    differ = [
        "",
        "pair",
        "part",
        "median [s]",
        "peaks until then",
        f"within {NEARLY:.0%}",
        "the others [deg]",
        "overturned",
    ]
    text += ["", cli.table([*differ, "same end", "peaks that stand", "most"], partings(paths))]
    per = ["scene", "sine [m/s2]", "blocks", "points", "MuJoCo [s/s]", "[s2]", "rigid [ns]", "sprung [ns]"]
    text += ["", cli.table(per, times)]
    plotting.save(drawn(histories), out / "columns_in_space.png")
    plotting.save(under_records(paths), out / "columns_under_records.png")
    cli.report(out / "columns_in_space", "\n".join(text), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
