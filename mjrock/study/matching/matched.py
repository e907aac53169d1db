"""Damping matched to one wall or to one stack, found by simulating it: it gives a required restitution.

A law predicts the damping of any wall in no time, for a base that holds and a smooth side. A match finds it for one
wall and any layout, friction, stiffness and amplitude, in some twenty simulations that take a fraction of a second. A
stack that rocks as one loses more on the damping that a law gives each joint (see `docs/theory.md`).
"""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import Annotated

import numpy as np

from ...bars import Bar
from ...engine.simulation import simulate
from ...problem.damping.contacts import (
    BaseStiffness,
    Contacts,
    FaceFriction,
    PointCount,
    SideStiffness,
    reference_frequency,
)
from ...problem.damping.restitution import Restitution
from ...problem.masonry.case import MasonryCase
from ...problem.masonry.laws.joint_table import ByName
from ...problem.masonry.lines import Lines, lowest_frequency
from ...problem.masonry.masonry import Masonry
from ...problem.masonry.rigid_stack import RigidStack
from ...problem.wall.block import Block
from ...problem.wall.effects import SideStop
from ...quantities import (
    Array,
    Implausible,
    Within,
    require_flag,
    require_kind,
    require_whole,
    require_within,
    warn_of,
    within_ranges,
)
from ...result.response import Response
from ...theory.impact import rigid_rocking
from .match import BASE_BOUNDS, SIDE_BOUNDS, Closest, GivenWall, Match, highest_branch

STIFF_AS_THEORY = 16.0
"""Rotation of the last rebound that counts, over that at which an edge lifts, of a base as stiff as theory's [-]."""
LARGEST_UPLIFT = 2e-4
"""Most rotation at which an edge of such a base lifts, over alpha [-]: the work of the weight on its springs then costs
less than 0.001 of e_2s."""
PLASTIC_TOUCH_DOWN = 0.415
"""Damping ratio of such a base times h/b [-], about that of a plastic touch-down. With less the wall bounces on it,
with more a faint rebound loses more than a large one."""
MISS_WARNED_OF = 0.02
"""Miss of |e| that is warned of, over |e| [-]: as the scatter of |e| with the phase of a touch is."""
UNLIKE_EQ_2 = 5e-3
"""Relative difference of e_2s to Eq. 2 from which it is warned that a stiff base does not give it [-]."""
DAMPING_ABOVE = 4.0
"""Damping ratio of the joints above the base, in the lowest mode in which the stack bends over an edge of it [-]. From
1 on the stack does not vibrate, and from 4 on more changes the energy lost by less than 0.2 %."""
PLASTIC_WITHIN = 5e-3
"""Relative difference to the energy that is to be lost up to which a base that touches down plastically is kept [-]. On
stiff joints less damping changes no more than that, and makes the stack bounce."""
ENERGY_MISS_WARNED_OF = 0.02
"""Relative difference to the energy that is to be lost from which a match has missed it [-]."""
SAMPLE_STEP = 5e-4
"""Spacing of the samples, over the time of a rebound [-]."""
SMALLEST_REBOUND = 0.01
"""Smallest rotation that counts as a rebound, over the largest [-]."""


@within_ranges
def matched_contacts(
    wall: Block,
    e: Restitution,
    k_base: BaseStiffness,
    k_side: SideStiffness = None,
    *,
    points: PointCount = 2,
    amplitude: Annotated[float, Within(0.01, 0.95)] = 0.5,
    friction: FaceFriction = None,
    side_friction: FaceFriction = None,
    side_stop: bool | SideStop = True,
    accuracy: Annotated[float, Within(1e-8, 0.1)] = 1e-4,
) -> Contacts:
    """Interfaces whose damping ratios give |e| of the first rebound of this wall, found by simulation.

    The base is matched two-sided to `e.base`, then the side one-sided to `e.lumped` with that base, as in the flowchart
    of the paper's Figure 2. Of several damping ratios the highest is taken.

    Args:
        wall, e: the wall, and the required restitution.
        k_base, k_side: interface stiffness of base and side [N/m3], 1e4 to 1e14; no side stop without `k_side`.
        points: contact lines a face, 2 to 1000.
        amplitude: rotation theta_0/alpha that the wall is released from [-], 0.01 to 0.95.
        friction, side_friction: coefficients as in `Interface` [-], 0 to 10.
        side_stop: True for a side over the whole face, or the `SideStop` that reaches only so high.
        accuracy: of the simulations [-], 1e-8 to 0.1, see `simulate`.

    Raises:
        ValueError: for a value outside its range.

    Warns:
        UserWarning: where no damping gives it. The damping that comes closest is returned, and the
            message says what it gives.
    """
    require_kind("wall", wall, Block)
    require_kind("e", e, Restitution)
    if k_side is not None:
        e.require_rebound()
    top = 2 * wall.h if not isinstance(side_stop, SideStop) else min(side_stop.top, 2 * wall.h)
    if difference := e.difference_from(wall, top if k_side is not None else None):
        warn_of(difference, Implausible)
    given_wall = GivenWall(wall, k_base, k_base if k_side is None else k_side, amplitude, side_stop)
    match = partial(Match, given_wall, e, points, accuracy=accuracy, friction=friction, side_friction=side_friction)
    xi_base, xi_side = _matched_xi(match()), 0.0
    if k_side is not None:
        xi_side = _matched_xi(match(xi_base=xi_base))
    return Contacts.from_damping(
        wall,
        k_base=k_base,
        xi_base=xi_base,
        k_side=k_side,
        xi_side=xi_side,
        points=points,
        friction=friction,
        side_friction=side_friction,
        law="matched",
        stop_top=None if k_side is None else top,
    )


