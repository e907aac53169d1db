"""One contact line at a pose, one function at a time: where it is, what it pushes and what is booked."""

import math

import numpy as np
import pytest
from by_hand import about, books, energy, matrix, system, velocity_at

from mjrock.distinct.contacts import contact, faces, friction, touches
from mjrock.distinct.contacts.faces import Meeting
from mjrock.distinct.rows import POINT_ON_FIXED_BLOCK
from mjrock.distinct.thread import add_force

NORMAL = {2: np.array([0.6, 0.8]), 3: np.array([0.48, 0.6, 0.64])}
ALONG = {2: np.array([0.8, -0.6]), 3: np.array([-0.8, 0.0, 0.6])}
AT = {2: np.array([0.2, -0.5]), 3: np.array([0.2, 0.3, -0.5])}
ORIGIN = {2: np.array([-0.1, 0.4]), 3: np.array([-0.1, -0.25, 0.4])}
BOTH = pytest.mark.parametrize("d", [2, 3])
FACES = pytest.mark.parametrize("face", [-1, 0, "support", POINT_ON_FIXED_BLOCK])
H, KICK, K, C = 1e-3, 1.1e-3, 1e5, 40.0


def put_line(whole, face, gap, aside=0.0, number=0, **law):
    """Line of body 1 at a gap from a face of body 0, of fixed ground, or of a support. Returns its normal there."""
    line, d, body = whole.lines[number], len(whole.axes), whole.bodies[1]
    line.body, line.face = 1, -1 if face == "support" else face
    line.support = 0 if face in ("support", POINT_ON_FIXED_BLOCK) else -1
    line.at, line.origin, line.normal = AT[d], ORIGIN[d], NORMAL[d]
    for name, value in law.items():
        line[name] = value
    turn, over = matrix(d, 1), np.zeros(d) if line.support < 0 else whole.supports.moved[0]
    turned = {-1: np.eye(d), 0: matrix(d, 0), POINT_ON_FIXED_BLOCK: turn}[int(line.face)]
    if line.face == 0:
        over = whole.bodies[0].place + turned @ ORIGIN[d] - ORIGIN[d]
    across = gap * turned @ NORMAL[d] + aside * turned @ ALONG[d]
    line.between = across - (body.place + turn @ AT[d] - AT[d]) + over
    return turned @ NORMAL[d]


def met(whole, number=0):
    return faces.meeting(whole, whole.lines[number])


@BOTH
@FACES
@pytest.mark.parametrize("gap", [-0.003, 0.002])
def test_a_line_is_where_its_bodies_have_it(d, face, gap):
    whole = system(d)
    normal = put_line(whole, face, gap, 0.01)
    meet, bodies = met(whole), whole.bodies
    across = (
        gap * normal
        + 0.01
        * {-1: np.eye(d), 0: matrix(d, 0), POINT_ON_FIXED_BLOCK: matrix(d, 1)}[int(whole.lines[0].face)]
        @ ALONG[d]
    )
    assert meet.gap == pytest.approx(gap, rel=1e-11)
    np.testing.assert_allclose(meet.normal, normal, rtol=1e-13)
    point = matrix(d, 1) @ AT[d]
    np.testing.assert_allclose(meet.arm, point - across if face == POINT_ON_FIXED_BLOCK else point, rtol=1e-12)
    if face == 0:
        np.testing.assert_allclose(meet.face_arm, matrix(d, 0) @ ORIGIN[d] + across, rtol=1e-12)
    assert meet.past is False
    over = np.zeros(d)
    if face == 0:
        over = velocity_at(bodies[0], np.array(meet.face_arm))
    elif face != -1:
        over = whole.supports.moving[0]
    slides = faces.relative_velocity(bodies, whole.lines[0], whole.supports, meet)
    np.testing.assert_allclose(slides, velocity_at(bodies[1], np.array(meet.arm)) - over, rtol=1e-12)


@BOTH
def test_a_force_adds_its_moment_about_the_centroid(d):
    body = system(d).bodies[1]
    add_force(body, tuple(AT[d]), tuple(ALONG[d]))
    add_force(body, tuple(ORIGIN[d]), tuple(NORMAL[d]))
    np.testing.assert_allclose(body.force, ALONG[d] + NORMAL[d])
    np.testing.assert_allclose(body.moment, about(AT[d], ALONG[d]) + about(ORIGIN[d], NORMAL[d]))


