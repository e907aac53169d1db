"""Ties and dampers between two blocks of the plane act on both, as they do in space."""

import numpy as np
import pytest
from by_hand import alone
from masonry_blocks import GROUND, box
from scenes import changed

import mjrock as mr
from mjrock.distinct.assembly import at_pose, system_of
from mjrock.distinct.kinds.lists import links_of
from mjrock.distinct.loop import Clock, advance
from mjrock.distinct.stable_step import longest_step
from mjrock.distinct.system import Books, Samples
from mjrock.scene.masonry import scene_of_masonry

K, C, GAP, SPEED = 1e5, 50.0, 1.5, 0.4


def tied():
    """Two blocks on smooth ground, a tie and a damper from one to the other at the height of their centroids."""
    blocks = [GROUND, box(-1.25, -0.75, 0, 0.3), box(0.75, 1.25, 0, 0.3)]
    masonry = mr.Masonry(blocks, k_n=1e8, friction=0.0, frequency=100.0)
    tie, damper = mr.Tie(0.15, K, length=GAP, block=2), mr.Damper(0.15, c=C, length=GAP, block=2)
    scene = scene_of_masonry(masonry, (tie, damper))
    case = mr.MasonryCase(masonry, 1.0, effects=(tie, damper))
    return changed(scene, links={"anchor_body": [0, 0], "anchor_at": [(0.25, 0.0)] * 2}), case


def test_a_tie_and_a_damper_between_two_blocks_of_the_plane_pull_both():
    scene, case = tied()
    system = system_of(scene, ended=True)
    system = system._replace(links=links_of(scene, case, system.bodies)[1])
    assert system.links[0].rows["between"][0] == pytest.approx([GAP, 0.0])
    velocity = np.array([[0.0, 0.0, 0.0], [SPEED, 0.0, 0.0]])
    at_pose(system, scene.at_rest, velocity)
    h = 0.2 * longest_step(system)
    books, count = Books.empty(system, 3), 600
    samples = Samples.room(count + 1, system, books, ledger=True)
    clock = Clock(
        h=h,
        steps_per_sample=5,
        stop=5 * count + 1,
        last=5 * count,
        ground_acceleration_before=(0.0,) * len(system.axes),
    )
    advance(system, books, samples, clock, alone(system))
    mass = scene.bodies.mass[0]
    samples = samples.chosen(slice(-1))
    np.testing.assert_allclose(samples.velocity[:, :, 0].sum(axis=1), SPEED, atol=1e-9)  # momentum
    apart = samples.pose[:, 1, 0] - samples.pose[:, 0, 0]
    relative_velocity = samples.velocity[:, 1, 0] - samples.velocity[:, 0, 0]
    t, w, decay = 5 * h * np.arange(count + 1), np.sqrt(2 * K / mass), C / mass
    taut = t < 0.9 * np.pi / w
    turning = np.sqrt(w**2 - decay**2)
    exact = SPEED / turning * np.exp(-decay * t) * np.sin(turning * t)
    assert taut.sum() > 20
    np.testing.assert_allclose(apart[taut], exact[taut], atol=2e-3 * exact.max())
    assert relative_velocity.min() < -0.1
    energy = samples.energy
    taken = samples.links[:, system.links[1].rows[0].account] + samples.dashpots.sum(axis=1)
    whole = energy["kinetic"] + energy["potential"] + energy["elastic"] + taken
    assert np.ptp(whole) < 1e-3 * energy["kinetic"][0]
