import math

import pytest

import mjrock as mr


def test_figure_3(wall, e):
    assert round(e.base, 2) == 0.97
    assert round(e.side, 2) == -0.47
    assert e.lumped == pytest.approx(e.base * e.side * e.base, rel=1e-15)


def test_alpha_as_printed_would_give_something_else(wall):
    with pytest.raises(ValueError, match=r"alpha = 1\.4289 rad is outside the valid range"):
        mr.Restitution.from_geometry(math.atan(wall.h / wall.b))


def test_from_lumped_keeps_the_measured_value():
    e = mr.Restitution.from_lumped(-0.328, 0.1184)
    assert e.lumped == pytest.approx(-0.328, rel=1e-14)
    assert e.base == mr.Restitution.from_geometry(0.1184).base


@pytest.mark.parametrize(("base", "side"), [(0, -0.5), (1.1, -0.5), (0.9, -1.2), (math.nan, -0.5), (0.9, math.nan)])
def test_values_outside_their_range(base, side):
    with pytest.raises(ValueError, match="outside the valid range"):
        mr.Restitution(base, side)


@pytest.mark.parametrize("lumped", [0.3, 0.0, -0.99, math.nan])
def test_measurements_that_cannot_be(lumped):
    with pytest.raises(ValueError, match="lumped restitution"):
        mr.Restitution.from_lumped(lumped, 0.1184)
