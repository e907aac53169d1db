import itertools
import re

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import Picture
from tests import page_figures
from tests.plotting.words import covered


@pytest.fixture(scope="module")
def responses(one_sided, contacts, e):
    return [mr.solve_analytical(one_sided, e), mr.simulate(one_sided, contacts, 1e-3)]


def test_axes_carry_units_and_are_returned(responses):
    ax = Figure().subplots()
    assert plotting.rotation(ax, responses) is ax
    assert ax.get_xlabel() == "time $t$ [s]"
    assert "[-]" in ax.get_ylabel()
    assert plotting.energy(Figure().subplots(), responses).get_ylabel() == "total energy $E$ [kJ]"


def test_lines_are_told_apart_without_colour(responses):
    ax = plotting.rotation(Figure().subplots(), responses)
    styles = [(line.get_linestyle(), line.get_linewidth()) for line in ax.get_lines()[:2]]
    assert len(set(styles)) == 2
    assert len({(s["linestyle"], s["linewidth"]) for s in plotting.STYLES.values()}) == len(plotting.STYLES)
    np.testing.assert_allclose(ax.get_lines()[0].get_ydata().max(), 0.5)


def test_a_saved_figure_is_the_same_bytes_again(responses, tmp_path):
    for name in ("a.png", "b.png"):
        plotting.save(plotting.comparison(responses, "title"), tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_grid_hides_the_panels_it_does_not_need(responses):
    figure = plotting.grid([("one", responses)] * 3)
    assert [ax.get_visible() for ax in figure.axes] == [True, True, True, False]


def test_a_fragility_curve_needs_no_levels():
    """The fit to capacities has none; the two curves differ in colour, and both are seen in full."""
    fits = [mr.fit_capacities(middle * np.array([0.8, 0.9, 1.0, 1.1, 1.3])) for middle in (0.6, 0.3)]
    ax = Figure().subplots()
    for name, fit in zip(("tied", "as it is"), fits, strict=True):
        assert plotting.fragility(ax, fit, solver=name) is ax
    lines = ax.get_lines()
    assert [line.get_label() for line in lines] == [
        f"{name}: {fit.median:.2f} g, {fit.dispersion:.2f}"
        for name, fit in zip(("tied", "as it is"), fits, strict=True)
    ]
    assert lines[0].get_color() != lines[1].get_color()
    assert ax.get_xlim()[1] > 2 * fits[0].median
    assert len(plotting.fragility(Figure().subplots(), fits[0], [0.5, 0.6], [0.0, 1.0]).get_lines()) == 2
    with pytest.raises(ValueError, match=r"levels has the shape \(2,\), shares has the shape \(1,\); rows of one"):
        plotting.fragility(fits[0], [0.5, 0.6], [0.3])
    with pytest.raises(ValueError, match="levels and shares go together: give both, or neither"):
        plotting.fragility(fits[0], levels=[0.5])
    with pytest.raises(TypeError, match="solver = 3 of type int is not a str or None"):
        plotting.fragility(fits[0], solver=3)


def test_push_over_curves_beside_closed_forms(one_sided, contacts):
    curves = {"rigid": mr.pushover(one_sided), "corner lines": mr.pushover(one_sided, contacts)}
    ax = Figure().subplots()
    assert plotting.pushover(ax, curves, {"rigid": ([0.0], [1 / 7])}) is ax
    assert (ax.get_xlabel(), ax.get_ylabel()) == (r"rotation $\theta$ [rad]", r"multiplier $\lambda$ [-]")
    rigid, corners, closed = ax.get_lines()
    np.testing.assert_array_equal(rigid.get_ydata(), curves["rigid"].multiplier)
    np.testing.assert_array_equal(corners.get_xdata(), curves["corner lines"].rotation)
    assert closed.get_color() == rigid.get_color() != corners.get_color()
    assert len({(line.get_linestyle(), line.get_linewidth()) for line in (rigid, corners)}) == 2
    ax = plotting.moment_rotation(Figure().subplots(), curves, {"corner lines": ([0.1], [5e3])})
    assert ax.get_ylabel() == "restoring moment $M$ [kN m]"
    rigid, corners, closed = ax.get_lines()
    assert list(rigid.get_xdata()[:2]) == [0, 0]  # a rigid wall takes the whole moment before it turns
    assert rigid.get_ydata()[:2] == pytest.approx([0, one_sided.wall.weight * one_sided.wall.b / 1e3])
    np.testing.assert_array_equal(corners.get_ydata(), curves["corner lines"].moment / 1e3)
    assert closed.get_ydata() == pytest.approx([5.0])


def test_blocks_are_drawn_where_a_pose_has_brought_them():
    """A block that turns by 90 degrees to the right about its centroid and moves by (3, 1)."""
    box = [(0, 0), (2, 0), (2, 1), (0, 1)]
    masonry = mr.Masonry([mr.Polygon(box), mr.Polygon([(0, -1), (2, -1), (2, 0), (0, 0)], fixed=True)])
    ax = Figure().subplots()
    assert plotting.blocks(ax, masonry) is ax
    assert (len(ax.patches), len(ax.collections[0].get_paths())) == (1, 1)
    assert len(ax.get_lines()) == 1
    ax = plotting.blocks(Figure().subplots(), masonry, [[3.0, 1.0, np.pi / 2]])
    corners = ax.collections[0].get_paths()[0].vertices[:4]
    np.testing.assert_allclose(corners, [(3.5, 2.5), (3.5, 0.5), (4.5, 0.5), (4.5, 2.5)], atol=1e-12)
    np.testing.assert_allclose(ax.patches[0].get_xy()[:-1], [(0, -1), (2, -1), (2, 0), (0, 0)])
    assert not ax.get_lines()
    with pytest.raises(ValueError, match=r"pose has the shape \(3,\); \(1, 3\) is needed"):
        plotting.blocks(ax, masonry, [0.0, 0.0, 0.0])


def test_what_the_axes_had_before_moves_on_after_blocks_are_drawn():
    """Lines that a user moves himself stay animated; what is drawn is part of the still picture."""
    ax = Figure().subplots()
    (own,) = ax.plot([0, 1], [0, 1], animated=True)
    plotting.blocks(ax, mr.Masonry.stack([mr.Block.from_size(0.5, 0.5)] * 2, k_n=1e8))
    assert [artist for artist in ax.get_children() if artist.get_animated()] == [own]


def test_a_rotation_that_overturns_below_alpha_is_drawn(wall, contacts):
    """A load at the top lowers it. Without effects there is no line, nor one far beyond the motion."""
    load, tie = mr.Load(0.4 * wall.weight, height=2 * wall.h), mr.Tie(2 * wall.h, 1e6)
    for effects, released, drawn in (
        ((load,), 0.3, True),
        ((load,), 0.1, False),
        ((), 0.3, False),
        ((tie,), 0.3, False),
    ):
        run = mr.simulate(mr.Case(wall, released * wall.alpha, 0.1, effects=effects), contacts)
        ax = mr.plotting.history(run).axes[0]
        levels = [line.get_ydata()[0] for line in ax.get_lines() if line.get_linestyle() == ":"]
        share = run.case.overturning_rotation / wall.alpha
        assert levels == ([pytest.approx(share)] if drawn else [])
        assert ("overturns" in [text.get_text() for text in ax.texts]) == drawn


def own_figure(width=6.0):
    figure = Picture(figsize=(width, 3.0), layout="constrained")
    return figure, figure.add_subplot()


BREACHES = {
    r"the figure is 7\.5 in wide; at most 7\.4 in": lambda: own_figure(7.5)[0],
    r"text 'small' has 7\.5 pt; at least 8 pt": lambda: own_figure()[1].text(0.5, 0.5, "small", fontsize=7.5),
    "text 'far' is cut off by the edge": lambda: own_figure()[1].text(1.2, 0.5, "far" * 30, in_layout=False),
    "'mine' has the colour #1f77b4 of Matplotlib": lambda: own_figure()[1].plot([0, 1], "C0", label="mine")[0],
    "'bars' has the colour #d62728 of Matplotlib": lambda: own_figure()[1].axvspan(0, 1, color="tab:red", label="bars"),
}


@pytest.mark.parametrize("message", BREACHES)
def test_what_a_page_cannot_show_well_is_found(message):
    drawn = BREACHES[message]()
    figure = drawn if isinstance(drawn, Figure) else drawn.get_figure(root=True)
    figure.draw_without_rendering()
    (fault,) = page_figures.faults(figure)
    assert re.search(message.replace("'far'", "'(far)+'"), fault)


def test_a_figure_of_its_own_has_colours_that_may_be_saved(tmp_path):
    figure, ax = own_figure(7.4)
    for i in range(6):
        ax.plot([0, 1], [i, i], label=f"line {i}")
    ax.plot([0, 1], [7, 7], label="MuJoCo, coarse", color=plotting.STYLES["MuJoCo"]["color"])
    ax.legend(fontsize=8)
    assert page_figures.save(figure, tmp_path / "a.png").exists()


def of_many_effects():
    """A long wall with ties of all heights, a far stop, and openings."""
    ties = [mr.Tie(2.0 + 0.5 * i, 2e6, slack=1e-3, strength=2e4 + i, ultimate=0.05, length=1.0 + i) for i in range(6)]
    effects = [*ties, mr.Thrust(4.0, 1e3), mr.Load(1e4, 5.5), mr.AddedMass(300.0, 5.0), mr.Damper(3.0, 1e4, length=3.0)]
    openings = [mr.Opening(1.2, 2.0), mr.Opening(0.8, 1.2, sill=3.5)]
    wall = mr.Block.from_size(0.5, 6.0, 24.0, openings=openings)
    return mr.Case(wall, 0.0, 1.0, side_stop=mr.SideStop(3.0), effects=effects)


def of_many_motions():
    waves = [np.sin(np.arange(200.0) * (1 + i)) for i in range(6)]
    return [mr.GroundMotion(wave, 0.02, f"a record of a long name, {i}") for i, wave in enumerate(waves)]


LONG, NAMES = "a long title " * 8, ["a label " * 6, "another " * 6]
HARD = {
    "sketch": lambda responses: plotting.sketch(of_many_effects()),
    "arguments": lambda responses: plotting.sketch(of_many_effects(), LONG, arguments=True),
    "record": lambda responses: plotting.record(of_many_motions()),
    "grid": lambda responses: plotting.grid([("a title that takes some room", responses)] * 7, columns=4),
    "panels": lambda responses: plotting.panels([(LONG, lambda ax: plotting.energy(ax, responses))] * 3, columns=3),
    "history": lambda responses: plotting.history(responses, LONG, labels=NAMES),
}


@pytest.mark.parametrize("name", HARD)
def test_pictures_of_much_are_readable(name, responses, tmp_path):
    assert page_figures.save(HARD[name](responses), tmp_path / "a.rgba").exists()


SEEN_WITHOUT = {
    "red": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "green": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "blue": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
"""What an eye without one kind of cones sees of linear RGB: Machado, Oliveira and Fernandes, A physiologically-based
model for simulation of color vision deficiency, IEEE TVCG 15 (2009), Table 1, severity 1."""
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
"""From linear RGB, IEC 61966-2-1."""


def linear(colour):
    rgb = np.array(to_rgb(colour))
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    """CIELAB of linear RGB, white D65."""
    share = TO_XYZ @ np.clip(rgb, 0, 1) / (TO_XYZ @ np.ones(3))
    x, y, z = np.where(share > (6 / 29) ** 3, np.cbrt(share), share / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("missing", SEEN_WITHOUT)
def test_colours_are_told_apart_by_those_who_do_not_see_one(missing):
    """At 15 or more in CIELAB; red and green of Matplotlib come as near as 7."""
    seen = [lab(np.array(SEEN_WITHOUT[missing]) @ linear(colour)) for colour in plotting.PALETTE]
    assert min(np.linalg.norm(a - b) for a, b in itertools.combinations(seen, 2)) > 15


def test_colours_have_a_contrast_of_three_on_white():
    """What graphics need, WCAG 2.1, 1.4.11."""
    light = [TO_XYZ[1] @ linear(colour) for colour in plotting.PALETTE]
    assert min(1.05 / (one + 0.05) for one in light) > 3
    assert {style["color"] for style in plotting.STYLES.values()} <= set(plotting.PALETTE)
    assert len({style["color"] for style in plotting.STYLES.values()}) == len(plotting.STYLES)


def test_panels_that_are_compared_have_one_scale():
    """A wall that falls ends its run early; its panel has the time and the rotations of the other one."""
    wall = mr.Block.from_size(0.6, 4.2)
    e = mr.Restitution.from_geometry(wall)
    motions = mr.GroundMotion.rectangular(-4.0, 1.0), mr.GroundMotion.rectangular(-2.0, 0.3)
    runs = [mr.solve_analytical(mr.Case(wall, 0.0, 5.0, motion=motion), e) for motion in motions]
    assert runs[0].t[-1] < 0.9 * runs[1].t[-1]
    for top in (None, 0.5):
        figure = plotting.grid([("falls", runs[:1]), ("stands", runs[1:])], top=top)
        assert {ax.get_xlim() for ax in figure.axes} == {(0.0, runs[1].t[-1])}
        assert len({ax.get_ylim() for ax in figure.axes}) == 1
        figure.draw_without_rendering()
        assert list(covered(figure)) == []


def test_drawings_of_blocks_beside_each_other_have_one_scale():
    walls = [mr.Masonry.running_bond(length, 1.0, (0.4, 0.2), k_n=1e9) for length in (1.2, 2.4)]
    figure = plotting.panels([("a", lambda ax, wall=wall: plotting.blocks(ax, wall)) for wall in walls])
    assert len({(ax.get_xlim(), ax.get_ylim()) for ax in figure.axes}) == 1


def test_panels_of_low_blocks_have_no_empty_bands(responses):
    """Walls 4 m long and 0.8 m high fill their row, and a history below them is no lower."""
    wall = mr.Masonry.running_bond(4.0, 0.8, (0.4, 0.2), k_n=1e9)
    blocks = "a", lambda ax: plotting.blocks(ax, wall)
    figure = plotting.panels([blocks, blocks, ("b", lambda ax: plotting.rotation(ax, responses))])
    figure.draw_without_rendering()
    left, right, history = (ax.get_tightbbox() for ax in figure.axes if ax.get_visible())
    assert left.height + history.height > 0.9 * figure.bbox.height
    assert left.width + right.width > 0.9 * figure.bbox.width  # they are not drawn smaller
    assert 3.0 < history.height / figure.dpi < 4.0
