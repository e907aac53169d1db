"""The models folder is what the script makes, and stock MuJoCo alone reproduces its reference."""

import csv

import mujoco
import numpy as np
import pytest

import make_models
import mjrock as mr


def reference(folder):
    with open(folder / "reference.csv") as file:
        rows = list(csv.reader(file))
    return rows[0], np.array(rows[1:], dtype=float)


@pytest.mark.parametrize("model", make_models.ALL, ids=lambda m: m.name)
def test_a_model_is_what_the_script_makes(model):
    folder = make_models.MODELS / model.name
    made = model.files()
    assert (folder / "scene.xml").read_text(encoding="utf-8") == made["scene.xml"]
    assert (folder / "README.md").read_text(encoding="utf-8") == made["README.md"]
    header, stored = reference(folder)
    lines = list(csv.reader(made["reference.csv"].splitlines()))
    assert lines[0] == header
    again = np.array(lines[1:], dtype=float)
    # 1e-4 of the largest value of each column: what another SciPy may do to the contact law's many impacts
    np.testing.assert_allclose(again / abs(stored).max(0), stored / abs(stored).max(0), atol=1e-4)


@pytest.mark.parametrize("model", make_models.ALL, ids=lambda m: m.name)
def test_stock_mujoco_follows_the_reference(model):
    """Load, reset to the keyframe, step: no mjrock in between."""
    folder = make_models.MODELS / model.name
    engine = mujoco.MjModel.from_xml_path(str(folder / "scene.xml"))
    data = mujoco.MjData(engine)
    mujoco.mj_resetDataKeyframe(engine, data, engine.key("release").id)
    _, stored = reference(folder)
    t, law = stored[:, 0], stored[:, 3]
    rotation = np.zeros_like(t)
    hinge = engine.joint("theta").qposadr[0]
    every = round((t[1] - t[0]) / engine.opt.timestep)
    rotation[0] = data.qpos[hinge]
    for i in range(1, len(t)):
        mujoco.mj_step(engine, data, every)
        rotation[i] = data.qpos[hinge]
    assert not any(warning.number for warning in data.warning)
    alpha = model.case.block.alpha
    assert np.sqrt(np.mean((rotation - law) ** 2)) / alpha < 0.003
    # and the first rebound, which a wall that stops dead would miss
    rebound = t > t[np.flatnonzero(law < 0.02 * alpha)[0]]
    peaks = [np.abs(y[rebound]).max() for y in (rotation, law)]
    assert peaks[0] == pytest.approx(peaks[1], rel=0.1, abs=1e-3 * alpha)


@pytest.mark.parametrize("model", make_models.ALL, ids=lambda m: m.name)
def test_the_text_is_the_simulation(model):
    """Stock MuJoCo, from the keyframe, is `simulate` at the step of the text, to 1e-9 alpha at every step."""
    engine = mujoco.MjModel.from_xml_path(str(make_models.MODELS / model.name / "scene.xml"))
    data = mujoco.MjData(engine)
    mujoco.mj_resetDataKeyframe(engine, data, engine.key("release").id)
    run = mr.simulate(model.case, model.contacts, engine.opt.timestep)
    pose = np.empty((len(run.t), 3))
    for i in range(len(pose)):
        pose[i] = data.qpos
        mujoco.mj_step(engine, data)
    assert np.abs(pose - run.pose[:, 0]).max() < 1e-9 * model.case.block.alpha
    # the twin that must fail: the velocity at the release instead of half a step before it
    mujoco.mj_resetDataKeyframe(engine, data, engine.key("release").id)
    data.qvel[:] = 0.0
    for _ in range(len(pose) - 1):
        mujoco.mj_step(engine, data)
    assert np.abs(data.qpos - run.pose[-1, 0]).max() > 1e-9 * model.case.block.alpha


def test_the_folder_holds_nothing_else():
    assert {p.name for p in make_models.MODELS.iterdir() if p.is_dir()} == {m.name for m in make_models.ALL}
