"""Pictures: functions that draw on an Axes and return it, or make a figure of several panels and return that.

An Axes is the first argument, or `ax`, and may be left out: `save(pushover(curves), "curves.png")`. The only package
that imports matplotlib.
"""

from .animation import animate, animate_bodies
from .browser import view
from .earthquakes import fragility, incremental, record, spectra
from .figures import PALETTE
from .histories import acceleration, comparison, displacement, energy, grid, history, rotation, ties
from .masonry import blocks, mechanism, thrust
from .pushing import moment_rotation, push, pushover
from .sketch import sketch
from .style import STYLES, Drawing, panels, save, single
from .tornado import tornado

__all__ = [
    "PALETTE", "STYLES", "Drawing", "acceleration", "animate", "animate_bodies", "blocks", "comparison", "displacement",
    "energy", "fragility", "grid", "history", "incremental", "mechanism", "moment_rotation", "panels", "push",
    "pushover", "record", "rotation", "save", "single", "sketch", "spectra", "thrust", "ties", "tornado", "view",
]  # fmt: skip
