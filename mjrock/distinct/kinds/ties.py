"""Ties and other springs with a slider of explicit steps: they pull, or push too, and break."""

from __future__ import annotations

import math

from ...compiled import inlined
from ...problem.masonry.case import AnyCase
from ...scene.scene import Scene
from ..rows import Row, Rows
from ..system import Books, System
from .link import Kind, Named, Table, book_support, lengthening, pull, push_apart


class Ties(Kind, Table):
    """Springs with a slider, by the law of `LinkLaw`.

    `k` [N/m] acts from the length `reach` on [m], which the slider moves. It yields at the forces `strength` and `push`
    either way [N]. `drawn` is its plastic elongation and `ultimate` the limit of that [m]. It was `broken` at a time
    [s], infinite for one that holds.
    """

    own = ("k", "reach", "strength", "push", "ultimate", "drawn", "broken")
    endless = ("strength", "ultimate", "broken")
    booked = ("ties", "broken")

    @classmethod
    def of(cls, scene: Scene, case: AnyCase, bodies: Rows) -> Named:
        """Those of a scene, where they bear nothing at rest if they push too."""
        ties = scene.ties
        return cls.linking(scene.links.sprung, ties.links.between, reach=ties.reach, drawn=0.0, broken=math.inf)

    @inlined
    def act(self, system: System, books: Books, t: float, h: float) -> None:
        """Their sliders move to where the pose asks."""
        for i in range(len(self.rows)):
            tie = self.rows[i]
            if t >= tie.broken:
                tie.pulled = 0.0
                continue
            now = pull(tie, system)
            beyond = now.length - tie.reach - tie.strength / tie.k
            shorter = tie.reach - now.length - tie.push / tie.k
            if beyond > 0:  # it yields, and breaks where it has been drawn out as far as it can be
                left = tie.ultimate - tie.drawn
                tie.drawn, tie.reach = tie.drawn + min(beyond, left), tie.reach + min(beyond, left)
                books.links[tie.account] += tie.strength * min(beyond, left)
                if beyond >= left:
                    since = since_broken(beyond - left, lengthening(tie, system, now), h)
                    book_support(tie, system, books, now, -tie.strength, h - since)
                    tie.broken, books.links[tie.account + 1] = t - since, 0.5 * tie.strength**2 / tie.k
                    tie.pulled = -pulled_until_broken(tie, since, h)
                    push_apart(tie, system, now, tie.pulled)
                    continue
            elif tie.push > 0 and shorter > 0:  # it slips the other way
                tie.drawn, tie.reach = tie.drawn + shorter, tie.reach - shorter
                books.links[tie.account] += tie.push * shorter
            force = -tie.k * elongation(tie, now.length)
            book_support(tie, system, books, now, force, h)
            push_apart(tie, system, now, force)

    @inlined
    def hold(self, system: System, books: Books, energy: Row) -> None:
        """What their springs hold."""
        for i in range(len(self.rows)):
            tie = self.rows[i]
            if tie.broken == math.inf:
                stretched = elongation(tie, pull(tie, system).length)
                energy.elastic += 0.5 * tie.k * stretched * stretched


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
