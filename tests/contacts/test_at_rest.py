"""Loads at rest by statics, and what the shapes of geoms and the depth of a blow do to a contact."""

import re
import warnings
from pathlib import Path

import mujoco
import numpy as np
import pytest
from pairs import FLOOR, scene, since

import mjrock as mr

G = 9.81
NOTHING = 'contype="0" conaffinity="0"'
WHEELS = "".join(
    f'<geom name="{name}{y}" size=".1" pos="{x} {y} -.1" mass="1"/>'
    for name, x in (("front", 0.3), ("rear", -0.3))
    for y in (0.2, -0.2)
)
TRAILER = f"""<body pos="0 0 .2"><freejoint/><geom type="box" size=".4 .2 .05" mass="20" {NOTHING}/>{WHEELS}
<body pos="-.5 0 0"><joint type="ball"/><geom type="box" size=".4 .2 .05" pos="-.5 0 0" mass="5" {NOTHING}/>
<geom type="box" size=".1 .1 .1" pos="-.8 0 .15" mass="60" {NOTHING}/>
<geom name="axle.2" size=".1" pos="-.8 .2 -.1" mass="1"/><geom name="axle-.2" size=".1" pos="-.8 -.2 -.1" mass="1"/>
</body></body>"""
ROCKER = """<body pos="{x} 0 -.05"><joint type="hinge" axis="0 1 0"/>
<geom type="capsule" fromto="-.1 0 0 .1 0 0" size=".01" mass=".2" contype="0" conaffinity="0"/>
<geom name="a{x}" size=".04" pos="-.1 0 -.06" mass=".1"/>
<geom name="b{x}" size=".04" pos=".1 0 -.06" mass=".1"/></body>"""
ROVER = f"""<body pos="0 0 .15"><joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 1 0"/>
<geom type="box" size=".4 .05 .02" mass="12" {NOTHING}/><geom type="box" size=".05 .05 .05" pos=".3 0 .07" mass="8"
{NOTHING}/>{ROCKER.format(x=0.3)}{ROCKER.format(x=-0.3)}</body>"""
PADS = [(0.2, 0.0), (-0.1, 0.17), (-0.1, -0.17)]
FRAME = f"""<body pos="0 0 .07"><freejoint/><geom type="box" size=".2 .2 .02" mass="10" {NOTHING}/>
<geom type="box" size=".03 .03 .03" pos=".1 0 .05" mass="5" {NOTHING}/>{
    "".join(
        f'<body pos="{x} {y} -.05"><joint type="ball" damping="1e-2"/><geom name="pad{i}" type="box" '
        'size=".02 .02 .005" pos="0 0 -.015" mass=".1"/></body>'
        for i, (x, y) in enumerate(PADS)
    )
}</body>"""
PRESS = """<body pos="0 0 .02"><freejoint/><geom name="cube" type="box" size=".02 .02 .02" mass=".06"/></body>
<body pos="0 0 .05"><joint name="z" type="slide" axis="0 0 1"/>
<geom name="finger" type="box" size=".01 .01 .01" mass=".3"/></body>"""
DRIVES = {
    "motor": ('<motor joint="z"/>', -50.0),
    "servo": ('<position joint="z" kp="1000"/>', -0.05),
    "none": ('<motor joint="z"/>', 0.0),
}


def quietly(make, *given, **named):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return make(*given, **named)


def loads(text, pattern, points=1):
    """Load of each geom of so many points on the floor [N], by its name."""
    spec = mujoco.MjSpec.from_string(text)
    made = quietly(mr.contacts_for, spec, {(each, "floor"): {"k": 5e5, "xi": 1.0} for each in pattern.split()})
    return {contact.geom1: contact.load * points for contact in made}


def test_a_trailer_stands_on_its_axle_and_leans_on_its_tractor():
    """Two beams on four supports, with a hinge: statically determinate, whatever friction could hold."""
    trailer, tractor = 67.0 * G, 24.0 * G
    axle = trailer * (5 * 0.5 + 62 * 0.8) / 67 / 0.8
    rear = (tractor * 0.3 + (trailer - axle) * 0.8) / 0.6
    right = {"front": tractor + trailer - axle - rear, "rear": rear, "axle": axle}
    found = loads(scene(FLOOR, TRAILER, gravity=G, timestep=1e-4), "front* rear* axle*")
    for name, load in right.items():
        assert [found[each] for each in found if each.startswith(name)] == pytest.approx([load / 2] * 2, rel=1e-4)


