"""Masonry in space at rest: a pose and friction within its cones in which the springs of its points carry the weight.

Points push only. Along the face each has a spring with a slider that slips where the spring would pass the friction.
Where many slip, friction accumulates from pose to pose as it does in the explicit steps. The search is Newton's method.
With the whole spring of a point that slips it overshoots no pose but is slow, with none of it it ends soon or never.
The share of the spring is therefore halved from pose to pose, and is whole again when more force is missing than
before.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csc_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from ...linear import rates_of
from ...problem.masonry.joints_in_space import axes_along
from ...quantities import GRAVITY, Array, Flags, Integers
from ..system import named, stacked
from .columns import PLACE, QUATERNION, applied, named_vectors, turns, vectors
from .system import System

SEARCHES = ((1e3, 20, False), (1.0, 150, True), (0.1, 300, True))
"""Searches, each where the one before has not ended: the shear stiffness of points over their normal stiffness [-],
nearly rigid at first, as friction that holds is, and then softer, as stiff ones slip more on the way; how many poses
are tried at most; and whether friction accumulates, or is that of springs as long as the slip from the place drawn."""
EXACT = 1e-9
"""Force that may be missing, over the weight of the heaviest body [-]."""
LOOSE, LEAST_LOOSE = 1e-9, 1e-12
"""Stiffness that is lent to every motion in the search, over the largest: at the start, and the least of it [-]."""
SLIPPING, RAISED = 1e-2, 4.0
"""Least share of its shear stiffness that a point that slips lends along its slip, and by how much it is raised each
time that more force is missing than before [-]."""
LEANING = 1e-6
"""Stiffness of an open point in the search for a direction, over that of a closed one [-]."""
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
        push: along the normals [N], shape (m,).
        drag: along the faces [N], shape (m, 3).
        grips: stiffness along the face, of the chord where a point slips [N/m], shape (m,).
        slips: whether a point slips, shape (m,).
        slider: how far the slider of each point has moved along its face, in its axes [m], shape (points, 3).
    """

    pair: Integers
    arms: tuple[Array, Array]
    normal: Array
    pressed: Array
    push: Array
    drag: Array
    grips: Array
    slips: Flags
    slider: Array


def settle(system: System) -> None:
    """Bring the bodies of a system to their pose of rest, and let its points start with the friction there.

    Raises:
        UnsettledError: if no such pose is found near the one as drawn.
    """
    for lent, iterations, accumulates in SEARCHES:
        try:
            k_s = lent * system.lines["k"]
            place, quaternion, springs = searched(system, k_s, iterations, accumulates=accumulates)
            break
        except UnsettledError as error:
            unsettled = error
    else:
        raise unsettled
    for name, values in (named(PLACE, place) | named(QUATERNION, quaternion)).items():
        system.bodies[name] = values
    take_grips(system, springs, quaternion)


def searched(system: System, k_s: Array, iterations: int, *, accumulates: bool) -> tuple[Array, Array, Springs]:
    """Places and quaternions at rest and the springs there, of points with these shear stiffnesses [N/m], shape (m,).

    Raises:
        UnsettledError: if there is none within some iterations.
    """
    bodies, lines = system.bodies, system.lines
    place, quaternion = stacked(bodies, PLACE), stacked(bodies, QUATERNION)
    size = np.column_stack([np.ones((len(bodies), 3)), np.repeat(sizes(system)[:, None], 3, axis=1)]).ravel()
    stiff, scales = np.concatenate([lines["k"], system.ties["k"]]), diags_array(1 / size)
    tolerated, loose, share, least = EXACT * GRAVITY * float(bodies["mass"].max()), LOOSE, 1.0, SLIPPING
    slider = np.zeros((len(lines), 3))
    springs = springs_at(system, place, quaternion, (k_s, slider))
    missing = missing_force(system, springs, quaternion) / size
    for _ in range(iterations):
        stiffness = stiffness_of(springs, np.where(springs.pressed >= 0, stiff, LEANING * stiff), share, len(bodies))
        scaled = scales @ stiffness @ scales
        lent = np.full(len(size), loose * float(scaled.diagonal().max()))
        motion = (splu(csc_array(scaled + diags_array(lent))).solve(missing) / size).reshape(-1, 6)
        place, quaternion = moved(place, quaternion, motion)
        if not np.linalg.norm(quaternion[:, 1:], axis=1).max() < np.sin(0.5 * TURNED):
            break
        slider, last = springs.slider if accumulates else slider, float(np.abs(missing).sum())
        springs = springs_at(system, place, quaternion, (k_s, slider))
        missing = missing_force(system, springs, quaternion) / size
        if np.abs(missing).max() < tolerated:
            return place, quaternion, springs
        if np.abs(missing).sum() < last:
            loose, share = max(0.5 * loose, LEAST_LOOSE), max(0.5 * share, least)
        else:
            loose, share, least = 2 * loose, 1.0, min(RAISED * least, 1.0)
    raise UnsettledError(place)


