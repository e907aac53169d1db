"""The plan of the form, from the schema of the file alone, and the input of the form as tables of the file.

The input is what a person has typed: nested dictionaries and lists of the shape of the file, whose values are texts. A
text becomes a number, a truth or a list where its field takes one; any other stays, for the reader of the file to
refuse it or to take it as a number with a unit.
"""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from ..assessment.sharing import Part
from ..assessment.tables import Document, Place
from ..reporting.page import TITLE_BLOCK_KEYS
from ..reporting.texts import MINUS, POWERS, Words, languages

TEXTS = Path(__file__).with_name("texts.toml")
"""The texts of the form, beside those of the report."""
VARIANT_KEYS = "kind", "make", "solver"
"""Keys that name the class, its constructor or the solver that a table stands for."""
FILE_CONTROLS = "file", "folder"
"""Controls whose values are names of files that are uploaded, or their folder."""
UPLOAD_FOLDER = "."
"""The folder of all files that are uploaded."""
ANY_TYPE = frozenset({"number", "boolean", "array"})
"""Types of a value whose key is not known."""
NUMBER_WITH_COMMA = re.compile(r"^([+-]?(?:0+|\d+(?=,(?!\d{3}(?!\d)))|\d{4,})),(\d+)(?=[^\d.,]|$)")
"""A number with a comma as its decimal mark, and what follows. One such as 1,000 may be a thousand and is left out."""
TRUTHS = {"true": True, "false": False}
SCHEMA_LANGUAGE = "en"
"""The language of the descriptions in the schema."""
BOUND = r"-?\d+(?:\.\d+)?(?:e-?\d+)?"
RANGE_TEXT = re.compile(rf"(?: \[[^\]]*\])?, (?:above )?({BOUND}) to ({BOUND})(?:(?=[.,;:](?!\d)|$)|(?P<and> and ))")
"""The range of a number in its description, with its unit."""


class Variant(NamedTuple):
    """What a table may stand for.

    Args:
        id: of its fields in the plan.
        label: what a person reads.
        names: the values of `kind` and `make` that name it.
        usual: whether it is so where these are left out.
    """

    id: str
    label: str
    names: dict[str, str]
    usual: bool


class Field(NamedTuple):
    """One field of the form.

    Args:
        key: its name in the file.
        label, help: what a person reads beside it and below it, in the language of the form.
        english: its description, where there is no help in the language.
        control: "number", "text", "choice", "truth", "file", "folder" of files, "row" of values in brackets, "table",
            "list" of tables, "named" tables, or "pairs" of names and texts.
        unit: in SI.
        range: of a number with its unit, in words.
        default: as a text; empty where there is none.
        needed: whether the file has to have it.
        choices: values and their labels; of "pairs" the names that it has, and their labels.
        variants: what its tables may be.
        several: whether it takes several files.
        types: of the values that it takes, as the schema names them.
    """

    key: str
    label: str
    help: str
    control: str
    english: str = ""
    unit: str = ""
    range: str = ""
    default: str = ""
    needed: bool = False
    choices: tuple[tuple[str, str], ...] = ()
    variants: tuple[Variant, ...] = ()
    several: bool = False
    types: frozenset[str] = frozenset()


