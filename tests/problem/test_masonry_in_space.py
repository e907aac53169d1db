"""Masonry in space: its joints, its contact points, and the frequency that damps it."""

import math

import numpy as np
import pytest
from scipy.linalg import null_space
from scipy.spatial import ConvexHull

import mjrock as mr
from mjrock.geometry import convex
from mjrock.problem.masonry.lines import masses_of, mean_slip_rates, rates

GROUND = mr.Polyhedron.box((8, 8, 1), (0, 0, -0.5), fixed=True, name="ground")
box = mr.Polyhedron.box


def turned(block, angle):
    c, s = math.cos(angle), math.sin(angle)
    about_z = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return mr.Polyhedron(block.corners @ about_z.T, block.density, block.fixed, block.name)


def wall(courses=3, units=4, angle=0.0):
    """Running bond of units .25 x .3 x .2 m, without half units."""
    blocks = [GROUND] + [
        box((0.25, 0.3, 0.2), (0.25 * i + 0.125 * (course % 2), 0.0, 0.2 * course + 0.1))
        for course in range(courses)
        for i in range(units)
    ]
    return mr.Masonry([turned(block, angle) for block in blocks], k_n=1e9)


@pytest.mark.parametrize("angle", [0.0, 0.3, -2.0])
def test_a_wall_has_all_its_joints(angle):
    masonry = wall(angle=angle)
    joints = masonry.joints
    heads = [joint for joint in joints if not joint.is_bed]
    assert (len(heads), len(joints)) == (3 * 3, 3 * 3 + 4 + 2 * 7)
    assert all(joint.area == pytest.approx(0.06) and joint.width == pytest.approx(0.2) for joint in heads)
    assert sum(j.area for j in joints if j.is_bed) == pytest.approx(4 * 0.075 + 2 * 3.5 * 0.075)
    for joint in joints:
        apart = masonry.centroids[joint.above] - masonry.centroids[joint.below]
        assert joint.normal @ apart > 0
        assert len(joint.outline) == 4
        assert joint.outline.mean(axis=0) == pytest.approx(joint.middle)
        assert joint.below == 0 or joint.normal[2] > -1e-9
    assert joints[0].name == "ground|block_1"


def test_edges_of_the_block_below_that_lie_within_the_face_above_carry_their_points():
    """As in the plane the whole line at an end where the upper block overhangs, not only its corners."""
    masonry = mr.Masonry(
        [GROUND, box((0.4, 0.3, 0.2), (0, 0, 0.1)), box((0.8, 0.3, 0.2), (0.2, 0, 0.3))], k_n=1e9, points=3
    )
    lines = masonry.lines
    own = lines.joint == 1
    at_end = np.isclose(lines.at[own][:, 0], 0.2)
    assert at_end.sum() == 3
    assert (lines.body[own] == np.where(at_end, 1, 2)).all()
    assert lines.normal[own][:, 2] == pytest.approx(np.where(at_end, -1, 1))
    on_ground = lines.joint == 0
    assert (lines.body[on_ground] == 1).all()


def test_a_joint_lies_halfway_and_is_the_common_part_of_two_faces():
    masonry = mr.Masonry([GROUND, box((1, 1, 1), (0, 0, 0.5 + 4e-6)), box((1, 1, 1), (0.75, 0.5, 1.5))])
    below, above = masonry.joints
    assert (below.name, above.name) == ("ground|block_1", "block_1|block_2")
    assert below.middle == pytest.approx([0, 0, 2e-6], abs=1e-12)
    assert above.middle == pytest.approx([0.375, 0.25, 1.0 + 2e-6], abs=1e-9)
    assert (above.area, above.width) == (pytest.approx(0.125), pytest.approx(0.25))
    # one corner of the common part is a corner of the block above, one of that below, two are crossings of edges
    assert sum(above.corners) == 1
    lines = masonry.lines
    of_above = lines.joint == 1
    assert sorted(lines.body[of_above].tolist()) == [1, 2, 2, 2]
    assert (lines.normal[of_above, 2] == np.where(lines.body[of_above] == 2, 1.0, -1.0)).all()


