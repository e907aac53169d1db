"""Pictures of static curves."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from ..quantities import named
from ..study.loading.push import Push
from ..study.loading.pushover import PushoverCurve
from .arguments import equal_rows, kind, mapping, picture
from .style import OWN, folded

Closed = Mapping[str, tuple[ArrayLike, ArrayLike]]
"""Rotations [rad] and the values of a closed form at them, by the name of its curve."""


@picture(curves=mapping(kind(PushoverCurve)))
def pushover(ax: Axes, curves: Mapping[str, PushoverCurve], closed: Closed | None = None) -> Axes:
    """Multiplier against rotation, a line a curve, with closed forms as points, and where ties yield and break."""
    _drawn(ax, {name: (curve.rotation, curve.multiplier) for name, curve in curves.items()}, closed or {})
    _marked(ax, curves)
    ax.set_ylabel(r"multiplier $\lambda$ [-]")
    return ax


@picture(curves=mapping(kind(PushoverCurve)))
def moment_rotation(ax: Axes, curves: Mapping[str, PushoverCurve], closed: Closed | None = None) -> Axes:
    """Restoring moment against rotation, as in Figure 1(c) of the paper; closed forms [N m] as points.

    The moment of a rigid wall rises at no rotation.
    """
    lines = {}
    for name, curve in curves.items():
        rotation, moment = curve.rotation, curve.moment / 1e3
        if curve.contacts is None:
            rotation, moment = np.append(0.0, rotation), np.append(0.0, moment)
        lines[name] = rotation, moment
    points = {name: (at, np.asarray(values, dtype=float) / 1e3) for name, (at, values) in (closed or {}).items()}
    _drawn(ax, lines, points)
    ax.set_ylabel("restoring moment $M$ [kN m]")
    return ax


@picture(curves=mapping(kind(Push)))
def push(ax: Axes, curves: Mapping[str, Push], closed: Closed | None = None) -> Axes:
    """Force against displacement of slow pushes, a line a push, to and fro too; closed forms [m, N] as points."""
    factor = 1e-3 if all(curve.unit == "N" for curve in curves.values()) else 1.0
    lines = {name: (1e3 * curve.displacement, factor * curve.force) for name, curve in curves.items()}
    points = {
        name: (1e3 * np.asarray(at, dtype=float), factor * np.asarray(values, dtype=float))
        for name, (at, values) in (closed or {}).items()
    }
    _drawn(ax, lines, points)
    ax.set(xlim=(None, None), ylim=(None, None), xlabel="displacement [mm]")
    ax.set_ylabel("force [kN]" if factor < 1 else r"multiplier $\lambda$ [-]")
    return ax


def _marked(ax: Axes, curves: Mapping[str, PushoverCurve]) -> None:
    """A triangle where ties of a curve yield and a cross where they break, those at one rotation with one text.

    Texts of ties that yield stand above their place, and texts of ties that break below.
    """
    for line, curve in zip(list(ax.get_lines()), curves.values(), strict=False):
        kinds = (("yield", "v", (4, 4)), ("break", "x", (4, -10)))
        for (what, marker, beside), reached in zip(kinds, curve.ties, strict=True):
            together: dict[float, list[str]] = {}
            for name, rotation in reached.items():
                together.setdefault(rotation, []).append(name)
            for rotation, names in together.items():
                near = int(np.searchsorted(curve.rotation, rotation))
                at = rotation, float(curve.multiplier[max(near - 2, 0) : near + 1].max())  # before it falls
                ax.plot(*at, marker, color=line.get_color(), markersize=6, zorder=5)
                ax.set_ylim(top=max(ax.get_ylim()[1], 1.08 * at[1]))  # room for the text
                said = f"{named(names)} {what}{'' if len(names) > 1 else 's'}"
                ax.annotate(said, at, beside, textcoords="offset points", fontsize=8, color=line.get_color(), zorder=6)


def _drawn(ax: Axes, lines: Mapping[str, tuple[ArrayLike, ArrayLike]], points: Closed) -> None:
    for (name, (x, y)), style in zip(lines.items(), cycle(OWN), strict=False):
        ax.plot(x, y, label=folded(name), **style)
    for i, (name, at) in enumerate(points.items()):
        x, y = equal_rows(rotation=at[0], values=at[1])
        colour = OWN[list(lines).index(name) % len(OWN)]["color"] if name in lines else "0.4"
        label = "closed forms" if i == 0 else None
        ax.plot(x, y, "o", color=colour, markerfacecolor="white", markersize=4, linestyle="", zorder=4, label=label)
    if ax.get_legend_handles_labels()[1]:
        ax.legend(frameon=False, fontsize=8)
    ax.set(xlim=(0, None), ylim=(0, None), xlabel=r"rotation $\theta$ [rad]")
