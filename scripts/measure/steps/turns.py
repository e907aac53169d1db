"""Steps of a scene that some threads make in turns with others."""

from __future__ import annotations

import time

import numpy as np

import mjrock as mr
from mjrock.compiled import for_types_of
from mjrock.distinct.loop import Clock, advance
from mjrock.distinct.setup import setup_of
from mjrock.distinct.system import Books, Samples
from mjrock.distinct.thread import threads_of
from mjrock.distinct.thread_pool import ThreadPool
from mjrock.quantities import Array


class Turns:
    """A scene that is followed on by some threads in its turns."""

    def __init__(self, case: mr.MasonryCase, threads: int) -> None:
        setup = setup_of(case, None, None)
        self.system, self.pool = setup.system, ThreadPool(threads)
        self.books = Books.empty(self.system, len(setup.scene.contacts.joints) + 1)
        self.samples = Samples.room(2, self.system, self.books)
        self.clock = Clock(
            h=setup.step_length.default,
            steps_per_sample=10**9,
            stop=1,
            last=10**9,
            ground_acceleration_before=(0.0,) * len(self.system.axes),
            steps_per_check=10**9,
        )
        (alone,), _ = threads_of(self.system.bodies, self.system.lines, 1)
        advance(self.system, self.books, self.samples, self.clock, alone)
        self.clock = self.clock._replace(step=1, sample=1)
        self.steps = for_types_of(advance, self.system, self.books, self.samples, self.clock, alone)

    def seconds(self, count: int) -> float:
        """Time of a step by the clock, from so many of them [s]."""
        begun = time.perf_counter()
        self.clock = self.clock._replace(stop=self.clock.step + count)
        self.pool.run(self.steps, self.system, self.books, self.samples, self.clock)
        self.clock = self.clock._replace(step=self.clock.stop)
        return (time.perf_counter() - begun) / count

    @property
    def place(self) -> Array:
        """Where the blocks are [m]."""
        return np.asarray(self.system.bodies["place"])
