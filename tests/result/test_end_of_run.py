"""The last sample is the end of the run in every solver, and the next run starts from it."""

import pickle

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr

WALL = mr.Block.from_size(0.6, 2.4)
ON = mr.Contacts.from_damping(WALL, k_base=1e8, xi_base=0.05)
PLANE = mr.Masonry([GROUND, box(-0.2, 0.2, 0, 0.4), box(-0.2, 0.2, 0.4, 0.8)], k_n=1e8, xi=0.05)
SPACE = mr.Masonry.column(0.4, 0.8, 2, k_n=1e8, xi=0.05)


def wall(duration):
    return mr.Case(WALL, 0.5 * WALL.alpha, duration, side_stop=False)


def plane(duration):
    return mr.MasonryCase(PLANE, duration, velocity=[[0.1, 0, 0.5], [0.3, 0, 0.5]])


def space(duration):
    return mr.MasonryCase(SPACE, duration, velocity=[[0.1, 0, 0, 0, 0.5, 0], [0.3, 0, 0, 0, 0.5, 0]])


SOLVERS = {
    "fitted": (wall, lambda case, **options: mr.simulate(case, ON, **options)),
    "fixed": (wall, lambda case, **options: mr.simulate(case, ON, 1e-4, **options)),
    "explicit": (wall, lambda case, **options: mr.solve_explicit(case, ON, **options)),
    "explicit, given step": (wall, lambda case, **options: mr.solve_explicit(case, ON, 2e-5, **options)),
    "compliant": (wall, lambda case, **options: mr.solve_compliant(case, ON, **options)),
    "theory": (
        wall,
        lambda case, **options: mr.solve_analytical(case, mr.Restitution.from_geometry(WALL), **options),
    ),
    "masonry": (plane, mr.simulate),
    "masonry, fixed": (plane, lambda case, **options: mr.simulate(case, timestep=1e-4, **options)),
    "masonry, explicit": (plane, mr.solve_explicit),
    "masonry, given step": (plane, lambda case, **options: mr.solve_explicit(case, timestep=2e-5, **options)),
    "space, explicit": (space, mr.solve_explicit),
    "space, given step": (space, lambda case, **options: mr.solve_explicit(case, timestep=2e-5, **options)),
}


@pytest.mark.parametrize("name", SOLVERS)
def test_the_last_sample_is_the_end(name):
    case, solve = SOLVERS[name]
    for spacing in (0.3, 0.07, 0.5):
        run = solve(case(0.5), output_step=spacing)
        assert run.t[0] == 0
        assert run.t[-1] == pytest.approx(0.5, rel=1e-12)
        if name == "explicit, given step":  # whole numbers of the finer samples in which impacts are seen
            assert np.diff(run.t).max() == pytest.approx(min(spacing, 0.5), abs=3e-4)
        else:
            assert np.diff(run.t).max() <= spacing * (1 + 1e-9)
            assert len(run.t) == 1 + np.ceil(0.5 / spacing)
        assert len(run.t) == len(run.pose) == len(run.velocity) == len(run.energy)
        if run.end is not None:
            assert all(np.array_equal(*pair) for pair in zip(run.end, (run.pose[-1], run.velocity[-1]), strict=True))
    with pytest.raises(ValueError, match=r"output_step = 0\.6 s is outside the valid range 1e-09 to 0\.5 s"):
        solve(case(0.5), output_step=0.6)


@pytest.mark.parametrize("name", ["fixed", "explicit, given step", "masonry, fixed", "masonry, given step"])
def test_the_ledger_ends_there_too(name):
    case, solve = SOLVERS[name]
    run = solve(case(0.5), output_step=0.3, ledger=True)
    assert np.array_equal(run.ledger.t, run.t)
    whole = solve(case(0.5), ledger=True)
    assert run.ledger.friction[-1] == pytest.approx(whole.ledger.friction[-1], rel=1e-9, abs=1e-12)


def test_a_given_step_that_does_not_divide_the_duration_is_kept():
    for run in (mr.simulate(wall(0.5), ON, 3e-4), mr.solve_explicit(wall(0.5), ON, 3e-5)):
        h = run.stats["timestep"]
        assert h in (3e-4, 3e-5)
        assert run.t[-1] == pytest.approx(h * round(0.5 / h), rel=1e-12)
    for solve, least in ((mr.simulate, "1e-09"), (mr.solve_explicit, "1e-12")):
        with pytest.raises(ValueError, match=rf"timestep = 0\.1 s is outside the valid range {least} to 0\.01 s"):
            solve(wall(0.01), ON, 0.1)


