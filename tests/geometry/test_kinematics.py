"""The one place of the kinematics, against corners written out, finite differences, and MuJoCo."""

import math

import mujoco
import numpy as np
import pytest
from scenes import changed, two_blocks

import mjrock as mr
from mjrock.geometry.frames import frames_of, rotation_change
from mjrock.geometry.kinematics import depth, gap, gaps, meeting, relative_velocity, slack, stretch, where_friction_acts
from mjrock.geometry.vectors import dot, tangent
from mjrock.problem.wall.effect import LinkLaw
from mjrock.problem.wall.restoring_moment import pose_of, pulled
from mjrock.scene.parts import Links
from mjrock.scene.rest import settled
from mjrock.scene.wall import wall_course
from scripts.shared.paper import K_N


def course_and_scene(case, contacts):
    """The course of a case, and its scene."""
    scene = mr.scene_of(case, contacts)
    return wall_course(case, scene), scene


def poses(rng, count, bodies):
    """Random poses of some bodies, and velocities and accelerations."""
    return rng.normal(0, [0.01, 0.01, 0.1] * bodies, (count, 3 * bodies)), *rng.normal(0, 1, (2, count, 3 * bodies))


@pytest.mark.parametrize("points", [2, 9])
@pytest.mark.parametrize("share", [0.0, 1e-6, 1e-3, 0.5, 0.999, -0.5])
def test_the_released_wall_is_carried_by_its_springs(wall, points, share):
    contacts = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.05, points=points)
    course, scene = course_and_scene(mr.Case(wall, share * wall.alpha, 1.0, side_stop=False), contacts)
    forces = -scene.contacts.k * np.minimum(gaps(scene.places, course.pose), 0)
    # rounding leaves some eps h of a gap, which is a small difference of lengths like h, and k times that of the force
    assert forces.sum() == pytest.approx(wall.weight, abs=10 * np.finfo(float).eps * wall.h * scene.contacts.k.sum())
    assert not course.velocity.any()


def test_the_toe_stays_where_it_is(wall, contacts):
    for theta in (0.05, -0.05):
        course, _ = course_and_scene(mr.Case(wall, theta, 1.0, side_stop=False), contacts)
        toe = math.copysign(wall.b, theta)
        x, _, _ = course.pose[0]
        assert x + toe * math.cos(theta) - wall.h * math.sin(theta) == pytest.approx(toe, abs=1e-15)


def test_release_velocity_turns_about_the_toe(wall, contacts):
    dt = 1e-6
    (now, _), (later, _) = (
        course_and_scene(mr.Case(wall, theta, 1.0, omega0=0.2), contacts) for theta in (0.05, 0.05 + 0.2 * dt)
    )
    np.testing.assert_allclose((later.pose - now.pose) / dt, now.velocity, rtol=1e-5)


def test_gaps_are_those_of_the_corners(wall, contacts):
    scene = mr.wall_scene(mr.Case(wall, 0.0, 1.0), contacts)
    pose = np.array([[0.02, -0.001, 0.1]])
    c, s = math.cos(0.1), math.sin(0.1)
    heights = [wall.h - 0.001 - x * s - wall.h * c for x in (-wall.b, wall.b)]
    distances = [0.02 - wall.b * c + z * s + wall.b for z in (-wall.h, wall.h)]
    np.testing.assert_allclose(gaps(scene.places, pose)[0], heights + distances, rtol=1e-13)


def test_rates_are_derivatives_also_of_a_face_that_turns():
    """Gap, rate and curvature of points on moving faces, along q + v t + a t^2/2, by central differences."""
    scene = two_blocks()
    rng = np.random.default_rng(5)
    t = 1e-4
    for q, v, a in zip(*poses(rng, 20, 2), strict=True):
        for i in range(len(scene.contacts.k)):
            before, after = (
                gap(scene.places, i, frames_of(q + s * v + 0.5 * s * s * a), v + s * a, a) for s in (-t, t)
            )
            now = gap(scene.places, i, frames_of(q), v, a)
            assert (after.value - before.value) / (2 * t) == pytest.approx(now.rate, abs=1e-6)
            assert (after.rate - before.rate) / (2 * t) == pytest.approx(now.linear + now.swept, abs=1e-5)
            assert gap(scene.places, i, frames_of(q), 2 * v, a).rate == pytest.approx(2 * now.rate)
            assert gap(scene.places, i, frames_of(q), a, v).rate == pytest.approx(now.linear)


