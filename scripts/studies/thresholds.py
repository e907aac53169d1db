"""The least pulse that overturns a wall: closed forms, rocking theory, and MuJoCo on bases of rising stiffness.

A rigid base lifts nothing before |a_g| = g tan(alpha). On one that yields, the pulse does work before an edge lifts: a
sudden push A = a_p / (g tan alpha) enters the rocking with the energy (A - 1/2) M theta_u instead of none, M the moment
that lifts an edge and theta_u the uplift rotation. The threshold is lower by a share that grows with the root of
theta_u / alpha, which itself grows with the square of h/b.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence

from tqdm import tqdm

import mjrock as mr
from mjrock import GroundMotion, Outcome
from scripts.shared import cli
from scripts.shared.paper import FIGURE_3

SLENDER = mr.Block(b=0.06, h=3.0)
"""h/b 50, for which the closed forms of slender blocks hold."""
RECTANGULAR = {0.5: 2.54149, 1.0: 1.58198, 2.0: 1.15652, 3.0: 1.05240}
"""p t_d and the least A, A = 1 / (1 - exp(-p t_d))."""
HALF_SINE = {2.0: 1.80072, 4.0: 2.79080, 6.0: 3.78816}
"""Omega = omega_p / p, and the root of sqrt(A^2 - 1) + A exp(-(pi - asin(1/A)) / Omega) = Omega."""

STOCKY = mr.Block(b=0.5, h=2.0)
"""h/b 4, the least of the paper's Table 1; Figure 3's wall has 7."""

Pulse = Callable[[float], GroundMotion]
Overturns = Callable[[GroundMotion], bool]


def rectangular(wall: mr.Block, duration: float) -> Pulse:
    """A rectangular pulse that opens the wall, of duration / p."""
    return lambda amplitude: GroundMotion.rectangular(-amplitude, duration / wall.p)


def half_sine(wall: mr.Block, frequency: float) -> Pulse:
    """A half sine that opens the wall, of circular frequency `frequency` p."""
    return lambda amplitude: GroundMotion.half_sine(-amplitude, math.pi / (frequency * wall.p))


def in_theory(wall: mr.Block, *, side_stop: bool = True, impacts: bool = True) -> Overturns:
    """Whether a pulse overturns the rigid wall; without `impacts` only an overturning before the first one counts."""
    e = mr.Restitution.from_geometry(wall.alpha)
    duration = 12 / wall.p

    def overturns(motion: GroundMotion) -> bool:
        case = mr.Case(wall, 0.0, duration, side_stop=side_stop, motion=motion)
        response = mr.solve_analytical(case, e, output_step=duration)
        return response.outcome is Outcome.OVERTURNED and (impacts or not response.impacts)

    return overturns


def in_mujoco(wall: mr.Block, k_n: float) -> Overturns:
    """Whether a pulse overturns the one-sided wall on interfaces of `k_n` [N/m3], damped as the published law says."""
    contacts = mr.Contacts.from_law(
        wall, mr.Restitution.from_geometry(wall.alpha), k_base=k_n, k_side=k_n, law="PUBLISHED"
    )

    def overturns(motion: GroundMotion) -> bool:
        case = mr.Case(wall, 0.0, 8 / wall.p, motion=motion)
        return mr.simulate(case, contacts).outcome is Outcome.OVERTURNED

    return overturns


def threshold(wall: mr.Block, pulse: Pulse, overturns: Overturns, low: float, high: float, tolerance: float) -> float:
    """The least A = a_p / (g tan alpha) at which the pulse overturns the wall, by bisection.

    Raises:
        ValueError: if the wall overturns at `low` already, or not even at `high`.
    """
    unit = mr.GRAVITY * math.tan(wall.alpha)
    if overturns(pulse(low * unit)) or not overturns(pulse(high * unit)):
        raise ValueError(f"the threshold is outside the range {low:g} to {high:g} that was searched")
    while high / low - 1 > tolerance:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if overturns(pulse(middle * unit)) else (middle, high)
    return math.sqrt(low * high)


def main(argv: Sequence[str] | None = None) -> None:
    """Find every threshold and print the table."""
    args = cli.parser(__doc__, "thresholds").parse_args(argv)
    out = cli.folder(args.out)
    pulses: list[tuple[Callable[[mr.Block, float], Pulse], str, float, float]] = [
        *((rectangular, "rectangular, p t_d", x, a) for x, a in RECTANGULAR.items()),
        *((half_sine, "half sine, omega_p/p", x, a) for x, a in HALF_SINE.items()),
    ]
    coarse = 1.0
    if args.quick:
        pulses, coarse = pulses[1:2], 1000.0
    rows: list[list[object]] = []
    for make, name, parameter, closed in tqdm(pulses, desc="thresholds", disable=None, leave=False):
        theory = threshold(
            SLENDER, make(SLENDER, parameter), in_theory(SLENDER), 0.8 * closed, 1.2 * closed, coarse * 1e-5
        )
        row = [name, f"{parameter:g}", f"{closed:.5f}", f"{theory / closed - 1:+.1e}"]
        for k_n in (3e9, 3e11, 3e13):
            found = threshold(
                SLENDER, make(SLENDER, parameter), in_mujoco(SLENDER, k_n), 0.7 * closed, 1.1 * closed, coarse * 5e-4
            )
            row.append(f"{found / closed - 1:+.2%}")
        for wall in (FIGURE_3, STOCKY):
            rigid, yielding = (
                threshold(wall, make(wall, parameter), overturns, 0.8 * closed, 1.2 * closed, coarse * 3e-4)
                for overturns in (in_theory(wall), in_mujoco(wall, 3e9))
            )
            row.append(f"{yielding / rigid - 1:+.2%}")
        rows.append(row)
    header = [
        "pulse", "", "closed form", "theory, h/b 50",
        "MuJoCo, h/b 50, 3e9 N/m3", "3e11", "3e13", "MuJoCo to theory, h/b 7, 3e9", "h/b 4, 3e9",
    ]  # fmt: skip
    cli.report(out / "thresholds", cli.table(header, rows))


if __name__ == "__main__":
    sys.exit(cli.run(main))
