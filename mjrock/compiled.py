"""Compilation of the inner loops by numba, and what happens where numba cannot compile or cannot store its result.

`@compiled` marks a loop for compilation at its first call. The result is stored in the folder that the environment
variable NUMBA_CACHE_DIR names, or in `__pycache__` beside the module, or in the user's cache folder where the package
lies on a read-only disk. Where none of them can be written, each process compiles anew. Of processes that need a loop
at once one compiles it, and the others wait. Short runs need not wait at all, see `background_compilation`. `inlined`
marks a function that compiled loops call, which takes the place of its call; called from Python it runs as Python. With
NUMBA_DISABLE_JIT=1, and on a Python that has no numba, all of them run as plain Python with the same results.
"""

from __future__ import annotations

import contextlib
import functools
import os
from collections.abc import Callable
from functools import cache, cached_property
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from .background_compilation import NotStoredError, allowed, as_plain_python, news
from .contacts.solref import INLINED
from .interrupts import interrupts_held_back
from .notice import notice

WITHOUT = "numba is not installed; the loops run as plain Python, thirty times slower, thousands in explicit steps"

Function = TypeVar("Function", bound=Callable[..., Any])

_waiting = list[Callable[..., Any]](INLINED)
"""Functions that compiled loops call, until there is a loop: numba takes half a second to import."""


@cache
def _numba() -> Any:
    """numba, or None where there is none; functions that wait are registered with it. Ctrl-C is delayed meanwhile."""
    with interrupts_held_back():
        try:
            import numba
            import numba.extending

            from .loop_cache import report_compilations
        except ImportError:
            notice(WITHOUT)
            return None
        report_compilations()
        while _waiting:
            _register(numba, _waiting.pop(0))
        return numba


def _is_imported() -> bool:
    return _numba.cache_info().currsize > 0 and _numba() is not None


def _register(numba: Any, function: Callable[..., Any]) -> None:
    options = {"forceinline": not getattr(function, "stays_apart", False), "no_cfunc_wrapper": True}
    choose = getattr(function, "choose", None)
    if choose is None:
        numba.extending.register_jitable(**options)(function)
    else:
        numba.extending.overload(function, jit_options=options, strict=False)(lambda first, *more: choose(first))


def inlined(function: Function) -> Function:
    """A function that compiled loops call, which takes the place of its call; called from Python it runs as Python.

    All are: numba compiles a function anew for callers of each kind, and calls of small functions take longer than
    their arithmetic.
    """
    if _is_imported():
        _register(_numba(), function)
    else:
        _waiting.append(function)
    return function


def called(function: Function) -> Function:
    """The same as `inlined`, but the call stays: for what many places call that need not be fast."""
    function.stays_apart = True  # type: ignore[attr-defined]
    return inlined(function)


def by_type(choose: Callable[[Any], Callable[..., Any]]) -> Callable[..., Any]:
    """A function that compiled loops call, with a text for each type of its first argument, which takes its place.

    Args:
        choose: gives the text from the first argument itself, or from numba's type of it.
    """

    def function(first: Any, *more: Any) -> Any:
        return choose(first)(first, *more)

    function.choose = choose  # type: ignore[attr-defined]
    return inlined(function)


def method(name: str) -> Callable[..., Any]:
    """A function that calls a method of its first argument, a NamedTuple, by name, as compiled loops can."""
    return by_type(lambda table: getattr(getattr(table, "instance_class", type(table)), name))


class Loop:
    """A function that numba compiles when it is called, or that runs as plain Python, see `background_compilation`.

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
        self._compiled_for: dict[object, Callable[..., Any]] = {}

    def __call__(self, *arguments: Any) -> Any:
        """What the function returns."""
        patient = allowed(self._at_once)
        if not patient or self._loaded or self._looked != news():
            self._looked = news()
            if not patient or self._loaded or may_be_stored(self.py_func):
                with contextlib.suppress(NotStoredError):
                    found = self.dispatcher(*arguments)
                    self._loaded = True
                    return found
        return as_plain_python(self.py_func, arguments)

    def for_types_of(self, arguments: tuple[Any, ...]) -> Callable[..., Any]:
        """See `for_types_of`."""
        if not self._loaded or self.dispatcher is self.py_func:
            return self
        kind = _kind(arguments)
        if kind not in self._compiled_for:
            types = tuple(self.dispatcher.typeof_pyval(each) for each in arguments)
            if (known := self.dispatcher.overloads.get(types)) is None:
                return self  # the call that follows may compile it
            self._compiled_for[kind] = known.entry_point
        return self._compiled_for[kind]

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
            from .loop_cache import cache_of  # which imports numba

            dispatcher._cache = cache_of(self.py_func, self._at_once)
        return dispatcher


def for_types_of(function: Function, *arguments: Any) -> Function:
    """A compiled function for further arguments of the types that these have; as it is, where it is not compiled.

    numba finds out at each call which types its arguments have. For a system that takes some 13 us, as long as four
    steps of a small wall. Here the caller vouches for them: arrays of the same dtype, dimension and order.
    """
    return function.for_types_of(arguments) if isinstance(function, Loop) else function  # type: ignore[return-value]


def _kind(value: object) -> object:
    """What numba's type of a value depends on."""
    if isinstance(value, np.ndarray):
        flags = value.flags
        return value.dtype, value.ndim, flags.c_contiguous, flags.f_contiguous, flags.writeable, flags.aligned
    if isinstance(value, tuple):
        return type(value), *map(_kind, value)
    return type(value)


def may_be_stored(function: Callable[..., Any]) -> bool:
    """Whether a look at what is stored is worth importing numba, which takes half a second."""
    module = Path(function.__code__.co_filename)
    beside = module.parent / "__pycache__"
    elsewhere = "NUMBA_CACHE_DIR" in os.environ or not os.access(beside if beside.exists() else module.parent, os.W_OK)
    return _is_imported() or elsewhere or any(beside.glob(f"{module.stem}.{function.__qualname__}-*.nbi"))


def compiled(function: Function) -> Function:
    """Compile a function when it is called, and store the result on disk where that is possible, see `Loop`."""
    return Loop(function)  # type: ignore[return-value]


def compiled_at_once(function: Function) -> Function:
    """Compile a function when it is called also where a run is short: plain Python is too slow for it."""
    return Loop(function, at_once=True)  # type: ignore[return-value]
