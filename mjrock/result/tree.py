"""Objects as trees of plain values, which JSON holds, and as arrays beside them; and back to the bit.

Nothing is pickled: a tree has the names of classes and the values of their fields. Reading takes only classes of
mjrock that hold values, and classes that the reader gives.
"""

from __future__ import annotations

import contextlib
import dataclasses
import enum
import importlib
import math
import re
from collections.abc import Callable, Collection, Iterable, Mapping
from copy import deepcopy
from functools import cached_property, partial
from itertools import takewhile
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..quantities import shown, spelt, warn_of

Tree = Any
"""None, a truth value, a number, a text, a list of trees or a dictionary of them by text."""
OWN_PACKAGE = __name__.partition(".")[0]
"""The name of this package."""
FOLDERS = ("problem", "scene", "geometry", "result", "theory", "distinct", "method", "contacts")
"""Where classes may stand that a file names. No example or command is imported."""
SINGLE = (bool, int, str, type(None))
BRACKETS = re.compile(r"\s\[([^\]:]+)\]")
"""A unit in a docstring."""
ARGUMENT = re.compile(r"^ +(?P<names>\w+(?:, \w+)*): (?P<text>.*)")
"""The first line of the description of arguments in a docstring."""
INLINE = 100
"""Most numbers of an array that stands in the tree itself."""


class UnreadableError(ValueError):
    """A tree that does not stand for an object."""


@dataclasses.dataclass(frozen=True)
class NotKept:
    """The substitute for a value that a file cannot hold, such as a function. It cannot be called.

    Args:
        what: the value in words.
    """

    what: str

    def __call__(self, *arguments: object) -> Any:
        """Refuse.

        Raises:
            ValueError: always, with what was lost.
        """
        raise ValueError(f"{self.what} was not kept in the file; build the case again to go on from it")


def is_named_tuple(kind: type) -> bool:
    """Whether a class is a NamedTuple."""
    return issubclass(kind, tuple) and hasattr(kind, "_fields")


def fields_of(kind: type) -> tuple[str, ...]:
    """Names of the fields of a dataclass or a NamedTuple."""
    if is_named_tuple(kind):
        return tuple(kind._fields)  # type: ignore[attr-defined]
    return tuple(entry.name for entry in dataclasses.fields(kind))


def name_of(kind: type) -> str:
    """The name by which a tree has a class: its public one, or with its module."""
    public = getattr(importlib.import_module(OWN_PACKAGE), kind.__qualname__, None)
    return kind.__qualname__ if public is kind else f"{kind.__module__}.{kind.__qualname__}"


def unit_and_text(kind: type, name: str) -> tuple[str, str]:
    """The unit of a field and what it is, from the docstring of its class; empty where that does not say."""
    lines = (kind.__doc__ or "").split("\n")
    for i, line in enumerate(lines):
        if (head := ARGUMENT.match(line)) and name in (names := head["names"].split(", ")):
            below = takewhile(partial(_is_below, line), lines[i + 1 :])
            text = " ".join([head["text"], *filter(None, map(str.strip, below))])
            unit = next(iter([*BRACKETS.findall(text), *BRACKETS.findall(" ".join(lines[:3]))]), "")
            units = unit.split(", ")
            return units[names.index(name)] if len(units) == len(names) else unit, text
    return "", ""


def _is_below(head: str, line: str) -> bool:
    """Whether a line is empty, or is indented further than another one."""
    return not line.strip() or len(line) - len(line.lstrip()) > len(head) - len(head.lstrip())


