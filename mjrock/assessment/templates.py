"""Complete files to begin with, with the meaning of each key from the schema of files."""

from __future__ import annotations

import re
import textwrap
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from ..toml_text import toml_key, toml_value
from .schema import whole_schema
from .sharing import Part
from .tables import Document

TEMPLATE_FILE = Path(__file__).with_name("templates.toml")
"""The values of all templates."""
TEMPLATE_WIDTH = 100
"""Columns of a template."""
SENTENCE = re.compile(r"(?<=\.)\s+(?=[A-Z`])")
"""Between two sentences."""
TEMPLATE_HEAD = """\
Numbers are in SI units, or texts with a unit, such as "30 cm", "60 kN", "0.2 g" and "12 deg".
A key after # may be left out, and has the value that is shown, if one is; take the # away to give
it another one. None in a comment stands for a key that is left out.
    mjrock check FILE                    prints whether it holds
    mjrock report FILE -o report.pdf     writes the report"""


def seeds() -> dict[str, dict[str, Any]]:
    """The values of each template by its name, with what they share, and its `title`."""
    tables = tomllib.loads(TEMPLATE_FILE.read_text(encoding="utf-8"))
    shared = tables.pop("shared")
    return {name: merged(shared, table) for name, table in tables.items()}


def merged(shared: Document, own: Document) -> dict[str, object]:
    """Tables with what they share, table by table."""
    tables = dict(own)
    for name, value in shared.items():
        own_table = own.get(name, {})
        both_tables = isinstance(value, Mapping) and isinstance(own_table, Mapping)
        tables[name] = merged(value, own_table) if both_tables else value
    return tables


class Writer:
    """Writes the tables of a template with what each key means.

    Args:
        schema: of the file.

    Attributes:
        explained: names of the classes whose optional keys have been listed.
    """

    def __init__(self, schema: Part) -> None:
        self.schema = schema
        self.explained: set[str] = set()

    def alternatives(self, node: Part) -> list[Part]:
        """What a value may be, each without references."""
        if "$ref" in node:
            beside = {key: value for key, value in node.items() if key != "$ref"}
            definition = self.schema["$defs"][node["$ref"].removeprefix("#/$defs/")]
            return [{**alternative, **beside} for alternative in self.alternatives(definition)]
        several = node.get("anyOf") or node.get("oneOf")
        return [alternative for branch in several for alternative in self.alternatives(branch)] if several else [node]

    def fitting(self, node: Part, value: Document) -> Part:
        """The alternative that a table is of, by its `kind` and `make`."""
        for alternative in self.alternatives(node):
            parts = [alternative.get("properties", {}).get(key, {}) for key in ("kind", "make")]
            values = [value.get(key, part.get("default")) for key, part in zip(("kind", "make"), parts, strict=True)]
            if alternative.get("type") == "object" and values == [part.get("const") for part in parts]:
                return alternative
        return {}

    def table(self, node: Part, value: Document, path: str) -> Iterator[str]:
        """The lines of a table: its keys, those that may be left out, and the tables in it."""
        schema = self.fitting(node, value)
        keys: Part = schema.get("properties", {})
        is_explained = schema.get("title", path) in self.explained
        self.explained.add(schema.get("title", path))
        below = {name: value[name] for name in sorted(value, key=[*keys, *value].index) if is_table(value[name])}
        for name, item in value.items():
            if name not in below:
                yield from explained(f"{toml_key(name)} = {toml_value(item)}", keys.get(name, {}))
        if "mechanisms" in value:  # what stands above them is for all
            common = [alternative.get("properties", {}).keys() for alternative in self.alternatives(node)]
            keys = {name: key for name, key in keys.items() if all(name in known for known in common)}
        for name, key in keys.items():
            if not is_explained and name not in value and "const" not in key and not self.holds_tables(key):
                yield from explained(f"#{name} = {default_of(key)}".rstrip(), key)
        for name, item in below.items():
            key = keys.get(name) or schema.get("additionalProperties") or {}
            is_alike = key.keys() <= {"type", "description"}  # of a limit state: what the site has too
            yield from self.below(schema if is_alike else key, item, f"{path}.{toml_key(name)}".lstrip("."))
        further = [name for name, key in keys.items() if name not in value and self.holds_tables(key)]
        if further and not is_explained:
            where = f"[{path}]" if path else "this file"
            yield from ("", *comment(f"Further tables of {where}: {', '.join(further)}. See `mjrock schema`."))

    def below(self, node: Part, value: Any, path: str) -> Iterator[str]:
        """The lines of a table in another, or of several in a list."""
        if isinstance(value, Mapping):
            schema = self.fitting(node, value)
            if not value or not all(map(is_table, value.values())):
                yield from ("", *comment(schema.get("description", node.get("description", ""))), f"[{path}]")
            yield from self.table(node, value, path)
            return
        items = [item for alternative in self.alternatives(node) for item in [alternative.get("items")] if item]
        for table in value:
            schema = self.fitting({"anyOf": items}, table)
            yield from ("", *comment(schema.get("description", "")), f"[[{path}]]")
            yield from self.table(schema, table, path)

    def holds_tables(self, node: Part) -> bool:
        """Whether a key is a table or a list of tables, whatever it is."""
        parts = [
            part for choice in self.alternatives(node) for part in self.alternatives(choice.get("items") or choice)
        ]
        return all("properties" in part or part.get("type") == "object" for part in parts)


def is_table(value: object) -> bool:
    """Whether a value is a table, or a list of tables."""
    items = value if isinstance(value, list) and value else [value]
    return all(isinstance(item, Mapping) for item in items)


def default_of(key: Part) -> str:
    """The value of a key that is left out, as TOML; empty where it has none."""
    return toml_value(key["default"]) if "default" in key else ""


def explained(line: str, key: Part) -> Iterator[str]:
    """A line with what its key means, beside it or above it."""
    text = SENTENCE.split(key.get("description", ""))[0]
    low, high, unit = key.get("minimum"), key.get("maximum"), key.get("unit", "")
    if low is not None and high is not None and " to " not in text:
        text = f"{text} {low:g} to {high:g} {unit}".strip()
    with_text = f"{line:<32}  # {text}" if text else line
    if len(with_text) <= TEMPLATE_WIDTH:
        yield with_text
    else:
        yield from (*comment(text), line)


def comment(text: str) -> list[str]:
    """A text as comments."""
    return textwrap.wrap(" ".join(text.split()), TEMPLATE_WIDTH, initial_indent="# ", subsequent_indent="# ")


def template(name: str) -> str:
    """The text of a template."""
    return template_text(seeds()[name], whole_schema())


def templates() -> dict[str, str]:
    """The texts of all templates by name."""
    schema = whole_schema()
    return {name: template_text(values, schema) for name, values in seeds().items()}


def template_text(values: dict[str, Any], schema: Part) -> str:
    """Values as the text of a template."""
    head = [*comment(values.pop("title")), "#", *(f"# {line}" for line in TEMPLATE_HEAD.splitlines()), ""]
    root = schema["then" if "mechanisms" in values else "else"]
    return "\n".join([*head, *Writer(schema).table(root, values, "")]) + "\n"
