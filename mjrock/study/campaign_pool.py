"""The worker processes of a campaign, and the jobs that go to them."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from multiprocessing import connection
from pickle import PicklingError

from .campaign_run import Job, Runner
from .campaign_task import failed_row
from .campaign_worker import Worker

DEATHS = 2
"""A task during which this many worker processes have died is run alone."""
LOOK = 0.2
"""Time between two looks at how long the tasks in progress have taken [s]."""


class Dispatch:
    """The worker processes of a campaign.

    One that dies is replaced. If a task ended it, the row of the task says so. If it was killed, the task is run again.
    After DEATHS deaths it is run while the others wait, in case memory was short. If its process dies again, the row of
    the task says so. The process of a task that takes longer than the limit [s] is ended, and the task gets a failed
    row; None stands for no limit. Where the processes do not import the script that calls the campaign, tasks that they
    cannot read for that reason run in this process.
    """

    def __init__(self, run: Runner, pending: Iterator[Job], count: int, limit: float | None, *, script: bool) -> None:
        self.run, self.pending, self.count, self.limit, self.script = run, pending, count, limit, script
        self.ahead: deque[Job] = deque()  # made while the processes are busy
        self.again: deque[Job] = deque()
        self.workers: list[Worker] = []

    def go(self) -> None:
        """Run all jobs. Whatever is raised, Ctrl-C included, ends the processes at once."""
        if not self.look_ahead():
            return
        try:
            for _ in range(self.count):
                self.workers.append(Worker(script=self.script))
            while self.hand_out():
                self.look_ahead()
                self.collect()
        except BaseException:
            for worker in self.workers:
                worker.process.kill()
            for worker in self.workers:
                worker.end(0)
            raise
        for worker in self.workers:
            worker.connection.close()
        for worker in self.workers:
            worker.end(1)

    def look_ahead(self) -> bool:
        """Make the jobs of the next chunk, and say whether there are any."""
        while len(self.ahead) < self.run.chunk() and (job := next(self.pending, None)):
            self.ahead.append(job)
        return bool(self.ahead)

    def take(self) -> list[Job]:
        """The jobs of the next chunk. Those that a process had that died go one by one."""
        flying = [worker.jobs[0] for worker in self.workers if worker.jobs]
        if any(job.deaths >= DEATHS for job in flying):
            return []
        if self.again:
            return [self.again.popleft()] if self.again[0].deaths < DEATHS or not flying else []
        self.look_ahead()
        return [self.ahead.popleft() for _ in range(min(self.run.chunk(), len(self.ahead)))]

    def hand_out(self) -> bool:
        """Give jobs to every process that has none, and say whether the campaign goes on."""
        for worker in self.workers:
            while worker.ready and not worker.jobs and (jobs := self.take()):
                try:
                    worker.send([(job.task, job.history) for job in jobs])
                    worker.jobs = jobs
                except Exception as error:
                    self.refused(jobs, error)
        return any(worker.jobs for worker in self.workers) or bool(self.again) or self.look_ahead()

    def collect(self) -> None:
        """Wait for rows, write them, and replace processes that have died or whose task takes too long."""
        waited = [worker.connection for worker in self.workers] + [worker.process.sentinel for worker in self.workers]
        ready = connection.wait(waited, None if self.limit is None else LOOK)
        for worker in list(self.workers):
            if worker.connection in ready or worker.process.sentinel in ready:
                answer = worker.receive()
                if answer is None:
                    self.replace(worker, overdue=False)
                elif isinstance(answer, dict):
                    jobs, worker.jobs = worker.jobs, []
                    self.refused(jobs, PicklingError(answer["error"]))
                elif answer:
                    jobs, worker.jobs = worker.jobs[: len(answer)], worker.jobs[len(answer) :]
                    self.run.write(jobs, answer)
            elif self.limit is not None and worker.jobs and worker.busy > self.limit:
                self.replace(worker, overdue=True)

    def refused(self, jobs: list[Job], error: Exception) -> None:
        """Try the tasks of a chunk that could not be pickled or read one by one. One that was alone runs here, if its
        process lacks the script, or fails."""
        if self.script or len(jobs) > 1:
            self.again.extend(self.run.singly(jobs, error))
        else:
            self.run.here(jobs[0], error)

    def replace(self, worker: Worker, *, overdue: bool) -> None:
        """Start another process in place of one that has died or whose task takes too long."""
        index = max(worker.started, 1) - 1  # one that dies before it starts a task may die of reading it
        how = worker.end(0 if overdue else 1)
        ended = worker.started > 0 and (worker.process.exitcode or 0) >= 0
        self.workers[self.workers.index(worker)] = Worker(script=self.script)
        if not worker.jobs:
            return
        job = worker.jobs.pop(index)
        self.again.extend(worker.jobs)
        if job.history is not None:
            for path in job.history.parent.glob(f"{job.history.name}.*.partial*"):
                path.unlink(missing_ok=True)
        job.deaths += not overdue
        if overdue:
            row = failed_row(TimeoutError(f"the case took longer than the time limit of {self.limit:g} s"))
            self.run.write([job], [row | {"seconds": self.limit}])
        elif ended or job.deaths > DEATHS:
            often = f", {job.deaths} times in all" if job.deaths > 1 else ""
            self.run.write([job], [failed_row(RuntimeError(f"its worker process {how}{often}"))])
        else:
            self.again.append(job)
