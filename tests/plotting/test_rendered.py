"""Pictures as their reader sees them: rendered, and their pixels counted."""

import io
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image

import mjrock as mr
from mjrock import plotting
from mjrock.plotting import animation
from mjrock.plotting.bodies import GROUND_COLOUR, STONE, Bodies
from mjrock.plotting.solids import Solids


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


@pytest.mark.parametrize(("length", "one_scale"), [(1.0, True), (8.0, True), (12.0, True), (60.0, False)])
def test_section_and_elevation_have_one_scale_or_say_how_they_differ(length, one_scale):
    wall = mr.Block.from_size(thickness=0.8, height=9.0, length=length)
    figure = plotting.sketch(mr.Case(wall, 0.0, 1.0, effects=mr.Tie(8.0, 2e6, strength=3e4)))
    section, elevation = (ax.get_window_extent().width / np.ptp(ax.get_xlim()) for ax in figure.axes)
    title = figure.axes[1].get_title()
    ratio = section / elevation
    assert (ratio == pytest.approx(1.0)) == one_scale
    assert title == ("elevation" if one_scale else f"elevation, {ratio:.2g} times smaller")


def test_a_gable_and_a_rose_window_are_drawn():
    rose = mr.Opening(1.2, 1.2, 2.0, round=True, at=-0.6)
    wall = mr.Block.from_size(0.8, 5.0, 5.0, openings=[rose], gable=mr.Gable(1.5, top=1.0))
    figure = plotting.sketch(mr.Case(wall, 0.0, 1.0, side_stop=False), "title")
    area = 5.0 * 3.5 + 0.5 * (5.0 + 1.0) * 1.5 - np.pi * 0.36
    assert area_of(figure, figure.axes[1], STONE) == pytest.approx(area, rel=0.08)


def test_the_sketch_says_where_a_tie_breaks():
    """The displacement of the centroid is that of the code check, whose wall has no masses added."""
    tie = mr.Tie(height=3.9, stiffness=2e6, strength=3e3, ultimate=0.02)
    case = mr.Case(mr.Block.from_size(0.6, 4.2), 0.0, 1.0, effects=(tie, mr.Tie(4.0, 1e6, strength=1e3)))
    message = [text.get_text() for text in plotting.sketch(case).axes[0].texts]
    (note,) = (text for text in message if text.startswith("tie_0"))
    assert "tie: z = 3.9 m" in plotting.sketch(replace(case, effects=(tie,))).axes[0].texts[-1].get_text()
    check = mr.mechanism_check(case, mr.code_spectrum("EC8 type 1", ag=2.0, soil="B"))
    assert note.endswith(f"breaks where the centroid has moved by {1e3 * check.breaking['tie_0']:.0f} mm")
    assert not any("breaks" in text for text in message if text.startswith("tie_1"))


def test_spectra_their_mean_and_their_target():
    """The mean of motions that are scaled to the target lies on it in the mean of the periods."""
    target, T = mr.code_spectrum("EC8 type 1", ag=2.0, soil="B"), np.geomspace(0.1, 2.0, 12)
    motions = [mr.scaled_to_spectrum(mr.GroundMotion.synthetic(3.0, 8.0, seed=i), T, target) for i in range(3)]
    ax = plotting.spectra(Figure().subplots(), motions, T, target)
    *single, mean, requested = [line.get_ydata() for line in ax.lines]
    np.testing.assert_allclose(mean, np.mean(single, axis=0))
    np.testing.assert_allclose(requested, target(T) / mr.GRAVITY)
    assert np.exp(np.log(mean / requested).mean()) == pytest.approx(1.0, abs=0.1)
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["records", "mean of 3", "target"]
    assert heights_of(ax.figure, ax, plotting.PALETTE[1])[1] == pytest.approx(requested.max(), rel=0.05)
    records = mr.RecordSet(a=tuple(motions), b=(motions[1],))
    of_set = plotting.spectra(Figure().subplots(), records, T, target).lines  # without the vertical component of a
    np.testing.assert_allclose(of_set[-2].get_ydata(), np.mean([single[0], single[1], single[1]], axis=0))


def on_a_jack(in_space):
    """A block on a slab that is raised by 0.3 m within 0.5 s, followed to the end."""
    if in_space:
        slab = mr.Polyhedron.box((1.0, 1.0, 0.2), (0, 0, 0.1), fixed=True, name="slab")
        block = mr.Polyhedron.box((0.6, 0.6, 0.4), (0, 0, 0.4))
    else:
        slab = mr.Polygon([(-0.5, 0), (0.5, 0), (0.5, 0.2), (-0.5, 0.2)], fixed=True, name="slab")
        block = mr.Polygon([(-0.3, 0.2), (0.3, 0.2), (0.3, 0.6), (-0.3, 0.6)])
    masonry = mr.Masonry([slab, block], k_n=1e8, xi=0.05)
    t = np.linspace(0.0, 0.5, 501)
    raised = 0.15 * (1 - np.cos(np.pi * t / 0.5))
    history = (t, 0 * t, *((0 * t,) * in_space), raised)
    return mr.solve_explicit(mr.MasonryCase(masonry, 0.5, supports={"slab": history}))


def heights_of(figure, ax, colour):
    """The lowest and the highest pixel of a colour within an Axes of the plane, as heights [m]."""
    pixels = rendered(figure)
    box = ax.get_window_extent().extents / figure.dpi * 100
    near = (np.abs(pixels - 255 * np.array(to_rgb(colour))) < 3).all(axis=-1)
    rows = len(pixels) - np.flatnonzero(near[:, round(box[0]) : round(box[2])].sum(axis=1) > 20)
    low, high = ax.get_ylim()
    return low + (np.array([rows.min(), rows.max()]) - box[1]) / np.ptp(box[[1, 3]]) * (high - low)


