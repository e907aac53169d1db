"""Masonry that needs more memory than there is, is refused before the memory is taken."""

import pytest

import mjrock as mr
from mjrock import machine
from mjrock.bars import progress_given_to
from mjrock.scene import masonry as scene
from mjrock.scene.rest import memory_of

COLUMN = mr.Masonry.column(width=0.5, height=2.0, drums=4)


@pytest.mark.parametrize("settled", [True, False])
@pytest.mark.parametrize("solve", [mr.simulate, mr.solve_explicit])
def test_what_does_not_fit_is_refused_with_both_figures(solve, settled, monkeypatch):
    monkeypatch.setattr(scene, "memory", lambda: 2000.0)
    scene.require_memory.cache_clear()
    named = r"blocks = 4 on 16 contact lines need about 0.000\d+ GB of memory, and the machine has 2e-06 GB available"
    with pytest.raises(ValueError, match=named):
        solve(mr.MasonryCase(COLUMN, 0.01, settled=settled))


def test_a_later_run_of_the_same_masonry_needs_no_memory_anew(monkeypatch):
    case = mr.MasonryCase(COLUMN, 0.01)
    first = mr.solve_explicit(case)
    monkeypatch.setattr(scene, "memory", lambda: 2000.0)
    assert (mr.solve_explicit(case).pose == first.pose).all()


def test_the_estimate_grows_with_blocks_and_lines():
    few, more = (memory_of(1000, lines, in_space=True) for lines in (10_000, 20_000))
    assert 0 < few < more < memory_of(2000, 20_000, in_space=True) == 2 * few


def test_the_search_for_rest_has_a_bar_with_the_memory_that_it_needs():
    seen, column = [], mr.Masonry.column(width=0.51, height=2.0, drums=4)
    scene.scene_of_masonry.cache_clear()
    with progress_given_to(seen.append):
        pose = scene.scene_of_masonry(column).at_rest
    assert pose[:, 2].max() < 0
    assert [each.done for each in seen] == list(range(1, len(seen) + 1))
    assert {each.what for each in seen} == {f"pose of rest, about {memory_of(4, 16, in_space=True) / 1e9:.2g} GB"}


@pytest.mark.parametrize(("limit", "least"), [("max", 2048e3), ("1000000", 1e6), (None, 2048e3)])
def test_memory_is_what_is_available_within_the_limit_of_the_control_group(limit, least, monkeypatch):
    texts = {"meminfo": "MemTotal:  4096 kB\nMemAvailable:  2000 kB\n", "memory.max": limit}

    def read(path):
        if (text := texts.get(path.name)) is None:
            raise FileNotFoundError(path)
        return text

    monkeypatch.setattr(machine.Path, "read_text", read)
    assert machine.memory() == least
