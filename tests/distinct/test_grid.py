"""The grid of a joint on the part of a face that lies over another, one function at a time, and what it stands for."""

import math

import numpy as np
import pytest
from by_hand import columns, stood
from scipy.spatial.transform import Rotation

import mjrock as mr
from mjrock.distinct.search import clipping
from mjrock.distinct.search.finder import Finder
from mjrock.distinct.search.solids import Poses, Solids
from mjrock.geometry import convex
from mjrock.rows import rows

BOX = mr.Polyhedron.box
UP = (0.0, 0.0, 1.0)


def polygon_in(corners, count=24):
    polygon = np.full((count, 3), np.nan)
    polygon[: len(corners), :2], polygon[: len(corners), 2] = np.reshape(corners, (-1, 2)), 0.25
    return polygon


def places_of(corners, cells):
    """Nodes of a polygon [m], shape (n, 2), what each stands for [m2], and how often each was met."""
    polygon = polygon_in(corners)
    whole = clipping.grid_of(polygon, len(corners), cells)
    nodes, middle = clipping.node_count(whole), clipping.middle_of(polygon, len(corners))
    places, areas, corner = np.full((nodes, 2), np.nan), np.zeros(nodes), np.zeros(nodes, dtype=bool)
    for q in range(whole.quads):
        quad = clipping.quad_of(polygon, whole, q, middle)
        for i in range(whole.cells_s + 1):
            for j in range(whole.cells_t + 1):
                number = clipping.node_number(whole, q, i, j)
                at = clipping.point_in(quad, i / whole.cells_s, j / whole.cells_t)
                assert np.isnan(places[number, 0]) or places[number] == pytest.approx(at[:2], abs=1e-14)
                places[number], areas[number] = at[:2], areas[number] + clipping.tributary_area(quad, whole, i, j)
                corner[number] = clipping.is_corner(whole, i, j)
    return places, areas, corner


RECTANGLE = np.array([(0.1, 0.2), (0.7, 0.2), (0.7, 0.6), (0.1, 0.6)])
KITE = np.array([(0.0, 0.0), (1.0, 0.1), (1.3, 1.1), (-0.2, 0.6)])
ROUND = np.array([(math.cos(a), math.sin(a)) for a in (0.1, 0.2, 1.4, 2.9, 4.0, 5.1)])


@pytest.mark.parametrize("corners", [RECTANGLE, KITE, ROUND[:3], ROUND[:5], ROUND])
@pytest.mark.parametrize("points", [3, 4, 5, 8, 9])
def test_the_places_of_a_part_stand_for_its_area_and_its_mean(corners, points):
    """And none coincide. `geometry.convex.spread` has the same places."""
    places, areas, corner = places_of(corners, (points - 1, points - 1))
    assert areas.min() > 0
    assert areas.sum() == pytest.approx(convex.area(corners), rel=1e-12)
    np.testing.assert_allclose(areas @ places / areas.sum(), convex.polygon_centroid(corners), rtol=1e-12)
    assert corner.sum() == len(corners)
    np.testing.assert_allclose(sorted(map(tuple, places[corner])), sorted(map(tuple, corners)), atol=1e-14)
    expected, _ = convex.spread(corners, points)
    apart = np.linalg.norm(places[:, None] - expected, axis=2)
    assert len(places) == len(expected)
    np.testing.assert_allclose([apart.min(axis=0), apart.min(axis=1)], 0.0, atol=1e-9)


@pytest.mark.parametrize("points", [3, 4, 9])
def test_a_rectangle_is_shared_out_as_a_joint_of_the_drawing(points):
    places, areas, _ = places_of(RECTANGLE, (points - 1, points - 1))
    expected, shares = convex.spread(RECTANGLE, points)
    apart = np.linalg.norm(places[:, None] - expected, axis=2)
    np.testing.assert_allclose(areas, shares[apart.argmin(axis=1)], rtol=1e-12)


@pytest.mark.parametrize("start", range(4))
def test_a_part_of_the_plane_is_divided_along_its_joint_alone(start):
    """At whichever corner it begins: y is across the plane."""
    corners = np.roll(RECTANGLE, start, axis=0)
    places, areas, _ = places_of(corners, (4, 1))
    np.testing.assert_allclose(np.unique(places[:, 0].round(9)), np.linspace(0.1, 0.7, 5))
    np.testing.assert_allclose(np.unique(places[:, 1].round(9)), [0.2, 0.6])
    ends = (np.abs(places[:, 0] - 0.4) > 0.29).sum()
    assert (len(places), ends) == (10, 4)
    np.testing.assert_allclose(np.unique(areas.round(12)), [0.24 / 16, 0.24 / 8])


def test_corners_where_a_polygon_goes_straight_on_are_left_out():
    polygon = polygon_in([(0, 0), (0.3, 0), (1, 0), (1, 1), (0.5, 1), (0, 1), (0, 0.2)])
    assert clipping.straightened(polygon, 7, polygon_in([])) == 4
    np.testing.assert_array_equal(polygon[:4, :2], [(0, 0), (1, 0), (1, 1), (0, 1)])


