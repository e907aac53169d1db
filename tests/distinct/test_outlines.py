"""Where a face ends, one function at a time."""

import math

import numpy as np
import pytest

import mjrock as mr
from mjrock.distinct.contacts import faces
from mjrock.distinct.rows import kinds
from mjrock.geometry.hull import Side
from mjrock.problem.wall.rest_geometry import Face
from mjrock.rows import rows

TURN = 0.3
C, S = math.cos(TURN), math.sin(TURN)


def rectangle(left, right, low, high, **more):
    """A block of the plane on a slope."""
    corners = [(left, low), (right, low), (right, high), (left, high)]
    return mr.Polygon([(C * x - S * z, S * x + C * z) for x, z in corners], density=2000.0, **more)


def test_the_outlines_of_a_joint_of_the_plane_are_the_two_whole_sides():
    """A block of 1 m on a slope of 5 m."""
    blocks = [rectangle(-1, 4, -1, 0, fixed=True), rectangle(0.5, 1.5, 0, 1)]
    masonry = mr.Masonry(blocks, k_n=1e8, friction=0.6)
    along, up = np.array([C, S]), np.array([-S, C])
    ((below, above),) = mr.MasonryCase(masonry, 1.0).rest_geometry.faces
    for outline, ends, normal in ((below, (-1, 4), up), (above, (0.5, 1.5), -up)):
        np.testing.assert_allclose(sorted((outline.corners @ along).tolist()), ends, rtol=1e-12)
        np.testing.assert_allclose(outline.corners @ up, 0.0, atol=1e-12)
        np.testing.assert_allclose(outline.normal, normal, rtol=1e-12)
        np.testing.assert_allclose(outline.edge_normals, [-along, along], rtol=1e-12)


def test_the_outlines_of_a_joint_in_space_are_the_two_whole_faces():
    """The normals of the edges point out of each face, in its plane."""
    blocks = [
        mr.Polyhedron.box((4.0, 3.0, 1.0), (1.0, 0.5, -0.5), density=2000.0, fixed=True),
        mr.Polyhedron.box((1.0, 2.0, 1.0), (1.0, 0.5, 0.5), density=2000.0),
    ]
    masonry = mr.Masonry(blocks, k_n=1e8, friction=0.6)
    ((below, above),) = mr.MasonryCase(masonry, 1.0).rest_geometry.faces
    for outline, size, normal in ((below, (4.0, 3.0), 1.0), (above, (1.0, 2.0), -1.0)):
        np.testing.assert_allclose(np.ptp(outline.corners, axis=0), [*size, 0.0], atol=1e-12)
        np.testing.assert_allclose(outline.normal, [0.0, 0.0, normal], atol=1e-12)
        middle = outline.corners.mean(axis=0)
        following = np.roll(outline.corners, -1, axis=0)
        for outwards, start, end in zip(outline.edge_normals, outline.corners, following, strict=True):
            assert outwards @ outwards == pytest.approx(1.0)
            assert outwards @ (start - middle) == pytest.approx(outwards @ (end - middle))
            assert outwards @ (start - middle) > 0


def outline(width, middle=0.0):
    """A face of the plane along x."""
    corners = np.array([[middle - 0.5 * width, 0.0], [middle + 0.5 * width, 0.0]])
    return Face(corners, np.array([0.0, 1.0]), np.array([[-1.0, 0.0], [1.0, 0.0]]))


@pytest.mark.parametrize(("other", "shorter"), [(3.0, 2.0), (0.5, 0.5)])
@pytest.mark.parametrize("centroid", [6.8, 5.5])
def test_a_face_is_longer_by_a_share_of_the_shorter_one(other, shorter, centroid):
    """Of 2 m about x = 7. The normal turns over as much beyond either end."""
    edges, _ = faces.edges_of([outline(2.0, 7.0)], np.array([[centroid, 1.0]]), [outline(other, 7.3)])
    np.testing.assert_allclose(edges["reach"], np.add([centroid - 6, 8 - centroid], 0.02 * shorter), rtol=1e-12)
    np.testing.assert_allclose(edges["band"], 0.02 * shorter + 2 * 0.02**2 * shorter, rtol=1e-12)
    np.testing.assert_array_equal(edges["normal"], [[-1.0, 0.0], [1.0, 0.0]])


