"""The pose, gravity, points and bonds of a contact: what `contact_for` takes from a model where it stands."""

import math
import warnings
from itertools import pairwise

import mujoco
import numpy as np
import pytest
from pairs import BALL, BOX, FLAT_BOX, FLOOR, ON_A_PLANE, scene

import mjrock as mr
from mjrock.contacts.contact import weight_caveats
from mjrock.contacts.meeting import Pose
from scripts.checks import requested_and_found as study

LEG = study.leg(others=study.BENT).text()
BENT = [0, 0, 0.6, 1, 0, 0, 0, 0.7, -1.4]


def spec_of(text):
    return mujoco.MjSpec.from_string(text)


def quietly(text, *geoms, **requested):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return mr.contact_for(spec_of(text), *geoms, **requested)


@pytest.mark.parametrize("name", ["ball, g/(omega v) = .085", "box on an edge, 45 deg", "leg, bent", "geared, 0.2 ms"])
def test_the_restitution_that_was_asked_for(name):
    found, warned = study.LANDINGS[name].found(0.3)
    assert found == pytest.approx(0.3, abs=study.RIGHT)
    assert not warned


@pytest.mark.slow
def test_every_landing_is_right_or_warned_of(tmp_path):
    study.main(["--out", str(tmp_path)])
    table = (tmp_path / "requested_and_found.txt").read_text()
    assert "WRONG" not in table
    assert table.count("  right\n") >= 20


def test_the_mass_is_that_of_the_pose():
    """A knee that is bent leaves a hundredth of the body's mass to the foot; a straight leg carries it all."""
    straight = quietly(LEG, "foot", "floor", k=5e4, restitution=0.2, friction=0)
    bent = mr.contact_for(spec_of(LEG), "foot", "floor", k=5e4, restitution=0.2, friction=0, keyframe="bent")
    by_number = mr.contact_for(spec_of(LEG), "foot", "floor", k=5e4, restitution=0.2, friction=0, keyframe=0)
    given = mr.contact_for(spec_of(LEG), "foot", "floor", k=5e4, restitution=0.2, friction=0, qpos=BENT)
    assert straight.mass == pytest.approx(7.02)
    assert bent.mass == pytest.approx(0.1716, abs=1e-4)
    assert bent.mass == by_number.mass == pytest.approx(given.mass)
    assert (straight.pose, bent.pose, given.pose) == ("qpos0", "keyframe 'bent'", "qpos")
    assert mr.inspect_contacts(spec_of(LEG), keyframe="bent")[0].mass < 0.4
    assert mr.inspect_contacts(spec_of(LEG), qpos=BENT)[0].mass < 0.4
    assert mr.inspect_contacts(spec_of(LEG))[0].mass == pytest.approx(7.02)


def test_a_keyframe_that_differs_is_named():
    with pytest.warns(UserWarning, match=r"0.172 kg at keyframe 'bent' and 7.02 kg at qpos0.*keyframe='bent'"):
        contact = mr.contact_for(spec_of(LEG), "foot", "floor", k=5e4, restitution=0.2, friction=0)
    contact.apply(applied := spec_of(LEG))
    assert any("keyframe 'bent'" in caveat for caveat in contact.caveats(applied))
    assert any("keyframe 'bent'" in note for note in mr.inspect_contacts(spec_of(LEG))[0].notes)
    mr.contact_for(spec_of(LEG), "foot", "floor", k=5e4, c=30.0, friction=0)  # a dashpot needs no mass