def tied_blocks():
    """The two blocks with one tie between them and one to the ground, neither along an axis."""
    scene = two_blocks()
    ends = ("between", "down"), [1, 1], [(0.3, 1.0), (-0.2, 0.7)], [0, -1], [(-0.2, -0.6), (-2.0, 0.1)]
    return changed(scene, links=Links(*ends, [LinkLaw(2e6, 2.0, 1e5), LinkLaw(3e6, 3.0)]))


def test_ties_between_bodies_that_turn():
    """Slack from the two ends written out; its rate and curvature along q + v t + a t^2/2, by central differences."""
    scene, t = tied_blocks(), 1e-4

    def world(q, body, local):
        if body < 0:
            return np.array(local)
        x, z, theta = q[3 * body : 3 * body + 3]
        c, s = math.cos(theta), math.sin(theta)
        return scene.bodies.rest[body] + [x + local[0] * c + local[1] * s, z - local[0] * s + local[1] * c]

    for q, v, a in zip(*poses(np.random.default_rng(9), 20, 2), strict=True):
        for i in range(2):
            ends = (
                world(q, scene.links.sprung.body[i], scene.links.sprung.at[i]),
                world(q, scene.links.sprung.anchor_body[i], scene.links.sprung.anchor_at[i]),
            )
            now = slack(scene.ties, i, frames_of(q), v, a)
            assert now.value == pytest.approx(scene.links.sprung.law["reach"][i] - math.dist(*ends), abs=1e-12)
            before, after = (
                slack(scene.ties, i, frames_of(q + s * v + 0.5 * s * s * a), v + s * a, a) for s in (-t, t)
            )
            assert (after.value - before.value) / (2 * t) == pytest.approx(now.rate, abs=1e-6)
            assert (after.rate - before.rate) / (2 * t) == pytest.approx(now.linear + now.swept, abs=1e-5)
            assert slack(scene.ties, i, frames_of(q), a, v).rate == pytest.approx(now.linear)


def test_a_tie_yields_beyond_its_strength_and_stays_longer():
    """k (length - reach) up to the strength; what is beyond lengthens the reach, and less than that gives no force."""
    scene = tied_blocks()
    ties = scene.ties._replace(reach=np.array(scene.ties.reach))
    q = np.zeros(6)
    length = 2.0 - slack(ties, 0, frames_of(q), q, q).value
    limit = 1e5 / 2e6
    for reach, elastic, yielded in (
        (length + 0.1, 0.0, 0.0),
        (length - 0.4 * limit, 0.4 * limit, 0.0),
        (length - limit - 0.3, limit, 0.3),
    ):
        ties.reach[0] = reach
        assert stretch(ties, 0, frames_of(q), q) == pytest.approx((elastic, yielded), abs=1e-12)
        assert ties.reach[0] == pytest.approx(reach + yielded)


def slip_of_bodies(places, i, frames, v):
    """Slip where friction acts, in the plane [m/s]."""
    acts = where_friction_acts(places, meeting(places, i, frames))
    return dot(tangent(acts.normal), relative_velocity(places, i, acts, frames, v))


