"""The steps between which no energy may appear in a run of masonry."""

from types import SimpleNamespace

import numpy as np
import pytest

import mjrock as mr
from mjrock.engine.run import MARKS, marks_of
from mjrock.result.reading import Reading


@pytest.mark.parametrize("count", [50, 25])
def test_they_reach_from_the_first_step_to_the_last_before_a_block_falls(count):
    reading = Reading(mr.Outcome.AT_REST, "", count=count)
    assert marks_of(reading, SimpleNamespace(t=np.arange(50) / 50)).tolist() == list(range(count))


def test_they_are_few_in_a_long_run():
    marks = marks_of(Reading(mr.Outcome.AT_REST, "", count=5000), SimpleNamespace(t=np.linspace(0.0, 9.0, 5000)))
    assert (len(marks), marks[0], marks[-1]) == (MARKS, 0, 4999)
    assert np.diff(marks).max() <= 6


def test_those_of_a_wall_are_its_peaks_while_it_can_come_back():
    t = np.arange(50) / 50
    reading = Reading(mr.Outcome.AT_REST, "", count=25, peak_times=np.array([0.1, 0.3, 0.7]))
    assert marks_of(reading, SimpleNamespace(t=t, windows=SimpleNamespace(t=t))).tolist() == [0, 5, 15, 24]


def test_a_peak_in_the_last_window_is_that_of_the_last_step():
    t = np.arange(50) / 50
    reading = Reading(mr.Outcome.AT_REST, "", count=25, peak_times=t[[24]])
    assert marks_of(reading, SimpleNamespace(t=t, windows=SimpleNamespace(t=t - 0.01))).tolist() == [0, 24]
