"""Every public picture, and those of the studies, against one that somebody has looked at.

Texts are taken out, since fonts differ between versions. Pictures are compared in cells: within one, the mean
difference of the colours of both has to be small. `python tests/plotting/test_baselines.py` draws the pictures anew, to
be looked at.
"""

import importlib
import io
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text
from packaging.version import Version
from PIL import Image, ImageFilter

import mjrock as mr
from mjrock import plotting
from mjrock.plotting import style
from scripts.shared import accuracy, law_pictures
from scripts.shared.pairs import pairs
from tests import page_figures
from tests.plotting.words import covered

FOLDER = Path(__file__).parent / "baselines"
DPI = 45
CELL = 6
"""Side of a cell [pixel]."""
DIFFERENT = 0.05
"""Largest mean difference of a cell, over that of black and white. Matplotlib 3.10.7 for 3.11.2 makes up to 0.018, most
lines of results that are missing 0.07 or more, a block of a wall 0.28. Faint lines of reference make less."""

WALL = mr.Block.from_size(0.6, 4.2, 3.0, openings=[mr.Opening(1.0, 2.0)], gable=mr.Gable(1.0))
E = mr.Restitution.from_geometry(WALL)
TIE = mr.Tie(height=3.9, stiffness=2e6, slack=1e-3, strength=3e3, ultimate=0.1)
EFFECTS = (TIE, mr.Thrust(3.5, 5e2), mr.Load(5e3, 4.0), mr.AddedMass(200.0, 4.0))
LOADED = mr.Case(WALL, 0.0, 1.0, side_stop=mr.SideStop(3.0), effects=EFFECTS)
T = np.linspace(0.0, 3.0, 301)
MOTION = mr.GroundMotion(-3.0 * np.sin(4.0 * T) * np.exp(-T), 0.01)
STACK = mr.Masonry.stack([mr.Block.from_size(0.5, 0.5)] * 3, k_n=1e8)
BOND = mr.Masonry.running_bond(1.6, 0.8, (0.4, 0.2), k_n=1e9)
DEEP = mr.Masonry.box((0.5, 0.8, 1.2), k_n=1e9)
RISING = np.linspace(0.1, 1.0, 8)


def shaken(motion=MOTION, effects=(TIE,)):
    return mr.solve_analytical(mr.Case(WALL, 0.0, 3.0, motion=motion, effects=effects), E)


def pressed():
    return mr.solve_explicit(mr.MasonryCase(STACK, 1e-3), forces=True)


def swung():
    case = mr.MasonryCase(STACK, 0.3, velocity=[(0.0, 0.0, 0.3)] * 3)
    return mr.solve_explicit(case)


def found():
    tried = ((1e9, 2, 0.4401), (3e8, 2, 0.35), (1e9, 9, 0.4404), (1e9, 16, 0.47))
    rows = tuple({"k_n": k, "points": p, "capacity_g": g} for k, p, g in tried)
    values = np.array([row["capacity_g"] for row in rows])
    base = {"k_n": 1e9, "points": 2}
    return mr.Sensitivity("capacity_g", ("k_n", "points"), base, rows, values, ((), ("k_n",), ("points",), ("points",)))


def islands():
    low = mr.Island(3.0, 4.0, 2.8, 4.2, (2.6, 3.0), (4.0, 4.4), 1.0)
    high = mr.Island(6.0, 8.0, 5.8, np.nan, (5.8, 6.0), (8.0, 8.0), 1.0)
    shares = np.array([[0, 0, 0.5, 1, 0, 1, 1, 1], [0, 0, 0, 0, 0, 0, 0, 0]])
    return mr.Thresholds(("a", "b"), np.arange(1.0, 9.0), shares, ((low, high), ()), (0.0, 1e-6), 20)


def fitted():
    levels = np.repeat([0.2, 0.3, 0.4, 0.5], 6)
    return mr.fit_fragility(levels, [i % 6 < n for i, n in zip(range(24), np.repeat([0, 2, 4, 6], 6), strict=True)])


def mapped():
    endings = np.array([[0, 1, 1, 0, 0, 2, 2, 2], [0, 0, 1, 1, 0, 2, 2, 2], [0, 0, 0, 1, 1, 1, 0, 2]])
    shares = (endings > 0) - 0.4 * (np.arange(24).reshape(3, 8) == 19)
    found = mr.OverturningMap(np.array([0.6, 0.8, 1.0]), 10 * RISING, endings, shares)
    return plotting.overturning_map(found, WALL)