def test_a_place_along_a_face_moves_with_its_rate():
    """The position along the face from its origin, its rate by central differences, and depth as the gap reversed."""
    scene, t = two_blocks(), 1e-5

    def place(i, frames):
        meets = meeting(scene.places, i, frames)
        return dot(tangent(meets.normal), meets.offset)

    for q, v, _ in zip(*poses(np.random.default_rng(10), 20, 2), strict=True):
        for i in range(len(scene.contacts.k)):
            before, after = (place(i, frames_of(q + s * v)) for s in (-t, t))
            frames = frames_of(q)
            meets = meeting(scene.places, i, frames)
            rate = dot(tangent(meets.normal), relative_velocity(scene.places, i, meets, frames, v))
            assert (after - before) / (2 * t) == pytest.approx(rate, abs=1e-7)
            assert depth(scene.places, i, frames) == pytest.approx(-gap(scene.places, i, frames, v, v).value)
    for i, expected in enumerate((-0.3, 0.3, -0.3, 0.3)):
        assert place(i, frames_of(np.zeros(6))) == pytest.approx(expected)


def test_slip_is_the_relative_velocity_where_friction_acts():
    """Of the two material points that are halfway between the point and the face, by central differences."""
    scene = two_blocks()
    rng = np.random.default_rng(6)

    def world(q, body, local):
        x, z, theta = q[3 * body : 3 * body + 3]
        c, s = math.cos(theta), math.sin(theta)
        return scene.bodies.rest[body] + [x + local[0] * c + local[1] * s, z - local[0] * s + local[1] * c]

    def local_to(q, body, place):
        x, z, theta = q[3 * body : 3 * body + 3]
        c, s = math.cos(theta), math.sin(theta)
        dx, dz = place - scene.bodies.rest[body] - [x, z]
        return np.array([dx * c - dz * s, dx * s + dz * c])

    t = 1e-5
    for q, v, _ in zip(*poses(rng, 20, 2), strict=True):
        for i in range(len(scene.contacts.k)):
            g = gap(scene.places, i, frames_of(q), v, v).value
            face = scene.contacts.face_body[i]
            turn = q[3 * face + 2] if face >= 0 else 0.0
            nx, nz = scene.contacts.normal[i]
            n = np.array([nx * math.cos(turn) + nz * math.sin(turn), nz * math.cos(turn) - nx * math.sin(turn)])
            place = world(q, scene.contacts.body[i], scene.contacts.at[i]) - (0.5 * g + scene.radius) * n
            relative = np.zeros(2)
            for body, sign in ((scene.contacts.body[i], 1), (face, -1)):
                if body >= 0:
                    own = local_to(q, body, place)
                    relative += sign * (world(q + t * v, body, own) - world(q - t * v, body, own)) / (2 * t)
            slip = slip_of_bodies(scene.places, i, frames_of(q), v)
            assert slip == pytest.approx(relative @ [n[1], -n[0]], abs=1e-8)


def test_gaps_and_slip_are_those_of_the_engine():
    """MuJoCo's own distances and tangential velocities, for a point on a body and on a face that moves."""
    from mjrock.engine.model import engine_of

    scene = two_blocks()
    rng = np.random.default_rng(7)
    seen = set()
    with engine_of(scene) as engine:
        model, data = engine.model, engine.data
        for q, v, _ in zip(*poses(rng, 60, 2), strict=True):
            q *= 0.02
            q[1::3] -= 3e-4
            data.qpos[:], data.qvel[:] = q, v
            mujoco.mj_forward(model, data)
            jacobian = np.reshape(data.efc_J, (data.nefc, model.nv))
            closed = np.flatnonzero(gaps(scene.places, q[None])[0] < 0)
            assert data.ncon == len(closed)
            for contact in data.contact:
                i = next(
                    i for i in range(model.npair) if {model.pair_geom1[i], model.pair_geom2[i]} == set(contact.geom)
                )
                seen.add(i)
                g, rate, _, _ = gap(scene.places, i, frames_of(q), v, v)
                assert contact.dist == pytest.approx(g, abs=1e-12)
                row = contact.efc_address
                assert jacobian[row] @ v == pytest.approx(rate, rel=1e-9, abs=1e-9)
                slips = jacobian[row + 1 : row + contact.dim] @ v
                slip = slip_of_bodies(scene.places, i, frames_of(q), v)
                assert np.hypot(*slips) == pytest.approx(abs(slip), abs=1e-9)
    assert seen == set(range(len(scene.contacts.k)))


