"""Pictures that move: a wall or blocks in section or in space, true to scale, beside the history of the rotation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from shutil import which
from typing import Any, ClassVar

import numpy as np
from matplotlib.animation import FFMpegWriter, PillowWriter
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import BboxBase
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar
from numpy.typing import ArrayLike
from PIL import Image

from ..bars import counted
from ..contacts.files import replacing
from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.wall.case import Case
from ..quantities import Array, require_kind, require_path, require_text, require_within, shown
from ..result.response import Response
from .bodies import Bodies, Update, combined, draw_outlines, frame_view, round_length, ties_of_masonry
from .forces import forces_on, require_shown
from .histories import acceleration, rotation, ties
from .solids import TITLED, Solids, draw_solids, fill_view, ties_in_view
from .style import Drawing, Look, write_title
from .wall import surroundings


@dataclass(frozen=True)
class WallFilm:
    """A wall as a film shows it, with its histories beside it."""

    case: Case
    is_below: ClassVar[bool] = False

    def around(self, ax: Axes, bodies: Bodies) -> Update:
        """Draw its base, side stop and effects."""
        return surroundings(ax, self.case, bodies)

    def beside(self, response: Response) -> list[Drawing]:
        """The motion of its base, its rotation and the forces of its ties over time, each on an Axes of its own."""
        drawings: list[Drawing] = []
        if self.case.shaken:
            drawings.append(lambda ax: acceleration(ax, self.case, float(response.t[-1])))
        drawings.append(lambda ax: rotation(ax, [response]))
        if response.ties:
            drawings.append(lambda ax: ties(ax, [response]))
        return drawings


@dataclass(frozen=True)
class MasonryFilm:
    """Masonry as a film shows it, with its histories below it as a strip."""

    case: MasonryCase
    is_below: ClassVar[bool] = True

    def around(self, ax: Axes, bodies: Bodies) -> Update:
        """Draw the ties of blocks of the plane, and a scale bar."""
        frame_view(ax, bodies)
        ax.axis("off")
        length = round_length(float(bodies.extent_seen[0]))
        bar = AnchoredSizeBar(ax.transData, length, f"{length:g} m", "lower left", pad=0, frameon=False, fill_bar=True)
        ax.add_artist(bar)
        return ties_of_masonry(ax, self.case, bodies)

    def beside(self, response: Response) -> list[Drawing]:
        """The motion of its ground."""

        def strip(ax: Axes) -> Axes:
            acceleration(ax, self.case, float(response.t[-1]))
            if ax.get_legend() is not None:
                place: Look = {"loc": "lower right", "bbox_to_anchor": (1, 1), "borderaxespad": 0.0}
                ax.legend(frameon=False, fontsize=8, ncols=3, **place)
            return ax

        return [strip] if self.case.grounds else []


def film_of(case: AnyCase) -> WallFilm | MasonryFilm:
    """A case as a film shows it."""
    return MasonryFilm(case) if isinstance(case, MasonryCase) else WallFilm(case)


MOST_FRAMES = 20_000
COLOURS, SAMPLED_FRAMES = 128, 9
"""Number of colours of a film, and of the frames that they are taken from. So few make files three times smaller."""
GIF_TICKS = 100
"""Resolution of the times of frames in a GIF [1/s]. Browsers play frames of less than two hundredths more slowly."""

WIDE = 8.0
"""Width of a film [inch]."""
LOWEST, HIGHEST, OTHERWISE = 2.0, 6.0, 4.5
"""Heights of what shows masonry, which fills it in between, and of a film of a wall or of other bodies [inch]."""
STRIP, CLOCK = 1.3, 0.4
"""Heights of a strip below the bodies and of the text above them [inch]."""
LAST_FRAME_LONGER = 1.0
"""How much longer than the others the last frame is shown before the film starts again [s]."""
CODECS = {
    ".mp4": ("h264", "-crf", "26", "-preset", "slow", "-movflags", "+faststart"),  # plays before it is loaded
    ".webm": ("libvpx-vp9", "-crf", "36", "-b:v", "0"),
}
"""Coder of a film and its options by the ending of the file. At these rates edges of blocks stay sharp."""
RATE_ROUNDING = 1 - 1e-9
"""Factor on the frame rate [-]. Writers round the milliseconds of a frame down, which must not lose one."""


class Stage:
    """A figure whose artists that move are marked as animated, at its resolution [1/inch]."""

    def __init__(self, figure: Figure, dpi: float) -> None:
        figure.set_dpi(dpi)
        canvas: Any = FigureCanvasAgg(figure)
        self.canvas = canvas
        canvas.draw()  # without what is animated
        self.background = canvas.copy_from_bbox(figure.bbox)
        moving = [(ax, artist) for ax in figure.axes for artist in ax.get_children() if artist.get_animated()]
        self.moving = sorted(moving, key=lambda pair: pair[1].get_zorder())
        self.palette: Image.Image | None = None

    def keep_colours(self, update: Update, count: int) -> None:
        """Take the colours of all pictures from some of `count` frames, the first and the last among them."""
        pictures = []
        for frame in sorted(set(np.linspace(0, count - 1, SAMPLED_FRAMES, dtype=int).tolist())):
            update(frame)
            pictures.append(np.asarray(self.drawn()))
        self.palette = Image.fromarray(np.concatenate(pictures)).quantize(COLOURS)
        colours = np.array(self.palette.getpalette() or [255] * 3).reshape(-1, 3)
        colours[colours.min(axis=1) > 248] = 255  # nearly white becomes white
        self.palette.putpalette(colours.ravel().tolist())

    def picture(self) -> Image.Image:
        """The figure as it is now, in the colours that are kept."""
        assert self.palette is not None
        return self.drawn().quantize(palette=self.palette, dither=Image.Dither.NONE)

    def drawn(self) -> Image.Image:
        """The figure as it is now."""
        self.canvas.restore_region(self.background)
        for ax, artist in self.moving:
            ax.draw_artist(artist)
        size = self.canvas.get_width_height()
        return Image.frombuffer("RGBA", size, self.canvas.buffer_rgba(), "raw", "RGBA", 0, 1).convert("RGB")


class GifWriter(PillowWriter):
    """Writes a GIF of the pictures of a stage."""

    stage: Stage

    def grab_frame(self, **options: object) -> None:
        """Take the figure as it is now."""
        self._frames.append(self.stage.picture())  # type: ignore[attr-defined]

    def finish(self) -> None:
        """Write the file, whose last frame stays a while."""
        first, *others = self._frames  # type: ignore[attr-defined]
        frame_time = int(1000 / self.fps)
        times = [*[frame_time] * len(others), frame_time + int(1000 * LAST_FRAME_LONGER)]
        first.save(self.outfile, save_all=True, append_images=others, duration=times if others else times[0], loop=0)


class MovieWriter(FFMpegWriter):
    """Writes a film with ffmpeg, the program or that of the package imageio-ffmpeg."""

    @classmethod
    def bin_path(cls) -> str:
        """Where ffmpeg is, or its name where it is not."""
        if which("ffmpeg") is None and find_spec("imageio_ffmpeg"):
            return str(import_module("imageio_ffmpeg").get_ffmpeg_exe())
        return "ffmpeg"

    def hold(self, count: int) -> None:
        """Write the figure as it is now, for a number of frames; it is drawn once."""
        frame = BytesIO()
        self.fig.savefig(frame, format=self.frame_format, dpi=self.dpi)
        self._proc.stdin.write(count * frame.getvalue())  # type: ignore[attr-defined]


def animate(
    response: Response,
    path: str | Path,
    *,
    speed: float = 1.0,
    fps: float = 25.0,
    magnify: float = 1.0,
    title: str = "",
    dpi: float = 100.0,
    camera: Sequence[float] | None = None,
    limits: ArrayLike | None = None,
    forces: str | None = None,
) -> Path:
    """Write the motion of a response as a moving picture.

    It shows the wall with its base, pivots, side stop, ties, openings, loads, thrusts and masses, and beside it the
    rotation over time, the motion of the ground and the forces of the ties where there are any. Of masonry it shows
    the blocks and their ties above the motion of the ground. The end is shown for another second.

    Args:
        response: of any solver.
        path: where to: a .gif, an .mp4 or a .webm (both need the program ffmpeg, or `pip install imageio-ffmpeg`).
            `view` writes a page that plays in a browser.
        speed: time of the motion that passes in a second of the picture [-], 0.001 to 1000; 1 is real time.
        fps: frames a second [1/s], 1 to 120. In a GIF a frame lasts a whole number of hundredths of a second, at least
            two; the motion keeps its speed.
        magnify: factor on all displacements [-], 0.01 to 10000; 1 is true to scale. The picture has it as text.
        title: what stands above, at most 1000 characters.
        dpi: resolution [1/inch], 20 to 600; the picture is 8 inches wide.
        camera: in space, the elevation and the azimuth that the blocks are seen from [deg], -90 to 90 and -360 to 360;
            None is (18, 35), from outside.
        limits: lowest and highest coordinate that the picture shows along each axis [m], shape (2, 2), in space (3, 2);
            None shows a wall or blocks, and what has gone no farther than one extent of them.
        forces: "thrust", "bars" or "cracks" is drawn of a response with forces=True, see `blocks`.

    Returns:
        The path that was written.

    Raises:
        ValueError: for another ending, a value outside its range, or more than 20,000 frames.
        RuntimeError: for an .mp4 or a .webm where there is no ffmpeg.
    """
    require_kind("response", response, Response)
    bodies: Bodies | Solids
    if response.in_space:
        bodies = Solids.of(response, magnify, camera, limits)
    elif camera is not None:
        raise ValueError(f"camera = {shown(camera)} is for masonry in space, and this response is in the plane")
    else:
        bodies = Bodies.of(response, magnify, limits)
    if forces is not None:
        require_shown("forces", forces, response)
    path = require_path("path", path)
    writer, interval = writer_for(path, require_within("fps", fps, 1.0, 120.0, "1/s"))
    speed = require_within("speed", speed, 1e-3, 1e3)
    times = frame_times(bodies.t, speed * interval)
    dpi = require_within("dpi", dpi, 20.0, 600.0)
    require_text("title", title)
    histories, case = film_of(response.case).beside(response), response.case
    bodies = bodies.at(times)
    figure, update = scene(bodies, histories, case, speed=speed, title=title, response=response, forces=forces)
    return write(figure, update, len(times), path, writer, dpi)


def write(figure: Figure, update: Update, count: int, path: Path, writer: GifWriter | MovieWriter, dpi: float) -> Path:
    """Write the frames of a scene, of which the last is shown for another second.

    Args:
        figure, update: of `scene`.
        count: number of frames.
        path: of the file, with the ending that the writer is for.
        writer: of `writer_for`.
        dpi: resolution [1/inch].
    """
    with replacing(path) as partial, writer.saving(figure, str(partial), dpi):
        if isinstance(writer, GifWriter):
            writer.stage = Stage(figure, dpi)
            writer.stage.keep_colours(update, count)
        for frame in counted(range(count), path.name, "frames"):
            update(frame)
            writer.grab_frame()
        if isinstance(writer, MovieWriter):  # a GIF gives its last frame a time instead
            writer.hold(round(LAST_FRAME_LONGER * writer.fps))
    return path


def writer_for(path: Path, fps: float) -> tuple[GifWriter | MovieWriter, float]:
    """The writer for a file of this ending, and how long a frame is shown [s]."""
    match path.suffix.lower():
        case ".gif":
            interval = max(2, round(GIF_TICKS / fps)) / GIF_TICKS
            return GifWriter(fps=RATE_ROUNDING / interval), interval  # type: ignore[arg-type]
        case ".mp4" | ".webm" as ending:
            if not MovieWriter.isAvailable():
                needs = f"{ending} needs the program ffmpeg, which is not on the PATH"
                raise RuntimeError(f"{path.name}: {needs}; pip install imageio-ffmpeg, or write a .gif")
            codec, *options = CODECS[ending]
            extra = ["-pix_fmt", "yuv420p", *options]
            return MovieWriter(fps=fps, codec=codec, extra_args=extra), 1 / fps  # type: ignore[arg-type]
    raise ValueError(f"path = {(path.name or str(path))!r} does not end in .gif, .mp4 or .webm; view writes an .html")


def frame_times(t: Array, step: float) -> Array:
    """Times of the frames [s], `step` apart from the first sample to the last.

    Raises:
        ValueError: for too many.
    """
    count = int((t[-1] - t[0]) / step * (1 + 1e-12)) + 1
    if count > MOST_FRAMES:
        raise ValueError(f"the picture would have {count} frames; the valid range is 1 to {MOST_FRAMES}; raise speed")
    return np.asarray(t[0] + step * np.arange(count))


def scene(
    bodies: Bodies | Solids,
    histories: Sequence[Drawing],
    case: AnyCase | None,
    *,
    speed: float = 1.0,
    title: str = "",
    response: Response | None = None,
    forces: str | None = None,
) -> tuple[Figure, Update]:
    """The picture, and what moves it to a frame.

    Args:
        bodies: at the times of the frames.
        histories: draw what stands beside the bodies, each on an Axes of its own, over the time.
        case: whose surroundings are drawn, or None.
        speed, title: as in `animate`.
        response, forces: whose forces are drawn, and how; None draws no forces.
    """
    figure, ax, strips = _laid_out_axes(bodies, case, len(histories))
    box = ax.figure.bbox
    updates = _draw_bodies(ax, bodies, case, box)
    if response is not None and forces is not None:
        updates.append(forces_on(ax, response, bodies.moving, forces))
    magnify = bodies.moving.magnify
    scale = "true to scale" if magnify == 1 else f"displacements x {magnify:g}"
    rate = "real time" if speed == 1 else f"{speed:g} x real time"
    clock = ax.set_title(f"{scale}, {rate}, $t$ = 0.00 s", fontsize=9)
    clock.set_animated(True)
    for panel, draw in zip(strips, histories, strict=True):
        draw(panel)
        panel.set_xlim(bodies.t[0], max(bodies.t[-1], bodies.t[0] + 1e-9))
        updates.append(_marker(panel, bodies.t))
        panel.label_outer()
    write_title(figure, title, 10)
    move = combined(updates)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # laid out once: frames do not jitter, and each is drawn faster
    if isinstance(bodies, Solids):
        fill_view(ax, bodies, box, TITLED)
        figure.draw_without_rendering()

    def update(frame: int) -> None:
        clock.set_text(f"{scale}, {rate}, $t$ = {bodies.t[frame]:.2f} s")
        move(frame)

    update(0)
    return figure, update


def _laid_out_axes(bodies: Bodies | Solids, case: AnyCase | None, count: int) -> tuple[Figure, Axes, Sequence[Axes]]:
    """A figure as high as its bodies need, the Axes that shows them, and `count` Axes over the time."""
    is_below, (wide, high) = case is not None and film_of(case).is_below, bodies.extent_seen
    height = CLOCK + float(np.clip(WIDE * high / wide, LOWEST, HIGHEST)) if is_below else OTHERWISE
    figure = Figure(figsize=(WIDE, height + is_below * STRIP * count), layout="constrained")
    axes_options = {"projection": "3d"} if isinstance(bodies, Solids) else None
    if not count:
        return figure, figure.subplots(subplot_kw=axes_options), ()
    ratios: Look = {"height_ratios": (height, STRIP * count)} if is_below else {"width_ratios": (1.0, 1.5)}
    bodies_figure, strips_figure = figure.subfigures(1 + is_below, 2 - is_below, **ratios)
    ax = bodies_figure.subplots(subplot_kw=axes_options)
    return figure, ax, strips_figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]


def _draw_bodies(ax: Axes, bodies: Bodies | Solids, case: AnyCase | None, box: BboxBase) -> list[Update]:
    """Draw bodies and what they meet."""
    if isinstance(bodies, Solids):
        return [draw_solids(ax, bodies, box), *([] if case is None else [ties_in_view(ax, bodies)])]
    updates = [draw_outlines(ax, bodies)]
    if case is None:
        frame_view(ax, bodies)
    else:
        updates.append(film_of(case).around(ax, bodies))
    return updates


def _marker(ax: Axes, times: Array) -> Update:
    """A line at the time of the frame, and a dot on the curve that was drawn first."""
    curve = ax.get_lines()[0]
    values = np.interp(times, np.asarray(curve.get_xdata(), dtype=float), np.asarray(curve.get_ydata(), dtype=float))
    (line,) = ax.plot([], [], color="0.5", linewidth=0.8, transform=ax.get_xaxis_transform(), zorder=4)
    (dot,) = ax.plot([], [], marker="o", markersize=6, color="#b5462f", zorder=5)
    for artist in (line, dot):
        artist.set_animated(True)

    def update(frame: int) -> None:
        line.set_data([times[frame]] * 2, [0.0, 1.0])
        dot.set_data([times[frame]], [values[frame]])

    return update
