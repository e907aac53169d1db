"""The closed forms of classical rocking (Housner), to the digits known independently of this code."""

import math

import numpy as np
import pytest

import mjrock as mr
from mjrock import Outcome


def amplitudes(wall, theta0, e, count):
    """cos(alpha - theta_n) - cos(alpha) = e^(2n) [cos(alpha - theta0) - cos(alpha)]."""
    drop = math.cos(wall.alpha - theta0) - math.cos(wall.alpha)
    return [wall.alpha - math.acos(math.cos(wall.alpha) + e ** (2 * n) * drop) for n in range(count)]


def test_two_sided_amplitudes(two_sided, e):
    response = mr.solve_analytical(two_sided, e)
    alpha = two_sided.block.alpha
    np.testing.assert_allclose(response.peaks[1:4] / alpha, [0.457531, 0.420401, 0.387514], atol=5e-7)
    expected = amplitudes(two_sided.block, two_sided.theta0, e.base, len(response.peaks))
    np.testing.assert_allclose(response.peaks, expected, rtol=1e-9)


def test_one_sided_amplitudes_and_impact_times(one_sided, e):
    response = mr.solve_analytical(one_sided, e)
    alpha = one_sided.block.alpha
    np.testing.assert_allclose(response.peaks[1:4] / alpha, [0.076322, 0.014464, 0.002812], atol=5e-7)
    np.testing.assert_allclose([i.t for i in response.impacts[:3]], [0.70757, 1.14182, 1.32588], atol=5e-6)
    assert response.theta.min() >= -1e-12


def test_quarter_period_and_impact_speed(two_sided, e):
    first = mr.solve_analytical(two_sided, e).impacts[0]
    assert first.t == pytest.approx(0.707565, abs=5e-7)
    assert first.omega_before == pytest.approx(-0.228618, abs=5e-7)


def test_slender_quarter_period(e):
    slender = mr.Block(b=0.02, h=2.0)
    case = mr.Case(slender, 0.5 * slender.alpha, 3.0, side_stop=False)
    first = mr.solve_analytical(case, e).impacts[0]
    assert first.t == pytest.approx(math.acosh(1 / (1 - 0.5)) / slender.p, rel=2e-5)


@pytest.mark.parametrize("side_stop", [True, False])
def test_each_impact_keeps_e_squared_of_the_energy(wall, e, side_stop):
    response = mr.solve_analytical(mr.Case(wall, 0.5 * wall.alpha, 6.0, side_stop=side_stop), e)
    kept = e.lumped**2 if side_stop else e.base**2
    for impact in response.impacts:
        assert impact.energy_after / impact.energy_before == pytest.approx(kept, abs=1e-9)
    for before, after in zip(response.impacts[:-1], response.impacts[1:], strict=True):
        assert after.energy_before == pytest.approx(before.energy_after, rel=1e-7)


def test_energy_is_constant_between_impacts(two_sided, e):
    response = mr.solve_analytical(two_sided, e)
    before = response.t < response.impacts[0].t
    np.testing.assert_allclose(response.energy[before], two_sided.release_energy, rtol=1e-9)


def test_alpha_as_printed_in_the_paper_fails(wall):
    """The twin that must fail: with alpha = arctan(h/b) there is no coefficient of restitution at all."""
    with pytest.raises(ValueError, match="valid range"):
        mr.Restitution.from_geometry(math.pi / 2 - wall.alpha)


def test_tolerances_govern_the_error(two_sided, e):
    exact = 0.7075650625339
    errors = [abs(mr.solve_analytical(two_sided, e, rtol=r).impacts[0].t - exact) for r in (1e-4, 1e-7, 1e-11)]
    assert errors[0] > errors[2]
    assert errors[2] < 1e-10


def test_impacts_accumulate_to_rest(one_sided, e):
    response = mr.solve_analytical(one_sided, e)
    assert response.outcome is Outcome.AT_REST
    assert 5 < len(response.impacts) < 40
    assert response.theta[-1] == 0
    assert response.t[-1] == one_sided.duration


@pytest.mark.parametrize(("share", "outcome"), [(0.999, Outcome.AT_REST), (1.001, Outcome.OVERTURNED)])
def test_alpha_divides_standing_from_falling(wall, e, share, outcome):
    response = mr.solve_analytical(mr.Case(wall, share * wall.alpha, 10.0), e)
    assert response.outcome is outcome
    if outcome is Outcome.OVERTURNED:
        assert response.theta[-1] == pytest.approx(math.pi / 2)
        assert "overturned" in response.message


def test_time_may_end_first(two_sided, e):
    response = mr.solve_analytical(two_sided, e)
    assert response.outcome is Outcome.TIME_ENDED
    assert response.t[-1] == 6.0


@pytest.mark.parametrize("omega0", [0.1, -0.1])
def test_a_push_is_a_fall_from_the_same_energy(wall, e, omega0):
    pushed = mr.Case(wall, 0.05, 5.0, omega0=omega0)
    response = mr.solve_analytical(pushed, e)
    assert response.peaks[0] == pytest.approx(pushed.release_peak, rel=1e-8)
    assert response.impacts[0].energy_before == pytest.approx(pushed.release_energy, rel=1e-8)


def test_a_push_beyond_the_barrier_overturns(wall, e):
    response = mr.solve_analytical(mr.Case(wall, 0.05, 5.0, omega0=0.5), e)
    assert response.outcome is Outcome.OVERTURNED


def test_a_wall_left_alone_stays(wall, e):
    response = mr.solve_analytical(mr.Case(wall, 0.0, 1.0), e)
    assert response.outcome is Outcome.AT_REST
    assert not response.theta.any()


def test_a_tiny_release_still_rocks(wall, e):
    response = mr.solve_analytical(mr.Case(wall, 1e-6 * wall.alpha, 1.0), e)
    assert response.impacts[0].restitution == pytest.approx(abs(e.lumped))
    assert response.outcome is Outcome.AT_REST


def test_leaning_the_other_way_is_the_mirror_image(wall, e):
    left, right = (mr.solve_analytical(mr.Case(wall, s * 0.05, 4.0, side_stop=False), e) for s in (-1, 1))
    np.testing.assert_array_equal(left.theta, -right.theta)


@pytest.mark.parametrize("values", [{"rtol": 0}, {"output_step": math.nan}, {"rest": 0}])
def test_bad_tolerances(two_sided, e, values):
    with pytest.raises(ValueError, match="outside the valid range"):
        mr.solve_analytical(two_sided, e, **values)


def test_a_wall_that_would_go_through_the_stop(one_sided):
    with pytest.raises(ValueError, match=r"lumped restitution = 0\.405"):
        mr.solve_analytical(one_sided, mr.Restitution(0.9, 0.5))


def test_what_a_campaign_does_not_read_is_not_computed(one_sided, e):
    """Peaks, impacts and rotations take no pose; pose and velocity are then those of the wall about its toes."""
    answer = mr.solve_analytical(one_sided, e)
    assert answer.peak_over_alpha < 1
    assert len(answer.restitution)
    assert answer.theta.shape == answer.t.shape
    assert not {"pose", "velocity", "energy"} & set(vars(answer.motion))
    np.testing.assert_array_equal(answer.pose[:, 0], one_sided.wall.pose(answer.theta))
    np.testing.assert_allclose(
        np.gradient(answer.pose[:, 0, 0], answer.t)[5:50], answer.velocity[5:50, 0, 0], rtol=1e-3
    )
