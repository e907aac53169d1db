"""Equilibrium: the poses in which the springs of the contacts carry the weight and the constant forces."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array, vstack

from ..geometry.kinematics import Forces, Places, gaps
from ..geometry.poses import moved, turned
from ..linear import averaged, balance, fitting, is_definite, sprung
from ..quantities import GRAVITY, Array, Flags
from .potential import Potential

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
    """No pose of rest was found; `pose` is the last one that was tried, shape (n, nq)."""

    def __init__(self, pose: Array) -> None:
        super().__init__(
            "the bodies do not stand on their contacts: no pose was found in which the springs carry weight and "
            "forces. The valid range are contacts that are stiffer, or loads and thrusts whose line of action with the "
            "weight runs nearer to the middle of the base"
        )
        self.pose = pose


def settled(potential: Potential, friction: Array) -> Array:
    """The pose in which the springs of contacts and ties carry weight and forces, shape (n, nq).

    Friction holds every joint that touches. Where no pose is found so, it holds those that are pressed: a block beside
    a wall that touches and does not press would else carry it by friction alone.

    Args:
        potential: of the scene.
        friction: coefficient of friction of each contact [-], shape (m,).

    Raises:
        UnsettledError: if no such pose is found near the undeformed one.
    """
    try:
        return _settled(potential, friction, pressed=False)
    except UnsettledError as error:
        try:
            return _settled(potential, friction, pressed=True)
        except UnsettledError:
            raise error from None


def _settled(potential: Potential, friction: Array, *, pressed: bool) -> Array:
    """As `settled`, by Newton's method on the potential energy, which every step lowers.

    Where nothing holds a direction, the bodies stay where they are. Friction holds the joints that touch, or those that
    are `pressed`.
    """
    places, ties, masses = potential.structure.places, potential.structure.ties, potential.structure.masses
    freedom, m, pose, k = places.freedom, len(friction), potential.unmoved, potential.springs
    closed = np.append(np.ones(m, dtype=bool), potential.openings(pose)[m:] < 0)
    scale = GRAVITY * float(masses[freedom.translations - 1 :: freedom.nv].max())
    tolerated = max(1e-9 * scale, ROUNDING * float((ties.k * ties.reach).max(initial=0)))
    for _ in range(ITERATIONS):
        rates, depth = fitting(potential.rates(pose)), -potential.openings(pose)
        stiffness = sprung(rates, np.where(closed, k, LEANING * k))
        residual = potential.load(pose) + rates.T @ (np.where(closed, k, 0.0) * depth)
        grip = k.max() * held_slips(potential, friction, closed & (depth > 0) if pressed else closed, pose)
        try:
            motion, held = balance(stiffness, grip, residual)
        except RuntimeError:  # a pivot of zero: friction holds more than the bodies can move
            break
        if np.abs(residual - grip.T @ held).max() < tolerated and (closed == (depth > 0)).all():
            if is_stable(potential, friction, closed, pose):
                return pose.reshape(-1, freedom.nq)
            break
        energy, share = potential.energy(pose), 1.0
        lower = energy + 1e-13 * max(scale, abs(energy))
        while share > SMALLEST_SHARE and potential.energy(moved(pose, share * motion, freedom)) > lower:
            share *= 0.5
        pose = moved(pose, share * motion, freedom)
        if not turned(pose, freedom).max() < TURNED:
            break
        closed = potential.openings(pose) < 0
    raise UnsettledError(pose.reshape(-1, freedom.nq))


def is_stable(potential: Potential, friction: Array, closed: Flags, pose: Array) -> bool:
    """Whether no motion that friction allows takes energy from a pose at rest, of shape (n nq,)."""
    stiffness = potential.stiffness(pose, np.where(closed, potential.springs, 0.0))
    hessian = csr_array(stiffness + potential.curvature(pose))
    return is_definite(hessian, held_slips(potential, friction, closed, pose), FLAT * float(abs(stiffness).max()))


def held_slips(potential: Potential, friction: Array, closed: Flags, pose: Array) -> csr_array:
    """Rates of the slip between bodies that friction holds, for unit velocities, shape (held, n nv).

    It is the mean slip of the closed points with friction of each pair. Two edges of one joint that both held would
    lock its rotation. In space it is the mean along both tangents, and the mean moment of the slips about the middle of
    the points, by which a body would spin on its joint.
    """
    places = potential.structure.places
    holds = closed[: len(friction)] & (friction > 0)
    pair = np.sort(np.column_stack([places.body, places.face_body]), axis=1)[holds]
    pairs, first, number = np.unique(pair, axis=0, return_index=True, return_inverse=True)
    group = np.full(len(friction), -1)
    group[holds] = np.argsort(np.argsort(first))[number]  # in the order in which the contacts name them
    rates = potential.slip_rates(pose)
    if len(rates) == 1:
        return averaged(rates[0], group, len(pairs))
    arms, grouped, middles = potential.spots(pose), group[holds], np.zeros((len(pairs), 2))
    np.add.at(middles, grouped, arms[np.flatnonzero(holds)] / np.bincount(grouped)[grouped, None])
    arms[np.flatnonzero(holds)] -= middles[grouped]
    spins = csr_array(diags_array(arms[:, 0]) @ rates[1] - diags_array(arms[:, 1]) @ rates[0])
    return csr_array(vstack([averaged(rows, group, len(pairs)) for rows in (*rates, spins)]))


def lowered(places: Places, springs: Array, forces: Forces, masses: Array, pose: Array) -> Array:
    """A pose lowered until the springs of level ground carry the weight of all bodies, shape (n, nq).

    The bodies keep their rotations and their horizontal positions.
    """
    freedom, up = places.freedom, places.freedom.translations - 1
    level = (places.face_body < 0) & (places.normal[:, up] > 1 - 1e-12)
    depth, k = -gaps(places, np.array(pose, dtype=float).reshape(1, -1))[0][level], springs[level]
    order = np.argsort(-depth, kind="stable")  # the deepest points are loaded first
    depth, k = depth[order], k[order]
    # sum k_i max(0, depth_i - z) = m g + what presses down, for the points down to the i-th
    carries = GRAVITY * masses[up :: freedom.nv].sum() - forces.force[:, up].sum()
    levels = (np.cumsum(k * depth) - carries) / np.cumsum(k)
    z = levels[np.flatnonzero(levels >= np.append(depth[1:], -np.inf))[0]]
    return pose + z * (np.arange(freedom.nq) == up)
