"""A wall in centimetres with y upwards, read as metres and as what it is, and a dented stone as its hull and as parts.

python scripts/studies/your_geometry.py --out docs/figures
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from scripts.shared import cli

FACES: list[tuple[int, ...]] = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
"""Of a box whose corners have z fastest."""
CRADLE = [(0, 0), (1.2, 0), (1.2, 0.6), (0.9, 0.6), (0.6, 0.3), (0.3, 0.6), (0, 0.6)]
"""Outline of a stone with a notch, x, z [m]."""
APART = 0.5
"""How far the centroids of parts are drawn apart, over how far they are [-]."""

Mesh = tuple[Array, list[tuple[int, ...]]]


def wall_in_cm() -> dict[str, Mesh]:
    """Bricks in running bond, with y upwards."""
    size, meshes = np.array([25.0, 6.0, 12.0]), dict[str, Mesh]()
    for course in range(6):
        for brick in range(3):
            low = np.array([25.0 * brick + 12.5 * (course % 2), 6.0 * course, 0.0])
            corners = np.array([low + size * bits for bits in np.ndindex(2, 2, 2)])
            meshes[f"brick_{course}_{brick}"] = corners, FACES
    return meshes


def notched() -> dict[str, Mesh]:
    """The stone with a notch and a post in it."""
    post = [(0.6, 0.3), (0.75, 0.45), (0.75, 1.0), (0.45, 1.0), (0.45, 0.45)]
    meshes: dict[str, Mesh] = {}
    for name, outline in (("cradle", CRADLE), ("post", post)):
        n = len(outline)
        corners = np.array([(x, y, z) for y in (0.0, 0.4) for x, z in outline])
        ends = [tuple(range(n)), tuple(range(2 * n - 1, n - 1, -1))]
        meshes[name] = corners, ends + [(i, n + i, n + (i + 1) % n, (i + 1) % n) for i in range(n)]
    return meshes


def drawn_apart(masonry: mr.Masonry) -> mr.Masonry:
    """The parts of its free blocks as blocks of their own, away from the middle of them all."""
    parts = [part for i in masonry.free for part in getattr(masonry.blocks[i], "parts", (masonry.blocks[i],))]
    centres = np.array([part.centroid for part in parts])
    moves = APART * (centres - centres.mean(axis=0))
    moves[:, 2] -= moves[:, 2].min()
    blocks = [mr.Polyhedron(part.corners + move) for part, move in zip(parts, moves, strict=True)]
    return mr.Masonry([*blocks, *(block for block in masonry.blocks if block.fixed)], k_n=1e9)


def main(argv: Sequence[str] | None = None) -> None:
    """Read, draw and print what is said."""
    out = cli.folder(cli.parser(__doc__, "out/your_geometry").parse_args(argv).out)
    wall, stone = wall_in_cm(), notched()
    lines = []
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        as_it_is = mr.Masonry.from_meshes(wall, ground=True)
    lines += [f"as it is: {each.message}" for each in warned]
    turned = mr.Masonry.from_meshes(wall, ground=True, unit="cm", up="y")
    lines.append(f"in cm, y upwards: {turned}, {len(turned.joints)} joints")
    for convex in (None, "hull", "parts"):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                found = mr.Masonry.from_meshes(stone, ground=True, convex=convex)
            lines.append(f"convex={convex}: {sum(found.blocks[i].mass for i in found.free):.0f} kg")
        except ValueError as error:
            lines.append(f"convex={convex}: {error}")
    shown = {"as it is": as_it_is, 'unit="cm", up="y"': turned, 'convex="parts", drawn apart': drawn_apart(found)}
    figure = Figure(figsize=(7.4, 2.2), layout="constrained")
    for i, (title, each) in enumerate(shown.items(), 1):
        ax = figure.add_subplot(1, 3, i, projection="3d")
        ends = np.concatenate([each.blocks[k].corners for k in each.free])
        room = 0.1 * np.ptp(ends, axis=0).max()
        limits = np.column_stack([ends.min(axis=0) - room, ends.max(axis=0) + room])
        plotting.blocks(ax, each, limits=limits, camera=(22, -60))
        ax.set_title(title, fontsize=9, y=0.9)
    plotting.save(figure, out / "your_geometry.png")
    cli.report(out / "your_geometry", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(cli.run(main))
