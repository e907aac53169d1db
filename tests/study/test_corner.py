"""A corner of two walls that overturns, against its closed form by limit analysis and by two solvers."""

import math

import numpy as np
import pytest

import mjrock as mr

OUT = -math.pi / 4


def by_hand(t, h, angle):
    """Moments of the weights and of the horizontal forces about the outer edge."""
    p = h * math.tan(angle)
    weights = np.array([t * t * h, t * p * h])
    behind = np.array([t, 1.5 * t + p / 3]) / math.sqrt(2)
    return weights @ behind / (weights @ [h / 2, 2 * h / 3])


@pytest.mark.parametrize(("t", "h", "angle"), [(0.5, 4.0, 30), (0.6, 3.0, 0), (0.4, 5.0, 12), (1.5, 12.0, 30)])
def test_limit_analysis_finds_the_closed_form(t, h, angle):
    corner = mr.Masonry.corner(t, h, math.radians(angle))
    found = mr.collapse_multiplier(corner, angle=OUT)
    assert found.multiplier == pytest.approx(by_hand(t, h, math.radians(angle)), rel=1e-6)
    assert corner.names[1] == "corner"
    assert [corner.names[i] for i in corner.free] == ["corner"]


def test_size_plays_no_part_and_the_push_along_a_wall_is_the_worst():
    """Across one wall the corner turns about its outer face, and the diagonal has sqrt(2) times that multiplier."""
    small, large = (mr.Masonry.corner(size * 0.5, size * 4.0, 0.4) for size in (1, 3))
    one, other = (mr.collapse_multiplier(corner, angle=OUT).multiplier for corner in (small, large))
    assert other == pytest.approx(one, rel=1e-9)
    across = [mr.collapse_multiplier(small, angle=angle).multiplier for angle in (-math.pi / 2, 0.0)]
    assert across == pytest.approx([one / math.sqrt(2)] * 2, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("solve", [mr.solve_explicit, mr.simulate])
def test_it_stands_a_slow_push_below_the_multiplier_and_falls_above(solve):
    """The push grows over 2 s and stays, at 0.93 and 1.05 times the multiplier of rigid bodies."""
    corner = mr.Masonry.corner(0.5, 4.0, 0.3, k_n=3e9)
    grown = by_hand(0.5, 4.0, 0.3) * mr.GRAVITY / math.sqrt(2) * np.minimum(np.linspace(0.0, 2.0, 401), 1.0)
    turned = []
    for share in (0.93, 1.05):
        ways = [mr.GroundMotion(sign * share * grown, 0.01) for sign in (-1, 1)]
        run = solve(mr.MasonryCase(corner, 4.0, motion=ways[0], transverse=ways[1]))
        turned.append(float(np.abs(run.pose[-1, 0, :2]).max()))
    assert turned[0] < 0.05
    assert turned[1] > 0.2


@pytest.mark.slow
def test_a_push_along_the_diagonal_ends_in_the_blows_that_it_comes_to():
    """It stands on one corner of its base, from which it leaves the diagonal and strikes what stays of the walls."""
    with pytest.warns(UserWarning, match="the push was not slow"):
        push = mr.push(mr.Masonry.corner(0.5, 4.0, math.radians(30)), None, 0.4, angle=OUT)
    assert push.peak == pytest.approx(by_hand(0.5, 4.0, math.radians(30)), rel=2e-3)
    assert push.ended.startswith("ends in blows at")
    assert 0.1 < push.displacement[-1] < 0.25


@pytest.mark.parametrize(
    ("given", "message"),
    [((0.005, 4.0), "thickness = 0.005"), ((0.5, 400.0), "height = 400"), ((0.5, 4.0, 1.5), "angle = 1.5")],
)
def test_refused(given, message):
    with pytest.raises(ValueError, match=message):
        mr.Masonry.corner(*given)
