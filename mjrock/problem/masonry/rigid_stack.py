"""A stack of blocks taken as one rigid body: its mass, the edges that it turns about, and how it starts to rock."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np

from ...geometry.vectors import spun
from ...quantities import GRAVITY, Array
from ..wall.block import Block
from .laws.joint_table import ByName
from .laws.stack_law import is_side, parts_above, wall_of
from .masonry import Masonry


@dataclass(frozen=True)
class RigidStack:
    """A stack, with or without a side stop, that rocks as one: the numbers of the joint that it stands on, `base`, and
    of those with the side stop, and the rigid `wall` of its mass on the base, of plain rectangular shape."""

    masonry: Masonry
    base: int
    sides: tuple[int, ...]
    wall: Block

    @classmethod
    def from_masonry(cls, masonry: Masonry) -> Self:
        """The stack that a masonry is.

        Raises:
            ValueError: if it is not one, is held both ways or too squat to rock.
        """
        blocks, joints = masonry.blocks, masonry.joints
        sides = tuple(i for i, joint in enumerate(joints) if is_side(blocks, joint))
        beds = [i for i in range(len(joints)) if i not in sides]
        parts = parts_above(blocks, [joints[i] for i in beds])
        if parts is None:
            raise ValueError("masonry is not a stack, in which every block stands on one other block or on the ground")
        bases = [(i, part) for i, part in zip(beds, parts, strict=True) if blocks[joints[i].below].fixed]
        if len(bases) > 1:
            raise ValueError(f"masonry is {len(bases)} stacks on fixed blocks; give one")
        ((base, part),) = bases
        if len({joints[i].normal[0] > 0 for i in sides}) > 1:
            raise ValueError("masonry has side stops on both sides; a stack between them does not rock")
        return cls(masonry, base, sides, wall_of(blocks, joints[base], part))

    @cached_property
    def free_standing(self) -> Masonry:
        """The stack without its side stop; its joints have the same names, and the same properties but damping."""
        if not self.sides:
            return self.masonry
        masonry, names = self.masonry, [joint.name for joint in self.masonry.joints]
        stops = {masonry.joints[i].below for i in self.sides}
        blocks = [replace(block, name=name) for block, name in zip(masonry.blocks, masonry.names, strict=True)]
        return replace(
            masonry,
            blocks=tuple(block for i, block in enumerate(blocks) if i not in stops),
            k_n=ByName(tuple(zip(names, masonry.joint_stiffness.tolist(), strict=True))),
            friction=ByName(tuple(zip(names, masonry.joint_friction.tolist(), strict=True))),
            xi=0.0,
            law=None,
        )

    @property
    def outwards(self) -> float:
        """1 where the stack opens to the right, -1 to the left, away from the side stop; 1 without one."""
        return 1.0 if not self.sides else math.copysign(1.0, self.masonry.joints[self.sides[0]].normal[0])

    @cached_property
    def masses(self) -> Array:
        """Mass of each block that is not fixed [kg], shape (bodies,)."""
        return np.array([self.masonry.blocks[i].mass for i in self.masonry.free])

    @cached_property
    def _arms(self) -> Array:
        """Centroid of each block that is not fixed from the middle of the base [m], shape (bodies, 2)."""
        return np.asarray(self.masonry.centroids[list(self.masonry.free)] - self.masonry.joints[self.base].middle)

    @cached_property
    def centroid(self) -> Array:
        """Centroid of the whole from the middle of the base [m], shape (2,)."""
        return np.asarray(self.masses @ self._arms / self.masses.sum())

    @cached_property
    def inertia(self) -> float:
        """Moment of inertia of the whole about its centroid [kg m2]."""
        central = sum(self.masonry.blocks[i].inertia for i in self.masonry.free)
        return float(central) + float(self.masses @ ((self._arms - self.centroid) ** 2).sum(axis=1))

    def lever(self, side: float) -> float:
        """Distance of the centroid from the edge of the base at a side, 1 right or -1 left, along the base [m]."""
        return 0.5 * float(self.masonry.joints[self.base].width) - side * float(self.centroid[0])

    def alpha(self, side: float) -> float:
        """Rotation about the edge at a side, 1 right or -1 left, from which the stack overturns [rad]."""
        return math.atan2(self.lever(side), float(self.centroid[1]))

    def turning(self, side: float, rate: float) -> Array:
        """Velocities of the blocks that turn as one about the edge at a side at a rate, positive to the right.

        x, z and rotation of each block that is not fixed [m/s, m/s, rad/s], shape (bodies, 3).
        """
        arms = self._arms - np.array([0.5 * side * self.masonry.joints[self.base].width, 0.0])
        return np.column_stack([*spun((rate,), tuple(arms.T)), np.full(len(arms), rate)])

    def rising(self, amplitude: float) -> tuple[Array, float]:
        """What makes a rigid stack at rest rise outwards to a rotation, a share of alpha: the velocities of its blocks,
        as `turning`, and the time to that rotation and back by Housner's formula for slender walls [s]."""
        side = self.outwards
        alpha, mass = self.alpha(side), float(self.masses.sum())
        arm = math.hypot(self.lever(side), float(self.centroid[1]))
        about_edge = self.inertia + mass * arm**2
        rise = mass * GRAVITY * arm * (math.cos(alpha * (1 - amplitude)) - math.cos(alpha))
        p = math.sqrt(mass * GRAVITY * arm / about_edge)
        quarter = math.acosh(1 / (1 - amplitude)) / p
        return self.turning(side, side * math.sqrt(2 * rise / about_edge)), 2 * quarter
