"""MuJoCo in space: the text, the plane inside space, and motions that are known."""

import math
import xml.etree.ElementTree as ET

import mujoco
import numpy as np
import pytest
import scenes
from scenes import changed, stock_takes
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from space_scenes import box, course, fitted, fixed

import mjrock as mr
from mjrock.engine.energy_work import ledger
from mjrock.engine.mjcf import scene_mjcf
from mjrock.engine.model import Engine
from mjrock.geometry.frames import SPACE
from mjrock.geometry.poses import at_rest
from mjrock.quantities import GRAVITY
from mjrock.scene.parts import Bodies, ContactPoints

BLOCK = (0.6, 0.4, 2.0)
UPRIGHT = (0, 0, 0, 1, 0, 0, 0)
SKEW = Rotation.from_euler("xyz", (0.4, -0.3, 0.7)).as_matrix()
slow = pytest.mark.slow


def tilted(scene, angle, plan):
    """Pose of a box turned by an angle [rad] towards a plan angle, its lowest corners where they were and pressed."""
    turn = Rotation.from_rotvec(angle * np.array([-math.sin(plan), math.cos(plan), 0.0]))
    turned = turn.apply(np.array(scene.contacts.at))
    lowest = int(turned[:, 2].argmin())
    return scene.lowered(np.array([[*(scene.contacts.at - turned)[lowest], *np.roll(turn.as_quat(), 1)]]))


def planar_block():
    """`box(BLOCK)` in the plane."""
    b, h, mass = 0.3, 1.0, 960.0
    k = np.full(2, 1e8 * 0.24 / 2)
    outline = np.array([(-b, -h), (b, -h), (b, h), (-b, h)])
    ends = [0, 0], [(-b, -h), (b, -h)], [-1, -1], [(0, 0)] * 2, [(0, 1)] * 2
    contacts = ContactPoints(*ends, k, 0.1 * np.sqrt(mass / k.sum()) * k, [0.6] * 2, [0, 0], ("base",))
    return mr.Scene(Bodies(("block",), [mass], [mass * (b**2 + h**2) / 3], [(0, h)], (outline,), 0.4), contacts)


def prisms(**options):
    """Masonry of two drums on the ground, one of them no box, in the plane and in space."""
    lower = [(-0.3, 0), (0.3, 0), (0.3, 0.6), (-0.3, 0.7)]
    upper = [(-0.3, 0.7), (0.3, 0.6), (0.3, 1.3), (-0.3, 1.3)]
    ground = [(-2, -1), (2, -1), (2, 0), (-2, 0)]
    flat, solid = [], []
    for name, corners in (("ground", ground), ("lower", lower), ("upper", upper)):
        flat.append(mr.Polygon(corners, length=0.5, fixed=name == "ground", name=name))
        ends = [(x, y, z) for y in (-0.25, 0.25) for x, z in corners]
        solid.append(mr.Polyhedron(ends, fixed=name == "ground", name=name))
    options = {"k_n": 1e9, "frequency": 100.0, "friction": 1.2} | options
    return mr.Masonry(flat, **options), mr.Masonry(solid, **options)


def in_plane(pose):
    """x, z and theta of poses of space, shape (..., 3)."""
    theta = 2 * np.arctan2(pose[..., 5], pose[..., 3])
    return np.stack([pose[..., 0], pose[..., 2], theta], axis=-1)


def sliding_down(mu, slope, speed, duration):
    """Where Coulomb friction brings a point that starts across a slope: down it and across it [m]."""

    def rates(t, state):
        velocity = state[2:]
        down = GRAVITY * np.array([math.sin(slope), 0.0])
        return [*velocity, *(down - mu * GRAVITY * math.cos(slope) * velocity / np.linalg.norm(velocity))]

    return solve_ivp(rates, (0, duration), [0, 0, 0, speed], rtol=1e-11, atol=1e-12).y[:2, -1]


