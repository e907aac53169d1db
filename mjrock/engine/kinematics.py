"""Kinematics of rigid bodies in a plane: gaps between points and faces, their rates, slip, lengths of ties.

Poses and velocities of n bodies are flat arrays of 3 n numbers: for each body the displacement x, z of its centroid
from rest [m] and its rotation theta from rest [rad]. x points away from the side stop of a wall, z upwards, and theta
is positive where the top of a body turns towards +x. A frame is a pose with its sines and cosines taken once: x, z,
sin(theta), 1 - cos(theta) of each body. This module is the only place where these formulas stand, apart from the
independent solver in `mjrock.reference`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, jitable
from ..problem.quantities import GRAVITY, Array, Flags, Integers


class Points(NamedTuple):
    """Contact points and the faces that they meet, as arrays for compiled functions.

    Args:
        body: the body that carries each point, shape (m,).
        at: position of the point from the centroid of that body, at rest [m], shape (m, 2).
        face_body: the body whose face the point meets, -1 for the ground, shape (m,).
        face_at: origin of the face from the centroid of its body, at rest, or from the origin of the world [m], (m, 2).
        normal: unit vector out of the face at rest, shape (m, 2).
        between: vector from the origin of the face to the point, at rest [m], shape (m, 2).
        k: stiffness [N/m], shape (m,).
        c: damping [N s/m], shape (m,).
        friction: coefficient of friction [-], zero for none, shape (m,).
        rubs: which contacts slide by Coulomb's law, see `mjrock.engine.sliding`, shape (m,).
        weight: sum of MuJoCo's inverse weights of the two bodies [1/kg], shape (m,).
        held, growth: inertia of the friction row [kg], zero for no friction, and its growth [1/s], see `set_rows`.
        radius: of MuJoCo's spheres for the points [m].
        reach, overlap: largest gap and deepest penetration that a run follows [m], infinite for a wall.
        bears: penetration of the point while the scene is at rest [m], zero where it is open, shape (m,).
        overdamped: c h W from which its dashpot is stiff for a step, see `contact.row` [-], shape (m,).
    """

    body: Integers
    at: Array
    face_body: Integers
    face_at: Array
    normal: Array
    between: Array
    k: Array
    c: Array
    friction: Array
    rubs: Flags
    weight: Array
    held: Array
    growth: float
    radius: float
    reach: float
    overlap: float
    bears: Array
    overdamped: Array


class Ties(NamedTuple):
    """Ties between points of two bodies, or of a body and the ground, as arrays for compiled functions.

    Args:
        body: the body that each tie holds, shape (t,).
        at: position of the held point from the centroid of that body, at rest [m], shape (t, 2).
        face_body: the body of the anchor, -1 for the ground, shape (t,).
        face_at: the anchor from the centroid of its body, at rest, or from the origin of the world [m], shape (t, 2).
        between: vector from the anchor to the held point, at rest [m], shape (t, 2).
        k: stiffness [N/m], shape (t,).
        reach: length up to which the tie is slack [m], shape (t,). It grows as the tie yields.
        stretch: elongation at which the tie yields [m], infinite for one that does not, shape (t,).
    """

    body: Integers
    at: Array
    face_body: Integers
    face_at: Array
    between: Array
    k: Array
    reach: Array
    stretch: Array


class Forces(NamedTuple):
    """Forces that keep size and direction and follow a point of a body, as arrays for compiled functions.

    Args:
        body: the body that each force acts on, shape (f,).
        at: position of its point from the centroid of that body, at rest [m], shape (f, 2).
        force: x and z component [N], shape (f, 2).
    """

    body: Integers
    at: Array
    force: Array


@jitable
def take_frame(q: Array, frame: Array) -> None:
    """Write the frame of a pose, shape (n, 4)."""
    for body in range(len(frame)):
        half = 0.5 * q[3 * body + 2]
        sine = math.sin(half)
        frame[body, 0], frame[body, 1] = q[3 * body], q[3 * body + 1]
        frame[body, 2], frame[body, 3] = 2 * sine * math.cos(half), 2 * sine * sine


def frame_of(q: Array) -> Array:
    """The frame of a pose, shape (n, 4)."""
    frame = np.empty((len(q) // 3, 4))
    take_frame(q, frame)
    return frame


@jitable
def carried(frame: Array, v: Array, a: Array, body: int, x: float, z: float) -> tuple[float, ...]:
    """Displacement, velocity, and acceleration in two parts of the point (x, z) of a body, x before z each.

    The first part of the acceleration is linear in a, the second is what turning at a constant rate makes.

    Args:
        frame: the pose of all bodies.
        v, a: their velocity and acceleration.
        body: which body.
        x, z: position of the point from the centroid at rest [m].
    """
    sine, versine = frame[body, 2], frame[body, 3]
    moved_x, moved_z = z * sine - x * versine, -x * sine - z * versine  # by the rotation alone
    from_x, from_z = x + moved_x, z + moved_z
    i = 3 * body
    w, turn = v[i + 2], a[i + 2]
    return (
        frame[body, 0] + moved_x,
        frame[body, 1] + moved_z,
        v[i] + w * from_z,
        v[i + 1] - w * from_x,
        a[i] + turn * from_z,
        a[i + 1] - turn * from_x,
        -w * w * from_x,
        -w * w * from_z,
    )


@jitable
def direction(points: Points, i: int, frame: Array) -> tuple[float, float]:
    """The normal of the face that point i meets, turned with the body of the face."""
    nx, nz, face = points.normal[i, 0], points.normal[i, 1], points.face_body[i]
    if face < 0:
        return nx, nz
    sine, versine = frame[face, 2], frame[face, 3]
    return nx + nz * sine - nx * versine, nz - nx * sine - nz * versine


@jitable
def gap(points: Points, i: int, frame: Array, v: Array, a: Array) -> tuple[float, float, float, float]:
    """Gap between point i and its face [m], its rate [m/s], and the rate of that in two parts [m/s2].

    The gap is n . r with r from the origin of the face to the point and n the normal, which turns with the body of the
    face. A negative gap is a penetration. The rate is linear in v. The first part of its rate is linear in a, and the
    same function of a as the rate is of v. The second part is what the velocities alone make.
    """
    x, z, vx, vz, ax, az, cx, cz = carried(frame, v, a, points.body[i], points.at[i, 0], points.at[i, 1])
    nx, nz = direction(points, i, frame)
    rx, rz = points.between[i, 0] + x, points.between[i, 1] + z
    face = points.face_body[i]
    if face < 0:
        return nx * rx + nz * rz, nx * vx + nz * vz, nx * ax + nz * az, nx * cx + nz * cz
    fx, fz, fvx, fvz, fax, faz, fcx, fcz = carried(frame, v, a, face, points.face_at[i, 0], points.face_at[i, 1])
    rx, rz, vx, vz = rx - fx, rz - fz, vx - fvx, vz - fvz
    ax, az, cx, cz = ax - fax, az - faz, cx - fcx, cz - fcz
    # the normal has the rate w (nz, -nx), and this has the rate turn (nz, -nx) - w^2 (nx, nz)
    w, turn = v[3 * face + 2], a[3 * face + 2]
    across, out = nz * rx - nx * rz, nx * rx + nz * rz
    swept = nx * cx + nz * cz + 2 * w * (nz * vx - nx * vz) - w * w * out
    return out, nx * vx + nz * vz + w * across, nx * ax + nz * az + turn * across, swept


@jitable
def depth(points: Points, i: int, frame: Array) -> float:
    """Penetration of point i [m], negative where it is open."""
    body, face = points.body[i], points.face_body[i]
    x, z, sine, versine = points.at[i, 0], points.at[i, 1], frame[body, 2], frame[body, 3]
    rx = points.between[i, 0] + frame[body, 0] + z * sine - x * versine
    rz = points.between[i, 1] + frame[body, 1] - x * sine - z * versine
    if face >= 0:
        x, z, sine, versine = points.face_at[i, 0], points.face_at[i, 1], frame[face, 2], frame[face, 3]
        rx -= frame[face, 0] + z * sine - x * versine
        rz -= frame[face, 1] - x * sine - z * versine
    nx, nz = direction(points, i, frame)
    return -(nx * rx + nz * rz)


@jitable
def slack(ties: Ties, i: int, frame: Array, v: Array, a: Array) -> tuple[float, float, float, float]:
    """How much longer tie i may still become before it pulls [m], and its rates; else as `gap`."""
    rx, rz, vx, vz, ax, az, cx, cz = carried(frame, v, a, ties.body[i], ties.at[i, 0], ties.at[i, 1])
    face = ties.face_body[i]
    if face >= 0:
        fx, fz, fvx, fvz, fax, faz, fcx, fcz = carried(frame, v, a, face, ties.face_at[i, 0], ties.face_at[i, 1])
        rx, rz, vx, vz = rx - fx, rz - fz, vx - fvx, vz - fvz
        ax, az, cx, cz = ax - fax, az - faz, cx - fcx, cz - fcz
    rx, rz = rx + ties.between[i, 0], rz + ties.between[i, 1]
    length = math.sqrt(rx * rx + rz * rz)
    nx, nz = rx / length, rz / length
    across = nz * vx - nx * vz
    swept = nx * cx + nz * cz + across * across / length
    return ties.reach[i] - length, -(nx * vx + nz * vz), -(nx * ax + nz * az), -swept


@jitable
def stretch(ties: Ties, i: int, frame: Array, v: Array) -> tuple[float, float]:
    """Elastic elongation of tie i, and by how much it has just yielded [m]. Its reach is brought up to date.

    The velocities v of the bodies make no difference.
    """
    pulled = -slack(ties, i, frame, v, v)[0]
    yielded = max(pulled - ties.stretch[i], 0.0)
    ties.reach[i] += yielded
    return max(pulled - yielded, 0.0), yielded


@jitable
def along(points: Points, i: int, frame: Array, v: Array) -> tuple[float, float, float]:
    """Position of point i along its face from the origin of the face [m], its rate, and the slip of the bodies [m/s].

    The slip is taken where MuJoCo lets friction act: halfway between the surface of the sphere and the face.
    """
    x, z, vx, vz, _, _, _, _ = carried(frame, v, v, points.body[i], points.at[i, 0], points.at[i, 1])
    nx, nz = direction(points, i, frame)
    rx, rz = points.between[i, 0] + x, points.between[i, 1] + z
    turn, face = v[3 * points.body[i] + 2], points.face_body[i]
    if face < 0:
        rate = nz * vx - nx * vz
        return nz * rx - nx * rz, rate, rate - turn * (0.5 * (nx * rx + nz * rz) + points.radius)
    fx, fz, fvx, fvz, _, _, _, _ = carried(frame, v, v, face, points.face_at[i, 0], points.face_at[i, 1])
    rx, rz, vx, vz = rx - fx, rz - fz, vx - fvx, vz - fvz
    across, out, w = nz * vx - nx * vz, nx * rx + nz * rz, v[3 * face + 2]
    below = 0.5 * out + points.radius
    return nz * rx - nx * rz, across - w * out, across - turn * below - w * (out - below)


@jitable
def spring_energy(points: Points, i: int, frame: Array) -> float:
    """Energy in the spring of point i [J]."""
    pressed = max(depth(points, i, frame), 0.0)
    return 0.5 * points.k[i] * pressed * pressed


def gaps(points: Points, q: Array) -> Array:
    """Gap of every point [m] at many poses of shape (steps, 3 n), shape (steps, m)."""
    found = np.empty((len(q), len(points.k)))
    _gaps(points, q, np.empty((q.shape[1] // 3, 4)), found)
    return found


@compiled
def _gaps(points: Points, q: Array, frame: Array, found: Array) -> None:
    for step in range(len(q)):
        take_frame(q[step], frame)
        for i in range(len(points.k)):
            found[step, i] = -depth(points, i, frame)


def energies(points: Points, ties: Ties, forces: Forces, masses: Array, q: Array, v: Array) -> tuple[Array, Array]:
    """Kinetic, potential and elastic energy at the steps of a motion [J], shape (steps, 3), and what ties have taken.

    The potential energy is that of the weight above the position of rest of the centroids, and that of the constant
    forces. Ties yield as the motion goes on. What they have taken up to each step has the shape (steps, t) [J]. Masses
    are the generalised ones, (m, m, I) for each body, shape (3 n,).
    """
    found, taken = np.zeros((len(q), 3)), np.zeros((len(q), len(ties.k)))
    own = ties._replace(reach=np.array(ties.reach))
    _energies(points, own, forces, masses, q, v, np.empty((q.shape[1] // 3, 4)), found, taken)
    return found, taken


@compiled
def _energies(
    points: Points,
    ties: Ties,
    forces: Forces,
    masses: Array,
    q: Array,
    v: Array,
    frame: Array,
    found: Array,
    taken: Array,
) -> None:
    for step in range(len(q)):
        take_frame(q[step], frame)
        for j in range(len(masses)):
            found[step, 0] += 0.5 * masses[j] * v[step, j] ** 2
        for j in range(1, len(masses), 3):
            found[step, 1] += GRAVITY * masses[j] * q[step, j]
        for i in range(len(forces.body)):
            x, z, _, _, _, _, _, _ = carried(frame, v[step], v[step], forces.body[i], forces.at[i, 0], forces.at[i, 1])
            found[step, 1] -= forces.force[i, 0] * x + forces.force[i, 1] * z
        for i in range(len(points.k)):
            found[step, 2] += spring_energy(points, i, frame)
        for i in range(len(ties.k)):
            stretched, yielded = stretch(ties, i, frame, v[step])
            found[step, 2] += 0.5 * ties.k[i] * stretched * stretched
            taken[step, i] = (taken[step - 1, i] if step else 0.0) + ties.k[i] * stretched * yielded
