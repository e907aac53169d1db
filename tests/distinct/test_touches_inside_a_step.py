"""A touch inside a step: restitution and energy wherever in the step it lies, and when an error ends a run."""

import itertools
import math
import re

import numpy as np
import pytest
from everyday import among, slow
from masonry_blocks import GROUND, box
from scipy.integrate import solve_ivp

import mjrock as mr
from mjrock.distinct import response, setup
from mjrock.result import ledger

G = mr.GRAVITY
PHASES = np.linspace(0.8, 1.2, 9)
"""Velocities at which a block leaves the ground [m/s], so that it meets it again anywhere in a step."""
K_N = 1e8
"""Stiffness of all joints here [N/m3]."""


def block(in_space, xi, size=(0.8, 0.5)):
    """A block on the ground, of this width and height."""
    width, height = size
    if in_space:
        return mr.Masonry.box((width, width, height), k_n=K_N, friction=0.7, xi=xi)
    return mr.Masonry([GROUND, box(-width / 2, width / 2, 0, height)], k_n=K_N, friction=0.7, xi=xi)


def bounced(masonry, speed, **options):
    """The block leaves the ground with a velocity, lands, and is on its way down again at the end."""
    velocity = [(0, 0, speed, 0, 0, 0) if masonry.in_space else (0, speed, 0)]
    case = mr.MasonryCase(masonry, 3.5 * speed / G, velocity=velocity)
    return mr.solve_explicit(case, **options)


def rebound(masonry, speed):
    """|e| of a flat impact at a speed [m/s], integrated to rounding: the contact ends where it would begin to pull."""
    mass = masonry.blocks[masonry.free[0]].mass
    square = K_N * 0.8 * (0.8 if masonry.in_space else 1.0) / mass
    damping = square * float(masonry.retardation[0])

    def released(_, y):
        return -square * y[0] - damping * y[1]

    released.terminal, released.direction = True, -1
    run = solve_ivp(
        lambda t, y: (y[1], released(t, y) - G), (0, 1), (0, -speed), events=released, rtol=1e-10, atol=1e-14
    )
    place, velocity = run.y[:, -1]
    return math.sqrt(velocity**2 + 2 * G * place) / speed


def default_step(masonry):
    """The step that is taken where samples do not shorten it [s]."""
    return bounced(masonry, 1.0, output_step=0.3).stats["timestep"]


SCATTER = {
    0.0: (1e-4, 1e-4),
    0.05: (3e-3, 1e-3),
    0.1: (3e-3, 2e-3),
    0.15: (1e-2, 3e-3),
    0.2: (1e-2, 3e-3),
    0.3: (1e-2, 4e-3),
    0.35: (1e-2, 4e-3),
}
"""Largest mean error of |e| and its scatter, by the damping ratio [-]."""


@pytest.mark.parametrize(
    ("in_space", "xi"), among(list(itertools.product([False, True], SCATTER)), (False, 0.05), (True, 0.3))
)
def test_a_flat_impact_at_the_default_step_is_that_of_exact_integration(in_space, xi):
    """Wherever in its step it falls, the energy of the motion upwards is its restitution, and the ledger closes."""
    mean, scatter = SCATTER[xi]
    masonry, errors = block(in_space, xi), []
    step = default_step(masonry)
    for speed in PHASES:
        run = bounced(masonry, speed, timestep=step, ledger=True, output_step=1e-3)
        height = run.pose[:, 0, 2 if in_space else 1]
        landed = int(np.argmax((height < 0) & (run.t > 0.1)))
        down, up = (part.max() for part in (height[:landed], height[landed:]))
        errors.append(math.sqrt(up / down) / rebound(masonry, math.sqrt(2 * G * down)) - 1)
        assert np.abs(run.energy_residual).max() < 1e-5 * run.ledger.kinetic[0]
    assert np.abs(errors).max() < 1e-2
    assert abs(np.mean(errors)) < mean
    assert np.std(errors) < scatter


