"""The sketch of a case: section and elevation of the wall with dimensions, and all that it meets and carries."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ..problem.wall.case import Case
from ..problem.wall.effect import Effect
from ..quantities import require_flag, require_kind, require_text
from .bodies import Bodies
from .section import STONE, blocks, surroundings

DIMENSION: dict[str, Any] = {"arrowstyle": "<->", "color": "0.3", "shrinkA": 0, "shrinkB": 0, "linewidth": 0.8}
LEADER: dict[str, Any] = {"arrowstyle": "-", "color": "0.6", "linewidth": 0.5, "relpos": (0.0, 0.5)}


def sketch(case: Case, title: str = "", *, arguments: bool = False) -> Figure:
    """Section and elevation of a wall at rest with dimensions [m], true to scale, and its effects.

    Openings are drawn in the middle of the elevation: where they are along the wall plays no part.

    Args:
        case: the wall and its effects.
        title: what stands above.
        arguments: whether to write the names of the arguments of `Tie`, `Thrust`, `Load`, `AddedMass` and `SideStop`
            beside what they place, in place of the values.
    """
    require_kind("case", case, Case)
    require_text("title", title)
    require_flag("arguments", arguments)
    figure = Figure(figsize=(8.4, 4.2), layout="constrained")
    section, elevation = figure.subplots(1, 2, width_ratios=(2.0, 1.0))
    wall = case.wall
    rests = np.array([[wall.centroid_offset, wall.centroid_height]])
    bodies = Bodies(np.zeros(1), (wall.outline,), rests, np.zeros((1, 1, 3)))
    blocks(section, bodies)
    surroundings(section, case, bodies)(0)
    for text in list(section.texts):
        text.remove()  # the notes say it
    for artist in section.get_children():
        artist.set_animated(False)
    section.axis("off")
    _dimensions(section, case)
    _notes(section, case, arguments=arguments)
    section.set_title("section; outwards is to the right", fontsize=9)
    _elevation(elevation, case)
    figure.suptitle(title, fontsize=11)
    return figure


def _across(ax: Axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    """A dimension with its text in the middle."""
    ax.annotate("", start, end, arrowprops=DIMENSION)
    middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    level = start[1] == end[1]
    offset, turn = ((0, -3), 0) if level else ((-3, 0), 90)
    note = ax.annotate(text, middle, offset, textcoords="offset points", fontsize=7, rotation=turn)
    note.set(ha="center" if level else "right", va="top" if level else "center")


def _dimensions(ax: Axes, case: Case) -> None:
    """Thickness and height of the wall, the lever of the toe, and the height of the stop."""
    wall, (left, right), (low, high) = case.block, ax.get_xlim(), ax.get_ylim()
    height, room = 2 * wall.h, 0.05 * (high - low)
    ax.set_ylim(low - 1.2 * room, high + 1.2 * room)
    ax.set_xlim(left - 0.15 * height, right + 1.25 * height)
    _across(ax, (-wall.b, -0.6 * room), (wall.b, -0.6 * room), f"{2 * wall.b:g} m")
    edge = left - 0.04 * height
    _across(ax, (edge, 0.0), (edge, height), f"{height:g} m")
    if case.stop_top is not None and case.stop_top < height:
        at = -wall.b - 0.12 * height
        _across(ax, (at, 0.0), (at, case.stop_top), f"stop {case.stop_top:g} m")
    centroid = case.wall.centroid_offset, case.wall.centroid_height
    ax.plot(*centroid, marker="+", color="0.15", markersize=7, zorder=7)


def _notes(ax: Axes, case: Case, *, arguments: bool) -> None:
    """What each effect is and where, in a column beside the wall, each with a line to its place."""
    notes = sorted(_effects(case, arguments=arguments), key=lambda note: note[0][1])
    if not notes:
        return
    height, right = 2 * case.block.h, ax.get_xlim()[1]
    apart, level, before = 0.04 * height, -np.inf, 0
    for (x, z), text in notes:
        lines = 1 + text.count("\n")
        level, before = max(level + apart * (1 + before + lines), z), lines
        ax.annotate(text, (x, z), (right - 1.2 * height, level), fontsize=6.5, va="center", arrowprops=LEADER, zorder=8)
    low, high = ax.get_ylim()
    ax.set_ylim(low, max(high, level + 2 * apart))


def _effects(case: Case, *, arguments: bool) -> list[tuple[tuple[float, float], str]]:
    """Where each effect acts in the section, and what it is."""
    face, said, made = -case.block.b, dict[Effect, str](), []
    for name, effect in case.named.items():
        if not effect.mass_added:
            said[effect] = f"{said[effect]}, {name}" if effect in said else name
    for effect, name in [*said.items(), *((mass, mass.label) for mass in case.wall.masses)]:
        note = f"{type(effect).__name__}({effect.arguments})" if arguments else f"{name}: {effect.said}"
        made.append(((face if effect.on_face else effect.offset, effect.height), note))
    if arguments and case.stop_top is not None:
        made.append(((face - 0.05, case.stop_top), "SideStop(top)"))
    return made


def _elevation(ax: Axes, case: Case) -> None:
    """The wall from outside, with its openings. Those of one sill are drawn at equal distances."""
    wall = case.block
    height, length = 2 * wall.h, wall.length
    ax.add_patch(Rectangle((-0.5 * length, 0.0), length, height, facecolor=STONE, edgecolor="0.15"))
    sills = [opening.sill for opening in wall.openings]
    for i, opening in enumerate(wall.openings):
        middle = length * ((sills[:i].count(opening.sill) + 0.5) / sills.count(opening.sill) - 0.5)
        place = middle - 0.5 * opening.width, opening.sill
        ax.add_patch(Rectangle(place, opening.width, opening.height, facecolor="white", edgecolor="0.35"))
        size = f"{opening.width:.3g} x\n{opening.height:.3g}\nsill {opening.sill:.3g}"
        ax.text(middle, opening.sill + 0.5 * opening.height, size, fontsize=6, ha="center", va="center")
    below = -0.05 * height
    _across(ax, (-0.5 * length, below), (0.5 * length, below), f"{length:g} m")
    ax.plot([-0.62 * length, 0.62 * length], [0.0, 0.0], color="0.15", linewidth=1.0)
    ax.set_xlim(-0.62 * length, 0.62 * length)
    ax.set_ylim(-0.14 * height, 1.05 * height)
    ax.set_aspect("equal")
    ax.set_xlabel("$y$ [m]")
    ax.set_title("elevation", fontsize=9)
