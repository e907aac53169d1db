"""Compiled loops on disk, and messages while they are compiled. Importing this module imports numba."""

from __future__ import annotations

import contextlib
import hashlib
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from numba.core import event
from numba.core.caching import FunctionCache, NullCache

from .background_compilation import NotStoredError, allowed
from .notice import notice

SLOW = {
    "mjrock.theory.arcs.rocking_loop": ("rocking theory", 3),
    "mjrock.engine.loop.fitted_loop": ("steps in MuJoCo that fit the motion", 20),
    "mjrock.engine.loop.fixed_loop": ("steps in MuJoCo of one length", 10),
    "mjrock.distinct.loop.advance": ("explicit steps", 12),
    "mjrock.distinct.search.finder.find": ("contacts of explicit steps where blocks are", 5),
}
"""Loops whose compilation takes seconds: what they do, and how many [s], on one core that has nothing else to do
(`scripts/measure/speed.py`). All others take two seconds or less."""
NOWHERE = "no folder is found that can be written; name one in the environment variable NUMBA_CACHE_DIR"
IMPORT = re.compile(r"^from (\.+)([\w.]*) import (\([^)]*\)|.*)", re.MULTILINE)
"""An import from the package as a module is imported itself, not in a function or for a type checker."""
CONSTANT = r"^(?:\w+, )*(?:{})\b.* = .*(?:\n[ )\]}}].*)*"
"""Constants of some names."""
TUPLE = r"^class (?:{})\(NamedTuple\):\n(?:(?: .*)?\n)*"
"""NamedTuples of some names."""
FIELD = r"^    \w+: .*"


@cache
def _imports(path: Path) -> list[tuple[Path, list[str]]]:
    """The modules of the package that a module imports as it is imported itself, and which names of them."""
    imports = []
    for dots, module, listed in IMPORT.findall(path.read_text(encoding="utf-8")):
        names, folder = re.findall(r"\w+", listed), path.parents[len(dots) - 1].joinpath(*module.split("."))
        imports += [(folder.with_suffix(".py"), names), *((folder / f"{name}.py", []) for name in names)]
    return [(module, names) for module, names in imports if module.is_file()]


def _has_compiled_functions(text: str) -> bool:
    return "@compiled" in text or "@inlined" in text


def _numbers(path: Path, names: list[str]) -> list[str]:
    """The constants of some names in a module without compiled functions, and the fields of its NamedTuples."""
    text, named = path.read_text(encoding="utf-8"), "|".join(names)
    if not names or _has_compiled_functions(text):
        return []
    fields = re.findall(FIELD, "".join(re.findall(TUPLE.format(named), text, re.MULTILINE)), re.MULTILINE)
    return [*re.findall(CONSTANT.format(named), text, re.MULTILINE), *fields]


def stamp(path: Path) -> str:
    """A digest of the modules with compiled functions among a module and all that it imports, directly or not.

    numba recompiles a function when its own file has changed. A compiled function also contains the functions of other
    files that it calls, the constants and the order of the fields of what it is given, so that a change of any of these
    has to recompile it as well. Constants and fields may stand in modules without compiled functions.
    """
    modules, pending = set(), [path]
    while pending:
        module = pending.pop()
        if module not in modules:
            modules.add(module)
            pending += [imported for imported, _ in _imports(module)]
    digest = hashlib.sha256()
    for module in sorted(modules):
        text = module.read_text(encoding="utf-8")
        if _has_compiled_functions(text):
            digest.update("\n".join([text, *(line for pair in _imports(module) for line in _numbers(*pair))]).encode())
    return digest.hexdigest()


class LoopCache(FunctionCache):  # type: ignore[misc]
    """numba's cache on disk, which is a convenience: whatever is wrong with it, the function is compiled anew."""

    def __init__(self, function: Callable[..., object], at_once: bool) -> None:
        super().__init__(function)
        self._at_once = at_once
        self._cache_file._source_stamp = stamp(Path(function.__code__.co_filename))
        self._locked: Any = None

    def load_overload(self, *key: object) -> Any:
        """The compiled function, or None where there is none that can be read. This process then compiles it, and
        others wait. What is stored makes room for it.

        Raises:
            NotStoredError: if there is none, and the run need not wait for it.
        """
        if (stored := self._stored_overload(*key)) is None:
            if allowed(self._at_once):
                raise NotStoredError
            self._lock()
            if (stored := self._stored_overload(*key)) is not None:
                self._unlock()
        return stored

    def _stored_overload(self, *key: object) -> Any:
        try:
            return super().load_overload(*key)
        except Exception:
            with contextlib.suppress(OSError):
                self.flush()
            return None

    def _lock(self) -> None:
        """Wait while another process compiles this function, which frees the lock also where it is killed."""
        from filelock import FileLock  # needed only where something is compiled

        with contextlib.suppress(OSError):  # a disk that cannot be written stores nothing either
            self._locked = FileLock(f"{self._cache_file._index_path}.lock")
            self._locked.acquire()

    def _unlock(self) -> None:
        if self._locked is not None:
            self._locked.release()

    def save_overload(self, *key: object) -> None:
        """Store the compiled function unless the disk refuses."""
        with contextlib.suppress(OSError):
            super().save_overload(*key)
        self._unlock()


class NoCache(NullCache):  # type: ignore[misc]
    """Where nothing can be stored, short runs need not wait for the compiler either."""

    def __init__(self, at_once: bool) -> None:
        self._at_once = at_once

    def load_overload(self, *key: object) -> None:
        """Nothing is stored.

        Raises:
            NotStoredError: if the run need not wait for the compiler.
        """
        if allowed(self._at_once):
            raise NotStoredError


def cache_of(function: Callable[..., object], at_once: bool) -> LoopCache | NoCache:
    """Where a compiled function is stored, if any folder can be written."""
    try:
        return LoopCache(function, at_once)
    except RuntimeError:  # neither the package nor the user's folder can be written
        return NoCache(at_once)


def folder() -> Path:
    """The folder in which loops of the modules beside this one are stored; the folders of others lie beside it.

    Raises:
        OSError: if none can be written.
    """
    path = cache_of(folder, at_once=False).cache_path
    if path is None:
        raise OSError(NOWHERE)
    return Path(path)


class Compilations(event.Listener):  # type: ignore[misc]
    """Writes which loop is being compiled where that takes seconds, how many, and where it is stored."""

    def on_start(self, event: Any) -> None:
        """Write why nothing seems to happen."""
        dispatcher = event.data.get("dispatcher")
        function = getattr(dispatcher, "py_func", None)
        slow = SLOW.get(f"{function.__module__}.{function.__name__}") if function is not None else None
        if slow is not None:
            folder = dispatcher._cache.cache_path
            stored = f"once; stored in {folder}" if folder is not None else f"in every process: {NOWHERE}"
            notice(f"compiling {slow[0]}, some {slow[1]} s of a core, {stored}")

    def on_end(self, event: Any) -> None:
        """Nothing to say."""


@cache
def report_compilations() -> None:
    """From now on, write a line on each compilation that takes seconds."""
    event.register("numba:compile", Compilations())
