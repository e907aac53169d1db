"""Published results of UDEC, LMGC90, HybriDFEM and CRA on the same blocks, beside those of mjrock.

A tapered column of eight drums under a pulse of the ground, +a for t_p and -a/2 for 2 t_p, after Dimitri, De Lorenzis
and Zavarise (Engineering Structures 33, 2011): the least a that overturns it, over t_p, what it depends on, and a map
of short pulses. Arches with vertical joints. With `--samples`, a folder of assemblies in the format of COMPAS, those of
compas_cra. No search begins at a published number. A run that was interrupted goes on where it ended.
"""

from __future__ import annotations

import itertools
import math
import sys
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, Look, legend_below
from mjrock.study.campaign.campaign import completed
from scripts.shared import cli, suite
from scripts.shared.labels import beside

CODES = ("UDEC", "LMGC90", "HybriDFEM")
LISTED: Mapping[float, Sequence[float | None]] = {
    0.1: (3.6, 4.3, 4.16),
    0.15: (2.05, 2.2, 2.14),
    0.2: (1.46, 1.48, 1.46),
    0.25: (1.09, None, 1.09),
    0.3: (0.87, 0.88, 0.88),
    0.31: (None, 0.85, 0.84),
    0.32: (0.8, 0.82, 0.81),
    0.33: (0.78, 0.79, 0.78),
    0.34: (0.46, 0.44, 0.39),
    0.35: (0.38, 0.43, 0.37),
    0.36: (None, 0.38, 0.34),
    0.37: (None, 0.36, 0.33),
    0.38: (None, 0.33, 0.31),
    0.39: (None, 0.31, 0.29),
    0.4: (0.31, 0.3, 0.29),
    0.45: (0.28, None, None),
    0.5: (0.27, 0.25, 0.25),
    0.6: (0.25, 0.24, 0.23),
    0.8: (0.22, 0.22, 0.22),
    1.0: (0.2, 0.21, 0.21),
}
"""Least a that overturns [g] by t_p [s] and `CODES`, as `Plt_FailureDomain.py` of the repository thlgrs/HybriDFEM-4
lists them."""
PULSES = tuple(LISTED)
"""Durations t_p [s]."""
PUBLISHED = {code: {t: a for t, row in LISTED.items() if (a := row[i]) is not None} for i, code in enumerate(CODES)}
"""The same by code and t_p."""
STATIC = 0.19
"""Multiplier of limit analysis in the same file [-]."""
K_N, FRICTION, DENSITY = 5e10, 0.7, 2620.0
"""Stiffness of joints in both directions [N/m3], friction [-] and density [kg/m3] of the column."""
BASE, TOP, HEIGHT, DRUMS, DRUM = 1.11, 0.9, 5.95, 7, 0.82
"""Widths at base and top, height, number of drums and height of one [m]; a capital is on top of them."""
FOLLOWED = 4.0
"""How long a column is followed after the pulse [s]."""


class Choice(NamedTuple):
    """What was not published, as one may choose it: name, solver, options of the joints, and of the solver."""

    name: str
    solver: str = "explicit"
    joints: Mapping[str, Any] = {}
    options: Mapping[str, Any] = {}


