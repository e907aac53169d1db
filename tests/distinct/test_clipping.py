"""Where a face lies over another one, one function at a time, against plane geometry."""

import math

import numpy as np
import pytest
from by_hand import columns
from scipy.spatial.transform import Rotation

import mjrock as mr
from mjrock.distinct.search import clipping
from mjrock.distinct.search.solids import Solids
from mjrock.rows import rows

UP, DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
LOWER = mr.Polyhedron.box((2.0, 2.0, 1.0), (0.0, 0.0, -0.5))
"""Its upper face lies at z = 0, 1 m about the origin."""


def turned(size, place, turn=None):
    """A block whose lower face has its middle at a place, after a turn about it."""
    box = mr.Polyhedron.box(size, (0.0, 0.0, 0.5 * size[2]))
    corners = np.array(box.corners)
    return mr.Polyhedron((corners if turn is None else turn.apply(corners)) + place)


def solids_about(*blocks):
    """Blocks where they are drawn."""
    outer = [np.zeros(len(block.faces), dtype=bool) for block in blocks]
    return Solids.about(blocks, np.zeros((len(blocks), 3)), outer, np.arange(len(blocks)))


def face_of(solids, block, way):
    """The face of a block with a normal, and its corners, shape (n, 3)."""
    face = clipping.face_towards(solids, block, tuple(way))
    around = range(solids.first[face], solids.first[face + 1])
    return face, np.array([clipping.corner_of(solids, i) for i in around])


def polygon_in(corners, count=12):
    """Room for the corners of a polygon that is written there."""
    polygon = np.full((count, 3), np.nan)
    polygon[: len(corners)] = np.reshape(corners, (-1, 3))
    return polygon


def same_polygons(found, expected):
    """Whether the corners of two polygons are the same, from any of them on."""
    assert len(found) == len(expected)
    start = int(np.linalg.norm(np.asarray(expected) - found[0], axis=1).argmin())
    np.testing.assert_allclose(found, np.roll(expected, -start, axis=0), atol=1e-12)


def test_corners_follow_each_other_around_a_face():
    solids = solids_about(LOWER, turned((1.0, 3.0, 0.5), (0.0, 0.0, 0.0)))
    for block, size in ((0, (2.0, 2.0)), (1, (1.0, 3.0))):
        face, corners = face_of(solids, block, UP)
        np.testing.assert_allclose(np.ptp(corners, axis=0), [*size, 0.0])
        following = [clipping.next_corner(solids, face, int(solids.first[face]) + i) for i in range(4)]
        np.testing.assert_array_equal(following, np.roll(corners, -1, axis=0))
        assert clipping.normal_of(solids, face) == pytest.approx(UP)


def test_the_face_towards_a_direction_has_the_nearest_normal():
    solids = solids_about(LOWER, LOWER)
    for way in [*np.eye(3), *-np.eye(3), (0.5, -0.6, 0.55)]:
        for block in range(2):
            face = clipping.face_towards(solids, block, tuple(way))
            assert solids.face[block] <= face < solids.face[block + 1]
            normal = np.zeros(3)
            axis = int(np.abs(way).argmax())
            normal[axis] = np.sign(way[axis])
            np.testing.assert_allclose(clipping.normal_of(solids, face), normal, atol=1e-15)
    both = [clipping.face_towards(solids, 0, way) for way in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))]
    assert clipping.face_towards(solids, 0, (1.0, 1.0, 0.0)) == min(both)  # of two that are as near the first one


@pytest.mark.parametrize(("size", "side"), [((2, 2, 1), 1.0), ((2, 2, 2), -1.0)])
@pytest.mark.parametrize("off", [-1e-12, 0.0, 1e-12])
def test_rounding_does_not_decide_between_faces_that_are_as_near(size, side, off):
    """Of two the larger one is taken, and of two that are as large the one that looks up."""
    solids = solids_about(turned(size, (0.0, 0.0, 0.0)))
    face = clipping.face_towards(solids, 0, (np.sqrt(0.5) * side + off, 0.0, np.sqrt(0.5)))
    np.testing.assert_allclose(clipping.normal_of(solids, face), UP, atol=1e-15)


