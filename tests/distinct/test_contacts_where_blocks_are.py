"""Blocks that have left their joints meet others wherever they are: overlap, momentum and who stands on whom."""

import numpy as np
import pytest
from by_hand import stood
from everyday import among, slow
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct.search.finder import Finder
from mjrock.distinct.search.solids import Poses

BOX = mr.Polyhedron.box
STILL = (0,) * 6


def found(blocks, moved, turn):
    """Places of two blocks in space, the second displaced [m] and turned by a quaternion."""
    drawn = np.array([block.centroid for block in blocks])
    w, x, y, z = turn
    matrix = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    poses = Poses(
        drawn,
        np.array([(0.0, 0.0, 0.0), moved]),
        np.array([0 * np.eye(3), matrix - np.eye(3)]),
    )
    finder = Finder(stood(blocks), flat=False)
    return finder.places_near(poses, np.full(2, 5e-3), np.ones(2, dtype=bool), np.zeros(0, dtype=np.int64))


def about(axis, angle):
    return (np.cos(angle / 2), *(np.sin(angle / 2) * np.eye(3)[axis]))


CUBES = BOX((0.2, 0.2, 0.2), (0, 0, 0.1)), BOX((0.2, 0.2, 0.2), (0, 0, 0.3))


@pytest.mark.parametrize(
    ("moved", "turn", "places"),
    [((0, 0, 0), about(2, 0.1), 8), ((0.013, 0.023, 0), about(2, 0.0), 4), ((0.013, 0.023, 0), about(2, 0.1), 4)],
)
@pytest.mark.parametrize("gap", [-1e-4, 1e-3])
def test_faces_that_lie_on_each_other(moved, turn, places, gap):
    """The octagon of two squares that are turned, and the rectangle of two that are displaced."""
    meeting = found(CUBES, np.add(moved, (0, 0, gap)), turn)
    assert len(meeting.gap) == places
    np.testing.assert_allclose(meeting.gap, gap, atol=1e-12)
    np.testing.assert_allclose(np.abs(meeting.normal), [[0, 0, 1]] * places, atol=1e-12)
    assert meeting.share.sum() == pytest.approx(1.0)
    np.testing.assert_allclose(meeting.place[:, 2], 0.2 + 0.5 * gap, atol=1e-12)


def test_beams_whose_edges_cross_meet_in_one_place():
    beams = BOX((2, 0.2, 0.2)), BOX((0.2, 2, 0.2), (0, 0, 0.2))
    along, across = about(0, np.pi / 4), about(1, np.pi / 4)
    first = mr.Polyhedron(
        [(x, *(0.1 * np.sqrt(2) * np.array(c))) for x in (-1, 1) for c in ((1, 0), (0, 1), (-1, 0), (0, -1))]
    )
    meeting = found((first, beams[1]), (0, 0, 0.2 * np.sqrt(2) - 0.2 - 1e-3), across)
    assert along[0] == across[0]
    assert len(meeting.gap) == 1
    np.testing.assert_allclose(meeting.gap, -1e-3, atol=1e-12)
    np.testing.assert_allclose(meeting.place, [[0, 0, 0.1 * np.sqrt(2) - 5e-4]], atol=1e-9)
    np.testing.assert_allclose(np.abs(meeting.normal), [[0, 0, 1]], atol=1e-9)


@pytest.mark.parametrize("seed", among(range(40), 17))
def test_a_drum_that_hops_lands_on_the_drum_or_beside_it(seed):
    """With any yaw, spin and offset. Beyond the width of the joint it used to fall through the drum."""
    rng = np.random.default_rng(seed)
    column = mr.Masonry.column(0.2, 0.4, 2, k_n=1e9, friction=0.6, xi=0.3)
    thrown = (*rng.uniform(-0.09, 0.09, 2), rng.uniform(1.9, 2.8), *rng.uniform(-0.2, 0.2, 2), rng.uniform(-0.6, 0.6))
    run = mr.solve_explicit(mr.MasonryCase(column, 1.6, velocity=[STILL, thrown]), ledger=True, output_step=2e-3)
    assert run.stats["overlap"] < 0.01
    assert np.abs(run.energy_residual).max() < 1e-3 * run.ledger.kinetic.max()
    assert min(run.ledger.ends["encounters"].min(), 0.0) > -0.01 * run.ledger.kinetic.max()


