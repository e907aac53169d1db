"""The keys of a table: the arguments of its public object, with the ranges that the signature declares."""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import MISSING, dataclass, is_dataclass
from functools import cache
from os import PathLike
from types import UnionType
from typing import Any, Literal, Self, TypeAlias, Union, Unpack, get_args, get_origin, get_type_hints, is_typeddict

import numpy as np

from ..problem.wall.block import Block
from ..problem.wall.effect import CombinedEffect, Effect
from ..problem.wall.own_link import Link
from ..quantities import OneOf, Within, alternatives

Hint: TypeAlias = object
"""The type of an argument as it is annotated: a class, a union, or one with what is declared of it."""
REQUIRED = MISSING
"""The default of an argument that has none."""
USUAL_MAKE = {"Block": "from_size", "Restitution": "from_geometry", "Contacts": "from_law"}
"""The constructor of a class where a table names none, by the name of the class; of others it is the class itself."""
ARGUMENT_ENTRY = re.compile(r"^ {4}((?:\w+, )*\w+): ")
SHARED_DOC = re.compile(r"(?:as|those) of `(\w+)`")


@dataclass(frozen=True)
class Key:
    """One key of a table.

    Args:
        name: of the argument.
        hint: its type, as it is annotated.
        default: what it is where it is left out, or REQUIRED.
        doc: what the docstring says of it.
    """

    name: str
    hint: Hint
    default: Any
    doc: str

    @property
    def within(self) -> Within | None:
        """Its declared range; None where there is none. What may be of several types has that of the first with one."""
        hints = (self.hint, *(get_args(self.hint) if get_origin(self.hint) in (Union, UnionType) else ()))
        notes = (note for hint in hints for note in getattr(hint, "__metadata__", ()))
        return next((note for note in notes if isinstance(note, Within)), None)

    @property
    def kinds(self) -> tuple[Hint, ...]:
        """The types that it may be of, one by one, without None."""
        return kinds_of(self.hint)

    @property
    def is_needed(self) -> bool:
        """Whether there is no value for it where it is left out."""
        optional = {type(None), Any} & set(alternatives(self.hint))
        return self.default is REQUIRED or (self.default is None and not optional)


@dataclass(frozen=True)
class Maker:
    """What a table stands for: a class, one of its further constructors, or a function.

    Args:
        call: the class, constructor or function, which takes the keys as arguments.
        keys: of the table, by name.
        doc: the first line of its docstring.
    """

    call: Callable[..., Any]
    keys: Mapping[str, Key]
    doc: str

    def missing(self, known: Collection[str]) -> list[Key]:
        """Keys that are needed beside those that are given. A point of masonry, `at`, stands for a height."""
        return [
            key
            for name, key in self.keys.items()
            if key.is_needed and name not in known and not (name == "height" and "at" in known)
        ]

    def without(self, *names: str) -> Maker:
        """The same without some keys, which are given otherwise."""
        return Maker(self.call, {name: key for name, key in self.keys.items() if name not in names}, self.doc)


Makers = Mapping[str, Maker]
"""All that makes an object of a class, by the name that `make` has in the file; "" is the class itself."""


def kinds_of(hint: Hint) -> tuple[Hint, ...]:
    """The types that a value of a hint may be of, one by one, without None and without functions. What may be an array
    may be a number too."""
    kinds = alternatives(hint)
    if complex in kinds:  # ArrayLike, which has much that a file has not
        return (float, np.ndarray, *(kind for kind in kinds if isinstance(kind, type) and is_dataclass(kind)))
    if known := [note for note in getattr(hint, "__metadata__", ()) if isinstance(note, OneOf)]:
        kinds = tuple(Literal[known[0].texts] if kind is str else kind for kind in kinds)
    return tuple(kind for kind in kinds if kind is not type(None) and get_origin(kind) is not Callable)


def is_path(kinds: Sequence[Hint]) -> bool:
    """Whether an argument of these types is the path of a file."""
    return any((get_origin(kind) or kind) is PathLike for kind in kinds)


def items_of(kind: Hint) -> tuple[Hint, ...] | None:
    """The types of the items of a sequence: one for each place of a tuple, or one and an ellipsis; None of others."""
    origin, arguments = get_origin(kind), get_args(kind)
    if origin is tuple:
        return arguments
    if isinstance(origin, type) and issubclass(origin, Sequence):
        return *arguments, ...
    return None


def choices_of(kind: Hint) -> tuple[str, ...]:
    """The texts that a literal type may be."""
    return tuple(map(str, get_args(kind))) if get_origin(kind) is Literal else ()


@cache
def described(call: Callable[..., object]) -> dict[str, str]:
    """What the docstring of a class or function says of each of its arguments."""
    docs: dict[str, str] = {}
    names: list[str] = []
    for line in _section(inspect.getdoc(call) or "", "Args").splitlines():
        if entry := ARGUMENT_ENTRY.match(line):
            names = entry[1].split(", ")
            docs |= {name: line[entry.end() :] for name in names}
        else:
            docs |= {name: f"{docs[name]} {line.strip()}".strip() for name in names}
    return docs


