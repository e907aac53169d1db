"""What is read from the joints of masonry in a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..quantities import Array


@dataclass(frozen=True, eq=False)
class JointMotion:
    """What is read from the motion of masonry.

    Args:
        opening: largest gap of each joint [m], shape (joints,). Fixed blocks are where supports have moved them.
        sliding: largest distance by which each joint has slid from rest, at its most pressed line [m], shape (joints,).
        fallen: when each block that fell did [s], by its name, the first first. A block has fallen when, as the run
            ends, it is tilted by more than 45 degrees, as one is that rolls over an edge, or no joint that holds
            connects it with a fixed block and it lies lower than at rest by more than half its height. A joint holds
            nothing where one block has slid by more than its width, or where its faces are apart by more than a tenth
            of its width at the nearest point. In MuJoCo, where faces have no end, a block that has slid off its joints
            counts as fallen at once.
        cracked: when each mortared joint that cracked did [s], by its name, the first first. A joint has cracked when
            all its lines have less than half of their bond.
    """

    opening: Array
    sliding: Array
    fallen: Mapping[str, float]
    cracked: Mapping[str, float] = field(default_factory=dict)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, JointMotion):
            return NotImplemented
        same = all(np.array_equal(getattr(self, name), getattr(other, name)) for name in ("opening", "sliding"))
        return same and dict(self.fallen) == dict(other.fallen) and dict(self.cracked) == dict(other.cracked)

    __hash__ = None  # type: ignore[assignment]