def on_a_slope(run, *, mu=0.3, slope=0.4):
    """How far from Coulomb's answer a block is that slid for a second, and how far it rose off the slope [m]."""
    turn = Rotation.from_euler("y", slope).as_matrix()
    size, k_n = (0.6, 0.4, 0.3), 1e8
    depth = 2000 * 0.3 * GRAVITY * math.cos(slope) / k_n
    scene = box(size, turned=turn, friction=mu, k_n=k_n, settled=[[*(-depth * turn[:, 2]), 1, 0, 0, 0]])
    steps = run(scene, course(scene, 1.0, velocity=[*turn[:, 1], 0, 0, 0]))
    slid = (steps.pose[-1, :3] - steps.pose[0, :3]) @ turn
    return np.abs(slid[:2] - sliding_down(mu, slope, 1.0, steps.t[-1])).max(), (steps.pose[:, :3] @ turn)[:, 2].max()


def spun(run):
    """Angle by which a block on four corners spins on until friction has stopped it, over that of Coulomb [-]."""
    size, mu, w = (0.6, 0.4, 0.3), 0.4, 3.0
    scene = box(size, friction=mu)
    steps = run(scene, course(scene, 1.0, velocity=[0, 0, 0, 0, 0, w]))
    slowing = mu * scene.bodies.mass[0] * GRAVITY * math.hypot(0.3, 0.2) / scene.bodies.inertia[0, 2, 2]
    return 2 * math.atan2(steps.pose[-1, 6], steps.pose[-1, 3]) / (w**2 / (2 * slowing))


class TestText:
    def test_the_text_is_the_run(self):
        """Stock MuJoCo repeats a run at a fixed step of masonry in space, which starts with a velocity."""
        case = mr.MasonryCase(prisms()[1], 0.05, velocity=[(0, 0, 0, 0.1, 0.2, 0.3), (0.1, 0.2, 0, 0.5, 0.4, -0.3)])
        with pytest.warns(UserWarning, match="pressed apart"):
            run = mr.simulate(case, timestep=2e-4)
        stock_takes(run.pose, mr.masonry_mjcf(case, 2e-4), 1e-15)
        assert np.abs(run.pose[-1] - run.pose[0]).max() > 1e-3

    def test_joints_and_names(self):
        model = mujoco.MjModel.from_xml_string(scene_mjcf(box(BLOCK), 1e-3))
        assert [model.joint(i).name for i in range(model.njnt)] == ["x", "y", "z", "turn"]
        assert (model.nq, model.nv, model.npair) == (7, 6, 4)
        assert model.camera("front").id == 0
        text = ET.fromstring(mr.masonry_mjcf(mr.MasonryCase(prisms()[1], 1.0), 1e-3))
        assert [mesh.get("name") for mesh in text.iter("mesh")] == ["lower", "upper"]

    def test_mujoco_weighs_skew_bodies_as_the_scene_does(self):
        scene = box(BLOCK, turned=SKEW, settled=[UPRIGHT])
        engine = Engine.compile(scene)  # raises where a body weighs otherwise
        mujoco.mj_forward(engine.model, engine.data)
        mass = np.zeros((6, 6))
        mujoco.mj_fullM(engine.model, engine.data, mass)
        np.testing.assert_allclose(mass[3:, 3:], scene.bodies.inertia[0], rtol=0, atol=1e-10)
        np.testing.assert_allclose(mass[:3, :3], 960 * np.eye(3), atol=1e-10)


