"""Explicit steps: closed forms, conservation, an independent integration, the contact law of a wall, and MuJoCo."""

import math
import time

import numpy as np
import pytest
from explicit_blocks import explicit
from masonry_blocks import GROUND, box, columns

import mjrock as mr
from mjrock.scene.masonry import masonry_course

PULSE = mr.GroundMotion.sine(2.0, 0.7)
CUBE = mr.Masonry([GROUND, box(-0.5, 0.5, 0, 1, name="cube")], k_n=1e9, friction=0.5, xi=0.05)


def solve(masonry, duration, motion=None, *, timestep=None, ledger=False, **options):
    return mr.solve_explicit(mr.MasonryCase(masonry, duration, motion, **options), timestep=timestep, ledger=ledger)


def test_free_flight():
    """A block that is thrown up flies on a parabola, spins steadily, and keeps its energy."""
    run = solve(CUBE, 0.5, velocity=[(1.0, 4.0, 2.0)], ledger=True)
    t = run.t[run.t > 0.05]
    pose = run.pose[run.t > 0.05, 0]
    path = np.column_stack([t, -0.5 * mr.GRAVITY * t**2, 0 * t]) * [1.0, 1.0, 1.0] + np.outer(t, [0.0, 4.0, 2.0])
    np.testing.assert_allclose(pose - pose[0], path - path[0], atol=2e-4)
    assert np.ptp(run.energy[run.t > 0.05]) < 1e-6 * run.energy[0]


@pytest.mark.parametrize("k_s", [None, 1e9])
def test_a_cube_slides_to_where_coulomb_stops_it(k_s):
    masonry = mr.Masonry(CUBE.blocks, k_n=1e9, friction=0.5, xi=0.05, k_s=k_s)
    run = solve(masonry, 1.2, velocity=[(4.0, 0.0, 0.0)], ledger=True)
    assert run.pose[-1, 0, 0] == pytest.approx(16 / (2 * 0.5 * mr.GRAVITY), rel=1e-3)
    assert np.abs(run.velocity[-1]).max() < 1e-3
    assert np.abs(run.energy_residual).max() < 2e-4 * run.energy[0]
    assert run.ledger.friction[-1] == pytest.approx(run.energy[0], rel=5e-3)


def test_rigid_friction_holds_to_its_last():
    """A push on a block at rest: it stays below the friction, and slides with a = (a_g - mu g) above it."""
    slope = np.minimum(np.linspace(0, 2, 201), 1.0)
    for share in (0.95, 1.2):
        push = mr.GroundMotion(-share * 0.5 * mr.GRAVITY * slope, 0.01)
        run = solve(CUBE, 2.0, push)
        beyond = np.maximum(share * slope - 1, 0.0) * 0.5 * mr.GRAVITY  # over the friction, at the samples of the push
        speed = np.concatenate([[0], np.cumsum(0.5 * (beyond[1:] + beyond[:-1]) * 0.01)])
        far = np.sum(0.5 * (speed[1:] + speed[:-1])) * 0.01
        slipped = run.pose[-1, 0, 0] - run.pose[0, 0, 0] - 0.5 * run.pose[-1, 0, 2]  # the base, under the centroid
        assert slipped == pytest.approx(far, rel=5e-3, abs=1e-5)


