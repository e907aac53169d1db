"""What a solver lacks is found wherever the geoms are: in touch, in the air, in bodies of several geoms."""

import itertools
import os
import warnings

import mujoco
import numpy as np
import pytest
from everyday import crossed
from pairs import BALL, FLOOR, scene, since

import mjrock as mr
from mjrock.contacts.geoms import GeomPair
from mjrock.contacts.meeting import Pose
from mjrock.contacts.solver_trial import SolverTrial

LEG = """<body pos="0 {y} -.15"><joint axis="0 1 0" armature=".01"/>
<geom type="capsule" fromto="0 0 0 0 0 -.3" size=".04" mass="3"/>
<body pos="0 0 -.34"><joint axis="0 1 0" armature=".01"/>
<geom type="capsule" fromto="0 0 0 0 0 -.25" size=".035" mass="2"/>
<geom name="foot{y}" size=".05" pos="0 0 -.3" mass=".5"/></body></body>"""
FEET = {("foot*", "floor"): {"k": 5e4, "xi": 0.7, "friction": 0.8}}
TORSO = '<geom type="box" size=".1 .15 .2" pos="0 0 .1" mass="20"/>'


def biped(height, timestep=2e-3, solver="Newton", iterations=1):
    """Feet of which each has a shin beside it, so high above the floor [m]."""
    legs = "".join(LEG.format(y=y) for y in (0.1, -0.1))
    body = f'<body pos="0 0 {height + 0.84}"><freejoint/>{TORSO}{legs}</body>'
    options = f'solver="{solver}" iterations="{iterations}" ls_iterations="4"'
    return mujoco.MjSpec.from_string(scene(FLOOR, body, timestep=timestep, gravity=9.81, options=options))


def dropped(solver, gap):
    boxes = (
        f'<body pos="0 0 {0.05 + 0.1 * i + gap * (i + 1)}"><freejoint/>'
        f'<geom name="box{i}" type="box" size="{0.1 - 0.001 * i} {0.07 - 0.001 * i} .05" mass="1.3"/></body>'
        for i in range(3)
    )
    return mujoco.MjSpec.from_string(scene(FLOOR, *boxes, timestep=5e-4, gravity=9.81, options=f'solver="{solver}"'))


@since(4, 0)
@pytest.mark.parametrize("timestep", [2e-3, 1e-4])
def test_few_iterations_are_named_at_any_height(timestep):
    """50 steps of free fall are 49 mm at 2 ms and .12 mm at .1 ms; the feet are found from much higher."""
    needs = set()
    for height in (0.01, 0.1, 1.0):
        with pytest.warns(mr.ContactWarning, match=r"the solver needs iterations = \d+ .* the model has 1 and 4"):
            needs.add(mr.contacts_for(biped(height, timestep), FEET).contacts[0].needs)
    turns = [need.iterations for need in needs]
    assert min(turns) >= 10
    assert max(turns) <= 20


def test_a_biped_that_lands_with_what_is_named_gains_no_energy():
    """With one iteration it gains .8 kJ, and nothing with what the trial in the air writes."""
    spec = biped(0.1)
    with pytest.warns(mr.ContactWarning, match="the solver needs"):
        mr.contacts_for(spec, FEET).apply(spec, iterations=True)
    model = spec.compile()
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    gained = []
    for iterations, searches in ((model.opt.iterations, model.opt.ls_iterations), (1, 4)):
        model.opt.iterations, model.opt.ls_iterations = iterations, searches
        data = mujoco.MjData(model)
        random = np.random.default_rng(0)
        data.qvel[:], data.qpos[7:] = 0.5 * random.normal(size=10), 0.3 * random.normal(size=4)
        mujoco.mj_forward(model, data)
        energy = [float(data.energy.sum())]
        for _ in range(500):
            mujoco.mj_step(model, data)
            energy.append(float(data.energy.sum()))
        gained.append(max(energy) - energy[0])
    assert gained[0] <= 0.0
    assert gained[1] > 100.0


