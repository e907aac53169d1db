"""Pictures of the sensitivity of a result to its settings."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes

from ..quantities import require_kind, require_text
from ..study.sensitivity import Sensitivity, setting_text
from .arguments import mapping, picture
from .figures import BLUE, ORANGE
from .style import power_of_ten

SETTINGS = dict.fromkeys(("k_n", "k_s", "k_base", "k_side"), "N/m³") | {"thickness": "m", "height": "m", "length": "m"}
SETTINGS |= {"density": "kg/m³", "thrust": "N", "strength": "N"}
"""Units of settings that have the names of arguments."""


@picture(labels=mapping(require_text, least=0))
def tornado(ax: Axes, found: Sensitivity, labels: Mapping[str, str] | None = None) -> Axes:
    """A bar for each setting, from the lowest to the highest value where it alone changes, the widest on top.

    The bar "together" is the range of all runs. The vertical line is the base. A bar that reaches the dashed line has a
    run in which the wall overturned. Below the name of a setting stand the values that were tried.

    Args:
        ax: where to draw.
        found: the study.
        labels: what settings and the measure are called, such as {"k_n": "stiffness $k_n$"}; others have their names.
    """
    require_kind("found", found, Sensitivity)
    said = {name: name for name in (*found.swings, found.measure)} | dict(labels or {})
    bars = dict(found.swings)
    if any(len(names) > 1 for names in found.changed):
        bars["together"] = found.range
    finite = found.values[np.isfinite(found.values)]
    least, most = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    width = most - least or 0.1 * (abs(most) or 1.0)
    edge = most + 0.12 * width  # where an overturned wall is drawn
    for i, (name, ends) in enumerate(bars.items()):
        low, high = (edge if end == math.inf else end for end in ends)
        colour = "0.75" if name == "together" else ORANGE if name == found.governs else BLUE
        ax.barh(i, high - low, left=low, color=colour, height=0.55)
        for end, x, side, shift in zip(ends, (low, high), ("right", "left"), (-4, 4), strict=True):
            text = found.written(end) if low == high else _apart(found, *ends)[end == ends[1]]
            ax.annotate(text, (x, i), (shift, 0), textcoords="offset points", ha=side, va="center", fontsize=8)
    if math.isfinite(found.base_value):
        ax.axvline(found.base_value, color="0.15", linewidth=1.0)
    if not np.isfinite(found.values).all():
        ax.axvline(edge, color="0.15", linewidth=1.0, linestyle="--")
    ax.set_yticks(range(len(bars)), [f"{said.get(name, name)}\n{_tried(found, name)}".strip() for name in bars])
    ax.invert_yaxis()
    right = 0.12 if np.isfinite(found.values).all() else 0.4  # room for the word at the end of a bar
    ax.set_xlim(least - 0.2 * width, edge + right * width)
    ax.set_xlabel(f"{said[found.measure]}{f' [{found.unit}]' if found.unit else ''}")
    governs = found.governs or ""
    ax.set_title(found.sentence.replace(f"governed by {governs}", f"governed by {said.get(governs)}"), fontsize=10)
    return ax


def _tried(found: Sensitivity, setting: str) -> str:
    """The values of a setting that were tried, with the unit of the settings that have a known one."""
    values = list(dict.fromkeys(row[setting] for row in found.rows)) if setting in found.settings else []
    if len(values) < 2 or not all(isinstance(value, int | float) for value in values):
        return ", ".join(setting_text(value) for value in values)
    return f"{power_of_ten(min(values))} to {power_of_ten(max(values))} {SETTINGS.get(setting, '')}".strip()


def _apart(found: Sensitivity, low: float, high: float) -> tuple[str, str]:
    """Two ends of a bar as text, with the digits that tell them apart."""
    texts = found.written(low), found.written(high)
    digits = 3
    while texts[0] == texts[1] and digits < 9:
        texts, digits = (f"{low:.{digits}g}", f"{high:.{digits}g}"), digits + 1
    return texts