class Plan:
    """The plan of the form in a language.

    Args:
        schema: of the file, see `mjrock.toml_schema`.
        words: of the language, with the texts of the form.

    Attributes:
        tables: the fields of each table by its id.
        root: the field of the whole file.
    """

    def __init__(self, schema: Part, words: Words) -> None:
        self.schema, self.words = schema, words
        self.tables: dict[str, list[Field]] = {}
        self._owners: dict[str, str] = {}
        parts = schema["$defs"]
        several = self._field("mechanisms", {"anyOf": [_mechanisms_of(parts["several"])]}, False)
        self.root = self._field("", parts["one"], True)
        for variant in self.root.variants:
            fields = [field for field in self.tables[variant.id] if field.key != "language"]
            self.tables[variant.id] = [*fields, several]

    def _field(self, key: str, node: Part, needed: bool, place: str = "") -> Field:
        """The field of a key; `place` is the id of the table that it is in."""
        alternatives = list(self._alternatives(node))
        plain = [part for _, part in alternatives if not _is_table(part)]
        types = frozenset(name for part in plain for name in _types(part))
        control, variants = self._control_of_tables(alternatives, f"{place}.{key}")
        choices = self._choices(plain, types)
        if control == "pairs" and key == "project":
            choices = tuple((name, self.words(f"head_{name}")) for name in TITLE_BLOCK_KEYS)
        if not control or (control == "table" and types - {"boolean"}):
            control = self._control(key, plain, types, bool(choices))
        number = next((part for part in plain if "unit" in part or "minimum" in part), {})
        text = _text_without_range(str(node.get("description", "")), number)
        help = text if self.words.language == SCHEMA_LANGUAGE else self._help(key, place)
        return Field(
            key,
            self._label(key, place),
            help,
            control,
            english="" if help else text,
            unit=_unit(number),
            range=self._range(number),
            default=self._default(node),
            needed=needed,
            choices=choices,
            variants=variants,
            several="array" in types,
            types=types,
        )

    def _control_of_tables(self, alternatives: list[tuple[str, Part]], place: str) -> tuple[str, tuple[Variant, ...]]:
        """The control of a field with tables, and what these may be; an empty one of a field without any."""
        for key, control in (("items", "list"), ("", "table"), ("additionalProperties", "named")):
            for name, node in alternatives:
                part = node.get(key) if key else node
                inner = [*self._alternatives(part, "" if key else name)] if isinstance(part, Mapping) else []
                if any("properties" in alternative for _, alternative in inner):
                    nested = inner if key else alternatives
                    return control, self._variants([pair for pair in nested if "properties" in pair[1]], place)
        return ("pairs", ()) if any(_is_table(node) for _, node in alternatives) else ("", ())

    def _alternatives(self, node: Part, name: str = "") -> Iterator[tuple[str, Part]]:
        """The alternatives of a part of the schema, with the names of those that are definitions."""
        if "$ref" in node:
            name = str(node["$ref"]).rpartition("/")[2]
            yield from self._alternatives(self.schema["$defs"][name], name)
        elif alternatives := node.get("anyOf", node.get("oneOf")):
            for alternative in alternatives:
                yield from self._alternatives(alternative)
        elif node:
            yield name, node

    def _variants(self, tables: list[tuple[str, Part]], place: str) -> tuple[Variant, ...]:
        """What a table may be."""
        variants = []
        kinds = {table["properties"].get("kind", {}).get("const") for _, table in tables}
        naming_keys = VARIANT_KEYS if len(kinds) > 1 else VARIANT_KEYS[1:]
        for i, (name, table) in enumerate(tables):
            properties = table["properties"]
            consts = {key: properties[key] for key in naming_keys if "const" in properties.get(key, {})}
            names = {key: str(node["const"]) for key, node in consts.items()}
            usual = all("default" in node for node in consts.values())
            id = name if name and table is self.schema["$defs"].get(name) else f"{place}/{i}"
            section = ".".join((place.rpartition(".")[2], *names.values()))
            self._owners[id] = str(table.get("title") or names.get("kind") or section)
            self._register(id, table)
            variants.append(Variant(id, self._variant_label(str(table.get("title", "")), names), names, usual))
        return tuple(variants)

    def _register(self, id: str, table: Part) -> None:
        """Plan the fields of a table, once."""
        if id in self.tables:
            return
        self.tables[id] = []
        needed = {*table.get("required", ()), *table.get("else", {}).get("required", ())}
        for key, node in table["properties"].items():
            if key not in VARIANT_KEYS or "const" not in node:
                self.tables[id].append(self._field(key, node, key in needed, id))

    def _control(self, key: str, plain: list[Part], types: frozenset[str], has_choices: bool) -> str:
        """How a value without tables is typed."""
        if any(part.get("x-path") or part.get("items", {}).get("x-path") for part in plain):
            return "folder" if key == "folder" else "file"
        if has_choices:
            return "truth" if types == {"boolean"} else "choice"
        if types & {"number", "integer"}:
            return "number"
        return "row" if types == {"array"} else "text"

    def _choices(self, plain: list[Part], types: frozenset[str]) -> tuple[tuple[str, str], ...]:
        """The values that can be chosen, with their labels; none where others can be typed."""
        texts = [str(value) for part in plain for value in part.get("enum", ())]
        consts = [part["const"] for part in plain if "const" in part]
        known = [text for text, value in TRUTHS.items() if value in consts or not consts] if "boolean" in types else []
        truths = [(text, self.words(f"form_{text}")) for text in known]
        if not texts and types - {"boolean"}:
            return ()
        return (*truths, *((value, self.words.or_else(f"value_{value}", value)) for value in texts))

    def _range(self, node: Part) -> str:
        """The range of a number in words, with its unit."""
        low, high = node.get("minimum", -math.inf), node.get("maximum", math.inf)
        if not math.isfinite(low):
            return ""
        ends = {"low": self._end(low), "high": self._end(high), "unit": f" {_unit(node)}".rstrip()}
        return self.words("form_range" if math.isfinite(high) else "form_from", **ends)

    def _end(self, value: float) -> str:
        """An end of a range, with a power of ten where it is long."""
        digits, _, power = f"{value:g}".partition("e")
        if power:
            digits = f"{digits}\u00b710".removeprefix("1\u00b7").replace("-1\u00b7", "-")
            digits += str(int(power)).translate(POWERS)
        return self.words.marked(digits).replace("-", MINUS)

    def _help(self, key: str, place: str) -> str:
        """What a key means, from the table of the language; empty where that has nothing."""
        known = self.words.texts.get(f"help_{self.words.language}", {})
        return next((known[name] for name in self.names_of(key, place) if name in known), "")

    def names_of(self, key: str, place: str) -> list[str]:
        """The names of a key in a table of helps, the closest first: of a constructor, of its class, of any table."""
        owner = self._owners.get(place, "")
        return [f"{owner}.{key}", f"{owner.partition('.')[0]}.{key}", key]

    def _default(self, node: Part) -> str:
        default = node.get("default")
        if isinstance(default, bool):
            return text_of(default)
        return "" if default is None else self.words.marked(text_of(default)) if _is_number(default) else str(default)

    def _label(self, key: str, place: str) -> str:
        """What an argument is called: of its class, by the form, by the report, or as it is."""
        own_key = f"arg_{self._owners.get(place, '').partition('.')[0]}_{key}"
        known = (own_key, f"arg_{key}", f"in_{key}")
        return next((self.words(name) for name in known if name in self.words.texts), key.replace("_", " "))

    def _variant_label(self, title: str, names: Mapping[str, str]) -> str:
        kind, make = names.get("solver") or names.get("kind", title.partition(".")[0]), names.get("make", "")
        label = self.words.or_else(f"table_{kind}", kind)
        return f"{label}: {self.words.or_else(f'make_{make}', make.replace('_', ' '))}" if make else label

    def field(self, fields: list[Field], key: str) -> Field | None:
        """The field of a key; None where there is none."""
        return next((field for field in fields if field.key == key), None)

    def variant(self, field: Field, values: Mapping[str, object]) -> Variant:
        """The variant of a table that its `kind` and `make` name; the nearest where none fits."""

        def fits(option: Variant, key: str) -> bool:
            variant_name = option.names.get(key)
            return values[key] == variant_name if key in values else variant_name is None or option.usual

        used = {key for option in field.variants for key in option.names}
        fitting = [option for option in field.variants if all(fits(option, key) for key in used)]
        return [*fitting, *(option for option in field.variants if fits(option, VARIANT_KEYS[0])), *field.variants][0]

    def tables_of(self, state: Document) -> Document:
        """The tables of the file that the input of the form stands for."""
        return self._table_of(self.root, state)

    def _table_of(self, field: Field, state: Document) -> Document:
        fields = self.tables[self.variant(field, state).id]
        fields_by_key = {key: self.field(fields, key) for key, value in state.items() if value != ""}
        return {key: self._value(field, state[key]) for key, field in fields_by_key.items()}

    def _value(self, field: Field | None, value: object) -> object:
        if isinstance(value, Mapping):
            if field is None or field.control in ("named", "pairs"):
                return {name: self._item(field, item) for name, item in value.items()}
            return self._item(field, value)
        if isinstance(value, list):
            return [self._item(field, item) for item in value]
        return typed(value, ANY_TYPE if field is None else field.types) if isinstance(value, str) else value

    def _item(self, field: Field | None, value: object) -> object:
        """A table of a field, or an item of a list, whose texts stay as they are."""
        if field is None:
            return self._value(None, value)
        return self._table_of(field, value) if isinstance(value, Mapping) and field.variants else value

    def files_in(self, tables: Document, field: Field | None = None) -> Iterator[tuple[Place, object]]:
        """The places of all files that tables of the file name, and what they name."""
        field = field or self.root
        fields = self.tables[self.variant(field, tables).id]
        for key, value in tables.items():
            own_field = self.field(fields, key)
            for item_place, item in _places_of_items(value, (key,)):
                if own_field is not None and own_field.control in FILE_CONTROLS and not isinstance(item, Mapping):
                    yield item_place, item
                elif own_field is not None and own_field.variants and isinstance(item, Mapping):
                    yield from ((item_place + place, name) for place, name in self._files_of(own_field, item))

    def _files_of(self, field: Field, table: Document) -> Iterator[tuple[Place, object]]:
        """The same of a table, or of tables by name."""
        if field.control != "named":
            yield from self.files_in(table, field)
            return
        for name, value in table.items():
            if isinstance(value, Mapping):
                yield from (((name, *place), path) for place, path in self.files_in(value, field))

    @property
    def as_json(self) -> dict[str, object]:
        """The plan as the page takes it."""

        def plain(field: Field) -> dict[str, object]:
            values = field._asdict() | {"variants": [variant._asdict() for variant in field.variants]}
            return {key: value for key, value in values.items() if key != "types" and value not in ("", (), [], False)}

        tables = {id: [plain(field) for field in fields] for id, fields in self.tables.items()}
        return {"tables": tables, "root": plain(self.root)}


