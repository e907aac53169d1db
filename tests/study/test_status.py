"""The last line of a campaign, and its status from the command line."""

import subprocess
import sys
import warnings

import pytest
from campaign_tasks import Square

import mjrock as mr
from mjrock.study.campaign.progress import closing_line, status

WALL = mr.Block.from_size(0.6, 4.2)
E = mr.Restitution.from_geometry(WALL)


def released(share):
    case = mr.Case(WALL, share * WALL.alpha, 0.5, side_stop=False)
    return mr.Analysis(case, "analytical", e=E, labels={"share": share})


@pytest.mark.slow
def test_the_last_line_and_the_status(tmp_path, capsys):
    path = tmp_path / "walls.sqlite"
    mr.campaign([released(0.5), released(1.1)], path, workers=1)
    last = capsys.readouterr().err.splitlines()[-1]
    assert last.startswith("campaign: 2 of 2 tasks have a row: 2 done, 0 failed (1 overturned, 1 time ended) in ")
    mr.campaign([released(0.5), released(1.1), Square(-2)], path, workers=1)
    last = capsys.readouterr().err.splitlines()[-1]
    assert last.startswith("campaign: 3 of 3 tasks have a row: 0 done, 1 failed in ")
    assert last.endswith(", 2 had a row before")
    first, outcomes, _, version, failed = status(path).splitlines()
    assert first == f"{path}: 3 rows, 2 done, 1 failed"
    assert outcomes == "outcomes: 1 overturned, 1 time ended"
    assert version.startswith(f"made by: 3 mjrock {mr.__version__}")
    assert failed.startswith("failed once: ")


def test_a_campaign_that_was_broken_off_says_what_is_left():
    line = closing_line(100, {"done": 48, "failed": 2}, {"at rest": 48}, 61.2, 384)
    assert line == (
        "150 of 384 tasks have a row: 48 done, 2 failed (48 at rest) in 61.2 s, 100 had a row before, 234 left; "
        "the same call carries on"
    )
    assert closing_line(0, {"done": 2}, {}, 1.0, None) == "2 tasks have a row: 2 done, 0 failed in 1 s"


@pytest.mark.slow
def test_the_command_line(tmp_path):
    mr.campaign([released(0.5)], tmp_path / "walls.sqlite", workers=1)

    def requested(*arguments):
        command = [sys.executable, "-m", "mjrock", *arguments]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)

    assert requested("status", "walls.sqlite").stdout.startswith("walls.sqlite: 1 rows, 1 done, 0 failed\n")
    assert "there is no such campaign" in requested("status", "none.sqlite").stderr
    assert requested("status", "none.sqlite").returncode == 2
    assert "invalid choice: 'stat'" in requested("stat").stderr
    assert requested().returncode == 0


def test_reading_rows_does_not_warn_again_of_what_the_run_has_warned_of(tmp_path):
    """A grid makes its tasks anew, and a weak record is doubted as its case is made."""

    def build(peak):
        motion = mr.GroundMotion.sine(peak, 0.5)
        return mr.Analysis(mr.Case(WALL, 0.0, 1.0, motion=motion), "analytical", e=E)

    grid = mr.Grid(build, peak=[0.05, 3.0])
    mr.campaign(grid, tmp_path / "walls.sqlite", workers=1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rows = mr.results(grid, tmp_path / "walls.sqlite")
    assert [row["peak"] for row in rows] == [0.05, 3.0]


def test_errors_of_a_grid_are_counted_by_their_kind(tmp_path):
    """Two walls of different numbers and points fail alike, a third by another error."""

    def build(wall, share):
        if wall == "other":
            raise ValueError("another error")
        return released(share)

    path = tmp_path / "walls.sqlite"
    mr.campaign(mr.Grid(build, wall=["a", "b", "other"], share=[50.0, 60.0]), path, workers=1)
    *_, often, seldom = status(path).splitlines()
    assert often.startswith("failed 4 times, first: ValueError: release rotation theta0 = ")
    assert "(at wall = a, share = 50.0)" in often
    assert seldom.startswith("failed 2 times, first: ValueError: another error")