AS_PUBLISHED = Choice("as published, undamped")
DAMPED = Choice("damping ratio 0.02", joints={"xi": 0.02})
CHOICES = (
    AS_PUBLISHED,
    Choice("stiffness 5e9 N/m3", joints={"k_n": 5e9, "k_s": 5e9}),
    Choice("stiffness 5e11 N/m3", joints={"k_n": 5e11, "k_s": 5e11}),
    DAMPED,
    Choice("damping ratio 0.10", joints={"xi": 0.1}),
    Choice("half the step", options={"timestep": 2.2e-5}),
    Choice("five lines a joint", joints={"points": 5}),
    Choice("friction 0.5", joints={"friction": 0.5}),
    Choice("joints that do not slide", joints={"friction": 10.0}),
    Choice("rigid friction", joints={"k_s": None}),
    Choice("MuJoCo, damping ratio 0.02", "MuJoCo", {"xi": 0.02, "k_s": None}),
)
CHOSEN_AT = (0.2, 0.5)
"""Durations for which every choice is tried [s]."""
SHORT = (0.06, 0.08, 0.1, 0.12, 0.15)
SPEEDS = tuple(round(0.28 + 0.02 * i, 2) for i in range(12))
"""Of the map of short pulses: t_p [s], and a t_p [g s]."""
JUMP = 0.34
SCANNED = tuple(round(0.36 + 0.01 * i, 2) for i in range(15))
"""The pulse [s] at which the codes jump from one branch to another, and the a [g] at which the column is run there."""
LOOKS: Mapping[str, Look] = {
    "UDEC": {"marker": "^", "color": GREEN},
    "LMGC90": {"marker": "x", "color": PURPLE},
    "HybriDFEM": {"marker": "s", "color": ORANGE, "markerfacecolor": "none"},
    "mjrock": {"marker": "o", "color": BLUE},
}
SAMPLES_OF_CRA = (
    *("cubes", "H", "A", "type-a", "type-b", "type-c", "type-d", "shelf-stable"),
    *("shelf", "shelf-s1", "shelf-s2", "shelf-s3", "bridge", "snake"),
)
CRA_FAILS = ("H", "A", "shelf", "shelf-s1", "shelf-s2", "shelf-s3")
"""Samples of compas_cra. Rigid-block equilibrium finds forces for all of them, coupled rigid-block analysis for all but
these: compas_cra 0.8.0, by `scripts/peers/codes/cra.py`."""
CUTS = (41, 81, 161)
VERTICAL, RADIAL = 0.1095, 0.1075
"""Least t/R of a semicircle with vertical and with radial joints, Makris and Alexakis (2013)."""


def column(**given: Any) -> mr.Masonry:
    """The column on the ground, with what is given of its joints."""
    levels = [*(DRUM * i for i in range(DRUMS + 1)), HEIGHT]
    halves = [(BASE - (BASE - TOP) * z / HEIGHT) / 2 for z in levels]
    blocks = [mr.Polygon([(-3.0, -0.75), (3.0, -0.75), (3.0, 0.0), (-3.0, 0.0)], fixed=True, name="ground")]
    for (z, b), (top, t) in itertools.pairwise(zip(levels, halves, strict=True)):
        blocks.append(mr.Polygon([(-b, z), (b, z), (t, top), (-t, top)], density=DENSITY))
    joints = {"k_n": K_N, "k_s": K_N, "xi": 0.0, "points": 2, "friction": FRICTION} | given
    return mr.Masonry(blocks, joints=mr.Dry(**joints))


