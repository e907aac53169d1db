"""The JSON schema of the file, for editors and forms, made from the signatures that the file is read by."""

from __future__ import annotations

import math
import typing
from collections.abc import Iterable, Mapping
from copy import deepcopy
from functools import cache
from typing import get_args

import numpy as np

from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..quantities import Within
from .assessment import DESIGN, FILE_KEYS, report_maker
from .declarations import (
    USUAL_MAKE,
    Hint,
    Key,
    Maker,
    Makers,
    choices_of,
    classes_of,
    is_path,
    items_of,
    key_named,
    makers_of,
)
from .mechanisms import CHECK, CURVE, FLOOR, MECHANISMS, SECTIONS, SITES
from .reading import NUMERIC, is_mapping, kinds_and_range
from .running import DYNAMIC, RECORDS, SCALED, SOLVERS, run_maker
from .sharing import Schema, shared

STATES = "SLV", "SLC", "SLD"
"""Limit states that an editor proposes; a code of one's own may have others."""


def toml_schema() -> Schema:
    """The JSON schema of the file of an assessment, draft 2020-12, as `python -m mjrock schema` prints it.

    Each class, constructor and function that a table stands for is one of `$defs`, and so is each part that occurs
    again. A number has its `minimum` and `maximum`, and beside them its `unit` in SI, empty for a plain number; a
    text is a number with a unit.
    """
    return shared(whole_schema())


def whole_schema() -> Schema:
    """The same schema for forms and templates: each table has all of its keys, which stand in others too."""
    return deepcopy(_written_once())


@cache
def _written_once() -> Schema:
    """The schema of this process, which nobody may change."""
    return SchemaWriter().whole()


