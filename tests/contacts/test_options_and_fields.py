"""What the options of a model and the fields of a pair do to a contact: the solver, flags, margin, gap and adhesion."""

import itertools
import math
import re
import warnings

import mujoco
import numpy as np
import pytest
from everyday import among
from pairs import BALL, FLOOR, scene, since

import mjrock as mr
from mjrock.contacts.notes import FLAG_EFFECTS, SolverNeed, few_iterations, model_caveats

BOXES = "".join(
    f'<body pos="0 0 {0.05 + 0.1 * i}"><freejoint/>'
    f'<geom name="box{i}" type="box" size="{0.1 - 0.001 * i} {0.07 - 0.001 * i} .05" mass="1.3"/></body>'
    for i in range(5)
)
NAMES = ["floor", *(f"box{i}" for i in range(5))]
PLATE = '<geom name="frame" type="box" size=".02 .3 .3" pos="-.02 0 .5" {}/>'
DOOR = """<body pos=".02 0 .5"><joint type="slide" axis="1 0 0"/>
<geom name="door" type="box" size=".02 .3 .3" mass="2" {}/></body>"""


def few(solver="Newton", iterations=3):
    options = f'iterations="{iterations}" ls_iterations="5" solver="{solver}"'
    return mujoco.MjSpec.from_string(scene(FLOOR, BOXES, timestep=5e-4, gravity=9.81, options=options))


def stacked(spec):
    joint = {"k": 2.5e4, "xi": 0.5, "friction": 0.6}
    return mr.contacts_for(spec, {(above, below): joint for below, above in itertools.pairwise(NAMES)})


@since(3, 4)
def test_a_solver_with_few_iterations_is_told_what_the_contacts_need():
    """With three iterations the stack flies apart; with what is written each joint gives way by the weight above it."""
    with pytest.warns(mr.ContactWarning, match=r"needs iterations = \d+ and ls_iterations = 50 .* the model has 3 and"):
        contacts = stacked(spec := few())
    with pytest.warns(mr.ContactWarning, match="the model has 3 and 5"):
        contacts.apply(spec)
    assert "apply(model, iterations=True)" in contacts.caveats(spec)[0]
    contacts.apply(spec, iterations=True)
    assert contacts.caveats(spec) == ()
    data = mujoco.MjData(model := spec.compile())
    data.qvel[0] = 0.3
    mujoco.mj_step(model, data, 2000)
    depth = -np.diff([0, *(data.qpos.reshape(-1, 7)[:, 2] - 0.05 - 0.1 * np.arange(5))])
    assert depth == pytest.approx(1.3 * 9.81 * np.arange(5, 0, -1) / 1e5, rel=0.01)  # what is left moves on after 1 s


def test_a_single_body_is_content_with_few_iterations():
    ball = scene(FLOOR, BALL, timestep=1e-4, gravity=9.81, options='iterations="4"')
    mr.contact_for(mujoco.MjSpec.from_string(ball), "ball", "floor", k=1e5, restitution=0.5)


@since(4, 0)
@pytest.mark.parametrize("solver", among(["PGS", "CG"], "CG"))
def test_a_solver_that_does_not_converge_is_given_a_smaller_impratio_and_creeps_as_said(solver):
    """On a slope of 10 degrees the lowest joint holds g sin(a) of five boxes, and its points have the mass of one."""
    with pytest.warns(
        mr.ContactWarning, match=f"the solver {solver} does not converge .* in 100 iterations; with impr"
    ):
        contacts = stacked(spec := few(solver, 100))
    contacts.apply(spec, iterations=True)
    model = spec.compile()
    (message,) = contacts.caveats(spec)
    assert model.opt.impratio == contacts.contacts[0].needs.impratio < contacts.impratio / 10
    (rate,) = map(float, re.findall(r"creeps at F / \((\S+) 1/s m\)", message))
    model.opt.gravity[:] = 9.81 * math.sin(math.radians(10)), 0, -9.81 * math.cos(math.radians(10))
    data, most = mujoco.MjData(model), 0
    for _ in range(2000):
        mujoco.mj_step(model, data)
        most = max(most, int(data.solver_niter.max()))
    assert most < model.opt.iterations
    assert data.qvel[0] == pytest.approx(5 * 9.81 * math.sin(math.radians(10)) / rate, rel=0.02)  # 2 digits are said


def test_a_solver_without_friction_is_given_nothing():
    sentences = list(few_iterations(few("PGS", 100).compile().opt, SolverNeed(converges=False)))
    assert sentences == [
        "the solver PGS does not converge with this contact in 100 iterations, and with no smaller impratio; take "
        "Newton, or a smaller ratio of masses"
    ]


