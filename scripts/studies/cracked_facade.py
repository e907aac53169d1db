"""A façade cracked at mid-height against the whole one under earthquakes: is the theory of one block safe?

The façade is 9 m high, 0.65 m thick and 6 m long, of rubble masonry of 1600 kg/m3. Cracked it is two blocks, whole it
is one, and the joints are the same: the crack is all that differs. One-sided, a fixed block stands behind the whole
height, smooth, and stops both halves. Base and crack rub with 0.7. Their damping is that of the calibrated law for the
wall above, and that of the fixed block behind is the law's for the whole façade.
Prints for each motion the least intensity that overturns, by rocking theory for the whole façade and by MuJoCo for the
whole and the cracked one, and the peak rotations at 0.7 of the least of the three. A record is run as it is (+) and
reversed (-). The search climbs by 8 %: it passes over a narrower band of intensities that overturn.
"""

from __future__ import annotations

import math
import statistics
import sys
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import binomtest
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLACK, BLUE, ORANGE, below_figure
from scripts.measure.effect_costs import BARE, K_N, MOST, SHARE, shown
from scripts.shared import cli, suite
from scripts.shared.labels import SMALL

SIDES = {"one-sided": True, "two-sided": False}
COLOURS = {"rocking theory": BLACK, "one block": ORANGE, "cracked": BLUE}
MARKS = {"rocking theory": "|", "one block": "s", "cracked": "o"}
LEAST, RUNG = 0.12, 1.08
"""Lowest intensity of the search [g], and the ratio of two that follow each other before the last is halved."""
HALVINGS = 2


class Found(NamedTuple):
    """The least intensities that overturn [g], and the peaks over alpha at SHARE of the least of them.

    Both in the order theory, whole, cracked. The peak of the cracked one is that of the half that turns more.
    """

    sides: str
    motion: str
    least: tuple[float, ...]
    peaks: tuple[float, ...]


def rectangle(left: float, low: float, high: float, name: str, fixed: bool = False) -> mr.Polygon:
    """A block of the façade or behind it, as thick as the façade."""
    right = left + 2 * BARE.b
    corners = [(left, low), (right, low), (right, high), (left, high)]
    return mr.Polygon(corners, density=BARE.density, length=BARE.length, fixed=fixed, name=name)


@cache
def facade(parts: int, one_sided: bool) -> mr.Masonry:
    """The façade of one block or more, with a fixed block behind it or not."""
    height = 2 * BARE.h / parts
    blocks = [rectangle(-BARE.b, -1.0, 0.0, "ground", fixed=True)]
    if one_sided:
        blocks.append(rectangle(-3 * BARE.b, 0.0, 2 * BARE.h, "behind", fixed=True))
    blocks += [rectangle(-BARE.b, i * height, (i + 1) * height, f"part_{i}") for i in range(parts)]

    def half_retardation(joint: mr.Joint) -> float:
        """Half of c/k, which is the damping ratio at 1 rad/s."""
        above = 2 * BARE.h - (joint.middle[1] if joint.is_bed else 0.0)
        wall = mr.Block.from_size(thickness=2 * BARE.b, height=above, length=BARE.length, density=BARE.density)
        law = mr.Contacts.from_law(wall, mr.Restitution.from_geometry(wall), k_base=K_N, k_side=K_N)
        return 0.5 * (law.base if joint.is_bed or law.side is None else law.side).retardation

    def friction(joint: mr.Joint) -> float:
        return 0.7 if joint.is_bed else 0.0

    return mr.Masonry(tuple(blocks), k_n=K_N, friction=friction, xi=half_retardation, frequency=1.0)


def solved(parts: int, sides: str, motion: mr.GroundMotion, pga: float) -> mr.MasonryResponse:
    """A run of MuJoCo under a motion scaled to a peak in g."""
    case = mr.MasonryCase(
        facade(parts, SIDES[sides]), motion.duration + suite.SETTLING, motion=suite.to_peak(motion, pga)
    )
    return mr.simulate(case, output_step=0.01)


def peak(parts: int, sides: str, motion: mr.GroundMotion, pga: float) -> float:
    """The largest rotation over alpha of the whole façade [-]; infinite if it overturns.

    A run also ends early where a block has gone farther from another than it is large.
    """
    found = solved(parts, sides, motion, pga)
    falls = found.outcome is mr.Outcome.OVERTURNED or found.t[-1] < found.case.duration
    return math.inf if falls else float(found.peak.max()) / BARE.alpha


def peak_in_theory(sides: str, motion: mr.GroundMotion, pga: float) -> float:
    """The same for one block in rocking theory."""
    scaled = suite.to_peak(motion, pga)
    case = mr.Case(BARE, 0.0, motion.duration + suite.SETTLING, side_stop=SIDES[sides], motion=scaled)
    found = mr.solve_analytical(case, mr.Restitution.from_geometry(BARE), rtol=1e-8, output_step=0.05)
    return math.inf if found.outcome is mr.Outcome.OVERTURNED else float(np.abs(found.theta).max()) / BARE.alpha


