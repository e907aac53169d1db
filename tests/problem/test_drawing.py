"""Blocks as they are drawn: millimetres, and vertices that are off by some tenths of a millimetre."""

import re
import warnings

import numpy as np
import pytest

import mjrock as mr

FACADE = mr.Masonry.facade(1.6, 0.8, 0.8, (0.4, 0.2), k_n=1e9)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda scale: mr.Polyhedron.box((scale * 0.4, scale * 0.2, scale * 0.2), (0, 0, scale * 0.1)),
            "block_1 is 489.9 m",
        ),
        (
            lambda scale: mr.Polygon([(0, 0), (scale * 0.4, 0), (scale * 0.4, scale * 0.3), (0, scale * 0.3)]),
            "block_1 is 500 m across",
        ),
    ],
)
def test_blocks_in_millimetres_are_doubted(make, message):
    of = (
        mr.Polyhedron.box((1e3, 1e3, 1e2), (0, 0, -50.0), fixed=True)
        if isinstance(make(1.0), mr.Polyhedron)
        else mr.Polygon([(-1e3, -1), (1e3, -1), (1e3, 0), (-1e3, 0)], fixed=True)
    )
    mr.Masonry([of, make(1.0)])
    with pytest.warns(mr.Implausible, match=f"{message}.*vertices are in m: are they in mm"):
        mr.Masonry([of, make(1000.0)])


def test_a_file_in_millimetres_is_doubted_and_scaled(tmp_path):
    path = tmp_path / "wall.obj"
    FACADE.to_obj(path)
    text = path.read_text().splitlines()
    lines = [
        " ".join(["v", *(str(1000 * float(x)) for x in line.split()[1:])]) if line.startswith("v ") else line
        for line in text
    ]
    path.write_text("\n".join(lines))
    fixed = [FACADE.names[i] for i in range(len(FACADE.blocks)) if i not in FACADE.free]
    with pytest.warns(mr.Implausible, match="vertices are in m: are they in mm, 0.35 m. A file takes unit='mm'"):
        mr.Masonry.from_obj(path, fixed, k_n=1e9)
    assert len(mr.Masonry.from_obj(path, fixed, scale=0.001, k_n=1e9).joints) == len(FACADE.joints)


def test_vertices_off_their_planes_are_named():
    """0.2 mm off, as drawings often have them, each face falls into two and makes twice the joints."""
    rng = np.random.default_rng(0)
    moved = [
        mr.Polyhedron(block.corners + 2e-4 * rng.uniform(-1, 1, block.corners.shape), fixed=block.fixed)
        for block in FACADE.blocks
    ]
    with pytest.warns(mr.Implausible, match="pairs of blocks meet along a face that is split .* round them"):
        found = mr.Masonry(moved, k_n=1e9, tolerance=2e-3)
    assert len(found.joints) > 2 * len(FACADE.joints)


@pytest.mark.parametrize(
    "masonry",
    [
        lambda: mr.Masonry.dome(5.0, 0.5, 8, 4, k_n=1e9),
        lambda: mr.Masonry.column(0.4, 1.0, 5, k_n=1e9),
        lambda: mr.Masonry.arch(5.0, 0.7),
        lambda: mr.Masonry.running_bond(2.0, 1.0, (0.5, 0.25), k_n=1e9),
    ],
)
@pytest.mark.filterwarnings("error")
def test_what_is_drawn_well_is_not_doubted(masonry):
    assert masonry().joints


@pytest.mark.parametrize("gap", [0.0004, 0.01])
@pytest.mark.parametrize("in_space", [False, True])
def test_open_joints_are_refused_with_the_gap_that_joins_them(gap, in_space):
    """No block touches any other, or one alone does: either way the gap that is said makes all joints."""
    sides = [(-1.0, 3.0, -1.0, 0.0)] + [(i * (0.5 + gap), i * (0.5 + gap) + 0.5, gap, gap + 0.3) for i in range(3)]
    blocks = [mr.Polygon([(a, c), (b, c), (b, d), (a, d)], fixed=c < 0) for a, b, c, d in sides]
    if in_space:
        blocks = [mr.Polyhedron.prism(block) for block in blocks]
    with pytest.raises(ValueError, match=rf"within the tolerance of 1e-05 m; .* there are {gap:g} m; gap") as refused:
        mr.Masonry(blocks)
    message = re.search(r"gap = (\S+) m joins all of them: it finds 5 joints$", str(refused.value))
    assert gap <= float(message[1]) < 1.2 * gap
    assert len(mr.Masonry(blocks, gap=float(message[1])).joints) == len(mr.Masonry(blocks, gap=gap).joints) == 5


def test_blocks_that_no_gap_joins_are_refused_with_their_distance():
    ground, stone = (mr.Polygon([(0, z), (1, z), (1, z + 1), (0, z + 1)], fixed=z < 0) for z in (-1.0, 0.3))
    with pytest.raises(ValueError, match=r"block_1 and block_0 there are 0.3 m, and no gap up to 0.1 m joins"):
        mr.Masonry([ground, stone])


