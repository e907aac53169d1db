"""Bodies as others draw them: in other units, with other axes, dented, open, and in other forms of file."""

import json
import struct
import warnings
from itertools import pairwise

import ezdxf
import numpy as np
import pytest

import mjrock as mr
from mjrock.geometry.hull import bulk_of

CUBE_FACES = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
TURNED = {"x": [1, 2, 0], "y": [0, 2, 1], "z": [0, 1, 2]}
"""Axes of a file that become x, y and z, but for their signs."""


def cuboid(low, high):
    """Vertices and faces of a box, z fastest."""
    return np.array([[(low, high)[bit[i]][i] for i in range(3)] for bit in np.ndindex(2, 2, 2)]), CUBE_FACES


def prism(outline, length, first=0):
    """Vertices and faces of an outline x, z over a length along y; its end faces begin at one of its corners."""
    n = len(outline)
    vertices = np.array([(x, y, z) for y in (0.0, length) for x, z in outline])
    ends = [tuple((first + i) % n for i in range(n)), tuple(n + (first - i) % n for i in range(n))]
    return vertices, ends + [(i, n + i, n + (i + 1) % n, (i + 1) % n) for i in range(n)]


def bricks(scale=1.0, up="z", count=8, size=(0.25, 0.12, 0.06)):
    """A pile of bricks by name, drawn in units of 1/scale m and with an axis upwards."""
    made = {}
    for i in range(count):
        vertices, faces = cuboid((0, 0, size[2] * i), (size[0], size[1], size[2] * (i + 1)))
        if up == "y":
            vertices = vertices[:, [0, 2, 1]] * [1, 1, -1]
        if up == "x":
            vertices = vertices[:, [2, 0, 1]] * [1, -1, -1]
        made[f"b{i}"] = (scale * vertices, faces)
    return made


def obj_text(meshes):
    text, before = "", 1
    for name, (vertices, faces) in meshes.items():
        text += f"o {name}\n" + "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in np.asarray(vertices).tolist())
        text += "".join("f " + " ".join(str(before + i) for i in face) + "\n" for face in faces)
        before += len(vertices)
    return text


@pytest.mark.parametrize(
    ("unit", "size", "message"),
    [
        ("cm", 0.01, "cm, 0.28 m or in, 0.72 m"),
        ("in", 0.0254, "in, 0.28 m or cm, 0.11 m"),
        ("mm", 0.001, "mm, 0.28 m or cm, 2.8 m"),
    ],
)
def test_bricks_in_another_unit_are_doubted_and_read_in_theirs(unit, size, message):
    """Of a brick of 0.25 x 0.12 x 0.06 m the diagonal, which is 0.284 m, is the size."""
    with pytest.warns(
        mr.Implausible, match=rf"b. is .* m across; vertices are in m: are they in {message}\? A file takes"
    ):
        mr.Masonry.from_meshes(bricks(1 / size), ground=True)
    read = mr.Masonry.from_meshes(bricks(1 / size), ground=True, unit=unit)
    assert [block.mass for block in read.blocks[1:]] == pytest.approx([2000 * 0.25 * 0.12 * 0.06] * 8)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("up", ["x", "y", "z"])
def test_a_file_is_turned_until_the_axis_that_is_named_points_upwards(up):
    upright = mr.Masonry.from_meshes(bricks(), ground=True, up="z")
    turned = mr.Masonry.from_meshes(bricks(up=up), ground=True, up=up)
    assert [joint.name for joint in turned.joints] == [joint.name for joint in upright.joints]
    np.testing.assert_allclose(
        [sorted(b.corners.tolist()) for b in turned.blocks],
        [sorted(b.corners.tolist()) for b in upright.blocks],
        atol=1e-12,
    )


@pytest.mark.parametrize("up", ["x", "y"])
def test_a_wall_that_lies_on_its_face_is_doubted(up):
    """Also where the ground is in the file; nobody doubts a caller who says that z points upwards."""
    pile = bricks(up=up, size=(0.25, 0.12, 0.1))
    message = f"z points upwards: does {up} in this file. up='{up}' turns it, and up='z' keeps z"
    with pytest.warns(mr.Implausible, match=f"8 of 8 blocks lie on the ground, side by side along {up}; {message}"):
        mr.Masonry.from_meshes(pile, ground=True)
    with pytest.warns(mr.Implausible, match=f"lie along {up} from the fixed ones and not above them; {message}"):
        mr.Masonry.from_meshes(pile, ["b0"])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mr.Masonry.from_meshes(pile, ground=True, up="z")


