"""The law of a bond on a row of numbers, against its equations."""

import math
import warnings
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.masonry.laws.bond_law import BRITTLE, bonded_limit, crush, tear, wear

K, TENSION, TORN = 1e8, 2e3, 1e4
"""Stiffness [N/m], strength [N], and rate at which a crack softens [1/m]: f_t / G_I."""


def row(**changed):
    """An intact bond."""
    law = {
        "k": K,
        "tension": TENSION,
        "cohesion": 3e3,
        "strength": math.inf,
        "opening_rate": TORN,
        "slip_rate": 5e3,
        "crushing_rate": 50.0,
    }
    state = {"integrity": 1.0, "largest_gap": 0.0, "crack": 0.0, "crushed": 0.0, "secant": K}
    plain = {"k_s": 0.4 * K, "friction": 0.75, "peak": math.inf, "hardening": 0.0}
    return SimpleNamespace(**law | state | plain | changed)


def state(bond):
    return bond.integrity, bond.largest_gap, bond.crack, bond.secant


@pytest.mark.parametrize("gap", [-1e-3, 0.0, 0.999 * TENSION / K, TENSION / K])
def test_a_bond_within_its_strength_stays_whole(gap):
    bond = row()
    tear(bond, gap)
    assert state(bond) == (1.0, max(gap, 0.0), 0.0, K)


@pytest.mark.parametrize("gap", [2.1e-5, 5e-5, 3e-4])
def test_a_crack_pulls_what_is_left_of_the_strength(gap):
    bond = row()
    tear(bond, gap)
    assert bond.largest_gap == gap
    assert 0 < bond.crack < gap
    assert K * (gap - bond.crack) == pytest.approx(TENSION * math.exp(-TORN * bond.crack), rel=1e-12)
    assert bond.integrity == pytest.approx(math.exp(-TORN * bond.crack), rel=1e-12)
    assert bond.secant * gap == pytest.approx(TENSION * bond.integrity, rel=1e-12)
    before = state(bond)
    tear(bond, 0.5 * gap)  # unloading along the secant leaves it as it is
    assert state(bond) == before


def test_many_small_openings_tear_as_one():
    once, often = row(), row()
    tear(once, 1e-4)
    for i in range(1, 11):
        tear(often, i * 1e-5)
    assert state(often) == pytest.approx(state(once), rel=1e-12)


def test_what_slip_has_worn_is_no_longer_there_to_tear():
    bond = row(integrity=0.5)
    tear(bond, 5e-5)
    assert bond.integrity == pytest.approx(0.5 * math.exp(-TORN * bond.crack), rel=1e-12)
    assert bond.secant * 5e-5 == pytest.approx(TENSION * bond.integrity, rel=1e-12)


@pytest.mark.parametrize(("rate", "breaks"), [(1.0, True), (1.0 - 1e-9, False), (1.5, True)])
def test_a_bond_breaks_at_once_where_its_spring_gives_back_what_the_crack_takes(rate, breaks):
    bond = row(k=2.0**27, tension=2.0**10, opening_rate=rate * BRITTLE * 2.0**17)
    tear(bond, 2.0**-17 + 1e-7)
    if breaks:
        assert state(bond) == (0.0, bond.largest_gap, bond.largest_gap, 0.0)
    else:
        assert 0 < bond.integrity < 1
        assert bond.secant > 0


@pytest.mark.parametrize("sheared", [0.0, 1e4])
def test_a_joint_is_crushed_until_it_bears_the_rest(sheared):
    bond = row(strength=1e5)
    gap = -math.sqrt(1e5**2 - (3 * sheared) ** 2) / K
    assert crush(bond, 0.999 * gap, sheared) == 0.0
    assert (bond.integrity, bond.crushed, bond.strength) == (1.0, 0.0, 1e5)
    closing = crush(bond, 1.1 * gap, sheared)
    pressed = K * (-1.1 * gap - closing)
    assert closing > 0
    assert math.hypot(pressed, 3 * sheared) == pytest.approx(1e5 * math.exp(-50.0 * closing), rel=1e-9)
    assert bond.strength == pytest.approx(1e5 * math.exp(-50.0 * closing), rel=1e-12)
    assert bond.integrity == pytest.approx(math.exp(-50.0 * closing), rel=1e-12)
    assert crush(bond, 1.2 * gap + closing, sheared) > 0
    assert bond.crushed > closing


@pytest.mark.parametrize("sheared", [0.0, 5e3])
def test_a_joint_that_hardens_bears_a_parabola_up_to_its_peak_and_then_softens(sheared):
    bond = row(strength=1e5 / 3, peak=1e5, hardening=2e-3)
    assert crush(bond, -0.99 * math.sqrt((1e5 / 3) ** 2 - (3 * sheared) ** 2) / K, sheared) == 0.0
    for pressed in (5e4, 8e4, 0.9999e5):
        share = 1 - math.sqrt(1 - ((3 * pressed / 1e5 - 1) / 2) ** 2)
        gap = -math.sqrt(pressed**2 - (3 * sheared) ** 2) / K - 2e-3 * share
        crush(bond, gap + bond.crushed, sheared)
        assert bond.crushed == pytest.approx(2e-3 * share, rel=1e-8)
        assert bond.strength == pytest.approx(pressed, rel=1e-8)
        assert bond.integrity == 1.0
    closing = bond.crushed + crush(bond, -2e-3, sheared)
    assert (bond.crushed, closing) == (pytest.approx(closing), pytest.approx(bond.crushed))
    assert closing > 2e-3
    assert bond.strength == pytest.approx(1e5 * math.exp(-50.0 * (closing - 2e-3)), rel=1e-9)
    assert bond.integrity == pytest.approx(math.exp(-50.0 * (closing - 2e-3)), rel=1e-9)


