"""Masonry of drawings in DXF that a CAD library has written."""

import math

import ezdxf
import numpy as np
import pytest
from ezdxf import units

import mjrock as mr


def drawing(path, *outlines, unit=units.M, **kept):
    """A drawing with closed polylines, given as (layer, corners)."""
    document = ezdxf.new(units=unit)
    for layer, corners in outlines:
        document.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})
    document.saveas(path)
    return path


def box(left, right, low, high):
    return [(left, low), (right, low), (right, high), (left, high)]


def facade(path, scale=1.0, unit=units.M):
    """Two piers of three stones, a lintel and a pediment of two halves, drawn with inserted blocks and a note."""
    document = ezdxf.new(units=unit)
    space = document.modelspace()
    stone = document.blocks.new("stone")
    stone.add_lwpolyline(scale * np.array(box(0, 0.6, 0, 0.8)), close=True, dxfattribs={"layer": "stone"})
    for x in (0.0, 2.4):
        for z in (0.0, 0.8, 1.6):
            space.add_blockref("stone", (scale * x, scale * z))
    space.add_polyline2d(scale * np.array(box(0, 3.0, 2.4, 2.8)), close=True, dxfattribs={"layer": "lintel"})
    for points in ([(0, 2.8), (1.5, 2.8), (1.5, 3.4)], [(1.5, 2.8), (3.0, 2.8), (1.5, 3.4)]):
        space.add_lwpolyline(scale * np.array(points), close=True, dxfattribs={"layer": "pediment"})
    space.add_lwpolyline(scale * np.array(box(-2, 5, -0.5, 0)), close=True, dxfattribs={"layer": "rock"})
    space.add_text("west front", height=scale * 0.2)
    space.add_line((0, 0), (scale, 0))
    document.saveas(path)
    return path


@pytest.mark.parametrize(("scale", "unit"), [(1.0, units.M), (1000.0, units.MM), (100.0, units.CM)])
def test_a_facade_becomes_masonry_in_metres_and_stands(tmp_path, scale, unit):
    path = facade(tmp_path / "front.dxf", scale, unit)
    density = {"stone": 2400.0, "lintel": 2600.0, "pediment": 2000.0, "rock": 2000.0}
    masonry = mr.Masonry.from_dxf(path, ["rock"], density=density, length=0.5, k_n=1e9, k_s=5e8)
    assert len(masonry.blocks) == 10
    assert [masonry.names[i] for i in masonry.free][-3:] == ["lintel_0", "pediment_0", "pediment_1"]
    weight = 0.5 * (6 * 0.6 * 0.8 * 2400 + 3.0 * 0.4 * 2600 + 3.0 * 0.6 / 2 * 2000)
    assert sum(masonry.blocks[i].mass for i in masonry.free) == pytest.approx(weight, rel=1e-9)
    assert len(masonry.joints) == 11  # six of the piers, two of the lintel, two of the pediment and the one in it
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.2), forces=True)
    assert answer.outcome is not mr.Outcome.OVERTURNED
    np.testing.assert_allclose(answer.reactions["rock_0"][-1], [0, weight * mr.GRAVITY], rtol=1e-6, atol=1e-3)


def test_ground_lies_under_the_lowest_point_and_the_end_of_a_polyline_may_repeat_its_start(tmp_path):
    document = ezdxf.new(units=units.M)
    corners = box(0, 0.4, 2, 3)
    document.modelspace().add_lwpolyline([*corners, corners[0]], dxfattribs={"layer": "a|b"})
    document.saveas(tmp_path / "a.dxf")
    masonry = mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True)
    assert masonry.names == ("ground", "a_b_0")
    assert masonry.joints[0].start[1] == 2.0


def test_a_turned_insert_is_where_it_is_drawn(tmp_path):
    document = ezdxf.new(units=units.M)
    document.blocks.new("s").add_lwpolyline(box(0, 1, 0, 2), close=True)
    document.modelspace().add_blockref("s", (5, 0), dxfattribs={"rotation": 90, "xscale": 0.5})
    document.saveas(tmp_path / "a.dxf")
    block = mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True).blocks[1]
    np.testing.assert_allclose(block.centroid, [4.0, 0.25], atol=1e-12)
    assert block.area == pytest.approx(1.0)


def arc(space):
    space.add_lwpolyline([(0, 0, 0, 0, 0.5), (1, 0, 0, 0, 0), (1, 1, 0, 0, 0)], close=True)


@pytest.mark.parametrize(
    ("draw", "complaint"),
    [
        (lambda space: space.add_lwpolyline(box(0, 1, 0, 1)), "layer 0: the polyline that begins at 0, 0 is open"),
        (arc, "has arcs: draw them as short straight edges"),
        (lambda space: space.add_line((0, 0), (1, 1)), "has no closed polyline; there is 1 LINE"),
        (lambda space: None, "has no closed polyline; there is nothing"),
        (
            lambda space: space.add_lwpolyline([(0, 0), (2, 0), (2, 2), (1, 0.5)], close=True),
            "block 0_0, which begins at 0, 0 m: vertices",
        ),
        (lambda space: space.add_polyline3d(box(0, 1, 0, 1), close=True), "not in the plane x, y"),
    ],
)
def test_drawings_that_are_no_masonry(tmp_path, draw, complaint):
    document = ezdxf.new(units=units.M)
    draw(document.modelspace())
    document.saveas(tmp_path / "a.dxf")
    with pytest.raises(ValueError, match=rf"a.dxf.*{complaint}"):
        mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True)


def test_arguments_are_checked(tmp_path):
    path = drawing(tmp_path / "a.dxf", ("stone", box(0, 1, 0, 1)), ("brick", box(0, 1, 1, 2)))
    with pytest.raises(ValueError, match="fixed = 'rock' is neither a layer nor a block; the layers are stone, brick"):
        mr.Masonry.from_dxf(path, ["rock"])
    with pytest.raises(ValueError, match=r"density = .* has nothing for the layer 'brick'"):
        mr.Masonry.from_dxf(path, ["stone"], density={"stone": 2000.0})
    with pytest.raises(ValueError, match="scale = 0"):
        mr.Masonry.from_dxf(path, ["stone"], scale=0.0)
    (tmp_path / "no.dxf").write_text("nothing")
    with pytest.raises(ValueError, match=r"no.dxf is not a drawing in DXF"):
        mr.Masonry.from_dxf(tmp_path / "no.dxf")
    masonry = mr.Masonry.from_dxf(
        path, ["stone_0"], scale=0.5, friction=lambda joint: 0.5 if "brick" in joint.name else 1.0
    )
    assert masonry.joint_friction.tolist() == [0.5]
    assert math.isclose(masonry.blocks[1].area, 0.25)
