"""Lines for the user on the standard error."""

from __future__ import annotations

import sys


def notice(text: str, by: str = "mjrock") -> None:
    """Write a line for the user. Programs without a console have no standard error, and the line is left out."""
    if sys.stderr is not None:
        sys.stderr.write(f"{by}: {text}\n")
        sys.stderr.flush()
