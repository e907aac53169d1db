"""`measure` finds what closed forms say, and shows where a model does not keep what its numbers promise."""

import math
import subprocess
import sys

import mujoco
import numpy as np
import pytest
from pairs import BALL, BOX, FLOOR, scene

import mjrock.contacts as package
from mjrock.contacts import contact_for, measure, rebound_damping, rebound_restitution

G = 9.81
ARM = """<body pos="0 0 .3"><joint name="hinge" axis="0 1 0"/><geom size=".01" mass=".1" contype="0" conaffinity="0"/>
<geom name="tip" size=".05" pos=".4 0 {z}" mass="1"/></body>"""


def model_with(body, geom, timestep=2e-4, options="", **requested):
    spec = mujoco.MjSpec.from_string(scene(FLOOR, body, timestep=timestep, gravity=G, options=options))
    contact_for(spec, geom, "floor", **{"depth": 1e-4, "restitution": 0.5, "friction": 0.8} | requested).apply(spec)
    return spec.compile()


@pytest.mark.parametrize("height", [0.1, 0.7])
@pytest.mark.parametrize(("body", "geom"), [(BOX.format(quat="1 0 0 0"), "box"), (BALL, "ball")])
def test_a_free_body_on_a_floor(body, geom, height):
    """2 kg, 0.1 mm deep, e = .5 without gravity; friction of F creeps at F / (1e7 m)."""
    model = model_with(body.replace("0 0 .1", f"0 0 {height}"), geom)
    found = measure(model, geom, "floor", speed=3.0, duration=0.2)
    assert found.restitution.promised == pytest.approx(0.5, abs=0.02)  # gravity takes some
    assert found.restitution.found == pytest.approx(found.restitution.promised, abs=0.01)
    assert found.depth == pytest.approx((1e-4, 1e-4), rel=1e-4)
    assert found.force == pytest.approx((2 * G, 2 * G), rel=1e-6)
    assert found.creep == pytest.approx([found.friction / (1e7 * 2.0)] * 2, rel=0.02)
    assert found.friction == pytest.approx(0.4 * 2 * G * (1.0 if geom == "box" else 2 / 7), rel=0.02)  # a ball rolls


def test_the_order_of_the_geoms_does_not_matter_and_the_model_stays():
    model = model_with(BALL, "ball")
    before = model.pair_solref.copy(), model.qpos0.copy(), model.opt.timestep
    one, other = (measure(model, *names, duration=0.2) for names in (("ball", "floor"), ("floor", "ball")))
    for name in ("restitution", "depth", "force", "creep"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-6)
    assert np.array_equal(model.pair_solref, before[0])
    assert np.array_equal(model.qpos0, before[1])
    assert model.opt.timestep == before[2]


def test_the_tip_of_an_arm_is_swung_down_to_the_floor():
    """What stops is its inertia about the hinge over the square of the lever arm where it lands, 0.25 m below."""
    model = model_with(ARM.format(z=0.1), "tip", friction=0, depth=None, k=1e5)
    found = measure(model, "tip", "floor", speed=3.0, duration=0.2)
    arm, inertia = 0.4**2 + 0.1**2 - 0.25**2, 0.4**2 + 0.1**2 + 0.4 * 0.05**2
    xi = found.contact.c / (2 * math.sqrt(1e5 * inertia / arm))
    assert found.restitution == pytest.approx([rebound_restitution(xi)] * 2, abs=0.02)
    high = model_with(ARM.format(z=0.1).replace("0 0 .3", "0 0 .9"), "tip", friction=0, depth=None, k=1e5, mass=1.0)
    with pytest.raises(ValueError, match=r"the joints do not bring geom1 and geom2 = .* together from qpos0"):
        measure(high, "tip", "floor")


def test_what_a_longer_step_spoils_is_found():
    """Promised is what the numbers in the model would do at a short step."""
    model = model_with(BALL, "ball", friction=0, restitution=0.95)
    model.opt.timestep = 5e-3
    found = measure(model, "ball", "floor", duration=0.3)
    assert abs(found.restitution.found - found.restitution.promised) > 0.05


def test_the_pyramidal_cone_promises_no_creep():
    model = model_with(BALL, "ball")
    model.opt.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    found = measure(model, "ball", "floor", duration=0.1)
    assert math.isnan(found.creep.promised)
    assert str(found).splitlines()[-1].endswith("-")


@pytest.mark.parametrize(
    ("requested", "complaint"),
    [({"speed": 0.0}, "speed = 0 m/s is outside"), ({"duration": -1.0}, "duration = -1 s is")],
)
def test_what_cannot_be_is_refused(requested, complaint):
    with pytest.raises(ValueError, match=complaint):
        measure(mujoco.MjModel.from_xml_string(scene(FLOOR, BALL)), "ball", "floor", **requested)


def test_the_command_prints_the_table(tmp_path):
    path = tmp_path / "model.xml"
    text = scene(FLOOR, BALL, timestep=5e-4, gravity=G)
    path.write_text(text.replace("<contact>", contact_text(text)).replace("</contact></contact>", "</contact>"))
    line = [sys.executable, "-W", "error", "-m", package.__name__, "measure", str(path), "ball", "floor"]
    done = subprocess.run([*line, "--duration", "0.1"], capture_output=True, text=True, check=True)
    assert [text.split()[0] for text in done.stdout.splitlines()] == ["ball", "restitution", "depth", "force", "creep"]


@pytest.mark.slow
def test_the_command_draws(tmp_path):
    pytest.importorskip("matplotlib")
    path, picture = tmp_path / "model.xml", tmp_path / "blow.png"
    path.write_text(scene(FLOOR, BALL, timestep=5e-4, gravity=G))
    line = [sys.executable, "-m", package.__name__, "measure", str(path), "ball", "floor", "--picture", str(picture)]
    subprocess.run([*line, "--duration", "0.1"], check=True)
    assert picture.read_bytes().startswith(b"\x89PNG")


def contact_text(text):
    """The options and the pair of a contact, up to where the other pairs begin."""
    contact = contact_for(mujoco.MjModel.from_xml_string(text), "ball", "floor", k=2e4, xi=rebound_damping(0.6))
    return contact.xml.rstrip()
