"""Edges that bodies of convex parts show, against the sums of their lengths."""

import numpy as np
import pytest

import mjrock as mr
from mjrock.geometry.parts import creases_of


def length_of(creases):
    return float(np.linalg.norm(creases[:, 1] - creases[:, 0], axis=1).sum())


def parts_of(block):
    ground = mr.Polygon([(-9, -1), (9, -1), (9, 0), (-9, 0)], fixed=True)
    return mr.MasonryCase(mr.Masonry([ground, block], k_n=1e9), 1.0).rest_geometry.solids[1].parts


def test_a_box_has_twelve_edges():
    creases = creases_of(parts_of(mr.Polygon([(0, 0), (2, 0), (2, 3), (0, 3)], length=0.5)))
    assert creases.shape == (12, 2, 3)
    assert length_of(creases) == pytest.approx(4 * (2 + 3 + 0.5))


def test_a_cut_through_a_unit_is_no_edge():
    """An L has two outlines and six edges across, however it is cut."""
    upright, foot = mr.Polygon([(0, 0), (1, 0), (1, 3), (0, 3)]), mr.Polygon([(1, 0), (2, 0), (2, 1), (1, 1)])
    below, above = mr.Polygon([(0, 0), (2, 0), (2, 1), (0, 1)]), mr.Polygon([(0, 1), (1, 1), (1, 3), (0, 3)])
    for cut in ((upright, foot), (below, above)):
        creases = creases_of(parts_of(mr.Compound(cut)))
        assert length_of(creases) == pytest.approx(2 * (2 + 1 + 1 + 2 + 1 + 3) + 6)


def test_a_wall_shows_its_opening_and_not_the_parts_that_it_is_made_of():
    window = mr.Opening(width=1.0, height=2.0, sill=1.0)
    wall = mr.Block.from_size(thickness=0.6, height=4.2, length=4.0, openings=[window])
    parts = mr.Case(wall, 0.01, 1.0).rest_geometry.solids[0].parts
    assert len(parts) > 3
    assert length_of(creases_of(parts)) == pytest.approx(4 * (0.6 + 4.2 + 4.0) + 4 * (1.0 + 2.0) + 4 * 0.6)
