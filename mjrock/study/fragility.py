"""Fragility: the share of walls that an intensity overturns, as a lognormal curve with its confidence band."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize
from scipy.special import log_ndtr, ndtr
from scipy.stats import norm

from ..problem.quantities import Array


@dataclass(frozen=True)
class Fragility:
    """P(overturning | intensity) = Phi(ln(intensity / median) / dispersion).

    Args:
        median: intensity at which half of the walls overturn, in the unit of the intensities that were fitted.
        dispersion: standard deviation of the logarithm of that intensity [-].
        covariance: of (ln median, ln dispersion), shape (2, 2).
        count: how many runs were fitted.
    """

    median: float
    dispersion: float
    covariance: tuple[tuple[float, float], tuple[float, float]]
    count: int

    def probability(self, intensity: ArrayLike) -> Array:
        """Share overturned at an intensity [-]."""
        return np.asarray(ndtr(self._score(intensity)))

    def band(self, intensity: ArrayLike, confidence: float = 0.9) -> tuple[Array, Array]:
        """Lower and upper bound of that share: the normal approximation of the fit, carried over to the score."""
        score = self._score(intensity)
        gradient = np.stack([np.full_like(score, -1 / self.dispersion), -score], axis=-1)
        spread = np.sqrt(np.einsum("...i,ij,...j->...", gradient, np.array(self.covariance), gradient))
        reach = norm.ppf(0.5 + 0.5 * confidence) * spread
        return np.asarray(ndtr(score - reach)), np.asarray(ndtr(score + reach))

    def median_interval(self, confidence: float = 0.9) -> tuple[float, float]:
        """Confidence interval of the median."""
        reach = float(norm.ppf(0.5 + 0.5 * confidence)) * math.sqrt(self.covariance[0][0])
        return self.median * math.exp(-reach), self.median * math.exp(reach)

    def _score(self, intensity: ArrayLike) -> Array:
        return np.asarray(np.log(np.asarray(intensity, dtype=float) / self.median) / self.dispersion)


def fit_fragility(intensity: ArrayLike, overturned: ArrayLike) -> Fragility:
    """The lognormal curve of greatest likelihood for runs that overturned or did not.

    Args:
        intensity: of each run, positive, shape (n,).
        overturned: whether each run overturned, shape (n,).

    Raises:
        ValueError: for an intensity that is not positive, shapes that differ, or runs that all, or none, overturned,
            or in which a single intensity parts them: then no curve is more likely than a step.
    """
    x, fell = np.asarray(intensity, dtype=float), np.asarray(overturned, dtype=bool)
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
    log_x, sign = np.log(x), np.where(fell, 1.0, -1.0)

    def unlikelihood(parameters: Array) -> float:
        return -float(log_ndtr(sign * (log_x - parameters[0]) / np.exp(parameters[1])).sum())

    start = np.array([0.5 * (log_x[fell].mean() + log_x[~fell].mean()), math.log(max(log_x.std(), 0.05))])
    found = minimize(
        unlikelihood, start, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12, "maxiter": 4000}
    )
    covariance = np.linalg.inv(_curvature(unlikelihood, found.x))
    return Fragility(
        median=math.exp(found.x[0]),
        dispersion=math.exp(found.x[1]),
        covariance=((covariance[0, 0], covariance[0, 1]), (covariance[1, 0], covariance[1, 1])),
        count=len(x),
    )


def _curvature(function, at: Array, step: float = 1e-3) -> Array:  # type: ignore[no-untyped-def]
    """Second derivatives by central differences."""
    e = step * np.eye(2)
    return np.array(
        [
            [
                function(at + e[i] + e[j])
                - function(at + e[i] - e[j])
                - function(at - e[i] + e[j])
                + function(at - e[i] - e[j])
                for j in range(2)
            ]
            for i in range(2)
        ]
    ) / (4 * step**2)
