"""Stock MuJoCo: a free box on a plane, against a second plane, in hand-written MJCF."""

from __future__ import annotations

import math
import time

import mujoco
import numpy as np

from .question import GRAVITY, Motion, Question

IMPRATIO = {"default, pyramidal": 1.0, "default, elliptic": 10.0, "direct": 10.0, "direct, small d, pairs": 1e7}
"""Friction over normal constraint impedance; the manual asks for a large one against slip, with the elliptic cone."""
SMALL_D = 1e-4
"""The least impedance that MuJoCo takes. A contact row then adds next to no inertia of its own."""


def mjcf(question: Question, variant: str, h: float) -> str:
    """The model, the first two variants with MuJoCo's own solref and solimp.

    The manual's direct format is (-stiffness, -damping) per unit of mass: a + d (b v + k r) = (1 - d) a0 with
    b = damping / d and k = stiffness d / d^2 at a constant d. Each of the two corners of an edge carries half.
    `direct` keeps the default solimp. `direct, small d, pairs` takes the least d. It needs pairs, for the friction of
    a geom takes its damping / d too, which no step resolves; solreffriction then stops a sliding corner in a step.
    """
    size = f"{question.thickness / 2!r} {question.length / 2!r} {question.height / 2!r}"
    across, up = question.centroid(settled=variant.startswith("direct"))
    quat = f"{math.cos(question.theta0 / 2)!r} 0 {math.sin(question.theta0 / 2)!r} 0"
    cone = "pyramidal" if "pyramidal" in variant else "elliptic"
    faces = {"base": ("0 0 0", "0 0 1", 3, question.k_base, question.c_base)}
    if question.side_stop:
        faces["stop"] = (f"{-question.thickness / 2!r} 0 0", "1 0 0", 1, question.k_side, question.c_side)
    friction = 30 if variant.startswith("direct") else 1  # 30 holds the base, and 1 is the default
    planes, pairs = "", ""
    for name, (place, normal, condim, k, c) in faces.items():
        scale = (1 - SMALL_D if "pairs" in variant else 1.0) / question.mass
        solref = f'solref="{-scale * k / 2!r} {-scale * c / 2!r}"' if variant.startswith("direct") else ""
        # the priority makes the parameters of the plane count, instead of a mixture with those of the wall
        planes += f"""
    <geom name="{name}" type="plane" size="9 9 1" pos="{place}" zaxis="{normal}" condim="{condim}"
      friction="{friction} 0 0" priority="1" {solref}/>"""
        if "pairs" in variant:
            pairs += f"""
    <pair geom1="wall" geom2="{name}" condim="{condim}" friction="{friction} {friction} 0 0 0" {solref}
      solimp="{SMALL_D} {SMALL_D} 0.001 0.5 2" solreffriction="-1e-30 {-SMALL_D / (2 * h)!r}"/>"""
    return f"""<mujoco>
  <option timestep="{h!r}" gravity="0 0 {-GRAVITY!r}" cone="{cone}" impratio="{IMPRATIO[variant]!r}"/>
  <worldbody>{planes}
    <body name="wall" pos="{across!r} 0 {up!r}" quat="{quat}">
      <freejoint/>
      <geom name="wall" type="box" size="{size}" mass="{question.mass!r}"/>
    </body>
  </worldbody>
  <contact>{pairs}
  </contact>
</mujoco>"""


def run(question: Question, variant: str, h: float) -> tuple[Motion, float]:
    """The motion at a step h [s] and the wall time [s], the compilation of the model excluded."""
    model = mujoco.MjModel.from_xml_string(mjcf(question, variant, h))
    data = mujoco.MjData(model)
    stride, count = question.samples(h)
    found = np.empty((count, 2))
    started = time.perf_counter()
    for n in range(count):
        found[n] = 2 * math.atan2(data.qpos[5], data.qpos[3]), data.qvel[4]
        mujoco.mj_step(model, data, stride)
    seconds = time.perf_counter() - started
    if data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number:
        raise RuntimeError("unstable")
    return (h * stride * np.arange(count), found[:, 0], found[:, 1]), seconds
