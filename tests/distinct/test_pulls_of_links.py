"""Ties, dampers, actuators, forces and supports, one function at a time, against the geometry of two points."""

import math

import numpy as np
import pytest
from by_hand import MOVED, MOVING, about, books, matrix, system, velocity_at

from mjrock.distinct import supports
from mjrock.distinct.kinds import link, ties
from mjrock.distinct.kinds.actuators import Actuators
from mjrock.distinct.kinds.constant_forces import ConstantForces
from mjrock.distinct.kinds.dampers import Dampers
from mjrock.distinct.kinds.lists import act_all, numbered, record_links
from mjrock.distinct.kinds.ties import Ties
from mjrock.distinct.supports import Supports, moving
from mjrock.distinct.system import ENERGY
from mjrock.rows import rows

BOTH = pytest.mark.parametrize("d", [2, 3])
ENDS = pytest.mark.parametrize("end", ["ground", "support", "body"])
AT = {2: np.array([0.2, -0.5]), 3: np.array([0.2, 0.3, -0.5])}
ORIGIN = {2: np.array([-0.1, 0.4]), 3: np.array([-0.1, -0.25, 0.4])}
BETWEEN = {2: np.array([1.5, 0.8]), 3: np.array([1.5, -0.6, 0.8])}
H = 0.02


def act(whole, account, t=5.0):
    """Let the links of a system act in a step to a time."""
    act_all(whole.links, whole, account, t, H)


def held(whole, account):
    """Potential energy, energy in springs and what is put in of the links of a system [J]."""
    energy = rows(ENERGY, 1)[0]
    record_links(whole.links, whole, account, energy, np.zeros(9))
    return energy.potential, energy.elastic, energy.driven


def linked(d, end="body", kind=Ties, **numbers):
    """Two bodies in motion with one link on body 1, from the ground, a support or body 0."""
    whole = system(d)
    ends = {"body": 1, "anchor": 0 if end == "body" else -1, "support": 0 if end == "support" else -1}
    places = {"at": AT[d], "origin": ORIGIN[d], "between": BETWEEN[d]}
    state = {"broken": math.inf} if kind is Ties else {}
    table = kind.table(d, 1, **ends | places | state | numbers)
    links = (kind(table, moving((), 1)) if kind is Actuators else kind(table),)
    return whole._replace(links=numbered(links)), table[0], end


def geometry(whole, end):
    """Length and direction of the link, arms to its ends, and its rate."""
    d, (other, body) = len(whole.axes), whole.bodies
    arm = matrix(d, 1) @ AT[d]
    across, velocity, anchor_arm = BETWEEN[d] + body.place + arm - AT[d], velocity_at(body, arm), ORIGIN[d]
    if end == "body":
        anchor_arm = matrix(d, 0) @ ORIGIN[d]
        across, velocity = across - other.place - anchor_arm + ORIGIN[d], velocity - velocity_at(other, anchor_arm)
    elif end == "support":
        across, velocity = across - whole.supports.moved[0], velocity - whole.supports.moving[0]
    length = np.linalg.norm(across)
    return length, across / length, arm, anchor_arm, velocity @ across / length


def assert_pulled(whole, end, force):
    """A link pushes its ends apart by a force, and nothing else acts."""
    _, way, arm, anchor_arm, _ = geometry(whole, end)
    np.testing.assert_allclose(whole.bodies[1].force, force * way, rtol=1e-11, atol=1e-14)
    np.testing.assert_allclose(whole.bodies[1].moment, about(arm, force * way), rtol=1e-11, atol=1e-14)
    back = -force * way if end == "body" else 0.0 * way
    np.testing.assert_allclose(whole.bodies[0].force, back, rtol=1e-11, atol=1e-14)
    np.testing.assert_allclose(whole.bodies[0].moment, about(anchor_arm, back), rtol=1e-11, atol=1e-14)


def carried(whole, end):
    """Velocity of the support along the link [m/s]."""
    return geometry(whole, end)[1] @ whole.supports.moving[0] if end == "support" else 0.0


