"""Masonry of many blocks: convex blocks, and the joints where their edges touch."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...quantities import Array, Implausible, frozen, keep, require_whole, require_within, shown
from ..damping.contacts import Law, required_law
from .builders import MOST_BLOCKS, Forms
from .exchange import Exchange
from .forms_in_space import FormsInSpace
from .joints import joints_in_plane, names_of
from .joints_in_space import joints_in_space
from .lines import Lines, lines_of, lowest_frequency
from .of_joint import OF_JOINTS, OfJoint, required, values_of
from .polygon import Polygon
from .polyhedron import Polyhedron
from .stack_law import retardations

FAR = 30.0
"""How far below the lowest frequency a given one is doubted [-], where it damps that one beyond `OVERDAMPED`."""
OVERDAMPED = 30.0
"""Damping ratio of the lowest mode above which the frequency that xi refers to is doubted [-]."""
UNDAMPED = 1e-4
"""The same below which it is doubted [-], where xi is a hundred times as much."""


@dataclass(frozen=True)
class Masonry(Forms, FormsInSpace, Exchange):
    """Rigid convex blocks on compliant joints.

    The joints are found where edges of two blocks touch along a line, along the whole edge or part of it. A joint is a
    few contact lines, at its ends and evenly between: each is a spring and a dashpot that push only, with Coulomb
    friction. A joint that opens turns about its last line. How stiff this hinge is depends on `points` and `k_n`, and a
    structure near its limit can depend on that.

    Blocks in space, of the kind `Polyhedron`, have their joints where two faces cover a common area, with contact
    points in place of the lines.

    In MuJoCo blocks meet only at the joints that they have at rest, faces have no end, and the run ends when two blocks
    of a joint are farther apart than the whole masonry is large, or when a block has turned by 90 degrees. Friction
    that holds is a strong dashpot there: under a sustained force F along a joint it creeps at about F / (3e8 m) [m/s],
    m the reduced mass of the two blocks [kg]. In explicit steps, see `solve_explicit`, faces end and blocks that fall
    meet others.

    Args:
        blocks: the blocks, all `Polygon` or all `Polyhedron`, at least one fixed and one that is not, at most 5000.
        k_n: normal stiffness of the joints [N/m3], 1e4 to 1e14, or a function of the joint.
        friction: coefficient of friction [-], 0 to 10, or a function of the joint.
        xi: damping ratio [-], 0 to 100, or a function of the joint. The dashpot of a line is c = (2 xi / omega) k, the
            stiffness-proportional damping of distinct-element codes.
        frequency: omega [rad/s], 1e-3 to 1e9. None takes the lowest natural frequency with every joint closed. It is
            `reference_frequency` for one block on the ground.
        points: contact lines of each joint, 2 to 1000. In space 2 to 50: two put a contact point on each corner of the
            joint, and more divide a joint of four corners into (points - 1)^2 cells with a point on each of their
            corners, and other joints alike. Each point has the stiffness of its tributary area.
        tolerance: largest distance between edges or faces that touch, and largest overlap of blocks [m], 1e-9 to 0.1. A
            joint is wider than ten times that. It lies halfway between the edges, and is closed and unloaded as drawn.
        law: a damping law or its name, which takes the place of xi. Each bed joint of a stack is damped as the base of
            the rigid wall above it, and a fixed block beside the stack as the side stop of the whole, see
            `Contacts.from_law`. A stack of 2 to 7 blocks that rocks as one then loses more than its wall at an impact:
            2 to 10 % more on joints of 1e10 N/m3 or stiffer, 4 to 24 % more on 1e9 (h/b of 7, from alpha/2), and 5 to
            7 % less against a side stop. `matched_masonry` finds the damping with which it loses the same. In space the
            wall is as thick as the joint where it is thinnest, and no fixed block may stand beside the stack.
        k_s: shear stiffness of the joints [N/m3], 1e4 to 1e16, or a function of the joint, for `solve_explicit`. None
            lets them stick rigidly, up to their friction, as they always do in MuJoCo.

    Raises:
        ValueError: for a value outside its range, blocks that overlap, or a law for what is not a stack.

    Warns:
        Implausible: for a frequency so far from the lowest one of the masonry that the dashpots are odd.
    """

    blocks: tuple[Any, ...]
    k_n: OfJoint = 1e10
    friction: OfJoint = 0.7
    xi: OfJoint = 0.05
    frequency: float | None = None
    points: int = 2
    tolerance: float = 1e-5
    law: Law | str | None = None
    k_s: OfJoint | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.blocks, Sequence) or isinstance(self.blocks, str):
            raise TypeError(f"blocks = {shown(self.blocks)} is not a list of blocks")
        keep(self, blocks=tuple(self.blocks))
        for i, block in enumerate(self.blocks):
            if not isinstance(block, Polygon | Polyhedron):
                raise TypeError(f"blocks[{i}] = {shown(block)} is not a Polygon or Polyhedron")
            if type(block) is not type(self.blocks[0]):
                raise TypeError(
                    f"blocks[{i}] is a {type(block).__name__}, and blocks[0] is none; give blocks of one kind"
                )
        if not 0 < len(self.free) < len(self.blocks) <= MOST_BLOCKS:
            raise ValueError(
                f"blocks = {len(self.free)} free and {len(self.blocks) - len(self.free)} fixed; at least one of each "
                f"and at most {MOST_BLOCKS} are needed"
            )
        for name, number in Counter(self.names).items():
            if number > 1:
                raise ValueError(f"blocks: {number} of them have the name {name}")
        keep(
            self,
            points=require_whole("points", self.points, 2, 50 if self.in_space else 1000),
            tolerance=require_within("tolerance", self.tolerance, 1e-9, 0.1, "m"),
        )
        if self.frequency is not None:
            keep(self, frequency=require_within("frequency", self.frequency, 1e-3, 1e9, "rad/s"))
        keep(self, **{name: required(name, getattr(self, name)) for name in OF_JOINTS})
        if self.law is not None:
            keep(self, law=required_law(self.law, self.points))
            if self.frequency is not None:
                given = f"frequency = {self.frequency:g} rad/s"
                raise ValueError(f"{given} is given with a law, which has its own; leave it")
        if not self.joints:
            raise ValueError(f"blocks: no two of them touch along {'a face' if self.in_space else 'an edge'}")
        _ = self.joint_stiffness, self.joint_friction, self.joint_damping, self.joint_shear  # checks what they hold
        if self.law is not None:
            _ = self.retardation
        elif self.frequency is not None and (odd := self._doubt_of_frequency(self.frequency)):
            warnings.warn(odd, Implausible, stacklevel=3)

    @property
    def in_space(self) -> bool:
        """Whether the blocks are bodies in space."""
        return isinstance(self.blocks[0], Polyhedron)

    def require_plane(self, what: str) -> None:
        """Raise a ValueError that says what takes blocks in the plane alone, if these are in space."""
        if self.in_space:
            raise ValueError(f"masonry in space: {what} takes blocks in the plane, of the kind Polygon")

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Name of each block: its own, or `block_` and its number."""
        return names_of(self.blocks)

    @cached_property
    def free(self) -> tuple[int, ...]:
        """Numbers of the blocks that are not fixed, in order."""
        return tuple(i for i, block in enumerate(self.blocks) if not block.fixed)

    @cached_property
    def centroids(self) -> Array:
        """Centroid of each block at rest, fixed ones too [m], shape (blocks, 2), in space (blocks, 3)."""
        return frozen([block.centroid for block in self.blocks])

    @cached_property
    def joints(self) -> tuple[Any, ...]:
        """The joints, in the order of the blocks: `Joint`, or `SpaceJoint` of blocks in space."""
        return (joints_in_space if self.in_space else joints_in_plane)(self.blocks, self.tolerance)

    @cached_property
    def joint_stiffness(self) -> Array:
        """k_n of each joint [N/m3], shape (joints,)."""
        return values_of("k_n", self.k_n, self.joints)

    @cached_property
    def joint_friction(self) -> Array:
        """Coefficient of friction of each joint [-], shape (joints,)."""
        return values_of("friction", self.friction, self.joints)

    @cached_property
    def joint_damping(self) -> Array:
        """xi of each joint [-], shape (joints,)."""
        return values_of("xi", self.xi, self.joints)

    @cached_property
    def joint_shear(self) -> Array:
        """k_s of each joint [N/m3], infinite for one that sticks rigidly, shape (joints,)."""
        return values_of("k_s", self.k_s, self.joints)

    @cached_property
    def lines(self) -> Lines:
        """The contact lines of all joints."""
        return lines_of(self.blocks, self.joints, self.joint_stiffness, self.points)

    @cached_property
    def retardation(self) -> Array:
        """c/k of each joint [s], shape (joints,)."""
        if self.law is not None:
            return retardations(self.blocks, self.joints, self.joint_stiffness, self.points, self.law)
        if not self.joint_damping.any():
            return np.zeros(len(self.joints))
        return np.asarray(2 * self.joint_damping / (self.frequency or self._lowest_frequency))

    @cached_property
    def _lowest_frequency(self) -> float:
        return lowest_frequency(self.blocks, self.lines, self.joint_friction)

    def _doubt_of_frequency(self, frequency: float) -> str:
        """What is odd about a given frequency [rad/s], in words, empty where nothing is.

        With the lowest one of the masonry it makes of xi the damping ratio of that mode, which says whether c/k is odd.
        """
        xi = float(self.joint_damping.max())
        try:
            lowest = self._lowest_frequency if xi else 0.0
        except ValueError:  # no joint that a motion could compress
            lowest = 0.0
        found, c_over_k = xi * lowest / frequency, 2 * xi / frequency
        overdamped = found > OVERDAMPED and lowest > FAR * frequency
        if not (overdamped or (0 < found < UNDAMPED and xi > 100 * UNDAMPED)):
            return ""
        return (
            f"frequency = {frequency:g} rad/s, and the lowest one of this masonry is {lowest:.3g} rad/s: with xi = "
            f"{xi:g} that one is damped to {found:.3g} times critical, c/k = {c_over_k:.2g} s; frequencies are in "
            "rad/s, and None takes the lowest"
        )
