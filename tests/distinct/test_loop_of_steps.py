"""The steps, in plain Python: leapfrog steps have motions and energies that are known to the last digits."""

import math

import numpy as np
import pytest
from by_hand import INERTIAS, MASSES, SPIN, VELOCITY, alone, matrix, system

import mjrock as mr
from mjrock.distinct import loop
from mjrock.distinct.kinds.actuators import Actuators
from mjrock.distinct.kinds.lists import numbered
from mjrock.distinct.kinds.ties import Ties
from mjrock.distinct.loop import Clock
from mjrock.distinct.rows import DISSIPATED_BY_LAWS
from mjrock.distinct.supports import Supports
from mjrock.distinct.system import Books, Samples
from mjrock.scene.course import Ground, ground_velocity

BOTH = pytest.mark.parametrize("d", [2, 3])
G, H = mr.GRAVITY, 0.01
RECORDS = [mr.GroundMotion(np.array(a), 0.04) for a in ([0.3, -0.5, 1.0], [-0.3, 0.9, 1.2], [0.6, 0.2, -0.8])]


def ground(d):
    """The ground moves along every axis of the system."""
    return Ground.from_motions(RECORDS[0], RECORDS[1], RECORDS[2] if d == 3 else None)


def moved(d, t):
    """Its velocity at a time [m/s]."""
    of = ground(d)
    return np.array([ground_velocity(one, t) for one in ((of.x, of.z) if d == 2 else (of.x, of.y, of.z))])


def no_supports(d):
    return Supports(np.empty(0), np.empty((0, d)), np.zeros(1, dtype=int), np.empty((0, d)), np.empty((0, d)))


def flying(d, lines=0):
    """Two bodies in flight over a ground that moves, and in space with the inertia of a sphere."""
    whole = system(d, lines)
    if d == 3:
        whole.bodies["inverse_inertia"] = whole.bodies["inverse_in_world"] = 0.25 * np.eye(3)
        whole.bodies["momentum"] = SPIN / 0.25
    return whole._replace(ground=ground(d), supports=no_supports(d))


def room(whole, count, ledger=True, checks=2, groups=3):
    account = Books.empty(whole, groups)
    return account, Samples.room(count, whole, account, ledger=ledger, checks=checks)


def clock(d, stop, **more):
    """Steps from the start, a sample of each, and none after `stop`."""
    start = {"h": H, "steps_per_sample": 1, "last": 999, "ground_acceleration_before": (0.0,) * d}
    return Clock(**start | {"stop": stop} | more)


def total(samples, count):
    """Energy of a ledger, which stays [J], shape (count,). Among the accounts of links is what is driven."""
    each = samples.energy[:count]
    held = each["kinetic"] + each["potential"] + each["elastic"] + each["friction"]
    accounts = sum(part[:count].sum(axis=1) for part in (samples.dashpots, samples.links))
    return held + accounts - each["ground"] - 2 * each["driven"]


def advanced(whole, *given):
    """The steps as plain Python, by one thread."""
    return loop.advance.py_func(whole, *given, alone(whole))


