"""`mjrock view scene.xml answer.csv`: a model in MuJoCo's viewer that replays an answer and goes on."""

from __future__ import annotations

import argparse
import contextlib
import csv
import math
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from ..command_line import Answer, parser
from ..contacts.files import require_file
from ..contacts.geoms import load
from ..quantities import Array, require_within

FRAME = 1 / 60
"""Time between two pictures [s]."""
SPACE_KEY, BACKSPACE_KEY = 32, 259
"""Keys, as the viewer numbers them."""
KEYFRAME = "release"
ENDED = "The window was closed"
PAUSED, REPLAYED, SIMULATED = "paused", "replay", "simulation"
BROKEN = "stopped: the model has only the contacts of rest"
"""The message where blocks have come so far from their joints that MuJoCo cannot follow them."""
TILTED = math.sqrt(0.5)
"""Cosine of the tilt from which a block has fallen, as in `mjrock.result.joint_motion` [-]."""
LOOKS = 64
"""Most samples of an answer that the camera is fitted to."""
BAD = mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC
QUATERNION = tuple(f"quaternion {part}{{of}} [-]" for part in "wxyz")
COORDINATES = {
    mujoco.mjtJoint.mjJNT_SLIDE: ("{axis}{of} [m]",),
    mujoco.mjtJoint.mjJNT_HINGE: ("rotation{of} [rad]",),
    mujoco.mjtJoint.mjJNT_BALL: QUATERNION,
    mujoco.mjtJoint.mjJNT_FREE: (*(f"{axis}{{of}} [m]" for axis in "xyz"), *QUATERNION),
}
"""Columns of `Response.csv` with the coordinates of a joint."""
OTHER = ("the joint {axis}{of}",)
"""The column that a joint of another model misses."""


def read_motion(model: mujoco.MjModel, path: Path) -> tuple[Array, Array]:
    """Times [s], shape (n,), and coordinates of all joints, shape (n, nq), from a file of `Response.csv`.

    Raises:
        ValueError: if it is no such file, or is not the motion of this model.
    """
    try:
        with open(require_file(path), encoding="utf-8", newline="") as file:
            header = next(csv.reader(file))
            values = np.loadtxt(file, delimiter=",", ndmin=2)
    except (StopIteration, UnicodeDecodeError, ValueError) as error:
        raise ValueError(f"answer {path} is not a file of Response.csv: {error or 'it is empty'}") from None
    missing = next((name for name in ("t [s]", *columns_of(model)) if name not in header), None)
    if missing is not None:
        raise ValueError(f"answer {path} has no column {missing!r}: it is not a motion of this model")
    if values.shape[1] != len(header) or not np.isfinite(values).all():
        raise ValueError(f"answer {path} has rows with other than {len(header)} numbers")
    t = values[:, header.index("t [s]")]
    if len(t) < 2 or not (np.diff(t) >= 0).all() or not t[-1] > t[0]:
        raise ValueError(f"answer {path} has {len(t)} samples whose times [s] do not grow")
    places = values[:, [header.index(name) for name in columns_of(model)]]
    for i in np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE):  # displacements are from rest
        at = model.jnt_qposadr[i]
        places[:, at : at + 3] += model.qpos0[at : at + 3]
    return t, places


def columns_of(model: mujoco.MjModel) -> list[str]:
    """The columns of `Response.csv` for the coordinates of a model of this package, in their order."""
    names = []
    for i in range(model.njnt):
        joint = model.joint(i)
        body, _, axis = joint.name.rpartition("_")
        kind = COORDINATES.get(mujoco.mjtJoint(model.jnt_type[i]), OTHER)
        if model.jnt_type[i] == mujoco.mjtJoint.mjJNT_FREE and axis != "free":
            kind = OTHER
        names += [name.format(axis=axis, of=f" of {body}" if body else "") for name in kind]
    return names


