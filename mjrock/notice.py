"""Lines for the user on the standard error, and warnings that become such lines."""

from __future__ import annotations

import contextlib
import sys
import warnings
from collections.abc import Callable, Iterator
from typing import TextIO


def notice(text: str, by: str = "mjrock") -> None:
    """Write a line for the user. Programs without a console have no standard error, and the line is left out."""
    if sys.stderr is not None:
        sys.stderr.write(f"{by}: {text}\n")
        sys.stderr.flush()


@contextlib.contextmanager
def collect_warnings(first: Callable[[str], bool | None]) -> Iterator[None]:
    """Pass the text of every warning that would be shown to `first`, and show those for which it returns True."""
    show_before = warnings.showwarning

    def shown(
        message: Warning | str,
        category: type[Warning],
        filename: str,
        lineno: int,
        file: TextIO | None = None,
        line: str | None = None,
    ) -> None:
        if first(f"{category.__name__}: {message}"):
            show_before(message, category, filename, lineno, file, line)

    warnings.showwarning = shown
    try:
        yield
    finally:
        warnings.showwarning = show_before