@BOTH
def test_bodies_in_flight_have_the_motion_of_weight_and_ground(d):
    """Half a step after each pose the velocity is exact, and the poses are their sum. The energy stays."""
    whole, count = flying(d), 9
    which = [0, 2] if d == 2 else [0, 1, 2]
    place, velocity = whole.bodies["place"].copy(), VELOCITY[:, which]
    spins = whole.bodies["spin"].copy()
    account, samples = room(whole, count, checks=5)
    ended = advanced(whole, account, samples, clock(d, count, last=count - 1, steps_per_check=2))
    assert ended == (count, count, False)
    up = np.eye(d)[-1]
    before = velocity
    for n in range(count):
        after = velocity - moved(d, (n + 0.5) * H) - G * (n + 0.5) * H * up
        np.testing.assert_allclose(samples.pose[n, :, :d], place, rtol=1e-12)
        mean = velocity if n == 0 else 0.5 * (before + after)
        np.testing.assert_allclose(samples.velocity[n, :, :d], mean, rtol=1e-12)
        kinetic = 0.5 * MASSES @ (after * (2 * velocity - after if n == 0 else before)).sum(axis=1)
        squares = (spins**2).sum(axis=1) / (0.25 if d == 3 else whole.bodies["inverse_inertia"][:, 0, 0])
        assert samples.energy[n].kinetic == pytest.approx(kinetic + 0.5 * squares.sum(), rel=1e-12)
        assert samples.energy[n].potential == pytest.approx(G * MASSES @ place[:, -1], rel=1e-12)
        place, before = place + H * after, after
    if d == 2:
        angles = np.array([0.7, -0.4]) + H * np.outer(np.arange(count), spins[:, 0])
        np.testing.assert_allclose(samples.pose[:count, :, 2], angles, rtol=1e-12)
    own = [spins[i] if d == 2 else matrix(3, i).T @ spins[i] for i in range(2)]  # a sphere keeps its spin in its axes
    np.testing.assert_allclose(samples.velocity[:count, :, d:], np.tile(own, (count, 1, 1)), rtol=1e-10)
    np.testing.assert_allclose(total(samples, count), total(samples, 1)[0], rtol=1e-12)
    for name in samples.energy.dtype.names:
        np.testing.assert_array_equal(samples.checks[name], samples.energy[name][:count:2])


@BOTH
def test_a_run_goes_on_from_a_step_before(d):
    """Its velocities are half that step before the pose, and the ground has moved the bodies since."""
    whole, before, pushed = flying(d), 0.004, (0.3, -0.7, 0.5)[:d]
    velocity, (account, samples) = whole.bodies["velocity"].copy(), room(whole, 1)
    advanced(whole, account, samples, clock(d, 1, h_before=before, ground_acceleration_before=pushed))
    changed = -moved(d, 0.5 * H) - 0.5 * before * np.array(pushed) - G * 0.5 * (before + H) * np.eye(d)[-1]
    np.testing.assert_allclose(whole.bodies["velocity"], velocity + changed, rtol=1e-12)
    np.testing.assert_allclose(samples.velocity[0, :, :d], velocity + 0.5 * changed, rtol=1e-12)


@BOTH
def test_a_run_in_two_parts_is_that_in_one(d):
    """Samples of every third step and of the last, checks of every second one and of the last."""
    runs, numbers = [], []
    for parts in ([8], [4, 8], [1, 2, 3, 5, 8]):
        whole = flying(d)
        account, samples = room(whole, 4, checks=6)
        step = row = 0
        for stop in parts:
            every = {"steps_per_sample": 3, "steps_per_check": 2}
            options = {"step": step, "sample": row, "last": 7} | every
            step, row, ended = advanced(whole, account, samples, clock(d, stop, **options))
            assert not ended
            numbers.append((step, row))
        runs.append(samples)
    assert numbers == [(8, 4), (4, 2), (8, 4), (1, 1), (2, 1), (3, 1), (5, 2), (8, 4)]
    for run in runs[1:]:
        np.testing.assert_array_equal(run.pose[:4], runs[0].pose[:4])
        np.testing.assert_array_equal(run.energy[:4], runs[0].energy[:4])
        np.testing.assert_array_equal(run.checks, runs[0].checks)
    whole = flying(d)
    account, all_samples = room(whole, 8)
    advanced(whole, account, all_samples, clock(d, 8, last=7))
    np.testing.assert_array_equal(runs[0].pose[:4], all_samples.pose[[0, 3, 6, 7]])
    np.testing.assert_array_equal(runs[0].energy[:4], all_samples.energy[[0, 3, 6, 7]])
    np.testing.assert_array_equal(runs[0].checks["kinetic"][:5], all_samples.energy["kinetic"][[0, 2, 4, 6, 7]])


