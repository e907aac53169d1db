"""What contacts of MuJoCo models may not depend on: where and how a model stands, its order and its units."""

import functools
import math

import mujoco
import numpy as np
import pytest
from everyday import crossed

from mjrock.contacts import contact_for, measure, stiffest_contacts

G, STEP, SPEED = 9.81, 2e-4, 2.0
REQUESTS = {
    "depth under a load": {"depth": 1e-4, "load": 300.0},
    "whole face": {"k_face": 1e6},
}
UNTURNED = np.array((1.0, 0.0, 0.0, 0.0))


def text(numbers):
    return " ".join(repr(float(each)) for each in numbers)


def model_of(*, turn=UNTURNED, shift=(0.0, 0.0, 0.0), length=1.0, mass=1.0, mirror=1.0, floor_first=True, others=False):
    """A box 30 mm over the top of a fixed box, with gravity, in another place, turn, unit of length or of mass."""

    def placed(*at):
        return text(length * (turned(turn, (at[0], mirror * at[1], at[2])) + shift))

    quat = text(turn)
    sizes = [text(length * np.array(size)) for size in ((0.5, 0.4, 0.1), (0.15, 0.1, 0.05))]
    body = f"""<body pos="{placed(0.05, 0.03, 0.18)}" quat="{quat}"><freejoint/>
      <geom name="box" type="box" size="{sizes[1]}" mass="{3.0 * mass!r}"/></body>"""
    floor = f'<body pos="{placed(0, 0, 0)}" quat="{quat}"><geom name="floor" type="box" size="{sizes[0]}"/></body>'
    ball = f'<body pos="{placed(5, 0, 0)}"><freejoint/><geom size="{0.1 * length!r}" mass="{mass!r}"/></body>'
    bodies = [floor, body] if floor_first else [body, floor]
    gravity = text(length * turned(turn, (0.0, 0.0, -G)))
    return mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="{STEP}" gravity="{gravity}"/>
        <worldbody>{ball if others else ""}{"".join(bodies)}</worldbody></mujoco>"""
    )


def turned(quat, vector):
    result = np.zeros(3)
    mujoco.mju_rotVecQuat(result, np.array(vector), np.array(quat))
    return result


def in_units(request, length, mass):
    """A request in other units of length and mass. The second remains, so that N/m are as the unit of mass."""
    factors = {"k_face": mass, "depth": length, "load": mass * length}
    return {key: value * factors[key] for key, value in request.items()}


def found_of(request, *, swapped=False, length=1.0, mass=1.0, **how):
    """Restitution, depth, force, friction and creep found and promised, in metres and kilograms."""
    spec = model_of(length=length, mass=mass, **how)
    geoms = ("floor", "box") if swapped else ("box", "floor")
    requested = in_units(request, length, mass) | {"restitution": 0.6, "friction": 0.5}
    contact = contact_for(spec, *geoms, speed=SPEED * length, **requested)
    contact.apply(spec)
    found = measure(spec, *geoms, speed=SPEED * length, duration=0.05)
    force = mass * length
    return np.array(
        [
            contact.k / mass,
            *found.restitution,
            *np.array(found.depth) / length,
            *np.array(found.force) / force,
            found.friction / force,
            *np.array(found.creep) / length,
        ]
    )


ASLANT = np.array((0.8, 0.36, 0.48, 0.0))
"""A turn by 74 degrees about a horizontal axis."""
SAME = {
    "far": {"shift": (300.0, -200.0, 40.0)},
    "turned": {"turn": ASLANT},
    "turned about the normal": {"turn": np.array((math.cos(0.4), 0.0, 0.0, math.sin(0.4)))},
    "mirrored": {"mirror": -1.0},
    "swapped": {"swapped": True},
    "another order": {"floor_first": False},
    "beside others": {"others": True},
    "in millimetres": {"length": 1e3},
    "in tonnes": {"mass": 1e-3},
    "in centimetres and grams": {"length": 1e2, "mass": 1e3},
}


@functools.cache
def found_as_drawn(name):
    return found_of(REQUESTS[name])


@pytest.mark.parametrize(("name", "how"), crossed(list(REQUESTS), list(SAME)))
def test_a_measured_contact(name, how):
    np.testing.assert_allclose(found_of(REQUESTS[name], **SAME[how]), found_as_drawn(name), rtol=2e-4)


@pytest.mark.parametrize("how", SAME.values(), ids=SAME)
def test_the_stiffest_contacts(how):
    how = dict(how)
    length, mass = how.get("length", 1.0), how.get("mass", 1.0)
    geoms = ("floor", "box") if how.pop("swapped", False) else ("box", "floor")
    found = [(each.k / mass, each.depth / length) for each in stiffest_contacts(model_of(**how), *geoms)]
    expected = [(each.k, each.depth) for each in stiffest_contacts(model_of(), "box", "floor")]
    np.testing.assert_allclose(found, expected, rtol=1e-6)
