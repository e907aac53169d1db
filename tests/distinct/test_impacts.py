"""Flat impacts at the joints: frequencies and damping ratios by closed forms, and the step that goes by them."""

import math

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct.setup import setup_of
from mjrock.distinct.step_length import Impacts

K_N = 1e8
"""Stiffness of the joints [N/m3]."""


def at_start(blocks, xi=0.1, **options):
    """Masonry of these blocks at its start."""
    masonry = mr.Masonry(blocks, k_n=K_N, friction=0.7, xi=xi, **options)
    return masonry, setup_of(mr.MasonryCase(masonry, 1.0), None, None).step_length


@pytest.mark.parametrize("in_space", [False, True])
def test_an_impact_is_that_of_a_reduced_mass(in_space):
    """A block of 2 m3 on the ground, and a cube on it that is turned about its vertical axis as a whole."""
    if in_space:
        ground = mr.Polyhedron.box((9, 9, 1), (0, 0, -0.5), fixed=True)
        blocks = [ground, *(mr.Polyhedron.box((2 - i, 1, 1), (0, 0, 0.5 + i)) for i in range(2))]
    else:
        blocks = [GROUND, box(-1, 1, 0, 1), box(-0.5, 0.5, 1, 2)]
    masonry, start = at_start(blocks)
    lower, upper = (masonry.blocks[i].mass for i in masonry.free)
    mass, area = np.array([lower, lower * upper / (lower + upper)]), np.array([2.0, 1.0])
    order = np.argsort([joint.above for joint in masonry.joints])
    frequency = np.sqrt(K_N * area / mass)
    np.testing.assert_allclose(start.impacts.frequency[order], frequency, rtol=1e-12)
    np.testing.assert_allclose(start.impacts.ratio[order], 0.5 * masonry.retardation[order] * frequency, rtol=1e-12)


def test_dashpots_of_a_moving_face_count_as_those_on_the_ground():
    """Blocks side by side: normals of beds are vertical, those of heads horizontal, and both count."""
    masonry, start = at_start([GROUND, box(0, 1, 0, 1), box(1, 2, 0, 1)])
    mass = masonry.blocks[1].mass
    expected = [math.sqrt(K_N / mass) if 0 in (j.below, j.above) else math.sqrt(2 * K_N / mass) for j in masonry.joints]
    np.testing.assert_allclose(start.impacts.frequency, expected, rtol=1e-12)


def test_joints_may_have_any_slope():
    """Those of an arch of equal voussoirs have one stiffness; the outer ones meet fixed abutments."""
    arch = mr.Masonry.arch(5.0, 0.75, voussoirs=7, k_n=K_N, xi=0.05)
    impacts, mass = setup_of(mr.MasonryCase(arch, 1.0), None, None).step_length.impacts, arch.blocks[arch.free[0]].mass
    fixed = [arch.blocks[joint.below].fixed or arch.blocks[joint.above].fixed for joint in arch.joints]
    assert sum(fixed) == 2
    np.testing.assert_allclose(impacts.frequency, np.sqrt(K_N * 0.75 / mass * np.where(fixed, 1, 2)), rtol=1e-9)


def test_a_block_that_a_guide_holds_has_no_impact():
    """Along the normal of its bed."""
    masonry = mr.Masonry([GROUND, box(-1, 1, 0, 1), box(1, 2, 0, 1)], k_n=K_N, friction=0.7)
    history = {"displacement": ([0.0, 0.1], [0.0, 0.0]), "stiffness": 1e8}
    jack = mr.Actuator(block=masonry.names[1], at=(0.0, 0.5), direction=(1.0, 0.0), guided="translation", **history)
    impacts = setup_of(mr.MasonryCase(masonry, 1.0, effects=(jack,)), None, None).step_length.impacts
    assert len(impacts.ratio) == 2
    assert np.isfinite(impacts.ratio).all()


IMPACTS = Impacts(np.array([100.0, 200.0, 50.0]), np.array([0.2, 0.5, 0.02]))


def test_dashpots_lag_by_the_mass_that_they_seem_to_take():
    """ln |e| is -pi r for little damping, and r grows by half of C h / 2 m, which is r w h / 2."""
    h, mass = 1e-3, 7.0
    stiffness, damping = mass * 100.0**2, 2 * 0.2 * 100.0 * mass
    lighter = damping / (2 * math.sqrt(stiffness * (mass - 0.5 * damping * h)))
    assert IMPACTS.lag(h)[0] == pytest.approx(math.pi * (lighter - 0.2), rel=0.05)
    np.testing.assert_allclose(IMPACTS.lag(h), 0.5 * math.pi * h * np.array([4.0, 50.0, 0.02]))


def test_the_step_is_short_where_dashpots_lag():
    """A tenth of the time in which they stop a block, or 0.15 of that of its vibration over 2 pi where that is more."""
    assert IMPACTS.step(1e-5) == 1e-5  # none lags
    lags = 0.01 / (0.5 * math.pi * 50.0)  # from here on the second one does
    assert IMPACTS.step(lags * 0.99) == lags * 0.99
    assert IMPACTS.step(1e-2) == pytest.approx(0.15 / 200.0)  # 0.1 of C / m is shorter, the first one asks for 2.5 ms
    assert Impacts(IMPACTS.frequency[:1], IMPACTS.ratio[:1]).step(1e-2) == pytest.approx(0.05 / 0.2 / 100.0)
    assert IMPACTS.step(7e-4) == 7e-4
    none = Impacts(np.zeros(0), np.zeros(0))
    assert none.step(0.3) == 0.3
    assert not none.look_ahead(0.3)


def test_dashpots_look_ahead_where_they_lag_and_steps_are_short():
    lags = 0.01 / (0.5 * math.pi * 50.0)
    for h, ahead in ((0.99 * lags, False), (1.01 * lags, True), (7.4e-4, True), (7.6e-4, False)):
        assert IMPACTS.look_ahead(h) is ahead


def test_masonry_with_strong_dashpots_takes_the_step_that_they_ask_for():
    blocks = [GROUND, box(-0.4, 0.4, 0, 0.5)]
    for xi, strong in ((0.05, False), (0.2, True), (0.3, True)):
        masonry, start = at_start(blocks, xi)
        stats = mr.solve_explicit(mr.MasonryCase(masonry, 1.0), output_step=0.1).stats
        if strong:
            step = 0.05 / start.impacts.ratio[0] / start.impacts.frequency[0]
            assert 0.98 * step < stats["timestep"] <= step
        else:
            assert 0.39 < stats["share"] <= 0.4
        assert start.looks_ahead(stats["timestep"]) is strong
        assert start.looks_ahead(start.default) is strong  # as long as it may be, to rounding
    given = 0.4 * start.limit  # too long for what dashpots could foresee
    assert not start.looks_ahead(given)
    assert start.looks_ahead(0.2 * start.limit)
    assert at_start(blocks, 0.0)[1].looks_ahead(0.25 * start.limit)


@pytest.mark.parametrize("share", [0.7, 0.95])
def test_strong_dashpots_are_stable_up_to_the_limit(share):
    """A column at rest. Dashpots that look ahead would be stable in half of it, and throw the drums about."""
    drums = mr.Masonry.column(width=0.6, height=4.8, drums=12, k_n=1e9, k_s=1e9, xi=0.05)
    limit = mr.solve_explicit(mr.MasonryCase(drums, 1e-3)).stats["stable_timestep"]
    after = mr.solve_explicit(mr.MasonryCase(drums, 0.05), timestep=share * limit, output_step=0.01)
    assert np.abs(after.velocity).max() < 1e-12
