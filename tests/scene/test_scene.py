"""The scene: what it refuses, how its text is made, and that runs share what they can."""

import dataclasses
import math

import mujoco
import numpy as np
import pytest
from scenes import changed, course, fixed_steps, stock_takes, two_blocks

import mjrock as mr
from mjrock.engine.mjcf import scene_mjcf
from mjrock.engine.model import engine_of, released_mjcf
from mjrock.engine.rows import inverse_weights
from mjrock.engine.stepping import fitted_steps
from mjrock.problem.wall.effect import LinkLaw
from mjrock.scene.course import Shaking, ground_velocity, mean_acceleration
from mjrock.scene.parts import Links
from mjrock.scene.wall import wall_scene


@pytest.mark.parametrize(
    ("parts", "complaint"),
    [
        ({"bodies": {"mass": [1.0]}}, r"mass of the bodies has the shape \(1,\); \(2,\) is needed"),
        ({"bodies": {"mass": [1.0, -1.0]}}, "mass of the bodies = -1 is outside the valid range, which is above 0"),
        ({"contacts": {"k": [1.0, math.nan, 1.0, 1.0]}}, "k of the contacts holds a value that is not finite"),
        ({"contacts": {"k": [1.0, 0.0, 1.0, 1.0]}}, "k of the contacts = 0 is outside the valid range, which is above"),
        ({"contacts": {"c": [-1.0, 0.0, 0.0, 0.0]}}, "c of the contacts = -1 is outside the valid range, which starts"),
        ({"contacts": {"friction": [0.0, 0.0, -0.5, 0.0]}}, "friction of the contacts = -0.5 is outside the valid"),
        ({"contacts": {"body": [0, 0, 1, 2]}}, "body of the contacts is outside the valid range 0 to 1"),
        ({"contacts": {"face_body": [-1, -1, 2, 0]}}, "face_body of the contacts is outside the valid range -1 to 1"),
        ({"contacts": {"face_body": [-1, -1, 1, 0]}}, "face_body of the contacts is another body, or -1 for the gro"),
        ({"contacts": {"joint": [0, 0, 1, 2]}}, "joint of the contacts is outside the valid range 0 to 1"),
        ({"contacts": {"at": np.zeros((4, 3))}}, r"at of the contacts has the shape \(4, 3\); \(4, 2\) is needed"),
        ({"contacts": {"normal": [(0, 2), (0, 1), (0, 1), (0, 1)]}}, "normal of the contacts holds a vector that is"),
        ({"contacts": {"joints": ("foot", "lower")}}, "lower names two things of the scene"),
    ],
)
def test_what_cannot_be_is_refused(parts, complaint):
    with pytest.raises(ValueError, match=complaint):
        changed(two_blocks(), **parts)


def test_bodies_that_do_not_stand_are_refused():
    """The upper block rests on two points of its left half: it turns over."""
    scene = two_blocks()
    points = scene.contacts.at.copy()
    points[3, 0] = -0.1
    tipping = changed(scene, contacts={"at": points})
    with pytest.raises(ValueError, match="do not stand on their contacts"):
        _ = tipping.at_rest


def test_the_text_of_many_bodies():
    """Names, joints, and what stock MuJoCo makes of them."""
    scene = two_blocks()
    text, again = released_mjcf(scene, course(scene), 1e-3), two_blocks()
    assert text == released_mjcf(again, course(again), 1e-3)
    model = mujoco.MjModel.from_xml_string(text)
    joints = [model.joint(i).name for i in range(model.njnt)]
    assert joints == ["lower_x", "lower_z", "lower_theta", "upper_x", "upper_z", "upper_theta"]
    assert [model.pair(i).name for i in range(model.npair)] == ["foot_0", "foot_1", "middle_0", "middle_1"]
    assert model.geom("middle").bodyid[0] == model.body("lower").id
    weight = inverse_weights(scene)
    for i in range(4):
        pair = model.pair(i)
        found = mr.contact_stiffness(tuple(pair.solref), tuple(pair.solimp), inverse_weight=weight[i])
        assert found == pytest.approx((scene.contacts.k[i], scene.contacts.c[i]), rel=1e-12)
    assert weight[3] == pytest.approx(2 * weight[0])


