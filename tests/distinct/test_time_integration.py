"""How explicit steps are cut into calls, and what is said before long ones."""

import os
import re
import signal
import threading
import time
import warnings

import numpy as np
import pytest
from masonry_blocks import columns

import mjrock as mr
from mjrock.distinct import time_integration
from mjrock.distinct.step_length import StepLength, TimeGrid

SLOW = mr.Masonry.facade(length=0.8, height=0.4, depth=0.4, unit=(0.4, 0.2), k_n=1e12, frequency=1.0)
"""Its dashpots ask for steps of less than a nanosecond: hours for a simulated second, minutes for a sample."""


def test_an_interruption_is_heard_within_a_sample():
    case = mr.MasonryCase(SLOW, 0.01)
    mr.solve_explicit(mr.MasonryCase(SLOW, 1e-6))  # compiled
    heard = []
    timer = threading.Timer(0.35, lambda: (heard.append(time.perf_counter()), os.kill(os.getpid(), signal.SIGINT)))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        mr.solve_explicit(case)
    assert time.perf_counter() - heard[0] < 3.0  # 0.3 s, on a busy machine more


@pytest.mark.parametrize("masonry", [columns(4), mr.Masonry.column(0.4, 0.8, 2)], ids=["plane", "space"])
def test_the_calls_do_not_matter(monkeypatch, masonry):
    """Also where blocks have left their joints and meet others."""
    velocity = np.zeros((len(masonry.free), 6 if masonry.in_space else 3))
    velocity[:, 0] = 2.0
    case = mr.MasonryCase(masonry, 0.05, velocity=velocity)
    whole = mr.solve_explicit(case, output_step=0.02)
    monkeypatch.setattr(time_integration, "FIRST_CALL", 100)
    monkeypatch.setattr(time_integration, "CALL_TIME", 1e-6)
    assert mr.solve_explicit(case, output_step=0.02) == whole


def test_long_runs_speak_before_they_start(monkeypatch):
    def stop(*args):
        raise StopIteration

    monkeypatch.setattr("mjrock.distinct.explicit.integrate", stop)
    complaint = r"explicit steps would take some \S+ s: \S+ steps of \S+ s on \d+ contact lines\. The dashpots, "
    with pytest.warns(UserWarning, match=complaint), pytest.raises(StopIteration):
        mr.solve_explicit(mr.MasonryCase(SLOW, 1.0), output_step=0.1)
    with warnings.catch_warnings():  # what is long without a remedy has a bar, and is no warning
        warnings.simplefilter("error")
        with pytest.raises(StopIteration):
            mr.solve_explicit(mr.MasonryCase(columns(4), 1e4), output_step=0.1)


def test_ten_seconds_are_worth_saying_where_the_run_is_asked_for(monkeypatch):
    case = mr.MasonryCase(columns(1), 1e-5)
    monkeypatch.setattr(time_integration, "STRONG_DASHPOTS", 1.0)
    for seconds, named in ((9.0, []), (11.0, ["explicit steps would take some 11 s"])):
        monkeypatch.setattr(time_integration, "stepping_seconds", lambda *args, s=seconds, **more: s)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            mr.solve_explicit(case, timestep=1e-9)
        complaint = [(re.split("[,:]", str(one.message))[0], one.filename) for one in caught]
        assert complaint == [(text, __file__) for text in ("timestep = 1e-09 s", *named)]


def test_the_estimate_is_near_what_it_takes(monkeypatch):
    """Within a factor of five, of the processor: the machine may do other things too."""
    masonry = mr.Masonry.arch(5.0, 0.75, k_n=1e10)
    estimates, of = [], time_integration.stepping_seconds
    monkeypatch.setattr(
        time_integration,
        "stepping_seconds",
        lambda *given, **more: estimates.append(of(*given, **more)) or estimates[-1],
    )
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.2))
    (estimate,) = estimates
    assert 0.2 < estimate / run.stats["stepping_processor_time"] < 5


@pytest.mark.parametrize("seed", range(20))
def test_a_step_that_is_given_again_gives_the_same_samples(seed):
    """Samples are then as far apart as they were, though more are kept in between. With any other step they are no
    farther apart than requested, and nearer by less than the distance of those that are kept and a step."""
    rng = np.random.default_rng(seed)
    duration, output, spacing, limit = 10 ** rng.uniform((-1, -2, -3, -5), (1, -1, -1.5, -3))
    length = StepLength(limit, 0.3 * limit, spacing)
    first = TimeGrid.of_run(length, duration, None, output)
    again = TimeGrid.of_run(length, duration, first.h, first.steps_per_sample * first.stride * first.h)
    assert (again.steps_per_sample, again.stride, again.last) == (first.steps_per_sample, first.stride, first.last)
    other = TimeGrid.of_run(length, duration, 0.77 * first.h, output)
    apart = other.steps_per_sample * other.stride * other.h
    assert other.steps_per_sample * other.h < spacing + 0.5 * other.h
    assert output - (other.steps_per_sample + 1) * other.h < apart < max(output, other.h) * (1 + 1e-9)
