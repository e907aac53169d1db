"""Links, which ties and dampers are: between a point of a body and an anchor, on the ground or on another body."""

from __future__ import annotations

from typing import Any, NamedTuple

from ..compiled import inlined
from ..quantities import Array
from .frames import linear, place, rotation_change, spin
from .vectors import Vector, minus, plus, spun, vector


class Ends(NamedTuple):
    """The two ends of a link at a pose.

    Args:
        across: from the anchor to the point [m].
        arm, anchor_arm: from the centroids of the two bodies to them [m]; on the ground there is no such arm.
    """

    across: Vector
    arm: Vector
    anchor_arm: Vector


@inlined
def ends(links: Any, i: int, frames: Array, axes: tuple[int, ...]) -> Ends:
    """The ends of link i of ties or dampers, see `kinematics.Ties`."""
    body, anchor, at = links.body[i], links.anchor_body[i], vector(links.at, i, axes)
    arm = plus(at, rotation_change(frames, body, at))
    across = plus(vector(links.between, i, axes), plus(place(frames, body, axes), minus(arm, at)))
    if anchor < 0:
        return Ends(across, arm, arm)
    at = vector(links.anchor_at, i, axes)
    anchor_arm = plus(at, rotation_change(frames, anchor, at))
    return Ends(minus(across, plus(place(frames, anchor, axes), minus(anchor_arm, at))), arm, anchor_arm)


@inlined
def parting(links: Any, i: int, at: Ends, frames: Array, v: Array, axes: tuple[int, ...]) -> Vector:
    """Velocity of the point of link i over its anchor [m/s]; for accelerations the part that is linear in them."""
    body, anchor = links.body[i], links.anchor_body[i]
    velocity = plus(linear(v, body, axes), spun(spin(frames, v, body, axes), at.arm))
    if anchor < 0:
        return velocity
    return minus(velocity, plus(linear(v, anchor, axes), spun(spin(frames, v, anchor, axes), at.anchor_arm)))
