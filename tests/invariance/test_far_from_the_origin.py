"""A dome drawn far from the origin: blocks that share a corner meet at the same places as beside the origin."""

from dataclasses import replace

import numpy as np
import pytest

import mjrock as mr
from mjrock.distinct.search.finder import NONE, Finder
from mjrock.distinct.search.pair_law import pair_number
from mjrock.distinct.search.solids import Poses
from mjrock.scene.masonry import standing_masonry

SHAKEN = 1e-5
"""Displacements of the blocks [m]: neighbours across a corner then lie over each other by slivers as wide as that."""
FAR = [(1 / 3, 0.0, 0.0), (1e3, 0.0, 0.0), (9e3, 1e3, 0.0)]


def dome(by=(0.0, 0.0, 0.0), k_n=1e12):
    joints = mr.Dry(k_n, friction=0.9)
    blocks = mr.Masonry.dome(1.0, 0.16, 8, 3, joints=joints).blocks
    return mr.Masonry([replace(block, vertices=np.array(block.vertices) + by) for block in blocks], joints=joints)


def meetings_in(masonry, by=(0.0, 0.0, 0.0)):
    """Of each pair of blocks without a joint, after small displacements: its places, their share of what the pair has,
    the middle of the places, moved back, and the sum of their normals, shape (pairs, 8)."""
    standing = standing_masonry(masonry).standing
    solids, count = standing.solids, len(standing.solids)
    moved = SHAKEN * np.random.default_rng(1).standard_normal((count, 3))
    poses = Poses(np.array([solid.rest for solid in solids]), moved, np.zeros((count, 3, 3)))
    found = Finder(solids, flat=False).found(poses, np.full(count, 1e-3), np.ones(count, dtype=bool), NONE)
    pair = pair_number(found.face, found.other, count)
    joined = [pair_number(joint.below, joint.above, count) for joint in standing.joints]
    pairs, of = np.unique(pair, return_inverse=True)
    rows = np.column_stack([np.ones(len(pair)), found.share, found.place - by, found.normal])
    sums = np.zeros((len(pairs), rows.shape[1]))
    np.add.at(sums, of, rows)
    sums[:, 2:5] /= sums[:, :1]
    return sums[~np.isin(pairs, joined)]


@pytest.mark.parametrize("by", FAR)
def test_blocks_of_a_dome_meet_at_their_corners_alike(by):
    """Coordinates of 9 km are rounded by 2e-12 m, a sliver of 1e-5 m by 1e-6 of its width."""
    here, there = meetings_in(dome()), meetings_in(dome(by), by)
    assert (here[:, 1] > 0).sum() > 10
    np.testing.assert_allclose(there, here, rtol=0, atol=1e-5)


@pytest.mark.parametrize("by", FAR)
def test_a_stiff_dome_is_at_rest_alike(by):
    here, there = standing_masonry(dome()), standing_masonry(dome(by))
    force = here.contacts.k * here.bears
    np.testing.assert_allclose(there.contacts.k * there.bears, force, rtol=0, atol=1e-8 * force.max())
