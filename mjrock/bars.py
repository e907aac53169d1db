"""Progress bars: on a terminal as text, in a notebook as a widget, where it has widgets."""

from __future__ import annotations

import contextlib
import importlib.util
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, wait
from contextvars import ContextVar, copy_context
from typing import NamedTuple, TypeVar

from tqdm import tqdm

Value = TypeVar("Value")
DELAY = 3.0
"""Time that nothing is shown [s]."""
POLLED_EVERY = 0.1
"""Time between two checks whether a function has ended [s]."""
PLAIN = "{desc}: {n:.0f} {unit} [{elapsed}{postfix}]"
OF_ALL = "{desc}: {percentage:3.0f}%|{bar}| {n:.0f} of {total:g} {unit} [{elapsed}<{remaining}{postfix}]"


class Progress(NamedTuple):
    """The progress of a task.

    Args:
        what: the task.
        done: amount of it that is done.
        total: amount of all of it; None if that is unknown.
    """

    what: str
    done: float
    total: float | None


Listener = Callable[[Progress], None]
_listener: ContextVar[Listener | None] = ContextVar("listener", default=None)


@contextlib.contextmanager
def progress_given_to(listener: Listener) -> Iterator[None]:
    """Give the progress of every bar in this block to a function too, which may raise an error to end the work."""
    token = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(token)


def shown_bar(what: str, unit: str, total: float | None, **options: object) -> tqdm:
    """The bar of tqdm that suits: a widget in a notebook with `ipywidgets`, otherwise text.

    Seconds have two decimals. Nothing is shown where the output is a file, or where there is none.
    """
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    in_notebook = hasattr(shell, "kernel")  # of Jupyter, VS Code or Colab
    if in_notebook and importlib.util.find_spec("ipywidgets"):
        from tqdm.notebook import tqdm as bar_type
    else:
        bar_type = tqdm
    bar_format = PLAIN if total is None else OF_ALL
    if unit == "s":
        bar_format = bar_format.replace("{n:.0f}", "{n:.2f}")
    options = {"total": total, "desc": what, "unit": unit, "bar_format": bar_format} | options
    silent = True if sys.stderr is None else None  # None: where it is no terminal
    return bar_type(disable=False if in_notebook else silent, **options)


class Bar:
    """Progress of a task that may take longer than DELAY; before, it costs nothing. Use it in a `with` statement.

    Args:
        what: the task.
        unit: of its amount.
        total: amount of all of it; None if that is unknown.
    """

    def __init__(self, what: str, unit: str, total: float | None = None) -> None:
        self.what, self.unit, self.total = what, unit, total
        self.n, self.begun = 0.0, time.time()
        self.bar: tqdm | None = None

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *error: object) -> None:
        if self.bar is not None:
            if self.total is not None and error[0] is None:
                self.bar.total = self.bar.n  # a run may end before its time, and is whole then
            self.bar.close()

    def add(self, more: float = 1.0) -> None:
        """Advance by an amount."""
        self.to(self.n + more)

    def to(self, n: float) -> None:
        """Set the amount that is done."""
        self.n = n if self.total is None else min(n, self.total)
        if (listener := _listener.get()) is not None:
            listener(Progress(self.what, self.n, self.total))
        if self.bar is None and time.time() - self.begun >= DELAY:
            self.bar = shown_bar(self.what, self.unit, self.total, leave=None)
            self.bar.start_t = self.bar.last_print_t = self.begun  # the rate is that since then
        if self.bar is not None:
            self.bar.update(self.n - self.bar.n)


def counted(values: Sequence[Value], what: str, unit: str) -> Iterator[Value]:
    """Values one by one, and a bar of how many there have been."""
    with Bar(what, unit, len(values)) as bar:
        for value in values:
            yield value
            bar.add()


def waited(function: Callable[[], Value], what: str) -> Value:
    """The value of a function of another library that leaves the interpreter free, and a bar of the time it takes.

    Ctrl-C ends the wait at once. The function cannot be ended: it goes on beside the script until it is done, or until
    the process ends, and its value is dropped.
    """
    future: Future[Value] = Future()

    def work() -> None:
        try:
            future.set_result(function())
        except BaseException as error:
            future.set_exception(error)

    threading.Thread(target=copy_context().run, args=(work,), daemon=True, name=what).start()
    with Bar(what, "s") as bar:
        while not wait([future], timeout=POLLED_EVERY).done:
            bar.to(time.time() - bar.begun)
    return future.result()
