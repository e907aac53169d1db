"""Limit analysis with constant effects, of blocks that only wedging holds, of loads at any angle, and in torsion."""

import itertools
import math

import numpy as np
import pytest
from everyday import among, slow

import mjrock as mr

THICK, HIGH = 0.5, 2.0
BOTH = pytest.mark.parametrize("in_space", [False, True], ids=["plane", "space"])
IN_EACH = pytest.mark.parametrize(
    ("in_space", "associated"),
    [(False, True), (False, False), (True, True), slow((True, False))],
    ids=["plane", "plane without dilatancy", "space", "space without dilatancy"],
)


def wall(in_space, friction=2.0, **more):
    """A block on the ground that turns about its toe."""
    blocks = [
        mr.Polygon([(-3, -1), (3, -1), (3, 0), (-3, 0)], fixed=True, name="ground"),
        mr.Polygon([(0, 0), (THICK, 0), (THICK, HIGH), (0, HIGH)], name="wall"),
    ]
    if in_space:
        blocks = [mr.Polyhedron.prism(block) for block in blocks]
    return mr.Masonry(blocks, friction=friction, **more)


def at(in_space, x, z, **values):
    """Where an effect acts on the wall: at x from its left face and a height."""
    if in_space:
        return {"at": (x, 0.0, z), "block": "wall"} | values
    return {"height": z, "block": "wall"} | values


def offset(in_space, x):
    """How far a place is from the middle of the wall, which is part of a point in space."""
    return {} if in_space else {"offset": x - 0.5 * THICK}


@IN_EACH
def test_constant_loads_thrusts_and_masses_stand_beside_the_force_that_grows(in_space, associated):
    """Moments about the toe at x = THICK, with the weight W: a load P turns back, a thrust T on, a mass both ways."""
    masonry = wall(in_space)
    weight, lever = masonry.blocks[1].mass * mr.GRAVITY, 0.5 * THICK
    load, thrust, mass = 0.7 * weight, 0.1 * weight, 0.4 * masonry.blocks[1].mass

    def found(*effects):
        return mr.collapse_multiplier(masonry, 1, associated=associated, effects=effects).multiplier

    down = mr.Load(load, **at(in_space, 0.1, HIGH), **offset(in_space, 0.1))
    out = mr.Thrust(force=thrust, **at(in_space, 0.2, 1.5))
    top = mr.AddedMass(mass, **at(in_space, 0.15, 1.8), **offset(in_space, 0.15))
    held, turned = weight * lever, weight * 0.5 * HIGH
    assert found() == pytest.approx(held / turned)
    assert found(down) == pytest.approx((held + load * (THICK - 0.1)) / turned)
    assert found(out) == pytest.approx((held - thrust * 1.5) / turned)
    added = mass * mr.GRAVITY
    assert found(top) == pytest.approx((held + added * (THICK - 0.15)) / (turned + added * 1.8))
    together = (held + load * (THICK - 0.1) - thrust * 1.5 + added * (THICK - 0.15)) / (turned + added * 1.8)
    assert found(down, out, top) == pytest.approx(together)


@BOTH
def test_a_constant_load_stands_beside_loads_that_grow(in_space):
    masonry = wall(in_space, friction=0.3)
    weight = masonry.blocks[1].mass * mr.GRAVITY
    sideways = {"wall": (0.01 * weight, 0.0, 0.0) if in_space else (0.01 * weight, 0.0)}
    down = mr.Load(weight, **at(in_space, 0.5 * THICK, HIGH))
    one = mr.collapse_multiplier(masonry, None, loads=sideways, effects=down)
    # it turns before it slides: (W + P) b / 2 over h / 2
    assert 0.01 * one.multiplier == pytest.approx(min(2 * 0.5 * THICK / (0.5 * HIGH), 0.3 * 2))
    assert one.forces.normal[0] == pytest.approx(2 * weight)


def tie_of(in_space, z, strength, **more):
    """A tie of the wall at a height to an anchor 3 m behind it."""
    place = {"at": (0.0, 0.0, z), "anchor": (-3.0, 0.0, z)} if in_space else {"height": z, "length": 3.0}
    return mr.Tie(stiffness=1e7, strength=strength, ultimate=0.1, block="wall", **place | more)


@IN_EACH
def test_ties_hold_up_to_their_strength_and_what_they_pull_is_said(in_space, associated):
    """Outwards they yield at (W b / 2 + sum T z) / (W h / 2); inwards they are slack; a third of a thrust is held."""
    masonry = wall(in_space)
    weight = masonry.blocks[1].mass * mr.GRAVITY
    held, turned = weight * 0.5 * THICK, weight * 0.5 * HIGH
    ties = tie_of(in_space, 1.5, 0.1 * weight), tie_of(in_space, 1.9, 0.05 * weight)
    out = mr.collapse_multiplier(masonry, 1, associated=associated, effects=ties)
    assert out.multiplier == pytest.approx((held + weight * (0.1 * 1.5 + 0.05 * 1.9)) / turned)
    assert out.pulls == pytest.approx([0.1 * weight, 0.05 * weight])
    inwards = mr.collapse_multiplier(masonry, -1, associated=associated, effects=ties)
    assert inwards.multiplier == pytest.approx(held / turned)
    assert inwards.pulls == pytest.approx([0.0, 0.0], abs=1e-6 * weight)
    thrust = mr.Thrust(force=0.3 * weight, **at(in_space, 0.2, 1.5))  # without the tie the wall would fall
    strong = tie_of(in_space, 1.5, 0.2 * weight)
    both = mr.collapse_multiplier(masonry, 1, associated=associated, effects=[thrust, strong])
    assert both.multiplier == pytest.approx((held + weight * (0.2 - 0.3) * 1.5) / turned)
    with pytest.raises(ValueError, match="wall would fall under the weight and the effects"):
        mr.collapse_multiplier(masonry, 1, associated=associated, effects=[thrust, tie_of(in_space, 1.5, 0.1 * weight)])