GROOVED = [(0, 0), (0.6, 0), (0.6, 0.4), (0.45, 0.4), (0.45, 0.25), (0.15, 0.25), (0.15, 0.4), (0, 0.4)]
SAWN = [(0, 0), (0.6, 0), (0.6, 0.4), (0.3001, 0.4), (0.3001, 0.2), (0.2999, 0.2), (0.2999, 0.4), (0, 0.4)]


@pytest.mark.parametrize("first", range(8))
@pytest.mark.parametrize(("outline", "volume"), [(GROOVED, 0.0975), (SAWN, 0.12 - 0.5 * 0.2 * 0.0002)])
def test_a_groove_is_seen_wherever_the_end_faces_begin(first, outline, volume):
    """A sawn stone has 0.02 % less than its hull: its faces tell it."""
    mesh = {"stone": prism(outline, 0.5, first)}
    with pytest.raises(ValueError, match=rf"body stone is not convex: .* {volume:.4g} m3 within their hull of 0.12 m3"):
        mr.Masonry.from_meshes(mesh, ground=True)
    with pytest.warns(UserWarning, match=rf"convex='hull' adds volume to 1 bodies: stone {0.12 / volume - 1:.2%}"):
        assert mr.Masonry.from_meshes(mesh, ground=True, convex="hull").blocks[1].volume == pytest.approx(0.12)
    cut = mr.Masonry.from_meshes(mesh, ground=True, convex="parts", density=1000.0)
    assert isinstance(cut.blocks[1], mr.Compound)
    assert cut.blocks[1].mass == pytest.approx(1000 * volume, rel=1e-6)
    assert len(cut.joints) == 1


def test_parts_have_the_mass_and_the_inertia_of_the_body():
    """Beside the sum over the tetrahedra of the faces, of a frame around an opening."""
    outer, inner = prism([(0, 0), (3, 0), (3, 2), (0, 2)], 0.5), prism([(1, 0.5), (2, 0.5), (2, 1.5), (1, 1.5)], 0.5)
    ring = [(i, (i + 1) % 4, 8 + (i + 1) % 4, 8 + i) for i in range(4)]
    ring += [(4 + (i + 1) % 4, 4 + i, 12 + i, 12 + (i + 1) % 4) for i in range(4)]
    faces = [*ring, *outer[1][2:], *(tuple(8 + i for i in face)[::-1] for face in inner[1][2:])]
    vertices = np.concatenate([outer[0], inner[0]])
    block = mr.Masonry.from_meshes({"frame": (vertices, faces)}, ground=True, convex="parts").blocks[1]
    bulk = bulk_of(vertices, tuple(faces))
    assert block.mass == pytest.approx(2000 * 0.5 * 5.0, rel=1e-9)
    assert abs(bulk.volume) == pytest.approx(2.5)
    np.testing.assert_allclose(block.centroid, bulk.centroid, rtol=1e-9)
    second = 2000 * np.sign(bulk.volume) * bulk.second
    np.testing.assert_allclose(block.inertia, np.trace(second) * np.eye(3) - second, rtol=1e-9, atol=1e-6)


def test_all_dented_bodies_are_said_at_once():
    meshes = {"tray": prism(GROOVED, 0.5), "plain": cuboid((1, 0, 0), (2, 1, 1)), "notch": prism(SAWN, 0.5)}
    with pytest.raises(ValueError, match=r"body tray is not convex.*, the most of 2 such bodies of 3; convex='hull'"):
        mr.Masonry.from_meshes(meshes, ground=True)


def test_an_open_plate_is_the_face_of_a_support():
    floor = ([(-1, -1, 0), (2, -1, 0), (2, 2, 0), (-1, 2, 0)], [(0, 1, 2, 3)])
    meshes = {"floor": floor, "stone": cuboid((0, 0, 0), (1, 1, 1))}
    with pytest.raises(ValueError, match="body floor is open: it is a plane plate; name it in fixed"):
        mr.Masonry.from_meshes(meshes)
    read = mr.Masonry.from_meshes(meshes, ["floor"])
    assert np.unique(np.round(read.blocks[0].corners[:, 2], 9)).tolist() == [-0.3, 0.0]
    assert [joint.area for joint in read.joints] == pytest.approx([1.0])


