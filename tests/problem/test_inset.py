"""Edges that lie inside the faces of a wall: theory, contacts and model follow."""

import math

import numpy as np
import pytest
from everyday import among, slow

import mjrock as mr

FULL = mr.Block.from_size(0.6, 4.2)


def damaged(share):
    """The wall with a base that is narrower by a share of the thickness."""
    return mr.Block.from_size(0.6, 4.2, inset=0.5 * share * 0.6)


def test_mass_stays_and_the_edges_move():
    wall = damaged(0.1)
    assert (wall.mass, wall.inertia) == (FULL.mass, FULL.inertia)
    assert wall.half_base == pytest.approx(0.27)
    assert wall.alpha == math.atan2(wall.half_base, wall.h)
    assert wall.toe_inertia == pytest.approx(wall.inertia + wall.mass * (0.27**2 + 2.1**2))


def test_no_inset_is_eqs_2_and_3():
    tiny = mr.Restitution.from_geometry(mr.Block(0.3, 2.1, inset=1e-12))
    exact = mr.Restitution.from_geometry(FULL)
    assert (tiny.base, tiny.side) == (pytest.approx(exact.base, rel=1e-10), pytest.approx(exact.side, rel=1e-10))


@pytest.mark.parametrize("inset", [-0.01, 0.3, math.nan])
def test_an_inset_that_cannot_be(inset):
    with pytest.raises(ValueError, match=r"inset = .* is outside the valid range 0 "):
        mr.Block(0.3, 2.1, inset=inset)


def overturning(wall, solve):
    """Peak of a rectangular pulse of 0.6 s that just overturns the wall outwards [m/s2]."""
    low, high = 1.0, 6.0
    while high / low > 1.001:
        middle = math.sqrt(low * high)
        motion = mr.GroundMotion.rectangular(-middle, 0.6)
        fell = solve(mr.Case(wall, 0.0, 6.0, motion=motion)).outcome is mr.Outcome.OVERTURNED
        low, high = (low, middle) if fell else (middle, high)
    return high


def theory(case):
    return mr.solve_analytical(case, mr.Restitution.from_geometry(case.block))


def engine(case):
    e = mr.Restitution.from_geometry(case.block)
    return mr.simulate(case, mr.Contacts.from_law(case.block, e, 3e9, 3e9))


@pytest.mark.parametrize(("solve", "close"), [(theory, 3e-3), slow((engine, 1e-2))])
@pytest.mark.parametrize("share", among([0.05, 0.1], 0.1))
def test_a_narrower_base_overturns_earlier(share, solve, close):
    """The intensity goes with tan(alpha) where a pulse overturns without an impact; the engine follows theory."""
    assert overturning(damaged(share), solve) / overturning(FULL, solve) == pytest.approx(1 - share, rel=close)


@pytest.mark.parametrize("side_stop", among([True, False], True))
def test_both_solvers_of_the_contact_law_agree(side_stop):
    wall = damaged(0.1)
    e = mr.Restitution.from_geometry(wall)
    contacts = mr.Contacts.from_law(wall, e, 5e8, 5e8)
    case = mr.Case(wall, 0.5 * wall.alpha, 3.0, side_stop=side_stop)
    law, engine = mr.solve_compliant(case, contacts), mr.simulate(case, contacts)
    np.testing.assert_allclose(engine.restitution[:2], law.restitution[:2], atol=1e-3)
    wanted = e.base if not side_stop else abs(e.lumped)
    assert engine.restitution[0] == pytest.approx(wanted, rel=1e-2)
    assert mr.wall_scene(case, contacts).contacts.at[:2, 0].tolist() == [-wall.half_base, wall.half_base]
