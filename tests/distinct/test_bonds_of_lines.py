"""The bond of one line, one function at a time: what it pulls, drags and takes, and what it leaves to its line."""

import math

import numpy as np
import pytest
from bonded import AREA, K_N, K_S, MORTAR, joint
from by_hand import about, books, matrix, system
from test_contact_lines import ALONG, BOTH, FACES, NORMAL, met, put_line

import mjrock as mr
from mjrock.distinct.contacts import faces, friction
from mjrock.distinct.kinds import mortar as bonds
from mjrock.distinct.search.validity import JointState, mark_left
from mjrock.distinct.setup import setup_of
from mjrock.problem.masonry.laws.bond_law import bonded_limit, crush, tear, wear
from mjrock.rows import rows

H, K, C, K_SHEAR, C_SHEAR = 1e-3, 1e6, 40.0, 4e5, 20.0
TENSION, COHESION, TORN, WORN = 1e3, 2e3, 300.0, 500.0


def taken_by(account):
    """What bonds have taken in tension, slip and crushing [J]."""
    return np.array([account.totals[0][name] for name in ("tension", "slip", "crushing")])


def bonded_line(d, face, at, **law):
    """A system whose line has an intact bond, at a gap, and its normal."""
    whole = system(d)
    normal = put_line(whole, face, at, k=0.0, c=0.0, friction=0.0, group=1)
    bond = whole.laws[0].rows[0]
    given = {"k": K, "c": C, "k_s": K_SHEAR, "c_s": C_SHEAR, "tension": TENSION, "cohesion": COHESION}
    given |= {
        "opening_rate": TORN,
        "slip_rate": WORN,
        "integrity": 1.0,
        "secant": K,
        "strength": math.inf,
        "residual": 0.5,
        "friction_drop": 0.25,
    }
    for name, value in (given | {"margin": math.inf} | law).items():
        bond[name] = value
    return whole, normal


def copy_of(bond):
    return rows(bond.dtype, 1, **{name: bond[name] for name in bond.dtype.names})[0]


@BOTH
@pytest.mark.parametrize("secant", [0.0, 0.25 * K, K])
def test_dashpots_along_the_face_leave_out_what_holds(d, secant):
    """A bond whose dashpots wait for cracks has them on the share of its stiffness that has cracked."""
    whole, _ = bonded_line(d, 0, -0.001, secant=secant)
    line, bond = whole.lines[0], whole.laws[0].rows[0]
    meet = faces.where_friction_rubs(met(whole))
    slip = friction.along_face(meet.normal, faces.relative_velocity(whole.bodies, line, whole.supports, meet))
    stretch, drags = friction.stretched(whole.bodies, line.face, bond.shear_state, meet.normal, H * np.array(slip)), []
    for undamped in (0.0, 1.0):
        twin = copy_of(bond)
        twin.undamped = undamped
        drags.append(np.array(bonds.slide(system(d).bodies, line, twin, stretch, slip, 1e5)[0]))
    expected = C_SHEAR * secant / K * np.array(slip)
    np.testing.assert_allclose(drags[1] - drags[0], expected, rtol=1e-9, atol=1e-9 * np.abs(drags[0]).max())


