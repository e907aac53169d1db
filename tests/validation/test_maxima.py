"""Distributions of the maxima of the wall US-1: the distance of two ensembles, and what of it is chance."""

import numpy as np
import pytest
from scipy.stats import ks_2samp

from scripts.studies import maxima
from scripts.studies.shaken_wall import RUNS

TEST = np.array([run.test for run in RUNS.values()])
TWIN = np.array([run.twin.peak for run in RUNS.values()])


@pytest.mark.parametrize("other", [TWIN, 2 * TEST, TEST[::-1] + 0.1, np.full(24, 3.0)])
def test_the_distance_is_that_of_kolmogorov_and_smirnov(other):
    assert maxima.distance(TEST, other) == pytest.approx(ks_2samp(TEST, other).statistic, abs=1e-12)


def test_chance_makes_any_distance_of_equal_ensembles_and_none_of_those_far_apart():
    """Where every exchange of one run shortens the distance, all or none of the runs have to change places."""
    assert maxima.chance(TEST, TEST[::-1]) == 1.0
    few = np.arange(1.0, 5.0)
    assert maxima.chance(few, few + 100.0) == pytest.approx(2 / 2**4, abs=0.01)


def test_the_calibrated_law_is_as_near_to_the_tests_as_their_repetition():
    """As docs/compared_with_tests.md says of all runs, and of those of the record that cracked the wall."""
    found = maxima.ensembles(maxima.TABLE)
    of_record = np.array([run.record == "HU12" for run in RUNS.values()])
    for runs in (of_record | True, of_record):
        apart = {name: maxima.distance(TEST[runs], values[runs]) for name, values in found.items()}
        assert apart["calibrated law"] <= apart[maxima.TWIN]
        assert apart["calibrated law"] == min(apart.values())


def test_a_table_of_a_short_study_is_refused(tmp_path):
    short = tmp_path / "short.csv"
    short.write_text("".join(maxima.TABLE.read_text(encoding="utf-8").splitlines(keepends=True)[:3]), encoding="utf-8")
    with pytest.raises(ValueError, match=r"has 2 runs, and the test has 24; run cracked_damping\.py without --quick"):
        maxima.ensembles(short)
