"""The length of a time step, as far as a scene decides it before a run, for both solvers.

* What may be requested: `MUJOCO_STEP` and `EXPLICIT_STEP`.
* The longest sound step of MuJoCo (`sound_timestep`). Steps that fit the motion are limited by `engine.step_control`.
* The longest stable step of the explicit scheme (`stable_step`). A mode of the frequency omega and the damping ratio xi
  is stable up to h = (2 / omega) (sqrt(1 + xi^2) - xi), since the dashpots take the velocity half a step before the
  pose. The eigenvalues are those of `distinct.stable_step`, and `distinct.step_length` chooses the step.
* The time that explicit steps take (`stepping_seconds`), which the engine compares with that of its own.
"""

from __future__ import annotations

import math

from ..problem.damping.contacts import Contacts
from ..problem.wall.block import Block
from ..quantities import Implausible, Within, require_flag, require_kind, warn_of

MUJOCO_STEP, EXPLICIT_STEP = Within(1e-9, 1, "s"), Within(1e-12, 1, "s")
"""Ranges of a requested step."""

ENERGY_GAIN = 1e-3
"""Most energy that may appear from nowhere, over the energy there was [-]."""
STEP_TAKEN = 0.4
"""Step that is taken for masonry, over the longest stable one [-]."""
SPRUNG_LINE, RIGID_LINE = 50e-9, 110e-9
"""Time of an explicit step a line, with shear springs and with rigid friction [s]
(`scripts/studies/solvers_of_masonry.py`)."""
SPRUNG_IN_SPACE, RIGID_IN_SPACE = 120e-9, 800e-9
"""The same for a point in space [s]. `scripts/studies/columns_in_space.py` finds 65e-9 to 280e-9 and 300e-9 to 1600e-9,
with how busy the machine is."""
TINY = 1e-3
"""Step over the one that a scene needs below which it is doubted [-]."""


def required_timestep(timestep: float | None, within: Within, duration: float) -> float | None:
    """The requested step, which is at most the duration [s], or None."""
    return None if timestep is None else within.up_to(duration).checked("timestep", timestep)


def automatic_timestep(wall: Block, contacts: Contacts, *, side_stop: bool) -> float:
    """The step [s] at which a touch misplaces no more than ENERGY_GAIN of the energy that it meets.

    A point that touches inside a step of length h is met up to h/2 too early or too late, and its spring then stores up
    to k (v h/2)^2 / 2 that the motion has not paid. Against the kinetic energy m v^2 / 2 behind the point that is
    (omega h / 2)^2, with omega the frequency of the contact. So omega h = 2 sqrt(ENERGY_GAIN), omega the highest
    frequency of the wall with every contact closed: about a hundred steps in the shortest contact period.
    """
    require_kind("wall", wall, Block)
    require_kind("contacts", contacts, Contacts)
    require_flag("side_stop", side_stop)
    contacts.require_fit(wall, side_stop=side_stop)
    return sound_timestep(contacts.highest_frequency(wall, side_stop=side_stop))


def sound_timestep(frequency: float) -> float:
    """`automatic_timestep` for the highest frequency of the closed contacts [rad/s]."""
    return 2 * math.sqrt(ENERGY_GAIN) / frequency


def stepping_seconds(steps: float, lines: int, *, sprung: bool, in_space: bool) -> float:
    """Time that explicit steps of contact lines or points take [s], with shear springs or with rigid friction."""
    of_springs, of_friction = (SPRUNG_IN_SPACE, RIGID_IN_SPACE) if in_space else (SPRUNG_LINE, RIGID_LINE)
    return steps * lines * (of_springs if sprung else of_friction)


def warn_if_tiny(timestep: float, needed: float) -> None:
    """Warn of a step far below the one that a scene needs [s]."""
    if timestep < TINY * needed:
        message = f"timestep = {timestep:.3g} s, and {needed:.3g} s is short enough for these contacts: is it in s?"
        warn_of(message, Implausible)


def stable_step(stiffness: float, damping: float) -> float:
    """The longest stable step [s], infinite where nothing acts but weight.

    Args:
        stiffness: omega^2, the highest eigenvalue of the stiffness over the mass [1/s2].
        damping: 2 xi omega, that of the damping over the mass [1/s].
    """
    return math.inf if stiffness == 0 else (math.sqrt(damping**2 + 4 * stiffness) - damping) / stiffness
