"""Scenes of two geoms, and the measurement of a rebound, for the tests of contacts in any model."""

import mujoco
import numpy as np
import pytest

import mjrock as mr

VERSION = tuple(int(part) for part in mujoco.__version__.split(".")[:2])
"""Of MuJoCo."""


def since(major, minor):
    """The mark of a test for which older versions of MuJoCo lack something."""
    return pytest.mark.skipif((major, minor) > VERSION, reason=f"MuJoCo {major}.{minor} or newer")


FLOOR = '<geom name="floor" type="plane" size="5 5 .1"/>'
BALL = '<body name="ball" pos="0 0 .1"><freejoint/><geom name="ball" size=".1" mass="2"/></body>'
OTHER = '<body name="other" pos="0 0 -.3"><freejoint/><geom name="other" size=".3" mass="5"/></body>'
BOX = """<body name="box" pos="0 0 .1" quat="{quat}"><freejoint/>
<geom name="box" type="box" size=".2 .3 .1" mass="2"/></body>"""


def scene(*things, timestep=1e-5, gravity=0.0, options="", pair=""):
    return (
        f'<mujoco><option timestep="{timestep}" gravity="0 0 {-gravity}" {options}/>'
        f"<worldbody>{''.join(things)}</worldbody><contact>{pair}</contact></mujoco>"
    )


ON_A_PLANE = scene(FLOOR, BALL)
TWO_BALLS = scene(BALL, OTHER)
FLAT_BOX = scene(FLOOR, BOX.format(quat="1 0 0 0"))
SCENES = {
    "a ball on a plane": (ON_A_PLANE, "ball", "floor", 1, 2.0),
    "two free balls": (TWO_BALLS, "ball", "other", 1, 10 / 7),
    "a box on four corners": (FLAT_BOX, "box", "floor", 4, 0.5),
}
"""Text, geoms, contact points, and mass that a contact point stops."""


def made_for(text, geom1, geom2, **requested):
    """The contact, and a compiled model that has it and nothing that spoils it."""
    spec = mujoco.MjSpec.from_string(text)
    contact = mr.contact_for(spec, geom1, geom2, **{"k": 1e6, "contacts": 1} | requested)
    contact.apply(spec)
    model = spec.compile()
    assert contact.caveats(model) == ()
    return contact, model


def rebound(contact, model, slide=0.0, phase=0.5, direction=(0, 0, 1), at=None):
    """Relative speed after the contact over that before. The first body moves down by 1 m/s.

    Args:
        contact, model: what is measured.
        slide: horizontal speed of the first body.
        phase: where in a step the touch falls.
        direction, at: a point of the first body, at which the speeds are taken; its centre by default.
    """
    data = mujoco.MjData(model)
    data.qpos[2] += (3 + phase) * model.opt.timestep
    data.qvel[0], data.qvel[2] = slide, -1.0
    touched = False
    for _ in range(20 + int(60 * max(1, contact.xi) / (contact.frequency * model.opt.timestep))):
        mujoco.mj_step(model, data)
        pressed = data.nefc > 0 and data.efc_force[: data.nefc].max() > 0
        touched |= pressed
        if touched and not pressed:
            break
    assert touched
    assert not pressed
    speed = np.array(data.qvel[:3])
    if at is not None:
        rotation = data.xmat[1].reshape(3, 3)
        speed += np.cross(rotation @ data.qvel[3:6], at - model.qpos0[:3])
    other = data.qvel[6:9] if model.nv > 6 else np.zeros(3)
    return float((speed - other) @ direction), data
