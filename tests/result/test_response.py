from dataclasses import replace

import numpy as np
import pytest

import mjrock as mr
from mjrock.geometry.kinematics import gaps
from mjrock.problem.damping.contacts import Uplift
from mjrock.result.ending import ending
from mjrock.result.rocking import RotationHistory, peak_energies, restitution_of, rocking_history
from mjrock.scene.wall import wall_scene
from scripts.shared.paper import K_N


def test_history_of_a_sampled_theory_is_the_theory(two_sided, one_sided, e):
    for case in (two_sided, one_sided):
        exact = mr.solve_analytical(case, e, output_step=2e-3)
        _, peaks, impacts = rocking_history(
            case, RotationHistory(exact.t, exact.theta, exact.omega, exact.energy), Uplift(1e-3 * case.block.alpha, 0.0)
        )
        n = len(peaks)
        np.testing.assert_allclose(peaks, exact.peaks[:n], rtol=1e-4)
        for sampled, true in zip(impacts[: n - 1], exact.impacts, strict=False):
            assert sampled.t == pytest.approx(true.t, abs=2e-3)
            assert sampled.omega_before == pytest.approx(true.omega_before, rel=1e-4)
            assert sampled.omega_after == pytest.approx(true.omega_after, rel=1e-3)
            assert sampled.restitution == pytest.approx(true.restitution, rel=1e-3)


@pytest.mark.parametrize("side_stop", [False, True])
def test_history_of_a_shaken_theory_is_the_theory(wall, e, side_stop):
    """Impacts are found from the velocities at which the wall passes a small rotation: time, speed, and side."""
    motion = mr.GroundMotion.sine(1.0, 0.7, cycles=6, samples=200)
    case = mr.Case(wall, 0.4 * wall.alpha, 3.0, side_stop=side_stop, motion=motion)
    exact = mr.solve_analytical(case, e, output_step=1e-4)
    uplift = Uplift(2e-4 * wall.alpha, 1e-6)
    _, _, impacts = rocking_history(case, RotationHistory(exact.t, exact.theta, exact.omega, exact.energy), uplift)
    strong = [one for one in exact.impacts if abs(one.omega_after) > 0.03]
    assert len(strong) >= 2
    for true in strong:
        found = min(impacts, key=lambda one: abs(one.t - true.t))
        assert found.t == pytest.approx(true.t, abs=2e-3)
        assert found.omega_before == pytest.approx(true.omega_before, rel=2e-2)
        assert found.omega_after == pytest.approx(true.omega_after, rel=2e-2)
        assert found.energy_before == pytest.approx(0.5 * wall.toe_inertia * true.omega_before**2, rel=4e-2)
        assert found.energy_after == pytest.approx(0.5 * wall.toe_inertia * true.omega_after**2, rel=4e-2)


def test_a_run_that_ends_on_the_way_out_has_its_last_impact(two_sided, e):
    """There is not a peak after the impact, but the wall's energy is that of its rotation and its velocity."""
    exact = mr.solve_analytical(two_sided, e, output_step=1e-3)
    impact = exact.impacts[1]
    for later in (0.1, 0.2):
        n = np.searchsorted(exact.t, impact.t + later)
        assert abs(exact.theta[n]) > 1e-2 * two_sided.block.alpha
        history = exact.t[:n], exact.theta[:n], exact.omega[:n], exact.energy[:n]
        _, peaks, impacts = rocking_history(
            two_sided, RotationHistory(*history), Uplift(1e-3 * two_sided.block.alpha, 0.0)
        )
        assert (len(peaks), len(impacts)) == (2, 2)
        assert impacts[1].t == pytest.approx(impact.t, abs=1e-3)
        assert impacts[1].energy_after == pytest.approx(impact.energy_after, rel=1e-3)
        assert impacts[1].omega_after == pytest.approx(impact.omega_after, rel=1e-3)


def test_a_wall_that_stops_dead_has_one_impact_and_no_rebound(one_sided):
    t = np.linspace(0, 1, 1001)
    theta = np.maximum(0.05 * np.cos(2 * np.pi * t), 0) * (t < 0.5)
    theta += (t > 0.5) * 1e-5 * np.sin(20 * np.pi * t)
    _, peaks, impacts = rocking_history(
        one_sided, RotationHistory(t, theta, np.gradient(theta, t), 0 * t), Uplift(1e-3, 0.0)
    )
    assert len(peaks) == 1
    assert len(impacts) == 1
    assert impacts[0].t == pytest.approx(0.25, abs=2e-3)
    assert impacts[0].restitution < 0.05


def test_maxima_on_the_side_of_the_stop_are_not_rocking(one_sided, two_sided):
    t = np.linspace(0, 4, 4001)
    theta = 0.05 * np.cos(2 * np.pi * t)
    omega = np.gradient(theta, t)
    _, peaks, _ = rocking_history(two_sided, RotationHistory(t, theta, omega, 0 * t), Uplift(1e-3, 0.0))
    assert len(peaks) == 8
    _, peaks, _ = rocking_history(one_sided, RotationHistory(t, theta, omega, 0 * t), Uplift(1e-3, 0.0))
    assert len(peaks) == 4


