"""Fragility for a report: few records, lost walls, capacities, paired ratios, CSV."""

import math

import numpy as np
import pytest
from scipy.stats import binom, chi2, norm
from scipy.stats import t as student

import mjrock as mr
from mjrock.study.intensity.fragility import _penalised
from mjrock.study.intensity.ida import IncrementalAnalysis
from scripts.studies import fragility_coverage

RNG = np.random.default_rng(3)
CAPACITIES = 0.8 * np.exp(0.3 * RNG.normal(size=40))


def test_a_wall_that_leans_on_its_ties_is_lost():
    rows = [("overturned", math.inf), ("at rest", 0.4), ("time ended", 1.4), ("time ended", 0.4), ("at rest", 1.2)]
    untied = [{"outcome": outcome, "peak_over_alpha": peak} for outcome, peak in rows]
    assert mr.lost([row | {"tie_0_force_N": 2e4} for row in untied]).tolist() == [True, False, True, False, False]
    assert mr.lost([row | {"tie_0_force_N": None} for row in untied]).tolist() == [True, False, False, False, False]
    assert mr.lost([row | {"tie_stiffness": 1e6} for row in untied]).tolist() == [True] + 4 * [False]  # a label
    assert mr.lost([row | {"inwards_over_alpha": 1.1} for row in untied]).all()
    assert mr.lost([row | {"inwards_over_alpha": 0.9} for row in untied]).tolist() == [True] + 4 * [False]
    with pytest.raises(ValueError, match=r"rows\[0\] has outcome = None and peak_over_alpha = None: no result"):
        mr.lost([{"status": "failed", "outcome": None}])
    with pytest.raises(TypeError, match="rows = 3 of type int are not rows of a campaign"):
        mr.lost(3)
    with pytest.raises(TypeError, match=r"rows = array.* are not rows of a campaign"):
        mr.lost(np.array(0.3))
    with pytest.raises(TypeError, match=r"lost\(rows\) makes it of the rows of a campaign"):
        mr.fit_fragility([1.0, 2.0], ["overturned", "time ended"])


def test_a_median_beyond_the_data_is_said_to_be():
    x = np.repeat([0.5, 0.6, 0.7, 0.8], 6)
    fell = np.tile([0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0], 2).astype(bool)
    fell[-4:-2] = True
    with pytest.warns(UserWarning, match=r"the median 0\.\d+ is extrapolated: the intensities tried are 0.5 to 0.8"):
        fit = mr.fit_fragility(x, fell)
    assert fit.tried == (0.5, 0.8)


def test_a_warning_points_to_the_line_of_the_user():
    """Also where one function of the package has called the one that warns."""
    fell = np.zeros((6, 4), dtype=int)
    fell[0, 1] = fell[0, 3] = fell[2, 3] = fell[3, 3] = 1
    rows = tuple(tuple({"outcome": "time ended", "fallen": int(one)} for one in record) for record in fell)
    study = IncrementalAnalysis(tuple("abcdef"), np.array([0.5, 0.6, 0.7, 0.8]), np.zeros((6, 4)), rows)
    with pytest.warns(UserWarning, match="extrapolated|resamples") as warned:
        study.fragility(resamples=20)
    assert {warning.filename for warning in warned} == {__file__}


def test_six_records_have_a_band_and_a_word():
    x = np.tile([0.6, 0.7, 0.8, 0.9, 1.0], 6)
    capacities = np.repeat([0.75, 0.75, 0.85, 0.85, 0.85, 0.95], 5)
    with pytest.warns(UserWarning, match=r"\d+ of 1000 resamples of 6 groups gave no curve, only a step"):
        fit = mr.fit_fragility(x, x > capacities, np.repeat(np.arange(6), 5))
    low, high = fit.band([0.3, 0.5, 1.4])
    assert fit.without_curve > 50
    assert (high[:2] < 0.2).all()
    assert low[2] > 0.8
    assert 0 < fit.dispersion_interval()[0] < fit.dispersion_interval()[1] < 10


def test_the_penalised_fit_is_that_of_reduced_bias():
    """With one intensity level the penalised share is (fallen + 1/2) / (runs + 1), as for a binomial share."""
    log_x = np.log(np.repeat([1.0, 2.0], 4))
    fell = np.array([0, 0, 0, 0, 1, 1, 1, 1], dtype=bool)
    ((level, slope),) = _penalised(log_x, fell, np.ones((1, 8)))
    assert np.isfinite([level, slope]).all()
    assert level == pytest.approx(-(level + slope * math.log(2)))  # symmetric
    assert slope > 0


