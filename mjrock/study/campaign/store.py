"""The resumable store of a campaign: an SQLite file with one row a case, keyed by the content of the case."""

from __future__ import annotations

import contextlib
import os
import sqlite3
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...contacts.files import require_file, written
from ...quantities import require_path, spelt
from .task import Row, Task, checksum, keyed, table_text, table_value

if TYPE_CHECKING:
    import pandas
    from filelock import BaseFileLock

APPLICATION = 0x6D6A726B
"""SQLite's application_id of a campaign, "mjrk"."""
ROW_COLUMNS = ("key", "position", "status", "error", "version", "seconds")
"""Columns of every row. `position` is the place in the list of tasks. `seconds` is the only column that is a timing."""
CHECKSUM = "checksum"
"""The column with the checksum of a row, which is verified and left out when the row is read. SQLite checks the
structure of its file, and not the values: a byte that is flipped in a number passes its `integrity_check`."""
UNREADABLE = (sqlite3.Error, UnicodeError, OverflowError)
"""What reading a damaged file raises."""
ENVIRONMENT = tuple(
    getattr(sqlite3, f"SQLITE_{name}")
    for name in ("BUSY", "CANTOPEN", "FULL", "IOERR", "LOCKED", "NOMEM", "PERM", "READONLY")
)
"""Errors of SQLite that the disk, the system or another process causes. All others say that the file is damaged."""


