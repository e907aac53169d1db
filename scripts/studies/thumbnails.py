"""A small picture of each example for the page of examples: the building, or the contact, that it is about.

Examples of many blocks are run, and what they find is drawn. Walls are drawn in section and façades from the front.
Writes a PNG for each example, named after it.
"""

from __future__ import annotations

import contextlib
import io
import runpy
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon, Rectangle
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.solids import Solids, draw_solids, fill_view
from mjrock.plotting.style import BLACK, BLUE, GREEN, ORANGE, Look
from mjrock.quantities import Array
from scripts.shared import cli

EXAMPLES = Path(mr.__file__).parent / "examples"
STONE, GROUND = "#dfae8b", "#bfbfbf"
SIZE, DPI = (4.0, 2.8), 100
"""Of a picture [inch], and pixels to an inch."""
LINE = 2.0
"""Width of outlines [pt]."""
FORCE: Look = {"color": ORANGE, "width": 0.09, "head_width": 0.4, "head_length": 0.4, "length_includes_head": True}


def ground(ax: Axes, left: float = -4.5, right: float = 4.5) -> None:
    """The ground under what is drawn [m]."""
    ax.add_patch(Rectangle((left, -0.4), right - left, 0.4, facecolor=GROUND))


def turned(corners: Array, tilt: float) -> Array:
    """Corners that have turned outwards about the origin by a tilt [rad]."""
    made: Array = corners @ np.array([[np.cos(tilt), -np.sin(tilt)], [np.sin(tilt), np.cos(tilt)]])
    return made


def wall(ax: Axes, tilt: float = 0.0, toe: float = 0.5, *, stop: bool = True) -> None:
    """A section of a wall of 1 x 6 m that has turned about its toe by a tilt [rad], in front of its side stop."""
    corners = np.array([(-1.0, 0.0), (0.0, 0.0), (0.0, 6.0), (-1.0, 6.0)])
    if stop:
        ax.add_patch(Rectangle((toe - 1.6, 0.0), 0.6, 6.0, facecolor=GROUND, edgecolor="0.5", hatch="///"))
    if tilt:
        ax.add_patch(Polygon(np.add(corners, (toe, 0.0)), facecolor="none", edgecolor="0.6", linestyle="--"))
    place = np.add(turned(corners, tilt), (toe, 0.0))
    ax.add_patch(Polygon(place, facecolor=STONE, edgecolor=BLACK, linewidth=LINE))


def front(ax: Axes, middle: float, size: tuple[float, float, float], colour: Any = STONE, rose: float = 0.5) -> None:
    """A façade of a width, with eaves and a ridge at these heights [m], with a door and a round window."""
    wide, eaves, ridge = size
    outline = [(-wide / 2, 0), (wide / 2, 0), (wide / 2, eaves), (0, ridge), (-wide / 2, eaves)]
    ax.add_patch(Polygon(np.add(outline, (middle, 0.0)), facecolor=colour, edgecolor=BLACK, linewidth=LINE))
    door = wide / 4, 0.4 * eaves
    ax.add_patch(Rectangle((middle - door[0] / 2, 0), *door, facecolor="white", edgecolor=BLACK, linewidth=LINE))
    ax.add_patch(Circle((middle, 0.75 * eaves), rose, facecolor="white", edgecolor=BLACK, linewidth=LINE))


def released(ax: Axes) -> None:
    """A wall that is held tilted away from its side stop."""
    ground(ax)
    wall(ax, 0.2)


def numbered(ax: Axes) -> None:
    """A façade with its width and its height."""
    ground(ax, -3.5, 4.5)
    front(ax, 0.0, (5.6, 4.4, 6.0))
    for x, z, end in (([-2.8, 2.8], [-0.9, -0.9], "|"), ([3.7, 3.7], [0.0, 6.0], "_")):
        ax.plot(x, z, color=BLUE, linewidth=LINE, marker=end, markersize=12, markeredgewidth=LINE)


def spring(ax: Axes, x: float, low: float, high: float) -> None:
    """A spring [m]."""
    across = 0.18 * np.array([0, 0, 1, -1, 1, -1, 1, 0, 0])
    ax.plot(x + across, np.linspace(low, high, 9), color=BLUE, linewidth=LINE)


def sprung(ax: Axes) -> None:
    """A wall on springs."""
    ax.add_patch(Rectangle((-3.0, -1.6), 6.0, 0.4, facecolor=GROUND))
    wall(ax, stop=False)
    for x in (-0.4, 0.4):
        spring(ax, x, -1.2, 0.0)


