"""The inverse of the check: the first value that holds follows from a formula worked out in each test."""

import math

import pytest
from masonry_blocks import box

import mjrock as mr
from mjrock import plotting

G = mr.GRAVITY
SLV = mr.code_spectrum("NTC 2018", ag=0.21 * G, F0=2.45, Tc=0.33, soil="C")
WALL = mr.Block.from_size(0.5, 6.0, 5.0, 1900.0)


def tied(strength):
    effects = () if strength is None else mr.Tie(5.8, 1e8, strength=strength, ultimate=0.05)
    return mr.Case(WALL, 0.0, 1.0, effects=effects)


def test_the_first_tie_that_the_linear_check_needs():
    """2 (alpha_0 + T z / (W h / 2)) g / FC is the peak of the demand."""
    needed = (SLV.peak * 1.35 / (2 * G) - 0.5 / 6.0) * WALL.weight * 3.0 / 5.8
    values = [0.5 * needed, 0.999 * needed, 1.001 * needed, 2 * needed]
    found = mr.design(tied, values, SLV, method="linear")
    assert found.value == values[2]
    assert found.chosen.ratio == pytest.approx(1.0, abs=1e-3)
    assert found.governs.verdict.what == "linear kinematic"
    assert [trial.holds for trial in found.trials] == [False, False, True, True]
    assert len(found.table().splitlines()) == 6


def test_the_first_plate_that_does_not_punch():
    """The wall is pulled through along 2 t (a + b + 2 t): the side of the plate follows from the force."""
    t, shear = 0.5, 12e3
    needed = (SLV.peak * 1.35 / (2 * G) - 0.5 / 6.0) * WALL.weight * 3.0 / 5.8
    side = needed / (shear * 4 * t) - t
    assert 0.05 < side < 2
    masonry = {"thickness": t, "shear_strength": shear, "compressive_strength": 20e6}

    def build(plate):
        tie = mr.Tie.of_bar(5.8, 0.05, 355e6, 6.0, plate=plate, ultimate=0.05, **masonry)
        return mr.Case(WALL, 0.0, 1.0, effects=tie)

    found = mr.design(build, [0.98 * side, 1.02 * side], SLV, method="linear")
    assert found.value == 1.02 * side


def test_every_condition_counts_and_the_least_governs():
    """Of a plain wall the nonlinear check of the SLV needs the most: by the check of each thickness on its own."""
    thicknesses = [0.4, 0.6, 0.8, 1.0]
    found = mr.design(lambda t: mr.Case(mr.Block.from_size(t, 4.0), 0.0, 1.0), thicknesses, SLV)
    for t, trial in zip(thicknesses, found.trials, strict=True):
        check = mr.mechanism_check(mr.Case(mr.Block.from_size(t, 4.0), 0.0, 1.0), SLV)
        assert trial.ratio == min(one.ratio for one in check.verdicts)
        assert trial.holds == all(one.holds for one in check.verdicts)
    assert found.value == 1.0
    assert repr(found) == "<Design: 1 is the first of 4 values for which every condition holds>"


def test_several_mechanisms_all_hold():
    """The whole wall, and the part above its tie, with a check of its own."""

    def build(strength):
        above = mr.mechanism_check(mr.Case(mr.Block.from_size(0.5, 1.0), 0.0, 1.0), SLV)
        return {"whole": tied(strength), "above": above}

    found = mr.design(build, [None, 30e3, 90e3], SLV, method="linear")
    names = {condition.mechanism for condition in found.trials[0].conditions}
    assert names == {"whole", "above"}
    assert found.trials[0].governs.label == "whole: linear kinematic, SLV"


def test_a_value_that_cannot_be_is_a_row_with_its_reason():
    """A thrust that overturns the thin wall as it stands; the thick one bears it."""

    def build(t):
        return mr.Case(mr.Block.from_size(t, 4.0), 0.0, 1.0, effects=mr.Thrust(4.0, 2e3))

    found = mr.design(build, [0.3, 1.5], SLV)
    assert found.trials[0].governs is None
    assert math.isnan(found.trials[0].ratio)
    assert "overturn the wall" in found.table().splitlines()[1]
    assert found.value == 1.5


def test_where_none_holds_the_best_is_said():
    found = mr.design(lambda t: mr.Case(mr.Block.from_size(t, 4.0), 0.0, 1.0), [0.3, 0.4], SLV)
    assert found.value is None
    assert found.sentence.startswith("none of 2 values holds; 0.4 comes nearest")
    assert found.governs.verdict == found.trials[1].governs.verdict


