"""Steps of MuJoCo: of one length, or fitted to the motion so that every touch is centred in time.

A wall rocks smoothly for a second and then hits something for milliseconds. Fitted steps are long while nothing new
touches, land half a short step behind every touch, and are short until the contacts have died down. The loops that make
them are in `mjrock.engine.loop`. This module starts them, looks at the engine from time to time, and collects the
steps.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..bars import Bar
from ..compiled import compiled
from ..geometry.frames import frames_of, take_frames
from ..geometry.kinematics import Places, meeting
from ..geometry.vectors import dot
from ..method import METHOD, Method
from ..quantities import Array
from ..scene.course import Course
from ..scene.scene import Scene
from .loop import Progress, clock_at_start, fitted_loop, fixed_loop, release, settle_ties
from .model import Engine, require_finite
from .record import Record, StepKinds, Steps
from .setting import Setting
from .shapes import PLATE
from .sliding import Sliding
from .step_control import StepControl
from .sticking import Joints


def fitted_steps(
    engine: Engine, scene: Scene, course: Course, accuracy: float, *, coulomb: bool = True, method: Method = METHOD
) -> Steps:
    """Steps that fit the motion, until the duration of the course, or a body lies on its face or has left another.

    The engine is at the start, see `Engine.place`. With `coulomb` contacts that slide obey Coulomb's law.

    Raises:
        StepError: if the engine warns or the state is not finite.
    """
    setting = Setting.of_run(scene, course, method)
    if setting.splits:
        method = method.on_moving_ground()
        setting = Setting.of_run(scene, course, method)
    memory, control = engine.memory, StepControl.from_scene(scene, course, accuracy, method)
    places, released_on = setting.points.places, engine.closed
    engine.model.tendon_damping[:] = 0.0  # dampers act as applied forces, at the velocity of the pose
    settle_ties(memory, setting, frames_of(memory.pose, places.freedom))
    sliding = Sliding.at_start(setting.points, coulomb=coulomb, method=method)
    state = Progress.at_start(memory, setting, Joints.of_scene(scene), sliding)
    clocks = clock_at_start(control, course.energy(scene))
    clock = clocks[0]

    def advance(record: Record) -> tuple[int, float, bool]:
        fitted_loop(memory, setting, control, state, clocks, record)
        return int(clock.steps), float(clock.t), bool(clock.ended)

    record = on_plates(_recorded(engine, course.duration, advance), scene)
    kind = (record.h * control.frequency >= method.smooth).astype(np.int64)
    kinds = StepKinds(control.beta, control.ringing, kind, released_on)
    return Steps(record, kinds, touches=int(clock.touches), method=method, freedom=places.freedom)


def fixed_steps(
    engine: Engine, scene: Scene, course: Course, newmark_beta: float, *, coulomb: bool = False, method: Method = METHOD
) -> Steps:
    """Steps of one length, until the duration of the course, or a body lies on its face or has left another.

    The engine is at the release, with the step and the rows of that length. With `coulomb` contacts that slide obey
    Coulomb's law; without it they have the rows of the model text.

    Raises:
        StepError: if the engine warns or the state is not finite.
    """
    memory, setting, done = engine.memory, Setting.of_run(scene, course, method, refines=False), 0
    timestep = float(engine.model.opt.timestep)
    sliding, released_on = Sliding.at_start(setting.points, coulomb=coulomb, method=method), engine.closed
    frames = frames_of(memory.pose, setting.points.places.freedom)
    if sliding.coulomb:
        release(memory, setting, sliding, frames, memory.velocity + 0.5 * timestep * memory.acceleration)

    def advance(record: Record) -> tuple[int, float, bool]:
        nonlocal done
        ended, n = fixed_loop(memory, setting, sliding, frames, record, done)
        done += n
        return n, done * timestep, ended

    record, contacts = on_plates(_recorded(engine, course.duration, advance), scene), len(scene.contacts.k)
    kind = np.zeros(len(record.t), dtype=np.int64)
    kinds = StepKinds(np.full((2, contacts), newmark_beta), np.zeros((2, contacts)), kind, released_on)
    return Steps(record, kinds, method=method, freedom=setting.points.places.freedom)


def _recorded(engine: Engine, duration: float, advance: Callable[[Record], tuple[int, float, bool]]) -> Record:
    """The steps of a run, made a chunk at a time.

    `advance` fills a record, and returns how many steps it has, the time [s], and whether the run is over.
    """
    chunks, t, ended = [], 0.0, False
    with Bar("MuJoCo", "s", duration) as bar:
        while not ended:
            n, t, ended = advance(engine.room)
            chunks.append(engine.room.first(n))
            bar.to(t)
            require_finite(engine.data, t)
    return Record.joined(chunks)


def on_plates(record: Record, scene: Scene) -> Record:
    """The steps before a point has passed the end of the plate that stands for a face of a body, and lies lower than
    it. The engine has no contact there, and no law of contacts holds."""
    places, reach = scene.places, PLATE * scene.bodies.extent
    if not (places.face_body >= 0).any():
        return record
    count = _on_plates(places, reach, record.pose, scene.freedom.frames(len(scene.bodies.names)))
    return record if count == len(record.t) else record.first(max(count, 1))


@compiled
def _on_plates(places: Places, reach: float, pose: Array, frames: Array) -> int:
    for n in range(len(pose)):
        take_frames(pose[n], frames, places.axes)
        for i in range(len(places.body)):
            if places.face_body[i] >= 0:
                meets = meeting(places, i, frames)
                if meets.gap < 0 and dot(meets.offset, meets.offset) - meets.gap * meets.gap > reach * reach:
                    return n
    return len(pose)
