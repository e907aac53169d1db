"""The law of a joint, for numbers and for arrays, and that all who need it take it from one place."""

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.masonry.laws import joint_law
from mjrock.problem.masonry.laws.joint_law import (
    Law,
    law_rows,
    normal_force,
    resting,
    shear_limit,
    stored,
    stored_along,
)

LAW = Law(k=100.0, c=2.0, k_s=50.0, friction=0.6)


@pytest.mark.parametrize(
    ("gap", "rate", "force"),
    [(-0.1, 0.0, 10.0), (-0.1, -1.0, 12.0), (-0.1, 1.0, 8.0), (-0.1, 6.0, 0.0), (0.1, -60.0, 0.0), (0.0, -1.0, 0.0)],
)
def test_a_joint_pushes_and_never_pulls(gap, rate, force):
    assert normal_force(LAW, gap, rate) == pytest.approx(force)


def test_a_law_without_numbers_holds_and_stores_nothing():
    assert set(Law()) == {0.0}


def test_arrays_and_numbers_have_one_law():
    gaps = np.array([-0.1, 0.1, -0.2])
    force, energy = resting(law_rows(3, k=LAW.k), gaps, np.zeros(3, dtype=bool))
    np.testing.assert_allclose(force, [normal_force(LAW, gap, 0.0) for gap in gaps])
    np.testing.assert_allclose(energy, [stored(LAW, gap) for gap in gaps])


def test_a_bonded_contact_at_rest_is_a_spring_both_ways():
    force, energy = resting(law_rows(2, k=LAW.k), np.array([0.1, -0.1]), np.array([True, True]))
    np.testing.assert_allclose(force, [-10.0, 10.0])
    np.testing.assert_allclose(energy, [0.5, 0.5])


def test_the_force_is_the_slope_of_what_is_stored():
    for gap in (-0.3, -0.01, 0.2):
        slope = (stored(LAW, gap + 1e-6) - stored(LAW, gap - 1e-6)) / 2e-6
        assert -slope == pytest.approx(normal_force(LAW, gap, 0.0), abs=1e-6)
    assert stored_along(LAW, 0.2**2) == pytest.approx(0.5 * 50 * 0.2**2)


def test_limit_analysis_has_the_friction_of_the_law(monkeypatch):
    block = mr.Masonry.stack([mr.Block(0.5, 0.5)], k_n=1e9, friction=0.3)
    assert mr.collapse_multiplier(block).multiplier == pytest.approx(0.3, rel=1e-6)
    half = lambda row, push: 0.5 * row.friction * push  # noqa: E731
    monkeypatch.setattr("mjrock.problem.masonry.limit.statics.shear_limit", half)
    assert mr.collapse_multiplier(block).multiplier == pytest.approx(0.15, rel=1e-6)
    assert shear_limit is joint_law.shear_limit
    assert shear_limit(LAW, 10.0) == pytest.approx(6.0)
