"""`contact_for`: what stock MuJoCo measures with the numbers that it gives."""

import math
import warnings

import mujoco
import numpy as np
import pytest
from everyday import crossed
from pairs import BALL, BOX, FLOOR, ON_A_PLANE, SCENES, TWO_BALLS, made_for, rebound, scene

import mjrock as mr
from mjrock.contacts.rebound import rebound_restitution


@pytest.mark.parametrize(("friction", "name", "e"), crossed([None, 0.0], SCENES, [0.05, 0.2, 0.5, 0.8, 0.95, 1.0]))
def test_the_restitution_that_was_asked_for(name, e, friction):
    """The effective mass, W of two bodies, the row and, with friction, the elliptic cone."""
    text, geom1, geom2, points, mass = SCENES[name]
    contact, model = made_for(text, geom1, geom2, restitution=e, friction=friction, contacts=points)
    assert contact.mass == pytest.approx(mass)
    assert contact.restitution == pytest.approx(e)
    measured, data = rebound(contact, model)
    assert measured == pytest.approx(e, rel=0.003)
    assert np.abs(data.qvel[3:6]).max() < 1e-8


@pytest.mark.parametrize("phase", [0.05, 0.95])
def test_whatever_the_phase_of_the_touch(phase):
    contact, model = made_for(ON_A_PLANE, "ball", "floor", restitution=0.5)
    assert rebound(contact, model, phase=phase)[0] == pytest.approx(0.5, rel=0.003)


@pytest.mark.parametrize("e", [0.05, 0.1, 0.3, 0.5, 0.9])
def test_the_step_that_is_not_warned_of(e):
    """At omega h = 0.2 the scatter is that of touches which fall evenly into a step, and ten times less at a tenth."""
    for timestep, off in ((2.8e-4, 0.03), (2.8e-5, 0.001)):
        contact, model = made_for(ON_A_PLANE, "ball", "floor", restitution=e, timestep=timestep)
        measured = [rebound(contact, model, phase=phase)[0] for phase in np.arange(0.025, 1, 0.05)]
        assert np.mean(measured) == pytest.approx(e, abs=off)
        assert np.std(measured) == pytest.approx(e * contact.c * timestep / 2 / math.sqrt(12), rel=0.2, abs=1e-3)


def test_a_restitution_of_zero_is_one_in_a_thousand():
    contact, model = made_for(ON_A_PLANE, "ball", "floor", restitution=0.0)
    assert contact.restitution == pytest.approx(1e-3)
    assert 0 < rebound(contact, model)[0] < 1.5e-3


@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "RK4"])
@pytest.mark.parametrize("xi", [0.05, 0.5])
def test_the_integrators_that_keep_the_energy(integrator, xi):
    """RK4 has no half step between position and velocity, so that its row has no inertia of Newmark's."""
    text = scene(FLOOR, BALL, options=f'integrator="{integrator}"', timestep=1e-4)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="timestep = 0.0001 s is long")
        contact, model = made_with_a_long_step(text, k=1e6, xi=xi)
        measured = np.mean([rebound(contact, model, phase=phase)[0] for phase in np.arange(0.05, 1, 0.1)])
    assert measured == pytest.approx(contact.restitution, rel=0.003 if integrator == "RK4" else 0.004)


def made_with_a_long_step(text, **requested):
    spec = mujoco.MjSpec.from_string(text)
    contact = mr.contact_for(spec, "ball", "floor", **requested)
    contact.apply(spec)
    return contact, spec.compile()


def test_the_weight_of_one_body_is_not_enough():
    """With the W of one of two bodies the contact is softer by W1 / W, and it rebounds as such a contact does."""
    contact, model = made_for(TWO_BALLS, "ball", "other", restitution=0.5)
    for body, measured in ((1, 0.55), (2, 0.674)):
        share = model.body_invweight0[body, 0] / contact.inverse_weight
        model.pair_solref[0] = np.multiply(contact.solref, share)
        assert rebound(contact, model)[0] == pytest.approx(measured, abs=0.001)
        assert rebound_restitution(contact.xi * math.sqrt(share)) == pytest.approx(measured, abs=0.001)


def test_the_pyramidal_cone_is_another_contact():
    contact, model = made_for(TWO_BALLS, "ball", "other", restitution=0.5, friction=0.8)
    model.opt.cone, model.opt.impratio = mujoco.mjtCone.mjCONE_PYRAMIDAL, 1
    assert any("pyramidal" in caveat for caveat in contact.caveats(model))
    measured = rebound(contact, model)[0]
    assert measured == pytest.approx(0.402, abs=0.001)
    assert mr.inspect_contacts(model)[0].restitution == pytest.approx(measured, rel=0.003)


