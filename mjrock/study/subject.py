"""What a campaign asks of a wall or of masonry: the solvers that take it, and the columns of its row."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import ClassVar, Protocol

from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.wall.case import Case
from ..quantities import Implausible, spelt
from ..result.response import Response


class Subject(Protocol):
    """A wall or masonry as a campaign sees it.

    Attributes:
        SOLVERS: names of the solvers that take it, and in words what they take where they are not all.
        COLUMNS: its columns but the last two.
        PEAK: the one that an incremental dynamic analysis gathers; it is infinite for what has overturned.
        FALLS: what it does at its capacity, in words.
    """

    SOLVERS: ClassVar[tuple[tuple[str, ...], str]]
    COLUMNS: ClassVar[tuple[str, ...]]
    PEAK: ClassVar[str]
    FALLS: ClassVar[str]

    def require(self, solver: str, e: Restitution | None, contacts: Contacts | None) -> None:
        """Raise ValueError unless it has what its solver needs, and no more."""

    def law(self, solver: str, contacts: Contacts | None) -> str:
        """The law of the damping."""

    def values(self, response: Response, law: str) -> tuple[object, ...]:
        """The values of the columns."""


@dataclass(frozen=True)
class OfWall(Subject):
    """A wall, see `Subject`."""

    case: Case
    SOLVERS = (("analytical", "compliant", "MuJoCo", "explicit"), "")
    COLUMNS = (
        "solver", "law", "outcome", "peak_over_alpha", "peak_over_overturning", "inwards_over_alpha", "impacts",
        "restitution_1", "restitution_2", "restitution_3",
    )  # fmt: skip
    PEAK = "peak_over_alpha"
    FALLS = "wall overturns"

    def require(self, solver: str, e: Restitution | None, contacts: Contacts | None) -> None:
        """Raise ValueError unless it has the restitution or the contacts that its solver needs."""
        case, by_theory = self.case, solver == "analytical"
        if (e if by_theory else contacts) is None:
            raise ValueError(f"the solver {solver} needs {'e' if by_theory else 'contacts'}")
        if by_theory and e is not None and (doubt := e.doubt(case.wall, case.stop_top)):
            warnings.warn(doubt, Implausible, stacklevel=4)
        if contacts is not None and not by_theory:
            contacts.require_fit(case.block, side_stop=case.one_sided)

    def law(self, solver: str, contacts: Contacts | None) -> str:
        """That of its contacts, or "restitution" for the analytical solver."""
        return "restitution" if contacts is None or solver == "analytical" else contacts.law

    def values(self, response: Response, law: str) -> tuple[object, ...]:
        """Outcome, peaks and rebounds."""
        restitution = [float(value) for value in response.restitution[:3]] + [None] * 3
        peaks = response.peak_over_alpha, response.peak_over_overturning, response.inwards_over_alpha
        return response.solver, law, response.outcome.value, *peaks, len(response.impacts), *restitution[:3]


@dataclass(frozen=True)
class OfMasonry(Subject):
    """Masonry, see `Subject`."""

    case: MasonryCase
    SOLVERS = (("MuJoCo", "explicit"), ", which take masonry")
    COLUMNS = (
        "solver", "outcome", "fallen", "first_fall_s", "largest_opening_m", "largest_sliding_m", "largest_rotation_rad",
    )  # fmt: skip
    PEAK = "largest_rotation_rad"
    FALLS = "masonry falls"

    def require(self, solver: str, e: Restitution | None, contacts: Contacts | None) -> None:
        """Raise ValueError for restitution or contacts, which are those of its joints."""
        self.case.require_own_joints(e, contacts)

    def law(self, solver: str, contacts: Contacts | None) -> str:
        """That which its joints were made with, or "given"."""
        given = self.case.masonry.law
        return "given" if given is None else str(getattr(given, "name", spelt(given)))

    def values(self, response: Response, law: str) -> tuple[object, ...]:
        """Outcome, fallen blocks and largest motions."""
        return (
            response.solver,
            response.outcome.value,
            len(response.fallen),
            min(response.fallen.values(), default=None),
            float(response.opening.max()),
            float(response.sliding.max()),
            math.inf if response.fallen else float(response.peak.max()),
        )


def subject_of(case: AnyCase) -> Subject:
    """A case as a campaign sees it."""
    return OfMasonry(case) if isinstance(case, MasonryCase) else OfWall(case)
