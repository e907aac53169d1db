"""Pictures of earthquake studies."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import ArrayLike

from ..problem.ground.code_spectrum import CodeSpectrum, FloorSpectrum
from ..problem.ground.motion import GroundMotion
from ..problem.ground.record_sets import RecordSet
from ..problem.ground.spectrum import response_spectrum
from ..quantities import GRAVITY
from ..study.intensity.fragility import Fragility
from .arguments import equal_rows, finite_row, kind, listed, mapping, picture, row, table
from .style import STYLES, folded, legend_below

MODES = {"stands": "#f3f1ea", "overturns after impacts": "#f0a35e", "overturns without impact": "#12406b"}
"""How a wall takes a pulse, and colours that a black-and-white print still tells apart."""

PEAK = r"peak rotation $\theta_{max}/\alpha$ [-]"


@picture(frequency=finite_row, amplitude=finite_row, mode=table)
def overturning_map(ax: Axes, frequency: ArrayLike, amplitude: ArrayLike, mode: ArrayLike) -> Axes:
    """Overturning spectrum of a pulse: `mode` (an index into MODES) over frequency and amplitude, shape (n_a, n_f)."""
    shape = len(amplitude), len(frequency)  # type: ignore[arg-type]
    if np.shape(mode) != shape:
        raise ValueError(f"mode has the shape {np.shape(mode)}; {shape} is needed, amplitudes by frequencies")
    colours = ListedColormap(list(MODES.values()))
    ax.pcolormesh(frequency, amplitude, mode, cmap=colours, vmin=-0.5, vmax=len(MODES) - 0.5, rasterized=True)
    ax.set(xlabel=r"frequency $\omega_p/p$ [-]", ylabel=r"amplitude $a_p/(g\,\tan\alpha)$ [-]")
    return ax


def mode_legend(figure: Figure) -> None:
    """What the colours of `overturning_map` stand for, below the figure."""
    handles = [Patch(facecolor=colour, edgecolor="0.4", linewidth=0.5, label=name) for name, colour in MODES.items()]
    legend_below(figure, handles, list(MODES), len(handles), fontsize=9)


def of_records(name: str, value: Any) -> None:
    """At least one motion, or a set of at least one record."""
    listed(kind(GroundMotion))(name, value.horizontal if isinstance(value, RecordSet) else value)


@picture(motions=of_records, periods=finite_row, target=kind(CodeSpectrum, FloorSpectrum))
def spectra(
    ax: Axes,
    motions: Sequence[GroundMotion] | RecordSet,
    periods: ArrayLike,
    target: CodeSpectrum | FloorSpectrum | None = None,
    damping: float = 0.05,
) -> Axes:
    """Pseudo-acceleration of each motion over the period, with their mean and the spectrum that they are scaled to.

    Of a set of records it draws the horizontal components.
    """
    T = np.asarray(periods, dtype=float)
    motions = motions.horizontal if isinstance(motions, RecordSet) else motions
    found = np.array([response_spectrum(motion, T, damping).Sa for motion in motions]) / GRAVITY
    for i, line in enumerate(found):
        ax.plot(T, line, color="0.7", linewidth=0.7, label="records" if i == 0 else None)
    ax.plot(T, found.mean(axis=0), color="#12406b", linewidth=2.0, label=f"mean of {len(found)}")
    if target is not None:
        ax.plot(T, target(T, damping) / GRAVITY, color="#f0a35e", linewidth=2.0, linestyle="--", label="target")
    ax.set(xlim=(T.min(), T.max()), ylim=(0, None), xlabel="period $T$ [s]")
    ax.set_ylabel(f"pseudo-acceleration $S_a$, {damping:.0%} damping [g]")
    ax.legend(frameon=False, fontsize=8)
    return ax


@picture()
def incremental(ax: Axes, intensity: ArrayLike, peaks: ArrayLike, solver: str, top: float | None = None) -> Axes:
    """Incremental dynamic analysis: peak rotation against intensity, a line a motion, with its 16, 50, 84 % fractiles.

    `peaks` are multiples of alpha, shape (motions, intensities). Infinity stands for overturning, drawn at `top`. None
    is 1.2, or above the largest peak of a wall that stands: one on ties may stand beyond alpha.
    """
    levels, values = np.asarray(intensity, dtype=float), np.asarray(peaks, dtype=float)
    if values.shape[1] != len(levels):
        raise ValueError(
            f"peaks has the shape {values.shape}; a column for each of {len(levels)} intensities is needed"
        )
    if top is None:
        top = max(1.2, 1.15 * float(values[np.isfinite(values)].max(initial=0.0)))
    shown = np.minimum(values, top)
    mark = "" if levels.size > 1 else "o"  # a line of one point is none
    ax.plot(levels, shown.T, color="0.75", linewidth=0.6, marker=mark)
    fractiles = np.minimum(np.percentile(values, [16, 50, 84], axis=0, method="nearest"), top)
    for line, style, label in zip(fractiles, (":", "-", "--"), ("16 %", "median", "84 %"), strict=True):
        ax.plot(levels, line, color="#12406b", linewidth=1.8, linestyle=style, marker=mark, label=label)
    ax.axhline(1, color="0.3", linewidth=0.6)
    ax.axhline(top, color="0.3", linewidth=0.6, linestyle=":")
    ax.text(0.01 * levels.max(), top, "overturned", fontsize=7, va="top", color="0.3")
    ax.set(xlim=(0, levels.max()), ylim=(0, 1.03 * top))
    ax.legend(frameon=False, fontsize=7, loc="center left")
    ax.set_title(STYLES.get(solver, {}).get("label", solver), fontsize=10)
    ax.set(xlabel="peak ground acceleration [g]", ylabel=PEAK)
    return ax


@picture()
def fragility(
    ax: Axes,
    fit: Fragility,
    levels: ArrayLike | None = None,
    shares: ArrayLike | None = None,
    solver: str | None = None,
    marker: str = "o",
    unit: str = "g",
) -> Axes:
    """A fragility curve with its 90 % band, and the share overturned at each level; `ax.legend()` shows the labels.

    Args:
        ax: where to draw.
        fit: the curve, of `fit_fragility` or `fit_capacities`.
        levels: intensities that were run, in the unit of the fit, shape (n,); None draws the curve alone.
        shares: share of the runs that overturned at each, shape (n,).
        solver: name of the curve; those of `STYLES` have their own colours, any other the next one.
        marker: of the shares, as matplotlib names it.
        unit: of the accelerations, for axis and label.

    Raises:
        ValueError: for levels and shares of different lengths, or one without the other.
    """
    if (levels is None) != (shares is None):
        raise ValueError("levels and shares go together: give both, or neither")
    style = STYLES.get(solver or "", {})
    colour = style.get("color", f"C{len(ax.collections)}")  # a band for each curve before
    name = f"{folded(style.get('label', solver))}: " if solver else ""
    label = f"{name}{fit.median:.2f} {unit}, {fit.dispersion:.2f}"
    top = max(2 * fit.median, fit.tried[1] if math.isfinite(fit.tried[1]) else 0.0)
    points = found = np.empty(0)
    if levels is not None and shares is not None:
        points, found = equal_rows(levels=levels, shares=shares)
        top = float(points.max())
    x = np.linspace(0.02 * top, top, 300)
    low, high = fit.band(x)
    right = ax.get_xlim()[1] if ax.collections else 0.0
    ax.fill_between(x, low, high, color=colour, alpha=0.2, linewidth=0)
    curve = None if points.size else label
    ax.plot(x, fit.probability(x), color=colour, linestyle=style.get("linestyle", "-"), linewidth=1.8, label=curve)
    if points.size:
        ax.plot(points, found, marker=marker, linestyle="", color=colour, markersize=5, label=label)
    ax.set_xlim(0, max(1.02 * top, right))
    ax.set(ylim=(-0.02, 1.02), xlabel=f"peak ground acceleration [{unit}]", ylabel="share of walls overturned [-]")
    return ax


@picture(samples=mapping(row))
def distributions(ax: Axes, samples: Mapping[str, ArrayLike], least: float = 1e-3, most: float = 1.0) -> Axes:
    """Share of runs whose peak rotation stays below a value, a line a solver; overturned runs lie beyond `most`."""
    for solver, values in samples.items():
        style = {k: v for k, v in STYLES.get(solver, {"label": folded(solver)}).items() if k != "linestyle"}
        ordered = np.sort(np.clip(np.asarray(values, dtype=float), float(least), 10 * float(most)))
        ax.step(ordered, np.arange(1, len(ordered) + 1) / len(ordered), where="post", **style)
    ax.set(
        xscale="log", xlim=(float(least), float(most)), ylim=(0, 1), xlabel=PEAK, ylabel="share of runs below it [-]"
    )
    return ax


@picture()
def pairs(ax: Axes, values: ArrayLike, names: tuple[str, str], limits: tuple[float, float]) -> Axes:
    """Peak rotations of the same cases in two ways, on logarithmic axes; what falls lies on the upper edge.

    `values` are multiples of alpha, shape (n, 2).
    """
    low, high = limits
    if np.shape(values)[1] != 2:
        raise ValueError(f"values has the shape {np.shape(values)}; two columns are needed")
    a, b = np.clip(np.asarray(values, dtype=float), low, high).T
    ax.plot([low, high], [low, high], color="0.6", linewidth=0.8)
    ax.loglog(a, b, linestyle="", marker="o", markersize=3.5, markeredgewidth=0, alpha=0.55, color="#12406b")
    limits = 0.8 * low, 1.25 * high
    x, y = (rf"$\theta_{{max}}/\alpha$, {name} [-]" for name in names)
    ax.set(xlim=limits, ylim=limits, aspect="equal", xlabel=x, ylabel=y)
    return ax
