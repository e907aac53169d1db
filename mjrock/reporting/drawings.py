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
from ..study.loading.load_check import Borne
from .content import content_of
from .pictures import FAILS, LABEL, SMALL, TALL, UNDER, WIDE
from .texts import FOUND, Words
from .verdicts import Subject

SWAY = 0.08
"""How far a crack is drawn open, over the length between the supports [-]."""
BEYOND = 0.4
"""How far walls go on in a drawing of a corner, over what moves of them [-]."""
OTHERS = Corner, VerticalBending, HorizontalBending
"""Mechanisms that are not drawn as the wall that stands for them."""
Colour = str | tuple[float, float, float]


def drawn(problem: Subject, words: Words, borne: Sequence[Borne] = ()) -> tuple[Figure, str]:
    """The drawing of what is checked or run, with the mechanism in it, and its caption.

    Args:
        problem: a case, a limit curve, what bears a load, or one of `OTHERS`.
        words: of the report.
        borne: of masonry, results whose loads are drawn.
    """
    if not isinstance(problem, OTHERS):
        return content_of(problem).at_rest(words, borne)
    figure = Figure(figsize=(WIDE, TALL), layout="constrained")
    if isinstance(problem, Corner):
        _corner(figure.subplots(1, 2), problem, words)
        return figure, words("drawing_corner")
    ax = figure.subplots()
    if isinstance(problem, VerticalBending):
        _between_floors(ax, problem, words)
    else:
        _between_sides(ax, problem, words)
    _plain(ax)
    return figure, words("drawing_bending")


def _plain(ax: Axes) -> None:
    """An Axes without frame, in one scale."""
    ax.set_aspect("equal")
    ax.axis("off")
    ax.margins(0.08)


def _stone(ax: Axes, outline: Sequence[tuple[float, float]] | Array, colour: Colour = STONE) -> None:
    ax.add_patch(Polygon(np.asarray(outline), facecolor=colour, edgecolor="0.3", linewidth=0.9))
    ax.update_datalim(np.asarray(outline))


def _moved(ax: Axes, outline: Array) -> None:
    ax.fill(*outline.T, facecolor="none", edgecolor=FAILS, linestyle="--", linewidth=0.9, zorder=3)


def _arrow(ax: Axes, end: tuple[float, float], way: tuple[float, float], length: float) -> None:
    start = end[0] - length * way[0], end[1] - length * way[1]
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": FORCE, "linewidth": 1.6}, zorder=5)
    ax.update_datalim([start, end])


def _note(ax: Axes, text: str, at: tuple[float, float], beside: tuple[float, float] = (6, 0)) -> None:
    ax.annotate(text, at, beside, va="center", **LABEL).set_bbox(UNDER)


def _corner(axes: Sequence[Axes], corner: Corner, words: Words) -> None:
    """Plan, with the way in which the corner goes, and elevation of a wall, with the crack of its wedge."""
    plan, side = axes
    t, h, p = corner.thickness, corner.height, corner.depth
    far = (t + p) * (1 + BEYOND)
    for outline in ([(0, 0), (far, 0), (far, t), (0, t)], [(0, 0), (t, 0), (t, far), (0, far)]):
        _stone(plan, outline, GROUND_COLOUR)
    for outline in ([(0, 0), (t + p, 0), (t + p, t), (t, t), (t, t + p), (0, t + p)],):
        _stone(plan, outline)
    way = -1 / math.sqrt(2)
    _arrow(plan, (0.6 * far * way, 0.6 * far * way), (way, way), 0.5 * far)
    _on_corner(plan, side, corner)
    _stone(side, [(0, 0), (far, 0), (far, h), (0, h)], GROUND_COLOUR)
    _stone(side, [(0, 0), (t, 0), (t + p, h), (0, h)])
    turned = 0.5 * SWAY
    _moved(side, np.array([(0, 0), (t, turned * t), (t + p - turned * h, h), (-turned * h, h)]))
    side.plot(0, 0, "o", color=FAILS, markersize=4, zorder=6)
    _note(side, words("hinge"), (0, 0), (-6, -9))
    _note(side, words.quantity(h, "m", FOUND), (far, 0.5 * h))
    _note(plan, words.quantity(t, "m", FOUND), (far, 0.5 * t))
    for ax, name in ((plan, "plan"), (side, "elevation")):
        _plain(ax)
        ax.set_title(words(name), fontsize=SMALL, loc="left")


