import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.stats import norm

from mjrock.study.intensity.fragility import drawn as drawn_groups
from mjrock.study.intensity.fragility import fit_fragility, resampled


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


def test_a_table_has_the_intervals_and_what_stands_behind_them():
    x, fell, records = clustered(0)
    fit = fit_fragility(x, fell, records, resamples=100)
    low, high = fit.median_interval()
    median, dispersion, runs, held = fit.table().splitlines()
    assert median == f"median      {fit.median:.4g}, 90% interval {low:.4g} to {high:.4g}"
    assert dispersion.startswith(
        f"dispersion  {fit.dispersion:.4g}, 90% interval {fit.dispersion_interval()[0]:.4g} to "
    )
    assert runs == "720 runs of 30 groups"
    assert held.startswith("90% intervals of 5 to 40 groups held the median in 88 to 96 ")
    assert (
        fit_fragility(x, fell)
        .table(0.8)
        .endswith(
            "80% interval "
            + "{:.4g} to {:.4g}".format(*fit_fragility(x, fell).dispersion_interval(0.8))
            + "\n720 runs taken as independent"
        )
    )


def test_the_band_narrows_with_the_runs():
    widths = [np.subtract(*fit_fragility(*drawn(n)).band(0.4)[::-1]) for n in (100, 10_000)]
    assert widths[0] > 5 * widths[1]
    low, high = fit_fragility(*drawn(300)).median_interval()
    assert low < 0.4 < high


def clustered(seed, records=30, between=0.35, within=0.08):
    """Runs under records: the capacity of the wall goes with the record, and hardly with the run."""
    rng = np.random.default_rng(seed)
    intensity = np.tile(np.linspace(0.1, 1.2, 12), 2 * records)
    record = np.repeat(np.arange(records), 24)
    capacity = 0.5 * np.exp(between * rng.normal(size=records)[record] + within * rng.normal(size=len(record)))
    return intensity, intensity > capacity, record


def test_runs_of_one_record_are_not_independent():
    """Spread of the fits of 60 studies, against what the intervals say of each."""
    fits = [fit_fragility(*clustered(seed)[:2]) for seed in range(60)]
    grouped = [fit_fragility(*clustered(seed), resamples=100) for seed in range(10)]
    for which, true in (("median", 0.5), ("dispersion", math.hypot(0.35, 0.08))):
        values = np.log([getattr(fit, which) for fit in fits])
        spread = 2 * 1.645 * values.std(ddof=1)
        naive, clusters = (
            np.mean([np.subtract(*np.log(getattr(fit, f"{which}_interval")())[::-1]) for fit in several])
            for several in (fits, grouped)
        )
        assert naive < 0.62 * spread
        assert 0.7 * spread < clusters < 1.3 * spread
        assert np.exp(values.mean()) == pytest.approx(true, rel=0.06)


@pytest.mark.slow
def test_the_intervals_over_records_hold_the_truth():
    true = {"median": 0.5, "dispersion": math.hypot(0.35, 0.08)}
    held = {(which, groups): 0 for which in true for groups in (True, False)}
    for seed in range(150):
        x, fell, record = clustered(seed)
        for groups in (True, False):
            fit = fit_fragility(x, fell, record if groups else None, resamples=200)
            for which, value in true.items():
                low, high = getattr(fit, f"{which}_interval")()
                held[which, groups] += low < value < high
    assert held["median", True] > 0.82 * 150
    assert held["dispersion", True] > 0.76 * 150
    assert held["median", False] < 0.6 * 150
    assert held["dispersion", False] < 0.6 * 150


def test_groups_of_one_run_each_are_independent_runs():
    x, fell = drawn(2000, seed=1)
    alone, grouped = fit_fragility(x, fell), fit_fragility(x, fell, np.arange(2000), resamples=400)
    assert (grouped.median, grouped.dispersion, grouped.groups) == (alone.median, alone.dispersion, 2000)
    for interval in ("median_interval", "dispersion_interval"):
        widths = [np.subtract(*np.log(getattr(fit, interval)())[::-1]) for fit in (alone, grouped)]
        assert widths[1] == pytest.approx(widths[0], rel=0.15)
    bands = [np.subtract(*norm.ppf(fit.band([0.3, 0.4, 0.6])[::-1])) for fit in (alone, grouped)]
    np.testing.assert_allclose(bands[1], bands[0], rtol=0.2)


