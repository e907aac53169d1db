"""A corner of two walls that overturns, against its closed form by limit analysis and by two solvers."""

import dataclasses
import math

import numpy as np
import pytest
from everyday import among

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
    for theta in (0.02, 0.1):
        found = mr.collapse_multiplier(masonry, angle=OUT, pose=leaning(masonry, theta)).multiplier
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


ROOF = (
    mr.Thrust(3.9, 1e3),
    mr.Load(9e3, 4.0, 0.1),
    mr.Load(12e3, 4.0, -1.0),
    mr.AddedMass(800.0, 4.0, -0.6),
    mr.AddedMass(300.0, 4.0, 0.4),
)


def loaded_by_hand(t, h, angle, effects, rods=0.0, density=2000.0):
    """Moments about the outer edge: of weights and loads at their distance behind it, of thrusts, and of rods in both
    walls, whose pulls add up to sqrt(2) of one along the diagonal."""
    p, out, half = h * math.tan(angle), math.sqrt(2), t / math.sqrt(2)
    weights = [(density * t * t * h, t / out, h / 2), (density * t * p * h, (1.5 * t + p / 3) / out, 2 * h / 3)]
    weights += [(one.mass, half - one.offset, one.height) for one in effects if isinstance(one, mr.AddedMass)]
    holds = sum(mr.GRAVITY * mass * lever for mass, lever, _ in weights) + rods
    holds += sum(one.force * (half - one.offset) for one in effects if isinstance(one, mr.Load))
    holds -= sum(one.force * one.height for one in effects if isinstance(one, mr.Thrust))
    return holds / sum(mr.GRAVITY * mass * z for mass, _, z in weights)


@pytest.mark.parametrize("effects", [*((one,) for one in ROOF), ROOF], ids=lambda some: type(some[0]).__name__)
@pytest.mark.parametrize("angle", [0.0, 0.01, 0.5])
def test_what_a_roof_brings_stands_in_the_closed_form(effects, angle):
    if angle < 0.5 and any(one.offset < -0.4 for one in effects if isinstance(one, mr.Load)):
        with pytest.raises(ValueError, match=r"effects\[\d\], offset of the Load = -1 m is outside the valid range"):
            mr.Corner(0.5, 4.0, angle, effects=effects)
        return
    corner = mr.Corner(0.5, 4.0, angle, effects=effects)
    assert corner.multiplier == pytest.approx(loaded_by_hand(0.5, 4.0, angle, effects), rel=1e-12)
    assert mr.mechanism_check(corner, lambda T, xi: 0.1).alpha_0 == pytest.approx(corner.multiplier, rel=1e-12)
    assert mr.pushover(corner.case).start == pytest.approx(corner.multiplier, rel=1e-12)


@pytest.mark.parametrize("anchor_height", [None, 2.0])
def test_a_tie_is_a_rod_in_either_wall(anchor_height):
    """Where it pulls with F its moment is that of both rods, from the points that they hold to their anchors."""
    t, h, z, length, strength = 0.5, 4.0, 3.8, 5.0, 15e3
    given = {"length": length, "anchor_height": anchor_height}
    tie = mr.Tie(z, 1e8, strength=strength, ultimate=0.03, slack=0.004, **given)
    behind, rods = np.array([-t, t, z]), 0.0
    for along in ([-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]):
        way = length * np.array(along) + [0.0, 0.0, 0.0 if anchor_height is None else anchor_height - z]
        pull = strength * way / np.linalg.norm(way)
        rods += np.cross(behind, pull) @ [1.0, 1.0, 0.0] / math.sqrt(2)  # about the edge, across the diagonal
    check = mr.mechanism_check(mr.Corner(t, h, 0.5, effects=tie), lambda T, xi: 0.1)
    assert check.alpha_0 == pytest.approx(by_hand(t, h, 0.5), rel=1e-12)
    assert check.alpha_tied == pytest.approx(loaded_by_hand(t, h, 0.5, (), abs(rods)), rel=1e-12)


def test_rods_are_stretched_by_as_much_as_the_walls_move_along_them():
    """A turn by theta moves the held point along either wall by 1 / sqrt(2) of its way along the diagonal."""
    t, h, z, k, slack = 0.5, 4.0, 3.8, 2e7, 0.002
    tie = mr.Tie(z, k, slack=slack, strength=15e3, ultimate=0.01, length=1000.0)
    case = mr.Corner(t, h, 0.5, effects=tie).case
    theta = np.array([0.0002, 0.0009, 0.001, 0.002, 0.01])
    out = (math.sqrt(2) * t * (1 - np.cos(theta)) + z * np.sin(theta)) / math.sqrt(2)  # of the inner corner
    force = np.where(out - slack > 15e3 / k + 0.01, 0.0, np.clip(k * (out - slack), 0.0, 15e3))
    lever = math.sqrt(2) * t * np.sin(theta) + z * np.cos(theta)
    assert case.pulls[0].moment(theta) == pytest.approx(math.sqrt(2) * force * lever, rel=1e-3)
    assert force[0] == force[-1] == 0 < force[1] < force[2]


def leaning(masonry, theta):
    """The pose of a corner of blocks that has turned along its diagonal about its outer edge."""
    x, y, z = masonry.blocks[1].centroid
    behind = -np.array([x, y]) @ DIAGONAL
    out, up = behind * (1 - math.cos(theta)) + z * math.sin(theta), behind * math.sin(theta) + z * (math.cos(theta) - 1)
    axis = math.sin(theta / 2) / math.sqrt(2)
    return [[*(out * DIAGONAL), up, math.cos(theta / 2), axis, axis, 0.0]]


