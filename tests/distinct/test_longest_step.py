"""The longest stable step of one block in the plane and in space, against the highest mode of a matrix by hand."""

import math

import numpy as np
import pytest
from masonry_blocks import GROUND, box
from scipy.sparse import csr_array

import mjrock as mr
from mjrock.distinct import stable_step as eigenvalues
from mjrock.scene.time_step import stable_step

MASS, SIDE = 2000.0, 1.0
"""Mass [kg] and side [m] of a cube."""


def longest(in_space, effects=(), **options):
    """The longest stable step of a cube on its base [s]."""
    if in_space:
        base = mr.Polyhedron.box((5, 5, 1), (0, 0, -0.5), fixed=True)
        blocks = [base, mr.Polyhedron.box((SIDE, SIDE, SIDE), (0, 0, 0.5 * SIDE))]
    else:
        blocks = [GROUND, box(-0.5 * SIDE, 0.5 * SIDE, 0.0, SIDE)]
    masonry = mr.Masonry(blocks, **{"k_n": 1e8, "friction": 0.5, "xi": 0.0} | options)
    return mr.solve_explicit(mr.MasonryCase(masonry, 1e-3, effects=effects)).stats["stable_timestep"]


def highest(k, k_s, in_space):
    """The highest eigenvalue of a cube on the two lines or the four corners of its base, which sways and rocks, goes up
    and down, and in space spins about the vertical."""
    inertia, arm = MASS * SIDE**2 / 6, 0.5 * SIDE
    stiffness = np.array([[k_s, k_s * arm], [k_s * arm, k_s * arm**2 + k * arm**2]])
    root = np.diag([1 / math.sqrt(MASS), 1 / math.sqrt(inertia)])
    spinning = 2 * k_s * arm**2 / inertia if in_space else 0.0
    return max(np.linalg.eigvalsh(root @ stiffness @ root)[-1], k / MASS, spinning)


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("k_s", [1e8, 1e9])
def test_shear_springs_count(in_space, k_s):
    assert longest(in_space, k_s=k_s) == pytest.approx(stable_step(highest(1e8, k_s, in_space), 0.0), rel=1e-6)


def held(in_space, kind, length, **values):
    """A tie or a damper at the centroid of the cube."""
    place = {"at": (0.0, 0.0, 0.5 * SIDE)} if in_space else {"height": 0.5 * SIDE}
    return (kind(**values, **place, block=1, length=length),)


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("length", [0.2, 5.0])
def test_ties_count_by_their_stiffness_and_not_by_their_length(in_space, length):
    tie = held(in_space, mr.Tie, length, stiffness=1e10)
    assert longest(in_space, tie) == pytest.approx(stable_step(1e10 / MASS, 0.0), rel=1e-6)


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("length", [0.2, 5.0])
def test_dampers_count_by_their_dashpot_and_not_by_their_length(in_space, length):
    damper = held(in_space, mr.Damper, length, c=1e7)
    assert longest(in_space, damper) == pytest.approx(stable_step(highest(1e8, 0.0, in_space), 1e7 / MASS), rel=1e-6)


@pytest.mark.parametrize("in_space", [False, True])
def test_a_tie_counts_beside_shear_springs(in_space):
    """It shares the sway with the springs of the joint: what is soft in one is stiff in the other."""
    tie = held(in_space, mr.Tie, 1.0, stiffness=2e9)
    both = longest(in_space, tie, k_s=1e9)
    assert both < 0.99 * longest(in_space, k_s=1e9)
    assert both < 0.99 * longest(in_space, tie)


@pytest.mark.parametrize("in_space", [False, True])
def test_shear_dashpots_count(in_space):
    """They are in proportion to the shear springs as those along the normal are to theirs."""
    k_s, retardation = 1e9, 2 * 0.3 / 100.0
    modes = highest(1e8, k_s, in_space)
    expected = stable_step(modes, retardation * modes)
    assert longest(in_space, k_s=k_s, xi=0.3, frequency=100.0) == pytest.approx(expected, rel=1e-6)


def test_many_springs_have_the_highest_eigenvalue_of_the_bodies_that_they_act_on(monkeypatch):
    """That of 40 masses in a row on equal springs with both ends held, 4 k/m sin^2(40 pi / 82), to the tolerance of the
    search and its allowance of 1 %, whichever matrix it is taken from."""
    count, k, mass = 40, 3e6, 50.0
    rates = csr_array(np.eye(count + 1, count) - np.eye(count + 1, count, -1))
    exact = 4 * k / mass * math.sin(0.5 * math.pi * count / (count + 1)) ** 2
    for many in (0, 1000):
        monkeypatch.setattr(eigenvalues, "MANY_SPRINGS", many)
        found = eigenvalues.highest(rates, np.full(count + 1, k), csr_array(np.eye(count) / math.sqrt(mass)))
        assert exact < found < 1.011 * exact
