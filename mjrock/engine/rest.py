"""Rest: the poses in which the springs of the contacts carry the weight and the constant forces."""

from __future__ import annotations

from functools import partial

import numpy as np
from scipy.linalg import null_space

from ..compiled import compiled
from ..problem.quantities import GRAVITY, Array, Flags
from .kinematics import Forces, Points, Ties, along, carried, frame_of, gap, gaps, slack

ITERATIONS = 1000
"""Most iterations of Newton's method. A wall that is nearly too heavy for its base takes hundreds."""
ROUNDING = 16 * np.finfo(float).eps
"""Rounding of the length of a tie, over that length [-]."""
LEANING = 1e-6
"""Stiffness of an open contact in the search for a direction, over that of a closed one [-]."""
SMALLEST_SHARE = 1e-6
"""Smallest share of a step of Newton's method [-]."""
TURNED = 0.5
"""Rotation beyond which a body no longer stands [rad]."""
FLAT = 1e-12
"""Negative stiffness that is put down to rounding, over the largest [-]."""


class UnsettledError(ValueError):
    """No pose of rest was found; `pose` is the last one that was tried, shape (n, 3)."""

    def __init__(self, pose: Array) -> None:
        super().__init__(
            "the bodies do not stand on their contacts: no pose was found in which the springs carry weight and "
            "forces. The valid range are contacts that are stiffer, or loads and thrusts whose line of action with the "
            "weight runs nearer to the middle of the base"
        )
        self.pose = pose


def gap_rates(points: Points, ties: Ties, pose: Array) -> Array:
    """Rates of the gaps and of the slack of the ties for unit velocities at a pose of shape (3 n,), (m + t, 3 n)."""
    made = np.zeros((len(points.k) + len(ties.k), len(pose)))
    _gap_rates(points, ties, frame_of(pose), np.zeros_like(pose), np.zeros_like(pose), made)
    return made


@compiled
def _gap_rates(points: Points, ties: Ties, frame: Array, unit: Array, none: Array, made: Array) -> None:
    m = len(points.k)
    for i in range(len(made)):
        body = points.body[i] if i < m else ties.body[i - m]
        other = points.face_body[i] if i < m else ties.face_body[i - m]
        for one in (body, other):
            for j in range(3 * one, 3 * one + 3 if one >= 0 else 0):
                unit[j] = 1.0
                made[i, j] = gap(points, i, frame, unit, none)[1] if i < m else slack(ties, i - m, frame, unit, none)[1]
                unit[j] = 0.0


def openings(points: Points, ties: Ties, pose: Array) -> Array:
    """Gaps of the contacts and slack of the ties at a pose of shape (3 n,) [m], shape (m + t,)."""
    frame = frame_of(pose)
    return np.append(gaps(points, pose[None])[0], [slack(ties, i, frame, pose, pose)[0] for i in range(len(ties.k))])


def curvature(points: Points, ties: Ties, forces: Forces, pose: Array) -> Array:
    """Second derivatives of the energy that turning makes, at a pose of shape (3 n,), shape (3 n, 3 n).

    A spring that is pressed by g and whose gap has the second derivatives H adds -k g H, which is what the weight takes
    from the stiffness of a tall wall. A force that follows a turning point adds its part likewise.
    """
    made = np.zeros((len(pose), len(pose)))
    pressed = np.maximum(-openings(points, ties, pose), 0.0) * np.append(points.k, ties.k)
    frame, none = frame_of(pose), np.zeros_like(pose)
    _curvatures(points, ties, frame, np.zeros_like(pose), none, pressed, made)
    for body, (x, z), force in zip(forces.body, forces.at, forces.force, strict=True):
        one = np.zeros_like(pose)
        one[3 * body + 2] = 1.0
        made[3 * body + 2, 3 * body + 2] -= force @ carried(frame, one, none, body, x, z)[6:8]
    return made


@compiled
def _curvatures(points: Points, ties: Ties, frame: Array, way: Array, none: Array, pressed: Array, made: Array) -> None:
    """Add what each pressed contact makes. What the velocities alone make of a gap is its second derivative along
    them."""
    m = len(points.k)
    for i in range(len(pressed)):
        if pressed[i] == 0:
            continue
        body = points.body[i] if i < m else ties.body[i - m]
        other = points.face_body[i] if i < m else ties.face_body[i - m]
        for p in range(6 if other >= 0 else 3):
            for r in range(6 if other >= 0 else 3):
                row = 3 * body + p if p < 3 else 3 * other + p - 3
                column = 3 * body + r if r < 3 else 3 * other + r - 3
                for sign in (1.0, -1.0):
                    way[row] += 1.0
                    way[column] += sign
                    bent = gap(points, i, frame, way, none)[3] if i < m else slack(ties, i - m, frame, way, none)[3]
                    made[row, column] -= 0.25 * sign * pressed[i] * bent
                    way[row], way[column] = 0.0, 0.0


def is_stable(points: Points, ties: Ties, forces: Forces, closed: Flags, pose: Array) -> bool:
    """Whether no motion that friction allows takes energy from a pose at rest, of shape (3 n,)."""
    rates, k = gap_rates(points, ties, pose), np.append(points.k, ties.k)
    matrix = (rates.T * np.where(closed, k, 0.0)) @ rates
    size = float(np.abs(matrix).max())
    matrix += curvature(points, ties, forces, pose)
    free = null_space(slip_rates(points, closed, pose), rcond=1e-9)
    return not free.size or float(np.linalg.eigvalsh(free.T @ matrix @ free)[0]) > -FLAT * size


