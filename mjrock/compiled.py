"""Compilation of the inner loops by numba, and what happens where numba cannot compile or cannot store its result.

`compiled` marks a loop for compilation at its first call. The result is stored in the folder that the environment
variable NUMBA_CACHE_DIR names, or in `__pycache__` beside the module, or in the user's cache folder where the package
lies on a read-only disk. Where none of them can be written, each process compiles anew. Of processes that need a loop
at once one compiles it, and the others wait. Short runs need not wait at all, see `patience`. `inlined` marks a
function that compiled loops call, which takes the place of its call; called from Python it runs as Python. With
NUMBA_DISABLE_JIT=1, and on a Python that has no numba, all of them run as plain Python with the same results.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import re
import sys
from collections.abc import Callable
from functools import cache, cached_property
from pathlib import Path
from typing import Any, TypeVar

from . import patience
from .interrupts import interrupts_held_back

SLOW = {
    "mjrock.theory.arcs.rocking_loop": ("rocking theory", 3),
    "mjrock.engine.loop.fitted_loop": ("steps in MuJoCo that fit the motion", 20),
    "mjrock.engine.loop.fixed_loop": ("steps in MuJoCo of one length", 10),
    "mjrock.distinct.loop.advance": ("explicit steps", 12),
    "mjrock.distinct.finder.find": ("contacts of explicit steps where blocks are", 5),
}
"""Loops whose compilation takes seconds: what they do, and how many [s], on one core that has nothing else to do
(`scripts/measure/speed.py`). All others take two seconds or less."""
WITHOUT = "numba is not installed; the loops run as plain Python, thirty times slower, thousands in explicit steps"
NOWHERE = "no folder is found that can be written; name one in the environment variable NUMBA_CACHE_DIR"

IMPORT = re.compile(r"^from (\.+)([\w.]*) import (\([^)]*\)|.*)", re.MULTILINE)
"""An import from the package as a module is imported itself, not in a function or for a type checker."""

Function = TypeVar("Function", bound=Callable[..., Any])

_waiting: list[Callable[..., Any]] = []
"""Functions that compiled loops call, until there is a loop: numba takes half a second to import."""


def _notice(text: str) -> None:
    sys.stderr.write(f"mjrock: {text}\n")


@cache
def _imports(path: Path) -> list[Path]:
    """The modules of the package that a module imports as it is imported itself."""
    found = []
    for dots, module, names in IMPORT.findall(path.read_text(encoding="utf-8")):
        folder = path.parents[len(dots) - 1].joinpath(*module.split("."))
        found += [folder.with_suffix(".py"), *(folder / f"{name}.py" for name in re.findall(r"\w+", names))]
    return [module for module in found if module.is_file()]


def stamp(path: Path) -> str:
    """A digest of the modules with compiled functions among a module and all that it imports, directly or not.

    numba recompiles a function when its own file has changed. A compiled function also contains the functions of other
    files that it calls, so that a change in any of these files has to recompile it as well.
    """
    found, ahead = set(), [path]
    while ahead:
        module = ahead.pop()
        if module not in found:
            found.add(module)
            ahead += _imports(module)
    digest = hashlib.sha256()
    for module in sorted(found):
        text = module.read_bytes()
        if any(mark in text for mark in (b"@compiled", b"@inlined")):
            digest.update(text)
    return digest.hexdigest()


def _numba() -> Any:
    """numba, or None where there is none; what waits is made known to it. Ctrl-C is heard when all of it is there."""
    with interrupts_held_back():
        return _imported_numba()


@cache
def _imported_numba() -> Any:
    try:
        import numba
        import numba.core.caching
        import numba.extending
        from numba.core import event
    except ImportError:
        _notice(WITHOUT)
        return None

    class _Cache(numba.core.caching.FunctionCache):  # type: ignore[misc]
        """numba's cache on disk, which is a convenience: whatever is wrong with it, the function is compiled anew."""

        def __init__(self, function: Function, at_once: bool) -> None:
            super().__init__(function)
            self._at_once = at_once
            self._cache_file._source_stamp = stamp(Path(function.__code__.co_filename))
            self._locked: Any = None

        def load_overload(self, *key: Any) -> Any:
            """The compiled function, or None where there is none that can be read. This process then compiles it, and
            others wait. What is stored makes room for it.

            Raises:
                NotStoredError: if there is none, and the run need not wait for it.
            """
            if (stored := self._stored(*key)) is None:
                if patience.allowed(self._at_once):
                    raise NotStoredError
                self._lock()
                if (stored := self._stored(*key)) is not None:
                    self._unlock()
            return stored

        def _stored(self, *key: Any) -> Any:
            try:
                return super().load_overload(*key)
            except Exception:
                with contextlib.suppress(OSError):
                    self.flush()
                return None

        def _lock(self) -> None:
            """Wait while another process compiles this function, which frees the lock also where it is killed. A
            process that compiles for another one goes on to the next function instead."""
            from filelock import FileLock, Timeout

            with contextlib.suppress(OSError):  # a disk that cannot be written stores nothing either
                try:
                    self._locked = FileLock(f"{self._cache_file._index_path}.lock")
                    self._locked.acquire(blocking=not patience.is_behind())
                except Timeout:
                    raise NotStoredError from None

        def _unlock(self) -> None:
            if self._locked is not None:
                self._locked.release()

        def save_overload(self, *key: Any) -> None:
            """Store the compiled function unless the disk refuses."""
            with contextlib.suppress(OSError):
                super().save_overload(*key)
            self._unlock()

    class _Compilations(event.Listener):  # type: ignore[misc]
        """Says which loop is being compiled where that takes seconds, how many, and where it is stored."""

        def on_start(self, event: Any) -> None:
            """Tell the user why nothing seems to happen."""
            dispatcher = event.data.get("dispatcher")
            function = getattr(dispatcher, "py_func", None)
            slow = SLOW.get(f"{function.__module__}.{function.__name__}") if function is not None else None
            if slow is not None:
                folder = dispatcher._cache.cache_path
                stored = f"once; stored in {folder}" if folder is not None else f"in every process: {NOWHERE}"
                _notice(f"compiling {slow[0]}, some {slow[1]} s of a core, {stored}")

        def on_end(self, event: Any) -> None:
            """Nothing to say."""

    event.register("numba:compile", _Compilations())
    globals().update(numba=numba, _Cache=_Cache)
    while _waiting:
        _register(numba, _waiting.pop(0))
    return numba


