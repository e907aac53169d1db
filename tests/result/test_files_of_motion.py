"""Files of a motion for Blender and ParaView, read again and held to the pictures, which place corners on their own."""

import json
import struct
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

import mjrock as mr
from mjrock.plotting.bodies import Bodies
from mjrock.plotting.solids import Solids
from mjrock.result.files import turns


@pytest.fixture(scope="module")
def plane():
    """Two blocks with an added mass on a footing that is displaced, pushed so that they rock."""
    footing = mr.Polygon([(-1, -0.5), (1, -0.5), (1, 0), (-1, 0)], fixed=True, name="footing")
    low = mr.Polygon([(-0.2, 0), (0.2, 0), (0.2, 1), (-0.2, 1)], length=0.7, name="low")
    high = mr.Polygon([(-0.2, 1), (0.2, 1), (0.2, 2), (-0.2, 2)], length=0.7, name="high")
    masonry = mr.Masonry([footing, low, high], k_n=1e8, k_s=5e7)
    case = mr.MasonryCase(
        masonry,
        0.5,
        motion=mr.GroundMotion.half_sine(-6.0, 0.3),
        supports={"footing": ([0.0, 0.4], [0.0, 0.04], [0.0, 0.0])},
        effects=(mr.AddedMass(200.0, 1.8, offset=0.1, block="high"),),
    )
    return mr.solve_explicit(case, forces=True, output_step=5e-3)


@pytest.fixture(scope="module")
def space():
    """A slender box that rocks about a corner."""
    ground = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True, name="ground")
    masonry = mr.Masonry([ground, mr.Polyhedron.box((0.4, 0.3, 2.0), (0, 0, 1), name="box")], k_n=1e8, k_s=5e7)
    push = {"motion": mr.GroundMotion.half_sine(-4.0, 0.3), "transverse": mr.GroundMotion.half_sine(-3.0, 0.3)}
    return mr.solve_explicit(mr.MasonryCase(masonry, 0.5, **push), forces=True, output_step=5e-3)


@pytest.fixture(scope="module")
def theory(one_sided, e):
    return mr.solve_analytical(replace(one_sided, duration=0.5), e, output_step=5e-3)


def drawn(answer, frame):
    """Corners of all that moves and is drawn, x and z of the plane, or x, y and z."""
    if answer.in_space:
        return Solids.of(answer).corners(frame).reshape(-1, 3)
    return Bodies.of(answer).corners(frame).reshape(-1, 2)


