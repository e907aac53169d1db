"""The check of masonry of blocks by the virtual work of its mechanism, beside walls and beside hand calculations."""

import math

import numpy as np
import pytest
from masonry_blocks import box
from scipy.optimize import brentq

import mjrock as mr

G = mr.GRAVITY
SLV = mr.code_spectrum("NTC 2018", ag=0.18 * G, F0=2.5, Tc=0.33, soil="B")
BASE = mr.Polygon([(-1, -0.5), (6, -0.5), (6, 0), (-1, 0)], fixed=True, name="tower", length=2.0)
PEDESTAL = box(-0.3, 0.3, 0, 0.9, name="pedestal", density=2600.0, length=0.5)
STATUE = mr.Polygon([(-0.225, 0.9), (0.225, 0.9), (0.16, 2.6), (-0.16, 2.6)], name="statue", length=0.5)
FLOOR = box(-2, 2, -0.3, 0, name="floor", fixed=True, length=0.5)


def same(found, wanted, rel=1e-6):
    for name in ("alpha_0", "participation", "a_0", "d_0", "linear_ratio", "ground_ratio"):
        assert getattr(found, name) == pytest.approx(getattr(wanted, name), rel=rel), name
    for state in wanted.states:
        for name in ("capacity", "period", "demand", "ratio"):
            wish = getattr(wanted.states[state], name)
            assert getattr(found.states[state], name) == pytest.approx(wish, rel=rel), (state, name)


def in_space(masonry):
    return mr.Masonry([mr.Polyhedron.prism(block) for block in masonry.blocks], friction=0.7)


@pytest.mark.parametrize("way", [1, pytest.param(-1, marks=pytest.mark.slow)])
def test_one_block_is_the_wall(way):
    """Also one that is weaker one way: its face is plumb on the side to which it turns, or on the other one."""
    profile = [(0, 0.6), (1.5, 0.6), (1.5, 0.4), (4, 0.4)]
    wall = mr.Block.from_size(0.6, 4.0, 1.0, 1800.0, profile=profile, plumb="outer")
    mirrored = mr.Block.from_size(0.6, 4.0, 1.0, 1800.0, profile=profile, plumb="inner")
    curve = mr.limit_curve(mr.Masonry.stack([wall], friction=0.7), way)
    found = mr.mechanism_check(curve, SLV)
    same(found, mr.mechanism_check(mr.Case(wall if way > 0 else mirrored, 0.0, 1.0), SLV))
    assert found.moving == ("block_0",)


@pytest.mark.slow
def test_one_block_in_space_is_the_wall():
    wall = mr.Block.from_size(0.5, 4.0, 2.0, 1800.0)
    curve = mr.limit_curve(in_space(mr.Masonry.stack([wall])), (1, 0))
    same(mr.mechanism_check(curve, SLV), mr.mechanism_check(mr.Case(wall, 0.0, 1.0), SLV))


def test_added_masses_and_loads_are_those_of_the_wall():
    wall = mr.Block.from_size(0.6, 4.0, 1.0, 1800.0)
    effects = mr.AddedMass(900.0, 4.0, -0.1), mr.Load(6e3, 4.0, 0.05)
    masonry = mr.Masonry.stack([wall], friction=0.7)
    named = mr.AddedMass(900.0, 4.0, -0.1, block="block_0"), mr.Load(6e3, 4.0, 0.05, block="block_0")
    found = mr.mechanism_check(mr.limit_curve(masonry, 1, effects=named), SLV)
    wanted = mr.mechanism_check(mr.Case(wall, 0.0, 1.0, effects=effects), SLV)
    assert wanted.participation < 0.97
    same(found, wanted)


def test_ties_are_slack_in_alpha_0_and_at_their_strength_in_alpha_tied():
    """By moments about the toe: 10 kN at 3.5 m, on a wall of 0.6 x 4 m."""
    wall = mr.Block.from_size(0.6, 4.0, 1.0, 1800.0)
    tie = mr.Tie(height=3.5, stiffness=1e7, strength=10e3, ultimate=0.02, block="block_0")
    found = mr.mechanism_check(mr.limit_curve(mr.Masonry.stack([wall], friction=0.7), 1, effects=tie, poses=20), SLV)
    assert found.alpha_0 == pytest.approx(0.15)
    assert found.alpha_tied == pytest.approx(0.15 + 10e3 * 3.5 / (wall.weight * 2.0))
    assert found.linear_ratio == pytest.approx(2 * found.alpha_tied * G / 1.35 / found.peak)


TIED = mr.Block.from_size(0.6, 4.0, 1.0, 1800.0)
SOFT = {"height": 3.5, "stiffness": 1e6, "strength": 10e3, "length": 5.0}


