"""Faces have no end in MuJoCo: a run says whose weight has passed its support, and how far."""

import math
import re

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr

FRICTION = 0.3
STEP = box(-4, 0, 0, 1, fixed=True, name="step")


def slid(blocks, far, in_space, **options):
    """A run in which the last block, on what stands before it, is pushed to slide so far to the right [m]."""
    free = sum(not block.fixed for block in blocks)
    velocity = np.zeros((free, 6 if in_space else 3))
    velocity[-1, 0] = math.sqrt(2 * FRICTION * mr.GRAVITY * far)
    made = [mr.Polyhedron.prism(block) for block in blocks] if in_space else blocks
    masonry = mr.Masonry(made, k_n=1e8, xi=0.3, **{"friction": FRICTION} | options)
    run = mr.simulate(mr.MasonryCase(masonry, 2.0, velocity=velocity))
    assert run.pose[-1, -1, 0] == pytest.approx(far, rel=0.01)
    return run


def printed(message):
    """The names of blocks whose weight has passed its support, and how far [m]."""
    return {name: float(far) for name, far in re.findall(r"(\w+) by ([\d.e-]+) m", message)}


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize(("far", "past"), [(0.55, None), (0.9, 0.3)])
def test_a_block_slid_out_over_an_edge(far, past, in_space):
    """Its centroid is 0.6 m from the edge at rest, and 0.3 m past it in the end."""
    run = slid([GROUND, STEP, box(-1.1, -0.1, 1, 1.4, name="box")], far, in_space)
    assert run.outcome is mr.Outcome.AT_REST
    assert printed(run.message) == ({} if past is None else {"box": pytest.approx(past, abs=0.01)})
    assert ("Faces have no end" in run.message) is (past is not None)


@pytest.mark.parametrize("in_space", [False, True])
def test_a_block_on_two_piers_has_passed_the_outer_edge(in_space):
    """Between the piers nothing is below its centroid, and it stands."""
    piers = [box(-2.4, -1.6, 0, 1, fixed=True, name="left"), box(-0.4, 0.4, 0, 1, fixed=True, name="right")]
    beam = box(-2.2, 0.2, 1, 1.2, name="beam")
    assert printed(slid([GROUND, *piers, beam], 0.3, in_space).message) == {}
    gone = slid([GROUND, *piers, beam], 1.5, in_space)
    assert printed(gone.message) == {"beam": pytest.approx(0.1, abs=0.02)}


def test_what_overhangs_as_it_is_drawn_counts_from_there():
    """A cornice stone whose tail carries weight."""
    cornice = [box(-0.2, 0.6, 1, 1.2, name="cornice"), box(-0.8, 0.1, 1.2, 2.2, name="above")]
    blocks = [GROUND, STEP, cornice[0], box(-0.8, -0.2, 1, 1.2, name="behind"), cornice[1]]
    still = mr.simulate(mr.MasonryCase(mr.Masonry(blocks, k_n=1e9), 0.1))
    assert printed(still.message) == {}


def test_a_block_that_fell_is_not_named_twice():
    run = slid([GROUND, STEP, box(-1.1, -0.1, 1, 1.4, name="box")], 1.3, False)
    assert list(run.fallen) == ["box"]
    assert printed(run.message) == {}
