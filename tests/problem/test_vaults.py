"""Arches on piers, bridges and barrel vaults: their blocks and joints, and where they stand."""

import math

import numpy as np
import pytest

import mjrock as mr

ARCH = {"radius": 3.0, "thickness": 0.45, "voussoirs": 20}


def stands(masonry):
    """Whether limit analysis finds forces in balance with the weight."""
    try:
        return mr.collapse_multiplier(masonry).multiplier > 0
    except ValueError:
        return False


def least_width(height, density=2000.0):
    """Width of a buttress that an arch just does not overturn [m], by hand.

    The least thrust passes the crown at its outer face and the inner corner of one joint of the haunch. With it half of
    the arch and the buttress turn about the outer toe.
    """
    inner, outer = 3.0 - 0.225, 3.0 + 0.225
    step = math.pi / 20
    angles = 0.5 * step + step * np.arange(10)  # of the middles of half of the voussoirs from the crown
    area = 0.5 * math.sin(step) * (outer**2 - inner**2)  # voussoirs have straight edges
    arm = 2 / 3 * math.cos(0.5 * step) * (outer**3 - inner**3) / (outer**2 - inner**2)
    weights, places = np.full(10, area), arm * np.sin(angles)
    thrusts = []
    for k in range(1, 11):
        x, z = inner * math.sin(k * step), inner * math.cos(k * step)
        thrusts.append((weights[:k] * (x - places[:k])).sum() / (outer - z))
    thrust = max(thrusts)

    def moment(width):
        """About the toe, of the buttress and of half of the arch against the thrust."""
        return 0.5 * width**2 * height + (weights * (inner + width - places)).sum() - thrust * (height + outer)

    low, high = 0.0, 10.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if moment(middle) > 0 else (middle, high)
    return high


@pytest.mark.parametrize("height", [2.0, 5.0])
def test_a_buttress_stands_from_the_width_of_statics_on(height):
    """Half a per cent wider stands, half a per cent narrower does not."""
    width = least_width(height)
    for factor, wanted in ((1.005, True), (0.995, False)):
        arch = mr.Masonry.bridge(**ARCH, pier_width=factor * width, pier_height=height, abutments=False, friction=5.0)
        assert stands(arch) == wanted, (factor, width)


def test_a_bridge_of_three_spans():
    bridge = mr.Masonry.bridge(
        radius=4.0, thickness=0.5, span_angle=2.4, voussoirs=13, spans=3, pier_width=1.5, pier_height=3.0
    )
    assert len(bridge.blocks) == 1 + 2 + 3 * 13 + 2
    assert len(bridge.joints) == 3 * 14 + 2  # two ends of each arch and what is between, and the feet of two piers
    names = {joint.name for joint in bridge.joints}
    assert {"ground|pier_1", "pier_1|span_1_voussoir_0", "left_abutment|span_0_voussoir_0"} <= names
    np.testing.assert_allclose([j.width for j in bridge.joints if "voussoir" in j.name], 0.5, rtol=1e-9)
    assert stands(bridge)
    answer = mr.solve_explicit(mr.MasonryCase(bridge, 0.1), forces=True, output_step=0.05)
    weight = sum(bridge.blocks[i].mass for i in bridge.free) * mr.GRAVITY
    total = sum(force[-1] for force in answer.reactions.values())
    np.testing.assert_allclose(total, [0.0, weight], rtol=1e-3, atol=1e-3 * weight)


def test_a_wide_pier_is_needed_between_two_springings():
    with pytest.raises(ValueError, match=r"pier_width = 0.8 m is outside the valid range 0.9"):
        mr.Masonry.bridge(**ARCH, spans=2, pier_width=0.8, pier_height=1.0)


def test_a_barrel_vault_has_the_weight_of_its_arch_and_stands():
    vault = mr.Masonry.barrel_vault(2.0, 0.4, length=3.0, unit=1.0, span_angle=2.8, courses=9)
    arch = mr.Masonry.arch(2.0, 0.4, 2.8, 9, length=3.0)
    assert sum(b.mass for b in vault.blocks if not b.fixed) == pytest.approx(
        sum(b.mass for b in arch.blocks if not b.fixed), rel=1e-9
    )
    assert len(vault.free) == 5 * 3 + 4 * 4
    heads = [joint for joint in vault.joints if abs(joint.normal[1]) > 0.9]
    assert len(heads) == 5 * 2 + 4 * 3
    assert (
        len(vault.joints) - len(heads) == 8 * 6 + 2 * 3
    )  # bed joints are half a unit long or a whole one at the abutments
    assert stands(vault)
    one = mr.collapse_multiplier(arch).multiplier
    assert mr.collapse_multiplier(vault, direction=(1.0, 0.0)).multiplier == pytest.approx(one, rel=1e-6)


GROIN = {"radius": 2.0, "thickness": 0.3, "length": 4.4, "unit": 0.8, "span_angle": 2.4}


