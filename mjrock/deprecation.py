"""Functions that a later version removes: see VERSIONING.md."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


def deprecated(instead: str, *, since: str, removal: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Mark a function or a method as one that a later version removes: each call gives a FutureWarning.

    Args:
        instead: what takes its place, as the user writes it.
        since: the version that deprecates it.
        removal: the major version that removes it.
    """

    def marked(function: Callable[P, R]) -> Callable[P, R]:
        message = f"{function.__qualname__} is deprecated since mjrock {since} and removed in {removal}; use {instead}"

        @wraps(function)
        def warning(*args: P.args, **kwargs: P.kwargs) -> R:
            warnings.warn(message, FutureWarning, stacklevel=2)
            return function(*args, **kwargs)

        return warning

    return marked
