"""A block on its corner and a column of three drums in two components: MuJoCo against explicit steps.

The block, 0.6 x 0.4 x 2 m on 1e8 N/m3, is released about a corner with a tilt of 0.12 rad at 30 degrees in plan, and
shaken along x and y. The square column of three drums, 0.6 x 3 m on 1e9 N/m3, is shaken likewise. MuJoCo sticks
rigidly, so explicit steps have rigid friction, or shear springs of 100, 10 and 0.4 times k_n. Differences are the
largest of a displacement of a centroid from that of explicit steps of 5 us with rigid friction. Times are those of the
steps alone, the least of some repetitions.

Then 20 pairs of artificial records shake the column, x at the full and y at 0.8 of the peak of 3.5 m/s2: peaks of the
tilt of the top drum, and how many columns overturn, which are drawn at the edge. A column under a record is chaotic, so
that single peaks differ where it rocks through many impacts.

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
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from scripts.shared import cli

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
COMPARED = ("MuJoCo 1e-3", "explicit", "explicit 0.4 k_n")
"""Solvers that run the records."""
COLOURS = {"MuJoCo 1e-3": "C0", "MuJoCo 1e-4": "C0", "explicit": "C1", "explicit 100 k_n": "C3"} | {
    "explicit 10 k_n": "C4",
    "explicit 0.4 k_n": "C2",
}


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
    away = np.array(scene.point) - turn.apply(np.array(scene.point))
    corner = away[int(away[:, 2].argmax())]
    return scene.lowered(np.array([[*corner, *np.roll(turn.as_quat(), 1)]])), np.zeros((1, 6))


def block(share: float | None) -> mr.Masonry:
    """The block on its ground."""
    return mr.Masonry.box(SIZE, k_n=SOFT, k_s=None if share is None else share * SOFT, friction=0.6)


def column(share: float | None) -> mr.Masonry:
    """The column of drums."""
    return mr.Masonry.column(WIDTH, HEIGHT, DRUMS, k_n=K_N, k_s=None if share is None else share * K_N, friction=0.7)


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


def peaks(study: Study, setting: str) -> Array:
    """Peak tilt of the top drum under each record [rad], infinite where a drum has fallen."""
    found = []
    for x, y in tqdm(records(study), desc=setting, disable=None, leave=False):
        answer = Scene("column", column, x, y).run(setting, study.length)
        found.append(math.inf if answer.fallen else float(answer.tilt[:, -1].max()))
    return np.array(found)


def statistics(found: dict[str, Array]) -> list[list[object]]:
    """Quartiles of the peaks, how many columns overturn, and how each solver compares with MuJoCo."""
    rows: list[list[object]] = []
    first = found[COMPARED[0]]
    for setting, values in found.items():
        quartiles = np.degrees(np.quantile(values, [0.25, 0.5, 0.75], method="nearest"))
        stood = np.isfinite(values) & np.isfinite(first)
        off = np.abs(values[stood] / first[stood] - 1)
        row = [f"{value:.2f}" for value in quartiles] + [int(np.isinf(values).sum())]
        agreed = int((np.isinf(values) == np.isinf(first)).sum())
        rows.append([setting, *row, agreed, f"{np.median(off):.1%}", f"{off.max():.1%}"])
    return rows


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
        points = len(scene.k)
        engine = mr.simulate(rigid).stats["stepping_time"] / study.shaken
        each = [
            1e9 * stats["stepping_time"] / stats["steps"] / points
            for stats in (mr.solve_explicit(case).stats for case in (rigid, sprung))
        ]
        unit = f"{engine / points / scene.highest_frequency:.1e}"
        rows.append(
            [name, f"{amplitude:g}", len(scene.names), points, f"{engine:.2g}", unit, *(f"{ns:.0f}" for ns in each)]
        )
    return rows


def drawn(histories: dict[str, dict[str, mr.Response]], found: dict[str, Array]) -> Figure:
    """Tilts over time, and peaks of explicit steps over those of MuJoCo."""
    figure = Figure(figsize=(11, 3.4), layout="constrained")
    *axes, last = figure.subplots(1, len(histories) + 1)
    for ax, (name, answers) in zip(axes, histories.items(), strict=True):
        for setting in ("MuJoCo 1e-4", "explicit", "explicit 0.4 k_n"):
            line = "-" if setting.startswith("MuJoCo") else "--"
            answer = answers[setting]
            ax.plot(answer.t, np.degrees(answer.tilt[:, -1]), line, color=COLOURS[setting], label=setting)
        ax.set(title=name, xlabel="t [s]", ylabel="tilt [deg]")
    axes[0].legend(frameon=False, fontsize=8)
    first = np.degrees(found[COMPARED[0]])
    top = max(float(np.degrees(values[np.isfinite(values)]).max(initial=1.0)) for values in found.values())
    for setting in COMPARED[1:]:
        own = np.degrees(found[setting])
        last.plot(np.minimum(first, 1.5 * top), np.minimum(own, 1.5 * top), "o", color=COLOURS[setting], label=setting)
        last.lines[-1].set_markerfacecolor("none")
    low = 0.5 * float(min(np.degrees(values).min() for values in found.values()))
    last.plot([low, 1.5 * top], [low, 1.5 * top], color="k", linewidth=0.6)
    last.set(xscale="log", yscale="log", title="peaks under records")
    last.set_xlabel("MuJoCo 1e-3 [deg]")
    last.set_ylabel("explicit steps [deg]")
    last.legend(frameon=False, fontsize=8)
    return figure


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
        found = {setting: peaks(study, setting) for setting in COMPARED}
        times = costs(study)
    header = ["scene", "solver", "steps", "steps [ms]", "peak tilt [deg]", "off", "apart [mm]"]
    shares = ["solver", "quartile [deg]", "median [deg]", "quartile [deg]", "overturned", "same end", "off", "most"]
    text = [cli.table(header, rows), "", f"{study.records} records", "", cli.table(shares, statistics(found))]
    per = ["scene", "sine [m/s2]", "blocks", "points", "MuJoCo [s/s]", "[s2]", "rigid [ns]", "sprung [ns]"]
    text += ["", cli.table(per, times)]
    plotting.save(drawn(histories, found), out / "columns_in_space.png")
    cli.report(out / "columns_in_space", "\n".join(text), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
