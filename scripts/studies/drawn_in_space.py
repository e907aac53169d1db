"""A facade and a dome after they have fallen, drawn by this package, by PyVista and by MuJoCo's renderer.

All three compare depths pixel by pixel. This package also draws edges where a picture shows another plane piece of a
block than beside it, and the shadow of each block on the others and on the ground, on a ground that ends beyond the
rubble. PyVista draws the edges of faces; VTK's shadows are blurred where the ground is wide, and it draws none beside
lines. Prints the time of the processor of a frame, how many pixels inside the blocks show another block than in
PyVista, and how large PyVista is. MuJoCo draws through EGL. Writes drawn_in_space.png and .txt.
Needs PyVista, `pip install pyvista`.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Sequence
from importlib.metadata import files
from typing import Any

os.environ.setdefault("MUJOCO_GL", "egl")

import mujoco
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text

import mjrock as mr
from mjrock import plotting
from mjrock.geometry.poses import rotations
from mjrock.plotting import animation, rasterizer
from mjrock.plotting.solids import Rendering, Solids
from mjrock.quantities import Array, Integers
from mjrock.result.bodies import Body, bodies_of
from scripts.shared import cli
from scripts.studies import dome, facade_in_space

try:
    import pyvista as pv
except ImportError:
    pv = None

SIZE, DPI = (800, 450), 100.0
"""Of a film [pixel], and its pixels to an inch."""
FRAMES = 20
"""Frames that are timed."""


class View:
    """A response as `plotting.animate` shows it: the middle of the picture and half of its height [m]."""

    def __init__(self, answer: mr.Response, camera: tuple[float, float]) -> None:
        self.solids = Solids.of(answer, camera=camera)
        self.bodies = bodies_of(answer.moving, answer.velocity)
        self.film, self.update = animation.scene(self.solids, [], None)
        for part in (*self.film.findobj(Text), *self.film.findobj(Line2D)):
            part.set_visible(False)
        self.stage = animation.Stage(self.film, DPI)
        (rendering,) = self.film.findobj(Rendering)
        self.seen: rasterizer.View = rendering.view()  # one scale for all
        self.middle, self.half = self.seen.middle, 0.5 * self.seen.pixel * self.seen.size[1]

    def drawn(self, frame: int) -> Array:
        """A frame of the film, shape (height, width, 3)."""
        self.update(frame)
        return np.asarray(self.stage.drawn())

    @property
    def shown(self) -> list[Body]:
        """The bodies that are drawn as blocks."""
        return [self.bodies[i] for i in self.solids.shown]


def plotter(view: View, colours: Sequence[Any], **look: Any) -> tuple[Any, Callable[[int], Array]]:
    """A scene of PyVista, and what draws a frame, shape (height, width, 3)."""
    scene, actors = pv.Plotter(off_screen=True, window_size=SIZE), []
    scene.set_background("white")
    for body, colour in zip(view.shown, colours, strict=True):
        mesh = pv.PolyData(body.corners, np.concatenate([[len(face), *face] for face in body.faces]))
        actors.append(scene.add_mesh(mesh, color=colour, **look))
    scene.enable_parallel_projection()
    scene.camera.focal_point, scene.camera.up = view.middle, (0.0, 0.0, 1.0)
    scene.camera.position, scene.camera.parallel_scale = view.middle + 50 * view.half * view.solids.eye, view.half
    scene.camera.clipping_range = 1.0, 100 * view.half

    def draw(frame: int) -> Array:
        for body, actor in zip(view.shown, actors, strict=True):
            place = np.eye(4)
            place[:3, :3], place[:3, 3] = rotations(body.pose[frame]), body.rest + body.pose[frame, :3]
            actor.user_matrix = place
        scene.render()
        return np.asarray(scene.screenshot(return_img=True))

    return scene, draw


def named_by_colour(count: int) -> Array:
    """A colour for each of up to 225 bodies that says its number, shape (count, 3), 0 to 1."""
    number = np.arange(count)
    return np.asarray((16 * np.column_stack([number % 15, number // 15, np.zeros(count)]) + 8) / 255)


def wrong(view: View, frame: int) -> float:
    """Share of pixels inside blocks that show another one than PyVista's picture."""
    scene, draw = plotter(view, list(named_by_colour(len(view.shown))), lighting=False)
    true, solids = draw(frame) // 16, view.solids
    scene.close()
    drawn = view.seen.drawn(solids.stage(frame)[0])[1].clip(-1)
    number = np.append(np.searchsorted(solids.shown, solids.facets.block), -1)[drawn][::-1]
    inside = (true != 15).any(axis=-1)
    for shift in ((0, 1), (1, 0), (0, -1), (-1, 0)):  # edges fall on one pixel or the next
        inside &= (true == np.roll(true, shift, (0, 1))).all(axis=-1)
    return float((number != true[..., 0].astype(int) + 15 * true[..., 1])[inside].mean())


