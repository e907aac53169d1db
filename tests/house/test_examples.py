"""The examples in docstrings run, with the wall, e, contacts and case of the README, and give what they show."""

import doctest
import inspect
import re
import warnings
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import pytest

import mjrock as mr

README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
NAMES = [name for name in mr.__all__ if ">>>" in (inspect.getdoc(getattr(mr, name)) or "")]


@pytest.fixture(scope="module")
def names():
    """What the README defines."""
    found: dict = {}
    with redirect_stdout(StringIO()):
        exec(re.search(r"```python\n(.*?)```", README, re.DOTALL)[1], found)
    return found


def test_there_are_examples():
    assert len(NAMES) >= 15


@pytest.mark.parametrize("name", NAMES)
def test_an_example_gives_what_it_shows(name, names):
    text = inspect.getdoc(getattr(mr, name))
    example = doctest.DocTestParser().get_doctest(text, dict(names), name, None, 0)
    assert example.examples
    printed = StringIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        failed = doctest.DocTestRunner(verbose=False).run(example, out=printed.write).failed
    assert not failed, printed.getvalue()
