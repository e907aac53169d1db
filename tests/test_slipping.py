"""Levers give the rates that the kinematics give, and a force along a face the work that its slip takes."""

import numpy as np
import pytest
from mjrock.engine.levers import levers_of, opening, rub, slipping
from scenes import two_blocks

import mjrock as mr
from mjrock.geometry.frames import frames_of
from mjrock.geometry.kinematics import along, gap

ARCH = mr.masonry_scene(mr.MasonryCase(mr.Masonry.arch(5.0, 0.75, voussoirs=5), 1.0))


@pytest.mark.parametrize("scene", [two_blocks(), ARCH], ids=["stack", "arch"])
def test_rates_are_those_of_the_kinematics(scene):
    rng = np.random.default_rng(1)
    for _ in range(20):
        pose = scene.at_rest.ravel() + rng.normal(0, 0.2, scene.masses.shape)
        velocity, frame = rng.normal(size=pose.shape), frames_of(pose)
        for i in range(len(scene.k)):
            levers = levers_of(scene.points, i, frame)
            between, rate, _, _ = gap(scene.places, i, frame, velocity, velocity)
            assert levers.gap == pytest.approx(between, abs=1e-14)
            assert opening(scene.points, i, levers, velocity) == pytest.approx(rate, abs=1e-13)
            slip = along(scene.places, i, frame, velocity)[2]
            assert slipping(scene.points, i, levers, velocity) == pytest.approx(slip, abs=1e-13)


@pytest.mark.parametrize("scene", [two_blocks(), ARCH], ids=["stack", "arch"])
def test_the_power_of_a_force_along_a_face_is_force_times_slip(scene):
    rng = np.random.default_rng(2)
    pose = scene.at_rest.ravel() + rng.normal(0, 0.2, scene.masses.shape)
    velocity, frame = rng.normal(size=pose.shape), frames_of(pose)
    for i in range(len(scene.k)):
        levers, applied = levers_of(scene.points, i, frame), np.zeros_like(pose)
        rub(scene.points, i, levers, -3.0, applied)
        assert applied @ velocity == pytest.approx(-3.0 * slipping(scene.points, i, levers, velocity), rel=1e-12)
