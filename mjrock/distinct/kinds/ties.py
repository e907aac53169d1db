"""Ties and other springs with a slider of explicit steps: they pull, or push too, and break.

A tie that goes taut or slack inside a step pulls for the time that it is taut, as a contact presses for the time that
it is closed, see `contacts.touches`: in the notation there, it is a line whose gap is the slack.
"""

from __future__ import annotations

import math

from ...compiled import inlined
from ...geometry.vectors import scaled
from ...problem.masonry.case import AnyCase
from ...rows import Row, Rows
from ...scene.scene import Scene
from ..contacts.touches import due_impulse
from ..rotation import apply_impulse_at
from ..system import Books, System
from .link import INFINITE_IN_LAW, Kind, Named, Pull, Table, book_support, carried_along, lengthening, pull, push_apart


class Ties(Kind, Table):
    """Springs with a slider, by the law of `LinkLaw`.

    `k` [N/m] acts from the length `reach` on [m], which the slider moves. It yields at the forces `strength` and `push`
    either way [N]. `plastic` is its plastic elongation and `ultimate` the limit of that [m]. It was `broken` at a time
    [s], infinite for one that holds. Where it has gone taut or slack in the last step, `struck` is its force beyond
    that of its law [N], `due` what its spring is still to do for that [kg], and `transit` the work that is still to
    come [J]. `rate` is the rate of its length in the last step [m/s].
    """

    own_fields = ("k", "reach", "strength", "push", "ultimate", "plastic", "broken", "struck", "due", "transit", "rate")
    endless = (*INFINITE_IN_LAW, "broken")
    booked = ("ties", "broken")

    @classmethod
    def from_scene(cls, scene: Scene, case: AnyCase, bodies: Rows) -> Named:
        """Those of a scene, where they bear nothing at rest if they push too."""
        ties = scene.ties
        begun = dict.fromkeys(("plastic", "struck", "due", "transit", "rate"), 0.0)
        return cls.linking(scene.links.sprung, ties.links.between, reach=ties.reach, broken=math.inf, **begun)

    def remembered(self, t: float) -> Ties:
        """When they broke counts from there."""
        self.rows["broken"] -= t
        return self

    @inlined
    def act(self, system: System, books: Books, t: float, h: float) -> None:
        """Move the sliders to the pose, and add the forces."""
        for i in range(len(self.rows)):
            tie = self.rows[i]
            if t >= tie.broken:
                tie.force = 0.0
                continue
            at_pose = pull(tie, system)
            meet_or_leave(tie, system, books, at_pose, h)
            beyond = at_pose.length - tie.reach - tie.strength / tie.k
            shorter = tie.reach - at_pose.length - tie.push / tie.k
            if beyond > 0:  # it yields, and breaks where it has been drawn out as far as it can be
                remaining = tie.ultimate - tie.plastic
                tie.plastic, tie.reach = tie.plastic + min(beyond, remaining), tie.reach + min(beyond, remaining)
                books.links[tie.account] += tie.strength * min(beyond, remaining)
                if beyond >= remaining:
                    since = since_broken(beyond - remaining, lengthening(tie, system, at_pose), h)
                    book_support(tie, system, books, at_pose, -tie.strength, h - since)
                    tie.broken, books.links[tie.account + 1] = t - since, 0.5 * tie.strength**2 / tie.k
                    tie.force = -pulled_until_broken(tie, since, h)
                    push_apart(tie, system, at_pose, tie.force)
                    continue
            elif tie.push > 0 and shorter > 0:  # it slips the other way
                tie.plastic, tie.reach = tie.plastic + shorter, tie.reach - shorter
                books.links[tie.account] += tie.push * shorter
            force = -tie.k * elongation(tie, at_pose.length)
            book_support(tie, system, books, at_pose, force, h)
            push_apart(tie, system, at_pose, force + tie.struck)

    @inlined
    def settle(self, system: System, books: Books, force_time: float) -> tuple[float, float]:
        """The second impulse of those that have gone taut or slack, see `touches`."""
        dissipated, put_in = 0.0, 0.0
        for i in range(len(self.rows)):
            tie = self.rows[i]
            if tie.due != 0:
                at_pose = pull(tie, system)
                impulse = due_impulse(tie, lengthening(tie, system, at_pose))
                apply_impulse_at(system.bodies[tie.body], at_pose.arm, scaled(impulse, at_pose.direction))
                if tie.anchor >= 0:
                    apply_impulse_at(system.bodies[tie.anchor], at_pose.anchor_arm, scaled(-impulse, at_pose.direction))
                put_in += 0.5 * impulse * carried_along(tie, system, at_pose)
                dissipated -= 0.5 * impulse * tie.rate
                tie.struck, tie.due = tie.struck + impulse / force_time, 0.0
        books.totals[0].ground += put_in
        return dissipated, put_in

    @inlined
    def add_energy(self, system: System, books: Books, energy: Row) -> None:
        """What their springs hold."""
        for i in range(len(self.rows)):
            tie = self.rows[i]
            if tie.broken == math.inf:
                stretched = elongation(tie, pull(tie, system).length)
                energy.elastic += 0.5 * tie.k * stretched * stretched + tie.transit


