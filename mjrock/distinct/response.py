"""The response of a run by explicit steps."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..problem.masonry.case import AnyCase
from ..quantities import GRAVITY, Array, Integers, warn_of
from ..result.forces import Forces, KeptForces, forces_of
from ..result.ledger import Ledger, StepError, require_no_gain, warn_if_open
from ..result.motion import SampledMotion, thinned
from ..result.reading import ContactHistory, Reading
from ..result.response import End, Response
from ..result.ties import Plastic, plastic_of, ties_message
from ..rows import Row, Rows
from ..scene.scene import Scene
from ..scene.time_step import ENERGY_GAIN
from .kinds.link import Kind
from .kinds.ties import Ties
from .setup import Setup
from .system import ENERGY, Books, Samples, System
from .time_integration import Integration

RESIDUAL_WARNED_OF = 0.01
"""Energy without an account, and energy put in at ends of faces, that is warned of, over the largest part of the ledger
and over the energy there was [-]."""
POSITION_ROUNDING = 1e-12
"""Rounding of a position in many steps, over its size [-]."""


@dataclass(frozen=True, eq=False)
class Run:
    """A run by explicit steps: its start and end, accounts and samples, and the times of samples and checks [s]."""

    setup: Setup
    integration: Integration
    books: Books
    samples: Samples
    t: Array
    checked: Array

    @property
    def case(self) -> AnyCase:
        """The case."""
        return self.setup.problem.case

    @property
    def scene(self) -> Scene:
        """The structure."""
        return self.setup.scene

    @property
    def links(self) -> Iterator[tuple[Kind, Row, str]]:
        """The table, the row and the name of each link."""
        for table, names in zip(self.integration.system.links, self.setup.link_names, strict=True):
            for row, name in zip(table.rows, names, strict=True):
                yield table, row, name

    def forces_of(self, link_forces: Array, *, driven: bool) -> dict[str, Array]:
        """The force of each link, or of each actuator, by name, among those of all."""
        links = ((row, name) for table, row, name in self.links if table.reported and table.driven is driven)
        return {name: link_forces[:, row.number] for row, name in links}

    @cached_property
    def energy(self) -> Array:
        """Energy above the scene at rest [J]. Shear springs count from what they hold at the start."""
        return self.above_rest(self.samples.energy)

    def above_rest(self, energy: Rows) -> Array:
        """The same of samples or checks, the first of which is the start."""
        at_rest = self.scene.rest_energies.sum()
        mechanical = energy["kinetic"] + energy["potential"] + energy["elastic"]
        preloaded = float(mechanical[0] - at_rest - self.setup.course.energy(self.scene))
        return np.asarray(mechanical - (float(at_rest) + preloaded))

    @property
    def rounding(self) -> float:
        """Energy that the rounding of positions makes [J]: of the weights over the largest displacement and lever."""
        linear = self.samples.pose[..., : self.scene.freedom.translations]
        size = np.abs(linear).max() + np.abs(self.scene.places.at).max()
        return POSITION_ROUNDING * GRAVITY * float(self.scene.bodies.mass.sum() * size)


def response_of(run: Run, *, ledger: bool, stride: int, stats: dict[str, Any]) -> Response:
    """The response of a run: every `stride` of its samples and the last, its `ledger` if requested, and the cost.

    Raises:
        RuntimeError: if energy has appeared from nowhere.
    """
    step = float(stats["timestep"])
    require_sound(run, step)
    reading, yielded = reading_of(run), plastic(run)
    samples, kept = run.samples, thinned(len(run.t), stride)
    response = Response(
        case=run.case,
        solver="explicit",
        t=run.t[kept],
        motion=SampledMotion(samples.pose[kept], samples.velocity[kept], run.energy[kept]),
        outcome=reading.outcome,
        message=reading.message + ties_message(yielded),
        rocking=reading.rocking,
        joints=reading.joints,
        plastic=yielded,
        ledger=ledger_of(run, kept) if ledger else None,
        actuators=run.forces_of(samples.link_forces[kept], driven=True),
        kept_forces=kept_forces(run, kept),
        stats=reading.stats | stats,
        end=End(samples.pose[-1].copy(), samples.velocity[-1].copy(), run.integration.memory),
    )
    if response.ledger is not None:
        residual = float(np.abs(response.ledger.residual).max())
        unpaid = residual if residual > run.rounding else 0.0
        warn_if_open(
            unpaid,
            response.ledger.largest,
            RESIDUAL_WARNED_OF,
            "its largest part",
            lambda share: f"the step is long for this motion, {advice(step, 2 * share, RESIDUAL_WARNED_OF)}",
        )
    return response


def kept_forces(run: Run, kept: Integers) -> Forces | None:
    """The forces of a run at some of its samples, if they were kept."""
    samples = run.samples.chosen(kept)
    if not samples.contact_reactions.shape[1]:
        return None
    driven = run.forces_of(samples.link_forces, driven=True)
    damage = None
    if any(len(law.rows) for law in run.integration.system.laws):
        dry = [bond is None for bond in run.scene.contacts.bonds]
        damage = np.where(dry, np.nan, samples.damage)
    of_run = KeptForces(
        t=run.t[kept],
        pose=samples.pose,
        loads=samples.loads,
        contact_reactions=samples.contact_reactions,
        links=run.forces_of(-samples.link_forces, driven=False),
        driven=np.array([*driven.values()]).T.copy() if driven else None,
        guided=samples.guided,
        damage=damage,
    )
    return forces_of(run.case, run.case.rest_geometry.frames, of_run)


def plastic(run: Run) -> dict[str, Plastic]:
    """What each tie has yielded, and when it broke."""
    ties, work, memory = ties_of(run.integration.system), run.books.links, run.setup.memory
    first, reach = ties["account"], run.scene.ties.reach
    before = np.zeros(len(ties)) if memory is None else ties_of(memory.system)["reach"] - reach
    return plastic_of(
        run.scene,
        elongation=ties["plastic"],
        energy=work[first],
        broken=ties["broken"],
        lost=work[first + 1],
        before=before,
    )


def ties_of(system: System) -> Rows:
    """The rows of the ties of a system."""
    return next(table.rows for table in system.links if isinstance(table, Ties))


def reading_of(run: Run) -> Reading:
    """What is read from a run."""
    samples, system, joint = run.samples, run.integration.system, run.scene.contacts.joint
    motion = SampledMotion(samples.pose, samples.velocity, run.energy)
    search = None if run.integration.memory is None else run.integration.memory.search
    has_left_joints = search is not None and bool(search.handed_over.any())
    cracked = dict(item for law in system.laws for item in law.cracked(run.scene).items())
    history = ContactHistory(system.lines["widest"][: len(joint)], has_left_joints, cracked)
    released = run.setup.course.released
    return run.setup.problem.read(run.scene, run.t, motion, released=released, history=history)


class EnergyGainError(RuntimeError):
    """Energy has appeared from nowhere."""


def require_sound(run: Run, step: float) -> None:
    """Raise a RuntimeError if energy appears from nowhere, or if the motion is not finite; warn if much appears at ends
    of faces, which have an account.

    The checks at fixed numbers of steps decide, so that the spacing of the samples plays no part.

    Args:
        run: the run.
        step: that was taken [s].
    """
    if not np.isfinite(run.energy[-1]):
        raise RuntimeError(f"the motion breaks down at t = {run.t[-1]:.4g} s; take a shorter timestep")
    checks = run.samples.checks[: len(run.checked)]
    work, lost = checks["ground"] + checks["driven"], checks["joint_ends"] + checks["encounter_ends"]
    mechanical = run.above_rest(checks)
    supplied = max(float(mechanical[0]), 0.0) + float(np.abs(np.diff(work)).sum()) + float(run.scene.rest_energies[2])
    kinetic = float(checks["kinetic"].max())  # what falls below its rest has more
    elastic = float(checks["elastic"].max())  # and masonry that is wedged, or pushed by supports
    scale = max(supplied, kinetic, elastic, run.rounding / ENERGY_GAIN)
    try:
        require_no_gain(run.checked, mechanical - work + lost, scale)
    except StepError as gain:
        message = f"{gain} by t = {gain.t:.4g} s; {advice(step, 4 * gain.share, ENERGY_GAIN)}"
        raise EnergyGainError(message) from None
    if -lost.min() > RESIDUAL_WARNED_OF * scale:
        warn_of(
            f"contacts at ends of faces put in {-lost.min():.3g} J, {-lost.min() / scale:.1%} of the energy there was: "
            "a block that slides over the end of a face is met all at once, at any step",
        )


LARGEST_ADVICE = 0.1
"""Least step that a message names, over the one that was taken [-]."""


def advice(step: float, share: float, wanted: float) -> str:
    """The step that brings a share of energy without an account down to the one that is wanted, in words.

    The share falls at least in proportion to the step, once steps are short enough for the stiffest contact. Where much
    is missing they are not, and the share does not show by which factor.
    """
    shorter = max(wanted / share, LARGEST_ADVICE)
    again = "" if shorter > LARGEST_ADVICE else " first, and a tenth of that if energy still appears"
    return f"take timestep = {shorter * step:.2g} s{again}"


def ledger_of(run: Run, kept: Integers) -> Ledger:
    """The ledger of a run at some of its samples."""
    samples = run.samples.chosen(kept)
    energy: dict[str, Any] = {name: np.asarray(samples.energy[name]) for name in ENERGY.names or ()}
    booked: dict[str, Any] = {"dashpots": {}, "actuators": {}, "ties": {}, "broken": {}}
    for table, row, name in run.links:
        for i, part in enumerate(table.booked):
            booked[part][name] = samples.links[:, row.account + i]
    sprung = run.scene.links.sprung
    may_break = dict(zip(sprung.names, np.isfinite(sprung.law["ultimate"]), strict=True))
    booked["broken"] = {name: account for name, account in booked["broken"].items() if may_break[name]}
    groups = (*run.scene.contacts.joints, "encounters", "motion")[: samples.dashpots.shape[1]]
    booked["dashpots"] |= dict(zip(groups, samples.dashpots.T, strict=True))
    ends = {"joints": energy["joint_ends"], "encounters": energy["encounter_ends"]}
    bonds = {name: energy[name] for name in ("tension", "slip", "crushing")}
    return Ledger(
        t=run.t[kept],
        **{name: energy[name] for name in ("kinetic", "potential", "elastic", "friction", "ground")},
        **booked,
        ends=ends if run.case.joints else {},
        bonds=bonds if any(len(law.rows) for law in run.integration.system.laws) else {},
    )
