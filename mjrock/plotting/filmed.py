"""What a film shows of a wall or of masonry around its bodies and beside them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from matplotlib.axes import Axes

from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.wall.case import Case
from ..result.response import Response
from .bodies import Bodies
from .histories import acceleration, rotation, ties
from .perspective import ties_in_view
from .section import Update, frame_view, surroundings, ties_of_masonry
from .solids import Solids
from .style import Drawing


class Filmed(Protocol):
    """A wall or masonry as a film sees it."""

    def around(self, ax: Axes, bodies: Bodies | Solids) -> Update:
        """Draw what its bodies meet."""

    def beside(self, response: Response) -> list[Drawing]:
        """What stands beside the bodies, each on an Axes of its own, over the time."""


@dataclass(frozen=True)
class FilmedWall(Filmed):
    """A wall, see `Filmed`."""

    case: Case

    def around(self, ax: Axes, bodies: Bodies | Solids) -> Update:
        """Base, side stop and effects."""
        assert isinstance(bodies, Bodies)
        return surroundings(ax, self.case, bodies)

    def beside(self, response: Response) -> list[Drawing]:
        """The motion of its base, its rotation and the forces of its ties."""
        drawn: list[Drawing] = []
        if self.case.shaken:
            drawn.append(lambda ax: acceleration(ax, self.case, float(response.t[-1])))
        drawn.append(lambda ax: rotation(ax, [response]))
        if response.ties:
            drawn.append(lambda ax: ties(ax, [response]))
        return drawn


@dataclass(frozen=True)
class FilmedMasonry(Filmed):
    """Masonry, see `Filmed`."""

    case: MasonryCase

    def around(self, ax: Axes, bodies: Bodies | Solids) -> Update:
        """Its ties."""
        if isinstance(bodies, Solids):
            return ties_in_view(ax, bodies)
        frame_view(ax, bodies)
        return ties_of_masonry(ax, self.case, bodies)

    def beside(self, response: Response) -> list[Drawing]:
        """Nothing."""
        return []


def filmed(case: AnyCase) -> Filmed:
    """A case as a film sees it."""
    return FilmedMasonry(case) if isinstance(case, MasonryCase) else FilmedWall(case)