def test_the_curve_and_its_table_say_where_ties_yield_and_break():
    """By the turn at which the tie is as long, from the geometry of a block about its toe."""
    tie = mr.Tie(**SOFT, ultimate=0.1, block="block_0")
    curve = mr.limit_curve(mr.Masonry.stack([TIED], friction=0.7), 1, effects=tie)

    def gone(elongation):
        def longer(turn):
            x, z = 0.6 - 0.6 * math.cos(turn) + 3.5 * math.sin(turn), 3.5 * math.cos(turn) + 0.6 * math.sin(turn) - 3.5
            return math.hypot(5.0 + x, z) - 5.0 - elongation

        turn = brentq(longer, 0.0, 0.3)
        return 0.3 * (1 - math.cos(turn)) + 2.0 * math.sin(turn)

    yielding, breaking = curve.ties
    assert yielding == {"tie_0": pytest.approx(gone(0.01), rel=1e-3)}
    assert breaking == {"tie_0": pytest.approx(gone(0.11), rel=1e-3)}
    drop = np.diff(curve.multiplier).argmin()  # the tie falls out between two poses
    assert curve.displacement[drop] < breaking["tie_0"] < curve.displacement[drop + 1]
    assert -np.diff(curve.multiplier)[drop] > 0.9 * 10e3 * 3.5 / (TIED.weight * 2.0)
    found = mr.mechanism_check(curve, SLV)
    wall = mr.mechanism_check(mr.Case(TIED, 0.0, 1.0, effects=mr.Tie(**SOFT, ultimate=0.1)), SLV)
    for name in ("yielding", "breaking"):
        assert getattr(found, name)["tie_0"] == pytest.approx(getattr(wall, name)["tie_0"], rel=1e-3)
    assert found.table().splitlines()[1:] == wall.table().splitlines()
    assert "without tie_0, broken" in found.table()


def test_ties_that_never_break_are_warned_of_as_those_of_a_wall():
    """4 kN at 3.5 m hold a wall of 42 kN at a turn at which it would fall without them."""
    tie = mr.Tie(3.5, 1e6, strength=4e3, length=5.0, block="block_0")
    with pytest.warns(mr.Implausible, match=r"d_SLC = .* curve without ties has ended: tie_0 \(ultimate = None\)"):
        mr.mechanism_check(mr.limit_curve(mr.Masonry.stack([TIED], friction=0.7), 1, effects=tie, poses=20), SLV)
    with pytest.warns(mr.Implausible, match=r"d_SLC = .* at which the curve without ties ends: tie_0"):
        mr.mechanism_check(mr.Case(TIED, 0.0, 1.0, effects=mr.Tie(3.5, 1e6, strength=4e3, length=5.0)), SLV)


def test_a_curve_that_ends_early_is_checked_up_to_its_end():
    """An arch, in which a further joint opens: shares of the displacement up to there, and the period of the curve."""
    curve = mr.limit_curve(mr.Masonry.arch(radius=5.0, thickness=0.9), 1)
    assert curve.ended == "another joint begins to open"
    with pytest.warns(mr.Implausible, match=r"case ends at d = .* another joint begins to open; the check takes that"):
        check = mr.mechanism_check(curve, SLV)
    masonry = curve.start.masonry
    rows = [masonry.free.index(masonry.names.index(name)) for name in check.moving]
    mass = np.array([masonry.blocks[masonry.free[row]].mass for row in rows])
    end = mass @ curve.pose[-1][rows, 0] / mass.sum() / check.participation
    assert check.d_0 == pytest.approx(end, rel=1e-12)
    capacity = 0.4 * end
    held = np.interp(capacity, check.d, curve.multiplier) * G / (check.participation * 1.35)
    slv = check.states["SLV"]
    assert (slv.capacity, slv.period) == pytest.approx((capacity, 1.68 * math.pi * math.sqrt(capacity / held)))
    assert check.table().splitlines()[1].split("  ")[-1].strip() == "another joint begins to open"
    shaken = mr.MasonryCase(masonry, 0.02, motion=mr.GroundMotion([0.0, -0.1, 0.0], 0.01))
    with pytest.raises(ValueError, match="ends where something is borne; give it up to where nothing is, or take the"):
        mr.dynamic_check([mr.solve_explicit(shaken)], curve=curve)


def belfry():
    left = box(0, 0.9, 0, 4.5, name="left", length=2.0, density=1800.0)
    right = box(4.1, 5, 0, 4.5, name="right", length=2.0, density=1800.0)
    cap = box(-0.1, 5.1, 4.5, 5.7, name="cap", length=2.0, density=1400.0)
    return mr.Masonry([BASE, left, right, cap], k_n=1e9, friction=0.6)


