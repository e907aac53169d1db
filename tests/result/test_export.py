"""Files for other programs, opened by libraries that did not write them."""

import dataclasses
import json
import struct
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

import mjrock as mr
from mjrock.result.motion import SampledMotion
from mjrock.result.paraview import BlockSurfaces
from mjrock.result.shapes import MovingShapes, shapes_of

trimesh, meshio = pytest.importorskip("trimesh"), pytest.importorskip("meshio")
WALL = mr.Block.from_size(thickness=0.6, height=4.2, length=3.0)


@pytest.fixture(scope="module")
def pillar():
    ground = mr.Polyhedron.box((2, 2, 0.5), (0, 0, -0.25), fixed=True, name="ground")
    blocks = [mr.Polyhedron.box((0.4, 0.6, 0.5), (0, 0, 0.25 + 0.5 * i), name=f"block {i}") for i in range(3)]
    masonry = mr.Masonry([ground, *blocks], k_n=1e9, friction=0.5, xi=0.1)
    push = mr.GroundMotion(np.where(np.arange(0, 0.8, 0.01) < 0.3, 12.0, 0.0), 0.01)
    return mr.solve_explicit(mr.MasonryCase(masonry, 0.8, motion=push, transverse=push), forces=True)


@pytest.fixture(scope="module")
def rocking():
    return mr.solve_analytical(mr.Case(WALL, 0.5 * WALL.alpha, 0.5), mr.Restitution.from_geometry(WALL))


def corners_at(response, body, sample):
    """Corners of a block in space at a sample, from its pose by the formula of Rodrigues."""
    block = response.case.masonry.blocks[body + 1]
    pose = response.pose[sample, body]
    arm, w, v = block.corners - block.centroid, pose[3], pose[4:]
    turned = arm + 2 * w * np.cross(v, arm) + 2 * np.cross(v, np.cross(v, arm))
    return block.centroid + pose[:3] + turned


