"""What masonry can be made as in space: blocks and joints are counted, sizes are closed forms."""

import itertools
import math
import warnings
from collections import Counter

import numpy as np
import pytest
from everyday import slow

import mjrock as mr
from mjrock.problem.masonry.limit.statics import falling

UNIT = (0.4, 0.2)


@pytest.mark.parametrize(
    "masonry",
    [
        mr.Masonry.box((0.4, 0.6, 2.0)),
        mr.Masonry.column(0.5, 4.0, 2),
        mr.Masonry.dome(2.0, 0.3, 4, 2),
        mr.Masonry.facade(1.2, 0.8, 0.4, (0.4, 0.2), gable=1),
        mr.Masonry.running_bond(1.0, 2.0, (0.5, 0.25)),
        mr.Masonry.stack([mr.Block(0.3, 2.0), mr.Block(0.3, 1.0)], 1e9),
    ],
    ids=["box", "column", "dome", "facade", "bond", "stack"],
)
def test_the_ground_reaches_two_heights_beyond(masonry):
    """What falls over lies on it."""
    ground = masonry.blocks[0].corners
    above = np.concatenate([masonry.blocks[i].corners for i in masonry.free])
    beyond = np.minimum(above.min(axis=0) - ground.min(axis=0), ground.max(axis=0) - above.max(axis=0))[:-1]
    assert beyond.min() >= 2 * np.ptp(above[:, -1]) - 1e-9
    assert ground[:, -1].max() == pytest.approx(above[:, -1].min(), abs=1e-12)


def test_a_box():
    masonry = mr.Masonry.box((0.6, 0.4, 2.0), k_n=1e8)
    (joint,) = masonry.joints
    assert (joint.name, joint.area, joint.width) == ("ground|block", pytest.approx(0.24), pytest.approx(0.4))
    assert masonry.centroids[1] == pytest.approx([0, 0, 1])
    assert masonry.in_space


@pytest.mark.parametrize("sides", [3, 4, 12])
def test_a_column_of_drums(sides):
    masonry = mr.Masonry.column(1.0, 6.0, 3, sides=sides, xi=0)
    assert [joint.name for joint in masonry.joints] == ["ground|drum_0", "drum_0|drum_1", "drum_1|drum_2"]
    area = sides * math.tan(math.pi / sides) / 4
    assert [joint.area for joint in masonry.joints] == pytest.approx(3 * [area])
    assert [block.mass for block in masonry.blocks[1:]] == pytest.approx(3 * [2000 * area * 2])
    assert masonry.joints[0].width == pytest.approx({3: 1.5, 4: 1.0, 12: 1.0}[sides])


@pytest.mark.parametrize("slender", [0.01, 100.0])
def test_the_flattest_and_the_longest_drums_keep_all_their_sides(slender):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mr.Implausible)
        column = mr.Masonry.column(1.0, 3 * slender, 3, sides=100, xi=0)
    assert [len(drum.faces) for drum in column.blocks[1:]] == 3 * [102]
    assert [len(joint.outline) for joint in column.joints] == 3 * [100]
    with pytest.raises(ValueError, match=r"height is .* m for 3 drums .*; the valid range is \[0.01, 100\]"):
        mr.Masonry.column(1.0, 3.03 * slender if slender > 1 else 2.97 * slender, 3)


def test_ground_under_a_mast_is_a_body():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mr.Implausible)
        masts = mr.Masonry.column(1.0, 625.0, 10), mr.Masonry.running_bond(1.0, 900.0, (0.5, 1.0))
    for mast in masts:
        wide, *_, deep = np.ptp(mast.blocks[0].corners, axis=0)
        assert deep == pytest.approx(1e-3 * wide)


def test_a_square_column_overturns_about_its_side_and_a_round_one_in_any_direction():
    square, round_one = (mr.Masonry.column(0.5, 5.0, 2, sides=sides, xi=0) for sides in (4, 48))
    assert mr.collapse_multiplier(square, angle=0.0).multiplier == pytest.approx(0.1)
    for angle in (0.0, 0.4):
        assert mr.collapse_multiplier(round_one, angle=angle).multiplier == pytest.approx(0.1, rel=0.003)


