"""Overturning spectrum of a sine pulse: which amplitudes and frequencies overturn a wall, and after how many impacts.

Two-sided, and one-sided in either polarity, by rocking theory and by MuJoCo, for the wall of the paper's Figure 3.
Amplitudes are in multiples of what lifts the wall, frequencies in multiples of its frequency parameter p. An island of
standing walls above the lowest amplitude that overturns is the two modes at work: with and without an impact.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import ArrayLike

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLUE, ORANGE, legend_below
from mjrock.quantities import Array
from mjrock.study.campaign.campaign import completed
from scripts.shared import cli, suite
from scripts.shared.paper import FIGURE_3

SIDES = {"two-sided": (False, -1), "one-sided, outward first": (True, -1), "one-sided, inward first": (True, 1)}
SIZES = {"analytical": 60, "MuJoCo": 26}
MODES = {"stands": "#f3f1ea", "overturns after impacts": ORANGE, "overturns without impact": BLUE}
"""How a wall takes a pulse, and colours that a black-and-white print still tells apart."""


def build(solver: str, sides: str, frequency: float, amplitude: float) -> mr.Analysis:
    """The wall under a pulse of `amplitude` g tan(alpha) and `frequency` p."""
    side_stop, sign = SIDES[sides]
    lifting = mr.GRAVITY * math.tan(FIGURE_3.alpha)
    motion = mr.GroundMotion.sine(sign * amplitude * lifting, 2 * math.pi / (frequency * FIGURE_3.p), samples=200)
    return suite.analysis(FIGURE_3, motion, solver, k_n=suite.STIFF, side_stop=side_stop, settling=10 / FIGURE_3.p)


def mode(row: dict[str, Any]) -> int:
    """Which of `MODES`."""
    if row["outcome"] != mr.Outcome.OVERTURNED.value:
        return 0
    return 1 if row["impacts"] else 2


def overturning_map(ax: Axes, frequency: ArrayLike, amplitude: ArrayLike, mode: ArrayLike) -> Axes:
    """Overturning spectrum of a pulse: `mode` (an index into MODES) over frequency and amplitude, shape (n_a, n_f)."""
    colours = ListedColormap(list(MODES.values()))
    ax.pcolormesh(frequency, amplitude, mode, cmap=colours, vmin=-0.5, vmax=len(MODES) - 0.5, rasterized=True)
    ax.set(xlabel=r"frequency $\omega_p/p$ [-]", ylabel=r"amplitude $a_p/(g\,\tan\alpha)$ [-]")
    return ax


def mode_legend(figure: Figure) -> None:
    """What the colours of `overturning_map` stand for, below the figure."""
    handles = [Patch(facecolor=colour, edgecolor="0.4", linewidth=0.5, label=name) for name, colour in MODES.items()]
    legend_below(figure, handles, list(MODES), len(handles), fontsize=9)


def drawn(maps: Mapping[tuple[str, str], tuple[Array, Array, Array]]) -> Figure:
    """A row a solver, a column a kind of wall, of frequencies, amplitudes and modes, shapes (n,), (n,) and (n, n)."""
    figure = Figure(figsize=(7.4, 5.4), layout="constrained")
    axes = figure.subplots(len(SIZES), len(SIDES), sharex=True, sharey=True)
    for ax, ((solver, sides), (frequency, amplitude, modes)) in zip(axes.flat, maps.items(), strict=True):
        overturning_map(ax, frequency, amplitude, modes.T)
        ax.set_title(f"{plotting.STYLES[solver]['label']},\n{sides}", fontsize=9)
        ax.label_outer()
    mode_legend(figure)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run the maps, draw them, and print how much of each is what."""
    args = suite.parser(__doc__, "overturning_spectrum", records=False).parse_args(argv)
    out = cli.folder(args.out)
    table, rows, maps = [], [], dict[tuple[str, str], tuple[Array, Array, Array]]()
    for solver, size in SIZES.items():
        n = 4 if args.quick else size
        frequency, amplitude = np.linspace(0.5, 8.0, n), np.linspace(0.5, 14.0, n)
        grid = mr.Grid(build, solver=[solver], sides=SIDES, frequency=frequency.tolist(), amplitude=amplitude.tolist())
        found = np.array(
            [mode(row) for row in completed(grid, out / "overturning_spectrum.sqlite", workers=args.workers)]
        )
        for sides, modes in zip(SIDES, found.reshape(3, n, n), strict=True):
            maps[solver, sides] = frequency, amplitude, modes
            falls = modes > 0
            lowest = np.array([amplitude[column.argmax()] if column.any() else math.inf for column in falls])
            island = (~falls & (amplitude[None] > lowest[:, None])).mean()
            shares = [(modes == i).mean() for i in range(3)]
            table.append([plotting.STYLES[solver]["label"], sides, n * n, *(f"{s:.3f}" for s in (*shares, island))])
            rows += [
                (solver, sides, f"{f:.4f}", f"{a:.4f}", list(MODES)[m])
                for f, column in zip(frequency, modes, strict=True)
                for a, m in zip(amplitude, column, strict=True)
            ]
    plotting.save(drawn(maps), out / "overturning_spectrum.png")
    header = ["solver", "sides", "omega_p/p [-]", "a_p/(g tan alpha) [-]", "mode"]
    text = cli.table(["solver", "wall", "cases", *MODES, "safe islands"], table)
    cli.report(out / "overturning_spectrum", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
