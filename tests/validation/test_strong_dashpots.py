"""What a base that holds means where dashpots are so strong that an edge is closed without pressing.

By the contact law friction needs a pressed edge, and `solve_compliant` has it so. MuJoCo finds normal force and
friction together, within a cone. With the large coefficient of a base that holds, an edge that friction drags is
pressed by it a little, and holds as long as it is closed. The two part from xi = 0.2 of the base on.
"""

import numpy as np
import pytest

import mjrock as mr
from mjrock.reference import equations


def held_while_closed(self, t, y):
    gaps = self.base_gap(y[1], y[2])
    return float(max(-gaps[0], -gaps[-1])) * self.base.k_n


@pytest.mark.slow
def test_mujoco_holds_an_edge_while_it_is_closed(monkeypatch):
    wall = mr.Block.from_slenderness(4.55, 1.64)
    case = mr.Case(wall, 0.67 * wall.alpha, 3.0)

    def found(xi, solve, **options):
        contacts = mr.Contacts.from_damping(wall, k_base=5.7e8, xi_base=xi, k_side=2.6e9, xi_side=0.0094, points=16)
        return solve(case, contacts, **options).restitution[0]

    # up to a tenth of critical damping the two agree
    assert found(0.1, mr.simulate, accuracy=1e-5) == pytest.approx(found(0.1, mr.solve_compliant), rel=2e-3)
    pressed, engine = found(0.3, mr.solve_compliant), found(0.3, mr.simulate, accuracy=1e-5)
    assert engine / pressed - 1 > 0.02
    monkeypatch.setattr(equations.Wall, "edge_load", held_while_closed)
    assert engine == pytest.approx(found(0.3, mr.solve_compliant), rel=2e-3)
    assert np.isfinite(engine)