@pytest.mark.parametrize(("solver", "gap"), crossed(["PGS", "CG"], [0.0, 0.05]))
def test_solvers_that_do_not_converge_are_named_at_once(solver, gap):
    """Boxes that are dropped onto each other fall apart with them, with MuJoCo's own 100 iterations."""
    spec, names = dropped(solver, gap), ["floor", "box0", "box1", "box2"]
    joint = {"k": 2.5e4, "xi": 0.5, "friction": 0.6}
    says = f"the solver {solver} does not converge with this contact in 100 iterations"
    with pytest.warns(mr.ContactWarning, match=says):
        made = mr.contacts_for(spec, {(above, below): joint for below, above in itertools.pairwise(names)})
    with pytest.warns(mr.ContactWarning, match=says):
        made.apply(spec)


def trial_of(spec, geom1, geom2):
    pose, pair = Pose(spec.compile()), GeomPair.named(spec.compile(), geom1, geom2)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        contact = mr.contact_for(spec, geom1, geom2, k=5e4, xi=0.7, friction=0.8)
    return SolverTrial(pose, [(contact, pose.landing(pair))])


def test_nothing_else_is_pressed():
    """A margin as wide as a foot is high would press it into its own shin and into the other foot."""
    trial = trial_of(biped(0.5), "foot0.1", "floor")
    data = mujoco.MjData(trial.model)
    trial._find_contacts(data)
    assert [sorted(each.geom) for each in data.contact if not each.exclude] == [sorted(trial.contacts.contacts[0].ids)]
    assert data.contact[0].dist == pytest.approx(-0.3 / trial.contacts.contacts[0].frequency)


def test_a_trial_prints_nothing_and_leaves_no_log(tmp_path, monkeypatch, capfd):
    """Steps by `mj_step` reset a state that blows up, print, and write MUJOCO_LOG.TXT."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("mjrock.contacts.solver_trial.MOVING", 1e12)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mr.contacts_for(biped(0.3), FEET)
    assert capfd.readouterr() == ("", "")
    assert os.listdir(tmp_path) == []


def test_what_is_not_tried_says_so():
    spec = mujoco.MjSpec.from_string(scene(FLOOR, BALL, options='><flag contact="disable"/></option><option'))
    with pytest.warns(mr.ContactWarning) as caught:
        contact = mr.contact_for(spec, "ball", "floor", k=1e5, xi=0.5)
    assert not contact.needs.tried
    assert any("enough iterations for it is not tried" in str(each.message) for each in caught)
    assert any("contacts are disabled" in str(each.message) for each in caught)


def test_friction_of_zero_in_condim_3_is_tried():
    """MuJoCo takes a coefficient of 1e-5 at least, without which its elliptic cone has no numbers."""
    text = scene(FLOOR.replace("/>", ' friction="0 0 0"/>'), BALL.replace('mass="2"', 'mass="2" friction="0 0 0"'))
    assert mr.contact_for(mujoco.MjSpec.from_string(text), "ball", "floor", k=1e5, xi=0.5).needs.tried


def test_the_order_of_the_geoms_and_where_they_stand_change_nothing():
    """A pair the other way round, on its side, and far from the origin."""
    needs = []
    for names, turn, x in (
        (("foot*", "floor"), "", 0.0),
        (("floor", "foot*"), "", 0.0),
        (("foot*", "floor"), "", 3.0),
        (("foot*", "floor"), 'euler="0 90 0"', 0.0),
    ):
        legs = "".join(LEG.format(y=y) for y in (0.1, -0.1))
        body = f'<body pos="0 0 1.2"><freejoint/>{TORSO}{legs}</body>'
        world = f'<frame pos="{x} 0 0" {turn}>{FLOOR}{body}</frame>'
        text = scene(world, timestep=2e-3, options='iterations="1" ls_iterations="4"')
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            spec = mujoco.MjSpec.from_string(text)
            spec.option.gravity = (-9.81, 0, 0) if turn else (0, 0, -9.81)
            needs.append(mr.contacts_for(spec, {names: FEET["foot*", "floor"]}).contacts[0].needs.iterations)
    assert min(needs) >= 10
    assert max(needs) <= 1.6 * min(needs)