class Store:
    """Rows of a campaign in a file. Use it in a `with` statement, or close it.

    Rows are committed as they come: a process that is killed at any moment leaves every one that was written. The
    structure of the file is checked when it is opened, and each row has a checksum that is verified when it is read. A
    damaged file raises an error and never returns other rows than were written.

    Args:
        path: the SQLite file, made where there is none.
        writing: whether rows will be added; one process at a time may do so, any number may read meanwhile.

    Raises:
        ValueError: if the file is not the store of a campaign, or is damaged; the error says how many rows are
            readable, and `Store.rescue` copies them.
        OSError: if it cannot be opened, or another process writes to it.
    """

    def __repr__(self) -> str:
        return f"<Store {self.path}>"

    def __init__(self, path: str | Path, *, writing: bool = False) -> None:
        self._lock: BaseFileLock | None = None
        self.path = require_path("path", path)
        if not writing and not self.path.is_file():
            raise FileNotFoundError(f"{self.path}: there is no such campaign")
        if writing and self.path.exists():
            require_file(self.path)
        if writing:
            self._lock = locked(self.path)
        try:
            try:
                self._rows = sqlite3.connect(self.path, isolation_level=None)
                self._open(writing)
            except UNREADABLE as error:
                raise self._explained_error(error) from None
            self._known = self.columns
        except BaseException:
            self.close()
            raise

    @classmethod
    def rescue(cls, damaged: str | Path, path: str | Path) -> int:
        """Copy the rows of a damaged store that are as they were written into a new store.

        Args:
            damaged: the damaged store, which is left as it is.
            path: the new store.

        Returns:
            How many rows were copied. The campaign, called with the new store, runs what is missing.

        Raises:
            FileExistsError: if there is a file at the new path.
            FileNotFoundError: if there is none at the old one.
        """
        damaged, path = require_path("damaged", damaged), require_path("path", path)
        if not damaged.is_file():
            raise FileNotFoundError(f"{damaged}: there is no such campaign")
        if path.exists():
            raise FileExistsError(f"{path} exists already; rows are rescued into a new file")
        return cls._write_new(path, readable(damaged))

    @classmethod
    def join(cls, parts: Iterable[str | Path], path: str | Path, tasks: Iterable[Task]) -> int:
        """Write the rows of several stores, as the jobs of a cluster leave them, into a new one in the order of tasks.

        Args:
            parts: the stores of the jobs, which are left as they are. Of two rows of a task one that is done counts.
            path: the new store.
            tasks: all tasks; rows of others are left out.

        Returns:
            How many tasks have a row. A campaign of all tasks, called with the new store, runs the others.

        Raises:
            FileExistsError: if there is a file at the new path.
            FileNotFoundError: if there is none at a path of `parts`.
            ValueError: if one of them is not a store, or is damaged.
        """
        path = require_path("path", path)
        if path.exists():
            raise FileExistsError(f"{path} exists already; rows are joined into a new file")
        kept: dict[str, Row] = {}
        for part in parts:
            with cls(part) as store:
                kept |= {row["key"]: row for row in store.rows() if row["status"] == "done" or row["key"] not in kept}
        positions: dict[str, int] = {}
        with warnings.catch_warnings():  # a task warned as it was made for the run
            warnings.simplefilter("ignore", UserWarning)
            for position, task in enumerate(tasks):
                positions.setdefault(keyed(task)[0], position)
        return cls._write_new(path, [kept[key] | {"position": i} for key, i in positions.items() if key in kept])

    @classmethod
    def _write_new(cls, path: Path, rows: Sequence[Row]) -> int:
        """Write rows into a new store, and return how many."""
        with cls(path, writing=True) as store:
            store.add_columns(dict.fromkeys(name for row in rows for name in row if name not in ROW_COLUMNS))
            store.add(rows)
        return len(rows)

    def _open(self, writing: bool) -> None:
        """Verify that the file is a store and sound, and make its table in a new one."""
        (application,) = self._rows.execute("PRAGMA application_id").fetchone()
        (tables,) = self._rows.execute("SELECT count(*) FROM sqlite_master").fetchone()
        if application != APPLICATION and (tables or not writing):
            raise ValueError(f"{self.path} is a database, but not the store of a campaign")
        if tables:
            (verdict,) = self._rows.execute("PRAGMA integrity_check(1)").fetchone()
            if verdict != "ok":
                raise sqlite3.DatabaseError(verdict)
            missing = {*ROW_COLUMNS, CHECKSUM} - {row[1] for row in self._rows.execute("PRAGMA table_info(cases)")}
            if missing:
                names = ", ".join(sorted(missing))
                raise sqlite3.DatabaseError(f"it has no column {names}, or an earlier version of mjrock wrote it")
            if not _is_written(self._rows):
                raise ValueError(f"{self.path} is not the store of a campaign: its rows are computed as they are read")
        if writing:
            self._rows.execute("PRAGMA journal_mode = WAL")
            self._rows.execute("PRAGMA synchronous = NORMAL")
        if writing and not tables:
            columns = ", ".join((*ROW_COLUMNS, CHECKSUM))
            self._rows.execute("BEGIN")
            self._rows.execute(f"PRAGMA application_id = {APPLICATION}")
            self._rows.execute(f"CREATE TABLE cases ({columns}, PRIMARY KEY (key))")
            self._rows.execute("COMMIT")

    def _explained_error(self, error: Exception) -> Exception:
        """What an error of SQLite means for the user."""
        code = getattr(error, "sqlite_errorcode", None)
        if code is not None and code & 0xFF in ENVIRONMENT and code != sqlite3.SQLITE_IOERR_SHORT_READ:
            return OSError(f"{self.path}: {error}")
        count = len(readable(self.path))
        if code == sqlite3.SQLITE_NOTADB and not count:
            return ValueError(f"{self.path} is not a campaign, or is damaged: {error}; none of its rows is readable")
        return ValueError(
            f"{self.path} is damaged ({table_text(str(error))}); {count} of its rows are readable, and "
            f"Store.rescue({str(self.path)!r}, new_path) copies them into a new store that a campaign can carry on from"
        )

    def _query(self, query: str) -> tuple[list[str], list[tuple[Any, ...]]]:
        """The names of the columns of a query, and its rows."""
        try:
            cursor = self._rows.execute(query)
            return [column[0] for column in cursor.description], cursor.fetchall()
        except UNREADABLE as error:
            raise self._explained_error(error) from None

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        if hasattr(self, "_rows"):
            with contextlib.suppress(sqlite3.Error):
                self._rows.close()  # every row is committed; the journal is taken up at the next opening
        if self._lock is not None:
            with contextlib.suppress(OSError):  # Windows deletes it as it is released; the file may stay
                os.unlink(self._lock.lock_file)
            self._lock.release()
            self._lock = None

    @property
    def columns(self) -> list[str]:
        """The names of the columns."""
        return [row[1] for row in self._query("PRAGMA table_info(cases)")[1] if row[1] != CHECKSUM]

    def add_columns(self, names: Iterable[str]) -> None:
        """Make columns for these names where there are none yet.

        Raises:
            ValueError: for a reserved name, a name that no column can have, or one that differs from another in upper
                and lower case only. No column is made then.
        """
        names = list(names)
        known = {name.lower(): name for name in self._known}
        reserved = (*ROW_COLUMNS, CHECKSUM)
        seen: set[str] = set()
        for name in names:
            if not isinstance(name, str) or not name or '"' in name or "\0" in name or name.lower() in reserved:
                raise ValueError(f"{spelt(name)} cannot name a column; reserved are {', '.join(reserved)}")
            table_value(name)
            if name.lower() in seen or known.get(name.lower(), name) != name:
                other = known.get(name.lower(), name)
                raise ValueError(f"{name!r} cannot name a column beside {other!r}; upper and lower case do not count")
            seen.add(name.lower())
            known[name.lower()] = name
        for name in names:
            if name not in self._known:
                self._write(((f'ALTER TABLE cases ADD COLUMN "{name}"', ()),))
                self._known.append(name)

    def add(self, rows: Sequence[Mapping[str, object]]) -> None:
        """Write rows, all or none; a row of the same key is replaced.

        Raises:
            ValueError: for a name that is not a column, or a value that is neither text nor a number nor None.
            OSError: if the disk is full or the file cannot be written. What was written before stays.
        """
        inserts = []
        for row in rows:
            values = {name: table_value(value) for name, value in row.items()}
            unknown = values.keys() - set(self._known)
            if unknown:
                raise ValueError(f"there is no column {', '.join(sorted(unknown))}; there are {', '.join(self._known)}")
            names = ", ".join(f'"{name}"' for name in values)
            marks = ", ?" * len(values)
            insert = f"INSERT OR REPLACE INTO cases ({CHECKSUM}, {names}) VALUES (?{marks})"
            inserts.append((insert, (checksum(values), *values.values())))
        self._write(inserts)

    def _write(self, statements: Iterable[tuple[str, tuple[object, ...]]]) -> None:
        """Carry out statements, all or none."""
        try:
            self._rows.execute("BEGIN")
            for statement, values in statements:
                self._rows.execute(statement, values)
            self._rows.execute("COMMIT")
        except BaseException as error:
            with contextlib.suppress(sqlite3.Error):
                self._rows.execute("ROLLBACK")
            if not isinstance(error, UNREADABLE):
                raise
            explained = self._explained_error(error)
            if isinstance(explained, OSError):
                explained = OSError(f"{explained}; what is in it is kept, and the same call carries on from there")
            raise explained from None

    def statuses(self) -> dict[str, str]:
        """Status by key: "done" or "failed"."""
        return {row["key"]: row["status"] for row in self._verified_rows()}

    def __len__(self) -> int:
        """How many rows there are."""
        return int(self._query("SELECT count(*) FROM cases")[1][0][0])

    def _verified_rows(self) -> Iterator[Row]:
        """The rows in the order of their tasks, each verified by its checksum."""
        names, rows = self._query("SELECT * FROM cases ORDER BY position, key")
        for values in rows:
            row = dict(zip(names, values, strict=True))
            if row.pop(CHECKSUM) != checksum(row):
                raise self._explained_error(ValueError("a row is not as it was written"))
            yield row

    def rows(self, **where: object) -> list[Row]:
        """The rows in the order of their tasks, all or those whose columns have the values given.

        Raises:
            ValueError: for an unknown column, a value that no column can hold, or a damaged file.
        """
        unknown = where.keys() - set(self.columns)
        if unknown:
            raise ValueError(f"there is no column {', '.join(sorted(unknown))}; there are {', '.join(self.columns)}")
        requested = {name: table_value(value) for name, value in where.items()}
        return [row for row in self._verified_rows() if all(row[name] == value for name, value in requested.items())]

    def csv(self, *, timings: bool = True) -> str:
        """The rows as CSV text; without timings it is the same however the campaign went, killed and resumed or not.

        Text that a spreadsheet would take for a formula has an apostrophe before it.
        """
        names = [name for name in self.columns if timings or name != "seconds"]
        return written([names, *([row[name] for name in names] for row in self.rows())])

    def frame(self) -> pandas.DataFrame:
        """The rows as a frame of pandas, which the extra `frames` installs."""
        import pandas

        return pandas.DataFrame(self.rows(), columns=self.columns)


