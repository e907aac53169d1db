"""A touch inside a step: the energy that it puts in or takes, and the step that an error about it advises."""

import math
import re

import numpy as np
import pytest

import mjrock as mr
from mjrock.distinct import reading
from mjrock.result import ledger

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
    gained = float(re.search(r"(\S+)% of the energy there was", str(caught.value))[1]) / 100
    assert advised == pytest.approx(min(0.0158 * STABLE, 0.25e-3 / gained * 1e-3), rel=0.05)
    assert thrown(0.05, advised, 1.0, spin).stats["timestep"] == advised


def test_the_error_names_a_shorter_step_where_that_one_does_not_do(monkeypatch):
    """A shorter step is named however short the one is that was taken, by how much energy there was too much."""
    for module in (reading, ledger):
        monkeypatch.setattr(module, "ENERGY_GAIN", 1e-7)
    for taken in (0.1 * STABLE, 0.01 * STABLE):
        with pytest.raises(RuntimeError, match=r"appeared from nowhere.*take timestep = ") as caught:
            thrown(0.05, taken, 0.3)
        gained = float(re.search(r"(\S+)% of the energy there was", str(caught.value))[1]) / 100
        named = float(re.search(r"timestep = (\S+) s", str(caught.value))[1])
        touches = 0.5 * math.sqrt(1e-7) * STABLE
        assert named == pytest.approx(min(touches, 0.25e-7 / gained * taken), rel=0.05)


def test_rounding_is_no_energy_from_nowhere(monkeypatch):
    """Whatever share of the energy is tolerated. The block flies free."""
    for module in (reading, ledger):
        monkeypatch.setattr(module, "ENERGY_GAIN", 1e-18)
    run = thrown(0.05, 1e-4, 0.05, (0.0, 0.0, 1.0))
    assert np.ptp(run.energy) > 1e-18 * run.energy[0]


DAMPED = mr.Masonry.box((1, 1, 1), k_n=1e8, friction=0.6, xi=0.2)


def test_a_ledger_that_does_not_close_warns_and_names_a_step_that_closes_it():
    case = mr.MasonryCase(DAMPED, 0.3, velocity=[(0, 0, 1.0, 0, 0, 0)])
    coarse = {"timestep": 2e-3, "output_step": 2e-3}
    with pytest.warns(UserWarning, match=r"the ledger does not close: .* J, \d\.\d% of its largest part.*take") as said:
        run = mr.solve_explicit(case, ledger=True, **coarse)
    share = np.abs(run.energy_residual).max() / run.ledger.largest
    assert 0.01 < share < 0.1
    assert f"{share:.1%}" in str(said[0].message)
    assert said[0].filename == __file__  # it points at the call
    named = float(re.search(r"timestep = (\S+) s", str(said[0].message))[1])
    assert named == pytest.approx(0.005 / share * run.stats["timestep"], rel=0.05)
    run = mr.solve_explicit(case, timestep=named, ledger=True)  # a warning is an error here
    assert np.abs(run.energy_residual).max() < 0.01 * run.ledger.largest


def test_without_a_ledger_nothing_is_said_of_it():
    case = mr.MasonryCase(DAMPED, 0.3, velocity=[(0, 0, 1.0, 0, 0, 0)])
    assert mr.solve_explicit(case, timestep=2e-3, output_step=2e-3).ledger is None


def test_energy_that_ends_of_faces_put_in_has_an_account_and_warns():
    """Blocks of a dome that spin slide past the ends of their faces and are met again, already inside each other."""
    dome = mr.Masonry.dome(0.18, 0.03, lunes=4, hoops=1, oculus=0.3, k_n=6e7, friction=0.9)
    velocity = [
        (0.3, 0.2, 0.2, -0.6, -3.1, 1.8),
        (0.0, 0.2, 0.1, -0.6, -1.3, 1.6),
        (0.1, 0.0, -0.3, -1.4, 4.2, 1.1),
        (0.2, -0.4, 0.0, -1.4, -5.8, -3.9),
    ]
    case = mr.MasonryCase(dome, 0.1, velocity=velocity)
    with pytest.warns(
        UserWarning, match=r"contacts at ends of faces put in \S+ J, \d+\.\d% of the energy there was"
    ) as said:
        run = mr.solve_explicit(case, timestep=2e-5, ledger=True)
    assert said[0].filename == __file__
    assert run.ledger.ends["joints"].min() < -0.01 * run.ledger.kinetic.max()
    assert np.abs(run.energy_residual).max() < 1e-3 * run.ledger.largest
