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
        (
            lambda space: space.add_polyline3d([(0, 0, 0), (1, 0, 0), (1, 1, 1)], close=True),
            "block 0_0, .*: it is not in the plane of the drawing; up='z' takes one in the plane x, z",
        ),
    ],
)
def test_drawings_that_are_no_masonry(tmp_path, draw, complaint):
    document = ezdxf.new(units=units.M)
    draw(document.modelspace())
    document.saveas(tmp_path / "a.dxf")
    with pytest.raises(ValueError, match=rf"a.dxf.*{complaint}"):
        mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True)


def inserting(path, levels, each=10):
    """A stone that is inserted so many times, in blocks of so many levels."""
    document = ezdxf.new(units=units.M)
    document.blocks.new("B0").add_lwpolyline(box(0, 1, 0, 1), close=True)
    for i in range(1, levels + 1):
        block = document.blocks.new(f"B{i}")
        for j in range(each):
            block.add_blockref(f"B{i - 1}", (j * each ** (i - 1), 0))
    document.modelspace().add_blockref(f"B{levels}", (0, 0))
    document.saveas(path)
    return path


def test_inserted_blocks_are_counted_before_they_are_inserted(tmp_path):
    """Five levels of ten, 22 kB, would take 20 s; a tower of 60 levels, rows and columns, and many lines likewise."""
    assert len(mr.Masonry.from_dxf(inserting(tmp_path / "a.dxf", 2), ground=True).free) == 100
    for levels, count in ((5, "1e\\+05"), (8, "1e\\+08")):
        with pytest.raises(ValueError, match=rf"b.dxf: there are {count} outlines, and at most 25000 are taken"):
            mr.Masonry.from_dxf(inserting(tmp_path / "b.dxf", levels), ground=True)
    with pytest.raises(ValueError, match="inserted in each other on more than 50 levels, from B60 on"):
        mr.Masonry.from_dxf(inserting(tmp_path / "b.dxf", 60, 1), ground=True)
    document = ezdxf.new(units=units.M)
    stone, field = document.blocks.new("stone"), {"row_count": 300, "row_spacing": 1, "column_spacing": 1}
    for _ in range(20):
        stone.add_line((0, 0), (1, 1))
    document.modelspace().add_lwpolyline(box(0, 1, 0, 1), close=True)
    document.modelspace().add_blockref("stone", (0, 0), dxfattribs=field | {"column_count": 300})
    document.saveas(tmp_path / "c.dxf")
    with pytest.raises(ValueError, match=r"c.dxf: there are 1.8e\+06 things that are inserted, and at most 250000 are"):
        mr.Masonry.from_dxf(tmp_path / "c.dxf", ground=True)


def test_blocks_that_insert_each_other_are_refused_by_name(tmp_path):
    document = ezdxf.new(units=units.M)
    pier, arch = document.blocks.new("pier"), document.blocks.new("arch")
    pier.add_blockref("arch", (0, 0))
    arch.add_blockref("pier", (0, 0))
    document.modelspace().add_blockref("pier", (0, 0))
    document.saveas(tmp_path / "a.dxf")
    with pytest.raises(ValueError, match=r"a.dxf: the blocks pier, arch insert each other"):
        mr.Masonry.from_dxf(tmp_path / "a.dxf")


