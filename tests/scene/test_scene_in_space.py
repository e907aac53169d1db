"""Scenes of space: what stands, what holds it, and when its first corner lifts."""

import dataclasses
import math

import numpy as np
import pytest
from scenes import changed
from scipy.optimize import approx_fprime
from scipy.spatial.transform import Rotation
from space_scenes import box

import mjrock as mr
from mjrock.geometry.frames import PLANE, SPACE
from mjrock.geometry.poses import angles, at_rest, coordinate_rates, from_rates, moved, turned
from mjrock.problem.wall.effect import LinkLaw
from mjrock.quantities import GRAVITY
from mjrock.scene.masses import coupling, products_of
from mjrock.scene.parts import ConstantForces, Links
from mjrock.scene.rest import settled

SKEW = Rotation.from_euler("xyz", (0.4, -0.3, 0.7)).as_matrix()


def pulled(**parts):
    """A box with a tie and a force, none of them along an axis."""
    stay = Links(("stay",), [0], [(0.3, 0.1, 0.9)], [-1], [(-1.5, -0.8, 0.2)], [LinkLaw(2e6, 2.633)])
    pull = ConstantForces(("pull",), [0], [(-0.2, 0.15, 0.7)], [(900.0, -700.0, -3e3)])
    return box((0.6, 0.4, 2.0), **{"links": stay, "forces": pull} | parts)


class TestPoses:
    def test_a_pose_is_moved_by_a_turn_about_its_own_axes(self):
        pose = moved(at_rest(1, SPACE), np.array([0.1, 0.2, 0.3, 0.4, -0.3, 0.2]), SPACE)
        again = moved(pose, np.array([0.0, 0.0, 0.0, -0.1, 0.5, 0.3]), SPACE)
        turn = Rotation.from_rotvec((0.4, -0.3, 0.2)) * Rotation.from_rotvec((-0.1, 0.5, 0.3))
        np.testing.assert_allclose(again[:3], (0.1, 0.2, 0.3))
        np.testing.assert_allclose(again[3:], np.roll(turn.as_quat(), 1), atol=1e-15)
        assert turned(again, SPACE)[0] == pytest.approx(turn.magnitude(), abs=1e-15)
        assert angles(again, pose, SPACE)[0] == pytest.approx(math.sqrt(0.35), abs=1e-15)

    @pytest.mark.parametrize("freedom", [PLANE, SPACE])
    def test_rates_of_coordinates(self, freedom):
        rng = np.random.default_rng(1)
        pose = moved(at_rest(2, freedom), rng.normal(0, 0.5, 2 * freedom.nv), freedom)
        velocity, h = rng.normal(0, 1, 2 * freedom.nv), 1e-6
        rates = (moved(pose, h * velocity, freedom) - moved(pose, -h * velocity, freedom)) / (2 * h)
        np.testing.assert_allclose(coordinate_rates(pose, velocity, freedom), rates, atol=1e-9)
        long = 1.0 if freedom == PLANE else 1 + 1e-3 * (np.arange(14) % 7 > 2)  # interpolation makes quaternions longer
        back, again = from_rates(long * pose, long * rates, freedom)
        np.testing.assert_allclose(back, pose, atol=1e-15)
        np.testing.assert_allclose(again, velocity, atol=1e-8)


