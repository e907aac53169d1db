"""Bodies and masonry in space that the tests of explicit steps share."""

import math

import numpy as np

import mjrock as mr
from mjrock.distinct.assembly import copied
from mjrock.distinct.kinds.actuators import Actuators
from mjrock.distinct.kinds.lists import KINDS, no_laws
from mjrock.distinct.loop import Clock, advance
from mjrock.distinct.rows import kinds
from mjrock.distinct.supports import moving
from mjrock.distinct.system import Books, Samples, System
from mjrock.distinct.thread import threads_of
from mjrock.geometry.frames import SPACE
from mjrock.rows import rows
from mjrock.scene.course import Ground

GROUND = mr.Polyhedron.box((20, 20, 1), (0, 0, -0.5), fixed=True, name="ground")


def free_body(mass, inertia, spin):
    """A body far from everything, with a spin about its axes, in tables as those of a run, whose loop serves."""
    kind, inverse = kinds(3), np.linalg.inv(inertia)[None]
    body = rows(
        kind.body,
        1,
        mass=mass,
        inverse_mass=1 / mass,
        inverse_inertia=inverse,
        quaternion=[1.0, 0, 0, 0],
        momentum=inertia @ spin,
    )
    none = {"lines": kind.line, "edges": kind.edge, "tangents": kind.tangent}
    tables: dict = {name: rows(of, 0) for name, of in none.items()}
    links = tuple(
        each(each.table(3, 0), *((moving((), 1),) if each is Actuators else ()))
        for each in KINDS  # with one kind less the loop would be compiled anew
    )
    tables |= {"links": links, "laws": no_laws(3), "guided": np.zeros(0, dtype=np.int64)}
    return System(axes=SPACE.axes, bodies=body, ground=Ground.from_motions(None), supports=moving((), 3), **tables)


def followed(system, duration, h, every):
    """The samples of a system that is followed without being changed."""
    last = every * round(duration / (h * every))
    system, books = copied(system), Books.empty(system, 1)
    samples = Samples.room(last // every + 1, system, books)
    alone = threads_of(system.bodies, system.lines, 1)[0][0]
    clock = Clock(h=h, steps_per_sample=every, stop=last + 1, last=last, ground_acceleration_before=(0.0, 0.0, 0.0))
    advance(system, books, samples, clock, alone)
    return samples.chosen(slice(-1)), system


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