class Writer:
    """Makes trees of objects.

    Args:
        keep: takes the path of an array, the array, and the class and field that it is of, and returns the name by
            which the array is found again; None has all arrays in the tree.
        has_place: whether an array has such a name already.

    Attributes:
        lost: values that could not be kept, in words, by their paths.
    """

    def __init__(
        self,
        keep: Callable[[str, NDArray[np.generic], type, str], str] | None = None,
        has_place: Callable[[object], bool] = lambda array: False,
    ) -> None:
        self._keep, self._has_place, self.lost = keep, has_place, dict[str, str]()
        self._known: dict[int, str] = {}
        self._held: list[object] = []  # an identity is that of one object only while it lives

    def tree(self, value: object, path: str, owner: type = object, field: str = "") -> Tree:
        """The tree of a value at a path, such as "case.motion", which is a field of a class."""
        if isinstance(value, np.generic):
            return {"scalar": value.dtype.str, "value": self.tree(value.item(), path)}
        if isinstance(value, float):
            return value if math.isfinite(value) else {"number": repr(value)}
        if type(value) in SINGLE:
            return value
        if isinstance(value, enum.Enum):
            return {"class": name_of(type(value)), "member": value.name}
        if isinstance(value, dict | list | set | frozenset) or type(value) is tuple:
            return self._collected(value, path, owner, field)
        if isinstance(value, Mapping):
            return self._collected(dict(value), path, owner, field)
        if id(value) in self._known:
            return {"same": self._known[id(value)]}
        self._known[id(value)] = path
        self._held.append(value)
        if isinstance(value, np.ndarray) and not value.dtype.hasobject:
            return self._array_tree(value, path, owner, field)
        is_object = dataclasses.is_dataclass(value) and not isinstance(value, type)
        if is_object or is_named_tuple(type(value)):
            return self._object_tree(value, path)
        return self._record_loss(value, path)

    def _collected(self, value: Collection[object], path: str, owner: type, field: str) -> Tree:
        """The tree of a tuple, a list, a set or a dictionary."""
        if isinstance(value, dict):
            if all(type(name) is str for name in value):
                return {"mapping": {k: self.tree(item, f"{path}[{k!r}]", owner, field) for k, item in value.items()}}
            pairs = enumerate(value.items())
            return {"pairs": [[self.tree(part, f"{path}.{i}.{j}") for j, part in enumerate(pair)] for i, pair in pairs]}
        ordered = sorted(value, key=repr) if isinstance(value, set | frozenset) else value
        items = [self.tree(item, f"{path}.{i}", owner, field) for i, item in enumerate(ordered)]
        return items if isinstance(value, tuple) else {type(value).__name__: items}

    def _array_tree(self, value: NDArray[np.generic], path: str, owner: type, field: str) -> Tree:
        """The tree of an array: its numbers, or its name among those that are kept beside the tree."""
        layout: dict[str, Tree] = {"rows": True} if value.dtype.type is np.record else {}
        layout |= {"fixed": True} if not value.flags.writeable else {}
        layout |= {"order": "F"} if value.flags.fnc else {}
        plain = value.dtype.names is None and value.size <= INLINE and not self._has_place(value)
        if self._keep is None or plain or value.dtype.kind == "U":
            numbers = [self.tree(number, path) for number in value.ravel().tolist()]
            return {"values": numbers, "shape": list(value.shape), "type": value.dtype.str} | layout
        return {"array": self._keep(path, value, owner, field), **layout}

    def _object_tree(self, value: object, path: str) -> Tree:
        """The tree of an object by its fields. One that may have functions has a method that puts values there."""
        kind, plain = type(value), getattr(value, "without_functions", None)
        stored = value if plain is None else plain()
        parts = {name: self.tree(getattr(stored, name), f"{path}.{name}", kind, name) for name in fields_of(kind)}
        if not is_named_tuple(kind):
            members = (pair for base in kind.__mro__ for pair in vars(base).items())
            cached = {name for name, member in members if isinstance(member, cached_property)}
            for name in sorted(vars(value).keys() - parts.keys() - cached):
                self._record_loss(getattr(value, name), f"{path}.{name}")
        formula = {"formula": text} if (text := getattr(kind, "formula", "")) else {}  # of a law of the user
        return {"class": name_of(kind)} | formula | parts

    def _record_loss(self, value: object, path: str) -> Tree:
        description = f"{type(value).__name__} {getattr(value, '__qualname__', '') or spelt(value)[:60]}"
        self.lost[path] = description
        return {"class": name_of(NotKept), "what": description}


