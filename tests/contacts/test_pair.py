"""A contact as text and in a model, what it warns of, and what it refuses."""

import warnings

import mujoco
import numpy as np
import pytest
from pairs import BALL, FLOOR, ON_A_PLANE, made_for, rebound, scene, since

import mjrock as mr


def test_the_text_is_the_same_contact():
    contact, model = made_for(ON_A_PLANE, "ball", "floor", restitution=0.5, friction=0.7)
    pasted = mujoco.MjModel.from_xml_string(ON_A_PLANE.replace("</mujoco>", contact.xml + "</mujoco>"))
    assert contact.caveats(pasted) == ()
    for name in ("pair_solref", "pair_solimp", "pair_solreffriction", "pair_friction", "pair_dim"):
        assert (getattr(pasted, name) == getattr(model, name)).all()
    assert (pasted.opt.cone, pasted.opt.impratio) == (model.opt.cone, model.opt.impratio)
    assert tuple(pasted.pair_solref[0]) == contact.solref


def test_a_compiled_model_keeps_its_pair():
    """The pair takes the numbers, in either order of the geoms, and nothing else of the model changes."""
    text = scene(FLOOR, BALL, pair='<pair geom1="ball" geom2="floor" friction=".3 .3 .1 .2 .2" condim="4"/>')
    model = mujoco.MjModel.from_xml_string(text)
    contact = mr.contact_for(model, "floor", "ball", k=1e6, restitution=0.5)
    assert (contact.friction, contact.condim) == ((0.3, 0.3, 0.1, 0.2, 0.2), 4)
    assert contact.caveats(model)
    contact.apply(model)
    assert contact.caveats(model) == ()
    assert rebound(contact, model)[0] == pytest.approx(0.5, rel=0.003)


def test_a_compiled_model_without_a_pair_can_have_it_on_its_geoms():
    """The geoms mix to the contact whatever they were, because they are equal."""
    text = ON_A_PLANE.replace('name="floor"', 'name="floor" priority="2" solmix="3" solimp=".5 .6 .1"')
    model = mujoco.MjModel.from_xml_string(text)
    contact = mr.contact_for(model, "ball", "floor", k=1e6, restitution=0.5, friction=0.4)
    contact.apply(model, on_geoms=True)
    assert [caveat[:50] for caveat in contact.caveats(model)] == [
        "the model has no explicit <pair> of the geoms, so ",
        "geoms have no solreffriction, so that sliding chan",
    ]
    assert rebound(contact, model)[0] == pytest.approx(0.5, rel=0.003)
    assert (mr.inspect_contacts(model)[0].k, model.geom_friction[0, 0]) == (pytest.approx(1e6), 0.4)
    assert abs(rebound(contact, model, slide=1.0)[0] - 0.5) > 0.03


@pytest.mark.parametrize("unnamed", ["floor", "ball"])
def test_a_geom_without_a_name_is_found_by_its_number(unnamed):
    """It may be the first of the model and the first of the contact, or the last of both."""
    model = mujoco.MjModel.from_xml_string(ON_A_PLANE.replace(f'<geom name="{unnamed}"', "<geom"))
    contact = mr.contact_for(model, 0, 1, k=1e6, restitution=0.5)
    contact.apply(model, on_geoms=True)
    assert contact.ids == (0, 1)
    assert (model.geom_solref == contact.solref).all()


def test_geoms_of_a_specification_are_named_on_request():
    text = ON_A_PLANE.replace('<geom name="floor"', "<geom").replace('<geom name="ball"', "<geom")
    spec = mujoco.MjSpec.from_string(text)
    contacts = mr.contacts_for(spec, {(0, 1): {"k": 1e5, "restitution": 0.5}})
    with pytest.raises(ValueError, match=r"has no name, which .* apply\(spec, name_geoms=True\)"):
        contacts.apply(spec)
    contacts.apply(spec, name_geoms=True)
    assert [pair.geomname1 for pair in spec.pairs] == [spec.geoms[0].name] == ["world[0]"]
    assert contacts.caveats(spec) == ()
    again = mr.contact_for(spec, "world[0]", spec.geoms[1].name, k=2e5, restitution=0.5)
    again.apply(spec, name_geoms=True)
    assert len(spec.pairs) == 1
    assert rebound(again, spec.compile())[0] == pytest.approx(0.5, abs=0.01)


