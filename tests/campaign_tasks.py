"""Tasks that workers of the campaign tests import."""

import os
import signal
import time
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
        return {"square": self.number**2}
