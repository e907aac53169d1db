"""The page on an effect of one's own names the modules that truly change."""

import re
from pathlib import Path

import pytest

import mjrock

ROOT = Path(mjrock.__file__).parent
PAGE = (ROOT.parent / "docs" / "own_effect.md").read_text(encoding="utf-8")
DEVICE, _, _, _, LAW = re.split(r"^## ", PAGE, flags=re.MULTILINE)[1:]
OF_DEVICE = r"FrictionDamper|friction_damper"
OF_LAW = (
    r"squeeze(:|\[|\b.*frozen)|\b(law|links|self|ties?|tied|sprung)\.push\b|\bresisting\b|links\.bearing\b"
    r"|class Slider\b|import Slider\b|slider_event|\bpushes = |\"reach\", \"strength\""
)


def listed(section):
    """Modules in the first column of the table of a section."""
    rows = [line.split("|")[1] for line in section.splitlines() if line.startswith("| `")]
    return {name for row in rows for name in re.findall(r"`(mjrock/[^`]+)`", row)}


def naming(words):
    """Modules in whose text some words stand, examples left out."""
    texts = {path: path.read_text(encoding="utf-8") for path in ROOT.rglob("*.py") if path.parent.name != "examples"}
    return {f"mjrock/{path.relative_to(ROOT).as_posix()}" for path, text in texts.items() if re.search(words, text)}


@pytest.mark.parametrize(("section", "words"), [(DEVICE, OF_DEVICE), (LAW, OF_LAW)], ids=["device", "law"])
def test_the_page_names_the_modules_that_change_and_no_other(section, words):
    device = naming(OF_DEVICE)
    assert listed(section) == naming(words) - (device if section is LAW else set())


def test_a_device_touches_few_modules():
    assert len(listed(DEVICE)) <= 9


def test_no_module_outside_the_problem_asks_which_kind_an_effect_is():
    kinds = r"isinstance\([^)]*\b(Tie|Thrust|Load|AddedMass|Damper|FrictionDamper|Anchored|Effect)\b|\.each\("
    assert {name for name in naming(kinds) if not name.startswith("mjrock/problem/")} == set()