def test_a_fixed_block_is_below_wherever_it_is():
    masonry = mr.Masonry([GROUND, box((1, 1, 1), (0, 0, 0.5)), box((1, 1, 1), (0, 0, 1.5), fixed=True, name="beam")])
    assert masonry.joints[1].name == "beam|block_1"
    assert masonry.joints[1].normal[2] == -1.0
    assert (masonry.lines.body == 1).all()


def test_blocks_that_touch_along_an_edge_or_at_a_corner_have_no_joint():
    blocks = [GROUND, box((1, 1, 1), (0, 0, 0.5)), box((1, 1, 1), (1, 1, 0.5)), box((1, 1, 1), (1, 0, 1.5 + 2e-5))]
    assert len(mr.Masonry(blocks).joints) == 2


@pytest.mark.parametrize("apart", [-0.02, 0.02])
def test_an_overlap_is_refused_by_name_also_across_edges(apart):
    """Two bars that cross, each turned to stand on an edge: only the product of their edges tells them apart."""
    c = math.sqrt(0.5)
    diamond = box((3, 1, 1)).corners @ np.array([[1, 0, 0], [0, c, c], [0, -c, c]])
    bar = mr.Polyhedron(diamond + np.array([0, 0, 2]), name="bar")
    cross = mr.Polyhedron(diamond[:, [1, 0, 2]] + [0, 0, 2 + math.sqrt(2) + apart], name="cross")
    rest = [GROUND, box((1, 1, 0.5), (3, 3, 0.25))]
    if apart > 0:
        assert len(mr.Masonry([*rest, bar, cross]).joints) == 1
    else:
        with pytest.raises(ValueError, match=r"blocks bar and cross overlap by 0.02 m"):
            mr.Masonry([*rest, bar, cross])


def test_points_of_prisms_beside_each_other_are_on_the_blocks_that_carry_the_lines_of_the_plane():
    """Two prisms of one distance from the middle, of which one is higher: across them their points make its lines."""
    middles = {"low": (-0.5, 0.5), "high": (0.5, 0.7)}
    flat = [mr.Polygon([(-4, -1), (4, -1), (4, 0), (-4, 0)], fixed=True, length=2.0)]
    solid = [box((8, 2, 1), (0, 0, -0.5), fixed=True)]
    for name, (x, z) in middles.items():
        flat.append(mr.Polygon([(x - 0.5, 0), (x + 0.5, 0), (x + 0.5, 2 * z), (x - 0.5, 2 * z)], name=name, length=2.0))
        solid.append(box((1, 2, 2 * z), (x, 0, z), name=name))
    found = []
    for blocks, place in ((flat, slice(0, 2)), (solid, slice(0, 3, 2))):
        lines, stiffness = mr.Masonry(blocks, k_n=1e9, points=4).lines, {}
        for body, at, k in zip(lines.body, np.round(lines.at[:, place], 6) + 0.0, lines.k, strict=True):
            stiffness[int(body), *at.tolist()] = stiffness.get((int(body), *at.tolist()), 0.0) + k
        found.append(stiffness)
    assert found[0] == pytest.approx(found[1])


def test_contact_points_carry_the_area_of_their_joint():
    for points, count in ((2, 4), (3, 9)):
        masonry = mr.Masonry([GROUND, box((0.6, 0.4, 2.0), (0, 0, 1.0))], k_n=1e8, points=points)
        assert masonry.lines.at.shape == (count, 3)
        assert masonry.lines.k.sum() == pytest.approx(0.24e8)


def test_rates_are_differences_of_a_small_motion():
    masonry = wall(2, 2, 0.3)
    lines, free = masonry.lines, list(masonry.free)
    rng = np.random.default_rng(0)
    motion = rng.standard_normal((len(free), 6))
    everyone = np.zeros((len(masonry.blocks), 6))
    everyone[free] = motion
    velocity = [
        everyone[b, :3] + np.cross(everyone[b, 3:], lines.at - masonry.centroids[b]) for b in range(len(everyone))
    ]
    m = np.arange(len(lines.k))
    apart = np.array(velocity)[lines.body, m] - np.array(velocity)[lines.face, m]
    for direction in (lines.normal, *lines.tangents):
        got = rates(masonry.blocks, lines, direction) @ motion.ravel()
        assert got == pytest.approx((apart * direction).sum(axis=1), abs=1e-12)


