import dataclasses
import math
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.damping.law import CALIBRATED, HIGHEST_XI, BedLaw, CornerLaw, PowerLaw, SideLaw
from mjrock.study.campaign.campaign import completed
from mjrock.study.matching import match
from mjrock.study.matching.calibration import Plan, regress
from mjrock.study.matching.match import REFERENCE, Combination, Match, combinations, highest_branch, least_difference

BOUNDS = (1e-3, 0.3)


def test_the_search_takes_the_highest_branch():
    def falling(xi):
        return 1 - xi

    found = highest_branch(falling, 0.9, BOUNDS)
    assert found.reached
    assert found.xi == pytest.approx(0.1, rel=2e-3)
    assert (found.lowest, found.highest) == (pytest.approx(0.7), pytest.approx(0.999))

    def humped(xi):
        return math.exp(-(math.log(xi / 0.02) ** 2))

    target = humped(0.05)
    assert humped(0.008) == pytest.approx(target, abs=2e-3)  # the low branch has it too
    assert highest_branch(humped, target, BOUNDS).xi == pytest.approx(0.05, rel=5e-3)


def test_what_cannot_be_reached_is_reported_with_the_range():
    low = highest_branch(lambda xi: 0.96 + 0.02 * math.exp(-xi / 0.05), 0.95, BOUNDS)
    assert not low.reached
    assert low.lowest > 0.95
    assert low.xi == pytest.approx(HIGHEST_XI)
    high = highest_branch(lambda xi: 0.96 + 0.02 * math.exp(-xi / 0.05), 0.99, BOUNDS)
    assert not high.reached
    assert high.highest == pytest.approx(0.98, abs=1e-3)


def test_a_jump_over_the_target_is_no_match():
    found = highest_branch(lambda xi: 0.5 if xi < 0.02 else 0.0, 0.3, BOUNDS)
    assert not found.reached


def test_an_overdamped_end_does_not_hide_the_branch():
    found = highest_branch(lambda xi: 1 - xi if xi < 0.2 else 0.85, 0.82, BOUNDS, whole=False)
    assert not found.reached or found.xi == pytest.approx(0.18, rel=1e-2)
    assert highest_branch(lambda xi: 1 - xi if xi < 0.2 else 0.85, 0.92, BOUNDS).xi == pytest.approx(0.08, rel=5e-3)


def test_the_least_difference_is_found_inside_or_reported():
    assert least_difference(lambda xi: math.log(xi / 0.04) ** 2, BOUNDS).xi == pytest.approx(0.04, rel=0.02)
    assert not least_difference(lambda xi: -xi, BOUNDS).reached


def test_a_match_reproduces_what_it_was_asked_for():
    e = mr.Restitution.from_geometry(REFERENCE.wall.alpha)
    base = Match(REFERENCE, e)
    row = base()
    assert set(row) == set(Match.COLUMNS)
    assert row["reached"] == 1
    assert base.restitution(row["xi"]) == pytest.approx(e.base, rel=1e-4)
    side = Match(REFERENCE, e, xi_base=row["xi"])
    assert side.target == pytest.approx(abs(e.lumped))
    matched = side()
    assert side.restitution(matched["xi"]) == pytest.approx(abs(e.lumped), rel=1e-3)
    assert side.restitution(2 * matched["xi"]) < 0.8 * abs(e.lumped)


def test_the_two_measures_agree_on_corner_lines():
    e = mr.Restitution.from_geometry(REFERENCE.wall.alpha)
    row = Match(REFERENCE, e, measure="rms")()
    assert row["reached"] == 1
    assert row["rms"] < 0.01
    assert row["found"] == pytest.approx(e.base, rel=0.01)
    with pytest.raises(ValueError, match="measure = 'speed' is not one of restitution, rms"):
        Match(REFERENCE, e, measure="speed")


def test_less_than_housner_is_out_of_reach_of_corner_lines():
    row = Match(REFERENCE, mr.Restitution(0.9, -0.5))()
    assert row["reached"] == 0
    assert row["lowest"] == pytest.approx(0.9605, abs=1e-3)


def test_size_and_density_drop_out():
    e = mr.Restitution.from_geometry(REFERENCE.wall.alpha)
    small, large = (Match(Combination(R=R), e).restitution(0.05) for R in (1.4, 2.8))
    assert small == pytest.approx(large, rel=1e-5)
    heavy = dataclasses.replace(REFERENCE.wall, density=4000.0)
    contacts = mr.Contacts.from_damping(heavy, k_base=1e9, xi_base=0.05)
    case = mr.Case(heavy, 0.5 * heavy.alpha, 2.0, side_stop=False)
    assert mr.simulate(case, contacts, accuracy=1e-4).restitution[0] == pytest.approx(small, rel=1e-5)
    assert Match(Combination(k_base=1e8), e).restitution(0.05) != pytest.approx(small, rel=1e-3)