def _is_written(connection: sqlite3.Connection) -> bool:
    """Whether the cases of a store are no view, which may be endless, no virtual table, and have no computed column."""
    is_table = "SELECT count(*) FROM sqlite_master WHERE name = 'cases' AND sql LIKE 'CREATE TABLE%'"
    computed = "SELECT count(*) FROM pragma_table_xinfo('cases') WHERE hidden"
    (is_plain,) = connection.execute(f"SELECT ({is_table}) > ({computed})").fetchone()
    return bool(is_plain)


def readable(path: Path) -> list[Row]:
    """The rows of a damaged store that are as they were written: those before the first and after the last damage."""
    kept: dict[str, Row] = {}
    for order in ("ASC", "DESC"):
        with contextlib.suppress(*UNREADABLE), contextlib.closing(sqlite3.connect(path)) as connection:
            connection.text_factory = lambda text: text.decode("utf-8", "replace")
            if not _is_written(connection):
                return []
            cursor = connection.execute(f"SELECT * FROM cases NOT INDEXED ORDER BY rowid {order}")
            names = [column[0] for column in cursor.description]
            for values in cursor:
                row = dict(zip(names, values, strict=True))
                if row.pop(CHECKSUM, None) == checksum(row) and set(ROW_COLUMNS) <= row.keys():
                    kept[row["key"]] = row
    return sorted(kept.values(), key=lambda row: (row["position"] or 0, row["key"]))


def locked(store: Path) -> BaseFileLock:
    """The lock of a store, taken. One process at a time can hold it, and the system frees it however the process ends.

    It is held on an empty file beside the store, `<store>.lock`. Whoever holds it deletes the file before the lock is
    released; one that gets the lock of a file that was deleted in between tries again. A process that is killed leaves
    the file behind, which locks nothing. Symbolic links to one store share one lock.

    Raises:
        OSError: if another process holds the lock, or the file beside the store cannot be made.
    """
    import filelock  # 30 ms, which only those who write need

    path = Path(os.path.realpath(store) + ".lock")
    try:
        path.parent.stat()  # a missing folder is an error; filelock would make it
        # Any thread may close the store. Without locks of the system there is an error, as a lock would outlive a kill.
        lock = filelock.FileLock(path, blocking=False, thread_local=False, fallback_to_soft=False)
        lock.acquire()
    except filelock.Timeout:
        raise OSError(f"{store}: another campaign is writing to it") from None
    except OSError as error:
        raise OSError(f"{store}: unable to open {path}: {error.strerror}") from None
    return lock