def test_a_dome_has_two_joints_a_voussoir():
    masonry = mr.Masonry.dome(5.0, 0.5, 8, 4, xi=0)
    assert len(masonry.blocks) == 1 + 8 * 4
    assert Counter(len(joint.outline) for joint in masonry.joints) == {4: 2 * 8 * 4}
    assert sum(masonry.blocks[joint.below].fixed for joint in masonry.joints) == 8
    volume, cubes = sum(block.volume for block in masonry.blocks[1:]), 5.25**3 - 4.75**3
    assert volume == pytest.approx(2 * math.pi / 3 * cubes, rel=0.14)
    thick = mr.Masonry.dome(5.0, 1.0, 8, 4, xi=0)  # all corners lie on two spheres
    assert sum(block.volume for block in thick.blocks[1:]) / volume == pytest.approx((5.5**3 - 4.5**3) / cubes)
    heights = masonry.centroids[:, 2]
    assert (np.diff(heights[1:].reshape(4, 8).mean(axis=1)) > 0).all()


def boxes_that_touch(masonry):
    """Joints between axis-parallel boxes, counted from their bounds alone."""
    low = np.array([block.corners.min(axis=0) for block in masonry.blocks])
    high = np.array([block.corners.max(axis=0) for block in masonry.blocks])
    count = 0
    for i in range(len(low)):
        common = np.minimum(high[i], high[:i]) - np.maximum(low[i], low[:i])
        touches, overlaps = (np.abs(common) < 1e-9).sum(axis=1), (common > 1e-6).sum(axis=1)
        count += int(((touches == 1) & (overlaps == 2)).sum())
    return count


def test_a_facade_with_return_walls():
    """Courses of 6 and 5 units between walls of 3: 12 and 11 blocks, and 8 of each other course."""
    masonry = mr.Masonry.facade(2.4, 1.6, 1.2, UNIT, xi=0)
    assert len(masonry.free) == 4 * 12 + 4 * 11
    assert len(masonry.joints) == boxes_that_touch(masonry) == 250
    assert sum(masonry.blocks[i].volume for i in masonry.free) == pytest.approx(1.6 * (2.4 * 0.2 + 2 * 1.0 * 0.2))
    corners = [joint for joint in masonry.joints if not joint.is_bed and abs(joint.normal[0]) > 0.9]
    assert len(corners) == 8 * 2 * 3 - 4 * 2  # across the return walls, and behind the facade in every other course
    assert masonry.blocks[1:][0].corners[:, 0].max() == 0.0


def bounds(masonry):
    """Lowest and highest corner of each block that is not fixed, shape (n, 2, 3)."""
    return np.array([(block.corners.min(axis=0), block.corners.max(axis=0)) for block in masonry.blocks[1:]])


SIZES = [
    slow(((2.4, 1.6, 1.2, UNIT), {})),
    slow(((7.0, 3.0, 3.0, (1.2, 0.6)), {"thickness": 0.8})),
    slow(((3.1, 1.1, 1.4, (0.4, 0.2)), {"thickness": 0.35})),
    slow(((4.0, 1.5, 2.0, (0.5, 0.25)), {"thickness": 0.7, "returns": "left"})),
    ((4.3, 1.6, 0.0, (0.5, 0.25)), {"thickness": 0.3, "returns": "none"}),
    ((3.3, 1.5, 1.5, (0.5, 0.25)), {"returns": "right"}),
]


@pytest.mark.parametrize(("size", "options"), SIZES)
def test_units_are_made_to_fit_and_lie_in_bond(size, options):
    """The measures are those asked for, no head joint stands on another, and headers lie in every second course."""
    length, height, depth, (long, _) = size
    masonry = mr.Masonry.facade(*size, **options, xi=0)
    t, ends = options.get("thickness", 0.5 * long), {"both": 2, "none": 0}.get(options.get("returns", "both"), 1)
    low, top = bounds(masonry).transpose(1, 0, 2)
    assert low[:, 1].min() == pytest.approx(-0.5 * length)
    np.testing.assert_allclose(top.max(axis=0), [0.0, 0.5 * length, height], atol=1e-12)
    assert low[:, 0].min() == pytest.approx(-depth if ends else -t)
    expected = height * t * (length + ends * (depth - t))
    assert sum(block.mass for block in masonry.blocks[1:]) == pytest.approx(2000.0 * expected, rel=1e-12)
    assert len(masonry.joints) == boxes_that_touch(masonry)
    for wall, along in (("facade", 1), ("left", 0), ("right", 0)):
        courses = {}
        for name, first, last in zip(masonry.names[1:], low, top, strict=True):
            if name.startswith(wall):
                courses.setdefault(round(first[2], 9), []).append((first[along], last[along]))
        heads = [np.unique([head for block in courses[z] for head in block]) for z in sorted(courses)]
        for below, above in itertools.pairwise(heads):
            free = [head for head in above[1:-1] if below[0] < head < below[-1]]
            assert np.abs(np.subtract.outer(free, below)).min() > 0.2 * long
    assert falling(masonry) == ()


