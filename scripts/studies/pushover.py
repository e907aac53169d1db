"""Static curves of one wall: moment against rotation on three bases, and the multiplier with each effect.

Draws the paper's Figure 1(c), for a rigid base, corner lines and a bed of many lines, and the push-over curves of the
wall of its Figure 3 with a load, a thrust, ties, an added mass, openings and an inset. Points are closed forms. Prints
the multiplier at which each wall starts to rock, the largest one, and the rotation at which it falls to zero.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.optimize import brentq

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import power_of_ten
from mjrock.problem.wall.effect import Effect
from scripts.shared import cli
from scripts.shared.paper import DENSITY, FIGURE_3, K_N

Values = NDArray[np.float64]
SOFT = 2e7
"""Interface stiffness of Figure 1(c) [N/m3], so soft that the curves are seen apart."""
BED = 128
"""Lines of a bed."""
B, H = 0.3, 2.1
"""Half thickness and half height of the wall [m], which is 1 m long."""
OPENINGS = (mr.Opening(0.5, 1.2, 1.0), mr.Opening(0.3, 2.0, 0.0))
WIDEST = 0.22
"""Largest rotation that is drawn [rad]."""
CASES: dict[str, tuple[mr.Block, tuple[Effect, ...]]] = {
    "wall alone": (FIGURE_3, ()),
    "load": (FIGURE_3, (mr.Load(15e3, 4.2, -0.1),)),
    "thrust": (FIGURE_3, (mr.Thrust(4.0, 1e3),)),
    "tie, elastic": (FIGURE_3, (mr.Tie(3.5, 1.2e4),)),
    "tie that yields": (FIGURE_3, (mr.Tie(3.5, 1e6, slack=0.02, strength=2e3),)),
    "added mass": (FIGURE_3, (mr.AddedMass(600.0, 4.0, 0.2),)),
    "openings": (mr.Block(B, H, 1.0, DENSITY, openings=OPENINGS), ()),
    "inset": (mr.Block(B, H, 1.0, DENSITY, inset=0.05), ()),
}


def main(argv: Sequence[str] | None = None) -> None:
    """Compute the curves, draw them beside the closed forms, and print where they start and end."""
    args = cli.parser(__doc__, "pushover").parse_args(argv)
    out = cli.folder(args.out)
    lines = 16 if args.quick else BED
    plotting.save(plotting.single(lambda ax: bases(ax, lines), (5.6, 3.8)), out / "pushover_bases.png")

    figure = Figure(figsize=(7.4, 4.6), layout="constrained")
    rows: list[list[object]] = []
    cells: list[Sequence[object]] = []
    axes = figure.subplots(2, 4, sharex=True, sharey=True)
    some = dict(list(CASES.items())[:: 4 if args.quick else 1])
    for ax, (name, (block, effects)) in zip(axes.flat[: len(some)], some.items(), strict=True):
        case = mr.Case(block, 0.0, 1.0, effects=effects)
        curves = {
            "rigid": mr.pushover(case),
            "corner lines": mr.pushover(case, contacts(block, K_N, 2)),
            "bed": mr.pushover(case, contacts(block, K_N, lines)),
        }
        last = min(curves["rigid"].end, WIDEST)
        at = np.linspace(0, last, 400)
        expected = multiplier(block, effects, at)
        plotting.pushover(ax, curves, {"rigid": (at[::40], expected[::40])}).set_title(name, fontsize=9)
        ax.legend().remove()
        for text in list(ax.texts):
            text.remove()  # where ties yield, which the title says
        ax.label_outer()
        off = mr.pushover(case, rotations=at).multiplier - expected
        end = falls(block, effects) if curves["rigid"].end < math.inf else math.inf
        lambdas = [f"{expected[0]:.5f}", f"{curves['rigid'].start:.5f}", f"{np.abs(off).max():.1e}"]
        ends = [f"{value:.5f}" for value in (end, *(curve.end for curve in curves.values()))]
        rows.append([name, *lambdas, *ends, *(f"{curve.peak:.5f}" for curve in curves.values())])
        cells += [
            (name, base, f"{theta:.6g}", f"{value:.6g}", f"{moment:.6g}")
            for base, curve in curves.items()
            for theta, value, moment in zip(curve.rotation, curve.multiplier, curve.moment, strict=True)
        ]
        ax.tick_params(labelsize=8)
    axes[0, 0].set(xlim=(0, WIDEST), ylim=(0, 0.22), xticks=(0.0, 0.1, 0.2))
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False, fontsize=9)
    plotting.save(figure, out / "pushover.png")
    header = ["wall", "lambda_0, closed", "rigid", "largest error", "end [rad], closed", "rigid", "corners", "bed"]
    text = cli.table([*header, "peak, rigid", "corners", "bed"], rows)
    cli.report(out / "pushover", text, ["wall", "base", "theta [rad]", "lambda [-]", "moment [N m]"], cells)


def contacts(block: mr.Block, k_n: float, lines: int) -> mr.Contacts:
    """Interfaces without damping, which plays no part here."""
    return mr.Contacts.from_damping(block, k_base=k_n, xi_base=0.0, k_side=k_n, points=lines)


def bases(ax: Axes, lines: int) -> Axes:
    """Figure 1(c): moment against rotation on a rigid base, on corner lines and on a bed."""
    case = mr.Case(FIGURE_3, 0.0, 1.0)
    curves = {
        "rigid": mr.pushover(case),
        "corner lines": mr.pushover(case, contacts(FIGURE_3, SOFT, 2)),
        "bed": mr.pushover(case, contacts(FIGURE_3, SOFT, lines)),
    }
    weight = FIGURE_3.weight
    lifting = weight / (2 * SOFT * B**2)  # theta_u of two lines and theta_1 of a bed are the same
    at = np.concatenate([lifting * np.array([0.25, 0.5, 0.75]), np.linspace(1.2 * lifting, 0.97 * FIGURE_3.alpha, 9)])
    toppling = weight * H * np.sin(at)
    corners = np.where(at < lifting, 2 * SOFT * B**3 * at, weight * B * np.cos(at)) - toppling
    contact = np.sqrt(2 * weight / (SOFT * at))
    bed = np.where(at < lifting, SOFT * (2 * B) ** 3 / 12 * at, weight * (B - contact / 3)) - toppling
    rigid = weight * B * np.cos(at) - toppling
    here = at < curves["bed"].end
    closed = {"rigid": (at, rigid), "corner lines": (at, corners), "bed": (at[here], bed[here])}
    names = {
        name: f"{name}: {curve.moment.max() / 1e3:.1f} kN m, {curve.end:.3f} rad" for name, curve in curves.items()
    }
    drawn = {names[name]: curve for name, curve in curves.items()}
    points = {names[name]: own for name, own in closed.items()}
    plotting.moment_rotation(ax, drawn, points).legend(
        frameon=False, fontsize=8, title="largest moment, rotation at which it falls", title_fontsize=8
    )
    ax.set_title(f"$k_n$ = {power_of_ten(SOFT)} N/m³", fontsize=10)
    return ax


def multiplier(block: mr.Block, effects: Sequence[object], phi: Values) -> Values:
    """The closed form of a rigid wall on its outer toe, from its parts one by one; ties are taken at first loading."""
    b, g = B - block.inset, mr.GRAVITY
    masses = [(4 * B * H * DENSITY, b, H)]
    masses += [(-2 * B * o.width * o.height * DENSITY, b, o.sill + o.height / 2) for o in block.openings]
    masses += [(one.mass, b - one.offset, one.height) for one in effects if isinstance(one, mr.AddedMass)]
    P0, Q0 = sum(m * g * d for m, d, _ in masses), sum(m * g * z for m, _, z in masses)
    P, Q, pull = P0, Q0, np.zeros_like(phi)
    for one in effects:
        if isinstance(one, mr.Load):
            P, Q = P + one.force * (b - one.offset), Q + one.force * one.height
        elif isinstance(one, mr.Thrust):
            P, Q = P - one.force * one.height, Q + one.force * b
        elif isinstance(one, mr.Tie):
            d, z = B + b, one.height
            x, up = one.length + d * (1 - np.cos(phi)) + z * np.sin(phi), d * np.sin(phi) - z * (1 - np.cos(phi))
            length = np.hypot(x, up)
            lever = (x * (d * np.sin(phi) + z * np.cos(phi)) + up * (d * np.cos(phi) - z * np.sin(phi))) / length
            elongation = length - one.length - one.slack
            pull = pull + np.clip(one.stiffness * elongation, 0, one.strength) * lever
    made: Values = (P * np.cos(phi) - Q * np.sin(phi) + pull) / (Q0 * np.cos(phi) + P0 * np.sin(phi))
    return made


def falls(block: mr.Block, effects: Sequence[object]) -> float:
    """The rotation at which the closed form falls to zero [rad]."""
    return float(brentq(lambda phi: float(multiplier(block, effects, np.array([phi]))[0]), 0.02, 0.5 * math.pi))


if __name__ == "__main__":
    sys.exit(cli.run(main))
