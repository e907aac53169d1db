"""Loads that grow as the objects that an engineer has: wind, water and axles on blocks, by hand in each test."""

import math

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr

T, H = 0.6, 2.0
WALL = mr.Masonry([GROUND, box(0, T, 0, H, name="wall")], friction=5.0)
W = WALL.blocks[1].mass * mr.GRAVITY
WIND = mr.Thrust(1.5, 2000.0, block="wall")


@pytest.mark.parametrize("loads", [WIND, [WIND], {"wall": (2000.0, 0.0, 2000.0 * 0.5)}])
def test_a_thrust_is_the_force_and_its_moment_about_the_centroid(loads):
    found = mr.collapse_multiplier(WALL, None, loads=loads)
    assert found.multiplier == pytest.approx(W * T / 2 / (2000 * 1.5), rel=1e-9)
    assert mr.load_check(found).holds


def test_a_load_beside_the_edge_is_the_same_at_a_point_and_at_an_offset():
    """A bracket of 5 kN at 0.2 m beyond the edge of the wall tips it, on a sill of its own block."""
    sill = mr.Compound([box(0, T, 0, H), box(T, T + 0.3, 1.5, 1.8)], name="wall")
    masonry = mr.Masonry([GROUND, sill], friction=5.0)
    parts = (T * H, 0.3 * 0.3)
    x = (parts[0] * T / 2 + parts[1] * (T + 0.15)) / sum(parts)
    weight = 2000 * mr.GRAVITY * sum(parts)
    for at in ({"at": (0.8, 1.8)}, {"height": 1.8, "offset": 0.8 - x}):
        found = mr.collapse_multiplier(masonry, None, loads=mr.Load(5e3, block="wall", **at))
        assert found.multiplier == pytest.approx(weight * (T - x) / (5e3 * 0.2), rel=1e-9)


def test_wind_on_two_blocks_turns_the_upper_one_or_both():
    """0.8 kN/m2 on each of two blocks: the least of both mechanisms, and the mirror image of it."""
    blocks = [box(0, 0.5, 0, 1.0, name="low"), box(0.1, 0.4, 1.0, 3.0, name="high")]
    masonry = mr.Masonry([GROUND, *blocks], friction=5.0)
    wind = [mr.Thrust(0.5, 800.0 * 1.0, block="low"), mr.Thrust(2.0, 800.0 * 2.0, block="high")]
    low, high = (block.mass * mr.GRAVITY for block in masonry.blocks[1:])
    alone = high * 0.15 / (1600 * 1.0)
    both = (low + high) * 0.25 / (800 * 0.5 + 1600 * 2.0)
    for way in (1, -1):
        turned = [mr.Thrust(one.height, way * one.force, block=one.block) for one in wind]
        found = mr.collapse_multiplier(masonry, None, loads=turned)
        assert found.multiplier == pytest.approx(min(alone, both), rel=1e-9)
        assert found.moving == ("high",)


def test_in_space_a_thrust_acts_along_its_direction():
    masonry = mr.Masonry.box((0.5, 1.5, 2.0), friction=5.0)
    weight = 0.5 * 1.5 * 2.0 * 2000 * mr.GRAVITY
    for way, half in (((1, 0, 0), 0.25), ((0, -1, 0), 0.75)):
        load = mr.Thrust(force=1e3, at=(0.0, 0.0, 1.8), direction=way, block="block")
        found = mr.collapse_multiplier(masonry, None, loads=load)
        assert found.multiplier == pytest.approx(weight * half / (1e3 * 1.8), rel=1e-9)


def test_the_load_stays_level_at_its_point_as_the_wall_turns():
    """About the toe at a rotation theta the weight has t/2 cos - h/2 sin, and the wind 1.5 cos + t/2 sin."""
    curve = mr.limit_curve(WALL, None, loads=WIND, poses=12)
    theta = curve.pose[:, 0, 2]
    weight = W * (T / 2 * np.cos(theta) - H / 2 * np.sin(theta))
    hand = weight / (2000 * (1.5 * np.cos(theta) + T / 2 * np.sin(theta)))
    np.testing.assert_allclose(curve.multiplier, hand, atol=1e-9)
    assert theta[-2] < math.atan(T / H) <= theta[-1]  # it goes on by itself from there
    assert mr.load_check(curve).capacity == pytest.approx(W * T / 2 / 3000)


def test_a_limit_curve_of_weight_and_wind_goes_by_the_centroid():
    """W (t/2) = lambda (W h/2 + F z) at rest, and both have their levers at the end."""
    curve = mr.limit_curve(WALL, 1, loads=[WIND], poses=12)
    assert curve.multiplier[0] == pytest.approx(W * T / 2 / (W * H / 2 + 3000), rel=1e-9)
    assert curve.d_0 == pytest.approx(T / 2, rel=1e-5)


def test_a_check_by_a_code_takes_no_curve_with_loads():
    with pytest.raises(ValueError, match="has loads; the check is of a horizontal force: give them as effects"):
        mr.mechanism_check(mr.limit_curve(WALL, 1, loads=WIND, poses=4), lambda T, xi: 0.02)


@pytest.mark.parametrize(
    ("loads", "complaint"),
    [
        (3, "loads = 3 of type int is not Thrust, Load, a sequence of them, or a mapping of blocks to forces"),
        ([mr.AddedMass(1.0, 1.0)], r"loads\[0\] = AddedMass.* is not a Thrust or Load"),
        (mr.Thrust(1.5, 2e3), r"loads\[0\] on ground: this block is fixed"),
        (mr.Thrust(1.5, 2e3, block="roof"), r"loads\[0\], block = 'roof' is no block; the valid ones are ground, wall"),
        (mr.Thrust(3.0, 2e3, block="wall"), r"loads\[0\] on wall, height = 3 m is outside the valid range"),
        (
            {"wall": WIND},
            "loads of wall = Thrust.* a Thrust or Load has a block of its own",
        ),
        ({"roof": (1.0, 0.0)}, "loads: 'roof' is not the name of a free block; those are wall"),
        ({"wall": (1.0,)}, "loads of wall"),
    ],
)
def test_what_is_no_load(loads, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        mr.collapse_multiplier(WALL, None, loads=loads)


def test_the_wall_of_a_case_takes_one_load_and_no_mapping():
    case = mr.Case(mr.Block.from_size(0.5, 3.0), 0.0, 1.0)
    hand = 0.5 * 3.0 * 2000 * mr.GRAVITY * 0.25 / (2e3 * 1.5)
    assert mr.collapse_multiplier(case, None, loads=mr.Thrust(1.5, 2e3)).multiplier == pytest.approx(hand)
    with pytest.raises(TypeError, match="of type dict is not Thrust, Load or a sequence of them"):
        mr.collapse_multiplier(case, None, loads={"wall": (1.0, 0.0)})
