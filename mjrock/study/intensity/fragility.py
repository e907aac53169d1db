"""Fragility: the share of walls that an intensity overturns, as a lognormal curve with its confidence band.

It is fitted to runs that overturned or did not, or to the intensities that overturn a wall under each record.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import chdtri, log_ndtr, ndtr, ndtri, stdtrit

from ...contacts.files import csv_text, write_text
from ...notebook import NotebookPicture
from ...quantities import (
    Array,
    Flags,
    Integers,
    is_iterable,
    require_path,
    require_plain,
    require_real,
    require_reals,
    require_row,
    require_whole,
    require_within,
    short_repr,
    shown,
    warn_of,
)
from ...result.ending import Outcome
from ..campaign.task import Row

FEWEST_GROUPS = 5
"""Fewest groups that are resampled."""
MOST_WITHOUT = 0.05
"""Share of resamples without a curve that is warned of [-]."""
MOST_VALUES = 4_000_000
"""Most values of resamples that are fitted at once."""
NEWTON_STEPS = 100
"""Most steps of Newton's method; a fit takes five to ten."""
SURE_SCORE = 8.0
"""Score beyond which a share counts as 0 or 1 in a penalised fit [-]."""
COVERAGE = (
    "90% intervals of 5 to 40 groups held the median in 88 to 96 and the dispersion in 89 to 98 of 100 simulations"
)
"""How often the intervals hold the truth (`scripts/studies/fragility_coverage.py`)."""
SPREAD = 0.9
"""Confidence at which the dispersions of a band have the interval of the dispersion."""
OUTCOMES = frozenset(outcome.value for outcome in Outcome)
"""The outcomes that a row can have."""
TIE_FORCE = re.compile(r"tie_\d+_force_N")
"""The column of a row with the largest force of a tie. A label such as tie_stiffness is none."""