class TestMasses:
    def test_energy_of_a_body_that_turns_about_skew_axes(self):
        tensor = SKEW @ np.diag((3.0, 4.0, 5.0)) @ SKEW.T
        scene = box((0.6, 0.4, 2.0), tensor=tensor, settled=at_rest(1, SPACE))
        v = np.array([1.0, -2.0, 0.5, 0.3, 0.7, -0.4])
        half = 0.5 * (scene.bodies.mass[0] * v[:3] @ v[:3] + v[3:] @ tensor @ v[3:])
        assert scene.accounts(at_rest(1, SPACE)[None], v[None])[0][0, 0] == pytest.approx(half, rel=1e-14)
        assert coupling(scene.bodies.products, v) == pytest.approx(v[3:] @ (tensor - np.diag(np.diag(tensor))) @ v[3:])

    def test_frequencies_do_not_depend_on_the_axes(self):
        block = box((0.6, 0.4, 2.0))
        skew = box((0.6, 0.4, 2.0), turned=SKEW, settled=at_rest(1, SPACE))
        assert skew.highest_frequency == pytest.approx(block.highest_frequency, rel=1e-12)
        assert skew.rocking_frequency == pytest.approx(block.rocking_frequency, rel=1e-12)
        assert block.highest_frequency == pytest.approx(math.sqrt(1e8 * 0.24 / 960), rel=1e-12)  # heave
        tall = pulled()
        rates = np.array([0.3 + 1.5, 0.1 + 0.8, 1.9 - 0.2])
        way = rates / np.linalg.norm(rates)
        turning = np.cross((0.3, 0.1, 0.9), way)
        inverse = 1 / 960 + turning @ np.linalg.solve(tall.bodies.inertia[0], turning)
        assert tall.tie_frequency == pytest.approx(math.sqrt(2e6 * inverse), rel=1e-12)

    def test_products_that_are_rounding(self):
        tensor = np.diag((1.0, 2.0, 2.5))
        tensor[0, 1] = tensor[1, 0] = 1e-13
        assert not products_of(tensor[None]).any()

    @pytest.mark.parametrize(
        ("inertia", "message"),
        [
            (np.diag((1.0, 2.0, 3.1)), "larger than the sum of the other two"),
            (np.diag((1.0, 2.0, -1.0)), "not a symmetric tensor with three positive moments"),
            (np.array([(3.0, 0.1, 0), (0, 3, 0), (0, 0, 3)]), "not a symmetric tensor with three positive moments"),
        ],
    )
    def test_tensors_that_no_body_has(self, inertia, message):
        with pytest.raises(ValueError, match=message):
            box((0.6, 0.4, 2.0), tensor=inertia)


@pytest.fixture
def at():
    """A potential, and a pose at which the tie is taut and two corners are open."""
    scene = pulled()
    return scene.potential, moved(at_rest(1, SPACE), np.array([1e-3, -2e-3, -3e-3, 0.02, 0.03, 0.05]), SPACE)


class TestPotential:
    def test_gradient_stiffness_and_curvature_are_derivatives(self, at):
        potential, pose = at
        pressed = potential.pressed(pose) > 0
        assert pressed[4]
        assert pressed[:4].sum() == 2

        def energy(motion):
            return potential.energy(moved(pose, motion, SPACE))

        none = np.zeros(6)
        np.testing.assert_allclose(potential.gradient(pose), approx_fprime(none, energy, 1e-7), atol=2.0)
        stiffness = potential.stiffness(pose, np.where(pressed, potential.springs, 0.0))
        hessian = (stiffness + potential.curvature(pose)).toarray()
        h, second = 1e-5, np.empty((6, 6))
        for i, row in enumerate(h * np.eye(6)):
            for j, column in enumerate(h * np.eye(6)):
                ends = energy(row + column) - energy(row - column) - energy(column - row) + energy(-row - column)
                second[i, j] = ends / (4 * h * h)
        np.testing.assert_allclose(hessian, second, atol=1e-5 * np.abs(second).max())

    def test_friction_has_a_geometric_stiffness(self, at):
        potential, pose = at
        drag = np.array([(3e4, -1e4), (-1e4, 2e4), (0.0, 0.0), (2e4, 5e3)])
        h, second = 1e-4, np.empty((6, 6))

        def slid(motion):
            return float((drag * potential.slips(moved(pose, motion, SPACE))).sum())

        for i, row in enumerate(h * np.eye(6)):
            for j, column in enumerate(h * np.eye(6)):
                ends = slid(row + column) - slid(row - column) - slid(column - row) + slid(-row - column)
                second[i, j] = ends / (4 * h * h)
        found = (potential.curvature(pose, drag) - potential.curvature(pose)).toarray()
        np.testing.assert_allclose(found, -second, atol=1e-6 * np.abs(second).max())

    def test_rates_of_slips_are_derivatives(self):
        """Of two drums that have turned as one, the upper of them spun and slid on its joint, which does not open."""
        column = mr.masonry_scene(mr.MasonryCase(mr.Masonry.column(0.5, 1.0, 2, k_n=1e9, friction=0.6), 1.0))
        turn = Rotation.from_euler("xyz", (0.2, -0.1, 0.3))
        places = turn.apply(column.bodies.rest + np.array([(0, 0, 0), (0.02, -0.01, 0)])) - column.bodies.rest
        drums = np.column_stack([places, np.tile(np.roll(turn.as_quat(), 1), (2, 1))]).ravel()
        potential, pose, h = column.potential, moved(drums, 0.4 * np.eye(12)[11], SPACE), 1e-6
        on_joint = column.contacts.face_body >= 0
        for j, way in enumerate(h * np.eye(12)):
            ends = (potential.slips(moved(pose, sign * way, SPACE)) for sign in (1, -1))
            slid = np.subtract(*ends) / (2 * h)
            for rates, wanted in zip(potential.slip_rates(pose), slid.T, strict=True):
                np.testing.assert_allclose(rates.toarray()[on_joint, j], wanted[on_joint], rtol=0, atol=1e-8)


