"""How far a campaign is: a bar in a terminal, a line now and then without one."""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from tqdm import tqdm

from .status import closing

EVERY = 30.0
"""Time between two lines of a campaign without a terminal [s]."""
FEWEST = 10
"""Fewest cases of which a rate is said."""


class CampaignProgress:
    """How far a campaign is, on the standard error. Use it in a `with` statement.

    `kept` rows are in the store already, and `total` is how many tasks there are, None if nobody knows.
    """

    def __init__(self, store: Path, kept: int, total: int | None) -> None:
        self.store, self.total = store, total
        self.started = self.spoken = time.monotonic()
        self.first: tuple[int, float] | None = None
        if kept:
            self._say(f"{kept} rows in {store} are kept")
        self.bar = tqdm(total=total, unit="case", desc="campaign", delay=1, disable=None, smoothing=0.05)

    def show(self, skipped: int, finished: int, failed: int) -> None:
        """Show how many tasks had a row already, how many have got one, and how many of these have failed."""
        failures = f"{failed} failed" if failed else ""
        if finished and self.first is None:
            self.first = finished, time.monotonic()
        if not self.bar.disable:
            self.bar.initial = skipped  # what was there already is not part of the rate
            self.bar.set_postfix_str(failures, refresh=False)
            self.bar.update(skipped + finished - self.bar.n)
        elif time.monotonic() - self.spoken >= EVERY:
            self.spoken = time.monotonic()
            of = "" if self.total is None else f" of {self.total}"
            parts = [f"{skipped + finished}{of} cases"]
            if rate := self._rate(finished):
                parts.append(f"{rate:.3g} cases/s")
                if self.total is not None:
                    parts.append(f"{(self.total - skipped - finished) / rate:.0f} s left")
            self._say(", ".join([*parts, failures] if failures else parts))

    def _rate(self, finished: int) -> float:
        """Cases in a second since the first that ended, as workers start for some time; 0 for fewer than FEWEST."""
        if finished < FEWEST or self.first is None or finished == self.first[0] or self.spoken <= self.first[1]:
            return 0.0
        return (finished - self.first[0]) / (self.spoken - self.first[1])

    def close(
        self, skipped: int, statuses: Mapping[str, int], outcomes: Mapping[str, int], warned: Sequence[str]
    ) -> None:
        """Say what was warned of, how many tasks had a row, how the others ended, how long that took, and how many are
        left."""
        self.bar.close()
        for line in warned:
            self._say(line)
        self._say(closing(skipped, statuses, outcomes, time.monotonic() - self.started, self.total))

    def _say(self, text: str) -> None:
        print(f"campaign: {text}", file=sys.stderr, flush=True)

    def __enter__(self) -> CampaignProgress:
        return self

    def __exit__(self, *error: object) -> None:
        self.bar.close()
