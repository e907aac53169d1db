"""Times of a run: on the clock, and of the thread on the processor."""

import time

import pytest

import mjrock as mr
from mjrock.result.ending import Stopwatch
from scripts.shared.paper import FIGURE_3


def test_a_thread_that_waits_takes_no_time_of_the_processor():
    watch = Stopwatch()
    time.sleep(0.1)
    waited = watch.took()
    assert waited["wall_time"] >= 0.1
    assert waited["processor_time"] < 0.05
    end = time.thread_time() + 0.05
    while time.thread_time() < end:
        pass
    assert watch.stepping()["stepping_processor_time"] >= waited["processor_time"] + 0.05


@pytest.mark.parametrize("solver", ["MuJoCo", "explicit", "compliant", "analytical"])
def test_every_solver_says_what_it_took(solver):
    case, e = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 0.1), mr.Restitution.from_geometry(FIGURE_3.alpha)
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=5e8, xi_base=0.05, k_side=3e8, xi_side=0.02)
    stats = mr.Analysis(case, solver, e, contacts).solve().stats
    assert stats["processor_time"] > 0
    assert stats["wall_time"] > 0
    if solver in ("MuJoCo", "explicit"):
        assert 0 < stats["stepping_time"] < stats["wall_time"]
        assert 0 < stats["stepping_processor_time"] < stats["processor_time"]
