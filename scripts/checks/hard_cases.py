"""The hard cases: stiff, soft, squat, slender, tiny, huge, undamped, nearly overturning, long, resting, restarted.

Prints, case by case, what is promised and what came out; the tests hold every promise.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from tqdm import tqdm

import mjrock as mr
from scripts.shared import cli
from scripts.shared.paper import FIGURE_3, K_N

STEP_GAIN = 0.05
"""Most energy that an impact may make at ten times the sound step, over the energy of release [-]."""


@dataclass(frozen=True)
class HardCase:
    """A case, what is promised of it, and a check that returns whether it is kept and what came out."""

    name: str
    promise: str
    check: Callable[[], tuple[bool, str]]


def rocking(wall: mr.Block = FIGURE_3, *, k: float = K_N, xi: float = 0.05, points: int = 2) -> tuple[bool, str]:
    """One-sided rocking from alpha/2: no energy from nowhere, no overturning, penetration bounded by the energy."""
    contacts = mr.Contacts.from_damping(wall, k_base=k, xi_base=xi, k_side=k, xi_side=xi / 7, points=points)
    case = mr.Case(wall, 0.5 * wall.alpha, 6 / wall.p)
    run = mr.simulate(case, contacts, ledger=True)
    assert run.energy_residual is not None
    assert contacts.side is not None
    kept, unpaid = float(run.energy.max() / run.energy[0]), float(run.energy_residual.max() / run.energy[0])
    static = wall.weight / float(contacts.base.stiffness[0])
    # all the energy in one spring, and the weight on top
    deepest = (
        math.sqrt(2 * run.energy[0] / contacts.base.stiffness[0]) + 2 * static,
        math.sqrt(2 * run.energy[0] / contacts.side.stiffness[0]),
    )
    inside = run.stats["deepest_base"] <= deepest[0] and run.stats["deepest_side"] <= deepest[1]
    good = kept < 1.01 and unpaid < 0.02 and inside and run.outcome is not mr.Outcome.OVERTURNED
    return good, (
        f"e_1s {run.impacts[0].restitution:.3f}, unpaid energy {max(unpaid, 0):.0e}, "
        f"base {run.stats['deepest_base'] / static:.1f} times its static depth, {run.outcome.value}"
    )


def released(share: float, outcome: mr.Outcome | None) -> tuple[bool, str]:
    """A release that must stand, or must overturn."""
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=3e9, xi_base=0.05, k_side=3e9, xi_side=0.01)
    run = mr.simulate(mr.Case(FIGURE_3, share * FIGURE_3.alpha, 10.0), contacts)
    good = run.outcome is outcome if outcome else run.outcome is not mr.Outcome.OVERTURNED
    return good, run.message


def tiny_release() -> tuple[bool, str]:
    """A millionth of alpha: the wall trembles on its base, with an energy that no tolerance resolves, and stays."""
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=K_N, xi_base=0.05, k_side=K_N, xi_side=0.01)
    run = mr.simulate(mr.Case(FIGURE_3, 1e-6 * FIGURE_3.alpha, 2.0), contacts)
    largest = float(np.abs(run.theta).max() / FIGURE_3.alpha)
    return largest < 1e-5 and run.outcome is mr.Outcome.AT_REST, f"largest rotation {largest:.2e} alpha, at rest"


def long_run() -> tuple[bool, str]:
    """Ten minutes of simulated time: the wall comes to rest and stays where it is."""
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=K_N, xi_base=0.0528, k_side=K_N, xi_side=0.0077)
    run = mr.simulate(mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 600.0, side_stop=False), contacts, output_step=0.01)
    slid = abs(run.stats["base_displacement"])
    good = run.outcome is mr.Outcome.AT_REST and slid < 1e-3 and abs(run.theta[-1]) < 1e-9
    return good, f"{len(run.impacts)} impacts, at rest, base displaced by {slid:.1e} m, {run.stats['wall_time']:.2f} s"


def thousand_impacts() -> tuple[bool, str]:
    """A slender, hardly damped wall over a thousand impacts: its energy never rises again."""
    wall = mr.Block.from_size(0.0125, 1.0)
    contacts = mr.Contacts.from_damping(wall, k_base=3e10, xi_base=0.0015)
    run = mr.simulate(mr.Case(wall, 0.9 * wall.alpha, 1000.0, side_stop=False), contacts, output_step=0.01)
    rise = float(np.max(run.energy - np.minimum.accumulate(run.energy)) / run.energy[0])
    return len(
        run.impacts
    ) >= 1000 and rise < 2e-3, f"{len(run.impacts)} impacts, largest rise {rise:.1e} of the release"


def large_step(xi: float) -> tuple[bool, str]:
    """Ten times the sound step: no impact makes more than a stated share of energy, or an error says so."""
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=K_N, xi_base=xi, k_side=K_N, xi_side=xi / 7)
    sound = mr.automatic_timestep(FIGURE_3, contacts, side_stop=True)
    worst, refused = 0.0, 0
    for share in (0.3, 0.45, 0.5, 0.6, 0.8):
        case = mr.Case(FIGURE_3, share * FIGURE_3.alpha, 4.0)
        try:
            run = mr.simulate(case, contacts, 10 * sound)
            energies = FIGURE_3.potential_energy(run.peaks)
            worst = max(worst, float(np.max(np.diff(energies), initial=0.0)) / case.release_energy)
        except mr.SimulationError as error:
            refused += 1
            worst = max(worst, float(str(error).split("%")[0].split()[-1]) / 100)
    return worst < STEP_GAIN, f"five releases, largest gain {worst:.1e} of the release energy, {refused} refused"


def undamped_vibration() -> tuple[bool, str]:
    """Full contact without damping over 1000 periods: no growth, no more loss than the friction of the edges."""
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=K_N, xi_base=0.0)
    omega = math.sqrt(
        (contacts.base.K_rot - FIGURE_3.weight * FIGURE_3.h) / (FIGURE_3.inertia + FIGURE_3.mass * FIGURE_3.h**2)
    )
    theta0 = 0.4 * contacts.uplift_rotation(FIGURE_3)
    case = mr.Case(FIGURE_3, theta0, 1000 * 2 * math.pi / omega, side_stop=False)
    sound = mr.automatic_timestep(FIGURE_3, contacts, side_stop=False)
    run = mr.simulate(case, contacts, 5 * sound)
    late = np.abs(run.theta[-len(run.theta) // 10 :]).max() / theta0
    grown = float(np.abs(run.theta).max()) / theta0
    return late > 0.9 and grown < 1.001, f"amplitude at the end {late:.4f}, largest {grown:.4f} of the first"


def standing_still() -> tuple[bool, str]:
    """An hour at rest: no drift, no creep."""
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=K_N, xi_base=0.05, k_side=K_N, xi_side=0.01)
    run = mr.simulate(mr.Case(FIGURE_3, 0.0, 3600.0), contacts, output_step=1.0)
    turned, slid = float(np.abs(run.theta).max()), abs(run.stats["base_displacement"])
    return turned < 1e-10 and slid < 1e-9, f"rotation below {turned:.0e} rad, base displaced by {slid:.0e} m"


def restart() -> tuple[bool, str]:
    """A run that is stopped in mid-flight and goes on from where it was."""
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=K_N, xi_base=0.0528, k_side=K_N, xi_side=0.0077)
    theta0 = 0.5 * FIGURE_3.alpha
    whole = mr.simulate(mr.Case(FIGURE_3, theta0, 1.8), contacts, 1e-4)
    first = mr.simulate(mr.Case(FIGURE_3, theta0, 0.9), contacts, 1e-4)
    second = mr.simulate(mr.Case(FIGURE_3, theta0, 0.9), contacts, 1e-4, start=first.end)
    rest = whole.theta[len(first.theta) - 1 :][: len(second.theta)]
    apart = float(np.abs(second.theta - rest).max() / FIGURE_3.alpha)
    return apart < 2e-3, f"largest difference of the rotation {apart:.1e} alpha"


def _cases() -> tuple[HardCase, ...]:
    keeps = "no energy from nowhere, none unpaid, no overturning, depth within the energy's"
    made = [HardCase(f"k_n {k:.0e} N/m3", keeps, lambda k=k: rocking(k=k)) for k in (5e6, 5e7, 3e9, 3e11)]  # type: ignore[misc]
    made += [
        HardCase(f"h/b {s:g}", keeps, lambda s=s: rocking(mr.Block.from_size(4.0 / s, 4.0)))  # type: ignore[misc]
        for s in (1.5, 4, 15, 40)
    ]
    made += [
        HardCase(f"height {h:g} m", keeps, lambda h=h: rocking(mr.Block.from_size(h / 8, h)))  # type: ignore[misc]
        for h in (0.05, 0.5, 12, 30)
    ]
    made += [
        HardCase(f"density {d:g} kg/m3", keeps, lambda d=d: rocking(mr.Block.from_size(0.6, 4.2, 1.0, d)))  # type: ignore[misc]
        for d in (500, 8000)
    ]
    made += [HardCase(f"xi {x:g}", keeps, lambda x=x: rocking(xi=x)) for x in (0.0, 1e-3, 1.0, 5.0)]  # type: ignore[misc]
    made += [HardCase(f"{n} lines a face", keeps, lambda n=n: rocking(points=n)) for n in (3, 32)]  # type: ignore[misc]
    return (
        *made,
        HardCase("release 0.999 alpha", "stands", lambda: released(0.999, None)),
        HardCase("release 1.001 alpha", "overturns", lambda: released(1.001, mr.Outcome.OVERTURNED)),
        HardCase("release 1e-6 alpha", "stays below 1e-5 alpha", tiny_release),
        HardCase("ten minutes", "comes to rest, slides by less than 1 mm", long_run),
        HardCase("a thousand impacts", "energy never rises by 0.2 % of the release", thousand_impacts),
        HardCase("10 times the sound step", f"no gain beyond {STEP_GAIN:.0%}", lambda: large_step(0.05)),
        HardCase("10 times the sound step, xi 0", f"no gain beyond {STEP_GAIN:.0%}", lambda: large_step(0.0)),
        HardCase("1000 periods, xi 0", "no growth beyond 0.1 %, loss below 10 %", undamped_vibration),
        HardCase("an hour at rest", "no rotation beyond 1e-10 rad, no creep beyond 1 nm", standing_still),
        HardCase("restart", "within 0.2 % of alpha of the run that was not stopped", restart),
    )


ALL = _cases()


def main(argv: Sequence[str] | None = None) -> None:
    """Run every case and print the table."""
    args = cli.parser(__doc__, "hard_cases").parse_args(argv)
    out = cli.folder(args.out)
    rows = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # large steps and large damping ratios are meant
        for case in tqdm(ALL[:2] if args.quick else ALL, desc="hard cases", disable=None, leave=False):
            kept, result = case.check()
            rows.append([case.name, case.promise, "kept" if kept else "BROKEN", result])
    lines = ["| case | promised | | result |", "|---|---|---|---|", *("| " + " | ".join(row) + " |" for row in rows)]
    text = "\n".join(lines)
    cli.write_text(out / "hard_cases.md", text + "\n")
    print(text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
