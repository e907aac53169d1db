"""Campaigns: what is asked once is done once, whoever does it and whoever is killed meanwhile."""

import csv
import math
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from importlib import import_module
from multiprocessing import current_process
from pathlib import Path

import numpy as np
import pytest
from campaign_tasks import Square

import mjrock as mr

TASKS = str(Path(__file__).parents[1])
"""Where a process finds `campaign_tasks`."""
HERE = str(Path(__file__).parent)
ENVIRONMENT = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, [TASKS, HERE, os.environ.get("PYTHONPATH")]))}


def table(path):
    with mr.Store(path) as store:
        return store.csv(timings=False)


def squares(marks, count=30, **options):
    return [Square(i, str(marks), labels={"name": f"n{i}"}, **options) for i in range(count)]


def thrice(marks, count=30, **options):
    """Three tasks of each content, which differ in a label."""
    tasks = squares(marks, count, **options)
    return [replace(task, labels=task.labels | {"tie": tie}) for task in tasks for tie in range(3)]


def done_once(marks, count):
    return [(marks / f"done-{i}").read_text() for i in range(count)] == ["x"] * count


@pytest.fixture
def build(wall, e, contacts):
    """An analysis from solver, scale and polarity."""
    record = mr.GroundMotion.synthetic(2.5, 3.0, seed=5)

    def make(solver, scale, polarity):
        motion = record.polarities[polarity].scaled(scale)
        return mr.Analysis(mr.Case(wall, 0.0, 4.0, motion=motion), solver, e=e, contacts=contacts)

    return make


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_a_grid_of_analyses(tmp_path, build, contacts, workers):
    grid = mr.Grid(build, solver=["analytical", "MuJoCo"], scale=[0.5, 1.0, 4.0], polarity=[0, 1])
    assert len(grid) == 12
    assert grid[-1].labels == {"solver": "MuJoCo", "scale": 4.0, "polarity": 1}
    path = mr.campaign(grid, tmp_path / "c.sqlite", workers=workers, histories=tmp_path / "histories")
    with mr.Store(path) as store:
        rows = store.rows()
    assert [r["position"] for r in rows] == list(range(12))
    for task, row in zip(grid, rows, strict=True):
        response = task.solve()
        assert row["status"] == "done"
        assert row["error"] is None
        assert (row["scale"], row["polarity"]) == (task.labels["scale"], task.labels["polarity"])
        assert row["outcome"] == response.outcome.value
        assert row["impacts"] == len(response.impacts)
        with np.load(tmp_path / "histories" / f"{row['key']}.npz") as history:
            np.testing.assert_array_equal(history["theta"], response.theta)
            largest = history["theta"].max() / task.case.block.alpha
        if response.outcome is mr.Outcome.OVERTURNED:
            assert row["peak_over_alpha"] == math.inf
        elif row["peak_over_alpha"] > contacts.uplift_rotation(task.case.block) / task.case.block.alpha:
            assert row["peak_over_alpha"] == pytest.approx(largest, rel=1e-4)
    assert len({row["peak_over_alpha"] for row in rows}) > 6


@pytest.mark.slow
def test_the_same_table_whoever_does_it(tmp_path):
    tables = []
    for name, options in {
        "alone": {"workers": 1},
        "processes": {"workers": 2},
        "threads": {"executor": ThreadPoolExecutor(3)},
    }.items():
        marks = tmp_path / name
        marks.mkdir()
        tables.append(table(mr.campaign(squares(marks), tmp_path / f"{name}.sqlite", **options)))
        assert done_once(marks, 30)
    assert tables[0] == tables[1] == tables[2]
    assert len(tables[0].splitlines()) == 31


def test_as_many_workers_as_cores_that_the_process_may_use(tmp_path, monkeypatch):
    """One core of eight: the tasks run in this process."""
    monkeypatch.setattr(os, "cpu_count", lambda: 8)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0}, raising=False)
    monkeypatch.setattr(import_module("mjrock.study.campaign.campaign"), "Workers", None)
    path = mr.campaign(squares(tmp_path, 2), tmp_path / "c.sqlite")
    with mr.Store(path) as store:
        assert [row["status"] for row in store.rows()] == ["done", "done"]


def test_it_goes_on_when_all_that_was_in_flight_is_done(tmp_path):
    """Workers that are quicker than the campaign leave nothing in flight for a moment."""

    class AtOnce(ThreadPoolExecutor):
        def submit(self, call, /, *args):
            future = Future()
            future.set_result(call(*args))
            return future

    with AtOnce() as executor:
        path = mr.campaign(squares(tmp_path, 50), tmp_path / "c.sqlite", executor=executor)
    assert len(table(path).splitlines()) == 51


