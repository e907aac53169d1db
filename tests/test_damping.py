import math
import warnings

import pytest

import mjrock as mr


def test_no_warning_inside_table_1(wall, e):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mr.PUBLISHED(wall, e, 5e8)


def test_a_warning_that_names_what_is_outside(wall, e):
    with pytest.warns(UserWarning, match=r"k_n \[N/m3\] = 1e\+10 not in 5e\+07 to 3e\+09"):
        mr.PUBLISHED(wall, e, 1e10)
    slender = mr.Block(b=0.1, h=2.0)
    with pytest.warns(UserWarning, match=r"h/b \[-\] = 20 not in 4 to 15"):
        mr.PUBLISHED(slender, e, 5e8)


def test_a_perfect_rebound_asks_for_no_damping(wall):
    assert mr.PUBLISHED(wall, mr.Restitution(1.0, -1.0), 5e8) == (0.0, 0.0)


def test_the_law_rises_with_loss(wall, e):
    base, side = mr.PUBLISHED(wall, e, 5e8)
    more_base, more_side = mr.PUBLISHED(wall, mr.Restitution(e.base**2, -(e.side**2)), 5e8)
    assert more_base == pytest.approx(2 * base)
    assert more_side == pytest.approx(2 * side)


def test_bad_input(wall, e):
    with pytest.raises(ValueError, match="k_n = -1 N/m3"):
        mr.PUBLISHED(wall, e, -1)
    with pytest.raises(ValueError, match="k_n = nan"):
        mr.PUBLISHED(wall, e, math.nan)
    with pytest.raises(ValueError, match="side restitution = 0"):
        mr.PUBLISHED(wall, mr.Restitution(0.9, 0.0), 5e8)
