"""Convex polygons in a plane."""

import math
from itertools import pairwise

import numpy as np
import pytest

from mjrock.geometry import convex

SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
FIVE = np.array([(0.0, 0.0), (2.0, 0.0), (1.5, 1.0), (0.2, 0.6), (-0.1, 0.3)])


def circle(n):
    angles = 2 * math.pi * np.arange(n) / n
    return np.column_stack([np.cos(angles), np.sin(angles)])


def test_clipping_of_squares():
    common = convex.clipped(SQUARE, SQUARE + np.array([0.25, -0.5]))
    assert convex.area(common) == pytest.approx(0.375)
    assert convex.polygon_centroid(common) == pytest.approx([0.625, 0.25])
    assert convex.width(common) == pytest.approx(0.5)


def test_clipping_of_a_square_by_itself_turned_is_an_octagon():
    """Area of the regular octagon of inradius 1/2: 2 (sqrt(2) - 1)."""
    c = math.sqrt(0.5)
    common = convex.clipped(SQUARE - 0.5, (SQUARE - 0.5) @ np.array([[c, c], [-c, c]]))
    assert len(common) == 8
    assert convex.area(common) == pytest.approx(2 * (math.sqrt(2) - 1))
    assert convex.width(common) == pytest.approx(1.0)


def test_how_far_points_lie_within_a_square():
    points = np.array([(0.5, 0.5), (0.1, 0.5), (1.0, 0.3), (1.2, 0.5), (0.5, -3.0)])
    assert convex.within(SQUARE, points) == pytest.approx([0.5, 0.1, 0.0, -0.2, -3.0])
    assert convex.within(2 * SQUARE, 2 * points) == pytest.approx([1.0, 0.2, 0.0, -0.4, -6.0])


def test_what_is_apart_has_nothing_in_common():
    assert convex.clipped(SQUARE, SQUARE + np.array([3.0, 0.0])).shape == (0, 2)


def test_cleaning_keeps_corners_and_a_circle_of_many():
    doubled = np.array([(0, 0), (0.5, 1e-7), (1, 0), (1, 1e-7), (1, 1), (0.5, 1.0), (0, 1)], dtype=float)
    assert len(convex.cleaned(doubled, 1e-5)) == 4
    coarse = convex.cleaned(circle(2000), 1e-5)  # each of its corners stands out by 5e-6
    assert 500 < len(coarse) < 2000
    assert convex.area(coarse) == pytest.approx(math.pi, rel=1e-4)
    assert not len(convex.cleaned(np.array([(0, 0), (1, 0), (1, 1e-6), (0, 1e-6)]), 1e-5))


@pytest.mark.parametrize("polygon", [SQUARE, FIVE, FIVE[:3], circle(12)], ids=["square", "five", "three", "circle"])
@pytest.mark.parametrize("points", [2, 3, 4, 7])
def test_areas_of_points_are_positive_and_have_the_area_and_its_centroid(polygon, points):
    places, areas = convex.spread(polygon, points)
    assert (areas > 0).all()
    assert areas.sum() == pytest.approx(convex.area(polygon), rel=1e-12)
    assert areas @ places / areas.sum() == pytest.approx(convex.polygon_centroid(polygon), abs=1e-12)


def test_points_of_a_rectangle_are_those_of_lines_in_both_directions():
    places, areas = convex.spread(SQUARE * [2.0, 1.0], 3)
    assert len(places) == 9
    inner = (np.abs(places - [1.0, 0.5]) < 1e-12).sum(axis=1)  # 0 corner, 1 edge, 2 middle
    assert areas == pytest.approx(2.0 * np.array([1, 2, 4])[inner] / 16)
    assert len(convex.spread(SQUARE, 2)[0]) == 4
    assert len(convex.spread(FIVE, 3)[0]) == 11


def test_more_points_have_the_second_moment_of_the_area():
    """That of a regular polygon of n corners is area (2 + cos(2 pi/n))/12; half the cells, a quarter of the error."""
    exact = convex.area(circle(6)) * (2 + math.cos(math.pi / 3)) / 12
    errors = []
    for points in (2, 9, 17):
        places, areas = convex.spread(circle(6), points)
        errors.append(areas @ places[:, 0] ** 2 / exact - 1)
    assert errors[0] == pytest.approx(6 / (2 + math.cos(math.pi / 3)) - 1)
    assert errors[2] == pytest.approx(errors[1] / 4, rel=0.01)
    assert 0 < errors[2] < 0.02


def second_moments(polygon):
    """Area and its moments with x, y, x^2, y^2 and x y, by the middles of the edges of triangles, exact for these."""
    total = np.zeros(6)
    for b, c in pairwise(polygon[1:]):
        a, part = polygon[0], convex.area(np.array([polygon[0], b, c]))
        for x, y in (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)):
            total += part / 3 * np.array([1.0, x, y, x * x, y * y, x * y])
    return total


@pytest.mark.parametrize("polygon", [SQUARE, FIVE, FIVE[:3], FIVE[1:], circle(12)], ids=list("abcde"))
@pytest.mark.parametrize("points", [3, 4, 5, 8])
def test_sections_have_area_centroid_and_second_moments(polygon, points):
    places, areas = convex.sectioned(polygon, points)
    x, y = places.T
    assert (areas > 0).all()
    found = [areas.sum(), areas @ x, areas @ y, areas @ x**2, areas @ y**2, areas @ (x * y)]
    assert found == pytest.approx(second_moments(polygon), abs=1e-12)


def test_sections_of_a_rectangle_are_those_of_lobatto_and_simpson():
    places, areas = convex.sectioned(SQUARE, 3)
    inner = (np.abs(places - 0.5) < 1e-12).sum(axis=1)  # 0 corner, 1 edge, 2 middle
    assert areas == pytest.approx(np.array([1, 4, 16])[inner] / 36)
    assert convex.exact_shares(4) == pytest.approx([1 / 8, 3 / 8, 3 / 8, 1 / 8])
    assert (convex.exact_shares(1000) > 0).all()
