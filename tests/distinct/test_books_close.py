"""The ledger of explicit steps closes: what no account had before, each in the smallest scene that shows it."""

import numpy as np
import pytest

import mjrock as mr

SOFT = {"k_n": 2e5, "friction": 0.5, "xi": 0.0}
"""Joints into which a cube of 1 m sinks by 0.1 m."""


def cube_on_ground(in_space, **options):
    if in_space:
        ground = mr.Polyhedron.box((20, 20, 1), (0, 0, -0.5), fixed=True, name="ground")
        return mr.Masonry([ground, mr.Polyhedron.box((1, 1, 1), (0, 0, 0.5))], **options)
    ground = mr.Polygon([(-10, -1), (10, -1), (10, 0), (-10, 0)], fixed=True, name="ground")
    return mr.Masonry([ground, mr.Polygon([(-0.5, 0), (0.5, 0), (0.5, 1), (-0.5, 1)])], **options)


def unaccounted(run):
    """Largest residual over the largest kinetic energy [-]."""
    return np.abs(run.energy_residual).max() / run.ledger.kinetic.max()


@pytest.mark.parametrize("in_space", [False, True])
def test_friction_of_springs_turns_the_blocks_that_overlap(in_space):
    """It rubs halfway into the overlap, and its spring is stretched by the slip there."""
    masonry = cube_on_ground(in_space, **SOFT, k_s=2e5)
    velocity = [(3.0, 0.0, 0.0, 0.0, 1.0, 0.0) if in_space else (3.0, 0.0, 1.0)]
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.5, velocity=velocity), timestep=5e-4, ledger=True)
    assert run.sliding.max() > 0.3
    assert unaccounted(run) < 5e-5
