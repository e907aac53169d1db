import contextlib
import gc
import os
from collections.abc import Callable, Generator

import pytest

import mjrock as mr
from scripts.shared.paper import FIGURE_3, K_N

os.environ.setdefault("MJROCK_INTERPRET", "0")  # tests compile; those of first answers switch it on


def pytest_sessionstart(session: pytest.Session) -> None:
    """Each process of xdist compiles its share of the loops before any test starts, so that none is compiled twice.

    What is stored already is only loaded. A session without xdist compiles what its tests call. What is wrong with a
    run, the tests say."""
    worker = getattr(session.config, "workerinput", None)
    if worker is not None:
        with contextlib.suppress(Exception):
            for run in loops()[int(worker["workerid"].removeprefix("gw")) :: worker["workercount"]]:
                run()


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """What is collected stays to the end: no search for garbage goes through it, then or later. Searches are few."""
    gc.disable()
    gc.set_threshold(20_000)
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


LONG = {"test_hostile", "test_wheel", "test_pages", "test_scripts", "test_earthquakes", "test_plausible_masonry"}
"""Files with the longest tests."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The longest tests start first, so that no process waits at the end for one that another has just begun."""
    items.sort(key=lambda item: item.path.stem not in LONG)


def loops() -> list[Callable[[], object]]:
    """Short runs that call the loops which take seconds to compile; MuJoCo and explicit steps in turn."""
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=K_N, xi_base=0.05)
    case, push = mr.Case(FIGURE_3, 0.01, 0.02, side_stop=False), mr.GroundMotion.half_sine(9.0, 0.5)
    plane = mr.MasonryCase(mr.Masonry.stack([FIGURE_3], K_N), 1.0, motion=push)
    space = mr.MasonryCase(mr.Masonry.box((0.6, 0.4, 2.0), k_n=K_N), 1.0, motion=push)
    short = mr.MasonryCase(space.masonry, 0.02)
    e = mr.Restitution.from_geometry(FIGURE_3)
    return [
        lambda: mr.simulate(case, contacts),
        lambda: mr.solve_explicit(plane),
        lambda: mr.simulate(short),
        lambda: mr.solve_explicit(space),
        lambda: mr.simulate(case, contacts, 1e-4),
        lambda: mr.solve_analytical(mr.Case(FIGURE_3, 0.0, 1.0, motion=push), e),
        lambda: mr.simulate(short, timestep=1e-4),
    ]


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
