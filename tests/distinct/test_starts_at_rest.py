"""Masonry that starts at rest stays there, where friction holds it and where joints are handed over at once."""

import math

import numpy as np
import pytest
from masonry_blocks import box

import mjrock as mr
from mjrock.distinct.search import contact_search

SLOPE = 0.3
K_N = 1e7
BOX = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
BENT = ((0.0, 0.0), (0.9, 0.0), (1.4, 0.01), (1.4, 1.0), (0.0, 1.0))
"""A block whose base goes on after 0.9 m with a side that rises by a fiftieth."""


def on_a_slope(corners, *, in_space=False, **options):
    """A block on a slope that friction holds, on joints that its weight closes by 2 mm."""
    turn = np.array([[math.cos(SLOPE), math.sin(SLOPE)], [-math.sin(SLOPE), math.cos(SLOPE)]])
    ground = np.array(box(-2, 2, -1, 0).corners)
    blocks = [mr.Polygon(ground @ turn, fixed=True), mr.Polygon(np.array(corners) @ turn)]
    blocks = [mr.Polyhedron.prism(block) for block in blocks] if in_space else blocks
    return mr.Masonry(blocks, k_n=K_N, friction=0.7, **options)


@pytest.mark.parametrize("k_s", [None, 0.5 * K_N])
@pytest.mark.parametrize("in_space", [False, True])
def test_friction_acts_halfway_into_the_overlap_in_the_search_for_rest_as_in_the_steps(in_space, k_s):
    """Else its lever is off by half of what the joint has closed by, 1 mm, which turns the block by some 1e-6. What is
    left is the force that may be missing at rest: 1e-9 of the weight, over the stiffness of the joint."""
    masonry = on_a_slope(BOX, in_space=in_space, k_s=k_s)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.1), output_step=1e-3)
    assert np.abs(run.pose - run.pose[0]).max() < 1e-9 * masonry.blocks[1].mass * mr.GRAVITY / K_N


@pytest.mark.parametrize("in_space", [False, True])
def test_a_joint_that_is_handed_over_at_the_start_keeps_its_friction(in_space, monkeypatch):
    """No step has been made yet, and lines know from the search for rest alone what they carry."""
    monkeypatch.setattr(contact_search, "HANDOVER_OPENING", -1.0)
    masonry = on_a_slope(BOX, in_space=in_space, k_s=0.4 * K_N)  # of no other test, since what stands is kept
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.1), output_step=1e-3, forces=True)
    assert not run.forces.normal.any()  # those of a joint that still serves
    assert np.abs(run.pose - run.pose[0]).max() < 1e-9 * masonry.blocks[1].mass * mr.GRAVITY / K_N


@pytest.mark.parametrize("in_space", [False, True])
def test_a_joint_with_a_side_beside_it_that_is_nearly_flush_serves_while_it_does_not_turn(in_space):
    """It has slid by 0.2 % of its width, which one that turned about its end would have done at 3.6 degrees; half the
    angle to the next side is 0.6. Its shear force is that of the weight along the slope, once it has come to rest."""
    masonry = on_a_slope(BENT, in_space=in_space, k_s=0.5 * K_N, xi=1.0)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.5, settled=False), output_step=0.01, forces=True)
    weight = masonry.blocks[1].mass * mr.GRAVITY
    assert np.abs(run.forces.shear[-1]).max() == pytest.approx(weight * math.sin(SLOPE), rel=1e-3)
    assert run.forces.normal[-1, 0] == pytest.approx(weight * math.cos(SLOPE), rel=1e-3)
