"""Warnings of a campaign: each kind once, with how often it came, and cases of the same content."""

import warnings
from concurrent.futures import ThreadPoolExecutor

import pytest
from campaign_tasks import Square, Warn

import mjrock as mr
from mjrock.notice import collect_warnings
from mjrock.study.campaign.progress import WarningCounter


def test_warnings_that_differ_in_numbers_are_of_one_kind():
    counter = WarningCounter()
    texts = ["peaks at 0.3 g", "peaks at 1.2e-05 g", "falls at 0.3 g", "peaks at 7 g"]
    assert [counter.add(text) for text in texts] == [True, False, True, False]
    assert counter.lines() == ["warned 3 times, first: peaks at 0.3 g", "warned once: falls at 0.3 g"]


def numbers(heard):
    """Warn of three numbers; all are heard and those with a nought are shown."""
    with collect_warnings(lambda text: heard.append(text) or "0" in text):
        for i in range(3):
            warnings.warn(f"number {i}", stacklevel=1)


def test_the_first_is_shown_and_all_are_heard():
    heard = []
    with pytest.warns(UserWarning, match="number 0") as caught:
        numbers(heard)
    assert heard == [f"UserWarning: number {i}" for i in range(3)]
    assert len(caught) == 1


def closing(capsys):
    return [line for line in capsys.readouterr().err.splitlines() if line.startswith("campaign: ")]


@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("where", [{"workers": 1}, {"executor": ThreadPoolExecutor(1)}])
def test_a_campaign_counts_warnings(tmp_path, capsys, where):
    with warnings.catch_warnings(record=True) as shown:
        path = mr.campaign([Warn(i) for i in range(5)], tmp_path / "c.sqlite", **where)
    message, last = closing(capsys)
    assert message == "campaign: warned 5 times, first: UserWarning: the number is 0"
    assert last.startswith("campaign: 5 of 5 tasks have a row: 5 done")
    assert len(shown) == 1
    with mr.Store(path) as store:
        assert [row["square"] for row in store.rows()] == [0, 1, 4, 9, 16]
        assert "warned" not in store.columns


def test_what_building_warns_of_is_counted(tmp_path, capsys):
    def build(number):
        warnings.warn(f"the number is {number}", stacklevel=2)
        return Square(number)

    with warnings.catch_warnings(record=True) as shown:
        warnings.simplefilter("always")
        mr.campaign(mr.Grid(build, number=range(4)), tmp_path / "c.sqlite", executor=ThreadPoolExecutor(1))
    assert closing(capsys)[0] == "campaign: warned 4 times, first: UserWarning: the number is 0"
    assert len(shown) == 1


def test_labels_that_change_nothing_are_said_to(tmp_path, capsys):
    """Points of a grid that are the same task have one row, with the labels of the first."""
    grid = mr.Grid(lambda number, name: Square(number), number=[2, 3], name=["a", "b"])
    path = mr.campaign(grid, tmp_path / "c.sqlite", executor=ThreadPoolExecutor(1))
    (message, _) = closing(capsys)
    assert message == (
        "campaign: warned 2 times, first: the case labelled {'number': 2, 'name': 'b'} is that labelled "
        "{'number': 2, 'name': 'a'}, whose row stands for both: they differ in labels alone"
    )
    with mr.Store(path) as store:
        assert [row["name"] for row in store.rows()] == ["a", "a"]
    mr.campaign([Square(2), Square(2)], tmp_path / "d.sqlite", executor=ThreadPoolExecutor(1))
    assert len(closing(capsys)) == 1