@pytest.mark.parametrize(
    ("requested", "complaint"),
    [
        ({"keyframe": "sit"}, "keyframe = 'sit' of type str is not a keyframe of this model; it has: bent"),
        ({"keyframe": 1}, "keyframe = 1 is outside the valid range 0 to 0"),
        ({"keyframe": "bent", "qpos": BENT}, "keyframe = 'bent' of type str and qpos are both given"),
        ({"qpos": [1.0]}, r"qpos has the shape \(1,\); \(9,\) is needed"),
        ({"qpos": [1e300, *BENT[1:]]}, "qpos holds a value outside the valid range"),
        ({"speed": 0.0}, "speed = 0 m/s is outside"),
        ({"k": None, "restitution": None, "c": 3.0}, "k = None takes restitution or xi, and c = 3.0 is given"),
        ({"k": None, "restitution": None}, "exactly one of c, restitution and xi"),
    ],
)
def test_what_cannot_be_is_refused(requested, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.contact_for(spec_of(LEG), "foot", "floor", **{"k": 5e4, "restitution": 0.2} | requested)
    if "keyframe" in requested:
        with pytest.raises(ValueError, match="keyframe"):
            mr.inspect_contacts(spec_of(LEG), **requested)


def test_a_model_without_keyframes_says_so():
    with pytest.raises(ValueError, match="keyframe = 0 of type int is given, and this model has none"):
        mr.contact_for(spec_of(ON_A_PLANE), "ball", "floor", k=1e6, c=3.0, keyframe=0)


def test_gravity_at_a_speed():
    """At g / (omega v) = 0.085, e = 0.3 takes xi = 0.355 instead of 0.497."""
    text = scene(FLOOR, BALL, gravity=9.81)
    omega = math.sqrt(1e6 / 2)
    speed = 9.81 / omega / 0.085
    contact = mr.contact_for(spec_of(text), "ball", "floor", k=1e6, restitution=0.3, speed=speed)
    assert contact.xi == pytest.approx(0.355, abs=1e-3)
    assert contact.restitution == pytest.approx(0.3, abs=1e-6)
    assert contact.gravity == pytest.approx(9.81)
    assert contact.restitution_at(100.0) > 0.39
    unsaid = mr.contact_for(spec_of(text), "ball", "floor", k=1e6, restitution=0.3)
    assert unsaid.restitution == pytest.approx(0.3)
    assert unsaid.restitution_at(speed) == pytest.approx(0.152, abs=1e-3)
    assert unsaid.restitution_at(1e-9) == 0.0
    with pytest.raises(ValueError, match="speed = 1e-06 m/s is too slow to rebound; the valid range is from"):
        mr.contact_for(spec_of(text), "ball", "floor", k=1e6, restitution=0.3, speed=1e-6)


def test_a_small_restitution_under_gravity_is_warned_of():
    text = scene(FLOOR, BALL, gravity=9.81)
    with pytest.warns(UserWarning, match=r"gravity lowers so small a restitution: e = 0.2 becomes .* give speed"):
        contact = mr.contact_for(spec_of(text), "ball", "floor", k=1e6, restitution=0.2)
    named = float(str(next(iter(weight_caveats(contact)))).split("below ")[1].split()[0])
    assert contact.restitution_at(named) == pytest.approx(0.1, abs=0.02)
    assert not list(weight_caveats(mr.contact_for(spec_of(text), "ball", "floor", k=1e6, restitution=0.3)))
    assert not list(weight_caveats(mr.contact_for(spec_of(text), "ball", "floor", k=1e6, restitution=0.01)))
    assert not list(weight_caveats(mr.contact_for(spec_of(ON_A_PLANE), "ball", "floor", k=1e6, restitution=0.2)))
    two = scene(BALL, BALL.replace("ball", "other").replace("0 0 .1", "0 0 .4"), gravity=9.81)
    assert mr.contact_for(spec_of(two), "ball", "other", k=1e6, restitution=0.2).gravity == 0.0


def test_bodies_of_a_pile_fall_alike_exactly():
    """What is left of their accelerations by rounding is no gravity, of which a small restitution would be warned."""
    balls = [
        BALL.replace("ball", f"ball{i}").replace("0 0 .1", f"0 0 {0.1 + 0.2 * i}").replace('"2"', f'"{mass}"')
        for i, mass in enumerate([1.5] * 4 + [300])
    ]
    names = [f"ball{i}" for i in range(5)]
    for below, above in pairwise(names):
        contact = mr.contact_for(spec_of(scene(*balls, gravity=9.81)), above, below, k=1e6, restitution=0.1)
        assert "carries nothing at rest" in str(contact)  # all of them fall
        assert contact.gravity == 0.0
        assert not list(weight_caveats(contact))


def test_mujocos_default_under_gravity():
    """e = 0.135 of the formula is 0 at 5 m/s, 0.03 at 5.6 m/s and 0.09 at 10 m/s, with the impedance at full width."""
    both = 'solimp=".95 .95 .001"'
    text = scene(FLOOR.replace("/>", f" {both}/>"), BALL.replace("/></body>", f" {both}/></body>"), gravity=9.81)
    (found,) = mr.inspect_contacts(mujoco.MjModel.from_xml_string(text))
    assert found.restitution == pytest.approx(0.135, abs=1e-3)
    assert [found.restitution_at(speed) for speed in (5.0, 5.6, 10.0)] == pytest.approx([0, 0.027, 0.09], abs=2e-3)


@pytest.mark.parametrize(
    ("name", "points"),
    [
        ("ball", 1),
        ("box on a face", 4),
        ("box on an edge, 20 deg", 2),
        ("box on a corner", 1),
        ("capsule, lying", 2),
        ("capsule, leaning", 1),
        ("cylinder on its end", 3),
        ("cylinder, lying", 2),
        ("mesh on its base", 4),
    ],
)
def test_the_points_are_counted(name, points):
    contact = quietly(study.LANDINGS[name].text(), "foot", "floor", k=1e5, restitution=0.5)
    assert contact.contacts == points
    (found,) = mr.inspect_contacts(spec_of(study.LANDINGS[name].text()))
    assert found.points == points
    assert found.mass == pytest.approx(contact.mass * points, rel=1e-3)


def test_points_are_counted_wherever_the_geoms_are():
    """In either order, between two boxes, in a body of several geoms, with two pairs of them, and excluded ones."""
    table = (
        '<body name="table" pos=".03 0 -.1"><freejoint/><geom name="table" type="box" size=".5 .5 .1" mass="9"/></body>'
    )
    box = BOX.format(quat="1 0 0 0").replace("0 0 .1", "0 0 .7")
    for order in (("box", "table"), ("table", "box")):
        contact = mr.contact_for(spec_of(scene(table, box)), *order, k=1e6, restitution=0.5)
        assert contact.contacts == 4
        assert contact.mass < 18 / 11 / 4
    twice = '<pair geom1="box" geom2="floor"/>' * 2 + '<exclude body1="box" body2="world"/>'
    with pytest.warns(UserWarning, match="2 explicit"):
        contact = mr.contact_for(spec_of(scene(FLOOR, box, pair=twice)), "box", "floor", k=1e6, restitution=0.5)
    assert contact.contacts == 4


def test_other_points_than_are_counted_refer_to_the_centres():
    tilted = scene(FLOOR, BOX.format(quat=".9 .3 -.2 .1"))
    assert mr.contact_for(spec_of(tilted), "box", "floor", k=1e6, restitution=0.5, friction=0).mass < 1.5
    assert mr.contact_for(spec_of(tilted), "box", "floor", k=1e6, restitution=0.5, contacts=4).mass == 0.5
    assert mr.contact_for(spec_of(FLAT_BOX), "box", "floor", k=1e6, restitution=0.5, contacts=1).mass == 2.0


def test_a_point_that_sticks_has_more_mass():
    """1/m = W_nn - W_nt^2 / W_tt where friction holds the point, and W_nn - mu W_nt where it slips."""
    tilt = math.radians(20)
    text = study.LANDINGS["box on an edge, 20 deg"].text()
    half, inertia = np.array([0.1, 0.05]), 1.3 * (0.1**2 + 0.05**2) / 3
    across = half[0] * math.cos(tilt) - half[1] * math.sin(tilt)
    down = half[0] * math.sin(tilt) + half[1] * math.cos(tilt)
    normal, both, tangent = 1 / 1.3 + across**2 / inertia, across * down / inertia, 1 / 1.3 + down**2 / inertia
    expected = {0.0: normal, 0.3: normal - 0.3 * both, 1.0: normal - both**2 / tangent}
    for friction, freedom in expected.items():
        contact = mr.contact_for(spec_of(text), "foot", "floor", k=1e5, restitution=0.5, friction=friction)
        assert 2 * contact.mass == pytest.approx(1 / freedom, rel=5e-4)


def test_what_else_holds_a_body_counts_or_is_named():
    named = {
        "welded, 20 ms": r"equality constraint \[0\] yields",
        "strut of 1e5 N/m": "joint strut adds 1e.05 N/m",
        "tendon, spring": "tendon cable adds 5e.04 N/m",
        "leg, bent, damped": "joint knee, joint hip add a damping ratio",
        "leg, bent, sprung": "joint knee, joint hip add .* N/m to the",
    }
    for name, complaint in named.items():
        text, pose = study.LANDINGS[name].text(), study.LANDINGS[name].pose
        with pytest.warns(UserWarning, match=complaint):
            mr.contact_for(spec_of(text), "foot", "floor", k=1e5, restitution=0.5, **pose)
    masses = {
        "welded, 0.2 ms": 4.5,
        "geared, 0.2 ms": 1 + 12**2 * 2 * (0.1**2 / 4 + 0.02**2 * 4 / 12),
        "tendon, armature": 0.95,
    }
    for name, mass in masses.items():
        contact = mr.contact_for(spec_of(study.LANDINGS[name].text()), "foot", "floor", k=1e5, restitution=0.5)
        assert contact.mass == pytest.approx(mass, rel=1e-4), name


def test_servos_and_limits_are_named():
    slide = """<body pos="0 0 .5"><joint name="lift" type="slide" axis="0 0 1" {limit}/>
    <geom name="ball" size=".1" mass="2"/></body>"""
    limit = 'limited="true" range="-1 -.001"'
    text = scene(FLOOR, slide.format(limit=""))
    servo = '<actuator><position name="servo" joint="lift" kp="2e5" kv="300"/></actuator></mujoco>'
    stiff, damped = quietly(text.replace("</mujoco>", servo), "ball", "floor", k=1e6, restitution=0.5).remarks
    assert stiff.startswith("actuator servo adds 2e+05 N/m to the 1e+06 N/m")
    assert damped.startswith("actuator servo adds a damping ratio of 0.11")
    with pytest.warns(UserWarning, match="joint lift is at its limit in this pose"):
        mr.contact_for(spec_of(scene(FLOOR, slide.format(limit=limit))), "ball", "floor", k=1e6, restitution=0.5)


def test_the_stiffest_contact_of_a_step():
    """It is what the warning of a long step names, and is not warned of."""
    spec = spec_of(scene(FLOOR, BALL, timestep=1e-3))
    for e in (0.05, 0.5, 1.0):
        stiffest = mr.contact_for(spec, "ball", "floor", restitution=e)
        assert stiffest.frequency * 1e-3 <= 0.3
        with pytest.warns(UserWarning, match="or k = .* N/m at this step") as caught:
            mr.contact_for(spec, "ball", "floor", k=1.1 * stiffest.k, restitution=e)
        named = float(str(caught[0].message).split("or k = ")[1].split()[0])
        assert named == pytest.approx(stiffest.k, rel=0.1)
        mr.contact_for(spec, "ball", "floor", k=named, restitution=e)
    assert mr.contact_for(spec, "ball", "floor", xi=0.2).xi == pytest.approx(0.2)
    weighed = spec_of(scene(FLOOR, BALL, timestep=1e-3, gravity=9.81))
    contact = mr.contact_for(weighed, "ball", "floor", restitution=0.3, speed=0.5)
    assert contact.restitution == pytest.approx(0.3, abs=1e-6)


def test_the_stiffness_under_a_load():
    """MuJoCo's impedance grows from 0.9 to 0.95 within a millimetre: k at rest is what the ball sinks in by."""
    spec = spec_of(scene(FLOOR, BALL, gravity=9.81, timestep=1e-3))
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 4000)
    (found,) = mr.inspect_contacts(model)
    assert found.load == pytest.approx(2 * 9.81)
    assert found.k_loaded == pytest.approx(2 * 9.81 / (0.1 - data.qpos[2]), rel=1e-3)
    assert found.k_loaded > 1.15 * found.k
    assert mr.inspect_contacts(model, load=1e-6)[0].k_loaded == pytest.approx(found.k, rel=1e-3)
    with pytest.raises(ValueError, match="load = -1 N is outside"):
        mr.inspect_contacts(model, load=-1.0)


