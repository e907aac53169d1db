"""Rest: the poses in which the springs of the contacts carry the weight and the constant forces."""

from __future__ import annotations

import numpy as np

from ..problem.quantities import GRAVITY, Array, Flags
from .kinematics import Forces, Points, Ties, along, carried, frame_of, gap, gaps, slack

ITERATIONS = 1000
"""Most iterations of Newton's method. A wall that is nearly too heavy for its base takes hundreds."""
ROUNDING = 16 * np.finfo(float).eps
"""Rounding of the length of a tie, over that length [-]."""


def gap_rates(points: Points, ties: Ties, pose: Array) -> Array:
    """Rates of the gaps and of the slack of the ties for unit velocities at a pose of shape (3 n,), (m + t, 3 n)."""
    frame, columns, none = frame_of(pose), np.eye(len(pose)), np.zeros_like(pose)
    rates = [[gap(points, i, frame, v, none)[1] for v in columns] for i in range(len(points.k))]
    rates += [[slack(ties, i, frame, v, none)[1] for v in columns] for i in range(len(ties.k))]
    return np.reshape(rates, (-1, len(pose)))


def openings(points: Points, ties: Ties, pose: Array) -> Array:
    """Gaps of the contacts and slack of the ties at a pose of shape (3 n,) [m], shape (m + t,)."""
    frame = frame_of(pose)
    return np.append(gaps(points, pose[None])[0], [slack(ties, i, frame, pose, pose)[0] for i in range(len(ties.k))])


def slip_rates(points: Points, closed: Flags, pose: Array) -> Array:
    """Rates of the slip between bodies that friction holds, for unit velocities, shape (pairs of bodies, 3 n).

    It is the mean slip of the closed points with friction of each pair. Two edges of one joint that both held would
    lock its rotation.
    """
    frame, columns = frame_of(pose), np.eye(len(pose))
    rows: dict[tuple[int, int], list[list[float]]] = {}
    for i in np.flatnonzero(closed[: len(points.k)] & (points.friction > 0)):
        pair = int(points.body[i]), int(points.face_body[i])
        rows.setdefault(pair, []).append([along(points, int(i), frame, v)[1] for v in columns])
    return np.reshape([np.mean(slips, axis=0) for slips in rows.values()], (-1, len(pose)))


def load(forces: Forces, masses: Array, pose: Array) -> Array:
    """Generalised force of the weight and of the constant forces at a pose of shape (3 n,), shape (3 n,)."""
    total = np.zeros_like(masses)
    total[1::3] = -GRAVITY * masses[1::3]
    frame, columns = frame_of(pose), np.eye(len(pose))
    for body, (x, z), force in zip(forces.body, forces.at, forces.force, strict=True):
        total += [force @ carried(frame, v, v, body, x, z)[2:4] for v in columns]
    return total


def settled(points: Points, ties: Ties, forces: Forces, masses: Array) -> Array:
    """The pose in which the springs of contacts and ties carry weight and forces, shape (n, 3).

    Newton's method on the potential energy. Friction holds every joint that is pressed. Where nothing holds a
    direction, the bodies stay where they are.

    Raises:
        ValueError: if no such pose is found near the undeformed one.
    """
    pose, k = np.zeros_like(masses), np.append(points.k, ties.k)
    closed = np.append(np.ones(len(points.k), dtype=bool), openings(points, ties, pose)[len(points.k) :] < 0)
    tolerated = max(1e-9 * GRAVITY * float(masses[1::3].max()), ROUNDING * float((ties.k * ties.reach).max(initial=0)))
    for _ in range(ITERATIONS):
        rates, depth = gap_rates(points, ties, pose), -openings(points, ties, pose)
        carrying = np.where(closed, k, 0.0)
        stiffness = (rates.T * carrying) @ rates
        residual = load(forces, masses, pose) + rates.T @ (carrying * depth)
        grip = k.max() * slip_rates(points, closed, pose)
        matrix = np.block([[stiffness, grip.T], [grip, np.zeros((len(grip), len(grip)))]])
        found = np.linalg.lstsq(matrix, np.append(residual, np.zeros(len(grip))), rcond=1e-12)[0]
        moved, friction = found[: len(pose)], found[len(pose) :]
        if np.abs(residual - grip.T @ friction).max() < tolerated and (closed == (depth > 0)).all():
            return pose.reshape(-1, 3)
        pose = pose + moved
        closed = openings(points, ties, pose) < 0
    raise ValueError(
        "the bodies do not stand on their contacts: no pose was found in which the springs carry weight and forces. "
        "The valid range are contacts that are stiffer, or loads and thrusts whose line of action with the weight runs "
        "nearer to the middle of the base"
    )


def lowered(points: Points, forces: Forces, masses: Array, pose: Array) -> Array:
    """A pose lowered until the springs of level ground carry the weight of all bodies, shape (n, 3).

    The bodies keep their rotations and their horizontal positions.
    """
    level = (points.face_body < 0) & (points.normal[:, 1] > 1 - 1e-12)
    depth, k = -gaps(points, np.array(pose, dtype=float).reshape(1, -1))[0][level], points.k[level]
    order = np.argsort(-depth, kind="stable")  # the deepest points are loaded first
    depth, k = depth[order], k[order]
    # sum k_i max(0, depth_i - z) = m g + what presses down, for the points down to the i-th
    carries = GRAVITY * masses[1::3].sum() - forces.force[:, 1].sum()
    levels = (np.cumsum(k * depth) - carries) / np.cumsum(k)
    z = levels[np.flatnonzero(levels >= np.append(depth[1:], -np.inf))[0]]
    return pose + np.array([0.0, z, 0.0])