class SchemaWriter:
    """Writes the schema, each class once.

    A definition whose name has a `?` is partial: its mechanism may share keys with others. With a `!` it needs no
    `kind`.

    Attributes:
        parts: the definitions.
    """

    def __init__(self) -> None:
        self.parts: Schema = {}

    def whole(self) -> Schema:
        """The schema of the file."""
        once = {name: self.of_key(key) for name, key in FILE_KEYS.items()}
        self.parts |= {"[report]": self._table(report_maker(), partial=False), "[design]": self._design()}
        once |= {name: {"$ref": f"#/$defs/[{name}]"} for name in ("report", "design")}
        several = {"mechanisms": {"type": "object", "additionalProperties": {"$ref": "#/$defs/own"}}}
        self.parts["own"] = self._mechanism({}, partial=True)
        self.parts["one"] = self._mechanism(once, partial=False)
        self.parts["several"] = self._mechanism(once | several, partial=True)
        return {
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": "mjrock assessment",
            "type": "object",
            "if": {"required": ["mechanisms"]},
            "then": {"$ref": "#/$defs/several"},
            "else": {"$ref": "#/$defs/one"},
            "$defs": self.parts,
        }

    def _design(self) -> Schema:
        """What `[design]` has: the values are those of the key."""
        schema = self._table(DESIGN, partial=False)
        schema["properties"]["values"] = {
            "type": "array",
            "minItems": 1,
            "description": "those that are tried, in order",
        }
        return schema | {"required": ["key", "values"]}

    def _mechanism(self, once: Schema, *, partial: bool) -> Schema:
        """The tables of a mechanism, of which a partial one shares some with others."""
        mark = "?" if partial else ""
        if f"[site]{mark}" not in self.parts:
            self.parts |= {f"[{name}]{mark}": table for name, table in self._sections(partial).items()}
        sections: Schema = {name: {"$ref": f"#/$defs/[{name}]{mark}"} for name in SECTIONS}
        if partial:
            sections = {name: _or_taken_away(table) for name, table in sections.items()}
        kinds = []
        for kind, makers in MECHANISMS.items():
            table = self._table(makers[""], partial=partial)
            if partial and "effects" in table["properties"]:
                table["properties"]["effects"] = _or_taken_away(table["properties"]["effects"])
            kind_key = {"kind": {"const": kind, "default": "Case"}} if kind == "Case" else {"kind": {"const": kind}}
            needed = [] if partial or kind == "Case" else ["kind"]
            table["properties"] = kind_key | table["properties"] | sections | once
            table["required"] = needed + table.pop("required", [])
            kinds.append(table)
        if not partial:
            return {"oneOf": kinds}
        return {"type": "object", "anyOf": kinds}

    def _sections(self, partial: bool) -> Schema:
        """The tables beside those of the mechanism."""
        ground = self._kinds(SITES, partial=True, usual="code_spectrum")
        state = ground | {"description": "of one limit state of the code, with what it does not share"}
        site = self._with_keys(ground, dict.fromkeys(STATES, state))
        scaled = {"scaled_to": self._table(SCALED, partial=False)}
        records = self._with_keys(self._kinds(RECORDS, partial=partial, usual="records_in"), scaled)
        for part in records["anyOf"]:
            part["properties"] = {name: _one_or_several(key_schema) for name, key_schema in part["properties"].items()}
        schema: Schema = {"site": site}
        schema |= {
            name: self._table(maker, partial=partial)
            for name, maker in (("floor", FLOOR), ("check", CHECK), ("limit_curve", CURVE), ("dynamic_check", DYNAMIC))
        }
        for kind in (Restitution, Contacts):
            makers = {name: maker.without("wall", "e") for name, maker in makers_of(kind).items()}
            schema[kind.__name__.lower()] = self._kinds({kind.__name__: makers}, partial=partial)
        schema["records"] = {"anyOf": [records, {"type": "array", "items": records}]}
        schema["run"] = {"anyOf": [self._table(run_maker(name), partial=partial) for name in SOLVERS]}
        for run_schema, name in zip(schema["run"]["anyOf"], SOLVERS, strict=True):
            run_schema["properties"]["solver"] = {"const": name} | ({"default": name} if name == SOLVERS[0] else {})
        return schema

    def _with_keys(self, schema: Schema, further: Schema) -> Schema:
        """What a table stands for, with further keys."""
        parts = [self.parts[reference["$ref"].removeprefix("#/$defs/")] for reference in schema["anyOf"]]
        return {"anyOf": [part | {"properties": part["properties"] | further} for part in parts]}

    def _table(self, maker: Maker, *, partial: bool) -> Schema:
        """The schema of a table that stands for a call."""
        properties = {key_named(key): self.of_key(key, partial) for key in maker.keys.values()}
        properties = {name: key_schema for name, key_schema in properties.items() if key_schema}
        needed, otherwise = ([key_named(key) for key in maker.missing(known)] for known in ((), ("at",)))
        schema: Schema = {"type": "object", "description": maker.doc, "properties": properties}
        if "at" in properties and needed != otherwise and not partial:
            schema |= {"if": {"required": ["at"]}, "else": {"required": needed}}
            needed = otherwise
        return schema | ({"required": needed} if needed and not partial else {}) | {"additionalProperties": False}

    def _kinds(self, kinds: Mapping[str, Makers], *, partial: bool = False, usual: str = "") -> Schema:
        """The schema of a table whose `kind` and `make` say what it stands for."""
        schemas = [
            self._part(kind, make, maker, partial, kind != usual and len(kinds) > 1)
            for kind, makers in kinds.items()
            for make, maker in makers.items()
        ]
        return schemas[0] if len(schemas) == 1 else {"anyOf": schemas}

    def _part(self, kind: str, make: str, maker: Maker, partial: bool, named: bool) -> Schema:
        """One class or constructor, as one of the definitions."""
        usual = USUAL_MAKE.get(kind, "" if make == "" else kind)
        name = f"{kind}.{make}" if make else kind
        key = name + ("?" if partial else "") + ("" if named else "!")
        if key not in self.parts:
            self.parts[key] = {}  # of a class within itself
            table = self._table(maker, partial=partial)
            names = {"kind": {"const": kind} | ({} if named else {"default": kind})}
            needed = ["kind"] if named else []
            if make != usual or make:
                names["make"] = {"const": make or kind} | ({"default": make} if make == usual else {})
                needed += [] if make == usual else ["make"]
            table["properties"] = names | table["properties"]
            if needed + table.get("required", []):
                table["required"] = needed + table.get("required", [])
            self.parts[key] = {"title": name} | table
        return {"$ref": f"#/$defs/{key}"}

    def of_key(self, key: Key, partial: bool = False) -> Schema:
        """The schema of a key; empty for one that a file cannot have."""
        schema = self._schema_of_kinds(key.kinds, key.within, partial)
        if not schema:
            return {}
        if key.doc:
            schema["description"] = key.doc
        if isinstance(key.default, bool | int | float | str) and math.isfinite(
            key.default if isinstance(key.default, int | float) else 0
        ):
            schema["default"] = key.default
        return schema

    def _schema_of_kinds(self, kinds: Iterable[Hint], within: Within | None, partial: bool = False) -> Schema:
        """The schema of a value of one of some types."""
        kinds = tuple(kinds)
        schemas: list[Schema] = []
        texts = [choice for kind in kinds for choice in choices_of(kind)]
        if bool in kinds:
            schemas.append({"type": "boolean"})
        if any(kind in NUMERIC or typing.get_origin(kind) in NUMERIC for kind in kinds):
            schemas.append(_number(kinds, within))
        if any(kind is np.ndarray or typing.get_origin(kind) is np.ndarray for kind in kinds):
            schemas.append({"type": "array"})
        if texts:
            schemas.append({"type": "string", "enum": texts})
        elif str in kinds:
            schemas.append({"type": "string"} | ({"x-path": True} if is_path(kinds) else {}))
        for kind in kinds:
            if (items := items_of(kind)) is not None:
                schemas.append(self._list(items, within))
            elif is_mapping(kind):
                values = self._schema_of_kinds(*kinds_and_range(get_args(kind)[1], None))
                schemas.append({"type": "object", "additionalProperties": values})
        if classes := classes_of(kinds):
            schemas.append(self._kinds({name: makers_of(kind) for name, kind in classes.items()}, partial=partial))
        schemas = [part for i, part in enumerate(schemas) if part and part not in schemas[:i]]
        return (schemas[0] if len(schemas) == 1 else {"anyOf": schemas}) if schemas else {}

    def _list(self, items: tuple[Hint, ...], within: Within | None) -> Schema:
        """The schema of a list."""
        if items[-1] is ...:
            item_schema = self._schema_of_kinds(*kinds_and_range(items[0], within))
            return {"type": "array", "items": item_schema} if item_schema else {}
        item_schemas = [self._schema_of_kinds(*kinds_and_range(item, within)) for item in items]
        return {
            "type": "array",
            "prefixItems": item_schemas,
            "minItems": len(item_schemas),
            "maxItems": len(item_schemas),
        }


