"""A picture of masonry in space at two times."""

from __future__ import annotations

from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

import mjrock as mr
from mjrock import plotting

ROOM = (0.04, 0.0, 0.93, 1.0)
"""Left, bottom, width and height of the pictures, over the figure [-]: labels of axes in space stand beside them."""
CLOSE = -9.0
"""Space between the vertical axis and its name, over what matplotlib leaves, which is wide beside low masonry [pt]."""


def at_two_times(answer: mr.Response, words: dict[str, int], camera: tuple[float, float]) -> Figure:
    """Masonry at two samples, each under a word, from a camera at this elevation and azimuth [deg]."""
    figure = Figure(figsize=(9.6, 4.0), layout=ConstrainedLayoutEngine(rect=ROOM, wspace=0.08))
    for i, (word, sample) in enumerate(words.items()):
        ax = figure.add_subplot(1, 2, i + 1, projection="3d")
        plotting.blocks(ax, answer.of_masonry.masonry, answer.pose[sample], camera=camera)
        ax.zaxis.labelpad = CLOSE
        ax.set_title(f"{word}, $t$ = {answer.t[sample]:.2f} s", fontsize=9)
    return figure
