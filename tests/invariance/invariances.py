"""Changes of a scene that must not change its answer, or change it in a known way, and what may differ.

Each invariance is a function of a `Trial`. It answers how far its motion is from the one that it should be, over the
size of the scene [-], or None where it does not apply. A new one is a function and a row of `INVARIANCES`.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from copy import deepcopy
from functools import cached_property, partial
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np

import mjrock as mr
from mjrock.distinct import thread
from mjrock.distinct.contacts.friction import SETTLED

from ..cores import one_core
from .quantities import Scene, changed, moved, scaled, turned
from .random_scenes import DENSITY, PLACES, box, draw
from .runs import (
    LINKS,
    Motion,
    apart,
    default_step,
    extruded,
    has_other_points,
    measured_in_the_plane,
    motion_of,
    pushed_beside,
    softened,
    solve,
)

SAMPLES = 40
"""Samples of a run."""
NUDGE = 1e-11
"""Relative change of k_n and k_s by which chaotic motions are told."""
SWELLS = 1e-12
"""Relative change of the sizes of blocks, likewise: a hundred times what coordinates of the scene are rounded by."""
WILD = 1e-5
"""Distance that a nudge brings, over the size of the scene, from which a motion is chaotic [-]."""
GROWN = 1e-9
"""Distance from the plane, over the size of the scene, which prisms that leave it by rounding have in a sample [-]."""
EXACTER = 1e-4
"""What the solver of MuJoCo leaves of a force, over what sweeps of explicit steps do [-]."""
IN_SPACE = 10.0
"""What sweeps leave of a force in space, over that in the plane [-]: the fiftieth sweep is the last one, and of two
scenes it ended within 0.0026 and 0.0044 of the largest impulse in half of such steps, and within 0.019 in all."""
STICKS = 10.0
"""The largest coefficient of friction [-]."""
DEEP = 0.1
"""Overlap of two blocks from which on a motion is none of masonry [-]."""
UNEQUAL = 1.0
"""What is said of two answers that differ in outcome or number of samples, with equal motions."""


class Trial:
    """A scene, its answer, and twins of it.

    Args:
        scene: the scene. The step of explicit steps is fixed to that of the first run, so that twins have the same.
        answer: of the scene.
    """

    def __init__(self, scene: Scene) -> None:
        self.spacing = scene["duration"] / SAMPLES
        self.scene, self.answer = scene, solve(scene, output_step=self.spacing)
        self.step = self.answer.stats.get("timestep", 0.0)
        self.motion = motion_of(self.answer)

    def again(self, scene: Scene | None = None, stretch: float = 1.0, **options: Any) -> mr.Response:
        """The answer to a twin of the scene, whose times are stretched."""
        scene = deepcopy(self.scene) if scene is None else scene
        if scene["solver"] == "explicit":
            scene = scene | {"timestep": stretch * self.step}
        return solve(scene, **{"output_step": stretch * self.spacing} | options)

    def away(self, motion: Motion) -> float:
        """How far a motion is from that of the scene, over its size [-]."""
        return apart(self.motion, motion) / self.scene["size"]

    def differs(self, answer: mr.Response) -> float:
        """How far an answer is that should be the same to the last bit [-]."""
        rows = ((getattr(each, name) for name in ("pose", "velocity")) for each in (answer, self.answer))
        same = answer.outcome is self.answer.outcome and answer.message == self.answer.message
        same = same and all(np.array_equal(*pair) for pair in zip(*rows, strict=True))
        same = same and np.allclose(answer.t, self.answer.t, rtol=1e-12, atol=0)  # a given step is rounded
        return 0.0 if same else self.away(motion_of(answer)) or UNEQUAL

    def twin(self, scene: Scene, matrix: np.ndarray | None = None, stretch: float = 1.0) -> float:
        """How far the answer to a twin is, whose motion is turned back and scaled back by the square of the stretch."""
        answer = self.again(scene, stretch)
        back = np.eye(3 if answer.in_space else 2) if matrix is None else matrix.T
        return self.away(motion_of(answer).turned(back, stretch**-2))

    @cached_property
    def extent(self) -> float:
        """How far the bodies move, over the size of the scene [-]."""
        return self.motion.extent() / self.scene["size"]

    @property
    def sag(self) -> float:
        """How far a column as high as the scene presses its joint, ten times, over the size of the scene [-]: the size
        of what rings."""
        return 10 * DENSITY * mr.GRAVITY / self.scene["k_n"]

    @cached_property
    def nudged(self) -> float:
        """How far nudges move the motion, over the size of the scene [-]: a change of k_n and k_s by 1e-11 up and down,
        and blocks of masonry that are larger and smaller by 1e-12, so that joints as drawn are closed or open.

        It is infinite where a nudge ends the run with an error."""
        scenes = [changed(self.scene, partial(times, 1 + share)) for share in (NUDGE, -NUDGE)]
        if self.scene["place"] != "wall":
            scenes += [swollen(self.scene, share) for share in (SWELLS, -SWELLS)]
        try:
            return max(self.away(motion_of(self.again(scene))) for scene in scenes)
        except (ValueError, RuntimeError):
            return math.inf

    @property
    def wild(self) -> bool:
        """Whether the motion is chaotic, or blocks lie deep inside each other, which the run has warned of."""
        return bool(self.answer.stats.get("overlap", 0.0) > DEEP or self.nudged > WILD)


def times(factor: float, name: str, value: Any) -> Any:
    """A value, multiplied where it is a stiffness of joints."""
    return factor * value if name in ("k_n", "k_s", "k_side") else value


def swollen(scene: Scene, share: float) -> Scene:
    """A scene with each block larger by a share, about its middle."""
    scene = deepcopy(scene)
    for unit in scene["units"]:
        middle = np.concatenate([part["corners"] for part in unit["parts"]]).mean(axis=0)
        for part in unit["parts"]:
            part["corners"] += share * (part["corners"] - middle)
    return scene


# the same scene


def twice(trial: Trial) -> float:
    """The same scene again."""
    return trial.differs(trial.again())


def after_another(trial: Trial) -> float:
    """The same scene after a shorter one of the same blocks and one of others."""
    shaken = deepcopy(trial.scene) | {"duration": 0.3 * trial.scene["duration"], "tilt": None}
    accel = np.zeros((4, 3 if trial.scene["place"] == "space" else 2))
    accel[1, 0] = 3.0
    shaken["record"] = {"dt": 0.1 * shaken["duration"], "acceleration": accel}
    for other in (shaken, draw(trial.scene["seed"] + len(PLACES)) | {"solver": trial.scene["solver"]}):
        with contextlib.suppress(Exception):  # the other may be refused
            solve(other, output_step=other["duration"])
    return trial.differs(trial.again())


def in_a_thread(trial: Trial) -> float:
    """The same scene in a thread."""
    with ThreadPoolExecutor(1) as pool:
        return trial.differs(pool.submit(trial.again).result())


def in_threads(trial: Trial) -> float | None:
    """Explicit steps by two and four threads, which share the lines by four and the blocks one by one."""
    if trial.scene["solver"] != "explicit":
        return None
    with patch.multiple(thread, LINES_TOGETHER=4, BODIES_TOGETHER=1), one_core():
        return max(trial.differs(trial.again(threads=count)) for count in (2, 4))


def other_samples(trial: Trial) -> float | None:
    """Samples at other distances: the last one is the same."""
    if trial.scene["solver"] == "theory":
        return None
    ends = [trial.again(output_step=spacing) for spacing in (3.7 * trial.spacing, trial.scene["duration"])]
    last = [answer.pose[-1] for answer in (trial.answer, *ends)]
    return (
        0.0
        if all(np.array_equal(last[0], pose) for pose in last)
        else max(float(np.abs(pose - last[0]).max()) / trial.scene["size"] for pose in last)
    )


def from_the_middle(trial: Trial) -> float | None:
    """Stopped after half of the steps and carried on from there: the last pose is the same."""
    scene = trial.scene
    yields = any(device["kind"] in ("tie", "friction damper") for device in scene["devices"])
    driven = yields or scene["record"] or scene.get("tilt") or scene.get("supports")
    jacks = any(device["kind"] == "jack" for device in scene["devices"])
    if scene["solver"] != "explicit" or driven or jacks:
        return None
    h, count = trial.answer.stats["timestep"], trial.answer.stats["steps"] - 1
    if count < 4 or abs(trial.answer.t[-1] - count * h) > 0.1 * h:
        return None
    half = count // 2
    first, last = (deepcopy(scene) | {"duration": steps * h} for steps in (half, count - half))
    begun = trial.again(first, output_step=first["duration"])
    ended = trial.again(last, output_step=last["duration"], start=begun.end)
    return float(np.abs(ended.pose[-1] - trial.answer.pose[-1]).max()) / scene["size"]


def zeros_after(trial: Trial) -> float | None:
    """Zeros after the record."""
    if not trial.scene["record"]:
        return None
    scene = deepcopy(trial.scene)
    accel = scene["record"]["acceleration"]
    scene["record"]["acceleration"] = np.concatenate([accel, np.zeros((500, accel.shape[1]))])
    return trial.differs(trial.again(scene))


# the same blocks elsewhere, or otherwise put down


def far_block(trial: Trial) -> float | None:
    """A fixed block far away."""
    if trial.scene["place"] == "wall":
        return None
    scene, size = deepcopy(trial.scene), trial.scene["size"]
    corners = box(300 * size, 0, size, size)
    if scene["place"] == "space":
        corners = np.array([(x, y, z) for x, z in corners for y in (0, size)])
    far = {"name": "far", "parts": [{"corners": corners}], "density": 2000.0, "length": 1.0, "fixed": True}
    return trial.twin(scene | {"units": [*scene["units"], far]})


def elsewhere(trial: Trial) -> float | None:
    """Moved by 1000 m."""
    if trial.scene["place"] == "wall":
        return None
    return trial.twin(moved(trial.scene, 1000 * np.eye(2 if trial.scene["place"] == "plane" else 3)[0]))


def mirrored(trial: Trial) -> float | None:
    """Left and right exchanged. In the plane links are anchored on the left, and stay so."""
    scene = trial.scene
    leans = scene["place"] == "wall" and (scene["one_sided"] or scene["devices"])
    held = scene["place"] == "plane" and any(device["kind"] in LINKS for device in scene["devices"])
    if leans or held:
        return None
    matrix = np.diag([-1.0, 1.0] if scene["place"] != "space" else [-1.0, 1.0, 1.0])
    return trial.twin(turned(scene, matrix), matrix)


def quarter_turn(trial: Trial) -> float | None:
    """Turned by 90 degrees about the vertical."""
    if trial.scene["place"] != "space" or trial.scene["tilt"]:
        return None
    matrix = np.array([(0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)])
    return trial.twin(turned(trial.scene, matrix), matrix)


def renumbered(trial: Trial) -> float | None:
    """The blocks in another order."""
    if trial.scene["place"] == "wall":
        return None
    scene = deepcopy(trial.scene)
    order = np.random.default_rng(scene["seed"]).permutation(len(scene["units"]))
    fixed = np.array([unit["fixed"] for unit in scene["units"]])
    row = np.cumsum(~fixed) - 1
    scene["units"] = [scene["units"][i] for i in order]
    if scene["kick"]:
        kept = [row[i] for i in order if not fixed[i]]
        scene["kick"] = {name: rates[kept] for name, rates in scene["kick"].items()}
    return trial.twin(scene)


def in_space(trial: Trial) -> float | None:
    """A scene of the plane with its blocks as prisms in space.

    Both have the shorter one of their steps, or an eighth of it where such a step puts energy in or where contacts of
    prisms are softer for it, which turn out of the plane faster than in it, and are searched at the same moments. In
    the plane a thrust acts at its height beside an L too, in space on its block. A side of an L may have a corner in
    the plane where it has none in space, see `has_other_points`. Both are compared as long as rounding has not grown
    out of the plane, and where they start at rest alike: with friction that is at its limit many poses are at rest, and
    the search for one goes another way in space. On springs that is so only where both start alike with the largest
    friction."""
    scene = trial.scene
    if scene["place"] != "plane" or scene["solver"] != "explicit" or scene["bond"]:
        return None
    if pushed_beside(scene) or has_other_points(scene):
        return None
    twin = extruded(scene)
    with measured_in_the_plane(scene):
        step = min(trial.step, default_step(twin))

    def motion_in_space(**changes: Any) -> Motion:
        with measured_in_the_plane(scene):
            return motion_of(solve(twin | changes, output_step=trial.spacing))

    def starts_alike(flat: Motion, solid: Motion) -> bool:
        begun = apart(flat.until(1), solid.until(1).in_the_plane()) / scene["size"]
        return begun <= INVARIANCES["in_space"].floor

    def both(step: float) -> float | None:
        solid, flat = motion_in_space(timestep=step), trial.motion
        if step < trial.step:
            flat = motion_of(solve(scene | {"timestep": step}, output_step=trial.spacing))
        if scene["settled"] and not starts_alike(flat, solid):
            sticks = {"timestep": step, "friction": STICKS}
            if trial.answer.stats["friction"] == "rigid" or starts_alike(
                motion_of(solve(scene | sticks, output_step=trial.spacing)), motion_in_space(**sticks)
            ):
                return None
        kept = while_flat(solid.out_of_the_plane() / scene["size"])
        return apart(flat, solid.until(kept).in_the_plane()) / scene["size"]

    with contextlib.suppress(RuntimeError), softened() as shares:
        found = both(step)
        if min(shares, default=1.0) == 1.0:
            return found
    return both(0.125 * step)


def while_flat(out: np.ndarray) -> int:
    """Samples of a motion of prisms before it is `WILD` out of the plane, where it grows to that from rounding.

    What leaves the plane from one sample to the next by more than that is compared whole: nothing in a scene of the
    plane asks for it.

    Args:
        out: how far it is out of the plane at each sample, over the size of the scene [-], shape (n,).
    """
    first = int(np.argmax(out > WILD)) if (out > WILD).any() else len(out)
    return first if first == len(out) or out[first - 1] > GROWN else len(out)


# the same scene in other units of length, time and mass


def larger(trial: Trial) -> float:
    """Four times as large and twice as slow: Froude's law."""
    return trial.twin(scaled(trial.scene, 4.0, 1.0), stretch=2.0)


