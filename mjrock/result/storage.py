"""A response in one file of HDF5, which describes its content, and from which the response is read to the bit.

At the top are the arrays of the response, each with units, a description and its dimensions; xarray and programs for
NetCDF open them. In the group `answer` are the parts of the response as texts in JSON, see `tree`, and the arrays that
these name. Nothing is unpickled.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..contacts.files import replacing, require_file
from ..quantities import named, require_path, warn_of
from .tree import Reader, Tree, UnreadableError, Writer, fields_of, name_of, unit_and_text
from .variables import Variable, attributes_of, variables_of

if TYPE_CHECKING:
    from h5py import Dataset, File

FORMAT, FORMAT_VERSION = "mjrock response", 1
"""Name of the format, and number of its layout, which grows when older programs would misread it."""
GROUP, CHECKSUMS = "answer", "answer/checksums"
"""The group of what a response is made from, and the text with the SHA-256 of every dataset."""
COMPRESSED = 1000
"""Numbers of an array from which on it is compressed."""
MEMORY = "numbers that explicit steps go on from, each in SI units"
"""Description of an array whose class has none."""
NUMBERS_IN_JSON = re.compile(r"\[\n\s+([-\d][^\[\]{}\"]*?)\n\s+\]")
"""A list of numbers in JSON, one a line."""


class StoredArray(NamedTuple):
    """An array of a file that is not one of those at the top: the array, its unit and its description."""

    values: Any
    units: str
    text: str


def hdf5() -> ModuleType:
    """h5py.

    Raises:
        ImportError: if it is missing.
    """
    try:
        import h5py  # an extra
    except ImportError as error:
        raise ImportError(f"{error}; h5py reads and writes whole results: pip install h5py") from None
    return h5py  # type: ignore[no-any-return]


def write_answer(answer: Any, path: str | Path) -> Path:
    """Write a `Response` to a file, whole or not at all.

    Raises:
        ImportError: without h5py.
        OSError: if the file cannot be written.

    Warns:
        UserWarning: of what the file cannot hold, such as a function of the user; the rest is kept.
    """
    path, h5py = require_path("path", path), hdf5()
    variables, arrays = variables_of(answer), dict[str, StoredArray]()
    places = {id(variable.values): name for name, variable in variables.items()}

    def keep(at: str, values: Any, owner: type, field: str) -> str:
        if id(values) not in places:
            unit, text = unit_and_text(owner, field)
            name = f"{GROUP}/arrays/{at.replace('/', '_')}"
            arrays[name] = StoredArray(values, unit or ("SI" if values.dtype.names else "-"), f"{at}: {text or MEMORY}")
            places[id(values)] = name
        return places[id(values)]

    writer = Writer(keep, lambda array: id(array) in places)
    texts = {name: writer.tree(getattr(answer, name), name, type(answer), name) for name in fields_of(type(answer))}
    with h5py.File(path.name, "w", driver="core", backing_store=False, block_size=1 << 24, libver="v110") as file:
        file.attrs.update({"format": FORMAT, "format_version": FORMAT_VERSION, **attributes_of(answer)})
        _write_variables(file, variables)
        _write_parts(file, arrays, {"class": name_of(type(answer)), **texts})
        file.flush()
        image = file.id.get_file_image()
    with replacing(path) as partial:
        partial.write_bytes(image)
    if writer.lost:
        lost = named([f"{at} ({description})" for at, description in writer.lost.items()])
        warn_of(f"{path} does not hold {lost}; all else is kept")
    return path


def _write_variables(file: File, variables: Mapping[str, Variable]) -> None:
    """Write the arrays of the top with their dimensions."""
    for name, variable in variables.items():
        dataset = _dataset(file, name, variable.values, variable.units, variable.text)
        for axis, dim in enumerate(variable.dims):
            if dim == name:
                dataset.make_scale(dim)
                continue
            if dim not in file:
                _dataset(file, dim, np.arange(variable.values.shape[axis]), "-", "number").make_scale(dim)
            dataset.dims[axis].attach_scale(file[dim])
            dataset.dims[axis].label = dim


def _write_parts(file: File, arrays: Mapping[str, StoredArray], texts: Tree) -> None:
    """Write the other arrays, the texts, and the checksums of all."""
    for name, array in arrays.items():
        dataset = _dataset(file, name, array.values, array.units, array.text)
        for axis in range(dataset.ndim):
            dataset.dims[axis].label = ("row", "column")[axis] if axis < 2 else f"axis_{axis}"
    for name, tree in texts.items():
        lines = json.dumps(tree, indent=1, allow_nan=False)
        text = NUMBERS_IN_JSON.sub(lambda match: f"[{' '.join(match[1].split())}]", lines)
        _dataset(file, f"{GROUP}/{name}", text, "-", f"{name} of the response as JSON")
    names: list[str] = []
    file.visit(names.append)
    checksums = {name: _checksum(file[name][()]) for name in names if isinstance(file[name], hdf5().Dataset)}
    _dataset(
        file, CHECKSUMS, json.dumps(checksums, indent=1), "-", "SHA-256 of the numbers or the text of each dataset"
    )


def _dataset(file: File, name: str, values: object, units: str, text: str) -> Dataset:
    """A new dataset with its unit and its description."""
    large = isinstance(values, np.ndarray) and values.size >= COMPRESSED
    packed = {"compression": "gzip", "compression_opts": 1, "shuffle": True} if large else {}
    if isinstance(values, np.ndarray) and values.dtype == object:
        packed["dtype"] = hdf5().string_dtype()
    dataset = file.create_dataset(name, data=values, **packed)
    dataset.attrs["units"], dataset.attrs["description"] = units, text
    return dataset


def _checksum(values: Any) -> str:
    """SHA-256 of what a dataset holds."""
    if isinstance(values, bytes):
        return hashlib.sha256(values).hexdigest()
    if values.dtype == object:
        return hashlib.sha256(b"\0".join(values.tolist())).hexdigest()
    return hashlib.sha256(values.tobytes()).hexdigest()


def read_answer(path: str | Path, laws: Iterable[type] = ()) -> Any:
    """The `Response` of a file, see `mjrock.load`."""
    path, h5py = require_file(require_path("path", path)), hdf5()
    try:
        with h5py.File(path, "r") as file:
            return _answer(path, file, laws)
    except UnreadableError as error:
        raise ValueError(f"{path}: {error}") from None
    except (OSError, LookupError, RuntimeError, TypeError, AttributeError, ValueError) as error:
        raise ValueError(f"{path} is no file of Response.save, or is damaged: {error}") from None


def _answer(path: Path, file: File, laws: Iterable[type]) -> Any:
    """The response of an open file."""
    if file.attrs.get("format") != FORMAT:
        raise UnreadableError("this is a file of HDF5, and not one of Response.save")
    if (version := int(file.attrs["format_version"])) != FORMAT_VERSION:
        age, remedy = ("newer", "update mjrock") if version > FORMAT_VERSION else ("older", "read it with that version")
        by = file.attrs.get("mjrock_version", "?")
        raise UnreadableError(
            f"it has the {age} format {version}, of mjrock {by}, and this version reads {FORMAT_VERSION}; {remedy}"
        )
    values = {}
    for name, checksum in json.loads(file[CHECKSUMS][()]).items():
        values[name] = file[name][()]
        if _checksum(values[name]) != checksum:
            raise UnreadableError(f"{name} is not as it was written; the file is damaged")
    heads = [name for name in values if name.startswith(f"{GROUP}/") and name.count("/") == 1]
    trees = {name.removeprefix(f"{GROUP}/"): json.loads(values[name]) for name in heads}
    try:
        return Reader(values, laws).value(trees, "")
    except UnreadableError as error:
        if ".memory" not in str(error):
            raise
        trees["end"]["memory"] = None
        warn_of(
            f"{path}: {error}. The rest is read; a run that goes on from its end starts from pose and velocity alone"
        )
        return Reader(values, laws).value(trees, "")
