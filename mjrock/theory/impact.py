"""Rigid impact of masonry: the plastic impact of rocking theory for many blocks, as Housner's is for one.

Rigid blocks meet at their joints, which are all closed at the undeformed pose. In the impact no joint penetrates, no
joint slips unless it opens at both ends, and nothing bounces. Of all velocities that the joints allow, the blocks take
that which is nearest to their velocity before, in the norm of their masses (Moreau's plastic impact):

    v = argmin (v - v_0)' M (v - v_0)   with   G v >= 0,   T v = 0.

G gives the rates at which the ends of the joints open, T those at which joints slip. The multipliers are the impulses,
M (v - v_0) = G' p + T' q with p >= 0, and p = 0 where a joint opens. The energy that is lost is the kinetic energy of
v_0 - v. For one block on the ground this is Eq. 2 of the paper, conservation of angular momentum about the new edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import null_space

from ..problem.damping.restitution import Restitution
from ..problem.masonry.lines import lines_of, rates
from ..problem.masonry.masonry import Masonry
from ..problem.masonry.rigid_stack import RigidStack
from ..quantities import Array, Flags, frozen, require_array, require_kind

IMPACT_ROUNDING = 1e-9
"""Momentum, or speed, over the largest one, below which it counts as zero [-]."""
EXACT = 1e-13
"""Rate of closing, over the velocity, that is a rounding error [-]."""
MOST_CHANGES = 10
"""Most changes of the set of ends that are pressed, over the number of ends [-]."""


@dataclass(frozen=True, eq=False)
class RigidImpact:
    """The motion after a rigid impact, and its impulses.

    Args:
        velocity: velocity of each block that is not fixed after the impact: x, z and rotation [m/s, m/s, rad/s], shape
            (bodies, 3), as in `MasonryCase`.
        kept: kinetic energy after the impact over that before [-].
        opening: names of the joints that open, at one end or at both.
        impulses: impulse on the block above of each joint: across it at its start and at its end, and along it, from
            start to end positive [N s], shape (joints, 3). Where more joints are pressed than are needed, as in a wall
            in bond, these are some of many that give the same velocity. The impulse along a joint over the sum of those
            across it is the coefficient of friction that it takes not to slip.
    """

    velocity: Array
    kept: float
    opening: tuple[str, ...]
    impulses: Array

    def __repr__(self) -> str:
        opens = ", ".join(self.opening) or "none"
        return f"<RigidImpact keeps {self.kept:.4g} of the energy; joints that open: {opens}>"


def rigid_impact(masonry: Masonry, velocity: Array | ArrayLike) -> RigidImpact:
    """The velocity of masonry after a rigid impact at its undeformed pose, by rocking theory.

    It takes the geometry, the masses and whether a joint has friction, and no stiffness or damping. Friction is rigid:
    a joint that is closed at one end does not slip, whatever its coefficient, as in Housner's theory; the impulses give
    the coefficient that this takes. A joint with a friction of 0 is smooth. Fixed blocks do not move.

    A stack takes milliseconds, an arch of 50 voussoirs 0.2 s, a wall of 200 units in bond up to half a minute.

    Args:
        masonry: the masonry.
        velocity: velocity of each block that is not fixed before the impact: x, z and rotation [m/s, m/s, rad/s], shape
            (bodies, 3), as in `MasonryCase`. The rotation is positive where the top of a block turns to the right.

    Raises:
        TypeError: unless the masonry is a `Masonry` and the velocity an array of numbers.
        ValueError: if the velocity has another shape, a value that is not finite, or is zero everywhere, or for masonry
            in space.
        RuntimeError: if no impulses are found.
    """
    require_kind("masonry", masonry, Masonry)
    masonry.require_plane("rigid_impact")
    masonry.require_dry("rigid_impact")
    before = require_array("velocity", velocity, (len(masonry.free), 3)).ravel()
    if not before.any():
        raise ValueError("velocity is zero everywhere; an impact needs a block that moves")
    blocks, joints = masonry.polygons, masonry.plane_joints
    ends = lines_of(blocks, joints, np.ones(len(joints)), 2, mirrored=False)
    root_masses = np.sqrt([m for i in masonry.free for m in (blocks[i].mass, blocks[i].mass, float(blocks[i].inertia))])
    opens = rates(blocks, ends, ends.normal).toarray() / root_masses
    slips = rates(blocks, ends, ends.along).toarray()[::2] / root_masses  # both ends of a joint slip alike
    after, normal, shear = _velocity_and_impulses(root_masses * before, opens, slips, masonry.joint_friction > 0)
    momentum = float(np.linalg.norm(root_masses * before))
    after[np.abs(after) <= IMPACT_ROUNDING * momentum] = 0.0  # a block that stops has a velocity of exactly zero
    opening = (opens @ after).reshape(-1, 2).max(axis=1) > IMPACT_ROUNDING * momentum / root_masses.max()
    return RigidImpact(
        velocity=frozen((after / root_masses).reshape(-1, 3)),
        kept=float(after @ after) / momentum**2,
        opening=tuple(joint.name for joint, is_open in zip(joints, opening, strict=True) if is_open),
        impulses=frozen(np.column_stack([normal, shear])),
    )


def rigid_rocking(stack: RigidStack) -> Restitution:
    """The restitution of a stack that rocks as one.

    That of the base is of the rigid impact. That of the side stop conserves the angular momentum about its top (Eq. 3
    of the paper, see `Restitution.from_geometry`); a rigid impact on base and side stop at once leaves nothing.

    Raises:
        ValueError: if the side stop is so low that the stack turns on over it.
    """
    outwards = stack.outwards
    base = math.sqrt(min(1.0, rigid_impact(stack.free_standing, stack.turning(outwards, -outwards)).kept))
    if not stack.sides:
        return Restitution(base, 0.0)
    joints, mass, (x, z) = (
        [stack.masonry.plane_joints[i] for i in stack.sides],
        float(stack.masses.sum()),
        stack.centroid,
    )
    foot = stack.masonry.joints[stack.base].middle
    below = z + foot[1] - max(max(joint.start[1], joint.end[1]) for joint in joints)
    face = outwards * (x + foot[0] - joints[0].middle[0])
    momentum = stack.inertia + mass * (stack.lever(-outwards) * face + z * below)
    return Restitution(base, float(momentum / (stack.inertia + mass * (face**2 + below**2))))


def _velocity_and_impulses(before: Array, opens: Array, slips: Array, rough: Flags) -> tuple[Array, Array, Array]:
    """The velocity after, the impulses across the ends of each joint and those along it.

    Velocities are those of the blocks times the root of their mass, shape (n,). Rates of opening are at the two ends of
    the joints, shape (2 joints, n), those of slip have the shape (joints, n). A joint that is rough, with friction, is
    held unless both of its ends open. This is known after the impact only. A held joint that opens is
    released, once, and one that closes is held.
    """
    sizes = np.linalg.norm(slips, axis=1)
    rate = IMPACT_ROUNDING * float(np.linalg.norm(before)) * sizes  # of a joint that stays closed
    impulse = IMPACT_ROUNDING * float(np.linalg.norm(before)) / sizes  # of a joint that changes nothing

    def closed_in(velocity: Array) -> Flags:
        return (opens @ velocity).reshape(-1, 2).min(axis=1) <= rate

    sticking, parted = rough & closed_in(before), np.zeros_like(rough)
    while True:
        after, normal, shear = _solved_with_sticking(before, opens, slips, sticking)
        closed = closed_in(after)
        next_sticking = (sticking & (closed | parted)) | (rough & closed)
        if (next_sticking == sticking).all():
            shear[np.abs(shear) <= impulse] = 0.0
            return after, normal, shear
        parted |= sticking & ~next_sticking
        sticking = next_sticking


def _solved_with_sticking(before: Array, opens: Array, slips: Array, sticking: Flags) -> tuple[Array, Array, Array]:
    """As `_velocity_and_impulses`, for joints of which it is known whether they are held."""
    basis = null_space(slips[sticking]) if sticking.any() else np.eye(len(before))
    rates = opens @ basis
    rates[np.linalg.norm(rates, axis=1) <= IMPACT_ROUNDING * np.linalg.norm(opens, axis=1)] = (
        0.0  # ends that cannot move
    )
    normal, shear = _nearest_impulses(rates, basis.T @ before), np.zeros(len(slips))
    after = basis @ (basis.T @ (before + opens.T @ normal))
    shear[sticking] = np.linalg.lstsq(slips[sticking].T, after - before - opens.T @ normal, rcond=None)[0]
    return after, normal.reshape(-1, 2), shear


def _nearest_impulses(opens: Array, before: Array) -> Array:
    """The impulses p >= 0 that take a velocity to the nearest one at which nothing penetrates, shape (m,).

    They minimise |before + opens' p|, by the active-set method of Lawson and Hanson. Ends that are pressed are found
    one by one, the one that penetrates fastest first, and their least squares are those of least norm: in a wall in
    bond more ends can be pressed than the velocity distinguishes.

    Raises:
        RuntimeError: if the search does not end.
    """
    sizes, scale = np.linalg.norm(opens, axis=1), float(np.linalg.norm(before))
    impulses, active = np.zeros(len(opens)), np.zeros(len(opens), dtype=bool)
    if scale == 0:
        return impulses
    sizes[sizes == 0] = 1.0
    rows, aim = opens / sizes[:, None], before / scale
    excluded = np.zeros(len(opens), dtype=bool)
    for _ in range(MOST_CHANGES * len(opens)):
        closing = np.where(active | excluded, 0.0, rows @ (aim + impulses @ rows))
        if closing.min() >= -EXACT:
            return impulses * scale / sizes
        entering = int(closing.argmin())
        active[entering] = True
        while True:
            trial = np.zeros(len(opens))
            trial[active] = np.linalg.lstsq(rows[active].T, -aim, rcond=EXACT)[0]
            negative = active & (trial < 0)
            if not negative.any():
                break
            share = impulses[negative] / (impulses[negative] - trial[negative])  # of the change, until it pulls
            impulses = impulses + share.min() * (trial - impulses)
            active[np.flatnonzero(negative)[share.argmin()]] = False
            impulses[~active] = 0.0
        excluded[entering] = not active[entering]  # it closes by a rounding error
        impulses = trial
    raise RuntimeError(
        f"no impulses were found in {MOST_CHANGES * len(opens)} changes of the set of ends that are pressed"
    )
