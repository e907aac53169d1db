"""Scenes that several tests use."""

import dataclasses

import mujoco
import numpy as np

import mjrock as mr
from mjrock.engine import stepping
from mjrock.engine.mjcf import pair_rows
from mjrock.engine.model import engine_of
from mjrock.scene.course import Course
from mjrock.scene.parts import Bodies, ContactPoints, Limits


def changed(scene, **parts):
    """A scene with other parts, or with parts of which some fields are others, as a dict."""
    made = {}
    for name, part in parts.items():
        made[name] = dataclasses.replace(getattr(scene, name), **part) if isinstance(part, dict) else part
    return dataclasses.replace(scene, **made)


def fixed_steps(scene, course, timestep):
    """The fixed steps of a scene."""
    with engine_of(scene) as engine:
        engine.set_step(timestep, pair_rows(scene, timestep, 0.25))
        engine.release(course)
        return stepping.fixed_steps(engine, scene, course, 0.25)


def stock_takes(poses, text, atol):
    """Stock MuJoCo, released as a text says, takes these poses; what it ends with."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for pose in poses:
        np.testing.assert_allclose(data.qpos, np.ravel(pose), rtol=0, atol=atol)
        mujoco.mj_step(model, data)
    return data


def course(scene, velocity=None, duration=1.0, motion=None, *, pose=None, vertical=None):
    """The course of a scene that starts at rest, or with a pose and a velocity of shape (n, 3)."""
    pose = scene.at_rest if pose is None else np.asarray(pose, dtype=float)
    velocity = np.zeros_like(scene.at_rest) if velocity is None else np.asarray(velocity, dtype=float)
    return Course(pose, velocity, duration, motion, vertical)


def unbalanced(scene):
    """Forces that are missing at rest, with those of friction, shape (n nv,), and friction over its limit [N]."""
    potential, (pose, drag) = scene.potential, scene.rest_state
    pose = pose.ravel()
    held = sum(rates.T @ along for rates, along in zip(potential.slip_rates(pose), drag.T, strict=True))
    limit = scene.contacts.friction * scene.contacts.k * scene.bears
    return held - potential.gradient(pose), np.linalg.norm(drag, axis=1) - limit


def two_blocks(k_n=5e8, friction=0.7, xi=0.049, *, width=0.6, height=2.1):
    """Two equal blocks one on the other, 1 m long, of 2000 kg/m3, with two lines a joint.

    The damping ratio refers to the rocking of what stands on a joint about the middle of that joint.
    """
    b, h = width / 2, height / 2
    mass = 2000.0 * width * height
    inertia = mass * (width**2 + height**2) / 12
    k = k_n * b * np.ones(4)
    c = np.empty(4)
    for joint, above in ((slice(0, 2), 2), (slice(2, 4), 1)):
        half = above * h
        about_base = above * mass * (width**2 + (2 * half) ** 2) / 12 + above * mass * half**2
        c[joint] = 2 * xi / np.sqrt(k[joint].sum() * b**2 / about_base) * k[joint]
    outline = np.array([(-b, -h), (b, -h), (b, h), (-b, h)])
    return mr.Scene(
        Bodies(("lower", "upper"), [mass] * 2, [inertia] * 2, [(0, h), (0, 3 * h)], (outline, outline), length=1.0),
        ContactPoints(
            body=[0, 0, 1, 1],
            at=[(-b, -h), (b, -h), (-b, -h), (b, -h)],
            face_body=[-1, -1, 0, 0],
            face_at=[(0, 0), (0, 0), (0, h), (0, h)],
            normal=[(0, 1)] * 4,
            k=k,
            c=c,
            friction=[friction] * 4,
            joint=[0, 0, 1, 1],
            joints=("foot", "middle"),
        ),
        limits=Limits(float(np.hypot(width, 2 * height)), height, damped_joints=True),
    )
