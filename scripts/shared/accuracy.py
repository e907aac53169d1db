"""Pictures of what accuracy costs: errors against steps and wall time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullLocator
from numpy.typing import ArrayLike

from mjrock.plotting.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PALETTE,
    PURPLE,
    WIDEST,
    Look,
    Picture,
    figure_of_panels,
    legend_below,
)
from scripts.shared.labels import SMALL, beside

CODES = (BLACK, ORANGE, GREEN, BLUE, PURPLE)
"""A colour for each code of `peers`."""
GRID: dict[str, Any] = {"visible": True, "which": "major", "linewidth": 0.4, "color": "0.9"}


def convergence(ax: Axes, steps: ArrayLike, errors: Mapping[str, ArrayLike], order: int) -> Axes:
    """Errors against the step on logarithmic axes, with the slope of an order to compare by."""
    steps = np.asarray(steps, dtype=float)
    for (label, values), marker, colour in zip(errors.items(), "osD^v", PALETTE, strict=False):
        row = np.asarray(values, dtype=float)
        ax.loglog(steps * 1e3, row, marker=marker, markersize=4, linewidth=1.2, color=colour)
        beside(ax, (1e3 * steps.max(), row[steps.argmax()]), label, colour, (10, 0))
    anchor = min(float(np.min(np.asarray(v))) for v in errors.values())
    slope = 0.25 * anchor * (steps / steps.min()) ** order
    ax.loglog(steps * 1e3, slope, color="0.5", linewidth=0.8, linestyle="--")
    beside(ax, (1e3 * steps.max(), slope.max()), f"order {order}", "0.4", (10, 0))
    ax.set_xlim(1e3 * steps.min() / 1.04, 1e3 * steps.max() * 1.04)
    ax.set_xticks(steps * 1e3)
    ax.xaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_minor_locator(NullLocator())
    ax.set_xlabel("step $h$ [ms]")
    ax.grid(**GRID)
    return ax


def work_precision(
    points: Sequence[tuple[str, str, float, float]],
    looks: Mapping[str, Look],
    error: str = "largest error of $e$ per rebound [-]",
    cost: str = "wall time [s]",
) -> Figure:
    """Error against time, a panel a case, with the Pareto front.

    Points are (case, method, seconds, error). Methods of `looks` have the label, colour and line that it gives them,
    and all others are thin and grey.
    """
    cases, methods = list(dict.fromkeys(p[0] for p in points)), list(dict.fromkeys(p[1] for p in points))
    figure, axes = figure_of_panels(len(cases), min(2, len(cases)), (4.2, 3.4))
    for ax, case in zip(axes.flat, cases, strict=False):
        _errors(ax, {m: sorted(p[2:] for p in points if p[:2] == (case, m)) for m in methods}, looks)
        ax.set_xlabel(cost)
        ax.set_title(case, fontsize=10)
    for ax in axes[:, 0]:
        ax.set_ylabel(error)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    legend_below(figure, handles, labels, 3, fontsize=SMALL)
    return figure


def peers(points: Sequence[tuple[str, str, float, float, float]], highlighted: Mapping[str, str]) -> Figure:
    """Error of |e| against wall time in several codes: a column a case, the contact law above and theory below.

    Points are (case, setup, wall time over simulated time, error against the law or NaN, error against theory). A
    setup is named "code, how". Those of `highlighted` have the colour of their code and a label, and the others are
    grey. An error of 1 is a rebound that never comes.
    """
    cases, setups = list(dict.fromkeys(p[0] for p in points)), list(dict.fromkeys(p[1] for p in points))
    codes = list(dict.fromkeys(setup.split(",")[0] for setup in setups))
    figure = Picture(figsize=(WIDEST, 7.2), layout="constrained")
    axes = figure.subplots(2, len(cases), squeeze=False, sharex=True, sharey="row")
    for setup in sorted(setups, key=lambda one: one in highlighted):
        style: Look = {"color": "0.75", "marker": ".", "linewidth": 0.7}
        if setup in highlighted:
            code = codes.index(setup.split(",")[0])
            dashes = "--" if setup == "mjrock, as_theory" else "-"
            style = {"color": CODES[code], "marker": "osD^v"[code], "linestyle": dashes, "linewidth": 1.5}
            style |= {"label": highlighted[setup], "markersize": 4, "zorder": 3}
        for column, case in zip(axes.T, cases, strict=True):
            rows = [point[2:] for point in points if point[:2] == (case, setup)]
            for ax, which in zip(column, (1, 2), strict=True):
                line = [(row[0], row[which]) for row in rows if np.isfinite(row[which])]
                ax.loglog(*np.reshape(line, (-1, 2)).T, **style)
    for column, case in zip(axes.T, cases, strict=True):
        column[0].set_title(case, fontsize=10)
        column[1].set_xlabel("wall time / simulated time [-]")
        for ax in column:
            ax.axhline(1, color="0.7", linewidth=0.8, zorder=0)
            ax.annotate(
                "a rebound is missing", (0.98, 1.3), xycoords=ax.get_yaxis_transform(), ha="right", fontsize=SMALL
            )
            ax.set_ylim(top=3)
            ax.grid(**GRID)
    for ax, target in zip(axes[:, 0], ("the contact law", "rocking theory"), strict=True):
        ax.set_ylabel(f"largest error of $|e|$\nagainst {target} [-]", fontsize=9)
    others = Line2D([], [], color="0.75", marker=".", linewidth=0.7)
    handles, labels = axes[1, 0].get_legend_handles_labels()
    legend_below(figure, [*handles, others], [*labels, "other ways to set up these codes"], 3, fontsize=SMALL)
    return figure


def _errors(ax: Axes, lines: Mapping[str, Sequence[tuple[float, float]]], looks: Mapping[str, Look]) -> None:
    """Errors against a cost, a line a method, and the front that no method beats."""
    for method, line in lines.items():
        if line and method not in looks:
            ax.loglog(*np.transpose(line), marker=".", markersize=3, linewidth=0.6, color="0.7")
    for i, (method, look) in enumerate(looks.items()):
        if lines.get(method):
            drawn: Look = {"marker": "os^Dv"[i % 5], "markersize": 4, "linewidth": 1.4, "linestyle": "-"} | look
            ax.loglog(*np.transpose(lines[method]), **drawn)
    front: list[tuple[float, float]] = []
    for cost, error in sorted(point for name, line in lines.items() if name != "rocking theory" for point in line):
        if not front or error < front[-1][1]:
            front.append((cost, error))
    ax.loglog(*np.transpose(front), color="0.9", linewidth=7, zorder=0, label="best of the contact law")
    ax.grid(**GRID)
