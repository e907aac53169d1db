"""How many iterations MuJoCo's solver needs for contacts, by a trial in a pose: `solver_need`.

Each point of a contact is pressed at the place where the geoms land, in a copy of the model, also where they are apart,
and nothing else is. The copy steps with Newton's method, from two states that move in all of their joints. At each
state the solver of the model solves the same equations. Where it ends at its last iteration or finds other forces, it
has too few. The points keep their places on the bodies and their normals through the few steps of the trial. The steps
are made from the parts of MuJoCo's own, which neither reset a state nor print or log a warning.
"""

from __future__ import annotations

import copy
import math
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from .checks import Array
from .contact import PairContact, PairContacts
from .effective_mass import with_tangents
from .geoms import GeomPair
from .meeting import TOUCHING_AT_REST, Landing, Pose, state_alike
from .notes import LINE_SEARCHES, MOST_ITERATIONS, SolverNeed

STEPS = 40
"""Steps of a trial of the solver from each of its two starts."""
MOVING = 0.3
"""Largest speed of a joint at the start of a trial [m/s or rad/s]."""
TOLERANCE_OF_FORCES = 0.01
"""Largest difference of forces that count as equal, over the largest force [-]."""
LARGEST_ACCELERATION = 1e10
"""Acceleration beyond which a trial ends [m/s2 or rad/s2], that of MuJoCo's own check."""
POSITION = int(mujoco.mjtStage.mjSTAGE_POS)


ContactLanding = tuple[PairContact, Landing]
"""A contact, and where its geoms meet."""


def solver_need(pose: Pose, landed: Sequence[ContactLanding]) -> SolverNeed:
    """The iterations that contacts need of the solver of their model, by a trial in a pose.

    Where it does not converge, a tenth of the impratio is tried, and so on until half of the iterations are enough.
    """
    trial = SolverTrial(pose, landed)
    given = trial.iterations, trial.line_searches
    cap, searches = max(trial.iterations, MOST_ITERATIONS), max(trial.line_searches, LINE_SEARCHES)
    try:
        result = trial.run(cap, searches)
    except mujoco.FatalError:  # the memory of the model is too small for the contacts
        result = TrialResult()
    if not result.carried:
        return SolverNeed(*given, tried=False)
    if result.most < cap:
        return SolverNeed(*given) if result.enough else SolverNeed(max(2 * result.most, trial.iterations), searches)
    option = trial.model.opt
    full = float(option.impratio) if trial.contacts.has_friction else 1.0
    for power in range(math.ceil(math.log10(full)) - 1, -1, -1):
        option.impratio = 10.0**power
        turns = trial.run(cap, searches).most
        if 2 * turns <= cap:
            return SolverNeed(max(2 * turns, given[0]), searches, converges=False, impratio=10.0**power)
    return SolverNeed(*given, converges=False)


@dataclass
class TrialResult:
    """The result of a trial.

    Args:
        most: the most iterations of a step.
        enough: whether the iterations of the model find the same forces.
        carried: whether one of the contacts carried a force.
    """

    most: int = 0
    enough: bool = True
    carried: bool = False


