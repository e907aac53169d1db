"""Compliant interfaces: stiffness per area and damping ratio, laid out as contact points, in physical units only."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np

from ...quantities import Array, Implausible, Within, keep_declared, require_kind, warn_of, within_ranges
from ..wall.block import Block

LAWS_END = 0.3
"""Highest damping ratio that the laws predict and searches try [-], see `mjrock.problem.damping.law`."""


PointCount = Annotated[int, Within(2, 1000, name="contact points", whole=True)]
"""Contact lines of a face."""


@within_ranges
def contact_lines(face: float, points: PointCount) -> tuple[Array, Array]:
    """Positions along a face of width `face` [m] from its centre [m], and the widths that are tributary to them [m].

    The lines are evenly spaced from edge to edge, so that the outer two have half the tributary width of the others.
    Two lines are the corners with half the face each. Many lines approach a uniform bed.
    """
    positions = np.linspace(-face / 2, face / 2, points)
    widths = np.full(points, face / (points - 1))
    widths[[0, -1]] /= 2
    return positions, widths


@within_ranges
def reference_frequency(
    wall: Block, k_n: Annotated[float, Within(1e4, 1e14, "N/m3", "interface stiffness k_n")], points: int = 2
) -> float:
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
    arm = math.hypot(wall.centroid_height, wall.centroid_offset)
    return math.sqrt(K_rot / (wall.inertia + wall.mass * arm**2))


@dataclass(frozen=True)
class Interface:
    """One compliant face: a bed of unilateral springs and dashpots lumped at contact lines by tributary area.

    Args:
        k_n: normal interface stiffness [N/m3], 1e4 to 1e14.
        xi: damping ratio [-] as a fraction, 0 to 100.
        face: width of the face across the lines: the thickness for the base, the height for the side stop [m],
            1e-3 to 1000.
        length: length of the lines along the wall [m], 1e-3 to 1000.
        frequency: what the damping ratio refers to, see `reference_frequency` [rad/s], 1e-3 to 1e9.
        points: number of contact lines, 2 to 1000.
        friction: coefficient of friction of every line [-], 0 to 10, or None. A base of None holds: it does not slide,
            as rocking theory has it. A side of None is smooth.

    Raises:
        ValueError: for a value outside its range.
    """

    k_n: Annotated[float, Within(1e4, 1e14, "N/m3", "interface stiffness k_n")]
    xi: Annotated[float, Within(0, 100, name="damping ratio xi")]
    face: Annotated[float, Within(1e-3, 1000, "m")]
    length: Annotated[float, Within(1e-3, 1000, "m")]
    frequency: Annotated[float, Within(1e-3, 1e9, "rad/s", "reference frequency")]
    points: PointCount = 2
    friction: Annotated[float | None, Within(0, 10)] = None

    def __post_init__(self) -> None:
        keep_declared(self)
        if self.xi > LAWS_END * (1 + 1e-9):
            warn_of(
                f"xi = {self.xi:g} is {self.xi:.0%} of critical, and the laws end at {LAWS_END:.0%}; "
                "damping ratios are fractions",
                Implausible,
            )

    def __repr__(self) -> str:
        held = "" if self.friction is None else f", friction {self.friction:.3g}"
        size = f"{self.face:.6g} x {self.length:.6g} m, {self.points} lines"
        return f"<Interface k_n = {self.k_n:.4g} N/m3, xi = {self.xi:.4g}{held}: {size}, {self.frequency:.4g} rad/s>"

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
