"""Vertical bending between floors: closed form, limit analysis, the check by hand, and runs about the multiplier."""

import itertools
import math

import numpy as np
import pytest
from everyday import among
from scipy.optimize import brentq

import mjrock as mr

WALL = mr.Block.from_size(0.35, 3.2, 1.5, 1800.0)
LOAD = 18e3


def by_hand(wall, load, at, crack):
    """Virtual work of a unit rotation of the lower body about the outer edge of the base.

    The upper body turns by psi = z / (h - z) the other way about the inner edge of the crack: the load stays in place
    sideways.
    """
    t, h = 2 * wall.b, 2 * wall.h
    psi = crack / (h - crack)
    lower, upper = wall.weight * crack / h, wall.weight * (h - crack) / h
    rise = lower * t / 2 + upper * (t + psi * t / 2) + load * (t + psi * at)
    sway = lower * crack / 2 + upper * psi * (h - crack) / 2
    return rise / sway


@pytest.mark.parametrize(("bearing", "crack"), [(None, None), (None, 1.6), (0.15, None), (0.2, 2.4)])
def test_virtual_work_and_limit_analysis(bearing, crack):
    bending = mr.VerticalBending(WALL, LOAD, bearing, crack)
    hand = by_hand(WALL, LOAD, bearing or 0.35, bending.crack_height)
    assert bending.multiplier == pytest.approx(hand, rel=1e-12)
    assert bending.curve.multiplier[0] == pytest.approx(hand, rel=1e-12)
    masonry = mr.Masonry.between_floors(WALL, LOAD, bearing=bearing, crack=crack)
    found = mr.collapse_multiplier(masonry)
    assert found.multiplier == pytest.approx(hand, rel=1e-9)
    assert found.moving == ("lower", "upper", "floor")


@pytest.mark.parametrize("load", [1.0, 1e8])
def test_a_load_that_no_floor_has_is_named_with_its_range(load):
    """A floor 1.5 m long and twice the thickness wide, of 0.35 to 1.75 m and 100 to 30000 kg/m3."""
    least, most = (mr.GRAVITY * 1.5 * 0.7 * mass for mass in (0.35 * 100, 1.75 * 30_000))
    with pytest.raises(ValueError, match="load = ") as caught:
        mr.Masonry.between_floors(WALL, load)
    assert f"{least:.6g} to {most:.6g} N" in str(caught.value)
    for within in (least, most):
        strip = mr.Masonry.between_floors(WALL, within * (1 + 1e-9 * (least + most - 2 * within) / most))
        floor = strip.polygons[strip.names.index("floor")]
        assert floor.mass * mr.GRAVITY == pytest.approx(within, rel=1e-6)


def test_the_crack_is_where_the_multiplier_is_least():
    bending = mr.VerticalBending(WALL, LOAD, 0.2)
    least = 2 * (math.sqrt((WALL.weight + LOAD) * 0.35) + math.sqrt(LOAD * 0.2)) ** 2 / (WALL.weight * 3.2)
    assert bending.multiplier == pytest.approx(least, rel=1e-12)
    assert min(by_hand(WALL, LOAD, 0.2, z) for z in np.linspace(0.1, 3.1, 3001)) == pytest.approx(least, rel=1e-6)
    assert 1.6 < bending.crack_height < 3.2


def test_the_curve_ends_where_the_three_hinges_lie_above_each_other():
    """With the load at the outer face both hinges of the floors are there, and the crack has moved by the thickness.

    The work of the multiplier up to there is the rise of the weights and of the load: each body then stands on its
    diagonal.
    """
    bending = mr.VerticalBending(WALL, LOAD)
    curve = bending.curve
    assert curve.displacement[-1] == pytest.approx(0.35 / 2, rel=1e-6)
    z, t, h = bending.crack_height, 0.35, 3.2
    long = math.hypot(t, z), math.hypot(t, h - z)
    lower, upper = WALL.weight * z / h, WALL.weight * (h - z) / h
    rise = lower * (long[0] - z) / 2 + upper * (long[0] + long[1] / 2 - z - (h - z) / 2)
    rise += LOAD * (sum(long) - h)
    work = WALL.weight * np.trapezoid(curve.multiplier, curve.displacement)
    assert work == pytest.approx(rise, rel=1e-6)