SQUARE = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.0, 2.0, 0.0), (0.0, 2.0, 0.0)]


@pytest.mark.parametrize(
    ("reach", "expected"),
    [
        (3.0, SQUARE),
        (2.0, SQUARE),
        (0.5, [(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (0.5, 2.0, 0.0), (0.0, 2.0, 0.0)]),
        (-1.0, []),
    ],
)
def test_a_polygon_is_cut_to_where_it_reaches(reach, expected):
    polygon = polygon_in(SQUARE)
    left = clipping.cut(polygon, 4, (1.0, 0.0, 0.0), reach, 0.0, polygon_in([]))
    np.testing.assert_allclose(polygon[:left], np.reshape(expected, (-1, 3)))


def test_a_corner_within_the_slack_of_an_edge_counts_as_on_it():
    """And the sides that go on beyond are cut at their end, not before or behind it."""
    for corners in (
        [(0.05, 0.0, 0.0), (0.2, 1.0, 0.0), (-1.0, 1.0, 0.0)],
        [(-1.0, 1.0, 0.0), (0.2, 1.0, 0.0), (0.05, 0.0, 0.0)],
    ):
        polygon = polygon_in(corners)
        left = clipping.cut(polygon, 3, (1.0, 0.0, 0.0), 0.0, 0.1, polygon_in([]))
        expected = [(0.05, 0.0, 0.0), (0.05, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 1.0, 0.0)]
        np.testing.assert_allclose(sorted(map(tuple, polygon[:left])), sorted(expected), atol=1e-15)


@pytest.mark.parametrize(
    ("place", "low", "high"),
    [
        ((1.0, 0.4), (0.5, -0.1), (1.0, 0.9)),
        ((-1.0, -1.0), (-1.0, -1.0), (-0.5, -0.5)),
        ((0.2, 0.1), (-0.3, -0.4), (0.7, 0.6)),
    ],
)
def test_the_part_of_a_face_that_lies_over_another(place, low, high):
    solids = solids_about(LOWER, turned((1.0, 1.0, 1.0), (*place, -0.01)))
    face, over, room = face_of(solids, 0, UP)[0], face_of(solids, 1, DOWN)[0], polygon_in([], 24)
    count = clipping.common_area(solids, face, over, room)
    x, y, z = (low[0], high[0]), (low[1], high[1]), -0.01
    corners = [(x[0], y[0], z), (x[0], y[1], z), (x[1], y[1], z), (x[1], y[0], z)]
    same_polygons(room[:count], corners)


@pytest.mark.parametrize(("beyond", "left"), [(0.5e-9, 1.0), (1.5e-9, 0.0)])
@pytest.mark.parametrize("size", [1.0, 0.125])
def test_a_corner_that_is_hardly_beyond_an_edge_stays_there(beyond, left, size):
    """By a thousand millionth of the length of the edges."""
    lower = mr.Polyhedron.box((2.0 * size, 2.0 * size, 1.0), (0.0, 0.0, -0.5))
    solids = solids_about(lower, turned((size, size, 1.0), ((0.5 + 2.0 * beyond) * size, 0.0, 0.0)))
    room = polygon_in([], 24)
    count = clipping.common_area(solids, face_of(solids, 0, UP)[0], face_of(solids, 1, DOWN)[0], room)
    assert room[:count, 0].max() / size - 1.0 == pytest.approx(left * 2.0 * beyond, abs=4e-16)


def test_corners_that_fall_on_those_before_them_are_left_out():
    a, b, c = (1.0, 2.0, 2.0), (2.0, 1.0, 2.0), (2.0, 2.0, 1.0)
    near = [(1.0 + far * 3e-9, 2.0, 2.0) for far in (0.9, 1.4)]
    for corners, left in (
        ([a, b, c], [a, b, c]),
        ([a, b, b, c, c, c], [a, b, c]),
        ([a, b, c, a], [b, c, a]),
        ([b, a, near[0], c], [b, a, c]),
        ([b, a, near[1], c], [b, a, near[1], c]),
    ):
        polygon = polygon_in(corners)
        count = clipping.without_duplicates(polygon, len(corners), 3e-9)
        np.testing.assert_array_equal(polygon[:count], left)


def test_the_area_of_a_polygon_in_space():
    around = [(math.cos(a), math.sin(a), 0.0) for a in 0.3 + 2 * math.pi * np.arange(5) / 5]
    turn = Rotation.from_rotvec([0.4, -0.7, 0.2])
    polygon = polygon_in(turn.apply(around) + np.array([3.0, -2.0, 1.0]))
    assert clipping.area_of(polygon, 5) == pytest.approx(2.5 * math.sin(2 * math.pi / 5))
    assert clipping.area_of(polygon_in(SQUARE[:3]), 3) == pytest.approx(2.0)


def test_the_distance_of_a_place_from_a_line():
    assert clipping.distance_from((1.0, 5.0, 3.0), (1.0, 2.0, -1.0), (0.0, 7.0, 0.0)) == pytest.approx(4.0)


def test_a_place_is_halfway_between_the_two_surfaces():
    table = rows(clipping.PLACE, 3)
    clipping.write_place(table[1], (4, 2), (1.0, 2.0, 3.0), (0.6, 0.0, 0.8), -0.02)
    table = columns(table)
    np.testing.assert_allclose(table[1], [4, 2, 1.006, 2.0, 3.008, 0.6, 0.0, 0.8, -0.02, 0, 0])
    assert not table[[0, 2]].any()


def clipped(*blocks, first=0, size=16, face=0):
    """Places of a block that lies over the upper face of another one."""
    solids = solids_about(*blocks)
    table, room = rows(clipping.PLACE, size), polygon_in([], 24)
    upper = face_of(solids, face, UP)[0]
    count = clipping.clip(solids, upper, (face, 1 - face), clipping.Workspace(table, room), first)
    return columns(table), count


@pytest.mark.parametrize("size", [(1.0, 0.2, 0.3), (0.2, 1.0, 0.3)])
def test_a_corner_and_its_mirror_image_are_found_alike(size):
    """Both are beyond an edge by more of the short sides beside them than counts as one place, and less of the long
    ones. Around a face a long side comes after one of them, and a short one after the other."""
    turn = Rotation.from_rotvec([0.0, 1e-3, 0.0])
    table, count = clipped(LOWER, turned(size, (1.0 + 5e-7 - 0.5 * size[0], 0.0, 0.0), turn))
    at_edge = table[:count][np.abs(table[:count, 2] - 1.0) < 1e-3]
    np.testing.assert_allclose(sorted(at_edge[:, 3]), np.array([-0.5, 0.5]) * size[1], rtol=1e-12)
    np.testing.assert_array_equal(at_edge[0, :2], at_edge[1, :2])
    np.testing.assert_allclose(at_edge[0, 5:8], at_edge[1, 5:8] * [1, -1, 1], atol=1e-15)


def sorted_by_place(table):
    return table[np.lexsort(np.round(table[:, 2:5], 9).T)]


@pytest.mark.parametrize("face", [0, 1])
def test_places_of_a_block_that_lies_flat_over_a_corner_of_another(face):
    """A corner of the upper one, a corner of the lower one on its face, and two places where edges cross."""
    blocks = [LOWER, turned((1.0, 1.2, 1.0), (1.0, 1.0, -0.01))]
    table, count = clipped(*blocks[:: 1 - 2 * face], face=face)
    assert count == 4
    x, y = [0.5, 1.0], [0.4, 1.0]
    expected = [
        [face, 1 - face, x[0], y[0], -0.005, *UP],
        [face, 1 - face, x[1], y[0], -0.005, *UP],
        [face, 1 - face, x[0], y[1], -0.005, *UP],
        [1 - face, face, x[1], y[1], -0.005, *DOWN],
    ]
    found = table[:count]
    found = found[np.lexsort((np.round(found[:, 2], 9), np.round(found[:, 3], 9)))]
    np.testing.assert_allclose(found[:, :8], expected, atol=1e-12)
    np.testing.assert_allclose(found[:, 8:], np.tile([-0.01, 0.25, 0.3], (4, 1)), rtol=1e-10)


def test_a_place_stands_for_the_angle_by_which_the_outline_turns():
    """An octagon from two squares; and a block beside another one, over which nothing lies."""
    table, count = clipped(LOWER, turned((2.0, 2.0, 1.0), (0.0, 0.0, 0.01), Rotation.from_rotvec([0, 0, math.pi / 4])))
    assert count == 8
    np.testing.assert_allclose(table[:8, 9], 0.125, rtol=1e-10)
    np.testing.assert_allclose(table[:8, 10], 8 * math.tan(math.pi / 8), rtol=1e-10)
    assert clipped(LOWER, turned((1.0, 1.0, 1.0), (1.6, 0.0, 0.0)))[1] == 0


def test_a_corner_of_a_block_lies_over_an_edge_of_another():
    """The part is a triangle: three eighths of a turn at each side of the corner, and a quarter there."""
    turn = Rotation.from_rotvec([0.0, 0.0, math.pi / 4])
    table, count = clipped(LOWER, turned((1.0, 1.0, 1.0), (1.0 + math.sqrt(0.5) - 0.2, 0.0, 0.01), turn))
    assert count == 3
    np.testing.assert_allclose(np.sort(table[:3, 9]), [0.25, 0.375, 0.375], rtol=1e-9)
    np.testing.assert_allclose(table[:3, 10], 0.04, rtol=1e-9)


def test_places_are_written_after_others_where_there_is_room():
    block = turned((1.0, 1.0, 1.0), (0.0, 0.0, -0.01))
    whole, count = clipped(LOWER, block)
    table, last = clipped(LOWER, block, first=3, size=5)
    assert (count, last) == (4, 7)
    np.testing.assert_array_equal(table[3:], whole[:2])
    assert not table[:3].any()


def test_places_of_a_block_that_is_tilted():
    """Corners of it have their own heights; a corner below has its distance from the tilted face, out of that one; and
    edges that cross their distance along the normal of both."""
    turn = Rotation.from_rotvec([0.05, -0.03, 0.4])
    middle = np.array([0.9, 0.8, -0.02])
    table, count = clipped(LOWER, turned((1.0, 1.2, 1.0), middle, turn))
    corners = turn.apply([(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.6, 0.6)]) + middle
    down, kinds = turn.apply(DOWN), []
    for row in table[:count]:
        normal, gap = row[5:8], row[8]
        above, below = row[2:5] + 0.5 * gap * normal, row[2:5] - 0.5 * gap * normal
        if row[0] == 1:
            kinds.append("below")
            np.testing.assert_allclose(normal, down, atol=1e-12)
            np.testing.assert_allclose(above, [1.0, 1.0, 0.0], atol=1e-12)
            assert down @ (below - middle) == pytest.approx(0.0, abs=1e-12)
        elif np.abs(corners - above).max(axis=1).min() < 1e-9:
            kinds.append("above")
            np.testing.assert_allclose(normal, UP, atol=1e-12)
            assert below[2] == pytest.approx(0.0, abs=1e-12)
        else:
            kinds.append("edges")
            assert down @ (above - middle) == pytest.approx(0.0, abs=1e-12)
            edge = np.eye(3)[1 if abs(above[0] - 1.0) < 1e-9 else 0]
            assert np.abs(above[:2]).max() == pytest.approx(1.0, abs=1e-12)
            assert normal @ edge == pytest.approx(0.0, abs=1e-12)
            own = turn.inv().apply(above - middle)
            along = turn.apply(np.eye(3)[1 if abs(abs(own[0]) - 0.5) < 1e-9 else 0])
            assert normal @ along == pytest.approx(0.0, abs=1e-12)
            assert normal[2] > 0
            np.testing.assert_allclose(np.linalg.norm(normal), 1.0)
            assert gap == pytest.approx(normal @ (above - [1.0, 1.0, 0.0]), abs=1e-13)
    assert sorted(kinds) == ["above", "below", "edges", "edges"]


def met(block, at, over=DOWN):
    """What a place of the face of a block over the lower one is."""
    solids, table = solids_about(LOWER, block), rows(clipping.PLACE, 1)
    faces = face_of(solids, 0, UP)[0], face_of(solids, 1, over)[0]
    clipping.write_corner(solids, faces, (0, 1), tuple(at), table[0])
    return columns(table)[0]


def crossing(turn):
    """The middle of an edge of a block, 0.3 above the edge of the lower one, where edges cross."""
    at = np.array([0.2, 1.0, 0.3])
    block = turned((1.0, 2.0, 1.0), at + turn.apply([0.5, 0.0, 0.0]), turn)
    return met(block, at, turn.apply(DOWN)), turn.apply([0.0, 1.0, 0.0])


@pytest.mark.parametrize(("degrees", "meet"), [(71.0, True), (74.0, False)])
def test_edges_meet_along_the_normal_of_both_unless_that_is_far_from_upright(degrees, meet):
    """One edge lies along x, and the other one rises. The cosine of 72.5 degrees is 0.3."""
    row, along = crossing(Rotation.from_rotvec([math.radians(degrees), 0.0, 0.0]))
    normal = np.cross([1.0, 0.0, 0.0], along) if meet else np.array(UP)
    np.testing.assert_allclose(row[5:8], normal, atol=1e-12)
    assert row[8] == pytest.approx(0.3 * normal[2])
    np.testing.assert_allclose(row[2:5], np.array([0.2, 1.0, 0.3]) - 0.15 * normal[2] * normal, atol=1e-12)


@pytest.mark.parametrize(("sine", "meet"), [(0.9e-4, False), (1.1e-4, True)])
def test_edges_that_are_hardly_across_each_other_do_not_meet(sine, meet):
    """One lies along x, and the other one turns away from it and rises by as little."""
    turn = Rotation.from_rotvec([0.0, 0.0, -math.pi / 2]) * Rotation.from_rotvec([0.6 * sine, 0.0, 0.8 * sine])
    row, _ = crossing(turn)
    expected = [0.0, -0.6, 0.8] if meet else UP
    np.testing.assert_allclose(row[5:8], expected, atol=1e-3)


@pytest.mark.parametrize(("off", "corner"), [(0.9e-6, True), (1.1e-6, False)])
def test_a_place_that_is_nearly_at_a_corner_is_that_corner(off, corner):
    """Within a millionth of an edge: of 0.5 m, of the upper block, and of 2 m, of the lower one. Otherwise edges cross
    there, and meet along the normal of both."""
    turn = Rotation.from_rotvec([0.1, 0.0, 0.0])
    start = np.array([0.0, 0.9, -0.01])
    upper = turned((0.5, 0.5, 1.0), start - turn.apply([0.25, 0.25, 0.0]), turn)
    row = met(upper, start - turn.apply([0.0, 0.5 * off, 0.0]), turn.apply(DOWN))
    np.testing.assert_allclose(row[5:8], UP if corner else turn.apply(UP), atol=1e-12)
    beside = turned((3.0, 3.0, 1.0), (0.0, 0.0, -0.01), turn)
    row = met(beside, (1.0 - 2.0 * off, 1.0, -0.01 + math.tan(0.1)), turn.apply(DOWN))
    assert (row[0] == 1) == corner
    if corner:
        np.testing.assert_allclose(row[2:5] + 0.5 * row[8] * row[5:8], [1.0, 1.0, 0.0], atol=1e-12)
