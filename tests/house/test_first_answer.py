"""Where no loop is stored, a short run has its answer as plain Python while another process compiles."""

import multiprocessing
import os
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import timeit
from pathlib import Path

import filelock
import numpy as np
import pytest
from everyday import slow

import mjrock as mr
from mjrock import background_compilation, compiled, machine

PACKAGE = Path(mr.__file__).parent
pytest.importorskip("numba")

WALL = """
import sys, time
import mjrock as mr
from mjrock import background_compilation
wall = mr.Block.from_size(0.6, 4.2)
contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05)
case = mr.Case(wall, 0.3 * wall.alpha, 0.3, side_stop=False)
answer = mr.simulate(case, contacts)
behind = background_compilation._process.compiler
print(answer.theta[-1].hex(), "numba" in sys.modules, behind and behind.process.pid, flush=True)
"""

THEORY = """
import sys, time
import mjrock as mr
from mjrock import background_compilation
from mjrock.theory.arcs import rocking_loop
wall = mr.Block.from_size(0.6, 4.2)
case, e = mr.Case(wall, 0.3 * wall.alpha, 0.3, side_stop=False), mr.Restitution.from_geometry(wall)
answer = mr.solve_analytical(case, e)
print(answer.theta[-1].hex())
"""
"""Rocking theory, whose loop is compiled the soonest."""


BEHIND = """
from mjrock import compiler
compiler.lock_of_store = lambda: "no other process matters here"
compiler.serve(0.2)
"""

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="it looks into /proc")


@pytest.fixture
def fresh(tmp_path):
    """A copy of the package that has stored nothing."""
    shutil.copytree(PACKAGE, tmp_path / "mjrock", ignore=shutil.ignore_patterns("*.nb[ci]*"))
    return tmp_path


def started(folder, program=WALL, interpret="1", *, at_home=False, **environment):
    """A program in a process of its own that takes the package in a folder; as if it were no test, where it lies at
    home."""
    away = ("NUMBA_CACHE_DIR", *(background_compilation.ENDING if at_home else ()))
    setting = {name: value for name, value in os.environ.items() if name not in away}
    setting |= {"PYTHONPATH": str(folder), "MJROCK_INTERPRET": interpret} | environment
    if at_home:
        setting["TMPDIR"] = str(folder / "mjrock" / "theory")  # any folder in which the package does not lie
    piped = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen([sys.executable, "-c", program], env=setting, cwd=folder, **piped)


def message(folder, program=WALL, interpret="1", **environment):
    """What a program prints: on the first line its answer, whether numba is imported, which process compiles."""
    out, err = started(folder, program, interpret, **environment).communicate()
    assert err == "", err
    return out.split()


def has_stored(folder):
    """Whether a loop is stored."""
    return any((folder / "mjrock").rglob("*.nbc"))


