"""Masonry from files of other programs and back; what is not a masonry is refused with the file and the body."""

import json
import struct
import time

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.masonry.files.meshes import read_obj

UNIT = (0.4, 0.2)
FACADE = mr.Masonry.facade(0.8, 0.4, 0.4, UNIT, xi=0)
CUBE_FACES = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]


def cube(low=(0.0, 0.0, 0.0), edge=1.0):
    """Corners with z fastest, of the faces above."""
    return [tuple(low[i] + edge * bit[i] for i in range(3)) for bit in np.ndindex(2, 2, 2)]


def obj(*bodies, kind="o"):
    text, before = "", 1
    for name, corners, faces in bodies:
        text += f"{kind} {name}\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
        text += "".join("f " + " ".join(f"{before + i}//1" for i in face) + "\n" for face in faces)
        before += len(corners)
    return text


def triangles(masonry):
    """Each body as triangles, one after the other."""
    for name, block in zip(masonry.names, masonry.blocks, strict=True):
        yield name, [block.corners[[f[0], f[i], f[i + 1]]] for f in block.faces for i in range(1, len(f) - 1)]


def binary_stl(masonry):
    facets = [facet for _, body in triangles(masonry) for facet in body]
    rows = [struct.pack("<12fH", 0, 0, 0, *facet.ravel(), 0) for facet in facets]
    return bytes(80) + struct.pack("<I", len(rows)) + b"".join(rows)


def text_stl(masonry):
    lines = []
    for name, body in triangles(masonry):
        lines.append(f"solid {name}")
        for facet in body:
            corners = [f"vertex {x!r} {y!r} {z!r}" for x, y, z in facet.tolist()]
            lines += ["facet normal 0 0 0", "outer loop", *corners, "endloop", "endfacet"]
        lines.append(f"endsolid {name}")
    return "\n".join(lines).encode()


def written(path, content):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def same(masonry, other):
    """Whether masonry has the same blocks; the order of vertices does not count."""
    shapes = [[(b.fixed, sorted(b.vertices)) for b in each.blocks] for each in (masonry, other)]
    return masonry.names == other.names and shapes[0] == shapes[1]


def test_an_obj_file_and_back(tmp_path):
    path = FACADE.to_obj(tmp_path / "wall.obj")
    masonry = mr.Masonry.from_obj(path, fixed=["ground"], density=1800.0, k_n=1e9, xi=0)
    assert same(masonry, FACADE)
    assert masonry.blocks[1].density == 1800.0
    assert mr.Masonry.from_obj(path, fixed=["ground"], xi=0).blocks[1].density == 2000.0
    assert [joint.name for joint in masonry.joints] == [joint.name for joint in FACADE.joints]


def test_a_compas_model_and_back(tmp_path):
    blocks = [*FACADE.blocks[:-1], mr.Polyhedron(FACADE.blocks[-1].vertices, 2400.0, name="dense")]
    path = mr.Masonry(blocks, xi=0).to_compas(tmp_path / "wall.json")
    masonry = mr.Masonry.from_compas(path, xi=0)
    assert masonry == mr.Masonry.from_compas(path, xi=0)
    assert same(masonry, mr.Masonry(blocks, xi=0))
    assert masonry.blocks[-1].density == 2400.0


@pytest.mark.parametrize("content", [binary_stl, text_stl])
def test_stl_files(tmp_path, content):
    """Bodies that touch are told apart where they come one after the other."""
    path = written(tmp_path / "wall.stl", content(FACADE))
    name = "ground" if content is text_stl else "body_0"
    masonry = mr.Masonry.from_stl(path, fixed=[name], xi=0)
    assert len(masonry.blocks) == len(FACADE.blocks)
    assert len(masonry.joints) == len(FACADE.joints)
    assert [b.mass for b in masonry.blocks] == pytest.approx([b.mass for b in FACADE.blocks], rel=1e-5)


def test_groups_negative_numbers_millimetres_and_ground(tmp_path):
    corners = np.array(cube(edge=1000.0)) + np.array([0, 0, 500.0])
    text = obj(("one|half", corners, CUBE_FACES), kind="g")
    text += "g other\n" + "".join(f"v {x + 1000} {y} {z}\n" for x, y, z in corners)
    text += "".join("f " + " ".join(str(i - 8) for i in face) + "\n" for face in CUBE_FACES)
    masonry = mr.Masonry.from_obj(written(tmp_path / "a.obj", text), ground=True, scale=0.001, xi=0)
    assert masonry.names == ("ground", "one_half", "other")
    assert [joint.name for joint in masonry.joints] == ["ground|one_half", "ground|other", "one_half|other"]
    assert masonry.centroids[1] == pytest.approx([0.5, 0.5, 1.0])