def test_a_support_that_moves_is_drawn_where_it_is():
    run = on_a_jack(in_space=False)
    figure, update = animation.scene(Bodies.of(run).at(run.t[[0, -1]]), [], run.case)
    for frame, raised in ((0, 0.0), (1, 0.3)):
        update(frame)
        assert heights_of(figure, figure.axes[0], GROUND_COLOUR) == pytest.approx([raised, 0.2 + raised], abs=0.02)
        assert heights_of(figure, figure.axes[0], STONE) == pytest.approx([0.2 + raised, 0.6 + raised], abs=0.02)


def test_a_support_that_moves_in_space_is_drawn_where_it_is():
    run = on_a_jack(in_space=True)
    solids = Solids.of(run).at(run.t[[0, -1]])
    slab = solids.facets.block == 0
    for frame, raised in ((0, 0.0), (1, 0.3)):
        heights = solids.corners(frame)[slab][..., 2]
        assert (heights.min(), heights.max()) == pytest.approx((raised, 0.2 + raised), abs=1e-9)


def test_masonry_at_the_end_of_a_run_is_drawn_on_its_supports():
    figure = Figure(figsize=(4, 4))
    ax = plotting.blocks(figure.subplots(), on_a_jack(in_space=False), joints=False)
    slab, block = ax.patches[0].get_xy(), ax.collections[0].get_paths()[0].vertices
    assert slab[:, 1].min() == pytest.approx(0.3)
    assert block[:, 1].min() == pytest.approx(slab[:, 1].max(), abs=1e-3)


def test_joints_are_drawn_or_not():
    with pytest.raises(TypeError, match=r"joints = .* is neither True nor False"):
        plotting.blocks(mr.Masonry.arch(5.0, 0.9), joints=np.array([True, False]))


def lying(in_space):
    """A bar of 0.2 x 1.6 m that has fallen to the right on the ground that the builders make, which is 6.6 m wide."""
    bar = (0.2, 0.5, 1.6)
    masonry = mr.Masonry.box(bar, k_n=1e8) if in_space else mr.Masonry.stack([mr.Block(0.1, 0.8, length=0.5)], 1e8)
    rate, t = 5.0, np.linspace(0.0, 1.2, 13)
    velocity = [(0.8 * rate, 0, 0, 0, rate, 0)] if in_space else [(0.8 * rate, 0, rate)]
    run = mr.solve_explicit(mr.MasonryCase(masonry, 1.2, velocity=velocity), output_step=float(t[1]))
    assert run.tilt[-1, 0] == pytest.approx(np.pi / 2, abs=0.1)
    return run


def covered(figure, ax, colour):
    """Share of an Axes that a colour covers."""
    return area_of(figure, ax, colour) / (np.ptp(ax.get_xlim()) * np.ptp(ax.get_ylim()))


def test_wide_ground_leaves_a_block_that_lies_on_it_large():
    """The picture follows the bar as it stands and as it lies, and not the ground to its ends. The still one reaches
    from where the bar stood to where it lies."""
    run = lying(in_space=False)
    figure, update = animation.scene(Bodies.of(run).at(run.t[[0, -1]]), [], run.case)
    for frame in (0, 1):
        update(frame)
        assert covered(figure, figure.axes[0], STONE) > 0.03
    still = Figure(figsize=(4, 4))
    ax = plotting.blocks(still.subplots(), run)
    assert covered(still, ax, STONE) > 0.05


def test_wide_ground_in_space_leaves_a_block_that_lies_on_it_large():
    run = lying(in_space=True)
    figure, update = animation.scene(Solids.of(run).at(run.t[[0, -1]]), [], run.case)
    ax = figure.axes[0]
    assert max(np.ptp(getattr(ax, f"get_{name}lim")()) for name in "xyz") < 4.0
    for frame in (0, 1):
        update(frame)
        for artist in ax.get_children():
            artist.set_animated(False)
        pixels = rendered(figure).astype(int)
        bricks = (pixels[..., 0] - pixels[..., 2] > 30) & (pixels[..., 0] > 80)
        assert bricks.mean() > 0.01


@pytest.mark.parametrize("in_space", [False, True])
def test_limits_of_a_picture_are_kept(in_space, tmp_path):
    run = lying(in_space)
    limits = [(-1.0, 5.0), (-0.5, 2.0)]
    if in_space:
        limits.insert(1, (-2.0, 1.0))
    of = (Solids if in_space else Bodies).of
    still = Figure().subplots(subplot_kw={"projection": "3d"} if in_space else None)
    for ax in (
        animation.scene(of(run, limits=limits), [], run.case)[0].axes[0],
        plotting.blocks(still, run, limits=limits),
    ):
        shown = [getattr(ax, f"get_{name}lim")() for name in ("xyz" if in_space else "xy")]
        np.testing.assert_allclose(shown, limits)
    assert plotting.animate(run, tmp_path / "one.gif", fps=2, dpi=40, limits=limits).exists()
    with pytest.raises(ValueError, match="limits along z = 2 to 1 m are not a lower and a higher one"):
        plotting.animate(run, tmp_path / "two.gif", limits=[*limits[:-1], (2.0, 1.0)])
    with pytest.raises(ValueError, match="limits has the shape"):
        plotting.blocks(still, run, limits=[(0.0, 1.0)])
