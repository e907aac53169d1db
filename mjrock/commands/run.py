"""`mjrock run`: the motion of the mechanisms of a file, with a table, a picture and a film of the largest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from ..assessment.assessment import Assessment
from ..command_line import Answer, Status, add_output, parser_of, require_free, ruled
from ..contacts.files import aligned, csv_text, write_text
from ..plotting.animation import animate
from ..plotting.histories import history
from ..plotting.style import save
from ..reporting.inputs import record_name
from ..reporting.texts import BY_HAND, DASH, Words
from ..reporting.verdicts import REVERSED, dynamic_results, kind_of
from ..reporting.verdicts import Mechanism as Verdicts
from ..study.analysis import Analysis
from ..study.campaign.campaign import completed
from ..study.campaign.task import Row
from ..study.loading.dynamic_check import DynamicCheck
from .assessment_file import INPUT, add_file, assessment_of_file, motion_of, runs_of
from .check import table_of as conditions_of

Rows = dict[str, list[Row]]
"""The rows of runs by the names of their mechanisms."""
KEPT_RUNS = "Runs are kept in FILE_runs.sqlite: a call that is broken off is carried on by the same call."
"""What the help says of them."""


class Files(NamedTuple):
    """What the runs of a mechanism are written to."""

    table: Path
    picture: Path
    film: Path


def files_of(folder: Path, stem: str, name: str) -> Files:
    """The files of a mechanism, beside those of others."""
    start = "_".join(filter(None, (stem, name.replace("/", "-"))))
    return Files(*(folder / f"{start}_{end}" for end in ("runs.csv", "largest.png", "largest.gif")))


def largest_of(runs: Sequence[Analysis], rows: Sequence[Row]) -> int:
    """Which run has the largest rotation; of those that overturn, the one that does so first."""
    keys = [(row[run.PEAK], -row["end_s"]) for run, row in zip(runs, rows, strict=True)]
    return max(range(len(keys)), key=keys.__getitem__)


def table_of(runs: Sequence[Analysis], rows: Sequence[Row], words: Words) -> str:
    """How each run ended, and its largest rotation."""
    cells = [tuple(words(key) for key in ("motion_name", "run_outcome", f"column_{runs[0].PEAK}"))]
    for run, row in zip(runs, rows, strict=True):
        outcome_key = "blocks_fell" if row.get("fallen") else f"outcome_{row['outcome'].replace(' ', '_')}"
        cells.append((motion_name(run, words), words(outcome_key), words.number(row[run.PEAK], BY_HAND)))
    return "\n".join(ruled(cells, "<<>"))


def motion_name(run: Analysis, words: Words) -> str:
    """What moves the wall or the masonry of a run, in words."""
    motion = run.case.motion
    if motion is None:
        return words(f"motion_{motion_of(run)}")
    return record_name(motion, words) + f", {words('reversed')}" * motion.name.endswith(REVERSED)


def dynamic_of(name: str, check: DynamicCheck, words: Words) -> str:
    """What a check by dynamic runs found, its conditions, and the verdict."""
    rows = [(words(f"dynamic_{key}"), value) for key, value in dynamic_results(check, words).items() if value != DASH]
    mechanism = Verdicts(name or words(f"kind_{kind_of(check.case)}"), None, (check,))
    return "\n".join([*aligned(rows, "<"), "", conditions_of([mechanism], words)])


def write_files(runs: Sequence[Analysis], rows: Sequence[Row], files: Files, film: bool) -> list[Path]:
    """Write the table of the runs of a mechanism, and a picture and a film of the largest, which is solved again."""
    columns = list(dict.fromkeys(name for run in runs for name in (*run.labels, *run.COLUMNS)))
    write_text(files.table, csv_text(columns, [[row.get(name) for name in columns] for row in rows]))
    largest = largest_of(runs, rows)
    response = runs[largest].solve()
    save(history(response, str(runs[largest].labels["motion"])), files.picture)
    return [files.table, files.picture, *([animate(response, files.film)] if film else [])]


def histories_of(store: Path) -> Path:
    """The folder of the time histories of masonry."""
    return store.with_suffix("")


def completed_runs(
    assessment: Assessment, runs: Mapping[str, list[Analysis]], store: Path, workers: int | None
) -> Rows:
    """The rows of the runs of each mechanism, those of masonry with their histories, by which it is judged."""
    rows_by_name: Rows = {}
    for of_walls in (True, False):
        chosen = {name: analyses for name, analyses in runs.items() if assessment.mechanisms[name].is_wall is of_walls}
        ordered = [run for analyses in chosen.values() for run in analyses]
        histories = None if of_walls else histories_of(store)
        rows = iter(completed(ordered, store, workers=workers, histories=histories) if ordered else ())
        rows_by_name |= {name: [next(rows) for _ in analyses] for name, analyses in chosen.items()}
    return rows_by_name


def answer(argv: Sequence[str]) -> Answer:
    """Run the mechanisms of a file. What a call that was broken off has run is not run again.

    Raises:
        ValueError: for a file that is wrong, or has nothing to run.
        OSError: if a file cannot be read or written, or is there and may not be replaced.
        RuntimeError: if a run fails.
        KeyboardInterrupt: at Ctrl-C, with how much is kept.
    """
    parser = parser_of("run", "Run the mechanisms of a file under its records, or from its release.", KEPT_RUNS)
    add_file(parser)
    add_output(parser, "folder of table, picture and film", "that of FILE")
    parser.add_argument("--no-film", action="store_true", help="leave the film out")
    parser.add_argument("-w", "--workers", type=int, help="how many processes; without it as many as there are cores")
    args = parser.parse_args(argv)
    path = Path("wall" if args.file == INPUT else args.file)
    assessment, folder = assessment_of_file(args.file, args.language), args.output or path.parent
    runs_by_name = runs_of(assessment)
    if not runs_by_name:
        raise ValueError(f"{assessment.name} has nothing to run: give it [records], a [motion] or theta0 of a release")
    files_by_name = {name: files_of(folder, path.stem, name) for name in runs_by_name}
    for files in files_by_name.values():
        for path_to_write in files[: 2 if args.no_film else 3]:
            require_free(path_to_write, args.force)
    folder.mkdir(parents=True, exist_ok=True)
    store = folder / f"{path.stem}_runs.sqlite"
    rows, words = completed_runs(assessment, runs_by_name, store, args.workers), Words(assessment.language)
    lines, all_hold = list[str](), True
    for name, analyses in runs_by_name.items():
        paths = write_files(analyses, rows[name], files_by_name[name], not args.no_film)
        check = assessment.mechanisms[name].verdict_on(analyses, store=store, histories=histories_of(store))
        all_hold &= check is None or check.holds
        verdict = [] if check is None else ["", dynamic_of(name, check, words)]
        lines += [*filter(None, [name]), table_of(analyses, rows[name], words), *verdict, ""]
        lines += [f"written: {', '.join(map(str, paths))}", ""]
    return Answer("\n".join(lines).strip(), Status.HOLDS if all_hold else Status.FAILS)
