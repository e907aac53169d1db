"""Damping matched to a stack: rocking as one, it loses at an impact what rocking theory says.

`docs/theory.md` says why it loses more on the damping that a law gives each joint.
"""

from __future__ import annotations

import dataclasses
import warnings

import numpy as np

from ...engine.simulation import simulate
from ...problem.damping.contacts import reference_frequency
from ...problem.damping.restitution import Restitution
from ...problem.masonry.case import MasonryCase
from ...problem.masonry.laws.joint_table import ByName
from ...problem.masonry.lines import Lines, lowest_frequency
from ...problem.masonry.masonry import Masonry
from ...problem.masonry.pile import Pile
from ...quantities import Array, require_kind, require_within
from ...result.response import Response
from ...theory.impact import as_one
from .contacts import TOUCH_DOWN
from .match import BASE_BOUNDS, SIDE_BOUNDS, Closest, highest_branch

STRONG_ABOVE = 4.0
"""Damping ratio of the joints above the base, in the lowest mode in which the stack bends over an edge of it [-]. From
1 on the stack does not vibrate, and from 4 on more changes the energy lost by less than 0.2 %."""
PLASTIC_WITHIN = 5e-3
"""Relative difference to the energy that is to be lost up to which a base that touches down plastically is kept [-]. On
stiff joints less damping changes no more than that, and makes the stack bounce."""
MISSED = 0.02
"""Relative difference to the energy that is to be lost from which a match has missed it [-]."""
SAMPLE_STEP = 5e-4
"""Spacing of the samples, over the time of a rebound [-]."""
SMALLEST_REBOUND = 0.01
"""Smallest rotation that counts as a rebound, over the largest [-]."""


def matched_masonry(
    masonry: Masonry, e: Restitution | None = None, *, amplitude: float = 0.5, accuracy: float = 1e-4
) -> Masonry:
    """The same stack with damping on which it keeps, rocking as one, the energy that rocking theory keeps.

    It is set turning about an edge of its base as one rigid wall. |e| of the first rebound is the root of the energy at
    its second peak over that at the first. The dashpots of the base are matched to `e.base` without the side stop, then
    those of the side stop to `e.lumped`, as `matched_contacts` does for a wall. Of several damping ratios the highest
    is taken. Where the damping of a stiff base changes next to nothing, it is that of a plastic touch-down, and the
    energy is met within 0.5 %. The joints above get strong dashpots, with which the stack does not vibrate on them.

    The law or xi that the masonry has is replaced. The new xi refers to the `reference_frequency` of its whole wall on
    the base. It takes some thirty short simulations: 0.2 s for two blocks, 1 to 3 s for seven, minutes for twenty.

    Args:
        masonry: a stack, with a side stop or without one. Its friction takes part: what sliding takes is matched too.
        e: the restitution that is asked for; None takes that of rocking theory, `rigid_impact` for the base and the
            angular momentum about the top of the side stop (Eq. 3 of the paper) for the side.
        amplitude: rotation over that which overturns the stack, from which it falls to the first impact [-], 0.01 to
            0.95. On soft joints small rotations lose more.
        accuracy: of the simulations, see `simulate`.

    Raises:
        ValueError: for a value outside its range, masonry that is not a stack, or a side stop from which it would not
            rebound.

    Warns:
        UserWarning: where no damping gives what is asked for. The damping that comes closest is returned, and the
            message says what it gives.
    """
    require_kind("masonry", masonry, Masonry)
    masonry.require_plane("matched_masonry")
    require_kind("e", e, Restitution, type(None))
    amplitude = require_within("amplitude", amplitude, 0.01, 0.95)
    accuracy = require_within("accuracy", accuracy, 1e-8, 0.1)
    pile = Pile.of(masonry)
    e = as_one(pile) if e is None else e
    if pile.sides:
        e.require_rebound()
    k_n, points = (float(column[pile.base]) for column in (masonry.table.k_n, masonry.table.points))
    frequency = reference_frequency(pile.wall, k_n, int(points))
    xi = np.full(len(masonry.joints), 0.5 * frequency * strong(pile))

    def damped(whole: Masonry) -> Masonry:
        values = tuple((joint.name, float(value)) for joint, value in zip(masonry.joints, xi, strict=True))
        return dataclasses.replace(whole, law=None, frequency=frequency, xi=ByName(values))

    def base(value: float) -> float:
        xi[pile.base] = value
        return rebound(damped(pile.free_standing), amplitude, accuracy)

    def side(value: float) -> float:
        xi[list(pile.sides)] = value
        return rebound(damped(masonry), amplitude, accuracy)

    if abs(excess(base(TOUCH_DOWN / pile.wall.slenderness), e.base)) > PLASTIC_WITHIN:
        xi[pile.base] = _matched("base", highest_branch(base, e.base, BASE_BOUNDS), e.base)
    if pile.sides:
        lumped = abs(e.lumped)
        xi[list(pile.sides)] = _matched("side", highest_branch(side, lumped, SIDE_BOUNDS, whole=False), lumped)
    return damped(masonry)


