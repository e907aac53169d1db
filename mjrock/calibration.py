"""Calibration of a damping law in the engine: the flowchart of the paper's Figure 2.

For each combination of wall, stiffness and release, and for each restitution that is asked for, a search finds the
damping ratio whose simulation is closest to the analytical response: first two-sided for the base (`Match` with no
`xi_base`), then one-sided for the side with the damping of the base presumed. The matched pairs are regressed on the
dimensionless groups of `mjrock.damping`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, least_squares, minimize_scalar

from .analytical import solve_analytical
from .block import Block, require_within
from .campaign import VERSION, completed
from .case import Case
from .compare import compare
from .damping import DENSITY, HIGHEST, LEAST, BedLaw, CornerLaw, DampingLaw, Form, Groups, PowerLaw, SideLaw
from .interface import Contacts
from .response import Response
from .restitution import Restitution
from .simulation import simulate

Array = NDArray[np.float64]
Row = dict[str, Any]

R_RANGE, SLENDERNESS_RANGE, AMPLITUDE_RANGE, K_N_RANGE = (1.4, 2.8), (4.0, 15.0), (0.3, 0.8), (0.5e8, 30e8)
"""Table 1: half diagonal [m], h/b [-], theta_0/alpha [-], interface stiffness of base and of side [N/m3]."""
BASE_BOUNDS, SIDE_BOUNDS = (LEAST, HIGHEST), (1e-4, HIGHEST)
"""Damping ratios that are searched [-]."""
SCAN = 3.0
"""Ratio of neighbouring damping ratios while the search goes down for a bracket [-]."""
XI_TOLERANCE = 1e-3
"""Relative tolerance of a matched damping ratio [-]."""
E_TOLERANCE = 5e-3
"""Relative difference to the restitution asked for at which a search has missed it [-]."""
MARGIN = 0.03
"""Share of the reachable range, at either end, in which any damping ratio gives the same restitution [-]."""
MEASURES = ("restitution", "rms")


@dataclass(frozen=True)
class Combination:
    """A wall and its interfaces, as Table 1 lists them.

    Args:
        R: half diagonal [m].
        slenderness: h/b [-].
        k_base, k_side: interface stiffness [N/m3].
        amplitude: theta_0/alpha of the release [-].
    """

    R: float = 2.1
    slenderness: float = 7.0
    k_base: float = 5e8
    k_side: float = 5e8
    amplitude: float = 0.5

    @property
    def wall(self) -> Block:
        """The wall, 1 m long, of 2000 kg/m3."""
        return Block.from_slenderness(self.slenderness, self.R, density=DENSITY)


REFERENCE = Combination()
"""The reference values of Table 1."""


def combinations(count: int, seed: int) -> list[Combination]:
    """Combinations that fill Table 1 evenly (a Latin hypercube), stiffnesses on a logarithmic scale.

    Each parameter takes `count` values, one in each of `count` equal strata of its range. Two seeds share no
    combination.
    """
    ranges = np.array([R_RANGE, SLENDERNESS_RANGE, np.log(K_N_RANGE), np.log(K_N_RANGE), AMPLITUDE_RANGE])
    rng = np.random.default_rng(seed)
    strata = rng.permuted(np.tile(np.arange(count), (len(ranges), 1)), axis=1).T
    shares = (strata + rng.random(strata.shape)) / count
    made = []
    for R, slenderness, k_base, k_side, amplitude in (ranges[:, 0] + shares * np.ptp(ranges, axis=1)).tolist():
        made.append(Combination(R, slenderness, math.exp(k_base), math.exp(k_side), amplitude))
    return made


@dataclass(frozen=True)
class Match:
    """A task of a campaign: the damping ratio that reproduces one restitution on one combination.

    Args:
        combination: the wall and its interfaces.
        e: what is asked for: `e.base` two-sided, `e.lumped` one-sided.
        points: contact lines a face.
        xi_base: None to match the base two-sided; the damping ratio of the base to match the side one-sided.
        measure: "restitution", |e| of the first rebound, matched to the digit on the branch of high damping; or "rms",
            the root mean square difference of theta over three quarters of a period, minimised, as in the paper.
        accuracy: what the fitted steps aim at, see `simulate`.
    """

    COLUMNS: ClassVar[tuple[str, ...]] = ("reached", "xi", "found", "lowest", "highest", "rms", "runs")

    combination: Combination
    e: Restitution
    points: int = 2
    xi_base: float | None = None
    measure: str = "restitution"
    accuracy: float = 1e-4

    def __post_init__(self) -> None:
        if self.measure not in MEASURES:
            raise ValueError(f"measure = {self.measure!r} is none of {', '.join(MEASURES)}")
        if self.xi_base is not None:
            require_within("damping ratio of the base xi_base", self.xi_base, 0.0, 1.0)

    @property
    def target(self) -> float:
        """The restitution of the rebound that is asked for, |e| [-]."""
        return self.e.base if self.xi_base is None else abs(self.e.lumped)

    @property
    def labels(self) -> Mapping[str, object]:
        """What is matched on what."""
        one = self.combination
        return {
            "match": "base" if self.xi_base is None else "side",
            "points": self.points,
            "measure": self.measure,
            **{name.name: getattr(one, name.name) for name in fields(one)},
            "e_base": self.e.base,
            "e_side": self.e.side,
            "xi_base": self.xi_base,
        }

    @property
    def groups(self) -> Groups:
        """The dimensionless groups that the damping ratio is regressed on."""
        one = self.combination
        return Groups.of(one.wall, self.e, one.k_base, one.k_side, one.amplitude)

    @property
    def loss(self) -> float:
        """The loss -ln|e| of the impact that is matched [-]."""
        return -math.log(self.e.base if self.xi_base is None else abs(self.e.side))

    def respond(self, xi: float, quarters: float = 3.0) -> Response:
        """The simulation with damping ratio `xi` over `quarters` of the period of the release."""
        one, wall = self.combination, self.combination.wall
        if self.xi_base is None:
            contacts = Contacts.from_damping(wall, k_base=one.k_base, xi_base=xi, points=self.points)
        else:
            contacts = Contacts.from_damping(
                wall, k_base=one.k_base, xi_base=self.xi_base, k_side=one.k_side, xi_side=xi, points=self.points
            )
        return simulate(self._case(quarters), contacts, accuracy=self.accuracy)

    def _case(self, quarters: float) -> Case:
        wall = self.combination.wall
        quarter = math.acosh(1 / (1 - self.combination.amplitude)) / wall.p
        theta0 = self.combination.amplitude * wall.alpha
        return Case(wall, theta0, quarters * quarter, side_stop=self.xi_base is not None)

    def restitution(self, xi: float) -> float:
        """|e| of the first rebound with damping ratio `xi`; 0 where the wall does not rock again."""
        for quarters in (3.0, 6.0):  # a wall on a soft bed rocks slower than a rigid one
            response = self.respond(xi, quarters)
            if len(response.restitution):
                return float(response.restitution[0])
        return 0.0

    def difference(self, xi: float) -> float:
        """Root mean square difference of theta to the analytical response, in multiples of alpha [-]."""
        return compare(solve_analytical(self._case(3.0), self.e), self.respond(xi)).rms

    def __call__(self, history: Path | None = None) -> Row:
        """Search, and return the columns."""
        bounds = BASE_BOUNDS if self.xi_base is None else SIDE_BOUNDS
        if self.measure == "rms":
            found = least_difference(self.difference, bounds)
            return found.row | {"found": self.restitution(found.xi), "rms": found.value}
        return highest_branch(self.restitution, self.target, bounds, whole=self.xi_base is None).row


@dataclass(frozen=True)
class Found:
    """What a search found.

    Args:
        reached: whether the target is met inside the bounds.
        xi: the damping ratio [-], the closest one where it is not.
        value: what is measured there.
        lowest, highest: the range of the measure on the branch that was searched.
        runs: how many simulations it took.
    """

    reached: bool
    xi: float
    value: float
    lowest: float
    highest: float
    runs: int

    @property
    def row(self) -> Row:
        """As columns of a campaign."""
        return {
            "reached": int(self.reached),
            "xi": self.xi,
            "found": self.value,
            "lowest": self.lowest,
            "highest": self.highest,
            "rms": None,
            "runs": self.runs,
        }


def highest_branch(
    measure: Callable[[float], float], target: float, bounds: tuple[float, float], *, whole: bool = True
) -> Found:
    """The highest damping ratio at which `measure`, a restitution, is `target`.

    Several damping ratios can give one restitution: little damping lets the wall bounce, and a bounce may cost as much
    as a dashpot. The search starts at the upper bound and goes down while the restitution rises; where it has begun to
    fall again the branch of high damping has ended, and what lies below is not looked at. Without `whole` it stops
    looking where the target is passed, and `highest` is what it has seen.
    """
    known: dict[float, float] = {}

    def at(log_xi: float) -> float:
        if log_xi not in known:
            known[log_xi] = measure(math.exp(log_xi))
        return known[log_xi]

    low, high = (math.log(bound) for bound in bounds)
    grid = np.linspace(high, low, 1 + math.ceil((high - low) / math.log(SCAN))).tolist()
    bottom = top = grid[0]
    for here in grid[1:]:
        if at(here) < at(top) and at(top) > at(bottom):
            break  # the branch has ended
        if at(here) < at(bottom):
            bottom = here  # overdamped: a little less damping loses more
        top = here
        if at(bottom) < target <= at(top) and not whole:
            break
    lowest, highest = at(bottom), at(top)
    if not lowest < target <= highest:
        best = top if target > highest else bottom
        return Found(False, math.exp(best), at(best), lowest, highest, len(known))
    best = float(brentq(lambda log_xi: at(log_xi) - target, top, bottom, xtol=XI_TOLERANCE))
    reached = abs(at(best) / target - 1) < E_TOLERANCE  # a wall that no longer rocks drops to 0 from one xi to the next
    return Found(reached, math.exp(best), at(best), lowest, highest, len(known))


def least_difference(measure: Callable[[float], float], bounds: tuple[float, float]) -> Found:
    """The damping ratio at which `measure`, a difference, is least; not reached where that is at a bound."""
    known: dict[float, float] = {}

    def at(log_xi: float) -> float:
        known[log_xi] = measure(math.exp(log_xi))
        return known[log_xi]

    low, high = (math.log(bound) for bound in bounds)
    grid = np.linspace(high, low, 1 + math.ceil((high - low) / math.log(SCAN))).tolist()
    values = [at(here) for here in grid]
    i = int(np.argmin(values))
    best = grid[i]
    inside = 0 < i < len(grid) - 1
    if inside:
        found = minimize_scalar(at, bounds=(grid[i + 1], grid[i - 1]), method="bounded", options={"xatol": 1e-2})
        best = min(known, key=lambda log_xi: known[log_xi])
        inside = bool(found.success)
    return Found(inside, math.exp(best), known[best], min(values), max(values), len(known))


STARTS: dict[type, tuple[float, ...]] = {
    PowerLaw: (0.1, -1.0, 0.1),
    CornerLaw: (2.6, 1.8, 0.4, 0.2, -0.5, 10.0),
    BedLaw: (0.16, 7.5, 1.2, 0.55),
    SideLaw: (0.25, -1.5, -0.5, 2.0, 0.4, 9.0),
}
"""Where the fit of a form starts."""


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

    form: Any
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


def well_matched(row: Mapping[str, Any]) -> bool:
    """Whether a row was reached, and for the base not in the MARGIN at an end of the reachable range."""
    if not row["reached"] or row["match"] == "side" or row["measure"] == "rms":
        return bool(row["reached"])
    width = MARGIN * (row["highest"] - row["lowest"])
    return bool(row["lowest"] + width <= row["found"] <= row["highest"] - width)


def regress(form: type, tasks: Sequence[Match], rows: Sequence[Row], folds: int = 10) -> Regression:
    """Fit a form to the matches that were reached, by least squares on ln xi, robust (soft L1) beyond 10 %.

    Predictions are held within the bounds of the search. The pairs of one combination are held out together in the
    cross-validation.

    Args:
        form: `CornerLaw` or `BedLaw` for the base, `SideLaw` for the side, the paper's `PowerLaw` for either.
        tasks, rows: what was asked and what `completed` returned.
        folds: into how many parts the combinations are split.

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
    members = list(dict.fromkeys(task.combination for task, _ in reached))
    place = {member: i for i, member in enumerate(members)}
    fold = np.array([place[task.combination] % folds for task, _ in reached])

    start = np.array(STARTS[form])
    bounds = BASE_BOUNDS if tasks[0].xi_base is None else SIDE_BOUNDS
    if form is PowerLaw:
        bounds = (1e-12, math.inf)  # the paper's form knows of none

    def predict(values: Array) -> Array:
        made: Form = form(*values, r_squared=math.nan)
        held: Array = np.clip(made.xi(groups, loss), *bounds)
        return held

    def fit(kept: NDArray[np.bool_], begin: Array) -> Any:
        def residuals(values: Array) -> Array:
            ratio: Array = np.log(predict(values) / xi)
            return ratio[kept]

        return least_squares(residuals, begin, x_scale=np.abs(start), loss="soft_l1", f_scale=0.1)

    everything = fit(np.ones(len(xi), dtype=bool), start)
    predicted = predict(everything.x)
    unseen = np.empty_like(xi)
    for part in range(folds):
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
        combinations=[task.combination for task, _ in reached],
        loss=loss,
        logarithmic=r_squared(np.log(predicted), np.log(xi)),
        held_out=r_squared(unseen, xi),
    )


