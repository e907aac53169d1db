"""Fill over an arch: its weight, the spread of a load through it, and what it bears where the arch moves into it."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ...quantities import (
    GRAVITY,
    Array,
    Within,
    keep_declared,
    require_kind,
    require_reals,
    require_row,
    require_within,
    short_repr,
)
from ..wall.effect import Effect, ReportItem
from ..wall.effects import Load
from ..wall.tie import Tie
from .blocks.joints import SHORTEST_JOINT
from .blocks.polygon import Polygon
from .blocks.surface import uncovered_ends
from .masonry import Masonry

LOOKS_UP = 1e-6
"""Least z of the normal of a face that bears fill [-]."""
ANCHORED, AS_RIGID = 5.0, 1e9
"""Length [m] and stiffness [N/m] of the ties that stand for passive pressure, of which only the strength counts."""
TOUCHED = 1e-9
"""Share of the width of a spread load up to which faces are touched at their ends alone [-]."""


class Bearing(NamedTuple):
    """A face of a block that bears fill: the block, its ends from left to right [m], shape (2, 2), and its length out
    of the plane [m]."""

    name: str
    ends: Array
    length: float

    def point_at(self, x: float) -> tuple[float, float]:
        """Its point at an x [m]."""
        return x, float(np.interp(x, *self.ends.T))


@dataclass(frozen=True)
class Fill:
    """Earth between the free upper faces of masonry in the plane, such as the extrados of an arch, and level ground.

    Its weight rests on the faces below it. A load on the ground spreads on the way down, and presses evenly between
    where its edges reach the faces. Where the masonry moves into the fill, that bears up to K rho g z on the height of
    the face, z below the ground, and it bears nothing where the masonry moves away. Friction of the fill and what it
    bears above the arch are left out, on the safe side.

    Args:
        top: level of the ground [m], -10000 to 10000.
        density: of the fill [kg/m3], 500 to 2600.
        spread: how far a load spreads to either side over the depth [-], 0 to 2; 0.5 is two to one.
        passive: K, the coefficient of the pressure that it bears [-], 0 to 20; 0 bears none. `EarthPressure.passive`
            has the largest, of which the movement brings about a part.

    Raises:
        ValueError: for a value outside its range.

    Examples:
        >>> arch = mr.Masonry.arch(radius=5.0, thickness=0.5, span_angle=1.9)
        >>> fill = mr.Fill(top=5.8, density=1800.0)
        >>> axle = fill.under(arch, force=50e3, at=-1.5, width=0.3)
        >>> round(float(mr.collapse_multiplier(arch, None, loads=axle, effects=fill.on(arch)).multiplier), 1)
        4.7
    """

    label: ClassVar[str] = "fill"
    arguments: ClassVar[str] = "top, density,\nspread, passive"
    top: Annotated[float, Within(-1e4, 1e4, "m", "top of the fill")]
    density: Annotated[float, Within(500, 2600, "kg/m3", "density of the fill")] = 1800.0
    spread: Annotated[float, Within(0, 2, "", "spread of a load")] = field(default=0.5, kw_only=True)
    passive: Annotated[float, Within(0, 20, "", "passive coefficient")] = field(default=0.0, kw_only=True)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep_declared(self)

    @property
    def description(self) -> str:
        """For sketches, and for reports that have no words for it."""
        return f"up to z = {self.top:g} m, {self.density:g} kg/m3"

    def on(self, masonry: Masonry) -> tuple[Effect, ...]:
        """The weight on each face as a `Load`, and its passive pressure as a `Tie` of that strength, for limit
        analysis. Pictures and reports show the fill.

        Raises:
            TypeError, ValueError: for what is not masonry in the plane, has a face above the ground, or free faces one
                above the other.
        """
        effects = list[Effect]()
        for face in self._faces(masonry):
            (x, z), (right, high) = face.ends
            depth, wide = self.top - face.ends[:, 1], right - x
            column = self.density * GRAVITY * face.length * 0.5 * depth.sum()
            share = (depth[0] + 2 * depth[1]) / (3 * depth.sum())  # of the centroid of a trapezium
            point = tuple(face.ends[0] + share * (face.ends[1] - face.ends[0]))
            drawn = *map(tuple, face.ends.tolist()), (right, self.top), (x, self.top)
            shown = {"stands_for": None if effects else self, "drawn": drawn}
            effects.append(EarthLoad(column * wide, block=face.name, at=point, **shown))  # type: ignore[arg-type]
            borne = self.passive * column * abs(high - z)
            if borne > 0:
                sense = 1.0 if high < z else -1.0  # out of the masonry, sideways
                middle = face.ends.mean(axis=0)
                anchor = middle[0] - sense * ANCHORED, middle[1]
                pull = {"strength": borne, "at": tuple(middle), "anchor": anchor, "block": face.name}
                effects.append(EarthTie(stiffness=AS_RIGID, **pull))
        return tuple(effects)

    def under(
        self, masonry: Masonry, force: float | ArrayLike, at: float | ArrayLike, width: float = 0.0
    ) -> tuple[Load, ...]:
        """Loads on the ground as they press on the masonry, for `loads` or `effects`. Where a load spreads over a gap
        between faces, these bear all of it.

        Args:
            masonry: the masonry.
            force: downwards [N], above 0 to 1e9, or that of each axle, shape (n,).
            at: x of its middle [m], above the faces, or of each axle, shape (n,). Of several those that are
                beyond the outermost faces are left out.
            width: of each load on the ground, 0 to 100 [m].

        Raises:
            TypeError, ValueError: as `on`, for a value outside its range, axles all beyond the outermost faces, or an
                axle above a gap that reaches no face.

        Examples:
            >>> arch = mr.Masonry.arch(radius=5.0, thickness=0.5, span_angle=1.9)
            >>> train = mr.Fill(top=5.8).under(arch, force=[60e3, 60e3], at=[-2.0, -0.2])
            >>> round(sum(load.force for load in train))
            120000
        """
        faces = self._faces(masonry)
        places = require_row("at", np.atleast_1d(require_reals("at", at, "places")), "place of an axle [m]")
        forces = require_row("force", np.atleast_1d(require_reals("force", force, "forces")), "force of an axle [N]")
        forces = np.repeat(forces, len(places)) if len(forces) == 1 else forces
        if len(forces) != len(places):
            raise ValueError(f"force has {len(forces)} axles and at has {len(places)}; give one force for each place")
        low, high = float(faces[0].ends[0, 0]), float(faces[-1].ends[1, 0])
        above = [place for place in places.tolist() if low <= place <= high]
        if not above:
            require_within("at", float(places[np.abs(places - 0.5 * (low + high)).argmin()]), low, high, "m")
        half = 0.5 * require_within("width", width, 0.0, 100.0, "m")
        loads = list[Load]()
        for i, (axle_force, place) in enumerate(zip(forces.tolist(), places.tolist(), strict=True)):
            name = "force" if len(forces) == 1 else f"force[{i}]"
            axle = Axle(require_within(name, axle_force, 1e-3, 1e9, "N"), place, 2 * half, self.top)
            if place not in above:
                continue
            borne = self._loads_under(faces, axle)
            if not borne:
                raise ValueError(f"at = {place:g} m lies above a gap between the faces; give places above the faces")
            loads += borne
        return tuple(loads)

    def _loads_under(self, faces: list[Bearing], axle: Axle) -> list[Load]:
        """One axle as it presses on the faces."""
        ends, at, half = np.concatenate([face.ends for face in faces]), axle.at, 0.5 * axle.width
        low, high = (self._reached(ends, at, side, half) for side in (-1, 1))
        spans = [(max(low, face.ends[0, 0]), min(high, face.ends[1, 0])) for face in faces]
        covered = sum(max(right - left, 0.0) for left, right in spans)
        if covered <= TOUCHED * (high - low) and high > low:
            return []
        loads = list[Load]()
        for face, (left, right) in zip(faces, spans, strict=True):
            share = (right - left) / covered if high > low else float(left == right and not loads)
            if share > 0:
                down = [left, right] if high > low else [at, at]
                up = np.interp(down, [low, high], [at - half, at + half]) if high > low else [at, at]
                drawn = *map(face.point_at, down), (float(up[1]), self.top), (float(up[0]), self.top)
                shown = {"stands_for": None if loads else axle, "drawn": drawn}
                point = face.point_at(0.5 * (down[0] + down[1]))
                loads.append(EarthLoad(axle.force * share, block=face.name, at=point, **shown))  # type: ignore[arg-type]
        return loads

    def _reached(self, ends: Array, at: float, side: int, half: float) -> float:
        """x at which an edge of a load, on its left (-1) or right (1), reaches the faces, or their end [m]."""

        def beyond(x: float) -> float:
            return side * (x - at) - half - self.spread * (self.top - float(np.interp(x, *ends.T)))

        end = float(ends[0 if side < 0 else -1, 0])
        return end if beyond(end) <= 0 else float(scipy.optimize.brentq(beyond, at, end)) if beyond(at) < 0 else at

    def _faces(self, masonry: Masonry) -> list[Bearing]:
        """The faces that bear the fill, without what other blocks cover of them, from left to right."""
        require_kind("masonry", masonry, Masonry)
        if masonry.in_space:
            raise ValueError("masonry is in space; a fill takes masonry in the plane")
        covered, faces = defaultdict[tuple[int, int], list[Array]](list), list[Bearing]()
        for joint in masonry.plane_joints:
            for pair in zip((joint.below, joint.above), joint.sides, strict=True):
                covered[pair].append(np.array([joint.start, joint.end]))
        for number in masonry.free:
            block = masonry.polygons[number]
            for k, side in enumerate(block.sides):
                if side.normal[1] > LOOKS_UP:
                    part = block.parts[side.parts[0]]
                    assert isinstance(part, Polygon)  # of masonry in the plane
                    pieces = uncovered_ends(side, covered[number, k], SHORTEST_JOINT * masonry.tolerance)
                    faces += [Bearing(masonry.names[number], ends[::-1], part.length) for ends in pieces]
        if not faces:
            raise ValueError("masonry has no free face that looks upwards, on which a fill could rest")
        highest = max(float(face.ends[:, 1].max()) for face in faces)
        if not self.top > highest:
            raise ValueError(f"top of the fill = {self.top:g} m is not above {highest:g} m, the highest face")
        faces.sort(key=lambda face: float(face.ends[0, 0]))
        for left, right in pairwise(faces):
            if left.ends[1, 0] - right.ends[0, 0] > SHORTEST_JOINT * masonry.tolerance:
                raise ValueError(
                    f"masonry has free faces of {left.name} and {right.name} that look upwards one above the other; a "
                    "fill rests on faces beside each other, as it has no earth below a block"
                )
        return faces


@dataclass(frozen=True)
class Axle:
    """A load on the ground over masonry, see `Fill.under`.

    Args:
        force: downwards [N].
        at: x of its middle [m].
        width: on the ground [m].
        top: level of the ground [m].
    """

    label: ClassVar[str] = "axle"
    arguments: ClassVar[str] = "force, at, width"
    force: Annotated[float, Within(1e-3, 1e9, "N")]
    at: Annotated[float, Within(-1e4, 1e4, "m")]
    width: Annotated[float, Within(0, 100, "m")]
    top: Annotated[float, Within(-1e4, 1e4, "m")]

    @property
    def description(self) -> str:
        """For sketches, and for reports that have no words for it."""
        return f"{self.force / 1e3:g} kN at x = {self.at:g} m"


@dataclass(frozen=True, repr=False)
class EarthLoad(Load):
    """The weight of a fill on a face, or the part of an axle that it bears.

    Args:
        stands_for: the fill or the axle that sketch and report show, None where another load shows it.
        drawn: corners of the earth through which it goes down to the face [m].
    """

    stands_for: Fill | Axle | None = field(kw_only=True, repr=False)
    drawn: tuple[tuple[float, float], ...] = field(kw_only=True, repr=False)

    @property
    def report_item(self) -> ReportItem | None:
        """The fill or the axle, once."""
        return self.stands_for

    @property
    def outline(self) -> Array:
        """The earth above the face."""
        return np.array(self.drawn)


class EarthTie(Tie):
    """What a fill bears where a face moves into it. Sketch and report show the fill."""

    @property
    def report_item(self) -> None:
        """Nothing: the fill is shown once."""
        return