@BOTH
@ENDS
def test_a_link_is_where_its_ends_are(d, end):
    whole, row, _ = linked(d, end)
    length, way, arm, anchor_arm, rate = geometry(whole, end)
    now = link.pull(row, whole)
    assert now.length == pytest.approx(length, rel=1e-12)
    np.testing.assert_allclose(now.direction, way, rtol=1e-11)
    np.testing.assert_allclose(now.arm, arm, rtol=1e-12)
    np.testing.assert_allclose(now.anchor_arm, anchor_arm, rtol=1e-12)
    assert link.lengthening(row, whole, now) == pytest.approx(rate, rel=1e-11)
    link.push_apart(row, whole, now, 3.0)
    assert_pulled(whole, end, 3.0)
    assert min(np.abs(MOVED).min(), np.abs(MOVING).min()) > 0


@BOTH
@ENDS
@pytest.mark.parametrize("longer", [0.01, -0.01])
@pytest.mark.parametrize("push", [0.0, 1e9])
def test_a_tie_pulls_where_it_is_longer_than_its_slack_and_a_spring_pushes_too(d, end, longer, push):
    stretch = longer if push else max(longer, 0.0)
    last = -3.0 if stretch else 0.0  # it was as taut in the step before
    whole, tie, _ = linked(d, end, k=2e3, strength=1e9, ultimate=1.0, force=last)
    tie.reach, tie.push = geometry(whole, end)[0] - longer, push
    account = books(whole)
    act(whole, account)
    assert_pulled(whole, end, -2e3 * stretch)
    assert tie.force == pytest.approx(-2e3 * stretch, rel=1e-10)
    work = 0.5 * H * (last - 2e3 * stretch) * carried(whole, end)
    assert account.totals[0].ground == pytest.approx(work, rel=1e-10)
    assert held(whole, account) == pytest.approx((0.0, 0.5 * 2e3 * stretch**2, 0.0), rel=1e-9)
    assert (tie.plastic, account.links[0], tie.broken) == (0.0, 0.0, math.inf)
    act(whole, account)
    assert account.totals[0].ground == pytest.approx(work - H * 2e3 * stretch * carried(whole, end), rel=1e-10)


@BOTH
@pytest.mark.parametrize(
    ("longer", "push", "way"), [(0.03, 0.0, 1), (0.03, 40.0, 1), (-0.03, 40.0, -1), (-0.03, 0.5, -1)]
)
def test_a_tie_yields_at_its_strength_and_slips_at_its_push(d, longer, push, way):
    """By what it is longer than its spring can hold; the work is booked, and its reach moves on."""
    whole, tie, end = linked(d, k=2e3, strength=20.0, push=push, ultimate=0.5, plastic=0.1)
    tie.reach = reach = geometry(whole, end)[0] - longer
    account, held = books(whole), 20.0 if way > 0 else push
    beyond = 0.03 - held / 2e3
    act(whole, account)
    assert_pulled(whole, end, -way * held)
    assert tie.force == pytest.approx(-way * held, rel=1e-9)
    assert tie.reach == pytest.approx(reach + way * beyond, rel=1e-12)
    assert tie.plastic == pytest.approx(0.1 + beyond, rel=1e-10)
    assert account.links[0] == pytest.approx(held * beyond, rel=1e-9)
    tie.reach = reach
    act(whole, account)
    assert account.links[0] == pytest.approx(2 * held * beyond, rel=1e-9)
    assert tie.plastic == pytest.approx(0.1 + 2 * beyond, rel=1e-10)
    assert account.links[1] == 0.0


@BOTH
@ENDS
@pytest.mark.parametrize("left", [0.004, 0.02, 0.0])
def test_a_tie_breaks_where_it_has_been_drawn_out_as_far_as_it_can_be(d, end, left):
    """Within the step, when the length was just reached. What it pulled too short or too long there is made up for."""
    whole, tie, _ = linked(d, end, k=2e3, strength=20.0, ultimate=0.5, plastic=0.5 - left, force=-20.0)
    length, *_, rate = geometry(whole, end)
    turned = math.copysign(1.0, rate)
    whole.bodies["velocity"] *= turned  # so that it grows
    whole.bodies["spin"] *= turned
    whole.supports.moving[:] *= turned
    beyond = left + 0.1 * H * abs(rate)
    tie.reach, account = length - beyond - 20.0 / 2e3, books(whole)
    act(whole, account)
    assert account.links[0] == pytest.approx(20.0 * left, rel=1e-9, abs=1e-15)
    assert tie.plastic == pytest.approx(0.5, rel=1e-12)
    assert tie.broken == pytest.approx(5.0 - 0.1 * H, rel=1e-9)
    assert account.links[1] == pytest.approx(0.5 * 20.0**2 / 2e3)
    assert account.totals[0].ground == pytest.approx(-0.9 * H * 20.0 * carried(whole, end), rel=1e-9)
    assert_pulled(whole, end, -20.0 * 0.4)
    assert tie.force == pytest.approx(-20.0 * 0.4, rel=1e-9)
    assert held(whole, account) == (0.0, 0.0, 0.0)
    whole.bodies["force"] = whole.bodies["moment"] = 0.0
    act(whole, account, tie.broken)
    assert_pulled(whole, end, 0.0)
    assert tie.force == 0.0


