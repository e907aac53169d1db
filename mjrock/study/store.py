"""The resumable store of a campaign: an SQLite file with one row a case, keyed by what the case is."""

from __future__ import annotations

import contextlib
import csv
import dataclasses
import hashlib
import io
import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas

APPLICATION = 0x6D6A726B
"""SQLite's application_id of a campaign, "mjrk"."""
FIXED = ("key", "position", "status", "error", "version", "seconds")
"""Columns of every row. `position` is the place in the list of tasks. `seconds` is the only column that is a timing."""


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
        raise TypeError(f"{value!r} is of no type whose content can be hashed")


class Store:
    """Rows of a campaign in a file. Use it in a `with` statement, or close it.

    Rows are committed as they come: a process that is killed at any moment leaves every one that was written.

    Args:
        path: the SQLite file, made where there is none.
        writing: whether rows will be added; one process at a time may do so, any number may read meanwhile.

    Raises:
        ValueError: if the file is not the store of a campaign.
        OSError: if it cannot be opened, or another process writes to it.
    """

    def __init__(self, path: str | Path, *, writing: bool = False) -> None:
        self.path = Path(path)
        self._lock: sqlite3.Connection | None = None
        if not writing and not self.path.is_file():
            raise FileNotFoundError(f"{self.path}: there is no such campaign")
        if writing:
            self._lock = self._locked()
        try:
            self._rows = sqlite3.connect(self.path, isolation_level=None)
            self._open(writing)
        except sqlite3.DatabaseError as error:
            self.close()
            if isinstance(error, sqlite3.OperationalError):
                raise OSError(f"{self.path}: {error}") from None
            raise ValueError(f"{self.path} is not a campaign: {error}") from None
        except ValueError:
            self.close()
            raise

    def _locked(self) -> sqlite3.Connection:
        """A lock that the system releases when a process is killed."""
        try:
            lock = sqlite3.connect(self.path.with_name(self.path.name + ".lock"), timeout=0, isolation_level=None)
            lock.execute("BEGIN EXCLUSIVE")
        except sqlite3.OperationalError as error:
            busy = "locked" in str(error)
            raise OSError(f"{self.path}: {'another campaign is writing to it' if busy else error}") from None
        return lock

    def _open(self, writing: bool) -> None:
        (application,) = self._rows.execute("PRAGMA application_id").fetchone()
        (tables,) = self._rows.execute("SELECT count(*) FROM sqlite_master").fetchone()
        if application != APPLICATION and (tables or not writing):
            raise ValueError(f"{self.path} is a database, but not the store of a campaign")
        if writing:
            self._rows.execute("PRAGMA journal_mode = WAL")
            self._rows.execute("PRAGMA synchronous = NORMAL")
            self._rows.execute(f"PRAGMA application_id = {APPLICATION}")
            self._rows.execute(f"CREATE TABLE IF NOT EXISTS cases ({', '.join(FIXED)}, PRIMARY KEY (key))")

    def __enter__(self) -> Store:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        if hasattr(self, "_rows"):
            self._rows.close()
        if self._lock is not None:
            self._lock.close()
            self.path.with_name(self.path.name + ".lock").unlink(missing_ok=True)
            self._lock = None

    @property
    def columns(self) -> list[str]:
        """The names of the columns."""
        return [row[1] for row in self._rows.execute("PRAGMA table_info(cases)")]

    def add_columns(self, names: Iterable[str]) -> None:
        """Make columns for these names where there are none yet.

        Raises:
            ValueError: for a name that every row has already, or one that is no column's name.
        """
        known = {name.lower() for name in self.columns}
        for name in names:
            if name.lower() in FIXED or not name or '"' in name:
                raise ValueError(f"{name!r} cannot name a column; reserved are {', '.join(FIXED)}")
            if name.lower() not in known:
                self._rows.execute(f'ALTER TABLE cases ADD COLUMN "{name}"')
                known.add(name.lower())

    def add(self, rows: Sequence[Mapping[str, object]]) -> None:
        """Write rows, all or none; a row of the same key is replaced.

        Raises:
            OSError: if the disk is full or the file cannot be written. What was written before stays.
        """
        try:
            self._rows.execute("BEGIN")
            for row in rows:
                names = ", ".join(f'"{name}"' for name in row)
                values = tuple(value.item() if isinstance(value, np.generic) else value for value in row.values())
                marks = ", ".join("?" * len(row))
                self._rows.execute(f"INSERT OR REPLACE INTO cases ({names}) VALUES ({marks})", values)
            self._rows.execute("COMMIT")
        except sqlite3.OperationalError as error:
            with contextlib.suppress(sqlite3.Error):
                self._rows.execute("ROLLBACK")
            raise OSError(
                f"{self.path}: {error}; what is in it is kept, and the same call carries on from there"
            ) from None

    def statuses(self) -> dict[str, str]:
        """Status by key: "done" or "failed"."""
        return dict(self._rows.execute("SELECT key, status FROM cases"))

    def __len__(self) -> int:
        """How many rows there are."""
        return int(self._rows.execute("SELECT count(*) FROM cases").fetchone()[0])

    def rows(self, **where: object) -> list[dict[str, Any]]:
        """The rows in the order in which they were asked, all or those whose columns have the values given."""
        unknown = where.keys() - set(self.columns)
        if unknown:
            raise ValueError(f"there is no column {', '.join(sorted(unknown))}; there are {', '.join(self.columns)}")
        names = self.columns
        condition = "".join(f' AND "{name}" IS ?' for name in where)
        query = f"SELECT * FROM cases WHERE 1{condition} ORDER BY position, key"
        return [dict(zip(names, row, strict=True)) for row in self._rows.execute(query, tuple(where.values()))]

    def csv(self, *, timings: bool = True) -> str:
        """The rows as CSV text; without timings it is the same however the campaign went, killed and resumed or not."""
        names = [name for name in self.columns if timings or name != "seconds"]
        text = io.StringIO()
        writer = csv.DictWriter(text, names, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(self.rows())
        return text.getvalue()

    def frame(self) -> pandas.DataFrame:
        """The rows as a frame of pandas, which the extra `frames` installs."""
        import pandas

        return pandas.DataFrame(self.rows(), columns=self.columns)
