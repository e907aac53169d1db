"""Explicit steps in space: closed forms, conservation, the plane inside space, and what does not depend on the axes."""

import math

import numpy as np
import pytest
from everyday import among, crossed, slow
from scipy.integrate import solve_ivp
from scipy.special import ellipj
from space_blocks import GROUND, about_vertical, angles, block, followed, free_body, steady

import mjrock as mr
from mjrock.geometry.poses import tilt_of
from mjrock.scene.masonry import masonry_scene

PULSE = mr.GroundMotion.sine(3.0, 0.7)
G = mr.GRAVITY
prism = mr.Polyhedron.prism


def solve(masonry, duration, motion=None, *, timestep=None, ledger=False, output_step=1e-3, start=None, **options):
    case = mr.MasonryCase(masonry, duration, motion, **options)
    return mr.solve_explicit(case, timestep=timestep, ledger=ledger, output_step=output_step, start=start)


def precession(t, moments, spin):
    """Spin of a body without moments that starts in the plane of its first and third axes, by Jacobi's functions."""
    a, b, c = moments
    twice, square = (moments * spin**2).sum(), ((moments * spin) ** 2).sum()
    rate = math.sqrt((c - b) * (square - twice * a) / (a * b * c))
    m = (b - a) * (twice * c - square) / ((c - b) * (square - twice * a))
    sn, cn, dn, _ = ellipj(rate * t, m)
    second = math.sqrt((twice * c - square) / (b * (c - b)))
    return np.column_stack([spin[0] * cn, second * sn, spin[2] * dn])


@pytest.mark.parametrize("turned", [False, True])
def test_a_body_without_moments_precesses_as_jacobi_found(turned):
    """Of second order, and with its angular momentum to the last digit; also where its axes are not principal ones."""
    moments, spin = np.array([432.0, 1046.0, 1306.0]), np.array([1.0, 0.0, 1.2])
    axes = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0] if turned else np.eye(3)
    axes[:, 0] *= np.linalg.det(axes)
    errors = []
    for h in (1e-2, 1e-3):
        samples, system = followed(
            free_body(960.0, axes @ np.diag(moments) @ axes.T, axes @ spin), 5.0, h, round(0.1 / h)
        )
        exact = precession(0.1 * np.arange(len(samples.pose)), moments, spin) @ axes.T
        errors.append(np.abs(samples.velocity[1:, 0, 3:] - exact[1:]).max())
        kinetic = samples.energy["kinetic"] - 0.5 * 960 * (samples.velocity[:, 0, :3] ** 2).sum(axis=1)
        assert np.ptp(kinetic) < 0.1 * h**2 * kinetic[0]
    assert errors[1] < 2.5e-6
    assert errors[0] / errors[1] == pytest.approx(100, rel=0.02)
    np.testing.assert_allclose(system.bodies[0].momentum, axes @ np.diag(moments) @ axes.T @ axes @ spin, rtol=1e-14)


@pytest.mark.parametrize("k_s", among([None, 1e9], None))
def test_a_block_slides_askew_as_coulomb_has_it(k_s):
    """The ground accelerates along x, and the block moves along y at the start: its path bends."""
    push, friction = 0.42 * G, 0.3
    run = solve(
        block((1.0, 1.0, 0.4), k_s=k_s, friction=friction), 0.5, steady(-push, 1.0), velocity=[(0, 1, 0, 0, 0, 0)]
    )

    def rates(_, state):
        drag = -friction * G * state[2:] / np.hypot(*state[2:])
        return [*state[2:], drag[0] + push, drag[1]]

    path = solve_ivp(rates, (0, 0.5), [0, 0, 0, 1.0], rtol=1e-9, atol=1e-12).y[:2, -1]
    np.testing.assert_allclose(run.pose[-1, 0, :2], path, rtol=1e-3)
    assert run.tilt.max() < 1e-4


@pytest.mark.parametrize("k_s", [None, 1e9])
def test_a_block_spins_to_rest_on_its_four_corners(k_s):
    run = solve(block((1.0, 0.6, 0.4), 0.3, k_s=k_s, friction=0.3), 1.6, velocity=[(0, 0, 0, 0, 0, 3.0)], ledger=True)
    arm, square = 0.5 * math.hypot(1.0, 0.6), (1.0 + 0.36) / 12
    assert run.peak[0] == pytest.approx(9 / (2 * 0.3 * G * arm / square), rel=1e-4)
    assert run.outcome is mr.Outcome.AT_REST
    assert np.abs(run.energy_residual).max() < 1e-5 * run.energy[0]
    assert run.ledger.friction[-1] == pytest.approx(run.energy[0], rel=1e-3)


