"""Stiffness of bodies in pairs, as an array of the entries that it may have."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csc_array, csr_array

from ..compiled import compiled
from ..quantities import Array, Integers


class Springs(NamedTuple):
    """Springs of some pairs.

    Args:
        pushed: rates of the lengths along which they push, for unit velocities of the two bodies, shape (m, 2, nv).
        stretched: likewise of the lengths that they are stretched by. Those of a spring are the same, unless its force
            depends on another length.
        stiffness: shape (m,) [N/m].
        pairs: which pairs they are.
    """

    pushed: Array
    stretched: Array
    stiffness: Array
    pairs: Integers | slice


class PairPattern:
    """The entries that a stiffness of bodies may have: those of each body, and of two that are a pair.

    A stiffness is an array of these entries, those of a column one after the other.

    Args:
        bodies: numbers of the two bodies of each pair, negative for one that is fixed, shape (pairs, 2).
        nv: unknowns of a body.
        count: how many bodies there are.
    """

    def __init__(self, bodies: Integers, nv: int, count: int) -> None:
        unknowns, on_diagonal = np.arange(nv), np.arange(count) * (count + 1)
        self.count = nv * count
        self.unknown = np.where(bodies[:, :, None] < 0, self.count, nv * bodies[:, :, None] + unknowns)
        both_move = (bodies[:, :, None] >= 0) & (bodies[:, None] >= 0)
        blocks = np.where(both_move, bodies[:, :, None] + count * bodies[:, None], 0)
        filled = np.unique(np.append(blocks[both_move], on_diagonal))
        column, row = np.divmod(filled, count)
        heights = nv * np.bincount(column, minlength=count)
        self.indptr = np.append(0, np.cumsum(np.repeat(heights, nv))).astype(np.int32)
        first = self.indptr[nv * column] + nv * (np.arange(len(filled)) - np.searchsorted(column, column))
        places = first[:, None, None] + heights[column, None, None] * unknowns[:, None] + unknowns
        self.indices = np.empty(self.indptr[-1], dtype=np.int32)
        self.indices[places] = (nv * row)[:, None, None] + unknowns
        self.diagonal = places[np.searchsorted(filled, on_diagonal)][:, unknowns, unknowns].ravel()
        number = np.searchsorted(filled, blocks)
        self.first, self.height = np.where(both_move, first[number], -1), heights[column[number]]

    def matrix(self, entries: Array) -> csc_array:
        """A stiffness as a matrix."""
        return csc_array((entries, self.indices, self.indptr), shape=(self.count, self.count))

    def entries_of(self, matrix: csr_array) -> Array:
        """A matrix as a stiffness. All of its entries are among those of the pattern."""
        entries = np.zeros(len(self.indices))
        _copy_entries(
            matrix.data, matrix.indices, matrix.indptr, self.indices, self.indptr[:-1].astype(np.int64), entries
        )
        return entries

    def forces(self, rates: Array, along: Array) -> Array:
        """Generalised force of forces along lengths [N], shape (m,), which are those of the first m pairs and have
        these rates for the velocities of the two bodies, shape (m, 2, nv)."""
        unknown, force = self.unknown[: len(along)].ravel(), (rates * along[:, None, None]).ravel()
        return np.asarray(np.bincount(unknown, force, self.count + 1)[:-1], dtype=float)

    def stiffness_of(self, *groups: Springs) -> Array:
        """The stiffness of some groups of springs, added in their order."""
        entries = np.zeros(len(self.indices))
        for pushed, stretched, stiffness, pairs in groups:
            _add_springs(pushed, stretched, stiffness, self.first[pairs], self.height[pairs], entries)
        return entries


@compiled
def _add_springs(
    pushed: Array, stretched: Array, springs: Array, first: Integers, height: Integers, entries: Array
) -> None:
    """Add springs to a stiffness, from where the block of each pair of bodies begins, and the height of its column."""
    nv = pushed.shape[2]
    for i in range(len(springs)):
        for row in range(2):
            for column in range(2):
                for k in range(nv if first[i, row, column] >= 0 else 0):
                    begin = first[i, row, column] + k * height[i, row, column]
                    for j in range(nv):
                        entries[begin + j] += stretched[i, column, k] * (springs[i] * pushed[i, row, j])


@compiled
def _copy_entries(
    values: Array, columns: Integers, begins: Integers, rows: Integers, reached: Integers, entries: Array
) -> None:
    """Copy a matrix by rows into entries by columns. `reached` is the entry that each column has reached."""
    for row in range(len(begins) - 1):
        for i in range(begins[row], begins[row + 1]):
            column = columns[i]
            while rows[reached[column]] < row:
                reached[column] += 1
            entries[reached[column]] = values[i]