@pytest.mark.parametrize(("gap", "moved"), [(-0.2, 0.1), (0.2, 0.0)])
def test_friction_rubs_halfway_into_the_overlap(gap, moved):
    meet = faces.where_friction_rubs(Meeting(gap, (0.6, 0.8), (1.0, 2.0), (-1.0, 0.5), False))
    assert meet.gap == gap
    np.testing.assert_allclose(meet.arm, np.add([1.0, 2.0], np.multiply(moved, [0.6, 0.8])))
    np.testing.assert_allclose(meet.face_arm, np.add([-1.0, 0.5], np.multiply(moved, [0.6, 0.8])))


def ended(d, face, over, *, within=1.0, gap=-0.003, band=0.5):
    """A line that lies by `over` beyond the end of its face, which is 0.05 from the place where it was at rest."""
    whole = system(d, edges=4)
    normal = put_line(whole, face, gap, 0.05 + over, margin=0.05**2)
    line = whole.lines[0]
    line.first, line.last, line.own_first, line.own_last = 0, 2, 2, 4
    for edge, way, place, reach in zip(
        whole.edges, [ALONG[d], -ALONG[d]] * 2, [ORIGIN[d]] * 2 + [AT[d]] * 2, [0.05, 1.0, within, within], strict=True
    ):
        edge.normal, edge.reach, edge.band = way, way @ place + reach, band
    return whole, normal


@BOTH
@pytest.mark.parametrize("face", [-1, 0])
@pytest.mark.parametrize(("over", "band"), [(0.02, 0.5), (0.02, 0.01)])
def test_the_end_of_a_face_presses_on_the_face_of_the_block_above(d, face, over, band):
    """Its gap is that of the end from the turned face above, and its normal turns to that of this face over a band."""
    whole, normal = ended(d, face, over, band=band)
    meet, turn = met(whole), np.eye(d) if face < 0 else matrix(d, 0)
    own, apart = matrix(d, 1) @ NORMAL[d], -0.003 * normal + over * turn @ ALONG[d]
    assert meet.gap == pytest.approx(own @ apart, rel=1e-10)
    blended = normal + min(over / band, 1.0) * (own - normal)
    np.testing.assert_allclose(meet.normal, blended / np.linalg.norm(blended), rtol=1e-12)
    aside = apart - own @ apart * own
    np.testing.assert_allclose(meet.arm, matrix(d, 1) @ AT[d] - aside, rtol=1e-12)
    if face == 0:
        arm = turn @ ORIGIN[d] - 0.003 * normal + (0.05 + over) * turn @ ALONG[d] - aside
        np.testing.assert_allclose(meet.face_arm, arm, rtol=1e-12)
    assert meet.past is True


@BOTH
def test_past_the_end_of_both_faces_nothing_is_left(d):
    meet = met(ended(d, 0, 0.02, within=0.001)[0])
    assert (meet.gap, meet.past) == (faces.GAP_OF_OPEN, True)
    assert faces.GAP_OF_OPEN > 0.1


@BOTH
@pytest.mark.parametrize("face", [-1, 0])
def test_within_the_outline_a_line_is_not_past_its_end(d, face):
    whole, _ = ended(d, face, -0.01)
    meet = met(whole)
    assert (meet.gap, meet.past) == (pytest.approx(-0.003, rel=1e-10), False)
    whole.lines["margin"] = 0.0  # the end is looked at, and not reached
    assert met(whole) == meet
    whole, _ = ended(d, face, 0.02, gap=0.001)  # what is open has no end
    assert (met(whole).gap, met(whole).past) == (pytest.approx(0.001, rel=1e-10), False)


