"""What a contact leaves as it is in a model: condim, MuJoCo's filters, other contacts, and geoms that land with it."""

import re
import warnings

import mujoco
import numpy as np
import pytest
from everyday import crossed
from pairs import BALL, FLAT_BOX, FLOOR, ON_A_PLANE, scene

import mjrock as mr

ROLLING = ON_A_PLANE.replace('mass="2"', 'mass="2" condim="{}" friction=".7 .02 .003"')
REQUESTED = {"k": 1e5, "restitution": 0.5}
FOOT = '<body name="foot" pos="0 0 .1"><freejoint/><geom name="box" type="box" size=".1 .1 .02" mass="4"/>{}</body>'
TOES = [f'<geom name="toe{i}" pos="{x} {y} -.03" size=".02" mass="0"/>'
        for i, (x, y) in enumerate(((0.08, 0.08), (0.08, -0.08), (-0.08, 0.08), (-0.08, -0.08)))]  # fmt: skip
SLIPPERY = '<default><geom friction=".3"/></default><worldbody>'
NEIGHBOUR = (
    '<body name="crate" pos="1 0 .1"><freejoint/><geom name="crate" type="box" size=".1 .1 .1" mass="2"/></body>'
)


def spec_of(text):
    return mujoco.MjSpec.from_string(text)


@pytest.mark.parametrize(("condim", "kept"), [(1, 3), (3, 3), (4, 4), (6, 6)])
def test_friction_keeps_condim_and_what_it_does_not_name(condim, kept):
    text = ROLLING.format(condim).replace('type="plane"', f'type="plane" condim="{condim}"')
    contact = mr.contact_for(spec_of(text), "ball", "floor", friction=0.9, **REQUESTED)
    assert (contact.condim, contact.friction) == (kept, (0.9, 0.9, 0.02, 0.003, 0.003))
    five = mr.contact_for(spec_of(ROLLING.format(6)), "ball", "floor", friction=(0.4, 0.5, 0.1, 0.2, 0.3), **REQUESTED)
    assert (five.condim, five.friction) == (6, (0.4, 0.5, 0.1, 0.2, 0.3))
    assert mr.contact_for(spec_of(text), "ball", "floor", friction=0.0, **REQUESTED).condim == 1


def test_a_spinning_ball_stops_as_in_the_model():
    ball = BALL.replace('mass="2"', 'mass="2" condim="4" friction=".7 .02 .003"')
    text = scene(FLOOR, ball, timestep=2e-4, gravity=9.81)
    spec = spec_of(text)
    mr.contact_for(spec, "ball", "floor", friction=0.7, **REQUESTED).apply(spec)
    spins = []
    for model in (spec_of(text).compile(), spec.compile()):
        data = mujoco.MjData(model)
        data.qvel[5] = 10.0
        mujoco.mj_step(model, data, int(0.4 / model.opt.timestep))
        spins.append(float(data.qvel[5]))
    assert spins == pytest.approx([0, 0], abs=1e-2)


def test_friction_that_condim_leaves_out_is_said():
    with pytest.warns(mr.ContactWarning, match=r"friction that condim 3 leaves out; give the geoms condim 4"):
        mr.contact_for(spec_of(ON_A_PLANE), "ball", "floor", friction=(0.4, 0.4, 0.1, 0.0, 0.0), **REQUESTED)
    mr.contact_for(spec_of(ON_A_PLANE), "ball", "floor", friction=(0.4, 0.4, 0.0, 0.0, 0.0), **REQUESTED)
    with pytest.raises(ValueError, match=r"has 3 numbers; one of sliding is needed, or five"):
        mr.contact_for(spec_of(ON_A_PLANE), "ball", "floor", friction=(0.4, 0.1, 0.1), **REQUESTED)


SEEN = '<geom name="ball_seen" type="box" size=".15 .15 .15" mass="0" contype="0" conaffinity="0"/>'
WITH_SEEN = BALL.replace("</body>", f"{SEEN}</body>")
CHILD = '<body pos="0 0 -.05"><joint axis="0 1 0"/><geom name="floor_of_foot" size=".08" mass="1"/></body>'
KEPT_APART = {
    "contype": (scene(FLOOR, WITH_SEEN), ("ball_seen", "floor"), "their contype and conaffinity do not match"),
    "exclude": (scene(FLOOR, BALL, pair='<exclude body1="world" body2="ball"/>'),
                ("ball", "floor"), "an <exclude> names their bodies"),
    "parent": (scene(BALL.replace("</body>", f"{CHILD}</body>")),
               ("ball", "floor_of_foot"), "their bodies are parent and child"),
}  # fmt: skip


