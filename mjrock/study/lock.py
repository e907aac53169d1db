"""The lock of a store, which one process at a time can hold."""

from __future__ import annotations

import contextlib
import os
import sys
from pathlib import Path

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl


class Lock:
    """A lock that the system releases when its process ends, however it ends.

    The lock is held on an empty file beside the store, `<store>.lock`, which is deleted before the lock is released. A
    process that had opened the file before it was deleted may get the lock of the deleted file. It finds out that the
    name belongs to another file or to none, and tries again.

    Args:
        store: the file of the store; symbolic links to the same file share one lock.

    Raises:
        OSError: if another process holds the lock, or the file beside the store cannot be made.
    """

    def __init__(self, store: Path) -> None:
        self._path = Path(os.path.realpath(store) + ".lock")
        self._file: int | None = None
        while self._file is None:
            try:
                file = os.open(self._path, os.O_CREAT | os.O_RDWR, 0o666)
            except OSError as error:
                raise OSError(f"{store}: unable to open {self._path}: {error.strerror}") from None
            try:
                _lock(file)
            except OSError as error:
                os.close(file)
                busy = isinstance(error, BlockingIOError | PermissionError)  # the second is what Windows raises
                raise OSError(f"{store}: {'another campaign is writing to it' if busy else error}") from None
            if self._holds(file):
                self._file = file
            else:
                os.close(file)

    def _holds(self, file: int) -> bool:
        """Whether the file that is locked is the one that others find by its name."""
        try:
            return os.path.samestat(os.fstat(file), os.stat(self._path))
        except FileNotFoundError:
            return False

    def release(self) -> None:
        """Let another process write."""
        if self._file is not None:
            with contextlib.suppress(OSError):  # Windows keeps files that are open; the file may stay
                self._path.unlink()
            os.close(self._file)
            self._file = None


def _lock(file: int) -> None:
    """Lock a file that is open, or raise OSError at once."""
    if sys.platform == "win32":
        msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