@BOTH
@pytest.mark.parametrize("turned", [0, 1])
def test_faces_that_are_turned_away_from_each_other_do_not_press(d, turned):
    whole = system(d, still=True)
    body = whole.bodies[turned]
    if d == 2:
        body.rotation[:] = [0.0, 2.0]  # half a turn
    else:
        body.rotation[:] = np.diag([-2.0, -2.0, 0.0])
        whole.lines["normal"] = [0.6, 0.8, 0.0]
    line = whole.lines[0]
    line.body, line.face, line.margin = 1, 0, 1e9
    if d == 2:
        line.normal = NORMAL[2]
    line.between = -0.003 * line.normal * (-1.0 if turned == 0 else 1.0)
    meet = met(whole)
    assert (meet.gap, meet.past) == (faces.TURNED_OVER, True)
    line.margin = math.inf  # a line of a place that was found has no end
    assert (met(whole).gap, met(whole).past) == (pytest.approx(-0.003), False)
    assert faces.TURNED_OVER > faces.GAP_OF_OPEN


LAW = Meeting(0.0, (0.0, 1.0), (0.0, 0.0), (0.0, 0.0), False)


@pytest.mark.parametrize(
    ("depth", "gap", "opened", "lost"),
    [
        (0.02, -0.01, 0.01, 0.0),  # the spring has done what it held less
        (0.02, -0.01, 0.0, 0.5 * K * 3e-4),
        (0.01, -0.02, 0.0, -0.5 * K * 3e-4),
        (0.02, 1.0, 0.0, 0.5 * K * 4e-4),
        (0.02, 0.0, 0.04, 0.0),  # it opened within the step
        (0.02, 0.01, 0.01, 0.5 * K * 2e-4),
        (0.0, -0.02, -0.02, 0.0),
        (0.0, -0.02, -0.03, 0.0),  # it closed within the step
        (0.0, -0.02, -0.01, -0.5 * K * 2e-4),
    ],
)
def test_what_a_line_has_lost_at_an_end(depth, gap, opened, lost):
    line = system(2).lines[0]
    line.k, line.c, line.depth = K, C, depth
    assert contact.lost_past_face_edge(line, LAW._replace(gap=gap), opened) == pytest.approx(lost, abs=1e-9 * K)


def pressed(whole, lead=0.0, h=H):
    kept = books(whole)
    counts = contact.press_lines(whole, kept, h, KICK, lead)
    return kept, counts


def moving_line(d, face, gap, *, was=0.002, push=150.0, number=0, whole=None, **law):
    """A line that was closed at the pose before, and the rate of its gap and its slip at the pose."""
    whole = system(d) if whole is None else whole
    law = {"k": K, "c": C, "depth": was, "push": push, "dashpot_force": 7.0, "rate": -0.1, "group": 1} | law
    normal = put_line(whole, face, gap, number=number, **law)
    meet = faces.where_friction_rubs(met(whole, number))
    over = faces.relative_velocity(whole.bodies, whole.lines[number], whole.supports, meet)
    rate = normal @ over
    return whole, meet, rate, over - rate * normal


@BOTH
@FACES
def test_a_line_presses_both_bodies_by_the_law(d, face):
    """Spring and dashpot along the normal; without friction nothing else. Works are the means of two poses."""
    gap = -0.003
    whole, meet, rate, _ = moving_line(d, face, gap)
    kept, counts = pressed(whole)
    push = max(K * 0.003 - C * rate, 0.0)
    line, bodies = whole.lines[0], whole.bodies
    assert counts == (0, 0)
    assert (line.push, line.rate, line.depth) == pytest.approx((push, rate, 0.003), rel=1e-9)
    assert (line.dashpot_force, line.past, line.widest) == (pytest.approx(push - 300.0, rel=1e-9), 0, 0.0)
    np.testing.assert_allclose(bodies["force"][1], push * np.array(meet.normal), rtol=1e-9)
    np.testing.assert_allclose(bodies["moment"][1], about(meet.arm, push * np.array(meet.normal)), rtol=1e-9)
    other = -push * np.array(meet.normal) if face == 0 else np.zeros(d)
    np.testing.assert_allclose(bodies["force"][0], other, rtol=1e-9)
    np.testing.assert_allclose(bodies["moment"][0], about(meet.face_arm, other), rtol=1e-9)
    np.testing.assert_allclose(kept.dashpots, [0.0, -0.5 * H * (7.0 + push - 300.0) * rate], rtol=1e-9)
    carried = 0.0 if face in (-1, 0) else whole.supports.moving[0] @ meet.normal
    assert kept.totals[0].ground == pytest.approx(0.5 * H * (150.0 + push) * carried, rel=1e-9)
    assert (kept.totals[0].friction, kept.totals[0].joint_ends) == (0.0, 0.0)


