"""Blocks as they are drawn: millimetres, and vertices that are off by some tenths of a millimetre."""

import re

import numpy as np
import pytest

import mjrock as mr

FACADE = mr.Masonry.facade(1.6, 0.8, 0.8, (0.4, 0.2), k_n=1e9)


@pytest.mark.parametrize(
    ("make", "said"),
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
def test_blocks_in_millimetres_are_doubted(make, said):
    of = (
        mr.Polyhedron.box((1e3, 1e3, 1e2), (0, 0, -50.0), fixed=True)
        if isinstance(make(1.0), mr.Polyhedron)
        else mr.Polygon([(-1e3, -1), (1e3, -1), (1e3, 0), (-1e3, 0)], fixed=True)
    )
    mr.Masonry([of, make(1.0)])
    with pytest.warns(mr.Implausible, match=f"{said}.*vertices are in m: are they in mm"):
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
    with pytest.warns(mr.Implausible, match="vertices are in m: are they in mm. A file takes scale=0.001"):
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
def test_open_joints_are_refused_with_the_gap_and_a_tolerance_that_joins_them(gap, in_space):
    """No block touches any other, or one alone does: either way the tolerance that is said makes all joints."""
    sides = [(-1.0, 3.0, -1.0, 0.0)] + [(i * (0.5 + gap), i * (0.5 + gap) + 0.5, gap, gap + 0.3) for i in range(3)]
    blocks = [mr.Polygon([(a, c), (b, c), (b, d), (a, d)], fixed=c < 0) for a, b, c, d in sides]
    if in_space:
        blocks = [mr.Polyhedron.prism(block) for block in blocks]
    with pytest.raises(ValueError, match=rf"within the tolerance of 1e-05 m; .* there are {gap:g} m; tol") as refused:
        mr.Masonry(blocks)
    tolerance = float(re.search(r"tolerance = (\S+) m joins all of them", str(refused.value))[1])
    assert gap < tolerance < 1.2 * gap
    assert len(mr.Masonry(blocks, tolerance=tolerance).joints) == 5


def test_blocks_that_no_tolerance_joins_are_refused_with_their_distance():
    ground, stone = (mr.Polygon([(0, z), (1, z), (1, z + 1), (0, z + 1)], fixed=z < 0) for z in (-1.0, 0.3))
    with pytest.raises(ValueError, match=r"block_1 and block_0 there are 0.3 m, and no tolerance up to 0.1 m joins"):
        mr.Masonry([ground, stone])
