"""Calibration of a damping law in the engine: the flowchart of the paper's Figure 2.

For each combination of wall, stiffness and release, and for each restitution that is asked for, a `Match` finds the
damping ratio: first two-sided for the base, then one-sided for the side with the damping of the base presumed. The
matched pairs are regressed on the dimensionless groups of `mjrock.problem.damping.law`, see
`mjrock.study.matching.regression`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Unpack

import numpy as np

from ...problem.damping.law import HIGHEST_XI, LEAST_XI, BedLaw, CornerLaw, DampingLaw, Form, SideLaw
from ...problem.damping.restitution import Restitution
from ...quantities import (
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
from ..campaign.task import VERSION, Row
from .match import AMPLITUDE_RANGE, K_N_RANGE, R_RANGE, SLENDERNESS_RANGE, Combination, Match, combinations
from .regression import Regression, regress


@dataclass(frozen=True)
class Plan:
    """What a calibration matches.

    Args:
        base_count, side_count: combinations for the base and for the side, 1 to 100000.
        losses: base losses -ln e_2s in multiples of Eq. 2's; e is varied independently of the slenderness.
        side_losses: the same, for which the side is matched.
        sides: restitutions |e_side| asked of the side.
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
            first, last = require_array(name, getattr(self, name), (2,)).tolist()
            require_within(f"{name}, lower end", first, low, high)
            require_within(f"{name}, upper end", last, first, high)
            keep(self, **{name: (first, last)})

    def base_tasks(self, points: int, measure: str = "restitution", accuracy: float = 1e-4) -> list[Match]:
        """Two-sided matches; `measure` and `accuracy` are those of `Match`."""
        return [
            Match(
                combination,
                Restitution(_housner(combination) ** share, -0.5),
                points,
                measure=measure,
                accuracy=accuracy,
            )
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
            e_base = _housner(combination) ** self.side_losses[i % len(self.side_losses)]
            if not LEAST_XI < _base_damping(combination, Restitution(e_base, -0.5), base) < HIGHEST_XI:
                e_base = _housner(combination)
            for side in self.sides:
                e = Restitution(e_base, -side)
                tasks.append(
                    Match(
                        combination,
                        e,
                        points,
                        presumed_damping(combination, e, base),
                        measure=measure,
                        accuracy=accuracy,
                    )
                )
        return tasks


def _housner(combination: Combination) -> float:
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
        f"face, {VERSION}; scripts/paper/calibrate.py makes it",
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


def sweep(start: Combination) -> list[tuple[str, Combination]]:
    """Combinations that differ from `start` in one parameter, at five values through its range of Table 1."""
    swept: list[tuple[str, Combination]] = []
    ranges = {"R": R_RANGE, "slenderness": SLENDERNESS_RANGE, "k_base": K_N_RANGE, "k_side": K_N_RANGE}
    for name, (low, high) in (ranges | {"amplitude": AMPLITUDE_RANGE}).items():
        swept += [(name, replace(start, **{name: float(value)})) for value in np.geomspace(low, high, 5)]
    return swept
