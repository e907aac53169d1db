"""Modules as Python parses them, each once in a process."""

import ast
from functools import cache


@cache
def tree(path):
    """A module as Python parses it."""
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def nodes(path):
    """All nodes of a module."""
    return tuple(ast.walk(tree(path)))