def test_rockers_share_their_load_and_pads_theirs():
    """The beam of a rover is on two hinges .6 m apart, each between two wheels; a frame is on three ball joints."""
    found = loads(scene(FLOOR, ROVER, gravity=G, timestep=1e-4), "a* b*")
    front = (12 * 0.3 + 8 * 0.6 + 0.4 * 0.6) * G / 0.6
    back = (20 + 0.8) * G - front
    assert [found[f"{side}0.3"] for side in "ab"] == pytest.approx([front / 2] * 2, rel=1e-4)
    assert [found[f"{side}-0.3"] for side in "ab"] == pytest.approx([back / 2] * 2, rel=1e-4)
    found = loads(scene(FLOOR, FRAME, gravity=G, timestep=1e-4), "pad*", points=4)
    equations = np.array([[1, 1, 1], [x for x, _ in PADS], [y for _, y in PADS]])
    right = np.linalg.solve(equations, [15 * G, 5 * 0.1 * G, 0]) + 0.1 * G
    assert [found[f"pad{i}"] for i in range(3)] == pytest.approx(right, rel=1e-4)


HOLDS = {
    "limit": ('range="0 90" limited="true"', ""),
    "friction": ('frictionloss="100"', ""),
    "spring": ('stiffness="1"', ""),
    "equality": ("", '<equality><joint joint1="hinge"/></equality>'),
    "motor": ("", '<actuator><motor joint="hinge"/></actuator>'),
    "nothing": ('damping="1"', ""),
}


@pytest.mark.parametrize("name", HOLDS)
def test_what_holds_a_joint_at_rest(name):
    """A crane of 10 kg on two feet .6 m apart, with 2 kg on an arm .3 m beyond one of them. A joint that turns freely
    lets it fall, and carries none of its weight."""
    joint, more = HOLDS[name]
    crane = f"""<body pos="0 0 .2"><joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 1 0"/>
    <geom type="box" size=".3 .05 .02" mass="9.8" {NOTHING}/><geom name="near" size=".05" pos=".3 0 -.15" mass=".1"/>
    <geom name="far" size=".05" pos="-.3 0 -.15" mass=".1"/>
    <body pos=".3 0 0"><joint name="hinge" axis="0 -1 0" {joint}/>
    <geom size=".02" pos=".3 0 0" mass="2" {NOTHING}/></body></body>"""
    found = loads(
        scene(FLOOR, crane, gravity=G, timestep=1e-4).replace("</worldbody>", "</worldbody>" + more), "near far"
    )
    arm = 0.0 if name == "nothing" else 1.0
    assert found["near"] == pytest.approx((5 + 3 * arm) * G, rel=0.01)
    assert found["far"] == pytest.approx((5 - arm) * G, rel=0.01)


@pytest.mark.parametrize("drive", DRIVES)
def test_what_an_actuator_presses_at_the_controls_of_a_keyframe_is_load(drive):
    actuator, control = DRIVES[drive]
    force = 50.0 if control else 0.0
    text = scene(FLOOR, PRESS, gravity=G, timestep=1e-4).replace(
        "</worldbody>",
        f'</worldbody><actuator>{actuator}</actuator><keyframe><key name="closed" ctrl="{control}"/></keyframe>',
    )
    spec = mujoco.MjSpec.from_string(text)
    for pose, pressed in (({"keyframe": "closed"}, force), ({"keyframe": ["closed"]}, force), ({}, 0.0)):
        on = quietly(mr.contact_for, spec, "cube", "floor", k=1e5, xi=1.0, **pose)
        under = quietly(mr.contact_for, spec, "finger", "cube", k=1e5, xi=1.0, **pose)
        assert on.depth == pytest.approx((pressed + 0.36 * G) / 4e5, rel=1e-4)
        assert under.load * under.contacts == pytest.approx(pressed + 0.3 * G, rel=1e-4)
    found = quietly(mr.inspect_contacts, spec, keyframe="closed")
    (cube,) = (each for each in found if (each.geom1, each.geom2) == ("floor", "cube"))
    assert cube.load * cube.points == pytest.approx(force + 0.36 * G, rel=1e-4)