def spectra():
    target = mr.code_spectrum("EC8 type 1", ag=2.0, soil="B")
    return plotting.spectra([MOTION, MOTION.scaled(0.5)], np.geomspace(0.1, 2.0, 20), target)


def alone(draw, *given):
    return plotting.single(lambda ax: draw(ax, *given))


def pushed():
    return {"tied": mr.pushover(LOADED), "bare": mr.pushover(mr.Case(WALL, 0.0, 1.0))}


def points(columns):
    costs = [(case, way, x) for case in "AB" for way in ("c, a", "d, a") for x in (1e-3, 1e-2)]
    return [(case, way, *(x * i ** (2 + (way < "d")) for i in range(1, columns))) for case, way, x in costs]


def both():
    return [shaken(), shaken(MOTION.reversed())]


PICTURES = {
    "acceleration": lambda: plotting.acceleration(mr.Case(WALL, 0.0, 3.0, motion=MOTION), 3.0),
    "blocks": lambda: plotting.blocks(BOND),
    "blocks_in_space": lambda: plotting.blocks(DEEP),
    "comparison": lambda: plotting.comparison([shaken(effects=())]),
    "convergence": lambda: plotting.single(
        lambda ax: accuracy.convergence(ax, [1e-3, 2e-3, 4e-3], {"e": [1e-5, 4e-5, 1.6e-4]}, 2)
    ),
    "damping_curves": lambda: plotting.single(
        lambda ax: law_pictures.damping_curves(ax, [(1e-2, (RISING, RISING**2), (RISING, RISING**1.9))])
    ),
    "design": lambda: plotting.design(
        mr.design(
            lambda t: mr.Case(mr.Block.from_size(t, 4.0), 0.0, 1.0),
            [0.4, 0.6, 0.9],
            mr.code_spectrum("NTC 2018", ag=2.06, F0=2.45, Tc=0.33, soil="C"),
        )
    ),
    "displacement": lambda: plotting.displacement([swung()]),
    "energy": lambda: plotting.energy([shaken()]),
    "fragility": lambda: plotting.fragility(fitted(), [0.2, 0.3, 0.4, 0.5], [0.0, 0.33, 0.67, 1.0], "MuJoCo"),
    "grid": lambda: plotting.grid([("a", [shaken(effects=())]), ("b", [shaken()])]),
    "history": lambda: plotting.history(both()),
    "incremental": lambda: plotting.incremental([1.0, 2.0, 3.0], [[0.1, 0.5, 0.9], [0.2, 0.3, np.inf]], "MuJoCo"),
    "mechanism": lambda: plotting.mechanism(mr.collapse_multiplier(BOND)),
    "moment_rotation": lambda: plotting.moment_rotation(pushed()),
    "obtained": lambda: plotting.single(
        lambda ax: law_pictures.obtained(ax, {"a": (RISING, RISING**1.1), "b": (RISING, RISING**0.9)})
    ),
    "overturning_map": mapped,
    "pairs": lambda: plotting.single(
        lambda ax: pairs(ax, np.column_stack([RISING, RISING**1.2]), ("a", "b"), (0.05, 1.5), "title")
    ),
    "panels": lambda: plotting.panels(
        [("a", lambda ax: plotting.blocks(ax, BOND)), ("b", lambda ax: plotting.ties(ax, both()))]
    ),
    "parity": lambda: alone(law_pictures.parity, RISING, RISING**1.1, RISING),
    "peers": lambda: accuracy.peers(points(4), {"c, a": "c"}),
    "push": lambda: plotting.push(
        {"a": mr.Push(RISING, 1e4 * RISING * (2 - RISING), 0 * RISING, "", swung(), energy=RISING)}
    ),
    "pushover": lambda: plotting.pushover(pushed()),
    "record": lambda: plotting.record([MOTION, MOTION.corrected(band=(None, 20.0))]),
    "residuals": lambda: law_pictures.residuals("t", RISING, {"R": (RISING, "log"), "h": (RISING[::-1], "linear")}),
    "rotation": lambda: plotting.rotation(both(), ["a", "b"]),
    "sensitivity": lambda: plotting.single(
        lambda ax: law_pictures.sensitivity(ax, {"R": (RISING, RISING + 0.5), "h": (RISING, 1.5 - RISING)})
    ),
    "single": lambda: plotting.single(lambda ax: plotting.blocks(ax, STACK)),
    "sketch": lambda: plotting.sketch(LOADED),
    "spectra": spectra,
    "thresholds": lambda: plotting.thresholds(islands(), "m/s²"),
    "thrust": lambda: plotting.thrust(pressed()),
    "ties": lambda: plotting.ties([shaken()]),
    "tornado": lambda: plotting.tornado(found()),
    "work_precision": lambda: accuracy.work_precision(points(3), {"c, a": plotting.STYLES["MuJoCo"]}),
}
OF_STUDIES = {"convergence", "damping_curves", "obtained", "pairs", "parity", "peers", "residuals"}
OF_STUDIES |= {"sensitivity", "work_precision"}
"""Pictures that scripts draw."""


