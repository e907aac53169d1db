"""Six walls of the literature by limit analysis, with associated friction and without dilatancy.

The walls are those of Ferris and Tin-Loi, International Journal of Mechanical Sciences 43 (2001) 209: blocks of 0.4 m
by 0.175 m with a coefficient of friction of 0.65 on a fixed base, and a horizontal force of lambda times the weight on
each block. Prints the multipliers beside the published ones, and draws how the walls fail without dilatancy.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import figure_of_panels
from scripts.shared import cli
from scripts.shared.labels import without_axes

LENGTH, HEIGHT, FRICTION = 0.4, 0.175, 0.65
"""Of a whole block [m], and of the joints [-]."""
WALLS: dict[int, tuple[str, dict[str, list[float]]]] = {
    1: ("ababab", {"a": [0.5, 1, 1, 1, 1, 0.5], "b": [1, 1, 1, 1, 1]}),
    2: ("ababababab", {"a": [0.5, 1, 1, 1, 1, 0.5], "b": [1, 1, 1, 1, 1]}),
    3: (
        "abadcdcdaba",
        {"a": [1, 1, 1, 1], "b": [0.5, 1, 1, 1, 0.5], "c": [1, 0.5, -1, 0.5, 1], "d": [0.5, 1, -1, 1, 0.5]},
    ),
    4: (
        "abadcdcdaba",
        {
            "a": [0.5, 1, 1, 1, 1, 0.5],
            "b": [1, 1, 1, 1, 1],
            "c": [0.5, 0.5, -1, 0.5, 0.5, -1, 0.5, 0.5],
            "d": [1, -1, 1, -1, 1],
        },
    ),
    5: (
        "abadcdcdabadcdcdaba",
        {"a": [0.5, 1, 1, 0.5], "b": [1, 1, 1], "c": [0.5, 0.5, -1, 0.5, 0.5], "d": [1, -1, 1]},
    ),
    6: (
        "ababdcdcdbabdcdcdbaba",
        {
            "a": [0.5, 1, 1, 1, 1, 1, 1, 0.5],
            "b": [1, 1, 1, 1, 1, 1, 1],
            "c": [1, 0.5, -1, 0.5, 1, 0.5, -1, 0.5, 1],
            "d": [0.5, 1, -1, 1, 1, -1, 1, 0.5],
        },
    ),
}
"""Courses of each wall from the lowest upwards, and the lengths of their blocks over a whole one; negative: a gap."""
GROUND = 0.15
"""Height of the ground that is drawn [m]."""
PUBLISHED = {
    1: (0.643, 0.640),
    2: (0.580, 0.563),
    3: (0.404, 0.356),
    4: (0.332, 0.264),
    5: (0.240, 0.215),
    6: (0.347, 0.297),
}
"""Multipliers with associated friction and without dilatancy [-]."""


def rectangles(courses: Sequence[Sequence[float]]) -> list[tuple[float, float, float, float]]:
    """Left, lower, right and upper side of each block [m]."""
    found = []
    for i, course in enumerate(courses):
        x = 0.0
        for share in course:
            if share > 0:
                found.append((x * LENGTH, i * HEIGHT, (x + share) * LENGTH, (i + 1) * HEIGHT))
            x += abs(share)
    return found


def masonry_of(courses: Sequence[Sequence[float]], friction: float = FRICTION) -> mr.Masonry:
    """Courses of blocks on a fixed base."""
    long = LENGTH * sum(abs(share) for share in courses[0])
    corners = [(-1.0, -0.5, long + 1.0, 0.0), *rectangles(courses)]
    blocks = [
        mr.Polygon([(a, b), (c, b), (c, d), (a, d)], fixed=i == 0, name="base" if i == 0 else None)
        for i, (a, b, c, d) in enumerate(corners)
    ]
    return mr.Masonry(blocks, k_n=1e10, friction=friction)


def wall(number: int) -> mr.Masonry:
    """One of the six walls."""
    order, courses = WALLS[number]
    return masonry_of([courses[name] for name in order])


def drawn(found: dict[int, mr.Collapse]) -> Figure:
    """How each wall fails without dilatancy."""
    figure, axes = figure_of_panels(len(found), min(3, len(found)), (2.46, 3.5))
    used = list(axes.flat[: len(found)])
    for ax, (number, collapse) in zip(used, found.items(), strict=True):
        plotting.mechanism(ax, collapse)
        ax.set_title(
            rf"wall {number}: $\lambda$ = {collapse.multiplier:.3f}," f"\npublished {PUBLISHED[number][1]:.3f}",
            fontsize=9,
        )
        ax.set_ylim(bottom=-GROUND)
        without_axes(ax)
    walls = [wall(number) for number in found]
    ends = [np.concatenate([masonry.blocks[i].corners for i in masonry.free]) for masonry in walls]
    wide = 0.6 * max(float(np.ptp(own[:, 0])) for own in ends) + 0.3
    highs = [max(ax.get_ylim()[1] for ax in row if ax in used) for row in axes]
    for i, (ax, own) in enumerate(zip(used, ends, strict=True)):  # one scale, and one level of the ground in a row
        middle = float(own[:, 0].max() + own[:, 0].min()) / 2 + 0.1
        ax.set(xlim=(middle - wide, middle + wide), ylim=(-GROUND, highs[i // axes.shape[1]]))
    used[0].get_gridspec().set_height_ratios([high + GROUND for high in highs])
    figure.set_figheight(figure.get_figheight() * (0.2 + 0.8 * float(np.mean(highs)) / max(highs)))  # 0.2: texts
    bar = AnchoredSizeBar(used[0].transData, 1.0, "1 m", "upper right", frameon=False, sep=4)
    used[0].add_artist(bar)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Ask limit analysis, print the table and draw."""
    args = cli.parser(__doc__, "limit_analysis").parse_args(argv)
    out, found, rows = cli.folder(args.out), {}, []
    for number in tqdm([1, 4] if args.quick else list(WALLS), desc="walls", disable=None, leave=False):
        masonry = wall(number)
        begun = time.perf_counter()
        bound = mr.collapse_multiplier(masonry).multiplier
        half = time.perf_counter()
        found[number] = mr.collapse_multiplier(masonry, associated=False)
        spent = half - begun, time.perf_counter() - half
        cells: list[object] = [number, len(masonry.free)]
        for one, published in zip((bound, found[number].multiplier), PUBLISHED[number], strict=True):
            cells += [published, round(one, 4), round(100 * (one / published - 1), 1) + 0.0]
        others = " ".join(f"{other:.4f}" for other in found[number].others)
        rows.append([*cells, others, *(f"{one:.2f} s" for one in spent)])
    plotting.save(drawn(found), out / "limit_analysis.png")
    header = ["wall", "blocks", "associated, published", "associated", "error [%]", "without dilatancy, published"]
    header += ["without dilatancy", "its error [%]", "others found", "time", "its time"]
    cli.report(out / "limit_analysis", cli.table(header, rows), header[:-2], [row[:-2] for row in rows])


if __name__ == "__main__":
    sys.exit(cli.run(main))