@BOTH
def test_a_check_leaves_the_samples_as_they_are(d):
    """That of the fifth step, after the sample of the fourth one."""
    runs = []
    for options in ({"steps_per_sample": 3, "steps_per_check": 2}, {"steps_per_sample": 3}):
        whole = flying(d)
        account, samples = room(whole, 2, checks=3)
        advanced(whole, account, samples, clock(d, 6, **options))
        runs.append(samples)
    for one, other in zip(runs[0][:3], runs[1][:3], strict=True):
        np.testing.assert_array_equal(one[:2], other[:2])
    assert (runs[0].checks["kinetic"] != 0).all()


@BOTH
def test_a_run_ends_where_a_body_is_astray(d):
    whole = flying(d)
    whole.bodies["velocity"][1, -1] = 1e8
    account, samples = room(whole, 5)
    assert advanced(whole, account, samples, clock(d, 5, last=4)) == (1, 2, True)


@pytest.mark.parametrize(("lost", "astray"), [(0.99e6, False), (1e6, True), (-1.1e6, True), (math.nan, True)])
def test_a_body_is_astray_beyond_a_million_metres_or_where_a_run_follows_no_rotation(lost, astray):
    for d in (2, 3):
        for axis in range(d):
            bodies = system(d).bodies
            bodies["place"][1, axis] = lost
            assert loop.is_astray(bodies, math.inf) is astray
    bodies = system(2).bodies
    assert [loop.is_astray(bodies, ends) for ends in (0.71, 0.69)] == [False, True]


def test_unless_it_is_asked_to_a_run_damps_nothing_and_looks_not_ahead():
    asked_nothing = clock(2, 1)
    assert (asked_nothing.steps_ahead, asked_nothing.mass_damping, asked_nothing.local_damping) == (0.0, 0.0, 0.0)


@BOTH
@pytest.mark.parametrize(("drag", "local"), [(0.0, 0.0), (0.4, 0.0), (0.0, 0.2)])
def test_a_motion_is_slowed_down_as_it_is_asked_to(d, drag, local):
    """Mass-proportional damping lets velocities decay; local damping takes a share of a force against the motion."""
    whole = flying(d)._replace(ground=Ground.from_motions(None))
    velocity = whole.bodies["velocity"].copy()
    account, samples = room(whole, 4)
    advanced(whole, account, samples, clock(d, 4, mass_damping=drag, local_damping=local))
    for n in range(4):
        kick = H if n else 0.5 * H
        weight = -G * (1 + local * np.sign(velocity[:, -1]))
        velocity[:, -1] += kick * weight
        velocity *= math.exp(-drag * kick)
    np.testing.assert_allclose(whole.bodies["velocity"], velocity, rtol=1e-12)
    assert (account.dashpots[-1] != 0) == (drag + local > 0)
    assert (account.dashpots[:-1] == 0).all()


def striking(d, *, height=0.02, face=False, friction=0.4, k_s=math.inf, c=5.0, fall=-0.5):
    """Two bodies that do not turn. One falls on a support, or both: that moves to and fro and up and down, in steps.

    A third line is of no joint and presses nothing.
    """
    whole = system(d, 2, still=True)
    bodies = whole.bodies
    bodies["inverse_inertia"] = bodies["spin"] = 0.0
    if d == 3:
        bodies["inverse_in_world"] = bodies["momentum"] = 0.0
    bodies["velocity"][:, :-1], bodies["velocity"][:, -1] = 0.7, [fall, fall - 0.4]
    for i, line in enumerate(whole.lines):
        line.body, line.face = i, 0 if face and i else -1
        line.support = -1 if line.face == 0 else 0
        line.normal, line.between, line.at[0], line.group = (
            np.eye(d)[-1],
            height * (1 + 0.3 * i) * np.eye(d)[-1],
            0.1,
            i,
        )
        line.k, line.c, line.friction, line.k_s, line.c_s = 2e3, c, friction, k_s, 3.0 if k_s < math.inf else 0.0
    way = np.zeros((3, d))
    way[:, 0], way[:, -1] = [0.0, 0.1, 0.0], [0.0, 0.03, -0.05]
    times, none = np.array([0.0, 0.2, 0.5]), np.zeros((1, d))
    return whole._replace(ground=ground(d), supports=Supports(times, way, np.array([0, 3]), none, none.copy()))


