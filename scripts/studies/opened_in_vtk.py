"""A facade that falls, written as glTF and for ParaView, and opened again by VTK, the library below ParaView.

VTK reads both files at three times. Prints how many blocks it finds in each, and the largest distance between a corner
there and in the response. Writes opened_in_vtk.txt. Needs PyVista, `pip install pyvista`.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import KDTree

import mjrock as mr
from mjrock.quantities import Array
from mjrock.result.bodies import bodies_of
from scripts.shared import cli
from scripts.studies import facade_in_space

try:
    import pyvista as pv
    from vtkmodules.vtkIOGeometry import vtkGLTFReader
except ImportError:
    pv = None


def fallen(duration: float) -> mr.Response:
    """The facade under its three components."""
    motions = facade_in_space.motions(facade_in_space.PEAKS, 6.0)
    case = mr.MasonryCase(facade_in_space.facade(), duration, **motions)
    return mr.solve_explicit(case, output_step=0.04, forces=True)


def corners_of(answer: mr.Response, sample: int) -> dict[str, Array]:
    """Corners of each block at a sample [m], by name."""
    at = [sample]
    bodies = bodies_of(answer.moving.at(at), answer.velocity[at])
    return {body.name: body.placed(body.corners)[0] for body in bodies}


def gltf_at(path: Path, time: float) -> list[Any]:
    """The meshes that VTK finds in a .glb at a time, z upwards."""
    reader = vtkGLTFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    for number in range(reader.GetNumberOfAnimations()):
        reader.EnableAnimation(number)
    reader.UpdateInformation()
    reader.UpdateTimeStep(time)
    parts = pv.wrap(reader.GetOutput()).recursive_iterator()
    return [part.rotate_x(90.0) for part in parts if part is not None and part.n_points]


def series_at(folder: Path, name: str, time: float) -> list[Any]:
    """The meshes that VTK finds in a series for ParaView at a time."""
    reader = pv.get_reader(folder / f"{name}.pvd")
    reader.set_active_time_value(min(reader.time_values, key=lambda one: abs(one - time)))
    return list(reader.read().recursive_iterator())


def farthest(parts: Sequence[Any], corners: dict[str, Array]) -> float:
    """The largest distance from a corner of a block to the next point that VTK has [m]."""
    points = KDTree(np.vstack([part.points for part in parts]))
    return float(max(points.query(there)[0].max() for there in corners.values()))


def main(argv: Sequence[str] | None = None) -> None:
    """Run, write, open, compare and draw."""
    args = cli.parser(__doc__, "opened_in_vtk").parse_args(argv)
    out = cli.folder(args.out)
    if pv is None:
        raise RuntimeError("PyVista is not installed: pip install pyvista")
    answer, lines = fallen(0.4 if args.quick else 7.0), []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        answer.to_gltf(folder / "facade.glb")
        answer.to_vtk(folder / "facade")
        for sample in np.linspace(0, len(answer.t) - 1, 3).astype(int):
            corners, t = corners_of(answer, sample), float(answer.t[sample])
            one, series = gltf_at(folder / "facade.glb", t), series_at(folder / "facade", "blocks", t)
            blocks = sum(len(np.unique(part["block"])) for part in series)
            off = farthest(one, corners), farthest(series, corners)
            lines.append(
                f"t = {t:.2f} s: {len(corners)} blocks; .glb {len(one)}, corners within {off[0]:.1e} m; "
                f".pvd {blocks}, corners within {off[1]:.1e} m"
            )
    cli.report(out / "opened_in_vtk", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(cli.run(main))
