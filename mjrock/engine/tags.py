"""Tags: the elements of the model text, with every digit of their numbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..files import quoted


def section(name: str, lines: Iterator[str]) -> list[str]:
    """A section of the text, or nothing where it would be empty."""
    elements = list(lines)
    return [f"<{name}>", *elements, f"</{name}>"] if elements else []


def value_text(value: object) -> str:
    """A quoted attribute: texts as they are, numbers with every digit that tells them from their neighbours."""
    if isinstance(value, str):
        return quoted(value)
    return f'"{" ".join(repr(float(number)) for number in np.ravel(np.asarray(value)))}"'


def tag(kind: str, within: str = "", /, **attributes: object) -> str:
    """An element with attributes."""
    opened = f"<{kind} {' '.join(f'{key}={value_text(value)}' for key, value in attributes.items())}"
    return f"{opened}>{within}</{kind}>" if within else f"{opened}/>"
