"""`inspect_contacts` against the rows that MuJoCo makes, and against measured rebounds."""

import mujoco
import numpy as np
import pytest
from everyday import among
from pairs import FLAT_BOX, ON_A_PLANE, made_for, since

import mjrock as mr
from mjrock.contacts.effective_mass import _slipping_impulse

MODEL = """<mujoco><option timestep="{h}" cone="{cone}" impratio="{impratio}" gravity="0 0 0"><flag {flags}/></option>
<worldbody><geom name="floor" type="plane" size="5 5 .1" {floor}/>
<body pos="0 0 .1"><freejoint/><geom name="ball" size=".1" mass="2" {ball}/></body></worldbody>
<contact>{pair}</contact></mujoco>"""


def made(h=1e-5, cone="elliptic", impratio=1, flags="", floor="", ball="", pair=""):
    return mujoco.MjModel.from_xml_string(
        MODEL.format(h=h, cone=cone, impratio=impratio, flags=flags, floor=floor, ball=ball, pair=pair)
    )


def drawn(rng):
    """Attributes of a geom: either format of solref, mixtures of both, any impedance, priority, weight and friction."""
    message = {"condim": rng.choice([1, 3, 4, 6]), "friction": rng.uniform(0.1, 1, 3)}
    kind = rng.choice(["none", "time", "direct", "undamped", "mixture"])
    time, direct = (rng.uniform(1e-3, 0.05), rng.uniform(0.1, 2)), (-1e4 * rng.random(), -50 * rng.random())
    values = {"time": time, "direct": direct, "undamped": (direct[0], 0), "mixture": (time[0], direct[1])}
    if kind in values:
        message["solref"] = values[kind]
    if rng.random() < 0.7:
        message["solimp"] = (rng.uniform(-0.1, 1.1), rng.uniform(), rng.choice([0, 0.001]))
    if rng.random() < 0.3:
        message["priority"] = rng.integers(0, 3)
    if rng.random() < 0.5:
        message["solmix"] = rng.choice([0, 0.5, 2])
    return " ".join(
        f'{name}="{" ".join(str(float(v)) for v in np.ravel(value))}"' for name, value in message.items()
    ).replace('.0"', '"')


@pytest.mark.parametrize("seed", among(range(100), *range(30)))
def test_it_is_what_the_engine_makes_of_two_geoms(seed):
    """K, B, d and R of the engine's own rows at a touch, all edges of a pyramid together."""
    rng = np.random.default_rng(seed)
    model = made(
        h=10 ** rng.uniform(-4, -2),
        cone=rng.choice(["elliptic", "pyramidal"]),
        impratio=10 ** rng.uniform(-1, 3),
        flags=rng.choice(["", 'refsafe="disable"']),
        floor=drawn(rng),
        ball=drawn(rng),
    )
    data = mujoco.MjData(model)
    data.qpos[2] -= 1e-9
    mujoco.mj_forward(model, data)
    (found,) = mr.inspect_contacts(model)
    stiffness, damping, impedance, _ = data.efc_KBIP[0]
    elliptic = model.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
    edges = 1 if elliptic or data.contact[0].dim == 1 else 2 * (data.contact[0].dim - 1)
    inertia = edges / data.efc_R[0]
    assert found.impedance == pytest.approx(impedance, abs=1e-5)
    assert found.k == pytest.approx(inertia * stiffness * impedance, rel=1e-4)
    assert found.c == pytest.approx(inertia * damping, rel=1e-4)
    assert found.inertia == pytest.approx(max(0, inertia * (1 - model.opt.timestep * damping / 2)), rel=1e-4, abs=1e-9)
    assert (found.mass, found.explicit) == (pytest.approx(2.0), False)
    assert any("grows with penetration" in note for note in found.notes) == (
        model.geom_solimp[0, 0] != data.contact[0].solimp[1]
        and data.contact[0].solimp[0] != data.contact[0].solimp[1]
        and data.contact[0].solimp[2] > 0
        and np.clip(data.contact[0].solimp[0], 1e-4, 0.9999) != np.clip(data.contact[0].solimp[1], 1e-4, 0.9999)
    )


