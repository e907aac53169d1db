"""What joints and blocks are said to have done follows the supports that move."""

import math

import numpy as np
import pytest
from everyday import among, crossed
from masonry_blocks import box

import mjrock as mr

T = np.linspace(0.0, 1.0, 1001)
EASED = 3 * T**2 - 2 * T**3
"""Way from rest to rest [-], of which the acceleration is 6 at most."""


def made(blocks, in_space, **options):
    return mr.Masonry([mr.Polyhedron.prism(block) for block in blocks] if in_space else blocks, **options)


def moved(masonry, duration, **ways):
    """A run in which fixed blocks go as far as the ways say, x and z [m]."""
    supports = {}
    for name, (x, z) in ways.items():
        across = (0 * T,) if masonry.in_space else ()
        supports[name] = (T, x * EASED, *across, z * EASED)
    return mr.solve_explicit(mr.MasonryCase(masonry, duration, supports=supports), output_step=2e-3)


def one(in_space, friction=0.7):
    """A block of 0.5 x 0.5 m on a base."""
    blocks = [box(-3, 3, -1, 0, fixed=True, name="base"), box(0, 0.5, 0, 0.5, name="block")]
    return made(blocks, in_space, k_n=1e8, friction=friction, xi=0.3)


@pytest.mark.parametrize(
    ("in_space", "support"), crossed([False, True], [(0.7, (0.8, 0), 0), (0, (0.3, 0), 0.3), (0.7, (0, 1.5), 0)])
)
def test_a_base_that_carries_its_block_leaves_it_or_lifts_it(in_space, support):
    """Friction bears the 4.8 m/s2 of a way of 0.8 m, and the weight the 9 m/s2 of 1.5 m upwards.

    A history is a row of straight lines, whose corners strike the block by some mm/s: it slips and hops by less than
    1 mm.
    """
    friction, way, slides = support
    run = moved(one(in_space, friction), 2.0, base=way)
    np.testing.assert_allclose(run.sliding, slides, atol=1e-3)
    np.testing.assert_array_less(run.opening, 1e-3)
    assert run.stats["deepest"] < 1e-3
    assert dict(run.fallen) == {}
    assert run.outcome is mr.Outcome.AT_REST
    followed = (0.0, way[1]) if slides else way
    np.testing.assert_allclose(run.pose[-1, 0, [0, 2] if in_space else [0, 1]], followed, atol=1e-3)


@pytest.mark.parametrize("in_space", among([False, True], True))
def test_a_lintel_whose_piers_part_falls_between_them(in_space):
    """Each bears 0.1 m of it and goes by 0.3 m. It has fallen when it is lower by half its height of 0.3 m.

    A face is 2 % longer than it is, 2 mm that take 5 ms, and samples are 2 ms apart.
    """
    piers = [box(-2.5, -0.9, -1, 0, fixed=True, name="left"), box(0.9, 2.5, -1, 0, fixed=True, name="right")]
    floor = box(-4, 4, -3, -2, fixed=True, name="floor")
    masonry = made([*piers, floor, box(-1, 1, 0, 0.3, name="lintel")], in_space, k_n=1e9, xi=0.5)
    run = moved(masonry, 0.9, left=(-0.3, 0), right=(0.3, 0))
    bare = float(np.interp(0.1 / 0.3, EASED, T))
    assert dict(run.fallen) == {"lintel": pytest.approx(bare + math.sqrt(0.3 / mr.GRAVITY), abs=7e-3)}
    assert run.outcome is mr.Outcome.OVERTURNED
    assert "1 block fell" in run.message
    np.testing.assert_allclose(run.sliding, 0.3 * np.interp(0.9, T, EASED), atol=1e-3)


def test_a_block_that_a_jack_has_lifted_is_at_rest():
    """Its energy is higher than at rest by its weight over 0.1 m."""
    jack = mr.Actuator("block", (0.25, 0.5), (0, 1), ([0, 0.5], [0, 0.1]), 1e7, 1e5, guided="upright")
    run = mr.solve_explicit(mr.MasonryCase(one(False), 2.0, effects=jack))
    assert run.pose[-1, 0, 1] == pytest.approx(0.1, abs=2e-3)
    assert run.opening.max() == pytest.approx(0.1, abs=2e-3)
    assert run.outcome is mr.Outcome.AT_REST
