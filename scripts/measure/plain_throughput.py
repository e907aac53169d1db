"""How many steps a second plain models take: one after the other, and many starts at once by `mujoco.rollout`.

The wall of Figure 3 at 0.2 ms and a facade of 29 blocks at 1 ms, from starts that differ by a small speed. Prints steps
a second of one core after the other, of rollout on one and on all cores, and whether their last states are the same to
the bit. MJX and MuJoCo Warp are asked for the wall where they are installed.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
import time
from collections.abc import Callable, Sequence

import mujoco
import numpy as np
from mujoco import rollout
from numpy.typing import NDArray

import mjrock as mr
from mjrock import machine
from scripts.shared import cli, paper
from scripts.studies.second_opinion import facade

Starts = NDArray[np.float64]


def wall_text() -> str:
    """The plain model of the wall of Figure 3."""
    e = mr.Restitution.from_geometry(paper.FIGURE_3)
    contacts = mr.Contacts.from_law(paper.FIGURE_3, e, k_base=paper.K_N, k_side=paper.K_N)
    return mr.mjcf_of(mr.Case(paper.FIGURE_3, 0.5 * paper.FIGURE_3.alpha, 1.0), contacts, 2e-4, collisions=True)


def starts_of(model: mujoco.MjModel, count: int) -> Starts:
    """States that differ a little, shape (count, states)."""
    data, rng = mujoco.MjData(model), np.random.default_rng(1)
    size = mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    states = np.zeros((count, size))
    for state in states:
        mujoco.mj_resetDataKeyframe(model, data, 0)
        data.qvel[:] += rng.uniform(-0.01, 0.01, model.nv)
        mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    return states


def one_by_one(model: mujoco.MjModel, starts: Starts, steps: int) -> Starts:
    """The last states of runs that are stepped one after the other."""
    data, last = mujoco.MjData(model), np.zeros_like(starts)
    for start, end in zip(starts, last, strict=True):
        mujoco.mj_setState(model, data, start, mujoco.mjtState.mjSTATE_FULLPHYSICS)
        data.qacc_warmstart[:] = 0.0
        for _ in range(steps):
            mujoco.mj_step(model, data)
        mujoco.mj_getState(model, data, end, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    return last


def at_once(model: mujoco.MjModel, starts: Starts, steps: int, threads: int) -> Starts:
    """The last states of runs that rollout steps on some cores."""
    with rollout.Rollout(nthread=threads) as many:
        data = [mujoco.MjData(model) for _ in range(threads)]
        states, _ = many.rollout(model, data, starts, nstep=steps)
    return np.asarray(states[:, -1])


def timed(call: Callable[..., Starts], *given: object) -> tuple[Starts, float]:
    """The last states, and how long they took [s]."""
    began = time.perf_counter()
    last = call(*given)
    return last, time.perf_counter() - began


def elsewhere(package: str, text: str) -> str:
    """Whether a package takes a model, in words."""
    if importlib.util.find_spec(package) is None:
        return "not installed, left out"
    try:
        importlib.import_module(package).put_model(mujoco.MjModel.from_xml_string(text))
    except Exception as error:
        return f"does not take the wall: {error}"
    return "takes the wall"


def main(argv: Sequence[str] | None = None) -> None:
    """Time them."""
    args, lines = cli.parser(__doc__, "plain_throughput").parse_args(argv), []
    out, cores = cli.folder(args.out), machine.cores()
    texts = {
        "wall of Figure 3": (wall_text(), 2000, 16),
        "facade of 29 blocks": (mr.mjcf_of(facade(), None, 1e-3, collisions=True), 200, 4),
    }
    for name, (text, steps, count) in texts.items():
        if args.quick:
            steps, count = 20, 2
        model = mujoco.MjModel.from_xml_string(text)
        starts = starts_of(model, count)
        alone, took = timed(one_by_one, model, starts, steps)
        rates = [f"{steps * count / took:,.0f} one after the other"]
        for threads in sorted({1, cores}):
            last, took = timed(at_once, model, starts, steps, threads)
            same = "the same to the bit" if np.array_equal(last, alone) else f"within {np.abs(last - alone).max():.2g}"
            rates.append(f"{steps * count / took:,.0f} by rollout on {threads} core{'s' * (threads > 1)} ({same})")
        lines.append(f"{name}, steps a second: " + ", ".join(rates))
    lines += [f"{package}: {elsewhere(package, wall_text())}" for package in ("mujoco.mjx", "mujoco_warp")]
    cli.report(out / "plain_throughput", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(cli.run(main))
