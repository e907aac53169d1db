"""The page on contacts for any model says what is so: its example runs, and its figures are those of the formulas."""

import math
import re
import textwrap
from pathlib import Path

import mujoco
import pytest
from pairs import BALL, FLOOR, ON_A_PLANE, rebound, scene

import mjrock as mr
from mjrock.contacts.rebound import falling_rebound, rebound_damping, rebound_restitution

PAGE = (Path(__file__).parents[2] / "docs" / "contacts_in_your_model.md").read_text(encoding="utf-8")
SENTENCES = " ".join(PAGE.split())
"""The page without its line breaks."""


def test_the_example_runs_and_does_what_it_says():
    code, *_ = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert len([line for line in code.splitlines() if line]) <= 12
    names: dict[str, object] = {}
    exec(code, names)
    model = names["model"]
    data = mujoco.MjData(model)
    speeds = [0.0]
    while len(speeds) < 3 or speeds[-2] < 0 or speeds[-1] > speeds[-2]:
        mujoco.mj_step(model, data)
        speeds.append(float(data.qvel[2]))
    assert max(speeds) / -min(speeds) == pytest.approx(0.5, rel=0.01)
    mujoco.mj_step(model, data, 15000)
    assert 0.1 - data.qpos[2] == pytest.approx(2 * 9.81 / 1e5, rel=1e-3)


def indented(start):
    """The lines of an indented block of the page, from the one that begins so."""
    (block,) = re.findall(rf"^    {re.escape(start)}.*\n(?:    .*\n)*", PAGE, re.MULTILINE)
    return textwrap.dedent(block)


@pytest.mark.filterwarnings("ignore")
def test_its_lines_for_gymnasium_make_contacts_of_the_feet():
    """MuJoCo then has them in N/m, with the restitution, as the ant lies on its feet after 5 s."""
    gymnasium = pytest.importorskip("gymnasium")
    pytest.importorskip("imageio")
    names = {"gymnasium": gymnasium, "contacts_for": mr.contacts_for}
    exec(indented("model = gymnasium"), names)
    model, ankles = names["model"], names["contacts"]
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 5000)
    feet = [contact for contact in data.contact if "ankle" in model.geom(contact.geom[1]).name]
    assert feet
    for contact in feet:
        assert contact.solref == pytest.approx(ankles.contacts[0].solref)
    found = {each.geom2: each for each in mr.inspect_contacts(model) if "ankle" in each.geom2 and each.geom1 == "floor"}
    assert [each.k for each in found.values()] == pytest.approx([5e3] * 4)
    assert [each.restitution for each in found.values()] == pytest.approx([0.2] * 4, abs=1e-3)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("engine", ["mujoco.mjx", "mujoco_warp"])
def test_its_lines_for_mjx_and_warp_keep_the_restitution(engine):
    """On a processor, of a ball that comes with 1 m/s from 1 mm: as MuJoCo rebounds, to single precision."""
    mjx = pytest.importorskip(engine)
    text = scene(FLOOR, BALL.replace("0 0 .1", "0 0 .101"), timestep=2e-4, gravity=9.81, options='iterations="3"')
    names = {"mjx": mjx, "contact_for": mr.contact_for, "spec": mujoco.MjSpec.from_string(text)}
    exec(indented("contact_for(spec"), names)
    model, batch = names["spec"].compile(), names["batch"]
    data = mujoco.MjData(model)
    data.qvel[2] = -1.0
    made, speeds = mjx.put_data(model, data), []
    step = pytest.importorskip("jax").jit(mjx.step) if engine == "mujoco.mjx" else mjx.step
    for _ in range(150):
        made = step(batch, made) or made
        mujoco.mj_step(model, data)
        speeds.append((float(made.qvel[2] if engine == "mujoco.mjx" else made.qvel.numpy()[0, 2]), data.qvel[2]))
    found, right = (max(each) for each in zip(*speeds, strict=True))
    assert found == pytest.approx(right, rel=1e-4)
    assert right == pytest.approx(0.489, abs=1e-3)


def test_its_figures():
    assert "0.372 instead of 0.451 at $\\xi$ = 0.3" in SENTENCES
    assert rebound_restitution(0.3) == pytest.approx(0.451, abs=5e-4)
    assert math.exp(-math.pi * 0.3 / math.sqrt(0.91)) == pytest.approx(0.372, abs=5e-4)
    assert rebound_damping(1e-3) == pytest.approx(16, abs=0.5)
    assert "0.58\\, e \\xi \\omega h" in PAGE
    assert 2 / math.sqrt(12) == pytest.approx(0.58, abs=5e-3)


def test_its_table_of_gravity():
    rows = [row.strip("|").split("|") for row in PAGE.splitlines() if row.startswith("| 0.")]
    assert len(rows) == 5
    for requested, *left in rows:
        for pull, e in zip((0.009, 0.054, 0.085), left, strict=True):
            assert falling_rebound(rebound_damping(float(requested)), pull).restitution == pytest.approx(
                float(e), abs=2e-3
            )


