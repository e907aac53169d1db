"""Large structures are factorised as they are: the same rest, stability and frequencies as those solved in full."""

import numpy as np
import pytest
import scipy
from everyday import crossed
from scipy.sparse import csc_array, csr_array

import mjrock as mr
from mjrock import linear
from mjrock.problem.masonry.limit.statics import slippery
from mjrock.problem.masonry.lines import lowest_frequency
from mjrock.scene.masonry import scene_of_masonry
from mjrock.scene.rest import UnsettledError
from scripts.studies import two_storeys

WALLS = {
    "bond": lambda: mr.Masonry.running_bond(2.0, 1.5, (0.5, 0.25), thickness=0.3, k_n=2e9, friction=0.65),
    "arch": lambda: mr.Masonry.arch(3.0, 0.5, k_n=1e9, voussoirs=17),
    "smooth": lambda: mr.Masonry.running_bond(1.5, 0.75, (0.5, 0.25), friction=lambda j: 0.6 if j.is_bed else 0.0),
    "stack": lambda: mr.Masonry.stack([mr.Block(0.4, 0.5), mr.Block(0.3, 0.9), mr.Block(0.2, 0.4)], 5e8),
    "open heads": lambda: two_storeys.wall(two_storeys.QUICK),
    "soft": lambda: mr.Masonry.stack([mr.Block(0.3, 1.0), mr.Block(0.3, 1.0)], 1e6),
}


def test_blocks_along_a_diagonal_are_those_of_a_full_matrix():
    blocks = np.random.default_rng(0).random((3, 2, 2))
    blocks[1] = [[0.0, 2.0], [0.0, 0.0]]
    found = linear.block_diagonal(blocks)
    assert np.array_equal(found.toarray(), scipy.linalg.block_diag(*blocks))
    assert found.nnz == 9  # zeros take no place: they would change in what order unknowns are eliminated


def measured(masonry):
    """Pose of rest, whether it is stable, and the lowest and the highest frequency, of a scene made anew."""
    scene_of_masonry.cache_clear()
    scene = scene_of_masonry(masonry)
    try:
        pose, stands = scene.at_rest, True
    except UnsettledError:
        pose, stands = np.zeros((len(masonry.free), 3)), False
    lowest = lowest_frequency(masonry.blocks, masonry.lines, masonry.joint_friction)
    return pose, stands, lowest, scene.highest_frequency


@pytest.mark.parametrize(("many", "name"), crossed([linear.MANY_UNKNOWNS, 0], WALLS))
def test_all_ways_agree(name, many, monkeypatch):
    masonry = WALLS[name]()
    full = measured(masonry)
    monkeypatch.setattr(linear, "SOLVED_IN_FULL", 0)
    monkeypatch.setattr(linear, "MANY_UNKNOWNS", many)
    sparse = measured(masonry)
    np.testing.assert_allclose(sparse[0], full[0], rtol=0, atol=1e-9 * np.abs(full[0]).max())
    assert sparse[1] == full[1] == (name != "soft")
    assert sparse[2:] == pytest.approx(full[2:], rel=1e-9)


def test_motions_that_are_held_twice_or_by_nothing(monkeypatch):
    """The same row twice, an unknown that nothing resists, and one that falls."""
    stiffness = csr_array(np.diag([2.0, 3.0, 0.0, 5.0]))
    constraints = csr_array([[1.0, 1.0, 0.0, 0.0]] * 2)
    answers = []
    for few, many in ((300, 20_000), (0, 20_000), (0, 0)):
        monkeypatch.setattr(linear, "SOLVED_IN_FULL", few)
        monkeypatch.setattr(linear, "MANY_UNKNOWNS", many)
        for first in (0.0, -4.0):
            value, mode = linear.lowest_mode(csr_array(np.diag([2.0, 3.0, first, 5.0])), 4.0)
            assert value == pytest.approx(first, abs=1e-9)
            np.testing.assert_allclose(np.abs(mode), [0.0, 0.0, 1.0, 0.0], rtol=0, atol=1e-9)
        answers.append(linear.lowest_square(stiffness, np.ones(4), constraints, 1e-12))
    assert answers == pytest.approx([2.5, 2.5, 2.5], rel=1e-9)


def test_what_is_clearly_stable_has_no_eigenvalue_near_zero(monkeypatch):
    axes = np.linalg.qr(np.random.default_rng(0).standard_normal((6, 6)))[0]

    def clearly(lowest):
        return linear.is_clearly_stable(csc_array(axes @ np.diag([lowest, 1.0, 2.0, 3.0, 4.0, 5.0]) @ axes.T))

    assert [clearly(lowest) for lowest in (1e-9, 0.0, -1e-9)] == [True, False, False]
    monkeypatch.setattr(linear, "SOLVED_IN_FULL", 5)
    assert not clearly(1.0)


@pytest.mark.parametrize("small", [0.0, 1e-18])
def test_a_matrix_whose_diagonal_is_no_pivot_is_solved_with_others(small, monkeypatch):
    monkeypatch.setattr(linear, "MANY_UNKNOWNS", 0)
    matrix = csc_array([[small, 1.0, 0.0], [1.0, small, 1.0], [0.0, 1.0, 2.0]])
    motion = np.array([3.0, -1.0, 0.5])
    np.testing.assert_allclose(linear.solution(matrix, matrix @ motion), motion, rtol=1e-12)


def test_what_slides_on_joints_without_friction(monkeypatch):
    """The course above the first one slides on it, and takes what stands on it along."""
    masonry = mr.Masonry.running_bond(
        2.0, 1.0, (0.5, 0.25), friction=lambda joint: 0.0 if abs(joint.middle[1] - 0.25) < 1e-6 else 0.6
    )
    full = slippery(masonry)
    monkeypatch.setattr(linear, "SOLVED_IN_FULL", 0)
    assert slippery(masonry) == full
    assert 0 < len(full[1]) < len(masonry.joints)
