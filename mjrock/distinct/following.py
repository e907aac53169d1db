"""Following a system by explicit steps: how long a step is, and the steps."""

from __future__ import annotations

import math

from tqdm import tqdm

from .loop import Clock, advance
from .setup import Setup
from .system import Books, Samples, System

AT_ONCE = 2e7
"""Steps of a line that are made before the progress bar moves and Ctrl-C is heard: about a second."""
LOOK = 5e-3
"""Longest time between two looks for blocks that meet others [s]."""


def steps_of(timestep: float | None, taken: float, limit: float, spacing: float) -> tuple[float, int]:
    """Length of a step [s], and how many lie between two samples; a ValueError says if it is not stable."""
    if timestep is None:
        every = max(1, math.ceil(spacing / taken))
        return spacing / every, every
    if timestep > limit:
        raise ValueError(
            f"timestep = {timestep:.3g} s is not stable; the valid range is up to {limit:.3g} s, which the stiffest "
            "contacts and the strongest dashpots allow"
        )
    return timestep, max(1, round(spacing / timestep))


def follow(setup: Setup, books: Books, samples: Samples, clock: Clock) -> tuple[System, int, int]:
    """Make the steps, with a progress bar where they take more than some seconds.

    Returns:
        The system at the end, how many steps it took, and of how many samples.
    """
    system, encounters = setup.system, setup.encounters
    total, sample, ended = clock.rows, clock.every * clock.h, False
    with tqdm(total=total, desc="explicit", unit="sample", delay=3, disable=None, leave=False) as bar:
        while clock.row < total and not ended:
            rows = max(1, int(AT_ONCE / (clock.every * max(1, len(system.lines)))))
            if encounters is not None:
                rows = min(rows, max(1, int(LOOK / sample)))
                loose = encounters.loose(system)
                if loose.any():
                    system = encounters.looked_for(system, loose, rows * sample)
            step, row, ended = advance(system, books, samples, clock._replace(rows=min(rows, total - clock.row)))
            bar.update(row - clock.row)
            clock = clock._replace(step=step, row=row)
    return system, clock.step, clock.row
