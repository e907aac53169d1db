"""The paper's Figure 3 in four solvers, and what the shear stiffness of joints does to a column and an arch.

|e| is the restitution of the rebounds of the wall of Figure 3, in rocking theory, and on the calibrated contacts in
SciPy, in MuJoCo and by explicit steps. RMS is that of theta over alpha against SciPy.
k_s, the stiffness of joints along their faces, runs from 0.1 to 100 times k_n beside joints that stick rigidly: a
column of four drums under a sine of 2.5 m/s2 and 0.7 s, and an arch under one of 2 m/s2 and 0.7 s. The displacement is
the largest of a centroid. Errors of the peaks of an arch are printed, of each solver against the finest of the
other, and so is the longest stable step of a wall in running bond for some damping ratios.
Writes four_solvers.csv and .txt, shear_stiffness.csv and .png.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli
from scripts.shared.paper import FIGURE_3, K_N

RATIOS = (0.1, 0.2, 0.4, 1.0, 2.0, 4.0, 10.0, 30.0, 100.0)
"""k_s over k_n [-]."""
DRUM = mr.Block.from_size(thickness=0.8, height=1.0)
STIFF = 2e9
"""k_n of column and arch [N/m3]."""
SINES = {"column of 4 drums": 2.5, "arch of 15 voussoirs": 2.0}
"""Amplitudes of the sine [m/s2]."""
PERIOD, DURATION = 0.7, 1.5
"""Period of the sine, and how long the motion is followed [s]."""
REBOUNDS = 3


def restitutions() -> list[list[object]]:
    """|e| of each solver, two-sided and one-sided."""
    rows: list[list[object]] = []
    e = mr.Restitution.from_geometry(FIGURE_3)
    contacts = mr.Contacts.from_law(FIGURE_3, e, k_base=K_N, k_side=K_N)
    for label, side_stop, duration in (("two-sided", False, 6.0), ("one-sided", True, 3.0)):
        case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, duration, side_stop=side_stop)
        law = mr.solve_compliant(case, contacts)
        answers = {
            "theory": mr.solve_analytical(case, e),
            "SciPy": law,
            "MuJoCo": mr.simulate(case, contacts),
            "explicit": mr.solve_explicit(case, contacts),
        }
        for name, answer in answers.items():
            found = np.append(np.abs(answer.restitution), np.full(REBOUNDS, np.nan))[:REBOUNDS]
            seconds = answer.stats["wall_time"] if "wall_time" in answer.stats else float("nan")
            rms = mr.compare(law, answer).rms
            rows.append([label, name, *(f"{one:.4f}" for one in found), f"{rms:.5f}", f"{seconds:.3f}"])
    return rows


def built(name: str, k_s: float | None) -> mr.Masonry:
    """Column or arch with this shear stiffness [N/m3]."""
    if name.startswith("arch"):
        return mr.Masonry.arch(radius=5.0, thickness=0.75, voussoirs=15, k_n=STIFF, k_s=k_s, friction=0.7)
    return mr.Masonry.stack([DRUM] * 4, k_n=STIFF, k_s=k_s, friction=0.7, xi=0.05)


def farthest(name: str, k_s: float | None) -> tuple[float, float, int]:
    """Largest displacement of a centroid, widest opening [m], and steps."""
    case = mr.MasonryCase(built(name, k_s), DURATION, mr.GroundMotion.sine(SINES[name], PERIOD))
    answer = mr.solve_explicit(case)
    moved = answer.pose - answer.pose[0]
    return float(np.hypot(moved[..., 0], moved[..., 1]).max()), float(answer.opening.max()), answer.stats["steps"]


def of_the_step(quick: bool) -> list[list[object]]:
    """Errors of the peaks of an arch, explicit steps against fine ones of MuJoCo and the other way round."""
    case = mr.MasonryCase(mr.Masonry.arch(5.0, 0.75), 1.0, mr.GroundMotion.sine(2.0, PERIOD))
    steps, goals = ((2e-5, 1e-5), (1e-3, 1e-4)) if quick else ((2e-5, 1e-5, 5e-6, 1e-6), (1e-3, 1e-4, 1e-6))
    explicit = {"default": mr.solve_explicit(case)}
    explicit |= {f"{h:g} s": mr.solve_explicit(case, timestep=h) for h in steps}
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "explicit steps would take", UserWarning)
        engine = {f"accuracy {goal:g}": mr.simulate(case, accuracy=goal) for goal in goals}
    rows: list[list[object]] = []
    for name, own, other in (("explicit", explicit, engine), ("MuJoCo", engine, explicit)):
        exact = list(other.values())[-1].peak
        for setting, answer in own.items():
            worst = float(np.abs(answer.peak / exact - 1).max())
            stats = answer.stats
            rows.append([f"{name}, {setting}", stats["steps"], f"{worst:.1e}", f"{stats['stepping_time']:.3f}"])
    return rows


def of_the_damping() -> list[list[object]]:
    """The longest stable step of a wall in running bond, and how many steps a second takes at the default."""
    rows: list[list[object]] = []
    for xi in (0.001, 0.01, 0.05, 0.2):
        for ratio in (None, 0.4):
            k_s = None if ratio is None else ratio * 1e10
            wall = mr.Masonry.running_bond(1.6, 1.2, (0.4, 0.2), k_n=1e10, k_s=k_s, xi=xi)
            stats = mr.solve_explicit(mr.MasonryCase(wall, 0.001)).stats
            rows.append([xi, "rigid" if ratio is None else ratio, f"{1e6 * stats['stable_timestep']:.1f}"])
    return rows


def drawn(peaks: dict[str, list[tuple[float, float, int]]], ratios: Sequence[float]) -> Figure:
    """Peaks against k_s over k_n, over that of joints that stick rigidly."""
    figure = Figure(figsize=(6.4, 3.6), layout="constrained")
    ax = figure.subplots()
    for (name, found), colour, marker in zip(peaks.items(), plotting.PALETTE, "os", strict=False):
        off = [100 * (one[0] / found[-1][0] - 1) for one in found[:-1]]
        ax.plot(ratios, off, color=colour, marker=marker, label=f"{name}, {SINES[name]:g} m/s² sine")
    ax.axhline(0, color="0.3", linestyle="--", linewidth=0.8, label="joints that stick rigidly")
    ax.set(xscale="log", xlabel="$k_s$ / $k_n$ [-]", ylabel="largest displacement,\noff that of rigid joints [%]")
    ax.legend(frameon=False, fontsize=8)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run the wall in four solvers, and column and arch on springs."""
    args = cli.parser(__doc__, "four_solvers").parse_args(argv)
    out = cli.folder(args.out)
    ratios = RATIOS[2::4] if args.quick else RATIOS
    peaks: dict[str, list[tuple[float, float, int]]] = {}
    with tqdm(total=len(SINES) * (len(ratios) + 1), disable=None, leave=False) as bar:
        for name in SINES:
            peaks[name] = []
            for k_s in (*(ratio * STIFF for ratio in ratios), None):
                peaks[name].append(farthest(name, k_s))
                bar.update()
    rows = restitutions()
    steps_of_arch, steps_of_wall = of_the_step(args.quick), of_the_damping()
    header = ["case", "solver", *(f"|e| {i + 1}" for i in range(REBOUNDS)), "RMS to SciPy", "time [s]"]
    shear = []
    for name, found in peaks.items():
        for ratio, (moved, opened, steps) in zip((*ratios, "rigid"), found, strict=True):
            shear.append([name, ratio, f"{1e3 * moved:.2f}", f"{1e3 * opened:.2f}", steps])
    labels = ["masonry", "k_s / k_n [-]", "displacement [mm]", "opening [mm]", "steps"]
    plotting.save(drawn(peaks, ratios), out / "shear_stiffness.png")
    cli.write_text(out / "shear_stiffness.csv", cli.csv_text(labels, shear))
    tables = [
        cli.table(header, rows),
        cli.table(labels, shear),
        cli.table(["arch under a sine", "steps", "error of peaks", "time [s]"], steps_of_arch),
        cli.table(["xi of 27 blocks", "k_s / k_n [-]", "longest step [us]"], steps_of_wall),
    ]
    cli.report(out / "four_solvers", "\n\n".join(tables), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
