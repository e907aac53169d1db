import numpy as np
import pytest

import mjrock as mr
from mjrock.geometry.kinematics import gaps
from mjrock.result import problem
from mjrock.result.ledger import StepError, require_no_gain
from scripts.shared.paper import FIGURE_3, K_N


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
    """In the median over releases: one release may meet its touches up to five times better or worse than another.

    What is left is what an impact loses to the steps, the change of (1/4 - beta) h^2 k v^2 / 2 from touch to touch, and
    what a change of the step within an impact misplaces for a moment.
    """
    releases = np.linspace(0.3, 0.7, 9) * FIGURE_3.alpha
    for accuracy, most in ((1e-3, 2.5e-3), (3e-4, 7e-4), (1e-4, 2.5e-4), (1e-5, 4e-5)):
        cases = [mr.Case(FIGURE_3, float(theta0), 3.0) for theta0 in releases]
        runs = [mr.simulate(case, contacts, accuracy=accuracy, ledger=True) for case in cases]
        assert np.median([closure(run) for run in runs]) < most


@pytest.mark.filterwarnings("ignore:xi = ")
def test_released_into_strong_dashpots():
    """At a speed, into nearly four times critical damping: the accounts begin at the release, not before it."""
    wall = mr.Block.from_slenderness(1.988, 5.16, density=3278.0)
    contacts = mr.Contacts.from_damping(wall, k_base=1.4448e9, xi_base=3.79, points=3)
    run = mr.simulate(mr.Case(wall, 1e-6, 3.0, side_stop=False, omega0=-0.1036), contacts, ledger=True)
    assert run.ledger.held[0] == pytest.approx(run.energy[0] + run.ledger.held[-1] - run.energy[-1], rel=1e-3)
    assert closure(run) < 5e-3


def test_one_that_does_not_close_says_so(one_sided, contacts, monkeypatch):
    mr.simulate(one_sided, contacts, ledger=True)  # silent: warnings are errors here
    monkeypatch.setattr(problem, "RESIDUAL_OF_WALL", -1.0)
    with pytest.warns(UserWarning, match=r"does not close: .* have no account; lower accuracy = 0.001") as caught:
        mr.simulate(one_sided, contacts, ledger=True)
    assert caught[0].filename == __file__  # it points at the call


def test_a_gain_of_a_thousandth_is_the_most():
    """The balance has fallen by 5 J before, which is no excuse for what appears afterwards."""
    t = np.array([0.0, 1.0, 2.0])
    require_no_gain(t, np.array([0.0, -5.0, -5.0 + 0.9e-3 * 20.0]), 20.0)
    with pytest.raises(StepError, match=r"0\.11% of the energy") as refused:
        require_no_gain(t, np.array([0.0, -5.0, -5.0 + 1.1e-3 * 20.0]), 20.0)
    assert refused.value.t == 2.0
    assert refused.value.share == pytest.approx(1.1e-3)


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


def test_the_dashpots_take_what_the_law_says(contacts):
    """Through the first side impact, against c (dr/dt)^2 over the time that each line presses, from SciPy's motion.

    Where a line is closed but its dashpot holds the spring back, the dashpot takes what the spring gives.
    """
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 0.9)
    law = mr.solve_compliant(case, contacts, output_step=1e-5)
    book = mr.simulate(case, contacts, accuracy=1e-5, ledger=True).ledger
    scene = mr.wall_scene(case, contacts)
    gap = gaps(scene.places, law.pose[:, 0])
    rate = np.gradient(gap, law.t, axis=0)
    force = -(scene.contacts.k * gap + scene.contacts.c * rate)
    power = np.where(force > 0, scene.contacts.c * rate, -scene.contacts.k * gap) * rate * (gap < 0)
    taken = power.sum(axis=0) * 1e-5
    exact = {name: taken[np.array(scene.contacts.group) == name].sum() for name in ("base", "side")}
    assert exact["side"] > 0.5 * case.release_energy
    for name, energy in exact.items():
        assert book.dashpots[name][-1] == pytest.approx(energy, rel=2e-2), name


def test_undamped_contacts_keep_everything():
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=K_N, xi_base=0.0)
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 1.5, side_stop=False)
    book = mr.simulate(case, contacts, 1e-4, ledger=True).ledger
    assert np.abs(book.dashpots["base"]).max() < 2e-3 * case.release_energy
    assert np.abs(book.residual).max() < 1e-3 * case.release_energy
    assert set(book.dashpots) == {"base"}


@pytest.mark.parametrize(
    ("times", "complaint"),
    [
        ("x", "t = 'x' of type str does not hold real numbers alone; it takes times in s"),
        ("nan", "t = 'nan' of type str does not hold real numbers"),
        ([[1], [2, 3]], "t = .* has rows of different lengths"),
        (1j, "t = 1j of type complex does not hold real numbers"),
        ([0.1, np.nan], "t = .* holds a value that is not finite"),
    ],
)
def test_a_ledger_is_asked_at_times(times, complaint):
    t = np.linspace(0.0, 1.0, 3)
    book = mr.Ledger(t, *(3 * [t]), dashpots={"base": 2 * t}, friction=t, ground=t)
    assert book.at(0.25).dashpots["base"] == 0.5
    assert book.at([[0.5], [1.0]]).kinetic.tolist() == [[0.5], [1.0]]
    with pytest.raises((TypeError, ValueError), match=complaint):
        book.at(times)