def test_restitution_of_peaks(wall):
    energy = wall.potential_energy(0.05)
    peaks = [0.05, wall.rotation_at(0.81 * energy), wall.rotation_at(0.81 * 0.25 * energy), 0.0, 0.0]
    found = restitution_of(*peak_energies(mr.Case(wall, 0.05, 1.0), peaks))
    np.testing.assert_allclose(found[:3], [0.9, 0.5, 0.0], atol=1e-7)
    assert np.isnan(found[3])


def test_a_release_that_is_not_quite_still_is_one_peak(two_sided, e):
    exact = mr.solve_analytical(two_sided, e)
    for first in (1e-20, -1e-20, 1e-6):
        omega = exact.omega.copy()
        omega[0] = first
        _, peaks, impacts = rocking_history(
            two_sided, RotationHistory(exact.t, exact.theta, omega, exact.energy), Uplift(1e-4, 0.0)
        )
        np.testing.assert_allclose(peaks, exact.peaks[: len(peaks)], rtol=1e-4)
        assert impacts[0].restitution == pytest.approx(e.base, rel=1e-3)


def test_the_pose_is_that_of_the_wall(one_sided, contacts, e, wall):
    """x, z, theta of the one body; a rigid wall turns about its toe, a compliant one sinks into its base."""
    settled = wall.weight / contacts.base.stiffness.sum()
    for run in (
        mr.solve_analytical(one_sided, e),
        mr.simulate(one_sided, contacts),
        mr.simulate(one_sided, contacts, 1e-3),
        mr.solve_compliant(one_sided, contacts),
    ):
        assert run.pose.shape == (len(run.t), 1, 3)
        np.testing.assert_array_equal(run.pose[:, 0, 2], run.theta)
        rigid = wall.pose(run.theta)
        free = run.theta > 0.1 * wall.alpha
        depth = 0.0 if run.solver == "analytical" else 2 * settled
        np.testing.assert_allclose(run.pose[free, 0, 1], rigid[free, 1] - depth, atol=0.2 * settled)
        np.testing.assert_allclose(run.pose[free, 0, 0], rigid[free, 0], atol=0.2 * settled)


def test_a_response_prints_short_and_compares(one_sided, contacts, e):
    first, again = (mr.simulate(one_sided, contacts) for _ in range(2))
    theory = mr.solve_analytical(one_sided, e)
    assert first == again
    assert first != theory
    assert first != mr.simulate(one_sided, contacts, accuracy=1e-2)
    assert first != "a wall"
    counts = f"3001 samples over 3 s, {len(first.impacts)} impacts"
    assert repr(first) == f"<Response of MuJoCo: {counts}, largest rotation 0.5 alpha, at rest>"
    assert len(repr(theory)) < 120
    book = mr.simulate(one_sided, contacts, ledger=True).ledger
    assert repr(book).startswith("<Ledger over 3 s [J]: at the end held -")


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_wall_lifts_no_edge_while_its_energy_is_below_that_of_uplift(wall, share):
    """On springs without dashpots, tilted to just below or above the rotation of uplift, and let go.

    Its energy is then share^2 of the energy of uplift, of which two edges that both stick take next to nothing. Just
    below, both edges stay pressed. Just above, an edge has lifted and it rocks. It swings on, and rests in neither.
    """
    undamped = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.0)
    case = mr.Case(wall, share * undamped.uplift_rotation(wall), 2.0, side_stop=False)
    for run in (mr.simulate(case, undamped, 2e-4), mr.simulate(case, undamped)):
        assert run.outcome is mr.Outcome.TIME_ENDED
        assert "In the last second it moved by" in run.message
        lifted = gaps(wall_scene(case, undamped).places, run.pose[:, 0]).max()
        assert bool(lifted > 0) is (share > 1)
        if share < 1:
            np.testing.assert_allclose(run.energy, share**2 * Uplift.from_case(run.case, undamped).energy, rtol=5e-3)


@pytest.mark.parametrize(
    ("energy", "theta", "outcome"),
    [
        (0.999, 0.0, mr.Outcome.AT_REST),
        (1.001, 0.0, mr.Outcome.TIME_ENDED),
        (1.001, 0.999, mr.Outcome.TIME_ENDED),
        (1.001, -0.999, mr.Outcome.TIME_ENDED),
        (1.001, 1.001, mr.Outcome.OVERTURNED),
        (-9.0, -1.001, mr.Outcome.OVERTURNED),  # what has fallen has lost energy, and does not rest
    ],
)
def test_the_end_is_judged_by_the_last_sample(two_sided, wall, energy, theta, outcome):
    """Energy in shares of that of uplift, rotation in shares of alpha; what was a second before does not count."""
    t, uplift = np.array([0.0, 0.9, 2.0]), 3.0
    last = np.array([5.0, 0.0, energy]) * uplift, np.array([0.0, 0.5, theta]) * wall.alpha
    found, message = ending(two_sided, t, wall.pose(last[1]), last[0], uplift, np.zeros(3))
    assert found is outcome
    assert "2 s" in message


