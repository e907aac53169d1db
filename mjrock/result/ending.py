"""How runs end, with a sentence for the user, and the time that a solver took."""

from __future__ import annotations

import enum
import time
from collections.abc import Mapping

from ..problem.wall.case import Case
from ..quantities import Array, named


class Outcome(enum.Enum):
    """How a run ended."""

    AT_REST = "at rest"
    OVERTURNED = "overturned"
    TIME_ENDED = "time ended"


def ending(
    case: Case, t: Array, theta: Array, energy: Array, uplift_energy: float, velocity: Array
) -> tuple[Outcome, str]:
    """Outcome of a run of a wall on compliant contacts, and a sentence about it.

    The wall is at rest when its energy above the settled wall no longer lifts an edge off the base, nor does its
    kinetic energy alone: a wall that a thrust pushes along has less than at rest. `velocity` is that at the end, shape
    (3,). The wall has overturned when it lies on its face or ends beyond the rotation from which weight, loads, thrusts
    and ties bring it back.
    """
    kinetic = 0.5 * float(velocity**2 @ [case.wall.mass, case.wall.mass, case.wall.inertia])
    if not case.returns_from(theta[-1:])[0]:
        outcome = Outcome.OVERTURNED
    elif max(energy[-1], kinetic) < uplift_energy:
        outcome = Outcome.AT_REST
    else:
        outcome = Outcome.TIME_ENDED
    said = describe(outcome, case, min(float(t[-1]), case.duration), float(theta[-1]))
    over = -float(theta.min()) / case.wall.alpha
    if case.one_sided and over >= 1:
        said += f" It leaned inwards over the side stop of {case.stop_top:g} m, by up to {over:.3g} alpha."
    return outcome, said


def describe(outcome: Outcome, case: Case, t_end: float, theta_end: float) -> str:
    """The ending in words."""
    share = abs(theta_end) / case.wall.alpha
    match outcome:
        case Outcome.AT_REST:
            return f"The wall is at rest at the end of the run ({t_end:.4g} s)."
        case Outcome.OVERTURNED:
            return f"The wall overturned; it was followed until {t_end:.4g} s, when its rotation was {share:.3g} alpha."
        case Outcome.TIME_ENDED:
            return f"The wall still rocks at the end of the run ({t_end:.4g} s), at {share:.3g} alpha."


def masonry_ending(fallen: Mapping[str, float], quiet: bool, t_end: float, *, everywhere: bool) -> tuple[Outcome, str]:
    """Outcome of a run of masonry, and a sentence about it; `everywhere` is whether all contacts are found."""
    if fallen:
        left_out = "" if everywhere else "; contacts other than those of the joints at rest are not in the model"
        (name, first), *others = fallen.items()
        fell = f"1 block fell, at {first:.4g} s: {name}."
        if others:
            fell = f"{len(fallen)} blocks fell, the first at {first:.4g} s: {named(list(fallen))}."
        return Outcome.OVERTURNED, f"{fell} The motion was followed for {t_end:.4g} s{left_out}."
    if quiet:
        return Outcome.AT_REST, f"The masonry is at rest at the end of the run ({t_end:.4g} s)."
    return Outcome.TIME_ENDED, f"The masonry still moves at the end of the run ({t_end:.4g} s)."


class Stopwatch:
    """Wall time, and processor time of this thread, since it was made [s]."""

    def __init__(self) -> None:
        self._began = time.perf_counter(), time.thread_time()

    def took(self, wall: str = "wall_time", processor: str = "processor_time") -> dict[str, float]:
        """Both times, under their names in the `stats` of a response."""
        return {wall: time.perf_counter() - self._began[0], processor: time.thread_time() - self._began[1]}

    def stepping(self) -> dict[str, float]:
        """Both times, under the names for the steps alone."""
        return self.took("stepping_time", "stepping_processor_time")
