"""Restitution that differs from impact to impact: mean, spread, range and seed of its draws."""

import math
from dataclasses import replace

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.damping.restitution import impacts_of

MANY = 20000


@pytest.mark.parametrize("sd", [0.01, 0.03, 0.1])
@pytest.mark.parametrize(("mean", "index"), [(0.75, 0), (-0.5, 1), (0.985, 0)])
def test_draws_have_the_mean_and_the_spread(sd, mean, index):
    """Within five standard errors; that of the sd takes the fourth moment of the beta distribution."""
    e = mr.Restitution(mean, -0.5) if index == 0 else mr.Restitution(0.9, mean)
    if index == 0:
        draws = impacts_of(e.scattered(sd, 7), lumped=False)(MANY)
    else:
        draws = np.array([e.scattered(sd, seed).drawn().side for seed in range(MANY // 10)])
    assert draws.mean() == pytest.approx(mean, abs=5 * sd / math.sqrt(len(draws)))
    m, s = abs(mean), m_s(abs(mean), sd)
    kurtosis = 3 + 6 * ((2 * m - 1) ** 2 * (s + 1) - m * (1 - m) * (s + 2)) / (m * (1 - m) * (s + 2) * (s + 3))
    assert draws.std() == pytest.approx(sd, rel=5 * math.sqrt((kurtosis - 1) / (4 * len(draws))))
    assert np.abs(draws).max() <= 1
    assert (np.sign(draws) == np.sign(mean)).all()


def m_s(mean, sd):
    """The sum of the two parameters of a beta distribution."""
    return mean * (1 - mean) / sd**2 - 1


def test_the_sequence_of_a_stop_is_the_product_of_three_draws():
    e = mr.Restitution(0.97, -0.47).scattered(0.02, 3)
    drawn = impacts_of(e, lumped=True)(MANY)
    first, single = e.drawn(), impacts_of(e, lumped=False)(1)[0]
    assert first.base == single
    assert drawn[0] / (first.base * first.side) == pytest.approx(0.97, abs=0.1)
    relative = (1 + (0.02 / 0.97) ** 2) ** 2 * (1 + (0.02 / 0.47) ** 2) - 1  # of a product of independent values
    assert drawn.mean() == pytest.approx(e.lumped, rel=5 * math.sqrt(relative / MANY))
    assert drawn.std() / abs(e.lumped) == pytest.approx(math.sqrt(relative), rel=0.05)


def test_impacts_have_their_draws_however_they_are_taken():
    e = mr.Restitution(0.97, -0.47).scattered(0.02, 3)
    one, other = impacts_of(e, lumped=False), impacts_of(e, lumped=False)
    assert (np.concatenate([one(5), one(0), one(11)]) == other(16)).all()


def test_each_impact_of_a_run_has_its_draw(wall):
    """Whatever the tolerance, and also where the solver has emptied the room that it writes steps in."""
    case = mr.Case(wall, 0.5 * wall.alpha, 200.0, side_stop=False)
    e = mr.Restitution(0.9999, -0.5).scattered(0.0001, 11)
    runs = [mr.solve_analytical(case, e, rtol=rtol, output_step=1.0, rest=1e-30) for rtol in (1e-10, 1e-6)]
    found = [[impact.omega_after / impact.omega_before for impact in run.impacts] for run in runs]
    count = min(map(len, found))
    drawn = impacts_of(e, lumped=False)(count)
    assert count > 100
    assert runs[0].stats["evaluations"] > 3 * 4096
    for one in found:
        assert one[:count] == pytest.approx(drawn, rel=1e-12)


def test_the_same_seed_gives_the_same_bits(wall, e):
    case = mr.Case(wall, 0.5 * wall.alpha, 6.0, side_stop=False)
    one, again, other = (mr.solve_analytical(case, e.scattered(0.01, seed)) for seed in (4, 4, 5))
    assert (one.theta == again.theta).all()
    assert not np.array_equal(one.peaks, other.peaks)


@pytest.mark.parametrize("side_stop", [True, False])
def test_no_spread_is_the_mean_to_the_last_bit(wall, e, side_stop):
    case = mr.Case(wall, 0.5 * wall.alpha, 6.0, side_stop=side_stop)
    assert (mr.solve_analytical(case, e).theta == mr.solve_analytical(case, e.scattered(0.0, 1)).theta).all()


def test_energy_left_is_the_product_of_what_was_drawn(wall):
    case = mr.Case(wall, 0.5 * wall.alpha, 10.0, side_stop=False)
    run = mr.solve_analytical(case, mr.Restitution.from_geometry(wall).scattered(0.02, 2))
    left = np.array([impact.energy_after / impact.energy_before for impact in run.impacts])
    peaks = case.energy(run.peaks, 0 * run.peaks)
    count = min(len(left), len(peaks) - 1)
    assert peaks[1 : count + 1] / peaks[0] == pytest.approx(np.cumprod(left[:count]), rel=1e-6)


def test_a_run_on_contacts_has_one_draw(wall, e):
    drawn = e.scattered(0.002, 9).drawn()
    assert drawn == e.scattered(0.002, 9).drawn() != e
    assert drawn.made_for == e.made_for
    assert e.scattered(0.0, 9).drawn() == e
    assert mr.Contacts.from_law(wall, drawn, 5e8, 5e8) != mr.Contacts.from_law(wall, e, 5e8, 5e8)
    with pytest.raises(TypeError, match="is not a Restitution"):
        mr.Contacts.from_law(wall, e.scattered(0.02, 9), 5e8, 5e8)


@pytest.mark.parametrize("sd", [-0.01, math.nan, math.inf, 0.18, 0.5])
def test_a_spread_that_leaves_the_range_is_refused(sd):
    """sqrt(0.97 * 0.03) = 0.1706."""
    with pytest.raises(ValueError, match="sd of the restitution"):
        mr.Restitution(0.97, -0.5).scattered(sd, 0)
    assert mr.Restitution(0.97, -0.5).scattered(0.17, 0).sd == 0.17


def test_what_does_not_scatter():
    with pytest.raises(ValueError, match="less than 0"):
        mr.Restitution(1.0, -0.5).scattered(0.01, 0)
    assert mr.Restitution(0.97, 0.0).scattered(0.01, 0).drawn().side == 0.0
    with pytest.raises(ValueError, match="seed"):
        mr.Restitution(0.97, -0.5).scattered(0.01, -1)
    with pytest.raises(TypeError, match="mean restitution"):
        mr.ScatteredRestitution(0.97, 0.01, 0)


def test_an_analysis_takes_it(wall, e):
    case = mr.Case(wall, 0.5 * wall.alpha, 3.0)
    one = mr.Analysis(case, "analytical", e=e.scattered(0.02, 1))
    assert one()["restitution_1"] != mr.Analysis(case, "analytical", e=e)()["restitution_1"]
    assert one != replace(one, e=e.scattered(0.02, 2))
