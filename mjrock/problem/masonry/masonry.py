"""Masonry of many blocks, and the joints where their edges touch."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Self, Unpack

import numpy as np
from numpy.typing import ArrayLike

from ...contacts.files import write_text
from ...geometry.frames import PLANE, SPACE, Freedom
from ...notebook import NotebookPicture
from ...quantities import (
    Array,
    Density,
    Implausible,
    Integers,
    Within,
    frozen,
    keep,
    named,
    require_flag,
    require_kind,
    require_path,
    require_sequence,
    require_whole,
    shown,
    warn_of,
)
from ..damping.contacts import AnyLaw, required_law
from ..wall.bending import Bearing, CrackHeight, FloorLoad, HorizontalBending, VerticalBending
from ..wall.block import Block
from ..wall.effects import SideStop
from ..wall.section import Opening
from .blocks.compound import AnyBlock, Compound, FlatBlock, SolidBlock
from .blocks.joints import Joint, OverlapError, joints_in_plane, names_of
from .blocks.joints_in_space import SpaceJoint, joints_in_space
from .blocks.polygon import COORDINATE, Polygon
from .blocks.polyhedron import Extents, Polyhedron
from .builders.in_plane import (
    MOST_BODIES,
    Taper,
    arch_of,
    bending_between_floors,
    between_beams,
    bonded_wall,
    curved,
    ground_below_all,
    side_of,
    stacked,
)
from .builders.in_space import (
    bending_between_sides,
    box_on_ground,
    column_of,
    dome_of,
    facade_of,
    ground_below,
    wall_corner,
    wallette_of,
    walls_of,
)
from .builders.vaults import Span, barrel_of, bridge_of, groin_of
from .drawing import (
    FINE_TOLERANCE,
    NEARLY,
    WIDEST_TOLERANCE,
    along_lines,
    nearly,
    not_joined,
    odd_axis,
    odd_damping,
    odd_frequency,
    odd_sizes,
    remedy,
    smallest_gap,
    split_faces,
    touches_told,
    with_sizes,
)
from .files.bodies import Given, Mesh, Scale, about, blocks_of, meshes_of, names_of_list
from .files.compas import compas_text, read_compas
from .files.dxf import DensityOfLayer, LengthOfLayer, polygons_of, read_dxf
from .files.lmgc90 import read_lmgc90
from .files.meshes import obj_text, read_obj, read_ply, read_stl
from .laws.bond import Bond
from .laws.dry import AnyPairs, Dry, Meets, Properties, requested_pair, required_pairs
from .laws.joint_table import (
    PROPERTIES,
    AnyJoints,
    ByKind,
    ByName,
    ByWord,
    Halved,
    JointOptions,
    JointTable,
    OfBond,
    OfCount,
    OfDamping,
    OfFrequency,
    OfFriction,
    OfJoint,
    OfPoints,
    OfShear,
    OfStiffness,
    OrElse,
    OtherOptions,
    has_function,
    keywords_checked,
    one_by_one,
    properties_of,
)
from .laws.own_law import Own
from .laws.stack_law import damping_by_law
from .lines import Lines, lines_of, lowest_frequency

AnyPath = str | PathLike[str]
Radius = Annotated[float, Within(0.01, 1000, "m")]
Thick = Annotated[Taper, Within(1e-5, 1000, "m")]
SpanAngle = Annotated[float, Within(0.1, math.pi, "rad")]
Voussoirs = Annotated[int, Within(1, 1000, whole=True)]
Length = Annotated[float, Within(1e-3, 1000, "m")]
Size = Annotated[float, Within(0.01, 1000, "m")]
Side = Annotated[float, Within(0.01, 100, "m")]
Unit = tuple[Side, Side]
"""Sizes that builders share."""


@keywords_checked
@dataclass(frozen=True, repr=False, init=False)
class Masonry(NotebookPicture):
    """Rigid blocks on compliant joints.

    The joints are found where edges of two blocks touch along a line, along the whole edge or part of it. A joint is a
    few contact lines, at its ends and evenly between: each is a spring and a dashpot that push only, with Coulomb
    friction. A joint that opens turns about its last line. How stiff this hinge is depends on `points` and `k_n`, and a
    structure near its limit can depend on that.

    Blocks in space, of the kind `Polyhedron`, have their joints where two faces cover a common area, with contact
    points in place of the lines. Blocks are convex; a unit that is not, such as an L or a hook, is a `Compound`.

    In MuJoCo blocks meet only at the joints that they have at rest, faces have no end, and the run ends when two blocks
    of a joint are farther apart than the whole masonry is large, when a block has turned by 90 degrees, or when one
    lies lower than a face that it has left, four times the largest extent of a block away from their joint. Friction
    that holds is a strong dashpot there: under a sustained force F along a joint it creeps at about F / (3e8 m) [m/s],
    m the reduced mass of the two blocks [kg]. In explicit steps, see `solve_explicit`, faces end and blocks that fall
    meet others.

    Two are equal if their blocks and keywords are. A function of the joint is equal to itself alone: two lambdas of the
    same text make two that are not equal.

    Args:
        blocks: the blocks, all in the plane, `Polygon` or `Compound` of these, or all in space, `Polyhedron` or
            `Compound` of these; at least one fixed and one that is not, at most 5000.
        k_n: normal stiffness of the joints [N/m3], 1e4 to 1e14, or a function of the joint; None takes 1e10.
        friction: coefficient of friction [-], 0 to 10, or a function of the joint; None takes 0.7.
        xi: damping ratio [-], 0 to 100, or a function of the joint; None takes 0.05. The dashpot of a line is
            c = (2 xi / omega) k, the stiffness-proportional damping of distinct-element codes.
        frequency: omega [rad/s], 1e-3 to 1e9. None takes the lowest natural frequency with every joint closed and none
            sliding. It is `reference_frequency` for one block on the ground. Where inclined faces leave no such motion,
            they slide on k_s, or freely where that is None.
        points: contact lines of each joint, 2 to 1000, or a function of the joint; None takes 2. In space 2 to 50: two
            put a contact point on each corner of the joint, and more divide a joint of four corners into (points - 1)^2
            cells with a point on each of their corners, and other joints alike. Each point has the stiffness of its
            tributary area. A closed joint of n lines is 1 + 2 / (n - 1)^2 times as stiff in bending as k_n I: 3 times
            with 2, 1.5 with 3, 1.031 with 9. In space this holds for a rectangle both ways; a triangle on its corners
            is 4 times as stiff. A joint with a bond takes 3 or more, and shares its area out to them so that it is as
            stiff as k_n I. A joint that has slid keeps its lines and k_n, on the part of its faces that still lies over
            each other.
        tolerance: largest distance between edges or faces that touch, and largest overlap of blocks [m], 1e-9 to 0.1. A
            joint is wider than ten times that. It lies halfway between the edges, and is closed and unloaded as drawn.
        gap: thickness of the mortar of brickwork that is drawn with its joints [m], 1e-9 to 0.1. Edges or faces are
            then a joint that lie up to the gap and the tolerance apart. Blocks are what is drawn, without the mortar
            and its mass. None is for blocks that touch.
        law: a damping law or its name, which takes the place of xi. Each bed joint of a stack is damped as the base of
            the rigid wall above it, and a fixed block beside the stack as the side stop of the whole, see
            `Contacts.from_law`. A stack of 2 to 7 blocks that rocks as one then loses more than its wall at an impact:
            2 to 10 % more on joints of 1e10 N/m3 or stiffer, 4 to 24 % more on 1e9 (h/b of 7, from alpha/2), and 5 to
            7 % less against a side stop. `matched_masonry` finds the damping with which it loses the same. In space the
            wall is as thick as the joint where it is thinnest, and no fixed block may stand beside the stack.
        k_s: shear stiffness of the joints [N/m3], 1e4 to 1e16, or a function of the joint, for `solve_explicit`. None
            lets them stick rigidly, up to their friction, as they always do in MuJoCo.
        bond: what mortar holds, a `Bond` or a function of the joint that gives one, or None where a joint is dry, for
            `solve_explicit`. It needs `k_s` and three `points` or more. The first crack in bending is that of the
            elastic section for any number of them; five or more follow the crack, see docs/mortar.md.
        joints: what the joints are, a `Dry` or a `Mortar` for all, or a function of the joint that gives one, in the
            place of k_n, friction, xi, k_s, frequency, points and bond, which are the short way to the same. A function
            is asked once of each joint. The joints that are found are then `joints`.
        pairs: friction and damping of blocks that have no joint, where they meet in explicit steps and in plain models:
            a `Dry` for all, or a function of the names of two blocks, in their order, that gives one or None. Of the
            `Dry` `friction`, `xi` and `frequency` count. None takes the joints of the two blocks, see `solve_explicit`.

    Raises:
        TypeError: for a keyword that it does not take, and names the nearest one.
        ValueError: for a value outside its range, joints given both ways, blocks that overlap, or a law for what is not
            a stack.

    Warns:
        Implausible: for a frequency so far from the lowest one of the masonry that the dashpots are odd, for an xi
            above 1 without one, for blocks so large or small that they are probably not in m, for faces that rounded
            vertices have split, and for blocks that touch along a line or at a corner alone, where no joint is.

    Examples:
        >>> arch = mr.Masonry.arch(radius=5.0, thickness=0.9, joints=mr.Dry(k_n=1e10, friction=0.7))
        >>> len(arch.blocks), len(arch.joints)
        (19, 18)
    """

    blocks: Sequence[AnyBlock]
    k_n: OfJoint
    friction: OfJoint
    xi: OfJoint
    frequency: OfJoint | None
    points: OfCount
    tolerance: float
    gap: float | None
    law: AnyLaw | str | None
    k_s: OfJoint | None
    bond: OfBond
    pairs: AnyPairs

    def __init__(
        self,
        blocks: Sequence[AnyBlock],
        k_n: OfStiffness = None,
        friction: OfFriction = None,
        xi: OfDamping = None,
        frequency: OfFrequency = None,
        points: OfPoints = None,
        tolerance: Annotated[float, Within(1e-9, WIDEST_TOLERANCE, "m")] = 1e-5,
        law: AnyLaw | str | None = None,
        k_s: OfShear = None,
        *,
        bond: OfBond = None,
        joints: AnyJoints | None = None,
        pairs: AnyPairs = None,
        gap: Annotated[float | None, Within(1e-9, WIDEST_TOLERANCE, "m")] = None,
    ) -> None:
        keep(self, blocks=blocks_of_one_kind(blocks), law=law, tolerance=tolerance, gap=gap)
        keep(self, pairs=required_pairs(pairs))
        given = {"k_n": k_n, "friction": friction, "xi": xi, "frequency": frequency, "points": points, "k_s": k_s}
        keep(self, **properties_of(joints, given | {"bond": bond}))
        if not self.joints:
            side = "a face" if self.in_space else "an edge"
            raise ValueError(
                f"blocks: no two of them touch along {side} within {self._reach_said}; "
                f"{smallest_gap(self.blocks, self.names, self.free, self._joints_within, self.reach)}"
            )
        if law is not None:
            keep(self, law=required_law(law))
        if len(counts := set(self.table.points.tolist())) == 1:
            keep(self, points=counts.pop())
        for odd in self._doubts():
            warn_of(odd, Implausible)

    def __repr__(self) -> str:
        corners = np.concatenate([self.blocks[i].corners for i in self.free])
        size = " x ".join(f"{extent:.4g}" for extent in np.ptp(corners, axis=0))
        left = {"k_s": np.isinf(self.joint_shear).all(), "xi": self.law is not None}
        names = (name for name in ("k_n", "k_s", "friction", "xi", "points") if not left.get(name))
        given = ((name, getattr(self, name)) for name in names)
        said = [f"{name} of the joint" if callable(value) else f"{name} = {value:g}" for name, value in given]
        if self.law is not None:
            said.insert(-1, f"law {getattr(self.law, 'name', getattr(self.law, '__name__', 'given'))}")
        bonded = ", mortar" if any(isinstance(bond, Bond) for bond in self.bonds) else ""
        bonded += ", laws of their own" if any(isinstance(bond, Own) for bond in self.bonds) else ""
        return f"<Masonry of {len(self.free)} blocks, {size} m: {', '.join(said)}{bonded}>"

    @property
    def in_space(self) -> bool:
        """Whether the blocks are bodies in space."""
        return self.blocks[0].in_space

    @property
    def freedom(self) -> Freedom:
        """How the blocks may move: in the plane or in space."""
        return SPACE if self.in_space else PLANE

    @cached_property
    def polygons(self) -> tuple[FlatBlock, ...]:
        """The blocks of masonry in the plane; none of masonry in space."""
        return tuple(block for block in self.blocks if not isinstance(block, Polyhedron) and not block.in_space)

    @cached_property
    def polyhedra(self) -> tuple[SolidBlock, ...]:
        """The blocks of masonry in space; none of masonry in the plane."""
        return tuple(block for block in self.blocks if not isinstance(block, Polygon) and block.in_space)

    @cached_property
    def plane_joints(self) -> tuple[Joint, ...]:
        """The joints of masonry in the plane; none of masonry in space."""
        return tuple(joint for joint in self.joints if isinstance(joint, Joint))

    @cached_property
    def space_joints(self) -> tuple[SpaceJoint, ...]:
        """The joints of masonry in space; none of masonry in the plane."""
        return tuple(joint for joint in self.joints if isinstance(joint, SpaceJoint))

    def require_plane(self, what: str) -> None:
        """Raise a ValueError that says what takes blocks in the plane alone, if these are in space."""
        if self.in_space:
            raise ValueError(f"masonry in space: {what} takes blocks in the plane, of the kind Polygon")

    def require_dry(self, what: str) -> None:
        """Raise a ValueError that says what takes dry joints alone, if some have a bond or a law of one's own."""
        own = {joint.name: bond for joint, bond in zip(self.joints, self.bonds, strict=True) if isinstance(bond, Own)}
        if own:
            laws = ", ".join(sorted({bond.name for bond in own.values()}))
            raise ValueError(
                f"law of {named(list(own))}: {what} knows k_n, xi and friction of a joint, and no {laws}; "
                "solve_explicit takes laws of your own"
            )
        if any(self.bonds):
            held = named([joint.name for joint, bond in zip(self.joints, self.bonds, strict=True) if bond is not None])
            raise ValueError(f"bond of {held}: {what} takes joints that push only; solve_explicit takes bonds")

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
    def joints(self) -> tuple[Joint | SpaceJoint, ...]:
        """The joints, in the order of the blocks: `Joint`, or `SpaceJoint` of blocks in space."""
        try:
            return self._joints_within(self.reach)
        except OverlapError as error:
            raise ValueError(f"{error}; {remedy(error.deepest, self._joints_with, self.blocks)}") from None

    @property
    def reach(self) -> float:
        """Largest distance between edges or faces that are a joint [m]: the tolerance beyond `gap`."""
        return self.tolerance + (self.gap or 0.0)

    @property
    def _reach_said(self) -> str:
        """The largest distance between faces that are a joint, in words."""
        return f"the {'tolerance' if self.gap is None else 'gap'} of {self.reach:g} m"

    def _joints_within(self, gap: float, pairs: Integers | None = None) -> tuple[Joint | SpaceJoint, ...]:
        """The joints of another gap [m], of all blocks or of some pairs."""
        return self._joints_with(self.tolerance, gap, pairs)

    def _joints_with(
        self, tolerance: float, gap: float = 0.0, pairs: Integers | None = None
    ) -> tuple[Joint | SpaceJoint, ...]:
        """The joints of another tolerance and of a gap that is at least as much [m], of all blocks or of some pairs."""
        if self.in_space:
            return joints_in_space(self.polyhedra, tolerance, max(gap, tolerance), pairs)
        return joints_in_plane(self.polygons, tolerance, max(gap, tolerance), pairs)

    @cached_property
    def table(self) -> JointTable:
        """The properties of the joints, a row each, with the damping of the law where there is one."""
        given = {name: getattr(self, name) for name in PROPERTIES}
        table = JointTable.of(self.joints, given)
        if self.law is None:
            return table
        if (known := table.frequency[~np.isnan(table.frequency)]).size:
            raise ValueError(f"frequency = {known[0]:g} rad/s is given with a law, which has its own; leave it")
        xi, frequency = damping_by_law(self.blocks, self.joints, table.k_n, table.points, self.law)
        return table._replace(xi=xi, frequency=frequency)

    def without_functions(self) -> Self:
        """The same with the values of its joints by their names in the place of functions of the joint, which no file
        can hold. What a file can hold is left as it is, and so is `pairs`."""
        given = {name: getattr(self, name) for name in PROPERTIES}
        held: dict[str, ByName | None] = {
            name: self._by_name(map(value, self.joints)) for name, value in given.items() if has_function(value)
        }
        if has_function(self.law):
            known = {name: self._by_name(getattr(self.table, name).tolist()) for name in ("xi", "frequency")}
            held |= {"law": None, **known}
        if not held:
            return self
        same = object.__new__(type(self))
        keep(same, **{each.name: getattr(self, each.name) for each in fields(self)} | held)
        return same

    def _by_name(self, values: Iterable[Any]) -> ByName:
        return ByName(tuple((joint.name, value) for joint, value in zip(self.joints, values, strict=True)))

    @property
    def joint_stiffness(self) -> Array:
        """k_n of each joint [N/m3], shape (joints,)."""
        return self.table.k_n

    @property
    def joint_friction(self) -> Array:
        """Coefficient of friction of each joint [-], shape (joints,)."""
        return self.table.friction

    @property
    def joint_damping(self) -> Array:
        """xi of each joint [-], shape (joints,)."""
        return self.table.xi

    @property
    def joint_shear(self) -> Array:
        """k_s of each joint [N/m3], infinite for one that sticks rigidly, shape (joints,)."""
        return self.table.k_s

    @property
    def residual_friction(self) -> Array:
        """Coefficient of friction of each joint that has lost its bond [-], shape (joints,)."""
        return self.table.residual_friction

    @property
    def bonds(self) -> tuple[Bond | Own | None, ...]:
        """The bond of each joint, or its law of one's own, None where it is dry."""
        return self.table.bonds

    def of_pair(self, one: int, other: int) -> Meets | None:
        """What two blocks without a joint have where they meet, by their numbers, or None where nothing is given."""
        dry = requested_pair(self.pairs, self.names[min(one, other)], self.names[max(one, other)])
        if dry is None:
            return None
        frequency = dry.frequency or (self._lowest_frequency if dry.xi else 1.0)
        return Meets(dry.friction, 2 * dry.xi / frequency)

    def areas_of(self, k: Array, joint: Integers) -> Array:
        """What part of its joint each contact line stands for [m2], from its k [N/m] and the number of its joint."""
        return np.asarray(k / self.table.k_n[joint])

    @cached_property
    def lines(self) -> Lines:
        """The contact lines of all joints."""
        bonded = [isinstance(bond, Bond) for bond in self.bonds]
        return lines_of(self.blocks, self.joints, self.joint_stiffness, self.table.points, bonded)

    @cached_property
    def retardation(self) -> Array:
        """c/k of each joint [s], shape (joints,)."""
        xi, frequency = self.table.xi, self.table.frequency
        if not xi.any():
            return np.zeros(len(self.joints))
        own = np.isnan(frequency)
        return np.asarray(2 * xi / (np.where(own, self._lowest_frequency, frequency) if own.any() else frequency))

    @cached_property
    def _lowest_frequency(self) -> float:
        along = self.table.k_s[self.lines.joint] * self.areas_of(self.lines.k, self.lines.joint)
        return lowest_frequency(self.blocks, self.lines, self.table.friction, along)

    @cached_property
    def _odd_sizes(self) -> str:
        """What is odd about the sizes of its free blocks, in words, empty where nothing is."""
        return odd_sizes({self.names[i]: 2 * self.blocks[i].size for i in self.free})

    def _doubts(self) -> list[str]:
        """What is odd about it, in words, empty where nothing is. Its table is made, and so checked, for that."""
        xi, frequency = self.table.xi, self.table.frequency
        own, odd = np.isnan(frequency), ""
        if self.law is None and not own.all():
            i = int(np.where(own, -1.0, xi / frequency).argmax())
            lowest = self._lowest_frequency if xi[i] else 0.0
            odd = odd_frequency(float(xi[i]), float(frequency[i]), lowest)
        sizes, faces = self._odd_sizes, split_faces(self.joints, self.blocks, self.names)
        touches = along_lines(self.blocks, self.joints, self.tolerance)
        alone = f"without a joint {touches_told(touches, self.names)}" if touches else ""
        return [doubt for doubt in (odd, odd_damping(xi[own]), sizes, faces, alone) if doubt]

    @classmethod
    def stack(
        cls,
        blocks: Sequence[Block],
        k_n: OfStiffness = None,
        *,
        ground: bool = True,
        side_stop: bool | SideStop = False,
        k_side: Annotated[float | None, Within(1e4, 1e14, "N/m3")] = None,
        side_friction: Annotated[float, Within(0, 10)] = 0.0,
        **options: Unpack[OtherOptions],
    ) -> Self:
        """Blocks one on the other, their bases centred, from the lowest upwards. One with a profile is a `Compound`.

        A `Block` is at least as high as it is thick. Flatter ones are given to `Masonry` as polygons.

        Args:
            blocks: the blocks, whose insets are zero.
            k_n: stiffness of the joints [N/m3], as of `Masonry`.
            ground: whether fixed ground is put under them. Otherwise the lowest block is fixed.
            side_stop: True for a side stop over the whole inner face, which is the left one, or the `SideStop` that
                reaches only so high. It is a fixed block of the name `side`, the last of the blocks, and has a joint
                with each face that it lies behind, at whose ends they meet. It follows setbacks, as side walls do,
                clear of the ledge as that rises, and does not reach under a block that stands out farther than those
                below it.
            k_side: stiffness of the joints with the side stop [N/m3], 1e4 to 1e14; None takes k_n.
            side_friction: their coefficient of friction [-], 0 to 10. A smooth one is what the laws were fitted for.
            options: further arguments of `Masonry`, such as `law`, `xi` and `friction`. With a side stop the xi of all
                joints refers to the lowest natural frequency without it.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        made = stacked(blocks, ground)
        side = side_of(made, side_stop)
        given = one_by_one({**options, "k_n": k_n})
        if side is None:
            if k_side is not None or side_friction:
                raise ValueError("k_side and side_friction need a side stop; give side_stop=True")
            return cls(made, **given)
        frequency = given["frequency"]
        if given.get("law") is None and (frequency is None or callable(frequency)):
            bare = cls(made, **given)
            lowest = lowest_frequency(bare.blocks, bare.lines, bare.joint_friction)
            given["frequency"] = OrElse(frequency, lowest) if callable(frequency) else lowest
        given["k_n"] = ByKind(given["k_n"], k_side or given["k_n"])
        given["friction"] = ByKind(given["friction"], side_friction)
        return cls((*made, side), **given)

    @classmethod
    def arch(
        cls,
        radius: Radius,
        thickness: Thick,
        span_angle: SpanAngle = math.pi,
        voussoirs: Voussoirs = 17,
        *,
        density: Density = 2000.0,
        length: Length = 1.0,
        chords: Annotated[int, Within(1, 50, whole=True)] = 1,
        ground: bool = False,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A circular arch of voussoirs of equal angles, between two fixed abutments.

        Edges are straight: halfway between joints that are delta apart [rad], an arch of one thickness is
        cos(delta / 2) times as thick as at the joints.

        Args:
            radius: of the middle of the arch at the joints [m], 0.01 to 1000.
            thickness: across the arch at the joints [m], 1e-5 to 1000, 0.001 to 1 times the radius; or a pair, at the
                springing and at the crown, between which it changes linearly with the angle.
            span_angle: angle between the two springings [rad], 0.1 to pi.
            voussoirs: how many, 1 to 1000. They are named `voussoir_0` and so on, from left to right.
            density: mass density [kg/m3], 100 to 30000.
            length: length out of the plane [m], 1e-3 to 1000.
            chords: straight edges of the intrados and of the extrados of a voussoir, 1 to 50. With two or more a
                voussoir is a `Compound`. Voussoirs times chords are at most 1000.
            ground: whether fixed ground lies under the lowest point of the abutments, two heights beyond them. Without
                it voussoirs that leave the arch fall on, and explicit steps name them.
            options: further arguments of `Masonry`.

        Raises:
            TypeError, ValueError: for a value outside its range, or as `Masonry` does.

        Examples:
            >>> arch = mr.Masonry.arch(radius=5.0, thickness=(0.9, 0.6), voussoirs=16)
            >>> sorted(round(joint.width, 2) for joint in arch.joints)[::8]
            [0.6, 0.75, 0.9]
        """
        voussoirs = require_whole("voussoirs", voussoirs, 1, 1000 // chords)
        blocks = curved(arch_of(radius, thickness, span_angle, voussoirs * chords, density, length), chords)
        return cls([*blocks, ground_below_all(blocks)] if require_flag("ground", ground) else blocks, **options)

    @classmethod
    def bridge(
        cls,
        radius: Radius,
        thickness: Thick,
        span_angle: SpanAngle = math.pi,
        voussoirs: Voussoirs = 17,
        *,
        spans: Annotated[int, Within(1, 50, whole=True)] = 1,
        pier_width: Size,
        pier_height: Annotated[float, Within(0.01, 1000, "m")],
        abutments: bool = True,
        density: Density = 2000.0,
        length: Length = 1.0,
        **options: Unpack[JointOptions],
    ) -> Self:
        """Equal arches side by side on piers: a bridge of several spans, or an arch on buttresses.

        Args:
            radius, thickness, span_angle, voussoirs: of each arch, as of `arch`.
            spans: how many arches, 1 to 50. Voussoirs are `span_0_voussoir_0` and so on, of one span `voussoir_0`.
            pier_width: between the springings of two arches [m], 0.01 to 1000, at least twice the width of a springing,
                once of one span. A pier is one block, `pier_1` that between the first two arches.
            pier_height: from the ground up to the springings [m], 0.01 to 1000.
            abutments: whether the outer arches end on fixed abutments; otherwise on piers of the same width.
            density: mass density [kg/m3], 100 to 30000.
            length: length out of the plane [m], 1e-3 to 1000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        arch = Span(radius, thickness, span_angle, voussoirs)
        return cls(bridge_of(spans, arch, (pier_width, pier_height), abutments, density, length), **options)

    @classmethod
    def barrel_vault(
        cls,
        radius: Radius,
        thickness: Thick,
        length: Annotated[float, Within(0.01, 1000, "m")],
        unit: Size,
        span_angle: SpanAngle = math.pi,
        courses: Annotated[int, Within(1, 1000, whole=True)] = 17,
        *,
        density: Density = 2000.0,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A barrel vault in space between two fixed abutments, its courses in running bond along y.

        Args:
            radius, thickness, span_angle: of its section, as of `arch`.
            length: along y [m], 0.01 to 1000.
            unit: length of a voussoir [m], 0.01 to 1000 and at most the length; units are made to fit.
            courses: voussoirs of the section, 1 to 1000. `voussoir_2_0` is the first of the third course.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        return cls(barrel_of(Span(radius, thickness, span_angle, courses), length, unit, density), **options)

    @classmethod
    def groin_vault(
        cls,
        radius: Radius,
        thickness: Thick,
        length: Size,
        unit: Size,
        span_angle: SpanAngle = math.pi,
        courses: Annotated[int, Within(1, 1000, whole=True)] = 17,
        *,
        cut: bool = False,
        density: Density = 2000.0,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A groin vault, or cross vault: two equal barrels that cross over a square bay, on four fixed piers.

        The webs are in running bond, and end at the groins, two vertical planes across the corners of the bay. The
        middle of the bay is x = y = 0. Its sides are front, where x is positive, back, left, where y is negative, and
        right; a pier is named by its two sides, `pier_front_right`.

        Args:
            radius, thickness, span_angle: of the section of a web, as of `arch`.
            length: of the sides of the bay [m], 0.01 to 1000, at least the span of the extrados.
            unit: length of a voussoir of the webs [m], 0.01 to 1000 and at most the length. `web_left_2_0` is the first
                of the third course of the left web, from its side inwards, and what is left of a course belongs to the
                groin.
            courses: voussoirs of the section of a web, 1 to 1000. An odd number has a keystone, with four arms.
            cut: whether the stones of a groin are cut along it, each of one web. Otherwise a stone of two arms, a
                `Compound`, belongs to both webs, `groin_front_right_0` above the pier, and binds them.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        return cls(groin_of(Span(radius, thickness, span_angle, courses), length, unit, cut, density), **options)

    @classmethod
    def running_bond(
        cls,
        length: Size,
        height: Size,
        unit: Unit,
        thickness: Length = 1.0,
        density: Density = 2000.0,
        *,
        halves: Bond | None = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A wall of units in running bond on the ground, which moves in the plane of its face.

        Args:
            length, height: of the wall [m], 0.01 to 1000. The height is a whole number of units. What is left of a
                course at its end is a piece of a unit.
            unit: length and height of a unit [m], 0.01 to 100.
            thickness: of the wall, out of the plane [m], 1e-3 to 1000.
            density: mass density [kg/m3], 100 to 30000.
            halves: the bond of a potential crack in the middle of each whole unit, which divides it in two, or None.
                The halves of `unit_2_0` are `unit_2_0a` and `unit_2_0b`, by which functions of the joint know them.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        wall = bonded_wall(length, height, unit, thickness, density, halves is not None)
        return cls(wall, **_halved(halves, options))

    @classmethod
    def shear_wall(
        cls,
        length: Size,
        height: Size,
        unit: Unit,
        thickness: Length = 1.0,
        density: Density = 2000.0,
        *,
        halves: Bond | None = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A wall in running bond between a fixed base and a loading beam, as laboratories press and shear it.

        Args:
            length, height, unit, thickness, density, halves: as of `running_bond`.
            options: further arguments of `Masonry`. The blocks are "base", the units as of `running_bond`, and "beam".
                Base and beam are fixed and reach a fifth of the length beyond the wall. The case leads the beam by
                `supports={"beam": (t, dx, dz)}`; it does not turn: dz presses the wall and dx shears it.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.

        Examples:
            >>> wall = mr.Masonry.shear_wall(0.8, 0.4, (0.2, 0.1), thickness=0.1)
            >>> wall.names[0], wall.names[-1], len(wall.free)
            ('base', 'beam', 18)
        """
        wall = bonded_wall(length, height, unit, thickness, density, halves is not None)
        return cls(between_beams(wall[1:]), **_halved(halves, options))

    @classmethod
    def between_floors(
        cls,
        wall: Block,
        load: FloorLoad,
        *,
        bearing: Bearing = None,
        crack: CrackHeight = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A wall that cracks between two floors, which hold it sideways, seen along its length.

        The inner face at the base is x = 0. The upper floor is a block with the mass of the load between two smooth
        guides, so that it may rise and not turn. It is anchored to the wall: its joint has a friction of 10, the
        largest there is.

        Args:
            wall, load, bearing, crack: as of `VerticalBending`.
            options: further arguments of `Masonry`; `friction` is that of the base and the crack. The blocks are
                "base", "lower", "upper", "floor", "inner_guide" and "outer_guide". All but the two of the wall and the
                floor are fixed.

        Raises:
            TypeError, ValueError: as `VerticalBending` or `Masonry` does.

        Examples:
            >>> strip = mr.Masonry.between_floors(mr.Block.from_size(0.3, 4.0), load=20e3)
            >>> round(float(mr.collapse_multiplier(strip).multiplier), 2)
            0.78
        """
        blocks = bending_between_floors(VerticalBending(wall, load, bearing, crack))
        return cls(blocks, **_by_word((("guide", 0.0), ("floor", 10.0)), options))

    @classmethod
    def between_sides(cls, bending: HorizontalBending, **options: Unpack[JointOptions]) -> Self:
        """A wall that cracks upright between two side walls, on a smooth bed.

        The inner face is x = 0, and the middle of the wall y = 0. A block at either end stands for a side wall: smooth
        guides hold it across the wall, and `effects=bending.tie` along it, up to the thrust.

        Args:
            bending: the wall, its crack and its thrust.
            options: further arguments of `Masonry`; `friction` is that of the ends and of the crack, see
                `HorizontalBending.friction`. The blocks are "ground", "left", "right", "side_0", "side_1" and four
                fixed guides.

        Raises:
            TypeError, ValueError: as `Masonry` does.

        Examples:
            >>> strip = mr.HorizontalBending(mr.Block.from_size(0.5, 2.0, 6.0), thrust=12e3)
            >>> blocks = mr.Masonry.between_sides(strip)
            >>> round(float(mr.collapse_multiplier(blocks, effects=strip.tie).multiplier), 4)
            0.068
        """
        require_kind("bending", bending, HorizontalBending)
        return cls(bending_between_sides(bending), **_by_word((("guide", 0.0), ("ground", 0.0)), options))

    @classmethod
    def wallette(
        cls,
        length: Size,
        height: Size,
        unit: Unit,
        thickness: Length,
        density: Density = 2000.0,
        *,
        leaves: Annotated[int, Within(1, 10, whole=True)] = 1,
        headers: Annotated[int, Within(0, 1000, whole=True)] = 0,
        beam: bool = True,
        halves: Bond | None = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A wall in running bond in space on a fixed base, as laboratories load it out of its plane.

        Its length runs along y, and its outer face is x = 0, as that of a facade.

        Args:
            length, height, unit, thickness, density, halves: as of `running_bond`; units of several leaves are whole.
            leaves: wythes beside each other through the thickness, 1 to 10. The joints between them have the normal x,
                so that a function of the joint gives them a bond of their own.
            headers: every so many courses, 0 to 1000, one of headers, half a unit long, that go through all leaves;
                0 for none.
            beam: whether a fixed beam lies on it, which the case leads by `supports={"beam": (t, dx, dy, dz)}`.
            options: further arguments of `Masonry`. The blocks are "base", the units as of `running_bond` with the
                number of the leaf or a letter of the header, and "beam".

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.

        Examples:
            >>> wall = mr.Masonry.wallette(0.8, 0.4, (0.2, 0.1), 0.2, leaves=2, headers=4)
            >>> wall.names[1], wall.names[-2], len(wall.free)
            ('unit_0_0_0', 'unit_3_4', 34)
        """
        if halves is not None and (leaves, headers) != (1, 0):
            raise ValueError(
                f"halves with leaves = {leaves} and headers = {headers}: units of several leaves are whole"
            )
        wall = bonded_wall(length, height, unit, thickness, density, halves is not None)
        flat = between_beams(wall[1:])
        blocks = wallette_of(flat if require_flag("beam", beam) else flat[:-1], unit[0], leaves, headers)
        return cls(blocks, **_halved(halves, options))

    @classmethod
    def box(cls, size: Extents, *, density: Density = 2000.0, **options: Unpack[JointOptions]) -> Self:
        """One box, `block`, on the ground, in the middle of it.

        Args:
            size: its extents along x, y and z [m], 1e-3 to 10000 each.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        return cls(box_on_ground(size, density), **options)

    @classmethod
    def column(
        cls,
        width: Annotated[Taper, Within(0.01, 100, "m")],
        height: Annotated[float, Within(0.01, 1000, "m")],
        drums: Annotated[int, Within(1, 1000, whole=True)],
        *,
        sides: Annotated[int, Within(3, 100, whole=True)] = 4,
        density: Density = 2000.0,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A column of drums of equal height on the ground.

        Args:
            width: diameter of the circle within the section [m], 0.01 to 100: the side of a square. A pair is that of
                the bottom and of the top of a column that tapers.
            height: of the column [m], 0.01 to 1000.
            drums: how many, 1 to 1000, each of a height of 0.01 to 100 widths. They are named `drum_0` and so on, from
                the lowest upwards.
            sides: of the section, a regular polygon, 3 to 100. A square one has its sides along x and y.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        return cls(column_of(width, height, drums, sides, density), **options)

    @classmethod
    def dome(
        cls,
        radius: Annotated[float, Within(0.1, 1000, "m")],
        thickness: Thick,
        lunes: Annotated[int, Within(4, 360, whole=True)],
        hoops: Annotated[int, Within(1, 360, whole=True)],
        *,
        oculus: Annotated[float, Within(0.01, 1.5, "rad")] = 0.05,
        density: Density = 2000.0,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A hemispherical dome of voussoirs with plane faces, which springs from the ground.

        Args:
            radius: of the middle of the thickness at the corners of the voussoirs [m], 0.1 to 1000.
            thickness: [m], 1e-5 to 1000, 0.001 to 1 times the radius; or a pair, at the springing and at the oculus,
                between which it changes linearly with the angle.
            lunes: how many voussoirs a hoop has, 4 to 360.
            hoops: how many hoops of equal angles, 1 to 360. `voussoir_0_3` is the fourth of the lowest hoop.
            oculus: angle at the centre between the axis and the edge of the opening at the crown [rad], 0.01 to 1.5.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        return cls(dome_of(radius, thickness, lunes, hoops, oculus, density), **options)

    @classmethod
    def facade(
        cls,
        length: Size,
        height: Size,
        depth: Annotated[float, Within(0, 1000, "m")],
        unit: Unit,
        *,
        thickness: Annotated[float | None, Within(0.01, 10, "m")] = None,
        returns: str = "both",
        openings: Sequence[tuple[Annotated[float, COORDINATE], Opening]] = (),
        gable: int = 0,
        ground: Polyhedron | None = None,
        density: Density = 2000.0,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A facade and return walls behind it, on the ground.

        All walls are one unit thick and in running bond, by half a unit. In every second course the return walls come
        through to the face of the facade as headers. Units are made to fit: their length and height are the nearest to
        those asked for that divide the walls. The face of the facade is x = 0, and the middle of its length is y = 0.
        Blocks are named `facade_`, `left_` and `right_` with the course and a number in it.

        Args:
            length: of the facade with its corners [m], 0.01 to 1000.
            height: of the walls [m], 0.01 to 1000.
            depth: of the return walls with the thickness of the facade [m], 0 to 1000; without any it
                plays no part.
            unit: length and height of a unit [m], 0.01 to 100.
            thickness: of all walls [m], 0.01 to 10; None is half the length of a unit.
            returns: where return walls are: "both" ends, "left" where y is negative, "right" or "none".
            openings: pairs of the y of the middle of an opening [m], -10000 to 10000, and the `Opening`. They cut
                units. A lintel of half a course or more lies over each, up to a bed joint, and bears on half a unit on
                either side.
            gable: courses above the walls, each of which is a unit shorter than the one below, 0 to as many as there
                are. The first is as long as the facade, or shorter by the corners over an odd number of courses.
            ground: a fixed block with its upper face at z = 0; None is ground that reaches two heights beyond.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, an opening that does not fit, or as `Masonry` does.
        """
        require_kind("ground", ground, Polyhedron, type(None))
        walls = walls_of(length, height, depth, unit, thickness=thickness, returns=returns, gable=gable)
        return cls(facade_of(walls, openings, density, ground), **options)

    @classmethod
    def corner(
        cls,
        thickness: Annotated[float, Within(0.01, 10, "m")],
        height: Annotated[float, Within(0.1, 100, "m")],
        angle: Annotated[float, Within(0, 1.4, "rad")] = 0.0,
        *,
        density: Annotated[float, Within(100, 30000, "kg/m3")] = 2000.0,
        **options: Unpack[JointOptions],
    ) -> Self:
        """A corner of two walls that overturns with a wedge of either, from smooth cracks.

        The outer faces are x = 0 and y = 0, and the walls go towards -x and y. Along its diagonal, which is
        `angle=-math.pi / 4` of `push` and `collapse_multiplier`, the corner turns about its outer edge at the origin.
        Across one wall it turns about the outer face of that, at 1 / sqrt(2) of the multiplier below. With t the
        thickness, h the height and p = h tan(angle) the length of a wedge at the top,

            alpha_0 = [t^2 + p (3 t / 2 + p / 3)] / (sqrt(2) h (t / 2 + 2 p / 3)).

        Args:
            thickness: of both walls [m], 0.01 to 10.
            height: of the storey that turns [m], 0.1 to 100.
            angle: of the cracks from the vertical [rad], 0 to 1.4. Without wedges the post in the corner turns alone.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`; `friction` is that of the base. The blocks are "ground", "corner",
                and "rest_0" and "rest_1", what stays of the walls. All but the corner are fixed.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.

        Examples:
            >>> corner = mr.Masonry.corner(0.5, 4.0, angle=math.radians(30))
            >>> round(float(mr.collapse_multiplier(corner, angle=-math.pi / 4).multiplier), 4)
            0.3714
        """
        return cls(wall_corner(thickness, height, angle, density), **_by_word((("rest", 0.0),), options))

    @classmethod
    def from_obj(
        cls,
        path: AnyPath,
        fixed: Sequence[str] = (),
        *,
        ground: bool = False,
        density: Density = 2000.0,
        scale: Scale = None,
        unit: str | None = None,
        up: str | None = None,
        convex: str | None = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """Blocks of a Wavefront OBJ file: its objects, or the groups of them.

        Every body has to be closed, and to touch another within the `tolerance`. A support may be an open plate: it
        becomes a fixed block behind its face, a tenth of its extent thick.

        Args:
            path: of the file. Several bodies of one object are numbered.
            fixed: names of the bodies that are fixed.
            ground: whether fixed ground is put under the lowest point.
            density: mass density of blocks whose file says none [kg/m3], 100 to 30000.
            scale: length of a unit of the file [m], 1e-6 to 1e3: 0.001 for millimetres. None takes the `unit`.
            unit: of the file, "m", "cm", "mm", "in" or "ft", in the place of `scale`. None is m.
            up: axis of the file that points upwards, "x", "y" or "z": the file is turned until that is z. Blender and
                glTF have "y". None is "z", and odd masonry is doubted.
            convex: what becomes of a body that is not convex. "hull" takes its convex hull and warns of the volume that
                is added. "parts" cuts it along the planes of its faces into a `Compound`, which fills the same volume.
                None refuses it.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: if the file is not valid, or a body is open, not convex or touches no other; the message names
                both. Or as `Masonry` does.

        Warns:
            Implausible: as `Masonry` does, for masonry that seems to stand along another axis, and for faces that lie
                as little apart as twenty tolerances. A UserWarning says what volume hulls add.
        """
        return cls._read(read_obj, path, density, Given(fixed, ground, scale, unit, up, convex), options)

    @classmethod
    def from_stl(
        cls,
        path: AnyPath,
        fixed: Sequence[str] = (),
        *,
        ground: bool = False,
        density: Density = 2000.0,
        scale: Scale = None,
        unit: str | None = None,
        up: str | None = None,
        convex: str | None = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """Blocks of an STL file, binary or text: its solids, or the closed bodies that it lists one after the other.

        Args:
            path: of the file. Bodies without a name are `body_0` and so on.
            fixed, ground, density, scale, unit, up, convex, options: as of `from_obj`.

        Raises:
            ValueError: as `from_obj` does.
        """
        return cls._read(read_stl, path, density, Given(fixed, ground, scale, unit, up, convex), options)

    @classmethod
    def from_ply(
        cls,
        path: AnyPath,
        fixed: Sequence[str] = (),
        *,
        ground: bool = False,
        density: Density = 2000.0,
        scale: Scale = None,
        unit: str | None = None,
        up: str | None = None,
        convex: str | None = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """Blocks of a PLY file, binary or text: the closed bodies that it lists one after the other.

        Args:
            path: of the file. Bodies are `body_0` and so on, or `body` where there is one.
            fixed, ground, density, scale, unit, up, convex, options: as of `from_obj`.

        Raises:
            ValueError: as `from_obj` does.
        """
        return cls._read(read_ply, path, density, Given(fixed, ground, scale, unit, up, convex), options)

    @classmethod
    def from_compas(
        cls,
        path: AnyPath,
        fixed: Sequence[str] = (),
        *,
        ground: bool = False,
        density: Density = 2000.0,
        scale: Scale = None,
        unit: str | None = None,
        up: str | None = None,
        convex: str | None = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """Blocks of a JSON file of COMPAS: a `BlockModel` of compas_dem, a problem that holds one, an `Assembly` of
        compas_assembly, also of COMPAS 0 and 1, or a list of meshes. Its supports are fixed.

        Args:
            path: of the file.
            fixed: names of further bodies that are fixed.
            ground, density, scale, unit, up, convex, options: as of `from_obj`. A density of the material of a block
                comes first.

        Raises:
            ValueError: as `from_obj` does.
        """
        return cls._read(read_compas, path, density, Given(fixed, ground, scale, unit, up, convex), options)

    @classmethod
    def from_lmgc90(
        cls,
        path: AnyPath,
        fixed: Sequence[str] = (),
        *,
        ground: bool = False,
        density: Density = 2000.0,
        scale: Scale = None,
        unit: str | None = None,
        up: str | None = None,
        convex: str | None = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """Blocks of the input of LMGC90: bodies RBDY3 with one polyhedron POLYR each. Bodies that are held are fixed.

        Joints are those of mjrock: laws of contact, loads and gravity of the folder are not read.

        Args:
            path: of a folder DATBOX with BODIES.DAT, BULK_BEHAV.DAT, DRV_DOF.DAT and DOF.INI, or of its BODIES.DAT.
            fixed: names of further bodies that are fixed, such as "body_1".
            ground, density, scale, unit, up, convex, options: as of `from_obj`. A density of the material of a body
                comes first.

        Raises:
            ValueError: as `from_obj` does; for bodies of other kinds or of several polyhedra, or driven ones.

        Warns:
            UserWarning: of planes, spheres and other shapes, which are left out, and where one of the files is missing.
        """
        return cls._read(read_lmgc90, path, density, Given(fixed, ground, scale, unit, up, convex), options)

    @classmethod
    def from_meshes(
        cls,
        meshes: Mapping[str, tuple[ArrayLike, Sequence[Sequence[int]]]],
        fixed: Sequence[str] = (),
        *,
        ground: bool = False,
        density: Density = 2000.0,
        scale: Scale = None,
        unit: str | None = None,
        up: str | None = None,
        convex: str | None = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """Blocks of meshes that another library has read, such as those of IFC, glTF or Blender.

        Args:
            meshes: by the names of bodies, vertices, shape (n, 3), and faces, numbers of the vertices around each.
            fixed, ground, density, scale, unit, up, convex, options: as of `from_obj`.

        Raises:
            TypeError, ValueError: for what is no mesh, or as `from_obj` does.
        """
        return cls._of_meshes(meshes_of(meshes), density, Given(fixed, ground, scale, unit, up, convex), options)

    @classmethod
    def from_dxf(
        cls,
        path: AnyPath,
        fixed: Sequence[str] = (),
        *,
        ground: bool = False,
        density: DensityOfLayer = 2000.0,
        length: LengthOfLayer = 1.0,
        scale: Scale = None,
        unit: str | None = None,
        up: str | None = None,
        convex: str | None = None,
        layers: Sequence[str] | None = None,
        **options: Unpack[JointOptions],
    ) -> Self:
        """Blocks of a drawing in DXF: its closed polylines, seen from the front. Needs `pip install ezdxf`.

        x of the drawing is x, and y points upwards. A block has the name of its layer and a number, `stone_0`, by which
        functions of the joint know it. Inserted blocks of the drawing are taken too, and all else is left out.

        Args:
            path: of the file.
            fixed: layers, and names of blocks, that are fixed.
            ground: whether fixed ground is put under the lowest point.
            density: mass density [kg/m3], 100 to 30000; or one for each layer, {"stone": 2400.0, "brick": 1800.0}.
            length: out of the plane [m], 1e-3 to 1000, or one for each layer.
            scale, unit: of the drawing, as of `from_obj`; None takes what its header says, or m.
            up: axis of the drawing that points upwards; None is "y". With "z" an elevation is drawn in the plane x, z.
            convex: what becomes of an outline that is not convex, as of `from_obj`.
            layers: those that are read; None reads all.
            options: further arguments of `Masonry`.

        Raises:
            ImportError: if ezdxf is missing.
            ValueError: if the file is not valid, for inserted blocks that hold each other or are too many, for a
                polyline that is open, has arcs or is not convex, or a block that touches no other; the message names
                it. Or as `Masonry` does.

        Warns:
            UserWarning: if the drawing is damaged and was repaired while it was read, or holds splines, hatches or
                other areas, which are left out.
        """
        given, path = Given(fixed, ground, scale, unit, up, convex).checked(), require_path("path", path)
        asked = None if layers is None else names_of_list("layers", layers)
        with about(f"path = {path}"):
            drawing = read_dxf(path, asked)
            try:
                blocks = polygons_of(drawing, given, density, length)
                if given.ground:
                    blocks.insert(0, ground_below_all(blocks))
                masonry = cls(blocks, **options)._touching()
            except ValueError as error:
                drawn = {outline.name: outline.corners for outline in drawing.outlines}
                raise with_sizes(error, drawn, given.matrix(drawing.unit or 1.0)) from None
        if drawing.unit not in (None, 1.0) and unit is None and scale is None and masonry._odd_sizes:
            stated = f"its header says that its unit is {drawing.unit:g} m, which a template may have left there"
            warn_of(f"path = {path}: {stated}; unit= takes another")
        return masonry

    def to_obj(self, path: AnyPath) -> Path:
        """Write the blocks to an OBJ file, an object each, in metres. Density and supports are not kept.

        Raises:
            ValueError: for blocks in the plane, or a `Compound`.
        """
        return write_text(require_path("path", path), obj_text(self.convex_in_space("an OBJ file"), self.names))

    def to_compas(self, path: AnyPath) -> Path:
        """Write the blocks to the JSON file of a COMPAS model, with supports and densities, in metres.

        Raises:
            ValueError: for blocks in the plane, or a `Compound`.
        """
        return write_text(require_path("path", path), compas_text(self.convex_in_space("a COMPAS model"), self.names))

    @classmethod
    def _read(
        cls,
        read: Callable[[Path], list[Mesh]],
        path: AnyPath,
        density: float,
        given: Given,
        options: JointOptions,
    ) -> Self:
        """Masonry of the meshes that a reader finds in a file."""
        given, path = given.checked(), require_path("path", path)
        with about(f"path = {path}"):
            return cls._of_meshes(read(path), density, given, options)

    @classmethod
    def _of_meshes(cls, meshes: Sequence[Mesh], density: float, given: Given, options: JointOptions) -> Self:
        """Masonry of meshes."""
        given = given.checked()
        try:
            blocks = blocks_of(meshes, density, given)
            if given.ground:
                corners = np.concatenate([block.corners for block in blocks])
                blocks.insert(0, ground_below(corners.min(axis=0), corners.max(axis=0)))
            masonry = cls(blocks, **options)._touching()
        except ValueError as error:
            raise with_sizes(error, {mesh.name: mesh.vertices for mesh in meshes}, given.matrix()) from None
        if given.up is None and (odd := odd_axis(masonry.blocks, masonry.space_joints, given.ground)):
            warn_of(odd, Implausible)
        return masonry

    def convex_in_space(self, what: str) -> list[Polyhedron]:
        """The blocks. A ValueError says what takes convex blocks in space alone, if they are in the plane or not
        convex."""
        if not self.in_space:
            raise ValueError("blocks = blocks in the plane have no such file; make them bodies with Polyhedron.prism")
        if compounds := [n for n, block in zip(self.names, self.blocks, strict=True) if isinstance(block, Compound)]:
            raise ValueError(f"blocks: {what} takes convex blocks, and {named(compounds)} has several parts")
        return [block for block in self.blocks if isinstance(block, Polyhedron)]

    def _touching(self) -> Self:
        """Itself. A ValueError names the blocks that are not fixed and have no joint, and the nearest gap.

        It warns of faces that lie a little farther apart than the tolerance.
        """
        touching = {i for joint in self.joints for i in (joint.below, joint.above)}
        loose = [i for i in self.free if i not in touching]
        if loose:
            raise ValueError(
                f"{named([self.names[i] for i in loose])} touch no other block within {self._reach_said}; "
                f"{smallest_gap(self.blocks, self.names, loose, self._joints_within, self.reach)}"
            )
        wider = min(NEARLY * self.tolerance, WIDEST_TOLERANCE)
        tries = [(wider, wider)] + ([(FINE_TOLERANCE, self.reach)] if self.tolerance > FINE_TOLERANCE else [])
        for tolerance, gap in tries:
            apart = not_joined(self.blocks, self.joints, gap)
            with suppress(OverlapError):
                found = self._joints_with(tolerance, gap, apart)
                if odd := nearly([joint.name for joint in found], gap, self.tolerance):
                    warn_of(odd, Implausible)
        return self


def blocks_of_one_kind(blocks: Sequence[AnyBlock]) -> tuple[AnyBlock, ...]:
    """The blocks of masonry, all of the plane or all in space, with names of their own.

    Raises:
        TypeError, ValueError: for what is no block, for both kinds, too few or too many, or names that stand twice.
    """
    require_sequence("blocks", blocks, "a list of blocks")
    for i, block in enumerate(blocks):
        if not isinstance(block, Polygon | Polyhedron | Compound):
            raise TypeError(f"blocks[{i}] = {shown(block)} is not a Polygon, Polyhedron or Compound")
        if block.in_space != blocks[0].in_space:
            which = [f"{type(b).__name__} {'in space' if b.in_space else 'of the plane'}" for b in (block, blocks[0])]
            raise TypeError(f"blocks[{i}] is a {which[0]}, and blocks[0] is a {which[1]}; give blocks of one kind")
    free = sum(not block.fixed for block in blocks)
    name = names_of(blocks)[0] if blocks else ""
    remedy = f"; of a file fixed=[{name!r}] names a support, and ground=True puts ground under all" * (free > 0)
    if not 0 < free < len(blocks) <= MOST_BODIES:
        raise ValueError(
            f"blocks = {free} free and {len(blocks) - free} fixed; at least one of each and at most {MOST_BODIES} are "
            f"needed{remedy}"
        )
    for name, number in Counter(names_of(blocks)).items():
        if number > 1:
            raise ValueError(f"blocks: {number} of them have the name {name}")
    return tuple(blocks)


def _by_word(words: tuple[tuple[str, float], ...], options: JointOptions) -> Properties:
    """Properties of joints, with the friction of those that have a word in their names."""
    given = one_by_one(options)
    return given | {"friction": ByWord(words, Dry.friction if given["friction"] is None else given["friction"])}


def _halved(halves: Bond | None, options: JointOptions) -> Properties:
    """Keywords of masonry whose units are divided by a bond, or not."""
    require_kind("halves", halves, Bond, type(None))
    given = one_by_one(options)
    return given if halves is None else given | {"bond": Halved(given["bond"], halves)}