def test_what_cannot_move_is_said():
    arm = """<body><joint axis="0 0 1"/><geom name="{name}" size=".1" mass="2" pos=".2 0 0"/></body>"""
    (found,) = mr.inspect_contacts(spec_of(scene(FLOOR, arm.format(name=""))))
    assert found.geom2 == "[1]"
    assert any("mass is infinite" in note for note in found.notes)
    named = scene(FLOOR, '<body name="arm"><freejoint/><geom size=".1" mass="2"/></body>')
    assert mr.inspect_contacts(spec_of(named))[0].geom2 == "arm[1]"
    assert mr.inspect_contacts(spec_of(named))[0].bodies == ("world", "arm")


def test_dry_friction_of_a_joint_is_named_with_what_it_takes():
    """A foot on a slide joint with frictionloss, at 1 m/s and without gravity."""
    text = """<mujoco><option timestep="1e-5" gravity="0 0 0"/><worldbody><geom name="floor" type="plane" size="1 1 1"/>
        <body pos="0 0 .1005"><joint name="strut" type="slide" axis="0 0 1" frictionloss="{loss}"/>
        <geom name="foot" size=".1" mass="1"/></body></worldbody></mujoco>"""
    left = []
    for loss in (0, 10):
        spec = mujoco.MjSpec.from_string(text.format(loss=loss))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            contact = mr.contact_for(spec, "foot", "floor", k=1e5, restitution=0.5)
        assert len(caught) == (loss > 0)
        contact.apply(spec)
        model = spec.compile()
        data = mujoco.MjData(model)
        data.qvel[0] = -1
        while data.qvel[0] < 0 or (data.ncon and data.efc_force.max() > 0):
            mujoco.mj_step(model, data)
        left.append(float(data.qvel[0]))
    shown_text = str(caught[0].message)
    assert shown_text.startswith(
        "joint strut adds a dry friction of 10 N along the approach, which lowers e = 0.5 by up to 0.037"
    )
    assert 0.008 < left[0] - left[1] < 0.037