@pytest.mark.parametrize("cone", ["elliptic", "pyramidal"])
@pytest.mark.parametrize("friction", [1.0, 0.3])
@pytest.mark.parametrize("row", ['solref=".02 .2" solimp=".9 .9 .001"', 'solref="-1e5 -100" solimp=".5 .5 .001"'])
def test_its_restitution_is_measured(row, friction, cone):
    """The inertia of MuJoCo's row moves with the mass: its usual impedance of 0.9 makes a contact ten times as slow."""
    both = f'{row} friction="{friction}"'
    model = made(cone=cone, floor=both, ball=both)
    data = mujoco.MjData(model)
    data.qpos[2] += 3.5e-6
    data.qvel[2] = -0.1
    while data.qvel[2] < 0 or data.efc_force.max(initial=0) > 0:
        mujoco.mj_step(model, data)
    (found,) = mr.inspect_contacts(model)
    assert found.restitution == pytest.approx(data.qvel[2] / 0.1, rel=0.002)


def test_a_pyramid_without_friction():
    """MuJoCo takes a coefficient of 1e-5 in place of 0."""
    both = 'friction="0" solimp=".9 .9 .001"'
    model = made(cone="pyramidal", floor=both, ball=both)
    data = mujoco.MjData(model)
    data.qpos[2] -= 1e-9
    mujoco.mj_forward(model, data)
    (found,) = mr.inspect_contacts(model)
    stiffness, _, impedance, _ = data.efc_KBIP[0]
    assert found.k == pytest.approx((1 / data.efc_R[:4]).sum() * stiffness * impedance, rel=1e-4)


def test_the_default_of_mujoco():
    """Its damping ratio of 1 is that of the contact in motion, whatever the mass: e = exp(-2)."""
    for mass in ("2", "2000"):
        text = MODEL.format(h=1e-6, cone="elliptic", impratio=1, flags="", floor="", ball="", pair="")
        (found,) = mr.inspect_contacts(mujoco.MjSpec.from_string(text.replace('mass="2"', f'mass="{mass}"')))
        assert found.restitution == pytest.approx(np.exp(-2), rel=1e-3)
        assert found.frequency == pytest.approx(0.9 / (0.95 * 0.02), rel=1e-3)
        assert found.k == pytest.approx(float(mass) * 9 * 0.9 / (0.95 * 0.02) ** 2, rel=1e-6)


def test_a_ball_on_uneven_ground_can_have_several_points():
    text = """<mujoco><asset><hfield name="hill" nrow="3" ncol="3" size="1 1 .1 .1"/></asset><worldbody>
    <geom name="hill" type="hfield" hfield="hill"/><body pos="0 0 1"><freejoint/><geom size=".1" mass="2"/></body>
    </worldbody></mujoco>"""
    (found,) = mr.inspect_contacts(mujoco.MjModel.from_xml_string(text))
    assert found.mass == pytest.approx(2.0)
    assert any("uneven" in note for note in found.notes)


def test_a_box_can_have_several_points():
    text = MODEL.format(h=1e-3, cone="elliptic", impratio=1, flags="", floor="", ball='type="box"', pair="")
    model = mujoco.MjModel.from_xml_string(text.replace('size=".1" ', 'size=".1 .1 .1" '))
    assert mr.inspect_contacts(model)[0].points == 4
    (found,) = mr.inspect_contacts(model, contacts=1)
    assert any("several points" in note for note in found.notes)


