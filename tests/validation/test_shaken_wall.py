"""The clay wall US-1 of the SAFEGO project, built by the numbers of its authors, beside closed form and test."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import eigh

import mjrock as mr
from scripts.studies.shaken_wall import COURSES, LOAD, K, Way, shaken, wall_of

MEASURED = 0.091
"""Period of the wall before the runs [s], Moshfeghi et al., Structures 66, 106815, 2024."""
HELD = 1e9
"""Stiffness that holds the beam along x [N/m]."""


def motion_at(masonry, block, point):
    """Displacement of a point of a block [m] by the small motions of all blocks, shape (3, 6 blocks)."""
    x, y, z = point - np.asarray(masonry.blocks[block].centroid)
    found = np.zeros((3, 6 * len(masonry.blocks)))
    found[:, 6 * block : 6 * block + 3] = np.eye(3)
    found[:, 6 * block + 3 : 6 * block + 6] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
    return found


def stiffness_of(masonry):
    """Linear joints of k_n and k_s, each integrated over its rectangle by 2 x 2 points of Gauss, which is exact."""
    total = 0.0
    for joint in masonry.joints:
        k_n, k_s = (0.1 * K, 1e4) if "support" in joint.name else (K, K)
        normal = np.outer(joint.normal, joint.normal)
        law = k_n * normal + k_s * (np.eye(3) - normal)
        corners = np.array(joint.vertices)
        along, across = (corners[1] - corners[0]) / np.sqrt(12), (corners[3] - corners[0]) / np.sqrt(12)
        for a, b in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
            point = corners.mean(axis=0) + a * along + b * across
            apart = motion_at(masonry, joint.above, point) - motion_at(masonry, joint.below, point)
            total = total + joint.area / 4 * apart.T @ law @ apart
    return total


def period_by_closed_form(masonry):
    """Period of the mode that the ground excites most [s]: rigid blocks on linear joints, under the weight above."""
    blocks, names = masonry.blocks, masonry.names
    mass, stiffness = np.zeros((2, 6 * len(blocks), 6 * len(blocks)))
    stiffness += stiffness_of(masonry)
    for i, block in enumerate(blocks):
        mass[6 * i : 6 * i + 3, 6 * i : 6 * i + 3] = block.mass * np.eye(3)
        mass[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] = block.inertia
    top = names.index("beam")
    stiffness[6 * top, 6 * top] += HELD
    chain = [top, *(names.index(f"part_{i}") for i in reversed(range(COURSES))), names.index("base")]
    pressing = LOAD
    for above, below in pairwise(chain):
        pressing += blocks[above].mass * mr.GRAVITY
        apart = np.zeros(6 * len(blocks))
        apart[[6 * above, 6 * below]] = 1.0, -1.0
        stiffness -= pressing / (blocks[above].centroid[2] - blocks[below].centroid[2]) * np.outer(apart, apart)
    moving = [6 * i + j for i in masonry.free for j in range(6)]
    squares, shapes = eigh(stiffness[np.ix_(moving, moving)], mass[np.ix_(moving, moving)])
    shared = np.abs(shapes.T @ mass[np.ix_(moving, moving)][:, ::6].sum(axis=1))
    return 2 * np.pi / np.sqrt(squares[shared.argmax()])


@pytest.mark.slow
def test_the_wall_rings_with_the_period_of_its_closed_form():
    """Within 1 %; the spectrum of half a second knows a sine of this period to 0.03 %. Joints of version 1.0, which
    were 22 % stiffer in bending than k_n I, had 5 % less.

    The wall of the test had 0.091 s. The model, in which nothing is fitted, is softer and misses it by 18 %, as
    docs/compared_with_tests.md says.
    """
    masonry = wall_of()
    closed = period_by_closed_form(masonry)
    pulse = mr.GroundMotion(0.3 * np.sin(2 * np.pi * np.arange(0.0, 0.1, 0.005) / 0.1), 0.005)
    (one,), _ = shaken(masonry, [pulse], Way())
    assert one.cracked == 0
    assert one.period == pytest.approx(closed, rel=0.01)
    assert one.period / MEASURED == pytest.approx(1.18, abs=0.015)
    assert 1e-5 < one.peaks[-1] < 1e-3