def test_positions_have_no_controls():
    """A servo whose position is given is where it is wanted: 1 kN/m pull nothing towards zero."""
    text = scene(FLOOR, PRESS.replace('pos="0 0 .05"', 'pos="0 0 .15"'), gravity=G, timestep=1e-4).replace(
        "</worldbody>", '</worldbody><actuator><position joint="z" kp="1000"/></actuator>'
    )
    spec = mujoco.MjSpec.from_string(text)
    qpos = [0, 0, 0.02, 1, 0, 0, 0, -0.1]
    assert quietly(mr.contact_for, spec, "cube", "floor", k=1e5, xi=1.0, qpos=qpos).load * 4 == pytest.approx(
        0.36 * G, rel=1e-4
    )


def test_a_contact_that_carries_nothing_says_so():
    wall = '<geom name="wall" type="box" size=".1 1 1" pos="-.2 0 1"/>'
    box = '<body pos="0 0 .1"><freejoint/><geom name="box" type="box" size=".1 .1 .1" mass="2"/></body>'
    spec = mujoco.MjSpec.from_string(scene(FLOOR, wall, box, gravity=G, timestep=1e-4))
    contact = quietly(mr.contact_for, spec, "box", "wall", k=1e5, xi=1.0)
    assert "; carries nothing at rest;" in str(contact)
    assert contact.load == pytest.approx(0, abs=1e-8)
    assert "m under the weight" in str(quietly(mr.contact_for, spec, "box", "floor", k=1e5, xi=1.0))
    notes = {each.geom1: " ".join(each.notes) for each in mr.inspect_contacts(spec)}
    assert "carries nothing at rest" in notes["wall"]
    assert "carries nothing at rest" not in notes["floor"]


BALL_ABOVE = '<body pos="0 0 {}"><freejoint/><geom name="ball" size=".02" mass=".0027"/></body>'
TABLE = '<geom name="table" type="box" size=".76 1.37 .01" pos="0 0 -.01"/>'


def falls_through(spec, contact, speed):
    """Of ten balls that touch at other moments of a step, how many go through the table."""
    contact.apply(spec)
    model, through = spec.compile(), 0
    for phase in range(10):
        data = mujoco.MjData(model)
        data.qpos[2] += 0.1 * phase * speed * model.opt.timestep
        data.qvel[2] = -speed
        while data.qpos[2] > -0.05 and data.qvel[2] < 0:
            mujoco.mj_step(model, data)
        through += bool(data.qpos[2] < 0)
    return through


@pytest.mark.parametrize("speed", [4.6, 8.0])
def test_a_blow_that_is_deeper_than_the_geoms_is_named_with_what_stops_it(speed):
    """A table-tennis ball on the stiffest contact of a step of 2 ms goes through its table, with what is named not."""
    text = scene(TABLE, BALL_ABOVE.format(0.1), gravity=G, timestep=2e-3)
    requested = {"restitution": 0.89, "speed": speed}
    with pytest.warns(mr.ContactWarning) as caught:
        contact = mr.contact_for(spec := mujoco.MjSpec.from_string(text), "ball", "table", **requested)
    (complaint,) = (str(each.message) for each in caught if "a blow at" in str(each.message))
    deep, k, step = map(
        float, re.findall(r"goes (\S+) m deep.* k = (\S+) N/m .* and (\S+) s resolves it", complaint)[0]
    )
    xi = contact.xi
    formula = speed / contact.frequency * np.exp(-xi * np.arccos(xi) / np.sqrt(1 - xi**2))
    assert deep == pytest.approx(formula, rel=0.02)
    assert falls_through(spec, contact, speed) == 10
    contact = mr.contact_for(spec := mujoco.MjSpec.from_string(text), "ball", "table", k=k, timestep=step, **requested)
    assert falls_through(spec, contact, speed) == 0


def test_a_plane_has_no_other_side():
    text = scene(FLOOR, BALL_ABOVE.format(0.1), gravity=G, timestep=1e-4)
    mr.contact_for(mujoco.MjSpec.from_string(text), "ball", "floor", k=30.0, restitution=0.89, speed=8.0)


CAN = '<body pos="0 0 .02" {}><freejoint/><geom name="can" type="cylinder" size=".1 .02" mass="1"/></body>'
SLAB = '<geom name="floor" type="box" size="2 2 .1" pos="0 0 -.1"/>'


