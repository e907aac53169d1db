"""The force of one line that has met or left its face inside a step, against the time for which it was closed."""

import math

import pytest

from mjrock.distinct.contacts import touches
from mjrock.distinct.rows import kinds
from mjrock.rows import rows

H, K, C = 0.01, 3e4, 40.0


def line(**numbers):
    """A line of the plane without force."""
    return rows(kinds(2).line, 1, **{"k": K, "c": C} | numbers)[0]


def test_a_line_that_does_no_work_was_open():
    assert touches.was_open(line()) is True
    assert touches.was_open(line(depth=0.5)) is touches.was_open(line(push=0.5)) is False
    assert touches.was_open(line(depth=1.0)) is touches.was_open(line(push=-1.0)) is False


def test_a_rate_is_foreseen_by_how_it_changed_and_how_its_force_has_grown():
    """A force that has more than doubled says no more."""
    before = line(rate=-0.5, push=20.0)
    assert touches.foreseen(before, -0.3, 20.0, 0.5) == pytest.approx(-0.2)
    assert touches.foreseen(before, -0.3, 10.0, 0.5) == pytest.approx(-0.25)
    assert touches.foreseen(before, -0.3, 30.0, 0.5) == pytest.approx(-0.15)
    assert touches.foreseen(before, -0.3, 90.0, 0.5) == pytest.approx(-0.1)


def test_the_time_for_which_a_line_was_closed():
    assert touches.time_closed(line(), -0.001, -0.2, H) == pytest.approx(0.005)
    assert touches.time_closed(line(), -0.002, -0.2, H) == H
    assert touches.time_closed(line(), -0.003, -0.2, H) == H  # it was moved past an end of its face
    assert touches.time_closed(line(depth=0.5), -0.001, -0.2, H) == H
    assert touches.time_closed(line(depth=1.0), -0.001, -0.2, H) == H


@pytest.mark.parametrize("c", [0.0, C])
@pytest.mark.parametrize("tau", [0.2 * H, 0.9 * H])
def test_a_line_that_has_met_its_face_is_given_the_force_of_the_time_since(tau, c):
    """The spring by the impulse k |rate| tau (h - tau) / 2 less, the dashpot for tau and the half step to come."""
    row, rate = line(c=c), -0.2
    sprung, push = touches.touched_forces(row, rate * tau, rate, H)
    mass = 0.5 * K * tau * (H - tau)
    assert H * sprung == pytest.approx(-K * rate * tau * H + mass * rate, rel=1e-12)
    assert H * (push - sprung) == pytest.approx(-c * rate * (tau + 0.5 * H), rel=1e-12, abs=1e-15)
    assert row.due == pytest.approx(-mass, rel=1e-12)


@pytest.mark.parametrize(("gap", "rate"), [(-0.003, -0.2), (-0.002, -0.2), (-0.001, 0.2), (0.0, -0.2)])
def test_a_line_that_has_not_moved_into_its_face_has_the_law(gap, rate):
    row = line()
    law = max(-K * gap, 0.0), max(-K * gap - C * rate, 0.0) if gap < 0 else 0.0
    assert touches.touched_forces(row, gap, rate, H) == pytest.approx(law)
    assert touches.touched_forces(row, gap, rate, 0.0) == pytest.approx(law)
    assert row.due == 0.0


def test_at_a_start_that_no_step_led_to_a_line_has_the_law():
    row = line(depth=0.5)
    assert touches.touched_forces(row, -0.001, -0.2, 0.0) == pytest.approx((30.0, 38.0))
    assert touches.touched_forces(line(depth=0.001, rate=0.1), -0.0002, 0.4, 0.0) == pytest.approx((6.0, 0.0))
    assert row.due == 0.0


def left(depth, rate, before=0.2, c=C, h=H):
    """Of a line that was closed by a depth and has left its face at a rate: the line, its forces and the time since."""
    row = line(depth=depth, rate=before, c=c, push=1.0)
    return row, touches.touched_forces(row, h * rate - depth, rate, h), depth / rate


@pytest.mark.parametrize("since", [0.25 * H, 0.8 * H])
def test_the_spring_of_a_line_that_has_left_takes_back_what_it_pushed_too_long(since):
    """The impulse -m rate with m = k tau (h - tau) / 2, and the dashpot half of what the law would pull."""
    rate = 0.2
    row, (sprung, push), tau = left(rate * since, rate, before=0.1)
    mass = 0.5 * K * tau * (H - tau)
    assert H * sprung == pytest.approx(-mass * rate, rel=1e-12)
    assert row.due == pytest.approx(mass, rel=1e-12)
    held, pull = K * row.depth - C * 0.1, K * (H * rate - row.depth) + C * rate
    assert held > 0
    assert push == pytest.approx(-0.5 / (1 / held + 1 / pull), rel=1e-12)


