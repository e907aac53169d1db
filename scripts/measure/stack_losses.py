"""What a stack that rocks as one loses at an impact, over what rocking theory says, for three choices of its joints.

The wall of the paper's Figure 3, cut into equal blocks, is set turning about an edge of its base so that it rises to a
share of alpha. The energy at its second peak over that at the first is compared with the rigid impact (two-sided), and
with e_1s of Eq. 4 (against a side stop). Damping is matched from alpha/2; other rotations and rebounds are not matched.
Friction holds. "Uppermost alone" is the uppermost block on a fixed one. "Opens below" is the largest opening of a joint
below, over that of the uppermost joint, when the uppermost block alone is set rocking on the others. The last line says
how much a loss changes with a tenth of the tolerance on the steps.
"""

from __future__ import annotations

import dataclasses
import sys
import warnings
from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.problem.masonry.rigid_stack import RigidStack
from mjrock.study.matching.matched import SAMPLE_STEP, excess, restitutions
from mjrock.theory.impact import rigid_rocking
from scripts.shared import cli
from scripts.shared.labels import beside
from scripts.shared.paper import FIGURE_3

BLOCKS = (1, 2, 4, 7)
K_N = (1e9, 3e9, 1e10, 1e11)
ROTATIONS = (0.5, 0.16)
"""Rotations over alpha from which the stack falls to the impact [-]."""
HOLDS = 10.0


def stack(blocks: int, k_n: float, side_stop: bool, stiffer: float = 1.0) -> mr.Masonry:
    """The wall in equal blocks on joints damped by the law, those above the base so many times as stiff."""
    block = mr.Block.from_size(2 * FIGURE_3.b, 2 * FIGURE_3.h / blocks, FIGURE_3.length, FIGURE_3.density)
    above = k_n * stiffer
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # few blocks of a stack are not a slender wall
        return mr.Masonry.stack(
            [block] * blocks,
            lambda joint: k_n if joint.below == 0 else above,
            side_stop=side_stop,
            k_side=k_n if side_stop else None,
            friction=HOLDS,
            law=mr.CALIBRATED,
        )


CHOICES: dict[str, Callable[[int, float, bool], mr.Masonry]] = {
    "law, joint by joint": stack,
    "law, joints above n² times as stiff": lambda n, k_n, side: stack(n, k_n, side, n**2),
    "matched_masonry": lambda n, k_n, side: mr.matched_masonry(stack(n, k_n, side)),
}


def lost(made: mr.Masonry, rotation: float = ROTATIONS[0], accuracy: float = 1e-4, impact: int = 1) -> float:
    """Energy that an impact takes after the stack has risen to a rotation, over that of theory [-]."""
    pile = RigidStack.from_masonry(made)
    e, (velocity, swing) = rigid_rocking(pile), pile.rising(rotation)
    case = mr.MasonryCase(made, (impact + 0.75) * swing, velocity=velocity)
    found = restitutions(mr.simulate(case, accuracy=accuracy, output_step=SAMPLE_STEP * swing), pile)
    return 1 + excess(float(found[impact - 1]), abs(e.lumped) if pile.sides else e.base)


def uppermost(made: mr.Masonry) -> mr.Masonry:
    """The uppermost block on a fixed one, with the stiffness and the dashpots that its joint has in a stack."""
    top, number = made.polygons[-1], len(made.joints) - 1
    under = mr.Polygon(top.corners - [0, np.ptp(top.corners[:, 1])], length=top.length, fixed=True)
    k_n, xi = float(made.joint_stiffness[number]), 0.5 * float(made.retardation[number])
    return mr.Masonry((under, dataclasses.replace(top, name="top")), k_n, HOLDS, xi=xi, frequency=1.0)


