"""Masonry: which joints are found, the lines that they carry, and their damping."""

import math
import warnings

import numpy as np
import pytest
from masonry_blocks import GROUND, box, columns

import mjrock as mr
from mjrock.geometry.frames import frames_of
from mjrock.geometry.kinematics import gap
from mjrock.problem.masonry.blocks import joints
from mjrock.problem.masonry.blocks.joints import neighbours
from mjrock.problem.masonry.lines import rates
from mjrock.scene.masonry import scene_of_masonry

LEFT, RIGHT, TOP = (
    box(-1, 0, 0, 1, name="left"),
    box(0, 1, 0, 1, name="right"),
    box(-0.6, 0.4, 1, 2, name="top", length=0.5),
)


def found(masonry):
    return {joint.name: joint for joint in masonry.joints}


def test_joints_of_a_stack():
    masonry = columns(3)
    assert [joint.name for joint in masonry.joints] == ["ground|block_0", "block_0|block_1", "block_1|block_2"]
    for i, joint in enumerate(masonry.joints):
        assert joint.start == pytest.approx((-0.3, 1.4 * i), abs=1e-12)
        assert joint.end == pytest.approx((0.3, 1.4 * i), abs=1e-12)
        assert joint.normal == pytest.approx([0, 1], abs=1e-12)
        assert joint.is_bed
        assert joint.corners == (True, True)
    assert masonry.names[1:] == ("block_0", "block_1", "block_2")
    assert masonry.free == (1, 2, 3)
    assert masonry.centroids[1:] == pytest.approx(np.array([(0, 0.7), (0, 2.1), (0, 3.5)]))
    assert masonry.joints[1].travel == pytest.approx((0.6, 0.6))


def test_parts_of_edges():
    """The upper block rests on 0.6 m of one and 0.4 m of the other, whose head joint is vertical."""
    joints = found(mr.Masonry([GROUND, LEFT, RIGHT, TOP]))
    assert set(joints) == {"ground|left", "ground|right", "left|right", "left|top", "right|top"}
    assert joints["left|top"].start == pytest.approx((-0.6, 1))
    assert joints["left|top"].end == pytest.approx((0, 1))
    assert joints["right|top"].width == pytest.approx(0.4)
    assert joints["left|top"].area == pytest.approx(0.3)  # as long as the shorter block
    assert joints["left|top"].corners == (True, False)  # the right end is a corner of the block below
    assert joints["right|top"].corners == (False, True)
    assert joints["left|right"].normal == pytest.approx([1, 0], abs=1e-12)
    assert not joints["left|right"].is_bed
    # the upper block leaves the left one after 0.4 m to the left and 0.6 m to the right, and the other way round
    assert joints["left|top"].travel == pytest.approx((1.4, 0.6))
    assert joints["right|top"].travel == pytest.approx((0.4, 1.6))


def test_running_bond():
    """Two courses of 1 m and half a metre: every unit of the upper course rests on two or one of the lower."""
    masonry = mr.Masonry.running_bond(3.0, 1.0, (1.0, 0.5), thickness=0.2)
    joints = found(masonry)
    assert len(masonry.blocks) == 1 + 3 + 4
    beds = [joint for joint in masonry.joints if joint.is_bed]
    assert sum(joint.width for joint in beds) == pytest.approx(6.0)
    assert joints["unit_0_0|unit_1_1"].width == pytest.approx(0.5)
    assert len(masonry.joints) - len(beds) == 2 + 3
    assert sum(masonry.blocks[i].mass for i in masonry.free) == pytest.approx(2000 * 3 * 1 * 0.2)
    cut = mr.Masonry.running_bond(2.7, 0.5, (1.0, 0.5))
    assert {(block.length, block.density) for block in cut.blocks[1:]} == {(1.0, 2000.0)}
    assert [cut.blocks[i].area for i in cut.free] == pytest.approx([0.5, 0.5, 0.35])


