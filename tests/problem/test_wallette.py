"""A wallette: a wall in space between a base and a beam, of one leaf or several."""

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.masonry.builders import in_space

SIZE = (0.8, 0.4, (0.2, 0.1))
MORTAR = mr.Bond(0.2e6, 0.3e6, 15.0, 130.0)


def collars(masonry):
    return [joint for joint in masonry.joints if abs(joint.normal[0]) > 0.5]


def test_one_leaf_has_the_joints_of_the_plane():
    wall, plane = mr.Masonry.wallette(*SIZE, 0.1), mr.Masonry.shear_wall(*SIZE, 0.1)
    assert wall.names == plane.names
    assert [joint.name for joint in wall.joints] == [joint.name for joint in plane.joints]
    masses = [[masonry.blocks[i].mass for i in masonry.free] for masonry in (wall, plane)]
    np.testing.assert_allclose(*masses)
    corners = np.concatenate([wall.blocks[i].corners for i in wall.free])
    np.testing.assert_allclose([corners.min(axis=0), corners.max(axis=0)], [(-0.1, -0.4, 0.0), (0.0, 0.4, 0.4)])
    assert not collars(wall)
    assert mr.Masonry.wallette(*SIZE, 0.1, beam=False).names == wall.names[:-1]


def test_leaves_are_joined_by_collar_joints_and_headers():
    wall = mr.Masonry.wallette(*SIZE, 0.2, leaves=2, headers=4)
    assert sum(wall.blocks[i].mass for i in wall.free) == pytest.approx(0.8 * 0.4 * 0.2 * 2000.0)
    through = [wall.blocks[i].name for i in wall.free if np.ptp(wall.blocks[i].corners[:, 0]) > 0.15]
    assert through == [name for name in wall.names if name.startswith("unit_3_")]
    assert sum(joint.area for joint in collars(wall)) == pytest.approx(3 * 0.1 * 0.8)  # three courses without headers
    bare = mr.Masonry.wallette(*SIZE, 0.2, leaves=2)
    assert sum(joint.area for joint in collars(bare)) == pytest.approx(0.4 * 0.8)


def test_it_stands_with_a_mortar_of_its_own_between_the_leaves():
    def bond(joint):
        return None if abs(joint.normal[0]) > 0.5 else MORTAR

    wall = mr.Masonry.wallette(*SIZE, 0.2, leaves=2, headers=4, beam=False, k_n=1e10, k_s=5e9, points=3, bond=bond)
    answer = mr.solve_explicit(mr.MasonryCase(wall, 1e-3), forces=True)
    weight = sum(wall.blocks[i].mass for i in wall.free) * mr.GRAVITY
    assert answer.forces.reactions["base"][0] == pytest.approx([0.0, 0.0, weight], abs=1e-6 * weight)
    assert np.isnan(answer.forces.damage[0]).sum() == len(collars(wall))


def test_what_cannot_be_is_named():
    with pytest.raises(ValueError, match="leaves = 0 is outside the valid range 1 to 10"):
        mr.Masonry.wallette(*SIZE, 0.2, leaves=0)
    with pytest.raises(ValueError, match="halves with leaves = 2 and headers = 0: units of several leaves are whole"):
        mr.Masonry.wallette(*SIZE, 0.2, leaves=2, halves=MORTAR, k_s=1e10)


@pytest.mark.parametrize(("options", "named"), [({"leaves": 2}, "leaves = 2"), ({"headers": 1}, "headers = 1")])
def test_more_blocks_than_there_may_be_are_refused_by_what_makes_them(options, named, monkeypatch):
    monkeypatch.setattr(in_space, "MOST_BODIES", 76)
    assert len(mr.Masonry.wallette(9.0, 1.0, (0.5, 0.25), 0.25).names) == 76
    with pytest.raises(ValueError, match=rf"{named}.* make a wall of 1\d\d blocks; the valid range ends at 76"):
        mr.Masonry.wallette(9.0, 1.0, (0.5, 0.25), 0.25, **options)
