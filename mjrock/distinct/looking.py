"""Looking at lines: which joints hold no longer, what springs hold, and which place was nearest."""

from __future__ import annotations

import math

from ..compiled import compiled, jitable
from ..geometry.vectors import components, dot, minus, plus, spin_components, vector
from ..problem.masonry.joint_law import stored, stored_along
from ..quantities import Array, Flags, Integers
from .contact import meeting
from .system import System
from .turning import rotation_change, take_turn


@compiled
def wear(system: System, pairs: Integers, slip: Array, gap: Array) -> None:
    """Write how far each pair of blocks with a joint has slid at most, and opened at least [m], shape (pairs,).

    Args:
        system: the system.
        pairs: number of the pair of each line of the joints.
        slip, gap: room for the answer.
    """
    wear_of_lines(system, pairs, slip, gap, system.axes)


@jitable
def wear_of_lines(system: System, pairs: Integers, slip: Array, gap: Array, axes: tuple[int, ...]) -> None:
    """`wear`, in the plane or in space. It brings the rotations of the bodies up to date."""
    slip[:], gap[:] = 0.0, math.inf
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


@compiled
def held(system: System, which: Flags) -> float:
    """Energy in the springs of some of the lines [J], shape of the answers (lines,)."""
    return held_by_lines(system, which, system.axes)


@jitable
def held_by_lines(system: System, which: Flags, axes: tuple[int, ...]) -> float:
    """`held`, in the plane or in space."""
    energy = 0.0
    for p in range(len(which)):
        if which[p]:
            line = system.lines[p]
            energy += stored(line, meeting(system, line, axes).gap)
            if line.k_s < math.inf:
                grip = spin_components(line.grip, axes)
                energy += stored_along(line, dot(grip, grip))
    return energy


@compiled
def nearest(pair: Integers, place: Array, first: Integers, other: Array, chosen: Integers) -> None:
    """Write which of other places of its pair is nearest to each place.

    Args:
        pair: position of the pair of each place in `first`, shape (places,).
        place: where they are [m], shape (places, d).
        first: where the others of each pair begin, and where those of the last end.
        other: where those are, one pair after the other [m].
        chosen: room for the answer, shape (places,).
    """
    for i in range(len(pair)):
        chosen[i], least = -1, math.inf
        for j in range(first[pair[i]], first[pair[i] + 1]):
            square = 0.0
            for axis in range(place.shape[1]):
                square += (place[i, axis] - other[j, axis]) ** 2
            if square < least:
                chosen[i], least = j, square