def strong(pile: Pile) -> float:
    """c/k with which the blocks of a stack over an edge of its base do not vibrate on the joints above [s].

    It is 2 STRONG over the lowest frequency of the stack with all joints closed above, and one edge of the base.
    """
    stack = pile.free_standing
    lines = stack.lines
    base = np.flatnonzero(lines.joint == Pile.of(stack).base)
    edges = base[np.argsort(lines.at[base, 0])][[0, -1]]
    frequencies = []
    for edge in edges:
        closed = np.ones(len(lines.k), dtype=bool)
        closed[base] = base == edge
        left = Lines(*(values[closed] for values in lines))  # type: ignore[arg-type]
        frequencies.append(lowest_frequency(stack.blocks, left, stack.joint_friction))
    return 2 * STRONG_ABOVE / min(frequencies)


def rebound(stack: Masonry, amplitude: float, accuracy: float) -> float:
    """|e| of the first rebound of a stack that rises as one to a rotation, a share of alpha; 0 without one."""
    pile = Pile.of(stack)
    velocity, swing = pile.rising(amplitude)
    for swings in (1.75, 3.5):  # a stack on soft joints rocks slower than a rigid one
        case = MasonryCase(stack, swings * swing, velocity=velocity)
        ratios = restitutions(simulate(case, accuracy=accuracy, output_step=SAMPLE_STEP * swing), pile)
        if len(ratios):
            return float(ratios[0])
    return 0.0


def excess(obtained: float, target: float) -> float:
    """How much more energy one |e| loses than another, over what that loses [-]."""
    return (target**2 - obtained**2) / max(1 - target**2, 1e-9)


def _matched(name: str, closest: Closest, target: float) -> float:
    """The damping ratio that is matched, with a warning where the match is missed."""
    if abs(excess(closest.value, target)) > MISSED:
        warnings.warn(
            f"no damping of the {name} gives |e| = {target:.4g}; the closest, xi = {closest.xi:.3g}, gives "
            f"{closest.value:.4g} and loses {1 + excess(closest.value, target):.3g} of the energy that is to be lost",
            stacklevel=3,
        )
    return closest.xi


def restitutions(answer: Response, pile: Pile) -> Array:
    """|e| of each rebound of a stack: the root of the energy at a peak over that at the peak before, shape (rebounds,).

    It is the whole energy above the stack at rest, as in `Response.settled_restitution`.
    """
    energy = answer.energy[peaks(answer, pile)]
    return np.asarray(np.sqrt(np.maximum(energy[1:], 0.0) / energy[:-1]))


def peaks(answer: Response, pile: Pile) -> list[int]:
    """The samples at which the rotation of a stack, the mean over its mass, has a maximum to either side."""
    theta = answer.theta @ pile.masses / pile.masses.sum()
    beyond = np.sign(theta) * (np.abs(theta) > SMALLEST_REBOUND * np.abs(theta).max())
    starts = np.flatnonzero(np.diff(beyond, prepend=0)).tolist()
    tops = []
    for start, end in zip(starts, [*starts[1:], len(theta)], strict=True):
        top = start + int(np.abs(theta[start:end]).argmax())
        if beyond[start] and top < len(theta) - 1:
            tops.append(top)
    return tops
