"""The start of a run that carries on an earlier one."""

from __future__ import annotations

import numpy as np

from ..geometry.frames import PLANE, SPACE
from ..problem.masonry.case import AnyCase
from ..problem.wall.effect import beyond_text
from ..quantities import require_array, require_within, shown
from .response import End, State

PARTS = ("pose", "velocity")
UNIT_ROUNDING = 1e-6
"""Largest difference of the length of a quaternion from one [-]."""


def required_start(start: object, case: AnyCase) -> State:
    """A start as pose and velocity of all bodies, of shape (bodies, 3), in space (bodies, 7) and (bodies, 6), finite.

    Raises:
        TypeError: if it is no pose and velocity.
        ValueError: for another shape, a value out of range, ties that yield among the effects, or a block that moves as
            its guide does not allow. A guide takes less than a thousandth of sqrt(g size) from it.
    """
    if any(link.law.yields for link in case.links.values()):
        raise ValueError("start does not say what ties have yielded; follow a case with ties that yield in one run")
    if isinstance(start, End):
        start = tuple(start)
    if not isinstance(start, tuple | list) or len(start) != 2:
        raise TypeError(f"start = {shown(start)} is not a pose and a velocity; take the end of an earlier response")
    bodies, freedom = len(case.bodies), SPACE if case.in_space else PLANE
    pose, velocity = (
        require_array(f"start, {name}", part, (bodies, numbers))
        for name, part, numbers in zip(PARTS, start, (freedom.nq, freedom.nv), strict=True)
    )
    velocity = case.require_start(pose, velocity)
    for name, values in zip(PARTS, (pose, velocity), strict=True):
        require_within(f"start, largest of {name}", float(np.abs(values).max()), 0.0, 1e3)
    if freedom is SPACE:
        size = np.linalg.norm(pose[:, 3:], axis=1)
        for length in size[np.abs(size - 1) > UNIT_ROUNDING].tolist():
            require_within("start, length of a quaternion", length, 1 - UNIT_ROUNDING, 1 + UNIT_ROUNDING)
    return pose, velocity


def require_in_text(case: AnyCase) -> None:
    """Raise ValueError for a link whose law the text of a model, and so a fixed step, cannot describe."""
    for name, link in case.links.items():
        if number := beyond_text(link.law):
            raise ValueError(
                f"a fixed step is the text of a model, which cannot describe the law of each link, and {name} has "
                f"{number}; leave timestep out, so that steps fit the motion"
            )
