"""Rocking over a shaken base in the analytical solver: against SciPy's integrator, closed forms and identities."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import mjrock as mr
from mjrock import GroundMotion, Outcome


def eq_1(wall, motion, s):
    def rates(t, y):
        tilt, share = s * wall.alpha - y[0], float(motion(t)) / mr.GRAVITY
        return y[1], -(wall.p**2) * (math.sin(tilt) + share * math.cos(tilt))

    return rates


@pytest.fixture(scope="module")
def jagged():
    """A motion of many kinks whose pieces do not divide any step."""
    return GroundMotion(np.random.default_rng(3).normal(0, 1.5, 150), 0.013)


def test_a_released_wall_follows_eq_1(wall, e, jagged):
    """Up to the first impact, against SciPy with its steps ended at every sample."""
    case = mr.Case(wall, 0.6 * wall.alpha, 3.0, motion=jagged)
    response = mr.solve_analytical(case, e)
    first = response.impacts[0]
    assert first.t > 0.3
    y, t = np.array([case.theta0, 0.0]), 0.0
    while t < first.t:
        end = min(first.t, jagged.dt * (math.floor(t / jagged.dt + 1e-6) + 1))
        y = solve_ivp(eq_1(wall, jagged, 1), (t, end), y, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
        t = end
    assert y[0] == pytest.approx(0.0, abs=1e-8 * wall.alpha)
    assert first.omega_before == pytest.approx(y[1], rel=1e-8)


def test_tolerance_governs_the_steps(wall, e, jagged):
    case = mr.Case(wall, 0.6 * wall.alpha, 0.4, motion=jagged)
    runs = [mr.solve_analytical(case, e, rtol=r) for r in (1e-14, 1e-10, 1e-8)]
    errors = [abs(run.theta[-1] - runs[0].theta[-1]) for run in runs[1:]]
    assert errors[0] < 1e-10 < errors[1] < 1e-8
    assert runs[0].stats["evaluations"] > 2 * runs[2].stats["evaluations"]


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_uplift_from_rest(wall, e, share):
    """A wall at rest is lifted when |a_g| > g tan(alpha), at the very time."""
    peak = share * mr.GRAVITY * math.tan(wall.alpha)
    ramp = GroundMotion([0.0, -peak, 0.0], 0.5)
    response = mr.solve_analytical(mr.Case(wall, 0.0, 2.0, motion=ramp), e)
    assert bool(response.theta.max() > 0) is (share > 1)
    if share > 1:
        lifted = response.t[np.flatnonzero(response.theta > 0)[0]]
        assert lifted == pytest.approx(0.5 / share, abs=2e-3)
        assert response.outcome is Outcome.AT_REST


def test_polarity(wall, e):
    """A one-sided wall is lifted by one polarity, a two-sided one by both, each to its side."""
    pulse = GroundMotion.half_sine(-3.0, 0.4)
    peaks = {
        (m, sides): mr.solve_analytical(mr.Case(wall, 0.0, 0.6, side_stop=sides, motion=motion), e).theta
        for m, motion in enumerate(pulse.polarities)
        for sides in (True, False)
    }
    assert peaks[0, True].max() > 0.01
    assert not peaks[1, True].any()
    np.testing.assert_allclose(peaks[1, False], -peaks[0, False], atol=1e-12)


def test_rest_between_bursts(wall, e):
    """The second of two equal bursts, far apart, finds the wall at rest and moves it as the first did."""
    burst = GroundMotion.sine(-2.4, 0.5, samples=100)
    gap = np.zeros(round(4.0 / burst.dt))
    twice = GroundMotion(np.concatenate([burst.accel, gap, burst.accel]), burst.dt)
    response = mr.solve_analytical(mr.Case(wall, 0.0, 9.0, motion=twice), e)
    late = response.t > 4.5
    assert response.theta[~late].max() > 1e-3
    assert response.theta[late].max() == pytest.approx(response.theta[~late].max(), rel=1e-4)
    between = (response.t > 3.5) & (response.t < 4.4)
    assert not response.theta[between].any()


def test_after_the_record_there_is_quiet(wall, e):
    motion = GroundMotion.half_sine(-2.6, 0.4)
    response = mr.solve_analytical(mr.Case(wall, 0.0, 6.0, motion=motion), e)
    free = (response.t > 0.41) & (response.t < response.impacts[0].t - 1e-3)
    np.testing.assert_allclose(response.energy[free], response.energy[free][0], rtol=1e-6)
    kept = [i.restitution for i in response.impacts]
    np.testing.assert_allclose(kept, abs(e.lumped), rtol=1e-9)
    np.testing.assert_array_equal(response.restitution, kept)


def test_an_earthquake_of_either_polarity_ends_well(wall, e):
    """No seed of a synthetic record stalls, goes through the stop, or leaves the time it was given."""
    for seed in range(12):
        motion = GroundMotion.synthetic(4.0, 8.0, seed=seed)
        for polarity in motion.polarities:
            for side_stop in (True, False):
                case = mr.Case(wall, 0.0, 12.0, side_stop=side_stop, motion=polarity)
                response = mr.solve_analytical(case, e)
                assert np.isfinite(response.theta).all()
                assert response.t[-1] <= 12.0
                if side_stop:
                    assert response.theta.min() >= -1e-9


def test_every_maximum_is_a_peak(wall, e):
    """Also the first after uplift from rest, and the one after a minimum in the air."""
    for seed in range(6):
        motion = GroundMotion.synthetic(4.0, 6.0, seed=seed)
        response = mr.solve_analytical(mr.Case(wall, 0.0, 8.0, side_stop=False, motion=motion), e, output_step=1e-3)
        theta = np.abs(response.theta)
        tops = theta[1:-1][(theta[1:-1] > theta[:-2]) & (theta[1:-1] > theta[2:])]
        large = 1e-3 * wall.alpha
        assert len(tops[tops > large]) == np.count_nonzero(response.peaks > large)
        np.testing.assert_allclose(
            np.sort(tops[tops > large]), np.sort(response.peaks[response.peaks > large]), rtol=1e-3
        )