@pytest.mark.parametrize(("slide", "friction"), [(1.0, 0.1), (1.0, 1.0), (5.0, 1.0)])
def test_sliding_does_not_change_the_rebound(slide, friction):
    """The impulse of friction is mu times that of the normal force, or what makes the ball roll."""
    contact, model = made_for(ON_A_PLANE, "ball", "floor", restitution=0.5, friction=friction)
    measured, data = rebound(contact, model, slide=slide)
    assert measured == pytest.approx(0.5, rel=0.005)
    lost = min(friction * 1.5, slide * 2 / 7)
    assert slide - data.qvel[0] == pytest.approx(lost, rel=0.15 if lost < friction * 1.5 else 0.005)


@pytest.mark.parametrize("name", SCENES)
def test_a_restitution_is_a_damping_ratio_is_a_dashpot(name):
    text, geom1, geom2, points, mass = SCENES[name]
    xi = 0.3
    by_e, by_xi, by_c = (
        made_for(text, geom1, geom2, contacts=points, **given)[0]
        for given in ({"restitution": 0.45099}, {"xi": xi}, {"c": 2 * xi * math.sqrt(1e6 * mass)})
    )
    assert by_xi.solref == pytest.approx(by_c.solref, rel=1e-12)
    assert by_e.solref == pytest.approx(by_c.solref, rel=1e-4)
    assert by_c.xi == pytest.approx(xi)
    assert by_c.frequency == pytest.approx(math.sqrt(1e6 / mass))
    assert mr.contact_stiffness(by_c.solref, by_c.solimp, inverse_weight=by_c.inverse_weight) == pytest.approx(
        (1e6, by_c.c)
    )


@pytest.mark.parametrize("k", [1e5, 1e7])
def test_k_is_the_force_over_the_indentation(k):
    text = scene(FLOOR, BALL, gravity=9.81)
    contact, model = made_for(text, "ball", "floor", k=k, xi=0.45)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, int(60 / (contact.frequency * model.opt.timestep)))
    assert 0.1 - data.qpos[2] == pytest.approx(2 * 9.81 / k, rel=1e-4)


def test_a_load_on_a_slope_creeps_and_slides_as_it_should():
    """A block of 2 kg, pushed by less and by more than friction holds, with MuJoCo's default solver."""
    text = scene(FLOOR, BOX.format(quat="1 0 0 0"), gravity=9.81, timestep=1e-4)
    _, model = made_for(text, "box", "floor", k=1e5, restitution=0.3, friction=0.5, contacts=4)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 3000)
    model.opt.gravity[0] = 3.0
    mujoco.mj_step(model, data, 1000)
    before = data.qpos[0]
    mujoco.mj_step(model, data, 5000)
    assert data.qpos[0] - before == pytest.approx(0.5 * 3.0 / 1e7, rel=0.05)
    model.opt.gravity[0] = 8.0
    mujoco.mj_step(model, data, 5000)
    assert data.qvel[0] == pytest.approx(0.5 * (8.0 - 0.5 * 9.81), rel=0.02)


def test_a_corner_has_its_own_mass():
    """A box that comes down on one corner turns away: 1/m = 1/m + (r x n) I^-1 (r x n)."""
    turn = np.array([0.9, 0.3, -0.2, 0.1])
    turn /= np.linalg.norm(turn)
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, turn)
    rotation = rotation.reshape(3, 3)
    corners = np.array([(x, y, z) for x in (-0.2, 0.2) for y in (-0.3, 0.3) for z in (-0.1, 0.1)]) @ rotation.T
    lowest = corners[corners[:, 2].argmin()]
    height = -float(lowest[2])
    body = BOX.format(quat=" ".join(repr(float(part)) for part in turn)).replace("0 0 .1", f"0 0 {height!r}")
    at = lowest + np.array((0, 0, height))
    text = scene(FLOOR, body, timestep=1e-6)
    contact, model = made_for(text, "box", "floor", k=1e8, restitution=0.6, friction=0.0, at=at)
    inverse = rotation @ np.diag(3 / 2 / np.array([0.3**2 + 0.1**2, 0.2**2 + 0.1**2, 0.2**2 + 0.3**2])) @ rotation.T
    lever = np.cross(lowest, (0, 0, 1))
    assert contact.mass == pytest.approx(1 / (0.5 + lever @ inverse @ lever), rel=1e-6)
    assert contact.mass < 1.5
    assert rebound(contact, model, at=at)[0] == pytest.approx(0.6, rel=0.005)


