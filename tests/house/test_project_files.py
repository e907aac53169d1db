"""What newcomers read first names commands, files and versions that there are."""

import re
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
