"""The length of the steps of a run: which step is taken, which is valid, and how a run is divided into steps.

The longest stable step (`stable_step`) counts

* the lines of the joints, with the springs and dashpots that laws of joints may give them (`JointLaw.springs`);
* links: ties, dampers, actuators and others, each kind by its `springs` and `rates`;
* blocks without a joint, and blocks whose pairs are given stronger dashpots than their joints have, as they may meet
  later (`LongestSteps`).

A wall takes a fixed share of it. Masonry takes a larger share, and shorter steps where results would not be exact:

* flat impacts at the joints, and of pairs that are given (`Impacts`);
* the decay of a velocity by dampers (`STOPPED`);
* blocks that stiff ties throw back (`THROWN_BACK`). A tie that goes taut within a step acts for the time that it is
  taut, see `kinds.ties`.

The dashpots of actuators are part of the stable step alone: an actuator follows its history.

A flat impact is that of two blocks that meet on a whole joint: of a reduced mass m on the springs K and dashpots C of
the joint, of the circular frequency w = (K / m)^1/2 and the damping ratio r = C / (2 m w). Dashpots take the velocity
half a step before the pose. To first order that acts like a mass less by C h / 2, so that ln |e|, -pi r, falls by pi/2
r^2 w h. Where this is too much, the rate is extrapolated, see `touches.foreseen`, and the step is so short that
dashpots brake little within it.
"""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np

from ..problem.masonry.laws.joint_law import largest_stiffness
from ..quantities import Array
from ..result.motion import intervals, whole_steps
from ..scene.time_step import EXPLICIT_STEP, STEP_TAKEN, warn_if_tiny
from .stable_step import longest_step, rates_of_links, stiffest_lines
from .system import System

TimeStep = Annotated[float | None, EXPLICIT_STEP]
"""Length of a step [s], None for the default one."""

SHARE_OF_A_WALL = 0.05
"""Step that is taken for a wall, over the longest stable one [-]. The first three |e| of a wall against a stop are then
within 0.04 %, and with 0.1 within 0.11 %."""
SAMPLES_OF_A_WALL = 1e-3
"""Largest spacing of the samples that are kept of a wall, times its frequency parameter p [-]: peaks and impacts are
read off them."""
CHECKED_EVERY, MOST_CHECKS = 100, 1_000_000
"""Steps from one check of the energy to the next, and most checks."""
LEAST_STEP_OF_LIGHT_BLOCKS = 0.1
"""Least share of the longest stable step of the joints to which the springs of blocks that may meet later shorten it
[-]. Lighter ones have softer contacts."""
STOPPED = 0.15
"""Step over the time m / C in which dampers stop what they act on, up to which that time is exact to 1 % [-]. Looking
ahead by half a step is wrong by 5/12 of its square."""

THROWN_BACK, SHORTER_FOR_TIES = 0.02, 0.5
"""Step times the circular frequency of blocks on ties alone, up to which ties need no shorter step, and by how much
they shorten it at most [-]. A block that a stiff tie throws back strikes its joints more often, and the errors of the
blows add up."""

LOOK_AHEAD_BELOW = 0.25
"""Step over the longest stable one up to which dashpots look ahead, however strong they are [-]."""
STEPS_AHEAD = 0.5
"""By how many steps dashpots look ahead: they take the rate at the pose, half a step after the velocity that there is.
In long steps what is foreseen at a contact is worse than that velocity, see `StepLength.looks_ahead`."""
STABLE_AHEAD = 0.5
"""Step up to which a dashpot that looks ahead by half a step is stable, over the longest one in which it is stable
otherwise [-]: it acts as one of twice its strength."""
LAGGED = 0.01
"""Error of |e| from which on dashpots look ahead [-]."""
BRAKING = 0.1
"""Step over the time C / m in which dashpots that look ahead stop a block, up to which |e| is exact to 1 % [-]."""
SWINGING = 0.15
"""Step times the circular frequency that is short enough for any damping [-]. From a damping ratio of a third on |e| is
below a third, and its error below 0.5 % of the speed of approach."""


