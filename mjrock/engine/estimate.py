"""What a run of masonry of many blocks would take, in MuJoCo and by explicit steps, before it is made."""

from __future__ import annotations

import math
import warnings

import numpy as np

from ..geometry.frames import PLANE
from ..scene.explicit_step import SHARE, stable_step, stepping_seconds
from ..scene.scene import Scene

FEW = 8
"""Number of free blocks up to which fitted steps are never far behind explicit ones."""
WEAK, STRONG = 0.7e-6, 20e-6
"""Time that fitted steps take of a simulated second, over the lines and the highest frequency [s2]: where little slides
or strikes, and where much does. Columns of 16 and 64 blocks take 1.2e-6 and 0.7e-6, arches 2e-6 to 5e-6, walls of 10 to
55 blocks in running bond 0.5e-6 to 2.3e-6 under a weak sine and 7e-6 to 22e-6 under a strong one
(`scripts/studies/solvers_of_masonry.py`)."""
WEAK_IN_SPACE, STRONG_IN_SPACE = 1.5e-6, 140e-6
"""`WEAK` and `STRONG` for points in space [s2]. A column of 12 drums takes 2e-6 to 3e-6, a facade with return walls
1e-5 under a weak sine and 1.4e-4 under a strong one (`scripts/studies/columns_in_space.py`)."""
INTERPRETED = 10.0
"""Time of steps that fit the motion as plain Python over the middle of what compiled ones may take [-]. Walls take 2 to
9, stacks 15."""
A_BODY, A_LINE = 7e-5, 5e-6
"""What each body and each contact line adds to a step of one length as plain Python [s]."""
WORTH_SAYING = 3.0
"""How many times faster explicit steps must be than the middle of what fitted steps may take to be spoken of [-]."""

A_PLAIN_STEP, A_PLAIN_PLACE = 6e-5, 2e-6
"""Time of a step of a plain model, and what each line adds to it and half of what each body does [s]: a wall takes
5.4e-5, a column of 32 blocks 1.5e-4, ten dominoes 1.4e-4, 12 blocks that are poured 1e-4, a panel of 102 blocks 7.8e-4,
a facade of 29 that falls 6.3e-4."""
MINUTE = 60.0
"""Time of a run of a plain model from which on it is spoken of [s]."""


def explicit_seconds(scene: Scene) -> float:
    """Time of a second by explicit steps [s], from the highest frequency and the strongest dashpot."""
    contacts, in_space = scene.contacts, scene.freedom != PLANE
    ratio = np.asarray(contacts.k_s) / contacts.k  # of the springs along the face and the normal
    sprung = np.isfinite(ratio)
    stiffness = float(np.max(ratio[sprung], initial=1.0)) * scene.highest_frequency**2
    step = SHARE * stable_step(stiffness, stiffness * float((contacts.c / contacts.k).max()))
    return stepping_seconds(1 / step, len(contacts.k), sprung=bool(sprung.any()), in_space=in_space)


def fitted_seconds(scene: Scene) -> tuple[float, float]:
    """Time of a second by steps that fit the motion [s], where little slides or strikes and where much does."""
    unit = len(scene.contacts.k) * scene.highest_frequency
    weak, strong = (WEAK, STRONG) if scene.freedom == PLANE else (WEAK_IN_SPACE, STRONG_IN_SPACE)
    return weak * unit, strong * unit


def interpreted_seconds(scene: Scene, duration: float, timestep: float | None) -> float:
    """Time of a run as plain Python [s], the middle of what it may take; with a fixed step where one is given [s]."""
    if timestep is not None:
        return duration / timestep * (A_BODY * len(scene.bodies.mass) + A_LINE * len(scene.contacts.k))
    weak, strong = fitted_seconds(scene)
    return INTERPRETED * duration * math.sqrt(weak * strong)


def warn_if_slow(scene: Scene) -> None:
    """Warn of masonry of many blocks that explicit steps would follow in a fraction of the time."""
    blocks = len(scene.bodies.names)
    if blocks <= FEW:
        return
    explicit, (least, most) = explicit_seconds(scene), fitted_seconds(scene)
    if WORTH_SAYING * explicit <= math.sqrt(least * most):
        warnings.warn(
            f"explicit steps would take some {explicit:.2g} s for a simulated second of these {blocks} "
            f"blocks, and steps that fit the motion in MuJoCo {least:.2g} to {most:.2g} s, the more the blocks slide "
            "and strike: take mr.solve_explicit(case), or a timestep",
            stacklevel=3,
        )


def plain_seconds(scene: Scene, steps: float) -> float:
    """Time of some steps of a plain model [s]."""
    return steps * (A_PLAIN_STEP + A_PLAIN_PLACE * (len(scene.contacts.k) + 2 * len(scene.bodies.mass)))


def warn_if_plain_is_slow(scene: Scene, duration: float, h: float) -> None:
    """Warn of a run of a plain model that takes minutes, with what sets its step h [s]."""
    seconds = plain_seconds(scene, duration / h)
    if seconds > MINUTE:
        warnings.warn(
            f"this plain model would take some {seconds / 60:.2g} minutes, {duration / h:.2g} steps of {h:.2g} s, whose"
            f" length the stiffest joint sets (omega h = {h * scene.highest_frequency:.2g}); explicit steps would take "
            f"some {explicit_seconds(scene) * duration / 60:.2g}: take mr.solve_explicit(case), or softer joints",
            stacklevel=4,
        )
