"""The package and its pages use the words of the field, as the glossary in CONTRIBUTING.md has them."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest
from trees import nodes

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "mjrock"
REPLACED = {
    "told": "label, description, message; known, distinguished",
    "said": "label, description, text, message; stated",
    "asked": "request, requested, required",
    "hangs? on": "depends on",
    "so much": "an amount, this amount",
    "so many": "a number of, a given number of",
}
"""Words that stand in no name, docstring, comment, message or page, and what is written instead."""
PARTICIPLES = {
    "Asked", "Changed", "Chosen", "Compared", "Declared", "Drawn", "Followed", "Found", "Gathered", "Given", "Held",
    "Listed", "Looked", "Meets", "Moved", "Named", "Pressed", "Reported", "Shaken", "Stated", "Tilted", "Told",
    "Wanted", "Watched",
}  # fmt: skip
"""Words that are no names of types: a type is a noun."""
SPEECH = re.compile(r"(?<![a-z])(?:told|said|says?|asks?|asked)(?![a-z])", re.IGNORECASE)
"""Verbs of speech, which are no names of functions, arguments or values."""
PAGES = sorted(path.stem for path in (ROOT / "docs").glob("*.md"))
NO_PROSE = re.compile(
    r'```.*?```|\$\$.*?\$\$|\$[^$\n]+\$|`[^`\n]+`|\]\([^)]*\)|"[^"\n]*"|^#.*?$', re.DOTALL | re.MULTILINE
)
SYMBOLS = re.compile(r"(?<![\w/.-])(?:xi|omega|theta|alpha|mu|k_n|k_s|e_[12]s)(?:_\w+)?(?![\w(.=-])")
WORDS = re.compile(rf"(?<![A-Za-z])({'|'.join(REPLACED)})(?![A-Za-z])", re.IGNORECASE)


@cache
def modules():
    """The modules of the package whose words are looked at."""
    found = sorted(PACKAGE.rglob("*.py"))
    assert len(found) > 100
    return found


def replaced(path):
    """Words of a file that the glossary replaces, each with its line and what to write."""
    name = path.relative_to(ROOT).as_posix()
    found = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        for word in WORDS.findall(line):
            instead = next(text for one, text in REPLACED.items() if re.fullmatch(one, word, re.IGNORECASE))
            found.append(f"{name}:{number}: {word}: write {instead}")
    return found


def test_modules_use_the_words_of_the_field():
    assert [offender for path in modules() for offender in replaced(path)] == []


def test_pages_use_the_words_of_the_field():
    pages = [
        *(ROOT / f"{name}.md" for name in ("README", "CHANGELOG", "VERSIONING")),
        *sorted((ROOT / "docs").glob("*.md")),
    ]
    assert len(pages) > 30
    assert [offender for path in pages for offender in replaced(path)] == []


@pytest.mark.parametrize("name", PAGES)
def test_symbols_in_prose_are_mathematics(name):
    text = NO_PROSE.sub("", (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8"))
    assert SYMBOLS.findall(text) == []
    assert SYMBOLS.findall(f"{text} with xi = 0.1")


NAMES = frozenset({"id", "name", "attr", "arg"})
"""Fields of a node that are names."""


def names_of(path):
    """Names of functions, classes, arguments, variables and attributes of a module, each with one of its lines."""
    return {
        name: getattr(node, "lineno", 0)
        for node in nodes(path)
        for field in NAMES.intersection(node._fields)
        if isinstance(name := getattr(node, field), str)
    }


def helpers():
    """The scripts, and what tests share."""
    shared = [path for path in (ROOT / "tests").rglob("*.py") if not path.name.startswith("test_")]
    return sorted([*(ROOT / "scripts").rglob("*.py"), *shared])


def test_names_are_no_verbs_of_speech():
    places = [*modules(), *helpers()]
    names = {path: names_of(path) for path in places}
    assert sum(map(len, names.values())) > 10000
    offenders = [
        f"{path.relative_to(ROOT)}:{line}: {name}"
        for path, lines in names.items()
        for name, line in lines.items()
        if SPEECH.search(name)
    ]
    assert offenders == []
    assert SPEECH.search("_said")
    assert not SPEECH.search("task")


def test_types_are_nouns():
    offenders = []
    for path in modules():
        for node in nodes(path):
            if isinstance(node, ast.ClassDef) and node.name.lstrip("_") in PARTICIPLES:
                offenders.append(f"{path.relative_to(ROOT)}:{node.lineno}: {node.name}")
    assert offenders == []


@pytest.mark.parametrize("text", ["much so", "retold", "masked", "hang"])
def test_other_words_are_none_of_these(text):
    assert WORDS.findall(text) == []
