"""`contacts_for`: names with wildcards, one compilation, one option; and arrays in `contact_parameters`."""

import mujoco
import numpy as np
import pytest
from pairs import FLOOR, scene, since

import mjrock as mr
from mjrock.contacts import geoms

FEET = "".join(
    f'<body name="leg{i}" pos="{i} 0 .1"><freejoint/><geom name="foot{i}" size=".1" mass="{i + 1}"/></body>'
    for i in range(3)
)
ROBOT = scene(FLOOR, FEET, '<body name="pad" pos="0 3 .1"><freejoint/><geom size=".1" mass="1"/></body>')
REQUESTED = {
    ("foot*", "floor"): {"k": 1e6, "restitution": 0.5},
    ("pad", "foot0"): {"k": 2e6, "xi": 0.1, "friction": 0.0},
}


def test_they_are_those_of_contact_for():
    spec = mujoco.MjSpec.from_string(ROBOT)
    contacts = mr.contacts_for(spec, REQUESTED, timestep=2e-5)
    assert [(contact.geom1, contact.geom2) for contact in contacts] == [
        ("foot0", "floor"), ("foot1", "floor"), ("foot2", "floor"), ("", "foot0"),
    ]  # fmt: skip
    assert len(contacts) == 4
    for i, contact in enumerate(contacts.contacts[:3]):
        assert contact == mr.contact_for(spec, f"foot{i}", "floor", k=1e6, restitution=0.5, timestep=2e-5)
    assert contacts.impratio == max(contact.impratio for contact in contacts)


def test_a_specification_is_compiled_once(monkeypatch):
    spec = mujoco.MjSpec.from_string(ROBOT)
    requested = {("foot*", "floor"): {"k": 1e6, "restitution": 0.5}}
    times = []
    for module in ("make", "contact"):
        monkeypatch.setattr(
            f"mjrock.contacts.{module}.compiled_model",
            lambda model: times.append(1) or geoms.compiled_model(model),
        )
    contacts = mr.contacts_for(spec, requested)
    contacts.apply(spec)
    assert len(times) == 2
    model = spec.compile()
    assert (model.npair, model.opt.cone, model.opt.impratio) == (3, 1, pytest.approx(contacts.impratio))
    assert contacts.caveats(model) == ()
    pasted = mujoco.MjModel.from_xml_string(ROBOT.replace("</mujoco>", contacts.xml + "</mujoco>"))
    assert contacts.xml.count("<option") == 1
    assert contacts.caveats(pasted) == ()
    assert (pasted.pair_solref == model.pair_solref).all()
    assert "foot0 on floor: impratio = 1 is below" in _with_impratio(model, contacts, 1.0)
    contacts.apply(pasted)
    assert contacts.caveats(pasted) == ()


def _with_impratio(model, contacts, value):
    model.opt.impratio = value
    return contacts.caveats(model)[0]


@since(3, 13)
def test_a_sentence_is_said_once():
    spec = mujoco.MjSpec.from_string(ROBOT)
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
    with pytest.warns(UserWarning, match="foot0 on floor, foot1 on floor, foot2 on floor: the integrator") as caught:
        mr.contacts_for(spec, {("foot?", "floor"): {"k": 1e6, "restitution": 0.5}})
    assert len(caught) == 1


def test_wildcards_among_bodies_and_among_each_other():
    spec = mujoco.MjSpec.from_string(ROBOT)
    legs = mr.contacts_for(spec, {("leg*", "leg[01]"): {"k": 1e6, "c": 1.0}})
    assert {frozenset(contact.ids) for contact in legs} == {frozenset(pair) for pair in ((1, 2), (1, 3), (2, 3))}


@pytest.mark.parametrize(
    ("pairs", "complaint"),
    [
        ({}, "pairs = {} of type dict name no contact"),
        ({("hand*", "floor"): {"k": 1.0, "c": 1.0}}, r"geom1 = 'hand\*' of type str matches no geom.*geoms are: floor"),
        ({("foot0", "floor"): {"k": 1.0, "e": 1.0}}, "have e; each takes k, k_face, k_n, depth, load, c, restitution"),
        ({("foot0", "floor"): 3.0}, "= 3.0 of type float has to be arguments of contact_for"),
        ({"foot0": {"k": 1.0, "c": 1.0}}, "pairs have the key 'foot0' of type str; it has to be two geoms"),
        (
            {("foot0", "floor"): {"k": 1e6, "c": 1.0}, ("foot*", 0): {"k": 1e6, "c": 1.0}},
            "pairs name the geoms .* twice",
        ),
        ([("foot0", "floor")], "pairs = .* has to be a dictionary, such as"),
    ],
)
def test_what_cannot_be_is_refused(pairs, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.contacts_for(mujoco.MjModel.from_xml_string(ROBOT), pairs)


def test_arrays_of_contacts():
    """Stiffness that differs from one environment to the next, or from contact to contact of another engine."""
    k, weight = np.array([[1e5], [2e5]]), [0.5, 0.7, 2.0]
    many = mr.contact_parameters(k, 30.0, timestep=1e-3, inverse_weight=weight)
    assert (many.solref.shape, many.solimp.shape, many.inertia.shape) == ((2, 3, 2), (2, 3, 5), (2, 3))
    single = mr.contact_parameters(2e5, 30.0, timestep=1e-3, inverse_weight=0.7)
    assert tuple(many.solref[1, 1]) == single.solref
    assert tuple(many.solimp[1, 1]) == single.solimp
    assert many.inertia[1, 1] == single.inertia
    with pytest.raises(ValueError, match=r"the shapes of stiffness k \(2,\), .* do not go together"):
        mr.contact_parameters([1e5, 2e5], [1.0, 2.0, 3.0], timestep=1e-3, inverse_weight=1.0)
    with pytest.raises(ValueError, match="stiffness k = -1 N/m is outside"):
        mr.contact_parameters([1e5, -1.0], 1.0, timestep=1e-3, inverse_weight=1.0)
