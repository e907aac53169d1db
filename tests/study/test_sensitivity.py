"""How an answer changes with what is not known, and the intensity that overturns a wall as a task."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

import mjrock as mr
from mjrock import plotting
from mjrock.study.campaign.task import Grid
from mjrock.study.intensity.ida import bracket, halved, lowest

OPTIONS = {"rtol": 1e-6}


@pytest.fixture(scope="module")
def build(wall, e):
    """A wall under a half sine of so many times g alpha, in rocking theory."""

    def of(scale=2.0, duration=0.5, sign=-1.0):
        motion = mr.GroundMotion.half_sine(sign * scale * mr.GRAVITY * wall.alpha, duration)
        return mr.Analysis(mr.Case(wall, 0.0, 2.0, motion=motion), "analytical", e=e, options=OPTIONS)

    return of


class Sum:
    """A task that adds up its settings."""

    def __init__(self, labels=None, **settings):
        self.settings, self.labels, self.COLUMNS = settings, labels or {}, ("total_m",)

    def labelled(self, labels):
        return Sum(labels, **self.settings)


def summed(monkeypatch, calls=None):
    """A sensitivity study of sums, without any campaign."""
    monkeypatch.setattr(
        "mjrock.study.sensitivity.completed",
        lambda tasks, store, **options: [
            {**task.labels, "total_m": sum(task.settings.values())}
            for task in tasks
            if calls is None or calls.append(task) is None
        ],
    )
    return lambda **settings: Sum(**settings)


def test_one_at_a_time_and_together(monkeypatch):
    calls = []
    build = summed(monkeypatch, calls)
    found = mr.sensitivity(build, {"a": 1.0, "b": 10.0, "c": 100.0}, {"a": [0.0, 4.0], "b": [9.0, 10.0]})
    assert found.measure == "total_m"
    assert found.unit == "m"
    assert found.base_value == 111.0
    assert found.swing("a") == (110.0, 114.0)
    assert found.swing("b") == (110.0, 111.0)
    assert found.range == (109.0, 114.0)
    assert found.governs == "a"
    assert list(found.swings) == ["a", "b"]
    assert found.sentence == "109.00 to 114.00 m, governed by a"
    assert len(calls) == 6  # three values of a by two of b, and none twice
    assert "together" in found.table()
    assert found.csv().splitlines()[0] == "a,b,total_m"
    alone = mr.sensitivity(build, {"a": 1.0, "b": 10.0}, {"a": [0.0, 4.0], "b": [9.0]}, together=False)
    assert len(alone.rows) == 4
    assert alone.range == (10.0, 14.0)
    assert "together" not in alone.table()


def test_a_setting_that_the_base_leaves_out_has_its_first_value(monkeypatch):
    found = mr.sensitivity(summed(monkeypatch), {}, {"points": [2, 16]})
    assert found.base == {"points": 2}
    assert found.values.tolist() == [2, 16]


def test_overturning_counts_more_than_any_finite_change(monkeypatch):
    build = summed(monkeypatch)
    found = mr.sensitivity(build, {"a": 0.0, "b": 0.5}, {"a": [0.4], "b": [math.inf]})
    assert found.governs == "b"
    assert found.sentence == "0.50 to overturned, governed by b"
    assert plotting.tornado(found).get_yticklabels()[0].get_text() == "b\n0.5 to inf"


def test_values_that_three_digits_do_not_tell_apart(monkeypatch):
    found = mr.sensitivity(summed(monkeypatch), {"a": 0.03681}, {"a": [0.03684]})
    assert found.sentence == "0.03681 to 0.03684 m, governed by a"


def test_what_changes_nothing(monkeypatch):
    found = mr.sensitivity(summed(monkeypatch), {"a": 1.0}, {"a": [1.0]})
    assert found.governs is None
    assert found.sentence == "1.00 m, no setting changes it"
    with pytest.raises(ValueError, match="setting = 'z' of type str is not one of a"):
        found.swing("z")


def test_the_base_has_the_defaults_of_build(monkeypatch):
    def build(a, b=0.5, c=3.0):
        return made(a=a, b=b)

    made = summed(monkeypatch)
    assert mr.sensitivity(build, {}, {"a": [0.1, 0.2], "b": [0.4, 0.6]}).base == {"a": 0.1, "b": 0.5}
    assert mr.sensitivity(build, {"b": 0.7}, {"a": [0.1], "b": [0.4]}).base == {"a": 0.1, "b": 0.7}


def test_of_a_wall_and_resumed(build, tmp_path):
    requested = {"base": {"duration": 0.5, "scale": 1.5, "sign": -1.0}, "vary": {"scale": [1.5, 1.2], "sign": [-1.0]}}
    store = tmp_path / "s.sqlite"
    found = mr.sensitivity(build, store=store, executor=ThreadPoolExecutor(1), **requested)
    assert found.values.tolist() == [build(scale).solve().peak_over_alpha for scale in (1.5, 1.2)]
    assert found.governs == "scale"
    assert found.sentence.endswith("alpha, governed by scale")
    with mr.Store(store) as file:
        assert {row["scale"] for row in file.rows()} == {1.2, 1.5}


def test_rows_of_an_older_study_have_the_settings_of_this_one(build, tmp_path):
    """A store that another study has filled holds runs of the same content whose labels are those of that study."""
    store = tmp_path / "both.sqlite"
    mr.sensitivity(build, {"scale": 2.0}, {"duration": [0.5, 0.4]}, store, workers=1)
    found = mr.sensitivity(build, {"scale": 2.0}, {"duration": [0.5, 0.4], "scale": [3.0]}, store, workers=1)
    settings = [(row["duration"], row["scale"]) for row in found.rows]
    assert settings == [(0.5, 2.0), (0.4, 2.0), (0.5, 3.0), (0.4, 3.0)]
    assert "None" not in plotting.tornado(found).get_yticklabels()[0].get_text()


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"build": 3}, "build = 3 of type int is not a function of settings"),
        ({"base": 3}, "base = 3 of type int is not a mapping of the names of settings"),
        ({"vary": {1: [2]}}, "vary = .* is not a mapping of the names of settings"),
        ({"vary": {}}, "vary is empty; at least one setting is needed"),
        ({"vary": {"scale": []}}, r"vary\['scale'\] = \[\] of type list is not a row of at least one value"),
        ({"vary": {"scale": "ab"}}, r"vary\['scale'\] = 'ab' of type str is not a row"),
        ({"measure": "peak"}, "measure = 'peak' of type str is not one of the columns solver, law, outcome"),
        ({"measure": 3}, "measure = 3 of type int is not a str"),
        ({"together": 3}, "together = 3 of type int is neither True nor False"),
        ({"build": lambda **settings: 3}, "build gives 3 of type int, which is not a task of a campaign"),
    ],
)
def test_what_cannot_be_varied(arguments, complaint, build):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.sensitivity(**{"build": build, "base": {}, "vary": {"scale": [1.0, 1.2]}} | arguments)


def test_a_measure_that_is_text(build):
    with pytest.raises(ValueError, match="measure = 'outcome' is 'at rest' in a row; it has to be a number"):
        mr.sensitivity(build, {}, {"scale": [0.5]}, measure="outcome", executor=ThreadPoolExecutor(1))


def test_the_capacity_is_where_the_outcome_changes(build):
    task = mr.Capacity(build(1.0), tolerance=1e-3)
    row = task()
    assert row["capacity_g"] == pytest.approx(row["capacity_scale"] * task.analysis.case.motion.peak / mr.GRAVITY)
    assert row["stands_at_g"] < row["capacity_g"] <= row["stands_at_g"] * 1.002
    assert build(row["capacity_scale"]).solve().outcome is mr.Outcome.OVERTURNED
    assert build(row["capacity_scale"] * 0.998).solve().outcome is not mr.Outcome.OVERTURNED
    down = mr.Capacity(build(1.0), tolerance=1e-3, start=20.0)()
    assert down["capacity_g"] == pytest.approx(row["capacity_g"], rel=2e-3)
    assert tuple(row) == task.COLUMNS
    assert row["stands_down_to_g"] == pytest.approx(row["stands_at_g"] / 1.02**12, rel=0.03)
    assert row["stands_above_g"] is None


def test_a_capacity_is_the_lowest_that_was_found():
    """The wall falls from 1.27 g on and in a band at 0.8 g; a search from 2.4 g meets the upper edge first."""
    wall = mr.Block.from_size(thickness=0.6, height=4.2)
    motion = mr.GroundMotion.synthetic(peak=4.0, duration=8.0, seed=23)
    analysis = mr.Analysis(mr.Case(wall, 0.0, 11.0, motion=motion), "analytical", e=mr.Restitution.from_geometry(wall))
    alone = mr.Capacity(analysis, tolerance=0.02, start=6.0, below=0)()
    assert alone["message"].endswith("It is an edge: whether a weaker intensity does so too was not looked at.")
    task = mr.Capacity(analysis, tolerance=0.02, start=6.0, below=40, spacing=0.05)
    row = task()
    assert row["capacity_g"] < 0.65 * alone["capacity_g"]
    assert row["stands_above_g"] > row["capacity_g"] > row["stands_at_g"]
    assert "Not monotonic: it stands at " in row["message"]
    assert task.scaled(row["capacity_scale"]).solve().outcome is mr.Outcome.OVERTURNED
    looked = row["stands_at_g"] / row["stands_down_to_g"]
    assert 1.05**39 < looked < 1.05**41
    for i in range(0, 41, 8):
        weaker = task.scaled(row["stands_down_to_g"] * 1.05**i * mr.GRAVITY / 4.0)
        assert weaker.solve().outcome is not mr.Outcome.OVERTURNED
    with pytest.raises(ValueError, match="below = 1001 is outside the valid range 0 to 1000"):
        mr.Capacity(analysis, below=1001)


def test_the_lowest_band_is_found_and_the_count_begins_again():
    """Bands from 3 on, from 2 to 2.2 and from 1.5 to 1.52: a spacing of 5 % meets the second, one of 1 % all three."""
    tried = []

    def falls(scale):
        tried.append(scale)
        return scale >= 3.0 or 2.0 <= scale < 2.2 or 1.5 <= scale < 1.52

    assert lowest(falls, 2.9, 3.0, 0, 0.1) == (2.9, 3.0)
    low, high = lowest(falls, 2.9, 3.0, 10, 0.05)
    assert low < 2.0 <= high < 2.1
    assert high / low == pytest.approx(1.05)
    assert tried[-1] == pytest.approx(low / 1.05**10)
    low, high = lowest(falls, 2.9, 3.0, 40, 0.01)
    assert low < 1.5 <= high < 1.515
    with pytest.raises(ValueError, match=r"the wall overturns at scales down to 2\.\d+e-06"):
        lowest(lambda scale: True, 2.9, 3.0, 3, 0.1)


def test_capacities_are_tasks_of_a_grid(build):
    grid = Grid(lambda scale: mr.Capacity(build(scale)), scale=[1.0, 2.0])
    assert [task.labels for task in grid] == [{"scale": 1.0}, {"scale": 2.0}]
    assert replace(grid[0], tolerance=0.1).tolerance == 0.1


def test_the_vertical_motion_is_scaled_too(build, wall, e):
    case = replace(build().case, vertical=mr.GroundMotion.half_sine(1.0, 0.5))
    scaled = mr.Capacity(replace(build(), case=case)).scaled(3.0).case
    assert scaled.vertical.peak == pytest.approx(3.0)
    assert scaled.motion.peak == pytest.approx(3 * case.motion.peak)


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"analysis": 3}, "analysis = 3 of type int is not a Analysis"),
        ({"tolerance": 0.0}, "tolerance = 0 is outside the valid range"),
        ({"start": math.nan}, "start = nan is outside the valid range"),
    ],
)
def test_capacities_that_cannot_be(arguments, complaint, build):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.Capacity(**{"analysis": build()} | arguments)


def test_a_case_without_motion_has_no_capacity(wall, e):
    still = mr.Analysis(mr.Case(wall, 0.05, 1.0), "analytical", e=e)
    with pytest.raises(ValueError, match=r"analysis = .* has no horizontal motion to scale"):
        mr.Capacity(still)


def test_a_bracket_is_found_from_either_side():
    for start in (0.1, 1.0, 50.0):
        low, high = halved(lambda x: x >= 3.0, *bracket(lambda x: x >= 3.0, start), 1e-4)
        assert low < 3.0 <= high <= low * 1.0002
    with pytest.raises(ValueError, match="the wall stands at every scale from 1 up to"):
        bracket(lambda x: False)
    with pytest.raises(ValueError, match="the wall overturns at every scale from 1 down to"):
        bracket(lambda x: True)
    assert np.isclose(bracket(lambda x: x > 1)[1], 1.25)
