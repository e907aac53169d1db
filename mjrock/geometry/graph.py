"""Connected components of graphs. SciPy's graphs are imported when they are first used, since that takes long."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ..quantities import Integers


def connected_parts(pairs: ArrayLike, count: int) -> Integers:
    """The number of the connected component of each node, shape (count,).

    Args:
        pairs: the two nodes of each edge, shape (edges, 2).
        count: number of nodes.
    """
    components = scipy.sparse.csgraph.connected_components(_graph(pairs, count), directed=False)[1]
    return np.asarray(components, dtype=np.int64)  # loops are compiled for numbers of this size


def nearest_roots(pairs: ArrayLike, count: int, roots: Sequence[int]) -> Integers:
    """The root with the fewest edges to each node, or a negative number where none is connected, shape (count,).

    Args:
        pairs: the two nodes of each edge, shape (edges, 2).
        count: number of nodes.
        roots: the nodes from which edges are counted.
    """
    paths = scipy.sparse.csgraph.dijkstra(
        _graph(pairs, count), directed=False, indices=roots, min_only=True, return_predecessors=True
    )
    return np.asarray(paths[2], dtype=np.int64)


def _graph(pairs: ArrayLike, count: int) -> scipy.sparse.coo_array:
    rows, columns = np.reshape(np.asarray(pairs, dtype=np.int64), (-1, 2)).T
    return scipy.sparse.coo_array((np.ones(len(rows)), (rows, columns)), shape=(count, count))
