"""A column of three drums near overturning under 30 records, in MuJoCo and by explicit steps.

The drums are 0.6 m wide and 1.2 m high, on joints of 2 lines that stick rigidly, k_n = 1e9 N/m3, mu = 0.7, xi = 0.05.
The synthetic records last 5 s and have a peak of 4 m/s2; the column is followed for 6 s. A run overturns when a drum
has turned by more than 0.5 rad. Every record is run three times: by `simulate(accuracy=1e-4)`, by explicit steps of the
default length, and by explicit steps half as long, which tells how far the scheme scatters by itself.
Two runs part where a rotation differs by more than 1 % of alpha, the angle at which the column as one block overturns.
Prints how the largest rotations before that compare, how many columns overturn (exact sign test on the pairs of which
one alone does), the median ratio of peaks where both stand (interval of order statistics, 95 %), and the
Kolmogorov-Smirnov test on all peaks, those that overturn counted as largest. The test takes the samples as independent;
since they share their records it is the less likely to find a difference.
Writes many_records.csv, .png and .txt.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import binom, binomtest, ks_2samp
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from scripts.shared import cli

DRUM = mr.Block.from_size(thickness=0.6, height=1.2)
ALPHA = math.atan(0.6 / 3.6)
"""Angle at which the column overturns as one block [rad]."""
PEAK = 4.0
"""Largest acceleration of the records [m/s2]."""
SHAKEN, FOLLOWED = 5.0, 6.0
"""Duration of a record, and how long a column is followed [s]."""
OVERTURNED = 0.5
"""Rotation of a drum beyond which the column has overturned [rad]."""
PARTED = 0.01
"""Difference of a rotation at which two paths have parted [alpha]."""
SAMPLE = 2e-3
"""Spacing of the samples [s]."""
RUNS = {"MuJoCo": ("#f0a35e", "-"), "explicit": ("#12406b", "-"), "explicit, half the step": ("#6c8a4e", "--")}


@dataclass(frozen=True)
class Path:
    """Rotations of the drums until one has overturned [rad], shape (n, 3), and whether one has."""

    theta: Array
    overturns: bool

    @property
    def peak(self) -> float:
        """Largest rotation [alpha], infinite of a column that overturns."""
        return math.inf if self.overturns else float(np.abs(self.theta).max()) / ALPHA


def path_of(answer: mr.Response) -> Path:
    """The part of an answer that counts."""
    theta = answer.pose[:, :, 2]
    over = (np.abs(theta) > OVERTURNED).any(axis=1)
    end = int(over.argmax()) if over.any() else len(theta)
    return Path(theta[: max(1, end)], bool(over.any()) or bool(answer.fallen))


def runs(seed: int, accuracy: float, followed: float) -> dict[str, Path]:
    """The three runs of one record."""
    column = mr.Masonry.stack([DRUM] * 3, k_n=1e9, friction=0.7, xi=0.05)
    record = mr.GroundMotion.synthetic(PEAK, SHAKEN, seed=seed)
    case = mr.MasonryCase(column, followed, record)
    coarse = mr.solve_explicit(case, output_step=SAMPLE)
    fine = mr.solve_explicit(case, timestep=0.5 * coarse.stats["timestep"], output_step=SAMPLE)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of drums that leave their joints
        engine = mr.simulate(case, accuracy=accuracy, output_step=SAMPLE)
    return dict(zip(RUNS, map(path_of, (engine, coarse, fine)), strict=True))


def parting(one: Path, other: Path) -> tuple[float, float]:
    """When two paths part [s], infinite if they do not, and the ratio of their largest rotations until then."""
    count = min(len(one.theta), len(other.theta))
    apart = (np.abs(one.theta[:count] - other.theta[:count]) > PARTED * ALPHA).any(axis=1)
    end = int(apart.argmax()) if apart.any() else count
    largest = [float(np.abs(path.theta[: max(1, end)]).max()) for path in (one, other)]
    return (end * SAMPLE if apart.any() else math.inf), largest[0] / max(largest[1], 1e-12)


def median_interval(values: Array) -> tuple[float, float, float]:
    """The median and its interval of 95 % by order statistics, NaN of fewer than six values."""
    n = len(values)
    if n < 6:
        return (float(np.median(values)) if n else math.nan, math.nan, math.nan)
    k = int(binom.ppf(0.025, n, 0.5))
    ordered = np.sort(values)
    return float(np.median(values)), float(ordered[k - 1]), float(ordered[n - k])


def compared(found: Sequence[dict[str, Path]], name: str, other: str) -> list[str]:
    """What tells two ways to run the same records apart, in words."""
    pairs = [(one[name], one[other]) for one in found]
    times, ratios = np.array([parting(*pair) for pair in pairs]).T
    off, stay = np.abs(ratios - 1), np.isinf(times)
    alone = [
        sum(a.overturns and not b.overturns for a, b in pairs),
        sum(b.overturns and not a.overturns for a, b in pairs),
    ]
    stand = np.array([a.peak / b.peak for a, b in pairs if not (a.overturns or b.overturns)])
    middle, low, high = median_interval(stand)
    peaks = [np.array([min(path.peak, 1e3) for path in side]) for side in zip(*pairs, strict=True)]
    counts = [sum(path.overturns for path in side) for side in zip(*pairs, strict=True)]
    first = f"at {np.median(times[~stay]):.2f} s in the median" if (~stay).any() else "never"
    return [
        f"{name} against {other}, {len(pairs)} records:",
        f"  {(~stay).sum()} part, {first}; largest rotations until then differ by {np.median(off):.1e} in the median, "
        f"{off.max():.1e} at most; {(off < 0.01).sum()} within 1 %",
        f"  overturn: {counts[0]} and {counts[1]}, {alone[0]} and {alone[1]} alone, sign test p = "
        f"{binomtest(alone[0], sum(alone)).pvalue if sum(alone) else 1.0:.2g}",
        f"  peaks where both stand ({len(stand)}): median ratio {middle:.4f}, 95 % {low:.4f} to {high:.4f}, "
        f"smallest {stand.min(initial=math.inf):.3f}, largest {stand.max(initial=0.0):.3f}",
        f"  Kolmogorov-Smirnov on all peaks: p = {ks_2samp(*peaks).pvalue:.2g}",
    ]


def drawn(found: Sequence[dict[str, Path]]) -> Figure:
    """A record whose paths part, the peaks in pairs, and their distributions."""
    figure = Figure(figsize=(11, 3.8), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    names = list(RUNS)
    late = [parting(one[names[1]], one[names[0]])[0] for one in found]
    shown = int(np.argsort([value if math.isfinite(value) else -1.0 for value in late])[len(late) // 2])
    for name, (colour, line) in RUNS.items():
        theta = found[shown][name].theta[:, -1] / ALPHA
        left.plot(SAMPLE * np.arange(len(theta)), theta, color=colour, linestyle=line, linewidth=1.1, label=name)
    if math.isfinite(late[shown]):
        left.axvline(late[shown], color="0.5", linewidth=0.8, linestyle=":")
    left.set(ylim=(-1.5, 1.9), xlabel="$t$ [s]", ylabel=r"rotation of the top drum $\theta/\alpha$ [-]")
    left.set_title(f"record {shown}; dotted: MuJoCo and explicit part", fontsize=9)
    left.legend(frameon=False, fontsize=8, loc="upper left")
    edge = 6.0
    for other, marker in ((names[0], "o"), (names[2], "x")):
        x = [min(one[other].peak, edge) for one in found]
        y = [min(one[names[1]].peak, edge) for one in found]
        middle.plot(x, y, marker, color=RUNS[other][0], markerfacecolor="none", label=f"against {other}")
    middle.plot([1e-2, 10], [1e-2, 10], color="0.6", linewidth=0.8, zorder=0)
    low = 0.7 * min(path.peak for one in found for path in one.values())
    middle.set(xscale="log", yscale="log", xlim=(low, 1.5 * edge), ylim=(low, 1.5 * edge))
    for draw in (middle.axvspan, middle.axhspan):
        draw(0.75 * edge, 1.5 * edge, color="0.92", zorder=-1)
    middle.set(xlabel=r"peak $|\theta|/\alpha$ [-]", ylabel=r"peak $|\theta|/\alpha$, explicit [-]")
    middle.set_title("grey: overturned", fontsize=9)
    middle.legend(frameon=False, fontsize=8, loc="upper left")
    for name, (colour, line) in RUNS.items():
        peaks = np.sort([min(one[name].peak, 1e3) for one in found])
        share = np.arange(1, len(peaks) + 1) / len(peaks)
        right.step(
            np.append(peaks[0], peaks), np.append(0.0, share), where="post", color=colour, linestyle=line, label=name
        )
    right.set(xscale="log", xlim=(low, edge), ylim=(0, 1), xlabel=r"peak $|\theta|/\alpha$ [-]")
    right.set_ylabel("share of records with a smaller peak [-]")
    right.legend(frameon=False, fontsize=8, loc="upper left")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run every record, compare, draw and print."""
    args = cli.parser(__doc__, "many_records").parse_args(argv)
    out = cli.folder(args.out)
    count, accuracy, followed = (3, 1e-2, 1.5) if args.quick else (30, 1e-4, FOLLOWED)
    found = [runs(seed, accuracy, followed) for seed in tqdm(range(count), unit="record", disable=None, leave=False)]
    plotting.save(drawn(found), out / "many_records.png")
    first, second, third = RUNS
    text = "\n".join([*compared(found, second, first), *compared(found, second, third)])
    header = ["record", *(f"peak/alpha {name} [-]" for name in RUNS), "parted [s]", "ratio before [-]"]
    header += ["parted, half the step [s]", "ratio before, half the step [-]"]
    rows = []
    for i, one in enumerate(found):
        peaks = [f"{one[name].peak:.5g}" for name in RUNS]
        parted = [f"{value:.5g}" for name in (first, third) for value in parting(one[second], one[name])]
        rows.append([i, *peaks, *parted])
    cli.report(out / "many_records", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
