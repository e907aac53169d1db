"""The intensity that overturns a wall or brings masonry down under the motion of its case, as a task of a campaign."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

from ..problem.ground.motion import GroundMotion
from ..problem.wall.case import Case
from ..quantities import GRAVITY, keep, require_kind, require_whole, require_within, shown
from .analysis import Analysis
from .campaign_task import Row

GROWTH = 1.25
"""Ratio of neighbouring scales while a bracket is searched [-]. A wall may stand again above a scale that overturns it:
a finer ratio misses fewer of such islands."""
LARGEST, LEAST = 1e3, 1e-6
"""Scales beyond which the search for a bracket gives up, over the scale it starts at [-]."""

NAMES = ("solver", "law", "capacity_g", "capacity_scale", "stands_at_g", "falls_below_g", "runs", "message")
"""The columns of a row."""


def bracket(falls: Callable[[float], bool], start: float = 1.0, growth: float = GROWTH) -> tuple[float, float]:
    """Two neighbouring scales of which the lower leaves a wall standing and the upper overturns it.

    From `start` the scale goes up by `growth` until the wall falls, or down until it stands; ValueError if it stands at
    LARGEST times the start, or falls at LEAST times the start.
    """
    low = high = start
    if falls(start):
        while falls(low := high / growth):
            if low < LEAST * start:
                raise ValueError(f"the wall overturns at every scale from {start:g} down to {low:g}")
            high = low
        return low, high
    while not falls(high := low * growth):
        if high > LARGEST * start:
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


@dataclass(frozen=True)
class Capacity:
    """The intensity at which the motion of a case overturns its wall; a task of a campaign, as an `Analysis` is.

    Masonry is lost when a block falls. The motions of the case in all directions are scaled together, and the intensity
    is that of `motion`, or in space without it of `transverse`. From the scale `start` the search goes up
    by a quarter at a time until the wall falls, or down until it stands, and then halves the interval. Its row has
    `capacity_g`, the peak ground acceleration over g that overturns the wall, `capacity_scale`, the factor on the
    motion of the case, and `stands_at_g`, hardly lower, at which the wall stands. Where there are several such edges,
    `start` decides which it is. `falls_below_g` is the lowest of `below` weaker intensities, a quarter apart, at which
    the wall falls too, empty if it stands at all of them; the message then says "Not monotonic". `ida` shows all.

    Args:
        analysis: the case with its motion, solver and, of a wall, contacts.
        tolerance: how far below the answer the wall may be known to stand, over the answer [-], 1e-6 to 0.5.
        start: scale of the motion from which the search starts [-], 1e-6 to 1e6.
        below: how many weaker intensities are tried, 0 to 30.

    Raises:
        TypeError: for what is no `Analysis`.
        ValueError: for a value outside its range, or a case whose ground does not move horizontally.
    """

    COLUMNS: ClassVar[tuple[str, ...]] = NAMES
    PEAK: ClassVar[str] = "capacity_g"
    """The column that a study of sensitivity looks at."""

    analysis: Analysis
    tolerance: float = 0.01
    start: float = 1.0
    below: int = 4

    def __post_init__(self) -> None:
        require_kind("analysis", self.analysis, Analysis)
        keep(
            self,
            tolerance=require_within("tolerance", self.tolerance, 1e-6, 0.5),
            start=require_within("start", self.start, 1e-6, 1e6),
            below=require_whole("below", self.below, 0, 30),
        )
        if not self.peak > 0:
            raise ValueError(f"analysis = {shown(self.analysis)} has no horizontal motion to scale")

    @property
    def peak(self) -> float:
        """Largest horizontal acceleration of the case over g [-], 0 where there is none."""
        case = self.analysis.case
        motion = case.motion or getattr(case, "transverse", None)
        return motion.peak / GRAVITY if isinstance(motion, GroundMotion) else 0.0

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
            grounds = {name: getattr(case, name, None) for name in ("motion", "vertical", "transverse")}
            moved = {name: ground.scaled(scale) for name, ground in grounds.items() if ground is not None}
            return replace(self.analysis, case=replace(case, **moved))

    def __call__(self, history: Path | None = None) -> Row:
        """Search, and return the columns of the row; a history is that of the run that overturned the wall."""
        runs = 0

        def falls(scale: float) -> bool:
            nonlocal runs
            runs += 1
            analysis = self.scaled(scale)
            return bool(analysis()[analysis.PEAK] == math.inf)

        low, high = halved(falls, *bracket(falls, self.start), self.tolerance)
        weaker = [scale for scale in (low / GROWTH**i for i in range(1, self.below + 1)) if falls(scale)]
        if history is not None:
            self.scaled(high)(history)
        peak, what = self.peak, "wall overturns" if isinstance(self.analysis.case, Case) else "masonry falls"
        message = f"The {what} at {high * peak:.4g} g and stands at {low * peak:.4g} g."
        lowest = min(weaker) * peak if weaker else None
        if weaker:
            message += (
                f" Not monotonic: it {what.split()[1]} at {', '.join(f'{scale * peak:.4g}' for scale in weaker)} g too."
            )
        values = self.solver, self.analysis.law, high * peak, high, low * peak, lowest, runs, message
        return dict(zip(self.COLUMNS, values, strict=True))
