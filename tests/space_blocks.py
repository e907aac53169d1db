"""Bodies and masonry in space that the tests of explicit steps share."""

import math

import numpy as np

import mjrock as mr
from mjrock.distinct.loop import Clock
from mjrock.distinct.space.assembly import copied, moving
from mjrock.distinct.space.columns import REST, ease_columns, named, named_vectors
from mjrock.distinct.space.loop import advance
from mjrock.distinct.space.system import BODY, EDGE, LINK, POINT, WAY, System
from mjrock.distinct.system import ALWAYS, Books, Samples, rows
from mjrock.geometry.frames import SPACE
from mjrock.scene.ground import Ground

GROUND = mr.Polyhedron.box((20, 20, 1), (0, 0, -0.5), fixed=True, name="ground")


def free_body(mass, inertia, spin):
    """A body far from everything, with a spin about its axes."""
    inertia = np.asarray(inertia, dtype=float)[None]
    momentum = inertia[0] @ np.asarray(spin)
    columns = ease_columns(inertia) | named(REST, np.zeros((1, 3))) | named_vectors(momentum=momentum)
    bodies, none = rows(BODY, 1, mass=mass, qw=1.0, **columns), rows(LINK, 0)
    return System(
        bodies, rows(POINT, 0), rows(EDGE, 0), rows(WAY, 0), none, none, none, Ground.of(None), moving((), axes=3)
    )


def followed(system, duration, h, every):
    """The samples of a system that is followed without being changed."""
    count = round(duration / (h * every)) + 1
    samples, system = Samples.of(count, len(system.bodies), ALWAYS, SPACE), copied(system)
    advance(system, Books.of(system, 1), samples, Clock(0, h, every, 0, count, math.inf))
    return samples, system


def about_vertical(blocks, angle):
    """Blocks turned about the vertical."""
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return [mr.Polyhedron(block.corners @ turn.T, block.density, block.fixed, block.name) for block in blocks]


def block(size=(0.6, 0.4, 2.0), angle=0.0, ground=GROUND, **options):
    """A block that stands on the ground, turned about the vertical."""
    box = mr.Polyhedron.box(size, (0, 0, 0.5 * size[2]), name="block")
    return mr.Masonry([ground, *about_vertical([box], angle)], **{"k_n": 1e9, "friction": 0.7, "xi": 0.05} | options)


def steady(acceleration, duration, rise=0.0):
    """A ground that accelerates steadily after a rise."""
    t = np.linspace(0, duration, 1001)
    return mr.GroundMotion(acceleration * np.clip(t / rise if rise else 1.0 + t, 0, 1), t[1])


def angles(run):
    """Rotation about y of each body that turns about nothing else [rad]."""
    return 2 * np.arctan2(run.pose[:, :, 5], run.pose[:, :, 3])
