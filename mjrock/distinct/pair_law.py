"""The law of the contact of two blocks beyond their joints.

Two blocks that had a joint keep its stiffness and dashpot per area of what lies over each other, and its friction, that
of a mortared joint without its bond. So a joint that has slid is as stiff as one that is drawn where it is. It keeps a
tenth of its stiffness down to a hundredth of its area, or corners would sink in. Two that had none take those of the
softer block: of its stiffest joint, or of half of all its joints if that is more, since a block of a wall has joints on
two sides. They keep all of it down to a tenth of the area of such a joint. Below, both have less in proportion, so that
blocks which only touch along their edges bear nothing. The places where a pair touches share what it has.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Flags, Integers
from .rows import Rows

SHARED = ("k", "c", "k_s", "c_s")
"""What the places of a pair share."""
WHOLE = 0.1
"""Part of the area of a joint over which two faces that had none have all that a pair has, and part of its stiffness
that one which has slid keeps until this part of that area is left [-]."""


def pair_number(a: Integers, b: Integers, blocks: int) -> Integers:
    """One number for two blocks."""
    return np.asarray(np.minimum(a, b) * blocks + np.maximum(a, b), dtype=np.int64)


def are_among(numbers: Integers, increasing: Integers) -> Flags:
    """Whether numbers are among increasing ones, shape of the numbers."""
    if not len(increasing):
        return np.zeros(len(numbers), dtype=bool)
    place = np.minimum(np.searchsorted(increasing, numbers), len(increasing) - 1)
    return np.asarray(increasing[place] == numbers)


def least_among(pair: Integers, others: Integers, shares: Array) -> Array:
    """The least share of each pair among others, 1 where it is not one of them, shape of the pairs."""
    if not len(others):
        return np.ones(len(pair))
    known, of = np.unique(others, return_inverse=True)
    least = np.ones(len(known) + 1)
    np.minimum.at(least, of, shares)
    return least[np.where(are_among(pair, known), np.searchsorted(known, pair), -1)]


class PairLaw(NamedTuple):
    """What each pair of blocks has in all.

    Args:
        jointed: numbers of the pairs that have a joint, increasing, shape (p,).
        of_pair: columns of `SHARED` and area [m2], in the plane width [m], of these pairs, shape (p, 5), and their
            friction, shape (p,).
        of_block: likewise of each block as a pair without a joint takes it.
    """

    jointed: Integers
    of_pair: tuple[Array, Array]
    of_block: tuple[Array, Array]

    @classmethod
    def of_joints(cls, masonry: Masonry, lines: Rows, joint: Integers) -> PairLaw:
        """The law of masonry, from the lines of its joints and the number of the joint of each."""
        blocks, joints = len(masonry.blocks), len(masonry.joints)
        below, above = np.array([(each.below, each.above) for each in masonry.joints]).T
        areas = np.array([each.area if masonry.in_space else each.width for each in masonry.joints])
        sums = np.column_stack([*(_sums(joint, lines[name], joints) for name in SHARED), areas])
        friction = np.zeros(joints)
        friction[joint] = np.minimum(lines["friction"], masonry.residual_friction[joint])
        jointed, of = np.unique(pair_number(below, above, blocks), return_inverse=True)
        in_pairs = np.column_stack([_sums(of, column, len(jointed)) for column in sums.T])
        least = np.full(len(jointed), np.inf)
        np.minimum.at(least, of, friction)
        return cls(jointed, (in_pairs, least), _of_blocks(np.append(below, above), sums, friction, blocks))

    def of_places(self, pair: Integers, share: Array, area: Array, blocks: int) -> dict[str, Array]:
        """Columns of lines at places of pairs, from the share that each has of its pair, and the area of the part of a
        face that lies over the other [m2], zero for edges, shape (n,) each."""
        first, second = np.divmod(pair, blocks)
        softer = np.where(self.of_block[0][first, 0] <= self.of_block[0][second, 0], first, second)
        shared, friction = self.of_block[0][softer], np.minimum(self.of_block[1][first], self.of_block[1][second])
        had = are_among(pair, self.jointed)
        there = np.searchsorted(self.jointed, pair[had])
        shared[had], friction[had] = self.of_pair[0][there], self.of_pair[1][there]
        over = area / shared[:, -1]
        kept = np.where(had, np.maximum(over, np.minimum(over / WHOLE, WHOLE)), np.minimum(over / WHOLE, 1.0))
        share = share * np.where(area > 0, kept, 1.0)
        return {**dict(zip(SHARED, share * shared[:, :-1].T, strict=True)), "friction": friction}


def _sums(of: Integers, values: Array, count: int) -> Array:
    return np.asarray(np.bincount(of, weights=values, minlength=count), dtype=float)


def _of_blocks(block: Integers, joints: Array, friction: Array, blocks: int) -> tuple[Array, Array]:
    """What each block has, from its joints: below of all and then above of all. One without a joint is never softer."""
    joints, friction = np.concatenate([joints, joints]), np.concatenate([friction, friction])
    sums = np.column_stack([_sums(block, column, blocks) for column in joints.T])
    stiffest, least = np.zeros(blocks), np.full(blocks, np.inf)
    np.maximum.at(stiffest, block, joints[:, 0])
    np.minimum.at(least, block, friction)
    alone = sums[:, 0] == 0
    share = np.maximum(stiffest / np.where(alone, 1.0, sums[:, 0]), 0.5)
    shared = share[:, None] * sums
    shared[alone] = np.inf
    return shared, least