@pytest.mark.parametrize("in_space", [False, True])
def test_neighbours_with_a_gap_meet_and_keep_their_momentum(in_space):
    """Two blocks, 2 mm apart, on smooth ground, one of which moves."""
    blocks = [GROUND, box(-1.001, -0.001, 0, 1), box(0.001, 1.001, 0, 1)]
    speed = np.array([[2.0, 0, 0], [0.0, 0, 0]])
    if in_space:
        blocks, speed = [mr.Polyhedron.prism(block) for block in blocks], np.pad(speed, ((0, 0), (0, 3)))
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.0, xi=0.05)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.3, velocity=speed))
    assert run.stats["overlap"] < 0.01
    np.testing.assert_allclose(run.velocity[:, :, 0].sum(axis=1), 2.0, rtol=1e-12)
    assert run.velocity[-1, 1, 0] > 1.5


@pytest.mark.parametrize("in_space", [False, True])
def test_a_cap_that_hops_lands_on_its_fixed_pier(in_space):
    blocks = [GROUND, box(-0.25, 0.25, 0, 1, fixed=True, name="pier"), box(-0.6, 0.6, 1, 1.2, name="cap")]
    velocity = (0, np.sqrt(2 * mr.GRAVITY * 0.6), 0)
    if in_space:
        blocks, velocity = [mr.Polyhedron.prism(block) for block in blocks], (0, 0, velocity[1], 0, 0, 0)
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.6, xi=0.3)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 2.0, velocity=[velocity]))
    assert run.pose[:, 0, 2 if in_space else 1].max() == pytest.approx(0.6, rel=0.05)
    assert run.pose[-1, 0, 2 if in_space else 1] == pytest.approx(0.0, abs=1e-3)
    assert run.stats["overlap"] < 0.01
    assert not run.fallen


def test_a_beam_that_is_thrown_over_a_sill_stays_above_it():
    """Its edges cross those of the sill, and no corner of either lies in the other."""
    sill, pier = BOX((0.2, 3, 1.0), (0.8, 0, 0.5), fixed=True), BOX((0.2, 0.2, 1.0), (-0.6, 0, 0.5), fixed=True)
    ground, beam = (
        BOX((20, 20, 1), (0, 0, -0.5), fixed=True, name="ground"),
        BOX((1.8, 0.1, 0.1), (-0.6, 0, 1.05), name="beam"),
    )
    masonry = mr.Masonry([ground, sill, pier, beam], k_n=1e9, friction=0.5, xi=0.3)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 1.2, velocity=[(0.8, 0, 1.5, 0.3, 0.2, 0.4)]), output_step=2e-3)
    assert run.stats["overlap"] < 0.01


@pytest.mark.parametrize("seed", among(range(20), 11))
def test_random_neighbours_with_a_gap_meet_and_keep_their_momentum(seed):
    """Any gap, size and speed, in space with a spin about the vertical, off the middle of the other."""
    rng = np.random.default_rng(seed)
    gap, speed, off, long = rng.uniform((1e-4, 0.5, -0.3, 0.4), (0.02, 3.0, 0.3, 1.2))
    ground = BOX((20, 20, 1), (0, 0, -0.5), fixed=True)
    blocks = [BOX((long, 0.5, 0.4), (-0.5 * long, 0, 0.2)), BOX((0.6, 0.5, 0.4), (0.3 + gap, off, 0.2))]
    masonry = mr.Masonry([ground, *blocks], k_n=1e9, friction=0.0, xi=0.05)
    thrown = (speed, 0, 0, 0, 0, rng.uniform(-0.2, 0.2))
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.2, velocity=[thrown, STILL]), output_step=2e-3)
    momentum = np.array([block.mass for block in blocks]) @ run.velocity[:, :, :2]
    assert run.stats["overlap"] < 0.01
    assert run.velocity[-1, 1, 0] > 0.1 * speed
    np.testing.assert_allclose(momentum, np.tile(momentum[0], (len(momentum), 1)), atol=1e-12 * momentum[0, 0])


