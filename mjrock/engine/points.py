"""Points: the contacts of a scene as the engine's loops take them."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..geometry.kinematics import Places
from ..method import METHOD, Method
from ..quantities import Array, Flags, frozen
from ..scene.scene import Scene
from .rows import ContactLaw, RowInertia
from .solref import body_weight


class Reach(NamedTuple):
    """How far contacts go.

    Args:
        bears: penetration of each at rest [m], zero where it is open, shape (m,).
        opened, overlapped: largest gap and deepest penetration that a run follows [m].
    """

    bears: Array
    opened: float
    overlapped: float


class Points(NamedTuple):
    """The contacts of a scene.

    Args:
        places: where they are.
        law: their springs, dashpots and friction.
        inertia: what MuJoCo's rows need besides.
        reach: how far they go.
        rubs: which slide by Coulomb's law, see `mjrock.engine.sliding`, shape (m,).
    """

    places: Places
    law: ContactLaw
    inertia: RowInertia
    reach: Reach
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
    dashpot is weaker than the stiffest vibration, has it centred where the method or the scene asks for that.
    """
    weight = inverse_weights(scene)
    held = method.held_masses * scene.freedom.translations / (3 * weight)
    mild = (scene.bears > 0) & (scene.contacts.c * weight < scene.highest_frequency)
    joints = scene.limits.damped_joints
    resolved = np.where(mild, method.borne if joints else method.resolved, method.overdamped)
    return Points(
        places=scene.places,
        law=ContactLaw(scene.contacts.k, scene.contacts.c, scene.contacts.friction),
        inertia=RowInertia(
            weight=weight,
            overdamped=resolved if joints else np.full_like(resolved, method.overdamped),
            resolved=resolved,
            friction=frozen(np.where(scene.contacts.friction > 0, held, 0.0)),
            growth=0.0 if np.any(scene.contacts.holds) else method.held_growth * scene.rocking_frequency,
        ),
        reach=Reach(scene.bears, scene.limits.reach, scene.limits.overlap),
        rubs=frozen((scene.contacts.friction > 0) & np.logical_not(scene.contacts.holds)),
    )
