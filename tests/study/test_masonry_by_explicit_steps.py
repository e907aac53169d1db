"""Studies take masonry by explicit steps as they take a wall: one small column, short, in each of them."""

import dataclasses
import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from everyday import slow

import mjrock as mr
from mjrock import plotting

COLUMN = mr.Masonry.stack([mr.Block.from_size(0.6, 0.9)] * 2, k_n=1e8, xi=0.05, friction=0.8)
STOPS = mr.Masonry.box((0.4, 0.4, 1.0), k_n=1e8, xi=0.05)


def analysis(scale=3.0, duration=0.5, k_n=1e8, **options):
    """The column under a half sine of so many m/s2."""
    masonry = dataclasses.replace(COLUMN, k_n=k_n)
    motion = mr.GroundMotion.half_sine(scale, duration)
    return mr.MasonryAnalysis(mr.MasonryCase(masonry, 1.0, motion=motion), options, solver="explicit")


def falls(scale):
    """The same with a longer pulse, under which it falls soon."""
    return analysis(scale, 0.8)


def test_an_analysis_has_the_row_of_its_solver():
    row, answer = analysis()(), mr.solve_explicit(analysis().case)
    assert row["solver"] == "explicit"
    assert row["largest_rotation_rad"] == answer.peak.max()
    assert row["largest_sliding_m"] == answer.sliding.max()
    assert analysis().law == "given"
    assert mr.MasonryAnalysis(mr.MasonryCase(COLUMN, 1.0)).solver == "MuJoCo"


def test_a_campaign(tmp_path):
    cases = [analysis(scale) for scale in (2.0, 3.0)]
    by_mujoco = mr.MasonryAnalysis(dataclasses.replace(cases[0].case, duration=0.1))
    short = dataclasses.replace(by_mujoco, solver="explicit")
    path = mr.campaign([*cases, by_mujoco, short], tmp_path / "c.sqlite", workers=1, histories=tmp_path / "histories")
    with mr.Store(path) as store:
        rows = store.rows()
        assert len(store.rows(solver="explicit")) == 3
    assert [row["solver"] for row in rows] == ["explicit", "explicit", "MuJoCo", "explicit"]
    assert rows[0]["largest_rotation_rad"] < rows[1]["largest_rotation_rad"] < 0.2
    assert rows[2]["largest_rotation_rad"] == pytest.approx(rows[3]["largest_rotation_rad"], rel=0.05)
    kept = [np.load(file) for file in (tmp_path / "histories").glob("*.npz")]
    assert {one["pose"].shape[1:] for one in kept} == {(2, 3)}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.* resamples of 5 groups gave no curve:UserWarning")
def test_an_incremental_analysis_and_its_fragility(tmp_path):
    builds = {f"record {i}": lambda scale, i=i: falls(scale * (1 + 0.2 * i)) for i in range(5)}
    found = mr.ida(builds, [4.0, 5.0], tmp_path / "ida.sqlite", workers=1)
    assert np.isfinite(found.peaks[0]).all()
    assert np.isinf(found.peaks[4]).all()
    for rows, peaks in zip(found.rows, found.peaks, strict=True):
        assert (mr.lost(rows) == np.isinf(peaks)).all()
    assert 4.0 < found.fragility(resamples=20).median < 5.0


def test_rows_of_masonry_say_whether_it_is_lost(tmp_path):
    found = mr.ida(falls, [3.0, 8.0], tmp_path / "ida.sqlite", executor=ThreadPoolExecutor(1))
    assert np.isinf(found.peaks).tolist() == [[False, True]]
    assert mr.lost(found.rows[0]).tolist() == [False, True]
    with pytest.raises(ValueError, match="no result of a wall or of masonry"):
        mr.lost([{"outcome": "overturned"}])


@pytest.mark.parametrize("tolerance", [0.2, slow(0.05)])
def test_a_capacity(tolerance):
    capacity = mr.Capacity(falls(4.0), tolerance=tolerance, below=1)
    row = capacity()
    assert row["solver"] == "explicit"
    assert capacity.scaled(row["capacity_scale"]).solve().fallen
    assert row["stands_at_g"] < row["capacity_g"] == pytest.approx(row["capacity_scale"] * 4.0 / mr.GRAVITY)
    assert row["message"].startswith("The masonry falls at")
    # below friction and the rigid column's b/h nothing moves
    assert row["stands_at_g"] > 0.6 / 1.8


def test_the_capacity_in_space_scales_motion_across():
    case = mr.MasonryCase(STOPS, 0.5, transverse=mr.GroundMotion.half_sine(3.0, 0.3))
    capacity = mr.Capacity(mr.MasonryAnalysis(case, solver="explicit"))
    assert capacity.peak == pytest.approx(3.0 / mr.GRAVITY)
    assert capacity.scaled(2.0).case.transverse.peak == pytest.approx(6.0)
    with pytest.raises(ValueError, match="has no horizontal motion to scale"):
        mr.Capacity(mr.MasonryAnalysis(mr.MasonryCase(STOPS, 0.5), solver="explicit"))


def test_sensitivity():
    found = mr.sensitivity(analysis, {"scale": 3.0}, {"k_n": [1e8, 3e8]}, executor=ThreadPoolExecutor(1))
    assert found.measure == "largest_rotation_rad"
    assert found.unit == "rad"
    assert found.governs == "k_n"
    assert 0 < found.range[0] < found.range[1] < math.inf


def test_a_report_and_histories(tmp_path):
    answers = [analysis().solve(), falls(7.0).solve()]
    tied = mr.Tie(height=1.7, stiffness=1e5, block=2)
    case = dataclasses.replace(analysis().case, effects=(tied,))
    path = mr.report(case, answers, tmp_path / "column.html", labels=["stands", "falls"], basis={"k_n": "two cores"})
    text = path.read_text(encoding="utf-8")
    for complaint in (
        "Motion of masonry",
        "2 free, 1 fixed",
        "MN/m³",
        "two cores",
        "holds without slip",
        "The blocks are rigid",
    ):
        assert complaint in text
    assert "block_1 at" in text
    assert text.count("<img") == 4  # the masonry with the tie, as that of the runs is; maxima, histories and ends
    with pytest.raises(ValueError, match=r"responses\[0\] is of masonry, and the case of other masonry"):
        mr.report(dataclasses.replace(case, masonry=STOPS, effects=()), answers, tmp_path / "a.html")
    with pytest.raises(ValueError, match="leave e and contacts out"):
        mr.report(case, answers, tmp_path / "a.html", e=mr.Restitution(0.9, 0.9))
    figure = plotting.history(answers[0])
    assert [ax.get_ylabel() for ax in figure.axes] == ["base [m/s²]", "farthest block [mm]"]
    (line, _, *_) = figure.axes[1].get_lines()
    far = np.hypot(*answers[0].pose[:, :, :2].T).max()
    assert np.max(line.get_ydata()) == pytest.approx(1e3 * far)


def test_a_history_of_a_fall_has_a_cross():
    answer = falls(7.0).solve()
    (_, crosses) = plotting.history(answer).axes[1].get_lines()
    assert crosses.get_xdata().tolist() == list(answer.fallen.values())


@pytest.mark.parametrize("solver", ["compliant", "analytical", "explicite", None])
def test_a_solver_that_does_not_take_masonry(solver):
    with pytest.raises(ValueError, match=r"solver = .* is not one of MuJoCo, explicit, which take masonry"):
        mr.MasonryAnalysis(mr.MasonryCase(COLUMN, 1.0), solver=solver)
