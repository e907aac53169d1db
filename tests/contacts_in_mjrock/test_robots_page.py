"""The page on stacks, grippers and feet says what is so: its example runs, and its figures are measured."""

import re
from pathlib import Path

import mujoco
import numpy as np
import pytest

import mjrock as mr
from scripts.models import stacks_grippers_feet as study

PAGE = (Path(__file__).parents[2] / "docs" / "stacks_grippers_feet.md").read_text(encoding="utf-8")


def test_its_stack_rests_as_it_says():
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    names: dict[str, object] = {}
    with pytest.warns(mr.ContactWarning, match="a turn of 0.01 degrees .* 8 points for 4: .* 2e.05 N/m for 1e.05 N/m"):
        exec(code, names)
    model = names["model"]
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 4000)
    tops = np.concatenate([[-0.05], data.qpos.reshape(5, 7)[:, 2]])
    printed = [
        [float(cell) for cell in row.split("|")[2:4]] for row in PAGE.splitlines() if re.match(r"\| [1-5] \|", row)
    ]
    measured = 1e3 * (0.1 - np.diff(tops))
    assert measured == pytest.approx([row[1] for row in printed], abs=3e-4)
    assert [1e3 * (5 - i) * 1.3 * 9.81 / 1e5 for i in range(5)] == pytest.approx([row[0] for row in printed], abs=1e-4)


def test_a_held_object_creeps_as_it_says():
    rows = {name: float(speed) for name, speed, *_ in study.creep(0.2)}
    assert rows["contacts_for"] < 3
    assert rows["MuJoCo, elliptic, impratio 10"] == pytest.approx(210, rel=0.2)


def test_its_lines_run():
    """The calls that stand in one line each."""
    found = mr.measured_contact([[1.0, 0.36], [1.0, 0.35]], mass=0.2, contact_times=[9e-3, 8.7e-3])
    assert found.restitution == pytest.approx(0.596, abs=1e-3)
    assert found.k == pytest.approx(20635, rel=1e-4)
    assert _bounced(found) == pytest.approx((0.353, 8.9e-3), rel=2e-3)
    assert mr.hertz_stiffness(0.02, 2.1e11, 0.3, mass=0.05, speed=1.0) > 1e7
    for call in (
        "measured_contact([[1.0, 0.36], [1.0, 0.35]], mass=0.2",
        "hertz_stiffness(0.02, 2.1e11, 0.3, mass=0.05",
    ):
        assert call in PAGE


def _bounced(found):
    """How high a ball bounces that is dropped from 1 m [m], and for how long it touches [s]."""
    spec = mujoco.MjSpec.from_string(study.model_text(
        '<body pos="0 0 1.03"><freejoint/><geom name="ball" size=".03" mass=".2"/></body>', 1e-4
    ))  # fmt: skip
    mr.contact_for(spec, "ball", "floor", k=found.k, restitution=found.restitution, speed=4.43).apply(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    touching, steps = 0, 0
    while steps < 4600 or data.qvel[2] > 0:
        mujoco.mj_step(model, data)
        touching += bool(data.ncon and data.efc_force[0] > 0)
        steps += 1
    return float(data.qpos[2]) - 0.03, 1e-4 * touching
