"""Random masonry for the search for trouble: columns, arches, walls in bond and heaps, at rest, shaken and kicked."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

import mjrock as mr

UNPAID = 0.03
"""Most energy that the ledger may have too much before a block falls, over what was released and put in."""
STOPPED = 5
"""Samples after which the joints have stopped what a kick asks of them against friction. The ledger counts the energy
of such a kick to first order in the step."""


@dataclass(frozen=True)
class Structure:
    """Masonry and what moves it, by the numbers that were drawn.

    Args:
        kind: "column", "arch", "bond" or "heap".
        count: blocks, voussoirs or courses.
        shape: slenderness of the column, t/R of the arch, or length over height of the units [-].
        size: height, radius or length of the structure [m].
        k_n, friction, xi, points: of the joints.
        shake: peak of one sine of the ground over g [-].
        period: of that sine [s].
        kick: standard deviation of the velocities at the release [m/s, rad/s].
        seed: of the kicks, and of the widths of a heap.
    """

    kind: str
    count: int
    shape: float
    size: float
    k_n: float
    friction: float
    xi: float
    points: int
    shake: float
    period: float
    kick: float
    seed: int

    def make(self) -> mr.MasonryCase:
        """The case.

        Raises:
            ValueError: for a value out of range.
        """
        rng = np.random.default_rng(self.seed)
        joints: dict[str, Any] = {"k_n": self.k_n, "friction": self.friction, "xi": self.xi, "points": self.points}
        if self.kind == "column":
            block = mr.Block.from_size(self.size / self.shape, max(self.size / self.count, self.size / self.shape))
            masonry = mr.Masonry.stack([block] * self.count, **joints)
        elif self.kind == "arch":
            masonry = mr.Masonry.arch(self.size, self.shape * self.size, 0.5 * math.pi + 1.0, self.count, **joints)
        elif self.kind == "bond":
            unit = (self.size / 3, self.size / 3 / self.shape)
            masonry = mr.Masonry.running_bond(self.size, self.count * unit[1], unit, 0.3, **joints)
        else:
            masonry = mr.Masonry(tuple(heap(rng, self.count, self.size)), **joints)
        velocity = rng.normal(0, self.kick, (len(masonry.free), 3)) if self.kick else None
        motion = mr.GroundMotion.sine(self.shake * mr.GRAVITY, self.period) if self.shake else None
        return mr.MasonryCase(masonry, 1.5, motion, velocity=velocity)


def heap(rng: np.random.Generator, count: int, size: float) -> list[mr.Polygon]:
    """Trapezia of random widths one on the other, shifted at random, on fixed ground."""
    blocks = [mr.Polygon([(-9 * size, -size), (9 * size, -size), (9 * size, 0), (-9 * size, 0)], fixed=True)]
    z = middle = 0.0
    for _ in range(count):
        low, high, tall = rng.uniform(0.3, 1.0, 3) * size
        middle += rng.uniform(-0.1, 0.1) * size
        corners = [(-low, z), (low, z), (high, z + tall), (-high, z + tall)]
        blocks.append(mr.Polygon([(middle + x, height) for x, height in corners]))
        z += tall
    return blocks


def draw(rng: np.random.Generator) -> Structure:
    """Random masonry."""

    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(math.log(low), math.log(high))))

    kind = str(rng.choice(["column", "arch", "bond", "heap"]))
    count = {"column": (1, 9), "arch": (3, 20), "bond": (1, 4), "heap": (1, 5)}[kind]
    shape = {"column": (3.0, 12.0), "arch": (0.08, 0.4), "bond": (1.0, 3.0), "heap": (1.0, 1.0)}[kind]
    return Structure(
        kind=kind,
        count=int(rng.integers(*count)),
        shape=between(*shape),
        size=between(0.2, 8.0),
        k_n=between(1e8, 1e11),
        friction=float(rng.choice([rng.uniform(0.3, 1.0), 0.0, 3.0], p=[0.8, 0.1, 0.1])),
        xi=float(rng.choice([between(1e-3, 1.0), 0.0], p=[0.85, 0.15])),
        points=int(rng.choice([2, 2, 3, 5])),
        shake=float(rng.choice([0.0, between(0.05, 1.5)], p=[0.3, 0.7])),
        period=between(0.1, 1.2),
        kick=float(rng.choice([0.0, between(1e-3, 1.0)], p=[0.6, 0.4])),
        seed=int(rng.integers(1 << 30)),
    )


def broken_promise(structure: Structure) -> str | None:
    """What is wrong with the run of a structure, or None. One that is refused with a reason is not wrong."""
    try:
        run = mr.simulate(structure.make(), ledger=True)
    except ValueError as refused:
        known = ("cannot stand", "no pose of rest", "valid range", "no joint that a motion could compress")
        return None if any(words in str(refused) for words in known) else str(refused)
    except mr.SimulationError as error:
        return str(error)
    if not (np.isfinite(run.pose).all() and np.isfinite(run.energy).all()):
        return "the motion is not finite"
    assert run.ledger is not None
    standing = run.t < min(run.fallen.values(), default=math.inf)
    scale = float(run.energy[0]) + float(np.abs(np.diff(run.ledger.ground[standing])).sum()) + run.ledger.elastic[0]
    residual = run.ledger.residual - (run.ledger.residual[STOPPED] if structure.kick else 0.0)
    unpaid = float(residual[standing][STOPPED:].max(initial=0.0)) / scale
    if unpaid > UNPAID:
        return f"the ledger has {unpaid:.2%} of the energy there was too much"
    still = structure.shake == 0 and structure.kick == 0
    if still and (run.fallen or run.sliding.max() > 1e-4):
        return f"left alone, it slid by {run.sliding.max():.3g} m, and {len(run.fallen)} blocks fell"
    return None