def test_energy_is_none_at_rest_and_the_rigid_one_at_release(wall, contacts):
    course, scene = course_and_scene(mr.Case(wall, 0.0, 1.0), contacts)
    assert course.energy(scene) == pytest.approx(0, abs=1e-9)
    case = mr.Case(wall, 0.5 * wall.alpha, 1.0)
    # one corner instead of two carries the wall: m g (m g / 4 k) less, k that of one corner
    less = wall.weight**2 / (4 * contacts.base.stiffness[0])
    course, scene = course_and_scene(case, contacts)
    assert course.energy(scene) == pytest.approx(case.release_energy - less, rel=1e-10)


def test_energies_of_bodies_that_move():
    scene = two_blocks()
    q, v, _ = poses(np.random.default_rng(8), 5, 2)
    found, taken = scene.accounts(q, v)
    assert (found.shape, taken.shape) == ((5, 3), (5, 0))
    np.testing.assert_allclose(found[:, 0], 0.5 * (v**2 @ scene.bodies.masses))
    np.testing.assert_allclose(found[:, 1], mr.GRAVITY * (q[:, 1::3] @ scene.bodies.mass))
    np.testing.assert_allclose(found[:, 2], 0.5 * np.minimum(gaps(scene.places, q), 0) ** 2 @ scene.contacts.k)


@pytest.mark.parametrize("side_stop", [True, False])
def test_the_highest_frequency_is_the_closed_form(wall, contacts, side_stop):
    scene = mr.wall_scene(mr.Case(wall, 0.0, 1.0, side_stop=side_stop), contacts)
    assert scene.highest_frequency == pytest.approx(contacts.highest_frequency(wall, side_stop=side_stop), rel=1e-12)
    assert scene.rocking_frequency == pytest.approx(wall.p, rel=1e-12)


def test_a_scene_settles_under_its_weight(wall, contacts):
    scene = mr.wall_scene(mr.Case(wall, 0.0, 1.0), contacts)
    np.testing.assert_allclose(settled(scene.potential, scene.contacts.k_s)[0], scene.at_rest, atol=1e-15)
    np.testing.assert_allclose(scene.bears, wall.weight / scene.contacts.k[:2].sum() * np.array([1, 1, 0, 0]))
    blocks = two_blocks()
    force = -blocks.contacts.k * np.minimum(gaps(blocks.places, blocks.at_rest.reshape(1, -1))[0], 0)
    weights = mr.GRAVITY * blocks.bodies.mass
    np.testing.assert_allclose([force[2:].sum(), force[:2].sum()], [weights[1], weights.sum()], rtol=1e-9)


def test_formulas_of_walls_alone_are_those_of_any_body():
    """`pose_of` and `pulled`, which stand apart for rocking theory, beside frames and slack, on both toes."""
    wall = mr.Block(0.3, 2.1, inset=0.02, masses=[mr.AddedMass(500.0, 3.0, 0.2)])
    contacts = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.05)
    tie = mr.Tie(3.5, 1e6, slack=0.01, length=2.0, anchor_height=3.0)
    case = mr.Case(wall, 0.0, 1.0, side_stop=False, effects=(tie,))
    scene, rest = mr.wall_scene(case, contacts), (wall.centroid_offset, wall.centroid_height)
    for theta in (0.1, -0.2, 1e-9):
        (pose,), frames = pose_of(np.array([theta]), *rest, wall.half_base), frames_of(np.array([0.0, 0.0, theta]))
        toe = math.copysign(wall.half_base, theta)
        turned = rotation_change(frames, 0, (toe - rest[0], -rest[1]))  # the toe stays where it is
        assert pose == pytest.approx([-turned[0], -turned[1], theta], rel=1e-12, abs=1e-15)
        velocity = wall.turning(theta, math.copysign(1.0, theta))
        now = slack(scene.ties, 0, frames_of(pose), velocity, velocity)
        assert pulled(case.pulls[0], theta, math.copysign(1.0, theta)) == pytest.approx((-now.value, -now.rate))
