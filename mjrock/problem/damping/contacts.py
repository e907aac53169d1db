"""Compliant interfaces of one wall: its base and, where it has one, its side stop.

An interface has a stiffness per area and a damping ratio, in physical units, and is laid out as contact lines.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated, NamedTuple

import numpy as np

from ...quantities import (
    Array,
    Implausible,
    Within,
    is_iterable,
    keep_declared,
    require_kind,
    require_real,
    require_text,
    shown,
    takes,
    warn_of,
    within_ranges,
)
from ..wall.block import Block
from ..wall.case import Case
from .law import CALIBRATED, CALIBRATED_BED, HIGHEST_XI, Amplitude, DampingLaw, law_named, rebound_over_uplift
from .restitution import ANOTHER_WALL, Restitution, StopTop

NEARLY_HELD = 10.0
"""Friction coefficient from which a base holds a wall nearly as one that holds without a bound does [-]."""
PointCount = Annotated[int, Within(2, 1000, name="contact points", whole=True)]
"""Contact lines of a face."""
InterfaceStiffness = Annotated[float, Within(1e4, 1e14, "N/m3", "interface stiffness k_n")]
"""Stiffness of an interface."""
BaseStiffness = Annotated[float, Within(1e4, 1e14, "N/m3", "base stiffness k_base")]
"""Stiffness of the base of a wall."""
SideStiffness = Annotated[float | None, Within(1e4, 1e14, "N/m3", "side stiffness k_side")]
"""Stiffness of the side stop of a wall, None without one."""
FaceFriction = Annotated[float | None, Within(0, 10)]
"""Coefficient of friction of an interface, see `Interface`."""
DampingFunction = Callable[[Block, Restitution, float], tuple[float, float]]
"""A law of the user, called as law(wall, e, k_base) to give the damping ratios of base and side."""
AnyLaw = DampingLaw | DampingFunction


@within_ranges
def contact_lines(face: float, points: PointCount) -> tuple[Array, Array]:
    """Positions along a face of width `face` [m] from its centre [m], and the widths that are tributary to them [m].

    The lines are evenly spaced from edge to edge, so that the outer two have half the tributary width of the others.
    Two lines are the corners with half the face each. Many lines approach a uniform bed.
    """
    return even_lines(face, points)


def even_lines(face: float, points: int) -> tuple[Array, Array]:
    """The same for a number of points that is known to be valid."""
    positions = np.linspace(-face / 2, face / 2, points)
    widths = np.full(points, face / (points - 1))
    widths[[0, -1]] /= 2
    return positions, widths


@within_ranges
def reference_frequency(wall: Block, k_n: InterfaceStiffness, points: int = 2) -> float:
    """The frequency omega [rad/s] that turns a damping ratio into a dashpot, c_i = (2 xi / omega) k_i.

    omega = sqrt(K_rot / I_base): the wall rocking in full contact about the centre of its base, K_rot = sum k_i x_i^2
    over the contact points of the base and I_base = m (b^2 + h^2)/3 + m h^2. Base and side dashpots share it.

    The paper prints xi as a fraction of critical damping and does not print the frequency. This reading is inferred
    from the magnitude of the loss. On the paper's Figure 3 wall (xi_b = 5.3 %, targets e_2s = 0.970 and |e_1s| =
    0.442), `solve_compliant` returns with this omega 0.970 and 0.558 for two corner lines (30.1 rad/s), and 0.977 and
    0.485 for a bed of 32 (17.4 rad/s). With the vertical bounce sqrt(k_n A / m) (244 rad/s) hardly anything is lost
    against the side: 0.983 and 0.920 on corner lines, 0.998 and 0.939 on the bed. `scripts/paper/layouts.py` prints
    these figures. A frequency of the side itself would damp some 26 times too little.

    Args:
        wall: the wall.
        k_n: interface stiffness of the base [N/m3], 1e4 to 1e14.
        points: contact lines of the base, 2 to 1000.
    """
    require_kind("wall", wall, Block)
    positions, widths = contact_lines(2 * wall.half_base, points)
    K_rot = float(np.sum(k_n * widths * wall.base_length * positions**2))
    return math.sqrt(K_rot / base_inertia(wall))


def base_inertia(wall: Block) -> float:
    """Moment of inertia of a wall about the middle of its base [kg m2]."""
    return wall.inertia + wall.mass * math.hypot(wall.centroid_height, wall.centroid_offset) ** 2


Xi = Annotated[float, Within(0, 100, name="damping ratio xi")]


@dataclass(frozen=True)
class Interface:
    """One compliant face: a bed of unilateral springs and dashpots lumped at contact lines by tributary area.

    Args:
        k_n: normal interface stiffness [N/m3], 1e4 to 1e14.
        xi: damping ratio [-] as a fraction, 0 to 100.
        face: width of the face across the lines: the thickness for the base, the height for the side stop [m],
            1e-3 to 1000.
        length: length of the lines along the wall [m], 1e-3 to 1000.
        frequency: the frequency of the damping ratio, see `reference_frequency` [rad/s], 1e-3 to 1e9.
        points: number of contact lines, 2 to 1000.
        friction: coefficient of friction of every line [-], 0 to 10, or None. A base of None holds: it does not slide,
            as rocking theory has it. A side of None is smooth.

    Raises:
        ValueError: for a value outside its range.
    """

    k_n: InterfaceStiffness
    xi: Xi
    face: Annotated[float, Within(1e-3, 1000, "m")]
    length: Annotated[float, Within(1e-3, 1000, "m")]
    frequency: Annotated[float, Within(1e-3, 1e9, "rad/s", "reference frequency")]
    points: PointCount = 2
    friction: FaceFriction = None

    def __post_init__(self) -> None:
        keep_declared(self)
        if self.xi > HIGHEST_XI * (1 + 1e-9):
            warn_of(
                f"xi = {self.xi:g} is {self.xi:.0%} of critical, and the laws end at {HIGHEST_XI:.0%}; "
                "damping ratios are fractions",
                Implausible,
            )

    def __repr__(self) -> str:
        friction = "" if self.friction is None else f", friction {self.friction:.3g}"
        size = f"{self.face:.6g} x {self.length:.6g} m, {self.points} lines"
        return (
            f"<Interface k_n = {self.k_n:.4g} N/m3, xi = {self.xi:.4g}{friction}: {size}, {self.frequency:.4g} rad/s>"
        )

    @cached_property
    def _lines(self) -> tuple[Array, Array]:
        return contact_lines(self.face, self.points)

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


def _predicted_ratios(law: DampingFunction, wall: Block, e: Restitution, k_base: float) -> tuple[float, float]:
    """The two damping ratios of a law of the user, or a TypeError that names the law."""
    refusal = f"law = {shown(law)} is not called as law(wall, e, k_base) to give two numbers"
    if not takes(law, 3):
        raise TypeError(refusal)
    returned: object = law(wall, e, k_base)
    if not is_iterable(returned) or not isinstance(returned, Sequence | np.ndarray) or len(returned) != 2:
        raise TypeError(f"{refusal}: it gives {shown(returned)}")
    xi_base, xi_side = returned
    return require_real("xi of the base from the law", xi_base), require_real("xi of the side from the law", xi_side)


def required_law(law: AnyLaw | str | None, points: int = 2) -> AnyLaw:
    """A law, by its name too; None stands for the calibrated one of a number of contact lines a face."""
    if law is None:
        return CALIBRATED if points == 2 else CALIBRATED_BED
    if isinstance(law, str):
        return law_named(law)
    if not callable(law):
        raise TypeError(f"law = {shown(law)} is neither a law nor the name of one")
    return law


def _differences_from_fit(
    law: DampingLaw, points: int, k_side: float | None, friction: float | None, side_friction: float | None
) -> Iterator[str]:
    """How contacts differ from those that a law was fitted for, in words."""
    if law.points not in (None, points):
        yield f"{law.name} was fitted for {law.points} contact lines a face, not {points}"
    if law.points is None and k_side is not None:
        yield (
            f"{law.name} was fitted in another code. Against a side stop its |e| is off by -43 to +119 % on the "
            "contacts of this one (docs/damping.md); CALIBRATED is made for them"
        )
    if side_friction or (friction is not None and friction < NEARLY_HELD):
        yield (
            f"{law.name} was fitted for a base that holds and a smooth side, not for friction = {friction} and "
            f"side_friction = {side_friction}; matched_contacts finds the damping for them"
        )


@dataclass(frozen=True)
class Contacts:
    """The interfaces of one wall: its base and, where it has one, its side stop.

    Args:
        base: the base, over the thickness of the wall.
        side: the side stop over the whole inner face, or None for a wall that never meets one.
        law: name of the damping law, recorded in the generated model.
        stop_top: height that the side stop reaches for which the damping was chosen [m], 0.01 to 200; None if unknown.
    """

    base: Interface
    side: Interface | None = None
    law: str = "given"
    stop_top: StopTop = field(default=None, kw_only=True, compare=False, repr=False)

    def __post_init__(self) -> None:
        require_kind("base", self.base, Interface)
        require_kind("side", self.side, Interface, type(None))
        require_text("law", self.law)
        keep_declared(self)

    def __repr__(self) -> str:
        parts = []
        for name, interface in zip(("base", "side"), self.faces(side_stop=True), strict=False):
            friction = "" if interface.friction is None else f", friction {interface.friction:.3g}"
            parts.append(f"{name} k_n = {interface.k_n:.4g} N/m3, xi = {interface.xi:.4g}{friction}")
        return f"<Contacts, law {self.law}, {self.base.points} lines a face: {'; '.join(parts)}>"

    @classmethod
    @within_ranges
    def from_damping(
        cls,
        wall: Block,
        *,
        k_base: BaseStiffness,
        xi_base: Xi,
        k_side: SideStiffness = None,
        xi_side: Xi = 0.0,
        points: PointCount = 2,
        friction: FaceFriction = None,
        side_friction: FaceFriction = None,
        law: str = "given",
        stop_top: StopTop = None,
    ) -> Contacts:
        """Interfaces of `wall` from stiffnesses and damping ratios.

        Args:
            wall: the wall.
            k_base, k_side: interface stiffness of base and side [N/m3], 1e4 to 1e14; no side stop without `k_side`.
            xi_base, xi_side: their damping ratios, see `Interface` [-], 0 to 100.
            points: contact lines a face, 2 to 1000.
            friction, side_friction: coefficients as in `Interface` [-], 0 to 10. By default the base holds and the side
                is smooth.
            law, stop_top: as of `Contacts`.

        Raises:
            ValueError: for a value outside its range, or a base too soft for the wall to stand on.
        """
        require_kind("wall", wall, Block)
        omega = reference_frequency(wall, k_base, points)
        base = Interface(k_base, xi_base, 2 * wall.half_base, wall.base_length, omega, points, friction)
        side = None
        if k_side is not None:
            side = Interface(k_side, xi_side, 2 * wall.h, wall.length, omega, points, side_friction)
        overturning_moment = wall.weight * wall.centroid_height  # moment for a unit of rotation
        if base.K_rot <= overturning_moment:
            softest = k_base * overturning_moment / base.K_rot
            raise ValueError(
                f"base stiffness k_base = {k_base:g} N/m3 cannot hold the wall upright; "
                f"the valid range is k_base > {softest:.3g} N/m3"
            )
        return cls(base, side, law, stop_top=stop_top)

    @classmethod
    @within_ranges
    def from_law(
        cls,
        wall: Block,
        e: Restitution,
        k_base: BaseStiffness,
        k_side: SideStiffness = None,
        law: AnyLaw | str | None = None,
        points: PointCount = 2,
        amplitude: Amplitude = 0.5,
        friction: FaceFriction = None,
        side_friction: FaceFriction = None,
    ) -> Contacts:
        """Interfaces of `wall` whose damping ratios the law predicts, in the chosen layout.

        By default the base holds and the side is smooth. The laws were fitted for such walls.
        `mjrock.matched_contacts` finds the damping for another friction.

        Args:
            wall, e: the wall, and the restitution of the interfaces.
            k_base, k_side: interface stiffness of base and side [N/m3], 1e4 to 1e14; no side stop without `k_side`.
            law: a law or its name; None takes CALIBRATED for two lines and CALIBRATED_BED for more. A law of your own
                is called as `law(wall, e, k_base)`; a `DampingLaw` takes `k_side` and `amplitude` too.
            points: contact lines a face, 2 to 1000.
            amplitude: rotation theta_0/alpha from which the wall falls to the rebound that matters most [-], 1e-3 to 1.
            friction, side_friction: coefficients as in `Interface` [-], 0 to 10.

        Raises:
            TypeError: for what is no law, or a law that does not give its numbers.
            ValueError: as `from_damping`, for an `e.side` that is no rebound, and what the law raises.

        Warns:
            UserWarning: what the law warns of; where it was fitted for another number of lines or another friction;
                and, with a side stop, where it was fitted in another code, as PUBLISHED was, or where the base is so
                soft that the rebound of `e` lifts no edge.
        """
        require_kind("wall", wall, Block)
        require_kind("e", e, Restitution)
        law = required_law(law, points)
        if k_side is not None:
            e.require_rebound()
        if isinstance(law, DampingLaw):
            xi_base, xi_side = law(wall, e, k_base, k_side, amplitude)
            for difference in _differences_from_fit(law, points, k_side, friction, side_friction):
                warn_of(difference)
        else:
            xi_base, xi_side = _predicted_ratios(law, wall, e, k_base)
        if unlike_wall := e.difference_from(wall, None):
            warn_of(unlike_wall, Implausible)
        if k_side is not None and (rebound := rebound_over_uplift(wall, e, k_base, amplitude)) < 1:
            warn_of(
                f"the base is too soft for the rebound that e requires from {amplitude:g} alpha: it would turn the "
                f"wall by {rebound:.2g} of the rotation that lifts an edge off a base of {k_base:g} N/m3. The rebound "
                f"is then elastic or larger than required. Give a base above {k_base / max(rebound, 1e-9):.2g} N/m3"
            )
        name = getattr(law, "name", getattr(law, "__name__", "given"))
        return cls.from_damping(
            wall,
            k_base=k_base,
            xi_base=xi_base,
            k_side=k_side,
            xi_side=xi_side,
            points=points,
            friction=friction,
            side_friction=side_friction,
            law=name,
            stop_top=e.stop_top(wall),
        )

    def faces(self, *, side_stop: bool) -> list[Interface]:
        """The interfaces that a case with or without a side stop meets, the base first."""
        return [self.base] + ([self.side] if side_stop and self.side else [])

    def side_up_to(self, top: float) -> Interface:
        """The interface of a side stop that reaches from the base up to `top` [m], with the same lines spread over it.

        Raises:
            ValueError: if there is no side.

        Warns:
            Implausible: if the damping was chosen for a stop of another height.
        """
        if self.stop_top is not None and not math.isclose(top, self.stop_top, rel_tol=ANOTHER_WALL):
            warn_of(
                f"the damping was chosen for a side stop up to {self.stop_top:.4g} m, and that of the case reaches "
                f"{top:.4g} m; take Restitution.from_geometry(wall, stop_top={top:.4g}) and "
                f"matched_contacts(..., side_stop=SideStop({top:.4g}))",
                Implausible,
            )
        return self._required_side if top == self._required_side.face else replace(self._required_side, face=top)

    @property
    def _required_side(self) -> Interface:
        if self.side is None:
            raise ValueError("the case has a side stop but the contacts have none; give k_side when making them")
        return self.side

    def require_fit(self, wall: Block, *, side_stop: bool) -> None:
        """Raise ValueError unless these interfaces have the size of `wall`, and a side where the case has a stop."""
        faces = [("base", self.base, (2 * wall.half_base, wall.base_length))]
        if side_stop:
            faces.append(("side", self._required_side, (2 * wall.h, wall.length)))
        for name, interface, required in faces:
            size = interface.face, interface.length
            if not all(math.isclose(span, needed, rel_tol=1e-9) for span, needed in zip(size, required, strict=True)):
                raise ValueError(
                    f"the {name} contacts were made for a face of {size[0]:g} x {size[1]:g} m, "
                    f"but that of the wall of this case is {required[0]:g} x {required[1]:g} m"
                )

    def uplift_rotation(self, wall: Block) -> float:
        """Rotation at which the first edge of a wall at rest decompresses [rad]; below it the wall does not rock."""
        return wall.weight / (float(self.base.stiffness.sum()) * wall.half_base)

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


class Uplift(NamedTuple):
    """Where the rocking of a wall starts.

    Args:
        rotation: rotation at which the first edge of the wall decompresses under its weight and loads [rad].
        energy: energy that tilts the wall so far from upright, its loads in the middle [J].
    """

    rotation: float
    energy: float

    @classmethod
    def from_case(cls, case: Case, contacts: Contacts) -> Uplift:
        """The uplift of a case. Loads and thrusts that make the wall lean leave the energy as it is."""
        base, moment = contacts.base, case.restoring
        rotation = case.pressing / (float(base.stiffness.sum()) * case.block.half_base)
        stiffness = base.K_rot - 0.5 * (moment.outer.Q + moment.inner.Q)
        return cls(rotation, 0.5 * stiffness * rotation**2)
