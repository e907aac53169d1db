"""Stiffness of bodies in pairs, by full matrices."""

import numpy as np
from scipy.sparse import csr_array

from mjrock.scene.pattern import PairPattern, Springs

BODIES = np.array([[2, 0], [0, -1], [0, 2], [-1, 1], [2, 0]])
"""Pairs of four bodies: either is first, the other may be fixed, and the last body has none."""
NV, COUNT = 3, 4


def full(rates):
    """Rates of pairs as rows of a full matrix."""
    matrix = np.zeros((len(rates), COUNT, NV))
    for row, pair, of_pair in zip(matrix, BODIES, rates, strict=False):
        for body, values in zip(pair, of_pair, strict=True):
            if body >= 0:
                row[body] += values
    return matrix.reshape(len(rates), -1)


def test_stiffness_and_forces_are_those_of_full_matrices():
    pattern, random = PairPattern(BODIES, NV, COUNT), np.random.default_rng(0)
    pushed, stretched = random.random((2, 5, 2, NV))
    springs, some = random.random(5), np.array([0, 3])
    of_some = Springs(pushed[some], stretched[some], springs[:2], some)
    found = pattern.stiffness_of(Springs(pushed, stretched, springs, slice(None)), of_some)
    expected = full(pushed).T @ np.diag(springs) @ full(stretched)
    expected += full(pushed)[some].T @ np.diag(springs[:2]) @ full(stretched)[some]
    np.testing.assert_allclose(pattern.matrix(found).toarray(), expected, rtol=1e-12)
    np.testing.assert_allclose(pattern.forces(pushed[:4], springs[:4]), full(pushed)[:4].T @ springs[:4], rtol=1e-12)
    np.testing.assert_array_equal(found[pattern.diagonal], np.diag(pattern.matrix(found).toarray()))


def test_a_matrix_is_taken_whichever_of_the_entries_it_has():
    pattern = PairPattern(BODIES, NV, COUNT)
    whole = pattern.matrix(np.arange(1.0, 1 + len(pattern.indices))).toarray()
    whole[::2] = 0.0
    np.testing.assert_array_equal(pattern.matrix(pattern.entries_of(csr_array(whole))).toarray(), whole)
