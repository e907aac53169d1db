"""Friction of one line and of a few, one function at a time, against Coulomb's law and the motion of rigid bodies."""

import math

import numpy as np
import pytest
from by_hand import MOVING, about, energy, matrix, system, velocity_at

from mjrock.distinct.contacts import friction
from mjrock.distinct.contacts.faces import Meeting
from mjrock.distinct.system import Books
from mjrock.geometry.vectors import tangent, tangents

NORMAL = {2: np.array([0.6, 0.8]), 3: np.array([0.48, 0.6, 0.64])}
ARM = {2: np.array([0.2, -0.5]), 3: np.array([0.2, 0.3, -0.5])}
OTHER = {2: np.array([-0.1, 0.4]), 3: np.array([-0.1, -0.25, 0.4])}
BOTH = pytest.mark.parametrize("d", [2, 3])
KICK = 0.01


def tangential(d):
    """A unit vector along the face."""
    return np.array([0.8, -0.6]) if d == 2 else np.array([-0.6, 0.0, 0.45]) / 0.75


def listed(whole, line, first, arms, slip, h=0.0):
    """Prepare the friction of a line in all its directions. In a step that is no time bodies turn by nothing."""
    normal = NORMAL[len(whole.axes)]
    friction.list_rigid(whole, line, first, Meeting(0.0, tuple(normal), *map(tuple, arms), False), tuple(slip), h)


def rigid(d, on_face=True, held=1e6):
    """A system with one line that sticks rigidly, at a place of body 1 and of the face of body 0 or of a support."""
    whole = system(d)
    line = whole.lines[0]
    line.body, line.face, line.support, line.friction = 1, 0 if on_face else -1, -1 if on_face else 0, 0.5
    listed(whole, line, 0, (ARM[d], OTHER[d]), slip_of(whole, on_face))
    friction.begin(whole, line, 0, held, KICK, whole.axes)
    return whole


def slip_of(whole, on_face=True):
    """Velocity of the place of body 1 over the face."""
    d = len(whole.axes)
    over = velocity_at(whole.bodies[0], OTHER[d]) if on_face else whole.supports.moving[0]
    slip = velocity_at(whole.bodies[1], ARM[d]) - over
    return slip - NORMAL[d] @ slip * NORMAL[d]


def compliances(whole, on_face=True):
    """Slip along the ways that unit impulses along them make, shape (d - 1, d - 1)."""
    d = len(whole.axes)
    ways, found = whole.tangents["direction"], np.zeros((d - 1, d - 1))
    for body, arm in ((1, ARM[d]), (0, OTHER[d]))[: 2 if on_face else 1]:
        each = whole.bodies[body]
        inverse = each.inverse_inertia if d == 2 else each.inverse_in_world
        levers = np.array([about(arm, way) for way in ways])
        found += ways @ np.diag(each.inverse_mass) @ ways.T + levers @ inverse @ levers.T
    return found


@BOTH
def test_vectors_along_a_face(d):
    a = np.array([0.3, -1.2, 2.1])[:d]
    part = a - NORMAL[d] @ a * NORMAL[d]
    kept = friction.along_face(tuple(NORMAL[d]), tuple(a))
    assert len(kept) == (1 if d == 2 else 3)
    np.testing.assert_allclose(friction.as_vector(tuple(NORMAL[d]), kept), part, rtol=1e-14)
    assert friction.along_face(tuple(NORMAL[d]), kept) == pytest.approx(kept)


@pytest.mark.parametrize("a", [(-3.0,), (3.0,), (-3.0, 4.0), (2.0, -1.0, 2.0)])
def test_a_vector_is_shortened_to_a_limit(a):
    length = math.sqrt(sum(x * x for x in a))
    for limit in (length, 2 * length):
        assert friction.shortened(a, limit) == a
    np.testing.assert_allclose(friction.shortened(a, 0.5), np.multiply(0.5 / length, a), rtol=1e-14)


@BOTH
def test_a_support_carries_the_lines_on_it_alone(d):
    whole = system(d)
    line, way = whole.lines[0], tuple(NORMAL[d])
    assert friction.carried(line, whole.supports, way) == 0.0
    line.support = 0
    assert friction.carried(line, whole.supports, way) == pytest.approx(whole.supports.moving[0] @ way)
    assert np.abs(MOVING).min() > 0


