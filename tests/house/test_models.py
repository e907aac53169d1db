"""The models folder is what the script makes, and stock MuJoCo alone reproduces its reference."""

import csv
import re

import mujoco
import numpy as np
import pytest
from everyday import among

import mjrock as mr
from scripts.models import make_models

NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"


SMALLEST_MOTION = 1e-5
"""Largest displacement below which what is compared is not a share of it [m]."""
ROUNDING = 1e-12, 1e-8
"""Rounding of the numbers of a scene up to its blow, and of the velocities of the blow [m/s, rad/s]. Those of a dome
differ by up to 3.5e-10 between OpenBLAS's kernels for Haswell, Nehalem, SkylakeX and Sandybridge."""
EVERY_DAY = {"figure3_one_sided", "corner_block"}
"""The models that the everyday tests run. The long tests run the others."""


def models(these):
    return [model if model.name in EVERY_DAY else pytest.param(model, marks=pytest.mark.slow) for model in these]


def reference(folder):
    with open(folder / "reference.csv") as file:
        rows = list(csv.reader(file))
    return rows[0], np.array(rows[1:], dtype=float)


@pytest.mark.parametrize(
    "model", models([*make_models.ALL, *make_models.MASONRY, *make_models.IN_SPACE]), ids=lambda m: m.name
)
def test_a_model_is_what_the_script_makes(model):
    folder = make_models.MODELS / model.name
    made = model.files()
    scene = (folder / "scene.xml").read_text(encoding="utf-8")
    if model in make_models.ALL:
        assert scene == made["scene.xml"]
    else:  # linear algebra finds its rest and its frequency, whose last digits depend on the machine
        halves = (text.split("qvel=") for text in (scene, made["scene.xml"]))
        for *texts, rounding in zip(*halves, ROUNDING, strict=True):
            stored_words, made_words = (re.split(NUMBER, text) for text in texts)
            assert stored_words == made_words
            stored_numbers, made_numbers = (np.array(re.findall(NUMBER, text), float) for text in texts)
            np.testing.assert_allclose(made_numbers, stored_numbers, rtol=1e-9, atol=rounding)
    assert (folder / "README.md").read_text(encoding="utf-8") == made["README.md"]
    header, stored = reference(folder)
    lines = list(csv.reader(made["reference.csv"].splitlines()))
    assert lines[0] == header
    again = np.array(lines[1:], dtype=float)
    # 1e-4 of the largest value of each column: what another SciPy may do to the contact law's many impacts. Blocks in
    # the plane of symmetry move sideways by rounding alone, some 1e-12 m, which is another number on another processor.
    size = np.maximum(abs(stored).max(0), SMALLEST_MOTION)
    np.testing.assert_allclose(again / size, stored / size, atol=1e-4)


@pytest.mark.parametrize("model", models(make_models.ALL), ids=lambda m: m.name)
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


@pytest.mark.parametrize("model", models(make_models.ALL), ids=lambda m: m.name)
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


def stepped(model, steps, *, cold=False):
    """Poses of stock MuJoCo from the keyframe of a stored scene, or from the same poses at rest."""
    engine = mujoco.MjModel.from_xml_path(str(make_models.MODELS / model.name / "scene.xml"))
    data = mujoco.MjData(engine)
    mujoco.mj_resetDataKeyframe(engine, data, engine.key("release").id)
    if cold:
        data.qvel[:] = 0.0
    pose = np.empty((steps, engine.nq))
    for own in pose:
        own[:] = data.qpos
        mujoco.mj_step(engine, data)
    assert not any(warning.number for warning in data.warning)
    turns = [engine.joint(f"{name}_theta").qposadr[0] for name in model.case.masonry.names if name in names_of(engine)]
    return pose, pose[:, turns]


def names_of(engine):
    return {engine.body(i).name for i in range(engine.nbody)}


@pytest.mark.parametrize("model", among(make_models.MASONRY, make_models.MASONRY[0]), ids=lambda m: m.name)
def test_stock_mujoco_repeats_masonry_and_follows_its_reference(model):
    """Every step of the text is that of `simulate`, and the step of the text costs little accuracy."""
    run = mr.simulate(model.case, timestep=model.timestep)
    pose, theta = stepped(model, len(run.t))
    np.testing.assert_allclose(pose, run.pose.reshape(len(pose), -1), rtol=0, atol=1e-9)
    header, stored = reference(make_models.MODELS / model.name)
    assert len(header) == theta.shape[1] + 2
    every = round((stored[1, 0] - stored[0, 0]) / model.timestep)
    exact = stored[:, 1:-1]
    error = np.abs(theta[::every] - exact).max(axis=0) / np.abs(exact).max(axis=0)
    assert error.max() < 1e-3
    np.testing.assert_allclose(run.energy[::every], stored[:, -1], atol=2e-3 * stored[:, -1].max())
    # the twin that must fail: no velocity at the release
    assert np.abs(stepped(model, every + 1, cold=True)[1][-1] - exact[1]).max() > 0.01 * np.abs(exact).max()


@pytest.mark.parametrize("model", models(make_models.IN_SPACE), ids=lambda m: m.name)
def test_stock_mujoco_repeats_masonry_in_space(model):
    """Every step of the text is that of `simulate`, and its step costs little accuracy."""
    engine = mujoco.MjModel.from_xml_path(str(make_models.MODELS / model.name / "scene.xml"))
    data = mujoco.MjData(engine)
    mujoco.mj_resetDataKeyframe(engine, data, engine.key("release").id)
    run = model.run(model.timestep)
    pose = np.empty((len(run.t), engine.nq))
    for own in pose:
        own[:] = data.qpos
        mujoco.mj_step(engine, data)
    np.testing.assert_allclose(pose, run.pose.reshape(len(pose), -1), rtol=0, atol=1e-9)
    _, stored = reference(make_models.MODELS / model.name)
    every = round((stored[1, 0] - stored[0, 0]) / model.timestep)
    places = pose.reshape(len(pose), -1, 7)[::every, :, :3].reshape(len(stored), -1)
    assert np.abs(places - stored[:, 1:-1]).max() < 2e-2 * np.abs(stored[:, 1:-1]).max()
    assert np.abs(stored[:, 1:-1]).max() > 5e-3


def test_neighbours_have_other_tints():
    engine = mujoco.MjModel.from_xml_path(str(make_models.MODELS / "facade_return_walls" / "scene.xml"))
    masonry = next(m for m in make_models.IN_SPACE if m.name == "facade_return_walls").case.masonry
    pairs = [joint.name.split("|") for joint in masonry.joints]
    tints = {masonry.names[i]: tuple(engine.geom(masonry.names[i]).rgba) for i in masonry.free}
    assert len(set(tints.values())) > 2
    assert all(tints[a] != tints[b] for a, b in pairs if a in tints and b in tints)


def test_the_folder_holds_nothing_else():
    assert {p.name for p in make_models.MODELS.iterdir() if p.is_dir()} == {
        m.name for m in (*make_models.ALL, *make_models.MASONRY, *make_models.IN_SPACE)
    }