@dataclass(frozen=True)
class Fragility(NotebookPicture):
    """P(overturning | intensity) = Phi(ln(intensity / median) / dispersion).

    Intervals and band take the runs as independent, unless the fit has their groups.

    Args:
        median: intensity at which half of the walls overturn, in the unit of the intensities that were fitted.
        dispersion: standard deviation of the logarithm of that intensity [-].
        covariance: of (ln median, ln dispersion), the runs taken as independent, shape (2, 2).
        count: how many runs were fitted.
        groups: how many groups they form, or None if each stands for itself.
        resamples: median and dispersion of the fit to each resample of the groups, shape (m, 2), or None.
        tried: the lowest and the highest intensity that was fitted.
        without_curve: how many resamples have no curve of greatest likelihood; they take a penalised fit.
    """

    median: float
    dispersion: float
    covariance: tuple[tuple[float, float], tuple[float, float]]
    count: int
    groups: int | None = None
    resamples: Array | None = field(default=None, repr=False, compare=False)
    tried: tuple[float, float] = (0.0, math.inf)
    without_curve: int = 0

    def __repr__(self) -> str:
        groups = f" in {self.groups} groups" if self.groups is not None else ""
        return (
            f"<Fragility: median {self.median:.4g}, dispersion {self.dispersion:.3g}, of {self.count} values{groups}>"
        )

    def probability(self, intensity: ArrayLike) -> Array:
        """Share overturned at an intensity [-], of any shape.

        Raises:
            TypeError, ValueError: unless the intensities are real numbers that are not negative. Infinity is allowed.
        """
        return np.asarray(ndtr(score_of(_intensities(intensity), self.median, self.dispersion)))

    def band(self, intensity: ArrayLike, confidence: float = 0.9) -> tuple[Array, Array]:
        """Lower and upper bound of that share [-], point by point.

        With groups they are percentiles of the curves that the resamples give, reflected as the intervals are, with
        dispersions that are spread over their interval. Without, they are the normal approximation of the fit, carried
        over to the score. They lie within the four curves that the ends of the two intervals give.

        Raises:
            TypeError, ValueError: for an intensity as `probability` does, or a confidence outside 0 to 1.
        """
        confidence = require_within("confidence", confidence, 0.0, 1.0)
        x = _intensities(intensity)
        low, high = (self._covariance_band if self.resamples is None else self._resampled_band)(x, confidence)
        medians, dispersions = self.median_interval(confidence), self.dispersion_interval(confidence)
        outer = np.stack([ndtr(score_of(x, median, dispersion)) for median in medians for dispersion in dispersions])
        bounds = outer.min(axis=0), outer.max(axis=0)
        return np.clip(low, *bounds), np.clip(high, *bounds)

    def _resampled_band(self, x: Array, confidence: float) -> tuple[Array, Array]:
        """Percentiles of the reflected curves at intensities [-], each of the shape of `x`."""
        shares = ndtr(score_of(x[..., None], *self._reflected_curves(confidence).T))
        low, high = np.percentile(shares, (50 * (1 - confidence), 50 * (1 + confidence)), axis=-1)
        return low, high

    def _reflected_curves(self, confidence: float) -> Array:
        """Median and dispersion of the resamples reflected at the fit, shape (m, 2), the dispersions spread as much as
        their 90 % interval requires."""
        assert self.resamples is not None
        fitted, drawn = np.log([self.median, self.dispersion]), _log(self.resamples)
        from_fit = _widening(SPREAD, self.groups) * (fitted - drawn)
        low, high = reflected(fitted[1], drawn[:, 1], SPREAD, self.groups) - fitted[1]
        required_low, required_high = _log(np.array(self.dispersion_interval(SPREAD))) - fitted[1]
        if high > low:
            from_fit[:, 1] = required_low + (required_high - required_low) / (high - low) * (from_fit[:, 1] - low)
        with np.errstate(over="ignore"):
            return np.exp(fitted + _widening(confidence, self.groups) / _widening(SPREAD, self.groups) * from_fit)

    def _covariance_band(self, x: Array, confidence: float) -> tuple[Array, Array]:
        """The normal approximation of the score at intensities, as shares [-], each of the shape of `x`."""
        score = score_of(x, self.median, self.dispersion)
        certain = np.isinf(score)  # no damage without motion, and none is spared by an infinite one
        finite = np.where(certain, 0.0, score)
        gradient = np.stack([np.full_like(score, -1 / self.dispersion), -finite], axis=-1)
        spread = np.sqrt(np.einsum("...i,ij,...j->...", gradient, np.array(self.covariance), gradient))
        with np.errstate(invalid="ignore"):
            reach = np.where(certain, 0.0, ndtri(0.5 + 0.5 * confidence) * spread)
        return np.asarray(ndtr(score - reach)), np.asarray(ndtr(score + reach))

    def median_interval(self, confidence: float = 0.9) -> tuple[float, float]:
        """Confidence interval of the median."""
        return self._interval(0, self.median, confidence)

    def dispersion_interval(self, confidence: float = 0.9) -> tuple[float, float]:
        """Confidence interval of the dispersion [-].

        With n groups it is as wide as that of the resamples and that of n lognormal capacities, by the chi-square
        distribution with n - 1 degrees of freedom, both: resamples of few records spread too little. `fit_fragility`
        says how often it holds the truth.
        """
        low, high = self._interval(1, self.dispersion, confidence)
        if self.groups is None:
            return low, high
        free = self.groups - 1
        with np.errstate(divide="ignore"):
            ends = self.dispersion * np.sqrt(free / chdtri(free, [0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence]))
        return min(low, float(ends[0])), max(high, float(ends[1]))

    def table(self, confidence: float = 0.9) -> str:
        """Median and dispersion with their intervals, how many runs and groups stand behind them, and how often such
        intervals hold, as text."""
        fitted = {
            "median": (self.median, *self.median_interval(confidence)),
            "dispersion": (self.dispersion, *self.dispersion_interval(confidence)),
        }
        lines = [
            f"{name:<10}  {value:.4g}, {confidence:.0%} interval {low:.4g} to {high:.4g}"
            for name, (value, low, high) in fitted.items()
        ]
        if self.groups is None:
            return "\n".join([*lines, f"{self.count} runs taken as independent"])
        return "\n".join([*lines, f"{self.count} runs of {self.groups} groups", COVERAGE])

    def csv(
        self, path: str | Path | None = None, *, intensity: ArrayLike | None = None, confidence: float = 0.9
    ) -> str:
        """The curve as CSV text: intensity, probability, lower and upper bound; written to `path` where one is given.

        Args:
            path: the file.
            intensity: at which intensities, shape (n,); None takes 100 from zero to twice the median.
            confidence: of the band.

        Raises:
            OSError: if the file cannot be written.
        """
        x = np.linspace(0.0, 2 * self.median, 100) if intensity is None else np.atleast_1d(_intensities(intensity))
        low, high = self.band(x, confidence)
        columns = ["intensity", "probability", f"lower {confidence:.0%}", f"upper {confidence:.0%}"]
        text = csv_text(columns, np.column_stack([x, self.probability(x), low, high]).tolist())
        if path is not None:
            write_text(require_path("path", path), text)
        return text

    def _interval(self, column: int, value: float, confidence: float) -> tuple[float, float]:
        confidence = require_within("confidence", confidence, 0.0, 1.0)
        if self.resamples is not None:
            low, high = reflected(math.log(value), _log(self.resamples[:, column]), confidence, self.groups)
            return float(np.exp(low)), float(np.exp(high))
        reach = float(ndtri(0.5 + 0.5 * confidence)) * math.sqrt(self.covariance[column][column])
        return value * math.exp(-reach), value * math.exp(reach)


