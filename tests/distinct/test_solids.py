"""Blocks of the plane as solids."""

import math

import numpy as np
import pytest

import mjrock as mr
from mjrock.distinct.search.solids import Solids, inside_of, solid_of
from mjrock.geometry.hull import area_vector

SIDES = {
    "rectangle": [(0, 0), (0.5, 0), (0.5, 0.2), (0, 0.2)],
    "triangle": [(0, 0), (0.5, -0.1), (0.2, 0.4)],
    "pentagon": [(math.cos(a), math.sin(a)) for a in 0.3 + 2 * math.pi * np.arange(5) / 5],
}


@pytest.mark.parametrize("of", SIDES)
def test_a_prism_is_the_hull_of_its_corners(of):
    block, half = mr.Polygon(SIDES[of]), 0.35
    solid, hull = solid_of(block, half), mr.Polyhedron(solid_of(block, half).corners)
    assert sorted(map(sorted, solid.faces)) == sorted(map(sorted, hull.faces))
    for face, normal in zip(solid.faces, solid.normals, strict=True):  # counterclockwise as seen from outside
        turned = area_vector(solid.corners[list(face)])
        np.testing.assert_allclose(turned / np.linalg.norm(turned), normal, atol=1e-12)
    assert solid.edges.shape == (0, 3)  # edges of the plane meet faces as their corners do
    assert solid.volume == pytest.approx(hull.volume, rel=1e-12)


@pytest.mark.parametrize("half", [0.01, 0.35, 40.0])
def test_the_outlines_of_prisms_are_measured_without_their_length(half):
    block = mr.Polygon(SIDES["rectangle"])
    given = [solid_of(block, half)], np.zeros((1, 3)), inside_of(block), np.zeros(1, dtype=int)
    np.testing.assert_allclose(np.sort(Solids.about(*given, (0, 2)).extent), [0.4, 0.4, 1.0, 1.0, 1.4, 1.4])
    whole = np.sort([1.4, 1.4, 0.4 + 4 * half, 0.4 + 4 * half, 1.0 + 4 * half, 1.0 + 4 * half])
    np.testing.assert_allclose(np.sort(Solids.about(*given).extent), whole)


@pytest.mark.parametrize("prism", [False, True])
def test_faces_of_a_cut_lie_inside(prism):
    """One of either part, at x = 1, and the two ends of the prisms of the plane."""
    parts = [mr.Polygon([(x, 0), (x + 1, 0), (x + 1, 1), (x, 1)]) for x in (0, 1)]
    cut = mr.Compound.prism(mr.Compound(parts)) if prism else mr.Compound(parts)
    for part, inside, way in zip(cut.parts, inside_of(cut), (1.0, -1.0), strict=True):
        solid = part if prism else solid_of(part, 0.5)
        ends = [] if prism else [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]
        np.testing.assert_allclose(solid.normals[inside], [*ends, [way, 0.0, 0.0]], atol=1e-12)
        assert len(inside) == len(solid.faces)
