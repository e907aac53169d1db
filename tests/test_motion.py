import math
from pathlib import Path

import numpy as np
import pytest

import mjrock as mr
from paper import FIGURE_3

RECORDS = Path(__file__).parents[2] / "shared" / "records"


def test_linear_between_samples_and_quiet_outside():
    motion = mr.GroundMotion([1.0, 3.0, -1.0], 0.5)
    np.testing.assert_allclose(motion(np.array([-0.1, 0.0, 0.25, 0.5, 0.9, 1.0, 1.1])), [0, 1, 2, 3, -0.2, -1, 0])
    assert motion.duration == 1.0
    assert motion.peak == 3.0


def test_scaled_and_reversed():
    motion = mr.GroundMotion.sine(2.0, 0.8)
    np.testing.assert_array_equal(motion.reversed().accel, -motion.accel)
    assert motion.scaled(1.5).peak == pytest.approx(3.0)
    assert motion.reversed().reversed() == motion
    assert hash(motion.reversed().reversed()) == hash(motion)
    assert motion != motion.scaled(2)


@pytest.mark.parametrize(
    ("accel", "dt", "complaint"),
    [
        ([0.0, math.nan, 1.0], 0.01, r"accel\[1\] = nan m/s2 is not finite"),
        ([[0.0, 1.0]], 0.01, r"shape \(1, 2\)"),
        ([1.0], 0.01, r"at least 2"),
        ([0.0, 1.0], 0.0, r"dt = 0 s"),
        ([0.0, 1.0], 20.0, r"dt = 20 s"),  # milliseconds
    ],
)
def test_bad_records(accel, dt, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.GroundMotion(accel, dt)


def test_another_unit_is_noticed():
    with pytest.warns(UserWarning, match="peaks at 300 m/s2 = 30.6 g"):
        mr.GroundMotion([0.0, 300.0], 0.01)


@pytest.mark.parametrize("amplitude", [-3.0, 3.0])
def test_mujoco_follows_the_contact_law_under_a_pulse(contacts, amplitude):
    """Outward first and inward first: two different motions of a one-sided wall, both as the contact law has them."""
    case = mr.Case(FIGURE_3, 0.0, 2.0, motion=mr.GroundMotion.sine(amplitude, 0.8))
    law = mr.solve_compliant(case, contacts)
    for options in ({}, {"timestep": 1e-4}):
        run = mr.simulate(case, contacts, **options)
        assert np.abs(run.theta).max() == pytest.approx(np.abs(law.theta).max(), rel=0.02)


def test_polarity_matters_to_a_one_sided_wall(contacts):
    """A negative acceleration opens the wall at once; the reversed one presses it against its stop first."""
    motion = mr.GroundMotion.sine(-2.0, 0.8)
    early = [
        mr.simulate(mr.Case(FIGURE_3, 0.0, 0.3, motion=m), contacts).theta.max() / FIGURE_3.alpha
        for m in (motion, motion.reversed())
    ]
    assert early[0] > 0.02
    assert early[1] < 0.01


def test_below_uplift_nothing_rocks(wall, contacts):
    least = mr.GRAVITY * math.tan(wall.alpha)
    for share, rocks in ((0.7, False), (1.4, True)):
        motion = mr.GroundMotion.sine(-share * least, 1.5, cycles=0.5)
        run = mr.simulate(mr.Case(wall, 0.0, 1.0, motion=motion), contacts)
        assert bool(run.theta.max() > 3 * contacts.uplift_rotation(wall)) is rocks


@pytest.mark.parametrize("accuracy", [1e-3, 1e-4])
def test_the_ledger_closes_on_a_shaken_wall(contacts, accuracy):
    case = mr.Case(FIGURE_3, 0.0, 4.0, motion=mr.GroundMotion.sine(-3.0, 1.2))
    book = mr.simulate(case, contacts, accuracy=accuracy, ledger=True).ledger
    assert np.abs(book.ground).max() > 1e3
    assert np.abs(book.residual).max() < 3 * accuracy * np.abs(book.ground).max()


def test_a_recorded_motion(contacts):
    if not RECORDS.is_dir():
        pytest.skip(f"the recorded ground motions are not at {RECORDS.name}")
    lines = (RECORDS / "LA14.sac").read_text().splitlines()
    count, dt = int(lines[1].split()[0]), float(lines[1].split()[1])
    accel = np.array(" ".join(lines[2:]).split(), dtype=float)[:count] / 100
    motion = mr.GroundMotion(accel, dt, "LA14").scaled(0.25)
    case = mr.Case(FIGURE_3, 0.0, 8.0, motion=motion)
    coarse, fine = (mr.simulate(case, contacts, accuracy=a, ledger=True) for a in (1e-3, 1e-4))
    assert fine.theta.max() > 0.01 * FIGURE_3.alpha
    assert coarse.theta.max() == pytest.approx(fine.theta.max(), rel=0.05)
    assert np.abs(fine.energy_residual).max() < 1e-3 * np.abs(fine.ledger.ground).max()


def test_theory_refuses_what_it_does_not_solve(e):
    case = mr.Case(FIGURE_3, 0.0, 1.0, motion=mr.GroundMotion.sine(1.0, 0.5))
    with pytest.raises(ValueError, match="free rocking only"):
        mr.solve_analytical(case, e)
