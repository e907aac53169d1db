"""Plain models of walls: the law of the contacts at every rebound, the text, what stands, and what is refused."""

import mujoco
import numpy as np
import pytest
from everyday import slow

import mjrock as mr
from scripts.measure.rebound_phase import Fall

WALL = mr.Block.from_size(thickness=0.6, height=4.2, length=1.0, density=2000.0)
LAW = mr.Contacts.from_law(WALL, mr.Restitution.from_geometry(WALL), k_base=5e8, k_side=5e8)
PLAIN = {"collisions": True, "ledger": True, "forces": True}


def released(wall=WALL, **options):
    """The case of a wall that is released at half of its slenderness."""
    return mr.Case(wall, **{"theta0": 0.5 * wall.alpha, "duration": 1.2, "side_stop": True} | options)


@pytest.mark.parametrize(("duration", "timestep"), [(1.0, 1e-4), slow((1.2, None))])
def test_the_law_carries_over_to_contacts_that_mujoco_finds(duration, timestep):
    """The first rebound from the side stop within 1 % of `solve_compliant`, whose kinematics it does not share."""
    case = released(duration=duration)
    plain = mr.simulate(case, LAW, timestep=timestep, **PLAIN)
    assert plain.restitution[0] == pytest.approx(mr.solve_compliant(case, LAW).restitution[0], rel=0.01)
    assert np.abs(plain.energy_residual).max() < 0.01 * plain.ledger.largest


def test_both_edges_lose_what_the_law_has():
    case = released(theta0=0.3 * WALL.alpha, side_stop=False, duration=1.1)
    plain, law = mr.simulate(case, LAW, timestep=2e-4, **PLAIN), mr.solve_compliant(case, LAW)
    assert plain.restitution[0] == pytest.approx(law.restitution[0], rel=0.001)


def test_a_wall_with_crushed_edges_rocks_about_them():
    """Its section is cut off at an angle beside the edges."""
    wall = mr.Block.from_size(thickness=0.6, height=4.2, length=1.0, density=2000.0, inset=0.03)
    law = mr.Contacts.from_law(wall, mr.Restitution.from_geometry(wall), k_base=5e8)
    case = released(wall, theta0=0.3 * wall.alpha, side_stop=False, duration=1.1)
    plain = mr.simulate(case, law, timestep=2e-4, **PLAIN)
    assert plain.restitution[0] == pytest.approx(mr.solve_compliant(case, law).restitution[0], rel=0.001)


def test_the_text_of_a_wall_is_short_and_its_steps_are_the_run():
    case = released(duration=0.3)
    text = mr.mjcf_of(case, LAW, 2e-4, collisions=True)
    run = mr.simulate(case, LAW, 2e-4, output_step=2e-4, collisions=True)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for pose in run.pose[:, 0]:
        assert (data.qpos == pose).all()
        mujoco.mj_step(model, data)
    assert len(text.splitlines()) <= 40
    assert max(map(len, text.splitlines())) < 280
    assert text == mr.mjcf_of(case, LAW, 2e-4, collisions=True)


def test_a_wall_that_overturns_comes_to_lie_on_its_face():
    """It is followed to the ground: turned by a right angle, its centroid half a thickness above the base. Its face
    meets the base with the springs of its joint, and sinks in as it lands."""
    case = mr.Case(WALL, theta0=1.5 * WALL.alpha, duration=3.0, side_stop=False)
    with pytest.warns(UserWarning, match="base and wall lie inside each other by 2"):
        run = mr.simulate(case, LAW, timestep=3e-4, collisions=True)
    assert run.outcome is mr.Outcome.OVERTURNED
    assert run.theta[-1] == pytest.approx(0.5 * np.pi, abs=1e-4)
    assert WALL.centroid_height + run.pose[-1, 0, 1] == pytest.approx(0.3, abs=1e-3)
    assert np.abs(run.velocity[-1]).max() < 1e-3


EFFECTS = {
    "tie": (mr.Tie(height=4.0, stiffness=2e6, slack=0.005, strength=2e5),),
    "load": (mr.Load(force=2e4, height=4.2, offset=0.1), mr.AddedMass(mass=500.0, height=4.0)),
    "damper": (mr.Damper(height=4.0, c=5e4),),
    "thrust": (mr.Thrust(height=4.0, force=1e3),),
}


