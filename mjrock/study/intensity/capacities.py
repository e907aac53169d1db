"""Capacities of a wall under many records: their distribution, and ratios of two walls under the same records."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from ...quantities import Array, Flags, is_iterable, require_real, require_row, require_within, short_repr, shown
from ...result.ending import Outcome
from ..campaign.task import Row
from .fragility import Fragility, drawn, group_numbers, labels_for

OUTCOMES = frozenset(outcome.value for outcome in Outcome)
"""How a row says that a run ended."""


def lost(rows: Iterable[Row]) -> Flags:
    """Whether each run of a campaign lost its wall, for `fit_fragility`; shape (n,).

    A wall is lost if it overturned. One with ties is lost too if the time ended after it had leaned by alpha or more:
    ties alone held it, and a wall that leans on ties that yield does not survive. So is one that leaned inwards by
    alpha or more, over its side stop. A wall that still rocks stands. Masonry is lost if a block has fallen.

    Args:
        rows: rows of walls or of masonry, as `Store.rows` gives them.

    Raises:
        ValueError: for a row without a result, or one of another task.
    """
    if isinstance(rows, Mapping) or not is_iterable(rows):
        raise TypeError(f"rows = {shown(rows)} are not rows of a campaign")
    found = []
    for i, row in enumerate(rows):
        if not isinstance(row, Mapping):
            raise TypeError(f"rows[{i}] = {shown(row)} is not a row of a campaign")
        outcome, peak = row.get("outcome"), row.get("peak_over_alpha")
        if peak is None and outcome in OUTCOMES and isinstance(row.get("fallen"), int):
            found.append(row["fallen"] > 0)
            continue
        if not isinstance(outcome, str) or outcome not in OUTCOMES or peak is None:
            raise ValueError(
                f"rows[{i}] has outcome = {shown(outcome)} and peak_over_alpha = {shown(peak)}: no result of a "
                "wall or of masonry"
            )
        peak, inwards = (
            require_real(f"rows[{i}], {name}", row.get(name) or 0.0)
            for name in ("peak_over_alpha", "inwards_over_alpha")
        )
        tied = any(str(name).startswith("tie_") and value is not None for name, value in row.items())
        leans = tied and outcome == Outcome.TIME_ENDED.value and peak >= 1.0
        found.append(outcome == Outcome.OVERTURNED.value or leans or inwards >= 1.0)
    return np.array(found, dtype=bool)


def fit_capacities(
    capacities: ArrayLike, groups: ArrayLike | None = None, *, resamples: int = 1000, seed: int = 0
) -> Fragility:
    """The lognormal fragility curve of capacities, the intensity that overturns a wall under each record.

    Median and dispersion are those of the logarithms. The intervals are those of `fit_fragility`: records are drawn
    again and again. Every capacity has to be known; `IncrementalAnalysis.fragility` takes records that overturn the
    wall at no scale.

    Args:
        capacities: in any measure of intensity, positive, shape (n,).
        groups: what each belongs to, such as its record where both polarities are given; at least 5 different ones.
            None takes each as a record of its own.
        resamples: how many times the records are drawn, 20 to 100000.
        seed: of the draws, a whole number from 0 to 2**53.

    Raises:
        TypeError, ValueError: for a capacity that is not finite and positive, equal ones, or fewer than 5 groups.

    Source: Porter, Kennedy and Bachman (2007), Creating fragility functions for performance-based earthquake
    engineering, Earthquake Spectra 23(2), method A; the standard deviation with n - 1.
    """
    log_c = _logarithms("capacities", capacities)
    names, group = group_numbers(labels_for(groups, len(log_c)))
    if not log_c.std() > 0:
        raise ValueError("capacities are all equal; a fragility curve needs a spread")
    weights = drawn(names, resamples, seed)[:, group].astype(float)
    total = weights.sum(axis=1)
    means = weights @ log_c / total
    squares = np.maximum((weights * (log_c - means[:, None]) ** 2).sum(axis=1) / (total - 1), 0.0)
    flat = squares == 0
    found = np.stack([np.exp(means), np.sqrt(np.where(flat, squares[~flat].min(initial=1.0), squares))], axis=1)
    found.setflags(write=False)
    s, n = float(log_c.std(ddof=1)), len(log_c)
    return Fragility(
        median=math.exp(log_c.mean()),
        dispersion=s,
        covariance=((s * s / n, 0.0), (0.0, 0.5 / (n - 1))),
        count=n,
        groups=names,
        resamples=found,
        tried=(math.exp(log_c.min()), math.exp(log_c.max())),
        without_curve=int(flat.sum()),
    )


@dataclass(frozen=True)
class PairedRatio:
    """The ratio of two capacities under the same records.

    Args:
        ratio: the geometric mean of the ratios [-].
        low, high: its confidence interval [-].
        least, most: the smallest and the largest ratio of a pair [-].
        pairs: how many pairs there are.
        groups: how many records they belong to.
        confidence: of the interval [-].
    """

    ratio: float
    low: float
    high: float
    least: float
    most: float
    pairs: int
    groups: int
    confidence: float

    __repr__ = short_repr

    def __str__(self) -> str:
        return (
            f"{self.ratio:.2f}, {self.confidence:.0%} interval {self.low:.2f} to {self.high:.2f}, single pairs "
            f"{self.least:.2f} to {self.most:.2f} ({self.pairs} pairs, {self.groups} records)"
        )


def paired_ratio(
    capacities: ArrayLike, over: ArrayLike, groups: ArrayLike | None = None, *, confidence: float = 0.9
) -> PairedRatio:
    """How many times as large capacities are as others of the same records, such as with ties over without.

    The logarithms of the ratios are averaged over each record first, and their mean has Student's interval.

    Args:
        capacities, over: numerator and denominator, pair by pair, positive, shape (n,).
        groups: what each pair belongs to, such as its record where both polarities are given; at least 2 different
            ones. None takes each as a record of its own.
        confidence: of the interval, 0 to 1.

    Raises:
        TypeError, ValueError: for values that are not finite and positive, shapes that differ, or fewer than 2 groups.
    """
    log_c, log_o = _logarithms("capacities", capacities), _logarithms("over", over)
    if log_c.shape != log_o.shape:
        raise ValueError(f"over has {len(log_o)} values and capacities {len(log_c)}; they have to be pairs")
    confidence = require_within("confidence", confidence, 0.0, 1.0)
    names, group = group_numbers(labels_for(groups, len(log_c)), 2)
    ratios = log_c - log_o
    means = np.bincount(group, ratios) / np.bincount(group)
    reach = float(stdtrit(names - 1, 0.5 + 0.5 * confidence)) * means.std(ddof=1) / math.sqrt(names)
    ends = means.mean() + reach * np.array([0.0, -1.0, 1.0])
    ratio, low, high, least, most = np.exp([*ends, ratios.min(), ratios.max()]).tolist()
    return PairedRatio(ratio, low, high, least, most, len(ratios), names, confidence)


def _logarithms(name: str, values: ArrayLike) -> Array:
    """Logarithms of positive numbers."""
    made = require_row(name, values, "capacity")
    bad = np.flatnonzero(~(made > 0))
    if bad.size:
        raise ValueError(f"{name}[{bad[0]}] = {made[bad[0]]:g} is outside the valid range, which is above 0")
    return np.log(made)
