"""Public names of a package that are imported when they are first used."""

from __future__ import annotations

import re
from pathlib import Path

IMPORTED = re.compile(r"^    from \.(\w[\w.]*) import (\([^)]*\)|.+)", re.MULTILINE)
"""What a type checker imports at the top of a package: a module and its public names."""


def homes(init: str) -> dict[str, str]:
    """The module of each public name of a package, from the file of its `__init__`."""
    imports = IMPORTED.findall(Path(init).read_text("utf-8"))
    return {name: module for module, names in imports for name in re.findall(r"\w+", names)}
