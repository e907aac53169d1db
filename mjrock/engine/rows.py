"""Rows: what MuJoCo solves for each contact in a step, from the contact law and the length of the step.

A friction row has no spring, only a dashpot, and the inertia of its normal row times impratio. With a damping rate of
1/h, solreffriction = (~0, -d/h), it stops the slip within one step, but for the share of the force that its inertia
leaves: under a load F along its face a contact that sticks creeps at F h / m_f, with m_f the inertia of its friction
row, `Points.friction_inertia` times max(1, growth h). In steps longer than 1 / growth it creeps no faster. MuJoCo has
one impratio for all contacts. It is the largest with which no friction row has more inertia than it should.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..contacts.solref import RowStep, body_weight, pair_values, row
from ..geometry.kinematics import Places
from ..method import METHOD, Method
from ..quantities import Array, Flags, frozen
from ..scene.scene import Scene


class Points(NamedTuple):
    """The contacts of a scene, and what the loops and MuJoCo's rows need of them besides.

    Args:
        places: the contacts.
        weight: sum of MuJoCo's inverse weights of the two bodies W [1/kg], shape (m,).
        overdamped, resolved: c h W from which a dashpot is stiff for a step with ringing and for one without, see
            `solref.row` [-], shape (m,).
        friction_inertia: inertia that the friction rows should have [kg], zero where there is no friction, shape (m,).
        growth: how it grows with the step: by the factor growth h, where that is more than one [1/s].
        bears: penetration of each at rest [m], zero where it is open, shape (m,).
        opened, overlapped: largest gap and deepest penetration that a run follows [m].
        rubs: which slide by Coulomb's law, see `mjrock.engine.sliding`, shape (m,).
    """

    places: Places
    weight: Array
    overdamped: Array
    resolved: Array
    friction_inertia: Array
    growth: float
    bears: Array
    opened: float
    overlapped: float
    rubs: Flags


def inverse_weights(scene: Scene) -> Array:
    """Sum of MuJoCo's inverse weights of the two bodies of each contact [1/kg], shape (m,)."""
    inverse = body_weight(scene.bodies.mass, scene.freedom.translations)
    face = scene.contacts.face_body
    return frozen(inverse[scene.contacts.body] + np.where(face < 0, 0.0, inverse[face]))


@lru_cache(maxsize=64)
def points_of(scene: Scene, method: Method = METHOD) -> Points:
    """The contacts of a scene.

    Friction of a base that holds is a number that holds it, and no law of sliding. A joint that bears weight, and whose
    dashpot is weaker than the stiffest vibration, has it centred where the method or the scene requires that.
    """
    weight = inverse_weights(scene)
    held = method.held_masses * scene.freedom.translations / (3 * weight)
    mild = (scene.bears > 0) & (scene.contacts.c * weight < scene.highest_frequency)
    joints = scene.limits.damped_joints
    resolved = np.where(mild, method.borne if joints else method.resolved, method.overdamped)
    return Points(
        places=scene.places,
        weight=weight,
        overdamped=resolved if joints else np.full_like(resolved, method.overdamped),
        resolved=resolved,
        friction_inertia=frozen(np.where(scene.contacts.friction > 0, held, 0.0)),
        growth=0.0 if np.any(scene.contacts.holds) else method.held_growth * scene.rocking_frequency,
        bears=scene.bears,
        opened=scene.limits.reach,
        overlapped=scene.limits.overlap,
        rubs=frozen((scene.contacts.friction > 0) & np.logical_not(scene.contacts.holds)),
    )


class Step(NamedTuple):
    """A step.

    Args:
        h: its length [s].
        beta: Newmark's beta of each contact [-], shape (m,).
        ringing: an extra dashpot of each in units of h k [-], shape (m,).
    """

    h: float
    beta: Array
    ringing: Array


class ContactRows(NamedTuple):
    """The rows as MuJoCo keeps them, shapes (m, 2), (m, 2 or more) and (m, 2)."""

    solref: Array
    solimp: Array
    solreffriction: Array

    @classmethod
    def with_room(cls, contacts: int) -> ContactRows:
        """Room for the rows of some contacts."""
        return cls(
            np.zeros((contacts, 2)), np.tile((0.0, 0.0, 0.001, 0.5, 2.0), (contacts, 1)), np.zeros((contacts, 2))
        )


@inlined
def row_of(points: Points, i: int, step: Step) -> tuple[float, float]:
    """Dashpot [N s/m] and inertia [kg] of the row of contact i in a step, see `solref.row`."""
    stiff, places = points.overdamped[i] if step.ringing[i] > 0 else points.resolved[i], points.places
    own = RowStep(step.h, step.beta[i], step.ringing[i], stiff)
    return row(places.k[i], places.c[i], points.weight[i], own)


@inlined
def impratio_of(points: Points, i: int, normal: float, h: float) -> float:
    """Inertia that the friction row of contact i should have in a step h, over that of its normal row [-]."""
    if points.friction_inertia[i] == 0:
        return math.inf
    return max(points.growth * h, 1.0) * points.friction_inertia[i] / normal


@inlined
def set_rows(points: Points, step: Step, rows: ContactRows) -> float:
    """Write the rows of all contacts for a step, and return the `impratio` of the model [-]."""
    impratio, k = math.inf, points.places.k
    for i in range(len(k)):
        dashpot, normal = row_of(points, i, step)
        rows.solref[i, 0], rows.solref[i, 1], d = pair_values(k[i], dashpot, normal, points.weight[i])
        rows.solimp[i, 0] = rows.solimp[i, 1] = d
        if points.friction_inertia[i] > 0:
            rows.solreffriction[i, 0], rows.solreffriction[i, 1] = -1e-30, -d / step.h
        impratio = min(impratio, impratio_of(points, i, normal, step.h))
    return impratio if impratio < math.inf else 1.0
