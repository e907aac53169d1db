"""Response spectra of codes, on the ground and on a floor, and of ground motions, and motions scaled to them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...quantities import (
    GRAVITY,
    Array,
    Implausible,
    OneOf,
    Within,
    frozen,
    keep,
    keep_declared,
    require_array,
    require_increasing,
    require_kind,
    require_one_of,
    require_reals,
    require_row,
    require_within,
    short_repr,
    spelt,
    warn_of,
    within_ranges,
)
from .motion import GroundMotion
from .oscillator import (
    LONGEST_PERIOD,
    SHORTEST_PERIOD,
    BuildingDamping,
    ModeShape,
    Participation,
    Periods,
    building_modes,
    of_pieces,
    one_or_row,
    oscillator_steps,
    relative_displacement,
)

LEAST_ETA = 0.55
"""Least correction for damping [-], NTC 2018 equation 3.2.4 and EN 1998-1 equation 3.6."""


class GroundNTC(NamedTuple):
    """A ground type of NTC 2018.

    Args:
        intercept, slope, lowest, highest: of S_S = intercept - slope F_0 a_g/g, between two bounds [-], table 3.2.IV.
        factor, power: of C_C = factor T_C*^power [-], table 3.2.IV.
        TE: T_E [s], table 3.2.VII.
    """

    intercept: float
    slope: float
    lowest: float
    highest: float
    factor: float
    power: float
    TE: float

    def soil_factor(self, F0: float, ag: float) -> float:
        """S_S of a_g [m/s2] and F_0 [-]."""
        return min(max(self.intercept - self.slope * F0 * ag / GRAVITY, self.lowest), self.highest)

    def corner_period(self, Tc: float) -> float:
        """T_C = C_C T_C* [s]."""
        return float(self.factor * Tc**self.power * Tc)


class GroundEC8(NamedTuple):
    """A ground type of EN 1998-1:2004: S [-] and T_B, T_C, T_D [s], tables 3.2 and 3.3, recommended values; and T_E
    [s], table A.1, which has it for type 1 alone."""

    S: float
    TB: float
    TC: float
    TD: float
    TE: float


GROUNDS_NTC = {
    "A": GroundNTC(1.00, 0.00, 1.00, 1.00, 1.00, 0.00, 4.5),
    "B": GroundNTC(1.40, 0.40, 1.00, 1.20, 1.10, -0.20, 5.0),
    "C": GroundNTC(1.70, 0.60, 1.00, 1.50, 1.05, -0.33, 6.0),
    "D": GroundNTC(2.40, 1.50, 0.90, 1.80, 1.25, -0.50, 6.0),
    "E": GroundNTC(2.00, 1.10, 1.00, 1.60, 1.15, -0.40, 6.0),
}
TOPOGRAPHY_NTC = {"T1": 1.0, "T2": 1.2, "T3": 1.2, "T4": 1.4}
"""S_T [-], NTC 2018 table 3.2.V."""
GROUNDS_EC8 = {
    "EC8 type 1": {
        "A": GroundEC8(1.00, 0.15, 0.40, 2.0, 4.5),
        "B": GroundEC8(1.20, 0.15, 0.50, 2.0, 5.0),
        "C": GroundEC8(1.15, 0.20, 0.60, 2.0, 6.0),
        "D": GroundEC8(1.35, 0.20, 0.80, 2.0, 6.0),
        "E": GroundEC8(1.40, 0.15, 0.50, 2.0, 6.0),
    },
    "EC8 type 2": {
        "A": GroundEC8(1.00, 0.05, 0.25, 1.2, math.inf),
        "B": GroundEC8(1.35, 0.05, 0.25, 1.2, math.inf),
        "C": GroundEC8(1.50, 0.10, 0.25, 1.2, math.inf),
        "D": GroundEC8(1.80, 0.10, 0.30, 1.2, math.inf),
        "E": GroundEC8(1.60, 0.05, 0.25, 1.2, math.inf),
    },
}
LONGEST_SPECTRAL = 10.0
"""T_F, beyond which the displacement is that of the ground [s]."""
PLATEAU_FROM, PLATEAU_TO = 0.8, 1.1
"""a and b, the periods between which a mode amplifies most, over its own [-], Circolare 2019 n. 7, C7.2.3."""
STEPS_BY_PIECES = 200
"""Steps to a period on ground that moves by pieces, between which the peak of a sine is missed by at most 1e-4."""
PeakOnRock = Annotated[float, Within(0.05, 10, "m/s2")]
PeriodOnRock = Annotated[float | None, Within(0.05, 1, "s")]
SoilFactor = Annotated[float, Within(0.5, 5)]
CornerPeriod = Annotated[float, Within(0.01, LONGEST_PERIOD, "s")]
SpectralDamping = Annotated[float, Within(0.005, 0.5)]
PROBABLY_IN_G = 0.35
"""a_g below which it was probably given in g [m/s2]."""


@dataclass(frozen=True)
class CodeSpectrum:
    """The elastic response spectrum of a code for one site. Called with T and xi it gives S_e [m/s2].

    Args:
        code: its name.
        ag: peak acceleration on rock a_g [m/s2], 0.05 to 10.
        S: soil factor S_S S_T [-], 0.5 to 5.
        amplification: largest amplification F_0 at 5 % damping [-], 1 to 10.
        TB, TC, TD, TE: corner periods [s], 0.01 to 100. TE is infinite where the displacement is S_e (T/2 pi)^2 at any
            period.
        damping: damping ratio that is taken where none is given [-], 0.005 to 0.5.
        soil: ground type; empty where it is not known, here and below.
        topography: its category, of NTC 2018 alone.
        Tc: T_C* of the limit state, of NTC 2018 alone [s], 0.05 to 1.

    Raises:
        TypeError, ValueError: for a value outside its range.
    """

    code: str
    ag: PeakOnRock
    S: SoilFactor
    amplification: Annotated[float, Within(1, 10)]
    TB: CornerPeriod
    TC: CornerPeriod
    TD: CornerPeriod
    TE: Annotated[float, Within(0.01, LONGEST_PERIOD, "s", infinite=True)]
    damping: SpectralDamping = 0.05
    soil: str = ""
    topography: str = ""
    Tc: PeriodOnRock = None

    def __post_init__(self) -> None:
        keep_declared(self)

    def __repr__(self) -> str:
        corners = ", ".join(f"{getattr(self, name):.3g}" for name in ("TB", "TC", "TD", "TE"))
        return (
            f"<CodeSpectrum {self.code}: a_g = {self.ag:.4g} m/s2, S = {self.S:.4g}, F_0 = {self.amplification:.4g}, "
            f"T_B, T_C, T_D, T_E = {corners} s>"
        )

    def __call__(self, T: ArrayLike, damping: float | None = None) -> Array:
        """S_e at the periods T [s], 0 to 100 [m/s2]; NTC 2018 equation 3.2.2, EN 1998-1 equations 3.2 to 3.5."""
        T, eta = periods_of(T), damping_correction(self.damping if damping is None else damping)
        top = self.ag * self.S * eta * self.amplification
        rising = self.ag * self.S * (1 + T / self.TB * (eta * self.amplification - 1))
        falling = top * self.TC / np.maximum(T, self.TC) * self.TD / np.maximum(T, self.TD)
        return np.where(self.TB > T, rising, falling)

    def displacement(self, T: ArrayLike, damping: float | None = None) -> Array:
        """S_De at the periods T [s] [m]; NTC 2018 equations 3.2.12 and 3.2.13, EN 1998-1 equations 3.7, A.1 and A.2."""
        periods, eta = periods_of(T), damping_correction(self.damping if damping is None else damping)
        short = np.minimum(periods, self.TE)
        below = self(short, damping) * (short / (2 * math.pi)) ** 2
        ground = 0.025 * self.ag * self.S * self.TC * self.TD
        share = np.clip((periods - self.TE) / (LONGEST_SPECTRAL - self.TE), 0.0, 1.0) if math.isfinite(self.TE) else 0.0
        largest = ground * (self.amplification * eta + (1 - self.amplification * eta) * share)
        return np.where(periods > self.TE, largest, below)

    @property
    def peak(self) -> float:
        """Peak ground acceleration a_g S [m/s2]."""
        return self.ag * self.S

    def at_height(
        self: CodeSpectrum | PointSpectrum,
        period: Periods,
        damping: BuildingDamping = 0.05,
        *,
        participation: Participation = 1.0,
        height: ModeShape = 1.0,
    ) -> FloorSpectrum:
        """The spectrum on a floor of a building that vibrates in one or some modes.

        Args:
            period: of the modes T_k [s], 0.01 to 100, shape (k,) or one.
            damping: of the building xi_k [-], 0.005 to 0.3.
            participation: gamma_k of each mode [-], -3 to 3; 3 n / (2 n + 1) for n equal storeys in the first mode.
            height: psi_k, the shape of each mode at the floor over that at the top [-], -1 to 1; z / H for a straight
                first mode.

        Raises:
            TypeError, ValueError: for a value outside its range, or shapes that differ.
        """
        return FloorSpectrum(self, *building_modes(period, damping, participation, height))


class _Alike:
    """A spectrum that equals another with the same numbers."""

    def __eq__(self, other: object) -> bool:
        same_type = type(self) is type(other)
        return same_type and all(map(np.array_equal, vars(self).values(), vars(other).values()))

    def __hash__(self) -> int:
        return hash(type(self))


@dataclass(frozen=True, eq=False)
class FloorSpectrum(_Alike):
    """The elastic spectrum on a floor, Circolare 2019 n. 7, C7.2.3. Called with T and xi it gives S_eZ [m/s2].

    Each mode amplifies oscillators of periods near its own (equation C7.2.6). S_eZ is the root of the sum of the
    squares over the modes, and beyond the period T_1 of the first mode at least the spectrum of the ground (C7.2.5).

    Args:
        ground: spectrum on the ground.
        period: of the modes T_k [s], shape (k,).
        damping: of the building xi_k [-].
        participation: gamma_k of each mode [-], shape (k,).
        height: psi_k, the shape of each mode at the floor over that at the top [-], shape (k,).

    Warns:
        Implausible: for a floor that is accelerated less than the ground, of which C7.2.5 takes nothing up to T_1.
    """

    ground: CodeSpectrum | PointSpectrum
    period: Array
    damping: float
    participation: Array
    height: Array

    __repr__ = short_repr

    def __post_init__(self) -> None:
        if self.peak < self.ground.peak:
            warn_of(
                f"the floor has a peak of {self.peak:.3g} m/s2 and the ground one of {self.ground.peak:.3g} "
                "m/s2: up to T_1 C7.2.5 takes the modes alone; give more modes, or check the mechanism on the "
                "ground too",
                Implausible,
            )

    @property
    def motion(self) -> Array:
        """gamma_k psi_k of each mode [-], shape (k,)."""
        return self.participation * self.height

    @property
    def first(self) -> float:
        """Period T_1 of the first mode [s]."""
        return float(self.period.max())

    def __call__(self, T: ArrayLike, damping: float | None = None) -> Array:
        """S_eZ at the periods T [s], 0 to 100 [m/s2], equation C7.2.5."""
        T, xi = periods_of(T), self.ground.damping if damping is None else damping
        # xi_k counts as a fraction here, 4.9 at 5 %, as an oscillator on another in resonance has it; in the root in %
        top = 1.1 / math.sqrt(self.damping) * damping_correction(xi)
        square = np.zeros(T.shape)
        for Tk, motion in zip(self.period.tolist(), self.motion.tolist(), strict=True):
            floor = self.ground(Tk, self.damping) * abs(motion) * math.sqrt(1 + 4 * self.damping**2)
            shorter = np.clip(1 - T / (PLATEAU_FROM * Tk), 0.0, None) ** 1.6
            longer = np.clip(T / (PLATEAU_TO * Tk) - 1, 0.0, None) ** 1.2
            square = square + (top * floor / (1 + (top - 1) * (shorter + longer))) ** 2
        return np.maximum(np.sqrt(square), np.where(self.first < T, self.ground(T, xi), 0.0))

    def displacement(self, T: ArrayLike, damping: float | None = None) -> Array:
        """S_DeZ at the periods T [s], S_eZ (T/2 pi)^2 [m]; beyond b T_1 at least S_eZ(T_1) (b T_1/2 pi)^2, equation
        C8.7.1.12."""
        T, edge = periods_of(T), PLATEAU_TO * self.first
        least_displacement = self(self.first, damping) * (edge / (2 * math.pi)) ** 2
        return np.maximum(self(T, damping) * (T / (2 * math.pi)) ** 2, np.where(edge < T, least_displacement, 0.0))

    @property
    def peak(self) -> float:
        """Peak acceleration of the floor a_Z, S_eZ at T = 0 [m/s2], equation C7.2.8."""
        return float(self(0.0))


@dataclass(frozen=True, eq=False)
class PointSpectrum(_Alike):
    """An elastic spectrum given as points, linear between them, constant beyond them. It stands wherever a spectrum of
    a code does.

    Other damping ratios multiply it by the correction eta of the codes. Its peak acceleration is that at the first
    period, which is to be 0 or that of a rigid body.

    Args:
        period: T, increasing [s], 0 to 100, shape (n,).
        acceleration: S_e at them [m/s2], 1e-6 to 1000, shape (n,).
        damping: damping ratio of the points [-], 0.005 to 0.5.

    Raises:
        TypeError, ValueError: for a value outside its range.

    Examples:
        >>> site = mr.PointSpectrum([0.0, 0.2, 0.6, 4.0], [2.0, 5.0, 5.0, 0.75])
        >>> round(float(site(0.1)), 2), site.peak
        (3.5, 2.0)
    """

    period: Annotated[Array, Within(0, LONGEST_PERIOD, "s")]
    acceleration: Annotated[Array, Within(1e-6, 1e3, "m/s2")]
    damping: SpectralDamping = 0.05

    def __post_init__(self) -> None:
        keep_declared(self, "spectrum")
        period = require_increasing("period", self.period, "period [s]", LONGEST_PERIOD, f"0 to {LONGEST_PERIOD:g} s")
        acceleration = require_array("acceleration", self.acceleration, (len(period),))
        keep(self, period=frozen(period), acceleration=frozen(acceleration))

    def __repr__(self) -> str:
        return f"<PointSpectrum of {len(self.period)} points up to {self.period[-1]:g} s, peak {self.peak:.3g} m/s2>"

    def __call__(self, T: ArrayLike, damping: float | None = None) -> Array:
        """S_e at the periods T [s], 0 to 100 [m/s2]."""
        factor = 1.0 if damping is None else damping_correction(damping) / damping_correction(self.damping)
        return np.asarray(factor * np.interp(periods_of(T), self.period, self.acceleration))

    def displacement(self, T: ArrayLike, damping: float | None = None) -> Array:
        """S_De at the periods T [s], S_e (T/2 pi)^2 [m]."""
        return np.asarray(self(T, damping) * (periods_of(T) / (2 * math.pi)) ** 2)

    @property
    def peak(self) -> float:
        """Peak acceleration of the ground, S_e at the first period [m/s2]."""
        return float(self.acceleration[0])

    at_height = CodeSpectrum.at_height


SpectrumOfCode = CodeSpectrum | FloorSpectrum | PointSpectrum
"""The spectrum of a code, on the ground or on a floor, or one given as points."""


@within_ranges
def code_spectrum(
    code: Annotated[str, OneOf(("NTC 2018", *GROUNDS_EC8))],
    *,
    ag: PeakOnRock,
    soil: Annotated[str, OneOf(GROUNDS_NTC)],
    F0: Annotated[float | None, Within(2, 4)] = None,
    Tc: PeriodOnRock = None,
    topography: Annotated[str, OneOf(TOPOGRAPHY_NTC)] = "T1",
    damping: SpectralDamping = 0.05,
    S: Annotated[float | None, Within(0.5, 5)] = None,
    TB: Annotated[float | None, Within(0.01, 1, "s")] = None,
    TC: Annotated[float | None, Within(0.05, 3, "s")] = None,
    TD: Annotated[float | None, Within(0.5, 10, "s")] = None,
) -> CodeSpectrum:
    """The elastic response spectrum of a code for one site.

    `spectrum(T, xi)` is the acceleration S_e [m/s2] and `spectrum.displacement(T, xi)` the displacement S_De [m].

    Args:
        code: "NTC 2018" (Italy), "EC8 type 1" or "EC8 type 2" (EN 1998-1:2004, recommended values).
        ag: peak acceleration on rock a_g of the limit state, with its factor of importance [m/s2], 0.05 to 10.
        soil: ground type, "A" to "E".
        F0: largest amplification F_0 of the limit state, of NTC 2018 alone [-], 2 to 4.
        Tc: T_C* of the limit state, of NTC 2018 alone [s], 0.05 to 1.
        topography: "T1" to "T4" of NTC 2018, with S_T at the top of the relief. EC8 takes T1 alone.
        damping: damping ratio that is taken where none is given [-], 0.005 to 0.5.
        S: soil factor of a national annex of EC8 [-], 0.5 to 5; None takes the recommended value, here and below.
        TB: first corner period of a national annex of EC8 [s], 0.01 to 1, less than TC.
        TC: second corner period of a national annex of EC8 [s], 0.05 to 3, less than TD.
        TD: third corner period of a national annex of EC8 [s], 0.5 to 10.

    Returns:
        The `CodeSpectrum`: called with a period [s] and a damping ratio [-] it gives the acceleration [m/s2].

    Raises:
        ValueError: for a code, a soil or a topography that is not known, or a value outside its range.

    Warns:
        Implausible: for an a_g below 0.35 m/s2, which is probably in g.

    Examples:
        >>> spectrum = mr.code_spectrum("EC8 type 1", ag=2.0, soil="B")
        >>> round(float(spectrum(0.3, 0.05)), 2)
        6.0
    """
    require_one_of("code", code, ("NTC 2018", *GROUNDS_EC8))
    require_one_of("soil", soil, GROUNDS_NTC)
    require_one_of("topography", topography, TOPOGRAPHY_NTC)
    if ag < PROBABLY_IN_G:
        warn_of(f"ag = {ag:g} m/s2 is {ag / GRAVITY:.3g} g; accelerations are in m/s2: is it in g?", Implausible)
    if code in GROUNDS_EC8:
        for name, value in (("F0", F0), ("Tc", Tc)):
            if value is not None:
                raise ValueError(f"{name} = {spelt(value)} is of NTC 2018; {code} takes ag and soil")
        if topography != "T1":
            raise ValueError(f"topography = {topography} is of NTC 2018; multiply ag for {code}")
        annex = {"S": S, "TB": TB, "TC": TC, "TD": TD}
        site = GROUNDS_EC8[code][soil]._replace(**{name: value for name, value in annex.items() if value is not None})
        if not site.TB < site.TC < site.TD:
            raise ValueError(f"TB, TC, TD = {site.TB:g}, {site.TC:g}, {site.TD:g} s do not increase")
        return CodeSpectrum(code, ag, **site._asdict(), amplification=2.5, damping=damping, soil=soil)
    for name, value in (("S", S), ("TB", TB), ("TC", TC), ("TD", TD)):
        if value is not None:
            raise ValueError(f"{name} = {spelt(value)} is of a national annex of EC8; NTC 2018 takes soil, F0 and Tc")
    if F0 is None or Tc is None:
        raise ValueError(f"{'Tc' if F0 else 'F0'} is missing: NTC 2018 takes ag, F0 and Tc of the limit state")
    ground = GROUNDS_NTC[soil]
    S = ground.soil_factor(F0, ag) * TOPOGRAPHY_NTC[topography]
    TC, TD = ground.corner_period(Tc), 4.0 * ag / GRAVITY + 1.6
    return CodeSpectrum(code, ag, S, F0, TC / 3, TC, TD, ground.TE, damping, soil, topography, Tc)


@within_ranges
def damping_correction(damping: Annotated[float, Within(0, 0.9)]) -> float:
    """Correction eta of a spectrum for damping [-], NTC 2018 equation 3.2.4, EN 1998-1 equation 3.6."""
    return max(math.sqrt(10 / (5 + 100 * damping)), LEAST_ETA)


def periods_of(T: ArrayLike) -> Array:
    """Periods as an array [s], each 0 to 100."""
    periods = require_reals("T", T, "one or more periods [s]")
    for period in np.atleast_1d(periods).tolist():
        require_within("T", period, 0.0, LONGEST_PERIOD, "s")
    return np.asarray(periods)


@dataclass(frozen=True, eq=False)
class ResponseSpectrum:
    """The largest response of linear oscillators to a ground motion.

    Args:
        period: their periods T [s], shape (n,).
        Sd: largest displacement relative to the ground [m], shape (n,).
        damping: their damping ratio [-].
    """

    period: Array
    Sd: Array
    damping: float

    __repr__ = short_repr

    @property
    def Sv(self) -> Array:
        """Pseudo-velocity 2 pi / T Sd [m/s], shape (n,)."""
        return 2 * math.pi / self.period * self.Sd

    @property
    def Sa(self) -> Array:
        """Pseudo-acceleration (2 pi / T)^2 Sd [m/s2], shape (n,)."""
        return (2 * math.pi / self.period) ** 2 * self.Sd

    @property
    def mean(self) -> float:
        """Geometric mean of Sa over the periods, a measure of intensity [m/s2]."""
        return float(np.exp(np.log(self.Sa).mean()))


def response_spectrum(motion: GroundMotion, periods: ArrayLike, damping: float = 0.05) -> ResponseSpectrum:
    """The response spectrum of a ground motion.

    Each oscillator is solved exactly for an acceleration that is linear between its samples, or jumps, and followed for
    one period after the last of them.

    Args:
        motion: the ground motion.
        periods: periods [s], 0.01 to 100, shape (n,), or one.
        damping: damping ratio [-], 0 to 0.9.

    Raises:
        TypeError, ValueError: for a value outside its range.
    """
    require_kind("motion", motion, GroundMotion)
    damping = require_within("damping", damping, 0.0, 0.9)
    T = one_or_row("periods", periods, SHORTEST_PERIOD, LONGEST_PERIOD, "s")
    largest = np.array([_largest(motion, float(period), damping) for period in T])
    return ResponseSpectrum(T, largest, damping)


def _largest(motion: GroundMotion, period: float, damping: float) -> float:
    """The largest displacement of an oscillator relative to the ground [m]."""
    if motion.instants is not None:
        until = motion.duration + period
        at = np.linspace(0.0, until, math.ceil(STEPS_BY_PIECES * until / period) + 1)
        return float(np.abs(of_pieces(motion.vertices, at, period, damping).displacement).max())
    parts = oscillator_steps(motion.dt, period)
    h = motion.dt / parts
    steps = parts * (len(motion.accel) - 1) + math.ceil(period / h)
    return float(np.abs(relative_displacement(motion(h * np.arange(steps + 1, dtype=float)), h, period, damping)).max())


def scaled_to_sa(motion: GroundMotion, period: float, sa: float, damping: float = 0.05) -> GroundMotion:
    """The motion scaled to a pseudo-acceleration Sa(T).

    Args:
        motion: the ground motion.
        period: T [s], 0.01 to 100.
        sa: the required pseudo-acceleration [m/s2], 1e-6 to 1e4.
        damping: damping ratio [-], 0 to 0.9.

    Raises:
        TypeError, ValueError: for a value outside its range, or a motion at rest.
    """
    period = require_within("period", period, SHORTEST_PERIOD, LONGEST_PERIOD, "s")
    return scaled_to_spectrum(motion, [period], [require_within("sa", sa, 1e-6, 1e4, "m/s2")], damping)


def scaled_to_spectrum(
    motion: GroundMotion, periods: ArrayLike, target: ArrayLike | SpectrumOfCode, damping: float = 0.05
) -> GroundMotion:
    """The motion scaled so that the geometric mean of its Sa over that of a target spectrum is one.

    One factor for the whole motion has the least squares of ln(Sa / target) over the periods.

    Args:
        motion: the ground motion.
        periods: periods [s], 0.01 to 100, shape (n,).
        target: pseudo-accelerations Sa of the target at them [m/s2], 1e-6 to 1e4, shape (n,), or a spectrum of a code.
        damping: damping ratio [-], 0 to 0.9.

    Raises:
        TypeError, ValueError: for a value outside its range, shapes that differ, or a motion at rest.
    """
    factor = factor_to_spectrum(motion, periods, target, damping)  # refuses what is no motion
    return scaled_by(factor, motion, periods, target)


def scaled_by(
    factor: float, motion: GroundMotion, periods: ArrayLike, target: ArrayLike | SpectrumOfCode
) -> GroundMotion:
    """The motion scaled by the factor of a target spectrum, whose header names both."""
    ground = target.ground if isinstance(target, FloorSpectrum) else target
    source = f"{ground.code}, ag = {ground.ag:.6g} m/s2" if isinstance(ground, CodeSpectrum) else "spectrum of points"
    source += " on a floor" if isinstance(target, FloorSpectrum) else ""
    at = ", ".join(f"{period:.6g}" for period in np.atleast_1d(np.asarray(periods, dtype=float)))
    text = f"{source}; factor {factor:.6g} over T = {at} s"
    return motion.scaled(factor).headed({**motion.header, "SCALED_TO": text})


def factor_to_spectrum(
    motion: GroundMotion, periods: ArrayLike, target: ArrayLike | SpectrumOfCode, damping: float
) -> float:
    """The factor of `scaled_to_spectrum` [-]."""
    spectrum = response_spectrum(motion, periods, damping)
    if isinstance(target, SpectrumOfCode):
        target = target(spectrum.period, damping)
    values = require_row("target", target, "pseudo-acceleration [m/s2]")
    for value in values:
        require_within("target", value, 1e-6, 1e4, "m/s2")
    if values.shape != spectrum.period.shape:
        raise ValueError(f"target has {len(values)} values and periods {len(spectrum.period)}; they have to be pairs")
    if motion.peak == 0:
        raise ValueError("motion is at rest: no factor gives it a spectrum")
    return float(np.exp(np.log(values / spectrum.Sa).mean()))
