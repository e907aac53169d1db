"""Hands the figures of an example to sphinx-gallery: what a block of it has assigned to the name `figure`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst


def scrape(block: object, variables: dict[str, Any], gallery: dict[str, Any]) -> str:
    """Save the figure that a block has made, and return the text that shows it."""
    figure = variables["example_globals"].pop("figure", None)
    if not isinstance(figure, Figure):
        return ""
    path = next(variables["image_path_iterator"])
    figure.savefig(path, dpi=150)
    title = Path(variables["src_file"]).read_text(encoding="utf-8").split("\n")[1]
    return str(figure_rst([path], gallery["src_dir"], title))


def _get_sg_image_scraper() -> Callable[..., str]:
    """What sphinx-gallery asks a module for that it is given by name."""
    return scrape
