"""Files of ParaView: a series of blocks and one of joints, with what moves and presses them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from ..files import replacing, write_text, writer
from ..geometry.poses import rotations
from ..problem.masonry.case import MasonryCase
from ..quantities import Array, Integers, require_path
from .response import Response
from .shapes import MovingShapes, in_space, outline_of

Fields = Mapping[str, Array]


def write_vtk(response: Response, folder: str | Path, fps: float) -> Path:
    """Write the series of files, see `Response.to_vtk`."""
    writer("meshio", "export")
    folder, moving = require_path("folder", folder), MovingShapes.of(response, fps)
    folder.mkdir(parents=True, exist_ok=True)
    blocks = BlockSurfaces(moving)
    _series(folder, "blocks", moving.t, blocks.triangles, blocks.points, (blocks.point_fields(), blocks.cell_fields()))
    if isinstance(response.case, MasonryCase):
        joints = JointSurfaces(moving)
        _series(folder, "joints", moving.t, joints.triangles, joints.points, ({}, joints.cell_fields()))
    return folder


def _series(
    folder: Path, name: str, t: Array, triangles: Integers, points: Array, fields: tuple[Fields, Fields]
) -> None:
    """Write a .vtu file for each time, and the .pvd that lists them."""
    meshio, sets, digits = writer("meshio", "export"), [], len(str(len(t)))
    for frame, time in enumerate(t):
        at_points, at_cells = ({key: values[frame] for key, values in each.items()} for each in fields)
        file = f"{name}_{frame:0{digits}}.vtu"
        mesh = meshio.Mesh(
            points[frame],
            [("triangle", triangles)],
            point_data=at_points,
            cell_data={key: [values] for key, values in at_cells.items()},
        )
        with replacing(folder / file) as partial:
            mesh.write(partial, file_format="vtu", binary=True)
        sets.append(f'<DataSet timestep="{float(time)!r}" part="0" file={quoteattr(file)}/>')
    text = "\n".join(['<VTKFile type="Collection" version="0.1"><Collection>', *sets, "</Collection></VTKFile>"])
    write_text(folder / f"{name}.pvd", f'<?xml version="1.0"?>\n{text}\n')


class BlockSurfaces:
    """The faces of all blocks as triangles, and their fields at the samples."""

    def __init__(self, moving: MovingShapes) -> None:
        self.moving, shapes = moving, moving.shapes
        counts = [len(shape.corners) for shape in shapes]
        first = np.concatenate([[0], np.cumsum(counts)[:-1]])
        self.triangles = np.concatenate([shape.triangles + at for shape, at in zip(shapes, first, strict=True)])
        self.cell_body = np.repeat(np.arange(len(shapes)), [len(shape.triangles) for shape in shapes])
        self.point_body = np.repeat(np.arange(len(shapes)), counts)
        self.rest = np.concatenate([shape.corners + shape.rest for shape in shapes])
        at_rest = [shape.corners + shape.rest for shape in shapes]
        self.points = np.concatenate([moving.placed(i, corners) for i, corners in enumerate(at_rest)], axis=1)

    def point_fields(self) -> Fields:
        """Displacement [m] and velocity [m/s] of each corner; fixed blocks that are moved have none of the latter."""
        moving, response = self.moving, self.moving.response
        velocity = response.velocity[moving.samples]
        linear, spin = np.zeros((2, len(velocity), len(moving.shapes), 3))
        free = [i for i, shape in enumerate(moving.shapes) if not shape.fixed]
        if response.in_space:
            turn = rotations(response.pose[moving.samples])
            linear[:, free], spin[:, free] = velocity[..., :3], np.matmul(turn, velocity[..., 3:, None])[..., 0]
        else:
            linear[:, free], spin[:, free, 1] = in_space(velocity[..., :2]), velocity[..., 2]
        rest = np.array([shape.rest for shape in moving.shapes])
        arm = self.points - (rest + moving.motion[0])[:, self.point_body]
        speed = linear[:, self.point_body] + np.cross(spin[:, self.point_body], arm)
        return {"displacement [m]": self.points - self.rest, "velocity [m/s]": speed}

    def cell_fields(self) -> Fields:
        """The number of the block, and whether it is fixed."""
        frames, fixed = len(self.moving.t), np.array([shape.fixed for shape in self.moving.shapes], dtype=float)
        values = {"block": self.cell_body.astype(float), "fixed": fixed[self.cell_body]}
        return {name: np.tile(row, (frames, 1)) for name, row in values.items()}


class JointSurfaces:
    """The joints of the drawing as triangles on the block below, and their fields at the samples."""

    def __init__(self, moving: MovingShapes) -> None:
        self.moving, self.joints = moving, moving.response.case.masonry.joints
        outlines = [outline_of(joint) for joint in self.joints]
        first = np.concatenate([[0], np.cumsum([len(outline) for outline in outlines])[:-1]])
        fans = [[(at, at + i, at + i + 1) for i in range(1, len(o) - 1)] for o, at in zip(outlines, first, strict=True)]
        self.triangles = np.concatenate(fans).astype(int)
        self.of = np.repeat(np.arange(len(outlines)), [len(fan) for fan in fans])
        pairs = list(zip(self.joints, outlines, strict=True))
        self.below = [moving.placed(joint.below, outline) for joint, outline in pairs]
        self.above = [moving.placed(joint.above, outline) for joint, outline in pairs]
        self.points = np.concatenate(self.below, axis=1)

    def cell_fields(self) -> Fields:
        """Opening and slip of each joint [m], and forces [N] and damage [-] where the run kept them.

        The opening is the largest gap of its corners, and the slip that of the middle of its corners, seen from the
        block below.
        """
        opening, slip = np.zeros((2, len(self.moving.t), len(self.joints)))
        for i, (below, above) in enumerate(zip(self.below, self.above, strict=True)):
            normal = np.cross(below[:, 1] - below[:, 0], below[:, 2] - below[:, 1])
            normal /= np.linalg.norm(normal, axis=1, keepdims=True)
            apart = above - below
            gap = np.matmul(apart, normal[:, :, None])[..., 0]
            opening[:, i] = gap.max(axis=1)
            middle = apart.mean(axis=1)
            slip[:, i] = np.linalg.norm(middle - gap.mean(axis=1)[:, None] * normal, axis=1)
        fields = {"opening [m]": opening, "slip [m]": slip}
        if (forces := self.moving.response.kept_forces) is not None:
            at = self.moving.samples
            shear = forces.shear[at].reshape(len(at), len(self.joints), -1)
            fields |= {"normal force [N]": forces.normal[at], "shear [N]": np.linalg.norm(shear, axis=2)}
            fields["damage [-]"] = np.nan_to_num(forces.damage[at])
        return {name: values[:, self.of] for name, values in fields.items()}
