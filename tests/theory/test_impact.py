"""Rigid impact of masonry against closed forms: one block, two blocks, an arch; and what holds for any impact."""

import math

import numpy as np
import pytest
from masonry_blocks import GROUND, box, columns

import mjrock as mr


def turning(masonry, pivots, rates):
    """Velocities of blocks that turn about points x, z [m] at rates [rad/s], positive to the right, (bodies, 3)."""
    arms = masonry.centroids[list(masonry.free)] - np.reshape(pivots, (-1, 2))
    rates = np.broadcast_to(rates, len(arms))
    return np.column_stack([rates * arms[:, 1], -rates * arms[:, 0], rates])


def masses(masonry):
    return np.array([(b.mass, b.mass, b.inertia) for b in (masonry.blocks[i] for i in masonry.free)])


def energy(masonry, velocity):
    return 0.5 * float((masses(masonry) * np.square(velocity)).sum())


@pytest.mark.parametrize("h", [0.9, 2.1, 4.5])
def test_one_block_keeps_what_eq_2_says(h):
    wall = mr.Block(0.3, h)
    masonry = mr.Masonry.stack([wall], 1e9)
    e = mr.Restitution.from_geometry(wall).base
    for side in (1, -1):  # it arrives turning about one edge, and leaves about the other
        found = mr.rigid_impact(masonry, turning(masonry, (0.3 * side, 0), -side))
        assert found.velocity == pytest.approx(turning(masonry, (-0.3 * side, 0), -side * e), abs=1e-12)
        assert found.kept == pytest.approx(e**2, rel=1e-12)
        assert found.opening == ("ground|block_0",)


@pytest.mark.parametrize("blocks", [2, 3, 4, 7, 20])
@pytest.mark.parametrize("friction", [0.2, 10.0])
def test_a_stack_that_rocks_as_one_keeps_what_its_wall_keeps(blocks, friction):
    masonry = columns(blocks, friction=friction)
    e = mr.Restitution.from_geometry(mr.Block(0.3, 2.1)).base
    found = mr.rigid_impact(masonry, turning(masonry, (0.3, 0), -1.0))
    assert found.velocity == pytest.approx(turning(masonry, (-0.3, 0), -e), abs=1e-12)
    assert found.kept == pytest.approx(e**2, rel=1e-12)
    assert found.opening == (masonry.joints[0].name,)
    assert (found.impulses[1:, :2] > 0).all()  # every joint above stays closed


def test_the_impulses_of_one_block():
    """At 1 rad/s the edge that it lands on takes m b (1 + e) upwards, and m h (1 - e) along."""
    masonry = columns(1)
    mass, e = masonry.blocks[1].mass, mr.Restitution.from_geometry(mr.Block(0.3, 2.1)).base
    found = mr.rigid_impact(masonry, turning(masonry, (0.3, 0), -1.0))
    assert found.impulses == pytest.approx(np.array([[mass * 0.3 * (1 + e), 0, mass * 2.1 * (1 - e)]]), abs=1e-8)


def test_the_side_stop_of_eq_3():
    """Eq. 3 is an impact of the top edge alone: no base, and a side that the face below does not meet.

    The wall arrives turning about the inner edge of its base. A side of the height d has e_side within about d.
    """
    e = mr.Restitution.from_geometry(mr.Block(0.3, 2.1)).side
    wall, errors = box(-0.3, 0.3, 0, 4.2), []
    for d in (0.1, 0.01, 0.001):
        masonry = mr.Masonry([box(-1, -0.3, 4.2 - d, 4.2, fixed=True), wall])
        found = mr.rigid_impact(masonry, turning(masonry, (-0.3, 0), -1.0))
        errors.append(float(found.velocity[0, 2]) + e)  # it turns back: e is negative
    assert np.abs(errors) == pytest.approx([3.1e-3, 2.2e-4, 2.1e-5], rel=0.05)
    assert found.velocity == pytest.approx(turning(masonry, (-0.3, 4.2), -e), abs=1e-3)
    assert found.velocity[0] @ [1, 0, -2.1] < -1.9  # the foot moves into the side, which Eq. 3 does not see


