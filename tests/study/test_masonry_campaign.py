"""Campaigns of masonry: one row a case, kept histories, and tasks that tell themselves apart."""

import pickle

import numpy as np
import pytest
from masonry_blocks import columns

import mjrock as mr
from mjrock.study.campaign.task import fingerprint


def analysis(peak, blocks=2, **options):
    case = mr.MasonryCase(columns(blocks), 0.8, mr.GroundMotion.sine(peak, 0.7))
    return mr.MasonryAnalysis(case, options, labels={"peak": peak})


@pytest.mark.slow
def test_rows_and_histories(tmp_path):
    tasks = [analysis(2.0), analysis(-2.0)]
    path = mr.campaign(tasks, tmp_path / "c.sqlite", workers=1, histories=tmp_path / "histories")
    with mr.Store(path) as store:
        rows = store.rows()
    answer = tasks[0].solve()
    assert [row["peak"] for row in rows] == [2.0, -2.0]
    assert rows[0]["largest_rotation_rad"] == answer.peak.max()
    assert rows[0]["largest_opening_m"] == answer.opening.max()
    assert rows[0]["fallen"] == 0
    assert rows[0]["first_fall_s"] is None
    kept = {len(np.load(file)["t"]) for file in (tmp_path / "histories").glob("*.npz")}
    assert kept == {len(answer.t)}
    assert rows[0]["largest_rotation_rad"] == pytest.approx(rows[1]["largest_rotation_rad"], rel=1e-6)


def test_what_tells_tasks_apart():
    assert fingerprint(analysis(2.0)) == fingerprint(analysis(2.0))
    assert fingerprint(pickle.loads(pickle.dumps(analysis(2.0)))) == fingerprint(analysis(2.0))
    assert len({fingerprint(task) for task in (analysis(2.0), analysis(2.1), analysis(2.0, 3))}) == 3
    assert fingerprint(analysis(2.0, accuracy=1e-2)) != fingerprint(analysis(2.0))


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: mr.MasonryAnalysis(columns(1)), "case = .* is not a Case or MasonryCase"),
        (lambda: analysis(1.0, precision=2), "MuJoCo has no option precision; it has timestep, accuracy"),
        (
            lambda: mr.MasonryAnalysis(mr.MasonryCase(columns(1), 1.0), labels=3),
            "labels = 3 of type int is not a mapping",
        ),
    ],
)
def test_what_cannot_be(make, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        make()
