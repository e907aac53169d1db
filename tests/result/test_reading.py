"""What is read from a motion, whichever solver found it."""

from functools import cache

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.result.motion import SampledMotion
from mjrock.result.reading import TIME_AT_REST, ContactHistory, masonry_reading, wall_reading
from mjrock.scene.masonry import masonry_scene

BOX = mr.Masonry([GROUND, box(-0.3, 0.3, 0, 0.5, name="left"), box(1.0, 1.6, 0, 0.5, name="right")], k_n=1e8)
CASE = mr.MasonryCase(BOX, 2.0)


@cache
def scene():
    return masonry_scene(CASE)


def read(t, displaced):
    """The reading of two blocks at rest that are displaced by as much at the times [m, m, rad], shape (n, 2, 3)."""
    motion = SampledMotion(scene().at_rest + displaced, np.zeros((len(t), 2, 3)), np.zeros(len(t)))
    return masonry_reading(CASE, scene(), t, motion)


def test_the_base_is_displaced_from_where_the_run_began_until_the_duration_is_over(two_sided, contacts):
    t = np.linspace(0.0, two_sided.duration + 0.5, 1001)
    pose = np.zeros((len(t), 1, 3))
    pose[:, 0, 0] = 0.01 + 0.002 * t
    motion = SampledMotion(pose, np.zeros_like(pose), np.zeros(len(t)))
    reading = wall_reading(two_sided, contacts, t, motion)
    assert reading.stats["base_displacement"] == pytest.approx(0.002 * two_sided.duration)
    assert f"{two_sided.duration:.4g} s" in reading.message
    np.testing.assert_allclose(reading.slip, pose[:, 0, 0] / two_sided.block.half_base)
    assert reading.count == len(t)
    pose[len(t) // 2 :, 0, 2] = 1.0  # lies
    assert wall_reading(two_sided, contacts, t, SampledMotion(pose, 0 * pose, np.zeros(len(t)))).count == len(t) // 2


def test_a_run_that_ends_early_names_the_blocks_that_went_far():
    """A fixed step may end up to half of it before the duration."""
    far = np.zeros((3, 2, 3))
    far[-1, :, 0] = 0.04, 0.09
    reading = read(np.array([0.0, 0.5, 1.0]), far)
    assert dict(reading.joints.fallen) == {"right": 1.0}
    assert "The motion was followed for 1 s" in reading.message
    far[-1, 0, 0] = 0.05
    assert dict(read(np.array([0.0, 0.5, 1.0]), far).joints.fallen) == {"left": 1.0, "right": 1.0}
    for turned, names in ((0.14, {"right"}), (0.16, {"left", "right"})):  # times 0.3 m, half the width
        far[-1, 0] = 0.0, 0.0, turned
        assert set(read(np.array([0.0, 0.5, 1.0]), far).joints.fallen) == names
    for end, falls in ((1.89, True), (1.91, False)):
        assert bool(read(np.array([0.0, end - 0.2, end]), far).joints.fallen) is falls


@pytest.mark.parametrize(("left", "outcome"), [(True, "AT_REST"), (False, "TIME_ENDED")])
def test_blocks_that_left_joints_and_lie_still_have_come_to_rest(left, outcome):
    """Their energy is below that at rest, so that it says nothing."""
    t = np.linspace(0.0, 2.0, 201)
    pose = np.tile(scene().at_rest, (len(t), 1, 1))
    velocity = np.zeros_like(pose)
    velocity[t < 2.0 - 1.5 * TIME_AT_REST] = 1.0
    history = ContactHistory(np.full(len(scene().contacts.joint), 0.3), left, {})
    motion = SampledMotion(pose, velocity, np.full(len(t), -1e6))
    reading = masonry_reading(CASE, scene(), t, motion, history)
    assert reading.outcome is mr.Outcome[outcome]
    np.testing.assert_array_equal(reading.joints.opening, 0.3)
    velocity[t > 2.0 - 0.5 * TIME_AT_REST] = 1.0
    assert masonry_reading(CASE, scene(), t, motion, history).outcome is mr.Outcome.TIME_ENDED


def test_a_block_beside_ground_that_has_sunk_as_far_has_not_fallen():
    """It has left its joint, and is as high above the ground as at rest."""
    t, sunk = np.linspace(0.0, 2.0, 5), np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    case = mr.MasonryCase(BOX, 2.0, supports={"ground": (t, 0 * t, -sunk)})
    pose = np.tile(scene().at_rest, (len(t), 1, 1))
    pose[:, :, 1] -= sunk[:, None]
    pose[:, 1, 0] += 2.0
    for below, fallen in ((0.2, {}), (0.3, {"right": 2.0})):  # half its height is 0.25 m
        pose[-1, 1, 1] = scene().at_rest[1, 1] - sunk[-1] - below
        history = ContactHistory(np.zeros(len(scene().contacts.joint)), True, {})
        reading = masonry_reading(case, scene(), t, SampledMotion(pose, 0 * pose, np.zeros(len(t))), history)
        assert dict(reading.joints.fallen) == fallen