def pulse(a: float, t_p: float) -> mr.GroundMotion:
    """+a for t_p, -a/2 for 2 t_p [g, s]."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*accelerations are in m/s2", UserWarning)  # beyond 3 g, as published
        return mr.GroundMotion.pieces([(t_p, mr.GRAVITY * a), (2 * t_p, -mr.GRAVITY * a / 2)])


def analysis(choice: Choice, t_p: float, a: float) -> mr.MasonryAnalysis:
    """The column under a pulse of a [g] for t_p [s]."""
    case = mr.MasonryCase(column(**choice.joints), 3 * t_p + FOLLOWED, motion=pulse(a, t_p))
    labels = {"choice": choice.name, "t_p": t_p, "a": a}
    return mr.MasonryAnalysis(case, {"output_step": 0.05, **choice.options}, labels, solver=choice.solver)


def searched(choice: Choice, t_p: float, **looks: Any) -> mr.Capacity:
    """A search for the least a that overturns, from that of a rectangular pulse for one slender block of this size."""
    block = mr.Block.from_size(thickness=(BASE + TOP) / 2, height=HEIGHT)
    start = math.tan(block.alpha) / (1 - math.exp(-block.p * t_p))
    return mr.Capacity(analysis(choice, t_p, start), **looks)


def falls(row: Mapping[str, Any]) -> bool:
    """Whether a block has fallen in the run of a row."""
    return bool(row["outcome"] == mr.Outcome.OVERTURNED.value or row["end_s"] < 3 * row["t_p"] + FOLLOWED)


def spread(t_p: float) -> tuple[float, float, float]:
    """Least, geometric mean and largest of the published thresholds [g]."""
    given = [code[t_p] for code in PUBLISHED.values() if t_p in code]
    return min(given), float(np.exp(np.log(given).mean())), max(given)


def vertical_arch(thick: float, cuts: int) -> mr.Masonry:
    """A semicircle of radius 1 m to its middle, cut by vertical joints; both ends stand on the ground."""
    inner, outer = 1 - thick / 2, 1 + thick / 2
    x = inner * np.sin(np.linspace(-np.pi / 2, np.pi / 2, cuts + 2)[1:-1])
    low, high = np.sqrt(inner**2 - x**2), np.sqrt(outer**2 - x**2)
    blocks = [mr.Polygon([(-2.0, -0.3), (2.0, -0.3), (2.0, 0.0), (-2.0, 0.0)], fixed=True, name="ground")]
    for i, j in itertools.pairwise(range(cuts)):
        blocks.append(mr.Polygon([(x[i], low[i]), (x[j], low[j]), (x[j], high[j]), (x[i], high[i])]))
    arc = np.linspace(0.0, math.acos(x[-1] / outer), 12)[:-1]
    round_it = np.column_stack((outer * np.cos(arc), outer * np.sin(arc)))
    right = np.vstack(([x[-1], low[-1]], [inner, 0.0], round_it, [x[-1], high[-1]]))
    blocks += [mr.Polygon(right), mr.Polygon((right * [-1, 1])[::-1])]
    return mr.Masonry(blocks, k_n=1e10, friction=10.0)


def stands(masonry: mr.Masonry) -> bool:
    """Whether limit analysis finds forces that bear the weight."""
    try:
        mr.collapse_multiplier(masonry)
    except ValueError:
        return False
    return True


def least_thickness(cuts: int, tolerance: float) -> float:
    """The least t/R at which a semicircle with vertical joints stands, by bisection."""
    low, high = 0.09, 0.13
    while high - low > tolerance:
        middle = (low + high) / 2
        low, high = (low, middle) if stands(vertical_arch(middle, cuts)) else (middle, high)
    return high


def wedged(path: Path) -> tuple[int, bool, bool]:
    """Blocks of an assembly, whether limit analysis says that some stand by wedging alone, and whether the search for
    rest on springs refuses it for that."""
    shelf = path.stem.startswith("shelf")
    supports = ["block_0"] if shelf or path.stem in ("cubes", "snake") else ["block_0", "block_1"]
    friction = 0.9 if shelf else {"bridge": 0.9, "snake": 0.7}.get(path.stem, 0.84)
    joints = mr.Dry(k_n=1e10, k_s=1e10, friction=friction)
    masonry = mr.Masonry.from_compas(path, fixed=supports, convex="parts", joints=joints)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*would stand only by wedging", UserWarning)
        found = mr.collapse_multiplier(masonry)
    try:
        mr.solve_explicit(mr.MasonryCase(masonry, 0.01))
    except ValueError as error:
        if "no pose of rest" not in str(error):
            raise
        return len(masonry.free), bool(found.wedged), True
    return len(masonry.free), bool(found.wedged), False


def of_assemblies(folder: Path | None) -> str:
    """The verdicts on every assembly of a folder."""
    if folder is None:
        return "assemblies of compas_cra: not read; --samples takes its folder src/compas_cra/data/samples"
    rows: list[list[object]] = []
    for name in SAMPLES_OF_CRA:
        free, wedge, refused = wedged(folder / f"{name}.json")
        fails = name in CRA_FAILS
        cells = ["no solution" if fails else "stands", "stands by wedging alone" if wedge else "stands"]
        cells += ["refused" if refused else "rests", "yes" if wedge == refused == fails else "no"]
        rows.append([name, free, "stands", *cells])
    header = ["assembly", "free blocks", "equilibrium", "CRA", "limit analysis", "rest on springs", "as CRA"]
    return cli.table(header, rows)


def of_arches(cuts: Sequence[int], tolerance: float = 1e-5) -> str:
    """Least thickness with vertical joints to a tolerance, and the push that arches with either kind of joints bear."""
    rows: list[list[object]] = [
        [f"least t/R, {n} vertical joints", VERTICAL, f"{least_thickness(n, tolerance):.5f}"] for n in cuts
    ]
    for thick in (0.12, 0.15, 0.2):
        radial = mr.Masonry.arch(1.0, thick, voussoirs=cuts[-1], k_n=1e10, friction=10.0)
        bears = [mr.collapse_multiplier(one).multiplier for one in (radial, vertical_arch(thick, cuts[-1]))]
        rows.append([f"push, t/R {thick}", "vertical lower", f"radial {bears[0]:.4f} g, vertical {bears[1]:.4f} g"])
    return cli.table(["arch", "published", "found"], rows)


def apart(name: str, ratios: Sequence[float]) -> list[object]:
    """A row of how far ratios are from one: their number, median distance, median, and the one farthest off."""
    off = np.array(ratios) - 1
    farthest = off[abs(off).argmax()]
    return [name, len(off), f"{np.median(abs(off)):.1%}", f"{np.median(off):+.1%}", f"{farthest:+.1%}"]


def of_codes(found: Mapping[float, float]) -> str:
    """How far mjrock is from each code, and these are from each other."""
    rows = [
        apart(f"mjrock over {name}", [found[t_p] / a for t_p, a in code.items() if t_p in found])
        for name, code in PUBLISHED.items()
    ]
    for one, other in itertools.combinations(PUBLISHED, 2):
        pairs = PUBLISHED[one], PUBLISHED[other]
        both = [t_p for t_p in found if all(t_p in code for code in pairs)]
        rows.append(apart(f"{one} over {other}", [pairs[0][t_p] / pairs[1][t_p] for t_p in both]))
    rows.append(apart("mjrock over the mean of the codes", [a / spread(t_p)[1] for t_p, a in found.items()]))
    inside = sum(spread(t)[0] - 0.005 <= a <= spread(t)[2] + 0.005 for t, a in found.items())
    near = sum(spread(t)[0] / 1.05 <= a <= spread(t)[2] * 1.05 for t, a in found.items())
    text = cli.table(["thresholds", "pulses", "median distance", "median", "largest"], rows)
    return f"{text}\n\n{inside} of {len(found)} within the spread of the codes as they round, {near} within 5 % of it"


def draw_thresholds(ax: Axes, found: Mapping[float, float]) -> None:
    """Thresholds over the duration of the pulse."""
    low, _, high = np.array([spread(t_p) for t_p in found]).T
    ax.fill_between(list(found), low, high, color="0.88", linewidth=0, label="spread of the codes")
    for name, values in (*PUBLISHED.items(), ("mjrock", found)):
        line = {"linewidth": 1.6} if name == "mjrock" else {"linestyle": "none"}
        pairs = {t: a for t, a in values.items() if t in found}
        ax.plot(list(pairs), list(pairs.values()), markersize=4, label=name, **LOOKS[name], **line)
    ax.axhline(STATIC, color=BLACK, linestyle=":", linewidth=1)
    ax.text(0.105, STATIC * 0.98, "limit analysis, 0.19 g", fontsize=8, va="top")
    ax.set(xscale="log", yscale="log", xlabel="$t_p$ [s]", ylabel="least $a$ that overturns [g]", ylim=(0.15, 5.5))
    ax.set_xticks([0.1, 0.2, 0.3, 0.5, 1.0], ["0.1", "0.2", "0.3", "0.5", "1"])
    ax.set_yticks([0.2, 0.5, 1, 2, 5], ["0.2", "0.5", "1", "2", "5"])
    ax.minorticks_off()


def draw_ratios(ax: Axes, found: Mapping[float, float], above: Sequence[float | None]) -> None:
    """Every threshold over the mean of the codes, pulse by pulse, with a line to where the column stands again."""
    at = np.arange(len(found))
    low, mean, high = np.array([spread(t_p) for t_p in found]).T
    ax.bar(at, (high - low) / mean, 0.86, low / mean, color="0.88")
    ax.axhline(1.0, color="0.5", linewidth=0.8)
    for shift, (name, values) in zip((-0.24, -0.08, 0.08, 0.24), (*PUBLISHED.items(), ("mjrock", found)), strict=True):
        has = [i for i, t_p in enumerate(found) if t_p in values]
        ratios = [values[t_p] / m for t_p, m in zip(found, mean, strict=True) if t_p in values]
        ax.plot(at[has] + shift, ratios, linestyle="none", markersize=4, **LOOKS[name])
    top = 1.3
    for x, least, again, m in zip(at + 0.24, found.values(), above, mean, strict=True):
        ax.plot([x, x], [least / m, (again or least) / m], color=BLUE, linewidth=1)
        if least / m > top:
            beside(ax, (x, top), f"{least / m:.2f} \u2191", BLUE, (-4, -8))
    ax.set_xticks(at, [f"{t_p:g}" for t_p in found], rotation=90, fontsize=8)
    ax.set(xlabel="$t_p$ [s]", ylabel="over the mean of the codes [-]", xlim=(-0.6, len(found) - 0.4), ylim=(0.8, top))


def draw_given(column_ax: Axes, pulse_ax: Axes) -> None:
    """The column, and the pulse."""
    plotting.blocks(column_ax, column(), joints=False, limits=np.array([(-1.0, 1.0), (-0.4, HEIGHT + 0.1)]))
    column_ax.axis("off")
    column_ax.set_title("5.95 m high,\n1.11 to 0.90 m wide", fontsize=8)
    pulse_ax.step([-0.3, 0, 1, 3, 3.5], [0, 1, -0.5, 0, 0], where="post", color=BLACK, linewidth=1.2)
    pulse_ax.set_xticks([0, 1, 3], ["0", "$t_p$", "$3t_p$"])
    pulse_ax.set_yticks([-0.5, 0, 1], ["$-a/2$", "0", "$a$"])
    pulse_ax.set_title("ground", fontsize=8)
    pulse_ax.spines[["top", "right"]].set_visible(False)


def drawn(rows: Mapping[float, Mapping[str, Any]], jump: Sequence[float]) -> Figure:
    """Column and pulse, thresholds, and ratios, from the row of each pulse, and the a that overturn at the jump."""
    found = {t_p: row["capacity_g"] for t_p, row in rows.items()}
    figure = Figure(figsize=(7.4, 6.6), layout="constrained")
    halves = figure.add_gridspec(2, 1, height_ratios=[1.25, 1])
    sides = halves[0].subgridspec(1, 2, width_ratios=[1, 3.4])
    given = sides[0].subgridspec(2, 1, height_ratios=[2.4, 1])
    draw_given(figure.add_subplot(given[0]), figure.add_subplot(given[1]))
    ax = figure.add_subplot(sides[1])
    draw_thresholds(ax, found)
    ratios = figure.add_subplot(halves[1])
    draw_ratios(ratios, found, [row["stands_above_g"] for row in rows.values()])
    scan: Look = {"linestyle": "none", "marker": "o", "markersize": 4, "color": BLUE, "markerfacecolor": "none"}
    ax.plot([JUMP] * len(jump), jump, label="mjrock, scan by 0.01 g", **scan)
    if JUMP in found:
        ratios.plot([list(found).index(JUMP) + 0.24] * len(jump), np.array(jump) / spread(JUMP)[1], **scan)
    legend_below(figure, *ax.get_legend_handles_labels(), ncols=5)
    return figure


def draw_map(ax: Axes, rows: Sequence[Mapping[str, Any]], title: str) -> None:
    """Which short pulses overturn the column, and the thresholds of the codes."""
    for name, fell, color in (("mjrock: falls", True, BLACK), ("mjrock: stands", False, "0.85")):
        some = np.array([(row["t_p"], row["a"] * row["t_p"]) for row in rows if falls(row) is fell]).reshape(-1, 2)
        ax.plot(*some.T, linestyle="none", marker="s", markersize=4.5, label=name, color=color)
    for code, values in PUBLISHED.items():
        pairs = np.array([(t_p, a * t_p) for t_p, a in values.items() if t_p <= SHORT[-1]])
        ax.plot(*pairs.T, linestyle="none", markersize=7, label=code, zorder=5, **LOOKS[code])
    ax.set(xlabel="$t_p$ [s]", xlim=(0.05, 0.16))
    ax.set_title(title, fontsize=9)


def drawn_choices(least: Mapping[tuple[str, float], float], rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Thresholds by each choice over the one as published, and maps of short pulses."""
    figure = Figure(figsize=(7.4, 4.6), layout="constrained")
    left, first, second = figure.subplots(1, 3, width_ratios=[1.25, 1, 1])
    names = [*(choice.name for choice in CHOICES if (choice.name, CHOSEN_AT[0]) in least), *PUBLISHED]
    for t_p, marker, color in zip(CHOSEN_AT, "oD", (BLUE, ORANGE), strict=True):
        values = [least[name, t_p] if (name, t_p) in least else PUBLISHED[name][t_p] for name in names]
        look: Look = {"linestyle": "none", "markersize": 5, "marker": marker, "color": color}
        left.plot(np.array(values) / values[0], range(len(names)), label=f"$t_p$ = {t_p:g} s", **look)
    left.axvline(1.0, color="0.5", linewidth=0.8)
    left.axhline(len(names) - len(PUBLISHED) - 0.5, color="0.5", linewidth=0.8)
    left.set_yticks(range(len(names)), names, fontsize=8)
    left.invert_yaxis()
    left.set_xlabel("least $a$, over that as published")
    first.set_ylabel("$a\\,t_p$ [g s]")
    second.sharey(first)
    second.tick_params(labelleft=False)
    for ax, choice in zip((first, second), (AS_PUBLISHED, DAMPED), strict=True):
        draw_map(ax, [row for row in rows if row["choice"] == choice.name], choice.name)
    (dots, code_labels), (marks, codes) = left.get_legend_handles_labels(), first.get_legend_handles_labels()
    legend_below(figure, [*dots, *marks], [*code_labels, *codes], ncols=7)
    return figure