@pytest.mark.parametrize("angle", [slow(0.0), slow(0.4), slow(math.pi / 4), 1.2])
def test_first_uplift_and_tipping_at_an_angle_in_plan(angle):
    """A slow ramp: four points leave the ground as those of a rigid body on springs, and it tips about an edge."""
    b, d, h = size = (0.6, 0.4, 2.0)
    lifts = 1 / (h * math.cos(angle) / b + h * math.sin(angle) / d)
    tips = min(side / (h * way) for side, way in ((b, math.cos(angle)), (d, math.sin(angle))) if way > 1e-9)
    t, ramp = 0.1 * np.arange(251), tips * np.interp(0.1 * np.arange(251), [0, 10, 25], [0, 0.95, 1.05])
    masonry = block(size, -angle, friction=2.0, k_n=1e9, frequency=200.0)
    run = solve(masonry, 25.0, mr.GroundMotion(-G * ramp, 0.1), output_step=1e-2)
    multiplier = np.interp(run.t, t, ramp)
    corners = about_vertical([mr.Polyhedron.box(size)], -angle)[0].corners
    low = corners[corners[:, 2] < 0]
    w, x, y, z = run.pose[:, 0, 3:].T
    last_row = np.column_stack([2 * (x * z - w * y), 2 * (y * z + w * x), -2 * (x * x + y * y)])
    gaps = run.pose[:, 0, 2][:, None] + last_row @ low.T
    assert multiplier[np.argmax(gaps.max(axis=1) > 0)] == pytest.approx(lifts, rel=1e-3)
    assert multiplier[np.argmax(run.tilt[:, 0] > 0.3)] == pytest.approx(tips, rel=0.02)


def test_an_impact_on_an_edge_keeps_what_housner_found():
    """A stiff, overdamped base: (1 - 3/2 sin^2 alpha)^2 of the energy."""
    masonry = block((0.5, 0.5, 2.0), k_n=1e11, friction=1.0, xi=1.0, frequency=200.0)
    w = 0.4
    run = solve(masonry, 0.9, velocity=[(w, 0, 0.25 * w, 0, w, 0)])
    turning = run.velocity[:, 0, 4]
    flights = np.flatnonzero(np.diff(np.sign(turning)) != 0)
    before, after = (run.energy[i] for i in flights[[0, 1]])
    assert after / before == pytest.approx((1 - 1.5 / (1 + 16)) ** 2, rel=5e-3)


def both(plane, duration, motion=None, **options):
    """Responses of masonry in the plane and of the same as prisms, at the same steps."""
    given = {name: getattr(plane, name) for name in ("k_n", "friction", "k_s", "xi", "frequency")}
    space = mr.Masonry([prism(polygon) for polygon in plane.blocks], **given)
    flat_effects, effects = options.pop("effects", ((), ()))
    flat_supports, supports = options.pop("supports", ((), ()))
    of_flat, of_deep = options.pop("each", ({}, {}))
    options |= {"timestep": 1e-4, "ledger": True}
    flat = solve(plane, duration, motion, effects=flat_effects, supports=flat_supports, **options, **of_flat)
    return flat, solve(space, duration, motion, effects=effects, supports=supports, **options, **of_deep)


def assert_same(flat, deep, within):
    np.testing.assert_allclose(angles(deep), flat.theta, atol=within)
    np.testing.assert_allclose(deep.pose[:, :, [0, 2]], flat.pose[:, :, :2], atol=within)
    np.testing.assert_allclose(deep.velocity[:, :, [0, 2, 4]], flat.velocity, atol=1e3 * within)
    scale = np.abs(flat.energy).max()
    np.testing.assert_allclose(deep.energy, flat.energy, atol=1e3 * within * scale)
    for name in ("friction", "ground"):
        np.testing.assert_allclose(getattr(deep.ledger, name), getattr(flat.ledger, name), atol=1e3 * within * scale)


FLOOR = mr.Polygon([(-2, -1), (2, -1), (2, 0), (-2, 0)], fixed=True, name="ground")


def brick(left, right, low, high, name=None):
    return mr.Polygon([(left, low), (right, low), (right, high), (left, high)], name=name)


