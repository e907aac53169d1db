"""Horizontal bending between side walls: closed form, limit analysis, the check by hand, and runs about the
multiplier."""

import math

import numpy as np
import pytest

import mjrock as mr

WALL = mr.Block.from_size(0.5, 2.0, 6.0, 1800.0)
THRUST = 12e3


def by_hand(wall, thrust, first):
    """Virtual work of a unit displacement of the crack: both ends of length a turn by 1 / a, and spread by t / a."""
    t, other = 2 * wall.b, wall.length - first
    return thrust * (t / first + t / other) / (wall.weight * 0.5)


@pytest.mark.parametrize("crack", [None, 2.0, 5.0])
def test_virtual_work_and_limit_analysis(crack):
    bending = mr.HorizontalBending(WALL, THRUST, crack)
    hand = by_hand(WALL, THRUST, crack or 3.0)
    assert bending.multiplier == pytest.approx(hand, rel=1e-12)
    assert bending.curve.multiplier[0] == pytest.approx(hand, rel=1e-12)
    masonry = mr.Masonry.between_sides(bending, friction=1.02 * bending.friction)
    found = mr.collapse_multiplier(masonry, effects=bending.tie)
    assert found.multiplier == pytest.approx(hand, rel=1e-6)
    assert found.moving == ("left", "right", "side_0", "side_1")
    assert found.pulls == pytest.approx([THRUST])
    assert np.abs(found.forces.shear[4:7] / found.forces.normal[4:7, None]).max() <= 1.03 * bending.friction


def test_the_crack_in_the_middle_has_the_least_multiplier():
    assert mr.HorizontalBending(WALL, THRUST).multiplier == pytest.approx(8 * THRUST * 0.5 / (WALL.weight * 6.0))
    least = min(mr.HorizontalBending(WALL, THRUST, a).multiplier for a in (2.0, 2.9, 3.1, 4.0))
    assert mr.HorizontalBending(WALL, THRUST).multiplier < least


def test_with_less_friction_it_slides_before_it_bends():
    """The ends hold half of the push each, alpha W / 2, with friction times the thrust."""
    bending = mr.HorizontalBending(WALL, THRUST)
    assert bending.friction == pytest.approx(0.5 * bending.multiplier * WALL.weight / THRUST)
    masonry = mr.Masonry.between_sides(bending, friction=0.8 * bending.friction)
    assert mr.collapse_multiplier(masonry, effects=bending.tie).multiplier < 0.99 * bending.multiplier


@pytest.mark.parametrize("crack", [None, 2.0])
def test_the_work_of_the_curve_is_that_on_the_thrust(crack):
    """At the end of the curve the arch is flat: each body lies along its diagonal."""
    bending = mr.HorizontalBending(WALL, THRUST, crack)
    curve = bending.curve
    spread = sum(math.hypot(0.5, part) for part in bending.parts) - 6.0
    work = WALL.weight * np.trapezoid(curve.multiplier, curve.displacement)
    assert work == pytest.approx(THRUST * spread, rel=1e-5)


@pytest.mark.parametrize("crack", [None, 2.0])
def test_the_curve_is_that_of_blocks_by_limit_analysis(crack):
    """In poses that have turned about upright axes, the sides as far apart as the arch pushes them."""
    bending = mr.HorizontalBending(WALL, THRUST, crack)
    masonry = mr.Masonry.between_sides(bending, friction=2.0)
    t = 0.5
    for rise in (0.45, 0.3, 0.1):
        poses, spreads = [], []
        for sign, part in zip((-1.0, 1.0), bending.parts, strict=True):
            theta = math.atan2(t, part) - math.asin(rise / math.hypot(t, part))
            spread = math.sqrt(t**2 + part**2 - rise**2) - part
            # the body turns about its outer edge (t, end), which moves outwards by the spread
            sine, cosine = math.sin(sign * theta), math.cos(theta)
            x, y = -t / 2, -sign * part / 2
            moved = x * (cosine - 1) - y * sine, x * sine + y * (cosine - 1) + sign * spread
            poses.append([*moved, 0.0, math.cos(theta / 2), 0.0, 0.0, math.sin(sign * theta / 2)])
            spreads.append([0.0, sign * spread, 0.0, 1.0, 0.0, 0.0, 0.0])
        found = mr.collapse_multiplier(masonry, effects=bending.tie, pose=[*poses, *spreads]).multiplier
        curve = bending.curve
        moved = np.array([pose[0] for pose in poses]) @ bending.parts / 6.0
        assert found == pytest.approx(np.interp(moved, curve.displacement, curve.multiplier), rel=1e-4)


def test_the_steps_of_the_check():
    bending = mr.HorizontalBending(WALL, THRUST)
    found = mr.mechanism_check(bending, lambda T, xi: 0.02, confidence_factor=1.2)
    assert found.participation == 1.0
    assert found.a_0 == pytest.approx(bending.multiplier * mr.GRAVITY / 1.2)
    # half a body along its diagonal, from where the middle of the wall was
    assert found.d_0 == pytest.approx(0.25, rel=1e-6)
    assert found.states["SLV"].capacity == pytest.approx(0.1, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("solve", [mr.solve_explicit, mr.simulate])
def test_it_stands_a_slow_push_below_the_multiplier_and_falls_above(solve):
    """The push grows over 2 s and stays, at 0.93 and 1.07 times the multiplier of rigid bodies."""
    bending = mr.HorizontalBending(WALL, THRUST)
    masonry = mr.Masonry.between_sides(bending, k_n=1e9, xi=0.1, frequency=100.0)
    grown = -bending.multiplier * mr.GRAVITY * np.minimum(np.linspace(0.0, 2.0, 301), 1.0)
    moved = []
    for share in (0.93, 1.07):
        case = mr.MasonryCase(masonry, 4.0, motion=mr.GroundMotion(share * grown, 0.01), effects=bending.tie)
        moved.append(float(np.abs(solve(case).pose[-1, :2, 0]).max()))
    assert moved[0] < 0.01
    assert moved[1] > 0.1


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ((WALL, 0.0), "thrust of the side walls = 0"),
        ((WALL, 1e4, 6.0), "crack = 6"),
        ((3, 1e4), "wall = 3 of type int"),
    ],
)
def test_refused(given, message):
    with pytest.raises((TypeError, ValueError), match=message):
        mr.HorizontalBending(*given)


def test_a_strip_that_would_slide_is_warned_of():
    with pytest.warns(mr.Implausible, match=r"slides before it bends unless friction .* is 0\.8; 0\.4"):
        mr.HorizontalBending(mr.Block.from_size(0.6, 2.0, 3.0), 12e3)