def _or_taken_away(schema: Schema) -> Schema:
    """The schema of what may be shared: false takes it away."""
    return {"anyOf": [schema, {"const": False}], "description": "false: without the shared one"}


def _one_or_several(node: Schema) -> Schema:
    """The schema of a number of which several may be given, each for a record of its own."""
    return {"anyOf": [node, {"type": "array", "items": node}]} | one_of_form(node) if "minimum" in node else node


def one_of_form(schema: Schema) -> Schema:
    """What a form shows of a number."""
    return {name: schema[name] for name in ("description", "unit", "default") if name in schema}


def _number(kinds: tuple[Hint, ...], within: Within | None) -> Schema:
    """The schema of a number, or of a text with a unit."""
    is_whole = within.whole if within else int in kinds and float not in kinds
    schema: Schema = {"type": "integer"} if is_whole else {"type": ["number", "string"]}
    if within is not None:
        schema |= {"minimum": _short(within.low)} if math.isfinite(within.low) else {}
        schema |= {"maximum": _short(within.high)} if math.isfinite(within.high) and not within.infinite else {}
        schema |= {"unit": "" if within.whole else within.unit}
    return schema


def _short(end: float) -> float:
    """An end of a range as it is written with the fewest characters."""
    return int(end) if float(end).is_integer() else end
