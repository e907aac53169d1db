"""A contact from heights of bounces and times of contact, and from Hertz."""

import math

import mujoco
import numpy as np
import pytest
from pairs import BALL, FLOOR, scene
from scipy.integrate import solve_ivp

import mjrock as mr


def test_what_mujoco_bounced_is_found_again():
    """Three bounces of a ball of 2 kg on 1e5 N/m with e = 0.6, measured as a camera and a contact switch would."""
    h = 2e-5
    spec = mujoco.MjSpec.from_string(scene(FLOOR, BALL.replace("0 0 .1", "0 0 .6"), timestep=h, gravity=9.81))
    made = mr.contact_for(spec, "ball", "floor", k=1e5, restitution=0.6, speed=math.sqrt(2 * 9.81 * 0.5))
    made.apply(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    heights, pressed, before = [0.5], 0, 0.0
    while len(heights) < 2:
        mujoco.mj_step(model, data)
        pressed += bool(data.efc_force.max(initial=0) > 0)
        if before > 0 >= data.qvel[2]:
            heights.append(float(data.qpos[2]) - 0.1)
        before = data.qvel[2]
    found = mr.measured_contact(heights, mass=2.0, contact_times=[pressed * h])
    assert found.restitution == pytest.approx(0.6, abs=2e-3)
    assert found.k == pytest.approx(1e5, rel=0.01)
    assert found.xi == pytest.approx(made.xi, rel=0.01)
    assert (found.restitution_interval, found.k_interval) == ((0.0, 1.0), (0.0, math.inf))


def test_the_intervals_hold_what_they_say():
    """95 of 100 intervals of e hold the true value, of drops whose bounces scatter."""
    rng = np.random.default_rng(1)
    held = 0
    for _ in range(400):
        drops = [[1.0, 1.0 * (0.7 + 0.03 * rng.normal()) ** 2] for _ in range(5)]
        low, high = mr.measured_contact(drops).restitution_interval
        held += low <= 0.7 <= high
    assert held / 400 == pytest.approx(0.95, abs=0.03)
    found = mr.measured_contact([[1.0, 0.49, 0.24], [1.1, 0.53]], mass=1.0, contact_times=[9e-3, 1e-2, 1.1e-2])
    assert (found.bounces, found.times) == (3, 3)
    assert found.k_interval[0] < found.k < found.k_interval[1]
    narrow = mr.measured_contact([[1.0, 0.49, 0.24], [1.1, 0.53]], confidence=0.5)
    assert narrow.restitution_interval[0] > found.restitution_interval[0]
    assert narrow.k is None


@pytest.mark.parametrize(("mass", "speed"), [(1.0, 1.0), (0.02, 3.0)])
def test_hertz_lasts_as_long(mass, speed):
    """Steel on steel, 20 mm: the time of Hertz's contact in SciPy is pi / omega of the linear one."""
    k = mr.hertz_stiffness(0.02, 2.1e11, 0.3, other=(2.1e11, 0.3), mass=mass, speed=speed)
    K = 4 / 3 * math.sqrt(0.02) * 2.1e11 / (2 * (1 - 0.09))

    def out(t, y):
        return y[0] + (1.0 if t < 1e-12 else 0.0)

    out.terminal, out.direction = True, -1
    scale = math.sqrt(mass / k)
    solved = solve_ivp(
        lambda t, y: (y[1], -K / mass * max(y[0], 0) ** 1.5), (0, 10 * scale), (0.0, speed), events=out, rtol=1e-10,
        atol=1e-16, max_step=scale / 50,
    )  # fmt: skip
    assert solved.t[-1] == pytest.approx(math.pi * scale, rel=1e-3)


def test_hertz_sinks_in_as_far():
    k = mr.hertz_stiffness(0.05, 5e6, 0.48, force=30.0)
    K = 4 / 3 * math.sqrt(0.05) * 5e6 / (1 - 0.48**2)
    assert 30.0 / k == pytest.approx((30.0 / K) ** (2 / 3))


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: mr.measured_contact([1.0]), "heights of a drop are .* at least one bounce"),
        (lambda: mr.measured_contact([1.0, 1.2]), "heights = .* no bounce higher than the one before"),
        (lambda: mr.measured_contact(np.array(0.5)), r"heights has the shape \(\); a row of at least one height"),
        (lambda: mr.measured_contact([1.0, 0.0]), "heights = .* positive"),
        (lambda: mr.measured_contact([1.0, 0.5], contact_times=[0.01]), "contact_times are given without mass"),
        (lambda: mr.measured_contact([1.0, 0.5], mass=1.0, contact_times=[-0.01]), "contact_times hold -0.01"),
        (lambda: mr.measured_contact([1.0, 0.5], confidence=1.0), "confidence = 1 is outside"),
        (lambda: mr.hertz_stiffness(0.1, 1e9, 0.6, force=1.0), "nu = 0.6 is outside the valid range -1 to 0.5"),
        (lambda: mr.hertz_stiffness(0.1, 1e9, 0.3), "give the force, or mass and speed"),
        (lambda: mr.hertz_stiffness(0.1, 1e9, 0.3, force=1.0, mass=1.0, speed=1.0), "give the force, or mass"),
        (lambda: mr.hertz_stiffness(0.1, 1e9, 0.3, mass=1.0), "give the force, or mass and speed"),
        (
            lambda: mr.hertz_stiffness(0.1, 1e9, 0.3, other=3.0, force=1.0),
            "other = 3.0 of type float has to be Young's modulus",
        ),
    ],
)
def test_what_cannot_be_is_refused(call, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        call()
