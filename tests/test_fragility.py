import math

import numpy as np
import pytest
from scipy.stats import norm

from mjrock.study.fragility import fit_fragility


def drawn(n, seed=0, median=0.4, dispersion=0.35):
    """Runs whose capacities follow a known lognormal distribution."""
    rng = np.random.default_rng(seed)
    intensity = rng.uniform(0.1, 1.2, n)
    return intensity, intensity > median * np.exp(dispersion * rng.normal(size=n))


def test_it_finds_the_curve_that_drew_the_runs():
    fit = fit_fragility(*drawn(20_000))
    assert fit.median == pytest.approx(0.4, rel=0.02)
    assert fit.dispersion == pytest.approx(0.35, rel=0.05)
    assert fit.probability(0.4) == pytest.approx(0.5, abs=0.02)
    assert fit.probability([0.1, 0.8])[1] == pytest.approx(norm.cdf(math.log(2) / 0.35), abs=0.02)


def test_the_band_covers_the_truth_as_often_as_it_says():
    inside = []
    for seed in range(200):
        fit = fit_fragility(*drawn(150, seed))
        low, high = fit.band(0.5, 0.9)
        inside.append(low < norm.cdf(math.log(0.5 / 0.4) / 0.35) < high)
    assert 0.83 < np.mean(inside) < 0.96


def test_the_band_narrows_with_the_runs():
    widths = [np.subtract(*fit_fragility(*drawn(n)).band(0.4)[::-1]) for n in (100, 10_000)]
    assert widths[0] > 5 * widths[1]
    low, high = fit_fragility(*drawn(300)).median_interval()
    assert low < 0.4 < high


@pytest.mark.parametrize(
    ("intensity", "overturned", "complaint"),
    [
        ([0.1, -0.2], [True, False], r"intensity\[1\] = -0.2"),
        ([0.1, 0.2], [True], "equal length"),
        ([0.1, 0.2], [False, False], "none of 2 runs"),
        ([0.1, 0.2], [True, True], "all of 2 runs"),
        ([0.1, 0.2, 0.3, 0.4], [False, False, True, True], "a step, not a curve"),
    ],
)
def test_what_cannot_be_fitted(intensity, overturned, complaint):
    with pytest.raises(ValueError, match=complaint):
        fit_fragility(intensity, overturned)