def as_theory(
    wall: Block, e: Restitution, *, side_stop: bool = True, rebounds: int = 4, amplitude: float = 0.5
) -> Contacts:
    """Interfaces on which a wall rocks as classical theory has it: the same |e| at every one of the first rebounds.

    A soft base makes |e| depend on the size of the rebound. Here the stiffness is chosen so that the rotation after
    `rebounds` rebounds is still STIFF_AS_THEORY times that at which an edge lifts off the base, and this at most
    LARGEST_UPLIFT alpha. On such a base e_2s is that of Eq. 2 whatever the damping. The side is matched.

    Args:
        wall, e: the wall, and the restitution of theory.
        side_stop: whether there is a side; its stiffness is that of the base.
        rebounds: how many rebounds count, 1 to 6.
        amplitude: rotation theta_0/alpha of the release [-], in (0, 0.95].

    Raises:
        ValueError: for a value outside its range, or rebounds so faint that no stiffness up to 1e14 N/m3 would do.

    Warns:
        UserWarning: where e.base is not that of Eq. 2, or no damping of the side gives e.lumped.
    """
    require_kind("wall", wall, Block)
    require_kind("e", e, Restitution)
    require_flag("side_stop", side_stop)
    amplitude = require_within("amplitude", amplitude, 0.01, 0.95)
    rebounds = require_whole("rebounds", rebounds, 1, 6)
    theory = Restitution.from_geometry(wall).base
    if abs(e.base / theory - 1) > UNLIKE_EQ_2:
        warn_of(f"a stiff base gives e_2s = {theory:.4g} of Eq. 2, and not {e.base:.4g}")
    remaining = (e.lumped if side_stop else e.base) ** (2 * rebounds)
    last_rebound = wall.rotation_at(remaining * float(wall.potential_energy(amplitude * wall.alpha)))
    uplift = min(last_rebound / STIFF_AS_THEORY, LARGEST_UPLIFT * wall.alpha)
    k_n = wall.weight / (2 * wall.base_length * wall.half_base**2 * uplift)
    xi_base, xi_side = PLASTIC_TOUCH_DOWN / wall.slenderness, 0.0
    if side_stop:
        xi_side = _matched_xi(Match(GivenWall(wall, k_n, k_n, amplitude), e, 2, xi_base))
    return Contacts.from_damping(
        wall, k_base=k_n, xi_base=xi_base, k_side=k_n if side_stop else None, xi_side=xi_side, law="as theory"
    )


def _matched_xi(match: Match) -> float:
    """The damping ratio that is matched, with a warning where the match is missed."""
    with Bar(f"matching the {match.face}", "runs") as bar:

        def measured(xi: float) -> float:
            bar.add()
            return match.restitution(xi)

        closest = highest_branch(measured, match.target, match.bounds, whole=match.face == "base")
    if not closest.reached and abs(closest.found - match.target) > MISS_WARNED_OF * match.target:
        warn_of(missed(match.face, closest, match.target))
    return closest.xi


