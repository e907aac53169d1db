"""The sketch of the wall and its symbols in docs/theory.md.

Writes sketch.png and prints the angles that it draws.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Polygon, Rectangle

from mjrock import plotting
from mjrock.plotting.bodies import FORCE, GROUND_COLOUR, STONE
from mjrock.plotting.style import BLUE
from scripts.shared import cli

B, H = 0.7, 2.1
"""Half thickness and half height of the wall that is drawn; a stocky one shows the angles best."""
TILT = 0.5
"""Rotation of the tilted wall over alpha."""
WALL: dict[str, Any] = {"facecolor": STONE, "edgecolor": "0.15", "linewidth": 1.2}
GROUND: dict[str, Any] = {"facecolor": GROUND_COLOUR, "edgecolor": "none"}


def turned(points: Sequence[tuple[float, float]], theta: float) -> list[tuple[float, float]]:
    """Points turned clockwise about the outer toe at (B, 0)."""
    c, s = math.cos(theta), math.sin(theta)
    return [(B + (x - B) * c + z * s, z * c - (x - B) * s) for x, z in points]


def ends(ax: Axes, a: tuple[float, float], b: tuple[float, float], text: str, at: tuple[float, float]) -> None:
    """A dimension from a to b."""
    ax.annotate("", a, b, arrowprops={"arrowstyle": "<->", "color": "0.25", "shrinkA": 0, "shrinkB": 0})
    ax.text(*at, text, ha="center", va="center", fontsize=10)


def arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float], text: str, color: str) -> None:
    """An arrow from start to end with a text beyond its end."""
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": 1.8})
    ax.text(end[0], end[1] - 0.12, text, color=color, ha="center", va="top", fontsize=10)


def surroundings(ax: Axes) -> None:
    """The base and the side stop."""
    ax.add_patch(Rectangle((-1.9, -0.28), 5.0, 0.28, **GROUND))
    ax.add_patch(Rectangle((-B - 0.42, 0), 0.42, 2 * H, **GROUND))
    ax.text(-B - 0.21, H, "side stop", rotation=90, ha="center", va="center", fontsize=9)
    ax.text(-1.45, -0.14, "base", ha="center", va="center", fontsize=9)


def frame(ax: Axes, title: str) -> None:
    """Equal scales, no axes, a title."""
    ax.set_xlim(-1.95, 3.15)
    ax.set_ylim(-1.15, 2 * H + 0.75)
    ax.set_aspect("equal")
    ax.axis("off")
    ax.set_title(title, fontsize=11)


def standing(ax: Axes) -> None:
    """The wall at rest: sizes, pivots, alpha, R, and the two polarities of the ground."""
    surroundings(ax)
    ax.add_patch(Rectangle((-B, 0), 2 * B, 2 * H, **WALL))
    ax.plot([B, 0], [0, H], color=BLUE)
    ax.plot([B, B], [0, 2 * H], color=BLUE, linestyle=":")
    alpha = math.atan(B / H)
    ax.add_patch(Arc((B, 0), 2.6, 2.6, theta1=90, theta2=90 + math.degrees(alpha), color=BLUE))
    ax.text(B - 0.24, 1.48, r"$\alpha$", color=BLUE, fontsize=13, ha="center")
    ax.text(0.12, 0.95, "$R$", color=BLUE, fontsize=12, ha="right")
    ax.plot(0, H, "o", color="0.15", markersize=5)
    ax.text(-0.12, H + 0.12, "centroid", fontsize=9, ha="center", va="bottom")
    ax.plot([B, -B], [0, 0], "o", color=FORCE, markersize=7, clip_on=False)
    ax.text(B + 0.1, 0.1, "outer toe", color=FORCE, fontsize=9, va="bottom")
    ax.text(-B + 0.08, 0.1, "inner toe", color=FORCE, fontsize=9, va="bottom")
    ends(ax, (-B, 2 * H + 0.25), (B, 2 * H + 0.25), "$2b$", (0, 2 * H + 0.47))
    ends(ax, (2.1, 0), (2.1, 2 * H), "$2h$", (2.35, H))
    arrow(ax, (0.95, -0.45), (1.75, -0.45), "$a_g > 0$", "0.25")
    arrow(ax, (0.05, -0.45), (-0.75, -0.45), "$a_g < 0$\nopens the wall", "0.25")
    frame(ax, "at rest against its side stop")


def tilted(ax: Axes) -> None:
    """The wall turned about its outer toe: theta, its weight, and the order in which it hits."""
    surroundings(ax)
    alpha = math.atan(B / H)
    theta = TILT * alpha
    corners = turned([(-B, 0), (B, 0), (B, 2 * H), (-B, 2 * H)], theta)
    ax.add_patch(Polygon(corners, closed=True, **WALL))
    ax.plot([B, B], [0, 2 * H], color=BLUE, linestyle=":")
    (edge,) = turned([(B, 2 * H)], theta)
    ax.add_patch(Arc((B, 0), 6.4, 6.4, theta1=90 - math.degrees(theta), theta2=90, color=BLUE))
    ax.text(B + 0.62, 3.18, r"$\theta > 0$", color=BLUE, fontsize=12)
    ax.plot([B, edge[0]], [0, edge[1]], color=BLUE, linewidth=1)
    (centre,) = turned([(0, H)], theta)
    ax.plot(*centre, "o", color="0.15", markersize=5)
    arrow(ax, centre, (centre[0], centre[1] - 0.9), "$m g$", "0.15")
    ax.plot(B, 0, "o", color=FORCE, markersize=7, clip_on=False)
    ax.text(B + 0.1, 0.1, "pivot", color=FORCE, fontsize=9, va="bottom")
    (inner,), (top,) = turned([(-B, 0)], theta), turned([(-B, 2 * H)], theta)
    places = {"1": (inner[0] + 0.2, inner[1] + 0.2), "2": (top[0] + 0.2, top[1] - 0.32), "3": (B - 0.25, 0.3)}
    for number, at in places.items():
        ax.text(*at, number, color=FORCE, fontsize=11, ha="center", va="center")
    ax.plot([inner[0], top[0]], [inner[1], top[1]], "o", color=FORCE, markersize=5)
    ax.annotate("outwards", (2.9, 2 * H + 0.3), (1.55, 2 * H + 0.3), va="center", fontsize=9,
                arrowprops={"arrowstyle": "-|>", "color": "0.25"})  # fmt: skip
    frame(ax, "tilted outwards")


def main(argv: Sequence[str] | None = None) -> None:
    """Draw the two walls."""
    args = cli.parser(__doc__, "sketch").parse_args(argv)
    out = cli.folder(args.out)
    figure = Figure(figsize=(7.4, 4.9), layout="constrained")
    left, right = figure.subplots(1, 2)
    standing(left)
    tilted(right)
    plotting.save(figure, out / "sketch.png")
    alpha = math.atan(B / H)
    print(f"drawn: alpha = {alpha:.3f} rad, theta = {TILT * alpha:.3f} rad")


if __name__ == "__main__":
    sys.exit(cli.run(main))
