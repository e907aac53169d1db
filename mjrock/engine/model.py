"""The compiled model of a scene, and its release."""

from __future__ import annotations

import logging
import math
from collections import OrderedDict, deque
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import mujoco
import numpy as np

from ..contacts.solref import body_weight
from ..quantities import Array, Flags
from ..result.ledger import StepError
from ..scene.course import Course
from ..scene.scene import Scene
from .memory import EngineArrays
from .mjcf import FixedRows, Keyframe, pair_rows, scene_mjcf
from .record import Record

CHUNK = 1_000
"""Steps after which a loop returns to Python, for progress, warnings of the engine and interruptions by the user."""
MARGIN_OF_ALL = 1e6
"""Margin with which every contact is closed [m]."""
SCENES_KEPT, ENGINES_KEPT = 16, 4
"""Scenes whose compiled models are kept for further runs, and most models of one scene."""
TEXT_STEP = 1e-3
"""Step of the text that is compiled [s]."""


def _log(text: str) -> None:
    """Log a warning of MuJoCo, which would otherwise write MUJOCO_LOG.TXT into the current folder."""
    logging.getLogger("mujoco").warning(text)


if mujoco.get_mju_user_warning() is None:
    mujoco.set_mju_user_warning(_log)


class SimulationError(RuntimeError):
    """A run broke down: NaN, a warning of the engine, or energy from nowhere. The message says what to change."""


@dataclass(frozen=True)
class Engine:
    """A compiled model, its data, their memory, and room for a chunk of steps."""

    model: mujoco.MjModel
    data: mujoco.MjData
    memory: EngineArrays
    room: Record

    @classmethod
    def compile(cls, scene: Scene) -> Engine:
        """Compile the text of a scene, and make sure that MuJoCo weighs its contacts as the text presumes.

        Raises:
            SimulationError: if MuJoCo weighs a body otherwise, or numbers the contacts otherwise.
        """
        return cls.from_model(mujoco.MjModel.from_xml_string(scene_mjcf(scene, TEXT_STEP)), scene)

    @classmethod
    def from_model(cls, model: mujoco.MjModel, scene: Scene) -> Engine:
        """The engine of a model that was compiled from the text of a scene. It raises what `compile` raises."""
        inverse = body_weight(scene.bodies.mass, scene.freedom.translations)
        for j, name in enumerate(scene.bodies.names):
            weighed = float(model.body_invweight0[j + 1, 0])
            if not math.isclose(weighed, inverse[j], rel_tol=1e-9):
                raise SimulationError(
                    f"MuJoCo {mujoco.__version__} gives the body {name} the inverse weight {weighed:g} 1/kg instead of "
                    f"{inverse[j]:g} 1/kg: its contact stiffness would not be the requested one"
                )
        if tuple(model.pair(i).name for i in range(model.npair)) != scene.contacts.point_names:
            raise SimulationError(f"MuJoCo {mujoco.__version__} does not keep the order of the contacts in the text")
        data = mujoco.MjData(model)
        require_room(model, data)
        return cls(
            model,
            data,
            EngineArrays.from_model(model, data),
            Record.with_room(CHUNK, (model.nq, model.nv), model.npair, len(scene.links.damped.names)),
        )

    def set_step(self, timestep: float, fixed: FixedRows) -> None:
        """Set the step [s], the rows of all contacts and the dashpots of links."""
        self.model.opt.timestep, self.model.opt.impratio = timestep, fixed.impratio
        for values, new in zip(self.memory.rows, fixed.rows, strict=True):
            values[:] = new
        self.model.tendon_damping[:] = fixed.damping

    def place(self, course: Course) -> None:
        """Set pose and velocity of the start, see `set_state`."""
        set_state(self.model, self.data, course.pose.ravel(), course.velocity.ravel())

    @property
    def closed(self) -> Flags:
        """Which contacts the engine found closed last, shape (m,). Gaps may be zero to rounding."""
        pairs = np.sort(np.column_stack([self.model.pair_geom1, self.model.pair_geom2]), axis=1)
        met = np.sort(self.data.contact.geom, axis=1)
        closed: Flags = (pairs[:, None] == met[None]).all(axis=2).any(axis=1)
        return closed

    def release(self, course: Course) -> None:
        """Set pose and velocity of the start, the velocity half a step back, see `set_release`."""
        set_release(self.model, self.data, course.pose.ravel(), course.velocity.ravel())


