"""Pictures of what accuracy costs: errors against steps and wall time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from numpy.typing import ArrayLike

from mjrock.plotting.style import below_figure

PEER_COLORS = ("0.1", "#1f77b4", "#2ca02c", "#d62728", "#9467bd")
"""A colour for each code of `peers`."""
GRID: dict[str, Any] = {"visible": True, "which": "major", "linewidth": 0.4, "color": "0.9"}


def convergence(ax: Axes, steps: ArrayLike, errors: Mapping[str, ArrayLike], order: int) -> Axes:
    """Errors against the step on logarithmic axes, with the slope of an order to compare by."""
    steps = np.asarray(steps, dtype=float)
    for (label, values), marker in zip(errors.items(), "osD^v", strict=False):
        ax.loglog(steps * 1e3, values, marker=marker, markersize=4, linewidth=1.2, label=label)
    anchor = min(float(np.min(np.asarray(v))) for v in errors.values())
    slope = 0.25 * anchor * (steps / steps.min()) ** order
    ax.loglog(steps * 1e3, slope, color="0.5", linewidth=0.8, linestyle="--", label=f"order {order}")
    ax.set_xticks(steps * 1e3)
    ax.xaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_minor_locator(NullLocator())
    ax.set_xlabel("step $h$ [ms]")
    ax.grid(**GRID)
    ax.legend(frameon=False, fontsize=8)
    return ax


def work_precision(
    points: Sequence[tuple[str, str, float, int, float]], error: str = "largest error of $e$ per rebound [-]"
) -> Figure:
    """Error against wall time and against steps, a column a case, with the Pareto front.

    Points are (case, method, seconds, steps, error); for a solver of SciPy's, steps are evaluations. `error` says what
    the errors are.
    """
    cases = list(dict.fromkeys(point[0] for point in points))
    methods = list(dict.fromkeys(point[1] for point in points if "lines" not in point[1]))
    figure = Figure(figsize=(4.2 * len(cases), 8.2), layout="constrained")
    axes = figure.subplots(2, len(cases), squeeze=False, sharey="col")
    for column, case in zip(axes.T, cases, strict=True):
        here = [point for point in points if point[0] == case and point[1] in methods]
        _errors(column[0], [(seconds, value, method) for _, method, seconds, _, value in here], methods)
        _errors(column[1], [(steps, value, method) for _, method, _, steps, value in here], methods)
        column[0].set_xlabel("wall time [s]")
        column[1].set_xlabel("steps [-]")
        column[0].set_title(case, fontsize=10)
    for ax in axes[:, 0]:
        ax.set_ylabel(error)
    below_figure(figure, axes[0, 0], ncols=4, fontsize=8)
    return figure


def peers(points: Sequence[tuple[str, str, float, float, float]]) -> Figure:
    """Error of |e| against wall time in several codes: a column a case, the contact law above and theory below.

    Points are (case, setup, wall time over simulated time, error against the law or NaN, error against theory). A
    setup is named "code, how", and those of one code share a colour. An error of 1 is a rebound that never comes.
    """
    cases, setups = list(dict.fromkeys(p[0] for p in points)), list(dict.fromkeys(p[1] for p in points))
    codes = list(dict.fromkeys(setup.split(",")[0] for setup in setups))
    figure = Figure(figsize=(4.6 * len(cases), 8.6), layout="constrained")
    axes = figure.subplots(2, len(cases), squeeze=False, sharex=True, sharey="row")
    for setup in setups:
        code = setup.split(",")[0]
        rank = [other for other in setups if other.split(",")[0] == code].index(setup)
        style = f"{'osD^'[rank]}{('-', '--', ':', '-.')[rank]}"
        color = PEER_COLORS[codes.index(code)]
        for column, case in zip(axes.T, cases, strict=True):
            rows = [point[2:] for point in points if point[:2] == (case, setup)]
            for ax, which in zip(column, (1, 2), strict=True):
                line = [(row[0], row[which]) for row in rows if np.isfinite(row[which])]
                ax.loglog(*np.reshape(line, (-1, 2)).T, style, color=color, linewidth=1.3, markersize=5, label=setup)
    for column, case in zip(axes.T, cases, strict=True):
        column[0].set_title(case, fontsize=10)
        column[1].set_xlabel("wall time / simulated time [-]")
        for ax in column:
            ax.axhline(1, color="0.7", linewidth=0.8, zorder=0)
            ax.annotate("a rebound is missing", (0.02, 1), xycoords=ax.get_yaxis_transform(), va="bottom", fontsize=7)
            ax.grid(**GRID)
    for ax, target in zip(axes[:, 0], ("the contact law", "rocking theory"), strict=True):
        ax.set_ylabel(f"largest error of $|e|$ against {target} [-]", fontsize=9)
    below_figure(figure, axes[0, 0], fontsize=8)
    return figure


def _errors(ax: Axes, points: Sequence[tuple[float, float, str]], methods: Sequence[str]) -> None:
    """Errors against a cost, a line a method, and the front that no method beats."""
    for i, (method, marker) in enumerate(zip(methods, "os^vD<>pPX*hd", strict=False)):
        errors = sorted((cost, error) for cost, error, name in points if name == method)
        if errors:
            color = f"C{i}" if i < 10 else ("0.15", "navy", "gold")[i - 10]
            ax.loglog(*np.transpose(errors), marker=marker, markersize=5, linewidth=1.2, color=color, label=method)
    front: list[tuple[float, float]] = []
    for cost, error, name in sorted(points):
        if name != "rocking theory" and (not front or error < front[-1][1]):
            front.append((cost, error))
    ax.loglog(*np.transpose(front), color="0.85", linewidth=7, zorder=0, label="Pareto front of the contact law")
    ax.grid(**GRID)
