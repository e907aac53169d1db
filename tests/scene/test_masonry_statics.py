"""Masonry that just stands: limits of equilibrium, of rigid blocks and of the compliant scene."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import scipy
from everyday import among, slow
from masonry_blocks import GROUND, box, bracket, columns, tilted
from scenes import unbalanced

import mjrock as mr
from mjrock.problem.masonry.blocks import polyhedron
from mjrock.problem.masonry.effects import applied
from mjrock.problem.masonry.limit.statics import falling, friction_lacking, nudged
from mjrock.scene.masonry import require_standing, scene_of_masonry
from scripts.studies import two_storeys


def rigid(masonry):
    return not falling(masonry)


def settles(masonry):
    try:
        return scene_of_masonry(masonry).at_rest is not None
    except ValueError:
        return False


def test_a_stack_overturns_at_its_slenderness():
    """Rigid blocks: tan = b/h of the whole. Corner springs take the rotation at which the edge lifts, W / (2 k b)."""
    slope = 0.3 / 2.1
    turned = bracket(lambda a: rigid(tilted(columns(4), a)), 0.141884, 0.141910, 0)
    assert math.tan(turned) == pytest.approx(slope, rel=1e-4)
    lifts = 2000 * 0.6 * 4.2 * mr.GRAVITY / (2 * 5e8 * 0.3 * 0.3)
    found = math.tan(bracket(lambda a: settles(tilted(columns(1), a)), 0.1413, 0.1414, 3))
    assert found == pytest.approx(slope - lifts, abs=2e-5)


def test_an_arch_of_the_least_thickness():
    """A semicircular arch under its weight stands from t/R = 0.1075 on (Milankovitch); 64 voussoirs are near that."""

    def stands(thickness):
        return rigid(mr.Masonry.arch(5.0, thickness, math.pi, 64, friction=2.0))

    assert bracket(lambda x: stands(-x), -0.5384, -0.5366, 0) / -5 == pytest.approx(0.1075, abs=2e-4)


@pytest.mark.slow
def test_springs_hardly_change_the_least_thickness():
    """Sixteen voussoirs: 0.1071 of rigid blocks, and a thousandth more on springs of 1e10 N/m3."""

    def arch(thickness):
        return mr.Masonry.arch(5.0, thickness, math.pi, 16, friction=2.0, k_n=1e10)

    least = bracket(lambda x: rigid(arch(-x)), -0.9, -0.3, 12)
    soft = bracket(lambda x: settles(arch(-x)), -0.56, -0.5, 8)
    assert 1e-4 < soft / least - 1 < 2e-3


def test_an_arch_tilts_to_its_multiplier():
    """Part of a circle of 157.5 degrees, t/R = 0.15, seven voussoirs: 0.37 g (Oppenheim 1992)."""
    arch = mr.Masonry.arch(10.0, 1.5, math.radians(157.5), 7)
    assert math.tan(bracket(lambda a: rigid(tilted(arch, a)), 0.35, 0.3585, 0)) == pytest.approx(0.37, abs=0.005)
    assert math.tan(bracket(lambda a: settles(tilted(arch, a)), 0.3563, 0.3577, 0)) == pytest.approx(0.373, abs=1e-3)


def test_a_block_slides_down_at_its_friction():
    flat = mr.Masonry([GROUND, box(-1, 1, 0, 0.4)], friction=0.25)
    assert math.tan(bracket(lambda a: rigid(tilted(flat, a)), 0.24478, 0.24518, 0)) == pytest.approx(0.25, rel=1e-3)


def test_blocks_that_fall_are_named():
    post = box(-0.3, 0.3, 0, 1, name="post")
    blocks = [GROUND, post, box(0.0, 1, 1, 1.4, name="cap"), box(0.0, 1, 1.4, 1.5, name="tile")]
    with pytest.raises(ValueError, match="the masonry cannot stand: cap, tile would fall under the weight"):
        mr.simulate(mr.MasonryCase(mr.Masonry(blocks), 1.0))
    assert falling(mr.Masonry([GROUND, post])) == ()


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_a_block_that_may_slide_does_not_fall_with_those_that_nothing_carries(friction, in_space):
    """The mechanism of least power may have any slip of a block on level ground without friction."""
    floating = [box(2, 2.5, 3, 3.5, name="floats"), box(2, 2.5, 3.5, 4, name="on it")]
    blocks = [GROUND, box(0, 0.5, 0, 1, name="stands"), *floating]
    made = [mr.Polyhedron.prism(block) for block in blocks] if in_space else blocks
    assert falling(mr.Masonry(made, friction=friction)) == ("floats", "on it")


def test_the_weight_of_an_added_mass_holds_a_block_down():
    """A cap of 1040 kg turns about the edge of its post by a lever of 0.05 m; what is on its tail has 0.6 m."""
    blocks = [GROUND, box(-0.3, 0.3, 0, 1, name="post"), box(-0.3, 1.0, 1, 1.4, name="cap")]
    masonry, enough = mr.Masonry(blocks), 1040 * 0.05 / 0.6
    assert falling(masonry) == ("cap",)
    for share, falls in ((0.95, ("cap",)), (1.05, ())):
        tail = mr.AddedMass(share * enough, 1.4, -0.65, block=2)
        assert falling(masonry, applied(masonry, (tail,))) == falls


def test_springs_too_soft_to_stand_on():
    """The weight's lever grows faster than the base resists: K_rot < W h."""
    with pytest.raises(ValueError, match="on joints of this stiffness block_0 would fall; raise k_n"):
        require_standing(columns(1, k_n=1e6))


