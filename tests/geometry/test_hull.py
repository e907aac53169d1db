"""The convex hull and the bulk of a body: closed forms."""

import itertools

import numpy as np
import pytest

from mjrock.geometry.hull import area_vector, bulk_of, hull_of

BOX = np.array(list(itertools.product((0.0, 0.6), (0.0, 0.4), (0.0, 2.0))))


def rotated(points):
    axis = np.linalg.qr(np.array([[1.0, 2, 3], [0, 1, 4], [5, 6, 0]]))[0]
    return points @ axis.T


@pytest.mark.parametrize("turn", [np.array, rotated])
def test_a_box_has_six_faces_that_look_outwards(turn):
    points = turn(BOX)
    hull = hull_of(points)
    assert len(hull.faces) == 6
    assert len(hull.corners) == 8
    for face, normal in zip(hull.faces, hull.normals, strict=True):
        ring = points[list(face)]
        assert area_vector(ring) / np.linalg.norm(area_vector(ring)) == pytest.approx(normal, abs=1e-12)
        assert (ring.mean(axis=0) - points.mean(axis=0)) @ normal > 0.1


@pytest.mark.parametrize("turn", [np.array, rotated])
def test_points_inside_on_a_face_and_on_an_edge_are_no_corners(turn):
    hull = hull_of(turn(np.vstack([[[0.3, 0.2, 1.0], [0.3, 0.1, 0.0], [0.3, 0.0, 0.0]], BOX])))
    assert hull.corners == tuple(range(3, 11))
    assert len(hull.faces) == 6
    assert hull.depth == pytest.approx([0.2] + 10 * [0.0], abs=1e-12)


@pytest.mark.parametrize("turn", [np.array, rotated])
def test_a_body_of_equal_shape_elsewhere_has_the_same_faces_and_arrays_of_its_own(turn):
    points, far = turn(BOX), np.array([4.0, -8.0, 16.0])
    here = hull_of(points)
    here.normals[:], here.depth[:] = np.nan, np.nan  # whoever writes into one leaves the next as it is
    for there in (hull_of(points), hull_of(points + far)):
        assert set(there.faces) == set(here.faces)  # rounding decides which of two equal ones comes first
        assert np.isfinite(there.normals).all()
        assert np.abs(there.depth).max() < 1e-12
    bulk, moved = bulk_of(points, here.faces), bulk_of(points + far, here.faces)
    assert moved.centroid - bulk.centroid == pytest.approx(far, rel=1e-14)
    assert moved.second == pytest.approx(bulk.second, rel=1e-12, abs=1e-15)


def test_a_body_of_equal_shape_and_another_size_is_another_body():
    bulks = [bulk_of(size * BOX, hull_of(size * BOX).faces) for size in (1.0, 2.0)]
    assert bulks[1].volume == pytest.approx(8 * bulks[0].volume)
    thin = BOX * [1.0, 1.0, 1e-5]
    for size in (1.0, 2.0):  # the message has the size of the body that is refused
        with pytest.raises(ValueError, match=f"{size * 2e-5:.3g} m thick"):
            hull_of(size * thin)


def test_a_face_that_is_bent_by_less_than_the_rounding_of_a_file_is_one():
    for bend, faces in ((1e-6, 6), (1e-2, 7)):
        points = BOX.copy()
        points[7, 2] += bend
        assert len(hull_of(points).faces) == faces


@pytest.mark.parametrize("turn", [np.array, rotated])
def test_bulk_of_a_box(turn):
    points = turn(BOX)
    hull = hull_of(points)
    bulk = bulk_of(points, hull.faces)
    assert bulk.volume == pytest.approx(0.48, rel=1e-12)
    assert bulk.centroid == pytest.approx(turn(np.array([[0.3, 0.2, 1.0]]))[0], abs=1e-12)
    axes = turn(np.eye(3)).T
    expected = axes @ np.diag(0.48 / 12 * np.array([0.36, 0.16, 4.0])) @ axes.T
    assert bulk.second == pytest.approx(expected, abs=1e-12)


def test_bulk_of_a_corner_tetrahedron():
    """Edges a along the axes: V = a^3/6, centroid a/4, integral of x^2 is a^5/60 and of x y a^5/120, at the corner."""
    points = np.vstack([np.zeros(3), 3.0 * np.eye(3)]) + np.array([10.0, -20.0, 30.0])
    hull = hull_of(points)
    bulk = bulk_of(points, hull.faces)
    assert bulk.volume == pytest.approx(27 / 6)
    assert bulk.centroid == pytest.approx(np.array([10.75, -19.25, 30.75]))
    expected = 3.0**5 * (np.ones((3, 3)) + np.eye(3)) / 120 - 27 / 6 * 0.75**2
    assert bulk.second == pytest.approx(expected, rel=1e-9)


def test_points_in_a_plane_enclose_nothing():
    with pytest.raises(ValueError, match=r"lie in a plane: they are 5e-06 m thick"):
        hull_of(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1e-5], [0.5, 0.5, 0]]) * [1, 1, 1.0])
