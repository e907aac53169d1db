"""Tables of a file as the objects that they describe."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar, get_args, get_origin

import numpy as np

from ..problem.wall.block import Block
from ..problem.wall.effect import CombinedEffect
from ..quantities import Message, Within, brief, named, reason, shown
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
from .tables import AssessmentError, Fault, Place, Table, line_of, spelt_place
from .units import UnitError, examples_of, value_in

Object = TypeVar("Object")
NUMERIC = (float, int, np.ndarray)
OWN_KEYS = "kind", "make"
"""Keys that name the class, and the constructor of the class, that a table stands for."""
FIRST_WORD = re.compile(r"(\w+)(?:\[(\d+)\])?")
"""The first word of a message, which is most often the name of an argument."""


class RefusedError(Exception):
    """Raised where a value is refused. The reader has its message already."""


class Reader:
    """What makes objects of tables, and collects what is wrong with them.

    Args:
        folder: what paths of other files are relative to; None where there is no file, and no path is read.
        confined: whether a path that leads out of that folder is refused.
        text: of the file, for the lines of messages; empty where there is none.
        name: of the file, for messages.

    Attributes:
        faults: what is wrong.
        language: of the file.
    """

    def __init__(self, folder: Path | None, text: str, name: str, *, confined: bool = False) -> None:
        self.folder, self.text, self.name, self.confined = folder, text, name, confined
        self.faults: list[Fault] = []
        self.language = "en"

    def refuse(self, place: Place, message: str) -> None:
        """Keep what is wrong with a key or table."""
        self.faults.append(Fault(place, message, line_of(place, self.text)))

    def refusal(self, place: Place, template: str, **values: object) -> RefusedError:
        """Keep what is wrong with a key or table, as the template of a message about its `place`, and return the error
        to raise."""
        self.refuse(place, Message(template, place=spelt_place(place), **values))
        return RefusedError()

    def require_sound(self) -> None:
        """Raise an AssessmentError with all that is wrong, in the order of the file."""
        if self.faults:
            faults = dict.fromkeys(sorted(self.faults, key=lambda fault: fault.line or 0))
            raise AssessmentError(tuple(faults), self.name, self.language)

    def make(self, table: Table, maker: Maker, given: Mapping[str, object] | None = None) -> Any:
        """What a table stands for.

        Args:
            table: the table.
            maker: what it stands for.
            given: arguments that do not come from the table.

        Raises:
            RefusedError: where something is wrong with it.
        """
        arguments = self.arguments(table, maker, given)
        try:
            return maker.call(**arguments)
        except (TypeError, ValueError, OSError, ImportError) as error:
            self.refuse(*self._cause(error, table, maker))
            raise RefusedError from None

    def arguments(self, table: Table, maker: Maker, given: Mapping[str, object] | None = None) -> dict[str, object]:
        """The arguments that a table has, and those that are given."""
        before, arguments = len(self.faults), dict(given or {})
        keys = {key_named(key): key for name, key in maker.keys.items() if name not in arguments}
        for name, value in table.values.items():
            if name not in keys:
                self.refuse(table.place_of(name), self._unknown(table.place_of(name), name, list(keys)))
                continue
            try:
                arguments[keys[name].name] = self.value(keys[name], value, table.place_of(name))
            except RefusedError:
                continue
        for key in maker.missing({*arguments, *(keys[name].name for name in keys.keys() & table.values.keys())}):
            values = {"name": key_named(key), "due": spelt_kinds(key.kinds, key.within)}
            message = Message("{place} has no {name}; it takes {due}", place=spelt_place(table.place), **values)
            self.refuse(table.place, message)
        if len(self.faults) > before:
            raise RefusedError
        return arguments | self._expanded(table, arguments)

    def _expanded(self, table: Table, arguments: dict[str, object]) -> dict[str, object]:
        """Sequences among arguments with the effects of what acts as several, such as a `Wedge`."""
        wall = next((value for value in arguments.values() if isinstance(value, Block)), None)
        expanded: dict[str, object] = {}
        for name, values in arguments.items():
            if isinstance(values, tuple) and any(isinstance(value, CombinedEffect) for value in values):
                parts = [self._effects_of(*pair, wall) for pair in zip(table.values[name], values, strict=True)]
                expanded[name] = tuple(effect for part in parts for effect in part)
        return expanded

    def _effects_of(self, table: Table, effect: object, wall: Block | None) -> tuple[object, ...]:
        """An effect, or those that one of several stands for."""
        if not isinstance(effect, CombinedEffect):
            return (effect,)
        try:
            if wall is None:
                raise ValueError(Message("acts on a wall, and there is none"))
            return effect.on(wall)
        except (TypeError, ValueError) as error:
            place = _named_in(str(error), table, {})
            self.refuse(place, caused(place, error))
            raise RefusedError from None

    def attempt(self, call: Callable[[], Object]) -> Object | None:
        """What a function returns; None where it finds something wrong."""
        try:
            return call()
        except RefusedError:
            return None

    def required_table(self, table: Table, name: str) -> Table:
        """A table in another."""
        value = table.values.get(name)
        if not isinstance(value, Table):
            it_takes = "{place} is {value}; it takes a table, [{place}]"
            raise self.refusal(table.place_of(name), it_takes, value=spelt_value(value))
        return value

    def choose_maker(self, table: Table, kinds: Mapping[str, Makers], usual: str | None = None) -> tuple[Maker, Table]:
        """The maker that `kind` and `make` of a table name, and the table without these."""
        kind = self.known_name(table, "kind", list(kinds), next(iter(kinds)) if len(kinds) == 1 else usual)
        makers = kinds[kind]
        make = self.known_name(table, "make", [name or kind for name in makers], USUAL_MAKE.get(kind, kind))
        return makers["" if make == kind else make], table.without(*OWN_KEYS)

    def known_name(self, table: Table, name: str, known: Sequence[str], usual: str | None) -> str:
        """A name that a key of a table has among those that are known."""
        value = table.values.get(name, usual)
        if value is None:
            raise self.refusal(table.place, "{place} has no {name}; {remedy}", name=name, remedy=one_of(known))
        if not isinstance(value, str) or value not in known:
            close_names = difflib.get_close_matches(str(value), known, 1)
            remedy = Message("did you mean {near!r}?", near=close_names[0]) if close_names else one_of(known)
            values = {"value": shown(value), "remedy": remedy}
            raise self.refusal(table.place_of(name), "{place} = {value} is not known; {remedy}", **values)
        return value

    def value(self, key: Key, value: object, place: Place) -> object:
        """The value of a key, checked by its declaration.

        Raises:
            RefusedError: where something is wrong with it.
        """
        return self._of_kinds(key.kinds, key.within, value, place)

    def _of_kinds(self, kinds: tuple[Hint, ...], within: Within | None, value: object, place: Place) -> object:
        """A value of one of some types, of a number within a range."""
        if isinstance(value, Table):
            return self._table(kinds, value)
        if isinstance(value, list):
            return self._row(kinds, within, value, place)
        if isinstance(value, str) and (str in kinds or any(map(choices_of, kinds))):
            return self._text(kinds, value, place)
        numeric = any(kind in NUMERIC or get_origin(kind) in NUMERIC for kind in kinds)
        if isinstance(value, bool) and bool in kinds:
            return value
        if numeric and isinstance(value, str | int | float):
            return self._number(kinds, within, value, place)
        raise self._wrong_type(place, value, kinds, within)

    def _text(self, kinds: tuple[Hint, ...], value: str, place: Place) -> object:
        """A text, one of several, or a path from the folder of the file."""
        known = [choice for kind in kinds for choice in choices_of(kind)]
        if known and value not in known:
            values = {"name": spelt_place(place), "value": brief(value), "known": ", ".join(known)}
            raise self.refusal(place, "{name} = {value} is not one of {known}", **values)
        if not is_path(kinds):
            return value
        if self.folder is None:
            message = "{place} = {value} is the path of a file, and these tables are in none"
            raise self.refusal(place, message, value=brief(value))
        path = self.folder / value
        if self.confined and not path.resolve().is_relative_to(self.folder.resolve()):
            raise self.refusal(place, "{place} = {value} leads out of the folder of the files", value=brief(value))
        return path

    def _number(self, kinds: tuple[Hint, ...], within: Within | None, value: str | float, place: Place) -> object:
        """A number, or a text with a unit."""
        name = spelt_place(place)
        try:
            number = value
            if isinstance(value, str):
                name = f"{name} = {brief(value)}"
                number = value_in(value, within.unit if within else "")
            if within is not None:
                return within.checked(name, number)
            if isinstance(number, bool):
                raise TypeError(Message("{name} = {value} is not a real number", name=name, value=shown(number)))
            return int(number) if int in kinds and float not in kinds and number == int(number) else float(number)
        except UnitError as error:
            due = Message("; the valid range is {range}", range=spelt_range(within)) if within else ""
            self.refuse(place, Message("{name} {cause}{due}", name=name, cause=reason(error), due=due))
        except (TypeError, ValueError, OverflowError) as error:
            self.refuse(place, reason(error))
        raise RefusedError

    def _row(self, kinds: tuple[Hint, ...], within: Within | None, value: list[object], place: Place) -> object:
        """A list, each item of the type that the argument has there."""
        rows = [items for kind in kinds if (items := items_of(kind)) is not None]
        if not rows:
            if any(kind is np.ndarray or get_origin(kind) is np.ndarray for kind in kinds):
                return [self._of_kinds((float, np.ndarray), within, item, (*place, i)) for i, item in enumerate(value)]
            raise self._wrong_type(place, value, kinds, within)
        fitting = [items for items in rows if items[-1] is ... or len(items) == len(value)]
        if not fitting:
            raise self.refusal(place, "{place} has {count} values; it takes {due}", count=len(value), due=len(rows[0]))
        items_read, has_fault = [], False
        for i, item_value in enumerate(value):
            item = fitting[0][0 if fitting[0][-1] is ... else i]
            item_place = item_value.place if isinstance(item_value, Table) else (*place, i)
            try:
                items_read.append(self._of_kinds(*kinds_and_range(item, within), item_value, item_place))
            except RefusedError:
                has_fault = True
        if has_fault:
            raise RefusedError
        return tuple(items_read)

    def _table(self, kinds: tuple[Hint, ...], table: Table) -> object:
        """What a table within another stands for: an object of one of some classes, or texts by name."""
        classes = classes_of(kinds)
        if classes:
            maker, content = self.choose_maker(table, {name: makers_of(kind) for name, kind in classes.items()})
            return self.make(content, maker)
        mapped = next((kind for kind in kinds if get_origin(kind) is not None and is_mapping(kind)), None)
        if mapped is not None:
            item_kinds, within = kinds_and_range(get_args(mapped)[1], None)
            items = table.values.items()
            return {name: self._of_kinds(item_kinds, within, item, table.place_of(name)) for name, item in items}
        raise self._wrong_type(table.place, table, kinds, None)

    def _wrong_type(self, place: Place, value: object, kinds: tuple[Hint, ...], within: Within | None) -> RefusedError:
        """Keep that a value is of another type."""
        values = {"value": spelt_value(value), "due": spelt_kinds(kinds, within)}
        return self.refusal(place, "{place} is {value}; it takes {due}", **values)

    def _unknown(self, place: Place, name: str, known: Sequence[str]) -> Message:
        """The message about a key that a table does not take."""
        close_names = difflib.get_close_matches(name, known, 2)
        valid_names = Message("the valid ones are {known}", known=", ".join(known) or "none")
        remedy = Message("did you mean {near}?", near=alternatively(close_names)) if close_names else valid_names
        return Message("{place} is not known; {remedy}", place=spelt_place(place), remedy=remedy)

    def _cause(self, error: Exception, table: Table, maker: Maker) -> tuple[Place, str]:
        """The key that an error of a class or function is about, and its message."""
        text, names = str(error), {name: key_named(key) for name, key in maker.keys.items()}
        place = _named_in(text, table, names)
        key = next((known for known in maker.keys.values() if table.place_of(key_named(known)) == place), None)
        within = None if key is None else key.within
        return place, caused(place, error, table.values.get(str(place[-1])) if key else None, within)


def caused(place: Place, error: Exception, value: object = None, within: Within | None = None) -> Message:
    """The message of an error at a place. In another language one that has no text there stays English, behind what is
    known of the place.

    Args:
        place: of the key or table.
        error: of a class or function.
        value: of the key, where it is one.
        within: its declared range.
    """
    known = f" = {brief(value)}" if isinstance(value, str | int | float) else ""
    range_text = Message("; the valid range is {range}", range=spelt_range(within)) if within else ""
    known = Message("{value}{of}", value=known, of=range_text)
    return Message("{place}: {cause}", place=spelt_place(place), cause=reason(error), known=known)


def _named_in(message: str, table: Table, names: Mapping[str, str]) -> Place:
    """The key of a table that a message names, the table itself where it names none.

    Args:
        message: most often of the form "effects[0], height of the Tie = ...".
        table: the table.
        names: keys of arguments that have another name.
    """
    place = table.place
    for word, index in FIRST_WORD.findall(message):
        name = names.get(word, word)
        if name not in table.values:
            continue
        place, value = table.place_of(name), table.values[name]
        if index and isinstance(value, list) and int(index) < len(value):
            value = value[int(index)]
            place = value.place if isinstance(value, Table) else (*place, int(index))
        if not isinstance(value, Table):
            break
        table, names = value, {}
    return place


def kinds_and_range(hint: Hint, within: Within | None) -> tuple[tuple[Hint, ...], Within | None]:
    """The types of a hint, and the range of its numbers."""
    key = Key("", hint, None, "")
    return key.kinds, key.within or within


def is_mapping(kind: Hint) -> bool:
    """Whether an argument of a type is a table of values by free names."""
    origin = get_origin(kind)
    return isinstance(origin, type) and issubclass(origin, Mapping)


def spelt_value(value: object) -> str:
    """What a key has, in words."""
    if isinstance(value, Table | list):
        return Message("a table") if isinstance(value, Table) else Message("a list")
    return shown(value)


def spelt_range(within: Within) -> Message:
    """A range in words."""
    unit = f" {within.unit}" if within.unit else ""
    return Message("{low:g} to {high:g}{unit}", low=within.low, high=within.high, unit=unit)


def alternatively(parts: Sequence[str]) -> str:
    """One or the other of some words, each once."""
    first, *others = dict.fromkeys(parts)
    return Message("{first} or {others}", first=first, others=alternatively(others)) if others else first


def one_of(known: Sequence[str]) -> Message:
    """What says that a value is one of several."""
    return Message("it is one of {known}", known=", ".join(known))


def spelt_kinds(kinds: tuple[Hint, ...], within: Within | None) -> str:
    """What an argument of some types takes, in words."""
    texts: list[str] = []
    if any(kind in NUMERIC or get_origin(kind) in NUMERIC for kind in kinds):
        range_text = Message(" of {range}", range=spelt_range(within)) if within and math.isfinite(within.high) else ""
        example = examples_of(within.unit) if within and within.unit else ""
        unit = Message(", or a text such as {example}", example=example) if example else ""
        texts.append(Message("a number{of}{unit}", of=range_text, unit=unit))
    texts += [Message("true or false")] if bool in kinds else []
    if known := [choice for kind in kinds for choice in choices_of(kind)]:
        texts.append(Message("one of {known}", known=", ".join(known)))
    elif str in kinds:
        texts.append(Message("a text"))
    if classes := classes_of(kinds):
        texts.append(Message("a table of {names}", names=named(list(classes))))
    for kind in kinds:
        if (items := items_of(kind)) is not None:
            item_text = spelt_kinds(kinds_and_range(items[0], within)[0], None)
            several = Message("a list of {count}, each {of}", count=len(items), of=item_text)
            texts.append(Message("a list, each {of}", of=item_text) if items[-1] is ... else several)
        elif is_mapping(kind):
            texts.append(Message("a table of texts"))
    return alternatively(texts or [Message("nothing that a file can have")])
