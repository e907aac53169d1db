"""Where blocks meet, one function at a time, and how it is decided whether they meet as faces or as edges."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from by_hand import columns, stood
from masonry_blocks import box
from scipy.spatial.transform import Rotation

import mjrock as mr
from mjrock.distinct.search import finder
from mjrock.distinct.search.clipping import PLACE, Workspace
from mjrock.distinct.search.finder import ContactPlaces, Finder, Near
from mjrock.distinct.search.solids import Poses, Solids
from mjrock.rows import rows

BOX = mr.Polyhedron.box
LOWER, UPPER = BOX((2.0, 3.0, 1.0), (0.0, 0.0, -0.5)), BOX((1.0, 0.5, 0.4), (0.2, 0.1, 0.2))
"""Two boxes that touch at z = 0."""


def solids_about(*blocks, inside=()):
    """Blocks where they are drawn, some of their faces inside, by block and number."""
    outer = [np.zeros(len(block.faces), dtype=bool) for block in blocks]
    for block, face in inside:
        outer[block][face] = True
    return Solids.about(blocks, np.zeros((len(blocks), 3)), outer, np.arange(len(blocks)))


def moved(block, by, turn=None):
    corners = np.array(block.corners)
    return mr.Polyhedron((corners if turn is None else turn.apply(corners)) + np.array(by))


def face_of(solids, block, way):
    return finder.face_towards(solids, block, tuple(map(float, way)))


@pytest.mark.parametrize("values", [[], [4], [1, 4], [1, 4, 9], [1, 4, 9, 12, 13, 20]])
def test_a_number_is_looked_for_among_increasing_ones(values):
    for number in range(-1, 23):
        where = values.index(number) if number in values else -1
        assert finder.index_of(np.array(values, dtype=np.int64), number) == where


@pytest.mark.parametrize("axis", range(3))
def test_blocks_are_apart_along_an_axis(axis):
    for low, apart in ((0.9, False), (1.0, False), (1.1, True)):
        at = np.zeros(3)
        at[axis] = low
        near = Near(np.array([np.zeros(3), at]), np.array([np.ones(3), at + 1]), *[None] * 7)
        assert bool(finder.bounds_separated(near, 0, 1)) is bool(finder.bounds_separated(near, 1, 0)) is apart


def test_how_far_a_block_is_outside_of_a_face_and_reaches():
    solids = solids_about(moved(LOWER, (0.3, 0.0, 0.0)), moved(UPPER, (0.0, 0.0, 0.25)))
    for way, reaches in (((1.0, 0.0, 0.0), 1.3), ((0.0, 0.0, 1.0), 0.0), ((0.0, -2.0, 0.0), 3.0)):
        assert finder.farthest_along(solids, 0, way) == pytest.approx(reaches)
    assert finder.distance_outside(solids, face_of(solids, 0, (0, 0, 1)), 1) == pytest.approx(0.25)
    assert finder.distance_outside(solids, face_of(solids, 1, (0, 0, -1)), 0) == pytest.approx(0.25)
    assert finder.distance_outside(solids, face_of(solids, 0, (1, 0, 0)), 1) == pytest.approx(-1.6)
    assert solids.extent[face_of(solids, 0, (0, 0, 1))] == pytest.approx(10.0)
    assert solids.extent[face_of(solids, 1, (0, 1, 0))] == pytest.approx(2.8)
    assert finder.height(solids, face_of(solids, 0, (1, 0, 0)), (1.5, 9.0, 9.0)) == pytest.approx(0.2)
    assert finder.height(solids, face_of(solids, 1, (0, 0, -1)), (1.5, 9.0, 0.15)) == pytest.approx(0.1)
    assert finder.lies_in(solids, 0, (1.2, 0.0, -0.1), 0.0)
    assert not finder.lies_in(solids, 0, (1.4, 0.0, -0.1), 0.0)
    assert finder.lies_in(solids, 0, (1.4, 0.0, -0.1), 0.11)
    assert not finder.lies_in(solids, 1, (0.2, 0.1, 0.2), 0.0)


def test_the_face_that_another_block_is_farthest_outside_of():
    for by, way, apart in (
        ((0, 0, 0.25), (0, 0, 1), 0.25),
        ((0, 0, -0.1), (0, 0, 1), -0.1),
        ((1.2, 0, -0.2), (1, 0, 0), -0.1),
    ):
        solids = solids_about(LOWER, moved(UPPER, by))
        face, most = finder.separating_face(solids, 0, 1, 1.0)
        assert (face, most) == (face_of(solids, 0, way), pytest.approx(apart))
    solids = solids_about(LOWER, moved(UPPER, (9.0, 9.0, 9.0)))  # the first face that is far enough will do
    face, most = finder.separating_face(solids, 0, 1, 0.5)
    assert face == min(face_of(solids, 0, way) for way in np.eye(3))
    assert most > 5
    cube = BOX((1.0, 1.0, 1.0), (0.0, 0.0, 0.0))
    solids = solids_about(cube, moved(cube, (0.5, 0.5, 0.5)))  # of three that are as far the first one
    face, most = finder.separating_face(solids, 0, 1, 1.0)
    assert face == min(face_of(solids, 0, way) for way in np.eye(3))
    assert most == pytest.approx(-0.5)


@pytest.mark.parametrize(("height", "apart"), [(0.25, math.inf), (0.0, math.inf), (-0.1, -0.6)])
def test_nothing_meets_a_face_inside_its_block(height, apart):
    """What is outside of it counts as far, and is nearest to another face otherwise."""
    top = face_of(solids_about(LOWER), 0, (0, 0, 1))
    solids = solids_about(LOWER, moved(UPPER, (0.8 if apart < 0 else 0.0, 0.0, height)), inside=[(0, top)])
    face, most = finder.separating_face(solids, 0, 1, 1.0)
    assert most == (apart if math.isinf(apart) else pytest.approx(-0.5))
    assert (face == top) is math.isinf(apart)
    every = solids_about(LOWER, moved(UPPER, (0.0, 0.0, -0.3)), inside=[(0, i) for i in range(6)])
    assert finder.separating_face(every, 0, 1, 1.0) == (-1, -math.inf)


ROOF = [(x, y, z) for x in (-1.0, 1.0) for y, z in ((0.0, 0.0), (0.5, -0.5), (-0.5, -0.5))]
"""A ridge along x."""
KEEL = [(x, y, z) for y in (-0.8, 0.8) for x, z in ((0.0, 0.0), (0.6, 0.6), (-0.6, 0.6))]
"""A keel along y."""


@pytest.mark.parametrize("gap", [-0.01, 0.02])
def test_edges_that_cross_are_apart_along_the_direction_across_both(gap):
    """A ridge along x and a keel above it that is turned from y."""
    turn = Rotation.from_rotvec([0.0, 0.0, 0.3])
    blocks = mr.Polyhedron(ROOF), moved(mr.Polyhedron(KEEL), (0.2, 0.1, gap), turn)
    for order, up in ((1, 1.0), (-1, -1.0)):
        solids = solids_about(*blocks[::order])
        way, apart = finder.edge_separation(solids, 0, 1)
        np.testing.assert_allclose(way, [0.0, 0.0, up], atol=1e-12)
        assert apart == pytest.approx(gap, abs=1e-12)
        end, along = finder.edge_towards(solids, 0, way)
        expected = [1.0, 0.0, 0.0] if up > 0 else turn.apply([0.0, 1.0, 0.0])
        assert (
            abs(np.dot(along, expected))
            == pytest.approx(np.linalg.norm(along))
            == pytest.approx(2.0 if up > 0 else 1.6)
        )
        assert end[2] == pytest.approx(0.0 if up > 0 else gap)
        table = rows(PLACE, 3)
        assert finder.write_edges(solids, (0, 1), way, apart, table, 1) == 2
        table = columns(table)
        y, x = 0.0, 0.2 + 0.1 * math.tan(0.3)  # where the keel passes over the ridge
        np.testing.assert_allclose(table[1], [0, 1, x, y, 0.5 * gap, *way, gap, 0.25, 0.0], atol=1e-12)
        assert not table[[0, 2]].any()
        table = rows(PLACE, 1)
        assert finder.write_edges(solids, (0, 1), way, apart, table, 1) == 2
        assert not columns(table).any()


@pytest.mark.parametrize(("sine", "across"), [(0.9e-3, False), (1.5e-3, True)])
def test_edges_that_are_nearly_parallel_have_no_direction_across_both(sine, across):
    solids = solids_about(LOWER, UPPER)._replace(
        edges=np.array([[1.0, 0.0, 0.0], [math.sqrt(1 - sine**2), sine, 0.0]]), edge=np.array([0, 1, 2])
    )
    assert np.isfinite(finder.edge_separation(solids, 0, 1)[1]) == across


def test_the_first_of_edges_that_reach_as_far_is_taken():
    solids = solids_about(LOWER)
    top = face_of(solids, 0, (0, 0, 1))
    end, along = finder.edge_towards(solids, 0, (0.0, 1.0, 1.0))
    np.testing.assert_allclose([end[1:], np.add(end, along)[1:]], [[1.5, 0.0]] * 2)
    faces = min(top, face_of(solids, 0, (0, 1, 0)))
    corners = [finder.corner_of(solids, i) for i in range(solids.first[faces], solids.first[faces + 1])]
    following = corners[(corners.index(end) + 1) % 4]
    np.testing.assert_allclose(np.add(end, along), following)


def test_the_deepest_of_places_counts():
    table = rows(PLACE, 6)
    table["gap"] = [-9.0, -0.1, -0.3, -0.3, -8.0, 7.0]
    assert [finder.deepest(table, *ends) for ends in ((1, 4), (1, 6), (5, 6), (2, 2))] == [2, 4, 5, -1]


def test_the_face_along_which_blocks_are_least_deep(monkeypatch):
    """Of those of either block that the other one is outside of by more than some number, which do not lie inside. The
    first one stays unless another is less deep by three tenths."""
    solids = solids_about(LOWER, UPPER, inside=[(1, 5)])
    depth = {0: -0.5, 2: -0.1, 3: -0.02, 7: -0.3, 8: -0.01, 11: -0.001}
    out = {2: -0.4, 3: -0.9, 7: -0.5, 8: -0.6, 11: 0.0}
    requested = []

    def clip(_, face, blocks, work, count):
        requested.append((face, blocks))
        if depth[face] is None:
            return count
        work.places[count].at, work.places[count].gap = 0.0, depth[face]
        return count + 1

    monkeypatch.setattr(finder, "clip", clip)
    monkeypatch.setattr(finder, "distance_outside", lambda _, face, other: out.get(face, -2.0))
    monkeypatch.setattr(finder, "lies_in", lambda _, block, at, slack: True)
    monkeypatch.setattr(finder, "height", lambda _, face, at: heights.get(face, 0.0))
    work, heights = Workspace(rows(PLACE, 3), None), {}
    for least, expected, more in (
        (-0.3, (0, (0, 1), -0.5), []),
        (-0.45, (2, (0, 1), -0.1), [(2, (0, 1))]),
        (-0.55, (2, (0, 1), -0.1), [(2, (0, 1)), (7, (1, 0))]),
        (-0.6, (2, (0, 1), -0.1), [(2, (0, 1)), (7, (1, 0))]),
        (-0.7, (8, (1, 0), -0.01), [(2, (0, 1)), (7, (1, 0)), (8, (1, 0))]),
    ):
        requested.clear()
        assert finder.shallowest(solids, 0, (0, 1), least, work, 1) == expected
        assert requested == [(0, (0, 1)), *more]
    depth[8] = depth[2]  # of two that are as deep the first one
    assert finder.shallowest(solids, 0, (0, 1), -0.7, work, 1) == (2, (0, 1), -0.1)
    requested.clear()  # from a face of the other block
    assert finder.shallowest(solids, 7, (1, 0), -0.45, work, 1) == (2, (0, 1), -0.1)
    assert requested == [(7, (1, 0)), (2, (0, 1))]
    for deep, taken in ((-0.36, 0), (-0.34, 2)):
        depth[2] = deep
        assert finder.shallowest(solids, 0, (0, 1), -0.45, work, 1) == (taken, (0, 1), depth[taken])
    depth[2] = -0.1
    for above, taken in ((-0.09, 2), (-0.11, 0)):  # the deepest place of the first face lies so deep below this one
        heights[2] = above
        assert finder.shallowest(solids, 0, (0, 1), -0.45, work, 1)[0] == taken
    monkeypatch.setattr(finder, "lies_in", lambda _, block, at, slack: block != 1)  # that place is not common to both
    assert finder.shallowest(solids, 0, (0, 1), -0.45, work, 1)[0] == 2
    for gap, taken in ((-0.001, 2), (0.0, 0), (0.001, 0)):  # places that are open
        depth[2] = gap
        assert finder.shallowest(solids, 0, (0, 1), -0.45, work, 1)[0] == taken
    depth[0], depth[2] = None, 0.001
    assert finder.shallowest(solids, 0, (0, 1), -0.45, work, 1) == (2, (0, 1), 0.001)
    depth[2] = None
    assert finder.shallowest(solids, 0, (0, 1), -0.45, work, 1) == (0, (0, 1), -math.inf)


def decided(
    monkeypatch,
    apart,
    *,
    reach=0.01,
    outlines=(6.0, 4.0),
    faces=(0, 6),
    gap=-0.2,
    cosine=-1.0,
    across=-1.0,
    rows=11,
    clipped=1,
):
    """How two blocks meet whose faces and edges are so far apart: as edges or along which face, and how deep another
    face may lie that comes into question."""
    sought, met = [], []

    def shallowest(_, face, blocks, least, *rest):
        sought.append(least)
        return face, blocks, gap

    normals = {faces[0]: (1.0, 0.0, 0.0), faces[1]: (1.0, 0.0, 0.0), 99: (cosine, math.sqrt(1 - cosine**2), 0.0)}
    for name, what in {
        "separating_face": lambda _, block, other, far: (faces[block], apart[block]),
        "shallowest": shallowest,
        "face_towards": lambda _, block, way: 99 if way[0] < 0 else None,
        "normal_of": lambda _, face: normals[face],
        "edge_separation": lambda _, a, b: ((0.0, 0.0, 1.0), across),
        "write_edges": lambda _, blocks, way, far, table, count: ("edges", blocks, way, far),
        "with_whole_sides": lambda solids: solids,
        "clip": lambda _, face, blocks, work, count: met.append(("faces", face, blocks)) or count + clipped,
        "write_near_corner": lambda _, face, blocks, gap, table, count: (
            met.append(("passes", face, blocks, gap)) or count + 1
        ),
    }.items():
        monkeypatch.setattr(finder, name, what)
    solids = SimpleNamespace(extent=dict(zip(faces, outlines, strict=True)))
    count = finder.find_pair(solids, reach, (0, 1), (1, 1), Workspace(range(rows), range(4)), 7)
    return met[-1] if met else count, *sought


def test_blocks_that_are_farther_than_they_reach_do_not_meet(monkeypatch):
    one, other = ("faces", 0, (0, 1)), ("faces", 6, (1, 0))
    assert decided(monkeypatch, (0.005, 0.001)) == (one,)
    assert decided(monkeypatch, (0.01, 0.001)) == (one,)
    assert decided(monkeypatch, (0.001, 0.01)) == (other,)
    assert decided(monkeypatch, (0.02, 0.001)) == decided(monkeypatch, (0.001, 0.02)) == (7,)
    assert decided(monkeypatch, (0.001, -math.inf), faces=(0, -1)) == (7,)  # all of its faces lie inside
    assert decided(monkeypatch, (-math.inf, 0.001), faces=(-1, 0)) == (7,)
    assert decided(monkeypatch, (0.001, 0.005), faces=(6, 0)) == (("faces", 0, (1, 0)),)


@pytest.mark.parametrize("gap", [0.005, -0.1])
def test_blocks_that_are_near_and_do_not_lie_over_each_other_pass_by(monkeypatch, gap):
    assert decided(monkeypatch, (gap, -0.3), clipped=0)[0] == ("passes", 0, (0, 1), gap)


@pytest.mark.parametrize("turn", [None, *range(8)])
def test_prisms_whose_ends_lie_in_one_plane_meet_along_the_face_of_their_joint(turn):
    """One lies on a side of the other with 0.9 mm of overlap at an end and 0.04 mm at the other one, beside a side that
    is inclined by 9 degrees to it, over which it has 0.04 mm alone. The deepest place is on both ends of both."""
    slope = math.atan(2 / 9)
    along, up = np.array([math.cos(slope), math.sin(slope)]), np.array([-math.sin(slope), math.cos(slope)])
    lower = mr.Polygon([(0.0, 0.0), (1.0, 0.0), (1.0, 0.5), (0.1, 0.3), (0.0, 0.26)])
    low, high = ((0.1, 0.3) + at * along - deep * up for at, deep in ((-0.01, 4e-5), (0.9, 9e-4)))
    blocks = [lower, mr.Polygon([low, high, high + 0.3 * up, low + 0.3 * up])]
    if turn is None:
        normal, solids = up, blocks
    else:
        spun = Rotation.random(random_state=turn)
        normal = spun.apply((up[0], 0.0, up[1]))
        solids = [moved(mr.Polyhedron.prism(block), (0.0, 0.0, 0.0), spun) for block in blocks]
    _, places = found(solids, reach=0.01)
    assert places.gap.min() == pytest.approx(-9e-4, rel=1e-3)
    assert np.abs(places.normal @ normal).min() > 0.999


@pytest.mark.parametrize("in_space", [False, True])
def test_two_corners_that_come_together_are_found_without_a_share(in_space):
    """Squares that stand on their corners side by side, of which no side lies over one of the other."""
    turn = np.array([[1.0, -1.0], [1.0, 1.0]]) / math.sqrt(2)
    blocks = [mr.Polygon(np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) @ turn.T + at) for at in ((0, 0), (1.45, 0.0))]
    blocks = [mr.Polyhedron.prism(block) for block in blocks] if in_space else blocks
    pairs, places = found(blocks, reach=0.02)
    assert pairs == [(0, 1)]
    np.testing.assert_array_equal((places.share, places.area), np.zeros((2, 1)))
    np.testing.assert_allclose(
        places.gap, (1.45 - math.sqrt(2)) / math.sqrt(2), rtol=1e-9
    )  # along the normal of a side


def test_without_room_for_the_most_places_of_a_pair_none_is_written(monkeypatch):
    for apart in ((0.005, 0.001), (-0.1, -0.3)):
        assert decided(monkeypatch, apart, rows=10) == (11,)
        assert decided(monkeypatch, apart, rows=11)[0] == ("faces", 0, (0, 1))


def test_of_faces_that_are_as_far_apart_the_larger_one_is_taken(monkeypatch):
    """By a millionth of how much longer its outline is, 3 m."""
    one, other, apart = ("faces", 0, (0, 1)), ("faces", 6, (1, 0)), 0.001
    for outlines, by, taken in (
        ((4.0, 4.0), 0.0, one),
        ((7.0, 4.0), 0.0, one),
        ((4.0, 7.0), 0.0, other),
        ((7.0, 4.0), 2.5e-6, one),
        ((7.0, 4.0), 3.5e-6, other),
        ((4.0, 7.0), -2.5e-6, other),
        ((4.0, 7.0), -3.5e-6, one),
    ):
        assert decided(monkeypatch, (apart, apart + by), outlines=outlines) == (taken,)
    for by in (1e-10, -1e-10):  # rounding decides nothing
        assert decided(monkeypatch, (apart, apart + by), outlines=(4.0, 4.0)) == (one,)


def test_fixed_blocks_come_first_then_the_largest_and_then_the_lowest():
    fixed, volumes = [False, False, True, False, False, False], np.array([1.0, 1.0, 0.1, 2.0, 1.0, 1.0])
    heights = np.array([0.5, 0.2, 5.0, 3.0, 0.2, 0.2])
    expected = [5, 2, 0, 1, 3, 4]
    assert finder.ranked(np.array(fixed), volumes, heights, 0.5).tolist() == expected
    for seed in range(5):  # rounding decides nothing
        off = 1e-12 * np.random.default_rng(seed).normal(size=(2, 6))
        assert finder.ranked(np.array(fixed), volumes * (1 + off[0]), heights + off[1], 0.5).tolist() == expected


def test_places_do_not_depend_on_the_numbers_of_blocks_nor_on_what_is_far_away():
    """Boxes that are turned anyhow on a table, and two bars of which one lies on the other, edge on edge: pairs, their
    order, and which has the normal."""
    rng = np.random.default_rng(3)
    table = mr.Polyhedron.box((3.0, 3.0, 0.2), (0.0, 0.0, -0.1), fixed=True, name="table")
    boxes = []
    for i, size in enumerate(rng.uniform(0.3, 0.6, 8)):
        place = (0.4 * (i % 3) - 0.4, 0.4 * (i // 3) - 0.4, 0.3)
        corners = moved(BOX((size, size, size)), place, Rotation.random(random_state=i)).corners
        boxes.append(mr.Polyhedron(np.array(corners), name=f"box_{i}"))
    for i, (way, high) in enumerate((("x", 5.0), ("y", 5.0 + 0.2 * math.sqrt(2) - 1e-3))):
        lengths = (2.0, 0.2, 0.2) if way == "x" else (0.2, 2.0, 0.2)
        corners = moved(BOX(lengths), (9.0, 0.0, high), Rotation.from_euler(way, 45, degrees=True)).corners
        boxes.append(mr.Polyhedron(np.array(corners), name=f"bar_{i}"))
    blocks, far = [table, *boxes], mr.Polyhedron.box((1.0, 1.0, 1.0), (0.0, 0.0, 90.0), fixed=True, name="far")

    def index_of(chosen):
        _, places = found(chosen, reach=0.01)
        names = [chosen[i].name for i in places.face], [chosen[i].name for i in places.other]
        return list(zip(*names, strict=True)), places

    names, places = index_of(blocks)
    assert [name for name, area in zip(names, places.area, strict=True) if area == 0] == [("bar_0", "bar_1")]
    assert len(set(names)) > 8
    for others in ([far, *blocks], blocks[::-1], [blocks[i] for i in (4, 2, 10, 8, 0, 6, 1, 9, 7, 3, 5)]):
        again, where = index_of(others)
        assert again == names
        for name in ("place", "normal", "gap", "share", "area"):
            np.testing.assert_array_equal(getattr(where, name), getattr(places, name))


def test_faces_that_come_into_question_are_deeper_by_a_share_of_the_smaller_outline(monkeypatch):
    assert decided(monkeypatch, (-0.1, -0.3)) == (("faces", 0, (0, 1)), pytest.approx(-0.1 - 0.06 * 4.0))
    assert decided(monkeypatch, (-0.3, -0.1)) == (("faces", 6, (1, 0)), pytest.approx(-0.1 - 0.06 * 4.0))
    turned = decided(monkeypatch, (-0.3, -0.1), outlines=(4.0, 6.0))
    assert turned == (("faces", 6, (1, 0)), pytest.approx(-0.1 - 0.06 * 4.0))
    assert decided(monkeypatch, (0.0, 0.0)) == (("faces", 0, (0, 1)),)
    assert decided(monkeypatch, (0.005, 0.0)) == (("faces", 0, (0, 1)),)


@pytest.mark.parametrize(
    ("options", "edges"),
    [
        ({"cosine": -0.71, "across": -0.1}, False),
        ({"cosine": -0.69, "across": -0.1}, True),
        ({"cosine": -0.69, "across": -0.159}, True),
        ({"cosine": -0.69, "across": -0.161}, False),
        ({"cosine": -1.0, "gap": -math.inf, "across": -9.0}, True),
        ({"cosine": 0.5, "across": 0.009}, True),
        ({"cosine": 0.5, "across": 0.01}, None),
        ({"cosine": 0.5, "across": 0.011}, None),
    ],
)
def test_blocks_that_overlap_meet_as_edges_where_these_are_much_less_deep(monkeypatch, options, edges):
    """By a fifth; and not where their faces are nearly flush."""
    met, _ = decided(monkeypatch, (-0.3, -0.1), **options)
    expected = {None: 7, False: ("faces", 6, (1, 0)), True: ("edges", (0, 1), (0.0, 0.0, 1.0), options["across"])}
    assert met == expected[edges]


def poses_of(blocks, by=None, change=None):
    drawn = np.array([block.centroid for block in blocks])
    d, count = drawn.shape[1], len(blocks)
    by = np.zeros((count, d)) if by is None else np.array(by, dtype=float)
    return drawn, Poses(drawn, by, np.zeros((count, d, d)) if change is None else np.array(change))


def found(blocks, by=None, change=None, *, reach=0.01, watched=None, skipped=(), room=None):
    """Where blocks meet, as pairs of a face and another block, and the places. Pairs of blocks are skipped."""
    drawn, poses = poses_of(blocks, by, change)
    whole = Finder(stood(blocks), flat=drawn.shape[1] == 2)
    if room:
        whole._table = rows(PLACE, room)
    which = np.ones(len(blocks), dtype=bool) if watched is None else np.isin(range(len(blocks)), watched)
    a, b = np.reshape(np.array(skipped, dtype=np.int64), (-1, 2)).T
    places = whole.places_near(
        poses, np.broadcast_to(reach, len(blocks)).astype(float), which, np.sort(whole.between(a, b))
    )
    pairs = sorted({tuple(sorted(pair)) for pair in zip(places.face.tolist(), places.other.tolist(), strict=True)})
    return pairs, places


ROW = [BOX((1.0, 1.0, 1.0), (1.005 * i, 0.0, 0.0)) for i in (2, 0, 3, 1)]
"""Cubes in a row with gaps of 5 mm: the second, the fourth, the first and the third one."""


@pytest.mark.parametrize("axis", range(3))
def test_pairs_that_are_nearer_than_both_reach_are_found(axis):
    blocks = [BOX((1.0, 1.0, 1.0), np.roll([1.005 * i, 0.0, 0.0], axis)) for i in (2, 0, 3, 1)]
    every = [(0, 2), (0, 3), (1, 3)]
    assert found(blocks, reach=0.0026)[0] == every
    assert found(blocks, reach=0.0024)[0] == []
    assert found(blocks, reach=[0.004, 0.002, 0.0, 0.002])[0] == [(0, 3)]
    assert found(blocks, watched=[0])[0] == [(0, 2), (0, 3)]
    assert found(blocks, watched=[1, 2])[0] == [(0, 2), (1, 3)]
    assert found(blocks, watched=[])[0] == []
    assert found(blocks, skipped=[(1, 3)])[0] == [(0, 2), (0, 3)]
    assert found(blocks, skipped=[(0, 3)])[0] == found(blocks, skipped=[(3, 0), (2, 3)])[0] == [(0, 2), (1, 3)]


def test_blocks_are_found_in_any_order():
    """The farthest one is the last one, too."""
    for order, pairs in (((0, 2, 1, 3), [(0, 2), (1, 2), (1, 3)]), ((3, 2, 1, 0, 4), [(0, 1), (0, 4), (1, 2), (2, 3)])):
        assert found([BOX((1.0, 1.0, 1.0), (1.005 * i, 0.0, 0.0)) for i in order])[0] == pairs


def test_fixed_blocks_do_not_meet_each_other():
    blocks = [BOX((1.0, 1.0, 1.0), (1.005 * i, 0.0, 0.0), fixed=i in (1, 2)) for i in (2, 0, 3, 1)]
    assert found(blocks)[0] == [(0, 2), (1, 3)]


@pytest.mark.parametrize("room", [None, 1, 5, 12])
def test_places_have_room(room):
    _, places = found(ROW, room=room)
    assert len(places.gap) == 12
    np.testing.assert_allclose(places.gap, 0.005, rtol=1e-9)
    np.testing.assert_allclose(places.share, 0.25)
    np.testing.assert_allclose(places.area, 1.0)
    np.testing.assert_allclose(np.abs(places.normal), np.tile([1.0, 0.0, 0.0], (12, 1)), atol=1e-12)
    np.testing.assert_allclose(
        np.unique(np.round(places.place, 9), axis=0)[:, 0], np.repeat([0.5025, 1.5075, 2.5125], 4)
    )
    some = places.only(np.array([3, 4]))
    assert [len(part) for part in some] == [2] * 7


def test_blocks_meet_where_they_have_moved_to():
    turn = Rotation.from_rotvec([0.0, 0.0, math.pi / 4]).as_matrix() - np.eye(3)
    blocks = [BOX((2.0, 2.0, 1.0), (0.0, 0.0, -0.5)), BOX((2.0, 2.0, 1.0), (5.0, 0.0, 3.5))]
    pairs, places = found(blocks, [(0, 0, 0.5), (-5, 0, -2.502)], [np.zeros((3, 3)), turn])
    assert pairs == [(0, 1)]
    assert len(places.gap) == 8
    np.testing.assert_allclose(places.gap, -0.002, rtol=1e-9)
    np.testing.assert_allclose(places.place[:, 2], 0.499, rtol=1e-9)


@pytest.mark.parametrize("size", [1.0, 0.1])
def test_blocks_of_the_plane_meet_at_one_end_of_their_prisms(size):
    """Two lines share what a pair has, over the length along which the sides lie over each other. Both blocks are
    turned about the centroid of the first one."""
    sides = ((-2, 2, -1, 0), (0.5, 1.5, 3, 4), (5, 6, 0, 1))
    blocks = [box(*(size * x for x in one)) for one in sides]
    turn, turns = np.array([[math.cos(0.1), math.sin(0.1)], [-math.sin(0.1), math.cos(0.1)]]), np.zeros((3, 2, 2))
    turns[:2] = turn - np.eye(2)
    drawn = np.array([block.centroid for block in blocks])

    def after(x, z):
        return turn @ (size * np.array([x, z]) - drawn[0]) + drawn[0]

    pairs, places = found(blocks, [(0, 0), after(1.2, 0.5 - 0.004) - drawn[1], (0, 0)], turns)
    assert pairs == [(0, 1)]
    np.testing.assert_allclose(places.gap, [-0.004 * size] * 2, rtol=1e-6)
    np.testing.assert_allclose(places.share, 0.5, rtol=1e-9)
    np.testing.assert_allclose(places.area, size, rtol=1e-9)
    np.testing.assert_allclose(places.normal, np.tile(turn @ [0.0, 1.0], (2, 1)), atol=1e-9)
    ends = [after(x, -0.002) for x in (0.7, 1.7)]
    np.testing.assert_allclose(places.place[places.place[:, 0].argsort()], ends, atol=1e-9)


@pytest.mark.parametrize("beside", [0.01, 0.1, 10.0])
def test_places_in_the_plane_do_not_depend_on_the_size_of_other_blocks(beside):
    """A polygon of 12 sides stands on a corner of a long ground, and a square lies far away."""
    around = 2 * math.pi / 12 * np.arange(12)
    wheel = mr.Polygon(0.3 * np.column_stack([np.sin(around), -np.cos(around)]))
    given = [box(-5, 60, -1, 0, fixed=True), wheel]
    shift = [(0.0, 0.0), (0.0, 0.299)]
    _, alone = found(given, shift)
    _, places = found([*given, box(30, 30 + beside, 0.5, 0.5 + beside)], [*shift, (0.0, 0.0)])
    for name in ContactPlaces._fields:
        np.testing.assert_allclose(getattr(places, name), getattr(alone, name), rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(places.gap.min(), -0.001, rtol=1e-9)
    np.testing.assert_allclose(places.place[places.gap.argmin()], [0.0, -0.0005], atol=1e-12)
    np.testing.assert_allclose(places.normal, [[0.0, 1.0]] * 2, atol=1e-12)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_a_small_polygon_meets_the_end_of_a_long_face_in_any_order(order):
    """One of its faces is deepest in that of the long block, and the one beside it comes not into question."""
    long = mr.Polygon([(0.1886, 0.2616), (0.3629, 0.2518), (0.3668, 0.3215), (0.1926, 0.3313)])
    small = mr.Polygon([(0.3324, 0.3330), (0.3427, 0.3227), (0.3605, 0.3173), (0.3581, 0.3382), (0.3514, 0.3451)])
    _, places = found([(long, small)[i] for i in order], reach=0.0)
    way = np.array([0.0098, 0.1742]) / math.hypot(0.0098, 0.1742)
    depth = [way @ (np.array(corner) - (0.1926, 0.3313)) for corner in ((0.3605, 0.3173), (0.3427, 0.3227))]
    np.testing.assert_allclose(np.sort(places.gap), depth, rtol=0, atol=1e-15)
    np.testing.assert_allclose(places.normal, [way] * 2, rtol=0, atol=1e-15)


def test_a_corner_of_the_plane_of_any_angle_meets_a_face():
    """A needle stands on its point, 1 mm deep, whose sides are steep to the ground."""
    needle = mr.Polygon([(0.0, 0.0), (0.02, 0.3), (-0.02, 0.3)])
    _, places = found([box(-5, 60, -1, 0, fixed=True), needle], [(0.0, 0.0), (0.0, -0.001)])
    assert len(places.gap) == 2
    deep = places.gap.argmin()
    np.testing.assert_allclose((places.gap[deep], places.share[deep]), (-0.001, 0.5), rtol=1e-9)
    np.testing.assert_allclose(np.abs(places.normal), [[0.0, 1.0]] * 2, atol=1e-12)


@pytest.mark.parametrize("prism", [False, True])
def test_the_parts_of_a_block_share_what_a_pair_has_by_their_areas(prism):
    """A block on the legs of a U, of 1 m and of 3 m, and another block beside it."""
    unit = mr.Compound([box(0, 1, 0, 1), box(1.5, 4.5, 0, 1), box(0, 4.5, -1, 0)])
    blocks = [box(9, 10, 0, 1), box(0.5, 4, 1.001, 2), unit, box(-1.001, -0.001, 0.3, 0.6)]
    if prism:
        blocks = [mr.Compound.prism(b) if isinstance(b, mr.Compound) else mr.Polyhedron.prism(b) for b in blocks]
    pairs, places = found(blocks)
    assert pairs == [(1, 2), (2, 3)]
    over = np.minimum(places.face, places.other) == 1
    assert (np.diff(over.astype(int)) != 0).sum() == 1  # those of a pair stand together
    np.testing.assert_allclose(places.area[over], 3.0, rtol=1e-9)
    ends, count = (4, 2) if not prism else (8, 4)
    assert over.sum() == ends
    np.testing.assert_allclose(np.sort(places.share[over]), np.repeat([0.5 / 3, 2.5 / 3], ends // 2) / count, rtol=1e-9)
    np.testing.assert_allclose(places.share[~over], 1 / (~over).sum(), rtol=1e-9)
    np.testing.assert_allclose(places.area[~over], 0.3, rtol=1e-9)
    drawn, _ = poses_of(blocks)
    whole = Finder(stood(blocks), flat=drawn.shape[1] == 2)
    each = np.ones(3)
    pair = ContactPlaces(
        *(np.array(of) for of in ([3, 1, 1], [1, 3, 2])), each, each, each, 0.25 * each, np.array([0.0, 0.0, 2.0])
    )
    edges = whole._among_blocks(pair)  # edges have the share that they have, and no area
    np.testing.assert_array_equal((edges.share, edges.area), [[0.25] * 3, [0.0, 0.0, 2.0]])
    assert [list(whole.parts_of(i)) for i in range(4)] == [[0], [1], [2, 3, 4], [5]]
    np.testing.assert_array_equal(
        whole.between(np.array([2, 1]), np.array([3, 0])), [6 * i + 5 for i in (2, 3, 4)] + [1]
    )
    np.testing.assert_allclose(whole.volumes / whole.volumes[0], [1.0, 3.5 * 0.999, 8.5, 0.3])
