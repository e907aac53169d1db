"""Overturning by pulses: closed forms of a slender rigid block, in the analytical solver and in MuJoCo."""

import math

import pytest

import mjrock as mr
from mjrock import GroundMotion, Outcome

SLENDER = mr.Block(b=0.06, h=3.0)
RECTANGULAR = {0.5: 2.54149, 1.0: 1.58198, 2.0: 1.15652, 3.0: 1.05240}
"""p t_d and the least A = a_p / (g tan alpha), A = 1 / (1 - exp(-p t_d))."""
HALF_SINE = {2: 1.80072, 4: 2.79080, 6: 3.78816}
"""Omega = omega_p / p, and the root of sqrt(A^2 - 1) + A exp(-(pi - asin(1/A)) / Omega) = Omega."""


def threshold(wall, motion, overturns, low, high, tolerance=2e-5):
    """The least A at which motion(A) overturns the wall, by bisection between two that do not and do."""
    unit = mr.GRAVITY * math.tan(wall.alpha)
    assert not overturns(motion(low * unit))
    assert overturns(motion(high * unit))
    while high / low - 1 > tolerance:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if overturns(motion(middle * unit)) else (middle, high)
    return math.sqrt(low * high)


def analytical(wall, side_stop=True):
    e = mr.Restitution.from_geometry(wall.alpha)
    duration = 12 / wall.p

    def overturns(motion):
        case = mr.Case(wall, 0.0, duration, side_stop=side_stop, motion=motion)
        return mr.solve_analytical(case, e, output_step=duration).outcome is Outcome.OVERTURNED

    return overturns


def in_mujoco(wall, k_n):
    e = mr.Restitution.from_geometry(wall.alpha)
    contacts = mr.Contacts.from_law(wall, e, k_base=k_n, k_side=k_n)

    def overturns(motion):
        case = mr.Case(wall, 0.0, 8 / wall.p, motion=motion)
        return mr.simulate(case, contacts).outcome is Outcome.OVERTURNED

    return overturns


def rectangular(wall, duration):
    return lambda amplitude: GroundMotion.rectangular(-amplitude, duration / wall.p)


def half_sine(wall, frequency):
    return lambda amplitude: GroundMotion.half_sine(-amplitude, math.pi / (frequency * wall.p))


@pytest.mark.parametrize(("duration", "expected"), RECTANGULAR.items())
def test_rectangular_pulse(duration, expected):
    found = threshold(SLENDER, rectangular(SLENDER, duration), analytical(SLENDER), 0.8 * expected, 1.2 * expected)
    assert found == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(("frequency", "expected"), HALF_SINE.items())
def test_half_sine_pulse(frequency, expected):
    found = threshold(SLENDER, half_sine(SLENDER, frequency), analytical(SLENDER), 0.8 * expected, 1.2 * expected)
    assert found == pytest.approx(expected, rel=1e-3)


def test_a_stocky_wall_is_not_a_slender_one():
    """The twin that must fail: at h/b 1.5 the closed form of slender blocks is out by more than its tolerance."""
    wall = mr.Block(b=1.0, h=1.5)
    found = threshold(wall, half_sine(wall, 4), analytical(wall), 2.4, 3.4)
    assert abs(found / HALF_SINE[4] - 1) > 5e-3


@pytest.mark.parametrize("frequency", [2, 3])
def test_outward_first_full_sine(frequency):
    """One-sided, outward first: until it meets the base the wall does not know what is behind it."""

    def pulse(amplitude):
        return GroundMotion.sine(-amplitude, 2 * math.pi / (frequency * SLENDER.p))

    one, two = (threshold(SLENDER, pulse, without_impact(side), 1.05, 8.0, 1e-4) for side in (True, False))
    assert one == pytest.approx(two, rel=1e-2)


def without_impact(side_stop):
    """Whether the wall overturns before it has met its base once."""
    e = mr.Restitution.from_geometry(SLENDER.alpha)

    def overturns(motion):
        case = mr.Case(SLENDER, 0.0, 20 / SLENDER.p, side_stop=side_stop, motion=motion)
        response = mr.solve_analytical(case, e, output_step=1.0)
        return response.outcome is Outcome.OVERTURNED and not response.impacts

    return overturns


@pytest.mark.parametrize(("frequency", "expected"), HALF_SINE.items())
def test_inward_first_full_sine(frequency, expected):
    """One-sided, inward first: the first half presses the wall against its stop, the second is a half sine."""

    def pulse(amplitude):
        return GroundMotion.sine(amplitude, 2 * math.pi / (frequency * SLENDER.p))

    found = threshold(SLENDER, pulse, analytical(SLENDER), 0.8 * expected, 1.2 * expected)
    assert found == pytest.approx(expected, rel=1e-2)


@pytest.mark.parametrize("make", [rectangular, half_sine])
def test_mujoco_on_a_stiff_base(wall, make):
    """The paper's wall on 3e9 N/m3, against the rigid wall: within 2 %, and never above it.

    A base that yields lets a pulse do work before the edge lifts, which overturns the wall a little earlier.
    """
    parameter, about = (1.0, 1.58198) if make is rectangular else (2, 1.80072)
    found, rigid = (
        threshold(wall, make(wall, parameter), overturns, 0.9 * about, 1.1 * about, 5e-4)
        for overturns in (in_mujoco(wall, 3e9), analytical(wall))
    )
    assert 0.98 < found / rigid < 1.0


def test_the_difference_is_the_yielding_of_the_base():
    """It falls with the root of uplift rotation over alpha: h/b 50 feels 3e9 N/m3 as h/b 7 feels 6e7."""
    expected = HALF_SINE[6]
    missing = []
    for k_n in (3e9, 3e11):
        found = threshold(
            SLENDER, half_sine(SLENDER, 6), in_mujoco(SLENDER, k_n), 0.7 * expected, 1.05 * expected, 5e-4
        )
        missing.append(1 - found / expected)
    assert missing[0] > 0.1
    assert missing[1] == pytest.approx(missing[0] / 10, rel=0.3)
