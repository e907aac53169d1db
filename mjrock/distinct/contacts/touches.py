"""Touches: the forces of a contact line that has met its face, or that no longer presses on it, inside a step.

The force at a pose acts from the middle of the step before to the middle of the next one. A line with a spring k that
meets its face inside a step of length h, tau before the pose, would get too much: k |rate| tau (h - tau) / 2 from its
spring, and from its dashpot the force for the time h / 2 - tau. One that leaves its face inside a step has got too much
at the pose before, and the pose after takes it back, with the friction that belongs to it.

With m = k tau (h - tau) / 2 [kg], negative for a line that has met its face, the spring is corrected by the impulse
-m rate. The rate changes in the step, so that the work m rate (change of the rate) / 2 is still missing, known when
all forces have acted, and one more impulse does it. The springs then give back the energy that they took. Of a spring
that is not linear k is its secant stiffness, and m grows by half of what that is above its equivalent stiffness, times
the square of tau.
"""

from __future__ import annotations

from ...compiled import inlined
from ...problem.masonry.laws.joint_law import equivalent_stiffness, normal_force, secant_stiffness
from ..rows import Row

FIRST_OPENING = 1e-9
"""Opening at which a line begins that nothing presses on, over the size of the smaller one of its blocks [-]. So it is
not rounding that decides whether it has touched, wherever its blocks stand."""


@inlined
def was_open(line: Row) -> bool:
    """Whether a line was open at the last pose and did no work there."""
    return bool(line.depth == 0 and line.push == 0)


@inlined
def foreseen(line: Row, rate: float, push: float, lead: float) -> float:
    """Rate of a line some steps on [m/s], changed as in the last step and as the force that changes it has grown."""
    ahead: float = rate + lead * (rate - line.rate) * min(push / line.push, 2.0)
    return ahead


@inlined
def time_closed(line: Row, gap: float, rate: float, h: float) -> float:
    """Time in the last step for which a line that presses was closed [s]."""
    met: float = gap / rate if line.depth == 0 and h * rate < gap else h
    return met


@inlined
def touched_forces(line: Row, gap: float, rate: float, h: float) -> tuple[float, float]:
    """Force of the spring and force along the normal [N] of a line that has begun or ceased to press in the last step.

    Leaves what the spring is still `due`. A line whose gap has changed by more than it has moved, at an end of its
    face, has not touched.
    """
    sprung, push = normal_force(line, gap, 0.0), normal_force(line, gap, rate)
    if h == 0:
        return sprung, push
    if line.depth > 0:
        return forces_of_leaving(line, gap, rate, h)
    if h * rate < gap < 0:
        since = gap / rate
        late, bent = 0.5 * (h - since) / h, mass_of_bending(line, -gap, since)
        line.due = -secant_stiffness(line, -gap) * since * h * late - bent
        sprung = (1 - late) * sprung + bent * rate / h
        return sprung, sprung - (since / h + 0.5) * line.c * rate
    return sprung, push


@inlined
def mass_of_bending(line: Row, depth: float, since: float) -> float:
    """What a spring that is not linear adds to m [kg], at a depth that it reached or left in a time [m, s]."""
    bent: float = 0.5 * (secant_stiffness(line, depth) - equivalent_stiffness(line, depth)) * since * since
    return bent


@inlined
def forces_of_leaving(line: Row, gap: float, rate: float, h: float) -> tuple[float, float]:
    """`touched_forces` of a line that was closed at the last pose."""
    sprung, push = normal_force(line, gap, 0.0), normal_force(line, gap, rate)
    held = normal_force(line, -line.depth, line.rate)
    if gap > 0:
        gap = h * rate - line.depth
        if gap <= 0:  # it has come to an end of its face
            return sprung, push
        since = line.depth / rate
        stiffness = secant_stiffness(line, line.depth)
        mass = 0.5 * stiffness * since * (h - since) + mass_of_bending(line, line.depth, since)
        if held == 0:  # the dashpot has held the spring back, and takes what it held
            return -2 * mass * rate / h, 0.0
        sprung, line.due = -mass * rate / h, mass
    pull = secant_stiffness(line, abs(gap)) * gap + line.c * rate  # the law, if it could pull
    if held > 0 and pull > 0:
        push = -0.5 * held * pull / (held + pull)
    return sprung, push


@inlined
def due_impulse(line: Row, rate: float) -> float:
    """Impulse that the spring of a line which has touched is due [N s], at the rate after all forces have acted."""
    before = line.rate
    share = before * before / max(before * (before + rate), 0.5 * before * before)
    impulse: float = line.due * (rate - before) * share
    return impulse


@inlined
def in_transit(line: Row, h: float) -> tuple[float, float]:
    """Work for a touch in the last step that a sample counts as held by the spring, and what it counts as taken by the
    dashpot, which the halves of the impulses after the pose will take [J]."""
    by_spring = 0.5 * h * (line.push - line.pressed - normal_force(line, -line.depth, 0.0)) * line.rate
    if line.push < 0:
        work = 0.5 * h * line.push * line.rate
        return work, by_spring - work
    return by_spring, 0.0
