"""The sketch of a case: section and elevation of the wall with dimensions, and all that it meets and carries."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, Patch, Polygon, Rectangle

from ..problem.masonry.case import require_wall
from ..problem.wall.case import Case
from ..problem.wall.effect import Effect
from ..quantities import require_flag, require_text
from .arguments import anything, picture
from .bodies import Bodies
from .figures import Picture
from .section import GROUND_COLOUR, STONE, blocks, surroundings
from .style import WIDEST, Look, figure_of, titled

Note = tuple[tuple[float, float], str]
"""A place in the section, x and z [m], and what is there."""
DIMENSION: Look = {"arrowstyle": "|-|,widthA=0.2,widthB=0.2", "color": "0.3", "shrinkA": 0, "shrinkB": 0}
LEADER: Look = {"arrowstyle": "-", "color": "0.6", "linewidth": 0.5, "relpos": (0.0, 0.5)}
TALLEST, LARGEST = 3.4, 2.0
"""Largest height of a drawing, and largest width of the section [inch]."""
POINTS = 4001
"""Rotations at which ties are looked at, up to the overturning."""
LEADING, LETTER, APART, EDGE, LINE = 0.2, 0.06, 0.4, 0.15, 0.15
"""Room for leaders, width of a letter, room between the drawings and at the edges, and height of a line [inch]."""


@picture(case=anything)
def sketch(case: Case, title: str = "", *, arguments: bool = False) -> Figure:
    """Section and elevation of a wall at rest with dimensions [m], true to scale, and its effects.

    A tie that breaks before the wall overturns says how far the centroid has then moved outwards as the wall turns
    about its toe. Openings of one sill are drawn at equal distances: where they are along the wall plays no part. The
    elevation of a long wall has a smaller scale than the section.

    Args:
        case: the wall and its effects.
        title: what stands above.
        arguments: whether to write the names of the arguments of `Tie`, `Thrust`, `Load`, `AddedMass` and `SideStop`
            beside what they place, in place of the values.
    """
    require_wall("case", case, "plotting.blocks")
    require_text("title", title)
    require_flag("arguments", arguments)
    figure = Picture()
    left, right = (figure.add_axes((0.0, 0.0, 1.0, 1.0), label=name) for name in ("section", "elevation"))
    section(left, case)
    elevation(right, case, left.get_ylim())
    notes = sorted(_effects(case, arguments=arguments), key=lambda note: note[0][1])
    _arrange(figure, title, _sizes(case), notes)
    left.set_title("section; outwards is to the right", fontsize=9, loc="left")
    right.set_title("elevation", fontsize=9)
    return figure


def _arrange(figure: Figure, title: str, openings: Sequence[str], notes: Sequence[Note]) -> None:
    """Size the figure, and place the title, the drawings on one level, and the notes between them.

    Args:
        figure: with its section and elevation, whose limits [m] are set.
        title: what stands above.
        openings: what stands below the elevation, line by line.
        notes: on effects, from the lowest.
    """
    left, right = figure.axes
    wide, tall, long = (float(np.ptp(limits)) for limits in (left.get_xlim(), left.get_ylim(), right.get_xlim()))
    scale = min(TALLEST / tall, LARGEST / wide)  # [inch/m]
    column = EDGE + scale * wide + EDGE
    letters = max((len(line) for _, text in notes for line in text.splitlines()), default=0)
    beside = column + (LEADING + LETTER * letters if notes else 0.0) + APART + EDGE
    smaller = min(scale, max(1.0, WIDEST - beside) / long)
    width = min(WIDEST, max(5.0, beside + smaller * long))
    below, room = EDGE + LINE * len(openings), LINE * sum(2 + text.count("\n") for _, text in notes)
    room = max(scale * tall, room)
    figure.set_size_inches(width, 1.0)
    height = below + room + 0.3 + titled(figure, title)
    figure.set_size_inches(width, height)
    for ax, one, start in ((left, scale, EDGE), (right, smaller, width - EDGE - smaller * long)):
        (x0, x1), (low, high) = ax.get_xlim(), ax.get_ylim()
        bottom = below + (one - scale) * low
        ax.set_position((start / width, bottom / height, one * (x1 - x0) / width, one * (high - low) / height))
        ax.axis("off")
    said, place = "\n".join(openings), (0.0, 72 * below - 3)
    coordinates = ("data", "figure points")
    right.annotate(said, place, xycoords=coordinates, fontsize=8, ha="center", va="top", annotation_clip=False)
    _notes(left, notes, column, (below, below + room))


def _across(ax: Axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    """A dimension with its text in the middle."""
    ax.annotate("", start, end, arrowprops=DIMENSION | {"linewidth": 0.8})
    middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    level = start[1] == end[1]
    offset, turn = ((0, -3), 0) if level else ((-3, 0), 90)
    note = ax.annotate(text, middle, offset, textcoords="offset points", fontsize=8, rotation=turn, zorder=9)
    note.set(ha="center" if level else "right", va="top" if level else "center")
    if not level:
        note.set_bbox({"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 0.5})


def section(ax: Axes, case: Case, stop: str = "stop") -> None:
    """The wall and all that it meets and carries, its thickness, and the height of the stop, which has a name."""
    wall, height = case.wall, 2 * case.block.h
    bodies = Bodies.at_poses(case, np.zeros(1), np.zeros((1, 1, 3)))
    blocks(ax, bodies)(0)
    surroundings(ax, case, bodies)(0)
    for text in list(ax.texts):
        text.remove()  # the notes say it
    for artist in ax.get_children():
        artist.set_animated(False)
    half = case.block.b
    _across(ax, (-half, -0.02 * height), (half, -0.02 * height), f"{2 * half:g} m")
    if case.stop_top is not None and case.stop_top < height:
        at = -half - 0.12 * height
        _across(ax, (at, 0.0), (at, case.stop_top), f"{stop} {case.stop_top:g} m")
    ax.plot(wall.centroid_offset, wall.centroid_height, marker="+", color="0.15", markersize=7, zorder=7)


def _notes(ax: Axes, notes: Sequence[Note], column: float, ends: tuple[float, float]) -> None:
    """What each effect is, in a column whose left end and lower and upper end are given [inch], with a line to it."""
    figure = figure_of(ax)
    inch = figure.dpi_scale_trans.inverted()
    halves = [0.5 * LINE * (2 + text.count("\n")) for _, text in notes]
    wanted = [float(inch.transform(ax.transData.transform(place))[1]) for place, _ in notes]
    levels, low = [], ends[0]
    for half, level in zip(halves, wanted, strict=True):
        levels.append(max(level, low + half))
        low = levels[-1] + half
    high = ends[1]
    for (place, text), half, level in reversed(list(zip(notes, halves, levels, strict=True))):
        level = min(level, high - half)
        high = level - half
        at = (72 * column, 72 * level)
        ax.annotate(text, place, at, textcoords="figure points", fontsize=8, va="center", arrowprops=LEADER, zorder=8)


def _effects(case: Case, *, arguments: bool) -> list[Note]:
    """Where each effect acts in the section, and what it is."""
    face, said, made = -case.block.b, dict[Effect, str](), []
    _, breaking = case.limits_of_ties(np.linspace(0.0, case.overturning_rotation, POINTS))
    for name, effect in case.named.items():
        if not effect.mass_added:
            said[effect] = f"{said[effect]}, {name}" if effect in said else name
    for effect, name in [*said.items(), *((mass, "") for mass in case.wall.masses)]:
        if (told := effect.told) is None:
            continue
        note = f"{type(told).__name__}({told.arguments})" if arguments else f"{name or told.label}: {told.said}"
        if name in breaking and not arguments:
            moved = float(case.wall.pose(np.array([breaking[name]]))[0, 0])
            note += f"\nbreaks where the centroid has moved by {1e3 * moved:.0f} mm"
        place = (face if effect.on_face else effect.offset, effect.height)
        if len(corners := effect.outline):
            place = (float(corners[:, 0].mean()), float(corners[:, 1].mean()))
        made.append((place, note))
    if arguments and case.stop_top is not None:
        made.append(((face - 0.05, case.stop_top), "SideStop(top)"))
    return made


def elevation(ax: Axes, case: Case, ends: tuple[float, float]) -> None:
    """The wall from outside with its openings, between lower and upper ends [m]."""
    wall = case.block
    height, length = 2 * wall.h, wall.length
    side = 0.08 * length + 0.08 * height
    ax.add_patch(
        Rectangle((-0.5 * length - side, -height), length + 2 * side, height, facecolor=GROUND_COLOUR, zorder=0.5)
    )
    levels = np.array([0.0, wall.front.eaves, height])
    half_length = 0.5 * wall.front.long(levels)
    front = np.column_stack([np.append(-half_length, half_length[::-1]), np.append(levels, levels[::-1])])
    ax.add_patch(Polygon(front, facecolor=STONE, edgecolor="0.15"))
    for opening, middle in zip(wall.openings, wall.front.places, strict=True):
        hole: Patch = Rectangle((middle - 0.5 * opening.width, opening.sill), opening.width, opening.height)
        if opening.round:
            hole = Ellipse((middle, opening.sill + 0.5 * opening.height), opening.width, opening.height)
        hole.set(facecolor="white", edgecolor="0.35")
        ax.add_patch(hole)
    edge = -0.5 * length - 0.5 * side
    _across(ax, (edge, 0.0), (edge, height), f"{height:g} m")
    _across(ax, (-0.5 * length, -0.02 * height), (0.5 * length, -0.02 * height), f"{length:g} m")
    ax.plot([-0.5 * length - side, 0.5 * length + side], [0.0, 0.0], color="0.15", linewidth=1.0)
    ax.set(xlim=(-0.5 * length - side, 0.5 * length + side), ylim=ends, title="elevation")


def _sizes(case: Case) -> list[str]:
    """The size of each kind of opening, and how many there are."""
    made = []
    for opening, count in Counter(replace(opening, at=None) for opening in case.block.openings).items():
        number = f"{count} openings" if count > 1 else "opening"
        sill = f"sill at {opening.sill:.3g} m" if opening.sill else "from the ground"
        kind = "round " if opening.round else ""
        made.append(f"{kind}{number} {opening.width:.3g} x {opening.height:.3g} m, {sill}")
    return made
