"""Many random scenes under all invariances, each in a process that may die, and one table of what came out.

    python -m tests.invariance --scenes 1500 --seed 0 --workers 2

Every scene is a line of `rows.jsonl` in the folder `--out`. A run that is interrupted goes on where it ended, and rows
that another version of the package or of these files has made are made again.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import re
import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import TimeoutError as TookTooLong
from pathlib import Path
from typing import Any

from pebble import ProcessExpired, ProcessFuture, ProcessPool
from tqdm import tqdm

import mjrock as mr

from .invariances import INVARIANCES
from .judge import judge
from .random_scenes import place_of

Row = dict[str, Any]

LONGEST = 300.0
"""Longest time of a scene [s]."""
VERDICTS = ("equal", "expected", "unexplained")


def version(only: Sequence[str] | None) -> str:
    """A digest of the package, of this folder and of what is tried."""
    digest = hashlib.sha256(repr(only).encode())
    for folder in (Path(mr.__file__).parent, Path(__file__).parent):
        for path in sorted(folder.rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def rows_of(path: Path, made_by: str) -> dict[int, Row]:
    """The rows of a file that this version has made, by their seeds."""
    rows = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
    return {row["seed"]: row for row in rows if row["version"] == made_by}


def table(rows: Sequence[Row]) -> str:
    """What came out, and the seeds of all that should not have."""
    answered = [row for row in rows if "apart" in row]
    counts = {name: sum(name in row for row in rows) for name in ("refused", "unnamed", "crashed")}
    lines = [f"{len(rows)} scenes, {len(answered)} answered, " + ", ".join(f"{n} {name}" for name, n in counts.items())]
    lines += ["", f"{'invariance':18}" + "".join(f"{verdict:>12}" for verdict in ("tried", *VERDICTS)) + "  seeds"]
    for name in INVARIANCES:
        found = [(row, *row["apart"][name]) for row in answered if name in row["apart"]]
        numbers = [sum(verdict == each for _, verdict, _ in found) for each in VERDICTS]
        line = f"{name:18}" + "".join(f"{number:12}" for number in (len(found), *numbers))
        lines.append(line + "  " + " ".join(str(row["seed"]) for row, verdict, _ in found if verdict == VERDICTS[-1]))
    lines += ["", "refused by name:"]
    label_of = [re.sub(r"[\d.]+|(block|fixed)_\S+", "#", row["refused"])[:100] for row in rows if "refused" in row]
    lines += [f"{number:5}  {sentence}" for sentence, number in Counter(label_of).most_common()]
    for name in ("unnamed", "crashed"):
        lines += [f"{name}: {row['place']} {row['seed']}: {row[name]}" for row in rows if name in row]
    lines += [
        f"wrong: {row['place']} {row['seed']} {row['kind']}: {sentence}"
        for row in answered
        for sentence in row["wrong"]
    ]
    return "\n".join(lines)


def main() -> int:
    """Run the scenes that are asked for and are not there yet, and print the table. The exit code is 1 where something
    is wrong."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0, help="of the first scene; those after it follow")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--only", nargs="*", choices=list(INVARIANCES), help="all by default")
    parser.add_argument("--out", type=Path, default=Path("out") / "invariance")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    path, made_by = options.out / "rows.jsonl", version(options.only)
    rows = rows_of(path, made_by)
    wanted = range(options.seed, options.seed + options.scenes)
    ahead = [seed for seed in wanted if seed not in rows]
    with ProcessPool(options.workers) as pool, path.open("a") as file:
        tasks = [pool.schedule(judge, (seed, options.only), timeout=LONGEST) for seed in ahead]
        for seed, task in zip(ahead, tqdm(tasks, desc="scenes", disable=None), strict=True):
            rows[seed] = {"place": place_of(seed), "seed": seed, "version": made_by} | result_of(task)
            file.write(json.dumps(rows[seed]) + "\n")
            file.flush()
    chosen = [rows[seed] for seed in wanted]
    print(table(chosen))
    return int(any(row.get("wrong") or "unnamed" in row or "crashed" in row or is_unexplained(row) for row in chosen))


def result_of(task: ProcessFuture) -> Row:
    """The row of a scene, or how its process died."""
    try:
        row: Row = task.result()
    except ProcessExpired as error:
        return {"crashed": f"exit code {error.exitcode}"}
    except TookTooLong:
        return {"crashed": f"took more than {LONGEST:g} s"}
    return row


def is_unexplained(row: Row) -> bool:
    """Whether a scene has differed in a way that nothing explains."""
    return any(verdict == VERDICTS[-1] for verdict, _ in row.get("apart", {}).values())


if __name__ == "__main__":
    sys.exit(main())
