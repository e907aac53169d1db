"""Blocks of random shapes that fall on each other, of which hardly one has a joint in the drawing: they stay apart."""

import itertools

import numpy as np
import pytest
from everyday import among
from masonry_blocks import box

import mjrock as mr

SCENES = range(50)
K_N = 1e10
"""On which blocks of 0.1 to 0.4 m that land with some m/s overlap by less than 1 % [N/m3]."""


def shape(rng, size, in_space):
    """Corners of a box or of a convex body, about zero."""
    d = 3 if in_space else 2
    if rng.random() < 0.4:
        half = 0.5 * size * rng.uniform(0.4, 1.0, d)
        return half * np.array(np.meshgrid(*[(-1, 1)] * d)).reshape(d, -1).T
    points = rng.normal(size=(rng.integers(6, 13), 3)) if in_space else rng.uniform(-1, 1, (40, 2))
    return 0.5 * size * points / np.linalg.norm(points, axis=1)[:, None]


def turned(rng, corners):
    turn, _ = np.linalg.qr(rng.normal(size=(corners.shape[1],) * 2))
    return corners @ turn


def flat(corners):
    """The hull of random corners on a circle, with sides that are no shorter than a tenth of it."""
    at = np.arctan2(*(corners - corners.mean(axis=0)).T)
    order, radius = np.argsort(-at), 0.5 * np.ptp(corners, axis=0).max()
    kept = []
    for corner in corners[order]:
        if not kept or np.linalg.norm(corner - kept[-1]) > 0.3 * radius:
            kept.append(corner)
    return kept[1:] if np.linalg.norm(kept[0] - kept[-1]) < 0.3 * radius else kept


def rain(seed, in_space, k_n=K_N):
    """Three to six blocks in a column over the ground, thrown about, and one that stands on it."""
    rng = np.random.default_rng([seed, in_space])
    low, bodies = 0.3, []
    for _ in range(rng.integers(3, 7)):
        size = 10 ** rng.uniform(np.log10(0.1), np.log10(0.4))
        low += 0.9 * size
        at = [*rng.uniform(-0.1, 0.1, 2 if in_space else 1), low]
        corners = turned(rng, shape(rng, size, in_space)) + at
        bodies.append(mr.Polyhedron(corners) if in_space else mr.Polygon(flat(corners)))
        low += 0.9 * size
    stands = [box(-6, 6, -1, 0, fixed=True, name="ground"), box(0.5, 0.8, 0, 0.1)]
    if in_space:
        stands = [
            mr.Polyhedron.box((12, 12, 1), (0, 0, -0.5), fixed=True),
            mr.Polyhedron.box((0.3, 0.3, 0.1), (1, 0, 0.05)),
        ]
    settings = {"friction": rng.choice([0.2, 0.6]), "xi": rng.choice([0.0, 0.05, 0.2]), "frequency": 2000.0}
    masonry = mr.Masonry([*stands, *bodies], k_n=k_n, k_s=rng.choice([None, 0.5 * k_n]), **settings)
    rates = rng.uniform(-1, 1, (len(bodies), 6 if in_space else 3))
    rates[:, 3 if in_space else 2 :] *= 5.0
    return mr.MasonryCase(masonry, 0.6, velocity=np.vstack([0 * rates[:1], rates]), settled=False)


@pytest.mark.parametrize(
    ("in_space", "seed"), among(list(itertools.product([False, True], SCENES)), (True, 0), (False, 1))
)
def test_blocks_that_fall_on_each_other_stay_apart(seed, in_space):
    """Landing at speed v, a block of size s overlaps by v (density / (k_n s))^1/2 of itself, some thousandths."""
    run = mr.solve_explicit(rain(seed, in_space), output_step=5e-3)
    assert run.stats["overlap"] < 0.01
    over = run.pose[:, :, 2 if in_space else 1] + run.case.masonry.centroids[list(run.case.masonry.free), -1]
    assert over.min() > 0
