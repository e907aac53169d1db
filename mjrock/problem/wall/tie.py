"""A tie that holds a wall back."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import ClassVar

from ...quantities import keep, require_real, require_within
from .effect import Anchored, LinkLaw
from .in_space import HIGHEST, LATER, Point, keep_place


@dataclass(frozen=True, repr=False)
class Tie(Anchored):
    """A tie that holds the inner face of the wall back: it pulls, never pushes, yields plastically, and may break.

    The tie runs horizontally from the inner face to an anchor behind the wall, unless `anchor_height` says otherwise.
    Its force is min(strength, stiffness times elongation), the elongation beyond the slack and beyond what has yielded.
    A tie that has yielded by `ultimate` breaks: it pulls no more, and its elastic energy is lost.

    Args:
        height: where it holds the wall [m].
        stiffness: E A over its length [N/m], 1 to 1e12.
        slack: elongation before it pulls [m], 0 to 10.
        strength: force at which it yields [N], above 0; infinite for one that does not.
        length: distance from the inner face to the anchor [m], 0.01 to 1000.
        anchor_height: height of the anchor [m]; None is that of the tie.
        block: the block that it holds.
        ultimate: plastic elongation at which it breaks [m], 0 to 10, such as the slip at which an anchor plate is
            pulled through; 0 for one that breaks as it begins to yield. None never breaks.
        at: in space, the point that it holds, x, y, z at rest [m]; it takes the place of the height.
        anchor: in space, its other end at rest [m]. None is `length` behind the point, as in the plane.
        anchor_block: of masonry, the block that the other end is fixed to and moves with; None is the ground. In the
            plane the end lies `length` to the left.

    Raises:
        ValueError: for a value outside its range, or an `ultimate` without a finite strength.
    """

    label: ClassVar[str] = "tie"
    arguments: ClassVar[str] = "height, stiffness, slack,\nstrength, ultimate, length, anchor_height"
    height: float = None  # type: ignore[assignment]
    stiffness: float = None  # type: ignore[assignment]
    slack: float = 0.0
    strength: float = math.inf
    length: float = 5.0
    anchor_height: float | None = None
    block: int = 0
    ultimate: float | None = None
    at: Point | None = field(default=None, kw_only=True, metadata=LATER)
    anchor: Point | None = field(default=None, kw_only=True, metadata=LATER)
    anchor_block: int | None = field(default=None, kw_only=True, metadata=LATER)

    def __post_init__(self) -> None:
        keep_place(self, "tie")
        keep(
            self,
            stiffness=require_within("stiffness of the tie", self.stiffness, 1.0, 1e12, "N/m"),
            slack=require_within("slack of the tie", self.slack, 0.0, 10.0, "m"),
            strength=require_real("strength of the tie", self.strength),
            length=require_within("length of the tie", self.length, 0.01, 1000.0, "m"),
        )
        if not self.strength > 0:
            raise ValueError(
                f"strength of the tie = {self.strength:g} N is outside the valid range, which is above 0 N"
            )
        if self.anchor_height is not None:
            anchored = require_within("height of the anchor", self.anchor_height, -HIGHEST, HIGHEST, "m")
            keep(self, anchor_height=anchored)
        if self.ultimate is not None:
            keep(self, ultimate=require_within("ultimate of the tie", self.ultimate, 0.0, 10.0, "m"))
            if self.strength == math.inf:
                raise ValueError(
                    f"ultimate of the tie = {self.ultimate:g} m, and its strength is infinite: it does not yield and "
                    "never breaks; give it a strength [N], or leave ultimate out"
                )

    @property
    def rise(self) -> float:
        """How much higher the anchor is than the point that is held [m]."""
        return 0.0 if self.anchor_height is None else self.anchor_height - self.height

    @property
    def reach(self) -> float:
        """Length up to which the tie is slack [m]."""
        return self.span + self.slack

    @property
    def stretch(self) -> float:
        """Elastic elongation at which it yields [m]."""
        return self.strength / self.stiffness

    @property
    def breaks_at(self) -> float:
        """Plastic elongation at which it breaks [m], infinite for one that never does."""
        return math.inf if self.ultimate is None else self.ultimate

    @property
    def law(self) -> LinkLaw:
        """A spring that pulls."""
        return LinkLaw(self.stiffness, self.reach, self.strength, ultimate=self.breaks_at)

    @property
    def said(self) -> str:
        """For sketch and report."""
        said = f"z = {self.height:g} m, {self.length:g} m long,\n"
        said += f"k = {self.stiffness / 1e6:g} kN/mm, slack {1e3 * self.slack:g} mm"
        if self.strength < math.inf:
            said += f",\nyields at {self.strength / 1e3:g} kN"
        return said if self.ultimate is None else f"{said}, breaks at {1e3 * self.ultimate:g} mm"
