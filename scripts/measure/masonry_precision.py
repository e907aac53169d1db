"""What accuracy costs in time for columns of many blocks: errors of rotations against wall time.

Columns of 0.6 x 4.2 m in 2, 4, 8 and 16 equal blocks are shaken by one sine of 2 m/s2 and 0.7 s and followed for 4 s.
The error of the peaks is the largest over the blocks, relative; that of the motion is the largest error of a rotation,
over the peak of its block. Fitted steps are judged by very fine fixed steps and fixed ones by very fine fitted steps,
so that no method is judged by itself; how far these two references lie apart is printed, and nothing below it can be
told. Times are those of `simulate`, the least of several interleaved repetitions in one process. Also printed: how many
times longer fixed steps take for the same error, how the time of a step grows with the contacts, and what an arch at
rest costs and how far it drifts. Writes masonry_precision.csv, masonry_precision.png and masonry_precision.txt.
"""

from __future__ import annotations

import math
import sys
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.engine.loop import fixed_loop
from mjrock.engine.mjcf import pair_rows
from mjrock.engine.model import engine_of
from mjrock.engine.setting import Setting
from mjrock.engine.sliding import Sliding
from mjrock.geometry.frames import frames_of
from mjrock.quantities import Array
from mjrock.scene.masonry import masonry_course
from scripts.shared import accuracy, cli

WIDTH, HEIGHT = 0.6, 4.2
"""Size of a column [m]."""
K_N, XI = 5e8, 0.049
"""Stiffness of the joints [N/m3], and their damping ratio on the rocking of what stands on them [-]."""
OMEGA = 100.0
"""Frequency that the damping ratios of all joints are converted to [rad/s]. It makes no difference."""
PULSE = mr.GroundMotion.sine(2.0, 0.7)
SAMPLE = 1e-3
"""Spacing of the samples that are compared [s]."""
PATIENCE = 2.0
"""Wall time after which a run is not repeated again [s]."""
TARGETS = {2: 10.0, 4: 10.0, 8: 4.0}
"""How many times longer fixed steps are to take than fitted ones of equal error, by the number of blocks."""


@dataclass(frozen=True)
class Study:
    """What is run: numbers of blocks, duration [s], accuracies, fixed steps [s], the references, and repetitions."""

    counts: Sequence[int] = (2, 4, 8, 16)
    duration: float = 4.0
    accuracies: Sequence[float] = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5)
    timesteps: Sequence[float] = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5)
    finest_accuracy: float = 1e-6
    finest_timestep: float = 5e-6
    repeats: int = 3
    arch: float = 60.0


QUICK = Study((2, 4), 1.0, (1e-2, 1e-3), (1e-3, 2e-4), 1e-5, 5e-5, 1, 2.0)


@dataclass(frozen=True)
class Motion:
    """Rotations of the blocks [rad]: their peaks, shape (n,), and samples, shape (samples, n)."""

    peaks: Array
    theta: Array

    def errors(self, exact: Motion) -> tuple[float, float]:
        """Relative error of the worst peak, and largest error of a rotation over its peak."""
        worst = np.abs(self.theta - exact.theta).max(axis=0) / exact.peaks
        return float(np.abs(self.peaks / exact.peaks - 1).max()), float(worst.max())


@dataclass(frozen=True)
class Point:
    """One setting of one method: steps, least wall time and time of the steps alone [s], and errors [-]."""

    blocks: int
    fitted: bool
    setting: float
    steps: int
    seconds: float
    stepping: float
    peak: float
    path: float

    @property
    def method(self) -> str:
        """What the picture and the table call it."""
        return "fitted steps" if self.fitted else "fixed steps"


def column(count: int) -> mr.Masonry:
    """A column of equal blocks on the ground."""

    def xi(joint: mr.Joint) -> float:
        above = HEIGHT - joint.middle[1]
        mass = 2000.0 * WIDTH * above
        inertia = mass * (WIDTH**2 + 4 * above**2) / 12
        return XI * OMEGA / math.sqrt(2 * K_N * (WIDTH / 2) ** 3 / inertia)

    def block(low: float, high: float, half: float, fixed: bool = False) -> mr.Polygon:
        return mr.Polygon([(-half, low), (half, low), (half, high), (-half, high)], fixed=fixed)

    edges = np.linspace(0, HEIGHT, count + 1).tolist()
    blocks = [block(low, high, WIDTH / 2) for low, high in pairwise(edges)]
    return mr.Masonry((block(-1.0, 0.0, 3.0, fixed=True), *blocks), k_n=K_N, friction=0.7, xi=xi, frequency=OMEGA)


