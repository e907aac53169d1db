"""Plain models in MuJoCo Warp: steps a second of many worlds at once on a GPU, beside C on the processor's cores.

The wall of Figure 3 beside its stop and without it at 0.2 ms, and a facade of 29 blocks at 1 ms. Then the restitution
of the first rebound of walls whose touch falls at another phase of a step, in single precision, beside that of the law.
Without mujoco_warp or a CUDA device the script says so and ends; `--device cpu` runs few worlds on a processor.
"""

from __future__ import annotations

import importlib.util
import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import mjrock as mr
from mjrock import machine
from scripts.measure.plain_throughput import at_once, starts_of, timed
from scripts.shared import cli, paper
from scripts.studies.second_opinion import facade

IN_A_GRAPH = 10
"""Steps of one CUDA graph."""
WALL_CONTACTS, FACADE_CONTACTS = 16, 400
"""Largest number of contacts of a world."""
ROWS_OF_A_CONTACT = 4
LARGEST_FACADES = 4096
"""Largest number of facades at once."""
WALL = paper.FIGURE_3
SPREAD = 5e-4
"""Largest speed that is added at the release [rad/s]: touches are spread over the phases of a step."""
NEAR = 2e-3
"""Rotation of a wall beside its stop below which its fall has ended [rad]."""


@dataclass(frozen=True)
class Plain:
    """A plain model and what its worlds need.

    Args:
        text: MJCF.
        contacts: largest number of contacts of a world.
        largest: most worlds at once.
        law: |e| of the first rebound by the law, or None where none is compared.
        duration: until the first peak has passed [s].
    """

    text: str
    contacts: int
    largest: float = math.inf
    law: float | None = None
    duration: float = 0.0

    @property
    def model(self) -> mujoco.MjModel:
        """The compiled model."""
        return mujoco.MjModel.from_xml_string(self.text)


def wall(side_stop: bool, duration: float) -> Plain:
    """The wall of Figure 3 released at half of its critical rotation."""
    e = mr.Restitution.from_geometry(WALL)
    contacts = mr.Contacts.from_law(WALL, e, k_base=paper.K_N, k_side=paper.K_N)
    case = mr.Case(WALL, theta0=0.5 * WALL.alpha, duration=2.0, side_stop=side_stop)
    law = float(mr.solve_compliant(case, contacts).restitution[0])
    return Plain(mr.mjcf_of(case, contacts, 2e-4, collisions=True), WALL_CONTACTS, law=law, duration=duration)


def worlds_of(plain: Plain, count: int, device: str) -> tuple[Callable[[], object], Any]:
    """A call that takes ten steps of all worlds of a model, and their data."""
    import mujoco_warp
    import warp

    model = plain.model
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    speeds = np.tile(data.qvel, (count, 1))
    speeds[:, 2] -= np.random.default_rng(1).uniform(0, SPREAD, count)
    with warp.ScopedDevice(device):
        batch = mujoco_warp.put_model(model)
        rows = ROWS_OF_A_CONTACT * plain.contacts
        worlds = mujoco_warp.put_data(model, data, nworld=count, nconmax=plain.contacts, njmax=rows)
        worlds.qvel = warp.array(speeds.astype(np.float32), dtype=float)
        mujoco_warp.step(batch, worlds)

        def steps() -> None:
            for _ in range(IN_A_GRAPH):
                mujoco_warp.step(batch, worlds)

        if not warp.get_device(device).is_cuda:
            return steps, worlds
        with warp.ScopedCapture() as capture:
            steps()
    return lambda: warp.capture_launch(capture.graph), worlds


def speed_of(plain: Plain, count: int, device: str, graphs: int) -> float:
    """Steps a second of all worlds together."""
    import warp

    steps, _ = worlds_of(plain, count, device)
    steps()
    warp.synchronize()
    taken = cli.seconds(lambda: ([steps() for _ in range(graphs)], warp.synchronize()))
    return count * graphs * IN_A_GRAPH / taken


