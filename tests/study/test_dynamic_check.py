"""The check by nonlinear dynamic analysis, C8.7.1.2.1.9, against arithmetic by hand and by three solvers."""

import math
import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import mjrock as mr

WALL = mr.Block.from_size(0.6, 4.2, 1.0, 2000.0)
E = mr.Restitution.from_geometry(WALL)
CONTACTS = mr.Contacts.from_law(WALL, E, k_base=3e9, k_side=3e9)


def cases(count, peak, effects=()):
    motions = [mr.GroundMotion.synthetic(peak, 6.0, seed=seed) for seed in range(count)]
    return [mr.Case(WALL, 0.0, 8.0, motion=way, effects=effects) for motion in motions for way in motion.polarities]


def test_by_hand():
    """d_0 by hand: the centroid at 0.3 m and 2.1 m from the toe stands above it after R - 2.1 up and 0.3 m across.

    The maxima are those of R sin(alpha) - R sin(alpha - theta) in each run; the mean is that of the worse polarity.
    """
    runs = [mr.solve_analytical(case, E) for case in cases(8, 2.5)]
    found = mr.dynamic_check(runs, "SLV", natural=True)
    assert found.d_0 == pytest.approx(0.3, rel=1e-12)
    R, alpha = math.hypot(0.3, 2.1), math.atan2(0.3, 2.1)
    maxima = [0.3 - R * math.sin(alpha - max(run.peaks.max(), run.theta.max())) for run in runs]
    assert [run.d for run in found.runs] == pytest.approx(maxima, rel=1e-9)
    worse = [max(maxima[i : i + 2]) for i in range(0, 16, 2)]
    assert found.mean == pytest.approx(sum(worse) / 8, rel=1e-9)
    assert found.capacity == pytest.approx(0.4 * 0.3)
    assert found.holds == (found.mean <= 0.12)
    assert found.lacking == ()
    assert mr.dynamic_check(runs, "SLC", natural=True).capacity == pytest.approx(0.6 * 0.3)
    assert list(found.restitution) == pytest.approx([abs(E.lumped)] * len(found.restitution))
    assert found.restitution


def test_one_wall_that_overturns_fails_all():
    runs = [mr.solve_analytical(case, E) for case in cases(8, 12.0)]
    found = mr.dynamic_check(runs, natural=True)
    assert found.exceeded
    assert math.isinf(found.mean)
    assert not found.holds
    assert "FAILS" in found.table()


def test_the_solvers_give_one_verdict():
    """MuJoCo and explicit steps solve the same contacts; theory has a rigid base, 0.3 % of d_0 beside it here."""
    requested = cases(1, 4.0, mr.Tie(4.0, 2e6, strength=5e3, ultimate=0.05))
    answers = [
        [mr.simulate(case, CONTACTS) for case in requested],
        [mr.solve_explicit(case, CONTACTS) for case in requested],
    ]
    answers.append([mr.solve_analytical(case, E) for case in requested])
    with pytest.warns(
        mr.Implausible, match="1 records, and at least 8 count, more than the 7 .*; natural records, and these are not"
    ):
        found = [mr.dynamic_check(runs) for runs in answers]
    assert len({check.holds for check in found}) == 1
    assert found[0].d_0 == pytest.approx(0.3)  # ties do not raise it
    assert found[1].mean == pytest.approx(found[0].mean, rel=0.02)


def test_rows_of_a_campaign_give_the_same(tmp_path):
    tasks = [mr.Analysis(case, "analytical", e=E) for case in cases(8, 2.5)]
    mr.campaign(tasks, tmp_path / "walls.sqlite", workers=1)
    by_rows = mr.dynamic_check(tasks, store=tmp_path / "walls.sqlite", natural=True)
    assert by_rows.mean == pytest.approx(mr.dynamic_check([t.solve() for t in tasks], natural=True).mean, rel=1e-9)