def run(case: mr.MasonryCase, fitted: bool, setting: float) -> mr.MasonryResponse:
    """`simulate` with an accuracy or a fixed step."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # long fixed steps do not resolve the contacts
        if fitted:
            return mr.simulate(case, accuracy=setting, output_step=SAMPLE)
        return mr.simulate(case, timestep=setting, output_step=SAMPLE)


def motion_of(answer: mr.MasonryResponse) -> Motion:
    """The rotations of an answer."""
    return Motion(answer.peak, answer.theta)


def finely(case: mr.MasonryCase, timestep: float) -> Motion:
    """Fixed steps so short that not all of them are kept."""
    scene, every, done, ended = mr.masonry_scene(case), round(SAMPLE / timestep), 0, False
    course = masonry_course(case, scene)
    setting = Setting.of_run(scene, course)
    peaks, samples = np.zeros(len(scene.bodies.names)), []
    with engine_of(scene) as engine:
        engine.set_step(timestep, pair_rows(scene, timestep, 0.25))
        engine.release(course)
        sliding, frames = Sliding.at_start(setting.points, coulomb=False), frames_of(engine.memory.pose)
        while not ended:
            ended, n = fixed_loop(engine.memory, setting, sliding, frames, engine.room, done)
            theta = engine.room.pose[:n, 2::3]
            peaks = np.maximum(peaks, np.abs(theta).max(axis=0))
            samples.append(theta[-done % every :: every].copy())
            done += n
    return Motion(peaks, np.concatenate(samples))


def measured(study: Study, count: int, bar: tqdm) -> tuple[list[Point], tuple[float, float]]:
    """The points of one column, and how far its two references lie apart."""
    case = mr.MasonryCase(column(count), study.duration, PULSE)
    settings = [(True, one) for one in study.accuracies] + [(False, one) for one in study.timesteps]
    found: dict[tuple[bool, float], list[tuple[float, float]]] = {one: [] for one in settings}
    motions, steps = {}, {}
    run(case, True, study.accuracies[0])  # compiles
    for _ in range(study.repeats):
        for one in settings:
            if sum(seconds for seconds, _ in found[one]) < PATIENCE:
                answer = run(case, *one)
                found[one].append((answer.stats["wall_time"], answer.stats["stepping_time"]))
                motions[one], steps[one] = motion_of(answer), answer.stats["steps"]
        bar.update()
    fine = {True: finely(case, study.finest_timestep), False: motion_of(run(case, True, study.finest_accuracy))}
    bar.update()
    points = []
    for fitted, setting in settings:
        seconds, stepping = np.min(found[fitted, setting], axis=0).tolist()
        errors = motions[fitted, setting].errors(fine[fitted])
        points.append(Point(count, fitted, setting, steps[fitted, setting], seconds, stepping, *errors))
    return points, fine[True].errors(fine[False])


def seconds_for(points: Sequence[Point], error: float, of: str) -> float:
    """Wall time of a method for an error [s], by log-log interpolation, infinite where no run is as good.

    A setting is worth no more than the worst of the finer ones, so that no error counts that is small by luck.
    """
    finest_first = sorted(points, key=lambda one: one.setting)
    worth = np.maximum.accumulate([getattr(one, of) for one in finest_first])
    if error < worth[0]:
        return math.inf
    return float(np.exp(np.interp(math.log(error), np.log(worth), np.log([one.seconds for one in finest_first]))))


def ratios(points: Sequence[Point], scatter: tuple[float, float]) -> Iterator[list[str]]:
    """For each accuracy of fitted steps, how many times longer fixed steps of the same error take."""
    fitted, fixed = ([one for one in points if one.fitted is kind] for kind in (True, False))
    for one in sorted(fitted, key=lambda own: -own.setting):
        line = [str(one.blocks), f"{one.setting:g}"]
        for of, least in zip(("peak", "path"), scatter, strict=True):
            worth = max(least, *(getattr(own, of) for own in fitted if own.setting <= one.setting))
            ratio = seconds_for(fixed, worth, of) / one.seconds
            best = max(own.seconds for own in fixed) / one.seconds
            line += [f"{worth:.1e}", f"{ratio:.1f}" if ratio < math.inf else f"> {best:.0f}"]
        yield line


def growth(study: Study) -> Iterator[list[str]]:
    """Time of a step and of a run against the number of contacts, with the exponents between neighbours.

    This is processor time, the least of interleaved repetitions, so that nothing else on the machine counts.
    """
    settings = [(True, accuracy) for accuracy in study.accuracies[:5:2]] + [(False, study.timesteps[1])]
    cases = [mr.MasonryCase(column(count), study.duration, PULSE) for count in study.counts]
    for fitted, setting in settings:
        least, steps = [math.inf] * len(cases), [0] * len(cases)
        for _ in range(study.repeats + 1):
            for i, case in enumerate(cases):
                begun = time.process_time()
                steps[i] = run(case, fitted, setting).stats["steps"]
                least[i] = min(least[i], time.process_time() - begun)
        before: tuple[float, float] | None = None
        for whole, made, count in zip(least, steps, study.counts, strict=True):
            each = whole / made
            name = f"fitted steps, {setting:g}" if fitted else f"fixed steps, {setting * 1e3:g} ms"
            line = [name, str(count), str(2 * count), str(made), f"{each * 1e6:.1f}"]
            grown = ["", ""]
            if before is not None:
                grown = [f"{math.log2(now / then):.2f}" for now, then in zip((each, whole), before, strict=True)]
            yield [*line, f"{whole * 1e3:.0f}", *grown]
            before = (each, whole)


def arch_at_rest(duration: float, repeats: int) -> str:
    """What an arch at rest costs, and how far it drifts."""
    case = mr.MasonryCase(mr.Masonry.arch(5.0, 0.75, voussoirs=16), duration)
    mr.simulate(case)
    answers = [mr.simulate(case) for _ in range(repeats)]
    seconds = min(answer.stats["wall_time"] for answer in answers)
    pose = answers[-1].pose
    drift = float(np.hypot(*(pose - pose[0])[:, :, :2].T).max())
    return (
        f"an arch of 16 voussoirs at rest for {duration:g} s: {seconds:.2f} s of wall time, "
        f"{answers[-1].stats['steps']} steps, drift {drift * 1e3:.4f} mm"
    )


def report(points: Sequence[Point], scatters: dict[int, tuple[float, float]], study: Study) -> str:
    """The tables."""
    rows = []
    for one in points:
        setting = f"{one.setting:g}" if one.fitted else f"{one.setting * 1e3:g} ms"
        cells = [f"{one.peak:.1e}", f"{one.path:.1e}", f"{one.seconds * 1e3:.1f}", f"{one.stepping * 1e3:.1f}"]
        rows.append([str(one.blocks), one.method, setting, str(one.steps), *cells])
    header = ["blocks", "method", "setting", "steps", "peak error", "motion error", "run [ms]", "steps alone [ms]"]
    text = cli.table(header, rows)
    text += f"\n\nthe references, accuracy {study.finest_accuracy:g} and {study.finest_timestep * 1e3:g} ms, apart\n"
    text += cli.table(
        ["blocks", "peaks", "motion"], [[str(n), *(f"{one:.1e}" for one in both)] for n, both in scatters.items()]
    )
    text += "\n\nhow many times longer fixed steps of the same error take, of the peaks and of the motion\n"
    lines = [line for n in scatters for line in ratios([one for one in points if one.blocks == n], scatters[n])]
    text += cli.table(["blocks", "accuracy", "peak error", "times", "motion error", "times"], lines)
    text += "\nof the peaks, aimed at: " + ", ".join(f"{least:g} with {n} blocks" for n, least in TARGETS.items())
    text += "\n\nhow processor time grows; exponents of the contacts from one column to the next\n"
    header = ["method", "blocks", "contacts", "steps", "a step [us]", "run [ms]", "of a step", "of a run"]
    return text + cli.table(header, list(growth(study)))


def drawn(points: Sequence[Point], scatters: Mapping[int, float]) -> Figure:
    """Errors of peaks against wall time, of the fewest and of the most blocks, not below the scatter of references.

    As in the table, a setting is worth no more than the worst of the finer ones: no error counts that is small by luck.
    """
    shown = []
    for count, fitted in product((min(scatters), max(scatters)), (True, False)):
        worst = scatters[count]
        own = [one for one in points if (one.blocks, one.fitted) == (count, fitted)]
        for one in sorted(own, key=lambda point: point.setting):
            worst = max(worst, one.peak)
            shown.append((f"{count} blocks", one.method, one.seconds, worst))
    mujoco = plotting.STYLES["MuJoCo"]
    looks = {"fitted steps": mujoco | {"label": "MuJoCo, fitted steps"}}
    looks["fixed steps"] = mujoco | {"label": "MuJoCo, fixed steps", "linestyle": "--", "linewidth": 1.0}
    return accuracy.work_precision(shown, looks, "largest error of a peak rotation [-]")


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, draw and print."""
    args = cli.parser(__doc__, "masonry_precision").parse_args(argv)
    out, study = cli.folder(args.out), QUICK if args.quick else Study()
    points: list[Point] = []
    scatters = {}
    with tqdm(total=(study.repeats + 1) * len(study.counts), disable=None, leave=False) as bar:
        for count in study.counts:
            found, scatters[count] = measured(study, count, bar)
            points += found
    header = ["blocks", "method", "setting [- or s]", "steps [-]", "run [s]", "stepping [s]", "peak [-]", "motion [-]"]
    rows = [(p.blocks, p.method, p.setting, p.steps, p.seconds, p.stepping, p.peak, p.path) for p in points]
    plotting.save(drawn(points, {count: own[0] for count, own in scatters.items()}), out / "masonry_precision.png")
    text = report(points, scatters, study) + "\n\n" + arch_at_rest(study.arch, study.repeats)
    cli.report(out / "masonry_precision", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
