"""What each effect costs in time, and what leaving it out costs in the answer, on one façade against side walls.

The façade is 9 m high, 0.65 m thick and 6 m long, of rubble masonry of 1600 kg/m3: two storeys between cross walls.
Each effect has the size that such a façade meets: a 16 mm tie whose anchor gives at 15 kN, the thrust of a rafter, a
floor, a cornice.
Time and steps are medians of interleaved runs under one motion that overturns none, over those of the bare façade in
the same round. The answer is the peak rotation at 0.7 of the intensity that overturns the bare façade, and the least
intensity that overturns, as medians over the motions. Prints one table of both.
"""

from __future__ import annotations

import functools
import math
import statistics
import sys
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLUE, ORANGE
from scripts.shared import cli, suite

SIZE: Mapping[str, Any] = {"thickness": 0.65, "height": 9.0, "length": 6.0, "density": 1600.0}
K_N = 5e8
BARE = mr.Block.from_size(**SIZE)
SHARE = 0.7
"""Intensity of the runs whose peak is compared, over the one that overturns the bare façade [-]."""
VERTICAL = 2 / 3
"""Peak of the vertical motion over that of the horizontal one [-]."""
MOST, LEAST, RUNG = 4.0, 0.06, 1.2
"""Highest and lowest intensity of the search [g], and the ratio of two that follow each other before it is halved."""
HALVINGS = 5
TIE = mr.Tie(height=8.0, stiffness=8e6, slack=0.005, strength=15e3)
OPENINGS = (mr.Opening(1.2, 2.2), mr.Opening(1.0, 1.5, sill=4.0), mr.Opening(1.0, 1.5, sill=7.0))
PROFILE = ((0.0, 0.65), (4.5, 0.65), (4.5, 0.5), (9.0, 0.5))


@dataclass(frozen=True)
class Facade:
    """The façade with some effects.

    Args:
        wall: what its section has that the bare one has not.
        effects, stop: as in `Case`.
        friction: of base and side, or None where the base holds and the side is smooth.
        vertical: whether the ground moves vertically too.
        shaken: whether it moves at all; else the façade is released from alpha/2.
    """

    wall: Mapping[str, Any] = field(default_factory=dict)
    effects: tuple[mr.Tie | mr.Thrust | mr.Load | mr.AddedMass, ...] = ()
    stop: bool | mr.SideStop = True
    friction: float | None = None
    vertical: bool = False
    shaken: bool = True

    def request(self, motion: mr.GroundMotion, up: mr.GroundMotion, pga: float) -> tuple[mr.Case, mr.Contacts]:
        """The case under a motion scaled to a peak in g, and contacts with the damping of the calibrated law."""
        wall = mr.Block.from_size(**SIZE, **self.wall)
        theta0 = 0.0 if self.shaken else 0.5 * wall.alpha
        case = mr.Case(
            wall,
            theta0,
            motion.duration + suite.SETTLING,
            side_stop=self.stop,
            motion=suite.to_peak(motion, pga) if self.shaken else None,
            vertical=suite.to_peak(up, VERTICAL * pga) if self.vertical else None,
            effects=self.effects,
        )
        e = mr.Restitution.from_geometry(wall, case.stop_top)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # the damping is that of a base that holds, to compare
            contacts = mr.Contacts.from_law(
                wall, e, k_base=K_N, k_side=K_N, friction=self.friction, side_friction=self.friction
            )
        return case, contacts


ALONE = {
    "tie that yields": Facade(effects=(TIE,)),
    "tie that does not yield": Facade(effects=(mr.Tie(TIE.height, TIE.stiffness, TIE.slack),)),
    "thrust": Facade(effects=(mr.Thrust(height=8.0, force=6e3),)),
    "load": Facade(effects=(mr.Load(force=60e3, height=9.0, offset=-0.1),)),
    "added mass": Facade(effects=(mr.AddedMass(mass=3e3, height=9.0, offset=0.2),)),
    "side stop of 7 m": Facade(stop=mr.SideStop(7.0)),
    "vertical motion": Facade(vertical=True),
    "openings": Facade(wall={"openings": OPENINGS}),
    "profile": Facade(wall={"profile": PROFILE}),
    "inset of 20 mm": Facade(wall={"inset": 0.02}),
    "friction of 0.4": Facade(friction=0.4),
}
TOGETHER = Facade(
    wall={"openings": OPENINGS, "profile": PROFILE, "inset": 0.02},
    effects=(TIE, *(one for name in ("thrust", "load", "added mass") for one in ALONE[name].effects)),
    stop=mr.SideStop(7.0),
    friction=0.4,
    vertical=True,
)
STUDIED = {"bare": Facade(), **ALONE, "all together": TOGETHER}
"""What the answer is found for. The time is measured without a ground motion, too."""