@BOTH
@FACES
@pytest.mark.parametrize(("gap", "last"), [(-0.003, -0.001), (0.0005, 0.0002), (0.003, 0.0005), (0.003, -0.0005)])
@pytest.mark.parametrize("undamped", [0.0, 1.0])
def test_a_bond_pulls_and_drags_by_its_law_and_books_what_it_takes(d, face, gap, last, undamped):
    before = 30.0 if d == 2 else 30.0 * ALONG[3]
    state = {"gap": last, "push": 80.0, "dashpot_force": 7.0, "shear_force": before, "shear_state": before / 1500.0}
    whole, normal = bonded_line(d, face, gap, **state, undamped=undamped)
    line, bond, bodies = whole.lines[0], whole.laws[0].rows[0], whole.bodies
    meet = faces.where_friction_rubs(met(whole))
    velocity = faces.relative_velocity(bodies, line, whole.supports, meet)
    rate, slip = normal @ velocity, friction.along_face(meet.normal, velocity)
    twin, other = copy_of(bond), system(d)
    tear(twin, gap)
    rest = K - twin.secant
    pressed = -(1 - undamped) * C * twin.secant / K * rate
    pulled = pressed - twin.secant * gap
    dry = max(-rest * gap - C * rest / K * rate, 0.0) if gap < 0 else 0.0
    stretch = friction.stretched(other.bodies, line.face, bond.shear_state, meet.normal, H * np.array(slip))
    drag, taken = bonds.slide(other.bodies, line, twin, stretch, slip, pulled + dry)
    kept = books(whole)
    whole.laws[0].act(whole, kept, 0.0, H)
    assert bond.secant == pytest.approx(twin.secant, rel=1e-9)
    assert bool(bond.secant < K) is (gap == 0.003)
    assert (line.k, line.c) == pytest.approx((rest, C * rest / K), rel=1e-9)
    assert (bond.push, bond.gap) == pytest.approx((pulled, gap), rel=1e-9)
    assert bond.dashpot_force == pytest.approx(pressed, rel=1e-9)
    assert line.widest == pytest.approx(max(gap, 0.0), rel=1e-9)
    np.testing.assert_allclose(bond.shear_force, drag, rtol=1e-9)
    np.testing.assert_allclose(bond.shear_state, twin.shear_state, rtol=1e-9)
    force = pulled * normal + friction.as_vector(meet.normal, drag)
    np.testing.assert_allclose(bodies["force"][1], force, rtol=1e-9)
    np.testing.assert_allclose(bodies["moment"][1], about(meet.arm, force), rtol=1e-9)
    against = -force if face == 0 else np.zeros(d)
    np.testing.assert_allclose(bodies["force"][0], against, rtol=1e-9)
    np.testing.assert_allclose(bodies["moment"][0], about(meet.face_arm, against), rtol=1e-9)
    np.testing.assert_allclose(kept.dashpots, [0.0, -0.5 * H * (7.0 + bond.dashpot_force) * rate], rtol=1e-9)
    torn = 0.5 * last * gap * (K - twin.secant)
    assert taken > 0
    np.testing.assert_allclose(taken_by(kept), [torn, taken, 0.0], rtol=1e-9, atol=1e-12)
    mean = 0.5 * H * (before + np.array(drag))
    assert kept.totals[0].friction == pytest.approx(-mean @ np.array(slip) - taken, rel=1e-9)
    if face not in (-1, 0):
        work = 0.5 * H * (80.0 + pulled) * normal + friction.as_vector(meet.normal, tuple(mean))
        assert kept.totals[0].ground == pytest.approx(whole.supports.moving[0] @ work, rel=1e-9)
    else:
        assert kept.totals[0].ground == 0


@pytest.mark.parametrize(("last", "gap"), [(5e-4, -1e-3), (-5e-4, -1e-3)])
def test_a_worn_bond_tears_as_it_closes(last, gap):
    """What its spring holds less is taken where the gap was open; a closed one held nothing that it no longer does."""
    whole, _ = bonded_line(2, -1, gap, gap=last, integrity=0.2, largest_gap=5e-4)
    kept = books(whole)
    whole.laws[0].act(whole, kept, 0.0, H)
    lost = K - whole.laws[0].rows["secant"][0]
    assert lost > 0.5 * K
    assert taken_by(kept)[0] == pytest.approx(0.5 * last * gap * lost if last > 0 else 0.0, rel=1e-9)


def test_works_of_bonds_add_up():
    """A second line at the same place doubles what both book."""
    once, twice = books(system(2)), books(system(2))
    for kept, count in ((once, 1), (twice, 2)):
        for _ in range(count):
            whole, _ = bonded_line(2, "support", 0.003, gap=0.0005, push=80.0, shear_state=0.01)
            whole.laws[0].act(whole, kept, 0.0, H)
    assert abs(once.totals[0].friction) > 0
    for name in ("friction", "ground"):
        assert twice.totals[0][name] == pytest.approx(2 * once.totals[0][name])
    np.testing.assert_allclose(taken_by(twice), 2 * taken_by(once))
    np.testing.assert_allclose(twice.dashpots, 2 * once.dashpots)
    assert (taken_by(once)[:2] > 0).all()