def test_very_strong_dashpots_leave_little_of_a_flat_impact_and_of_its_error():
    """|e| below a third is within 0.5 % of the speed of approach."""
    for xi in (0.4, 0.6, 0.8):
        masonry = block(False, xi)
        run = bounced(masonry, 1.0, timestep=default_step(masonry), output_step=1e-3)
        landed = int(np.argmax((run.pose[:, 0, 1] < 0) & (run.t > 0.1)))
        down, up = (part.max() for part in (run.pose[:landed, 0, 1], run.pose[landed:, 0, 1]))
        exact = rebound(masonry, math.sqrt(2 * G * down))
        assert exact < 1 / 3
        assert math.sqrt(up / down) == pytest.approx(exact, abs=5e-3)


@pytest.mark.parametrize("in_space", among([False, True], True))
def test_dashpots_at_short_steps_are_of_second_order(in_space):
    """They look half a step ahead."""
    masonry, error = block(in_space, 0.3), {}
    limit = bounced(masonry, 1.0, output_step=0.1).stats["stable_timestep"]
    for share in (0.2, 0.1, 0.05):
        run = bounced(masonry, 1.0, timestep=share * limit, output_step=1e-4)
        height = run.pose[:, 0, 2 if in_space else 1]
        landed = int(np.argmax((height < 0) & (run.t > 0.1)))
        down, up = (part.max() for part in (height[:landed], height[landed:]))
        error[share] = math.sqrt(up / down) / rebound(masonry, math.sqrt(2 * G * down)) - 1
    assert abs(error[0.2]) < 8e-3
    assert abs(error[0.1]) < 3e-3
    assert abs(error[0.05]) < 1e-3


def landing(in_space, xi, angle, height, timestep=None):
    """A block turned by an angle falls on its corner, on ground without friction. Velocities are x, z and about y."""
    options = {"k_n": K_N, "friction": 0.0, "xi": xi}
    if in_space:
        masonry = mr.Masonry.box((0.6, 0.4, 1.0), **options)
        start = [[0, 0, height, math.cos(angle / 2), 0, math.sin(angle / 2), 0]], [[0.0] * 6]
    else:
        masonry = mr.Masonry([GROUND, box(-0.3, 0.3, 0, 1.0)], **options)
        start = [[0, height, angle]], [[0.0] * 3]
    pose, velocity = (np.array(part, dtype=float) for part in start)
    case = mr.MasonryCase(masonry, 0.2)
    return mr.solve_explicit(case, timestep=timestep, ledger=True, start=(pose, velocity))


IN_CORNERS = [(False, 0.0), (False, 0.05), (True, 0.0), (True, 0.05), (False, 0.2), (True, 0.2), (False, 0.3)]


@pytest.mark.parametrize(
    ("in_space", "xi", "heights", "shortest"),
    [(False, 0.0, 4, 1e-5), (True, 0.05, 4, 1e-5)]
    + [slow((in_space, xi, 5 if in_space else 7, 5e-6)) for in_space, xi in IN_CORNERS],
)
def test_a_corner_impact_at_the_default_step_is_that_of_short_steps(in_space, xi, heights, shortest):
    """The corner leaves the ground again with the speed that it has at steps some fifty or a hundred times shorter."""
    spin, up = (4, 2) if in_space else (2, 1)
    for height in 0.2 + np.linspace(0, 0.02, heights):
        runs = [landing(in_space, xi, 0.25, height, step) for step in (None, shortest)]
        long, short = (run.velocity[-1, 0] for run in runs)
        assert abs(short[spin]) > 0.5
        assert abs(long[spin] - short[spin]) < 0.01 * abs(short[spin])
        assert abs(long[up] - short[up]) < 0.01 * np.abs(runs[1].velocity[:, 0, up]).max()
        assert np.abs(runs[0].energy_residual).max() < 1e-3 * runs[0].ledger.kinetic.max()


