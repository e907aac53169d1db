"""`measure`: a contact of a model is dropped, pressed and pushed in a copy, and compared with what its numbers promise.

The geoms are moved together along the motion of the joints that a blow between them causes. The blow begins with a
speed of approach, at several places within a step. Then the model rests for a while in touch, and at last a force that
friction can hold pushes the body that moves. All else in the model acts as it does in a run.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

import mujoco
import numpy as np

from .checks import Array, Within, short_repr, within_ranges
from .effective_mass import PointLaw, with_tangents
from .files import aligned
from .geoms import GeomPair, compiled_model
from .inspect import InspectedContact, inspected
from .meeting import Keyframe, PairMeeting, Pose, meeting_of_geoms, state_alike
from .row_of_model import ModelRow

PHASES = 8
"""Places within a step at which blows begin."""
PUSHED = 0.5
"""Force that pushes, as a share of what friction can hold at rest [-]."""
MOST_MOVES, ARRIVED = 20, 1e-3
"""Most moves of the joints until the geoms have their distance, and its error over the first distance by then [-]."""
LONGEST_BLOW = 40.0
"""Longest blow that is followed, in periods of the contact over 2 pi [-], times xi where that is above 1."""


class MeasuredValue(NamedTuple):
    """A number that was measured, `found`, and the `promised` one of the contact; NaN where there is none."""

    found: float
    promised: float


@dataclass(frozen=True, eq=False)
class Measurement:
    """Measurements of a contact of a model.

    Args:
        contact: the contact as `inspect_contacts` gives it.
        speed: speed of approach of the blows [m/s].
        restitution: mean coefficient of restitution of the blows [-].
        depth: how deep the points are pressed in at rest [m], on average.
        force: normal force of all points at rest [N], and their static load in the pose.
        friction: force of friction of all points while the body is pushed [N].
        creep: speed of slip of the points under it [m/s].
        blow: time [s] and distance [m] of one of the blows, shape (n, 2).
        rest: time [s] and distance [m] at rest, and while it is pushed, shape (n, 2).
    """

    contact: InspectedContact
    speed: float
    restitution: MeasuredValue
    depth: MeasuredValue
    force: MeasuredValue
    friction: float
    creep: MeasuredValue
    blow: Array
    rest: Array

    __repr__ = short_repr

    def __str__(self) -> str:
        """A table of measured and promised values."""
        rows = [
            (f"restitution at {self.speed:g} m/s [-]", self.restitution),
            ("depth at rest [m]", self.depth),
            ("force at rest [N]", self.force),
            (f"creep under {self.friction:.3g} N [m/s]", self.creep),
        ]
        cells = [[name, *("-" if math.isnan(value) else f"{value:.4g}" for value in values)] for name, values in rows]
        title = f"{self.contact.geom1} on {self.contact.geom2}"
        return "\n".join(aligned([[title, "found", "promised"], *cells], "<>"))

    def draw(self) -> Any:
        """A figure of Matplotlib, which has to be installed: a blow, and the rest, promised values dashed."""
        from matplotlib import pyplot

        figure, (left, right) = pyplot.subplots(1, 2, figsize=(8, 3), layout="constrained")
        end = self.blow[-1]
        left.plot(*(1e3 * self.blow.T))
        if not math.isnan(self.restitution.promised):
            later = np.array((0.0, 0.25 * end[0]))
            left.plot(1e3 * (later + end[0]), 1e3 * (end[1] + self.restitution.promised * self.speed * later), "--")
        left.set(title=f"blow at {self.speed:g} m/s", xlabel="time [ms]", ylabel="distance [mm]")
        right.plot(self.rest[:, 0], 1e3 * self.rest[:, 1])
        right.axhline(-1e3 * self.depth.promised, linestyle="--", color="C1", label="promised")
        right.set(title="at rest, then pushed", xlabel="time [s]", ylabel="distance [mm]")
        right.set_ylim(-2e3 * np.nanmax(np.abs([self.depth.promised, self.depth.found])), 0.0)
        right.legend()
        return figure


@within_ranges
def measure(
    model: mujoco.MjModel | mujoco.MjSpec,
    geom1: str | int,
    geom2: str | int,
    *,
    speed: Annotated[float, Within(1e-9, 1e6, "m/s")] = 1.0,
    duration: Annotated[float, Within(1e-6, 1e3, "s")] = 1.0,
    keyframe: Keyframe = None,
    qpos: Sequence[float] | Array | None = None,
) -> Measurement:
    """Measure the contact of two geoms in a copy of their model.

    Args:
        model: a compiled model or a specification; it is not changed. `contact.apply(model)` comes first.
        geom1, geom2: names or numbers of the geoms.
        speed: speed of approach of the blows [m/s], 1e-9 to 1e6: a model may have millimetres.
        duration: how long the geoms rest, and then are pushed [s], 1e-6 to 1000.
        keyframe, qpos: the pose from which the geoms are moved together; see `contact_for`.

    Returns:
        The restitution, the depth and force at rest and the creep, each beside what the contact promises.

    Raises:
        TypeError, ValueError: for a value outside its range, and geoms that the joints cannot bring together.
    """
    whole = copy.copy(compiled_model(model))
    return ContactTest(Pose(whole, keyframe, qpos), GeomPair.named(whole, geom1, geom2)).measured(speed, duration)


class PressedPoints(NamedTuple):
    """The contact points of a pair in a state.

    Args:
        distances, forces: of each [m], [N], shape (n,).
        friction: size of the sum of the forces along the face [N].
        slip: mean speed along the face [m/s].
    """

    distances: Array
    forces: Array
    friction: float
    slip: float


class ContactTest:
    """A pair of geoms in a copy of a model, in which it is moved together and released.

    Args:
        pose: the pose of the copy.
        pair: the geoms.
    """

    def __init__(self, pose: Pose, pair: GeomPair) -> None:
        self.pose, self.pair, self.model, self.row = pose, pair, pose.model, ModelRow.from_pair(pair)
        self.pose, _ = self.at(0.0)
        self.contact = inspected(pair, self.pose)

    def measured(self, speed: float, duration: float) -> Measurement:
        """The measurement, see `measure`."""
        contact, h = self.contact, float(self.model.opt.timestep)
        blows = [self.blow(speed, (phase + 0.5) / PHASES * speed * h) for phase in range(PHASES)]
        load = contact.load * contact.points
        depth = contact.load / contact.k_loaded if contact.k_loaded > 0 else math.nan
        at_rest, pressed, pushed = self.rest(0.0 if math.isnan(depth) else depth, duration)
        found_depth = -float(pressed.distances.mean()) if len(pressed.distances) else math.nan
        creep = MeasuredValue(math.nan, math.nan)
        if pushed.friction > 0:
            of_point = pushed.friction / max(len(pushed.forces), 1)
            creep = MeasuredValue(pushed.slip, self.row.creep(of_point, found_depth))
        return Measurement(
            contact,
            speed,
            restitution=MeasuredValue(float(np.mean([e for e, _ in blows])), contact.restitution_at(speed)),
            depth=MeasuredValue(found_depth, depth),
            force=MeasuredValue(float(pressed.forces.sum()), load),
            friction=pushed.friction,
            creep=creep,
            blow=blows[0][1],
            rest=at_rest,
        )

    def at(self, distance: float) -> tuple[Pose, mujoco.MjData]:
        """The pose in which the geoms are nearly at a distance of each other [m], and the state in which they are.

        Raises:
            ValueError: if the joints do not bring them there.
        """
        pose, first = self.pose, max(abs(self.pose.landing(self.pair).distance), 1e-3)
        for _ in range(MOST_MOVES):
            missing = distance - pose.landing(self.pair).distance
            place = np.array(pose.data.qpos)
            mujoco.mj_integratePos(self.model, place, self.meeting(pose).effective.motion, missing)
            if abs(missing) <= ARRIVED * first:
                state = state_alike(self.model, pose.data)
                state.qpos[:] = place
                return pose, state
            pose = self.pose.at_positions(place)
        raise ValueError(
            f"the joints do not bring geom1 and geom2 = {self.pair.labels} together from {self.pose.label}; give the "
            "pose in which they touch"
        )

    def meeting(self, pose: Pose) -> PairMeeting:
        """How the geoms meet in a pose.

        Raises:
            ValueError: if they cannot approach each other there.
        """
        met = meeting_of_geoms(self.pair, pose, law=PointLaw(self.row.mixed.sliding, self.row.k))
        if not met.effective.mass < math.inf:
            raise ValueError(f"geom1 and geom2 = {self.pair.labels} cannot approach each other at {self.pose.label}")
        return met

    def approach(self, pose: Pose) -> Array:
        """The change of the distance of the geoms with the joints in a pose, shape (nv,)."""
        landing, rate, side = pose.landing(self.pair), np.zeros(self.model.nv), np.zeros((3, self.model.nv))
        for body, points, sign in zip(self.pair.bodies, (landing.first, landing.second), (1.0, -1.0), strict=True):
            mujoco.mj_jac(self.model, pose.data, side, None, points.mean(axis=0), body)
            rate += sign * (landing.away @ side)
        return rate

    def blow(self, speed: float, distance: float) -> tuple[float, Array]:
        """The coefficient of restitution of a blow that begins at a distance [m], and its times [s] and distances [m]:
        zero if the geoms stay together."""
        pose, state = self.at(distance)
        rate, state.qvel[:] = self.approach(pose), -speed * self.meeting(pose).effective.motion
        path, touched = [(0.0, distance)], False
        period = math.sqrt(self.contact.moved / max(self.contact.k, 1e-300))
        longest = LONGEST_BLOW * max(1.0, self.contact.xi) * min(period, 1e3) + 20 * float(self.model.opt.timestep)
        while state.time < longest:
            time, leaves = float(state.time), float(rate @ state.qvel)
            mujoco.mj_step(self.model, state)
            distances = self.points(state).distances
            if touched and not len(distances):
                path.append((time, path[-1][1] + leaves * (time - path[-1][0])))
                return max(0.0, leaves) / speed, np.array(path)
            path.append((time, float(distances.min(initial=np.inf)) if len(distances) else distance - speed * time))
            touched |= len(distances) > 0
        return 0.0, np.array(path)

    def rest(self, depth: float, duration: float) -> tuple[Array, PressedPoints, PressedPoints]:
        """Times [s] and distances [m] at rest and while pushed, and the contact points at the end of each, on average
        over the last quarter."""
        _, state = self.at(-depth)
        force = self.row.mixed.sliding * PUSHED * self.contact.load * self.contact.points
        path: list[tuple[float, float]] = []
        ends = []
        for push in (0.0, force):
            state.xfrc_applied[self.body, :3] = push * self.along
            seen, end = [], state.time + duration
            while state.time < end:
                mujoco.mj_step(self.model, state)
                points = self.points(state)
                path.append((float(state.time), float(points.distances.mean()) if len(points.distances) else math.nan))
                if state.time > end - 0.25 * duration and len(points.distances):
                    seen.append(points)
            ends.append(_mean_points(seen))
        return np.array(path), ends[0], ends[1]

    @property
    def body(self) -> int:
        """The body that is pushed: the first that moves."""
        return next(body for body in self.pair.bodies if self.model.body_treeid[body] >= 0)

    @property
    def along(self) -> Array:
        """The direction along the face in which it is pushed, shape (3,)."""
        tangents = with_tangents(self.pose.landing(self.pair).away)[1:]
        return tangents[int(np.abs(tangents[1, 2]) < np.abs(tangents[0, 2]))]

    def points(self, state: mujoco.MjData) -> PressedPoints:
        """The contact points of the pair at the start of a step that was made."""
        chosen = [i for i in range(state.ncon) if {*state.contact.geom[i].tolist()} == {*self.pair.geoms}]
        forces, slip, held = np.zeros((len(chosen), 6)), np.zeros((len(chosen), 2)), np.zeros(3)
        side = np.zeros((3, self.model.nv))
        for row, i in enumerate(chosen):
            mujoco.mj_contactForce(self.model, state, i, forces[row])
            frame = state.contact.frame[i].reshape(3, 3)
            held += frame[1:].T @ forces[row, 1:3]
            for body, sign in zip(self.pair.bodies, (1.0, -1.0), strict=True):
                mujoco.mj_jac(self.model, state, side, None, state.contact.pos[i], body)
                slip[row] += sign * (frame[1:] @ (side @ state.qvel))
        size = np.linalg.norm(slip, axis=1)
        return PressedPoints(
            np.array(state.contact.dist[chosen]) if chosen else np.zeros(0),
            forces[:, 0],
            float(np.linalg.norm(held)),
            float(size.mean()) if chosen else 0.0,
        )


def _mean_points(seen: Sequence[PressedPoints]) -> PressedPoints:
    """The mean of points of several steps; those with another number of points than the last are left out."""
    if not seen:
        return PressedPoints(np.zeros(0), np.zeros(0), 0.0, 0.0)
    alike = [points for points in seen if len(points.forces) == len(seen[-1].forces)]
    return PressedPoints(
        np.mean([points.distances for points in alike], axis=0),
        np.mean([points.forces for points in alike], axis=0),
        float(np.mean([points.friction for points in alike])),
        float(np.mean([points.slip for points in alike])),
    )
