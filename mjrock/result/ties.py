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


def plastic_of(scene: Scene, **columns: Array) -> dict[str, Plastic]:
    """Plastic elongation and energy of each link of a scene, from the fields of `Plastic`, shape (links,) each. Its
    `start` follows from the scene.
    """
    links = scene.links.sprung
    columns["start"] = scene.ties.reach - links.law["reach"]
    rows = ({field: float(column[i]) for field, column in columns.items()} for i in range(len(links.names)))
    return {name: Plastic(**row) for name, row in zip(links.names, rows, strict=True)}


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


def _motion(moving: BodyMotion, tie: Anchored, at_end: Plastic | None) -> TieMotion:
    elongation, law, t = elongation_of(moving, tie), tie.law, moving.t
    before = 0.0 if at_end is None else at_end.before
    if law.push > 0:
        elongation = elongation - (0.0 if at_end is None else at_end.start)
        plastic = law.plastic_elongation(elongation, before)
        force = law.k * (elongation - plastic)
        return TieMotion(elongation, plastic, force, float(np.abs(force).max()), math.inf)
    broken = math.inf if at_end is None else at_end.broken
    pulls = t < broken
    plastic = np.minimum(law.plastic_elongation(elongation, before), law.ultimate)
    if broken < math.inf:
        plastic = np.where(pulls, plastic, law.ultimate)
    force = np.where(pulls, np.clip(law.k * (elongation - plastic), 0.0, law.strength), 0.0)
    elongation = np.where(pulls, np.maximum(elongation, plastic), np.nan)
    spent = broken < math.inf or (at_end is not None and at_end.elongation > 0)
    return TieMotion(elongation, plastic, force, law.strength if spent else float(force.max()), broken)


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
    moved, anchor_moved = (moving.displaced(link_end.block, link_end.point[None])[:, 0] for link_end in (end, anchor))
    return np.asarray(end.point - anchor.point + moved - anchor_moved)


def ties_message(plastic: Mapping[str, Plastic]) -> str:
    """Which ties broke, and when, as sentences after a message; an empty text where none did."""
    broken = sorted((tie.broken, name, tie) for name, tie in plastic.items() if tie.broken < math.inf)
    return "".join(
        f" {name} broke {f'at {when:.4g} s' if when >= 0 else 'before'}, drawn out by {1e3 * tie.elongation:.3g} mm."
        for when, name, tie in broken
    )


def overdrawn(tie: Anchored, plastic: Plastic) -> bool:
    """Whether a tie that never breaks was drawn out beyond PLAUSIBLE of its length."""
    return tie.law.holds and tie.law.ultimate == math.inf and plastic.elongation > PLAUSIBLE * tie.span


def warn_of_ties(case: AnyCase, plastic: Mapping[str, Plastic]) -> None:
    """Warn of ties without an `ultimate` that were drawn out beyond PLAUSIBLE of their length."""
    for name, yielded in plastic.items():
        length = case.links[name].span
        if overdrawn(case.links[name], yielded):
            warn_of(
                f"{name} was drawn out by {1e3 * yielded.elongation:.3g} mm, {yielded.elongation / length:.1%} of its "
                f"length of {length:g} m. A steel bar breaks at some {PLAUSIBLE:.0%}, and an anchor plate follows "
                "less; give the tie the elongation up to which it holds as ultimate"
            )