def test_bodies_of_one_object_are_numbered_also_when_their_faces_alternate(tmp_path):
    corners = cube() + cube((2.0, 0, 0))
    faces = [tuple(i + 8 * k for i in face) for face in CUBE_FACES for k in (0, 1)]
    path = written(tmp_path / "a.obj", obj(("pair", corners, faces)))
    assert mr.Masonry.from_obj(path, ground=True, xi=0).names == ("ground", "pair_0", "pair_1")


def test_a_model_of_compas_that_is_moved(tmp_path):
    model = json.loads(FACADE.to_compas(tmp_path / "a.json").read_text())
    matrix = np.eye(4)
    matrix[:3, 3] = [1.0, 2.0, 3.0]
    for element in model["data"]["elements"].values():
        element["data"]["transformation"] = {"data": {"matrix": matrix.tolist()}}
        element["data"]["name"] = "Block"
    masonry = mr.Masonry.from_compas(written(tmp_path / "b.json", json.dumps(model)), xi=0)
    assert masonry.names[:2] == ("Block_0", "Block_1")
    assert masonry.centroids - FACADE.centroids == pytest.approx(np.tile([1.0, 2, 3], (len(masonry.blocks), 1)))


NOTCHED = [(0, 0, 0), (2, 0, 0), (2, 0, 2), (1, 0, 1), (0, 0, 2)]
NOTCH = [*NOTCHED, *((x, 1, z) for x, _, z in NOTCHED)]
NOTCH_FACES = [(0, 1, 2, 3, 4), (5, 6, 7, 8, 9)] + [(i, (i + 1) % 5, (i + 1) % 5 + 5, i + 5) for i in range(5)]


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        (obj(("a", cube(), CUBE_FACES[:-1])), "body a is open: 4 of its edges belong to one face alone"),
        (obj(("a", NOTCH, NOTCH_FACES)), "body a is not convex: its faces enclose 3 m3 within their hull of 4 m3"),
        (obj(("a", [*cube()[:7], (0.3, 0.3, 0.3)], CUBE_FACES)), "body a is not convex: .* 0.65 m3 within"),
        (obj(("a", cube(), CUBE_FACES), ("b", cube((0, 0, 1.01)), CUBE_FACES)), "b touch no other block .* 0.01 m"),
        (obj(("a", cube(), CUBE_FACES), ("b", cube((0, 0, 0.9)), CUBE_FACES)), "blocks a and b overlap by 0.1 m"),
        (obj(("a", cube(), CUBE_FACES)).replace("f 2", "f 99"), "line 11: 'f 99//1 .* is not a vertex or face"),
        (obj(("a", cube(), CUBE_FACES)) + "f 1 2", "line 16: 'f 1 2' is not a vertex or face"),
        (obj(("a", cube(), CUBE_FACES)) + "v 1 nan", "line 16"),
        (obj(("a", cube(), CUBE_FACES)).replace("v 0.0 0.0 0.0", "v nan 0 0"), "body a: vertices holds a coordinate"),
        ("solid a\nendsolid\n", "has no faces: it is not an OBJ file, or is cut short"),
        ("", "has 0 bytes"),
        (b"\xff\xfe\x00", "is not text"),
    ],
)
def test_obj_files_that_are_no_masonry(tmp_path, text, complaint):
    path = written(tmp_path / "broken.obj", text)
    with pytest.raises(ValueError, match=rf"broken.obj.*{complaint}"):
        mr.Masonry.from_obj(path, ground=True, xi=0)


def test_stl_files_that_are_none(tmp_path):
    content = binary_stl(FACADE)
    for name, broken, complaint in (
        ("cut", content[:-30], "is not an STL file, or is cut short: it has .* bytes; its head promises"),
        ("text", text_stl(FACADE)[:3000], "the solid .* does not end|is open|three vertices|not a vertex"),
        ("other", b"PK" + bytes(300), "is not an STL file"),
        ("open", text_stl(FACADE).replace(b"endfacet", b"", 1).replace(b"vertex", b"vert", 1), "three vertices|open"),
    ):
        with pytest.raises(ValueError, match=rf"{name}.stl.*({complaint})"):
            mr.Masonry.from_stl(written(tmp_path / f"{name}.stl", broken), fixed=["body_0"], xi=0)


