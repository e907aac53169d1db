"""The intensity that overturns a wall or brings masonry down under the motion of its case, as a task of a campaign."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar

from ...quantities import GRAVITY, Within, keep_declared, require_kind, short_repr, shown
from ..analysis import Analysis, subject_of
from ..campaign.task import Row

GROWTH = 1.25
"""Ratio of neighbouring scales while a bracket is searched [-]. A wall may stand again above a scale that overturns it:
a finer ratio misses fewer of such islands."""
LARGEST_SCALE, LEAST_SCALE = 1e3, 1e-6
"""Scales beyond which the search for a bracket gives up, over the scale it starts at [-]."""

NAMES = (
    "solver", "law", "capacity_g", "capacity_scale", "stands_at_g", "stands_down_to_g", "stands_above_g", "runs",
    "message",
)  # fmt: skip
"""The columns of a row."""


def bracket(falls: Callable[[float], bool], start: float = 1.0, growth: float = GROWTH) -> tuple[float, float]:
    """Two neighbouring scales of which the lower leaves a wall standing and the upper overturns it.

    From `start` the scale goes up by `growth` until the wall falls, or down until it stands; ValueError if it stands at
    LARGEST times the start, or falls at LEAST times the start.
    """
    low = high = start
    if falls(start):
        while falls(low := high / growth):
            if low < LEAST_SCALE * start:
                raise ValueError(f"the wall overturns at every scale from {start:g} down to {low:g}")
            high = low
        return low, high
    while not falls(high := low * growth):
        if high > LARGEST_SCALE * start:
            raise ValueError(f"the wall stands at every scale from {start:g} up to {high:g}; no capacity is found")
        low = high
    return low, high


def halved(falls: Callable[[float], bool], low: float, high: float, tolerance: float) -> tuple[float, float]:
    """The interval between a scale that leaves a wall standing and one that overturns it, halved until it is narrower
    than `tolerance` times its upper end."""
    while high - low > tolerance * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if falls(middle) else (middle, high)
    return low, high


def lowest(falls: Callable[[float], bool], low: float, high: float, below: int, spacing: float) -> tuple[float, float]:
    """Two neighbouring scales, as those given, below which the wall has stood at so many weaker ones in a row.

    From `low` the scale goes down by `spacing` [-] at a time. Where the wall falls, that scale is the upper one of the
    two, and the count begins again. ValueError if it falls at LEAST times `low` or less.
    """
    scale, stood, least = low, 0, LEAST_SCALE * low
    while stood < below:
        scale /= 1 + spacing
        if falls(scale):
            if scale < least:
                raise ValueError(f"the wall overturns at scales down to {scale:g}; no capacity is found")
            high, stood = scale, -1
        else:
            low = scale if stood < 0 else low
            stood += 1
    return low, high


@dataclass(frozen=True)
class Capacity:
    """The lowest intensity found at which the motion of a case overturns its wall; a task of a campaign, as an
    `Analysis` is.

    Masonry is lost when a block falls. The motions of the case in all directions are scaled together, and the intensity
    is that of `motion`, or in space without it of `transverse`. From the scale `start` the search goes up by a quarter
    at a time until the wall falls, or down until it stands, and then halves the interval. A wall may fall in a band of
    intensities, stand above it and fall again. So the search then goes down, `spacing` at a time, until the wall has
    stood at `below` intensities in a row. The lowest at which it falls is the upper end of the answer.

    Its row has `capacity_g`, the peak ground acceleration over g that overturns the wall, `capacity_scale`, the factor
    on the motion of the case, `stands_at_g`, hardly lower, at which the wall stands, and `stands_down_to_g`, the lowest
    of the intensities tried below, at all of which it stands. `stands_above_g` is the highest above the capacity that
    was tried and at which the wall stands, None if there is none; the message then says "Not monotonic". A band
    narrower than the spacing, or below the last look, may be missed. With `below=0` the answer is one edge of perhaps
    several.

    Looks below make the search longer. In 28 cases of theory, each from five starts, `below=0` takes 10 runs in the
    mean, the default 27, and 30 looks at 1 % take 52. The answer is within 2 % of the lowest intensity that overturns
    in 31, 63 and 79 % of them, within 10 % in 51, 83 and 89 % (`scripts/checks/capacity_bands.py`).

    Args:
        analysis: the case with its motion, solver and, of a wall, contacts.
        tolerance: how far below the answer the wall may be known to stand, over the answer [-], 1e-6 to 0.5.
        start: scale of the motion from which the search starts [-], 1e-6 to 1e6.
        below: at how many weaker intensities the wall has to stand, 0 to 1000.
        spacing: ratio of two of them, less one [-], 1e-4 to 0.25.

    Raises:
        TypeError: for what is no `Analysis`.
        ValueError: for a value outside its range, or a case whose ground does not move horizontally.
    """

    COLUMNS: ClassVar[tuple[str, ...]] = NAMES
    PEAK: ClassVar[str] = "capacity_g"
    """The column that a study of sensitivity looks at."""

    analysis: Analysis
    tolerance: Annotated[float, Within(1e-6, 0.5)] = 0.01
    start: Annotated[float, Within(1e-6, 1e6)] = 1.0
    below: Annotated[int, Within(0, 1000, whole=True)] = 12
    spacing: Annotated[float, Within(1e-4, GROWTH - 1)] = 0.02

    __repr__ = short_repr

    def __post_init__(self) -> None:
        require_kind("analysis", self.analysis, Analysis)
        keep_declared(self)
        if not self.peak > 0:
            raise ValueError(f"analysis = {shown(self.analysis)} has no horizontal motion to scale")

    @property
    def peak(self) -> float:
        """Largest horizontal acceleration of the case over g [-], 0 where there is none."""
        case = self.analysis.case
        motion = case.motion or case.transverse
        return 0.0 if motion is None else motion.peak / GRAVITY

    @property
    def labels(self) -> Mapping[str, object]:
        """The labels of the analysis."""
        return self.analysis.labels

    @property
    def solver(self) -> str:
        """The solver of the analysis."""
        return self.analysis.solver

    def labelled(self, labels: Mapping[str, object]) -> Capacity:
        """The same task with other labels."""
        return replace(self, analysis=replace(self.analysis, labels=labels))

    def scaled(self, scale: float) -> Analysis:
        """The analysis with its motions times `scale`."""
        case = self.analysis.case
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".* peaks at ", category=UserWarning)  # weak and strong are meant
            moved: dict[str, Any] = {name: ground.scaled(scale) for name, ground in case.grounds.items()}
            return replace(self.analysis, case=replace(case, **moved))

    def __call__(self, history: Path | None = None) -> Row:
        """Search, and return the columns of the row; a history is that of the run that overturned the wall."""
        tried: dict[float, bool] = {}

        def falls(scale: float) -> bool:
            if scale not in tried:
                analysis = self.scaled(scale)
                tried[scale] = bool(analysis()[analysis.PEAK] == math.inf)
            return tried[scale]

        low, high = halved(falls, *bracket(falls, self.start), max(self.tolerance, self.spacing))
        low, high = lowest(falls, low, high, self.below, self.spacing)
        least, (low, high) = low / (1 + self.spacing) ** self.below, halved(falls, low, high, self.tolerance)
        if history is not None:
            self.scaled(high)(history)
        peak = self.peak
        above = max((scale for scale, fell in tried.items() if scale > high and not fell), default=None)
        values = (
            self.solver, self.analysis.law, high * peak, high, low * peak, least * peak,
            None if above is None else above * peak, len(tried), self._said(low, high, least, above),
        )  # fmt: skip
        return dict(zip(self.COLUMNS, values, strict=True))

    def _said(self, low: float, high: float, least: float, above: float | None) -> str:
        """What is known, in words: the scales between which the outcome changes, and what was tried beside them."""
        falls = subject_of(self.analysis.case).FALLS
        message = f"The {falls} at {high * self.peak:.4g} g and stands at {low * self.peak:.4g} g"
        if self.below:
            down = f"{100 * self.spacing:.3g} % apart, down to {least * self.peak:.4g} g"
            message += f" and at all {self.below} lower intensities that were tried, {down}."
        else:
            message += ". It is an edge: whether a weaker intensity does so too was not looked at."
        if above is not None:
            message += f" Not monotonic: it stands at {above * self.peak:.4g} g too."
        return message
