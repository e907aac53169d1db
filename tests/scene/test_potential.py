"""The pose of rest: first and second derivatives of the energy that is minimised, and which equilibria are none."""

import numpy as np
import pytest
from everyday import among
from scenes import changed, two_blocks, unbalanced

import mjrock as mr
from mjrock.geometry.frames import frames_of
from mjrock.geometry.kinematics import meeting
from mjrock.geometry.poses import rotations
from mjrock.geometry.vectors import tangent
from mjrock.problem.wall.effect import LinkLaw
from mjrock.scene import potential as potential_module
from mjrock.scene.parts import Bodies, ConstantForces, ContactPoints, Links


@pytest.fixture
def held():
    """Two blocks with a tie between them and a force on the upper one, away from its centroid."""
    scene = two_blocks()
    tie = Links(("tie",), [1], [(0.3, 0.7)], [0], [(-0.3, 0.2)], [LinkLaw(3e6, 0.5)])
    return changed(scene, links=tie, forces=ConstantForces(("pull",), [1], [(0.1, 0.9)], [(3e4, -1e4)]))


def test_derivatives_of_the_energy(held):
    """Central differences of the potential give its gradient and its second derivatives, turned bodies and all."""
    potential, pose = held.potential, np.array([0.01, -2e-3, 0.02, 0.04, -6e-3, 0.05])
    assert (potential.openings(pose) < 0).sum() >= 3  # springs of both kinds are pressed, and one contact is open
    assert (potential.openings(pose) > 0).any()
    k = np.append(held.contacts.k, held.links.law["k"])
    np.testing.assert_array_equal(potential.springs, k)
    np.testing.assert_array_equal(potential.pressed(pose), np.maximum(-potential.openings(pose), 0))
    pressed = np.maximum(-potential.openings(pose), 0) * k
    rates = potential.rates(pose).toarray()
    ways, h = np.eye(6), 1e-5
    gradient = [(potential.energy(pose + h * way) - potential.energy(pose - h * way)) / (2 * h) for way in ways]
    force = potential.load(pose) + rates.T @ pressed
    assert -force == pytest.approx(gradient, rel=1e-6, abs=1e-6 * np.abs(force).max())
    np.testing.assert_allclose(potential.gradient(pose), -force, rtol=1e-12, atol=1e-12 * np.abs(force).max())

    def gradient_at(at):
        closed = np.maximum(-potential.openings(at), 0) * k
        return -potential.load(at) - potential.rates(at).T @ closed

    second = np.array([(gradient_at(pose + h * way) - gradient_at(pose - h * way)) / (2 * h) for way in ways])
    found = (rates.T * np.where(pressed > 0, k, 0)) @ rates + potential.curvature(pose).toarray()
    np.testing.assert_allclose(found, second, rtol=1e-6, atol=1e-8 * np.abs(second).max())
    bent = np.abs(potential.curvature(pose).toarray()).max()
    assert bent > 1e4  # what the check of the second derivatives is about is not a trifle


def test_geometric_stiffness_is_the_same_made_in_parts(held, monkeypatch):
    """To rounding: parts are summed in another order."""
    potential, drag = held.potential, np.array([[3e4], [-1e4], [2e4], [0.0]])
    pose = np.array([0.01, -2e-3, 0.02, 0.04, -6e-3, 0.05])
    whole = potential.curvature(pose, drag).toarray()
    monkeypatch.setattr(potential_module, "SPRINGS_PER_BATCH", 2)
    np.testing.assert_allclose(
        potential.curvature(pose, drag).toarray(), whole, rtol=0, atol=1e-12 * np.abs(whole).max()
    )


def test_friction_has_a_geometric_stiffness(held):
    """Friction that keeps its size takes its size times the second derivatives of slip from the stiffness."""
    potential, pose = held.potential, np.array([0.01, -2e-3, 0.02, 0.04, -6e-3, 0.05])
    drag, h, second = np.array([[3e4], [-1e4], [2e4], [0.0]]), 1e-4, np.empty((6, 6))

    def slid(way):
        return float((drag * potential.slips(pose + h * way)).sum())

    for i, row in enumerate(np.eye(6)):
        for j, column in enumerate(np.eye(6)):
            ends = slid(row + column) - slid(row - column) - slid(column - row) + slid(-row - column)
            second[i, j] = ends / (4 * h * h)
    found = (potential.curvature(pose, drag) - potential.curvature(pose)).toarray()
    np.testing.assert_allclose(found, -second, atol=1e-6 * np.abs(second).max())


def test_the_energy_is_that_of_the_accounts(held):
    """Weight, forces and springs, at rest at some pose: one formula for the search for rest, another for a history."""
    for pose in np.random.default_rng(3).normal(0, [0.01, 0.01, 0.05] * 2, (5, 6)):
        stored = held.accounts(pose[None], np.zeros((1, 6)))[0][0]
        assert stored[0] == 0
        assert held.potential.energy(pose) == pytest.approx(stored.sum(), rel=1e-12)