@pytest.mark.parametrize("why", KEPT_APART)
def test_wildcards_obey_the_filters_and_a_plain_name_says_that_it_overrides_them(why):
    """The pair makes the contact that MuJoCo does not, and what has it is not warned of again."""
    text, names, reason = KEPT_APART[why]
    spec = spec_of(text)
    with pytest.raises(ValueError, match="are geoms that MuJoCo keeps apart"):
        mr.contacts_for(spec, {(names[0][:-1] + "?", names[1]): REQUESTED | {"mass": 1.0}})
    with pytest.warns(mr.ContactWarning, match=f"MuJoCo keeps these geoms apart, since {reason}"):
        contact = mr.contact_for(spec, *names, mass=1.0, **REQUESTED)
    contact.apply(spec)
    model = spec.compile()
    assert contact.caveats(model) == ()
    assert mr.contacts_for(model, {(names[0][:-1] + "?", names[1]): REQUESTED | {"mass": 1.0}}).contacts == (contact,)


def test_a_visual_geom_stays_visual():
    """The ball rests on its own radius, not on the box that is drawn around it."""
    text = scene(FLOOR, WITH_SEEN, timestep=2e-4, gravity=9.81)
    spec = spec_of(text)
    contacts = mr.contacts_for(spec, {("ball*", "floor"): REQUESTED})
    contacts.apply(spec)
    data = mujoco.MjData(model := spec.compile())
    mujoco.mj_step(model, data, 4000)
    assert (len(contacts), data.qpos[2]) == (1, pytest.approx(0.1 - 2 * 9.81 / 1e5, abs=1e-6))


def sunk(spec):
    """How deep the crate rests [m]."""
    data = mujoco.MjData(model := spec.compile())
    mujoco.mj_step(model, data, 1500)
    return 0.1 - float(data.qpos[-5])


def test_the_elliptic_cone_is_told_to_others_or_kept_from_them():
    """With the pyramidal cone and mu = 0.3 the rows of a contact are 2 / (mu^2 (1 + mu^2)) = 20.4 times as stiff."""
    text = scene(FLOOR, BALL, NEIGHBOUR, timestep=1e-3, gravity=9.81).replace("<worldbody>", SLIPPERY)
    depths = [sunk(spec_of(text))]
    for keep in (False, True):
        contact = mr.contact_for(spec := spec_of(text), "ball", "floor", **REQUESTED)
        if keep:
            contact.apply(spec, keep_others=True)
        else:
            with pytest.warns(mr.ContactWarning, match=r"2 other contacts .*: floor on crate \(9.15e\+05 to 5.34e\+04"):
                contact.apply(spec)
        depths.append(sunk(spec))
        assert contact.caveats(spec) == ()
    assert depths[1] / depths[0] == pytest.approx(20.4, rel=0.03)
    assert depths[2] / depths[0] == pytest.approx(1, abs=0.05)


@pytest.mark.parametrize(
    ("solimp", "solref", "mu"),
    crossed(["0.9 0.9 .001", "0.2 0.2 .001", "0.9 0.95 .001"], [".02 1", "-2e4 -50"], [0.3, 0.7, 1.4]),
)
def test_a_pair_of_the_model_is_kept(mu, solref, solimp):
    """k, c and the inertia of its row, exactly where d does not grow."""
    pair = f'<pair geom1="crate" geom2="floor" friction="{mu} {mu}" solref="{solref}" solimp="{solimp}"/>'
    own = '<pair geom1="ball" geom2="floor"/><pair geom1="ball" geom2="crate" condim="1"/>'
    model = mujoco.MjModel.from_xml_string(scene(FLOOR, BALL, NEIGHBOUR, timestep=1e-4, gravity=1.0, pair=pair + own))
    before = next(found for found in mr.inspect_contacts(model) if found.geom2 == "crate")
    mr.contact_for(model, "ball", "floor", **REQUESTED).apply(model, keep_others=True)
    after = next(found for found in mr.inspect_contacts(model) if found.geom2 == "crate")
    exact = 1e-9 if len({*solimp.split()[:2]}) == 1 else 0.05
    assert (after.k, after.c, after.inertia) == pytest.approx((before.k, before.c, before.inertia), rel=exact)


