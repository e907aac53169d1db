"""A touch inside a step: the energy that it puts in or takes, and the step that an error about it advises."""

import math
import re

import numpy as np
import pytest

import mjrock as mr
from mjrock.distinct import reading

BLOCK = mr.Masonry.box((0.6, 0.4, 2.0), k_n=1e8, friction=0.6, xi=0.0)
THROWN = 1.0
"""Velocity of the block at its release [m/s]."""
STABLE = 2 / math.sqrt(1e8 * 0.6 * 0.4 / 960)
"""Longest stable step of the block without damping: as it bounces on its base, 960 kg on 1e8 N/m3 [s]."""


def thrown(height, timestep, duration=0.32, spin=(0.0, 0.0, 0.0)):
    """The block without damping, thrown up from a height over its ground, bounces."""
    start = np.array([[0, 0, height, 1.0, 0, 0, 0]]), np.array([[0, 0, THROWN, *spin]])
    case = mr.MasonryCase(BLOCK, duration)
    return mr.solve_explicit(case, timestep=timestep, output_step=timestep or 1e-3, start=start)


@pytest.mark.parametrize("share", [0.4, 0.1])
def test_a_bounce_keeps_its_energy_but_for_the_square_of_the_step(share, monkeypatch):
    """It gains or loses up to (h / longest stable step)^2, as the touches happen to lie within their steps."""
    monkeypatch.setattr(reading, "require_no_gain", lambda run, count, stats: None)
    steps = share * STABLE * np.linspace(0.8, 1.0, 12)
    runs = [thrown(0.05 + 0.3 * i * steps[-1] * THROWN, h) for i, h in enumerate(steps)]
    assert runs[-1].stats["share"] == pytest.approx(share)
    gained = np.array([run.energy[-1] / run.energy[0] - 1 for run in runs])
    assert 0.2 * share**2 < gained.max() < 1.01 * share**2
    assert 0.2 * share**2 < -gained.min() < 1.01 * share**2
    assert abs(gained.mean()) < 0.2 * share**2


def test_the_error_advises_a_step_that_does():
    spin = (0.3, 0.2, 1.0)
    with pytest.raises(RuntimeError, match=r"appeared from nowhere.*up to 0.62% of the energy it meets") as caught:
        thrown(0.05, None, 1.0, spin)
    advised = float(re.search(r"timestep = (\S+) s", str(caught.value))[1])
    assert advised == pytest.approx(0.0158 * STABLE, rel=0.05)
    assert thrown(0.05, advised, 1.0, spin).stats["timestep"] == advised