@BOTH
@FACES
def test_friction_of_a_spring_acts_halfway_and_its_work_is_booked(d, face):
    gap, spring = -0.003, {"k_s": 4e4, "c_s": 20.0, "friction": 0.5}
    last = 3.0 if d == 2 else 3.0 * ALONG[3]
    whole, meet, rate, slip = moving_line(d, face, gap, shear_force=last, **spring)
    twin = system(d)
    put_line(twin, face, gap, k=K, **spring)
    along = friction.along_face(meet.normal, tuple(slip))
    drag = friction.sprung_friction(twin.bodies, twin.lines[0], meet.normal, along, max(300.0 - C * rate, 0.0), H)
    kept, counts = pressed(whole)
    line, bodies = whole.lines[0], whole.bodies
    assert counts == (0, 0)
    np.testing.assert_allclose(line.shear_force, drag, rtol=1e-9)
    np.testing.assert_allclose(line.shear_state, twin.lines[0].shear_state, rtol=1e-9)
    force = line.push * np.array(meet.normal) + friction.as_vector(meet.normal, drag)
    np.testing.assert_allclose(bodies["force"][1], force, rtol=1e-9)
    np.testing.assert_allclose(bodies["moment"][1], about(meet.arm, force), rtol=1e-9)
    other = -force if face == 0 else np.zeros(d)
    np.testing.assert_allclose(bodies["moment"][0], about(meet.face_arm, other), rtol=1e-9)
    mean = 0.5 * H * (np.add(last, drag) if d == 3 else last + np.array(drag))
    assert kept.totals[0].friction == pytest.approx(-mean @ np.array(along), rel=1e-9)
    if face not in (-1, 0):
        work = 0.5 * H * (150.0 + line.push) * np.array(meet.normal) + friction.as_vector(meet.normal, tuple(mean))
        assert kept.totals[0].ground == pytest.approx(whole.supports.moving[0] @ work, rel=1e-9)
    again, _ = pressed(whole)
    assert again.totals[0].friction != 0


@BOTH
def test_lines_that_stick_rigidly_are_listed(d):
    """The first line has no friction, and the ways of the others follow each other."""
    whole = system(d, 3)
    moving_line(d, 0, -0.003, whole=whole)
    _, meet, rate, _ = moving_line(d, 0, -0.002, number=1, whole=whole, friction=0.5)
    moving_line(d, "support", -0.001, number=2, whole=whole, friction=0.25)
    kept, counts = pressed(whole)
    assert counts == (2, 0)
    assert list(kept.active[:2]) == [1, 2]
    ways = whole.tangents
    np.testing.assert_array_equal(ways["face"][: 2 * (d - 1)], np.repeat([0, -1], d - 1))
    np.testing.assert_allclose(ways["limit"][0], KICK * 0.5 * max(200.0 - C * rate, 0.0), rtol=1e-9)
    np.testing.assert_allclose(ways["limit"][d - 1], KICK * 0.25 * whole.lines["push"][2], rtol=1e-9)
    np.testing.assert_allclose(ways["lever"][0], about(meet.arm, ways["direction"][0]), rtol=1e-9)
    np.testing.assert_allclose(ways["lever_on_face"][0], about(meet.face_arm, ways["direction"][0]), rtol=1e-9)


@BOTH
@pytest.mark.parametrize("size", [1.0, 1e-3])
def test_a_dashpot_looks_ahead_where_it_presses_before_and_after(d, size):
    for was, ahead in ((150.0 * size, True), (0.0, False)):
        whole, _, rate, _ = moving_line(d, 0, -0.003, push=was, dashpot_force=0.0, depth=0.002, k=K * size, c=C * size)
        line = whole.lines[0]
        push = max((300.0 - C * rate) * size, 0.0)
        assert push > 0
        seen = touches.foreseen(line, rate, push, 0.5) if ahead else rate
        if not ahead:
            push = touches.forces_of_leaving(line, -0.003, rate, H)[1]
        pressed(whole, lead=0.5)
        assert whole.lines[0].push == pytest.approx(max((300.0 - C * seen) * size, 0.0) if ahead else push, rel=1e-9)


