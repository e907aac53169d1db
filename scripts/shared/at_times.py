"""A picture of states of masonry in space, in one scale and from one camera."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.solids import Solids


class State(NamedTuple):
    """A sample of a response, and the words above it."""

    words: str
    answer: mr.Response
    sample: int


def states(shown: Sequence[State], camera: tuple[float, float], columns: int = 3) -> Figure:
    """States in rows, from a camera at this elevation and azimuth [deg]."""
    rows, high = -(-len(shown) // columns), 6.6 / columns
    figure = Figure(figsize=(7.4, rows * high), layout="constrained")
    ends = np.array([Solids(one.answer.moving.at([one.sample]), camera).extent() for one in shown])
    limits = np.column_stack([ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)])
    for i, one in enumerate(shown):
        ax = figure.add_subplot(rows, columns, i + 1, projection="3d")
        masonry, pose = one.answer.of_masonry.masonry, one.answer.pose[one.sample]
        plotting.blocks(ax, masonry, pose, camera=camera, limits=limits)
        ax.set_title(one.words, fontsize=9, y=0.95)
    return figure


def at_times(answer: mr.Response, words: dict[str, int], camera: tuple[float, float]) -> Figure:
    """Masonry at some samples, each under a word and its time."""
    shown = [State(f"{word},\n$t$ = {answer.t[sample]:.2f} s", answer, sample) for word, sample in words.items()]
    return states(shown, camera)