def test_a_dashpot_that_has_held_the_spring_back_takes_what_it_held():
    """At the pose before, spring and dashpot together did not push."""
    row, (sprung, push), tau = left(0.0005, 0.2, before=0.5)
    assert K * row.depth < C * 0.5
    assert H * sprung == pytest.approx(-K * tau * (H - tau) * 0.2, rel=1e-12)
    assert (push, row.due) == (0.0, 0.0)


@pytest.mark.parametrize("size", [1.0, 1e-3])
def test_a_line_that_ceases_to_press_within_its_face_takes_back_half(size):
    """Closed before and after, where the dashpot would pull: half of the one force and the other in series."""
    law, gap, rate = {"k": size * K, "c": size * C}, -0.0002, 0.4
    row = line(depth=0.001, rate=0.1, **law)
    sprung, push = touches.touched_forces(row, gap, rate, H)
    held, pull = size * (0.001 * K - C * 0.1), size * (K * gap + C * rate)
    assert min(held, pull) > 0
    assert sprung == pytest.approx(-size * K * gap)
    assert push == pytest.approx(-0.5 * held * pull / (held + pull), rel=1e-12)
    assert row.due == 0.0
    row = line(depth=0.001, rate=1.0, **law)  # what did not push before takes nothing back
    assert touches.touched_forces(row, gap, rate, H) == (pytest.approx(-size * K * gap), 0.0)


def test_a_line_that_presses_before_and_after_has_the_law():
    assert touches.touched_forces(line(depth=0.001, rate=0.1), -0.002, 0.1, H) == pytest.approx((60.0, 56.0))
    no_pull = line(depth=0.001, rate=0.1, c=0.0)
    assert touches.touched_forces(no_pull, 0.0, 0.0, H) == (0.0, 0.0)


@pytest.mark.parametrize("depth", [0.003, 0.002])
def test_a_line_that_has_come_to_an_end_of_its_face_is_not_touched(depth):
    """Its gap has grown by more than it has moved, so that nothing pulls back."""
    row = line(depth=depth, rate=0.1)
    assert touches.touched_forces(row, 1.0, 0.2, H) == (0.0, 0.0)
    assert row.due == 0.0


def test_a_gap_that_has_grown_at_an_end_counts_as_far_as_the_line_has_moved():
    row, (_, expected), _ = left(0.001, 0.2, before=0.1)
    at_an_end = line(depth=0.001, rate=0.1)
    _, push = touches.touched_forces(at_an_end, 1.0, 0.2, H)
    assert push == pytest.approx(expected, rel=1e-12)
    assert at_an_end.due == row.due > 0


@pytest.mark.parametrize(
    ("rate", "share"), [(0.3, 0.4), (0.2, 0.5), (0.0, 1.0), (-0.05, 4 / 3), (-0.1, 2.0), (-0.5, 2.0)]
)
def test_what_a_spring_is_due_does_the_work_that_is_missing(rate, share):
    """An impulse at the mean of the rates before and after, m (r - r0) r0 / (r + r0); the mean is taken to be no less
    than a quarter of the rate before."""
    before = 0.2
    impulse = touches.due_impulse(line(due=7.0, rate=before), rate)
    assert impulse == pytest.approx(7.0 * (rate - before) * share, rel=1e-12)
    assert touches.due_impulse(line(due=7.0, rate=-before), -rate) == pytest.approx(-impulse)


def test_what_a_touch_still_does_is_counted_at_a_sample():
    """Half a step of the impulse that is not the law's, of the spring, and of the dashpot where the line has left."""
    row = line(push=50.0, dashpot_force=8.0, depth=0.001, rate=-0.2)
    assert touches.in_transit(row, H) == (pytest.approx(0.5 * H * (50.0 - 8.0 - 30.0) * -0.2), 0.0)
    row.push, row.depth = -20.0, 0.0
    by_spring, by_dashpot = touches.in_transit(row, H)
    assert by_spring == pytest.approx(0.5 * H * -20.0 * -0.2)
    assert by_dashpot == pytest.approx(0.5 * H * -8.0 * -0.2)
    row.push = 0.5
    assert touches.in_transit(row, H) == (pytest.approx(0.5 * H * -7.5 * -0.2), 0.0)
    assert math.isclose(row.rate, -0.2)