def test_beside_the_kinematic_check_and_the_floor_of_the_slv():
    """The floor by hand: a_g,SLV / a_g = a_g,SLD / a_g = (0.3 / 2.1) g / 1.35 / peak where displacements give less."""
    case, *_ = cases(1, 2.5)
    check = mr.mechanism_check(case, mr.code_spectrum("EC8 type 1", ag=1.0, soil="D"))
    assert check.ground_ratio == max(check.states["SLV"].ratio, check.a_0 / check.peak)
    weak = mr.mechanism_check(case, mr.GroundMotion.sine(1.0, 4.0, 6))
    assert weak.states["SLV"].ratio < weak.ground_ratio == pytest.approx(0.3 / 2.1 * 9.81 / 1.35 / 1.0)
    assert "at least a_g,SLD / a_g" in weak.table()
    slv = weak.verdicts[1]
    assert slv.capacity / slv.demand == slv.ratio == weak.ground_ratio
    runs = [mr.solve_analytical(one, E) for one in cases(8, 2.5)]
    complaint = mr.dynamic_check(runs, natural=True).table(weak)
    names = ("linear kinematic", "nonlinear kinematic", "dynamic, largest run", "dynamic, mean of maxima")
    assert all(name in complaint for name in names)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: mr.dynamic_check([], "SLV"), "runs = "),
        (lambda: mr.dynamic_check([mr.Analysis(cases(1, 2.0)[0], "analytical", e=E)], "SLD"), "not one of SLV, SLC"),
        (lambda: mr.dynamic_check([mr.Analysis(cases(1, 2.0)[0], "analytical", e=E)]), "give its file as store"),
        (
            lambda: mr.dynamic_check([mr.Analysis(mr.Case(WALL, 0.01, 1.0), "analytical", e=E)]),
            "no horizontal ground motion",
        ),
    ],
)
def test_refused(ask, message):
    with pytest.raises((TypeError, ValueError), match=message):
        ask()


OMEGA = mr.reference_frequency(WALL, 3e9)
RATIO = {
    place: OMEGA * face.damping.sum() / (2 * face.stiffness.sum())
    for place, face in (("ground", CONTACTS.base), ("side", CONTACTS.side))
}
"""xi of both joints, which have the dashpots of the contacts."""


@cache
def curve_of(way, to=0.35):
    return mr.push(masonry_of(way), way, to)


@cache
def masonry_of(way):
    """The wall as masonry on its ground and beside its stop, or mirrored."""
    wall, ground, stop = (-0.3, 0.3, 0.0, 4.2), (-9.0, 9.0, -0.5, 0.0), (-0.9, -0.3, 0.0, 4.2)
    blocks = [
        mr.Polygon([(way * x, z) for x, z in ((a, c), (b, c), (b, d), (a, d))][::way], fixed=name != "wall", name=name)
        for name, (a, b, c, d) in {"ground": ground, "side": stop, "wall": wall}.items()
    ]
    return mr.Masonry(
        blocks,
        3e9,
        frequency=OMEGA,
        xi=lambda joint: RATIO["ground" if joint.is_bed else "side"],
        friction=lambda joint: 5.0 if joint.is_bed else 0.0,
    )


def shaken(count, peak, way=1):
    """Cases of it."""
    motions = [mr.GroundMotion.synthetic(peak, 6.0, seed=seed).scaled(way) for seed in range(count)]
    return [mr.MasonryCase(masonry_of(way), 8.0, motion=one) for motion in motions for one in motion.polarities]


@pytest.mark.slow
def test_masonry_of_one_block_is_checked_as_a_wall():
    """Its push gives half the thickness as d_0, and the maxima are those of the centroid on the same contacts."""
    requested = shaken(1, 4.0)
    runs, walls = map(mr.solve_explicit, requested), (mr.solve_explicit(case, CONTACTS) for case in cases(1, 4.0))
    with pytest.warns(mr.Implausible, match="requires more"):
        found = mr.dynamic_check([*runs], curve=curve_of(1))
    with pytest.warns(mr.Implausible, match="requires more"):
        wall = mr.dynamic_check([*walls])
    assert found.d_0 == pytest.approx(0.3, rel=1e-3)
    assert [run.d for run in found.runs] == pytest.approx([run.d for run in wall.runs], rel=0.01)
    assert found.restitution == ()


@pytest.mark.slow
def test_masonry_from_which_a_block_falls_is_beyond_d_0():
    requested = shaken(1, 15.0)
    with pytest.warns(mr.Implausible, match="requires more"):
        found = mr.dynamic_check([mr.solve_explicit(case) for case in requested], curve=curve_of(1))
    assert math.isinf(found.mean)
    assert not found.holds


