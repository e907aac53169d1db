"""The formula of the longest stable step of the explicit scheme, the share of it that is taken, and what steps take.

Both solvers use them: the engine estimates the time of explicit steps. The eigenvalues of a system are in
`distinct.stable_step`.

A mode of the frequency omega and the damping ratio xi is stable up to h = (2 / omega) (sqrt(1 + xi^2) - xi), since the
dashpots take the velocity half a step before the pose.
"""

from __future__ import annotations

import math

from ..quantities import Implausible, warn_of

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
