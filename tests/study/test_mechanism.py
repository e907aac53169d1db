"""The check of a local mechanism: every step against its closed form for one block."""

import math
import warnings

import pytest

import mjrock as mr

WALL = mr.Block.from_size(0.9, 12.0, 10.0, 1900.0)
CASE = mr.Case(WALL, 0.0, 1.0)


def test_the_steps_of_a_plain_wall():
    found = mr.mechanism_check(CASE, lambda T, xi: 0.1, confidence_factor=1.2)
    assert found.alpha_0 == pytest.approx(WALL.b / WALL.h)
    assert found.participation == pytest.approx(1.0)
    assert found.a_0 == pytest.approx(mr.GRAVITY * WALL.b / WALL.h / 1.2)
    assert found.linear == pytest.approx(2 * found.a_0)
    slv, slc = found.states["SLV"], found.states["SLC"]
    assert found.d_0 == pytest.approx(WALL.b, rel=0.01)  # the centroid stands above the toe
    assert slv.capacity == pytest.approx(0.4 * found.d_0)
    assert slc.capacity == pytest.approx(0.6 * found.d_0)
    # the curve falls nearly linearly, a = a_0 (1 - d / d_0)
    assert slv.period == pytest.approx(1.68 * math.pi * math.sqrt(0.4 * found.d_0 / (0.6 * found.a_0)), rel=0.01)
    assert slc.period == pytest.approx(1.56 * math.pi * math.sqrt(0.6 * found.d_0 / (0.4 * found.a_0)), rel=0.01)
    assert slv.ratio == pytest.approx(slv.capacity / 0.1)
    assert "C8.7.1.10" in found.table()


def test_a_mass_at_the_top_takes_part():
    added = mr.AddedMass(WALL.mass / 2, 12.0)
    found = mr.mechanism_check(mr.Case(WALL, 0.0, 1.0, effects=added), lambda T, xi: 0.1)
    assert found.participation == pytest.approx((6 + 6) ** 2 / (1.5 * (36 + 72)))


def test_ties_at_their_strength_stand_beside_the_slack_ones():
    """Virtual work about the toe: the strength times its height, over weight times the height of the centroid."""
    ties = mr.Tie(10.0, 1e8, strength=60e3, ultimate=0.05), mr.Tie(6.0, 1e8, strength=20e3, ultimate=0.05)
    tied = mr.mechanism_check(mr.Case(WALL, 0.0, 1.0, effects=ties), lambda T, xi: 0.1, confidence_factor=1.2)
    bare = mr.mechanism_check(CASE, lambda T, xi: 0.1, confidence_factor=1.2)
    multiplier = (WALL.weight * WALL.b + 60e3 * 10.0 + 20e3 * 6.0) / (WALL.weight * WALL.h)
    assert tied.alpha_tied == pytest.approx(multiplier)
    assert tied.linear_tied == pytest.approx(2 * multiplier * mr.GRAVITY / 1.2)
    assert tied.linear == bare.linear
    assert bare.alpha_tied is None is bare.linear_tied
    assert "ties at their strength" not in bare.table()
    (shown_text,) = (
        line for line in tied.table().splitlines() if line.startswith("linear SLV, ties at their strength [g]")
    )
    assert f"{tied.linear_tied / mr.GRAVITY:.4f}" in shown_text


def test_a_record_asks_for_its_largest_displacement_up_to_the_period():
    record = mr.GroundMotion.synthetic(3.0, 10.0, seed=1)
    found = mr.mechanism_check(CASE, record)
    state = found.states["SLV"]
    assert state.demand >= mr.response_spectrum(record, state.period, 0.08).Sd[0] * 0.999
    twice = mr.mechanism_check(CASE, record.scaled(2.0)).states["SLV"]
    assert twice.demand == pytest.approx(2 * state.demand)