def test_an_arch():
    """Radial joints of the full thickness; the normal points to the higher voussoir."""
    masonry = mr.Masonry.arch(5.0, 0.75, math.radians(120), 9)
    assert len(masonry.joints) == 10
    for joint in masonry.joints:
        assert joint.width == pytest.approx(0.75)
        assert np.hypot(*joint.middle) == pytest.approx(5.0)
        assert abs(joint.middle @ joint.normal) < 1e-9
        assert joint.normal[1] > 0
        assert not masonry.blocks[joint.above].fixed
    area = 0.5 * (5.375**2 - 4.625**2) * 9 * math.sin(math.radians(120) / 9)
    assert sum(masonry.blocks[i].area for i in masonry.free) == pytest.approx(area)
    assert masonry.joints[0].name == "left_abutment|voussoir_0"


def test_the_ground_of_an_arch_lies_under_its_abutments_and_is_no_neighbour_of_its_voussoirs():
    plain, masonry = (mr.Masonry.arch(5.0, 0.75, math.radians(120), 9, ground=ground) for ground in (False, True))
    corners = np.concatenate([block.vertices for block in plain.blocks])
    (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    (x, deep), (to, surface) = np.sort(np.array(masonry.blocks[-1].vertices), axis=0)[[0, -1]]
    assert masonry.names == (*plain.names, "ground")
    assert [joint.name for joint in masonry.joints] == [joint.name for joint in plain.joints]
    assert surface == pytest.approx(low)
    assert deep < low
    assert min(left - x, to - right) >= 2 * (high - low)
    with pytest.raises(TypeError, match="ground = 1"):
        mr.Masonry.arch(5.0, 0.75, ground=1)


@pytest.mark.parametrize(("apart", "joints"), [(9e-4, 1), (-9e-4, 1), (1.1e-3, 0)])
def test_the_tolerance(apart, joints):
    blocks = [GROUND, box(0, 1, apart, 1 + apart)]
    if not joints:
        with pytest.raises(ValueError, match="no two of them touch along an edge"):
            mr.Masonry(blocks, tolerance=1e-3)
        return
    (joint,) = mr.Masonry(blocks, tolerance=1e-3).joints
    assert joint.start[1] == pytest.approx(0.5 * apart)  # halfway between the edges


def test_blocks_that_overlap_are_named():
    with pytest.raises(ValueError, match=r"blocks left and other overlap by 0.01 m; .* the tolerance, 1e-05 m"):
        mr.Masonry([GROUND, LEFT, box(-0.01, 1, 0, 1, name="other")])


def test_corners_that_touch_make_no_joint():
    """A joint of zero length carries nothing: a block on its corner, and two blocks corner to corner."""
    on_edge = mr.Polygon([(3, 0), (3.5, 0.5), (3, 1), (2.5, 0.5)], name="on edge")
    masonry = mr.Masonry([GROUND, LEFT, box(0, 1, 1, 2, name="diagonal"), on_edge])
    assert set(found(masonry)) == {"ground|left"}
    with pytest.raises(ValueError, match="cannot stand: diagonal, on edge would fall"):
        mr.simulate(mr.MasonryCase(masonry, 1.0))


@pytest.mark.parametrize("points", [2, 5])
def test_lines_have_the_stiffness_of_their_area(points):
    masonry = mr.Masonry([GROUND, LEFT, RIGHT, TOP], k_n=lambda joint: 1e9 if joint.is_bed else 1e7, points=points)
    lines = masonry.lines
    for number, joint in enumerate(masonry.joints):
        own = lines.joint == number
        k_n = 1e9 if joint.is_bed else 1e7
        assert own.sum() == points
        assert lines.k[own].sum() == pytest.approx(k_n * joint.area)
        assert lines.at[own][[0, -1]] == pytest.approx(np.array([joint.start, joint.end]))
        assert lines.k[own][0] == pytest.approx(k_n * joint.area / (points - 1) / 2)


def test_a_corner_carries_its_point():
    """Where the upper block overhangs, the corner is that of the block below, and its point is on it."""
    masonry = mr.Masonry([GROUND, LEFT, RIGHT, TOP], points=3)
    lines, names = masonry.lines, masonry.names
    number = [joint.name for joint in masonry.joints].index("left|top")
    own = lines.joint == number
    assert [names[i] for i in lines.body[own]] == ["top", "top", "left"]
    assert [names[i] for i in lines.face[own]] == ["left", "left", "top"]
    assert lines.normal[own] == pytest.approx(np.array([(0, 1), (0, 1), (0, -1)]), abs=1e-12)
    # fixed ground that is narrower than the block does not carry points
    narrow = mr.Masonry([box(-0.3, 0.3, -1, 0, fixed=True), box(-0.5, 0.5, 0, 1)])
    assert set(narrow.lines.body.tolist()) == {1}


@pytest.mark.parametrize("points", [2, 3, 5])
@pytest.mark.parametrize("ends", [(-0.3, 0.3), (-0.6, 0.3), (-0.3, 0.6), (-0.6, 0.6)])
def test_either_end_of_a_joint_is_carried_by_the_block_that_has_a_corner_there(points, ends):
    below = box(-0.5, 0.5, 0, 1, name="below")
    masonry = mr.Masonry([GROUND, below, box(*ends, 1, 2, name="above")], points=points)
    own = masonry.lines.joint == [joint.name for joint in masonry.joints].index("below|above")
    carried = [masonry.names[i] for i in masonry.lines.body[own]]
    outer = ["below" if abs(end) > 0.5 else "above" for end in ends]
    assert carried == [outer[0], *["above"] * (points - 2), outer[1]]


def test_rates_of_lines_are_those_of_the_engine():
    masonry = mr.Masonry([GROUND, LEFT, RIGHT, TOP], points=3)
    scene = scene_of_masonry(masonry)
    flat = np.zeros(9)
    mine = {}
    for i in range(len(scene.contacts.k)):
        columns_ = [gap(scene.places, i, frames_of(flat), one, flat).rate for one in np.eye(9)]
        mine[
            scene.contacts.group[i], *np.round(scene.bodies.rest[scene.contacts.body[i]] + scene.contacts.at[i], 9)
        ] = columns_
    opening = rates(masonry.blocks, masonry.lines, masonry.lines.normal).toarray()
    for row, joint, at in zip(opening, masonry.lines.joint, masonry.lines.at, strict=True):
        assert row == pytest.approx(mine[masonry.joints[joint].name, *np.round(at, 9)], abs=1e-12)
    sideways = {tuple(np.round(row, 9)) for row in rates(masonry.blocks, masonry.lines, masonry.lines.along).toarray()}
    assert sideways == {tuple(np.round(row, 9)) for row in scene.potential.slip_rates(flat)[0].toarray()}


def test_the_frequency_of_one_block_is_that_of_a_wall():
    wall = mr.Block(0.3, 2.1)
    for points in (2, 7):
        masonry = mr.Masonry.stack([wall], 5e8, xi=0.05, points=points)
        assert masonry.retardation == pytest.approx([0.1 / mr.reference_frequency(wall, 5e8, points)], rel=1e-12)
    assert columns(2, frequency=40.0, xi=0.2).retardation == pytest.approx([0.01, 0.01])
    assert (columns(2, xi=0.0).retardation == 0).all()


def test_the_lowest_frequency_of_two_blocks():
    """Rocking about the base and about the middle, without slip: two by two, by hand."""
    k_n, b, h = 5e8, 0.3, 1.05
    m, turn = 2000 * 0.6 * 2.1, 2 * k_n * b**3
    inertia = m * (0.6**2 + 2.1**2) / 12
    # rotations of both; the centroids move by h t1, and 2 h t1 + h t2
    mass = np.array([[inertia + 5 * m * h**2, 2 * m * h**2], [2 * m * h**2, inertia + m * h**2]])
    stiffness = turn * np.array([[2, -1], [-1, 1]])
    lowest = np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).min())
    assert columns(2, xi=0.5).retardation == pytest.approx(1 / lowest, rel=1e-9)


