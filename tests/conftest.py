import contextlib
import gc
import os
import signal
from collections.abc import Generator
from typing import Any

import pytest

import mjrock as mr
from mjrock import machine
from mjrock.reporting import markup
from mjrock.study.compilation import RUNS, carry_out
from scripts.shared.paper import FIGURE_3, K_N

os.environ.setdefault("MJROCK_INTERPRET", "0")  # tests compile; those of first answers switch it on


def pytest_sessionstart(session: pytest.Session) -> None:
    """Each process of xdist compiles its share of the loops before any test starts, so that none is compiled twice.

    What is stored already is only loaded. A session without xdist compiles what its tests call. What is wrong with a
    run, the tests say. A shell starts what runs in the background with Ctrl-C ignored, which tests of it need."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    worker = getattr(session.config, "workerinput", None)
    if worker is not None:
        with contextlib.suppress(Exception):
            for number in range(int(worker["workerid"].removeprefix("gw")), len(RUNS), worker["workercount"]):
                carry_out(number)


def pytest_sessionfinish() -> None:
    """The garbage of the tests is searched for once. Later searches of pytest leave out what is alive now."""
    gc.collect()
    gc.freeze()


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Name what last digits depend on, where a test has failed."""
    if terminalreporter.stats.get("failed") or terminalreporter.stats.get("error"):
        terminalreporter.write_line(f"computed by {machine.description()}")


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """What is collected stays to the end: no search for garbage goes through it, then or later. Searches are few."""
    gc.disable()
    gc.set_threshold(100_000)
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.fixture(scope="session", autouse=True)
def _coarse_pictures() -> Generator[None, None, None]:
    """Pictures of reports are drawn and laid out as ever, with a fourth of the dots."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(markup, "DOTS_PER_INCH", markup.DOTS_PER_INCH / 4)
        yield


LONG = {"test_hostile", "test_wheel", "test_pages", "test_scripts", "test_earthquakes", "test_plausible_masonry"}
LONG |= {"test_bounds", "test_digests"}
"""Files with the longest tests."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The longest tests start first, so that no process waits at the end for one that another has just begun."""
    items.sort(key=lambda item: item.path.stem not in LONG)


@pytest.fixture(scope="session")
def wall() -> mr.Block:
    """The wall of the paper's Figure 3."""
    return FIGURE_3


@pytest.fixture(scope="session")
def e(wall: mr.Block) -> mr.Restitution:
    return mr.Restitution.from_geometry(wall.alpha)


@pytest.fixture(scope="session")
def contacts(wall: mr.Block, e: mr.Restitution) -> mr.Contacts:
    """Corner lines with the published law."""
    return mr.Contacts.from_law(wall, e, k_base=K_N, k_side=K_N, law="PUBLISHED")


@pytest.fixture(scope="session")
def two_sided(wall: mr.Block) -> mr.Case:
    return mr.Case(wall, 0.5 * wall.alpha, 6.0, side_stop=False)


@pytest.fixture(scope="session")
def one_sided(wall: mr.Block) -> mr.Case:
    return mr.Case(wall, 0.5 * wall.alpha, 3.0)