def of_pulses(rows: Mapping[float, Mapping[str, Any]]) -> list[list[object]]:
    """A row a pulse: the thresholds, and up to where the column stands."""
    table: list[list[object]] = []
    for t_p, row in rows.items():
        above = "" if row["stands_above_g"] is None else f"{row['stands_above_g']:.3f}"
        codes = [code.get(t_p, "") for code in PUBLISHED.values()]
        own = [f"{row[name]:.3f}" for name in ("capacity_g", "stands_at_g")]
        table.append([t_p, *codes, *own, f"{row['capacity_g'] / spread(t_p)[1]:.3f}", above])
    return table


def main(argv: Sequence[str] | None = None) -> None:
    """Find the thresholds, print the tables and draw."""
    parser = suite.parser(__doc__, "other_codes", records=False)
    parser.add_argument("--samples", type=Path, help="folder with the assemblies of compas_cra")
    args = parser.parse_args(argv)
    out = cli.folder(args.out)
    store = out / "other_codes.sqlite"
    pulses, choices = (PULSES[2::14], CHOICES[:1]) if args.quick else (PULSES, CHOICES)
    short, speeds = (SHORT[2:3], SPEEDS[::6]) if args.quick else (SHORT, SPEEDS)
    rough: Mapping[str, Any] = {"below": 0, "tolerance": 0.2} if args.quick else {}
    tasks = [searched(AS_PUBLISHED, t_p, **{"below": 25, "spacing": 0.03, **rough}) for t_p in pulses]
    tried = {(one.name, t_p): searched(one, t_p, **{"below": 12, **rough}) for one in choices for t_p in CHOSEN_AT}
    rows = completed([*tasks, *tried.values()], store, workers=args.workers)
    by_pulse = dict(zip(pulses, rows, strict=False))
    found = {t_p: row["capacity_g"] for t_p, row in by_pulse.items()}
    least = dict(zip(tried, (row["capacity_g"] for row in rows[len(pulses) :]), strict=True))
    scan = [analysis(AS_PUBLISHED, JUMP, a) for a in SCANNED[:: 14 if args.quick else 1]]
    grid = [analysis(choice, t_p, v / t_p) for choice in (AS_PUBLISHED, DAMPED) for t_p in short for v in speeds]
    ends = completed([*scan, *grid], store, workers=args.workers)
    jump, mapped = [row["a"] for row in ends[: len(scan)] if falls(row)], ends[len(scan) :]
    plotting.save(drawn(by_pulse, jump), out / "other_codes.png")
    plotting.save(drawn_choices(least, mapped), out / "other_codes_choices.png")
    header = [
        "t_p [s]",
        *PUBLISHED,
        "mjrock [g]",
        "stands at [g]",
        "over the mean of the codes",
        "stands above, at [g]",
    ]
    table = of_pulses(by_pulse)
    static = mr.collapse_multiplier(column()).multiplier
    texts = [cli.table(header, table), of_codes(found), of_choices(least), of_map(mapped)]
    texts.append(
        f"t_p {JUMP} s, {len(scan)} a from {scan[0].labels['a']} to {scan[-1].labels['a']} g: overturns at {jump}"
    )
    texts.append(f"limit analysis: {STATIC} published, {static:.4f} found")
    texts += [of_assemblies(args.samples), of_arches(CUTS[:1], 1e-2) if args.quick else of_arches(CUTS)]
    cli.report(out / "other_codes", "\n\n".join(texts), header, table)


