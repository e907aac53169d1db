"""Bodies that are not convex, cut into parts: these fill the body, and no two of them overlap."""

from itertools import combinations

import numpy as np
import pytest
import scipy

from mjrock.geometry.hull import bulk_of, hull_of
from mjrock.geometry.parts import convex_parts


def prism(outline, length=0.7):
    """Corners and faces over an outline x, z, in order around it, with the faces all one way."""
    n = len(outline)
    corners = np.array([(x, y, z) for y in (0.0, length) for x, z in outline])
    ends = [tuple(range(n)), tuple(range(2 * n - 1, n - 1, -1))]
    return corners, ends + [(i, n + i, n + (i + 1) % n, (i + 1) % n) for i in range(n)]


def star(points):
    """An outline around the origin whose radius goes up and down at random."""
    random = np.random.default_rng(points)
    angles = 2 * np.pi * (np.arange(points) + random.uniform(-0.2, 0.2, points)) / points
    return random.uniform(0.4, 1.0, points)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])


def volume(corners):
    hull = hull_of(corners)
    return bulk_of(corners[list(hull.corners)], hull.faces).volume


def inner_radius(one, other):
    """Radius of the largest ball within two convex bodies, by a linear program; negative where they are apart."""
    planes = np.concatenate([scipy.spatial.ConvexHull(points).equations for points in (one, other)])
    limits = [(None, None)] * 4
    rows = np.column_stack([planes[:, :3], np.ones(len(planes))])
    return scipy.optimize.linprog([0, 0, 0, -1], A_ub=rows, b_ub=-planes[:, 3], bounds=limits).x[3]


TURN = scipy.spatial.transform.Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()


@pytest.mark.parametrize("points", [5, 8, 13])
@pytest.mark.parametrize(("turn", "size"), [(np.eye(3), 1.0), (TURN, 1.0), (TURN, 0.01), (TURN, 1000.0)])
@pytest.mark.parametrize("inside_out", [False, True])
def test_parts_fill_a_body_and_do_not_overlap(points, turn, size, inside_out):
    """However it lies, however large it is, and whichever way its faces turn. A plane takes 1e-6 of the extent."""
    corners, faces = prism(star(points))
    enclosed = abs(bulk_of(corners, tuple(faces)).volume)
    faces = [face[::-1] for face in faces] if inside_out else faces
    parts = convex_parts(size * corners @ turn.T + size * np.array([3.0, -2.0, 5.0]), faces, 60)
    assert sum(map(volume, parts)) == pytest.approx(size**3 * enclosed, rel=1e-5)
    assert max((inner_radius(one, other) for one, other in combinations(parts, 2)), default=0.0) < 3e-6 * size
    assert len(parts) <= points


def test_a_convex_body_is_one_part_and_a_body_with_a_hole_is_some():
    corners, faces = prism([(0, 0), (2, 0), (2.5, 1), (1, 2), (-0.5, 1)])
    (part,) = convex_parts(corners, faces, 5)
    assert volume(part) == pytest.approx(volume(corners))
    outer, inner = prism([(0, 0), (3, 0), (3, 2), (0, 2)]), prism([(1, 0.5), (2, 0.5), (2, 1.5), (1, 1.5)])
    ring = [(i, (i + 1) % 4, 8 + (i + 1) % 4, 8 + i) for i in range(4)]
    ring += [(4 + (i + 1) % 4, 4 + i, 12 + i, 12 + (i + 1) % 4) for i in range(4)]
    walls = [*outer[1][2:], *(tuple(8 + i for i in face)[::-1] for face in inner[1][2:])]
    parts = convex_parts(np.concatenate([outer[0], inner[0]]), [*ring, *walls], 8)
    assert len(parts) == 4
    assert sum(map(volume, parts)) == pytest.approx(0.7 * 5.0)


def test_more_parts_than_asked_for_are_refused():
    with pytest.raises(ValueError, match=r"its faces cut it into .* parts"):
        convex_parts(*prism(star(40)), 3)
