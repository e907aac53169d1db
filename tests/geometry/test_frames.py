"""Kinematics in space: those of the plane where bodies stay in it, derivatives where they tumble, and MuJoCo's own."""

import math

import mujoco
import numpy as np
import pytest
from scenes import changed, two_blocks
from scipy.spatial.transform import Rotation

import mjrock as mr
from mjrock.compiled import compiled
from mjrock.geometry.frames import (
    PLANE,
    SPACE,
    displaced,
    frames_of,
    inverse_rotation_change,
    linear,
    push_body,
    rotation_change,
    spin,
)
from mjrock.geometry.kinematics import (
    AppliedForces,
    LinkEnds,
    Places,
    Ties,
    depth,
    displacement,
    gap,
    gaps,
    meeting,
    push_apart,
    relative_velocity,
    slack,
    stretch,
    where_friction_acts,
)
from mjrock.geometry.vectors import dot, plus, scaled, spun, tangent
from mjrock.problem.masonry.laws.joint_law import LAW_ROW
from mjrock.problem.wall.effect import LinkLaw
from mjrock.quantities import frozen
from mjrock.scene.course import Ground, push_ground
from mjrock.scene.parts import ConstantForces, Links
from mjrock.scene.potential import Potential, Structure, energies

AXES = SPACE.axes


def lifted(vectors):
    """Vectors of the plane as vectors of space."""
    return frozen(np.insert(np.reshape(vectors, (-1, 2)), 1, 0.0, axis=1))


def pose_in_space(q):
    """A pose of the plane in space: y = 0, and the rotation about y as a quaternion."""
    x, z, theta = np.reshape(q, (-1, 3)).T
    none = np.zeros_like(x)
    return np.column_stack([x, none, z, np.cos(theta / 2), none, np.sin(theta / 2), none]).ravel()


def velocity_in_space(v):
    x, z, turning = np.reshape(v, (-1, 3)).T
    none = np.zeros_like(x)
    return np.column_stack([x, none, z, none, turning, none]).ravel()


def in_space(scene):
    """The structure of a scene of the plane in space. Moments of inertia are the same about all axes."""
    flat = scene.structure
    places, ties, forces = flat.places, flat.ties, flat.forces
    ends = {name: lifted(getattr(ties.links, name)) for name in ("at", "anchor_at", "between")}
    return Structure(
        places._replace(
            axes=AXES, **{name: lifted(getattr(places, name)) for name in ("at", "face_at", "normal", "between")}
        ),
        ties._replace(links=ties.links._replace(axes=AXES, **ends)),
        forces._replace(axes=AXES, at=lifted(forces.at), force=lifted(forces.force)),
        frozen(np.column_stack([scene.bodies.mass] * 3 + [scene.bodies.inertia] * 3).ravel()),
    )


def held_blocks():
    """Two blocks with a tie between them, one to the ground, and a force, none of them along an axis."""
    scene = two_blocks()
    ends = ("between", "down"), [1, 1], [(0.3, 1.0), (-0.2, 0.7)], [0, -1], [(-0.2, -0.6), (-2.0, 0.1)]
    ties = Links(*ends, [LinkLaw(2e6, 2.0, 1e5), LinkLaw(3e6, 3.0)])
    return changed(scene, links=ties, forces=ConstantForces(("pull",), [1], [(0.1, 0.9)], [(3e3, -1e4)]))


def arch():
    return mr.masonry_scene(mr.MasonryCase(mr.Masonry.arch(5.0, 0.75, voussoirs=5), 1.0))


def moves(rng, scene, count):
    """Poses of the plane, velocities and accelerations."""
    bodies = len(scene.bodies.mass)
    poses = rng.normal(0, [0.02, 0.02, 0.2] * bodies, (count, 3 * bodies))
    return zip(poses, *rng.normal(0, 1, (2, count, 3 * bodies)), strict=True)


