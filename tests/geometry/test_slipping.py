"""Where two bodies meet gives the rates that the kinematics give, and a force there the work that its way takes."""

import numpy as np
import pytest
from scenes import two_blocks

import mjrock as mr
from mjrock.engine.sliding import slipping
from mjrock.geometry.frames import frames_of
from mjrock.geometry.kinematics import depth, gap, meeting, push_apart, relative_velocity, where_friction_acts
from mjrock.geometry.vectors import dot, scaled, tangent


def arch():
    return mr.masonry_scene(mr.MasonryCase(mr.Masonry.arch(5.0, 0.75, voussoirs=5), 1.0))


@pytest.fixture(scope="module", params=[two_blocks, arch], ids=["stack", "arch"])
def scene(request):
    return request.param()


def test_rates_are_those_of_the_kinematics(scene):
    """Of the gap at the arms to the place of friction too: along the normal a body moves there as at the point."""
    rng, places = np.random.default_rng(1), scene.places
    for _ in range(20):
        pose = scene.at_rest.ravel() + rng.normal(0, 0.2, scene.bodies.masses.shape)
        velocity, frames = rng.normal(size=pose.shape), frames_of(pose)
        for i in range(len(scene.contacts.k)):
            meets = where_friction_acts(places, meeting(places, i, frames))
            between = gap(places, i, frames, velocity, velocity)
            assert meets.gap == pytest.approx(between.value, abs=1e-14)
            assert meets.gap == pytest.approx(-depth(places, i, frames), abs=1e-14)
            opening = dot(meets.normal, relative_velocity(places, i, meets, frames, velocity))
            assert opening == pytest.approx(between.rate, abs=1e-13)
            slip = dot(tangent(meets.normal), relative_velocity(places, i, meets, frames, velocity))
            assert slipping(places, i, meets, frames, velocity).speed == pytest.approx(slip, abs=1e-13)


def test_the_power_of_a_force_along_a_face_is_force_times_slip(scene):
    rng, places = np.random.default_rng(2), scene.places
    pose = scene.at_rest.ravel() + rng.normal(0, 0.2, scene.bodies.masses.shape)
    velocity, frames = rng.normal(size=pose.shape), frames_of(pose)
    for i in range(len(scene.contacts.k)):
        meets, applied = where_friction_acts(places, meeting(places, i, frames)), np.zeros_like(pose)
        push_apart(places, i, meets, frames, scaled(-3.0, tangent(meets.normal)), applied)
        power = -3.0 * slipping(places, i, meets, frames, velocity).speed
        assert applied @ velocity == pytest.approx(power, rel=1e-12)


def test_the_power_of_a_force_out_of_a_face_is_force_times_rate(scene):
    rng, places = np.random.default_rng(3), scene.places
    pose = scene.at_rest.ravel() + rng.normal(0, 0.2, scene.bodies.masses.shape)
    velocity, frames = rng.normal(size=pose.shape), frames_of(pose)
    for i in range(len(scene.contacts.k)):
        meets, applied = meeting(places, i, frames), np.zeros_like(pose)
        push_apart(places, i, meets, frames, scaled(5.0, meets.normal), applied)
        rate = gap(places, i, frames, velocity, velocity).rate
        assert applied @ velocity == pytest.approx(5.0 * rate, rel=1e-12)