DAMAGE = {
    "IndexError": ("$VISRETAIN\n 70\n", "$VISRETAIN\n  0\n"),
    "KeyError": ("  3\nModel\n", "  3\nMoxdel\n"),
    "AttributeError": ("  3\nLayout1\n", "  3\n1.0\n"),
    "of the unit": ("$INSUNITS\n 70\n6\n", "$INSUNITS\n 70\n99\n"),
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_drawing_ends_in_an_error_with_its_path(tmp_path, damage):
    """What the library raises for it is named; each is one line of the file."""
    path = drawing(tmp_path / "a.dxf", ("stone", box(0, 1, 0, 1)))
    text = path.read_text()
    assert DAMAGE[damage][0] in text
    path.write_text(text.replace(*DAMAGE[damage]))
    with pytest.raises(ValueError, match=r"a.dxf: it is not a drawing in DXF, or is damaged: "):
        mr.Masonry.from_dxf(path, ground=True)


def test_a_drawing_that_was_repaired_is_warned_of(tmp_path):
    path = drawing(tmp_path / "a.dxf", ("stone", box(0, 1, 0, 2.5)))
    text = path.read_text()
    assert text.count("\n2.5\n") > 1
    path.write_text(text.replace(" 20\n2.5\n", " 20\n2.5XT\n"))
    with pytest.warns(UserWarning, match=r"a.dxf is damaged, and was repaired .*\"2.5XT\" near line \d+ as \"2.5\""):
        assert mr.Masonry.from_dxf(path, ground=True).blocks[1].area == pytest.approx(2.5)


@pytest.mark.parametrize(
    ("start", "what"),
    [(b"%PDF-1.4", "a PDF"), (b"PK\x03\x04", "a zip archive"), (b"AutoCAD Binary DXF\r\n", "a binary")],
)
def test_other_files_are_named(tmp_path, start, what):
    (tmp_path / "a.dxf").write_bytes(start + bytes(range(256)))
    with pytest.raises(ValueError, match=rf"a.dxf: it is {what}.*, and no drawing in DXF; save it as text in DXF"):
        mr.Masonry.from_dxf(tmp_path / "a.dxf")


def test_arguments_are_checked(tmp_path):
    path = drawing(tmp_path / "a.dxf", ("stone", box(0, 1, 0, 1)), ("brick", box(0, 1, 1, 2)))
    with pytest.raises(ValueError, match="fixed = 'rock' is neither a layer nor a block; the layers are stone, brick"):
        mr.Masonry.from_dxf(path, ["rock"])
    with pytest.raises(ValueError, match=r"density = .* has nothing for the layer 'brick'"):
        mr.Masonry.from_dxf(path, ["stone"], density={"stone": 2000.0})
    with pytest.raises(ValueError, match="scale = 0"):
        mr.Masonry.from_dxf(path, ["stone"], scale=0.0)
    (tmp_path / "no.dxf").write_text("nothing")
    with pytest.raises(ValueError, match=r"no.dxf: it is not a drawing in DXF"):
        mr.Masonry.from_dxf(tmp_path / "no.dxf")
    masonry = mr.Masonry.from_dxf(
        path, ["stone_0"], scale=0.5, friction=lambda joint: 0.5 if "brick" in joint.name else 1.0
    )
    assert masonry.joint_friction.tolist() == [0.5]
    assert math.isclose(masonry.blocks[1].area, 0.25)


def test_layers_are_chosen_and_what_is_left_out_is_said(tmp_path):
    """A frame with an open polyline is another layer; a spline and a hatch are no polylines."""
    document = ezdxf.new(units=units.CM)
    space = document.modelspace()
    space.add_lwpolyline(box(0, 40, 0, 50), close=True, dxfattribs={"layer": "stone"})
    space.add_lwpolyline(box(-90, 90, -90, 90), dxfattribs={"layer": "frame"})
    document.saveas(tmp_path / "a.dxf")
    with pytest.raises(ValueError, match=r"layer frame: .* is open: close it; or give the layers that hold blocks by"):
        mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True)
    assert mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True, layers=["stone"]).blocks[1].area == pytest.approx(0.2)
    with pytest.raises(ValueError, match=r"layers = 'brick' holds nothing; the layers are stone, frame"):
        mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True, layers=["brick"])
    with pytest.raises(TypeError, match="layers = 'stone' of type str is not a list of names"):
        mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True, layers="stone")
    space.add_spline([(0, 0), (1, 1), (2, 0)], dxfattribs={"layer": "stone"})
    space.add_hatch(dxfattribs={"layer": "stone"}).paths.add_polyline_path(box(0, 1, 0, 1))
    document.saveas(tmp_path / "a.dxf")
    with pytest.warns(UserWarning, match=r"only closed polylines are read; left out are 1 HATCH, 1 SPLINE"):
        mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True, layers=["stone"])


