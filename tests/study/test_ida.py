"""Incremental dynamic analysis: peaks, capacities, and the scale that overturns a wall."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

import mjrock as mr
from mjrock.study.intensity import ida as module


@pytest.fixture(scope="module")
def pulse(wall, e):
    """An analysis of a half sine of so many times g alpha, in rocking theory."""

    def of(sign=1.0, duration=0.6):
        def build(scale):
            motion = mr.GroundMotion.half_sine(-sign * max(scale, 1e-3) * mr.GRAVITY * wall.alpha, duration)
            return mr.Analysis(mr.Case(wall, 0.0, 3.0, motion=motion), "analytical", e=e, options={"rtol": 1e-6})

        return build

    return of


@pytest.mark.slow
def test_peaks_of_one_record(tmp_path, pulse, wall):
    scales = [0.5, 1.5, 2.5, 6.0]
    found = mr.ida(pulse(), scales, tmp_path / "ida.sqlite", workers=1)
    expected = [pulse()(scale).solve().peak_over_alpha for scale in scales]
    np.testing.assert_array_equal(found.peaks, [expected])
    assert found.peaks[0, 0] == 0
    assert 0 < found.peaks[0, 1] < 1
    assert found.peaks[0, -1] == math.inf
    np.testing.assert_array_equal(found.scales, scales)
    assert found.capacity[0] == scales[list(expected).index(math.inf)]
    assert [row["scale"] for row in found.rows[0]] == scales
    assert found.rows[0][-1]["outcome"] == "overturned"
    assert repr(found) == "<IncrementalAnalysis of 1 records at 4 scales from 0.5 to 6: 1 records overturn the wall>"


@pytest.mark.slow
def test_several_records_and_what_is_stored(tmp_path, pulse, monkeypatch):
    builds = {"out": pulse(1.0), "long": pulse(1.0, 1.2), "short": pulse(1.0, 0.1)}
    scales = np.array([1.2, 1.8, 5.0])
    found = mr.ida(builds, scales, tmp_path / "ida.sqlite", workers=1)
    assert found.records == ("out", "long", "short")
    assert found.peaks.shape == (3, 3)
    assert [[row["record"] for row in own] for own in found.rows] == [[name] * 3 for name in builds]
    assert math.isnan(found.capacity[2])  # too short to overturn it
    assert found.capacity[1] < found.capacity[0]
    np.testing.assert_array_equal(found.percentiles((0, 50, 100)), np.sort(found.peaks, axis=0))
    assert found.percentiles().shape == (3, 3)

    def never(analysis):
        raise AssertionError("it runs again")

    monkeypatch.setattr(mr.Analysis, "solve", never)
    again = mr.ida(builds, scales, tmp_path / "ida.sqlite", workers=1)
    np.testing.assert_array_equal(again.peaks, found.peaks)
    here = ThreadPoolExecutor(1)
    with pytest.raises(RuntimeError, match="3 of 6 tasks failed, the first with AssertionError: it runs again"):
        mr.ida({"out": pulse(1.0)}, [1.2, 1.3, 1.8, 3.1, 5.0, 5.1], tmp_path / "ida.sqlite", executor=here)


@pytest.mark.slow
def test_labels_of_the_user_stay(tmp_path, pulse):
    def build(scale):
        return replace(pulse()(scale), labels={"scale": 10 * scale, "site": "rock"})

    found = mr.ida(build, [0.1, 0.2], tmp_path / "ida.sqlite", workers=1)
    assert [(row["scale"], row["site"], row["record"]) for row in found.rows[0]] == [
        (1.0, "rock", "record"),
        (2.0, "rock", "record"),
    ]


def test_the_overturning_intensity_is_where_the_outcome_changes(pulse):
    build = pulse()
    for tolerance in (1e-2, 1e-4):
        found = mr.overturning_intensity(build, 1.0, 8.0, tolerance=tolerance)
        assert build(found).solve().outcome is mr.Outcome.OVERTURNED
        assert build(found * (1 - tolerance)).solve().outcome is not mr.Outcome.OVERTURNED
    coarse = mr.overturning_intensity(build, 1.0, 8.0, tolerance=0.1)
    assert found <= coarse <= found / 0.9


def test_a_row_says_infinity_for_a_wall_that_overturned(pulse):
    assert pulse()(6.0)()["peak_over_alpha"] == math.inf
    assert 0 < pulse()(1.5)()["peak_over_alpha"] < 1


@pytest.mark.parametrize(
    ("scales", "complaint"),
    [
        ([], "scales has the shape"),
        (0.5, "scales has the shape"),
        ([0.2, 0.1], "scales = .* has to increase within the valid range 0 and above"),
        ([0.2, 0.2], "scales = .* has to increase"),
        ([-0.1, 0.2], "scales = .* has to increase"),
        ([0.1, math.nan], "scales holds a value that is not finite"),
        ([0.1, math.inf], "scales holds a value that is not finite"),
        (["a"], "scales = .* does not hold real numbers alone"),
        ([[0.1], [0.2, 0.3]], "scales = .* has rows of different lengths"),
    ],
)
def test_scales_that_cannot_be(scales, complaint, tmp_path, pulse):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.ida(pulse(), scales, tmp_path / "ida.sqlite")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("build", "complaint"),
    [
        (None, "build = None is not a function of a scale"),
        ({}, "build holds no records"),
        ({"a": 3}, r"build\['a'\] = 3 of type int is not a function of a scale"),
        ({1: print}, "the name of a record in build = 1 of type int is not a str"),
        (lambda scale: None, r"build\(0.1\) = None is not an Analysis"),
        ({"a": lambda scale: "x"}, r"build\['a'\]\(0.1\) = 'x' of type str is not an Analysis"),
    ],
)
def test_builds_that_cannot_be(build, complaint, tmp_path):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.ida(build, [0.1, 0.2], tmp_path / "ida.sqlite")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"low": 6.0}, "low = 6: the wall overturns at that scale already; give a lower one"),
        ({"high": 1.5}, r"high = 1.5: the wall does not overturn at that scale, its largest rotation is 0\.\d+ alpha"),
        ({"high": 0.5}, "high = 0.5 is outside the valid range, which is above low = 1"),
        ({"low": -1.0}, "low = -1 is outside the valid range"),
        ({"high": math.nan}, "high = nan is outside the valid range"),
        ({"tolerance": 0.0}, "tolerance = 0 is outside the valid range"),
        ({"build": 3}, "build = 3 of type int is not a function of a scale"),
        ({"build": mr.CALIBRATED}, "build = <DampingLaw .* is not a function of a scale"),
        ({"build": lambda scale: scale}, r"build\(1\) = 1.0 of type float is not an Analysis"),
    ],
)
def test_intensities_that_cannot_be(arguments, complaint, pulse):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.overturning_intensity(**{"build": pulse(), "low": 1.0, "high": 8.0} | arguments)


def test_a_share_that_cannot_be():
    found = module.IncrementalAnalysis(("a",), np.array([1.0]), np.array([[0.5]]), ())
    with pytest.raises(ValueError, match=r"shares\[0\] = 101 % is outside the valid range 0 to 100 %"):
        found.percentiles((101,))


def build_column(scale):
    masonry = mr.Masonry.stack([mr.Block.from_size(0.6, 2.1)] * 2, k_n=5e8, xi=0.05, friction=0.8)
    return mr.MasonryAnalysis(mr.MasonryCase(masonry, 1.5, motion=mr.GroundMotion.half_sine(scale, 0.6)))


def test_walls_and_masonry_have_no_peaks_in_common(tmp_path, pulse):
    """Those of walls are multiples of alpha, those of masonry rotations: a wall was missing from either column."""
    with pytest.raises(ValueError, match="build makes walls and masonry, whose peaks have different units"):
        mr.ida({"wall": pulse(), "masonry": build_column}, [0.5, 1.0], tmp_path / "ida.sqlite")
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_masonry_is_taken_as_a_wall_is(tmp_path):
    found = mr.ida(build_column, [0.5, 2.0, 6.0], tmp_path / "ida.sqlite", workers=1)
    assert found.peaks[0, 0] < found.peaks[0, 1] < found.peaks[0, 2] == math.inf
    assert found.capacity == [6.0]
    least = mr.overturning_intensity(build_column, 1.0, 6.0, tolerance=0.2)
    assert 2.0 < least < 6.0