def test_a_joint_that_hardens_passes_its_peak_within_one_call():
    once, twice = (row(strength=1e5 / 3, peak=1e5, hardening=2e-3) for _ in range(2))
    crush(once, -4e-3, 1e3)
    first = crush(twice, -2e-3, 1e3)
    crush(twice, -4e-3 + first, 1e3)
    assert once.crushed > 2e-3
    for name in ("crushed", "strength", "integrity"):
        assert getattr(once, name) == pytest.approx(getattr(twice, name), rel=1e-9)


def test_a_joint_that_hardens_and_closes_its_gap_under_shear_stays_below_its_peak():
    bond = row(strength=1e5 / 3, peak=1e5, hardening=2e-3)
    assert crush(bond, -1e-5, 3e4) == pytest.approx(1e-5)
    assert bond.strength == pytest.approx(1e5 / 3 * (1 + 2 * math.sqrt(0.005 * 1.995)), rel=1e-9)


def test_a_joint_that_shear_alone_crushes_gives_way_until_nothing_presses():
    bond = row(strength=1e5)
    assert crush(bond, -2e-4, 5e4) == pytest.approx(2e-4)


def test_cohesion_and_friction_within_what_the_joint_bears():
    assert bonded_limit(row(), 4e3) == pytest.approx(3e3 + 0.75 * 4e3)
    assert bonded_limit(row(integrity=0.5), 4e3) == pytest.approx(1.5e3 + 0.75 * 4e3)
    assert bonded_limit(row(), -4e3) == pytest.approx(3e3)
    assert bonded_limit(row(strength=9e3), 4e3) == pytest.approx(3e3)


def test_slip_wears_cohesion_by_its_energy():
    """A whole bond takes c / (c / G_II) in all: the energy of the line."""
    bond = row(integrity=0.8)
    taken = wear(bond, 1e-4)
    assert bond.integrity == pytest.approx(0.8 * math.exp(-0.5), rel=1e-12)
    assert taken == pytest.approx(3e3 / 5e3 * (0.8 - bond.integrity), rel=1e-12)
    assert wear(bond, 0.0) == 0.0
    assert wear(row(slip_rate=0.0), 1e-4) == 0.0
    assert wear(row(), 1.0) == pytest.approx(3e3 / 5e3)


@pytest.mark.parametrize("hardening", [None, 1e-4])
def test_crushing_that_a_spring_would_outdo_is_refused_with_the_valid_ranges(hardening):
    """Steepest is f_c^2 / (G_c - what hardening takes), here of SAFEGO on its k_n of 2.5e9 N/m3."""
    bond = replace(mr.BONDS["clay brick, SAFEGO"], hardening=hardening)
    steepest = (20e6) ** 2 / (22.2e3 - bond.energy_of_hardening)
    column = {"sides": 4, "k_s": 1e9, "points": 3}
    with pytest.raises(ValueError, match=r"range of k_n is .* that of the crushing_energy") as refused:
        mr.Masonry.column(0.5, 2.0, 2, k_n=2.5e9, bond=bond, **column)
    complaint = [float(word) for word in str(refused.value).split() if "e+" in word]
    assert complaint == pytest.approx([2.5e9, 1.01 * steepest, 1.01 * bond.crushing_energy_on(2.5e9)], rel=0.005)
    assert len(mr.Masonry.column(0.5, 2.0, 2, k_n=1.001 * steepest, bond=bond, **column).bonds) == 2
    enough = replace(bond, crushing_energy=1.001 * bond.crushing_energy_on(2.5e9))
    assert mr.Masonry.column(0.5, 2.0, 2, k_n=2.5e9, bond=enough, **column).bonds[0] == enough


@pytest.mark.parametrize("hardening", [None, 1e-4])
def test_the_least_energy_of_crushing_is_that_of_the_spring_and_of_hardening(hardening):
    """At f_c it holds f_c^2 / k_n on its way down, and before that the area under f_c (1 + 2 sqrt(2 x - x^2)) / 3."""
    bond = replace(mr.BONDS["clay brick, SAFEGO"], hardening=hardening)
    x = (np.arange(100_000) + 0.5) / 100_000
    before = (
        0.0 if hardening is None else float((bond.crushing * (1 + 2 * np.sqrt(2 * x - x**2)) / 3).mean() * hardening)
    )
    assert bond.energy_of_hardening == pytest.approx(before, rel=1e-6)
    assert bond.crushing_energy_on(5e10) == pytest.approx(bond.crushing**2 / 5e10 + before, rel=1e-6)


def test_a_joint_that_is_not_crushed_takes_no_energy_of_crushing():
    bond = mr.Bond(2e5, 3e5, 18.0, 125.0)
    assert (bond.steepest, bond.crushing_energy_on(1e9), bond.energy_of_hardening) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("tension", "energy", "doubted"),
    [(1e4, 0.0599, True), (9.99e3, 0.0599, False), (1.9e4, 0.0599, True), (1e4, 0.06, False)],
)
@pytest.mark.parametrize("name", ["opening_energy", "slip_energy"])
def test_energies_below_those_of_mortar_are_doubted_where_the_tension_is_that_of_mortar(tension, energy, doubted, name):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        mr.Bond(tension, 0.0, **{"opening_energy": 1.0, "slip_energy": 1.0, name: energy})
    assert [f"{name} = {energy:g} J/m2" in str(each.message) for each in caught] == [True] * doubted
