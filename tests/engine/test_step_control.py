"""How long steps may be, rule by rule, and which edges stick in them."""

import dataclasses
import math

import numpy as np
import pytest
from scenes import changed, course, two_blocks

import mjrock as mr
from mjrock.engine.rows import Step, points_of
from mjrock.engine.step_control import (
    StepControl,
    kind_of_step,
    limited_by_loaded_contacts,
    limited_by_taut_ties,
    next_length,
    short_step,
)
from mjrock.engine.sticking import Joints, StepMotion, deepest_point, presses_unloaded, rolling_distance
from mjrock.engine.touches import Openings
from mjrock.geometry.frames import frames_of
from mjrock.geometry.kinematics import gap, gaps, meeting
from mjrock.geometry.vectors import tangent
from mjrock.method import METHOD
from mjrock.scene.wall import wall_course, wall_scene


@pytest.fixture
def scene(one_sided, contacts):
    return wall_scene(one_sided, contacts)


def openings(count, of):
    """Openings of some springs that are closed and still, but for those in `of`: value, rate, linear, swept."""
    found = Openings(*np.zeros((4, count)))
    for i, values in of.items():
        for one, value in zip(found, values, strict=True):
            one[i] = value
    return found


def test_the_limits_of_a_wall(scene, wall, contacts):
    """The short step resolves the contacts, the longest the rocking; both go with the root of the accuracy."""
    control = StepControl.from_scene(scene, course(scene), 1e-4)
    assert control.short == pytest.approx(math.sqrt(METHOD.short * 1e-4) / scene.highest_frequency)
    assert control.longest == pytest.approx(math.sqrt(METHOD.longest * 1e-4) / wall.p)
    assert StepControl.from_scene(scene, course(scene), 0.1).short == pytest.approx(
        METHOD.most / scene.highest_frequency
    )
    # two lines hold m g with their springs, m g / 2 each
    assert control.least_energy == pytest.approx(wall.weight**2 / contacts.base.stiffness.sum())
    np.testing.assert_allclose(control.ringing, [[0] * 4, [METHOD.ringing_borne] * 2 + [METHOD.ringing_open] * 2])
    np.testing.assert_allclose(control.beta, [[1 / 12] * 4, (1 + control.ringing[1] ** 2) / 4])
    for share, kind in ((0.99, 0), (1.01, 1)):
        assert kind_of_step(control, share * METHOD.smooth / scene.highest_frequency) == kind


def test_a_record_and_a_dashpot_shorten_the_steps(wall, contacts):
    """No step is longer than that of the record. A dashpot is resolved down to an eighth of the step of the spring."""
    motion = mr.GroundMotion([0.0, 1.0, 0.0], 3e-3)
    for shaken in (
        mr.Case(wall, 0.0, 1.0, motion=motion),
        mr.Case(wall, 0.0, 1.0, motion=motion, vertical=mr.GroundMotion([0.0, 1.0, 0.0], 4e-3)),
        mr.Case(wall, 0.0, 1.0, vertical=motion),
    ):
        scene = wall_scene(shaken, contacts)
        assert StepControl.from_scene(scene, wall_course(shaken, scene), 1e-3).longest == 3e-3
    case = mr.Case(wall, 0.0, 1.0, side_stop=False)
    for xi, limited in ((0.08, False), (0.12, False), (0.2, True), (0.8, True)):
        damped = wall_scene(case, dataclasses.replace(contacts, base=dataclasses.replace(contacts.base, xi=xi)))
        spring = math.sqrt(METHOD.short * 1e-3) / damped.highest_frequency
        # the least mass that a contact may feel is 1 / (6 W), a quarter of the wall's
        dashpot = math.sqrt(METHOD.dashpot * 1e-3) * wall.mass / 4 / damped.contacts.c[0]
        assert dashpot < spring
        assert bool(dashpot < spring / 8) is limited
        assert short_step(damped, 1e-3) == pytest.approx(spring / 8 if limited else dashpot)


