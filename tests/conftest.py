import pytest

import mjrock as mr
from scripts.shared.paper import FIGURE_3, K_N


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