@pytest.mark.parametrize("side_stop", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_a_wall_loses_what_the_contact_law_loses(side_stop, contacts, wall):
    case = mr.Case(wall, 0.5 * wall.alpha, 3.0, side_stop=side_stop)
    law, run = mr.solve_compliant(case, contacts), mr.solve_explicit(case, contacts, ledger=True)
    count = min(len(law.restitution), len(run.restitution), 3)
    np.testing.assert_allclose(run.restitution[:count], law.restitution[:count], rtol=2e-3)
    assert np.abs(run.energy_residual).max() < 1e-3 * run.energy[0]
    assert run.outcome is law.outcome


def against(masonry, duration, motion, h, timestep=None):
    """Largest differences of peak rotation and of rotation to rigid blocks with rigid friction, over the peaks."""
    case = mr.MasonryCase(masonry, duration, motion)
    scene = mr.masonry_scene(case)
    t, pose = explicit(scene, masonry_course(case, scene), h, round(1e-3 / h))
    run = mr.solve_explicit(case, timestep=timestep)
    theta = np.column_stack([np.interp(t, run.t, angle) for angle in run.theta.T])
    peaks = np.abs(pose[:, :, 2]).max(axis=0)
    return np.abs(np.abs(theta).max(axis=0) / peaks - 1).max(), (
        np.abs(theta - pose[:, :, 2]).max(axis=0) / peaks
    ).max()


def test_two_blocks_against_an_independent_integration():
    of_peak, of_path = against(columns(2, xi=0.049), 1.5, mr.GroundMotion.sine(3.0, 0.9), 2e-5)
    assert of_peak < 3e-3
    assert of_path < 1e-2


@pytest.mark.slow
def test_an_arch_against_an_independent_integration_and_its_order():
    """The difference falls with the step: 1.3 % and .05 % of the path at 33 and 5 us."""
    arch = mr.Masonry.arch(5.0, 0.75)
    default, coarse, fine = (against(arch, 1.0, PULSE, 5e-6, step) for step in (None, 3.3e-5, 5e-6))
    for step, (peak, path) in (("default", default), ("33 us", coarse), ("5 us", fine)):
        print(f"arch, {step} step: peaks {peak:.1e}, rotations {path:.1e} of the peak apart")
    assert default[0] < 5e-3
    assert coarse[0] < 3e-3
    assert fine[0] < 5e-4
    assert fine[1] < 5e-3
    assert fine[1] < 0.3 * coarse[1]


@pytest.mark.slow
@pytest.mark.parametrize("blocks", [2, 3, 5])
def test_columns_against_mujoco(blocks):
    column = columns(blocks, k_n=2e9, friction=0.75)
    stiff = mr.Masonry(column.blocks, k_n=2e9, friction=0.75, k_s=2e11)
    case = mr.MasonryCase(column, 2.0, PULSE)
    engine = mr.simulate(case, accuracy=1e-4)
    for masonry in (column, stiff):
        run = mr.solve_explicit(mr.MasonryCase(masonry, 2.0, PULSE))
        np.testing.assert_allclose(run.peak, engine.peak, rtol=1e-2)


def test_energy_stays_without_damping_and_friction_is_booked():
    column = columns(3, k_n=2e9, xi=0.0, friction=0.8)
    run = solve(column, 1.0, mr.GroundMotion.sine(3.0, 0.8), ledger=True)
    scale = np.abs(run.ledger.ground).max()
    assert np.abs(run.energy_residual).max() < 1e-4 * scale
    assert all(np.abs(account).max() < 1e-9 * scale for account in run.ledger.dashpots.values())


def test_the_ledger_closes_with_every_effect_and_both_motions():
    top = 4.0
    effects = (
        mr.Tie(height=top, stiffness=5e6, slack=1e-3, strength=4e3, block=2),
        mr.Load(force=5e3, height=top, block=2),
        mr.Thrust(force=1e3, height=top, block=2),
        mr.AddedMass(mass=500.0, height=top, block=2),
        mr.Damper(height=top, c=2e3, block=2),
    )
    column = columns(2, k_n=1e9, friction=0.7, k_s=4e8)
    up = mr.GroundMotion.sine(2.0, 0.3)
    run = solve(column, 1.5, mr.GroundMotion.sine(3.0, 0.8), vertical=up, effects=effects, ledger=True)
    assert np.abs(run.energy_residual).max() < 2e-3 * np.abs(run.ledger.ground).max()
    assert run.plastic["tie_0"].elongation > 0
    assert run.ledger.dashpots["damper_0"][-1] > 0
    engine = mr.simulate(mr.MasonryCase(columns(2, k_n=1e9, friction=0.7), 1.5, mr.GroundMotion.sine(3.0, 0.8), up,
                                        effects=effects))  # fmt: skip
    np.testing.assert_allclose(run.peak, engine.peak, rtol=0.05)  # its joints stick rigidly


def test_a_tie_breaks_and_its_books_close():
    """A cube on ice is caught by a tie, draws it out and breaks it: the energies of both stay behind."""
    ice = mr.Masonry(CUBE.blocks, k_n=1e9, friction=0.0, xi=0.05)
    tie = mr.Tie(height=0.5, stiffness=1e6, slack=1e-3, strength=5e3, ultimate=0.1, block=1)
    run = solve(ice, 0.6, velocity=[(2.0, 0.0, 0.0)], effects=(tie,), ledger=True)
    taken = 5e3 * 0.1 + 0.5 * 5e3**2 / 1e6
    left = math.sqrt(4.0 - 2 * taken / CUBE.blocks[1].mass)
    assert run.velocity[-1, 0, 0] == pytest.approx(left, rel=2e-3)
    assert run.plastic["tie_0"].elongation == pytest.approx(0.1, rel=1e-9)
    assert run.plastic["tie_0"].broken < 0.2
    assert np.abs(run.energy_residual).max() < 5e-3 * run.energy[0]


def test_a_support_that_settles_takes_what_stands_on_it_along():
    t = np.linspace(0, 1, 101)
    smooth = 0.5 - 0.5 * np.cos(np.pi * t)
    run = solve(CUBE, 1.2, supports={"ground": (t, 0.01 * smooth, -0.02 * smooth)}, ledger=True)
    np.testing.assert_allclose(run.pose[-1, 0] - run.pose[0, 0], [0.01, -0.02, 0.0], atol=2e-5)
    assert np.abs(run.energy_residual).max() < 1e-3 * np.abs(run.ledger.ground).max()
    with pytest.raises(
        ValueError, match="supports = ground: fixed blocks do not move in MuJoCo but with collisions=True"
    ):
        mr.simulate(run.case)


@pytest.mark.parametrize(
    ("supports", "complaint"),
    [
        ({"cube": ([0, 1], [0, 0], [0, 0])}, "'cube' of type str is not a fixed block; the valid ones are ground"),
        ({"ground": ([0, 1], [0, 0])}, r"is not \(t, dx, dz\)"),
        ({"ground": ([0, 0], [0, 0], [0, 0])}, "t does not increase"),
        ({"ground": ([0, 1], [0, 0, 1], [0, 0])}, "have 2, 3 and 2 values"),
        ({"ground": ([0, 1], [0, 1e3], [0, 0])}, "outside the valid range"),
        ({"ground": ([0, math.nan], [0, 0], [0, 0])}, "not finite"),
        ([1], "is not a Mapping"),
    ],
)
def test_supports_that_cannot_be(supports, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        mr.MasonryCase(CUBE, 1.0, supports=supports)


def test_mujoco_says_that_it_takes_no_shear_stiffness():
    masonry = mr.Masonry(CUBE.blocks, k_n=1e9, k_s=1e9)
    with pytest.warns(UserWarning, match=r"k_s = 1e\+09 N/m3 is taken by solve_explicit alone"):
        mr.simulate(mr.MasonryCase(masonry, 0.01))


def test_softer_shear_moves_a_column_further():
    """In a slow push the joints of a block yield by F / (k_s A)."""
    push = mr.GroundMotion(np.minimum(np.linspace(0, 2, 201), 1.0) * -1.0, 0.01)
    masonry = mr.Masonry(CUBE.blocks, k_n=1e9, friction=0.5, k_s=1e7)
    run = solve(masonry, 2.0, push)
    leaning = 0.5 * run.pose[-1, 0, 2]  # the rotation moves the centroid too
    assert run.pose[-1, 0, 0] - leaning == pytest.approx(2000.0 / 1e7, rel=0.02)


def test_a_step_that_is_not_stable_is_refused_with_the_longest_that_is():
    limit = solve(CUBE, 0.01).stats["stable_timestep"]
    with pytest.raises(ValueError, match="is not stable; the valid range is up to"):
        solve(CUBE, 0.01, timestep=1.1 * limit)
    kept = solve(CUBE, 0.5, PULSE, timestep=0.95 * limit)
    assert np.abs(kept.pose).max() < 0.1


def test_a_step_that_is_taken_can_be_given():
    """Also below a nanosecond, which strong dashpots need, and which errors and warnings then name."""
    masonry = mr.Masonry(CUBE.blocks, k_n=1e13, frequency=1.0, xi=1.0)
    taken = solve(masonry, 1e-6)
    assert taken.stats["timestep"] < 5e-10
    given = solve(masonry, 1e-6, timestep=taken.stats["timestep"])
    assert given.stats["steps"] == taken.stats["steps"]
    with pytest.raises(ValueError, match=r"timestep = 1e-13 s is outside the valid range 1e-12 to 1 s"):
        solve(masonry, 1e-6, timestep=1e-13)


@pytest.mark.filterwarnings("ignore:.*lie inside each other")  # a motion that blows up
@pytest.mark.parametrize("blocks", [1, 4])
def test_the_longest_step_is_the_limit_of_stability(blocks, monkeypatch):
    """Beyond the limit the motion blows up, and the run says so."""
    from mjrock.distinct import setup as module

    column = columns(blocks, k_n=1e9, xi=0.05)
    limit, at_rest = solve(column, 0.01).stats["stable_timestep"], module.masonry_at_rest
    monkeypatch.setattr(module, "masonry_at_rest", lambda scene: at_rest(scene)._replace(limit=2 * limit))
    with pytest.raises(RuntimeError, match=r"appeared from nowhere|breaks down"):
        solve(column, 2.0, PULSE, timestep=1.8 * limit)


def test_a_run_goes_on_where_another_ended():
    whole = solve(CUBE, 1.0, PULSE)
    first = solve(CUBE, 0.5, PULSE)
    assert np.array_equal(whole.pose[: len(first.pose)], first.pose)
    second = mr.solve_explicit(mr.MasonryCase(CUBE, 0.1), start=first.end)
    np.testing.assert_allclose(second.pose[0], first.pose[-1])


def test_the_time_of_the_steps_is_a_part_of_the_whole():
    begun = time.perf_counter()
    stats = solve(CUBE, 0.1, PULSE).stats
    assert 0 < stats["stepping_time"] < stats["wall_time"] < time.perf_counter() - begun


def test_it_is_a_solver_of_campaigns():
    row = mr.Analysis(mr.MasonryCase(CUBE, 0.05, PULSE), solver="explicit")()
    assert row["outcome"] == "at rest" or row["outcome"] == "time ended"
    assert row["largest_rotation_rad"] > 0


def test_bad_options():
    with pytest.raises(ValueError, match="output_step = -1 s is outside the valid range"):
        mr.solve_explicit(mr.MasonryCase(CUBE, 0.1), output_step=-1)
    with pytest.raises(TypeError, match="ledger = 3 of type int is neither True nor False"):
        mr.solve_explicit(mr.MasonryCase(CUBE, 0.1), ledger=3)
    with pytest.raises(ValueError, match="start, largest of velocity = 1001 is outside the valid range 0 to 1000"):
        mr.solve_explicit(mr.MasonryCase(CUBE, 0.1), start=(np.zeros((1, 3)), np.array([[0.0, 0.0, 1001.0]])))
    with pytest.raises(ValueError, match="k_s = 1 N/m3 is outside the valid range"):
        mr.Masonry(CUBE.blocks, k_s=1.0)


def test_the_shear_dashpot_of_a_landing_block_stretches_no_spring():
    masonry = mr.Masonry([GROUND, box(-0.3, 0.3, 0, 0.5)], k_n=1e9, k_s=1e8, friction=0.5, frequency=200.0, xi=0.5)
    run = solve(masonry, 0.2, velocity=[(1.0, 0.3, 0.2)], ledger=True)
    rubbed = np.diff(run.ledger.friction)
    assert rubbed.max() > 1.0
    assert rubbed.min() > -1e-9


def test_a_small_arch_holds_still_by_the_friction_of_its_joints():
    """Friction takes less than a newton, from the start; otherwise its shear springs would have to give way first."""
    small = mr.Masonry.arch(0.05, 0.01, voussoirs=7, k_n=1e10, k_s=1e10, density=100.0, friction=0.7)
    run = solve(small, 0.02)
    assert np.abs(run.pose - run.pose[0]).max() < 1e-3 * np.abs(run.pose[0]).max()


def test_a_ledger_beyond_memory_is_refused(monkeypatch):
    """Friction, ground and two groups of dashpots at each of 101 samples."""
    monkeypatch.setattr("mjrock.contacts.checks.MOST_SAMPLES", 400)
    assert len(solve(CUBE, 0.1).t) == 101
    with pytest.raises(ValueError, match="the ledger of this answer would be 404; at most"):
        solve(CUBE, 0.1, ledger=True)