def test_slips_hold_sliding_and_twisting_and_nothing_else():
    """A block on the ground: the motions without slip are the lift and the two rotations that open the joint."""
    masonry = mr.Masonry([GROUND, box((0.6, 0.4, 2.0), (0, 0, 1.0))])
    grip = mean_slip_rates(masonry.blocks, masonry.lines, 1).toarray()
    assert grip.shape == (3, 6)
    assert np.linalg.matrix_rank(grip) == 3
    assert np.abs(grip @ [0, 0, 1, 0, 0, 0]).max() == 0
    assert np.abs(grip @ [1.0, 0, 0, 0, 1.0, 0]).max() == pytest.approx(0, abs=1e-12)  # turns about the base


def test_points_of_a_joint_slide_in_the_same_directions_on_either_block():
    masonry = mr.Masonry([GROUND, box((1, 1, 1), (0, 0, 0.5)), box((1, 1, 1), (0.75, 0.5, 1.5))])
    lines = masonry.lines
    assert len(set(lines.body[lines.joint == 1].tolist())) == 2
    shift = np.zeros(12)
    shift[6:9] = 0.3, 0.4, 0.0  # the block above slides on the other
    slip = mean_slip_rates(masonry.blocks, lines, 2) @ shift
    assert np.hypot(slip[1], slip[3]) == pytest.approx(0.5)
    assert mean_slip_rates(masonry.blocks, lines, 2)[5] @ np.array([0] * 11 + [2.0]) == pytest.approx(2.0)


def test_a_prism_has_the_frequencies_of_its_section():
    """Those of the plane are among those of space, and the damping ratio refers to the lowest."""

    def rectangle(x, z, b, h, length, fixed, name):
        corners = [(x - b / 2, z), (x + b / 2, z), (x + b / 2, z + h), (x - b / 2, z + h)]
        return mr.Polygon(corners, length=length, fixed=fixed, name=name)

    plane = [
        rectangle(0, -1, 4, 1, 4.0, True, "ground"),
        rectangle(0, 0, 0.6, 2, 0.9, False, "a"),
        rectangle(0.2, 2, 0.4, 0.5, 0.9, False, "b"),
    ]
    masonry = mr.Masonry(plane, k_n=1e8), mr.Masonry([mr.Polyhedron.prism(block) for block in plane], k_n=1e8)
    frequencies = []
    for each in masonry:
        masses, axes = masses_of(each.blocks)
        opening, grip = rates(each.blocks, each.lines, each.lines.normal), mean_slip_rates(each.blocks, each.lines, 2)
        if axes is not None:
            opening, grip = opening @ axes, grip @ axes
        free = null_space(grip.toarray() / np.sqrt(masses))
        opening = opening.toarray() / np.sqrt(masses) @ free
        frequencies.append(np.sqrt(np.linalg.eigvalsh(opening.T @ (each.lines.k[:, None] * opening))))
    assert all(np.abs(frequencies[1] / f - 1).min() < 1e-9 for f in frequencies[0])
    assert len(frequencies[1]) == 6
    assert masonry[1].retardation == pytest.approx(masonry[0].retardation, rel=1e-9)


