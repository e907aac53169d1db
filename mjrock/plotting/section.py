"""The section of a wall with base, side stop, toes, ties, openings, loads, thrusts and masses."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import FancyArrowPatch, Polygon, Rectangle

from ..problem.masonry.case import MasonryCase
from ..problem.wall.case import Case
from ..problem.wall.effect import Anchored, Effect, Point
from ..problem.wall.effects import constant_forces_of
from ..quantities import Array, Flags
from ..result.bodies import Moving
from ..result.ties import elongation_of
from ..scene.tints import FIXED_COLOUR, TINTS
from .bodies import Bodies
from .style import Look

STONE, GROUND_COLOUR, STEEL, FORCE = TINTS[0], FIXED_COLOUR, "#12406b", "#a8201a"
"""Colours of a wall, of what does not move, of ties, and of forces."""
ARROW = 0.16
"""Length of the arrow of a force, over the height of the wall [-]."""

Update = Callable[[int], None]
"""Moves what is drawn to a frame."""


def together(updates: Sequence[Update]) -> Update:
    """One update that makes several."""

    def update(frame: int) -> None:
        for move in updates:
            move(frame)

    return update


def blocks(ax: Axes, bodies: Bodies, *, animated: bool = True) -> Update:
    """Draw the outlines of bodies true to scale."""
    moving, supports = bodies.moving, list[tuple[Polygon, Array]]()
    for number, outline in moving.case.fixed.items():
        patch = Polygon(outline, facecolor=GROUND_COLOUR, edgecolor="0.4", linewidth=0.8)
        if moving.case.support_of(number) is not None:
            supports.append((patch, moving.placed(number, outline)))
            patch.set_animated(animated)
        ax.add_patch(patch)
    width = min(1.2, 12 / np.sqrt(max(1, len(bodies.outlines))))  # lines of many blocks would hide them
    drawn = PolyCollection([], facecolors=bodies.colours, edgecolor="0.15", linewidth=width, zorder=2)
    drawn.set_animated(animated)
    ax.add_collection(drawn, autolim=False)
    ax.set(aspect="equal", xlabel="$x$ [m]", ylabel="$z$ [m]")

    def update(frame: int) -> None:
        for patch, places in supports:
            patch.set_xy(places[frame])
        drawn.set_verts(bodies.corners(frame))  # type: ignore[arg-type]  # one array is drawn the fastest

    return update


def frame_view(ax: Axes, bodies: Bodies) -> None:
    """Set limits that every frame fits into, with a margin."""
    low, high = bodies.extent()
    margin = 0.06 * float((high - low).max())
    ax.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))


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
        stop = Rectangle((-wall.b - 0.09 * height, 0), 0.09 * height, case.stop_top)
        stop.set(facecolor=GROUND_COLOUR, edgecolor="0.4", hatch="////", linewidth=0.8, zorder=1)
        ax.add_patch(stop)
    toes = (1.0,) if case.one_sided else (1.0, -1.0)
    toe_x = [side * wall.half_base for side in toes]
    ax.plot(toe_x, [0.0] * len(toes), "o", markersize=5, color=FORCE, zorder=5)
    updates, moving = [_openings(ax, case, bodies)], bodies.moving
    for tie, text in zip(ties, tie_texts(ties, left, height), strict=True):
        updates.append(_tie(ax, moving, tie, markersize=6))
        at = left + 0.02 * (right - left), tie.height + max(tie.rise, 0.0)
        look = {"fontsize": 8, "color": tie.colour, "va": "bottom", "zorder": 6}
        note = ax.annotate(text, at, (0, 3), textcoords="offset points", **look)  # type: ignore[arg-type]
        note.set_bbox({"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 0.3})
    updates += [_force(ax, case, effect, force, bodies) for effect, force in forces]
    updates += [_mass(ax, case, added, bodies) for added in case.wall.masses if added.told is not None]
    return together(updates)


def ties_of_masonry(ax: Axes, case: MasonryCase, bodies: Bodies) -> Update:
    """Links of blocks, each from its block to an anchor. An anchor that is far lies at the edge of the picture."""
    low, high = bodies.extent()
    ties, updates, moving = case.links, [], bodies.moving
    edge = float(low[0]) - 0.25 * float(high[1] - low[1])
    for name, tie in ties.items():
        updates.append(_tie(ax, moving, tie, markersize=5, edge=edge))
        place = edge, case.held_by(tie)[1] + tie.rise
        ax.annotate(name, place, (4, 4), textcoords="offset points", fontsize=8, color=tie.colour)
    if ties:
        ax.set_xlim(left=edge - 0.03 * float(high[1] - low[1]))
    return together(updates)


def _tie(ax: Axes, moving: Moving, tie: Anchored, *, markersize: float, edge: float = -np.inf) -> Update:
    """A link from the point that it holds to its anchor: solid where it pulls, dotted where it is slack, gone once it
    broke. An anchor beyond an x [m] is drawn there."""
    held, number = moving.case.held_by(tie), tie.anchor_block
    anchor = tie.anchor_of(held)
    if number is None and anchor[0] < edge:
        anchor = held + (anchor - held) * (held[0] - edge) / tie.length
    pulls, broken = pulling(moving, tie)
    points, ends = moving.placed(tie.block, held[None])[:, 0], moving.placed(number, anchor[None])[:, 0]
    (line,) = ax.plot([], [], color=tie.colour, linewidth=1.8, zorder=4, animated=True)
    (mark,) = ax.plot(
        *anchor[:, None], marker="s", markersize=markersize, color=tie.colour, zorder=4, animated=number is not None
    )

    def update(frame: int) -> None:
        mark.set_data(ends[frame][:, None])
        line.set_data(*np.transpose([ends[frame], points[frame]]))
        line.set_linestyle(tie.dashes if pulls[frame] else ":")
        line.set_visible(not broken[frame])

    return update


def pulling(moving: Moving, tie: Anchored) -> tuple[Flags, Flags]:
    """Whether a link acts at each frame, and whether it has broken.

    A tie acts where it is longer than when it was slack or last yielded, and what also pushes acts always.
    """
    law = tie.law
    if not law.holds:
        return np.ones(len(moving.t), dtype=bool), np.zeros(len(moving.t), dtype=bool)
    elongation = elongation_of(moving, tie)
    yielded = law.drawn(elongation)
    broken: Flags = yielded > law.ultimate
    return (elongation > yielded) & ~broken, broken


def _local(case: Case, x: float, z: float) -> Array:
    """A point given from the middle of the base, about the centroid [m], shape (1, 2)."""
    return np.array([[x - case.wall.centroid_offset, z - case.wall.centroid_height]])


def _openings(ax: Axes, case: Case, bodies: Bodies) -> Update:
    """Sill and head of each opening as dashed lines through the thickness."""
    wall = case.block
    profile = wall.profile or ((0.0, 2 * wall.b), (2 * wall.h, 2 * wall.b))
    heights = sorted({z for opening in wall.openings for z in (opening.sill, opening.head) if z > 0})
    segments, lines = [], []
    for z in heights:
        outer = float(np.interp(z, *np.transpose(profile))) - wall.b
        segments.append(np.concatenate([_local(case, -wall.b, z), _local(case, outer, z)]))
        lines += ax.plot([], [], color="0.35", linewidth=0.9, linestyle="--", zorder=3, animated=True)

    def update(frame: int) -> None:
        for line, ends in zip(lines, segments, strict=True):
            line.set_data(*bodies.placed(frame, 0, ends).T)

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


def _force(ax: Axes, case: Case, effect: Effect, force: Point, bodies: Bodies) -> Update:
    """A force downwards as an arrow onto its point, any other as one from its point along the force."""
    length, loads = 2 * ARROW * case.block.h, force[0] == 0
    point = _local(case, effect.offset, effect.height)
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
        at = bodies.placed(frame, 0, point)[0]
        tail, tip = (at - along, at) if loads else (at, at + along)
        arrow.set_positions(tuple(tail), tuple(tip))
        text.xy = tuple(tail if loads else tip)

    return update


def _mass(ax: Axes, case: Case, added: Effect, bodies: Bodies) -> Update:
    """An added mass: its outline, or a dot with its size where it is at a point."""
    if len(corners := added.outline):
        outline = np.vstack([_local(case, x, z) for x, z in corners])
        shape = Polygon(outline, facecolor=STONE, edgecolor="0.15", linestyle="--", zorder=1.8, animated=True)
        ax.add_patch(shape)
        return lambda frame: shape.set_xy(bodies.placed(frame, 0, outline))
    point = _local(case, added.offset, added.height)
    (dot,) = ax.plot([], [], marker="o", markersize=8, color="0.25", zorder=5, animated=True)
    text = ax.text(0, 0, f"  {added.mass_added:g} kg", fontsize=8, color="0.25", va="center", zorder=6, animated=True)

    def update(frame: int) -> None:
        at = bodies.placed(frame, 0, point)[0]
        dot.set_data([at[0]], [at[1]])
        text.set_position(tuple(at))

    return update