class Glb:
    """A .glb, read by its definition."""

    def __init__(self, path):
        data = path.read_bytes()
        magic, version, length = struct.unpack("<4sII", data[:12])
        assert (magic, version, length) == (b"glTF", 2, len(data))
        size, kind = struct.unpack("<I4s", data[12:20])
        binary, end = struct.unpack("<I4s", data[20 + size : 28 + size])
        assert (kind, end, len(data)) == (b"JSON", b"BIN\0", 28 + size + binary)
        assert size % 4 == binary % 4 == 0
        self.text, self.data = json.loads(data[20 : 20 + size]), data[28 + size :]

    def numbers(self, accessor):
        table = self.text["accessors"][accessor]
        view, wide = self.text["bufferViews"][table["bufferView"]], {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[table["type"]]
        dtype = {5126: "<f4", 5125: "<u4"}[table["componentType"]]
        values = np.frombuffer(self.data, dtype, table["count"] * wide, view["byteOffset"])
        return values.reshape(-1, wide).astype(float)

    def mesh(self, node):
        (part,) = self.text["meshes"][self.text["nodes"][node]["mesh"]]["primitives"]
        return self.numbers(part["attributes"]["POSITION"]), self.numbers(part["indices"]).astype(int).reshape(-1, 3)

    def moves(self, node):
        """Times, translations and rotations of a node, none of one that stands still."""
        animation, found = self.text["animations"][0], {}
        for channel in animation["channels"]:
            if channel["target"]["node"] == node:
                sampler = animation["samplers"][channel["sampler"]]
                found["t"] = self.numbers(sampler["input"])[:, 0]
                found[channel["target"]["path"]] = self.numbers(sampler["output"])
        return found

    def placed(self, node, frame):
        """Corners of a node at a frame with z upwards again."""
        found, (corners, _) = self.moves(node), self.mesh(node)
        (x, y, z, w), place = found["rotation"][frame], found["translation"][frame]
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        there = corners @ (np.eye(3) + 2 * w * cross + 2 * cross @ cross).T + place
        return there[:, [0, 2, 1]] * (1, -1, 1)


def volume(corners, triangles):
    """Volume within triangles whose corners are counterclockwise from outside."""
    return np.linalg.det(corners[triangles]).sum() / 6


def same_points(some, others):
    """Whether each of some points lies at one of others, and the reverse."""
    apart = np.linalg.norm(some[:, None] - others, axis=2)
    np.testing.assert_allclose(apart.min(axis=0), 0, atol=2e-6)
    np.testing.assert_allclose(apart.min(axis=1), 0, atol=2e-6)


@pytest.mark.parametrize(("which", "nodes", "free"), [("plane", 3, [1, 2]), ("space", 2, [1]), ("theory", 3, [0])])
def test_blocks_of_a_glb_are_where_pictures_have_them(which, nodes, free, request, tmp_path):
    answer = request.getfixturevalue(which)
    glb = Glb(answer.to_gltf(tmp_path / "motion.glb", fps=50))
    assert len(glb.text["nodes"]) == nodes
    assert len(glb.moves(free[0])["t"]) == pytest.approx(50 * answer.t[-1], abs=2)
    times = glb.moves(free[0])["t"]
    assert np.diff(times).min() > 0
    assert times[-1] == pytest.approx(answer.t[-1], rel=1e-6)
    for frame in (0, len(times) // 2, len(times) - 1):
        sample = np.abs(answer.t - times[frame]).argmin()
        corners = np.concatenate([glb.placed(node, frame) for node in free])
        same_points(corners if answer.in_space else corners[:, [0, 2]], drawn(answer, sample))
    assert np.abs(answer.peak).max() > 1e-3


def test_nodes_have_names_volumes_and_stand_still_where_they_are_fixed(plane, space, theory, tmp_path):
    glb = Glb(plane.to_gltf(tmp_path / "plane.glb"))
    assert [node["name"] for node in glb.text["nodes"]] == ["footing", "low", "high"]
    for node, size in enumerate((2 * 0.5 * 1.0, 0.4 * 0.7, 0.4 * 0.7)):
        assert volume(*glb.mesh(node)) == pytest.approx(size, rel=1e-5)
    footing = glb.moves(0)
    np.testing.assert_allclose(np.ptp(footing["translation"], axis=0), [0.04, 0, 0], atol=1e-6)
    glb = Glb(space.to_gltf(tmp_path / "space.glb"))
    assert [volume(*glb.mesh(node)) for node in (0, 1)] == pytest.approx([16, 0.24], rel=1e-5)
    assert not glb.moves(0)
    glb = Glb(theory.to_gltf(tmp_path / "wall.glb"))
    assert [node["name"] for node in glb.text["nodes"]] == ["wall", "base", "side"]
    wall = theory.case.wall
    assert volume(*glb.mesh(0)) == pytest.approx(4 * wall.b * wall.h * wall.length, rel=1e-5)


def test_a_wall_with_a_profile_has_its_volume(e, tmp_path):
    wall = mr.Block(0.3, 2.1, profile=((0.0, 0.6), (2.0, 0.6), (2.0, 0.4), (4.2, 0.4)))
    answer = mr.solve_analytical(mr.Case(wall, 0.02, 0.1), mr.Restitution.from_geometry(wall))
    glb = Glb(answer.to_gltf(tmp_path / "wall.glb"))
    assert volume(*glb.mesh(0)) == pytest.approx(0.6 * 2.0 + 0.4 * 2.2, rel=1e-5)


def test_quaternions_have_no_jumps_of_sign():
    """A viewer that goes straight from one to the next would turn a block back by a whole turn."""
    half = np.linspace(0, 2 * np.pi, 41)
    zero = np.zeros(41)
    smooth = np.column_stack([np.cos(half), zero, np.sin(half), zero])
    jumping = smooth * np.where(np.arange(41) % 3 == 1, -1.0, 1.0)[:, None]
    np.testing.assert_allclose(turns(jumping), np.column_stack([zero, zero, -np.sin(half), np.cos(half)]), atol=1e-12)


def test_another_library_opens_the_glb(space, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.load_scene(space.to_gltf(tmp_path / "space.glb"))
    assert set(scene.geometry) == {"ground", "box"}
    assert scene.geometry["box"].is_watertight
    assert scene.geometry["box"].volume == pytest.approx(0.24, rel=1e-5)
    np.testing.assert_allclose(scene.bounds, [[-2, -1, -2], [2, 2, 2]], atol=2e-3)


def read(path):
    """The arrays of a .vtu, by their names."""
    piece = ET.parse(path).find("UnstructuredGrid/Piece")
    arrays = {}
    for array in piece.iter("DataArray"):
        wide = int(array.get("NumberOfComponents", 1))
        arrays[array.get("Name")] = np.array(array.text.split(), dtype=float).reshape(-1, wide)
    assert len(arrays["Points"]) == int(piece.get("NumberOfPoints"))
    assert len(arrays["offsets"]) == int(piece.get("NumberOfCells"))
    return arrays


def series(path):
    return [(float(row.get("timestep")), path.parent / row.get("file")) for row in ET.parse(path).iter("DataSet")]


@pytest.mark.parametrize("which", ["plane", "space", "theory"])
def test_a_series_has_the_corners_of_pictures_and_their_velocities(which, request, tmp_path):
    answer = request.getfixturevalue(which)
    files = series(answer.to_vtk(tmp_path / "vtk", fps=1e4))
    assert [t for t, _ in files] == answer.t.tolist()
    for sample in (3, len(files) // 2, len(files) - 2):
        now, then = read(files[sample][1]), read(files[sample + 1][1])
        moving = np.linalg.norm(now["displacement"], axis=1) + np.linalg.norm(then["displacement"], axis=1) > 0
        points = now["Points"] if answer.in_space else now["Points"][:, [0, 2]]
        apart = np.linalg.norm(points[:, None] - drawn(answer, sample), axis=2).min(axis=0)
        np.testing.assert_allclose(apart, 0, atol=1e-9)
        change = (then["Points"] - now["Points"])[moving] / (answer.t[sample + 1] - answer.t[sample])
        mean = 0.5 * (then["velocity"] + now["velocity"])[moving]
        np.testing.assert_allclose(change, mean, atol=0.02 * max(0.1, np.abs(mean).max()))
    assert np.abs(mean).max() > 0.01


@pytest.mark.parametrize("which", ["plane", "space"])
def test_joints_have_forces_and_openings(which, request, tmp_path):
    answer = request.getfixturevalue(which)
    answer.to_vtk(tmp_path, fps=1e4)
    found = [read(path) for _, path in series(tmp_path / "joints.pvd")]
    gaps = np.array([one["opening"][:, 0] for one in found])
    np.testing.assert_allclose(gaps.max(axis=0), answer.opening, rtol=1e-2)
    assert answer.opening.max() > 1e-3
    np.testing.assert_allclose([one["normal"][:, 0] for one in found], answer.forces.normal, rtol=1e-9, atol=1e-6)
    on_ground = np.array([one["force"][0] for one in found])
    reaction = answer.reactions[answer.case.masonry.names[0]]
    held = np.cumprod(on_ground[:, 2] != 0).astype(bool)  # a joint that is handed over has no force
    assert held.sum() > 40
    np.testing.assert_allclose(on_ground[held][:, [0, 2]], reaction[held][:, [0, -1]], rtol=1e-6, atol=1e-3)


def test_another_library_opens_the_series(plane, tmp_path):
    meshio = pytest.importorskip("meshio")
    (tmp_path / "new").mkdir()
    files = series(plane.to_vtk(tmp_path / "new"))
    mesh = meshio.read(files[-1][1])
    assert len(mesh.points) == 3 * 8
    assert sum(len(block.data) for block in mesh.cells) == 3 * 6
    assert np.concatenate(mesh.cell_data["block"]).tolist() == np.repeat([0, 1, 2], 6).tolist()
    np.testing.assert_allclose(mesh.point_data["displacement"], read(files[-1][1])["displacement"], atol=1e-12)
    joints = meshio.read(tmp_path / "new" / files[-1][1].name.replace("blocks", "joints"))
    assert joints.point_data["force"].shape == (2, 3)


def test_what_cannot_be_is_refused(theory, tmp_path):
    with pytest.raises(ValueError, match=r"path = 'wall.gltf' does not end in .glb"):
        theory.to_gltf(tmp_path / "wall.gltf")
    for write in (theory.to_gltf, theory.to_vtk):
        with pytest.raises(ValueError, match=r"fps = 0 1/s is outside the valid range 1 to 10000"):
            write(tmp_path / "wall.glb", fps=0)
    assert not list(tmp_path.iterdir())
    theory.to_vtk(tmp_path)
    assert not (tmp_path / "joints.pvd").exists()