@pytest.mark.parametrize(
    ("name", "timestep"),
    [*((name, 2e-4) for name in ("load", "damper", "tie")), *(slow((name, None)) for name in EFFECTS)],
)
def test_effects_act_as_in_models_of_contact_points(name, timestep):
    """At the same step: the rotation, and the whole ledger, to the first rebound."""
    case = released(effects=EFFECTS[name], duration=0.5)
    plain = mr.simulate(case, LAW, timestep=timestep, **PLAIN)
    points = mr.simulate(case, LAW, timestep=plain.stats["timestep"], output_step=1e-3, ledger=True)
    np.testing.assert_allclose(plain.theta, np.interp(plain.t, points.t, points.theta), atol=1e-3 * WALL.alpha)
    for part in ("ties", "dashpots"):
        for of, account in getattr(points.ledger, part).items():
            mine = getattr(plain.ledger, part)[of][-1]
            assert mine == pytest.approx(account[-1], abs=0.02 * points.ledger.largest)
    assert np.abs(plain.energy_residual).max() < 0.01 * plain.ledger.largest


@pytest.mark.parametrize("duration", [0.9, slow(1.2)])
def test_a_shaken_wall_moves_as_on_contact_points(duration):
    case = mr.Case(WALL, theta0=0.0, duration=duration, motion=mr.GroundMotion.sine(-2.0, 0.8), side_stop=False)
    plain = mr.simulate(case, LAW, timestep=2e-4, **PLAIN)
    points = mr.simulate(case, LAW, ledger=True)
    late = np.interp(plain.t, points.t, points.theta)
    np.testing.assert_allclose(plain.theta, late, atol=0.01 * plain.peak[0])
    assert plain.ledger.ground[-1] == pytest.approx(points.ledger.ground[-1], rel=0.01)


@pytest.mark.parametrize(("duration", "first_duration"), [(0.2, 0.1), slow((0.4, 0.1))])
def test_a_run_carries_on_from_its_end(duration, first_duration):
    """The leapfrog starts anew, so that the two agree to the second order of the step."""
    whole = mr.simulate(released(duration=duration), LAW, timestep=1e-4, collisions=True)
    first = mr.simulate(released(duration=first_duration), LAW, timestep=1e-4, collisions=True)
    remaining = released(duration=duration - first_duration)
    rest = mr.simulate(remaining, LAW, timestep=1e-4, collisions=True, start=first.end)
    assert rest.theta[-1] == pytest.approx(whole.theta[-1], abs=1e-5 * WALL.alpha)


def test_the_step_follows_from_the_stiffest_contact():
    run = mr.simulate(released(duration=0.01), LAW, collisions=True)
    assert 0.09 < run.stats["resolved"] <= 0.1
    assert run.t == pytest.approx(np.arange(11) * 1e-3)
    assert run.solver == "plain MuJoCo"


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"accuracy": 1e-3}, "accuracy = 0.001 does not go with collisions"),
        ({"coulomb": True}, "coulomb = True does not go"),
        ({"newmark_beta": 0.1}, "newmark_beta = 0.1 does not go"),
        ({"timestep": -1e-3}, "timestep = -0.001 s is outside the valid range"),
        ({"timestep": float("nan")}, "timestep"),
        ({"output_step": 5.0}, "output_step = 5 s is outside the valid range"),
    ],
)
def test_what_does_not_go_with_collisions_is_refused_by_name(given, message):
    with pytest.raises(ValueError, match=message):
        mr.simulate(released(), LAW, **{"collisions": True} | given)
    with pytest.raises(TypeError, match="collisions"):
        mr.simulate(released(), LAW, collisions="yes")


def test_ties_that_break_are_refused():
    tie = mr.Tie(height=4.0, stiffness=2e6, strength=2e4, ultimate=0.1)
    for ask in (
        lambda case: mr.simulate(case, LAW, collisions=True),
        lambda case: mr.mjcf_of(case, LAW, 1e-4, collisions=True),
    ):
        with pytest.raises(ValueError, match="tie_0 has ultimate"):
            ask(released(effects=(tie,)))


@pytest.mark.slow
def test_the_mean_over_the_phase_of_a_touch_is_right_and_its_scatter_is_of_first_order():
    """|e| over evenly spaced places of the touch in a step; the mean is within half a percent at .2 ms."""
    e = {h: Fall(WALL, 5e8, h).over_phases(40) for h in (4e-4, 2e-4)}
    law = Fall(WALL, 5e8, 2e-4).law
    assert e[2e-4].mean() == pytest.approx(law, rel=5e-3)
    assert e[4e-4].std() / e[2e-4].std() == pytest.approx(2, rel=0.1)
    assert 0.01 < e[2e-4].std() / law < 0.04
