"""Progress of a campaign: a bar or lines while it runs, its warnings by their kinds, and the status of its store."""

from __future__ import annotations

import re
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from ...bars import OF_ALL, PLAIN, shown_bar
from ...command_line import Answer, parser_of
from ...notice import notice
from .store import Store
from .task import Row

NUMBER_IN_TEXT = re.compile(r"\d[\d.]*(?:e[-+]?\d+)?")


class WarningCounter:
    """Warnings by their kind. Those that differ in their numbers alone are of one kind, which keeps the first text."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self.texts: dict[str, str] = {}

    def add(self, text: str, kind: str = "") -> bool:
        """Count a warning. Returns whether it is the first of its kind, by default its text without numbers."""
        kind = kind or NUMBER_IN_TEXT.sub("#", text)
        self.counts[kind] += 1
        return self.texts.setdefault(kind, text) is text

    def lines(self, event: str = "warned", limit: int | None = None) -> list[str]:
        """A line for each kind with how often it came, the most frequent first."""
        return [
            f"{event} once: {self.texts[kind]}" if count == 1 else f"{event} {count} times, first: {self.texts[kind]}"
            for kind, count in self.counts.most_common(limit)
        ]


MOST_ERRORS = 3
"""Most different errors that are shown."""


def counts_text(outcomes: Mapping[str, int]) -> str:
    """How many cases ended in each way, the most frequent first."""
    ordered = sorted(outcomes.items(), key=lambda pair: (-pair[1], pair[0]))
    return ", ".join(f"{number} {name}" for name, number in ordered)


def closing_line(
    kept: int, statuses: Mapping[str, int], outcomes: Mapping[str, int], seconds: float, total: int | None
) -> str:
    """The last line of a campaign.

    It has the number of tasks whose rows were kept, how many of the others are done or failed and how they ended, the
    time that it took [s], and how many of the total are left; a total of None is not known.
    """
    rows = kept + sum(statuses.values())
    of_total = "" if total is None else f" of {total}"
    left_text = "" if total is None or rows >= total else f", {total - rows} left; the same call carries on"
    done_text = f"{statuses.get('done', 0)} done, {statuses.get('failed', 0)} failed"
    endings = f" ({counts_text(outcomes)})" if outcomes else ""
    kept_text = f", {kept} had a row before" if kept else ""
    return f"{rows}{of_total} tasks have a row: {done_text}{endings} in {seconds:.3g} s{kept_text}{left_text}"


def status(path: str | Path) -> str:
    """How many rows a store holds, how they ended, how long they took and what has failed, as text.

    It can be called while the campaign runs.

    Raises:
        ValueError, OSError: as `Store`.
    """
    with Store(path) as store:
        rows = store.rows()
    done = [row for row in rows if row["status"] == "done"]
    failed = [row for row in rows if row["status"] != "done"]
    lines = [f"{path}: {len(rows)} rows, {len(done)} done, {len(failed)} failed"]
    outcomes = Counter(str(row["outcome"]) for row in done if row.get("outcome") is not None)
    if outcomes:
        lines.append(f"outcomes: {counts_text(outcomes)}")
    seconds = sum(row["seconds"] or 0.0 for row in rows)
    lines.append(f"time of all cases together: {seconds:.3g} s, {seconds / max(len(rows), 1):.3g} s a case")
    lines.append(
        f"made by: {counts_text(Counter(str(row['version']) for row in rows))}" if rows else "made by: nobody yet"
    )
    errors = WarningCounter()
    for row in failed:
        line = str(row["error"]).splitlines()[0]
        errors.add(line[:160], NUMBER_IN_TEXT.sub("#", line.partition(" (at ")[0]))  # a grid says at which point
    return "\n".join([*lines, *errors.lines("failed", MOST_ERRORS)])


def answer(argv: Sequence[str]) -> Answer:
    """The `status` of the store that is named."""
    parser = parser_of("status", "How far a campaign is, from its store.")
    parser.add_argument("store", help="the SQLite file of a campaign")
    return Answer(status(parser.parse_args(argv).store))


LINE_INTERVAL = 30.0
"""Time between two lines of a campaign without a terminal [s]."""
FEWEST_CASES = 10
"""Fewest cases from which a rate is shown."""


class CampaignProgress:
    """How far a campaign is, on the standard error. Use it in a `with` statement.

    `kept` rows are in the store already, and `total` is the number of tasks, None if it is not known. `skipped` tasks
    had a row already; of the others `statuses` and `outcomes` count how they ended, and `warned` what was warned of.
    """

    def __init__(self, store: Path, kept: int, total: int | None) -> None:
        self.total, self.skipped = total, 0
        self.statuses: Counter[str] = Counter()
        self.outcomes: Counter[str] = Counter()
        self.warned = WarningCounter()
        self.started = self.last_line = time.monotonic()
        self.first: tuple[int, float] | None = None
        if kept:
            self._print(f"{kept} rows in {store} are kept")
        form = (PLAIN if total is None else OF_ALL).replace("<{remaining}", "")  # which counts the start of workers
        self.bar = shown_bar("campaign", "cases", total, delay=1, bar_format=form)

    @property
    def finished(self) -> int:
        """How many tasks have got a row."""
        return self.statuses.total()

    def add(self, rows: Sequence[Row]) -> None:
        """Count rows, and show how many tasks have one, and how many of these have failed."""
        self.statuses.update(row["status"] for row in rows)
        self.outcomes.update(str(row["outcome"]) for row in rows if row.get("outcome") is not None)
        now, finished, parts = time.monotonic(), self.finished, list[str]()
        if finished and self.first is None:
            self.first = finished, now
        if rate := self._rate(finished, now):
            parts.append(f"{rate:.3g} cases/s")
            if self.total is not None:
                parts.append(f"{(self.total - self.skipped - finished) / rate:.0f} s left")
        if self.statuses["failed"]:
            parts.append(f"{self.statuses['failed']} failed")
        if not self.bar.disable:
            self.bar.set_postfix_str(", ".join(parts), refresh=False)
            self.bar.update(self.skipped + finished - self.bar.n)
        elif now - self.last_line >= LINE_INTERVAL:
            self.last_line = now
            of_total = "" if self.total is None else f" of {self.total}"
            self._print(", ".join([f"{self.skipped + finished}{of_total} cases", *parts]))

    def _rate(self, finished: int, now: float) -> float:
        """Cases in a second since the first that ended, as workers take some time to start; 0 for fewer than
        FEWEST_CASES."""
        if finished < FEWEST_CASES or self.first is None or finished == self.first[0] or now <= self.first[1]:
            return 0.0
        return (finished - self.first[0]) / (now - self.first[1])

    def close(self) -> None:
        """Print the warnings by their kinds, and the last line of the campaign."""
        self.bar.close()
        for line in self.warned.lines():
            self._print(line)
        seconds = time.monotonic() - self.started
        self._print(closing_line(self.skipped, self.statuses, self.outcomes, seconds, self.total))

    def _print(self, text: str) -> None:
        notice(text, by="campaign")

    def __enter__(self) -> CampaignProgress:
        return self

    def __exit__(self, *error: object) -> None:
        self.bar.close()
