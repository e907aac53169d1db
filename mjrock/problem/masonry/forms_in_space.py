"""What `Masonry` can be made as in space: a box, a column, a dome, and a facade with return walls."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Self

from numpy.typing import ArrayLike

from ..wall.section import Opening
from .builders_in_space import box_on_ground, column_of, dome_of, facade_of
from .polyhedron import Polyhedron


class FormsInSpace:
    """Masonry that is built often, in space. Options are further arguments of `Masonry`."""

    if TYPE_CHECKING:

        def __init__(self, blocks: tuple[Polyhedron, ...], **options: Any) -> None:
            """As `Masonry`."""

    @classmethod
    def box(cls, size: ArrayLike, *, density: float = 2000.0, **options: Any) -> Self:
        """One box, `block`, on the ground, in the middle of it.

        Args:
            size: its extents along x, y and z [m], 1e-3 to 10000 each.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        return cls(tuple(box_on_ground(size, density)), **options)

    @classmethod
    def column(
        cls, width: float, height: float, drums: int, *, sides: int = 4, density: float = 2000.0, **options: Any
    ) -> Self:
        """A column of equal prismatic drums on the ground.

        Args:
            width: diameter of the circle within the section [m], 0.01 to 100: the side of a square.
            height: of the column [m], 0.01 to 1000.
            drums: how many, 1 to 1000. They are named `drum_0` and so on, from the lowest upwards.
            sides: of the section, a regular polygon, 3 to 100. A square one has its sides along x and y.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        return cls(tuple(column_of(width, height, drums, sides, density)), **options)

    @classmethod
    def dome(
        cls,
        radius: float,
        thickness: float,
        lunes: int,
        hoops: int,
        *,
        oculus: float = 0.05,
        density: float = 2000.0,
        **options: Any,
    ) -> Self:
        """A hemispherical dome of voussoirs with plane faces, which springs from the ground.

        Args:
            radius: of the middle of the thickness at the corners of the voussoirs [m], 0.1 to 1000.
            thickness: [m], 0.001 to 1 times the radius.
            lunes: how many voussoirs a hoop has, 4 to 360.
            hoops: how many hoops of equal angles, 1 to 360. `voussoir_0_3` is the fourth of the lowest hoop.
            oculus: angle at the centre between the axis and the edge of the opening at the crown [rad], 0.01 to 1.5.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, or as `Masonry` does.
        """
        return cls(tuple(dome_of(radius, thickness, lunes, hoops, oculus, density)), **options)

    @classmethod
    def facade(
        cls,
        length: float,
        height: float,
        depth: float,
        unit: tuple[float, float],
        *,
        openings: Sequence[tuple[float, Opening]] = (),
        gable: int = 0,
        density: float = 2000.0,
        **options: Any,
    ) -> Self:
        """A facade and two return walls behind it, on the ground.

        All walls are in running bond and half a unit thick, so that units of the facade and of the return walls take
        turns at the corners. The face of the facade is x = 0, and the middle of its length is y = 0. Blocks are named
        `facade_`, `left_` and `right_` with the course and a number in it.

        Args:
            length: of the facade, a whole number of units, at least 2 [m].
            height: of the walls, a whole number of units [m].
            depth: of the return walls with the thickness of the facade, a whole number of units [m].
            unit: length and height of a unit [m], 0.01 to 100.
            openings: pairs of the y of the middle of an opening [m] and the `Opening`. Its edges lie on half units and
                on courses. A lintel over it bears on half a unit on either side.
            gable: courses above the walls, each of which is a unit shorter than the one below, 0 to as many as there
                are. The first is as long as the facade, or a unit shorter over an odd number of courses.
            density: mass density [kg/m3], 100 to 30000.
            options: further arguments of `Masonry`.

        Raises:
            ValueError: for a value outside its range, an opening that does not fit, or as `Masonry` does.
        """
        return cls(tuple(facade_of(length, height, depth, unit, openings, gable, density)), **options)
