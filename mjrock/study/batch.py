"""Fixed-step runs of one geometry, which MuJoCo's threads can take up together."""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ..engine.simulation import simulate_batch
from ..result.response import Response
from .analysis import Analysis
from .fingerprint import fingerprint
from .task import Row, Task, carry_out_all, checked_row, failed_row

BATCH = 8
"""Fixed-step runs that each thread takes up in one batch."""
BATCHED = frozenset({"timestep", "newmark_beta", "output_step", "ledger"})
"""Options of runs that can be stepped together."""


def geometry(task: Task) -> str | None:
    """What fixed-step runs have to share to be stepped together, or None for any other task."""
    if not isinstance(task, Analysis) or task.solver != "MuJoCo" or "timestep" not in task.options:
        return None
    if task.options.keys() - BATCHED:
        return None
    return fingerprint(task.case.block, task.case.side_stop, task.case.effects, task.contacts, task.options)


def batch_rows(batch: Sequence[tuple[Task, Path | None]]) -> tuple[list[Row], float]:
    """Rows of runs that are stepped together, and the time per run that the engine took [s]."""
    analyses = [task for task, _ in batch if isinstance(task, Analysis)]
    options: dict[str, Any] = dict(analyses[0].options)
    assert analyses[0].contacts is not None
    started = time.perf_counter()
    try:
        answers = simulate_batch([analysis.case for analysis in analyses], analyses[0].contacts, **options)
    except Exception:  # one of them may be to blame
        return carry_out_all(batch), 0.0
    rows: list[Row] = []
    for (_, history), analysis, answer in zip(batch, analyses, answers, strict=True):
        if isinstance(answer, Response):
            row = checked_row(partial(analysis.row, answer, history), analysis.COLUMNS)
        else:
            row = failed_row(answer)
        rows.append(row | {"seconds": (time.perf_counter() - started) / len(batch)})
    stepping = [answer.stats["stepping_time"] for answer in answers if isinstance(answer, Response)]
    return rows, stepping[0] if stepping else 0.0
