"""Parameters of a test of which only some are run every day."""

from collections.abc import Sequence
from typing import Any

import pytest


def among(values: Sequence[Any], *chosen: Any) -> list[Any]:
    """All values; those that are not among the chosen ones are slow."""
    return [value if value in chosen else slow(value) for value in values]


def slow(value: Any) -> Any:
    """A value, or a tuple of values, that is not run every day."""
    values = value if isinstance(value, tuple) else (value,)
    return pytest.param(*values, marks=pytest.mark.slow)
