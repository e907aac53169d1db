"""Regression of matched damping ratios on the dimensionless groups of a wall."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ...problem.damping.law import REACH_MARGIN, BedLaw, CornerLaw, Form, Groups, PowerLaw, SideLaw
from ...quantities import Array
from ..campaign.task import Row
from .match import BASE_BOUNDS, SIDE_BOUNDS, Combination, Match

STARTS: dict[type, tuple[float, ...]] = {
    PowerLaw: (0.1, -1.0, 0.1),
    CornerLaw: (2.6, 1.8, 0.4, 0.2, -0.5, 10.0),
    BedLaw: (0.16, 7.5, 1.2, 0.55),
    SideLaw: (0.25, -1.5, -0.5, 2.0, 0.4, 9.0),
}
"""Where the fit of a form starts."""
FOLDS = 10
"""Into how many parts combinations are split to be held out."""


@dataclass(frozen=True)
class Regression:
    """A form fitted to matched pairs.

    Args:
        form: the fitted form, with its R2.
        errors: standard errors of its coefficients by name.
        xi, predicted: matched damping ratios and those of the form [-], shape (n,).
        groups: the groups of the pairs, arrays of shape (n,).
        combinations: what they were matched on, n of them.
        loss: the loss of the pairs [-], shape (n,).
        logarithmic: R2 of ln xi.
        held_out: R2 of xi where each pair is predicted by a fit that has not seen its combination.
    """

    form: Form
    errors: Mapping[str, float]
    xi: Array
    predicted: Array
    groups: Groups
    combinations: list[Combination]
    loss: Array
    logarithmic: float
    held_out: float


def r_squared(predicted: Array, xi: Array) -> float:
    """The coefficient of determination [-]."""
    return float(1 - np.sum((predicted - xi) ** 2) / np.sum((xi - xi.mean()) ** 2))


def coefficients(form: type) -> list[str]:
    """Names of the coefficients of a form."""
    return [name.name for name in fields(form) if name.name != "r_squared"]


def well_matched(row: Row) -> bool:
    """Whether a row was reached, and for the base not in the MARGIN at an end of the reachable range."""
    if not row["reached"] or row["match"] == "side" or row["measure"] == "rms":
        return bool(row["reached"])
    width = REACH_MARGIN * (row["highest"] - row["lowest"])
    return bool(row["lowest"] + width <= row["found"] <= row["highest"] - width)


def regress(form: type, tasks: Sequence[Match], rows: Sequence[Row]) -> Regression:
    """Fit a form to the matches that were reached, by least squares on ln xi, robust (soft L1) beyond 10 %.

    Predictions are held within the bounds of the search. The pairs of one combination are held out together in the
    cross-validation.

    Args:
        form: `CornerLaw` or `BedLaw` for the base, `SideLaw` for the side, the paper's `PowerLaw` for either.
        tasks, rows: what was asked and what `completed` returned.

    Raises:
        ValueError: if fewer pairs were reached than the form has coefficients to fit.
    """
    reached = [(task, row) for task, row in zip(tasks, rows, strict=True) if well_matched(row)]
    names = coefficients(form)
    if len(reached) < 2 * len(names):
        raise ValueError(
            f"{len(reached)} matched pairs are too few for the {len(names)} coefficients of {form.__name__}"
        )
    groups = Groups.stack([task.groups for task, _ in reached])
    loss = np.array([task.loss for task, _ in reached])
    xi = np.array([row["xi"] for _, row in reached])
    combinations = [task.combination for task, _ in reached]
    place = {combination: i for i, combination in enumerate(dict.fromkeys(combinations))}
    fold = np.array([place[combination] % FOLDS for combination in combinations])
    start = np.array(STARTS[form])
    bounds = BASE_BOUNDS if tasks[0].xi_base is None else SIDE_BOUNDS
    if form is PowerLaw:
        bounds = (1e-12, math.inf)  # the paper's form knows of none

    def predict(values: Array) -> Array:
        fitted: Form = form(*values, r_squared=math.nan)
        return np.asarray(np.clip(fitted.xi(groups, loss), *bounds))

    def fit(kept: NDArray[np.bool_], begin: Array) -> Any:
        def residuals(values: Array) -> Array:
            return np.asarray(np.log(predict(values) / xi)[kept])

        return least_squares(residuals, begin, x_scale=np.abs(start), loss="soft_l1", f_scale=0.1)

    everything = fit(np.ones(len(xi), dtype=bool), start)
    predicted = predict(everything.x)
    unseen = np.empty_like(xi)
    for part in range(FOLDS):
        if (fold == part).any():
            unseen[fold == part] = predict(fit(fold != part, everything.x).x)[fold == part]
    variance = 2 * everything.cost / (len(xi) - len(names))
    spread = np.sqrt(np.diag(np.linalg.pinv(everything.jac.T @ everything.jac)) * variance)
    return Regression(
        form=form(*everything.x.tolist(), r_squared=r_squared(predicted, xi)),
        errors=dict(zip(names, spread.tolist(), strict=True)),
        xi=xi,
        predicted=predicted,
        groups=groups,
        combinations=combinations,
        loss=loss,
        logarithmic=r_squared(np.log(predicted), np.log(xi)),
        held_out=r_squared(unseen, xi),
    )