@pytest.mark.parametrize("seed", among(range(20), 5))
def test_random_caps_that_hop_stay_out_of_their_pier(seed):
    """With any yaw, spin and offset. A cap lands on its fixed pier, or beside it on the ground."""
    rng = np.random.default_rng(seed)
    ground, pier = BOX((20, 20, 1), (0, 0, -0.5), fixed=True), BOX((0.5, 0.4, 1.0), (0, 0, 0.5), fixed=True)
    cap = BOX((1.2, 0.6, 0.2), (*rng.uniform(-0.1, 0.1, 2), 1.1), name="cap")
    masonry = mr.Masonry([ground, pier, cap], k_n=1e9, friction=0.6, xi=0.3)
    thrown = (*rng.uniform(-0.6, 0.6, 2), rng.uniform(2.0, 3.5), *rng.uniform(-0.5, 0.5, 2), rng.uniform(-1.0, 1.0))
    run = mr.solve_explicit(mr.MasonryCase(masonry, 1.6, velocity=[thrown]), ledger=True, output_step=2e-3)
    assert run.stats["overlap"] < 0.01
    assert np.abs(run.energy_residual).max() < 0.01 * run.ledger.kinetic.max()


@pytest.mark.parametrize("seed", among(range(20), 2))
def test_random_beams_that_are_thrown_over_a_sill_stay_out_of_it(seed):
    """Edges of a beam cross those of a sill and of its pier at any angle."""
    rng = np.random.default_rng(seed)
    sill, pier = BOX((0.2, 3, 1.0), (0.8, 0, 0.5), fixed=True), BOX((0.2, 0.2, 1.0), (-0.6, 0, 0.5), fixed=True)
    ground = BOX((20, 20, 1), (0, 0, -0.5), fixed=True)
    beam = BOX((1.8, 0.1, 0.1), (-0.6 + rng.uniform(-0.1, 0.1), 0, 1.05), name="beam")
    masonry = mr.Masonry([ground, sill, pier, beam], k_n=1e9, friction=0.5, xi=0.3)
    thrown = (rng.uniform(0.4, 1.4), rng.uniform(-0.3, 0.3), rng.uniform(0.8, 2.0), *rng.uniform(-0.5, 0.5, 3))
    run = mr.solve_explicit(mr.MasonryCase(masonry, 1.2, velocity=[thrown]), ledger=True, output_step=2e-3)
    assert run.stats["overlap"] < 0.01
    assert np.abs(run.energy_residual).max() < 0.01 * run.ledger.kinetic.max()


@pytest.mark.parametrize(
    ("step", "beyond", "falls"),
    [(1.5, 0.02, True), (10.0, -0.02, False), slow((1.5, -0.02, False)), slow((10.0, 0.02, True))],
)
def test_a_block_tips_where_its_weight_passes_the_edge_of_any_step(step, beyond, falls):
    """It slides by friction alone, half its width and 20 mm less or more."""
    blocks = [GROUND, mr.Polygon([(-step, 0), (0, 0), (0, 1), (-step, 1)], fixed=True), box(-1.0, 0.0, 1, 1.5)]
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.2, xi=0.2)
    speed = np.sqrt(2 * 0.2 * mr.GRAVITY * (0.5 + beyond))
    run = mr.solve_explicit(mr.MasonryCase(masonry, 3.0, velocity=[(speed, 0, 0)]), output_step=5e-3)
    assert bool(run.fallen) == falls


