"""The texts of the page on clusters, run by local processes: an array of jobs with a store each, and MPI."""

import importlib.util
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from campaign_tasks import Square

import mjrock as mr

PAGE = Path(__file__).parents[2] / "docs" / "analysis.md"
ARRAY, JOIN, MPI = re.findall(r"```py\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
CASES = 24
GRID = """
import mjrock as mr
from campaign_tasks import Square

def build(number):
    return Square(number, {marks!r}, wait={wait}, labels={{"number": number}})

grid = mr.Grid(build, number=range({cases}))
"""


def put(folder, wait):
    """The files of the page, and a grid of tasks that leave marks and wait [s]."""
    texts = {"walls.py": GRID.format(marks=str(folder), wait=wait, cases=CASES)}
    for name, text in (texts | {"one_job.py": ARRAY, "join_jobs.py": JOIN, "by_mpi.py": MPI}).items():
        (folder / name).write_text(text)


STARTED = []
"""Processes of the test that runs."""


@pytest.fixture(autouse=True)
def _ended():
    """No process outlives its test."""
    yield
    for process in STARTED:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        process.stderr.close()
    STARTED.clear()


def started(folder, *command, **setting):
    """A process in the folder, in a group of its own."""
    paths = [str(Path(__file__).parents[2]), str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, paths))} | setting
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
    STARTED.append(subprocess.Popen(command, cwd=folder, env=environment, start_new_session=True, **quiet))
    return STARTED[-1]


def job(folder, number):
    ids = {"SLURM_ARRAY_TASK_ID": number, "SLURM_ARRAY_TASK_COUNT": 3, "SLURM_CPUS_PER_TASK": 1}
    return started(folder, sys.executable, "one_job.py", **{name: str(value) for name, value in ids.items()})


def done(process):
    """What a process has said, once it has ended well."""
    message = process.communicate(timeout=120)[1]
    assert process.returncode == 0, message
    return message


def killed(process, folder, marks):
    """Kill a process and its children when so many tasks are done."""
    until = time.monotonic() + 60
    while len(list(folder.glob("done-*"))) < marks:
        assert process.poll() is None, process.communicate()[1]
        assert time.monotonic() < until
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def of_one_process(folder):
    """The table of a campaign in one process, without its timings."""
    tasks = [Square(number, labels={"number": number}) for number in range(CASES)]
    with mr.Store(mr.campaign(tasks, folder / "alone.sqlite", workers=1)) as store:
        return store.csv(timings=False)


def table(folder):
    with mr.Store(folder / "walls.sqlite") as store:
        return store.csv(timings=False)


@pytest.mark.skipif(sys.platform == "win32", reason="groups of processes are those of POSIX")
@pytest.mark.slow
def test_an_array_of_jobs_is_joined_and_completed(tmp_path):
    """One job is killed and submitted again; another one's store is missing when the rest is joined."""
    put(tmp_path, 0.05)
    jobs = [job(tmp_path, number) for number in range(3)]
    killed(jobs[1], tmp_path, 3)
    for one in (jobs[0], jobs[2], job(tmp_path, 1)):
        done(one)
    assert {len(path.read_text()) for path in tmp_path.glob("done-*")} <= {1, 2}
    assert sum(len(path.read_text()) for path in tmp_path.glob("done-*")) <= CASES + 1
    (tmp_path / "walls_2.sqlite").rename(tmp_path / "lost.sqlite")
    message = done(started(tmp_path, sys.executable, "join_jobs.py"))
    assert f"{CASES} of {CASES} tasks have a row: 8 done" in message
    assert table(tmp_path) == of_one_process(tmp_path)


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("mpi4py") is None, reason="mpi4py is not installed")
def test_mpi_is_killed_and_carries_on(tmp_path):
    mpiexec = shutil.which("mpiexec", path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    if mpiexec is None:
        pytest.skip("mpiexec is not installed")
    command = mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures", "by_mpi.py"
    put(tmp_path, 0.05)
    killed(started(tmp_path, *command), tmp_path, 6)
    with mr.Store(tmp_path / "walls.sqlite") as store:
        kept = len(store)
    assert 0 < kept < CASES
    assert f"{kept} had a row before" in done(started(tmp_path, *command))
    assert table(tmp_path) == of_one_process(tmp_path)


def test_rows_that_are_done_count_and_those_of_other_tasks_do_not(tmp_path):
    good, bad, other = Square(2), Square(-1), Square(5)
    first = mr.campaign([bad, good, other], tmp_path / "a.sqlite", workers=1)
    second = mr.campaign([Square(3), good], tmp_path / "b.sqlite", workers=1)
    tasks = [Square(3), bad, Square(7), good]
    assert mr.Store.join([first, second], tmp_path / "c.sqlite", tasks) == 3
    with mr.Store(tmp_path / "c.sqlite") as store:
        assert [(row["position"], row["status"], row["square"]) for row in store.rows()] == [
            (0, "done", 9), (1, "failed", None), (3, "done", 4)
        ]  # fmt: skip
    with pytest.raises(FileExistsError, match=r"c\.sqlite exists already; rows are joined into a new file"):
        mr.Store.join([first], tmp_path / "c.sqlite", tasks)
    with pytest.raises(FileNotFoundError, match=r"none\.sqlite: there is no such campaign"):
        mr.Store.join([first, tmp_path / "none.sqlite"], tmp_path / "d.sqlite", tasks)
    assert not (tmp_path / "d.sqlite").exists()
