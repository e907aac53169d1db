"""The rigid wall: its size, its mass, and the quantities of classical rocking theory."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from ...quantities import (
    GRAVITY,
    Array,
    Density,
    Implausible,
    OneOf,
    Real,
    Within,
    keep,
    keep_declared,
    require_kind,
    require_one_of,
    require_real,
    require_row,
    require_sequence,
    require_within,
    warn_of,
    within_ranges,
)
from .effects import AddedMass
from .restoring_moment import Restoring, of_force, pose_of
from .section import PLUMB, Front, Gable, Moments, Opening, Profile, Section, Thickness, moments, require_profile

HEAVIEST = 4000.0
"""Density above which that of a wall is taken for a weight [kg/m3]; basalt and iron ore have 3,000 to 4,000."""
Length = Annotated[float, Within(1e-3, 1000, "m")]
"""Length of a wall, out of the plane of rocking."""
Inset = Annotated[float, Within(0, 10, "m", "inset")]
"""How far the edges that a wall rocks about lie inside its faces."""
Plumb = Annotated[str, OneOf(PLUMB)]
"""The face of a wall that is plumb."""


@dataclass(frozen=True)
class Block:
    """A homogeneous wall that rocks in its plane of thickness and height: a full rectangle, unless parts say otherwise.

    Args:
        b: half the thickness at the base [m], 1e-3 to 10.
        h: half the height [m], 5e-3 to 100.
        length: length along the wall, out of the plane of rocking [m], 1e-3 to 1000. Mass and contact stiffness are
            both proportional to it, so that no rotation depends on it.
        density: mass density [kg/m3], 100 to 30000.
        inset: how far the edges that the wall rocks about lie inside its faces [m], 0 to 10 and less than b. Crushed or
            broken corners move them inwards. Mass and inertia are those of the full wall.
        openings: doors and windows through the whole thickness. A door shortens the base too.
        profile: pairs of height and thickness [m] from the base to the top, for a wall that tapers or has storeys of
            different thickness; linear in between. None is a constant thickness.
        masses: masses that move with the wall.
        gable: the upper part of a wall whose length falls towards its top; the height counts up to there. None is a
            rectangle as seen from outside.
        plumb: "inner" or "outer", the face that is plumb where the thickness of a profile changes. Facades with
            setbacks inside, on which floors bear, are plumb outside: their thinner storeys stand above the outer edge,
            and alpha is less than with the inner face plumb.

    Raises:
        ValueError: for a value outside its range, a wall that is thicker than it is high, or one whose centroid does
            not lie behind its outer edge. Behind its inner edge it needs a side stop, see `Wedge`.
    """

    b: Annotated[float, Within(1e-3, 10, "m", "half thickness b")]
    h: Annotated[float, Within(5e-3, 100, "m", "half height h")]
    length: Length = 1.0
    density: Density = 2000.0
    inset: Inset = 0.0
    openings: tuple[Opening, ...] = ()
    profile: Profile | None = None
    masses: tuple[AddedMass, ...] = ()
    gable: Gable | None = field(default=None, kw_only=True)
    plumb: Plumb = field(default="inner", kw_only=True)

    def __post_init__(self) -> None:
        keep_declared(self)
        require_within("slenderness h/b", self.h / self.b, 1.0, 200.0)
        if not 0 <= self.inset < self.b:
            raise ValueError(f"inset = {self.inset:g} m is outside the valid range 0 <= inset < b = {self.b:g} m")
        if self.density > HEAVIEST:
            warn_of(
                f"density = {self.density:g} kg/m3, and stone has up to {HEAVIEST:g} kg/m3: is it a weight in N/m3?",
                Implausible,
            )
        self._require_parts()
        if not self.centroid_offset < self.half_base:
            raise ValueError(
                f"the centroid of the wall lies {self.centroid_offset:g} m from the middle of the base; the "
                f"valid range is less than {self.half_base:g} m, where the outer edge is"
            )
        require_within("slenderness h / (b - inset)", self.slenderness, 1.0, 200.0)

    def _require_parts(self) -> None:
        """Check openings, profile and masses, and keep them as tuples."""
        for name, kind in (("openings", Opening), ("masses", AddedMass)):
            parts = getattr(self, name)
            require_sequence(name, parts, f"a sequence of {kind.__name__}")
            for i, part in enumerate(parts):
                require_kind(f"{name}[{i}]", part, kind)
            keep(self, **{name: tuple(parts)})
        require_kind("gable", self.gable, Gable, type(None))
        require_one_of("plumb", self.plumb, PLUMB)
        self.front.require()
        if self.profile is not None:
            keep(self, profile=require_profile(self.profile, 2 * self.b, 2 * self.h))
        for i, mass in enumerate(self.masses):
            require_within(f"masses[{i}], height", mass.height, 0.0, 2 * self.h * (1 + 1e-12), "m")
            require_within(f"masses[{i}], offset", mass.offset, -13.0, self.b + 3, "m")

    @classmethod
    @within_ranges
    def from_size(
        cls,
        thickness: Annotated[float, Within(2e-3, 20, "m")],
        height: Annotated[float, Within(1e-2, 200, "m")],
        length: Length = 1.0,
        density: Density = 2000.0,
        inset: Inset = 0.0,
        openings: Sequence[Opening] = (),
        profile: Sequence[Thickness] | None = None,
        masses: Sequence[AddedMass] = (),
        *,
        gable: Gable | None = None,
        plumb: Plumb = "inner",
    ) -> Block:
        """The wall of full sizes.

        Args:
            thickness: 2b at the base [m], 0.002 to 20.
            height: 2h, up to the top of a gable [m], 0.01 to 200, and 1 to 200 times the thickness.
            length, density, inset, openings, profile, masses, gable, plumb: as of `Block`.

        Raises:
            ValueError: as `Block`.
        """
        if height < thickness:
            raise ValueError(f"height = {height:g} m is less than thickness = {thickness:g} m: are they swapped?")
        height = require_within("height", height, 1e-2, min(200.0, 200 * thickness), "m")
        parts = {"openings": openings, "profile": profile, "masses": masses, "gable": gable, "plumb": plumb}
        return cls(thickness / 2, height / 2, length, density, inset, **parts)  # type: ignore[arg-type]

    @classmethod
    @within_ranges
    def from_slenderness(
        cls,
        slenderness: Annotated[float, Within(1, 200, name="slenderness h/b")],
        R: Annotated[float, Within(1e-3, 200, "m", "half diagonal R")],
        length: Length = 1.0,
        density: Density = 2000.0,
    ) -> Block:
        """The wall of a slenderness and a half diagonal, as Table 1 of the paper lists walls.

        Args:
            slenderness: h/b [-], 1 to 200.
            R: half the diagonal [m], 0.001 to 200.
            length, density: as of `Block`.
        """
        alpha = math.atan(1 / slenderness)
        largest = min(10 / math.sin(alpha), 100 / math.cos(alpha))
        R = require_within("half diagonal R", R, max(1e-3 / math.sin(alpha), 5e-3 / math.cos(alpha)), largest, "m")
        return cls(b=R * math.sin(alpha), h=R * math.cos(alpha), length=length, density=density)

    def __repr__(self) -> str:
        parts = [f"{2 * self.b:.6g} x {2 * self.h:.6g} m, {self.length:.6g} m long, {self.density:.6g} kg/m3"]
        if self.inset:
            parts.append(f"inset {self.inset:.6g} m")
        if self.profile:
            outside = ", plumb outside" if self.plumb == "outer" else ""
            parts.append(f"{self.profile[-1][1]:.6g} m thick at the top{outside}")
        if self.gable:
            parts.append(f"gable of {self.gable.height:.6g} m")
        for name, items in (("opening", self.openings), ("added mass", self.masses)):
            if items:
                parts.append(f"{len(items)} {name}{'' if len(items) == 1 else 's' if name == 'opening' else 'es'}")
        return f"<Block {', '.join(parts)}: {self.mass:.6g} kg, alpha = {self.alpha:.4g} rad, p = {self.p:.4g} rad/s>"

    @property
    def half_base(self) -> float:
        """Half the distance between the edges that the wall rocks about, b less the inset [m]."""
        return self.b - self.inset

    @property
    def base_length(self) -> float:
        """Length of the base along the wall, without its doors [m]."""
        return self.length - sum(opening.width for opening in self.openings if opening.sill == 0)

    @property
    def front(self) -> Front:
        """The wall as seen from outside."""
        return Front(self.length, 2 * self.h, self.openings, self.gable)

    @property
    def section(self) -> Section:
        """The wall across its thickness."""
        return Section(self.profile or ((0.0, 2 * self.b), (2 * self.h, 2 * self.b)), self.plumb)

    def inner_face(self, z: float) -> float:
        """Where the inner face is at a height z [m], x from the middle of the base [m]; that of the thicker part at a
        step."""
        return -self.b if not self.profile or self.plumb == "inner" else float(self.section.faces(np.array(z))[0])

    @cached_property
    def _moments(self) -> Moments:
        """Mass and its moments of all that is not a plain rectangle [kg, kg m, kg m2]."""
        total = [self.density * value for value in moments(self.section, self.front)]
        for mass in self.masses:
            x, z = mass.offset, mass.height
            for i, value in enumerate((1.0, x, z, x * x, z * z)):
                total[i] += mass.mass * value
        return Moments(*total)

    @property
    def is_plain(self) -> bool:
        """Whether the wall is a full rectangle without parts."""
        return not (self.openings or self.profile or self.masses or self.gable)

    @property
    def centroid_height(self) -> float:
        """Height of the centroid above the base [m]; h for a full rectangle."""
        return self.h if self.is_plain else self._moments.z / self._moments.volume

    @property
    def centroid_offset(self) -> float:
        """Distance of the centroid from the middle of the base, outwards [m]; 0 for a full rectangle."""
        return 0.0 if self.is_plain or not (self.profile or self.masses) else self._moments.x / self._moments.volume

    @property
    def lever(self) -> float:
        """Horizontal distance of the centroid from the outer edge [m]; b for a full rectangle."""
        return self.half_base - self.centroid_offset

    @property
    def slenderness(self) -> float:
        """h/b [-] as Eqs. 5-6 and Table 1 of the paper use it, with the height of the centroid for h and its distance
        from the outer edge for b."""
        return self.centroid_height / self.lever

    @property
    def alpha(self) -> float:
        """Angle of the line from the outer edge to the centroid, arctan(b/h) [rad]; a static tilt beyond it overturns
        the wall.

        The paper prints arctan(h/b) below Eq. 1; its own example (Figure 3) needs arctan(b/h) in Eq. 2.
        """
        return math.atan2(self.lever, self.centroid_height)

    @property
    def R(self) -> float:
        """Distance from the centroid to the outer edge that the wall rocks about [m]; half the diagonal of a
        rectangle."""
        return math.hypot(self.lever, self.centroid_height)

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return 4 * self.b * self.h * self.length * self.density if self.is_plain else self._moments.volume

    @property
    def weight(self) -> float:
        """Weight [N]."""
        return self.mass * GRAVITY

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centroid [kg m2]."""
        if self.is_plain:
            return self.mass * (self.b**2 + self.h**2) / 3
        about_base = self._moments.xx + self._moments.zz
        return about_base - self.mass * (self.centroid_offset**2 + self.centroid_height**2)

    @property
    def toe_inertia(self) -> float:
        """Moment of inertia about the outer toe, I_0 of Eq. 1 [kg m2]."""
        return self.inertia + self.mass * self.R**2

    def inertia_about(self, side: float) -> float:
        """Moment of inertia about the outer toe (+1) or the inner toe (-1) [kg m2]."""
        lever = self.half_base - math.copysign(1.0, side) * self.centroid_offset
        return self.inertia + self.mass * (lever**2 + self.centroid_height**2)

    @property
    def p(self) -> float:
        """Frequency parameter sqrt(m g R / I_0) of Eq. 1 [rad/s]."""
        return math.sqrt(self.weight * self.R / self.toe_inertia)

    @cached_property
    def restoring(self) -> Restoring:
        """The restoring moments of the weight about the two toes."""
        return of_force(self.centroid_offset, self.centroid_height, 0.0, self.weight, self.half_base)

    def potential_energy(self, theta: Real) -> Real:
        """Energy of the rigid wall tilted by `theta` [rad] about its toe, above the wall at rest [J]."""
        return self.restoring.energy(theta)

    def rotation_at(self, energy: float) -> float:
        """The rotation in [0, alpha] whose `potential_energy` is `energy` [J]; the inverse of that function.

        Raises:
            TypeError: unless the energy is a real number.
            ValueError: if the wall has more energy than it takes to overturn it.
        """
        return self.restoring.outer.rotation_at(require_real("energy", energy))

    def pose(self, theta: ArrayLike) -> Array:
        """Displacement (x, z) of the centroid [m] and rotation [rad] of the rigid wall turned about its toe, (n, 3).

        x points away from the side stop, and z upwards. The rotations theta [rad] have the shape (n,).

        Raises:
            TypeError, ValueError: unless the rotations are a row of finite numbers.
        """
        rotations = require_row("theta", theta, "rotation [rad]")
        return pose_of(rotations, self.centroid_offset, self.centroid_height, self.half_base)

    def turning(self, theta: Real, direction: Real) -> Array:
        """Rate of `pose` per unit of angular velocity, the wall turning about the toe in `direction`, +1 or -1;
        (..., 3)."""
        toe, z = direction * self.half_base - self.centroid_offset, self.centroid_height
        sine, cosine = np.sin(theta), np.cos(theta)
        return np.stack([z * cosine + toe * sine, toe * cosine - z * sine, np.ones_like(sine)], axis=-1)

    def velocity(self, theta: Array, omega: Array) -> Array:
        """Rate of `pose` of the rigid wall that rocks, at rotations [rad] and angular velocities [rad/s], (n, 3)."""
        outwards = np.where(theta == 0, omega, theta) >= 0
        return np.asarray(omega[:, None] * self.turning(theta, np.where(outwards, 1.0, -1.0)))

    @property
    def outline(self) -> Array:
        """Corners of the section about the centroid, counter-clockwise from the inner edge of the base [m], (n, 2)."""
        return self.section.outline - (self.centroid_offset, self.centroid_height)