def test_blocks_are_designed_by_their_limit_curve():
    """Of one block alpha_0 is t / h, and the linear check needs t = peak FC h / (2 g)."""
    needed = SLV.peak * 1.35 * 2.0 / (2 * G)

    def build(t):
        return mr.limit_curve(mr.Masonry.stack([mr.Block.from_size(t, 2.0)], friction=2.0), 1, poses=20)

    values = [0.99 * needed, 1.01 * needed]
    assert mr.design(build, values, SLV, method="linear").value == values[1]


def test_the_picture_has_a_line_for_each_condition_and_a_label_for_each_value():
    found = mr.design(tied, [None, 30e3, 90e3], SLV)
    ax = plotting.design(found)
    assert {line.get_label() for line in ax.get_lines()} >= {"linear kinematic, SLV", "nonlinear kinematic, SLC"}
    assert [label.get_text() for label in ax.get_xticklabels()] == ["None", "30000", "90000"]
    linear = next(line for line in ax.get_lines() if line.get_label() == "linear kinematic, SLV")
    assert linear.get_ydata() == pytest.approx([trial.conditions[0].verdict.ratio for trial in found.trials])


def corbel(spread=0.0):
    """A slab of 3 m that lies on 2 m of ground, with earth on it."""
    flat = [box(-1, 2, -1, 0, fixed=True, name="ground"), box(0, 3, 0, 0.5, name="slab")]
    masonry = mr.Masonry(flat, friction=0.7)
    return masonry, mr.Fill(1.0, 1800.0, spread=spread)


def test_an_axle_that_is_tried_at_each_place_has_its_least_factor_where_it_tips_the_slab():
    """The slab and its fill weigh on 0.5 m about the edge at 2 m, and the axle on x - 2 m."""
    masonry, fill = corbel()
    weight = (3 * 0.5 * 2000 + 3 * 0.5 * 1800) * G

    def at(x):
        return mr.collapse_multiplier(masonry, None, loads=fill.under(masonry, 30e3, at=x), effects=fill.on(masonry))

    places = [1.0, 2.3, 2.9, 2.6]
    found = mr.design(at, places)
    hand = [math.inf, *(weight * 0.5 / (30e3 * (x - 2)) for x in places[1:])]
    assert [trial.ratio for trial in found.trials] == pytest.approx(hand, rel=1e-9)
    assert found.least.value == 2.9
    assert found.least.built.moving == ("slab",)
    assert found.table().splitlines()[-1] == "4 of 4 values hold; the least ratio is 1.03, of 2.9"
    assert mr.design(at, places, 1.1).sentence == "3 of 4 values hold; the least ratio is 0.94, of 2.9"
    ax = plotting.design(found)
    assert ax.get_title() == found.sentence


def test_the_first_thickness_that_stands_the_wind():
    """W t / 2 over q h^2 / 2 is at least 1.5 from t = sqrt(1.5 q h / (rho g)) on, for a wall 1 m long."""
    needed = math.sqrt(1.5 * 0.8e3 * 3.0 / (2000 * G))

    def build(t):
        case = mr.Case(mr.Block.from_size(t, 3.0), 0.0, 1.0)
        return mr.collapse_multiplier(case, None, loads=mr.Thrust(1.5, 0.8e3 * 3.0))

    values = [0.9 * needed, 1.01 * needed, 1.2 * needed]
    assert mr.design(build, values, 1.5).value == values[1]


@pytest.mark.parametrize(
    ("given", "complaint"),
    [
        ((2, [1.0], SLV), "build = 2 .* is not a function of a value"),
        ((tied, "abc", SLV), "values = 'abc' .* is not a sequence"),
        ((tied, [], SLV), "values is empty"),
        ((tied, [1e4]), "demand is None"),
        ((tied, [1e4], {"SLV": SLV}), "demand has SLV; a mapping needs SLV and SLC"),
        ((tied, [-1.0], SLV), "none of the values can be built and checked; -1: strength of the tie"),
        ((lambda value: {}, [1e4], SLV), "is an empty mapping"),
        ((tied, [1e4], 2.5), "demand = 2.5 is a factor .*build.10000. = <Case .*collapse_multiplier.* as demand"),
        ((lambda value: None, [1e4], SLV), "build.10000. is None; build has to return"),
        ((lambda value: 3, [1e4], SLV), "case = 3 .* is not a Case"),
    ],
)
def test_what_cannot_be_designed_is_refused(given, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        mr.design(*given)
    with pytest.raises(ValueError, match="method = 'best' is not one of linear, nonlinear, dynamic"):
        mr.design(tied, [1e4], SLV, method="best")


def test_what_a_build_returns_is_named_where_it_is_no_mechanism():
    motion = mr.GroundMotion.half_sine(3.0, 0.1)  # can be called, too
    with pytest.raises(TypeError, match=r"^build\(0.4\) = array\(0.\).*is not a Case"):
        mr.design(motion, [0.4], SLV)