def volume_of_webs(courses):
    """Volume of four webs of `GROIN` between their groins and the sides of the bay [m3], by closed form.

    A course of the area A in the section, whose centroid is at x, has the volume A (length / 2 - |x|). A voussoir is
    the difference of two triangles with their apex at the centre.
    """
    inner, outer, d = 1.85, 2.15, 2.4 / courses
    angles = (np.arange(courses) - 0.5 * (courses - 1)) * d
    area = 0.5 * math.sin(d) * (outer**2 - inner**2)
    moments = math.sin(d) * math.cos(d / 2) / 3 * (outer**3 - inner**3) * np.abs(np.sin(angles))
    if courses % 2:  # half of the one at the crown is on either side
        moments[courses // 2] = math.sin(d / 2) ** 2 * math.cos(d / 2) / 3 * (outer**3 - inner**3)
    return 4 * (courses * area * 2.2 - moments.sum())


@pytest.mark.parametrize("cut", [False, True])
@pytest.mark.parametrize(("courses", "heads"), [(9, (0, 0, 0, 1, 2, 1, 0, 0, 0)), (4, (0, 1, 1, 0))])
def test_a_groin_vault_has_the_joints_and_the_weight_of_its_webs(cut, courses, heads):
    """Heads by hand, from the side in units of 0.8 m, in every other course by half of one, up to 0.2 m before a groin.

    A bed between two courses with n and m heads, none of which meet, has n + m + 1 joints; on both sides of a ridge
    they meet.
    """
    vault = mr.Masonry.groin_vault(**GROIN, courses=courses, cut=cut)
    beds = sum(1 + n + m for n, m in zip((0, *heads), (*heads, 0), strict=True))
    if courses % 2 == 0:
        beds -= heads[courses // 2]
    assert len(vault.joints) == 4 * (sum(heads) + beds + (courses + 1) // 2 * cut)
    webs = [name for name in vault.names if name.startswith("web")]
    assert len(webs) == 4 * sum(heads)
    stones = 4 * courses if cut else 4 * (courses // 2) + courses % 2
    assert len(vault.free) == len(webs) + stones
    mass = sum(vault.blocks[i].mass for i in vault.free)
    assert mass == pytest.approx(2000.0 * volume_of_webs(courses), rel=1e-9)


def test_a_groin_vault_of_many_courses_is_two_circular_barrels():
    """The volume of circular webs, 4 (A length / 2 - M) with M the moment of half of a ring, to second order."""
    area, moment = 1.2 * (2.15**2 - 1.85**2), 4 / 3 * (2.15**3 - 1.85**3) * math.sin(0.6) ** 2
    short = [1 - volume_of_webs(courses) / (4 * (2.2 * area - moment)) for courses in (8, 16, 32)]
    assert short[0] / short[1] == pytest.approx(4, rel=0.02)
    assert short[1] / short[2] == pytest.approx(4, rel=0.005)


def test_a_groin_vault_rests_on_four_piers_alike():
    """A quarter of the weight on each, and thrusts inwards that turn half of the vault as its weight does.

    About the y axis, the weight of half of the vault balances the thrust of the other half, between intrados and
    extrados of the ridges, and the reactions of two piers somewhere in their beds.
    """
    vault = mr.Masonry.groin_vault(**GROIN, courses=4)
    answer = mr.solve_explicit(mr.MasonryCase(vault, 0.002), forces=True, output_step=0.001)
    assert answer.stats["overlap"] == 0.0
    masses = np.array([vault.blocks[i].mass for i in vault.free])
    weight, half = masses.sum() * mr.GRAVITY, vault.centroids[list(vault.free), 0] > 0
    assert masses[half].sum() == pytest.approx(0.5 * masses.sum())
    pushes = []
    for name, force in answer.reactions.items():
        side, other = name.split("_")[1:]
        signs = [{"front": -1, "back": 1}[side], {"right": -1, "left": 1}[other], 1]
        x, y, z = force[-1] * signs / weight
        assert (x, z) == pytest.approx((y, 0.25), rel=1e-4)
        pushes.append(x)
    assert pushes == pytest.approx(4 * pushes[:1], rel=1e-4)
    mean = float(masses[half] @ vault.centroids[list(vault.free)][half, 0] / masses[half].sum())
    (inside, low), (_, high) = 1.85 * np.sin([1.2, 1.2 + math.pi / 2]), 2.15 * np.sin([1.2, 1.2 + math.pi / 2])
    thrusts = [0.5 * (inside - mean) / (2.15 - low), 0.5 * (2.2 - mean) / (1.85 - high)]
    assert thrusts[0] < 2 * pushes[0] < thrusts[1]


def test_a_cut_groin_bears_no_more_than_one_that_is_bound():
    """Forces in balance in the cut vault are so in the other, whose joints are some of those (static theorem)."""
    bound, cut = (mr.Masonry.groin_vault(**GROIN, courses=4, cut=cut, friction=0.7) for cut in (False, True))
    along_x, along_y = (mr.collapse_multiplier(bound, push).multiplier for push in ((1.0, 0.0), (0.0, 1.0)))
    assert along_x == pytest.approx(along_y, rel=1e-6)
    assert 0 < mr.collapse_multiplier(cut).multiplier <= along_x
