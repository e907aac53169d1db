"""The class methods that build masonry, as `python tests/house/stubs.py` writes them."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Self, Unpack

from numpy.typing import ArrayLike

from mjrock.problem.masonry.blocks.polygon import COORDINATE
from mjrock.problem.masonry.blocks.polyhedron import Extents, Polyhedron
from mjrock.problem.masonry.builders.in_plane import Length, Radius, Size, SpanAngle, Taper, Thick, Unit, Voussoirs
from mjrock.problem.masonry.files.bodies import AnyPath, Scale
from mjrock.problem.masonry.laws.bond import Bond
from mjrock.problem.masonry.laws.joint_table import JointOptions
from mjrock.problem.wall.bending import Bearing, CrackHeight, FloorLoad, HorizontalBending
from mjrock.problem.wall.block import Block
from mjrock.problem.wall.section import Opening
from mjrock.quantities import Density, Within

class Constructors:
    """Class methods of `Masonry` that build it. Each has the arguments of its builder or reader, and the keywords of
    `Masonry`."""

    @classmethod
    def arch(
        cls,
        radius: Radius,
        thickness: Thick,
        span_angle: SpanAngle = 3.141592653589793,
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
            TypeError, ValueError: for a value outside its range.
            ValueError: as `Masonry` does.

        Examples:
            >>> arch = mr.Masonry.arch(radius=5.0, thickness=(0.9, 0.6), voussoirs=16)
            >>> sorted(round(joint.width, 2) for joint in arch.joints)[::8]
            [0.6, 0.75, 0.9]
        """

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

        `friction` of `Masonry` is that of the base and the crack. The blocks are "base", "lower", "upper", "floor",
        "inner_guide" and "outer_guide". All but the two of the wall and the floor are fixed.

        Args:
            wall, load, bearing, crack: as of `VerticalBending`.
            options: further arguments of `Masonry`.

        Raises:
            TypeError, ValueError: as `VerticalBending` does.
            ValueError: as `Masonry` does.

        Examples:
            >>> strip = mr.Masonry.between_floors(mr.Block.from_size(0.3, 4.0), load=20e3)
            >>> round(float(mr.collapse_multiplier(strip).multiplier), 2)
            0.78
        """

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
            ValueError: for a value outside its range.
            ValueError: as `Masonry` does.
        """

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

        The blocks are "base", the units as of `running_bond`, and "beam". Base and beam are fixed and reach a fifth of
        the length beyond the wall. The case leads the beam by `supports={"beam": (t, dx, dz)}`; it does not turn: dz
        presses the wall and dx shears it.

        Args:
            length, height, unit, thickness, density, halves: as of `running_bond`.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range.
            ValueError: as `Masonry` does.

        Examples:
            >>> wall = mr.Masonry.shear_wall(0.8, 0.4, (0.2, 0.1), thickness=0.1)
            >>> wall.names[0], wall.names[-1], len(wall.free)
            ('base', 'beam', 18)
        """

    @classmethod
    def between_sides(cls, bending: HorizontalBending, **options: Unpack[JointOptions]) -> Self:
        """A wall that cracks upright between two side walls, on a smooth bed.

        The inner face is x = 0, and the middle of the wall y = 0. A block at either end stands for a side wall: smooth
        guides hold it across the wall, and `effects=bending.tie` along it, up to the thrust.

        `friction` of `Masonry` is that of the ends and of the crack, see `HorizontalBending.friction`. The blocks are
        "ground", "left", "right", "side_0", "side_1" and four fixed guides.

        Args:
            bending: the wall, its crack and its thrust.
            options: further arguments of `Masonry`.

        Raises:
            TypeError, ValueError: as `Masonry` does.
            ValueError: as `Masonry` does.

        Examples:
            >>> strip = mr.HorizontalBending(mr.Block.from_size(0.5, 2.0, 6.0), thrust=12e3)
            >>> blocks = mr.Masonry.between_sides(strip)
            >>> round(float(mr.collapse_multiplier(blocks, effects=strip.tie).multiplier), 4)
            0.068
        """

    @classmethod
    def box(cls, size: Extents, *, density: Density = 2000.0, **options: Unpack[JointOptions]) -> Self:
        """One box, `block`, on the ground, in the middle of it.

        Args:
            size: its extents along x, y and z [m], 1e-3 to 10000 each.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range.
            ValueError: as `Masonry` does.
        """

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
            ValueError: for a value outside its range.
            ValueError: as `Masonry` does.
        """

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

        `friction` of `Masonry` is that of the base. The blocks are "ground", "corner", and "rest_0" and "rest_1", what
        stays of the walls. All but the corner are fixed.

        Args:
            thickness: of both walls [m], 0.01 to 10.
            height: of the storey that turns [m], 0.1 to 100.
            angle: of the cracks from the vertical [rad], 0 to 1.4. Without wedges the post in the corner turns alone.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range.
            ValueError: as `Masonry` does.

        Examples:
            >>> corner = mr.Masonry.corner(0.5, 4.0, angle=math.radians(30))
            >>> round(float(mr.collapse_multiplier(corner, angle=-math.pi / 4).multiplier), 4)
            0.3714
        """

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
            ValueError: for a value outside its range.
            ValueError: as `Masonry` does.
        """

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
        the given ones that divide the walls. The face of the facade is x = 0, and the middle of its length is y = 0.
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
            ValueError: for a value outside its range, or an opening that does not fit.
            ValueError: as `Masonry` does.
        """

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

        The blocks are "base", the units as of `running_bond` with the number of the leaf or a letter of the header,
        and "beam".

        Args:
            length, height, unit, thickness, density, halves: as of `running_bond`; units of several leaves are whole.
            leaves: wythes beside each other through the thickness, 1 to 10. The joints between them have the normal x,
                so that a function of the joint gives them a bond of their own.
            headers: courses from one course of headers to the next, 0 to 1000, 0 for none. Headers are half a unit long
                and go through all leaves.
            beam: whether a fixed beam lies on it, which the case leads by `supports={"beam": (t, dx, dy, dz)}`.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range.
            ValueError: as `Masonry` does.

        Examples:
            >>> wall = mr.Masonry.wallette(0.8, 0.4, (0.2, 0.1), 0.2, leaves=2, headers=4)
            >>> wall.names[1], wall.names[-2], len(wall.free)
            ('unit_0_0_0', 'unit_3_4', 34)
        """

    @classmethod
    def barrel_vault(
        cls,
        radius: Radius,
        thickness: Thick,
        length: Annotated[float, Within(0.01, 1000, "m")],
        unit: Size,
        span_angle: SpanAngle = 3.141592653589793,
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
            ValueError: for a value outside its range.
            ValueError: as `Masonry` does.
        """

    @classmethod
    def bridge(
        cls,
        radius: Radius,
        thickness: Thick,
        span_angle: SpanAngle = 3.141592653589793,
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
            ValueError: for a value outside its range.
            ValueError: as `Masonry` does.
        """

    @classmethod
    def groin_vault(
        cls,
        radius: Radius,
        thickness: Thick,
        length: Size,
        unit: Size,
        span_angle: SpanAngle = 3.141592653589793,
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
            ValueError: for a value outside its range.
            ValueError: as `Masonry` does.
        """

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
        """Blocks of a Wavefront OBJ file: its objects, or the groups of them, in their order.

        Every body has to be closed, and to touch another within the `tolerance`. A support may be an open plate: it
        becomes a fixed block behind its face, a tenth of its extent thick.

        Args:
            path: of the file. Several bodies of one object are numbered.
            fixed: names of bodies that are fixed, beside those that the file marks as supports.
            ground: whether fixed ground is put under the lowest point.
            density: mass density of blocks whose file has none [kg/m3], 100 to 30000.
            scale: length of a unit of the file [m], 1e-6 to 1e3: 0.001 for millimetres. None takes the `unit`.
            unit: of the file, "m", "cm", "mm", "in" or "ft", in the place of `scale`. None is m.
            up: axis of the file that points upwards, "x", "y" or "z": the file is turned until that is z. Blender and
                glTF have "y". None is "z", and there is a warning if the masonry seems to stand along another axis.
            convex: what becomes of a body that is not convex. "hull" takes its convex hull and warns of the volume that
                is added. "parts" cuts it along the planes of its faces into a `Compound`, which fills the same volume.
                None refuses it.
            options: further arguments of `Masonry`.

        Raises:
            TypeError: for names that are no list, and for `ground` that is neither True nor False.
            ValueError: if the file is not valid, or a body is open, not convex or touches no other; the message names
                both.
            ValueError: as `Masonry` does.

        Warns:
            Implausible: as `Masonry` does, for masonry that seems to stand along another axis, and for faces that lie
                as little apart as twenty tolerances. A UserWarning gives the volume that hulls add.
        """

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
            fixed: names of bodies that are fixed, beside those that the file marks as supports.
            ground: whether fixed ground is put under the lowest point.
            density: mass density of blocks whose file has none [kg/m3], 100 to 30000.
            scale: length of a unit of the file [m], 1e-6 to 1e3: 0.001 for millimetres. None takes the `unit`.
            unit: of the file, "m", "cm", "mm", "in" or "ft", in the place of `scale`. None is m.
            up: axis of the file that points upwards, "x", "y" or "z": the file is turned until that is z. Blender and
                glTF have "y". None is "z", and there is a warning if the masonry seems to stand along another axis.
            convex: what becomes of a body that is not convex. "hull" takes its convex hull and warns of the volume that
                is added. "parts" cuts it along the planes of its faces into a `Compound`, which fills the same volume.
                None refuses it.
            options: further arguments of `Masonry`.

        Raises:
            TypeError: for names that are no list, and for `ground` that is neither True nor False.
            ValueError: if the file is not valid, or a body is open, not convex or touches no other; the message names
                both.
            ValueError: as `Masonry` does.

        Warns:
            Implausible: as `Masonry` does, for masonry that seems to stand along another axis, and for faces that lie
                as little apart as twenty tolerances. A UserWarning gives the volume that hulls add.
        """

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
            fixed: names of bodies that are fixed, beside those that the file marks as supports.
            ground: whether fixed ground is put under the lowest point.
            density: mass density of blocks whose file has none [kg/m3], 100 to 30000.
            scale: length of a unit of the file [m], 1e-6 to 1e3: 0.001 for millimetres. None takes the `unit`.
            unit: of the file, "m", "cm", "mm", "in" or "ft", in the place of `scale`. None is m.
            up: axis of the file that points upwards, "x", "y" or "z": the file is turned until that is z. Blender and
                glTF have "y". None is "z", and there is a warning if the masonry seems to stand along another axis.
            convex: what becomes of a body that is not convex. "hull" takes its convex hull and warns of the volume that
                is added. "parts" cuts it along the planes of its faces into a `Compound`, which fills the same volume.
                None refuses it.
            options: further arguments of `Masonry`.

        Raises:
            TypeError: for names that are no list, and for `ground` that is neither True nor False.
            ValueError: if the file is not valid, or a body is open, not convex or touches no other; the message names
                both.
            ValueError: as `Masonry` does.

        Warns:
            Implausible: as `Masonry` does, for masonry that seems to stand along another axis, and for faces that lie
                as little apart as twenty tolerances. A UserWarning gives the volume that hulls add.
        """

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
            path: of the file. The density of the material of a block replaces `density`.
            fixed: names of bodies that are fixed, beside those that the file marks as supports.
            ground: whether fixed ground is put under the lowest point.
            density: mass density of blocks whose file has none [kg/m3], 100 to 30000.
            scale: length of a unit of the file [m], 1e-6 to 1e3: 0.001 for millimetres. None takes the `unit`.
            unit: of the file, "m", "cm", "mm", "in" or "ft", in the place of `scale`. None is m.
            up: axis of the file that points upwards, "x", "y" or "z": the file is turned until that is z. Blender and
                glTF have "y". None is "z", and there is a warning if the masonry seems to stand along another axis.
            convex: what becomes of a body that is not convex. "hull" takes its convex hull and warns of the volume that
                is added. "parts" cuts it along the planes of its faces into a `Compound`, which fills the same volume.
                None refuses it.
            options: further arguments of `Masonry`.

        Raises:
            TypeError: for names that are no list, and for `ground` that is neither True nor False.
            ValueError: if the file is not valid, or a body is open, not convex or touches no other; the message names
                both.
            ValueError: as `Masonry` does.

        Warns:
            Implausible: as `Masonry` does, for masonry that seems to stand along another axis, and for faces that lie
                as little apart as twenty tolerances. A UserWarning gives the volume that hulls add.
        """

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
        """Blocks of the input of LMGC90: bodies RBDY3 with one polyhedron POLYR each. Driven bodies are fixed.

        Joints are those of mjrock: laws of contact, loads and gravity of the folder are not read. A UserWarning names
        planes, spheres and other shapes, which are left out, and a file that is missing.

        Args:
            path: of a folder DATBOX with BODIES.DAT, BULK_BEHAV.DAT, DRV_DOF.DAT and DOF.INI, or of its BODIES.DAT. The
                density of the material of a body replaces `density`.
            fixed: names of bodies that are fixed, beside those that the file marks as supports.
            ground: whether fixed ground is put under the lowest point.
            density: mass density of blocks whose file has none [kg/m3], 100 to 30000.
            scale: length of a unit of the file [m], 1e-6 to 1e3: 0.001 for millimetres. None takes the `unit`.
            unit: of the file, "m", "cm", "mm", "in" or "ft", in the place of `scale`. None is m.
            up: axis of the file that points upwards, "x", "y" or "z": the file is turned until that is z. Blender and
                glTF have "y". None is "z", and there is a warning if the masonry seems to stand along another axis.
            convex: what becomes of a body that is not convex. "hull" takes its convex hull and warns of the volume that
                is added. "parts" cuts it along the planes of its faces into a `Compound`, which fills the same volume.
                None refuses it.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for bodies of other kinds or of several polyhedra.
            TypeError: for names that are no list, and for `ground` that is neither True nor False.
            ValueError: if the file is not valid, or a body is open, not convex or touches no other; the message names
                both.
            ValueError: as `Masonry` does.

        Warns:
            Implausible: as `Masonry` does, for masonry that seems to stand along another axis, and for faces that lie
                as little apart as twenty tolerances. A UserWarning gives the volume that hulls add.
        """

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
            fixed: names of bodies that are fixed, beside those that the file marks as supports.
            ground: whether fixed ground is put under the lowest point.
            density: mass density of blocks whose file has none [kg/m3], 100 to 30000.
            scale: length of a unit of the file [m], 1e-6 to 1e3: 0.001 for millimetres. None takes the `unit`.
            unit: of the file, "m", "cm", "mm", "in" or "ft", in the place of `scale`. None is m.
            up: axis of the file that points upwards, "x", "y" or "z": the file is turned until that is z. Blender and
                glTF have "y". None is "z", and there is a warning if the masonry seems to stand along another axis.
            convex: what becomes of a body that is not convex. "hull" takes its convex hull and warns of the volume that
                is added. "parts" cuts it along the planes of its faces into a `Compound`, which fills the same volume.
                None refuses it.
            options: further arguments of `Masonry`.

        Raises:
            TypeError, ValueError: for what is no mesh.
            TypeError: for names that are no list, and for `ground` that is neither True nor False.
            ValueError: if the file is not valid, or a body is open, not convex or touches no other; the message names
                both.
            ValueError: as `Masonry` does.

        Warns:
            Implausible: as `Masonry` does, for masonry that seems to stand along another axis, and for faces that lie
                as little apart as twenty tolerances. A UserWarning gives the volume that hulls add.
        """
