"""A joint that has slid is as stiff as before on what still lies over each other: bending, torsion, force, energy."""

import math

import numpy as np
import pytest
from everyday import among, crossed
from masonry_blocks import box

import mjrock as mr
from mjrock.distinct.setup import masonry_at_rest

K_N, SIDE, FRICTION = 1e9, 1.0, 0.2
SMOOTH = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0, 1, 101))


def bed(points, width):
    """Places of lines along a face, from its middle [m], and stiffness of each [N/m]."""
    k = np.full(points, K_N * width / (points - 1))
    k[[0, -1]] *= 0.5
    return np.linspace(-0.5, 0.5, points) * width, k


def yields(points, width, off):
    """Rotation of a cube of 1 m on lines that do not slide, under a unit acceleration [rad s2/m].

    Its centroid is `off` from the middle of what it lies on. Unknowns are what it sinks and turns by.
    """
    at, k = bed(points, width)
    at, mass = at + off, 2000.0 * SIDE**3
    high = 0.5 * SIDE
    stiffness = np.array([[k.sum(), k @ at], [k @ at, k @ at**2 - mass * mr.GRAVITY * high]])
    return float(np.linalg.solve(stiffness, [0.0, mass * high])[1])


def case_of(points, slide, ground, in_space=False):
    """A cube on a fixed block that slides by friction to rest, and then leans under 0.5 m/s2 of the ground."""
    blocks = [box(*ground, -SIDE, 0.0, fixed=True), box(-0.5 * SIDE, 0.5 * SIDE, 0.0, SIDE)]
    blocks = [mr.Polyhedron.prism(block) for block in blocks] if in_space else blocks
    masonry = mr.Masonry(blocks, k_n=K_N, friction=FRICTION, xi=0.3, points=points)
    speed = math.sqrt(2 * FRICTION * mr.GRAVITY * slide)
    start = (speed, 0, 0, 0, 0, 0) if in_space else (speed, 0, 0)
    pushed = -0.5 * np.concatenate([np.zeros(700), SMOOTH, np.ones(100)])
    return mr.MasonryCase(masonry, 0.9, velocity=[start], motion=mr.GroundMotion(pushed, 1e-3))


def leaned(run):
    """What the cube has leaned by under a unit acceleration [rad s2/m]."""
    turned = run.pose[:, 0, 2] if run.pose.shape[2] == 3 else 2 * run.pose[:, 0, 5]
    return float(np.interp(0.9, run.t, turned) - np.interp(0.7, run.t, turned)) / 0.5


@pytest.mark.parametrize("in_space", among([False, True], False))
@pytest.mark.parametrize("points", [2, 5, 9])
@pytest.mark.parametrize("slide", [0.02, 0.08])
def test_a_cube_that_has_slid_on_its_ground_leans_as_before(in_space, points, slide):
    """On 2 lines it is three times as stiff in bending as on many. It leaves its joint at 5 %."""
    run = mr.solve_explicit(case_of(points, slide, (-5.0, 5.0), in_space), output_step=2e-3)
    assert run.pose[-1, 0, 0] == pytest.approx(slide, rel=0.05)
    assert leaned(run) == pytest.approx(yields(points, SIDE, 0.0), rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("slide", "points"), crossed([0.02, 0.08], [2, 5]))
def test_a_cube_that_has_slid_leans_in_mujoco_by_as_much(points, slide):
    run = mr.simulate(case_of(points, slide, (-5.0, 5.0)), output_step=2e-3)
    assert leaned(run) == pytest.approx(yields(points, SIDE, 0.0), rel=0.02)


@pytest.mark.parametrize(("points", "slide"), crossed([2, 5, 9], [0.08, 0.2]))
def test_a_joint_whose_faces_have_slid_off_each_other_is_as_stiff_as_what_is_left(points, slide):
    """On a block of its own width: bending goes as the third power of what lies over each other."""
    run = mr.solve_explicit(case_of(points, slide, (-0.5, 0.5)), output_step=2e-3)
    slid = run.pose[-1, 0, 0]
    assert slid == pytest.approx(slide, rel=0.05)
    assert leaned(run) == pytest.approx(yields(points, SIDE - slid, -0.5 * slid), rel=0.02)


@pytest.mark.parametrize("in_space", among([False, True], True))
def test_a_joint_that_is_handed_over_keeps_its_force_and_energy(in_space):
    run = mr.solve_explicit(case_of(5, 0.08, (-5.0, 5.0), in_space), output_step=1e-3, ledger=True, forces=True)
    weight = 2000.0 * mr.GRAVITY
    slid = run.pose[:, 0, 0] > 0.045
    upwards = next(iter(run.reactions.values()))[slid, -1]
    np.testing.assert_allclose(upwards, weight, rtol=2e-3)
    assert np.abs(run.ledger.ends["encounters"]).max() < 1e-9 * run.ledger.kinetic[0]
    assert np.abs(run.energy_residual).max() < 1e-4 * run.ledger.kinetic[0]


