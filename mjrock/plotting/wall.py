"""Pictures of a wall: its section with all that it meets and carries, its elevation, and both as a sketch."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, FancyArrowPatch, Patch, Polygon, Rectangle

from ..problem.masonry.case import require_wall
from ..problem.wall.case import Case
from ..problem.wall.effect import Anchored, Effect, Point
from ..problem.wall.effects import constant_forces_of
from ..quantities import require_flag, require_text
from ..result.bodies import BodyMotion
from .bodies import FORCE, GROUND_COLOUR, STONE, Bodies, Update, anchored, combined, draw_outlines, make_static
from .picture import anything, picture
from .style import BEHIND, WIDEST, Look, Picture, figure_of, plain_names, width_of, wrapped, write_title

ARROW = 0.16
"""Length of the arrow of a force, over the height of the wall [-]."""
Note = tuple[tuple[float, float], str]
"""A place in the section, x and z [m], and what is there."""
DIMENSION: Look = {"arrowstyle": "|-|,widthA=0.2,widthB=0.2", "color": "0.3", "shrinkA": 0, "shrinkB": 0}
LEADER: Look = {"arrowstyle": "-", "color": "0.6", "linewidth": 0.5, "relpos": (0.0, 0.5)}
TALLEST, LARGEST, LEAST = 3.4, 2.0, 1.7
"""Largest height of a drawing, largest width of the section, and least height of both in one scale [inch]."""
POINTS = 4001
"""Number of rotations at which forces of ties are computed, up to the overturning."""
LEADING, APART, EDGE, LINE = 0.2, 0.4, 0.15, 0.15
"""Room for leaders, between the drawings and at the edges, and height of a line [inch]."""
SMALL = 8.0
"""Size of notes [pt]."""


def surroundings(ax: Axes, case: Case, bodies: Bodies) -> Update:
    """Draw what a wall meets and carries. The limits of the axes are set for all frames."""
    wall, height = case.block, 2 * case.block.h
    ties, forces = list(case.links.values()), list(constant_forces_of(case.effects).values())
    low, high = bodies.extent()
    behind = max([0.2 * height, *(min(1.03 * tie.length, 0.5 * height) for tie in ties)])  # anchors that are far hide
    corners = np.vstack([np.zeros((1, 2)), *(added.outline for added in case.wall.masses)])
    behind = max(behind, 0.05 * height - wall.b - float(corners[:, 0].min()))
    reach = (2.6 * ARROW if any(force[0] for _, force in forces) else 0.08) * height
    left, right = min(-wall.b - behind, low[0] - 0.05 * height), max(high[0], wall.b) + reach
    ax.set_xlim(left, right)
    ax.set_ylim(min(-0.07 * height, low[1]), max(high[1], height) + (1.7 * ARROW if forces else 0.05) * height)
    ax.add_patch(
        Rectangle((left, -height), right - left, height, facecolor=GROUND_COLOUR, edgecolor="none", zorder=0.5)
    )
    ax.plot([left, right], [0, 0], color="0.15", linewidth=1.0, zorder=1)
    if case.stop_top is not None:
        face, back = case.rest_geometry.met_by_stop, -wall.b - 0.09 * height
        stop = Polygon(np.vstack([(back, 0.0), face, (back, case.stop_top)]))
        stop.set(facecolor=GROUND_COLOUR, edgecolor="0.4", hatch="////", linewidth=0.8, zorder=1)
        ax.add_patch(stop)
    toes = (1.0,) if case.one_sided else (1.0, -1.0)
    toe_x = [side * wall.half_base for side in toes]
    ax.plot(toe_x, [0.0] * len(toes), "o", markersize=5, color=FORCE, zorder=5)
    moving = bodies.moving
    updates = [_openings(ax, case, moving)]
    for tie, text in zip(ties, tie_texts(ties, left, height), strict=True):
        updates.append(anchored(ax, moving, tie, markersize=6))
        place = left + 0.02 * (right - left), tie.height + max(tie.rise, 0.0)
        look = {"fontsize": 8, "color": tie.colour, "va": "bottom", "zorder": 6}
        note = ax.annotate(text, place, (0, 3), textcoords="offset points", **look)  # type: ignore[arg-type]
        note.set_bbox(BEHIND)
    updates += [_force(ax, case, effect, force, moving) for effect, force in forces]
    updates += [_mass(ax, added, moving) for added in case.wall.masses if added.report_item is not None]
    if bodies.limits is not None:
        ax.set(xlim=bodies.limits[0], ylim=bodies.limits[1])
    return combined(updates)


def _openings(ax: Axes, case: Case, moving: BodyMotion) -> Update:
    """Sill and head of each opening as dashed lines through the thickness."""
    wall = case.block
    heights = sorted({z for opening in wall.openings for z in (opening.sill, opening.head) if z > 0})
    ends = zip(*wall.section.faces(np.array(heights)), heights, strict=True)
    places = [moving.placed(0, np.array([(inner, z), (outer, z)])) for inner, outer, z in ends]
    look: Look = {"color": "0.35", "linewidth": 0.9, "linestyle": "--", "zorder": 3, "animated": True}
    lines = [line for _ in heights for line in ax.plot([], [], **look)]

    def update(frame: int) -> None:
        for line, ends in zip(lines, places, strict=True):
            line.set_data(*ends[frame].T)

    return update


def tie_texts(ties: Sequence[Anchored], left: float, height: float) -> list[str]:
    """Text at each tie: how many are at one place, at the first of them, and how far behind a hidden anchor is, at the
    highest of those that are as long."""
    placed = [(round(tie.height / (0.03 * height)), tie.length, tie.rise) for tie in ties]
    texts = []
    for i, (tie, place) in enumerate(zip(ties, placed, strict=True)):
        number = f"{placed.count(place)} x " if placed.count(place) > 1 else ""
        highest = place[0] == max(other[0] for other in placed if other[1:] == place[1:])
        where = f"anchor {tie.length:g} m behind" if tie.length > -left and highest else number and "tie"
        texts.append("" if place in placed[:i] else f"{number}{where}")
    return texts


def _force(ax: Axes, case: Case, effect: Effect, force: Point, moving: BodyMotion) -> Update:
    """A force downwards as an arrow onto its point, any other as one from its point along the force."""
    length, loads = 2 * ARROW * case.block.h, force[0] == 0
    places = moving.placed(0, np.array([[effect.offset, effect.height]]))[:, 0]
    along = np.array([0.0, -length]) if loads else np.array([np.sign(force[0]) * length, 0.0])
    arrow = FancyArrowPatch((0, 0), (1, 0), arrowstyle="-|>", mutation_scale=12, color=FORCE, linewidth=1.6, zorder=6)
    arrow.set_animated(True)
    ax.add_patch(arrow)
    outwards = along[0] >= 0
    look: Look = {"fontsize": 8, "color": FORCE, "zorder": 6, "animated": True}
    look |= {"ha": "center", "va": "bottom"} if loads else {"ha": "left" if outwards else "right", "va": "center"}
    shift = (0, 2) if loads else (2 if outwards else -2, 0)
    text = ax.annotate(f"{(force[0] - force[2]) / 1e3:g} kN", (0, 0), shift, textcoords="offset points", **look)

    def update(frame: int) -> None:
        place = places[frame]
        tail, tip = (place - along, place) if loads else (place, place + along)
        arrow.set_positions(tuple(tail), tuple(tip))
        text.xy = tuple(tail if loads else tip)

    return update


def _mass(ax: Axes, added: Effect, moving: BodyMotion) -> Update:
    """An added mass: its outline, or a dot with its size where it is at a point."""
    if len(added.outline):
        corners = moving.placed(0, added.outline)
        shape = Polygon(added.outline, facecolor=STONE, edgecolor="0.15", linestyle="--", zorder=1.8, animated=True)
        ax.add_patch(shape)
        return lambda frame: shape.set_xy(corners[frame])
    places = moving.placed(0, np.array([[added.offset, added.height]]))
    (dot,) = ax.plot([], [], marker="o", markersize=8, color="0.25", zorder=5, animated=True)
    text = ax.text(0, 0, f"  {added.mass_added:g} kg", fontsize=8, color="0.25", va="center", zorder=6, animated=True)

    def update(frame: int) -> None:
        dot.set_data(*places[frame].T)
        text.set_position(tuple(places[frame, 0]))

    return update


@picture(case=anything)
def sketch(case: Case, title: str = "", *, arguments: bool = False) -> Figure:
    """Section and elevation of a wall at rest with dimensions [m], true to scale, and its effects.

    The note on a tie that breaks before the wall overturns gives how far the centroid has then moved outwards, by a
    rotation about the toe. Openings of one sill are drawn at equal distances: their places along the wall do not
    matter. Section and elevation have one scale. The elevation of a wall so long that it would leave no room for the
    section has a smaller one, which its title gives.

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
    note_width = LEADING + max(width_of(figure, text, SMALL) for _, text in notes) if notes else 0.0
    scale = min(TALLEST / tall, LARGEST / wide)  # [inch/m]
    common = (WIDEST - 3 * EDGE - APART - note_width) / (wide + long)
    if common * tall >= LEAST:
        scale = min(scale, common)
    column = EDGE + scale * wide + EDGE
    text_start = column + APART + EDGE + note_width
    sizes = wrapped("\n".join(openings), max(1.5, WIDEST - text_start), SMALL)
    elevation_scale = min(scale, max(1.0, WIDEST - text_start) / long)
    smaller = f", {scale / elevation_scale:.2g} times smaller" if elevation_scale < 0.999 * scale else ""
    right.set_title(f"elevation{smaller}", fontsize=9)
    text_width = max(elevation_scale * long, width_of(figure, sizes, SMALL))
    width = max(5.0, text_start + text_width)
    lines = len(sizes.splitlines())
    room_below = EDGE + LINE * lines + 0.5 * LINE * bool(lines)
    drawing_height = max(scale * tall, LINE * sum(2 + text.count("\n") for _, text in notes))
    title_pad = 72 * (drawing_height - scale * tall)
    left.set_title("section; outwards is to the right", fontsize=9, loc="left", pad=6 + title_pad)
    figure.set_size_inches(width, 1.0)
    height = room_below + drawing_height + 0.3 + write_title(figure, title)
    figure.set_size_inches(width, height)
    text_middle = width - EDGE - 0.5 * text_width
    elevation_start = text_middle - 0.5 * elevation_scale * long
    for ax, own_scale, start in ((left, scale, EDGE), (right, elevation_scale, elevation_start)):
        (x0, x1), (low, high) = ax.get_xlim(), ax.get_ylim()
        bottom = room_below + (own_scale - scale) * low
        size = own_scale * (x1 - x0) / width, own_scale * (high - low) / height
        ax.set_position((start / width, bottom / height, *size))
        ax.axis("off")
    place, coordinates = (72 * text_middle, 72 * (EDGE + LINE * lines)), "figure points"
    right.annotate(sizes, place, xycoords=coordinates, fontsize=SMALL, ha="center", va="top", annotation_clip=False)
    _notes(left, notes, column, (room_below, room_below + drawing_height))


