"""A tie that breaks inside a step of explicit steps, in the plane and in space: the speed that is left, and when."""

import math

import pytest
from everyday import crossed

import mjrock as mr

SPEED, STIFFNESS, STRENGTH, SLACK = 3.0, 2e6, 30e3, 0.01
"""Speed of the block [m/s], stiffness [N/m], strength [N] and slack [m] of the tie that catches it."""
MASS = 2000.0
"""Mass of the block [kg]."""


def caught(in_space, ultimate):
    """A block slides on smooth ground and is caught by a tie at its centroid, which yields and breaks."""
    if in_space:
        blocks = [
            mr.Polyhedron.box((20, 20, 1), (0, 0, -0.5), fixed=True),
            mr.Polyhedron.box((2, 1, 0.5), (0, 0, 0.25)),
        ]
        place = {"at": (0, 0, 0.25)}
    else:
        blocks = [
            mr.Polygon([(x, z - 0.5) for x, z in ((-10, 0), (10, 0), (10, 0.5), (-10, 0.5))], fixed=True),
            mr.Polygon([(-1, 0), (1, 0), (1, 0.5), (-1, 0.5)]),
        ]
        place = {"height": 0.25}
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.0, xi=0.05)
    tie = mr.Tie(stiffness=STIFFNESS, slack=SLACK, strength=STRENGTH, ultimate=ultimate, block=1, length=5.0, **place)
    velocity = [(SPEED, *(0.0 for _ in range(5 if in_space else 2)))]
    return mr.solve_explicit(mr.MasonryCase(masonry, 0.05, velocity=velocity, effects=(tie,)), ledger=True)


@pytest.mark.parametrize(("in_space", "ultimate"), crossed([False, True], [0.05, 0.051, 0.052, 0.053]))
def test_a_tie_holds_until_it_breaks_and_no_longer(in_space, ultimate):
    """The breaks lie at different places inside their steps."""
    run = caught(in_space, ultimate)
    elastic, plastic = 0.5 * STRENGTH**2 / STIFFNESS, STRENGTH * ultimate
    left = math.sqrt(SPEED**2 - 2 * (elastic + plastic) / MASS)
    assert run.velocity[-1, 0, 0] == pytest.approx(left, rel=2e-5)
    frequency = math.sqrt(STIFFNESS / MASS)
    stretching = math.asin(STRENGTH / STIFFNESS * frequency / SPEED) / frequency
    yielding = (math.sqrt(SPEED**2 - 2 * elastic / MASS) - left) * MASS / STRENGTH
    assert run.plastic["tie_0"].broken == pytest.approx(SLACK / SPEED + stretching + yielding, abs=2e-6)
    assert abs(run.energy_residual[-1]) < 3e-5 * run.energy[0]