@BOTH
@pytest.mark.parametrize("face", [-1, 0])
@pytest.mark.parametrize(("push", "slides"), [(1e4, False), (3.0, True)])
def test_a_shear_spring_and_its_dashpot_hold_what_the_face_holds(d, face, push, slides):
    """Kept in the axes of the face, the spring is as long along a normal that has turned since, as in the plane. It is
    stretched by the slip and shortened by the slider."""
    whole = system(d)
    line, way, time = whole.lines[0], tangential(d), 0.02
    line.face, line.friction, line.k_s, line.c_s = face, 0.5, 200.0, 3.0
    slip, turn = 0.3 * way, np.eye(d) if face < 0 else matrix(d, 0)
    start = 0.01 * (way + 0.2 * NORMAL[d]) / math.sqrt(1.04)
    if d == 2:
        line.shear_state[0], passed = 0.01, (0.3,)
    else:
        line.shear_state[:], passed = turn.T @ start, tuple(slip)
    drag = friction.sprung_friction(whole.bodies, line, tuple(NORMAL[d]), passed, push, time)
    limit = 0.5 * push
    stretch = min(0.01 + 0.3 * time, limit / 200.0)
    assert (stretch < 0.01 + 0.3 * time) is slides
    held = min(200.0 * stretch + 3.0 * 0.3, limit)
    np.testing.assert_allclose(friction.as_vector(tuple(NORMAL[d]), drag), -held * way, rtol=1e-12, atol=1e-14)
    shear_state = line.shear_state * way if d == 2 else turn @ line.shear_state
    np.testing.assert_allclose(shear_state, stretch * way, rtol=1e-12, atol=1e-16)


@BOTH
def test_a_dashpot_that_is_larger_than_what_the_face_holds_stretches_no_spring(d):
    whole = system(d)
    line, way = whole.lines[0], tangential(d)
    line.friction, line.k_s, line.c_s = 0.5, 200.0, 30.0
    slip = (0.3,) if d == 2 else tuple(0.3 * way)
    drag = friction.sprung_friction(whole.bodies, line, tuple(NORMAL[d]), slip, 4.0, 1e-3)
    assert math.hypot(*drag) == pytest.approx(2.0)
    assert np.linalg.norm(line.shear_state) == pytest.approx(0.3e-3)


@BOTH
@pytest.mark.parametrize("face", [-1, 0])
def test_friction_of_the_last_step_is_that_of_the_spring_or_of_rigid_lines(d, face):
    whole = system(d)
    line, spring = whole.lines[0], (0.7,) if d == 2 else (0.7, -0.2, 0.4)
    line.face, line.shear_state[:] = face, 2.0 if d == 2 else [2.0, -1.0, 0.5]
    found = friction.last_friction(whole.bodies, line, spring)
    turned = line.shear_state if d == 2 or face < 0 else matrix(d, 0) @ line.shear_state
    np.testing.assert_allclose(found, turned, rtol=1e-13)
    line.k_s = 1e6
    assert friction.last_friction(whole.bodies, line, spring) == spring


