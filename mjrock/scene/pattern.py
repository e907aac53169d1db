"""Stiffness of bodies in pairs, as an array of the entries that it may have."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, csr_array

from ..compiled import compiled
from ..quantities import Array, Integers

Springs = tuple[Array, Array, Array, Integers | slice]
"""Springs of some pairs, see `PairPattern.sprung`."""


class PairPattern:
    """The entries that a stiffness of bodies may have: those of each body, and of two that are a pair.

    A stiffness is an array of these entries, those of a column one after the other.

    Args:
        bodies: numbers of the two bodies of each pair, negative for one that is fixed, shape (pairs, 2).
        nv: unknowns of a body.
        count: how many bodies there are.
    """

    def __init__(self, bodies: Integers, nv: int, count: int) -> None:
        every, own = np.arange(nv), np.arange(count) * (count + 1)
        self.count = nv * count
        self.unknown = np.where(bodies[:, :, None] < 0, self.count, nv * bodies[:, :, None] + every)
        there = (bodies[:, :, None] >= 0) & (bodies[:, None] >= 0)
        blocks = np.where(there, bodies[:, :, None] + count * bodies[:, None], 0)
        filled = np.unique(np.append(blocks[there], own))
        column, row = np.divmod(filled, count)
        heights = nv * np.bincount(column, minlength=count)
        self.indptr = np.append(0, np.cumsum(np.repeat(heights, nv))).astype(np.int32)
        first = self.indptr[nv * column] + nv * (np.arange(len(filled)) - np.searchsorted(column, column))
        places = first[:, None, None] + heights[column, None, None] * every[:, None] + every
        self.indices = np.empty(self.indptr[-1], dtype=np.int32)
        self.indices[places] = (nv * row)[:, None, None] + every
        self.diagonal = places[np.searchsorted(filled, own)][:, every, every].ravel()
        number = np.searchsorted(filled, blocks)
        self.first, self.height = np.where(there, first[number], -1), heights[column[number]]

    def matrix(self, entries: Array) -> csc_array:
        """A stiffness as a matrix."""
        return csc_array((entries, self.indices, self.indptr), shape=(self.count, self.count))

    def taken(self, matrix: csr_array) -> Array:
        """The stiffness that is this matrix."""
        entries = np.zeros(len(self.indices))
        _take(matrix.data, matrix.indices, matrix.indptr, self.indices, self.indptr[:-1].astype(np.int64), entries)
        return entries

    def forces(self, rates: Array, along: Array) -> Array:
        """Generalised force of forces along lengths [N], shape (m,), which are those of the first m pairs and have
        these rates for the velocities of the two bodies, shape (m, 2, nv)."""
        unknown, force = self.unknown[: len(along)].ravel(), (rates * along[:, None, None]).ravel()
        return np.asarray(np.bincount(unknown, force, self.count + 1)[:-1], dtype=float)

    def sprung(self, *terms: Springs) -> Array:
        """The stiffness of springs of some pairs: rates of the lengths along which they push, of those that they are
        stretched by, both of the shape (m, 2, nv), their stiffness [N/m], shape (m,), and which pairs they are."""
        entries = np.zeros(len(self.indices))
        for pushed, stretched, springs, pairs in terms:
            _add_springs(pushed, stretched, springs, self.first[pairs], self.height[pairs], entries)
        return entries


@compiled
def _add_springs(
    pushed: Array, stretched: Array, springs: Array, first: Integers, height: Integers, entries: Array
) -> None:
    nv = pushed.shape[2]
    for i in range(len(springs)):
        for row in range(2):
            for column in range(2):
                for k in range(nv if first[i, row, column] >= 0 else 0):
                    begin = first[i, row, column] + k * height[i, row, column]
                    for j in range(nv):
                        entries[begin + j] += stretched[i, column, k] * (springs[i] * pushed[i, row, j])


@compiled
def _take(
    values: Array, columns: Integers, begins: Integers, rows: Integers, reached: Integers, entries: Array
) -> None:
    for row in range(len(begins) - 1):
        for i in range(begins[row], begins[row + 1]):
            column = columns[i]
            while rows[reached[column]] < row:
                reached[column] += 1
            entries[reached[column]] = values[i]
