"""A facade that falls as MuJoCo's viewer shows it: a plain model, stepped and drawn by MuJoCo.

The facade of `scripts/studies/second_opinion.py` under a sine out of its plane. The picture has the colours, shadows
and the camera of the model text, without a display. Writes viewer.png.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

os.environ.setdefault("MUJOCO_GL", "egl")

import mujoco
import numpy as np
from matplotlib import image

import mjrock as mr
from scripts.shared import cli
from scripts.studies.second_opinion import facade

SIZE, FINE = (1480, 987), 2
"""Of the picture [pixel], and pixels that are drawn for one of it along each side."""
CLOSER = 0.8
"""Angle of view over that of the model's camera [-]."""
AT = 1.2
"""When it is drawn [s]."""


def main(argv: Sequence[str] | None = None) -> None:
    """Step it and draw it."""
    args = cli.parser(__doc__, "in_the_viewer").parse_args(argv)
    out, case = cli.folder(args.out), facade()
    answer = mr.simulate(case, timestep=1e-3, collisions=True, output_step=0.01)
    model = mujoco.MjModel.from_xml_string(mr.mjcf_of(case, None, 1e-3, collisions=True))
    wide, high = (FINE * size for size in SIZE)
    model.vis.global_.offwidth, model.vis.global_.offheight = wide, high
    model.cam("front").fovy[:] *= CLOSER
    data, k = mujoco.MjData(model), int(np.searchsorted(answer.t, 0.1 if args.quick else AT))
    places = answer.pose[k].copy()
    places[:, :3] += case.rests
    data.qpos[:] = places.ravel()
    mujoco.mj_forward(model, data)
    with mujoco.Renderer(model, high, wide) as renderer:
        renderer.update_scene(data, "front")
        picture = renderer.render().reshape(SIZE[1], FINE, SIZE[0], FINE, 3).mean(axis=(1, 3)) / 255
    path = out / "viewer.png"
    image.imsave(path, picture)
    print(f"{len(answer.fallen)} of {len(case.bodies)} blocks fall; {path} is drawn at {answer.t[k]:.2f} s")


if __name__ == "__main__":
    sys.exit(cli.run(main))