class TestPlaneInSpace:
    def test_a_block_rocks_as_in_the_plane(self):
        flat, space = planar_block(), box(BLOCK)
        pose = tilted(space, 0.12, 0.0)
        planar = scenes.fixed_steps(flat, scenes.course(flat, pose=in_plane(pose)), 1e-3)
        steps = fixed(space, course(space, 1.0, pose=pose), 1e-3)
        np.testing.assert_allclose(in_plane(steps.pose), planar.pose, rtol=0, atol=1e-7)
        assert np.abs(steps.pose[:, [1, 4, 6]]).max() < 1e-12

    def test_two_drums(self):
        motion = mr.GroundMotion(7.0 * np.sin(2 * math.pi * 2.0 * np.arange(0, 0.5, 1e-2)), 1e-2)
        planar, space = (
            mr.simulate(mr.MasonryCase(masonry, 0.4, motion=motion), timestep=2e-4, coulomb=True)
            for masonry in prisms()
        )
        assert np.abs(planar.theta).max() > 1e-3
        np.testing.assert_allclose(in_plane(space.pose), planar.pose, rtol=0, atol=1e-7)
        np.testing.assert_allclose(space.opening, planar.opening, rtol=0, atol=1e-7)

    @slow
    def test_two_drums_with_steps_that_fit(self):
        motion = mr.GroundMotion(7.0 * np.sin(2 * math.pi * 2.0 * np.arange(0, 0.5, 1e-2)), 1e-2)
        planar, space = (
            mr.simulate(mr.MasonryCase(masonry, 0.8, motion=motion), accuracy=1e-4) for masonry in prisms()
        )
        np.testing.assert_allclose(in_plane(space.pose), planar.pose, rtol=0, atol=2e-3)

    @slow
    @pytest.mark.parametrize(("accuracy", "error"), [(1e-2, 2e-2), (1e-3, 5e-4), (1e-5, 1.5e-4)])
    def test_steps_that_fit_rock_as_fixed_ones(self, accuracy, error):
        scene = box(BLOCK)
        start = course(scene, 2.0, pose=tilted(scene, 0.12, 0.0))
        exact, steps = fixed(scene, start, 1e-5), fitted(scene, start, accuracy)
        t = np.linspace(0, 2, 201)
        for j in (0, 2):
            apart = np.interp(t, exact.t, exact.pose[:, j]) - np.interp(t, steps.t, steps.pose[:, j])
            assert np.abs(apart).max() < error


def test_the_same_scene_turned_about_the_vertical():
    plain, turn = box(BLOCK), Rotation.from_euler("z", 37, degrees=True).as_matrix()
    turned, pose = box(BLOCK, turned=turn), tilted(plain, 0.1, 0.3)
    other = np.array([[*(turn @ pose[0, :3]), pose[0, 3], *(turn @ pose[0, 4:])]])
    motions = [fixed(s, course(s, 0.5, pose=p), 1e-3).pose for s, p in ((plain, pose), (turned, other))]
    assert np.abs(motions[1][:, :3] @ turn - motions[0][:, :3]).max() < 1e-8 * np.abs(motions[0][:, :3]).max()


class TestFriction:
    def test_coulomb_across_a_slope(self):
        apart, risen = on_a_slope(lambda scene, start: fixed(scene, start, 1e-3, coulomb=True))
        assert apart < 3e-5
        assert risen < 0  # it stays pressed in, where the rows of the text lift it

    def test_the_rows_of_the_text_lift_what_slides(self):
        apart, risen = on_a_slope(lambda scene, start: fixed(scene, start, 1e-3))
        assert 1e-4 < apart < 2e-3
        assert risen > 5e-5

    @slow
    def test_coulomb_across_a_slope_with_steps_that_fit(self):
        assert on_a_slope(lambda scene, start: fitted(scene, start, 1e-3))[0] < 5e-5

    def test_a_spin_on_four_corners_ends(self):
        assert spun(lambda scene, start: fixed(scene, start, 1e-3, coulomb=True)) == pytest.approx(1, abs=2e-5)
        assert spun(lambda scene, start: fixed(scene, start, 1e-3)) == pytest.approx(1, abs=1e-4)

    @slow
    def test_a_spin_ends_with_steps_that_fit(self):
        assert spun(lambda scene, start: fitted(scene, start, 1e-4)) == pytest.approx(1, abs=2e-4)


def torque_free(run):
    """Largest error of the angular velocity of a body in free flight [rad/s], and the energy that it has gained [-]."""
    moments = np.array([432.0, 1046.0, 1306.0])
    tensor, w = SKEW @ np.diag(moments) @ SKEW.T, SKEW @ (0.3, 1.0, 0.2)
    flying = box((1.0, 1.5, 2.0), tensor=tensor, height=1e3, settled=[UPRIGHT], friction=0.0)
    scene = changed(flying, bodies={"mass": [3000.0]})
    steps = run(scene, course(scene, 1.0, velocity=[0, 0, 0, *w]))

    def rates(t, w):
        return -np.linalg.solve(tensor, np.cross(w, tensor @ w))

    exact = solve_ivp(rates, (0, 1.1), w, rtol=1e-12, atol=1e-13, dense_output=True).sol(steps.t).T
    energy = np.einsum("ni,ij,nj->n", steps.velocity[:, 3:], tensor, steps.velocity[:, 3:])
    return len(steps.t), np.abs(steps.velocity[:, 3:] - exact).max(), energy[-1] / energy[0] - 1


