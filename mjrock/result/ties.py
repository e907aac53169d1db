"""The motion of ties: their elongation, their force, and when they broke."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..problem.masonry.case import AnyCase
from ..problem.wall.effect import Anchored
from ..quantities import Array, warn_of
from ..scene.scene import Scene
from .bodies import BodyMotion

PLAUSIBLE = 0.05
"""Share of its length up to which a tie may yield before that is warned of [-]: the characteristic strain at the
greatest force of reinforcing steel of class B, EN 1992-1-1, Table C.1. Anchorages in masonry follow less."""


class Plastic(NamedTuple):
    """How far a tie has yielded by the end of a run, and whether it has broken.

    Args:
        elongation: plastic elongation, also of the runs that this one carries on [m].
        energy: the energy that it took in this run [J].
        broken: when the tie broke [s], negative before this run, infinite for one that did not.
        lost: the elastic energy that it lost as it broke in this run [J].
        before: by how much its slider had moved when this run began [m].
        start: elongation at which it bears nothing at rest [m], of a link that is put in when the wall stands.
    """

    elongation: float
    energy: float
    broken: float = math.inf
    lost: float = 0.0
    before: float = 0.0
    start: float = 0.0


def plastic_of(scene: Scene, *columns: Array, before: Array | float = 0.0) -> dict[str, Plastic]:
    """Plastic elongation and energy of each link of a scene, from the fields of `Plastic` in their order, shape
    (links,) each. Its `start` follows from the scene.
    """
    links = scene.links.sprung
    starts = scene.ties.reach - links.law["reach"]
    rows = zip(links.names, *columns, np.broadcast_to(before, starts.shape), starts, strict=True)
    return {name: Plastic(*map(float, values)) for name, *values in rows}


@dataclass(frozen=True, eq=False)
class TieMotion:
    """A tie, or another link with a spring, at the samples of a response.

    Args:
        elongation: beyond its slack, with what has yielded; zero where the tie is slack for the first time, NaN once it
            has broken [m], shape (n,).
        plastic: the part that has yielded [m], shape (n,).
        force: its tension, zero once it has broken [N], shape (n,). A link that also pushes has a negative one then,
            and its elongation and its plastic part are those from rest, of either sign.
        largest_force: the largest force [N]: that among the samples, or the strength where it has yielded or broken.
        broken: when it broke [s], infinite for one that did not.
    """

    elongation: Array
    plastic: Array
    force: Array
    largest_force: float
    broken: float


def motion_of_ties(moving: BodyMotion, plastic: Mapping[str, Plastic]) -> dict[str, TieMotion]:
    """The ties of a case where its bodies are."""
    return {name: _motion(moving, tie, plastic.get(name)) for name, tie in moving.case.springs.items()}


def _motion(moving: BodyMotion, tie: Anchored, ended: Plastic | None) -> TieMotion:
    elongation, law, t = elongation_of(moving, tie), tie.law, moving.t
    before = 0.0 if ended is None else ended.before
    if law.push > 0:
        elongation = elongation - (0.0 if ended is None else ended.start)
        drawn = law.drawn(elongation, before)
        force = law.k * (elongation - drawn)
        return TieMotion(elongation, drawn, force, float(np.abs(force).max()), math.inf)
    broken = math.inf if ended is None else ended.broken
    pulls = t < broken
    drawn = np.minimum(law.drawn(elongation, before), law.ultimate)
    if broken < math.inf:
        drawn = np.where(pulls, drawn, law.ultimate)
    force = np.where(pulls, np.clip(law.k * (elongation - drawn), 0.0, law.strength), 0.0)
    elongation = np.where(pulls, np.maximum(elongation, drawn), np.nan)
    spent = broken < math.inf or (ended is not None and ended.elongation > 0)
    return TieMotion(elongation, drawn, force, law.strength if spent else float(force.max()), broken)


def elongation_of(moving: BodyMotion, tie: Anchored) -> Array:
    """How much longer than its slack length a tie is where bodies are [m], negative where it is slack, shape (n,)."""
    return np.asarray(np.linalg.norm(link_vector(moving, tie), axis=1) - tie.law.reach)


class LinkEnd(NamedTuple):
    """An end of a link: the number of its block, None of the ground, and the point at rest [m], shape (d,)."""

    block: int | None
    point: Array


def link_ends(case: AnyCase, link: Anchored) -> tuple[LinkEnd, LinkEnd]:
    """The point that a link holds, and its anchor."""
    held = case.held_by(link)
    return LinkEnd(link.block, held), LinkEnd(link.anchor_block, link.anchor_of(held))


def link_vector(moving: BodyMotion, tie: Anchored) -> Array:
    """Vector from the anchor of a link to its other end in a motion [m], shape (n, d)."""
    end, anchor = link_ends(moving.case, tie)
    own, of_anchor = (moving.displaced(link_end.block, link_end.point[None])[:, 0] for link_end in (end, anchor))
    return np.asarray(end.point - anchor.point + own - of_anchor)


def ties_message(plastic: Mapping[str, Plastic]) -> str:
    """Which ties broke, and when, as sentences after a message; an empty text where none did."""
    broken = sorted((tie.broken, name, tie) for name, tie in plastic.items() if tie.broken < math.inf)
    return "".join(
        f" {name} broke {f'at {when:.4g} s' if when >= 0 else 'before'}, drawn out by {1e3 * tie.elongation:.3g} mm."
        for when, name, tie in broken
    )


def overdrawn(tie: Anchored, drawn: Plastic) -> bool:
    """Whether a tie that never breaks was drawn out beyond PLAUSIBLE of its length."""
    return tie.law.holds and tie.law.ultimate == math.inf and drawn.elongation > PLAUSIBLE * tie.span


def warn_of_ties(case: AnyCase, plastic: Mapping[str, Plastic]) -> None:
    """Warn of ties without an `ultimate` that were drawn out beyond PLAUSIBLE of their length."""
    for name, drawn in plastic.items():
        length = case.links[name].span
        if overdrawn(case.links[name], drawn):
            warn_of(
                f"{name} was drawn out by {1e3 * drawn.elongation:.3g} mm, {drawn.elongation / length:.1%} of its "
                f"length of {length:g} m. A steel bar breaks at some {PLAUSIBLE:.0%}, and an anchor plate follows "
                "less; give the tie the elongation up to which it holds as ultimate"
            )