def test_stock_mujoco_repeats_the_fixed_steps_of_many_bodies():
    scene = two_blocks()
    lifted = scene.at_rest + np.array([[0, 1e-4, 1e-3], [0, 3e-4, 2e-3]])
    thrown = course(scene, [[0.0, 0.0, 0.0], [0.1, 0.0, 0.2]], 0.05, pose=lifted)
    steps = fixed_steps(scene, thrown, 1e-4)
    stock_takes(steps.pose, released_mjcf(scene, thrown, 1e-4), 1e-13)


def test_a_body_that_is_no_box_is_drawn_as_a_prism():
    """MuJoCo keeps the outline, where it is; the inertia stays the one given."""
    scene = two_blocks()
    trapezium = np.array([(-0.3, -1.05), (0.3, -1.05), (0.2, 1.05), (-0.2, 1.05)])
    shaped = changed(scene, bodies={"outlines": (trapezium, scene.bodies.outlines[1])})
    model = mujoco.MjModel.from_xml_string(scene_mjcf(shaped, 1e-3))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    geom = model.geom("lower")
    vertices = model.mesh_vert[: model.mesh_vertnum[0]] @ data.geom("lower").xmat.reshape(3, 3).T
    placed = vertices + data.geom("lower").xpos - data.body("lower").xpos
    for corner in trapezium:
        assert np.abs(placed[:, [0, 2]] - corner).sum(axis=1).min() < 1e-6
    assert geom.type[0] == mujoco.mjtGeom.mjGEOM_MESH
    assert model.body("lower").mass[0] == scene.bodies.mass[0]
    assert model.body_invweight0[1, 0] == pytest.approx(2 / (3 * scene.bodies.mass[0]))


def test_a_face_that_is_not_level_ground_is_a_plane_of_its_own(one_sided, contacts):
    model = mujoco.MjModel.from_xml_string(mr.wall_mjcf(one_sided, contacts, 1e-3))
    for name, normal in (("base", (0, 0, 1)), ("side", (1, 0, 0))):
        geom = model.geom(name)
        assert geom.type[0] == mujoco.mjtGeom.mjGEOM_PLANE
        turned = np.zeros(3)
        mujoco.mju_rotVecQuat(turned, np.array([0.0, 0.0, 1.0]), geom.quat)
        np.testing.assert_allclose(turned, normal, atol=1e-15)


def test_walls_that_differ_in_release_alone_share_a_model(wall, contacts, monkeypatch):
    from mjrock.engine import model

    compiled = []
    honest = model.Engine.compile.__func__
    monkeypatch.setattr(model, "_idle", model.OrderedDict())
    monkeypatch.setattr(
        model.Engine, "compile", classmethod(lambda cls, scene: compiled.append(scene) or honest(cls, scene))
    )
    motion = mr.GroundMotion.sine(-2.0, 0.5)
    runs = [mr.simulate(mr.Case(wall, 0.02, 0.3, motion=m), contacts) for m in (None, motion, motion.reversed())]
    softer = mr.Contacts.from_damping(wall, k_base=4e8, xi_base=0.02, k_side=5e8, xi_side=0.01)
    mr.simulate(mr.Case(wall, 0.02, 0.3), softer)  # springs and dashpots are set with every step
    assert len(compiled) == 1 or (
        len(compiled) == 2 and compiled[0].contacts.friction[0] != compiled[1].contacts.friction[0]
    )
    monkeypatch.setattr(model, "_idle", model.OrderedDict())
    assert mr.simulate(runs[1].case, contacts) == runs[1]  # in a model of its own


def test_an_engine_whose_run_has_failed_is_not_used_again(wall, contacts):
    scene = wall_scene(mr.Case(wall, 0.03, 0.1), contacts)
    with pytest.raises(RuntimeError, match="in the middle"), engine_of(scene) as failed:
        raise RuntimeError("in the middle")
    with engine_of(scene) as engine:
        assert engine is not failed


