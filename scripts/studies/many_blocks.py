"""How the time of explicit steps grows with the number of blocks, up to 4,000: set-up, and a simulated second.

Walls in running bond, twice as long as high, grow at one size of unit; arches of one shape are cut into more and more
voussoirs. The joints have k_n = 1e10 N/m3, and stick rigidly or have springs of k_s = k_n along their faces. The
damping is 0.05 of the critical one at the lowest frequency of each, as `Masonry` takes it, or, for the walls, at one
frequency for all sizes. From rest the ground accelerates at 5 m/s2 at once. Times are those of the processor, which
other work on the machine lengthens less than those of a clock. Set-up is all that a run takes beside its steps:
joints, statics, frequencies, and the reading of the answer.
Prints the exponents of the blocks by which set-up, step and second grow, from a hundred blocks on. Writes
many_blocks.csv, .png and .txt.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLUE, GREEN, ORANGE, Look, below_figure
from mjrock.scene.time_step import STEP_TAKEN
from scripts.shared import cli

UNIT = (0.4, 0.2)
"""Size of a unit in running bond [m]."""
K_N = 1e10
"""Stiffness of the joints [N/m3]."""
FREQUENCY = 300.0
"""The frequency that xi refers to where it is one for all walls [rad/s]."""
PUSH = 5.0
"""Acceleration of the ground [m/s2]."""
SIZES = {
    "wall, rigid": (20, 50, 100, 200, 500, 1000, 2000),
    "wall, k_s = k_n": (20, 50, 100, 200, 500, 1000, 2000, 4000),
    "wall, k_s = k_n, one c/k": (20, 50, 100, 200, 500, 1000),
    "arch, rigid": (20, 50, 100, 200),
}
"""Numbers of blocks, about those of the walls and exactly those of the arches."""
SPAN, SLENDER = 5.0, 0.15
"""Radius of the arches [m], and their thickness over it [-]."""
LARGE = 100
"""Number of blocks from which on the exponents are fitted."""
LINE_STEPS = 3e7
"""Steps times lines that are timed: some two seconds."""
LOOKS: dict[str, Look] = {
    "wall, rigid": {"color": BLUE, "marker": "o"},
    "wall, k_s = k_n": {"color": ORANGE, "marker": "s"},
    "wall, k_s = k_n, one c/k": {"color": ORANGE, "marker": "^", "linestyle": ":"},
    "arch, rigid": {"color": GREEN, "marker": "D"},
}
NAMES = {
    "wall, rigid": "wall, joints stick rigidly",
    "wall, k_s = k_n": "wall, $k_s = k_n$",
    "wall, k_s = k_n, one c/k": "wall, $k_s = k_n$, one damping for all sizes",
    "arch, rigid": "arch, joints stick rigidly",
}
"""Labels of the scenes."""


@dataclass(frozen=True)
class Point:
    """One size: blocks, lines, step [s], time of set-up [s], of a step [s] and of a simulated second [s]."""

    scene: str
    blocks: int
    lines: int
    h: float
    setting_up: float
    step: float

    @property
    def second(self) -> float:
        """Time of a simulated second [s]."""
        return self.step / self.h


def built(scene: str, blocks: int) -> mr.Masonry:
    """A wall of about so many blocks, or an arch of so many."""
    k_s = None if "rigid" in scene else K_N
    if scene.startswith("arch"):
        return mr.Masonry.arch(SPAN, SLENDER * SPAN, 0.9 * math.pi, blocks, k_n=K_N, k_s=k_s)
    courses = max(1, round(math.sqrt(0.5 * blocks * UNIT[0] / UNIT[1])))
    size = max(1, round(blocks / courses)) * UNIT[0], courses * UNIT[1]
    return mr.Masonry.running_bond(*size, UNIT, k_n=K_N, k_s=k_s, frequency=FREQUENCY if "one c/k" in scene else None)


def run(masonry: mr.Masonry, duration: float) -> mr.Response:
    """A run of some duration [s]."""
    case = mr.MasonryCase(masonry, duration, mr.GroundMotion(np.full(2, PUSH), float(np.clip(duration, 1e-5, 1.0))))
    return mr.solve_explicit(case, output_step=duration, threads=1)


def measured(scene: str, blocks: int, line_steps: float) -> Point:
    """The times of one size."""
    begun = time.thread_time()
    masonry = built(scene, blocks)
    first = run(masonry, 1e-6).stats
    setting_up = time.thread_time() - begun - first["stepping_processor_time"]
    h, lines = STEP_TAKEN * first["stable_timestep"], len(masonry.lines.k)
    stats = run(masonry, h * max(20, round(line_steps / lines))).stats
    return Point(scene, len(masonry.free), lines, h, setting_up, stats["stepping_processor_time"] / stats["steps"])


def exponent(blocks: Sequence[int], times: Sequence[float]) -> float:
    """Of the power law through the sizes from a hundred blocks on, or through all where they are smaller."""
    large = np.array(blocks) >= LARGE if sum(count >= LARGE for count in blocks) > 1 else np.full(len(blocks), True)
    return float(np.polyfit(np.log(np.array(blocks)[large]), np.log(np.array(times)[large]), 1)[0])


def drawn(points: Sequence[Point]) -> Figure:
    """Set-up, time of a step and time of a simulated second over the number of blocks."""
    figure = Figure(figsize=(7.4, 3.4), layout="constrained")
    panels = figure.subplots(1, 3, sharex=True)
    titles = ("all but the steps [s]", "one step [ms]", "a simulated second [s/s]")
    for ax, title, factor, name in zip(panels, titles, (1.0, 1e3, 1.0), ("setting_up", "step", "second"), strict=True):
        for scene in dict.fromkeys(one.scene for one in points):
            own = [one for one in points if one.scene == scene]
            blocks, times = [one.blocks for one in own], [factor * getattr(one, name) for one in own]
            ax.plot(blocks, times, label=NAMES[scene], **LOOKS[scene] | {"markerfacecolor": "none", "markersize": 4})
        ax.set(xscale="log", yscale="log")
        ax.xaxis.set_minor_formatter(NullFormatter())
        ax.set_xlabel("blocks that are free [-]")
        ax.set_title(f"CPU time of\n{title}", fontsize=9)
    below_figure(figure, panels[0], ncols=2, fontsize=8)
    return figure


def written(points: Sequence[Point], out: Path) -> None:
    """Draw, print and write."""
    plotting.save(drawn(points), out / "many_blocks.png")
    header = ["scene", "blocks", "lines", "step [us]", "set-up [s]", "time of a step [ms]", "ns a step and line"]
    header.append("s a simulated s")
    rows, powers = [], []
    for one in points:
        times = f"{one.setting_up:.3g}", f"{1e3 * one.step:.3g}", f"{1e9 * one.step / one.lines:.0f}"
        rows.append([one.scene, one.blocks, one.lines, f"{1e6 * one.h:.3g}", *times, f"{one.second:.3g}"])
    for scene in dict.fromkeys(one.scene for one in points):
        own = [one for one in points if one.scene == scene]
        blocks = [one.blocks for one in own]
        found = [exponent(blocks, [getattr(one, name) for one in own]) for name in ("setting_up", "step", "second")]
        powers.append([scene, *(f"{one:.2f}" for one in found)])
    exponents = cli.table(["exponent of the blocks", "set-up", "a step", "a simulated s"], powers)
    cli.report(out / "many_blocks", cli.table(header, rows) + "\n\n" + exponents, header, rows)


def main(argv: Sequence[str] | None = None) -> None:
    """Time every size, draw and print."""
    args = cli.parser(__doc__, "many_blocks").parse_args(argv)
    out = cli.folder(args.out)
    sizes = dict.fromkeys(SIZES, (8, 16)) if args.quick else SIZES
    for scene in sizes:
        measured(scene, 8, 1e4)  # compiles what is not compiled yet
    points = []
    with tqdm(total=sum(map(sum, sizes.values())), unit="block", disable=None, leave=False) as bar:
        for scene, counts in sizes.items():
            for count in counts:
                points.append(measured(scene, count, LINE_STEPS / 30 if args.quick else LINE_STEPS))
                bar.update(count)
    written(points, out)


if __name__ == "__main__":
    sys.exit(cli.run(main))
