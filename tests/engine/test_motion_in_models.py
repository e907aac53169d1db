"""A motion of any solver, placed in the model of its case body by body, as docs/results.md shows it."""

import mujoco
import numpy as np
import pytest

import mjrock as mr

FALLING = mr.GroundMotion.half_sine(-6.0, 0.3)
SPACE = mr.Masonry.column(width=0.5, height=2.0, drums=2, k_n=1e8)
PLANE = mr.Masonry.stack([mr.Block.from_size(0.5, 1.0), mr.Block.from_size(0.5, 0.8)], k_n=1e8)


@pytest.mark.parametrize("masonry", [PLANE, SPACE], ids=["plane", "space"])
@pytest.mark.parametrize("collisions", [True, False])
def test_a_motion_is_that_of_the_model(masonry, collisions):
    """Blocks are where the response has them, to the radius of the spheres that stand for contact points."""
    case = mr.MasonryCase(masonry, duration=0.3, motion=FALLING)
    answer = mr.solve_explicit(case)
    model = mujoco.MjModel.from_xml_string(mr.mjcf_of(case, None, timestep=1e-3, collisions=collisions))
    data, space = mujoco.MjData(model), case.in_space
    rest = model.qpos0.reshape(answer.pose[0].shape).copy()
    rest[:, 3:] = 0.0
    assert np.abs(answer.pose[-1]).max() > 1e-3
    for pose in answer.pose[[0, -1]]:
        data.qpos[:] = (rest + pose).ravel()
        mujoco.mj_forward(model, data)
        places = np.array([data.body(name).xipos for name in answer.bodies])[:, [0, 1, 2] if space else [0, 2]]
        d = places.shape[1]
        np.testing.assert_allclose(places, masonry.centroids[list(masonry.free)] + pose[:, :d], atol=1e-5)
        for name, way in zip(answer.bodies, pose[:, d:], strict=True):
            turn = way if space else [np.cos(0.5 * way[0]), 0.0, np.sin(0.5 * way[0]), 0.0]
            np.testing.assert_allclose(data.body(name).xquat, turn, atol=1e-9)
