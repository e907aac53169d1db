"""Bodies and lines whose rows are written by hand, for tests that call functions of explicit steps one at a time."""

import numpy as np
from scipy.spatial.transform import Rotation

from mjrock.distinct.kinds.mortar import Bonds
from mjrock.distinct.rotation import take_inverse_inertia, update_rotation
from mjrock.distinct.rows import kinds
from mjrock.distinct.supports import moving
from mjrock.distinct.system import Books, System
from mjrock.distinct.thread import threads_of
from mjrock.geometry.frames import PLANE, SPACE
from mjrock.problem.wall.rest_geometry import Solid, in_space
from mjrock.rows import rows
from mjrock.scene.course import Ground

TURNS = Rotation.from_rotvec([[0.7, -0.4, 0.3], [-0.2, 0.5, 0.6]])
ANGLES = 0.7, -0.4
INERTIAS = np.array(
    [
        [[3.0, 0.4, -0.3], [0.4, 5.0, 0.7], [-0.3, 0.7, 2.0]],
        [[4.0, -0.5, 0.2], [-0.5, 2.0, 0.3], [0.2, 0.3, 6.0]],
    ]
)
MASSES = np.array([2.0, 5.0])
REST = np.array([[0.3, -0.2, 1.1], [-0.4, 0.5, 2.3]])
PLACE = np.array([[0.02, 0.05, -0.04], [-0.03, 0.01, 0.06]])
VELOCITY = np.array([[0.7, -0.3, 0.4], [-0.2, 0.6, 0.9]])
SPIN = np.array([[0.5, -0.8, 0.3], [-0.6, 0.2, 0.7]])
MOVED, MOVING = np.array([[0.01, -0.02, 0.03]]), np.array([[0.3, -0.1, 0.2]])


def system(d, lines=1, edges=0, still=False):
    """Two bodies in general motion, or still and not turned, a support, and rows for lines, tangents and bonds."""
    kind, which = kinds(d), [0, 2] if d == 2 else [0, 1, 2]
    bodies = rows(kind.body, 2, mass=MASSES, inverse_mass=1 / MASSES[:, None], rest=REST[:, which])
    bodies["place"] = PLACE[:, which]
    if d == 2:
        bodies["angle"], bodies["inverse_inertia"] = ANGLES, 1 / INERTIAS[:, 1, 1].reshape(2, 1, 1)
    else:
        bodies["quaternion"], bodies["inverse_inertia"] = np.roll(TURNS.as_quat(), 1, axis=1), np.linalg.inv(INERTIAS)
    if still:
        bodies["place"] = 0.0
        bodies["angle" if d == 2 else "quaternion"] = 0.0 if d == 2 else [1.0, 0.0, 0.0, 0.0]
    axes = PLANE.axes if d == 2 else SPACE.axes
    for body in bodies:
        update_rotation(body)
        take_inverse_inertia(body)
    if not still:
        bodies["velocity"], bodies["spin"] = VELOCITY[:, which], SPIN[:, 1:2] if d == 2 else SPIN
    if d == 3:
        bodies["momentum"] = np.linalg.solve(bodies["inverse_in_world"], bodies["spin"][:, :, None])[:, :, 0]
    supports = moving((), d)._replace(moved=MOVED[:, which], moving=MOVING[:, which])
    return System(
        axes=axes,
        bodies=bodies,
        lines=rows(kind.line, lines, face=-1, support=-1, k_s=np.inf, margin=np.inf, sense=1.0),
        edges=rows(kind.edge, edges),
        tangents=rows(kind.tangent, (d - 1) * lines),
        laws=(Bonds(Bonds.table(d, lines)),),
        links=(),
        guided=np.zeros(0, dtype=np.int64),
        ground=Ground.from_motions(None),
        supports=supports,
    )


def stood(blocks):
    """Blocks as solids of a scene, free ones as bodies in their order."""
    free = np.cumsum([not block.fixed for block in blocks]) - 1
    return [
        Solid(
            str(i),
            i,
            -1 if block.fixed else int(free[i]),
            in_space(np.array(block.centroid)),
            block.solids,
            block.inside,
            block.sides,
            block.size,
        )
        for i, block in enumerate(blocks)
    ]


def alone(system):
    """The only thread of a run."""
    return threads_of(system.bodies, system.lines, 1)[0][0]


def books(system):
    return Books.empty(system, 2)


def columns(places):
    """Places as columns of numbers, shape (n, 11): the two blocks, where, the normal, gap, share and area."""
    return np.column_stack([places[name] for name in places.dtype.names if name != "sides"])


def matrix(d, i):
    """The rotation of a body of a system that moves."""
    if d == 3:
        return TURNS[i].as_matrix()
    c, s = np.cos(ANGLES[i]), np.sin(ANGLES[i])
    return np.array([[c, s], [-s, c]])


def about(arm, force):
    """Moment of a force at an arm, shape (1,) in the plane, positive where z turns towards x, or (3,)."""
    arm, force = np.asarray(arm), np.asarray(force)
    return np.array([arm[1] * force[0] - arm[0] * force[1]]) if len(arm) == 2 else np.cross(arm, force)


def velocity_at(body, arm):
    """Velocity of a point of a body at an arm from its centroid."""
    if len(arm) == 2:
        return body.velocity + body.spin[0] * np.array([arm[1], -arm[0]])
    return body.velocity + np.cross(body.spin, arm)


def energy(bodies):
    """Kinetic energy [J]."""
    spin = bodies["spin"]
    inverse = bodies["inverse_inertia" if spin.shape[1] == 1 else "inverse_in_world"]
    momentum = np.linalg.solve(inverse, spin[:, :, None])[:, :, 0]
    return 0.5 * float((bodies["mass"] * (bodies["velocity"] ** 2).sum(axis=1)).sum() + (spin * momentum).sum())