@pytest.mark.parametrize("side_friction", [0.0, 0.7])
@pytest.mark.parametrize("top", [2.8, 4.2])
def test_a_wall_on_its_base_stops_dead_against_a_side(side_friction, top):
    """Base and side at once leave nothing. Eq. 4, base, side, base, leaves 0.20 of the energy."""
    masonry = mr.Masonry(
        [GROUND, box(-1, -0.3, 0, top, fixed=True, name="side"), box(-0.3, 0.3, 0, 4.2)],
        friction=lambda joint: 0.7 if joint.is_bed else side_friction,
    )
    found = mr.rigid_impact(masonry, turning(masonry, (0.3, 0), -1.0))
    assert found.kept == 0
    assert (found.velocity == 0).all()
    assert found.opening == ()


def two_blocks_leave(masonry, before, heights):
    """Rates of two blocks that leave about the left edges of their beds: angular momentum about each, by hand.

    Of both blocks about the left edge of the base, and of the upper one about that of the bed between. After the impact
    they move as a double pendulum with the arms r1 and r2 to the centroids and l1 to the upper edge.
    """
    m, width = masses(masonry), 0.6
    l1, edges = np.array([0, heights[0]]), np.array([(-0.5 * width, 0), (-0.5 * width, heights[0])])
    r1, r2 = (masonry.centroids[i + 1] - edges[i] for i in range(2))
    # momentum about a point of a body at arm r from it: I w + m (r_z v_x - r_x v_z)
    known = [
        sum(m[i, 2] * before[i, 2] + m[i, 0] * (r[1] * before[i, 0] - r[0] * before[i, 1]) for i, r in pairs)
        for pairs in (((0, r1), (1, l1 + r2)), ((1, r2),))
    ]
    a, c = m[0, 2] + m[0, 0] * r1 @ r1, m[1, 2] + m[1, 0] * r2 @ r2
    matrix = [[a + m[1, 0] * (l1 + r2) @ l1, m[1, 2] + m[1, 0] * (l1 + r2) @ r2], [m[1, 0] * r2 @ l1, c]]
    return np.linalg.solve(matrix, known)


@pytest.mark.parametrize(("thickness", "height", "load"), [(0.3, 4.0, 20e3), (0.21, 2.58, 10e3), (0.4, 3.0, 1e3)])
def test_a_strip_between_floors_that_cracks_at_half_its_height(thickness, height, load):
    """Two equal bodies of m, I, width 2b and height 2h turn at the same rate against each other, with a hinge at the
    edge of the crack, and lift the floor of the mass M by 4b. Of the velocity with the hinges on one side the impact
    leaves its part along that with the hinges on the other,

        e = (2 m h^2 - 10 m b^2 + 2 I - 16 M b^2) / (2 m h^2 + 10 m b^2 + 2 I + 16 M b^2).
    """
    masonry = mr.Masonry.between_floors(mr.Block.from_size(thickness, height), load=load, crack=height / 2)
    b, h = thickness / 2, height / 4
    m, inertia, mass = masses(masonry)[0, 0], masses(masonry)[0, 2], masses(masonry)[2, 0]
    before = -np.array([[h, b, 1.0], [h, 3 * b, -1.0], [0.0, 4 * b, 0.0]])
    e = (2 * m * h**2 - 10 * m * b**2 + 2 * inertia - 16 * mass * b**2) / (
        2 * m * h**2 + 10 * m * b**2 + 2 * inertia + 16 * mass * b**2
    )
    found = mr.rigid_impact(masonry, before)
    assert found.velocity == pytest.approx(-e * np.array([[h, -b, 1.0], [h, -3 * b, -1.0], [0.0, -4 * b, 0.0]]))
    assert found.kept == pytest.approx(e**2)


