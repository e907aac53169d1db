"""Pictures as their reader sees them: rendered, and their pixels counted."""

import io

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.section import STONE


def rendered(figure, dpi=100):
    """The figure as its PNG shows it, RGB of shape (rows, columns, 3)."""
    file = io.BytesIO()
    figure.savefig(file, dpi=dpi, format="png")
    return np.asarray(Image.open(file).convert("RGB"))


def area_of(figure, ax, colour):
    """Area inside an Axes that a colour covers [m2]."""
    pixels = rendered(figure)
    box = ax.get_window_extent().extents / figure.dpi * 100
    rows = len(pixels) - np.round(box[[3, 1]]).astype(int)
    columns = np.round(box[[0, 2]]).astype(int)
    within = pixels[rows[0] : rows[1], columns[0] : columns[1]]
    covered = (np.abs(within - 255 * np.array(to_rgb(colour))) < 3).all(axis=-1).sum()
    metres = np.ptp(ax.get_xlim()) / np.ptp(box[[0, 2]])
    return covered * metres**2


@pytest.mark.parametrize(
    ("thickness", "openings", "stop"),
    [(1.2, (), False), (0.8, (mr.Opening(1.5, 1.6, 1.0), mr.Opening(1.0, 1.6, 1.0)), True)],
)
def test_a_sketch_shows_the_wall_filled_in_section_and_elevation(thickness, openings, stop):
    """The wall covers thickness times height of the section, and length times height less the openings of the
    elevation. Lines and marks on the wall take a little of both."""
    wall = mr.Block.from_size(thickness=thickness, height=4.0, length=5.0, openings=openings)
    figure = plotting.sketch(mr.Case(wall, 0.0, 1.0, side_stop=stop), "title")
    section, elevation = figure.axes
    assert area_of(figure, section, STONE) == pytest.approx(thickness * 4.0, rel=0.15)
    openings_area = sum(opening.width * opening.height for opening in openings)
    assert area_of(figure, elevation, STONE) == pytest.approx(5.0 * 4.0 - openings_area, rel=0.08)
