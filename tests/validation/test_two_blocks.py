"""Two free-standing blocks one on the other, against an explicit integration of the same contacts."""

import numpy as np
import pytest
from explicit_blocks import explicit
from scenes import course, fixed_steps, two_blocks

import mjrock as mr
from mjrock.engine.model import engine_of
from mjrock.engine.stepping import fitted_steps

PULSE = mr.GroundMotion.sine(2.0, 0.7)


def fitted(scene, accuracy):
    """Times and rotations of both blocks."""
    shaken = course(scene, duration=1.0, motion=PULSE)
    with engine_of(scene) as engine:
        engine.place(shaken)
        steps = fitted_steps(engine, scene, shaken, accuracy)
    return steps.t, steps.pose[:, [2, 5]]


@pytest.fixture(scope="module")
def reference():
    scene = two_blocks()
    t, pose = explicit(scene, course(scene, duration=1.0, motion=PULSE), 1e-6, 100)
    return t, pose[:, :, 2]


@pytest.mark.parametrize("accuracy", [1e-3, 1e-4])
def test_rotations_within_a_ten_thousandth_of_the_peak(reference, accuracy):
    times, exact = reference
    t, theta = fitted(two_blocks(), accuracy)
    for body in range(2):
        peak = np.abs(exact[:, body]).max()
        assert peak > 0.02
        assert np.abs(np.interp(times, t, theta[:, body]) - exact[:, body]).max() < 1e-4 * peak


def test_a_fixed_step_follows_too(reference):
    times, exact = reference
    scene = two_blocks()
    shaken = course(scene, duration=1.0, motion=PULSE)
    steps = fixed_steps(scene, shaken, 1e-4)
    for body in range(2):
        found = np.interp(times, steps.t, steps.pose[:, 3 * body + 2])
        assert np.abs(found - exact[:, body]).max() < 3e-3 * np.abs(exact[:, body]).max()


def test_a_joint_without_friction_fails(reference):
    """The twin that must fail: the upper block slips off the motion."""
    times, exact = reference
    t, theta = fitted(two_blocks(friction=0.05), 1e-3)
    assert np.abs(np.interp(times, t, theta[:, 1]) - exact[:, 1]).max() > 0.1 * np.abs(exact[:, 1]).max()
