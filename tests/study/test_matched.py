"""Contacts matched to one wall, and contacts as theory has them."""

from typing import ClassVar

import numpy as np
import pytest
from everyday import slow

import mjrock as mr
from mjrock import bars
from scripts.shared.paper import FIGURE_3, K_N

E = mr.Restitution.from_geometry(FIGURE_3)


def rebounds(contacts, *, side_stop=True):
    return mr.simulate(mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 3.0, side_stop=side_stop), contacts).restitution


@pytest.mark.parametrize(("friction", "side"), [slow((None, None)), slow((0.6, None)), (0.4, 0.6)])
def test_the_first_rebound_is_what_was_asked_for(friction, side):
    contacts = mr.matched_contacts(FIGURE_3, E, K_N, K_N, friction=friction, side_friction=side)
    assert rebounds(contacts)[0] == pytest.approx(abs(E.lumped), rel=5e-3)
    assert rebounds(contacts, side_stop=False)[0] == pytest.approx(E.base, rel=1e-3)
    assert (contacts.base.friction, contacts.side.friction, contacts.law) == (friction, side, "matched")


def test_a_law_that_is_not_told_of_friction_misses():
    """The twin that must fail: the same damping on a base that slides."""
    law = mr.Contacts.from_law(FIGURE_3, E, K_N, K_N)
    sliding = mr.Contacts.from_damping(
        FIGURE_3, k_base=K_N, xi_base=law.base.xi, k_side=K_N, xi_side=law.side.xi, friction=0.6
    )
    assert rebounds(sliding)[0] < 0.9 * abs(E.lumped)


def test_what_no_damping_gives_is_said():
    with pytest.warns(UserWarning, match=r"no damping of the base gives \|e\| = 0.8; the closest, xi = 0.*, gives 0.9"):
        mr.matched_contacts(FIGURE_3, mr.Restitution(0.8, -0.5), 5e9)


def test_as_theory_has_it_at_every_rebound():
    contacts = mr.as_theory(FIGURE_3, E)
    np.testing.assert_allclose(rebounds(contacts)[:4], abs(E.lumped), rtol=1e-2)
    contacts = mr.as_theory(FIGURE_3, E, side_stop=False)
    np.testing.assert_allclose(rebounds(contacts, side_stop=False)[:4], E.base, rtol=1e-3)


def test_as_theory_gives_eq_2_and_says_so():
    with pytest.warns(UserWarning, match="a stiff base gives e_2s = 0.97 of Eq. 2, and not 0.95"):
        mr.as_theory(FIGURE_3, mr.Restitution(0.95, -0.47), side_stop=False)


@pytest.mark.parametrize("changed", [{"rebounds": 0}, {"rebounds": 9}, {"amplitude": 1.5}])
def test_values_outside_their_range(changed):
    with pytest.raises(ValueError, match="outside the valid range"):
        mr.as_theory(FIGURE_3, E, **changed)


def test_the_measure_above_the_settled_rest():
    """V - E of the settled base counts the more the smaller a rebound is; in theory both measures are one."""
    response = mr.simulate(
        mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 3.0), mr.Contacts.from_law(FIGURE_3, E, K_N, K_N), accuracy=1e-4
    )
    rigid, settled = response.restitution[:3], response.settled_restitution[:3]
    assert (np.diff(rigid) > 0).all()
    assert (np.diff(settled) < 0).all()
    theory = mr.solve_analytical(mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 3.0), E)
    np.testing.assert_allclose(theory.settled_restitution[:3], theory.restitution[:3], rtol=1e-4)
    shaken = mr.Case(FIGURE_3, 0.0, 1.0, motion=mr.GroundMotion.sine(2.0, 0.5))
    with pytest.raises(ValueError, match="does work between two peaks"):
        _ = mr.solve_analytical(shaken, E).settled_restitution


def test_a_fixed_step_that_scatters_warns():
    contacts = mr.Contacts.from_law(FIGURE_3, E, K_N, K_N)
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 0.1)
    omega = contacts.highest_frequency(FIGURE_3, side_stop=True)
    with pytest.warns(UserWarning, match=r"\|e\| scatters by 5% \(standard deviation\).* below .* it is less than 2%"):
        mr.simulate(case, contacts, 0.5 / omega)
    mr.simulate(case, contacts, 0.19 / omega)  # silent: warnings are errors here
    mr.simulate(mr.Case(FIGURE_3, 0.05, 0.1, side_stop=False), contacts, 0.5 / omega)


class Shown:
    """What a bar of progress is told, in place of `tqdm`."""

    bars: ClassVar[list] = []

    def __init__(self, what, unit, total, **options):
        self.what, self.unit, self.total, self.n = what, unit, total, 0.0
        Shown.bars.append(self)

    def update(self, more):
        self.n += more

    def close(self):
        pass


def test_what_takes_long_has_a_bar(monkeypatch):
    """A match counts its simulations, a push-over on contacts its rotations."""
    monkeypatch.setattr(Shown, "bars", [])
    monkeypatch.setattr(bars, "shown_bar", Shown)
    monkeypatch.setattr(bars, "DELAY", 0.0)
    contacts = mr.matched_contacts(FIGURE_3, E, K_N, K_N)
    mr.pushover(mr.Case(FIGURE_3, 0.0, 1.0), contacts, points=20)
    base, side, push = (bar for bar in Shown.bars if bar.unit != "s")
    assert [bar.what for bar in (base, side, push)] == ["matching the base", "matching the side", "push-over"]
    assert min(base.n, side.n) > 5
    assert push.n == push.total
