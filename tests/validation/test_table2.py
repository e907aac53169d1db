"""The paper's Table 2: damping ratios of six specimens."""

import math
from contextlib import nullcontext

import pytest
from everyday import among

import mjrock as mr
from scripts.shared.paper import K_N, TABLE_2

specimens = pytest.mark.parametrize("specimen", TABLE_2, ids=lambda s: s.slug)


@specimens
def test_equation_5(specimen):
    """To the printed digit; the table cuts digits off (4.249 % is printed 4.24)."""
    xi = mr.PUBLISHED.base(specimen.block.slenderness, K_N, specimen.restitution.base)
    assert math.floor(1e4 * xi) == round(1e4 * specimen.xi_base)


@specimens
def test_equation_6(specimen):
    xi = mr.PUBLISHED.side(specimen.block.slenderness, K_N, specimen.restitution.side)
    assert xi == pytest.approx(specimen.xi_side, rel=0.05)


def test_other_exponents_fail():
    """The twin that must fail: a thousandth more or less on the exponent that the paper misprints."""
    for exponent in (0.342, 0.344):
        law = mr.PowerLaw(0.000292, 0.935, exponent, 0.978)
        values = [law(s.block.slenderness, K_N, s.restitution.base) for s in TABLE_2]
        assert sum(math.floor(1e4 * xi) == round(1e4 * s.xi_base) for xi, s in zip(values, TABLE_2, strict=True)) < 3


@specimens
def test_geometry_and_warning(specimen):
    assert specimen.block.alpha == pytest.approx(specimen.alpha, rel=1e-12)
    assert 2 * specimen.block.h == specimen.height
    with pytest.warns(UserWarning, match="outside the range of the fit"):
        mr.PUBLISHED(specimen.block, specimen.restitution, K_N)


@pytest.mark.parametrize("specimen", among(TABLE_2, *TABLE_2[::4]), ids=lambda s: s.slug)
def test_mujoco_follows_the_contact_law(specimen):
    """The slenderest specimen, h/b 27, is warned of: its rebound ends before an edge lifts off its base."""
    block, e = specimen.block, specimen.restitution
    lifts = specimen.slug != "brick_h163_cd06_t01"
    with (
        nullcontext()
        if lifts
        else pytest.warns(UserWarning, match="the base is too soft for the rebound that e requires")
    ):
        contacts = mr.Contacts.from_law(block, e, k_base=K_N, k_side=K_N, law="PUBLISHED")
    case = mr.Case(block, 0.5 * block.alpha, 0.8)
    found = mr.compare(mr.solve_compliant(case, contacts), mr.simulate(case, contacts))
    if not lifts:
        run = found.candidate
        assert run.theta[run.t > run.impacts[0].t].max() < 0.1 * contacts.uplift_rotation(block)
    assert found.rms < 0.003
    share = [impact.restitution for impact in (found.reference.impacts[0], found.candidate.impacts[0])]
    assert share[1] == pytest.approx(share[0], abs=0.01)