def _mechanisms_of(several: Part) -> Part:
    """The table of mechanisms by name, from that of a file with several."""
    parts = several.get("anyOf") or several["oneOf"]
    table: Part = parts[0]["properties"]["mechanisms"]
    return table


def _places_of_items(value: object, place: Place) -> list[tuple[Place, object]]:
    """A value with its place, or each item of a list with its own."""
    return [((*place, i), item) for i, item in enumerate(value)] if isinstance(value, list) else [(place, value)]


def _is_table(node: Part) -> bool:
    return node.get("type") == "object" or "properties" in node


def _types(node: Part) -> list[str]:
    if isinstance(node.get("const"), bool):
        return ["boolean"]
    types = node.get("type", "string" if "enum" in node else [])
    return [types] if isinstance(types, str) else list(types)


def _unit(node: Part) -> str:
    """The unit of a number as it is printed."""
    unit = str(node.get("unit", ""))
    return unit.replace("m3", "m\u00b3").replace("m2", "m\u00b2").replace("s2", "s\u00b2").replace(" ", "\u00b7")


def _text_without_range(text: str, node: Part) -> str:
    """A description without the range that the schema has too."""

    def repeats(match: re.Match[str]) -> bool:
        return float(match[1]) == node.get("minimum") and node.get("maximum", float(match[2])) == float(match[2])

    return RANGE_TEXT.sub(lambda match: (", " if match["and"] else "") if repeats(match) else match[0], text)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def typed(text: str, types: frozenset[str]) -> object:
    """The value that a text stands for in a field that takes some types; the text itself where it fits none.

    A number may have a comma as its decimal mark, unless it may be that of thousands, as in 1,000.
    """
    text = text.strip()
    if types & {"number", "integer"}:
        text = NUMBER_WITH_COMMA.sub(r"\1.\2", text)
        for number_type in (int, float):
            try:
                return number_type(text)
            except ValueError:
                continue
    if "boolean" in types and text in TRUTHS:
        return TRUTHS[text]
    if "array" in types and text.startswith("["):
        try:
            return tomllib.loads(f"value = {text}")["value"]
        except (tomllib.TOMLDecodeError, RecursionError):
            return text
    return text


def text_of(value: object) -> str:
    """A value of a file as a person would type it, with all its digits."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    if isinstance(value, list):
        return f"[{', '.join(json.dumps(item) if isinstance(item, str) else text_of(item) for item in value)}]"
    return str(value)


def state_of(tables: Document) -> Document:
    """The input of the form that stands for tables of a file: its values as texts."""

    def value_state(value: object) -> object:
        if isinstance(value, Mapping):
            return state_of(value)
        if isinstance(value, list) and value and all(isinstance(table, Mapping) for table in value):
            return [state_of(table) for table in value]
        return text_of(value)

    return {key: value_state(value) for key, value in tables.items()}


def texts_of(words: Words) -> dict[str, str]:
    """The texts that the page needs, by their names in its script."""
    form_texts = {key: text[words.language] for key, text in words.texts.items() if key.startswith("form_")}
    return {key.removeprefix("form_"): text for key, text in form_texts.items()}


def languages_named(words: Words) -> list[tuple[str, str]]:
    """The languages of the form, and what each is called."""
    return [(name, words(f"language_{name}")) for name in languages()]
