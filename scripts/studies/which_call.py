"""Which call is for what: a façade, one block of it, the same as many blocks, and one contact.

Writes which_call.png.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon, Rectangle

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLACK, ORANGE
from scripts.shared import cli

STONE, GROUND = "#dfae8b", "#bfbfbf"
WIDTH, EAVES, TOP = 6.0, 5.0, 6.6
"""Of the façade [m]."""
LIMITS = (-4.2, 4.2), (-0.5, 7.0)
"""Of the panels that show it [m]."""


def ground(ax: Axes) -> None:
    """The ground of a panel."""
    ax.add_patch(Rectangle((LIMITS[0][0], -0.4), LIMITS[0][1] - LIMITS[0][0], 0.4, facecolor=GROUND))


def front(ax: Axes) -> None:
    """The façade with the cracks along which it comes off its side walls."""
    ground(ax)
    half = 0.5 * WIDTH
    ax.add_patch(
        Polygon([(-half, 0), (half, 0), (half, EAVES), (0, TOP), (-half, EAVES)], facecolor=STONE, edgecolor=BLACK)
    )
    for x, z, wide, high in ((-0.7, 0.0, 1.4, 2.4), (-0.5, 3.6, 1.0, 1.0)):
        ax.add_patch(Rectangle((x, z), wide, high, facecolor="white", edgecolor=BLACK))
    steps = np.array([(0.0, 0.0), (0.15, 0.7), (-0.1, 1.5), (0.2, 2.4), (0.0, 3.3), (0.15, 4.1), (0.0, EAVES)])
    for side in (-1, 1):
        ax.plot(side * (half - 0.45) + steps[:, 0], steps[:, 1], color=ORANGE, linewidth=1.8)


def block(ax: Axes) -> None:
    """One block that turns about its toe."""
    ground(ax)
    corners = np.array([(-0.6, 0.0), (0.0, 0.0), (0.0, TOP), (-0.6, TOP)])
    turned = corners @ np.array([[np.cos(0.2), -np.sin(0.2)], [np.sin(0.2), np.cos(0.2)]])
    ax.add_patch(Polygon(corners, facecolor="none", edgecolor="0.6", linestyle="--"))
    ax.add_patch(Polygon(turned, facecolor=STONE, edgecolor=BLACK))
    ax.add_patch(Circle((0.0, 0.0), 0.16, color=ORANGE, zorder=5))


def blocks(ax: Axes) -> None:
    """Many blocks, of which some have come off."""
    wall = mr.Masonry.running_bond(WIDTH, 5.4, (0.6, 0.3), k_n=1e9, friction=0.6)
    pose = np.zeros((len(wall.free), 3))
    middle = wall.centroids[list(wall.free)]
    off = middle[:, 0] + 0.45 * middle[:, 1] - middle[:, 0].max() - 0.6
    pose[:, 0] = 0.25 * np.maximum(off, 0.0)
    pose[:, 1] = -0.08 * np.maximum(off, 0.0) ** 2
    pose[:, 2] = 0.1 * np.maximum(off, 0.0)
    left, right = middle[:, 0].min(), middle[:, 0].max()
    shift = 0.5 * (left + right)
    limits = [(LIMITS[0][0] + shift, LIMITS[0][1] + shift), LIMITS[1]]
    plotting.blocks(ax, wall, pose, joints=False, limits=limits)
    for note in list(ax.texts):
        note.remove()
    ax.set(xlim=limits[0], ylim=limits[1], xlabel="", ylabel="")


def contact(ax: Axes) -> None:
    """One contact: a spring and a dashpot between a body and the ground."""
    ground(ax)
    ax.add_patch(Rectangle((-2.0, 3.2), 4.0, 2.2, facecolor=STONE, edgecolor=BLACK))
    zigzag = np.array([0, 0, 1, -1, 1, -1, 1, 0, 0])
    heights = np.array([0.0, 0.6, 0.8, 1.1, 1.4, 1.7, 2.0, 2.2, 3.2])
    ax.plot(-0.9 + 0.3 * zigzag, heights, color=BLACK)
    for x, z in (([0.9, 0.9], [0.0, 1.2]), ([0.6, 0.6, 1.2, 1.2], [2.0, 1.2, 1.2, 2.0]), ([0.6, 1.2], [1.6, 1.6])):
        ax.plot(x, z, color=BLACK)
    ax.plot([0.9, 0.9], [1.6, 3.2], color=BLACK)
    ax.text(-1.4, 1.4, "$k$", ha="right", va="center", fontsize=11)
    ax.text(1.4, 1.4, "$c$ or $e$", ha="left", va="center", fontsize=11)
    ax.text(0.0, 4.3, "$m$", ha="center", va="center", fontsize=11)


PANELS = (
    ("a façade", front, "which part moves?", "collapse_multiplier\nmechanism_check\nCorner"),
    ("one block", block, "does it fall?", "Block, Case\nsolve_analytical\nsimulate, campaign"),
    ("many blocks", blocks, "how does it come apart?", "Masonry, MasonryCase\nsolve_explicit\nsimulate"),
    ("one contact", contact, "a MuJoCo model of yours", "contact_for\ninspect_contacts\nmeasure"),
)
"""Name, drawing, question and calls of each panel."""


def drawn() -> Figure:
    """The four panels side by side."""
    figure = Figure(figsize=(7.4, 3.0))
    for i, (name, draw, question, calls) in enumerate(PANELS):
        ax = figure.add_axes((0.25 * i + 0.005, 0.3, 0.24, 0.58))
        draw(ax)
        ax.set(xlim=ax.get_xlim() if draw is blocks else LIMITS[0], ylim=LIMITS[1], aspect="equal")
        ax.axis("off")
        middle = 0.25 * i + 0.125
        figure.text(middle, 0.93, name, ha="center", fontsize=11, weight="bold")
        figure.text(middle, 0.27, question, ha="center", va="top", fontsize=9)
        figure.text(middle, 0.19, calls, ha="center", va="top", fontsize=8, family="monospace", linespacing=1.4)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Draw it."""
    args = cli.parser(__doc__, "which_call").parse_args(argv)
    print(plotting.save(drawn(), cli.folder(args.out) / "which_call.png"))


if __name__ == "__main__":
    sys.exit(cli.run(main))