@pytest.mark.slow
def test_mirrored_masonry_is_pushed_and_shaken_the_other_way():
    """Its friction sticks rigidly, to 1e-3 of the largest impulse of a step, which is what the two differ by."""
    found = []
    for way in (1, -1):
        runs = [mr.solve_explicit(case) for case in shaken(1, 3.0, way)]
        with pytest.warns(mr.Implausible, match="requires more"):
            found.append(mr.dynamic_check(runs, curve=curve_of(way)))
    assert found[1].d_0 == pytest.approx(found[0].d_0, rel=1e-6)
    assert [run.d for run in found[1].runs] == pytest.approx([run.d for run in found[0].runs], rel=1e-3)


@pytest.mark.slow
def test_masonry_without_its_curve_is_refused():
    case, _ = shaken(1, 3.0)
    runs = [mr.solve_explicit(replace(case, duration=0.5))]
    with pytest.raises(TypeError, match=r"runs\[0\] is masonry, .* take curve, its limit_curve or push along"):
        mr.dynamic_check(runs)
    curve = curve_of(1, 0.01)
    with pytest.raises(ValueError, match=r"curve ends at 0.01\d* m, where 9\d% of its peak is borne; push on"):
        mr.dynamic_check(runs, curve=curve)
    whole = curve_of(1)
    with pytest.raises(ValueError, match=r"runs\[0\] is not of the masonry of curve"):
        mr.dynamic_check([mr.solve_analytical(cases(1, 1.0)[0], E)], curve=whole)
    other = mr.Masonry(masonry_of(1).blocks, 1e9, friction=0.7)
    with pytest.raises(ValueError, match="not of the masonry of curve"):
        mr.dynamic_check([mr.solve_explicit(replace(case, masonry=other, duration=0.5))], curve=whole)
    jack = mr.push(masonry_of(1), mr.Actuator("wall", (-0.3, 2.1), (1, 0), None, 1e6), 0.02)
    with pytest.raises(ValueError, match="curve is that of an Actuator"):
        mr.dynamic_check(runs, curve=jack)


def test_the_verdict_names_its_way_and_asks_for_the_weaker_one():
    """A wall of 0.25 x 2.4 m with a buttress of 0.4 x 2 m behind it: by hand it overturns outwards, about its outer
    edge, at 0.149 g and towards the buttress at 0.407 g. The buttress takes a seventh of the length."""
    ground = mr.Polygon([(-3, -0.5), (3, -0.5), (3, 0), (-3, 0)], fixed=True, name="ground")
    wall = mr.Polygon([(0, 0), (0.25, 0), (0.25, 2.4), (0, 2.4)], density=1800.0)
    buttress = mr.Polygon([(-0.4, 0), (0, 0), (0, 2.0), (-0.4, 2.0)], density=240.0)
    masonry = mr.Masonry([ground, mr.Compound([buttress, wall], name="wall")], k_n=1e9, friction=0.7)
    runs = [mr.solve_explicit(mr.MasonryCase(masonry, 0.5, motion=mr.GroundMotion.half_sine(0.5, 0.2)))]
    masses, x, z = np.array([1080.0, 192.0]), np.array([0.125, -0.2]), np.array([1.2, 1.0])
    about = {1: 0.25 * masses.sum() - masses @ x, -1: masses @ x + 0.4 * masses.sum()}
    by_hand = {way: moment / (masses @ z) for way, moment in about.items()}
    for way, curve in ((way, mr.limit_curve(masonry, way, poses=20)) for way in (1, -1)):
        with warnings.catch_warnings(record=True) as seen:
            warnings.simplefilter("always")
            check = mr.dynamic_check(runs, curve=curve, natural=True)
        assert f"along ({way}, 0)" in repr(check)
        assert f"judged: the centroid of wall along ({way}, 0)" in check.table()
        weaker = [str(one.message) for one in seen if "check that way too" in str(one.message)]
        assert len(weaker) == (by_hand[-way] < by_hand[way])
        for complaint in weaker:
            assert f"{by_hand[way]:.4g} g" in complaint
            assert f"along (1, 0) it bears {by_hand[1]:.4g} g" in complaint
