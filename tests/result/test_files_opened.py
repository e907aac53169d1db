"""Files of a motion, opened by libraries of others: trimesh and meshio."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest

import mjrock as mr
from mjrock.result.bodies import BodyMotion, bodies_of

trimesh, meshio = pytest.importorskip("trimesh"), pytest.importorskip("meshio")


@pytest.fixture(scope="module")
def pillar():
    ground = mr.Polyhedron.box((2, 2, 0.5), (0, 0, -0.25), fixed=True, name="ground")
    blocks = [mr.Polyhedron.box((0.4, 0.6, 0.5), (0, 0, 0.25 + 0.5 * i), name=f"block {i}") for i in range(3)]
    masonry = mr.Masonry([ground, *blocks], k_n=1e9, friction=0.5, xi=0.1)
    push = mr.GroundMotion(np.where(np.arange(0, 0.8, 0.01) < 0.3, 12.0, 0.0), 0.01)
    return mr.solve_explicit(mr.MasonryCase(masonry, 0.8, motion=push, transverse=push), forces=True)


def corners_at(response, body, sample):
    """Corners of a block in space at a sample, from its pose by the formula of Rodrigues."""
    block = response.case.masonry.blocks[body + 1]
    pose = response.pose[sample, body]
    arm, w, v = block.corners - block.centroid, pose[3], pose[4:]
    turned = arm + 2 * w * np.cross(v, arm) + 2 * np.cross(v, np.cross(v, arm))
    return block.centroid + pose[:3] + turned


def read(folder, name, time):
    """The mesh of a series next to a time, and the time."""
    sets = [(float(e.get("timestep")), e.get("file")) for e in ET.parse(folder / f"{name}.pvd").iter("DataSet")]
    at, file = min(sets, key=lambda pair: abs(pair[0] - time))
    return at, meshio.read(folder / file)


def test_trimesh_finds_each_block_of_a_glb(pillar, tmp_path):
    scene = trimesh.load(pillar.to_gltf(tmp_path / "pillar.glb"))
    assert set(scene.geometry) == {"ground", "block 0", "block 1", "block 2"}
    for name, mesh in scene.geometry.items():
        assert mesh.volume == pytest.approx(2.0 if name == "ground" else 0.12, rel=1e-6)
    low, high = scene.bounds  # y is upwards there, and z points towards us
    np.testing.assert_allclose([low, high], [[-1, -0.5, -1], [1, 1.5, 1]], atol=1e-4)


def test_meshio_finds_blocks_where_they_are_and_forces_of_joints(pillar, tmp_path):
    pillar.to_vtk(tmp_path)
    for time in (0.0, 0.4, 0.8):
        at, mesh = read(tmp_path, "blocks", time)
        sample = int(np.argmin(np.abs(pillar.t - at)))
        assert len(mesh.points) == 4 * 8
        for body in range(3):
            own = slice(8 * (body + 1), 8 * (body + 2))
            np.testing.assert_allclose(mesh.points[own], corners_at(pillar, body, sample), atol=1e-9)
        joints = read(tmp_path, "joints", time)[1]
        np.testing.assert_allclose(joints.point_data["normal"], pillar.forces.normal[sample], rtol=1e-9, atol=1e-6)
    assert np.abs(pillar.pose[-1, 2, :2]).min() > 0.01  # it has moved along both


@pytest.mark.parametrize(
    "wall",
    [
        mr.Block.from_size(thickness=0.6, height=4.2, gable=mr.Gable(1.0, 0.5)),
        mr.Block(b=0.4, h=2.0, profile=((0.0, 0.8), (2.0, 0.8), (2.0, 0.5), (4.0, 0.4))),
    ],
    ids=["gable", "storeys"],
)
def test_the_body_of_a_wall_has_its_mass(wall):
    case, still = mr.Case(wall, 0.1 * wall.alpha, 1.0), np.zeros((1, 1, 3))
    body = bodies_of(BodyMotion(case, np.zeros(1), still), still)[0]
    fans = [(face[0], *face[i : i + 2]) for face in body.faces for i in range(1, len(face) - 1)]
    mesh = trimesh.Trimesh(body.corners, fans)
    assert mesh.volume * wall.density == pytest.approx(wall.mass, rel=1e-9)
    np.testing.assert_allclose(mesh.center_mass, 0, atol=1e-9)