def test_openings_anywhere_cut_units():
    """A portal off the middle and a window whose edges lie on no joint: exact mass, no loose unit, at rest."""
    portal, window = (0.3, mr.Opening(1.5, 2.5)), (-0.2, mr.Opening(1.1, 0.9, sill=3.7))
    length, height, depth, t, unit = 6.4, 5.4, 3.0, 0.8, 4.8 / 4
    options = {"thickness": t, "gable": 2, "openings": [portal, window]}
    masonry = mr.Masonry.facade(length, height, depth, (1.3, 0.6), **options, friction=0.6, k_n=1e9, xi=0.05)
    low, top = bounds(masonry).transpose(1, 0, 2)
    assert len(masonry.joints) == boxes_that_touch(masonry)
    gable = t * 0.6 * sum(length - 2 * t - (k - 1) * unit for k in (1, 2))
    assert np.prod((top - low)[low[:, 2] > height - 0.01], axis=1).sum() == pytest.approx(gable)
    walls = height * t * (length + 2 * (depth - t)) - t * (1.5 * 2.5 + 1.1 * 0.9)
    assert sum(block.mass for block in masonry.blocks[1:]) == pytest.approx(2000.0 * (walls + gable), rel=1e-12)
    y, z = np.meshgrid(np.linspace(-3.141, 3.143, 64), np.linspace(0.051, 5.353, 54))
    covered = sum(
        ((a[1] < y) & (y < b[1]) & (a[2] < z) & (z < b[2])).astype(int)
        for a, b in zip(low, top, strict=True)
        if b[0] > -0.01
    )
    for middle, hole in (portal, window):
        inside = (abs(y - middle) < 0.5 * hole.width) & (hole.sill < z) & (z < hole.head)
        assert not covered[inside].any()
        covered[inside] = 1
    assert set(np.unique(covered)) == {1}
    assert falling(masonry) == ()


@pytest.mark.slow
def test_a_facade_whose_units_are_cut_stands_at_rest():
    openings = [(0.3, mr.Opening(1.5, 2.5)), (-0.2, mr.Opening(1.1, 0.9, sill=3.7))]
    joints = {"friction": 0.6, "k_n": 1e9, "xi": 0.05}
    masonry = mr.Masonry.facade(6.4, 5.4, 3.0, (1.3, 0.6), thickness=0.8, gable=2, openings=openings, **joints)
    settled = mr.solve_explicit(mr.MasonryCase(masonry, duration=0.05))
    assert not settled.fallen
    np.testing.assert_allclose(settled.pose[-1], settled.pose[0], atol=1e-7)


def test_corners_may_be_bonded_in_part():
    """Joints between facade and return walls are known by their names: less friction there, less is borne outwards."""

    def at_corners(joint):
        one, other = (name.split("_")[0] for name in joint.name.split("|"))
        return 0.1 if {one, other} in ({"facade", "left"}, {"facade", "right"}) else 0.7

    borne = []
    for friction in (0.7, at_corners):
        masonry = mr.Masonry.facade(1.6, 0.8, 1.2, UNIT, xi=0, friction=friction)
        borne.append(mr.collapse_multiplier(masonry, angle=0.0).multiplier)
    assert borne[1] < 0.85 * borne[0]


def test_the_ground_may_be_given():
    slab = mr.Polyhedron.box((3.0, 3.0, 0.3), (-0.5, 0.0, -0.15), fixed=True, name="slab")
    masonry = mr.Masonry.facade(1.6, 0.8, 0.8, UNIT, ground=slab, xi=0)
    assert masonry.names[0] == "slab"
    assert falling(masonry) == ()


def test_openings_have_lintels_and_a_gable_narrows():
    door, window = (0.0, mr.Opening(0.8, 0.8)), (-1.2, mr.Opening(0.4, 0.4, sill=0.4))
    masonry = mr.Masonry.facade(4.0, 1.2, 0.8, UNIT, openings=[door, window], gable=2, xi=0)
    assert len(masonry.joints) == boxes_that_touch(masonry)
    lintels = [
        block for block in masonry.blocks if block.name.startswith("facade") and np.ptp(block.corners[:, 1]) > 0.41
    ]
    assert sorted(round(float(np.ptp(block.corners[:, 1])), 9) for block in lintels) == [0.8, 1.2]
    walls = 1.2 * (4.0 * 0.2 + 2 * 0.6 * 0.2) - 0.2 * (0.64 + 0.16)
    gable = 0.2 * 0.2 * (4.0 + 3.6)
    assert sum(masonry.blocks[i].volume for i in masonry.free) == pytest.approx(walls + gable)
    assert falling(masonry) == ()
    to_the_point = mr.Masonry.facade(1.2, 0.6, 0.8, UNIT, gable=2, xi=0)
    assert to_the_point.centroids[:, 2].max() == pytest.approx(0.9)