@pytest.mark.parametrize("heights", [(2.1, 2.1), (1.2, 3.0), (3.4, 0.8)])
@pytest.mark.parametrize("upper", [-1.2, -1.5, -2.5, -6.0])
def test_two_blocks(heights, upper):
    """They arrive turning about the right edges of both beds, at different rates.

    Where both joints open at their right ends, angular momentum about the two left edges gives the velocities, as in
    the literature on two blocks. Where that would close the upper joint, the two leave as one, with the angular
    momentum of both about the left edge of the base.
    """
    parts = [box(-0.3, 0.3, 0, heights[0]), box(-0.3, 0.3, heights[0], sum(heights))]
    masonry = mr.Masonry([GROUND, *parts])
    before = turning(masonry, [(0.3, 0), (0.3, heights[0])], [-1.0, upper])
    before[1, :2] += np.array([-heights[0], 0])  # the upper pivot moves with the lower block
    found = mr.rigid_impact(masonry, before)
    lower, top = two_blocks_leave(masonry, before, heights)
    if top < lower:
        assert found.velocity[:, 2] == pytest.approx([lower, top], rel=1e-9)
        assert found.opening == ("ground|block_1", "block_1|block_2")
    else:
        mass, arms = masses(masonry), masonry.centroids[1:] - [-0.3, 0]
        momentum = (
            mass[:, 2] * before[:, 2] + mass[:, 0] * (arms[:, 1] * before[:, 0] - arms[:, 0] * before[:, 1])
        ).sum()
        whole = momentum / (mass[:, 2] + mass[:, 0] * (arms**2).sum(axis=1)).sum()
        assert found.velocity == pytest.approx(turning(masonry, (-0.3, 0), whole), rel=1e-9)
        assert found.opening == ("ground|block_1",)
    assert found.kept == pytest.approx(energy(masonry, found.velocity) / energy(masonry, before))


def test_a_block_alone_on_a_wide_one_keeps_what_eq_2_says():
    masonry = mr.Masonry([GROUND, box(-2, 2, 0, 1), box(-0.3, 0.3, 1, 3)])
    before = np.vstack([np.zeros(3), turning(masonry, (0.3, 1), -1.0)[1]])
    found = mr.rigid_impact(masonry, before)
    assert found.kept == pytest.approx(mr.Restitution.from_geometry(mr.Block(0.3, 1.0)).base ** 2)
    assert (found.velocity[0] == 0).all()
    assert found.opening == ("block_1|block_2",)


def mechanism(masonry, hinges):
    """The velocity with one hinge in each joint, at its start (0) or its end (1): what the hinges leave free."""
    number, rows = {block: i for i, block in enumerate(masonry.free)}, []
    for joint, end in zip(masonry.joints, hinges, strict=True):
        at = np.array((joint.start, joint.end)[end])
        for row in np.eye(2):
            made = np.zeros((len(number), 3))
            for block, sign in ((joint.above, 1), (joint.below, -1)):
                if block in number:
                    x, z = at - masonry.centroids[block]
                    made[number[block]] = sign * np.array([*row, row @ [z, -x]])
            rows.append(made.ravel())
    return np.linalg.svd(np.array(rows))[2][-1].reshape(-1, 3)


@pytest.mark.parametrize(("angle", "thickness"), [(120, 0.15), (157.5, 0.15), (180, 0.2)])
def test_an_arch_of_three_voussoirs_leaves_in_the_mirrored_mechanism(angle, thickness):
    """Four hinges are one degree of freedom. What is kept is the square of the cosine between arrival and departure,
    in the norm of the masses."""
    masonry = mr.Masonry.arch(1.0, thickness, math.radians(angle), 3)
    before, after = mechanism(masonry, (0, 1, 1, 0)), mechanism(masonry, (1, 0, 0, 1))
    mass = masses(masonry)
    for arriving in (before, -before):
        found = mr.rigid_impact(masonry, arriving)
        if len(found.opening) == 4 and found.kept < 1 - 1e-9:
            break
    cosine = (arriving * mass * after).sum() / math.sqrt((before * mass * before).sum() * (after * mass * after).sum())
    assert found.kept == pytest.approx(cosine**2, rel=1e-9)
    departing = after * (arriving * mass * after).sum() / (after * mass * after).sum()
    assert found.velocity == pytest.approx(departing, abs=1e-9)
    assert mr.rigid_impact(masonry, -arriving).kept == pytest.approx(1)  # the mechanism that opens meets nothing


MASONRY = {
    "stack": columns(4),
    "arch": mr.Masonry.arch(5.0, 0.75, math.pi, 7),
    "bond": mr.Masonry.running_bond(1.5, 0.75, (0.5, 0.25)),
}


@pytest.mark.parametrize("name", MASONRY)
@pytest.mark.parametrize("seed", range(4))
def test_what_holds_for_any_impact(name, seed):
    """The lost energy is that of the lost velocities, impulses push, and where a joint opens there is none."""
    masonry = MASONRY[name]
    before = np.random.default_rng(seed).normal(size=(len(masonry.free), 3))
    found = mr.rigid_impact(masonry, before)
    lost = energy(masonry, before) - energy(masonry, found.velocity)
    assert lost == pytest.approx(energy(masonry, before - found.velocity), rel=1e-9)
    assert (found.impulses[:, :2] >= 0).all()
    if found.velocity.any():
        again = mr.rigid_impact(masonry, found.velocity)  # an impact that is over
        assert again.kept == pytest.approx(1)
        assert again.velocity == pytest.approx(found.velocity, abs=1e-9)
    faster = mr.rigid_impact(masonry, 3 * before)
    assert faster.velocity == pytest.approx(3 * found.velocity, abs=1e-9)
    assert faster.opening == found.opening


