"""Overturning spectrum of a sine pulse: which amplitudes and frequencies overturn a wall, and after how many impacts.

Two-sided, and one-sided in either polarity, by rocking theory and by MuJoCo, for the wall of the paper's Figure 3.
Amplitudes are in multiples of what lifts the wall, frequencies in multiples of its frequency parameter p. An island of
standing walls above the lowest amplitude that overturns is the two modes at work: with and without an impact.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import legend_below
from mjrock.study.intensity.overturning_map import ENDINGS
from scripts.shared import cli, suite
from scripts.shared.paper import FIGURE_3

SIDES = {"two-sided": (False, -1), "one-sided, outward first": (True, -1), "one-sided, inward first": (True, 1)}
SIZES = {"analytical": 60, "MuJoCo": 26}
MODES = ENDINGS[:3]
LIFTING = mr.GRAVITY * math.tan(FIGURE_3.alpha)
"""What lifts the wall [m/s2]."""


def analysis(amplitude: float, period: float, solver: str, sides: str) -> mr.Analysis:
    """The wall under a pulse [m/s2, s]."""
    side_stop, sign = SIDES[sides]
    motion = mr.GroundMotion.sine(sign * amplitude, period, samples=200)
    return suite.analysis(FIGURE_3, motion, solver, k_n=suite.STIFF, side_stop=side_stop, settling=10 / FIGURE_3.p)


def drawn(maps: Mapping[tuple[str, str], mr.OverturningMap]) -> Figure:
    """A row a solver, a column a kind of wall."""
    figure = Figure(figsize=(7.4, 5.4), layout="constrained")
    axes = figure.subplots(len(SIZES), len(SIDES), sharex=True, sharey=True)
    handles: dict[str, Artist] = {}
    for ax, ((solver, sides), found) in zip(axes.flat, maps.items(), strict=True):
        plotting.overturning_map(ax, found, FIGURE_3)
        legend = ax.get_legend()
        handles |= {text.get_text(): cell for text, cell in zip(legend.texts, legend.legend_handles, strict=True)}
        for extra in (legend, *ax.child_axes):
            extra.remove()
        ax.set_title(f"{plotting.STYLES[solver]['label']},\n{sides}", fontsize=9)
        ax.label_outer()
    legend_below(figure, list(handles.values()), list(handles), len(handles), fontsize=9)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run the maps, draw them, and print how much of each is what."""
    args = suite.parser(__doc__, "overturning_spectrum", records=False).parse_args(argv)
    out = cli.folder(args.out)
    table, rows, maps = [], [], dict[tuple[str, str], mr.OverturningMap]()
    for solver, size in SIZES.items():
        n = 3 if args.quick else size
        periods, amplitudes = 2 * math.pi / (np.linspace(8.0, 0.5, n) * FIGURE_3.p), np.linspace(0.5, 14.0, n) * LIFTING
        for sides in SIDES:
            build = partial(analysis, solver=solver, sides=sides)
            store = out / "overturning_spectrum.sqlite"
            maps[solver, sides] = found = mr.overturning_map(build, amplitudes, periods, store, workers=args.workers)
            shares = [(found.endings == i).mean() for i in range(len(MODES))]
            label = plotting.STYLES[solver]["label"]
            table.append([label, sides, n * n, *(f"{s:.3f}" for s in (*shares, found.islands.mean()))])
            rows += [
                (solver, sides, f"{2 * math.pi / (T * FIGURE_3.p):.4f}", f"{a / LIFTING:.4f}", MODES[m])
                for T, column in zip(periods[::-1], found.endings[::-1], strict=True)
                for a, m in zip(amplitudes, column, strict=True)
            ]
    plotting.save(drawn(maps), out / "overturning_spectrum.png")
    header = ["solver", "sides", "omega_p/p [-]", "a_p/(g tan alpha) [-]", "mode"]
    text = cli.table(["solver", "wall", "cases", *MODES, "safe islands"], table)
    cli.report(out / "overturning_spectrum", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
