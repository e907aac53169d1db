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


CORNERS = [(0.5, 4.0, 30), (0.6, 3.0, 0), (0.4, 5.0, 12)]
DIAGONAL = np.array([1.0, -1.0]) / math.sqrt(2)


def as_wall(t, h, angle, **changed):
    """A corner as a case of a wall."""
    corner = mr.Corner(t, h, math.radians(angle))
    return mr.Case(corner.block, **{"theta0": 0.0, "duration": 3.0} | changed, effects=corner.masses)


@pytest.mark.parametrize(("t", "h", "angle"), CORNERS)
def test_as_a_wall_it_has_mass_centroid_and_moment_of_inertia_of_the_blocks(t, h, angle):
    wall, body = as_wall(t, h, angle).wall, mr.Masonry.corner(t, h, math.radians(angle)).blocks[1]
    across = np.array([1.0, 1.0, 0.0]) / math.sqrt(2)
    assert wall.mass == pytest.approx(body.mass)
    assert wall.lever == pytest.approx(-body.centroid[:2] @ DIAGONAL)
    assert wall.centroid_height == pytest.approx(body.centroid[2])
    assert wall.inertia == pytest.approx(across @ body.inertia @ across)


@pytest.mark.parametrize(("t", "h", "angle"), CORNERS)
def test_the_check_by_hand(t, h, angle):
    """alpha_0 by moments, e* of post and wedges, and d_0 where the weights stand over the outer edge, C8.7.1.4."""
    p = h * math.tan(math.radians(angle))
    weights, heights = np.array([t * t * h, t * p * h]), np.array([h / 2, 2 * h / 3])
    levers = np.array([t, 1.5 * t + p / 3]) / math.sqrt(2)
    found = mr.mechanism_check(as_wall(t, h, angle), lambda T, xi: 0.1, confidence_factor=1.2)
    assert found.alpha_0 == pytest.approx(by_hand(t, h, math.radians(angle)), rel=1e-12)
    corner = mr.Corner(t, h, math.radians(angle))
    assert corner.multiplier == pytest.approx(found.alpha_0, rel=1e-12)
    assert mr.mechanism_check(corner, lambda T, xi: 0.1, confidence_factor=1.2).d_0 == found.d_0
    share = (weights @ heights) ** 2 / (weights.sum() * (weights @ heights**2))
    assert found.participation == pytest.approx(share)
    assert found.linear == pytest.approx(2 * found.alpha_0 * mr.GRAVITY / (share * 1.2))
    assert found.d_0 == pytest.approx(weights @ levers / weights.sum() / share, rel=1e-3)


@pytest.mark.parametrize(("t", "h", "angle"), CORNERS)
def test_its_curve_is_that_of_blocks_in_space_by_limit_analysis(t, h, angle):
    curve, masonry = mr.pushover(as_wall(t, h, angle)), mr.Masonry.corner(t, h, math.radians(angle))
    x, y, z = masonry.blocks[1].centroid
    behind = -np.array([x, y]) @ DIAGONAL
    for theta in (0.02, 0.1):
        sine, cosine = math.sin(theta), math.cos(theta)
        out, up = behind * (1 - cosine) + z * sine, behind * sine + z * (cosine - 1)
        axis = math.sin(theta / 2) / math.sqrt(2)
        pose = [*(out * DIAGONAL), up, math.cos(theta / 2), axis, axis, 0.0]
        found = mr.collapse_multiplier(masonry, angle=OUT, pose=[pose]).multiplier
        assert found == pytest.approx(np.interp(theta, curve.rotation, curve.multiplier), rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("solve", [mr.solve_explicit, mr.simulate])
def test_theory_follows_it_to_its_largest_lean(solve):
    """A pulse along the diagonal; both rock about the outer edge, and blocks in space stay on the diagonal so long. The
    base of one point gives way by 11 % of the lean on 1e10 N/m3 and 2.8 % on 1e11, in both solvers."""
    t, h, angle = 0.5, 4.0, 30
    pulse = mr.GroundMotion.half_sine(8.0, 0.4).scaled(-1.0)
    case = as_wall(t, h, angle, duration=1.0, motion=pulse)
    theory = mr.solve_analytical(case, mr.Restitution(0.95, -0.45))
    samples = pulse(np.linspace(0.0, 1.0, 1001)) / math.sqrt(2)
    ways = [mr.GroundMotion(sign * samples, 1e-3) for sign in (1, -1)]
    masonry = mr.Masonry.corner(t, h, math.radians(angle), k_n=1e11)
    run = solve(mr.MasonryCase(masonry, 1.0, motion=ways[0], transverse=ways[1]))
    most = theory.theta.max()
    assert most > 0.02
    assert run.tilt[:, 0].max() == pytest.approx(most, rel=0.03)


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
    [((0.005, 4.0), "thickness.* = 0.005"), ((0.5, 400.0), "height.* = 400"), ((0.5, 4.0, 1.5), "angle.* = 1.5")],
)
@pytest.mark.parametrize("made", [mr.Masonry.corner, mr.Corner])
def test_refused(made, given, message):
    with pytest.raises(ValueError, match=message):
        made(*given)


@pytest.mark.parametrize(("given", "message"), [((10.0, 100.0, 1.2), "offset of the added mass"), ((2.0, 2.0), "swap")])
def test_a_corner_that_no_wall_stands_for_is_refused_as_it_is_made(given, message):
    with pytest.raises(ValueError, match=rf"thickness = {given[0]:g} m, height = .* are no corner .*{message}"):
        mr.Corner(*given)