@pytest.mark.parametrize(("ultimate", "broken"), [(0.5, True), (0.75, False)])
def test_a_tie_that_is_drawn_out_just_to_its_limit_breaks(ultimate, broken):
    """It is 1 m longer than its slack, of which its spring holds half a metre."""
    tie = {"k": 2.0, "strength": 1.0, "reach": 1.0, "ultimate": ultimate, "broken": math.inf}
    whole = system(2, still=True)
    table = Ties.table(2, 1, between=[2.0, 0.0], **tie)
    whole = whole._replace(links=(Ties(table),))
    act(whole, books(whole))
    assert (table[0].broken == 5.0) == broken


def test_a_link_that_only_pulls_is_slack_where_one_that_pushes_too_is_shorter():
    for push, elongation in ((0.0, 0.0), (0.5, -0.1)):
        tie = Ties.table(2, 1, reach=1.0, push=push)[0]
        assert ties.elongation(tie, 0.9) == pytest.approx(elongation)
        assert ties.elongation(tie, 1.2) == pytest.approx(0.2)


def test_when_a_tie_broke():
    assert ties.since_broken(0.01, 2.0, H) == pytest.approx(0.005)
    assert ties.since_broken(0.1, 2.0, H) == H
    assert ties.since_broken(0.01, 0.5, H) == H
    assert ties.since_broken(0.01, 0.0, H) == ties.since_broken(0.01, -1.0, H) == 0.0
    tie = Ties.table(2, 1, strength=20.0)[0]
    for since, share in ((0.0, 0.5), (0.5 * H, 0.0), (H, -0.5)):
        assert ties.pulled_until_broken(tie, since, H) == pytest.approx(20.0 * share)
    assert ties.pulled_until_broken(tie, 0.0, 0.0) == 0.0


@BOTH
@ENDS
def test_a_damper_is_against_its_rate(d, end):
    whole, damper, _ = linked(d, end, Dampers, c=50.0, force=7.0)
    account, rate = books(whole), geometry(whole, end)[-1]
    act(whole, account)
    assert_pulled(whole, end, -50.0 * rate)
    assert damper.force == pytest.approx(-50.0 * rate, rel=1e-11)
    taken, work = 0.5 * H * (50.0 * rate - 7.0) * rate, 0.5 * H * (7.0 - 50.0 * rate) * carried(whole, end)
    assert account.links[0] == pytest.approx(taken, rel=1e-10)
    assert account.totals[0].ground == pytest.approx(work, rel=1e-10)
    act(whole, account)
    assert account.links[0] == pytest.approx(taken + H * 50.0 * rate**2, rel=1e-10)


def driving(d):
    """An actuator of body 1, and a damper on it, whose account stands before that of the actuator."""
    way = np.eye(d)[0] * 0.6 + np.eye(d)[-1] * 0.8
    whole, row, _ = linked(d, "ground", Actuators, k=300.0, c=2.0, reach=0.02, force=5.0, dashpot_force=1.0)
    row.between = way
    history, before = np.full((1, 1), 0.05), np.full((1, 1), 0.05 - 0.4 * H)
    drives = Supports(np.zeros(1), history, np.array([0, 1]), before, np.zeros((1, 1)))
    damper = Dampers(Dampers.table(d, 1, body=1, between=1.0))
    return whole._replace(links=numbered((damper, Actuators(whole.links[0].rows, drives)))), row, way