def test_an_elevation_in_the_plane_x_z_and_a_unit_other_than_that_of_the_header(tmp_path):
    document = ezdxf.new(units=units.IN)
    corners = [(0, 7, 0), (40, 7, 0), (40, 7, 90), (0, 7, 90)]
    document.modelspace().add_polyline3d(corners, close=True)
    document.saveas(tmp_path / "a.dxf")
    masonry = mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True, up="z", unit="cm")
    np.testing.assert_allclose(masonry.blocks[1].corners, [(0, 0), (0.4, 0), (0.4, 0.9), (0, 0.9)], atol=1e-12)
    own = mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True, up="z")
    assert own.blocks[1].area == pytest.approx(0.36 * 2.54**2)


def test_inserts_without_a_scale_along_z_and_drawings_of_lines(tmp_path):
    """Plane drawings of some programs insert blocks with a scale of nought along z."""
    document = ezdxf.new(units=units.M)
    document.blocks.new("s").add_lwpolyline(box(0, 1, 0, 2), close=True)
    document.modelspace().add_blockref("s", (5, 0), dxfattribs={"zscale": 0.0})
    document.saveas(tmp_path / "a.dxf")
    assert mr.Masonry.from_dxf(tmp_path / "a.dxf", ground=True).blocks[1].area == pytest.approx(2.0)
    document = ezdxf.new()
    for start, end in (((0, 0), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 0))):
        document.modelspace().add_line(start, end)
    document.saveas(tmp_path / "b.dxf")
    with pytest.raises(ValueError, match="there is 3 LINE; join its lines to closed polylines"):
        mr.Masonry.from_dxf(tmp_path / "b.dxf", ground=True)


def test_outlines_that_are_not_convex_are_cut_or_filled(tmp_path):
    """An L of 4 m2 is two parts of a unit; its hull has 5 m2. It keeps its place among the blocks."""
    shape = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 3), (0, 3)]
    path = drawing(tmp_path / "a.dxf", ("L", shape), ("stone", box(2, 3, 0, 1)))
    with pytest.raises(ValueError, match=r"block L_0, .* points inwards; a block is convex; convex='parts' cuts it"):
        mr.Masonry.from_dxf(path, ground=True)
    cut = mr.Masonry.from_dxf(path, ground=True, convex="parts", density={"L": 1000.0, "stone": 2000.0}, length=0.5)
    assert isinstance(cut.blocks[1], mr.Compound)
    assert cut.names == ("ground", "L_0", "stone_0")
    assert [block.mass for block in cut.blocks[1:]] == pytest.approx([2000.0, 1000.0])
    assert len(cut.joints) == 3
    with pytest.warns(UserWarning, match=r"convex='hull' adds volume to 1 bodies: L_0 25.00%"):
        filled = mr.Masonry.from_dxf(path, ["L"], convex="hull")
    assert filled.blocks[0].area == pytest.approx(5.0)
    assert [block.fixed for block in filled.blocks] == [True, False]


@pytest.mark.parametrize(("unit", "message"), [(units.IN, "0.0254 m"), (units.MM, "0.001 m")])
def test_a_header_that_states_another_unit_than_the_drawing_has_is_named(tmp_path, unit, message):
    """Bricks that are drawn in mm and in m under the default of a template."""
    high = 250.0 if unit == units.IN else 0.4
    outlines = [("brick", box(0, 2 * high, i * high, (i + 1) * high)) for i in range(5)]
    path = drawing(tmp_path / "a.dxf", *outlines, unit=unit)
    with pytest.warns(UserWarning, match=f"a.dxf: its header says that its unit is {message}, which .*; unit= takes"):
        mr.Masonry.from_dxf(path, ground=True)


def test_a_thing_of_no_kind_is_no_error_of_the_library(tmp_path):
    """A damaged name of a kind, as of the text here, ended in an AttributeError of ezdxf."""
    path = facade(tmp_path / "a.dxf")
    for name in ("TEXT", "LINE", "LWPOLYLINE", "INSERT"):
        for other in ("18", "?"):
            (tmp_path / "b.dxf").write_text(path.read_text().replace(f"\n{name}\n", f"\n{other}\n"))
            with pytest.raises(ValueError, match=r"b\.dxf: "):
                mr.Masonry.from_dxf(tmp_path / "b.dxf", layers=["rock", "none"])
