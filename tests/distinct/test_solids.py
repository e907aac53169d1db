"""Blocks of the plane as solids."""

import math

import numpy as np
import pytest
from by_hand import stood

import mjrock as mr
from mjrock.distinct.search.solids import Solids, parts_of, sides_of
from mjrock.geometry.hull import area_vector

SIDES = {
    "rectangle": [(0, 0), (0.5, 0), (0.5, 0.2), (0, 0.2)],
    "triangle": [(0, 0), (0.5, -0.1), (0.2, 0.4)],
    "pentagon": [(math.cos(a), math.sin(a)) for a in 0.3 + 2 * math.pi * np.arange(5) / 5],
}


@pytest.mark.parametrize("of", SIDES)
def test_a_prism_is_the_hull_of_its_corners(of):
    block, half = mr.Polygon(SIDES[of]), 0.35
    (solid,) = parts_of(stood([block]), half, flat=True)
    hull = mr.Polyhedron(solid.corners)
    assert sorted(map(sorted, solid.faces)) == sorted(map(sorted, hull.faces))
    for face, normal in zip(solid.faces, solid.normals, strict=True):  # counterclockwise as seen from outside
        turned = area_vector(solid.corners[list(face)])
        np.testing.assert_allclose(turned / np.linalg.norm(turned), normal, atol=1e-12)
    assert solid.bulk.volume == pytest.approx(hull.volume, rel=1e-12)
    about = Solids.about([solid], np.zeros((1, 3)), block.inside, np.zeros(1, dtype=int), flat=True)
    assert about.edges.shape == (0, 3)  # edges of the plane meet faces as their corners do


@pytest.mark.parametrize("half", [0.01, 0.35, 40.0])
def test_the_outlines_of_prisms_are_measured_without_their_length(half):
    block = mr.Polygon(SIDES["rectangle"])
    given = parts_of(stood([block]), half, flat=True), np.zeros((1, 3)), block.inside, np.zeros(1, dtype=int)
    np.testing.assert_allclose(np.sort(Solids.about(*given, flat=True).extent), [0.4, 0.4, 1.0, 1.0, 1.4, 1.4])
    whole = np.sort([1.4, 1.4, 0.4 + 4 * half, 0.4 + 4 * half, 1.0 + 4 * half, 1.0 + 4 * half])
    np.testing.assert_allclose(np.sort(Solids.about(*given).extent), whole)


@pytest.mark.parametrize("prism", [False, True])
def test_faces_of_a_cut_lie_inside(prism):
    """One of either part, at x = 1, and the two ends of the prisms of the plane."""
    parts = [mr.Polygon([(x, 0), (x + 1, 0), (x + 1, 1), (x, 1)]) for x in (0, 1)]
    cut = mr.Compound.prism(mr.Compound(parts)) if prism else mr.Compound(parts)
    solids = parts_of(stood([cut]), 0.5, flat=not prism)
    for solid, inside, way in zip(solids, cut.inside, (1.0, -1.0), strict=True):
        ends = [] if prism else [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]
        np.testing.assert_allclose(solid.normals[inside], [*ends, [way, 0.0, 0.0]], atol=1e-12)
        assert len(inside) == len(solid.faces)


def sides_with_parts(block):
    """Faces of a block that lie on one side, and the corners around that side."""
    whole, owner = stood([block]), np.zeros(len(block.parts), dtype=int)
    solids = parts_of(whole, 0.5, flat=not block.in_space)
    about = Solids.about(solids, np.zeros((len(solids), 3)), block.inside, owner, side=sides_of(whole))
    found = {}
    for face, side in enumerate(about.side.tolist()):
        ring = about.corners[about.around[about.begin[face] : about.begin[face + 1]]]
        np.testing.assert_allclose(area_vector(ring) @ about.normals[face], np.linalg.norm(area_vector(ring)))
        found.setdefault(side, []).append(ring)
    return [rings for rings in found.values() if len(rings) > 1]


@pytest.mark.parametrize("prism", [False, True])
def test_faces_in_one_plane_across_a_cut_lie_on_one_side(prism):
    """The bottom of an L of three parts; in space its two ends too, of which one cut makes an L, which is no side."""
    parts = [mr.Polygon([(x, 0), (x + 1, 0), (x + 1, z), (x, z)]) for x, z in ((0, 1), (1, 1), (2, 3))]
    unit = mr.Compound.prism(mr.Compound(parts)) if prism else mr.Compound(parts)
    areas = {(round(abs(area_vector(r[0])).max(), 9), len(r), len(r[0])) for r in sides_with_parts(unit)}
    assert areas == {(3.0, 3, 4), (2.0, 2, 4)}
    for rings in sides_with_parts(unit):
        assert all(np.array_equal(ring, rings[0]) for ring in rings)


def test_a_face_that_another_part_divides_is_one_side_with_what_goes_on_at_both_ends():
    """The underside of a T whose flange goes on on both sides, and whose web hides the middle."""
    boxes = ((0, 1, 2, 3), (1, 4, 2, 3), (4, 6, 2, 3), (2, 3, 0, 2))
    unit = mr.Compound([mr.Polygon([(a, c), (b, c), (b, d), (a, d)]) for a, b, c, d in boxes])
    underside = [rings for rings in sides_with_parts(unit) if rings[0][:, 2].max() == rings[0][:, 2].min() == 2]
    assert [len(rings) for rings in underside] == [3]
    np.testing.assert_allclose([underside[0][0].min(axis=0), underside[0][0].max(axis=0)], [[0, -0.5, 2], [6, 0.5, 2]])
