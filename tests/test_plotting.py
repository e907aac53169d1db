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
