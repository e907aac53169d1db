"""A picture of masonry in space at two times."""

from __future__ import annotations

from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting


def at_two_times(answer: mr.Response, words: dict[str, int], camera: tuple[float, float]) -> Figure:
    """Masonry at two samples, each under a word, from a camera at this elevation and azimuth [deg]."""
    figure = Figure(figsize=(7.4, 3.4), layout="constrained")
    for i, (word, sample) in enumerate(words.items()):
        ax = figure.add_subplot(1, 2, i + 1, projection="3d")
        plotting.blocks(ax, answer.of_masonry.masonry, answer.pose[sample], camera=camera)
        ax.set_title(f"{word}, $t$ = {answer.t[sample]:.2f} s", fontsize=10)
    return figure