def test_capacities_are_fitted_directly():
    fit = mr.fit_capacities(CAPACITIES)
    assert fit.median == pytest.approx(np.exp(np.log(CAPACITIES).mean()))
    assert fit.dispersion == pytest.approx(np.log(CAPACITIES).std(ddof=1))
    reach = student.ppf(0.95, 39) * fit.dispersion / math.sqrt(40)
    low, high = fit.median_interval()
    assert np.log(high / low) == pytest.approx(2 * reach, rel=0.15)
    assert fit.groups == 40
    low, high = mr.fit_capacities(CAPACITIES, np.arange(40) // 8).median_interval()
    assert low < fit.median < high


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("confidence", [0.0, 0.5, 0.9, 0.99])
def test_a_band_lies_within_the_intervals_of_its_table(seed, confidence):
    """At every intensity, of 14 capacities of 7 records: the four curves of the ends of both intervals bound it."""
    rng = np.random.default_rng(seed)
    capacities = 0.6 * np.exp(0.12 * rng.normal(size=(7, 1)) + 0.08 * rng.normal(size=(7, 2))).ravel()
    fits = [mr.fit_capacities(capacities, np.repeat(np.arange(7), 2))]
    levels = np.linspace(0.3, 1.0, 8)
    fell = np.repeat(levels, 14) > np.tile(capacities, 8)
    fits.append(mr.fit_fragility(np.repeat(levels, 14), fell))
    x = np.linspace(0.05, 1.5, 59)
    for fit in fits:
        low, high = fit.band(x, confidence)
        curves = [
            norm.cdf(np.log(x / median) / dispersion)
            for median in fit.median_interval(confidence)
            for dispersion in fit.dispersion_interval(confidence)
        ]
        assert (low >= np.min(curves, axis=0) - 1e-12).all()
        assert (high <= np.max(curves, axis=0) + 1e-12).all()
        if confidence >= 0.5:
            wide = fit.band(x, 0.5 + 0.5 * confidence)
            assert (wide[0] <= low + 1e-12).all()
            assert (wide[1] >= high - 1e-12).all()
        assert (np.diff(low) >= 0).all()
        assert (np.diff(high) >= 0).all()


def test_the_dispersion_of_few_capacities_has_the_interval_of_a_sample():
    """s^2 (n - 1) over the quantiles of chi-square, exact for lognormal capacities; resamples may only widen it."""
    fit = mr.fit_capacities(CAPACITIES[:6])
    low, high = fit.dispersion_interval(0.8)
    exact = fit.dispersion * np.sqrt(5 / chi2.ppf([0.9, 0.1], 5))
    assert low <= exact[0] * (1 + 1e-9)
    assert high >= exact[1] * (1 - 1e-9)
    assert fit.dispersion_interval(1.0)[1] == math.inf
    held = 0
    for seed in range(200):
        few = mr.fit_capacities(np.exp(0.3 * np.random.default_rng(seed).normal(size=5)), resamples=50)
        ends = few.dispersion_interval()
        held += ends[0] <= 0.3 <= ends[1]
    assert held > 0.85 * 200  # 0.9 is known from 200 studies to 2 %


def test_the_curve_as_a_table(tmp_path):
    fit = mr.fit_capacities(CAPACITIES)
    text = fit.csv(tmp_path / "curve.csv", intensity=[0.4, 0.8])
    assert text == (tmp_path / "curve.csv").read_text()
    lines = [line.split(",") for line in text.splitlines()]
    assert lines[0] == ["intensity", "probability", "lower 90%", "upper 90%"]
    assert [float(cell) for cell in lines[2]] == [0.8, fit.probability(0.8), *np.ravel(fit.band(0.8))]
    assert len(fit.csv().splitlines()) == 101


def test_a_paired_ratio_is_sharper_than_its_parts():
    with_tie = 1.8 * CAPACITIES * np.exp(0.05 * RNG.normal(size=40))
    found = mr.paired_ratio(with_tie, CAPACITIES)
    logs = np.log(with_tie / CAPACITIES)
    reach = student.ppf(0.95, 39) * logs.std(ddof=1) / math.sqrt(40)
    assert found.ratio == pytest.approx(np.exp(logs.mean()))
    assert (found.low, found.high) == pytest.approx(np.exp(logs.mean() + np.array([-reach, reach])))
    assert found.ratio == pytest.approx(1.8, rel=0.03)
    assert found.high / found.low < 1.05
    assert str(found) == f"{found.ratio:.2f}, 90% interval {found.low:.2f} to {found.high:.2f}, single pairs " + (
        f"{found.least:.2f} to {found.most:.2f} (40 pairs, 40 records)"
    )
    pairs = mr.paired_ratio(with_tie, CAPACITIES, np.arange(40) // 2)
    assert pairs.groups == 20
    assert pairs.ratio == pytest.approx(found.ratio)


@pytest.mark.filterwarnings("ignore:.* gave no curve:UserWarning")
def test_the_runs_of_an_ida_are_fitted():
    scales = np.array([0.0, 0.6, 0.8, 1.0])
    capacity = np.array([0.55, 0.7, 0.7, 0.9, 0.9, 0.9, 5.0])
    peaks = np.where(scales >= capacity[:, None], math.inf, 0.2)
    rows = tuple(
        tuple({"outcome": "overturned" if p == math.inf else "at rest", "peak_over_alpha": p} for p in own)
        for own in peaks
    )
    found = IncrementalAnalysis(tuple("abcdefg"), scales, peaks, rows)
    fit = found.fragility(resamples=200)
    direct = mr.fit_fragility(np.tile(scales[1:], 7), np.isinf(peaks[:, 1:]).ravel())
    assert (fit.median, fit.dispersion) == (direct.median, direct.dispersion)
    assert fit.groups == 7
    with pytest.raises(ValueError, match=r"groups has the shape \(2,\); \(7,\) is needed"):
        found.fragility([1, 2])


def test_the_search_brackets_by_itself(wall, e):
    def build(scale):
        motion = mr.GroundMotion.half_sine(-scale * mr.GRAVITY * wall.alpha, 0.6)
        return mr.Analysis(mr.Case(wall, 0.0, 2.0, motion=motion), "analytical", e=e, options={"rtol": 1e-6})

    given = mr.overturning_intensity(build, 1.0, 8.0)
    assert mr.overturning_intensity(build) == pytest.approx(given, rel=2e-3)
    assert mr.overturning_intensity(build, start=15.0) == pytest.approx(given, rel=2e-3)
    with pytest.raises(ValueError, match=r"low = 1.0 and high = None: give both, or neither"):
        mr.overturning_intensity(build, 1.0)


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: mr.fit_capacities([1.0, math.nan]), "capacities holds a value that is not finite"),
        (lambda: mr.fit_capacities([1.0, -1.0]), r"capacities\[1\] = -1 is outside the valid range"),
        (
            lambda: mr.fit_capacities([1.0, 2.0]),
            "the number of groups is 2 .*; the valid range is 5 or more: fewer give no interval",
        ),
        (lambda: mr.fit_capacities([1.0] * 6), "capacities are all equal"),
        (lambda: mr.paired_ratio([1.0, 2.0], [1.0]), "over has 1 values and capacities 2; they have to be pairs"),
        (lambda: mr.paired_ratio([1.0, 2.0], [1.0, 1.0], [1]), r"groups has the shape \(1,\)"),
        (lambda: mr.paired_ratio([1.0], [1.0]), "the number of groups is 1 .*; the valid range is 2 or more"),
        (lambda: mr.paired_ratio([1.0, 2.0], [1.0, 1.0], confidence=2), "confidence = 2 is outside"),
    ],
)
def test_what_cannot_be(call, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        call()


def share_with_a_curve(records, levels):
    """Share of studies in which no single intensity parts what fell: the capacities spread over more than two
    neighbouring steps between the intensities. Both capacities of a record lie in a step with a probability that
    Gauss-Hermite quadrature integrates over the middle of the record."""
    nodes, weights = np.polynomial.hermite_e.hermegauss(200)
    ends = np.log(np.array([1e-9, *levels, 1e9]) / fragility_coverage.MEDIAN)
    below = norm.cdf((ends[:, None] - fragility_coverage.BETWEEN * nodes) / fragility_coverage.WITHIN)

    def all_within(steps):
        inside = below[steps:] - below[:-steps]
        return (((inside**2) @ weights / weights.sum()) ** records).sum()

    return 1 - all_within(2) + all_within(1)  # two windows share the capacities of one step


@pytest.mark.slow
@pytest.mark.parametrize(("records", "studies"), [(6, 800), (40, 80)])
def test_the_intervals_hold_the_truth(records, studies):
    """Of 90 % intervals and bands, as many as a binomial sample has in all but one of a hundred cases, with few records
    too. 800 studies know it to 1 %: a band of dispersions that are only reflected held 87 % away from the median.
    Studies without a curve are left out, and are as frequent as they have to be."""
    for row in fragility_coverage.coverage(records, studies):
        if (levels := fragility_coverage.LEVELS.get(row[1])) is not None:
            curves = share_with_a_curve(records, levels)
            assert binom.ppf(0.005, studies, curves) <= row[2] <= binom.ppf(0.995, studies, curves)
        assert min(float(share) for share in row[3:-1]) >= binom.ppf(0.01, row[2], 0.9) / row[2], row
