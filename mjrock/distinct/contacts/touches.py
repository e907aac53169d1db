"""Touches: the forces of a contact line that closes or opens inside a step.

The force at a pose acts from the middle of the step before to the middle of the next one. A line with a spring k that
closes inside a step of length h, tau before the pose, would get too large an impulse: by k |rate| tau (h - tau) / 2
from its spring, and by the force of its dashpot over the time h / 2 - tau. A line that opens inside a step has got too
large an impulse at the pose before. The pose after subtracts it again, with its friction.

With m = k tau (h - tau) / 2 [kg], negative for a line that closes, the spring is corrected by the impulse -m rate. The
rate changes in the step, so that the work m rate (change of the rate) / 2 is still missing. It is known when all forces
have acted, and a second impulse does it. The springs then return the energy that they stored. For a spring that is not
linear k is the secant stiffness, and m grows by half the difference between secant and equivalent stiffness, times the
square of tau.
"""

from __future__ import annotations

from ...compiled import inlined
from ...problem.masonry.laws.joint_law import equivalent_stiffness, normal_force, secant_stiffness
from ...rows import Row

FIRST_OPENING = 1e-9
"""Opening at which a line begins that nothing presses on, over the size of the smaller one of its blocks [-]. So it is
not rounding that decides whether it has touched, wherever its blocks stand."""


@inlined
def was_open(line: Row) -> bool:
    """Whether a line was open at the last pose and did no work there."""
    return bool(line.depth == 0 and line.push == 0)


@inlined
def foreseen(line: Row, rate: float, push: float, steps_ahead: float) -> float:
    """Rate of a line some steps on [m/s], changed as in the last step and as the force that changes it has grown."""
    ahead: float = rate + steps_ahead * (rate - line.rate) * min(push / line.push, 2.0)
    return ahead


@inlined
def time_closed(line: Row, gap: float, rate: float, h: float) -> float:
    """Time in the last step for which a line that presses was closed [s]."""
    met: float = gap / rate if line.depth == 0 and h * rate < gap else h
    return met


@inlined
def touched_forces(line: Row, gap: float, rate: float, h: float) -> tuple[float, float]:
    """Force of the spring and force along the normal [N] of a line that has begun or ceased to press in the last step.

    Leaves the impulse that is still `due` in the line. A line whose gap has changed by more than it has moved is at an
    end of its face, and has not touched.
    """
    sprung, push = normal_force(line, gap, 0.0), normal_force(line, gap, rate)
    if h == 0:
        return sprung, push
    if line.depth > 0:
        return forces_of_leaving(line, gap, rate, h)
    if h * rate < gap < 0:
        since = gap / rate
        late, mass = 0.5 * (h - since) / h, mass_of_nonlinear_spring(line, -gap, since)
        line.due = -secant_stiffness(line, -gap) * since * h * late - mass
        sprung = (1 - late) * sprung + mass * rate / h
        return sprung, sprung - (since / h + 0.5) * line.c * rate
    return sprung, push


@inlined
def mass_of_nonlinear_spring(line: Row, depth: float, since: float) -> float:
    """What a spring that is not linear adds to m [kg], from its overlap [m] and the time since it closed or until it
    opened [s].
    """
    mass: float = 0.5 * (secant_stiffness(line, depth) - equivalent_stiffness(line, depth)) * since * since
    return mass


@inlined
def forces_of_leaving(line: Row, gap: float, rate: float, h: float) -> tuple[float, float]:
    """`touched_forces` of a line that was closed at the last pose."""
    sprung, push = normal_force(line, gap, 0.0), normal_force(line, gap, rate)
    force_before = normal_force(line, -line.depth, line.rate)
    if gap > 0:
        gap = h * rate - line.depth
        if gap <= 0:  # it has come to an end of its face
            return sprung, push
        since = line.depth / rate
        stiffness = secant_stiffness(line, line.depth)
        mass = 0.5 * stiffness * since * (h - since) + mass_of_nonlinear_spring(line, line.depth, since)
        if force_before == 0:  # the dashpot has held the spring back, and takes what it held
            return -2 * mass * rate / h, 0.0
        sprung, line.due = -mass * rate / h, mass
    pull = secant_stiffness(line, abs(gap)) * gap + line.c * rate  # the law, if it could pull
    if force_before > 0 and pull > 0:
        push = -0.5 * force_before * pull / (force_before + pull)
    return sprung, push


@inlined
def due_impulse(line: Row, rate: float) -> float:
    """The second impulse of the spring of a line that has touched [N s], at the rate after all forces have acted."""
    before = line.rate
    share = before * before / max(before * (before + rate), 0.5 * before * before)
    impulse: float = line.due * (rate - before) * share
    return impulse


@inlined
def in_transit(line: Row, h: float) -> tuple[float, float]:
    """Work of the halves of the impulses of a touch that act after the pose [J]: the part that a sample counts as held
    by the spring, and the part that it counts as dissipated by the dashpot.
    """
    by_spring = 0.5 * h * (line.push - line.dashpot_force - normal_force(line, -line.depth, 0.0)) * line.rate
    if line.push < 0:
        work = 0.5 * h * line.push * line.rate
        return work, by_spring - work
    return by_spring, 0.0