def _dimension(ax: Axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    """A dimension with its text in the middle."""
    ax.annotate("", start, end, arrowprops=DIMENSION | {"linewidth": 0.8})
    middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    level = start[1] == end[1]
    offset, rotation = ((0, -3), 0) if level else ((-3, 0), 90)
    note = ax.annotate(text, middle, offset, textcoords="offset points", fontsize=8, rotation=rotation, zorder=9)
    note.set(ha="center" if level else "right", va="top" if level else "center")
    if not level:
        note.set_bbox(BEHIND)


def section(ax: Axes, case: Case, stop: str = "stop") -> None:
    """The wall and all that it meets and carries, its thickness, and the height of the stop, which has a name."""
    wall, height, others = case.wall, 2 * case.block.h, ax.get_children()
    bodies = Bodies.of_moving(BodyMotion(case, np.zeros(1), np.zeros((1, 1, 3))))
    draw_outlines(ax, bodies)(0)
    surroundings(ax, case, bodies)(0)
    for text in list(ax.texts):
        text.remove()  # it is in the notes
    make_static(ax, others)
    half = case.block.b
    _dimension(ax, (-half, -0.02 * height), (half, -0.02 * height), f"{2 * half:g} m")
    if case.stop_top is not None and case.stop_top < height:
        x = -half - 0.12 * height
        _dimension(ax, (x, 0.0), (x, case.stop_top), f"{stop} {case.stop_top:g} m")
    ax.plot(wall.centroid_offset, wall.centroid_height, marker="+", color="0.15", markersize=7, zorder=7)


def _notes(ax: Axes, notes: Sequence[Note], column: float, ends: tuple[float, float]) -> None:
    """Write notes on effects, each with a line to it, in a column whose left, lower and upper ends are given [inch]."""
    figure = figure_of(ax)
    inch = figure.dpi_scale_trans.inverted()
    halves = [0.5 * LINE * (2 + text.count("\n")) for _, text in notes]
    heights = [float(inch.transform(ax.transData.transform(place))[1]) for place, _ in notes]
    levels, low = [], ends[0]
    for half, level in zip(halves, heights, strict=True):
        levels.append(max(level, low + half))
        low = levels[-1] + half
    high = ends[1]
    for (place, text), half, level in reversed(list(zip(notes, halves, levels, strict=True))):
        level = min(level, high - half)
        high = level - half
        at = (72 * column, 72 * level)
        ax.annotate(text, place, at, textcoords="figure points", fontsize=8, va="center", arrowprops=LEADER, zorder=8)


def _effects(case: Case, *, arguments: bool) -> list[Note]:
    """The place of each effect in the section, and a note on it."""
    named, notes, plain = dict[Effect, list[str]](), [], plain_names(case.named)
    _, breaking = case.limits_of_ties(np.linspace(0.0, case.overturning_rotation, POINTS))
    for name, effect in case.named.items():
        if not effect.mass_added:
            named.setdefault(effect, []).append(name)
    for effect, names in [*named.items(), *((mass, []) for mass in case.wall.masses)]:
        if (item := effect.report_item) is None:
            continue
        label = ", ".join(plain[name] for name in names) or item.label
        note = f"{type(item).__name__}({item.arguments})" if arguments else f"{label}: {item.description}"
        if breaks := [breaking[name] for name in names if name in breaking and not arguments]:
            displacement = float(case.wall.pose(np.array([min(breaks)]))[0, 0])
            note += f"\nbreaks where the centroid has moved by {1e3 * displacement:.0f} mm"
        place = (case.block.inner_face(effect.height) if effect.on_face else effect.offset, effect.height)
        if len(corners := effect.outline):
            place = (float(corners[:, 0].mean()), float(corners[:, 1].mean()))
        notes.append((place, note))
    if arguments and case.stop_top is not None:
        notes.append(((case.block.inner_face(case.stop_top) - 0.05, case.stop_top), "SideStop(top)"))
    return notes


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
    _dimension(ax, (edge, 0.0), (edge, height), f"{height:g} m")
    _dimension(ax, (-0.5 * length, -0.02 * height), (0.5 * length, -0.02 * height), f"{length:g} m")
    ax.plot([-0.5 * length - side, 0.5 * length + side], [0.0, 0.0], color="0.15", linewidth=1.0)
    ax.set(xlim=(-0.5 * length - side, 0.5 * length + side), ylim=ends, title="elevation")


def _sizes(case: Case) -> list[str]:
    """The size of each kind of opening, and how many there are."""
    lines = []
    for opening, count in Counter(replace(opening, at=None) for opening in case.block.openings).items():
        number = f"{count} openings" if count > 1 else "opening"
        sill = f"sill at {opening.sill:.3g} m" if opening.sill else "from the ground"
        shape = "round " if opening.round else ""
        lines.append(f"{shape}{number} {opening.width:.3g} x {opening.height:.3g} m, {sill}")
    return lines