Pair = tuple[mr.GroundMotion, mr.GroundMotion]
"""A horizontal motion and the vertical one that goes with it."""


def solved(facade: Facade, motions: Pair, pga: float) -> mr.Response:
    """A run of MuJoCo."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of sliding, which is what is asked for
        return mr.simulate(*facade.request(*motions, pga), output_step=0.01)


def peak(facade: Facade, motions: Pair, pga: float) -> float:
    """The largest rotation over alpha of the bare façade [-]; infinite for one that overturns."""
    found = solved(facade, motions, pga)
    return math.inf if found.outcome is mr.Outcome.OVERTURNED else float(np.abs(found.theta).max()) / BARE.alpha


def overturning(falls: Callable[[float], bool]) -> float:
    """The least intensity that overturns [g], by a ladder and by halving its last rung; MOST or more is infinite."""
    low = LEAST
    while not falls(low * RUNG):
        low *= RUNG
        if low > MOST:
            return math.inf
    high = low * RUNG
    for _ in range(HALVINGS):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if falls(middle) else (middle, high)
    return math.sqrt(low * high)


def timed(studied: Mapping[str, Facade], motions: Pair, pga: float, rounds: int) -> dict[str, tuple[float, float]]:
    """Time and steps per simulated second over those of the bare façade, medians of interleaved rounds."""
    ratios: dict[str, list[tuple[float, float]]] = {}
    facades = {"no ground motion": Facade(shaken=False), **studied}
    for facade in facades.values():
        solved(facade, motions, pga)  # text and compilation
    for _ in tqdm(range(rounds), desc="rounds", disable=None, leave=False):
        spent = {}
        for name, facade in facades.items():
            begun = time.process_time()
            found = solved(facade, motions, pga)
            spent[name] = (time.process_time() - begun) / found.t[-1], found.stats["steps"] / found.t[-1]
        for name, (seconds, steps) in spent.items():
            ratios.setdefault(name, []).append((seconds / spent["bare"][0], steps / spent["bare"][1]))
    return {name: (statistics.median(a), statistics.median(b)) for name, (a, b) in _turned(ratios).items()}


def _turned(ratios: Mapping[str, list[tuple[float, float]]]) -> dict[str, tuple[list[float], list[float]]]:
    """Pairs in lists as lists in pairs."""
    return {name: ([a for a, _ in pairs], [b for _, b in pairs]) for name, pairs in ratios.items()}


def shown(value: float, above: str) -> str:
    """A number, or what stands for infinity."""
    return f"{value:.2f}" if math.isfinite(value) else above


class LeftOut(NamedTuple):
    """Overturning intensity without an effect over that with it [-].

    Args:
        ratios: under each motion; where nothing overturns up to MOST, what it is less than.
        bound: whether the median is such a bound.
    """

    ratios: list[float]
    bound: bool

    @classmethod
    def of(cls, without: Sequence[float], with_it: Sequence[float]) -> LeftOut:
        """The ratios of two rows of intensities [g]."""
        ratios = [bare / min(own, MOST) for bare, own in zip(without, with_it, strict=True)]
        return cls(ratios, math.isinf(statistics.median(with_it)))

    @property
    def median(self) -> float:
        """Median over the motions [-]."""
        return statistics.median(self.ratios)

    @property
    def texts(self) -> tuple[str, str]:
        """The median, and the least and the largest ratio, which a bound has not."""
        if self.bound:
            return f"< {self.median:.2f}", "-"
        return f"{self.median:.2f}", f"{min(self.ratios):.2f} to {max(self.ratios):.2f}"


def answers(studied: Mapping[str, Facade], pairs: Sequence[Pair]) -> dict[str, tuple[list[float], list[float]]]:
    """Peaks over alpha and overturning intensities [g] of every façade under every motion."""
    found: dict[str, tuple[list[float], list[float]]] = {name: ([], []) for name in studied}
    for pair in tqdm(pairs, desc="motions", disable=None, leave=False):
        scale = math.nan
        for name, facade in studied.items():

            def falls(pga: float, facade: Facade = facade, pair: Pair = pair) -> bool:
                return math.isinf(peak(facade, pair, pga))

            least = overturning(falls)
            scale = SHARE * least if name == "bare" else scale
            found[name][0].append(peak(facade, pair, scale))
            found[name][1].append(least)
    return found


def vertical_in_theory(count: int) -> list[float]:
    """Overturning intensity without the vertical motion over that with it, in rocking theory.

    Under some synthetic motions in both polarities.
    """
    ratios = []
    for seed in tqdm(range(count), desc="theory", disable=None, leave=False):
        up = mr.GroundMotion.synthetic(3.0, 15.0, seed=count + seed)
        for motion in mr.GroundMotion.synthetic(3.0, 15.0, seed=seed).polarities:

            def falls(pga: float, vertical: bool, motion: mr.GroundMotion = motion, up: mr.GroundMotion = up) -> bool:
                case, _ = Facade(vertical=vertical).request(motion, up, pga)
                found = mr.solve_analytical(case, mr.Restitution.from_geometry(BARE), rtol=1e-8, output_step=0.05)
                return found.outcome is mr.Outcome.OVERTURNED

            without, with_it = (overturning(functools.partial(falls, vertical=vertical)) for vertical in (False, True))
            ratios.append(without / with_it)
    return ratios


def drawn(names: Sequence[str], times: Mapping[str, float], left_out: Sequence[LeftOut]) -> Figure:
    """Bars: time on the left, what leaving an effect out makes of the overturning intensity on the right.

    A bound has no bar but an arrow from it to what it may be.
    """
    figure = Figure(figsize=(7.4, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    y = np.arange(len(names))
    left.barh(y, [times[name] for name in names], 0.6, color="0.6")
    left.set_xlabel("time of a run over that of the bare façade [-]", fontsize=9)
    known = np.array([1.0 if one.bound else one.median for one in left_out])
    right.barh(y, known - 1, 0.6, left=1, color=np.where(known > 1, ORANGE, BLUE))
    for level, one in zip(y.tolist(), left_out, strict=True):
        if one.bound:
            right.annotate("", (0.0, level), (one.median, level), arrowprops={"arrowstyle": "-|>", "color": BLUE})
            right.plot([one.median] * 2, [level - 0.3, level + 0.3], color=BLUE, linewidth=1.5)
            right.text(one.median + 0.03, level, f"less than {one.median:.2f}", fontsize=8, va="center", color=BLUE)
    right.set_xlabel("overturning intensity without the effect\nover that with it [-]", fontsize=9)
    for side, text in (("right", "safe to leave out  ←"), ("left", "→  unsafe")):
        right.text(1, 1.02, f"  {text}  ", ha=side, fontsize=9, transform=right.get_xaxis_transform())
    right.set_xlim(0, 1.5)
    for ax in (left, right):
        ax.axvline(1, color="0.3", linewidth=0.8)
    left.set_yticks(y, names)
    left.invert_yaxis()
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, draw and print."""
    args = suite.parser(__doc__, "effect_costs").parse_args(argv)
    out = cli.folder(args.out)
    motions = suite.motions(args, 9, quick=2)
    pairs = [(motion, motions[(i + 1) % len(motions)]) for i, motion in enumerate(motions)]
    studied = {name: STUDIED[name] for name in ("bare", "all together")} if args.quick else STUDIED
    found = answers(studied, pairs[:1] if args.quick else pairs)
    bare = found["bare"]
    standing = 0.8 * min(least[0] for _, least in found.values())  # a wall that falls ends its run early
    times = timed(studied, pairs[0], standing, 1 if args.quick else 7)
    rows, left_out = [["no ground motion", *(f"{ratio:.2f}" for ratio in times["no ground motion"]), *4 * ["-"]]], []
    for name, (peaks, least) in found.items():
        left_out.append(LeftOut.of(bare[1], least))
        rows.append(
            [
                name,
                *(f"{ratio:.2f}" for ratio in times[name]),
                shown(statistics.median(peaks), "falls"),
                shown(statistics.median(least), f"> {MOST:g}"),
                *left_out[-1].texts,
            ]
        )
    plotting.save(
        drawn(list(found), {name: both[0] for name, both in times.items()}, left_out), out / "effect_costs.png"
    )
    header = ["façade", "time", "steps", "peak/alpha", "overturns at [g]", "without/with", "over the motions"]
    ratios = vertical_in_theory(1 if args.quick else 8)
    text = cli.table(header, rows) + (
        f"\n\nvertical motion in rocking theory, without/with over {len(ratios)} runs: "
        f"median {statistics.median(ratios):.2f}, {min(ratios):.2f} to {max(ratios):.2f}"
    )
    cli.report(out / "effect_costs", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
