"""The motion of bodies and the forces of joints as series of files that ParaView opens, written as text of XML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ..files import quoted, write_text
from ..quantities import Array, require_path
from .bodies import Body

VTK_POINT, VTK_POLYGON = 1, 7
"""VTK's numbers of kinds of cells."""


def write_series(folder: str | Path, name: str, t: Array, texts: Sequence[str]) -> Path:
    """Write the text of each time [s] to a file of its own, and the .pvd that lists them, whose path is returned.

    Raises:
        OSError: if a file cannot be written.
    """
    folder = require_path("folder", folder)
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for i, (time, text) in enumerate(zip(t.tolist(), texts, strict=True)):
        file = write_text(folder / f"{name}_{i:05d}.vtu", text)
        rows.append(f'<DataSet timestep="{time!r}" part="0" file={quoted(file.name)}/>')
    return write_text(folder / f"{name}.pvd", _file("Collection", "\n".join(rows)))


def texts_of_bodies(bodies: Sequence[Body]) -> list[str]:
    """The faces of the bodies at each of their times, with the displacement [m] and the velocity [m/s] of each corner,
    and with the number of the body, whether it is fixed and its colour, of three bytes, of each face."""
    counts = np.cumsum([0, *(len(body.corners) for body in bodies)])
    faces = [tuple(counts[k] + i for i in face) for k, body in enumerate(bodies) for face in body.faces]
    sizes = [len(body.faces) for body in bodies]
    of_face = {"block": np.arange(len(bodies)), "fixed": np.array([int(body.fixed) for body in bodies])}
    of_face["colour"] = np.rint(255 * np.array([body.colour for body in bodies])).astype(np.uint8)
    cells = {name: np.repeat(values, sizes, axis=0) for name, values in of_face.items()}
    places = np.concatenate([body.placed(body.corners) for body in bodies], axis=1)
    rest = np.concatenate([body.rest + body.corners for body in bodies])
    rates = np.concatenate([body.rate(body.corners) for body in bodies], axis=1)
    return [
        _grid(at, faces, VTK_POLYGON, {"displacement": at - rest, "velocity": rate}, cells)
        for at, rate in zip(places, rates, strict=True)
    ]


def texts_of_joints(middles: Array, values: Mapping[str, Array]) -> list[str]:
    """Points in the middle of joints [m], shape (n, joints, 3), with values of the shapes (n, joints, ...)."""
    cells = [(i,) for i in range(middles.shape[1])]
    return [
        _grid(at, cells, VTK_POINT, {name: value[i] for name, value in values.items()}, {})
        for i, at in enumerate(middles)
    ]


def _grid(
    points: Array,
    cells: Sequence[tuple[int, ...]],
    kind: int,
    at_points: Mapping[str, Array],
    at_cells: Mapping[str, Array],
) -> str:
    """The text of points and cells of one kind, with values at both."""
    kinds = np.full(len(cells), kind, dtype=np.uint8)
    ends = np.cumsum([len(cell) for cell in cells])
    tables = {"connectivity": np.concatenate([np.array(cell) for cell in cells]), "offsets": ends, "types": kinds}
    shown = {"CellData": ' Scalars="colour"'} if "colour" in at_cells else {}
    parts = {
        "Points": {"Points": points},
        "Cells": tables,
        "PointData": at_points,
        "CellData": at_cells,
    }
    text = "\n".join(
        f"<{part}{shown.get(part, '')}>\n"
        + "\n".join(_array(name, array) for name, array in arrays.items())
        + f"\n</{part}>"
        for part, arrays in parts.items()
    )
    piece = f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">\n{text}\n</Piece>'
    return _file("UnstructuredGrid", piece)


def _array(name: str, values: Array) -> str:
    kind = {"f": "Float64", "i": "Int64", "u": "UInt8"}[values.dtype.kind]
    wide = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    text = " ".join(f"{value:.12g}" for value in values.ravel().tolist())
    return f'<DataArray type="{kind}" Name={quoted(name)}{wide} format="ascii">\n{text}\n</DataArray>'


def _file(kind: str, text: str) -> str:
    return (
        f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian">\n'
        f"<{kind}>\n{text}\n</{kind}>\n</VTKFile>\n"
    )
