"""Rigid blocks on springs, integrated explicitly with kinematics of its own: what MuJoCo's runs are checked against.

Each contact is a spring and a dashpot that push only. Friction is Coulomb's and has no spring: in each step impulses
along the faces, at most mu times the pressure, stop the slip of every contact as far as they can (projected
Gauss-Seidel). They act halfway into the overlap. Steps are those of the symplectic Euler method.
"""

import numpy as np

from mjrock.compiled import compiled, inlined
from mjrock.quantities import GRAVITY

SWEEPS = 20
"""Most sweeps over the contacts in a step."""
SETTLED = 1e-9
"""Change of an impulse in a sweep, over the largest that friction allows, below which the sweeps end [-]."""


@inlined
def turned(x, z, theta):
    """A vector turned by theta, positive where up turns to the right."""
    c, s = np.cos(theta), np.sin(theta)
    return x * c + z * s, z * c - x * s


@inlined
def shaken(accel, dt, t):
    """Acceleration of the ground at a time, linear between samples, none after the last."""
    place = t / dt
    i = min(int(place), len(accel) - 2)
    return accel[i] + (place - i) * (accel[i + 1] - accel[i]) if place < len(accel) - 1 else 0.0


@inlined
def pushed(v, rows, p, first, a, b, inverse, impulse):
    """Change the velocities of bodies a and b by an impulse along a row, six numbers of line p of the rows."""
    for j in range(3):
        v[3 * a + j] += inverse[3 * a + j] * rows[p, first + j] * impulse
    if b >= 0:
        for j in range(3):
            v[3 * b + j] += inverse[3 * b + j] * rows[p, first + 3 + j] * impulse


@compiled
def _integrate(
    inverse, rest, body, at, face, base, normal, k, c, mu, accel, dt, up, up_dt, h, every, q, v, rows, most, held, out
):
    steps, bodies = (len(out) - 1) * every, len(rest)
    for n in range(steps + 1):
        if n % every == 0:
            for j in range(3 * bodies):
                out[n // every, j] = q[j]
        a_x, a_z = shaken(accel, dt, n * h), shaken(up, up_dt, n * h)
        scale = 0.0
        for p in range(len(k)):
            a, b = body[p], face[p]
            rx, rz = turned(at[p, 0], at[p, 1], q[3 * a + 2])
            px, pz = rest[a, 0] + q[3 * a] + rx, rest[a, 1] + q[3 * a + 1] + rz
            ox, oz, nx, nz, sx, sz = base[p, 0], base[p, 1], normal[p, 0], normal[p, 1], 0.0, 0.0
            ux, uz = v[3 * a] + v[3 * a + 2] * rz, v[3 * a + 1] - v[3 * a + 2] * rx
            if b >= 0:
                ox, oz = turned(base[p, 0], base[p, 1], q[3 * b + 2])
                ox, oz = ox + rest[b, 0] + q[3 * b], oz + rest[b, 1] + q[3 * b + 1]
                nx, nz = turned(nx, nz, q[3 * b + 2])
                sx, sz = px - rest[b, 0] - q[3 * b], pz - rest[b, 1] - q[3 * b + 1]
                ux, uz = ux - v[3 * b] - v[3 * b + 2] * sz, uz - v[3 * b + 1] + v[3 * b + 2] * sx
            gap, rate = nx * (px - ox) + nz * (pz - oz), nx * ux + nz * uz
            push = max(0.0, -k[p] * gap - c[p] * rate) if gap < 0 else 0.0
            # the force pushes at the point, and friction rubs halfway between the faces that overlap there
            rows[p, 0], rows[p, 1], rows[p, 2] = nx, nz, rz * nx - rx * nz
            rows[p, 3], rows[p, 4], rows[p, 5] = -nx, -nz, -(sz * nx - sx * nz)
            most[p, 0] = push * h
            rx, rz, sx, sz = rx - 0.5 * gap * nx, rz - 0.5 * gap * nz, sx - 0.5 * gap * nx, sz - 0.5 * gap * nz
            rows[p, 6], rows[p, 7], rows[p, 8] = nz, -nx, rz * nz + rx * nx
            rows[p, 9], rows[p, 10], rows[p, 11] = -nz, nx, -(sz * nz + sx * nx)
            most[p, 1] = mu[p] * push * h
            scale = max(scale, most[p, 1])
            light = 0.0
            for j in range(3):
                light += rows[p, 6 + j] ** 2 * inverse[3 * a + j]
                if b >= 0:
                    light += rows[p, 9 + j] ** 2 * inverse[3 * b + j]
            most[p, 2] = 1 / light
        for j in range(bodies):
            v[3 * j] -= h * a_x
            v[3 * j + 1] -= h * (GRAVITY + a_z)
        for p in range(len(k)):
            if most[p, 0] > 0:
                pushed(v, rows, p, 0, body[p], face[p], inverse, most[p, 0])
            held[p] = min(max(held[p], -most[p, 1]), most[p, 1])  # starts as in the last step
            if held[p] != 0:
                pushed(v, rows, p, 6, body[p], face[p], inverse, held[p])
        for sweep in range(SWEEPS):
            changed = 0.0
            for turn in range(len(k)):
                p = turn if sweep % 2 else len(k) - 1 - turn
                if most[p, 1] == 0:
                    continue
                i, j, slip = 3 * body[p], 3 * face[p], 0.0
                for m in range(3):
                    slip += rows[p, 6 + m] * v[i + m]
                    if j >= 0:
                        slip += rows[p, 9 + m] * v[j + m]
                impulse = min(max(held[p] - slip * most[p, 2], -most[p, 1]), most[p, 1])
                pushed(v, rows, p, 6, body[p], face[p], inverse, impulse - held[p])
                changed = max(changed, abs(impulse - held[p]))
                held[p] = impulse
            if changed <= SETTLED * scale:
                break
        for j in range(3 * bodies):
            q[j] += h * v[j]


def explicit(scene, course, h=2e-6, every=500):
    """Times and poses (n, bodies, 3) of the bodies of a scene in a course, from where its contacts are at rest."""
    shaking = [
        (np.zeros(2), 1.0) if motion is None else (np.array(motion.accel), motion.dt)
        for motion in (course.motion, course.vertical)
    ]
    pose, velocity = (np.ravel(part).copy() for part in (course.pose, course.velocity))
    points, rest = scene.contacts, scene.bodies.rest
    count, below = len(points.k), points.face_body[:, None] < 0
    out = np.empty((round(course.duration / h) // every + 1, len(pose)))
    # the face passes through its point of the contact at rest, so that the gap is zero there
    origin = rest[points.body] + points.at
    along = np.where(below, points.face_at, rest[points.face_body] + points.face_at) - origin
    origin = origin + points.normal * np.sum(along * points.normal, axis=1)[:, None]
    _integrate(
        1 / scene.bodies.masses, rest, points.body, points.at, points.face_body,
        origin - np.where(below, 0.0, rest[points.face_body]), points.normal,
        points.k, points.c, points.friction, *shaking[0], *shaking[1], h, every, pose, velocity,
        np.zeros((count, 12)), np.zeros((count, 3)), np.zeros(count), out,
    )  # fmt: skip
    return h * every * np.arange(len(out)), out.reshape(len(out), -1, 3)
