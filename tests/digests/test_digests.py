"""Answers of every solver as numbers that are kept: which has moved, from which number to which."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from mjrock.distinct import thread, time_integration
from mjrock.distinct.thread_pool import ThreadPool
from tests.cores import one_core
from tests.digests.digest_answers import answers, elsewhere, moved, stored
from tests.digests.digest_scenes import SCENES

KEPT = stored()
SLOW = (
    "explicit, dome",
    "rest, vault",
    "MuJoCo fitted, box",
    "MuJoCo fixed, drums",
    "SciPy, shaken",
    "push",
    "limit analysis, arch without dilatancy",
)
"""Scenes that take the longest."""
EXACT = [name for name in SCENES if name.startswith(("theory", "MuJoCo f", "push-over", "check"))]
INTERPRETED = [name for name in SCENES if name.startswith(("theory", "MuJoCo f", "rest", "push-over"))]
INTERPRETED.remove("rest, vault")
"""Scenes that are short as plain Python. The loops that find the rest of a vault are those of the dome."""
BY_EXPLICIT_STEPS = [name for name in SCENES if name.startswith("explicit") or name == "push"]
RIGID = ["explicit, wall released"]
"""Scenes whose friction is rigid, which one thread follows whatever it is given."""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in SCENES]
)
def test_no_answer_has_moved(name):
    """`python -m tests.digests --write` makes the numbers anew where one has changed on purpose."""
    assert not moved(name, answers([name])[name], KEPT[name])


def test_an_answer_that_moves_is_named_with_both_numbers():
    kept = {"answers": {"peak [N]": [2.0, 1e-3], "end [N]": [1.0, 1e-3]}}
    (line,) = moved("push", {"peak [N]": 2.5, "end [N]": 1.0005}, kept)
    assert line == "push, peak [N]: 2.0 is now 2.5, 5.0e-01 apart for 1.0e-03"
    assert moved("push", {"peak [N]": float("nan"), "end [N]": 1.0}, kept)
    assert moved("push", {"peak [N]": 2.0}, kept)


def test_scenes_and_answers_are_those_of_the_file():
    assert list(KEPT) == list(SCENES)


@pytest.mark.slow
def test_equal_to_the_bit_in_another_process_and_order_in_threads_and_as_plain_python():
    """The rest of many blocks takes linear algebra whose last digits depend on how many threads it has, here one."""
    here, there, backwards = answers(EXACT), elsewhere()["answers"], elsewhere("--backwards")["answers"]
    assert there == backwards
    assert {name: there[name] for name in EXACT} == here
    with ThreadPoolExecutor(2) as pool:
        for found in pool.map(lambda name: answers([name]), EXACT):
            assert found.items() <= here.items()
    plain = elsewhere("--scenes", *INTERPRETED, NUMBA_DISABLE_JIT="1")["answers"]
    assert plain == {name: there[name] for name in INTERPRETED}


@pytest.mark.slow
def test_equal_to_the_bit_in_any_number_of_threads(monkeypatch):
    """Explicit steps by 1, 2 and 4 threads, which share the lines by four and the blocks one by one."""
    alone, runs = answers(BY_EXPLICIT_STEPS), []
    monkeypatch.setattr(thread, "LINES_TOGETHER", 4)
    monkeypatch.setattr(thread, "BODIES_TOGETHER", 1)
    for count in (1, 2, 4):
        monkeypatch.setattr(
            time_integration, "ThreadPool", lambda given, count=count: runs.append(ThreadPool(count)) or runs[-1]
        )
        for name in BY_EXPLICIT_STEPS:
            with one_core():
                assert answers([name]) == {name: alone[name]}
            assert {run.used for run in runs} == {1 if name in RIGID else count}, name
            runs.clear()
