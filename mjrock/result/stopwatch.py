"""How long a solver took."""

from __future__ import annotations

import time


class Stopwatch:
    """Times since it was made [s]: on the clock, and of this thread on the processor."""

    def __init__(self) -> None:
        self._began = time.perf_counter(), time.thread_time()

    def took(self, wall: str = "wall_time", processor: str = "processor_time") -> dict[str, float]:
        """The two times under their names in the `stats` of a response."""
        return {wall: time.perf_counter() - self._began[0], processor: time.thread_time() - self._began[1]}

    def stepping(self) -> dict[str, float]:
        """The two times as those of the steps alone."""
        return self.took("stepping_time", "stepping_processor_time")
