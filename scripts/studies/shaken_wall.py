"""A clay brick wall with timber joists on a shake table, US-1 of the SAFEGO project, run by run beside the test.

The wall of Moshfeghi, Smyrou, Arslan and Bal (Structures 66, 106815, 2024) spans 2.58 m between a base and a beam that
move together. It is built by the numbers of the 3DEC deck of its authors (repository yopi1838/Hanze_SAFEGO): 44 courses
of 1.292 x 0.21 m, which are one body each since the wall spans one way, four joists in pockets, mortar of f_t 0.2 MPa
in every joint, and 10.35 kN on the beam. The runs follow each other, and each starts from the damage that the ones
before it have left. Nothing is fitted.

The motions of the table are not part of this repository, as theirs names no licence. `--records` is a folder with files
of its `record_tables_full`, the velocity of the table in a run: `vel_expfull_T9_run21.txt` for HU12, and those of runs
22 to 24 for FR76. A run without a file of its own takes that of run 21, by the published scales. The runs of EC40, of
at most 0.19 g, are left out. Nothing is damped, as in the deck, but by cracks and friction; `--damping` is the ratio
of a damping of all motion. Prints a table and draws it. `--quick` shakes the wall with a short pulse and needs no
records.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from scipy.signal import butter, sosfiltfilt
from scipy.stats import spearmanr
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.figures import BLACK
from mjrock.plotting.style import Look
from mjrock.quantities import Array
from scripts.shared import cli

LENGTH, THICK, HEIGHT, COURSES = 1.292, 0.21, 2.58, 44
"""Wall [m]: along, through, upwards, and its courses."""
POCKETS, DEEP, FAR = ((0.323, 0.4038), (0.8883, 0.969)), 0.105, 1.355
"""Joists along the wall, the face that they reach in it, and their far end [m]."""
LEVELS = ((5, 8), (35, 38))
"""First course of a level of joists, and the first one above it."""
MORTAR = mr.Bond(0.2e6, 0.4e6, 32.0, 320.0)
"""Every joint of the wall and of its pockets, as the deck has it but for its crushing at 20 MPa. That of 9.2 kJ/m2 is
less than joints of 2.5e9 N/m3 hold there, 160 kJ/m2."""
K, FRICTION = 2.5e9, float(np.tan(np.radians(36.9)))
"""k_n = k_s [N/m3] and friction."""
LOAD = 10.35e3
"""On the beam [N]."""
SENSOR = 2.06
"""Height at which the displacement was measured [m]."""
PERIOD, QUIET = 0.092, 0.5
"""Period to which the damping refers, as in the deck, and what follows on each run [s]."""
POINTS, STEP = 4, 2e-3
"""Points of a joint each way, and time between two samples [s]."""
PROFILE = {0.66: 4.68, 1.26: 9.43, SENSOR: 16.37}
"""Displacement of the test at three heights in run 21 [mm]: the largest of each."""
CUT = 25.0
"""Frequency above which the velocities of the table are filtered [Hz]. They are differences of displacements in steps
of 0.1 mm. The Arias intensity of run 21 is then 0.56 m/s, as measured with accelerometers 0.55 m/s."""
STRONG = (0.01, 0.95)
"""Part of each motion that is run, from one share of its Arias intensity to another [-]."""


class Run(NamedTuple):
    """One run: record, scale, peak of the ground [g], peak displacement of the wall and of its twin US-2, and that of
    the authors' models without damping and with 1.5 % [mm]. The models were moved by single pulses of a like
    spectrum."""

    record: str
    scale: float
    ground: float
    test: float
    twin: float
    undamped: float
    damped: float


RUNS = {
    1: Run("HU12", 0.5, 0.063, 0.30, 0.125, 0.445, 0.402),
    2: Run("HU12", 0.75, 0.105, 0.41, 0.40, 1.218, 0.713),
    4: Run("HU12", 1.0, 0.132, 0.67, 0.389, 1.523, 0.948),
    5: Run("HU12", 1.25, 0.157, 0.96, 0.655, 1.79, 1.197),
    7: Run("HU12", 1.5, 0.189, 1.24, 0.952, 2.699, 1.43),
    9: Run("HU12", 1.75, 0.221, 1.41, 1.12, 2.864, 1.769),
    10: Run("HU12", 2.0, 0.243, 2.06, 1.502, 2.012, 2.009),
    12: Run("HU12", 2.25, 0.271, 2.25, 1.573, 2.717, 2.183),
    13: Run("HU12", 2.5, 0.311, 2.57, 1.877, 3.326, 2.282),
    14: Run("HU12", 2.75, 0.351, 3.10, 2.247, 3.656, 2.42),
    15: Run("HU12", 3.0, 0.389, 3.65, 2.541, 12.719, 2.574),
    16: Run("HU12", 3.5, 0.444, 4.77, 3.597, 12.325, 2.826),
    17: Run("HU12", 4.0, 0.478, 5.88, 4.32, 12.714, 3.391),
    18: Run("HU12", 4.5, 0.541, 8.48, 5.338, 14.562, 3.999),
    19: Run("HU12", 5.0, 0.617, 10.74, 6.914, 26.69, 5.206),
    20: Run("HU12", 5.5, 0.692, 13.52, 8.625, 23.982, 10.124),
    21: Run("HU12", 6.0, 0.799, 16.37, 10.441, 32.974, 12.466),
    22: Run("FR76", 1.0, 0.358, 3.64, 2.539, 33.911, 2.818),
    23: Run("FR76", 1.5, 0.505, 13.16, 5.453, 46.749, 3.503),
    24: Run("FR76", 1.75, 0.594, 29.48, 7.826, 9.213, 4.855),
}


def box(low: tuple[float, float, float], high: tuple[float, float, float], **given: object) -> mr.Polyhedron:
    """A box by its lowest and highest corner [m]."""
    a, b = np.array(low), np.array(high)
    return mr.Polyhedron.box(b - a, (a + b) / 2, **given)  # type: ignore[arg-type]


def course(number: int) -> mr.Polyhedron | mr.Compound:
    """A course, with pockets at the levels of the joists."""
    z = (number * HEIGHT / COURSES, (number + 1) * HEIGHT / COURSES)
    name = f"course_{number}"
    if not any(first <= number < end for first, end in LEVELS):
        return box((0.0, 0.0, z[0]), (THICK, LENGTH, z[1]), density=1885.0, name=name)
    edges = [0.0, *np.array(POCKETS).ravel(), LENGTH]
    front = [
        box((DEEP, a, z[0]), (THICK, b, z[1]), density=1885.0) for a, b in zip(edges[::2], edges[1::2], strict=True)
    ]
    return mr.Compound([box((0.0, 0.0, z[0]), (DEEP, LENGTH, z[1]), density=1885.0), *front], name=name)


def wall_of(points: int = POINTS) -> mr.Masonry:
    """The wall between its base and its beam, with its joists on their supports."""
    blocks = [box((0.0, 0.0, -0.1), (THICK, LENGTH, 0.0), fixed=True, name="base"), *map(course, range(COURSES))]
    blocks.append(box((0.0, 0.0, HEIGHT), (THICK, LENGTH, HEIGHT + 0.1), density=7850.0, name="beam"))
    for level, (first, end) in enumerate(LEVELS):
        low, high = first * HEIGHT / COURSES, end * HEIGHT / COURSES
        for i, (a, b) in enumerate(POCKETS):
            name = f"joist_{level}_{i}"
            blocks.append(box((DEEP, a, low), (FAR, b, high), density=5510 * 1.034, name=name))
        blocks.append(box((1.0, 0.0, low - 0.1), (1.5, LENGTH, low), fixed=True, name=f"support_{level}"))

    def at_support(joint: mr.SpaceJoint) -> bool:
        return "support" in joint.name

    return mr.Masonry(
        blocks,
        k_n=lambda joint: 0.1 * K if at_support(joint) else K,
        k_s=lambda joint: 1e4 if at_support(joint) else K,
        friction=lambda joint: float(np.tan(np.radians(1.0))) if at_support(joint) else FRICTION,
        bond=lambda joint: None if at_support(joint) else MORTAR,
        xi=0.0,
        points=points,
    )


def motion_of(folder: Path, run: int) -> mr.GroundMotion:
    """Strong part of the motion of the table in a run, from its own file, or from that of run 21 by its scale.

    Raises:
        FileNotFoundError: for a run of FR76 without a file.
    """
    own = folder / f"vel_expfull_T9_run{run:02d}.txt"
    scale = 1.0
    if not own.exists() and RUNS[run].record == RUNS[21].record:
        own, scale = folder / "vel_expfull_T9_run21.txt", RUNS[run].scale / RUNS[21].scale
    t, velocity = np.loadtxt(own, skiprows=2).T
    step = float(np.diff(t).mean())
    smooth = sosfiltfilt(butter(4, CUT, fs=1 / step, output="sos"), velocity)
    return mr.GroundMotion(scale * strongest(np.gradient(smooth, step)), step)


def strongest(accel: Array) -> Array:
    """The strong part of an acceleration."""
    share = np.cumsum(accel**2) / np.sum(accel**2)
    return accel[slice(*np.searchsorted(share, STRONG))]


class Shaken(NamedTuple):
    """Largest displacement of the wall at the sensor since the run began [m], that of every course then, the period in
    which it rings at the end [s], and the joints that have cracked so far."""

    peak: float
    shape: Array
    period: float
    cracked: int


def period_of(moved: Array, step: float) -> float:
    """Period of the strongest part of a motion [s]."""
    size = 2**16
    spectrum = np.abs(np.fft.rfft((moved - moved.mean()) * np.hanning(len(moved)), size))
    return float(1 / np.fft.rfftfreq(size, step)[1 + int(spectrum[1:].argmax())])


def shaken(masonry: mr.Masonry, motions: Iterable[mr.GroundMotion], damping: float) -> list[Shaken]:
    """The wall under motions that follow each other, with a damping ratio of all motion at `PERIOD`."""
    top = masonry.names.index("beam")
    above = HEIGHT + 0.05
    held = mr.Actuator("beam", (THICK / 2, LENGTH / 2, above), (1.0, 0.0, 0.0), ([0.0], [0.0]), 1e9)
    load = mr.Load(LOAD, at=(THICK / 2, LENGTH / 2, HEIGHT + 0.1), block=top)
    courses = [masonry.free.index(masonry.names.index(f"course_{i}")) for i in range(COURSES)]
    middles = (np.arange(COURSES) + 0.5) * HEIGHT / COURSES
    rate, found, start = 4 * np.pi * damping / PERIOD, list[Shaken](), None
    for motion in motions:
        case = mr.MasonryCase(masonry, len(motion.accel) * motion.dt + QUIET, motion=motion, effects=(load, held))
        answer = mr.solve_explicit(case, output_step=STEP, start=start, forces=True, mass_damping=rate)
        assert answer.forces is not None
        start, moved = answer.end, answer.pose[:, courses, 0] - answer.pose[0, courses, 0]
        at = np.array([np.interp(SENSOR, middles, row) for row in moved])
        last = int(np.abs(at).argmax())
        cracked = int((answer.forces.damage[-1] > 0.5).sum())
        found.append(
            Shaken(abs(float(at[last])), moved[last], period_of(at[answer.t > case.duration - QUIET], STEP), cracked)
        )
    return found


def drawn(peaks: dict[int, float]) -> Figure:
    """Peaks by the run, which has that acceleration of the table [mm]."""
    figure = Figure(figsize=(7.4, 4.2), layout="constrained")
    ax = figure.subplots()
    runs = list(peaks)
    grey: Look = {"color": "0.5", "linestyle": ":", "markersize": 4}
    for name, label, style in (
        ("test", "test US-1", {"color": BLACK, "marker": "o", "markersize": 5}),
        (
            "twin",
            "test of its twin US-2",
            {"color": BLACK, "marker": "o", "markerfacecolor": "none", "linestyle": "--"},
        ),
        ("undamped", "3DEC of the authors, undamped", grey | {"marker": "s"}),
        ("damped", "3DEC of the authors, damping ratio 1.5 %", grey | {"marker": "^"}),
    ):
        ax.plot(runs, [getattr(RUNS[run], name) for run in runs], label=label, linewidth=1.0, **style)
    look = plotting.STYLES["explicit"] | {"linestyle": "-", "marker": "D", "markersize": 4}
    ax.plot(runs, list(peaks.values()), **look)
    shown = [run for run in (1, 5, 10, 15, 18, 21, 24) if run in runs] or runs
    ax.set_xticks(shown, [f"{run}\n{RUNS[run].ground:.2f} g" for run in shown])
    ax.set(xlabel="run, and the peak of its motion", ylabel="largest displacement at 2.06 m [mm]", yscale="log")
    if runs[-1] == 24:
        ax.axvspan(20.5, 24.5, color="0.94", zorder=0, linewidth=0)
        ax.text(22.5, 0.15, "model and\ntest part", fontsize=8, ha="center")
    ax.legend(frameon=False, fontsize=8)
    return figure


def judged(found: dict[int, Shaken]) -> str:
    """Ranks of the runs and factors on the test, of the steps, the twin and the models of the authors."""
    runs, lines = list(found), []
    test = np.array([RUNS[run].test for run in runs])
    others = {name: np.array([getattr(RUNS[run], name) for run in runs]) for name in ("twin", "undamped", "damped")}
    for name, values in {"explicit steps": np.array([1e3 * one.peak for one in found.values()]), **others}.items():
        factor = values / test
        rank = spearmanr(values, test).statistic if len(runs) > 1 else 1.0
        within = int((np.abs(np.log(factor)) < np.log(2)).sum())
        mean = np.exp(np.log(factor).mean())
        lines.append(
            f"{name}: ranks {rank:.3f}, mean factor {mean:.2f}, within a factor of two {within} of {len(runs)}"
        )
    return "\n".join(lines)


def main(argv: Sequence[str] | None = None) -> None:
    """Shake the wall, print the table and draw."""
    parser = cli.parser(__doc__, "shaken_wall")
    parser.add_argument("--records", type=Path, default=Path("records"), help="folder with the files")
    parser.add_argument("--damping", type=float, default=0.0, help="damping ratio of all motion at 0.092 s")
    args = parser.parse_args(argv)
    out = cli.folder(args.out)
    runs = list(RUNS)[:1] if args.quick else list(RUNS)
    pulse = np.sin(2 * np.pi * np.arange(0.0, 0.1, 0.005) / 0.1)
    masonry = wall_of(3 if args.quick else POINTS)
    motions = [
        mr.GroundMotion(RUNS[run].scale * pulse, 0.005) if args.quick else motion_of(args.records, run) for run in runs
    ]
    motions_shown = tqdm(motions, desc="runs", disable=None, leave=False)
    found = dict(zip(runs, shaken(masonry, motions_shown, args.damping), strict=True))
    plotting.save(drawn({run: 1e3 * one.peak for run, one in found.items()}), out / "shaken_wall.png")
    header = ["run", "record", "scale", "ground [g]", "test [mm]", "twin US-2", "explicit steps", "over the test"]
    header += ["3DEC, undamped", "3DEC, 1.5 %", "joints cracked", "period [s]"]
    rows: list[list[object]] = []
    for run, one in found.items():
        given, peak = RUNS[run], 1e3 * one.peak
        cells: list[object] = [run, given.record, given.scale, given.ground, given.test, given.twin, f"{peak:.2f}"]
        cells += [f"{peak / given.test:.2f}", given.undamped, given.damped, one.cracked, f"{one.period:.3f}"]
        rows.append(cells)
    cli.report(out / "shaken_wall", cli.table(header, rows) + "\n\n" + judged(found), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
