"""Forces of joints and links, and reactions of fixed blocks, at the samples of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..problem.masonry.case import AnyCase
from ..problem.wall.rest_geometry import JointFrames
from ..quantities import Array, require_size
from .bodies import BodyMotion
from .ties import link_vector

ANCHORS = "anchors"
"""Name of the reaction of all links whose anchors are on no block, and of actuators."""


@dataclass(frozen=True, eq=False, repr=False)
class Forces:
    """Forces at the samples of a run with `forces=True`.

    A force is the one that acts at the pose of its sample, with dashpots and friction. The steps of a solver let it act
    from half a step before the pose to half a step after it: the sum of the reactions and of the constant forces is the
    mass of all bodies times their mean acceleration in that time, with gravity and the acceleration of the ground.

    A joint is that of the drawing, in the order of `masonry.joints`; those of a wall are "base" and, where it has one,
    "side". Its axes turn with the block below it: the normal out of that block, in the plane the direction a quarter
    turn to the right of it, which is x on a bed joint, and in space `SpaceJoint.axes`. Forces are those on the block
    above. A joint that explicit steps have handed over to contacts found where blocks are has none any more.

    Args:
        frames: the joints at rest.
        normal: normal force, positive where it presses [N], shape (n, joints).
        shear: force along the joint [N], shape (n, joints), and in space along its two axes, (n, joints, 2).
        eccentricity: distance from the middle of the joint to where the resultant passes through its plane, along the
            joint [m], of the shape of `shear`, also where a bond pulls; NaN without a normal force.
        moment: of the forces about the middle of the joint, positive with theta [N m], shape (n, joints), in space
            about the normal and the two axes, (n, joints, 3).
        links: what each tie, damper or other link pulls with, negative where it pushes [N], shape (n,), by its name.
        reactions: forces on the masonry by each fixed block, moved or not, along x and z and in space x, y and z [N],
            shape (n, 2) or (n, 3), by its name: of all its contacts, whether of joints or found where blocks are, and
            of the links that are anchored on it. "anchors" is that of all links anchored on no block, and of actuators
            and their guides. Of a wall those of "base", "side" and "anchors".
        guides: what the guide of an actuator does to its block, by the name of the block: the vertical force [N], zero
            where the block may rise, and the moment about its centroid, positive with theta [N m], shape (n, 2), in
            space about x, y and z, shape (n, 4). It balances all other forces on the block.
        damage: share of its bond that each joint has lost [-], shape (n, joints), NaN where it is dry.
    """

    frames: JointFrames
    normal: Array
    shear: Array
    eccentricity: Array
    moment: Array
    links: Mapping[str, Array]
    reactions: Mapping[str, Array]
    guides: Mapping[str, Array]
    damage: Array

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints, in their order."""
        return self.frames.names

    @property
    def largest_reaction(self) -> float:
        """The largest reaction of a fixed block, or of the base or the side of a wall, among the samples [N]."""
        largest = [np.linalg.norm(force, axis=1).max() for name, force in self.reactions.items() if name != ANCHORS]
        return float(max(largest))

    def columns(self) -> dict[str, Array]:
        """All of them as columns of a table, with their units, shape (n,) each."""
        d = self.frames.middle.shape[1]
        columns: dict[str, Array] = {}
        for name, force in self.reactions.items():
            columns |= {
                f"reaction {axis} of {name} [N]": force[:, i] for i, axis in enumerate("xz" if d == 2 else "xyz")
            }
        for name, held in self.guides.items():
            columns[f"vertical force of the guide of {name} [N]"] = held[:, 0]
            about = ("",) if d == 2 else tuple(f" about {axis}" for axis in "xyz")
            columns |= {f"moment{a} of the guide of {name} [N m]": held[:, 1 + i] for i, a in enumerate(about)}
        for i, name in enumerate(self.joints):
            columns[f"normal force of {name} [N]"] = self.normal[:, i]
            labels = ("",) if d == 2 else (" 1", " 2")
            for quantity, values, unit in (("shear", self.shear, "N"), ("eccentricity", self.eccentricity, "m")):
                along = values[:, i].reshape(len(values), -1).T
                columns |= {f"{quantity}{k} of {name} [{unit}]": row for k, row in zip(labels, along, strict=True)}
            turning = self.moment[:, i].reshape(len(self.moment), -1).T
            about = ("moment",) if d == 2 else ("torsion", *(f"moment{k}" for k in labels))
            columns |= {f"{component} of {name} [N m]": row for component, row in zip(about, turning, strict=True)}
        return columns | {f"pull of {name} [N]": pulled for name, pulled in self.links.items()}

    def __repr__(self) -> str:
        return f"<Forces of {len(self.joints)} joints, largest reaction {self.largest_reaction:.4g} N>"