def rebounds(plain: Plain, count: int, device: str) -> NDArray[np.float64]:
    """|e| of the first rebound of each world, by the energy of the rigid wall at its peak, shape (count,)."""
    steps, worlds = worlds_of(plain, count, device)
    rotations = []
    for _ in range(round(plain.duration / plain.model.opt.timestep / IN_A_GRAPH)):
        steps()
        rotations.append(worlds.qpos.numpy()[:, 2].astype(float))
    theta = np.array(rotations)
    touched = np.argmax(theta < NEAR, axis=0)
    peaks = np.array([np.abs(theta[start:, world]).max() for world, start in enumerate(touched)])
    heights = [np.cos(WALL.alpha - each) - np.cos(WALL.alpha) for each in (peaks, 0.5 * WALL.alpha)]
    return np.asarray(np.sqrt(heights[0] / heights[1]))


def in_c(plain: Plain, threads: int, quick: bool) -> float:
    """Steps a second of the same model in C, in double precision, on some cores."""
    steps = 20 if quick else 500 if plain.law is not None else 60
    starts = starts_of(plain.model, 8 * threads)
    return len(starts) * steps / timed(at_once, plain.model, starts, steps, threads)[1]


def lacking(device: str) -> str:
    """What is not here, in words, or nothing."""
    if importlib.util.find_spec("mujoco_warp") is None:
        return "mujoco_warp is not installed"
    import warp

    warp.config.log_level = warp.LOG_WARNING
    if device != "cpu" and not warp.is_cuda_available():
        return "no CUDA device"
    return ""


def speeds(scenes: dict[str, Plain], sizes: Sequence[int], device: str, quick: bool) -> str:
    """The table of steps a second."""
    cores, rows = machine.cores(), []
    for name, plain in scenes.items():
        one, all_cores = (in_c(plain, threads, quick) for threads in (1, cores))
        rows.append([name, "C, one core", f"{one:.3g}", "1", f"{one / all_cores:.2g}"])
        rows.append([name, f"C, {cores} cores", f"{all_cores:.3g}", f"{all_cores / one:.2g}", "1"])
        for count in tqdm([size for size in sizes if size <= plain.largest], desc=name, disable=None, leave=False):
            found = speed_of(plain, count, device, 2 if device == "cpu" else 30)
            rows.append(
                [name, f"Warp, {count:,} worlds", f"{found:.3g}", f"{found / one:.2g}", f"{found / all_cores:.2g}"]
            )
    return cli.table(["scene", "run", "steps/s", "over one core", "over all cores"], rows)


def scatter(scenes: dict[str, Plain], count: int, device: str) -> str:
    """The table of restitutions."""
    rows = []
    for name, plain in scenes.items():
        if plain.law is not None:
            e = rebounds(plain, count, device)
            rows.append([name, *(f"{each:.5f}" for each in (plain.law, e.mean(), e.std(), e.min(), e.max()))])
    return cli.table(["scene", "law", "mean", "standard deviation", "least", "largest"], rows)


def main(argv: Sequence[str] | None = None) -> None:
    """Measure them."""
    options = cli.parser(__doc__, "warp_throughput")
    options.add_argument("--device", choices=("cuda", "cpu"), default="cuda", help="where the worlds are stepped")
    options.add_argument("--worlds", type=int, nargs="+", default=[1, 256, 4096, 32768], help="numbers of worlds")
    options.add_argument("--phases", type=int, default=1024, help="walls whose first rebound is looked at")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    if lacks := lacking(args.device):
        cli.report(out / "warp_throughput", f"not measured: {lacks}")
        return
    scenes = {
        "wall beside its stop": wall(True, 1.15),
        "wall alone": wall(False, 1.6),
        "facade of 29 blocks": Plain(
            mr.mjcf_of(facade(), None, 1e-3, collisions=True), FACADE_CONTACTS, largest=LARGEST_FACADES
        ),
    }
    if args.quick:
        scenes = dict(list(scenes.items())[:1])
    began = time.perf_counter()
    text = speeds(scenes, args.worlds[:1] if args.quick else args.worlds, args.device, args.quick)
    text += f"\n\n|e| of the first rebound, {args.phases} walls\n{scatter(scenes, args.phases, args.device)}"
    cli.report(out / "warp_throughput", f"{text}\n\n{time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    sys.exit(cli.run(main))
