"""Functions that a later version removes: each call warns, and none outlives the version that it names."""

import ast
import inspect
import warnings
from pathlib import Path

import pytest

import mjrock as mr
from mjrock.deprecation import deprecated

ROOT = Path(mr.__file__).parent
SAMPLE = """
@deprecated("new", since="1.2", removal="{}")
def old(): ...
"""


@deprecated("simulate", since="1.3", removal="2.0")
def run(case, *, steps=1):
    """The answer of a case."""
    return case * steps


class Wall:
    @classmethod
    @deprecated("Wall.of_bricks", since="1.3", removal="2.0")
    def made(cls, height):
        return cls, height


def test_a_call_warns_at_the_line_that_calls_and_answers_as_before():
    with pytest.warns(
        FutureWarning, match=r"run is deprecated since mjrock 1\.3 and removed in 2\.0; use simulate"
    ) as found:
        assert run(3, steps=2) == 6
    assert found[0].filename == __file__
    with pytest.warns(FutureWarning, match="Wall.made is deprecated"):
        assert Wall.made(2.0) == (Wall, 2.0)
    assert run.__doc__ == "The answer of a case."
    assert str(inspect.signature(run)) == "(case, *, steps=1)"


def test_a_user_sees_the_warning_without_a_setting():
    """A DeprecationWarning would be shown in the script alone, not in modules that it imports."""
    with warnings.catch_warnings(record=True) as found:
        warnings.resetwarnings()
        run(1)
    assert [warning.category for warning in found] == [FutureWarning]


def version(text):
    return tuple(map(int, text.split(".")))


def users(source):
    """The name of each function that a text deprecates, with the versions since which and in which it is removed."""
    for node in ast.walk(ast.parse(source)):
        for mark in getattr(node, "decorator_list", ()):
            if isinstance(mark, ast.Call) and getattr(mark.func, "id", "") == "deprecated":
                yield node.name, {keyword.arg: getattr(keyword.value, "value", None) for keyword in mark.keywords}


def overdue(source, now):
    """What is wrong with the versions of the deprecated functions of a text, in a version of the package."""
    for name, given in users(source):
        since, removal = (version(given[key]) for key in ("since", "removal"))
        if not (removal[0] > since[0] and not any(removal[1:])):
            yield f"{name}: {given['removal']} is no later major version than {given['since']}"
        if removal <= version(now):
            yield f"{name}: {now} is to remove it"


def test_a_version_that_has_come_or_is_not_major_is_found():
    assert list(users(SAMPLE.format("2.0"))) == [("old", {"since": "1.2", "removal": "2.0"})]
    assert list(overdue(SAMPLE.format("2.0"), "1.9.1")) == []
    assert list(overdue(SAMPLE.format("1.3"), "1.2.0")) == ["old: 1.3 is no later major version than 1.2"]
    assert list(overdue(SAMPLE.format("2.0"), "2.0.0")) == ["old: 2.0.0 is to remove it"]


def test_what_is_deprecated_has_a_version_of_removal_that_has_not_come():
    """Deprecated now: the methods of restitutions that `difference_from` replaces."""
    sources = {path: path.read_text(encoding="utf-8") for path in ROOT.rglob("*.py")}
    marked = {path: text for path, text in sources.items() if "@deprecated(" in text}
    assert [name for text in marked.values() for name, _ in users(text)] == ["doubt", "doubt"]
    assert [fault for text in marked.values() for fault in overdue(text, mr.__version__)] == []
