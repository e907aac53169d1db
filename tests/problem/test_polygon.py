"""The convex block: closed forms, and what it refuses."""

import math

import numpy as np
import pytest

import mjrock as mr

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


def test_a_rectangle_is_the_block_of_its_size():
    wall = mr.Block(0.3, 2.1, length=1.5, density=1800.0)
    made = mr.Polygon([(5, 1), (5.6, 1), (5.6, 5.2), (5, 5.2)], density=1800.0, length=1.5)
    assert made.mass == pytest.approx(wall.mass, rel=1e-12)
    assert made.inertia == pytest.approx(wall.inertia, rel=1e-12)
    assert made.centroid == pytest.approx([5.3, 3.1], abs=1e-12)
    assert made.size == pytest.approx(wall.R, rel=1e-12)


def test_the_default_density():
    assert mr.Polygon(SQUARE).mass == 2000.0


def test_in_a_large_outline_vertices_coincide_that_are_a_micron_apart():
    """Within 1e-9 of the extent, where that is more than 1e-7 m."""
    for apart, coincide in ((0.9e-6, True), (1.1e-6, False)):
        outline = [(0, 0), (1000, 0), (1000, 1000), (1000 - apart, 1000), (0, 1000)]
        if coincide:
            with pytest.raises(ValueError, match="vertices 2 and 3 coincide"):
                mr.Polygon(outline)
        else:
            assert mr.Polygon(outline).area == pytest.approx(1e6)


def test_a_right_triangle():
    """Base a, height h: area a h/2, centroid at h/3, polar second moment A (a^2 + h^2)/18."""
    a, h = 3.0, 2.0
    made = mr.Polygon([(0, 0), (a, 0), (0, h)], density=1000.0)
    assert made.area == pytest.approx(a * h / 2)
    assert made.centroid == pytest.approx([a / 3, h / 3])
    assert made.inertia == pytest.approx(1000.0 * made.area * (a**2 + h**2) / 18)


def test_a_polygon_of_many_corners_is_a_disc_far_from_the_origin():
    """Area and polar second moment of a regular polygon; nothing is lost to a distant origin."""
    n, R = 60, 0.4
    angles = 2 * math.pi * np.arange(n) / n
    made = mr.Polygon(np.column_stack([900 + R * np.cos(angles), -700 + R * np.sin(angles)]), density=1000.0)
    area = 0.5 * n * R**2 * math.sin(2 * math.pi / n)
    assert made.area == pytest.approx(area, rel=1e-9)
    assert made.inertia == pytest.approx(1000.0 * area * R**2 * (2 + math.cos(2 * math.pi / n)) / 6, rel=1e-9)
    assert made.centroid == pytest.approx([900, -700], abs=1e-9)


def test_either_orientation_and_corners_on_an_edge():
    assert mr.Polygon(SQUARE[::-1]).mass == mr.Polygon(SQUARE).mass
    made = mr.Polygon([(0, 0), (0.5, 0), *SQUARE[1:]])
    assert len(made.vertices) == 4
    assert made.area == 1


@pytest.mark.parametrize(
    ("vertices", "complaint"),
    [
        (SQUARE[:2], r"vertices has the shape \(2, 2\); \(3 to 1000, 2\) is needed"),
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "edges after corners 0 and 2 cross; give the vertices in order"),
        ([(0, 0), (1, 0), (0.2, 0.2), (0, 1)], r"the corner 2 at \[0.2, 0.2\] m points inwards; a block is convex"),
        ([(0, 0), (1, 0), (2, 0)], "enclose an area of 0 m2: they lie on a line"),
        ([(0, 0), (0, 0), (1, 0), (1, 1)], r"vertices 0 and 1 coincide at \[0.0, 0.0\] m"),
        ([(0, 0), (1, 0), (1, math.nan)], "outside the valid range -10000 to 10000 m"),
        ([(0, 0), (1, 0), (1, 2e4)], "outside the valid range -10000 to 10000 m"),
        ("no", "vertices = 'no' of type str does not hold real numbers alone"),
    ],
)
def test_outlines_that_cannot_be(vertices, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.Polygon(vertices)


def test_a_star_winds_twice():
    angles = 4 * math.pi * np.arange(5) / 5
    with pytest.raises(ValueError, match="cross"):
        mr.Polygon(np.column_stack([np.cos(angles), np.sin(angles)]))
    many = 4 * math.pi * np.arange(101) / 101  # too many edges to try all pairs: the winding tells
    with pytest.raises(ValueError, match="cross"):
        mr.Polygon(np.column_stack([np.cos(many), np.sin(many)]))


@pytest.mark.parametrize("changed", [{"density": 1.0}, {"length": 0.0}, {"fixed": 1}, {"name": "a|b"}, {"name": ""}])
def test_values_out_of_range_are_named(changed):
    with pytest.raises((ValueError, TypeError), match=next(iter(changed))):
        mr.Polygon(SQUARE, **changed)
