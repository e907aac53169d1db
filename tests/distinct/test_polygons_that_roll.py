"""Polygons on long ground: rimless wheels against their closed form, and how deep thrown ones sink."""

import math
from itertools import cycle

import numpy as np
import pytest
from everyday import among, slow
from masonry_blocks import box
from wheels import RADIUS, rolling, slope_of, wheel_on

import mjrock as mr
from mjrock.distinct.search import contact_search

WHEELS = [(12, 0.5), slow((24, 0.5)), *map(slow, zip(range(5, 25), cycle((0.5, 5.0, 50.0)), strict=False))]
"""Sides of wheels, and how far the ground goes on behind them [m]."""


def rolls(sides, behind, others=(), *, falls=5.0, **options):
    """The run of a wheel by explicit steps, and the closed form of its rate."""
    case, rate = rolling(sides, behind, others, falls=falls)
    return mr.solve_explicit(case, output_step=1e-4, **options), rate


def sinks(run, turn):
    """How deep the corners of the wheel lie below the ground [m], shape (samples,)."""
    corners = np.array(run.case.masonry.blocks[1].vertices) - run.case.masonry.centroids[1]
    at = run.pose[:, 0, :2] + run.case.masonry.centroids[1]
    cosine, sine = np.cos(run.pose[:, 0, 2])[:, None], np.sin(run.pose[:, 0, 2])[:, None]
    x = at[:, :1] + corners[:, 0] * cosine + corners[:, 1] * sine
    z = at[:, 1:] - corners[:, 0] * sine + corners[:, 1] * cosine
    return -(turn[0, 1] * x + turn[1, 1] * z).min(axis=1)


@pytest.mark.parametrize(("sides", "behind"), WHEELS)
def test_a_rimless_wheel_rolls_at_its_closed_form_speed(sides, behind):
    """Its rates before impacts, from the third on, are within 0.2 %: a sample is at most 0.1 ms before each, in which
    the rate grows by 0.05 % at most."""
    run, rate = rolls(sides, behind, falls=14.0 if sides == 5 else 5.0)
    turned = run.pose[:, 0, 2] / (2 * math.pi / sides)
    later = run.velocity[turned > 2, 0, 2]
    assert turned[-1] > 3
    assert later.max() == pytest.approx(rate, rel=2e-3)
    assert sinks(run, wheel_on(slope_of(sides), sides, behind)[1]).max() < 2e-3 * RADIUS
    assert run.stats["overlap"] < 1e-3


def test_a_wheel_rolls_alike_whatever_lies_beside_it():
    """On ground that ends 5 or 50 m behind it, and with blocks on this ground that it never meets.

    The step is below half of the longest stable one of all, so that dashpots look ahead in each run."""
    beside = [(-3.0, -2.95, 0.0, 0.05), (-4.0, -3.9, 0.0, 0.1), (-4.9, -4.2, 0.0, 0.7)]
    given = {"timestep": 4e-6, "falls": 1.0}
    alone, _ = rolls(12, 5.0, **given)
    for behind, others in ((50.0, ()), (5.0, beside)):
        run, _ = rolls(12, behind, others, **given)
        np.testing.assert_allclose(run.pose[:, 0], alone.pose[:, 0], atol=1e-10)


def thrown(seed):
    """A random convex polygon that stands on one of its sides, the ground behind it, and how fast it is thrown."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * math.pi, rng.integers(5, 11)))
    while np.diff([*angles, angles[0] + 2 * math.pi]).max() > 2.0:
        angles = np.sort(rng.uniform(0, 2 * math.pi, rng.integers(5, 11)))
    corners = np.column_stack([0.3 * np.cos(angles), 0.21 * np.sin(angles)])
    side = rng.integers(len(corners))
    along = np.roll(corners, -1, axis=0)[side] - corners[side]
    c, s = along / np.linalg.norm(along)
    corners = (corners - corners[side]) @ np.array([[c, -s], [s, c]])
    return corners, rng.choice([0.6, 2.0, 5.0]), (1.5, 0.0, rng.uniform(2, 6))


@pytest.mark.filterwarnings("ignore:dashpots, c/k")
@pytest.mark.parametrize("seed", among(range(12), 3))
def test_a_polygon_that_is_thrown_sinks_by_no_more_than_the_overlap_of_its_landing(seed):
    """One line has at least half of what the joint has on which it stood, and stops no more than all of the mass at the
    speed that it would have from all of its energy."""
    corners, behind, velocity = thrown(seed)
    blocks = [box(-behind, 30, -1, 0, fixed=True), mr.Polygon(corners)]
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.7, xi=0.5)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 1.0, velocity=[velocity], settled=False), output_step=2e-3)
    mass, inertia = blocks[1].mass, blocks[1].inertia
    energy = 0.5 * mass * velocity[0] ** 2 + 0.5 * inertia * velocity[2] ** 2
    energy += mass * mr.GRAVITY * (masonry.centroids[1][1])
    landing = math.sqrt(2 * energy / (0.5 * 1e9 * masonry.joints[0].width))
    on_the_ground = (run.pose[:, 0, 0] + masonry.centroids[1][0] > 0.6 - behind).nonzero()[0]
    assert sinks(run, np.eye(2))[on_the_ground].max() < landing


@pytest.mark.parametrize("sides", [4, 8, 12, 24, 60])
def test_a_joint_ends_before_the_next_side_of_a_polygon_lands(sides):
    """At half the angle to it. A side that goes straight on, as that of ground in two parts, is none."""
    blocks, _ = wheel_on(0.0, sides, 1.0)
    parts = mr.Compound([box(-1.0, 0.0, -1.0, 0.0), box(0.0, 20.0, -2.0, 0.0)], fixed=True, name="parts")
    for ground in (blocks[0], parts):
        masonry = mr.Masonry([ground, blocks[1]], points=2)
        width = sum(joint.width for joint in masonry.joints)
        standing = mr.MasonryCase(masonry, 1.0).rest_geometry
        np.testing.assert_allclose(contact_search._rolling_limits(standing), 1 - math.cos(math.pi / sides), rtol=1e-9)
        assert width == pytest.approx(2 * RADIUS * math.sin(math.pi / sides))
