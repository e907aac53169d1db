"""Frames of a moving picture, drawn fast: what stands is drawn once, and what moves on top of it in every frame."""

from __future__ import annotations

import base64
import html
import re
from io import BytesIO
from typing import Any

from matplotlib.animation import HTMLWriter, PillowWriter
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image


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

    def picture(self) -> Image.Image:
        """The figure as it is now, in the colours of the first picture."""
        self.canvas.restore_region(self.background)
        for ax, artist in self.moving:
            ax.draw_artist(artist)
        size = self.canvas.get_width_height()
        drawn = Image.frombuffer("RGBA", size, self.canvas.buffer_rgba(), "raw", "RGBA", 0, 1).convert("RGB")
        if self.palette is None:
            self.palette = drawn.quantize(128)  # flat drawings need no more colours, and files are three times smaller
        return drawn.quantize(palette=self.palette, dither=Image.Dither.NONE)


class GifWriter(PillowWriter):
    """Writes a GIF of the pictures of a stage."""

    stage: Stage

    def grab_frame(self, **options: Any) -> None:
        """Take the figure as it is now."""
        self._frames.append(self.stage.picture())  # type: ignore[attr-defined]


class PageWriter(HTMLWriter):
    """Writes a page with the pictures of a stage."""

    stage: Stage

    def grab_frame(self, **options: Any) -> None:
        """Take the figure as it is now."""
        file = BytesIO()
        self.stage.picture().save(file, "PNG")
        self._saved_frames.append(base64.encodebytes(file.getvalue()).decode("ascii"))  # type: ignore[attr-defined]

    def finish(self) -> None:
        """Write the page, and remove the folder for frames also where the disk is full."""
        try:
            super().finish()
        finally:
            self._tmpdir.cleanup()  # type: ignore[attr-defined]


ICONS = {
    "fa-minus": "&#8722;",
    "fa-fast-backward": "|&#9664;&#9664;",
    "fa-step-backward": "|&#9664;",
    "fa-play fa-flip-horizontal": "&#9664;",
    "fa-pause": "&#10074;&#10074;",
    "fa-play": "&#9654;",
    "fa-step-forward": "&#9654;|",
    "fa-fast-forward": "&#9654;&#9654;|",
    "fa-plus": "&#43;",
}
"""What stands on the buttons of matplotlib's player in place of an icon font from the web."""


def standalone(text: str, title: str) -> str:
    """The page of matplotlib's player with characters for its icons, which it would load from the web."""
    text = re.sub(r"<link\b[^>]*>", "", text)
    text = re.sub(r'<i class="fa ([^"]*)"></i>', lambda icon: ICONS.get(icon[1], "&#8226;"), text)
    return f'<!DOCTYPE html>\n<meta charset="utf-8">\n<title>{html.escape(title)}</title>\n{text}'