def heavier(trial: Trial) -> float:
    """Twice as dense, on joints twice as stiff and under forces twice as large."""
    return trial.twin(scaled(trial.scene, 1.0, 2.0))


def longer(trial: Trial) -> float | None:
    """Three times as long across the plane, under forces three times as large."""
    if trial.scene["place"] == "space":
        return None
    across = ("length", "stiffness", "damping", "strength", "slip_force", "prestress", "force", "mass")
    return trial.twin(changed(trial.scene, lambda name, value: 3 * value if name in across else value))


def half_the_step(trial: Trial) -> float | None:
    """Steps half as long."""
    if trial.scene["solver"] != "explicit":
        return None
    return trial.away(motion_of(solve(trial.scene | {"timestep": 0.5 * trial.step}, output_step=trial.spacing)))


# what may differ


class Invariance(NamedTuple):
    """An invariance and how far its motion may be from the one that it should be, with the reason.

    A twin is at most this far, over the size of the scene: `floor`, shares of the extent of the motion and the sag of
    the scene, and `nudges` times what a nudge does. One `share` always counts, `rigid` where friction is rigid, as it
    always is in MuJoCo, `meets` where blocks meet others that they have no joint with, and `drawn` where they start as
    drawn. Where friction is rigid, `sweeps` more nudges count. Of motions that are `wild` only what has to be equal to
    the last bit is asked, which has no nudges.
    """

    run: Callable[[Trial], float | None]
    reason: str
    floor: float = 0.0
    share: float = 0.0
    rigid: float = 0.0
    meets: float = 0.0
    drawn: float = 0.0
    nudges: float = 0.0
    sweeps: float = 0.0

    def allows(self, trial: Trial, distance: float) -> bool:
        """Whether a distance is expected in a scene."""
        scene, stats = trial.scene, trial.answer.stats
        rigid = stats.get("friction") == "rigid" or scene["solver"] == "MuJoCo"
        share = self.share + self.rigid * rigid + self.meets * (stats.get("overlap", 0.0) > 0)
        share += self.drawn * (not scene.get("settled", True))
        known = self.floor + share * (trial.extent + trial.sag)
        if distance <= known or not self.nudges:
            return distance <= known
        sweeps = self.sweeps * rigid * (EXACTER if scene["solver"] == "MuJoCo" else 1.0)
        sweeps *= IN_SPACE if scene["place"] == "space" else 1.0
        return trial.wild or distance <= known + (self.nudges + sweeps) * trial.nudged

    def excuses(self, trial: Trial) -> bool:
        """Whether a twin may end with an error where the scene does not."""
        return bool(self.nudges) and trial.wild

    @property
    def bounds(self) -> str:
        """As a row of a table."""
        if not self.floor:
            return "bit for bit | | | | | | "
        return " | ".join(f"{value:g}" for value in self[2:])