@BOTH
def test_an_actuator_pushes_a_point_along_its_way_to_its_history(d):
    whole, row, way = driving(d)
    account, body, arm = books(whole), whole.bodies[1], matrix(d, 1) @ AT[d]
    rate = 0.4 - way @ velocity_at(body, arm)
    force = 300.0 * (0.05 - (way @ (body.place + arm - AT[d]) - 0.02)) + 2.0 * rate
    driven, taken = 0.5 * H * (5.0 + force) * 0.4, 0.5 * H * (1.0 + 2.0 * rate) * rate
    act(whole, account)
    np.testing.assert_allclose(body.force, force * way, rtol=1e-11, atol=1e-12)
    np.testing.assert_allclose(body.moment, about(arm, force * way), rtol=1e-11, atol=1e-12)
    assert (row.force, row.dashpot_force) == pytest.approx((force, 2.0 * rate), rel=1e-11)
    assert account.links[1] == pytest.approx(driven, rel=1e-11)
    np.testing.assert_allclose(account.links[::2], [0.0, taken], rtol=1e-10)
    in_spring = force - 2.0 * rate
    assert held(whole, account) == pytest.approx((0.0, 0.5 * in_spring**2 / 300.0, driven), rel=1e-10)
    whole.links[1].drives.moved[:] -= 0.4 * H
    act(whole, account)
    assert account.links[1] == pytest.approx(driven + H * force * 0.4, rel=1e-11)
    assert account.links[2] == pytest.approx(taken + H * 2.0 * rate**2, rel=1e-10)


@BOTH
def test_an_actuator_without_a_body_pushes_all_in_proportion_to_their_mass(d):
    whole, row, way = driving(d)
    row.body = -1
    whole.bodies["mass"] = [3.0, 5.0]
    account, shares = books(whole), np.array([3.0, 5.0]) / 8.0
    rate = 0.4 - shares @ whole.bodies["velocity"] @ way
    force = 300.0 * (0.05 - (shares @ whole.bodies["place"] @ way - 0.02)) + 2.0 * rate
    act(whole, account)
    np.testing.assert_allclose(whole.bodies["force"], np.outer(shares, force * way), rtol=1e-11)
    np.testing.assert_array_equal(whole.bodies["moment"], 0.0)
    assert (row.force, row.dashpot_force) == pytest.approx((force, 2.0 * rate), rel=1e-11)
    assert account.links[1] == pytest.approx(0.5 * H * (5.0 + force) * 0.4, rel=1e-11)
    assert account.links[2] == pytest.approx(0.5 * H * (1.0 + 2.0 * rate) * rate, rel=1e-10)


@BOTH
def test_a_constant_force_acts_at_a_point_and_has_a_potential(d):
    force = np.array([3.0, -2.0, 5.0])[:d]
    whole, _, _ = linked(d, "ground", ConstantForces, between=force)
    arm = matrix(d, 1) @ AT[d]
    act(whole, books(whole))
    np.testing.assert_allclose(whole.bodies[1].force, force)
    np.testing.assert_allclose(whole.bodies[1].moment, about(arm, force), rtol=1e-12)
    falls = -force @ (whole.bodies[1].place + arm - AT[d])
    assert held(whole, books(whole)) == pytest.approx((falls, 0.0, 0.0), rel=1e-11)


TIMES = [np.array([0.5, 1.0, 1.5, 3.0, 4.0]), np.array([2.0]), np.array([0.0, 1.0])]
PLACES = [
    np.array([[0.1, 1.0], [0.2, 2.0], [0.7, -1.0], [0.4, 0.0], [0.9, 3.0]]),
    np.array([[0.3, 0.6]]),
    np.array([[0.0, 0.0], [5.0, 6.0]]),
]


def histories():
    first = np.cumsum([0, *map(len, TIMES)])
    return Supports(np.concatenate(TIMES), np.concatenate(PLACES), first, np.ones((3, 2)), np.full((3, 2), 9.0))


@pytest.mark.parametrize("t", [-1.0, 0.0, 0.5, 0.7, 1.0, 1.3, 1.5, 2.0, 2.9, 3.0, 3.5, 4.0, 9.0])
def test_a_support_is_where_its_history_has_it(t):
    """Linear between its samples and constant beyond them; its velocity is the mean of the step."""
    whole = histories()
    for h in (0.0, 0.25):
        before = whole.moved.copy()
        supports.move_supports(whole, t, h)
        for i in range(3):
            for axis in range(2):
                place = np.interp(t, TIMES[i], PLACES[i][:, axis])
                assert supports.support_place(whole, i, axis, t) == pytest.approx(place)
                assert whole.moved[i, axis] == pytest.approx(place)
                moving = (place - before[i, axis]) / h if h else 0.0
                assert whole.moving[i, axis] == pytest.approx(moving)
        whole.moved[:] = 1.0
