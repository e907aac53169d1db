"""A column of drums and an arch near overturning under 30 records each, in MuJoCo and by explicit steps.

The column is three drums 0.6 m wide and 1.2 m high; the arch has five voussoirs 0.4 m thick on a radius of 2.5 m.
Joints of 2 lines stick rigidly, k_n = 1e9 N/m3, mu = 0.7, xi = 0.05. The synthetic records have a peak of 5 m/s2 and
last 6 s for the column, 8 m/s2 and 4 s for the arch, and the motion is followed for a second more. A run overturns when
a block has turned by more than 0.5 rad. Every record is run three times: by `simulate(accuracy=1e-4)`, by explicit
steps of the default length, and by steps half as long, which tells how far the scheme scatters by itself.
Two runs part where a rotation differs by more than 2 mrad, which is 1.2 % of the angle at which the column overturns as
one block. Prints how the largest rotations before that compare, how many overturn (exact sign test on the pairs of
which one alone does), the median ratio of peaks where both stand (interval of order statistics, 95 %), and the
Kolmogorov-Smirnov test on all peaks, those that overturn counted as largest. The test takes the samples as independent;
since they share their records it is the less likely to find a difference.
Writes many_records.csv, .png and .txt.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.stats import binom, binomtest, ks_2samp
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLACK, BLUE, ORANGE, Look, below_figure
from mjrock.quantities import Array
from scripts.shared import cli
from scripts.shared.labels import SMALL
from scripts.shared.paths import OVERTURNED, SAMPLE, Path, draw_square, pairs_of, parting, path_of

STRUCTURES = {"column": (5.0, 6.0), "arch": (8.0, 4.0)}
"""Largest acceleration of the records [m/s2], and their duration [s]."""
AFTER = 1.0
"""How long the motion is followed after a record [s]."""
RUNS: dict[str, Look] = {
    "MuJoCo": {"color": ORANGE, "linestyle": "-"},
    "explicit": {"color": BLUE, "linestyle": "-"},
    "explicit, half the step": {"color": BLACK, "linestyle": "--"},
}
"""The runs and their lines."""
SHOWN = "arch"
"""What is drawn: of the column all three runs are alike."""


def built(name: str) -> mr.Masonry:
    """The column or the arch."""
    if name == "arch":
        return mr.Masonry.arch(2.5, 0.4, 0.9 * math.pi, 5, k_n=1e9, friction=0.7, xi=0.05)
    return mr.Masonry.stack([mr.Block.from_size(thickness=0.6, height=1.2)] * 3, k_n=1e9, friction=0.7, xi=0.05)


def runs(name: str, seed: int, accuracy: float, shaken: float) -> dict[str, Path]:
    """The three runs of one record."""
    record = mr.GroundMotion.synthetic(STRUCTURES[name][0], shaken, seed=seed)
    case = mr.MasonryCase(built(name), shaken + AFTER, record)
    coarse = mr.solve_explicit(case, output_step=SAMPLE)
    fine = mr.solve_explicit(case, timestep=0.5 * coarse.stats["timestep"], output_step=SAMPLE)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of blocks that leave their joints
        engine = mr.simulate(case, accuracy=accuracy, output_step=SAMPLE)
    return dict(zip(RUNS, map(path_of, (engine, coarse, fine)), strict=True))


def median_interval(values: Array) -> tuple[float, float, float]:
    """The median and its interval of 95 % by order statistics, NaN of fewer than six values."""
    n = len(values)
    if n < 6:
        return (float(np.median(values)) if n else math.nan, math.nan, math.nan)
    k = int(binom.ppf(0.025, n, 0.5))
    ordered = np.sort(values)
    return float(np.median(values)), float(ordered[k - 1]), float(ordered[n - k])


def compared(of: str, found: Sequence[dict[str, Path]], name: str, other: str) -> list[str]:
    """What tells two ways to run the same records apart, in words."""
    pairs = pairs_of(found, name, other)
    off, stay, stand, alone = np.abs(pairs.before - 1), np.isinf(pairs.parts), pairs.stand, pairs.alone
    middle, low, high = median_interval(stand)
    peaks = [np.array([min(one[way].peak, 1e3) for one in found]) for way in (name, other)]
    first = f"at {np.median(pairs.parts[~stay]):.2f} s in the median" if (~stay).any() else "never"
    return [
        f"{of}, {name} against {other}, {len(found)} records:",
        f"  {(~stay).sum()} part, {first}; largest rotations until then differ by {np.median(off):.1e} in the median, "
        f"{off.max():.1e} at most; {(off < 0.01).sum()} within 1 %",
        f"  overturn: {pairs.overturn[0]} and {pairs.overturn[1]}, {alone[0]} and {alone[1]} alone, sign test p = "
        f"{binomtest(alone[0], sum(alone)).pvalue if sum(alone) else 1.0:.2g}",
        f"  peaks where both stand ({len(stand)}): median ratio {middle:.4f}, 95 % {low:.4f} to {high:.4f}, "
        f"smallest {stand.min(initial=math.inf):.3f}, largest {stand.max(initial=0.0):.3f}",
        f"  Kolmogorov-Smirnov on all peaks: p = {ks_2samp(*peaks, method='asymp').pvalue:.2g}",
    ]


def drawn(found: Sequence[dict[str, Path]]) -> Figure:
    """A record whose paths part, and the peaks in pairs."""
    figure = Figure(figsize=(7.4, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    draw_paths(left, found)
    draw_pairs(right, [{run: path.peak for run, path in one.items()} for one in found])
    below_figure(figure, left)
    right.legend(frameon=False, fontsize=SMALL, loc="upper left", bbox_to_anchor=(0.0, 0.8))
    return figure


def draw_paths(ax: Axes, found: Sequence[dict[str, Path]]) -> None:
    """Of the records under which nothing overturns, the one whose paths part at the median time."""
    first, second, _ = RUNS
    late = [parting(one[second], one[first]).when for one in found]
    standing = [i for i, one in enumerate(found) if not any(path.overturns for path in one.values())]
    parted = [i for i in standing if math.isfinite(late[i])] or standing or [0]
    shown = sorted(parted, key=lambda i: late[i])[len(parted) // 2]
    block = int(np.abs(found[shown][second].rotation).max(axis=0).argmax())
    for run, look in RUNS.items():
        theta = 1e3 * found[shown][run].rotation[:, block]
        ax.plot(SAMPLE * np.arange(len(theta)), theta, linewidth=1.1, label=run, **look)
    if math.isfinite(late[shown]):
        ax.set_ylim(top=1.1 * ax.get_ylim()[1])
        ax.axvline(late[shown], color="0.5", linewidth=0.8, linestyle=":")
        ax.text(late[shown], 0.96, " they part", transform=ax.get_xaxis_transform(), fontsize=SMALL, va="top")
    ax.set(xlabel="$t$ [s]", ylabel="rotation [mrad]")
    ax.set_title(f"{SHOWN}, record {shown}, block {block}", fontsize=9)


def draw_pairs(ax: Axes, peaks: Sequence[dict[str, float]]) -> None:
    """Peaks of the same record [rad], those that overturn in the grey."""
    first, second, third = RUNS
    edge = OVERTURNED
    low = 0.7 * min(value for one in peaks for value in one.values())
    for other, marker in ((first, "o"), (third, "x")):
        x, y = ([min(one[run], 1.4 * edge) for one in peaks] for run in (second, other))
        ax.plot(x, y, marker, color=RUNS[other]["color"], markerfacecolor="none", label=other)
    draw_square(ax, low, edge)
    ax.text(1.4 * edge, 1.1 * low, "overturned", rotation=90, fontsize=SMALL, ha="center", va="bottom", color="0.3")
    ax.set(xlabel="peak rotation, explicit [rad]", ylabel="peak rotation of the other run [rad]")
    ax.set_title("peaks of all records", fontsize=9)


def main(argv: Sequence[str] | None = None) -> None:
    """Run every record, compare, draw and print."""
    args = cli.parser(__doc__, "many_records").parse_args(argv)
    out = cli.folder(args.out)
    count, accuracy = (2, 1e-2) if args.quick else (30, 1e-4)
    found: dict[str, list[dict[str, Path]]] = {}
    with tqdm(total=count * len(STRUCTURES), unit="record", disable=None, leave=False) as bar:
        for name, (_, shaken) in STRUCTURES.items():
            found[name] = []
            for seed in range(count):
                found[name].append(runs(name, seed, accuracy, 1.0 if args.quick else shaken))
                bar.update()
    plotting.save(drawn(found[SHOWN]), out / "many_records.png")
    first, second, third = RUNS
    text = "\n".join(
        line for name, own in found.items() for other in (first, third) for line in compared(name, own, second, other)
    )
    header = ["structure", "record", *(f"peak {name} [rad]" for name in RUNS), "parted [s]", "ratio before [-]"]
    header += ["parted, half the step [s]", "ratio before, half the step [-]"]
    rows = []
    for name, own in found.items():
        for i, one in enumerate(own):
            peaks = [f"{one[run].peak:.5g}" for run in RUNS]
            apart = (parting(one[second], one[run]) for run in (first, third))
            parted = [f"{value:.5g}" for pair in apart for value in (pair.when, pair.ratio)]
            rows.append([name, i, *peaks, *parted])
    cli.report(out / "many_records", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
