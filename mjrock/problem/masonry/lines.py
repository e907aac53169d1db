"""Contact lines of the joints of masonry, and the lowest frequency of masonry whose joints are all closed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.linalg import null_space

from ...geometry.frames import PLANE, push_body
from ...quantities import Array, Integers
from ..damping.interface import contact_lines
from .joints import Joint
from .polygon import Polygon

RIGID = 1e-12
"""Square of a frequency, over that of the highest, below which a mode is a motion that no joint resists [-]."""


class Lines(NamedTuple):
    """Contact lines: points on one block that meet the face of another.

    Args:
        joint: number of the joint that each belongs to, shape (m,).
        body: number of the block that carries the point, which is never fixed, shape (m,).
        face: number of the block whose face it meets, shape (m,).
        at: where, at rest [m], shape (m, 2).
        normal: unit vector out of the face, shape (m, 2).
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
        """Unit vectors along the faces, a quarter turn from the normals, shape (m, 2)."""
        return np.column_stack([self.normal[:, 1], -self.normal[:, 0]])


def lines_of(blocks: Sequence[Polygon], joints: Sequence[Joint], k_n: Array, points: int) -> Lines:
    """The lines of all joints, evenly spaced from end to end of each, the outer two with half the tributary width.

    The point is on the block above. At an end where the block above overhangs, the corner is that of the block below,
    and the point is on the block below, unless that one is fixed.

    Each joint has its own k_n [N/m3], and all have the same number of points.
    """
    rows: list[tuple[int, int, int]] = []
    at, normal, k = [], [], []
    for number, joint in enumerate(joints):
        places, widths = contact_lines(joint.width, points)
        for i, (place, width) in enumerate(zip(places, widths, strict=True)):
            overhangs = (i == 0 and not joint.corners[0]) or (i == points - 1 and not joint.corners[1])
            turned = overhangs and not blocks[joint.below].fixed
            rows.append((number, *((joint.below, joint.above) if turned else (joint.above, joint.below))))
            at.append(joint.middle + place * joint.along)
            normal.append(-joint.normal if turned else joint.normal)
            k.append(k_n[number] * joint.length * width)
    joint_of, body, face = np.array(rows, dtype=np.int64).reshape(-1, 3).T
    return Lines(joint_of, body, face, np.reshape(at, (-1, 2)), np.reshape(normal, (-1, 2)), np.array(k))


def rates(blocks: Sequence[Polygon], lines: Lines, directions: Array) -> Array:
    """Rates at which the lines move apart in given directions, for unit velocities of the blocks at rest.

    They are the generalised forces of unit forces that press the two blocks of a line apart.

    Directions are unit vectors, shape (m, 2). Along the normals the rates are those of the gaps.

    Returns:
        Rates for x, z and rotation of each block that is not fixed, in order, shape (m, 3 bodies).
    """
    free = [i for i, block in enumerate(blocks) if not block.fixed]
    number, frames = {block: body for body, block in enumerate(free)}, np.zeros((len(free), 4))
    rates = np.zeros((len(lines.k), PLANE.nv * len(free)))
    for sign, carrier in ((1.0, lines.body), (-1.0, lines.face)):
        for i, block in enumerate(carrier.tolist()):
            if block in number:
                arm = tuple((lines.at[i] - blocks[block].centroid).tolist())
                push_body(frames, number[block], arm, tuple((sign * directions[i]).tolist()), rates[i])
    return rates


def lowest_frequency(blocks: Sequence[Polygon], lines: Lines, friction: Array) -> float:
    """The lowest natural frequency of masonry whose joints are all closed and do not slide [rad/s].

    Joints without friction slide. Motions that no joint resists, such as the fall of a loose block, do not count. The
    weight's own part of the stiffness is left out, as in `reference_frequency`, which is the case of one block.
    """
    free = [block for block in blocks if not block.fixed]
    masses = np.array([(block.mass, block.mass, block.inertia) for block in free]).ravel()
    open_up = rates(blocks, lines, lines.normal) / np.sqrt(masses)
    sideways = rates(blocks, lines, lines.along) / np.sqrt(masses)
    slips = [sideways[lines.joint == joint].mean(axis=0) for joint in np.flatnonzero(friction > 0)]
    left = null_space(np.reshape(slips, (-1, len(masses))), rcond=1e-9)  # the motions without slip
    squares = np.linalg.eigvalsh((left.T @ (open_up.T * lines.k)) @ (open_up @ left)) if left.shape[1] else np.zeros(0)
    squares = squares[squares > RIGID * max(squares, default=0.0)]
    if not squares.size:
        raise ValueError("the blocks have no joint that a motion could compress, and xi refers to no frequency")
    return math.sqrt(float(squares[0]))