def overturning(falls: Callable[[float], bool], rung: float) -> float:
    """The least intensity that overturns [g], by a ladder and by halving its last rung; MOST or more is infinite.

    The ladder is fine, since a façade can stand an intensity above one that overturns it.
    """
    high = LEAST
    while not falls(high):
        high *= rung
        if high > MOST:
            return math.inf
    low = high / rung
    for _ in range(HALVINGS):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if falls(middle) else (middle, high)
    return math.sqrt(low * high)


def studied(sides: str, name: str, motion: mr.GroundMotion, rung: float = RUNG) -> Found:
    """What one motion does to the façade."""
    models: list[Callable[[float], float]] = [lambda pga: peak_in_theory(sides, motion, pga)]
    models += [lambda pga, parts=parts: peak(parts, sides, motion, pga) for parts in (1, 2)]  # type: ignore[misc]
    least = [overturning(lambda pga, of=of: math.isinf(of(pga)), rung) for of in models]  # type: ignore[misc]
    return Found(sides, name, tuple(least), tuple(of(SHARE * min(least)) for of in models))


def requested(motions: Sequence[mr.GroundMotion]) -> list[tuple[str, str, mr.GroundMotion]]:
    """Sides, name and motion of every study: both polarities where the façade is one-sided, which is not symmetric."""
    names = [f"{number} {motion.name.split()[0]}" for number, motion in enumerate(motions, 1)]
    both = []
    for name, motion in zip(names, motions, strict=True):
        both += [(name, sign, one) for sign, one in zip("+-", motion.polarities, strict=True)]
    one_sided = [("one-sided", f"{name} {sign}", one) for name, sign, one in both]
    return one_sided + [("two-sided", name, one) for name, one in zip(names, motions, strict=True)]


def summary(found: Sequence[Found]) -> list[list[str]]:
    """How the cracked façade compares with the whole one and with theory, for each kind of side."""
    rows = []
    for sides in SIDES:
        least = np.array([one.least for one in found if one.sides == sides])
        for over, column in (("one block", 1), ("rocking theory", 0)):
            ratios = (least[:, 2] / least[:, column]).tolist()
            unsafe = sum(ratio < 0.98 for ratio in ratios)
            spread = f"{min(ratios):.2f} to {max(ratios):.2f}"
            weaker, stronger = sum(ratio < 1 for ratio in ratios), sum(ratio > 1 for ratio in ratios)
            sign = f"{binomtest(weaker, weaker + stronger).pvalue:.2f}" if weaker + stronger else "-"
            rows.append([sides, over, f"{statistics.median(ratios):.2f}", spread, f"{unsafe} of {len(ratios)}", sign])
    return rows


def drawn(found: Sequence[Found]) -> Figure:
    """The intensities of every motion, a panel for each kind of wall."""
    figure = Figure(figsize=(7.4, 4.2), layout="constrained")
    counts = [sum(one.sides == sides for one in found) or 1 for sides in SIDES]
    least = np.minimum([one.least for one in found], MOST)
    for ax, sides in zip(figure.subplots(2, 1, sharex=True, height_ratios=counts), SIDES, strict=True):
        of = [i for i, one in enumerate(found) if one.sides == sides]
        y, here = np.arange(len(of)), least[of]
        for i, (name, colour) in enumerate(COLOURS.items()):
            ax.scatter(here[:, i], y, (150, 60, 20)[i], marker=MARKS[name], color=colour, label=name, zorder=i)
        if of:
            ax.hlines(y, here.min(axis=1), here.max(axis=1), color="0.8", linewidth=1, zorder=0)
        ax.set_yticks(y, [found[i].motion for i in of], fontsize=SMALL)
        ax.set_ylim(len(of) - 0.4, -0.6)
        ax.set_xscale("log")
        ax.set_title(sides, fontsize=10)
    ticks = [tick for tick in (0.1, 0.2, 0.3, 0.5, 1, 2, 4) if 0.8 * least.min() < tick < 1.3 * least.max()]
    ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.set_xticks([], minor=True)
    ax.set_xlabel("least intensity that overturns [g]")
    below_figure(figure, ax)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run, draw and print."""
    options = cli.parser(__doc__, "cracked_facade")
    options.add_argument("--records", type=Path, help="folder of .at2 and .sac records; else synthetic ones")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    motions = suite.motions(args, 5, quick=1)
    studies = requested(motions)[1 if args.quick else 0 :]
    rung = RUNG**4 if args.quick else RUNG
    bar = tqdm(studies, desc="motions", disable=None, leave=False)
    found = [studied(sides, name, motion, rung) for sides, name, motion in bar]
    rows = []
    for one in found:
        least = [shown(value, f"> {MOST:g}") for value in one.least]
        ratios = [f"{one.least[2] / one.least[i]:.2f}" for i in (1, 0)]
        rows.append([one.sides, one.motion, *least, *ratios, *(shown(value, "falls") for value in one.peaks)])
    plotting.save(drawn(found), out / "cracked_facade.png")
    header = ["façade", "motion", "theory [g]", "one block [g]", "cracked [g]", "cracked/one", "cracked/theory"]
    header += ["peak/alpha: theory", "one block", "cracked"]
    summed = ["façade", "cracked over", "median", "range", "unsafe", "sign test p"]
    text = cli.table(header, rows) + "\n\n" + cli.table(summed, summary(found))
    cli.report(out / "cracked_facade", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
