"""Threads of one run: who presses which lines and moves which bodies, and where all wait for each other.

Lines and bodies are divided into spans, which do not depend on how many threads there are. Each thread has some spans
one after the other. What is booked is summed span by span, and then over the spans in their order. A body that lines of
two threads press on gets the forces of its lines when all have pressed, in the order of the lines. So any number of
threads gives the same bits.

What only one thread can do, such as the links, the first one does while the others wait.
"""

from __future__ import annotations

import ctypes
import sys
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..compiled import by_type, called, inlined
from ..geometry.vectors import Vector, increase, minus, moment, put, read, scaled
from ..quantities import Integers
from ..rows import Row, Rows, rows
from .rows import kinds

LINES_TOGETHER, BODIES_TOGETHER = 512, 256
"""Lines and bodies of a span."""
GATE_ARRIVALS, GATE_ROUNDS, GATE_END = 0, 8, 16
"""Places of the gate: threads that have arrived, how often all have, and 1 when the run has ended. Each has a line of
the cache of its own."""
LOOKS_AT_GATE = 2000
"""How often a thread looks whether all have arrived before it lets others have its core."""


class Thread(NamedTuple):
    """A thread among those of a run.

    Args:
        number, threads: of the thread, and how many there are.
        lines, bodies: where each span begins, and where the last one ends.
        own_lines, own_bodies: numbers of its first span, and of that after its last one.
        own_apart: its first row of the forces that wait, and that after its last one.
        starts: the first line of each thread.
        touched: how many lines of each thread have met or left their face.
        gate: where threads wait for each other.
        pause: address of the function of C that lets other threads have the core.
    """

    number: int
    threads: int
    lines: Integers
    bodies: Integers
    own_lines: tuple[int, int]
    own_bodies: tuple[int, int]
    own_pending: tuple[int, int]
    starts: Integers
    touched: Integers
    gate: Integers
    pause: int