@BOTH
@pytest.mark.parametrize(
    ("face", "law"),
    [
        (False, {}),
        (True, {}),
        (False, {"k_s": 5000.0}),
        (False, {"c": 0.0}),
        (True, {"height": -0.02, "friction": 0.0}),
    ],
)
def test_the_energy_of_bodies_that_strike_and_slide_is_that_of_the_accounts(d, face, law):
    """Bodies fall on a support that moves and rub on it; or one on the other one. What the touches leave is small."""
    (whole, count), names = (striking(d, face=face, **law), 16), ("kinetic", "elastic", "friction")
    account, samples = room(whole, count)
    advanced(whole, account, samples, clock(d, count, last=count - 1))
    ledger, (kinetic, elastic, friction) = total(samples, count), (samples.energy[name][:count].max() for name in names)
    np.testing.assert_allclose(ledger, ledger[0], rtol=0, atol=1e-8 * kinetic)
    assert elastic > 0.1
    assert (friction > 0.01) == (law.get("friction", 1.0) > 0)
    assert (samples.dashpots[:count].sum(axis=1).max() > 0.1) == (law.get("c", 5.0) > 0)


@BOTH
@pytest.mark.parametrize("ledger", [False, True])
def test_what_friction_takes_is_kept_where_there_is_a_ledger_or_a_support(d, ledger):
    """Without both, that of shear springs alone."""
    whole = striking(d)
    whole.lines["support"], whole.lines["group"] = -1, 0
    whole = whole._replace(supports=no_supports(d))
    account, samples = room(whole, 9, ledger=ledger, groups=1)
    advanced(whole, account, samples, clock(d, 9, last=8))
    assert (samples.energy["friction"][8] > 0.1) == ledger
    other = striking(d)
    account, samples = room(other, 9, ledger=False)
    advanced(other, account, samples, clock(d, 9, last=8))
    assert samples.energy["friction"][8] > 0.1


@BOTH
def test_links_act_and_are_booked_at_the_time_of_the_pose(d):
    """An actuator drives one of the bodies along a history."""
    whole, count = flying(d), 31
    whole = whole._replace(ground=Ground.from_motions(None))
    whole.bodies["inverse_inertia"] = 0.0
    whole.bodies["spin"] = 0.0
    if d == 3:
        whole.bodies["momentum"] = 0.0
    along = np.eye(d)[0]
    drive = Actuators.table(d, 1, body=0, k=300.0, c=2.0, between=along)
    history = np.array([[0.0], [0.1], [0.02]])
    drives = Supports(np.array([0.0, 0.1, 0.3]), history, np.array([0, 3]), np.zeros((1, 1)), np.zeros((1, 1)))
    whole = whole._replace(links=numbered((Actuators(drive, drives),)))
    whole.bodies["place"] = 0.0
    account, samples = room(whole, count)
    advanced(whole, account, samples, clock(d, count, last=count - 1))
    pose = samples.pose[:count, 0, 0]
    pulled = samples.link_forces[:count, 0]
    target = np.interp(H * np.arange(count), [0.0, 0.1, 0.3], history[:, 0])
    moving = np.diff(target, prepend=0.0) / H
    after = np.diff(pose) / H
    rates = np.concatenate([[0.0 - 0.7], moving[1:] - after])
    np.testing.assert_allclose(pulled, 300.0 * (target - pose) + 2.0 * rates, rtol=1e-9)
    np.testing.assert_allclose(np.diff(after), H * pulled[1:-1] / MASSES[0], rtol=1e-9)
    np.testing.assert_allclose(total(samples, count), total(samples, 1)[0], rtol=1e-10)
    assert samples.energy["driven"][count - 1] == samples.links[count - 1, 0] != 0.0