def test_the_plane_inside_space_a_rocking_block_with_effects():
    """A tie that yields and breaks, a damper, a load, a thrust, a mass, and a vertical motion of the ground."""
    plane = mr.Masonry([FLOOR, brick(-0.25, 0.25, 0, 2)], k_n=2e9, k_s=1e9, frequency=300.0)
    tie = {"stiffness": 1e6, "strength": 2e3, "ultimate": 3e-3, "block": 1}
    flat = (mr.Tie(1.8, **tie), mr.Damper(1.0, c=300.0, block=1), mr.Load(500.0, 2.0, 0.1, block=1),
            mr.Thrust(1.5, 100.0, block=1), mr.AddedMass(80.0, 1.9, -0.1, block=1))  # fmt: skip
    deep = (mr.Tie(at=(-0.25, 0, 1.8), **tie), mr.Damper(at=(-0.25, 0, 1.0), c=300.0, block=1),
            mr.Load(500.0, at=(0.1, 0, 2.0), block=1), mr.Thrust(at=(0, 0, 1.5), force=100.0, block=1),
            mr.AddedMass(80.0, at=(-0.1, 0, 1.9), block=1))  # fmt: skip
    run, spatial = both(plane, 1.0, PULSE, effects=(flat, deep), vertical=mr.GroundMotion.sine(1.0, 0.3))
    assert run.plastic["tie_0"].broken < 1.0
    assert_same(run, spatial, 1e-6)  # the search for the pose of rest ends at a tolerance
    np.testing.assert_allclose(spatial.plastic["tie_0"], run.plastic["tie_0"], rtol=1e-3)
    np.testing.assert_allclose(spatial.ties["tie_0"].force, run.ties["tie_0"].force, atol=2.0)
    assert np.abs(spatial.energy_residual).max() < 2 * np.abs(run.energy_residual).max()


def test_the_plane_inside_space_a_block_slides_over_an_edge_and_a_support_moves():
    """Thin blocks, whose prisms are of nearly the size of their sections, so that looks come at the same steps."""
    thin = [mr.Polygon(b.corners, fixed=b.fixed, name=b.name, length=0.02) for b in (FLOOR, brick(1.2, 1.9, 0, 0.5))]
    plane = mr.Masonry(thin, k_n=1e9, k_s=1e9, friction=0.2, frequency=300.0)
    t, far = [0.0, 0.2, 0.4], [0.0, -0.02, 0.0]
    moved = {"ground": (t, far, [0.0, 0.01, 0.0])}, {"ground": (t, far, [0.0] * 3, [0.0, 0.01, 0.0])}
    run, spatial = both(plane, 0.9, supports=moved, motion=steady(-5.0, 1.0))
    assert run.pose[-1, 0, 0] > 0.5
    assert abs(run.theta[-1, 0]) > 0.05  # it turns over the edge
    assert dict(spatial.fallen) == pytest.approx(
        dict(run.fallen), abs=0.01
    )  # prisms are larger and looked at otherwise
    assert list(run.fallen) == ["block_1"]
    assert run.pose[299, 0, 0] > 0.1  # what lies over the ground has become less by then
    count = int(0.6 / 1e-3)
    np.testing.assert_allclose(angles(spatial)[:count], run.theta[:count], atol=1e-9)


def test_the_plane_inside_space_a_block_spins_on_a_tie_a_damper_and_a_load():
    """It turns by more than a right angle, and is held and loaded at points far from its centroid."""
    plane = mr.Masonry([FLOOR, brick(-0.25, 0.25, 0, 1)], k_n=2e9, k_s=1e9, frequency=300.0)
    tie, damper = {"stiffness": 5e3, "block": 1}, {"c": 100.0, "block": 1}
    flat = mr.Tie(0.9, **tie), mr.Damper(0.2, **damper), mr.Load(500.0, 0.9, 0.1, block=1)
    deep = (mr.Tie(at=(-0.25, 0, 0.9), **tie), mr.Damper(at=(-0.25, 0, 0.2), **damper),
            mr.Load(500.0, at=(0.1, 0, 0.9), block=1))  # fmt: skip
    velocity = {"velocity": [(0.5, 4.0, 6.0)]}, {"velocity": [(0.5, 0, 4.0, 0, 6.0, 0)]}
    run, spatial = both(plane, 0.4, effects=(flat, deep), each=velocity)
    assert run.theta.max() > 1.6
    assert_same(run, spatial, 1e-6)


