"""The curve of a mechanism that the kinematic check needs: of a wall that overturns or bends, or of masonry."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple, cast

import numpy as np

from ...problem.masonry.case import AnyCase, MasonryCase, require_wall
from ...problem.masonry.limit.collapse import Collapse
from ...problem.masonry.masonry import Masonry
from ...problem.wall.bending import HorizontalBending, VerticalBending
from ...problem.wall.case import Case
from ...problem.wall.effect import Anchored
from ...problem.wall.effects import link_effects
from ...problem.wall.restoring_moment import moment_at_strength
from ...problem.wall.wedge import Corner
from ...quantities import GRAVITY, Array, Implausible, warn_of
from .code import Code
from .limit_analysis import MOVED, WEAKER, LimitCurve, collapse_multiplier
from .moving_part import MovingPart, multiplier_of
from .pushover import falls_to_zero, pushover

Checked = Case | Corner | VerticalBending | HorizontalBending | LimitCurve
"""What a kinematic check takes."""


def case_of(problem: Checked | AnyCase | Collapse) -> AnyCase:
    """The case that stands for a mechanism where it is run: of a corner its wall and masses, of a wall that bends the
    wall, of limit analysis its masonry and effects."""
    if isinstance(problem, Corner):
        return problem.case
    if isinstance(problem, VerticalBending | HorizontalBending):
        return Case(problem.wall)
    collapse = problem.start if isinstance(problem, LimitCurve) else problem
    if not isinstance(collapse, Collapse):
        return collapse
    if collapse.masonry is not None:
        return MasonryCase(collapse.masonry, 1.0, effects=collapse.effects)
    assert collapse.case is not None
    return collapse.case


class MechanismCurve(NamedTuple):
    """The spectral displacements of a mechanism with what it bears at each.

    Args:
        multiplier: along the curve [-], shape (n,).
        d: spectral displacements [m], shape (n,), C8.7.1.4.
        participation: e* [-], C8.7.1.5.
        tied: multiplier that starts it with the ties at their strength [-]; None without ties.
        yielding, breaking: displacement at which each tie yields and breaks [m], by name.
        slack: multiplier that starts it with the ties slack [-], where it is not the first of the curve.
        moving: names of the blocks that move.
        ended: why the curve ends where something is borne; empty where nothing is.
    """

    multiplier: Array
    d: Array
    participation: float
    tied: float | None = None
    yielding: Mapping[str, float] = MappingProxyType({})
    breaking: Mapping[str, float] = MappingProxyType({})
    slack: float | None = None
    moving: tuple[str, ...] = ()
    ended: str = ""


def curve_of(case: Checked, code: Code) -> MechanismCurve:
    """The curve of the mechanism of a case, a corner, a bending or a limit curve."""
    if isinstance(case, VerticalBending | HorizontalBending):
        return _curve_of_bending(case)
    if isinstance(case, LimitCurve):
        return _curve_of_blocks(case, code)
    return _curve_of_wall(cast(Case, case_of(case)), code)


def _curve_of_bending(bending: VerticalBending | HorizontalBending) -> MechanismCurve:
    """A wall between floors or side walls. The curve is that of the common centroid, and d is its displacement over e*
    then, by C8.7.1.4 and C8.7.1.5."""
    curve, participation = bending.curve, bending.participation
    return MechanismCurve(curve.multiplier, curve.displacement / participation, participation)


class PartCurve(NamedTuple):
    """The curve of the part of masonry that moves, up to where nothing is borne or the curve ends.

    Args:
        part: what moves.
        masonry: it and the rest.
        displacement: of its centroid [m], shape (n,).
        multiplier: [-], shape (n,), zero at the last where nothing is borne.
        along: displacement of the limit curve at each [m], shape (n,).
    """

    part: MovingPart
    masonry: Masonry
    displacement: Array
    multiplier: Array
    along: Array

    @classmethod
    def from_curve(cls, name: str, curve: LimitCurve) -> PartCurve:
        """That of a limit curve.

        Raises:
            ValueError: if it has loads, has no mechanism, or bears nothing.
        """
        masonry, borne = curve.start.masonry, curve.multiplier
        if curve.start.loads:
            raise ValueError(f"{name} = {curve!r} has loads; the check is of a horizontal force: give them as effects")
        if masonry is None or not curve.start.moving or not borne[0] > 0:
            raise ValueError(f"{name} = {curve!r} has no mechanism: nothing gives way, or nothing is borne")
        part = MovingPart.from_collapse(curve.start, masonry, curve.effects)
        moved, along = part.displacement(masonry, curve.pose), curve.displacement
        if borne[-1] > 0:
            return cls(part, masonry, moved, borne, along)
        last = int(np.flatnonzero(borne <= 0)[0])
        ends = (falls_to_zero(path[: last + 1], borne[: last + 1]) for path in (moved, along))
        moved, along = (np.append(path[:last], end) for path, end in zip((moved, along), ends, strict=True))
        return cls(part, masonry, moved, np.append(borne[:last], 0.0), along)

    @property
    def is_whole(self) -> bool:
        """Whether it goes on until nothing is borne."""
        return bool(self.multiplier[-1] == 0)


def _curve_of_blocks(curve: LimitCurve, code: Code) -> MechanismCurve:
    """Masonry of blocks, up to where nothing is borne, or where the mechanism cannot go on."""
    moving = PartCurve.from_curve("case", curve)
    part, d = moving.part, moving.displacement / moving.part.participation
    alpha_0 = multiplier_of(curve.start, moving.masonry, curve.effects)
    if not moving.is_whole:
        _require_some(curve, float(d[-1]), alpha_0, part.participation)
    pulled = any(link.law.holds for link in link_effects(curve.effects).values())
    yielding, breaking = (
        {tie: float(np.interp(at, moving.along, d)) for tie, at in ties.items() if at <= moving.along[-1]}
        for ties in curve.ties
    )
    last, rule = list(code.states.items())[-1]
    capacity = rule.share * float(d[-1])
    if _stands_by_ties(curve, moving.masonry, int(np.searchsorted(d, capacity))):
        _warn_of_ties(link_effects(curve.effects), f"d_{last}", capacity, None, breaking)
    return MechanismCurve(
        multiplier=moving.multiplier,
        d=d,
        participation=part.participation,
        tied=float(moving.multiplier[0]) if pulled else None,
        yielding=yielding,
        breaking=breaking,
        slack=alpha_0,
        moving=part.names,
        ended="" if moving.is_whole else curve.ended,
    )


def _require_some(curve: LimitCurve, d: float, alpha_0: float, participation: float) -> None:
    """Warn of a curve that ends at d [m] while something is borne. Raises a ValueError if it begins there."""
    if curve.ended.startswith(MOVED):
        raise ValueError(f"case = {curve!r} ends at the argument to, where it still bears something; leave out to")
    if d <= 0:
        raise ValueError(
            f"case = {curve!r} ends as it begins. Of it the linear check alone can be made, with alpha_0 = "
            f"{alpha_0:.4g} and e* = {participation:.4g}; check the limit states by runs, dynamic_check(runs, "
            "curve=push(masonry, direction, to))"
        )
    warn_of(
        f"case ends at d = {d:.4g} m, where {curve.multiplier[-1]:.4g} of the weight is borne: {curve.ended}; "
        "the check takes that for d_0, and counts nothing beyond",
        Implausible,
    )


def _curve_of_wall(case: Case, code: Code) -> MechanismCurve:
    """A wall that overturns, with its ties. Raises a ValueError if they hold it for good."""
    require_wall("case", case, "mr.limit_curve(masonry, direction)")
    curve = pushover(case)
    if not math.isfinite(curve.end):
        raise ValueError("case has a push-over curve that does not end: its ties hold the wall; give them a strength")
    warn_of_inner_edge(case, float(curve.multiplier[0]))
    wall = case.wall
    weights, heights = _masses(case)
    first, second = float(weights @ heights), float(weights @ heights**2)
    moved = wall.pose(curve.rotation)[:, 0]  # of the control point, the centroid
    d = moved * second / (wall.centroid_height * first)
    without_ties = float(wall.pose(np.array([max(case.restoring.outer.alpha, 0.0)]))[0, 0] * d[-1] / moved[-1])
    yielding, breaking = (
        {tie: float(np.interp(at, curve.rotation, d)) for tie, at in ties.items()} for ties in curve.ties
    )
    last, rule = list(code.states.items())[-1]
    _warn_of_ties(case.springs, f"d_{last}", rule.share * float(d[-1]), without_ties, breaking)
    tied = None
    if case.pulls:
        tied = float(curve.multiplier[0]) + moment_at_strength(case.pulls) / (wall.weight * wall.centroid_height)
    participation = first**2 / (float(weights.sum()) * second)
    return MechanismCurve(curve.multiplier, d, participation, tied=tied, yielding=yielding, breaking=breaking)


def warn_of_inner_edge(case: Case, outwards: float) -> None:
    """Warn of a wall that is free both ways and starts inwards at a lower multiplier than it bears outwards [-]."""
    inner = case.restoring.inner.P / (case.wall.weight * case.wall.centroid_height)
    if case.lopsided and inner < (1 - WEAKER) * outwards:
        warn_of(
            f"case has side_stop=False, and the check is of the way outwards, with {outwards:.4g} g; inwards "
            f"the wall starts at {inner:.4g} g: check that way too, with the mirrored wall: the other plumb, "
            "offsets and forces with the other sign",
            Implausible,
        )


def _warn_of_ties(
    springs: Mapping[str, Anchored],
    name: str,
    capacity: float,
    without_ties: float | None,
    breaking: Mapping[str, float],
) -> None:
    """Warn of ties that still hold at the largest displacement capacity, where they raise it.

    Args:
        springs: the ties, by name.
        name: of the capacity, such as d_SLC of NTC 2018.
        capacity: the largest of the limit states [m].
        without_ties: displacement at which the curve without ties ends [m]; None where it is less than the capacity.
        breaking: displacement at which each tie breaks [m], by name.
    """
    holding = [
        f"{tie} (ultimate = {f'{spring.law.ultimate:g} m' if spring.law.ultimate < math.inf else None})"
        for tie, spring in springs.items()
        if breaking.get(tie, math.inf) > capacity
    ]
    if holding and (without_ties is None or capacity > without_ties):
        ended = "lies where the curve without ties has ended"
        if without_ties is not None:
            ended = f"is more than {without_ties:.3g} m, at which the curve without ties ends"
        warn_of(
            f"{name} = {capacity:.3g} m {ended}: {', '.join(holding)} would still hold there; say by `ultimate` how "
            "far a tie can be drawn out [m]",
            Implausible,
        )


def _stands_by_ties(curve: LimitCurve, masonry: Masonry, at: int) -> bool:
    """Whether masonry in a pose of its limit curve bears nothing without its ties."""
    if not (springs := link_effects(curve.effects)):
        return False
    others = [effect for effect in curve.effects if effect not in springs.values()]
    push = curve.start.direction
    direction = push[:2] if masonry.in_space else float(push[0])
    try:
        return collapse_multiplier(masonry, direction, effects=others, pose=curve.pose[at]).multiplier <= 0
    except ValueError:
        return False


def _masses(case: Case) -> tuple[Array, Array]:
    """Weights [N] and heights [m] of the wall and of the masses that the case adds to it."""
    added = [effect for effect in case.effects if effect.mass_added]
    weights = [case.block.mass, *(effect.mass_added for effect in added)]
    heights = [case.block.centroid_height, *(effect.height for effect in added)]
    return GRAVITY * np.array(weights), np.array(heights)