def _section(text: str, head: str) -> str:
    """A section of a docstring."""
    match = re.search(rf"^{head}:\n((?:    .*\n?|\n)+)", text, re.MULTILINE)
    return match[1] if match else ""


@cache
def maker_of(call: Callable[..., object], owner: type | None = None) -> Maker:
    """The keys of a class, of a constructor of a class `owner`, or of a function."""
    parameters = inspect.signature(call).parameters.values()
    hints = hints_of(call)
    keys: dict[str, Key] = {}
    docs = described(call)
    of_owner = {} if owner is None or call is owner else maker_of(owner).keys
    for parameter in parameters:
        if parameter.kind is parameter.VAR_KEYWORD:
            keys |= {
                name: key for name, key in _options(hints.get(parameter.name), of_owner).items() if name not in keys
            }
        elif parameter.kind is not parameter.VAR_POSITIONAL:
            default = REQUIRED if parameter.default is parameter.empty else parameter.default
            doc = docs.get(parameter.name, "")
            if owner is not None and ((shared := SHARED_DOC.search(doc)) or not doc):
                doc = _doc_as_of(owner, shared[1] if shared else "", parameter.name) or doc
            key = Key(parameter.name, hints.get(parameter.name, Any), default, doc)
            keys |= {parameter.name: key} if key.kinds or default is REQUIRED else {}
    return Maker(call, keys, (inspect.getdoc(call) or "").partition("\n\n")[0].replace("\n", " "))


def hints_of(call: Callable[..., object]) -> dict[str, Hint]:
    """The types of the arguments of a class or function, with what is declared of them."""
    hints = _evaluated_hints(call)
    constructor = vars(call).get("__init__") if isinstance(call, type) else None
    if inspect.isfunction(constructor) and constructor.__code__.co_filename != "<string>":  # not made by `dataclass`
        hints |= _evaluated_hints(constructor)
    return hints


def _evaluated_hints(call: Callable[..., object]) -> dict[str, Hint]:
    """Annotations as types; a name that type checkers alone import stands for any type."""
    unknown: dict[str, Hint] = {}
    while True:
        try:
            return get_type_hints(call, localns=unknown or None, include_extras=True)
        except NameError as error:
            unknown[str(error.name)] = Any


def _doc_as_of(owner: type, name: str, argument: str) -> str:
    """What another constructor of a class, or the class itself, says of an argument."""
    described_call = getattr(owner, name, owner) if name else owner
    return described(getattr(described_call, "__func__", described_call)).get(argument, "")


def _options(hint: Hint, of_owner: Mapping[str, Key]) -> dict[str, Key]:
    """The keys that a constructor hands on: those of a typed dictionary, as the class declares them."""
    named = get_args(hint)[0] if get_origin(hint) is Unpack else None
    if not is_typeddict(named):
        return {}
    hints = get_type_hints(named, include_extras=True)
    return {name: of_owner.get(name, Key(name, option_hint, None, "")) for name, option_hint in hints.items()}


@cache
def makers_of(kind: type) -> Makers:
    """All that makes an object of a class."""
    makers = {"": maker_of(kind, kind)}
    for name, member in inspect.getmembers(kind, inspect.ismethod):
        if not name.startswith("_") and name in _constructors(kind):
            makers[name] = maker_of(member, kind)
    return makers


def _constructors(kind: type) -> set[str]:
    """Names of the class methods that return an object of the class."""
    names = set()
    for base in kind.__mro__:
        for name, member in vars(base).items():
            if isinstance(member, classmethod) and not name.startswith("_"):
                returned = get_type_hints(member.__func__).get("return")
                if returned is Self or (isinstance(returned, type) and issubclass(kind, returned)):
                    names.add(name)
    return names


def subclasses_of(kind: type[object]) -> list[type[object]]:
    """A class and all that are derived from it, those of a user too, in the order in which they were defined."""
    return [kind, *(subclass for sub in type.__subclasses__(kind) for subclass in subclasses_of(sub))]


@cache
def public_names() -> Collection[str]:
    """The public names of the package. Modules of the wall are imported, so that its classes are known."""
    package = importlib.import_module(__package__.partition(".")[0])
    for module in {module_name for module_name in package.HOME.values() if module_name.startswith("problem.wall.")}:
        importlib.import_module(f"{package.__name__}.{module}")
    return tuple(package.HOME)


def is_public(kind: type) -> bool:
    """Whether a class is one of the package that users know, or one of their own."""
    of_user = kind.__module__.partition(".")[0] != __package__.partition(".")[0]
    return of_user or kind.__name__ in public_names()


def classes_of(kinds: Sequence[Hint]) -> dict[str, type]:
    """The public dataclasses that values of some types may be of, by name, with those derived from them. No file
    can say the law of a `Link`."""
    public_names()
    bases = [kind for kind in kinds if isinstance(kind, type)]
    bases += [CombinedEffect] if Effect in bases else []
    classes = (subclass for base in bases for subclass in subclasses_of(base))
    return {cls.__name__: cls for cls in classes if is_dataclass(cls) and is_public(cls) and cls is not Link}


def key_named(key: Key) -> str:
    """The name of a key in the file: an argument that is a wall is the table `wall`, whatever it is called."""
    return "wall" if key.kinds == (Block,) else key.name
