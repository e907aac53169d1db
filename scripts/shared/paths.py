"""Two runs of the same record: until when they follow the same path, and how their peaks compare before and after."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from scipy.spatial.transform import Rotation

import mjrock as mr
from mjrock.quantities import Array

OVERTURNED = 0.5
"""Rotation of a block beyond which a run has overturned [rad]."""
PARTED = 2e-3
"""Difference of a rotation at which two paths have parted [rad]."""
SAMPLE = 2e-3
"""Spacing of the samples [s]."""


@dataclass(frozen=True)
class Path:
    """Rotations until a block has overturned [rad], shape (n, rotations), tilts, (n, blocks), and whether one has.

    In the plane a block has one rotation, of which the tilt is the size. In space it has the three of a rotation
    vector.
    """

    rotation: Array
    tilt: Array
    overturns: bool

    @property
    def peak(self) -> float:
        """Largest tilt [rad], infinite of a run that overturns."""
        return math.inf if self.overturns else float(self.tilt.max())


def path_of(answer: mr.Response) -> Path:
    """The part of an answer that counts."""
    if answer.pose.shape[2] == 3:
        rotation = answer.pose[:, :, 2]
        tilt = np.abs(rotation)
    else:
        turns = Rotation.from_quat(np.roll(answer.pose[:, :, 3:], -1, axis=2).reshape(-1, 4))
        rotation, tilt = turns.as_rotvec().reshape(len(answer.pose), -1), answer.tilt
    over = (tilt > OVERTURNED).any(axis=1)
    end = max(1, int(over.argmax()) if over.any() else len(tilt))
    return Path(rotation[:end], tilt[:end], bool(over.any()) or bool(answer.fallen))


def apart(one: Path, other: Path) -> Array:
    """Largest difference of a rotation [rad] for as long as both are followed, shape (n,)."""
    count = min(len(one.rotation), len(other.rotation))
    difference: Array = np.abs(one.rotation[:count] - other.rotation[:count]).max(axis=1)
    return difference


class Parting(NamedTuple):
    """When two paths part [s], infinite if they do not; until then the peak of the one [rad], over that of the other
    [-]."""

    when: float
    peak: float
    ratio: float


def parting(one: Path, other: Path) -> Parting:
    """Until when two runs follow the same path."""
    parted = apart(one, other) > PARTED
    end = int(parted.argmax()) if parted.any() else len(parted)
    peak, reference = (float(path.tilt[: max(1, end)].max()) for path in (one, other))
    return Parting(end * SAMPLE if parted.any() else math.inf, peak, peak / max(reference, 1e-12))


@dataclass(frozen=True)
class Pairs:
    """One way to run some records against another way.

    Args:
        parts: when the paths of each record part [s], infinite where they do not.
        peaks: of the one until then [rad].
        before: ratio of the peaks until then.
        stand: ratio of the peaks of the records under which neither overturns.
        overturn: how many overturn in the one and in the other.
        alone: how many of them do so in the one alone, and in the other alone.
    """

    parts: Array
    peaks: Array
    before: Array
    stand: Array
    overturn: tuple[int, int]
    alone: tuple[int, int]


def pairs_of(runs: Sequence[dict[str, Path]], name: str, other: str) -> Pairs:
    """What tells two ways to run the same records apart."""
    pairs = [(paths[name], paths[other]) for paths in runs]
    parts, peaks, before = np.array([parting(*pair) for pair in pairs]).T
    ends = np.array([[path.overturns for path in pair] for pair in pairs])
    first, second = ends.sum(axis=0)
    both = int(ends.all(axis=1).sum())
    stand = np.array([a.peak / b.peak for a, b in pairs if not (a.overturns or b.overturns)])
    return Pairs(parts, peaks, before, stand, (int(first), int(second)), (int(first) - both, int(second) - both))


def draw_square(ax: Axes, low: float, edge: float) -> None:
    """Logarithmic axes of peaks against peaks from `low`, with the line of equal ones, grey beyond the `edge`."""
    ax.plot([low, edge], [low, edge], color="0.6", linewidth=0.8, zorder=0)
    for draw in (ax.axvspan, ax.axhspan):
        draw(edge, 2 * edge, color="0.92", zorder=-1)
    ax.set(xscale="log", yscale="log", xlim=(low, 2 * edge), ylim=(low, 2 * edge))
