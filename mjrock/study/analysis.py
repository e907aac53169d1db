"""One case for one solver, as a task of a campaign: the run, and the columns of its row."""

from __future__ import annotations

import inspect
import math
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np

from ..contacts.files import write_arrays
from ..distinct.explicit import solve_explicit
from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import AnyRestitution, Restitution, ScatteredRestitution
from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.wall.case import Case
from ..quantities import Implausible, keep, require_kind, shown, spelt, warn_of
from ..reference.compliant import solve_compliant
from ..result.response import Response
from ..result.ties import Plastic
from ..theory.analytical import solve_analytical
from .campaign.task import Row


@dataclass(frozen=True)
class WallSubject:
    """A wall as a campaign sees it.

    Attributes:
        SOLVERS: names of the solvers that take it, and in words what they take where they are not all.
        COLUMNS: its columns but the last two.
        PEAK: the column that an incremental dynamic analysis collects, infinite for what has overturned.
        FALLS: what it does at its capacity, in words.
    """

    case: Case
    SOLVERS = (("analytical", "compliant", "MuJoCo", "explicit"), "")
    COLUMNS = (
        "solver", "law", "outcome", "peak_over_alpha", "peak_over_overturning", "inwards_over_alpha", "impacts",
        "restitution_1", "restitution_2", "restitution_3",
    )  # fmt: skip
    PEAK = "peak_over_alpha"
    FALLS = "wall overturns"

    def require(self, solver: str, e: AnyRestitution | None, contacts: Contacts | None) -> None:
        """Raise ValueError unless it has the restitution or the contacts that its solver needs."""
        case, by_theory = self.case, solver == "analytical"
        if (e if by_theory else contacts) is None:
            raise ValueError(f"the solver {solver} needs {'e' if by_theory else 'contacts'}")
        if by_theory and e is not None and (difference := e.difference_from(case.wall, case.stop_top)):
            warn_of(difference, Implausible)
        if contacts is not None and not by_theory:
            contacts.require_fit(case.block, side_stop=case.one_sided)

    def law(self, solver: str, contacts: Contacts | None) -> str:
        """The law of the damping: that of its contacts, or "restitution" for the analytical solver."""
        return "restitution" if contacts is None or solver == "analytical" else contacts.law

    def values(self, response: Response, law: str) -> tuple[object, ...]:
        """The values of the columns: outcome, peaks and rebounds."""
        restitution = [float(value) for value in response.restitution[:3]] + [None] * 3
        peaks = response.peak_over_alpha, response.peak_over_overturning, response.inwards_over_alpha
        return response.solver, law, response.outcome.value, *peaks, len(response.impacts), *restitution[:3]


@dataclass(frozen=True)
class MasonrySubject:
    """Masonry as a campaign sees it, see `WallSubject`."""

    case: MasonryCase
    SOLVERS = (("MuJoCo", "explicit"), ", which take masonry")
    COLUMNS = (
        "solver", "outcome", "fallen", "first_fall_s", "largest_opening_m", "largest_sliding_m", "largest_rotation_rad",
    )  # fmt: skip
    PEAK = "largest_rotation_rad"
    FALLS = "masonry falls"

    def require(self, solver: str, e: AnyRestitution | None, contacts: Contacts | None) -> None:
        """Raise ValueError for restitution or contacts, which are those of its joints."""
        self.case.require_own_joints(e, contacts)

    def law(self, solver: str, contacts: Contacts | None) -> str:
        """The law of the damping of its joints, or "given"."""
        law = self.case.masonry.law
        return "given" if law is None else str(getattr(law, "name", spelt(law)))

    def values(self, response: Response, law: str) -> tuple[object, ...]:
        """The values of the columns: outcome, fallen blocks and largest motions."""
        return (
            response.solver,
            response.outcome.value,
            len(response.fallen),
            min(response.fallen.values(), default=None),
            float(response.opening.max()),
            float(response.sliding.max()),
            math.inf if response.fallen else float(response.peak.max()),
        )


def subject_of(case: AnyCase) -> WallSubject | MasonrySubject:
    """A case as a campaign sees it."""
    return MasonrySubject(case) if isinstance(case, MasonryCase) else WallSubject(case)


@cache
def solver_named(name: str) -> Callable[..., Response]:
    """A solver by its name. That of MuJoCo brings MuJoCo, which no other needs."""
    if name == "MuJoCo":
        from ..engine.simulation import simulate

        return simulate
    solvers: dict[str, Callable[..., Response]] = {
        "analytical": solve_analytical,
        "compliant": solve_compliant,
        "explicit": solve_explicit,
    }
    return solvers[name]


TIE_COLUMNS = ("elongation_m", "force_N", "energy_J", "broken_s")
"""Columns of each tie, after its name: how far it has yielded, its largest force, what yielding and breaking took, and
when it broke, empty where it did not."""
ACTUATOR_COLUMNS = ("largest_force_N", "work_J")
"""Columns of each actuator, after its name: its largest force, and with a ledger what it has put in by the end."""


