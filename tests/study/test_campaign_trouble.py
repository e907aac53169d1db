"""Campaigns in trouble: tasks that misbehave, points that cannot be built, Ctrl-C, and cases that take too long."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from _thread import interrupt_main
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import resource_tracker, util
from pathlib import Path

import numpy as np
import pytest
from campaign_tasks import Misbehave, Square
from pebble.pool import process
from test_campaign import ENVIRONMENT, children, gone

import mjrock as mr
from mjrock.study.campaign import progress
from scripts.shared import cli

KINDS = ["", "exit", "interrupt", "generator", "columns", "list", "last"]
ERRORS = [
    None,
    "SystemExit: enough",
    "KeyboardInterrupt: by the task",
    "GeneratorExit: ",
    "ValueError: the task returned other; its COLUMNS are answer",
    "ValueError: the column answer: [1, 2] is of type list, and a table holds text, numbers and None",
    None,
]


@pytest.mark.parametrize(
    "where",
    [
        {"workers": 1},
        *(pytest.param(w, marks=pytest.mark.slow) for w in ({"workers": 2}, {"executor": ThreadPoolExecutor(2)})),
    ],
)
def test_whatever_a_task_raises_is_a_row(tmp_path, where):
    tasks = [Misbehave(kind) for kind in KINDS]
    rows = mr.results(tasks, mr.campaign(tasks, tmp_path / "c.sqlite", **where))
    assert [row["error"] for row in rows] == ERRORS
    assert [row["status"] for row in rows] == ["done" if error is None else "failed" for error in ERRORS]


DEATHS = {
    "_exit": "ended with exit status 3",
    "_exit 0": "ended with exit status 0",
    "libc": "ended with exit status 1, as after a fatal error of MuJoCo, which MUJOCO_LOG.TXT would hold",
    "kill": "was killed by SIGKILL, 3 times in all",
}


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="signals, and the library of C, are those of POSIX")
def test_a_task_that_ends_its_process_is_a_row(tmp_path):
    """Each of three, among others that run on. The next call leaves them alone."""
    tasks = [Misbehave(kind) for kind in ("first", "_exit", "second", "_exit 0", "libc", "kill", "last")]
    path = mr.campaign(tasks, tmp_path / "c.sqlite", workers=2)
    rows = mr.results(tasks, path)
    errors = [DEATHS.get(task.kind) for task in tasks]
    expected = [how and f"RuntimeError: its worker process {how}" for how in errors]
    assert [row["error"] for row in rows] == expected
    assert [row["answer"] for row in rows] == [None if how else 42 for how in errors]
    mr.campaign(tasks, path, workers=2)
    assert mr.results(tasks, path) == rows


def nothing():
    """Something that has no content to hash."""


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_tasks_that_cannot_be_run_are_rows(tmp_path, workers):
    """Labels that no table holds, contents that cannot be hashed, and things that are not tasks."""
    tasks = [
        Square(1, labels={"n": 10**30}),
        Square(2, labels={"n": [1, 2]}),
        Misbehave(nothing, labels={"n": 3}),
        None,
        Square(4, labels={"n": np.int64(4)}),
    ]
    rows = mr.results(tasks, mr.campaign(tasks, tmp_path / "c.sqlite", workers=workers))
    assert [row["status"] for row in rows] == ["failed"] * 4 + ["done"]
    assert [row["n"] for row in rows] == [str(10**30), "[1, 2]", 3, None, 4]
    complaints = ["label n: 1000", "label n: [1, 2] is of type list", "can be hashed", "None is not a task"]
    assert all(complaint in row["error"] for complaint, row in zip(complaints, rows[:4], strict=True))
    mr.campaign(tasks, tmp_path / "c.sqlite", workers=workers)
    with mr.Store(tmp_path / "c.sqlite") as store:
        assert len(store) == 5


@pytest.mark.slow
def test_a_task_that_cannot_be_pickled_is_a_row(tmp_path):
    tasks = [Square(1), Square(5, marks=lambda: 0), Square(2)]
    rows = mr.results(tasks, mr.campaign(tasks, tmp_path / "c.sqlite", workers=2))
    assert [row["status"] for row in rows] == ["done", "failed", "done"]
    assert "pickle" in rows[1]["error"]


def build(n):
    if n == 1:
        raise ZeroDivisionError("one divides nothing")
    if n == 2:
        raise ValueError("two is refused")
    if n == 3:
        sys.exit(3)
    return None if n == 4 else Square(int(n))


@pytest.mark.slow
def test_a_point_that_fails_to_build_is_a_row(tmp_path):
    grid = mr.Grid(build, n=np.arange(7))
    with mr.Store(mr.campaign(grid, tmp_path / "c.sqlite", workers=1)) as store:
        assert [row["status"] for row in store.rows()] == ["done"] + ["failed"] * 4 + ["done"] * 2
        assert store.rows(n=1)[0]["error"] == "ZeroDivisionError: one divides nothing"
        assert store.rows(n=2)[0]["error"] == "ValueError: two is refused (at n = 2)"
        assert store.rows(n=3)[0]["error"] == "SystemExit: 3"
        assert store.rows(n=4)[0]["error"].startswith("TypeError: build gives None")
        assert [row["n"] for row in store.rows()] == list(range(7))
        assert store.rows(n=np.float64(6))[0]["square"] == 36


@pytest.mark.parametrize(
    ("labels", "complaint"),
    [
        ({"Outcome": 1}, "'outcome' cannot name a column beside 'Outcome'"),
        ({"law": "mine"}, "'law' cannot name a column beside 'law'"),
        ({"impacts": 3}, "'impacts' cannot name a column beside 'impacts'"),
        ({"solver": "mine"}, "'solver' cannot name a column beside 'solver'"),
        ({"Scale": 1, "scale": 2}, "'scale' cannot name a column beside 'Scale'"),
        ({"Error": 1}, "'Error' cannot name a column"),
    ],
)
def test_labels_that_clash(tmp_path, wall, e, labels, complaint):
    """Nothing runs, in a list not even what comes before, and in a grid neither."""
    case = mr.Case(wall, 0.01, 1.0)
    tasks = [Square(1, str(tmp_path)), mr.Analysis(case, "analytical", e=e, labels=labels)]
    grid = mr.Grid(lambda **point: mr.Analysis(case, "analytical", e=e), **{n: [v] for n, v in labels.items()})
    for requested in (tasks, grid):
        with pytest.raises(ValueError, match=complaint):
            mr.campaign(requested, tmp_path / "c.sqlite", workers=1)
        with mr.Store(tmp_path / "c.sqlite") as store:
            assert len(store) == 0
    assert not (tmp_path / "done-1").exists()


INTERRUPTED = """
import sys
from scripts.shared import cli
import mjrock as mr
from campaign_tasks import Misbehave
def main(argv):
    wall = mr.Block.from_size(0.6, 4.2)
    contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05, k_side=5e8, xi_side=0.01)
    run = mr.Analysis(mr.Case(wall, 0.01, 0.1), contacts=contacts)
    mr.campaign([run, Misbehave("again"), Misbehave("sleep")], sys.argv[1], workers=int(sys.argv[2]))
