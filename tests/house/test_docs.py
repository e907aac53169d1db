"""The Python blocks of docs/effects.md run, one after the other, and say what the text says."""

import re
from pathlib import Path

import pytest

import mjrock as mr

TEXT = (Path(__file__).parents[2] / "docs" / "effects.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def names():
    """What the blocks define, in one namespace."""
    found: dict = {}
    for block in re.findall(r"```python\n(.*?)```", TEXT, flags=re.DOTALL):
        exec(compile(block, "docs/effects.md", "exec"), found)
    return found


def test_the_blocks_run_and_end_with_a_response(names):
    assert isinstance(names["response"], mr.Response)


def test_a_stop_of_two_thirds_of_the_height_is_where_the_rebound_ends(names):
    wall = names["wall"]
    top = 2 / 3 * 2 * wall.h * (1 + (wall.b / wall.h) ** 2)
    assert mr.Restitution.from_geometry(wall, top).side == pytest.approx(0, abs=1e-12)
    assert mr.Restitution.from_geometry(wall, 0.99 * top).side > 0 > mr.Restitution.from_geometry(wall, 1.01 * top).side
    assert names["e"].side == pytest.approx(-0.33, abs=5e-3)


def test_a_lower_stop_throws_the_wall_back_more_on_the_same_contacts(names):
    wall, contacts = names["wall"], names["contacts"]
    rebounds = [
        mr.simulate(mr.Case(wall, 0.5 * wall.alpha, 1.8, side_stop=mr.SideStop(top)), contacts).restitution[0]
        for top in (9.0, 7.0, 5.0)
    ]
    assert rebounds == pytest.approx([0.48, 0.59, 0.71], abs=0.006)
