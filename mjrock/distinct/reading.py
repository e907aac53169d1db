"""Reading: the response of a run by explicit steps."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..geometry.frames import SPACE
from ..geometry.poses import tilts
from ..problem.damping.contacts import Contacts, Uplift
from ..problem.masonry.case import MasonryCase
from ..problem.wall.case import Case
from ..quantities import GRAVITY, Array, Integers, named
from ..result.ending import ending, masonry_ending
from ..result.fallen import below_everything, fallen_blocks, sunk_ground
from ..result.forces import Forces, Gathered, JointFrames, forces_of
from ..result.history import rocking_history
from ..result.joint_motion import joint_motion
from ..result.joints import JointMotion
from ..result.ledger import ENERGY_GAIN, Ledger, from_nowhere
from ..result.motion import SampledMotion
from ..result.response import Response
from ..result.rocking import Rocking
from ..result.samples import thinned
from ..result.ties import Plastic
from ..scene.course import Course
from ..scene.scene import Scene, is_quiet
from .bonds import TAKEN, cracked
from .following import Followed
from .memory import remembered
from .rows import Rows
from .system import Books, Samples

OPEN = 0.01
"""Energy without an account, and energy put in at ends of faces, that is warned of, over the largest part of the ledger
and over the energy there was [-]."""
STILL = 0.2
"""Time without motion after which blocks that have left their joints lie still [s]."""
ROUNDING = 1e-12
"""Rounding of a position in many steps, over its size [-]."""


@dataclass(frozen=True, eq=False)
class Run:
    """A run by explicit steps: what was asked, what stood, what was kept of the motion, and when [s], and the times of
    the looks [s]."""

    case: Case | MasonryCase
    contacts: Contacts | None
    scene: Scene
    course: Course
    followed: Followed
    books: Books
    samples: Samples
    t: Array
    looked: Array

    @property
    def in_space(self) -> bool:
        """Whether the bodies move in space."""
        return bool(self.samples.pose.shape[2] == SPACE.nq)

    @cached_property
    def energy(self) -> Array:
        """Energy above the scene at rest [J]. Shear springs count from what they hold at the start."""
        return self.above_rest(self.samples.energy)

    def above_rest(self, energy: Rows) -> Array:
        """The same of samples or looks, the first of which is the start."""
        at_rest = self.scene.rest_energies.sum()
        there = energy["kinetic"] + energy["potential"] + energy["elastic"]
        preloaded = float(there[0] - at_rest - self.course.energy(self.scene))
        return np.asarray(there - (float(at_rest) + preloaded))

    @property
    def rounding(self) -> float:
        """Energy that the rounding of positions makes [J]: of the weights over the largest displacement and lever."""
        linear = self.samples.pose[..., : 3 if self.in_space else 2]
        size = np.abs(linear).max() + np.abs(self.scene.places.at).max()
        return ROUNDING * GRAVITY * float(self.scene.bodies.mass.sum() * size)


def response_of(run: Run, *, ledger: bool, stride: int, stats: dict[str, Any]) -> Response:
    """The response of a run: every `stride` of its samples and the last, its `ledger` if asked for, what it took.

    Raises:
        RuntimeError: if energy has appeared from nowhere.
    """
    reading = wall_reading(run) if isinstance(run.case, Case) else masonry_reading(run, run.case)
    require_no_gain(run, stats)
    samples, kept = run.samples, thinned(len(run.t), stride)
    response = Response(
        case=run.case,
        solver="explicit",
        t=run.t[kept],
        motion=SampledMotion(samples.pose[kept], samples.velocity[kept], run.energy[kept]),
        plastic=plastic_of(run),
        ledger=ledger_of(run, kept) if ledger else None,
        actuators=dict(zip(actuators_of(run.case), samples.actuators[kept].T, strict=True)),
        kept_forces=kept_forces(run, kept),
        stats=reading.pop("stats") | stats,
        end=remembered((samples.pose[-1].copy(), samples.velocity[-1].copy()), run.followed.memory),
        **reading,
    )
    warn_if_open(response, run.rounding)
    return response


def actuators_of(case: Case | MasonryCase) -> tuple[str, ...]:
    """Names of the actuators of a case."""
    return tuple(case.actuators) if isinstance(case, MasonryCase) else ()


def kept_forces(run: Run, kept: Integers) -> Forces | None:
    """The forces of a run at some of its samples, if they were kept."""
    samples, links = run.samples.taken(kept), run.scene.links
    if not samples.held.shape[1]:
        return None
    pulled = dict(zip((*links.sprung.names, *links.damped.names), -samples.pulled.T, strict=True))
    damage = None
    if isinstance(run.case, MasonryCase) and len(run.followed.system.bonds):
        lines = np.bincount(run.scene.contacts.joint, minlength=samples.damage.shape[1])
        dry = [bond is None for bond in run.case.masonry.bonds]
        damage = np.where(dry, np.nan, samples.damage / lines)
    gathered = Gathered(run.t[kept], samples.pose, samples.loads, samples.held, pulled, samples.actuators, damage)
    return forces_of(run.case, JointFrames.of(run.case), gathered)


def plastic_of(run: Run) -> dict[str, Plastic]:
    """What each tie has yielded, and when it broke."""
    ties, books = run.followed.system.ties, run.books
    links = run.scene.links.sprung
    start = run.scene.ties.reach - links.reach
    columns = zip(links.names, ties["drawn"], books.ties, ties["broken"], books.broken, start, strict=True)
    return {name: Plastic(*(float(value) for value in values)) for name, *values in columns}


def wall_reading(run: Run) -> dict[str, Any]:
    """Peaks and impacts of a wall."""
    case, contacts = run.case, run.contacts
    assert isinstance(case, Case)
    assert contacts is not None
    uplift = Uplift.of(case, contacts)
    theta, omega = run.samples.pose[:, 0, 2], run.samples.velocity[:, 0, 2]
    _, peaks, impacts = rocking_history(case, run.t, theta, omega, run.energy, uplift, released=run.course.released)
    outcome, message = ending(case, run.t, theta, run.energy, uplift.energy, run.samples.velocity[-1, 0])
    slip = run.samples.pose[:, 0, 0] - case.wall.pose(theta)[:, 0]
    return {
        "rocking": Rocking(impacts, peaks),
        "outcome": outcome,
        "message": message,
        "stats": {"base_displacement": float(slip[-1] - slip[0])},
    }


def masonry_reading(run: Run, case: MasonryCase) -> dict[str, Any]:
    """Openings, slidings and falls of masonry."""
    masonry, scene, pose = case.masonry, run.scene, run.samples.pose
    flat = pose.reshape(len(pose), -1)
    up = scene.freedom.translations - 1
    motion = joint_motion(masonry, scene.places, scene.contacts.joint, scene.at_rest.ravel(), flat)
    drop = scene.at_rest[:, up] - pose[:, :, up]
    below = drop - sunk_ground(masonry, case.supports, run.t)
    fallen = fallen_blocks(masonry, run.t, motion.parted, tilts(flat, scene.freedom), below)
    quiet = is_quiet(scene, float(run.energy[-1]), run.samples.velocity[-1]) or lies_still(run)
    outcome, message = masonry_ending(fallen, quiet, float(run.t[-1]), unmet="")
    if gone := below_everything(masonry, case.supports, run.t, drop):
        message += f" Below all fixed blocks, past the edge of any ground: {named(gone)}."
    opening = motion.opening.copy()
    of = scene.contacts.joint
    np.maximum.at(opening, of, run.followed.system.lines["widest"][: len(of)])
    return {
        "joints": JointMotion(opening, motion.sliding, fallen, cracked(run.followed.system.bonds, of, masonry)),
        "outcome": outcome,
        "message": message,
        "stats": {"deepest": motion.deepest},
    }


def lies_still(run: Run) -> bool:
    """Whether blocks that have left their joints lie still: for the last 0.2 s none moved as `is_quiet` says."""
    met = None if run.followed.memory is None else run.followed.memory.met
    if met is None or not met.handed.any():
        return False
    last = run.samples.velocity[run.t >= run.t[-1] - STILL]
    return run.t[-1] > STILL and all(is_quiet(run.scene, 0.0, velocity) for velocity in last)


def require_no_gain(run: Run, stats: Mapping[str, Any]) -> None:
    """Raise a RuntimeError if energy appears from nowhere, or if the motion is not finite; warn if much appears at ends
    of faces, which have an account.

    The looks decide, which are made every so many steps, so that the spacing of the samples plays no part.

    Args:
        run: the run.
        stats: with the step that was taken.
    """
    if not np.isfinite(run.energy[-1]):
        raise RuntimeError(f"the motion breaks down at t = {run.t[-1]:.4g} s; take a shorter timestep")
    looks = run.samples.looks[: len(run.looked)]
    work, left, there = looks["ground"], looks["ends"].sum(axis=1), run.above_rest(looks)
    own = there - work + left
    given = max(float(there[0]), 0.0) + float(np.abs(np.diff(work)).sum()) + float(run.scene.rest_energies[2])
    kinetic = float(looks["kinetic"].max())  # what falls below its rest has more
    scale = max(given, kinetic, run.rounding / ENERGY_GAIN)
    gain = from_nowhere(own, scale)
    if gain is not None:
        worst, share, said = gain
        raise RuntimeError(f"{said} by t = {run.looked[worst]:.4g} s; {advice(stats, share)}")
    if -left.min() > OPEN * scale:
        warnings.warn(
            f"contacts at ends of faces put in {-left.min():.3g} J, {-left.min() / scale:.1%} of the energy there was: "
            "a block that slides over the end of a face is met all at once, at any step",
            stacklevel=4,
        )


def warn_if_open(response: Response, rounding: float) -> None:
    """Warn of a ledger that does not close by more than rounding [J], and say which step closes it."""
    if response.ledger is None:
        return
    residual, largest = float(np.abs(response.ledger.residual).max()), response.ledger.largest
    if residual > max(OPEN * largest, rounding):
        enough = 0.5 * OPEN * largest / residual * response.stats["timestep"]
        warnings.warn(
            f"the ledger does not close: {residual:.3g} J, {residual / largest:.1%} of its largest part, have no "
            f"account. The step is long for this motion; take timestep = {enough:.2g} s",
            stacklevel=4,
        )


def advice(stats: Mapping[str, Any], gained: float) -> str:
    """What to do against a share of energy from nowhere, in words.

    What appears falls at least in proportion to the step, and the step that is advised brings it to a quarter of
    ENERGY_GAIN.
    """
    return f"take timestep = {0.25 * ENERGY_GAIN / gained * stats['timestep']:.2g} s"


def ledger_of(run: Run, kept: Integers) -> Ledger:
    """The ledger of a run at some of its samples."""
    scene, samples = run.scene, run.samples.taken(kept)
    energy, may_break = samples.energy, np.isfinite(scene.links.sprung.ultimate)
    dashpots = dict(zip((*scene.links.damped.names, *actuators_of(run.case)), samples.dampers.T, strict=True))
    groups = (*scene.contacts.joints, "encounters", "motion")[: samples.dashpots.shape[1]]
    dashpots |= dict(zip(groups, samples.dashpots.T, strict=True))
    broken = zip(scene.links.sprung.names, samples.broken.T, may_break, strict=True)
    return Ledger(
        t=run.t[kept],
        **{name: np.asarray(energy[name]) for name in ("kinetic", "potential", "elastic", "ground")},
        dashpots=dashpots,
        friction=np.asarray(energy["friction"]),
        ties=dict(zip(scene.links.sprung.names, samples.ties.T, strict=True)),
        broken={name: account for name, account, breaks in broken if breaks},
        ends={} if isinstance(run.case, Case) else dict(zip(("joints", "encounters"), energy["ends"].T, strict=True)),
        bonds=dict(zip(TAKEN, energy["bonds"].T, strict=True)) if len(run.followed.system.bonds) else {},
    )