@pytest.mark.parametrize("k_n", among([5e8, 1e10], 5e8))
def test_a_stack_without_friction_is_not_told_to_be_stiffer(k_n):
    """Of two level joints one has friction: the upper block slides, and no stiffness keeps it."""
    masonry = columns(2, k_n, friction=lambda joint: 0.7 if "ground" in joint.name else 0.0)
    complaint = r"nothing keeps block_1 from sliding, however large k_n is; .* above 0: block_0\|block_1$"
    with pytest.raises(ValueError, match=complaint):
        require_standing(masonry)
    require_standing(columns(2, k_n, friction=1e-3))


@pytest.mark.parametrize("k_n", among([1e6, 1e10], 1e6))
def test_a_keystone_without_thrust_is_not_told_to_be_stiffer(k_n):
    """Between upright jambs friction would hold it if they were pushed together, and limit analysis says so. The search
    alone finds no rest, and the message does not say more than that."""
    jambs = [box(-2, -0.5, -1, 1, fixed=True, name="left"), box(0.5, 2, -1, 1, fixed=True, name="right")]
    masonry = mr.Masonry([*jambs, box(-0.5, 0.5, 0, 0.4, name="key")], k_n=k_n)
    assert falling(masonry) == ()
    with pytest.raises(
        ValueError, match=r"^no pose of rest was found: key would slide.*limit analysis finds.*press"
    ) as caught:
        require_standing(masonry)
    assert not re.search(r"raise k_n|however large", str(caught.value))


def test_a_brick_that_hangs_over_by_half_tips_and_one_at_the_angle_of_friction_slides():
    """Rigid blocks stand at these limits alone, and neither is held by wedging."""
    low = box(0, 0.4, 0, 0.2, name="low")
    for over, complaint in ((0.2, "top would tip, .* more to stand on"), (0.21, "top would fall under the weight$")):
        bricks = mr.Masonry([GROUND, low, box(over, over + 0.4, 0.2, 0.4, name="top")], friction=0.5, k_n=1e9)
        with pytest.raises(ValueError, match=complaint):
            require_standing(bricks)
    require_standing(mr.Masonry([GROUND, low, box(0.199, 0.599, 0.2, 0.4, name="top")], friction=0.5, k_n=1e9))
    slope = tilted(mr.Masonry([GROUND, box(-0.5, 0.5, 0, 0.2)], friction=math.tan(0.2) * (1 + 1e-9)), 0.2)
    assert nudged(slope)[1]
    assert nudged(mr.Masonry.arch(5.0, 0.9)) is None


def test_a_wall_beside_a_smooth_one_on_a_soft_base_is_told_to_be_stiffer():
    """Joints without friction that nothing slides on are not to blame."""
    wall = mr.Block.from_size(0.6, 4.2)
    masonry = mr.Masonry.stack([wall], 1e6, side_stop=True, side_friction=0.0, friction=0.7, frequency=10.0)
    with pytest.raises(ValueError, match="would fall; raise k_n"):
        require_standing(masonry)