def ply(meshes, order, reds=1):
    vertices = np.concatenate([vertices for vertices, _ in meshes.values()])
    before = np.cumsum([0, *(len(vertices) for vertices, _ in meshes.values())])
    faces = [[start + i for i in face] for start, (_, of) in zip(before, meshes.values(), strict=False) for face in of]
    kind = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    red = reds * "property uchar red\n"
    head = (
        f"ply\nformat {kind} 1.0\ncomment own\nelement vertex {len(vertices)}\nproperty double x\nproperty double y\n"
        f"property double z\n{red}element face {len(faces)}\nproperty list uchar int vertex_indices\n"
        "end_header\n"
    )
    if not order:
        rows = [f"{x!r} {y!r} {z!r}{reds * ' 7'}" for x, y, z in vertices.tolist()]
        rows += [" ".join(map(str, [len(face), *face])) for face in faces]
        return (head + "\n".join(rows) + "\n").encode()
    rows = [struct.pack(f"{order}ddd{reds}B", *place, *reds * [7]) for place in vertices.tolist()]
    rows += [struct.pack(f"{order}B{len(face)}i", len(face), *face) for face in faces]
    return head.encode() + b"".join(rows)


@pytest.mark.parametrize("order", ["", "<", ">"])
def test_ply_files(tmp_path, order):
    path = tmp_path / "a.ply"
    path.write_bytes(ply(bricks(), order))
    read = mr.Masonry.from_ply(path, ground=True)
    assert [block.mass for block in read.blocks[1:]] == pytest.approx([2000 * 0.25 * 0.12 * 0.06] * 8)
    assert len(read.joints) == 8


def test_ply_files_that_are_none(tmp_path):
    text = ply(bricks(), "")
    for broken in (
        text[:200], text[:-100], text[:-3],
        ply(bricks(), "<")[:-9], text.replace(b"element face 48", b"element face 99999999999"),
        text.replace(b"ascii", b"utf"), text.replace(b"property double z", b"property double w"), b"solid a\n",
        text.replace(b"4 0 4 6 2", b"4 0 4 6 999"), text.replace(b"4 0 4 6 2", b"2 0 4 6 2"),
        text.replace(b"element face", b"element edge -3\nproperty int a\nelement face"),
    ):  # fmt: skip
        (tmp_path / "b.ply").write_bytes(broken)
        with pytest.raises(ValueError, match=r"b.ply: .*"):
            mr.Masonry.from_ply(tmp_path / "b.ply", ground=True)


@pytest.mark.parametrize("order", ["", "<"])
def test_properties_of_one_name_in_a_ply_file_have_a_place_each(tmp_path, order):
    """The red of front and back, say."""
    path = tmp_path / "a.ply"
    path.write_bytes(ply(bricks(), order, reds=2))
    assert len(mr.Masonry.from_ply(path, ground=True).joints) == 8


def compas_mesh(mesh):
    vertices, faces = mesh
    places = {
        str(10 + i): dict(zip("xyz", place, strict=True)) for i, place in enumerate(np.asarray(vertices).tolist())
    }
    return {"vertex": places, "face": {str(i): [str(10 + j) for j in face] for i, face in enumerate(faces)}}