def tumbling():
    """Two bodies of space with contacts on the ground and between them, ties and forces, in no special direction."""
    rng = np.random.default_rng(11)
    rest = np.array([(0.1, -0.3, 0.8), (0.4, 0.5, 2.1)])
    body, face_body = np.array([0, 0, 1, 1, 0]), np.array([-1, -1, 0, 0, 1])
    at, face_at, normal = rng.normal(0, 0.6, (3, 5, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]

    def origin(bodies):
        return np.where(bodies[:, None] < 0, 0.0, rest[bodies])

    between = origin(body) + at - origin(face_body) - face_at
    rows = np.zeros(5, dtype=LAW_ROW)
    rows["k"] = [1e5, 2e5, 3e5, 1e5, 2e5]
    law = np.zeros(5, dtype=np.int64), rows, rows["k"].copy(), *np.zeros((4, 5))
    places = Places(AXES, body, at, face_body, face_at, normal, between, 1e-3, *law)
    held, anchor_body = np.array([0, 1, 1]), np.array([-1, 0, -1])
    ends, anchors = rng.normal(0, 0.7, (2, 3, 3))
    between = origin(held) + ends - origin(anchor_body) - anchors
    k, reach = np.array([2e4, 3e4, 1e4]), np.array([0.5, 0.9, 9.0])
    links = LinkEnds(AXES, held, ends, anchor_body, anchors, between)
    ties = Ties(links, k, reach, *np.full((2, 3), math.inf), np.zeros(3))
    forces = AppliedForces(AXES, np.array([0, 1]), *rng.normal(0, [[[0.5]], [[300.0]]], (2, 2, 3)))
    masses = np.array([40.0, 40.0, 40.0, 2.0, 3.0, 4.0, 25.0, 25.0, 25.0, 1.0, 2.5, 1.5])
    return rest, Structure(places, ties, forces, masses)


def turned_by(quaternion, spin_, acceleration, t):
    """A quaternion after a time, in steps of Runge and Kutta: 2 q' = q (0, w), with the spin w in the body's axes."""

    def rate(q, at):
        w, x, y, z = q
        a, b, c = spin_ + acceleration * at
        return 0.5 * np.array(
            [-x * a - y * b - z * c, w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a]
        )

    q, now, h = quaternion, 0.0, t / 4
    for _ in range(4):
        first = rate(q, now)
        second = rate(q + 0.5 * h * first, now + 0.5 * h)
        third = rate(q + 0.5 * h * second, now + 0.5 * h)
        last = rate(q + h * third, now + h)
        q, now = q + h / 6 * (first + 2 * second + 2 * third + last), now + h
    return q


def later(q, v, a, t):
    """The pose of bodies in space after a time, with velocities v + a t."""
    pose = np.array(q)
    for body in range(len(q) // 7):
        at, rates = slice(7 * body, 7 * body + 3), slice(6 * body, 6 * body + 3)
        turn, spins = slice(7 * body + 3, 7 * body + 7), slice(6 * body + 3, 6 * body + 6)
        pose[at] += t * v[rates] + 0.5 * t * t * a[rates]
        pose[turn] = turned_by(q[turn], v[spins], a[spins], t)
    return pose


def tumbles(seed, count, bodies=2):
    """Poses of space in any orientation, with velocities and accelerations."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        quaternions = rng.normal(size=(bodies, 4))
        quaternions /= np.linalg.norm(quaternions, axis=1)[:, None]
        q = np.column_stack([rng.normal(0, 0.5, (bodies, 3)), quaternions]).ravel()
        yield q, *rng.normal(0, 1, (2, 6 * bodies))


def material(rest, q, body, at):
    """Where a point of a body is, with scipy's rotations."""
    if body < 0:
        return np.array(at)
    x, y, z, *quaternion = q[7 * body : 7 * body + 7]
    return rest[body] + [x, y, z] + Rotation.from_quat(quaternion, scalar_first=True).apply(at)


@compiled
def look(places, frames, v, a, found, applied):
    """Write the gap of every contact and how it changes, and add what a force at each does to the bodies."""
    for i in range(len(places.body)):
        now = gap(places, i, frames, v, a)
        found[i, 0], found[i, 1], found[i, 2], found[i, 3] = now.value, now.rate, now.linear, now.swept
        meets = where_friction_acts(places, meeting(places, i, frames))
        push_apart(places, i, meets, frames, scaled(1.0 + i, meets.normal), applied)


class TestFrames:
    def test_rotations_are_those_of_the_quaternions(self):
        for q, v, _ in tumbles(1, 20):
            frames = frames_of(q, SPACE)
            assert frames.shape == (2, 12)
            for body in range(2):
                turn = Rotation.from_quat(q[7 * body + 3 : 7 * body + 7], scalar_first=True)
                r = np.array([0.3, -1.2, 0.7])
                np.testing.assert_allclose(r + rotation_change(frames, body, tuple(r)), turn.apply(r), atol=1e-14)
                back = r + inverse_rotation_change(frames, body, tuple(r))
                np.testing.assert_allclose(back, turn.inv().apply(r), atol=1e-14)
                moved = np.array([1.0, 2.0, 3.0]) + turn.apply(r) - r
                np.testing.assert_allclose(displaced((1.0, 2.0, 3.0), frames, body, tuple(r)), moved, atol=1e-14)
                own = v[6 * body + 3 : 6 * body + 6]  # a spin is that of the body in its own axes
                np.testing.assert_allclose(spin(frames, v, body, AXES), turn.apply(own), atol=1e-14)
                np.testing.assert_array_equal(linear(v, body, AXES), v[6 * body : 6 * body + 3])

    @pytest.mark.parametrize("freedom", [PLANE, SPACE])
    @pytest.mark.parametrize("turn", [1e-3, 1e-9, 1e-15])
    def test_small_rotations_keep_their_digits(self, turn, freedom):
        """R - 1 is not a difference of numbers near one."""
        q = np.array([0.0, 0.0, turn])
        r, expected = (0.4, 2.0), (2.0 * math.sin(turn) - 0.8 * math.sin(turn / 2) ** 2,)
        expected += (-0.4 * math.sin(turn) - 4.0 * math.sin(turn / 2) ** 2,)
        if freedom is SPACE:
            q, r, expected = pose_in_space(q), (0.4, 0.9, 2.0), (expected[0], 0.0, expected[1])
        frames = frames_of(q, freedom)
        np.testing.assert_allclose(rotation_change(frames, 0, r), expected, rtol=2e-15, atol=0)
        turned = tuple(np.add(r, rotation_change(frames, 0, r)))
        np.testing.assert_allclose(np.add(turned, inverse_rotation_change(frames, 0, turned)), r, rtol=2e-15)
        np.testing.assert_allclose(inverse_rotation_change(frames, 0, turned), -np.array(expected), rtol=2e-15, atol=0)

    def test_velocities_are_those_of_the_points(self):
        """v + spin x arm, by central differences along the motion."""
        rest, t, r = np.zeros((2, 3)), 1e-4, np.array([0.3, -1.2, 0.7])
        for q, v, a in tumbles(2, 20):
            frames = frames_of(q, SPACE)
            before, after = (later(q, v, a, s) for s in (-t, t))
            for body in range(2):
                arm = plus(tuple(r), rotation_change(frames, body, tuple(r)))
                moving = plus(linear(v, body, AXES), spun(spin(frames, v, body, AXES), arm))
                found = (material(rest, after, body, r) - material(rest, before, body, r)) / (2 * t)
                np.testing.assert_allclose(found, moving, atol=1e-6)

    def test_a_force_does_the_work_of_its_point(self):
        """Generalised force times velocity is force times the velocity of the point that it acts on."""
        rng = np.random.default_rng(3)
        for q, v, _ in tumbles(3, 20):
            frames = frames_of(q, SPACE)
            for body in range(2):
                arm, force = (tuple(one) for one in rng.normal(0, 1, (2, 3)))
                total = np.zeros(12)
                push_body(frames, body, arm, force, total)
                moving = plus(linear(v, body, AXES), spun(spin(frames, v, body, AXES), arm))
                assert total @ v == pytest.approx(dot(force, moving), rel=1e-12, abs=1e-13)
                assert not total[6 * (1 - body) : 6 * (1 - body) + 6].any()
                again = total.copy()
                push_body(frames, body, arm, force, total)  # adds
                np.testing.assert_allclose(total, 2 * again)

    def test_poses_velocities_and_forces_are_those_of_mujoco(self):
        """Of joints x, y, z and a ball: where a body is, how its points move, what a force on them does."""
        joints = "".join(f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))
        inertial = '<inertial pos="0 0 0" mass="2" diaginertia="1 2 2.5"/>'
        body = f'<body pos="{{}}">{inertial}{joints}<joint type="ball"/></body>'
        rest, rng = np.array([(0.1, -0.3, 0.8), (0.4, 0.5, 2.1)]), np.random.default_rng(4)
        bodies = "".join(body.format(" ".join(map(str, place))) for place in rest)
        model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
        data = mujoco.MjData(model)
        assert (model.nq, model.nv) == (2 * SPACE.nq, 2 * SPACE.nv)
        for q, v, _ in tumbles(4, 20):
            data.qpos[:], data.qvel[:] = q, v
            mujoco.mj_forward(model, data)
            frames = frames_of(q, SPACE)
            for number in range(2):
                at, force = rng.normal(0, 1, (2, 3))
                arm = plus(tuple(at), rotation_change(frames, number, tuple(at)))
                point = data.xpos[number + 1] + data.xmat[number + 1].reshape(3, 3) @ at
                np.testing.assert_allclose(rest[number] + q[7 * number : 7 * number + 3] + arm, point, atol=1e-14)
                jacobian, total, found = np.zeros((3, 12)), np.zeros(12), np.zeros(12)
                mujoco.mj_jac(model, data, jacobian, None, point, number + 1)
                moving = plus(linear(v, number, AXES), spun(spin(frames, v, number, AXES), arm))
                np.testing.assert_allclose(moving, jacobian @ v, atol=1e-13)
                push_body(frames, number, arm, tuple(force), total)
                mujoco.mj_applyFT(model, data, force, np.zeros(3), point, number + 1, found)
                np.testing.assert_allclose(total, found, atol=1e-13)


@pytest.fixture(scope="module", params=[held_blocks, arch], ids=["stack", "arch"])
def scene(request):
    return request.param()


class TestThePlaneInSpace:
    def test_gaps_and_their_rates(self, scene):
        flat, places = scene.places, in_space(scene).places
        for q, v, a in moves(np.random.default_rng(5), scene, 10):
            one, other = frames_of(q), frames_of(pose_in_space(q), SPACE)
            for i in range(len(scene.contacts.k)):
                mine = gap(places, i, other, velocity_in_space(v), velocity_in_space(a))
                np.testing.assert_allclose(mine, gap(flat, i, one, v, a), rtol=0, atol=1e-13)
                assert depth(places, i, other) == -mine.value
                moved = relative_velocity(places, i, meeting(places, i, other), other, velocity_in_space(v))
                assert moved[1] == 0
                np.testing.assert_allclose(
                    moved[::2], relative_velocity(flat, i, meeting(flat, i, one), one, v), rtol=0, atol=1e-13
                )

    def test_gaps_at_many_poses(self, scene):
        q = np.array([one for one, _, _ in moves(np.random.default_rng(6), scene, 10)])
        mine = gaps(in_space(scene).places, np.array([pose_in_space(one) for one in q]))
        np.testing.assert_allclose(mine, gaps(scene.places, q), rtol=0, atol=1e-14)

    def test_what_a_contact_does_to_two_bodies(self, scene):
        """Along the normal and along the face: x, z and the moment about y are those of the plane, the rest is zero."""
        flat, places, bodies = scene.places, in_space(scene).places, len(scene.bodies.mass)
        for q, _, _ in moves(np.random.default_rng(7), scene, 5):
            one, other = frames_of(q), frames_of(pose_in_space(q), SPACE)
            for i in range(len(scene.contacts.k)):
                for acts in (lambda _, meets: meets, where_friction_acts):
                    meets, mine = acts(flat, meeting(flat, i, one)), acts(places, meeting(places, i, other))
                    assert mine.gap == pytest.approx(meets.gap, abs=1e-14)
                    force = plus(scaled(3.0, meets.normal), scaled(-2.0, tangent(meets.normal)))
                    here, there = np.zeros(3 * bodies), np.zeros(6 * bodies)
                    push_apart(flat, i, meets, one, force, here)
                    push_apart(places, i, mine, other, (force[0], 0.0, force[1]), there)
                    np.testing.assert_allclose(there, velocity_in_space(here), rtol=0, atol=2e-13)

    def test_ties(self, scene):
        flat, ties = scene.ties, in_space(scene).ties
        for q, v, a in moves(np.random.default_rng(8), scene, 10):
            one, other = frames_of(q), frames_of(pose_in_space(q), SPACE)
            for i in range(len(ties.k)):
                mine = slack(ties, i, other, velocity_in_space(v), velocity_in_space(a))
                np.testing.assert_allclose(mine, slack(flat, i, one, v, a), rtol=0, atol=1e-13)
                reach = flat.reach.copy()
                stretched = stretch(flat._replace(reach=reach), i, one, v)
                fresh = ties._replace(reach=np.array(ties.reach))
                np.testing.assert_allclose(
                    stretch(fresh, i, other, velocity_in_space(v)), stretched, rtol=0, atol=1e-13
                )
                np.testing.assert_allclose(fresh.reach, reach, rtol=0, atol=1e-13)

    def test_energies_and_forces(self, scene):
        """The potential of the scene, its derivatives, and the energies of a motion."""
        structure = in_space(scene)
        flat, space = scene.potential, Potential(structure)
        for q, v, _ in moves(np.random.default_rng(9), scene, 5):
            pose, scale = pose_in_space(q), np.abs(flat.gradient(q)).max()
            np.testing.assert_allclose(space.openings(pose), flat.openings(q), rtol=0, atol=1e-13)
            assert space.energy(pose) == pytest.approx(flat.energy(q), rel=1e-12)
            np.testing.assert_allclose(
                space.load(pose), velocity_in_space(flat.load(q)), rtol=1e-13, atol=1e-13 * scale
            )
            there, here = space.rates(pose).toarray(), flat.rates(q).toarray()
            for axis, of in ((0, 0), (2, 1), (4, 2)):
                np.testing.assert_allclose(there[:, axis::6], here[:, of::3], rtol=0, atol=1e-13)
            for axis in (1, 3, 5):  # nothing of it holds the bodies in the plane
                np.testing.assert_allclose(there[:, axis::6], 0, rtol=0, atol=1e-13)
            gradient = velocity_in_space(flat.gradient(q))
            np.testing.assert_allclose(space.gradient(pose), gradient, rtol=0, atol=1e-12 * scale)
            parts, taken = energies(structure, pose[None], velocity_in_space(v)[None])
            exact, gone = scene.accounts(q[None], v[None])
            np.testing.assert_allclose(parts, exact, rtol=1e-11)
            np.testing.assert_allclose(taken, gone, rtol=1e-11)


class TestTumblingBodies:
    def test_gaps_are_those_of_the_points(self):
        """Point over face along the face's normal, all three turned by scipy."""
        rest, structure = tumbling()
        places = structure.places
        for q, _, _ in tumbles(12, 20):
            frames = frames_of(q, SPACE)
            for i in range(len(places.body)):
                face = places.face_body[i]
                origin = material(rest, q, face, places.face_at[i])
                normal = material(rest, q, face, places.face_at[i] + places.normal[i]) - origin
                across = material(rest, q, places.body[i], places.at[i]) - origin
                meets = meeting(places, i, frames)
                np.testing.assert_allclose(meets.normal, normal, atol=1e-14)
                np.testing.assert_allclose(meets.offset, across, atol=1e-14)
                assert meets.gap == pytest.approx(normal @ across, abs=2e-14)
                assert gaps(places, q[None])[0, i] == pytest.approx(meets.gap, abs=2e-14)

    def test_rates_of_gaps_are_derivatives(self):
        """Gap, rate and second rate along a motion whose quaternions are integrated, by central differences."""
        places, t = tumbling()[1].places, 1e-4
        for q, v, a in tumbles(13, 20):
            frames = [frames_of(later(q, v, a, s), SPACE) for s in (-t, 0.0, t)]
            for i in range(len(places.body)):
                before, now, after = (
                    gap(places, i, frame, v + s * a, a) for frame, s in zip(frames, (-t, 0.0, t), strict=True)
                )
                assert (after.value - before.value) / (2 * t) == pytest.approx(now.rate, abs=1e-6)
                assert (after.rate - before.rate) / (2 * t) == pytest.approx(now.linear + now.swept, abs=1e-5)
                assert gap(places, i, frames[1], 2 * v, a).rate == pytest.approx(2 * now.rate)
                assert gap(places, i, frames[1], 2 * v, a).swept == pytest.approx(4 * now.swept)
                assert gap(places, i, frames[1], a, v).rate == pytest.approx(now.linear)

    def test_rates_of_ties_are_derivatives(self):
        rest, structure = tumbling()
        ties, t = structure.ties, 1e-4
        for q, v, a in tumbles(14, 20):
            frames = [frames_of(later(q, v, a, s), SPACE) for s in (-t, 0.0, t)]
            for i in range(len(ties.k)):
                before, now, after = (
                    slack(ties, i, frame, v + s * a, a) for frame, s in zip(frames, (-t, 0.0, t), strict=True)
                )
                ends = (material(rest, q, ties.links.body[i], ties.links.at[i]),)
                ends += (material(rest, q, ties.links.anchor_body[i], ties.links.anchor_at[i]),)
                assert now.value == pytest.approx(ties.reach[i] - math.dist(*ends), abs=1e-13)
                assert (after.value - before.value) / (2 * t) == pytest.approx(now.rate, abs=1e-6)
                assert (after.rate - before.rate) / (2 * t) == pytest.approx(now.linear + now.swept, abs=1e-5)
                assert slack(ties, i, frames[1], a, v).rate == pytest.approx(now.linear)

    def test_the_power_between_two_bodies(self):
        """A force and its reaction, at the point and where friction acts: force times the velocity over the face."""
        places, rng = tumbling()[1].places, np.random.default_rng(15)
        for q, v, _ in tumbles(15, 20):
            frames = frames_of(q, SPACE)
            for i in range(len(places.body)):
                meets = meeting(places, i, frames)
                for at in (meets, where_friction_acts(places, meets)):
                    force, total = tuple(rng.normal(0, 1, 3)), np.zeros(12)
                    push_apart(places, i, at, frames, force, total)
                    power = dot(force, relative_velocity(places, i, at, frames, v))
                    assert total @ v == pytest.approx(power, rel=1e-12, abs=1e-13)
                pressing = np.zeros(12)
                push_apart(places, i, meets, frames, scaled(2.0, meets.normal), pressing)
                assert pressing @ v == pytest.approx(2.0 * gap(places, i, frames, v, v).rate, rel=1e-12, abs=1e-13)

    def test_compiled_it_is_the_same(self):
        """The loops of a run call these functions compiled, for the number of axes that they are given."""
        places = tumbling()[1].places
        for q, v, a in tumbles(18, 5):
            frames, total = frames_of(q, SPACE), np.zeros(12)
            found, applied = np.zeros((5, 4)), np.zeros(12)
            look(places, frames, v, a, found, applied)
            for i in range(5):
                np.testing.assert_allclose(found[i], gap(places, i, frames, v, a), rtol=1e-13, atol=1e-13)
                meets = where_friction_acts(places, meeting(places, i, frames))
                push_apart(places, i, meets, frames, scaled(1.0 + i, meets.normal), total)
            np.testing.assert_allclose(applied, total, rtol=1e-13, atol=1e-13)

    def test_friction_acts_halfway_between_sphere_and_face(self):
        """Along the normal that is half the gap and the radius below the point, on both bodies."""
        places = tumbling()[1].places
        for q, _, _ in tumbles(16, 5):
            frames = frames_of(q, SPACE)
            for i in range(len(places.body)):
                meets = meeting(places, i, frames)
                acts = where_friction_acts(places, meets)
                below = (0.5 * meets.gap + places.radius) * np.array(meets.normal)
                np.testing.assert_allclose(np.subtract(meets.arm, acts.arm), below, atol=1e-14)
                np.testing.assert_allclose(np.subtract(meets.face_arm, acts.face_arm), below, atol=1e-14)

    def test_the_gradient_is_the_rate_of_the_energy(self):
        """Along a motion, of springs, ties, weight and forces; openings and forces with points turned by scipy."""
        rest, structure = tumbling()
        potential, h, pressed = Potential(structure), 1e-5, set()
        for q, v, a in tumbles(17, 20):
            before, after = (potential.energy(later(q, v, a, s)) for s in (-h, h))
            gradient = potential.gradient(q)
            pressed |= set(np.flatnonzero(potential.openings(q) < 0))
            assert (after - before) / (2 * h) == pytest.approx(gradient @ v, abs=1e-6 * np.abs(gradient).max())
            rates = [gap(structure.places, i, frames_of(q, SPACE), v, v).rate for i in range(5)]
            rates += [slack(structure.ties, i, frames_of(q, SPACE), v, v).rate for i in range(3)]
            np.testing.assert_allclose(potential.rates(q) @ v, rates, atol=1e-12)
            for i, body in enumerate(structure.forces.body):
                at = structure.forces.at[i]
                moved = material(rest, q, body, at) - rest[body] - at
                np.testing.assert_allclose(displacement(structure.forces, i, frames_of(q, SPACE)), moved, atol=1e-14)
        assert pressed >= set(range(5)) | {5, 6}  # every contact, and the ties that are short


@pytest.mark.parametrize("freedom", [PLANE, SPACE], ids=["plane", "space"])
def test_the_ground_pushes_every_body_along_its_two_directions(freedom):
    """-m times the mean accelerations, along x and upwards; what has no mass in these directions is not pushed."""
    x, z = (mr.GroundMotion([a, a], 0.5) for a in (2.0, -3.0))
    masses, applied = np.arange(1.0, 2 * freedom.nv + 1), np.zeros(2 * freedom.nv)
    push_ground(Ground.from_motions(x, z), masses, freedom.axes, 0.2, 0.1, applied)
    accelerations = np.zeros((2, freedom.nv))
    accelerations[:, 0], accelerations[:, freedom.translations - 1] = 2.0, -3.0
    np.testing.assert_allclose(applied, -masses * accelerations.ravel())
