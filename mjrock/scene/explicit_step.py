"""The formula of the longest stable step of the explicit scheme, and the share of it that is taken.

It stands here since the engine estimates the time of explicit steps with it. The eigenvalues of a system are in
`distinct.limit`.

A mode of the frequency omega and the damping ratio xi is stable up to h = (2 / omega) (sqrt(1 + xi^2) - xi), since the
dashpots take the velocity half a step before the pose.
"""

from __future__ import annotations

import math

SHARE = 0.4
"""Step that is taken for masonry, over the longest stable one [-]."""


def stable_step(stiffness: float, damping: float) -> float:
    """The longest stable step [s], infinite where nothing acts but weight.

    Args:
        stiffness: omega^2, the highest eigenvalue of the stiffness over the mass [1/s2].
        damping: 2 xi omega, that of the damping over the mass [1/s].
    """
    return math.inf if stiffness == 0 else (math.sqrt(damping**2 + 4 * stiffness) - damping) / stiffness