@pytest.mark.parametrize("in_space", [False, True])
def test_blocks_that_strike_in_flight_keep_their_momentum(in_space):
    """Without weight on the ground: both fall freely, and the upper one is the faster one."""
    ground = mr.Polyhedron.box((9, 9, 1), (0, 0, -0.5), fixed=True) if in_space else GROUND
    blocks = (
        [mr.Polyhedron.box((0.6, 0.6, 0.4), (0, 0, z)) for z in (0.2, 0.6)]
        if in_space
        else [box(-0.3, 0.3, 0, 0.4), box(-0.3, 0.3, 0.4, 0.8)]
    )
    masonry = mr.Masonry([ground, *blocks], k_n=K_N, friction=0.7, xi=0.02)
    at, d = np.array([[0, 0, 0.2, 1, 0, 0, 0], [0, 0, 0.22, 1, 0, 0, 0]]), 6
    if not in_space:
        at, d = np.array([[0, 0.2, 0], [0, 0.22, 0]]), 3
    velocity = np.zeros((2, d))
    up = 2 if in_space else 1
    velocity[1, up], velocity[1, -1] = -2.0, 0.3
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.05), start=(at, velocity), ledger=True)
    momentum = run.velocity.sum(axis=1)[:, up] + 2 * G * run.t
    assert run.velocity[-1, 0, up] < -1.5  # it was struck
    np.testing.assert_allclose(momentum, momentum[0], rtol=1e-12)
    assert np.abs(run.energy_residual).max() < 1e-4 * run.ledger.kinetic.max()


BLOCK = mr.Masonry.box((0.6, 0.4, 2.0), k_n=K_N, friction=0.6, xi=0.0)
THROWN = 1.0
"""Velocity of the block at its release [m/s]."""
STABLE = 2 / math.sqrt(1e8 * 0.6 * 0.4 / 960)
"""Longest stable step of the block without damping: as it bounces on its base, 960 kg on 1e8 N/m3 [s]."""


def thrown(height, timestep, duration=0.32, spin=(0.0, 0.0, 0.0), output_step=None):
    """The block without damping, thrown up from a height over its ground, bounces."""
    start = np.array([[0, 0, height, 1.0, 0, 0, 0]]), np.array([[0, 0, THROWN, *spin]])
    case = mr.MasonryCase(BLOCK, duration)
    return mr.solve_explicit(case, timestep=timestep, output_step=output_step or timestep or 1e-3, start=start)


@pytest.mark.parametrize(("share", "count"), [(0.4, 5), (0.1, 5), slow((0.4, 8)), slow((0.1, 8))])
def test_a_bounce_keeps_its_energy_wherever_the_touches_lie_in_their_steps(share, count):
    steps = share * STABLE * np.linspace(0.8, 1.0, count)
    runs = [thrown(0.05 + 0.3 * i * steps[-1] * THROWN, h) for i, h in enumerate(steps)]
    assert runs[-1].stats["share"] == pytest.approx(share)
    assert max(np.ptp(run.energy) / run.energy[0] for run in runs) < 1e-4


@pytest.mark.parametrize("duration", [0.7, slow(1.0)])
def test_hops_without_damping_are_accepted_at_any_spacing_of_the_samples(duration):
    for spin in ((0.0, 0.0, 0.0), (0.3, 0.2, 1.0)):
        for spacing in (None, 0.01, 0.3):
            assert thrown(0.05, 0.4 * STABLE, duration, spin, output_step=spacing).stats["share"] == pytest.approx(0.4)


def unstable(monkeypatch, output_step=1e-3, beyond=1.8):
    """A block that rocks, at a step beyond the longest stable one."""
    masonry = block(False, 0.05, (0.5, 2.0))
    case = mr.MasonryCase(masonry, 0.5, velocity=[(0.0, 0.0, 0.3)])
    limit, at_rest = mr.solve_explicit(mr.MasonryCase(masonry, 0.01)).stats["stable_timestep"], setup.masonry_at_rest
    monkeypatch.setattr(setup, "masonry_at_rest", lambda scene: at_rest(scene)._replace(limit=2 * limit))
    return mr.solve_explicit(case, timestep=beyond * limit, output_step=output_step)


def test_the_spacing_of_the_samples_plays_no_part_in_what_is_refused(monkeypatch):
    complaint = []
    for spacing in (1e-3, 1e-2, 0.5):
        with monkeypatch.context() as patched, pytest.raises(RuntimeError, match="appeared from nowhere") as caught:
            unstable(patched, spacing)
        complaint.append(str(caught.value))
    assert len(set(complaint)) == 1


