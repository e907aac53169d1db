"""Dampers between a wall and the building behind it: a viscous one, and an anchor that slips."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Literal

from ...quantities import Within, keep_declared
from .effect import OF_MASONRY, Anchored, LinkLaw, PointOf, keep_place


@dataclass(frozen=True, repr=False)
class Damper(Anchored):
    """A linear viscous damper that runs horizontally from the inner face to an anchor behind the wall.

    It resists both ways with c times the rate of its length. A wall at rest does not feel it.

    Args:
        height: where it holds the wall [m].
        c: damping coefficient [N s/m], 0 to 1e9.
        length: distance from the inner face to the anchor [m], 0.01 to 1000.
        block: the block that it holds.
        at: of masonry, the point that it holds, x, z or x, y, z at rest [m]; it takes the place of the height.
        anchor: of masonry, its other end at rest [m]. None is `length` behind the point.
        anchor_block: of masonry, the block that the other end is fixed to and moves with; None is the ground. In the
            plane the end lies `length` to the left.

    Raises:
        ValueError: for a value outside its range.

    Examples:
        >>> damper = mr.Damper(height=4.0, c=2e4)
        >>> mr.Case(wall, 0.0, 1.0, effects=(damper,)).effects[0].c
        20000.0
    """

    label: ClassVar[str] = "damper"
    arguments: ClassVar[str] = "height, c, length"
    colour: ClassVar[str] = "#3f8f5b"
    dashes: ClassVar[Literal["-", "--", "-."]] = "-."
    height: float = None  # type: ignore[assignment]
    c: Annotated[float, Within(0, 1e9, "N s/m", "coefficient c of the damper")] = None  # type: ignore[assignment]
    length: Annotated[float, Within(0.01, 1000, "m")] = 5.0
    block: int = 0
    at: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor_block: int | None = field(default=None, kw_only=True, metadata=OF_MASONRY)

    def __post_init__(self) -> None:
        keep_place(self, "damper")
        keep_declared(self, "damper")

    @property
    def law(self) -> LinkLaw:
        """A dashpot."""
        return LinkLaw(c=self.c)

    @property
    def said(self) -> str:
        """For sketches, and for reports that have no words for it."""
        return f"z = {self.height:g} m, c = {self.c / 1e3:g} kN s/m"


@dataclass(frozen=True, repr=False)
class FrictionDamper(Anchored):
    """A friction damper that runs horizontally from the inner face to an anchor behind the wall.

    It is a spring with a slider: its force is that of the spring up to the slip force, at which it slips, in either
    direction. A cycle of the amplitude d takes 4 F (d - F/k) from the wall, with F the slip force and k the stiffness.
    It is put in when the wall stands, so that it bears nothing at rest.

    Args:
        height: where it holds the wall [m].
        stiffness: of the spring [N/m], 1 to 1e12.
        slip_force: force at which it slips [N], 1e-3 to 1e9.
        length: distance from the inner face to the anchor [m], 0.01 to 1000.
        block: the block that it holds.
        at: of masonry, the point that it holds, x, z or x, y, z at rest [m]; it takes the place of the height.
        anchor: of masonry, its other end at rest [m]. None is `length` behind the point.
        anchor_block: of masonry, the block that the other end is fixed to and moves with; None is the ground. In the
            plane the end lies `length` to the left.

    Raises:
        ValueError: for a value outside its range.
    """

    label: ClassVar[str] = "friction_damper"
    arguments: ClassVar[str] = "height, stiffness,\nslip_force, length"
    colour: ClassVar[str] = "#8a4f9e"
    dashes: ClassVar[Literal["-", "--", "-."]] = "--"
    limit: ClassVar[str] = "slip_force"
    height: float = None  # type: ignore[assignment]
    stiffness: Annotated[float, Within(1, 1e12, "N/m")] = None  # type: ignore[assignment]
    slip_force: Annotated[float, Within(1e-3, 1e9, "N")] = None  # type: ignore[assignment]
    length: Annotated[float, Within(0.01, 1000, "m")] = 5.0
    block: int = 0
    at: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor_block: int | None = field(default=None, kw_only=True, metadata=OF_MASONRY)

    def __post_init__(self) -> None:
        keep_place(self, "friction damper")
        keep_declared(self, "friction damper")

    @property
    def law(self) -> LinkLaw:
        """A spring that yields both ways."""
        return LinkLaw(self.stiffness, self.span, self.slip_force, push=self.slip_force)

    @property
    def said(self) -> str:
        """For sketches, and for reports that have no words for it."""
        said = f"z = {self.height:g} m,\nk = {self.stiffness / 1e6:.4g} kN/mm"
        return f"{said}, slips at {self.slip_force / 1e3:g} kN"
