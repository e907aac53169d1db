"""What is read from the joints of masonry in a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..quantities import Array


@dataclass(frozen=True, eq=False)
class JointMotion:
    """What is read from the motion of masonry.

    Args:
        opening: largest gap of each joint [m], shape (joints,).
        sliding: largest distance by which each joint has slid from rest, at its most pressed line [m], shape (joints,).
        fallen: when each block that fell did [s], by its name, the first first. A block has fallen when no joint that
            holds connects it with a fixed block any more, or when its centroid has dropped by its size. A joint no
            longer holds when it has opened by 0.7 of its width, or when one block has slid off the other.
    """

    opening: Array
    sliding: Array
    fallen: Mapping[str, float]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, JointMotion):
            return NotImplemented
        same = all(np.array_equal(getattr(self, name), getattr(other, name)) for name in ("opening", "sliding"))
        return same and dict(self.fallen) == dict(other.fallen)

    __hash__ = None  # type: ignore[assignment]
