"""Lines that take the place of others: forces and energy of a pair stay, and the step stays stable."""

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct.finder import Found
from mjrock.distinct.handover import Lines, press
from mjrock.distinct.pair_law import least_among
from mjrock.distinct.rows import kinds, rows
from mjrock.distinct.softening import Sides, shares_within


def places(rng, bodies, count, d):
    """Places between random pairs of bodies and the ground, -1, their law, and the inverse of the masses."""
    nv = 3 * d - 3
    one = rng.integers(0, bodies, count)
    other = (one + rng.integers(1, bodies + 1, count)) % (bodies + 1) - 1
    other = np.where(other == one, -1, other)
    normals = rng.normal(size=(count, d))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    sides = Sides(np.array([one, other]), rng.normal(size=(2, count, d)), normals)
    law = {name: 10 ** rng.uniform(-1, 2, count) for name in ("k", "k_s")}
    law |= {name: 10 ** rng.uniform(-3, 0, count) for name in ("c", "c_s")}
    roots = rng.normal(size=(bodies, nv, nv))
    inverse = np.zeros((bodies, nv, nv))
    inverse[:, :d, :d] = (10 ** rng.uniform(-1, 1, bodies))[:, None, None] * np.eye(d)
    inverse[:, d:, d:] = (roots @ np.swapaxes(roots, 1, 2))[:, d:, d:]
    return sides, law, inverse


def bodies_of(inverse):
    """Bodies with the inverse of their masses in the axes of the world."""
    d = 2 if inverse.shape[1] == 3 else 3
    spins = {"inverse_inertia" if d == 2 else "inverse_in_world": inverse[:, d:, d:]}
    return rows(kinds(d).body, len(inverse), inverse_mass=np.diagonal(inverse, axis1=1, axis2=2)[:, :d], **spins)


def highest(sides, law, inverse, share, step):
    """The highest eigenvalue of all places with a share of their stiffness, times the square of the step."""
    bodies, nv = inverse.shape[:2]
    d = sides.normals.shape[1]
    matrix = np.zeros((bodies * nv, bodies * nv))
    for p in range(len(share)):
        across = np.linalg.svd(sides.normals[p][None])[2][1:]
        for way, k, c in [(sides.normals[p], "k", "c"), *((way, "k_s", "c_s") for way in across)]:
            rate = np.zeros(bodies * nv)
            for sign, body, arm in zip((1, -1), sides.bodies[:, p], sides.arms[:, p], strict=True):
                if body >= 0:
                    spin = [arm[1] * way[0] - arm[0] * way[1]] if d == 2 else np.cross(arm, way)
                    rate[body * nv : (body + 1) * nv] += sign * np.concatenate([way, spin])
            matrix += share[p] * (step**2 * law[k][p] + 2 * step * law[c][p]) * np.outer(rate, rate)
    blocks = np.zeros_like(matrix)
    for body in range(bodies):
        at = slice(body * nv, (body + 1) * nv)
        blocks[at, at] = inverse[body]
    return float(np.linalg.eigvals(blocks @ matrix).real.max())


@pytest.mark.parametrize("d", [2, 3])
def test_softened_places_leave_the_step_stable(d):
    rng = np.random.default_rng(d)
    found = []
    for _ in range(40):
        sides, law, inverse = places(rng, 4, 9, d)
        share = shares_within(sides, law, bodies_of(inverse), 0.1)
        found.append(highest(sides, law, inverse, share, 0.1))
        if highest(sides, law, inverse, np.ones(9), 0.1) > 4:
            assert share.min() < 1
    assert 1 < max(found) < 4 * (1 + 1e-12)