def test_what_masonry_in_space_refuses():
    blocks = [GROUND, box((1, 1, 1), (0, 0, 0.5))]
    with pytest.raises(TypeError, match=r"blocks\[2\] is a Polygon of the plane, and blocks\[0\]"):
        mr.Masonry([*blocks, mr.Polygon([(0, 0), (1, 0), (0, 1)])])
    with pytest.raises(
        ValueError, match="law: damping by a law is for stacks, where every block stands on one other block"
    ):
        mr.Masonry.facade(1.2, 0.8, 0.4, (0.4, 0.2), law="CALIBRATED")
    beside = mr.Polyhedron.box((0.5, 1.0, 4.0), (-0.55, 0.0, 2.0), fixed=True)
    with pytest.raises(ValueError, match="law: in space it is for stacks that stand free"):
        mr.Masonry([GROUND, box((0.6, 1, 4), (0, 0, 2)), beside], law="CALIBRATED")
    with pytest.raises(ValueError, match="points = 51 is outside the valid range 2 to 50"):
        mr.Masonry(blocks, points=51)
    with pytest.raises(ValueError, match="no two of them touch along a face"):
        mr.Masonry([GROUND, box((1, 1, 1), (0, 0, 3))])
    assert mr.Masonry(blocks).in_space


@pytest.mark.filterwarnings("ignore:the joint")
@pytest.mark.parametrize(("law", "points", "blocks"), [("CALIBRATED", 2, 2), (mr.CALIBRATED_BED, 16, 1)])
def test_the_law_gives_a_stack_in_space_what_it_gives_in_the_plane(law, points, blocks):
    """Blocks of 0.6 m x 2.7 m, 1.3 m long, which rock about their long edges."""
    options = {"friction": 0.7, "law": law, "points": points}
    plane = mr.Masonry.stack([mr.Block.from_size(0.6, 2.7, length=1.3)] * blocks, 1e9, **options)
    space = mr.Masonry([mr.Polyhedron.prism(block) for block in plane.blocks], 1e9, **options)
    assert space.retardation == pytest.approx(plane.retardation, rel=1e-12)
    assert mr.Masonry.box((1.3, 0.6, 2.7 * blocks), k_n=1e9, **options).retardation == pytest.approx(
        plane.retardation[0], rel=1e-12
    )


def test_what_is_of_the_plane_alone_says_so():
    masonry = mr.Masonry([GROUND, box((1, 1, 1), (0, 0, 0.5))])
    with pytest.raises(ValueError, match="masonry in space: rigid_impact takes blocks in the plane"):
        mr.rigid_impact(masonry, np.ones((1, 6)))
    with pytest.raises(ValueError, match="masonry in space: matched_masonry takes blocks in the plane"):
        mr.matched_masonry(masonry)


def cut(block, normal, middle):
    """The two parts of a block on either side of a plane through a point, and the corners of the section."""
    heights = (block.corners - middle) @ normal
    section = []
    for face in block.faces:
        for i, j in zip(face, face[1:] + face[:1], strict=True):
            if i < j and heights[i] * heights[j] < 0:
                share = heights[i] / (heights[i] - heights[j])
                section.append(block.corners[i] + share * (block.corners[j] - block.corners[i]))
    section = np.array(section)
    sides = [np.vstack([block.corners[sign * heights > 0], section]) for sign in (-1, 1)]
    return [mr.Polyhedron(side) for side in sides], section


@pytest.mark.parametrize("seed", range(4))
def test_rubble_cut_from_a_cube_has_joints_of_the_area_of_all_cuts(seed):
    """Each cut adds a section whose area stays that of the joints in it, however often they are divided."""
    rng = np.random.default_rng(seed)
    stones, area = [box((1, 1, 1), (0, 0, 0.5))], 1.0  # that on the ground
    for _ in range(12):
        stone = stones.pop(int(np.argmax([stone.volume for stone in stones])))
        normal = rng.standard_normal(3)
        normal /= np.linalg.norm(normal)
        parts, section = cut(stone, normal, stone.centroid)
        across = np.linalg.svd(normal[None])[2][1:]
        area += convex.area(section_hull(section @ across.T))
        stones += parts
    masonry = mr.Masonry([GROUND, *stones], xi=0)
    assert sum(block.volume for block in masonry.blocks[1:]) == pytest.approx(1.0)
    assert sum(joint.area for joint in masonry.joints) == pytest.approx(area, rel=1e-3)
    pairs = [(joint.below, joint.above) for joint in masonry.joints]
    assert len(set(pairs)) == len(pairs)


def section_hull(points):
    """Corners of the convex hull of points in a plane, counterclockwise."""
    return points[ConvexHull(points).vertices]
