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
from .loop import Clock, Progress, fitted_loop, fixed_loop, release
from .model import Engine
from .pace import SMOOTH, Pace
from .scene import Scene
from .sliding import Sliding
from .steps import Record, StepError, Steps
from .sticking import Joints
from .touches import Springs


def fitted_steps(engine: Engine, scene: Scene, accuracy: float, *, coulomb: bool = True) -> Steps:
    """Steps that fit the motion, until the duration of the scene or until a body lies on its face.

    Args:
        engine: of the scene, with pose and velocity of the start, see `Engine.place`.
        scene: the scene.
        accuracy: the relative tolerance that is aimed at [-].
        coulomb: whether contacts that slide obey Coulomb's law, see `mjrock.engine.sliding`.

    Raises:
        StepError: if the engine warns or the state is not finite.
    """
    pace, ground, joints = Pace.of(scene, accuracy), Ground.of(scene.motion, scene.vertical), Joints.of_scene(scene)
    ties = scene.ties._replace(reach=np.array(scene.ties.reach))  # they yield in this run alone
    for i in range(len(ties.k)):
        stretch(ties, i, frame_of(engine.memory.pose), engine.memory.velocity)
    sliding, released_on = Sliding.of(scene.points, coulomb=coulomb), engine.closed
    state = Progress.of(engine.memory, Springs.of(scene.points, ties))
    energy = max(2 * scene.release_energy, pace.least_energy)
    clock = Clock(0.0, pace.short, 0.0, energy, 0, True, False, 0, False)

    def advance(record: Record) -> tuple[int, float, bool]:
        nonlocal clock
        values, n = fitted_loop(
            *(engine.memory, scene.points, ties, scene.masses, ground, pace, joints, sliding),
            *(state, clock, record, scene.duration),
        )
        clock = Clock(*values)
        return n, clock.t, clock.ended

    made = _recorded(engine, scene, advance)
    kind = (made.h * pace.frequency >= SMOOTH).astype(np.int64)
    return Steps(*made[:5], pace.beta, pace.ringing, kind, made.friction, released_on, clock.touches)


def fixed_steps(engine: Engine, scene: Scene, timestep: float, newmark_beta: float, *, coulomb: bool = False) -> Steps:
    """Steps of one length, until the duration of the scene or until a body lies on its face.

    Args:
        engine: of the scene, at the release, with the step and the rows of that length.
        scene: the scene.
        timestep: length of the steps [s].
        newmark_beta: Newmark's beta of the rows [-].
        coulomb: whether contacts that slide obey Coulomb's law, see `mjrock.engine.sliding`; without it they have the
            rows of the model text.

    Raises:
        StepError: if the engine warns or the state is not finite.
    """
    last, ground, done = max(1, round(scene.duration / timestep)), Ground.of(scene.motion, scene.vertical), 0

    sliding = Sliding.of(scene.points, coulomb=coulomb)
    memory, frame, released_on = engine.memory, frame_of(engine.memory.pose), engine.closed
    if sliding.coulomb:
        velocity = memory.velocity + 0.5 * timestep * memory.acceleration
        release(memory, scene.points, ground, scene.masses, sliding, frame, velocity)

    def advance(record: Record) -> tuple[int, float, bool]:
        nonlocal done
        fixed = memory, scene.points, scene.masses, ground, sliding, frame, record, done, timestep, last
        ended, n = fixed_loop(*fixed)
        done += n
        return n, done * timestep, ended

    made = _recorded(engine, scene, advance)
    beta, none = np.full((2, len(scene.k)), newmark_beta), np.zeros((2, len(scene.k)))
    return Steps(*made[:5], beta, none, np.zeros(len(made.t), dtype=np.int64), made.friction, released_on)


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
