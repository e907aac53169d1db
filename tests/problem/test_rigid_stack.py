"""A stack taken as one rigid body, and the restitution of rocking theory for it."""

import math

import numpy as np
import pytest
from masonry_blocks import GROUND, box, columns

import mjrock as mr
from mjrock.problem.masonry.rigid_stack import RigidStack
from mjrock.theory.impact import rigid_rocking

WALL = mr.Block(0.3, 2.1, length=1.5, density=1800.0)


def stack(blocks, **options):
    part = mr.Block(0.3, 2.1 / blocks, length=1.5, density=1800.0)
    return mr.Masonry.stack([part] * blocks, 1e9, **options)


@pytest.mark.parametrize("blocks", [1, 2, 5])
def test_equal_blocks_are_their_wall(blocks):
    pile = RigidStack.from_masonry(stack(blocks))
    assert pile.masses.sum() == pytest.approx(WALL.mass)
    assert pile.inertia == pytest.approx(WALL.inertia)
    assert pile.centroid == pytest.approx([0, 2.1], abs=1e-12)
    assert (pile.alpha(1), pile.alpha(-1)) == pytest.approx((WALL.alpha, WALL.alpha))
    assert pile.lever(1) == pytest.approx(0.3)
    assert (pile.wall.b, pile.wall.h, pile.wall.mass) == pytest.approx((0.3, 2.1, WALL.mass))
    assert pile.outwards == 1


def test_it_rises_to_the_rotation_that_was_asked_for():
    """The energy of the start is that of the wall at the rotation, and the time that of Housner's quarter period."""
    pile = RigidStack.from_masonry(stack(3))
    velocity, swing = pile.rising(0.4)
    rate = velocity[0, 2]
    assert (velocity[:, 2] == rate).all()
    assert velocity[:, 0] == pytest.approx(rate * np.array([0.7, 2.1, 3.5]))
    assert velocity[:, 1] == pytest.approx(rate * 0.3)  # about the right edge
    assert 0.5 * WALL.toe_inertia * rate**2 == pytest.approx(float(WALL.potential_energy(0.4 * WALL.alpha)))
    assert swing == pytest.approx(2 * math.acosh(1 / 0.6) / WALL.p)


def test_two_blocks_that_are_not_alike_and_not_in_line():
    parts = [box(-0.5, 0.5, 0, 1), box(-0.1, 0.5, 1, 3, density=1000.0)]
    pile = RigidStack.from_masonry(mr.Masonry([GROUND, *parts]))
    assert pile.centroid == pytest.approx([0.2 * 1200 / 3200, (0.5 * 2000 + 2 * 1200) / 3200])
    x, z = pile.centroid
    far = 2000 * (x**2 + (z - 0.5) ** 2) + 1200 * ((0.2 - x) ** 2 + (2 - z) ** 2)
    assert pile.inertia == pytest.approx(2000 * 2 / 12 + 1200 * (0.36 + 4) / 12 + far)
    assert (pile.lever(1), pile.lever(-1)) == pytest.approx((0.5 - x, 0.5 + x))
    assert pile.alpha(1) == pytest.approx(math.atan((0.5 - x) / z))


@pytest.mark.parametrize("top", [None, 3.6])
@pytest.mark.parametrize("blocks", [1, 3])
def test_the_restitution_of_a_stack_is_that_of_its_wall(blocks, top):
    side_stop = True if top is None else mr.SideStop(top)
    e, expected = (
        rigid_rocking(RigidStack.from_masonry(stack(blocks, side_stop=side_stop))),
        mr.Restitution.from_geometry(WALL, top),
    )
    assert (e.base, e.side) == pytest.approx((expected.base, expected.side))
    alone = rigid_rocking(RigidStack.from_masonry(stack(blocks)))
    assert (alone.base, alone.side) == (pytest.approx(expected.base), 0)


def test_a_side_stop_on_the_right_is_the_mirror_image():
    parts = [box(-0.3, 0.3, 0, 2), box(-0.3, 0.3, 2, 4)]
    left = mr.Masonry([GROUND, *parts, box(-1, -0.3, 0, 4, fixed=True, name="side")])
    right = mr.Masonry([GROUND, *parts, box(0.3, 1, 0, 4, fixed=True, name="side")])
    one, other = RigidStack.from_masonry(left), RigidStack.from_masonry(right)
    assert (one.outwards, other.outwards) == (1, -1)
    assert one.rising(0.5)[0] == pytest.approx(other.rising(0.5)[0] * [-1, 1, -1])
    assert rigid_rocking(one).base == pytest.approx(rigid_rocking(other).base)
    assert rigid_rocking(one).side == pytest.approx(rigid_rocking(other).side)


def test_a_stack_that_stands_elsewhere_is_the_same():
    def moved(by):
        blocks = [mr.Polygon(b.corners + by, fixed=b.fixed, name=b.name) for b in stack(2, side_stop=True).blocks]
        return RigidStack.from_masonry(mr.Masonry(blocks))

    here, there = moved(np.zeros(2)), moved(np.array([7.0, 11.0]))
    assert there.centroid == pytest.approx(here.centroid)
    assert there.inertia == pytest.approx(here.inertia)
    assert there.rising(0.5)[0] == pytest.approx(here.rising(0.5)[0])
    assert rigid_rocking(there).side == pytest.approx(rigid_rocking(here).side)


def test_the_stack_without_its_side_stop():
    masonry = stack(2, side_stop=True, k_side=3e8, side_friction=0.4, friction=0.8)
    pile = RigidStack.from_masonry(masonry)
    assert [masonry.joints[i].name for i in pile.sides] == ["side|block_0", "side|block_1"]
    alone = pile.free_standing
    assert alone.names == ("ground", "block_0", "block_1")
    assert (alone.joint_stiffness == 1e9).all()
    assert (alone.joint_friction == 0.8).all()
    assert RigidStack.from_masonry(alone).free_standing is alone


@pytest.mark.parametrize(
    ("masonry", "complaint"),
    [
        (lambda: mr.Masonry.arch(5, 0.75), "masonry is not a stack, in which every block stands on one other block"),
        (lambda: mr.Masonry([GROUND, box(-3, -2, 0, 3), box(2, 3, 0, 3)]), "masonry is 2 stacks on fixed blocks"),
        (
            lambda: mr.Masonry(
                [GROUND, box(0, 1, 0, 4), box(-1, 0, 0, 4, fixed=True), box(1, 2, 0, 4, fixed=True, name="b")]
            ),
            "masonry has side stops on both sides",
        ),
        (lambda: mr.Masonry([GROUND, box(0, 1, 0, 0.1)]), "slenderness h/b = 0.1 is outside the valid range"),
    ],
)
def test_what_is_no_stack_is_refused(masonry, complaint):
    with pytest.raises(ValueError, match=complaint):
        RigidStack.from_masonry(masonry())


def test_drums_flatter_than_wide_are_a_stack_too():
    assert RigidStack.from_masonry(columns(14)).wall.h == pytest.approx(2.1)
