"""Compliant interfaces: stiffness per area and damping ratio, laid out as contact points, in physical units only."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .block import Block
from .damping import CALIBRATED, CALIBRATED_BED, DampingLaw, law_named
from .quantities import Array, require_kind, require_real, require_stiffness, require_whole, require_within, shown
from .restitution import Restitution

Law = DampingLaw | Callable[[Block, Restitution, float], tuple[float, float]]


def _require_points(points: int) -> None:
    require_whole("contact points", points, 2, 1000)


def contact_lines(face: float, points: int) -> tuple[Array, Array]:
    """Positions along a face of width `face` [m] from its centre [m], and the widths that are tributary to them [m].

    The lines are evenly spaced from edge to edge, so that the outer two have half the tributary width of the others.
    Two lines are the corners with half the face each. Many lines approach a uniform bed.
    """
    positions = np.linspace(-face / 2, face / 2, points)
    widths = np.full(points, face / (points - 1))
    widths[[0, -1]] /= 2
    return positions, widths


def reference_frequency(wall: Block, k_n: float, points: int = 2) -> float:
    """The frequency omega [rad/s] that turns a damping ratio into a dashpot, c_i = (2 xi / omega) k_i.

    omega = sqrt(K_rot / I_base): the wall rocking in full contact about the centre of its base, K_rot = sum k_i x_i^2
    over the contact points of the base and I_base = m (b^2 + h^2)/3 + m h^2. Base and side dashpots share it.

    The paper prints xi as a fraction of critical damping and does not print the frequency. This reading is inferred
    from the magnitude of the loss. On the paper's Figure 3 wall (xi_b = 5.3 %, targets e_2s = 0.970 and |e_1s| =
    0.442), `solve_compliant` returns with this omega 0.970 and 0.558 for two corner lines (30.1 rad/s), and 0.977 and
    0.485 for a bed of 32 (17.4 rad/s). With the vertical bounce sqrt(k_n A / m) (244 rad/s) hardly anything is lost
    against the side: 0.983 and 0.920 on corner lines, 0.998 and 0.939 on the bed. `scripts/layouts.py` prints these
    figures. A frequency of the side itself would damp some 26 times too little.
    """
    require_kind("wall", wall, Block)
    require_stiffness("interface stiffness k_n", k_n)
    _require_points(points)
    positions, widths = contact_lines(2 * wall.half_base, int(points))
    K_rot = float(np.sum(k_n * widths * wall.length * positions**2))
    return math.sqrt(K_rot / (wall.inertia + wall.mass * wall.h**2))


@dataclass(frozen=True)
class Interface:
    """One compliant face: a bed of unilateral springs and dashpots lumped at contact lines by tributary area.

    Args:
        k_n: normal interface stiffness [N/m3], 1e4 to 1e14.
        xi: damping ratio [-] as a fraction, 0 to 100.
        face: width of the face across the lines: the thickness for the base, the height for the side stop [m].
        length: length of the lines along the wall [m].
        frequency: what the damping ratio refers to, see `reference_frequency` [rad/s].
        points: number of contact lines, at least 2.
        friction: coefficient of friction of every line [-], 0 to 10, or None. A base of None holds: it does not slide,
            as rocking theory has it. A side of None is smooth.

    Raises:
        ValueError: for a value outside its range.
    """

    k_n: float
    xi: float
    face: float
    length: float
    frequency: float
    points: int = 2
    friction: float | None = None

    def __post_init__(self) -> None:
        require_within("face", self.face, 1e-3, 1e3, "m")
        require_within("length", self.length, 1e-3, 1e3, "m")
        require_within("reference frequency", self.frequency, 1e-3, 1e9, "rad/s")
        if self.friction is not None:
            require_within("friction", self.friction, 0.0, 10.0)
        require_stiffness("interface stiffness k_n", self.k_n)
        require_within("damping ratio xi", self.xi, 0.0, 100.0)
        if self.xi > 1:
            warnings.warn(f"xi = {self.xi:g} is {self.xi:.0%} of critical; damping ratios are fractions", stacklevel=3)
        _require_points(self.points)

    @cached_property
    def _lines(self) -> tuple[Array, Array]:
        return contact_lines(self.face, int(self.points))

    @property
    def positions(self) -> Array:
        """Positions of the contact lines along the face, from its centre [m], shape (points,)."""
        return self._lines[0]

    @cached_property
    def stiffness(self) -> Array:
        """k_i, the interface stiffness times the tributary area [N/m], shape (points,)."""
        return self.k_n * self.length * self._lines[1]

    @cached_property
    def damping(self) -> Array:
        """c_i = (2 xi / omega) k_i [N s/m], shape (points,)."""
        return self.retardation * self.stiffness

    @property
    def retardation(self) -> float:
        """c_i / k_i = 2 xi / omega, the same at every line [s]."""
        return 2 * self.xi / self.frequency

    @cached_property
    def K_rot(self) -> float:
        """Rotational stiffness about the centre of the face in full contact, sum k_i x_i^2 [N m/rad]."""
        return float(np.sum(self.stiffness * self.positions**2))


def _predicted(law: Callable[..., Any], wall: Block, e: Restitution, k_base: float) -> tuple[float, float]:
    """What a law of one's own gives, two damping ratios, or a TypeError that names the law."""
    try:
        xi_base, xi_side = law(wall, e, k_base)
    except TypeError as error:
        raise TypeError(
            f"law = {shown(law)} is not called as law(wall, e, k_base) to give two numbers: {error}"
        ) from None
    return require_real("xi of the base from the law", xi_base), require_real("xi of the side from the law", xi_side)