class TestRest:
    def test_friction_within_its_cones_holds_what_springs_do_not(self):
        scene = pulled()
        pose, drag = settled(scene.potential, scene.contacts.k_s)
        left = scene.potential.gradient(pose.ravel())
        assert np.linalg.norm(left) > 100.0
        held = sum(
            rates.T @ along for rates, along in zip(scene.potential.slip_rates(pose.ravel()), drag.T, strict=True)
        )
        np.testing.assert_allclose(left, held, rtol=0, atol=1e-5)
        assert (
            np.linalg.norm(drag, axis=1) <= scene.contacts.friction * scene.contacts.k * scene.bears * (1 + 1e-9)
        ).all()

    def test_a_block_that_is_too_tall_for_its_base_falls(self):
        """Upright all forces balance. The corners resist a tilt by k_n w t (t / 2)^2, and m g h drives it."""
        soft = 960 * GRAVITY * 1.0 / (0.24 * 0.2**2)
        assert box((0.6, 0.4, 2.0), k_n=1.1 * soft).at_rest[0, 2] < -0.03
        with pytest.raises(ValueError, match="do not stand on their contacts"):
            _ = box((0.6, 0.4, 2.0), k_n=0.9 * soft).at_rest

    def test_a_block_sinks_by_its_weight(self):
        scene = box((0.6, 0.4, 2.0))
        np.testing.assert_allclose(scene.at_rest, [(0, 0, -960 * GRAVITY / 24e6, 1, 0, 0, 0)], atol=1e-15)
        assert scene.rest_energies[2] == pytest.approx((960 * GRAVITY) ** 2 / (2 * 24e6))

    @pytest.mark.parametrize("degrees", [0, 30, 45, 70, 90])
    def test_the_first_corner_lifts_at_the_angle_of_the_push(self, degrees):
        """a/g = 1 / (h cos/b + h sin/t): the moment of the push takes the share of one corner of four."""
        phi = math.radians(degrees)
        share = 1 / (2.0 * math.cos(phi) / 0.6 + 2.0 * math.sin(phi) / 0.4)
        lifted = ((1.001, 3),) if 0 < degrees < 90 else ()  # on two corners alone it would not stand
        for times, closed in ((0.999, 4), *lifted):
            push = times * share * 960 * GRAVITY * np.array([math.cos(phi), math.sin(phi), 0.0])
            scene = box((0.6, 0.4, 2.0), k_n=1e12, forces=ConstantForces(("push",), [0], [(0, 0, 0)], [push]))
            assert (scene.bears > 0).sum() == closed

    def test_scenes_of_plane_and_space_do_not_mix(self):
        scene = box((0.6, 0.4, 2.0))
        with pytest.raises(ValueError, match=r"face_at of the contacts has the shape \(4, 2\); \(4, 3\) is needed"):
            changed(scene, contacts={"face_at": np.zeros((4, 2))})

    def test_masonry_of_prisms_is_at_rest_as_in_the_plane(self):
        """Two drums that lean on each other by an inclined joint."""
        lower = [(0, 0), (1, 0), (1, 0.8), (0, 1.0)]
        upper = [(0, 1.0), (1, 0.8), (1, 1.7), (0, 1.7)]
        ground = [(-1, -1), (2, -1), (2, 0), (-1, 0)]
        flat, solid = [], []
        for name, corners in (("ground", ground), ("lower", lower), ("upper", upper)):
            fixed = name == "ground"
            flat.append(mr.Polygon(corners, density=2000.0, length=0.7, fixed=fixed, name=name))
            ends = [(x, y, z) for y in (-0.35, 0.35) for x, z in corners]
            solid.append(mr.Polyhedron(ends, density=2000.0, fixed=fixed, name=name))
        planar, space = (
            mr.masonry_scene(mr.MasonryCase(mr.Masonry(blocks, k_n=1e8, frequency=50.0), 1.0))
            for blocks in (flat, solid)
        )
        x, z, theta = planar.at_rest.T
        none = np.zeros(2)
        wanted = np.column_stack([x, none, z, np.cos(theta / 2), none, np.sin(theta / 2), none])
        shear = np.abs(space.potential.slips(space.at_rest.ravel())).max()  # friction is that of stiff springs in space
        np.testing.assert_allclose(space.at_rest, wanted, rtol=0, atol=shear)
        assert shear < 2e-4 * np.abs(wanted[:, 2]).max()
        there = space.accounts(wanted.reshape(1, -1), np.zeros((1, 12)))[0][0]
        np.testing.assert_allclose(there, planar.rest_energies, rtol=1e-9, atol=1e-9)
        assert space.bodies.masses[[0, 2, 4]] == pytest.approx(planar.bodies.masses[:3])

    def test_effects_act_where_they_are(self):
        ground = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True, name="ground")
        wall = mr.Polyhedron.box((0.6, 0.4, 2.0), (0, 0, 1.0), name="wall")
        low = mr.Polyhedron.box((0.6, 0.4, 1.0), (1.0, 0, 0.5), name="low")
        effects = (
            mr.Tie(block=1, at=(0.3, 0.0, 1.8), anchor_block=2, anchor=(1.0, 0.0, 1.0), stiffness=1e6, slack=0.01),
            mr.AddedMass(block=1, at=(0.1, 0.2, 1.5), mass=240.0),
            mr.Thrust(block=1, at=(0.3, 0.1, 1.0), force=100.0, direction=(0.0, 1.0, 0.0)),
        )
        scene = mr.masonry_scene(mr.MasonryCase(mr.Masonry([ground, wall, low], k_n=1e9), 1.0, effects=effects))
        np.testing.assert_allclose(scene.bodies.rest[0], (0.02, 0.04, 1.1))
        np.testing.assert_allclose(scene.bodies.rest[0] + scene.links.sprung.at[0], (0.3, 0.0, 1.8))
        np.testing.assert_allclose(scene.bodies.rest[1] + scene.links.sprung.anchor_at[0], (1.0, 0.0, 1.0))
        assert scene.links.sprung.anchor_body[0] == 1
        assert scene.links.sprung.law["reach"][0] == pytest.approx(math.hypot(0.7, 0.8) + 0.01)
        np.testing.assert_allclose(scene.forces.force, [(0, 100, 0)])
        apart = np.array((0.1, 0.2, 0.5))
        added = 960 * 240 / 1200 * (apart @ apart * np.eye(3) - np.outer(apart, apart))
        np.testing.assert_allclose(scene.bodies.inertia[0], wall.inertia + added)
        assert dataclasses.replace(scene, title="another").key == scene.key