def set_state(model: mujoco.MjModel, data: mujoco.MjData, pose: Array, velocity: Array) -> None:
    """Set qpos and qvel of a start.

    Ties that the pose stretches too far have yielded: MuJoCo lets a tie yield at the end of a step, and the first step
    would have its whole elastic force.
    """
    mujoco.mj_resetData(model, data)
    data.qpos[:], data.qvel[:] = pose, velocity
    if model.nplastic:
        mujoco.mj_fwdPosition(model, data)
        yields = np.flatnonzero(model.tendon_plasticadr >= 0)
        lower = model.tendon_plasticadr[yields]  # of the range in which a tie is slack, the upper end behind it
        length, stretch = data.ten_length[yields], model.tendon_springyield[yields]
        pushes = data.plastic[lower] == data.plastic[lower + 1]
        data.plastic[lower + 1] = np.maximum(data.plastic[lower + 1], length - stretch)
        shorter = np.minimum(data.plastic[lower + 1], length + stretch)[pushes]
        data.plastic[lower[pushes]] = data.plastic[lower[pushes] + 1] = shorter
    mujoco.mj_forward(model, data)  # an error of the engine is one of Python here, and the end in a compiled loop


def set_release(model: mujoco.MjModel, data: mujoco.MjData, pose: Array, velocity: Array) -> None:
    """Set qpos and qvel of a start, the velocity half a step back, where the leapfrog keeps it.

    Before the release the ground is quiet. Contacts that slide have their rows.
    """
    set_state(model, data, pose, velocity)
    for _ in range(10):  # the dashpots act on the velocity that is being set: a contraction, exact to rounding
        mujoco.mj_forward(model, data)
        data.qvel[:] = velocity - 0.5 * model.opt.timestep * data.qacc


def require_finite(data: mujoco.MjData, t: float) -> None:
    """Raise a StepError with the time [s] if the engine has warned, or the state is not finite."""
    warned = [mujoco.mjtWarning(i).name for i in np.flatnonzero(data.warning.number)]
    if warned or not (np.isfinite(data.qpos).all() and np.isfinite(data.qvel).all()):
        raise StepError(f"MuJoCo warned ({', '.join(warned)})" if warned else "the state is not finite", t)


def require_room(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Make sure that the memory of the engine holds all contacts at once: in a compiled loop an overflow would end the
    process.

    The contacts are found once with a margin with which every pair of geoms is in contact, through the bindings, which
    raise an error.

    Raises:
        SimulationError: if it does not.
    """
    margin, iterations = model.pair_margin.copy(), model.opt.iterations
    model.pair_margin[:], model.opt.iterations = MARGIN_OF_ALL, 1
    try:
        mujoco.mj_forward(model, data)
        full = data.ncon < model.npair or data.warning.number.any()
    except mujoco.FatalError:
        full = True
    model.pair_margin[:], model.opt.iterations = margin, iterations
    mujoco.mj_resetData(model, data)
    if full:
        raise SimulationError(
            f"the memory of MuJoCo {mujoco.__version__} does not hold the {model.npair} contact lines of this scene at "
            "once; give its joints fewer points, or fewer blocks"
        )


_idle: OrderedDict[str, deque[Engine]] = OrderedDict()


@contextmanager
def engine_of(scene: Scene) -> Iterator[Engine]:
    """An engine for a scene, taken from those of earlier runs where one is idle. It is kept for the next run.

    Runs of one wall under many motions share the text, the compilation and the data. Two threads never share an engine.
    Each run finds it with the step and the rows of the text of its scene, whatever ran before.
    """
    try:
        engine = _idle[scene.key].pop()
    except (KeyError, IndexError):
        engine = Engine.compile(scene)
    engine.set_step(TEXT_STEP, pair_rows(scene, TEXT_STEP))
    yield engine
    _idle.setdefault(scene.key, deque(maxlen=ENGINES_KEPT)).append(engine)  # one whose run has failed is not kept
    while len(_idle) > SCENES_KEPT:
        _idle.popitem(last=False)


def released_mjcf(scene: Scene, course: Course, timestep: float, newmark_beta: float = 0.25) -> str:
    """The text of a scene whose keyframe has the velocity half a step before the release, as the engine finds it."""
    with engine_of(scene) as engine:
        engine.set_step(timestep, pair_rows(scene, timestep, newmark_beta))
        engine.release(course)
        keyframe = Keyframe(course.pose, engine.data.qvel.reshape(len(scene.bodies.names), -1), engine.data.plastic)
        return scene_mjcf(scene, timestep, newmark_beta, keyframe)
