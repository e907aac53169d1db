"""Pairs: which pieces of a plain model are neighbours, and the law of the contacts that MuJoCo finds between any two.

A joint has k_n times its area, and MuJoCo finds four points where two faces lie on each other, two where one stands on
an edge: a point has a quarter of the joint. Any two pieces without a joint meet with the frequency and the damping of
the median joint: MuJoCo then gives each two of them a stiffness in proportion to their masses. Those for which the
masonry gives friction and damping are pairs with that stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from ...contacts.solref import RowStep, body_weight, pair_values, row
from ...method import METHOD
from ...problem.masonry.laws.dry import PairProperties
from ...problem.wall.rest_geometry import in_space
from ...quantities import Array, Integers
from ...scene.parts import GROUND
from ...scene.scene import Scene
from .pieces import Piece

FRICTION_MASSES = 100.0
"""Inertia of a friction row of several bodies in masses of the body that it holds [-]. Under an acceleration a along
its face a contact that sticks creeps at a h / FRICTION_MASSES. With ten times as much a step of thirty blocks takes 1.7
times as long."""
NO_BODY = -2
"""Number of the body of a piece that is only seen."""
POINTS = 4
"""Points that MuJoCo finds where two faces lie on each other [-]."""


@dataclass(frozen=True, eq=False)
class Pairs:
    """Pairs of pieces that share a joint, then pairs whose law is given. The last row is the law of any other two, for
    an inverse weight of one.

    Args:
        pieces: numbers of the two pieces of each pair, shape (p, 2).
        of_joint: number of their joint, or how many joints there are where they have none, shape (p + 1,).
        weight: sum of MuJoCo's inverse weights of the two bodies [1/kg], shape (p + 1,).
        k, c: spring [N/m] and dashpot [N s/m] of one point, shape (p + 1,).
        friction: coefficient of friction [-], shape (p + 1,).
        friction_inertia: inertia of a friction row in masses of the body that it holds [-].
    """

    pieces: Integers
    of_joint: Integers
    weight: Array
    k: Array
    c: Array
    friction: Array
    friction_inertia: float

    @classmethod
    def in_scene(cls, scene: Scene, pieces: list[Piece]) -> Pairs:
        """The pairs of pieces between which the scene has contacts."""
        contacts, bodies = scene.contacts, scene.bodies
        carriers = np.sort(np.stack(_carriers(scene, pieces), axis=1), axis=1)
        jointed, line, pair = np.unique(carriers, axis=0, return_index=True, return_inverse=True)
        k, c, rubbing = (
            np.bincount(pair.ravel(), weights=values)
            for values in (contacts.k, contacts.c, contacts.friction * contacts.k)
        )
        inverse = np.append(body_weight(bodies.mass, scene.freedom.translations), 0.0)  # the last one of the ground
        of_piece = inverse[np.array([piece.body for piece in pieces])]
        weight = of_piece[jointed].sum(axis=1)
        laws = np.stack([weight, k / POINTS, c / POINTS, rubbing / k])
        others = np.array([1.0, *np.median([weight * laws[1], weight * laws[2], laws[3]], axis=1)])
        unjointed, properties = _pairs_without_joint(scene, pieces, jointed)
        unjointed_weight = of_piece[unjointed].sum(axis=1)
        unjointed_k = np.divide(others[1], unjointed_weight)
        unjointed_laws = [unjointed_weight, unjointed_k, properties[:, 1] * unjointed_k, properties[:, 0]]
        pairs = np.concatenate([jointed, unjointed])
        order = np.lexsort(pairs.T[::-1])
        joint = np.append(contacts.joint[line], np.full(len(unjointed), len(contacts.joints)))[order]
        weight, k, c, friction = np.column_stack([laws, unjointed_laws])[:, order]
        return cls(
            pieces=pairs[order],
            of_joint=np.append(joint, len(contacts.joints)),
            weight=np.append(weight, others[0]),
            k=np.append(k, others[1]),
            c=np.append(c, others[2]),
            friction=np.append(friction, others[3]),
            friction_inertia=METHOD.held_masses if len(bodies.names) == 1 else FRICTION_MASSES,
        )

    def rows(self, timestep: float) -> PairRows:
        """The parameters of MuJoCo for the pairs at a step [s], see `mjrock.engine.rows`."""
        count = len(self.k)
        solref, impedance, inertia = np.zeros((count, 2)), np.zeros(count), np.zeros(count)
        step = RowStep(timestep, overdamped=METHOD.borne)
        for i in range(count):
            dashpot, inertia[i] = row(self.k[i], self.c[i], self.weight[i], step)
            *solref[i], impedance[i] = pair_values(self.k[i], dashpot, inertia[i], self.weight[i])
        rough = self.friction > 0
        of_friction = self.friction_inertia / self.weight[rough]
        ratio = float((of_friction / inertia[rough]).min()) if rough.any() else 1.0
        return PairRows(solref, impedance, -impedance / timestep, max(1.0, ratio))


@dataclass(frozen=True, eq=False)
class PairRows:
    """Rows of pairs: solref in the direct format (p + 1, 2), the impedance [-], the second number of solreffriction
    [1/s], shape (p + 1,) each, and the impratio of the model [-]."""

    solref: Array
    impedance: Array
    friction_rate: Array
    impratio: float


def _pairs_without_joint(scene: Scene, pieces: list[Piece], jointed: Integers) -> tuple[Integers, Array]:
    """Pieces of two blocks without a joint whose law the masonry gives, shape (n, 2), and the friction and dashpot over
    spring of each two, shape (n, 2)."""
    unjointed, properties = list[tuple[int, int]](), list[PairProperties]()
    if scene.springs is not None and scene.springs.pairs is not None:
        names = [solid.name for solid in scene.rest_geometry.solids]
        neighbours = {frozenset((pieces[a].block, pieces[b].block)) for a, b in jointed.tolist()}
        by_block = {name: [i for i, part in enumerate(pieces) if part.block == name and part.meets] for name in names}
        for i, j in combinations(range(len(names)), 2):
            first, second = by_block[names[i]], by_block[names[j]]
            fixed = all(pieces[k].body == GROUND for k in (*first[:1], *second[:1]))
            if fixed or {names[i], names[j]} in neighbours or (law := scene.springs.of_pair(i, j)) is None:
                continue
            pairs = [(min(pair), max(pair)) for pair in product(first, second)]
            unjointed, properties = [*unjointed, *pairs], [*properties, *[law] * len(pairs)]
    return np.reshape(unjointed, (-1, 2)).astype(np.int64), np.reshape(properties, (-1, 2)).astype(float)


def _carriers(scene: Scene, pieces: list[Piece]) -> tuple[Integers, Integers]:
    """The piece that carries each contact point, and the one whose face it meets, shape (m,) each."""
    contacts, centroids = scene.contacts, scene.bodies.rest
    place = centroids[contacts.body] + contacts.at
    met = np.where((contacts.face_body == GROUND)[:, None], 0.0, centroids[contacts.face_body])
    first = _nearest(pieces, contacts.body, contacts.at, -contacts.normal)
    return first, _nearest(pieces, contacts.face_body, place - met, contacts.normal)


def _nearest(pieces: list[Piece], body: Integers, points: Array, normals: Array) -> Integers:
    """The piece of its body on which each point lies, shape (m,), from points in the frame of the body [m] and the
    normals of the body there."""
    chosen, points, normals = np.zeros(len(points), dtype=np.int64), in_space(points), in_space(normals)
    carrier = np.array([piece.body if piece.meets else NO_BODY for piece in pieces])
    for j in np.unique(body):
        candidates, of_body = np.flatnonzero(carrier == j), body == j
        distance = np.array([pieces[i].distance(points[of_body], normals[of_body]) for i in candidates])
        chosen[of_body] = candidates[distance.argmin(axis=0)]
    return chosen
