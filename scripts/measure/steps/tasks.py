"""What a version of the package is asked for by `step_cost.py`: a step of a scene, a set-up, rocking theory.

It imports no more of the package than its names, since earlier versions have other modules.
"""

from __future__ import annotations

import inspect
import math
import sys
import time
import warnings
from functools import cache
from typing import Any

import mjrock as mr
from scripts.measure import speed
from scripts.shared import cli

K_N, K_SPACE = 1e10, 1e9
"""Stiffness of the joints of the plane and of space [N/m3]."""
PUSH = {2: 5.0, 3: 0.5}
"""Acceleration of the ground by dimension [m/s2]."""
WALLS, FACADES = (50, 200, 1000), ((2.0, 1.0, 0.5, (0.5, 0.25)), (4.0, 2.0, 1.0, (0.5, 0.25)))
LARGE_WALL, LARGE_FACADE = 3873, (10.0, 6.0, 1.0, (0.5, 0.25))
MORTAR = "cement mortar, wall J4D"
THEORY = ("one-sided, 3 s, rocking theory", "two-sided, 6 s, rocking theory", "10 s record, rocking theory")


@cache
def masonry(name: str) -> mr.Masonry:
    """A wall of so many blocks in running bond, or a façade."""
    kind, number, friction = name.split()
    k_n = K_N if kind == "wall" else K_SPACE
    joints: dict[str, Any] = {"k_n": k_n, "k_s": None if friction == "rigid" else k_n}
    if friction == "mortar":
        joints |= {"bond": mr.BONDS[MORTAR], "points": 3}
    if kind == "wall":
        columns = max(1, round(math.sqrt(int(number))))
        size = max(1, round(int(number) / columns)) * 0.4, columns * 0.2
        return mr.Masonry.running_bond(*size, (0.4, 0.2), **joints)
    return mr.Masonry.facade(*(*FACADES, LARGE_FACADE)[int(number)], **joints)


STEPS_BEFORE = tuple(
    f"{kind} {number} {friction}"
    for friction in ("sprung", "rigid")
    for kind, numbers in (("wall", WALLS), ("facade", range(len(FACADES))))
    for number in numbers
)
"""Scenes of every version."""
STEPS = (
    *STEPS_BEFORE[: len(WALLS)],
    f"wall {LARGE_WALL} sprung",
    *(f"wall {number} mortar" for number in WALLS),
    *STEPS_BEFORE[len(WALLS) : len(WALLS) + len(FACADES)],
    f"facade {len(FACADES)} sprung",
    *STEPS_BEFORE[len(WALLS) + len(FACADES) :],
)
"""Scenes of this version, which has mortar and larger masonry."""


def case_of(name: str, duration: float) -> mr.MasonryCase:
    """A scene whose ground accelerates at once."""
    blocks = masonry(name)
    return mr.MasonryCase(blocks, duration, motion=mr.GroundMotion([PUSH[3 if blocks.in_space else 2]] * 2, 1.0))


def stepped(name: str, duration: float) -> tuple[mr.Response, float]:
    """The answer by one thread, and processor seconds of its steps: all of the call, where a version has no others."""
    begun = time.process_time()
    one: dict[str, Any] = {"threads": 1} if "threads" in inspect.signature(mr.solve_explicit).parameters else {}
    answer = mr.solve_explicit(case_of(name, duration), output_step=duration, **one)
    spent = time.process_time() - begun
    return answer, float(answer.stats.get("stepping_processor_time", spent))


def step_seconds(name: str, count: int) -> float:
    """Processor seconds of a step of a scene: what so many steps take beyond a tenth of them, a step."""
    first, _ = stepped(name, 1e-6)
    h = 0.4 * first.stats["stable_timestep"]
    few, many = (stepped(name, steps * h) for steps in (count / 10, count))
    return (many[1] - few[1]) / float(many[0].stats["steps"] - few[0].stats["steps"])


def serve() -> None:
    """Do the tasks that are named on standard input, one a line, and answer with the seconds that each took."""
    warnings.simplefilter("ignore", UserWarning)
    for line in sys.stdin:
        name, size = line.rstrip("\n").split("\t")
        if name == "set-up":
            seconds = speed.set_up(int(size))
        elif name in THEORY:
            speed.CALLS[name]()
            seconds = min(cli.seconds(speed.CALLS[name]) for _ in range(20))
        else:
            seconds = step_seconds(name, int(size))
        print(f"{seconds!r}", flush=True)


if __name__ == "__main__":
    serve()