def accessor(path, number):
    """An array of a .glb, by the standard."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    tree, binary = json.loads(data[20 : 20 + length]), data[20 + length + 8 :]
    entry = tree["accessors"][number]
    offset = tree["bufferViews"][entry["bufferView"]].get("byteOffset", 0)
    wide = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[entry["type"]]
    values = np.frombuffer(binary, "<f4", entry["count"] * wide, offset).reshape(-1, wide)
    return tree, values


def test_gltf_has_each_block_at_rest_where_trimesh_finds_it(pillar, tmp_path):
    scene = trimesh.load(pillar.to_gltf(tmp_path / "pillar.glb"))
    assert set(scene.geometry) == {"ground", "block 0", "block 1", "block 2"}
    for name, mesh in scene.geometry.items():
        assert mesh.volume == pytest.approx(2.0 if name == "ground" else 0.12, rel=1e-6)
    low, high = scene.bounds  # y is upwards there, and z points towards us
    np.testing.assert_allclose([low, high], [[-1, -0.5, -1], [1, 1.5, 1]], atol=1e-4)


def test_gltf_moves_each_block_as_the_response_does(pillar, tmp_path):
    path = pillar.to_gltf(tmp_path / "pillar.glb", fps=100)
    tree, _ = accessor(path, 0)
    (animation,) = tree["animations"]
    moved = {(tree["nodes"][c["target"]["node"]]["name"], c["target"]["path"]): c for c in animation["channels"]}
    assert ("ground", "translation") not in moved
    for body in range(3):
        way, turn = (moved[f"block {body}", what] for what in ("translation", "rotation"))
        sampler, other = animation["samplers"][way["sampler"]], animation["samplers"][turn["sampler"]]
        times, places = (accessor(path, sampler[key])[1] for key in ("input", "output"))
        turns = accessor(path, other["output"])[1]
        for time in (0.0, 0.4, 0.8):
            key = int(np.argmin(np.abs(times[:, 0] - time)))
            sample = int(np.argmin(np.abs(pillar.t - times[key, 0])))
            centroid = pillar.case.masonry.centroids[body + 1] + pillar.pose[sample, body, :3]
            np.testing.assert_allclose(places[key], centroid, atol=1e-6)
            np.testing.assert_allclose(turns[key], np.roll(pillar.pose[sample, body, 3:], -1), atol=1e-6)
    assert np.abs(pillar.pose[-1, 2, :2]).min() > 0.01  # it has moved along both


def read(folder, name, time):
    """The mesh of a series next to a time, and the time."""
    sets = [
        (float(e.get("timestep")), e.get("file")) for e in ElementTree.parse(folder / f"{name}.pvd").iter("DataSet")
    ]
    at, file = min(sets, key=lambda pair: abs(pair[0] - time))
    return at, meshio.read(folder / file)


def test_paraview_has_blocks_where_they_are(pillar, tmp_path):
    folder = pillar.to_vtk(tmp_path / "series")
    for time in (0.0, 0.4, 0.8):
        at, mesh = read(folder, "blocks", time)
        sample = int(np.argmin(np.abs(pillar.t - at)))
        assert len(mesh.points) == 4 * 8
        for body in range(3):
            own = slice(8 * (body + 1), 8 * (body + 2))
            np.testing.assert_allclose(mesh.points[own], corners_at(pillar, body, sample), atol=1e-12)
    rest = mesh.points - mesh.point_data["displacement [m]"]
    np.testing.assert_allclose(rest[8:16], pillar.case.masonry.blocks[1].corners, atol=1e-12)


def test_velocities_for_paraview_are_rates_of_the_corners(pillar, tmp_path):
    moving = MovingShapes(pillar, np.array([399, 400, 401]))
    surfaces = BlockSurfaces(moving)
    rate = (surfaces.points[2] - surfaces.points[0]) / (moving.t[2] - moving.t[0])
    speed = surfaces.point_fields()["velocity [m/s]"][1]
    np.testing.assert_allclose(speed, rate, atol=0.02 * np.abs(rate).max())


def test_paraview_has_joints_with_their_forces(pillar, tmp_path):
    folder = pillar.to_vtk(tmp_path / "series")
    at, mesh = read(folder, "joints", 0.4)
    sample = int(np.argmin(np.abs(pillar.t - at)))
    cells = {name: values[0] for name, values in mesh.cell_data.items()}
    per_joint = len(cells["slip [m]"]) // 3
    np.testing.assert_allclose(cells["normal force [N]"][::per_joint], pillar.forces.normal[sample])
    last = read(folder, "joints", 0.8)[1].cell_data
    assert 0 < last["opening [m]"][0].max() <= pillar.opening.max() + 1e-9


def test_the_opening_and_slip_of_a_joint_are_those_of_a_known_motion(pillar, tmp_path):
    pose = np.tile([0.0, 0, 0, 1, 0, 0, 0], (2, 3, 1))
    pose[1, 1:, :3] = (0.03, 0.04, 0.01)
    motion = SampledMotion(pose, np.zeros((2, 3, 6)), np.zeros(2))
    still = dataclasses.replace(pillar, t=np.array([0.0, 0.1]), motion=motion, kept_forces=None)
    cells = read(still.to_vtk(tmp_path), "joints", 0.1)[1].cell_data
    opening, slip = (np.unique(np.round(cells[name][0], 12)) for name in ("opening [m]", "slip [m]"))
    np.testing.assert_allclose(opening, [0, 0.01], atol=1e-12)
    np.testing.assert_allclose(slip, [0, 0.05], atol=1e-12)


def test_a_wall_turns_about_its_toe_in_both(rocking, tmp_path):
    scene = trimesh.load(rocking.to_gltf(tmp_path / "wall.glb"))
    assert set(scene.geometry) == {"wall", "ground", "side stop"}
    assert scene.geometry["wall"].volume == pytest.approx(0.6 * 4.2 * 3.0, rel=1e-6)
    mesh = read(rocking.to_vtk(tmp_path / "wall"), "blocks", 0.0)[1]
    lowest = mesh.points[:8][np.argsort(mesh.points[:8, 2])[:2]]
    np.testing.assert_allclose(lowest, [[0.3, -1.5, 0], [0.3, 1.5, 0]], atol=1e-12)
    theta = rocking.theta[0]
    assert mesh.points[:8, 0].max() == pytest.approx(0.3 + 4.2 * np.sin(theta), abs=1e-9)


@pytest.mark.parametrize(
    "wall",
    [
        mr.Block.from_size(thickness=0.6, height=4.2, gable=mr.Gable(1.0, 0.5)),
        mr.Block(b=0.4, h=2.0, profile=((0.0, 0.8), (2.0, 0.8), (2.0, 0.5), (4.0, 0.4))),
    ],
    ids=["gable", "storeys"],
)
def test_the_shape_of_a_wall_has_its_mass(wall):
    shape = shapes_of(mr.Case(wall, 0.1 * wall.alpha, 1.0))[0]
    mesh = trimesh.Trimesh(shape.corners, shape.triangles)
    assert mesh.volume * wall.density == pytest.approx(wall.mass, rel=1e-9)
    np.testing.assert_allclose(mesh.center_mass, 0, atol=1e-9)


def test_a_block_of_the_plane_reaches_over_its_length():
    ground = mr.Polygon([(-1, -1), (2, -1), (2, 0), (-1, 0)], fixed=True)
    block = mr.Polygon([(0, 0), (1, 0), (0.8, 2), (0.2, 2)], length=3.0)
    masonry = mr.Masonry([ground, block], k_n=1e9, friction=0.5)
    shape = next(s for s in shapes_of(mr.MasonryCase(masonry, 1.0)) if not s.fixed)
    mesh = trimesh.Trimesh(shape.corners, shape.triangles)
    assert mesh.volume == pytest.approx(1.6 * 3.0, rel=1e-12)
    np.testing.assert_allclose(mesh.center_mass, 0, atol=1e-12)


def test_what_is_missing_or_wrong_is_named(rocking, tmp_path, monkeypatch):
    with pytest.raises(ValueError, match=r"does not end with \.glb"):
        rocking.to_gltf(tmp_path / "wall.gltf")
    with pytest.raises(ValueError, match="fps"):
        rocking.to_vtk(tmp_path, fps=0.1)
    for package, ask in (("pygltflib", rocking.to_gltf), ("meshio", rocking.to_vtk)):
        monkeypatch.setitem(sys.modules, package, None)
        with pytest.raises(ImportError, match=r"pip install 'mjrock\[export\]'"):
            ask(tmp_path / "wall.glb")
