"""The system: bodies, contact lines and links in the plane, each a row of named numbers for compiled functions.

What belongs together stands together in memory, which is what a step of some thousand lines takes its time for.
Positions are those at rest, and the motion is counted from there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry.frames import PLANE, Freedom
from ..quantities import Array, Integers
from ..scene.ground import Ground

FAR = 1e9
"""An end that is never reached [m]."""

BODY = np.dtype(
    [
        *((name, float) for name in ("mass", "ease")),  # [kg], and the inverse of the moment of inertia [1/(kg m2)]
        *((name, float) for name in ("x0", "z0")),  # centroid at rest [m]
        *((name, float) for name in ("x", "z", "theta")),  # displacement from there [m, m, rad]
        *((name, float) for name in ("sine", "versine")),  # sin and 1 - cos of theta
        *((name, float) for name in ("vx", "vz", "w")),  # velocity half a step before the pose [m/s, m/s, rad/s]
        *((name, float) for name in ("fx", "fz", "moment")),  # force and moment at the pose [N, N, N m]
    ]
)
"""A rigid body."""

LINE = np.dtype(
    [
        ("body", np.int64),  # the body that carries the point
        ("face", np.int64),  # the body of the face, -1 for a fixed block
        ("support", np.int64),  # the support that moves a fixed block, -1 for none
        ("group", np.int64),  # number of the account
        ("corner", np.int64),  # 1 for a corner near an edge, 2 when it has come through; 0 for a line of a joint
        *((name, float) for name in ("at_x", "at_z")),  # the point from the centroid of its body [m]
        *((name, float) for name in ("origin_x", "origin_z")),  # a point of the face, from the centroid [m]
        *((name, float) for name in ("normal_x", "normal_z")),  # unit vector out of the face
        *((name, float) for name in ("between_x", "between_z")),  # from the face to the point at rest [m]
        *((name, float) for name in ("k", "c", "k_s", "c_s")),  # springs and dashpots along the normal and the face
        ("friction", float),  # coefficient [-]
        *((name, float) for name in ("low", "high")),  # ends of the face, from its origin along its tangent [m]
        *((name, float) for name in ("back", "forth")),  # ends of the edge of the body, from the point likewise [m]
        ("grip", float),  # stretch of the shear spring [m]; where it is rigid, friction of the last step [N]
        *((name, float) for name in ("push", "pressed", "dragged")),  # force, dashpot and friction of the last step [N]
        ("widest", float),  # largest gap so far [m]
        ("past", np.int64),  # 1 for a point past the end of its face at the last pose
        *((name, float) for name in ("way_x", "way_z", "lever", "other")),  # friction of a unit impulse: see `friction`
        *((name, float) for name in ("most", "light", "sliding")),
    ]
)
"""A contact line: a point of a body above the face of another body or of a fixed block."""
THROUGH = 2
"""`corner` of a line whose corner has come through an edge or a face, in the plane and in space."""

LINK = np.dtype(
    [
        ("body", np.int64),  # the body that is held
        *((name, float) for name in ("at_x", "at_z")),  # where, from its centroid [m]
        *((name, float) for name in ("between_x", "between_z")),  # from the anchor [m]; components of a force [N]
        *((name, float) for name in ("k", "c")),  # spring and dashpot [N/m, N s/m]
        *((name, float) for name in ("reach", "strength")),  # slack length of a tie [m], and its yield [N]
        *((name, float) for name in ("drawn", "ultimate", "broken")),  # plastic elongation, its limit [m], time [s]
        ("pulled", float),  # force of a damper in the last step [N]
    ]
)
"""A tie, a damper or a constant force between a point of a body and the ground."""

Rows = NDArray[np.void]
Row = Any
"""One of the rows; its numbers are attributes."""


def rows(kind: np.dtype[np.void], count: int, **columns: Array | Integers | float) -> Rows:
    """Rows with these columns, and zeros in the others."""
    table = np.zeros(count, dtype=kind)
    for name, values in columns.items():
        table[name] = values
    return table.view(np.recarray)


def named(names: Sequence[str], values: Array) -> dict[str, Array]:
    """The columns of an array by name."""
    return dict(zip(names, np.reshape(values, (-1, len(names))).T, strict=True))


def stacked(table: Rows, names: Sequence[str]) -> NDArray[Any]:
    """Columns of rows side by side, shape (rows, columns)."""
    columns = np.asarray(table)  # a record array would make an object of its own of each column
    return np.column_stack([columns[name] for name in names])


class Supports(NamedTuple):
    """Displacement histories of fixed blocks, and where the blocks are.

    Args:
        t: times of the samples of all supports, one support after the other [s], shape (samples,).
        displacement: x and z [m], shape (samples, 2), in space (samples, 3), linear in between.
        first: where the samples of each support begin, and where those of the last end, shape (s + 1,).
        moved, moving: displacement and velocity at the pose [m, m/s], shape (s, 2), in space (s, 3).
    """

    t: Array
    displacement: Array
    first: Integers
    moved: Array
    moving: Array


class System(NamedTuple):
    """All that stands and acts, and its motion."""

    bodies: Rows
    lines: Rows
    ties: Rows
    dampers: Rows
    forces: Rows
    ground: Ground
    supports: Supports


class Books(NamedTuple):
    """Work since the start [J].

    Args:
        dashpots: by group, shape (g,).
        ties, broken, dampers: by tie, yielding and breaking, and by damper, shapes (t,), (t,) and (d,).
        ends: what lines have lost at the ends of faces, those of joints and of encounters, shape (2,).
        friction: friction, what is in the shear springs included; then the work of ground and supports; then the
            accelerations of the ground in the last step, x, z and y [m/s2], shape (5,).
        active: room for the numbers of the lines that stick rigidly, shape (m,).
    """

    dashpots: Array
    ties: Array
    broken: Array
    dampers: Array
    ends: Array
    friction: Array
    active: Integers

    @classmethod
    def of(cls, system: Any, groups: int, further: int = 0) -> Books:
        """Empty books of a system in the plane or in space, with room for some further lines."""
        sizes = (groups, len(system.ties), len(system.ties), len(system.dampers), 2, 5)
        dashpots, ties, broken, dampers, ends, friction = (np.zeros(size) for size in sizes)
        active = np.zeros(len(system.lines) + further, dtype=np.int64)
        return cls(dashpots, ties, broken, dampers, ends, friction, active)


ALWAYS = 4
"""Columns of work that are kept without a ledger too: friction, ground, ends of faces of joints and of encounters."""


class Samples(NamedTuple):
    """What is kept of a motion at its samples.

    Args:
        pose, velocity: of the bodies, shape (samples, n, 3); in space (samples, n, 7) and (samples, n, 6).
        energy: kinetic, potential and elastic [J], shape (samples, 3).
        work: friction, ground and ends of faces, then dampers, ties, broken ties and dashpots by group [J], shape
            (samples, columns). Without a ledger it is the first ALWAYS alone, and friction is that of shear springs.
    """

    pose: Array
    velocity: Array
    energy: Array
    work: Array

    @classmethod
    def of(cls, count: int, bodies: int, columns: int, freedom: Freedom = PLANE) -> Samples:
        """Room for some samples."""
        shapes = (count, bodies, freedom.nq), (count, bodies, freedom.nv), (count, 3), (count, columns)
        return cls(*(np.zeros(shape) for shape in shapes))