@BOTH
def test_a_bond_that_has_torn_keeps_its_secant_and_presses_with_its_line(d):
    """What the secant lacks of the stiffness of the line presses only, which the friction of both knows."""
    whole, _ = bonded_line(
        d, 0, -0.003, integrity=0.2, largest_gap=0.004, crack=0.0039, secant=3e5, gap=-0.002, c_s=0.0
    )
    line, bond = whole.lines[0], whole.laws[0].rows[0]
    line.k, line.c = K - 3e5, C * (1 - 0.3)
    meet = faces.where_friction_rubs(met(whole))
    rate = np.dot(meet.normal, faces.relative_velocity(whole.bodies, line, whole.supports, meet))
    bond.shear_state[:] = 1.0 if d == 2 else matrix(3, 0).T @ (matrix(3, 0) @ ALONG[3])
    whole.laws[0].act(whole, books(whole), 0.0, H)
    assert bond.secant == 3e5
    assert bond.push == pytest.approx(3e5 * 0.003 - 0.3 * C * rate, rel=1e-9)
    whole_push = K * 0.003 - C * rate
    assert np.linalg.norm(bond.shear_force) == pytest.approx(0.2 * COHESION + 0.55 * whole_push, rel=1e-9)


@BOTH
@pytest.mark.parametrize("face", [-1, 0])
@pytest.mark.parametrize("held", [1.0, 0.9])
def test_slip_takes_no_more_than_there_is_to_take(d, face, held):
    """Where crushing limits the force to a ninth of the cohesion, friction pays for nothing."""
    whole, _ = bonded_line(d, face, 0.0, strength=COHESION / 3, residual=0.0, friction_drop=0.0, c=0.0, c_s=0.0)
    line, bond, limit = whole.lines[0], whole.laws[0].rows[0], COHESION / 9
    meet = faces.where_friction_rubs(met(whole))
    velocity = faces.relative_velocity(whole.bodies, line, whole.supports, meet)
    slip = np.array(friction.along_face(meet.normal, velocity))
    way = slip / np.linalg.norm(slip)
    shear_state = held * limit / K_SHEAR * way
    bond.shear_force = -K_SHEAR * shear_state
    bond.shear_state = matrix(3, 0).T @ shear_state if face == 0 and d == 3 else shear_state
    kept = books(whole)
    whole.laws[0].act(whole, kept, 0.0, H)
    assert np.linalg.norm(bond.shear_force) == pytest.approx(limit)
    work = 0.5 * H * (held + 1) * limit * np.linalg.norm(slip)
    there = work - 0.5 * (1 - held**2) * limit**2 / K_SHEAR
    assert 0 < there < COHESION * (1 - bond.integrity) / WORN
    assert taken_by(kept)[1] == pytest.approx(there)
    assert kept.totals[0].friction == pytest.approx(work - there)


@BOTH
@pytest.mark.parametrize("face", [-1, 0])
@pytest.mark.parametrize(("push", "slides"), [(1e4, False), (400.0, True), (-300.0, True)])
def test_a_bond_holds_cohesion_and_friction_along_the_face(d, face, push, slides):
    """Kept in the axes of the face. Its friction falls from that of a whole bond to the residual one."""
    whole, _ = bonded_line(d, face, -0.001, integrity=0.6)
    line, bond, way = whole.lines[0], whole.laws[0].rows[0], ALONG[d]
    turn, slip = np.eye(d) if face < 0 else matrix(d, 0), 0.3
    normal, along = turn @ NORMAL[d], turn @ way
    bond.shear_state[:] = 0.004 if d == 2 else way * 0.004
    twin = copy_of(bond)
    twin.friction = 0.5 + 0.25 * 0.6
    limit = bonded_limit(twin, push)
    trial = 0.004 + slip * H
    stretch = min(trial, limit / K_SHEAR)
    assert bool(stretch < trial) is slides
    slipped = (slip,) if d == 2 else tuple(slip * along)
    elongation = friction.stretched(
        whole.bodies, line.face, bond.shear_state, tuple(normal), tuple(H * np.array(slipped))
    )
    drag, taken = bonds.slide(whole.bodies, line, bond, elongation, slipped, push)
    assert bond.friction == pytest.approx(0.65)
    held = min(K_SHEAR * stretch + C_SHEAR * slip, limit)
    np.testing.assert_allclose(friction.as_vector(tuple(normal), drag), -held * along, rtol=1e-12, atol=1e-10)
    np.testing.assert_allclose(bond.shear_state, stretch if d == 2 else stretch * way, rtol=1e-12, atol=1e-15)
    assert taken == pytest.approx(wear(twin, trial - stretch), rel=1e-12)
    assert bond.integrity == pytest.approx(twin.integrity, rel=1e-12)


