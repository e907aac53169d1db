"""A randomised search for trouble: random walls, contacts, releases and effects, inside and well outside Table 1; and
masonry of many blocks.

Every run has to stay finite, to make no energy, from peak to peak or in its ledger, and to stand or fall as its energy
says. Ties and ground motions take and give energy of their own, so that the last promise is not asked there. Prints how
many scenes were run, how many broke a promise, and each that did, ready to be made a test.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock import AddedMass, GroundMotion, Load, Opening, Outcome, SideStop, Thrust, Tie
from mjrock.problem.damping.contacts import Uplift
from scripts.shared import cli, random_masonry

Effect = Tie | Thrust | Load | AddedMass
Sine = tuple[float, float]
"""Amplitude [g] and period [s] of a ground motion of five cycles."""

UNPAID = {False: 0.02, True: 0.10}
"""Most energy that the ledger may have too much at any time, over the energy of release, inside and outside Table 1:
there, dashpots may be too strong for any step and act at its end, which is first order in the step."""


@dataclass(frozen=True)
class Scene:
    """A wall, its contacts, its release and its effects, by the numbers that were drawn.

    The side stop reaches the share `top` of the height, the wall tapers to the share `taper` of its thickness, and its
    edges are inset by the share `inset` of half its thickness.
    """

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
    top: float = 1.0
    inset: float = 0.0
    taper: float = 1.0
    openings: tuple[Opening, ...] = ()
    effects: tuple[Effect, ...] = ()
    motion: Sine | None = None
    vertical: Sine | None = None

    def make(self) -> tuple[mr.Case, mr.Contacts]:
        """The case and its contacts.

        Raises:
            ValueError: for a base too soft to stand on.
        """
        thickness = self.height / self.slenderness
        wall = mr.Block.from_size(
            thickness,
            self.height,
            1.0,
            self.density,
            inset=self.inset * thickness / 2,
            openings=self.openings,
            profile=None if self.taper == 1 else [(0, thickness), (self.height, self.taper * thickness)],
        )
        contacts = mr.Contacts.from_damping(
            wall,
            k_base=self.k_base,
            xi_base=self.xi_base,
            k_side=self.k_side,
            xi_side=self.xi_side,
            points=self.points,
        )
        stop = SideStop(self.top * self.height) if self.side_stop and self.top < 1 else self.side_stop
        case = mr.Case(
            wall,
            0.0,
            duration=4 / wall.p,
            side_stop=stop,
            motion=_sine(self.motion),
            vertical=_sine(self.vertical),
            effects=self.effects,
        )
        alpha = case.restoring.towards(self.release).alpha
        return replace(case, theta0=self.release * alpha, omega0=self.omega * alpha * wall.p), contacts

    @property
    def judged(self) -> bool:
        """Whether its energy alone says that it stands or falls."""
        return not (self.motion or self.vertical or any(isinstance(one, Tie) for one in self.effects))


def _sine(numbers: Sine | None) -> GroundMotion | None:
    """A ground motion from its numbers."""
    return None if numbers is None else GroundMotion.sine(numbers[0] * mr.GRAVITY, numbers[1], 5, 100)


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


def loaded(rng: np.random.Generator, scene: Scene, *, wide: bool) -> Scene:
    """A scene with up to four random effects and openings, a partial stop and ground motions, usual or, `wide`, not."""
    H, b = scene.height, scene.height / scene.slenderness / 2
    weight = scene.density * mr.GRAVITY * 2 * b * H
    effects = tuple(_effect(rng, H, b, weight, wide=wide) for _ in range(rng.integers(0, 5)))
    openings, sill = [], float(rng.choice([0.0, rng.uniform(0.02, 0.3)])) * H
    for _ in range(rng.integers(0, 3)):  # one above the other
        height = float(rng.uniform(0.05, 0.9 if wide else 0.4)) * (H - sill)
        if height > 0.011:
            openings.append(Opening(float(rng.uniform(0.05, 0.98 if wide else 0.6)), height, sill))
            sill += height + float(rng.uniform(0.01, 0.2)) * (H - sill - height)

    def sine(likely: float, most: float) -> Sine | None:
        drawn = float(rng.uniform(0.05, most)), float(np.exp(rng.uniform(math.log(0.05), math.log(2.0))))
        return drawn if rng.random() < likely else None

    return replace(
        scene,
        top=float(rng.uniform(0.03 if wide else 0.4, 1)) if rng.random() < 0.4 else 1.0,
        inset=float(rng.uniform(0, 0.8 if wide else 0.2)) if rng.random() < 0.2 else 0.0,
        taper=float(rng.uniform(0.1 if wide else 0.5, 1)) if rng.random() < 0.2 else 1.0,
        openings=tuple(openings),
        effects=effects,
        motion=sine(0.2, 3.0 if wide else 0.5),
        vertical=sine(0.2, 3.0 if wide else 0.5),
    )


def _effect(rng: np.random.Generator, H: float, b: float, weight: float, *, wide: bool) -> Effect:
    """An effect on a wall of height H and half thickness b [m]."""
    height, offset = float(rng.uniform(0 if wide else 0.3, 1)) * H, float(rng.uniform(-1, 1)) * b
    match int(rng.integers(0, 4)):
        case 0:
            stiff = rng.uniform(-3, 7) if wide else rng.uniform(0, 3)
            return Tie(
                height=height,
                stiffness=float(np.clip(10**stiff * weight / b, 1, 1e12)),
                slack=min(float(rng.choice([0.0, rng.uniform(0, 2 if wide else 0.2)])) * b, 10.0),
                strength=float(rng.choice([math.inf, rng.uniform(1e-4 if wide else 0.05, 1) * weight])),
                length=float(rng.uniform(0.05, 20) if wide else rng.uniform(1, 10)),
                anchor_height=None if rng.random() < 0.7 else float(rng.uniform(-1, 2) * H),
            )
        case 1:
            least, most = (-3.0, 1.2) if wide else (-0.5, 0.5)
            return Thrust(height, float(rng.uniform(least, most)) * weight * b / max(height, 0.1 * H))
        case 2:
            return Load(min(float(rng.uniform(0, 20 if wide else 1)) * weight, 1e9), height, offset)
        case _:
            beyond = float(rng.choice([0.0, rng.uniform(-2.9, 2.9)])) if wide else 0.0
            mass = float(rng.uniform(0, 5 if wide else 0.5)) * weight / mr.GRAVITY
            return AddedMass(mass, height, offset + beyond)


def broken_promise(scene: Scene, *, wide: bool) -> str | None:
    """What is wrong with the run of a scene, or None. A scene that is refused with a reason is not wrong."""
    try:
        case, contacts = scene.make()
        run = mr.simulate(case, contacts, ledger=True)
    except mr.SimulationError as error:
        return str(error)
    except ValueError as refused:
        return None if "cannot hold the wall upright" in str(refused) or "valid range" in str(refused) else str(refused)
    if not (np.isfinite(run.theta).all() and np.isfinite(run.energy).all()):
        return "the motion is not finite"
    assert run.ledger is not None
    standing = case.returns_from(run.theta)
    uplift = Uplift.from_case(case, contacts)
    put_in = float(np.abs(np.diff(run.ledger.ground)).sum())
    slid = float(run.ledger.friction[standing].max(initial=0.0))  # thrusts and gravity pay for it
    scale = max(float(run.energy[0]) + put_in + slid, uplift.energy)
    unpaid = float(run.ledger.residual[standing].max(initial=0.0)) / scale
    if unpaid > UNPAID[wide]:
        return f"the ledger has {unpaid:.2%} of the release energy too much"
    return misjudged(scene, case, contacts, run) if scene.judged else None


def misjudged(scene: Scene, case: mr.Case, contacts: mr.Contacts, run: mr.Response) -> str | None:
    """What is wrong if a wall stands or falls although its energy says otherwise, or None."""
    sides = case.restoring[:1] if case.side_stop else case.restoring
    barrier = min(float(one.energy(one.alpha)) for one in sides)
    alpha = min(one.alpha for one in sides)
    soft = contacts.base.points > 2 or Uplift.from_case(case, contacts).rotation > 0.01 * alpha
    safe = case.release_energy < 0.99 * barrier and abs(case.theta0) < 0.99 * alpha and not soft
    if safe and run.outcome is Outcome.OVERTURNED:
        return f"overturned with {case.release_energy / barrier:.3f} of the energy that it takes"
    if abs(scene.release) > 1.01 and scene.omega * scene.release >= 0 and run.outcome is not Outcome.OVERTURNED:
        return f"released at {scene.release:.3f} alpha and {run.outcome.value}"
    return None


def search(count: int, *, wide: bool, seed: int, effects: bool = False) -> list[tuple[Scene, str]]:
    """Run random scenes, with effects or without, and return those that broke a promise."""
    rng = np.random.default_rng(seed)
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for _ in tqdm(range(count), desc="wide" if wide else "Table 1", disable=None, leave=False):
            scene = draw(rng, wide=wide)
            if effects:
                scene = loaded(rng, scene, wide=wide)
            complaint = broken_promise(scene, wide=wide)
            if complaint:
                found.append((scene, complaint))
    return found


def search_masonry(count: int, *, seed: int) -> list[tuple[random_masonry.Structure, str]]:
    """Run random masonry and return what broke a promise."""
    rng = np.random.default_rng(seed)
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for _ in tqdm(range(count), desc="masonry", disable=None, leave=False):
            structure = random_masonry.draw(rng)
            complaint = random_masonry.broken_promise(structure)
            if complaint:
                found.append((structure, complaint))
    return found


def main(argv: Sequence[str] | None = None) -> None:
    """Search and print."""
    options = cli.parser(__doc__, "trouble")
    options.add_argument("--count", type=int, default=5000, help="scenes, half of them well outside Table 1")
    options.add_argument("--effects", type=int, default=2000, help="scenes with effects, half of them extreme")
    options.add_argument("--masonry", type=int, default=300, help="structures of many blocks, some seconds each")
    options.add_argument("--seed", type=int, default=1, help="seed of the draw")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    counts = (40, 20) if args.quick else (args.count, args.effects)
    lines, failures = [], 0
    for count, effects in zip(counts, (False, True), strict=True):
        for wide in (False, True):
            found = search(count // 2, wide=wide, seed=args.seed, effects=effects)
            failures += len(found)
            where = ("well outside Table 1" if wide else "inside Table 1") + (", with effects" if effects else "")
            lines.append(f"{where}: {count // 2} scenes, {len(found)} broken")
            lines += [f"  {complaint}\n    {scene}" for scene, complaint in found]
    lines.append(f"{sum(2 * (count // 2) for count in counts)} scenes, {failures} broken")
    structures = min(3, args.masonry) if args.quick else args.masonry
    fallen = search_masonry(structures, seed=args.seed)
    lines.append(f"masonry: {structures} structures, {len(fallen)} broken")
    lines += [f"  {complaint}\n    {structure}" for structure, complaint in fallen]
    cli.report(out / "trouble", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(cli.run(main))