@inlined
def meet_or_leave(tie: Row, system: System, books: Books, at_pose: Pull, h: float) -> None:
    """Write what a tie that only pulls does beyond its law in the last step, of length h, where it has gone taut or
    slack, or begun to yield in it. The forces at the poses before and after the step act for half of it each, and the
    tie pulled less or more than that."""
    books.totals[0].ground += 0.5 * h * tie.struck * carried_along(tie, system, at_pose)
    tie.struck = tie.due = tie.transit = 0.0
    if tie.push > 0 or h == 0:
        return
    tie.rate = lengthening(tie, system, at_pose)
    longer, pull_before = at_pose.length - tie.reach, -tie.force
    if longer > 0 and tie.rate > 0 and (pull_before == 0 or tie.k * longer > tie.strength > pull_before):
        taut = min(longer / tie.rate, h) if pull_before == 0 else h
        peak = min(tie.k * longer, tie.strength)
        rising = min((peak - pull_before) / (tie.k * tie.rate), taut)
        tie.struck = 0.5 * (pull_before + peak) + (0.5 * (peak - pull_before) * rising - peak * taut) / h
        tie.due = -0.5 * tie.k * taut * (h - taut) if peak < tie.strength else 0.0
    elif longer <= 0 and pull_before > 0 and tie.rate < 0:
        taut = min(pull_before / (tie.k * -tie.rate), h)
        tie.struck = 0.5 * pull_before * (h - taut) / h
        tie.due = 0.5 * tie.k * taut * (h - taut)
    tie.transit = 0.5 * h * tie.struck * tie.rate
    books.totals[0].ground += 0.5 * h * tie.struck * carried_along(tie, system, at_pose)


@inlined
def since_broken(over: float, rate: float, h: float) -> float:
    """How long before the pose a tie broke that is longer than it can be by `over` [s], within the step of length h."""
    return min(over / rate, h) if rate > 0 else 0.0


@inlined
def pulled_until_broken(tie: Row, since: float, h: float) -> float:
    """Force at the pose after a tie broke, in place of none [N].

    The force of the pose before acts on the velocity up to the middle of the step. The impulse of the tie after the
    middle and before it broke has still to be added, and its impulse before the middle and after it had broken has to
    be subtracted.
    """
    return tie.strength * (0.5 - since / h) if h > 0 else 0.0


@inlined
def elongation(tie: Row, length: float) -> float:
    """Elastic elongation of a link with a spring [m], zero where one that only pulls is slack."""
    elastic: float = length - tie.reach
    return elastic if tie.push > 0 else max(0.0, elastic)
