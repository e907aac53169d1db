"""`mjrock run`: the motion of the mechanisms of a file, with a table, a picture and a film of the largest."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from ..assessment.mechanisms import Mechanism
from ..command_line import Answer, Status, add_output, parser, require_free, ruled
from ..contacts.files import csv_text, write_text
from ..plotting.animation import animate
from ..plotting.histories import history
from ..plotting.style import save
from ..study.analysis import Analysis
from ..study.campaign.campaign import completed
from ..study.campaign.task import Row
from ..study.loading.code_check import DynamicCheck
from .opened import FILE_HELP, INPUT, opened, tasks_of

KEPT = "Runs are kept in FILE_runs.sqlite: a call that is broken off is carried on by the same call."
"""What the help says of them."""


class Files(NamedTuple):
    """What the runs of a mechanism are written to."""

    table: Path
    picture: Path
    film: Path


def files_of(folder: Path, stem: str, name: str) -> Files:
    """The files of a mechanism, beside those of others."""
    whole = "_".join(filter(None, (stem, name.replace("/", "-"))))
    return Files(*(folder / f"{whole}_{end}" for end in ("runs.csv", "largest.png", "largest.gif")))


def largest_of(runs: Sequence[Analysis], rows: Sequence[Row]) -> int:
    """Which run has the largest rotation; of those that overturn, the one that does so first."""
    keys = [(row[run.PEAK], -row["end_s"]) for run, row in zip(runs, rows, strict=True)]
    return max(range(len(keys)), key=keys.__getitem__)


def table_of(runs: Sequence[Analysis], rows: Sequence[Row]) -> str:
    """How each run ended, and its largest rotation."""
    shown = [("motion", "outcome", runs[0].PEAK.replace("_", " "))]
    for run, row in zip(runs, rows, strict=True):
        shown.append((str(run.labels["motion"]), row["outcome"], f"{row[run.PEAK]:.4g}"))
    return "\n".join(ruled(shown, "<<>"))


def written(runs: Sequence[Analysis], rows: Sequence[Row], files: Files, film: bool) -> list[Path]:
    """Write the table of the runs of a mechanism, and a picture and a film of the largest, which is solved again."""
    columns = list(dict.fromkeys(name for run in runs for name in (*run.labels, *run.COLUMNS)))
    write_text(files.table, csv_text(columns, [[row.get(name) for name in columns] for row in rows]))
    which = largest_of(runs, rows)
    response = runs[which].solve()
    save(history(response, str(runs[which].labels["motion"])), files.picture)
    return [files.table, files.picture, *([animate(response, files.film)] if film else [])]


def verdict_on(mechanism: Mechanism, runs: Sequence[Analysis], store: Path) -> DynamicCheck | None:
    """The check by the runs of a wall under records; None of masonry, whose report has it, and of a release."""
    if not mechanism.shaking.records or mechanism.limit_curve is not None:
        return None
    return mechanism.dynamic(runs, store)


def answer(argv: Sequence[str]) -> Answer:
    """Run the mechanisms of a file. What a call that was broken off has run is not run again.

    Raises:
        ValueError: for a file that is wrong, or has nothing to run.
        OSError: if a file cannot be read or written, or is there and may not be replaced.
        RuntimeError: if a run fails.
        KeyboardInterrupt: at Ctrl-C, with how much is kept.
    """
    made = parser("run", "Follow the motion of the mechanisms of a file under its records, or from its release.", KEPT)
    made.add_argument("file", metavar="FILE", help=FILE_HELP)
    add_output(made, "folder of table, picture and film", "that of FILE")
    made.add_argument("--no-film", action="store_true", help="leave the film out")
    made.add_argument("-w", "--workers", type=int, help="how many processes; without it as many as there are cores")
    args = made.parse_args(argv)
    path = Path("wall" if args.file == INPUT else args.file)
    assessment, folder = opened(args.file), args.output or path.parent
    runs = tasks_of(assessment)
    if not runs:
        raise ValueError(f"{assessment.name} has nothing to run: give it [records], a [motion] or theta0 of a release")
    places = {name: files_of(folder, path.stem, name) for name in runs}
    for files in places.values():
        for one in files[: 2 if args.no_film else 3]:
            require_free(one, args.force)
    folder.mkdir(parents=True, exist_ok=True)
    store = folder / f"{path.stem}_runs.sqlite"
    rows = iter(completed([run for some in runs.values() for run in some], store, workers=args.workers))
    text, holds = list[str](), True
    for name, some in runs.items():
        own = [next(rows) for _ in some]
        found = written(some, own, places[name], not args.no_film)
        check = verdict_on(assessment.mechanisms[name], some, store)
        holds &= check is None or check.holds
        judged = [] if check is None else ["", check.table()]
        text += [*filter(None, [name]), table_of(some, own), *judged, "", f"written: {', '.join(map(str, found))}", ""]
    return Answer("\n".join(text).strip(), Status.HOLDS if holds else Status.FAILS)
