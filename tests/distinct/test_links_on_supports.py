"""Ties and dampers that are anchored on a fixed block which a support moves, such as a jack."""

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr

K, STROKE = 1e5, 0.05
RAMP = np.linspace(0.0, 0.5, 501)
SMOOTH = STROKE * (3 * (2 * RAMP) ** 2 - 2 * (2 * RAMP) ** 3)


def jacked(in_space, *links, x, z=None, duration=0.6, ledger=True):
    """A block that sticks to the ground, and a jack beside it, from which links go to the block; what they do."""
    blocks = [GROUND, box(-2.5, -2.0, 0, 1, fixed=True, name="jack"), box(-0.5, 0.5, 0, 1, name="block")]
    still = 0 * RAMP
    history = (RAMP, x, still if z is None else z)
    where = {"height": 0.1, "length": 1.5}
    if in_space:
        blocks, history = [mr.Polyhedron.prism(block) for block in blocks], (RAMP, x, still, history[2])
        where = {"at": (-0.5, 0.0, 0.1), "anchor": (-2.0, 0.0, 0.1)}
    masonry = mr.Masonry(blocks, k_n=1e10, friction=0.9, xi=0.3)
    effects = tuple(kind(block=2, anchor_block=1, **where, **law) for kind, law in links)
    case = mr.MasonryCase(masonry, duration, effects=effects, supports={"jack": history})
    return mr.solve_explicit(case, ledger=ledger)


@pytest.mark.parametrize("in_space", [False, True])
def test_a_jack_stretches_a_tie(in_space):
    """The force is k times the stretch, and the work of the support k u^2 / 2."""
    run = jacked(in_space, (mr.Tie, {"stiffness": K}), x=-SMOOTH)
    tie = run.ties["tie_0"]
    assert np.abs(run.pose[-1, 0, 0]) < 1e-5
    assert tie.force[-1] == pytest.approx(K * STROKE, rel=1e-3)
    np.testing.assert_allclose(tie.elongation, np.interp(run.t, RAMP, SMOOTH), atol=2e-5)
    assert run.ledger.ground[-1] == pytest.approx(0.5 * K * STROKE**2, rel=1e-3)
    assert run.ledger.elastic[-1] - run.ledger.elastic[0] == pytest.approx(0.5 * K * STROKE**2, rel=2e-3)
    assert np.abs(run.energy_residual).max() < 1e-3 * run.ledger.ground[-1]


@pytest.mark.parametrize("in_space", [False, True])
def test_a_jack_draws_a_tie_beyond_its_strength(in_space):
    """Up to the yield k u^2 / 2, and beyond it the strength over the rest of the stroke. It breaks in the end."""
    law = {"stiffness": K, "strength": 2e3, "ultimate": 0.025}
    run = jacked(in_space, (mr.Tie, law), x=-SMOOTH)
    assert 0.2 < run.plastic["tie_0"].broken < 0.5
    assert run.ledger.ground[-1] == pytest.approx(0.5 * 2e3 * 0.02 + 2e3 * 0.025, rel=2e-3)
    assert np.abs(run.energy_residual).max() < 5e-3 * run.ledger.ground[-1]


@pytest.mark.parametrize("in_space", [False, True])
def test_a_jack_draws_a_damper(in_space):
    """Its work at a steady speed v is c v^2 T, all of which the damper takes."""
    speed = STROKE / 0.5
    run = jacked(in_space, (mr.Damper, {"c": 2e4}), x=-speed * RAMP)
    assert run.ledger.ground[-1] == pytest.approx(2e4 * speed**2 * 0.5, rel=5e-3)
    assert run.ledger.dashpots["damper_0"][-1] == pytest.approx(run.ledger.ground[-1], rel=5e-3)


def test_a_tie_turns_with_a_jack_that_rises():
    """Plane and space alike, and also where the block slides after it."""
    lift = 0.3 * (RAMP / 0.5) ** 2
    flat, deep = (jacked(space, (mr.Tie, {"stiffness": 1e6}), x=-lift, z=lift, duration=0.5) for space in (False, True))
    assert np.abs(flat.pose[-1, 0, 0]) > 0.05
    np.testing.assert_allclose(deep.pose[:, 0, [0, 2]], flat.pose[:, 0, :2], atol=1e-6)
    np.testing.assert_allclose(deep.ledger.ground, flat.ledger.ground, rtol=1e-4, atol=0.1)
    assert np.abs(flat.energy_residual).max() < 1e-3 * np.abs(flat.ledger.ground).max()


def test_a_run_on_a_moved_jack_is_carried_on():
    tie = mr.Tie, {"stiffness": 1e6}
    whole = jacked(False, tie, x=-3 * SMOOTH, duration=0.4, ledger=False)
    first = jacked(False, tie, x=-3 * SMOOTH, duration=0.2, ledger=False)
    case = first.case
    later = {"jack": (RAMP, *(np.interp(RAMP + 0.2, RAMP, each) for each in (-3 * SMOOTH, 0 * RAMP)))}
    rest = mr.solve_explicit(mr.MasonryCase(case.masonry, 0.2, effects=case.effects, supports=later), start=first.end)
    np.testing.assert_allclose(rest.pose[-1], whole.pose[-1], atol=1e-9)


@pytest.mark.parametrize("solver", [mr.simulate, mr.solve_explicit])
def test_a_tie_in_the_plane_between_two_blocks_is_that_in_space(solver):
    blocks = [GROUND, box(-1.25, -0.75, 0, 0.3), box(0.75, 1.25, 0, 0.3)]
    law, velocity = {"stiffness": 1e5, "block": 2, "anchor_block": 1}, np.array([[0.0, 0, 0], [0.4, 0, 0]])
    runs = []
    for in_space in (False, True):
        made = [mr.Polyhedron.prism(block) for block in blocks] if in_space else blocks
        where = {"at": (0.75, 0, 0.15), "anchor": (-0.75, 0, 0.15)} if in_space else {"height": 0.15, "length": 1.5}
        masonry = mr.Masonry(made, k_n=1e8, friction=0.0, frequency=100.0)
        start = np.column_stack([velocity, np.zeros((2, 3))]) if in_space else velocity
        case = mr.MasonryCase(masonry, 0.3, velocity=start, effects=mr.Tie(**law, **where))
        runs.append(solver(case, timestep=1e-4))
    flat, deep = runs
    np.testing.assert_allclose(flat.velocity[:, :, 0].sum(axis=1), 0.4, atol=1e-3)
    assert flat.velocity[-1, 0, 0] > 0.2
    np.testing.assert_allclose(deep.pose[:, :, [0, 2]], flat.pose[:, :, :2], atol=1e-6)
    np.testing.assert_allclose(flat.ties["tie_0"].elongation, deep.ties["tie_0"].elongation, atol=1e-6)


def test_the_anchor_in_the_plane_lies_on_its_block():
    masonry = mr.Masonry([GROUND, box(-2.5, -2.0, 0, 1, fixed=True, name="jack"), box(-0.5, 0.5, 0, 1)])
    with pytest.raises(ValueError, match=r"anchor = \(-1.0, 0.5\) m lies 1 m outside the block"):
        mr.MasonryCase(masonry, 1.0, effects=mr.Tie(0.5, 1e5, length=0.5, block=2, anchor_block=1))
    with pytest.raises(ValueError, match="anchor_block = 2 is the block itself"):
        mr.MasonryCase(masonry, 1.0, effects=mr.Tie(0.5, 1e5, length=0.5, block=2, anchor_block=2))