def test_what_cannot_be_kept_is_named():
    """Geoms without names, and compiled models, have no place for another pair."""
    text = scene(FLOOR, BALL, NEIGHBOUR, timestep=1e-3).replace("<worldbody>", SLIPPERY)
    nameless = spec_of(text.replace('geom name="crate"', "geom"))
    with pytest.warns(mr.ContactWarning, match=r"2 other contacts .*: floor on crate\[2\]"):
        mr.contact_for(nameless, "ball", "floor", **REQUESTED).apply(nameless, keep_others=True)
    model = mujoco.MjModel.from_xml_string(text.replace("<contact>", '<contact><pair geom1="ball" geom2="floor"/>'))
    with pytest.warns(mr.ContactWarning, match="2 other contacts"):
        mr.contact_for(model, "ball", "floor", **REQUESTED).apply(model, keep_others=True)


def landed(text, requested, turned=0.0):
    """e of the foot that lands on four toes, and the contacts."""
    spec = spec_of(text)
    qpos = spec.compile().qpos0.copy()
    qpos[3:7] = np.cos(turned / 2), 0, np.sin(turned / 2), 0
    contacts = mr.contacts_for(spec, requested, qpos=qpos)
    contacts.apply(spec)
    data = mujoco.MjData(model := spec.compile())
    data.qpos[2], data.qvel[2] = 0.0501, -1.0
    mujoco.mj_step(model, data, 60)
    while data.nefc and data.efc_force.max() > 0:
        mujoco.mj_step(model, data)
    return float(data.qvel[2]), contacts


def test_geoms_of_a_foot_share_its_mass():
    """Four balls that land flat stop a quarter of the foot each, as the corners of a box do."""
    text = scene(FLOOR, FOOT.format("".join(TOES)), timestep=1e-4)
    e, contacts = landed(text, {("toe*", "floor"): {"k": 1e5, "restitution": 0.3}})
    assert e == pytest.approx(0.3, abs=0.005)
    assert [(contact.contacts, contact.mass) for contact in contacts] == [(4, pytest.approx(1.0))] * 4
    alone = mr.contact_for(spec_of(text), "toe0", "floor", k=1e5, restitution=0.3, contacts=1, friction=0.0)
    assert alone.mass == pytest.approx(1 / (1 / 4 + 2 * 0.08**2 / (4 / 12 * (0.2**2 + 0.04**2))))
    assert {found.points for found in mr.inspect_contacts(spec_of(text)) if found.geom2[:3] == "toe"} == {4}


def test_what_a_foot_has_besides_is_said():
    text = scene(FLOOR, FOOT.format("".join(TOES)), timestep=1e-4)
    requested = {"k": 1e5, "restitution": 0.3}
    with pytest.warns(
        mr.ContactWarning, match="it lands together with toe1 on floor, toe2 on floor, toe3 on floor, and"
    ):
        mr.contact_for(spec_of(text), "toe0", "floor", **requested)
    others = {("toe[12]", "floor"): requested, ("toe0", "floor"): requested | {"k": 2e5}, ("toe3", "floor"): requested}
    with pytest.warns(
        mr.ContactWarning, match="toe1 on floor, toe2 on floor, toe3 on floor: it lands together with toe0"
    ):
        mr.contacts_for(spec_of(text), others)


@pytest.mark.parametrize(
    ("turned", "points", "complaint"),
    [
        (0.0005, 4, ""),
        (0.01, 4, "taken to land together with it touches up to 0.0016 m sooner or later; give the pose"),
        (
            0.1,
            2,
            "toe1 on floor: it lands together with toe2 on floor, toe3 on floor, and shares the mass, only on a level",
        ),
    ],
)
def test_a_foot_that_is_not_level_is_said(turned, points, complaint):
    text = scene(FLOOR, FOOT.format("".join(TOES)), timestep=1e-4)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        _, contacts = landed(text, {("toe*", "floor"): {"k": 1e5, "restitution": 0.3}}, turned)
    assert {contact.contacts for contact in contacts} == {points}
    (message,) = [str(warning.message) for warning in caught] or [""]
    assert complaint in message
    assert bool(complaint) == bool(message)