def polygon(corners, size):
    """A face across x whose outline is regular."""
    angles = 2 * np.pi * np.arange(corners) / corners
    ring = size * np.column_stack([np.zeros(corners), np.cos(angles), np.sin(angles)])
    return Face.in_space([Side(ring, np.array([1.0, 0.0, 0.0]))])[0]


def test_faces_of_many_outlines_have_the_edges_of_each_alone():
    sides = [polygon(corners, size) for corners, size in ((4, 1.0), (3, 2.0), (4, 0.3), (5, 1.0), (3, 0.7))]
    origins, met = np.arange(15.0).reshape(5, 3), [*sides[1:], sides[0]]
    edges, begin = faces.edges_of(sides, origins, met)
    np.testing.assert_array_equal(begin, [0, 4, 7, 11, 16, 19])
    for i, (one, other) in enumerate(zip(sides, met, strict=True)):
        alone, _ = faces.edges_of([one], origins[i : i + 1], [other])
        np.testing.assert_array_equal(edges[begin[i] : begin[i + 1]], alone)


def square(reach=1.0, band=0.5):
    """Edges of a square about the centroid of a block, and one more that is none of it."""
    normals = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]
    return rows(kinds(3).edge, 5, normal=[*normals, [0.0, 0.0, 1.0]], reach=[reach] * 4 + [-9.0], band=[band] * 5)


def test_the_least_distance_of_a_line_from_the_end_of_its_face():
    lines = rows(kinds(3).line, 3, first=[0, 0, 4], last=[4, 4, 5])
    lines["origin"] = [[0.7, -0.2, 5.0], [-1.5, 0.0, 0.0], [0.0, 0.0, -12.0]]
    np.testing.assert_allclose(faces.margins(lines, square()), [0.09, 0.0, 9.0])


@pytest.mark.parametrize(
    ("place", "inside", "share"),
    [
        ((0.3, -0.9, 7.0), (0.3, -0.9, 7.0), 0.0),
        ((1.0, -1.0, 0.0), (1.0, -1.0, 0.0), 0.0),
        ((1.2, 0.5, 2.0), (1.0, 0.5, 2.0), 0.4),
        ((-1.1, 1.3, 2.0), (-1.0, 1.0, 2.0), 0.6),
    ],
)
def test_places_beside_a_face_are_pulled_to_its_outline(place, inside, share):
    edges = square()
    found, by = faces.pulled_inside(edges, 0, 4, place)
    np.testing.assert_allclose(found, inside, rtol=1e-12)
    assert by == pytest.approx(share)
    assert faces.is_beside(edges, 0, 4, place) is (share > 0)
    assert faces.is_beside(edges, 1, 4, (1.2, 0.5, 2.0)) is False


def test_at_a_sharp_corner_the_search_goes_round():
    """What one edge has pulled inside may lie beyond another one then. How far it is beyond counts at the start."""
    normals = np.array([[1.0, 0.0, 0.0], [-0.6, 0.8, 0.0]])
    edges = rows(kinds(3).edge, 2, normal=normals, reach=[1.0, 0.0], band=[0.1, 1.0])
    found, share = faces.pulled_inside(edges, 0, 2, (1.0, 1.0, 0.0))
    place = np.array([1.0, 1.0])
    for _ in range(faces.ROUNDS):
        for normal, reach in zip(normals[:, :2], (1.0, 0.0), strict=True):
            place = place - max(normal @ place - reach, 0.0) * normal
    np.testing.assert_allclose(found, [*place, 0.0], rtol=1e-12)
    assert normals[0, :2] @ place - 1.0 < 0.36**2 * 0.12 * (1 + 1e-9)
    assert share == pytest.approx(0.2)
