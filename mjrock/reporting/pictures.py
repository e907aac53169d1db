"""The pictures of a report: the wall with its hinge and effects, capacity curves, and the runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from textwrap import fill
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.transforms import Bbox

from ..plotting.bodies import Bodies
from ..plotting.masonry import mechanism
from ..plotting.studies import design
from ..plotting.style import OWN, Look, figure_of, figure_of_panels, legend_below, width_of
from ..plotting.wall import elevation, section
from ..problem.masonry.limit.collapse import Collapse
from ..problem.wall.case import Case
from ..problem.wall.effects import constant_forces_of
from ..quantities import Array
from ..result.bodies import BodyMotion
from ..result.response import Response
from ..study.loading.design import Design
from ..study.loading.limit_analysis import LimitCurve
from ..study.loading.load_check import StaticAnswer
from ..study.loading.mechanism_check import MechanismCheck
from ..study.loading.pushover import PushoverCurve
from .texts import DASH, Words, effect_name
from .verdicts import REVERSED, Mechanism, condition_text, effect_label

PICTURE_WIDTH = 7.0
"""Width of a picture [inch]."""
LEAST_TYPE = 8.0
"""Size of the least type [pt]."""
TALLEST_WALL = 2.5
"""Most height of the drawing of a wall [inch]."""
ROOM_BELOW, ROOM_ABOVE, ROOM_BEFORE, NAME_DISTANCE, LEAST_HEIGHT = 0.36, 0.36, 0.45, 0.36, 1.05
"""Room below, above and before a drawing, from a wall to names outside, and least height of a wall in it [inch]."""
LINE_HEIGHT = 10.0
"""Height of a line of text [pt]."""
STRIP_ROWS = 12
"""Most rows of a picture of largest displacements."""
PANELS_OF_PICTURE = 6
"""Most records whose motion is drawn in one picture."""
MOST_PANELS = 12
"""Most records whose motion is drawn."""
FARTHEST_LIMIT = 2.0
"""A limit that is farther than the motion by this factor would flatten it."""
MOST_LINE_STYLES = 5
"""Most runs of one record whose lines differ."""
NAME_PLACES = (
    ((4, 4), "left"), ((-4, -11), "right"), ((-4, 4), "right"), ((4, -11), "left"), ((7, -4), "left"),
    ((0, 14), "center"), ((0, 22), "center"),
)  # fmt: skip
"""Where a name may stand beside its point [pt], and how it is aligned."""
HALF_DOT = 5.0
"""Half of the room that a point takes in a diagram [pixels]."""
DRAWN_ROTATION = 0.06
"""Rotation at which the mechanism is drawn [rad]."""
HOLDS, FAILS, TIE = "#0b7a4b", "#b3261e", "0.2"
"""Colours of what holds and of what fails, which differ in lightness too, and of where ties yield and break."""


LABEL: Look = {"textcoords": "offset points", "fontsize": LEAST_TYPE, "zorder": 9}
"""How the labels of a drawing are written."""
LABEL_BOX: Look = {"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 0.5}
"""What lies under them."""


class Run(NamedTuple):
    """A response as a report names it.

    Args:
        response: the response.
        variant: what it is a run of, or empty.
        label: what it is called.
        record: number of its record.
        motion: name of the record, as it was recorded.
        largest: its largest displacement [m], infinite where it overturned or a block fell.
    """

    response: Response
    variant: str
    label: str
    record: int
    motion: str
    largest: float

    @property
    def is_reversed(self) -> bool:
        """Whether the record is reversed."""
        motion = self.response.case.motion
        return motion is not None and motion.name.endswith(REVERSED)

    @property
    def line(self) -> str:
        """The name of its line among the runs of its record."""
        return self.variant or self.label


def by_variant(runs: Sequence[Run]) -> dict[str, list[Run]]:
    """The runs of each variant, in their order."""
    return {name: [run for run in runs if run.variant == name] for name in dict.fromkeys(run.variant for run in runs)}


class WallDrawing(NamedTuple):
    """Section and elevation of a wall.

    Args:
        figure: with both.
        one_scale: whether both have one scale.
    """

    figure: Figure
    one_scale: bool


def wall_drawing(case: Case, words: Words) -> WallDrawing:
    """Section and elevation with sizes, the hinge, the mechanism that opens about it, and the names of the effects."""
    figure = Figure(figsize=(PICTURE_WIDTH, TALLEST_WALL))
    left, right = figure.add_axes((0.0, 0.0, 0.5, 1.0)), figure.add_axes((0.5, 0.0, 0.5, 1.0))
    section(left, case, words("stop"))
    loaded = any(force[0] == 0 for _, force in constant_forces_of(case.effects).values())
    top = left.get_ylim()[1] if loaded else 1.04 * 2 * case.block.h
    elevation(right, case, (0.0, top))
    opened = Bodies.of_moving(BodyMotion(case, np.zeros(1), case.wall.pose(np.array([DRAWN_ROTATION]))[None]))
    left.fill(*opened.corners(0)[0].T, facecolor="none", edgecolor=FAILS, linestyle="--", linewidth=0.9, zorder=3)
    names = _names(case, words)
    widths = [width_of(figure, words("hinge"), LEAST_TYPE), *(name.width for name in names if not name.inside)]
    scales = _place_side_by_side(left, right, top, max(1.05, NAME_DISTANCE + max(widths)))
    left.annotate(words("hinge"), (case.block.half_base, 0.0), (8, 3), color=FAILS, **LABEL).set_bbox(LABEL_BOX)
    _write_names(left, case, scales.section, names)
    for ax, title in ((left, "section"), (right, "elevation")):
        ax.axis("off")
        ax.set_title("")  # that of the drawing, in English and in the middle
        ax.set_title(words(title), fontsize=LEAST_TYPE, loc="left")
        for text in ax.texts:
            text.set_fontsize(max(LEAST_TYPE, text.get_fontsize()))
    return WallDrawing(figure, scales.section == scales.elevation)


class Scales(NamedTuple):
    """The scales of section and elevation [inch/m]."""

    section: float
    elevation: float


def _place_side_by_side(left: Axes, right: Axes, top: float, between: float) -> Scales:
    """Place section and elevation side by side up to a height [m].

    Between them is room for names [inch]. They have one scale, unless the elevation is so long that the section would
    be too small to read.
    """
    figure, room = figure_of(left), ROOM_BEFORE + between
    widths = [float(np.ptp(ax.get_xlim())) for ax in (left, right)]
    tallest = (TALLEST_WALL - ROOM_BELOW - ROOM_ABOVE) / top
    common = min(tallest, (PICTURE_WIDTH - room) / sum(widths))
    one_scale = common * top >= LEAST_HEIGHT
    left_over = PICTURE_WIDTH - room - tallest * widths[0]
    scales = Scales(common, common) if one_scale else Scales(tallest, left_over / widths[1])
    height = scales.section * top + ROOM_BELOW + ROOM_ABOVE
    figure.set_size_inches(PICTURE_WIDTH, height)
    starts = [ROOM_BEFORE, PICTURE_WIDTH - scales.elevation * widths[1]]
    if one_scale:  # in the middle of what is left
        starts[1] = 0.5 * (starts[1] + room + common * widths[0])
    for ax, start, scale, width in zip((left, right), starts, scales, widths, strict=True):
        below = ROOM_BELOW / scale
        ax.set_ylim(-below, top)
        ax.set_position((start / PICTURE_WIDTH, 0.0, scale * width / PICTURE_WIDTH, scale * (top + below) / height))
    return scales


class Name(NamedTuple):
    """The name of an effect in a drawing.

    Args:
        text: in words.
        place: height and inner face of the wall there, or of the outline of wedges their left end [m].
        inside: whether it stands before the inner face.
        width: of the text [inch].
    """

    text: str
    place: tuple[float, float]
    inside: bool
    width: float


def _names(case: Case, words: Words) -> list[Name]:
    """The names of the effects with their heights."""
    figure, names = Figure(), []
    for name, effect in case.named.items():
        if effect.report_item is None:
            continue
        text, z = words.marked(f"{effect_label(name, effect, words)}, {effect.height:.4g} m"), effect.height
        inside = effect.on_face or len(effect.outline) > 0
        if len(effect.outline):  # below the crack of wedges there is room
            z, text = 0.15 * z, fill(text, 12)
        names.append(Name(text, (case.block.inner_face(z), z), inside, width_of(figure, text, LEAST_TYPE)))
    return names


def _write_names(ax: Axes, case: Case, scale: float, names: Sequence[Name]) -> None:
    """Write the names of the effects, each on a line of its own; `scale` is that of the section [inch/m]."""
    lines: dict[bool, list[float]] = {True: [], False: []}
    for text, (face, z), inside, _ in names:
        level = 72 * scale * z + (3 if inside else -10)
        while any(abs(level - taken) < LINE_HEIGHT for taken in lines[inside]):
            level -= LINE_HEIGHT
        lines[inside].append(level)
        x, offset = (face, -3) if inside else (case.block.b, 72 * NAME_DISTANCE)
        note = ax.annotate(text, (x, z), (offset, level - 72 * scale * z), ha="right" if inside else "left", **LABEL)
        note.set_bbox(LABEL_BOX)


def capacity_curves(mechanisms: Sequence[Mechanism], words: Words) -> Figure | None:
    """The curve of each kinematic check with its capacities and the demands; None without one."""
    checks = [(mechanism.name, mechanism.kinematic) for mechanism in mechanisms if mechanism.kinematic]
    if not checks:
        return None
    columns = min(3 if len(checks) % 2 else 2, len(checks))
    figure, axes = figure_of_panels(len(checks), columns, (PICTURE_WIDTH / columns, 2.25))
    named_points = []
    for ax, (name, check) in zip(axes.flat, checks, strict=False):
        ax.locator_params(nbins=5 if columns > 2 else "auto")
        named_points.append(_curve(ax, check, words))
        ax.set_title(name, fontsize=9)
    marks: list[tuple[Look, str]] = [
        ({"color": "#12406b"}, words("capacity_curve")),
        ({"marker": "o", "linestyle": "", "color": "0.2"}, words("verdict_capacity")),
        ({"marker": "D", "linestyle": "", "color": HOLDS}, words("demand_holds")),
        ({"marker": "D", "linestyle": "", "color": FAILS}, words("demand_fails")),
    ]
    handles = [Line2D([], [], **look) for look, _ in marks]
    legend_below(figure, handles, [label for _, label in marks], 4, fontsize=LEAST_TYPE)
    layout = figure.get_layout_engine()
    assert layout is not None
    layout.execute(figure)
    for ax, points in zip(axes.flat, named_points, strict=False):
        _write_beside(ax, points)
    return figure


class Point(NamedTuple):
    """A point of a diagram with its name, displacement [m] and acceleration [m/s2]."""

    name: str
    d: float
    a: float


def _curve(ax: Axes, check: MechanismCheck, words: Words) -> list[Point]:
    """A capacity curve, the period of each limit state, its capacity on the curve, and the demand at its period.

    Returns the points that are to be named.
    """
    ax.plot(check.d, check.a, color="#12406b", linewidth=1.8)
    demands = [(2 * math.pi / state.period) ** 2 * state.demand for state in check.states.values()]
    top = 1.15 * max(float(check.a.max()), *demands)
    points: list[Point] = []
    for name, state in check.states.items():
        a_at_capacity = float(np.interp(state.capacity, check.d, check.a))
        omega_squared = (2 * math.pi / state.period) ** 2
        end = max(state.demand, state.capacity)
        ax.plot([0.0, end], [0.0, min(omega_squared * end, top)], color="0.6", linewidth=0.7, linestyle=":")
        colour = HOLDS if state.ratio >= 1 else FAILS
        ax.plot(state.capacity, a_at_capacity, "o", color="0.2", markersize=5, zorder=5)
        ax.plot(state.demand, omega_squared * state.demand, "D", color=colour, markersize=5, zorder=6)
        points += [Point(name, state.capacity, a_at_capacity), Point(name, state.demand, omega_squared * state.demand)]
    largest_d = max(check.d_0, *(1.1 * state.demand for state in check.states.values()))
    ax.set(xlim=(0, 1.1 * largest_d), ylim=(0, top), xlabel=words("axis_d"), ylabel=words("axis_a"))
    small(ax)
    return [*points, Point("d₀", check.d_0, 0.0)]


def _write_beside(ax: Axes, points: Sequence[Point]) -> None:
    """Write names beside points of a diagram whose place is known, each where it lies on no other name and on no point
    if there is such a place."""
    dots = ax.transData.transform([(d, a) for _, d, a in points])
    boxes = [Bbox.from_extents(*(dot - HALF_DOT), *(dot + HALF_DOT)) for dot in dots]
    for i, (name, d, a) in enumerate(points):
        trials = []
        for offset, align in NAME_PLACES:
            note = ax.annotate(name, (d, a), offset, ha=align, **LABEL)
            box = note.get_window_extent()
            overlaps = sum(box.overlaps(other) for other in [*boxes[:i], *boxes[i + 1 :]])
            inside = ax.bbox.contains(box.x1, box.y1) and ax.bbox.contains(box.x0, box.y0)
            trials.append((overlaps + 2 * (not inside), offset, align, box))
            note.remove()
        _, offset, align, box = min(trials, key=lambda trial: trial[0])
        ax.annotate(name, (d, a), offset, ha=align, **LABEL)
        boxes.append(box)


def static_answer_figure(result: StaticAnswer, words: Words) -> Figure | None:
    """The mechanism of limit analysis, or what is borne over the displacement; None where nothing gives way."""
    if isinstance(result, Collapse) and not (result.moving and result.masonry):
        return None
    figure = Figure(figsize=(PICTURE_WIDTH, 2.6), layout="constrained")
    if isinstance(result, Collapse):
        in_space = result.masonry is not None and result.masonry.in_space
        small(mechanism(figure.add_subplot(projection="3d" if in_space else None), result))
        return figure
    ax = figure.subplots()
    if isinstance(result, PushoverCurve):
        x, y, labels = result.rotation, result.multiplier, ("axis_rotation", "axis_multiplier")
    elif isinstance(result, LimitCurve):
        x, y, labels = 1e3 * result.displacement, result.multiplier, ("axis_moved", "axis_multiplier")
    else:
        is_force = result.unit == "N"
        y = (1e-3 if is_force else 1.0) * result.force
        x, labels = 1e3 * result.displacement, ("axis_moved", "axis_force" if is_force else "axis_multiplier")
    ax.plot(x, y, color="#12406b", linewidth=1.8)
    if isinstance(result, PushoverCurve | LimitCurve):
        scale = 1e3 if isinstance(result, LimitCurve) else 1.0
        for events, key, marker in zip(result.ties, ("tie_yields", "tie_breaks"), "sX", strict=True):
            for tie, place in events.items():
                multiplier_there = float(np.interp(scale * place, x, y))
                ax.plot(scale * place, multiplier_there, marker, color=TIE, markersize=6, zorder=5)
                text = words(key, name=effect_name(tie, words))
                ax.annotate(text, (scale * place, multiplier_there), (6, 4), **LABEL)
    ax.set(xlabel=words(labels[0]), ylabel=words(labels[1]), ylim=(min(0.0, float(y.min())), 1.15 * float(y.max())))
    small(ax)
    return figure


def design_figure(result: Design, words: Words) -> Figure:
    """Capacity over demand of every condition for each value that was tried."""
    figure = Figure(figsize=(PICTURE_WIDTH, 3.0), layout="constrained")
    ax = design(figure.subplots(), result)
    conditions = [condition for trial in result.trials for condition in trial.conditions]
    texts = {condition.label: condition_text(condition, words) for condition in conditions}
    for line in ax.get_lines():
        line.set_label(texts.get(str(line.get_label()), line.get_label()))
    ax.set_xticks(ax.get_xticks(), [words.marked(label.get_text()) for label in ax.get_xticklabels()])
    ax.set_title("")
    ax.legend(fontsize=LEAST_TYPE)
    small(ax)
    return figure


def strips(runs: Sequence[Run], limits: Sequence[tuple[str, float]], beyond: str, words: Words) -> list[Figure]:
    """The largest displacement of each run: a row a record, a colour a variant, hollow where the record is reversed;
    many in several pictures of one scale, none taller than half a page.

    Runs without variants have a row each.

    Args:
        runs: the runs.
        limits: what may be reached, in words and in numbers [m].
        beyond: what is written over runs without a largest displacement.
        words: of the report.
    """
    rows = list(dict.fromkeys(run.label for run in runs))
    return [_strip(runs, rows[i : i + STRIP_ROWS], limits, beyond, words) for i in range(0, len(rows), STRIP_ROWS)]


def _strip(
    runs: Sequence[Run], rows: list[str], limits: Sequence[tuple[str, float]], beyond: str, words: Words
) -> Figure:
    """Some of the rows, in the scale of all runs."""
    variants = list(dict.fromkeys(run.variant for run in runs))
    figure = Figure(figsize=(PICTURE_WIDTH, 1.5 + 0.24 * len(rows)), layout="constrained")
    ax = figure.subplots()
    finite = [run.largest for run in runs if math.isfinite(run.largest)]
    of_one_polarity = not any(run.is_reversed for run in runs)
    longest = 1.08 * max([*finite, *(limit for _, limit in limits), 1e-6])
    for run in (run for run in runs if run.label in rows):
        order = variants.index(run.variant)
        colour = OWN[order % len(OWN)]["color"]
        y = rows.index(run.label) + 0.22 * (order - 0.5 * (len(variants) - 1))
        y += 0.0 if of_one_polarity else 0.09 if run.is_reversed else -0.09
        x = 1e3 * (run.largest if math.isfinite(run.largest) else 1.06 * longest)
        look = {"marker": "o" if math.isfinite(run.largest) else "X", "color": colour}
        ax.plot(x, y, linestyle="", markersize=5.5, markerfacecolor="white" if run.is_reversed else colour, **look)
    ax.axvspan(1e3 * longest, 1.12e3 * longest, color="0.93", zorder=0)
    above_axes: Look = {"transform": ax.get_xaxis_transform(), "fontsize": LEAST_TYPE, "ha": "center", "va": "bottom"}
    ax.text(1.06e3 * longest, 1.01, beyond, **above_axes)
    for label, limit in limits:
        ax.axvline(1e3 * limit, color="0.35", linewidth=0.9, linestyle="--", zorder=1)
        side = "right" if limit == max(other for _, other in limits) else "center"
        ax.text(1e3 * limit, 1.01, label, **(above_axes | {"ha": side}))
    ax.set_yticks(range(len(rows)), labels=rows)
    ax.set(xlim=(0, 1.12e3 * longest), ylim=(len(rows) - 0.4, -0.6), xlabel=words("axis_largest"))
    ax.grid(axis="y", color="0.92")
    looks = {variant: {"color": OWN[i % len(OWN)]["color"]} for i, variant in enumerate(variants) if variant}
    if not of_one_polarity:
        looks |= {words("recorded"): {"color": "0.3"}, words("reversed"): {"color": "0.3", "markerfacecolor": "white"}}
    handles = [Line2D([], [], marker="o", linestyle="", **look) for look in looks.values()]
    if looks:
        legend_below(figure, handles, list(looks), 5, fontsize=LEAST_TYPE)
    small(ax)
    return figure


def histories(runs: Sequence[Run], displacements: Sequence[Array], limit: float | None, words: Words) -> list[Figure]:
    """Displacement over time in small panels, one a record, those with the largest motion where there are many, in
    pictures of one scale, none taller than half a page.

    Args:
        runs: the runs.
        displacements: of each at its samples [m], shape (n,).
        limit: displacement from which nothing comes back, or None [m].
        words: of the report.
    """
    largest = dict[int, float]()
    for run in runs:
        largest[run.record] = max(largest.get(run.record, 0.0), run.largest)
    records = sorted(sorted(largest, key=lambda record: -largest[record])[:MOST_PANELS])
    starts = range(0, len(records), PANELS_OF_PICTURE)
    return [_histories(runs, displacements, limit, records[i : i + PANELS_OF_PICTURE], words) for i in starts]


def _histories(
    runs: Sequence[Run], displacements: Sequence[Array], limit: float | None, records: Sequence[int], words: Words
) -> Figure:
    """The panels of some records, in the scale of all runs."""
    lines = list(dict.fromkeys(run.line for run in runs))
    styles_suffice = len(lines) <= MOST_LINE_STYLES
    columns = min(2, len(records))
    figure, axes = figure_of_panels(len(records), columns, (PICTURE_WIDTH / columns, 1.32 if len(records) > 4 else 1.8))
    peaks = [float(np.abs(displacement).max()) for displacement in displacements]
    finite = [peak for run, peak in zip(runs, peaks, strict=True) if math.isfinite(run.largest)]
    top = 1.1e3 * max([*finite, 1e-6]) if finite else 1.1e3 * (limit or 1.0)
    if limit is not None and 1e3 * limit < FARTHEST_LIMIT * top:
        top = max(top, 1.1e3 * limit)
    for ax, record in zip(axes.flat, records, strict=False):
        for run, displacement in zip(runs, displacements, strict=True):
            if run.record == record:
                style = OWN[lines.index(run.line) % len(OWN)] if styles_suffice else {"color": "0.4"}
                line_style = ":" if run.is_reversed else "-"
                ax.plot(run.response.t, 1e3 * displacement, color=style["color"], linestyle=line_style, linewidth=0.9)
                name = run.line if run.motion == DASH else run.motion
        if limit is not None:
            ax.axhline(1e3 * limit, color="0.4", linewidth=0.7, linestyle="--")
        low = min(0.0, *(float(displacement.min()) for displacement in displacements))
        ax.set(ylim=(max(-top, 1.05e3 * low - 0.03 * top), top), xlim=(0, None))
        ax.set_title(name, fontsize=LEAST_TYPE, pad=2)
        small(ax)
    for ax in axes[-1]:
        ax.set_xlabel(words("axis_t"), fontsize=LEAST_TYPE)
    figure.supylabel(words("axis_moved"), fontsize=LEAST_TYPE)
    if styles_suffice:
        handles = [Line2D([], [], color=OWN[i % len(OWN)]["color"]) for i in range(len(lines))]
        legend_below(figure, handles, lines, 4, fontsize=LEAST_TYPE)
    return figure


def small(ax: Axes) -> None:
    """Type of small panels."""
    ax.tick_params(labelsize=LEAST_TYPE)
    for axis in (ax.xaxis, ax.yaxis):
        axis.label.set_fontsize(LEAST_TYPE)