def test_what_is_welded_moves_as_one():
    """A foot beside the body that it is welded to: the blow is beside the centre of the whole, and turns it too."""
    whole = """<body pos="0 0 .1"><freejoint/><geom size=".1" mass="2"/>
    <body name="foot" pos=".3 0 .05"><geom name="foot" size=".1" mass="3"/></body></body>"""
    contact, _ = made_for(scene(FLOOR, whole), "foot", "floor", restitution=0.5, friction=0.0)
    apart = np.hypot(0.3, 0.05)
    inertia = 0.4 * (2 + 3) * 0.1**2 + 2 * 3 / 5 * apart**2
    assert contact.mass == pytest.approx(1 / (1 / 5 + (0.3 * 2 / 5) ** 2 / inertia))
    centred = whole.replace(".3 0 .05", "0 0 -.1")
    assert made_for(scene(FLOOR, centred), "foot", "floor", restitution=0.5)[0].mass == pytest.approx(5.0)


def test_joints_count():
    """A ball on a slide that is inclined: only a part of its approach is along the normal."""
    inclined = """<body name="ball" pos="0 0 .1"><joint type="slide" axis="0 .6 .8"/>
    <geom name="ball" size=".1" mass="2"/></body>"""
    contact, _ = made_for(scene(FLOOR, inclined), "ball", "floor", restitution=0.5, friction=0.0)
    assert contact.mass == pytest.approx(2 / 0.8**2)
    level = inclined.replace("0 .6 .8", "0 1 0")
    with pytest.raises(ValueError, match=r"cannot approach each other along their normal at qpos0.* give mass"):
        mr.contact_for(mujoco.MjSpec.from_string(scene(FLOOR, level)), "ball", "floor", k=1e6, restitution=0.5)


@pytest.mark.parametrize(("height", "normal"), [(1.5, 0.8), (0.4, 0.8), (0.4 - 1e-9, 0.8), (0.35, 0.8)])
def test_the_normal_is_that_of_the_shortest_distance(height, normal):
    """A ball above a face of a fixed box, beside its middle: apart from it, touching it, and in it."""
    table = '<geom name="floor" type="box" size="2 2 .3"/>'
    ball = f"""<body name="ball" pos=".5 .7 {height}"><joint type="slide" axis="0 .6 .8"/>
    <geom name="ball" size=".1" mass="2"/></body>"""
    contact, _ = made_for(scene(table, ball), "ball", "floor", restitution=0.5, friction=0.0)
    assert contact.mass == pytest.approx(2 / normal**2, rel=1e-3)


STEPS = [(1.5e-3, 2.0), (5e-3, 2.0), (5e-2, 2.0), (5e-3, 8.0), (5e-2, 8.0)]
"""Steps [s] that do not resolve a contact, and masses [kg]."""


@pytest.mark.parametrize(("integrator", "step", "e"), crossed(["Euler", "RK4"], STEPS, [0.1, 0.9, 1.0]))
def test_a_step_that_does_not_resolve_it_adds_no_energy(integrator, step, e):
    """Also where the point feels a quarter of the mass that was given, as at a corner."""
    timestep, mass = step
    spec = mujoco.MjSpec.from_string(scene(FLOOR, BALL, options=f'integrator="{integrator}"'))
    with pytest.warns(UserWarning, match="does not resolve"):
        contact = mr.contact_for(spec, "ball", "floor", k=1e6, restitution=e, timestep=timestep, mass=mass)
    contact.apply(spec)
    model = spec.compile()
    for phase in np.arange(0.05, 1, 0.15):
        assert rebound(contact, model, phase=phase)[0] < 0.6


def test_the_row_is_newmarks():
    """Average acceleration by default, wherever the step resolves the contact, whatever the mass."""
    spec = mujoco.MjSpec.from_string(ON_A_PLANE)
    for mass, timestep in ((2.0, 1e-4), (900.0, 9e-3)):
        contact = mr.contact_for(spec, "ball", "floor", k=1e6, c=30.0, mass=mass, timestep=timestep)
        row = mr.contact_parameters(1e6, 30.0, timestep=timestep, inverse_weight=0.5)
        assert contact.solref == pytest.approx(row.solref, rel=1e-12)
        assert contact.solimp == pytest.approx(row.solimp, rel=1e-12)


def test_the_row_of_a_step_that_does_not_resolve_it():
    """An extra dashpot h k, on the velocity at the end of the step, and beta = 1/2. Friction stops within the step."""
    h, k, c = 5e-3, 1e6, 30.0
    spec = mujoco.MjSpec.from_string(ON_A_PLANE)
    with pytest.warns(UserWarning, match="does not resolve"):
        contact = mr.contact_for(spec, "ball", "floor", k=k, c=c, timestep=h)
    assert mr.contact_stiffness(contact.solref, contact.solimp, inverse_weight=0.5) == pytest.approx((k, c + h * k))
    d = contact.solimp[0]
    assert d / ((1 - d) * 0.5) == pytest.approx(h * (c + h * k) + 0.5 * h**2 * k)
    assert contact.solreffriction == pytest.approx((0, -d / h))
    assert contact.c == c