@pytest.mark.parametrize("k_s", [None, 3e8])
def test_a_block_between_inclined_faces_vibrates_on_its_joints(k_s):
    """Three faces leave no motion in which none slides. Stiffness of its lines by hand, and along them that of k_s."""
    ground = mr.Polygon([(-3, -1), (3, -1), (3, 0), (-3, 0)], fixed=True)
    wedge = mr.Polygon([(-0.5, 0), (0.5, 0), (1.0, 1.5), (-1.2, 1.5)])
    right = mr.Polygon([(0.5, 0), (2.5, 0), (2.5, 1.5), (1.0, 1.5)], fixed=True)
    left = mr.Polygon([(-0.5, 0), (-1.2, 1.5), (-2.5, 1.5), (-2.5, 0)], fixed=True)
    masonry = mr.Masonry([ground, wedge, right, left], k_n=1e9, k_s=k_s, xi=0.5)
    stiffness = np.zeros((3, 3))
    for joint in masonry.joints:
        ways = [(joint.normal, 1e9), *([] if k_s is None else [(joint.along, k_s)])]
        for end in (joint.start, joint.end):
            x, z = np.subtract(end, wedge.centroid)
            for way, k in ways:
                rate = np.array([*way, z * way[0] - x * way[1]])
                stiffness += 0.5 * joint.area * k * np.outer(rate, rate)
    mass = np.diag([wedge.mass, wedge.mass, wedge.inertia])
    lowest = np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).min())
    assert len(masonry.joints) == 3
    assert masonry.retardation == pytest.approx(1 / lowest, rel=1e-9)
    if k_s:
        assert mr.solve_explicit(mr.MasonryCase(masonry, 0.01)).outcome.name