def test_json_files_that_are_none(tmp_path):
    text = FACADE.to_compas(tmp_path / "a.json").read_text()
    for name, broken, complaint in (
        ("cut", text[:2000], "is not JSON, or is cut short"),
        ("deep", "[" * 100_000, "is not JSON, or is cut short"),
        ("other", "[1, 2]", "is not a COMPAS model: it has no data.elements"),
        ("none", '{"data": {"elements": {}}}', "without elements"),
        ("rows", '[{"vertex": [[0, 0, 0]], "face": [[0, 1]]}, {}]', r"the element 0 is not .*, and faces .* vertices$"),
        ("mesh", text.replace('"vertex"', '"corners"'), "the element .* is not a block with a mesh, which has x"),
    ):
        with pytest.raises(ValueError, match=rf"{name}.json.*{complaint}"):
            mr.Masonry.from_compas(written(tmp_path / f"{name}.json", broken), xi=0)


def test_a_coordinate_beyond_floats_is_named(tmp_path):
    model = json.loads(FACADE.to_compas(tmp_path / "a.json").read_text())
    element = next(iter(model["data"]["elements"].values()))
    element["data"]["geometry"]["data"]["vertex"]["0"]["x"] = 10**400
    with pytest.raises(ValueError, match=r"b.json: the element .* is not a block with a mesh, which has x, y"):
        mr.Masonry.from_compas(written(tmp_path / "b.json", json.dumps(model)), xi=0)


def test_files_of_many_faces_and_of_many_bodies_take_no_longer_than_their_size_asks(tmp_path):
    """Bodies without end are refused as soon as they are too many, and a body knows its own vertices alone."""
    faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "f 1 2 3\n" * 60_000
    started = time.process_time()
    with pytest.raises(ValueError, match=r"body_0 is more than 25000 closed bodies"):
        mr.Masonry.from_obj(written(tmp_path / "faces.obj", faces))
    took = time.process_time() - started
    assert took < 2  # 0.2 s; it were 4 s if each pair of faces was divided for itself
    boxes = obj(*((f"b{i}", cube((2.0 * i, 0, 0)), CUBE_FACES) for i in range(1000)))
    meshes = read_obj(written(tmp_path / "boxes.obj", boxes))
    assert len(meshes) == 1000
    assert all(mesh.vertices.shape == (8, 3) for mesh in meshes)
    assert [mesh.vertices[0].tolist() for mesh in meshes[:3]] == [[0, 0, 0], [2, 0, 0], [4, 0, 0]]


@pytest.mark.parametrize("name", ["#a", "a # b", "a\\", " a", "a "])
def test_names_that_no_obj_file_holds(tmp_path, name):
    """They would come back as others, or as none, or tie two lines together. A COMPAS model holds them."""
    ground = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True)
    named = mr.Masonry([ground, mr.Polyhedron.box((1, 1, 1), (0, 0, 0.5), name=name)])
    with pytest.raises(ValueError, match=r"the block .* has a # in its name, a backslash at its end or a blank"):
        named.to_obj(tmp_path / "a.obj")
    assert not list(tmp_path.iterdir())
    if name.strip() == name:
        assert mr.Masonry.from_compas(named.to_compas(tmp_path / "a.json")).names[1] == name


def test_arguments_are_checked(tmp_path):
    path = FACADE.to_obj(tmp_path / "wall.obj")
    with pytest.raises(ValueError, match="fixed = 'floor' is not a body; there are ground, facade_0_0"):
        mr.Masonry.from_obj(path, fixed=["floor"])
    with pytest.raises(ValueError, match="fixed has 'ground' 2 times; each body is named once"):
        mr.Masonry.from_obj(path, fixed=["ground", "ground"])
    with pytest.raises(TypeError, match="fixed = 'ground' of type str is not a list of names"):
        mr.Masonry.from_obj(path, fixed="ground")
    with pytest.raises(ValueError, match="scale = 0 m is outside the valid range"):
        mr.Masonry.from_obj(path, scale=0)
    with pytest.raises(ValueError, match=r"none.obj: it is not a file"):
        mr.Masonry.from_obj(tmp_path / "none.obj")
    with pytest.raises(ValueError, match="blocks are in the plane, and"):
        mr.Masonry.stack([mr.Block(0.3, 1.0)], 1e8).to_obj(tmp_path / "a.obj")


