"""The contacts as a package: what they import, and the command; within mjrock, and where mjcontacts is installed."""

import re
import subprocess
import sys

from pairs import BALL, FLOOR, scene

import mjrock.contacts as package

HEAVY = "numba", "scipy", "matplotlib", "tqdm", "filelock", "pebble", "pandas"


def python(code, *arguments):
    return subprocess.run(
        [sys.executable, "-W", "error", *code, *arguments], capture_output=True, text=True, check=False
    )


def test_every_name_is_there():
    assert [name for name in package.__all__ if getattr(package, name) is None] == []
    assert dir(package) == package.__all__


def test_mujoco_and_numpy_are_enough():
    """All names, with what other packages bring out of reach."""
    code = f"""
import sys
for name in {HEAVY}:
    sys.modules[name] = None
import {package.__name__} as package
assert "mujoco" not in sys.modules
assert all(getattr(package, name) for name in package.__all__)
"""
    assert python(["-c", code]).stderr == ""


def test_the_command_prints_a_table(tmp_path):
    path = tmp_path / "model.xml"
    path.write_text(scene(FLOOR, BALL, timestep=1e-3, gravity=9.81))
    done = python(["-m", package.__name__], "inspect", str(path))
    assert (done.returncode, done.stderr) == (0, "")
    assert re.search(r"^floor  ball  +\d", done.stdout, re.MULTILINE)
    done = python(["-m", package.__name__], "inspect", str(tmp_path / "none.xml"))
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: model ")
