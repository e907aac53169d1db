"""The compiled loops: they run as plain Python with the same results, are stored, and are made anew when they must
be."""

import ast
import importlib
import os
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from trees import nodes

import mjrock as mr
from mjrock import background_compilation, bars, compiled, compiler, loop_cache

PACKAGE = Path(mr.__file__).parent

ANEW = "in every process: no folder is found that can be written; name one in the environment variable NUMBA_CACHE_DIR"

COMPILING = "compiling rocking theory, some 3 s of a core, "

RUN = """
import sys
import numpy as np
import mjrock as mr
wall = mr.Block.from_size(0.6, 4.2)
e = mr.Restitution.from_geometry(wall.alpha)
contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05, k_side=5e8, xi_side=0.008)
motion = mr.GroundMotion.sine(-2.6, 0.6, samples=40)
rocking = mr.simulate(mr.Case(wall, 0.3 * wall.alpha, 0.7), contacts, ledger=True)
shaken = mr.simulate(mr.Case(wall, 0.0, 0.5, motion=motion), contacts)
fixed = mr.simulate(mr.Case(wall, 0.3 * wall.alpha, 0.02), contacts, 1e-4)
theory = mr.solve_analytical(mr.Case(wall, 0.0, 3.0, motion=motion), e)
np.savez(sys.argv[1], rocking=rocking.theta, ledger=rocking.energy_residual, shaken=shaken.theta, fixed=fixed.theta,
         theory=theory.theta, impacts=theory.impacts, steps=[rocking.stats["steps"], shaken.stats["steps"]])
"""


THEORY = """
import sys
import numpy as np
import mjrock as mr
wall = mr.Block.from_size(0.6, 4.2)
motion = mr.GroundMotion.sine(-2.6, 0.6, samples=40)
case = mr.Case(wall, 0.0, 0.6, side_stop=False, motion=motion)
np.savez(sys.argv[1], shaken=mr.solve_analytical(case, mr.Restitution.from_geometry(wall)).theta)
"""
"""Rocking theory, whose loop is compiled the soonest of those that a user is told of."""


def run(path, home=None, program=RUN, **environment):
    """Run a program in a process of its own, with the package copied to `home` if one is given; its stderr."""
    setting = os.environ | environment
    if home is not None:
        setting["PYTHONPATH"] = str(home)
    done = subprocess.run(
        [sys.executable, "-c", program, str(path)],
        env=setting,
        capture_output=True,
        text=True,
        check=False,
        cwd=path.parent,
    )
    assert done.returncode == 0, done.stderr
    return done.stderr


def same(left, right):
    """Whether two files hold the same arrays, to rounding: the compiler may order additions otherwise."""
    with np.load(left) as a, np.load(right) as b:
        for name in a.files:
            np.testing.assert_allclose(a[name], b[name], rtol=1e-9, atol=1e-9 * np.abs(a[name]).max())


@pytest.mark.slow
def test_without_numba_there_is_one_line_and_the_same_result(tmp_path):
    """As on a Python for which numba has no wheel: a module of its name that cannot be imported."""
    (tmp_path / "numba").mkdir()
    (tmp_path / "numba" / "__init__.py").write_text("raise ImportError('no wheel')")
    message = run(tmp_path / "without.npz", home=tmp_path)
    assert message.splitlines() == [
        "mjrock: numba is not installed; "
        "the loops run as plain Python, thirty times slower, thousands in explicit steps"
    ]
    run(tmp_path / "compiled.npz")
    same(tmp_path / "without.npz", tmp_path / "compiled.npz")


@pytest.mark.slow
def test_stored_once_and_made_anew_when_a_source_changes(tmp_path):
    """The first run says that it compiles, the second does not; a change in a file that the loop only calls is seen."""
    copy = tmp_path / "mjrock"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))

    compiling = [f"mjrock: {COMPILING}once; stored in {copy / 'theory' / '__pycache__'}"]
    assert run(tmp_path / "a.npz", home=tmp_path, program=THEORY).splitlines() == compiling
    assert run(tmp_path / "b.npz", home=tmp_path, program=THEORY) == ""
    same(tmp_path / "a.npz", tmp_path / "b.npz")
    law = copy / "theory" / "law.py"
    rule = "return Push(x, x_rate,"
    assert rule in law.read_text()
    law.write_text(law.read_text().replace(rule, "return Push(2 * x, 2 * x_rate,"))
    assert run(tmp_path / "c.npz", home=tmp_path, program=THEORY).splitlines() == compiling
    with np.load(tmp_path / "a.npz") as a, np.load(tmp_path / "c.npz") as c:
        assert np.abs(c["shaken"]).max() > 1.5 * np.abs(a["shaken"]).max()


