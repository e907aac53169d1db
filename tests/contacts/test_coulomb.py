"""Coulomb's law in a user's own steps: a pushed box, a spinning one, a held object."""

import copy

import mujoco
import numpy as np
import pytest
from pairs import FLOOR, scene, since

import mjrock as mr

G, MU, K = 9.81, 0.4, 1e5
BOX = '<body name="box" pos="0 0 .1"><freejoint/><geom name="box" type="box" size=".2 .2 .1" mass="2"/></body>'
GRIPPER = """<body name="left" pos="-.06 0 .3"><joint name="left" type="slide" axis="1 0 0"/>
<geom name="left" type="box" size=".01 .03 .03" mass=".2"/></body><body name="right" pos=".06 0 .3">
<joint name="right" type="slide" axis="-1 0 0"/><geom name="right" type="box" size=".01 .03 .03" mass=".2"/></body>
<body name="held" pos="0 0 .3"><freejoint/><geom name="held" type="box" size=".05 .02 .04" mass=".3"/></body>"""


def thrown(h, coulomb, *, speed=3.0, spin=0.0, duration=1.0, integrator="Euler"):
    """Place, velocity and highest lift of a box of 2 kg that is thrown along the floor."""
    options = f'integrator="{integrator}"'
    spec = mujoco.MjSpec.from_string(scene(FLOOR, BOX, timestep=h, gravity=G, options=options))
    mr.contact_for(spec, "box", "floor", k=K / 4, xi=0.3, friction=MU).apply(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[2] -= 2 * G / K
    data.qvel[0], data.qvel[5] = speed, spin
    friction, top = mr.CoulombFriction(model), -1.0
    while data.time < duration - h / 2:
        if coulomb:
            friction(data)
        mujoco.mj_step(model, data)
        top = max(top, float(data.qpos[2]) - 0.1 + 2 * G / K)
    return data.qpos.copy(), data.qvel.copy(), top


@pytest.mark.parametrize("integrator", ["Euler", pytest.param("implicitfast", marks=pytest.mark.slow)])
def test_a_thrown_box_does_not_lift(integrator):
    """The cone lifts it by 0.39 mm at a step of 1 ms, twice its indentation. It stops after v^2 / (2 mu g)."""
    place, velocity, top = thrown(1e-3, True, integrator=integrator)
    assert top < 1e-8
    assert place[0] == pytest.approx(9 / (2 * MU * G), abs=3.0 * 1e-3)
    assert np.abs(velocity).max() < 1e-8
    assert thrown(1e-3, False, duration=0.3, integrator=integrator)[2] > 3e-4


def test_its_speed_is_that_of_coulombs_law():
    place, velocity, _ = thrown(1e-3, True, speed=8.0, duration=0.5)
    assert velocity[0] == pytest.approx(8 - MU * G * 0.5, abs=1e-9)
    assert abs(thrown(1e-3, False, speed=8.0, duration=0.5)[1][0] - velocity[0]) > 1e-3
    assert place[1] == pytest.approx(0, abs=1e-12)


@pytest.mark.slow
def test_a_box_that_spins_slides_in_two_tangents():
    """Each of its points rubs along its own slip; a step four times as short gives the same."""
    coarse, fine = (thrown(h, True, spin=5.0, duration=0.2)[0] for h in (1e-3, 2.5e-4))
    assert coarse[:2] == pytest.approx(fine[:2], abs=2e-3)
    assert abs(fine[1]) > 1e-3


def test_a_held_object_stays_and_nothing_slides():
    """What sticks has its rows: the motion is that without the function, and the object creeps by less than 1 um."""
    spec = mujoco.MjSpec.from_string(scene(GRIPPER, timestep=2e-4, gravity=G))
    pads = {(side, "held"): {"k": 2e4, "xi": 1.0, "friction": 0.8} for side in ("left", "right")}
    mr.contacts_for(spec, pads).apply(spec)
    runs = []
    for coulomb in (True, False):
        model = spec.compile()
        data = mujoco.MjData(model)
        friction = mr.CoulombFriction(model)
        data.qfrc_applied[:2] = 10.0
        heights = []
        for _ in range(800):
            slid = friction(data) if coulomb else ()
            mujoco.mj_step(model, data)
            heights.append(float(data.qpos[4]))
        assert slid == ()
        assert (data.qfrc_applied[:2] == 10.0).all()
        assert abs(heights[-1] - heights[300]) < 1e-6
        runs.append(heights)
    assert runs[0] == pytest.approx(runs[1], abs=1e-9)


def test_forces_of_the_user_remain():
    """Set once or anew before each step; release gives rows and forces back."""
    spec = mujoco.MjSpec.from_string(scene(FLOOR, BOX, timestep=1e-3, gravity=G))
    mr.contact_for(spec, "box", "floor", k=K / 4, xi=0.3, friction=MU).apply(spec)
    speeds = []
    for anew in (False, True):
        model = spec.compile()
        data = mujoco.MjData(model)
        data.qpos[2] -= 2 * G / K
        data.qfrc_applied[0] = 12.0
        friction = mr.CoulombFriction(model)
        for _ in range(300):
            if anew:
                data.qfrc_applied[:] = (12.0, 0, 0, 0, 0, 0)
            friction(data)
            mujoco.mj_step(model, data)
        assert friction.sliding == (0,)
        assert model.pair_dim[0] == 1
        speeds.append(float(data.qvel[0]))
        friction.release(data)
        assert data.qfrc_applied.tolist() == [12.0, 0, 0, 0, 0, 0]
        assert (model.pair_dim[0], friction.sliding) == (3, ())
    for call in (friction, friction.release):
        with pytest.raises(TypeError, match="data = 3 of type int is not a MjData"):
            call(3)
    assert speeds[0] == speeds[1] == pytest.approx(0.3 * (6 - MU * G), rel=0.01)


def test_a_model_is_stepped_with_one_data():
    """What slides stands in the model, so that a second state, or a second function, needs a model of its own."""
    spec = mujoco.MjSpec.from_string(scene(FLOOR, BOX, timestep=1e-3, gravity=G))
    mr.contact_for(spec, "box", "floor", k=K / 4, xi=0.3, friction=MU).apply(spec)
    model = spec.compile()
    friction, other = mr.CoulombFriction(model), mr.CoulombFriction(model)
    first, second = mujoco.MjData(model), mujoco.MjData(model)
    first.qpos[2] -= 2 * G / K
    first.qvel[0] = 3.0
    for _ in range(2):
        assert friction(first) == (0,)
        mujoco.mj_step(model, first)
    with pytest.raises(ValueError, match=r"data is another MjData .*copy\.copy\(model\)"):
        friction(second)
    with pytest.raises(ValueError, match=r"pair_dim \[1\], and this one left \[3\]"):
        other(second)
    own = copy.copy(model)
    own.pair_dim[:] = 3
    assert mr.CoulombFriction(own)(second) == ()
    friction.release(first)
    assert friction(second) == ()


def test_what_cannot_be_is_refused():
    bare = mujoco.MjModel.from_xml_string(scene(FLOOR, BOX))
    paired = scene(FLOOR, BOX, pair='<pair geom1="box" geom2="floor"/>', options="{}")
    staged = paired.format('integrator="RK4" cone="elliptic"')
    for model, complaint in (
        (bare, "model has no explicit <pair> with friction"),
        (mujoco.MjModel.from_xml_string(paired.format("")), "model has the pyramidal cone"),
        (mujoco.MjModel.from_xml_string(staged), "model has the integrator RK4"),
        (paired, "model = .* is not a MjModel"),
    ):
        with pytest.raises((ValueError, TypeError), match=complaint):
            mr.CoulombFriction(model)


def pushed(kinetic, *, speed=0.0, push=0.0, belt=0.0, condim=3, duration=0.3):
    """Speed of a box of 2 kg on a floor or a belt after a while."""
    moves = f'surfacevel="{belt} 0 0 0 0 0"' if belt else ""
    floor = f'<geom name="floor" type="box" size="9 9 .1" pos="0 0 -.1" {moves}/>'
    box = BOX.replace("mass=", f'condim="{condim}" mass=')
    spec = mujoco.MjSpec.from_string(scene(floor, box, timestep=1e-3, gravity=G))
    mr.contact_for(spec, "box", "floor", k=K / 4, xi=0.5, friction=MU).apply(spec)
    data = mujoco.MjData(model := spec.compile())
    data.qpos[2] -= 2 * G / K
    data.qvel[0], data.qfrc_applied[0] = speed, push
    friction = mr.CoulombFriction(model, kinetic)
    while data.time < duration - 5e-4:
        friction(data)
        mujoco.mj_step(model, data)
    return float(data.qvel[0])


@since(3, 11)
def test_a_belt_carries_along():
    """A crate that is put on it gains mu g t, until it has the speed of the belt."""
    assert pushed(1.0, belt=2.0) == pytest.approx(MU * G * 0.3, rel=1e-3)
    assert pushed(1.0, belt=0.5) == pytest.approx(0.5, rel=1e-3)


@since(3, 4)
def test_static_friction_is_above_kinetic_friction():
    """7 N do not move what mu m g = 7.85 N hold. Once it slides, half of that slows it by less than they push."""
    assert abs(pushed(0.5, push=7.0)) < 1e-5
    assert pushed(0.5, push=7.0, speed=0.5) == pytest.approx(0.5 + 0.3 * (3.5 - 0.5 * MU * G), rel=1e-6)
    with pytest.raises(ValueError, match=r"kinetic = 1\.5 is outside"):
        pushed(1.5)


def test_torsional_friction_keeps_its_rows_and_is_said():
    with pytest.warns(mr.ContactWarning, match="pairs floor on box have condim 4 or 6"):
        pushed(1.0, condim=4, duration=2e-3)
