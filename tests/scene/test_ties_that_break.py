"""Ties that break: closed forms of the energy, the motion after the break, and what is told of it."""

import math

import numpy as np
import pytest
from scenes import changed, course

import mjrock as mr
from mjrock.engine.energy_work import ledger
from mjrock.engine.model import engine_of
from mjrock.engine.stepping import fitted_steps
from mjrock.problem.wall.effect import LinkLaw
from mjrock.problem.wall.restoring_moment import dissipated_by_ties, yielded
from mjrock.scene.parts import Links
from mjrock.scene.potential import breaks
from mjrock.scene.wall import wall_scene

K, STRENGTH, ULTIMATE, SLACK, SPEED = 2e6, 2e4, 0.01, 0.02, 0.5
"""Of a tie on a mass that slides away from it [N/m, N, m, m, m/s]."""


@pytest.fixture
def sliding(wall, contacts):
    """The wall on a base without friction, tied to an anchor 5 m behind its centroid, and half a second of it."""
    standing = wall_scene(mr.Case(wall, 0.0, 1.0, side_stop=False), contacts)
    ends = ("tie",), [0], [(0.0, 0.0)], [-1], [(-5.0, standing.bodies.rest[0, 1])]
    tie = Links(*ends, [LinkLaw(K, 5.0 + SLACK, STRENGTH, ultimate=ULTIMATE)])
    scene = changed(standing, links=tie, contacts={"friction": [0.0, 0.0]}, settled=None)
    return scene, course(scene, [[SPEED, 0.0, 0.0]], 0.5)


def kicked(wall, tie, share, duration=3.0):
    """A wall that is kicked outwards with a share of the energy that overturns it without the tie."""
    bare = mr.Case(wall, 0.0, duration)
    energy = share * float(bare.restoring.outer.energy(wall.alpha))
    speed = math.sqrt(2 * energy / wall.toe_inertia)
    return mr.Case(wall, 0.0, duration, omega0=speed, effects=tie), energy


def brittle(wall, **changed):
    return mr.Tie(
        **{"height": 1.8 * wall.h, "stiffness": 2e6, "slack": 1e-3, "strength": 4e3, "ultimate": 0.01} | changed
    )


@pytest.mark.parametrize("accuracy", [1e-3, 1e-5])
def test_a_mass_that_breaks_its_tie(sliding, accuracy):
    """m v^2/2 falls by T u + T^2/(2 k); the break comes after slack, quarter sine and constant force."""
    scene, away = sliding
    with engine_of(scene) as engine:
        engine.place(away)
        steps = fitted_steps(engine, scene, away, accuracy)
    mass, books = scene.bodies.mass[0], ledger(scene, away, steps)
    elastic = STRENGTH**2 / (2 * K)
    left = math.sqrt(SPEED**2 - 2 * (STRENGTH * ULTIMATE + elastic) / mass)
    assert steps.record.after[-1, 0] == pytest.approx(left, rel=accuracy)
    assert books.ties["tie"][-1] == pytest.approx(STRENGTH * ULTIMATE, rel=1e-9)
    assert books.broken["tie"][-1] == pytest.approx(elastic, rel=1e-12)
    assert np.abs(books.residual).max() < 2 * accuracy * 0.5 * mass * SPEED**2
    omega, stretch, slows = math.sqrt(K / mass), STRENGTH / K, STRENGTH / mass
    entering = math.sqrt(SPEED**2 - 2 * elastic / mass)
    sprung = math.asin(stretch * omega / SPEED) / omega
    yields = (entering - math.sqrt(entering**2 - 2 * slows * ULTIMATE)) / slows
    broken = steps.windows.t[breaks(scene.ties, steps.pose)[0]]
    assert broken == pytest.approx(SLACK / SPEED + sprung + yields, abs=accuracy * 0.05)


@pytest.mark.parametrize("ultimate", [0.0, 0.01])
def test_energy_of_a_wall_that_breaks_its_tie(wall, contacts, e, ultimate):
    """In theory the potential energy at the peak is that of the kick less T u + T^2/(2 k)."""
    tie = brittle(wall, ultimate=ultimate)
    case, energy = kicked(wall, tie, 0.6)
    theory = mr.solve_analytical(case, e)
    lost = 0.5 * tie.strength**2 / tie.stiffness
    peak = case.restoring.outer.rotation_at(energy - tie.strength * ultimate - lost)
    assert theory.peaks[0] == pytest.approx(peak, rel=1e-9)
    done = theory.plastic["tie_0"]
    assert done[:2] == pytest.approx((ultimate, tie.strength * ultimate), rel=1e-12)
    assert done.lost == pytest.approx(lost)
    engine = mr.simulate(case, contacts, ledger=True, accuracy=1e-4)
    assert engine.plastic["tie_0"] == pytest.approx(done, rel=2e-2)
    assert engine.plastic["tie_0"][:2] == pytest.approx(done[:2], rel=1e-9)
    assert engine.ledger.broken["tie_0"][-1] == pytest.approx(lost)
    assert np.abs(engine.energy_residual).max() < 5e-3 * energy
    for response in (theory, engine, mr.solve_explicit(case, contacts)):
        assert f"tie_0 broke at {response.plastic['tie_0'].broken:.4g} s" in response.message
        motion = response.ties["tie_0"]
        assert motion.force[response.t >= motion.broken].max() == 0
        assert motion.largest_force == tie.strength
        assert motion.plastic[-1] == ultimate