def mirrored_x(masonry):
    """The other corner of a house, of the same blocks in a mirror across x, with smooth cracks."""

    def turned(part):
        return dataclasses.replace(part, vertices=np.array(part.vertices) * [-1, 1, 1])

    blocks = [
        mr.Compound([turned(part) for part in block.parts], name=block.name) if len(block.parts) > 1 else turned(block)
        for block in masonry.blocks
    ]
    return mr.Masonry(blocks, k_n=1e10, friction=lambda joint: 0.0 if "rest" in joint.name else 0.7)


@pytest.mark.parametrize("mirrored", among([False, True], True))
def test_blocks_in_space_bear_the_same_with_thrusts_loads_and_rods(mirrored):
    """The other corner of the house too, with all in it mirrored, and as it leans."""
    t, h, angle, far = 0.5, 4.0, 0.5, 500.0
    masonry, sign = mr.Masonry.corner(t, h, angle), -1.0 if mirrored else 1.0

    def place(x, y, z):
        return sign * x, y, z

    def behind(offset):
        """A point on the diagonal at an offset from the middle of the post."""
        along = (t / math.sqrt(2) - offset) / math.sqrt(2)
        return place(-along, along, 4.0)

    def on_walls(offset):
        """A point in the middle of either wall at that offset along the diagonal."""
        along = 0.5 * t - math.sqrt(2) * offset
        return place(-along, 0.5 * t, 4.0), place(-0.5 * t, along, 4.0)

    roof = [
        mr.Thrust(at=place(-0.25, 0.25, 3.9), force=1e3, direction=place(1.0, -1.0, 0.0), block="corner"),
        *(mr.Load(0.5 * one.force, at=at, block="corner") for one in ROOF[1:3] for at in on_walls(one.offset)),
        *(mr.AddedMass(one.mass, at=behind(one.offset), block="corner") for one in ROOF[3:]),
    ]
    rod = {"stiffness": 1e9, "strength": 12e3, "ultimate": 1.0, "block": "corner", "at": place(-t, t, 3.8)}
    rods = [mr.Tie(**rod, anchor=end) for end in (place(-far, t, 3.8), place(-t, far, 3.8))]
    tie = mr.Tie(3.8, 1e9, strength=12e3, ultimate=0.9, length=far - t)
    corner = mr.Corner(t, h, angle, effects=(*ROOF, tie))
    masonry, way = (mirrored_x(masonry), math.pi - OUT) if mirrored else (masonry, OUT)
    slack = mr.collapse_multiplier(masonry, angle=way, effects=roof).multiplier
    assert slack == pytest.approx(corner.multiplier, rel=1e-6)
    held = mr.collapse_multiplier(masonry, angle=way, effects=[*roof, *rods]).multiplier
    assert held == pytest.approx(mr.mechanism_check(corner, lambda T, xi: 0.1).alpha_tied, rel=1e-6)
    if mirrored:
        return
    curve = mr.pushover(corner.case)
    for theta in (0.02, 0.1):
        pose = leaning(masonry, theta)
        found = mr.collapse_multiplier(masonry, angle=OUT, effects=[*roof, *rods], pose=pose).multiplier
        assert found == pytest.approx(np.interp(theta, curve.rotation, curve.multiplier), rel=1e-3)


def test_sizes_and_forces_of_another_scale_give_the_same_corner():
    """Sizes by s, forces by s^3 and stiffnesses by s^2 at one density."""

    def checked(s):
        roof = mr.Thrust(3.9 * s, 4e3 * s**3), mr.Load(12e3 * s**3, 4.0 * s, -1.0 * s)
        tie = mr.Tie(3.8 * s, 1e7 * s**2, 0.01 * s, 15e3 * s**3, 5.0 * s, ultimate=0.03 * s)
        return mr.mechanism_check(mr.Corner(0.5 * s, 4.0 * s, 0.5, effects=(*roof, tie)), lambda T, xi: 0.1)

    one, other = checked(1.0), checked(1.75)
    assert (other.alpha_0, other.alpha_tied) == pytest.approx((one.alpha_0, one.alpha_tied), rel=1e-12)
    assert other.d_0 == pytest.approx(1.75 * one.d_0, rel=1e-9)
    assert other.breaking["tie_0"] == pytest.approx(1.75 * one.breaking["tie_0"], rel=1e-9)


@pytest.mark.parametrize(
    ("effect", "complaint"),
    [
        (mr.Damper(3.0, 1e4), "effects = Damper.* is not a sequence of Tie, Thrust, Load, AddedMass"),
        ([mr.Damper(3.0, 1e4)], r"effects\[0\] = Damper.* is not a Tie or Thrust or Load or AddedMass"),
        (
            mr.Load(9e3, 4.0, 0.4),
            r"effects\[0\], offset of the Load = 0.4 m is outside the valid range -1.89873 to 0.353553",
        ),
        (mr.Load(9e3, 4.0, -3.0), r"effects\[0\], offset of the Load = -3 m is outside"),
        (mr.Tie(4.1, 1e7), r"effects\[0\], height of the Tie = 4.1 m is outside the valid range 0 to 4 m"),
        (mr.Tie(at=(0.0, 3.0), stiffness=1e7), r"effects\[0\], at = \(0.0, 3.0\) is for masonry; leave it out"),
        (mr.Thrust(4.0, 1e6), "loads and thrusts overturn the wall outwards as it stands"),
    ],
)
def test_what_does_not_fit_a_corner_is_refused_by_name(effect, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        mr.Corner(0.5, 4.0, 0.5, effects=effect)
