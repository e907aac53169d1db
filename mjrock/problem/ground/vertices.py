"""Functions of time that are linear between vertices: instants that do not decrease, with a value each.

An instant that stands twice is a jump, from the first value to the second. Outside the vertices the function is zero.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...quantities import Array

SAME_INSTANT = 1e-12
"""Instants that are closer than this are one, over the last instant [-]."""


class Vertices(NamedTuple):
    """Instants [s], of which the first is zero, and the values at them, both of shape (n,)."""

    times: Array
    values: Array

    def tidied(self) -> Vertices:
        """The same function with two vertices at a jump and one at any other instant, and so at both ends."""
        times = _merged_instants(self.times)
        grows = np.diff(times) > 0
        opens, closes = np.append(True, grows), np.append(grows, True)
        jumps = closes & (self.values != self.values[opens][np.cumsum(opens) - 1]) & (times < times[-1])
        stays = np.where(times == 0, closes, opens | jumps)
        return Vertices(times[stays], self.values[stays])

    def even_step(self, step: float) -> float | None:
        """The step of vertices that are evenly apart, `step` where it is that [s]; None for others."""
        count = np.arange(len(self.times), dtype=float)
        for even in (step, float(self.times[-1] / count[-1])):
            if np.abs(self.times - even * count).max() <= SAME_INSTANT * self.times[-1]:
                return even
        return None

    def sides(self, instants: Array) -> Array:
        """The values just before and just after increasing instants, shape (n, 2)."""
        close = SAME_INSTANT * np.max(instants, initial=self.times[-1])
        near = self.times[np.minimum(np.searchsorted(self.times, instants - close), len(self.times) - 1)]
        instants = np.where(np.abs(near - instants) <= close, near, instants)
        sides = np.zeros((len(instants), 2))
        for column in (0, 1):
            after = np.searchsorted(self.times, instants, "right" if column else "left")
            within = np.flatnonzero((after > 0) & (after < len(self.times)))
            j = after[within]
            share = (instants[within] - self.times[j - 1]) / (self.times[j] - self.times[j - 1])
            sides[within, column] = (1 - share) * self.values[j - 1] + share * self.values[j]
        return sides

    def plus(self, other: Vertices) -> Vertices:
        """The sum of two functions, which jumps where one of them does."""
        instants = _merged_instants(np.sort(np.concatenate((self.times, other.times))))
        values = self.sides(instants) + other.sides(instants)
        return Vertices(np.repeat(instants, 2), values.ravel()).tidied()


def _merged_instants(times: Array) -> Array:
    """Instants that do not decrease. Those that rounding has set apart become the first of them."""
    starts = np.append(True, np.diff(times) > SAME_INSTANT * times[-1])
    return np.asarray(times[starts][np.cumsum(starts) - 1])
