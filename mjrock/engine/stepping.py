"""Steps of MuJoCo: of one length, or fitted to the motion so that every touch is centred in time.

A wall rocks smoothly for a second and then hits something for milliseconds. Fitted steps are long while nothing new
touches, land half a short step behind every touch, and are short until the contacts have died down. The loops that make
them are in `mjrock.engine.loop`. This module starts them, looks at the engine from time to time, and collects the
steps.
"""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np
from tqdm import tqdm

from .ground import Ground
from .kinematics import frame_of, stretch
from .loop import Clock, State, fitted_loop, fixed_loop
from .model import Engine
from .pace import SMOOTH, Pace
from .scene import Scene
from .steps import Record, StepError, Steps
from .sticking import Joints
from .touches import Springs


def fitted_steps(engine: Engine, scene: Scene, accuracy: float) -> Steps:
    """Steps that fit the motion, until the duration of the scene or until a body lies on its face.

    The engine has to be at the release, with the step and the rows of `Pace.short`.

    Raises:
        StepError: if the engine warns or the state is not finite.
    """
    pace, ground, joints = Pace.of(scene, accuracy), Ground.of(scene.motion, scene.vertical), Joints.of_scene(scene)
    ties = scene.ties._replace(reach=np.array(scene.ties.reach))  # they yield in this run alone
    for i in range(len(ties.k)):
        stretch(ties, i, frame_of(engine.memory.pose), engine.memory.velocity)
    state = State.of(engine.memory, Springs.of(scene.points, ties))
    energy = max(2 * scene.release_energy, pace.least_energy)
    clock = Clock(0.0, pace.short, pace.short, energy, 0, True, False, 0, False)

    def advance(record: Record) -> tuple[int, float, bool]:
        nonlocal clock
        clock, n = fitted_loop(
            engine.memory, scene.points, ties, scene.masses, ground, pace, joints, state, clock, record, scene.duration
        )
        return n, clock.t, clock.ended

    made = _recorded(engine, scene, advance)
    kind = (made.h * pace.frequency >= SMOOTH).astype(np.int64)
    return Steps(*made, pace.beta, pace.ringing, kind, clock.touches)


def fixed_steps(engine: Engine, scene: Scene, timestep: float, newmark_beta: float) -> Steps:
    """Steps of one length, until the duration of the scene or until a body lies on its face.

    The engine has to be at the release, with the step and the rows of that length.

    Raises:
        StepError: if the engine warns or the state is not finite.
    """
    last, ground, done = max(1, round(scene.duration / timestep)), Ground.of(scene.motion, scene.vertical), 0

    def advance(record: Record) -> tuple[int, float, bool]:
        nonlocal done
        ended, n = fixed_loop(engine.memory, scene.masses, ground, record, done, timestep, last)
        done += n
        return n, done * timestep, ended

    made = _recorded(engine, scene, advance)
    beta, none = np.full((2, len(scene.k)), newmark_beta), np.zeros((2, len(scene.k)))
    return Steps(*made, beta, none, np.zeros(len(made.t), dtype=np.int64))


def _recorded(engine: Engine, scene: Scene, advance: Callable[[Record], tuple[int, float, bool]]) -> Record:
    """The steps of a run, made a chunk at a time. `advance` fills a record: how many steps, the time, whether it
    ends."""
    chunks, t, ended = [], 0.0, False
    with tqdm(total=scene.duration, desc="MuJoCo", unit="s", delay=3, disable=None, leave=False) as bar:
        while not ended:
            n, t, ended = advance(engine.room)
            chunks.append(engine.room.first(n))
            bar.update(min(t, scene.duration) - bar.n)
            warned = [mujoco.mjtWarning(i).name for i in np.flatnonzero(engine.data.warning.number)]
            if warned or not (np.isfinite(engine.memory.pose).all() and np.isfinite(engine.memory.velocity).all()):
                raise StepError(f"MuJoCo warned ({', '.join(warned)})" if warned else "the state is not finite", t)
    return Record.joined(chunks)