def facade(*openings, **options):
    arguments = {"length": 4.0, "height": 1.2, "depth": 0.8, "unit": UNIT, "xi": 0} | options
    return mr.Masonry.facade(**arguments, openings=openings)


@pytest.mark.parametrize("apart", [(0.8, 0.0), (0.0, 0.6)], ids=["side by side", "one above the other"])
@pytest.mark.parametrize("turned", [False, True])
def test_lintels_may_just_touch(apart, turned):
    """Openings of a unit and two courses: lintels end a half unit beside them and a course above."""
    y, sill = apart
    pair = (0.0, mr.Opening(0.4, 0.4, 0.2)), (y, mr.Opening(0.4, 0.4, 0.2 + sill))
    made = mr.Masonry.facade(4.0, 2.4, 0.8, UNIT, openings=pair[::-1] if turned else pair, xi=0)
    lengths = Counter(round(float(np.ptp(block.corners[:, 1])), 9) for block in made.blocks)
    assert lengths[0.8] == 2  # the lintels
    nearer = (y and y - 0.2, mr.Opening(0.4, 0.4, 0.2 + (sill and sill - 0.2)))
    with pytest.raises(ValueError, match="or the lintels over them, overlap"):
        mr.Masonry.facade(4.0, 2.4, 0.8, UNIT, openings=[pair[0], nearer], xi=0)


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: facade(length=0.4), "length = 0.4 m is outside the valid range 0.8 to 1000 m"),
        (lambda: facade(height=0.1), "height = 0.1 m is outside the valid range 0.2 to 1000 m"),
        (lambda: facade(depth=0.3), "depth = 0.3 m is outside the valid range 0.4 to 1000 m"),
        (lambda: facade(thickness=0.0), "thickness = 0 m is outside the valid range 0.01 to 10 m"),
        (lambda: facade(returns="front"), "returns = 'front' is not one of both, left, right, none"),
        (lambda: facade(ground=1.0), "ground = 1.0 of type float is not a Polyhedron"),
        (lambda: facade(length=900.0, height=100.0), "need more units than 25000"),
        (lambda: facade((math.nan, mr.Opening(0.4, 0.4))), r"openings\[0\], y = nan"),
        (lambda: facade((2e5, mr.Opening(0.4, 0.4))), r"openings\[0\], y = 200000 m is outside the valid range"),
        (lambda: facade(gable=11), "gable = 11 is outside the valid range 0 to 10"),
        (lambda: facade(unit=(0.4,)), "unit = .* is not the length and the height"),
        (lambda: facade((0.0, mr.Opening(0.4, 0.41))), r"leave a piece of 0.2 x 0.01 m at y = -0.4 m in course 2"),
        (lambda: facade((0.0, mr.Opening(0.4, 0.4, round=True))), r"openings\[0\] is round"),
        (lambda: facade((1.6, mr.Opening(0.4, 0.4))), r"openings\[0\] with its lintel reaches from y = 1.2 to 2 m; "),
        (lambda: facade((0.0, mr.Opening(0.4, 1.2))), "no course above it"),
        (lambda: facade((0.0, mr.Opening(0.4, 0.4)), (0.6, mr.Opening(0.4, 0.4))), r"openings\[1\] and openings\[0\]"),
        (
            lambda: facade((0.0, mr.Opening(1.2, 0.4, 2.2)), gable=9),
            r"the valid range in course 13 is -0.\d+ to 0.\d+ m",
        ),
        (lambda: facade(mr.Opening(0.4, 0.4)), r"openings\[0\] = .* is not \(y, Opening\)"),
        (lambda: mr.Masonry.column(1.0, 6.0, 0), "drums = 0 is outside the valid range 1 to 1000"),
        (lambda: mr.Masonry.column(1.0, 6.0, 1, sides=2), "sides = 2"),
        (lambda: mr.Masonry.dome(5.0, 6.0, 8, 4), "thickness = 6 m is outside the valid range 0.005 to 5 m"),
        (lambda: mr.Masonry.dome(5.0, 0.5, 3, 4), "lunes = 3 is outside the valid range 4 to 360"),
        (lambda: mr.Masonry.dome(5.0, 0.5, 360, 70), "lunes = 360 times hoops = 70"),
        (lambda: mr.Masonry.dome(5.0, 0.5, 8, 4, oculus=2.0), "oculus = 2 rad"),
        (lambda: mr.Masonry.box((1, 1)), r"size has the shape \(2,\)"),
    ],
)
def test_what_cannot_be_built_is_refused_by_name(make, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        make()
