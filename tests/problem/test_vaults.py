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