def test_the_push_of_the_ground_is_its_impulse():
    """The compiled velocity is that of the motion; its mean acceleration over a window is the exact one."""
    motion = mr.GroundMotion(np.random.default_rng(2).normal(0, 2, 50), 0.013)
    ground = Shaking.from_motion(motion)
    for t in (-0.1, 0.0, 1e-4, 0.2, 0.3334, motion.duration, motion.duration + 1):
        assert ground_velocity(ground, t) == pytest.approx(float(motion.velocity(t)), abs=1e-14)
        for h in (1e-5, 0.02):
            exact = float(motion.velocity(t + h / 2) - motion.velocity(t - h / 2)) / h
            assert mean_acceleration(ground, t, h) == pytest.approx(exact, abs=1e-9)
    assert mean_acceleration(Shaking.from_motion(None), 1.0, 0.1) == 0.0


def test_a_stack_at_rest_stays_at_rest():
    """Two blocks, ten seconds: nothing moves, and the steps grow long."""
    scene = two_blocks()
    still = course(scene, duration=10.0)
    with engine_of(scene) as engine:
        engine.place(still)
        steps = fitted_steps(engine, scene, still, 1e-3)
    assert np.abs(steps.pose - scene.at_rest.ravel()).max() < 1e-12
    assert len(steps.t) < 2000


def test_the_title_says_what_stands(one_sided, contacts):
    wall = one_sided.block
    size = f"{2 * wall.b:g} m thick, {2 * wall.h:g} m high, {wall.length:g} m long, {wall.density:g} kg/m3"
    assert wall_scene(one_sided, contacts).title == f"A masonry wall, {size}, rocking against a side stop"


def test_links_by_what_they_have():
    """A spring, a spring and a dashpot, a dashpot, a spring that also pushes, and neither."""
    names = ("spring", "both", "dashpot", "pushes", "neither")
    at, ends = np.zeros((5, 2)), np.array([(-1.0, 0.0)] * 5)
    spring = LinkLaw(1e3, 1.0, 1e3)
    laws = [spring, spring._replace(c=50.0), LinkLaw(c=50.0), spring._replace(push=1e3), LinkLaw()]
    links = Links(names, [0] * 5, at, [-1] * 5, ends, laws)
    assert links.sprung.names == ("spring", "both", "pushes")
    assert links.bearing.names == ("spring", "both")
    assert links.damped.names == ("both", "dashpot", "neither")
    np.testing.assert_array_equal(links.damped.law["c"], [50.0, 50.0, 0.0])


def test_a_wall_beside_a_stop_with_friction_rests_on_its_base(wall):
    """Its base holds it, and a side that it has left does not: it turns about the middle of its base."""
    contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05, k_side=5e8, xi_side=0.05, side_friction=0.4)
    scene = wall_scene(mr.Case(wall, 0.0, 1.0, effects=(mr.AddedMass(500.0, 4.0, 0.1),)), contacts)
    x, _, theta = scene.at_rest[0]
    assert theta > 1e-5
    assert x == pytest.approx(math.sin(theta) * scene.bodies.rest[0, 1], abs=1e-8)


def test_faces_are_numbered_within_their_joint():
    """Three faces on each of two joints; the first has the name of the joint, and a face that comes again its own."""
    lower = two_blocks().contacts
    faces = [(float(i), 0.0) for i in (0, 1, 0, 2, 1, 1, 2, 0)]
    repeated = "k", "c", "friction", "body", "at", "normal", "k_s", "area", "holds", "joint"
    eight = {name: np.repeat(getattr(lower, name), 2, axis=0) for name in repeated}
    named = dataclasses.replace(lower, **eight, face_body=[-1] * 8, face_at=faces)
    expected = "foot", "foot_face_1", "foot", "foot_face_2", "middle", "middle", "middle_face_1", "middle_face_2"
    assert named.face_names == expected
