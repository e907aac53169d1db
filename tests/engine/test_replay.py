"""`python -m mjrock view`: an answer in a model, frame by frame, and what MuJoCo makes of it from its end."""

import os
import shutil
import subprocess
import sys
import time
from contextlib import nullcontext
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

import mjrock as mr
from mjrock.__main__ import main
from mjrock.engine.replay import BACKSPACE_KEY, SPACE_KEY, Replay, columns_of, load, read_motion, show


@pytest.fixture(scope="module")
def column(tmp_path_factory):
    """Two drums in space that rock: the model, the file of the answer, and the answer."""
    folder = tmp_path_factory.mktemp("column")
    masonry = mr.Masonry.column(0.5, 2.0, 2, k_n=1e8, k_s=5e7)
    case = mr.MasonryCase(masonry, 0.4, motion=mr.GroundMotion.half_sine(-4.0, 0.3))
    answer = mr.solve_explicit(case, output_step=5e-3)
    (folder / "scene.xml").write_text(mr.masonry_mjcf(case, 1e-3))
    answer.csv(folder / "answer.csv")
    return folder / "scene.xml", folder / "answer.csv", answer


def test_bodies_are_where_the_answer_has_them(column):
    model = load(column[0])
    replay, answer = Replay(model, read_motion(model, column[1])), column[2]
    for sample in (0, 30, 60):
        replay.restart()
        replay.advance(answer.t[sample] + 1e-9)
        for i, name in enumerate(("drum_0", "drum_1")):
            place, body = answer.pose[sample, i], replay.data.body(name)
            rest = answer.case.masonry.centroids[i + 1]
            np.testing.assert_allclose(
                replay.data.body(name).xipos, rest + place[:3], atol=1e-6
            )  # less the radius of its points
            np.testing.assert_allclose(body.xquat, place[3:], atol=1e-12)


def test_a_plain_model_replays_an_answer_and_goes_on_when_blocks_have_fallen(column):
    """Its free joints are where bodies are, and nothing stops what lies on its side."""
    path, answer = column[0].with_name("plain.xml"), column[2]
    path.write_text(mr.mjcf_of(answer.case, None, 1e-3, collisions=True))
    replay = Replay(load(path), read_motion(load(path), column[1]))
    replay.advance(answer.t[60] + 1e-9)
    rest = answer.case.masonry.centroids[1:]
    np.testing.assert_allclose(replay.data.xpos[1:], rest + answer.pose[60, :, :3], atol=1e-9)
    np.testing.assert_allclose(replay.data.xquat[1:], answer.pose[60, :, 3:], atol=1e-9)
    replay.advance(1.0)
    replay.data.qvel[-3:] = (0.0, 5.0, 0.0)
    replay.advance(0.01)
    assert replay.state == "simulation"
    assert not replay.is_broken


def test_simulation_goes_on_from_the_end_with_its_velocity(column):
    model = load(column[0])
    replay, answer = Replay(model, read_motion(model, column[1])), column[2]
    replay.advance(1.0)
    assert not replay.is_replayed
    np.testing.assert_allclose(
        replay.data.qvel[6:9], answer.velocity[-1, 1, :3], atol=0.05 * abs(answer.velocity).max()
    )
    z = replay.data.body("drum_1").xipos[2]
    for _ in range(10):
        replay.advance(0.01)
    assert replay.data.time == pytest.approx(0.5, abs=2e-3)
    assert replay.data.body("drum_1").xipos[2] == pytest.approx(z, abs=0.05)  # it stands still
    replay.restart()
    assert replay.data.time == 0
    assert replay.is_replayed


def test_columns_of_walls_and_blocks_in_the_plane_are_those_of_the_file(wall, tmp_path):
    contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05)
    case = mr.Case(wall, 0.02, 0.05, side_stop=False)
    answer = mr.simulate(case, contacts)
    answer.csv(tmp_path / "wall.csv")
    model = mujoco.MjModel.from_xml_string(mr.wall_mjcf(case, contacts, 1e-4))
    t, places = read_motion(model, tmp_path / "wall.csv")
    np.testing.assert_array_equal(t, answer.t)
    np.testing.assert_array_equal(places, answer.pose[:, 0])


def test_what_mujoco_cannot_follow_stops(column):
    replay = Replay(load(column[0]))
    replay.data.qvel[:] = 1e12
    replay.advance(0.01)
    time_of_stop = replay.data.time
    replay.advance(0.01)
    assert replay.is_broken
    assert replay.data.time == time_of_stop
    assert replay.state.startswith("stopped")
    replay.restart()
    assert not replay.is_broken
    replay.data.joint("drum_1_turn").qpos = np.sqrt([0.5, 0.5, 0.0, 0.0])
    mujoco.mj_forward(replay.model, replay.data)
    replay.advance(0.01)
    assert replay.is_broken
    assert replay.data.time == 0