def is_alive(process):
    """Whether a process runs, and is no zombie. Its first thread is one before the others have ended."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
        return state != "Z" or len(os.listdir(f"/proc/{process}/task")) > 1
    except OSError:
        return False


def ended(process):
    """Whether a process ends by itself. On a busy machine one of low priority takes minutes to import numba."""
    until = time.monotonic() + 300
    while is_alive(process) and time.monotonic() < until:
        time.sleep(0.05)
    return not is_alive(process)


@pytest.mark.parametrize("ending", [slow("ends"), "killed"])
def test_an_answer_comes_first_and_the_process_that_compiles_ends_with_its_parent_in_a_test(fresh, ending):
    """The answer comes before, without a compiler and with the same digits."""
    parent = started(fresh, WALL + "sys.stdin.read()")
    theta, numba, process = parent.stdout.readline().split()
    wall = mr.Block.from_size(0.6, 4.2)
    contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05)
    assert theta == mr.simulate(mr.Case(wall, 0.3 * wall.alpha, 0.3, side_stop=False), contacts).theta[-1].hex()
    assert numba == "False"
    if process == "None" or sys.platform != "linux":
        assert parent.communicate("")[1] == ""
        pytest.skip("one core, or a system that does not tell which processes run")
    assert is_alive(process)
    if ending == "killed":
        parent.kill()
    assert parent.communicate("")[1] == ""
    assert ended(process)
    assert not has_stored(fresh)


@linux
def test_the_process_that_compiles_outlives_a_short_script_and_says_so(fresh):
    parent = started(fresh, at_home=True)
    process = parent.stdout.readline().split()[-1]
    if process == "None":
        pytest.skip("one core: nothing compiles behind a run")
    message = parent.communicate("")[1]
    try:
        assert is_alive(process)
        assert message == (
            f"mjrock: process {process} goes on compiling for at most 120 s, at low priority; the next start takes "
            "what it stores. It can be ended without harm\n"
        )
        nice = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[16]
        assert int(nice) == min(os.nice(0) + 10, 19)
    finally:
        os.kill(int(process), signal.SIGKILL)


@linux
@pytest.mark.slow
def test_the_second_start_takes_compiled_loops(fresh):
    """Of a script that ends long before the compiler does. The bits are the same, and nothing is said any more."""
    counted = "print(sum(rocking_loop.stats.cache_hits.values()) if rocking_loop._loaded else 0)"
    first = started(fresh, THEORY + counted, at_home=True)
    printed, message = first.communicate("")
    if machine.cores() == 1:
        pytest.skip("one core: nothing compiles behind a run")
    assert printed.split()[-1] == "0"
    assert ended(message.split("process ")[1].split()[0])
    assert started(fresh, THEORY + counted, at_home=True).communicate("") == (printed.split()[0] + "\n1\n", "")


@linux
def test_one_process_for_each_store_compiles_behind_others(fresh):
    """A second one ends at once, though its parent runs on."""
    kept = fresh / "mjrock" / "__pycache__" / "compiler.lock"
    kept.parent.mkdir(exist_ok=True)
    with filelock.FileLock(kept):
        parent = started(fresh, WALL + "sys.stdin.read()", at_home=True)
        process = parent.stdout.readline().split()[-1]
        assert process == "None" or ended(process)
        assert parent.communicate("")[1] == ""


@pytest.mark.parametrize("setting", [*background_compilation.ENDING, "NUMBA_CACHE_DIR", "first process", "worker"])
def test_where_the_process_that_compiles_ends_with_its_parent(setting, monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path))
    for name in (*background_compilation.ENDING, "NUMBA_CACHE_DIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(os, "getppid", lambda: 77)
    assert background_compilation.may_outlive()
    if setting == "first process":
        monkeypatch.setattr(os, "getppid", lambda: 1)
    elif setting == "worker":
        monkeypatch.setattr(multiprocessing, "parent_process", multiprocessing.current_process)
    else:
        monkeypatch.setenv(setting, str(tmp_path / "store"))
    assert not background_compilation.may_outlive()


@linux
def test_the_process_that_compiles_is_limited():
    """In the time of a core, in memory, and in time after its parent."""
    limits = "from mjrock import compiler; import resource as r; compiler.limit(); print(*r.getrlimit(r.RLIMIT_CPU))"
    assert subprocess.check_output([sys.executable, "-c", limits], text=True).split() == ["120", "120"]
    run = background_compilation.Run(timeit.timeit, {"stmt": "import time; time.sleep(600)", "number": 1})
    begun = time.monotonic()
    process = subprocess.Popen([sys.executable, "-c", BEHIND], stdin=subprocess.PIPE)
    process.communicate(pickle.dumps(pickle.dumps(run)))
    assert process.returncode == 1
    assert time.monotonic() - begun < 300


@pytest.mark.slow
def test_later_calls_take_what_another_process_has_stored(fresh):
    waiting = """
first, until = answer.theta, time.monotonic() + 300
while "numba" not in sys.modules and time.monotonic() < until:
    time.sleep(0.5)
    background_compilation._process.taken = 0.0  # as if plain Python took no time
    answer = mr.solve_analytical(case, e)
assert (answer.theta == first).all()
print(bool(rocking_loop.signatures), sum(rocking_loop.stats.cache_hits.values()))
"""
    assert message(fresh, THEORY + waiting)[-2:] == ["True", "1"]


@pytest.mark.slow
def test_two_processes_at_once_compile_a_loop_once(fresh):
    """The second waits for the first, and then takes what it has stored."""
    once = """
print(sum(rocking_loop.stats.cache_misses.values()), sum(rocking_loop.stats.cache_hits.values()))
"""
    both = [started(fresh, THEORY + once, interpret="0") for _ in range(2)]
    found = [process.communicate()[0].split() for process in both]
    assert found[0][0] == found[1][0]
    assert sorted(counts[-2:] for counts in found) in ([["0", "1"], ["1", "0"]], [["1", "0"], ["1", "1"]])


@pytest.mark.slow
def test_campaign_workers_compile(fresh):
    program = """
import mjrock as mr
def build(scale):
    wall = mr.Block.from_size(0.6, 4.2)
    e = mr.Restitution.from_geometry(wall)
    return mr.Analysis(mr.Case(wall, scale * wall.alpha, 0.2, side_stop=False), "analytical", e)
if __name__ == "__main__":
    mr.campaign(mr.Grid(build, scale=[0.2, 0.3, 0.4, 0.5]), "walls.sqlite", workers=2)
