"""Bodies at rest: a pose, and friction within its limit, at which the springs of contacts and ties carry the weight.

Contacts push only. Along the face each has a spring in series with a slider, which slips where the force of the spring
would exceed the limit of friction. The springs are those of the joints, or nearly rigid ones where joints stick
rigidly. Sliders may stand anywhere, so that many poses may be at rest. The search finds the one to which every spring
is loaded once, from the drawn pose: of all that need no slip it has the least energy in its springs. It depends
neither on the path of the search nor on rounding.

The search is Newton's method with steps of two kinds. An exact step follows the derivatives of all forces, and the
limit of friction grows with the pressure. It is taken, whole or in part, where less force is missing after it.
Otherwise a step is taken that lowers the energy at the present limits of friction. With the shear stiffness of slipping
contacts such steps converge safely and slowly; without it they converge fast or not at all. The share of it that is
kept is therefore halved from pose to pose, and is whole again when more force is missing than before.

A block that slips on both of its supports is dragged along by the one on which it presses more, and then presses on it
more. More force is missing until it no longer slips there. A search that makes no progress for some poses therefore
lets all contacts that slip slide without stiffness, whatever force is missing, as far as the energy falls.
"""

from __future__ import annotations

from contextlib import suppress
from typing import NamedTuple

import numpy as np
import scipy
from scipy.sparse import csr_array

from ..bars import Bar
from ..geometry.frames import SPACE
from ..geometry.graph import connected_parts
from ..geometry.kinematics import Places, gaps
from ..geometry.poses import moved, turned
from ..linear import is_clearly_stable, lowest_mode, solution
from ..problem.masonry.laws.joint_law import shear_limit
from ..quantities import GRAVITY, Array, Flags, Integers
from .pattern import PairPattern, Springs
from .potential import Potential, Structure

FORCE_TOLERANCE = 1e-9
"""Force that may be missing at rest, over the weight of the heaviest body [-]."""
DISPLACEMENT_ROUNDING = 16 * np.finfo(float).eps
"""Rounding of the displacements of bodies and of the lengths of ties, over these [-]."""
STIFFNESS_OF_OPEN = 1e-6
"""Stiffness of an open contact in the search for a direction, over that of a closed one [-]."""
ROTATION_OF_FALLEN, DISPLACEMENT_OF_FALLEN = 0.5, 1e2
"""Rotation [rad], and displacement in radii of inertia, beyond which a body no longer stands."""
NEGLIGIBLE_STIFFNESS = 1e-12
"""Negative stiffness that counts as rounding, over the largest [-]."""
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
IMPERFECTION = 1e-5
"""Forces on all bodies by which a structure is no longer its own mirror image, over the largest that is missing [-]."""
PUSH = 1e-2
"""First motion of a push off a pose at which the bodies balance and do not stand, over the deepest penetration [-]."""
ALIKE_ENERGY = 1e-3
"""Difference of energies up to which falls in the two senses of a direction are alike, over the energy that is lost,
and total momentum of the bodies that counts as none, over the sum of their magnitudes [-]."""
LITTLE_PROGRESS = 0.5
"""Share of the missing force that an exact step must make up for, and of that share a part of the step [-]."""
PARTS_OF_STEP, EXACT_STEPS = (1.0, 0.5, 0.25, 0.125, 0.0625), 30
"""Parts of an exact step that are tried in turn, and most exact steps from a pose."""
RIGID, RIGID_WITHOUT_LIMIT = 1e3, 1e4
"""Shear stiffness of contacts that stick rigidly, over their normal stiffness [-]: with the limit of friction, and
without one. More makes rounding of the slip a larger force than may be missing."""
SOFT_STARTS = 100.0, 0.01, 0.1
"""Shear stiffnesses, over the normal one, at which the pose is found from which a search starts that finds none from
the undeformed pose, in turn [-]: stiff springs slip more from pose to pose, as of blocks beside a rough wall."""
POSES = 300
"""Most poses of a search."""
SLIDES, STALLED, PROGRESS = 20, 40, 0.01
"""Poses in a row with no less force missing than before, from which on contacts that slip lend no stiffness, and after
which a search ends, and how much less that has to be, over it [-]. Other searches that find a pose have up to some 15
such poses in a row."""
MEMORY_OF_BLOCK, MEMORY_OF_LINE = {False: 30e3, True: 70e3}, {False: 4e3, True: 6e3}
"""Memory of set-up for each block and for each of its contact lines, in the plane and in space [bytes]. The factors of
the stiffness in the search for the pose of rest take the most. `scripts/measure/setup_cost.py` measures it."""