@dataclass(frozen=True)
class Plan:
    """What a calibration matches.

    Args:
        base_count, side_count: combinations for the base and for the side.
        losses: base losses -ln e_2s in multiples of Eq. 2's; e is varied independently of the slenderness.
        side_losses: the same, for which the side is matched.
        sides: restitutions |e_side| asked of the side.
        seed: of the combinations.
    """

    base_count: int = 160
    side_count: int = 240
    losses: tuple[float, ...] = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 2.0)
    side_losses: tuple[float, ...] = (0.8, 1.0, 1.25)
    sides: tuple[float, ...] = (0.2, 0.3, 0.4, 0.5, 0.6)
    seed: int = 1

    def base_tasks(self, points: int, **options: Any) -> list[Match]:
        """Two-sided matches; `options` are those of `Match`."""
        return [
            Match(one, Restitution(_housner(one) ** share, -0.5), points, **options)
            for one in combinations(self.base_count, self.seed)
            for share in self.losses
        ]

    def side_tasks(self, points: int, base: Form, **options: Any) -> list[Match]:
        """One-sided matches, presuming the damping of the base that `base` predicts; `options` are those of `Match`.

        The losses of the base are varied where they can be; elsewhere they are those of Eq. 2.
        """
        tasks = []
        for i, one in enumerate(combinations(self.side_count, self.seed + 1)):
            e_base = _housner(one) ** self.side_losses[i % len(self.side_losses)]
            if not LEAST < _base_damping(one, Restitution(e_base, -0.5), base) < HIGHEST:
                e_base = _housner(one)
            for side in self.sides:
                e = Restitution(e_base, -side)
                tasks.append(Match(one, e, points, presumed_damping(one, e, base), **options))
        return tasks


