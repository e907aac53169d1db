"""Compilation of the inner loops by numba, and what happens where numba cannot compile or cannot store its result.

`compiled` marks a loop for compilation at its first call. The result is stored in the folder that the environment
variable NUMBA_CACHE_DIR names, or in `__pycache__` beside the module, or in the user's cache folder where the package
lies on a read-only disk. Where none of them can be written, each process compiles anew. `inlined` marks a function that
compiled loops call, which takes the place of its call; called from Python it runs as Python. With NUMBA_DISABLE_JIT=1,
and on a Python that has no numba, all of them run as plain Python with the same results.
"""

from __future__ import annotations

import contextlib
import hashlib
import re
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

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

        def __init__(self, function: Function) -> None:
            super().__init__(function)
            self._cache_file._source_stamp = stamp(Path(function.__code__.co_filename))

        def load_overload(self, *key: Any) -> Any:
            """The compiled function, or None where it cannot be read. What is stored then makes room for it."""
            try:
                return super().load_overload(*key)
            except Exception:
                with contextlib.suppress(OSError):
                    self.flush()
                return None

        def save_overload(self, *key: Any) -> None:
            """Store the compiled function unless the disk refuses."""
            with contextlib.suppress(OSError):
                super().save_overload(*key)

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


def compiled(function: Function) -> Function:
    """Compile a function at its first call, and store the result on disk where that is possible.

    The function allocates nothing: it writes into arrays that it is given. numba then need not count references to
    arrays, which would take longer than the arithmetic. It returns numbers or plain tuples: for a NamedTuple
    numba calls its class, and a signal that raises in this call, such as Ctrl-C, ends the interpreter.

    Products and sums are not fused (numba's `fastmath={"contract"}`), although explicit steps would be 13 to 17 %
    faster. Last digits would then differ between processors that fuse and others, and masonry that slides or falls
    makes of last digits another motion: what one machine has found another could not repeat.
    """
    numba = _numba()
    if numba is None:
        return function
    dispatcher = numba.njit(nogil=True, error_model="numpy", no_cfunc_wrapper=True, _nrt=False)(function)
    if dispatcher is not function:  # it is with NUMBA_DISABLE_JIT=1
        with contextlib.suppress(RuntimeError):  # neither the package nor the user's folder can be written
            dispatcher._cache = globals()["_Cache"](function)
    return dispatcher  # type: ignore[no-any-return]