def test_the_plane_inside_space_a_cap_slides_off_its_free_pier():
    """Corners of the pier press on the wider cap, and past its end the edge of the cap presses on the pier.

    A load on the rear of the cap keeps it down until it has passed the pier.
    """
    pier, cap = brick(-0.2, 0.2, 0, 1), brick(-0.4, 0.4, 1, 1.2)
    plane = mr.Masonry([FLOOR, pier, cap], k_n=1e8, k_s=1e8, friction=0.01, frequency=300.0)
    velocity = {"velocity": [(0, 0, 0), (6.0, 0, 0)]}, {"velocity": [(0,) * 6, (6.0, 0, 0, 0, 0, 0)]}
    loads = (mr.Load(2e4, 1.2, -0.18, block=2),), (mr.Load(2e4, at=(-0.18, 0, 1.2), block=2),)
    run, spatial = both(plane, 0.15, each=velocity, effects=loads)
    assert run.pose[-1, 1, 0] > 0.85
    handed = int(0.1 / 1e-3)  # then the places are found at other moments, since prisms are larger
    np.testing.assert_allclose(spatial.pose[:handed, :, [0, 2]], run.pose[:handed, :, :2], atol=2e-4)
    np.testing.assert_allclose(angles(spatial)[:handed], run.theta[:handed], atol=2e-3)
    np.testing.assert_allclose(spatial.pose[:, :, [0, 2]], run.pose[:, :, :2], atol=2e-3)


@pytest.mark.slow
def test_the_plane_inside_space_an_arch():
    """It starts with other forces along its joints, and with a lower friction that makes a difference."""
    plane = mr.Masonry.arch(5.0, 0.75, k_n=2e9, k_s=2e9, friction=1.2, frequency=300.0)
    space = mr.Masonry([prism(b) for b in plane.blocks], k_n=2e9, k_s=2e9, friction=1.2, frequency=300.0)
    motion = mr.GroundMotion.sine(2.0, 0.7)
    run, spatial = (solve(masonry, 1.0, motion, timestep=1e-5) for masonry in (plane, space))
    assert np.abs(angles(spatial) - run.theta).max() < 0.01 * run.peak.max()


def test_a_wall_in_the_plane_and_in_space_at_rest():
    bond = mr.Masonry.running_bond(1.2, 0.6, (0.6, 0.2), thickness=0.3, k_n=2e9, k_s=2e9, frequency=300.0)
    run, spatial = both(bond, 0.1, mr.GroundMotion.sine(4.0, 0.5))
    assert_same(run, spatial, 1e-12)


def bonded(angle=0.0):
    """Two courses of two walls that meet at a corner."""
    box = mr.Polyhedron.box
    blocks = [box((0.2, 0.4, 0.2), (0.1, 0.2, 0.1)), box((0.4, 0.2, 0.2), (0.4, 0.1, 0.1)),
              box((0.4, 0.2, 0.2), (0.2, 0.1, 0.3)), box((0.2, 0.3, 0.2), (0.1, 0.35, 0.3))]  # fmt: skip
    return [GROUND, *about_vertical(blocks, angle)]


@pytest.mark.parametrize("k_s", among([None, 1e9], 1e9))
def test_a_scene_turned_with_its_motion_moves_alike(k_s):
    angle = math.radians(37)
    c, s = math.cos(angle), math.sin(angle)
    answers, shaking = [], mr.GroundMotion.sine(9.0, 0.3)
    for turned in (0.0, angle):
        masonry = mr.Masonry(bonded(turned), k_n=1e9, k_s=k_s, friction=0.5, frequency=200.0)
        ways = (c, s) if turned else (1.0, 0.0)
        x, y = (mr.GroundMotion(way * shaking.accel, shaking.dt) if way else None for way in ways)
        answers.append(solve(masonry, 0.15, x, transverse=y, timestep=5e-5))
    straight, askew = answers
    assert straight.opening.max() > 5e-5
    assert straight.sliding.max() > 1e-3
    within = 1e-9 if k_s else 1e-4  # rigid friction ends its search at a tolerance
    to_turned = np.array([[c, s], [-s, c]])
    for first in (0, 4):  # displacements, and the vectors of the quaternions
        level = slice(first, first + 2)
        np.testing.assert_allclose(askew.pose[:, :, level], straight.pose[:, :, level] @ to_turned, atol=within)
    np.testing.assert_allclose(askew.pose[:, :, [2, 3, 6]], straight.pose[:, :, [2, 3, 6]], atol=within)