@pytest.mark.parametrize(("law", "points"), [("CALIBRATED", 2), (mr.CALIBRATED_BED, 16)])
def test_the_law_gives_the_single_wall_its_numbers(law, points):
    wall = mr.Block(0.3, 2.1, length=1.7, density=1900.0)
    contacts = mr.Contacts.from_law(wall, mr.Restitution.from_geometry(wall), 5e8, law=law, points=points)
    masonry = mr.Masonry.stack([wall], 5e8, law=law, points=points)
    assert masonry.lines.k == pytest.approx(contacts.base.stiffness, rel=1e-12)
    assert masonry.retardation == pytest.approx([contacts.base.retardation], rel=1e-12)


def test_the_law_takes_what_is_above_a_joint_as_one_wall():
    with warnings.catch_warnings(action="ignore"):
        upper = mr.Block(0.3, 1.05)
        contacts = mr.Contacts.from_law(upper, mr.Restitution.from_geometry(upper), 5e8, law=mr.CALIBRATED)
        whole = mr.Contacts.from_law(
            mr.Block(0.3, 2.1), mr.Restitution.from_geometry(mr.Block(0.3, 2.1)), 5e8, law=mr.CALIBRATED
        )
        found = columns(2, law="calibrated").retardation
    assert found == pytest.approx([whole.base.retardation, contacts.base.retardation], rel=1e-12)


