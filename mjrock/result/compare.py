"""Two responses to one case, side by side: the motion, and the energy lost at each impact."""

from __future__ import annotations

import itertools
import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..contacts.files import csv_text
from ..notebook import NotebookPicture
from ..problem.wall.case import Case
from ..quantities import Array, Integers, require_kind
from .ending import Outcome
from .response import Response
from .rocking import Impact

COMPARED_FROM = 0.01
"""Energy before an impact under ground motion that is too small to be paired, over that which overturns the wall
[-]."""
SAME_IMPACT = 0.25
"""How far apart in time two impacts may be that belong to each other, times p of the wall [-]."""


WIDEST_LINE = 80
"""Columns of a terminal, which no line of a table is longer than."""


class Measure(NamedTuple):
    """A measure of an impact: name and unit, its property of `Comparison`, and its format in a table that has it."""

    name: str
    unit: str
    attribute: str
    form: str | None


MEASURES_OF_IMPACTS = (
    Measure("impact time", "s", "impact_times", "8.4f"),
    Measure("restitution", "-", "restitution", "7.4f"),
    Measure("rebound peak", "theta/alpha", "rebound_peaks", "7.5f"),
    Measure("energy loss", "J", "energy_loss", None),
    Measure("energy loss share", "of release", "energy_share", "7.2%"),
)
HEADINGS = " time [s] ", "restitution [-]", "peak/alpha [-]", "loss / release"
"""Heads of the measures in a table."""


@dataclass(frozen=True)
class Comparison(NotebookPicture):
    """The differences of `candidate` from `reference`. Rebounds are counted from 1; NaN where one has fewer.

    On a base at rest the first impact of one belongs to the first of the other. Under ground motion impacts are paired
    by their times, and those before which the wall has less than a hundredth of the energy that overturns it are left
    out, see `paired`.

    Args:
        reference, candidate: the responses.
        rms: root mean square of the difference of theta/alpha over the time that both cover [-].
    """

    reference: Response
    candidate: Response
    rms: float

    def __repr__(self) -> str:
        pair = self.restitution[0] if len(self.restitution) else (math.nan, math.nan)
        shown = ["none" if math.isnan(value) else f"{value:.4g}" for value in pair]
        impact = "impact 1 under ground motion" if self.case.shaken else "rebound 1"
        return (
            f"<Comparison of {self.candidate.solver} with {self.reference.solver}: |e| of {impact} {shown[1]} for "
            f"{shown[0]}, RMS of theta/alpha {self.rms:.3g}>"
        )

    @property
    def case(self) -> Case:
        """The case that both answer."""
        return self.reference.of_wall[0]

    @property
    def _responses(self) -> tuple[Response, Response]:
        return self.reference, self.candidate

    @property
    def _labels(self) -> tuple[str, str]:
        reference, candidate = (response.solver for response in self._responses)
        return (reference, candidate) if reference != candidate else (f"{reference} 1", f"{candidate} 2")

    @cached_property
    def pairs(self) -> Integers | None:
        """Numbers of the impacts that belong to each other, -1 for none, shape (n, 2); None on a base at rest."""
        case = self.case
        if not case.shaken:
            return None
        outer = case.restoring.outer
        least_energy = COMPARED_FROM * float(outer.energy(max(outer.alpha, 0.0)))
        return paired(self.reference.impacts, self.candidate.impacts, SAME_IMPACT / case.wall.p, least_energy)

    def _values(self, left: Array | list[float], right: Array | list[float]) -> Array:
        every = np.repeat(np.arange(max(len(left), len(right)))[:, None], 2, axis=1)
        return of_impacts(every if self.pairs is None else self.pairs, left, right)

    @property
    def restitution(self) -> Array:
        """|e| per rebound, reference and candidate [-], shape (n, 2)."""
        return self._values(*(r.restitution for r in self._responses))

    @property
    def energy_loss(self) -> Array:
        """Energy lost per impact, reference and candidate [J], shape (n, 2)."""
        return self._values(*([i.energy_loss for i in r.impacts] for r in self._responses))

    @property
    def energy_share(self) -> Array:
        """`energy_loss` as a share of the energy of release [-], shape (n, 2)."""
        released = self.case.release_energy
        return self.energy_loss / (released if released > 0 else math.nan)

    @property
    def impact_times(self) -> Array:
        """Times of the impacts [s], shape (n, 2)."""
        return self._values(*([i.t for i in r.impacts] for r in self._responses))

    @property
    def rebound_peaks(self) -> Array:
        """Rotation maxima after each impact as shares of alpha [-], shape (n, 2).

        Under ground motion each is the largest rotation up to the next impact.
        """
        alpha = self.case.wall.alpha
        if self.pairs is not None:
            return self._values(*(_largest_after(r) / alpha for r in self._responses))
        skip = 0 if self.case.released_outwards else 1
        return self._values(*(r.peaks[skip:] / alpha for r in self._responses))

    @property
    def first_rebound_peak(self) -> tuple[float, float]:
        """The first rotation maximum after an impact as a share of alpha, reference and candidate [-]."""
        first, second = self.rebound_peaks[0].tolist() if len(self.rebound_peaks) else (math.nan, math.nan)
        return first, second

    @property
    def outcomes(self) -> tuple[Outcome, Outcome]:
        """How the reference and the candidate ended."""
        return self.reference.outcome, self.candidate.outcome

    @property
    def _measures(self) -> Array:
        """The measures of all impacts, reference and candidate, shape (n, measures, 2), NaN where one has none."""
        columns = [getattr(self, measure.attribute) for measure in MEASURES_OF_IMPACTS]
        measured = np.full((max(map(len, columns)), len(columns), 2), np.nan)
        for i, values in enumerate(columns):
            measured[: len(values), i] = values
        return measured

    def rows(self) -> list[dict[str, float]]:
        """One row an impact, for a table or a CSV file; names carry their units."""
        labels = self._labels
        names = [f"{measure.name}, {solver} [{measure.unit}]" for measure in MEASURES_OF_IMPACTS for solver in labels]
        values = self._measures.reshape(-1, len(names)).tolist()
        return [{"impact": i + 1} | dict(zip(names, row, strict=True)) for i, row in enumerate(values)]

    def csv(self) -> str:
        """The rows as CSV text; its columns have the names of the rows without commas, see `mjrock.contacts.files`."""
        rows = self.rows()
        if not rows:
            return "impact\n"
        return csv_text(list(rows[0]), [list(row.values()) for row in rows])

    def table(self, most: int = 6) -> str:
        """The first `most` impacts and the totals as text of at most 80 columns; `csv` has the losses in J too."""
        labels = self._labels
        lines = [
            f"Of each impact: {labels[0]}, then {labels[1]}",
            "impact |" + "|".join(f"{heading:^17}" for heading in HEADINGS),
        ]
        for i, row in enumerate(self._measures[: max(0, most)].tolist()):
            cells = (
                " ".join(f"{'-':>{entry.form[0]}}" if math.isnan(value) else f"{value:{entry.form}}" for value in pair)
                for entry, pair in zip(MEASURES_OF_IMPACTS, row, strict=True)
                if entry.form is not None
            )
            lines.append(f"{i + 1:>6} | " + " | ".join(cells))
        if self.pairs is not None:
            lines.append(
                f"Impacts are paired by time; those of less than {COMPARED_FROM:.0%} of the overturning energy are out."
            )
        if self.case.shaken:
            lines.append("Under ground motion the restitution is that of single impacts, and none of free rocking.")
        lines.append(f"RMS difference of theta/alpha: {self.rms:.5f}")
        for label, response in zip(labels, self._responses, strict=True):
            lines.append(f"{label}: {response.message}")
        return "\n".join(part for line in lines for part in textwrap.wrap(line, WIDEST_LINE))


