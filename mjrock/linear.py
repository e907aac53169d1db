"""Linear algebra of structures: stability and frequencies of bodies on springs, some of whose motions are constrained.

Matrices are sparse. Structures of few unknowns are solved in full, by null spaces and eigenvalues, which need no
care. Larger ones are factorised as they are: a block has three unknowns and meets a handful of others.

Rows `constraints` give rates that are zero. They may depend on one another.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy  # which imports its parts when they are named
from scipy.sparse import block_array, csc_array, csr_array, diags_array, eye_array

from .quantities import Array, Integers

SOLVED_IN_FULL = 300
"""Most unknowns of a structure that is solved in full."""
MANY_UNKNOWNS = 20_000
"""Unknowns above which matrices are factorised with their pivots on the diagonal, in half the time and memory [-]."""
LARGEST_ERROR = 1e-6
"""Error of a solution with such factors, over the force, above which the matrix is factorised with other pivots [-]."""
DEPENDENT = 1e-9
"""Singular value of held motions below which they depend on one another, over the largest [-]."""
YIELDING = 1e-6
"""Compliance that every held motion is given while a large structure is balanced, over that of its stiffest unknown
[-]. The unknowns that it moves may have no spring, as those along a course whose head joints are open."""
REFINED, REFINEMENTS = 1e-13, 8
"""Error at which a balance is exact, over what is balanced [-], and most refinements of it."""
SHIFT = 1e-9
"""Shift of the squares of the frequencies of a large structure, over that of the highest [-], with which motions that
nothing resists need no treatment of their own."""
MIXTURES = 4
"""Motions that stand for all that nothing resists in a large structure."""
SIGN_COMPONENT = 0.5
"""Least component of a mode that may give it its sign, over its largest [-]."""
CLEARLY_STABLE = 1e-11
"""Least eigenvalue of a matrix that is clearly stable, over its largest entry [-]."""
EIGENVALUE_TOLERANCE = 1e-12
"""Tolerance of the search for a frequency of a large structure, over its square [-]."""


def rates_matrix(values: Array, bodies: Integers, unknowns: int) -> csr_array:
    """A matrix with the rates of pairs of bodies.

    Args:
        values: of each row for the unknowns of its bodies, shape (rows, bodies of a row, unknowns of a body).
        bodies: their numbers, negative for one that is fixed, shape (rows, bodies of a row).
        unknowns: of all bodies.

    Returns:
        The matrix, shape (rows, unknowns).
    """
    rows, _, nv = values.shape
    columns = nv * bodies[:, :, None] + np.arange(nv)
    is_free = np.broadcast_to(bodies[:, :, None] >= 0, values.shape)
    row_starts = np.append(0, np.cumsum(nv * (bodies >= 0).sum(axis=1)))
    matrix = csr_array((values[is_free], columns[is_free], row_starts), shape=(rows, unknowns))
    matrix.sum_duplicates()
    return matrix


def sum_of_pair_matrices(values: Array, bodies: Integers, unknowns: int) -> csr_array:
    """The sum of matrices of pairs of bodies, each for the unknowns of the first and then of the second one.

    Args:
        values: shape (pairs, unknowns of two bodies, unknowns of two bodies).
        bodies: their numbers, negative for one that is fixed, shape (pairs, 2).
        unknowns: of all bodies.

    Returns:
        The matrix, shape (unknowns, unknowns).
    """
    nv = values.shape[1] // 2
    unknown = np.where(bodies[:, :, None] < 0, -1, nv * bodies[:, :, None] + np.arange(nv)).reshape(-1, 2 * nv)
    unknown = unknown.astype(np.int32)
    rows, columns = np.broadcast_arrays(unknown[:, :, None], unknown[:, None])
    is_entry = (rows >= 0) & (columns >= 0) & (values != 0)
    return csr_array((values[is_entry], (rows[is_entry], columns[is_entry])), shape=(unknowns, unknowns))


def block_diagonal(blocks: Array) -> csr_array:
    """The matrix with square blocks along its diagonal, shape (n k, n k), of blocks of the shape (n, k, k)."""
    (n, size, _), (block, row, column) = blocks.shape, np.nonzero(blocks)
    positions = np.array([size * block + row, size * block + column], dtype=np.int32)
    return csr_array((blocks[block, row, column], tuple(positions)), shape=(n * size, n * size))


def summed(matrices: Sequence[csr_array]) -> csr_array:
    """The sum of some matrices, added at once."""
    rows, columns = (np.concatenate([part.tocoo().coords[i] for part in matrices]) for i in range(2))
    values = np.concatenate([part.data for part in matrices])
    return csr_array((values, (rows, columns)), shape=matrices[0].shape)


def rates_of(pair: Integers, arms: tuple[Array, Array], direction: Array, bodies: int) -> csr_array:
    """Rates at which places of pairs of bodies move apart in directions, for unit velocities.

    They are the generalised forces of unit forces that press the two apart.

    Args:
        pair: numbers of the two bodies, negative for one that is fixed, shape (rows, 2).
        arms: from the centroid of each to the place [m], shape (rows, 2) each, in space (rows, 3).
        direction: unit vectors, of the same shape.
        bodies: how many there are.

    Returns:
        Rates for x, z and rotation of each body, shape (rows, 3 bodies). In space for x, y, z and the angular velocity
        in the axes of the world, shape (rows, 6 bodies).
    """
    sides, plane = [], direction.shape[1] == 2
    for sign, arm in zip((1.0, -1.0), arms, strict=True):
        x, z = direction[:, 0], direction[:, -1]
        turning = (arm[:, 1] * x - arm[:, 0] * z)[:, None] if plane else np.cross(arm, direction)
        sides.append(sign * np.hstack([direction, turning]))
    return rates_matrix(np.stack(sides, axis=1), np.asarray(pair, dtype=np.int64), (3 if plane else 6) * bodies)


def averaged(rows: csr_array, group: Integers, count: int) -> csr_array:
    """Means of the rows of each group, shape (count, unknowns); a row with a negative number is in none."""
    grouped = np.flatnonzero(group >= 0)
    shape = (count, len(group))
    sums = csr_array((np.ones(len(grouped)), (group[grouped], grouped)), shape=shape) @ rows
    sums.data /= np.repeat(np.bincount(group[grouped], minlength=count), np.diff(sums.indptr))
    return csr_array(sums)


def scaled_rows(factors: Array, rows: csr_array) -> csr_array:
    """The rows of a matrix, each times its factor: what a diagonal matrix gives that multiplies it, in less time."""
    values = np.repeat(factors, np.diff(rows.indptr)) * rows.data
    return csr_array((values, rows.indices, rows.indptr), shape=rows.shape)


def scaled_rows_and_columns(factors: Array, matrix: csr_array) -> csr_array:
    """The rows and the columns of a matrix, each times its factor."""
    product = scaled_rows(factors, matrix)
    product.data *= factors[product.indices]
    return product


def stiffness_of_springs(rates: csr_array, springs: Array) -> csr_array:
    """Stiffness of springs [N/m] whose rates are these."""
    return csr_array(scaled_rows(springs, rates).T @ rates)


class _Balance:
    """The factors of a large matrix near that of a balance, regular whatever is loose or constrained twice."""

    def __init__(self, stiffness: csr_array, constraints: csr_array, loose: float) -> None:
        stiffest = float(stiffness.diagonal().max())
        self.stiffness, self.constraints, self.transpose = stiffness, constraints, csr_array(constraints.T)
        yielding = diags_array(-YIELDING / stiffest * constraints.power(2).sum(axis=1))
        added = diags_array(np.full(stiffness.shape[0], loose * stiffest))
        near = block_array([[stiffness + added, self.transpose], [constraints, yielding]], format="csc")
        self.factors = _factors(near)

    def __call__(self, force: Array) -> tuple[Array, Array]:
        """The motion u with stiffness u + constraints^T f = force and constraints u = 0, and the forces f.

        The residual of a solution of the near matrix is balanced in turn.
        """
        count, n = self.constraints.shape
        residual, error, scale = np.append(force, np.zeros(count)), np.inf, float(np.abs(force).max())
        motion, reaction = np.zeros(n), np.zeros(count)
        for _ in range(REFINEMENTS):
            correction = self.factors.solve(residual)
            motion, reaction = motion + correction[:n], reaction + correction[n:]
            unbalanced = force - self.stiffness @ motion - self.transpose @ reaction
            residual = np.append(unbalanced, -(self.constraints @ motion))
            last_error, error = error, float(np.abs(residual).max())
            if error < REFINED * scale or error > 0.5 * last_error:
                break
        return motion, reaction


def _factors(matrix: csc_array) -> scipy.sparse.linalg.SuperLU:
    """Factors of a symmetric matrix with the pivots on its diagonal."""
    return scipy.sparse.linalg.splu(
        matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )


def solution(matrix: csc_array, force: Array) -> Array:
    """The motion that a stiffness, which need not be symmetric, takes for a force, shape (unknowns,)."""
    if matrix.shape[0] > MANY_UNKNOWNS:
        motion: Array = _factors(matrix).solve(force)
        if np.abs(matrix @ motion - force).max() <= LARGEST_ERROR * np.abs(force).max():
            return motion
    return scipy.sparse.linalg.splu(matrix).solve(force)  # type: ignore[no-any-return]


def is_clearly_stable(matrix: csc_array) -> bool:
    """Whether all eigenvalues of a symmetric matrix of few unknowns are above its rounding, which takes a tenth of the
    time of `lowest_mode`. Of many unknowns it says nothing."""
    if matrix.shape[0] > SOLVED_IN_FULL:
        return False
    full = matrix.toarray()
    try:
        np.linalg.cholesky(full - CLEARLY_STABLE * np.abs(full).max() * np.eye(len(full)))
    except np.linalg.LinAlgError:
        return False
    return True


def lowest_mode(matrix: csr_array, most: float) -> tuple[float, Array]:
    """The lowest eigenvalue of a symmetric matrix, none of which is below -most, and its unit vector.

    The first of its large components is positive: no rounding decides which way it points.
    """
    n = matrix.shape[0]
    if n <= SOLVED_IN_FULL:
        values, modes = np.linalg.eigh(matrix.toarray())
    else:
        start = np.random.default_rng(0).random(n)
        matrix, shift, inverse = csc_array(matrix), -2 * most, None
        if n > MANY_UNKNOWNS:
            factors = _factors(csc_array(matrix - shift * eye_array(n)))
            inverse = scipy.sparse.linalg.LinearOperator((n, n), factors.solve, dtype=float)
        values, modes = scipy.sparse.linalg.eigsh(
            matrix, 1, sigma=shift, which="LM", tol=EIGENVALUE_TOLERANCE, v0=start, OPinv=inverse
        )
    mode = modes[:, 0]
    return float(values[0]), mode * np.sign(mode[np.argmax(np.abs(mode) > SIGN_COMPONENT * np.abs(mode).max())])


def loose(rows: csr_array) -> Array:
    """Motions at which no row has a rate, shape (unknowns, motions): a basis, of many unknowns random mixtures."""
    n = rows.shape[1]
    if n <= SOLVED_IN_FULL:
        return scipy.linalg.null_space(rows.toarray(), rcond=DEPENDENT)  # type: ignore[no-any-return]
    gram = csc_array(rows.T @ rows)
    shift = SHIFT * float(gram.diagonal().max())
    factors = _factors(csc_array(gram + shift * eye_array(n)))
    motions: Array = np.random.default_rng(0).standard_normal((n, MIXTURES))
    for _ in range(3):  # each time, what a row resists is divided by its stiffness over the shift
        motions = shift * factors.solve(motions)
    return motions


def highest_square(stiffness: csr_array, masses: Array) -> float:
    """The highest square of a natural frequency [rad2/s2]."""
    matrix = scaled_rows_and_columns(1 / np.sqrt(masses), stiffness)
    if len(masses) <= SOLVED_IN_FULL:
        return float(np.linalg.eigvalsh(matrix.toarray())[-1])
    start = np.random.default_rng(0).random(len(masses))
    return float(
        scipy.sparse.linalg.eigsh(matrix, 1, which="LA", tol=EIGENVALUE_TOLERANCE, v0=start, return_eigenvectors=False)[
            0
        ]
    )


def lowest_square(stiffness: csr_array, masses: Array, constraints: csr_array, rigid: float) -> float:
    """The lowest square of a natural frequency with some motions constrained [rad2/s2], zero if there is none.

    Args:
        stiffness: of the springs, positive semi-definite.
        masses: of the unknowns.
        constraints: rates of what is fixed, for unit velocities.
        rigid: square up to which a motion is one that nothing resists, over the highest [-].
    """
    n, root = len(masses), 1 / np.sqrt(masses)
    stiffness = scaled_rows_and_columns(root, stiffness)
    if n <= SOLVED_IN_FULL:
        return _lowest_square_in_full(stiffness, constraints.toarray() * root, rigid)
    constraints = csr_array(constraints @ diags_array(root))
    # a bound is enough for the shift, and takes no search
    highest = highest_square(stiffness, np.ones(n)) if n <= MANY_UNKNOWNS else float(abs(stiffness).sum(axis=1).max())
    if highest == 0:
        return 0.0
    balance = _Balance(csr_array(stiffness + SHIFT * highest * eye_array(n)), constraints, 0.0)
    inverse = scipy.sparse.linalg.LinearOperator((n, n), lambda x: balance(x)[0], dtype=float)
    start, count = inverse @ np.random.default_rng(0).random(n), 1
    while count < n // 2:
        # the inverse of the shifted squares is largest for the lowest of them
        inverses = scipy.sparse.linalg.eigsh(
            inverse, count, which="LA", tol=EIGENVALUE_TOLERANCE, v0=start, return_eigenvectors=False
        )
        squares = np.sort(1 / inverses) - SHIFT * highest
        resisted = squares[squares > 0.5 * SHIFT * highest]
        if resisted.size:
            return float(resisted[0])
        count *= 4
    return _lowest_square_in_full(stiffness, constraints.toarray(), rigid)


def _lowest_square_in_full(stiffness: csr_array, constraints: Array, rigid: float) -> float:
    """As `lowest_square`, of unit masses, by all squares of frequencies."""
    free = scipy.linalg.null_space(constraints, rcond=DEPENDENT)
    squares = np.linalg.eigvalsh(free.T @ (stiffness @ free)) if free.shape[1] else np.zeros(0)
    squares = squares[squares > rigid * max(squares, default=0.0)]
    return float(squares[0]) if squares.size else 0.0