def assembly(masonry):
    """Blocks as compas_assembly 0.7 writes them: the nodes of a graph."""
    nodes = {}
    for i, block in enumerate(masonry.polyhedra):
        places = [dict(zip("xyz", place, strict=True)) for place in block.vertices]
        mesh = {"vertex": {str(k): place for k, place in enumerate(places)}}
        mesh["face"] = {str(k): list(face) for k, face in enumerate(block.faces)}
        node = {"block": {"dtype": "compas_assembly.datastructures/Block", "data": mesh}}
        nodes[str(i)] = node | ({"is_support": True} if block.fixed else {})
    graph = {"dtype": "compas.datastructures/Graph", "data": {"node": nodes, "edge": {}}}
    content = {"attributes": {"name": "Assembly"}, "graph": graph}
    return json.dumps({"dtype": "compas_assembly.datastructures/Assembly", "data": content})


def test_an_assembly_keeps_its_joints(tmp_path):
    masonry = mr.Masonry.from_compas(written(tmp_path / "assembly.json", assembly(FACADE)), xi=0)
    assert [(j.below, j.above) for j in masonry.joints] == [(j.below, j.above) for j in FACADE.joints]
    np.testing.assert_allclose([j.area for j in masonry.joints], [j.area for j in FACADE.joints])
    assert [block.fixed for block in masonry.blocks] == [block.fixed for block in FACADE.blocks]
    assert masonry.names[:2] == ("block_0", "block_1")


def test_a_problem_that_holds_its_model(tmp_path):
    model = json.loads(FACADE.to_compas(tmp_path / "a.json").read_text())
    problem = {"dtype": "compas_dem.problem/Problem", "data": {"name": "Problem", "model": model}}
    assert same(mr.Masonry.from_compas(written(tmp_path / "p.json", json.dumps(problem)), xi=0), FACADE)


def test_models_that_compas_writes_itself(tmp_path):
    """Through the classes of compas_dem, whose own contacts are as many and as large as the joints."""
    pytest.importorskip("compas_dem", reason="needs compas_dem")
    import compas

    column = mr.Masonry.column(0.5, 1.5, 3)
    model = compas.json_load(column.to_compas(tmp_path / "a.json"))
    model.compute_contacts(tolerance=1e-6, minimum_area=1e-6)
    areas = sorted(contact.size for contact in model.contacts())
    assert areas == pytest.approx([joint.area for joint in column.joints], rel=1e-9)
    compas.json_dump(model, tmp_path / "b.json")
    again = mr.Masonry.from_compas(tmp_path / "b.json")
    assert same(again, column)
    assert [joint.name for joint in again.joints] == [joint.name for joint in column.joints]


def test_assemblies_that_compas_assembly_writes(tmp_path):
    pytest.importorskip("compas_assembly", reason="needs compas_assembly")
    import compas
    from compas.geometry import Box, Frame
    from compas_assembly.datastructures import Assembly, Block

    made = Assembly()
    for i in range(3):
        place = Frame([0, 0, 0.2 + 0.4 * i], [1, 0, 0], [0, 1, 0])
        made.add_block(Block.from_shape(Box(1.0, 0.5, 0.4, place)), is_support=i == 0)
    compas.json_dump(made, tmp_path / "assembly.json")
    masonry = mr.Masonry.from_compas(tmp_path / "assembly.json")
    assert [joint.area for joint in masonry.joints] == pytest.approx([0.5, 0.5])
    assert [block.fixed for block in masonry.blocks] == [True, False, False]


def test_a_text_of_34_bytes_is_no_stl_file(tmp_path):
    """84 bytes and 50 for each of -1 facets are 34."""
    with pytest.raises(ValueError, match=r"it is not an STL file, or is cut short: it has 34 bytes$"):
        mr.Masonry.from_stl(written(tmp_path / "short.stl", b"solid".ljust(34)))


def test_an_stl_file_that_ends_within_a_facet_says_so(tmp_path):
    path = tmp_path / "cut.stl"
    path.write_text("solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendsolid a\n")
    with pytest.raises(ValueError, match="line 6: a facet of an STL file has three vertices"):
        mr.Masonry.from_stl(path)
