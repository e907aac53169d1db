"""Masonry of many blocks, and the joints where their edges touch."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Self, Unpack

import numpy as np

from ...contacts.files import write_text
from ...geometry.frames import PLANE, SPACE, Freedom
from ...notebook import NotebookPicture
from ...quantities import (
    Array,
    Implausible,
    Integers,
    Within,
    frozen,
    keep,
    named,
    require_path,
    require_sequence,
    shown,
    warn_of,
)
from ..damping.contacts import AnyLaw, required_law
from ..wall.block import Block
from ..wall.effects import SideStop
from .blocks.compound import AnyBlock, Compound, FlatBlock, SolidBlock
from .blocks.joints import Joint, OverlapError, joints_in_plane, names_of
from .blocks.joints_in_space import SpaceJoint, joints_in_space
from .blocks.polygon import Polygon
from .blocks.polyhedron import Polyhedron
from .builders.in_plane import MOST_BODIES, ground_below_all, stack
from .builders.in_space import ground_below
from .constructors import Constructors
from .drawing import (
    DOUBTED_GAP,
    FINE_TOLERANCE,
    WIDEST_TOLERANCE,
    along_lines,
    nearly_joined,
    not_joined,
    odd_axis,
    odd_damping,
    odd_frequency,
    odd_sizes,
    remedy,
    sizes_in_errors,
    smallest_gap,
    split_faces,
    touches_text,
)
from .files.bodies import AnyPath, FileOptions, Mesh, Scale, about, blocks_of, meshes_of, required_names
from .files.compas import compas_text
from .files.dxf import DensityOfLayer, LengthOfLayer, polygons_of, read_dxf
from .files.meshes import obj_text
from .laws.bond import Bond
from .laws.dry import AnyPairs, PairProperties, requested_pair, required_pairs
from .laws.joint_table import (
    PROPERTIES,
    AnyJoints,
    ByKind,
    ByName,
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


@keywords_checked
@dataclass(frozen=True, repr=False, init=False)
class Masonry(Constructors, NotebookPicture):
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
            `Compound` of these; at least one fixed and one that is not, at most 25000.
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
            with 2, 1.5 with 3, 1.031 with 9. In space this holds for a rectangle about both axes; a triangle on its
            corners is 4 times as stiff. A joint with a bond takes 3 or more, and shares its area out to them so that it
            is as stiff as k_n I. A joint that has slid keeps its lines and k_n, on the part of its faces that still
            lies over each other.
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
            is called once for each joint. The joints that are found are then `joints`.
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
        properties = {"k_n": k_n, "friction": friction, "xi": xi, "frequency": frequency, "points": points, "k_s": k_s}
        keep(self, **properties_of(joints, properties | {"bond": bond}))
        if not self.joints:
            side = "a face" if self.in_space else "an edge"
            raise ValueError(
                f"blocks: no two of them touch along {side} within {self._reach_text}; "
                f"{smallest_gap(self.blocks, self.names, self.free, self._joints_within, self.reach)}"
            )
        if law is not None:
            keep(self, law=required_law(law))
        if len(counts := set(self.table.points.tolist())) == 1:
            keep(self, points=counts.pop())
        for doubt in self._remarks():
            warn_of(doubt, Implausible)

    def __repr__(self) -> str:
        corners = np.concatenate([self.blocks[i].corners for i in self.free])
        size = " x ".join(f"{extent:.4g}" for extent in np.ptp(corners, axis=0))
        omitted = {"k_s": np.isinf(self.joint_shear).all(), "xi": self.law is not None}
        names = (name for name in ("k_n", "k_s", "friction", "xi", "points") if not omitted.get(name))
        properties = ((name, getattr(self, name)) for name in names)
        parts = [f"{name} of the joint" if callable(value) else f"{name} = {value:g}" for name, value in properties]
        if self.law is not None:
            parts.insert(-1, f"law {getattr(self.law, 'name', getattr(self.law, '__name__', 'given'))}")
        bonded = ", mortar" if any(isinstance(bond, Bond) for bond in self.bonds) else ""
        bonded += ", laws of their own" if any(isinstance(bond, Own) for bond in self.bonds) else ""
        return f"<Masonry of {len(self.free)} blocks, {size} m: {', '.join(parts)}{bonded}>"

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
        """Raise a ValueError that says what takes plain joints alone, see `JointTable.require_known`."""
        self.table.require_known(what, self.joints)

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
    def _reach_text(self) -> str:
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
        properties = {name: getattr(self, name) for name in PROPERTIES}
        table = JointTable.from_properties(self.joints, properties)
        if self.law is None:
            return table
        if (known := table.frequency[~np.isnan(table.frequency)]).size:
            raise ValueError(f"frequency = {known[0]:g} rad/s is given with a law, which has its own; leave it")
        xi, frequency = damping_by_law(self.blocks, self.joints, table.k_n, table.points, self.law)
        return table._replace(xi=xi, frequency=frequency)

    def without_functions(self) -> Self:
        """The same with the values of its joints by their names in the place of functions of the joint, which no file
        can hold. What a file can hold is left as it is, and so is `pairs`."""
        properties = {name: getattr(self, name) for name in PROPERTIES}
        by_name: dict[str, ByName | None] = {
            name: self._by_name(map(value, self.joints)) for name, value in properties.items() if has_function(value)
        }
        if has_function(self.law):
            damping = {name: self._by_name(getattr(self.table, name).tolist()) for name in ("xi", "frequency")}
            by_name |= {"law": None, **damping}
        if not by_name:
            return self
        copy = object.__new__(type(self))
        keep(copy, **{entry.name: getattr(self, entry.name) for entry in fields(self)} | by_name)
        return copy

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

    def of_pair(self, one: int, other: int) -> PairProperties | None:
        """What two blocks without a joint have where they meet, by their numbers, or None where nothing is given."""
        dry = requested_pair(self.pairs, self.names[min(one, other)], self.names[max(one, other)])
        if dry is None:
            return None
        frequency = dry.frequency or (self._lowest_frequency if dry.xi else 1.0)
        return PairProperties(dry.friction, 2 * dry.xi / frequency)

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
        lowest = np.isnan(frequency)
        return np.asarray(2 * xi / (np.where(lowest, self._lowest_frequency, frequency) if lowest.any() else frequency))

    @cached_property
    def _lowest_frequency(self) -> float:
        along = self.table.k_s[self.lines.joint] * self.areas_of(self.lines.k, self.lines.joint)
        return lowest_frequency(self.blocks, self.lines, self.table.friction, along)

    @cached_property
    def _odd_sizes(self) -> str:
        """What is odd about the sizes of its free blocks, in words, empty where nothing is."""
        return odd_sizes({self.names[i]: 2 * self.blocks[i].size for i in self.free})

    def _remarks(self) -> list[str]:
        """What is odd about it, in words, empty where nothing is. Its table is made, and so checked, for that."""
        xi, frequency = self.table.xi, self.table.frequency
        at_lowest, doubt = np.isnan(frequency), ""
        if self.law is None and not at_lowest.all():
            i = int(np.where(at_lowest, -1.0, xi / frequency).argmax())
            lowest = self._lowest_frequency if xi[i] else 0.0
            doubt = odd_frequency(float(xi[i]), float(frequency[i]), lowest)
        sizes, faces = self._odd_sizes, split_faces(self.joints, self.blocks, self.names)
        touches = along_lines(self.blocks, self.joints, self.tolerance)
        unjoined = f"without a joint {touches_text(touches, self.names)}" if touches else ""
        return [text for text in (doubt, odd_damping(xi[at_lowest]), sizes, faces, unjoined) if text]

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
            blocks, ground, side_stop: as of `blocks.stack`.
            k_n: stiffness of the joints [N/m3], as of `Masonry`.
            k_side: stiffness of the joints with the side stop [N/m3], 1e4 to 1e14; None takes k_n.
            side_friction: their coefficient of friction [-], 0 to 10. A smooth one is what the laws were fitted for.
            options: further arguments of `Masonry`, such as `law`, `xi` and `friction`. With a side stop the xi of all
                joints refers to the lowest natural frequency without it.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        polygons = stack(blocks, ground, side_stop)
        properties = one_by_one({**options, "k_n": k_n})
        if not side_stop:
            if k_side is not None or side_friction:
                raise ValueError("k_side and side_friction need a side stop; give side_stop=True")
            return cls(polygons, **properties)
        frequency = properties["frequency"]
        if properties.get("law") is None and (frequency is None or callable(frequency)):
            without_side = cls(polygons[:-1], **properties)
            lowest = lowest_frequency(without_side.blocks, without_side.lines, without_side.joint_friction)
            properties["frequency"] = OrElse(frequency, lowest) if callable(frequency) else lowest
        properties["k_n"] = ByKind(properties["k_n"], k_side or properties["k_n"])
        properties["friction"] = ByKind(properties["friction"], side_friction)
        return cls(polygons, **properties)

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
        file = FileOptions(fixed, ground=ground, scale=scale, unit=unit, up=up, convex=convex)
        path, read_layers = require_path("path", path), None if layers is None else required_names("layers", layers)
        with about(f"path = {path}"):
            drawing = read_dxf(path, read_layers)
            drawn = {outline.name: outline.corners for outline in drawing.outlines}
            with sizes_in_errors(drawn, file.matrix(drawing.unit or 1.0)):
                blocks = polygons_of(drawing, file, density, length)
                masonry = cls([ground_below_all(blocks), *blocks] if ground else blocks, **options)._touching()
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
    def _of_meshes(
        cls, read: Callable[[Any], list[Mesh]], source: object, file: FileOptions, options: JointOptions
    ) -> Self:
        """Masonry of the meshes that a reader finds in a file, or in meshes that a caller has."""
        if read is not meshes_of:
            source = require_path("path", source)
        with about(f"path = {source}") if isinstance(source, Path) else nullcontext():
            meshes = read(source)
            with sizes_in_errors({mesh.name: mesh.vertices for mesh in meshes}, file.matrix()):
                blocks = blocks_of(meshes, file)
                if file.ground:
                    corners = np.concatenate([block.corners for block in blocks])
                    blocks.insert(0, ground_below(corners.min(axis=0), corners.max(axis=0)))
                masonry = cls(blocks, **options)._touching()
        if file.up is None and (doubt := odd_axis(masonry.blocks, masonry.space_joints, file.ground)):
            warn_of(doubt, Implausible)
        return masonry

    def convex_in_space(self, what: str) -> list[Polyhedron]:
        """The blocks, for what takes convex ones in space alone.

        Raises:
            ValueError: with what takes them, if they are in the plane or not convex.
        """
        if not self.in_space:
            raise ValueError(
                f"blocks are in the plane, and {what} takes blocks in space; make them bodies with Polyhedron.prism"
            )
        if compounds := [n for n, block in zip(self.names, self.blocks, strict=True) if isinstance(block, Compound)]:
            raise ValueError(f"blocks: {what} takes convex blocks, and {named(compounds)} has several parts")
        return [block for block in self.blocks if isinstance(block, Polyhedron)]

    def _touching(self) -> Self:
        """Itself, with a warning of faces that lie a little farther apart than the tolerance.

        Raises:
            ValueError: for blocks that are not fixed and have no joint, with their names and the nearest gap.
        """
        touching = {i for joint in self.joints for i in (joint.below, joint.above)}
        loose = [i for i in self.free if i not in touching]
        if loose:
            raise ValueError(
                f"{named([self.names[i] for i in loose])} touch no other block within {self._reach_text}; "
                f"{smallest_gap(self.blocks, self.names, loose, self._joints_within, self.reach)}"
            )
        wider = min(DOUBTED_GAP * self.tolerance, WIDEST_TOLERANCE)
        tries = [(wider, wider)] + ([(FINE_TOLERANCE, self.reach)] if self.tolerance > FINE_TOLERANCE else [])
        for tolerance, gap in tries:
            unjoined = not_joined(self.blocks, self.joints, gap)
            with suppress(OverlapError):
                nearly = self._joints_with(tolerance, gap, unjoined)
                if doubt := nearly_joined([joint.name for joint in nearly], gap, self.tolerance):
                    warn_of(doubt, Implausible)
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
            kinds = [f"{type(b).__name__} {'in space' if b.in_space else 'of the plane'}" for b in (block, blocks[0])]
            raise TypeError(f"blocks[{i}] is a {kinds[0]}, and blocks[0] is a {kinds[1]}; give blocks of one kind")
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
