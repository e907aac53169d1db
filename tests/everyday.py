"""Parameters of a test of which only some are run every day."""

import itertools
from collections.abc import Iterable, Sequence
from typing import Any

import pytest


def among(values: Sequence[Any], *chosen: Any) -> list[Any]:
    """All values; those that are not among the chosen ones, all of which are there, are slow."""
    assert all(value in values for value in chosen), chosen
    return [value if value in chosen else slow(value) for value in values]


def slow(value: Any) -> Any:
    """A value, or a tuple of values, that is not run every day."""
    values = value if isinstance(value, tuple) else (value,)
    return pytest.param(*values, marks=pytest.mark.slow)


def crossed(*lists: Iterable[Any]) -> list[Any]:
    """All combinations of these values. Those that are not run every day are slow: the first value of each list is
    run with the first ones of the others, the second with the second ones, and a short list begins again."""
    rows = [list(values) for values in lists]
    every_day = [tuple(row[i % len(row)] for row in rows) for i in range(max(map(len, rows)))]
    return [given if given in every_day else slow(given) for given in itertools.product(*rows)]