@BOTH
@pytest.mark.parametrize("face", [-1, 0])
def test_a_line_that_is_crushed_steps_back_by_what_it_closes(d, face):
    """The gap falls by the closing, and half the force times the way that the spring gave back is taken."""
    whole, _ = bonded_line(d, face, -0.003, strength=2000.0, crushing_rate=50.0, gap=-0.0015, k_s=1e5)
    line, bond = whole.lines[0], whole.laws[0].rows[0]
    bond.shear_state[:] = 0.002 if d == 2 else 0.002 * ALONG[3]
    twin, kept = copy_of(bond), books(whole)
    closing = crush(twin, met(whole).gap, 1e5 * 0.002)
    assert closing > 1e-4
    assert bonds.crush_line(kept, line, bond, met(whole).gap) == pytest.approx(closing, rel=1e-9)
    assert met(whole).gap == pytest.approx(-0.003 + closing, rel=1e-9)
    point = matrix(d, 1) @ line.at
    np.testing.assert_allclose(met(whole).arm, point, rtol=1e-9)
    assert taken_by(kept)[2] == pytest.approx(0.5 * K * closing * (0.0015 + 0.003 - closing), rel=1e-9)
    if face == 0:  # the place of the point on the block of the face is the same
        over = whole.bodies[0].place + matrix(d, 0) @ line.origin - line.origin
        across = line.between + whole.bodies[1].place + point - line.at - over
        np.testing.assert_allclose(met(whole).face_arm, matrix(d, 0) @ line.origin + across, rtol=1e-9)
    bond.gap, twin.gap = 0.001, 0.001
    more = bonds.crush_line(kept, line, bond, -0.003)
    assert more > 0
    gained = taken_by(kept)[2] - 0.5 * K * closing * (0.0015 + 0.003 - closing)
    assert gained == pytest.approx(0.5 * K * more * (0.003 - more), rel=1e-6)


@BOTH
@pytest.mark.parametrize(("bears", "gap"), [(2000.0, -0.003), (2000.0, 0.003), (math.inf, -0.003)])
def test_a_bond_is_crushed_where_it_is_pressed_and_can_be(d, bears, gap):
    whole, _ = bonded_line(d, 0, gap, strength=bears, crushing_rate=50.0, gap=-0.002)
    twin, kept = copy_of(whole.laws[0].rows[0]), books(whole)
    closing = crush(twin, gap, 0.0) if gap < 0 and bears < math.inf else 0.0
    whole.laws[0].act(whole, kept, 0.0, H)
    bond = whole.laws[0].rows[0]
    assert bool(closing > 0) is (bears == 2000.0 and gap < 0)
    assert bond.gap == pytest.approx(gap + closing, rel=1e-9)
    assert bond.integrity <= twin.integrity
    assert bool(taken_by(kept)[2] > 0) is bool(closing > 0)


