"""The rocking spectrum of a ground motion: largest rotations of walls of one slenderness and many sizes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...problem.damping.restitution import Restitution
from ...problem.ground.motion import GroundMotion
from ...problem.wall.block import Block
from ...problem.wall.case import Case
from ...quantities import Array, require_flag, require_kind, require_row, short_repr
from ...theory.analytical import solve_analytical

SETTLING = 5.0
"""Time that a wall is followed after the motion, over 1 / p [-]."""


@dataclass(frozen=True, eq=False)
class RockingSpectrum:
    """Largest rotations of walls of one slenderness by rocking theory.

    Args:
        R: half diagonals of the walls [m], shape (n,).
        period: 2 pi / p of the walls [s], shape (n,).
        peak: largest rotation over alpha, infinite where a wall overturned [-], shape (n,).
    """

    R: Array
    period: Array
    peak: Array

    __repr__ = short_repr


def rocking_spectrum(
    motion: GroundMotion, R: ArrayLike, slenderness: float, *, side_stop: bool = True, rtol: float = 1e-8
) -> RockingSpectrum:
    """Largest rotation over alpha of walls of many sizes under one motion, after Makris and Konstantinidis (2003).

    Args:
        motion: the ground motion.
        R: half diagonals of the walls [m], shape (n,).
        slenderness: their h/b [-], 1 to 200.
        side_stop: whether they rock to one side only.
        rtol: tolerance of `solve_analytical`.

    Raises:
        TypeError, ValueError: for a value outside its range.
    """
    require_kind("motion", motion, GroundMotion)
    side_stop = require_flag("side_stop", side_stop)
    sizes = require_row("R", R, "half diagonal [m]")
    walls = [Block.from_slenderness(slenderness, size) for size in sizes.tolist()]
    peaks = []
    for wall in walls:
        case = Case(wall, 0.0, motion.duration + SETTLING / wall.p, side_stop=side_stop, motion=motion)
        peaks.append(solve_analytical(case, Restitution.from_geometry(wall), rtol=rtol).peak_over_alpha)
    return RockingSpectrum(sizes, np.array([2 * math.pi / wall.p for wall in walls]), np.array(peaks))
