"""Stiffness by the depth under a load, of a whole face, and of an interface; and what a time step resolves."""

import math
import warnings

import mujoco
import numpy as np
import pytest
from pairs import BALL, BOX, FLOOR, ON_A_PLANE, scene

import mjrock as mr

G, MASS, AREA = 9.81, 2.0, 0.4 * 0.6
HEAVY_BOX = scene(FLOOR, BOX.format(quat="1 0 0 0"), gravity=G, timestep=1e-4)
ACTUATOR = """</worldbody><actuator><motor joint="z" gear="-1"/></actuator>
<keyframe><key name="on" ctrl="50"/></keyframe>"""
PRESS = """<body pos="0 0 .1"><joint name="z" type="slide" axis="0 0 1"/>
<geom name="press" size=".1" mass="2"/></body>"""


def found_depth(spec, contact, push=0.0):
    """How deep the box lies after it has come to rest, pressed by a further force [m]."""
    contact.apply(spec)
    data = mujoco.MjData(model := spec.compile())
    data.xfrc_applied[1, 2] = -push
    mujoco.mj_step(model, data, 4000)
    assert abs(data.qvel[2]) < 1e-9
    return 0.1 - data.qpos[2]


@pytest.mark.parametrize(
    ("requested", "push", "depth"),
    [
        ({"depth": 2e-4}, 0.0, 2e-4),
        ({"depth": 5e-4, "load": MASS * G + 30.0}, 30.0, 5e-4),
        ({"k_face": 1e5}, 0.0, MASS * G / 1e5),
        ({"k_n": 1e6}, 0.0, MASS * G / (1e6 * AREA)),
    ],
)
def test_the_depth_is_that_of_the_request(requested, push, depth):
    spec = mujoco.MjSpec.from_string(HEAVY_BOX)
    contact = mr.contact_for(spec, "box", "floor", xi=1.0, friction=0, **requested)
    assert contact.contacts == 4
    if not push:
        assert contact.depth == pytest.approx(depth, rel=1e-6)
    assert found_depth(spec, contact, push) == pytest.approx(depth, rel=1e-6)


def test_a_turned_face_has_the_same_area():
    """Of a box that lies on a slope, in another order of the geoms."""
    turn = "0.966 0.0 0.259 0.0"
    spec = mujoco.MjSpec.from_string(HEAVY_BOX.replace('<geom name="floor"', f'<geom quat="{turn}" name="floor"'))
    pose = [0.1 * math.sin(math.pi / 6), 0, 0.1 * math.cos(math.pi / 6), *map(float, turn.split())]
    contact = mr.contact_for(spec, "floor", "box", k_n=1e6, xi=1.0, friction=0, qpos=pose)
    assert contact.k * contact.contacts == pytest.approx(1e6 * AREA, rel=1e-3)


def test_four_balls_of_a_foot_share_the_stiffness_of_the_whole():
    feet = "".join(f'<geom name="foot{i}" size=".02" pos="{x} {y} 0"/>' for i, (x, y) in enumerate(np.ndindex(2, 2)))
    spec = mujoco.MjSpec.from_string(scene(FLOOR, f'<body pos="0 0 .02"><freejoint/>{feet}</body>', gravity=G))
    contacts = mr.contacts_for(spec, {("foot*", "floor"): {"k_face": 4e5, "xi": 0.5}})
    assert [contact.k for contact in contacts] == [1e5] * 4


def test_the_pressure_of_an_actuator_at_its_controls_is_the_load():
    spec = mujoco.MjSpec.from_string(scene(FLOOR, PRESS, gravity=G, timestep=1e-4).replace("</worldbody>", ACTUATOR))
    contact = mr.contact_for(spec, "press", "floor", depth=1e-4, xi=1.0, friction=0, keyframe="on")
    assert contact.k == pytest.approx((50.0 + MASS * G) / 1e-4, rel=1e-6)
    contact.apply(spec)
    data = mujoco.MjData(model := spec.compile())
    data.ctrl[:] = 50.0
    mujoco.mj_step(model, data, 3000)
    assert -data.qpos[0] == pytest.approx(1e-4, rel=1e-6)


@pytest.mark.parametrize(
    ("requested", "complaint"),
    [
        ({"k": 1e5, "depth": 1e-4}, "k = 100000.0 and depth = 0.0001 are given; give one of them"),
        (
            {"k_n": 1e6},
            r"k_n = 1e\+06 N/m3 needs a face, and \('ball', 'floor'\) meet in 1 point at qpos0; give k or k_face",
        ),
        ({"depth": 1e-4}, "depth = 0.0001 m needs a load, and .* carry none at rest at qpos0; give load"),
        ({"depth": 0.0}, "depth = 0 m is outside the valid range 1e-12 to 1000 m"),
        ({"depth": 1e-4, "load": -1.0}, "load = -1 N is outside the valid range"),
        ({"depth": 1e-4, "c": 3.0, "xi": 0.2}, "exactly one of c, restitution and xi"),
    ],
)
def test_what_cannot_be_is_refused(requested, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.contact_for(mujoco.MjModel.from_xml_string(ON_A_PLANE), "ball", "floor", **{"xi": 0.5} | requested)


def test_the_stiffest_contacts_of_a_step_rebound_as_they_say():
    """Each of them at MuJoCo's own 2 ms, on average over where in a step the ball touches: within .03."""
    spec = mujoco.MjSpec.from_string(scene(FLOOR, BALL, timestep=2e-3))
    contacts = mr.stiffest_contacts(spec, "ball", "floor")
    assert contacts == mr.stiffest_contacts(spec.compile(), 1, 0, timestep=2e-3)
    for contact in contacts:
        contact.apply(spec)
        model, found = spec.compile(), []
        for phase in np.arange(0.05, 1, 0.1):
            data = mujoco.MjData(model)
            data.qpos[2] += (3 + phase) * 2e-3
            data.qvel[2] = -1.0
            mujoco.mj_step(model, data, 100)
            found.append(data.qvel[2])
        assert np.mean(found) == pytest.approx(contact.restitution, abs=0.03)
    shorter = mr.stiffest_contacts(spec, "ball", "floor", timestep=2e-4)
    assert [one.k / other.k for one, other in zip(shorter, contacts, strict=True)] == pytest.approx(
        [100.0] * 7, rel=0.01
    )
    with pytest.raises(ValueError, match="timestep = 0 s is outside the valid range"):
        mr.stiffest_contacts(spec, "ball", "floor", timestep=0)


def test_a_contact_that_is_softer_than_before_says_by_what_factor():
    text = scene(FLOOR, BALL.replace("size", 'solref="-1e6 -100" size'), gravity=G, timestep=2e-3)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        contact = mr.contact_for(mujoco.MjSpec.from_string(text), "ball", "floor", restitution=0.5)
    (before,) = mr.inspect_contacts(mujoco.MjModel.from_xml_string(text))
    factor = before.k_loaded / contact.k
    assert any(f"by a factor of {factor:.2g}" in str(one.message) for one in caught)