@BOTH
@pytest.mark.parametrize(("bears", "tension"), [(math.inf, TENSION), (5e3, 0.5), (math.inf, 0.0), (5e3, 0.0)])
def test_a_line_has_what_its_bond_leaves_when_it_has_gone(d, bears, tension):
    whole, _ = bonded_line(
        d, 0, 0.002, integrity=1e-5, secant=2e4, strength=bears, tension=tension, gap=0.003, margin=9.0, push=-60.0
    )
    line, bond = whole.lines[0], whole.laws[0].rows[0]
    line.k, line.c, line.margin = (K - 2e4, 0.5 * C, math.inf) if tension else (K, C, 9.0)
    shear_state, drag = (0.4, 0.3) if d == 2 else ([0.4, 0.1, -0.2], [0.3, -0.5, 0.6])
    bond.shear_state[:], bond.shear_force[:], line.shear_state[:] = shear_state, drag, 7.0
    kept = books(whole)
    bonds.make_dry(kept, line, bond)
    assert taken_by(kept)[0] == pytest.approx(0.5 * 2e4 * 0.003**2 if tension else 0.0)
    assert (line.k, line.c, line.margin) == (K, C, 9.0)
    if tension:
        assert (bond.tension, bond.cohesion, bond.secant, bond.slip_rate) == (0.0, 0.0, 0.0, 0.0)
    if bears == math.inf:
        assert (bond.k, bond.push, line.friction) == (0.0, 0.0, 0.5)
        np.testing.assert_array_equal(line.shear_state, shear_state)
        np.testing.assert_array_equal(line.shear_force, drag)
        assert not bond.shear_state.any()
        assert not bond.shear_force.any()
    else:
        assert (bond.k, bond.push, line.friction) == (K, -60.0, 0.0)
        np.testing.assert_array_equal(bond.shear_state, shear_state)


def test_a_closed_bond_that_goes_takes_nothing_more():
    whole, _ = bonded_line(2, -1, -0.002, secant=2e4, gap=-0.003)
    kept = books(whole)
    bonds.make_dry(kept, whole.lines[0], whole.laws[0].rows[0])
    assert taken_by(kept)[0] == 0.0


@pytest.mark.parametrize(("softened", "goes"), [(8.99, False), (9.01, True)])
def test_a_bond_goes_at_nine_times_the_opening_that_softens_it(softened, goes):
    whole, _ = bonded_line(2, -1, -0.002, integrity=math.exp(-softened), secant=10.0, k_s=1.0, c_s=0.0)
    whole.laws[0].act(whole, books(whole), 0.0, H)
    assert bool(whole.laws[0].rows["k"][0] == 0) is goes
    assert (whole.laws[0].rows["age"][0], whole.lines["k"][0]) == (0.0, K if goes else 0.0)
    assert whole.laws[0].holds(whole.laws[0].rows[0]) == (not goes)


@pytest.mark.parametrize(
    ("changed", "holds"),
    [
        ({}, True),
        ({"k": 0.5}, True),
        ({"k": 0.0}, False),
        ({"tension": 0.0}, False),
        ({"integrity": 1e-5}, False),
        ({"integrity": bonds.INTEGRITY_OF_LOST}, False),
    ],
)
def test_a_bond_holds_while_something_of_it_is_left(changed, holds):
    whole, _ = bonded_line(2, -1, -0.002, **changed)
    assert whole.laws[0].holds(whole.laws[0].rows[0]) == holds


def test_a_pair_does_not_leave_a_joint_whose_bond_holds():
    whole, _ = bonded_line(2, -1, 0.003)
    joints = JointState.intact(np.array([0]), np.array([[0, 1]]), np.array([1e-3]), np.array([2.0]))
    joints.gap[0], left, handed_over = 3e-3, np.zeros(3, dtype=bool), np.array([False])
    mark_left(whole.laws, joints, handed_over, left)
    assert not joints.left.any()
    assert not left.any()
    whole.laws[0].rows["tension"] = 0.0
    mark_left(whole.laws, joints, handed_over, left)
    assert (joints.left.tolist(), left.tolist()) == ([True], [True, True, False])


@pytest.mark.parametrize(("left", "ages"), [(0.51, True), (0.49, False), (0.5, False)])
def test_a_bond_ages_until_it_has_cracked(left, ages):
    whole, _ = bonded_line(
        2, -1, -0.002, integrity=left, largest_gap=0.1, crack=0.1, secant=10.0, age=0.25, cohesion=1e9
    )
    whole.laws[0].act(whole, books(whole), 0.0, H)
    assert whole.laws[0].rows["age"][0] == (0.25 + H if ages else 0.25)


def test_lines_without_a_bond_are_left_alone():
    whole, _ = bonded_line(2, -1, -0.003, k=0.0)
    whole.laws[0].act(whole, books(whole), 0.0, H)
    assert not whole.bodies["force"].any()