def test_friction_that_is_lacking():
    """A slope of 0.25, a block pushed by a fifth of its weight, and an arch whose springings alone are too smooth."""
    flat = mr.Masonry([GROUND, box(-1, 1, 0, 0.4)], friction=0.1)
    (name,) = (joint.name for joint in flat.joints)
    assert friction_lacking(tilted(flat, math.atan(0.2502))) == (pytest.approx(0.251), (name,))
    thrust = mr.Thrust(0.2, 0.2 * flat.blocks[1].mass * mr.GRAVITY, block=1)
    with pytest.raises(
        ValueError, match=rf"block_1 would fall under the weight; .* friction of 0\.2.*: {re.escape(name)}$"
    ):
        require_standing(flat, (thrust,))
    smooth = mr.Masonry.arch(5.0, 0.75, voussoirs=9, friction=0.3)
    least, names = friction_lacking(smooth)
    assert names == ("left_abutment|voussoir_0", "right_abutment|voussoir_8")
    assert falling(mr.Masonry.arch(5.0, 0.75, voussoirs=9, friction=least - 0.002))
    assert falling(mr.Masonry.arch(5.0, 0.75, voussoirs=9, friction=least)) == ()
    post = [GROUND, box(-0.3, 0.3, 0, 1), box(0.0, 1, 1, 1.4)]
    assert friction_lacking(mr.Masonry(post)) is None


def test_what_settles_is_in_equilibrium():
    """Springs carry the weight of an arch, and symmetric abutments half of it each."""
    masonry = mr.Masonry.arch(5.0, 0.75, voussoirs=16, points=3)
    scene = scene_of_masonry(masonry)
    pressed = scene.contacts.k * scene.bears
    turned = scene.contacts.normal * pressed[:, None]
    left = np.array([name.startswith("left") for name in scene.contacts.group])
    right = np.array([name.startswith("right") for name in scene.contacts.group])
    weight = scene.bodies.mass.sum() * mr.GRAVITY
    assert turned[left, 1].sum() == pytest.approx(weight / 2, rel=1e-4)  # the springings are level
    assert turned[right, 1].sum() == pytest.approx(weight / 2, rel=1e-4)
    assert scene.at_rest[:, 0] == pytest.approx(-scene.at_rest[::-1, 0], abs=1e-8)


@pytest.mark.parametrize("k_n", [1e10, 1e11])
def test_an_arch_leaves_the_pose_in_which_its_keystone_only_balances(k_n):
    """Five voussoirs hinge about four points, and the middle one turns about two of them until it touches."""
    scene = scene_of_masonry(mr.Masonry.arch(5.0, 0.56, math.pi, 5, k_n=k_n, friction=2.0))
    weight = mr.GRAVITY * scene.bodies.mass.max()
    assert np.abs(scene.at_rest).max() < 20 * weight / scene.contacts.k.min()
    assert np.abs(unbalanced(scene)[0]).max() < 1e-9 * weight
    assert unbalanced(scene)[1].max() < 1e-9 * weight


def test_a_soft_arch_settles():
    """Its symmetric pose carries the weight and does not stand, and its points slip."""
    scene = scene_of_masonry(mr.Masonry.arch(5.0, 0.75, voussoirs=17, k_n=3e7))
    weight = mr.GRAVITY * scene.bodies.mass.max()
    assert np.abs(unbalanced(scene)[0]).max() < 1e-9 * weight
    assert unbalanced(scene)[1].max() < 1e-9 * weight


@pytest.mark.parametrize(
    ("height", "storeys", "gap"), [(2.4, 1, 0.0), (3.2, 1, 0.002), slow((6.4, 2, 0.0)), slow((6.4, 2, 0.002))]
)
def test_a_wall_with_openings_settles(height, storeys, gap, monkeypatch):
    """Open or closed head joints: with open ones nothing but friction holds a unit along its course."""
    monkeypatch.setattr(two_storeys, "OPEN", gap)
    openings = (two_storeys.Opening(2.0, 3.2, 0.0, 2.2), two_storeys.Opening(2.0, 3.2, 4.0, 5.2))[:storeys]
    scene = scene_of_masonry(two_storeys.wall(replace(two_storeys.QUICK, length=5.2, height=height, openings=openings)))
    missing, beyond = unbalanced(scene)
    assert np.abs(missing).max() < 1e-9 * mr.GRAVITY * scene.bodies.mass.max()
    assert beyond.max() < 1e-9 * mr.GRAVITY * scene.bodies.mass.max()
    assert np.abs(scene.at_rest).max() < 0.01


def test_what_is_found_at_rest_stands_without_a_linear_programme(monkeypatch):
    """By the safe theorem: joints push, friction is within its limit, and nothing is unbalanced. Nor is a hull sought
    for blocks of the plane."""

    def refused(*_):
        raise AssertionError

    monkeypatch.setattr(scipy.optimize, "linprog", refused)
    monkeypatch.setattr(polyhedron, "hull_of", refused)
    for masonry in (mr.Masonry.running_bond(2.0, 1.0, (0.5, 0.25), k_s=1e10), mr.Masonry.arch(5.0, 0.8, k_s=1e10)):
        assert mr.solve_explicit(mr.MasonryCase(masonry, 1e-3)).stats["steps"] > 1