@BOTH
def test_a_tie_breaks_when_a_body_has_fallen_so_far(d):
    """On a straight line, by what its spring and its yielding let it."""
    whole, count, up = flying(d), 31, np.eye(d)[-1]
    law = {"k": 300.0, "strength": 1.0, "ultimate": 0.05, "reach": 1.0, "broken": math.inf}
    tie = Ties.table(d, 1, body=1, between=-up, **law)
    whole = whole._replace(ground=Ground.from_motions(None), links=numbered((Ties(tie),)))
    for name in ("place", "velocity", "spin", "inverse_inertia"):
        whole.bodies[name][1] = 0.0
    if d == 3:
        whole.bodies["momentum"][1] = 0.0
    account, samples = room(whole, count)
    advanced(whole, account, samples, clock(d, count, last=count - 1))
    fallen = -samples.pose[:count, 1, d - 1]
    broken = np.interp(1.0 / 300.0 + 0.05, fallen, H * np.arange(count))
    np.testing.assert_allclose(tie[0].broken, broken, atol=1e-4)
    assert account.links[0] == pytest.approx(0.05)
    np.testing.assert_allclose(total(samples, count), total(samples, 1)[0], atol=1e-3)


@BOTH
def test_forces_start_with_weight_and_the_ground(d):
    whole, account, before = system(d), Books.empty(system(d), 2), 0.02
    push, last = np.array([0.3, -0.7, 0.5])[:d], np.array([-0.2, 0.4, 0.1])[:d]
    turns, spins = whole.bodies["rotation"].copy(), whole.bodies["spin"].copy()
    whole.bodies["rotation"], whole.bodies["moment"], whole.bodies["force"] = 9.0, 9.0, 9.0
    if d == 3:
        inverse, whole.bodies["inverse_in_world"] = whole.bodies["inverse_in_world"].copy(), 9.0
    account.totals[0].ground_acceleration, account.totals[0].ground = last, 0.5
    loop.start_forces(whole, account, tuple(push), before)
    np.testing.assert_allclose(whole.bodies["force"], -np.outer(MASSES, push + G * np.eye(d)[-1]), rtol=1e-13)
    assert not whole.bodies["moment"].any()
    np.testing.assert_allclose(whole.bodies["rotation"], turns, rtol=1e-13)
    np.testing.assert_allclose(whole.bodies["spin"], spins, rtol=1e-12)
    if d == 3:
        np.testing.assert_allclose(whole.bodies["inverse_in_world"], inverse, rtol=1e-13)
    work = -before * MASSES @ whole.bodies["velocity"] @ (0.5 * (push + last))
    assert account.totals[0].ground == pytest.approx(0.5 + work, rel=1e-12)
    np.testing.assert_array_equal(account.totals[0].ground_acceleration, push)


