import csv
import dataclasses
import io
import math

import numpy as np
import pytest

import mjrock as mr
from mjrock.result.motion import SampledMotion


def turned(response, theta):
    """A response of a wall with other rotations at its first samples, and nothing after them."""
    n = len(theta)
    pose = response.pose[:n].copy()
    pose[:, 0, 2] = theta
    motion = SampledMotion(pose, response.velocity[:n], response.energy[:n])
    return dataclasses.replace(response, t=response.t[:n], motion=motion)


@pytest.fixture(scope="module")
def comparison(two_sided, contacts, e):
    return mr.compare(mr.solve_analytical(two_sided, e), mr.simulate(two_sided, contacts, 1e-3))


def test_a_response_equals_itself(two_sided, e):
    response = mr.solve_analytical(two_sided, e)
    same = mr.compare(response, response)
    assert same.rms == 0
    np.testing.assert_array_equal(same.restitution[:, 0], same.restitution[:, 1])


def test_rms_is_in_multiples_of_alpha(two_sided, e):
    response = mr.solve_analytical(two_sided, e)
    shifted = turned(response, response.theta + 0.01 * two_sided.block.alpha)
    assert mr.compare(response, shifted).rms == pytest.approx(0.01)


def test_different_grids_and_lengths(two_sided, e):
    long = mr.solve_analytical(two_sided, e)
    other = mr.solve_analytical(two_sided, e, output_step=1.7e-4)
    assert mr.compare(long, other).rms < 1e-6
    half = turned(other, other.theta[: len(other.t) // 2])
    assert mr.compare(long, half).rms < 1e-6


def test_a_wall_that_stops_dead_is_told_from_one_that_rebounds(one_sided, e):
    """RMS alone would score it well: what tells them apart is the restitution per rebound."""
    exact = mr.solve_analytical(one_sided, e)
    stop = exact.impacts[0].t
    rocking = dataclasses.replace(exact.rocking, peaks=exact.peaks[:1])
    dead = dataclasses.replace(turned(exact, np.where(exact.t < stop, exact.theta, 0.0)), rocking=rocking)
    found = mr.compare(exact, dead)
    assert found.rms == pytest.approx(0.0185 * math.sqrt(4 / 3), abs=3e-4)  # 0.0185 over 4 s
    assert np.isnan(found.restitution[0, 1])
    assert found.restitution[0, 0] == pytest.approx(abs(e.lumped))


def test_losses_add_up(comparison):
    released = comparison.reference.case.release_energy
    np.testing.assert_allclose(comparison.energy_share, comparison.energy_loss / released)
    assert comparison.energy_loss[0, 0] == pytest.approx((1 - 0.97**2) * released, rel=1e-6)


def test_table_and_csv_say_the_same(comparison):
    rows = list(csv.DictReader(io.StringIO(comparison.csv())))
    assert len(rows) == len(comparison.impact_times)
    assert float(rows[0]["restitution analytical [-]"]) == comparison.restitution[0, 0]
    assert all("[" in name for name in rows[0] if name != "impact")
    table = comparison.table()
    assert all(f"{shown:.4f}" in table for shown in comparison.restitution[0])
    assert f"{comparison.rms:.5f}" in table
    assert len({len(line) for line in table.splitlines()[2:6]}) == 1
    assert max(map(len, table.splitlines())) <= 80


def test_more_impacts_than_the_other_are_shown_as_missing(one_sided, contacts, e):
    comparison = mr.compare(mr.solve_analytical(one_sided, e), mr.simulate(one_sided, contacts, 1e-3))
    assert math.isnan(comparison.rows()[-1]["impact time, MuJoCo [s]"])
    assert "nan" not in comparison.table(most=50)
    assert comparison.table(most=-1) == comparison.table(most=0)


def test_different_cases_are_not_compared(two_sided, one_sided, e):
    with pytest.raises(ValueError, match="different cases"):
        mr.compare(mr.solve_analytical(two_sided, e), mr.solve_analytical(one_sided, e))


def test_restitution_under_ground_motion_is_said_to_be_that_of_impacts(wall, contacts, e, comparison):
    case = mr.Case(wall, 0.0, 2.0, motion=mr.GroundMotion.sine(-3.0, 0.6))
    shaken = mr.compare(mr.solve_analytical(case, e), mr.simulate(case, contacts))
    message = "Under ground motion the restitution is that of single impacts, and none of free rocking."
    assert message in shaken.table().replace("\n", " ")
    assert "|e| of impact 1 under ground motion" in repr(shaken)
    still = mr.Case(wall, 0.0, 0.1, motion=mr.GroundMotion.sine(-3.0, 0.6))
    assert "|e| of impact 1 under ground motion none for none, RMS" in repr(
        mr.compare(mr.solve_analytical(still, e), mr.simulate(still, contacts))
    )
    assert message not in comparison.table()
    assert "|e| of rebound 1 " in repr(comparison)