def test_a_tie_that_yields_between_two_samples_has_borne_its_strength(wall, e):
    tie = brittle(wall, ultimate=None)
    case, _ = kicked(wall, tie, 0.3, duration=1.0)
    motion = mr.solve_analytical(case, e, output_step=1.0).ties["tie_0"]
    assert len(motion.force) == 2
    assert motion.force.max() < 0.9 * tie.strength
    assert motion.largest_force == tie.strength


def test_from_the_break_on_the_wall_is_one_without_a_tie(wall, contacts, e):
    tie = brittle(wall)
    case, _ = kicked(wall, tie, 0.6)
    theory = mr.solve_analytical(case, e)
    broken = theory.plastic["tie_0"].broken
    after = theory.t > broken + 1e-3
    i = int(np.flatnonzero(after)[0])
    bare = mr.Case(wall, theory.theta[i], 3.0 - theory.t[i], omega0=theory.omega[i])
    without = mr.solve_analytical(bare, e)
    np.testing.assert_allclose(
        np.interp(theory.t[i:] - theory.t[i], without.t, without.theta), theory.theta[i:], atol=1e-6
    )
    engine = mr.simulate(case, contacts, accuracy=1e-5)
    i = int(np.flatnonzero(engine.t > engine.plastic["tie_0"].broken + 1e-3)[0])
    start = engine.pose[i], engine.velocity[i]
    bare = mr.simulate(mr.Case(wall, 0.0, 3.0 - engine.t[i]), contacts, accuracy=1e-5, start=start)
    until = engine.t[i:] < 1.5
    same = np.interp(engine.t[i:] - engine.t[i], bare.t, bare.theta)
    np.testing.assert_allclose(same[until], engine.theta[i:][until], atol=2e-3 * wall.alpha)


def test_a_tie_that_never_comes_so_far_changes_no_digit(wall, contacts, e):
    kick = [kicked(wall, brittle(wall, ultimate=u), 0.6)[0] for u in (None, 1.0)]
    for solve in (lambda case: mr.solve_analytical(case, e), lambda case: mr.simulate(case, contacts, ledger=True)):
        left, right = map(solve, kick)
        assert np.array_equal(left.pose, right.pose)
        assert left.message == right.message
        assert left.plastic == right.plastic


def test_a_slack_tie_pulls_nothing(wall, contacts, e):
    case, _ = kicked(wall, brittle(wall, slack=10.0), 0.6)
    for solve in (lambda case: mr.solve_analytical(case, e), lambda case: mr.simulate(case, contacts)):
        tie = solve(case).ties["tie_0"]
        assert tie.largest_force == 0
        assert not tie.force.any()


def test_the_next_run_of_the_same_wall_has_a_whole_tie(wall, contacts):
    """Compiled models are kept for the next run, and the state of their ties is not."""
    case, _ = kicked(wall, brittle(wall), 0.6)
    assert np.array_equal(mr.simulate(case, contacts).pose, mr.simulate(case, contacts).pose)


def test_a_release_that_has_broken_the_tie(wall, contacts, e):
    """The tie that the tilt has torn does nothing, and the ledger starts after it."""
    tilted = {"theta0": 0.5 * wall.alpha, "duration": 1.5}
    case, bare = mr.Case(wall, **tilted, effects=brittle(wall)), mr.Case(wall, **tilted)
    theory, engine = mr.solve_analytical(case, e), mr.simulate(case, contacts, ledger=True)
    np.testing.assert_allclose(theory.theta, mr.solve_analytical(bare, e).theta, atol=1e-8)
    np.testing.assert_allclose(engine.theta, mr.simulate(bare, contacts).theta, atol=2e-3 * wall.alpha)
    assert theory.plastic["tie_0"].broken == engine.plastic["tie_0"].broken == 0
    assert engine.ledger.broken["tie_0"].max() == engine.ledger.ties["tie_0"].max() == 0


