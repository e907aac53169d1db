import math

import pytest

import mjrock as mr


@pytest.mark.parametrize(
    ("values", "complaint"),
    [
        ({"theta0": 4.0}, r"theta0 = 4 rad is outside the valid range 0 to 1.5708 rad"),  # degrees
        ({"theta0": -0.01}, r"theta0 = -0.01 rad"),  # into the side stop
        ({"theta0": math.nan}, r"theta0 = nan"),
        ({"duration": 0.0}, r"duration = 0 s"),
        ({"duration": math.inf}, r"duration = inf s"),
        ({"omega0": 1e6}, r"omega0"),
        ({"motion": "NF13"}, r"motion must be None"),
    ],
)
def test_bad_values_are_named(wall, values, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.Case(wall, **{"theta0": 0.05, "duration": 1.0} | values)


def test_two_sided_walls_may_lean_either_way(wall):
    assert mr.Case(wall, -0.05, 1.0, side_stop=False).direction == -1


def test_release_energy_and_peak(wall):
    still = mr.Case(wall, 0.05, 1.0)
    assert still.release_peak == 0.05
    moving = mr.Case(wall, 0.05, 1.0, omega0=-0.1)
    assert moving.release_energy == pytest.approx(still.release_energy + 0.005 * wall.toe_inertia)
    assert wall.potential_energy(moving.release_peak) == pytest.approx(moving.release_energy)
    assert mr.Case(wall, 0.05, 1.0, omega0=0.1).released_outwards
