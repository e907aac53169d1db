"""`mjrock run`: the motion of the mechanisms of a file, with a table, a picture and a film of the largest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from ..assessment.assessment import Assessment
from ..command_line import Answer, Status, add_output, parser, require_free, ruled
from ..contacts.files import aligned, csv_text, write_text
from ..plotting.animation import animate
from ..plotting.histories import history
from ..plotting.style import save
from ..reporting.inputs import record_name
from ..reporting.texts import BY_HAND, DASH, Words, languages
from ..reporting.verdicts import REVERSED, dynamic_found, kind_of
from ..reporting.verdicts import Mechanism as Verdicts
from ..study.analysis import Analysis
from ..study.campaign.campaign import completed
from ..study.campaign.task import Row
from ..study.loading.dynamic_check import DynamicCheck
from .check import table_of as conditions_of
from .opened import FILE_HELP, INPUT, motion_of, opened, tasks_of

Rows = dict[str, list[Row]]
"""The rows of runs by the names of their mechanisms."""
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


def table_of(runs: Sequence[Analysis], rows: Sequence[Row], words: Words) -> str:
    """How each run ended, and its largest rotation."""
    shown = [tuple(words(key) for key in ("motion_name", "run_outcome", f"column_{runs[0].PEAK}"))]
    for run, row in zip(runs, rows, strict=True):
        ended = "blocks_fell" if row.get("fallen") else f"outcome_{row['outcome'].replace(' ', '_')}"
        shown.append((called(run, words), words(ended), words.number(row[run.PEAK], BY_HAND)))
    return "\n".join(ruled(shown, "<<>"))


def called(run: Analysis, words: Words) -> str:
    """What moves the wall or the masonry of a run, in words."""
    motion = run.case.motion
    if motion is None:
        return words(f"motion_{motion_of(run)}")
    return record_name(motion, words) + f", {words('reversed')}" * motion.name.endswith(REVERSED)


def dynamic_of(name: str, check: DynamicCheck, words: Words) -> str:
    """What a check by dynamic runs found, its conditions, and the verdict."""
    rows = [(words(f"dynamic_{key}"), value) for key, value in dynamic_found(check, words).items() if value != DASH]
    mechanism = Verdicts(name or words(f"kind_{kind_of(check.case)}"), None, (check,))
    return "\n".join([*(line.rstrip() for line in aligned(rows, "<")), "", conditions_of([mechanism], words)])


def written(runs: Sequence[Analysis], rows: Sequence[Row], files: Files, film: bool) -> list[Path]:
    """Write the table of the runs of a mechanism, and a picture and a film of the largest, which is solved again."""
    columns = list(dict.fromkeys(name for run in runs for name in (*run.labels, *run.COLUMNS)))
    write_text(files.table, csv_text(columns, [[row.get(name) for name in columns] for row in rows]))
    which = largest_of(runs, rows)
    response = runs[which].solve()
    save(history(response, str(runs[which].labels["motion"])), files.picture)
    return [files.table, files.picture, *([animate(response, files.film)] if film else [])]


def histories_of(store: Path) -> Path:
    """The folder of the time histories of masonry."""
    return store.with_suffix("")


def completed_runs(
    assessment: Assessment, runs: Mapping[str, list[Analysis]], store: Path, workers: int | None
) -> Rows:
    """The rows of the runs of each mechanism, those of masonry with their histories, by which it is judged."""
    found: Rows = {}
    for walls in (True, False):
        some = {name: of for name, of in runs.items() if assessment.mechanisms[name].is_wall is walls}
        tasks = [run for of in some.values() for run in of]
        histories = None if walls else histories_of(store)
        rows = iter(completed(tasks, store, workers=workers, histories=histories) if tasks else ())
        found |= {name: [next(rows) for _ in of] for name, of in some.items()}
    return found


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
    made.add_argument("-l", "--language", choices=languages(), help="instead of that of the file")
    made.add_argument("--no-film", action="store_true", help="leave the film out")
    made.add_argument("-w", "--workers", type=int, help="how many processes; without it as many as there are cores")
    args = made.parse_args(argv)
    path = Path("wall" if args.file == INPUT else args.file)
    assessment, folder = opened(args.file, args.language), args.output or path.parent
    runs = tasks_of(assessment)
    if not runs:
        raise ValueError(f"{assessment.name} has nothing to run: give it [records], a [motion] or theta0 of a release")
    places = {name: files_of(folder, path.stem, name) for name in runs}
    for files in places.values():
        for one in files[: 2 if args.no_film else 3]:
            require_free(one, args.force)
    folder.mkdir(parents=True, exist_ok=True)
    store = folder / f"{path.stem}_runs.sqlite"
    rows, words = completed_runs(assessment, runs, store, args.workers), Words(assessment.language)
    text, holds = list[str](), True
    for name, some in runs.items():
        found = written(some, rows[name], places[name], not args.no_film)
        check = assessment.mechanisms[name].verdict_on(some, store=store, histories=histories_of(store))
        holds &= check is None or check.holds
        judged = [] if check is None else ["", dynamic_of(name, check, words)]
        text += [*filter(None, [name]), table_of(some, rows[name], words), *judged, ""]
        text += [f"written: {', '.join(map(str, found))}", ""]
    return Answer("\n".join(text).strip(), Status.HOLDS if holds else Status.FAILS)