@BOTH
@pytest.mark.parametrize("ledger", [False, True])
def test_springs_hold_energy_at_a_sample_and_accounts_are_kept(d, ledger):
    """Along the normal with what a touch still does, along the face, where it is no friction yet, and of bonds."""
    whole, before = system(d, 3), 0.02
    account = Books.empty(whole, 1)
    samples = Samples.room(2, whole, account, ledger=ledger)
    lines, shear_state = whole.lines, np.arange(9.0).reshape(3, 3)[:, : 2 * d - 3] * 1e-3
    lines["k"], lines["depth"], lines["push"], lines["dashpot_force"] = (
        2e3,
        [0.01, 0.0, 0.0],
        [27.0, -6.0, 0.0],
        [3.0, 0.0, 9.0],
    )
    lines["rate"], lines["shear_state"], lines["k_s"] = 0.5, shear_state, [math.inf, 400.0, 500.0]
    bond = whole.laws[0].rows[0]
    bond.k, bond.secant, bond.gap, bond.k_s, bond.shear_state[:] = 1.0, 900.0, -0.02, 300.0, 2e-3
    account.totals[0].friction, account.totals[0].ground = 7.0, 5.0
    account.dashpots[:] = 11.0
    for name, taken in zip(DISSIPATED_BY_LAWS, range(1, 6), strict=True):
        account.totals[0][name] = taken
    loop.record_pose(whole, account, samples, 1, before)
    squares = (shear_state**2).sum(axis=1)
    sheared = 0.5 * (400.0 * squares[1] + 500.0 * squares[2] + 300.0 * 4e-6 * (2 * d - 3))
    late = 0.5 * before * 0.5 * np.array([27.0 - 3.0 - 20.0, -6.0])
    sample = samples.energy[1]
    assert sample.elastic == pytest.approx(0.1 + late.sum() + 0.5 * 900.0 * 4e-4 + sheared, rel=1e-12)
    assert sample.friction == pytest.approx(7.0 - sheared, rel=1e-12)
    assert (sample.ground, sample.driven, sample.potential) == (5.0, 0.0, 0.0)
    assert [sample[name] for name in DISSIPATED_BY_LAWS] == [1.0, 2.0, 3.0, 4.0, 5.0]
    lines["push"][1], lines["dashpot_force"][1] = -6.0, -2.0  # the dashpot pulls
    loop.record_pose(whole, account, samples, 0, before)
    by_spring = 0.5 * before * (-6.0 + 2.0) * 0.5
    assert samples.energy[0].elastic == pytest.approx(sample.elastic, rel=1e-12)
    assert samples.dashpots[:2].tolist() == (
        [[pytest.approx(11.0 + by_spring - late[1])], [11.0]] if ledger else [[], []]
    )


@BOTH
@pytest.mark.parametrize("before", [0.0, 0.5])
def test_kept_velocities_are_those_of_the_pose_and_the_energy_is_that_of_the_steps(d, before):
    """A spin in the axes of the body from the mean momentum, and half the products of velocity and momentum before and
    after; a start has before it what it has after it."""
    whole = system(d)
    account, samples = room(whole, 1)
    bodies, random = whole.bodies, np.random.default_rng(d)
    first, then = bodies["velocity"].copy(), random.normal(size=bodies["velocity"].shape)
    inverse = 1 / INERTIAS[:, 1, 1].reshape(2, 1, 1) if d == 2 else bodies["inverse_in_world"].copy()
    momentum = np.linalg.solve(inverse, bodies["spin"][:, :, None])[:, :, 0]
    turned = random.normal(size=momentum.shape)
    samples.energy[0].potential = 3.0
    loop.record_pose(whole, account, samples, 0, before)
    bodies["velocity"] = then
    if d == 2:
        bodies["spin"] = turned * inverse[:, 0]
    else:
        bodies["momentum"] = turned
    loop.record_velocity(bodies, samples, 0, before)
    mean, mean_momentum = (0.5 * (first + then), 0.5 * (momentum + turned)) if before else (first, momentum)
    np.testing.assert_allclose(samples.velocity[0, :, :d], mean, rtol=1e-12)
    spin = np.einsum("nij,nj->ni", inverse, mean_momentum)
    if d == 3:
        spin = np.array([matrix(3, i).T @ spin[i] for i in range(2)])
    np.testing.assert_allclose(samples.velocity[0, :, d:], spin, rtol=1e-12)
    if not before:
        first, momentum = 2 * first - then, 2 * momentum - turned
    kinetic = 0.5 * MASSES @ (first * then).sum(axis=1) + 0.5 * np.einsum("ni,nij,nj->", momentum, inverse, turned)
    assert samples.energy[0].kinetic == pytest.approx(kinetic, rel=1e-12)
    assert samples.energy[0].potential == pytest.approx(G * MASSES @ bodies["place"][:, -1], rel=1e-12)
