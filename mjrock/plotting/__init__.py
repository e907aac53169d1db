"""Pictures: functions that draw on an Axes and return it, or make a figure of several panels and return that.

An Axes is the first argument, or `ax`, and may be left out: `save(pushover(curves), "curves.png")`. The only package
that imports matplotlib.
"""

from .accuracy import convergence, peers, work_precision
from .animation import animate, animate_bodies
from .browser import view
from .earthquakes import MODES, distributions, fragility, incremental, mode_legend, overturning_map, pairs, spectra
from .histories import acceleration, comparison, displacement, energy, grid, history, rotation, ties
from .laws import damping_curves, obtained, parity, residuals, sensitivity
from .masonry import blocks
from .mechanism import mechanism
from .pushing import moment_rotation, push, pushover
from .sketch import sketch
from .style import STYLES, Drawing, panels, save, single
from .thrust import thrust
from .tornado import tornado

__all__ = [
    "MODES", "STYLES", "Drawing", "acceleration", "animate", "animate_bodies", "blocks", "comparison", "convergence",
    "damping_curves", "displacement", "distributions", "energy", "fragility", "grid", "history", "incremental",
    "mechanism", "mode_legend", "moment_rotation", "obtained", "overturning_map", "pairs", "panels", "parity",
    "peers", "push", "pushover", "residuals", "rotation", "save", "sensitivity", "single", "sketch", "spectra",
    "thrust", "ties", "tornado", "view", "work_precision",
]  # fmt: skip
