"""A panel in running bond pushed in its plane until it fails, against limit analysis and bounds in closed form.

The panel is 1.5 m long and 1.75 m high: 24 units of 0.5 m by 0.25 m without mortar that holds. The ground is brought to
a constant acceleration, a multiple of g, in half a second. The panel fails at the least multiple under which a joint
has opened or slid by more than 20 mm 0.7 s later, which takes 0.008 more than lets it slide. Limit analysis tilts rigid
blocks and takes friction as associated: joints that slide also open, which locks a stair if friction is strong.
The bounds are mechanisms: the panel or the part above a bed joint slides (mu), it turns about its toe as a whole (b/h),
or it turns without the units below a stair, where joints that open do not rub (stair).
Prints the multiples for some coefficients of friction.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLACK
from mjrock.problem.masonry.limit.statics import falling
from scripts.shared import cli
from scripts.shared.labels import SMALL, beside

LENGTH, HEIGHT, UNIT = 1.5, 1.75, (0.5, 0.25)
FRICTIONS = (0.3, 0.45, 0.6, 0.75)
K_N = 1e10
RAMP, HELD = 0.5, 0.7
"""Time in which the acceleration grows, and for which it is then held [s]."""
MOVED = 0.02
"""Opening or sliding of a joint beyond which the panel has failed [m]."""
SHOWN = 0.12
"""Largest displacement of a unit in the picture [m]."""


@cache
def panel(friction: float) -> mr.Masonry:
    """The panel on its ground."""
    return mr.Masonry.running_bond(LENGTH, HEIGHT, UNIT, thickness=0.3, k_n=K_N, friction=friction)


def tilted(masonry: mr.Masonry, angle: float) -> mr.Masonry:
    """The same blocks on ground that falls to the right by an angle [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    turned = [
        mr.Polygon(block.corners @ np.array([[c, -s], [s, c]]), block.density, block.length, block.fixed, name)
        for block, name in zip(masonry.blocks, masonry.names, strict=True)
        if isinstance(block, mr.Polygon)
    ]
    return mr.Masonry(tuple(turned), k_n=masonry.k_n, friction=masonry.friction)


def least(fails: Callable[[float], bool], low: float, high: float, halvings: int) -> float:
    """The middle between the highest multiple that stands and the lowest that fails, by halving."""
    for _ in range(halvings):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if fails(middle) else (middle, high)
    return 0.5 * (low + high)


@cache
def limit(friction: float) -> float:
    """The multiple at which limit analysis finds a mechanism."""
    return least(lambda multiple: bool(falling(tilted(panel(friction), math.atan(multiple)))), 0.0, 1.0, 10)


def stair() -> float:
    """The least multiple that turns the units above a stair about the right end of its lowest bed joint.

    The moving part has all units that stand on one of it, and all to the right of one of it.
    """
    masonry, found = panel(FRICTIONS[0]), []
    units = [masonry.blocks[i] for i in masonry.free]
    left, right = (np.array([pick(u.corners[:, 0]) for u in units]) for pick in (np.min, np.max))
    low = np.array([u.corners[:, 1].min() for u in units])
    for first in range(len(units)):
        edge, moves = left[first], np.zeros(len(units), dtype=bool)
        for z in np.arange(low[first], HEIGHT - 1e-9, UNIT[1]):
            course = np.isclose(low, z) & (right > edge + 1e-9)
            moves |= course
            edge = left[course].min()
        mass = np.array([u.mass for u in units])[moves]
        x, z = np.array([u.centroid for u in units])[moves].T
        found.append(float(mass @ (LENGTH - x) / (mass @ (z - low[first]))))
    return min(found)


def pushed(friction: float, multiple: float, held: float = HELD) -> mr.MasonryResponse:
    """The panel on ground that accelerates to the left."""
    steps = 100
    count = steps + math.ceil(held / RAMP * steps)
    accel = -multiple * mr.GRAVITY * np.minimum(np.arange(count + 1) / steps, 1.0)
    motion = mr.GroundMotion(accel, RAMP / steps, name="ramp")
    return mr.simulate(mr.MasonryCase(panel(friction), RAMP + held, motion=motion), output_step=0.005)


def fails(answer: mr.MasonryResponse) -> bool:
    """Whether a joint has opened or slid so far that the panel does not come back."""
    return bool(answer.fallen) or max(float(answer.opening.max()), float(answer.sliding.max())) > MOVED


def drawn(measured: dict[float, float], answers: dict[float, mr.MasonryResponse], points: int) -> Figure:
    """The panel as it fails at each friction, and the multiples against the bounds, limit analysis at some `points`."""
    figure = Figure(figsize=(7.4, 5.6), layout="constrained")
    grid = figure.add_gridspec(2, max(2, len(answers)), height_ratios=(1, 1.6))
    for i, (friction, answer) in enumerate(answers.items()):
        ax = figure.add_subplot(grid[0, i])
        far = np.hypot(answer.pose[:, :, 0], answer.pose[:, :, 1]).max(axis=1)
        at = int((far > SHOWN).argmax()) or len(far) - 1
        plotting.blocks(ax, answer.of_masonry.masonry, answer.pose[at], limits=[(-0.3, 2.0), (-0.15, 2.0)])
        ax.axis("off")
        ax.set_title(rf"$\mu$ = {friction:g}, {measured[friction]:.3f} $g$", fontsize=9)
        ax.plot([0, 0, LENGTH, LENGTH], [0, HEIGHT, HEIGHT, 0], color="0.4", linestyle=":", linewidth=0.9)  # at rest
    ax = figure.add_subplot(grid[1, :])
    mu, turning = np.linspace(0.2, 0.9, points), LENGTH / HEIGHT
    ax.plot(mu, [limit(float(one)) for one in mu], color=BLACK, linewidth=1.2, label="limit analysis")
    bounds = (
        (mu, r"slides: $\mu$", (0.77, 0.80)),
        (0 * mu + turning, "turns as a whole: $b/h$", (0.2, turning)),
        (0 * mu + stair(), "turns above a stair", (0.2, stair())),
    )
    for y, label, place in bounds:
        ax.plot(mu, y, color="0.5", linestyle="--", linewidth=1)
        ax.text(*place, label, color="0.3", fontsize=SMALL, va="bottom", ha="right" if place[0] > 0.5 else "left")
    look = {"color": plotting.STYLES["MuJoCo"]["color"], "marker": "o", "linestyle": "", "markersize": 7}
    ax.plot(list(measured), list(measured.values()), label="MuJoCo", **look)
    last = max(measured)
    beside(ax, (last, measured[last]), f"{measured[last]:.3f}", look["color"], (0, -9), ha="center")
    beside(ax, (last, limit(last)), f"{limit(last):.3f}", BLACK, (0, 9), ha="center")
    ax.set_ylim(0.15, 0.95)
    ax.set_xlabel(r"coefficient of friction $\mu$ [-]")
    ax.set_ylabel("multiple of $g$ at failure [-]")
    ax.legend(frameon=False, fontsize=9, loc="lower right")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Push, draw and print."""
    args = cli.parser(__doc__, "panel").parse_args(argv)
    out = cli.folder(args.out)
    frictions = FRICTIONS[:1] if args.quick else FRICTIONS
    measured, answers, rows = {}, {}, []
    for friction in tqdm(frictions, desc="frictions", disable=None, leave=False):
        begun, steps, bound = time.perf_counter(), 0, limit(friction)

        def failing(multiple: float, friction: float = friction) -> bool:
            nonlocal steps
            answer = pushed(friction, multiple)
            steps += answer.stats["steps"]
            return fails(answer)

        found = least(failing, 0.7 * bound, 1.1 * bound, 1 if args.quick else 5)
        spent = time.perf_counter() - begun
        measured[friction] = found
        answers[friction] = pushed(friction, 1.03 * found, 1.2 if not args.quick else HELD)
        bounds = [f"{bound:.3f}", f"{friction:.3f}", f"{LENGTH / HEIGHT:.3f}", f"{stair():.3f}"]
        rows.append([f"{friction:g}", f"{found:.3f}", *bounds, f"{found / bound:.3f}", f"{1e3 * spent / steps:.2g}"])
    plotting.save(drawn(measured, answers, 2 if args.quick else 15), out / "panel.png")
    header = ["friction", "MuJoCo", "limit analysis", "slides", "b/h", "stair", "MuJoCo/limit", "ms a step"]
    cli.report(out / "panel", cli.table(header, rows), header[:-1], [row[:-1] for row in rows])


if __name__ == "__main__":
    sys.exit(cli.run(main))