@pytest.mark.parametrize("associated", [True, False])
@pytest.mark.parametrize("strength", [0.1, math.inf])
def test_a_tie_between_blocks_pulls_on_both(strength, associated):
    """The wall on the ground beside a wide block. A tie that never yields makes both slide and turn as they may."""
    wide = mr.Polygon([(-5, 0), (-1, 0), (-1, HIGH), (-5, HIGH)], name="wide")
    masonry = mr.Masonry([*wall(False).blocks, wide], friction=0.9)
    weight = masonry.blocks[1].mass * mr.GRAVITY
    tie = mr.Tie(
        height=1.5, stiffness=1e7, strength=strength * weight, length=1.0, block="wall", anchor_block="wide",
        ultimate=None if strength == math.inf else 0.1,
    )  # fmt: skip
    found = mr.collapse_multiplier(masonry, 1, associated=associated, effects=tie)
    yields = (0.5 * THICK + 0.1 * 1.5) / (0.5 * HIGH)
    if strength == 0.1:
        assert found.multiplier == pytest.approx(yields)
        assert found.moving == ("wall",)
    else:
        assert yields < found.multiplier <= 0.9 + 1e-9


def test_effects_that_are_no_constant_forces_and_what_falls_under_them_are_refused():
    masonry = wall(False)
    weight = masonry.blocks[1].mass * mr.GRAVITY
    damper = mr.Damper(height=1.0, c=1e4, length=3.0, block=1)
    with pytest.raises(TypeError, match=r"effects\[1\] is a Damper, whose force depends on the motion; .* and Tie"):
        mr.collapse_multiplier(masonry, effects=[mr.Load(1.0, HIGH, block=1), damper])
    with pytest.raises(ValueError, match=r"effects\[0\], slack = 0.02 m: the tie holds nothing as the masonry begins"):
        mr.collapse_multiplier(masonry, effects=tie_of(False, 1.0, 1e4, slack=0.02))
    with pytest.raises(ValueError, match="wall would fall under the weight and the effects"):
        mr.collapse_multiplier(masonry, effects=mr.Thrust(height=HIGH, force=0.2 * weight, block=1))
    with pytest.raises(ValueError, match=r"effects\[0\], block = 'roof' is no block"):
        mr.collapse_multiplier(masonry, effects=mr.Load(1.0, HIGH, block="roof"))


@IN_EACH
def test_a_block_that_only_wedging_holds_is_named(in_space, associated):
    """Between two upright cheeks nothing presses on it; beside it a block stands on the ground."""
    sides = {"left": (0, 1, 0, 2), "middle": (1, 2, 0.5, 1.5), "right": (2, 3, 0, 2), "other": (1.2, 1.8, 1.5, 2.5)}
    blocks = [
        mr.Polygon([(a, c), (b, c), (b, d), (a, d)], fixed=name in ("left", "right"), name=name)
        for name, (a, b, c, d) in sides.items()
    ]
    if in_space:
        blocks = [mr.Polyhedron.prism(block) for block in blocks]
    masonry = mr.Masonry(blocks, friction=0.8, k_n=1e9)
    with pytest.warns(mr.Implausible, match="middle, other would stand only by wedging"):
        found = mr.collapse_multiplier(masonry, associated=associated)
    assert found.wedged == ("middle", "other")
    assert mr.collapse_multiplier(wall(in_space), associated=associated).wedged == ()


@pytest.mark.parametrize(
    ("degrees", "associated"),
    among(list(itertools.product([0.0, 11.25, 22.5, 57.0, 200.0], [True, False])), (11.25, True), (57.0, False)),
)
def test_a_load_alone_slides_at_the_whole_friction_in_any_direction(degrees, associated):
    masonry = mr.Masonry.box((0.5, 0.8, 0.3), friction=0.37)
    weight, turn = masonry.blocks[masonry.free[0]].mass * mr.GRAVITY, math.radians(degrees)
    load = weight * np.array([math.cos(turn), math.sin(turn), 0.0])
    found = mr.collapse_multiplier(masonry, None, loads={"block": load}, associated=associated)
    assert found.multiplier == pytest.approx(0.37, rel=1e-9)


def test_a_face_that_bears_no_torsion_without_dilatancy_is_named():
    """The corners bear sqrt(1/2) mu N a, whichever the number of points; a point in the middle nothing."""
    twist = {"block": (0.0, 0.0, 0.0, 0.0, 0.0, 1.0)}
    for points, share in ((2, math.sqrt(0.5)), (3, 0.0)):
        masonry = mr.Masonry.box((1.0, 1.0, 0.2), friction=0.4, points=points)
        most = 0.4 * masonry.blocks[masonry.free[0]].mass * mr.GRAVITY
        assert mr.collapse_multiplier(masonry, None, loads=twist).multiplier == pytest.approx(math.sqrt(0.5) * most)
        if share:
            found = mr.collapse_multiplier(masonry, None, loads=twist, associated=False)
        else:
            with pytest.warns(mr.Implausible, match=r"multiplier = 0: ground\|block turn about their normals without"):
                found = mr.collapse_multiplier(masonry, None, loads=twist, associated=False)
        assert found.multiplier == pytest.approx(share * most, abs=1e-6 * most)
