"""The tests of explicit steps in processes whose loops check every index, and whose loops are plain Python."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

CHECKED = """
import numpy as np

from mjrock.compiled import compiled, inlined
from mjrock.distinct.rows import kinds
from mjrock.rows import rows


@inlined
def write_row(table, i):
    table[i].impulse = 1.0


@compiled
def rows_beyond(table, i):
    write_row(table, i)


@compiled
def numbers_beyond(table, i):
    table[i] = 1.0


some = rows(kinds(2).tangent, 2)
for loop, table in ((rows_beyond, some), (numbers_beyond, np.zeros(2)), (numbers_beyond, np.zeros(0))):
    try:
        loop(table, len(table))
    except IndexError:
        print("refused")
"""
"""Rows and arrays, in the loop itself and in a function that takes the place of its call."""

EXPLICIT = """
import sys

import pytest

import mjrock as mr

mr.simulate = lambda *given, **named: pytest.skip("the loops of steps in MuJoCo are others")


class FirstAndLast:
    @pytest.hookimpl(trylast=True)  # of those that are not slow
    def pytest_collection_modifyitems(self, items):
        functions = {}
        for item in items:
            functions.setdefault(item.nodeid.partition("[")[0], []).append(item)
        items[:] = [item for each in functions.values() for item in (each[0], *each[1:][-1:])]


sys.exit(pytest.main(sys.argv[1:], plugins=[FirstAndLast()]))
"""
"""Tests by their first and last arguments, less those of steps in MuJoCo, whose loops would take as long to compile."""


SMALL = [
    "bonds_of_lines",
    "clipping",
    "contact_lines",
    "forces_of_lines",
    "friction_of_lines",
    "handing_over",
    "longest_step",
    "loop_of_steps",
    "motion_damping",
    "pulls_of_links",
    "rotation_of_bodies",
    "softening",
    "solids",
    "touches_of_lines",
]
"""Tests of single functions, and of a few steps."""


def checked(tmp_path, *command):
    """A Python command whose loops are compiled with checks."""
    environment = {**os.environ, "NUMBA_BOUNDSCHECK": "1", "NUMBA_CACHE_DIR": str(tmp_path), "PYTHONHASHSEED": "0"}
    return subprocess.run([sys.executable, *command], env=environment, capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_an_index_beyond_an_array_is_refused(tmp_path):
    program = tmp_path / "beyond.py"
    program.write_text(CHECKED, encoding="utf-8")
    run = checked(tmp_path, str(program))
    assert run.stdout.split() == ["refused"] * 3, run.stderr


@pytest.mark.slow
def test_no_loop_of_the_explicit_steps_writes_beyond_its_arrays(tmp_path):
    """The everyday tests of this folder, less those of laws of the user, which bring loops of their own."""
    folder = Path(__file__).parent
    options = [
        "-n",
        "0",
        "-q",
        "-p",
        "no:cacheprovider",
        *(f"--ignore={path}" for path in folder.glob("test_own_*.py")),
    ]
    run = checked(tmp_path, "-c", EXPLICIT, *options, str(folder))
    assert run.returncode == 0, run.stdout[-4000:] + run.stderr[-2000:]


@pytest.mark.slow
def test_the_loops_do_the_same_as_plain_python():
    """The small tests, by what runs where a loop is not compiled."""
    files = [str(Path(__file__).with_name(f"test_{name}.py")) for name in SMALL]
    command = [sys.executable, "-m", "pytest", "-n", "0", "-q", "-p", "no:cacheprovider", *files]
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    run = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout[-4000:] + run.stderr[-2000:]
