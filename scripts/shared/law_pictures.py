"""Pictures of damping laws and of their calibration."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter
from numpy.typing import ArrayLike

from mjrock.plotting.style import titled

ASKED = "restitution asked for $|e|$ [-]"


def damping_curves(
    ax: Axes, families: Sequence[tuple[str, tuple[ArrayLike, ArrayLike], tuple[ArrayLike, ArrayLike]]]
) -> Axes:
    """Matched damping ratios against the restitution asked for, and the fitted curve of each combination.

    Families are (label, (e, xi) of the matches, (e, xi) of the curve).
    """
    for i, ((label, matches, curve), marker) in enumerate(zip(families, "os^vD<>p", strict=False)):
        color = colormaps["viridis"](0.9 * i / max(1, len(families) - 1))
        ax.semilogy(*curve, color=color, linewidth=1.2)
        ax.semilogy(*matches, marker, markersize=4, color=color, label=label)
    ax.set(xlabel=ASKED, ylabel=r"damping ratio $\xi$ [-]")
    ax.locator_params(axis="x", nbins=6)
    ax.set_ylim(bottom=0.1 * ax.get_ylim()[0])  # room for the legend
    ax.legend(frameon=False, fontsize=7, loc="lower left", ncols=2)
    return ax


def parity(ax: Axes, matched: ArrayLike, predicted: ArrayLike, color: ArrayLike) -> Axes:
    """Predicted against matched damping ratios, on logarithmic axes, coloured by the softness of the base."""
    limits = 0.8 * min(np.min(matched), np.min(predicted)), 1.25 * max(np.max(matched), np.max(predicted))
    ax.loglog(limits, limits, color="0.5", linewidth=0.8)
    ax.scatter(matched, predicted, c=np.log10(color), s=6, cmap="viridis", linewidth=0)
    ax.set(xlim=limits, ylim=limits, xlabel=r"matched $\xi$ [-]", ylabel=r"predicted $\xi$ [-]")
    return ax


def residuals(title: str, residual: ArrayLike, variables: Mapping[str, tuple[ArrayLike, str]]) -> Figure:
    """Predicted over matched damping ratio against each variable; a variable is its values and its scale."""
    figure = Figure(figsize=(max(3.5, 2.3 * len(variables)), 2.5), layout="constrained")
    axes = figure.subplots(1, len(variables), sharey=True, squeeze=False)[0]
    for ax, (name, (values, scale)) in zip(axes, variables.items(), strict=True):
        ax.plot(values, residual, linestyle="", marker="o", markersize=2, markeredgewidth=0, alpha=0.6, color="#12406b")
        ax.axhline(1, color="0.5", linewidth=0.8)
        ax.set(xscale=scale, yscale="log", xlabel=name)
        ax.xaxis.set_minor_formatter(NullFormatter())
    axes[0].set_ylabel(r"predicted $\xi$ / matched $\xi$ [-]")
    titled(figure, title, 10)
    return figure


def sensitivity(ax: Axes, curves: Mapping[str, tuple[ArrayLike, ArrayLike]]) -> Axes:
    """Damping ratio, over its mean, as each parameter goes through its range; a line a parameter."""
    for (name, (shares, ratios)), marker in zip(curves.items(), "os^vD<>p", strict=False):
        ax.semilogy(shares, ratios, marker=marker, markersize=4, linewidth=1.2, label=name)
    ax.axhline(1, color="0.6", linewidth=0.6)
    ax.set(xlabel="place in the range of Table 1 [-]", ylabel=r"$\xi$ over its mean [-]")
    ax.legend(frameon=False, fontsize=7)
    return ax


def obtained(ax: Axes, samples: Mapping[str, tuple[ArrayLike, ArrayLike]]) -> Axes:
    """Restitution obtained against the one asked for; samples are (asked for, obtained) by law. NaN is not drawn."""
    wanted = np.concatenate([asked for asked, _ in samples.values()])
    limits = wanted.min(), wanted.max()
    ax.plot(limits, limits, color="0.5", linewidth=0.8)
    looks = zip("x.s", ("#f0a35e", "#12406b", "0.4"), strict=True)
    for (name, row), (marker, color) in zip(samples.items(), looks, strict=False):
        ax.plot(*row, linestyle="", marker=marker, markersize=5, color=color, label=name)
    ax.set(xlabel=ASKED, ylabel="restitution obtained $|e|$ [-]")
    ax.legend(frameon=False, fontsize=8)
    return ax