class TestFlight:
    def test_the_text_is_first_order(self):
        errors = [torque_free(lambda s, c, h=h: fixed(s, c, h))[1] for h in (1e-2, 5e-3)]
        assert errors[0] / errors[1] == pytest.approx(2, abs=0.1)

    @slow
    def test_steps_that_fit_are_second_order(self):
        (steps, error, gain), (more, less, _) = (torque_free(lambda s, c, a=a: fitted(s, c, a)) for a in (1e-3, 1e-5))
        assert math.log(error / less) / math.log(more / steps) == pytest.approx(2, abs=0.1)
        assert error < 2e-5
        assert abs(gain) < 1e-5


@slow
class TestImpact:
    def test_on_an_edge_it_keeps_what_rocking_theory_says(self):
        """A stiff overdamped base, square in plan: (1 - 3/2 sin(alpha)^2)^2 = 0.8313 of the energy."""
        size, alpha = (0.5, 0.5, 2.0), math.atan(0.25)
        scene = box(size, k_n=1e10, xi=1.0, friction=2.0)
        steps = fitted(scene, course(scene, 1.5, pose=tilted(scene, 0.06, 0.0)), 1e-4)
        theta = in_plane(steps.pose)[:, 2]
        first, second = np.flatnonzero(np.diff(np.sign(theta)))[:2]
        energies = np.cos(alpha - np.abs([theta[0], theta[first:second].min()])) - math.cos(alpha)
        assert energies[1] / energies[0] == pytest.approx((1 - 1.5 * math.sin(alpha) ** 2) ** 2, abs=1.5e-3)

    def test_the_ledger_of_a_corner_that_rocks_closes(self):
        scene = box(BLOCK)
        motion = mr.GroundMotion(2.0 * np.sin(2 * math.pi * 1.5 * np.arange(0, 2.0, 1e-2)), 1e-2)
        start = course(scene, 2.0, pose=tilted(scene, 0.1, 0.5), motion=motion, transverse=motion, vertical=motion)
        steps = fitted(scene, start, 1e-4)
        book = ledger(scene, start, steps)
        assert np.abs(book.residual).max() < 2e-3 * book.potential[0]
        assert book.dashpots["base"][-1] > 10.0
        assert abs(book.ground[-1]) > 10.0


@slow
@pytest.mark.parametrize(("timestep", "error"), [(1e-3, 2e-3), (1e-4, 2e-4)])
def test_on_a_corner_it_keeps_energy_and_angular_momentum(timestep, error):
    """A block pivots on a corner that sticks, and spins about the vertical through it."""
    scene = box(BLOCK, k_n=1e10, friction=5.0)
    pose = tilted(scene, 0.25, 0.4)
    turn = Rotation.from_quat(np.roll(pose[0, 3:], -1))
    pivot = scene.contacts.at[int(turn.apply(np.array(scene.contacts.at))[:, 2].argmin())]
    velocity = np.cross((0, 0, 1.0), -turn.apply(np.array(pivot)))
    steps = fixed(scene, course(scene, 0.5, pose=pose, velocity=[*velocity, *turn.inv().apply((0, 0, 1.0))]), timestep)
    energy = scene.energy(steps.pose[:, None], steps.velocity[:, None])
    turns = Rotation.from_quat(np.roll(steps.pose[:, 3:], -1, axis=1))
    momentum = turns.apply(steps.velocity[:, 3:] @ scene.bodies.inertia[0])
    momentum += scene.bodies.mass[0] * np.cross(-turns.apply(np.array(pivot)), steps.velocity[:, :3])
    assert np.ptp(energy) < error * energy[0]
    assert np.ptp(momentum[:, 2]) < error * momentum[0, 2]


