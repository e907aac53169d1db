"""The check by nonlinear dynamic analysis, C8.7.1.2.1.9, against arithmetic by hand and by three solvers."""

import math

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
    asked = cases(1, 4.0, mr.Tie(4.0, 2e6, strength=5e3, ultimate=0.05))
    answers = [[mr.simulate(case, CONTACTS) for case in asked], [mr.solve_explicit(case, CONTACTS) for case in asked]]
    answers.append([mr.solve_analytical(case, E) for case in asked])
    with pytest.warns(mr.Implausible, match="1 records, and more than the 7 .*; natural records, and these are not"):
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
    runs = [mr.solve_analytical(one, E) for one in cases(8, 2.5)]
    said = mr.dynamic_check(runs, natural=True).table(weak)
    names = ("linear kinematic", "nonlinear kinematic", "dynamic, largest run", "dynamic, mean of maxima")
    assert all(name in said for name in names)


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
