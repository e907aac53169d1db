"""Pictures of responses over time."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..result.response import Response
from .style import style_of


def rotation(ax: Axes, responses: Sequence[Response]) -> Axes:
    """Rotation in multiples of alpha against time."""
    for response in responses:
        ax.plot(response.t, response.theta / response.case.wall.alpha, **style_of(response))
    ax.axhline(0, color="0.8", linewidth=0.6, zorder=0)
    ax.set_xlabel("time $t$ [s]")
    ax.set_ylabel(r"rotation $\theta/\alpha$ [-]")
    return ax


def energy(ax: Axes, responses: Sequence[Response]) -> Axes:
    """Energy above the wall at rest against time."""
    for response in responses:
        ax.plot(response.t, response.energy / 1e3, **style_of(response))
    ax.set_ylim(bottom=0)
    ax.set_xlabel("time $t$ [s]")
    ax.set_ylabel("total energy $E$ [kJ]")
    return ax


def comparison(responses: Sequence[Response], title: str = "") -> Figure:
    """Rotation above, energy below, in the manner of the paper's Figure 3."""
    figure = Figure(figsize=(6.3, 5.0), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    rotation(above, responses).set_xlabel("")
    energy(below, responses)
    below.set_xlim(0, max(r.t[-1] for r in responses))
    figure.legend(*above.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    above.set_title(title, fontsize=10)
    return figure


def grid(panels: Sequence[tuple[str, Sequence[Response]]], columns: int = 2, top: float | None = None) -> Figure:
    """Rotation histories of several cases, one panel each, in the manner of the paper's Figure 4.

    `top` cuts the panels off at a rotation in multiples of alpha, to show small rebounds large.
    """
    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(3.4 * columns, 2.2 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    for ax, (title, responses) in zip(axes.flat, panels, strict=False):
        rotation(ax, responses).set_title(title, fontsize=9)
        if top is not None:
            ax.set_ylim(-0.1 * top, top)
    for ax in axes.flat[len(panels) :]:
        ax.set_visible(False)
    for ax in axes[:-1].flat:
        ax.set_xlabel("")
    for ax in axes[:, 1:].flat:
        ax.set_ylabel("")
    axes[0, 0].legend(loc="upper right", frameon=False, fontsize=8)
    return figure
