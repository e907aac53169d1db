"""Pictures: functions that draw on an Axes and return it, or make a figure of several panels and return that.

An Axes is the first argument, or `ax`, and may be left out: `save(pushover(curves), "curves.png")`. The only package
that imports matplotlib.
"""

from .animation import animate
from .browser import view
from .histories import acceleration, comparison, displacement, energy, grid, history, rotation, ties
from .masonry import blocks, mechanism, thrust
from .picture import panels, single
from .studies import (
    design,
    fragility,
    incremental,
    moment_rotation,
    overturning_map,
    push,
    pushover,
    record,
    spectra,
    thresholds,
    tornado,
)
from .style import PALETTE, STYLES, Drawing, save
from .wall import sketch

__all__ = [
    "PALETTE", "STYLES", "Drawing", "acceleration", "animate", "blocks", "comparison", "design",
    "displacement", "energy", "fragility", "grid", "history", "incremental", "mechanism", "moment_rotation",
    "overturning_map", "panels", "push", "pushover", "record", "rotation", "save", "single", "sketch", "spectra",
    "thresholds", "thrust", "ties", "tornado", "view",
]  # fmt: skip