def rendered(view: View) -> Callable[[int], Array]:
    """What draws a frame with MuJoCo's renderer."""
    meshes, bodies = [], []
    for i, body in enumerate(view.shown):
        colour = " ".join(map(str, body.colour))
        meshes.append(f'<mesh name="{i}" vertex="{" ".join(map(str, body.corners.ravel()))}"/>')
        bodies.append(f'<body mocap="true"><geom type="mesh" mesh="{i}" rgba="{colour} 1"/></body>')
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><visual><global offwidth="{SIZE[0]}" orthographic="true" fovy="{2 * view.half}"/>'
        f'<headlight ambient="0.6 0.6 0.6"/></visual><asset>{"".join(meshes)}</asset>'
        f"<worldbody>{''.join(bodies)}</worldbody></mujoco>"
    )
    data, camera, renderer = mujoco.MjData(model), mujoco.MjvCamera(), mujoco.Renderer(model, SIZE[1], SIZE[0])
    elevation, azimuth = view.solids.camera or (0.0, 0.0)
    camera.lookat[:], camera.distance, camera.orthographic = view.middle, 8 * view.half, 1
    camera.azimuth, camera.elevation = 180 + azimuth, -elevation

    def draw(frame: int) -> Array:
        for i, body in enumerate(view.shown):
            data.mocap_pos[i], data.mocap_quat[i] = body.rest + body.pose[frame, :3], body.pose[frame, 3:]
        mujoco.mj_kinematics(model, data)
        renderer.update_scene(data, camera)
        pixels = np.array(renderer.render())
        pixels[(pixels == 0).all(axis=-1)] = 255  # where nothing is
        return pixels

    return draw


def megabytes(*packages: str) -> float:
    """How large packages are where they are installed [MB]."""
    return sum(os.path.getsize(file.locate()) for one in packages for file in files(one) or ()) / 1e6


def timed(draw: Callable[[int], Array], frames: Integers) -> tuple[Array, float]:
    """The last frame, and the time of the processor of one [s]."""
    draw(0)
    begun = time.process_time()
    pictures = [draw(int(frame)) for frame in frames]
    return pictures[-1], (time.process_time() - begun) / len(pictures)


def main(argv: Sequence[str] | None = None) -> None:
    """Run, draw, time and compare."""
    args = cli.parser(__doc__, "drawn_in_space").parse_args(argv)
    out = cli.folder(args.out)
    if pv is None:
        raise RuntimeError("PyVista is not installed: pip install pyvista")
    answers = {"façade": (facade_in_space.shaken(facade_in_space.facade(), 0.1 if args.quick else 7.0), (20.0, 38.0))}
    if not args.quick:
        answers["dome"] = dome.growing(dome.dome(0.038, dome.FACETS[-1], dome.STIFFNESSES[0])), (28.0, 35.0)
    figure = Figure(figsize=(7.4, 1.75 * len(answers)), layout="constrained")
    axes, lines = figure.subplots(len(answers), 3, squeeze=False), []
    for row, (name, (answer, camera)) in zip(axes, answers.items(), strict=True):
        view, last = View(answer, camera), len(answer.t) - 1
        frames = np.linspace(0, last, 2 if args.quick else FRAMES).astype(int)
        colours = [body.colour for body in view.shown]
        ways = {"mjrock": view.drawn, "PyVista": plotter(view, colours, show_edges=True)[1]}
        if not args.quick:  # a process chooses how MuJoCo draws before it imports it
            ways["MuJoCo"] = rendered(view)
        found = {way: timed(draw, frames) for way, draw in ways.items()}
        share = max(wrong(view, frame) for frame in frames)
        lines.append(
            f"{name}, {len(view.shown)} blocks: "
            + ", ".join(f"{way} {1e3 * took:.0f} ms a frame" for way, (_, took) in found.items())
            + f"; pixels of another block than PyVista's, most in a frame: {share:.2%}"
        )
        for ax, (way, (picture, _)) in zip(row, found.items(), strict=False):
            ax.imshow(picture)
            ax.set_axis_off()
            ax.set_title(f"{name}, {way}", fontsize=8)
    lines.append(f"PyVista and VTK are {megabytes('pyvista', 'vtk'):.0f} MB, MuJoCo and matplotlib are there")
    plotting.save(figure, out / "drawn_in_space.png")
    cli.report(out / "drawn_in_space", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(cli.run(main))
