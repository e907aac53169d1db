"""What ties and friction dampers pull at poses that are given."""

import math

import numpy as np
import pytest

import mjrock as mr
from mjrock.result.bodies import BodyMotion
from mjrock.result.ties import Plastic, motion_of_ties

WALL = mr.Block.from_size(0.6, 4.2)
T = np.linspace(0.0, 1.0, 6)


def pulled(effect, moved, ended=None):
    """The link of a wall that is moved by so much along x."""
    case = mr.Case(WALL, 0.0, 1.0, side_stop=False, effects=effect)
    (name,) = case.springs
    pose = np.zeros((len(T), 1, 3))
    pose[:, 0, 0] = moved
    return motion_of_ties(BodyMotion(case, T, pose), {} if ended is None else {name: ended})[name]


@pytest.mark.parametrize("slip", [0.5, 5e3])
def test_a_friction_damper_of_any_force_slips_both_ways(slip):
    """Its force is that of the spring until it slips, and the slider follows by what is beyond."""
    u = slip / 1e5
    motion = pulled(mr.FrictionDamper(2.0, 1e5, slip), u * np.array([0.0, 3.0, 2.0, 1.0, -1.0, 0.0]))
    np.testing.assert_allclose(motion.force, slip * np.array([0.0, 1.0, 0.0, -1.0, -1.0, 0.0]), atol=1e-9 * slip + 1e-8)
    np.testing.assert_allclose(motion.plastic, u * np.array([0.0, 2.0, 2.0, 2.0, 0.0, 0.0]), atol=1e-13)
    assert motion.largest_force == pytest.approx(slip)
    assert motion.broken == math.inf


def test_a_tie_pulls_with_what_it_holds_beyond_its_slack_until_it_breaks():
    """Slack of 10 mm, yield at 5 mm more, break at 20 mm more than that."""
    tie = mr.Tie(2.0, 1e6, 0.01, 5e3, ultimate=0.02)
    moved = np.array([0.0, 0.012, 0.025, 0.02, 0.04, 0.0])
    whole = pulled(tie, moved)
    np.testing.assert_allclose(whole.force, [0.0, 2e3, 5e3, 0.0, 5e3, 0.0], atol=1e-6)
    np.testing.assert_allclose(whole.plastic, [0.0, 0.0, 0.01, 0.01, 0.02, 0.02], atol=1e-12)
    assert (whole.largest_force, whole.broken) == (pytest.approx(5e3), math.inf)
    broken = pulled(tie, moved, Plastic(0.02, 100.0, broken=0.7))
    np.testing.assert_allclose(broken.force, [0.0, 2e3, 5e3, 0.0, 0.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(broken.plastic, [0.0, 0.0, 0.01, 0.01, 0.02, 0.02], atol=1e-12)
    np.testing.assert_array_equal(np.isnan(broken.elongation), T > 0.7)
    assert np.nanmax(broken.elongation) == pytest.approx(0.015)
