"""The steps between which no energy may appear in a run of masonry."""

from types import SimpleNamespace

import numpy as np
import pytest

from mjrock.engine.run import MARKS, marks_of_masonry


@pytest.mark.parametrize(("fallen", "steps"), [({}, 50), ({"lintel": 0.5}, 25)])
def test_they_reach_from_the_first_step_to_the_last_before_a_block_falls(fallen, steps):
    reading, t = SimpleNamespace(joints=SimpleNamespace(fallen=fallen)), np.arange(50) / 50
    marks, count = marks_of_masonry(reading, SimpleNamespace(t=t))
    assert count == steps
    assert marks.tolist() == list(range(steps))


def test_they_are_few_in_a_long_run():
    marks, count = marks_of_masonry(
        SimpleNamespace(joints=SimpleNamespace(fallen={})), SimpleNamespace(t=np.linspace(0.0, 9.0, 5000))
    )
    assert (len(marks), marks[0], marks[-1], count) == (MARKS, 0, 4999, 5000)
    assert np.diff(marks).max() <= 6