def test_without_k_it_says_where_it_is_soft():
    ball = spec_of(scene(FLOOR, BALL, timestep=5e-3, gravity=9.81))
    with pytest.warns(mr.ContactWarning) as caught:
        contact = mr.contact_for(ball, "ball", "floor", restitution=0.5)
    softer, deep = (str(warning.message) for warning in caught)
    assert re.match(r"k = 5.88e\+03 N/m, .* softer than .* the model had, 5.34e\+04 N/m .*; 0.0016 s resolves", softer)
    assert re.match(r"the weight presses .* by 0.0033 m .*, 3% of their smallest half extent; 0.0027 s", deep)
    assert contact.depth == pytest.approx(2 * 9.81 / contact.k)
    fine = mr.contact_for(ball, "ball", "floor", restitution=0.5, timestep=1.6e-3)
    assert fine.k > 5.34e4
    box = mr.contact_for(spec_of(FLAT_BOX.replace('gravity="0 0 -0.0"', "")), "box", "floor", **REQUESTED)
    assert box.depth == pytest.approx(2 * 9.81 / 4e5)


def test_attached_it_is_found_by_its_prefix_and_lacks_the_options():
    child, parent = spec_of(ON_A_PLANE), spec_of("<mujoco/>")
    contact = mr.contact_for(child, "ball", "floor", **REQUESTED)
    contact.apply(child)
    parent.attach(child, prefix="robot-", frame=parent.worldbody.add_frame(pos=[0, 0, 1]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # MuJoCo names the options that it leaves behind
        model = parent.compile()
    for found in (contact.caveats(model, prefix="robot-"), mr.PairContacts((contact,)).caveats(model, "robot-")):
        assert len(found) == 3
        assert "the model steps by" in found[0]
        assert "the friction cone is pyramidal" in found[1]
        assert "impratio = 1 is below" in found[2]
    with pytest.raises(ValueError, match="'ball' is not a geom or body"):
        contact.caveats(model)
    again = mr.contact_for(parent, "robot-ball", "robot-floor", timestep=1e-5, **REQUESTED)
    again.apply(parent)
    assert again.caveats(parent) == ()


def test_a_flex_is_named():
    cloth = """<flexcomp name="cloth" type="grid" count="3 3 1" spacing=".1 .1 .1" radius=".01" dim="2">
    <edge equality="true"/></flexcomp>"""
    with pytest.raises(ValueError, match="geom1 = 'cloth' is a flex, which no explicit pair covers"):
        mr.contact_for(spec_of(scene(FLOOR, cloth)), "cloth", "floor", **REQUESTED)


def test_its_attributes_and_its_line():
    contact = mr.contact_for(
        spec_of(scene(FLOOR, BALL, gravity=9.81)), "ball", "floor", friction=0.3, speed=1.0, **REQUESTED
    )
    spec = spec_of(ON_A_PLANE)
    names = {"geom1": "geomname1", "geom2": "geomname2"}
    spec.add_pair(**{names.get(key, key): value for key, value in contact.attributes.items()})
    for key, value in contact.options.items():
        setattr(spec.option, key, mujoco.mjtCone.mjCONE_ELLIPTIC if key == "cone" else value)
    assert contact.caveats(spec) == ()
    line = str(contact)
    assert line.startswith("ball on floor: k = 1e+05 N/m, c = ")
    assert "e = 0.5 at 1 m/s with gravity" in line
    assert "depth 0.000196 m" in line
    assert len(line) < 230
    both = mr.PairContacts((contact, contact))
    assert (str(both).count("\n"), both.options) == (1, contact.options)


def test_a_later_entry_replaces_what_wildcards_named():
    text = scene(FLOOR, *(BALL.replace("ball", f"ball{i}") for i in range(3)))
    harder = REQUESTED | {"k": 3e5}
    found = mr.contacts_for(spec_of(text), {("ball*", "floor"): REQUESTED, ("ball1", "floor"): harder})
    assert {contact.geom1: contact.k for contact in found} == {"ball0": 1e5, "ball1": 3e5, "ball2": 1e5}
