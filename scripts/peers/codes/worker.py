"""Runs one peer over its steps in a process of its own: a task on standard input, its motions in a file."""

from __future__ import annotations

import importlib
import json
import sys
import time
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .question import Question

REPEATS, PATIENCE = 5, 2.0
"""Most runs whose least time counts, and the seconds after which no further one starts."""


@dataclass(frozen=True)
class Task:
    """A peer, how it is set up, its step [s], what it is asked, and the file for its answers."""

    code: str
    variant: str
    h: float
    questions: tuple[Question, ...]
    file: str

    @property
    def text(self) -> str:
        """The task as text."""
        return json.dumps(asdict(self))

    @classmethod
    def of(cls, text: str) -> Task:
        """The task that a text describes."""
        fields: dict[str, Any] = json.loads(text)
        return cls(**{**fields, "questions": tuple(Question(**one) for one in fields["questions"])})


def work(task: Task) -> None:
    """Answer every question once, the first as often as patience lasts, and write the motions and its least time."""
    run = importlib.import_module(f"{__package__}.{task.code}").run
    answers: dict[str, Any] = {}
    started, seconds = time.perf_counter(), []
    for _ in range(REPEATS):
        motion, taken = run(task.questions[0], task.variant, task.h)
        seconds.append(taken)
        if time.perf_counter() - started > PATIENCE:
            break
    answers["motion_0"] = np.array(motion)
    for i, question in enumerate(task.questions[1:], 1):
        answers[f"motion_{i}"] = np.array(run(question, task.variant, task.h)[0])
    np.savez(task.file, seconds=min(seconds), **answers)


if __name__ == "__main__":
    work(Task.of(sys.stdin.read()))
