"""The motion of masonry in a run: openings and slips of its joints, blocks that fall, and blocks that overhang."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import scipy

from ..compiled import compiled, inlined
from ..geometry.frames import frames_of, inverse_rotation_change, take_frames
from ..geometry.graph import connected_parts, nearest_roots
from ..geometry.kinematics import Meeting, Places, meeting
from ..geometry.vectors import Vector, dot, minus, plus, scaled, vector
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.histories import Support
from ..problem.masonry.masonry import Masonry
from ..problem.masonry.rest_geometry import MasonryRestGeometry, travels
from ..quantities import Array, Flags, Integers, named
from ..scene.scene import Scene


@dataclass(frozen=True, eq=False)
class JointMotion:
    """Results of the motion of masonry.

    Args:
        opening: largest gap of each joint [m], shape (joints,). Fixed blocks are where supports have moved them.
        sliding: largest distance by which each joint has slid from rest, at its most pressed line [m], shape (joints,).
        fallen: when each block that fell did [s], by its name, the earliest first. A block has fallen when, as the run
            ends, it is tilted by more than 45 degrees, as one is that rolls over an edge, or no joint that holds
            connects it with a fixed block and it lies lower than at rest by more than half its height. A joint holds
            nothing where one block has slid by more than its width, or where its faces are apart by more than a tenth
            of its width at the nearest point. In MuJoCo, where faces have no end, a block that has slid off its joints
            counts as fallen at once.
        cracked: when each mortared joint that cracked did [s], by its name, the earliest first. A joint has cracked
            when all its lines have less than half of their bond.
    """

    opening: Array
    sliding: Array
    fallen: Mapping[str, float]
    cracked: Mapping[str, float] = field(default_factory=dict)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, JointMotion):
            return NotImplemented
        same = all(np.array_equal(getattr(self, name), getattr(other, name)) for name in ("opening", "sliding"))
        return same and dict(self.fallen) == dict(other.fallen) and dict(self.cracked) == dict(other.cracked)

    __hash__ = None  # type: ignore[assignment]


TOPPLED = 0.25 * np.pi
"""Tilt of a block beyond which it has fallen [rad]."""
DROPPED = 0.5
"""Drop of a block that nothing holds beyond which it has fallen, over its height at rest [-]."""
PARTED = 0.1
"""Gap between the faces of a joint where they are nearest, over its width, beyond which the joint holds nothing [-]."""


def fallen_blocks(masonry: Masonry, t: Array, parted: Flags, tilt: Array, drop: Array) -> dict[str, float]:
    """When each block that fell did [s], by its name, the earliest first.

    A block has fallen when, as the run ends, it is tilted by more than 45 degrees, or no joint that holds connects it
    with a fixed block and it lies lower than at rest by more than half its height. It fell when this became so for
    good.

    Args:
        masonry: the masonry.
        t: times [s], shape (n,).
        parted: whether the blocks of each joint have parted then, shape (n, joints).
        tilt: of each free block from rest [rad], shape (n, bodies).
        drop: how far the centroid of each free block lies below where its ground holds it at rest [m], (n, bodies).
    """
    heights = np.array([np.ptp(masonry.blocks[block].corners[:, -1]) for block in masonry.free])
    toppled, low = tilt > TOPPLED, drop > DROPPED * heights
    pairs, down, since = _pairs(masonry), np.ones(len(masonry.free), dtype=bool), np.full(len(masonry.free), np.inf)
    for n in reversed(range(len(t))):
        down &= toppled[n] | low[n]
        if not down.any():
            break
        if n == len(t) - 1 or (parted[n] != parted[n + 1]).any():
            loose = _are_cut_off(masonry, pairs[~parted[n]])
        down &= toppled[n] | loose
        since[down] = t[n]
    return in_order({masonry.names[block]: when for block, when in zip(masonry.free, since.tolist(), strict=True)})


def left_joints(masonry: Masonry, t: Array, off: Flags) -> dict[str, float]:
    """When each block that left its joints did [s]: it slid off, and none connects it with a fixed block any more.

    In MuJoCo faces have no end and blocks have no other contacts. So such a block moves as no masonry does, and
    it counts as fallen there.

    Args:
        masonry, t: as of `fallen_blocks`.
        off: whether one block of each joint has slid off the other then, shape (n, joints).
    """
    pairs, off = _pairs(masonry), np.logical_or.accumulate(off, axis=0)
    since = np.full(len(masonry.free), np.inf)
    for n in np.flatnonzero(np.diff(off.sum(axis=1), prepend=0)):
        loose = _are_cut_off(masonry, pairs[~off[n]])
        since[loose] = np.minimum(since[loose], t[n])
    return in_order({masonry.names[block]: when for block, when in zip(masonry.free, since.tolist(), strict=True)})


def below_everything(masonry: Masonry, supports: tuple[Support, ...], t: Array, drop: Array) -> list[str]:
    """Names of the blocks that lie below all fixed blocks at the end, having fallen past the edge of the ground.

    Args:
        masonry: the masonry.
        supports: that move fixed blocks.
        t: times [s], shape (n,).
        drop: how far the centroid of each free block lies below where it was at rest [m], shape (n, bodies).
    """
    moved = {support.block: float(support.at(t[-1:])[0, -1]) for support in supports}
    fixed = [(masonry.names[i], block.corners[:, -1].min()) for i, block in enumerate(masonry.blocks) if block.fixed]
    lowest = min(low + moved.get(name, 0.0) for name, low in fixed)
    heights = masonry.centroids[list(masonry.free), -1] - drop[-1]
    return [masonry.names[block] for block, height in zip(masonry.free, heights, strict=True) if height < lowest]


def in_order(when: Mapping[str, float]) -> dict[str, float]:
    """The finite times, the earliest first."""
    return {name: when[name] for name in sorted(when, key=when.__getitem__) if np.isfinite(when[name])}


def sunk_ground(masonry: Masonry, supports: tuple[Support, ...], t: Array) -> Array:
    """How far the ground of each free block has sunk [m], shape (n, bodies). Its ground is the fixed block to which the
    fewest joints lead."""
    fixed = [i for i, block in enumerate(masonry.blocks) if block.fixed]
    nearest = nearest_roots(_pairs(masonry), len(masonry.blocks), fixed)
    sunk = {masonry.names.index(support.block): -support.at(t)[:, -1] for support in supports}
    unsunk = np.zeros(len(t))
    return np.stack([sunk.get(ground, unsunk) for ground in nearest[list(masonry.free)].tolist()], axis=1)


def _pairs(masonry: Masonry) -> Integers:
    """The two blocks of each joint, shape (joints, 2)."""
    return np.array([(joint.below, joint.above) for joint in masonry.joints])


def _are_cut_off(masonry: Masonry, pairs: Integers) -> Flags:
    """Whether no chain of joints connects each free block with a fixed one, shape (bodies,); `pairs` of joints."""
    labels = connected_parts(pairs, len(masonry.blocks))
    fixed = {labels[i] for i, block in enumerate(masonry.blocks) if block.fixed}
    return ~np.isin(labels[list(masonry.free)], list(fixed))


GAPS_AT_ONCE = 1_000_000
"""Most gaps of joints that are in memory at once."""


class JointRecord(NamedTuple):
    """The motion of joints in a run.

    Args:
        opening, sliding: the largest of each joint [m], shape (joints,).
        deepest: the deepest penetration [m].
        off: whether one block of each joint has slid off the other, shape (steps, joints).
        parted: whether the faces of each joint have parted, of the same shape, see `joint_motion`.
    """

    opening: Array
    sliding: Array
    deepest: float
    off: Flags
    parted: Flags


def joint_motion(case: MasonryCase, scene: Scene, t: Array, pose: Array) -> JointRecord:
    """The motion of the joints of masonry, relative to the supports that move.

    The blocks of a joint have parted where one has slid by more than the width of the joint, or where their faces are
    apart by more than a tenth of this width at the nearest point.

    Args:
        case: the case, for the masonry and its supports.
        scene: of the case.
        t: times of the steps or samples [s], shape (steps,).
        pose: at these times, shape (steps, n nq).
    """
    masonry, points, count = case.masonry, JointPoints.of_case(case, scene), len(case.masonry.joints)
    widths = np.array([joint.width for joint in masonry.joints])
    shift = displacements(case.supports, t, scene.freedom.translations)
    opening, sliding, deepest = np.zeros(count), np.zeros(count), 0.0
    off, parted = np.zeros((2, len(pose), count), dtype=bool)
    size = max(1, GAPS_AT_ONCE // max(1, count))
    for first in range(0, len(pose), size):
        batch = slice(first, first + size)
        gaps = _joint_gaps(scene, points, pose[batch], shift[batch])
        distance, off[batch] = _slid_off(case.rest_geometry, gaps.slid)
        parted[batch] = (distance > widths) | (gaps.nearest > PARTED * widths)
        opening, sliding = np.maximum(opening, gaps.opened.max(axis=0)), np.maximum(sliding, distance.max(axis=0))
        deepest = max(deepest, -float(gaps.nearest.min()))
    return JointRecord(opening, sliding, deepest, off, parted)


def slips(case: MasonryCase, scene: Scene, t: Array, pose: Array) -> Array:
    """How far the block above each joint has slid on the one below [m], shape (steps, joints, d)."""
    shift = displacements(case.supports, t, scene.freedom.translations)
    return _joint_gaps(scene, JointPoints.of_case(case, scene), pose, shift).slid


def displacements(supports: Sequence[Support], t: Array, d: int) -> Array:
    """Where supports that move are at some times, from where they are drawn [m], shape (times, supports, d)."""
    moved = np.array([support.at(t) for support in supports]).reshape(len(supports), len(t), d)
    return np.swapaxes(moved, 0, 1)


def _slid_off(geometry: MasonryRestGeometry, slid: Array) -> tuple[Array, Flags]:
    """How far joints have slid [m], and whether one block has left the other, shape (steps, joints) each, from their
    slips [m], shape (steps, joints, d)."""
    if not geometry.masonry.in_space:
        joints = geometry.masonry.plane_joints
        along = np.einsum("sji,ji->sj", slid, np.array([joint.along for joint in joints]))
        back, forth = np.array([joint.travel for joint in joints]).T
        return np.abs(along), (along > forth) | (along < -back)
    widths, distance = np.array([joint.width for joint in geometry.joints]), np.linalg.norm(slid, axis=2)
    off = distance >= widths
    for j in np.flatnonzero(off.any(axis=0)):
        ways = slid[:, j] / np.maximum(distance[:, j], widths[j])[:, None]
        off[:, j] &= distance[:, j] > travels(geometry.faces[j], ways)
    return distance, off


class JointPoints(NamedTuple):
    """The contact points of masonry as those of joints.

    Args:
        at_rest: its place along its face at rest [m], shape (m, d).
        sign: 1 if the block above has it, or -1, shape (m,), see `Scene.sense`.
        support: number of the support that moves its face, -1 where none does, shape (m,).
    """

    at_rest: Array
    sign: Array
    support: Integers

    @classmethod
    def of_case(cls, case: MasonryCase, scene: Scene) -> JointPoints:
        """The points of a case."""
        masonry, places, joint = case.masonry, scene.places, scene.places.joint
        frames = frames_of(scene.at_rest.ravel(), places.freedom)
        at_rest = np.array([_place_on_face(places, i, meeting(places, i, frames), frames) for i in range(len(joint))])
        number = {masonry.names.index(support.block): i for i, support in enumerate(case.supports)}
        below = np.array([number.get(joint.below, -1) for joint in masonry.joints])  # a block above is never fixed
        support = np.where(places.face_body < 0, below[joint], -1)
        return cls(at_rest, scene.sense, support)


class JointGaps(NamedTuple):
    """Joints at some steps: the gap at the widest point and at the nearest [m], shape (steps, joints), and how
    far the block above has slid at the nearest [m], shape (steps, joints, d)."""

    opened: Array
    nearest: Array
    slid: Array


def _joint_gaps(scene: Scene, points: JointPoints, pose: Array, shift: Array) -> JointGaps:
    """The joints at poses, shape (steps, n nq), with supports that are displaced [m], (steps, supports, d)."""
    size = len(pose), len(scene.contacts.joints)
    gaps = JointGaps(np.empty(size), np.empty(size), np.empty((*size, scene.freedom.translations)))
    pose, shift = np.ascontiguousarray(pose), np.ascontiguousarray(shift)
    _write_gaps(scene.places, points, pose, shift, scene.freedom.frames(len(scene.bodies.names)), gaps)
    return gaps


@inlined
def _place_on_face(places: Places, i: int, meets: Meeting, frames: Array) -> Vector:
    """Position of point i along its face, from the origin of the face, in the axes of the face [m]."""
    along, face = minus(meets.offset, scaled(meets.gap, meets.normal)), places.face_body[i]
    return along if face < 0 else plus(along, inverse_rotation_change(frames, face, along))


@inlined
def _meeting_of_moved(places: Places, i: int, frames: Array, shift: Array, support: int) -> Meeting:
    """Where point i and its face meet, which a support may have moved."""
    meets = meeting(places, i, frames)
    if support < 0:
        return meets
    across = minus(meets.offset, vector(shift, support, places.axes))
    return Meeting(dot(meets.normal, across), meets.normal, across, meets.arm, across)


@compiled
def _write_gaps(places: Places, points: JointPoints, pose: Array, shift: Array, frames: Array, gaps: JointGaps) -> None:
    """Write gaps and slips of joints, see `_joint_gaps`; `frames` is room for those of a pose."""
    opened, nearest, slid = gaps
    for n in range(len(pose)):
        take_frames(pose[n], frames, places.axes)
        for j in range(opened.shape[1]):
            opened[n, j], nearest[n, j] = 0.0, np.inf
        for i in range(len(places.joint)):
            meets, j = _meeting_of_moved(places, i, frames, shift[n], points.support[i]), places.joint[i]
            opened[n, j] = max(opened[n, j], meets.gap)
            if meets.gap < nearest[n, j]:
                nearest[n, j] = meets.gap
                along = _place_on_face(places, i, meets, frames)
                for axis in range(len(along)):
                    slid[n, j, axis] = points.sign[i] * (along[axis] - points.at_rest[i, axis])


OVERHANG_SAMPLES = 200
"""Most times at which overhangs are computed."""
LEAST_OVERHANG = 1e-3
"""Overhang that is reported, over the size of the block [-]."""
VERTICAL_FACE = 1e-9
"""Vertical part of the normal of a joint up to which it carries no weight [-]."""


def past_support(
    geometry: MasonryRestGeometry, motion: JointRecord, slips: Callable[[Integers], Array]
) -> dict[str, float]:
    """Largest distance by which the centroid of each block has passed the edge of its support [m], by name.

    Only blocks whose joints are horizontal count. The overhang of the drawing is subtracted.

    Args:
        geometry: the masonry at rest.
        motion: of the joints.
        slips: from the numbers of some steps, how far the block above each joint has slid on the one below [m], shape
            (steps, joints, d).
    """
    masonry, overhangs, slid = geometry.masonry, dict[str, float](), None
    faces = [below.corners[:, :-1] for below, _ in geometry.faces]
    sampled = np.unique(np.linspace(0, len(motion.off) - 1, OVERHANG_SAMPLES).astype(int))
    for block, beds in _beds(masonry).items():
        centroid = geometry.centroids[block, :-1]
        drawn = _distance_beyond(centroid, np.concatenate([faces[j] for j in beds]))
        threshold = max(drawn, 0.0) + LEAST_OVERHANG * masonry.blocks[block].size
        if drawn + motion.sliding[beds].max() < threshold:
            continue
        slid = slips(sampled) if slid is None else slid
        farthest = threshold
        for offsets, off in zip(slid[:, beds, :-1], motion.off[sampled][:, beds], strict=True):
            support = [faces[j] - offset for j, offset, left in zip(beds, offsets, off, strict=True) if not left]
            if support:
                farthest = max(farthest, _distance_beyond(centroid, np.concatenate(support)))
        if farthest > threshold:
            overhangs[masonry.names[block]] = farthest - max(drawn, 0.0)
    return overhangs


def overhang_message(past: Mapping[str, float]) -> str:
    """A sentence that names the blocks that overhang, and how far; empty where none does."""
    texts = [f"{name} by {past[name]:.3g} m" for name in sorted(past, key=past.__getitem__, reverse=True)]
    return (
        f" The weight passed the edge of what it stands on: {named(texts)}. Faces have no end in MuJoCo, where such a "
        "block does not tip; solve_explicit follows it."
        if texts
        else ""
    )


def _beds(masonry: Masonry) -> dict[int, list[int]]:
    """Numbers of the horizontal joints below each block, for blocks without inclined joints below."""
    beds: dict[int, list[int]] = {}
    inclined = set()
    for j, joint in enumerate(masonry.joints):
        up = float(joint.normal[-1])
        if joint.is_bed and up > 0:
            beds.setdefault(joint.above, []).append(j)
        elif not joint.is_bed and abs(up) > VERTICAL_FACE:
            inclined |= {joint.below, joint.above}
    return {block: on for block, on in beds.items() if block not in inclined}


def _distance_beyond(point: Array, corners: Array) -> float:
    """How far a point lies outside of the hull of some corners in plan [m], negative inside."""
    if len(point) == 1:
        return float(max(corners.min() - point[0], point[0] - corners.max()))
    sides = scipy.spatial.ConvexHull(corners).equations
    return float((sides[:, :2] @ point + sides[:, 2]).max())