class UnsettledError(ValueError):
    """No pose of rest was found; `pose` is the last one that was tried, shape (n, nq)."""

    def __init__(self, pose: Array) -> None:
        super().__init__(
            "the bodies do not stand on their contacts: no pose was found in which the springs carry weight and "
            "forces. The valid range is that of stiffer contacts, or of loads and thrusts whose line of action with "
            "the weight runs nearer to the middle of the base"
        )
        self.pose = pose


class Search(NamedTuple):
    """What is sought.

    Args:
        shear: stiffness of the contacts along their faces [N/m], shape (m,).
        limited: whether friction has its limit. Without one the springs resist the mean slip of the points of a joint
            that touch: springs at every point would lock its rotation.
        bar: counts the poses that are tried.
    """

    shear: Array
    limited: bool
    bar: Bar


class LentStiffness(NamedTuple):
    """Stiffness that a search lends to motions at a pose, as at its beginning.

    Args:
        loose: to every motion, over the largest [-].
        share: share of its shear stiffness that a contact that slips lends along its slip [-].
        least_share: the least of it [-].
        missing: force that was missing at the pose before [N].
    """

    loose: float = LOOSE
    share: float = 1.0
    least_share: float = SLIPPING
    missing: float = np.inf

    def at_next(self, missing: float, *, slides: bool) -> LentStiffness:
        """That at the next pose, where a force is missing [N]; with `slides` contacts that slip lend none."""
        if slides:
            return LentStiffness(LOOSE, 0.0, 0.0, missing)
        if missing < self.missing:
            loose, share = max(0.5 * self.loose, LEAST_LOOSE), max(0.5 * self.share, self.least_share)
            return LentStiffness(loose, share, self.least_share, missing)
        return LentStiffness(2 * self.loose, 1.0, min(RAISED * self.least_share, 1.0), missing)


class Sliders(NamedTuple):
    """Springs of the contacts along their faces, each in series with a slider that has a limit of friction.

    Args:
        stiffness: of the springs [N/m], shape (m,).
        limit: friction that each contact can have, negative for one that is open or smooth [N], shape (m,).
        rubs: which contacts have friction, shape (m,).
        joint: number of the joint of each, whose points share their slip, shape (m,), or None where none do.
    """

    stiffness: Array
    limit: Array
    rubs: Flags
    joint: Integers | None = None

    def shared(self, values: Array) -> Array:
        """Of values of all points those that the springs have: their own or the mean of their joint, zero where a point
        does not rub, shape (m, ...)."""
        rubs = self.rubs.reshape(-1, *[1] * (values.ndim - 1))
        if self.joint is None:
            return np.where(rubs, values, 0.0)
        means = np.zeros_like(values)
        share = 1 / np.maximum(np.bincount(self.joint, self.rubs), 1.0)[self.joint].reshape(rubs.shape)
        np.add.at(means, self.joint, np.where(rubs, share * values, 0.0))
        return np.where(rubs, means[self.joint], 0.0)