class Replay:
    """A model that follows an answer, and is simulated from its end, or from its release where there is none.

    Args:
        model: the model.
        motion: times [s], shape (n,), and coordinates, shape (n, nq); or None.
    """

    def __init__(self, model: mujoco.MjModel, motion: tuple[Array, Array] | None = None) -> None:
        self.model, self.data, self.motion = model, mujoco.MjData(model), motion
        self.restart()

    @property
    def is_replayed(self) -> bool:
        """Whether the samples of the answer are not over yet."""
        return self.motion is not None and bool(self.data.time < self.motion[0][-1])

    @property
    def is_broken(self) -> bool:
        """Whether MuJoCo cannot go on: its state is no number, or a block of this package lies."""
        own = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_TEXT, "mjrock") >= 0
        fell = own and bool((self.data.xmat[1:, 8] < TILTED).any())
        return fell or any(self.data.warning[kind].number > 0 for kind in BAD)

    @property
    def state(self) -> str:
        """What is shown, in words."""
        return REPLAYED if self.is_replayed else BROKEN if self.is_broken else SIMULATED

    @property
    def frame(self) -> tuple[Array, float] | None:
        """Middle of all that is seen to move in the answer [m], shape (3,), and half of its diagonal [m]; None without
        one."""
        model, data = self.model, mujoco.MjData(self.model)
        seen = (model.body_weldid[model.geom_bodyid] > 0) & (model.geom_group < 3)
        if self.motion is None or not seen.any():
            return None
        places, reach = self.motion[1], model.geom_rbound[seen, None]
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for sample in np.unique(np.linspace(0, len(places) - 1, LOOKS).astype(int)):
            data.qpos[:] = places[sample]
            mujoco.mj_kinematics(model, data)
            at = data.geom_xpos[seen]
            low, high = np.minimum(low, (at - reach).min(axis=0)), np.maximum(high, (at + reach).max(axis=0))
        return 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low))

    def restart(self) -> None:
        """Go to the first sample, or to the release."""
        key = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_KEY, KEYFRAME)
        if key < 0:
            mujoco.mj_resetData(self.model, self.data)
        else:
            mujoco.mj_resetDataKeyframe(self.model, self.data, key)
        if self.motion is not None:
            self._show(0)
        mujoco.mj_forward(self.model, self.data)

    def advance(self, duration: float) -> None:
        """Go on by a duration [s]: to the last sample before its end, or by steps of the model."""
        end = self.data.time + duration
        if self.motion is not None and self.is_replayed:
            t = self.motion[0]
            self._show(int(np.searchsorted(t, end, "right")) - 1)
            self.data.time = min(end, t[-1])
            mujoco.mj_forward(self.model, self.data)
            return
        began = time.perf_counter()
        while self.data.time < end - 0.5 * self.model.opt.timestep and not self.is_broken:
            mujoco.mj_step(self.model, self.data)
            if time.perf_counter() - began > 2 * FRAME:
                return

    def _show(self, sample: int) -> None:
        """Take the coordinates of a sample, and the mean velocity since the one before."""
        assert self.motion is not None
        t, places = self.motion
        before = int(np.searchsorted(t, t[sample])) - 1
        self.data.time, self.data.qpos[:] = t[sample], places[sample]
        self.data.qvel[:] = 0.0
        if before >= 0:
            mujoco.mj_differentiatePos(
                self.model, self.data.qvel, t[sample] - t[before], places[before], places[sample]
            )


def show(replay: Replay, launch: Callable[..., Any], speed: float) -> None:
    """Replay and simulate in a window until it is closed.

    Args:
        replay: what is shown.
        launch: `mujoco.viewer.launch_passive`.
        speed: seconds of the motion in a second [-].
    """
    pressed: list[int] = []
    runs, last = True, time.perf_counter()
    panels = {"show_left_ui": False, "show_right_ui": False}  # Tab and Shift+Tab show them
    with launch(replay.model, replay.data, key_callback=pressed.append, **panels) as window:
        with window.lock():
            mujoco.mjv_defaultFreeCamera(replay.model, window.cam)
            if replay.frame is not None:
                window.cam.lookat[:], half = replay.frame
                window.cam.distance = half / math.sin(math.radians(0.5 * replay.model.vis.global_.fovy))
        while window.is_running():
            while pressed:
                key = pressed.pop(0)
                runs ^= key == SPACE_KEY
                if key == BACKSPACE_KEY:
                    replay.restart()
            now = time.perf_counter()
            if runs:
                replay.advance(speed * (now - last))
            last = now
            text = f"{replay.state if runs else PAUSED}\n{replay.data.time:.2f} s"
            window.set_texts((None, mujoco.mjtGridPos.mjGRID_BOTTOMLEFT, text, ""))
            window.sync()
            time.sleep(max(0.0, FRAME - (time.perf_counter() - now)))


def launcher() -> Callable[..., Any]:
    """`mujoco.viewer.launch_passive`, where a window can be opened.

    Raises:
        OSError: with what is needed, where none can.
    """
    needs = (
        "the viewer needs a display: a desktop, `ssh -X`, or `xvfb-run` for a virtual one. Without one, "
        "plotting.view writes a page for any browser and plotting.animate a film"
    )
    try:
        import glfw
        from mujoco import viewer
    except (ImportError, RuntimeError) as error:
        raise OSError(f"{needs} ({error})") from None
    if sys.platform != "darwin":  # there MuJoCo's own launcher, mjpython, has the main thread and does this
        glfw.ERROR_REPORTING = "ignore"
        if not glfw.init():
            raise OSError(needs)
    return viewer.launch_passive


def arguments() -> argparse.ArgumentParser:
    """The arguments of the command line."""
    keys = "Space stops and goes on, Backspace begins again. On macOS: mjpython -m mjrock view ..."
    made = parser("view", f"{__doc__}\n{keys}")
    made.add_argument("model", type=Path, help="MJCF file, such as mjcf_of writes, or a compiled .mjb")
    made.add_argument("answer", type=Path, nargs="?", help="its motion, a file of Response.csv; none simulates at once")
    made.add_argument("--speed", type=float, default=1.0, help="seconds of the motion in a second, 0.001 to 1000")
    return made


@contextlib.contextmanager
def unwarned() -> Iterator[None]:
    """Leave out the warnings of MuJoCo, which the window shows itself."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda text: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


def answer(argv: Sequence[str]) -> Answer:
    """Open the window with the model that is named; the text says until when it was followed.

    Raises:
        ValueError, OSError: for what the user can mend, or where there is no display.
    """
    args = arguments().parse_args(argv)
    speed = require_within("speed", args.speed, 1e-3, 1e3)
    model = load(args.model)
    replay = Replay(model, None if args.answer is None else read_motion(model, args.answer))
    with unwarned(), contextlib.suppress(KeyboardInterrupt):
        try:
            show(replay, launcher(), speed)
        except RuntimeError as error:
            if "mjpython" not in str(error):
                raise
            raise OSError("on macOS MuJoCo's launcher opens the window: mjpython -m mjrock view ...") from None
    return Answer(f"{ENDED} at {replay.data.time:.3g} s.")
