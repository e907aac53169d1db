"""Warnings of a campaign: each kind is said once at the end, with how often it came."""

from __future__ import annotations

import contextlib
import re
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

NUMBER = re.compile(r"\d[\d.]*(?:e[-+]?\d+)?")


class WarningCounter:
    """Warnings by their kind. Those that differ in their numbers alone are of one kind, which keeps the first text."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self.texts: dict[str, str] = {}

    def add(self, text: str, kind: str = "") -> bool:
        """Count a warning, and say whether it is the first of its kind, by default its text without numbers."""
        kind = kind or NUMBER.sub("#", text)
        self.counts[kind] += 1
        return self.texts.setdefault(kind, text) is text

    def lines(self) -> list[str]:
        """A line for each kind with how often it came, the most frequent first."""
        return [
            f"warned once: {self.texts[kind]}" if count == 1 else f"warned {count} times, first: {self.texts[kind]}"
            for kind, count in self.counts.most_common()
        ]


@contextlib.contextmanager
def collect_warnings(first: Callable[[str], bool | None]) -> Iterator[None]:
    """Hand the text of every warning that would be shown to `first`, and show those for which it says so."""
    before = warnings.showwarning

    def shown(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
        if first(f"{category.__name__}: {message}"):
            before(message, category, *place, **more)

    warnings.showwarning = shown
    try:
        yield
    finally:
        warnings.showwarning = before
