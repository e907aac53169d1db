"""Every picture on an Axes takes one first, or as `ax`, or makes a figure of its own."""

import inspect

import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting

ON_AXES = [
    name
    for name in plotting.__all__
    if inspect.isfunction(getattr(plotting, name)) and "ax" in inspect.signature(getattr(plotting, name)).parameters
]
FLAT = mr.Masonry.running_bond(1.0, 0.4, (0.4, 0.2), k_n=1e9)
DEEP = mr.Masonry.box((0.2, 0.4, 1.0), k_n=1e9)


def test_pictures_on_axes_have_it_first():
    assert len(ON_AXES) >= 15
    for name in ON_AXES:
        assert next(iter(inspect.signature(getattr(plotting, name)).parameters)) == "ax"


@pytest.mark.parametrize("masonry", [FLAT, DEEP], ids=["plane", "space"])
def test_blocks_are_drawn_with_and_without_an_axes(masonry, tmp_path):
    given = Figure().add_subplot(projection="3d" if masonry.in_space else None)
    first, named, own, all_named = (
        plotting.blocks(given, masonry),
        plotting.blocks(masonry, ax=given),
        plotting.blocks(masonry),
        plotting.blocks(masonry=masonry),
    )
    assert all_named.name == given.name
    assert first is named is given
    assert isinstance(own, Axes)
    assert own is not given
    assert own.name == given.name
    assert len(own.collections) + len(own.patches) + len(own.artists) > 0
    assert plotting.save(own, tmp_path / "blocks").stat().st_size > 3000


@pytest.mark.parametrize("name", ON_AXES)
def test_what_cannot_be_drawn_is_refused_without_an_axes_too(name):
    with pytest.raises((TypeError, ValueError)):
        getattr(plotting, name)("no picture")