def test_what_the_law_warns_of_has_the_name_of_the_joint():
    with pytest.warns(UserWarning, match=r"the joint block_0\|block_1: CALIBRATED: outside the range"):
        columns(2, law=mr.CALIBRATED)


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: mr.Masonry([]), "blocks = 0 free and 0 fixed; at least one of each"),
        (lambda: mr.Masonry([LEFT]), "blocks = 1 free and 0 fixed; at least one of each"),
        (lambda: mr.Masonry([GROUND, LEFT, box(2, 3, 0, 1, name="left")]), "2 of them have the name left"),
        (lambda: mr.Masonry([GROUND, LEFT], k_n=1e3), "k_n = 1000 N/m3 is outside the valid range"),
        (lambda: mr.Masonry([GROUND, LEFT], k_n=1.1e14), "k_n = 1.1e.14 N/m3 is outside the valid range"),
        (lambda: mr.Masonry([GROUND, LEFT], friction=lambda joint: -1), r"friction of ground\|left = -1 is outside"),
        (lambda: mr.Masonry([GROUND, LEFT], xi=len), "xi = .* is not called as xi"),
        (lambda: mr.Masonry([GROUND, LEFT], frequency=9.0, law="CALIBRATED"), "frequency = 9 rad/s is given with a la"),
        (lambda: mr.Masonry([GROUND, LEFT, RIGHT, TOP], law=mr.CALIBRATED), "law: damping by a law is for stacks"),
        (lambda: mr.Masonry.arch(5, 0.75, law=mr.CALIBRATED), "law: damping by a law is for stacks"),
        (lambda: mr.Masonry([GROUND, LEFT], law="mine"), "law = 'mine' is not one of"),
        (lambda: mr.Masonry.stack([mr.Block(0.3, 2.1, inset=0.1)], 5e8), r"inset = 0.1 m; .* give Masonry a Polygon"),
        (
            lambda: mr.Masonry.stack([mr.Block(0.3, 2.1, openings=(mr.Opening(0.5, 1.0),))], 5e8),
            r"blocks\[0\] has openings, .* cut it at sills and heads into blocks .* or take the Block in a Case",
        ),
        (lambda: mr.Masonry.arch(5.0, 6.0), "thickness = 6 m is outside the valid range 0.005 to 5 m"),
        (lambda: mr.Masonry.running_bond(2, 1, (0.5, 0.3)), "height = 1 m is not a whole number of units of 0.3 m"),
        (lambda: mr.MasonryCase(columns(1), 1.0, velocity=[[0, 0]]), r"velocity has the shape \(1, 2\); \(1, 3\)"),
        (lambda: mr.MasonryCase(columns(1), 1.0, velocity=[[0, 0, 2e3]]), "velocity = 2000 m/s or rad/s is outside"),
        (lambda: mr.simulate(mr.MasonryCase(columns(1), 1.0), columns(1)), "contacts = .*: masonry has its joints"),
    ],
)
def test_what_cannot_be_is_refused(make, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        make()


def test_the_lowest_block_may_be_the_ground():
    masonry = mr.Masonry.stack([mr.Block(0.3, 1.0)] * 2, 5e8, ground=False)
    assert len(masonry.blocks) == 2
    assert masonry.free == (1,)


@pytest.mark.parametrize("upright", [True, False])
def test_neighbours_are_the_pairs_whose_boxes_touch(upright):
    rng, blocks = np.random.default_rng(4), [box(-9, 9, -9, 9, name="ground", fixed=True)]
    for i in range(60):
        low, size = rng.uniform((0, 0), (3, 20) if upright else (20, 3)), rng.uniform(0.1, 2, 2)
        blocks.append(box(low[0], low[0] + size[0], low[1], low[1] + size[1], name=f"b{i}", fixed=i % 7 == 0))
    ends = [(block.corners.min(axis=0) - 1e-3, block.corners.max(axis=0) + 1e-3) for block in blocks]
    wanted = [
        [i, j]
        for i in range(len(blocks))
        for j in range(i + 1, len(blocks))
        if (ends[i][0] <= ends[j][1]).all() and (ends[j][0] <= ends[i][1]).all()
        if not (blocks[i].fixed and blocks[j].fixed)
    ]
    assert neighbours(blocks, 1e-3).tolist() == wanted


def test_joints_of_many_pairs_are_those_of_a_few(monkeypatch):
    blocks = mr.Masonry.running_bond(3.2, 1.5, (0.5, 0.25)).blocks
    every = mr.Masonry(blocks).joints
    monkeypatch.setattr(joints, "TOGETHER", 7)
    assert mr.Masonry(blocks).joints == every
    with pytest.raises(ValueError, match=r"unit_1_0 and extra overlap by 0\.15 m"):
        mr.Masonry([*blocks, box(0.1, 0.3, 0.3, 0.5, name="extra")])
