"""Films of the documentation: an .mp4, the same as .webm, and its poster, a picture of one frame."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

from mjrock.plotting.animation import CODECS, MovieWriter
from scripts.shared import cli

FPS = 25.0
"""Frames a second."""


def folder(path: Path) -> Path:
    """Make the output folder, and find out before any work whether films can be written to it."""
    if not MovieWriter.isAvailable():
        raise RuntimeError("films need the program ffmpeg, which is not on the PATH; pip install '.[docs]' brings one")
    return cli.folder(path)


def films(draw: Callable[[Path], Path], stem: Path, poster: float) -> list[Path]:
    """Write a film as .mp4 and .webm, and its poster as .webp.

    Args:
        draw: writes the film to the path that it is given.
        stem: of the files, without ending.
        poster: time in the film of the frame that is its poster [s].

    Returns:
        The three files.
    """
    film, other, still = (stem.with_suffix(ending) for ending in (".mp4", ".webm", ".webp"))
    draw(film)
    coder, *options = CODECS[".webm"]
    _convert(film, other, ["-c:v", coder, "-pix_fmt", "yuv420p", *options])
    _convert(film, still, ["-ss", f"{poster:g}", "-frames:v", "1", "-quality", "80"])
    return [film, other, still]


def summary_of(files: list[Path]) -> str:
    """Names and sizes of what was written, as a line of text."""
    return ", ".join(f"{path.name}: {path.stat().st_size / 1e6:.2f} MB" for path in files)


def _convert(source: Path, target: Path, options: list[str]) -> None:
    """Write what ffmpeg makes of a film."""
    command = [MovieWriter.bin_path(), "-v", "error", "-y", "-i", str(source), *options, str(target)]
    subprocess.run(command, check=True, stdin=subprocess.DEVNULL)
