import numpy as np
import pytest
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting


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