@pytest.mark.parametrize("seed", range(3))
def test_size_density_and_mirror(seed):
    masonry = MASONRY["arch"]
    before = np.random.default_rng(seed).normal(size=(7, 3))
    found = mr.rigid_impact(masonry, before)

    def changed(scale, density):
        return mr.Masonry(
            [
                mr.Polygon(scale * block.corners, density=density, fixed=block.fixed, name=name)
                for block, name in zip(masonry.blocks, masonry.names, strict=True)
            ]
        )

    larger = mr.rigid_impact(changed(np.array([3.0, 3.0]), 500.0), before * [3, 3, 1])
    assert larger.kept == pytest.approx(found.kept)
    assert larger.velocity == pytest.approx(found.velocity * [3, 3, 1], abs=1e-9)
    assert larger.opening == found.opening
    mirrored = mr.rigid_impact(changed(np.array([-1.0, 1.0]), 2000.0), before * [-1, 1, -1])
    assert mirrored.velocity == pytest.approx(found.velocity * [-1, 1, -1], abs=1e-9)
    assert mirrored.kept == pytest.approx(found.kept)


def test_stiffness_damping_and_the_size_of_friction_do_not_enter():
    before = np.random.default_rng(3).normal(size=(3, 3))
    one, other = columns(3, k_n=1e7, xi=0.9, friction=0.1), columns(3, k_n=1e12, xi=0.0, friction=9.0, points=5)
    assert (mr.rigid_impact(one, before).velocity == mr.rigid_impact(other, before).velocity).all()


def test_a_joint_without_friction_slides():
    smooth, rough = columns(1, friction=0.0), columns(1, friction=0.01)
    dropped = [[0.1, -1.0, 0.0]]  # it lands with its whole base while it moves sideways
    assert mr.rigid_impact(smooth, dropped).velocity == pytest.approx(np.array([[0.1, 0, 0]]), abs=1e-12)
    assert (mr.rigid_impact(rough, dropped).velocity == 0).all()
    for masonry, along in ((smooth, 0.0), (rough, -0.1)):
        impulses = mr.rigid_impact(masonry, dropped).impulses[0] / masonry.blocks[1].mass
        assert impulses[:2].sum() == pytest.approx(1)
        assert impulses[2] == pytest.approx(along)


def test_a_joint_that_opens_everywhere_is_not_held():
    masonry = columns(2)
    thrown = [[1.0, 1.0, 0.0], [2.0, 3.0, 0.0]]
    found = mr.rigid_impact(masonry, thrown)
    assert found.velocity == pytest.approx(np.array(thrown))
    assert found.opening == ("ground|block_0", "block_0|block_1")
    assert (found.impulses == 0).all()
    assert repr(found) == "<RigidImpact keeps 1 of the energy; joints that open: ground|block_0, block_0|block_1>"


@pytest.mark.parametrize(
    ("velocity", "error", "complaint"),
    [
        ([[0, 0, 1]], ValueError, r"velocity has the shape \(1, 3\); \(2, 3\) is needed"),
        (np.full((2, 3), np.nan), ValueError, "velocity holds a value that is not finite"),
        (np.zeros((2, 3)), ValueError, "velocity is zero everywhere; an impact needs a block that moves"),
        ("fast", TypeError, "velocity = 'fast' of type str does not hold real numbers alone"),
    ],
)
def test_a_velocity_that_cannot_be_is_refused(velocity, error, complaint):
    with pytest.raises(error, match=complaint):
        mr.rigid_impact(columns(2), velocity)
    with pytest.raises(TypeError, match=r"masonry = .* is not a Masonry"):
        mr.rigid_impact(mr.Block(0.3, 2.1), [[0, 0, 1]])


def test_what_comes_back_is_read_only():
    found = mr.rigid_impact(columns(1), [[0, -1, 0]])
    for values in (found.velocity, found.impulses):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 1