def test_a_specification_keeps_one_pair():
    spec = mujoco.MjSpec.from_string(ON_A_PLANE)
    mr.contact_for(spec, "ball", "floor", k=1e5, restitution=0.2).apply(spec)
    mr.contact_for(spec, "floor", "ball", k=1e6, restitution=0.5).apply(spec)
    assert spec.compile().npair == 1


def test_a_larger_impratio_stays():
    model = made_for(ON_A_PLANE, "ball", "floor", restitution=0.5)[1]
    model.opt.impratio = 1e9
    mr.contact_for(model, "ball", "floor", k=1e6, restitution=0.5).apply(model)
    assert model.opt.impratio == 1e9


@pytest.mark.parametrize("order", [("ball", "floor"), (1, 0), (np.int64(1), "floor"), ("thing", "world")])
def test_geoms_by_name_by_number_and_by_body(order):
    text = ON_A_PLANE.replace('body name="ball"', 'body name="thing"')
    assert mr.contact_for(mujoco.MjSpec.from_string(text), *order, k=1e6, restitution=0.5).geom1 == "ball"


SPOILED = {
    'o_solref=".01 1"><flag override="enable"/></option><option': "the override flag is set",
    '><flag contact="disable"/></option><option': "contacts are disabled",
    '><flag constraint="disable"/></option><option': "constraints are disabled",
}
NEWER = {
    'integrator="discrete"': "the integrator `discrete` takes energy",
    '><flag diagexact="enable"/></option><option': "the diagexact flag is set",
    '><flag sleep="enable"/></option><option': "the sleep flag is set",
}


@pytest.mark.parametrize("options", [*SPOILED, *(pytest.param(each, marks=since(3, 13)) for each in NEWER)])
def test_it_warns_of_what_spoils_every_contact(options):
    spec = mujoco.MjSpec.from_string(scene(FLOOR, BALL, options=options))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        mr.contact_for(spec, "ball", "floor", k=1e6, restitution=0.5)
    assert any((SPOILED | NEWER)[options] in str(each.message) for each in caught)


@pytest.mark.parametrize(
    ("text", "requested", "complaint"),
    [
        (ON_A_PLANE, {"timestep": 1e-3}, "timestep = 0.001 s is long .* 0.00038 s resolves it"),
        (scene(FLOOR, BALL, pair='<pair geom1="ball" geom2="floor" margin=".01"/>'), {}, "a margin of 0.01 m"),
        pytest.param(
            *(scene(FLOOR, BALL, pair='<pair geom1="ball" geom2="floor" adhesion="3"/>'), {}, "an adhesion of 3 N"),
            marks=since(3, 11),
        ),
    ],
)
def test_it_warns_of_what_spoils_this_contact(text, requested, complaint):
    arguments = {"geom1": "ball", "geom2": "floor", "k": 1e6, "restitution": 0.5} | requested
    with pytest.warns(UserWarning, match=complaint):
        mr.contact_for(mujoco.MjSpec.from_string(text), **arguments)


def test_the_step_that_it_names_is_not_warned_of():
    spec = mujoco.MjSpec.from_string(ON_A_PLANE)
    for e in (0.01, 0.2, 0.8, 1.0):
        with pytest.warns(UserWarning, match="is long") as caught:
            mr.contact_for(spec, "ball", "floor", k=1e6, restitution=e, timestep=1e-3)
        named = float(str(caught[0].message).split("; ")[-1].split()[0])
        mr.contact_for(spec, "ball", "floor", k=1e6, restitution=e, timestep=named)


@pytest.mark.parametrize(("k", "timestep"), [(3e5, 1e-3), (4e5, 1e-3), (1e12, 1e-3), (1e12, 8e-5)])
def test_the_step_that_it_names_is_the_last_word(k, timestep):
    """The step is rounded down. Where MuJoCo represents no such contact, both steps are named at once."""
    spec = mujoco.MjSpec.from_string(ON_A_PLANE)
    requested = {"k": k, "restitution": 0.5}
    if k == 1e12 and timestep == 1e-3:
        with pytest.raises(ValueError, match=r"the longest step is 8.94e-05 s, and 3.8e-07 s resolves") as refused:
            mr.contact_for(spec, "ball", "floor", **requested, timestep=timestep)
        words = str(refused.value)
    else:
        with pytest.warns(UserWarning, match="s resolves it") as caught:
            mr.contact_for(spec, "ball", "floor", **requested, timestep=timestep)
        words = str(caught[0].message)
    mr.contact_for(spec, "ball", "floor", **requested, timestep=float(words.split(" s resolves")[0].split()[-1]))


