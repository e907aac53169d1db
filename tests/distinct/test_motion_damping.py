"""Damping of a slow motion, one function at a time: what it leaves of a motion, and the energy that it takes."""

import math

import numpy as np
import pytest
from by_hand import books, energy, system

import mjrock as mr
from mjrock.distinct import motion_damping

BOTH = pytest.mark.parametrize("d", [2, 3])


@BOTH
def test_all_velocities_decay_alike_and_the_energy_that_they_lose_is_booked(d):
    whole = system(d)
    account, names = books(whole), ("velocity", "spin", *(("momentum",) if d == 3 else ()))
    before, had = {name: whole.bodies[name].copy() for name in names}, energy(whole.bodies)
    for turn in (1, 2):
        motion_damping.damp_velocities(whole, account, 0.3)
        for name in names:
            np.testing.assert_allclose(whole.bodies[name], math.exp(-0.3 * turn) * before[name], rtol=1e-13)
        assert account.dashpots[-1] == pytest.approx(had - energy(whole.bodies), rel=1e-12)
    assert account.dashpots[0] == 0.0


@BOTH
def test_each_force_that_is_not_balanced_loses_a_share_against_the_motion(d):
    """Along each axis its size times the share, with the sign of the velocity; nothing where there is no velocity."""
    whole, share, kick = system(d), 0.25, 0.02
    account, bodies = books(whole), whole.bodies
    random = np.random.default_rng(d)
    for name in ("force", "moment"):
        bodies[name] = random.normal(size=bodies[name].shape)
    bodies["velocity"][1, 0] = bodies["spin"][0, 0] = 0.0
    power, expected = 0.0, {}
    for force, velocity in (("force", "velocity"), ("moment", "spin")):
        less = share * np.abs(bodies[force]) * np.sign(bodies[velocity])
        expected[force], power = bodies[force] - less, power + (less * bodies[velocity]).sum()
    motion_damping.damp_unbalanced(whole, account, share, kick)
    for name, force in expected.items():
        np.testing.assert_allclose(bodies[name], force, rtol=1e-14)
    assert account.dashpots[-1] == pytest.approx(kick * power, rel=1e-13)
    assert power > 0
    motion_damping.damp_unbalanced(whole, account, share, kick)
    assert account.dashpots[-1] > 1.5 * kick * power
    assert account.dashpots[0] == 0.0


def test_local_damping_of_rigid_friction_is_refused():
    case = mr.MasonryCase(mr.Masonry.column(0.5, 1.0, 1, k_n=1e8), 0.01)
    with pytest.raises(
        ValueError, match=r"local_damping = 0\.5 needs joints with a shear .*: take mass_damping, or masonry"
    ):
        mr.solve_explicit(case, local_damping=0.5)
    wall = mr.Block.from_size(0.5, 2.0)
    contacts = mr.Contacts.from_damping(wall, k_base=1e9, xi_base=0.05, k_side=1e9, xi_side=0.05)
    with pytest.raises(ValueError, match=r"local_damping = 0\.5 needs joints .* take mass_damping"):
        mr.solve_explicit(mr.Case(wall, duration=0.01), contacts, local_damping=0.5)