def test_each_limit_state_has_a_demand_of_its_own():
    slv = mr.code_spectrum("NTC 2018", ag=2.56, F0=2.36, Tc=0.347, soil="C", topography="T1")
    slc = mr.code_spectrum("NTC 2018", ag=3.27, F0=2.40, Tc=0.358, soil="C", topography="T1")
    both = mr.mechanism_check(CASE, {"SLV": slv, "SLC": slc})
    one, other = mr.mechanism_check(CASE, slv), mr.mechanism_check(CASE, slc)
    assert both.states["SLV"].ratio == one.states["SLV"].ratio
    assert both.states["SLC"].ratio == other.states["SLC"].ratio
    assert both.peak == one.peak
    assert both.states["SLC"].ratio < one.states["SLC"].ratio


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: mr.mechanism_check(CASE, 3), "demand = 3 of type int is neither a GroundMotion nor a function"),
        (lambda: mr.mechanism_check(CASE, {"SLV": abs}), "demand has SLV; a mapping needs SLV and SLC"),
        (lambda: mr.mechanism_check(CASE, {"SLV": 3, "SLC": 3}), r"demand\['SLV'\] = 3 of type int is neither"),
        (lambda: mr.mechanism_check(CASE, abs), "demand = <built-in function abs> .* nor a function"),
        (lambda: mr.mechanism_check(CASE, lambda T, xi: "x"), r"demand\(T, xi\) = 'x' of type str is not a real"),
        (lambda: mr.mechanism_check(CASE, lambda T, xi: 0.1, confidence_factor=2), "confidence_factor = 2 is outside"),
        (
            lambda: mr.mechanism_check(mr.Case(WALL, 0.0, 1.0, effects=mr.Tie(8.0, 1e7)), lambda T, xi: 0.1),
            "case has a push-over curve that does not end",
        ),
    ],
)
def test_what_cannot_be(call, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        call()


def test_ties_that_never_break_are_doubted_where_they_make_the_capacity():
    wall = mr.Block.from_size(0.6, 4.0, 6.0, 1900.0)
    spectrum = mr.code_spectrum("NTC 2018", ag=2.0, F0=2.45, Tc=0.35, soil="B")

    def check(**changed):
        tie = mr.Tie(height=4.0, stiffness=2e7, **changed)
        return mr.mechanism_check(mr.Case(wall, 0.0, 1.0, effects=tie), spectrum)

    with pytest.warns(mr.Implausible, match=r"d_SLC = .* than 0.3 m, .* tie_0 \(ultimate = None\) would still hold"):
        endless = check(strength=120e3)
    with pytest.warns(mr.Implausible, match="would still hold there|ultimate = 8 m") as caught:
        assert check(strength=120e3, ultimate=8).states["SLC"].capacity > 0.3
    assert ["tie_0 (ultimate = 8 m)" in str(one.message) for one in caught] == [False, True]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        drawn_out = check(strength=120e3, ultimate=0.05)
        weak = check(strength=3e3)
    assert endless.d_0 > 1.0
    assert drawn_out.d_0 == pytest.approx(0.3, rel=1e-3)
    assert 0.3 < weak.d_0 < 0.5
    for name in ("SLV", "SLC"):
        (row,) = (line for line in drawn_out.table().splitlines() if line.startswith(f"capacity over demand {name}  "))
        assert row.endswith("without tie_0, broken")
    assert "broken" not in endless.table()


def test_the_elastic_branch_by_hand():
    """a = (2 pi / T_0)^2 d up to the curve of the mechanism, which falls from a_0, and T_SLV where it is on the branch.

    T_0 = 3.0 s: the branch reaches 0.4 d_0 = 0.18 m at 0.18 (2 pi / 3)^2 = 0.79 m/s2, above 0.6 a_0 = 0.33: as before.
    T_0 = 5.0 s: 0.18 (2 pi / 5)^2 = 0.284 m/s2, below it: T_SLV = 1.68 pi sqrt(0.18 / 0.284) = 0.84 T_0 = 4.2 s.
    """
    rigid = mr.mechanism_check(CASE, lambda T, xi: 0.1)
    for T_0 in (3.0, 5.0):
        found = mr.mechanism_check(CASE, lambda T, xi: 0.1, elastic_period=T_0)
        least = min(0.6 * rigid.a_0, found.states["SLV"].capacity * (2 * math.pi / T_0) ** 2)
        T = 1.68 * math.pi * math.sqrt(found.states["SLV"].capacity / least)
        assert found.states["SLV"].period == pytest.approx(T, rel=0.01)  # the curve is straight within 1 %
        assert found.d_0 == pytest.approx(rigid.d_0)
        assert found.a[0] == 0.0
        assert "C8.7.1.6" in found.table()
        assert found.alpha_0 == rigid.alpha_0
    assert found.states["SLV"].period == pytest.approx(0.84 * 5.0, rel=1e-4)


PARAPET = mr.Case(mr.Block.from_size(0.3, 1.2, 10.0, 1800.0), 0.0, 10.0, side_stop=False)
SITE = {state: mr.code_spectrum("NTC 2018", ag=ag, F0=2.5, Tc=0.33, soil="B") for state, ag in
        (("SLD", 0.7), ("SLV", 1.77), ("SLC", 2.26))}  # fmt: skip
ROOF = {state: spectrum.at_height(0.28, participation=1.3, height=1.0) for state, spectrum in SITE.items()}


def test_an_element_that_vibrates_freely_meets_the_spectrum_at_its_period():
    """C8.7.1.9, and C8.7.1.2.1.7 with it: S_eZ(T_0) with 5 %, where a rigid one meets the peak."""
    T_0 = 0.12
    free, rigid = mr.mechanism_check(PARAPET, ROOF, elastic_period=T_0), mr.mechanism_check(PARAPET, ROOF)
    a_0 = 0.25 * mr.GRAVITY / 1.35
    assert rigid.linear_ratio == pytest.approx(2 * a_0 / ROOF["SLV"].peak)
    assert rigid.damage_ratio == pytest.approx(a_0 / ROOF["SLD"].peak)
    assert free.linear_ratio == pytest.approx(2 * a_0 / float(ROOF["SLV"](T_0, 0.05)))
    assert free.damage_ratio == pytest.approx(a_0 / float(ROOF["SLD"](T_0, 0.05)))
    assert free.linear_ratio < rigid.linear_ratio
    assert [one.clause for one in (rigid.verdicts[-1], free.verdicts[-1])] == ["C8.7.1.8", "C8.7.1.9"]
    assert [one.limit_state for one in free.verdicts] == ["SLV", "SLV", "SLC", "SLD"]
    lines = free.table().splitlines()
    assert any(line.startswith("S_eZ(T_0)") and line.endswith("C8.7.1.9") for line in lines)
    assert not any(line.startswith("peak of the demand") for line in lines)
    (row,) = (line for line in lines if line.startswith("capacity over demand SLD"))
    assert row.endswith(free.verdicts[-1].label)


def test_the_same_of_records_and_displacement_spectra():
    """(2 pi / T_0)^2 S_De is the acceleration, and of a record that of the oscillator of its period."""
    T_0 = 0.2
    spectrum = SITE["SLV"]
    of_function = mr.mechanism_check(PARAPET, lambda T, xi: float(spectrum.displacement(T, xi)), elastic_period=T_0)
    assert of_function.peak == pytest.approx(float(spectrum(T_0, 0.05)))
    record = mr.GroundMotion.synthetic(2.0, 5.0, seed=1)
    found = mr.mechanism_check(PARAPET, record, elastic_period=T_0)
    assert found.peak == pytest.approx(float(mr.response_spectrum(record, [T_0], 0.05).Sa[0]), rel=1e-9)


def test_without_a_demand_of_its_own_there_is_no_condition_of_damage():
    assert mr.mechanism_check(PARAPET, ROOF["SLV"]).damage_ratio is None
    assert len(mr.mechanism_check(PARAPET, ROOF["SLV"]).verdicts) == 3


def test_a_wall_that_is_free_both_ways_names_its_weaker_edge():
    """A chimney whose outer face tapers stands off the middle of its base. Inwards it is the mirrored one outwards."""

    def chimney(plumb):
        shape = mr.Block.from_size(1.4, 14.0, 1.2, 1300.0, profile=[(0, 1.4), (14, 1.0)], plumb=plumb)
        return mr.Case(shape, 0.0, 1.0, side_stop=False)

    inner, z = 1.4 / 2 + chimney("inner").wall.centroid_offset, chimney("inner").wall.centroid_height
    weaker = mr.mechanism_check(chimney("outer"), lambda T, xi: 0.1)
    assert weaker.alpha_0 == pytest.approx(inner / z)
    assert weaker.alpha_0 == pytest.approx(0.0916, abs=1e-4)
    with pytest.warns(mr.Implausible, match=rf"inwards the wall starts at {inner / z:.4g} g"):
        mr.mechanism_check(chimney("inner"), lambda T, xi: 0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mr.mechanism_check(chimney("outer"), lambda T, xi: 0.1)
