"""Scenes of space that several tests use, and how they are stepped."""

import itertools

import numpy as np

import mjrock as mr
from mjrock.engine import stepping
from mjrock.engine.mjcf import pair_rows
from mjrock.engine.model import engine_of
from mjrock.scene.course import Course
from mjrock.scene.parts import Bodies, ContactPoints


def box(size, *, k_n=1e8, xi=0.05, friction=0.6, density=2000.0, turned=None, height=None, tensor=None, **parts):
    """A box with a contact at each corner of its base, on ground that is turned with it by a rotation (3, 3) if any.

    The damping ratio refers to the heave on all four springs.
    """
    half, turn = np.array(size) / 2, np.eye(3) if turned is None else turned
    mass = density * np.prod(size)
    vertices = np.array(list(itertools.product(*([-1, 1] for _ in range(3))))) * half
    inertia = mass / 3 * np.diag((half**2).sum() - half**2)
    k = np.full(4, k_n * size[0] * size[1] / 4)
    c = 2 * xi * np.sqrt(mass / k.sum()) * k
    rest = turn[:, 2] * (half[2] if height is None else height)
    tensor = turn @ inertia @ turn.T if tensor is None else tensor
    bodies = Bodies(("block",), [mass], [tensor], [rest], (vertices @ turn.T,), length=size[1])
    contacts = ContactPoints(
        body=[0] * 4,
        at=(vertices @ turn.T)[vertices[:, 2] < 0],
        face_body=[-1] * 4,
        face_at=[(0, 0, 0)] * 4,
        normal=[turn[:, 2]] * 4,
        k=k,
        c=c,
        friction=[friction] * 4,
        joint=[0] * 4,
        joints=("base",),
    )
    return mr.Scene(bodies, contacts, **parts)


def course(scene, duration, *, pose=None, velocity=None, **motions):
    """The course of a scene of one body from a pose (7,) and with a velocity (6,), at rest where they are None."""
    pose = scene.at_rest if pose is None else np.reshape(pose, (-1, 7))
    velocity = np.zeros((len(scene.bodies.names), 6)) if velocity is None else np.reshape(velocity, (-1, 6))
    return Course(pose, velocity, duration, **motions)


def fixed(scene, what, timestep, *, beta=0.25, coulomb=False):
    """Steps of one length."""
    with engine_of(scene) as engine:
        engine.set_step(timestep, pair_rows(scene, timestep, beta))
        engine.release(what)
        return stepping.fixed_steps(engine, scene, what, beta, coulomb=coulomb)


def fitted(scene, what, accuracy=1e-3, *, coulomb=True):
    """Steps that fit the motion."""
    with engine_of(scene) as engine:
        engine.place(what)
        return stepping.fitted_steps(engine, scene, what, accuracy, coulomb=coulomb)
