"""A class method of `Masonry` that builds it: the arguments of a builder of blocks, or of a reader of files, and after
them the keywords of masonry."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from typing import Any, Self, Unpack, get_type_hints

from .files.bodies import FileOptions
from .laws.joint_table import ByWord, Halved, JointOptions, one_by_one, with_known_keywords

SECTION = re.compile(r"^(Args|Raises|Warns|Examples):\n", re.MULTILINE)
"""Heading of a section of a docstring."""


def joint_options(**options: Unpack[JointOptions]) -> None:
    """The keywords of masonry.

    Args:
        options: further arguments of `Masonry`.

    Raises:
        ValueError: as `Masonry` does.
    """


def of_builder(name: str, builder: Callable[..., Any]) -> classmethod[Any, Any, Any]:
    """The class method that makes masonry of the blocks that a builder returns."""
    friction: Mapping[str, float] = getattr(builder, "friction", {})

    def make(cls: type[Any], arguments: dict[str, Any], options: JointOptions) -> Any:
        blocks, halves = builder(**arguments), arguments.get("halves")
        if not friction and halves is None:
            return cls(blocks, **options)
        joints = one_by_one(options)
        if friction:
            joints["friction"] = ByWord(tuple(friction.items()), joints["friction"])
        if halves is not None:
            joints["bond"] = Halved(joints["bond"], halves)
        return cls(blocks, **joints)

    return _class_method(name, make, builder)


def of_reader(name: str, read: Callable[..., object]) -> classmethod[Any, Any, Any]:
    """The class method that makes masonry of the meshes that a reader finds in a file."""
    (source,) = inspect.signature(read).parameters

    def make(cls: type[Any], arguments: dict[str, Any], options: JointOptions) -> Any:
        meshes = arguments.pop(source)
        return cls._of_meshes(read, meshes, FileOptions(**arguments), options)

    return _class_method(name, make, read, FileOptions)


def _class_method(
    name: str, make: Callable[..., object], *functions: Callable[..., object]
) -> classmethod[Any, Any, Any]:
    """A class method with the arguments of some functions and the keywords of masonry, as `make` takes them."""
    functions = (*functions, joint_options)
    parameters = [inspect.Parameter("cls", inspect.Parameter.POSITIONAL_OR_KEYWORD)]
    parameters += [parameter for function in functions for parameter in inspect.signature(function).parameters.values()]
    signature = inspect.Signature(parameters, return_annotation="Self")

    def construct(*arguments: object, **options: object) -> object:
        try:
            bound = signature.bind(*arguments, **options).arguments
        except TypeError as error:
            raise TypeError(f"Masonry.{name}: {error}") from None
        return make(bound.pop("cls"), bound, bound.pop("options", {}))

    construct.__name__, construct.__qualname__, construct.__doc__ = name, f"Masonry.{name}", joined_doc(*functions)
    construct.__module__ = functions[0].__module__
    hints = (get_type_hints(function, include_extras=True) for function in functions)
    construct.__annotations__ = {key: hint for part in hints for key, hint in part.items()} | {"return": Self}
    construct.__signature__ = signature  # type: ignore[attr-defined]
    return classmethod(with_known_keywords(construct, f"Masonry.{name}"))


def joined_doc(*functions: Callable[..., object]) -> str:
    """The docstring of the first function, with the arguments, errors and warnings of all."""
    sections = {"Args": "", "Raises": "", "Warns": "", "Examples": ""}
    heads = []
    for function in functions:
        head, *parts = SECTION.split(inspect.getdoc(function) or "")
        heads.append(head.rstrip())
        for section, text in zip(parts[::2], parts[1::2], strict=True):
            sections[section] += text.rstrip() + "\n"
    return "\n\n".join([heads[0], *(f"{section}:\n{text.rstrip()}" for section, text in sections.items() if text)])
