"""Response and rocking spectra, motions scaled to them, and displacements at a height."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import mjrock as mr

RECORD = mr.GroundMotion.synthetic(3.0, 6.0, seed=1, dt=0.02)


@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_an_oscillator_is_that_of_its_equation(damping):
    T = 0.7
    omega = 2 * math.pi / T

    def rate(t, y):
        return [y[1], -2 * damping * omega * y[1] - omega**2 * y[0] - float(RECORD(t))]

    found = solve_ivp(rate, (0, 6 + T), [0, 0], max_step=0.01, rtol=1e-8)
    spectrum = mr.response_spectrum(RECORD, T, damping)
    assert spectrum.Sd[0] == pytest.approx(np.abs(found.y[0]).max(), rel=5e-3)
    assert spectrum.Sa[0] == pytest.approx(omega**2 * spectrum.Sd[0])
    assert spectrum.Sv[0] == pytest.approx(omega * spectrum.Sd[0])


def test_the_ends_of_a_spectrum():
    stiff = mr.response_spectrum(RECORD, [0.01]).Sa[0]
    assert stiff == pytest.approx(RECORD.peak, rel=0.01)
    wave = mr.GroundMotion.sine(1.0, 0.5, cycles=60)
    assert mr.response_spectrum(wave, 0.5, 0.05).Sa[0] == pytest.approx(1 / (2 * 0.05), rel=0.01)  # resonance


def test_scaled_to_a_spectrum():
    assert mr.response_spectrum(mr.scaled_to_sa(RECORD, 0.5, 2.5), 0.5).Sa[0] == pytest.approx(2.5)
    periods = [0.2, 0.5, 1.0]
    target = np.array([4.0, 3.0, 1.0])
    made = mr.response_spectrum(mr.scaled_to_spectrum(RECORD, periods, target), periods)
    assert np.log(made.Sa / target).mean() == pytest.approx(0.0, abs=1e-9)
    assert made.mean == pytest.approx(12.0 ** (1 / 3))


def test_the_displacement_of_a_rigid_wall_at_a_height(wall, e):
    answer = mr.solve_analytical(mr.Case(wall, 0.5 * wall.alpha, 0.5), e)
    theta = answer.theta
    for z in (0.0, 1.0, 2 * wall.h):
        exact = wall.b * (1 - np.cos(theta)) + z * np.sin(theta)
        np.testing.assert_allclose(answer.displacement(z), exact, atol=1e-12)
    with pytest.raises(ValueError, match=r"height z = 9 m is outside the valid range 0 to 4.2"):
        answer.displacement(9.0)


def test_larger_walls_rotate_less():
    pulse = mr.GroundMotion.half_sine(-4.0, 0.5)
    found = mr.rocking_spectrum(pulse, [0.5, 2.0, 8.0], 7.0, rtol=1e-6)
    assert found.peak[0] == math.inf
    assert found.peak[1] > found.peak[2] > 0
    assert found.period[2] == pytest.approx(4 * found.period[0])


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: mr.response_spectrum(RECORD, [0.0]), "periods = 0 s is outside the valid range 0.01 to 100 s"),
        (lambda: mr.response_spectrum(RECORD, "1"), r"periods = '1' of type str .* takes one value \[s\] or a row"),
        (lambda: mr.response_spectrum(RECORD, []), r"a row of at least one value \[s\] is needed"),
        (lambda: mr.response_spectrum(RECORD, [1.0], 5), "damping = 5 is outside the valid range 0 to 0.9"),
        (lambda: mr.scaled_to_spectrum(RECORD, [1.0], [1.0, 2.0]), "target has 2 values and periods 1"),
        (lambda: mr.scaled_to_sa(mr.GroundMotion([0, 0], 0.1), 1.0, 1.0), "motion is at rest"),
    ],
)
def test_what_cannot_be(call, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        call()