def test_the_error_names_a_shorter_step(monkeypatch):
    with pytest.raises(RuntimeError, match=r"appeared from nowhere by t = \S+ s; take timestep = \S+ s") as caught:
        unstable(monkeypatch)
    gained = float(re.search(r"(\S+)% of the energy there was", str(caught.value))[1]) / 100
    named = float(re.search(r"timestep = (\S+) s", str(caught.value))[1])
    taken = 1.8 * bounced(block(False, 0.05, (0.5, 2.0)), 1.0).stats["stable_timestep"] / 2
    assert named == pytest.approx(max(0.25e-3 / gained, 0.1) * taken, rel=0.06)


def test_rounding_is_no_energy_from_nowhere(monkeypatch):
    """Whatever share of the energy is tolerated. The block flies free."""
    for module in (response, ledger):
        monkeypatch.setattr(module, "ENERGY_GAIN", 1e-18)
    run = thrown(0.05, 1e-4, 0.05, (0.0, 0.0, 1.0))
    assert np.ptp(run.energy) > 1e-18 * run.energy[0]


SOFT = mr.Masonry([GROUND, box(-0.5, 0.5, 0, 1)], k_n=2e5, k_s=2e5, friction=0.5, xi=0.0)
SPUN = mr.MasonryCase(SOFT, 0.5, velocity=[(3.0, 0.0, 3.0)])
"""A cube that sinks deep into soft ground and turns as it slides."""


def test_a_ledger_that_does_not_close_warns_and_names_a_step_that_closes_it():
    with pytest.warns(
        UserWarning, match=r"the ledger does not close: .* J, \d\.\d% of its largest part.*take"
    ) as caught:
        run = mr.solve_explicit(SPUN, ledger=True, timestep=0.04, output_step=0.04)
    share = np.abs(run.energy_residual).max() / run.ledger.largest
    assert 0.01 < share < 0.1
    assert f"{share:.1%}" in str(caught[0].message)
    assert caught[0].filename == __file__  # it points at the call
    named = float(re.search(r"timestep = (\S+) s", str(caught[0].message))[1])
    assert named == pytest.approx(0.005 / share * run.stats["timestep"], rel=0.05)
    run = mr.solve_explicit(SPUN, timestep=named, ledger=True)  # a warning is an error here
    assert np.abs(run.energy_residual).max() < 0.01 * run.ledger.largest


def test_without_a_ledger_nothing_is_said_of_it():
    assert mr.solve_explicit(SPUN, timestep=0.04, output_step=0.04).ledger is None


def test_energy_that_ends_of_faces_put_in_has_an_account_and_warns(monkeypatch):
    """Blocks of a dome that spin leave their joints, and meet again without energy that was not there."""
    dome = mr.Masonry.dome(0.18, 0.03, lunes=4, hoops=1, oculus=0.3, k_n=6e7, friction=0.9)
    velocity = [
        (0.3, 0.2, 0.2, -0.6, -3.1, 1.8),
        (0.0, 0.2, 0.1, -0.6, -1.3, 1.6),
        (0.1, 0.0, -0.3, -1.4, 4.2, 1.1),
        (0.2, -0.4, 0.0, -1.4, -5.8, -3.9),
    ]
    case = mr.MasonryCase(dome, 0.1, velocity=velocity)
    run = mr.solve_explicit(case, timestep=2e-5, ledger=True)
    assert min(run.ledger.ends["joints"].min(), run.ledger.ends["encounters"].min()) > -0.01 * run.ledger.kinetic.max()
    assert np.abs(run.energy_residual).max() < 1e-3 * run.ledger.largest
    monkeypatch.setattr(response, "RESIDUAL_WARNED_OF", -1.0)
    with pytest.warns(
        UserWarning, match=r"contacts at ends of faces put in \S+ J, -?\d+\.\d% of the energy there"
    ) as caught:
        mr.solve_explicit(case, timestep=2e-5)
    assert caught[0].filename == __file__