def test_the_points_share_the_mass():
    """e of a flat landing is that of four points, and of a ball that of one."""
    for text, geom, points in ((FLAT_BOX, "box", 4), (ON_A_PLANE, "ball", 1)):
        contact, model = made_for(text, geom, "floor", restitution=0.5, contacts=points)
        (found,) = mr.inspect_contacts(model, contacts=4)
        assert (found.points, found.mass) == (points, pytest.approx(2.0))
        assert found.restitution == pytest.approx(0.5, rel=1e-3)
        assert found.frequency == pytest.approx(contact.frequency, rel=1e-3)
        assert mr.inspect_contacts(model)[0].points == points
        (single,) = mr.inspect_contacts(model, contacts=1)
        assert single.restitution == pytest.approx(0.69 if points == 4 else 0.5, abs=0.003)
        assert any("contacts=None counts them" in note for note in single.notes) == (points == 4)
    for wrong, error in ((0, ValueError), (51, ValueError), (1.5, (TypeError, ValueError))):
        with pytest.raises(error, match="contacts"):
            mr.inspect_contacts(model, contacts=wrong)


@pytest.mark.parametrize(("stretch", "is_long"), [(0.9, False), (1.1, True)])
def test_a_dashpot_that_throws_back_is_told(stretch, is_long):
    """Centred in the step it leaves (1 - x / 2) / (1 + x / 2) of the speed, x = c h / m, and throws back beyond 2."""
    h = 1e-4
    c, k = stretch * 2 * 2 / h, 1e5
    d = 0.5 * h * c * 0.5 / (1 + 0.5 * h * c * 0.5)
    both = f'solref="{-(1 - d) * 0.5 * k} {-(1 - d) * 0.5 * c}" solimp="{d} {d} .001" condim="1"'
    (found,) = mr.inspect_contacts(made(h=h, floor=both, ball=both))
    assert found.inertia == pytest.approx(0, abs=1e-9)
    assert any("the rebound can be another" in note for note in found.notes) == is_long
    assert not any("gain" in note for note in found.notes)


@pytest.mark.parametrize("integrator", ["Euler", "RK4"])
@pytest.mark.parametrize("xi", [0.05, 0.5])
def test_it_reads_back_what_contact_for_has_written(xi, integrator):
    spec = mujoco.MjSpec.from_string(
        MODEL.format(h=1e-5, cone="pyramidal", impratio=1, flags="", floor="", ball="", pair="")
    )
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    contact = mr.contact_for(spec, "ball", "floor", k=1e6, xi=xi)
    contact.apply(spec)
    (found,) = mr.inspect_contacts(spec)
    assert (found.geom1, found.geom2, found.explicit) == ("floor", "ball", True)
    assert (found.k, found.c) == (pytest.approx(1e6), pytest.approx(contact.c))
    assert found.xi == pytest.approx(xi, rel=1e-4)
    assert found.frequency == pytest.approx(contact.frequency, rel=1e-4)
    assert found.notes == ()


CROWD = """<mujoco><option><flag {flags}/></option><worldbody>
<geom name="floor" type="plane" size="5 5 .1"/><geom name="wall" type="plane" size="1 1 1"/>
<geom name="post" size="9"/>
<body name="arm"><joint/><geom name="upper" pos=".3 0 0" size="9"/>
  <body name="hand" pos="0 0 .2"><joint/><geom name="palm" pos=".2 0 0" size="9"/>
    <body name="finger"><geom name="tip" pos=".1 0 0" size="9"/></body></body></body>
<body name="dust" pos="0 0 3"><freejoint/><geom name="dust" size="9" contype="2" conaffinity="4"/></body>
<body name="grit" pos="0 0 4"><freejoint/><geom name="grit" size="9" contype="4" conaffinity="0"/></body>
<body name="sand" pos="0 0 5"><freejoint/><geom name="sand" size="9"/></body>
</worldbody><contact><exclude body1="hand" body2="world"/><exclude body1="sand" body2="arm"/>
<pair geom1="grit" geom2="floor"/></contact></mujoco>"""


@pytest.mark.parametrize("flags", ["", 'filterparent="disable"'])
def test_the_candidates_are_those_of_the_engine(flags):
    """Not: static ones, one body, parent and child, excluded bodies, types that do not match, listed pairs."""
    model = mujoco.MjModel.from_xml_string(CROWD.format(flags=flags))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    made = {frozenset(model.geom(int(geom)).name for geom in contact.geom) for contact in data.contact}
    found = mr.inspect_contacts(model)
    assert {frozenset((contact.geom1, contact.geom2)) for contact in found} == made
    assert len(found) == len(made) == (15 if flags else 13)
    assert [contact.explicit for contact in found[:2]] == [True, False]
    assert len(mr.inspect_contacts(model, candidates=False)) == 1


