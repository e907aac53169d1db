"""The push of rigid masonry as its mechanism goes on, by limit analysis: closed forms, energies, closing hinges."""

import math

import numpy as np
import pytest

import mjrock as mr


def work_of(curve, masonry):
    """Work under a curve, and the potential energy gained at its end [J]."""
    weight = mr.GRAVITY * np.array([masonry.blocks[i].mass for i in masonry.free])
    rise = curve.pose[-1, :, 2 if masonry.in_space else 1]
    return weight.sum() * np.trapezoid(curve.multiplier, curve.displacement), float(weight @ rise)


@pytest.mark.parametrize("in_space", [False, True], ids=["plane", "space"])
def test_a_column_leans_as_one_block(in_space):
    thick, high = 0.6, 3.0
    column = mr.Masonry.stack([mr.Block.from_size(thick, high / 3)] * 3)
    if in_space:
        column = mr.Masonry([mr.Polyhedron.prism(block) for block in column.blocks])
    curve = mr.limit_curve(column, 1, to=0.5, poses=20)
    alpha, half = math.atan2(thick, high), math.hypot(thick, high) / 2
    theta = alpha - np.arcsin(np.maximum(math.sin(alpha) - curve.displacement / half, -1.0))
    np.testing.assert_allclose(curve.multiplier, np.tan(alpha - theta), atol=2e-6)
    assert curve.d_0 == pytest.approx(thick / 2, rel=1e-3)
    assert curve.ended == "goes on by itself"
    assert curve.multiplier[-2] > 0 >= curve.multiplier[-1]


def test_against_the_direction_it_is_the_mirror_image():
    column = mr.Masonry.stack([mr.Block.from_size(0.6, 1.5)] * 2)
    one, other = (mr.limit_curve(column, way, to=0.1, poses=8) for way in (1, -1))
    np.testing.assert_allclose(one.displacement, other.displacement, rtol=1e-9)
    np.testing.assert_allclose(one.multiplier, other.multiplier, atol=1e-9)
    np.testing.assert_allclose(one.pose * [-1, 1, -1], other.pose, atol=1e-9)


def test_a_wall_between_floors_follows_virtual_work():
    """The curve counts the floor above, whose mass goes up and not sideways."""
    load = 20e3
    bending = mr.VerticalBending(mr.Block.from_size(0.35, 3.2, 1.0, 1800.0), load)
    masonry = mr.Masonry.between_floors(bending.wall, load, friction=1.5)
    found = mr.limit_curve(masonry, 1, to=0.08, poses=8)
    share = bending.wall.weight / (bending.wall.weight + load)
    closed = np.interp(found.displacement / share, bending.curve.displacement, bending.curve.multiplier)
    np.testing.assert_allclose(found.multiplier, closed, atol=1e-4)


def test_the_area_of_an_arch_is_the_energy_that_it_gains():
    arch = mr.Masonry.arch(2.0, 0.4, voussoirs=9, friction=2.0)
    curve = mr.limit_curve(arch, 1, to=0.05, poses=20)
    work, gained = work_of(curve, arch)
    assert curve.multiplier[0] == pytest.approx(mr.collapse_multiplier(arch).multiplier)
    assert work == pytest.approx(gained, rel=1e-3)  # of the trapezoidal rule
    assert curve.ended == "moved by 50 mm"
    assert math.isnan(curve.d_0)


@pytest.mark.slow
def test_an_arch_beside_a_slow_push_by_explicit_steps():
    arch = mr.Masonry.arch(2.0, 0.4, voussoirs=9, k_n=1e11, friction=2.0, xi=0.1)
    push, curve = mr.push(arch, 1, 0.05), mr.limit_curve(arch, 1, to=0.05)
    at = np.linspace(5e-3, 0.049, 20)
    borne = [
        np.interp(at, each.displacement, values) for each, values in ((push, push.force), (curve, curve.multiplier))
    ]
    np.testing.assert_allclose(*borne, atol=0.01 * push.peak)


def test_it_ends_where_hinges_would_move():
    """The thrust of an arch of many voussoirs reaches the edge of a further joint, and its hinge takes over."""
    arch = mr.Masonry.arch(2.0, 0.4, voussoirs=15, friction=2.0)
    curve = mr.limit_curve(arch, 1, to=0.12, poses=25)
    work, gained = work_of(curve, arch)
    assert work == pytest.approx(gained, rel=1e-3)
    assert curve.ended == "another joint begins to open"
    assert 0.02 < curve.displacement[-1] < 0.04


def test_it_ends_where_joints_slide():
    column = mr.Masonry.stack([mr.Block.from_size(0.6, 1.0)] * 3, friction=0.1)
    curve = mr.limit_curve(column, 1, to=0.2)
    assert curve.multiplier.tolist() == pytest.approx([0.1])
    assert curve.ended.endswith("slide")


def test_it_ends_where_lines_close_again_and_again():
    """A corner that is pushed along a wall has many mechanisms of one multiplier."""
    corner = mr.Masonry.corner(0.5, 4.0, math.pi / 6)
    curve = mr.limit_curve(corner, None, angle=0.0, to=2.0, poses=2)
    assert curve.ended in ("lines close again and again", "locks")
    assert len(curve.multiplier) <= 3 + len(corner.lines.at)


def test_a_tie_that_breaks_bears_nothing_from_there_on():
    """A block of 0.6 by 2 m leans by theta; its tie at 1.9 m is then longer by 1.9 sin(theta), next to its height."""
    column = mr.Masonry.stack([mr.Block.from_size(0.6, 2.0)])
    tie = mr.Tie(height=1.9, stiffness=1e6, strength=1e3, ultimate=0.05, block="block_0")
    bare, held = mr.limit_curve(column, 1, to=0.5, poses=20), mr.limit_curve(column, 1, to=0.5, effects=tie, poses=20)
    broken = 1.9 * np.sin(held.pose[:, 0, 2]) > 0.052
    assert broken[3:].any()
    assert not broken[:2].any()
    assert held.d_0 == pytest.approx(bare.d_0, rel=1e-3)
    extra = held.multiplier - np.interp(held.displacement, bare.displacement, bare.multiplier)
    assert np.abs(extra[broken]).max() < 1e-4
    assert extra[~broken].min() > 0.9 * 1e3 * 1.9 / (column.blocks[1].mass * mr.GRAVITY)


@pytest.mark.parametrize(
    ("given", "message"),
    [({"to": 0.0}, "to = 0"), ({"to": 0.1, "poses": 1}, "poses = 1"), ({"to": 0.1, "direction": 2}, "direction")],
)
def test_refused(given, message):
    with pytest.raises(ValueError, match=message):
        mr.limit_curve(mr.Masonry.stack([mr.Block.from_size(0.6, 1.0)] * 2), **given)


def test_bonded_masonry_is_refused():
    """What a bond holds is lost as its joint opens, which no pose says."""
    bond = mr.Bond(tension=2e5, cohesion=3e5, opening_energy=20.0, slip_energy=100.0)
    bed = mr.Mortar(mr.Dry(1e10, 0.6, 0.05, 1e10, None, 5), bond)
    wall = mr.Masonry.stack([mr.Block.from_size(0.6, 1.0)] * 2, joints=bed)
    with pytest.raises(ValueError, match=r"bond of .*: limit_curve takes joints that push only"):
        mr.limit_curve(wall, 1, to=0.2)
