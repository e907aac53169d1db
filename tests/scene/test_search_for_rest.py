"""The search for rest, one function at a time: sliders, energy, stiffness and where bodies are let fall to."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scenes import changed, two_blocks

import mjrock as mr
from mjrock.bars import Bar, progress_given_to
from mjrock.geometry.poses import moved
from mjrock.problem.wall.effect import LinkLaw
from mjrock.scene import rest
from mjrock.scene.masonry import scene_of_masonry
from mjrock.scene.parts import ConstantForces, Links

WEIGHT = 2000.0 * 0.6 * 2.1 * mr.GRAVITY


def search_in(scene, *, limited=True):
    return rest.Search(1e3 * scene.contacts.k, limited, Bar("rest", "poses"))


def sliders(scene, push, *, limited=True):
    return rest.sliders_at(scene.places, search_in(scene, limited=limited), np.array(push, dtype=float))


def shear_stiffness(friction, share):
    return friction.pattern.matrix(rest.shear_stiffness(friction, share)).toarray()


def test_a_slider_holds_friction_times_push_and_only_where_faces_touch():
    scene = two_blocks()
    found = sliders(scene, [10.0, 0.0, -1.0, 1e-3])
    np.testing.assert_allclose(found.limit, [7.0, 0.0, -np.inf, 7e-4])
    np.testing.assert_allclose(found.stiffness, 1e3 * scene.contacts.k)
    np.testing.assert_array_equal(found.shared(np.eye(4)), np.diag([1.0, 1.0, 0.0, 1.0]))
    smooth = sliders(changed(scene, contacts={"friction": [0.7, 0.0, 0.7, 0.7]}), [10.0] * 4)
    np.testing.assert_allclose(smooth.limit, [7.0, -np.inf, 7.0, 7.0])
    bonds = {"area": 2e-3, "bonds": (mr.Bond(250.0, 1500.0, 1.0, 1.0), None)}
    bonded = sliders(changed(scene, contacts=bonds), [10.0, -1.0, -1.0, 10.0])
    np.testing.assert_allclose(bonded.limit, [10.0, 3.0, -np.inf, 7.0])


def test_without_a_limit_sliders_hold_the_mean_slip_of_the_points_of_a_joint_that_touch():
    found = sliders(two_blocks(), [10.0, 1.0, -1.0, 5.0], limited=False)
    np.testing.assert_array_equal(found.limit, [np.inf, np.inf, -np.inf, np.inf])
    means = np.zeros((4, 4))
    means[:2, :2], means[3, 3] = 0.5, 1.0
    np.testing.assert_allclose(found.shared(np.eye(4)), means)


@pytest.mark.parametrize(("slid", "slips"), [(1e-6, False), (1e-3, True), (-1e-3, True)])
def test_a_slider_sticks_or_has_what_the_face_holds_against_its_slip(slid, slips):
    """The lower block has slid on the ground."""
    scene = two_blocks()
    found = sliders(scene, [1e6, 2e6, 1.0, 1.0])
    pose = np.array([slid, 0.0, 0.0, slid, 0.0, 0.0])
    friction = rest.friction_at(scene.potential, pose, found)
    k = 1e3 * scene.contacts.k
    sense = np.sign(scene.potential.slips(pose)[0, 0] * slid)
    assert abs(sense) == 1
    stretch = sense * np.array([slid, slid, 0.0, 0.0])
    force = np.clip(k * stretch, -found.limit, found.limit)
    np.testing.assert_allclose(friction.force[:, 0], -force, rtol=1e-9, atol=1e-9)
    assert (friction.slips[:2] == slips).all()
    assert not friction.slips[2:].any()
    chord = np.divide(force, stretch, out=k.copy(), where=stretch != 0)
    np.testing.assert_allclose(friction.stiffness, chord, rtol=1e-9)
    np.testing.assert_allclose(friction.generalised[0], -sense * force.sum(), rtol=1e-9)
    whole, half = shear_stiffness(friction, 1.0), shear_stiffness(friction, 0.25)
    assert whole[0, 0] == pytest.approx(chord.sum())
    assert whole[3, 3] == pytest.approx(chord[2:].sum())
    assert half[0, 0] == pytest.approx((0.25 if slips else 1.0) * chord[:2].sum() + chord[2:].sum())
    elastic = np.abs(force) / k
    stored = (k * elastic * (np.abs(stretch) - 0.5 * elastic)).sum()
    energy = rest.energy_with(found, scene.potential, pose) - scene.potential.energy(pose)
    assert energy == pytest.approx(stored, rel=1e-9, abs=1e-15 * WEIGHT)


def test_an_exact_step_follows_the_derivatives_of_all_forces():
    """Points that stick, slip and are open: what is missing after a small motion, by the forces themselves. The limit
    of friction of a point that slips grows with its pressure."""
    scene = two_blocks()
    search, freedom = search_in(scene), scene.freedom
    lower, upper = 4e-5, -3e-4
    pose = scene.at_rest.ravel() + np.array([2e-3, 0.0, lower, 2e-3 + 1.05 * (lower + upper), 0.0, upper])
    trial = rest.trial_at(scene.potential, search, pose)
    assert 0 < trial.friction.slipping.sum() < trial.closed.sum() < 4
    size = rest.sizes(scene.potential)
    derivatives = np.empty((6, 6))
    for i, way in enumerate(1e-8 * np.eye(6)):
        ahead, behind = (rest.trial_at(scene.potential, search, moved(pose, s * way, freedom)).missing for s in (1, -1))
        derivatives[:, i] = (behind - ahead) / 2e-8 * size
    found = scene.potential.pattern.matrix(rest.stiffness_at(scene.potential, search, trial)).toarray()
    # friction acts halfway between point and face, where slip is that of the point: 1e-4 of the arm of a block
    np.testing.assert_allclose(found, derivatives, rtol=2e-4, atol=1e-6 * np.abs(derivatives).max())


def test_open_sliders_hold_nothing():
    scene = two_blocks()
    found = sliders(scene, [-1.0] * 4)
    friction = rest.friction_at(scene.potential, np.array([1e-3, 0.0, 0.0, 2e-3, 0.0, 0.0]), found)
    assert not friction.force.any()
    assert not friction.stiffness.any()
    assert not rest.shear_stiffness(friction, 0.5).any()


def test_friction_in_space_is_softer_along_its_slip_alone():
    """k (1 - a a) + share k a a with a the way of the slip, along two ways of the face."""
    both = np.array([[1.0, 0.0, 0.3], [0.0, 1.0, -0.2]])
    rates = np.stack([both, np.zeros((2, 3))], axis=1)[:, None]
    pattern = rest.PairPattern(np.array([[0, -1]]), 3, 1)
    friction = rest.PointFriction(pattern, rates, np.array([[-3.0, 4.0]]), np.array([7.0]), np.array([True]))
    way = np.array([-0.6, 0.8])
    matrix = 7.0 * (np.eye(2) - 0.75 * np.outer(way, way))
    np.testing.assert_allclose(shear_stiffness(friction, 0.25), both.T @ matrix @ both, rtol=1e-12)
    np.testing.assert_allclose(friction.generalised, both.T @ [-3.0, 4.0])


def test_what_may_be_missing_is_a_billionth_of_the_heaviest_body_or_what_springs_round_to():
    """The springs of contacts round with the displacements of bodies, up to their size, and ties with their length."""
    scene = changed(two_blocks(), bodies={"mass": [3000.0, 1000.0]})
    assert rest.heaviest(scene.potential) == pytest.approx(3000.0 * mr.GRAVITY)

    def tolerance(scene, lifted=0.0):
        return rest.tolerance(scene.potential, np.array([0.0, lifted, 0.0, 0.0, 0.0, 0.0]), search_in(scene))

    assert tolerance(scene) == pytest.approx(1e-9 * 3000.0 * mr.GRAVITY)
    stiff = changed(two_blocks(k_n=1e13), bodies={"mass": [3000.0, 1000.0]})
    eps, k = np.finfo(float).eps, 1e3 * stiff.contacts.k.max()
    for far, counts in ((1e-3, 1e-3), (5.0, 1.05)):
        assert tolerance(stiff, far) == pytest.approx(16 * eps * k * counts)
    tie = Links(("tie",), [1], [(0.3, 0.7)], [0], [(-0.3, 0.2)], [LinkLaw(3e12, 0.5)])
    rounding = 16 * np.finfo(float).eps * 3e12 * 0.5
    assert tolerance(changed(scene, links=tie)) == pytest.approx(rounding)
    closed = rest.touching(changed(scene, links=tie).potential, np.zeros(6))
    length = math.hypot(0.6, 2.6)
    np.testing.assert_array_equal(closed, [True] * 4 + [length > 0.5])
    slack = changed(scene, links=Links(("tie",), [1], [(0.3, 0.7)], [0], [(-0.3, 0.2)], [LinkLaw(3e6, 9.0)]))
    np.testing.assert_array_equal(rest.touching(slack.potential, np.zeros(6)), [True] * 4 + [False])


@pytest.mark.parametrize("pull", [0.0, -4e4, 3e4])
@pytest.mark.parametrize("theta", [0.0, 1e-4, 1e-3])
def test_bodies_are_lowered_until_level_ground_carries_them(pull, theta):
    """Rotations stay. The springs of the ground carry both weights less what pulls upwards."""
    scene = two_blocks()
    pulled = changed(scene, forces=ConstantForces(("pull",), [1], [(0.1, 0.9)], [(3e4, pull)]))
    pose = np.array([[0.0, 0.01, theta], [0.002, 0.0, -theta]])
    found = pulled.lowered(pose)
    moved = found - pose
    np.testing.assert_allclose(moved, moved[0, 1] * np.array([[0, 1, 0], [0, 1, 0]]), atol=1e-15)
    openings = scene.potential.openings(found.ravel())[:2]
    carried = float((np.maximum(-openings, 0) * scene.contacts.k[:2]).sum())
    assert carried == pytest.approx(2 * WEIGHT - pull, rel=1e-9)
    assert (openings < 0).sum() == (2 if theta < 1e-3 else 1)


def test_a_stack_settles_by_its_weight_over_its_springs():
    scene = two_blocks()
    k = scene.contacts.k[:2].sum()
    np.testing.assert_allclose(scene.at_rest[:, 1], [-2 * WEIGHT / k, -3 * WEIGHT / k], rtol=1e-9)
    pose = scene.at_rest.ravel()
    search = search_in(scene)
    assert rest.falling_direction(scene.potential, search, rest.trial_at(scene.potential, search, pose)) is None


def test_the_whole_motion_is_made_where_it_takes_energy_and_a_part_where_it_gives_some():
    scene = two_blocks()
    rests, found = scene.at_rest.ravel(), sliders(scene, [-1.0] * 4)
    down = np.array([0.0, 1.0, 0.0, 0.0, 1.0, 0.0])
    above = rests + 1e-4 * down
    np.testing.assert_allclose(rest.lowering_step(scene.potential, above, -1e-4 * down, found), rests, atol=1e-15)
    far = rest.lowering_step(scene.potential, above, -1e-3 * down, found)
    assert far[1] == pytest.approx(rests[1] + 1e-4 - 1.25e-4)  # the eighth is the first that raises no energy
    assert far[4] - far[1] == pytest.approx(rests[4] - rests[1])


def test_bodies_fall_along_the_way_that_takes_the_most_energy():
    """Two blocks upright on springs too soft for their height tilt, and are let go to where energy ends to fall."""
    scene = two_blocks(k_n=1e6)
    k = scene.contacts.k[:2].sum()
    pose = np.array([0.0, -2 * WEIGHT / k, 0.0, 0.0, -3 * WEIGHT / k, 0.0])
    search = search_in(scene)
    trial = rest.trial_at(scene.potential, search, pose)
    friction, way = trial.friction, rest.falling_direction(scene.potential, search, trial)
    assert way is not None
    assert abs(way[2]) > 0
    assert way[2] * way[5] > 0
    fallen = rest.fallen_pose(scene.potential, trial, way)
    far = (fallen - pose)[2] / way[2]
    np.testing.assert_allclose(fallen[[2, 5]], pose[[2, 5]] + far * way[[2, 5]], rtol=1e-9)
    drag, stiffness = way @ friction.generalised, way @ shear_stiffness(friction, 1.0) @ way

    def energy(part):
        of_friction = -part * far * drag + 0.5 * (part * far) ** 2 * stiffness
        return scene.potential.energy(pose + part * far * way) + of_friction

    first = 1e-2 * scene.potential.pressed(pose).max() / np.abs(way).max()
    assert abs(far) > first
    assert energy(1.0) < energy(0.5) < energy(0.0)
    assert energy(1.0) < min(energy(0.98), energy(1.02)) or np.abs(far * way).max() >= rest.ROTATION_OF_FALLEN


def wall_beside_a_gap(courses: int = 10, below: int = 4) -> mr.Masonry:
    """Two bricks long, in running bond, with a gap as wide as one brick above the lowest courses."""

    def box(left: float, right: float, bottom: float, **options: bool) -> mr.Polygon:
        return mr.Polygon([(left, bottom), (right, bottom), (right, bottom + 0.25), (left, bottom + 0.25)], **options)

    blocks = [box(0.0, 1.0, -0.25, fixed=True)]
    for course in range(courses):
        ends = [0.0, 0.25, 0.75, 1.0] if course % 2 else [0.0, 0.5, 1.0]
        sides = [(0.0, 0.25), (0.75, 1.0)] if course >= below else list(pairwise(ends))
        blocks += [box(left, right, 0.25 * course) for left, right in sides]
    return mr.Masonry(blocks, k_n=1e10, k_s=1e10, friction=0.7)


def test_a_block_that_slips_on_both_supports_is_found_at_rest_by_one_search():
    """Below the gap a block lies on two others that slide apart. It slips on both, and is dragged along by the one that
    carries more, until it slips on one alone: there is more force missing on the way."""
    scene, seen = scene_of_masonry(wall_beside_a_gap()), []
    with progress_given_to(seen.append):
        pose = scene.at_rest
    assert len(seen) < rest.POSES / 2  # one search, of those that begin from softer springs none
    push = scene.potential.pushes(pose.ravel())[: len(scene.contacts.k)]
    on_ground = scene.contacts.face_body < 0
    assert push[on_ground].sum() == pytest.approx(mr.GRAVITY * scene.bodies.mass.sum(), rel=1e-9)


def test_a_search_that_makes_no_progress_ends_before_the_most_poses(monkeypatch):
    """The same block, where all that slips keeps some of its stiffness in the search."""
    scene, seen = scene_of_masonry(wall_beside_a_gap()), []
    monkeypatch.setattr(rest, "SLIDES", rest.POSES)
    with progress_given_to(seen.append), pytest.raises(rest.UnsettledError), rest.shown_search(scene.potential) as bar:
        rest.search_pose(scene.potential, rest.Search(scene.contacts.k, limited=True, bar=bar))
    assert rest.STALLED < len(seen) < rest.POSES / 2


@pytest.mark.parametrize(("number", "stands"), [(20, True), (24, False)])
def test_a_tall_stack_buckles_on_its_joints_and_is_not_wedged(number, stands):
    """A column of rigid cubes of side a on springs at two edges buckles under its own weight as an elastic one does,
    q L^3 = 7.837 E I, where E I / a = k a^3 / 4 a unit of length: 21.6 cubes of 2 cm on 1e8 N/m3."""
    a, k = 0.02, 1e8
    block = mr.Block.from_size(a, a)
    q = block.weight / (block.length * a)
    assert 20 < (7.837 * k * a**4 / 4 / q) ** (1 / 3) / a < 24
    stack = mr.Masonry.stack([block] * number, k)
    found = mr.collapse_multiplier(stack)
    assert found.multiplier == pytest.approx(1 / number, rel=1e-6)
    assert found.wedged == ()
    if stands:
        mr.masonry_scene(mr.MasonryCase(stack, 1.0))
        return
    with pytest.raises(ValueError, match=r"on joints of this stiffness .* would fall; raise k_n"):
        mr.masonry_scene(mr.MasonryCase(stack, 1.0))
    mr.masonry_scene(mr.MasonryCase(mr.Masonry.stack([block] * number, 10 * k), 1.0))
