"""What a solver returns: the motion, its impacts and rotation peaks, and how it ended."""

from __future__ import annotations

import enum
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..files import write_text
from ..problem.case import Case
from ..problem.quantities import Array, require_path
from .history import Impact, peak_energies, restitution_of
from .ledger import Ledger
from .table import csv_text

State = tuple[Array, Array]
"""Pose (x, z, theta) of each body as its displacement from rest [m, m, rad], and its velocity, shape (bodies, 3)."""


class Outcome(enum.Enum):
    """How a run ended."""

    AT_REST = "at rest"
    OVERTURNED = "overturned"
    TIME_ENDED = "time ended"


class Plastic(NamedTuple):
    """How far a tie has yielded by the end of a run.

    Args:
        elongation: plastic elongation [m].
        energy: the energy that this took [J].
    """

    elongation: float
    energy: float


@dataclass(frozen=True, eq=False, repr=False)
class Response:
    """The motion that a solver found.

    Two responses are equal if they have the same case, solver, samples, impacts and outcome.

    Args:
        case: what was asked.
        solver: which solver answered.
        t: times [s], shape (n,).
        theta: rotation [rad], shape (n,).
        omega: angular velocity [rad/s], shape (n,).
        impacts: the impacts in order.
        peaks: rotation maxima |theta| [rad], the release first, shape (m,).
        outcome: how the run ended.
        message: the same in words, for the user.
        plastic: what ties have yielded, by tie.
        compliant: energy [J], shape (n,), and pose, shape (n, bodies, 3), where contacts are compliant. None for the
            rigid wall of rocking theory, whose energy and pose follow from its rotation.
        ledger: every part of the energy, or None where none was asked for.
        stats: what the run took: `steps`, `timestep` [s] or solver tolerances, `wall_time` [s]. MuJoCo adds the deepest
            penetration of each group of contacts, such as `deepest_base`, and the `base_displacement` at the end [m].
        end: pose and velocity at the end, to continue from with `simulate(..., start=...)`. None from other solvers.
    """

    case: Case
    solver: str
    t: Array
    theta: Array
    omega: Array
    impacts: tuple[Impact, ...]
    peaks: Array
    outcome: Outcome
    message: str
    compliant: tuple[Array, Array] | None = None
    ledger: Ledger | None = None
    stats: dict[str, Any] = field(default_factory=dict)
    end: State | None = None
    plastic: Mapping[str, Plastic] = field(default_factory=dict)

    @property
    def peak_over_alpha(self) -> float:
        """Largest rotation over alpha [-]; infinite for a wall that has overturned.

        The largest rotation may be that of the last sample, where a run ends on its way out.
        """
        if self.outcome is Outcome.OVERTURNED:
            return math.inf
        return float(max(self.peaks.max(initial=0.0), np.abs(self.theta[-1]))) / self.case.wall.alpha

    @cached_property
    def energy(self) -> Array:
        """Kinetic, potential and, where contacts are compliant, elastic energy above the wall at rest [J], shape
        (n,)."""
        if self.compliant is not None:
            return self.compliant[0]
        return self.case.energy(self.theta, self.omega)

    @cached_property
    def pose(self) -> Array:
        """Displacement x, z of each centroid from rest [m] and its rotation theta [rad], shape (n, bodies, 3).

        x points away from the side stop, z upwards. A wall is one body.
        """
        return self.case.wall.pose(self.theta)[:, None] if self.compliant is None else self.compliant[1]

    @property
    def energy_residual(self) -> Array | None:
        """Closure error of the energy ledger [J], shape (n,), or None where none was asked for."""
        return None if self.ledger is None else self.ledger.residual

    @property
    def restitution(self) -> Array:
        """|e| of each rebound, from successive peaks [-], shape (m - 1,).

        e_n = sqrt(V_(n+1) / V_n), with V the potential energy of the rigid wall at a rotation peak, or its whole energy
        at the release. Every solver is measured with this one rule. It is exact for a rigid wall, and it does not count
        the energy that a compliant base stores under a pivoting wall as a loss. On a shaken base the ground does work
        between two peaks. There, with ties and for a lopsided wall, |e| is that of the impacts, shape (len(impacts),).
        """
        if self.case.shaken or self.case.pulls or self.case.lopsided:
            return np.array([impact.restitution for impact in self.impacts])
        return restitution_of(*peak_energies(self.case, self.peaks))

    @property
    def settled_restitution(self) -> Array:
        """|e| of each rebound, from the whole energy of the wall above its settled rest [-], shape (m - 1,).

        The energy at a rotation peak is potential and elastic. It differs from that of `restitution`, the rigid wall's
        above the undeformed base, by what the settled base gives back as the wall lifts off it: V - E is nearly the
        same at every peak. It counts for more the smaller the rebound is. Both are the same in rocking theory.

        Raises:
            ValueError: on a shaken base, where the ground does work between two peaks, and with ties.
        """
        if self.case.shaken or self.case.pulls:
            raise ValueError("on a shaken base the ground does work between two peaks, and ties may; see impacts")
        bounds = [0.0, *(impact.t for impact in self.impacts), float(self.t[-1])]
        energies = []
        for i in range(len(self.peaks)):
            first, last = np.searchsorted(self.t, bounds[i : i + 2])
            turn = first + int(np.argmax(np.abs(self.theta[first : last + 1])))
            energies.append(self.energy[0] if i == 0 and self.peaks[0] == self.case.release_peak else self.energy[turn])
        return restitution_of(np.array(energies), np.array(energies))

    def csv(self, path: str | Path | None = None) -> str:
        """The samples as CSV text, one row each, written to `path` where one is given.

        The columns are t [s], theta [rad], omega [rad/s], energy [J], x, z and rotation of each body from rest
        [m, m, rad], and the acceleration of the ground where there is one [m/s2]. Their names have no commas, so that
        `np.genfromtxt(path, delimiter=",", names=True)` and pandas read them. Numbers keep all their digits.

        Raises:
            OSError: if the file cannot be written.
        """
        columns = {"t [s]": self.t, "theta [rad]": self.theta, "omega [rad/s]": self.omega, "energy [J]": self.energy}
        bodies = self.pose.shape[1]
        for i in range(bodies):
            of = "" if bodies == 1 else f" of body {i}"
            for j, (name, unit) in enumerate((("x", "m"), ("z", "m"), ("rotation", "rad"))):
                columns[f"{name}{of} [{unit}]"] = self.pose[:, i, j]
        for motion, name in ((self.case.motion, "horizontal"), (getattr(self.case, "vertical", None), "vertical")):
            if motion is not None:
                columns[f"ground {name} [m/s2]"] = motion(self.t)
        text = csv_text(list(columns), np.column_stack(list(columns.values())).tolist())
        if path is not None:
            write_text(require_path("path", path), text)
        return text

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Response):
            return NotImplemented
        same = ("case", "solver", "impacts", "outcome")
        samples = ("t", "theta", "omega", "peaks", "energy", "pose")
        return all(getattr(self, name) == getattr(other, name) for name in same) and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in samples
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        largest = float(np.abs(self.theta).max()) / self.case.wall.alpha
        return (
            f"<Response of {self.solver}: {len(self.t)} samples over {self.t[-1]:.4g} s, {len(self.impacts)} impacts, "
            f"largest rotation {largest:.3g} alpha, {self.outcome.value}>"
        )