def test_the_stamp_of_a_module_is_that_of_what_it_imports(tmp_path):
    """An edit of a module that it does not import leaves it, also one of a module that imports it."""
    copy = tmp_path / "mjrock"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__", "laws"))

    def edited(module, old="", new="# @compiled"):
        """Which of three modules with loops have another stamp after an edit of a module with compiled functions, or
        after an edit in the one line that has some text."""
        path = copy / module
        text = path.read_text()
        assert not old or text.count(old) == 1
        path.write_text(text.replace(old, new) if old else f"{text}\n{new}\n")
        after = stamps()
        path.write_text(text)
        return {name for name, stamp in before.items() if stamp != after[name]}

    def stamps():
        loop_cache._imports.cache_clear()
        names = ("engine/loop.py", "theory/arcs.py", "distinct/loop.py")
        return {name: loop_cache.stamp(copy / name) for name in names}

    before = stamps()
    assert edited("distinct/loop.py") == {"distinct/loop.py"}
    assert edited("distinct/contacts/contact.py") == {"distinct/loop.py"}
    assert edited("theory/arcs.py") == {"theory/arcs.py"}
    assert edited("engine/loop.py") == {"engine/loop.py"}
    assert edited("engine/step_control.py") == {"engine/loop.py"}
    assert "engine/loop.py" in edited("geometry/frames.py")  # which it reaches by others
    assert edited("engine/memory.py", "TIMESTEP, IMPRATIO = 0, 1", "TIMESTEP, IMPRATIO = 1, 0") == {"engine/loop.py"}
    order = "    pose: Array\n    velocity: Array\n", "    velocity: Array\n    pose: Array\n"
    assert edited("engine/memory.py", *order) == {"engine/loop.py"}
    assert edited("engine/memory.py", '"linux": "libmujoco', '"linux": "lib') == set()  # no compiled function knows it
    assert edited("engine/memory.py", "the two addresses.", "both.") == set()
    assert edited("distinct/rows.py", "\nPOINT_ON_FIXED_BLOCK =", "\nPOINT_ON_FIXED_BLOCK = 1 +") == {
        "distinct/loop.py"
    }
    every = {"engine/loop.py", "theory/arcs.py", "distinct/loop.py"}
    assert edited("quantities.py", "\nGRAVITY =", "\nGRAVITY = 1 +") == edited("compiled.py") == every
    assert edited("distinct/search/contact_search.py") <= {"distinct/loop.py"}


