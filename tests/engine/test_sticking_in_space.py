"""Bodies of space are put back along both tangents of the face on which their deepest point sticks."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from space_scenes import box, course, fitted, fixed

import mjrock as mr
from mjrock.engine.rows import Step
from mjrock.engine.sticking import Joints, StepMotion, deepest_point, rolling_distance, tangents_at
from mjrock.geometry.frames import SPACE, frames_of
from mjrock.geometry.kinematics import depth, meeting
from mjrock.geometry.poses import moved

SIZE, TURN = (0.6, 0.4, 2.0), Rotation.from_euler("z", 37, degrees=True)
EDGE, CORNER = 0.0, 0.5
"""Plan angle of a fall about an edge and about a corner [rad]."""
WALL = mr.Block(b=0.3, h=1.2)


def on_its_toe(scene, angle, plan):
    """Pose of a box tilted by an angle [rad] towards a plan angle, and the point on which it stands."""
    tilt = Rotation.from_rotvec(angle * np.array([-math.sin(plan), math.cos(plan), 0.0]))
    at = np.array(scene.contacts.at)
    toe = int(tilt.apply(at)[:, 2].argmin())
    away = at[toe] - tilt.apply(at[toe])
    return scene.lowered(np.array([[*away, *np.roll(tilt.as_quat(), 1)]])), toe


def drift(steps, at):
    """How far a point of a body has moved over level ground [m]."""
    turns = Rotation.from_quat(np.roll(steps.pose[:, 3:], -1, axis=1))
    path = steps.pose[:, :3] + turns.apply(np.array(at))
    return np.hypot(*(path - path[0])[:, :2].T).max()


@pytest.mark.parametrize("plan", [EDGE, CORNER], ids=["edge", "corner"])
def test_a_toe_stays_where_it_stuck(plan):
    """On a stiff base it rolls by less than 0.1 um. The twin: in a fixed step it drifts, to first order in the step."""
    scene = box(SIZE, k_n=1e11, friction=5.0)
    pose, toe = on_its_toe(scene, 0.12, plan)
    start, at = course(scene, 0.3, pose=pose), scene.contacts.at[toe]
    for accuracy in (1e-2, 1e-3, 1e-4):
        assert drift(fitted(scene, start, accuracy), at) < 1e-7
    coarse, fine = (drift(fixed(scene, start, h), at) for h in (2e-3, 1e-3))
    assert coarse / fine == pytest.approx(2, rel=0.03)
    assert fine > 1e-6


@pytest.mark.parametrize("plan", [EDGE, CORNER], ids=["edge", "corner"])
def test_it_does_not_matter_how_the_block_lies_in_plan(plan):
    """To rounding, over a fall and its impact."""
    plain, turned = box(SIZE, friction=5.0), box(SIZE, friction=5.0, turned=TURN.as_matrix())
    pose = np.array(on_its_toe(plain, 0.12, plan)[0][0])
    other = np.concatenate([TURN.apply(pose[:3]), pose[3:4], TURN.apply(pose[4:])])
    first, second = (fitted(s, course(s, 0.5, pose=p), 1e-2) for s, p in ((plain, pose), (turned, other)))
    np.testing.assert_allclose(TURN.inv().apply(second.pose[:, :3]), first.pose[:, :3], rtol=0, atol=1e-9)


def against_a_side(k_n):
    """A wall beside a smooth side stop in the plane, and the same as prisms in space, each with its start."""
    stack = mr.Masonry.stack([WALL], k_n, side_stop=True, friction=5.0)
    angle, toe = 0.5 * WALL.alpha, np.array([WALL.b, 0.0, -WALL.h])
    tilt = Rotation.from_euler("y", angle)
    away = toe - tilt.apply(toe)
    starts = [[*away[[0, 2]], angle]], [[*away, *np.roll(tilt.as_quat(), 1)]]
    for blocks, pose in zip((stack.blocks, [mr.Polyhedron.prism(b) for b in stack.blocks]), starts, strict=True):
        masonry = mr.Masonry(
            tuple(blocks), k_n, lambda joint: 0.0 if "side" in joint.name else 5.0, xi=0.02, frequency=100.0
        )
        scene = mr.masonry_scene(mr.MasonryCase(masonry, 1.0))
        yield masonry, (scene.lowered(np.array(pose)), np.zeros((1, len(scene.bodies.masses))))


def test_rebounds_from_a_side_are_those_of_the_plane():
    """A toe that had drifted would be pressed against the side: the first rebound would be 4 % off."""
    planar, space = (
        mr.simulate(mr.MasonryCase(masonry, 1.2), start=start).pose[:, 0] for masonry, start in against_a_side(5e9)
    )
    theta = 2 * np.arctan2(space[:, 5], space[:, 3])
    assert np.abs(theta[700:]).max() > 0.02 * WALL.alpha
    np.testing.assert_allclose(theta, planar[:, 2], rtol=0, atol=1e-4 * WALL.alpha)


def test_a_point_rolls_as_its_body_turns_over_its_face():
    """By half the penetration times the rotation vector of one body over the other, along each tangent."""
    drums = mr.Masonry.column(0.6, 2.0, 2, k_n=1e9, friction=0.7)
    scene = mr.masonry_scene(mr.MasonryCase(drums, 1.0))
    start = np.zeros(14)
    start[3], start[10], start[2], start[9] = 1.0, 1.0, -0.004, -0.011
    turns = 1e-4 * np.array([[2.0, -1.0, 0.5], [-0.5, 1.5, 0.3]])
    motion = np.zeros(12)
    motion[3:6], motion[9:12] = turns
    pose = moved(start, motion, SPACE)
    frames = frames_of(start, SPACE), frames_of(pose, SPACE)
    step = StepMotion(Step(1e-3, np.zeros(0), np.zeros(0)), 1.0, motion, motion, start, pose, *frames)
    for i in (int(np.flatnonzero(scene.contacts.body == body)[0]) for body in (0, 1)):
        meets = meeting(scene.places, i, step.frames)
        pressed = 0.5 * (depth(scene.places, i, step.from_frames) + depth(scene.places, i, step.frames))
        relative = turns[0] if scene.contacts.body[i] == 0 else turns[1] - turns[0]
        expected = -0.5 * pressed * np.cross(relative, meets.normal)
        ways = tangents_at(scene.places, i, step.frames)
        np.testing.assert_allclose([*ways, meets.normal] @ np.transpose([*ways, meets.normal]), np.eye(3), atol=1e-14)
        found = [rolling_distance(scene.places, i, meets, way, step) for way in ways]
        np.testing.assert_allclose(found, np.array(ways) @ expected, rtol=1e-6)
        assert pressed > 1e-3


def test_of_two_ends_of_an_edge_it_is_the_one_that_stuck():
    """As long as the other is deeper by no more than rounding."""
    scene = box(SIZE)
    joints = Joints.of_scene(scene)
    assert joints.anchor.shape == (1, 2)
    for roll, expected in ((1e-11, (2, 3)), (-1e-11, (2, 3)), (1e-5, (2, 2)), (-1e-5, (3, 3))):
        turn = Rotation.from_euler("xyz", (roll, 0.01, 0.0))
        pose = np.array([0.0, 0.0, -4e-3, *np.roll(turn.as_quat(), 1)])
        for stuck, point in enumerate(expected, start=2):
            joints.stuck[0] = stuck
            assert deepest_point(scene.places, joints, 0, frames_of(pose, SPACE)) == point
