"""What has fallen when a run ends, and what stands again."""

import numpy as np
import pytest
from everyday import crossed
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.result.joint_motion import joint_motion
from mjrock.scene.masonry import scene_of_masonry

SOLVERS = [mr.simulate, mr.solve_explicit]
TABLE = box(-1, 0, 0, 1, fixed=True, name="table")


def drums(in_space):
    """Two drums of 0.2 m, one on the other."""
    if in_space:
        return mr.Masonry.column(0.2, 0.4, 2, k_n=1e8, friction=0.6, xi=0.3)
    return mr.Masonry([GROUND, box(-0.1, 0.1, 0, 0.2), box(-0.1, 0.1, 0.2, 0.4)], k_n=1e8, friction=0.6, xi=0.3)


@pytest.mark.parametrize(("solver", "in_space", "duration"), crossed(SOLVERS, [False, True], [0.2, 1.8]))
def test_a_drum_that_hops_has_not_fallen(duration, in_space, solver):
    """Its joint opens by 0.9 of its width. It is at the top as the short run ends, and stands again after the other."""
    upwards = np.zeros((2, 6 if in_space else 3))
    upwards[1, 2 if in_space else 1] = 1.9
    run = solver(mr.MasonryCase(drums(in_space), duration, velocity=upwards))
    assert run.opening[1] == pytest.approx(0.184, abs=1e-3)
    assert dict(run.fallen) == {}
    assert run.outcome is (mr.Outcome.TIME_ENDED if duration < 0.5 else mr.Outcome.AT_REST)


@pytest.mark.parametrize("turned", [0.0, 0.5])
def test_a_joint_has_parted_where_its_faces_are_apart_by_a_tenth_of_its_width(turned):
    """At their nearest point: a block that rocks about its corner has not parted from the ground."""
    masonry = mr.Masonry([GROUND, box(-0.2, 0.2, 0, 0.6)], k_n=1e8, friction=0.6, xi=0.3)
    case = mr.MasonryCase(masonry, 1.0)
    down = 0.3 - 0.3 * np.cos(turned) - 0.2 * np.sin(turned)  # its lower corner comes up by so much as it turns
    pose = np.array([(0.0, lift - down, turned) for lift in (0.0, 0.039, 0.041, 0.079)])
    record = joint_motion(case, scene_of_masonry(masonry), np.arange(4.0), pose)
    np.testing.assert_array_equal(record.parted[:, 0], [False, False, True, True])


def test_an_arch_that_stands_on_spread_supports_has_not_fallen():
    """Its crown has come down by more than a voussoir is large."""
    t = np.linspace(0.0, 4.0, 101)
    spread = 0.9 * 0.2356 * 5.0 * (3 * (t / 4) ** 2 - 2 * (t / 4) ** 3)
    arch = mr.Masonry.arch(5.0, 1.0, voussoirs=20, friction=1.5, k_n=3e8, xi=0.3)
    case = mr.MasonryCase(arch, 4.6, supports={"right_abutment": (t, spread, 0 * t)})
    run = mr.solve_explicit(case, output_step=2e-2)
    assert np.abs(run.velocity[-1]).max() < 1e-3
    assert -run.pose[-1, :, 1].min() > arch.blocks[10].size
    assert dict(run.fallen) == {}


@pytest.mark.parametrize("seconds", [8.0, 0.5])
def test_a_block_on_ground_that_sinks_has_not_fallen(seconds):
    """It sinks by 50 m with the ground, which soon is far below a block that falls freely."""
    t = np.linspace(0.0, seconds, 401)
    s = t / seconds
    masonry = mr.Masonry([GROUND, box(-0.3, 0.3, 0, 1.2)], k_n=1e7, xi=0.3)
    case = mr.MasonryCase(masonry, seconds + 0.4, supports={"ground": (t, 0 * t, -50.0 * (3 * s**2 - 2 * s**3))})
    run = mr.solve_explicit(case, output_step=0.01)
    assert run.pose[-1, 0, 1] < -1.2
    assert dict(run.fallen) == {}


def thrown(duration):
    """A box that leaves its table upwards at 3 m/s and sideways at 2 m/s, with its joint gone."""
    masonry = mr.Masonry([GROUND, TABLE, box(-0.5, -0.1, 1, 1.3, name="box")], k_n=1e8, friction=0.5, xi=0.2)
    return mr.solve_explicit(mr.MasonryCase(masonry, duration, velocity=[(2.0, 3.0, 0.0)]), output_step=1e-3)


@pytest.mark.filterwarnings("ignore:ground and box lie inside each other")
def test_a_block_in_flight_falls_when_it_is_lower_than_it_stood_by_half_its_height():
    """Above that it may yet stand again, and what became so and did not remain so does not count."""
    below = (3.0 + np.sqrt(9.0 + 2 * mr.GRAVITY * 0.15)) / mr.GRAVITY
    assert dict(thrown(below - 0.01).fallen) == {}
    assert dict(thrown(1.5).fallen) == {"box": pytest.approx(below, abs=2e-3)}


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_block_that_lies_on_its_face_beside_its_joint_has_fallen(solver):
    """Its toe is still on the joint. A cube that rocks beyond 45 degrees would not have."""
    masonry = mr.Masonry([GROUND, box(-0.3, 0.3, 0, 0.8, name="block")], k_n=1e8, friction=0.8, xi=0.3)
    run = solver(mr.MasonryCase(masonry, 1.2, velocity=[(1.2, 0.9, 3.0)]))
    assert list(run.fallen) == ["block"]
    tilt = np.interp(run.fallen["block"], run.t, run.theta[:, 0])
    assert tilt == pytest.approx(np.pi / 4, abs=0.02)


def test_in_mujoco_a_block_that_slid_off_its_joint_counts_as_fallen_at_once():
    """Faces have no end there."""
    masonry = mr.Masonry([GROUND, TABLE, box(-0.5, -0.1, 1, 1.3, name="box")], k_n=1e8, friction=0.2, xi=0.2)
    run = mr.simulate(mr.MasonryCase(masonry, 0.6, velocity=[(2.5, 0.0, 0.0)]))
    assert list(run.fallen) == ["box"]
    assert np.interp(run.fallen["box"], run.t, run.pose[:, 0, 0]) == pytest.approx(0.5, abs=0.01)
    assert np.abs(run.pose[-1, 0, 1]) < 1e-3
