"""A JSON schema that defines equal parts once, so that it is short enough for editors."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

Schema = dict[str, Any]
"""A schema, or a part of one."""
Part = Mapping[str, Any]
"""A part of a schema that is read alone."""
SINGLE_PART, PARTS_BY_NAME, LISTED_PARTS = (
    ("items", "additionalProperties", "then", "else"),
    ("properties", "$defs"),
    ("anyOf", "oneOf"),
)
"""Keywords whose value is a part of a schema, parts by names, and a list of parts."""
LONGEST_REPEATED = 60
"""Most letters of a part that is repeated where it occurs: it is hardly longer than a reference to it."""


def shared(whole: Schema) -> Schema:
    """The same schema, with each longer part that occurs again as one of `$defs`."""
    counts = Counter[str]()
    names: dict[str, str] = {}
    parts: Schema = {}

    def count(node: object) -> object:
        text = _text(node)
        counts[text] += 1
        return _with_parts(node, count) if counts[text] == 1 else node

    def written(node: object) -> object:
        text = _text(node)
        if counts[text] == 1 or len(text) <= LONGEST_REPEATED:
            return _with_parts(node, written)
        if text not in names:
            names[text] = f"part_{len(names) + 1}"
            parts[names[text]] = _with_parts(node, written)
        return {"$ref": f"#/$defs/{names[text]}"}

    tables = whole["$defs"]
    whole = whole | {"$defs": {name: _beyond_free(tables, name) for name in tables}}
    count(whole)
    result: Schema = _with_parts(whole, written)
    return result | {"$defs": result["$defs"] | parts}


def _beyond_free(tables: Schema, name: str) -> Schema:
    """A definition. Where there is a partial one with the same keys, whose name has a `?`, it refers to that one and
    adds the keys that it requires."""
    table: Schema = tables[name]
    free = f"{name.rstrip('?!')}?{'' if name.startswith('[') else '!'}"
    keys, own_keys = tables.get(free, {}).get("properties", {}), table.get("properties", {})
    if name == free or not keys or keys.keys() != own_keys.keys():
        return table
    further = {key: part for key, part in own_keys.items() if part != keys[key] and "const" not in part}
    needed = {"required": table["required"]} if "required" in table else {}
    return {"$ref": f"#/$defs/{free}"} | needed | ({"properties": further} if further else {})


def _with_parts(node: object, call: Callable[[object], object]) -> Any:
    """A part of a schema, with what a function makes of each part in it."""
    if not isinstance(node, dict):
        return node
    result = dict(node)
    for key, value in node.items():
        if key in PARTS_BY_NAME:
            result[key] = {name: call(part) for name, part in value.items()}
        elif key in LISTED_PARTS:
            result[key] = [call(part) for part in value]
        elif key in SINGLE_PART:
            result[key] = call(value)
    return result


def _text(part: object) -> str:
    """A part of a schema as text."""
    return json.dumps(part, sort_keys=True)
