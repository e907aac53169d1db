"""Contact lines of the joints of masonry, points in space, and the lowest frequency of masonry with closed joints."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array, vstack

from ...geometry.convex import exact_shares, sectioned, spread, within
from ...linear import averaged, block_diagonal, lowest_square, rates_matrix, rates_of, stiffness_of_springs
from ...quantities import Array, Flags, Integers
from ..damping.contacts import even_lines
from .blocks.compound import AnyBlock
from .blocks.joints import LEVEL, Joint
from .blocks.joints_in_space import SpaceJoint, tangent_axes
from .blocks.polygon import Polygon

UNRESISTED = 1e-12
"""Square of a frequency, over that of the highest, below which a mode is a motion that no joint resists [-]."""
EDGE_WITHIN = 1e-5
"""Distance from an edge of a face up to which a point is on it [m]."""


class Lines(NamedTuple):
    """Contact lines, in space contact points: points on one block that meet the face of another.

    Args:
        joint: number of the joint that each belongs to, shape (m,).
        body: number of the block that carries the point, which is never fixed, shape (m,).
        face: number of the block whose face it meets, shape (m,).
        at: where, at rest [m], shape (m, 2), in space (m, 3).
        normal: unit vector out of the face, shape (m, 2), in space (m, 3).
        k: stiffness [N/m], shape (m,).
    """

    joint: Integers
    body: Integers
    face: Integers
    at: Array
    normal: Array
    k: Array

    @property
    def along(self) -> Array:
        """In the plane, unit vectors along the faces, a quarter turn from the normals, shape (m, 2)."""
        return np.column_stack([self.normal[:, 1], -self.normal[:, 0]])

    @property
    def tangents(self) -> tuple[Array, ...]:
        """Unit vectors along the faces: in the plane `along`; in space two, perpendicular to each other, (m, 3).

        Opposite normals have opposite vectors, so that all points of a joint count its slip in the same directions.
        """
        if self.normal.shape[1] == 2:
            return (self.along,)
        leading = np.abs(self.normal).argmax(axis=1)
        signs = np.sign(self.normal[np.arange(len(leading)), leading])[:, None]
        pairs = signs[:, None] * tangent_axes(signs * self.normal)
        return pairs[:, 0], pairs[:, 1]


class Spot(NamedTuple):
    """A place of a joint.

    Args:
        at: where [m].
        stiffness: of its line [N/m].
        overhangs: whether its corner or edge is that of the block below.
        on_one_edge: whether it lies on an edge of one face alone. No place of the plane does.
    """

    at: Array
    stiffness: float
    overhangs: bool
    on_one_edge: bool = False


def lines_of(
    blocks: Sequence[AnyBlock],
    joints: Sequence[Joint | SpaceJoint],
    k_n: Array,
    points: Integers | int,
    bonded: Sequence[bool] | None = None,
    *,
    mirrored: bool = True,
) -> Lines:
    """The contact lines of all joints, or in space their contact points.

    The point is on the block above. Where that one overhangs, the corner or edge is that of the block below, and the
    point is on the block below, unless that one is fixed. Lines are `mirrored` where the masonry is: of two blocks
    beside each other the point is on the one that is farther from the middle of the masonry, where both or neither
    have a corner or an edge there. If they are as far, it is on either, with half the stiffness. The stiffness of each
    joint is k_n [N/m3], shape (joints,). A joint has as many lines as `points`, of each of them or of all, in
    space see `geometry.convex.spread`.
    Those that are `bonded` have the stiffness k_n I in bending, see `geometry.convex.sectioned`.
    """
    rows, at, normal, k = [], [], [], []
    divided: dict[tuple[bytes, int, bool], tuple[Array, Array]] = {}
    centroids, fixed = np.array([block.centroid for block in blocks]), np.array([block.fixed for block in blocks])
    distances = np.linalg.norm((centroids - centroids[~fixed].mean(axis=0))[:, :-1], axis=1).tolist()
    counts = np.broadcast_to(points, len(joints)).tolist()
    for number, (joint, count) in enumerate(zip(joints, counts, strict=True)):
        k_joint, exact = k_n[number], bonded is not None and bonded[number]
        if isinstance(joint, Joint):
            spots = list(_spots_on_edge(joint, count, k_joint, exact))
        else:
            faces = [blocks[i].sides[j].corners for i, j in zip((joint.below, joint.above), joint.sides, strict=True)]
            shape = joint.flat.tobytes(), count, exact
            if shape not in divided:
                divided[shape] = sectioned(joint.flat, count) if exact else spread(joint.flat, count)
            flat, areas = divided[shape]
            spots = _spots_on_face(joint, faces, flat, k_joint * areas)
        below, above, upwards = blocks[joint.below], blocks[joint.above], joint.normal
        vertical = mirrored and abs(upwards[-1]) < LEVEL and not below.fixed
        beside = _is_outer(distances[joint.above], distances[joint.below]) if vertical else ()
        alike = _have_corners(below, spots) == _have_corners(above, spots) if beside else ()
        for i, spot in enumerate(spots):
            turns: tuple[bool, ...] = (spot.overhangs and not below.fixed,)
            if beside and not spot.on_one_edge and alike[i]:
                turns = beside
            for turned in turns:
                rows.append((number, *((joint.below, joint.above) if turned else (joint.above, joint.below))))
                at.append(spot.at)
                normal.append(-upwards if turned else upwards)
                k.append(spot.stiffness / len(turns))
    joint_of, body, face = np.array(rows, dtype=np.int64).T
    return Lines(joint_of, body, face, np.array(at), np.array(normal), np.array(k))


def _is_outer(above: float, below: float) -> tuple[bool, ...]:
    """Whether the point of a joint is on the block below, as that is farther from the middle of the masonry, apart from
    heights [m]. Both answers where the two blocks are as far."""
    return (False, True) if abs(below - above) <= EDGE_WITHIN else (below > above,)


def _have_corners(block: AnyBlock, spots: Sequence[Spot]) -> Flags:
    """Which of some places have a corner of a block at them."""
    places = np.array([spot.at for spot in spots])
    return np.asarray(np.abs(block.corners - places[:, None]).max(axis=2).min(axis=1) < EDGE_WITHIN)


def _spots_on_edge(joint: Joint, points: int, k_n: float, exact: bool) -> Iterator[Spot]:
    """Places of the lines of a joint, evenly from end to end.

    The outer two have half the tributary width, or in a joint that is `exact` less, see `exact_shares`.
    """
    places, widths = even_lines(joint.width, points)
    widths = joint.width * exact_shares(points) if exact else widths
    for i, (place, width) in enumerate(zip(places, widths.tolist(), strict=True)):
        overhangs = (i == 0 and not joint.corners[0]) or (i == points - 1 and not joint.corners[1])
        yield Spot(joint.middle + place * joint.along, k_n * joint.length * width, overhangs)


def _spots_on_face(joint: SpaceJoint, faces: Sequence[Array], flat: Array, k: Array) -> list[Spot]:
    """The same of the points of a joint in space, which lie `flat` in its plane, and have the stiffness k [N/m]. Those
    at its corners may be of the block below alone, and those on an edge of the face below that lies within the face
    above are."""
    below, above = ((face - joint.outline[0]) @ joint.axes.T for face in faces)
    on_below, on_above = within(below, flat) < EDGE_WITHIN, within(above[::-1], flat) < EDGE_WITHIN
    places = joint.outline[0] + flat @ joint.axes
    distances = np.abs(joint.outline - places[:, None]).max(axis=2)
    at_corner = (distances.min(axis=1) < 1e-9) & np.array(joint.corners)[distances.argmin(axis=1)]
    overhangs, on_one_edge = (on_below & ~on_above) | at_corner, on_below != on_above
    return [Spot(*spot) for spot in zip(places, k, overhangs.tolist(), on_one_edge.tolist(), strict=True)]


def rates(blocks: Sequence[AnyBlock], lines: Lines, directions: Array) -> csr_array:
    """Rates at which the lines move apart in given directions, see `mjrock.linear.rates_of`.

    Directions have the shape (m, 2), in space (m, 3), or (n, m, d) for n directions of each, the rows of the first
    before the second. Along the normals the rates are those of the gaps. The bodies are the blocks that are not fixed,
    in order.
    """
    centroids, number = np.array([block.centroid for block in blocks]), free_numbers(blocks)
    times = (len(directions) if directions.ndim == 3 else 1, 1)
    pair = np.tile(number[np.column_stack([lines.body, lines.face])], times)
    arms = np.tile(lines.at - centroids[lines.body], times), np.tile(lines.at - centroids[lines.face], times)
    return rates_of(pair, arms, directions.reshape(-1, directions.shape[-1]), int(number.max()) + 1)


def free_numbers(blocks: Sequence[AnyBlock]) -> Integers:
    """Number of each block among those that are not fixed, -1 for one that is, shape (blocks,)."""
    free = np.array([not block.fixed for block in blocks])
    return np.where(free, np.cumsum(free) - 1, -1)


def mean_slip_rates(blocks: Sequence[AnyBlock], lines: Lines, joints: int) -> csr_array:
    """Mean rates at which the lines of each joint slide for unit velocities, shape (joints, 3 bodies).

    In space a joint has three: along the two directions of `Lines.tangents`, and the rate at which it twists about its
    normal [rad/s]. The shape is (3 joints, 6 bodies), the first of all joints before the second.
    """
    directions = np.array(lines.tangents)
    group = np.add.outer(joints * np.arange(len(directions)), lines.joint).ravel()
    parts = [averaged(rates(blocks, lines, directions), group, joints * len(directions))]
    if lines.normal.shape[1] == 3:
        number = free_numbers(blocks)
        spins = lines.normal[:, None] * np.array([[1.0], [-1.0]])
        values = np.concatenate([np.zeros_like(spins), spins], axis=-1)
        twists = rates_matrix(values, number[np.column_stack([lines.body, lines.face])], parts[0].shape[1])
        parts.append(averaged(twists, lines.joint, joints))
    return parts[0] if len(parts) == 1 else csr_array(vstack(parts))


def lowest_frequency(
    blocks: Sequence[AnyBlock], lines: Lines, friction: Array, along: Array | float = math.inf
) -> float:
    """The lowest natural frequency of masonry whose joints are all closed and do not slide [rad/s].

    Joints without friction slide. Motions that no joint resists, such as the fall of a loose block, do not count. The
    weight's own part of the stiffness is left out, as in `reference_frequency`, which is the case of one block.

    Inclined faces may leave no motion in which none of them slides, as those of a wedge do. There joints deform along
    their faces by their springs `along` [N/m], shape (m,), and slide where these are infinite.
    """
    masses, axes = masses_of(blocks)

    def about_axes(moves: csr_array) -> csr_array:
        return moves if axes is None else csr_array(moves @ axes)

    opening = about_axes(rates(blocks, lines, lines.normal))
    sliding = about_axes(mean_slip_rates(blocks, lines, len(friction)))
    sticking = np.isin(np.arange(len(friction)), lines.joint) & (friction > 0)
    sticking_rates = sliding[np.tile(sticking, sliding.shape[0] // len(sticking))]
    stiffness = stiffness_of_springs(opening, lines.k)
    square = lowest_square(stiffness, masses, sticking_rates, UNRESISTED)
    if square == 0:
        springs = np.where(np.isfinite(along) & (friction > 0)[lines.joint], along, 0.0)
        for tangent in lines.tangents:
            stiffness = stiffness + stiffness_of_springs(about_axes(rates(blocks, lines, tangent)), springs)
        square = lowest_square(stiffness, masses, sticking_rates[:0], UNRESISTED)
    return math.sqrt(square)


def masses_of(blocks: Sequence[AnyBlock]) -> tuple[Array, csr_array | None]:
    """Mass or moment of inertia of each unknown of the blocks that are not fixed [kg, kg m2], shape (unknowns,).

    In space they are those of rotations about the principal axes. The second value then holds the unknowns of `rates`
    for unit ones about these axes, in its columns, shape (unknowns, unknowns).
    """
    solids = [block for block in blocks if not isinstance(block, Polygon) and block.in_space and not block.fixed]
    if solids:
        axes = block_diagonal(np.array([part for block in solids for part in (np.eye(3), block.principal.axes)]))
        return np.array([(*[block.mass] * 3, *block.principal.moments) for block in solids]).ravel(), axes
    return np.array([(block.mass, block.mass, block.inertia) for block in blocks if not block.fixed]).ravel(), None