def test_a_resample_is_the_fit_to_all_runs_of_its_groups():
    """Equal runs count once in the fit to resamples, with a weight."""
    x, fell, record = clustered(0)
    fit = fit_fragility(x, fell, record, resamples=20)
    for times, (median, dispersion) in zip(drawn_groups(30, 20, 0), fit.resamples, strict=True):
        each = np.repeat(np.arange(len(x)), times[record])
        alone = fit_fragility(x[each], fell[each])
        assert (median, dispersion) == pytest.approx((alone.median, alone.dispersion), rel=1e-9)


def test_the_same_seed_draws_the_same_groups():
    x, fell, record = clustered(0)
    fits = [fit_fragility(x, fell, record, resamples=20, seed=seed).resamples for seed in (0, 0, 1)]
    np.testing.assert_array_equal(fits[0], fits[1])
    assert not np.array_equal(fits[0], fits[2])
    with_names = fit_fragility(x, fell, [f"record {i}" for i in record], resamples=20)
    assert with_names.groups == 30


def test_the_fit_is_the_top_of_the_likelihood():
    """Its derivatives vanish there, and minus the second ones are the inverse of the covariance."""
    x, fell = drawn(200)
    fit = fit_fragility(x, fell)

    def likelihood(a, b):
        z = (np.log(x) - a) / np.exp(b)
        return float(np.where(fell, norm.logcdf(z), norm.logcdf(-z)).sum())

    a, b, h = math.log(fit.median), math.log(fit.dispersion), 1e-4
    top = likelihood(a, b)
    second = np.empty((2, 2))
    for i, (da, db) in enumerate(((h, 0), (0, h))):
        up, down = likelihood(a + da, b + db), likelihood(a - da, b - db)
        assert (up - down) / (2 * h) == pytest.approx(0.0, abs=1e-4)
        second[i, i] = (up - 2 * top + down) / h**2
    mixed = [likelihood(a + i * h, b + j * h) for i in (1, -1) for j in (1, -1)]
    second[0, 1] = second[1, 0] = (mixed[0] - mixed[1] - mixed[2] + mixed[3]) / (4 * h**2)
    np.testing.assert_allclose(-np.linalg.inv(second), fit.covariance, rtol=1e-3)


def test_resamples_that_have_no_curve_take_a_finite_one_and_are_counted():
    x = np.array([0.2, 0.3, 0.4, 0.5, 0.6, 0.7])
    fell = np.array([False, False, True, False, True, True])
    weights = np.array([[1, 1, 0, 0, 1, 1], [1, 1, 0, 1, 0, 0], [0, 0, 1, 0, 1, 1], [0, 0, 3, 3, 0, 0], [1] * 6])
    fits, without = resampled(np.log(x), fell, weights)
    assert without == 4
    assert 0.3 < fits[0, 0] < 0.6  # a step between the two
    assert 0 < fits[0, 1] < 1
    assert fits[1, 0] > 0.5  # all stood
    assert fits[2, 0] < 0.4  # all fell
    assert np.isfinite(fits[:3]).all()
    assert fits[3, 1] == np.inf  # it falls with the intensity
    np.testing.assert_allclose(fits[4], [fit_fragility(x, fell).median, fit_fragility(x, fell).dispersion])


@pytest.mark.parametrize(
    ("groups", "options", "complaint"),
    [
        ([1, 2], {}, r"groups has the shape \(2,\)"),
        (
            np.arange(100) % 4,
            {},
            "the number of groups is 4 .*; the valid range is 5 or more: .* Run more records, or report the single",
        ),
        (np.arange(100), {"resamples": 3}, "resamples = 3 is outside"),
        (np.arange(100), {"seed": -1}, "seed = -1 is outside"),
    ],
)
def test_groups_that_cannot_be(groups, options, complaint):
    with pytest.raises(ValueError, match=complaint):
        fit_fragility(*drawn(100), groups, **options)
    with pytest.raises(ValueError, match="confidence = 2 is outside"):
        fit_fragility(*drawn(100)).median_interval(2)


@pytest.mark.parametrize(
    ("intensity", "overturned", "complaint"),
    [
        ([0.1, -0.2], [True, False], r"intensity\[1\] = -0.2"),
        ([0.1, 0.2], [True], "equal length"),
        ([0.1, 0.2], [False, False], "none of 2 runs"),
        ([0.1, 0.2], [True, True], "all of 2 runs"),
        ([0.1, 0.2, 0.3, 0.4], [False, False, True, True], "a step, not a curve"),
        ([0.1, 0.2, 0.3, 0.4], [True, True, False, True], "does not grow with intensity"),
    ],
)
def test_what_cannot_be_fitted(intensity, overturned, complaint):
    with pytest.raises(ValueError, match=complaint):
        fit_fragility(intensity, overturned)


