"""The drawing of what is checked: a wall that overturns, a corner, a wall that bends, or masonry of blocks."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from ..plotting.bodies import FORCE, GROUND_COLOUR, STONE
from ..problem.wall.bending import HorizontalBending, VerticalBending
from ..problem.wall.effects import link_effects
from ..problem.wall.wedge import Corner
from ..quantities import Array
from ..study.loading.load_check import StaticAnswer
from .content import content_of
from .pictures import FAILS, LABEL, LABEL_BOX, LEAST_TYPE, PICTURE_WIDTH, TALLEST_WALL
from .texts import FOUND, Words
from .verdicts import Subject

SWAY = 0.08
"""How far a crack is drawn open, over the length between the supports [-]."""
UNIT_DIAGONAL = 1 / math.sqrt(2)
"""Each component of a unit vector along the diagonal of a corner [-]."""
FORCE_ARROW, LOAD_ARROW = 0.25, 0.2
"""Lengths of arrows on a corner: of a force over the walls drawn, and of a load over the height [-]."""
BEYOND_CORNER = 0.4
"""How far walls go on in a drawing of a corner, over what moves of them [-]."""
DRAWN_APART = Corner, VerticalBending, HorizontalBending
"""Mechanisms that are not drawn as the wall that stands for them."""
Colour = str | tuple[float, float, float]


def drawing_of(problem: Subject, words: Words, static_answers: Sequence[StaticAnswer] = ()) -> tuple[Figure, str]:
    """The drawing of what is checked or run, with the mechanism in it, and its caption.

    Args:
        problem: a case, a limit curve, what bears a load, or one of `DRAWN_APART`.
        words: of the report.
        static_answers: of masonry, results whose loads are drawn.
    """
    if not isinstance(problem, DRAWN_APART):
        return content_of(problem).rest_drawing(words, static_answers)
    figure = Figure(figsize=(PICTURE_WIDTH, TALLEST_WALL), layout="constrained")
    if isinstance(problem, Corner):
        _draw_corner(figure.subplots(1, 2), problem, words)
        return figure, words("drawing_corner")
    ax = figure.subplots()
    if isinstance(problem, VerticalBending):
        _draw_between_floors(ax, problem, words)
    else:
        _draw_between_sides(ax, problem, words)
    _hide_frame(ax)
    return figure, words("drawing_bending")


def _hide_frame(ax: Axes) -> None:
    """An Axes without frame, in one scale."""
    ax.set_aspect("equal")
    ax.axis("off")
    ax.margins(0.08)


def _add_outline(ax: Axes, outline: Sequence[tuple[float, float]] | Array, colour: Colour = STONE) -> None:
    ax.add_patch(Polygon(np.asarray(outline), facecolor=colour, edgecolor="0.3", linewidth=0.9))
    ax.update_datalim(np.asarray(outline))


def _add_moved_outline(ax: Axes, outline: Array) -> None:
    ax.fill(*outline.T, facecolor="none", edgecolor=FAILS, linestyle="--", linewidth=0.9, zorder=3)


def _add_arrow(ax: Axes, end: tuple[float, float], direction: tuple[float, float], length: float) -> None:
    start = end[0] - length * direction[0], end[1] - length * direction[1]
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": FORCE, "linewidth": 1.6}, zorder=5)
    ax.update_datalim([start, end])


def _add_note(ax: Axes, text: str, place: tuple[float, float], offset: tuple[float, float] = (6, 0)) -> None:
    ax.annotate(text, place, offset, va="center", **LABEL).set_bbox(LABEL_BOX)


def _draw_corner(axes: Sequence[Axes], corner: Corner, words: Words) -> None:
    """Plan, with the direction in which the corner moves, and elevation of a wall, with the crack of its wedge."""
    plan, side = axes
    t, h, p = corner.thickness, corner.height, corner.depth
    end = (t + p) * (1 + BEYOND_CORNER)
    for outline in ([(0, 0), (end, 0), (end, t), (0, t)], [(0, 0), (t, 0), (t, end), (0, end)]):
        _add_outline(plan, outline, GROUND_COLOUR)
    _add_outline(plan, [(0, 0), (t + p, 0), (t + p, t), (t, t), (t, t + p), (0, t + p)])
    tip = -0.6 * end * UNIT_DIAGONAL
    _add_arrow(plan, (tip, tip), (-UNIT_DIAGONAL, -UNIT_DIAGONAL), 0.5 * end)
    _draw_loads_of_corner(plan, side, corner)
    _add_outline(side, [(0, 0), (end, 0), (end, h), (0, h)], GROUND_COLOUR)
    _add_outline(side, [(0, 0), (t, 0), (t + p, h), (0, h)])
    rotation = 0.5 * SWAY
    _add_moved_outline(side, np.array([(0, 0), (t, rotation * t), (t + p - rotation * h, h), (-rotation * h, h)]))
    side.plot(0, 0, "o", color=FAILS, markersize=4, zorder=6)
    _add_note(side, words("hinge"), (0, 0), (-6, -9))
    _add_note(side, words.quantity(h, "m", FOUND), (end, 0.5 * h))
    _add_note(plan, words.quantity(t, "m", FOUND), (end, 0.5 * t))
    for ax, name in ((plan, "plan"), (side, "elevation")):
        _hide_frame(ax)
        ax.set_title(words(name), fontsize=LEAST_TYPE, loc="left")


def _draw_loads_of_corner(plan: Axes, side: Axes, corner: Corner) -> None:
    """What a corner bears: rods along the walls, arrows of forces, dots of loads and masses."""
    t, end = corner.thickness, (corner.thickness + corner.depth) * (1 + BEYOND_CORNER)
    middle = t / 2
    links = link_effects(corner.effects).values()
    for link in links:
        wall, across, level = (0, end), (middle, middle), (link.height, link.height)
        for ax, x, y in ((plan, wall, across), (plan, across, wall), (side, wall, level)):
            ax.plot(x, y, color=link.colour, linewidth=1.4, zorder=4)
    for effect in (effect for effect in corner.effects if effect not in links):
        outwards, _, upwards = effect.force_vector or (0.0, 0.0, 0.0)
        if outwards:
            sign, face = (-1, t) if outwards > 0 else (1, 0)
            _add_arrow(plan, (face, face), (sign * UNIT_DIAGONAL, sign * UNIT_DIAGONAL), FORCE_ARROW * end)
            _add_arrow(side, (sign * FORCE_ARROW * end, effect.height), (sign, 0), FORCE_ARROW * end)
            continue
        along = middle - effect.offset / UNIT_DIAGONAL  # half of what lies behind the post is in either wall
        places = [(along, middle), (middle, along)] if along > middle else [((along + middle) / 2,) * 2]
        side_place = places[0][0], effect.height
        for ax, dots in ((plan, places), (side, [side_place])):
            ax.plot(*zip(*dots, strict=True), "o", color=FORCE, markersize=4, zorder=6)
        if upwards:
            _add_arrow(side, side_place, (0, -1), LOAD_ARROW * corner.height)


def _draw_between_floors(ax: Axes, bending: VerticalBending, words: Words) -> None:
    """Section of the wall, and its two bodies as the crack opens."""
    h, crack = 2 * bending.wall.h, bending.crack_height
    outline = np.asarray(bending.wall.outline)
    outline = outline - np.array([0.0, outline[:, 1].min()])
    _add_outline(ax, outline)
    points = np.concatenate([np.linspace(a, b, 40) for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True)])
    sway = np.interp(points[:, 1], [0, crack, h], [0, SWAY * h, 0])
    _add_moved_outline(ax, points + np.column_stack([sway, np.zeros(len(points))]))
    left, right = outline[:, 0].min(), outline[:, 0].max()
    load_x = left + (bending.lever if bending.bearing is not None else 0.5 * (right - left))
    _add_arrow(ax, (load_x, h), (0, -1), 0.15 * h)
    _add_note(ax, f"{words('in_load')} {words.quantity(bending.load, 'N', FOUND)}", (load_x, 1.1 * h))
    text = f"{words('in_crack_height')} {words.quantity(crack, 'm', FOUND)}"
    _add_note(ax, text, (right + SWAY * h, crack))
    for z in (0.0, h):
        ax.plot([left - 0.1 * h, right], [z, z], color="0.3", linewidth=2.0, zorder=1)
    ax.set_title(words("section"), fontsize=LEAST_TYPE, loc="left")


def _draw_between_sides(ax: Axes, bending: HorizontalBending, words: Words) -> None:
    """Plan of the wall, and its two bodies as the crack opens."""
    length, t = bending.wall.length, 2 * bending.wall.b
    crack = bending.parts[0]
    _add_outline(ax, [(0, 0), (length, 0), (length, -t), (0, -t)])
    points = np.array([(0, 0), (crack, 0), (length, 0), (length, -t), (crack, -t), (0, -t)], dtype=float)
    sway = np.interp(points[:, 0], [0, crack, length], [0, SWAY * length, 0])
    _add_moved_outline(ax, points - np.column_stack([np.zeros(6), sway]))
    for x, sign in ((0.0, 1), (length, -1)):
        _add_arrow(ax, (x, -0.5 * t), (sign, 0), 0.12 * length)
        ax.plot([x, x], [1.5 * t, -1.5 * t], color="0.3", linewidth=2.0, zorder=1)
    _add_note(ax, words.quantity(bending.thrust, "N", FOUND), (-0.12 * length, -0.5 * t), (0, 10))
    text = f"{words('in_crack')} {words.quantity(crack, 'm', FOUND)}"
    _add_note(ax, text, (crack, -t - SWAY * length), (0, -8))
    ax.set_title(words("plan"), fontsize=LEAST_TYPE, loc="left")