def test_a_run_shorter_than_the_usual_spacing():
    for case, solve in SOLVERS.values():
        assert solve(case(2e-4)).t[-1] == pytest.approx(2e-4, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "tolerance"),
    [
        ("fixed", 1e-12),
        ("explicit", 1e-11),
        ("explicit, given step", 1e-11),
        ("masonry, fixed", 1e-10),
        ("masonry, explicit", 1e-11),
        ("masonry, given step", 1e-11),
        ("space, explicit", 1e-11),
        ("space, given step", 1e-11),
        ("fitted", 1e-3),  # its accuracy
    ],
)
def test_two_pieces_are_one_run(name, tolerance):
    case, solve = SOLVERS[name]
    whole, first = solve(case(0.5)), solve(case(0.2))
    second = solve(case(0.3), start=first.end)
    assert np.array_equal(second.pose[0], first.pose[-1])
    np.testing.assert_allclose(second.velocity[0], first.velocity[-1], rtol=1e-7, atol=1e-15)
    far = np.abs(whole.pose[-1] - whole.pose[0]).max()
    assert np.abs(second.pose[-1] - whole.pose[-1]).max() < tolerance * far


def shaken(in_space, k_s, pieces):
    """Two blocks on a sliding support under a record, held by a tie and a damper, in pieces that end at these times."""
    dt, moving = 0.01, np.linspace(0.0, 0.5, 51)
    accel, slid = 6.0 * np.sin(40 * moving), 0.002 * np.sin(30 * moving)
    if in_space:
        blocks = [mr.Polyhedron.box((0.4, 0.4, 0.4), (0, 0, z), name=name) for name, z in (("low", 0.2), ("high", 0.6))]
        ground = mr.Polyhedron.box((2, 2, 0.2), (0, 0, -0.1), fixed=True, name="ground")
        place = {"at": (-0.2, 0.1, 0.7)}
    else:
        blocks, ground = list(PLANE.blocks[1:]), PLANE.blocks[0]
        place = {"height": 0.7}
    effects = mr.Tie(**place, stiffness=2e5, block=2), mr.Damper(**place, c=500.0, block=2)
    masonry = mr.Masonry([ground, *blocks], k_n=1e8, k_s=k_s, friction=0.3, xi=0.05)
    runs, start, begun = [], None, 0.0
    for end in pieces:
        some = slice(round(begun / dt), round(end / dt) + 1)
        history = moving[some] - begun, slid[some], *((0 * slid[some],) * (1 + in_space))
        case = mr.MasonryCase(
            masonry,
            end - begun,
            mr.GroundMotion(accel[some], dt),
            effects=effects,
            supports={masonry.names[0]: history},
        )
        runs.append(mr.solve_explicit(case, timestep=1e-4, start=start, ledger=True))
        start, begun = runs[-1].end, end
    return runs


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("k_s", [None, 4e7])
def test_two_pieces_of_a_record_with_friction_that_slips_are_one_run(in_space, k_s):
    (whole,), (first, second) = shaken(in_space, k_s, (0.5,)), shaken(in_space, k_s, (0.2, 0.5))
    assert whole.sliding.max() > 1e-3
    assert np.abs(second.pose[-1] - whole.pose[-1]).max() < 1e-12
    # the ground of the first piece is at rest in the half step after its end
    assert np.abs(second.velocity[0] - first.velocity[-1]).max() < 0.25 * 1e-4 * 6.0
    for account in ("friction", "ground"):
        one, two = getattr(whole.ledger, account)[-1], [getattr(run.ledger, account)[-1] for run in (first, second)]
        assert sum(two) == pytest.approx(one, rel=1e-3), account
    assert np.abs(second.ledger.residual).max() < 0.01 * second.ledger.largest


def test_an_end_unpacks_into_pose_and_velocity_and_can_be_written_and_read():
    """Without its memory a run goes on from pose and velocity alone."""
    end = mr.solve_explicit(mr.MasonryCase(mr.Masonry.column(width=0.5, height=1.0, drums=2), 0.01)).end
    pose, velocity = pickle.loads(pickle.dumps(end))
    np.testing.assert_array_equal(pose, end.pose)
    np.testing.assert_array_equal(velocity, end[1])
    assert end.memory is not None
