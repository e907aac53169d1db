"""Looking at blocks and lines: where and how fast blocks are, which joints hold no longer, and what springs hold."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..geometry.vectors import components, dot, minus, plus, put, spin_components, vector
from ..problem.masonry.joint_law import stored
from ..quantities import Array, Integers
from .contact import meeting
from .handover import Blocks
from .rows import Rows
from .solids import Poses
from .system import System
from .turning import rotation_change, take_inverse_inertia, take_turn

AXES = np.eye(3)
"""Unit vectors."""


class Motion(NamedTuple):
    """Where all blocks are, and how fast.

    Args:
        poses: where they are.
        velocity: of their centroids [m/s], shape (blocks, d).
        about: the largest velocity of a corner about the centroid of its block [m/s], shape (blocks,).
    """

    poses: Poses
    velocity: Array
    about: Array


@compiled
def take_motion(system: System, blocks: Blocks, motion: Motion) -> None:
    """Write where the blocks are that move, and how fast, and take the inertia of the bodies there."""
    write_motion(system, blocks, motion, system.axes)


@inlined
def write_motion(system: System, blocks: Blocks, motion: Motion, axes: tuple[int, ...]) -> None:
    """`take_motion`, in the plane or in space."""
    poses, supports = motion.poses, system.supports
    for b in range(len(blocks.free)):
        body, block = system.bodies[b], blocks.free[b]
        take_turn(body, axes)
        take_inverse_inertia(body, axes)
        for i in range(len(axes)):
            put(poses.change[block][:, i], rotation_change(body, vector(AXES, i, axes)))
        spin = spin_components(body.spin, axes)
        put(poses.moved[block], components(body.place, axes))
        put(motion.velocity[block], components(body.velocity, axes))
        motion.about[block] = math.sqrt(dot(spin, spin)) * blocks.sizes[block]
    for block in range(len(blocks.support)):
        if blocks.support[block] >= 0:
            put(poses.moved[block], vector(supports.moved, blocks.support[block], axes))
            put(motion.velocity[block], vector(supports.moving, blocks.support[block], axes))


class Wear(NamedTuple):
    """How far joints have worn, and bodies have moved from where they stood.

    Args:
        pairs: number of the pair of blocks of each line of a joint, shape (m,).
        slip, gap: largest way along the joints of each pair, and least opening [m], shape (pairs,).
        left: slip or gap from which on a pair has left its joints [m], shape (pairs,).
        start: the bodies where they stood.
        limits: how far each may move before its block is looked at [m], shape (bodies,).
        sizes: the largest distance of a corner from its centroid [m], shape (bodies,).
    """

    pairs: Integers
    slip: Array
    gap: Array
    left: Array
    start: Rows
    limits: Array
    sizes: Array


@compiled
def wears(system: System, wear: Wear, time: float) -> bool:
    """Bring slip and gap of joints up to date. Returns whether a pair has left its joints, or a body may move farther
    than its limit within a time [s]."""
    return wears_joints(system, wear, system.axes) or moves_on(system, wear, time, system.axes)


@inlined
def moves_on(system: System, wear: Wear, time: float, axes: tuple[int, ...]) -> bool:
    """Whether a body may move farther than its limit within a time [s]."""
    for b in range(len(system.bodies)):
        body, start, turned = system.bodies[b], wear.start[b], 0.0
        take_turn(start, axes)
        for i in range(len(axes)):
            unit = vector(AXES, i, axes)
            change = minus(rotation_change(body, unit), rotation_change(start, unit))
            turned += dot(change, change)
        way, velocity = (
            minus(components(body.place, axes), components(start.place, axes)),
            components(body.velocity, axes),
        )
        spin = spin_components(body.spin, axes)
        speed = math.sqrt(dot(velocity, velocity)) + math.sqrt(dot(spin, spin)) * wear.sizes[b]
        if math.sqrt(dot(way, way)) + math.sqrt(turned) * wear.sizes[b] + time * speed > wear.limits[b]:
            return True
    return False


@inlined
def wears_joints(system: System, wear: Wear, axes: tuple[int, ...]) -> bool:
    """Bring slip, gap and the rotations of bodies up to date. Returns whether a pair has left its joints."""
    pairs, slip, gap = wear.pairs, wear.slip, wear.gap
    for pair in range(len(slip)):
        slip[pair], gap[pair] = 0.0, math.inf
    for b in range(len(system.bodies)):
        take_turn(system.bodies[b], axes)
    for p in range(len(pairs)):
        line = system.lines[p]
        body, at, normal = system.bodies[line.body], components(line.at, axes), components(line.normal, axes)
        across = plus(components(line.between, axes), plus(components(body.place, axes), rotation_change(body, at)))
        if line.face >= 0:
            face = system.bodies[line.face]
            change = rotation_change(face, components(line.origin, axes))
            across = minus(across, plus(components(face.place, axes), change))
            normal = plus(normal, rotation_change(face, normal))
        elif line.support >= 0:
            across = minus(across, vector(system.supports.moved, line.support, axes))
        apart = dot(normal, across)
        slip[pairs[p]] = max(slip[pairs[p]], math.sqrt(max(dot(across, across) - apart * apart, 0.0)))
        gap[pairs[p]] = min(gap[pairs[p]], apart)
        line.widest = max(line.widest, apart)
    left = False
    for pair in range(len(slip)):
        left = left or max(slip[pair], gap[pair]) > wear.left[pair]
    return left


@compiled
def held(system: System, which: Integers, depth: Array) -> float:
    """Energy in the springs along the normal of some of the lines [J], and write how deep each presses [m]. What shear
    springs lose, friction takes."""
    return held_by_lines(system, which, depth, system.axes)


@inlined
def held_by_lines(system: System, which: Integers, depth: Array, axes: tuple[int, ...]) -> float:
    """`held`, in the plane or in space."""
    energy = 0.0
    for i in range(len(which)):
        line = system.lines[which[i]]
        gap = meeting(system, line, axes).gap
        depth[i] = max(-gap, 0.0)
        energy += stored(line, gap)
    return energy