class Impacts(NamedTuple):
    """Flat impacts at the joints.

    Args:
        frequency: circular frequency of each without damping [1/s], shape (joints,).
        ratio: its damping ratio [-], likewise.
    """

    frequency: Array
    ratio: Array

    @classmethod
    def at_joints(cls, system: System) -> Impacts:
        """Those of the joints of a system, which are the groups of its lines."""
        lines, inverse = stiffest_lines(system), np.asarray(system.bodies["inverse_mass"])
        along = np.asarray(lines["normal"]) ** 2
        inverse_mass = (inverse[lines["body"]] * along).sum(axis=1)
        inverse_mass += np.where(lines["face"] >= 0, (inverse[np.maximum(lines["face"], 0)] * along).sum(axis=1), 0.0)
        moves = inverse_mass > 0  # where guides hold both blocks along the normal there is no impact
        _, first, joint = np.unique(lines["group"][moves], return_index=True, return_inverse=True)
        inverse_mass = inverse_mass[moves][first]
        springs = largest_stiffness(lines), lines["c"]
        stiffness, damping = (inverse_mass * np.bincount(joint, column[moves]) for column in springs)
        frequency = np.sqrt(stiffness)
        return cls(frequency, damping / (2 * frequency))

    def beside(self, others: Impacts) -> Impacts:
        """These and others."""
        return Impacts(*map(np.concatenate, zip(self, others, strict=True)))

    def lag(self, h: float) -> Array:
        """How much |e| falls in steps of h [s] since dashpots take the velocity half a step before the pose [-]."""
        return np.asarray(0.5 * math.pi * self.ratio**2 * self.frequency * h)

    def step(self, longest: float) -> float:
        """A step no longer than another one with which each |e| is exact to 1 % [s]."""
        lagging = self.lag(longest) > LAGGED
        ratio, frequency = self.ratio[lagging], self.frequency[lagging]
        short = np.maximum(BRAKING / (2 * ratio), SWINGING) / frequency
        return float(short.min(initial=longest))

    def look_ahead(self, h: float) -> bool:
        """Whether dashpots are to look ahead in steps of h [s]: if they lag, and the steps are short enough for it."""
        return bool((self.lag(h) > LAGGED).any()) and self.step(h) > (1 - 1e-9) * h


class LongestSteps(NamedTuple):
    """The longest stable steps of blocks on the springs that they have beyond their joints, infinite for none.

    Args:
        loose: of blocks without a joint, with the dashpots of the joints [s].
        given: of these and of blocks whose pairs are given stronger dashpots, on their springs alone [s].
        damped: how much shorter than that a step is with these dashpots [-].
    """

    loose: float
    given: float = math.inf
    damped: float = 1.0

    def step(self, shortest: float) -> float:
        """The longest stable step [s], where no springs shorten it below another one [s]."""
        return min(max(self.loose, shortest), self.damped * max(self.given, shortest))


