"""Blocks that meet of which neither has a joint in the drawing: their springs are those of a joint drawn there."""

import math

import numpy as np
import pytest
from everyday import among, crossed
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct import explicit, time_integration
from mjrock.distinct.search.contact_search import ContactSearch

TABLE = box(-1.0, 1.0, 1.0, 1.5, fixed=True, name="table")
STANDS = box(3.0, 3.2, 0.0, 0.2, name="stands")
K_N = 1e8


def of(blocks, in_space):
    return [mr.Polyhedron.prism(block) for block in blocks] if in_space else blocks


def velocities(in_space, *rows):
    """Along x and z, and the rate about y."""
    return [[x, 0.0, z, 0.0, rate, 0.0] if in_space else [x, z, rate] for x, z, rate in rows]


def upright(run, block):
    """Height of the centroid of a free block above where it was drawn [m], shape (samples,)."""
    return run.pose[:, block, 2 if run.case.masonry.in_space else 1]


@pytest.mark.parametrize(("k_s", "in_space", "size"), crossed([None, 4e7], [False, True], [(0.2, 0.3), (0.3, 0.1)]))
def test_a_box_that_is_dropped_on_a_table_sinks_as_deep_as_on_a_joint(size, in_space, k_s):
    """By m g over k_n times its face, whether this is its largest face or not."""
    width, height = size
    dropped = box(0.0, width, 1.51, 1.51 + height, name="dropped")
    masonry = mr.Masonry(of([GROUND, STANDS, TABLE, dropped], in_space), k_n=K_N, k_s=k_s, friction=0.5, xi=1.0)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.8, settled=False), output_step=0.01, ledger=True)
    sunk = masonry.blocks[3].mass * mr.GRAVITY / (K_N * width * 1.0)
    assert -0.01 - upright(run, 1)[-1] == pytest.approx(sunk, rel=1e-3)
    assert np.abs(run.energy_residual).max() < 1e-3 * run.ledger.kinetic.max()
    assert run.stats["overlap"] < 0.01


@pytest.mark.parametrize(("in_space", "k_s"), crossed([False, True], [None, 4e7]))
def test_boxes_that_fall_on_each_other_come_to_rest(in_space, k_s):
    """Two of a heap that is poured, with rigid friction in the plane and in space, and on springs."""
    blocks = [GROUND, STANDS, box(0.0, 0.3, 0.3, 0.6, name="A"), box(0.03, 0.33, 0.8, 1.1, name="B")]
    masonry = mr.Masonry(of(blocks, in_space), k_n=K_N, k_s=k_s, friction=0.5, xi=1.0)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 1.0, settled=False), output_step=0.01, ledger=True)
    np.testing.assert_allclose([upright(run, 1)[-1], upright(run, 2)[-1]], [-0.3, -0.5], atol=1e-3)
    assert np.abs(run.velocity[-1]).max() < 1e-3
    assert run.stats["overlap"] < 0.01
    assert np.abs(run.energy_residual).max() < 0.01 * run.ledger.kinetic.max()


@pytest.mark.parametrize("in_space", [False, True])
def test_boxes_that_are_thrown_at_each_other_keep_their_momentum(in_space):
    """With faces that are flush, and each as far from the other as both are large: depth, speed v by (m / 2 k)^1/2, and
    rebound, exp(-pi r / (1 - r^2)^1/2) of the speed, are those of two masses on a spring and a dashpot."""
    blocks = [GROUND, STANDS, box(0.0, 0.2, 3.0, 3.2, name="A"), box(0.6, 0.8, 3.0, 3.2, name="B")]
    masonry = mr.Masonry(of(blocks, in_space), k_n=K_N, friction=0.5, xi=0.05, frequency=400.0)
    velocity = velocities(in_space, (0, 0, 0), (0.5, 0, 0), (-0.5, 0, 0))
    case = mr.MasonryCase(masonry, 0.45, velocity=velocity, settled=False)
    run = mr.solve_explicit(case, timestep=2e-5, output_step=1e-4)
    mass, k = masonry.blocks[2].mass, K_N * 0.2
    ratio = 2 * 0.05 / 400.0 * math.sqrt(k / (0.5 * mass)) / 2
    back = math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2))
    np.testing.assert_allclose(run.velocity[-1, 1:, 0], [-0.5 * back, 0.5 * back], rtol=0.02)
    np.testing.assert_allclose(run.velocity[:, 1, 0] + run.velocity[:, 2, 0], 0.0, atol=1e-9)
    deep = (run.pose[:, 1, 0] - run.pose[:, 2, 0]).max() - 0.4
    assert deep == pytest.approx(math.sqrt(0.5 * mass / k) * math.exp(-ratio * (0.5 * math.pi - ratio)), rel=0.02)


def test_two_blocks_that_come_from_afar_meet_on_time():
    """Tilted boxes without joints, each within its own size of where it started when they meet."""
    tilted = mr.Polygon([(0.0, 3.0), (0.2, 3.05), (0.15, 3.25), (-0.05, 3.2)], name="A")
    masonry = mr.Masonry([GROUND, STANDS, tilted, box(0.4, 0.6, 3.0, 3.2)], k_n=1e9, friction=0.5)
    case = mr.MasonryCase(masonry, 0.1, velocity=[(0, 0, 0), (3, 0, 0), (-3, 0, 0)], settled=False)
    run = mr.solve_explicit(case, output_step=1e-3)
    assert run.stats["overlap"] < 0.01
    assert run.velocity[-1, 1, 0] < 0 < run.velocity[-1, 2, 0]


