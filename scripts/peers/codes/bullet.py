"""PyBullet: a free box on a box, against a second box."""

from __future__ import annotations

import math
import time

import numpy as np
import pybullet

from .question import GRAVITY, Motion, Question

FRICTION = 30.0
"""Of a base that holds, but 1 with the defaults; the stop is smooth."""
FAR = 5.0
"""Half the size of the base and the stop [m]."""


def run(question: Question, variant: str, h: float) -> tuple[Motion, float]:
    """The motion at a step h [s] and the wall time [s], the making of the world excluded."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        wall = _world(question, variant, h, client)
        stride, count = question.samples(h)
        found = np.empty((count, 2))
        started = time.perf_counter()
        for n in range(count):
            turned = pybullet.getBasePositionAndOrientation(wall, client)[1]
            found[n] = 2 * math.atan2(turned[1], turned[3]), pybullet.getBaseVelocity(wall, client)[1][1]
            for _ in range(stride):
                pybullet.stepSimulation(client)
        seconds = time.perf_counter() - started
    finally:
        pybullet.disconnect(client)
    return (h * stride * np.arange(count), found[:, 0], found[:, 1]), seconds


def _world(question: Question, variant: str, h: float, client: int) -> int:
    """The wall, released; the number of its body."""
    pybullet.setGravity(0, 0, -GRAVITY, client)
    pybullet.setTimeStep(h, client)
    b, height, length = question.thickness / 2, question.height / 2, question.length / 2
    base = _box((FAR, FAR, FAR), (0, 0, -FAR), client)
    bodies = {"base": base}
    if question.side_stop:
        bodies["stop"] = _box((FAR, FAR, FAR), (-b - FAR, 0, 0), client)
    shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=(b, length, height), physicsClientId=client)
    across, up = question.centroid(settled=variant == "stiffness and damping")
    wall = int(
        pybullet.createMultiBody(
            question.mass,
            shape,
            basePosition=(across, 0, up),
            baseOrientation=(0, math.sin(question.theta0 / 2), 0, math.cos(question.theta0 / 2)),
            physicsClientId=client,
        )
    )
    pybullet.changeDynamics(wall, -1, lateralFriction=1, physicsClientId=client)
    held = 1.0 if variant == "defaults" else FRICTION
    pybullet.changeDynamics(base, -1, lateralFriction=held, physicsClientId=client)
    if question.side_stop:
        pybullet.changeDynamics(bodies["stop"], -1, lateralFriction=0, physicsClientId=client)
    if variant != "defaults":
        pybullet.changeDynamics(wall, -1, linearDamping=0, angularDamping=0, physicsClientId=client)
        pybullet.setPhysicsEngineParameter(
            numSolverIterations=200,
            solverResidualThreshold=0,
            restitutionVelocityThreshold=1e-3,
            physicsClientId=client,
        )
    if variant == "restitution":
        pybullet.setPhysicsEngineParameter(contactERP=0.02, contactBreakingThreshold=1e-4, physicsClientId=client)
        pybullet.changeDynamics(wall, -1, restitution=1, physicsClientId=client)
        if question.side_stop:
            pybullet.changeDynamics(bodies["stop"], -1, restitution=question.e, physicsClientId=client)
    if variant == "stiffness and damping":
        values = {"base": (question.k_base, question.c_base), "stop": (question.k_side, question.c_side)}
        for name, body in bodies.items():  # each of the two corners of an edge carries half
            k, c = values[name]
            pybullet.changeDynamics(body, -1, contactStiffness=k / 2, contactDamping=c / 2, physicsClientId=client)
    return wall


def _box(half: tuple[float, float, float], place: tuple[float, float, float], client: int) -> int:
    """A fixed box."""
    shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half, physicsClientId=client)
    return int(pybullet.createMultiBody(0, shape, basePosition=place, physicsClientId=client))
