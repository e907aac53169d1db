"""The steps and the conditions of a check, and the conditions as a table."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ...contacts.files import aligned
from ...quantities import ratio_text


class Step(NamedTuple):
    """One step of a check.

    Args:
        key: which it is, see `CHECK_STEPS`.
        value: in the unit.
        clause: where it stands in the code; none of a ratio.
        unit: of the value.
        of: the tie or the limit state that it is of.
    """

    key: str
    value: float
    clause: str = ""
    unit: str = ""
    of: str = ""


class Verdict(NamedTuple):
    """One condition of a check.

    Args:
        what: which it is.
        limit_state: of the code, such as "SLV".
        demand, capacity: in the unit.
        unit: of both.
        clause: where it stands in the code.
    """

    what: str
    limit_state: str
    demand: float
    capacity: float
    unit: str
    clause: str

    def __repr__(self) -> str:
        return (
            f"<{self.what}, {self.limit_state}: {self.capacity:.4g} for {self.demand:.4g} {self.unit}, "
            f"ratio {ratio_text(self.ratio)} {self.label}, {self.clause}>"
        )

    @property
    def ratio(self) -> float:
        """Capacity over demand [-]."""
        return self.capacity / self.demand if self.demand > 0 else math.inf

    @property
    def holds(self) -> bool:
        """Whether the capacity is at least the demand."""
        return self.ratio >= 1

    @property
    def label(self) -> str:
        """HOLDS or FAILS."""
        return "HOLDS" if self.holds else "FAILS"


def verdict_rows(verdicts: Sequence[Verdict]) -> list[tuple[str, ...]]:
    """Conditions as rows of a table: limit state, demand, capacity, ratio, HOLDS or FAILS, and the clause."""
    rows: list[tuple[str, ...]] = [("check", "state", "demand", "capacity", "unit", "ratio", "verdict", "clause")]
    for verdict in verdicts:
        numbers = f"{verdict.demand:.4f}", f"{verdict.capacity:.4f}", verdict.unit, ratio_text(verdict.ratio)
        rows.append((verdict.what, verdict.limit_state, *numbers, verdict.label, verdict.clause))
    return rows


def verdicts_of(verdicts: Sequence[Verdict]) -> str:
    """Conditions as a table in text, see `verdict_rows`."""
    return "\n".join(aligned(verdict_rows(verdicts), "<"))