POWERS = """<mujoco><option gravity="0 0 0"><flag {flag}/></option><worldbody><site name="above" pos="0 0 2"/>
<body pos="0 0 .5"><joint name="lift" type="slide" axis="0 0 1" damping="1 2 3" stiffness="40 50 60" springref=".2"/>
<geom size=".05" mass="3"/><site name="hook"/></body></worldbody><tendon><spatial name="cable" damping="4 5 6"
stiffness="70 80 90" springlength=".3 1.2"><site site="above"/><site site="hook"/></spatial></tendon><actuator>
<position joint="lift" kp="7" kv="8" damping="9 10" gear="2"/><pid joint="lift" kp="11" kv="12"/>
<dcmotor joint="lift" motorconst="2" resistance="1" input="none"/><velocity joint="lift" kv="3"/></actuator></mujoco>"""


@pytest.mark.parametrize("flag", ["", 'damper="disable"', 'spring="disable"', 'actuation="disable"'])
def test_springs_and_dampers_are_the_forces_of_the_engine(flag):
    """Polynomials, servos, motors and controllers: the engine's own forces at two places and at two speeds."""
    pose = Pose(mujoco.MjModel.from_xml_string(POWERS.format(flag=flag)))
    model, data, speed, step = pose.model, mujoco.MjData(pose.model), 0.7, 1e-6
    forces = []
    for place, velocity in ((0, 0), (step, 0), (0, speed)):
        data.qpos[0], data.qvel[0] = place, velocity
        mujoco.mj_forward(model, data)
        forces.append(float(data.qfrc_passive[0] + data.qfrc_actuator[0]))
    k, c = (float(each.sum()) for each in pose.springs.along(np.array([1.0]), speed))
    assert k == pytest.approx((forces[0] - forces[1]) / step, rel=1e-4)
    assert c == pytest.approx((forces[0] - forces[2]) / speed, rel=1e-6)


