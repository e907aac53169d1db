"""Tasks that workers of the campaign tests import."""

import ctypes
import os
import signal
import sys
import time
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar


@dataclass(frozen=True)
class Square:
    """A task that leaves a mark each time it is done, and dies, fails or waits as told."""

    COLUMNS: ClassVar[tuple[str, ...]] = ("square",)

    number: int
    marks: str = field(default="", compare=False)
    wait: float = field(default=0.0, compare=False)
    deaths: int = field(default=0, compare=False)
    labels: dict = field(default_factory=dict, compare=False)

    def __call__(self, history=None):
        if self.number < 0:
            raise ValueError(f"number = {self.number} is outside the valid range")
        marks = Path(self.marks)
        if self.deaths:
            died = len(list(marks.glob(f"died-{self.number}-*")))
            if died < self.deaths:
                (marks / f"died-{self.number}-{died}").touch()
                os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(self.wait)
        if self.marks:
            with open(marks / f"done-{self.number}", "a") as file:
                file.write("x")
        if history is not None:
            history.touch()
        return {"square": self.number**2}


@dataclass(frozen=True)
class Misbehave:
    """A task that does what its kind says."""

    COLUMNS: ClassVar[tuple[str, ...]] = ("answer",)

    kind: object
    labels: dict = field(default_factory=dict, compare=False)

    def __call__(self, history=None):
        if self.kind == "exit":
            sys.exit("enough")
        if self.kind == "interrupt":
            raise KeyboardInterrupt("by the task")
        if self.kind == "generator":
            raise GeneratorExit
        if self.kind == "columns":
            return {"answer": 1, "other": 2}
        if self.kind == "list":
            return {"answer": [1, 2]}
        if self.kind == "_exit":
            os._exit(3)
        if self.kind == "_exit 0":
            os._exit(0)
        if self.kind == "libc":
            ctypes.CDLL(None).exit(1)
        if self.kind == "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        if self.kind == "sleep":
            Path(f"{history}.{os.getpid()}.partial").write_text("half") if history else None
            time.sleep(20)
        return {"answer": 42}


@dataclass(frozen=True)
class Warn:
    """A task that warns of its number."""

    COLUMNS: ClassVar[tuple[str, ...]] = ("square",)

    number: int
    labels: dict = field(default_factory=dict, compare=False)

    def __call__(self, history=None):
        warnings.warn(f"the number is {self.number}", stacklevel=2)
        return {"square": self.number**2}