def _register(numba: Any, function: Callable[..., Any]) -> None:
    numba.extending.register_jitable(forceinline=True, no_cfunc_wrapper=True)(function)


def __getattr__(name: str) -> Any:
    """numba and what is made of it, where there is numba."""
    if name in ("numba", "_Cache") and _numba() is not None:
        return globals()[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def inlined(function: Function) -> Function:
    """A function that compiled loops call, which takes the place of its call; called from Python it runs as Python.

    All are: numba compiles a function anew for callers of each kind, and calls of small functions take longer than
    their arithmetic.
    """
    if "numba" in globals():
        _register(_numba(), function)
    else:
        _waiting.append(function)
    return function


class NotStoredError(Exception):
    """A loop is not stored."""


class Loop:
    """A function that numba compiles when it is called, or that runs as plain Python while `patience` allows it.

    Args:
        function: allocates nothing: it writes into arrays that it is given. numba then need not count references to
            arrays, which would take longer than the arithmetic. It returns numbers or plain tuples: for a NamedTuple
            numba calls its class, and a signal that raises in this call, such as Ctrl-C, ends the interpreter.
        at_once: whether plain Python is too slow for it.
    """

    def __init__(self, function: Callable[..., Any], *, at_once: bool = False) -> None:
        functools.update_wrapper(self, function)
        self.py_func, self._at_once = function, at_once
        self._loaded, self._looked = False, -1

    def __call__(self, *arguments: Any) -> Any:
        """What the function returns."""
        patient = patience.allowed(self._at_once)
        if not patient or self._loaded or self._looked != patience.news():
            self._looked = patience.news()
            if not patient or self._loaded or may_be_stored(self.py_func):
                with contextlib.suppress(NotStoredError):
                    found = self.dispatcher(*arguments)
                    self._loaded = True
                    return found
        return patience.as_plain_python(self.py_func, arguments)

    def __getattr__(self, name: str) -> Any:
        """What numba knows of the function, such as its signatures."""
        if name.startswith("__") or name == "dispatcher":
            raise AttributeError(f"{self.py_func.__qualname__} has no attribute {name!r}")
        return getattr(self.dispatcher, name)

    @cached_property
    def dispatcher(self) -> Any:
        """The function as numba calls it; as it is, where numba is missing or switched off.

        Products and sums are not fused (numba's `fastmath={"contract"}`), although explicit steps would be 13 to 17 %
        faster. Last digits would then differ between processors that fuse and others, and masonry that slides or falls
        makes of last digits another motion: what one machine has found another could not repeat.
        """
        numba = _numba()
        if numba is None:
            return self.py_func
        dispatcher = numba.njit(nogil=True, error_model="numpy", no_cfunc_wrapper=True, _nrt=False)(self.py_func)
        if dispatcher is not self.py_func:  # it is with NUMBA_DISABLE_JIT=1
            with contextlib.suppress(RuntimeError):  # neither the package nor the user's folder can be written
                dispatcher._cache = globals()["_Cache"](self.py_func, self._at_once)
        return dispatcher


def may_be_stored(function: Callable[..., Any]) -> bool:
    """Whether a look at what is stored is worth importing numba, which takes half a second."""
    module = Path(function.__code__.co_filename)
    beside = module.parent / "__pycache__"
    elsewhere = "NUMBA_CACHE_DIR" in os.environ or not os.access(beside if beside.exists() else module.parent, os.W_OK)
    return "numba" in globals() or elsewhere or any(beside.glob(f"{module.stem}.{function.__qualname__}-*.nbi"))


def compiled(function: Function) -> Function:
    """Compile a function when it is called, and store the result on disk where that is possible, see `Loop`."""
    return Loop(function)  # type: ignore[return-value]


def compiled_at_once(function: Function) -> Function:
    """Compile a function when it is called also where a run is short: plain Python is too slow for it."""
    return Loop(function, at_once=True)  # type: ignore[return-value]