def test_combinations_fill_table_1_and_seeds_share_none():
    fit, unseen = combinations(64, 1), combinations(64, 1001)
    assert not set(fit) & set(unseen)
    assert fit == combinations(64, 1)
    for name, (low, high) in {"R": (1.4, 2.8), "slenderness": (4, 15), "k_base": (5e7, 3e9)}.items():
        values = np.array([getattr(one, name) for one in fit])
        assert low <= values.min() < low * 1.2
        assert high / 1.2 < values.max() <= high


CORNER = CornerLaw(2.5, 1.8, 0.3, 0.12, -0.5, 15.0)


@pytest.mark.parametrize("form", [CORNER, BedLaw(0.16, 8.0, 1.3, 0.55), SideLaw(0.2, -1.5, -0.5, 1.2, 0.4, 6.0)])
def test_the_regression_recovers_a_law_from_what_it_predicts(form):
    plan = Plan(base_count=30, side_count=30)
    tasks = plan.side_tasks(2, CORNER) if isinstance(form, SideLaw) else plan.base_tasks(2)
    rows = []
    for task in tasks:
        xi = float(form.xi(task.groups, task.loss))
        inside = math.isfinite(xi) and BOUNDS[0] < xi < BOUNDS[1]
        match = "base" if task.xi_base is None else "side"
        rows.append(
            {"reached": inside, "xi": xi, "found": 0.5, "lowest": 0, "highest": 1, "match": match, "measure": ""}
        )
    found = regress(type(form), tasks, rows)
    assert dataclasses.astuple(found.form)[:-1] == pytest.approx(dataclasses.astuple(form)[:-1], rel=1e-3)
    assert found.form.r_squared == pytest.approx(1)
    assert found.held_out == pytest.approx(1)
    assert regress(PowerLaw, tasks, rows).form.r_squared < 0.97
    with pytest.raises(ValueError, match="matched pairs are too few"):
        regress(type(form), tasks[:3], rows[:3])


@pytest.mark.slow
def test_a_second_run_carries_on_from_the_store(tmp_path, monkeypatch):
    tasks = [Match(one, mr.Restitution.from_geometry(one.wall.alpha)) for one in combinations(3, 7)]
    first = completed(tasks[:2], tmp_path / "a.sqlite", workers=1)
    assert [row["slenderness"] for row in first] == [task.combination.slenderness for task in tasks[:2]]
    requested = []
    original = match.simulate
    monkeypatch.setattr(
        match, "simulate", lambda case, *args, **kw: requested.append(case) or original(case, *args, **kw)
    )
    again = completed(tasks, tmp_path / "a.sqlite", executor=ThreadPoolExecutor(1))
    assert again[:2] == first
    assert {case.block for case in requested} == {tasks[2].combination.wall}


@pytest.mark.slow
def test_a_search_that_broke_down_is_an_error(tmp_path):
    tasks = [Match(Combination(k_base=1e4), mr.Restitution(0.95, -0.5))]
    with pytest.raises(RuntimeError, match=r"1 of 1 tasks failed, the first with ValueError: base stiffness"):
        completed(tasks, tmp_path / "a.sqlite", workers=1)


@pytest.mark.slow
def test_the_shipped_law_on_walls_that_it_has_not_seen():
    errors = {True: [], False: []}
    published = []
    for one in combinations(40, 2002):
        e = mr.Restitution.from_geometry(one.wall.alpha)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            xi_base, xi_side = CALIBRATED(one.wall, e, one.k_base, one.k_side)
        errors[False].append(Match(one, e).restitution(xi_base) / e.base - 1)
        side = Match(one, e, xi_base=xi_base)
        errors[True].append(side.restitution(xi_side) / abs(e.lumped) - 1)
        old_base, old_side = mr.PUBLISHED(one.wall, e, one.k_base)
        published.append(dataclasses.replace(side, xi_base=old_base).restitution(old_side) / abs(e.lumped) - 1)
    two, single = (np.abs(errors[sides]) for sides in (False, True))
    assert np.median(two) < 0.01
    assert np.percentile(two, 95) < 0.03
    assert np.median(single) < 0.03
    assert np.percentile(single, 95) < 0.10
    assert np.median(np.abs(published)) > 0.2