def compare(reference: Response, candidate: Response) -> Comparison:
    """Set two responses to the same case side by side.

    The difference is taken at the reference's samples, the candidate interpolated linearly, over the time both cover.

    Raises:
        TypeError: for responses of masonry.
        ValueError: if the responses answer different cases.
    """
    require_kind("reference", reference, Response)
    require_kind("candidate", candidate, Response)
    for name, response in (("reference", reference), ("candidate", candidate)):
        if response.rocking is None:
            raise TypeError(
                f"{name} is that of masonry; responses of one wall are compared. `mjrock.plotting.history` takes both, "
                "and their opening, sliding, fallen and peak are arrays of equal shapes"
            )
    if reference.case != candidate.case:
        raise ValueError(f"the responses answer different cases: {reference.case} and {candidate.case}")
    common = reference.t <= min(reference.t[-1], candidate.t[-1]) * (1 + 1e-12)
    difference = np.interp(reference.t[common], candidate.t, candidate.theta) - reference.theta[common]
    rms = float(np.sqrt(np.mean(difference**2))) / reference.of_wall[0].wall.alpha
    return Comparison(reference, candidate, rms)


def _largest_after(response: Response) -> Array:
    """Largest |rotation| from each impact to the next [rad], shape (impacts,)."""
    ends = np.searchsorted(response.t, [*(impact.t for impact in response.impacts), np.inf])
    theta = np.abs(response.theta)
    return np.array([theta[first : last + 1].max(initial=0.0) for first, last in itertools.pairwise(ends)])


def paired(left: Sequence[Impact], right: Sequence[Impact], within: float, least: float) -> Integers:
    """Numbers of the impacts of two motions that belong to each other, -1 where one has none, shape (n, 2).

    Two impacts are a pair where each is the nearest to the other in time, `within` [s] of it. Those are left out before
    which the wall has less energy than `least` [J]. All are in the order of their times.
    """
    counted = [[i for i, impact in enumerate(side) if impact.energy_before >= least] for side in (left, right)]
    a, b = (np.array([side[i].t for i in indices]) for side, indices in zip((left, right), counted, strict=True))
    pairs, unpaired = [], set(range(len(b)))
    for i, t in enumerate(a):
        j = int(np.abs(b - t).argmin()) if len(b) else -1
        if j >= 0 and abs(b[j] - t) <= within and int(np.abs(a - b[j]).argmin()) == i:
            pairs.append((t, counted[0][i], counted[1][j]))
            unpaired.discard(j)
        else:
            pairs.append((t, counted[0][i], -1))
    pairs += [(b[j], -1, counted[1][j]) for j in unpaired]
    return np.array([numbers for _, *numbers in sorted(pairs)], dtype=np.int64).reshape(-1, 2)


def of_impacts(numbers: Integers, left: Sequence[float] | Array, right: Sequence[float] | Array) -> Array:
    """Values of the impacts of each pair, NaN where there is none, shape (n, 2)."""
    sides = zip(numbers.T, (left, right), strict=True)
    columns = [[values[i] if 0 <= i < len(values) else np.nan for i in indices] for indices, values in sides]
    return np.array(columns, dtype=float).T.reshape(-1, 2)