@pytest.mark.parametrize("k_n", [1e9, 4e9])
def test_a_unit_that_falls_flat_overlaps_by_what_its_joint_yields(k_n):
    """v sqrt(m / k), as a spring stops it, of its height: 1 % at 3.2 m/s on 1e9 N/m3, half of it on four times that."""
    high, speed, drop = 0.2, 2.0, 0.05
    masonry = mr.Masonry([GROUND, box(-0.2, 0.2, 0.0, high)], k_n=k_n, k_s=k_n, friction=0.6, xi=0.0)
    case = mr.MasonryCase(masonry, 0.05)
    start = np.array([[0.0, drop, 0.0]]), np.array([[0.0, -speed, 0.0]])
    run = mr.solve_explicit(case, start=start, output_step=1.5e-4 / np.sqrt(k_n / 1e9))
    stopped = np.sqrt(speed**2 + 2 * mr.GRAVITY * drop) * np.sqrt(2000.0 * high / k_n)
    assert -run.pose[:, 0, 1].min() == pytest.approx(stopped, rel=0.02)


@pytest.mark.slow
def test_voussoirs_of_an_arch_that_falls_lie_on_its_ground():
    """Without ground they fall on, and are named."""
    shaken = mr.GroundMotion.sine(8.0, 1.0)
    for ground in (True, False):
        arch = mr.Masonry.arch(1.0, 0.2, voussoirs=5, k_n=1e9, k_s=1e9, friction=0.6, xi=0.1, ground=ground)
        run = mr.solve_explicit(mr.MasonryCase(arch, 3.0, motion=shaken), output_step=0.01)
        lowest = min((run.pose[-1, :, 1] + arch.centroids[arch.free, 1]).tolist())
        assert run.fallen
        assert run.stats["overlap"] < 0.01
        assert (lowest > -0.2) == ground
        assert ("Below all fixed blocks, past the edge of any ground" in run.message) != ground


def test_a_heap_comes_to_rest():
    """Blocks thrown on each other lie still: kinetic energy falls to rounding, and nothing creeps."""
    blocks = [GROUND, *(box(-0.2 + 0.03 * i, 0.2 + 0.03 * i, 0.3 * i, 0.3 + 0.3 * i) for i in range(4))]
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.6, xi=0.3)
    velocity = [(0.0, 0, 0), (0.5, 1.0, 0.5), (-0.5, 2.0, -1.0), (1.0, 3.0, 2.0)]
    run = mr.solve_explicit(mr.MasonryCase(masonry, 6.0, velocity=velocity), ledger=True, output_step=0.01)
    assert run.stats["overlap"] < 0.01
    assert run.ledger.kinetic[-1] < 1e-9
    assert np.abs(run.pose[-1] - run.pose[400]).max() < 1e-5


@pytest.mark.filterwarnings("ignore:dashpots, c/k")
@pytest.mark.parametrize("in_space", [False, True])
def test_a_pillar_lands_on_its_edge_with_the_default_step(in_space):
    """Its corner moves four times as easily as its base, whose joint decides the step."""
    blocks = [GROUND, box(-0.1, 0.1, 0, 2)]
    velocity = (0, 0, 1.5)
    if in_space:
        blocks, velocity = [mr.Polyhedron.prism(block) for block in blocks], (0, 0, 0, 0, 1.5, 0)
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.5, xi=0.05)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 2.0, velocity=[velocity]), ledger=True, output_step=5e-3)
    assert np.abs(run.energy_residual).max() < 1e-3 * run.ledger.kinetic.max()
    assert run.stats["overlap"] < 0.01


@pytest.mark.filterwarnings("ignore:dashpots, c/k")
@pytest.mark.parametrize(("share", "xi"), [(0.8, 0.0), (0.8, 0.1), (0.98, 0.1)])
def test_a_plate_between_two_walls_is_stable_with_steps_that_its_base_allows(share, xi):
    blocks = [
        GROUND,
        box(-0.05, 0.05, 0, 2),
        box(-1, -0.06, 0, 2, fixed=True, name="left"),
        box(0.06, 1, 0, 2, fixed=True, name="right"),
    ]
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.3, xi=xi)
    limit = mr.solve_explicit(mr.MasonryCase(masonry, 1e-3)).stats["stable_timestep"]
    case = mr.MasonryCase(masonry, 1.0, velocity=[(0.2, 0, 0)])
    run = mr.solve_explicit(case, timestep=share * limit, output_step=5e-3)
    assert np.abs(run.velocity).max() < 0.24
