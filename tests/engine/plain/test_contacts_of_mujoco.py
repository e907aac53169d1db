"""What plain models rest on: how many points MuJoCo finds between two blocks, and that their law is exact at any lever.

The blocks are 0.2 x 0.1 x 0.1 m and lie 1 um inside each other, or are turned from there.
"""

import mujoco
import numpy as np
import pytest

import mjrock as mr

HALF = np.array([0.1, 0.05, 0.05])
AXES = {"yaw": (0.0, 0.0, 1.0), "tilt": (0.0, 1.0, 0.0)}


def contacts(shape, *, along=0.0, turned="yaw", angle=0.0):
    """The contacts between two blocks as MuJoCo lists them."""
    spec = mujoco.MjSpec()
    spec.option.ccd_tolerance = 1e-9
    corners = HALF * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    spec.add_mesh(name="hull", uservert=corners.ravel())
    for name, height in (("low", 0.0), ("high", 2 * HALF[2] - 1e-6)):
        body = spec.worldbody.add_body(name=name, pos=(0.0, 0.0, height))
        body.add_freejoint()
        if shape == "box":
            body.add_geom(name=name, type=mujoco.mjtGeom.mjGEOM_BOX, size=HALF)
        else:
            body.add_geom(name=name, type=mujoco.mjtGeom.mjGEOM_MESH, meshname="hull")
    spec.add_pair(geomname1="low", geomname2="high")
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[7] += along
    mujoco.mju_axisAngle2Quat(data.qpos[10:14], np.array(AXES[turned]), angle)
    mujoco.mj_forward(model, data)
    return data.contact


def found(shape, **placed):
    """Gaps of the contacts between two blocks [m]."""
    return contacts(shape, **placed).dist.copy()


@pytest.mark.parametrize("shape", ["box", "hull"])
@pytest.mark.parametrize("along", [0.0, 0.1])
def test_faces_that_lie_on_each_other_meet_at_four_points(shape, along):
    """Also in running bond. Corners of a hull have the digits of a float: 1.5e-9 m of 0.1 m."""
    np.testing.assert_allclose(found(shape, along=along), np.full(4, -1e-6), atol=2e-9)


def test_a_box_that_is_turned_in_its_face_has_twice_as_many_points_and_a_hull_has_not():
    """So a joint of boxes that has turned is twice as stiff, which docs/plain_models.md says."""
    assert len(found("box", angle=1e-3)) == 8
    assert len(found("hull", angle=1e-3)) == 4


@pytest.mark.parametrize("shape", ["box", "hull"])
def test_a_block_on_its_edge_meets_at_two_points(shape):
    assert len(found(shape, turned="tilt", angle=1e-3)) == 2


@pytest.mark.parametrize(
    ("shape", "angle", "leans"), [("box", 0.05, 0), ("hull", 0.05, 0.05), ("hull", 0.08, 0.08), ("hull", 0.1, 0)]
)
def test_normals_of_hulls_that_nearly_lie_flat_are_those_of_the_second_one(shape, angle, leans):
    """The upper block, the second one, stands on its edge: the face of the lower one bears, and its normal is right.
    MuJoCo takes the face of the second hull up to 5.2 degrees."""
    normal = contacts(shape, turned="tilt", angle=angle).frame[0, :3]
    assert np.arctan2(abs(normal[0]), abs(normal[2])) == pytest.approx(leans, abs=1e-6)


@pytest.mark.parametrize("lever", [0.0, 0.3, 2.0])
def test_the_law_of_a_pair_is_exact_whatever_the_lever(lever):
    """f = -(k r + c v + m a) at a sphere on the arm of a body, m = h c / 2 + h^2 k / 4, with v and a of the point."""
    k, c, h, depth = 3e6, 2e3, 1e-4, 1e-5
    spec = mujoco.MjSpec()
    spec.option.timestep, spec.option.tolerance, spec.option.gravity = h, 1e-14, (0.0, 0.0, 0.0)
    spec.worldbody.add_geom(name="ground", type=mujoco.mjtGeom.mjGEOM_PLANE, size=(10, 10, 1))
    body = spec.worldbody.add_body(name="arm", pos=(0.0, 0.0, 0.5))
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=(0.4, 0.4, 0.4), mass=50.0, contype=0, conaffinity=0)
    body.add_geom(
        name="tip", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=(0.1, 0, 0), pos=(lever, 0, -0.4 - depth), mass=0.0
    )
    pair = spec.add_pair(geomname1="tip", geomname2="ground")
    pair.condim = 1
    weight = float(spec.compile().body_invweight0[1, 0])
    parameters = mr.contact_parameters(k, c, timestep=h, inverse_weight=weight)
    pair.solref, pair.solimp = parameters.solref, parameters.solimp
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[2] = -0.2
    mujoco.mj_forward(model, data)
    rate = float(data.efc_J.reshape(data.nefc, -1)[0] @ data.qvel)
    change = float(data.efc_J.reshape(data.nefc, -1)[0] @ data.qacc)
    expected = -(k * data.contact.dist[0] + c * rate + parameters.inertia * change)
    assert data.efc_force[0] == pytest.approx(expected, rel=1e-9)
