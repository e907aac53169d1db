"""Every rebound on a stiff base: steps that fit the motion keep what the contact law keeps."""

import numpy as np
import pytest

import mjrock as mr
from mjrock.engine import loop, sticking
from scripts.shared.paper import FIGURE_3

FIRST = 5


def wall_on(k_n):
    """The Figure 3 wall against its side, with damping that is about right on every base."""
    contacts = mr.Contacts.from_damping(FIGURE_3, k_base=k_n, xi_base=0.06, k_side=k_n, xi_side=0.0113)
    return mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 2.2), contacts


@pytest.mark.parametrize("k_n", [5e8, *(pytest.param(k_n, marks=pytest.mark.slow) for k_n in (5e9, 5e10, 5e11))])
def test_every_rebound_is_that_of_the_contact_law(k_n):
    """Within 1e-3 at the default accuracy, and within 1e-4 at 1e-4, up to 5e10 N/m3.

    On 5e11 N/m3 the fifth rebound, of 7e-5 alpha, is within 2.5e-3 and 1e-3.
    """
    case, contacts = wall_on(k_n)
    law = mr.solve_compliant(case, contacts, rtol=1e-9).restitution[:FIRST]
    assert len(law) >= (5 if k_n > 1e10 else 3)
    found = mr.simulate(case, contacts).restitution[: len(law)]
    np.testing.assert_allclose(found[:4], law[:4], atol=1e-3)
    np.testing.assert_allclose(found, law, atol=1e-3 if k_n < 1e11 else 2.5e-3)
    finer = mr.simulate(case, contacts, accuracy=1e-4).restitution[: len(law)]
    np.testing.assert_allclose(finer, law, atol=1e-4 if k_n < 1e11 else 1e-3)


@pytest.mark.slow
def test_an_edge_that_drifts_fails(monkeypatch):
    """The twin that must fail: as plain Python, so that the rule can be taken out of the loop."""
    case, contacts = wall_on(5e10)
    law = mr.solve_compliant(case, contacts, rtol=1e-9).restitution[:FIRST]
    py = getattr(loop.fitted_loop, "py_func", loop.fitted_loop)
    monkeypatch.setattr("mjrock.engine.stepping.fitted_loop", py)
    whole = mr.simulate(case, contacts)
    np.testing.assert_allclose(whole.restitution[:FIRST], law, atol=1e-3)
    monkeypatch.setattr(sticking, "put_back", lambda *_: None)
    drifting = mr.simulate(case, contacts).restitution[:FIRST]
    assert np.abs(drifting - law).max() > 2e-3