@BOTH
def test_a_line_that_stays_open_keeps_its_widest_gap(d):
    whole, _, _, _ = moving_line(
        d, -1, 0.004, was=0.0, push=0.0, dashpot_force=0.0, shear_state=3.0, widest=0.001, k_s=1e5, friction=0.5
    )
    kept, counts = pressed(whole)
    line = whole.lines[0]
    assert counts == (0, 0)
    assert line.widest == pytest.approx(max(0.001, met(whole).gap))
    assert not line.shear_state.any()
    assert not whole.bodies["force"].any()
    assert not kept.dashpots.any()
    assert line.rate == -0.1  # it is not looked at


def test_a_line_past_its_end_is_not_open():
    whole, _ = ended(2, -1, 0.02, within=0.001)
    whole.lines["k"], whole.lines["widest"] = K, 0.001
    pressed(whole)
    assert whole.lines["widest"][0] == 0.001


@BOTH
@pytest.mark.parametrize(
    ("was", "push", "gap", "before"),
    [
        (0.0, 0.0, -0.0002, 0.3),
        (0.0002, 20.0, 0.0001, 0.3),
        (0.0002, 0.5, 0.0001, 0.3),
        (0.0, 0.0, -0.3, 0.3),
        (0.0002, 0.0, 0.0001, 0.3),
        (0.0002, 0.0, 0.0001, 0.6),
    ],
)
def test_a_line_that_meets_or_leaves_its_face_is_touched(d, was, push, gap, before):
    whole = system(d, 2)
    whole.bodies["velocity"][1] += (1.0 if gap > 0 else -1.0) * matrix(d, 0) @ NORMAL[d]
    friction_law = {"k_s": 1e5, "c_s": 1.0, "friction": 0.5, "shear_force": 2.0, "shear_state": 0.0}
    _, meet, rate, slip = moving_line(
        d, 0, gap, was=was, push=push, dashpot_force=0.0, number=1, whole=whole, rate=before, **friction_law
    )
    twin = system(d, 2)
    put_line(twin, 0, gap, number=1, k=K, c=C, depth=was, push=push, rate=before, **friction_law)
    sprung, expected = touches.touched_forces(twin.lines[1], meet.gap, rate, H)
    drag = np.zeros(1 if d == 2 else 3)
    if expected > 0:
        along = friction.along_face(meet.normal, tuple(slip))
        time = touches.time_closed(twin.lines[1], meet.gap, rate, H)
        drag = friction.sprung_friction(twin.bodies, twin.lines[1], meet.normal, along, expected, time)
    elif expected < 0 < push:
        drag = np.array(friction.turned_along(meet.normal, (2.0,) if d == 2 else (2.0,) * 3)) * expected / push
    kept, counts = pressed(whole)
    line = whole.lines[1]
    assert line.due == pytest.approx(twin.lines[1].due, rel=1e-9)
    assert counts == (0, 1 if line.due else 0)
    assert kept.touched[0] == (1 if line.due else 0)
    assert line.push == pytest.approx(expected, rel=1e-9, abs=1e-12)
    assert line.dashpot_force == pytest.approx(
        expected - sprung if gap < 0 or expected < 0 else 0.0, rel=1e-9, abs=1e-12
    )
    assert line.depth == pytest.approx(max(-gap, 0.0))
    np.testing.assert_allclose(line.shear_force, drag, rtol=1e-9)
    np.testing.assert_allclose(kept.dashpots[1], -0.5 * H * (expected - sprung) * rate, rtol=1e-9, atol=1e-15)


@BOTH
def test_no_line_touches_twice(d):
    whole = system(d, 2)
    whole.bodies["velocity"][1] -= matrix(d, 0) @ NORMAL[d]
    for number in range(2):
        moving_line(d, 0, -0.0002, was=0.0, push=0.0, dashpot_force=0.0, number=number, whole=whole)
    kept, counts = pressed(whole)
    assert counts == (0, 2)
    assert list(kept.touched) == [0, 1]


