"""Run: a case as a plain model, stepped by MuJoCo, as a `Response`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np

from ...geometry.frames import PLANE
from ...problem.masonry.case import AnyCase
from ...quantities import Array, require_sample_count, require_size, warn_of
from ...result.bodies import BodyMotion
from ...result.ending import Outcome, Stopwatch
from ...result.forces import Forces, KeptForces, forces_of
from ...result.ledger import Ledger, StepError, warn_if_open
from ...result.motion import SampledMotion, whole_steps
from ...result.problem import Problem, require_in_text
from ...result.reading import ContactHistory
from ...result.response import End, Response, State
from ...result.ties import Plastic, motion_of_ties, plastic_of, ties_message, warn_of_ties
from ...scene.course import Course
from ...scene.dampers import damping_rate
from ...scene.potential import energies
from ...scene.scene import Scene
from ..mjcf import Keyframe
from ..model import SimulationError, set_release
from ..options import SPACING, Options
from ..run_warnings import require_for_mujoco, warn_if_plain_is_slow, warn_if_sheared
from .follow import JointForces, PlainEngine, Sample, Work, follow
from .pairs import Pairs
from .pieces import Piece, pieces_of
from .text import plain_text

RESOLVED, RESOLVED_OF_MANY = 0.1, 0.5
"""omega h of the step that is taken by default, omega the highest frequency of the closed contacts, of one body and of
several [-] (`scripts/studies/plain_models.py`, `scripts/studies/plain_masonry.py`)."""
RESOLVED_DAMPERS, STABLE_DAMPERS = 0.02, 0.5
"""Step over the time m / C in which the strongest damper stops the body that it acts on: with the first that time is
exact to 1 %, and up to the second the step is stable with any contacts [-]. MuJoCo's tendons damp the velocity half a
step before the pose."""
SHORTER_FOR_DAMPERS = 0.1
"""Least share of the step of the contacts to which dampers shorten it so that they are resolved [-]."""
UNPAID_OF_PLAIN = 0.01
"""Energy without an account, over the largest part of the ledger, above which there is a warning [-]."""
NOTABLE_OVERLAP = 0.01
"""Volume that two solids have in common, over that of the smaller one, above which there is a warning [-]."""
OVERLAPS_COMPUTED = 10
"""Of how many of the deepest contacts the common volume is computed."""


@dataclass(frozen=True, eq=False)
class PlainModel:
    """A case as a plain model.

    Args:
        problem, scene, course: the problem, the structure, and what happens to it.
    """

    problem: Problem
    scene: Scene
    course: Course

    @cached_property
    def pieces(self) -> list[Piece]:
        """The solids."""
        return pieces_of(self.scene)

    @cached_property
    def pairs(self) -> Pairs:
        """The law of their contacts."""
        return Pairs.in_scene(self.scene, self.pieces)

    @property
    def start(self) -> tuple[Array, Array]:
        """Positions and velocities of the release as MuJoCo has them: fixed blocks that are moved come first."""
        pose, supports = self.course.pose.copy(), self.problem.case.supports
        if self.scene.freedom != PLANE:
            pose[:, :3] += self.scene.bodies.rest
        standstill = np.zeros(3 * len(supports))
        return np.append(standstill, pose), np.append(standstill, self.course.velocity)

    def text(self, timestep: float, keyframe: Keyframe | None = None) -> str:
        """The model text at a step [s]; without a keyframe its velocities are those of the release."""
        moved = tuple(support.block for support in self.problem.case.supports)
        key = Keyframe(*self.start, np.empty(0)) if keyframe is None else keyframe
        return plain_text(self.scene, self.pieces, self.pairs, timestep, key, moved)

    def engine(self, timestep: float) -> PlainEngine:
        """The compiled model at its release."""
        model = mujoco.MjModel.from_xml_string(self.text(timestep))
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET  # what breaks down ends the run
        data = mujoco.MjData(model)
        set_release(model, data, *self.start)
        return PlainEngine(model, data, self.scene, self.pieces, self.pairs, self.problem.case.supports)

    def released_text(self, timestep: float) -> str:
        """The model text whose keyframe has the velocities half a step before the release."""
        data = self.engine(timestep).data
        return self.text(timestep, Keyframe(data.qpos, data.qvel, data.plastic))


@dataclass(frozen=True, eq=False)
class PlainRun:
    """A run of a plain model.

    Args:
        model: the model.
        at: all samples, one after the other.
    """

    model: PlainModel
    at: Sample

    @classmethod
    def of_samples(cls, model: PlainModel, samples: list[Sample]) -> PlainRun:
        """The run that went through some samples."""
        parts = dict(zip(Sample._fields, zip(*samples, strict=True), strict=True))
        work = Work(*map(np.array, zip(*parts.pop("work"), strict=True)))
        deepest = [overlap for overlaps in parts.pop("deepest") for overlap in overlaps]
        arrays = {name: np.array(part) for name, part in parts.items()}
        return cls(model, Sample(work=work, deepest=deepest, **arrays))

    @cached_property
    def stored(self) -> tuple[Array, Array]:
        """Kinetic, potential and elastic energy [J], shape (n, 3), and what ties have taken [J], shape (n, ties)."""
        scene, at, flat = self.model.scene, self.at, (len(self.at.t), -1)
        without = scene.structure._replace(places=scene.places._replace(law=np.zeros_like(scene.places.law)))
        parts, taken = energies(without, at.pose.reshape(flat), at.velocity.reshape(flat))
        parts[:, 2] += at.elastic.sum(axis=1)
        return parts, taken

    @cached_property
    def energy(self) -> Array:
        """Energy above the scene at rest [J], shape (n,): that of the start, and what has been added since."""
        total = self.stored[0].sum(axis=1)
        return np.asarray(total - total[0] + self.model.course.energy(self.model.scene))

    def ledger(self) -> Ledger:
        """Where the energy is, and what took it."""
        (parts, taken), at, work, scene = self.stored, self.at, self.at.work, self.model.scene
        lost = -(work.pressed - work.pressed[0]) - (at.elastic - at.elastic[0])
        groups = (*scene.contacts.joints, "encounters")
        of_joint = self.model.pairs.of_joint
        dashpots = {name: lost[:, of_joint == i].sum(axis=1) for i, name in enumerate(groups)}
        if len(scene.bodies.names) == 1 and not self.model.problem.case.joints:
            dashpots.pop("encounters")
        damped = dict(zip(scene.links.damped.names, (work.damped - work.damped[0]).T, strict=True))
        return Ledger(
            t=at.t,
            kinetic=parts[:, 0],
            potential=parts[:, 1],
            elastic=parts[:, 2],
            dashpots=dashpots | damped,
            friction=work.rubbed[0] - work.rubbed,
            ground=work.ground - work.ground[0],
            ties=dict(zip(scene.links.sprung.names, (taken - taken[0]).T, strict=True)),
        )

    @cached_property
    def overlap(self) -> tuple[float, str]:
        """The largest volume that two solids have in common, over that of the smaller one [-], and where, in words."""
        deepest = sorted(self.at.deepest, key=lambda overlap: -overlap.depth)[:OVERLAPS_COMPUTED]
        shares = [(overlap.share, overlap) for overlap in deepest]
        if not shares:
            return 0.0, ""
        share, worst = max(shares, key=lambda pair: pair[0])
        names = " and ".join(piece.name for piece in worst.pieces)
        return share, f"{names} lie inside each other by {share:.1%} at {worst.t:.4g} s"

    def plastic(self) -> dict[str, Plastic]:
        """How far each tie has yielded."""
        energy, strength = self.stored[1][-1], self.model.scene.links.sprung.law["strength"]
        return plastic_of(self.model.scene, elongation=energy / strength, energy=energy)

    def forces(self, plastic: dict[str, Plastic]) -> Forces:
        """The forces of joints, links and fixed blocks."""
        case, links, at = self.model.problem.case, self.model.scene.links, self.at
        ties = motion_of_ties(BodyMotion(case, at.t, at.pose), plastic)
        of_links = {name: ties[name].force for name in links.sprung.names}
        of_links |= dict(zip(links.damped.names, at.damper_forces.T, strict=True))
        kept = KeptForces(t=at.t, pose=at.pose, loads=at.loads, contact_reactions=at.contact_reactions, links=of_links)
        return forces_of(case, case.rest_geometry.frames, kept)


def simulate_plain(problem: Problem, options: Options, state: State | None) -> Response:
    """`simulate` with collisions, from a state that takes the place of the release where one is given.

    Raises:
        ValueError: for more steps or samples than fit into memory, or what no plain model has.
        SimulationError: if MuJoCo warns or the state is not finite.
    """
    case = problem.case
    require_plain(case)
    spacing = options.output_step or min(SPACING, case.duration)
    scene = problem.scene()
    warn_if_sheared(scene)
    course = problem.course(scene)
    if state is not None:
        course = course.continued(*state)
    h = options.timestep or plain_timestep(scene, spacing)
    require_size("the steps of this run", case.duration / h, "take a longer timestep")
    require_sample_count(len(scene.bodies.names) * case.duration / spacing)
    warn_if_plain_is_slow(scene, course.duration, h)
    model, watch = PlainModel(problem, scene, course), Stopwatch()
    frames = case.rest_geometry.frames
    joints = JointForces(model.pairs.of_joint, frames.above, {name: i for i, name in enumerate(frames.blocks)})
    steps, stride = max(1, round(course.duration / h)), whole_steps(spacing, h)
    try:
        samples = follow(model.engine(h), course, steps, stride, joints if options.forces else None)
    except StepError as error:
        raise SimulationError(f"{error} at t = {error.t:.4g} s with a step of {h:.3g} s; halve the step") from None
    stats = {"steps": steps, "timestep": h, "resolved": h * scene.highest_frequency, **watch.stepping()}
    response = response_of_plain(PlainRun.of_samples(model, samples), stats, options)
    if response.outcome is not Outcome.OVERTURNED:
        warn_of_ties(case, response.plastic)
    return response


def plain_timestep(scene: Scene, spacing: float) -> float:
    """The default step of a plain model, a whole share of the spacing of the samples [s]."""
    resolved = RESOLVED if len(scene.bodies.names) == 1 else RESOLVED_OF_MANY
    decay = damping_rate(scene.dampers, scene.potential.unmoved, scene.bodies.principal)
    shorter = min(
        decay / RESOLVED_DAMPERS,
        max(scene.highest_frequency / (SHORTER_FOR_DAMPERS * resolved), decay / STABLE_DAMPERS),
    )
    return spacing / math.ceil(spacing * max(scene.highest_frequency / resolved, shorter))


def require_plain(case: AnyCase) -> None:
    """Raise a ValueError for what no plain model has: bonds, effects of explicit steps, ties that break or that are
    anchored on supports that move."""
    require_for_mujoco(case)
    require_in_text(case)
    moved = {support.block for support in case.supports}
    for name, link in case.links.items():
        if link.anchor_block is not None and case.blocks[link.anchor_block] in moved:
            raise ValueError(
                f"{name} is anchored on a support that moves, which a plain model has not; take solve_explicit"
            )


def response_of_plain(run: PlainRun, settings: dict[str, float], options: Options) -> Response:
    """The response of a run."""
    model, at, motion = run.model, run.at, SampledMotion(run.at.pose, run.at.velocity, run.energy)
    encounters = model.pairs.of_joint == len(model.scene.contacts.joints)
    elsewhere = bool((at.elastic[:, encounters] > 0).any())
    history = ContactHistory(np.zeros(len(model.scene.contacts.k)), elsewhere, {})
    reading = model.problem.read(model.scene, at.t, motion, released=model.course.released, history=history)
    plastic, account = run.plastic(), run.ledger()
    overlap, message = run.overlap
    if overlap > NOTABLE_OVERLAP:
        warn_of(f"{message}, over the smaller one; a shorter timestep or stiffer joints keep them apart")
    residual = float(np.abs(account.residual).max())
    advice = f"the step is long for this motion, take timestep = {0.5 * settings['timestep']:.2g} s"
    warn_if_open(residual, account.largest, UNPAID_OF_PLAIN, "its largest part", lambda share: advice)
    return Response(
        case=model.problem.case,
        solver="plain MuJoCo",
        t=at.t,
        motion=motion,
        outcome=reading.outcome,
        message=reading.message + ties_message(plastic),
        rocking=reading.rocking,
        joints=reading.joints,
        plastic=plastic,
        ledger=account if options.ledger else None,
        stats=reading.stats | {"overlap": overlap} | settings,
        end=End(at.pose[-1].copy(), at.velocity[-1].copy()),
        kept_forces=run.forces(plastic) if options.forces else None,
    )