@pytest.mark.parametrize("in_space", among([False, True], True))
def test_rigid_friction_that_a_run_has_found_carries_on(in_space):
    """A run that carries on has room for the lines that the run before it has found, and ends where one run does."""
    blocks = [GROUND, STANDS, *(box(0.02 * i, 0.3 + 0.02 * i, 0.1 + 0.35 * i, 0.4 + 0.35 * i) for i in range(4))]
    masonry = mr.Masonry(of(blocks, in_space), k_n=K_N, friction=0.6, xi=1.0)
    whole = mr.solve_explicit(mr.MasonryCase(masonry, 0.6, settled=False), timestep=1e-4, output_step=0.01)
    half = mr.MasonryCase(masonry, 0.3, settled=False)
    first = mr.solve_explicit(half, timestep=1e-4, output_step=0.01)
    second = mr.solve_explicit(half, timestep=1e-4, output_step=0.01, start=first.end)
    np.testing.assert_allclose(second.pose[-1], whole.pose[-1], atol=1e-12)


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("size", [0.1, 0.002])
def test_the_default_step_counts_blocks_without_joints(size, in_space):
    """As if each lay between two others, so that none is softened; splinters shorten it tenfold at most.

    A square on a line at each end with K = k_n a / 2, and K / 2 along it, and the radius of gyration a / 6^1/2: in slip
    and rocking the matrix over 2 K / m is [[1/2, s/2], [s/2, s^2 / 2 + s^2]] with s = 6^1/2 / 2. A bar of 1 m in space
    rocks along its length: 12 (1/2)^2 = 3.
    """
    blocks = [GROUND, box(3.0, 3.5, 0.0, 0.5), box(0.0, size, 0.6, 0.6 + size)]
    blocks = [mr.Polyhedron.prism(block) for block in blocks] if in_space else blocks
    masonry = mr.Masonry(blocks, k_n=K_N, k_s=0.5 * K_N, friction=0.5, xi=0.0)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.1, settled=False), output_step=0.1)
    if size < 0.01:
        assert run.stats["timestep"] == pytest.approx(0.04 * run.stats["stable_timestep"], rel=0.01)
        return
    s = math.sqrt(6) / 2
    highest = 3.0 if in_space else np.linalg.eigvalsh([[0.5, 0.5 * s], [0.5 * s, 1.5 * s * s]])[-1]
    bound = 2 / math.sqrt(2 * K_N * size / masonry.blocks[2].mass * highest)
    assert run.stats["timestep"] == pytest.approx(0.4 * bound, rel=0.02)  # a whole share of the run


FALLS = mr.Masonry([GROUND, STANDS, TABLE, box(0.0, 0.2, 1.52, 1.72, name="falls")], k_n=K_N)


def test_a_motion_that_is_not_finite_ends_the_run_by_name(monkeypatch):
    advance = time_integration.advance

    def spoiled(system, *rest):
        after = advance(system, *rest)
        if after[0] > 60:
            system.bodies["velocity"][1, 0] = np.nan
        return after

    monkeypatch.setattr(time_integration, "advance", spoiled)
    with pytest.raises(RuntimeError, match=r"the motion of falls breaks down by t = 0\.0.* s: .* shorter timestep"):
        mr.solve_explicit(mr.MasonryCase(FALLS, 0.2, settled=False), timestep=1e-4)


def test_a_contact_that_is_not_finite_ends_the_run_by_name(monkeypatch):
    monkeypatch.setattr(ContactSearch, "_shares", lambda _, places, *others: np.full(len(places.gap), np.nan))
    with pytest.raises(RuntimeError, match=r"the contact of (table and falls|falls and table) breaks down by t = 0\.0"):
        mr.solve_explicit(mr.MasonryCase(FALLS, 0.2, settled=False))


@pytest.mark.parametrize(("name", "value"), [("k", np.inf), ("c", np.nan), ("k_s", np.nan), ("margin", np.nan)])
def test_rows_that_are_not_finite_are_refused_at_the_start(monkeypatch, name, value):
    def spoiled(setup, *rest):
        setup.system.lines[name][1] = value
        return integrate(setup, *rest)

    integrate = time_integration.integrate
    monkeypatch.setattr(explicit, "integrate", spoiled)
    with pytest.raises(RuntimeError, match=r"the lines \[1\] of the explicit steps have numbers that are not finite"):
        mr.solve_explicit(mr.MasonryCase(FALLS, 0.2, settled=False))


def test_a_guide_of_the_only_jointed_block_leaves_the_step_of_the_loose_ones():
    """The guide holds the joint, which then limits no step; the block that falls has its springs all the same."""
    masonry = mr.Masonry([GROUND, STANDS, box(0.0, 0.3, 0.3, 0.6)], k_n=K_N, friction=0.5, xi=1.0)
    held = mr.Actuator("stands", (3.2, 0.1), 1, None, 1e6, guided="translation")
    steps = [
        mr.solve_explicit(mr.MasonryCase(masonry, 0.02, effects=effects, settled=False), output_step=0.02)
        for effects in ((), held)
    ]
    free, guided = (run.stats["timestep"] for run in steps)
    assert guided < 1.5 * free