class PointFriction(NamedTuple):
    """Friction of the points at a pose, in the axes of their faces, see `Potential.slip_rates`.

    Args:
        pattern: of the stiffness.
        rates: of the slips for unit velocities of the two bodies, shape (directions, m, 2, nv).
        force: friction on the bodies of the points [N], shape (m, directions).
        stiffness: of the springs, and where a point slips its friction over its slip [N/m], shape (m,).
        slips: whether a point slips, shape (m,).
    """

    pattern: PairPattern
    rates: Array
    force: Array
    stiffness: Array
    slips: Flags

    @property
    def generalised(self) -> Array:
        """Generalised force of the friction, shape (n nv,)."""
        return np.sum([*map(self.pattern.forces, self.rates, self.force.T)], axis=0)

    @property
    def slipping(self) -> Flags:
        """Which points slip and have friction, shape (m,)."""
        return np.asarray(self.slips & (self.stiffness > 0))

    def along(self, slips: Flags) -> Array:
        """Rates of slip along the direction of friction, of the points that slip, shape (points, 2, nv)."""
        directions = (self.force[slips] / np.linalg.norm(self.force[slips], axis=1)[:, None]).T
        return np.asarray((directions[..., None, None] * self.rates[:, slips]).sum(axis=0))


class Trial(NamedTuple):
    """A pose that is tried, and the forces there.

    Args:
        pose: shape (n nq,).
        closed: which springs act, shape (m + t,).
        springs: their stiffness [N/m], shape (m + t,).
        rates: of their openings for unit velocities of the two bodies, shape (m + t, 2, nv).
        push: force of each [N], shape (m + t,).
        sliders, friction: the friction.
        missing: generalised force that is missing, moments over the size of the body [N], shape (n nv,).
    """

    pose: Array
    closed: Flags
    springs: Array
    rates: Array
    push: Array
    sliders: Sliders
    friction: PointFriction
    missing: Array

    @property
    def missing_sum(self) -> float:
        """Sum of the forces that are missing [N]."""
        return float(np.abs(self.missing).sum())


class RestState(NamedTuple):
    """A pose of rest, and the friction there.

    Args:
        pose: shape (n, nq).
        friction: on the bodies of the points along the tangential directions of `Potential.slip_rates` [N], shape
            (m, directions).
    """

    pose: Array
    friction: Array


def settled(potential: Potential, k_s: Array) -> RestState:
    """The pose in which the springs of contacts and ties carry weight and forces, and the friction there.

    Where nothing holds a direction, the bodies stay where they are.

    Args:
        potential: of the bodies.
        k_s: stiffness of the contacts along their faces [N/m], infinite where they stick rigidly, shape (m,).

    Raises:
        UnsettledError: if no such pose is found near the undeformed one, or the bodies fall from it.
    """
    k = potential.structure.places.k
    *starts, last = (None, *SOFT_STARTS)
    with shown_search(potential) as bar:
        search = Search(np.where(np.isfinite(k_s), k_s, RIGID * k), limited=True, bar=bar)
        for soft in starts:
            with suppress(UnsettledError):
                return search_from(potential, search, soft)
        return search_from(potential, search, last)


def memory_of(blocks: int, lines: int, *, in_space: bool) -> float:
    """Memory that set-up of some free blocks with some contact lines takes [bytes], estimated."""
    return blocks * MEMORY_OF_BLOCK[in_space] + lines * MEMORY_OF_LINE[in_space]


