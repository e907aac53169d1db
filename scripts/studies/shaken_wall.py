"""A clay brick wall with timber joists on a shake table, US-1 of the SAFEGO project, run by run beside the test.

The wall of Moshfeghi, Smyrou, Arslan and Bal (Structures 66, 106815, 2024) spans 2.58 m between a base and a beam that
move together. It is built by the numbers of the 3DEC deck of its authors (repository yopi1838/Hanze_SAFEGO): 44 courses
of 1.292 x 0.21 m, which are rigid since the wall spans one way, four joists in pockets, mortar of f_t 0.2 MPa
in every joint, and 10.35 kN on the beam. All 24 runs follow each other, and each starts from the damage that the ones
before it have left. Nothing is fitted. The wall is run undamped but for cracks and friction, as the deck has it, and
with the damping of a law in joints that have cracked. Pairs of courses are one body, on joints as stiff as theirs
together. After `SHARED` runs each sequence has several starts, whose motions differ by a millionth.

The motions of the table are not part of this repository, as theirs names no licence. `--motions` is a folder with files
of its `record_tables_full`, the velocity of the table in a run. Needed are `vel_expfull_T9_run21.txt` for HU12,
`run11.txt` for EC40, and those of runs 22 to 24 for FR76. A run without a file of its own takes that of its record, by
the peak velocities that accelerometers measured in both; run 10 taken so has the response spectrum of its own file
within 11 %. Prints a table and draws it. `--quick` shakes the wall with a short pulse and needs no records.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from scipy.signal import butter, sosfiltfilt
from scipy.stats import spearmanr
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLACK, Look
from mjrock.quantities import Array
from mjrock.result.response import End
from scripts.shared import cli
from scripts.shared.labels import SMALL

LENGTH, THICK, HEIGHT, COURSES = 1.292, 0.21, 2.58, 44
"""Wall [m]: along, through, upwards, and its courses."""
POCKETS, DEEP, FAR = ((0.323, 0.4038), (0.8883, 0.969)), 0.105, 1.355
"""Joists along the wall, the face that they reach in it, and their far end [m]."""
LEVELS = ((5, 8), (35, 38))
"""First course of a level of joists, and the first one above it."""
PAIRS = (0, 1, 3, 5, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30, 32, 34, 35, 38, 40, 42, 44)
"""Courses at which the wall is divided, since the dashpots of a law make the steps of single courses too short."""
MORTAR = mr.Bond(0.2e6, 0.4e6, 32.0, 320.0, damped=False)
"""Every joint of the wall and of its pockets, as the deck has it but for its crushing at 20 MPa. That of 9.2 kJ/m2 is
less than joints of 2.5e9 N/m3 hold there, 160 kJ/m2. A law damps what has cracked, and nothing before."""
DENSITY = 1885.0
"""Of the wall [kg/m3]."""
K, FRICTION = 2.5e9, float(np.tan(np.radians(36.9)))
"""k_n = k_s [N/m3] and friction."""
LOAD = 10.35e3
"""On the beam [N]."""
HEIGHTS = (0.66, 1.26, 2.06)
"""Heights at which the displacement was measured [m]."""
SENSOR = HEIGHTS[-1]
"""The highest of them [m]."""
PERIOD, QUIET = 0.092, 0.5
"""Period to which a damping of all motion refers, as in the deck, and what follows on each run [s]."""
SHARED, STARTS, STRONGER = 12, 2, 1e-6
"""Runs that all starts share, in which the wall is nearly whole, starts, and by how much the motions of two differ
after them [-]."""
POINTS, STEP = 4, 2e-3
"""Points of a joint each way, and time between two samples [s]."""
CUT = 25.0
"""Frequency above which the velocities of the table are filtered [Hz]. They are differences of displacements in steps
of 0.1 mm. The Arias intensity of run 21 is then 0.56 m/s, as measured with accelerometers 0.55 m/s."""
STRONG = (0.01, 0.95)
"""Part of each motion that is run, from one share of its Arias intensity to another [-]."""


class Beside(NamedTuple):
    """Largest displacement at 2.06 m [mm], and tilt at the end since before the first run [0.001 degrees]."""

    peak: float
    tilt: float


class Run(NamedTuple):
    """One run: record, scale, peak acceleration [g] and velocity [m/s] of the table by accelerometers, largest
    displacement at `HEIGHTS` [mm], tilt at its end since before the first run [0.001 degrees], period [s], and the same
    of the twin US-2 and of the undamped model of the authors under the records."""

    record: str
    scale: float
    ground: float
    speed: float
    peaks: tuple[float, float, float]
    tilt: float
    period: float
    twin: Beside
    model: Beside

    @property
    def test(self) -> float:
        """Largest displacement at 2.06 m [mm]."""
        return self.peaks[-1]


RUNS = {
    1: Run("HU12", 0.5, 0.063, 0.0193, (0.19, 0.31, 0.30), -4.6, 0.092, Beside(0.11, -2.4), Beside(0.38, 0.0)),
    2: Run("HU12", 0.75, 0.104, 0.0256, (0.02, 0.27, 0.41), -7.2, 0.092, Beside(0.39, -5.1), Beside(0.63, -0.1)),
    3: Run("EC40", 0.2, 0.086, 0.0641, (0.03, 0.04, 0.14), -7.2, 0.093, Beside(0.07, -6.3), Beside(0.71, 0.1)),
    4: Run("HU12", 1.0, 0.132, 0.0338, (0.11, 0.18, 0.67), -6.3, 0.094, Beside(0.34, -5.2), Beside(1.16, -0.2)),
    5: Run("HU12", 1.25, 0.157, 0.0399, (0.19, 0.35, 0.96), -7.1, 0.094, Beside(0.50, -6.3), Beside(1.72, 0.0)),
    6: Run("EC40", 0.3, 0.110, 0.0959, (0.03, 0.17, 0.48), -8.6, 0.093, Beside(0.33, -6.4), Beside(2.82, -1.4)),
    7: Run("HU12", 1.5, 0.189, 0.0472, (0.20, 0.57, 1.24), -7.3, 0.095, Beside(0.85, -6.3), Beside(2.82, -1.1)),
    8: Run("EC40", 0.4, 0.145, 0.1277, (0.11, 0.29, 0.87), -10.8, 0.096, Beside(0.65, -6.3), Beside(2.21, -1.5)),
    9: Run("HU12", 1.75, 0.221, 0.0545, (0.29, 0.86, 1.42), -7.4, 0.096, Beside(1.05, -6.4), Beside(2.78, -0.1)),
    10: Run("HU12", 2.0, 0.243, 0.0604, (0.38, 1.07, 2.06), -10.8, 0.097, Beside(1.36, -6.3), Beside(2.28, -1.5)),
    11: Run("EC40", 0.5, 0.192, 0.1592, (0.19, 0.53, 0.92), -10.9, 0.097, Beside(0.95, -9.8), Beside(2.63, -1.8)),
    12: Run("HU12", 2.25, 0.271, 0.0696, (0.39, 1.25, 2.25), -11.4, 0.101, Beside(1.60, -10.5), Beside(2.35, -1.7)),
    13: Run("HU12", 2.5, 0.311, 0.0755, (0.39, 1.43, 2.57), -11.9, 0.101, Beside(1.93, -13.3), Beside(2.28, -0.7)),
    14: Run("HU12", 2.75, 0.351, 0.0829, (0.55, 1.71, 3.10), -11.9, 0.101, Beside(2.20, -14.1), Beside(2.75, -1.4)),
    15: Run("HU12", 3.0, 0.389, 0.0896, (0.66, 1.99, 3.65), -11.8, 0.101, Beside(2.53, -14.0), Beside(2.90, -1.7)),
    16: Run("HU12", 3.5, 0.444, 0.1031, (0.69, 2.41, 4.77), -12.6, 0.099, Beside(3.47, -14.7), Beside(3.55, -2.2)),
    17: Run("HU12", 4.0, 0.478, 0.1182, (1.59, 3.50, 5.88), -13.8, 0.097, Beside(4.14, -15.3), Beside(4.12, -3.6)),
    18: Run("HU12", 4.5, 0.541, 0.1352, (2.27, 4.96, 8.48), -20.7, 0.102, Beside(5.19, -15.3), Beside(4.03, -2.6)),
    19: Run("HU12", 5.0, 0.617, 0.1492, (3.04, 6.26, 10.74), -21.4, 0.104, Beside(6.75, -15.2), Beside(9.32, -0.1)),
    20: Run("HU12", 5.5, 0.692, 0.1622, (3.88, 7.98, 13.52), -27.6, 0.103, Beside(8.34, -15.3), Beside(13.72, 9.0)),
    21: Run("HU12", 6.0, 0.799, 0.1748, (4.68, 9.43, 16.37), -29.7, 0.103, Beside(10.11, -15.4), Beside(16.98, 15.0)),
    22: Run("FR76", 1.0, 0.357, 0.2524, (0.77, 2.17, 3.65), -21.0, 0.104, Beside(2.38, -15.3), Beside(3.73, 20.8)),
    23: Run("FR76", 1.5, 0.505, 0.3671, (3.39, 7.51, 13.15), 8.5, 0.110, Beside(5.26, -6.4), Beside(5.94, 38.1)),
    24: Run("FR76", 1.75, 0.594, 0.4226, (7.61, 16.50, 29.48), 40.3, 0.112, Beside(7.58, -5.5), Beside(8.31, 60.6)),
}
"""Every run of the test, from `exp_Test9_tilt.csv`, `US1_IM_vs_EDP.csv`, `exp_Test9_period_psd.csv`,
`exp_Test12_tilt.csv` and `cumulative_tilt.csv` of the repository. Peaks of the twin and of the model are those of the
chord of the wall below 2.06 m."""
STANDS_IN = {"HU12": 21, "EC40": 11}
"""Run whose file serves those of its record that have none."""


def box(low: tuple[float, float, float], high: tuple[float, float, float], **given: object) -> mr.Polyhedron:
    """A box by its lowest and highest corner [m]."""
    a, b = np.array(low), np.array(high)
    return mr.Polyhedron.box(b - a, (a + b) / 2, **given)  # type: ignore[arg-type]


def part(first: int, end: int) -> mr.Polyhedron | mr.Compound:
    """Courses as one body, with pockets at the levels of the joists."""
    z = (first * HEIGHT / COURSES, end * HEIGHT / COURSES)
    name = f"part_{first}"
    if not any(low <= first < high for low, high in LEVELS):
        return box((0.0, 0.0, z[0]), (THICK, LENGTH, z[1]), density=DENSITY, name=name)
    edges = [0.0, *np.array(POCKETS).ravel(), LENGTH]
    front = [
        box((DEEP, a, z[0]), (THICK, b, z[1]), density=DENSITY) for a, b in zip(edges[::2], edges[1::2], strict=True)
    ]
    return mr.Compound([box((0.0, 0.0, z[0]), (DEEP, LENGTH, z[1]), density=DENSITY), *front], name=name)


class Way(NamedTuple):
    """A way to damp the wall: damping ratio of cracked joints and the frequency that it refers to [rad/s], and damping
    ratio of all motion."""

    xi: float = 0.0
    frequency: float = 1.0
    motion: float = 0.0


def of_law(law: str, restitution: float | None = None, points: int = 2) -> Way:
    """What a law says of the wall above a crack at half its height, as one that rocks on it, or with another e."""
    part = mr.Block.from_size(thickness=THICK, height=HEIGHT / 2, length=LENGTH, density=DENSITY)
    own = mr.Restitution.from_geometry(part)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*(outside the range|no damping of this|was fitted for)", UserWarning)
        warnings.filterwarnings("ignore", "xi = ", mr.Implausible)
        e = own if restitution is None else mr.Restitution(restitution, own.side)
        base = mr.Contacts.from_law(part, e, k_base=K, law=law, points=points).base
    return Way(base.xi, base.frequency)


def ways() -> dict[str, Way]:
    """Every way of this study."""
    return {"undamped": Way(), "published law": of_law("PUBLISHED"), "calibrated law": of_law("CALIBRATED")}


def stiffness_of(joint: str, cuts: Sequence[int]) -> float:
    """Stiffness of a joint by its name [N/m3]: that of the joints within the halves of its parts too."""
    sizes = {f"part_{first}": end - first for first, end in pairwise(cuts)}
    below, above = (sizes.get(name, 0) for name in joint.split("|"))
    return K if "joist" in joint else K / (0.5 * (below + above + (below == 0) + (above == 0)))


def wall_of(points: int = POINTS, way: Way | None = None, cuts: Sequence[int] = range(COURSES + 1)) -> mr.Masonry:
    """The wall between its base and its beam, with its joists on their supports."""
    way = way or Way()
    blocks: list[mr.Polyhedron | mr.Compound] = [box((0.0, 0.0, -0.1), (THICK, LENGTH, 0.0), fixed=True, name="base")]
    blocks += [part(first, end) for first, end in pairwise(cuts)]
    blocks.append(box((0.0, 0.0, HEIGHT), (THICK, LENGTH, HEIGHT + 0.1), density=7850.0, name="beam"))
    for level, (first, end) in enumerate(LEVELS):
        low, high = first * HEIGHT / COURSES, end * HEIGHT / COURSES
        for i, (a, b) in enumerate(POCKETS):
            name = f"joist_{level}_{i}"
            blocks.append(box((DEEP, a, low), (FAR, b, high), density=5510 * 1.034, name=name))
        blocks.append(box((1.0, 0.0, low - 0.1), (1.5, LENGTH, low), fixed=True, name=f"support_{level}"))

    def joint_of(joint: mr.SpaceJoint) -> mr.Dry | mr.Mortar:
        if "support" in joint.name:
            return mr.Dry(0.1 * K, float(np.tan(np.radians(1.0))), 0.0, 1e4, 1.0, points)
        stiffness = stiffness_of(joint.name, cuts)
        return mr.Mortar(mr.Dry(stiffness, FRICTION, way.xi, stiffness, way.frequency, points), MORTAR)

    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*frequency", mr.Implausible)
        return mr.Masonry(blocks, joints=joint_of)


def motion_of(folder: Path, run: int) -> mr.GroundMotion:
    """Strong part of the motion of the table in a run, from its own file, or from that which stands in for it by the
    measured peak velocities.

    Raises:
        FileNotFoundError: for a run of FR76 without a file.
    """
    own, given, scale = folder / f"vel_expfull_T9_run{run:02d}.txt", RUNS[run], 1.0
    if not own.exists() and given.record in STANDS_IN:
        other = STANDS_IN[given.record]
        own, scale = folder / f"vel_expfull_T9_run{other:02d}.txt", given.speed / RUNS[other].speed
    t, velocity = np.loadtxt(own, skiprows=2).T
    step = float(np.diff(t).mean())
    smooth = sosfiltfilt(butter(4, CUT, fs=1 / step, output="sos"), velocity)
    return mr.GroundMotion(scale * strongest(np.gradient(smooth, step)), step)


def strongest(accel: Array) -> Array:
    """The strong part of an acceleration."""
    share = np.cumsum(accel**2) / np.sum(accel**2)
    return accel[slice(*np.searchsorted(share, STRONG))]


class Shaken(NamedTuple):
    """Largest displacement of the wall at `HEIGHTS` since the run began [m], the tilt at the end since it stood at rest
    [degrees], the period in which it rings then [s], and the joints that have cracked so far."""

    peaks: Array
    tilt: float
    period: float
    cracked: int


def period_of(moved: Array, step: float) -> float:
    """Period of the strongest part of a motion [s]."""
    size = 2**16
    spectrum = np.abs(np.fft.rfft((moved - moved.mean()) * np.hanning(len(moved)), size))
    return float(1 / np.fft.rfftfreq(size, step)[1 + int(spectrum[1:].argmax())])


class Carried(NamedTuple):
    """What a run starts from: the end of the last one, and where the wall stood at `SENSOR` before the first [m]."""

    end: End | None
    rest: float


def shaken(
    masonry: mr.Masonry, motions: Iterable[mr.GroundMotion], way: Way, carried: Carried | None = None
) -> tuple[list[Shaken], Carried | None]:
    """The wall under motions that follow each other, and what another one would start from."""
    top = masonry.names.index("beam")
    above = HEIGHT + 0.05
    held = mr.Actuator("beam", (THICK / 2, LENGTH / 2, above), (1.0, 0.0, 0.0), ([0.0], [0.0]), 1e9)
    load = mr.Load(LOAD, at=(THICK / 2, LENGTH / 2, HEIGHT + 0.1), block=top)
    parts = [i for i, block in enumerate(masonry.free) if masonry.names[block].startswith("part")]
    middles = [masonry.blocks[masonry.free[i]].centroid[2] for i in parts]
    rate, found = 4 * np.pi * way.motion / PERIOD, list[Shaken]()
    for motion in motions:
        case = mr.MasonryCase(masonry, len(motion.accel) * motion.dt + QUIET, motion=motion, effects=(load, held))
        start = None if carried is None else carried.end
        answer = mr.solve_explicit(case, output_step=STEP, start=start, forces=True, mass_damping=rate)
        assert answer.forces is not None
        at = np.array([np.interp(HEIGHTS, middles, row) for row in answer.pose[:, parts, 0]])
        carried = Carried(answer.end, float(at[0, -1]) if carried is None else carried.rest)
        moved, quiet = at - at[0], answer.t > case.duration - QUIET
        tilt = float(np.degrees(np.arctan((at[quiet, -1].mean() - carried.rest) / SENSOR)))
        cracked, period = int((answer.forces.damage[-1] > 0.5).sum()), period_of(at[quiet, -1], STEP)
        found.append(Shaken(np.abs(moved).max(axis=0), tilt, period, cracked))
    return found, carried


def sequences(way: Way, motions: Sequence[mr.GroundMotion], starts: int, points: int = POINTS) -> list[list[Shaken]]:
    """Every run of every start."""
    masonry = wall_of(points, way, PAIRS)
    with warnings.catch_warnings():  # what lies on the ground after a fall is not looked at
        warnings.filterwarnings("ignore", ".*(lie inside each other|came to lie)", UserWarning)
        shared, carried = shaken(masonry, motions[:SHARED], way)
        later = [[motion.scaled(1 + i * STRONGER) for motion in motions[SHARED:]] for i in range(starts)]
        return [shared + shaken(masonry, each, way, carried)[0] for each in later]


def judged(peaks: Array, runs: Sequence[int]) -> list[str]:
    """Ranks, mean factor on the test and runs within a factor of two by median peaks, over all runs and by record, and
    the starts of FR76 within it; peaks of starts by run [mm], shape (starts, runs)."""
    test, record = np.array([RUNS[run].test for run in runs]), np.array([RUNS[run].record for run in runs])
    factor = np.median(peaks, axis=0) / test
    near, single = np.abs(np.log(factor)) < np.log(2), np.abs(np.log(peaks / test)) < np.log(2)

    def part(name: str) -> str:
        of = record == name
        if not of.any():
            return ""
        return f"{np.exp(np.log(factor[of]).mean()):.2f}; {near[of].sum()} of {of.sum()}"

    rocking = record == "FR76"
    return [
        f"{spearmanr(factor * test, test).statistic:.3f}",
        f"{np.exp(np.log(factor).mean()):.2f}; {near.sum()} of {len(runs)}",
        *map(part, ("HU12", "EC40", "FR76")),
        ", ".join(f"{x:.2f}" for x in factor[rocking]),
        f"{single[:, rocking].sum()} of {single[:, rocking].size}",
    ]


JUDGED = (
    "way",
    "ranks",
    "all: mean factor; within two",
    "HU12",
    "EC40",
    "FR76",
    "factors of runs 22 to 24",
    "their starts within two",
)
"""Heads of `judged`, behind that of the ways."""


def spread(values: Array, form: str = ".2f") -> str:
    """16, 50 and 84 % of values."""
    return ", ".join(f"{x:{form}}" for x in np.percentile(values, [16, 50, 84]))


LONGEST = 0.25
"""Longest period that the figure shows [s]."""


def drawn(found: dict[str, list[list[Shaken]]], runs: Sequence[int]) -> Figure:
    """Peaks, tilts and periods by the run."""
    figure = Figure(figsize=(7.4, 5.4), layout="constrained")
    axes = figure.subplot_mosaic([["peaks", "peaks"], ["tilts", "periods"]], height_ratios=(3, 2))
    peaks, tilts, periods = axes.values()
    looks = [look | {"linestyle": "-"} for look in plotting.style.OWN[: len(found)]]
    for look, (name, starts) in zip(looks, found.items(), strict=False):
        for ax, values in (
            (peaks, [[1e3 * one.peaks[-1] for one in each] for each in starts]),
            (tilts, [[1e3 * one.tilt for one in each] for each in starts]),
            (periods, [[one.period for one in each] for each in starts]),
        ):
            low, middle, high = np.percentile(values, [16, 50, 84], axis=0)
            ax.fill_between(runs, low, high, color=look["color"], alpha=0.2, linewidth=0)
            ax.plot(runs, middle, **look, label=name)
    test: Look = {"color": BLACK, "marker": "o", "markersize": 3, "linewidth": 1.0, "label": "test US-1"}
    twin = {"color": "0.6", "marker": "o", "markersize": 3, "linewidth": 1.0, "label": "its twin US-2"}
    model = {"color": "0.45", "linestyle": ":", "label": "3DEC of the authors, undamped"}
    given = [RUNS[run] for run in runs]
    for look, high, tilt in (
        (test, [one.test for one in given], [one.tilt for one in given]),
        (twin, [one.twin.peak for one in given], [one.twin.tilt for one in given]),
        (model, [one.model.peak for one in given], [one.model.tilt for one in given]),
    ):
        peaks.plot(runs, high, **look)
        tilts.plot(runs, tilt, **look)
    periods.plot(runs, [one.period for one in given], **test)
    peaks.set(ylabel="peak at 2.06 m [mm]", yscale="log", xlabel="run")
    tilts.set(ylabel="tilt after a run\n[0.001 degrees]", xlabel="run")
    periods.set(ylabel="period after a run [s]", xlabel="run", ylim=(0, LONGEST))
    for i, run in enumerate(runs):
        period = max(starts[0][i].period for starts in found.values())
        if period > LONGEST:
            periods.text(run - 1.2, 0.98 * LONGEST, f"{period:.2f} s", ha="right", va="top", fontsize=SMALL)
    slow = [run for run in runs if RUNS[run].record == "FR76"]
    for ax in axes.values():
        ax.axvspan(slow[0] - 0.5, slow[-1] + 0.5, color="0.93", zorder=0)
    peaks.text(slow[0] - 0.3, peaks.get_ylim()[0] * 1.2, "record FR76", fontsize=SMALL, color="0.3")
    plotting.style.below_figure(figure, peaks, ncols=4)
    return figure


def by_run(found: dict[str, list[list[Shaken]]], runs: Sequence[int]) -> tuple[list[str], list[list[object]]]:
    """Head and rows of the table of runs."""
    header = ["run", "record", "ground [g]", "test at 0.66, 1.26, 2.06 m [mm]", "twin US-2", "3DEC"]
    header += [f"{name}: {what}" for name in found for what in ("16, 50, 84 % at 2.06 m", "medians at 0.66, 1.26 m")]
    header += ["tilt, test, twin, 3DEC [0.001 degrees]", *(f"{name}: 16, 50, 84 %" for name in found)]
    header += ["period, test [s]", *(f"{name}: median" for name in found), "joints cracked"]
    rows: list[list[object]] = []
    for i, run in enumerate(runs):
        given, here = RUNS[run], {name: [each[i] for each in starts] for name, starts in found.items()}
        cells: list[object] = [run, f"{given.record} x {given.scale:g}", given.ground]
        cells += [", ".join(f"{x:.2f}" for x in given.peaks), given.twin.peak, given.model.peak]
        for each in here.values():
            peaks = 1e3 * np.array([one.peaks for one in each])
            cells += [spread(peaks[:, -1]), ", ".join(f"{x:.2f}" for x in np.median(peaks[:, :2], axis=0))]
        cells.append(f"{given.tilt:.1f}, {given.twin.tilt:.1f}, {given.model.tilt:.1f}")
        cells += [spread(1e3 * np.array([one.tilt for one in each]), ".1f") for each in here.values()]
        cells += [given.period, *(f"{np.median([one.period for one in each]):.3f}" for each in here.values())]
        rows.append([*cells, ", ".join(f"{np.median([one.cracked for one in each]):.0f}" for each in here.values())])
    return header, rows


def main(argv: Sequence[str] | None = None) -> None:
    """Shake the wall, print the tables and draw."""
    parser = cli.parser(__doc__, "shaken_wall")
    parser.add_argument("--motions", type=Path, default=Path("motions"), help="folder with the files")
    args = parser.parse_args(argv)
    out, runs = cli.folder(args.out), list(RUNS)[:: 21 if args.quick else 1]
    pulse = np.sin(2 * np.pi * np.arange(0.0, 0.1, 0.005) / 0.1)
    motions = [
        mr.GroundMotion(RUNS[run].scale * pulse, 0.005) if args.quick else motion_of(args.motions, run) for run in runs
    ]
    made = {"undamped": Way()} if args.quick else ways()
    starts, points = (1, 3) if args.quick else (STARTS, POINTS)
    found = {
        name: sequences(way, motions, starts, points) for name, way in tqdm(made.items(), disable=None, leave=False)
    }
    reported(out, found, runs)


def reported(out: Path, found: dict[str, list[list[Shaken]]], runs: Sequence[int]) -> None:
    """Print the tables and draw."""
    plotting.save(drawn(found, runs), out / "shaken_wall.png")
    peaks = {
        name: 1e3 * np.array([[one.peaks[-1] for one in each] for each in starts]) for name, starts in found.items()
    }
    peaks |= {
        "twin US-2": np.array([[RUNS[run].twin.peak for run in runs]]),
        "3DEC, undamped": np.array([[RUNS[run].model.peak for run in runs]]),
    }
    text = cli.table(JUDGED, [[name, *judged(values, runs)] for name, values in peaks.items()])
    header, rows = by_run(found, runs)
    cli.report(out / "shaken_wall", f"{text}\n\n{cli.table(header, rows)}", header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
