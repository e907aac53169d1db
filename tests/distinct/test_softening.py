"""How much of their law places keep so that a step stays stable."""

import numpy as np
import pytest

from mjrock.distinct.rows import kinds
from mjrock.distinct.search.softening import Sides, shares_within, unsoftened
from mjrock.rows import rows


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


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize(
    ("k", "c", "k_s", "c_s"), [(700.0, 0.0, 0.0, 0.0), (100.0, 40.0, 10.0, 2.0), (1.0, 0.0, 500.0, 9.0)]
)
def test_places_on_one_body_keep_what_its_longest_step_leaves(d, k, c, k_s, c_s):
    """At the centroid of a body of 2 kg the eigenvalues are h (h k + 2 c) / m along the normal and along the face.
    Those of the 16th power are summed. The place on another body stays as it is."""
    step, mass = 0.1, 2.0
    inverse = np.array([np.diag([1 / mass] * d + [1.0] * (2 * d - 3))] * 2)
    law = {
        "k": np.array([k, 1.0]),
        "c": np.array([c, 0.0]),
        "k_s": np.array([k_s, np.inf]),
        "c_s": np.array([c_s, 0.0]),
    }
    sides = Sides(np.array([[0, 1], [-1, -1]]), np.zeros((2, 2, d)), np.eye(d)[[0, 0]])
    along, across = step * (step * k + 2 * c) / mass, step * (step * k_s + 2 * c_s) / mass
    trace = (along**16 + (d - 1) * across**16) ** (1 / 16)
    share = shares_within(sides, law, bodies_of(inverse), step)
    np.testing.assert_allclose(share, [min(1.0, 4 / trace), 1.0], rtol=1e-12)


def test_two_bodies_take_shares_that_go_as_their_loads():
    """A spring k between 1 kg and 4 kg acts on each of them like one of 1.25 k on 1 kg."""
    inverse = np.array([np.diag([1 / m, 1 / m, 0.0]) for m in (1.0, 4.0)])
    law = {"k": np.full(1, 8.0), "c": np.zeros(1), "k_s": np.full(1, np.inf), "c_s": np.zeros(1)}
    sides = Sides(np.array([[0], [1]]), np.zeros((2, 1, 2)), np.array([[0.0, 1.0]]))
    np.testing.assert_allclose(shares_within(sides, law, bodies_of(inverse), 1.0), [4 / 10], rtol=1e-12)


@pytest.mark.parametrize("slow", [0.0, 1e-4, 1e-2])
@pytest.mark.parametrize("step", [1e-3, 4e-3])
def test_a_step_that_leaves_all_of_the_law_of_a_place(step, slow):
    """A single mass on a spring and a dashpot: step and share go together as the bound of its step says."""
    stiffness, short = 1.0e7, 2e-4
    bound = short**2 * stiffness + 2 * short * slow * stiffness
    share = bound / (step**2 * stiffness + 2 * step * slow * stiffness)
    assert unsoftened(share, step, slow) == pytest.approx(short, rel=1e-9)
    assert unsoftened(1.0, step, slow) == pytest.approx(step, rel=1e-12)