def shown_search(potential: Potential) -> Bar:
    """A bar of the poses that a search has tried, with the memory that it needs."""
    places, masses = potential.structure.places, potential.structure.masses
    in_space = places.freedom == SPACE
    needed = memory_of(len(masses) // places.freedom.nv, len(places.k), in_space=in_space)
    return Bar(f"pose of rest, about {needed / 1e9:.2g} GB", "poses")


def search_from(potential: Potential, search: Search, soft: float | None) -> RestState:
    """What `settled` returns, by a search from the undeformed pose, or from the pose of rest on springs of another
    shear stiffness: `soft` times the normal stiffness [-]."""
    k, freedom = potential.structure.places.k, potential.structure.places.freedom
    start = None if soft is None else search_pose(potential, search._replace(shear=soft * k))[0]
    pose, friction = search_pose(potential, search, start)
    return RestState(pose.reshape(-1, freedom.nq), friction.force)


def settled_without_slip(potential: Potential) -> Array:
    """The pose of rest if friction had no limit, shape (n, nq), see `settled`."""
    with shown_search(potential) as bar:
        pose, _ = search_pose(potential, Search(RIGID_WITHOUT_LIMIT * potential.structure.places.k, False, bar))
    return pose.reshape(-1, potential.structure.places.freedom.nq)


def search_pose(potential: Potential, search: Search, start: Array | None = None) -> tuple[Array, PointFriction]:
    """The pose of rest, shape (n nq,), and the friction there.

    The search starts from a pose, or with None from the undeformed one, at which all contacts touch. Bodies that
    balance at a pose and do not stand there are pushed off it, and the search goes on where energy falls.

    Raises:
        UnsettledError: if there is none within the number of poses.
    """
    freedom, lent = potential.structure.places.freedom, LentStiffness()
    least_missing, since = np.inf, 0  # the least force that has been missing, and at which pose it was
    trial, pushed = trial_at(potential, search, potential.unmoved if start is None else start, start is None), False
    for poses in range(POSES):
        ending = trial if start is None and not poses else after_exact_steps(potential, search, trial)
        if balances(potential, search, ending):
            direction = falling_direction(potential, search, ending)
            if direction is None:
                return ending.pose, ending.friction
            if not pushed or balances(potential, search, trial):
                trial, pushed = trial_at(potential, search, fallen_pose(potential, ending, direction)), True
                lent, least_missing, since = LentStiffness(), np.inf, poses
        if trial.missing_sum < (1 - PROGRESS) * least_missing:
            least_missing, since = trial.missing_sum, poses
        lent = lent.at_next(trial.missing_sum, slides=poses - since >= SLIDES)
        springs = np.where(trial.closed, trial.springs, STIFFNESS_OF_OPEN * trial.springs)
        stiffness = normal_stiffness(potential, trial, springs) + shear_stiffness(trial.friction, lent.share)
        motion = newton_motion(potential, stiffness, trial.missing + imperfection(potential, trial), lent.loose)
        trial = trial_at(potential, search, lowering_step(potential, trial.pose, motion, trial.sliders))
        if lent.loose > MOST_LOOSE or poses - since >= STALLED or has_fallen(potential, trial.pose):
            break
    raise UnsettledError(trial.pose.reshape(-1, freedom.nq))


def has_fallen(potential: Potential, pose: Array) -> bool:
    """Whether a body has turned too far to stand, or has moved away."""
    freedom = potential.structure.places.freedom
    moved_by = np.abs(pose.reshape(-1, freedom.nq)[:, : freedom.translations]).max(axis=1)
    radii = sizes(potential).reshape(-1, freedom.nv)[:, -1]
    return not (turned(pose, freedom).max() < ROTATION_OF_FALLEN and np.all(moved_by < DISPLACEMENT_OF_FALLEN * radii))


def imperfection(potential: Potential, trial: Trial) -> Array:
    """Small forces towards positive x, and half of them along y, on all bodies that friction connects with the ground.

    Steps that are not exact are taken with them. A structure that is its own mirror image falls to that side if it
    falls, whatever the rounding is.
    """
    places, freedom = potential.structure.places, potential.structure.places.freedom
    count, rough = len(trial.missing) // freedom.nv, trial.sliders.limit > 0
    pairs = np.column_stack([places.body[rough], places.face_body[rough] % (count + 1)])  # the ground is the last
    group = connected_parts(pairs, count + 1)
    forces = np.zeros((count, freedom.nv))
    forces[group[:-1] == group[-1], : freedom.translations - 1] = [1.0, 0.5][: freedom.translations - 1]
    return IMPERFECTION * float(np.abs(trial.missing).max()) * forces.ravel()


def balances(potential: Potential, search: Search, trial: Trial) -> bool:
    """Whether no force is missing at a pose."""
    return bool(np.abs(trial.missing).max() < tolerance(potential, trial.pose, search))


def after_exact_steps(potential: Potential, search: Search, trial: Trial) -> Trial:
    """The pose after as many exact steps, whole or in part, as each leave less force missing."""
    for _ in range(EXACT_STEPS):
        better = exact_step(potential, search, trial)
        if better is None:
            break
        trial = better
    return trial


def exact_step(potential: Potential, search: Search, trial: Trial) -> Trial | None:
    """The pose after a step by the derivatives of all forces, or after a part of it; None if more force is missing
    after every part. Where far more is missing after a step, no smaller parts are tried."""
    motion = newton_motion(potential, stiffness_at(potential, search, trial), trial.missing, LEAST_LOOSE)
    for part in PARTS_OF_STEP[:1] if balances(potential, search, trial) else PARTS_OF_STEP:
        step = trial_at(potential, search, moved(trial.pose, part * motion, potential.structure.places.freedom))
        if step.missing_sum < (1 - LITTLE_PROGRESS * part) * trial.missing_sum:
            return step
        if step.missing_sum > LITTLE_PROGRESS * part / PARTS_OF_STEP[-1] * trial.missing_sum:
            break
    return None


def trial_at(potential: Potential, search: Search, pose: Array, touches: bool = False) -> Trial:
    """The forces at a pose of shape (n nq,); where the search starts, all contacts touch."""
    search.bar.add()
    openings, rates = potential.openings(pose), potential.pair_rates(pose)
    closed = touching(potential, pose) if touches else potential.closed(openings)
    push = potential.forces_at(openings)
    sliders = sliders_at(potential.structure.places, search, np.where(closed, push, -1.0)[: len(search.shear)])
    friction = friction_at(potential, pose, sliders)
    missing = (potential.load(pose) + potential.pattern.forces(rates, push) + friction.generalised) / sizes(potential)
    return Trial(pose, closed, potential.springs_at(openings), rates, push, sliders, friction, missing)


def stiffness_at(potential: Potential, search: Search, trial: Trial) -> Array:
    """Derivative of the missing force along a motion, entries of the pattern: the limit of friction grows with the
    pressure too."""
    places, slipping, m = potential.structure.places, trial.friction.slipping, len(search.shear)
    # open contacts have next to none: more of it would hide that open joints let go of a structure that stands on few
    springs = np.where(trial.closed, trial.springs, LEAST_LOOSE * trial.springs)
    stiffness = normal_stiffness(potential, trial, springs) + potential.pattern.entries_of(curvature(potential, trial))
    stiffness += shear_stiffness(trial.friction, 0.0)
    if not slipping.any():
        return stiffness
    pressed = (trial.push[:m] > 0)[slipping]
    rises = np.where(pressed, shear_limit(places.law, trial.springs[:m])[slipping], 0.0)  # with depth [N/m]
    lengths = rises[:, None, None] * trial.rates[:m][slipping]
    points, unit = np.flatnonzero(slipping), np.ones(len(rises))
    return stiffness + potential.pattern.stiffness_of(Springs(trial.friction.along(slipping), lengths, unit, points))


def normal_stiffness(potential: Potential, trial: Trial, springs: Array) -> Array:
    """Stiffness of springs of contacts and ties [N/m], shape (m + t,), entries of the pattern."""
    return potential.pattern.stiffness_of(Springs(trial.rates, trial.rates, springs, slice(None)))


def curvature(potential: Potential, trial: Trial) -> csr_array:
    """Geometric stiffness of all forces at a pose, shape (n nv, n nv)."""
    return potential.curvature(trial.pose, trial.sliders.shared(trial.friction.force), trial.push)


def newton_motion(potential: Potential, stiffness: Array, missing: Array, loose: float) -> Array:
    """The motion that makes up for forces that are missing, shape (n nv,).

    Args:
        potential: of the bodies.
        stiffness: entries of the pattern.
        missing: shape (n nv,).
        loose: stiffness that is added to the whole diagonal, over the largest there [-].
    """
    size, pattern = sizes(potential), potential.pattern
    scaled = stiffness * (1 / size)[pattern.indices] * np.repeat(1 / size, np.diff(pattern.indptr))
    scaled[pattern.diagonal] += loose * float(np.abs(scaled[pattern.diagonal]).max())
    matrix = pattern.matrix(scaled).copy()
    matrix.eliminate_zeros()
    return solution(matrix, missing) / size


def sizes(potential: Potential) -> Array:
    """Lengths by which moments are divided to compare them with forces: 1 for a force, and the radius of inertia [m]
    for a moment, shape (n nv,)."""
    masses, nv = potential.structure.masses, potential.structure.places.freedom.nv
    return np.asarray(np.sqrt(masses / np.repeat(masses[::nv], nv)))


def sliders_at(contacts: Places, search: Search, push: Array) -> Sliders:
    """Sliders under forces of the contacts, negative where one is open [N], shape (m,)."""
    rubs = (contacts.tension > 0) | ((push >= 0) & (contacts.friction > 0))
    friction_limit = contacts.cohesion + shear_limit(contacts.law, np.maximum(push, 0.0))
    limit = np.where(rubs, friction_limit if search.limited else np.inf, -np.inf)
    return Sliders(search.shear, limit, rubs, None if search.limited else contacts.joint)


def lowering_step(potential: Potential, pose: Array, motion: Array, sliders: Sliders) -> Array:
    """The pose after a motion, or after a part of it that does not raise the energy, see `energy_with`."""
    freedom, part, energy = potential.structure.places.freedom, 1.0, energy_with(sliders, potential, pose)
    highest = energy + max(ENERGY_ROUNDING * heaviest(potential), RAISES * abs(energy))
    while part > SMALLEST_PART and energy_with(sliders, potential, moved(pose, part * motion, freedom)) > highest:
        part *= 0.5
    return moved(pose, part * motion, freedom)


def energy_with(sliders: Sliders, potential: Potential, pose: Array) -> float:
    """Energy at a pose, with that of the springs along the faces and the work of slip at the present limits [J].

    Its negative gradient is the force that is missing.
    """
    stretch = np.linalg.norm(sliders.shared(potential.slips(pose)), axis=1)
    elastic = np.minimum(stretch, np.maximum(sliders.limit, 0.0) / sliders.stiffness)
    return potential.energy(pose) + float((sliders.stiffness * elastic * (stretch - 0.5 * elastic)).sum())


def friction_at(potential: Potential, pose: Array, sliders: Sliders) -> PointFriction:
    """Friction at a pose of shape (n nq,)."""
    stretch = sliders.shared(potential.slips(pose))
    elastic = sliders.stiffness * np.linalg.norm(stretch, axis=1)
    slips = elastic > sliders.limit
    stays = np.where(slips, np.maximum(sliders.limit, 0.0) / np.where(elastic > 0, elastic, 1.0), 1.0)
    stiffness = stays * sliders.stiffness
    rates = potential.pair_slip_rates(pose)
    if sliders.joint is not None:  # the body of a point may be either of a joint
        places = potential.structure.places
        turned_round = (places.body < places.face_body)[:, None, None]
        rates = np.array([sliders.shared(np.where(turned_round, along[:, ::-1], along)) for along in rates])
        rates = np.where(turned_round, rates[:, :, ::-1], rates)
    return PointFriction(potential.pattern, rates, -stiffness[:, None] * stretch, stiffness, slips)


def shear_stiffness(friction: PointFriction, share: float) -> Array:
    """Stiffness of the points along their faces, entries of the pattern. Along its slip a point has a share of it."""
    groups = [Springs(rates, rates, friction.stiffness, slice(len(rates))) for rates in friction.rates]
    if (slipping := friction.slipping).any():
        along = friction.along(slipping)
        change = (share - 1) * friction.stiffness[slipping]
        groups.append(Springs(along, along, change, np.flatnonzero(slipping)))
    return friction.pattern.stiffness_of(*groups)


def falling_direction(potential: Potential, search: Search, trial: Trial) -> Array | None:
    """The motion from a pose of balance along which the energy falls most steeply with friction as it is; None where it
    rises along all, so that the bodies stand.

    A contact that touches without force has no stiffness: the opposite motion opens it.
    """
    presses = (trial.push > tolerance(potential, trial.pose, search)) | potential.bonded
    geometric = curvature(potential, trial)
    stiffness = normal_stiffness(potential, trial, np.where(presses, trial.springs, 0.0))
    softening = float(abs(geometric).sum(axis=1).max())  # that the forces take from the stiffness
    total = stiffness + shear_stiffness(trial.friction, 1.0) + potential.pattern.entries_of(geometric)
    matrix = potential.pattern.matrix(total)
    if is_clearly_stable(matrix):
        return None
    lowest, direction = lowest_mode(matrix, softening)
    return direction if lowest < -NEGLIGIBLE_STIFFNESS * float(np.abs(stiffness).max()) else None


def fallen_pose(potential: Potential, trial: Trial, direction: Array) -> Array:
    """The pose of least energy to which bodies fall along a direction from a pose at which they balance, with the
    friction there. Of the two senses of the direction the one with the lower energy is taken, and forwards where both
    are alike, as in a structure that is its own mirror image."""
    freedom, direction = potential.structure.places.freedom, forwards(potential, direction)
    first = PUSH * float(potential.pressed(trial.pose).max()) / np.abs(direction).max()
    of_friction = csr_array(potential.pattern.matrix(shear_stiffness(trial.friction, 1.0)))
    of_friction = of_friction + curvature(potential, trial) - potential.curvature(trial.pose)
    friction, stiffness = direction @ trial.friction.generalised, direction @ (of_friction @ direction)

    def energy(distance: float) -> float:
        return (
            potential.energy(moved(trial.pose, distance * direction, freedom))
            - distance * friction
            + 0.5 * distance * distance * stiffness
        )

    def lowest_along(distance: float) -> float:
        while energy(2 * distance) < energy(distance) and abs(distance) * np.abs(direction).max() < ROTATION_OF_FALLEN:
            distance *= 2
        lowest = scipy.optimize.minimize_scalar(lambda part: energy(part * distance), bounds=(1, 2), method="bounded")
        return distance * float(lowest.x)

    ahead, behind = lowest_along(first), lowest_along(-first)
    lower = energy(ahead) - energy(behind)
    alike = max(ENERGY_ROUNDING * heaviest(potential), ALIKE_ENERGY * (energy(0.0) - energy(ahead)))
    return moved(trial.pose, (ahead if lower < alike else behind) * direction, freedom)


def forwards(potential: Potential, direction: Array) -> Array:
    """A direction or its opposite: that in which the total momentum is positive along the axis x, y or z along which it
    is largest. It does not depend on the order of the bodies."""
    masses, freedom = potential.structure.masses, potential.structure.places.freedom
    momenta = (masses * direction).reshape(-1, freedom.nv)[:, : freedom.translations]
    total = momenta.sum(axis=0)
    largest = total[np.argmax(np.abs(total))]
    return -direction if largest < -ALIKE_ENERGY * np.abs(momenta).sum() else direction


def touching(potential: Potential, pose: Array) -> Flags:
    """Springs that are closed at the start of a search, shape (m + t,): all contacts, and the ties that are taut."""
    contacts = np.arange(len(potential.springs)) < len(potential.structure.places.k)
    closed: Flags = contacts | (potential.openings(pose) < 0)
    return closed


def heaviest(potential: Potential) -> float:
    """Weight of the heaviest body [N]."""
    freedom = potential.structure.places.freedom
    return GRAVITY * float(potential.structure.masses[:: freedom.nv].max())


def tolerance(potential: Potential, pose: Array, search: Search) -> float:
    """Force that may be missing at rest [N]: a share of the weight, or what the springs round to."""
    places, ties = potential.structure.places, potential.structure.ties
    size = np.abs(places.at).max(initial=0.0)
    moves = np.abs((pose - potential.unmoved).reshape(-1, places.freedom.nq)[:, : places.freedom.translations]).max()
    moves = min(moves + turned(pose, places.freedom).max() * size, size)
    stiffest = max(places.k.max(initial=0.0), search.shear.max(initial=0.0))
    rounding = DISPLACEMENT_ROUNDING * max(stiffest * moves, (ties.k * ties.reach).max(initial=0.0))
    return float(max(FORCE_TOLERANCE * heaviest(potential), rounding))


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