def test_a_heavy_beam_on_many_light_units_is_not_softened_for_them():
    """Four units of 1 kg below a beam of 4 kg: the beam against all units has the eigenvalue 4 k / m, as each unit
    would have between the ground and a wall."""
    bodies = np.array([np.repeat(np.arange(4), 2), np.full(8, 4)])
    arms = np.zeros((2, 8, 2))
    inverse = np.array([np.diag([1 / m, 1 / m, 0.0]) for m in (1, 1, 1, 1, 4)])
    law = {"k": np.ones(8), "c": np.zeros(8), "k_s": np.full(8, np.inf), "c_s": np.zeros(8)}
    sides = Sides(bodies, arms, np.tile([0.0, 1.0], (8, 1)))
    np.testing.assert_allclose(shares_within(sides, law, bodies_of(inverse), 0.9), 1.0)
    np.testing.assert_allclose(shares_within(sides, law, bodies_of(inverse), 1.1), 1 / 1.1**2, rtol=0.02)


@pytest.mark.parametrize("guided", ["translation", "upright", None])
def test_a_beam_that_slides_keeps_its_normal_force_where_its_joints_are_handed_over(guided):
    """The beam leaves its joints at a slip of 10 mm, with its weight on it: only a guided one could lose it."""
    units = [box(x, x + 0.2, 0.0, 0.15) for x in (-0.4, -0.2, 0.0, 0.2)]
    masonry = mr.Masonry(
        [GROUND, *units, box(-0.4, 0.4, 0.15, 0.3, name="beam")], k_n=1e9, k_s=1e9, friction=0.6, xi=0.05
    )
    jack = mr.Actuator("beam", (-0.4, 0.2), (1.0, 0.0), ([0.0, 1.0], [0.0, 0.02]), 1e7, 2e4, guided=guided)
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 1.0, effects=(jack,)), output_step=0.01, forces=True)
    assert answer.pose[-1, -1, 0] == pytest.approx(0.02, rel=0.01)
    upwards = answer.reactions["ground"][:, 1]
    np.testing.assert_allclose(upwards[20:], upwards[0], rtol=0.005)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.03, 0.0315, 0.0325])
def test_a_dome_that_falls_puts_no_energy_in_where_lines_follow_each_other(share):
    masonry = mr.Masonry.dome(5.0, share * 5.0, 6, 4, k_n=1e9, k_s=1e9, friction=0.9, xi=0.01)
    ledger = mr.solve_explicit(mr.MasonryCase(masonry, 2.0, settled=False), output_step=0.01, ledger=True).ledger
    lost = np.sum(list(ledger.ends.values()), axis=0)
    assert ledger.kinetic.max() > 1e5
    assert lost.min() > -1e-3 * ledger.kinetic.max()
    assert lost[-1] < 0.05 * ledger.kinetic.max()


def test_the_least_share_of_a_pair_is_that_of_its_softest_line():
    shares = least_among(np.array([7, 3, 7, 5]), np.array([3, 7, 7]), np.array([0.9, 0.4, 0.6]))
    np.testing.assert_array_equal(shares, [0.4, 0.9, 0.4, 1.0])
    np.testing.assert_array_equal(least_among(np.array([1, 2]), np.zeros(0, dtype=int), np.zeros(0)), [1.0, 1.0])


def test_what_presses_follows_the_lines_before_it_and_gains_no_energy():
    """A stiffer place starts with the force, a softer one with the energy of the line before it."""
    kind = kinds(2).line
    found = Found(
        np.array([0]), np.array([1]), np.zeros((1, 2)), np.zeros((1, 2)), np.array([-1.0]), np.ones(1), np.ones(1)
    )
    for stiffness, depth in ((2.0, 0.5), (1.0, 1.0), (0.81, 1 / 0.9)):
        gone = Lines(rows(kind, 1, k=1.0), np.zeros(1), np.array([0.5]))
        new = Lines(rows(kind, 1, k=stiffness), np.zeros(1), np.array([0.5]))
        press(new, (0, 1), found, gone, (0, 1))
        assert new.depth[0] == pytest.approx(0.5 * depth)
        assert stiffness * new.depth[0] ** 2 <= 0.25 * (1 + 1e-12)
