"""What a stack that rocks as one loses at an impact: MuJoCo against an explicit integration of the same contacts.

The stack is set turning about an edge of its base. Both answers are read alike: the energy of the rigid wall at the
mean rotation, at the second peak over that at the first. The explicit integration has dashpots that push only, and
friction without springs, as the contact law has it.
"""

import math
import warnings

import numpy as np
import pytest
from everyday import slow
from explicit_blocks import explicit
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.problem.masonry.rigid_stack import RigidStack
from mjrock.scene.masonry import masonry_course
from mjrock.theory.impact import rigid_rocking


def lost(pile, pose):
    """Energy lost between the first peak, on the right, and the second, on the left, over that of theory."""
    theta = pose[:, :, 2] @ pile.masses / pile.masses.sum()
    alpha = pile.alpha(1)
    left = (math.cos(alpha + theta.min()) - math.cos(alpha)) / (math.cos(alpha - theta.max()) - math.cos(alpha))
    return (1 - left) / (1 - rigid_rocking(pile).base ** 2)


@pytest.mark.parametrize(
    ("blocks", "matched", "expected"),
    [
        (2, False, 1.0398),
        slow((2, True, 0.9966)),
        slow((4, True, 0.9949)),
        slow((7, False, 1.2307)),
    ],
)
def test_two_solvers_agree_on_what_a_stack_loses(blocks, matched, expected):
    with warnings.catch_warnings(action="ignore"):
        masonry = mr.Masonry.stack([mr.Block(0.3, 2.1 / blocks)] * blocks, 1e9, friction=10.0, law="CALIBRATED")
    if matched:
        masonry = mr.matched_masonry(masonry)
    pile = RigidStack.from_masonry(masonry)
    velocity, swing = pile.rising(0.5)
    case = mr.MasonryCase(masonry, 1.75 * swing, velocity=velocity)
    answer = mr.simulate(case, accuracy=1e-5)
    scene = mr.masonry_scene(case)
    _, poses = explicit(scene, masonry_course(case, scene))
    found, reference = lost(pile, answer.pose), lost(pile, poses)
    assert found == pytest.approx(reference, abs=1e-3)
    assert found == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize("upper", [-1.2, -1.5, -2.5])
def test_strong_dashpots_on_stiff_joints_keep_what_a_rigid_impact_keeps(upper):
    """Two blocks arrive turning about the right edges of both beds, and leave as one or with both joints open."""
    masonry = mr.Masonry([GROUND, box(-0.3, 0.3, 0, 2.1), box(-0.3, 0.3, 2.1, 4.2)], 1e13, 10.0, 5e-4, frequency=1.0)
    arms = masonry.centroids[1:] - [(0.3, 0), (0.3, 2.1)]
    rates = np.array([-1.0, upper])
    before = np.column_stack([rates * arms[:, 1], -rates * arms[:, 0], rates])
    before[1, 0] -= 2.1  # the edge of the upper bed moves with the lower block
    answer = mr.simulate(mr.MasonryCase(masonry, 1e-3, velocity=before), accuracy=1e-5, output_step=1e-5)
    assert answer.energy[-1] / answer.energy[0] == pytest.approx(mr.rigid_impact(masonry, before).kept, abs=5e-4)