@pytest.mark.parametrize("k_s", [None, 1e9])
def test_masonry_starts_at_rest(k_s):
    masonry = mr.Masonry(bonded(0.2), k_n=1e9, k_s=k_s, friction=0.5, frequency=200.0)
    run = solve(masonry, 0.05)
    assert np.abs(run.velocity).max() < 1e-9
    assert run.outcome is mr.Outcome.AT_REST
    assert run.energy[0] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("plan", "k_s"), crossed([0.0, 37.0], [None, 1e10]))
def test_a_slab_thrown_up_a_steep_slope_stops_where_coulomb_has_it(plan, k_s):
    """v^2 / (2 g (mu cos + sin)) above where it rests, whichever way the slope faces."""
    slope, mu, speed = math.radians(65), 2.5, 1.0
    up, out = np.array([math.cos(slope), math.sin(slope)]), np.array([-math.sin(slope), math.cos(slope)])
    hill = mr.Polygon([(0, 0), (1, 0), (1, math.tan(slope))], fixed=True, name="hill")
    slab = mr.Polygon([s * up + z * out for s, z in ((1.0, 0), (1.4, 0), (1.4, 0.05), (1.0, 0.05))])
    blocks = about_vertical([prism(hill), prism(slab)], math.radians(plan))
    masonry = mr.Masonry(blocks, k_n=1e9, k_s=k_s, friction=mu, frequency=300.0, xi=0.5)
    way = np.array([math.cos(math.radians(plan)) * up[0], math.sin(math.radians(plan)) * up[0], up[1]])
    run = solve(masonry, 0.08, velocity=[(*speed * way, 0, 0, 0)])
    moved = run.pose[-1, 0, :3] - run.pose[0, 0, :3]
    assert moved @ way == pytest.approx(speed**2 / (2 * G * (mu * math.cos(slope) + math.sin(slope))), rel=0.02)
    assert np.linalg.norm(moved - (moved @ way) * way) < 1e-3 * np.linalg.norm(moved)


def test_masonry_that_cannot_stand_is_named():
    leaning = mr.Polyhedron.box((0.4, 0.4, 0.4), (0.35, 0, 1.2), name="leaning")
    with pytest.raises(ValueError, match="cannot stand: leaning would fall"):
        solve(mr.Masonry([*block((0.4, 0.4, 1.0)).blocks, leaning], k_n=1e9, friction=0.5), 0.1)


def test_a_tie_between_two_blocks_pulls_both():
    """Momentum: two blocks on smooth ground that move apart are pulled together again."""
    left, right = (
        mr.Polyhedron.box((0.5, 0.5, 0.3), (x, 0, 0.15), name=name) for x, name in ((-1, "left"), (1, "right"))
    )
    masonry = mr.Masonry([GROUND, left, right], k_n=1e8, friction=0.0, frequency=100.0)
    tie = mr.Tie(at=(0.75, 0, 0.15), stiffness=1e5, block=2, anchor=(-0.75, 0, 0.15), anchor_block=1)
    damper = mr.Damper(at=(0.75, 0, 0.15), c=50.0, block=2, anchor=(-0.75, 0, 0.15), anchor_block=1)
    run = solve(
        masonry, 0.5, velocity=[(0, 0.1, 0, 0, 0, 0), (0.4, 0.1, 0, 0, 0, 0)], effects=(tie, damper), ledger=True
    )
    speed = run.velocity[:, :, :2].sum(axis=1)
    np.testing.assert_allclose(speed, np.broadcast_to([0.4, 0.2], speed.shape), atol=1e-9)
    assert (run.velocity[:, 1, 0] - run.velocity[:, 0, 0]).min() < -0.1
    assert run.ledger.dashpots["damper_0"][-1] > 0
    apart = run.pose[:, 1, :3] - run.pose[:, 0, :3] + [1.5, 0, 0]  # they do not turn
    longer = np.maximum(np.linalg.norm(apart, axis=1) - 1.5, 0)
    np.testing.assert_allclose(run.ties["tie_0"].elongation, longer, atol=1e-6)
    assert np.abs(run.energy_residual).max() < 1e-3 * run.energy[0]


