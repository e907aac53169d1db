"""Files that are whole or absent: what is written takes the place of the old file when all of it is on the disk."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """The path of a file to write, which takes the name `path` at the end, and is removed where an error comes first.

    Its name ends as that of `path` does, for writers that tell the format by it.
    """
    path = Path(path)
    partial = path.with_name(f"{path.name}.{os.getpid()}.partial{path.suffix}")
    try:
        yield partial
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> Path:
    """Write text as UTF-8, with line ends as they are."""
    with replacing(path) as partial, open(partial, "wb") as file:
        file.write(text.encode())
        file.flush()
        os.fsync(file.fileno())
    return Path(path)


def write_arrays(path: str | Path, **arrays: Any) -> None:
    """Write arrays to an .npz file, by their names."""
    with replacing(path) as partial, open(partial, "wb") as file:
        np.savez_compressed(file, **arrays)
