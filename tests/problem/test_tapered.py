"""Arches, domes and columns whose thickness changes, and curved voussoirs: closed forms and a thrust line by hand."""

import math

import numpy as np
import pytest
import scipy

import mjrock as mr


def faces(thickness, count, radius=5.0):
    """Angle from the crown of the joints of half of a semicircular arch, and radii of their inner and outer ends."""
    angles = 0.5 * math.pi * np.arange(count // 2 + 1) / (count // 2)
    half = 0.5 * np.interp(angles, [0.0, 0.5 * math.pi], thickness[::-1])
    return angles, radius - half, radius + half


def shoelace(corners):
    """Area and centroid of a polygon."""
    x, z = np.array(corners).T
    cross = x * np.roll(z, -1) - np.roll(x, -1) * z
    return 0.5 * cross.sum(), ((x + np.roll(x, -1)) @ cross) / (3 * cross.sum())


def has_a_thrust_line(thickness, count):
    """Whether a thrust line lies within half of an arch: two unknowns, the thrust and its moment about the centre.

    At each joint the moment of what is above it is positive about one end and negative about the other.
    """
    angles, inner, outer = faces(thickness, count)
    ends = [np.column_stack([r * np.sin(angles), r * np.cos(angles)]) for r in (inner, outer)]
    areas = [shoelace([ends[0][k], ends[1][k], ends[1][k + 1], ends[0][k + 1]]) for k in range(count // 2)]
    weights, places = np.abs([area for area, _ in areas]), np.array([x for _, x in areas])
    rows, most = [], []
    for k in range(count // 2 + 1):
        for sign, (x, z) in zip((1.0, -1.0), (end[k] for end in ends), strict=True):
            rows.append([sign * z, -sign])  # weight (x - place) + thrust z - moment <= 0 at the inner end
            most.append(-sign * float(weights[:k] @ (x - places[:k])))
    return scipy.optimize.linprog([0.0, 0.0], A_ub=rows, b_ub=most, bounds=[(0, None), (None, None)]).status == 0


def stands(masonry):
    """Whether limit analysis finds forces in balance with the weight."""
    try:
        return mr.collapse_multiplier(masonry).multiplier > 0
    except ValueError:
        return False


@pytest.mark.parametrize("ratio", [0.6, 1.0, 1.8])
def test_the_least_thickness_of_a_tapered_semicircle(ratio):
    """Half a per cent thicker stands, half a per cent thinner does not; a uniform arch needs 0.1075 of its radius.

    That one is of a continuous ring (Milankovitch 1907); 24 voussoirs are near it.
    """
    low, high = 0.05, 2.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if has_a_thrust_line((ratio * middle, middle), 24) else (middle, high)
    if ratio == 1.0:
        assert high / 5.0 == pytest.approx(0.1075, rel=0.02)
    for factor, wanted in ((1.005, True), (0.995, False)):
        thickness = (factor * ratio * high, factor * high)
        assert has_a_thrust_line(thickness, 24) == wanted
        assert stands(mr.Masonry.arch(5.0, thickness, voussoirs=24, friction=5.0)) == wanted, factor


def test_a_tapered_arch_has_the_mass_of_its_rings_and_stands_alike_on_both_sides():
    """The area between two chords from a to b, of the angle d between them, is sin(d) (a_out b_out - a_in b_in) / 2."""
    _, inner, outer = faces((0.9, 0.6), 16)
    area = math.sin(math.pi / 16) * (outer[1:] * outer[:-1] - inner[1:] * inner[:-1]).sum()
    arch = mr.Masonry.arch(5.0, (0.9, 0.6), voussoirs=16, length=2.0)
    weight = sum(arch.blocks[i].mass for i in arch.free) * mr.GRAVITY
    assert weight == pytest.approx(2000.0 * 2.0 * area * mr.GRAVITY, rel=1e-9)
    widths = [joint.width for joint in arch.joints]
    np.testing.assert_allclose(widths, np.interp(np.arange(17), [0, 8, 16], [0.9, 0.6, 0.9]), rtol=1e-9)
    answer = mr.solve_explicit(mr.MasonryCase(arch, 0.002), forces=True, output_step=0.001)
    left, right = (answer.reactions[f"{side}_abutment"][-1] / weight for side in ("left", "right"))
    np.testing.assert_allclose(left, right * (-1, 1), rtol=1e-5)
    assert left[1] == pytest.approx(0.5, rel=1e-5)


def test_curved_voussoirs_come_close_to_a_ring_to_second_order():
    """A voussoir of n chords is as long as one, is one body, and lacks 1 - sin(d) / d of the area of a ring."""
    ring = 0.5 * math.pi * (5.3**2 - 4.7**2) * 2000.0
    for chords in (1, 2, 4):
        arch = mr.Masonry.arch(5.0, 0.6, voussoirs=9, chords=chords)
        assert (len(arch.free), len(arch.joints)) == (9, 10)
        d = math.pi / 9 / chords
        assert sum(arch.blocks[i].mass for i in arch.free) == pytest.approx(ring * math.sin(d) / d, rel=1e-9)
        np.testing.assert_allclose([joint.width for joint in arch.joints], 0.6, rtol=1e-9)
        assert stands(arch)


def test_vaults_and_bridges_taper_as_their_arch_does():
    """Their weight is that of the arch, and a pier is as wide at the springing as the arch is thick there."""
    arch = mr.Masonry.arch(2.0, (0.5, 0.3), 2.4, 6, length=1.5)
    barrel = mr.Masonry.barrel_vault(2.0, (0.5, 0.3), 1.5, 0.75, 2.4, 6)
    masses = [sum(masonry.blocks[i].mass for i in masonry.free) for masonry in (arch, barrel)]
    assert masses[0] == pytest.approx(masses[1], rel=1e-9)
    bridge = mr.Masonry.bridge(2.0, (0.5, 0.3), 2.4, 6, spans=2, pier_width=1.2, pier_height=1.0)
    widths = [joint.width for joint in bridge.joints if "pier_1" in joint.name and "voussoir" in joint.name]
    np.testing.assert_allclose(widths, [0.5, 0.5], rtol=1e-9)
    groin = mr.Masonry.groin_vault(2.0, (0.5, 0.3), 4.4, 1.0, 2.4, 3)
    assert stands(groin)
    middle = np.average(groin.centroids[list(groin.free)], axis=0, weights=[groin.blocks[i].mass for i in groin.free])
    np.testing.assert_allclose(middle[:2], 0.0, atol=1e-12)


def test_a_tapered_column_overturns_as_its_centroid_says():
    """A frustum of a square section; its push is half of its width over the height of its centroid."""
    column = mr.Masonry.column((1.0, 0.6), 4.0, 4, xi=0)
    assert sum(column.blocks[i].mass for i in column.free) == pytest.approx(2000.0 * 4.0 * (1.0 + 0.6 + 0.36) / 3)
    height = 4.0 / 4 * (1.0 + 2 * 0.6 + 3 * 0.36) / (1.0 + 0.6 + 0.36)
    assert mr.collapse_multiplier(column).multiplier == pytest.approx(0.5 / height)


def test_a_tapered_dome_has_the_thickness_asked_for_at_each_hoop():
    dome = mr.Masonry.dome(5.0, (0.8, 0.4), 12, 4, xi=0)
    beds = {}
    for joint in dome.joints:
        radii = np.linalg.norm(joint.outline, axis=1)
        if np.ptp(joint.outline[:, 2] / radii) < 1e-9:
            beds.setdefault(round(float(joint.outline[0, 2] / radii[0]), 6), float(np.ptp(radii)))
    np.testing.assert_allclose([beds[level] for level in sorted(beds)], [0.8, 0.7, 0.6, 0.5], rtol=1e-9)
    assert stands(dome)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: mr.Masonry.arch(5.0, (0.9, 0.6, 0.3)), r"thickness = \(0.9, 0.6, 0.3\).* neither a number nor a pair"),
        (lambda: mr.Masonry.arch(5.0, (0.9, 6.0)), r"thickness = 6 m is outside the valid range 0.005 to 5 m"),
        (lambda: mr.Masonry.arch(5.0, 0.9, voussoirs=17, chords=0), r"chords = 0 is outside the valid range 1 to 50"),
        (lambda: mr.Masonry.arch(5.0, 0.9, voussoirs=100, chords=20), r"voussoirs = 100 is outside .* 1 to 50"),
        (lambda: mr.Masonry.column((1.0, 0.001), 4.0, 2), r"width = 0.001 m is outside the valid range 0.01 to 100 m"),
        (lambda: mr.Masonry.groin_vault(2.0, 0.3, 4.0, 0.8), r"length = 4 m is outside the valid range 4.3 to 1000 m"),
        (lambda: mr.Masonry.groin_vault(2.0, 0.3, 5.0, 6.0), r"unit = 6 m is outside the valid range 0.01 to 5 m"),
        (lambda: mr.Masonry.groin_vault(2.0, 0.3, 5.0, 0.01, courses=30), r"unit = 0.01 m .* more blocks than 25000"),
    ],
)
def test_what_cannot_be_is_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
