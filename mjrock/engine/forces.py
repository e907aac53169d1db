"""Forces of contacts, links and fixed blocks in steps that were made, from poses and half-step velocities.

What a row of the engine pushed follows from the record: along the normal from the gap, its rate and the acceleration of
the step, and along the face from the slip that was left after it. The loops keep nothing for this.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..compiled import compiled
from ..geometry.frames import place
from ..geometry.kinematics import meeting, relative_velocity, where_friction_acts
from ..geometry.vectors import increase, moment, plus, scaled, vector
from ..problem.masonry.case import AnyCase
from ..quantities import Array, Integers
from ..result.bodies import BodyMotion
from ..result.forces import Forces, KeptForces, forces_of
from ..result.ties import Plastic, motion_of_ties
from ..scene.scene import Scene
from .energy_work import LedgerRoom, contact_in_step, take_step
from .record import Record, StepKinds, Steps, Windows
from .rows import Points, points_of
from .sliding import slip_of


class JointLoads(NamedTuple):
    """Forces of the contacts on joints and fixed blocks, with the steps, joints and blocks that they belong to.

    Args:
        steps: numbers of the steps, shape (n,).
        sense: 1 where the body of a contact is above its joint or -1, shape (m,).
        fixed: number of the fixed block below each joint, or -1, shape (joints,).
        rest: centroids of the bodies at rest [m].
        loads, contact_reactions: see `KeptForces`.
    """

    steps: Integers
    sense: Array
    fixed: Integers
    rest: Array
    loads: Array
    contact_reactions: Array


def kept_forces(case: AnyCase, scene: Scene, steps: Steps, t: Array, plastic: Mapping[str, Plastic]) -> Forces:
    """The forces at samples: those of the steps in whose windows the samples lie, see `record.Windows`.

    Args:
        case, scene, steps: the run.
        t: times of the samples [s], shape (n,).
        plastic: what ties have yielded, by tie.
    """
    chosen, sample = np.unique(np.searchsorted(steps.windows.t, t, side="right") - 1, return_inverse=True)
    frames, d = case.rest_geometry.frames, scene.freedom.translations
    room = np.zeros((len(chosen), len(frames.names), scene.freedom.nv)), np.zeros((len(chosen), len(frames.blocks), d))
    loads = JointLoads(chosen, scene.sense, frames.fixed, frames.rest, *room)
    points = points_of(scene, steps.method)
    _gather(points, steps.record, steps.windows, steps.kinds, LedgerRoom.for_scene(scene), loads)
    pose = steps.pose.reshape(len(steps.t), -1, scene.freedom.nq)
    ties = motion_of_ties(BodyMotion(case, steps.t, pose), plastic)
    step_of_sample = chosen[sample]
    of_links = {name: ties[name].force[step_of_sample] for name in scene.links.sprung.names}
    of_links |= dict(zip(scene.links.damped.names, -steps.record.damping[step_of_sample].T, strict=True))
    kept = KeptForces(
        t=steps.t[step_of_sample],
        pose=pose[step_of_sample],
        loads=loads.loads[sample],
        contact_reactions=loads.contact_reactions[sample],
        links=of_links,
    )
    return forces_of(case, frames, kept)


@compiled
def _gather(
    points: Points, record: Record, windows: Windows, kinds: StepKinds, room: LedgerRoom, into: JointLoads
) -> None:
    places, axes = points.places, points.places.axes
    for row in range(len(into.steps)):
        n = into.steps[row]
        recorded = take_step(points, record, windows, kinds, n, room)
        for i in range(len(places.k)):
            contact = contact_in_step(points, record, recorded, room, i)
            if not kinds.released_on[i] if n == 0 else contact.gap >= 0:
                continue
            meets = where_friction_acts(places, meeting(places, i, room.frames))
            slipping = room.middle if contact.coulomb else record.after[n]
            direction = slip_of(meets.normal, relative_velocity(places, i, meets, room.frames, slipping)).direction
            force = plus(scaled(contact.row, meets.normal), scaled(contact.along, direction))
            body, joint = places.body[i], places.joint[i]
            at = plus(vector(into.rest, body, axes), plus(place(room.frames, body, axes), meets.arm))
            load = into.loads[row, joint]
            increase(load, scaled(into.sense[i], force))
            increase(load[len(axes) :], scaled(into.sense[i], moment(at, force)))
            if into.fixed[joint] >= 0:
                increase(into.contact_reactions[row, into.fixed[joint]], force)