def test_the_steps_of_the_check():
    bending = mr.VerticalBending(WALL, LOAD)
    found = mr.mechanism_check(bending, lambda T, xi: 0.02, confidence_factor=1.2)
    assert found.participation == pytest.approx(1.0, rel=1e-15)  # a quotient of sums, which kernels order differently
    assert found.a_0 == pytest.approx(bending.multiplier * mr.GRAVITY / 1.2)
    assert found.d_0 == pytest.approx(0.175, rel=1e-6)
    slv = found.states["SLV"]
    assert slv.capacity == pytest.approx(0.07, rel=1e-6)
    # the curve falls nearly linearly
    assert slv.period == pytest.approx(1.68 * math.pi * math.sqrt(0.07 / (0.6 * found.a_0)), rel=0.03)
    assert [one.holds for one in found.verdicts] == [True, True]


@pytest.mark.parametrize("solve", [pytest.param(mr.solve_explicit, marks=pytest.mark.slow), mr.simulate])
def test_it_stands_a_slow_push_below_the_multiplier_and_falls_above(solve):
    """The push grows over 1.5 s and stays, at 0.95 and 1.05 times the multiplier of rigid bodies."""
    wall = mr.Block.from_size(0.3, 4.0)
    masonry = mr.Masonry.between_floors(wall, 20e3, friction=1.0, k_n=2e9)
    multiplier = mr.VerticalBending(wall, 20e3).multiplier
    grown = -multiplier * mr.GRAVITY * np.minimum(np.linspace(0.0, 2.0, 301), 1.0)
    below, above = (
        solve(mr.MasonryCase(masonry, 3.0, motion=mr.GroundMotion(share * grown, 0.01))) for share in (0.95, 1.05)
    )
    assert not below.fallen
    assert below.opening.max() < 1e-3
    assert {"lower", "upper"} <= set(above.fallen)


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: mr.VerticalBending(WALL, LOAD, bearing=0.4), "bearing = 0.4 m is outside the valid range"),
        (lambda: mr.VerticalBending(WALL, LOAD, crack=3.2), "crack = 3.2 m is outside the valid range"),
        (lambda: mr.VerticalBending(WALL, 0.0), "load of the floor = 0"),
        (lambda: mr.VerticalBending(3, LOAD), "wall = 3 of type int is not a Block"),
        (
            lambda: mr.Masonry.between_floors(mr.Block.from_size(0.35, 3.2, inset=0.05), LOAD),
            "is not a rectangle, with a profile or without; cut it to the strip",
        ),
    ],
)
def test_what_cannot_be(call, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        call()


def two_storeys(effect):
    """Two storeys of 3.2 m, whose middle floor loads the wall and does not hold it."""
    wall = mr.Block.from_size(0.45, 6.4, 1.0, 1800.0)
    return mr.VerticalBending(wall, 12e3, bearing=0.225, effects=effect)


def hand(bending, crack, inertia):
    """Virtual work of 12 kN at mid-height of 6.4 m, in the middle of 0.45 m, by one sum for each side of the crack."""
    t, h, W, N = 0.45, 6.4, bending.wall.weight, 12e3
    up = crack / (h - crack)
    rise, sway = (0.5 * t, 3.2) if crack >= 3.2 else (t + up * 0.5 * t, up * 3.2)
    work = W * t + N * (t + up * 0.225) + N * rise
    return work / (0.5 * W * crack + inertia * N * sway)


@pytest.mark.parametrize(
    ("effect", "inertia", "least"),
    [(mr.Load(12e3, 3.2), 0, 0.3194), (mr.AddedMass(12e3 / mr.GRAVITY, 3.2), 1, 0.2435)],
    ids=["load", "mass"],
)
def test_a_middle_floor_that_does_not_hold_loads_the_wall(effect, inertia, least):
    bending = two_storeys(effect)
    cracks = np.linspace(0.1, 6.3, 62001)
    scanned = [hand(bending, crack, inertia) for crack in cracks]
    assert bending.multiplier == pytest.approx(min(scanned), rel=1e-8)
    assert bending.multiplier == pytest.approx(least, abs=5e-5)
    assert bending.crack_height == pytest.approx(cracks[np.argmin(scanned)], abs=1e-3)
    for crack in (1.0, 3.0, 3.5, 6.0):
        given = mr.VerticalBending(bending.wall, 12e3, bearing=0.225, crack=crack, effects=effect)
        assert given.multiplier == pytest.approx(hand(bending, crack, inertia), rel=1e-12)
        assert given.curve.multiplier[0] == pytest.approx(given.multiplier, rel=1e-12)


def test_the_same_as_blocks():
    """The load stands on the lower body where the crack is above it, as limit analysis finds it."""
    bending = two_storeys(mr.Load(12e3, 3.2))
    crack = bending.crack_height
    masonry = mr.Masonry.between_floors(bending.wall, 12e3, bearing=0.225, crack=crack)
    found = mr.collapse_multiplier(masonry, 1, effects=mr.Load(12e3, 3.2, block="lower"))
    assert found.multiplier == pytest.approx(bending.multiplier, rel=1e-6)


def test_e_star_and_d_of_a_mass_in_between():
    """Of virtual displacements: crack / 2 of both bodies, and 3.2 of the mass below the crack."""
    effect = mr.AddedMass(12e3 / mr.GRAVITY, 3.2)
    bending = two_storeys(effect)
    crack, W, N = bending.crack_height, bending.wall.weight, 12e3
    assert crack > 3.2
    first, second = W * crack / 2 + N * 3.2, W * crack**2 / 4 + N * 3.2**2
    assert bending.participation == pytest.approx(first**2 / ((W + N) * second), rel=1e-12)
    check = mr.mechanism_check(bending, lambda T, xi: 0.02)
    assert check.participation == bending.participation
    assert check.d_0 == pytest.approx(bending.curve.displacement[-1] / bending.participation)


@pytest.mark.parametrize(
    ("effect", "complaint"),
    [
        (mr.Load(12e3, 7.0), r"effects\[0\], height = 7 m is outside the valid range 0 to 6.4 m"),
        (mr.Load(12e3, 3.0, 0.3), r"effects\[0\], offset = 0.3 m is outside the valid range -0.225 to 0.225 m"),
        (mr.Thrust(3.0, 12e3), r"effects\[0\] = .*Thrust.* is not a Load or AddedMass"),
    ],
)
def test_what_does_not_load_it_is_refused(effect, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        two_storeys((effect,))


T0, T1, STEP, HEIGHT, FLOOR, BEARS = 0.45, 0.30, 3.2, 6.0, 14e3, 0.12


def stepped(plumb, **options):
    """Two storeys, the upper one thinner; the roof bears on 0.12 m from its inner face."""
    profile = [(0, T0), (STEP, T0), (STEP, T1), (HEIGHT, T1)]
    wall = mr.Block.from_size(T0, HEIGHT, 1.5, 1800.0, profile=profile, plumb=plumb)
    return mr.VerticalBending(wall, FLOOR, BEARS, **options)


def storeys(plumb, crack, above_a_step=True):
    """Weight, x and z of the rectangles below and above a crack, x from the inner edge of the base; its inner edge."""
    inside = T0 - T1 if plumb == "outer" else 0.0
    thin = crack > STEP or (crack == STEP and above_a_step)
    cuts = sorted({0.0, STEP, crack, HEIGHT})
    below, above = [], []
    for low, high in itertools.pairwise(cuts):
        t, face = (T0, 0.0) if high <= STEP else (T1, inside)
        row = 1800 * mr.GRAVITY * 1.5 * t * (high - low), face + t / 2, (low + high) / 2
        (below if high <= crack else above).append(row)
    return np.array(below), np.array(above), inside if thin else 0.0, inside


def stepped_by_hand(plumb, crack, above_a_step=True):
    """Virtual work of a unit rotation of the lower body about the outer edge of the base."""
    below, above, c, inside = storeys(plumb, crack, above_a_step)
    r = crack / (HEIGHT - crack)
    work = (below[:, 0] * (T0 - below[:, 1])).sum() + (above[:, 0] * (T0 - c + r * (above[:, 1] - c))).sum()
    work += FLOOR * (T0 - c + r * (inside + BEARS - c))
    return work / ((below[:, 0] * below[:, 2]).sum() + (above[:, 0] * r * (HEIGHT - above[:, 2])).sum())


@pytest.mark.parametrize("plumb", among(["inner", "outer"], "inner"))
def test_a_wall_that_steps_back_bends_at_the_least_of_all_cracks(plumb):
    bending = stepped(plumb)
    cracks = [STEP, *np.linspace(0.07, 5.93, 3001)]
    scanned = [stepped_by_hand(plumb, crack, side) for crack in cracks for side in (True, False)]
    assert bending.multiplier == pytest.approx(min(scanned), rel=1e-6)
    for crack in (1.0, STEP, 4.0, 5.5):
        given = stepped(plumb, crack=crack)
        hand = stepped_by_hand(plumb, crack)
        assert given.multiplier == pytest.approx(hand, rel=1e-12)
        assert given.curve.multiplier[0] == pytest.approx(hand, rel=1e-12)
        blocks = mr.Masonry.between_floors(given.wall, FLOOR, bearing=BEARS, crack=crack, friction=2.0)
        assert mr.collapse_multiplier(blocks).multiplier == pytest.approx(hand, rel=1e-8)


@pytest.mark.parametrize("plumb", ["inner", "outer"])
def test_the_work_along_the_curve_of_a_stepped_wall_is_what_weights_and_floor_have_risen(plumb):
    """Both bodies as they stand at the end, from the angle of the lower one alone."""
    crack = 4.0
    bending = stepped(plumb, crack=crack)
    below, above, c, inside = storeys(plumb, crack)
    curve = bending.curve
    theta = curve.rotation[-1]
    edge = np.array([T0, 0.0])

    def turned(points, about, angle):
        x, z = (np.atleast_2d(points) - about).T
        return np.column_stack([x * np.cos(angle) + z * np.sin(angle), z * np.cos(angle) - x * np.sin(angle)]) + about

    hinge = turned((c, crack), edge, theta)[0]
    bears = np.array([inside + BEARS, HEIGHT])
    back = brentq(lambda psi: turned(bears + hinge - (c, crack), hinge, -psi)[0, 0] - bears[0], 0.0, 1.0)
    moved = turned(below[:, 1:], edge, theta), turned(above[:, 1:] + hinge - (c, crack), hinge, -back)
    floor = turned(bears + hinge - (c, crack), hinge, -back)[0]
    rise = FLOOR * (floor[1] - HEIGHT)
    total, sway = 0.0, 0.0
    for rows, places in ((below, moved[0]), (above, moved[1])):
        rise += rows[:, 0] @ (places[:, 1] - rows[:, 2])
        sway += rows[:, 0] @ (places[:, 0] - rows[:, 1])
        total += rows[:, 0].sum()
    assert curve.displacement[-1] == pytest.approx(sway / total, rel=1e-5)
    assert total * np.trapezoid(curve.multiplier, curve.displacement) == pytest.approx(rise, rel=1e-6)


def test_e_star_and_the_check_of_a_stepped_wall():
    """Virtual displacements of the two centroids: z below, r (h - z) above."""
    bending = stepped("outer", crack=4.0)
    below, above, *_ = storeys("outer", 4.0)
    weights = np.array([below[:, 0].sum(), above[:, 0].sum()])
    z = (below[:, 0] @ below[:, 2] / weights[0], above[:, 0] @ above[:, 2] / weights[1])
    sway = np.array([z[0], 2.0 * (HEIGHT - z[1])])
    share = (weights @ sway) ** 2 / (weights.sum() * (weights @ sway**2))
    assert share < 1 - 1e-4
    assert bending.participation == pytest.approx(share, rel=1e-12)
    check = mr.mechanism_check(bending, lambda T, xi: 0.02)
    assert check.a_0 == pytest.approx(stepped_by_hand("outer", 4.0) * mr.GRAVITY / (share * 1.35), rel=1e-12)


def test_a_profile_of_one_thickness_is_the_plain_wall():
    plain = mr.VerticalBending(WALL, LOAD, 0.2)
    profile = [(0, 0.35), (1.1, 0.35), (1.1, 0.35), (3.2, 0.35)]
    cut = mr.VerticalBending(mr.Block.from_size(0.35, 3.2, 1.5, 1800.0, profile=profile, plumb="outer"), LOAD, 0.2)
    assert cut.multiplier == pytest.approx(plain.multiplier, rel=1e-12)
    assert cut.crack_height == pytest.approx(plain.crack_height, rel=1e-6)
    given = [mr.VerticalBending(one.wall, LOAD, 0.2, crack=2.0) for one in (plain, cut)]
    assert given[0].participation == pytest.approx(given[1].participation, rel=1e-12)
    np.testing.assert_allclose(given[0].curve.multiplier, given[1].curve.multiplier, atol=1e-12)


def test_a_floor_on_the_setback_loads_the_lower_storey():
    """12 kN in the middle of the ledge of 0.15 m: it rises by t - 0.075 where the crack is above."""
    ledge = mr.Load(12e3, STEP, 0.075 - T0 / 2)
    found = stepped("outer", crack=4.0, effects=ledge).multiplier - stepped("outer", crack=4.0).multiplier
    below, above, *_ = storeys("outer", 4.0)
    work = (below[:, 0] @ below[:, 2]) + (above[:, 0] * 2.0) @ (HEIGHT - above[:, 2])
    assert found == pytest.approx(12e3 * (T0 - 0.075) / work, rel=1e-12)