@BOTH
def test_bonds_store_what_secant_and_shear_spring_hold(d):
    whole = system(d, 2)
    table = whole.laws[0].rows
    table["secant"], table["gap"], table["k_s"] = [2e4, 3e4], [0.002, -0.001], [5e4, 6e4]
    table["shear_state"] = [[0.001], [0.002]] if d == 2 else [[0.001, 0.002, 0.002], [0.0, 0.003, 0.004]]
    squares = (1e-6, 4e-6) if d == 2 else (9e-6, 25e-6)
    along = 0.5 * (5e4 * squares[0] + 6e4 * squares[1])
    assert whole.laws[0].stored() == pytest.approx((0.5 * (2e4 * 4e-6 + 3e4 * 1e-6), along))


@pytest.mark.parametrize("space", [False, True])
def test_the_bonds_of_masonry_have_the_strength_of_its_joints(space):
    """Forces are strengths times area, shared by the lines. What the bond takes over is zero in the line."""
    bond = mr.Bond(0.25e6, 0.35e6, 18.0, 125.0, 10.5e6, 5e3, residual_friction=0.5)
    more = {"space": space, "xi": 0.05, "frequency": 100.0}
    whole, dry = (
        setup_of(mr.MasonryCase(joint(each, **more), 1.0, settled=False), None, None).system for each in (bond, None)
    )
    lines, table = whole.lines, whole.laws[0].rows
    for name in ("k", "c", "k_s", "c_s"):  # a dry joint shares them out to its lines in another way
        assert table[name].sum() == pytest.approx(dry.lines[name].sum())
        np.testing.assert_allclose(table[name] / table[name].sum(), table["k"] / table["k"].sum())
    np.testing.assert_allclose(np.sort(table["margin"]), np.sort(dry.lines["margin"]))
    assert (table["friction"] == 0.75).all()
    assert not table["shear_state"].any()
    assert len(table) == len(lines)
    for name in ("k", "c", "friction", "shear_state"):
        assert not lines[name].any()
    assert (lines["margin"] == math.inf).all()
    for name, strength in (("tension", 0.25e6), ("cohesion", 0.35e6), ("strength", 10.5e6)):
        assert table[name].sum() == pytest.approx(strength * AREA)
    np.testing.assert_allclose(table["secant"], table["k"])
    assert table["k"].sum() == pytest.approx(K_N * AREA)
    assert table["k_s"].sum() == pytest.approx(K_S * AREA)
    for name, rate in (("opening_rate", 0.25e6 / 18.0), ("slip_rate", 0.35e6 / 125.0), ("crushing_rate", 10.5e6 / 5e3)):
        np.testing.assert_allclose(table[name], rate)
    for name, value in (("integrity", 1.0), ("residual", 0.5), ("friction_drop", 0.25)):
        np.testing.assert_allclose(table[name], value)
    assert len(dry.laws[0].rows) == 0


@pytest.mark.filterwarnings("ignore:tension = .* is it in MPa:mjrock.Implausible")
def test_a_bond_of_a_newton_tears_too():
    weak = setup_of(mr.MasonryCase(joint(mr.Bond(0.5, 0.5, 1e-6, 1e-6)), 1.0, settled=False), None, None).system
    assert (weak.laws[0].rows["tension"] < 0.1).all()
    np.testing.assert_array_equal(weak.laws[0].rows["secant"], weak.laws[0].rows["k"])
    whole, _ = bonded_line(2, -1, 0.003, tension=0.5)
    whole.laws[0].act(whole, books(whole), 0.0, H)
    assert 0 < whole.laws[0].rows["secant"][0] < K
    assert whole.laws[0].holds(whole.laws[0].rows[0]) == (whole.laws[0].rows["integrity"][0] > bonds.INTEGRITY_OF_LOST)


def test_a_bond_without_strength_in_tension_leaves_the_normal_to_its_line():
    bond = mr.Bond(0.0, 0.0, 18.0, 125.0, 10.5e6, 5e3)
    whole = setup_of(mr.MasonryCase(joint(bond), 1.0, settled=False), None, None).system
    assert whole.lines["k"].sum() == pytest.approx(K_N * AREA)
    assert not whole.laws[0].rows["secant"].any()
    assert np.isfinite(whole.lines["margin"]).all()
    assert whole.laws[0].rows["strength"].sum() == pytest.approx(10.5e6 * AREA)
    never = setup_of(mr.MasonryCase(joint(MORTAR), 1.0, settled=False), None, None).system
    assert (never.laws[0].rows["strength"] == math.inf).all()


