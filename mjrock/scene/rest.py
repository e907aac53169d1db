"""Bodies at rest: a pose and friction within its cones in which the springs of contacts and ties carry the weight.

Contacts push only. Along the face each has a spring with a slider that slips where the spring would pass the friction.
Where many slip, friction accumulates from pose to pose as it does in the explicit steps. The search is Newton's method.
Keeping the shear stiffness of slipping contacts converges safely and slowly; dropping it converges fast or not at all.
The share of the stiffness that is kept is therefore halved from pose to pose, and is whole again when more force is
missing than before.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy
from scipy.sparse import csc_array, csr_array, diags_array, vstack

from ..geometry.kinematics import Places, gaps
from ..geometry.poses import moved, turned
from ..linear import lowest_mode, sprung, times
from ..problem.masonry.laws.joint_law import Law, shear_limit
from ..quantities import GRAVITY, Array, Flags
from .potential import Potential, Structure

FORCE_TOLERANCE = 1e-9
"""Force that may be missing at rest, over the weight of the heaviest body [-]."""
LENGTH_ROUNDING = 16 * np.finfo(float).eps
"""Rounding of the length of a tie, over that length [-]."""
LEANING = 1e-6
"""Stiffness of an open contact in the search for a direction, over that of a closed one [-]."""
ROTATION_OF_FALLEN = 0.5
"""Rotation beyond which a body no longer stands [rad]."""
NEGLIGIBLE_STIFFNESS = 1e-12
"""Negative stiffness that is put down to rounding, over the largest [-]."""
LOOSE, LEAST_LOOSE, MOST_LOOSE = 1e-9, 1e-12, 1.0
"""Stiffness that is lent to every motion in the search, over the largest [-]: at the start, the least of it, and that
beyond which a search ends, since the bodies hardly move any more. Searches that find a pose lend less than 1e-5."""
SLIPPING, RAISED = 1e-2, 4.0
"""Least share of its shear stiffness that a contact that slips lends along its slip, and by how much it is raised each
time that more force is missing than before [-]."""
ENERGY_ROUNDING, RAISES, SMALLEST_PART = 1e-13, 1e-6, 1e-6
"""Rounding of the energy, over the weight of a body times a metre [-]; by how much a step of Newton's method may raise
the energy, over itself, as friction acts halfway between point and face where slip is that of the point [-]; and the
smallest part of a step that is tried."""
PUSHES, PUSH = 4, 1e-2
"""Most pushes off poses at which the bodies balance and do not stand, and the first motion of one, over the deepest
penetration [-]."""
LITTLE_PROGRESS = 0.5
"""Force that is missing, over that of the pose before, above which a pose that is near enough ends the search [-].
Faces that touch without force are then apart by less than the resolution of the coordinates."""


class Search(NamedTuple):
    """A search for rest.

    Args:
        shear: shear stiffness of the contacts over their normal stiffness [-].
        poses: how many are tried at most.
        limited: whether friction has its limit. Without one it holds the mean slip of the points of a joint that touch:
            points that were all held would lock its rotation.
        accumulates: whether sliders stay where they have slipped to from pose to pose.
        resumes: whether it starts where the one without a limit has ended, or from the undeformed pose.
    """

    shear: float
    poses: int
    limited: bool = True
    accumulates: bool = False
    resumes: bool = False


SEARCHES_FOR_REST = (
    Search(1e3, 20),
    Search(1e3, 20, limited=False),
    Search(1e3, 80, resumes=True),
    Search(1.0, 150, accumulates=True),
    Search(0.1, 300, accumulates=True),
)
"""Searches in turn, until one with limits ends. The first ones are nearly rigid along the faces. Contacts are softer
there in the last ones, as stiff ones slip more on the way."""


SEARCH_WITHOUT_LIMIT = Search(1e4, 100, limited=False)
"""The search in which friction holds without a limit. With 1e6 in place of 1e4, rounding of the slip makes a larger
force than may be missing."""


class UnsettledError(ValueError):
    """No pose of rest was found; `pose` is the last one that was tried, shape (n, nq)."""

    def __init__(self, pose: Array) -> None:
        super().__init__(
            "the bodies do not stand on their contacts: no pose was found in which the springs carry weight and "
            "forces. The valid range are contacts that are stiffer, or loads and thrusts whose line of action with the "
            "weight runs nearer to the middle of the base"
        )
        self.pose = pose


class Sliders(NamedTuple):
    """Springs of the contacts along their faces, which slip where they would pass the friction.

    Args:
        stiffness: of the springs [N/m], shape (m,).
        limit: friction that each contact can have, negative for one that is open or smooth [N], shape (m,).
        place: how far each slider has moved [m], shape (m, ways): one way in the plane, two in space.
        shares: share of the slip of every point in the elongation of each spring [-], shape (m, m).
    """

    stiffness: Array
    limit: Array
    place: Array
    shares: csr_array


class Grips(NamedTuple):
    """Friction of the points at a pose, in the axes of their faces, see `Potential.slip_rates`.

    Args:
        rates: of the slips for unit velocities, one matrix for each way, shape (m, n nv).
        drag: friction on the bodies of the points [N], shape (m, ways).
        stiffness: of the chord where a point slips [N/m], shape (m,).
        slips: whether a point slips, shape (m,).
        slider: how far the slider of each point has moved [m], shape (m, ways).
    """

    rates: tuple[csr_array, ...]
    drag: Array
    stiffness: Array
    slips: Flags
    slider: Array

    @property
    def held(self) -> Array:
        """Generalised force of the friction, shape (n nv,)."""
        return np.sum([rates.T @ drag for rates, drag in zip(self.rates, self.drag.T, strict=True)], axis=0)


def settled(potential: Potential) -> tuple[Array, Array]:
    """The pose in which the springs of contacts and ties carry weight and forces, and the friction there.

    Where nothing holds a direction, the bodies stay where they are.

    Returns:
        The pose, shape (n, nq), and the friction on the bodies of the points along the ways of `Potential.slip_rates`
        [N], shape (m, ways).

    Raises:
        UnsettledError: if no such pose is found near the undeformed one, or the bodies fall from it.
    """
    start = None
    for search in SEARCHES_FOR_REST:
        if search.resumes and start is None:
            continue
        try:
            pose, grips = searched(potential, search, start if search.resumes else None)
        except UnsettledError as error:
            unsettled = error
            continue
        if search.limited:
            pose, grips = left_falling(potential, search, (pose, grips))
            return pose.reshape(-1, potential.structure.places.freedom.nq), grips.drag
        start = pose
    raise unsettled


def held(potential: Potential) -> Array:
    """The pose of rest of bodies that friction holds without a limit, shape (n, nq), see `settled`."""
    pose, _ = left_falling(potential, SEARCH_WITHOUT_LIMIT, searched(potential, SEARCH_WITHOUT_LIMIT, None))
    return pose.reshape(-1, potential.structure.places.freedom.nq)


def left_falling(potential: Potential, search: Search, found: tuple[Array, Grips]) -> tuple[Array, Grips]:
    """The pose of rest to which bodies fall from one that was found, which is the same where they stand there.

    Raises:
        UnsettledError: if they stand nowhere near it.
    """
    for _ in range(PUSHES):
        pose, grips = found
        way = falling_way(potential, grips, pose)
        if way is None:
            return found
        found = searched(potential, search, let_go(potential, grips, pose, way))
    raise UnsettledError(found[0].reshape(-1, potential.structure.places.freedom.nq))


def searched(potential: Potential, search: Search, start: Array | None) -> tuple[Array, Grips]:
    """The pose of rest, shape (n nq,), and the friction there, by one of the searches.

    It starts from a pose, or with None from the undeformed one.

    Raises:
        UnsettledError: if there is none within its number of poses.
    """
    k, masses, freedom = potential.springs, potential.structure.masses, potential.structure.places.freedom
    size = np.sqrt(masses / np.repeat(masses[:: freedom.nv], freedom.nv))  # compares moments with forces
    loose, share, least, last = LOOSE, 1.0, SLIPPING, np.inf
    m, pose = len(potential.structure.places.k), potential.unmoved if start is None else start
    openings, slipped = potential.openings(pose), np.zeros((m, freedom.translations - 1))
    closed = touching(potential, pose) if start is None else potential.closed(openings)
    for tried in range(search.poses):
        rates, push = potential.rates(pose), potential.forces_at(openings)
        sliders = sliders_at(potential.structure.places, search, np.where(closed, push, -1.0)[:m], slipped)
        grips = grips_at(potential, pose, sliders)
        missing = (potential.load(pose) + rates.T @ push + grips.held) / size
        left, slipped = float(np.abs(missing).sum()), grips.slider if search.accumulates else slipped
        ends = left >= LITTLE_PROGRESS * last or tried == search.poses - 1
        if ends and np.abs(missing).max() < tolerance(potential):
            return pose, grips
        if left < last:
            loose, share = max(0.5 * loose, LEAST_LOOSE), max(0.5 * share, least)
        else:
            loose, share, least = 2 * loose, 1.0, min(RAISED * least, 1.0)
        last = left
        stiffness = sprung(rates, np.where(closed, k, LEANING * k)) + shear_stiffness(grips, share)
        scaled = times(1 / size, csr_array(stiffness))
        scaled.data *= (1 / size)[scaled.indices]
        lent = np.full(len(size), loose * float(scaled.diagonal().max()))
        motion = scipy.sparse.linalg.splu(csc_array(scaled + diags_array(lent))).solve(missing) / size
        pose = lowering(potential, pose, motion, sliders)
        openings = potential.openings(pose)
        closed = potential.closed(openings)
        if loose > MOST_LOOSE or not turned(pose, freedom).max() < ROTATION_OF_FALLEN:
            break
    raise UnsettledError(pose.reshape(-1, freedom.nq))


def sliders_at(contacts: Places, search: Search, push: Array, slipped: Array) -> Sliders:
    """Sliders at places [m], shape (m, ways), under forces of the contacts, negative where one is open [N], (m,)."""
    bonded, m = contacts.tension > 0, len(push)
    rubs = bonded | ((push >= 0) & (contacts.friction > 0))
    most = contacts.cohesion + shear_limit(Law(friction=contacts.friction), np.maximum(push, 0.0))
    limit = np.where(rubs, most if search.limited else np.inf, -np.inf)
    if search.limited:
        shares = csr_array((np.ones(rubs.sum()), np.flatnonzero(rubs), np.append(0, np.cumsum(rubs))), shape=(m, m))
    else:
        points = csr_array((rubs.astype(float), (contacts.joint, np.arange(m))))
        shares = csr_array(points.T @ times(1 / np.maximum(points.sum(axis=1), 1.0), points))
    return Sliders(search.shear * contacts.k, limit, slipped, shares)


def lowering(potential: Potential, pose: Array, motion: Array, sliders: Sliders) -> Array:
    """The pose after a motion, or after a part of it that does not raise the energy, see `energy_with`."""
    freedom, part, energy = potential.structure.places.freedom, 1.0, energy_with(sliders, potential, pose)
    highest = energy + max(ENERGY_ROUNDING * heaviest(potential), RAISES * abs(energy))
    while part > SMALLEST_PART and energy_with(sliders, potential, moved(pose, part * motion, freedom)) > highest:
        part *= 0.5
    return moved(pose, part * motion, freedom)


def energy_with(sliders: Sliders, potential: Potential, pose: Array) -> float:
    """Energy at a pose, with that of the sliders and the work that slipping further takes at a constant limit [J].

    The forces that are missing at a pose are those along which it falls.
    """
    stretch = np.linalg.norm(sliders.shares @ potential.slips(pose) - sliders.place, axis=1)
    elastic = np.minimum(stretch, np.maximum(sliders.limit, 0.0) / sliders.stiffness)
    return potential.energy(pose) + float((sliders.stiffness * elastic * (stretch - 0.5 * elastic)).sum())


def grips_at(potential: Potential, pose: Array, sliders: Sliders) -> Grips:
    """Friction at a pose of shape (n nq,)."""
    stretch = sliders.shares @ potential.slips(pose) - sliders.place
    held = sliders.stiffness * np.linalg.norm(stretch, axis=1)
    slips = held > sliders.limit
    stays = np.where(slips, np.maximum(sliders.limit, 0.0) / np.where(held > 0, held, 1.0), 1.0)
    stiffness, slider = stays * sliders.stiffness, sliders.place + (1 - stays)[:, None] * stretch
    rates = tuple(csr_array(sliders.shares @ rates) for rates in potential.slip_rates(pose))
    return Grips(rates, -stiffness[:, None] * stretch, stiffness, slips, slider)


def shear_stiffness(grips: Grips, share: float) -> csr_array:
    """Stiffness of the points along their faces, shape (n nv, n nv). Along its slip a point has a share of it."""
    rates, springs = list(grips.rates), [grips.stiffness for _ in grips.rates]
    slips = grips.slips & (grips.stiffness > 0)
    if slips.any():
        ways = (grips.drag[slips] / np.linalg.norm(grips.drag[slips], axis=1)[:, None]).T
        rates.append(sum(times(way, rate[slips]) for way, rate in zip(ways, grips.rates, strict=True)))
        springs.append((share - 1) * grips.stiffness[slips])
    return sprung(csr_array(vstack(rates)), np.concatenate(springs))


def falling_way(potential: Potential, grips: Grips, pose: Array) -> Array | None:
    """The motion that lowers the energy most from a pose at rest while its friction holds, or None where it stands.

    A contact that touches without force has no stiffness: a motion the other way opens it.
    """
    presses = (potential.pushes(pose) > tolerance(potential)) | potential.bonded
    bent = potential.curvature(pose)
    stiffness = potential.stiffness(pose, np.where(presses, potential.springs, 0.0))
    most = float(abs(bent).sum(axis=1).max())  # that the forces take from the stiffness
    lowest, way = lowest_mode(csr_array(stiffness + shear_stiffness(grips, 1.0) + bent), most)
    return way if lowest < -NEGLIGIBLE_STIFFNESS * float(abs(stiffness).max()) else None


def let_go(potential: Potential, grips: Grips, pose: Array, way: Array) -> Array:
    """The pose to which bodies fall along a way from a pose at which they balance, while its friction holds."""
    freedom, far = potential.structure.places.freedom, PUSH * float(potential.pressed(pose).max()) / np.abs(way).max()
    held, stiffness = way @ grips.held, way @ (shear_stiffness(grips, 1.0) @ way)

    def energy(far: float) -> float:
        return potential.energy(moved(pose, far * way, freedom)) - far * held + 0.5 * far * far * stiffness

    while energy(2 * far) < energy(far) and far * np.abs(way).max() < ROTATION_OF_FALLEN:
        far *= 2
    return moved(pose, far * way, freedom)


def touching(potential: Potential, pose: Array) -> Flags:
    """Springs that are closed at the start of a search, shape (m + t,): all contacts, and the ties that are taut."""
    contacts = np.arange(len(potential.springs)) < len(potential.structure.places.k)
    closed: Flags = contacts | (potential.openings(pose) < 0)
    return closed


def heaviest(potential: Potential) -> float:
    """Weight of the heaviest body [N]."""
    freedom = potential.structure.places.freedom
    return GRAVITY * float(potential.structure.masses[:: freedom.nv].max())


def tolerance(potential: Potential) -> float:
    """Force that may be missing at rest [N]."""
    ties = potential.structure.ties
    return max(FORCE_TOLERANCE * heaviest(potential), LENGTH_ROUNDING * float((ties.k * ties.reach).max(initial=0)))


def lowered(structure: Structure, pose: Array) -> Array:
    """A pose lowered until the springs of level ground carry the weight of all bodies, shape (n, nq).

    The bodies keep their rotations and their horizontal positions.
    """
    places, freedom = structure.places, structure.places.freedom
    up = freedom.translations - 1
    level = (places.face_body < 0) & (places.normal[:, up] > 1 - 1e-12)
    depth, k = -gaps(places, np.array(pose, dtype=float).reshape(1, -1))[0][level], places.k[level]
    order = np.argsort(-depth, kind="stable")  # the deepest points are loaded first
    depth, k = depth[order], k[order]
    # sum k_i max(0, depth_i - z) = m g + what presses down, for the points down to the i-th
    carries = GRAVITY * structure.masses[up :: freedom.nv].sum() - structure.forces.force[:, up].sum()
    levels = (np.cumsum(k * depth) - carries) / np.cumsum(k)
    z = levels[np.flatnonzero(levels >= np.append(depth[1:], -np.inf))[0]]
    return pose + z * (np.arange(freedom.nq) == up)
