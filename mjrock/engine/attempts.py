"""Attempts at a run: the engine is released and stepped, and what it did is judged.

Judging turns the steps into a run that is checked, and raises a `StepError` where the run is broken. A wall and masonry
differ in how they are judged, and in nothing else.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from ..problem.effects import Effect, Tie
from ..problem.quantities import require_array, require_flag, shown
from ..result.response import State
from .mjcf import Rows
from .model import engine_of
from .pace import short_step
from .run import broken
from .scene import Scene
from .stepping import fitted_steps, fixed_steps
from .steps import StepError, Steps

Judged = TypeVar("Judged")
PARTS = ("pose", "velocity")
"""What a state is made of."""


def fitted(
    scene: Scene, start: State, accuracy: float, coulomb: bool | None, judge: Callable[[Steps], Judged]
) -> tuple[Judged, dict[str, Any]]:
    """A run with steps that fit the motion, and what it took, repeated with finer steps where it is broken.

    Raises:
        SimulationError: if it is broken with a hundredth of the accuracy too.
    """
    used = accuracy
    while True:
        h = short_step(scene, used)
        try:
            with engine_of(scene) as engine:
                engine.place(start)
                begun = time.perf_counter()
                steps = fitted_steps(engine, scene, used, coulomb=coulomb is not False)
            took = time.perf_counter() - begun
            run = judge(steps)
            return run, {"timestep": h, "accuracy": used, "newmark_beta": None, "stepping_time": took}
        except StepError as error:
            if used < 0.02 * accuracy:
                raise broken(error, scene, h, used) from None
            used /= 10


def fixed(
    scene: Scene,
    start: State,
    timestep: float,
    newmark_beta: float,
    rows: Rows,
    coulomb: bool | None,
    judge: Callable[[Steps], Judged],
) -> tuple[Judged, dict[str, Any]]:
    """A run at one step with the rows of that step, and what it took.

    Raises:
        SimulationError: if it is broken.
    """
    try:
        with engine_of(scene) as engine:
            engine.follow(timestep, rows)
            engine.release(start)
            begun = time.perf_counter()
            steps = fixed_steps(engine, scene, timestep, newmark_beta, coulomb=coulomb is True)
        took = time.perf_counter() - begun
        run = judge(steps)
    except StepError as error:
        raise broken(error, scene, timestep, None) from None
    return run, {"timestep": timestep, "accuracy": None, "newmark_beta": newmark_beta, "stepping_time": took}


def require_coulomb(coulomb: object) -> None:
    """Raise TypeError unless `coulomb` is True, False or None."""
    if coulomb is not None:
        require_flag("coulomb", coulomb)


def stride_of(output_step: float | None, timestep: float) -> int:
    """How many fixed steps lie between two samples that are `output_step` apart [s]."""
    return max(1, round(output_step / timestep)) if output_step else 1


def required_start(start: object, bodies: int, effects: Sequence[Effect]) -> State:
    """A start as pose and velocity of all bodies, each of shape (bodies, 3) and finite.

    Raises:
        TypeError: if it is no pose and velocity.
        ValueError: for another shape, a value that is not finite, or ties that yield among the effects.
    """
    if any(isinstance(one, Tie) and one.strength < math.inf for one in effects):
        raise ValueError("start does not say what ties have yielded; follow a case with ties that yield in one run")
    if not isinstance(start, tuple | list) or len(start) != 2:
        raise TypeError(f"start = {shown(start)} is not a pose and a velocity; take the end of an earlier response")
    pose, velocity = (
        require_array(f"start, {name}", part, (bodies, 3)) for name, part in zip(PARTS, start, strict=True)
    )
    return pose, velocity
