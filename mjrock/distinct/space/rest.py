"""Masonry in space at rest: the pose in which the springs of its points, in every direction, carry the weight.

Points push only, and their shear springs slip where they would pass the friction. Points that stick rigidly are lent
shear springs for this search, and start with the force of these. The search is Newton's method, with the stiffness of
a point that slips taken along the chord.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csc_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from ...problem.masonry.joints_in_space import axes_across
from ...quantities import GRAVITY, Array, Integers
from .columns import PLACE, QUATERNION, applied, named, named_vectors, stacked, turns, vectors
from .limit import rates_of
from .system import System

LENT = 1e3
"""Shear stiffness that points have in the search, over their normal stiffness [-]."""
ITERATIONS = 300
"""Most iterations of the search."""
EXACT = 1e-9
"""Force that may be missing, over the weight of the heaviest body [-]."""
LOOSE = 1e-10
"""Stiffness that is lent to every motion in the search, over the largest [-]."""
LEANING = 1e-6
"""Stiffness of an open point in the search for a direction, over that of a closed one [-]."""
SMALLEST_SHARE = 1e-2
"""Smallest share of a step of the search [-]."""
TURNED = 0.5
"""Rotation beyond which a body no longer stands [rad]."""


class UnsettledError(ValueError):
    """No pose of rest was found; `place` is where the bodies were last, from their places as drawn, shape (n, 3)."""

    def __init__(self, place: Array) -> None:
        super().__init__("no pose was found in which the springs of the joints carry the weight")
        self.place = place


class Springs(NamedTuple):
    """The springs of points, and then of ties, at a pose.

    Args:
        pair: numbers of the two bodies, shape (m, 2).
        arms: from their centroids to the point [m], shape (m, 3) each.
        normal: unit vectors along which the springs push the two apart, shape (m, 3).
        pressed: depth of points and elongation of ties, negative where open or slack [m], shape (m,).
        slid: how far each point has slid along its face [m], shape (m, 3).
        push: along the normals [N], shape (m,).
        drag: along the faces [N], shape (m, 3).
        grips: stiffness along the face, of the chord where a point slips [N/m], shape (m,).
    """

    pair: Integers
    arms: tuple[Array, Array]
    normal: Array
    pressed: Array
    slid: Array
    push: Array
    drag: Array
    grips: Array


def settle(system: System) -> None:
    """Bring the bodies of a system to their pose of rest, and let its points start with the friction there.

    Raises:
        UnsettledError: if no such pose is found near the one as drawn.
    """
    bodies, lines = system.bodies, system.lines
    place, quaternion = stacked(bodies, PLACE), stacked(bodies, QUATERNION)
    size = np.column_stack([np.ones((len(bodies), 3)), np.repeat(sizes(system)[:, None], 3, axis=1)]).ravel()
    tolerated = EXACT * GRAVITY * float(bodies["mass"].max())
    stiff, shear = np.concatenate([lines["k"], system.ties["k"]]), np.append(shears(system), np.zeros(len(system.ties)))
    rubs = np.append(lines["friction"] > 0, np.zeros(len(system.ties), dtype=bool))
    springs = springs_at(system, place, quaternion)
    missing = missing_force(system, springs, quaternion) / size
    for iteration in range(ITERATIONS):
        if np.abs(missing).max() < tolerated and iteration:
            break
        first = iteration == 0  # all points hold in all directions
        acting = springs._replace(grips=np.where(rubs, shear, 0.0)) if first else springs
        closed = (springs.pressed > 0) | (first & (shear > 0))
        stiffness = stiffness_of(acting, np.where(closed, stiff, LEANING * stiff), len(bodies))
        lent = LOOSE * float(stiffness.diagonal().max())
        scaled = csc_array(
            diags_array(1 / size) @ stiffness @ diags_array(1 / size) + diags_array(np.full(len(size), lent))
        )
        motion = (splu(scaled).solve(missing) / size).reshape(-1, 6)
        share, last = 1.0, float(np.abs(missing).sum())
        while True:
            tried = moved(place, quaternion, share * motion)
            springs = springs_at(system, *tried)
            missing = missing_force(system, springs, tried[1]) / size
            if np.abs(missing).sum() < last or share < SMALLEST_SHARE or iteration == 0:
                break
            share *= 0.5
        place, quaternion = tried
        if not np.linalg.norm(quaternion[:, 1:], axis=1).max() < np.sin(0.5 * TURNED):
            raise UnsettledError(place)
    else:
        raise UnsettledError(place)
    for name, values in (named(PLACE, place) | named(QUATERNION, quaternion)).items():
        bodies[name] = values
    take_grips(system, springs, quaternion)


def shears(system: System) -> Array:
    """Shear stiffness that the points have in the search [N/m], shape (m,)."""
    return np.asarray(LENT * system.lines["k"])


def sizes(system: System) -> Array:
    """A length of each body, by which moments are compared with forces: its radius of gyration [m], shape (n,)."""
    bodies = system.bodies
    return np.asarray(np.sqrt(1 / (bodies["mass"] * bodies["ease_xx"])))


def springs_at(system: System, place: Array, quaternion: Array) -> Springs:
    """The springs at a pose."""
    lines, ties, turn = system.lines, system.ties, turns(quaternion)
    pair = np.column_stack([lines["body"], lines["face"]])
    arms, across = apart(pair, (vectors(lines, "at"), vectors(lines, "origin")), place, turn)
    normal = vectors(lines, "normal")
    normal = normal + applied(turn, pair[:, 1], normal)
    gap = np.einsum("ij,ij->i", normal, across)
    slid, push = across - gap[:, None] * normal, np.maximum(-lines["k"] * gap, 0.0)
    k_s = shears(system)
    held, most = k_s * np.linalg.norm(slid, axis=1), lines["friction"] * push
    grips = np.where(held > most, k_s * most / np.where(held > 0, held, 1.0), k_s)
    grips[(lines["friction"] == 0) | (push == 0)] = 0.0
    drag = -grips[:, None] * slid
    if not len(ties):
        return Springs(pair, arms, normal, -gap, slid, push, drag, grips)
    held_pair = np.column_stack([ties["body"], ties["anchor"]])
    held_arms, between = apart(held_pair, (vectors(ties, "at"), vectors(ties, "origin")), place, turn)
    between = between + vectors(ties, "between")
    length = np.linalg.norm(between, axis=1)
    longer, none = length - ties["reach"], np.zeros((len(ties), 3))
    return Springs(
        np.vstack([pair, held_pair]),
        (np.vstack([arms[0], held_arms[0]]), np.vstack([arms[1], held_arms[1]])),
        np.vstack([normal, -between / length[:, None]]),
        np.append(-gap, longer),
        np.vstack([slid, none]),
        np.append(push, np.maximum(ties["k"] * longer, 0.0)),
        np.vstack([drag, none]),
        np.append(grips, np.zeros(len(ties))),
    )


def apart(pair: Integers, places: tuple[Array, Array], place: Array, turn: Array) -> tuple[tuple[Array, Array], Array]:
    """Arms to the places of two bodies at a pose, and how far these have moved apart from rest [m], shape (m, 3)."""
    swings = [applied(turn, body, at) for body, at in zip(pair.T, places, strict=True)]
    moved_by = np.vstack([place, np.zeros(3)])  # the last is that of the ground
    across = moved_by[pair[:, 0]] + swings[0] - moved_by[pair[:, 1]] - swings[1]
    return (places[0] + swings[0], places[1] + swings[1] + across), across


def missing_force(system: System, springs: Springs, quaternion: Array) -> Array:
    """Force and moment on each body that nothing balances, about its centroid, shape (6 n,)."""
    total, turn = np.zeros((len(system.bodies), 6)), turns(quaternion)
    total[:, 2] = -GRAVITY * system.bodies["mass"]
    force = springs.push[:, None] * springs.normal + springs.drag
    turning = np.cross(0.5 * np.maximum(springs.pressed, 0.0)[:, None] * springs.normal, springs.drag)
    for sign, number, arm in zip((1.0, -1.0), springs.pair.T, springs.arms, strict=True):
        on_body = number >= 0
        acting = np.hstack([force, np.cross(arm, force) + turning])[on_body]
        np.add.at(total, number[on_body], sign * acting)
    row = system.forces
    at, force = vectors(row, "at"), vectors(row, "between")
    np.add.at(total, row["body"], np.hstack([force, np.cross(at + applied(turn, row["body"], at), force)]))
    return total.ravel()


def stiffness_of(springs: Springs, k: Array, bodies: int) -> csr_array:
    """Stiffness of the springs, those along the normals with the given k, shape (6 n, 6 n)."""
    total = csr_array((6 * bodies, 6 * bodies))
    first, second = np.moveaxis(axes_across(springs.normal), 1, 0)
    for way, weights in ((springs.normal, k), (first, springs.grips), (second, springs.grips)):
        rates = rates_of(springs.pair, springs.arms, way, bodies)
        total = csr_array(total + rates.T @ diags_array(weights) @ rates)
    return total


def moved(place: Array, quaternion: Array, motion: Array) -> tuple[Array, Array]:
    """A pose moved by displacements and rotation vectors, shape (n, 6)."""
    half = 0.5 * motion[:, 3:]
    angle = np.linalg.norm(half, axis=1)[:, None]
    a, b = np.cos(angle), half * np.sinc(angle / np.pi)
    w, v = quaternion[:, :1], quaternion[:, 1:]
    turned = np.hstack([a * w - np.einsum("ij,ij->i", b, v)[:, None], a * v + w * b + np.cross(b, v)])
    return place + motion[:, :3], turned / np.linalg.norm(turned, axis=1)[:, None]


def take_grips(system: System, springs: Springs, quaternion: Array) -> None:
    """Let the points start with the friction that they have at rest, in the axes of their faces."""
    lines, m = system.lines, len(system.lines)
    drag, face = springs.drag[:m], springs.pair[:m, 1]
    sprung = np.isfinite(lines["k_s"])
    grip = np.where(sprung[:, None], -drag / np.where(sprung, lines["k_s"], 1.0)[:, None], drag)
    turned_back = np.swapaxes(turns(quaternion), 1, 2)
    grip = grip + applied(turned_back, face, grip)
    for name, values in named_vectors(grip=grip).items():
        lines[name] = values
