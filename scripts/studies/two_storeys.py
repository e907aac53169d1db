"""A wall of two storeys with openings under an earthquake in its plane, by explicit steps: it stands, and it collapses.

A thousand units of 0.4 m by 0.2 m and half units in running bond, 14 m long and 6.4 m high, with a door, five windows
and lintels that bear on a unit at either side. Beds are dry, k_n = k_s = 2e9 N/m3, mu = 0.6; heads are open by 2 mm.
One synthetic record is scaled to two peaks. Draws the run that falls as a film, and the wall at the end of both.
Prints how many blocks fall, how far blocks have moved, and the time of the processor that set-up and steps take.
Writes two_storeys_falls.mp4, .webm and .webp, and two_storeys.csv, .png and .txt.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli
from scripts.shared.films import films, folder, summary_of

UNIT = (0.4, 0.2)
"""Length and height of a unit [m]; a half unit is half as long."""
THICKNESS = 0.4
K_N, XI, FRICTION = 2e9, 0.02, 0.6
"""Stiffness of joints along and across their faces [N/m3], damping ratio at the lowest frequency, friction [-]."""
SOIL = 0.8
"""Frequency of the soil under the record [Hz]."""
OPEN = 0.002
"""Width of the head joints [m]."""
REACH = 1.3
"""How far the ground goes on at either side, over the length of the wall [-]."""
BEARING = 0.4
"""Length on which a lintel bears at either side [m]."""


@dataclass(frozen=True)
class Opening:
    """An opening in whole half units: left, right, sill and head [m]."""

    left: float
    right: float
    sill: float
    head: float


@dataclass(frozen=True)
class Study:
    """What is run.

    Args:
        length, height: of the wall [m].
        openings: its openings.
        shaken, followed: duration of the record and of the runs [s].
        peaks: largest acceleration of the record in the run that stands and in the one that falls [m/s2].
    """

    length: float
    height: float
    openings: tuple[Opening, ...]
    shaken: float
    followed: float
    peaks: tuple[float, float]


WINDOWS = (Opening(2.0, 3.2, 1.0, 2.2), Opening(10.8, 12.0, 1.0, 2.2))
UPPER = tuple(Opening(left, left + 1.2, 4.0, 5.2) for left in (2.0, 6.4, 10.8))
FULL = Study(14.0, 6.4, (*WINDOWS, Opening(6.4, 7.6, 0.0, 2.2), *UPPER), 3.0, 6.0, (2.5, 16.0))
QUICK = Study(2.8, 1.4, (Opening(1.0, 1.8, 0.4, 0.8),), 1.0, 0.2, (2.5, 16.0))


def free_parts(course: int, study: Study) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    """What of a course is laid in units, and its lintels, from left to right [m]."""
    low, high = course * UNIT[1], (course + 1) * UNIT[1]
    gaps, lintels = [], []
    for one in study.openings:
        if one.sill < high - 1e-9 and one.head > low + 1e-9:
            gaps.append((one.left, one.right))
        elif abs(one.head - low) < 1e-9:
            lintels.append((one.left - BEARING, one.right + BEARING))
    edges = [0.0, *(x for gap in sorted(gaps + lintels) for x in gap), study.length]
    return [(left, right) for left, right in zip(edges[::2], edges[1::2], strict=True) if right > left], lintels


def wall(study: Study, k_n: float = K_N) -> mr.Masonry:
    """The wall on its ground, on joints of a stiffness [N/m3]: units and half units that keep the bond throughout."""

    def block(left: float, right: float, course: int) -> mr.Polygon:
        low, high = course * UNIT[1], (course + 1) * UNIT[1]
        left, right = left + 0.5 * OPEN, right - 0.5 * OPEN
        corners = [(left, low), (right, low), (right, high), (left, high)]
        return mr.Polygon(corners, length=THICKNESS)

    left, right = -REACH * study.length, (1 + REACH) * study.length
    ground = [(left, -0.4), (right, -0.4), (right, 0.0), (left, 0.0)]
    blocks = [mr.Polygon(ground, length=THICKNESS, fixed=True, name="ground")]
    for course in range(round(study.height / UNIT[1])):
        parts, lintels = free_parts(course, study)
        heads = np.arange(UNIT[0] * (0.5 if course % 2 else 1.0), study.length - 1e-9, UNIT[0])
        for left, right in parts:
            inside = heads[(heads > left + 1e-9) & (heads < right - 1e-9)]
            blocks += [block(a, b, course) for a, b in pairwise([left, *inside.tolist(), right])]
        blocks += [block(left, right, course) for left, right in lintels]
    return mr.Masonry(tuple(blocks), k_n=k_n, k_s=k_n, friction=FRICTION, xi=XI)


def run(masonry: mr.Masonry, study: Study, peak: float) -> mr.Response:
    """The wall under the record scaled to a peak [m/s2]."""
    record = mr.GroundMotion.synthetic(peak, study.shaken, seed=1, ground_frequency=SOIL)
    return mr.solve_explicit(mr.MasonryCase(masonry, study.followed, record), output_step=0.01)


def drawn(study: Study, answers: Sequence[mr.Response]) -> Figure:
    """The wall at the end of both runs, one above the other."""
    figure = Figure(figsize=(7.4, 4.2), layout="constrained")
    masonry = answers[0].of_masonry.masonry
    for ax, peak, one in zip(figure.subplots(2, 1), study.peaks, answers, strict=True):
        limits = [(-0.75 * study.length, 2.2 * study.length), (-0.3, 1.05 * study.height)]
        plotting.blocks(ax, masonry, one.pose[-1], joints=False, limits=limits)
        for note in list(ax.texts):
            note.remove()  # how many lie outside, which the caption says
        ax.axis("off")
        fallen = f"{len(one.fallen)} of {len(masonry.free):,} units have fallen"
        ax.set_title(f"peak of {peak:g} m/s², after {one.t[-1]:.1f} s: {fallen}", fontsize=10)
    return figure


def filmed(study: Study, answer: mr.Response, out: Path) -> None:
    """Write the film of the wall and of where its units fall, as large as the frame holds."""
    peak, count = study.peaks[-1], len(answer.of_masonry.masonry.free)
    title = f"{count} units under a record of {peak:g} m/s²"
    limits = [(-0.25 * study.length, 1.75 * study.length), (-1.6, 1.05 * study.height)]

    def draw(path: Path) -> Path:
        return plotting.animate(answer, path, title=title, limits=limits)

    print(summary_of(films(draw, out / "two_storeys_falls", 0.75 * study.followed)))


def main(argv: Sequence[str] | None = None) -> None:
    """Run, draw and print."""
    args = cli.parser(__doc__, "two_storeys").parse_args(argv)
    out = folder(args.out)
    study = QUICK if args.quick else FULL
    masonry, answers, rows = wall(study), [], []
    for peak in study.peaks:
        answer = run(masonry, study, peak)
        moved = np.hypot(*np.moveaxis(answer.pose[-1, :, :2] - answer.pose[0, :, :2], -1, 0))
        answers.append(answer)
        stats = answer.stats
        row = [
            f"{peak:g}",
            len(masonry.free),
            len(masonry.lines.k),
            len(answer.fallen),
            f"{1e3 * np.median(moved):.1f}",
        ]
        row += [f"{1e3 * moved.max():.0f}", stats["steps"], f"{1e6 * stats['timestep']:.1f}"]
        stepping = stats["stepping_processor_time"]
        row += [f"{stepping / study.followed:.3g}", f"{stats['processor_time'] - stepping:.3g}"]
        rows.append(row)
    filmed(study, answers[-1], out)
    plotting.save(drawn(study, answers), out / "two_storeys.png")
    header = ["peak [m/s2]", "units", "lines", "fallen", "moved, median [mm]", "most [mm]", "steps", "step [us]"]
    header += ["s a simulated s", "set-up [s]"]
    cli.report(out / "two_storeys", cli.table(header, rows), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
