"""Pictures of responses over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ..problem.masonry.case import MasonryCase
from ..problem.wall.case import Case
from ..quantities import require_kind, require_text
from ..result.ending import Outcome
from ..result.response import Response
from .picture import kind, listed, picture
from .style import (
    BEHIND,
    BLACK,
    GREEN,
    ORANGE,
    Look,
    Picture,
    below_figure,
    figure_of,
    figure_of_panels,
    plain_names,
    require_labels,
    short,
    styles_of,
    wrapped,
)

TIME = "time $t$ [s]"
MOST = 6
"""Entries of a legend of ties."""


@picture()
def rotation(
    ax: Axes, responses: Sequence[Response], labels: Sequence[str] | None = None, top: float | None = None
) -> Axes:
    """Rotation in multiples of alpha against time.

    A wall that overturns is shown up to 1.2 alpha, or to its largest rotation before it has no way back. A note gives
    the time from which that is so; the end of its run is in the message of the response. Responses have the lines of
    their solvers, or with `labels` colours of their own. A dotted line is the rotation that overturns a wall whose
    effects move it from alpha, unless it is far beyond the motion. `top` is the largest rotation shown, over alpha.
    """
    fallen = [overturned_at(response) for response in responses]
    shares = [response.theta / response.of_wall[0].wall.alpha for response in responses]
    reached, styles, lines = [0.0], styles_of(responses, labels), []
    for response, share, end, style in zip(responses, shares, fallen, styles, strict=True):
        lines += ax.plot(response.t, share, **style)
        reached.append(float(np.abs(share[response.t <= (np.inf if end is None else end)]).max()))
    ax.axhline(0, color="0.8", linewidth=0.6, zorder=0)
    far_limit = 4 * max(reached)  # a line there would flatten the motion
    limits = {case.overturning_rotation / case.wall.alpha for case, _ in (response.of_wall for response in responses)}
    limits_drawn = [limit for limit in sorted(limits) if abs(limit - 1) > 0.01 and limit < far_limit]
    for limit in limits_drawn:
        ax.axhline(limit, color="0.4", linewidth=0.8, linestyle=":", zorder=1)
    if limits_drawn and (top is None or limits_drawn[0] < top):
        place: Look = {"transform": ax.get_yaxis_transform(), "ha": "left", "va": "top"}
        ax.text(0.01, limits_drawn[0], "overturns", fontsize=8, bbox=BEHIND, **place)
    ax.set(xlabel=TIME, ylabel=r"rotation $\theta/\alpha$ [-]")
    names = [response.solver for response in responses] if labels is None else labels
    ends = [(short(name), t) for name, t in zip(names, fallen, strict=True) if t is not None]
    notes = [f"{name}: beyond return from t = {t:.3g} s" for name, t in ends]
    if top is not None or notes:
        top_shown = float(top or max(1.2, 1.05 * max([*reached, *limits_drawn])))
        lowest, room = min(float(share.min()) for share in shares), _share_of(ax, len(notes)) if notes else 0.0
        bottom = -0.1 * top_shown if top is not None else max(-top_shown, min(-0.08 * top_shown, 1.08 * lowest))
        ax.set_ylim(bottom, (top_shown - room * bottom) / (1 - room))
        for line in lines:  # a wall that falls goes no farther, so that its line leaves the note alone
            line.set_clip_path(Rectangle((0, bottom), 1, top_shown - bottom, transform=ax.get_yaxis_transform()))
    if notes:
        text = "\n".join(notes) if len(responses) > 1 else notes[0].rsplit(": ", 1)[1]
        ax.text(0.02, 0.97, text, transform=ax.transAxes, fontsize=8, va="top", zorder=6)
    return ax


def overturned_at(response: Response) -> float | None:
    """When the wall went beyond the rotation from which it comes back [s], or None if it did not overturn."""
    if response.outcome is not Outcome.OVERTURNED:
        return None
    returns = np.flatnonzero(response.of_wall[0].returns_from(response.theta))
    return float(response.t[min(returns[-1] + 1, len(response.t) - 1) if returns.size else 0])


@picture(responses=listed(kind(Response)))
def displacement(ax: Axes, responses: Sequence[Response], labels: Sequence[str] | None = None) -> Axes:
    """Largest displacement of a centroid of all blocks of masonry against time, from rest [mm], a cross at each fall.

    Responses have the lines of their solvers, or with `labels` colours of their own.
    """
    for response, style in zip(responses, styles_of(responses, labels), strict=True):
        largest = 1e3 * np.linalg.norm(response.pose[:, :, : 3 if response.in_space else 2], axis=2).max(axis=1)
        (line,) = ax.plot(response.t, largest, **style)
        falls = np.array(list(response.of_joints.fallen.values()))
        ax.plot(falls, np.interp(falls, response.t, largest), "x", color=line.get_color(), markersize=7, zorder=5)
    ax.set_ylim(bottom=0)
    ax.set(xlabel=TIME, ylabel="farthest block [mm]")
    return ax


GROUNDS = {"motion": ("horizontal", BLACK), "transverse": ("transverse", GREEN), "vertical": ("vertical", ORANGE)}
"""The motions of the ground of a case, what they are called and their colours."""


@picture(case=kind(Case, MasonryCase))
def acceleration(ax: Axes, case: Case | MasonryCase, until: float) -> Axes:
    """Acceleration of the base against time [m/s2], horizontal and, where there are some, transverse and vertical.

    The base is the ground or a floor.
    """
    for name, (label, color) in GROUNDS.items():
        if (motion := case.grounds.get(name)) is not None:
            t = np.append(motion.times, [motion.duration, max(until, motion.duration)])
            ax.plot(t, np.append(motion.accel, [0.0, 0.0]), color=color, linewidth=0.8, label=label)
    if len(case.grounds) > 1 or case.vertical is not None:
        _legend_above(ax)
    ax.axhline(0, color="0.8", linewidth=0.6, zorder=0)
    ax.set(xlabel=TIME, ylabel="base [m/s²]")
    return ax


@picture(responses=listed(kind(Response)))
def ties(ax: Axes, responses: Sequence[Response], labels: Sequence[str] | None = None) -> Axes:
    """Force of the ties against time [kN], a cross where one broke, and how far each was drawn out.

    Ties of one response that did the same are drawn once.
    """
    entries = 0
    for response, style in zip(responses, styles_of(responses, labels), strict=True):
        drawn: dict[bytes, list[str]] = {}
        plain = plain_names(response.ties)
        for name, tie in response.ties.items():
            drawn.setdefault(tie.force.tobytes(), []).append(name)
        for i, names in enumerate(drawn.values()):
            tie = response.ties[names[0]]
            label = f"{short(style['label'])}, " if len(responses) > 1 else ""
            label += f"{short(', '.join(plain[name] for name in names))}: drawn out by {1e3 * tie.plastic[-1]:.3g} mm"
            look = style | {"label": label, "zorder": 2} | ({"linestyle": ("-", "--", "-.", ":")[i % 4]} if i else {})
            (line,) = ax.plot(response.t, tie.force / 1e3, **look)
            if tie.broken < np.inf:
                label += f", broke at {tie.broken:.3g} s"
                at = min(int(np.searchsorted(response.t, tie.broken)), len(response.t) - 1)
                height = tie.force[max(at - 1, 0)] / 1e3
                ax.plot(response.t[at], height, "x", color=line.get_color(), markersize=9, markeredgewidth=2, zorder=5)
            entries += 1
            line.set_label(label if entries < MOST else "_")
            last = line, label
    if entries >= MOST:
        last[0].set_label(last[1] if entries == MOST else f"and {entries - MOST + 1} more")
    ax.set_ylim(bottom=0.0)
    _legend_above(ax)
    ax.set(xlabel=TIME, ylabel="ties [kN]")
    return ax


def _share_of(ax: Axes, rows: int) -> float:
    """Share of the height of an Axes that rows of small text take [-]."""
    return min(0.7, (0.1 + 0.15 * rows) * figure_of(ax).dpi / ax.bbox.height)


def _legend_above(ax: Axes) -> None:
    """A legend above the lines of an Axes, in two columns where they are short enough."""
    labels = ax.get_legend_handles_labels()[1]
    figure = figure_of(ax)
    width = ax.bbox.width / figure.dpi  # [inch]
    columns = 2 if len(labels) > 2 and 2 * (0.06 * max(map(len, labels)) + 0.35) < width else 1
    rows = -(-len(labels) // columns)
    top, low = max(float(np.max(line.get_ydata(), initial=0.0)) for line in ax.get_lines()) or 1.0, ax.get_ylim()[0]
    ax.set_ylim(low, low + (1.08 * top - low) / (1 - _share_of(ax, rows)))
    ax.legend(frameon=False, fontsize=8, loc="upper right", ncols=columns, labelspacing=0.3, columnspacing=1.0)


def history(
    responses: Response | Sequence[Response], title: str = "", *, labels: Sequence[str] | None = None
) -> Figure:
    """Rotation against time of one response or of several, below the ground motion and above the forces of the ties.

    Of masonry it is the largest displacement of a block, see `displacement`.

    Args:
        responses: one, or several under the same ground motion or its reverse: of one case by several solvers, of the
            two polarities of a record, or of two cases, such as one with a tie and one without. The ground motion that
            is drawn is that of the first.
        title: what stands above.
        labels: what each response is called, one for each; each then has a colour of its own. Without them responses
            have the names of their solvers, and cases that differ are numbered.

    Raises:
        ValueError: for no response, responses under different ground motions, of walls and of masonry, or another
            number of labels.
    """
    require_text("title", title)
    if not isinstance(responses, Sequence):
        require_kind("responses", responses, Response)
    several = [responses] if isinstance(responses, Response) else list(responses)
    for i, response in enumerate(several):
        require_kind(f"responses[{i}]", response, Response)
    if not several:
        raise ValueError("responses is empty; at least one response is needed")
    first = several[0]
    for i, response in enumerate(several):
        if type(response.case) is not type(first.case):
            raise ValueError(f"responses[{i}] and responses[0] are one of a wall and one of masonry; draw each alone")
        if response.case.grounds != first.case.grounds and not reversed_ground(first, response):
            raise ValueError(
                f"responses[{i}] is that to another ground motion than responses[0]; draw cases under one motion "
                "or its reverse"
            )
    names = required_labels(several, labels)
    case, until = first.case, max(float(response.t[-1]) for response in several)
    has_ties = any(response.ties for response in several)
    has_motion = bool(case.grounds)
    heights = [1.0] * has_motion + [2.0] + [1.2] * has_ties
    figure = Picture(figsize=(6.3, 1.8 + 1.2 * len(heights)), layout="constrained")
    axes = figure.subplots(len(heights), 1, sharex=True, height_ratios=heights, squeeze=False)[:, 0]
    if has_motion:
        acceleration(axes[0], case, until)
    (rotation if first.joints is None else displacement)(axes[int(has_motion)], several, names)
    if has_ties:
        ties(axes[-1], several, names)
    for ax in axes[:-1]:
        ax.set_xlabel("")
    axes[0].set_xlim(0, until)
    axes[0].set_title(wrapped(title, 5.4, 10), fontsize=10)
    if len(several) > 1:
        below_figure(figure, axes[int(has_motion)])
    return figure


def reversed_ground(left: Response, right: Response) -> bool:
    """Whether the horizontal motion of the ground of one response is that of the other, reversed."""
    first, second = (response.case for response in (left, right))
    if first.motion is None or second.motion != first.motion.reversed():
        return False
    return first.transverse == second.transverse and first.vertical == second.vertical


def required_labels(responses: Sequence[Response], labels: object) -> list[str] | None:
    """Labels of responses: those given, or solvers with numbers where cases differ, or None where solvers suffice.

    Raises:
        TypeError, ValueError: see `require_labels`.
    """
    if labels is not None:
        return require_labels(labels, responses)
    if len({response.solver for response in responses}) == len(responses):
        return None
    first, names = responses[0], list[str]()
    for response in responses:
        names.append(response.solver + (", reversed" if reversed_ground(first, response) else ""))
    return names if len(set(names)) == len(names) else [f"{name} {i + 1}" for i, name in enumerate(names)]


@picture(responses=listed(kind(Response)))
def energy(ax: Axes, responses: Sequence[Response]) -> Axes:
    """Energy above the wall at rest against time."""
    for response, style in zip(responses, styles_of(responses), strict=True):
        ax.plot(response.t, response.energy / 1e3, **style)
    ax.set_ylim(bottom=0)
    ax.set(xlabel=TIME, ylabel="total energy $E$ [kJ]")
    return ax


@picture()
def comparison(responses: Sequence[Response], title: str = "") -> Figure:
    """Rotation above, energy below, in the manner of the paper's Figure 3."""
    figure = Picture(figsize=(6.3, 5.0), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    rotation(above, responses).set_xlabel("")
    energy(below, responses)
    below.set_xlim(0, max(r.t[-1] for r in responses))
    below_figure(figure, above)
    above.set_title(wrapped(title, 5.4, 10), fontsize=10)
    return figure


@picture()
def grid(
    panels: Sequence[tuple[str, Sequence[Response]]],
    columns: int = 2,
    top: float | None = None,
    labels: Sequence[str] | None = None,
) -> Figure:
    """Rotation histories of several cases in one scale, one panel each, in the manner of the paper's Figure 4.

    `top` cuts the panels off at a rotation in multiples of alpha, to show small rebounds large. `labels` are the names
    of the responses of each panel, in place of their solvers.
    """
    figure, axes = figure_of_panels(len(panels), columns, (3.4, 2.2))
    axes_drawn = list(axes.flat[: len(panels)])
    for ax, (title, responses) in zip(axes_drawn, panels, strict=True):
        rotation(ax, responses, labels, top)
        ax.set_title(wrapped(title, figure.get_figwidth() / axes.shape[1] - 0.7, 9), fontsize=9)
    limits = np.array([ax.get_ylim() for ax in axes_drawn])
    last = max(float(response.t[-1]) for _, responses in panels for response in responses)
    for ax in axes_drawn:
        ax.set(xlim=(0.0, last), ylim=(limits[:, 0].min(), limits[:, 1].max()))
        ax.label_outer(remove_inner_ticks=False)
    below_figure(figure, axes[0, 0], fontsize=8)
    return figure
