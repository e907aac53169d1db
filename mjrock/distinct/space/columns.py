"""Columns of rows in space as arrays, and the bodies' masses as a matrix."""

from __future__ import annotations

import numpy as np
from scipy.sparse import block_diag, csr_array

from ...quantities import Array
from ..system import Rows, named, stacked
from .system import AXES

EASE = ((0, 0, "xx"), (1, 1, "yy"), (2, 2, "zz"), (0, 1, "xy"), (0, 2, "xz"), (1, 2, "yz"))
"""Places of the numbers of an inverse inertia in its matrix."""
PLACE, REST = ("x", "y", "z"), ("x0", "y0", "z0")
QUATERNION = ("qw", "qx", "qy", "qz")


def vectors(table: Rows, name: str) -> Array:
    """The vectors of rows by the name that they have with _x, _y and _z, shape (rows, 3)."""
    return stacked(table, [f"{name}_{axis}" for axis in AXES])


def named_vectors(**given: Array) -> dict[str, Array]:
    """The columns of vectors by name, with _x, _y and _z."""
    columns: dict[str, Array] = {}
    for name, values in given.items():
        columns |= named([f"{name}_{axis}" for axis in AXES], values)
    return columns


def ease_columns(inertia: Array) -> dict[str, Array]:
    """The columns of the inverse inertia of bodies, from their tensors [kg m2], shape (n, 3, 3)."""
    ease = np.linalg.inv(inertia)
    return {f"ease_{pair}": np.asarray(ease[:, i, j], dtype=float) for i, j, pair in EASE}


def ease_of(bodies: Rows) -> Array:
    """The inverse inertia of bodies in their axes [1/(kg m2)], shape (n, 3, 3)."""
    ease = np.empty((len(bodies), 3, 3))
    for i, j, pair in EASE:
        ease[:, i, j] = ease[:, j, i] = bodies[f"ease_{pair}"]
    return ease


def root_of_masses(bodies: Rows) -> csr_array:
    """A matrix whose product with its transpose is the inverse of the masses at rest, shape (6 n, 6 n)."""
    roots = np.linalg.cholesky(ease_of(bodies))
    blocks = []
    for mass, root in zip(bodies["mass"], roots, strict=True):
        blocks += [np.eye(3) / np.sqrt(mass), root]
    return csr_array(block_diag(blocks, format="csr"))


def turns(quaternions: Array) -> Array:
    """R - 1 of unit quaternions, w first, shape (n, 3, 3)."""
    w, (x, y, z) = quaternions[:, 0], quaternions[:, 1:].T
    rows = (
        (-2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), -2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), -2 * (x * x + y * y)),
    )
    return np.moveaxis(np.array(rows), 2, 0)
