"""The convex block in space: closed forms, and what it refuses."""

import math

import numpy as np
import pytest

import mjrock as mr

CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]


def test_a_box():
    box = mr.Polyhedron.box((0.6, 0.4, 2.0), (1.0, 2.0, 3.0), density=1800.0)
    m = 1800 * 0.48
    assert box.mass == pytest.approx(m, rel=1e-12)
    assert box.centroid == pytest.approx([1, 2, 3])
    moments = m / 12 * np.array([0.16 + 4.0, 0.36 + 4.0, 0.36 + 0.16])
    assert box.inertia == pytest.approx(np.diag(moments), rel=1e-12, abs=1e-9)
    assert box.principal.moments == pytest.approx(moments)
    assert (box.principal.axes == np.eye(3)).all()
    assert box.size == pytest.approx(0.5 * math.sqrt(0.36 + 0.16 + 4.0))
    assert len(box.faces) == 6
    assert sorted(np.abs(box.edges).tolist()) == [[0, 0, 1], [0, 1, 0], [1, 0, 0]]


def test_principal_axes_of_a_turned_box():
    c, s = math.cos(0.4), math.sin(0.4)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    box = mr.Polyhedron(mr.Polyhedron.box((0.6, 0.4, 2.0)).corners @ turn.T)
    moments, axes = box.principal
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes @ np.diag(moments) @ axes.T == pytest.approx(box.inertia, abs=1e-9)
    assert moments == pytest.approx(960 / 12 * np.array([0.52, 4.16, 4.36]))


def test_a_prism_is_its_polygon():
    polygon = mr.Polygon([(0, 0), (2, 0), (0, 3)], density=1000.0, length=0.5, name="wedge")
    prism = mr.Polyhedron.prism(polygon, 4.0)
    assert prism.mass == pytest.approx(polygon.mass)
    assert prism.inertia[1, 1] == pytest.approx(polygon.inertia)
    x, z = polygon.centroid
    assert prism.centroid == pytest.approx([x, 4.0, z])
    assert (prism.name, len(prism.faces), len(prism.vertices)) == ("wedge", 5, 6)


def test_vertices_on_faces_and_edges_are_left_out():
    assert mr.Polyhedron([*CUBE, (0.5, 0.5, 0.0), (0.5, 0.0, 0.0)]) == mr.Polyhedron(CUBE)


@pytest.mark.parametrize(
    ("vertices", "complaint"),
    [
        ([*CUBE, (0.4, 0.5, 0.5)], r"8 at \[0.4, 0.5, 0.5\] m lies 0.4 m inside the hull of the others"),
        ([*CUBE, (0.0, 0.0, 1e-9)], "vertices 0 and 8 coincide"),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], "lie in a plane: they are 0 m thick"),
        ([(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)], "lie in a plane"),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], r"shape \(3, 3\); \(4 to 1000, 3\) is needed"),
        ([(0, 0), (1, 0), (0, 1), (1, 1)], r"shape \(4, 2\)"),
        ([*CUBE[:7], (1, 1, math.nan)], "outside the valid range -10000 to 10000 m"),
        ((1e-4 * np.array(CUBE)).tolist(), "extend over 0.0001 m"),
        ("cube", "vertices = 'cube'"),
    ],
)
def test_what_is_no_convex_body_is_refused(vertices, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.Polyhedron(vertices)


def test_a_box_is_checked():
    with pytest.raises(ValueError, match=r"size = -1 m is outside the valid range 0.001 to 10000 m"):
        mr.Polyhedron.box((1, -1, 1))
    with pytest.raises(ValueError, match=r"centre has the shape \(2,\)"):
        mr.Polyhedron.box((1, 1, 1), (0, 0))
    with pytest.raises(ValueError, match="density = 1 kg/m3"):
        mr.Polyhedron.box((1, 1, 1), density=1)
