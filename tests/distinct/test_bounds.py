"""Compiled loops stay within their arrays: the tests of explicit steps in a process whose loops check every index."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

CHECKED = """
import numpy as np

from mjrock.compiled import compiled, inlined
from mjrock.distinct.rows import kinds, rows


@inlined
def write_row(table, i):
    table[i].impulse = 1.0


@compiled
def rows_beyond(table, i):
    write_row(table, i)


@compiled
def numbers_beyond(table, i):
    table[i] = 1.0


for loop, table in ((rows_beyond, rows(kinds(2).way, 2)), (numbers_beyond, np.zeros(2)), (numbers_beyond, np.zeros(0))):
    try:
        loop(table, len(table))
    except IndexError:
        print("refused")
"""
"""Rows and arrays, in the loop itself and in a function that takes the place of its call."""


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
    """All everyday tests of this folder, which take some two minutes of a core, half of them to compile."""
    run = checked(tmp_path, "-m", "pytest", "-n", "0", "-q", "-p", "no:cacheprovider", str(Path(__file__).parent))
    assert run.returncode == 0, run.stdout[-4000:] + run.stderr[-2000:]
