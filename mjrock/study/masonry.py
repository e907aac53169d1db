"""One case of masonry, as a task of a campaign."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

from ..engine.simulation import simulate
from ..files import write_arrays
from ..problem.masonry_case import MasonryCase
from ..problem.quantities import keep, require_kind, shown
from ..result.masonry import MasonryResponse
from .task import Row

OPTIONS = ("timestep", "accuracy", "newmark_beta", "output_step", "ledger", "start")
"""The options of `simulate`."""


@dataclass(frozen=True)
class MasonryAnalysis:
    """One case of masonry for `simulate`.

    What the joints have has to be numbers: a function of the joint has no content by which a campaign could tell one
    task from another, and such a task becomes a failed row.

    Args:
        case: the case.
        options: keyword arguments of `simulate`, such as `accuracy`.
        labels: columns that tell the user which case it is: text, numbers.

    Raises:
        ValueError: for an option that there is not.
        TypeError: for an argument of another type.
    """

    COLUMNS: ClassVar[tuple[str, ...]] = (
        "outcome",
        "fallen",
        "first_fall_s",
        "largest_opening_m",
        "largest_sliding_m",
        "largest_rotation_rad",
        "end_s",
        "message",
    )

    PEAK: ClassVar[str] = "largest_rotation_rad"
    """The column that an incremental dynamic analysis gathers; it is infinite where a block has fallen."""

    case: MasonryCase
    options: Mapping[str, Any] = field(default_factory=dict)
    labels: Mapping[str, object] = field(default_factory=dict, compare=False)

    def __post_init__(self) -> None:
        require_kind("case", self.case, MasonryCase)
        for name in ("options", "labels"):
            value = getattr(self, name)
            if not isinstance(value, Mapping):
                raise TypeError(f"{name} = {shown(value)} is no mapping of names to values")
            keep(self, **{name: dict(value)})
        unknown = self.options.keys() - set(OPTIONS)
        if unknown:
            raise ValueError(
                f"options: there is no {', '.join(sorted(map(str, unknown)))}; valid: {', '.join(OPTIONS)}"
            )

    def solve(self) -> MasonryResponse:
        """The response."""
        return simulate(self.case, **self.options)

    def __call__(self, history: Path | None = None) -> Row:
        """Solve, keep the history in the file given, and return the columns of the row."""
        answer = self.solve()
        if history is not None:
            save_poses(answer, history)
        values = (
            answer.outcome.value,
            len(answer.fallen),
            min(answer.fallen.values(), default=None),
            float(answer.opening.max()),
            float(answer.sliding.max()),
            math.inf if answer.fallen else float(answer.peak.max()),
            float(answer.t[-1]),
            answer.message,
        )
        return dict(zip(self.COLUMNS, values, strict=True))


def save_poses(answer: MasonryResponse, path: Path) -> None:
    """Write t [s], pose [m, m, rad], velocity and energy to an .npz file."""
    write_arrays(path, t=answer.t, pose=answer.pose, velocity=answer.velocity, energy=answer.energy)
