"""What ties did: how far they were drawn out, what they pulled, and when they broke."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..problem.masonry.case import MasonryCase
from ..problem.masonry.effects import laden, placed
from ..problem.wall.case import Case
from ..problem.wall.effect import Anchored
from ..quantities import Array
from ..scene.scene import Scene

PLAUSIBLE = 0.05
"""Share of its length up to which a tie may yield before that is warned of [-]: the characteristic strain at the
greatest force of reinforcing steel of class B, EN 1992-1-1, Table C.1. Anchorages in masonry follow less."""


class Plastic(NamedTuple):
    """How far a tie has yielded by the end of a run, and whether it has broken.

    Args:
        elongation: plastic elongation [m].
        energy: the energy that this took [J].
        broken: when the tie broke [s], infinite for one that did not.
        lost: the elastic energy that it lost as it broke [J].
        start: elongation at which it bears nothing at rest [m], of a link that is put in when the wall stands.
    """

    elongation: float
    energy: float
    broken: float = math.inf
    lost: float = 0.0
    start: float = 0.0


def plastic_of(scene: Scene, *columns: Array) -> dict[str, Plastic]:
    """What each link of a scene has yielded, from the fields of `Plastic` but `start`, shape (links,) each."""
    links = scene.links.sprung
    rows = zip(links.names, *columns, scene.ties.reach - links.reach, strict=True)
    return {name: Plastic(*map(float, values)) for name, *values in rows}


@dataclass(frozen=True, eq=False)
class TieMotion:
    """A tie, or another link with a spring, at the samples of a response.

    Args:
        elongation: beyond its slack, with what has yielded; zero where the tie is slack for the first time, NaN once it
            has broken [m], shape (n,).
        plastic: the part that has yielded [m], shape (n,).
        force: what it pulls with, zero once it has broken [N], shape (n,). A link that also pushes does so with a
            negative one, and its elongation and its plastic part are those from rest, of either sign.
        largest_force: the largest force [N]: that among the samples, or the strength where it has yielded or broken.
        broken: when it broke [s], infinite for one that did not.
    """

    elongation: Array
    plastic: Array
    force: Array
    largest_force: float
    broken: float

    @property
    def largest_elongation(self) -> float:
        """The largest elongation beyond the slack among the samples before it broke [m]."""
        return float(np.nanmax(np.abs(self.elongation), initial=0.0))


def motion_of_ties(
    case: Case | MasonryCase, t: Array, pose: Array, plastic: Mapping[str, Plastic]
) -> dict[str, TieMotion]:
    """The ties of a case, of a wall or of masonry, at poses as of a `Response` and times t [s]."""
    return {name: _motion(case, tie, t, pose, plastic.get(name)) for name, tie in case.springs.items()}


def _motion(case: Case | MasonryCase, tie: Anchored, t: Array, pose: Array, ended: Plastic | None) -> TieMotion:
    elongation, law = elongation_of(case, tie, t, pose), tie.law
    if law.push > 0:
        elongation = elongation - (0.0 if ended is None else ended.start)
        drawn = law.drawn(elongation)
        force = law.k * (elongation - drawn)
        return TieMotion(elongation, drawn, force, float(np.abs(force).max()), math.inf)
    broken = math.inf if ended is None else ended.broken
    pulls = t < broken
    drawn = np.minimum(law.drawn(elongation), law.ultimate)
    if broken < math.inf:
        drawn = np.where(pulls, drawn, law.ultimate)
    force = np.where(pulls, np.clip(law.k * (elongation - drawn), 0.0, law.strength), 0.0)
    elongation = np.where(pulls, np.maximum(elongation, drawn), np.nan)
    spent = broken < math.inf or (ended is not None and ended.elongation > 0)
    return TieMotion(elongation, drawn, force, law.strength if spent else float(force.max()), broken)


def elongation_of(case: Case | MasonryCase, tie: Anchored, t: Array, pose: Array) -> Array:
    """How much longer than its slack length a tie is at poses as of a `Response` [m], negative where it is slack.

    The times t [s] say where supports are, shape (n,).
    """
    return np.asarray(np.linalg.norm(across(case, tie, t, pose), axis=1) - tie.law.reach)


def across(case: Case | MasonryCase, tie: Anchored, t: Array, pose: Array) -> Array:
    """From the anchor of a link to the point that it holds at poses as in `elongation_of` [m], shape (n, d)."""
    held = held_by(case, tie)[1]
    anchor = tie.anchor_of(held)
    between = held - anchor + _displaced(case, tie.block, held, t, pose)
    if tie.anchor_block is not None:
        between = between - _displaced(case, tie.anchor_block, anchor, t, pose)
    return np.asarray(between)


def _displaced(case: Case | MasonryCase, block: int, point: Array, t: Array, pose: Array) -> Array:
    """Displacement of a point of a block from rest [m], shape (n, d); that of its support where the block is fixed."""
    if isinstance(case, Case):
        body, centroid = 0, np.array([case.wall.centroid_offset, case.wall.centroid_height])
    elif block not in case.masonry.free:
        name = case.masonry.names[block]
        still = np.zeros((len(t), len(point)))
        return next((support.at(t) for support in case.supports if support.block == name), still)
    else:
        body, centroid = case.masonry.free.index(block), laden(case.masonry, case.effects)[1][block]
    moved, arm = pose[:, body], point - centroid
    if len(arm) == 2:
        sine, cosine = np.sin(moved[:, 2]), np.cos(moved[:, 2]) - 1
        turned = np.column_stack([arm[0] * cosine + arm[1] * sine, arm[1] * cosine - arm[0] * sine])
        return np.asarray(moved[:, :2] + turned)
    w, v = moved[:, 3:4], moved[:, 4:]
    # (R - 1) r = 2 w v x r + 2 v x (v x r)
    turned = np.cross(v, np.broadcast_to(arm, v.shape))
    return np.asarray(moved[:, :3] + 2 * w * turned + 2 * np.cross(v, turned))


def held_by(case: Case | MasonryCase, tie: Anchored) -> tuple[int, Array, Array]:
    """The body that a tie holds, the point where it does and the centroid of the body, at rest [m]."""
    if isinstance(case, Case):
        wall = case.wall
        return 0, np.array([-case.block.b, tie.height]), np.array([wall.centroid_offset, wall.centroid_height])
    masonry, held = case.masonry, np.array(placed(case.masonry, tie))
    return masonry.free.index(tie.block), held, laden(masonry, case.effects)[1][tie.block]


def told_of_ties(plastic: Mapping[str, Plastic]) -> str:
    """Which ties broke, and when, as sentences after a message; nothing where none did."""
    broken = sorted((tie.broken, name, tie) for name, tie in plastic.items() if tie.broken < math.inf)
    return "".join(
        f" {name} broke at {when:.4g} s, drawn out by {1e3 * tie.elongation:.3g} mm." for when, name, tie in broken
    )


def overdrawn(tie: Anchored, drawn: Plastic) -> bool:
    """Whether a tie that never breaks was drawn out beyond PLAUSIBLE of its length."""
    return tie.law.holds and tie.law.ultimate == math.inf and drawn.elongation > PLAUSIBLE * tie.span


def warn_of_ties(case: Case | MasonryCase, plastic: Mapping[str, Plastic]) -> None:
    """Warn of ties without an `ultimate` that were drawn out beyond PLAUSIBLE of their length."""
    for name, drawn in plastic.items():
        length = case.links[name].span
        if overdrawn(case.links[name], drawn):
            warnings.warn(
                f"{name} was drawn out by {1e3 * drawn.elongation:.3g} mm, {drawn.elongation / length:.1%} of its "
                f"length of {length:g} m. A steel bar breaks at some {PLAUSIBLE:.0%}, and an anchor plate follows "
                "less; give the tie the elongation up to which it holds as ultimate",
                stacklevel=3,
            )