def test_a_damper_between_two_blocks_slows_both():
    """They slide apart on smooth ground and turn, as the damper holds them askew. Momentum stays."""
    ground = mr.Polyhedron.box((8, 8, 1), (0, 0, -0.5), fixed=True, name="ground")
    pair = [mr.Polyhedron.box((0.5, 0.5, 0.3), (x, 0, 0.15), name=name) for x, name in ((-1, "left"), (1, "right"))]
    masonry = mr.Masonry([ground, *pair], k_n=1e8, friction=0.0, frequency=100.0)
    damper = mr.Damper(at=(0.75, 0.1, 0.15), c=500.0, block=2, anchor=(-0.75, 0, 0.15), anchor_block=1)
    apart = [(0, 0.1, 0, 0, 0, 0), (0.4, 0.1, 0, 0, 0, 0)]
    case = mr.MasonryCase(masonry, 0.3, velocity=apart, effects=damper)
    run = mr.simulate(case, accuracy=1e-4, ledger=True)
    momentum = run.velocity[:, :, :2].sum(axis=1)
    np.testing.assert_allclose(momentum, np.broadcast_to([0.4, 0.2], momentum.shape), atol=1e-12)
    assert run.ledger.dashpots["damper_0"][-1] > 0.2 * run.energy[0]
    assert np.abs(run.energy_residual).max() < 1e-4 * run.energy[0]
    explicit = mr.solve_explicit(case, timestep=1e-5)
    assert np.abs(run.pose - explicit.pose).max() < 1e-5
    stock_takes(mr.simulate(case, timestep=1e-3).pose, mr.masonry_mjcf(case, 1e-3), 1e-13)


def test_a_dome_stays_where_it_rests():
    """A ring of voussoirs wedges itself, and its friction is within the cones from the first step on."""
    scene = mr.masonry_scene(mr.MasonryCase(mr.Masonry.dome(2.5, 0.25, 6, 3, k_n=1e9, friction=0.7), 1.0))
    sunk = np.abs(scene.at_rest[:, :3]).max()
    assert sunk > 1e-4
    for pose, least, most in ((None, 0.0, 1e-4), (at_rest(18, SPACE), 0.1, 10.0)):
        run = fixed(scene, course(scene, 0.01, pose=pose, velocity=np.zeros((18, 6))), 2e-4)
        place = run.pose.reshape(-1, 18, 7)[:, :, :3]
        far = np.abs(place - place[0]).max()
        assert least * sunk <= far < most * sunk


def test_a_fallen_block_is_named_and_ends_the_run():
    ground = mr.Polyhedron.box((8, 8, 1), (0, 0, -0.5), fixed=True, name="ground")
    block = mr.Polyhedron.box(BLOCK, (0, 0, 1.0), name="block")
    case = mr.MasonryCase(mr.Masonry([ground, block], k_n=1e8), 3.0, velocity=[(0, 3.0, 0, -3.0, 0, 0)])
    answer = mr.simulate(case, timestep=1e-3, coulomb=True)
    assert list(answer.fallen) == ["block"]
    assert answer.t[-1] < 2.0
    assert answer.tilt[-1, 0] == pytest.approx(math.pi / 2, abs=0.02)


@slow
def test_a_step_too_long_for_masonry_that_falls_apart_is_refused_by_name():
    walls = mr.Masonry.facade(1.5, 0.75, 0.5, (0.5, 0.25), k_n=1e9, frequency=100.0)
    motion = mr.GroundMotion.sine(9.0, 0.3)
    refused = pytest.raises(mr.SimulationError, match="joints that slide are unstable at a fixed step beyond")
    with pytest.warns(UserWarning, match="does not resolve"), refused:
        mr.simulate(mr.MasonryCase(walls, 0.3, motion=motion), timestep=4e-3)


def test_a_block_that_is_too_light_to_turn_in_mujoco_is_refused_by_name():
    corners = [(x, y, z) for x, z in ((0, 0), (1.1e-3, 0), (0, 6e-4)) for y in (0, 1.1e-3)]
    chip = mr.Polyhedron(corners, density=100.0, name="chip")
    ground = mr.Polyhedron.box((1, 1, 1), (0, 0, -0.5), fixed=True)
    case = mr.MasonryCase(mr.Masonry([ground, chip], k_n=1e7, friction=0.7), 1e-4)
    assert mr.solve_explicit(case).outcome is mr.Outcome.AT_REST
    with pytest.raises(ValueError, match=r"chip has a moment of inertia of \S+e-15 kg m2; MuJoCo takes .* 1e-14 kg m2"):
        mr.simulate(case)
