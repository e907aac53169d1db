"""Joints of one masonry with unlike numbers of contact lines, in both solvers."""

from functools import partial

import numpy as np
import pytest

import mjrock as mr

K_N, WIDTH, HEIGHT = 1e8, 0.4, 1.2
COUNTS = {"two": 2, "three": 3, "five": 5}
SPEED = 1e-3
"""Of the turning at the start [rad/s]. The joints stay closed."""


def three_blocks(in_space):
    """Three equal blocks on one ground, each on a joint of its own number of lines."""
    half, places = WIDTH / 2, (-1.0, 0.0, 1.0)
    if in_space:
        blocks = [mr.Polyhedron.box((6.0, 3.0, 1.0), (0, 0, -0.5), fixed=True, name="ground")]
        size = WIDTH, 1.0, HEIGHT
        blocks += [
            mr.Polyhedron.box(size, (x, 0, HEIGHT / 2), name=name) for x, name in zip(places, COUNTS, strict=True)
        ]
    else:
        blocks = [mr.Polygon([(-3, -1), (3, -1), (3, 0), (-3, 0)], fixed=True, name="ground")]
        for x, name in zip(places, COUNTS, strict=True):
            corners = [(x - half, 0), (x + half, 0), (x + half, HEIGHT), (x - half, HEIGHT)]
            blocks.append(mr.Polygon(corners, name=name))
    return mr.Masonry(blocks, joints=lambda joint: mr.Dry(K_N, 5.0, xi=0.0, points=COUNTS[joint.name.split("|")[1]]))


@pytest.mark.parametrize("solver", [mr.solve_explicit, partial(mr.simulate, accuracy=1e-4)])
@pytest.mark.parametrize("in_space", [False, True])
def test_each_block_rocks_with_the_stiffness_of_its_joint(in_space, solver):
    """On a closed joint a block rocks about the middle of its base with omega^2 = (K_rot - m g h) / I, K_rot = k_n I
    (1 + 2 / (n - 1)^2).

    Half a period of the quickest is followed. Both solvers are within 0.08 % of its amplitude; 0.1 % is allowed. The
    next number of lines is off by 30 % and by 13 %.
    """
    masonry = three_blocks(in_space)
    mass, arm = 2000.0 * WIDTH * HEIGHT, HEIGHT / 2
    about_base = mass * (WIDTH**2 + HEIGHT**2) / 12 + mass * arm**2
    spring = K_N * WIDTH**3 / 12 * np.array([1 + 2 / (count - 1) ** 2 for count in COUNTS.values()])
    omega = np.sqrt((spring - mass * mr.GRAVITY * arm) / about_base)
    velocity = np.zeros((3, 6 if in_space else 3))
    velocity[:, 0], velocity[:, 4 if in_space else 2] = SPEED * arm, SPEED
    case = mr.MasonryCase(masonry, 3.0 / float(omega.max()), velocity=velocity)
    answer = solver(case)
    turned = 2 * answer.pose[..., 5] if in_space else answer.pose[..., 2]
    expected = SPEED / omega * np.sin(omega * answer.t[:, None])
    np.testing.assert_allclose(turned - turned[0], expected, atol=1e-3 * SPEED / omega.max())
