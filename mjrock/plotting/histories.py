"""Pictures of responses over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..problem.wall.case import Case
from ..quantities import require_kind
from ..result.response import Outcome, Response
from .style import style_of

BEYOND = 1.2
"""Rotation up to which a wall that overturns is shown, in multiples of alpha [-]."""


def rotation(ax: Axes, responses: Sequence[Response]) -> Axes:
    """Rotation in multiples of alpha against time.

    A wall that overturns is shown up to 1.2 alpha, or to its largest rotation before it has no way back. The picture
    says when that was.
    """
    fallen = [overturned_at(response) for response in responses]
    reached = [0.0]
    for response, end in zip(responses, fallen, strict=True):
        share = response.theta / response.case.wall.alpha
        ax.plot(response.t, share, **style_of(response))
        reached.append(float(np.abs(share[response.t <= (np.inf if end is None else end)]).max()))
    ax.axhline(0, color="0.8", linewidth=0.6, zorder=0)
    ax.set_xlabel("time $t$ [s]")
    ax.set_ylabel(r"rotation $\theta/\alpha$ [-]")
    said = [f"{r.solver}: overturned at t = {t:.3g} s" for r, t in zip(responses, fallen, strict=True) if t is not None]
    if said:
        top = max(BEYOND, 1.05 * max(reached))
        inwards = min(float(response.theta.min() / response.case.wall.alpha) for response in responses)
        ax.set_ylim(max(-top, min(-0.08 * top, 1.08 * inwards)), top)
        text = "\n".join(said) if len(responses) > 1 else said[0].split(": ")[1]
        ax.text(0.02, 0.96, text, transform=ax.transAxes, fontsize=8, va="top")
    return ax


def overturned_at(response: Response) -> float | None:
    """When the wall went beyond the rotation from which it comes back [s], or None if it did not overturn."""
    if response.outcome is not Outcome.OVERTURNED:
        return None
    returns = np.flatnonzero(response.case.returns_from(response.theta))
    return float(response.t[min(returns[-1] + 1, len(response.t) - 1) if returns.size else 0])


def acceleration(ax: Axes, case: Case, until: float) -> Axes:
    """Acceleration of the ground against time [m/s2], horizontal and, where there is one, vertical."""
    for motion, label, color in ((case.motion, "horizontal", "0.25"), (case.vertical, "vertical", "#f0a35e")):
        if motion is not None:
            t = np.append(motion.dt * np.arange(len(motion.accel)), [motion.duration, max(until, motion.duration)])
            ax.plot(t, np.append(motion.accel, [0.0, 0.0]), color=color, linewidth=0.8, label=label)
    if case.vertical is not None:
        ax.legend(frameon=False, fontsize=7, loc="upper right", ncols=2)
    ax.axhline(0, color="0.8", linewidth=0.6, zorder=0)
    ax.set_xlabel("time $t$ [s]")
    ax.set_ylabel("ground [m/s²]")
    return ax


def history(responses: Response | Sequence[Response], title: str = "") -> Figure:
    """Rotation against time of one response, or of several to one case, below the acceleration of the ground."""
    if not isinstance(responses, Sequence):
        require_kind("responses", responses, Response)
    several = [responses] if isinstance(responses, Response) else list(responses)
    for i, response in enumerate(several):
        require_kind(f"responses[{i}]", response, Response)
    if not several:
        raise ValueError("responses is empty; at least one response is needed")
    case, until = several[0].case, max(float(response.t[-1]) for response in several)
    figure = Figure(figsize=(6.3, 4.2 if case.shaken else 3.0), layout="constrained")
    if case.shaken:
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(1, 2))
        acceleration(above, case, until).set_xlabel("")
    else:
        above = below = figure.subplots()
    rotation(below, several)
    below.set_xlim(0, until)
    above.set_title(title, fontsize=10)
    if len(several) > 1:
        figure.legend(*below.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure


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
