"""The component of a record across a wall, and sets of records put together."""

import math

import numpy as np
import pytest

import mjrock as mr

NORTH = mr.GroundMotion.synthetic(2.0, 4.0, seed=1)
EAST = mr.GroundMotion.synthetic(3.0, 4.0, seed=2)


def test_along_an_azimuth_by_hand():
    """cos(azimuth) north + sin(azimuth) east; north is 0, east pi/2, south the reversed north."""
    assert NORTH.along(EAST, 0.0) == NORTH
    assert NORTH.along(EAST, 0.5 * math.pi).accel == pytest.approx(EAST.accel, abs=1e-15 * NORTH.peak * 10)
    assert NORTH.along(EAST, math.pi).accel == pytest.approx(NORTH.reversed().accel, abs=1e-14)
    half = NORTH.along(EAST, math.radians(30.0))
    assert half.accel == pytest.approx(0.5 * math.sqrt(3) * NORTH.accel + 0.5 * EAST.accel, rel=1e-12, abs=1e-14)
    square = half.accel**2 + NORTH.along(EAST, math.radians(120.0)).accel ** 2
    assert square == pytest.approx(NORTH.accel**2 + EAST.accel**2)  # no energy is lost in two square directions


def test_unlike_components_are_refused():
    with pytest.raises(ValueError, match=r"other has 3 samples at dt = 0.01 s; the valid one has 401 at 0.01 s"):
        NORTH.along(mr.GroundMotion([0.0, 1.0, 0.0], 0.01), 0.0)
    with pytest.raises(ValueError, match="azimuth = 90 rad is outside"):
        NORTH.along(EAST, 90.0)


def test_sets_put_together_are_sets():
    one, two = mr.RecordSet(a=(NORTH,)), mr.RecordSet(b=(EAST, NORTH))
    for both in (one | two, one | dict(two), dict(one) | two):
        assert type(both) is mr.RecordSet
        assert list(both) == ["a", "b"]
        assert len(both.horizontal) == 3
    one |= two
    assert type(one) is mr.RecordSet
    with pytest.raises(TypeError):
        one | [1]
    assert np.isfinite(both.mean_over(mr.code_spectrum("EC8 type 1", ag=2.0, soil="B"), [0.5])).all()
