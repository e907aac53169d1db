"""How runs end, with a sentence for the user, and the time that a solver took."""

from __future__ import annotations

import enum
import time
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..problem.wall.case import Case
from ..quantities import Array, named

LAST_SECOND, STANDS_STILL = 1.0, 1e-3
"""Time at the end of a run in which a structure at rest does not move [s], and motion of a point in it that still
counts as rest, over the size of its body [-]."""
LEAST_MOTION = 1e-5
"""Motion below which messages give no number [m]."""


class Outcome(enum.Enum):
    """How a run ended."""

    AT_REST = "at rest"
    OVERTURNED = "overturned"
    TIME_ENDED = "time ended"


class Standstill(NamedTuple):
    """The motion at the end of a run, of a wall or of the block of masonry that moves most.

    Args:
        name: of the body that has moved farthest, over its size.
        moved: how far a point of it has moved in the last second, or in a shorter run [m].
        size: largest distance of a corner of it from its centroid [m].
        kinetic: kinetic energy of a body, over that with which it opens a joint, the largest of all bodies [-].
    """

    name: str
    moved: float
    size: float
    kinetic: float

    @classmethod
    def of(cls, names: Sequence[str], sizes: Array, t: Array, pose: Array, kinetic: float) -> Standstill:
        """That of bodies with these sizes [m], shape (bodies,), at samples of a run, shapes (n,) and (n, bodies, nq).

        A point moves by no more than its body does along the axes, and by its size times the change of its rotation.
        """
        last = pose[t >= t[-1] - LAST_SECOND]
        if pose.shape[-1] == 3:
            shift, turn = last[..., :2], np.ptp(last[..., 2], axis=0)
        else:
            shift, cosine = last[..., :3], np.abs((last[..., 3:] * last[-1, :, 3:]).sum(axis=-1))
            turn = 2 * np.arccos(np.minimum(cosine.min(axis=0), 1.0))
        moved = np.linalg.norm(np.ptp(shift, axis=0), axis=-1) + sizes * turn
        farthest = int((moved / sizes).argmax())
        return cls(names[farthest], float(moved[farthest]), float(sizes[farthest]), kinetic)

    @property
    def rests(self) -> bool:
        """Whether nothing moves."""
        return self.kinetic < 1 and self.moved <= STANDS_STILL * self.size

    def described(self, subject: str) -> str:
        """How far the subject has moved, and its kinetic energy, in words."""
        distance = f"{1e3 * self.moved:.2g} mm" if self.moved > LEAST_MOTION else f"less than {1e3 * LEAST_MOTION:g} mm"
        kinetic = f"{self.kinetic:.2g} times" if self.kinetic > 0.01 else "less than 1 % of"
        motion = f"In the last second {subject} moved by {distance}"
        return f"{motion}, and it has {kinetic} the kinetic energy that opens a joint."


def ending(
    case: Case, t: Array, pose: Array, energy: Array, uplift_energy: float, velocity: Array
) -> tuple[Outcome, str]:
    """Outcome of a run of a wall on compliant contacts, and a sentence about it.

    The wall is at rest when its energy above the settled wall no longer lifts an edge off the base, nor does its
    kinetic energy alone, and it stands still, see `Standstill`: a wall that a thrust pushes along has less energy than
    at rest. It has overturned when it lies on its face or ends beyond the rotation from which weight, loads, thrusts
    and ties bring it back.

    Args:
        case: the wall.
        t, pose, energy: times [s], poses and energy above rest [J], shapes (n,), (n, 3) and (n,).
        uplift_energy: with which an edge lifts off [J].
        velocity: at the end, shape (3,).
    """
    theta, block = pose[:, 2], case.block
    kinetic = 0.5 * float(velocity**2 @ [case.wall.mass, case.wall.mass, case.wall.inertia])
    sizes = np.array([np.hypot(block.half_base, block.h)])
    standstill = Standstill.of(("the wall",), sizes, t, pose[:, None], kinetic / uplift_energy)
    if not case.returns_from(theta[-1:])[0]:
        outcome = Outcome.OVERTURNED
    elif energy[-1] < uplift_energy and standstill.rests:
        outcome = Outcome.AT_REST
    else:
        outcome = Outcome.TIME_ENDED
    message = describe(outcome, case, min(float(t[-1]), case.duration), float(theta[-1]))
    if outcome is not Outcome.OVERTURNED:
        message += f" {standstill.described('it')}"
    over = -float(theta.min()) / case.wall.alpha
    if case.one_sided and over >= 1:
        message += f" It leaned inwards over the side stop of {case.stop_top:g} m, by up to {over:.3g} alpha."
    return outcome, message


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


def masonry_ending(
    fallen: Mapping[str, float], standstill: Standstill, quiet: bool, t_end: float, *, everywhere: bool
) -> tuple[Outcome, str]:
    """Outcome of a run of masonry, and a sentence about it.

    Args:
        fallen: when each block fell [s].
        standstill: the motion at the end.
        quiet: whether the energy above rest no longer opens a joint.
        t_end: end of the run [s].
        everywhere: whether all contacts are found.
    """
    if fallen:
        left_out = "" if everywhere else "; contacts other than those of the joints at rest are not in the model"
        (name, first), *others = fallen.items()
        fell = f"1 block fell, at {first:.4g} s: {name}."
        if others:
            fell = f"{len(fallen)} blocks fell, the first at {first:.4g} s: {named(list(fallen))}."
        return Outcome.OVERTURNED, f"{fell} The motion was followed for {t_end:.4g} s{left_out}."
    message = standstill.described(standstill.name)
    if quiet and standstill.rests:
        return Outcome.AT_REST, f"The masonry is at rest at the end of the run ({t_end:.4g} s). {message}"
    return Outcome.TIME_ENDED, f"The masonry still moves at the end of the run ({t_end:.4g} s). {message}"


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