def mirrored(ax: Axes) -> None:
    """Two walls: the ground moves inwards under the one and outwards under the other."""
    for toe, tilt, along in ((-2.0, 0.25, -1.6), (3.0, 0.0, 1.6)):
        ground(ax, toe - 2.4, toe + 2.2)
        wall(ax, tilt, toe)
        ax.arrow(toe - along / 2 - 0.2, -1.0, along, 0.0, **FORCE)


def tied(ax: Axes) -> None:
    """A wall that a vault pushes outwards and a tie holds."""
    ground(ax)
    wall(ax)
    ax.plot([-3.6, -0.5], [5.4, 5.4], color=BLUE, linewidth=2 * LINE, linestyle=":")
    ax.add_patch(Rectangle((-3.9, 5.05), 0.3, 0.7, facecolor=BLUE))
    ax.arrow(0.5, 4.4, 1.9, 0.0, **FORCE)


def damped(ax: Axes) -> None:
    """A wall that slips on a floor, through a friction damper."""
    ground(ax)
    ax.add_patch(Rectangle((-4.5, 3.6), 2.2, 0.5, facecolor=GROUND, edgecolor="0.5"))
    wall(ax, 0.12, stop=False)
    ax.plot([-2.3, -0.1], [3.85, 3.85], color=GREEN, linewidth=2 * LINE)
    ax.add_patch(Rectangle((-1.9, 3.45), 0.9, 0.8, facecolor="white", edgecolor=GREEN, linewidth=LINE, zorder=3))


def pushed(ax: Axes) -> None:
    """A tilted wall and the horizontal force that holds it."""
    ground(ax)
    wall(ax, 0.2, stop=False)
    ax.arrow(-2.6, 3.2, 2.5, 0.0, **FORCE)


def recorded(ax: Axes) -> None:
    """A wall on the ground, and the record that moves it."""
    ground(ax)
    wall(ax)
    record = mr.GroundMotion.synthetic(peak=1.0, duration=8.0, seed=3)
    a = record.accel
    ax.plot(np.linspace(-4.5, 4.5, len(a)), -1.6 + 0.9 * a / np.abs(a).max(), color=ORANGE, linewidth=1.2)


