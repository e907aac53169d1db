"""The check of a façade in one picture: the wall without and with a tie, its capacity curves, demands and verdicts.

The façade of 0.6 m by 7 m overturns at its base. The tie of 90 kN at 6.2 m holds until its anchors have moved. Both are
checked after NTC 2018 against one spectrum. Writes check_in_one_picture.png and prints the ratios.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLACK, BLUE, GREEN, ORANGE, Look
from mjrock.plotting.wall import section
from scripts.shared import cli

STATE = "SLV"
"""Limit state that is drawn."""
LOOKS = {"as it is": BLACK, "with a tie": BLUE}
"""The two cases, and the colours of their curves."""


def cases() -> dict[str, mr.Case]:
    """The façade without and with the tie."""
    door = mr.Opening(width=1.4, height=2.4)
    wall = mr.Block.from_size(thickness=0.6, height=7.0, length=6.0, density=1800.0, openings=[door])
    tie = mr.Tie(height=6.2, stiffness=20e6, strength=90e3, length=2.0, ultimate=0.25)
    motion = mr.GroundMotion.synthetic(peak=2.0, duration=10.0, seed=1)
    return {
        name: mr.Case(wall, 0.0, 10.0, motion=motion, effects=effects)
        for name, effects in zip(LOOKS, ((), (tie,)), strict=True)
    }


def curve(ax: Axes, name: str, check: mr.MechanismCheck) -> None:
    """A capacity curve with its capacity and its demand in the limit state, and the line of its period."""
    state, colour = check.states[STATE], LOOKS[name]
    stiff = (2 * math.pi / state.period) ** 2
    ax.plot(1e3 * check.d, check.a, color=colour, linewidth=1.8, label=f"capacity curve, {name}")
    held = float(np.interp(state.capacity, check.d, check.a))
    end = 1e3 * max(state.capacity, state.demand)
    ax.plot([0.0, end], [0.0, stiff * end / 1e3], color=colour, linewidth=0.7, linestyle=":")
    ax.plot(1e3 * state.capacity, held, "o", color=colour, markersize=6, zorder=5)
    verdict = GREEN if state.ratio >= 1 else ORANGE
    ax.plot(1e3 * state.demand, stiff * state.demand, "D", color=verdict, markersize=7, zorder=6)


def drawn(checks: dict[str, mr.MechanismCheck]) -> Figure:
    """Both sections with their verdicts, and both curves."""
    figure = Figure(figsize=(7.4, 3.6), layout="constrained")
    *sections, ax = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 3.2))
    for one, (name, case) in zip(sections, cases().items(), strict=True):
        section(one, case)
        ratio = checks[name].states[STATE].ratio
        word, colour = ("holds", GREEN) if ratio >= 1 else ("fails", ORANGE)
        one.set(xlim=(-2.9, 1.3), ylim=(-0.8, 7.8), xticks=[], yticks=[])
        one.axis("off")
        one.text(-0.6, 7.5, name, ha="center", fontsize=10)
        below: Look = {"transform": one.get_xaxis_transform(), "ha": "center", "va": "top"}
        one.text(-0.6, -0.02, word, fontsize=11, color=colour, weight="bold", **below)
        one.text(-0.6, -0.1, f"capacity over\ndemand {ratio:.2f}", fontsize=8, **below)
    for name, check in checks.items():
        curve(ax, name, check)
    breaks = checks["with a tie"].breaking["tie_0"]
    ax.annotate("the tie breaks", (1e3 * breaks, 1.6), (6, 0), textcoords="offset points", fontsize=8)
    ax.plot([], [], "o", color="0.4", label="capacity $d_{SLV}$")
    ax.plot([], [], "D", color=GREEN, label="demand of the spectrum, holds")
    ax.plot([], [], "D", color=ORANGE, label="demand of the spectrum, fails")
    ax.set(xlim=(0, None), ylim=(0, None), xlabel="spectral displacement [mm]", ylabel="spectral acceleration [m/s²]")
    ax.legend(fontsize=8, frameon=False, loc="upper right")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Check, draw and print."""
    args = cli.parser(__doc__, "check_in_one_picture").parse_args(argv)
    out = cli.folder(args.out)
    site = mr.code_spectrum("NTC 2018", ag=2.06, F0=2.45, Tc=0.33, soil="C")
    checks = {name: mr.mechanism_check(case, site) for name, case in cases().items()}
    lines = []
    for name, check in checks.items():
        states = ", ".join(f"{state} {one.ratio:.2f}" for state, one in check.states.items())
        lines.append(f"{name}: capacity over demand by displacements {states}; linear {check.linear_ratio:.2f}")
    plotting.save(drawn(checks), out / "check_in_one_picture.png")
    cli.report(out / "check_in_one_picture", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(cli.run(main))
