"""What tells one task from another: a hash of its content."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Iterator, Mapping

import numpy as np

from ...quantities import spelt


def fingerprint(*contents: object) -> str:
    """A hash of the content of dataclasses, arrays, mappings and plain values, the same on every machine.

    A field of a dataclass that does not take part in comparison does not count: a label, the name of a record.

    Raises:
        TypeError: for a value whose content is not known, such as a function.
    """
    digest = hashlib.sha256()
    for piece in _pieces(contents):
        digest.update(b"%d:" % len(piece) + piece)
    return digest.hexdigest()[:32]


def _pieces(value: object) -> Iterator[bytes]:
    """The content of a value as bytes that tell it from any other."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        yield type(value).__name__.encode()
        for field in dataclasses.fields(value):
            if field.compare:
                yield field.name.encode()
                yield from _pieces(getattr(value, field.name))
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype.str}{value.shape}".encode()
        yield np.ascontiguousarray(value).tobytes()
    elif isinstance(value, Mapping):
        yield b"{%d" % len(value)
        for name in sorted(value):
            yield from _pieces(name)
            yield from _pieces(value[name])
    elif isinstance(value, tuple | list):
        yield b"[%d" % len(value)
        for item in value:
            yield from _pieces(item)
    elif isinstance(value, np.generic):
        yield from _pieces(value.item())
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield repr(float(value)).encode()  # 1 and 1.0 are the same thickness
    elif value is None or isinstance(value, bool | str):
        yield repr(value).encode()
    else:
        raise TypeError(f"{spelt(value)} is of no type whose content can be hashed")
