"""What a solver returns for masonry: the motion of its blocks, what their joints did, and which blocks fell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..problem.joints import Joint
from ..problem.masonry import Masonry
from ..problem.masonry_case import MasonryCase
from ..problem.quantities import Array, Flags
from .ledger import Ledger
from .response import Outcome, Plastic, State

LOST = 0.7
"""Opening of a joint, over its width, beyond which it holds no longer [-]: the blocks have turned by 45 degrees."""
DROPPED = 1.0
"""Drop of a centroid, over the largest distance of a corner from it, beyond which a block has fallen [-]."""
SHOWN = 5
"""Most blocks that a message names."""


@dataclass(frozen=True, eq=False, repr=False)
class MasonryResponse:
    """The motion of masonry that a solver found. Bodies are the blocks that are not fixed, in order.

    Args:
        case: what was asked.
        solver: which solver answered.
        t: times [s], shape (n,).
        pose: displacement x, z of each centroid from the undeformed joints [m] and rotation theta [rad], shape
            (n, bodies, 3). The rotation is positive where the top of a block turns to the right.
        velocity: its rate [m/s, m/s, rad/s], shape (n, bodies, 3).
        energy: kinetic, potential and elastic energy above the masonry at rest [J], shape (n,).
        opening: largest gap of each joint [m], shape (joints,).
        sliding: largest distance by which each joint has slid from rest, at its most pressed line [m], shape (joints,).
        fallen: when each block that fell did [s], by its name, the first first. A block has fallen when no joint that
            holds connects it with a fixed block any more, or when its centroid has dropped by its size. A joint no
            longer holds when it has opened by 0.7 of its width, or when one block has slid off the other.
        outcome: how the run ended. Masonry has overturned when a block has fallen.
        message: the same in words, for the user.
        ledger: every part of the energy, with the dashpots of each joint, or None where none was asked for.
        stats: what the run took, as in `Response`, and the deepest penetration of a line, `deepest` [m].
        end: pose and velocity at the end, shape (bodies, 3) each, to continue from with `simulate(..., start=...)`.
        plastic: what ties have yielded, by tie.
    """

    case: MasonryCase
    solver: str
    t: Array
    pose: Array
    velocity: Array
    energy: Array
    opening: Array
    sliding: Array
    fallen: Mapping[str, float]
    outcome: Outcome
    message: str
    ledger: Ledger | None = None
    stats: dict[str, Any] = field(default_factory=dict)
    end: State | None = None
    plastic: Mapping[str, Plastic] = field(default_factory=dict)

    @property
    def theta(self) -> Array:
        """Rotation of each block [rad], shape (n, bodies)."""
        return self.pose[:, :, 2]

    @property
    def omega(self) -> Array:
        """Angular velocity of each block [rad/s], shape (n, bodies)."""
        return self.velocity[:, :, 2]

    @property
    def peak(self) -> Array:
        """Largest |rotation| of each block [rad], shape (bodies,)."""
        peak: Array = np.abs(self.theta).max(axis=0)
        return peak

    @property
    def energy_residual(self) -> Array | None:
        """Closure error of the energy ledger [J], shape (n,), or None where none was asked for."""
        return None if self.ledger is None else self.ledger.residual

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MasonryResponse):
            return NotImplemented
        same, samples = ("case", "solver", "fallen", "outcome"), ("t", "pose", "velocity", "energy")
        return all(getattr(self, name) == getattr(other, name) for name in same) and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in samples
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return (
            f"<MasonryResponse of {self.solver}: {len(self.t)} samples over {self.t[-1]:.4g} s, "
            f"{self.pose.shape[1]} blocks, largest opening {self.opening.max(initial=0):.3g} m, "
            f"{len(self.fallen)} fallen, {self.outcome.value}>"
        )


def named(names: Sequence[str]) -> str:
    """Names in a message, not too many."""
    rest = len(names) - SHOWN
    return ", ".join(names[:SHOWN]) + (f" and {rest} more" if rest > 0 else "")


def fallen_blocks(masonry: Masonry, t: Array, lost: Flags, drop: Array) -> dict[str, float]:
    """When each block that fell did [s], by its name, the first first.

    Args:
        masonry: the masonry.
        t: times [s], shape (n,).
        lost: whether each joint has ceased to hold by then, shape (n, joints).
        drop: how far each free block has dropped from rest, over its size [-], shape (n, bodies).
    """
    gone: dict[int, float] = {}
    for body, block in enumerate(masonry.free):
        late = np.flatnonzero(drop[:, body] > DROPPED)
        if late.size:
            gone[block] = float(t[late[0]])
    for step in np.flatnonzero(np.diff(lost.sum(axis=1), prepend=0)):
        held = [joint for joint, over in zip(masonry.joints, lost[step], strict=True) if not over]
        for block in _cut_off(masonry, held):
            gone[block] = min(gone.get(block, np.inf), float(t[step]))
    return {masonry.names[block]: gone[block] for block in sorted(gone, key=gone.__getitem__)}


def _cut_off(masonry: Masonry, held: Sequence[Joint]) -> list[int]:
    """Blocks that no joint in `held` connects with a fixed block."""
    beside: dict[int, list[int]] = {}
    for joint in held:
        beside.setdefault(joint.below, []).append(joint.above)
        if not masonry.blocks[joint.below].fixed:
            beside.setdefault(joint.above, []).append(joint.below)
    reached = {i for i, block in enumerate(masonry.blocks) if block.fixed}
    waiting = list(reached)
    while waiting:
        new = [block for block in beside.get(waiting.pop(), []) if block not in reached]
        reached.update(new)
        waiting += new
    return [block for block in masonry.free if block not in reached]


def masonry_ending(fallen: Mapping[str, float], quiet: bool, t_end: float) -> tuple[Outcome, str]:
    """How a run ended, and the same in words."""
    if fallen:
        first = next(iter(fallen.values()))
        return Outcome.OVERTURNED, (
            f"{len(fallen)} blocks fell, the first at {first:.4g} s: {named(list(fallen))}. The motion was followed "
            f"for {t_end:.4g} s; contacts other than those of the joints at rest are not in the model."
        )
    if quiet:
        return Outcome.AT_REST, f"The masonry came to rest; last looked at {t_end:.4g} s."
    return Outcome.TIME_ENDED, f"The masonry was still moving when the asked {t_end:.4g} s ended."
