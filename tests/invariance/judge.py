"""One random scene put to the test: its answer is checked, and the scene is run under invariances."""

from __future__ import annotations

import time
import traceback
import warnings
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

import mjrock as mr

from .checks import GIVES_BACK, complaints
from .invariances import INVARIANCES, Trial
from .quantities import Scene
from .random_scenes import draw
from .runs import solve

PACKAGE = str(Path(mr.__file__).parent)
EQUAL = 1e-9
"""Distance of two motions over the size of a scene up to which they are equal, where it need not be to the bit [-]."""
MOST = 30_000
"""Most steps of an answer whose every step is checked."""


def is_named(error: Exception) -> bool:
    """Whether an error was raised by the package itself, of a kind that it raises on purpose."""
    last = traceback.extract_tb(error.__traceback__)[-1]
    return isinstance(error, ValueError | RuntimeError) and last.filename.startswith(PACKAGE)


def error_text(error: Exception) -> str:
    """An error and where it was raised."""
    last = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {str(error)[:300]} ({Path(last.filename).name}:{last.lineno})"


@contextmanager
def overheard() -> Iterator[list[str]]:
    """What runs warn of. A warning of NumPy is an error: it is not the package's own."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        warnings.simplefilter("error", RuntimeWarning)
        warned: list[str] = []
        yield warned
        warned += [str(warning.message) for warning in caught]


def judge(seed: int, names: Collection[str] | None = None) -> dict[str, Any]:
    """What became of a scene, as a row of a table.

    Args:
        seed: of the scene.
        names: the invariances to try; None takes all.
    """
    scene, began = draw(seed), time.perf_counter()
    row: dict[str, Any] = {"place": scene["place"], "seed": seed, "kind": scene["kind"], "solver": scene["solver"]}
    with overheard():
        try:
            trial = Trial(scene)
        except Exception as error:
            return row | {"refused" if is_named(error) else "unnamed": error_text(error)}
        row |= {"outcome": trial.answer.outcome.value, "steps": trial.answer.stats.get("steps", 0)}
        row["friction"] = trial.answer.stats.get("friction", "")
        row |= {"extent": trial.extent, "apart": {}}
        row["wrong"] = watched(trial)
        for name in INVARIANCES if names is None else names:
            if (found := tried(trial, name)) is not None:
                row["apart"][name] = found
        if "nudged" in vars(trial):
            row["nudged"] = trial.nudged
    return row | {"took": time.perf_counter() - began}


def tried(trial: Trial, name: str) -> tuple[str, float | str] | None:
    """The verdict on an invariance of a scene and the distance or the error, or None where it does not apply.

    The verdict is "equal" within rounding, "expected" or "unexplained".
    """
    invariance = INVARIANCES[name]
    try:
        distance = invariance.run(trial)
    except Exception as error:
        expected = is_named(error) and invariance.excuses(trial)
        return "expected" if expected else "unexplained", error_text(error)
    if distance is None:
        return None
    if distance <= EQUAL * bool(invariance.floor):
        return "equal", distance
    return "expected" if invariance.allows(trial, distance) else "unexplained", distance


def watched(trial: Trial) -> list[str]:
    """What is wrong with the answer, watched at every step, with its ledger and forces."""
    scene: Scene = trial.scene
    if scene["solver"] == "theory":
        return list(complaints(scene, trial.answer, []))
    options: dict[str, Any] = {"ledger": True, "forces": True, "output_step": trial.spacing}
    if scene["solver"] == "explicit":
        close = trial.answer.stats["steps"] < MOST
        scene = scene | {"timestep": trial.step}
        options["output_step"] = trial.step if close else trial.spacing
    try:
        with overheard() as warned:
            answer = solve(scene, **options)
    except Exception as error:
        return [f"watched: {error_text(error)}"]
    wrong = list(complaints(scene, answer, warned))
    if any(GIVES_BACK in text for text in wrong) and scene["solver"] == "explicit":
        shorter = {"timestep": 0.25 * trial.step}  # what a line does within the step in which it leaves is not resolved
        with overheard():
            finer = complaints(scene, solve(scene | shorter, **options | {"output_step": 0.25 * trial.step}), warned)
        still = [text for text in finer if GIVES_BACK in text]
        wrong = [text for text in wrong if GIVES_BACK not in text] + still
    if scene["solver"] == "explicit" and not np.array_equal(answer.pose[-1], trial.answer.pose[-1]):
        wrong.append(f"watched otherwise: {np.abs(answer.pose[-1] - trial.answer.pose[-1]).max():.1e}")
    return wrong
