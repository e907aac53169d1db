"""Ctrl-C while modules are imported: it is heard afterwards, and what follows works."""

import importlib
import signal
import subprocess
import sys
import threading

import pytest

from mjrock.interrupts import interrupts_held_back


def interrupted(then):
    """Ctrl-C, and then something else, in two blocks that hold it back, one in the other."""
    with interrupts_held_back(), interrupts_held_back():
        signal.raise_signal(signal.SIGINT)
        then()


def test_ctrl_c_is_heard_when_the_block_has_ended():
    done = []
    with pytest.raises(KeyboardInterrupt):
        interrupted(lambda: done.append(1))
    assert done == [1]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_it_is_heard_too_where_the_block_fails():
    with pytest.raises(KeyboardInterrupt) as caught:
        interrupted(lambda: importlib.import_module("no_such_module"))
    assert isinstance(caught.value.__context__, ImportError)


def test_other_threads_and_programs_that_ignore_it_are_left_alone(monkeypatch):
    seen = []

    def look():
        with interrupts_held_back():
            seen.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=look)
    thread.start()
    thread.join()
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        look()
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen == [before, signal.SIG_IGN]


SCRIPT = """
import os, signal, sys
import numpy as np
import mjrock as mr
from mjrock import compiled

class Interrupting:
    # Ctrl-C as the n-th module that numba brings is looked for
    def __init__(self, n):
        self.left = n
    def find_spec(self, name, path=None, target=None):
        if "numba" in sys.modules or name.startswith("numba"):
            self.left -= 1
            if self.left == 0:
                signal.raise_signal(signal.SIGINT)

def double(values):
    for i in range(len(values)):
        values[i] = 2 * values[i]

def child(n):
    finder = Interrupting(n)
    sys.meta_path.insert(0, finder)
    try:
        compiled.compiled(double)(np.ones(2))
    except KeyboardInterrupt:
        pass
    else:
        return f"{n}: not interrupted"
    assert finder.left <= 0
    for _ in range(2):
        room = np.ones(2)
        compiled.compiled(double)(room)
        assert list(room) == [2.0, 2.0]

assert "numba" not in sys.modules
for n in map(int, sys.argv[1:]):  # numba brings some 260 modules
    pid = os.fork()
    if pid == 0:
        answer = 1
        try:
            said = child(n)
            answer = 0 if said is None else 1
            if said:
                print(said, file=sys.stderr)
        finally:
            os._exit(answer)
    if os.waitpid(pid, 0)[1]:
        sys.exit(f"interrupted at module {n}: the next call fails")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="it forks a process for each moment")
@pytest.mark.parametrize(
    "moments", [(60,), pytest.param((1, 2, 10, 30, 70, 100, 130, 160, 200, 240), marks=pytest.mark.slow)], ids=len
)
def test_ctrl_c_while_numba_is_imported(moments):
    """The call is interrupted, and the same call works after it."""
    pytest.importorskip("numba")
    command = [sys.executable, "-c", SCRIPT, *map(str, moments)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr[-2000:]