BITS = "the same numbers in the same order"
SUMS = "sums in another order"
OTHERWISE = {"rigid": 5e-3, "drawn": 1e-3, "nudges": 100, "sweeps": 10 * SETTLED / NUDGE}
"""What may differ where sums are rounded otherwise: rigid friction is found in sweeps, in the order of the lines, and
joints as drawn are open or closed."""
INVARIANCES = {
    row.run.__name__: row
    for row in (
        Invariance(twice, BITS),
        Invariance(after_another, BITS),
        Invariance(in_a_thread, BITS),
        Invariance(in_threads, BITS),
        Invariance(other_samples, BITS),
        Invariance(from_the_middle, "the end of a run has all that its steps keep", 1e-12, nudges=100),
        Invariance(zeros_after, BITS),
        Invariance(far_block, BITS),
        Invariance(
            elsewhere,
            "rounded to 1e-13 m, and corners within 1e-6 are one",
            1e-9,
            meets=1e-3,
            **OTHERWISE | {"nudges": 3e5},
        ),
        Invariance(mirrored, "of two equal faces the first has the lines", 1e-12, **OTHERWISE),
        Invariance(quarter_turn, SUMS, 1e-12, **OTHERWISE),
        Invariance(renumbered, SUMS, 1e-12, **OTHERWISE),
        Invariance(
            in_space,
            "prisms have twice the lines, and faces with longer outlines",
            1e-8,
            1e-3,
            meets=0.02,
            **OTHERWISE | {"sweeps": 100 * SETTLED / NUDGE},
        ),
        Invariance(larger, "the search for rest ends within rounding", 1e-12, **OTHERWISE),
        Invariance(heavier, "the search for rest ends within rounding", 1e-12, **OTHERWISE),
        Invariance(longer, "products by three are rounded", 1e-12, **OTHERWISE),
        Invariance(half_the_step, "blows fall at other times: two motions may be opposite", 1e-12, 2.0, nudges=1e4),
    )
}
"""By name."""