def test_two_pairs_of_the_same_geoms():
    """MuJoCo makes the contacts of both, whichever comes first."""
    contact, _ = made_for(ON_A_PLANE, "ball", "floor", restitution=0.5)
    other = '<contact><pair geom1="floor" geom2="ball" solref="-1000 -10" solimp=".5 .5 .001"/></contact>'
    for added, softer in ((contact.xml + other, 1), (other + contact.xml, 0)):
        model = mujoco.MjModel.from_xml_string(ON_A_PLANE.replace("</mujoco>", added + "</mujoco>"))
        data = mujoco.MjData(model)
        data.qpos[2] -= 1e-6
        mujoco.mj_forward(model, data)
        assert data.ncon == 2
        assert any("has 2 explicit <pair>s of these geoms" in caveat for caveat in contact.caveats(model))
        found = mr.inspect_contacts(model)
        assert all("has 2 explicit <pair>s" in one.notes[0] for one in found)
        assert (found[1 - softer].k, found[softer].k) == (pytest.approx(1e6), pytest.approx(1000 / 0.5 * 2))


def test_of_two_options_the_last_is_taken():
    later = ON_A_PLANE.replace("</mujoco>", '<option impratio="1e9"/><option impratio="1e3"/></mujoco>')
    assert mujoco.MjModel.from_xml_string(later).opt.impratio == 1e3


def test_caveats_say_what_was_not_written():
    contact, model = made_for(ON_A_PLANE, "ball", "floor", restitution=0.5)
    bare = mujoco.MjModel.from_xml_string(ON_A_PLANE)
    assert "the model has no explicit <pair> of the geoms" in contact.caveats(bare)[0]
    changes = {
        "cone": (model.opt, "cone", 0, "pyramidal"),
        "impratio": (model.opt, "impratio", 1.0, "impratio = 1 is below"),
        "timestep": (model.opt, "timestep", 2e-5, "the model steps by 2e-05 s"),
        "integrator": (model.opt, "integrator", 1, "made for the integrator EULER"),
        "solref": (model, "pair_solref", [[-1.0, -1.0]], "another solref"),
        "friction": (model, "pair_friction", [[0.1] * 5], "another friction"),
        "condim": (model, "pair_dim", [1], "condim 1 for 3"),
    }
    for owner, name, value, complaint in changes.values():
        kept = np.array(getattr(owner, name))
        _write(owner, name, value)
        assert any(complaint in caveat for caveat in contact.caveats(model)), name
        _write(owner, name, kept)
    assert contact.caveats(model) == ()


def _write(owner, name, value):
    if np.ndim(value):
        getattr(owner, name)[:] = value
    else:
        setattr(owner, name, type(getattr(owner, name))(value))


