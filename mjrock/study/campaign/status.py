"""How far a campaign is, from its store: `python -m mjrock status walls.sqlite`."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from .store import Store

ERRORS = 3
"""Most different errors that are shown."""


def counted(outcomes: Mapping[str, int]) -> str:
    """How many cases ended in each way, the most frequent first."""
    ordered = sorted(outcomes.items(), key=lambda pair: (-pair[1], pair[0]))
    return ", ".join(f"{number} {name}" for name, number in ordered)


def closing(
    kept: int, statuses: Mapping[str, int], outcomes: Mapping[str, int], seconds: float, total: int | None
) -> str:
    """The last line of a campaign.

    It says how many tasks had a row and were kept, how many of the others are done or failed and how they ended, how
    long that took [s], and how many of the total are left, None if nobody knows.
    """
    rows = kept + sum(statuses.values())
    of = "" if total is None else f" of {total}"
    left = "" if total is None or rows >= total else f", {total - rows} left; the same call carries on"
    done = f"{statuses.get('done', 0)} done, {statuses.get('failed', 0)} failed"
    ended = f" ({counted(outcomes)})" if outcomes else ""
    before = f", {kept} had a row before" if kept else ""
    return f"{rows}{of} tasks have a row: {done}{ended} in {seconds:.3g} s{before}{left}"


def status(path: str | Path) -> str:
    """How many rows a store holds, how they ended, how long they took and what has failed, as text.

    It may be asked while the campaign runs.

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
        lines.append(f"outcomes: {counted(outcomes)}")
    seconds = sum(row["seconds"] or 0.0 for row in rows)
    lines.append(f"time of all cases together: {seconds:.3g} s, {seconds / max(len(rows), 1):.3g} s a case")
    lines.append(f"made by: {counted(Counter(str(row['version']) for row in rows))}" if rows else "made by: nobody yet")
    errors = Counter(str(row["error"]).splitlines()[0] for row in failed)
    lines += [f"failed {number} times: {error[:160]}" for error, number in errors.most_common(ERRORS)]
    return "\n".join(lines)


def answer(argv: Sequence[str]) -> str:
    """The `status` of the store that is named."""
    parser = argparse.ArgumentParser("python -m mjrock status", description=__doc__)
    parser.add_argument("store", help="the SQLite file of a campaign")
    return status(parser.parse_args(argv).store)
