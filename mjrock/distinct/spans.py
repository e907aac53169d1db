"""What a thread does span by span: its bodies and lines, with the books of each span, see `thread`."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from ..compiled import by_type, inlined, method
from ..quantities import Array, Integers
from ..rows import Row, Rows
from .contacts.contact import press_lines
from .system import Books, System, Tables
from .thread import Thread, add_pending_forces, wait

act = method("act")


def _slicer_of(table: Any) -> Callable[..., Any]:
    kind: Any = getattr(table, "instance_class", type(table))
    return _slicer_of_kind(kind)


@cache
def _slicer_of_kind(kind: Any) -> Callable[..., Any]:
    def part(table: Any, first: int, last: int) -> Any:
        count = len(table.rows)
        return kind(table.rows[min(first, count) : min(last, count)])

    return part


rows_within = by_type(_slicer_of)
"""A table with its rows from one number to another, as far as there are any."""


@inlined
def books_of_span(books: Books, span: int, dashpots: Array, active: Integers, touched: Integers) -> Books:
    """The books of a span, with these accounts of dashpots and this room in the lists."""
    totals = books.totals[span : span + 1]
    return Books(
        dashpots=dashpots,
        links=books.links,
        totals=totals,
        active=active,
        touched=touched,
        impulse=books.impulse,
        remaining=books.remaining,
        encounters=books.encounters,
        pending=books.pending,
    )


@inlined
def with_rows(system: System, bodies: Rows, lines: Rows, tangents: Rows) -> System:
    """A system with some of its bodies, lines and tangential directions."""
    return System(
        axes=system.axes,
        bodies=bodies,
        lines=lines,
        edges=system.edges,
        tangents=tangents,
        laws=system.laws,
        links=system.links,
        guided=system.guided,
        ground=system.ground,
        supports=system.supports,
    )


@inlined
def bodies_of_span(system: System, books: Books, thread: Thread, span: int) -> tuple[System, Books]:
    """The bodies of a span, and its books."""
    bodies = system.bodies[thread.bodies[span] : thread.bodies[span + 1]]
    span_books = books_of_span(books, span, books.dashpots, books.active, books.touched)
    return with_rows(system, bodies, system.lines, system.tangents), span_books


@inlined
def books_of_lines(
    system: System, books: Books, thread: Thread, span: int, active: Integers, touched: Integers
) -> Books:
    """The books of a span of lines, with this room in the lists. Lines that share their group with the span before have
    an account of their own, see `Books.encounters`."""
    first, dashpots = thread.lines[span], books.dashpots
    if first > 0 and system.lines[first].group == system.lines[first - 1].group:
        dashpots = books.encounters[span : span + len(dashpots)]
    return books_of_span(books, span, dashpots, active, touched)


@inlined
def press_by_laws(laws: Tables, system: System, books: Books, thread: Thread, t: float, h: float) -> None:
    """Let the laws of joints act on the lines of a thread at a time t, one after the other, and book what the last step
    of length h took."""
    if len(laws) > 0:
        if len(laws[0].rows) > 0:
            for span in range(thread.own_lines[0], thread.own_lines[1]):
                first, last = thread.lines[span], thread.lines[span + 1]
                lines_of_span = with_rows(system, system.bodies, system.lines[first:last], system.tangents)
                span_books = books_of_lines(system, books, thread, span, books.active, books.touched)
                act(rows_within(laws[0], first, last), lines_of_span, span_books, t, h)
            add_pending_forces(thread, books.pending, system.bodies)
            wait(thread)
        press_by_laws(laws[1:], system, books, thread, t, h)


@inlined
def press_spans(system: System, books: Books, thread: Thread, h: float, force_time: float, steps_ahead: float) -> int:
    """`press_lines` for the spans of a thread. Returns how many stick rigidly."""
    active, touched, per_line = 0, 0, len(system.axes) - 1
    start = thread.starts[thread.number]
    for span in range(thread.own_lines[0], thread.own_lines[1]):
        first, last = thread.lines[span], thread.lines[span + 1]
        lines_of_span = with_rows(system, system.bodies, system.lines[first:last], system.tangents[per_line * active :])
        accounts = books_of_lines(system, books, thread, span, books.active[active:], books.touched[start + touched :])
        sticking, met = press_lines(lines_of_span, accounts, h, force_time, steps_ahead)
        for i in range(sticking):
            accounts.active[i] += first
        for i in range(met):
            accounts.touched[i] += first
        active, touched = active + sticking, touched + met
    thread.touched[thread.number] = touched
    return active


@inlined
def list_touched(books: Books, thread: Thread) -> int:
    """How many lines of all threads have met or left their face. The first thread lists them in their order."""
    count = 0
    for number in range(thread.threads):
        start = thread.starts[number]
        for i in range(thread.touched[number] if thread.number == 0 else 0):
            books.touched[count + i] = books.touched[start + i]
        count += thread.touched[number]
    return count


@inlined
def sum_up(system: System, books: Books) -> None:
    """Add up what has been booked span by span."""
    for span in range(1, len(books.totals)):
        move_work(books.totals[0], books.totals[span])
    if len(system.lines) > 0:
        group = system.lines[len(system.lines) - 1].group
        for account in range(group + 1, len(books.encounters)):
            books.dashpots[group] += books.encounters[account]
            books.encounters[account] = 0.0


@inlined
def move_work(total: Row, part: Row) -> None:
    """Add what a row of totals has booked to another, and let it begin anew."""
    total.friction, total.ground = total.friction + part.friction, total.ground + part.ground
    total.tension, total.slip = total.tension + part.tension, total.slip + part.slip
    total.crushing = total.crushing + part.crushing
    total.joint_ends = total.joint_ends + part.joint_ends
    total.encounter_ends = total.encounter_ends + part.encounter_ends
    part.friction = part.ground = part.tension = part.slip = part.crushing = 0.0
    part.joint_ends = part.encounter_ends = 0.0