@pytest.mark.parametrize(
    ("requested", "complaint"),
    [
        ({}, "exactly one of c, restitution and xi has to be given; given are none"),
        (
            {"restitution": 0.5, "xi": 0.1},
            "exactly one of c, restitution and xi .* given are restitution = 0.5, xi = 0.1",
        ),
        ({"restitution": 1.5}, "restitution = 1.5 is outside the valid range 0 to 1"),
        ({"xi": -0.1}, "damping ratio xi = -0.1"),
        ({"c": -1.0}, "damping c = -1 N s/m"),
        ({"c": 1.0, "k": 0.0}, "stiffness k = 0 N/m"),
        (
            {"c": 1.0, "geom1": "bal"},
            "geom1 = 'bal' is not a geom or body .* geoms are: floor, ball; its named bodies are: world, ball",
        ),
        ({"c": 1.0, "geom1": -1}, "geom1 = -1 is outside"),
        ({"c": 1.0, "geom1": 2}, "geom1 = 2 is outside the valid range 0 to 1"),
        ({"c": 1.0, "geom1": 1.0}, "geom1 = 1.0 of type float is neither the name nor the number"),
        ({"c": 1.0, "geom1": "floor"}, "geom1 and geom2 = 'floor' .* are the same geom"),
        ({"c": 1.0, "model": ON_A_PLANE}, "model = .* is not a MjModel or MjSpec; load .*from_xml_string"),
        ({"c": 1.0, "model": "model.xml"}, "model = 'model.xml' .* load it with mujoco.MjModel.from_xml_path"),
        ({"c": 1.0, "model": 1}, "model = 1 .* is not a MjModel or MjSpec"),
        ({"c": 1.0, "friction": -0.1}, "friction = -0.1"),
        ({"c": 1.0, "mass": 0.0}, "mass = 0 kg"),
        ({"c": 1.0, "mass": 1.0, "at": (0, 0, 0)}, "mass = 1.0 .* and at = .* are both given"),
        ({"c": 1.0, "at": (0, 0)}, r"at has the shape \(2,\)"),
        ({"c": 1.0, "at": (0, 0, 1e99)}, "at = .* is outside the valid range"),
        ({"c": 1.0, "contacts": 1.5}, "contacts = 1.5 is not a whole number"),
        ({"c": 1.0, "timestep": 1.0}, "stiffness k = 1e.06 N/m at timestep = 1 s .* the longest step is"),
        ({"c": 1e12}, "damping c = 1e.12 N s/m at timestep = 1e-05 s .* lower the timestep"),
        ({"c": 1.0, "newmark_beta": 1e6, "timestep": 1e-3}, "newmark_beta = 1e.06 requires more inertia"),
    ],
)
def test_what_cannot_be_is_refused(requested, complaint):
    model = mujoco.MjModel.from_xml_string(ON_A_PLANE)
    arguments = {"model": model, "geom1": "ball", "geom2": "floor", "k": 1e6} | requested
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.contact_for(**arguments)


def test_what_cannot_be_applied_is_refused():
    bare = mujoco.MjModel.from_xml_string(ON_A_PLANE)
    contact = mr.contact_for(bare, "ball", "floor", k=1e6, restitution=0.5)
    with pytest.raises(
        ValueError, match=r"model has no explicit <pair> of 'ball' and 'floor'; .* MjSpec .* \.xml .* on_geoms=True"
    ):
        contact.apply(bare)
    heavy = mujoco.MjSpec.from_string(ON_A_PLANE.replace('mass="2"', 'mass="3"'))
    with pytest.raises(ValueError, match=r"inverse weight 0.333333333 1/kg .* was made for 0.5 1/kg"):
        contact.apply(heavy)
    nameless = mujoco.MjSpec.from_string(ON_A_PLANE.replace('<geom name="floor"', "<geom"))
    contact = mr.contact_for(nameless, "ball", 0, k=1e6, restitution=0.5)
    for use in (lambda: contact.xml, lambda: contact.apply(nameless)):
        with pytest.raises(ValueError, match=r"has no name.*apply.model, on_geoms=True"):
            use()
    broken = mujoco.MjSpec.from_string("<mujoco><worldbody><body><freejoint/></body></worldbody></mujoco>")
    with pytest.raises(ValueError, match="model does not compile"):
        mr.contact_for(broken, 0, 1, k=1e6, c=1.0)
    static = mujoco.MjSpec.from_string(scene(FLOOR, '<geom name="post" size=".1"/>'))
    with pytest.raises(ValueError, match="neither centre of mass can move"):
        mr.contact_for(static, "post", "floor", k=1e6, c=1.0)


def test_the_model_is_left_alone():
    spec = mujoco.MjSpec.from_string(ON_A_PLANE)
    before = spec.to_xml()
    mr.contact_for(spec, "ball", "floor", k=1e6, restitution=0.5)
    assert spec.to_xml() == before


def test_a_contact_without_friction_asks_for_nothing_more():
    contact = mr.contact_for(mujoco.MjSpec.from_string(ON_A_PLANE), "ball", "floor", k=1e6, c=30.0, friction=0)
    assert (contact.condim, contact.solreffriction, contact.impratio) == (1, (0.0, 0.0), 1.0)
    assert "cone" not in contact.xml
    assert "friction" not in contact.xml
