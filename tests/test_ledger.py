import numpy as np
import pytest

import mjrock as mr
from paper import FIGURE_3, K_N


def closure(run):
    return float(np.abs(run.energy_residual).max()) / run.case.release_energy


def test_free_when_off(one_sided, contacts):
    run = mr.simulate(one_sided, contacts)
    assert run.ledger is None
    assert run.energy_residual is None


@pytest.mark.parametrize("side_stop", [False, True])
def test_it_closes(contacts, side_stop):
    """To a thousandth of the release energy at the sound fixed step, where a touch lies anywhere in a step."""
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 3.0, side_stop=side_stop)
    sound = mr.automatic_timestep(FIGURE_3, contacts, side_stop=side_stop)
    assert closure(mr.simulate(case, contacts, sound, ledger=True)) < 1e-3
    assert closure(mr.simulate(case, contacts, ledger=True)) < 3e-3


def test_it_closes_with_the_accuracy(contacts):
    """In the median over releases: one release may meet its touches up to five times better or worse than another."""
    releases = np.linspace(0.3, 0.7, 9) * FIGURE_3.alpha
    for accuracy, most in ((1e-3, 2e-3), (3e-4, 6e-4), (1e-4, 2e-4)):
        cases = [mr.Case(FIGURE_3, float(theta0), 3.0) for theta0 in releases]
        runs = [mr.simulate(case, contacts, accuracy=accuracy, ledger=True) for case in cases]
        assert np.median([closure(run) for run in runs]) < most


def test_order_of_closure(one_sided, contacts):
    """With every touch centred the closure is second order in the step, first order in the accuracy."""
    knobs = np.array([1e-2, 3e-3, 1e-3, 3e-4, 1e-4])
    residuals = [closure(mr.simulate(one_sided, contacts, accuracy=a, ledger=True)) for a in knobs]
    assert 0.7 < np.polyfit(np.log(knobs), np.log(residuals), 1)[0] < 1.3


def test_where_the_energy_went(one_sided, contacts):
    book = mr.simulate(one_sided, contacts, accuracy=1e-4, ledger=True).ledger
    gone = book.dashpots["base"][-1] + book.dashpots["side"][-1] + book.friction[-1]
    released = book.kinetic[0] + book.potential[0] + book.elastic[0]
    left = book.kinetic[-1] + book.potential[-1] + book.elastic[-1]
    assert gone == pytest.approx(released - left, rel=1e-3)
    assert book.dashpots["side"][-1] > 5 * book.dashpots["base"][-1] > 0
    for account in book.dashpots.values():
        assert np.diff(account).min() > -1e-3 * released


def test_a_dashpot_that_is_not_booked_shows(one_sided, contacts, monkeypatch):
    """The twin that must fail: without the side dashpot's account nine tenths of the energy are missing."""
    from dataclasses import replace

    run = mr.simulate(one_sided, contacts, ledger=True)
    cooked = replace(run.ledger, dashpots={"base": run.ledger.dashpots["base"]})
    assert cooked.residual[-1] < -0.8 * one_sided.release_energy


def test_undamped_contacts_keep_everything():
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=K_N, xi_base=0.0)
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 1.5, side_stop=False)
    book = mr.simulate(case, contacts, 1e-4, ledger=True).ledger
    assert np.abs(book.dashpots["base"]).max() < 2e-3 * case.release_energy
    assert np.abs(book.residual).max() < 1e-3 * case.release_energy
    assert set(book.dashpots) == {"base"}