@BOTH
def test_what_a_line_loses_past_its_end_is_booked(d):
    for before, over in ((0, 0.02), (1, -0.02)):
        whole, _ = ended(d, 0, over)
        line = whole.lines[0]
        line.k, line.c, line.depth, line.push, line.past = K, C, 0.004, 400.0, before
        meet = met(whole)
        rub = faces.where_friction_rubs(meet)
        rate = np.dot(meet.normal, faces.relative_velocity(whole.bodies, line, whole.supports, rub))
        lost = contact.lost_past_face_edge(line, meet, H * rate)
        kept, _ = pressed(whole)
        assert lost != 0
        assert kept.totals[0].joint_ends == pytest.approx(lost, rel=1e-9)
        assert whole.lines[0].past == (1 if over > 0 else 0)
        kept.totals[0].joint_ends = 0.0


def test_a_line_whose_faces_are_turned_away_has_gone():
    whole = system(2, still=True)
    whole.bodies["rotation"][1] = [0.0, 2.0]
    line = whole.lines[0]
    line.body, line.face, line.margin, line.normal, line.between = 1, 0, 1e9, NORMAL[2], -0.003 * NORMAL[2]
    line.k, line.c, line.friction, line.depth, line.push = K, C, 0.5, 0.001, 100.0
    pressed(whole)
    assert (line.k, line.c, line.friction, line.widest) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(("k", "margin", "pushes"), [(0.0, math.inf, False), (K, math.inf, True), (0.0, 1e9, True)])
def test_a_line_with_an_intact_bond_or_that_is_handed_over_is_left_out(k, margin, pushes):
    whole, _, rate, _ = moving_line(2, -1, -0.003, k=k, margin=margin)
    pressed(whole)
    assert bool(whole.lines[0].rate == pytest.approx(rate)) is pushes


@BOTH
@pytest.mark.parametrize("face", [0, "support"])
def test_springs_do_the_work_of_their_touch(d, face):
    """The impulses change both velocities, and each is what its spring is due at the rate that they leave."""
    whole = system(d, 3)
    for number, due in enumerate((0.0, 0.02, -0.03)):
        _, _, rate, _ = moving_line(d, face, -0.002, number=number, whole=whole, due=due)
        whole.lines[number].rate = 1.5 * rate
    kept = books(whole)
    kept.touched[:2], kept.impulse[:] = [1, 2], 5.0
    rates, before, place = whole.lines["rate"].copy(), energy(whole.bodies), whole.bodies["velocity"].copy()
    normal = np.array(met(whole, 1).normal)
    taken, put_in = contact.settle_touches(whole, kept, 2, KICK)
    struck = kept.impulse[:2]
    left = [
        normal @ faces.relative_velocity(whole.bodies, whole.lines[i], whole.supports, met(whole, i)) for i in (1, 2)
    ]
    for i in (1, 2):
        whole.lines[i].due = (0.0, 0.02, -0.03)[i]
        assert struck[i - 1] == pytest.approx(touches.due_impulse(whole.lines[i], left[i - 1]), rel=1e-3)
        assert abs(struck[i - 1]) > 1e-4
    total = struck.sum() * normal
    np.testing.assert_allclose(whole.bodies["velocity"][1], place[1] + total / 5.0, rtol=1e-12)
    np.testing.assert_allclose(whole.bodies["velocity"][0], place[0] - (total / 2.0 if face == 0 else 0.0), rtol=1e-12)
    np.testing.assert_allclose(whole.lines["push"], 150.0 + np.array([0.0, *struck]) / KICK, rtol=1e-12)
    assert taken == pytest.approx(-0.5 * struck @ rates[1:], rel=1e-12)
    carried = 0.0 if face == 0 else whole.supports.moving[0] @ total
    assert put_in == pytest.approx(0.5 * carried, rel=1e-12)
    assert kept.totals[0].ground == pytest.approx(0.5 * carried, rel=1e-12)
    assert energy(whole.bodies) != before
    whole.lines["due"] = 0.0
    contact.settle_touches(whole, kept, 2, KICK)
    assert not kept.impulse[:2].any()
    contact.settle_touches(whole, kept, 2, KICK)
    assert kept.totals[0].ground == pytest.approx(0.5 * carried, rel=1e-12)
    assert not whole.lines["due"].any()


def test_touches_leave_nothing_due():
    whole, _, rate, _ = moving_line(2, 0, -0.002, due=0.02)
    whole.lines[0].rate = 1.5 * rate
    contact.settle_touches(whole, books(whole), 1, KICK)
    assert whole.lines[0].due == 0.0
