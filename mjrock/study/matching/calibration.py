"""Calibration of a damping law in the engine: the flowchart of the paper's Figure 2.

For each combination of wall, stiffness and release, and for each required restitution, a `Match` finds the
damping ratio: first two-sided for the base, then one-sided for the side with the damping of the base presumed. The
matched pairs are regressed on the dimensionless groups of `mjrock.problem.damping.law`, see `regress`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated, Unpack

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from ...problem.damping.law import (
    HIGHEST_XI,
    LEAST_XI,
    REACH_MARGIN,
    BedLaw,
    CornerLaw,
    DampingLaw,
    Form,
    Groups,
    PowerLaw,
    SideLaw,
)
from ...problem.damping.restitution import Restitution
from ...quantities import (
    Array,
    Flags,
    Within,
    keep,
    keep_declared,
    require_array,
    require_kind,
    require_whole,
    require_within,
    short_repr,
)
from ..campaign.campaign import CampaignOptions, completed
from ..campaign.task import Row, programs
from .match import K_N_RANGE, R_RANGE, SLENDERNESS_RANGE, Combination, GivenWall, Match, combinations


@dataclass(frozen=True)
class Plan:
    """What a calibration matches.

    Args:
        base_count, side_count: combinations for the base and for the side, 1 to 100000.
        losses: base losses -ln e_2s in multiples of Eq. 2's; e is varied independently of the slenderness.
        side_losses: the same, for which the side is matched.
        sides: restitutions |e_side| that the side is matched to.
        seed: of the combinations, 0 to 2147483648.
        k_n: interface stiffnesses that are covered [N/m3].
        amplitude: releases theta_0/alpha that are covered [-]. Low ones stand for later rebounds.
    """

    base_count: Annotated[int, Within(1, 100_000, whole=True)] = 160
    side_count: Annotated[int, Within(1, 100_000, whole=True)] = 240
    losses: tuple[float, ...] = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 2.0)
    side_losses: tuple[float, ...] = (0.8, 1.0, 1.25)
    sides: tuple[float, ...] = (0.2, 0.3, 0.4, 0.5, 0.6)
    seed: Annotated[int, Within(0, 2**31, whole=True)] = 1
    k_n: tuple[float, float] = K_N_RANGE
    amplitude: tuple[float, float] = (0.08, 0.8)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep_declared(self)
        for name, low, high in (("losses", 0.0, 10.0), ("side_losses", 0.0, 10.0), ("sides", 1e-3, 1.0)):
            values = getattr(self, name)
            require_kind(name, values, tuple)
            keep(self, **{name: tuple(require_within(name, value, low, high) for value in values)})
            if not values:
                raise ValueError(f"{name} is empty; at least one value is needed")
        for name, low, high in (("k_n", 1e4, 1e14), ("amplitude", 0.01, 0.95)):
            lower, upper = require_array(name, getattr(self, name), (2,)).tolist()
            require_within(f"{name}, lower end", lower, low, high)
            require_within(f"{name}, upper end", upper, lower, high)
            keep(self, **{name: (lower, upper)})

    def base_tasks(self, points: int, measure: str = "restitution", accuracy: float = 1e-4) -> list[Match]:
        """Two-sided matches; `measure` and `accuracy` are those of `Match`."""
        return [
            Match(combination, Restitution(_housner_e(combination) ** share, -0.5), points, None, measure, accuracy)
            for combination in combinations(self.base_count, self.seed, self.k_n, self.amplitude)
            for share in self.losses
        ]

    def side_tasks(self, points: int, base: Form, measure: str = "restitution", accuracy: float = 1e-4) -> list[Match]:
        """One-sided matches, presuming the damping of the base that `base` predicts.

        `measure` and `accuracy` are those of `Match`. The losses of the base are varied where they can be; elsewhere
        they are those of Eq. 2.
        """
        tasks = []
        for i, combination in enumerate(combinations(self.side_count, self.seed + 1, self.k_n, self.amplitude)):
            e_base = _housner_e(combination) ** self.side_losses[i % len(self.side_losses)]
            if not LEAST_XI < _base_damping(combination, Restitution(e_base, -0.5), base) < HIGHEST_XI:
                e_base = _housner_e(combination)
            for side in self.sides:
                e = Restitution(e_base, -side)
                xi_base = presumed_damping(combination, e, base)
                tasks.append(Match(combination, e, points, xi_base, measure, accuracy))
        return tasks


def _housner_e(combination: Combination) -> float:
    return Restitution.from_geometry(combination.wall).base


def _base_damping(combination: Combination, e: Restitution, base: Form) -> float:
    groups = Match(combination, e).groups
    return float(base.xi(groups, groups.base_loss))


def presumed_damping(combination: Combination, e: Restitution, base: Form) -> float:
    """The damping ratio of the base that a one-sided match presumes [-], to six digits."""
    return float(f"{min(max(_base_damping(combination, e, base), LEAST_XI), HIGHEST_XI):.6g}")


@dataclass(frozen=True)
class Calibration:
    """A fitted law, its regressions for base and side, and the tasks and rows of every search, reached or not."""

    law: DampingLaw
    base: Regression
    side: Regression
    base_tasks: list[Match]
    base_rows: list[Row]
    side_tasks: list[Match]
    side_rows: list[Row]


def calibrate(
    name: str,
    store: str | Path,
    *,
    points: int = 2,
    plan: Plan | None = None,
    measure: str = "restitution",
    accuracy: float = 1e-4,
    **options: Unpack[CampaignOptions],
) -> Calibration:
    """Calibrate a law for one contact layout: base two-sided, then side one-sided.

    Args:
        name: the name of the law.
        store: the campaign's file, from which a killed calibration carries on.
        points: contact lines a face; 2 are fitted with `CornerLaw`, more with `BedLaw`.
        plan: what is matched, `Plan()` by default.
        measure: see `Match`.
        accuracy: of the simulations, as that of `Match`.
        options: those of `campaign`, such as `workers`.

    Raises:
        ValueError, OSError, RuntimeError: as `completed` and `regress`.
    """
    require_kind("name", name, str)
    points = require_whole("points", points, 2, 1000)
    require_kind("plan", plan, Plan, type(None))
    plan = plan or Plan()
    base_tasks = plan.base_tasks(points, measure=measure, accuracy=accuracy)
    base_rows = completed(base_tasks, store, **options)
    base = regress(CornerLaw if points == 2 else BedLaw, base_tasks, base_rows)
    side_tasks = plan.side_tasks(points, base.form, measure=measure, accuracy=accuracy)
    side_rows = completed(side_tasks, store, **options)
    side = regress(SideLaw, side_tasks, side_rows)
    law = DampingLaw(
        name=name,
        source=f"mjrock.calibration over Table 1 of the paper up to {plan.k_n[1]:.0e} N/m3, {points} contact lines a "
        f"face, {programs()}; scripts/paper/calibrate.py makes it",
        base=base.form,
        side=side.form,
        R_range=R_RANGE,
        slenderness_range=SLENDERNESS_RANGE,
        k_n_range=plan.k_n,
        side_range=(min(plan.sides), max(plan.sides)),
        points=points,
        scalable=True,
        runs=(len(base.xi), len(side.xi)),
        errors={"base": base.errors, "side": side.errors},
    )
    return Calibration(law, base, side, base_tasks, base_rows, side_tasks, side_rows)


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
    """A form that is fitted to matched pairs.

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
    combinations: list[Combination | GivenWall]
    loss: Array
    logarithmic: float
    held_out: float


