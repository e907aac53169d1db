"""Plain tables as TOML text, floats with all their digits."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from typing import Any

BARE = re.compile(r"[A-Za-z0-9_-]+")


def toml_text(document: Mapping[str, Any]) -> str:
    """Tables as TOML text, from which `tomllib` reads the same again.

    Args:
        document: nested dictionaries and lists of texts, numbers, truths and tables. None is left out.

    Raises:
        TypeError: for a value that TOML has not.
    """
    return "\n".join(_lines(document, "")).strip() + "\n"


def _lines(table: Mapping[str, Any], name: str) -> list[str]:
    """The lines of a table: its values first, then the tables in it."""
    lines, tables = [], []
    for key, value in table.items():
        full_name = f"{name}.{toml_key(key)}" if name else toml_key(key)
        if isinstance(value, Mapping):
            below = _lines(value, full_name)
            head = [f"[{full_name}]"] if not value or any(not line.startswith("[") for line in below[:1]) else []
            tables += ["", *head, *below] if head else below
        elif isinstance(value, list | tuple) and value and all(isinstance(item, Mapping) for item in value):
            for item in value:
                tables += ["", f"[[{full_name}]]", *_lines(item, full_name)]
        elif value is not None:
            lines.append(f"{toml_key(key)} = {toml_value(value)}")
    return lines + tables


def toml_key(name: str) -> str:
    """A key as TOML, in quotation marks where it needs them."""
    return name if BARE.fullmatch(name) else _text(name)


def _text(text: str) -> str:
    """A text in quotation marks. JSON writes it as TOML reads it, but for the delete character."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def toml_value(value: object) -> str:
    """A value on a line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, Mapping):
        return (
            "{ "
            + ", ".join(f"{toml_key(key)} = {toml_value(item)}" for key, item in value.items() if item is not None)
            + " }"
        )
    raise TypeError(f"{value!r} of type {type(value).__name__} is nothing that a TOML file has")
