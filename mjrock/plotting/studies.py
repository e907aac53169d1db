"""Pictures of studies: records and spectra, intensity and fragility, pushes, and the sensitivity to settings."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import get_args

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import ArrayLike

from ..problem.ground.motion import GroundMotion
from ..problem.ground.record_sets import RecordSet
from ..problem.ground.spectrum import SpectrumOfCode, response_spectrum
from ..problem.wall.block import Block
from ..quantities import GRAVITY, Array, named, require_kind, require_row, require_text
from ..study.intensity.fragility import Fragility
from ..study.intensity.overturning_map import ENDINGS, OverturningMap
from ..study.intensity.thresholds import Thresholds
from ..study.loading.design import Design
from ..study.loading.push import Push
from ..study.loading.pushover import PushoverCurve
from ..study.sensitivity import Sensitivity, setting_text
from .picture import equal_rows, kind, listed, mapping, picture
from .style import (
    BEHIND,
    BLUE,
    ON_LINES,
    ORANGE,
    OWN,
    PALETTE,
    STYLES,
    Look,
    figure_of,
    folded,
    plain_names,
    power_of_ten,
    wrapped,
)

LETTERS_OF_AXIS = 60
"""Letters below an axis from which on its labels are turned."""
MOST_LABELS = 9
"""Most labels of values in a row on an axis; of more every second, third and so on has one."""
NEAREST = 0.12
"""Least distance of two values on an axis, over their range, that leaves room for their labels [-]."""
ROUND_PERIODS = (0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0)
"""Periods that the axis of a map may show [s]."""
PEAK = r"peak rotation $\theta_{max}/\alpha$ [-]"


def of_records(name: str, value: object) -> None:
    """At least one motion, or a set of at least one record."""
    listed(kind(GroundMotion))(name, value.horizontal if isinstance(value, RecordSet) else value)


def one_or_more(name: str, value: object) -> None:
    """A motion, at least one of them, or a set of records."""
    of_records(name, [value] if isinstance(value, GroundMotion) else value)


def finite_row(name: str, value: object) -> None:
    """A row of at least one finite number."""
    require_row(name, value, "number")


@picture(motions=one_or_more)
def record(motions: GroundMotion | Sequence[GroundMotion] | RecordSet) -> Figure:
    """Acceleration, velocity and displacement of the ground over time, with the peaks and where each motion ends.

    It is the first thing to look at of a file. Several motions are drawn over each other, so that it shows what
    `corrected` does: `record([motion, motion.corrected("linear")])`. Of a set of records it has the horizontal ones.
    """
    records = [motions] if isinstance(motions, GroundMotion) else motions
    records = records.horizontal if isinstance(records, RecordSet) else records
    figure = Figure(figsize=(6.4, 5.4 + 0.4 * len(records)), layout="constrained")
    axes = figure.subplots(3, sharex=True)
    for i, motion in enumerate(records):
        t = np.sort(np.append(motion.times, np.linspace(0.0, motion.duration, 400)))  # also where it has few samples
        histories = (motion.times, motion.accel), (t, motion.velocity(t)), (t, motion.displacement(t))
        for ax, (t, history), unit in zip(axes, histories, ("m/s²", "m/s", "m"), strict=True):
            start = f"{motion.name[:90]}: " if ax is axes[0] else f"end {history[-1]:.2g}, "
            peak = float(np.abs(history).max())
            label = f"{start}peak {peak:.3g} {unit}"
            ax.plot(t, history, color=PALETTE[i % len(PALETTE)], linewidth=0.8, label=label)
    for ax, label in zip(axes, ("acceleration [m/s²]", "velocity [m/s]", "displacement [m]"), strict=True):
        ax.axhline(0, color="0.8", linewidth=0.6, zorder=0)
        ax.set_ylabel(label)
        ax.yaxis.set_label_coords(-0.1, 0.5)
        columns = {"ncols": 1 if ax is axes[0] else 3, "columnspacing": 1.0, "handlelength": 1.0}
        ax.legend(frameon=False, fontsize=8, loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.0, **columns)
    axes[2].set(xlabel="time $t$ [s]", xlim=(0, max(motion.duration for motion in records)))
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
    spectra_found = np.array([response_spectrum(motion, T, damping).Sa for motion in motions]) / GRAVITY
    for i, line in enumerate(spectra_found):
        ax.plot(T, line, color="0.7", linewidth=0.7, label="records" if i == 0 else None)
    ax.plot(T, spectra_found.mean(axis=0), color=BLUE, linewidth=2.0, label=f"mean of {len(spectra_found)}")
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
    values_shown = np.minimum(values, top)
    mark = "" if levels.size > 1 else "o"  # a line of one point is none
    ax.plot(levels, values_shown.T, color="0.75", linewidth=0.6, marker=mark)
    fractiles = np.minimum(np.percentile(values, [16, 50, 84], axis=0, method="nearest"), top)
    for line, style, label in zip(fractiles, (":", "-", "--"), ("16 %", "median", "84 %"), strict=True):
        ax.plot(levels, line, color=BLUE, linewidth=1.8, linestyle=style, marker=mark, label=label)
    ax.axhline(1, color="0.3", linewidth=0.6)
    ax.axhline(top, color="0.3", linewidth=0.6, linestyle=":")
    ax.text(0.01 * levels.max(), top, "overturned", fontsize=8, va="top", color="0.3", bbox=BEHIND)
    ax.set(xlim=(0, levels.max()), ylim=(0, 1.03 * top))
    ax.legend(**ON_LINES, loc="center left")
    ax.set_title(STYLES.get(solver, {}).get("label", solver), fontsize=10)
    ax.set(xlabel="peak ground acceleration [g]", ylabel=PEAK)
    return ax


SCAN_COLOURS = {"stands": "white", "falls": ORANGE, "by chance": "0.6"}
"""What a run at a scale does, and the colour of its mark. By chance: nudged motions end otherwise."""


@picture(found=kind(Thresholds), unit=require_text)
def thresholds(ax: Axes, found: Thresholds, unit: str = "") -> Axes:
    """The ranges of scales in which each record makes a wall or masonry fall, a row a record.

    A bar is a range. A thin bar goes over the edges that nudged motions have. Dots are the scales of the scan.

    Args:
        ax: where to draw.
        found: the thresholds.
        unit: of the scales, for the axis.
    """
    last = float(found.scales[-1])
    for row, (ranges, shares) in enumerate(zip(found.islands, found.shares, strict=True)):
        for scale_range in ranges:
            end = last if math.isnan(scale_range.stands_above) else scale_range.falls_to
            upper = end if math.isnan(scale_range.stands_above) else scale_range.upper[1]
            ax.barh(row, end - scale_range.falls_from, 0.5, left=scale_range.falls_from, color=ORANGE, alpha=0.45)
            ax.barh(row, upper - scale_range.lower[0], 0.12, left=scale_range.lower[0], color=ORANGE)
        kinds = np.where(shares == 0, "stands", np.where(shares == 1, "falls", "by chance"))
        for name, colour in SCAN_COLOURS.items():
            scales = found.scales[kinds == name]
            look: Look = {"markersize": 4, "color": "0.3", "markerfacecolor": colour, "markeredgewidth": 0.6}
            ax.plot(scales, np.full(len(scales), row), "o", label=None if row else name, zorder=5, **look)
    ax.set_yticks(range(len(found.records)), [folded(name) for name in found.records])
    ax.set(ylim=(len(found.records) - 0.4, -0.6), xlabel=f"scale{f' [{unit}]' if unit else ''}")
    columns = {"ncols": 3, "columnspacing": 1.0, "handletextpad": 0.2, "borderaxespad": 0.2}
    ax.legend(frameon=False, fontsize=8, loc="lower left", bbox_to_anchor=(0, 1), **columns)
    return ax


AGAIN, CHANCE = "stands above a fall", "by chance"
ENDING_COLOURS = {
    **dict(zip(ENDINGS, ("#f3f1ea", ORANGE, BLUE, ORANGE), strict=True)), AGAIN: "#a9c9a4", CHANCE: "0.45",
}  # fmt: skip
"""What a wall does under a pulse, and colours that a black-and-white print still tells apart. By chance: nudged pulses,
or those of other builds, end otherwise."""


@picture(found=kind(OverturningMap), wall=kind(Block, type(None)))
def overturning_map(ax: Axes, found: OverturningMap, wall: Block | None = None) -> Axes:
    """What a wall or masonry does under pulses of every amplitude and period, a cell a pulse.

    Cells that stand above an amplitude that overturns have a colour of their own.

    Args:
        ax: where to draw.
        found: the map.
        wall: draws amplitudes over g tan(alpha) of this wall, and frequencies 2 pi / period over its p, with the units
            on the opposite axes; None draws them in m/s2 and s.
    """
    colours, names = list(ENDING_COLOURS.values()), list(ENDING_COLOURS)
    kinds = np.where(found.islands, names.index(AGAIN), found.endings)
    kinds = np.where((found.shares > 0) & (found.shares < 1), names.index(CHANCE), kinds)
    x, y = found.periods, found.amplitudes
    if wall is not None:
        p, lifts = wall.p, GRAVITY * math.tan(wall.alpha)
        x, y, kinds = 2 * math.pi / (p * x[::-1]), y / lifts, kinds[::-1]
    look: Look = {"cmap": ListedColormap(colours), "vmin": -0.5, "vmax": len(colours) - 0.5, "rasterized": True}
    ax.pcolormesh(_cell_edges(x), _cell_edges(y), kinds.T, **look)
    ax.set(xlabel="period of the pulse [s]", ylabel="amplitude of the pulse [m/s²]")
    if wall is not None:
        ax.set(xlabel=r"frequency $\omega_p/p$ [-]", ylabel=r"amplitude $a_p/(g\,\tan\alpha)$ [-]")
        periods = _round_periods(x * p)
        above = ax.secondary_xaxis("top")
        above.set_xticks([2 * math.pi / (p * period) for period in periods], [f"{period:g}" for period in periods])
        above.set_xlabel("period [s]")
        scale = (lambda share: np.multiply(share, lifts)), (lambda amplitude: np.divide(amplitude, lifts))
        ax.secondary_yaxis("right", functions=scale).set_ylabel("amplitude [m/s²]")
    handles = [Patch(facecolor=colours[i], edgecolor="0.4", linewidth=0.5, label=names[i]) for i in np.unique(kinds)]
    ax.legend(handles=handles, frameon=False, fontsize=8, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.16))
    return ax


def _round_periods(omega: Array) -> list[float]:
    """Round periods with room for their labels on an axis of circular frequencies [s]."""
    periods: list[float] = []
    for period in ROUND_PERIODS:
        omega_there = 2 * math.pi / period
        distance = abs(2 * math.pi / periods[-1] - omega_there) if periods else math.inf
        if omega[0] <= omega_there <= omega[-1] and distance >= 0.5 * NEAREST * (omega[-1] - omega[0]):
            periods.append(period)
    return periods


def _cell_edges(centres: Array) -> Array:
    """Where cells around increasing values meet, the outer ones as wide on both sides down to 0, shape (n + 1,)."""
    if len(centres) == 1:
        return np.array([0.95, 1.05]) * (centres[0] or 1.0)
    middles = 0.5 * (centres[1:] + centres[:-1])
    return np.concatenate(([max(2 * centres[0] - middles[0], 0.0)], middles, [2 * centres[-1] - middles[-1]]))


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
    points = shares_found = np.empty(0)
    if levels is not None and shares is not None:
        points, shares_found = equal_rows(levels=levels, shares=shares)
        top = float(points.max())
    x = np.linspace(0.02 * top, top, 300)
    low, high = fit.band(x)
    right = ax.get_xlim()[1] if ax.collections else 0.0
    ax.fill_between(x, low, high, color=colour, alpha=0.2, linewidth=0)
    curve = None if points.size else label
    ax.plot(x, fit.probability(x), color=colour, linestyle=style.get("linestyle", "-"), linewidth=1.8, label=curve)
    if points.size:
        ax.plot(points, shares_found, marker=marker, linestyle="", color=colour, markersize=5, label=label)
    ax.set_xlim(0, max(1.02 * top, right))
    ax.set(ylim=(-0.02, 1.02), xlabel=f"peak ground acceleration [{unit}]", ylabel="share of walls overturned [-]")
    return ax


Closed = Mapping[str, tuple[ArrayLike, ArrayLike]]
"""Rotations [rad] and the values of a closed form at them, by the name of its curve."""


@picture(curves=mapping(kind(PushoverCurve)))
def pushover(ax: Axes, curves: Mapping[str, PushoverCurve], closed: Closed | None = None) -> Axes:
    """Multiplier against rotation, a line a curve, with closed forms as points, and where ties yield and break."""
    _drawn(ax, {name: (curve.rotation, curve.multiplier) for name, curve in curves.items()}, closed or {})
    _mark_ties(ax, curves)
    ax.set_ylabel(r"multiplier $\lambda$ [-]")
    return ax


@picture(curves=mapping(kind(PushoverCurve)))
def moment_rotation(ax: Axes, curves: Mapping[str, PushoverCurve], closed: Closed | None = None) -> Axes:
    """Restoring moment against rotation, as in Figure 1(c) of the paper; closed forms [N m] as points.

    The moment of a rigid wall rises at no rotation.
    """
    lines = {}
    for name, curve in curves.items():
        rotation, moment = curve.rotation, curve.moment / 1e3
        if curve.contacts is None:
            rotation, moment = np.append(0.0, rotation), np.append(0.0, moment)
        lines[name] = rotation, moment
    points = {name: (at, np.asarray(values, dtype=float) / 1e3) for name, (at, values) in (closed or {}).items()}
    _drawn(ax, lines, points)
    ax.set_ylabel("restoring moment $M$ [kN m]")
    return ax


@picture(curves=mapping(kind(Push)))
def push(ax: Axes, curves: Mapping[str, Push], closed: Closed | None = None) -> Axes:
    """Force against displacement of slow pushes, a line a push, to and fro too; closed forms [m, N] as points."""
    factor = 1e-3 if all(curve.unit == "N" for curve in curves.values()) else 1.0
    lines = {name: (1e3 * curve.displacement, factor * curve.force) for name, curve in curves.items()}
    points = {
        name: (1e3 * np.asarray(at, dtype=float), factor * np.asarray(values, dtype=float))
        for name, (at, values) in (closed or {}).items()
    }
    _drawn(ax, lines, points)
    ax.set(xlim=(None, None), ylim=(None, None), xlabel="displacement [mm]")
    ax.set_ylabel("force [kN]" if factor < 1 else r"multiplier $\lambda$ [-]")
    return ax


def _mark_ties(ax: Axes, curves: Mapping[str, PushoverCurve]) -> None:
    """A triangle where ties of a curve yield and a cross where they break, which the legend names once."""
    labels = dict[str, Look]()
    for line, curve in zip(list(ax.get_lines()), curves.values(), strict=False):
        plain = plain_names(curve.ties[0] | curve.ties[1])
        for (event, marker), reached in zip((("yield", "v"), ("break", "x")), curve.ties, strict=True):
            if not reached:
                continue
            names = sorted(reached, key=reached.__getitem__)
            near = np.searchsorted(curve.rotation, [reached[name] for name in names])
            heights = [float(curve.multiplier[max(i - 2, 0) : i + 1].max()) for i in near.tolist()]  # before it falls
            text = folded(f"{named([plain[name] for name in names])} {event}{'' if len(names) > 1 else 's'}")
            look: Look = {"marker": marker, "markersize": 6, "zorder": 5, "linestyle": ""}
            ax.plot([reached[name] for name in names], heights, **look, color=line.get_color())
            labels[text] = look | {"color": "0.3" if text in labels else line.get_color()}
    for text, look in labels.items():
        ax.plot([], [], **look, label=text)
    _add_legend(ax)


def _add_legend(ax: Axes) -> None:
    """A legend of what has a name."""
    if ax.get_legend_handles_labels()[1]:
        ax.legend(**ON_LINES)


def _drawn(ax: Axes, lines: Mapping[str, tuple[ArrayLike, ArrayLike]], points: Closed) -> None:
    for (name, (x, y)), style in zip(lines.items(), cycle(OWN), strict=False):
        ax.plot(x, y, label=folded(name), **style)
    for i, (name, at) in enumerate(points.items()):
        x, y = equal_rows(rotation=at[0], values=at[1])
        colour = OWN[list(lines).index(name) % len(OWN)]["color"] if name in lines else "0.4"
        label = "closed forms" if i == 0 else None
        ax.plot(x, y, "o", color=colour, markerfacecolor="white", markersize=4, linestyle="", zorder=4, label=label)
    _add_legend(ax)
    ax.set(xlim=(0, None), ylim=(0, None), xlabel=r"rotation $\theta$ [rad]")


SETTINGS = dict.fromkeys(("k_n", "k_s", "k_base", "k_side"), "N/m³") | {"thickness": "m", "height": "m", "length": "m"}
SETTINGS |= {"density": "kg/m³", "thrust": "N", "strength": "N"}
"""Units of settings that have the names of arguments."""


@picture(labels=mapping(require_text, least=0))
def tornado(ax: Axes, found: Sensitivity, labels: Mapping[str, str] | None = None) -> Axes:
    """A bar for each setting, from the lowest to the highest value where it alone changes, the widest on top.

    The bar "together" is the range of all runs. The vertical line is the base. A bar that reaches the dashed line has a
    run in which the wall overturned. Below the name of a setting stand the values that were tried.

    Args:
        ax: where to draw.
        found: the study.
        labels: what settings and the measure are called, such as {"k_n": "stiffness $k_n$"}; others have their names.
    """
    require_kind("found", found, Sensitivity)
    called = {name: name for name in (*found.swings, found.measure)} | dict(labels or {})
    bars = dict(found.swings)
    if any(len(names) > 1 for names in found.changed):
        bars["together"] = found.range
    finite = found.values[np.isfinite(found.values)]
    lowest, highest = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    width = highest - lowest or 0.1 * (abs(highest) or 1.0)
    edge = highest + 0.12 * width  # where an overturned wall is drawn
    for i, (name, ends) in enumerate(bars.items()):
        low, high = (edge if end == math.inf else end for end in ends)
        colour = "0.75" if name == "together" else ORANGE if name == found.governs else BLUE
        ax.barh(i, high - low, left=low, color=colour, height=0.55)
        for end, x, side, shift in zip(ends, (low, high), ("right", "left"), (-4, 4), strict=True):
            text = found.written(end) if low == high else _distinct_texts(found, *ends)[end == ends[1]]
            look: Look = {"ha": side, "va": "center", "fontsize": 8, "bbox": BEHIND}
            ax.annotate(text, (x, i), (shift, 0), textcoords="offset points", **look)
    if math.isfinite(found.base_value):
        ax.axvline(found.base_value, color="0.15", linewidth=1.0)
    if not np.isfinite(found.values).all():
        ax.axvline(edge, color="0.15", linewidth=1.0, linestyle="--")
    ax.set_yticks(range(len(bars)), [f"{called.get(name, name)}\n{_trials(found, name)}".strip() for name in bars])
    ax.invert_yaxis()
    right = 0.12 if np.isfinite(found.values).all() else 0.4  # room for the word at the end of a bar
    ax.set_xlim(lowest - 0.2 * width, edge + right * width)
    ax.set_xlabel(f"{called[found.measure]}{f' [{found.unit}]' if found.unit else ''}")
    governs = found.governs or ""
    sentence = found.sentence.replace(f"governed by {governs}", f"governed by {called.get(governs)}")
    ax.set_title(wrapped(sentence, 0.6 * figure_of(ax).get_figwidth(), 10), fontsize=10)  # names take the rest
    return ax


@picture()
def design(ax: Axes, found: Design) -> Axes:
    """Capacity over demand of every condition for each value that was tried, with the value that the sentence names.

    Conditions hold on the line of 1 and above it. A value that cannot be built has no points.

    Args:
        ax: where to draw.
        found: what `mjrock.design` returns.
    """
    require_kind("found", found, Design)
    values = [trial.value for trial in found.trials]
    every = -(-len(values) // MOST_LABELS)
    numbers = all(isinstance(value, int | float) for value in values) and _apart_enough(values[::every])
    places = values if numbers else list(range(len(values)))
    lines = dict[str, list[tuple[float, float]]]()
    for place, trial in zip(places, found.trials, strict=True):
        for condition in trial.conditions:
            lines.setdefault(condition.label, []).append((place, condition.verdict.ratio))
    for number, (name, points) in enumerate(lines.items()):
        marker = "osD^vP*X"[number % 8]
        ax.plot(*np.transpose(points), marker=marker, markersize=5, linewidth=1.3, label=name)
    ax.axhline(1.0, color="0.15", linewidth=1.0, linestyle="--")
    if found.marked is not None:
        at = places[found.trials.index(found.marked)]
        ax.axvline(at, color=BLUE, alpha=0.18, linewidth=12, zorder=0)
    every = every if numbers else 1
    labels = [trial.label for trial in found.trials][::every]
    ax.set_xticks(places[::every], labels)
    if max(map(len, labels)) * len(labels) > LETTERS_OF_AXIS:
        ax.tick_params(axis="x", labelrotation=45)
        for label in ax.get_xticklabels():
            label.set(ha="right", rotation_mode="anchor")
    finite = [ratio for points in lines.values() for _, ratio in points if math.isfinite(ratio)]
    ax.set_ylim(0.0, 1.1 * max([1.0, *finite]))
    ax.set_ylabel("capacity over demand [-]")
    ax.set_title(wrapped(found.sentence, figure_of(ax).get_figwidth() - 0.6, 10), fontsize=10)
    ax.legend(fontsize=8)
    return ax


def _apart_enough(values: Sequence[float]) -> bool:
    """Whether numbers have room for their labels where they are on an axis."""
    row = np.sort(np.array(values, dtype=float))
    return len(row) == 1 or bool(np.diff(row).min() > NEAREST * np.ptp(row) > 0)


def _trials(study: Sensitivity, setting: str) -> str:
    """The values of a setting that were tried, with the unit of the settings that have a known one."""
    values = list(dict.fromkeys(row[setting] for row in study.rows)) if setting in study.settings else []
    if len(values) < 2 or not all(isinstance(value, int | float) for value in values):
        return ", ".join(setting_text(value) for value in values)
    return f"{power_of_ten(min(values))} to {power_of_ten(max(values))} {SETTINGS.get(setting, '')}".strip()


def _distinct_texts(study: Sensitivity, low: float, high: float) -> tuple[str, str]:
    """Two ends of a bar as text, with as many digits as it takes to distinguish them."""
    texts = study.written(low), study.written(high)
    digits = 3
    while texts[0] == texts[1] and digits < 9:
        texts, digits = (f"{low:.{digits}g}", f"{high:.{digits}g}"), digits + 1
    return texts
