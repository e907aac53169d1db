"""Equilibrium: the poses in which the springs of the contacts carry the weight and the constant forces."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from ..geometry.kinematics import Forces, Places, gaps
from ..geometry.poses import moved, turned
from ..linear import averaged, balance, fitting, is_definite, sprung
from ..quantities import GRAVITY, Array, Flags
from .potential import Potential

ITERATIONS = 1000
"""Most iterations of Newton's method. A wall that is nearly too heavy for its base takes hundreds."""
EXACT = 1e-9
"""Force that may be missing at rest, over the weight of the heaviest body [-]."""
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
    freedom, pose, k = potential.structure.places.freedom, potential.unmoved, potential.springs
    closed = touching(potential, pose)
    scale, tolerated = heaviest(potential), tolerance(potential)
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


def touching(potential: Potential, pose: Array) -> Flags:
    """What is closed at the start of a search, shape (m + t,): all contacts, and the ties that are taut."""
    contacts = np.arange(len(potential.springs)) < len(potential.structure.k)
    closed: Flags = contacts | (potential.openings(pose) < 0)
    return closed


def heaviest(potential: Potential) -> float:
    """Weight of the heaviest body [N]."""
    freedom = potential.structure.places.freedom
    return GRAVITY * float(potential.structure.masses[:: freedom.nv].max())


def tolerance(potential: Potential) -> float:
    """Force that may be missing at rest [N]."""
    ties = potential.structure.ties
    return max(EXACT * heaviest(potential), ROUNDING * float((ties.k * ties.reach).max(initial=0)))


def is_stable(potential: Potential, friction: Array, closed: Flags, pose: Array) -> bool:
    """Whether no motion that friction allows takes energy from a pose at rest, of shape (n nq,)."""
    stiffness = potential.stiffness(pose, np.where(closed, potential.springs, 0.0))
    hessian = csr_array(stiffness + potential.curvature(pose))
    return is_definite(hessian, held_slips(potential, friction, closed, pose), FLAT * float(abs(stiffness).max()))


def held_slips(potential: Potential, friction: Array, closed: Flags, pose: Array) -> csr_array:
    """Rates of the slip between bodies that friction holds, for unit velocities, shape (held, n nv).

    It is the mean slip of the closed lines with friction of each pair. Two edges of one joint that both held would
    lock its rotation.
    """
    places = potential.structure.places
    holds = closed[: len(friction)] & (friction > 0)
    pair = np.sort(np.column_stack([places.body, places.face_body]), axis=1)[holds]
    pairs, first, number = np.unique(pair, axis=0, return_index=True, return_inverse=True)
    group = np.full(len(friction), -1)
    group[holds] = np.argsort(np.argsort(first))[number]  # in the order in which the contacts name them
    return averaged(potential.slip_rates(pose)[0], group, len(pairs))


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
