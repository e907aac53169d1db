"""Masonry in space from files of other programs, and to them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Self

import numpy as np

from ...files import write_text
from ...quantities import named, require_flag, require_path, require_text, require_within, shown
from .builders import FromBlocks
from .forms_in_space import ground_below
from .mesh_files import compas_text, obj_text, read_compas, read_obj, read_stl
from .meshes import Mesh, blocks_of

AnyPath = str | PathLike[str]


class Exchange(FromBlocks):
    """Masonry in space from files, and to files. Options are further arguments of `Masonry`.

    All readers take `density` [kg/m3], 100 to 30000, for blocks whose file says none, and `scale`, the length of a unit
    of the file [m], 1e-6 to 1e3: 0.001 for millimetres. The z axis of the file points upwards.

    Every body has to be closed and convex, and to touch another within the `tolerance`. Messages name the file and the
    body.
    """

    @classmethod
    def from_obj(
        cls,
        path: AnyPath,
        fixed: Sequence[str] = (),
        *,
        ground: bool = False,
        density: float = 2000.0,
        scale: float = 1.0,
        **options: Any,
    ) -> Self:
        """Blocks of a Wavefront OBJ file: its objects, or the groups of them.

        Args:
            path: of the file. Several bodies of one object are numbered.
            fixed: names of the bodies that are fixed.
            ground: whether fixed ground is put under the lowest point.
            density, scale, options: see `Exchange`.

        Raises:
            ValueError: for a file that is none, or a body that is no block, with their names, or as `Masonry` does.
        """
        return cls._read(read_obj, path, fixed, ground, density, scale, options)

    @classmethod
    def from_stl(
        cls,
        path: AnyPath,
        fixed: Sequence[str] = (),
        *,
        ground: bool = False,
        density: float = 2000.0,
        scale: float = 1.0,
        **options: Any,
    ) -> Self:
        """Blocks of an STL file, binary or text: its solids, or the closed bodies that it lists one after the other.

        Args:
            path: of the file. Bodies without a name are `body_0` and so on.
            fixed, ground, density, scale, options: as of `from_obj`.

        Raises:
            ValueError: as `from_obj` does.
        """
        return cls._read(read_stl, path, fixed, ground, density, scale, options)

    @classmethod
    def from_compas(
        cls,
        path: AnyPath,
        fixed: Sequence[str] = (),
        *,
        ground: bool = False,
        density: float = 2000.0,
        scale: float = 1.0,
        **options: Any,
    ) -> Self:
        """Blocks of the JSON file of a COMPAS model, such as a `BlockModel` of compas_dem. Its supports are fixed.

        Args:
            path: of the file.
            fixed: names of further bodies that are fixed.
            ground, density, scale, options: as of `from_obj`. A density of the material of a block comes first.

        Raises:
            ValueError: as `from_obj` does.
        """
        return cls._read(read_compas, path, fixed, ground, density, scale, options)

    def to_obj(self: Any, path: AnyPath) -> Path:
        """Write the blocks to an OBJ file, an object each, in metres. Density and supports are not kept.

        Raises:
            ValueError: for blocks in the plane.
        """
        self._require_space()
        return write_text(require_path("path", path), obj_text(self.blocks, self.names))

    def to_compas(self: Any, path: AnyPath) -> Path:
        """Write the blocks to the JSON file of a COMPAS model, with supports and densities, in metres.

        Raises:
            ValueError: for blocks in the plane.
        """
        self._require_space()
        return write_text(require_path("path", path), compas_text(self.blocks, self.names))

    @classmethod
    def _read(
        cls,
        read: Callable[[Path], list[Mesh]],
        path: AnyPath,
        fixed: Sequence[str],
        ground: bool,
        density: float,
        scale: float,
        options: dict[str, Any],
    ) -> Self:
        """Masonry of the meshes that a reader finds in a file."""
        if not isinstance(fixed, list | tuple):
            raise TypeError(f"fixed = {shown(fixed)} is no list of names")
        for name in fixed:
            require_text("fixed", name)
        density = require_within("density", density, 100.0, 3e4, "kg/m3")
        scale = require_within("scale", scale, 1e-6, 1e3, "m")
        ground, path = require_flag("ground", ground), require_path("path", path)
        meshes = [mesh._replace(vertices=scale * mesh.vertices) for mesh in read(path)]
        try:
            blocks = blocks_of(meshes, density, fixed)
            if ground:
                corners = np.concatenate([block.corners for block in blocks])
                blocks.insert(0, ground_below(corners.min(axis=0), corners.max(axis=0), float(corners[:, 2].min())))
            masonry = cls(blocks, **options)
            masonry._require_touching()
        except ValueError as error:
            raise ValueError(f"path = {path}: {error}") from None
        return masonry

    def _require_space(self: Any) -> None:
        if not self.in_space:
            raise ValueError("blocks = blocks in the plane have no such file; make them bodies with Polyhedron.prism")

    def _require_touching(self: Any) -> None:
        """Raise a ValueError with the names of the blocks that are not fixed and have no joint, and the nearest gap."""
        touching = {i for joint in self.joints for i in (joint.below, joint.above)}
        loose = [i for i in self.free if i not in touching]
        if loose:
            low, high = (np.array([end(block.corners, axis=0) for block in self.blocks]) for end in (np.min, np.max))
            i = loose[0]
            gaps = np.linalg.norm(np.maximum(0.0, np.maximum(low - high[i], low[i] - high)), axis=1)
            gaps[i] = np.inf
            raise ValueError(
                f"{named([self.names[i] for i in loose])} touch no other block within the tolerance of "
                f"{self.tolerance:g} m; between the bounds of {self.names[i]} and {self.names[int(gaps.argmin())]} "
                f"there are {gaps.min():.3g} m"
            )
