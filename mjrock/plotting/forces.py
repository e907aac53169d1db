"""Forces of joints on pictures of blocks: the line of thrust, or a bar at each joint; and cracks."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.proj3d import proj_transform

from ..problem.masonry.blocks.joints import Joint
from ..quantities import Array, Integers, require_one_of
from ..result.bodies import BodyMotion
from ..result.response import Response
from .bodies import FORCE, Update, named_line

SHOWN = ("thrust", "bars", "cracks")
"""How forces are shown."""
WIDEST, BAR = 5.0, 2.5
"""Width of the line of thrust at the force of the scale, and of a bar [point]."""
CLOSED, CRACK = 0.8, 4.0
"""Width of the line of a closed joint that has lost its bond, and of the widest crack of a run [point]."""
CRACKED = "#c0392b"
"""Colour of cracks."""
LONGEST = 0.12
"""Length of the bar of a large force, over the extent of the joints [-]."""
LARGE = 2.0
"""Force over that of the scale above which a line stays as wide [-]. In a film impacts would hide the rest."""
LEAST_DRAWN = 1e-6
"""Least force over that of the scale, and least damage of a joint, that is drawn [-]."""


class Strokes(LineCollection):
    """Lines in the plane or in space, which are drawn over the blocks."""

    ends: Array = np.zeros((0, 2, 2))
    """Both ends of each [m], shape (n, 2, d)."""

    def put(self, ends: Array, widths: Array | float) -> None:
        """Draw these."""
        self.ends = ends
        self.set_linewidth(widths)  # type: ignore[arg-type]
        if ends.shape[2] == 2:
            self.set_segments(list(ends))
        elif getattr(self.axes, "M", None) is not None:
            self.do_3d_projection()

    def do_3d_projection(self) -> float:
        """Bring the lines into the plane of the picture, whenever the axes are drawn."""
        assert isinstance(self.axes, Axes3D)
        x, y, _ = proj_transform(*self.ends.reshape(-1, 3).T, self.axes.M)
        self.set_segments(list(np.stack([x, y], axis=-1).reshape(-1, 2, 2)))
        return 0.0


def require_shown(name: str, value: object, response: Response) -> None:
    """Raise unless the forces of a response can be drawn so.

    Raises:
        AttributeError: if the response has kept no forces.
        ValueError: for what is not one of `SHOWN`, or for cracks where no joint has a bond.
    """
    require_one_of(name, value, SHOWN)
    if value == "cracks" and np.isnan(response.forces.damage).all():
        raise ValueError(f"{name} = 'cracks' needs joints with a bond, and all joints are dry")
    _ = response.forces


class DrawnForces:
    """The forces of the joints of a response where bodies are drawn.

    Args:
        response: a run that has kept its forces.
        bodies: where the bodies are.
    """

    def __init__(self, response: Response, bodies: BodyMotion) -> None:
        self.response, self.forces, self.bodies = response, response.forces, bodies
        self.frames = self.forces.frames
        self.sample = np.maximum(np.searchsorted(response.t, bodies.t * (1 + 1e-12), side="right") - 1, 0)
        normal, shear = self.forces.normal[self.sample], self.forces.shear[self.sample]
        along = np.concatenate([normal[..., None], shear.reshape(*normal.shape, -1)], axis=-1)
        self.along = np.where(normal[..., None] > 0, along, 0.0)
        self.size = np.linalg.norm(self.along, axis=-1)
        self.scale = float(np.median(self.size.max(axis=1))) or 1.0

    @cached_property
    def widths(self) -> Array:
        """Widths of the cracks of all joints in the frames [m], shape (frames, joints), 0 of those with their bond."""
        lost = np.nan_to_num(self.forces.damage) > LEAST_DRAWN
        return np.asarray(np.where(lost, self.response.crack_widths, 0.0)[self.sample])

    @property
    def extent(self) -> float:
        """Extent of joints and centroids at rest [m]."""
        return float(np.ptp(np.concatenate([self.frames.middle, self.frames.rest]), axis=0).max())

    def joints(self, frame: int) -> tuple[Array, Array]:
        """Middles [m] and axes of the joints in a frame, shapes (j, d) and (j, d, d)."""
        middle, axes = self.bodies.at([frame]).joints(self.frames)
        return middle[0], axes[0]

    def placed(self, frame: int) -> tuple[Array, Array]:
        """Where the force of each joint acts in a frame [m], and the force over the scale, shape (j, d) each."""
        middle, axes = self.joints(frame)
        eccentricity = self.forces.eccentricity[self.sample[frame]].reshape(len(middle), -1)
        eccentricity = np.where(self.size[frame][:, None] > 0, eccentricity, 0.0)
        place = middle + (eccentricity[..., None] * axes[:, 1:]).sum(axis=1)
        return place, (self.along[frame][..., None] * axes).sum(axis=1) / self.scale

    def thrust(self, frame: int) -> tuple[Array, Array | float]:
        """The line of thrust in a frame: ends of its pieces [m], shape (n, 2, d), and their widths [point].

        In each block it goes from joint to joint by way of the mean of their places, in proportion to their forces. So
        it is straight between two. A block with one joint that presses has its other end at its centroid.
        """
        place, share = self.placed(frame)
        frames, share = self.frames, np.linalg.norm(share, axis=1)
        joint = np.tile(np.flatnonzero(share > LEAST_DRAWN), 2)
        body = np.concatenate([side[joint[: len(joint) // 2]] for side in (frames.below, frames.above)])
        joint, body = joint[body >= 0], body[body >= 0]
        count = len(frames.rest)
        sums = [np.bincount(body, weights=share[joint] * column, minlength=count) for column in place[joint].T]
        weight = np.bincount(body, weights=share[joint], minlength=count)
        nodes = np.stack(sums, axis=-1) / np.where(weight > 0, weight, 1.0)[:, None]
        at_one_joint = np.bincount(body, minlength=count) == 1
        d = place.shape[1]
        nodes[at_one_joint] = (frames.rest + self.bodies.magnify * self.bodies.pose[frame, :, :d])[at_one_joint]
        return np.stack([place[joint], nodes[body]], axis=1), WIDEST * np.minimum(share[joint], LARGE)

    def bars(self, frame: int) -> tuple[Array, Array | float]:
        """A bar through the place of each joint's force along it, as long as the force is large: its ends [m], shape
        (n, 2, d), of the joints that press; and the width of all [point]."""
        place, share = self.placed(frame)
        presses = np.linalg.norm(share, axis=1) > LEAST_DRAWN
        place, share = place[presses], share[presses]
        length = np.minimum(LARGE / np.linalg.norm(share, axis=1), 1.0)
        half = 0.5 * LONGEST * self.extent * share * length[:, None]
        return np.stack([place - half, place + half], axis=1), BAR

    @cached_property
    def edges(self) -> tuple[Integers, Array]:
        """Edges of the joints: the joint of each, and its ends from the middle along the axes [m], shape (e, 2, d)."""
        outlines = [
            np.array([joint.start, joint.end])[None] if isinstance(joint, Joint) else edges_of(joint.outline)
            for joint in self.response.of_masonry.masonry.joints
        ]
        joint_of_edge = np.repeat(np.arange(len(outlines)), [len(edges) for edges in outlines])
        offsets = np.concatenate(outlines) - self.frames.middle[joint_of_edge, None]
        return joint_of_edge, np.matmul(offsets, np.swapaxes(self.frames.axes[joint_of_edge], 1, 2))

    def cracks(self, frame: int) -> tuple[Array, Array | float]:
        """Edges of joints that have lost some of their bond [m], and widths of their lines: thin as the lost share
        where they are closed, and beyond that by the width of the crack."""
        middle, axes = self.joints(frame)
        joint_of_edge, ends = self.edges
        lost_bond: Array = np.nan_to_num(self.forces.damage[self.sample[frame]])[joint_of_edge]
        share_open = self.widths[frame][joint_of_edge] / max(float(self.widths.max()), 1e-300)
        ends = (middle[joint_of_edge, None] + np.matmul(ends, axes[joint_of_edge]))[lost_bond > LEAST_DRAWN]
        return ends, (CLOSED * lost_bond + (CRACK - CLOSED) * share_open)[lost_bond > LEAST_DRAWN]


def edges_of(outline: Array) -> Array:
    """Edges of a polygon, shape (n, 2, d)."""
    return np.stack([outline, np.roll(outline, -1, axis=0)], axis=1)


def forces_on(ax: Axes, response: Response, bodies: BodyMotion, how: str) -> Update:
    """Draw the forces of the joints on blocks that are drawn already, and write the force of the scale."""
    drawn_forces = DrawnForces(response, bodies)
    cracks = how == "cracks"
    colour, capstyle = (CRACKED, "butt") if cracks else (FORCE, "round")
    strokes = Strokes([], colors=colour, zorder=7, animated=True, capstyle=capstyle)
    ax.add_collection(strokes, autolim=False)
    if cracks:
        named_line(ax, f"cracked, {1e3 * drawn_forces.widths.max():.2g} mm open", colour, CRACK)
    elif how == "thrust":
        named_line(ax, f"{drawn_forces.scale / 1e3:.3g} kN", colour, WIDEST)
    else:
        label = f"bar {LONGEST * drawn_forces.extent:.2g} m long: {drawn_forces.scale / 1e3:.3g} kN"
        named_line(ax, label, colour, BAR)
    strokes_of = {"thrust": drawn_forces.thrust, "bars": drawn_forces.bars, "cracks": drawn_forces.cracks}[how]

    def update(frame: int) -> None:
        strokes.put(*strokes_of(frame))

    return update