def sizes(system: System) -> Array:
    """A length of each body, by which moments are compared with forces: its radius of gyration [m], shape (n,)."""
    bodies = system.bodies
    return np.asarray(np.sqrt(1 / (bodies["mass"] * bodies["ease_xx"])))


def springs_at(system: System, place: Array, quaternion: Array, shear: tuple[Array, Array]) -> Springs:
    """The springs at a pose. `shear` is the shear stiffness of the points, and where their sliders were before."""
    lines, ties, turn = system.lines, system.ties, turns(quaternion)
    pair = np.column_stack([lines["body"], lines["face"]])
    arms, across = apart(pair, (vectors(lines, "at"), vectors(lines, "origin")), place, turn)
    normal = vectors(lines, "normal")
    normal = normal + applied(turn, pair[:, 1], normal)
    gap = np.einsum("ij,ij->i", normal, across)
    push, (k_s, slider) = np.maximum(-lines["k"] * gap, 0.0), shear
    stretch = across - slider - applied(turn, pair[:, 1], slider)
    stretch = stretch - np.einsum("ij,ij->i", normal, stretch)[:, None] * normal
    held, most = k_s * np.linalg.norm(stretch, axis=1), lines["friction"] * push
    slips = held > most
    stays = np.where(slips, most / np.where(slips, held, 1.0), 1.0)
    slid, grips = (1 - stays)[:, None] * stretch, np.where((lines["friction"] == 0) | (gap > 0), 0.0, stays * k_s)
    slider = slider + slid + applied(np.swapaxes(turn, 1, 2), pair[:, 1], slid)
    drag = -(stays * k_s)[:, None] * stretch
    if not len(ties):
        return Springs(pair, arms, normal, -gap, push, drag, grips, slips, slider)
    held_pair = np.column_stack([ties["body"], ties["anchor"]])
    held_arms, between = apart(held_pair, (vectors(ties, "at"), vectors(ties, "origin")), place, turn)
    between = between + vectors(ties, "between")
    length = np.linalg.norm(between, axis=1)
    longer, none = length - ties["reach"], np.zeros(len(ties))
    return Springs(
        np.vstack([pair, held_pair]),
        (np.vstack([arms[0], held_arms[0]]), np.vstack([arms[1], held_arms[1]])),
        np.vstack([normal, -between / length[:, None]]),
        np.append(-gap, longer),
        np.append(push, np.maximum(ties["k"] * longer, 0.0)),
        np.vstack([drag, np.zeros((len(ties), 3))]),
        np.append(grips, none),
        np.append(slips, none > 0),
        slider,
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


def stiffness_of(springs: Springs, k: Array, share: float, bodies: int) -> csr_array:
    """Stiffness of the springs, those along the normals with the given k, shape (6 n, 6 n). Along its slip a point has
    a share of its stiffness."""
    total = csr_array((6 * bodies, 6 * bodies))
    first, second = axes_along(springs.normal, springs.drag)
    along = np.where(springs.slips, share, 1.0) * springs.grips
    for way, weights in ((springs.normal, k), (first, along), (second, springs.grips)):
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
