"""Pictures of what accuracy costs: errors against steps and wall time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from numpy.typing import ArrayLike


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
    ax.grid(True, which="major", linewidth=0.4, color="0.9")
    ax.legend(frameon=False, fontsize=8)
    return ax


def work_precision(points: Sequence[tuple[str, str, float, int, float]]) -> Figure:
    """Error against wall time and against steps, a column a case, with the Pareto front.

    Points are (case, method, seconds, steps, error); for a solver of SciPy's, steps are evaluations.
    """
    cases = list(dict.fromkeys(point[0] for point in points))
    methods = list(dict.fromkeys(point[1] for point in points if "lines" not in point[1]))
    figure = Figure(figsize=(4.2 * len(cases), 8.2), layout="constrained")
    axes = figure.subplots(2, len(cases), squeeze=False, sharey="col")
    for column, case in zip(axes.T, cases, strict=True):
        here = [point for point in points if point[0] == case and point[1] in methods]
        _errors(column[0], [(seconds, error, method) for _, method, seconds, _, error in here], methods)
        _errors(column[1], [(steps, error, method) for _, method, _, steps, error in here], methods)
        column[0].set_xlabel("wall time [s]")
        column[1].set_xlabel("steps [-]")
        column[0].set_title(case, fontsize=10)
    for ax in axes[:, 0]:
        ax.set_ylabel("largest error of $e$ per rebound [-]")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def _errors(ax: Axes, points: Sequence[tuple[float, float, str]], methods: Sequence[str]) -> None:
    """Errors against a cost, a line a method, and the front that no method beats."""
    for i, (method, marker) in enumerate(zip(methods, "os^vD<>pPX*hd", strict=False)):
        own = sorted((cost, error) for cost, error, name in points if name == method)
        if own:
            color = f"C{i}" if i < 10 else ("0.15", "navy", "gold")[i - 10]
            ax.loglog(*np.transpose(own), marker=marker, markersize=5, linewidth=1.2, color=color, label=method)
    front: list[tuple[float, float]] = []
    for cost, error, name in sorted(points):
        if name != "rocking theory" and (not front or error < front[-1][1]):
            front.append((cost, error))
    ax.loglog(*np.transpose(front), color="0.85", linewidth=7, zorder=0, label="Pareto front of the contact law")
    ax.grid(True, which="major", linewidth=0.4, color="0.9")
