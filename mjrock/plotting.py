"""Pictures: functions that draw on an Axes and return it. The only module that imports matplotlib."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import NullFormatter, NullLocator
from numpy.typing import ArrayLike

from .fragility import Fragility
from .response import Response

STYLES: dict[str, dict[str, Any]] = {
    "analytical": {"label": "rocking theory", "color": "0.15", "linestyle": "-", "linewidth": 1.1},
    "MuJoCo": {"label": "MuJoCo", "color": "#f0a35e", "linestyle": "-", "linewidth": 2.6, "zorder": 1.5},
    "compliant": {"label": "contact law, SciPy", "color": "#12406b", "linestyle": ":", "linewidth": 1.5, "zorder": 3},
}
"""Lines that a black-and-white print still tells apart."""


def rotation(ax: Axes, responses: Sequence[Response]) -> Axes:
    """Rotation in multiples of alpha against time."""
    for response in responses:
        ax.plot(response.t, response.theta / response.case.block.alpha, **_style(response))
    ax.axhline(0, color="0.8", linewidth=0.6, zorder=0)
    ax.set_xlabel("time $t$ [s]")
    ax.set_ylabel(r"rotation $\theta/\alpha$ [-]")
    return ax


def energy(ax: Axes, responses: Sequence[Response]) -> Axes:
    """Energy above the wall at rest against time."""
    for response in responses:
        ax.plot(response.t, response.energy / 1e3, **_style(response))
    ax.set_ylim(bottom=0)
    ax.set_xlabel("time $t$ [s]")
    ax.set_ylabel("total energy $E$ [kJ]")
    return ax


def comparison(responses: Sequence[Response], title: str = "") -> Figure:
    """Rotation above, energy below, in the manner of the paper's Figure 3."""
    figure = Figure(figsize=(6.3, 5.0), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    rotation(above, responses).set_xlabel("")
    energy(below, responses)
    below.set_xlim(0, max(r.t[-1] for r in responses))
    figure.legend(*above.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    above.set_title(title, fontsize=10)
    return figure


def grid(panels: Sequence[tuple[str, Sequence[Response]]], columns: int = 2, top: float | None = None) -> Figure:
    """Rotation histories of several cases, one panel each, in the manner of the paper's Figure 4.

    `top` cuts the panels off at a rotation in multiples of alpha, to show small rebounds large.
    """
    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(3.4 * columns, 2.2 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    for ax, (title, responses) in zip(axes.flat, panels, strict=False):
        rotation(ax, responses).set_title(title, fontsize=9)
        if top is not None:
            ax.set_ylim(-0.1 * top, top)
    for ax in axes.flat[len(panels) :]:
        ax.set_visible(False)
    for ax in axes[:-1].flat:
        ax.set_xlabel("")
    for ax in axes[:, 1:].flat:
        ax.set_ylabel("")
    axes[0, 0].legend(loc="upper right", frameon=False, fontsize=8)
    return figure


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


def save(figure: Figure, path: Path) -> Path:
    """Write a figure, in the format of the path's suffix, without traces of when and by what (reproducible bytes)."""
    figure.savefig(path, dpi=200, metadata={"Software": None} if path.suffix == ".png" else None)
    return path


def single(draw: Callable[[Axes], Axes], size: tuple[float, float] = (5.2, 3.6)) -> Figure:
    """A figure with one Axes, drawn by `draw`."""
    figure = Figure(figsize=size, layout="constrained")
    draw(figure.subplots())
    return figure


def _style(response: Response) -> dict[str, Any]:
    return STYLES.get(response.solver, {"label": response.solver})


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


MODES = {"stands": "#f3f1ea", "overturns after impacts": "#f0a35e", "overturns without impact": "#12406b"}
"""How a wall takes a pulse, and colours that a black-and-white print still tells apart."""


def overturning_map(ax: Axes, frequency: ArrayLike, amplitude: ArrayLike, mode: ArrayLike) -> Axes:
    """Overturning spectrum of a pulse: `mode` (an index into MODES) over frequency and amplitude, shape (n_a, n_f)."""
    colours = ListedColormap(list(MODES.values()))
    ax.pcolormesh(frequency, amplitude, mode, cmap=colours, vmin=-0.5, vmax=len(MODES) - 0.5, rasterized=True)
    ax.set_xlabel(r"frequency $\omega_p/p$ [-]")
    ax.set_ylabel(r"amplitude $a_p/(g\,\tan\alpha)$ [-]")
    return ax


def mode_legend(figure: Figure) -> None:
    """What the colours of `overturning_map` stand for, below the figure."""
    handles = [Patch(facecolor=colour, edgecolor="0.4", linewidth=0.5, label=name) for name, colour in MODES.items()]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=9)


def incremental(ax: Axes, intensity: ArrayLike, peaks: ArrayLike, solver: str, top: float = 1.2) -> Axes:
    """Incremental dynamic analysis: peak rotation against intensity, a line a motion, with its 16, 50, 84 % fractiles.

    `peaks` are multiples of alpha, shape (motions, intensities); infinity stands for overturning, drawn at `top`.
    """
    levels, values = np.asarray(intensity, dtype=float), np.asarray(peaks, dtype=float)
    shown = np.minimum(values, top)
    ax.plot(levels, shown.T, color="0.75", linewidth=0.6)
    fractiles = np.minimum(np.percentile(values, [16, 50, 84], axis=0, method="nearest"), top)
    for line, style, label in zip(fractiles, (":", "-", "--"), ("16 %", "median", "84 %"), strict=True):
        ax.plot(levels, line, color="#12406b", linewidth=1.8, linestyle=style, label=label)
    ax.set_ylim(0, 1.03 * top)
    ax.axhline(1, color="0.3", linewidth=0.6)
    ax.set_xlim(0, levels.max())
    ax.set_title(STYLES.get(solver, {}).get("label", solver), fontsize=10)
    ax.set_xlabel("peak ground acceleration [g]")
    ax.set_ylabel(r"peak rotation $\theta_{max}/\alpha$ [-]")
    return ax


def fragility(ax: Axes, fit: Fragility, levels: ArrayLike, shares: ArrayLike, solver: str, marker: str) -> Axes:
    """A fragility curve with its 90 % band, and the share overturned at each level."""
    style = STYLES.get(solver, {})
    colour = style.get("color", "C0")
    points = np.asarray(levels, dtype=float)
    x = np.linspace(0.02 * points.max(), points.max(), 300)
    low, high = fit.band(x)
    ax.fill_between(x, low, high, color=colour, alpha=0.2, linewidth=0)
    ax.plot(x, fit.probability(x), color=colour, linestyle=style.get("linestyle", "-"), linewidth=1.8)
    label = f"{style.get('label', solver)}: {fit.median:.2f} g, {fit.dispersion:.2f}"
    ax.plot(points, shares, marker=marker, linestyle="", color=colour, markersize=5, label=label)
    ax.set_xlim(0, points.max())
    ax.set_ylim(-0.02, 1.02)
    ax.set_xlabel("peak ground acceleration [g]")
    ax.set_ylabel("share of walls overturned [-]")
    return ax


def distributions(ax: Axes, samples: Mapping[str, ArrayLike], least: float = 1e-3, most: float = 1.0) -> Axes:
    """Share of runs whose peak rotation stays below a value, a line a solver; overturned runs lie beyond `most`."""
    for solver, values in samples.items():
        style = {k: v for k, v in STYLES.get(solver, {"label": solver}).items() if k != "linestyle"}
        ordered = np.sort(np.clip(np.asarray(values, dtype=float), least, 10 * most))
        ax.step(ordered, np.arange(1, len(ordered) + 1) / len(ordered), where="post", **style)
    ax.set_xscale("log")
    ax.set_xlim(least, most)
    ax.set_ylim(0, 1)
    ax.set_xlabel(r"peak rotation $\theta_{max}/\alpha$ [-]")
    ax.set_ylabel("share of runs below it [-]")
    return ax


def pairs(ax: Axes, values: ArrayLike, names: tuple[str, str], limits: tuple[float, float]) -> Axes:
    """Peak rotations of the same cases in two ways, on logarithmic axes; what falls lies on the upper edge.

    `values` are multiples of alpha, shape (n, 2).
    """
    low, high = limits
    a, b = np.clip(np.asarray(values, dtype=float), low, high).T
    ax.plot([low, high], [low, high], color="0.6", linewidth=0.8)
    ax.loglog(a, b, linestyle="", marker="o", markersize=3.5, markeredgewidth=0, alpha=0.55, color="#12406b")
    ax.set_xlim(0.8 * low, 1.25 * high)
    ax.set_ylim(0.8 * low, 1.25 * high)
    ax.set_aspect("equal")
    ax.set_xlabel(rf"$\theta_{{max}}/\alpha$, {names[0]} [-]")
    ax.set_ylabel(rf"$\theta_{{max}}/\alpha$, {names[1]} [-]")
    return ax


def damping_curves(
    ax: Axes, families: Sequence[tuple[str, tuple[ArrayLike, ArrayLike], tuple[ArrayLike, ArrayLike]]]
) -> Axes:
    """Matched damping ratios against the restitution asked for, and the fitted curve of each combination.

    Families are (label, (e, xi) of the matches, (e, xi) of the curve).
    """
    for i, ((label, matches, curve), marker) in enumerate(zip(families, "os^vD<>p", strict=False)):
        color = colormaps["viridis"](0.9 * i / max(1, len(families) - 1))
        ax.semilogy(*curve, color=color, linewidth=1.2)
        ax.semilogy(*matches, linestyle="", marker=marker, markersize=4, color=color, label=label)
    ax.set_xlabel("restitution asked for $|e|$ [-]")
    ax.set_ylabel(r"damping ratio $\xi$ [-]")
    ax.locator_params(axis="x", nbins=6)
    ax.set_ylim(bottom=0.1 * ax.get_ylim()[0])  # room for the legend
    ax.legend(frameon=False, fontsize=7, loc="lower left", ncols=2)
    return ax


def parity(ax: Axes, matched: ArrayLike, predicted: ArrayLike, color: ArrayLike) -> Axes:
    """Predicted against matched damping ratios, on logarithmic axes, coloured by the softness of the base."""
    x, y = np.asarray(matched, dtype=float), np.asarray(predicted, dtype=float)
    limits = 0.8 * min(x.min(), y.min()), 1.25 * max(x.max(), y.max())
    ax.loglog(limits, limits, color="0.5", linewidth=0.8)
    ax.scatter(x, y, c=np.log10(np.asarray(color, dtype=float)), s=6, cmap="viridis", linewidth=0)
    ax.set_xlim(limits)
    ax.set_ylim(limits)
    ax.set_xlabel(r"matched $\xi$ [-]")
    ax.set_ylabel(r"predicted $\xi$ [-]")
    return ax


def residuals(title: str, residual: ArrayLike, variables: Mapping[str, tuple[ArrayLike, str]]) -> Figure:
    """Predicted over matched damping ratio against each variable; a variable is its values and its scale."""
    figure = Figure(figsize=(2.3 * len(variables), 2.5), layout="constrained")
    axes = figure.subplots(1, len(variables), sharey=True, squeeze=False)[0]
    for ax, (name, (values, scale)) in zip(axes, variables.items(), strict=True):
        ax.plot(values, residual, linestyle="", marker="o", markersize=2, markeredgewidth=0, alpha=0.6, color="#12406b")
        ax.axhline(1, color="0.5", linewidth=0.8)
        ax.set_xscale(scale)
        ax.xaxis.set_minor_formatter(NullFormatter())
        ax.set_yscale("log")
        ax.set_xlabel(name)
    axes[0].set_ylabel(r"predicted $\xi$ / matched $\xi$ [-]")
    figure.suptitle(title, fontsize=10)
    return figure


def sensitivity(ax: Axes, curves: Mapping[str, tuple[ArrayLike, ArrayLike]]) -> Axes:
    """Damping ratio, over its mean, as each parameter goes through its range; a line a parameter."""
    for (name, (shares, ratios)), marker in zip(curves.items(), "os^vD<>p", strict=False):
        ax.semilogy(shares, ratios, marker=marker, markersize=4, linewidth=1.2, label=name)
    ax.axhline(1, color="0.6", linewidth=0.6)
    ax.set_xlabel("place in the range of Table 1 [-]")
    ax.set_ylabel(r"$\xi$ over its mean [-]")
    ax.legend(frameon=False, fontsize=7)
    return ax


def obtained(ax: Axes, samples: Mapping[str, tuple[ArrayLike, ArrayLike]]) -> Axes:
    """Restitution obtained against the one asked for; samples are (asked for, obtained) by law. NaN is not drawn."""
    wanted = np.concatenate([np.asarray(asked, dtype=float) for asked, _ in samples.values()])
    limits = wanted.min(), wanted.max()
    ax.plot(limits, limits, color="0.5", linewidth=0.8)
    for (name, (asked, found)), marker, color in zip(
        samples.items(), "x.s", ("#f0a35e", "#12406b", "0.4"), strict=False
    ):
        ax.plot(asked, found, linestyle="", marker=marker, markersize=5, color=color, label=name)
    ax.set_xlabel("restitution asked for $|e|$ [-]")
    ax.set_ylabel("restitution obtained $|e|$ [-]")
    ax.legend(frameon=False, fontsize=8)
    return ax


Drawing = Callable[[Axes], Axes]
"""What a panel needs."""


def panels(drawings: Sequence[tuple[str, Drawing]], columns: int = 2) -> Figure:
    """Several drawings, each on an Axes of its own under its title."""
    rows = -(-len(drawings) // columns)
    figure = Figure(figsize=(4.4 * columns, 3.4 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    for ax, (title, draw) in zip(axes.flat, drawings, strict=False):
        draw(ax).set_title(title, fontsize=10)
    for ax in axes.flat[len(drawings) :]:
        ax.set_visible(False)
    return figure
