"""Lines that take the place of others: forces and energy of a pair stay."""

import numpy as np
import pytest
from everyday import among
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct.rows import kinds
from mjrock.distinct.search.finder import ContactPlaces
from mjrock.distinct.search.handover import Lines, press
from mjrock.distinct.search.pair_law import least_among
from mjrock.rows import rows


@pytest.mark.parametrize("guided", among(["translation", "upright", None], "translation", None))
def test_a_beam_that_slides_keeps_its_normal_force_where_its_joints_are_handed_over(guided):
    """The beam leaves its joints at a slip of 10 mm, with its weight on it: only a guided one could lose it. It is
    longer than the units below it together, so that it lies over as much of them on its way."""
    units = [box(x, x + 0.2, 0.0, 0.15) for x in (-0.4, -0.2, 0.0, 0.2)]
    masonry = mr.Masonry(
        [GROUND, *units, box(-0.45, 0.45, 0.15, 0.3, name="beam")], k_n=1e9, k_s=1e9, friction=0.6, xi=0.05
    )
    jack = mr.Actuator("beam", (-0.4, 0.2), (1.0, 0.0), ([0.0, 1.0], [0.0, 0.02]), 1e7, 2e4, guided=guided)
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 1.0, effects=(jack,)), output_step=0.01, forces=True)
    assert answer.pose[-1, -1, 0] == pytest.approx(0.02, rel=0.01)
    upwards = answer.reactions["ground"][:, 1]
    np.testing.assert_allclose(upwards[20:], upwards[0], rtol=0.005)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.03, 0.0315, 0.0325])
def test_a_dome_that_falls_puts_no_energy_in_where_lines_follow_each_other(share):
    masonry = mr.Masonry.dome(5.0, share * 5.0, 6, 4, k_n=1e9, k_s=1e9, friction=0.9, xi=0.01)
    ledger = mr.solve_explicit(mr.MasonryCase(masonry, 2.0, settled=False), output_step=0.01, ledger=True).ledger
    lost = np.sum(list(ledger.ends.values()), axis=0)
    assert ledger.kinetic.max() > 1e5
    assert lost.min() > -1e-3 * ledger.kinetic.max()
    assert lost[-1] < 0.05 * ledger.kinetic.max()


def test_the_least_share_of_a_pair_is_that_of_its_softest_line():
    shares = least_among(np.array([7, 3, 7, 5]), np.array([3, 7, 7]), np.array([0.9, 0.4, 0.6]))
    np.testing.assert_array_equal(shares, [0.4, 0.9, 0.4, 1.0])
    np.testing.assert_array_equal(least_among(np.array([1, 2]), np.zeros(0, dtype=int), np.zeros(0)), [1.0, 1.0])


def test_what_presses_follows_the_lines_before_it_and_gains_no_energy():
    """A stiffer place starts with the force, a softer one with the energy of the line before it."""
    kind = kinds(2).line
    found = ContactPlaces(
        np.array([0]), np.array([1]), np.zeros((1, 2)), np.zeros((1, 2)), np.array([-1.0]), np.ones(1), np.ones(1)
    )
    for stiffness, depth in ((2.0, 0.5), (1.0, 1.0), (0.81, 1 / 0.9)):
        gone, new = (Lines.unwritten(rows(kind, 1, k=k), np.zeros(1)) for k in (1.0, stiffness))
        gone.depth[:] = new.depth[:] = 0.5
        press(new, (0, 1), found, gone, (0, 1))
        assert new.depth[0] == pytest.approx(0.5 * depth)
        assert stiffness * new.depth[0] ** 2 <= 0.25 * (1 + 1e-12)