def opens_below(made: mr.Masonry) -> float:
    """Largest opening of a joint below, over that of the uppermost, when its block alone is set rocking [-]."""
    top = RigidStack.from_masonry(uppermost(made)).rising(ROTATIONS[0])
    velocity = np.zeros((len(made.free), 3))
    velocity[-1] = top[0][0]
    opening = mr.simulate(mr.MasonryCase(made, 1.75 * top[1], velocity=velocity), accuracy=1e-4).opening
    return float(opening[:-1].max(initial=0.0) / opening[-1])


def drawn(found: dict[tuple[str, float, bool], list[list[float]]], stiffnesses: Sequence[float]) -> Figure:
    """Losses of two-sided stacks against stiffness, by the law joint by joint and by joints stiffer above."""
    figure = Figure(figsize=(7.4, 3.4), layout="constrained")
    choices, rotation = list(CHOICES)[:2], ROTATIONS[-1]
    for ax, choice in zip(figure.subplots(1, 2, sharey=True), choices, strict=True):
        for side, dashes in ((False, "-"), (True, ":")):
            curves = list(zip(*found[choice, rotation, side], strict=True))
            for i, (n, curve) in enumerate(zip(BLOCKS[: len(curves)], curves, strict=True)):
                colour = plotting.PALETTE[i % len(plotting.PALETTE)]
                ax.plot(stiffnesses, curve, dashes, color=colour, marker="osD^"[i], markerfacecolor="none")
                if choice == choices[0] and not side:
                    beside(ax, (stiffnesses[0], curve[0]), f"{n} block{'s' * (n > 1)}", colour, (-8, 5))
        ax.set(xscale="log", xlim=(0.3 * stiffnesses[0], 1.5 * stiffnesses[-1]))
        ax.axhline(1, color="0.6", linewidth=0.6)
        ax.set_title(choice, fontsize=9)
        ax.set_xlabel("$k_n$ of the base [N/m³]")
    ax.set_ylim(top=1.52)
    figure.axes[0].set_ylabel("energy lost, over theory [-]")
    figure.axes[1].plot([], [], "-", color="0.3", label="two-sided")
    figure.axes[1].plot([], [], ":", color="0.3", label="with a side stop")
    figure.axes[1].legend(frameon=False, fontsize=8)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, print and draw."""
    args = cli.parser(__doc__, "stack_losses").parse_args(argv)
    out = cli.folder(args.out)
    stiffnesses, blocks = (K_N[:1], BLOCKS[1:2]) if args.quick else (K_N, BLOCKS)
    found: dict[tuple[str, float, bool], list[list[float]]] = {}
    rows: list[list[object]] = []
    changes = []
    for choice, side in tqdm([(c, s) for c in CHOICES for s in (False, True)], disable=None, leave=False):
        stacks = [[CHOICES[choice](n, k_n, side) for n in blocks] for k_n in stiffnesses]
        measured = {f"from {a:g} alpha": [[lost(made, a) for made in line] for line in stacks] for a in ROTATIONS}
        for a, values in zip(ROTATIONS, measured.values(), strict=True):
            found[choice, a, side] = values
        if not side:
            measured["second impact"] = [[lost(made, impact=2) for made in line] for line in stacks]
            measured["uppermost alone"] = [[lost(uppermost(made)) for made in line] for line in stacks]
            measured["opens below"] = [[opens_below(made) for made in line] for line in stacks]
        for name, values in measured.items():
            for k_n, line in zip(stiffnesses, values, strict=True):
                sides = "side stop" if side else "two-sided"
                rows.append([choice, sides, name, f"{k_n:.0e}", *(f"{value:.3f}" for value in line)])
        fine = [[lost(made, accuracy=1e-5) for made in line] for line in stacks]
        changes.append(np.abs(np.subtract(fine, found[choice, ROTATIONS[0], side])).max())
    header = ["joints", "sides", "impact", "k_n [N/m3]", *(f"{n} blocks" for n in blocks)]
    text = cli.table(header, rows) + f"\nlargest change with accuracy 1e-5 for 1e-4: {max(changes):.1e}"
    plotting.save(drawn(found, stiffnesses), out / "stack_losses.png")
    cli.report(out / "stack_losses", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