def of_choices(least: Mapping[tuple[str, float], float]) -> str:
    """Thresholds by each choice."""
    names = [choice.name for choice in CHOICES if (choice.name, CHOSEN_AT[0]) in least]
    rows: list[list[object]] = [[name, *(f"{least[name, t_p]:.3f}" for t_p in CHOSEN_AT)] for name in names]
    rows += [[code, *(values[t_p] for t_p in CHOSEN_AT)] for code, values in PUBLISHED.items()]
    return cli.table(["choice", *(f"t_p {t_p:g} s [g]" for t_p in CHOSEN_AT)], rows)


def of_map(rows: Sequence[Mapping[str, Any]]) -> str:
    """Of each short pulse the least a that overturns, and the largest beyond it at which the column stands."""
    cells: list[list[object]] = []
    for choice, t_p in dict.fromkeys((row["choice"], row["t_p"]) for row in rows):
        here = sorted((row["a"], falls(row)) for row in rows if (row["choice"], row["t_p"]) == (choice, t_p))
        fell = [a for a, over in here if over]
        stood = [a for a, over in here if not over and fell and a > fell[0]]
        cells.append(
            [choice, t_p, f"{fell[0]:.2f}" if fell else "none", f"{stood[-1]:.2f}" if stood else "", len(stood)]
        )
    return cli.table(
        ["choice", "t_p [s]", "least a that overturns [g]", "stands above, up to [g]", "of so many"], cells
    )


if __name__ == "__main__":
    sys.exit(cli.run(main))