def _on_corner(plan: Axes, side: Axes, corner: Corner) -> None:
    """What a corner bears: rods along the walls, arrows of forces, dots of loads and masses."""
    t, far = corner.thickness, (corner.thickness + corner.depth) * (1 + BEYOND)
    links = link_effects(corner.effects).values()
    for link in links:
        z = link.height
        for ax, *ends in ((plan, (0, t / 2), (far, t / 2)), (plan, (t / 2, 0), (t / 2, far)), (side, (0, z), (far, z))):
            ax.plot(*zip(*ends, strict=True), color=link.colour, linewidth=1.4, zorder=4)
    for effect in (one for one in corner.effects if one not in links):
        out, _, up = effect.force_vector or (0.0, 0.0, 0.0)
        if out:
            way, face = (-1, t) if out > 0 else (1, 0)
            _arrow(plan, (face, face), (way / math.sqrt(2), way / math.sqrt(2)), 0.25 * far)
            _arrow(side, (way * 0.25 * far, effect.height), (way, 0), 0.25 * far)
            continue
        along = t / 2 - math.sqrt(2) * effect.offset  # half of what lies behind the post is in either wall
        at = [(along, t / 2), (t / 2, along)] if along > t / 2 else [((along + t / 2) / 2,) * 2]
        for ax, places in ((plan, at), (side, [(at[0][0], effect.height)])):
            ax.plot(*zip(*places, strict=True), "o", color=FORCE, markersize=4, zorder=6)
        if up:
            _arrow(side, (at[0][0], effect.height), (0, -1), 0.2 * corner.height)


def _between_floors(ax: Axes, bending: VerticalBending, words: Words) -> None:
    """Section of the wall, and its two bodies as the crack opens."""
    h, crack = 2 * bending.wall.h, bending.crack_height
    outline = np.asarray(bending.wall.outline)
    outline = outline - np.array([0.0, outline[:, 1].min()])
    _stone(ax, outline)
    edge = np.concatenate([np.linspace(a, b, 40) for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True)])
    sway = np.interp(edge[:, 1], [0, crack, h], [0, SWAY * h, 0])
    _moved(ax, edge + np.column_stack([sway, np.zeros(len(edge))]))
    left, right = outline[:, 0].min(), outline[:, 0].max()
    bears = left + (bending.lever if bending.bearing is not None else 0.5 * (right - left))
    _arrow(ax, (bears, h), (0, -1), 0.15 * h)
    _note(ax, f"{words('in_load')} {words.quantity(bending.load, 'N', FOUND)}", (bears, 1.1 * h))
    text = f"{words('in_crack_height')} {words.quantity(crack, 'm', FOUND)}"
    _note(ax, text, (right + SWAY * h, crack))
    for z in (0.0, h):
        ax.plot([left - 0.1 * h, right], [z, z], color="0.3", linewidth=2.0, zorder=1)
    ax.set_title(words("section"), fontsize=SMALL, loc="left")


def _between_sides(ax: Axes, bending: HorizontalBending, words: Words) -> None:
    """Plan of the wall, and its two bodies as the crack opens."""
    length, t = bending.wall.length, 2 * bending.wall.b
    crack = bending.parts[0]
    _stone(ax, [(0, 0), (length, 0), (length, -t), (0, -t)])
    edge = np.array([(0, 0), (crack, 0), (length, 0), (length, -t), (crack, -t), (0, -t)], dtype=float)
    sway = np.interp(edge[:, 0], [0, crack, length], [0, SWAY * length, 0])
    _moved(ax, edge - np.column_stack([np.zeros(6), sway]))
    for x, sign in ((0.0, 1), (length, -1)):
        _arrow(ax, (x, -0.5 * t), (sign, 0), 0.12 * length)
        ax.plot([x, x], [1.5 * t, -1.5 * t], color="0.3", linewidth=2.0, zorder=1)
    _note(ax, words.quantity(bending.thrust, "N", FOUND), (-0.12 * length, -0.5 * t), (0, 10))
    text = f"{words('in_crack')} {words.quantity(crack, 'm', FOUND)}"
    _note(ax, text, (crack, -t - SWAY * length), (0, -8))
    ax.set_title(words("plan"), fontsize=SMALL, loc="left")