def shared(ax: Axes) -> None:
    """Eight walls in two rows, of which two have fallen."""
    for i, tilt in enumerate((0.0, 0.1, 1.55, 0.0, 0.05, 0.0, 0.12, 1.55)):
        at, low = 5.0 * (i % 4), 6.4 * (1 - i // 4)
        ax.add_patch(Rectangle((at - 1.0, low - 0.3), 5.0, 0.3, facecolor=GROUND))
        corners = np.array([(-0.6, 0.0), (0.0, 0.0), (0.0, 4.0), (-0.6, 4.0)])
        place, colour = np.add(turned(corners, tilt), (at, low)), ORANGE if tilt > 1 else STONE
        ax.add_patch(Polygon(place, facecolor=colour, edgecolor=BLACK, linewidth=LINE))


def ball(ax: Axes) -> None:
    """A ball on the spring and the dashpot of a contact."""
    ground(ax, -3.0, 3.0)
    ax.add_patch(Circle((0.0, 3.4), 1.4, facecolor=STONE, edgecolor=BLACK, linewidth=LINE))
    spring(ax, -0.7, 0.0, 2.2)
    for x, z in (([0.7, 0.7], [0.0, 0.8]), ([0.4, 0.4, 1.0, 1.0], [1.3, 0.8, 0.8, 1.3]), ([0.4, 1.0], [1.1, 1.1])):
        ax.plot(x, z, color=BLUE, linewidth=LINE)
    ax.plot([0.7, 0.7], [1.1, 2.2], color=BLUE, linewidth=LINE)


def church(ax: Axes) -> None:
    """The façade of a church between its side walls, with the plates of two bars."""
    ground(ax, -5.5, 5.5)
    for x in (-4.6, 3.4):
        ax.add_patch(Rectangle((x, 0.0), 1.2, 6.6, facecolor=GROUND, edgecolor="0.5"))
    front(ax, 0.0, (6.8, 7.6, 10.4), rose=1.0)
    for x in (-2.5, 2.5):
        ax.plot(x, 7.0, marker="x", color=BLUE, markersize=12, markeredgewidth=4)


def street(ax: Axes) -> None:
    """Façades in the colours of how likely they lean far."""
    ground(ax, -8.0, 8.0)
    colours = colormaps["YlOrRd"]
    for x, size, share in (
        (-6.0, (3.4, 4.0, 5.2), 0.05),
        (-2.2, (3.4, 6.0, 7.2), 0.6),
        (1.8, (3.8, 4.6, 5.8), 0.3),
        (6.0, (3.4, 7.0, 8.4), 0.9),
    ):
        front(ax, x, size, colours(share))


def in_the_air(bodies: Solids, ax: Axes) -> None:
    """Blocks in space over the whole picture, without a scale bar."""
    draw_solids(ax, bodies, ax.figure.bbox)(0)
    fill_view(ax, bodies, ax.figure.bbox, (0.2, 0.2))
    ax.lines[0].remove()


class Thumbnail(NamedTuple):
    """What a small picture shows, in words, and what draws it, from what its example has found where it runs it."""

    label: str
    draw: Callable[..., object]
    run: bool = False


def found(draw: Callable[[dict[str, Any], Axes], object], label: str) -> Thumbnail:
    """A thumbnail of what the run of an example has left."""
    return Thumbnail(label, draw, run=True)


THUMBNAILS = {
    "01_release": Thumbnail("A wall is held tilted away from its side stop.", released),
    "02_facade_and_its_numbers": Thumbnail("A façade with a gable, a door and a round window is measured.", numbered),
    "03_soft_base": Thumbnail("A wall stands on springs.", sprung),
    "04_two_polarities": Thumbnail("The ground moves one way and opens a wall, and the other way.", mirrored),
    "05_ties_and_thrusts": Thumbnail("A vault pushes a wall outwards, and a tie holds it.", tied),
    "06_friction_damper": Thumbnail("A wall leans away from a floor, and a friction damper slips.", damped),
    "07_push_over": Thumbnail("A horizontal force holds a tilted wall.", pushed),
    "08_records_and_spectra": Thumbnail("A wall stands on the ground above the record of an earthquake.", recorded),
    "09_fragility": Thumbnail("Two of eight walls have fallen.", shared),
    "10_column": found(
        lambda of, ax: of["drawing"](of["answers"][0.4])(ax), "A column of drums opens at its joints under a pulse."
    ),
    "11_panel": found(
        lambda of, ax: plotting.mechanism(ax, of["found"][2.4], forces=False),
        "A part of a panel in running bond turns over above a stair.",
    ),
    "12_mortar": found(
        lambda of, ax: plotting.blocks(ax, of["answer"], at=0.5, forces="cracks", magnified=20.0),
        "Joints of a small wall of mortar have cracked under shear.",
    ),
    "13_arch": found(lambda of, ax: of["drawing"](of["answers"][1e9])(ax), "An arch opens at four joints."),
    "14_support_moves": found(
        lambda of, ax: plotting.thrust(ax, of["answer"], at=1.2),
        "An arch with its line of thrust falls as its support moves away.",
    ),
    "15_dome": found(
        lambda of, ax: in_the_air(Solids(of["answer"].moving.at([-1])), ax), "A thin dome falls and its rings open."
    ),
    "16_facade_in_space": found(
        lambda of, ax: in_the_air(Solids(of["answer"].moving.at([-1])), ax),
        "The middle of a façade has fallen, and its corners stand.",
    ),
    "17_heap": found(lambda of, ax: plotting.blocks(ax, of["answer"], at=4.0), "A wall has fallen into a heap."),
    "18_contacts_in_mujoco": Thumbnail("A ball rests on a spring and a dashpot.", ball),
    "19_church_facade": Thumbnail("A church façade stands between its side walls and is held by two bars.", church),
    "20_town": Thumbnail("Façades of a street have the colours of how likely they lean far.", street),
    "21_terrace": found(
        lambda of, ax: in_the_air(Solids(of["answer"].moving.at([-1])), ax),
        "Two façades of a terrace have fallen, and ties hold the one between them.",
    ),
}
"""The small picture of each example."""


def drawn(name: str) -> Figure:
    """The small picture of an example, without axes and words."""
    one, figure = THUMBNAILS[name], Figure(figsize=SIZE, dpi=DPI)
    if not one.run:
        ax = figure.add_axes((0.02, 0.02, 0.96, 0.96))
        one.draw(ax)
    else:
        with contextlib.redirect_stdout(io.StringIO()):
            left = runpy.run_path(str(EXAMPLES / f"{name}.py"))
        space = left["answer"].in_space if "answer" in left else False
        ax = figure.add_axes((0.02, 0.02, 0.96, 0.96), projection="3d" if space else None)
        one.draw(left, ax)
    if ax.name != "3d":
        ax.set_aspect("equal")
        ax.autoscale_view()
    for text in [*ax.texts, *filter(None, [ax.get_legend()])]:
        text.remove()
    ax.axis("off")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Draw all, the quick ones alone with --quick."""
    args = cli.parser(__doc__, "thumbnails").parse_args(argv)
    out = cli.folder(args.out)
    for name, one in tqdm(THUMBNAILS.items(), disable=None, leave=False):
        if not (args.quick and one.run):
            print(plotting.save(drawn(name), out / f"{name}.png"))


if __name__ == "__main__":
    sys.exit(cli.run(main))