def ending(case: Case, t: Array, theta: Array, energy: Array, uplift_energy: float) -> tuple[Outcome, str]:
    """How a run on compliant contacts ended, and the same in words.

    The wall is at rest when its energy above the settled wall no longer lifts an edge off the base. It has overturned
    when it lies on its face or ends beyond the rotation from which weight, loads, thrusts and ties bring it back.
    """
    if not case.returns_from(theta[-1:])[0]:
        outcome = Outcome.OVERTURNED
    elif energy[-1] < uplift_energy:
        outcome = Outcome.AT_REST
    else:
        outcome = Outcome.TIME_ENDED
    return outcome, describe(outcome, case, min(float(t[-1]), case.duration), float(theta[-1]))


def describe(outcome: Outcome, case: Case, t_end: float, theta_end: float) -> str:
    """The ending in words."""
    share = abs(theta_end) / case.wall.alpha
    match outcome:
        case Outcome.AT_REST:
            return f"The wall came to rest; last looked at {t_end:.4g} s."
        case Outcome.OVERTURNED:
            return f"The wall overturned; at {t_end:.4g} s its rotation was {share:.3g} alpha."
        case Outcome.TIME_ENDED:
            return f"The wall was still rocking when the asked {t_end:.4g} s ended, at {share:.3g} alpha."
