"""Ties, loads, thrusts and added masses on the blocks of masonry."""

import math

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.masonry.effects import applied, pulls_of, with_added_masses

WALL = mr.Block.from_size(0.6, 4.2)
HALF = mr.Block.from_size(0.6, 2.1)
PULSE = mr.GroundMotion.sine(2.5, 0.7)
EFFECTS = {
    "load": lambda block: mr.Load(10e3, 4.2, 0.1, block=block),
    "thrust": lambda block: mr.Thrust(4.0, 1000.0, block=block),
    "mass": lambda block: mr.AddedMass(800.0, 4.0, 0.15, block=block),
    "tie": lambda block: mr.Tie(3.0, 1e6, 0.01, 3e3, block=block),
}


@pytest.mark.parametrize("name", EFFECTS)
def test_one_block_with_an_effect_is_the_wall_with_it(name):
    """The scene of a wall without a side stop and that of masonry of one block, with the friction of the wall."""
    masonry = mr.Masonry.stack([WALL], k_n=5e8, xi=0.05, friction=1.0)
    contacts = mr.Contacts.from_damping(WALL, k_base=5e8, xi_base=0.05, friction=1.0)
    effect = EFFECTS[name]
    stacked = mr.simulate(mr.MasonryCase(masonry, 1.5, motion=PULSE, effects=effect(masonry.free[0])))
    alone = mr.simulate(
        mr.Case(WALL, 0.0, 1.5, side_stop=False, motion=PULSE, effects=effect(0)), contacts, accuracy=1e-3
    )
    np.testing.assert_allclose(stacked.theta[:, 0], alone.theta, atol=2e-6)
    assert np.abs(alone.theta).max() > 0.01 * WALL.alpha
    assert stacked.plastic == {key: pytest.approx(value, rel=1e-4) for key, value in alone.plastic.items()}


@pytest.mark.parametrize("name", EFFECTS)
def test_an_effect_on_the_upper_of_two_blocks(name):
    """The ledger closes, and the effect is felt."""
    masonry = mr.Masonry.stack([HALF, HALF], k_n=5e8, xi=0.05, friction=0.8)
    upper = masonry.free[1]
    run = mr.simulate(mr.MasonryCase(masonry, 1.2, motion=PULSE, effects=EFFECTS[name](upper)), ledger=True)
    bare = mr.simulate(mr.MasonryCase(masonry, 1.2, motion=PULSE))
    turned_over = run.energy[0] + np.abs(run.ledger.ground).max() + run.ledger.friction.max()
    assert np.abs(run.ledger.residual).max() < 5e-3 * turned_over
    assert np.abs(run.theta - bare.theta).max() > 1e-3


def test_a_thrust_that_overturns_the_upper_block_names_it():
    masonry = mr.Masonry.stack([HALF, HALF], k_n=5e8, xi=0.05)
    upper = masonry.free[1]
    most = HALF.weight * 0.3 / 1.05  # at the centroid of the upper block, about its own toe
    mr.simulate(mr.MasonryCase(masonry, 0.01, effects=mr.Thrust(3.15, 0.4 * most, block=upper)))
    with pytest.raises(ValueError, match=f"the masonry cannot stand: .*{masonry.names[upper]} would fall"):
        mr.simulate(mr.MasonryCase(masonry, 0.01, effects=mr.Thrust(3.15, 1.05 * most, block=upper)))


def test_two_blocks_beside_a_rough_wall_stand():
    """Friction at the side could carry them. No such pose is found, and the one in which it does not is."""

    def block(left, right, low, high, fixed=False):
        return mr.Polygon([(left, low), (right, low), (right, high), (left, high)], fixed=fixed)

    behind = block(-1, -0.3, 0, 9, True)
    blocks = (block(-1, 2, -1, 0, True), behind, block(-0.3, 0.3, 0, 4.5), block(-0.3, 0.3, 4.5, 9))
    run = mr.simulate(mr.MasonryCase(mr.Masonry(blocks, k_n=2e8, friction=0.7), 0.2))
    assert run.outcome is mr.Outcome.AT_REST
    assert run.pose[0, :, 1] == pytest.approx([-8.829e-4, -1.3244e-3], rel=1e-3)


def test_left_end_of_a_block():
    trapezium = mr.Polygon([(0, 0), (4, 0), (3, 2), (1, 2)])
    assert [trapezium.left_at(z) for z in (0.0, 1.0, 2.0, 9.0)] == [0.0, 0.5, 1.0, 0.0]