def over_a_curb(seed, factor, duration=6.0):
    """A wall under a record behind a curb of a tenth of its height, on a base that slides."""
    wall = mr.Block.from_size(0.8, 4.0, 6.0, 1800.0)
    held = mr.Contacts.from_law(wall, mr.Restitution.from_geometry(wall), k_base=1e9, k_side=1e9)
    slides = replace(held, base=replace(held.base, friction=0.6))
    motion = mr.GroundMotion.synthetic(peak=factor * mr.GRAVITY / 5, duration=6.0, seed=seed)
    return mr.Analysis(mr.Case(wall, 0.0, duration, side_stop=mr.SideStop(0.4), motion=motion), contacts=slides)


def test_a_wall_that_leans_inwards_over_a_low_stop_is_not_safe():
    task = over_a_curb(6, 5.5)
    leaning = task.solve()
    alpha, row = leaning.case.wall.alpha, task()
    assert leaning.peaks.max() < 0.9 * alpha < alpha < -leaning.theta.min()
    assert leaning.peak_over_alpha == leaning.inwards_over_alpha == pytest.approx(-leaning.theta.min() / alpha)
    limit = np.arctan2(0.4, 2.0 - 0.4)  # about the highest point of the stop
    assert leaning.case.inward_limit == pytest.approx(limit)
    assert row["peak_over_overturning"] == pytest.approx(-leaning.theta.min() / limit)
    assert row["inwards_over_alpha"] == leaning.inwards_over_alpha
    assert row["outcome"] == "time ended"
    assert mr.lost([row]).tolist() == [True]
    assert "leaned inwards over the side stop of 0.4 m, by up to 1.17 alpha" in row["message"]


def test_a_wall_that_turns_over_a_low_stop_has_overturned():
    turning = over_a_curb(2, 5.0).solve()
    assert -np.pi / 2 < turning.theta[-1] < -turning.case.inward_limit
    assert turning.outcome is mr.Outcome.OVERTURNED
    assert turning.peak_over_alpha == turning.peak_over_overturning == np.inf


@pytest.mark.parametrize("side_stop", [False, True])
def test_peak_over_the_rotation_that_overturns(wall, contacts, side_stop):
    """A load at the top lowers the rotation that overturns; a wall without effects has the one peak."""
    bare = mr.simulate(mr.Case(wall, 0.3 * wall.alpha, 0.2, side_stop=side_stop), contacts)
    assert bare.peak_over_overturning == pytest.approx(bare.peak_over_alpha)
    load = mr.Load(0.4 * wall.weight, height=2 * wall.h)
    loaded = mr.simulate(mr.Case(wall, 0.3 * wall.alpha, 0.2, side_stop=side_stop, effects=load), contacts)
    assert loaded.case.overturning_rotation < 0.8 * wall.alpha
    released = 0.3 * wall.alpha / loaded.case.overturning_rotation
    assert loaded.peak_over_overturning == pytest.approx(released)
    assert (loaded.inwards_over_alpha is None) == (not side_stop)


def test_a_stop_holds_a_wall_whose_centroid_it_reaches(wall):
    loads = mr.Load(0.2 * wall.weight, height=2 * wall.h, offset=-0.1), mr.Thrust(wall.h, 0.02 * wall.weight)
    stops = True, mr.SideStop(1.0), False
    whole, low, free = (mr.Case(wall, 0.0, 1.0, side_stop=stop, effects=loads) for stop in stops)
    assert whole.inward_limit == np.pi / 2
    assert free.inward_limit == free.restoring.inner.alpha
    rise = wall.h - 1.0
    held = wall.b + 0.2 * (wall.b - 0.1) + 0.02 * rise  # moment at rest over the weight [m], a thrust above the stop
    lost = rise + 0.2 * (2 * wall.h - 1.0) - 0.02 * wall.b
    assert low.inward_limit == pytest.approx(np.arctan2(held, lost))


def test_a_lopsided_wall_has_a_limit_on_either_side(wall, contacts):
    """A load near the outer edge: the wall overturns outwards from less than inwards."""
    load = mr.Load(0.3 * wall.weight, height=2 * wall.h, offset=0.2)
    case = mr.Case(wall, -0.3 * wall.alpha, 0.61, side_stop=False, effects=load)
    run = mr.simulate(case, contacts)
    shares = run.theta.max() / case.overturning_rotation, -run.theta.min() / case.inward_limit
    assert case.overturning_rotation < 0.8 * case.inward_limit
    assert run.theta.max() < -run.theta.min()
    assert shares[0] > shares[1]
    assert run.peak_over_overturning == pytest.approx(shares[0], rel=1e-4)
    assert run.inwards_over_alpha is None


def test_a_fall_is_followed_until_it_lies(wall, contacts):
    fallen = mr.simulate(mr.Case(wall, 1.05 * wall.alpha, 5.0), contacts)
    assert fallen.message.startswith(
        f"The wall overturned; it was followed until {fallen.t[-1]:.4g} s, when its rotation"
    )
