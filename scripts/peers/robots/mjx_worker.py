"""Runs one scene in MJX and in MuJoCo's C code, and prints speeds and depths as JSON; `mjx_contacts.py` starts it.

Nothing here imports mjrock: the environment with MJX needs neither it nor the same MuJoCo.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import json
import sys
from typing import Any


def main() -> None:
    """Read a question from standard input, and answer it."""
    question = json.load(sys.stdin)
    jax, mujoco, mjx = (importlib.import_module(name) for name in ("jax", "mujoco", "mujoco.mjx"))
    jax.config.update("jax_enable_x64", bool(question["double"]))

    def steps(there: Any, now: Any, count: int) -> Any:
        """So many steps. The first is apart: in double precision it changes the type of whole numbers."""
        return jax.lax.fori_loop(1, count, lambda _, state: mjx.step(there, state), mjx.step(there, now))

    run: Any = jax.jit(steps)
    answers = []
    for scene in question["scenes"]:
        model = mujoco.MjModel.from_xml_string(scene["xml"])
        data = mujoco.MjData(model)
        data.qvel[:] = scene["velocity"]
        there, now = mjx.put_model(model), mjx.put_data(model, data)
        now = run(there, now, scene["steps"])
        mujoco.mj_step(model, data, scene["steps"])
        answers.append(
            {
                "mjx": [float(now.qvel[2]), float(now.qpos[2])],
                "c": [float(data.qvel[2]), float(data.qpos[2])],
                "type": str(now.qpos.dtype),
            }
        )
    versions = {name: importlib.metadata.version(name) for name in ("mujoco", "mujoco-mjx", "jax")}
    print(json.dumps({"versions": versions, "device": str(jax.devices()[0].platform), "answers": answers}))


if __name__ == "__main__":
    main()