class Reader:
    """Makes objects of trees.

    Args:
        arrays: the arrays by their names.
        laws: classes from outside mjrock that may be made, such as laws of joints of a user.
    """

    def __init__(self, arrays: Mapping[str, Any], laws: Iterable[type] = ()) -> None:
        self._arrays, self._own = arrays, {kind.__name__: kind for kind in laws}
        self._known: dict[str, object] = {}

    def value(self, tree: Tree, path: str) -> Any:
        """The value of a tree at a path.

        Raises:
            UnreadableError: where it stands for none.
        """
        if isinstance(tree, float) or type(tree) in SINGLE:
            return tree
        if isinstance(tree, list):
            return tuple(self.value(item, f"{path}.{i}") for i, item in enumerate(tree))
        if not isinstance(tree, dict):
            raise UnreadableError(f"{path} is {shown(tree)}")
        if "class" in tree:
            return self._object(tree, path)
        for key, read in self._readers.items():
            if key in tree:
                return read(tree, path)
        raise UnreadableError(f"{path} is of no kind that is known: {', '.join(tree)}")

    @property
    def _readers(self) -> dict[str, Callable[[dict[str, Tree], str], Any]]:
        def items(tree: dict[str, Tree], path: str) -> Any:
            return self.value(next(iter(tree.values())), path)

        return {
            "array": self._array,
            "values": self._array,
            "same": lambda tree, path: self._shared_value(tree["same"], path),
            "number": lambda tree, path: float(tree["number"]),
            "scalar": lambda tree, path: np.dtype(tree["scalar"]).type(self.value(tree["value"], path)),
            "mapping": lambda tree, path: {k: self.value(v, f"{path}[{k!r}]") for k, v in tree["mapping"].items()},
            "pairs": lambda tree, path: dict(self.value(tree["pairs"], path)),
            "list": lambda tree, path: list(items(tree, path)),
            "set": lambda tree, path: set(items(tree, path)),
            "frozenset": lambda tree, path: frozenset(items(tree, path)),
        }

    def _shared_value(self, known: str, path: str) -> Any:
        if known not in self._known:
            raise UnreadableError(f"{path} is the same as {known}, which is not there")
        return self._known[known]

    def _array(self, tree: dict[str, Tree], path: str) -> NDArray[np.generic]:
        if "values" in tree:
            values = np.array(self.value(tree["values"], path), dtype=tree["type"]).reshape(tree["shape"])
        elif tree["array"] not in self._arrays:
            raise UnreadableError(f"{path} is the array {tree['array']}, which is not there")
        else:
            values = np.asarray(self._arrays[tree["array"]])
        values = np.asarray(values, order=tree.get("order", "C"))
        if tree.get("rows"):
            values = values.view(np.dtype((np.record, values.dtype)))
        values.setflags(write=not tree.get("fixed", False))
        self._known[path] = values
        return values

    def _object(self, tree: dict[str, Tree], path: str) -> Any:
        """An object of a class, by its fields. Those that the file lacks have their defaults."""
        kind = self._class(tree["class"], path)
        if issubclass(kind, enum.Enum):
            if tree.get("member") not in kind.__members__:
                raise UnreadableError(f"{path} is {tree.get('member')!r}, which {tree['class']} does not know")
            return kind[tree["member"]]
        names, known = tree.keys() - {"class", "formula"}, fields_of(kind)
        if tree.get("formula", "") != getattr(kind, "formula", tree.get("formula", "")):
            warn_of(
                f"{path} is of the class {tree['class']}, whose methods have changed since the file was written, or "
                "are compiled by another Python: a run that goes on from it may be another"
            )
        defaults = _defaults_of(kind)
        unlike = [*sorted(names - set(known)), *(name for name in known if name not in names and name not in defaults)]
        if unlike:
            message = f"{path} is of the class {tree['class']}, which has other fields in this version of mjrock"
            raise UnreadableError(f"{message}: {', '.join(unlike)}")
        at = f"{path}." if path else ""
        values = {name: self.value(tree[name], at + name) if name in names else defaults[name]() for name in known}
        if is_named_tuple(kind):
            instance = kind(**values)
        else:
            instance = object.__new__(kind)
            for name, value in values.items():
                object.__setattr__(instance, name, value)
        self._known[path] = instance
        return instance

    def _class(self, name: str, path: str) -> type:
        """The class of a name.

        Raises:
            UnreadableError: for one that is not known, or holds no values.
        """
        module, _, class_name = name.rpartition(".")
        package, _, below = module.partition(".")
        kind: Any = None
        if not module:
            public = importlib.import_module(OWN_PACKAGE)
            kind = getattr(public, class_name, None) if class_name in public.__all__ else None
        elif package != OWN_PACKAGE:
            if class_name not in self._own:
                raise UnreadableError(f"{path} is of the class {name} of a user; give it as laws=[{class_name}]")
            kind = self._own[class_name]
        elif below.split(".")[0] in FOLDERS:
            with contextlib.suppress(ImportError):
                kind = getattr(importlib.import_module(module), class_name, None)
        if not isinstance(kind, type) or not (
            dataclasses.is_dataclass(kind) or is_named_tuple(kind) or issubclass(kind, enum.Enum)
        ):
            raise UnreadableError(f"{path} is of the class {name}, which this version of mjrock does not have")
        return kind


def _defaults_of(kind: type) -> dict[str, Callable[[], Any]]:
    """Functions that give the default of each field of a class that has one."""
    if is_named_tuple(kind):
        return {name: partial(deepcopy, default) for name, default in kind._field_defaults.items()}  # type: ignore[attr-defined]
    defaults: dict[str, Callable[[], Any]] = {}
    for entry in dataclasses.fields(kind):
        if entry.default_factory is not dataclasses.MISSING:
            defaults[entry.name] = entry.default_factory
        elif entry.default is not dataclasses.MISSING:
            defaults[entry.name] = partial(deepcopy, entry.default)
    return defaults
