"""The probit model of the share overturned over the logarithm of the intensity, for many resamples at once."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import log_ndtr, ndtr, ndtri, stdtrit

from ..quantities import Array, Flags

ITERATIONS = 100
"""Most steps of Newton's method; a fit takes five to ten."""
FARTHEST = 8.0
"""Score beyond which a share counts as 0 or 1 in a penalised fit [-]."""


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
    for which, fit in ((curves, probit), (~curves, _penalised)):
        if which.any():
            fits[which] = fit(log_x, fell, weights[which])
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
    for _ in range(ITERATIONS):
        ratio, slant = _derivatives(sign * (fits[:, :1] + fits[:, 1:] * u))
        g, h = weights * sign * ratio, weights * slant
        gradient = np.stack([g.sum(axis=1), g @ u], axis=1)
        hessian = np.stack([h.sum(axis=1), h @ u, h @ u, h @ (u * u)], axis=1).reshape(-1, 2, 2)
        step = np.linalg.solve(hessian, gradient[..., None])[..., 0]
        size = np.abs(step).max(axis=1, keepdims=True)
        fits += step / np.maximum(1.0, size)  # far from the summit the full step may overshoot
        if size.max() < 1e-10 * (1 + np.abs(fits).max()):
            break
    return np.stack([fits[:, 0] - fits[:, 1] * middle / width, fits[:, 1] / width], axis=1)


def _derivatives(z: Array) -> tuple[Array, Array]:
    """First derivative of ln Phi(z), and minus the second."""
    ratio = np.exp(-0.5 * z * z - log_ndtr(z)) / math.sqrt(2 * math.pi)
    return ratio, ratio * (z + ratio)


def curvature(log_x: Array, fell: Flags, level: float, slope: float) -> Array:
    """Minus the second derivatives of the likelihood over level and slope, shape (2, 2)."""
    h = _derivatives(np.where(fell, 1.0, -1.0) * (level + slope * log_x))[1]
    return np.array([[h.sum(), h @ log_x], [h @ log_x, h @ (log_x * log_x)]])


def _penalised(log_x: Array, fell: Flags, weights: Array) -> Array:
    """Level and slope with reduced bias, shape (m, 2), finite where the likelihood has no summit too.

    Source: Kosmidis and Firth (2009), Bias reduction in exponential family nonlinear models, Biometrika 96(4): each run
    adds h / 2 runs of a share of one half, h its leverage.
    """
    middle, width = log_x.mean(), log_x.std()
    u = (log_x - middle) / width
    design = np.stack([np.ones_like(u), u], axis=1)
    fits = np.tile([0.0, 1.0], (len(weights), 1))
    for _ in range(ITERATIONS):
        eta = np.clip(fits[:, :1] + fits[:, 1:] * u, -FARTHEST, FARTHEST)
        share, density = ndtr(eta), np.exp(-0.5 * eta * eta) / math.sqrt(2 * math.pi)
        spread = share * ndtr(-eta)
        w = weights * density**2 / spread
        information = np.stack([w.sum(axis=1), w @ u, w @ u, w @ (u * u)], axis=1).reshape(-1, 2, 2)
        inverse = np.linalg.pinv(information, hermitian=True)  # one record drawn again and again says nothing
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


def reflected(value: ArrayLike, drawn: Array, confidence: float, groups: int | None) -> tuple[Array, Array]:
    """The basic bootstrap interval, along the last axis: resamples lie about the estimate as it does about the truth.

    Resamples of n groups spread by sqrt((n - 1) / n) too little, and the quantile of few is that of Student's t; the
    interval is wider by both. `scripts/studies/fragility_coverage.py` counts how often it holds the truth.
    """
    n = groups or math.inf
    tail = 0.5 + 0.5 * confidence
    wider = math.sqrt(n / (n - 1)) * stdtrit(n - 1, tail) / ndtri(tail) if math.isfinite(n) and 0.5 < tail < 1 else 1.0
    ends = 50 * (1 - confidence), 50 * (1 + confidence)
    low, high = np.percentile(drawn, ends, axis=-1, method="nearest")
    with np.errstate(invalid="ignore"):
        interval = value + wider * (value - high), value + wider * (value - low)
    first, last = (np.where(np.isnan(end), value, end) for end in interval)  # both infinite: as certain as the estimate
    return np.asarray(first), np.asarray(last)