@pytest.mark.slow
def test_a_read_only_installation_works(tmp_path):
    """No folder can be written, neither the package's nor the user's: short runs go as plain Python, and where they may
    not, the loops are compiled in each process."""
    copy = tmp_path / "site" / "mjrock"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    # a file where the folders would have to be made, which stops even the superuser
    for folder in (copy, *(path for path in copy.iterdir() if path.is_dir() and path.name != "laws")):
        (folder / "__pycache__").touch()
    (tmp_path / "home").touch()
    nowhere = {"HOME": str(tmp_path / "home"), "XDG_CACHE_HOME": str(tmp_path / "home"), "PYTHONDONTWRITEBYTECODE": "1"}
    message = run(tmp_path / "anew.npz", home=tmp_path / "site", program=THEORY, **nowhere)
    assert message.splitlines() == [f"mjrock: {COMPILING}{ANEW}"]
    assert run(tmp_path / "plain.npz", home=tmp_path / "site", program=THEORY, MJROCK_INTERPRET="1", **nowhere) == ""
    run(tmp_path / "stored.npz", program=THEORY)
    same(tmp_path / "anew.npz", tmp_path / "stored.npz")
    same(tmp_path / "plain.npz", tmp_path / "stored.npz")
    command = [sys.executable, "-m", "mjrock", "compile"]
    setting = os.environ | nowhere | {"PYTHONPATH": str(tmp_path / "site")}
    refused = subprocess.run(command, env=setting, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (refused.returncode, refused.stderr) == (2, f"error: {loop_cache.NOWHERE}\n")


def test_a_cache_that_cannot_be_read_or_written_is_none(monkeypatch):
    """A damaged file, a full disk: the loop is compiled and runs."""
    if not compiled._numba():
        pytest.skip("without numba nothing is stored")
    from numba.core.caching import FunctionCache

    def broken(self, *key):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(FunctionCache, "load_overload", broken)
    monkeypatch.setattr(FunctionCache, "save_overload", broken)
    double = compiled.compiled(PROBE)
    room = np.array([1.0, 2.0])
    double(room)
    assert list(room) == [2.0, 4.0]


def test_a_cache_that_names_a_class_that_is_gone_is_made_anew():
    """As after a change of version in place."""
    if not compiled._numba():
        pytest.skip("without numba nothing is stored")
    index = Path(compiled.compiled(PROBE).dispatcher._cache._cache_file._index_path)
    index.parent.mkdir(exist_ok=True)
    index.write_bytes(pickle.dumps(compiled._numba().__version__) + b"cmjrock.compiled\ngone\n.")
    for _ in range(2):  # the second reads what the first has stored
        double, room = compiled.compiled(PROBE), np.array([1.0, 2.0])
        double(room)
        assert list(room) == [2.0, 4.0]
    assert sum(double.stats.cache_hits.values()) == 1


def test_where_no_folder_can_be_written_it_says_so(monkeypatch, capfd):
    """Also of a read-only package whose user has no home: what to set is named, and nothing is promised."""
    if not compiled._numba():
        pytest.skip("without numba nothing is stored")
    from numba.core.caching import FunctionCache

    monkeypatch.setattr(FunctionCache._impl_class, "_locator_classes", [])
    compiled.compiled(PROBE)(np.ones(2))
    assert capfd.readouterr().err == ""  # what takes no time is not worth a line
    monkeypatch.setitem(loop_cache.SLOW, f"{PROBE.__module__}.PROBE", ("probes", 7))
    compiled.compiled(PROBE)(np.ones(2))
    assert capfd.readouterr().err == f"mjrock: compiling probes, some 7 s of a core, {ANEW}\n"


def test_where_nothing_can_be_stored_short_runs_are_plain_python(monkeypatch):
    if not compiled._numba():
        pytest.skip("without numba nothing is stored")
    from numba.core.caching import FunctionCache

    monkeypatch.setattr(FunctionCache._impl_class, "_locator_classes", [])
    monkeypatch.setenv("MJROCK_INTERPRET", "1")
    monkeypatch.setattr(background_compilation._process, "taken", 0.0)
    monkeypatch.setattr(background_compilation._process, "started", background_compilation.MOST)
    probe, room = compiled.compiled(PROBE), np.ones(2)
    with background_compilation.first_answer(print):
        probe(room)
        assert not probe.signatures
        monkeypatch.setattr(background_compilation._process, "taken", background_compilation.COMPILING)
        probe(room)
    assert len(probe.signatures) == 1
    assert list(room) == [4.0, 4.0]
    assert compiler.lock_of_store() is None


def test_where_there_is_no_standard_error_it_compiles_in_silence(monkeypatch, tmp_path):
    """As of pythonw on Windows, of services, and of programs without a console. It compiles also what is stored."""
    if not compiled._numba():
        pytest.skip("without numba nothing is stored")
    from numba.core.caching import FunctionCache

    monkeypatch.setattr(FunctionCache, "load_overload", lambda self, *key: None)
    monkeypatch.setitem(loop_cache.SLOW, f"{PROBE.__module__}.PROBE", ("probes", 7))
    monkeypatch.setattr(sys, "stderr", None)
    room = np.ones(2)
    compiled.compiled(PROBE)(room)
    assert list(room) == [2.0, 2.0]
    with bars.shown_bar("probes", "pieces", 3) as bar:
        bar.update(2)
    wall = mr.Block.from_size(0.6, 4.2)
    monkeypatch.undo()
    monkeypatch.setattr(sys, "stderr", None)
    walls = [mr.Analysis(mr.Case(wall, 0.05, 0.1), "analytical", mr.Restitution.from_geometry(wall))]
    mr.campaign(walls, tmp_path / "walls.sqlite", workers=1)
    with mr.Store(tmp_path / "walls.sqlite") as store:
        assert [row["status"] for row in store.rows()] == ["done"]


@pytest.mark.slow
def test_the_command_stores_what_it_finds_missing(tmp_path):
    """Here rocking theory, the soonest compiled. The command names the folder of the loops."""
    copy = tmp_path / "mjrock"
    shutil.copytree(PACKAGE, copy)
    before = sorted(copy.rglob("*.nbc"))
    gone = [path for path in before if path.parents[1].name == "theory"]
    assert gone
    for path in (copy / "theory").rglob("*.nb[ci]"):
        path.unlink()
    command = [sys.executable, "-m", "mjrock", "compile"]
    printed = subprocess.check_output(command, env=os.environ | {"PYTHONPATH": str(tmp_path)}, cwd=tmp_path, text=True)
    assert printed.startswith(f"the loops are stored in {copy}; ")
    assert [path for path in gone if not path.exists()] == []
    assert len(before) > 30


COVERED = (
    """
import gc, sys
from mjrock.compiled import Loop
from mjrock.study.compilation import RUNS, carry_out

def signatures():
    loops = [each for each in gc.get_objects() if type(each) is Loop]
    return {(loop.__qualname__, types) for loop in loops for types in loop.signatures}

first = signatures()
for number in range(len(RUNS)):
    carry_out(number)
of_command = signatures()
"""
    + RUN
    + """
print(len(of_command - first), len(signatures() - of_command), *signatures() - of_command)
"""
)
"""How many loops the command compiles, and which a script compiles after it."""


@pytest.mark.slow
def test_the_command_compiles_what_scripts_call(tmp_path):
    """A wall in MuJoCo and rocking theory need no loop for arguments of other types."""
    command, setting = [sys.executable, "-c", COVERED, str(tmp_path / "a.npz")], os.environ | {"MJROCK_INTERPRET": "0"}
    of_command, more, *which = subprocess.check_output(command, env=setting, text=True).split(maxsplit=2)
    assert int(of_command) > 10
    assert int(more) == 0, which


def test_squares_are_products():
    """A power of a NumPy number and of a compiled one may differ in the last bit, which plain Python must not."""
    powers = []
    for folder in ("engine", "geometry", "problem", "result", "scene", "theory"):
        for path in (PACKAGE / folder).rglob("*.py"):
            for function in nodes(path):
                marks = {getattr(mark, "id", "") for mark in getattr(function, "decorator_list", ())}
                if marks & {"compiled", "inlined"}:
                    found = [node for node in ast.walk(function) if isinstance(getattr(node, "op", None), ast.Pow)]
                    powers += [f"{path.relative_to(PACKAGE)}:{node.lineno}" for node in found]
    assert powers == []


def test_loops_that_take_seconds_to_compile_are_there():
    for name in loop_cache.SLOW:
        module, function = name.rsplit(".", 1)
        assert callable(getattr(importlib.import_module(module), function))


@pytest.mark.slow
def test_the_folder_of_the_environment_comes_first(tmp_path):
    script = "from mjrock.engine import loop; print(loop.fitted_loop._cache.cache_path)"
    run = subprocess.run(
        [sys.executable, "-c", script],
        env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert Path(run.stdout.strip()).parent == tmp_path


def PROBE(values):
    for i in range(len(values)):
        values[i] = 2 * values[i]


def total(values, factors):
    """The sum of values times the first of some factors."""
    added = 0.0
    for i in range(len(values)):
        added += factors[0] * values[i]
    return added


def corner(values):
    """The last value of a plane array."""
    return values[-1, -1]


def test_a_loop_is_taken_once_for_arguments_of_the_same_types():
    """It is the loop itself where it is not compiled for them."""
    loop, ones = compiled.compiled(total), np.ones(3)
    assert compiled.for_types_of(loop, ones, (2.0, 1)) is loop
    assert loop(ones, (2.0, 1)) == loop(np.ones(3, dtype=np.int64), (2.0, 1)) == 6.0
    found = {kind: compiled.for_types_of(loop, np.ones(3, dtype=kind), (2.0, 1)) for kind in (np.float64, np.int64)}
    for kind, function in found.items():
        assert function is not loop
        assert function(np.arange(4, dtype=kind), (0.5, 7)) == 3.0
        assert function is compiled.for_types_of(loop, np.zeros(9, dtype=kind), (1.5, 0))
    others = np.ones(3, dtype=np.float32), np.ones(6)[::2], np.ones((3, 1))
    assert all(compiled.for_types_of(loop, other, (2.0, 1)) is loop for other in others)
    assert loop(others[0], (2.0, 1)) == 6.0
    assert compiled.for_types_of(loop, others[0], (2.0, 1)) is not loop  # it is compiled for them since
    assert compiled.for_types_of(loop, ones, (2.0, 1.0)) is loop
    plane = compiled.compiled(corner)
    columns, parts = np.asfortranarray(np.arange(6.0).reshape(2, 3)), np.arange(24.0).reshape(4, 6)[::2, ::2]
    assert plane(columns) == compiled.for_types_of(plane, columns)(columns) == 5.0
    assert compiled.for_types_of(plane, parts)(parts) == 16.0
    assert compiled.for_types_of(total, ones, (2.0, 1)) is total


def moment(values):
    """The sum of the rows of a table, each times its number."""
    summed = 0.0
    for i in range(values.shape[0]):
        for j in range(values.shape[1]):
            summed += i * values[i, j]
    return summed


def test_the_order_of_an_array_is_part_of_its_type():
    """Of a table by columns and of one with gaps, neither of which is in one piece by rows. The loop is found where it
    has been compiled since it was looked for."""
    loop, gaps = compiled.compiled(moment), np.arange(24.0).reshape(4, 6)[::2, ::2]
    by_columns = np.asfortranarray(gaps)
    assert loop(gaps.copy()) == gaps[1].sum()
    for table in (by_columns, gaps):
        assert compiled.for_types_of(loop, table) is loop
        assert loop(table) == gaps[1].sum()
    found = [compiled.for_types_of(loop, table) for table in (by_columns, gaps)]
    assert loop not in found
    assert [function(table) for function, table in zip(found, (by_columns, gaps), strict=True)] == 2 * [gaps[1].sum()]
