"""What newcomers read first names commands, files and versions that there are."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def test_the_commands_of_contributing_are_those_of_the_makefile():
    targets = set(re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    named = set(re.findall(r"(?<![\w`]/)\bmake ([a-z-]+)", CONTRIBUTING))
    assert {"demo", "test", "lint"} <= named <= targets


def test_the_files_of_contributing_are_there():
    named = re.findall(r"`((?:mjrock|tests|docs|scripts)/[\w/]+\.\w+)`", CONTRIBUTING)
    linked = re.findall(r"\]\(([\w/]+\.\w+)\)", CONTRIBUTING)
    assert len(named) > 4
    for path in named + linked:
        assert (ROOT / path).exists(), path


def test_the_workflows_and_forms_are_yaml():
    yaml = pytest.importorskip("yaml")
    for path in [*(ROOT / ".github").rglob("*.yml"), ROOT / ".pre-commit-config.yaml", ROOT / "CITATION.cff"]:
        assert yaml.safe_load(path.read_text(encoding="utf-8")), path
    tests = yaml.safe_load((ROOT / ".github/workflows/tests.yml").read_text(encoding="utf-8"))
    assert tests["jobs"]["everyday"]["strategy"]["matrix"]["python"][0] == "3.11"


def test_the_extra_of_the_pages_brings_every_lexer_that_they_name():
    """`pip install '.[docs]'` alone builds the site: the lexer of each block is Pygments' own or of a package named."""
    lexers = pytest.importorskip("pygments.lexers")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    named = {re.split(r"[><=\[]", one)[0].replace("-", "_") for one in project["optional-dependencies"]["docs"]}
    pages = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "docs").rglob("*.md"))
    languages = set(re.findall(r"^```([a-z]\w*)$", pages, re.MULTILINE))
    assert {"python", "ipython"} <= languages
    for language in languages:
        assert type(lexers.get_lexer_by_name(language)).__module__.split(".")[0] in {"pygments", *named}, language
