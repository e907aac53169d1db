"""Pictures of masonry: where a motion has brought its blocks, the line of thrust, and a mechanism of collapse."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, Polygon
from numpy.typing import ArrayLike

from ..geometry.frames import PLANE, SPACE
from ..geometry.poses import at_rest
from ..problem.masonry.blocks.joints import Joint
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.effects import place_in_world
from ..problem.masonry.fill import Axle
from ..problem.masonry.limit.collapse import Collapse, JointForces
from ..problem.masonry.limit.pose import pose_of_all
from ..problem.masonry.masonry import Masonry
from ..problem.wall.effect import Effect
from ..quantities import Array, require_flag, require_kind, require_within
from ..result.bodies import BodyMotion
from ..result.motion import sample_at
from ..result.response import Response
from .bodies import FORCE, Bodies, combined, draw_outlines, make_static, named_line, required_limits
from .forces import forces_on, require_shown
from .picture import anything, picture
from .solids import Solids, draw_solids, fill_view
from .style import BEHIND, Look
from .wall import surroundings

MORTAR = "#12406b"


@picture(limits=anything, joints=require_flag)
def blocks(
    ax: Axes,
    masonry: Masonry | Response,
    pose: ArrayLike | None = None,
    *,
    at: float | None = None,
    forces: str | None = None,
    magnified: float = 1.0,
    joints: bool = True,
    camera: Sequence[float] | None = None,
    limits: ArrayLike | None = None,
) -> Axes:
    """The blocks of masonry to scale, fixed ones in grey, where they rest or at a pose.

    Blocks in space need an `ax` of three dimensions, `figure.add_subplot(projection="3d")`. They fill it, with a scale
    bar in place of axes.

    Args:
        ax: where to draw.
        masonry: the masonry, or a response of it, which is drawn as it was at a time.
        pose: x, z and theta of each block that is not fixed [m, m, rad], shape (bodies, 3), in space (bodies, 7), such
            as `answer.pose[-1]`, or of all blocks, as `answer.at(t)`; None draws masonry at rest.
        at: time of the response that is drawn [s]; None is the end.
        forces: "thrust" draws the line of thrust over the blocks, see `thrust`, and "bars" a bar at each joint along
            its force, as long as that is large, through the place where it acts. "cracks" draws joints that
            have lost bond, as wide as they are open. All need a response with forces=True, cracks joints with a bond.
        magnified: factor on the displacements, to show a small motion, 0 to 1e6.
        joints: whether to draw the joints as lines, in the plane and where no pose is given.
        camera: in space, the elevation and the azimuth that the blocks are seen from [deg], -90 to 90 and -360 to 360;
            None is (18, 35), from outside.
        limits: lowest and highest coordinate that the picture shows along each axis [m], shape (2, 2), in space (3, 2);
            None shows the blocks, but for what has gone farther than two extents of the masonry, in space than one.

    Raises:
        AttributeError: for forces of a run that has kept none.
        ValueError: for cracks of dry joints, a pose of another shape, a value outside its range, or axes of two
            dimensions for blocks in space.
    """
    magnified, others = require_within("magnified", magnified, 0.0, 1e6), ax.get_children()
    if isinstance(masonry, Response) and masonry.joints is None:
        raise ValueError("blocks takes masonry or a response of it, and this response is one of a wall")
    if isinstance(masonry, Response) and pose is None:
        if forces is not None:
            require_shown("forces", forces, masonry)
        moving = replace(masonry.moving.at([sample_at(masonry.t, at)]), magnify=magnified)
    elif at is not None or forces is not None:
        raise ValueError("at and forces are for a response; give one in place of masonry, and no pose")
    else:
        moving = _motion_at_pose(masonry, pose, magnified)
    case = cast(MasonryCase, moving.case)
    if case.in_space:
        bodies = Solids(moving, camera, required_limits(limits, "xyz"))
        draw_solids(ax, bodies, ax.bbox)(0)
        fill_view(ax, bodies, ax.bbox)
    else:
        flat_bodies = Bodies.of_moving(moving, limits)
        draw_outlines(ax, flat_bodies)(0)
        if joints and pose is None and not isinstance(masonry, Response):
            _joints(ax, case.masonry.plane_joints)
        _view(ax, flat_bodies)
    if isinstance(masonry, Response) and forces is not None:
        forces_on(ax, masonry, moving, forces)(0)
    make_static(ax, others)
    return ax


def _motion_at_pose(masonry: Masonry | Response, pose: ArrayLike | None, magnified: float) -> BodyMotion:
    """Masonry, or that of a response with its supports as they are drawn, at a pose; at rest without one."""
    case = replace(masonry.of_masonry, supports=()) if isinstance(masonry, Response) else MasonryCase(masonry, 1.0)
    freedom = SPACE if case.in_space else PLANE
    poses = at_rest(len(case.bodies), freedom).reshape(-1, freedom.nq)
    return BodyMotion(case, np.zeros(1), (poses if pose is None else _free_pose(case.masonry, pose))[None], magnified)


def _free_pose(masonry: Masonry, pose: ArrayLike) -> Array:
    """The pose of the free blocks, from one of them or of all blocks.

    Raises:
        ValueError: as `pose_of_all`, and for fixed blocks that have moved.
    """
    poses, free = pose_of_all(masonry, pose), list(masonry.free)
    if (np.delete(poses, free, axis=0)[:, : 3 if masonry.in_space else None] != 0).any():
        raise ValueError("pose has fixed blocks that have moved; give the response whose supports move them")
    return poses[free]


def _joints(ax: Axes, joints: Sequence[Joint]) -> None:
    """Joints as lines."""
    width = min(1.4, 14 / np.sqrt(len(joints) + 1))  # lines of many joints would hide the blocks
    for joint in joints:
        ax.plot(*np.transpose([joint.start, joint.end]), color=MORTAR, linewidth=width, solid_capstyle="butt")


def _view(ax: Axes, bodies: Bodies) -> None:
    """Limits and labels, and how many blocks lie outside the picture."""
    low, high = bodies.extent()
    sides = high - low
    if bodies.limits is None:
        room = 0.05 * sides.max() + np.maximum(0.0, 0.5 * (0.3 * sides.max() - sides))  # labels need some width
        low, high = low - room, high + room
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    ax.locator_params(axis="both", nbins="auto" if sides.max() < 2 * sides.min() else 4)
    corners = bodies.corners(0)
    outside = ((corners.max(axis=1) < low) | (corners.min(axis=1) > high)).any(axis=1).sum()
    if outside:
        note = f"{outside} of {len(corners)} blocks lie outside"
        ax.annotate(note, (0.02, 0.03), xycoords="axes fraction", fontsize=8, va="bottom", bbox=BEHIND)


@picture(limits=anything)
def thrust(
    ax: Axes, response: Response, at: float | None = None, *, magnified: float = 1.0, limits: ArrayLike | None = None
) -> Axes:
    """The line of thrust through blocks, or through a wall, at a time, as wide as the force is large.

    It passes through each joint of the drawing where the resultant of its forces does. In a block it goes straight from
    joint to joint, and where more than two press, by way of the mean of their places in proportion to their forces. It
    begins in the centroid of a block that presses on one joint alone. In a line that leaves the blocks joints are open.

    Args:
        ax: where to draw, of three dimensions for blocks in space.
        response: a run with forces=True.
        at: time [s]; None is the end of the run.
        magnified: factor on the displacements, 0.01 to 10000.
        limits: lowest and highest coordinate that the picture shows along each axis [m], as those of `blocks`.

    Raises:
        AttributeError: if the run has kept no forces.
        ValueError: for a time outside the run, or a value outside its range.
    """
    require_kind("response", response, Response)
    if response.joints is not None:
        return blocks(ax, response, at=at, forces="thrust", magnified=magnified, limits=limits)
    require_shown("forces", "thrust", response)
    sample, others = sample_at(response.t, at), ax.get_children()
    bodies = Bodies.of(response, magnified, limits).at(response.t[sample : sample + 1])
    updates = [draw_outlines(ax, bodies), surroundings(ax, response.of_wall[0], bodies)]
    updates.append(forces_on(ax, response, bodies.moving, "thrust"))
    combined(updates)(0)
    make_static(ax, others)
    return ax


THICK = 3.0
"""Width of the line of the largest force [points]."""


@picture()
def mechanism(ax: Axes, collapse: Collapse, *, share: float = 0.1, forces: bool = True) -> Axes:
    """Masonry that has moved a little in its mechanism of collapse, and where joints press as it begins to move.

    In the plane loads are drawn where they act at rest: the fill, and those that grow as heavy arrows with their size.
    Each force is a line through the point of its joint where it acts, along the force and as long as half the joint.
    Its width grows with the force. Lines that follow one another are the path of the thrust. They move with the block
    below their joint, so that they pass through the hinges. They are drawn in the plane alone.

    Args:
        ax: where to draw; of three dimensions for blocks in space.
        collapse: what `collapse_multiplier` has returned, of a finite multiplier.
        share: largest displacement of a centroid that is drawn, over the extent of the masonry, 0 to 1.
        forces: whether to draw the forces.

    Raises:
        ValueError: for a multiplier that is infinite, or a share out of its range.
    """
    require_kind("collapse", collapse, Collapse)
    share, forces = require_within("share", share, 0.0, 1.0), require_flag("forces", forces)
    masonry = collapse.masonry
    if masonry is None or collapse.forces is None:
        raise ValueError(f"multiplier = {collapse.multiplier:g}: nothing gives way, and there is no mechanism to draw")
    parts = 3 if masonry.in_space else 2
    extent = np.ptp(np.concatenate([masonry.blocks[i].corners for i in masonry.free]), axis=0).max()
    largest = np.linalg.norm(collapse.motion[:, :parts], axis=1).max()
    pose = share * extent / largest * collapse.motion
    if masonry.in_space:
        half = 0.5 * pose[:, 3:]
        pose = np.column_stack([pose[:, :3], np.ones(len(pose)), half])
        pose[:, 3:] /= np.linalg.norm(pose[:, 3:], axis=1)[:, None]
    blocks(ax, masonry, pose)
    if not masonry.in_space:
        draw_loads(ax, masonry, collapse.effects, collapse.loads)
    if forces and not masonry.in_space:
        case = MasonryCase(masonry, 1.0)
        _draw_joint_forces(ax, BodyMotion(case, np.zeros(1), pose[None]), masonry, collapse.forces)
    return ax


def _draw_joint_forces(ax: Axes, moving: BodyMotion, masonry: Masonry, forces: JointForces) -> None:
    """A line for each force of a joint, where the joint has moved."""
    normal, eccentricity = forces.normal, forces.eccentricity
    pressing = np.stack([normal, forces.shear], axis=1)
    size = np.linalg.norm(pressing, axis=1)
    middles, axes = (arrays[0] for arrays in moving.joints(moving.case.rest_geometry.frames))
    widths = [joint.width for joint in masonry.plane_joints]
    named_line(ax, f"{size.max() / 1e3:.3g} kN", FORCE, THICK)
    for i in np.flatnonzero(normal > 1e-3 * size.max()):
        direction = pressing[i] @ axes[i] / size[i]
        ends = middles[i] + eccentricity[i] * axes[i, 1] + 0.25 * widths[i] * np.outer([-1, 1], direction)
        ax.plot(*ends.T, color=FORCE, linewidth=max(0.4, THICK * size[i] / size.max()), solid_capstyle="round")


EARTH, LADEN, LOAD = "#e3d5b8", "#c9a86a", "0.15"
"""Colours of a fill, of the part of it through which a load goes down, and of loads."""
ARROW, SMALLEST, NAMED, NAME_ROOM = 0.16, 0.6, 6, 0.08
"""Length of the arrow of the largest load over the extent of the masonry [-], that of a small one over it [-], the most
constant loads whose size is written, and the room for it over the extent [-]."""


def draw_loads(
    ax: Axes,
    masonry: Masonry,
    effects: Sequence[Effect],
    loads: Mapping[str, tuple[float, ...]] | Sequence[Effect] = (),
) -> None:
    """Draw the fill and the loads on masonry in the plane at rest, those that grow with heavy arrows."""
    growing = () if isinstance(loads, Mapping) else tuple(loads)
    for effect in (*effects, *growing):
        if len(corners := effect.outline):
            colour, zorder = (LADEN, 0.3) if effect in growing else (EARTH, 0.2)
            ax.add_patch(Polygon(corners, facecolor=colour, edgecolor=colour, linewidth=0.6, zorder=zorder))
    constant = [arrow for effect in effects if (arrow := _force_of(masonry, effect)) is not None]
    growing_forces = [arrow for effect in growing if (arrow := _force_of(masonry, effect)) is not None]
    growing_forces += (
        [_line_of_action(masonry, name, load) for name, load in loads.items()] if isinstance(loads, Mapping) else []
    )
    size = float(np.ptp(np.concatenate([masonry.blocks[i].corners for i in masonry.free]), axis=0).max())
    outlines = [effect.outline for effect in (*effects, *growing) if len(effect.outline)]
    for arrows, width, with_names in ((constant, 1.0, len(constant) <= NAMED), (growing_forces, 2.0, True)):
        largest = max((float(np.hypot(*force)) for _, force in arrows), default=0.0)
        for place, force in arrows:
            length = max(float(np.hypot(*force)) / largest, SMALLEST) * ARROW * size
            outlines.append(_arrow(ax, place, force, length, width, with_names))
    if outlines:
        (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
        lowest, highest = (end(np.concatenate(outlines), axis=0) for end in (np.min, np.max))
        room = NAME_ROOM * size
        ax.set_xlim(min(left, lowest[0] - room), max(right, highest[0] + room))
        ax.set_ylim(min(low, lowest[1] - room), max(high, highest[1] + room))


def _force_of(masonry: Masonry, effect: Effect) -> tuple[Array, Array] | None:
    """Where an effect pushes [m] and its force [N], that of an axle on the ground; None where no arrow is drawn."""
    item = effect.report_item
    if isinstance(item, Axle):
        return np.array([item.at, item.top]), np.array([0.0, -item.force])
    if len(effect.outline) or effect.force_vector is None:
        return None
    return np.array(place_in_world(masonry, effect)), np.array(effect.force_vector)[[0, 2]]


def _line_of_action(masonry: Masonry, name: str, load: Sequence[float]) -> tuple[Array, Array]:
    """Where the line of a force passes the centroid of its block [m], from its moment about that, and the force [N]."""
    force, moment = np.array(load[:2]), load[2] if len(load) == 3 else 0.0
    aside = np.array([-force[1], force[0]]) * moment / max(float(force @ force), 1e-300)
    return masonry.centroids[masonry.names.index(name)] + aside, force


def _arrow(ax: Axes, place: Array, force: Array, length: float, width: float, with_name: bool) -> Array:
    """An arrow of a length [m]: onto its point where it presses downwards, otherwise from its point along the force.
    Its ends [m], shape (2, 2)."""
    along = force / max(float(np.hypot(*force)), 1e-300) * length
    tail, tip = (place - along, place) if force[1] < 0 else (place, place + along)
    look: Look = {"arrowstyle": "-|>", "mutation_scale": 6 + 4 * width, "color": LOAD, "linewidth": width, "zorder": 8}
    ax.add_patch(FancyArrowPatch(tuple(tail), tuple(tip), shrinkA=0, shrinkB=0, **look))
    if with_name:
        downwards = force[1] < 0
        label_look: Look = {"ha": "left" if along[0] > 0 else "right", "va": "center"}
        label_look |= {"ha": "center", "va": "bottom"} if downwards else {}
        label, end = f"{np.hypot(*force) / 1e3:.3g} kN", tail if downwards else tip
        offset = (0, 2) if downwards else (3 * np.sign(along[0]), 0)
        label_look |= {"textcoords": "offset points", "fontsize": 8, "color": LOAD, "zorder": 8, "bbox": BEHIND}
        ax.annotate(label, tuple(end), offset, **label_look)
    return np.array([tail, tip])
