"""Ctrl-C at moments at which it would leave the process broken."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator


@contextlib.contextmanager
def interrupts_held_back() -> Iterator[None]:
    """Delay Ctrl-C to the end of the block: an import that is cut off leaves modules that are half made, and a start of
    processes leaves some that nothing ends.

    Python receives signals in the main thread, and nothing is done in another. The same holds where no function of
    Python handles Ctrl-C.
    """
    handler = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(handler):
        yield
        return
    signals = []
    signal.signal(signal.SIGINT, lambda *received: signals.append(received))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
        if signals:
            handler(*signals[0])
