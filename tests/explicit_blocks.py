"""Rigid blocks on springs, integrated explicitly with kinematics of its own: what masonry in MuJoCo is checked against.

Each contact line is a spring and a dashpot that push only, and a spring along the face that slides at mu times the
pressure. MuJoCo's friction has no such spring, so it is taken stiff. Steps are those of the symplectic Euler method.
"""

import numpy as np

from mjrock.compiled import compiled, jitable
from mjrock.problem.quantities import GRAVITY

SHEAR = 10.0
"""Stiffness along a face over that across it [-]."""


@jitable
def turned(x, z, theta):
    """A vector turned by theta, positive where up turns to the right."""
    c, s = np.cos(theta), np.sin(theta)
    return x * c + z * s, z * c - x * s


@jitable
def shaken(accel, dt, t):
    """Acceleration of the ground at a time, linear between samples, none after the last."""
    place = t / dt
    i = min(int(place), len(accel) - 2)
    return accel[i] + (place - i) * (accel[i + 1] - accel[i]) if place < len(accel) - 1 else 0.0


@compiled
def _integrate(
    mass, inertia, rest, body, at, face, base, normal, k, c, mu, accel, dt, up, up_dt, h, every, q, v, slip, force, out
):
    steps, bodies = (len(out) - 1) * every, len(mass)
    for n in range(steps + 1):
        if n % every == 0:
            for j in range(3 * bodies):
                out[n // every, j] = q[j]
        a_x, a_z = shaken(accel, dt, n * h), shaken(up, up_dt, n * h)
        for j in range(bodies):
            force[3 * j], force[3 * j + 1], force[3 * j + 2] = -mass[j] * a_x, -mass[j] * (GRAVITY + a_z), 0.0
        for p in range(len(k)):
            a, b = body[p], face[p]
            rx, rz = turned(at[p, 0], at[p, 1], q[3 * a + 2])
            px, pz = rest[a, 0] + q[3 * a] + rx, rest[a, 1] + q[3 * a + 1] + rz
            ux, uz = v[3 * a] + v[3 * a + 2] * rz, v[3 * a + 1] - v[3 * a + 2] * rx
            ox, oz, nx, nz, sx, sz = base[p, 0], base[p, 1], normal[p, 0], normal[p, 1], 0.0, 0.0
            if b >= 0:
                ox, oz = turned(base[p, 0], base[p, 1], q[3 * b + 2])
                ox, oz = ox + rest[b, 0] + q[3 * b], oz + rest[b, 1] + q[3 * b + 1]
                nx, nz = turned(nx, nz, q[3 * b + 2])
                sx, sz = px - rest[b, 0] - q[3 * b], pz - rest[b, 1] - q[3 * b + 1]
                ux, uz = ux - v[3 * b] - v[3 * b + 2] * sz, uz - v[3 * b + 1] + v[3 * b + 2] * sx
            g, rate, along = nx * (px - ox) + nz * (pz - oz), nx * ux + nz * uz, nz * ux - nx * uz
            push = max(0.0, -k[p] * g - c[p] * rate) if g < 0 else 0.0
            slip[p] = slip[p] + h * along if push > 0 else 0.0
            drag = -SHEAR * (k[p] * slip[p] + c[p] * along)
            if abs(drag) > mu[p] * push:
                drag = np.copysign(mu[p] * push, drag)
                slip[p] = -drag / (SHEAR * k[p])
            fx, fz = push * nx + drag * nz, push * nz - drag * nx
            force[3 * a], force[3 * a + 1] = force[3 * a] + fx, force[3 * a + 1] + fz
            force[3 * a + 2] += rz * fx - rx * fz
            if b >= 0:
                force[3 * b], force[3 * b + 1] = force[3 * b] - fx, force[3 * b + 1] - fz
                force[3 * b + 2] -= sz * fx - sx * fz
        for j in range(bodies):
            v[3 * j] += h * force[3 * j] / mass[j]
            v[3 * j + 1] += h * force[3 * j + 1] / mass[j]
            v[3 * j + 2] += h * force[3 * j + 2] / inertia[j]
        for j in range(3 * bodies):
            q[j] += h * v[j]


def explicit(masonry, pose, duration, motion, h=2e-6, every=500, vertical=None):
    """Times and poses (n, bodies, 3) of masonry that starts at a pose, from its blocks and contact lines."""
    blocks, lines = masonry.blocks, masonry.lines
    free = list(masonry.free)
    number = {block: i for i, block in enumerate(free)}
    body = np.array([number[i] for i in lines.body.tolist()])
    face = np.array([number.get(i, -1) for i in lines.face.tolist()])
    at = lines.at - np.array([blocks[i].centroid for i in lines.body])
    base = lines.at - np.array([np.zeros(2) if blocks[i].fixed else blocks[i].centroid for i in lines.face])
    shaking = [(np.zeros(2), 1.0) if one is None else (np.array(one.accel), one.dt) for one in (motion, vertical)]
    out = np.empty((round(duration / h) // every + 1, 3 * len(free)))
    _integrate(
        np.array([blocks[i].mass for i in free]),
        np.array([blocks[i].inertia for i in free]),
        np.array([blocks[i].centroid for i in free]),
        body, at, face, base, np.array(lines.normal), np.array(lines.k),
        masonry.retardation[lines.joint] * lines.k, masonry.joint_friction[lines.joint],
        *shaking[0], *shaking[1], h, every, np.ravel(pose).copy(), np.zeros(3 * len(free)), np.zeros(len(body)),
        np.zeros(3 * len(free)), out,
    )  # fmt: skip
    return h * every * np.arange(len(out)), out.reshape(len(out), -1, 3)
