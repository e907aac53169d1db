"""Masses of bodies that turn about axes other than their principal ones.

The axes of a body of space are those of the world at rest. Its mass matrix is m, m, m and the tensor of inertia about
its centroid in these axes. `masses` are the diagonals of all bodies, and `products` the products of inertia Ixy, Ixz
and Iyz of each body, shape (n, 3). In the plane there are none, shape (0, 3).
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, eye_array

from ..compiled import inlined
from ..geometry.vectors import Vector, spun
from ..linear import block_diagonal
from ..quantities import Array

PRODUCT_ROUNDING = 1e-12
"""Product of inertia that counts as rounding, over the sum of the moments [-]."""


def mass_diagonals(mass: Array, inertia: Array) -> Array:
    """The diagonals of the mass matrices of all bodies, shape (n nv,), for inertia of shape (n,) or (n, 3, 3)."""
    if inertia.ndim == 1:
        return np.column_stack([mass, mass, inertia]).ravel()
    return np.column_stack([mass, mass, mass, np.diagonal(inertia, axis1=1, axis2=2)]).ravel()


def products_of(inertia: Array) -> Array:
    """Ixy, Ixz and Iyz of tensors of inertia [kg m2], shape (n, 3), zero where they are rounding, or (0, 3)."""
    if inertia.ndim == 1:
        return np.empty((0, 3))
    products = np.column_stack([inertia[:, 0, 1], inertia[:, 0, 2], inertia[:, 1, 2]])
    rounding = PRODUCT_ROUNDING * np.trace(inertia, axis1=1, axis2=2)
    return np.where(np.abs(products) > rounding[:, None], products, 0.0)


def principal(mass: Array, inertia: Array) -> tuple[csr_array, Array]:
    """Velocities along principal axes, as columns of shape (n nv, n nv), and the masses of each, shape (n nv,).

    They are orthonormal, so that M^-1 = columns / masses @ columns^T.
    """
    if inertia.ndim == 1:
        masses = mass_diagonals(mass, inertia)
        return csr_array(eye_array(len(masses))), masses
    moments, axes = np.linalg.eigh(inertia)
    blocks = np.stack([np.broadcast_to(np.eye(3), axes.shape), axes], axis=1).reshape(-1, 3, 3)
    return block_diagonal(blocks), np.column_stack([mass, mass, mass, moments]).ravel()


@inlined
def coupling(products: Array, v: Array) -> float:
    """The part of v^T M v that the products of inertia add to the sum of masses times squares [J]."""
    total = 0.0
    for body in range(len(products)):
        x, y, z = v[6 * body + 3], v[6 * body + 4], v[6 * body + 5]
        total += 2 * (products[body, 0] * x * y + products[body, 1] * x * z + products[body, 2] * y * z)
    return total


def kinetic_energies(masses: Array, products: Array, velocity: Array) -> Array:
    """Kinetic energy of each body [J], shape (n,), for velocities of shape (n, nv)."""
    energies: Array = 0.5 * (masses.reshape(velocity.shape) * velocity**2).sum(axis=1)
    if len(products):
        x, y, z = velocity[:, 3:].T
        energies += (products * np.column_stack([x * y, x * z, y * z])).sum(axis=1)
    return energies


@inlined
def angular_momentum(masses: Array, products: Array, body: int, spin: Vector) -> Vector:
    """Angular momentum of a body of space about its centroid, in its axes [kg m2/s]."""
    xx, yy, zz = masses[6 * body + 3], masses[6 * body + 4], masses[6 * body + 5]
    xy, xz, yz = products[body, 0], products[body, 1], products[body, 2]
    x, y, z = spin
    return xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z


@inlined
def gyroscopic(masses: Array, products: Array, body: int, spin: Vector) -> Vector:
    """Spin x angular momentum, the rate at which the axes of a body turn its momentum [N m]."""
    return spun(spin, angular_momentum(masses, products, body, spin))
