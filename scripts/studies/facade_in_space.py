"""A facade with return walls of some hundred blocks under an earthquake of three components, by explicit steps.

The facade is 3.2 m long and 1.6 m high with two windows, its return walls are 1.2 m deep, of units of 0.4 x 0.2 x 0.2 m
in running bond. The joints have k_n = k_s = 1e9 N/m3, mu = 0.6, xi = 0.01 at the lowest frequency, and four points
each. The ground moves by three synthetic motions, along x, y and z; peaks are given in the table.
Prints the horizontal acceleration that the blocks stand by limit analysis outwards, inwards and along the facade, what
the run did and took, and the time of a simulated second against the number of points. Times are those of the processor.
Writes facade_in_space.csv, .png and .txt, the film as .mp4 and .webm, its poster as .webp, and a .gif.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli
from scripts.shared.at_times import at_times
from scripts.shared.films import films, folder, summary_of

LENGTH, HEIGHT, DEPTH, UNIT = 3.2, 1.6, 1.2, (0.4, 0.2)
WINDOWS = tuple((y, mr.Opening(width=0.4, height=0.6, sill=0.6)) for y in (-0.6, 0.6))
JOINTS: dict[str, Any] = {"k_n": 1e9, "k_s": 1e9, "friction": 0.6, "xi": 0.01}
PEAKS = {"motion": 6.0, "transverse": 4.0, "vertical": 3.0}
"""Largest acceleration of the ground along x, y and z [m/s2]."""
DURATION = 7.0
OUTWARDS, ALONG, INWARDS = 0.0, 0.5 * math.pi, math.pi
SIZES = ((0.8, 2), (1.6, 2), (1.6, 3), (2.4, 2))
"""Heights [m] and `points` whose time is measured."""
CAMERA = (20.0, 38.0)
"""Elevation and azimuth of the pictures [deg]."""
SHORT = 0.1
"""Time that is followed to measure it [s]."""


def facade(height: float = HEIGHT, points: int = 2) -> mr.Masonry:
    """The facade, without windows where it is lower or higher."""
    openings = WINDOWS if height == HEIGHT else ()
    return mr.Masonry.facade(LENGTH, height, DEPTH, UNIT, openings=openings, points=points, **JOINTS)


def motions(peaks: dict[str, float], duration: float) -> dict[str, Any]:
    """Three synthetic motions with their largest accelerations [m/s2], as `MasonryCase` takes them."""
    return {
        name: mr.GroundMotion.synthetic(peak=peak, duration=duration, seed=seed)
        for seed, (name, peak) in enumerate(peaks.items(), 1)
    }


def shaken(masonry: mr.Masonry, duration: float) -> mr.Response:
    """The facade under the three motions."""
    return mr.solve_explicit(mr.MasonryCase(masonry, duration, **motions(PEAKS, 6.0)), output_step=0.01)


def cost(height: float, points: int) -> list[object]:
    """Blocks, points, set-up [s], step [us], time of a simulated second [s] and of a point and step [ns]."""
    begun = time.thread_time()
    masonry = facade(height, points)
    count = len(masonry.lines.k)
    answer = shaken(masonry, SHORT)
    took, stats = time.thread_time() - begun, answer.stats
    stepping = stats["stepping_processor_time"]
    each = 1e9 * stepping / stats["steps"] / count
    return [
        len(masonry.free), count, f"{took - stepping:.2g}", f"{1e6 * stats['timestep']:.3g}",
        f"{stepping / SHORT:.2g}", f"{each:.0f}",
    ]  # fmt: skip


def moment_of(answer: mr.Response) -> int:
    """The sample at which the first block falls, or the last one."""
    first = next(iter(answer.fallen.values()), math.inf)
    return min(int(np.searchsorted(answer.t, first)), len(answer.t) - 1)


def main(argv: Sequence[str] | None = None) -> None:
    """Limit analysis, the run and its cost; draw and print."""
    args = cli.parser(__doc__, "facade_in_space").parse_args(argv)
    out = folder(args.out)
    masonry = facade(0.4) if args.quick else facade()
    ways = {"outwards": OUTWARDS, "inwards": INWARDS, "along": ALONG}
    limits = {name: mr.collapse_multiplier(masonry, angle=angle).multiplier for name, angle in ways.items()}
    shaken(masonry, 0.01)  # compiles what is not compiled yet
    answer = shaken(masonry, 0.05 if args.quick else DURATION)
    moment, stats = moment_of(answer), answer.stats
    far = np.linalg.norm(answer.pose[moment, :, :3] - answer.pose[0, :, :3], axis=1)
    words = {"at rest": 0, "as the first block falls": moment, "at the end": len(answer.t) - 1}
    plotting.save(at_times(answer, words, CAMERA), out / "facade_in_space.png")
    written = films(
        lambda path: plotting.animate(answer, path, camera=CAMERA), out / "facade_in_space", 0.7 * float(answer.t[-1])
    )
    written.append(plotting.animate(answer, out / "facade_in_space.gif", fps=10, dpi=80, camera=CAMERA))
    header = ["blocks", "points", "set-up [s]", "step [us]", "s a simulated s", "ns a point and step"]
    rows = [cost(0.4, 2)] if args.quick else [cost(*size) for size in SIZES]
    each = 1e9 * stats["stepping_processor_time"] / stats["steps"] / len(masonry.lines.k)
    lines = [
        f"{len(masonry.free)} blocks, {len(masonry.joints)} joints, {len(masonry.lines.k)} points",
        "limit analysis: " + ", ".join(f"{name} {value:.3f} g" for name, value in limits.items()),
        "peaks of the ground: " + ", ".join(f"{name} {peak:g} m/s2" for name, peak in PEAKS.items()),
        f"{answer.message} The largest overlap of two blocks is {answer.stats['overlap']:.2%}.",
        f"at t = {answer.t[moment]:.2f} s {answer.bodies[far.argmax()]} has moved the most, by {far.max():.2f} m",
        f"{stats['steps']} steps of {1e6 * stats['timestep']:.3g} us: {stats['stepping_processor_time']:.3g} s, "
        f"{stats['stepping_processor_time'] / answer.t[-1]:.3g} s a simulated second, {each:.0f} ns a point and step; "
        f"before them {stats['processor_time'] - stats['stepping_processor_time']:.2g} s",
        summary_of(written),
        "",
        cli.table(header, rows),
    ]
    cli.report(out / "facade_in_space", "\n".join(lines), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
