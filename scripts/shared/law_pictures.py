"""Pictures of damping laws and of their calibration."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator
from numpy.typing import ArrayLike

from mjrock.plotting.style import BLUE, GREEN, ORANGE, OWN, figure_of, figure_of_panels, write_title
from scripts.shared.labels import SMALL

SYMBOLS = {
    "R": "$R$",
    "slenderness": "$h/b$",
    "k_base": "$k_{n,b}$",
    "k_side": "$k_{n,s}$",
    "amplitude": r"$\theta_0/\alpha$",
}
"""The parameters of a match in figures."""
SOFTNESS = 1e-4, 0.2
"""Ends of the scale of colours: softness of the base [-]."""
TICKS = (0.1, 0.2, 0.5, 1, 2, 5)
"""Of damping ratios over their mean [-]."""
REQUESTED = "restitution $|e|$ requested [-]"


def damping_curves(
    ax: Axes, families: Sequence[tuple[float, tuple[ArrayLike, ArrayLike], tuple[ArrayLike, ArrayLike]]]
) -> Axes:
    """Matched damping ratios against the restitution asked for, and the fitted curve of each combination.

    Families are (softness of the base, (e, xi) of the matches, (e, xi) of the curve). Colours go by the softness.
    """
    scale = LogNorm(*SOFTNESS)
    for softness, matches, curve in families:
        color = colormaps["viridis"](scale(softness))
        ax.semilogy(*curve, color=color, linewidth=1.2)
        ax.semilogy(*matches, "o", markersize=4, color=color)
    ax.set(xlabel=REQUESTED, ylabel=r"damping ratio $\xi$ [-]")
    ax.locator_params(axis="x", nbins=6)
    colours = ScalarMappable(scale, "viridis")
    figure_of(ax).colorbar(colours, ax=ax).set_label("softness of the base [-]", fontsize=SMALL)
    return ax


def parity(ax: Axes, matched: ArrayLike, predicted: ArrayLike, color: ArrayLike) -> Axes:
    """Predicted against matched damping ratios, on logarithmic axes, coloured by the softness of the base."""
    limits = 0.8 * min(np.min(matched), np.min(predicted)), 1.25 * max(np.max(matched), np.max(predicted))
    ax.loglog(limits, limits, color="0.5", linewidth=0.8)
    ax.scatter(matched, predicted, c=color, s=6, cmap="viridis", norm=LogNorm(*SOFTNESS), linewidth=0)
    factor = np.exp(np.quantile(np.abs(np.log(np.asarray(predicted) / np.asarray(matched))), 0.9))
    ax.text(0.04, 0.96, f"nine of ten within\na factor {factor:.2f}", transform=ax.transAxes, va="top", fontsize=SMALL)
    ax.set(xlim=limits, ylim=limits, aspect="equal")
    ax.set(xlabel=r"matched $\xi$ [-]", ylabel=r"predicted $\xi$ [-]")
    return ax


def residuals(title: str, residual: ArrayLike, variables: Mapping[str, tuple[ArrayLike, str]]) -> Figure:
    """Predicted over matched damping ratio against each variable; a variable is its values and its scale."""
    figure, axes = figure_of_panels(len(variables), min(4, len(variables)), (2.3, 2.3))
    for ax, (name, (values, scale)) in zip(axes.flat, variables.items(), strict=False):
        ax.plot(values, residual, linestyle="", marker="o", markersize=2, markeredgewidth=0, alpha=0.6, color=BLUE)
        ax.axhline(1, color="0.5", linewidth=0.8)
        ax.set(xscale=scale, yscale="log", xlabel=name)
        ax.xaxis.set_minor_formatter(NullFormatter())
    for ax in axes[:, 0]:
        ax.set_ylabel(r"predicted $\xi$ / matched $\xi$ [-]", fontsize=9)
    write_title(figure, title, 10)
    return figure


def sensitivity(ax: Axes, curves: Mapping[str, tuple[ArrayLike, ArrayLike]]) -> Axes:
    """Damping ratio, over its mean, as each parameter goes through its range; a line a parameter."""
    for (name, (shares, ratios)), look, marker in zip(curves.items(), cycle(OWN), "os^vD<>p", strict=False):
        ax.semilogy(shares, ratios, **look | {"label": name, "linewidth": 1.2, "marker": marker, "markersize": 4})
    ax.axhline(1, color="0.6", linewidth=0.6)
    ax.set_yticks(TICKS, [f"{tick:g}" for tick in TICKS])
    ax.yaxis.set_minor_locator(NullLocator())
    ax.set(xlabel="parameter, from least (0) to largest (1)", ylabel=r"$\xi$ over its mean [-]")
    ax.set_ylim(min(TICKS) / 1.3, max(TICKS) * 1.3)
    ax.legend(frameon=False, fontsize=SMALL)
    return ax


def obtained(ax: Axes, samples: Mapping[str, tuple[ArrayLike, ArrayLike]]) -> Axes:
    """Restitution obtained against the one asked for; samples are (asked for, obtained) by law. NaN is not drawn.

    A wall that sticks to its side has none.
    """
    wanted = np.concatenate([requested for requested, _ in samples.values()])
    limits = wanted.min(), wanted.max()
    ax.plot(limits, limits, color="0.5", linewidth=0.8)
    looks = zip("x.s", (ORANGE, BLUE, GREEN), (3, 5, 4), strict=True)
    for (name, row), (marker, color, size) in zip(samples.items(), looks, strict=False):
        ax.plot(*row, linestyle="", marker=marker, markersize=size, color=color, label=name, alpha=0.6)
    found = np.concatenate([row for _, row in samples.values()])
    if np.any(found == 0):
        ax.text(0.5 * sum(limits), 0.02, "0: sticks", fontsize=SMALL, color="0.3")
    ax.set(xlabel=REQUESTED, ylabel="restitution obtained $|e|$ [-]")
    ax.legend(frameon=False, fontsize=SMALL)
    return ax