def test_a_step_is_judged_by_the_change_of_acceleration(scene):
    """Halved above what is tolerated, doubled after two steps in a row below a quarter of it."""
    control = StepControl.from_scene(scene, course(scene), 1e-3)
    tolerated, h = (METHOD.change * 1e-3) ** 2, math.sqrt(control.short * control.longest)
    assert next_length(control, h, 1.01 * tolerated, 1) == (0.5 * h, 0)
    assert next_length(control, h, 0.99 * tolerated, 1) == (h, 0)
    assert next_length(control, h, 1.01 * tolerated / 16, 1) == (h, 0)
    assert next_length(control, h, 0.99 * tolerated / 16, 0) == (h, 1)
    assert next_length(control, h, 0.99 * tolerated / 16, 1) == (2 * h, 0)
    assert next_length(control, 1.5 * control.short, 2 * tolerated, 0) == (control.short, 0)
    assert next_length(control, 0.7 * control.longest, 0.0, 1) == (control.longest, 0)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_loaded_point_stays_loaded(scene, sign):
    """h^2/2 |g2| = stays |g|; what has lifted off or bears nothing at rest does not count."""
    pressed, curve, points = scene.bears[0], 3.0, points_of(scene)
    control = StepControl.from_scene(scene, course(scene), 1e-3)._replace(short=1e-5)
    longest = math.sqrt(2 * METHOD.stays * pressed / curve)
    just, hardly = 1.01 * METHOD.loaded, 0.99 * METHOD.loaded
    for point, share, counts in ((0, 1.0, True), (1, just, True), (1, hardly, False), (3, 1, False)):
        moving = openings(4, {point: (-share * pressed, 0.0, 7.0, sign * curve)})
        expected = math.sqrt(share) * longest if counts else 1.0
        assert limited_by_loaded_contacts(control, points, moving, 1.0) == pytest.approx(expected)
    moving = openings(4, {0: (-pressed, 0.0, 0.0, sign * curve), 3: (-pressed, 0.0, 7.0, sign * curve)})
    assert limited_by_loaded_contacts(control, points, moving, 0.99 * longest) == 0.99 * longest
    assert limited_by_loaded_contacts(control._replace(short=2 * longest), points, moving, 1.0) == 2 * longest


def test_a_tie_that_can_yield_is_met_at_its_greatest_length():
    """A taut tie that still lengthens at 0.3 m/s and is held back with 20 + 10 m/s2 is longest after 10 ms."""
    scene = two_blocks()
    ties = scene.ties._replace(k=np.ones(1), stretch=np.ones(1), reach=np.ones(1))
    longer = openings(5, {4: (-0.01, -0.3, 20.0, 10.0)})
    control = StepControl.from_scene(scene, course(scene), 1e-3)._replace(short=1e-4, taut=1.0)
    assert limited_by_taut_ties(control, ties, longer, 0.02) == pytest.approx(0.01)
    assert limited_by_taut_ties(control._replace(short=0.015), ties, longer, 0.02) == 0.015
    assert limited_by_taut_ties(control, ties, longer, 0.009) == 0.009
    for other in ((0.01, -0.3, 20.0, 10.0), (-0.01, 0.3, 20.0, 10.0)):  # slack, and shortening
        assert limited_by_taut_ties(control, ties, openings(5, {4: other}), 0.02) == 0.02
    elastic = ties._replace(stretch=np.array([math.inf]))
    assert limited_by_taut_ties(control, elastic, longer, 0.02) == 0.02
    assert limited_by_taut_ties(control._replace(taut=0.004), elastic, longer, 0.02) == 0.004
    slack = openings(5, {4: (0.01, -0.3, 20.0, 10.0)})
    assert limited_by_taut_ties(control._replace(taut=0.004), elastic, slack, 0.02) == 0.02


def test_steps_on_a_taut_tie(wall, contacts):
    """omega h = sqrt(taut accuracy), omega = sqrt(k (1/m + h^2/I)) of a level tie at the top of the inner face."""
    free = mr.Case(wall, 0.05, 1.0)
    tied = mr.Case(wall, 0.05, 1.0, effects=(mr.Tie(2 * wall.h, 1e6),))

    def taut(case):
        scene = wall_scene(case, contacts)
        return StepControl.from_scene(scene, wall_course(case, scene), 1e-3).taut

    assert taut(free) == math.inf
    omega = math.sqrt(1e6 * (1 / wall.mass + wall.h**2 / wall.inertia))
    assert taut(tied) == pytest.approx(math.sqrt(METHOD.taut * 1e-3) / omega)


def with_stops(scene):
    """Two blocks with a stop before each of them, one millimetre away, and one between them that meets no weight."""
    extra = {
        "body": [0, 1, 1],
        "at": [(-0.3, 0.0), (-0.3, 0.0), (0.0, -1.05)],
        "face_body": [-1, -1, 0],
        "face_at": [(-0.301, 0.0), (-0.301, 0.0), (0.0, 1.049)],
        "normal": [(1, 0), (1, 0), (0, 1)],
        "k": [1e7] * 3,
        "c": [0.0] * 3,
        "friction": [0.0] * 3,
        "k_s": [np.inf] * 3,
        "area": [0.0] * 3,
        "joint": [2, 2, 3],
        "joints": ("stop", "pin"),
    }
    more = {name: (*getattr(scene.contacts, name), *values) for name, values in extra.items()}
    return changed(scene, contacts={"holds": False} | more)


def test_which_body_presses_what_bears_nothing_at_rest():
    """The stop of a body concerns that body alone, and the pin between the two concerns both."""
    scene = with_stops(two_blocks())
    np.testing.assert_array_equal(scene.bears > 0, [True] * 4 + [False] * 3)
    for moved, pressing in (
        ((0, 0, 0, 0), (False, False)),
        ((-0.002, 0, 0, 0), (True, False)),
        ((0, 0, -0.002, 0), (False, True)),
        ((0, 0, 0, -0.002), (True, True)),
    ):
        pose = scene.at_rest.ravel() + np.array([moved[0], moved[1], 0, moved[2], moved[3], 0])
        found = tuple(presses_unloaded(points_of(scene), body, frames_of(pose)) for body in (0, 1))
        assert found == pressing