def test_every_flag_of_mujoco_is_judged():
    """It fails when MuJoCo adds a flag: say in `notes` what that does to a contact."""
    names = {name for kind in (mujoco.mjtEnableBit, mujoco.mjtDisableBit) for name in kind.__members__}
    assert {name for name in names if "_" in name} <= {f"mj{name}" for name in FLAG_EFFECTS}
    model = mujoco.MjModel.from_xml_string(scene(FLOOR, BALL))
    assert list(model_caveats(model)) == []
    model.opt.enableflags |= 1 << 20
    model.opt.disableflags |= 1 << 25
    assert [text[:22] for text in model_caveats(model)] == ["mjtEnableBit 1048576 i", "mjtDisableBit 33554432"]


@since(4, 0)
def test_speculative_contacts_are_told():
    spec = mujoco.MjSpec.from_string(scene(FLOOR, BALL, options='><flag speculative="enable"/></option><option'))
    with pytest.warns(mr.ContactWarning, match="the speculative flag is set"):
        mr.contact_for(spec, "ball", "floor", k=1e6, restitution=0.5)


@since(3, 5)
def test_a_body_that_begins_asleep_in_touch_is_read():
    asleep = BALL.replace('name="ball" pos="0 0 .1"', 'pos="0 0 .0999" sleep="init"')
    other = BALL.replace("ball", "other").replace("0 0 .1", "1 0 .1")
    text = scene(FLOOR, asleep, other, options='><flag sleep="enable"/></option><option')
    spec = mujoco.MjSpec.from_string(text)
    assert len(mr.inspect_contacts(spec)) == 3
    with pytest.warns(mr.ContactWarning, match="the sleep flag is set"):
        mr.contact_for(spec, "other", "floor", k=1e6, restitution=0.5)


@pytest.mark.parametrize("on_geoms", [False, True])
def test_a_margin_is_told_and_taken_away(on_geoms):
    """The ball rests at its weight over k, not a centimetre above the floor."""
    text = scene(FLOOR.replace("/>", ' margin=".01"/>'), BALL, timestep=2e-4, gravity=9.81, options='cone="elliptic"')
    text = text.replace("<worldbody>", '<default><pair margin=".02"/></default><worldbody>')
    spec = mujoco.MjSpec.from_string(text)
    with pytest.warns(mr.ContactWarning, match=r"a margin of 0.01 m, at which the spring begins; apply writes"):
        contact = mr.contact_for(spec, "ball", "floor", k=1e5, xi=1.0)
    target = spec.compile() if on_geoms else spec
    contact.apply(target, on_geoms=on_geoms)
    assert not any("margin" in caveat for caveat in contact.caveats(target))
    model = target if on_geoms else target.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 2000)
    assert data.qpos[2] == pytest.approx(0.1 - 2 * 9.81 / 1e5, abs=1e-8)
    pasted = mujoco.MjModel.from_xml_string(text.replace("</mujoco>", contact.xml + "</mujoco>"))
    assert pasted.pair_margin[0] == 0


def pull_off(model):
    """Force at which the door comes off [N]."""
    data = mujoco.MjData(model)
    while data.qpos[0] < 0.01 and data.time < 5:
        data.qfrc_applied[0] = 20 * data.time
        mujoco.mj_step(model, data)
    return float(data.qfrc_applied[0])


@since(3, 11)
@pytest.mark.parametrize("on_geoms", [False, True])
def test_adhesion_and_gap_are_carried(on_geoms):
    """Four points with 5 + 5 N each: the latch holds 40 N, whatever the stiffness."""
    text = scene(PLATE.format('adhesion="5" gap=".002"'), DOOR.format('adhesion="5"'), timestep=5e-4,
                 options='cone="elliptic"')  # fmt: skip
    spec = mujoco.MjSpec.from_string(text)
    target = spec.compile() if on_geoms else spec
    with pytest.warns(mr.ContactWarning, match=r"an adhesion of 10 N a point, with which .* within 0.002 m"):
        contact = mr.contact_for(target, "door", "frame", k=1e4, xi=1.0)
    contact.apply(target, on_geoms=on_geoms)
    late = 20 * (6 * 2 * 0.01 / 20) ** (1 / 3)  # the force grows by 20 N/s while 2 kg move by 1 cm
    assert 40 < pull_off(target if on_geoms else spec.compile()) < 40 + late + 0.1


@since(3, 11)
def test_the_higher_priority_decides_on_adhesion():
    text = scene(PLATE.format('adhesion="3" priority="1"'), DOOR.format('adhesion="5"'))
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[0] = -1e-5
    mujoco.mj_forward(model, data)
    assert set(data.contact.adhesion.tolist()) == {3.0}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert mr.contact_for(model, "door", "frame", k=1e4, xi=1.0).adhesion == 3.0