def test_two_pillars_and_a_roof_by_hand():
    """The ten lines of a spreadsheet. Pillars turn about their toes, and the roof goes with their tops.

    At a rotation theta the roof is at 0.9 (1 - cos theta) + 4.5 sin theta, a pillar at half of it, and
    tan(alpha - theta) is borne.
    """
    demand = SLV.at_height(0.05 * 24.0**0.75, participation=1.4, height=0.8)
    check = mr.mechanism_check(mr.limit_curve(belfry(), 1, poses=30), demand)
    P = G * np.array([1800 * 0.9 * 4.5 * 2, 1800 * 0.9 * 4.5 * 2, 1400 * 5.2 * 1.2 * 2])
    delta = np.array([2.25, 2.25, 4.5])
    alpha_0 = P @ (0.45, 0.45, 0.9) / (P @ delta)
    e_star = (P @ delta) ** 2 / (P.sum() * (P @ delta**2))
    a_0 = alpha_0 * G / (e_star * 1.35)
    d_0 = P @ (0.45, 0.45, 0.9) / P.sum() / e_star
    rows = check.alpha_0, check.participation, check.a_0, check.d_0, check.linear_ratio
    assert rows == pytest.approx((0.2, e_star, a_0, d_0, 2 * a_0 / demand.peak), rel=1e-6)
    assert alpha_0 == pytest.approx(0.2)
    for state, share, factor, damping in (("SLV", 0.4, 1.68, 0.08), ("SLC", 0.6, 1.56, 0.10)):
        capacity, roof = share * d_0, share * 0.9
        theta = brentq(lambda turn, roof=roof: 0.9 * (1 - math.cos(turn)) + 4.5 * math.sin(turn) - roof, 0.0, 0.2)
        period = factor * math.pi * math.sqrt(capacity / (math.tan(math.atan(0.2) - theta) * G / (e_star * 1.35)))
        found = check.states[state]
        wanted = capacity, period, demand.displacement(period, damping)
        assert (found.capacity, found.period, found.demand) == pytest.approx(wanted, rel=1e-5)
    assert set(check.moving) == {"left", "right", "cap"}
    assert check.table().splitlines()[0].split(None, 2)[2].strip() == "left, right, cap"


def test_of_a_statue_on_a_pedestal_the_statue_is_judged():
    """It turns about its own edge: alpha_0 = 0.225 / z, e* = 1 and d_0 = 0.225 m, where the common centroid of both
    has gone by less."""
    masonry = mr.Masonry([FLOOR, PEDESTAL, STATUE], k_n=1e9, friction=0.6)
    curve = mr.limit_curve(masonry, 1, poses=30)
    check = mr.mechanism_check(curve, SLV)
    assert check.moving == ("statue",)
    assert check.alpha_0 == pytest.approx(0.225 / (STATUE.centroid[1] - 0.9))
    assert check.participation == pytest.approx(1.0)
    assert check.d_0 == pytest.approx(0.225, rel=1e-6)
    assert curve.d_0 == pytest.approx(0.225 * STATUE.mass / (STATUE.mass + PEDESTAL.mass), rel=1e-6)
    assert repr(check).startswith("<MechanismCheck of statue: starts at 0.2")


def test_runs_are_judged_by_the_block_that_moves():
    masonry = mr.Masonry([FLOOR, PEDESTAL, STATUE], k_n=1e9, friction=0.6)
    curve = mr.limit_curve(masonry, 1, poses=30)
    t = np.arange(0, 1.0, 0.01)
    pulse = mr.GroundMotion(-4.0 * np.sin(2 * math.pi * t / 0.5) * (t < 0.5), 0.01)
    runs = [mr.solve_explicit(mr.MasonryCase(masonry, 1.2, motion=motion)) for motion in pulse.polarities]
    with pytest.warns(mr.Implausible, match="requires more"):
        check = mr.dynamic_check(runs, curve=curve, natural=True)
    assert check.d_0 == pytest.approx(0.225, rel=1e-6)
    rows = masonry.free.index(masonry.names.index("statue"))
    largest = [max(run.pose[:, rows, 0].max(), 0.0) for run in runs]
    assert max(largest) > 0.01
    assert [run.d for run in check.runs] == pytest.approx(largest)


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (
            lambda: mr.limit_curve(mr.Masonry.stack([mr.Block.from_size(0.6, 1.0)], friction=0.1), 1),
            r"slide> ends as it begins. Of it the linear check alone .* alpha_0 = 0.1 and e\* = 1; .* curve=push",
        ),
        (
            lambda: mr.limit_curve(mr.Masonry.stack([mr.Block.from_size(0.6, 3.0)]), 1, to=0.05, poses=9),
            "leave out to",
        ),
        (lambda: mr.Masonry.stack([mr.Block.from_size(0.6, 1.0)]), r"take mr.limit_curve\(masonry, direction\)"),
    ],
)
def test_what_has_no_end_is_refused(make, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        mr.mechanism_check(make(), SLV)
