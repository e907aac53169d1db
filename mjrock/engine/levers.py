"""Levers: how the velocities of two bodies open a contact and let it slip, and how a force along its face moves them.

`kinematics.gap` and `kinematics.along` give the same rates. Levers are found once for a pose and then serve many
velocities, accelerations and forces.
"""

from __future__ import annotations

from typing import NamedTuple

from ..compiled import jitable
from ..problem.quantities import Array
from .kinematics import Points, direction


class Levers(NamedTuple):
    """A contact at a pose. Rates of its gap and of its slip are products of these with the velocities of two bodies.

    Args:
        gap: between point and face [m].
        nx, nz: normal of the face; the face runs along (nz, -nx).
        across, face_across: levers of the gap for the rotations of the two bodies [m].
        along, face_along: levers of the slip, where friction acts, see `along` [m].
    """

    gap: float
    nx: float
    nz: float
    across: float
    face_across: float
    along: float
    face_along: float


@jitable
def levers_of(points: Points, i: int, frame: Array) -> Levers:
    """The levers of contact i."""
    body, face = points.body[i], points.face_body[i]
    x, z, sine, versine = points.at[i, 0], points.at[i, 1], frame[body, 2], frame[body, 3]
    dx, dz = z * sine - x * versine, -x * sine - z * versine
    nx, nz = direction(points, i, frame)
    rx, rz = points.between[i, 0] + frame[body, 0] + dx, points.between[i, 1] + frame[body, 1] + dz
    x, z = x + dx, z + dz
    across, along_face = nx * z - nz * x, nz * z + nx * x
    if face < 0:
        out = nx * rx + nz * rz
        return Levers(out, nx, nz, across, 0.0, along_face - (0.5 * out + points.radius), 0.0)
    x, z, sine, versine = points.face_at[i, 0], points.face_at[i, 1], frame[face, 2], frame[face, 3]
    dx, dz = z * sine - x * versine, -x * sine - z * versine
    rx, rz = rx - frame[face, 0] - dx, rz - frame[face, 1] - dz
    x, z = x + dx, z + dz
    out, below = nx * rx + nz * rz, 0.5 * (nx * rx + nz * rz) + points.radius
    other = nx * z - nz * x - (nz * rx - nx * rz)
    return Levers(out, nx, nz, across, other, along_face - below, nz * z + nx * x + out - below)


@jitable
def opening(points: Points, i: int, levers: Levers, v: Array) -> float:
    """Rate of the gap of contact i for velocities v of the bodies [m/s], or the same of their accelerations."""
    a, b = 3 * points.body[i], 3 * points.face_body[i]
    rate: float = levers.nx * v[a] + levers.nz * v[a + 1] + levers.across * v[a + 2]
    if b >= 0:
        rate -= levers.nx * v[b] + levers.nz * v[b + 1] + levers.face_across * v[b + 2]
    return rate


@jitable
def slipping(points: Points, i: int, levers: Levers, v: Array) -> float:
    """Slip of contact i for velocities v of the bodies [m/s], or the same of their accelerations."""
    a, b = 3 * points.body[i], 3 * points.face_body[i]
    rate: float = levers.nz * v[a] - levers.nx * v[a + 1] + levers.along * v[a + 2]
    if b >= 0:
        rate -= levers.nz * v[b] - levers.nx * v[b + 1] + levers.face_along * v[b + 2]
    return rate


@jitable
def rub(points: Points, i: int, levers: Levers, force: float, applied: Array) -> None:
    """Add to generalised forces what a force along the face does at contact i [N]."""
    a, b = 3 * points.body[i], 3 * points.face_body[i]
    applied[a] += levers.nz * force
    applied[a + 1] -= levers.nx * force
    applied[a + 2] += levers.along * force
    if b >= 0:
        applied[b] -= levers.nz * force
        applied[b + 1] += levers.nx * force
        applied[b + 2] -= levers.face_along * force