FLOOR, STONE = compas_mesh(cuboid((-1, -1, -1), (2, 2, 0))), compas_mesh(cuboid((0, 0, 0), (1, 1, 1)))
ASSEMBLY, MESH = "compas_assembly.datastructures/Assembly", "compas.datastructures/Mesh"
FORMS = {
    "blocks beside a network": {
        "assembly": {"attributes": {}, "node": {"0": {"is_support": True}, "1": {}}, "edge": {}},
        "blocks": {"0": FLOOR, "1": STONE},
    },
    "blocks beside a network of vertices": {
        "assembly": {"vertex": {"0": {"is_support": True, "x": 0.0}, "1": {"is_support": False}}},
        "blocks": {"0": FLOOR, "1": STONE},
    },
    "a network of blocks": {
        "attributes": {"name": "Network"},
        "node": {
            "0": {"block": {"dtype": ASSEMBLY, "value": FLOOR}, "is_support": True},
            "1": {"block": {"dtype": ASSEMBLY, "value": {"datatype": MESH, "data": STONE}}},
        },
    },
    "an assembly of COMPAS 1": {
        "dtype": ASSEMBLY,
        "value": {"graph": {"node": {
            "0": {"block": {"dtype": MESH, "value": FLOOR, "guid": "0"}, "is_support": True},
            "1": {"block": {"dtype": MESH, "value": STONE}},
        }}},
    },
    "an older model": {
        "dtype": "compas_dem.models/BlockModel",
        "data": {"elements": [
            {"dtype": "compas_dem/Block", "data": {"shape": {"dtype": MESH, "data": FLOOR}, "is_support": True}},
            {"dtype": "compas_dem/Block", "data": {"shape": {"dtype": MESH, "data": STONE}}},
        ]},
    },
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
def test_older_files_of_compas(tmp_path, form):
    path = tmp_path / "a.json"
    path.write_text(json.dumps(FORMS[form]))
    read = mr.Masonry.from_compas(path)
    assert [block.fixed for block in read.blocks] == [True, False]
    assert [joint.area for joint in read.joints] == pytest.approx([1.0])
    assert read.names == ("block_0", "block_1")


@pytest.mark.parametrize("mesh", [lambda m: m, lambda m: [m], lambda m: {"dtype": MESH, "value": {"data": m}}])
def test_a_list_of_meshes_of_compas(tmp_path, mesh):
    path = tmp_path / "a.json"
    path.write_text(json.dumps([mesh(FLOOR), mesh(STONE)]))
    assert [joint.area for joint in mr.Masonry.from_compas(path, ["block_0"]).joints] == pytest.approx([1.0])


def test_what_is_said_of_a_file_is_checked(tmp_path):
    meshes, path = bricks(), tmp_path / "a.obj"
    path.write_text(obj_text(meshes))
    for read, first in ((mr.Masonry.from_obj, path), (mr.Masonry.from_meshes, meshes)):
        with pytest.raises(ValueError, match="unit = 'km' is not one of m, cm, mm, in, ft"):
            read(first, ground=True, unit="km")
        with pytest.raises(ValueError, match=r"unit = 'cm' of type str and scale = 0.01 are both given; give one"):
            read(first, ground=True, unit="cm", scale=0.01)
        with pytest.raises(ValueError, match="up = -1 is not one of x, y, z"):
            read(first, ground=True, up=-1)
        with pytest.raises(ValueError, match="convex = 'cut' is not one of hull, parts"):
            read(first, ground=True, convex="cut")


@pytest.mark.parametrize(
    ("meshes", "complaint"),
    [
        ({}, "meshes is empty: the model has no element of the kind .* whole walls, IfcWall"),
        ([1], "meshes = .* is not a dict"),
        ({"a": 1}, "meshes.'a' .* = 1 of type int is not a pair of vertices and faces"),
        ({"a": ([(0, 0)], [])}, "meshes.'a' .*: vertices has the shape .1, 2.; .n, 3. is needed"),
        ({"a": (np.zeros((3, 3)), [0])}, "faces = .* are not lists of numbers of vertices"),
        ({"a": (np.zeros((3, 3)), [(0, 1, 3)])}, "the face .0, 1, 3. is not three or more of 3 vertices"),
        ({"a": (np.zeros((3, 3)), [(0, 1, 0.5)])}, "are not lists of numbers"),
        ({"a": (np.zeros((3, 3)), [])}, "body a has no faces"),
        ({1: (np.zeros((3, 3)), [(0, 1, 2)])}, "meshes = 1 of type int"),
    ],
)
def test_meshes_that_are_none(meshes, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.Masonry.from_meshes(meshes, ground=True)


def stl_text(meshes):
    lines = []
    for name, (vertices, faces) in meshes.items():
        lines.append(f"solid {name}")
        for face in faces:
            for i, j in pairwise(face[1:]):
                lines += ["facet normal 0 0 0", "outer loop"]
                lines += [f"vertex {x!r} {y!r} {z!r}" for x, y, z in vertices[[face[0], i, j]].tolist()]
                lines += ["endloop", "endfacet"]
        lines.append(f"endsolid {name}")
    return "\n".join(lines)


def dxf_text(path):
    document = ezdxf.new("R12")
    for i in range(3):
        places = [(0, 0.1 * i), (0.3, 0.1 * i), (0.3, 0.1 * i + 0.1), (0, 0.1 * i + 0.1)]
        document.modelspace().add_polyline2d(places, close=True)
    document.saveas(path)
    return path.read_bytes()


FILES = {
    "obj": lambda path: obj_text(bricks(count=3)).encode(),
    "stl": lambda path: stl_text(bricks(count=3)).encode(),
    "ply": lambda path: ply(bricks(count=3), "<"),
    "compas": lambda path: json.dumps(FORMS["blocks beside a network"]).encode(),
    "dxf": dxf_text,
}


@pytest.mark.parametrize("form", FILES)
def test_damaged_files_are_read_or_refused_with_their_path(tmp_path, form):
    """Cut short anywhere, with bytes put in the place of others, and with lines left out."""
    path, random = tmp_path / f"a.{form}", np.random.default_rng(7)
    content = FILES[form](path)
    lines = content.split(b"\n")
    damaged = [content[: int(len(content) * share)] for share in random.uniform(0.02, 0.98, 8)]
    for _ in range(12):
        some = bytearray(content)
        for at in random.integers(len(content), size=3):
            some[at] = random.choice(list(b'0-9.eE x"{[\n\xff'))
        damaged.append(bytes(some))
        damaged.append(b"\n".join(line for line in lines if random.uniform() > 2 / len(lines)))
    path.write_bytes(content)
    assert getattr(mr.Masonry, f"from_{form}")(path, ground=True).joints
    unnamed = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for some in damaged:
            path.write_bytes(some)
            try:
                getattr(mr.Masonry, f"from_{form}")(path, ground=True)
            except ValueError as error:
                unnamed += [str(error)] if str(path) not in str(error) else []
    assert unnamed == []


def test_a_warped_face_is_cut_as_its_triangles():
    """One upper corner of a cube is 0.2 m lower: the first diagonal of the upper face goes up, the other one down."""
    vertices, faces = cuboid((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    vertices[7, 2] = 0.8
    for up, volume in (((1, 3, 7, 5), 1 - 0.2 / 6), ((3, 7, 5, 1), 1 - 0.2 / 3)):
        others = [face for face in faces if set(face) != {1, 3, 7, 5}]
        mesh = {"stone": (vertices, [*others, up])}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            whole = mr.Masonry.from_meshes(mesh, ground=True, convex="hull")
        cut = mr.Masonry.from_meshes(mesh, ground=True, convex="parts")
        assert cut.blocks[1].mass == pytest.approx(2000 * volume, rel=1e-6)
        assert whole.blocks[1].mass == pytest.approx(2000 * (1 - 0.2 / 6), rel=1e-6)


def test_a_body_whose_faces_cross_is_not_cut():
    """A prism over a figure of eight encloses 1 m3 once forwards and once backwards."""
    mesh = {"eight": prism([(0, 0), (2, 1), (2, 0), (0, 1.5)], 1.0)}
    with pytest.raises(ValueError, match=r"body eight is not convex, and cannot be cut .* do its faces cross"):
        mr.Masonry.from_meshes(mesh, ground=True, convex="parts")


def test_bodies_that_are_drawn_twice_are_read_once(tmp_path):
    meshes = bricks(count=3)
    with pytest.warns(UserWarning, match="1 bodies are drawn twice, and read once: again"):
        read = mr.Masonry.from_meshes(meshes | {"again": meshes["b1"]}, ground=True)
    assert read.names == ("ground", "b0", "b1", "b2")
    vertices, faces = meshes["b0"]
    with pytest.warns(UserWarning, match="1 bodies are drawn twice"):
        assert mr.Masonry.from_meshes({"b": (vertices, faces + faces[::-1])}, ground=True).names == ("ground", "b")


def test_a_refusal_says_that_the_sizes_are_odd():
    """Bricks in mm with a gap of 20 mm."""
    meshes = bricks(1000.0)
    meshes["b7"] = (meshes["b7"][0] + [0, 0, 20.0], meshes["b7"][1])
    with pytest.raises(ValueError, match=r"b7 touch no other block .* 20 m.* A file takes unit='mm'"):
        mr.Masonry.from_meshes(meshes, ground=True)


def test_a_body_of_many_hollow_faces_is_not_cut(monkeypatch):
    """As scans are; a comb of 9 teeth is 17 parts along its flanks."""
    tooth = ((0.0, 1.0), (0.1, 1.0), (0.1, 0.5), (0.2, 0.5))
    comb = [(0.0, 0.0), (1.7, 0.0), *((1.7 - 0.2 * i - x, z) for i in range(9) for x, z in tooth)]
    mesh = {"comb": prism(comb[:-2], 0.5)}
    assert len(mr.Masonry.from_meshes(mesh, ground=True, convex="parts").blocks[1].parts) == 17
    monkeypatch.setattr("mjrock.problem.masonry.files.bodies.MOST_CUTS", 3)
    with pytest.raises(ValueError, match=r"body comb is not convex, .* its faces cut it into .* parts.* hull"):
        mr.Masonry.from_meshes(mesh, ground=True, convex="parts")