MASKED = np.ma.array([0.1] * 10, mask=[True] + [False] * 9)


@pytest.mark.parametrize(
    ("given", "complaint"),
    [
        ({"overturned": [math.nan] + [True] * 99}, "overturned holds nan at 0; it takes whether each run overturned"),
        ({"overturned": [None] + [True] * 99}, "overturned = .* does not hold"),
        ({"overturned": ["False"] * 100}, "overturned = .* does not hold"),
        ({"overturned": [0.5] * 100}, "overturned holds 0.5 at 0"),
        ({"overturned": [1j] * 100}, "overturned = .* does not hold"),
        ({"overturned": np.ma.array([True] * 100, mask=[True] + [False] * 99)}, "overturned has masked values"),
        ({"overturned": [[True], [True, False]]}, "overturned = .* has rows of different lengths"),
        ({"intensity": ["0.1"] * 100}, "intensity = .* does not hold real numbers alone"),
        ({"intensity": [True] * 100}, "intensity = .* does not hold real numbers alone"),
        ({"intensity": [1 + 1j] * 100}, "intensity = .* does not hold real numbers alone"),
        ({"intensity": [[1.0], [1.0, 2.0]]}, "intensity = .* has rows of different lengths"),
        ({"intensity": np.ma.array([0.1] * 100, mask=[True] + [False] * 99)}, "intensity has masked values"),
        ({"intensity": None}, "intensity = None does not hold"),
        ({"intensity": [math.nan] * 100}, r"intensity\[0\] = nan is outside the valid range"),
        ({"groups": [math.nan] * 100}, "groups holds nan"),
        ({"groups": [None] * 100}, "groups = .* does not hold"),
        ({"groups": ["a", 1] * 50}, "groups = .* holds text and numbers"),
        ({"groups": np.ma.array([1] * 100, mask=[True] + [False] * 99)}, "groups has masked values"),
        ({"groups": [[1], [1, 2]]}, "groups = .* has rows of different lengths"),
    ],
)
def test_a_run_without_a_result_is_refused(given, complaint):
    x, fell = drawn(100)
    with pytest.raises((TypeError, ValueError), match=complaint):
        fit_fragility(**({"intensity": x, "overturned": fell} | given))


def test_ones_and_zeros_are_results():
    x, fell = drawn(100)
    fits = [fit_fragility(x, kind) for kind in (fell, fell.astype(int), fell.astype(float), fell.tolist())]
    assert all(fit == fits[0] for fit in fits)


@pytest.mark.parametrize("grouped", [False, True])
@pytest.mark.parametrize("ask", ["probability", "band"])
@pytest.mark.parametrize(
    "intensity", [-1.0, [-1.0, math.nan], "x", [["a"]], object(), [[1.0], [1.0, 2.0]], MASKED, 1j, True, None]
)
def test_a_curve_is_asked_at_intensities(grouped, ask, intensity):
    x, fell = drawn(100)
    fit = fit_fragility(x, fell, np.arange(100) // 10 if grouped else None, resamples=20)
    with pytest.raises((TypeError, ValueError), match=r"^intensity "):
        getattr(fit, ask)(intensity)


@pytest.mark.parametrize("grouped", [False, True])
@pytest.mark.parametrize("confidence", [0.0, 0.9, 1.0])
def test_the_ends_of_the_curve_are_certain(grouped, confidence):
    """No motion overturns no wall, an infinite one every wall, and nothing warns of it."""
    x, fell = drawn(100)
    fit = fit_fragility(x, fell, np.arange(100) // 10 if grouped else None, resamples=20)
    ends = [0.0, math.inf]
    np.testing.assert_array_equal(fit.probability(ends), [0.0, 1.0])
    np.testing.assert_array_equal(fit.band(ends, confidence), [[0.0, 1.0]] * 2)
    assert np.isfinite(fit.band([1e-300, 0.4, 1e300], confidence)).all()


def test_a_confidence_that_is_no_float():
    fit = fit_fragility(*drawn(100))
    assert fit.median_interval(Fraction(1, 2)) == fit.median_interval(0.5) == fit.median_interval(np.float16(0.5))