class KeptForces(NamedTuple):
    """The forces that a solver has kept at some poses.

    Args:
        t: times [s], shape (n,).
        pose: as of a `Response`.
        loads: of each joint the force on what is above it [N] and its moment about the origin of the world [N m], shape
            (n, joints, 3), in space (n, joints, 6).
        contact_reactions: force of the contacts of each fixed block on what it carries [N], shape (n, blocks, d).
        links: what each link pulls with [N], by its name, shape (n,).
        driven: force of each actuator [N], shape (n, actuators), or None without.
        guided: force and moment about its centroid of all but a guide on the block of each actuator [N, N m], shape
            (n, actuators, nv), or None without.
        damage: share of its bond that each joint has lost [-], shape (n, joints), or None without bonds.
    """

    t: Array
    pose: Array
    loads: Array
    contact_reactions: Array
    links: Mapping[str, Array]
    driven: Array | None = None
    guided: Array | None = None
    damage: Array | None = None


def forces_of(case: AnyCase, frames: JointFrames, kept: KeptForces) -> Forces:
    """The forces of a run from those that its solver has kept."""
    d = frames.middle.shape[1]
    middle, axes = BodyMotion(case, kept.t, kept.pose).joints(frames)
    force, about = kept.loads[..., :d], kept.loads[..., d:]
    along = np.matmul(axes, force[..., None])[..., 0]
    normal, shear = along[..., 0], along[..., 1:]
    if d == 2:
        moment = about[..., 0] - (middle[..., 1] * force[..., 0] - middle[..., 0] * force[..., 1])
        bends = -moment[..., None]
    else:
        moment = np.matmul(axes, (about - np.cross(middle, force))[..., None])[..., 0]
        bends = np.stack([-moment[..., 2], moment[..., 1]], axis=-1)
    acts = (normal != 0)[..., None]
    eccentricity = np.where(acts, bends, np.nan) / np.where(acts, normal[..., None], 1.0)
    reactions = {name: kept.contact_reactions[:, i].copy() for i, name in enumerate(frames.blocks)}
    guides = guides_of(case, kept)
    add_links(case, kept, reactions)
    for guide in guides.values():
        reactions[ANCHORS][:, -1] += guide[:, 0]
    if d == 2:
        shear, eccentricity = shear[..., 0], eccentricity[..., 0]
    damage = np.full(normal.shape, np.nan) if kept.damage is None else kept.damage
    return Forces(
        frames=frames,
        normal=normal.copy(),
        shear=shear.copy(),
        eccentricity=eccentricity,
        moment=moment,
        links=dict(kept.links),
        reactions=reactions,
        guides=guides,
        damage=damage,
    )


def guides_of(case: AnyCase, kept: KeptForces) -> dict[str, Array]:
    """Forces of guides on the blocks of actuators, see `Forces`: they balance all other forces on these blocks."""
    guides: dict[str, Array] = {}
    d = 3 if case.in_space else 2
    for i, actuator in enumerate(case.actuators.values()):
        if actuator.block is None or kept.guided is None:
            continue
        name, upwards = case.blocks[actuator.block], -kept.guided[:, i, d - 1]
        if actuator.guide.rising or (actuator.guide.turning and name not in guides):
            upwards = upwards if actuator.guide.rising else np.zeros_like(upwards)
            guides[name] = np.column_stack([upwards, -kept.guided[:, i, d:]])
    return guides


def add_links(case: AnyCase, kept: KeptForces, reactions: dict[str, Array]) -> None:
    """Add the forces of links to the reactions of the blocks that they are anchored on, and to that of all anchors."""
    moving, blocks = BodyMotion(case, kept.t, kept.pose), case.blocks
    for name, pulled in kept.links.items():
        if name not in case.links:
            continue  # of a device that only explicit steps have
        link = case.links[name]
        if case.body_of(link.anchor_block) is not None:
            continue
        vector, anchor = link_vector(moving, link), ANCHORS if link.anchor_block is None else blocks[link.anchor_block]
        force = -(pulled / np.linalg.norm(vector, axis=1))[:, None] * vector
        reactions[anchor] = reactions.get(anchor, 0.0) + force
    if case.actuators and kept.driven is not None:
        directions = np.array([actuator.direction for actuator in case.actuators.values()])
        reactions[ANCHORS] = reactions.get(ANCHORS, 0.0) + kept.driven @ directions


class ForceCounts(NamedTuple):
    """Numbers of the joints, fixed blocks, links and actuators of a case."""

    joints: int
    fixed: int
    links: int
    actuators: int


def required_room(case: AnyCase, samples: float) -> ForceCounts:
    """The numbers of what has forces in a case.

    Raises:
        ValueError: if their forces at the samples do not fit into memory.
    """
    frames = case.rest_geometry.frames
    d = frames.middle.shape[1]
    counts = ForceCounts(len(frames.names), len(frames.blocks), len(case.links), len(case.actuators))
    of_sample = counts.joints * 4 * (d - 1) + counts.fixed * d + counts.links + counts.actuators * (1 if d == 2 else 3)
    numbers = samples * of_sample
    require_size("the forces of this answer", numbers, "raise output_step, or leave the forces out")
    return counts