class StepLength(NamedTuple):
    """The length of the steps of a wall or of masonry.

    Args:
        limit: the longest stable step [s].
        default: the step that is taken where none is given [s].
        spacing: largest spacing of the samples that are kept [s].
        impacts: flat impacts at the joints, and of pairs that are given. A wall has none: its steps are below
            `LOOK_AHEAD_BELOW`.
    """

    limit: float
    default: float
    spacing: float = math.inf
    impacts: Impacts | None = None

    @classmethod
    def of_wall(cls, system: System, p: float) -> StepLength:
        """That of a wall of the frequency parameter p [1/s]."""
        limit = longest_step(system)
        return cls(limit, SHARE_OF_A_WALL * limit, SAMPLES_OF_A_WALL / p)

    @classmethod
    def of_masonry(cls, system: System, unguided: float, later: LongestSteps, given: Impacts) -> StepLength:
        """That of masonry.

        Args:
            system: with its laws, links and guides.
            unguided: its longest stable step without actuators and their guides [s].
            later: of blocks that may meet later.
            given: flat impacts of pairs that are given.
        """
        limit = longest_step(system) if len(system.guided) else unguided
        shortest = LEAST_STEP_OF_LIGHT_BLOCKS * min(limit, unguided)
        impacts = Impacts.at_joints(system)
        step = impacts.step(STEP_TAKEN * min(limit, later.step(shortest)))
        step = max(given.step(step), min(step, STEP_TAKEN * later.damped * shortest))
        frequency, decay = rates_of_links(system)
        of_ties = max(THROWN_BACK / max(frequency, 1e-300), SHORTER_FOR_TIES * step)
        return cls(limit, min(step, of_ties, STOPPED / max(decay, 1e-300)), impacts=impacts.beside(given))

    def looks_ahead(self, h: float) -> bool:
        """Whether dashpots of contacts look ahead in steps of h [s]."""
        needed = self.impacts is not None and self.impacts.look_ahead(h)
        return h <= LOOK_AHEAD_BELOW * self.limit or (needed and self.links_look_ahead(h))

    def links_look_ahead(self, h: float) -> bool:
        """Whether dashpots of links look ahead in steps of h [s]: where they are stable then."""
        return h <= STABLE_AHEAD * self.limit

    def require_stable(self, timestep: float) -> None:
        """Raise a ValueError for a requested step that is not stable, and warn of one far below the default [s]."""
        if timestep > self.limit:
            raise ValueError(
                f"timestep = {timestep:.3g} s is not stable; the valid range is up to {self.limit:.3g} s, which the "
                "stiffest contacts and the strongest dashpots allow"
            )
        warn_if_tiny(timestep, self.default)


class TimeGrid(NamedTuple):
    """When the steps of a run are made, and which of them are sampled.

    Args:
        h: length of a step [s].
        steps_per_sample: steps from one sample to the next.
        stride: samples from one that is returned to the next.
        last: number of the last step, of which there is a sample too.
        end: when it is made [s].
    """

    h: float
    steps_per_sample: int
    stride: int
    last: int
    end: float

    @classmethod
    def of_run(cls, length: StepLength, duration: float, timestep: float | None, output_step: float) -> TimeGrid:
        """Steps that end with the duration: in equal parts of it no longer than `output_step`.

        A requested step is kept, and the run ends with the one that is nearest to the duration.

        Raises:
            ValueError: if the requested step is not stable.
        """
        if timestep is None:
            count = intervals(duration, output_step)
            parts = intervals(duration / count, length.spacing)
            steps_per_sample = intervals(duration / (count * parts), length.default)
            last = count * parts * steps_per_sample
            return cls(h=duration / last, steps_per_sample=steps_per_sample, stride=parts, last=last, end=duration)
        length.require_stable(timestep)
        steps, last = whole_steps(output_step, timestep), max(1, round(duration / timestep))
        steps_per_sample = steps // min(steps, intervals(steps * timestep, length.spacing))
        stride = steps // steps_per_sample
        return cls(h=timestep, steps_per_sample=steps_per_sample, stride=stride, last=last, end=last * timestep)

    @property
    def steps_per_check(self) -> int:
        """Steps from one check of the energy to the next."""
        return max(CHECKED_EVERY, -(-self.last // MOST_CHECKS))

    def checks(self, steps: int) -> Array:
        """Times of the checks of a number of steps [s]."""
        count = steps // self.steps_per_check + 1 if steps <= self.last else -(-self.last // self.steps_per_check) + 1
        return self.h * np.minimum(self.steps_per_check * np.arange(count), self.last)

    @property
    def samples(self) -> int:
        """How many samples there are."""
        return -(-self.last // self.steps_per_sample) + 1

    def times(self) -> Array:
        """Times of the samples [s], shape (samples,)."""
        t = self.h * self.steps_per_sample * np.arange(self.samples)
        t[-1] = self.end
        return np.asarray(t)