@pytest.mark.parametrize(
    ("ground", "can", "named"),
    [
        (FLOOR, CAN.format(""), True),
        (FLOOR, CAN.format('quat="0 1 0 0"'), True),
        (FLOOR, CAN.format('quat="1 1 0 0"').replace("0 0 .02", "0 0 .1"), False),
        (FLOOR, CAN.format("").replace("<freejoint/>", '<joint type="slide" axis="0 0 1"/>'), False),
        (SLAB, CAN.format(""), False),
    ],
)
def test_a_cylinder_that_stands_on_a_plane_is_named(ground, can, named):
    spec = mujoco.MjSpec.from_string(scene(ground, can, gravity=G, timestep=5e-4))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        mr.contact_for(spec, "can", "floor", k=5e4, xi=0.5, friction=0)
    assert any("throws a cylinder" in str(each.message) for each in caught) == named
    notes = " ".join(note for each in mr.inspect_contacts(spec) for note in each.notes)
    assert ("throws a cylinder" in notes) == named


REPORTS = Path(__file__).parents[2] / "scripts" / "peers"


def code_of(report):
    """The program in a report to MuJoCo, and what the report says that it prints."""
    text = (REPORTS / report).read_text(encoding="utf-8")
    return re.findall(r"```(?:py|text)\n(.*?)```", text, re.DOTALL)


@pytest.mark.skipif(not REPORTS.exists(), reason="the reports are in the repository of mjrock")
def test_the_fault_that_the_report_describes_is_there(capsys):
    """Once this fails, MuJoCo has mended it: take the report and the warning away."""
    code, _ = code_of("mujoco_plane_cylinder.md")
    exec(code.replace("20000", "2000").replace("4000", "500"), {})
    plane, box, poses = capsys.readouterr().out.splitlines()
    assert float(re.findall(r"lifts by (\S+) mm", plane)[0]) > 100
    assert float(re.findall(r"lifts by (\S+) mm", box)[0]) < 0.1
    deeper, without = map(int, re.findall(r"(\d+) of 2000 too deep, (\d+) without", poses)[0])
    assert deeper > 20
    assert without > 2


@pytest.mark.skipif(not REPORTS.exists(), reason="the reports are in the repository of mjrock")
def test_what_the_report_on_the_points_of_a_face_prints(capsys):
    """Once this fails, MuJoCo weighs the points of a face: take the report and the warning of a turn away."""
    code, printed = code_of("mujoco_points_of_a_face.md")
    exec(code, {})
    found, shown = (
        [float(number) for number in re.findall(r"[\d.]+", text)] for text in (capsys.readouterr().out, printed)
    )
    assert found == pytest.approx(shown, rel=2e-3)
    assert len(found) == 24


@since(3, 8)
def test_a_face_on_one_point_is_named():
    corners = " ".join(f"{x} {y} {z}" for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1))
    mesh = f'<asset><mesh name="cube" vertex="{corners}"/></asset><worldbody>'
    cube = '<body pos="0 0 .1"><freejoint/><geom name="cube" type="mesh" mesh="cube" mass="2"/></body>'
    for flag, named in (("disable", True), ("enable", False)):
        options = f'><flag multiccd="{flag}"/></option><option'
        text = scene(SLAB, cube, gravity=G, timestep=1e-4, options=options).replace("<worldbody>", mesh)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            contact = mr.contact_for(mujoco.MjSpec.from_string(text), "cube", "floor", k=1e5, xi=0.5)
        assert contact.contacts == (1 if named else 4)
        assert any("meet in one point, where the multiccd flag gives them 4" in str(w.message) for w in caught) == named


def test_the_factor_by_which_it_is_softer_is_given():
    text = scene(FLOOR, BALL_ABOVE.format(0.02).replace("size", 'solref=".001 1" size'), gravity=G, timestep=2e-3)
    contact = quietly(mr.contact_for, mujoco.MjSpec.from_string(text), "ball", "floor", xi=0.5)
    (complaint,) = (each for each in contact.remarks if "softer than the contact that the model had" in each)
    before, factor = (
        float(n) for n in re.findall(r"had, (\S+) N/m under the weight, by a factor of (\S+);", complaint)[0]
    )
    assert before / contact.k == pytest.approx(factor, rel=0.02)