def rendered(drawn, size=None):
    """A picture without its texts, as pixels."""
    figure = drawn.get_figure(root=True) if isinstance(drawn, Axes) else drawn
    for ax in figure.axes:
        ax.tick_params(labelbottom=False, labelleft=False, which="both")
    for text in figure.findobj(Text):
        text.set_visible(False)
    for legend in [*figure.legends, *(ax.get_legend() for ax in figure.axes)]:
        if legend is not None:
            legend.remove()
    figure.set_layout_engine("none")
    if size is not None:  # a legend below a figure makes it as high as its fonts ask for
        figure.set_size_inches((np.array(size) + 0.01) / DPI)
    file = io.BytesIO()
    figure.savefig(file, dpi=DPI, format="png", metadata={"Software": None})
    return Image.open(file).convert("RGB")


def difference(name, drawn):
    """The largest mean difference of a cell of what is drawn and of the picture that is kept [-].

    A cell may lie a pixel aside: frames and edges are drawn on the nearest pixel.
    """
    kept = Image.open(FOLDER / f"{name}.png").convert("RGB")
    both = kept, rendered(drawn, kept.size)
    left, right = (np.asarray(one.filter(ImageFilter.BoxBlur(CELL // 2)), dtype=float) for one in both)
    aside = [np.roll(right, shift, (0, 1)) for shift in np.ndindex(3, 3)]
    apart = [np.abs(np.roll(left, 1, (0, 1)) - other).mean(axis=-1) for other in aside]
    return float(np.min(apart, axis=0).max()) / 255


def test_every_public_picture_is_kept():
    others = {"PALETTE", "STYLES", "Drawing", "save", "animate", "view"}
    assert set(plotting.__all__) - others == set(PICTURES) - {"blocks_in_space"} - OF_STUDIES
    assert {path.stem for path in FOLDER.glob("*.png")} == set(PICTURES)


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_readable_and_the_one_that_was_looked_at(name):
    """No text is small, cut, or under another one or a line. It is drawn once for all of this."""
    drawn = PICTURES[name]()
    assert isinstance(drawn, Axes | Figure)
    figure = style.figure_of(drawn) if isinstance(drawn, Axes) else drawn
    before = figure.dpi, [ax.get_position() for ax in figure.axes]
    figure.set_dpi(style.FINE)  # as it is saved
    figure.draw_without_rendering()
    assert list(page_figures.faults(figure)) == []
    assert list(covered(figure)) == []
    figure.set_layout_engine("none")
    figure.set_dpi(before[0])
    for ax, place in zip(figure.axes, before[1], strict=True):
        ax.set_position(place)
    if name == "sketch" and Version(matplotlib.__version__) < Version("3.11"):
        pytest.skip("the elevation is a pixel larger: its place depends on the width of texts, which 3.11 has changed")
    assert difference(name, drawn) < DIFFERENT


@pytest.mark.parametrize("missing", ["elevation", "draw_outlines", "surroundings"])
def test_a_sketch_without_its_wall_or_what_it_meets_is_another_picture(missing, monkeypatch):
    sketches = importlib.import_module("mjrock.plotting.wall")
    monkeypatch.setattr(sketches, missing, lambda *given: lambda frame: None)
    assert difference("sketch", plotting.sketch(LOADED)) > 2 * DIFFERENT


def test_masonry_without_a_block_is_another_picture():
    ax = plotting.blocks(BOND)
    ax.collections[0].set_verts([path.vertices for path in ax.collections[0].get_paths()[:-1]])
    assert difference("blocks", ax) > 2 * DIFFERENT


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, draw in PICTURES.items():
        rendered(draw()).quantize(32).save(FOLDER / f"{name}.png", optimize=True)