if __name__ == "__main__":
    sys.exit(cli.run(main))
"""


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_ctrl_c(tmp_path, workers):
    """It ends behind a task of a minute, in two seconds and without a traceback, and leaves no process."""
    (tmp_path / "run.py").write_text(INTERRUPTED)
    path = tmp_path / "c.sqlite"
    scripts = os.pathsep.join([ENVIRONMENT["PYTHONPATH"], str(Path(cli.__file__).parents[2])])
    command = [sys.executable, str(tmp_path / "run.py"), str(path), str(workers)]
    run = subprocess.Popen(
        command, env=ENVIRONMENT | {"PYTHONPATH": scripts}, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    while not path.exists() or rows_of(path) < 2:
        assert run.poll() is None
        time.sleep(0.05)
    time.sleep(0.3)
    started, workers = time.monotonic(), children(run.pid)
    os.killpg(run.pid, signal.SIGINT)
    message = run.communicate()[1]
    assert time.monotonic() - started < 2
    assert run.returncode == 130
    closed, interrupted = message.splitlines()
    assert interrupted == f"interrupted: {path}: 2 rows are kept, and the same call carries on from there"
    assert closed.startswith("campaign: 2 of 3 tasks have a row: 2 done, 0 failed (1 time ended) in ")
    assert closed.endswith(", 1 left; the same call carries on")
    assert gone(workers)


def rows_of(path):
    try:
        with mr.Store(path) as store:
            return len(store)
    except (ValueError, OSError):  # it is not written yet
        return 0


@pytest.mark.skipif(sys.platform == "win32", reason="processes start in another way")
@pytest.mark.parametrize(
    "waits", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["ends them", "lets them start"]
)
def test_ctrl_c_while_workers_start(tmp_path, monkeypatch, capfd, waits):
    """As the first one has been started: both are ended, also where one opens the pipes and locks of a campaign that
    has closed them already."""
    started, spawn, end = [], util.spawnv_passfds, process.WorkerManager.force_stop_workers

    def interrupted(*given):
        started.append(spawn(*given))
        if len(started) == 1:
            interrupt_main()  # as if another thread had received the signal
        return started[-1]

    def late(manager):
        for worker in manager.workers.values():
            worker.join(60.0)
        end(manager)

    resource_tracker.ensure_running()
    monkeypatch.setattr(util, "spawnv_passfds", interrupted)
    if waits:
        monkeypatch.setattr(process.WorkerManager, "force_stop_workers", late)
    with pytest.raises(KeyboardInterrupt, match="0 rows are kept"):
        mr.campaign([Square(1), Square(2)], tmp_path / "c.sqlite", workers=2)
    for pid in started:
        with contextlib.suppress(ChildProcessError):  # it has ended
            os.waitpid(pid, 0)
    assert len(started) == 2
    assert "Traceback" not in capfd.readouterr().err


@pytest.mark.slow
def test_ctrl_c_in_the_library(tmp_path):
    def tasks():
        yield Square(1)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match=r"c\.sqlite: 0 rows are kept, and the same call carries on"):
        mr.campaign(tasks(), tmp_path / "c.sqlite", workers=2)


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_a_time_limit(tmp_path, workers):
    tasks = [Misbehave("", {"n": 0}), Misbehave("sleep", {"n": 1}), Misbehave("last", {"n": 2})]
    path, histories = tmp_path / "c.sqlite", tmp_path / "histories"
    mr.campaign(tasks, path, workers=workers, time_limit=0.4, histories=histories)
    with mr.Store(path) as store:
        assert [row["status"] for row in store.rows()] == ["done", "failed", "done"]
        assert store.rows(n=1)[0]["error"] == "TimeoutError: the case took longer than the time limit of 0.4 s"
    assert list(histories.iterdir()) == []


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        ({"time_limit": 0.0}, "time_limit = 0.0 s is outside the valid range, which is above 0"),
        ({"time_limit": 1.0, "executor": ThreadPoolExecutor(1)}, "time_limit = 1.0 s needs processes of this machine"),
    ],
)
def test_bad_limits(tmp_path, options, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.campaign([], tmp_path / "c.sqlite", **options)


def test_the_time_left_follows_from_cases_after_the_first(tmp_path, monkeypatch, capsys):
    """Workers start for 1000 s, then a case ends every 31 s: 90 more take 2790 s, and before ten nothing is said."""
    now = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    shown = progress.CampaignProgress(tmp_path / "c.sqlite", 0, 100)
    if not shown.bar.disable:
        pytest.skip("a terminal has a bar")
    for finished in range(1, 11):
        now[0] = 1000.0 + 31 * finished
        shown.add([{"status": "done"}])
    *others, ninth, tenth = capsys.readouterr().err.splitlines()
    assert len(others) == 8
    assert ninth == "campaign: 9 of 100 cases"
    assert tenth == "campaign: 10 of 100 cases, 0.0323 cases/s, 2790 s left"


@pytest.mark.slow
def test_without_a_terminal_lines_say_how_far_it_is(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(progress, "LINE_INTERVAL", 0.0)
    path = tmp_path / "c.sqlite"
    mr.campaign([Square(1), Square(-2)], path, workers=1)
    first = capsys.readouterr().err.splitlines()
    assert first[-2] == "campaign: 2 of 2 cases, 1 failed"
    mr.campaign([Square(1), Square(-2), Square(3)], path, workers=1)
    again = capsys.readouterr().err.splitlines()
    assert again[0] == f"campaign: 2 rows in {path} are kept"
    assert again[1] == "campaign: 3 of 3 cases"


@pytest.mark.slow
def test_halves_of_histories_are_removed(tmp_path, wall, e):
    """What kill -9 leaves of a history is not taken for one, and the case that is run again removes it."""
    task = mr.Analysis(mr.Case(wall, 0.01, 0.5), "analytical", e=e)
    path, folder = tmp_path / "c.sqlite", tmp_path / "histories"
    mr.campaign([task], path, workers=1, histories=folder)
    (history,) = folder.iterdir()
    whole = history.read_bytes()
    history.unlink()
    history.with_name(f"{history.name}.123.partial").write_bytes(whole[:50])
    mr.campaign([task], path, workers=1, histories=folder)
    assert [(file.name, file.read_bytes()[:2]) for file in folder.iterdir()] == [(history.name, whole[:2])]


def test_an_analysis_keeps_its_options(wall, contacts):
    options, labels = {"accuracy": 1e-3}, {"name": "one"}
    analysis = mr.Analysis(mr.Case(wall, 0.01, 1.0), contacts=contacts, options=options, labels=labels)
    options["accuracy"] = 0.1
    labels["name"] = "two"
    assert (analysis.options, analysis.labels) == ({"accuracy": 1e-3}, {"name": "one"})


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"case": None}, "case = None is not a Case or MasonryCase"),
        ({"contacts": "CALIBRATED"}, "contacts = 'CALIBRATED' of type str is not a Contacts or None"),
        ({"e": 0.9}, "e = 0.9 of type float is not a Restitution or ScatteredRestitution or None"),
        ({"options": ["accuracy"]}, "options = .* is not a mapping"),
    ],
)
def test_analyses_of_other_types(wall, contacts, arguments, complaint):
    with pytest.raises(TypeError, match=complaint):
        mr.Analysis(**{"case": mr.Case(wall, 0.01, 1.0), "contacts": contacts} | arguments)