@pytest.mark.slow
def test_the_push_over_curve_falls_to_that_without_the_tie(wall, contacts):
    tie = brittle(wall)
    case, bare = mr.Case(wall, 0.0, 1.0, effects=tie), mr.Case(wall, 0.0, 1.0)
    tears = (tie.slack + tie.stretch + tie.ultimate) / tie.height  # rotation, to first order
    below, beyond = 0.97 * tears, np.array([1.1, 2.0, 3.0]) * tears
    for on in (None, contacts):
        curve = mr.pushover(case, on, rotations=np.append(below, beyond))
        without = mr.pushover(bare, on, rotations=np.append(below, beyond))
        assert curve.multiplier[0] - without.multiplier[0] > 0.5 * tie.strength * 1.8 / wall.weight
        np.testing.assert_allclose(curve.multiplier[1:], without.multiplier[1:], rtol=1e-6)
        assert mr.pushover(case, on).end == pytest.approx(mr.pushover(bare, on).end, rel=1e-6)
    assert case.overturning_rotation == pytest.approx(bare.overturning_rotation, abs=1e-3)


def test_what_ties_have_taken_with_those_that_broke(wall):
    """By hand: T u + T^2/(2 k) of the broken one, T times the plastic elongation of the other."""
    broken, whole = brittle(wall), brittle(wall, ultimate=None)
    pulls = mr.Case(wall, 0.0, 1.0, effects=(broken, whole)).pulls
    plastic = yielded(pulls, np.array([0.0, 0.3, 0.1]) * wall.alpha)
    assert np.isinf(plastic[1:, 0]).all()
    own = broken.strength * broken.ultimate + 0.5 * broken.strength**2 / broken.stiffness
    assert dissipated_by_ties(pulls, plastic) == pytest.approx([0.0, *2 * [own + whole.strength * plastic[1, 1]]])


def test_a_tie_of_masonry_breaks(wall):
    column = mr.Masonry.stack([wall], 5e8)
    tie = brittle(wall, block=column.free[0])
    push = mr.GroundMotion.half_sine(-4.0, 0.3)
    answer = mr.simulate(mr.MasonryCase(column, 0.8, motion=push, effects=tie), ledger=True)
    assert answer.plastic["tie_0"].broken < 0.8
    assert "tie_0 broke" in answer.message
    motion = answer.ties["tie_0"]
    assert np.nanmax(motion.elongation) == pytest.approx(tie.stretch + tie.ultimate, rel=0.15)


def test_a_fixed_step_refuses_by_name(wall, contacts):
    case, _ = kicked(wall, brittle(wall), 0.6)
    with pytest.raises(ValueError, match=r"ultimate = 0.01 m; leave timestep out, so that .*, or leave ultimate out"):
        mr.simulate(case, contacts, 1e-4)


@pytest.mark.parametrize(
    ("changed", "complaint"),
    [
        ({"ultimate": -0.01}, "ultimate of the tie = -0.01 m is outside the valid range 0 to 10 m"),
        ({"ultimate": 50.0}, "ultimate of the tie = 50 m is outside"),
        ({"ultimate": math.nan}, "ultimate of the tie = nan m is outside"),
        ({"strength": math.inf}, "its strength is infinite"),
    ],
)
def test_ties_that_cannot_be(wall, changed, complaint):
    with pytest.raises(ValueError, match=complaint):
        brittle(wall, **changed)


def test_a_bar_that_is_drawn_out_too_far_is_warned_of(wall, contacts, e):
    """A hundred millimetres of a bar of half a metre."""
    soft = brittle(wall, ultimate=None, strength=2e3, length=0.5)
    case, _ = kicked(wall, soft, 0.6)
    for solve, given in ((mr.solve_analytical, e), (mr.simulate, contacts), (mr.solve_explicit, contacts)):
        with pytest.warns(UserWarning, match=r"tie_0 was drawn out by .* of its length of 0.5 m") as caught:
            solve(case, given)
        assert caught[0].filename == __file__


@pytest.mark.parametrize("solver", ["analytical", "compliant", "MuJoCo"])
def test_rows_say_what_ties_did(wall, contacts, e, solver):
    """Two ties: the first breaks but where the solver has only springs, the second stays a spring."""
    spring = mr.Tie(height=1.8 * wall.h, stiffness=1e4)
    ties = (spring,) if solver == "compliant" else (brittle(wall), spring)
    case, _ = kicked(wall, ties, 0.6, duration=1.0)
    row = mr.Analysis(case, solver, e=e, contacts=contacts)()
    last = f"tie_{len(ties) - 1}"
    assert [row[f"{last}_{name}"] for name in ("elongation_m", "energy_J", "broken_s")] == [0, 0, None]
    assert 0 < row[f"{last}_force_N"] < 1e4
    if solver != "compliant":
        assert (row["tie_0_elongation_m"], row["tie_0_force_N"]) == pytest.approx((0.01, 4e3), rel=1e-9)
        assert row["tie_0_energy_J"] == pytest.approx(4e3 * 0.01 + 4.0)
        assert 0 < row["tie_0_broken_s"] < 0.5