def _housner(one: Combination) -> float:
    return Restitution.from_geometry(one.wall.alpha).base


def _base_damping(one: Combination, e: Restitution, base: Form) -> float:
    groups = Groups.of(one.wall, e, one.k_base, one.k_side, one.amplitude)
    return float(base.xi(groups, groups.base_loss))


def presumed_damping(one: Combination, e: Restitution, base: Form) -> float:
    """The damping ratio of the base that a one-sided match presumes [-], to six digits."""
    return float(f"{min(max(_base_damping(one, e, base), LEAST), HIGHEST):.6g}")


@dataclass(frozen=True)
class Calibration:
    """A fitted law and what it was fitted to.

    Args:
        law: the law.
        base, side: its regressions.
        base_tasks, base_rows: every search for the base, reached or not.
        side_tasks, side_rows: the same for the side.
    """

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
    **options: Any,
) -> Calibration:
    """Calibrate a law for one contact layout: base two-sided, then side one-sided.

    Args:
        name: the name of the law.
        store: the campaign's file, from which a killed calibration carries on.
        points: contact lines a face; 2 are fitted with `CornerLaw`, more with `BedLaw`.
        plan: what is matched, `Plan()` by default.
        measure: see `Match`.
        options: `executor` and `workers` of `campaign`, `accuracy` of `Match`.

    Raises:
        ValueError, OSError, RuntimeError: as `completed` and `regress`.
    """
    plan = plan or Plan()
    accuracy = options.pop("accuracy", 1e-4)
    base_tasks = plan.base_tasks(points, measure=measure, accuracy=accuracy)
    base_rows = completed(base_tasks, store, **options)
    base = regress(CornerLaw if points == 2 else BedLaw, base_tasks, base_rows)
    side_tasks = plan.side_tasks(points, base.form, measure=measure, accuracy=accuracy)
    side_rows = completed(side_tasks, store, **options)
    side = regress(SideLaw, side_tasks, side_rows)
    law = DampingLaw(
        name=name,
        source=f"mjrock.calibration over Table 1 of the paper, {points} contact lines a face, {VERSION}; "
        "scripts/calibrate.py makes it",
        base=base.form,
        side=side.form,
        R_range=R_RANGE,
        slenderness_range=SLENDERNESS_RANGE,
        k_n_range=K_N_RANGE,
        side_range=(min(plan.sides), max(plan.sides)),
        points=points,
        scalable=True,
        runs=(len(base.xi), len(side.xi)),
        errors={"base": base.errors, "side": side.errors},
    )
    return Calibration(law, base, side, base_tasks, base_rows, side_tasks, side_rows)


def sweep(start: Combination, count: int = 5) -> list[tuple[str, Combination]]:
    """Combinations that differ from `start` in one parameter, which goes through its range of Table 1."""
    swept: list[tuple[str, Combination]] = []
    ranges = {"R": R_RANGE, "slenderness": SLENDERNESS_RANGE, "k_base": K_N_RANGE, "k_side": K_N_RANGE}
    for name, (low, high) in (ranges | {"amplitude": AMPLITUDE_RANGE}).items():
        swept += [(name, replace(start, **{name: float(value)})) for value in np.geomspace(low, high, count)]
    return swept
