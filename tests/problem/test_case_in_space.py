"""Cases of masonry in space: what moves it, and the effects that it carries at points."""

import math

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.masonry.effects import applied as applied_to
from mjrock.problem.masonry.effects import point_of_effect
from mjrock.study.campaign.task import fingerprint

box = mr.Polyhedron.box
MASONRY = mr.Masonry(
    [
        box((4, 4, 1), (0, 0, -0.5), fixed=True, name="ground"),
        box((0.6, 0.4, 2.0), (0, 0, 1), name="a"),
        box((0.4, 0.4, 1.0), (0, 0, 2.5)),
    ],
    k_n=1e8,
)
PLANE = mr.Masonry.stack([mr.Block(0.3, 1.0)], 1e8)
MOTION = mr.GroundMotion.half_sine(3.0, 0.1)
TOP = (0.2, 0.1, 3.0)


def case(*effects, masonry=MASONRY, **options):
    return mr.MasonryCase(masonry, 1.0, effects=effects, **options)


def test_a_case_in_space_has_three_motions_and_six_velocities():
    velocity = np.arange(12.0).reshape(2, 6)
    shaken = case(motion=MOTION, transverse=MOTION, vertical=MOTION, velocity=velocity)
    assert shaken == case(motion=MOTION, transverse=MOTION, vertical=MOTION, velocity=velocity)
    assert shaken != case(motion=MOTION, vertical=MOTION, velocity=velocity)
    assert hash(shaken) == hash(case(motion=MOTION, transverse=MOTION, vertical=MOTION))
    assert fingerprint(shaken) != fingerprint(case(motion=MOTION, vertical=MOTION, velocity=velocity))
    with pytest.raises(ValueError, match=r"velocity has the shape \(2, 3\); \(2, 6\) is needed"):
        case(velocity=np.zeros((2, 3)))
    with pytest.raises(ValueError, match="transverse is for masonry in space"):
        case(masonry=PLANE, transverse=MOTION)


def test_effects_act_at_points():
    tie = mr.Tie(stiffness=1e6, at=TOP, anchor=(0.2, 3.1, 7.0), slack=0.1, block=2)
    assert point_of_effect(tie).tolist() == list(TOP)
    assert (tie.height, tie.reach) == (3.0, pytest.approx(5.1))
    behind = mr.Tie(stiffness=1e6, at=TOP, length=3.0, block=2, anchor_height=7.0)
    assert behind.anchor_of(point_of_effect(behind)) == pytest.approx([-2.8, 0.1, 7.0])
    assert behind.reach == 5.0
    bound = mr.Damper(c=1e3, at=TOP, anchor=(0.2, 0.1, 2.0), anchor_block=1, block=2)
    assert bound.anchor_of(point_of_effect(bound)) == pytest.approx([0.2, 0.1, 2.0])
    thrust = mr.Thrust(force=5.0, at=TOP, direction=(0, 3, 4), block=2)
    assert thrust.force_vector == pytest.approx([0, 3, 4])
    assert mr.Thrust(force=5.0, at=TOP).force_vector == (5, 0, 0)
    load, mass = mr.Load(force=10.0, at=TOP, block=2), mr.AddedMass(mass=2.0, at=(0, 0, 9.0), block=1)
    kept = case(tie, behind, bound, thrust, load, mass).effects
    applied = applied_to(MASONRY, kept)
    assert applied[0] == pytest.approx([0, 0, -2 * mr.GRAVITY, 0, 0, 0])
    assert applied[1, :3] == pytest.approx([0, 3, 4 - 10])
    assert applied[1, 3:] == pytest.approx(np.cross([0.2, 0.1, 0.5], [0, 3, -6]))


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: case(mr.Tie(1.0, 1e6, block=1)), r"effects\[0\] on a, height = 1 m is for masonry in the plane"),
        (lambda: case(mr.Load(1.0, offset=0.1, at=TOP, block=2)), "offset = 0.1 m goes with a height"),
        (lambda: case(mr.Load(1.0, at=(0.2015, 0.1, 3.0), block=2)), r"m lies 0.0015 m outside the block"),
        (lambda: case(mr.Load(1.0, at=(0.3, 0.1, 3.0), block=2)), r"at = \(0.3, 0.1, 3.0\) m lies 0.1 m outside"),
        (lambda: case(mr.Tie(stiffness=1e6, at=TOP, block=2, anchor_block=1)), "anchor_block = 1 needs anchor="),
        (lambda: case(mr.Damper(c=1.0, at=TOP, block=2, anchor_block=2, anchor=TOP)), "2 is the block itself"),
        (lambda: case(mr.Damper(c=1.0, at=TOP, block=2, anchor_block=3, anchor=TOP)), "anchor_block = 3 is outside"),
        (lambda: case(mr.Damper(c=1.0, at=TOP, block=2, anchor=TOP)), "lies at the point that is held"),
        (lambda: case(mr.Damper(c=1.0, at=TOP, block=2, anchor_block=1, anchor=(0, 0, 2.5))), "anchor = .* outside"),
        (lambda: case(mr.Tie(stiffness=1e6, at=TOP, block=1), masonry=PLANE), "at = .* 3 numbers; this masonry takes"),
        (
            lambda: mr.Case(mr.Block(0.3, 1.0), 0.0, 1.0, effects=mr.Load(1.0, at=(0, 0, 1))),
            "at = .* is for masonry; leave it out",
        ),
        (lambda: mr.Thrust(force=1.0, at=TOP, direction=(0, 0, 0)), "direction of the thrust = .* no length"),
        (lambda: mr.Tie(2.0, 1e6, at=TOP), "height of the tie = 2.0 m is given with at"),
        (lambda: mr.Tie(stiffness=1e6), "height of the tie = None is not a real number"),
        (lambda: mr.AddedMass(1.0, at=(0, 0, math.inf)), "at of the added mass holds a value that is not finite"),
        (lambda: case(mr.Load(1.0, at=(0, 0), block=2)), "has 2 numbers; this masonry takes"),
        (lambda: mr.Load(1.0, at=(0, 0, 0, 0)), r"at of the load has the shape \(4,\)"),
        (lambda: case(supports={"ground": ([0, 1], [0, 1], [0, 1])}), r"is not \(t, dx, dy, dz\)"),
    ],
)
def test_what_cannot_be_is_refused_by_name(make, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        make()


def test_supports_move_along_three_axes():
    (support,) = case(supports={"ground": ([0, 1], [0, 1], [0, 2], [0, 3])}).supports
    assert support.displacement.tolist() == [[0, 0, 0], [1, 2, 3]]