@pytest.mark.parametrize("in_space", [False, True])
def test_an_added_mass_weighs_on_its_block(in_space):
    """Its weight acts at its place and turns the block about its centroid."""
    if in_space:
        masonry, place = mr.Masonry.box((0.6, 0.4, 2.0), k_n=1e9), {"at": (0.15, 0.1, 1.8)}
        expected = [0, 0, -800 * mr.GRAVITY, -800 * mr.GRAVITY * 0.1, 800 * mr.GRAVITY * 0.15, 0]
    else:
        masonry, place = mr.Masonry.stack([WALL], k_n=5e8), {"height": 4.0, "offset": 0.15}
        expected = [0, -800 * mr.GRAVITY, 800 * mr.GRAVITY * 0.15]
    (block,) = masonry.free
    np.testing.assert_allclose(applied(masonry, (mr.AddedMass(800.0, block=block, **place),)), [expected], atol=1e-9)


def test_ties_pull_their_blocks_towards_their_anchors():
    """By 1 N each, with moments about the centroids; in space towards x, in the plane about y."""
    plane = mr.Masonry.stack([HALF, HALF], k_n=5e8)
    found = pulls_of(plane, [mr.Tie(3.0, 1e6, block=2), mr.Tie(3.0, 1e6, block=2, anchor_block=1)])
    np.testing.assert_allclose(found[0], [[0, 0, 0], [-1, 0, 3.15 - 3.0]], atol=1e-12)
    np.testing.assert_allclose(found[1, 0] + found[1, 1], [0, 0, 3.15 - 1.05], atol=1e-12)
    space = mr.Masonry.box((0.6, 0.4, 2.0), k_n=1e9)
    (block,) = space.free
    tie = mr.Tie(stiffness=1e6, at=(0.3, 0.1, 1.8), anchor=(0.3, 4.1, 1.8), block=block)
    np.testing.assert_allclose(pulls_of(space, [tie]), [[[0, 1, 0, -0.8, 0, 0.3]]], atol=1e-12)


@pytest.mark.parametrize(("apart", "taken"), [(0.009, False), (0.01, True), (0.015, True)])
def test_an_anchor_in_space_is_a_centimetre_off_at_least(apart, taken):
    masonry = mr.Masonry.box((0.6, 0.4, 2.0), k_n=1e9)
    tie = mr.Tie(stiffness=1e6, at=(0.0, 0.0, 1.8), anchor=(apart, 0.0, 1.8), block=masonry.free[0])
    if taken:
        assert len(mr.MasonryCase(masonry, 1.0, effects=tie).effects) == 1
        return
    with pytest.raises(ValueError, match=r"lies at the point that is held; the least is 0.01 m"):
        mr.MasonryCase(masonry, 1.0, effects=tie)


MASONRY = mr.Masonry.stack([HALF, HALF], k_n=5e8, xi=0.05)


@pytest.mark.parametrize(
    ("effect", "complaint"),
    [
        (mr.Tie(3.0, 1e6, block=7), r"effects\[0\], block = 7 is outside the valid range 0 to 2"),
        (mr.Tie(0.0, 1e6, block=0), r"effects\[0\] on .*: this block is fixed; the valid ones are \[1, 2\]"),
        (mr.Tie(3.0, 1e6, block=1), r"effects\[0\] on block_0, height = 3 m is outside the valid range"),
        (mr.Load(1e3, 3.0, 0.4, block=2), r"effects\[0\] on block_1, offset = 0.4 m is outside .* -0.3 to 0.3 m"),
        (3, r"effects = 3 of type int is not a sequence"),
        ([math.nan], r"effects\[0\] = nan of type float is not a Tie"),
    ],
)
def test_effects_that_are_not_on_their_block(effect, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.MasonryCase(MASONRY, 1.0, effects=effect)


def test_a_start_does_not_say_what_ties_have_yielded():
    case = mr.MasonryCase(MASONRY, 0.1, effects=mr.Tie(3.0, 1e6, strength=1e3, block=2))
    with pytest.raises(ValueError, match=r"do not say how far .* has yielded"):
        mr.simulate(case, start=(np.zeros((2, 3)), np.zeros((2, 3))))


def test_ties_that_do_not_yield_go_with_a_start():
    case = mr.MasonryCase(MASONRY, 0.01, effects=mr.Tie(3.0, 1e6, block=2))
    assert np.array_equal(mr.simulate(case, start=(np.zeros((2, 3)), np.zeros((2, 3)))).pose[0], np.zeros((2, 3)))


def test_a_small_mass_counts_as_a_large_one():
    """Half a kilogram on a brick of a kilogram, beside its centroid."""
    brick = mr.Polygon([(0, 0), (0.1, 0), (0.1, 0.1), (0, 0.1)], density=100.0)
    masonry = mr.Masonry([mr.Polygon([(-1, -1), (1, -1), (1, 0), (-1, 0)], fixed=True), brick], k_n=1e7)
    mass, centroids, inertia = with_added_masses(masonry, (mr.AddedMass(0.5, 0.09, 0.03, block=1),))
    assert mass[1] == pytest.approx(1.5)
    np.testing.assert_allclose(centroids[1], [0.05 + 0.03 / 3, 0.05 + 0.04 / 3])
    assert inertia[1] == pytest.approx(0.1**2 / 6 + 1.0 * 0.5 / 1.5 * 0.05**2)
