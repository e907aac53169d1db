"""Drawn far from the origin: blocks of a dome that share a corner meet at the same places as beside the origin, and
MuJoCo moves blocks alike."""

from dataclasses import replace

import numpy as np
import pytest
from everyday import slow

import mjrock as mr
from mjrock.distinct.search.finder import NONE, Finder
from mjrock.distinct.search.pair_law import pair_number
from mjrock.distinct.search.solids import Poses
from mjrock.scene.masonry import scene_of_masonry

SHAKEN = 1e-5
"""Displacements of the blocks [m]: neighbours across a corner then lie over each other by slivers as wide as that."""
FAR = [(1 / 3, 0.0, 0.0), (1e3, 0.0, 0.0), (9e3, 1e3, 0.0)]
OFTEN = [*(slow((by,)) for by in FAR[:-1]), FAR[-1]]
"""The farthest every day."""


def dome(by=(0.0, 0.0, 0.0), k_n=1e12):
    joints = mr.Dry(k_n, friction=0.9)
    blocks = mr.Masonry.dome(1.0, 0.16, 8, 3, joints=joints).blocks
    return mr.Masonry([replace(block, vertices=np.array(block.vertices) + by) for block in blocks], joints=joints)


def meetings_in(masonry, by=(0.0, 0.0, 0.0)):
    """Of each pair of blocks without a joint, after small displacements: its places, their share of what the pair has,
    the middle of the places, moved back, and the sum of their normals, shape (pairs, 8)."""
    standing = scene_of_masonry(masonry).rest_geometry
    solids, count = standing.solids, len(standing.solids)
    moved = SHAKEN * np.random.default_rng(1).standard_normal((count, 3))
    poses = Poses(np.array([solid.rest for solid in solids]), moved, np.zeros((count, 3, 3)))
    found = Finder(solids, flat=False).places_near(poses, np.full(count, 1e-3), np.ones(count, dtype=bool), NONE)
    pair = pair_number(found.face, found.other, count)
    joined = [pair_number(joint.below, joint.above, count) for joint in standing.joints]
    pairs, of = np.unique(pair, return_inverse=True)
    rows = np.column_stack([np.ones(len(pair)), found.share, found.place - by, found.normal])
    sums = np.zeros((len(pairs), rows.shape[1]))
    np.add.at(sums, of, rows)
    sums[:, 2:5] /= sums[:, :1]
    return sums[~np.isin(pairs, joined)]


@pytest.mark.parametrize("by", OFTEN)
def test_blocks_of_a_dome_meet_at_their_corners_alike(by):
    """Coordinates of 9 km are rounded by 2e-12 m, a sliver of 1e-5 m by 1e-6 of its width."""
    here, there = meetings_in(dome()), meetings_in(dome(by), by)
    assert (here[:, 1] > 0).sum() > 10
    np.testing.assert_allclose(there, here, rtol=0, atol=1e-5)


@pytest.mark.parametrize("by", OFTEN)
def test_a_stiff_dome_is_at_rest_alike(by):
    here, there = scene_of_masonry(dome()), scene_of_masonry(dome(by))
    force = here.contacts.k * here.bears
    np.testing.assert_allclose(there.contacts.k * there.bears, force, rtol=0, atol=1e-8 * force.max())


def stack(by, in_space):
    """Three blocks on a fixed one, with a tie to the ground and a thrust. Coordinates are binary fractions: 8 km away
    they are not rounded."""
    blocks = []
    for i, (left, right) in enumerate([(-1.0, 1.0), (-0.25, 0.25), (-0.1875, 0.3125), (-0.25, 0.25)]):
        low, high = 0.5 * i - 0.5, 0.5 * i
        if in_space:
            corners = [(x, y, z) for x in (left, right) for y in (-0.5, 0.5) for z in (low, high)]
            blocks.append(mr.Polyhedron(np.array(corners) + by, name=f"block_{i}", fixed=i == 0))
        else:
            corners = [(left, low), (right, low), (right, high), (left, high)]
            blocks.append(mr.Polygon(np.array(corners) + by, length=1.0, name=f"block_{i}", fixed=i == 0))
    masonry = mr.Masonry(blocks, joints=mr.Dry(1e10, friction=0.6))
    if in_space:
        at, anchor = np.array([(-0.25, 0.0, 1.25), (-1.25, 0.0, 1.0)]) + by
        effects = (
            mr.Tie(at=at, anchor=anchor, stiffness=1e6, block="block_3"),
            mr.Thrust(at=(0.25 + by[0], 0.0, 1.25), direction=(1.0, 0.5, 0.0), force=500.0, block="block_3"),
        )
    else:
        effects = (
            mr.Tie(height=1.25, stiffness=1e6, length=1.0, block="block_3"),
            mr.Thrust(height=1.25, force=500.0, block="block_3"),
        )
    rates = np.zeros((3, 6 if in_space else 3))
    rates[:, 0] = 0.05
    return mr.MasonryCase(masonry, duration=0.05, effects=effects, velocity=rates, settled=False)


@pytest.mark.parametrize("in_space", [False, True])
def test_mujoco_has_the_same_model_eight_kilometres_away(in_space):
    """The same text, so that the motion is equal to the bit. MuJoCo would round places there by 1e-12 m."""
    here, there = (stack(np.array([x, 0.0, 0.0] if in_space else [x, 0.0]), in_space) for x in (0.0, 8e3))
    assert mr.mjcf_of(there, None, 1e-4) == mr.mjcf_of(here, None, 1e-4)
    moved = [mr.simulate(case, timestep=1e-4, coulomb=True).pose for case in (here, there)]
    assert np.abs(moved[0][..., :2]).max() > 1e-4
    np.testing.assert_array_equal(moved[1], moved[0])
