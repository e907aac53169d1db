"""`mjrock report`: the report of a file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..bars import counted
from ..command_line import Answer, add_output, parser, require_free
from ..reporting.markup import pdf_writer
from ..reporting.texts import languages
from .opened import FILE_HELP, INPUT, opened, tasks_of


def answer(argv: Sequence[str]) -> Answer:
    """Write the report of a file, with its runs.

    Raises:
        ValueError: for a file that is wrong.
        OSError: if a file cannot be read or written, or is there and may not be replaced.
        ImportError: for a PDF without WeasyPrint.
    """
    made = parser("report", "Write the report of a file: its checks step by step, every input, and its runs.")
    made.add_argument("file", metavar="FILE", help=FILE_HELP)
    add_output(made, "the report, which ends in .html or .pdf", "FILE with the ending .html")
    made.add_argument("-l", "--language", choices=languages(), help="instead of that of the file")
    made.add_argument("--no-runs", action="store_true", help="leave out the runs")
    args = made.parse_args(argv)
    path = args.output or Path("report.html" if args.file == INPUT else args.file).with_suffix(".html")
    require_free(path, args.force)
    if path.suffix.lower() == ".pdf":
        pdf_writer()  # before anything is run
    assessment = opened(args.file, args.language)
    tasks = {} if args.no_runs else tasks_of(assessment)
    runs = {name: [task.solve() for task in counted(some, name or "runs", "runs")] for name, some in tasks.items()}
    return Answer(f"written: {assessment.report(path, runs or None)}")