@pytest.mark.parametrize(
    "normal", [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.48, 0.6, 0.64), (0.6, 0.768, 0.224)]
)
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_ways_along_a_face_are_square_to_it_and_to_each_other(normal, sense):
    normal = sense * np.array(normal)
    first, second = np.array(tangents(tuple(normal)))
    three = np.array([first, second, normal])
    np.testing.assert_allclose(three @ three.T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(np.cross(normal, first), second, atol=1e-14)
    assert tangent((0.6, 0.8)) == (0.8, -0.6)


def test_a_body_that_a_guide_holds_hardly_yields():
    body = system(3).bodies[1]
    body.inverse_mass[:] = [0.5, 0.25, 0.0]
    assert friction.inverse_mass_along(body, (0.6, 0.8, 0.0)) == pytest.approx(0.36 * 0.5 + 0.64 * 0.25)
    assert friction.inverse_mass_along(body, (0.0, 0.0, 1.0)) == friction.COMPLIANCE_OF_GUIDED / 5.0
    body.mass, body.inverse_mass[:] = 1e6, 1e-6
    assert friction.inverse_mass_along(body, (0.6, 0.8, 0.0)) == pytest.approx(1e-6)


@BOTH
@pytest.mark.parametrize("on_face", [True, False])
def test_the_ways_of_a_rigid_line_know_what_an_impulse_does(d, on_face):
    whole = rigid(d, on_face)
    ways, found = whole.tangents, compliances(whole, on_face)
    assert (ways["body"] == 1).all()
    assert (ways["face"] == (0 if on_face else -1)).all()
    assert (ways["support"] == (-1 if on_face else 0)).all()
    np.testing.assert_allclose(ways["compliance"], np.diag(found), rtol=1e-13)
    stops = np.linalg.inv(found)
    np.testing.assert_allclose(ways["stiffness"], np.diag(stops), rtol=1e-13)
    slip = slip_of(whole, on_face)
    slips = [friction.slip_along(whole, row) for row in ways]
    np.testing.assert_allclose(slips, ways["direction"] @ slip, rtol=1e-13)
    if d == 3:
        assert ways["coupling"][0] == pytest.approx(found[0, 1])
        assert ways["shared"][0] == pytest.approx(-stops[0, 1])
    np.testing.assert_allclose(ways["slip"], slips, rtol=1e-13)
    for impulses in (0.3 * np.eye(d - 1)).tolist():
        before = [friction.slip_along(whole, each) for each in ways]
        friction.strike(whole, 0, tuple(impulses))
        after = [friction.slip_along(whole, each) for each in ways]
        np.testing.assert_allclose(np.subtract(after, before), impulses @ found, rtol=1e-12)


@BOTH
@pytest.mark.parametrize("on_face", [True, False])
@pytest.mark.parametrize(("held", "size"), [(1e3, 4.0), (1.0, 1.0)])
def test_a_rigid_line_begins_with_the_friction_of_the_last_step(d, on_face, held, size):
    whole = rigid(d, on_face)
    line, way = whole.lines[0], tangential(d)
    line.shear_state[:] = 4.0 if d == 2 else 4.0 * (matrix(3, 0).T @ way if on_face else way)
    friction.begin(whole, line, 0, held, KICK, whole.axes)
    np.testing.assert_allclose(
        whole.tangents["impulse"] @ whole.tangents["direction"], KICK * size * way, rtol=1e-12, atol=1e-16
    )
    assert (whole.tangents["limit"] == KICK * held).all()


@BOTH
@pytest.mark.parametrize("on_face", [True, False])
def test_a_line_stops_its_slip_where_the_face_holds_it(d, on_face):
    whole = rigid(d, on_face)
    whole.tangents["impulse"] = 0.1 * np.arange(1, d)
    before = whole.tangents["impulse"].copy()
    changed = friction.stop(whole, 0, whole.axes)
    np.testing.assert_allclose(slip_of(whole, on_face), 0.0, atol=1e-14)
    assert changed == pytest.approx(np.abs(whole.tangents["impulse"] - before).max())
    assert changed > 0.1


@BOTH
@pytest.mark.parametrize("on_face", [True, False])
def test_a_line_stops_its_slip_in_the_middle_of_the_step(d, on_face):
    """The arms of bodies that turn are turned by then, and as far back in the middle of the step before."""
    whole, h = rigid(d, on_face), 2e-3

    def slip_with_arms(turned):
        """Slip of the place for arms that have turned for a time [m/s]."""
        slip = -whole.supports.moving[0] * (not on_face)
        for sign, body, arm in ((1, whole.bodies[1], ARM[d]), (-1, whole.bodies[0], OTHER[d]))[: 1 + on_face]:
            turning = velocity_at(body, arm) - body.velocity
            slip = slip + sign * velocity_at(body, arm + turned * turning)
        return whole.tangents["direction"] @ slip

    listed(whole, whole.lines[0], 0, (ARM[d], OTHER[d]), slip_of(whole, on_face), h)
    late, early = slip_with_arms(0.5 * h), slip_with_arms(-0.5 * h)
    np.testing.assert_allclose(whole.tangents["drift"], 0.5 * (late - early), rtol=1e-9)
    assert np.abs(whole.tangents["drift"]).min() > 1e-5
    whole.tangents["limit"] = 1e6
    friction.stop(whole, 0, whole.axes)
    np.testing.assert_allclose(slip_with_arms(0.0), -whole.tangents["drift"], atol=1e-14)


@BOTH
def test_a_line_stops_its_slip_where_the_face_just_holds_it(d):
    for slower in (1.0, 1e-3):
        held = 1e6
        for _ in range(2):
            whole = rigid(d)
            for name in ("velocity", "spin"):
                whole.bodies[name] *= slower
            whole.tangents["limit"] = held
            friction.stop(whole, 0, whole.axes)
            np.testing.assert_allclose(slip_of(whole), 0.0, atol=1e-14)
            held = 1.0001 * np.linalg.norm(whole.tangents["impulse"])


@BOTH
def test_a_line_that_slips_has_what_the_face_holds(d):
    whole = rigid(d, held=20.0)
    slip = slip_of(whole)
    friction.stop(whole, 0, whole.axes)
    impulse, slid = whole.tangents["impulse"] @ whole.tangents["direction"], slip_of(whole)
    assert np.linalg.norm(impulse) == pytest.approx(20.0 * KICK)
    assert np.linalg.norm(slid) < np.linalg.norm(slip)
    for _ in range(200):
        friction.stop(whole, 0, whole.axes)
    impulse, slid = whole.tangents["impulse"] @ whole.tangents["direction"], slip_of(whole)
    np.testing.assert_allclose(impulse, -20.0 * KICK * slid / np.linalg.norm(slid), rtol=1e-9, atol=1e-12)


def test_the_step_towards_sliding_is_that_of_the_loosest_direction():
    """By the larger eigenvalue of what impulses do, with which the search cannot overshoot; shortened where needed."""
    whole = rigid(3)
    whole.bodies["inverse_in_world"] *= 10
    listed(whole, whole.lines[0], 0, (ARM[3], OTHER[3]), slip_of(whole))
    values, directions = np.linalg.eigh(compliances(whole))
    loosest, slip = values[-1], directions @ [0.9, 0.3]  # mostly along the other one
    whole.bodies["velocity"][1] += (slip - whole.tangents["direction"] @ slip_of(whole)) @ whole.tangents["direction"]
    stopping = np.linalg.norm(np.linalg.solve(compliances(whole), slip))
    step = -slip / loosest
    assert np.linalg.norm(step) < 0.8 * stopping
    between = 0.5 * (np.linalg.norm(step) + stopping)
    for limit, expected in ((between, step), (0.5 * between, 0.5 * between * step / np.linalg.norm(step))):
        whole.tangents["limit"] = limit
        np.testing.assert_allclose(friction.stopping(whole, 0, whole.axes), expected, rtol=1e-12)
    whole.tangents["impulse"] = [0.02, -0.05]
    expected = np.array([0.02, -0.05]) - slip / loosest
    expected *= min(1.0, 0.3 * between / np.linalg.norm(expected))
    whole.tangents["limit"] = 0.3 * between
    np.testing.assert_allclose(friction.stopping(whole, 0, whole.axes), expected, rtol=1e-12)


def many(d, held, count=7):
    """Lines of body 1 on body 0 and on the support in turn, at places of their own."""
    whole, random = system(d, count), np.random.default_rng(d)
    for i, line in enumerate(whole.lines):
        line.body, line.face, line.support = 1, -(i % 2), -1 + i % 2
        arms = random.normal(size=(2, d))
        listed(whole, line, (d - 1) * i, arms, np.zeros(d))
        friction.begin(whole, line, (d - 1) * i, held, KICK, whole.axes)
    return whole, np.arange(count)


@BOTH
@pytest.mark.parametrize("held", [1e3, 8.0])
def test_lines_stick_together_and_keep_their_friction(d, held):
    """Where the face holds all of it, the friction stops every slip; it takes energy where it does not."""
    whole, active = many(d, held, 2 if held > 100 else 7)
    before, slips = energy(whole.bodies), [friction.slip_along(whole, row) for row in whole.tangents]
    momentum = whole.bodies["momentum"].copy() if d == 3 else None
    friction.stick(whole, active, len(active), KICK)
    after = [friction.slip_along(whole, row) for row in whole.tangents]
    impulses = whole.tangents["impulse"].reshape(-1, d - 1)
    np.testing.assert_array_less(np.linalg.norm(impulses, axis=1), KICK * held * (1 + 1e-12))
    grips = whole.lines["shear_state"]
    pushed = np.einsum("ij,ijk->ik", impulses, whole.tangents["direction"].reshape(len(active), d - 1, d))
    on_face = whole.lines["face"] >= 0
    turned = grips[on_face] if d == 2 else grips[on_face] @ matrix(3, 0).T
    along = pushed if d == 3 else impulses
    np.testing.assert_allclose(turned, along[on_face] / KICK, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(grips[~on_face], along[~on_face] / KICK, rtol=1e-12, atol=1e-12)
    if held > 100:
        assert np.abs(after).max() < 0.02 * np.abs(slips).max()
    supports = 0.5 * (np.array(slips) + after) @ whole.tangents["impulse"]
    carried = sum(row.impulse * friction.carried(row, whole.supports, tuple(row.direction)) for row in whole.tangents)
    assert energy(whole.bodies) - before == pytest.approx(supports + carried, rel=1e-9)
    assert supports < 0
    if d == 3:
        spins = np.einsum("nij,nj->ni", whole.bodies["inverse_in_world"], whole.bodies["momentum"] - momentum)
        turned = np.einsum("nij,nj->ni", whole.bodies["inverse_in_world"], momentum)
        np.testing.assert_allclose(whole.bodies["spin"], spins + turned, rtol=1e-10, atol=1e-12)


@BOTH
def test_sweeps_end_where_the_impulses_have_settled(d, monkeypatch):
    whole, active = many(d, 1e4, 1)
    calls, stop = [], friction.stop
    monkeypatch.setattr(friction, "stop", lambda *given: calls.append(given[1]) or stop(*given))
    friction.stick(whole, active, 1, KICK)
    assert calls == [0, 0]


@BOTH
def test_each_sweep_takes_every_line_once(d, monkeypatch):
    whole, active = many(d, 8.0)
    calls, stop = [], friction.stop
    monkeypatch.setattr(friction, "stop", lambda *given: calls.append(given[1]) or stop(*given))
    friction.stick(whole, active, 7, KICK)
    assert len(calls) % 7 == 0
    sweeps = np.reshape(calls, (-1, 7))
    for sweep in sweeps:
        assert sorted(sweep) == [(d - 1) * i for i in range(7)]
    np.testing.assert_array_equal(sweeps[2:], sweeps[:-2])  # to and fro
    assert (sweeps[0] != sweeps[1]).any()


@BOTH
def test_a_slow_motion_has_its_impulses_as_exactly_as_a_fast_one(d):
    """At velocities and forces that are a million times smaller they are so, too, to the last bit."""
    impulses = []
    for scale in (1.0, 2.0**-20):
        whole, active = many(d, 8.0 * scale)
        for name in ("velocity", "spin"):
            whole.bodies[name] *= scale
        whole.supports.moving[:] *= scale
        friction.stick(whole, active, 7, KICK)
        impulses.append(whole.tangents["impulse"] / scale)
    np.testing.assert_array_equal(*impulses)


@BOTH
@pytest.mark.parametrize("on_face", [True, False])
def test_the_work_of_rigid_friction_is_booked(d, on_face):
    """With impulses along the mean of the slips, the work is what the bodies lose and the support puts in."""
    whole = rigid(d, on_face, held=20.0)
    books, before = Books.empty(whole, 1), energy(whole.bodies)
    first = np.array([friction.slip_along(whole, row) for row in whole.tangents])
    friction.stop(whole, 0, whole.axes)
    rubbed, put_in = friction.book_rubbing(whole, books, 1)
    total, impulses = books.totals[0], whole.tangents["impulse"]
    assert total.ground - total.friction == pytest.approx(energy(whole.bodies) - before, rel=1e-12)
    carried = 0.0 if on_face else impulses @ whole.tangents["direction"] @ whole.supports.moving[0]
    assert total.ground == pytest.approx(carried)
    assert (rubbed, put_in) == pytest.approx((-0.5 * impulses @ first, 0.5 * carried))
    friction.book_rubbing(whole, books, 1)
    assert books.totals[0].ground == pytest.approx(2 * carried)
