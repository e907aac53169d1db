"""Capacity of a facade strip against the stiffness of its joints, by explicit steps, over that of limit analysis.

The strip is a section through a facade without mortar, 3 m high and 0.6 m thick: 10 courses of a header of 0.4 m and
one of 0.2 m, which change sides. mu = 0.7, 2000 kg/m3. The ground is brought to a constant acceleration within 1 s
along a cosine, and held there for 1.5 s. The strip has failed when its top has moved by more than 0.15 m, a quarter of
its thickness. The capacity is the middle between the highest multiple of g that stands and the lowest that fails, at
most 0.01 of the limit apart. Limit analysis has rigid blocks and associated friction. k_n runs from 1e8 to 1e12 N/m3,
and k_s is 0.1, 0.4 and 1 times k_n, or the joints stick rigidly. The capacity of the softest joints is found again
where the ground takes three times as long, to tell how slow is slow enough.
Writes joint_stiffness.csv, .png and .txt.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLUE, ORANGE
from mjrock.problem.masonry.limit.statics import falling
from scripts.shared import cli

THICKNESS, HEIGHT, UNIT = 0.6, 3.0, (0.4, 0.3)
DENSITY, FRICTION = 2000.0, 0.7
STIFFNESSES = (1e8, 1e9, 1e10, 1e11, 1e12)
"""k_n of the joints [N/m3]."""
RATIOS = (0.1, 0.4, 1.0, None)
"""k_s over k_n [-]; None sticks rigidly."""
RAMP, HELD = 1.0, 1.5
"""Time in which the acceleration grows, and for which it is then held [s]."""
MOVED = 0.25 * THICKNESS
"""Displacement of the top at which the strip has failed [m]."""
XI = 0.01
"""Damping ratio at the lowest frequency: more would cost steps in proportion."""
LOWEST, HIGHEST, WIDTH = 0.3, 1.03, 0.01
"""Where the capacity of the softest joints is looked for, and how well it is found, over the limit [-]."""


def strip(k_n: float, ratio: float | None) -> mr.Masonry:
    """The strip on its ground."""
    k_s = None if ratio is None else ratio * k_n
    return mr.Masonry.running_bond(THICKNESS, HEIGHT, UNIT, density=DENSITY, k_n=k_n, k_s=k_s, friction=FRICTION, xi=XI)


def limit(heads: float = FRICTION) -> float:
    """The multiple of g at which limit analysis finds a mechanism, with some friction of the head joints [-]."""
    low, high = 0.0, 1.0
    masonry = mr.Masonry(strip(1e10, None).blocks, friction=lambda joint: FRICTION if joint.is_bed else heads)
    masses = np.array([masonry.blocks[i].mass for i in masonry.free])
    for _ in range(14):
        middle = 0.5 * (low + high)
        applied = np.column_stack([middle * mr.GRAVITY * masses, 0 * masses, 0 * masses])
        low, high = (low, middle) if falling(masonry, applied) else (middle, high)
    return 0.5 * (low + high)


def fails(masonry: mr.Masonry, multiple: float, ramp: float) -> bool:
    """Whether the strip falls where the ground is slowly brought to an acceleration."""
    t = np.linspace(0.0, ramp + HELD, 501)
    accel = multiple * mr.GRAVITY * (0.5 - 0.5 * np.cos(np.pi * np.minimum(t / ramp, 1.0)))
    case = mr.MasonryCase(masonry, float(t[-1]), mr.GroundMotion(-accel, float(t[1])))
    answer = mr.solve_explicit(case, output_step=5e-3)
    top = answer.pose[:, -1, 0]
    return bool(np.abs(top - top[0]).max() > MOVED)


def capacity(masonry: mr.Masonry, bound: float, low: float, width: float, ramp: float = RAMP) -> float:
    """The multiple of g that the strip bears, over that of limit analysis [-], known to bear `low`."""
    high = HIGHEST
    while high - low > width:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if fails(masonry, middle * bound, ramp) else (middle, high)
    return 0.5 * (low + high)


def name(ratio: float | None) -> str:
    """A ratio of stiffnesses in words."""
    return "rigid" if ratio is None else f"{ratio:g}"


def drawn(found: dict[float | None, list[float]], stiffnesses: Sequence[float]) -> Figure:
    """Capacity over stiffness, for the softest joints along their faces and for all others together."""
    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    ax = figure.subplots()
    others = np.array([values for ratio, values in found.items() if ratio != RATIOS[0]])
    apart = 100 * max(float(np.ptp(others, axis=0).max()), 0.5 * WIDTH)
    label = f"$k_s$ from {RATIOS[1]:g} $k_n$ to rigid: alike to {apart:.1g} %"
    ax.plot(stiffnesses, others.mean(axis=0), "o-", color=BLUE, label=label)
    ax.plot(
        stiffnesses, found[RATIOS[0]], "v--", color=ORANGE, markerfacecolor="none", label=f"$k_s$ = {RATIOS[0]:g} $k_n$"
    )
    ax.axhline(1.0, color="0.5", linewidth=0.8)
    ax.text(stiffnesses[0], 1.0, "limit analysis", color="0.3", fontsize=8, va="bottom")
    ax.set_xscale("log")
    ax.set_xlabel(r"stiffness of the joints $k_n$ [N/m$^3$]")
    ax.set_ylabel("acceleration at failure\nover that of limit analysis [-]")
    ax.set_ylim(top=1.04)
    ax.legend(frameon=False, fontsize=8, loc="lower right")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Find every capacity, draw and print."""
    args = cli.parser(__doc__, "joint_stiffness").parse_args(argv)
    out = cli.folder(args.out)
    stiffnesses, width = (STIFFNESSES[:2], 0.5) if args.quick else (STIFFNESSES, WIDTH)
    bound = limit()
    found: dict[float | None, list[float]] = {}
    with tqdm(total=len(stiffnesses) * len(RATIOS), unit="strip", disable=None, leave=False) as bar:
        for ratio in RATIOS:
            found[ratio] = []
            for k_n in stiffnesses:
                low = max([LOWEST, *(one - WIDTH for one in found[ratio])])  # stiffer joints bear no less
                found[ratio].append(capacity(strip(k_n, ratio), bound, low, width))
                bar.update()
    plotting.save(drawn(found, stiffnesses), out / "joint_stiffness.png")
    rows = [[name(ratio), *(f"{one:.3f}" for one in values)] for ratio, values in found.items()]
    header = ["k_s / k_n [-]", *(f"k_n = {k_n:.0e} N/m3" for k_n in stiffnesses)]
    text = f"limit analysis: {bound:.4f} g, {limit(0.0) / bound:.3f} of it with smooth head joints; "
    text += f"thickness over height {THICKNESS / HEIGHT:g}\n"
    text += "capacity over that of limit analysis, to " + f"{0.5 * width:g}:\n" + cli.table(header, rows)
    if not args.quick:
        slow = capacity(strip(stiffnesses[0], 1.0), bound, LOWEST, width, 3 * RAMP)
        text += f"\nk_n = {stiffnesses[0]:.0e} N/m3, k_s = k_n, three times as slow: {slow:.3f}"
    cli.report(out / "joint_stiffness", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