def test_in_one_process_each_task_of_an_iterator_has_run_before_the_next_is_taken(tmp_path):
    """It may look at what came out; and where it breaks, no task that it has given is lost."""
    known = []

    def looking():
        for task in squares(tmp_path, 20):
            known.append(len(list(tmp_path.glob("done-*"))))
            yield task
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        mr.campaign(looking(), tmp_path / "rows.sqlite", workers=1)
    assert known == list(range(20))
    with mr.Store(tmp_path / "rows.sqlite") as store:
        assert len(store) == 20


def test_a_failed_case_is_a_row(tmp_path):
    tasks = [Square(1), Square(-2), Square(3), Square(1)]
    path = mr.campaign(iter(tasks), tmp_path / "c.sqlite", workers=1)
    with mr.Store(path) as store:
        rows = store.rows()
    assert [r["status"] for r in rows] == ["done", "failed", "done"]  # and what is asked twice is done once
    assert rows[1]["error"] == "ValueError: number = -2 is outside the valid range"


def test_nothing_is_done_twice(tmp_path):
    path = tmp_path / "c.sqlite"
    mr.campaign(squares(tmp_path, 10), path, workers=1)
    mr.campaign(squares(tmp_path, 20), path, workers=1)
    mr.campaign(squares(tmp_path, 20), path, workers=2)
    assert done_once(tmp_path, 20)
    assert len(table(path).splitlines()) == 21


@pytest.mark.parametrize("histories", [False, True])
def test_equal_tasks_run_once_and_keep_the_labels_of_the_first(tmp_path, histories):
    """Also while the first of them is still running, when neither its row nor its history is there."""
    tasks = thrice(tmp_path, 5, wait=0.02)
    options = {"histories": tmp_path / "h"} if histories else {}
    for _ in range(2):  # the second time nothing is left to do
        path = mr.campaign(tasks, tmp_path / "c.sqlite", executor=ThreadPoolExecutor(3), **options)
    assert done_once(tmp_path, 5)
    with mr.Store(path) as store:
        assert [(row["name"], row["tie"], row["position"]) for row in store.rows()] == [
            (f"n{i}", 0, 3 * i) for i in range(5)
        ]


def test_results_are_those_of_the_tasks_asked(tmp_path):
    path = mr.campaign(squares(tmp_path, 10), tmp_path / "c.sqlite", workers=1)
    rows = mr.results([Square(7), Square(99), Square(2)], path)
    assert [row and row["square"] for row in rows] == [49, None, 4]


@pytest.mark.slow
def test_tasks_may_have_other_labels_than_the_first(tmp_path):
    tasks = [Square(1, labels={"name": "a"}), Square(2, labels={"size": 3.5})]
    path = mr.campaign(tasks, tmp_path / "c.sqlite", workers=1)
    assert [(row["name"], row["size"]) for row in mr.results(tasks, path)] == [("a", None), (None, 3.5)]


@pytest.mark.slow
def test_failures_are_tried_again_when_asked(tmp_path, monkeypatch):
    path = mr.campaign([Square(-1)], tmp_path / "c.sqlite", workers=1)
    monkeypatch.setattr(Square, "__call__", lambda self, history=None: {"square": 1})
    here = ThreadPoolExecutor(1)
    mr.campaign([Square(-1)], path, executor=here)
    assert ",failed," in table(path)
    mr.campaign([Square(-1)], path, executor=here, retry=True)
    assert ",failed," not in table(path)


@pytest.mark.slow
def test_another_version_makes_other_rows(tmp_path, monkeypatch):
    path = mr.campaign(squares(tmp_path, 3), tmp_path / "c.sqlite", workers=1)
    monkeypatch.setattr("mjrock.study.campaign.task.programs", lambda: "mjrock 99")
    mr.campaign(squares(tmp_path, 3), path, workers=1)
    assert len(table(path).splitlines()) == 7


@pytest.mark.slow
def test_a_killed_worker_is_replaced(tmp_path):
    """Two cases kill their worker, one once and one always."""
    tasks = squares(tmp_path, 12)
    tasks[3] = Square(3, str(tmp_path), deaths=1, labels={"name": "n3"})
    tasks[7] = Square(7, str(tmp_path), deaths=99, labels={"name": "n7"})
    path = mr.campaign(tasks, tmp_path / "c.sqlite", workers=2)
    with mr.Store(path) as store:
        rows = store.rows()
    assert len(rows) == 12
    assert [r["number"] if "number" in r else r["name"] for r in rows if r["status"] == "failed"] == ["n7"]
    assert rows[7]["error"] == "RuntimeError: its worker process was killed by SIGKILL, 3 times in all"
    assert rows[3]["square"] == 9