def wall():
    """Three blocks with a bond in the upper joint alone."""
    box = [(-0.1, 0.1)] * 3
    blocks = [
        mr.Polygon([(left, z), (right, z), (right, z + 0.1), (left, z + 0.1)], length=0.1, fixed=z < 0, name=name)
        for (left, right), z, name in zip(box, (-0.1, 0.0, 0.1), "abc", strict=True)
    ]
    bond = lambda joint: MORTAR if joint.name == "b|c" else None  # noqa: E731
    return mr.Masonry(blocks, k_n=K_N, k_s=K_S, friction=0.75, xi=0.0, points=3, bond=bond)


def test_joints_without_a_bond_stay_dry_and_do_not_crack():
    masonry = wall()
    setup = setup_of(mr.MasonryCase(masonry, 1.0, settled=False), None, None)
    of = np.repeat([0, 1], 3)
    bonded = np.array([joint.name == "b|c" for joint in masonry.joints])[of]
    law, lines = setup.system.laws[0], setup.system.lines
    table = law.rows
    np.testing.assert_array_equal(table["k"] > 0, bonded)
    np.testing.assert_array_equal(lines["k"] > 0, ~bonded)
    np.testing.assert_array_equal(lines["friction"] > 0, ~bonded)
    assert law.cracked(setup.scene) == {}
    table["age"][bonded], table["integrity"][bonded] = [0.1, 0.3, 0.2], [0.5, 0.4, 0.6]
    assert law.cracked(setup.scene) == {}
    table["integrity"][bonded] = [0.5, 0.4, 0.3]
    assert law.cracked(setup.scene) == {"b|c": 0.3}


def test_joints_are_named_in_the_order_in_which_they_cracked():
    blocks = [
        mr.Polygon([(-0.1, z), (0.1, z), (0.1, z + 0.1), (-0.1, z + 0.1)], length=0.1, fixed=z < 0, name=name)
        for z, name in zip((-0.1, 0.0, 0.1), "abc", strict=True)
    ]
    masonry = mr.Masonry(blocks, k_n=K_N, k_s=K_S, friction=0.75, points=3, bond=MORTAR)
    setup = setup_of(mr.MasonryCase(masonry, 1.0, settled=False), None, None)
    law = setup.system.laws[0]
    law.rows["integrity"], law.rows["age"] = 0.1, np.array([0.5, 0.6, 0.7, 0.1, 0.2, 0.3])
    found = law.cracked(setup.scene)
    assert list(found.items()) == [(masonry.joints[1].name, 0.3), (masonry.joints[0].name, 0.7)]


def test_lines_that_are_handed_over_have_back_what_their_bond_has():
    whole = system(2, 3)
    for name, value in {
        "k": [0.5, K, 0.0],
        "c": C,
        "friction": 0.6,
        "margin": 9.0,
        "shear_state": 0.4,
        "shear_force": 0.3,
    }.items():
        whole.laws[0].rows[name] = (
            np.array(value)[:, None] if name in ("shear_state", "shear_force") and np.ndim(value) else value
        )
    whole.laws[0].rows["secant"], whole.laws[0].rows["push"] = 2e5, 50.0
    whole.laws[0].release(whole.lines, np.array([True, False, True]))
    np.testing.assert_array_equal(whole.lines["k"], [0.5, 0.0, 0.0])
    for name, value in (("c", C), ("friction", 0.6), ("margin", 9.0)):
        assert whole.lines[name][0] == value
    assert (whole.lines["shear_state"][0], whole.lines["shear_force"][0]) == (0.4, 0.3)
    for name in ("k", "secant", "shear_state", "shear_force", "push"):
        assert not whole.laws[0].rows[name][0].any()
        assert whole.laws[0].rows[name][1].any()
    assert whole.laws[0].rows["secant"][2] == 2e5