@pytest.mark.parametrize("attribute", ['damping="0 0 200"', 'damping="0 20"', 'stiffness="0 2e5"'])
def test_higher_terms_of_a_joint_are_named(attribute):
    slide = f"""<body pos="0 0 .2"><joint name="lift" type="slide" axis="0 0 1" {attribute}/>
    <geom name="ball" size=".1" mass="1"/></body>"""
    with pytest.warns(mr.ContactWarning, match="joint lift adds"):
        mr.contact_for(spec_of(scene(FLOOR, slide)), "ball", "floor", k=1e4, restitution=0.5, qpos=[-0.1])


@pytest.mark.parametrize(("k", "gives_way"), [(2e3, True), (2e7, False)])
def test_a_leg_that_buckles_within_a_soft_blow_is_told(k, gives_way):
    """A leg that is a little bent is stiff at first. Within a soft blow it bends, and the mass at its foot falls."""
    text = study.LANDINGS["leg, straight"].text()
    spec = spec_of(text)
    pose = {"qpos": [0, 0, 0.6, 1, 0, 0, 0, 0.3, -0.6]}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        contact = mr.contact_for(spec, "foot", "floor", k=k, restitution=0.5, friction=0, timestep=2e-5, **pose)
    shown_text = any("joints give way within a blow" in str(each.message) for each in caught)
    contact.apply(spec)
    data = mujoco.MjData(model := spec.compile())
    model.opt.gravity[:] = 0
    data.qpos[:] = pose["qpos"]
    mujoco.mj_kinematics(model, data)
    foot = model.geom("foot").id
    data.qpos[2] -= data.geom_xpos[foot, 2] - 0.02 - 1e-6
    data.qvel[2] = -1
    touched, jacobian = False, np.zeros((3, model.nv))
    while not touched or data.ncon:
        mujoco.mj_step(model, data)
        touched |= data.ncon > 0
    mujoco.mj_jacGeom(model, data, jacobian, None, foot)
    e = float(jacobian[2] @ data.qvel)
    assert (shown_text, abs(e - 0.5) > 0.03) == (gives_way, gives_way), e
