"""The solver of the contact law in SciPy: conservation, limits, and the tolerances that it keeps."""

import numpy as np
import pytest

import mjrock as mr
from scripts.shared.paper import K_N


def test_without_damping_energy_is_conserved(wall):
    contacts = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.0)
    response = mr.solve_compliant(mr.Case(wall, 0.3 * wall.alpha, 0.65, side_stop=False), contacts, rtol=1e-10)
    assert response.t[-1] > 0.55  # beyond the first impact
    np.testing.assert_allclose(response.energy, response.energy[0], rtol=1e-6)


@pytest.mark.slow
def test_energy_never_rises(two_sided, one_sided, contacts):
    for case in (two_sided, one_sided):
        energy = mr.solve_compliant(case, contacts).energy
        assert np.diff(energy).max() < 1e-6 * energy[0]


def test_a_wall_at_rest_stays_at_rest(wall, contacts):
    response = mr.solve_compliant(mr.Case(wall, 0.0, 1.0), contacts)
    assert np.abs(response.theta).max() < 1e-10  # the absolute tolerance of the integration
    assert response.outcome is mr.Outcome.AT_REST


@pytest.mark.slow
def test_tolerance_does_not_change_the_rebounds(one_sided, contacts):
    loose = mr.solve_compliant(one_sided, contacts)
    tight = mr.solve_compliant(one_sided, contacts, rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(loose.restitution[:3], tight.restitution[:3], rtol=1e-4)


def test_a_stiff_base_approaches_the_rigid_quarter_period(wall, e):
    case = mr.Case(wall, 0.5 * wall.alpha, 1.0, side_stop=False)
    exact = mr.solve_analytical(case, e).impacts[0].t
    errors = []
    for k_n in (5e8, 5e9):
        contacts = mr.Contacts.from_damping(wall, k_base=k_n, xi_base=0.05)
        errors.append(abs(mr.solve_compliant(case, contacts).impacts[0].t - exact))
    assert errors[1] < 1e-4
    assert errors[1] < errors[0] / 3


def test_reference_frequency_evidence(wall, e):
    """What the docstring of `reference_frequency` reports for corner lines, and its twin that loses too little."""
    case = mr.Case(wall, 0.5 * wall.alpha, 1.5, side_stop=False)
    contacts = mr.Contacts.from_law(wall, e, k_base=K_N, law="PUBLISHED")
    assert mr.solve_compliant(case, contacts).restitution[0] == pytest.approx(e.base, abs=0.0005)
    bounce = np.sqrt(contacts.base.stiffness.sum() / wall.mass)
    weaker = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=contacts.base.xi * contacts.base.frequency / bounce)
    assert mr.solve_compliant(case, weaker).restitution[0] > e.base + 0.01


@pytest.mark.slow
def test_overturning(wall, contacts):
    assert mr.solve_compliant(mr.Case(wall, 1.01 * wall.alpha, 5.0), contacts).outcome is mr.Outcome.OVERTURNED
    assert mr.solve_compliant(mr.Case(wall, 0.97 * wall.alpha, 5.0), contacts).outcome is not mr.Outcome.OVERTURNED


def test_a_hardly_damped_base_that_is_caught_and_released_often_ends(wall):
    contacts = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.0065)
    response = mr.solve_compliant(mr.Case(wall, 0.5 * wall.alpha, 1.5, side_stop=False), contacts)
    assert response.stats["switches"] > 2
    assert response.t[-1] == 1.5


@pytest.mark.parametrize("values", [{"rtol": 0}, {"atol": -1}, {"output_step": 0}])
def test_bad_tolerances(two_sided, contacts, values):
    with pytest.raises(ValueError, match="outside the valid range"):
        mr.solve_compliant(two_sided, contacts, **values)


def test_a_run_that_sticks_and_slips_without_end_is_an_error(wall, contacts, monkeypatch):
    """Here the first slip is one too many."""
    monkeypatch.setattr("mjrock.reference.compliant.MOST_SWITCHES", 1)
    case = mr.Case(wall, 0.3 * wall.alpha, 1.0, effects=mr.FrictionDamper(4.0, 1e6, 100.0))
    with pytest.raises(RuntimeError, match=r"base or dampers began to stick or slip 1 times by t = .* s; relax"):
        mr.solve_compliant(case, contacts)