def r_squared(predicted: Array, xi: Array) -> float:
    """The coefficient of determination [-]."""
    return float(1 - np.sum((predicted - xi) ** 2) / np.sum((xi - xi.mean()) ** 2))


def coefficients(form: type) -> list[str]:
    """Names of the coefficients of a form."""
    return [entry.name for entry in fields(form) if entry.name != "r_squared"]


def well_matched(row: Row) -> bool:
    """Whether a row was reached, and for the base not within REACH_MARGIN of an end of the reachable range."""
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
        tasks, rows: the matches, and the rows that `completed` returned.

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
    number = {combination: i for i, combination in enumerate(dict.fromkeys(combinations))}
    fold = np.array([number[combination] % FOLDS for combination in combinations])
    start = np.array(STARTS[form])
    bounds = (1e-12, math.inf) if form is PowerLaw else tasks[0].bounds  # the paper's form has none

    def predict(values: Array) -> Array:
        fitted: Form = form(*values, r_squared=math.nan)
        return np.asarray(np.clip(fitted.xi(groups, loss), *bounds))

    def fit(included: Flags, guess: Array) -> OptimizeResult:
        def residuals(values: Array) -> Array:
            return np.asarray(np.log(predict(values) / xi)[included])

        return least_squares(residuals, guess, x_scale=np.abs(start), loss="soft_l1", f_scale=0.1)

    full_fit = fit(np.ones(len(xi), dtype=bool), start)
    predicted = predict(full_fit.x)
    unseen = np.empty_like(xi)
    for part in range(FOLDS):
        if (fold == part).any():
            unseen[fold == part] = predict(fit(fold != part, full_fit.x).x)[fold == part]
    variance = 2 * full_fit.cost / (len(xi) - len(names))
    spread = np.sqrt(np.diag(np.linalg.pinv(full_fit.jac.T @ full_fit.jac)) * variance)
    return Regression(
        form=form(*full_fit.x.tolist(), r_squared=r_squared(predicted, xi)),
        errors=dict(zip(names, spread.tolist(), strict=True)),
        xi=xi,
        predicted=predicted,
        groups=groups,
        combinations=combinations,
        loss=loss,
        logarithmic=r_squared(np.log(predicted), np.log(xi)),
        held_out=r_squared(unseen, xi),
    )
