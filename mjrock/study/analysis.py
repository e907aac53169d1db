"""One case for one solver, as a task of a campaign."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

from ..engine.simulation import simulate
from ..files import write_arrays
from ..problem.case import Case
from ..problem.contacts import Contacts
from ..problem.quantities import keep, spelt
from ..problem.restitution import Restitution
from ..reference.compliant import solve_compliant
from ..result.response import Response
from ..theory.analytical import solve_analytical
from .task import Row

SOLVERS: dict[str, Callable[..., Response]] = {
    "analytical": solve_analytical,
    "compliant": solve_compliant,
    "MuJoCo": simulate,
}
OPTIONS = {name: tuple(inspect.signature(solver).parameters)[2:] for name, solver in SOLVERS.items()}
"""The options of each solver."""


@dataclass(frozen=True)
class Analysis:
    """One case for one solver.

    Args:
        case: the case.
        solver: "analytical", "compliant" or "MuJoCo".
        e: coefficients of restitution, for the analytical solver.
        contacts: interfaces, for the other two.
        options: keyword arguments of the solver, such as `accuracy`, `timestep` or `rtol`.
        labels: columns that tell the user which case it is: text, numbers.

    Options and labels are copied: what happens to the mappings given does not reach the analysis.

    Raises:
        ValueError: for a solver or an option that there is not, or if `e` or `contacts` are missing.
        TypeError: for an argument of another type.
    """

    COLUMNS: ClassVar[tuple[str, ...]] = (
        "solver",
        "law",
        "outcome",
        "peak_over_alpha",
        "impacts",
        "restitution_1",
        "restitution_2",
        "restitution_3",
        "end_s",
        "message",
    )

    PEAK: ClassVar[str] = "peak_over_alpha"
    """The column that an incremental dynamic analysis gathers; it is infinite for a wall that has overturned."""

    case: Case
    solver: str = "MuJoCo"
    e: Restitution | None = None
    contacts: Contacts | None = None
    options: Mapping[str, object] = field(default_factory=dict)
    labels: Mapping[str, object] = field(default_factory=dict, compare=False)

    def __post_init__(self) -> None:
        for name, kind in (("case", Case), ("e", Restitution), ("contacts", Contacts)):
            value = getattr(self, name)
            if not isinstance(value, kind) and (value is not None or name == "case"):
                raise TypeError(f"{name} = {spelt(value)} is no {kind.__name__}")
        for name in ("options", "labels"):
            value = getattr(self, name)
            if not isinstance(value, Mapping):
                raise TypeError(f"{name} = {spelt(value)} is no mapping of names to values")
            keep(self, **{name: dict(value)})
        if not isinstance(self.solver, str) or self.solver not in SOLVERS:
            raise ValueError(f"solver = {spelt(self.solver)} is none of {', '.join(SOLVERS)}")
        needed = "e" if self.solver == "analytical" else "contacts"
        if getattr(self, needed) is None:
            raise ValueError(f"the solver {self.solver} needs {needed}")
        if self.contacts is not None and self.solver != "analytical":
            self.contacts.require_fit(self.case.block, side_stop=self.case.one_sided)
        valid = OPTIONS[self.solver]
        unknown = self.options.keys() - set(valid)
        if unknown:
            raise ValueError(
                f"{self.solver} has no option {', '.join(sorted(map(str, unknown)))}; it has {', '.join(valid)}"
            )

    def __repr__(self) -> str:
        by = f"e = {self.e}" if self.solver == "analytical" else f"{self.contacts}"
        options = "".join(f", {name} = {value}" for name, value in self.options.items())
        return f"<Analysis by {self.solver} of {self.case!r}, {by}{options}>"

    def solve(self) -> Response:
        """The response."""
        return SOLVERS[self.solver](self.case, self.e if self.solver == "analytical" else self.contacts, **self.options)

    def __call__(self, history: Path | None = None) -> Row:
        """Solve, keep the history in the file given, and return the columns of the row."""
        return self.row(self.solve(), history)

    def row(self, response: Response, history: Path | None = None) -> Row:
        """The columns of a response, whose history is kept in the file given."""
        if history is not None:
            save_history(response, history)
        restitution = [float(value) for value in response.restitution[:3]] + [None] * 3
        law = "restitution" if self.contacts is None or self.solver == "analytical" else self.contacts.law
        values = (
            self.solver,
            law,
            response.outcome.value,
            response.peak_over_alpha,
            len(response.impacts),
            *restitution[:3],
            float(response.t[-1]),
            response.message,
        )
        return dict(zip(self.COLUMNS, values, strict=True))


def save_history(response: Response, path: Path) -> None:
    """Write t [s], theta [rad], omega [rad/s] and energy [J] to an .npz file."""
    write_arrays(path, t=response.t, theta=response.theta, omega=response.omega, energy=response.energy)
