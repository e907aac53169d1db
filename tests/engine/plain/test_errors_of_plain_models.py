"""Errors of plain models that docs/plain_models.md has in its table: spinning bodies, runs in two parts, reactions.

`pytest -s tests/engine/plain/test_errors_of_plain_models.py` prints them.
"""

from dataclasses import replace

import numpy as np
import pytest
from everyday import slow
from masonry_blocks import box
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import mjrock as mr

SIZE, SPIN, FLIGHT = (0.4, 0.3, 0.8), np.array([3.0, 5.0, -4.0]), 0.5
INERTIA = np.array([SIZE[1] ** 2 + SIZE[2] ** 2, SIZE[0] ** 2 + SIZE[2] ** 2, SIZE[0] ** 2 + SIZE[1] ** 2]) / 12


def turned():
    """How a free body has turned by Euler's equations."""

    def rates(_, state):
        spin, (x, y, z, w) = state[:3], state[3:]
        turning = np.array([[w, -z, y], [z, w, -x], [-y, x, w], [-x, -y, -z]]) @ spin
        return [*(-np.cross(spin, INERTIA * spin) / INERTIA), *(0.5 * turning)]

    return Rotation.from_quat(solve_ivp(rates, (0, FLIGHT), [*SPIN, 0, 0, 0, 1], rtol=1e-11, atol=1e-12).y[3:, -1])


def spun(solve):
    """By how much a spinning body has turned wrongly [rad], and the error of its angular momentum [-]."""
    blocks = [
        mr.Polyhedron.box((100, 100, 1), (0, 0, -59.5), fixed=True),
        mr.Polyhedron.box((0.3, 0.3, 0.3), (40, 40, -58.85)),
        mr.Polyhedron.box(SIZE, (0, 0, 0)),
    ]
    velocity = np.zeros((2, 6))
    velocity[1, 3:] = SPIN
    run = solve(mr.MasonryCase(mr.Masonry(blocks, k_n=1e9), FLIGHT, velocity=velocity, settled=False))
    w, *xyz = run.pose[-1, 1, 3:]
    found = Rotation.from_quat([*xyz, w])
    momentum = found.apply(INERTIA * run.velocity[-1, 1, 3:]) - INERTIA * SPIN
    return (found * turned().inv()).magnitude(), np.linalg.norm(momentum) / np.linalg.norm(INERTIA * SPIN)


def plain(case, **options):
    return mr.simulate(case, collisions=True, **options)


def test_a_body_that_spins_in_flight():
    """Plain models keep the gyroscopic moment of half a step before, explicit steps the angular momentum."""
    usual, finer, explicit = spun(plain), spun(lambda case: plain(case, timestep=1e-4)), spun(mr.solve_explicit)
    print(f"turned wrongly by {usual[0]:.1e} of 3.5 rad, explicit {explicit[0]:.1e} rad", end="; ")
    print(f"angular momentum {usual[1]:.1e}, explicit {explicit[1]:.1e}")
    assert 3e-4 < usual[0] < 2e-3
    assert 2e-4 < usual[1] < 1e-3
    assert finer[0] < usual[0]
    assert explicit[0] < 5e-6
    assert explicit[1] < 1e-12


@pytest.mark.parametrize("share", [8, slow(4)])
@pytest.mark.filterwarnings("ignore:contacts that slide")
def test_a_run_in_two_parts_under_a_record(share):
    """Cut at a sample of the record: the end of the first part is a mean of velocities in time, at fixed steps."""
    blocks = [
        box(-6, 6, -1, 0, fixed=True),
        box(-0.3, 0.3, 0, 0.8),
        box(-0.3, 0.3, 0.8, 1.6),
    ]
    masonry = mr.Masonry(blocks, joints=mr.Dry(k_n=1e9, friction=0.6, xi=0.05, frequency=60.0))
    record = mr.GroundMotion.synthetic(6.0, 1.0, seed=5)
    half = len(record.accel) // share
    case = mr.MasonryCase(masonry, 2 * half * record.dt, motion=record)
    later = mr.GroundMotion(record.accel[half:], record.dt, "rest")
    for name, solve, most in (
        ("plain", lambda case, **start: plain(case, timestep=1e-4, **start), 1e-5),
        ("points, fixed step", lambda case, **start: mr.simulate(case, timestep=1e-4, **start), 1e-5),
        ("explicit", lambda case, **start: mr.solve_explicit(case, timestep=5e-5, **start), 1e-9),
    ):
        first = solve(replace(case, duration=half * record.dt))
        second = solve(replace(case, duration=half * record.dt, motion=later), start=first.end)
        whole = solve(case).pose[-1]
        error = np.abs(second.pose[-1] - whole).max() / np.abs(whole).max()
        print(f"{name}: the end of two runs is {error:.0e} of the largest displacement from that of one")
        assert error < most


@pytest.mark.parametrize(("solve", "most"), [(plain, 5e-4), (mr.simulate, 5e-4), (mr.solve_explicit, 1e-9)])
def test_horizontal_reactions_at_the_first_sample(solve, most):
    """Friction of MuJoCo creeps until it holds what ties aslant pull."""
    block = mr.Polyhedron.box((0.6, 0.4, 1.5), (0, 0, 0.75), name="b")
    ground = mr.Polyhedron.box((6, 6, 1), (0, 0, -0.5), fixed=True, name="ground")
    masonry = mr.Masonry([ground, block], joints=mr.Dry(4e7, 5.0, 0.05, None, 60.0))
    ties = (
        mr.Tie(stiffness=4e5, prestress=5e3, at=(0.3, 0.2, 1.2), anchor=(2.0, 1.5, 2.0), block="b"),
        mr.Tie(stiffness=3e5, prestress=4e3, at=(-0.3, 0.0, 1.5), anchor=(-1.5, 0.5, 0.0), block="b"),
    )
    run = solve(mr.MasonryCase(masonry, 0.02, effects=ties), forces=True)
    whole = sum(run.reactions.values())[0] / (block.mass * mr.GRAVITY)
    print(f"{run.solver}: horizontal reactions are {np.abs(whole[:2]).max():.1e} of the weight off")
    assert np.abs(whole[:2]).max() < most
