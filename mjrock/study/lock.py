"""The lock of a store, which one process at a time can hold."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from filelock import BaseFileLock


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
