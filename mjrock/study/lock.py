"""The lock of a store, which one process at a time can hold."""

from __future__ import annotations

import os
import sqlite3
from pathlib import Path


class Lock:
    """A lock that the system releases when its process ends, however it ends.

    The lock is held on a file beside the store, `<store>.lock`. That file is empty and stays when the lock is released.
    If it were deleted, a process that had opened it just before could lock the deleted file while another process
    locks a new one.

    Args:
        store: the file of the store; symbolic links to the same file share one lock.

    Raises:
        OSError: if another process holds the lock, or the file beside the store cannot be used.
    """

    def __init__(self, store: Path) -> None:
        path = Path(os.path.realpath(store) + ".lock")
        self._connection: sqlite3.Connection | None = None
        try:
            self._connection = sqlite3.connect(path, timeout=0, isolation_level=None)
            self._connection.execute("BEGIN EXCLUSIVE")
        except sqlite3.Error as error:
            self.release()
            if getattr(error, "sqlite_errorcode", None) == sqlite3.SQLITE_BUSY:
                raise OSError(f"{store}: another campaign is writing to it") from None
            if getattr(error, "sqlite_errorcode", None) == sqlite3.SQLITE_NOTADB:
                raise OSError(f"{store}: {path} is not the lock of a store; move it away") from None
            raise OSError(f"{store}: {error}") from None

    def release(self) -> None:
        """Let another process write."""
        if self._connection is not None:
            self._connection.close()
            self._connection = None
