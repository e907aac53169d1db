"""Pictures of earthquake studies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import get_args

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from ..problem.ground.motion import GroundMotion
from ..problem.ground.record_sets import RecordSet
from ..problem.ground.spectrum import SpectrumOfCode, response_spectrum
from ..quantities import GRAVITY, require_kind
from ..study.intensity.fragility import Fragility
from .arguments import equal_rows, finite_row, kind, listed, picture
from .figures import BLUE, ORANGE, PALETTE
from .style import STYLES, folded

PEAK = r"peak rotation $\theta_{max}/\alpha$ [-]"


def of_records(name: str, value: object) -> None:
    """At least one motion, or a set of at least one record."""
    listed(kind(GroundMotion))(name, value.horizontal if isinstance(value, RecordSet) else value)


def one_or_more(name: str, value: object) -> None:
    """A motion, at least one of them, or a set of records."""
    of_records(name, [value] if isinstance(value, GroundMotion) else value)


@picture(motions=one_or_more)
def record(motions: GroundMotion | Sequence[GroundMotion] | RecordSet) -> Figure:
    """Acceleration, velocity and displacement of the ground over time, with the peaks and where each motion ends.

    It is the first thing to look at of a file. Several motions are drawn over each other, so that it shows what
    `corrected` does: `record([motion, motion.corrected("linear")])`. Of a set of records it has the horizontal ones.
    """
    given = [motions] if isinstance(motions, GroundMotion) else motions
    given = given.horizontal if isinstance(given, RecordSet) else given
    figure = Figure(figsize=(6.4, 5.4 + 0.4 * len(given)), layout="constrained")
    axes = figure.subplots(3, sharex=True)
    for i, motion in enumerate(given):
        t = motion.dt * np.arange(len(motion.accel))
        histories = (motion.accel, motion.velocities, motion.displacements)
        for ax, history, unit in zip(axes, histories, ("m/s²", "m/s", "m"), strict=True):
            said = f"{motion.name[:90]}: " if ax is axes[0] else f"ends at {history[-1]:.2g}, "
            peak = float(np.abs(history).max())
            label = f"{said}peak {peak:.3g}{f' {unit}' if ax is axes[0] else ''}"
            ax.plot(t, history, color=PALETTE[i % len(PALETTE)], linewidth=0.8, label=label)
    for ax, label in zip(axes, ("acceleration [m/s²]", "velocity [m/s]", "displacement [m]"), strict=True):
        ax.axhline(0, color="0.8", linewidth=0.6, zorder=0)
        ax.set_ylabel(label)
        ax.yaxis.set_label_coords(-0.1, 0.5)
        columns = {"ncols": 1 if ax is axes[0] else 3, "columnspacing": 1.0, "handlelength": 1.0}
        ax.legend(frameon=False, fontsize=8, loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.0, **columns)
    axes[2].set(xlabel="time $t$ [s]", xlim=(0, max(motion.duration for motion in given)))
    return figure


@picture(motions=of_records, periods=finite_row, target=kind(*get_args(SpectrumOfCode)))
def spectra(
    ax: Axes,
    motions: Sequence[GroundMotion] | RecordSet,
    periods: ArrayLike,
    target: SpectrumOfCode | None = None,
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
    ax.plot(T, found.mean(axis=0), color=BLUE, linewidth=2.0, label=f"mean of {len(found)}")
    if target is not None:
        ax.plot(T, target(T, damping) / GRAVITY, color=ORANGE, linewidth=2.0, linestyle="--", label="target")
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
        ax.plot(levels, line, color=BLUE, linewidth=1.8, linestyle=style, marker=mark, label=label)
    ax.axhline(1, color="0.3", linewidth=0.6)
    ax.axhline(top, color="0.3", linewidth=0.6, linestyle=":")
    ax.text(0.01 * levels.max(), top, "overturned", fontsize=8, va="top", color="0.3")
    ax.set(xlim=(0, levels.max()), ylim=(0, 1.03 * top))
    ax.legend(frameon=False, fontsize=8, loc="center left")
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
        TypeError: unless the solver is a text.
        ValueError: for levels and shares of different lengths, or one without the other.
    """
    require_kind("solver", solver, str, type(None))
    if (levels is None) != (shares is None):
        raise ValueError("levels and shares go together: give both, or neither")
    style = STYLES.get(solver or "", {})
    colour = style.get("color", PALETTE[len(ax.collections) % len(PALETTE)])  # a band each
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
