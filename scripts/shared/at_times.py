"""A picture of masonry in space at some times."""

from __future__ import annotations

from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting


def at_times(answer: mr.Response, words: dict[str, int], camera: tuple[float, float]) -> Figure:
    """Masonry at some samples, each under a word, from a camera at this elevation and azimuth [deg]."""
    figure = Figure(figsize=(7.4, 6.8 / len(words)), layout="constrained")
    for i, (word, sample) in enumerate(words.items()):
        ax = figure.add_subplot(1, len(words), i + 1, projection="3d")
        plotting.blocks(ax, answer.of_masonry.masonry, answer.pose[sample], camera=camera)
        ax.set_title(f"{word},\n$t$ = {answer.t[sample]:.2f} s", fontsize=9, y=0.95)
    return figure