def threads_of(bodies: Rows, lines: Rows, count: int) -> tuple[tuple[Thread, ...], Rows]:
    """A number of threads for these bodies and lines, and room for the forces that wait, see `pending_forces`."""
    spans, of_bodies = spans_of(lines), spans_of_bodies(bodies)
    parts, parts_of_bodies = ([i * (len(ends) - 1) // count for i in range(count + 1)] for ends in (spans, of_bodies))
    pending = pending_forces(bodies, lines, spans[parts])
    first = (1 + pending["body"][1:].searchsorted(of_bodies[parts_of_bodies])).tolist()
    touched, gate = np.zeros(count, dtype=np.int64), np.zeros(GATE_END + 1, dtype=np.int64)
    shared = spans[parts[:-1]], touched, gate, yielding()
    own_lines, own_bodies, own_pending = (list(pairwise(ends)) for ends in (parts, parts_of_bodies, first))
    threads = [
        Thread(i, count, spans, of_bodies, own_lines[i], own_bodies[i], own_pending[i], *shared) for i in range(count)
    ]
    return tuple(threads), pending


def spans_of(lines: Rows) -> Integers:
    """Where each span of lines begins, and where the last one ends. Lines of one joint are not parted, so that no two
    threads book on one account. Those that a search has found follow them, with an account for each span."""
    count, joints, cuts = len(lines), int(np.count_nonzero(lines["sense"])), [0]
    if joints > LINES_TOGETHER:
        starts = np.append(np.flatnonzero(np.diff(lines["group"][:joints], prepend=-1)), joints)
        cuts = starts[np.searchsorted(starts, np.arange(0, joints, LINES_TOGETHER))].tolist()
    return np.array(sorted({*cuts, *range(joints, count, LINES_TOGETHER), count}))


def spans_of_bodies(bodies: Rows) -> Integers:
    """Where each span of bodies begins, and where the last one ends."""
    return np.array([*range(0, len(bodies), BODIES_TOGETHER), len(bodies)])


def pending_forces(bodies: Rows, lines: Rows, parts: Integers) -> Rows:
    """Room for the forces on bodies that lines of two threads press on, body by body in the order of the lines. The
    first row is not used.

    Args:
        bodies, lines: all of them. Lines get the number of their row for their body and for that of their face, 0 where
            their force need not wait.
        parts: where the lines of each thread begin, and where those of the last one end.
    """
    row_type = kinds(bodies["rest"].shape[1]).pending
    if len(parts) == 2:  # one thread
        lines["pending"] = lines["face_pending"] = 0
        return rows(row_type, 1, body=-1)
    thread = np.repeat(np.arange(len(parts) - 1), np.diff(parts))
    sides = np.column_stack([lines["body"], lines["face"]]).ravel()
    first, last = np.full(len(bodies), len(parts)), np.full(len(bodies), -1)
    pressed_sides = np.flatnonzero(sides >= 0)
    np.minimum.at(first, sides[pressed_sides], thread[pressed_sides // 2])
    np.maximum.at(last, sides[pressed_sides], thread[pressed_sides // 2])
    waits = pressed_sides[(first < last)[sides[pressed_sides]]]
    waits = waits[np.argsort(sides[waits], kind="stable")]
    numbers = np.zeros(2 * len(lines), dtype=np.int32)
    numbers[waits] = 1 + np.arange(len(waits))
    lines["pending"], lines["face_pending"] = numbers[::2], numbers[1::2]
    return rows(row_type, 1 + len(waits), body=np.append(-1, sides[waits]))


@cache
def yielding() -> int:
    """Address of the function of C that lets other threads have the core."""
    if sys.platform == "win32":
        function = ctypes.WinDLL("kernel32").SwitchToThread
    else:
        function = ctypes.CDLL(None).sched_yield
    return int(ctypes.cast(function, ctypes.c_void_p).value or 0)


@inlined
def add_force(body: Row, arm: Vector, force: Vector) -> None:
    """Add a force at an arm from the centroid of a body [N]."""
    increase(body.force, force)
    increase(body.moment, moment(arm, force))


@inlined
def add_line_force(pending: Rows, bodies: Rows, line: Row, arms: tuple[Vector, Vector], force: Vector) -> None:
    """Add the force of a line on its body and on that of its face [N], or let it wait.

    Args:
        pending: forces that wait.
        bodies, line: the bodies, and the line.
        arms: from the two centroids to where the force acts [m].
        force: on the body of the line.
    """
    if line.pending > 0:
        add_force(pending[line.pending], arms[0], force)
    else:
        add_force(bodies[line.body], arms[0], force)
    if line.face >= 0:
        if line.face_pending > 0:
            add_force(pending[line.face_pending], arms[1], scaled(-1.0, force))
        else:
            add_force(bodies[line.face], arms[1], scaled(-1.0, force))


@inlined
def add_pending_forces(thread: Thread, pending: Rows, bodies: Rows) -> None:
    """Add the forces that wait to those of their bodies, when all threads have pressed."""
    wait(thread)
    for i in range(thread.own_pending[0], thread.own_pending[1]):
        row = pending[i]
        body, force, turning = bodies[row.body], read(row.force), read(row.moment)
        increase(body.force, force)
        increase(body.moment, turning)
        put(row.force, minus(force, force))
        put(row.moment, minus(turning, turning))


def _atomic_call(name: str) -> object:
    def by_one_thread(gate: Integers, *arguments: int) -> int:
        return 0

    def chosen(gate: object) -> object:
        if isinstance(gate, np.ndarray):
            return by_one_thread  # plain Python has one thread
        from . import atomics  # which imports numba

        return getattr(atomics, name)

    return chosen


add, look, give_way = (by_type(_atomic_call(name)) for name in ("add", "look", "give_way"))  # type: ignore[arg-type]


@inlined
def wait(thread: Thread) -> None:
    """Wait until all threads are here. What each has written, all can read then."""
    if thread.threads > 1:
        meet_others(thread.gate, thread.threads, thread.pause)


@called
def meet_others(gate: Integers, threads: int, pause: int) -> None:
    """Wait at a gate for the other threads."""
    turn = look(gate, GATE_ROUNDS)
    if add(gate, GATE_ARRIVALS, 1) == threads - 1:
        add(gate, GATE_ARRIVALS, -threads)
        add(gate, GATE_ROUNDS, 1)
    else:
        looks = 0
        while look(gate, GATE_ROUNDS) == turn:
            looks += 1
            if looks > LOOKS_AT_GATE:
                give_way(gate, pause)


@inlined
def end_all(thread: Thread) -> None:
    """End the run for all threads, which see it when they have waited."""
    thread.gate[GATE_END] = 1


@inlined
def has_ended(thread: Thread) -> bool:
    """Whether the run has ended."""
    return bool(thread.gate[GATE_END] == 1)
