"""A randomised search for trouble: random walls, contacts and releases, inside and well outside Table 1.

Every run has to stay finite, to make no energy, from peak to peak or in its ledger, and to stand or fall as its energy
says. Prints how
many scenes were run, how many broke a promise, and each that did, ready to be made a test.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from tqdm import tqdm

import cli
import mjrock as mr
from mjrock import Outcome
from mjrock.problem.uplift import Uplift

UNPAID = {False: 0.02, True: 0.10}
"""Most energy that the ledger may have too much at any time, over the energy of release, inside and outside Table 1:
there, dashpots may be too strong for any step and act at its end, which is first order in the step."""


@dataclass(frozen=True)
class Scene:
    """A wall, its contacts and its release, by the numbers that were drawn."""

    height: float
    slenderness: float
    density: float
    k_base: float
    k_side: float
    xi_base: float
    xi_side: float
    points: int
    side_stop: bool
    release: float
    omega: float

    def make(self) -> tuple[mr.Case, mr.Contacts]:
        """The case and its contacts.

        Raises:
            ValueError: for a base too soft to stand on.
        """
        wall = mr.Block.from_size(self.height / self.slenderness, self.height, 1.0, self.density)
        contacts = mr.Contacts.from_damping(
            wall,
            k_base=self.k_base,
            xi_base=self.xi_base,
            k_side=self.k_side,
            xi_side=self.xi_side,
            points=self.points,
        )
        case = mr.Case(
            wall,
            self.release * wall.alpha,
            duration=4 / wall.p,
            side_stop=self.side_stop,
            omega0=self.omega * wall.alpha * wall.p,
        )
        return case, contacts


def draw(rng: np.random.Generator, *, wide: bool) -> Scene:
    """A scene inside Table 1 or, `wide`, well outside it."""

    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(math.log(low), math.log(high))))

    side_stop = bool(rng.random() < 0.6)
    releases = (
        (rng.uniform(0.3, 0.8),) if not wide else (rng.uniform(0.01, 0.99), 1e-6, 0.999, 1.001, rng.uniform(1, 1.3))
    )
    release = float(rng.choice(releases))
    if wide:
        undamped = rng.random(2) < 0.1
        return Scene(
            height=between(0.05, 30),
            slenderness=between(1.5, 40),
            density=float(rng.uniform(500, 8000)),
            k_base=between(5e6, 3e11),
            k_side=between(5e6, 3e11),
            xi_base=0.0 if undamped[0] else between(1e-4, 5),
            xi_side=0.0 if undamped[1] else between(1e-4, 5),
            points=int(rng.choice([2, 2, 3, 8])),
            side_stop=side_stop,
            release=release if side_stop or rng.random() < 0.5 else -release,
            omega=float(rng.choice([0.0, 0.0, rng.uniform(-0.3, 0.3)])),
        )
    slenderness, R = rng.uniform(4, 15), rng.uniform(1.4, 2.8)
    return Scene(
        height=2 * R * math.cos(math.atan(1 / slenderness)),
        slenderness=float(slenderness),
        density=2000.0,
        k_base=between(0.5e8, 30e8),
        k_side=between(0.5e8, 30e8),
        xi_base=between(0.01, 0.2),
        xi_side=between(0.002, 0.1),
        points=int(rng.choice([2, 4, 8])),
        side_stop=side_stop,
        release=release,
        omega=0.0,
    )


def broken_promise(scene: Scene, *, wide: bool) -> str | None:
    """What is wrong with the run of a scene, or None. A scene that is refused with a reason is not wrong."""
    try:
        case, contacts = scene.make()
    except ValueError as refused:
        return None if "cannot hold the wall upright" in str(refused) or "valid range" in str(refused) else str(refused)
    wall = case.block
    try:
        run = mr.simulate(case, contacts, ledger=True)
    except mr.SimulationError as error:
        return str(error)
    if not (np.isfinite(run.theta).all() and np.isfinite(run.energy).all()):
        return "the motion is not finite"
    assert run.ledger is not None
    standing = np.abs(run.theta) <= wall.alpha
    scale = max(float(run.energy[0]), Uplift.of(case, contacts).energy)
    unpaid = float(run.ledger.residual[standing].max(initial=0.0)) / scale
    if unpaid > UNPAID[wide]:
        return f"the ledger has {unpaid:.2%} of the release energy too much"
    barrier = float(wall.potential_energy(wall.alpha))
    soft = contacts.base.points > 2 or contacts.uplift_rotation(wall) > 0.01 * wall.alpha
    safe = case.release_energy < 0.99 * barrier and abs(case.theta0) < 0.99 * wall.alpha and not soft
    if safe and run.outcome is Outcome.OVERTURNED:
        return f"overturned with {case.release_energy / barrier:.3f} of the energy that it takes"
    if abs(scene.release) > 1.01 and scene.omega * scene.release >= 0 and run.outcome is not Outcome.OVERTURNED:
        return f"released at {scene.release:.3f} alpha and {run.outcome.value}"
    return None


def search(count: int, *, wide: bool, seed: int) -> list[tuple[Scene, str]]:
    """Run random scenes and return those that broke a promise."""
    rng = np.random.default_rng(seed)
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for _ in tqdm(range(count), desc="wide" if wide else "Table 1", disable=None, leave=False):
            scene = draw(rng, wide=wide)
            complaint = broken_promise(scene, wide=wide)
            if complaint:
                found.append((scene, complaint))
    return found


def main(argv: Sequence[str] | None = None) -> None:
    """Search and print."""
    options = cli.parser(__doc__, "trouble")
    options.add_argument("--count", type=int, default=5000, help="scenes, half of them well outside Table 1")
    options.add_argument("--seed", type=int, default=1, help="seed of the draw")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    count = 40 if args.quick else args.count
    lines, failures = [], 0
    for wide in (False, True):
        found = search(count // 2, wide=wide, seed=args.seed)
        failures += len(found)
        lines.append(
            f"{'well outside Table 1' if wide else 'inside Table 1'}: {count // 2} scenes, {len(found)} broken"
        )
        lines += [f"  {complaint}\n    {scene}" for scene, complaint in found]
    lines.append(f"{2 * (count // 2)} scenes, {failures} broken")
    cli.write(out / "trouble.txt", "\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    sys.exit(cli.run(main))