def test_joints_go_from_the_ground_upwards():
    """However the bodies are numbered; a body that stands on two others has none."""
    scene = two_blocks()
    assert Joints.of_scene(scene).body.tolist() == [0, 1]
    faces = {"face_body": [1, 1, -1, -1], "face_at": scene.contacts.face_at[::-1]}
    joints = Joints.of_scene(changed(scene, bodies={"rest": scene.bodies.rest[::-1]}, contacts=faces))
    assert joints.body.tolist() == [1, 0]
    assert joints.of.tolist() == [1, 1, 0, 0]
    bridge = {"face_body": [-1, -1, 0, -1], "face_at": [(0, 0), (0, 0), (0, 1.05), (0, 2.1)]}
    assert len(Joints.of_scene(changed(scene, contacts=bridge)).body) == 0


def test_the_deepest_point_of_a_joint():
    """Of its own joint alone, and of closed points alone."""
    scene = two_blocks()
    joints, frame = Joints.of_scene(scene), np.zeros((2, 4))
    for lean, found in (((0.01, 0.01), (1, -1)), ((-0.01, 0.02), (0, 3)), ((0.01, -0.03), (1, 2))):
        pose = np.array([0, -1e-3, lean[0], 0, -2e-3, lean[1]])
        frame[:] = frames_of(pose)
        depths = -gaps(scene.places, pose[None])[0]
        for joint, of in ((0, (0, 1)), (1, (2, 3))):
            best = max(of, key=lambda i: depths[i])
            expected = best if depths[best] > 0 else -1
            assert deepest_point(scene.places, joints, joint, frame) == expected
        assert deepest_point(scene.places, joints, 0, frame) == found[0]


@pytest.mark.parametrize("i", [1, 3])
def test_an_edge_rolls_about_the_place_of_friction(i):
    """Where that place, half the penetration above the point, does not slip, the point moves by half of it."""
    scene, turn = two_blocks(), 1e-4
    pose = np.array([0, -0.004, 0.0, 0, -0.007, 0.0])
    later = pose.copy()
    later[3 * scene.contacts.body[i] + 2] += turn
    if i == 3:
        later[2] += 3 * turn  # the face turns as well, and only what is left turns the point against it
    depth = [-gap(scene.places, i, frames_of(q), q, q).value for q in (pose, later)]
    relative = turn if i == 1 else -2 * turn
    meets = meeting(scene.places, i, frames_of(later))
    step = StepMotion(
        Step(1e-3, np.zeros(0), np.zeros(0)), 1.0, 0 * pose, 0 * pose, pose, later, frames_of(pose), frames_of(later)
    )
    assert rolling_distance(scene.places, i, meets, tangent(meets.normal), step) == pytest.approx(
        -relative * 0.5 * np.mean(depth), rel=1e-12
    )


@pytest.mark.parametrize(("share", "slides"), [(0.9, False), (1.2, True)])
def test_a_base_sticks_up_to_mu(share, slides):
    """Pushed with a constant acceleration, a block slides by what is beyond mu g, and else stays where it is."""
    mu, block = 0.3, mr.Block.from_size(2.0, 2.0)
    contacts = mr.Contacts.from_damping(block, k_base=5e8, xi_base=0.05, friction=mu)
    push = share * mu * mr.GRAVITY
    motion = mr.GroundMotion(-push * np.minimum(np.arange(101) / 50, 1.0), 0.01)  # it sets in within half a second
    run = mr.simulate(mr.Case(block, 0.0, 1.0, side_stop=False, motion=motion), contacts)
    if not slides:
        assert abs(run.stats["base_displacement"]) < 1e-6
        return
    t, dt = np.linspace(0, 1, 100001, retstep=True)
    speed = np.cumsum(np.maximum(push * np.minimum(2 * t, 1.0) - mu * mr.GRAVITY, 0.0)) * dt
    assert run.stats["base_displacement"] == pytest.approx(speed.sum() * dt, rel=2e-2)


def test_between_blocks_the_extra_dashpot_is_only_what_the_joint_lacks():
    for xi in (0.0, 1e-4, 0.05):
        scene = two_blocks(xi=xi)
        control = StepControl.from_scene(scene, course(scene), 1e-3)
        lacking = np.maximum(METHOD.ringing_borne - scene.contacts.c / scene.contacts.k / control.longest, 0)
        np.testing.assert_allclose(control.ringing[1], lacking)
        assert (lacking[0] == METHOD.ringing_borne, lacking[0] == 0) == (xi == 0, xi == 0.05)