@dataclass(frozen=True)
class PressedPoint:
    """A contact point that is pressed in a trial.

    Args:
        row: MuJoCo's contact, with its parameters and the direction in which the geoms part.
        bodies: the numbers of the two bodies.
        places: the point on each of them, in the frame of the body [m].
        apart: where the two points are from each other along the direction once the contact carries nothing [m].
    """

    row: mujoco.MjContact
    bodies: tuple[int, int]
    places: tuple[Array, Array]
    apart: float

    def add(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Add it to the contacts of a state."""
        first, second = (
            data.xpos[body] + data.xmat[body].reshape(3, 3) @ place
            for body, place in zip(self.bodies, self.places, strict=True)
        )
        self.row.dist = float((first - second) @ -self.row.frame[:3]) - self.apart
        fixed = [model.body_weldid[body] == 0 for body in self.bodies]
        self.row.pos = second if fixed[0] else first if fixed[1] else 0.5 * (first + second)
        mujoco.mj_addContact(model, data, self.row)


class SolverTrial:
    """A copy of a model in a pose, in which contacts are pressed.

    Attributes:
        model: the copy, with the options that the contacts need.
        contacts: the contacts that are tried.
        iterations, line_searches: the most that the model allows.
    """

    def __init__(self, pose: Pose, landed: Sequence[ContactLanding]) -> None:
        self.pose, self.model = pose, copy.copy(pose.model)
        self.contacts = contacts = PairContacts(tuple(contact for contact, _ in landed))
        option = self.model.opt
        self.iterations, self.line_searches = int(option.iterations), int(option.ls_iterations)
        option.timestep = contacts.contacts[0].timestep
        if contacts.has_friction:
            option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
            option.impratio = max(float(option.impratio), contacts.impratio, 1.0)
        self.pressed = [point for pair in _contacts_that_meet(pose.model, landed) for point in _points(pose, *pair)]
        self.named = np.sort([contact.ids for contact in contacts], axis=1)

    def run(self, cap: int, searches: int) -> TrialResult:
        """Step with at most `cap` iterations and `searches` line searches, and compare with the steps of the model."""
        result = TrialResult()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for speed in (MOVING, -MOVING):  # what parts from its contact in one of them meets it in the other
                data = state_alike(self.model, self.pose.data)
                data.qvel[:] = speed * np.cos(np.arange(self.model.nv))
                for _ in range(STEPS):
                    self._find_contacts(data)
                    fewer = self._forces(data, self.iterations, self.line_searches)
                    turns, exact = self._exact_solution(data, cap, searches)
                    if not np.abs(data.qacc).max(initial=0) < LARGEST_ACCELERATION:
                        break
                    result.most = max(result.most, turns)
                    result.enough &= _are_equal(fewer, exact)
                    result.carried |= self._carries_force(data)
                    mujoco.mj_Euler(self.model, data)
        return result

    def _exact_solution(self, data: mujoco.MjData, cap: int, searches: int) -> tuple[int, Array]:
        """Iterations of the model's solver, of `cap` with `searches` line searches, and forces of Newton's method [N].

        A solver that ends at its last iteration may only miss its tolerance. Half of the iterations, and so on, count
        then where they find the forces of Newton's method.
        """
        newton = int(mujoco.mjtSolver.mjSOL_NEWTON)
        self._forces(data, cap, searches)
        turns = int(data.solver_niter.max(initial=0))
        exact = self._forces(data, MOST_ITERATIONS, LINE_SEARCHES, newton)
        if turns == cap:
            while turns > 1 and _are_equal(self._forces(data, turns // 2, searches), exact):
                turns //= 2
            exact = self._forces(data, MOST_ITERATIONS, LINE_SEARCHES, newton)
        return turns, exact

    def _find_contacts(self, data: mujoco.MjData) -> None:
        """Compute a state with the points of the contacts that are tried in place of those that MuJoCo finds."""
        model = self.model
        mujoco.mj_fwdPosition(model, data)
        for contact in data.contact if data.ncon else ():
            if (np.sort(contact.geom) == self.named).all(axis=1).any():
                contact.exclude = 1
        for point in self.pressed:
            point.add(model, data)
        mujoco.mj_makeConstraint(model, data)
        mujoco.mj_island(model, data)
        mujoco.mj_projectConstraint(model, data)

    def _forces(self, data: mujoco.MjData, iterations: int, searches: int, solver: int | None = None) -> Array:
        """The forces that a solver, or that of the model, finds with a number of iterations and line searches [N]."""
        option = self.model.opt
        solver_before, option.solver = option.solver, option.solver if solver is None else solver
        option.iterations, option.ls_iterations = iterations, searches
        start = np.array(data.qacc_warmstart)
        mujoco.mj_forwardSkip(self.model, data, POSITION, 1)
        data.qacc_warmstart[:], option.solver = start, solver_before
        return np.array(data.efc_force)

    def _carries_force(self, data: mujoco.MjData) -> bool:
        """Whether one of the points carries a force."""
        rows = data.contact.efc_address[data.ncon - len(self.pressed) :] if self.pressed else np.zeros(0, int)
        return bool(np.any(data.efc_force[rows[rows >= 0]] > 0))


def _contacts_that_meet(model: mujoco.MjModel, landed: Sequence[ContactLanding]) -> Iterator[ContactLanding]:
    """The contacts that act together: those of geoms that touch, and of each geom that moves the nearest one."""
    nearest: dict[int, float] = {}
    for contact, landing in landed:
        for geom in contact.ids:
            if model.body_treeid[model.geom_bodyid[geom]] >= 0:
                nearest[geom] = min(landing.distance, nearest.get(geom, math.inf))
    for contact, landing in landed:
        reach = max(nearest.get(geom, 0.0) for geom in contact.ids)
        if landing.distance <= max(0.0, reach) + TOUCHING_AT_REST:
            yield contact, landing


def _points(pose: Pose, contact: PairContact, landing: Landing) -> Iterator[PressedPoint]:
    """The points of a contact, each as deep as its load presses it, or as a blow with the speed of the trial."""
    data, pair = pose.data, GeomPair(pose.model, contact.ids)
    depth = max(contact.depth, MOVING / contact.frequency)
    for ends in zip(landing.first, landing.second, strict=True):
        row = mujoco.MjContact()
        row.frame = with_tangents(-landing.away).ravel()
        row.solref, row.solimp, row.solreffriction = contact.solref, contact.solimp, contact.solreffriction
        row.friction, row.dim = np.maximum(contact.friction, mujoco.mjMINMU), contact.condim  # as MuJoCo does
        row.geom, row.geom1, row.geom2 = contact.ids, *contact.ids
        row.flex, row.elem, row.vert, row.efc_address = (-1, -1), (-1, -1), (-1, -1), -1
        places = [
            data.xmat[body].reshape(3, 3).T @ (end - data.xpos[body])
            for body, end in zip(pair.bodies, ends, strict=True)
        ]
        apart = float((ends[0] - ends[1]) @ landing.away)
        yield PressedPoint(row, pair.bodies, (places[0], places[1]), apart + depth)


def _are_equal(one: Array, other: Array) -> bool:
    """Whether the forces of two solutions of one state are equal to TOLERANCE_OF_FORCES."""
    largest = np.abs(other).max(initial=0)
    return bool(np.abs(one - other).max(initial=0) <= TOLERANCE_OF_FORCES * largest)