def test_a_contact_without_a_spring():
    """A dashpot alone stops everything, and a contact with neither stops nothing. MuJoCo takes both."""
    for dashpot, xi, e in ((-5, np.inf, 0.0), (0, 0.0, 1.0)):
        both = f'solref="0 {dashpot}"'
        (found,) = mr.inspect_contacts(made(floor=both, ball=both))
        assert (found.k, found.xi, found.restitution) == (0.0, xi, e)


def test_a_contact_without_an_approach_has_no_restitution():
    """A body on a level slide above a plane."""
    text = """<mujoco><worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 .1"><joint type="slide" axis="1 0 0"/>
    <geom size=".1"/></body></worldbody></mujoco>"""
    (found,) = mr.inspect_contacts(mujoco.MjModel.from_xml_string(text))
    assert (found.mass, found.k > 0) == (np.inf, True)
    assert np.isnan(found.xi)
    assert np.isnan(found.restitution)


@pytest.mark.parametrize(
    ("changed", "complaint"),
    [
        pytest.param(
            *({"ball": 'margin=".01"', "floor": 'margin=".02"'}, "begins at a distance of 0.03 m"), marks=since(3, 9)
        ),
        pytest.param(*({"ball": 'adhesion="3"'}, "pulls with up to 3 N"), marks=since(3, 11)),
        ({}, "impratio = 1 is small"),
        ({"cone": "pyramidal"}, "the cone is pyramidal"),
        pytest.param(*({"flags": 'diagexact="enable"'}, "diagexact"), marks=since(3, 9)),
    ],
)
def test_its_notes(changed, complaint):
    (found,) = mr.inspect_contacts(made(**changed))
    assert any(complaint in note for note in found.notes)


def test_the_override_takes_the_place_of_every_contact():
    model = made(flags='override="enable"', ball='solref="-1e5 -100"')
    model.opt.o_solref[:2], model.opt.o_solimp[:3] = (-1e4, -10), (0.5, 0.5, 0.001)
    (found,) = mr.inspect_contacts(model)
    assert (found.k, found.c) == (pytest.approx(1e4 / 0.25 * 0.25 / 0.5 * 2 / 0.5 * 0.5), pytest.approx(10 / 0.5 * 2))


@pytest.mark.parametrize("height", [0.3, 0.7])
def test_bodies_that_a_rigid_constraint_holds_cannot_approach(height):
    """What the constraint leaves of their freedom is rounding, of either sign or none."""
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="1e-4"/><worldbody><geom name="wall" type="box" pos="1 0 {height}" size=".1 1 1"/>
        <body><joint axis="0 1 0"/><geom size=".05" mass="1"/><body pos=".3 0 {height}"><joint axis="0 1 0"/>
        <geom size=".05" mass="1.3"/><body name="tip" pos=".3 0 .1"><joint axis="0 1 0"/><geom size=".05" mass=".7"/>
        </body></body></body></worldbody><equality><connect body1="tip" anchor="0 0 0" body2="world" solref="2e-3 1"/>
        </equality></mujoco>"""
    )
    found = mr.inspect_contacts(model)
    assert [contact.mass for contact in found] == [np.inf] * 3
    assert all("cannot approach each other" in " ".join(contact.notes) for contact in found)


def test_friction_is_opposite_to_the_slip_that_it_leaves():
    """A weight of which one direction is free of rounding only, as of a fish that lies in its plane of symmetry."""
    weight = np.array([[171.7, -46.1, 0.0], [-46.1, 44.1, 0.0], [6.6e-34, -6.8e-34, 2177.1]])
    _, first, second = impulse = _slipping_impulse(weight, 1.0)
    slip = weight[1:] @ impulse
    assert np.hypot(first, second) == pytest.approx(1)
    assert -(slip @ (first, second)) == pytest.approx(np.linalg.norm(slip))
