"""Blocks in space that leave their joints meet the ground and each other, corner on face."""

from dataclasses import replace

import numpy as np
import pytest
from everyday import among
from space_blocks import GROUND

import mjrock as mr

BOX = mr.Polyhedron.box
TABLE = BOX((1, 1, 1), (0, 0, 0.5), name="table")
STILL = (0, 0, 0, 0, 0, 0)


def solve(blocks, duration, velocity, timestep=None, **options):
    masonry = mr.Masonry([GROUND, *blocks], **{"k_n": 1e8, "friction": 0.5, "xi": 0.2} | options)
    case = mr.MasonryCase(masonry, duration, velocity=velocity)
    return mr.solve_explicit(case, timestep=timestep, ledger=True, output_step=2e-3)


def unaccounted(run):
    """Energy gained and lost that no account has, over the largest kinetic energy; the first sample is the push."""
    residual = run.energy_residual - run.energy_residual[1]
    return residual.max() / run.ledger.kinetic.max(), -residual.min() / run.ledger.kinetic.max()


@pytest.mark.parametrize("k_s", among([None, 1e8], None))
def test_a_block_that_slides_off_its_table_comes_to_rest_on_the_ground(k_s):
    box = BOX((0.4, 0.4, 0.3), (0.3, 0.1, 1.15), name="box")
    run = solve([TABLE, box], 2.0, [STILL, (2.5, 0, 0, 0, 0, 0)], timestep=1e-4, k_s=k_s)
    assert list(run.fallen) == ["box"]
    x, _, z = run.pose[-1, 1, :3] + (0.3, 0.1, 1.15)
    assert x > 0.7
    assert min(abs(z - 0.15), abs(z - 0.2)) < 5e-4
    assert np.abs(run.velocity[-1]).max() < 1e-3
    gained, lost = unaccounted(run)
    assert gained < 1e-4
    assert lost < 0.003


def test_a_block_that_is_thrown_up_lands_on_another_one():
    """It leaves its joint, spins by an angle that was not there before, and rests over the same block."""
    top = BOX((0.6, 0.6, 0.4), (0.05, 0.03, 1.2), name="top")
    velocity = [STILL, (0, 0, 1.0, 0.3, 0.5, 0.2)]
    run = solve([TABLE, top], 2.0, velocity, timestep=1e-4, k_s=1e8)
    assert run.pose[:, 1, 2].max() == pytest.approx(1.0 / (2 * mr.GRAVITY), rel=0.05)
    assert np.abs(run.pose[-1, 1, 2]) < 5e-4
    assert np.abs(run.velocity[-1]).max() < 1e-3
    assert run.outcome is mr.Outcome.AT_REST
    assert max(unaccounted(run)) < 1e-3


def test_a_block_flush_with_the_one_below_lands_on_it():
    """Its corners come down on the edge of the face, and the corners of the other one on its own."""
    top = BOX((1, 1, 0.4), (0, 0, 1.2), name="top")
    run = solve([TABLE, top], 0.6, [STILL, (0, 0, 1.0, 0, 0, 0)], timestep=1e-4)
    assert np.abs(run.pose[-1, 1, 2]) < 5e-4
    assert not run.fallen


def test_a_block_beyond_the_edge_of_a_face_does_not_meet_it():
    """It falls past the table and on the ground."""
    top = BOX((0.4, 0.4, 0.3), (0.4, 0, 1.15), name="top")
    run = solve([TABLE, top], 1.5, [STILL, (1.5, 0, 2.0, 0, 0, 0)], k_n=1e9)
    x, _, z = run.pose[-1, 1, :3] + (0.4, 0, 1.15)
    assert x > 0.7
    assert min(abs(z - 0.15), abs(z - 0.2)) < 5e-4


@pytest.mark.slow
def test_a_facade_falls_into_a_heap_and_the_books_close():
    facade = mr.Masonry.facade(1.2, 0.8, 0.4, (0.4, 0.2), k_n=1e9, k_s=1e9, friction=0.6)
    facade = replace(facade, blocks=(GROUND, *facade.blocks[1:]))
    case = mr.MasonryCase(facade, 1.5, mr.GroundMotion.sine(-14.0, 0.8))
    run = mr.solve_explicit(case, ledger=True, output_step=5e-3)
    assert len(run.fallen) >= 3
    assert np.abs(run.energy_residual).max() < 0.01 * np.abs(run.ledger.ground).max()
    centroids = facade.centroids[list(facade.free)]
    assert (run.pose[-1, :, 2] + centroids[:, 2]).min() > 0.09  # none is in the ground