def slip_rates(points: Points, closed: Flags, pose: Array) -> Array:
    """Rates of the slip between bodies that friction holds, for unit velocities, shape (pairs of bodies, 3 n).

    It is the mean slip of the closed points with friction of each pair. Two edges of one joint that both held would
    lock its rotation.
    """
    own = np.zeros((len(points.k), len(pose)))
    _slips(points, frame_of(pose), np.zeros_like(pose), own)
    rows: dict[tuple[int, int], list[int]] = {}
    for i in np.flatnonzero(closed[: len(points.k)] & (points.friction > 0)):
        body, face = int(points.body[i]), int(points.face_body[i])
        rows.setdefault((min(body, face), max(body, face)), []).append(int(i))
    return np.reshape([own[lines].mean(axis=0) for lines in rows.values()], (-1, len(pose)))


@compiled
def _slips(points: Points, frame: Array, unit: Array, made: Array) -> None:
    """Rate at which each point moves along its face, for unit velocities, shape (m, 3 n)."""
    for i in range(len(made)):
        for one in (points.body[i], points.face_body[i]):
            for j in range(3 * one, 3 * one + 3 if one >= 0 else 0):
                unit[j] = 1.0
                made[i, j] = along(points, i, frame, unit)[1]
                unit[j] = 0.0


def load(forces: Forces, masses: Array, pose: Array) -> Array:
    """Generalised force of the weight and of the constant forces at a pose of shape (3 n,), shape (3 n,)."""
    total = np.zeros_like(masses)
    total[1::3] = -GRAVITY * masses[1::3]
    frame, columns = frame_of(pose), np.eye(len(pose))
    for body, (x, z), force in zip(forces.body, forces.at, forces.force, strict=True):
        total += [force @ carried(frame, v, v, body, x, z)[2:4] for v in columns]
    return total


def potential(points: Points, ties: Ties, forces: Forces, masses: Array, pose: Array) -> float:
    """Energy of springs, weight and constant forces at a pose of shape (3 n,) [J]."""
    frame = frame_of(pose)
    pressed = np.maximum(-openings(points, ties, pose), 0.0)
    total = 0.5 * np.append(points.k, ties.k) @ pressed**2 + GRAVITY * masses[1::3] @ pose[1::3]
    for body, (x, z), force in zip(forces.body, forces.at, forces.force, strict=True):
        total -= force @ carried(frame, pose, pose, body, x, z)[:2]
    return float(total)


def settled(points: Points, ties: Ties, forces: Forces, masses: Array) -> Array:
    """The pose in which the springs of contacts and ties carry weight and forces, shape (n, 3).

    Friction holds every joint that touches. Where no pose is found so, it holds those that are pressed: a block beside
    a wall that touches and does not press would else carry it by friction alone.

    Raises:
        UnsettledError: if no such pose is found near the undeformed one.
    """
    try:
        return _settled(points, ties, forces, masses, pressed=False)
    except UnsettledError as error:
        try:
            return _settled(points, ties, forces, masses, pressed=True)
        except UnsettledError:
            raise error from None


def _settled(points: Points, ties: Ties, forces: Forces, masses: Array, *, pressed: bool) -> Array:
    """As `settled`, by Newton's method on the potential energy, which every step lowers.

    Where nothing holds a direction, the bodies stay where they are. Friction holds the joints that touch, or those that
    are `pressed`.
    """
    pose, k = np.zeros_like(masses), np.append(points.k, ties.k)
    closed = np.append(np.ones(len(points.k), dtype=bool), openings(points, ties, pose)[len(points.k) :] < 0)
    scale = GRAVITY * float(masses[1::3].max())
    tolerated = max(1e-9 * scale, ROUNDING * float((ties.k * ties.reach).max(initial=0)))
    energy_at = partial(potential, points, ties, forces, masses)
    for _ in range(ITERATIONS):
        rates, depth = gap_rates(points, ties, pose), -openings(points, ties, pose)
        carrying = np.where(closed, k, 0.0)
        stiffness = (rates.T * np.where(closed, k, LEANING * k)) @ rates
        residual = load(forces, masses, pose) + rates.T @ (carrying * depth)
        grip = k.max() * slip_rates(points, closed & (depth > 0) if pressed else closed, pose)
        matrix = np.block([[stiffness, grip.T], [grip, np.zeros((len(grip), len(grip)))]])
        found = np.linalg.lstsq(matrix, np.append(residual, np.zeros(len(grip))), rcond=1e-14)[0]
        moved, friction = found[: len(pose)], found[len(pose) :]
        if np.abs(residual - grip.T @ friction).max() < tolerated and (closed == (depth > 0)).all():
            if is_stable(points, ties, forces, closed, pose):
                return pose.reshape(-1, 3)
            break
        energy, share = energy_at(pose), 1.0
        while share > SMALLEST_SHARE and energy_at(pose + share * moved) > energy + 1e-13 * max(scale, abs(energy)):
            share *= 0.5
        pose = pose + share * moved
        if not np.abs(pose[2::3]).max() < TURNED:
            break
        closed = openings(points, ties, pose) < 0
    raise UnsettledError(pose.reshape(-1, 3))


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
