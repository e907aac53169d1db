"""How a body turns, one function at a time, against rotation matrices."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mjrock.distinct import rotation
from mjrock.distinct.rows import kinds
from mjrock.rows import rows

INERTIA = np.array([[3.0, 0.4, -0.3], [0.4, 5.0, 0.7], [-0.3, 0.7, 2.0]])
TURN = Rotation.from_rotvec([0.7, -1.1, 0.4])
A, B = (0.3, -1.2, 2.1), (1.7, 0.6, -0.9)
FLAT, DEEP = (0, 2), (0, 1, 2)
ANGLE = 0.7


def deep(turn=TURN, momentum=B, **more):
    """A body of space after a rotation."""
    x, y, z, w = turn.as_quat()
    inverse = np.linalg.inv(INERTIA)[None]
    body = rows(kinds(3).body, 1, quaternion=[w, x, y, z], inverse_inertia=inverse, momentum=momentum, **more)[0]
    rotation.update_rotation(body)
    return body


def flat(angle=ANGLE, **more):
    """A body of the plane after a rotation, of 4 kg m2."""
    body = rows(kinds(2).body, 1, **{"angle": angle, "inverse_inertia": 0.25} | more)[0]
    rotation.update_rotation(body)
    return body


def in_plane(angle):
    """The matrix by which z turns towards x."""
    return np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])


def quaternion(turn):
    x, y, z, w = turn.as_quat()
    return np.array([w, x, y, z])


@pytest.mark.parametrize(
    ("body", "a", "matrix"), [(deep(), A, TURN.as_matrix()), (flat(), A[:2], in_plane(ANGLE))], ids=["space", "plane"]
)
def test_vectors_turn_with_the_body(body, a, matrix):
    np.testing.assert_allclose(rotation.in_world(body, a), matrix @ a, rtol=1e-14)
    np.testing.assert_allclose(rotation.in_body(body, a), matrix.T @ a, rtol=1e-14)
    np.testing.assert_allclose(rotation.rotation_change(body, a), matrix @ a - a, rtol=1e-13)


def test_a_spin_of_the_plane_is_the_same_in_both_axes():
    assert rotation.in_world(flat(), (0.3,)) == rotation.in_body(flat(), (0.3,)) == (0.3,)


def test_small_rotations_keep_their_digits():
    np.testing.assert_allclose(rotation.rotation_change(flat(1e-9), (0.0, 1.0)), (1e-9, -0.5e-18), rtol=1e-12)


@pytest.mark.parametrize(("angle", "faces_away"), [(math.pi / 4 - 1e-6, False), (math.pi / 4 + 1e-6, True)])
def test_a_body_may_face_away_beyond_an_eighth_of_a_turn(angle, faces_away):
    assert rotation.may_face_away(flat(angle)) is faces_away
    assert rotation.may_face_away(flat(-angle)) is faces_away
    turn = Rotation.from_rotvec(angle * np.array(A) / np.linalg.norm(A))
    assert rotation.may_face_away(deep(turn)) is faces_away


def test_at_an_eighth_of_a_turn_a_body_does_not_face_away():
    body, other = flat(), deep()
    body.rotation[1], other.rotation[:] = rotation.EIGHTH, np.diag([-2 * rotation.EIGHTH, 0.0, 0.0])
    assert not rotation.may_face_away(body)
    assert not rotation.may_face_away(other)


def test_a_moment_gives_the_spin_that_the_inertia_asks_for():
    body, matrix = deep(), TURN.as_matrix()
    inverse = np.linalg.inv(INERTIA)
    np.testing.assert_allclose(rotation.apply_inverse_inertia(body, A), inverse @ A, rtol=1e-13)
    world = matrix @ inverse @ matrix.T
    np.testing.assert_allclose(rotation.spin_from_moment(body, A), world @ A, rtol=1e-13)
    rotation.take_inverse_inertia(body)
    np.testing.assert_allclose(body.inverse_in_world, world, rtol=1e-13)
    np.testing.assert_allclose(rotation.spin_from_many(body, A), world @ A, rtol=1e-13)
    rotation.take_inverse_inertia(flat())
    for spin in (rotation.apply_inverse_inertia, rotation.spin_from_moment, rotation.spin_from_many):
        assert spin(flat(), (3.0,)) == (0.75,)


def test_the_spin_of_a_pose_is_that_of_its_momentum():
    body, matrix = deep(), TURN.as_matrix()
    assert rotation.momentum_of(body) == B
    np.testing.assert_allclose(body.spin, matrix @ np.linalg.solve(INERTIA, matrix.T @ B), rtol=1e-13)
    assert rotation.momentum_of(flat(spin=0.5)) == (2.0,)
    assert rotation.momentum_of(flat(spin=0.5, inverse_inertia=0.0)) == (0.0,)


def test_a_moment_changes_the_momentum_by_its_impulse():
    body, matrix = deep(), TURN.as_matrix()
    rotation.apply_angular_impulse(body, tuple(np.multiply(0.1, A)))
    np.testing.assert_allclose(body.momentum, np.add(B, np.multiply(0.1, A)), rtol=1e-13)
    np.testing.assert_allclose(body.spin, matrix @ np.linalg.solve(INERTIA, matrix.T @ body.momentum), rtol=1e-13)
    other = flat(spin=0.5)
    rotation.apply_angular_impulse(other, (0.3,))
    assert other.spin[0] == pytest.approx(0.5 + 0.25 * 0.3)


def test_a_blow_changes_velocity_momentum_and_spin():
    body, matrix, arm = deep(inverse_mass=[0.5, 0.25, 0.0], velocity=1.0), TURN.as_matrix(), np.array([0.2, -0.4, 1.1])
    rotation.apply_impulse_at(body, tuple(arm), A)
    np.testing.assert_allclose(body.velocity, [1.15, 0.7, 1.0], rtol=1e-14)
    np.testing.assert_allclose(body.momentum, B + np.cross(arm, A), rtol=1e-14)
    np.testing.assert_allclose(body.spin, matrix @ np.linalg.solve(INERTIA, matrix.T @ body.momentum), rtol=1e-13)
    other = flat(inverse_mass=0.5, spin=0.5)
    rotation.apply_impulse_at(other, (0.2, 1.1), (0.3, -1.2))
    np.testing.assert_allclose(other.velocity, [0.15, -0.6], rtol=1e-14)
    assert other.spin[0] == pytest.approx(0.5 + 0.25 * (1.1 * 0.3 + 0.2 * 1.2))


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.99e-4, 1.01e-4, 0.1, 2.5])
def test_a_vector_turned_by_a_rotation_vector(angle):
    by = angle * np.array([2.0, -1.0, 2.0]) / 3
    for a in np.eye(3):
        expected = Rotation.from_rotvec(by).apply(a)
        np.testing.assert_allclose(rotation.rotated(tuple(by), tuple(a)), expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize(("turned", "order"), [(0.9e-3, 3), (0.02, 4), (0.2, 4), (0.9, 4)])
def test_the_spin_in_the_middle_of_a_step_is_that_of_the_momentum_there(turned, order):
    """w = I^-1 exp(-h w / 2) R^T L, to the power of h w that the passes leave."""
    body = deep()
    start = TURN.inv().apply(B)
    h = turned / np.linalg.norm(np.linalg.solve(INERTIA, start))
    found = np.array(rotation.middle_spin(body, B, h))
    left = found - np.linalg.solve(INERTIA, Rotation.from_rotvec(-0.5 * h * found).apply(start))
    assert np.linalg.norm(left) < np.linalg.norm(found) * turned**order
    near = np.linalg.solve(INERTIA, start)
    assert np.linalg.norm(found - near) > 0.01 * turned * np.linalg.norm(near)


@pytest.mark.parametrize(
    ("spin", "h", "passes"), [(1.0, 0.99e-3, 2), (1.0, 1e-3, 3), (2.0, 0.4e-3, 2), (2.0, 0.6e-3, 3)]
)
def test_a_body_that_turns_slowly_in_a_step_takes_fewer_passes(spin, h, passes, monkeypatch):
    calls, rotated = [], rotation.rotated
    monkeypatch.setattr(rotation, "rotated", lambda *given: calls.append(given) or rotated(*given))
    body = rows(kinds(3).body, 1, quaternion=[1.0, 0.0, 0.0, 0.0], inverse_inertia=np.eye(3))[0]
    rotation.middle_spin(body, (spin, 0.0, 0.0), h)
    assert len(calls) == passes


@pytest.mark.parametrize("h", [1e-9, 1e-4, 2.2e-4, 0.1, 1.0])
def test_a_step_turns_a_body_by_its_spin(h):
    body = deep()
    spin = np.array(rotation.middle_spin(body, B, h))
    rotation.rotate_body(body, h)
    expected = quaternion(TURN * Rotation.from_rotvec(h * spin))
    np.testing.assert_allclose(body.quaternion, expected * np.sign(expected @ body.quaternion), rtol=0, atol=1e-15)
    other = flat(spin=0.5)
    rotation.rotate_body(other, h)
    assert other.angle == ANGLE + 0.5 * h


def test_quaternions_are_brought_back_to_one():
    body = deep(momentum=1e-9)
    body.quaternion *= 1.1
    rotation.rotate_body(body, 1e-9)
    np.testing.assert_allclose(body.quaternion, quaternion(TURN), rtol=1e-14)


def test_rotations_are_written_after_the_displacements():
    pose = np.zeros(7)
    rotation.write_rotation(deep(), pose)
    np.testing.assert_array_equal(pose, [0.0, 0.0, 0.0, *quaternion(TURN)])
    pose = np.zeros(3)
    rotation.write_rotation(flat(), pose)
    np.testing.assert_array_equal(pose, [0.0, 0.0, ANGLE])


def test_a_run_follows_a_body_up_to_a_rotation():
    ends = [rotation.rotation_within(flat(angle), 1.0) for angle in (-1.0, -0.9, 0.9, 1.0)]
    assert ends == [False, True, True, False]
    body = deep()
    assert rotation.rotation_within(body, 0.0)
    for lost in (math.inf, -math.inf, math.nan):
        body.spin[0] = lost
        assert not rotation.rotation_within(body, 0.0)


def test_bodies_start_with_the_rotations_and_spins_of_a_pose():
    inverse = np.linalg.inv(INERTIA)[None]
    bodies = rows(kinds(3).body, 2, inverse_inertia=np.vstack([inverse, 0 * inverse]))
    pose, velocity = np.array([[0, 0, 0, *quaternion(TURN)]] * 2), np.array([[0, 0, 0, *A]] * 2)
    rotation.set_rotations_and_spins(bodies, pose, velocity)
    np.testing.assert_array_equal(bodies["quaternion"], pose[:, 3:])
    np.testing.assert_allclose(bodies["momentum"], [TURN.apply(INERTIA @ A), np.zeros(3)], rtol=1e-12)
    np.testing.assert_allclose(rotation.rotations(bodies), [TURN.as_matrix() - np.eye(3)] * 2, rtol=1e-13)
    bodies = rows(kinds(2).body, 1, inverse_inertia=0.25)
    rotation.set_rotations_and_spins(bodies, np.array([[0.0, 0.0, ANGLE]]), np.array([[0.0, 0.0, 0.5]]))
    assert (bodies["angle"], bodies["spin"]) == (ANGLE, 0.5)
    np.testing.assert_allclose(rotation.rotations(bodies), [in_plane(ANGLE) - np.eye(2)], rtol=1e-13)


@pytest.mark.parametrize("d", [2, 3])
def test_inverse_masses_at_rest_are_squares_of_their_roots(d):
    inverse = np.full((1, 1, 1), 0.25) if d == 2 else np.linalg.inv(INERTIA)[None]
    bodies = rows(kinds(d).body, 2, inverse_mass=np.arange(d) + 1.0, inverse_inertia=np.vstack([inverse, 0 * inverse]))
    roots = rotation.roots_of_masses(bodies)
    masses = roots @ np.swapaxes(roots, 1, 2)
    np.testing.assert_allclose(masses[:, :d, :d], [np.diag(np.arange(d) + 1.0)] * 2, rtol=1e-13)
    np.testing.assert_allclose(masses[:, d:, d:], np.vstack([inverse, 0 * inverse]), rtol=1e-13, atol=1e-16)
    np.testing.assert_array_equal(masses[:, :d, d:], 0.0)
