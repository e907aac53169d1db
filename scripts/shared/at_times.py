"""A picture of states of masonry in space, in one scale and from one camera."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox, TransformedBbox

import mjrock as mr
from mjrock.plotting.solids import MARGIN, Solids, draw_solids, fill_view
from mjrock.result.bodies import BodyMotion

WIDTH, LINE = 7.4, 0.15
"""Width of the picture, and height of a line above a panel [inch]."""


class State(NamedTuple):
    """A sample of a response, and the label above it."""

    label: str
    answer: mr.Response
    sample: int


def states(shown: Sequence[State], camera: tuple[float, float], columns: int = 3) -> Figure:
    """States in rows, from a camera at this elevation and azimuth [deg]. Each panel is as high as its blocks need.

    Args:
        shown: the states. Their masonry has the same blocks.
        camera: elevation and azimuth [deg].
        columns: panels in a row.
    """
    poses = np.stack([one.answer.pose[one.sample] for one in shown])
    bodies = Solids(BodyMotion(shown[0].answer.case, np.arange(float(len(shown))), poses), camera)
    wide, high = bodies.extent_seen
    panel = MARGIN[1] + (WIDTH / columns - MARGIN[0]) * high / wide
    row = panel + LINE * (1 + max(1 + one.label.count("\n") for one in shown))
    rows = -(-len(shown) // columns)
    figure = Figure(figsize=(WIDTH, rows * row))
    for i, one in enumerate(shown):
        left, low = i % columns / columns, (rows - 1 - i // columns) / rows
        place = Bbox.from_bounds(left, low, 1 / columns, panel / row / rows)
        ax, box = figure.add_axes(place.bounds, projection="3d"), TransformedBbox(place, figure.transFigure)
        draw_solids(ax, bodies, box)(i)
        fill_view(ax, bodies, box)
        figure.text(left + 0.5 / columns, place.y1, one.label, fontsize=9, ha="center", va="bottom")
    return figure


def at_times(answer: mr.Response, labels: dict[str, int], camera: tuple[float, float]) -> Figure:
    """Masonry at some samples, each under a label and its time."""
    shown = [State(f"{label},\n$t$ = {answer.t[sample]:.2f} s", answer, sample) for label, sample in labels.items()]
    return states(shown, camera)