@dataclass(frozen=True)
class Analysis:
    """One case for one solver.

    The properties of the joints of masonry have to be numbers. A function of the joint has no content by which a
    campaign could distinguish tasks, and its task becomes a failed row.

    Args:
        case: the case, of a wall or of masonry.
        solver: "analytical", "compliant", "MuJoCo" or "explicit"; masonry takes the last two.
        e: coefficients of restitution, for the analytical solver.
        contacts: interfaces of a wall, for the other three.
        options: keyword arguments of the solver, such as `accuracy`, `timestep` or `rtol`.
        labels: columns by which the user recognizes the case: text, numbers.

    Options and labels are copied.

    Raises:
        ValueError: for an unknown solver or option, or if `e` or `contacts` are missing.
        TypeError: for an argument of another type.
    """

    case: AnyCase
    solver: str = "MuJoCo"
    e: AnyRestitution | None = None
    contacts: Contacts | None = None
    options: Mapping[str, object] = field(default_factory=dict)
    labels: Mapping[str, object] = field(default_factory=dict, compare=False)

    def __post_init__(self) -> None:
        require_kind("case", self.case, Case, MasonryCase)
        require_kind("e", self.e, Restitution, ScatteredRestitution, type(None))
        require_kind("contacts", self.contacts, Contacts, type(None))
        for name in ("options", "labels"):
            value = getattr(self, name)
            if not isinstance(value, Mapping):
                raise TypeError(f"{name} = {shown(value)} is not a mapping of names to values")
            keep(self, **{name: dict(value)})
        subject = subject_of(self.case)
        solvers, whom = subject.SOLVERS
        if not isinstance(self.solver, str) or self.solver not in solvers:
            raise ValueError(f"solver = {spelt(self.solver)} is not one of {', '.join(solvers)}{whom}")
        subject.require(self.solver, self.e, self.contacts)
        valid = tuple(inspect.signature(solver_named(self.solver)).parameters)[2:]
        if unknown := self.options.keys() - set(valid):
            raise ValueError(
                f"{self.solver} has no option {', '.join(sorted(map(str, unknown)))}; it has {', '.join(valid)}"
            )

    @property
    def COLUMNS(self) -> tuple[str, ...]:
        """The columns of a row."""
        columns = tuple(f"{tie}_{name}" for tie in self.case.springs for name in TIE_COLUMNS)
        if self.options.get("forces"):
            columns += ("largest_reaction_N",)
        names = ACTUATOR_COLUMNS if self.options.get("ledger") else ACTUATOR_COLUMNS[:1]
        columns += tuple(f"{jack}_{name}" for jack in self.case.actuators for name in names)
        return (*subject_of(self.case).COLUMNS, "end_s", "message", *columns)

    @property
    def law(self) -> str:
        """The law of the damping, or "restitution" for the analytical solver; of masonry without a law "given"."""
        return subject_of(self.case).law(self.solver, self.contacts)

    @property
    def PEAK(self) -> str:
        """The column that an incremental dynamic analysis collects; it is infinite for what has overturned."""
        return subject_of(self.case).PEAK

    def __repr__(self) -> str:
        inputs = "" if self.contacts is None else f", {self.contacts}"
        inputs = f", e = {self.e}" if self.solver == "analytical" else inputs
        options = "".join(f", {name} = {value}" for name, value in self.options.items())
        return f"<Analysis by {self.solver} of {self.case!r}{inputs}{options}>"

    def solve(self) -> Response:
        """The response."""
        if self.solver != "analytical":
            return solver_named(self.solver)(self.case, self.contacts, **self.options)
        with warnings.catch_warnings():  # the warning came when the analysis was made
            warnings.filterwarnings("ignore", message="the restitution is that of ", category=Implausible)
            return solver_named(self.solver)(self.case, self.e, **self.options)

    def __call__(self, history: Path | None = None) -> Row:
        """Solve, keep the history in the file given, and return the columns of the row."""
        response = self.solve()
        if history is not None:
            save_history(response, history)
        values = subject_of(self.case).values(response, self.law)
        ending = float(response.t[-1]), response.message
        forces = () if response.kept_forces is None else (response.forces.largest_reaction,)
        further = *_columns_of_ties(response), *forces, *_columns_of_actuators(response)
        return dict(zip(self.COLUMNS, (*values, *ending, *further), strict=True))


def _columns_of_ties(response: Response) -> Iterator[float | None]:
    """The columns of ties. A tie that did not yield has an elongation and an energy of zero."""
    for name, tie in response.ties.items():
        plastic = response.plastic.get(name, Plastic(0.0, 0.0))
        broken = None if math.isinf(plastic.broken) else plastic.broken
        yield from (plastic.elongation, tie.largest_force, plastic.energy + plastic.lost, broken)


def _columns_of_actuators(response: Response) -> Iterator[float]:
    """The columns of actuators. Their largest force is that among the samples, with its sign."""
    for name, force in response.actuators.items():
        yield float(force[np.abs(force).argmax()])
        if response.ledger is not None:
            yield float(response.ledger.actuators[name][-1])


@dataclass(frozen=True, repr=False)
class MasonryAnalysis(Analysis):
    """`Analysis` of masonry, with the arguments case, options, labels and, by its name, solver.

    The solver is "MuJoCo", or "explicit" for `solve_explicit`, which is the faster one from some eight blocks on.
    """

    case: MasonryCase
    solver: str = field(default="MuJoCo", kw_only=True)
    e: None = field(default=None, init=False)
    contacts: None = field(default=None, init=False)


def save_history(response: Response, path: Path) -> None:
    """Write t [s], theta and omega [rad, rad/s], or pose and velocity of masonry, and energy [J] to an .npz file.

    Where the run has kept forces, normal, shear, eccentricity and moment follow, and the reaction of each fixed block.
    """
    names = ("theta", "omega") if response.joints is None else ("pose", "velocity")
    arrays = {name: getattr(response, name) for name in ("t", *names, "energy")}
    if response.kept_forces is not None:
        arrays |= {name: getattr(response.forces, name) for name in ("normal", "shear", "eccentricity", "moment")}
        arrays |= {f"reaction of {name}": force for name, force in response.reactions.items()}
    write_arrays(path, **arrays)
