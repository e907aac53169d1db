"""Spectra with national parameters of EC8, and spectra given as points."""

import math

import numpy as np
import pytest

import mjrock as mr


def test_national_parameters_by_hand():
    """EN 1998-1 eqs. 3.2 to 3.5 with S = 1.3, 0.1, 0.6, 2.0 s, a_g = 2 m/s2.

    2.6 at rest, 6.5 on the plateau, 6.5 0.6/1.2 at 1.2 s and 6.5 0.6 2.0 / 9 at 3 s.
    """
    spectrum = mr.code_spectrum("EC8 type 1", ag=2.0, soil="B", S=1.3, TB=0.1, TC=0.6, TD=2.0)
    assert spectrum([0.0, 0.3, 1.2, 3.0]) == pytest.approx([2.6, 6.5, 3.25, 6.5 * 0.6 * 2.0 / 9])
    assert mr.code_spectrum("EC8 type 1", ag=2.0, soil="B", S=1.2).peak == pytest.approx(2.4)  # the recommended one
    with pytest.raises(ValueError, match=r"TB, TC, TD = 0.7, 0.5, 2 s do not increase"):
        mr.code_spectrum("EC8 type 1", ag=2.0, soil="B", TB=0.7)
    with pytest.raises(ValueError, match=r"S = 1.3 is of a national annex of EC8"):
        mr.code_spectrum("NTC 2018", ag=2.0, soil="B", F0=2.4, Tc=0.3, S=1.3)


def test_points_of_a_code_give_its_check():
    """Points of a spectrum every 1 ms stand for it within the chord of 1/T, 1e-5 here."""
    code = mr.code_spectrum("EC8 type 1", ag=2.0, soil="B")
    T = np.linspace(0.0, 4.5, 4501)
    points = mr.PointSpectrum(T, code(T))
    case = mr.Case(mr.Block.from_size(0.5, 3.0), 0.0, 1.0)
    given, known = mr.mechanism_check(case, points), mr.mechanism_check(case, code)
    assert given.linear_ratio == pytest.approx(known.linear_ratio)
    for name in ("SLV", "SLC"):
        assert given.states[name].ratio == pytest.approx(known.states[name].ratio, rel=1e-5)
    assert points(0.3, 0.10) == pytest.approx(code(0.3, 0.10))
    assert points.displacement(1.0) == pytest.approx(points(1.0) / (2 * math.pi) ** 2)
    floor = points.at_height(0.25, participation=1.2, height=0.7)
    assert floor(0.3) == pytest.approx(code.at_height(0.25, participation=1.2, height=0.7)(0.3), rel=1e-5)
    record = mr.GroundMotion.synthetic(2.0, 5.0, seed=3)
    scaled = mr.scaled_to_spectrum(record, [0.5, 1.0], points)
    assert scaled.accel == pytest.approx(mr.scaled_to_spectrum(record, [0.5, 1.0], code).accel, rel=1e-5)


def test_points_out_of_range():
    with pytest.raises(ValueError, match="period"):
        mr.PointSpectrum([0.2, 0.1], [1.0, 2.0])
    with pytest.raises(ValueError, match="acceleration"):
        mr.PointSpectrum([0.1, 0.2], [1.0, -2.0])
