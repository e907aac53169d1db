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
        ({"motion": "NF13"}, r"motion = 'NF13' of type str is not a GroundMotion"),
    ],
)
def test_bad_values_are_named(wall, values, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
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


def test_degrees_instead_of_radians_are_noticed(wall):
    with pytest.warns(UserWarning, match="theta0 = 1.2 rad is 8.46 alpha"):
        mr.Case(wall, 1.2, 1.0)


@pytest.mark.parametrize("speed", [pytest.param(0.05, marks=pytest.mark.slow), 0.1])
def test_pushed_against_the_stop_is_an_impact_at_once(wall, contacts, e, speed):
    """All three solvers agree on a wall that starts upright and is thrown against its stop."""
    case = mr.Case(wall, 0.0, 2.0, omega0=-speed * wall.p)
    theory, law, run = (
        mr.solve_analytical(case, e),
        mr.solve_compliant(case, contacts),
        mr.simulate(case, contacts, accuracy=1e-4),
    )
    assert theory.theta.min() >= -1e-12
    assert theory.impacts[0].t == 0.0
    assert theory.impacts[0].restitution == pytest.approx(abs(e.lumped))
    assert run.theta.max() == pytest.approx(law.theta.max(), rel=0.02)


def test_energy_beyond_overturning_counts_in_full(wall, e):
    case = mr.Case(wall, 0.99 * wall.alpha, 3.0, omega0=-0.2 * wall.p)
    response = mr.solve_analytical(case, e)
    assert case.release_energy > wall.potential_energy(wall.alpha)
    assert response.restitution[0] == pytest.approx(abs(e.lumped), rel=1e-6)
    assert response.impacts[0].energy_before == pytest.approx(case.release_energy, rel=1e-8)
