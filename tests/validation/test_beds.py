"""A bed of many lines against its side: steps that fit the motion roll about the place that friction holds."""

import numpy as np
import pytest

import mjrock as mr
from mjrock.study.matching.match import Combination


@pytest.mark.slow
def test_a_bed_loses_what_the_contact_law_loses():
    """One-sided, 16 lines on a stiff side: friction that held the edge itself would cost 1.2 % of the first rebound."""
    one = Combination(R=2.7, slenderness=10.8, k_base=5.6e8, k_side=1.6e9)
    e = mr.Restitution.from_geometry(one.wall.alpha)
    contacts = mr.Contacts.from_law(one.wall, e, one.k_base, one.k_side, mr.CALIBRATED_BED, 16)
    case = mr.Case(one.wall, 0.8 * one.wall.alpha, 5.0)
    law = mr.solve_compliant(case, contacts).restitution[:3]
    found = mr.simulate(case, contacts).restitution[:3]
    np.testing.assert_allclose(found[0], law[0], rtol=4e-3)
    np.testing.assert_allclose(found, law, rtol=1.5e-2)
    np.testing.assert_allclose(mr.simulate(case, contacts, accuracy=1e-5).restitution[:3], law, rtol=2.5e-3)
