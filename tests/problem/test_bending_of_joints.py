"""Stiffness of closed joints: k_n times the area along the normal, and more than k_n I in bending."""

from dataclasses import replace

import numpy as np
import pytest

import mjrock as mr

BOXES = ((2.0, -1.0), (0.3, 0.0), (0.3, 1.0), (0.3, 2.0))
"""Half the width of a block, and the height of its lower edge [m]."""


def bending(masonry, joint=0):
    """Rotational stiffness of a closed joint about its middle, over k_n I of a strip [-]."""
    lines = masonry.lines
    own = (lines.joint == joint) & (lines.body == masonry.joints[joint].above)
    x, k = lines.at[own][:, 0], lines.k[own]
    x = x - x.mean()
    return float(k @ x**2) / (float(k.sum()) * np.ptp(x) ** 2 / 12)


@pytest.mark.parametrize(("points", "over"), [(2, 3.0), (3, 1.5), (5, 1.125), (9, 1 + 2 / 64)])
def test_a_closed_joint_of_few_lines_is_stiffer_in_bending_than_its_face(points, over):
    """n lines with their tributary lengths give 1 + 2 / (n - 1)^2 times k_n I, in the plane and in space."""
    plane = mr.Masonry.stack([mr.Block.from_size(thickness=0.6, height=1.0)] * 2, 1e9, points=points)
    space = mr.Masonry.box((0.6, 0.9, 1.0), k_n=1e9, points=points)
    assert over == 1 + 2 / (points - 1) ** 2
    assert bending(plane) == pytest.approx(over)
    assert bending(space) == pytest.approx(over)


@pytest.mark.parametrize("in_space", [False, True])
def test_joints_of_one_masonry_may_have_unlike_points(in_space):
    """Each joint has the lines, and the stiffness, that it has where all joints have as many."""
    given = {"ground": 2, "drum_0|drum_1": 3, "drum_1|drum_2": 5}

    def points(joint):
        return next(count for name, count in given.items() if joint.name.startswith(name))

    def built(**joints):
        if in_space:
            return mr.Masonry.column(0.6, 3.0, 3, **joints)
        boxes = [mr.Polygon([(-x, z), (x, z), (x, z + 1), (-x, z + 1)], fixed=z < 0) for x, z in BOXES]
        names = ["ground", "drum_0", "drum_1", "drum_2"]
        return mr.Masonry([replace(box, name=name) for box, name in zip(boxes, names, strict=True)], **joints)

    mixed = built(joints=lambda joint: mr.Dry(1e9, points=points(joint)))
    assert mixed.table.points.tolist() == [2, 3, 5]
    assert "points of the joint" in repr(mixed)
    assert built(k_n=1e9, points=points).table.points.tolist() == [2, 3, 5]
    assert built(points=lambda joint: 3) == built(points=3)
    for number, count in enumerate(given.values()):
        alike, own = built(k_n=1e9, points=count).lines, mixed.lines
        assert bending(mixed, number) == pytest.approx(1 + 2 / (count - 1) ** 2)
        for name in ("at", "k", "body"):
            given_, wanted = (getattr(each, name)[each.joint == number] for each in (own, alike))
            np.testing.assert_array_equal(given_, wanted)


BOND = mr.Bond(0.1e6, 0.1e6, 10.0, 100.0)


@pytest.mark.parametrize("points", [3, 4, 5, 9])
def test_a_bonded_joint_has_the_stiffness_of_its_face_in_bending(points):
    """By closed form, k_n I to rounding, in the plane and both ways in space; its area and its middle stay."""
    ground = mr.Polygon([(-1, -1), (1, -1), (1, 0), (-1, 0)], fixed=True)
    wall = mr.Polygon([(-0.3, 0), (0.3, 0), (0.3, 1), (-0.3, 1)])
    options = {"k_n": 1e9, "k_s": 1e9, "points": points, "bond": BOND}
    plane, space = mr.Masonry([ground, wall], **options), mr.Masonry.box((0.6, 0.9, 1.0), **options)
    assert bending(plane) == pytest.approx(1.0, rel=1e-12)
    assert plane.lines.k.sum() == pytest.approx(1e9 * 0.6)
    at, k = space.lines.at, space.lines.k
    assert k @ at[:, :2] ** 2 == pytest.approx(1e9 * np.array([0.9 * 0.6**3, 0.6 * 0.9**3]) / 12, rel=1e-12)
    assert k @ at[:, 0] == pytest.approx(0.0, abs=1e-3)
    assert len(k) == points**2


def test_two_lines_do_not_make_a_bonded_joint():
    given = {"k_n": 1e9, "k_s": 1e9, "bond": BOND}
    with pytest.raises(ValueError, match=r"points = 2, and ground\|block has a bond: .* the valid range is 3 or more"):
        mr.Masonry.box((0.6, 0.9, 1.0), **given)
    dry = mr.Masonry.box((0.6, 0.9, 1.0), **given | {"bond": lambda joint: None})
    assert bending(dry) == pytest.approx(3.0)


def test_a_triangle_on_its_three_corners_is_four_times_as_stiff():
    masonry = mr.Masonry.column(0.6, 0.8, 1, sides=3, k_n=1e9)
    lines = masonry.lines
    own = lines.body == masonry.joints[0].above
    at, k = lines.at[own][:, :2], lines.k[own]
    at = at - at.mean(axis=0)
    edges = np.roll(at, -1, axis=0) - at
    side = float(np.linalg.norm(edges, axis=1).mean())
    second_moment = side**4 * np.sqrt(3) / 96
    assert k.sum() == pytest.approx(1e9 * side**2 * np.sqrt(3) / 4)
    assert float(k @ at[:, 0] ** 2) == pytest.approx(4 * 1e9 * second_moment)
    assert float(k @ at[:, 1] ** 2) == pytest.approx(4 * 1e9 * second_moment)
