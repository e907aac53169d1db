"""`mjrock report`: the report of a file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..bars import counted
from ..command_line import Answer, add_output, parser_of, require_free
from ..reporting.markup import pdf_writer
from .assessment_file import INPUT, add_file, assessment_of_file, runs_of


def answer(argv: Sequence[str]) -> Answer:
    """Write the report of a file, with its runs.

    Raises:
        ValueError: for a file that is wrong.
        OSError: if a file cannot be read or written, or is there and may not be replaced.
        ImportError: for a PDF without WeasyPrint.
    """
    parser = parser_of("report", "Write the report of a file: its checks step by step, every input, and its runs.")
    add_file(parser)
    add_output(parser, "the report, which ends in .html or .pdf", "FILE with the ending .html")
    parser.add_argument("--no-runs", action="store_true", help="leave out the runs")
    args = parser.parse_args(argv)
    path = args.output or Path("report.html" if args.file == INPUT else args.file).with_suffix(".html")
    require_free(path, args.force)
    if path.suffix.lower() == ".pdf":
        pdf_writer()  # before anything is run
    assessment = assessment_of_file(args.file, args.language)
    analyses = {} if args.no_runs else runs_of(assessment)
    responses = {key: [run.solve() for run in counted(runs, key or "runs", "runs")] for key, runs in analyses.items()}
    return Answer(f"written: {assessment.report(path, responses or None)}")