"""
    (fresh / "walls.py").write_text(program)
    run = subprocess.run(
        [sys.executable, "walls.py"],
        env=os.environ | {"PYTHONPATH": str(fresh), "MJROCK_INTERPRET": "1"},
        cwd=fresh,
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stderr.count("compiling rocking theory") == 1
    assert has_stored(fresh)


def test_switched_off_it_compiles(fresh, monkeypatch):
    monkeypatch.setenv("MJROCK_INTERPRET", "0")
    with background_compilation.first_answer(print):
        assert not background_compilation.allowed(at_once=False)
    monkeypatch.setenv("MJROCK_INTERPRET", "1")
    with background_compilation.first_answer(print):
        assert background_compilation.allowed(at_once=False)
        assert not background_compilation.allowed(at_once=True)
        monkeypatch.setattr(background_compilation._process, "taken", background_compilation.COMPILING)
        assert not background_compilation.allowed(at_once=False)
    monkeypatch.setattr(background_compilation._process, "taken", 0.0)
    assert not background_compilation.allowed(at_once=False)
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    with background_compilation.first_answer(print):
        assert not background_compilation.allowed(at_once=False)


def test_a_long_run_compiles_at_once(monkeypatch):
    monkeypatch.setenv("MJROCK_INTERPRET", "1")
    monkeypatch.setattr(background_compilation._process, "taken", 0.0)
    with background_compilation.first_answer(print):
        background_compilation.expect(0.5 * background_compilation.COMPILING)
        assert background_compilation.allowed(at_once=False)
        monkeypatch.setattr(background_compilation._process, "taken", 0.6 * background_compilation.COMPILING)
        background_compilation.expect(0.5 * background_compilation.COMPILING)
        assert not background_compilation.allowed(at_once=False)


@pytest.fixture
def patient(monkeypatch):
    """First answers in this process, by loops that nobody compiles behind it."""
    monkeypatch.setenv("MJROCK_INTERPRET", "1")
    monkeypatch.setattr(background_compilation._process, "taken", 0.0)
    monkeypatch.setattr(background_compilation._process, "started", background_compilation.MOST)


def double(values):
    for i in range(len(values)):
        values[i] = 2 * values[i]


def test_the_time_of_plain_python_counts(patient, monkeypatch):
    """Once it is as long as compiling, the loop is compiled."""
    loop, room = compiled.compiled(double), np.array([1.0, 2.0])
    monkeypatch.setattr(compiled, "may_be_stored", lambda function: False)
    with background_compilation.first_answer(print):
        loop(room)
        assert 0 < background_compilation._process.taken < 1
        assert "dispatcher" not in vars(loop)
        monkeypatch.setattr(background_compilation._process, "taken", background_compilation.COMPILING)
        loop(room)
    assert len(loop.signatures) == 1
    assert list(room) == [4.0, 8.0]


@pytest.mark.parametrize("written", ["never", "not read"])
def test_a_disk_that_refuses(patient, monkeypatch, written):
    """A full or damaged disk: short runs go on as plain Python, and what is compiled in the end runs."""
    from numba.core.caching import FunctionCache

    def refused(self, *key):
        raise OSError(28, "No space left on device")

    for name in ("save_overload", "load_overload") if written == "never" else ("load_overload",):
        monkeypatch.setattr(FunctionCache, name, refused)
    loop, room = compiled.compiled(double), np.array([1.0])
    with background_compilation.first_answer(print):
        loop(room)
    loop(room)
    assert list(room) == [4.0]


def test_the_disk_is_full_where_a_lock_should_be(patient, monkeypatch):
    class Full(filelock.FileLock):
        def acquire(self, *arguments, **named):
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(filelock, "FileLock", Full)
    room = np.array([1.0])
    compiled.compiled(double)(room)
    assert list(room) == [2.0]


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_ends_a_run_in_plain_python(fresh):
    """The run of a record of 30 s, which takes some seconds as plain Python; the next one has its answer."""
    program = """
record = mr.GroundMotion.synthetic(peak=4.0, duration=30.0, seed=1)
try:
    print("begins", flush=True)
    mr.simulate(mr.Case(wall, 0.0, 30.0, motion=record, side_stop=False), contacts)
except KeyboardInterrupt:
    print((mr.simulate(case, contacts).theta == answer.theta).all(), "numba" in sys.modules)
"""
    run = started(fresh, WALL + program)
    while run.stdout.readline() != "begins\n":
        pass
    time.sleep(0.5)
    run.send_signal(signal.SIGINT)
    assert run.communicate() == ("True False\n", "")
