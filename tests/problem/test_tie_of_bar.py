"""Ties from bar, steel, plate and masonry, against closed forms worked out by hand."""

import math

import pytest

import mjrock as mr
from mjrock import strengths_of_bar

BAR = {
    "height": 6.0, "diameter": 0.024, "yield_stress": 235e6, "length": 8.0, "plate": 0.3, "thickness": 0.6,
    "shear_strength": 0.03e6, "compressive_strength": 2e6,
}  # fmt: skip


def test_the_least_strength_governs():
    """A bar of 24 mm yields at 106 kN, a plate of 0.3 m pulls through a wall of 0.6 m at 65 kN, and bears 180 kN."""
    found = strengths_of_bar(0.024, 235e6, 0.3, 0.6, 0.03e6, 2e6)
    assert found == {
        "bar": pytest.approx(235e6 * math.pi * 0.012**2),
        "punching": pytest.approx(0.03e6 * 2 * 0.6 * (0.3 + 0.3 + 1.2)),
        "bearing": pytest.approx(2e6 * 0.09),
    }
    tie = mr.Tie.of_bar(**BAR, slack=0.005, ultimate=0.03)
    assert tie.strength == pytest.approx(64.8e3)
    assert tie.stiffness == pytest.approx(210e9 * math.pi * 0.012**2 / 8.0)
    assert (tie.height, tie.length, tie.slack, tie.ultimate) == (6.0, 8.0, 0.005, 0.03)


def test_punching_beside_a_printed_example():
    """Master Magazine 7, p. 75: a round plate of 100 mm on a wall of 300 mm, f_v0 = 0.74 N/cm2, punches at 2.79 kN. A
    square plate has 4 / pi of the perimeter."""
    square = strengths_of_bar(0.016, 450e6, 0.1, 0.3, 7.4e3, 1e6)["punching"]
    assert square * math.pi / 4 == pytest.approx(2.79e3, abs=5)


@pytest.mark.parametrize(
    ("other", "strength"),
    [
        ({"plate": (0.2, 0.1)}, 2e6 * 0.02),
        ({"plate": 1.0}, 235e6 * math.pi * 0.012**2),
        ({"number": 3}, 3 * 64.8e3),
    ],
)
def test_plates_and_numbers(other, strength):
    tie = mr.Tie.of_bar(**BAR | other)
    assert tie.strength == pytest.approx(strength)
    count = other.get("number", 1)
    assert tie.stiffness == pytest.approx(count * 210e9 * math.pi * 0.012**2 / 8.0)


@pytest.mark.parametrize(("plate", "name"), [(0.3, "punching"), ((0.2, 0.1), "bearing"), (1.0, "bar")])
def test_what_governs_is_kept_and_said(plate, name):
    tie = mr.Tie.of_bar(**BAR | {"plate": plate})
    assert tie.governed_by == name
    assert tie.description.endswith(f" kN ({name})")
    assert "governed_by" not in repr(mr.Tie(6.0, 1e6))
    assert mr.Case(mr.Block(0.5, 3.5), 0.0, 1.0, effects=(tie,)).effects == (tie,)
    with pytest.raises(ValueError, match="governed_by of the tie = 'hope' is not one of bar, punching, bearing"):
        mr.Tie(6.0, 1e6, governed_by="hope")


@pytest.mark.parametrize(
    ("spacing", "strength"),
    [
        (0.3, 0.03e6 * 1.2 * (0.9 + 0.3 + 1.2)),
        (1.0, 0.03e6 * 1.2 * (2.3 + 0.3 + 1.2)),
        (1.8, 3 * 64.8e3),
        (5.0, 3 * 64.8e3),
    ],
)
def test_near_plates_punch_as_one_plate(spacing, strength):
    """Three plates of 0.3 m side by side are a plate of 0.9 m by 0.3 m; from a + b + 2 t = 1.8 m each is alone."""
    tie = mr.Tie.of_bar(**BAR, number=3, spacing=spacing)
    assert (tie.strength, tie.governed_by) == (pytest.approx(strength), "punching")
    assert tie.stiffness == pytest.approx(3 * mr.Tie.of_bar(**BAR).stiffness)


@pytest.mark.parametrize(
    ("other", "complaint"),
    [
        ({"diameter": 24.0}, "diameter of the bar = 24 m is outside the valid range 0.004 to 0.2 m"),
        ({"yield_stress": 235.0}, "yield_stress of the bar = 235 Pa is outside"),
        ({"plate": 300.0}, "plate = 300 m is outside the valid range 0.02 to 3 m"),
        ({"shear_strength": 0.03}, "shear_strength of the masonry = 0.03 Pa is outside"),
        ({"compressive_strength": 2.0}, "compressive_strength of the masonry = 2 Pa is outside"),
        ({"number": 0}, "number of ties = 0 is outside"),
        ({"number": 2, "spacing": 0.25}, "spacing of the ties = 0.25 m is outside the valid range 0.3 to 1000 m"),
        ({"length": -1.0}, "length of the tie = -1 m is outside"),
    ],
)
def test_what_cannot_be(other, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.Tie.of_bar(**BAR | other)


def test_a_tie_says_at_which_force_it_yields_in_kilonewtons():
    assert "yields at 64.8 kN" in mr.Tie.of_bar(**BAR).description
    assert "yields" not in mr.Tie(6.0, 1e6).description


@pytest.mark.parametrize(("thickness", "taken"), [(0.049, False), (0.05, True), (10.0, True), (10.1, False)])
def test_walls_of_some_thickness_hold_a_plate(thickness, taken):
    if taken:
        assert mr.Tie.of_bar(**BAR | {"thickness": thickness}).strength > 0
        return
    with pytest.raises(ValueError, match=r"thickness of the wall = .* is outside the valid range 0.05 to 10 m"):
        mr.Tie.of_bar(**BAR | {"thickness": thickness})


@pytest.mark.parametrize(("bears", "strength", "name"), [(50e3, 50e3, "other end"), (70e3, 64.8e3, "punching")])
def test_the_other_end_may_govern(bears, strength, name):
    tie = mr.Tie.of_bar(**BAR, other_end=bears)
    assert (tie.strength, tie.governed_by) == (pytest.approx(strength), name)


def test_a_grouted_anchor_by_hand():
    """600 mm in a hole of 50 mm: a surface of pi x 0.05 x 0.6 m2, and a cone that is pi (0.05 + 0.6) round at half the
    depth and 0.6 m deep."""
    found = mr.strengths_of_anchor(0.05, 0.6, 0.3e6, 60e3, number=2)
    assert found == {
        "bond": pytest.approx(2 * 0.3e6 * math.pi * 0.05 * 0.6),
        "cone": pytest.approx(2 * 60e3 * math.pi * 0.65 * 0.6),
    }
    tie = mr.Tie.of_bar(**BAR, other_end=min(mr.strengths_of_anchor(0.05, 0.6, 0.3e6, 60e3).values()))
    assert tie.strength == pytest.approx(0.3e6 * math.pi * 0.03)
    with pytest.raises(ValueError, match="diameter of the hole = 1 m is outside"):
        mr.strengths_of_anchor(1.0, 0.6, 0.3e6, 60e3)