def test_energy_stays_without_damping():
    """A block that lands askew on a smooth, undamped ground."""
    masonry = block((0.6, 0.4, 0.5), 0.3, k_n=1e7, xi=0.0, friction=0.0)
    run = solve(masonry, 1.0, velocity=[(0.2, 0.1, 1.0, 1.0, 0.5, 2.0)], timestep=5e-5)
    assert np.abs(run.energy / run.energy[0] - 1).max() < 2e-3
    assert run.opening[0] > 0.05


def test_the_response_in_space(tmp_path):
    run = solve(block(), 0.05, PULSE, velocity=[(0, 0, 0, 0.1, 0.2, 0.3)])
    assert (run.pose.shape[1:], run.velocity.shape[1:]) == ((1, 7), (1, 6))
    np.testing.assert_allclose(np.linalg.norm(run.pose[:, :, 3:], axis=2), 1.0, atol=1e-14)
    for name in ("theta", "omega"):
        with pytest.raises(AttributeError, match=f"no {name}"):
            getattr(run, name)
    columns = run.csv().splitlines()[0].split(",")
    assert columns[2:9] == ["x of block [m]", "y of block [m]", "z of block [m]"] + [
        f"quaternion {part} of block [-]" for part in "wxyz"
    ]
    pose, velocity = run.end
    again = solve(block(), 0.01, start=(pose, velocity))
    np.testing.assert_array_equal(again.pose[0], pose)
    np.testing.assert_allclose(again.velocity[0], velocity, atol=1e-14)
    with pytest.raises(ValueError, match="length of a quaternion"):
        solve(block(), 0.01, start=(1.1 * pose, velocity))


def test_angles_of_rotations():
    half = 0.5 * 0.3
    about = np.array([[0, 0, 0, math.cos(half), *(math.sin(half) * np.eye(3)[i])] for i in range(3)])
    np.testing.assert_allclose(tilt_of(about), [0.3, 0.3, 0.0], atol=1e-15)


def test_a_block_that_falls_is_named():
    run = solve(block((0.3, 0.3, 1.0)), 1.5, steady(-6.0, 2.0))
    assert list(run.fallen) == ["block"]
    assert "not in the model" not in run.message
    assert masonry_scene(run.case).bodies.names == ("block",)


@pytest.mark.parametrize("askew", [False, True])
def test_the_shear_dashpot_of_a_landing_block_stretches_no_spring(askew):
    """Friction never gives energy back, also where the dashpot alone is more than the friction."""
    masonry = block((0.6, 0.4, 0.5), k_n=1e9, k_s=1e8, friction=0.5, frequency=200.0, xi=0.5)
    run = solve(masonry, 0.2, velocity=[(1.0, 0.5 * askew, 0.3, 0, 0.2, 0)], ledger=True, output_step=1e-4)
    rubbed = np.diff(run.ledger.friction)
    assert rubbed.max() > 1.0
    assert rubbed.min() > -1e-9


def test_an_arch_in_the_plane_and_in_space_with_rigid_friction():
    """The same dashpots: xi at the lowest frequency would mean others, as that of the prisms is out of the plane."""
    plane = mr.Masonry.arch(5.0, 0.75, voussoirs=6, k_n=1e9, frequency=100.0)
    space = mr.Masonry([prism(b) for b in plane.blocks], k_n=1e9, frequency=100.0)
    run, spatial = (solve(masonry, 0.4, mr.GroundMotion.sine(4.0, 0.6)) for masonry in (plane, space))
    assert run.peak.max() > 5e-3
    assert np.abs(angles(spatial) - run.theta).max() < 1e-3 * run.peak.max()


def test_a_block_that_has_turned_over_and_left_the_ground_falls_freely():
    """The ground is drawn away below it. Its points would meet their face again from behind, after a whole turn."""
    ground = mr.Polyhedron.box((0.6, 0.6, 0.1), (0, 0, -0.05), fixed=True)
    masonry = mr.Masonry([ground, mr.Polyhedron.box((0.3, 0.3, 1.0), (0, 0, 0.5), name="block")], k_n=1e9, xi=0.05)
    case = mr.MasonryCase(masonry, 3.0, mr.GroundMotion(np.full(5, -6.0), 1.0))
    response = mr.solve_explicit(case, ledger=True)
    assert list(response.fallen) == ["block"]
    assert "Below all fixed blocks, past the edge of any ground: block." in response.message
    assert np.abs(response.velocity[..., :3]).max() < 3.0 * mr.GRAVITY
    assert np.abs(response.energy_residual).max() < 1e-4 * response.energy.max()
