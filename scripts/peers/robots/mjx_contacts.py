"""Contacts of `contact_for` in MJX, in single and double precision, beside MuJoCo's C code of the same environment.

    python scripts/peers/robots/mjx_contacts.py --python .venv-mjx/bin/python

A ball of 2 kg lands on a plane with 1 m/s and without gravity, and lies on it under gravity. Prints e that was asked,
what each gives, and the static penetration over weight / k. MJX runs in an environment of its own, in which
`pip install mujoco-mjx` has been called. Writes mjx_contacts.csv and mjx_contacts.txt.
"""

from __future__ import annotations

import json
import subprocess
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mujoco

import mjrock as mr
from scripts.peers.robots import mjx_worker
from scripts.shared import cli

K, MASS, RADIUS, STEP, G = 1e5, 2.0, 0.1, 1e-4, 9.81
HEADER = ("precision", "friction", "impratio", "asked", "MJX", "C MuJoCo")
SCENE = """<mujoco><option timestep="{h}" gravity="0 0 -{g}"/><worldbody><geom name="floor" type="plane" size="1 1 1"/>
<body pos="0 0 {z}"><freejoint/><geom name="ball" size="{r}" mass="{m}"/></body></worldbody></mujoco>"""
MISSING = "MJX is not installed in {python}: make an environment, pip install mujoco-mjx in it, and name it by --python"


def scene(e: float, friction: float, falls: bool) -> tuple[dict[str, Any], float]:
    """A landing without gravity, or a ball that lies down; and its impratio."""
    text = SCENE.format(h=STEP, g=0 if falls else G, z=RADIUS + (0.5 * STEP if falls else 0), r=RADIUS, m=MASS)
    spec = mujoco.MjSpec.from_string(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # gravity on a small e
        contact = mr.contact_for(spec, "ball", "floor", k=K, restitution=e, friction=friction)
    contact.apply(spec)
    steps = int(30 / contact.frequency / STEP)
    spec.compile()
    velocity = [0.0, 0.0, -1.0 if falls else 0.0, 0.0, 0.0, 0.0]
    return {"xml": spec.to_xml(), "velocity": velocity, "steps": steps}, contact.impratio


def requested_scenes(quick: bool) -> list[tuple[str, float, float, bool]]:
    """What is asked, the restitution, the friction, and whether it falls."""
    landings = [(f"e = {e}", e, 0.6, True) for e in ((0.5,) if quick else (0.3, 0.5, 0.8))]
    return [*landings, ("depth = 1 weight / k", 0.3, 0.6, False)]


def measured(falls: bool, state: Sequence[float]) -> str:
    """The restitution [-], or the penetration over weight / k [-]."""
    speed, height = state
    return f"{speed:.4f}" if falls else f"{(RADIUS - height) * K / (MASS * G):.5f}"


def main(argv: Sequence[str] | None = None) -> None:
    """Run the scenes in both precisions, and print the table."""
    options = cli.parser(__doc__, "mjx_contacts")
    options.add_argument("--python", default=sys.executable, help="interpreter of an environment with MJX")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    requested = requested_scenes(args.quick)
    scenes = [scene(e, friction, falls) for _, e, friction, falls in requested]
    rows, versions = [], ""
    for double in (True, False):
        question = json.dumps({"double": double, "scenes": [text for text, _ in scenes]})
        run = subprocess.run(
            [args.python, str(Path(mjx_worker.__file__))], input=question, capture_output=True, text=True, check=False
        )
        if "No module named" in run.stderr and run.returncode:
            cli.report(out / "mjx_contacts", MISSING.format(python=args.python))
            return
        if run.returncode:
            raise RuntimeError(f"MJX stopped: {run.stderr.strip().splitlines()[-1]}")
        answer = json.loads(run.stdout.splitlines()[-1])
        versions = ", ".join(f"{name} {version}" for name, version in answer["versions"].items())
        versions += f", on the {answer['device']}; contacts made with MuJoCo {mujoco.__version__}"
        for (label, _, friction, falls), (_, impratio), found in zip(requested, scenes, answer["answers"], strict=True):
            values = (measured(falls, found[name]) for name in ("mjx", "c"))
            rows.append([found["type"], f"{friction:g}", f"{impratio:.2g}", label, *values])
    cli.report(out / "mjx_contacts", "\n".join([cli.table(HEADER, rows), versions]), HEADER, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
