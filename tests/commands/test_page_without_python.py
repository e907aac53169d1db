"""docs/without_python.md: its files are read, its commands run, and they print what the page shows."""

import re
import shlex
from pathlib import Path

import pytest

from mjrock.__main__ import COMMANDS, main
from mjrock.command_line import Status

PAGE = (Path(__file__).parents[2] / "docs" / "without_python.md").read_text(encoding="utf-8")
PART = re.compile(r"^```(toml|sh)\n(.*?)^```\n(?:\n*```text\n(.*?)^```\n)?", re.DOTALL | re.MULTILINE)
"""A file, or lines of a terminal, and what these print where the page shows it right below."""
ELSEWHERE = ("app",)
"""Commands that open a window and wait."""


def run(line, capsys):
    """What a line of a terminal prints, on either of its outputs."""
    program, *arguments = shlex.split(line, comments=True)
    assert program == "mjrock", line
    status = main(arguments)
    printed = capsys.readouterr()
    assert (status == Status.ERROR) == ("error: " in printed.err), line
    return printed.out + printed.err


@pytest.mark.slow
def test_the_files_and_commands_of_the_page_do_what_it_shows(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for kind, content, shown in PART.findall(PAGE):
        if kind == "toml":
            name = re.match(r"# (\S+\.toml)", content)[1]
            Path(name).write_text(content, encoding="utf-8")
            continue
        lines = [line for line in content.splitlines() if line.split()[1] not in ELSEWHERE]
        printed = "".join(run(line, capsys) for line in lines)
        trimmed = "\n".join(map(str.rstrip, printed.splitlines()))
        assert not shown or trimmed.strip() == shown.strip(), content


def test_the_page_names_every_command():
    named = set(re.findall(r"mjrock (\w+)", PAGE))
    assert set(COMMANDS) <= named, set(COMMANDS) - named