def fit_fragility(
    intensity: ArrayLike,
    overturned: ArrayLike,
    groups: ArrayLike | None = None,
    *,
    resamples: int = 1000,
    seed: int = 0,
) -> Fragility:
    """The lognormal curve of greatest likelihood for runs that overturned or did not.

    It is a probit model of the logarithm of the intensity, solved by Newton's method. Runs under one record at several
    intensities, or in both polarities, are not independent. Given the record of each run, the fit draws whole
    records with replacement and repeats itself for every draw. The curve stays the same, its intervals get wider, with
    few records once more, as Student's distribution does. Of 90 % intervals from 5, 8, 20 and 40 simulated records in
    both polarities at 13 intensities 89, 91, 90 and 90 % hold the median, 95, 95, 91 and 89 % the dispersion, and 86 to
    93 % the probability within a quarter of the median. At 8 intensities a fifth of the studies of 5 records have no
    curve; of the others 96, 93, 88 and 89 % hold the median, 98, 96, 92 and 89 % the dispersion
    (`scripts/studies/fragility_coverage.py`).

    Args:
        intensity: of each run, positive, shape (n,).
        overturned: whether each run overturned, True or False, or 1 or 0, shape (n,). Leave runs without a result out.
        groups: what each run belongs to, such as the name or the number of its record, shape (n,), at least 5
            different ones, all text or all numbers. None takes the runs as independent.
        resamples: how many times the groups are drawn, 20 to 100000.
        seed: of the draws, a whole number from 0 to 2**53.

    Raises:
        TypeError: for intensities that are not real numbers, and results that are neither True nor False.
        ValueError: for an intensity that is not positive, a NaN, a masked value, shapes that differ, fewer than 5
            groups, or runs of which all or none overturned, which a single intensity parts, or which overturn the less
            the stronger the motion is.

    Source: Baker (2015), Efficient analytical fragility function fitting, Earthquake Spectra 31(1); for the bootstrap
    over clusters, Field and Welsh (2007), J. R. Stat. Soc. B 69(3).
    """
    x, fell = require_reals("intensity", intensity, "one intensity of each run"), _flags(overturned)
    _require_fit(x, fell)
    fit = _likeliest_curve(x, fell)
    low, high = fit.tried
    if not low <= fit.median <= high:
        warn_of(
            f"the median {fit.median:.4g} is extrapolated: the intensities tried are {low:.4g} to {high:.4g}; run "
            "intensities around it"
        )
    if groups is None:
        return fit
    names, group = group_numbers(labels_for(groups, len(x)))
    runs, number = np.unique(x + 1j * fell, return_inverse=True)  # equal ones count once
    of_groups = np.zeros((names, len(runs)))
    np.add.at(of_groups, (group, number), 1.0)
    draws = drawn(names, resamples, seed)
    count, batch = len(draws), max(1, MOST_VALUES // len(runs))
    weights = (draws[i : i + batch] @ of_groups for i in range(0, count, batch))
    fits = [resampled(np.log(runs.real), runs.imag > 0, batch_weights) for batch_weights in weights]
    curves, without = np.concatenate([pairs for pairs, _ in fits]), sum(lacking for _, lacking in fits)
    curves.setflags(write=False)
    if without > MOST_WITHOUT * count:
        warn_of(
            f"{without} of {count} resamples of {names} groups gave no curve, only a step; a penalised fit stands "
            "for them, and the band is wide: run intensities between those tried, or more records"
        )
    return replace(fit, groups=names, resamples=curves, without_curve=without)


def _likeliest_curve(x: Array, fell: Flags) -> Fragility:
    """The curve of greatest likelihood, the runs taken as independent."""
    log_x = np.log(x)
    ((level, slope),) = probit(log_x, fell, np.ones((1, len(x))))
    if slope <= 0:
        raise ValueError("the share overturned does not grow with intensity; no fragility curve falls")
    h = _derivatives(np.where(fell, 1.0, -1.0) * (level + slope * log_x))[1]
    towards = np.array([[-slope, -level], [0.0, -slope]])  # of (level, slope) over (ln median, ln dispersion)
    covariance = np.linalg.inv(towards.T @ _information(h, log_x) @ towards)
    return Fragility(
        median=math.exp(-level / slope),
        dispersion=float(1 / slope),
        covariance=((covariance[0, 0], covariance[0, 1]), (covariance[1, 0], covariance[1, 1])),
        count=len(x),
        tried=(float(x.min()), float(x.max())),
    )


def _flags(overturned: ArrayLike) -> Flags:
    """Whether each run overturned. Raises a TypeError or ValueError unless each value is True or False, or 1 or 0."""
    takes = "whether each run overturned: True or False, or 1 or 0; lost(rows) makes it of the rows of a campaign"
    values = require_plain("overturned", overturned, takes, "biuf")
    unclear = np.flatnonzero((values != 0) & (values != 1))
    if unclear.size:
        raise ValueError(f"overturned holds {values.flat[unclear[0]]:g} at {unclear[0]}; it takes {takes}")
    return np.asarray(values, dtype=bool)


def group_numbers(labels: NDArray[np.generic], fewest: int = FEWEST_GROUPS) -> tuple[int, Integers]:
    """How many groups there are, and the number of that of each value.

    Raises:
        ValueError: for too few for an interval.
    """
    names, group = np.unique(labels, return_inverse=True)
    if len(names) < fewest:
        raise ValueError(
            f"the number of groups is {len(names)} (without groups each value is one); the valid range is {fewest} or "
            "more: fewer give no interval that can be trusted. Run more records, or report the single values and their "
            "range"
        )
    return len(names), group


def drawn(groups: int, resamples: int, seed: int) -> Integers:
    """How often each resample holds each group, drawn with replacement, shape (resamples, groups)."""
    count = require_whole("resamples", resamples, 20, 100_000)
    rng = np.random.default_rng(require_whole("seed", seed, 0, 2**53))
    return rng.multinomial(groups, np.full(groups, 1 / groups), size=count)


def labels_for(groups: ArrayLike | None, count: int) -> NDArray[np.generic]:
    """The group of each of a number of values; None takes each as a group of its own.

    Raises:
        TypeError, ValueError: unless they are all text or all numbers, without NaN.
    """
    if groups is None:
        return np.arange(count)
    takes = "the name or the number of the group of each run"
    labels = require_plain("groups", groups, takes, "biufU")
    if labels.dtype.kind == "U" and not all(isinstance(label, str) for label in np.asarray(groups, dtype=object).flat):
        raise TypeError(f"groups = {shown(groups)} holds text and numbers; it takes {takes}, all of one kind")
    if labels.dtype.kind == "f" and np.isnan(labels).any():
        raise ValueError(f"groups holds nan; it takes {takes}")
    if labels.shape != (count,):
        raise ValueError(f"groups has the shape {labels.shape}; ({count},) is needed")
    return labels


def _intensities(intensity: ArrayLike) -> Array:
    """Intensities at which a curve is evaluated."""
    takes = "one or more intensities that are not negative"
    x = require_reals("intensity", intensity, takes)
    bad = x[~(x >= 0)]
    if bad.size:
        raise ValueError(f"intensity holds {bad[0]:g}; it takes {takes}")
    return x


def _require_fit(x: Array, fell: Flags) -> None:
    """Raise ValueError unless there is a curve of greatest likelihood."""
    if x.shape != fell.shape or x.ndim != 1:
        raise ValueError(
            f"intensity has the shape {x.shape} and overturned {fell.shape}; both need one row of equal length"
        )
    bad = np.flatnonzero(~(np.isfinite(x) & (x > 0)))
    if bad.size:
        raise ValueError(f"intensity[{bad[0]}] = {x[bad[0]]:g} is outside the valid range intensity > 0")
    if fell.all() or not fell.any():
        raise ValueError(f"{'all' if fell.any() else 'none'} of {len(fell)} runs overturned; a fragility needs both")
    if x[fell].min() >= x[~fell].max():
        raise ValueError(
            f"every run above {x[~fell].max():g} overturned and none below {x[fell].min():g}: a step, not a curve"
        )


def resampled(log_x: Array, fell: Flags, weights: Array) -> tuple[Array, int]:
    """Median and dispersion of each resample, shape (m, 2), and how many of them have no curve of greatest likelihood.

    A resample that a single intensity parts, or in which all or none overturned, has none. It takes the penalised fit,
    which is finite. One that overturns the less the stronger the motion is, penalised or not, has an infinite
    dispersion and its median at zero or at infinity.

    Args:
        log_x: logarithm of the intensity of each run, shape (n,).
        fell: whether each overturned, shape (n,).
        weights: how often each resample holds each run, shape (m, n).
    """
    drawn = weights > 0
    lowest = np.where(drawn & fell, log_x, np.inf).min(axis=1)
    highest = np.where(drawn & ~fell, log_x, -np.inf).max(axis=1)
    curves = lowest < highest
    fits = np.zeros((len(weights), 2))
    for selected, fit in ((curves, probit), (~curves, _penalised)):
        if selected.any():
            fits[selected] = fit(log_x, fell, weights[selected])
    level, slope = fits.T
    rises = slope > 0
    slope = np.where(rises, slope, 1.0)
    few = (weights @ fell) < 0.5 * weights.sum(axis=1)
    with np.errstate(over="ignore"):
        medians = np.where(rises, np.exp(-level / slope), np.where(few, np.inf, 0.0))
    return np.stack([medians, np.where(rises, 1 / slope, np.inf)], axis=1), int((~(curves & rises)).sum())


def probit(log_x: Array, fell: Flags, weights: Array) -> Array:
    """Level and slope of Phi(level + slope log_x) of greatest likelihood, for each row of weights, shape (m, 2)."""
    middle, width = log_x.mean(), log_x.std()
    u = (log_x - middle) / width
    sign = np.where(fell, 1.0, -1.0)
    fits = np.zeros((len(weights), 2))
    fits[:, 0] = ndtri((weights @ fell) / weights.sum(axis=1))
    for _ in range(NEWTON_STEPS):
        ratio, slant = _derivatives(sign * (fits[:, :1] + fits[:, 1:] * u))
        g, h = weights * sign * ratio, weights * slant
        gradient = np.stack([g.sum(axis=1), g @ u], axis=1)
        step = np.linalg.solve(_information(h, u), gradient[..., None])[..., 0]
        size = np.abs(step).max(axis=1, keepdims=True)
        fits += step / np.maximum(1.0, size)  # far from the summit the full step may overshoot
        if size.max() < 1e-10 * (1 + np.abs(fits).max()):
            break
    return np.stack([fits[:, 0] - fits[:, 1] * middle / width, fits[:, 1] / width], axis=1)


def _derivatives(z: Array) -> tuple[Array, Array]:
    """First derivative of ln Phi(z), and minus the second."""
    ratio = np.exp(-0.5 * z * z - log_ndtr(z)) / math.sqrt(2 * math.pi)
    return ratio, ratio * (z + ratio)


def _information(h: Array, u: Array) -> Array:
    """Minus the second derivatives of the likelihood over level and slope, shape (..., 2, 2).

    Args:
        h: minus the second derivative of the likelihood of each run over its score, shape (..., n).
        u: logarithm of the intensity of each run, shape (n,).
    """
    return np.stack([h.sum(axis=-1), h @ u, h @ u, h @ (u * u)], axis=-1).reshape(*h.shape[:-1], 2, 2)


def _penalised(log_x: Array, fell: Flags, weights: Array) -> Array:
    """Level and slope with reduced bias, shape (m, 2), finite where the likelihood has no summit too.

    Source: Kosmidis and Firth (2009), Bias reduction in exponential family nonlinear models, Biometrika 96(4): each run
    adds h / 2 runs of a share of one half, h its leverage.
    """
    middle, width = log_x.mean(), log_x.std()
    u = (log_x - middle) / width
    design = np.stack([np.ones_like(u), u], axis=1)
    fits = np.tile([0.0, 1.0], (len(weights), 1))
    for _ in range(NEWTON_STEPS):
        eta = np.clip(fits[:, :1] + fits[:, 1:] * u, -SURE_SCORE, SURE_SCORE)
        share, density = ndtr(eta), np.exp(-0.5 * eta * eta) / math.sqrt(2 * math.pi)
        spread = share * ndtr(-eta)
        w = weights * density**2 / spread
        inverse = np.linalg.pinv(_information(w, u), hermitian=True)  # that of one record alone is singular
        leverage = w * np.einsum("ni,mij,nj->mn", design, inverse, design)
        score = weights * (fell - share) * density / spread - 0.5 * leverage * eta
        step = np.einsum("mij,mj->mi", inverse, np.stack([score.sum(axis=1), score @ u], axis=1))
        size = np.abs(step).max(axis=1, keepdims=True)
        fits += step / np.maximum(1.0, size)
        if size.max() < 1e-8:
            break
    return np.stack([fits[:, 0] - fits[:, 1] * middle / width, fits[:, 1] / width], axis=1)


def score_of(intensity: ArrayLike, median: ArrayLike, dispersion: ArrayLike) -> Array:
    """How many dispersions an intensity lies above the median; nothing over nothing counts as the median itself."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        score = np.log(np.asarray(intensity) / np.asarray(median)) / np.asarray(dispersion)
    return np.asarray(np.where(np.isnan(score), 0.0, score))


def reflected(value: float, drawn: Array, confidence: float, groups: int | None) -> tuple[Array, Array]:
    """The basic bootstrap interval of resamples, shape (m,): they lie about the estimate as it does about the truth."""
    wider = _widening(confidence, groups)
    ends = 50 * (1 - confidence), 50 * (1 + confidence)
    low, high = np.percentile(drawn, ends, method="nearest")
    with np.errstate(invalid="ignore"):
        interval = value + wider * (value - high), value + wider * (value - low)
    first, last = (np.where(np.isnan(end), value, end) for end in interval)  # both infinite: as certain as the estimate
    return np.asarray(first), np.asarray(last)


def _widening(confidence: float, groups: int | None) -> float:
    """By how much an interval is wider than its resamples [-].

    Resamples of n groups spread by sqrt((n - 1) / n) too little, and the quantile of few is that of Student's t; the
    interval is wider by both. `scripts/studies/fragility_coverage.py` counts how often it holds the truth.
    """
    n, tail = groups or math.inf, 0.5 + 0.5 * confidence
    if not (math.isfinite(n) and 0.5 < tail < 1):
        return 1.0
    return math.sqrt(n / (n - 1)) * float(stdtrit(n - 1, tail) / ndtri(tail))


def _log(values: Array) -> Array:
    """Logarithms; zero has that of minus infinity."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.log(values))


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
    losses = []
    for i, row in enumerate(rows):
        if not isinstance(row, Mapping):
            raise TypeError(f"rows[{i}] = {shown(row)} is not a row of a campaign")
        outcome, peak = row.get("outcome"), row.get("peak_over_alpha")
        if peak is None and outcome in OUTCOMES and isinstance(row.get("fallen"), int):
            losses.append(row["fallen"] > 0)
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
        tied = any(TIE_FORCE.fullmatch(str(name)) and value is not None for name, value in row.items())
        leans = tied and outcome == Outcome.TIME_ENDED.value and peak >= 1.0
        losses.append(outcome == Outcome.OVERTURNED.value or leans or inwards >= 1.0)
    return np.array(losses, dtype=bool)


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
    curves = np.stack([np.exp(means), np.sqrt(np.where(flat, squares[~flat].min(initial=1.0), squares))], axis=1)
    curves.setflags(write=False)
    s, n = float(log_c.std(ddof=1)), len(log_c)
    return Fragility(
        median=math.exp(log_c.mean()),
        dispersion=s,
        covariance=((s * s / n, 0.0), (0.0, 0.5 / (n - 1))),
        count=n,
        groups=names,
        resamples=curves,
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
    ratio, low, high, lowest, highest = np.exp([*ends, ratios.min(), ratios.max()]).tolist()
    return PairedRatio(ratio, low, high, lowest, highest, len(ratios), names, confidence)


def _logarithms(name: str, values: ArrayLike) -> Array:
    """Logarithms of positive numbers."""
    numbers = require_row(name, values, "capacity")
    bad = np.flatnonzero(~(numbers > 0))
    if bad.size:
        raise ValueError(f"{name}[{bad[0]}] = {numbers[bad[0]]:g} is outside the valid range, which is above 0")
    return np.log(numbers)