KILLED = """
import sys
from pathlib import Path
import mjrock as mr
from test_campaign import thrice
if __name__ == "__main__":
    mr.campaign(thrice(Path(sys.argv[1]), 60, wait=0.02), sys.argv[2], workers=2, histories=sys.argv[2] + ".h")
"""


def children(pid):
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True, check=False)
    return [int(line) for line in found.stdout.split()]


def gone(pids):
    """Whether processes end in ten seconds."""
    deadline = time.monotonic() + 10
    while any(Path(f"/proc/{pid}").exists() for pid in pids) and time.monotonic() < deadline:
        time.sleep(0.05)
    return not any(Path(f"/proc/{pid}").exists() for pid in pids)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="looks for processes in /proc")
def test_kill_and_resume(tmp_path):
    """kill -9 of the campaign mid-run, twice: it carries on, and its table is that of an undisturbed run.

    Every content is asked three times, under other labels, and has a history.
    """
    script = tmp_path / "run.py"
    script.write_text(KILLED)
    undisturbed, marks = tmp_path / "undisturbed", tmp_path / "marks"
    undisturbed.mkdir()
    marks.mkdir()
    whole = mr.campaign(thrice(undisturbed, 60), tmp_path / "u.sqlite", workers=1, histories=tmp_path / "u.h")
    expected = table(whole)
    path = tmp_path / "c.sqlite"
    for least in (5, 25):
        with (tmp_path / "stderr").open("w") as message:
            run = subprocess.Popen(
                [sys.executable, str(script), str(marks), str(path)], env=ENVIRONMENT, stderr=message
            )
        while len(list(marks.glob("done-*"))) < least and run.poll() is None:
            time.sleep(0.02)
        workers = children(run.pid)
        assert run.poll() is None
        run.send_signal(signal.SIGKILL)
        run.wait()
        assert workers
        assert gone(workers)  # no orphans
        assert "resource_tracker" not in (tmp_path / "stderr").read_text()
        kept = table(path).splitlines()
        assert 1 < len(kept) < 61
    subprocess.run([sys.executable, str(script), str(marks), str(path)], env=ENVIRONMENT, check=True)
    assert table(path) == expected


@pytest.mark.slow
def test_runs_with_a_fixed_step(tmp_path, wall, contacts):
    """Runs of one geometry: the same rows by processes, and one by one."""

    def build(polarity, scale):
        motion = mr.GroundMotion.sine(-2.5, 0.9).polarities[polarity].scaled(scale)
        return mr.Analysis(mr.Case(wall, 0.0, 1.5, motion=motion), contacts=contacts, options={"timestep": 1e-3})

    grid = mr.Grid(build, polarity=[0, 1], scale=np.linspace(0.5, 1.5, 12).tolist())
    one_by_one, by_processes = (
        table(mr.campaign(grid, tmp_path / f"{workers}.sqlite", workers=workers)) for workers in (1, 2)
    )
    assert one_by_one == by_processes
    assert len(one_by_one.splitlines()) == 1 + 24