def missed(face: str, closest: Closest, target: float) -> str:
    """The text of a warning for a search that has missed its target."""
    outcome = f"the closest, xi = {closest.xi:.3g}, gives {closest.found:.4g}"
    return f"no damping of the {face} gives |e| = {target:.4g}; {outcome}"


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
        e: the required restitution; None takes that of rocking theory, `rigid_impact` for the base and the
            angular momentum about the top of the side stop (Eq. 3 of the paper) for the side.
        amplitude: rotation over that which overturns the stack, from which it falls to the first impact [-], 0.01 to
            0.95. On soft joints small rotations lose more.
        accuracy: of the simulations, see `simulate`.

    Raises:
        ValueError: for a value outside its range, masonry that is not a stack, or a side stop from which it would not
            rebound.

    Warns:
        UserWarning: where no damping gives it. The damping that comes closest is returned, and the
            message says what it gives.
    """
    require_kind("masonry", masonry, Masonry)
    masonry.require_plane("matched_masonry")
    require_kind("e", e, Restitution, type(None))
    amplitude = require_within("amplitude", amplitude, 0.01, 0.95)
    accuracy = require_within("accuracy", accuracy, 1e-8, 0.1)
    stack = RigidStack.from_masonry(masonry)
    e = rigid_rocking(stack) if e is None else e
    if stack.sides:
        e.require_rebound()
    k_n, points = (float(column[stack.base]) for column in (masonry.table.k_n, masonry.table.points))
    frequency = reference_frequency(stack.wall, k_n, int(points))
    xi = np.full(len(masonry.joints), 0.5 * frequency * damping_above(stack))

    def damped(undamped: Masonry) -> Masonry:
        values = tuple((joint.name, float(value)) for joint, value in zip(masonry.joints, xi, strict=True))
        return dataclasses.replace(undamped, law=None, frequency=frequency, xi=ByName(values))

    def base_e(value: float) -> float:
        xi[stack.base] = value
        return rebound(damped(stack.free_standing), amplitude, accuracy)

    def side_e(value: float) -> float:
        xi[list(stack.sides)] = value
        return rebound(damped(masonry), amplitude, accuracy)

    if abs(excess(base_e(PLASTIC_TOUCH_DOWN / stack.wall.slenderness), e.base)) > PLASTIC_WITHIN:
        xi[stack.base] = _warned_xi("base", highest_branch(base_e, e.base, BASE_BOUNDS), e.base)
    if stack.sides:
        lumped = abs(e.lumped)
        xi[list(stack.sides)] = _warned_xi("side", highest_branch(side_e, lumped, SIDE_BOUNDS, whole=False), lumped)
    return damped(masonry)


def damping_above(stack: RigidStack) -> float:
    """c/k of the joints above the base with which the blocks of a stack over an edge of it do not vibrate [s].

    It is 2 DAMPING_ABOVE over the lowest frequency of the stack with all joints closed above, and one edge of the base.
    """
    masonry = stack.free_standing
    lines = masonry.lines
    base = np.flatnonzero(lines.joint == RigidStack.from_masonry(masonry).base)
    edges = base[np.argsort(lines.at[base, 0])][[0, -1]]
    frequencies = []
    for edge in edges:
        closed = np.ones(len(lines.k), dtype=bool)
        closed[base] = base == edge
        closed_lines = Lines(*(values[closed] for values in lines))  # type: ignore[arg-type]
        frequencies.append(lowest_frequency(masonry.blocks, closed_lines, masonry.joint_friction))
    return 2 * DAMPING_ABOVE / min(frequencies)


def rebound(masonry: Masonry, amplitude: float, accuracy: float) -> float:
    """|e| of the first rebound of a stack that rises as one to a rotation, a share of alpha; 0 without one."""
    stack = RigidStack.from_masonry(masonry)
    velocity, swing = stack.rising(amplitude)
    for swings in (1.75, 3.5):  # a stack on soft joints rocks slower than a rigid one
        case = MasonryCase(masonry, swings * swing, velocity=velocity)
        ratios = restitutions(simulate(case, accuracy=accuracy, output_step=SAMPLE_STEP * swing), stack)
        if len(ratios):
            return float(ratios[0])
    return 0.0


def excess(obtained: float, target: float) -> float:
    """How much more energy one |e| loses than another, over what that loses [-]."""
    return (target**2 - obtained**2) / max(1 - target**2, 1e-9)


def _warned_xi(face: str, closest: Closest, target: float) -> float:
    """The damping ratio that is found, with a warning where it loses another energy than required."""
    surplus = excess(closest.found, target)
    if abs(surplus) > ENERGY_MISS_WARNED_OF:
        warn_of(f"{missed(face, closest, target)} and loses {1 + surplus:.3g} of the energy that is to be lost")
    return closest.xi


def restitutions(answer: Response, stack: RigidStack) -> Array:
    """|e| of each rebound of a stack: the root of the energy at a peak over that at the peak before, shape (rebounds,).

    It is the whole energy above the stack at rest, as in `Response.settled_restitution`.
    """
    energy = answer.energy[peaks(answer, stack)]
    return np.asarray(np.sqrt(np.maximum(energy[1:], 0.0) / energy[:-1]))


def peaks(answer: Response, stack: RigidStack) -> list[int]:
    """The samples at which the rotation of a stack, the mean over its mass, has a maximum to either side."""
    theta = answer.theta @ stack.masses / stack.masses.sum()
    beyond = np.sign(theta) * (np.abs(theta) > SMALLEST_REBOUND * np.abs(theta).max())
    starts = np.flatnonzero(np.diff(beyond, prepend=0)).tolist()
    tops = []
    for start, end in zip(starts, [*starts[1:], len(theta)], strict=True):
        top = start + int(np.abs(theta[start:end]).argmax())
        if beyond[start] and top < len(theta) - 1:
            tops.append(top)
    return tops