class Window:
    """A window that presses keys and closes after some pictures."""

    def __init__(self, keys, pictures):
        self.keys, self.left, self.texts, self.cam = dict(keys), pictures, [], mujoco.MjvCamera()

    def launch(self, model, data, key_callback, **panels):
        self.press = key_callback
        return self

    def lock(self):
        return nullcontext()

    def __enter__(self):
        return self

    def __exit__(self, *error):
        return None

    def is_running(self):
        self.left -= 1
        return self.left >= 0

    def set_texts(self, text):
        self.texts.append(text[2].split("\n"))

    def sync(self):
        if len(self.texts) in self.keys:
            self.press(self.keys[len(self.texts)])


def test_keys_stop_it_and_begin_again(column):
    model = load(column[0])
    window = Window({5: SPACE_KEY, 10: SPACE_KEY, 15: BACKSPACE_KEY}, 20)
    show(Replay(model, read_motion(model, column[1])), window.launch, 1.0)
    states, times = zip(*window.texts, strict=True)
    assert states[:5] == ("replay",) * 5
    assert states[5:10] == ("paused",) * 5
    assert states[10] == "replay"
    seconds = [float(text.split()[0]) for text in times]
    assert seconds[4] > seconds[0]
    assert len(set(seconds[4:10])) == 1
    assert seconds[15] < seconds[14]


def test_the_camera_fits_the_motion(column):
    """A column that is carried 30 m away is looked at half way, from far enough that both ends are in the picture."""
    model = load(column[0])
    t, places = read_motion(model, column[1])
    shift = np.zeros(model.nq)
    shift[[model.jnt_qposadr[i] for i in range(model.njnt) if model.joint(i).name.endswith("_x")]] = 30.0
    away = places + np.linspace(0, 1, len(t))[:, None] * shift
    window = Window({}, 1)
    show(Replay(model, (t, away)), window.launch, 1.0)
    np.testing.assert_allclose(window.cam.lookat, [15, 0, 1], atol=0.2)
    assert 30 < window.cam.distance * np.tan(np.radians(0.5 * model.vis.global_.fovy)) * 2 < 50
    still = Window({}, 1)
    show(Replay(model), still.launch, 1.0)
    assert still.cam.distance == pytest.approx(1.5 * model.stat.extent)


def test_without_a_display_it_says_what_it_needs(column, monkeypatch, capsys):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setitem(sys.modules, "glfw", SimpleNamespace(init=lambda: False, _glfw=True, ERROR_REPORTING=""))
    monkeypatch.setitem(sys.modules, "mujoco.viewer", SimpleNamespace(launch_passive=None))
    monkeypatch.setattr(mujoco, "viewer", sys.modules["mujoco.viewer"], raising=False)
    assert main(["view", *map(str, column[:2])]) == 2
    assert "needs a display" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not a file of Response.csv"),
        ("t [s],x of drum_0 [m]\n0,1\n", "has no column 'y of drum_0 \\[m\\]'"),
        ("t [s]\nnot a number\n", "not a file of Response.csv"),
    ],
)
def test_other_files_are_refused(column, tmp_path, text, message):
    (tmp_path / "other.csv").write_text(text)
    with pytest.raises(ValueError, match=message):
        read_motion(load(column[0]), tmp_path / "other.csv")


def test_a_joint_of_another_model_has_no_column():
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint name='cart'/><geom size='1'/></body></worldbody></mujoco>"
    )
    assert columns_of(model) == ["the joint cart"]


WINDOW = """
import os, sys, threading
from pathlib import Path
from mjrock.engine.replay import Replay, launcher, load, read_motion, show
launch, model = launcher(), load(Path(sys.argv[1]))
replay = Replay(model, read_motion(model, Path(sys.argv[2])))
def told():
    print(replay.data.time, flush=True)
    os._exit(0)  # a window that another thread closes while it is drawn crashes now and then
threading.Timer(3.0, told).start()
show(replay, launch, 1.0)
"""


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("Xvfb") is None, reason="needs Xvfb")
def test_a_window_opens_and_goes_on(column):
    """In MuJoCo's own viewer on a virtual display."""
    with subprocess.Popen(["Xvfb", ":97", "-screen", "0", "800x600x24"], stderr=subprocess.DEVNULL) as server:
        time.sleep(2)
        command = [sys.executable, "-c", WINDOW, *map(str, column[:2])]
        shown = {**os.environ, "DISPLAY": ":97"}
        try:
            told = subprocess.run(command, env=shown, capture_output=True, text=True, timeout=60, check=True).stdout
        finally:
            server.terminate()
    assert float(told.split()[-1]) > 0.4  # beyond the answer