@pytest.mark.slow
def test_a_campaign_of_several_solvers(tmp_path, wall, e, contacts):
    case = mr.Case(wall, 0.02, 0.5)
    tasks = [mr.Analysis(case, contacts=contacts, options={"timestep": h}) for h in (1e-3, 5e-4)]
    tasks.append(mr.Analysis(case, "analytical", e=e))
    path = mr.campaign(tasks, tmp_path / "c.sqlite", workers=2)
    assert [r["solver"] for r in csv.DictReader(table(path).splitlines())] == ["MuJoCo", "MuJoCo", "analytical"]


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"solver": "guess"}, "solver = 'guess' is not one of analytical, compliant, MuJoCo"),
        ({"solver": "analytical", "contacts": None}, "the solver analytical needs e"),
        ({"contacts": None}, "the solver MuJoCo needs contacts"),
        ({"options": {"timestop": 1}}, "MuJoCo has no option timestop; it has timestep, accuracy"),
    ],
)
def test_bad_analyses(wall, contacts, arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.Analysis(**{"case": mr.Case(wall, 0.01, 1.0), "contacts": contacts} | arguments)


def test_bad_campaigns(tmp_path):
    with pytest.raises(ValueError, match="workers = 0"):
        mr.campaign([], tmp_path / "c.sqlite", workers=0)
    with pytest.raises(ValueError, match="the axis scale has no values"):
        mr.Grid(Square, scale=[])
    with pytest.raises(ValueError, match="'seconds' cannot name a column"):
        mr.campaign([Square(1, labels={"seconds": 3})], tmp_path / "c.sqlite", workers=1)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_dask_survives_the_death_of_a_worker(tmp_path):
    distributed = pytest.importorskip("distributed")
    tasks = squares(tmp_path, 40, wait=0.01)
    tasks[11] = Square(11, str(tmp_path), deaths=1, labels={"name": "n11"})
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "local_directory": tmp_path / "dask"}
    with (
        distributed.LocalCluster(**options) as cluster,
        distributed.Client(cluster) as client,
        client.get_executor() as executor,
    ):
        client.run(sys.path.append, TASKS)
        path = mr.campaign(tasks, tmp_path / "c.sqlite", executor=executor)
        blocks = mr.Masonry.stack([mr.Block.from_size(0.6, 2.1)] * 2, k_n=5e8)
        column = mr.MasonryAnalysis(mr.MasonryCase(blocks, 0.05), labels={"name": "column"})
        stands = mr.campaign([column], tmp_path / "m.sqlite", executor=executor)
    with mr.Store(stands) as store:
        assert [row["outcome"] for row in store.rows()] == ["at rest"]
    assert (tmp_path / "died-11-0").exists()
    with mr.Store(path) as store:
        assert [r["square"] for r in store.rows()] == [i**2 for i in range(40)]


@pytest.mark.slow
def test_a_point_that_cannot_be_built_is_a_row(tmp_path, wall, e):
    def build(slenderness):
        return mr.Analysis(mr.Case(mr.Block(b=2.1 / slenderness, h=2.1), 0.01, 1.0), "analytical", e=e)

    grid = mr.Grid(build, slenderness=[5, 0.5, 7])
    with pytest.raises(ValueError, match=r"slenderness h/b = 0.5 .*\(at slenderness = 0.5\)"):
        grid[1]
    rows = mr.results(grid, mr.campaign(grid, tmp_path / "c.sqlite", workers=1))
    assert [row["status"] for row in rows] == ["done", "failed", "done"]
    assert "slenderness h/b = 0.5 is outside" in rows[1]["error"]


UNGUARDED = """
from dataclasses import dataclass
from typing import ClassVar
import mjrock as mr
from campaign_tasks import Square
@dataclass(frozen=True)
class Double:
    COLUMNS: ClassVar = ("square", "double")
    labels: ClassVar = {}
    number: int
    def __call__(self, history=None):
        return {"double": 2 * self.number}
tasks = [Double(1), *map(Square, range(20)), Double(2)]
print([row.get("square") or row.get("double") for row in mr.results(tasks, mr.campaign(tasks, "c.sqlite", workers=1))])
"""


@pytest.mark.slow
def test_one_worker_needs_no_guard(tmp_path):
    """Nor is the script imported again. Types that it defines are known to its own process only, as in a notebook."""
    (tmp_path / "unguarded.py").write_text(UNGUARDED)
    run = subprocess.run(
        [sys.executable, "unguarded.py"], cwd=tmp_path, env=ENVIRONMENT, capture_output=True, text=True, check=False
    )
    assert run.stdout == f"{[2, None, *(i**2 for i in range(1, 20)), 4]}\n"
    assert len(run.stderr.splitlines()) == 1


def test_in_a_process_that_may_start_no_other(tmp_path, monkeypatch):
    """A worker of multiprocessing's Pool, or of Dask."""
    monkeypatch.setitem(current_process()._config, "daemon", True)
    assert len(table(mr.campaign(squares(tmp_path, 5), tmp_path / "c.sqlite", workers=1)).splitlines()) == 6


@pytest.mark.slow
def test_a_script_without_its_guard_is_told_so(tmp_path):
    script = tmp_path / "unguarded.py"
    script.write_text(
        "import mjrock as mr\nfrom campaign_tasks import Square\n"
        "mr.campaign([Square(1), Square(2)], 'c.sqlite', workers=2)\n"
    )
    run = subprocess.run(
        [sys.executable, str(script)], cwd=tmp_path, env=ENVIRONMENT, capture_output=True, text=True, check=False
    )
    assert run.returncode == 1
    assert 'below `if __name__ == "__main__":`' in run.stderr, run.stderr