def test_its_two_lines_measure_e():
    code, *_ = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    lines = [line.strip() for line in PAGE.splitlines() if line.startswith(("    model.opt.grav", "    while data"))]
    names: dict[str, object] = {}
    exec("\n".join([code.replace("0 0 .5", "0 0 .1005"), *lines]), names)
    assert names["data"].qvel[2] == pytest.approx(0.5, rel=0.01)


def test_the_pyramidal_cone_gains_what_it_says():
    assert "k = 1e5 N/m and h = 0.1 ms on 2 kg the same contact rebounds with up to 1.04." in SENTENCES
    spec = mujoco.MjSpec.from_string(ON_A_PLANE)
    contact = mr.contact_for(spec, "ball", "floor", k=1e5, restitution=0.5, friction=0.3, timestep=1e-4)
    contact.apply(spec)
    model = spec.compile()
    model.opt.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    assert rebound(contact, model, phase=0.05)[0] == pytest.approx(1.04, abs=0.005)
    assert any("can gain energy" in caveat for caveat in contact.caveats(model))
    assert any("the rebound can be another, and it can gain energy" in note for note in inspected(model).notes)
    model.opt.impratio = 1
    (caveat,) = (caveat for caveat in contact.caveats(model) if "pyramidal" in caveat)
    assert "20.4 times as large" in caveat
    assert "gain" not in caveat


def test_the_inertia_of_the_row_is_counted():
    """Undamped in short steps the row has more inertia than asked for. The pyramid multiplies it too: no gain."""
    spec = mujoco.MjSpec.from_string(ON_A_PLANE)
    contact = mr.contact_for(spec, "ball", "floor", k=1e5, restitution=1.0, friction=0.5, timestep=1e-5)
    contact.apply(spec)
    model = spec.compile()
    model.opt.cone, model.opt.impratio = mujoco.mjtCone.mjCONE_PYRAMIDAL, 1e7
    assert inspected(model).frequency * 1e-5 == pytest.approx(0.224, abs=0.001)
    assert rebound(contact, model, phase=0.05)[0] < 1.005
    assert not any("gain" in caveat for caveat in contact.caveats(model))
    assert not any("is long" in note for note in inspected(model).notes)


def test_a_contact_for_a_step_that_resolves_nothing_is_not_said_to_gain():
    spec = mujoco.MjSpec.from_string(ON_A_PLANE)
    with pytest.warns(UserWarning, match="does not resolve"):
        contact = mr.contact_for(spec, "ball", "floor", k=1e6, restitution=1.0, timestep=5e-3)
    contact.apply(spec)
    (note,) = inspected(spec.compile()).notes
    assert "omega h = 0.96: e leaves out the step, and the rebound can be another; " in note


@pytest.mark.slow
def test_the_cost_of_impratio():
    """Iterations of the solver in a step, of three boxes of which the top one slides, and of a single one."""
    assert "1.1 iterations in a step instead of 1.0; 1e8 takes 1.4 and 1e10 takes 5.5." in SENTENCES
    iterations = [_iterations(3, impratio) for impratio in (1, None, 1e8)]
    assert iterations == pytest.approx([1.0, 1.1, 1.4], abs=0.06)
    assert _iterations(3, 1e10) > 3
    assert _iterations(1, None) < _iterations(1, 1)


def _iterations(boxes, impratio):
    bodies = "".join(
        f"""<body pos="0 0 {0.1 + 0.2 * i}"><freejoint/>
        <geom name="box{i}" type="box" size="{0.2 - 0.001 * i} {0.3 - 0.001 * i} .1" mass="2"/></body>"""
        for i in range(boxes)
    )
    spec = mujoco.MjSpec.from_string(scene(FLOOR, bodies, gravity=9.81, timestep=1e-4))
    below = "floor"
    for i in range(boxes):
        mr.contact_for(spec, f"box{i}", below, k=2.5e5, restitution=0.5, contacts=4, friction=0.5).apply(spec)
        below = f"box{i}"
    model = spec.compile()
    assert model.opt.impratio == pytest.approx(7.3e5, rel=0.02)
    model.opt.impratio = impratio or model.opt.impratio
    data = mujoco.MjData(model)
    data.qvel[6 * (boxes - 1)] = 0.5
    count = 0
    for _ in range(3000):
        mujoco.mj_step(model, data)
        count += int(data.solver_niter[0])
    return count / 3000


def inspected(model):
    (found,) = mr.inspect_contacts(model)
    return found


def test_its_table_is_what_the_script_prints():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><geom name="floor" type="plane" size="5 5 .1"/><body pos="0 0 .1"><freejoint/>
        <geom name="ball" size=".1" mass="2"/></body></worldbody></mujoco>"""
    )
    (found,) = mr.inspect_contacts(model)
    figures = found.k, found.c, found.mass, found.points, found.restitution
    (line,) = re.findall(r"^ +floor  ball  (.*)$", PAGE, re.MULTILINE)
    printed = [float(word) for word in line.split()[:-1]]
    assert printed == pytest.approx(figures, rel=4e-3)
