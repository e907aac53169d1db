"""First cracks and arching of mortared walls, and masonry on a tilting table in time, against closed forms."""

import numpy as np
import pytest

import mjrock as mr
from scripts.checks import arching, mortar, tilting_table


@pytest.mark.parametrize("points", [3, mortar.POINTS])
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if "12" in name else name for name in mortar.CASES]
)
def test_a_mortared_wall_cracks_where_the_closed_form_says(name, points, monkeypatch):
    """On three lines as on more. The samples are 0.2 % of the acceleration apart."""
    monkeypatch.setattr(mortar, "POINTS", points)
    wall, expected = mortar.CASES[name]()
    assert mortar.first_crack(wall, expected) == pytest.approx(expected, rel=0.003)


@pytest.mark.slow
def test_a_cracked_strip_arches_between_floors_as_the_closed_form_says():
    found = arching.pushed()
    shares = np.array(arching.SHARES)
    np.testing.assert_allclose(arching.forces(found, shares), arching.closed(shares * arching.T), rtol=0.01)
    assert found.peak == pytest.approx(float(arching.closed(0.0)), rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("name", tilting_table.CASES)
def test_masonry_on_a_tilting_table_moves_where_the_closed_form_says(name):
    masonry, closed = tilting_table.CASES[name]
    expected = mr.collapse_multiplier(masonry).multiplier if closed is None else closed
    assert tilting_table.tangent(masonry, expected) == pytest.approx(expected, rel=0.01)