def thrown(points, duration, speed=1.0, spin=4.0, step=1e-4):
    """Speed and spin of a thin square plate on points of even pressure, integrated here."""
    places, weights = bed(points, 1.0)
    x, y = (each.ravel() for each in np.meshgrid(places, places))
    share = np.outer(weights, weights).ravel() / weights.sum() ** 2
    velocity, turned = np.array([speed, 0.0, spin]), 0.0

    def rate(velocity, turned):
        c, s = math.cos(turned), math.sin(turned)
        at = c * x - s * y, s * x + c * y
        slip = velocity[0] - velocity[2] * at[1], velocity[1] + velocity[2] * at[0]
        drag = -0.3 * mr.GRAVITY * share / np.hypot(np.hypot(*slip), 1e-6)
        force = drag * slip[0], drag * slip[1]
        return np.array([force[0].sum(), force[1].sum(), 6 * (at[0] * force[1] - at[1] * force[0]).sum()])

    for _ in range(round(duration / step)):
        half = velocity + 0.5 * step * rate(velocity, turned)
        velocity = velocity + step * rate(half, turned + 0.5 * step * velocity[2])
        turned += step * half[2]
    return math.hypot(*velocity[:2]), velocity[2]


def plate(points, duration, k_s=None):
    masonry = mr.Masonry.box((1.0, 1.0, 0.02), k_n=K_N, k_s=k_s, friction=0.3, xi=0.3, points=points)
    return mr.MasonryCase(masonry, duration, velocity=[(1.0, 0, 0, 0, 0, 4.0)])


@pytest.mark.parametrize("k_s", among([None, K_N], K_N))
@pytest.mark.parametrize("points", [2, 3, 5])
def test_a_plate_that_slides_and_spins_keeps_its_torsion(points, k_s):
    """It leaves its joint after 0.05 s. On the corners of its face it would have 1.67 rad/s after 0.2 s, not 2.58."""
    run = mr.solve_explicit(plate(points, 0.2, k_s), output_step=0.01)
    speed, spin = thrown(points, 0.2)
    assert np.hypot(*run.velocity[-1, 0, :2]) == pytest.approx(speed, rel=1e-3)
    assert run.velocity[-1, 0, 5] == pytest.approx(spin, rel=1e-3)


@pytest.mark.slow
def test_a_plate_that_slides_and_spins_moves_as_in_mujoco():
    run = mr.simulate(plate(3, 0.2), output_step=0.01)
    speed, spin = thrown(3, 0.2)
    assert np.hypot(*run.velocity[-1, 0, :2]) == pytest.approx(speed, rel=0.02)
    assert run.velocity[-1, 0, 5] == pytest.approx(spin, rel=0.02)


def test_a_plate_that_spins_on_one_of_its_size_has_the_torsion_of_an_octagon():
    """Of even pressure on what the two cover, whose mean distance from the middle is integrated at each turn."""
    below, above = (mr.Polyhedron.box((1.0, 1.0, 0.1), (0, 0, z), fixed=z < 0) for z in (-0.05, 0.05))
    masonry = mr.Masonry([below, above], k_n=K_N, k_s=K_N, friction=0.3, xi=0.3, points=9)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.2, velocity=[(0, 0, 0, 0, 0, 4.0)]), output_step=0.01)
    cells = (np.stack(np.meshgrid(*2 * [np.arange(200)]), axis=-1).reshape(-1, 2) + 0.5) / 200 - 0.5
    spin, turned, step = 4.0, 0.0, 2e-3
    for _ in range(100):
        own = np.abs(cells @ np.array([(math.cos(turned), -math.sin(turned)), (math.sin(turned), math.cos(turned))]))
        radius = np.linalg.norm(cells[own.max(axis=1) <= 0.5], axis=1).mean()
        spin -= step * 6 * 0.3 * mr.GRAVITY * radius
        turned += step * spin
    assert turned > 0.25
    assert run.velocity[-1, 0, 5] == pytest.approx(spin, rel=0.02)


def test_pairs_keep_the_lines_of_their_own_joints():
    """Of two blocks with two joints, which is one pair, the most."""
    counts = {"ground|drum_0": 2, "drum_0|drum_1": 5}
    masonry = mr.Masonry.column(0.6, 2.0, 2, points=lambda joint: counts[joint.name])
    finder = masonry_at_rest(mr.scene_of(mr.MasonryCase(masonry, 1.0))).search.finder
    assert dict(zip(finder.jointed.tolist(), finder.points.tolist(), strict=True)) == {1: 2, 5: 5}
    step = [mr.Polygon([(x, z), (x + 1, z), (x + 1, z + 0.5), (x, z + 0.5)]) for x, z in ((0, 0), (1, 0), (0, 0.5))]
    corner = mr.Masonry(
        [mr.Compound(step, fixed=True, name="step"), mr.Polygon([(1, 0.5), (2, 0.5), (2, 1), (1, 1)], name="block")],
        points=lambda joint: 3 if joint.is_bed else 4,
    )
    drawn = mr.scene_of(mr.MasonryCase(corner, 1.0, settled=False))
    assert sorted(masonry_at_rest(drawn).search.finder.points.tolist()) == [3, 4]
