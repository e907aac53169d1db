"""A JSON schema with each longer part once, so that it is short enough for editors."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from typing import Any

from .mechanisms import SECTIONS

Schema = dict[str, Any]
WITH_PARTS, WITH_NAMED, WITH_SEVERAL = (
    ("items", "additionalProperties", "then", "else"),
    ("properties", "$defs"),
    ("anyOf", "oneOf", "allOf", "prefixItems"),
)
"""Keywords whose value is a part of a schema, parts by names, and a list of parts."""
OF_PLACE = "required", "title", "description", "default", "unit"
"""Keywords of a table or of alternatives that differ from place to place."""
LETTERS_OF_REFERENCE = 30
"""Of a reference to a part, about."""


class Shared:
    """A schema in which each longer part stands once, as one of `$defs`.

    Args:
        whole: the schema, in which parts may stand several times.

    Attributes:
        schema: it.
    """

    def __init__(self, whole: Schema) -> None:
        parts = whole["$defs"]
        whole = whole | {"$defs": _grouped({name: _over(parts, name, one) for name, one in parts.items()})}
        self._counts, self._names = Counter[str](), {_text(one): name for name, one in whole["$defs"].items()}
        self._count("", whole)
        self._parts: Schema = {}
        self.schema = self._with(whole, self._written)
        self.schema["$defs"] = self.schema["$defs"] | self._parts

    def _with(self, node: Schema, call: Callable[[str, Any], Any]) -> Schema:
        """A part of the schema, with what a function makes of the name and the value of each part in it."""
        made = dict(node)
        for key, value in node.items():
            if key in WITH_NAMED:
                made[key] = {name: call(name, one) for name, one in value.items()}
            elif key in WITH_SEVERAL:
                made[key] = [call(key, one) for one in value]
            elif key in WITH_PARTS:
                made[key] = call(key, value)
        return made

    def _count(self, name: str, node: Any) -> None:
        """Count a part, and those in it when it is met first. What it is counts without what is said of it too."""
        text = _text(node)
        self._counts[text] += 1
        if self._counts[text] > 1 or not isinstance(node, dict):
            return
        bare = _bare(node)
        if bare == node:
            self._with(node, self._count)
        else:
            self._count(name, bare)

    def _written(self, name: str, node: Any) -> Any:
        """A part, or the reference to it."""
        if not isinstance(node, dict):
            return node
        text = _text(node)
        size, count = len(text), self._counts[text]
        if count * (size - LETTERS_OF_REFERENCE) < size + LETTERS_OF_REFERENCE or self._names.get(text) == name:
            bare = _bare(node)
            if bare != node and self._counts[_text(bare)] > 1:
                return self._written(name, bare) | {key: one for key, one in node.items() if key not in bare}
            return self._with(node, self._written)
        if text not in self._names:
            same = sum(one.partition(":")[0] == name for one in self._parts)
            self._names[text] = f"{name}:{same + 1}"
            self._parts[self._names[text]] = {}
            self._parts[self._names[text]] = self._written(self._names[text], node)
        return {"$ref": f"#/$defs/{self._names[text]}"}


def _over(parts: Schema, name: str, table: Schema) -> Schema:
    """A definition, as what it asks for beyond that of the same table with no key that it needs."""
    if name == "own":
        alone = _keys(parts["several"]) - _keys(table)
        return {"$ref": "#/$defs/several", "properties": dict.fromkeys(sorted(alone), False)}
    if name == "one":
        return _single(parts, table)
    table = {key: one for key, one in table.items() if key != "title"}
    free_name = f"{name.rstrip('?!')}?{'!' * (not name.startswith('['))}"
    free = parts.get(free_name, {}).get("properties", {})
    if name == free_name or not free or free.keys() != table["properties"].keys():
        return table
    own = {key: one for key, one in table["properties"].items() if one != free[key] and "const" not in one}
    needed = {"required": table["required"]} if "required" in table else {}
    return {"$ref": f"#/$defs/{free_name}"} | needed | ({"allOf": [{"properties": own}]} if own else {})


def _single(parts: Schema, table: Schema) -> Schema:
    """A file of one mechanism, as what it asks for beyond one of several."""
    kinds = []
    for full, free in zip(table["oneOf"], parts["several"]["anyOf"], strict=True):
        own = {key: one for key, one in full["properties"].items() if key == "kind" or one != free["properties"][key]}
        own = {key: one for key, one in own.items() if key not in SECTIONS}
        kinds.append({"properties": own, "required": full["required"]})
    sections = {name: table["oneOf"][0]["properties"][name] for name in SECTIONS}
    return {"$ref": "#/$defs/several", "properties": {"mechanisms": False} | sections, "oneOf": kinds}


def _grouped(parts: Schema) -> Schema:
    """Definitions, with the keys that most constructors of a class have alike as one of their own."""
    made = dict(parts)
    makers = {name: one for name, one in parts.items() if name.endswith("?!") and "." in name}
    for kind in sorted({name.partition(".")[0] for name in makers}):
        own = {name: one["properties"] for name, one in makers.items() if name.startswith(f"{kind}.")}
        found: dict[str, list[str]] = {}
        for keys in own.values():
            for key, one in keys.items():
                found.setdefault(key, []).append(_text(one))
        usual = {key: some for key, some in found.items() if 2 * len(some) > len(own) > 3}
        alike = {key: json.loads(some[0]) for key, some in usual.items() if len(set(some)) == 1}
        for name, keys in own.items() if alike else ():
            left = {key: key in alike or one for key, one in keys.items()}
            made[name] = makers[name] | {"properties": left, "allOf": [{"properties": alike}]}
    return made


def _keys(mechanisms: Schema) -> set[str]:
    """The keys of all mechanisms."""
    return {name for one in mechanisms["anyOf"] for name in one["properties"]}


def _text(part: Any) -> str:
    """A part of a schema as text."""
    return json.dumps(part, sort_keys=True)


def _bare(node: Schema) -> Schema:
    """What a table or several alternatives are, without what is said of them and the keys that they need."""
    nested = "properties" in node or "anyOf" in node
    return {key: one for key, one in node.items() if key not in OF_PLACE} if nested else node
