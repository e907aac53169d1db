"""Bodies in space at rest: a pose and friction within its cones in which the springs of their points carry the weight.

Points push only. Along the face each has a spring with a slider that slips where the spring would pass the friction.
Where many slip, friction accumulates from pose to pose as it does in the explicit steps. The search is Newton's method.
Keeping the shear stiffness of slipping points converges safely and slowly; dropping it converges fast or not at all.
The share of the spring is therefore halved from pose to pose, and is whole again when more force is missing than
before.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csc_array, csr_array, diags_array, vstack
from scipy.sparse.linalg import splu

from ..geometry.frames import SPACE
from ..geometry.poses import moved, turned
from ..linear import is_definite, sprung
from ..problem.masonry.joint_law import Law, normal_force, shear_limit
from ..quantities import Array, Flags
from .equilibrium import FLAT, LEANING, TURNED, UnsettledError, tolerance, touching
from .potential import Potential

SEARCHES = ((1e3, 20, False), (1.0, 150, True), (0.1, 300, True))
"""Searches, each where the one before has not ended: the shear stiffness of points over their normal stiffness [-],
nearly rigid at first, as friction that holds is, and then softer, as stiff ones slip more on the way; how many poses
are tried at most; and whether friction accumulates, or is that of springs as long as the slip from the place drawn."""
LOOSE, LEAST_LOOSE = 1e-9, 1e-12
"""Stiffness that is lent to every motion in the search, over the largest: at the start, and the least of it [-]."""
SLIPPING, RAISED = 1e-2, 4.0
"""Least share of its shear stiffness that a point that slips lends along its slip, and by how much it is raised each
time that more force is missing than before [-]."""

ENDED = 0.5
"""Force that is missing, over that of the pose before, above which a pose that is near enough ends the search [-].
Faces that touch without force are then apart by less than the resolution of the coordinates."""


class Grips(NamedTuple):
    """Friction of the points at a pose, in the axes of their faces, see `Potential.slip_rates`.

    Args:
        rates: of the slips for unit velocities, two of shape (m, 6 n).
        drag: friction on the bodies of the points [N], shape (m, 2).
        stiffness: of the chord where a point slips [N/m], shape (m,).
        slips: whether a point slips, shape (m,).
        slider: how far the slider of each point has moved [m], shape (m, 2).
    """

    rates: tuple[csr_array, ...]
    drag: Array
    stiffness: Array
    slips: Flags
    slider: Array


def settled_in_space(potential: Potential, friction: Array) -> tuple[Array, Array]:
    """The pose in which the springs of contacts and ties carry weight and forces, and the friction there.

    Where nothing holds a direction, the bodies stay where they are.

    Args:
        potential: of the scene.
        friction: coefficient of friction of each contact [-], shape (m,).

    Returns:
        The pose, shape (n, 7), and the friction on the bodies of the points along the two `tangents` of their faces at
        rest, which turn with them [N], shape (m, 2).

    Raises:
        UnsettledError: if no such pose is found near the undeformed one, or the bodies fall from it.
    """
    for search in SEARCHES:
        try:
            pose, grips = searched(potential, friction, search)
        except UnsettledError as error:
            unsettled = error
            continue
        if not stands(potential, grips, pose):
            raise UnsettledError(pose.reshape(-1, 7))
        return pose.reshape(-1, 7), grips.drag
    raise unsettled


def searched(potential: Potential, friction: Array, search: tuple[float, int, bool]) -> tuple[Array, Grips]:
    """The pose of rest, shape (7 n,), and the friction there, by one of the searches.

    Raises:
        UnsettledError: if there is none within its number of poses.
    """
    shear, poses, accumulates = search
    k, masses, pose = potential.springs, potential.structure.masses, potential.unmoved
    size = np.sqrt(masses / np.repeat(masses[::6], 6))  # moments are compared with forces by radii of gyration
    scales, loose, share, least, last = diags_array(1 / size), LOOSE, 1.0, SLIPPING, np.inf
    m, openings, closed = len(friction), potential.openings(pose), touching(potential, pose)
    slider = np.zeros((m, 2))
    for tried in range(poses):
        rates, push = potential.rates(pose), normal_force(potential.law, openings, 0.0)
        limit = np.where(closed[:m] & (friction > 0), shear_limit(Law(friction=friction), push[:m]), -np.inf)
        grips = grips_at(potential, pose, limit, (shear * k[:m], slider))
        held = grips.rates[0].T @ grips.drag[:, 0] + grips.rates[1].T @ grips.drag[:, 1]
        missing = (potential.load(pose) + rates.T @ push + held) / size
        left, slider = float(np.abs(missing).sum()), grips.slider if accumulates else slider
        ends = left > ENDED * last or tried == poses - 1
        if ends and np.abs(missing).max() < tolerance(potential):
            return pose, grips
        if left < last:
            loose, share = max(0.5 * loose, LEAST_LOOSE), max(0.5 * share, least)
        else:
            loose, share, least = 2 * loose, 1.0, min(RAISED * least, 1.0)
        last = left
        stiffness = sprung(rates, np.where(closed, k, LEANING * k)) + shear_stiffness(grips, share)
        scaled = scales @ stiffness @ scales
        lent = np.full(len(size), loose * float(scaled.diagonal().max()))
        pose = moved(pose, splu(csc_array(scaled + diags_array(lent))).solve(missing) / size, SPACE)
        openings = potential.openings(pose)
        closed = openings < 0
        if not turned(pose, SPACE).max() < TURNED:
            break
    raise UnsettledError(pose.reshape(-1, 7))


def grips_at(potential: Potential, pose: Array, limit: Array, shear: tuple[Array, Array]) -> Grips:
    """Friction at a pose.

    Args:
        potential: of the scene.
        pose: shape (7 n,).
        limit: of the friction of each point, negative for one that slips freely [N], shape (m,).
        shear: their shear stiffnesses [N/m], shape (m,), and where their sliders were before [m], shape (m, 2).
    """
    k_s, slider = shear
    stretch = potential.slips(pose) - slider
    held = k_s * np.linalg.norm(stretch, axis=1)
    slips = held > limit
    stays = np.where(slips, np.maximum(limit, 0.0) / np.where(held > 0, held, 1.0), 1.0)
    stiffness, slider = stays * k_s, slider + (1 - stays)[:, None] * stretch
    return Grips(potential.slip_rates(pose), -stiffness[:, None] * stretch, stiffness, slips, slider)


def shear_stiffness(grips: Grips, share: float) -> csr_array:
    """Stiffness of the points along their faces, shape (6 n, 6 n). Along its slip a point has a share of it."""
    (first, second), slips = grips.rates, grips.slips & (grips.stiffness > 0)
    ways = grips.drag[slips] / np.linalg.norm(grips.drag[slips], axis=1)[:, None]
    along = diags_array(ways[:, 0]) @ first[slips] + diags_array(ways[:, 1]) @ second[slips]
    less = (share - 1) * grips.stiffness[slips]
    springs = np.concatenate([grips.stiffness, grips.stiffness, less])
    return csr_array(sprung(csr_array(vstack([first, second, along])), springs))


def stands(potential: Potential, grips: Grips, pose: Array) -> bool:
    """Whether no motion takes energy from a pose at rest, of shape (7 n,), while its friction holds."""
    hessian, none = potential.hessian(pose), csr_array((0, 6 * len(pose) // 7))
    return is_definite(csr_array(hessian + shear_stiffness(grips, 1.0)), none, FLAT * float(abs(hessian).max()))