def carried(rest, body, place, pose):
    """Function that gives where the part of a body that is at a place in one pose is in another one [m]."""
    if body < 0:
        return lambda at: place
    centre, turn = rest[body] + pose[3 * body : 3 * body + 2], rotations(pose[3 * body : 3 * body + 3])

    def there(at):
        own = at[3 * body : 3 * body + 3]
        return rest[body] + own[:2] + rotations(own) @ turn.T @ (place - centre)

    return there


def test_rates_are_derivatives_of_openings_and_of_what_slips(held):
    """Of every gap, of the slack of the tie, and of the way along the face of the parts of both bodies that are halfway
    between the point and the face."""
    potential, places, h = held.potential, held.places, 1e-6
    pose, rest = np.array([0.01, -2e-3, 0.02, 0.04, -6e-3, 0.05]), held.bodies.rest
    meets = [meeting(places, i, frames_of(pose)) for i in range(4)]
    slips = []
    for i, meet in enumerate(meets):
        body, normal = places.body[i], np.array(meet.normal)
        halfway = rest[body] + pose[3 * body : 3 * body + 2] + meet.arm - 0.5 * meet.gap * normal
        ends = [carried(rest, each, halfway, pose) for each in (body, places.face_body[i])]
        slips.append((*ends, np.array(tangent(meet.normal))))

    def along_faces(at):
        return np.array([way @ (own(at) - other(at)) for own, other, way in slips])

    for j, way in enumerate(np.eye(6)):
        opened = (potential.openings(pose + h * way) - potential.openings(pose - h * way)) / (2 * h)
        np.testing.assert_allclose(potential.rates(pose).toarray()[:, j], opened, rtol=0, atol=1e-8)
        slid = (along_faces(pose + h * way) - along_faces(pose - h * way)) / (2 * h)
        np.testing.assert_allclose(potential.slip_rates(pose)[0].toarray()[:, j], slid, rtol=0, atol=1e-8)


def test_at_rest_only_friction_holds_what_springs_do_not(held):
    """The tie and the force would make the blocks slide: along all other ways the springs balance them."""
    for length, taut in ((0.75, True), (3.0, False)):
        scene = changed(held, links={"law": [LinkLaw(3e6, length)]}, forces={"force": [(3e3, -1e4)]})
        pose = scene.at_rest.ravel()
        assert (scene.potential.pressed(pose)[4] > 0) == taut
        missing, beyond = unbalanced(scene)
        np.testing.assert_allclose(missing, 0, rtol=0, atol=1e-9 * scene.bodies.mass[0] * mr.GRAVITY)
        assert beyond.max() < 1e-9 * scene.bodies.mass[0] * mr.GRAVITY
        assert np.abs(scene.potential.gradient(pose)).max() > 1e3  # friction carries some of the force


def test_an_equilibrium_that_is_not_stable_is_no_rest():
    """Two blocks upright on springs too soft for their height: every force balances, and they fall all the same."""
    assert np.abs(two_blocks(k_n=5e7).at_rest[:, 2]).max() < 1e-9
    with pytest.raises(ValueError, match="do not stand on their contacts"):
        _ = two_blocks(k_n=1e6).at_rest


def board(k, level, friction=0.7):
    """A board of the plane, 0.2 m thick and 2.2 m high, that a force three times its weight presses against a wall at
    two lines 8 mm apart, and friction holds there. The force meets the weight and the friction in the middle of the
    two lines, so that both bear alike. The lines are at a level above the centroid [m]."""
    b, h, c, mass = 0.1, 1.1, 0.004, 880.0
    push, outline = 3 * mass * mr.GRAVITY, np.array([(-b, -h), (b, -h), (b, h), (-b, h)])
    return mr.Scene(
        Bodies(("board",), [mass], [mass * (b**2 + h**2) / 3], [(b, h)], (outline,), length=1.0),
        ContactPoints(
            body=[0, 0],
            at=[(-b, level - c), (-b, level + c)],
            face_body=[-1, -1],
            face_at=[(0, h)] * 2,
            normal=[(1, 0)] * 2,
            k=[k] * 2,
            c=[0.0] * 2,
            friction=[friction] * 2,
            joint=[0, 0],
            joints=("wall",),
            k_s=k,
        ),
        forces=ConstantForces(("push",), [0], [(0.0, level + b / 3)], [(-push, 0.0)]),
    )


@pytest.mark.parametrize("level", among([-0.9, 0.0, 0.9], -0.9, 0.9))
def test_a_board_held_by_friction_turns_about_its_joint(level):
    """The force P takes P b of the rotational stiffness 2 k c^2 of the joint, with b half the thickness, and the weight
    takes its height over the joint, or gives its depth below it. Friction carries this weight."""
    b, c, weight = 0.1, 0.004, 880.0 * mr.GRAVITY
    least = (3 * weight * b - weight * level) / (2 * c * c)
    if level > 0:
        assert least < 0
        least = 0.5 * 3 * weight * b / (2 * c * c)  # the joint alone would let the force turn the board
    else:
        with pytest.raises(ValueError, match="do not stand on their contacts"):
            _ = board(0.9 * least, level).at_rest
    assert abs(board(1.1 * least, level).at_rest[0, 2]) < 5e-3