def solids_about(*blocks):
    outer = [np.zeros(len(block.faces), dtype=bool) for block in blocks]
    return Solids.about(blocks, np.zeros((len(blocks), 3)), outer, np.arange(len(blocks)))


LOWER = BOX((2.0, 2.0, 1.0), (0.0, 0.0, -0.5))


def laid(upper, cells, size=99):
    """Places of a block that lies over the upper face of another one."""
    solids, table = solids_about(LOWER, upper), rows(clipping.PLACE, size)
    count = clipping.clip_in_grid(
        solids, clipping.face_towards(solids, 0, UP), (0, 1), cells, clipping.Workspace(table, polygon_in([], 32)), 1
    )
    return columns(table), count


def test_places_of_a_block_that_lies_over_a_corner_of_another():
    """Points of the upper one on the lower, and along the edges of the lower one alone points of these on the upper."""
    table, count = laid(BOX((1.0, 1.0, 0.5), (1.0, 1.0, 0.2)), (2, 2))
    assert count == 10
    rows = table[1:10]
    np.testing.assert_allclose(rows[:, 8], -0.05, atol=1e-15)
    np.testing.assert_allclose(rows[:, 10], 0.25)
    on_edge = rows[:, 2:4].max(axis=1) > 1 - 1e-9
    assert on_edge.sum() == 5
    upper = rows[:, 2:4].min(axis=1) < 0.5 + 1e-9  # on an edge of the upper one as well
    np.testing.assert_array_equal(rows[:, 0], on_edge & ~upper)
    np.testing.assert_allclose(rows[:, 5:8], np.outer(1 - 2 * rows[:, 0], UP), atol=1e-15)
    assert not table[[0, *range(10, 99)]].any()


def test_each_place_of_a_tilted_block_has_its_own_height():
    turn = Rotation.from_rotvec([0.02, -0.03, 0.4])
    middle = np.array([0.1, 0.0, -0.02])
    upper = mr.Polyhedron(turn.apply(np.array(BOX((1.0, 1.2, 0.5), (0.0, 0.0, 0.25)).corners)) + middle)
    table, count = laid(upper, (4, 4))
    assert count == 26
    for row in table[1:26]:
        above = row[2:5] + 0.5 * row[8] * row[5:8]
        assert turn.inv().apply(above - middle)[2] == pytest.approx(0.0, abs=1e-12)
        assert row[8] == pytest.approx(above[2], abs=1e-12)
    assert table[1:26, 9].sum() == pytest.approx(1.0)


def test_places_for_which_there_is_no_room_are_counted():
    upper = BOX((1.0, 1.0, 0.5), (0.0, 0.0, 0.2))
    assert laid(upper, (2, 2), size=9)[1] == 10
    assert not laid(upper, (2, 2), size=9)[0].any()
    assert laid(BOX((1.0, 1.0, 0.5), (1.6, 0.0, 0.2)), (2, 2))[1] == 1  # nothing lies over the face


def even(corners, about, count=200):
    """Mean distance from a point over the area of a polygon [m], by cells within it."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    cells = low + (high - low) * (np.stack(np.meshgrid(*2 * [np.arange(count)]), axis=-1).reshape(-1, 2) + 0.5) / count
    inside = cells[convex.within(corners, cells) > 0]
    return np.linalg.norm(inside - about, axis=1).mean()


@pytest.mark.parametrize("turn", [0.0, 0.05, 0.4])
def test_torsion_of_two_squares_tends_to_that_of_even_pressure(turn):
    """Over each other with a twist, in the finder: 0.3826 of mu N a for none, and 1.85 times that at the corners."""
    blocks = BOX((1.0, 1.0, 0.5), (0, 0, -0.25)), BOX((1.0, 1.0, 0.5), (0, 0, 0.25))
    drawn = np.array([block.centroid for block in blocks])
    change = np.stack([np.zeros((3, 3)), Rotation.from_rotvec([0, 0, turn]).as_matrix() - np.eye(3)])
    poses = Poses(drawn, np.zeros((2, 3)), change)
    square = 0.5 * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    turned = square @ np.array([(math.cos(turn), math.sin(turn)), (-math.sin(turn), math.cos(turn))])
    expected = even(convex.clipped(square, turned), np.zeros(2))
    if turn == 0:
        assert expected == pytest.approx(0.3826, rel=1e-3)
    for points, within in ((3, 0.13), (5, 0.04), (9, 0.015)):
        finder = Finder(stood(blocks), flat=False)
        for jointed, off in ((np.array([1]), within), (np.zeros(0, dtype=np.int64), 1.0)):
            finder.jointed, finder.points = jointed, np.full(len(jointed), points)
            found = finder.places_near(poses, np.full(2, 1e-3), np.ones(2, dtype=bool), np.zeros(0, dtype=np.int64))
            radius = float(found.share @ np.linalg.norm(found.place[:, :2], axis=1))
            assert found.share.sum() == pytest.approx(1.0)
            assert radius == pytest.approx(expected, rel=off)
        assert radius > 1.3 * expected  # without a joint it is at the corners