def test_all_overlaps_are_said_with_the_tolerance_that_takes_them():
    """Courses that sink by 1, 4 and 2 mm: with the tolerance that is said all three joints are found."""
    depths, z = (0.001, 0.004, 0.002), 0.0
    blocks = [mr.Polyhedron.box((2, 2, 1), (0, 0, -0.5), fixed=True)]
    for deep in depths:
        z -= deep
        blocks.append(mr.Polyhedron.box((0.5, 0.5, 0.3), (0, 0, z + 0.15)))
        z += 0.3
    outlines = [(b.corners.min(axis=0)[[0, 2]], b.corners.max(axis=0)[[0, 2]]) for b in blocks]
    flat = [mr.Polygon([(a, c), (b, c), (b, d), (a, d)], fixed=d == 0) for (a, c), (b, d) in outlines]
    for made in (blocks, flat):
        with pytest.raises(ValueError, match=r"block_1 and block_2 overlap by 0.004 m, the most of 3 pairs") as refused:
            mr.Masonry(made)
        tolerance = float(re.search(r"tolerance = (\S+) m takes them: it finds 3 joints$", str(refused.value))[1])
        assert 0.004 <= tolerance < 0.0042
        assert len(mr.Masonry(made, tolerance=tolerance).joints) == 3


def test_an_overlap_that_no_tolerance_takes_is_said():
    ground, deep = (mr.Polygon([(0, z), (1, z), (1, z + 1), (0, z + 1)], fixed=z < -0.7) for z in (-1.0, -0.5))
    with pytest.raises(ValueError, match=r"overlap by 0.5 m; .*; no tolerance up to 0.1 m takes them"):
        mr.Masonry([ground, deep])


def cards(in_space):
    """Two cards that lean against each other on the ground, and a slab whose foot is cut flat and whose head is not."""
    blocks = [mr.Polygon([(-3, -1), (3, -1), (3, 0), (-3, 0)], fixed=True, name="ground")]
    blocks.append(mr.Polygon([(0, 0), (1, 2), (0.9, 2.05), (-0.1, 0.05)], name="left"))
    blocks.append(mr.Polygon([(1, 2), (1.95, 0.1), (2.05, 0.15), (1.1, 2.05)], name="right"))
    return [mr.Polyhedron.prism(block) for block in blocks] if in_space else blocks


@pytest.mark.parametrize("in_space", [False, True])
def test_blocks_that_touch_along_a_line_are_refused_by_that_name(in_space):
    message = "ground and left touch along a line"
    with pytest.raises(ValueError, match=f"no two of them touch .*; {message}.*; a joint takes faces: cut the edge"):
        mr.Masonry(cards(in_space)[:2])
    post = mr.Polygon([(-2, 0), (-1.5, 0), (-1.5, 1), (-2, 1)], name="post")
    with pytest.warns(mr.Implausible, match=f"without a joint {message}"):
        mr.Masonry([*cards(in_space)[:2], mr.Polyhedron.prism(post) if in_space else post])


def test_a_corner_on_a_face_is_named_and_edges_that_meet_are_not_doubted():
    """A cube on its tip stands on a corner. Bricks across a corner touch along an edge, and press in no direction."""
    turn = np.linalg.qr(np.array([[1.0, 1, 1], [1, -1, 0], [1, 1, -2]]).T)[0].T[[1, 2, 0]]
    tip = mr.Polyhedron.box((1, 1, 1)).corners @ turn.T
    ground = mr.Polyhedron.box((5, 5, 1), (0, 0, -0.5), fixed=True, name="ground")
    with pytest.raises(ValueError, match="ground and tip touch at a corner; a joint takes faces"):
        mr.Masonry([ground, mr.Polyhedron(tip - [0, 0, tip[:, 2].min()], name="tip")])
    bond = [mr.Polyhedron.box((1, 1, 1), (x, 0, z + 0.5)) for x, z in ((0, 0), (1, 0), (0, 1))]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(mr.Masonry([ground, *bond]).joints) == 4


def test_faces_of_a_file_that_nearly_touch_are_doubted():
    """0.1 mm between the heads of two stones on the ground is ten times the tolerance."""
    stones = {"one": (0.0, 1.0), "two": (1.0001, 2.0)}
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    meshes = {
        name: (np.array([(x, y, z) for x in ends for y in (0.0, 0.5) for z in (0.0, 0.5)]), faces)
        for name, ends in stones.items()
    }
    with pytest.warns(mr.Implausible, match=r"1 pairs .* lie less than 0.0002 m apart, such as one\|two; gap = 0.0002"):
        assert len(mr.Masonry.from_meshes(meshes, ground=True).joints) == 2
    assert len(mr.Masonry.from_meshes(meshes, ground=True, tolerance=2e-4).joints) == 3
    assert len(mr.Masonry.from_meshes(meshes, ground=True, gap=2e-4).joints) == 3
