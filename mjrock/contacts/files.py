"""Files that are whole or absent, and their content: tables as CSV that NumPy, pandas and a spreadsheet read.

What is written takes the place of the old file when all of it is on the disk.
"""

from __future__ import annotations

import contextlib
import csv
import errno
import html
import io
import os
import re
import shutil
import stat
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import IO, Any

import numpy as np


@contextlib.contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """The path of a file to write, whose content is at `path` at the end, and which is removed where an error comes.

    Its name ends as that of `path` does, for writers that tell the format by it. A file that is at `path`, or at the
    end of links, is replaced, and its mode and owner stay. A device or a pipe stays and is given the content.

    Raises:
        OSError: with `path`, if it is a folder, may not be written, stands for an open file as /dev/stdout may, or is a
            pipe that nobody reads; and if writing fails, as on a full disk.
    """
    path = partial = Path(path)
    try:
        old = _status(path)
        if old is None or stat.S_ISREG(old.st_mode):
            target = Path(os.path.realpath(path))
            partial = target.with_name(f"{target.name}.{os.getpid()}.partial{path.suffix}")
            try:
                yield partial
                if old is not None:
                    _keep_owner_and_mode(partial, old)
                os.replace(partial, target)
            finally:
                partial.unlink(missing_ok=True)
        else:
            with TemporaryDirectory() as folder:
                partial = Path(folder) / path.name
                yield partial
                with open(partial, "rb") as content, _opened_device(path) as sink:
                    shutil.copyfileobj(content, sink)
    except OSError as error:
        if error.filename is not None and str(error.filename) != str(partial):
            raise
        raise OSError(error.errno, error.strerror or str(error), str(path)) from None


def _status(path: Path) -> os.stat_result | None:
    """What is at a path, at the end of links; None if there is nothing. OSError if it is nothing to write to."""
    try:
        old = path.stat()
    except FileNotFoundError:
        return None
    if stat.S_ISDIR(old.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not os.access(path, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
    folder = Path(os.path.realpath(path.parent))
    if stat.S_ISREG(old.st_mode) and (folder.parts[1:2] == ("proc",) or folder in (Path("/dev"), Path("/dev/fd"))):
        raise OSError(errno.EBUSY, "stands for a file that is open; give the path of that file", str(path))
    return old


def _keep_owner_and_mode(path: Path, old: os.stat_result) -> None:
    new = path.stat()
    if (new.st_uid, new.st_gid) != (old.st_uid, old.st_gid):
        with contextlib.suppress(OSError):  # the superuser alone gives files away
            os.chown(path, old.st_uid, old.st_gid)
    if new.st_mode != old.st_mode:
        path.chmod(stat.S_IMODE(old.st_mode))


def _opened_device(path: Path) -> IO[bytes]:
    """A device or a pipe, open for writing. A pipe that nobody reads is an OSError and is not waited for."""
    try:
        descriptor = os.open(path, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0))
    except OSError as error:
        if error.errno == errno.ENXIO:
            raise OSError(error.errno, "nobody reads from it", str(path)) from None
        raise
    if hasattr(os, "O_NONBLOCK"):
        os.set_blocking(descriptor, True)
    return open(descriptor, "wb")


def require_file(path: Path) -> Path:
    """The path of a file that is to be read.

    Raises:
        OSError: with the path, if there is nothing, or what is not a file, such as a pipe, which may never end.
    """
    mode = path.stat().st_mode
    if not stat.S_ISREG(mode):
        folder = stat.S_ISDIR(mode)
        raise OSError(errno.EISDIR if folder else errno.EINVAL, "is not a file", str(path))
    return path


def write_text(path: str | Path, text: str) -> Path:
    """Write text as UTF-8, with line ends as they are."""
    with replacing(path) as partial, open(partial, "wb") as file:
        file.write(text.encode())
        file.flush()
        os.fsync(file.fileno())
    return Path(path)


def write_arrays(path: str | Path, **arrays: Any) -> None:
    """Write arrays to an .npz file, by their names."""
    content = io.BytesIO()  # an archive on a full disk would be left open
    np.savez_compressed(content, **arrays)
    with replacing(path) as partial:
        partial.write_bytes(content.getvalue())


def quoted(value: str) -> str:
    """A text as the value of an attribute in XML, within its quotes."""
    return f'"{html.escape(value)}"'


def csv_text(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Rows as CSV text that `np.genfromtxt(path, delimiter=",", names=True)` and pandas read, see `written`.

    NumPy reads no quotation marks and takes # for the start of a comment. Commas, quotation marks and # are therefore
    left out of the header, and in the cells a comma becomes a semicolon. Numbers keep all their digits.

    Raises:
        ValueError: if two columns have the same name.
    """
    names = [" ".join(re.sub('[,"#]', "", name).split()) for name in header]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"two columns have the name {twice[0]!r}")
    return written([names, *([_cell(value) for value in row] for row in rows)])


def written(rows: Iterable[Sequence[object]]) -> str:
    """Rows as CSV text. Text that a spreadsheet would take for a formula has an apostrophe before it."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(map(_guarded, row) for row in rows)
    return text.getvalue()


def aligned(rows: Sequence[Sequence[str]], sides: str = ">") -> list[str]:
    """Rows of cells as lines whose columns end below each other, or begin so where their side is "<"; the last side is
    that of all further columns. No line ends in blanks."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    formats = [f"{side}{width}" for side, width in zip(sides.ljust(len(widths), sides[-1]), widths, strict=True)]
    return ["  ".join(f"{cell:{form}}" for cell, form in zip(row, formats, strict=True)).rstrip() for row in rows]


def _cell(value: object) -> object:
    if not isinstance(value, str):
        return value
    return value.replace(",", ";").replace("#", "no. ").replace('"', "'")


def _guarded(value: object) -> object:
    """A cell that no spreadsheet computes: text that begins like a formula, and is not a number, gets an apostrophe."""
    if not isinstance(value, str) or not value.startswith(("=", "+", "-", "@", "\t", "\r")):
        return value
    try:
        float(value)
    except ValueError:
        return f"'{value}"
    return value
