"""Matches of damping to restitution in the engine: the search loop of the paper's Figure 2, see `Match`."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from ...engine.simulation import simulate
from ...problem.damping.contacts import Contacts
from ...problem.damping.law import DENSITY, HIGHEST_XI, LEAST_XI, Groups
from ...problem.damping.restitution import Restitution
from ...problem.wall.block import Block
from ...problem.wall.case import Case
from ...problem.wall.effects import SideStop
from ...quantities import keep, require_one_of, require_within
from ...result.compare import compare
from ...result.response import Response
from ...theory.analytical import solve_analytical
from ..campaign.task import Row

R_RANGE, SLENDERNESS_RANGE, AMPLITUDE_RANGE, K_N_RANGE = (1.4, 2.8), (4.0, 15.0), (0.3, 0.8), (0.5e8, 30e8)
"""Table 1: half diagonal [m], h/b [-], theta_0/alpha [-], interface stiffness of base and of side [N/m3]."""
MOST_UNLIKE = 60.0
"""Largest ratio of the stiffnesses of base and side in Table 1 [-]."""
BASE_BOUNDS, SIDE_BOUNDS = (LEAST_XI, HIGHEST_XI), (1e-4, HIGHEST_XI)
"""Damping ratios that are searched [-]."""
SCAN = 3.0
"""Ratio of neighbouring damping ratios while the search goes down for a bracket [-]."""
XI_TOLERANCE = 1e-3
"""Relative tolerance of a matched damping ratio [-]."""
E_TOLERANCE = 5e-3
"""Relative difference to the required restitution from which on a search has missed it [-]."""
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

    side_stop: ClassVar[bool | SideStop] = True

    @property
    def wall(self) -> Block:
        """The wall, 1 m long, of 2000 kg/m3."""
        return Block.from_slenderness(self.slenderness, self.R, density=DENSITY)


REFERENCE = Combination()
"""The reference values of Table 1."""


@dataclass(frozen=True)
class GivenWall:
    """A given wall on its interfaces, in place of a `Combination` of Table 1.

    Args:
        wall: the wall.
        k_base, k_side: interface stiffness [N/m3].
        amplitude: theta_0/alpha of the release [-].
        side_stop: the side that the wall is matched against.
    """

    wall: Block
    k_base: float
    k_side: float
    amplitude: float
    side_stop: bool | SideStop = True


def combinations(
    count: int, seed: int, k_n: tuple[float, float] = K_N_RANGE, amplitude: tuple[float, float] = AMPLITUDE_RANGE
) -> list[Combination]:
    """Combinations that fill Table 1 evenly (a Latin hypercube), stiffnesses on a logarithmic scale.

    Each parameter takes `count` values, one in each of `count` equal strata of its range. Two seeds share no
    combination. A side is at most MOST_UNLIKE times as stiff as the base, or as soft, which is the range of Table 1.

    Args:
        count, seed: how many, and which.
        k_n: the range of the stiffness of base and side, where it is not that of Table 1 [N/m3].
        amplitude: the range of theta_0/alpha [-].
    """
    ranges = np.array([R_RANGE, SLENDERNESS_RANGE, np.log(k_n), np.log(k_n), amplitude])
    rng = np.random.default_rng(seed)
    strata = rng.permuted(np.tile(np.arange(count), (len(ranges), 1)), axis=1).T
    shares = (strata + rng.random(strata.shape)) / count
    sample = []
    for R, slenderness, k_base, k_side, phi in (ranges[:, 0] + shares * np.ptp(ranges, axis=1)).tolist():
        k_side = min(max(k_side, k_base - math.log(MOST_UNLIKE)), k_base + math.log(MOST_UNLIKE))
        sample.append(Combination(R, slenderness, math.exp(k_base), math.exp(k_side), phi))
    return sample


@dataclass(frozen=True)
class Match:
    """A task of a campaign: the damping ratio that reproduces one restitution on one combination.

    Args:
        combination: the wall and its interfaces.
        e: the restitution to match: `e.base` two-sided, `e.lumped` one-sided.
        points: contact lines a face.
        xi_base: None to match the base two-sided; the damping ratio of the base to match the side one-sided.
        measure: "restitution", |e| of the first rebound, matched to the digit on the branch of high damping; or "rms",
            the root mean square difference of theta over three quarters of a period, minimised, as in the paper.
        accuracy: what the fitted steps aim at, see `simulate`.
        friction, side_friction: of base and side, as `Contacts.from_damping` takes them.
    """

    COLUMNS: ClassVar[tuple[str, ...]] = ("reached", "xi", "found", "lowest", "highest", "rms", "runs")

    combination: Combination | GivenWall
    e: Restitution
    points: int = 2
    xi_base: float | None = None
    measure: str = "restitution"
    accuracy: float = 1e-4
    friction: float | None = None
    side_friction: float | None = None

    def __post_init__(self) -> None:
        require_one_of("measure", self.measure, MEASURES)
        if self.xi_base is not None:
            keep(self, xi_base=require_within("damping ratio of the base xi_base", self.xi_base, 0.0, 1.0))

    @property
    def face(self) -> str:
        """Whether the "base" or the "side" is matched."""
        return "base" if self.xi_base is None else "side"

    @property
    def bounds(self) -> tuple[float, float]:
        """The damping ratios that are searched [-]."""
        return BASE_BOUNDS if self.xi_base is None else SIDE_BOUNDS

    @property
    def target(self) -> float:
        """The restitution of the rebound that is to be matched, |e| [-]."""
        return self.e.base if self.xi_base is None else abs(self.e.lumped)

    @property
    def labels(self) -> Mapping[str, object]:
        """What is matched on what."""
        return {
            "match": self.face,
            "points": self.points,
            "measure": self.measure,
            **vars(self.combination),
            "e_base": self.e.base,
            "e_side": self.e.side,
            "xi_base": self.xi_base,
            "friction": self.friction,
            "side_friction": self.side_friction,
        }

    @property
    def groups(self) -> Groups:
        """The dimensionless groups that the damping ratio is regressed on."""
        combination = self.combination
        return Groups.from_wall(combination.wall, self.e, combination.k_base, combination.k_side, combination.amplitude)

    @property
    def loss(self) -> float:
        """The loss -ln|e| of the impact that is matched [-]."""
        return -math.log(self.e.base if self.xi_base is None else abs(self.e.side))

    def respond(self, xi: float, quarters: float = 3.0) -> Response:
        """The simulation with damping ratio `xi` over `quarters` of the period of the release."""
        combination, wall = self.combination, self.combination.wall
        contacts = Contacts.from_damping(
            wall,
            k_base=combination.k_base,
            xi_base=xi if self.xi_base is None else self.xi_base,
            k_side=None if self.xi_base is None else combination.k_side,
            xi_side=xi,
            points=self.points,
            friction=self.friction,
            side_friction=self.side_friction,
        )
        return simulate(self._case(quarters), contacts, accuracy=self.accuracy)

    def _case(self, quarters: float) -> Case:
        wall, amplitude = self.combination.wall, self.combination.amplitude
        duration = quarters * (math.acosh(1 / (1 - amplitude)) / wall.p)
        side_stop = self.xi_base is not None and self.combination.side_stop
        return Case(wall, amplitude * wall.alpha, duration, side_stop=side_stop)

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
        if self.measure == "rms":
            closest = least_difference(self.difference, self.bounds)
            return closest.row | {"found": self.restitution(closest.xi), "rms": closest.found}
        return highest_branch(self.restitution, self.target, self.bounds, whole=self.xi_base is None).row


@dataclass(frozen=True)
class Closest:
    """What a search found.

    Args:
        reached: whether the target is met inside the bounds.
        xi: the damping ratio [-], the closest one where it is not.
        found: what is measured there.
        lowest, highest: the range of the measure on the branch that was searched.
        runs: how many simulations it took.
    """

    reached: bool
    xi: float
    found: float
    lowest: float
    highest: float
    runs: int

    @property
    def row(self) -> Row:
        """As columns of a campaign."""
        return vars(self) | {"reached": int(self.reached), "rms": None}


def highest_branch(
    measure: Callable[[float], float], target: float, bounds: tuple[float, float], *, whole: bool = True
) -> Closest:
    """The highest damping ratio at which `measure`, a restitution, is `target`.

    Several damping ratios can give one restitution: little damping lets the wall bounce, and a bounce may cost as much
    as a dashpot. The search starts at the upper bound and goes down while the restitution rises; where it has begun to
    fall again the branch of high damping has ended, and what lies below is not looked at. Without `whole` it stops
    looking where the target is passed, and `highest` is what it has seen.
    """
    value, grid = _measure_and_grid(measure, bounds)
    bottom = top = grid[0]
    for log_xi in grid[1:]:
        if value(log_xi) < value(top) and value(top) > value(bottom):
            break  # the branch has ended
        if value(log_xi) < value(bottom):
            bottom = log_xi  # overdamped: a little less damping loses more
        top = log_xi
        if value(bottom) < target <= value(top) and not whole:
            break
    lowest, highest = value(bottom), value(top)
    if not lowest < target <= highest:
        best = top if target > highest else bottom
        return Closest(False, math.exp(best), value(best), lowest, highest, value.cache_info().currsize)
    best = float(brentq(lambda log_xi: value(log_xi) - target, top, bottom, xtol=XI_TOLERANCE))
    reached = abs(value(best) / target - 1) < E_TOLERANCE  # |e| drops to 0 where the wall no longer rocks
    return Closest(reached, math.exp(best), value(best), lowest, highest, value.cache_info().currsize)


def least_difference(measure: Callable[[float], float], bounds: tuple[float, float]) -> Closest:
    """The damping ratio at which `measure`, a difference, is least; not reached where that is at a bound."""
    value, grid = _measure_and_grid(measure, bounds)
    values = [value(log_xi) for log_xi in grid]
    i = int(np.argmin(values))
    best, inside = grid[i], 0 < i < len(grid) - 1
    if inside:
        minimum = minimize_scalar(value, bounds=(grid[i + 1], grid[i - 1]), method="bounded", options={"xatol": 1e-2})
        best, inside = min(grid[i], float(minimum.x), key=value), bool(minimum.success)
    return Closest(inside, math.exp(best), value(best), min(values), max(values), value.cache_info().currsize)


def _measure_and_grid(measure: Callable[[float], float], bounds: tuple[float, float]) -> tuple[Any, list[float]]:
    """The measure over ln xi, which remembers what it has simulated, and the grid on which a search goes down."""
    low, high = (math.log(bound) for bound in bounds)
    grid = np.linspace(high, low, 1 + math.ceil((high - low) / math.log(SCAN))).tolist()
    return cache(lambda log_xi: measure(math.exp(log_xi))), grid