@dataclass(frozen=True)
class Contacts:
    """The interfaces of one wall: its base and, where it has one, its side stop.

    Args:
        base: the base, over the thickness of the wall.
        side: the side stop over the whole inner face, or None for a wall that never meets one.
        law: name of the damping law, recorded in the generated model.
    """

    base: Interface
    side: Interface | None = None
    law: str = "given"

    def __post_init__(self) -> None:
        require_kind("base", self.base, Interface)
        require_kind("side", self.side, Interface, type(None))
        require_kind("law", self.law, str)

    @classmethod
    def from_damping(
        cls,
        wall: Block,
        *,
        k_base: float,
        xi_base: float,
        k_side: float | None = None,
        xi_side: float = 0.0,
        points: int = 2,
        friction: float | None = None,
        side_friction: float | None = None,
        law: str = "given",
    ) -> Contacts:
        """Interfaces of `wall` from stiffnesses [N/m3] and damping ratios [-]; no side stop without `k_side`.

        Friction is that of `Interface`: by default the base holds and the side is smooth.

        Raises:
            ValueError: for a value outside its range, or a base too soft for the wall to stand on.
        """
        require_kind("wall", wall, Block)
        _require_points(points)
        points = int(points)
        require_stiffness("base stiffness k_n", k_base)
        if k_side is not None:
            require_stiffness("side stiffness k_n", k_side)
        omega = reference_frequency(wall, k_base, points)
        base = Interface(k_base, xi_base, 2 * wall.half_base, wall.length, omega, points, friction)
        side = None
        if k_side is not None:
            side = Interface(k_side, xi_side, 2 * wall.h, wall.length, omega, points, side_friction)
        toppling = wall.weight * wall.h
        if base.K_rot <= toppling:
            least = k_base * toppling / base.K_rot
            raise ValueError(
                f"base stiffness k_n = {k_base:g} N/m3 cannot hold the wall upright; "
                f"the valid range is k_n > {least:.3g} N/m3"
            )
        return cls(base, side, law)

    @classmethod
    def from_law(
        cls,
        wall: Block,
        e: Restitution,
        k_base: float,
        k_side: float | None = None,
        law: Law | str | None = None,
        points: int = 2,
        amplitude: float = 0.5,
    ) -> Contacts:
        """Interfaces of `wall` whose damping ratios the law predicts, in the chosen layout.

        The base holds and the side is smooth, as the laws have it. `mjrock.matched_contacts` finds the damping for
        friction.

        Args:
            wall, e: the wall, and the restitution that is asked for.
            k_base, k_side: interface stiffness of base and side [N/m3]; no side stop without `k_side`.
            law: a law or its name; None takes CALIBRATED for two lines and CALIBRATED_BED for more. A law of your own
                is called as `law(wall, e, k_base)`; a `DampingLaw` is told `k_side` and `amplitude` too.
            points: contact lines a face.
            amplitude: rotation theta_0/alpha from which the wall falls to the rebound that matters most [-].

        Raises:
            ValueError: as `from_damping`, and what the law raises.

        Warns:
            UserWarning: what the law warns of; where it was fitted for another number of lines; and one-sided where it
                was fitted in another code, as PUBLISHED was.
        """
        require_kind("wall", wall, Block)
        require_kind("e", e, Restitution)
        _require_points(points)
        if law is None:
            law = CALIBRATED if points == 2 else CALIBRATED_BED
        elif isinstance(law, str):
            law = law_named(law)
        elif not callable(law):
            raise TypeError(f"law = {shown(law)} is neither a law nor the name of one")
        for name, k in (("base", k_base), ("side", k_side)):
            if name == "base" or k is not None:
                require_stiffness(f"{name} stiffness k_n", k)
        if k_side is not None:
            e.require_rebound()
        if isinstance(law, DampingLaw):
            xi_base, xi_side = law(wall, e, k_base, k_side, amplitude)
            if law.points not in (None, points):
                warnings.warn(
                    f"{law.name} was fitted for {law.points} contact lines a face, not {points}", stacklevel=2
                )
            if law.points is None and k_side is not None:
                warnings.warn(
                    f"{law.name} was fitted in another code. Against a side stop its |e| is off by -43 to +119 % on "
                    "the contacts of this one (docs/damping.md); CALIBRATED is made for them",
                    stacklevel=2,
                )
        else:
            xi_base, xi_side = _predicted(law, wall, e, k_base)
        name = getattr(law, "name", getattr(law, "__name__", "given"))
        return cls.from_damping(
            wall, k_base=k_base, xi_base=xi_base, k_side=k_side, xi_side=xi_side, points=points, law=name
        )

    def faces(self, *, side_stop: bool) -> list[Interface]:
        """The interfaces that a case with or without a side stop meets, the base first."""
        return [self.base] + ([self.side] if side_stop and self.side else [])

    def require_fit(self, wall: Block, *, side_stop: bool) -> None:
        """Raise ValueError unless these interfaces have the size of `wall`, and a side where the case has a stop."""
        faces = [("base", self.base, 2 * wall.half_base)]
        if side_stop:
            if self.side is None:
                raise ValueError("the case has a side stop but the contacts have none; give k_side when making them")
            faces.append(("side", self.side, 2 * wall.h))
        for name, interface, face in faces:
            made, asked = (interface.face, interface.length), (face, wall.length)
            if not np.allclose(made, asked, rtol=1e-9, atol=0):
                raise ValueError(
                    f"the {name} contacts were made for a face of {made[0]:g} x {made[1]:g} m, "
                    f"but the wall of this case has {asked[0]:g} x {asked[1]:g} m"
                )

    def uplift_rotation(self, wall: Block) -> float:
        """Rotation at which the first edge of a wall at rest decompresses [rad]; below it the wall does not rock."""
        return wall.weight / (float(self.base.stiffness.sum()) * wall.half_base)

    def uplift_energy(self, wall: Block) -> float:
        """Energy above the wall at rest that tilts it to `uplift_rotation` [J]."""
        return 0.5 * (self.base.K_rot - wall.weight * wall.h) * self.uplift_rotation(wall) ** 2

    def highest_frequency(self, wall: Block, *, side_stop: bool) -> float:
        """The highest natural frequency of the wall with every contact closed and free to slide [rad/s].

        No contact state of the run can vibrate faster: opening a contact or holding the base only lowers it.
        """
        base = self.base
        vertical = float(base.stiffness.sum()) / wall.mass
        if not side_stop:
            return math.sqrt(max(vertical, base.K_rot / wall.inertia))
        assert self.side is not None
        horizontal = float(self.side.stiffness.sum()) / wall.mass
        return math.sqrt(max(vertical, horizontal, (base.K_rot + self.side.K_rot) / wall.inertia))
