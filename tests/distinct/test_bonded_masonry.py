"""Masonry with bonds: at rest, by explicit steps, in limit analysis, and what refuses it."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from bonded import MORTAR, joint

import mjrock as mr
from mjrock.distinct.setup import setup_of

HUGE = mr.Bond(1e9, 1e9, 1e12, 1e12)
WEAK = {"k_n": 2e9, "k_s": 1e9, "points": 3, "frequency": 500.0, "bond": mr.Bond(2e3, 2.8e3, 0.05, 0.5)}


def in_boxes(plane, options):
    """Masonry of rectangles as boxes in space."""
    boxes = []
    for block in plane.blocks:
        low, high = block.corners.min(axis=0), block.corners.max(axis=0)
        size, middle = (high - low).tolist(), (0.5 * (low + high)).tolist()
        boxes.append(
            mr.Polyhedron.box(
                (size[0], block.length, size[1]), (middle[0], 0, middle[1]), fixed=block.fixed, name=block.name
            )
        )
    return mr.Masonry(boxes, **options)


def cantilever(count, bond=MORTAR, **more):
    """Blocks of 0.2 x 0.3 x 0.2 m glued to each other and to a wall beside them."""
    blocks = [mr.Polygon([(-0.3, 0), (0, 0), (0, 0.3), (-0.3, 0.3)], length=0.2, fixed=True, name="wall")]
    for i in range(count):
        corners = [(0.2 * i, 0), (0.2 * i + 0.2, 0), (0.2 * i + 0.2, 0.3), (0.2 * i, 0.3)]
        blocks.append(mr.Polygon(corners, length=0.2, name=f"b{i}"))
    return mr.Masonry(blocks, **{"k_n": 6e10, "k_s": 3e10, "points": 3, "bond": bond} | more)


def shaken(masonry, duration=0.5, size=4.0, **options):
    t = np.arange(0.0, duration, 0.005)
    motion = mr.GroundMotion(size * np.sin(2 * np.pi * 3 * t), 0.005)
    return mr.solve_explicit(mr.MasonryCase(masonry, duration, motion), **options)


def column(bond, count=3, **more):
    """A column of cubes of 0.4 m on the ground."""
    blocks = [mr.Polygon([(-1, -0.5), (1, -0.5), (1, 0), (-1, 0)], fixed=True, name="ground")]
    for i in range(count):
        blocks.append(
            mr.Polygon(
                [(-0.2, 0.4 * i), (0.2, 0.4 * i), (0.2, 0.4 * i + 0.4), (-0.2, 0.4 * i + 0.4)], length=0.4, name=f"b{i}"
            )
        )
    return mr.Masonry(blocks, **{"k_n": 2e9, "k_s": 1e9, "points": 3, "bond": bond} | more)


def test_bonded_blocks_hang_at_rest_on_their_bonds():
    masonry = cantilever(4)
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.02), ledger=True, forces=True)
    weight = 4 * 0.2 * 0.3 * 0.2 * 2000 * mr.GRAVITY
    assert np.abs(answer.pose - answer.pose[0]).max() < 1e-9
    assert answer.reactions["wall"][0] == pytest.approx([0.0, weight], abs=1e-6 * weight)
    assert (answer.forces.damage == 0).all()
    assert not answer.cracked


def test_what_needs_more_than_its_strength_at_rest_is_refused_by_name():
    """M / W of the section at the wall, 1506.8 N m / 0.003 m3, over a tension of 0.25 MPa."""
    with pytest.raises(ValueError, match=r"at rest the bonds of wall\|b0, .* would need 2.01 times their strength"):
        mr.solve_explicit(mr.MasonryCase(cantilever(8), 0.1))
    with pytest.raises(ValueError, match="b0 would fall under the weight"):
        mr.solve_explicit(mr.MasonryCase(cantilever(1, None), 0.1))


def test_limit_analysis_holds_tension_and_cohesion():
    """A column whose bed joint holds its tension over all of its width."""
    bond = mr.Bond(0.01e6, 0.05e6, 10.0, 50.0)
    one = column(bond, 1)
    weight, width = 0.4**3 * 2000 * mr.GRAVITY, 0.4
    pull = bond.tension * 0.4 * width
    dry = mr.collapse_multiplier(column(None, 1, points=2)).multiplier
    assert dry == pytest.approx(0.7)
    sliding = 0.7 + bond.cohesion * 0.4 * width / weight
    turning = 0.5 * width * (weight + pull) / (weight * 0.2)  # the middle of the pull is that of the width
    found = mr.collapse_multiplier(one)
    assert found.multiplier == pytest.approx(min(sliding, turning), rel=1e-6)
    with pytest.raises(ValueError, match="collapse_multiplier without dilatancy takes joints that push only"):
        mr.collapse_multiplier(one, associated=False)


def test_bonds_without_strength_are_dry_bit_for_bit():
    dry, none = (shaken(column(bond)) for bond in (None, mr.Bond(0.0, 0.0, 1.0, 1.0)))
    assert np.array_equal(dry.pose, none.pose)


@pytest.mark.filterwarnings("ignore:tension = .* is it in MPa:mjrock.Implausible")
def test_bonds_of_next_to_no_strength_move_as_dry_ones():
    """Dry joints whose lines share the area in the same way are those that could be crushed alone, and are not."""
    uncrushed = mr.Bond(0.0, 0.0, 1.0, 1.0, 1e12, 1e15)
    dry, weak = (shaken(column(bond)) for bond in (uncrushed, mr.Bond(1.0, 1.0, 1e-6, 1e-6)))
    assert weak.pose == pytest.approx(dry.pose, abs=0.01 * np.abs(dry.pose).max())
    assert weak.pose[:150] == pytest.approx(dry.pose[:150], abs=1e-4 * np.abs(dry.pose).max())


def test_a_block_on_bonds_that_never_break_vibrates_as_on_linear_springs():
    masonry = joint(HUGE)
    answer = mr.solve_explicit(
        mr.MasonryCase(masonry, 0.02, velocity=[[0.0, 0.05, 0.0]]), output_step=1e-7, timestep=1e-7
    )
    mass, z = 0.1 * 0.2 * 0.1 * 2000, answer.pose[:, 0, 1] - answer.pose[0, 0, 1]
    stiffness = 62.7e9 * 0.02
    rising = np.flatnonzero((z[:-1] < 0) & (z[1:] >= 0))
    crossed = answer.t[rising] + 1e-7 * z[rising] / (z[rising] - z[rising + 1])
    period = (crossed[-1] - crossed[0]) / (len(crossed) - 1)
    assert 2 * math.pi / period == pytest.approx(math.sqrt(stiffness / mass), rel=1e-6)


@pytest.mark.parametrize("base", [HUGE, None])
def test_blocks_on_bonds_that_never_break_move_as_one_rigid_body(base):
    """Three cubes on each other beside one block on the same base, 1e6 times as soft as the joints above it.

    What differs is the compliance of the joints between, some 1e-6 of that of the base.
    """
    soft = 1e7
    stiffness = {"k_n": lambda joint: soft if "ground" in joint.name else 1e6 * soft, "xi": 0.0}
    three = column(lambda joint: base if "ground" in joint.name else HUGE, k_s=stiffness["k_n"], **stiffness)
    ground, lowest, *_ = three.blocks
    whole = mr.Polygon([(-0.2, 0), (0.2, 0), (0.2, 1.2), (-0.2, 1.2)], length=lowest.length, name="whole")
    one = mr.Masonry([ground, whole], k_s=stiffness["k_n"], points=3, bond=base, **stiffness)
    turn, h = 0.3 if base is None else 0.01, 4e-6
    answers = [
        mr.solve_explicit(mr.MasonryCase(masonry, 0.6, velocity=[[turn * z, 0, turn] for z in heights]), timestep=h)
        for masonry, heights in ((three, (0.2, 0.6, 1.0)), (one, (0.6,)))
    ]
    assert (answers[1].opening.max() > 1e-3) == (base is None)
    moved = [answer.pose - answer.pose[0] for answer in answers]
    size = np.abs(moved[1][:, 0]).max(axis=0)
    assert (np.abs(moved[0][:, 1] - moved[1][:, 0]).max(axis=0) < 5e-6 * size).all()


@pytest.mark.parametrize("space", [False, True])
def test_the_ledger_of_masonry_that_cracks_closes_and_names_what_bonds_took(space):
    if space:
        blocks = [mr.Polyhedron.box((2, 2, 0.5), (0, 0, -0.25), fixed=True, name="ground")]
        blocks += [mr.Polyhedron.box((0.4, 0.4, 0.4), (0, 0, 0.2 + 0.4 * i), name=f"b{i}") for i in range(3)]
        masonry = mr.Masonry(blocks, k_n=2e9, k_s=1e9, points=3, bond=mr.Bond(0.03e6, 0.05e6, 2.0, 10.0))
    else:
        masonry = column(mr.Bond(0.03e6, 0.05e6, 2.0, 10.0))
    answer = shaken(masonry, 1.0, 8.0, ledger=True, forces=True)
    assert np.abs(answer.ledger.residual).max() < 1e-3 * answer.ledger.largest
    took = answer.ledger.bonds
    assert list(took) == ["tension", "slip", "crushing"]
    lost = 0.16 * answer.forces.damage[-1].sum()  # area; lines that pull still would give a part of their energy back
    assert took["tension"][-1] / 2.0 + took["slip"][-1] / 10.0 == pytest.approx(lost, rel=0.1)
    assert (np.diff(answer.forces.damage, axis=0) >= -1e-12).all()
    times = list(answer.cracked.values())
    assert times == sorted(times)
    assert "ground|b0" in answer.cracked
    crack = answer.cracked["ground|b0"]
    damage = answer.forces.damage[:, masonry.joints.index(next(j for j in masonry.joints if j.name == "ground|b0"))]
    assert damage[answer.t < crack - 2e-3].min() < 0.5 < damage[answer.t > crack + 2e-3].min()


@pytest.mark.parametrize("space", [False, True])
def test_what_holds_is_not_damped_where_dashpots_wait_for_cracks(space):
    """To the last bit as without dashpots: bonds that never break, and a push that shears and opens them."""
    poses = []
    for xi, bond in ((0.0, HUGE), (0.5, replace(HUGE, damped=False)), (0.5, HUGE)):
        masonry = joint(bond, space=space, xi=xi)
        velocity = [[0.05, 0.0, 0.03, 0.1, 0.2, 0.3]] if space else [[0.05, 0.03, 0.2]]
        poses.append(mr.solve_explicit(mr.MasonryCase(masonry, 0.004, velocity=velocity), timestep=2e-7).pose)
    assert np.array_equal(poses[0], poses[1])
    assert np.abs(poses[2] - poses[0]).max() > 0.1 * np.abs(poses[0] - poses[0][0]).max()


def test_dashpots_that_wait_for_cracks_take_nothing_before_the_first_one_and_the_books_close():
    bond = mr.Bond(0.03e6, 0.05e6, 2.0, 10.0, damped=False)
    answer = shaken(column(bond, xi=0.2), 1.0, 8.0, ledger=True, forces=True)
    took = sum(answer.ledger.dashpots.values())
    whole = answer.forces.damage.max(axis=1) == 0
    assert 10 < whole.sum() < len(whole)
    assert took[whole].max() == 0
    assert took[-1] > 1e-3 * answer.ledger.largest
    assert (np.diff(took) >= -1e-9 * answer.ledger.largest).all()
    assert np.abs(answer.ledger.residual).max() < 1e-3 * answer.ledger.largest


def test_a_run_carries_on_with_its_bonds():
    masonry = column(mr.Bond(0.03e6, 0.05e6, 2.0, 10.0))
    t = np.arange(0.0, 0.6, 0.005)
    motion = mr.GroundMotion(8.0 * np.sin(2 * np.pi * 3 * t), 0.005)
    h = 2e-5
    whole = mr.solve_explicit(mr.MasonryCase(masonry, 0.4, motion), timestep=h)
    first = mr.solve_explicit(mr.MasonryCase(masonry, 0.2, motion), timestep=h)
    late = mr.GroundMotion(motion.accel[40:], 0.005)
    second = mr.solve_explicit(mr.MasonryCase(masonry, 0.2, late), timestep=h, start=first.end)
    assert first.opening.max() > 1e-3
    assert second.pose[-1] == pytest.approx(whole.pose[-1], abs=1e-9)


def test_mujoco_rocking_theory_and_a_missing_k_s_are_said_by_name():
    masonry = cantilever(2)
    case = mr.MasonryCase(masonry, 0.1)
    for call in (
        lambda: mr.simulate(case),
        lambda: mr.masonry_mjcf(case, 1e-4),
        lambda: mr.rigid_impact(masonry, [[0, 0, 1], [0, 0, 1]]),
    ):
        with pytest.raises(ValueError, match=r"bond of wall\|b0, b0\|b1: .* solve_explicit takes bonds"):
            call()
    with pytest.raises(ValueError, match=r"bond of wall\|b0: k_s = None, and a bond needs a shear stiffness"):
        cantilever(2, k_s=None)


def test_bonds_are_given_for_some_joints():
    masonry = cantilever(2, lambda joint: MORTAR if "wall" in joint.name else None)
    assert masonry.bonds == (MORTAR, None)
    with pytest.raises(ValueError, match="b1 would fall"):
        mr.solve_explicit(mr.MasonryCase(masonry, 0.1))


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ((-1.0, 0.0, 1.0, 1.0), "tension = -1 Pa"),
        ((0.0, 1.0, 1.0, 1.0), "cohesion = 1 Pa with a tension of 0"),
        ((1.0, 1.0, 0.0, 1.0), "opening_energy = 0 J/m2"),
        ((1.0, 1.0, 1.0, 1.0, 1e6), "give both of them, or neither"),
    ],
)
def test_a_bond_out_of_range_is_refused(numbers, message):
    with pytest.raises(ValueError, match=message):
        mr.Bond(*numbers)


def test_units_in_halves_have_the_mass_of_whole_ones_and_a_bond_within():
    """A wall of 1.0 m in units of 0.4 m: two whole units and a piece of 0.2 m, which stays whole, in a course."""
    within, between = mr.Bond(1e6, 1.4e6, 50.0, 500.0), mr.Bond(0.1e6, 0.14e6, 10.0, 100.0)
    options = {"k_n": 1e10, "k_s": 1e10, "points": 3, "bond": between}
    whole, halved = (mr.Masonry.running_bond(1.0, 0.4, (0.4, 0.2), halves=one, **options) for one in (None, within))
    assert sum(block.mass for block in halved.blocks) == pytest.approx(sum(block.mass for block in whole.blocks))
    assert len(halved.free) - len(whole.free) == 4
    inner = [joint.name for joint, bond in zip(halved.joints, halved.bonds, strict=True) if bond == within]
    assert len(inner) == 4
    assert all(first[:-1] == second[:-1] for first, second in (name.split("|") for name in inner))
    assert all(bond in (within, between) for bond in halved.bonds)


def test_a_bonded_wall_that_cracks_moves_in_the_plane_as_in_space():
    """A wall of four courses and its blocks as boxes in space, its joints cracked, and beyond as it falls apart."""
    plane = mr.Masonry.running_bond(0.4, 0.8, (0.4, 0.2), thickness=0.2, **WEAK)
    flat, deep = (shaken(one, 0.3, 9.0, timestep=2e-5) for one in (plane, in_boxes(plane, WEAK)))
    assert len(flat.cracked) > 3
    assert list(flat.cracked) == list(deep.cracked)
    gap = np.abs(deep.pose[..., [0, 2]] - flat.pose[..., :2]).max()
    assert gap < 1e-6 * np.abs(flat.pose - flat.pose[0]).max()


def test_a_block_whose_joint_is_handed_over_moves_in_the_plane_as_in_space():
    """It slides on a joint that has cracked. A point in the middle gives its friction to both places beside it."""
    ground = mr.Polygon([(-0.5, -0.2), (0.5, -0.2), (0.5, 0), (-0.5, 0)], length=0.2, fixed=True)
    plane = mr.Masonry([ground, mr.Polygon([(-0.1, 0), (0.1, 0), (0.1, 0.3), (-0.1, 0.3)], length=0.2)], **WEAK)
    flat, deep = (shaken(one, 0.4, 9.0, timestep=2e-5) for one in (plane, in_boxes(plane, WEAK)))
    assert np.abs(flat.pose[-1, 0, 0] - flat.pose[0, 0, 0]) > 0.05 * 0.2
    assert np.abs(deep.pose[..., [0, 2]] - flat.pose[..., :2]).max() < 1e-9


def frequencies(x, h, modes):
    """Of undamped modes about a constant, from samples [rad/s]: x_{i+n} + x_{i-n} follows from those between."""
    n, inner = modes, len(x) - 2 * modes
    rows = [np.ones(inner), x[n:-n], *(x[n + i : n + i + inner] + x[n - i : n - i + inner] for i in range(1, n))]
    weights = np.linalg.lstsq(np.array(rows).T, x[2 * n :] + x[:inner], rcond=None)[0]
    cosines = np.polynomial.chebyshev.chebroots([-weights[1], *(-2 * weights[2:]), 2.0])
    return np.sort(np.arccos(cosines)) / h


@pytest.mark.slow
@pytest.mark.parametrize("in_space", [False, True], ids=["plane", "space"])
def test_units_whose_bonds_are_strong_and_stiff_vibrate_as_one_block(in_space):
    """Up and down, and in both modes of sway and rocking, on a joint that is four million times softer."""
    found = []
    for heights in ((0.0, 1.2), (0.0, 0.3, 0.6, 1.2)):
        blocks = [mr.Polygon([(-1, -0.5), (1, -0.5), (1, 0), (-1, 0)], length=0.4, fixed=True, name="ground")]
        for low, high in pairwise(heights):
            corners = [(-0.2, low), (0.2, low), (0.2, high), (-0.2, high)]
            blocks.append(mr.Polygon(corners, length=0.4, name=f"at {low}"))
        if in_space:
            blocks = [mr.Polyhedron.prism(block) for block in blocks]

        def stiffness(joint):
            return 2.5e7 if "ground" in joint.name else 1e14

        masonry = mr.Masonry(blocks, k_n=stiffness, k_s=stiffness, friction=0.6, xi=0, bond=HUGE, points=3)
        step = {"timestep": 8e-6} if len(heights) == 2 else {}
        for way, accel, modes in (("motion", 1e-3, 2), ("vertical", 1e-2, 1)):
            case = mr.MasonryCase(masonry, 0.4, **{way: mr.GroundMotion([accel] * 2, 0.4)})
            answer = mr.solve_explicit(case, output_step=1e-3, **step)
            up = 2 if in_space else 1
            found.append(frequencies(answer.pose[:, -1, 0 if modes == 2 else up], answer.t[1], modes))
    one, units = np.concatenate(found[:2]), np.concatenate(found[2:])
    np.testing.assert_allclose(units, one, rtol=1e-6)
    assert one[2] == pytest.approx(math.sqrt(2.5e7 * 0.16 / (2000 * 0.4 * 0.4 * 1.2)), rel=1e-6)


@pytest.mark.parametrize("in_space", [False, True])
def test_each_line_of_a_bond_has_its_part_of_the_area(in_space):
    """Damage of a joint is a mean over its area, of which each line has the part that it has of the stiffness."""
    bond = {"k_n": 1e9, "k_s": 5e8, "points": 5, "bond": mr.Bond(1e5, 1e5, 10.0, 50.0)}
    masonry = mr.Masonry.column(0.5, 2.0, 2, **bond)
    if not in_space:
        masonry = mr.Masonry.stack([mr.Block.from_size(0.5, 1.0)] * 2, **bond)
    system = setup_of(mr.MasonryCase(masonry, 0.1), None, None).system
    for group in range(len(masonry.joints)):
        bonds = system.laws[0].rows[system.lines["group"] == group]
        np.testing.assert_allclose(bonds["share"], bonds["k"] / bonds["k"].sum(), rtol=1e-12)
        assert bonds["share"].sum() == pytest.approx(1.0)
